"""The process: signals that end it, its environment, its cores, and the callback of long
computations.
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
    are removed. A signal that was ignored from the start (`nohup`) still is.
    """
    for name in _ENDING:
        number = getattr(signal, name, None)  # some are missing on Windows, the last elsewhere
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _exit)


def _exit(number: int, _frame: object) -> None:
    raise SystemExit(128 + number)


def ignore_matplotlib_settings() -> None:
    """Keep matplotlib from reading settings of other people: a `matplotlibrc` in the working folder
    may come with an archive, and a backend for windows may not be installed.
    """
    for name in ("MPLBACKEND", "MATPLOTLIBRC"):
        os.environ.pop(name, None)
    if os.path.lexists("matplotlibrc"):  # it is read when matplotlib is imported
        with chdir(os.path.dirname(__file__)):
            import matplotlib  # noqa: F401


def has_no_reader(error: OSError) -> bool:
    """Return whether a pipe was closed by its reader (on Windows, an invalid argument)."""
    return isinstance(error, BrokenPipeError) or (WINDOWS and error.errno == errno.EINVAL)


def count_cores() -> int:
    """Return the number of processor cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # only Linux has it
        return os.cpu_count() or 1


# Is told, time and again, how much is done: a share from 0 to 1, or a number where the function
# says so; True: that is enough, what can end early does so.
Tell = Callable[[float], bool]


def tell_nobody(done: float) -> bool:
    """Ignore progress."""
    return False
