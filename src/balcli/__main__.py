"""The program's start and end: what makes a process quick, around what it does."""

from __future__ import annotations

import atexit
import gc
import os
import sys
from typing import NoReturn


def main() -> NoReturn:
    """Entry point of `balcli` and `python -m balcli`."""
    gc.set_threshold(100_000)  # start-up makes many objects, but no garbage
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "1")  # looking for them takes 20 ms
    from .cli import main as run  # after that, for it imports what heeds it

    try:
        run()
    except SystemExit as end:
        _end_at_once(end)


def _end_at_once(end: SystemExit) -> NoReturn:
    """End the process without taking its thousands of objects to pieces, which takes 10 ms; what is
    registered for its end is done.

    Where something cannot be written any more, the interpreter ends as usual and tells of it.
    """
    atexit._run_exitfuncs()
    try:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
    except OSError:
        raise end from None
    os._exit(int(end.code or 0))


if __name__ == "__main__":
    main()
