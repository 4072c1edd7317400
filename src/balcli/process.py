"""The process: signals that end it, its environment, its processor cores, and the type of progress
callbacks.
"""

from __future__ import annotations

import errno
import os
import signal
from collections.abc import Callable
from contextlib import chdir

WINDOWS = os.name == "nt"
_ENDING = ("SIGTERM", "SIGHUP", "SIGQUIT", "SIGALRM", "SIGUSR1", "SIGUSR2", "SIGXCPU", "SIGBREAK")


def exit_on_signals() -> None:
    """Let every signal that ends a process raise SystemExit (128 + number), so that temporary files
    are removed. Signals that the caller ignores (`nohup`) stay ignored.
    """
    for name in _ENDING:
        number = getattr(signal, name, None)  # Windows lacks some; only Windows has the last
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _exit)


def _exit(number: int, _frame: object) -> None:
    raise SystemExit(128 + number)


def ignore_matplotlib_settings() -> None:
    """Keep matplotlib from reading foreign settings: a `matplotlibrc` in the working folder may
    come with an archive, and the environment may name a backend that is not installed.
    """
    for name in ("MPLBACKEND", "MATPLOTLIBRC"):
        os.environ.pop(name, None)
    if os.path.lexists("matplotlibrc"):  # matplotlib reads the file at its import
        with chdir(os.path.dirname(__file__)):
            import matplotlib  # noqa: F401


def has_no_reader(error: OSError) -> bool:
    """Return whether a pipe was closed by its reader (for Windows, an invalid argument)."""
    return isinstance(error, BrokenPipeError) or (WINDOWS and error.errno == errno.EINVAL)


def count_cores() -> int:
    """Return the number of processor cores that this process may use."""
    usable = getattr(os, "sched_getaffinity", None)  # only Linux has it
    return len(usable(0)) if usable else os.cpu_count() or 1


# A progress callback. It is called repeatedly with the share that is done (0 to 1), or with a
# number if the docstring of the function says so. If it returns True, a computation that can end
# early ends.
Tell = Callable[[float], bool]


def tell_nobody(done: float) -> bool:
    """Ignore progress."""
    return False
