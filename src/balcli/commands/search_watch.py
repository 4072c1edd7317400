"""Watching a search that may take long: how far it is, and Ctrl-C, which ends it with the best so
far.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import typer

from ..errors import Exit, say
from .sweep_output import Interrupt, noting_interrupt

_SILENT_S, _EVERY_S = 2.0, 20.0  # before the first word, and between two of them


class Watch:
    """Told which share of all arrangements has been decided on, it says so on a terminal, and
    whether Ctrl-C has been pressed.
    """

    def __init__(self, interrupt: Interrupt) -> None:
        self._interrupt, self._share = interrupt, 0.0
        self._start = time.monotonic()
        self._next = self._start + _SILENT_S

    def __call__(self, share: float) -> bool:
        self._share = share
        if time.monotonic() >= self._next and sys.stderr.isatty():
            self._next = time.monotonic() + _EVERY_S
            say(f"balcli: {self._describe(time.monotonic() - self._start)}")
        return self._interrupt.noted

    def _describe(self, seconds: float) -> str:
        more = seconds * (1 / max(self._share, 1e-9) - 1)
        return (
            f"{self._share:.2%} of the arrangements in {seconds:.0f} s, about {more:.0f} s more at "
            "this pace; Ctrl-C shows the best so far"
        )

    def exit_if_stopped(self) -> None:
        """End with the status of an interruption, and say how far it has come, if there was one."""
        if self._interrupt.noted and self._share < 1:
            done = f"stopped after {self._share:.2%} of the arrangements"
            say(f"balcli: {done}; these are the best of them")
            raise typer.Exit(Exit.INTERRUPTED)


@contextmanager
def watching_search(over: str) -> Iterator[Watch | None]:
    """A watch over a search over throws (no other takes long). Where Ctrl-C has ended the search,
    the command ends with its status, too.
    """
    if over != "throws":
        yield None
        return
    with noting_interrupt() as interrupt:
        watch = Watch(interrupt)
        yield watch
    watch.exit_if_stopped()
