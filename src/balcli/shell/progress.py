"""Report the progress of long computations: a bar on a terminal, and a message after Ctrl-C."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeVar

import typer

from ..errors import Exit, is_quiet, say
from ..show.sheet import count_name

if TYPE_CHECKING:
    from rich.progress import Progress as Bar


T = TypeVar("T")

_SILENT_S = 2.0
_EVERY_S = 0.5  # time before the bar appears, and between updates


class Progress:
    """Callback that receives the amount of work done so far and shows it on a terminal.

    Attributes:
        done: Work done so far, as a number or (without a total) a share from 0 to 1.
        stopped: Whether Ctrl-C asks the computation to end with the results so far.
    """

    def __init__(self, noun: str, total: float | None, shown: bool) -> None:
        self.done = 0.0
        self.stopped = False
        self._what = noun
        self._total = total
        self._next = time.monotonic() + _SILENT_S
        wanted = shown and not is_quiet() and sys.stderr.isatty()
        self._bar = _make_bar(noun, total) if wanted else None

    def __call__(self, done: float) -> bool:
        """Report the work done so far; return whether the computation should stop."""
        self.done = done
        if self._bar is not None and time.monotonic() >= self._next:
            self._next = time.monotonic() + _EVERY_S
            self._bar.start()
            self._bar.update(self._bar.task_ids[0], completed=done, refresh=True)
        return self.stopped

    @property
    def cut_short(self) -> bool:
        """Whether Ctrl-C ended the computation before all was done."""
        return self.stopped and self.done < (self._total or 1.0)

    def describe(self) -> str:
        """Return a text such as "20000 of 4000000 variants" or "0.50% of the work"."""
        if self._total is None:
            return f"{self.done:.2%} of the {self._what}"
        return f"{count_name(self.done)} of {count_name(self._total)} {self._what}"

    def close(self) -> None:
        """Remove the progress bar from the terminal."""
        if self._bar is not None:
            self._bar.stop()


def _make_bar(noun: str, total: float | None) -> Bar:
    """Return a bar on standard error, not yet started; messages are printed above it."""
    from rich import progress
    from rich.console import Console

    bar = progress.Progress(
        *progress.Progress.get_default_columns(),
        *([] if total is None else [progress.MofNCompleteColumn()]),
        console=Console(file=sys.stderr),
        auto_refresh=False,
        transient=True,
        redirect_stdout=False,
    )
    bar.add_task(f"balcli: {noun}", total=total or 1.0)
    return bar


@contextmanager
def reporting(noun: str, total: float | None = None, shown: bool = True) -> Iterator[Progress]:
    """Yield a callback for the work done so far. Ctrl-C ends the command and prints the progress.

    Args:
        noun: Noun for the work, such as "samples".
        total: Total amount of work; None: the callback receives the share of the work, from 0 to 1.
        shown: Whether to show a bar; false if results appear on the terminal meanwhile.
    """
    progress = Progress(noun, total, shown)
    try:
        yield progress
    except KeyboardInterrupt:
        progress.close()
        say(f"balcli: stopped after {progress.describe()}")
        raise typer.Exit(Exit.INTERRUPTED) from None
    finally:
        progress.close()


@contextmanager
def reporting_until_stopped(noun: str, total: float | None = None) -> Iterator[Progress]:
    """Report progress as `reporting` does, for a computation that can end early with a partial
    result: the first Ctrl-C only sets `stopped`, the second one ends the command. If the process
    ignores Ctrl-C (`nohup`), it continues to do so.

    Args:
        noun: Noun for the work.
        total: Total amount of work; None: the callback receives the share of the work, from 0 to 1.
    """
    before = signal.getsignal(signal.SIGINT)
    with reporting(noun, total) as progress:

        def stop(*_: object) -> None:
            progress.stopped = True
            signal.signal(signal.SIGINT, before)

        if before is not signal.SIG_IGN:
            signal.signal(signal.SIGINT, stop)
        try:
            yield progress
        finally:
            signal.signal(signal.SIGINT, before)


def exit_if_cut_short(progress: Progress, what_there_is: str = "") -> None:
    """If the work was cut short, print its progress and end with the status of an interruption.

    Args:
        progress: Progress of the work.
        what_there_is: Remark on the result so far.
    """
    if progress.cut_short:
        tail = f"; {what_there_is}" if what_there_is else ""
        say(f"balcli: stopped after {progress.describe()}{tail}")
        raise typer.Exit(Exit.INTERRUPTED)


def each_until_stopped(items: Sequence[T], progress: Progress) -> Iterator[T]:
    """Yield the items until Ctrl-C; an item counts as done when the next one is requested.

    Args:
        items: Items of the work.
        progress: Progress of the work.
    """
    for count, item in enumerate(items):
        if progress(count):
            return
        yield item
    progress(len(items))
