"""How far a long computation is: a line rewritten on a terminal, and the word after Ctrl-C."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import TypeVar

import typer

from .. import errors, process
from ..errors import Exit, say

T = TypeVar("T")

_SILENT_S, _EVERY_S = 2.0, 0.5  # before the first line, and between two of them


class Progress:
    """Is told how much is done, time and again, and tells it on: on a terminal, when two seconds
    have passed, with the time that is left; and when Ctrl-C ends the command.

    Attributes:
        done: so far, of `total`.
        stopped: whether Ctrl-C asks whoever computes to end with what there is.
    """

    def __init__(self, what: str, total: float | None, at_once: bool, shown: bool) -> None:
        self.done, self.stopped = 0.0, False
        self._what, self._total = what, total
        self._start = time.monotonic()
        self._next = self._start + (0.0 if at_once else _SILENT_S)
        self._width = 0  # of the line that stands there
        self._shown = shown and not errors.is_quiet() and sys.stderr.isatty()

    def __call__(self, done: float) -> bool:
        """So much is done; whether to end with it."""
        self.done = done
        now = time.monotonic()
        if self._shown and now >= self._next:
            self._next = now + _EVERY_S
            self._write(self._describe_pace(now - self._start))
        return self.stopped

    @property
    def cut_short(self) -> bool:
        """Whether Ctrl-C has ended it before all was done."""
        return self.stopped and self._share < 1

    def describe(self) -> str:
        """Such as "20000 of 4000000 variants", or "0.50% of the arrangements"."""
        if self._total is None:
            return f"{self.done:.2%} of the {self._what}"
        return f"{self.done:.0f} of {self._total:.0f} {self._what}"

    def last_word(self) -> str:
        """What is said when the process ends here, on a line of its own."""
        if not self.done:
            return ""
        return "\n" * (self._width > 0) + f"balcli: stopped after {self.describe()}\n"

    def clear(self) -> None:
        """Take the line away."""
        self._write("")

    @property
    def _share(self) -> float:
        return self.done / (self._total or 1.0)

    def _describe_pace(self, seconds: float) -> str:
        """Such as "balcli: 20000 of 4000000 variants (0.5%) in 8 s, about 27 min left"."""
        percent = "" if self._total is None else f" ({self._share:.0%})"
        left = seconds * (1 / self._share - 1) if 0 < self._share < 1 else None
        tail = "" if left is None else f", about {_duration(left)} left"
        return f"balcli: {self.describe()}{percent} in {_duration(seconds)}{tail}"

    def _write(self, line: str) -> None:
        """Over what stands there; a terminal that cannot be written to is none."""
        if line or self._width:
            with suppress(OSError):
                sys.stderr.write(f"\r{line:{self._width}}" + "\r" * (not line))
                sys.stderr.flush()
        self._width = len(line)


def _duration(seconds: float) -> str:
    """Such as 8 s, 3 min, 2.5 h."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


@contextmanager
def reporting(
    what: str, total: float | None = None, at_once: bool = False, shown: bool = True
) -> Iterator[Progress]:
    """Somebody to tell how much is done. Ctrl-C ends the command, which says how far it was.

    Args:
        what: there is to do, as "samples".
        total: of them; None: the share of all is told, from 0 to 1.
        at_once: not only after two seconds.
        shown: False: results are written to the terminal meanwhile.
    """
    progress = Progress(what, total, at_once, shown)
    process.last_words.append(progress.last_word)
    try:
        with _long_computation(progress):
            yield progress
    finally:
        process.last_words.pop()


@contextmanager
def reporting_until_stopped(
    what: str, total: float | None = None, at_once: bool = False, shown: bool = True
) -> Iterator[Progress]:
    """As `reporting`, for what can end early with a whole result of less: the first Ctrl-C is only
    noted, the second one ends the process. Where it is ignored (`nohup`), it still is.
    """
    progress = Progress(what, total, at_once, shown)

    def note(*_: object) -> None:
        progress.stopped = True
        signal.signal(signal.SIGINT, before)

    before = signal.getsignal(signal.SIGINT)
    signal.signal(signal.SIGINT, before if before is signal.SIG_IGN else note)
    try:
        with _long_computation(progress):
            yield progress
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _long_computation(progress: Progress) -> Iterator[None]:
    """It keeps what memory it frees. Messages take the line away before they are written; so does
    the end.
    """
    process.keep_freed_memory()
    errors.before_messages.append(progress.clear)
    try:
        yield
    finally:
        errors.before_messages.remove(progress.clear)
        progress.clear()


def exit_if_cut_short(progress: Progress, what_there_is: str = "") -> None:
    """End with the status of an interruption, and say how far it has come, if there was one."""
    if progress.cut_short:
        tail = f"; {what_there_is}" if what_there_is else ""
        say(f"balcli: stopped after {progress.describe()}{tail}")
        raise typer.Exit(Exit.INTERRUPTED)


def each_until_stopped(items: Sequence[T], progress: Progress) -> Iterator[T]:
    """The items, until Ctrl-C is noted; each is done when the next one is wanted."""
    for count, item in enumerate(items):
        if progress(count):
            return
        yield item
    progress(len(items))
