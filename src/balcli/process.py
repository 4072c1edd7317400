"""Process: signals that end it, and the cores that it may use."""

from __future__ import annotations

import errno
import os
import signal

WINDOWS = os.name == "nt"


def exit_on_signals() -> None:
    """Let SIGTERM, SIGHUP and the limit of processor time raise SystemExit (128 + number), so that
    temporary files are removed. A signal that was ignored from the start (`nohup`) still is.
    """
    for name in ("SIGTERM", "SIGHUP", "SIGXCPU", "SIGBREAK"):
        number = getattr(signal, name, None)  # some are missing on Windows, the last elsewhere
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _exit)


def _exit(number: int, _frame: object) -> None:
    raise SystemExit(128 + number)


def has_no_reader(error: OSError) -> bool:
    """Whether a pipe was closed by its reader; Windows reports this as an invalid argument."""
    return isinstance(error, BrokenPipeError) or (WINDOWS and error.errno == errno.EINVAL)


def count_cores() -> int:
    """Return the number of processor cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # only Linux has it
        return os.cpu_count() or 1
