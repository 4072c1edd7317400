"""What the system does to the process: signals that end it, and standard streams that are closed.

Little is imported here, for until `end_on_signals` has been called, a signal ends the process as
the system does, and leaves what is unfinished.
"""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

started_with = dict(os.environ)  # before this program sets what makes its own start quick
_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD = -1, -3  # as <malloc.h> has them
# Temporary files, and folders of such, which nobody finds there once the process has ended.
unfinished: set[str] = set()
last_words: list[Callable[[], str]] = []  # the last one says how far a long computation is


def end_on_signals() -> None:
    """Let Ctrl-C, SIGTERM, SIGHUP and the end of its processor time end the process at any instant:
    exit status 128 and the signal's number, as in a shell, without a word unless Ctrl-C ends a long
    computation. What was ignored from the start (`nohup`) still is.
    """
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGXCPU", "SIGBREAK"):
        number = getattr(signal, name, None)  # the last is Windows' own, which has no SIGHUP
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _end)


def _end(number: int, _frame: object) -> None:
    """Not by an exception: what is being imported, or deleted, would swallow or wrap it."""
    for path in tuple(unfinished):
        discard(path)
    if number == signal.SIGINT and last_words:
        with suppress(OSError):  # past `sys.stderr`, which may be in the middle of a line
            os.write(2, last_words[-1]().encode())
    os._exit(128 + number)


@contextmanager
def ctrl_c_later() -> Iterator[None]:
    """Ctrl-C is heeded afterwards; processes and threads that are begun here never hear of it (a
    terminal sends it to all, and a Python that just starts says so at length).
    """
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    from multiprocessing import resource_tracker  # for few

    resource_tracker.ensure_running()  # else that, with the first process, lets Ctrl-C through
    usual = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, usual)


def discard(path: str) -> None:
    """Delete a temporary file, or a folder with its files, unless it has been moved to its place or
    was not made yet. Threads may still write into a folder: it gets another name, where they do not
    find it.
    """
    if not os.path.isdir(path):
        with suppress(OSError):
            os.unlink(path)
        return
    moved = f"{path}.old"
    unfinished.add(moved)  # for the next signal
    with suppress(OSError):  # Windows moves no folder of open files
        os.rename(path, moved)
        path = moved
    while _delete_files(path):
        pass
    with suppress(OSError):
        os.rmdir(path)
    unfinished.discard(moved)


def _delete_files(folder: str) -> int:
    """How many of its files could be deleted."""
    deleted = 0
    with suppress(OSError):
        for name in os.listdir(folder):
            with suppress(OSError):
                os.unlink(os.path.join(folder, name))
                deleted += 1
    return deleted


def keep_freed_memory() -> None:
    """Let the C library keep what arrays leave for the next ones, up to 64 MB. It would hand back
    large ones, to be cleared again for every array; in the workers of a dask cluster, whose
    environment says so, all of them, which takes four times as long as what sweeps compute.
    """
    from ctypes import CDLL  # which numpy loads, too

    with suppress(AttributeError, OSError, TypeError):  # only glibc has it
        mallopt = CDLL(None).mallopt
        mallopt(_M_MMAP_THRESHOLD, 32 << 20)  # its own maximum
        mallopt(_M_TRIM_THRESHOLD, 64 << 20)


WINDOWS = os.name == "nt"


def has_no_reader(error: OSError) -> bool:
    """Whether nobody reads a pipe any more: on Windows that is no BrokenPipeError."""
    return isinstance(error, BrokenPipeError) or (WINDOWS and error.errno == errno.EINVAL)


def count_cores() -> int:
    """Processor cores that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # of Linux alone
        return os.cpu_count() or 1


def open_closed_streams() -> None:
    """Put something in the place of standard streams that are closed (`>&-`), which Python has as
    None: where reading or writing fails with an OSError, as it does for every other program.

    No file that is opened later gets the number of a standard stream either.
    """
    for number, name, ways in (
        (0, "stdin", (os.O_WRONLY, "r")),
        (1, "stdout", (os.O_RDONLY, "w")),
        (2, "stderr", (os.O_RDWR, "w")),  # what cannot be said is not
    ):
        if getattr(sys, name) is None:
            found = os.open(os.devnull, ways[0])
            if found != number:
                os.dup2(found, number)
                os.close(found)
            stream = open(number, ways[1], encoding="utf-8", closefd=False)  # noqa: SIM115 (stays)
            setattr(sys, name, stream)
