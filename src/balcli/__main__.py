"""The program's start and end: what makes a process quick, around what it does."""

from __future__ import annotations

import signal

if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    # Before anything else is imported: until `end_on_signals`, Ctrl-C would be a traceback.
    signal.signal(signal.SIGINT, signal.SIG_DFL)

import atexit
import gc
import os
import sys
from contextlib import suppress
from typing import NoReturn

from .errors import Exit, say
from .process import end_on_signals, open_closed_streams


def main() -> NoReturn:
    """Entry point of `balcli` and `python -m balcli`."""
    end_on_signals()
    open_closed_streams()
    gc.set_threshold(100_000)  # start-up makes many objects, but no garbage
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "1")  # looking for them takes 20 ms
    # Our matrices are too small for threads, whose start takes another core's time; a user may ask.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if not sys.stdout.isatty():  # help, too, has no escapes there, whatever FORCE_COLOR says
        os.environ["_TYPER_FORCE_DISABLE_TERMINAL"] = "1"
    status: int = Exit.INTERNAL
    try:
        from .cli import main as run  # after that, for it imports what heeds it

        run()
    except SystemExit as end:
        status = int(end.code or 0)
    except Exception as error:
        _tell_fault(error)
    _end_at_once(status)


def _tell_fault(error: Exception) -> None:
    """One sentence about an error that is nobody's but ours; for those who look for it, where it
    was raised, too.
    """
    if sys.flags.dev_mode or os.environ.get("BALCLI_TRACEBACK"):
        import traceback  # for those alone

        say("".join(traceback.format_exception(error)).rstrip("\n"))
    what = ": ".join(filter(None, (type(error).__name__, str(error))))
    say(
        f"balcli: internal error ({what}); this is a fault of balcli, no figure is to be trusted: "
        "please report it with the command and its files (BALCLI_TRACEBACK=1 shows where it is)"
    )


def _end_at_once(status: int) -> NoReturn:
    """End the process without taking its thousands of objects to pieces, which takes 10 ms; what is
    registered for its end is done.
    """
    atexit._run_exitfuncs()
    with suppress(OSError):
        sys.stderr.flush()  # nobody reads it: nothing is left to say
    try:
        sys.stdout.flush()
    except OSError as error:
        if not status:  # else this has been told already
            status = Exit.BAD_INPUT
            say(f"balcli: standard output: cannot be written ({error.strerror or error})")
    os._exit(status)


if __name__ == "__main__":
    main()
