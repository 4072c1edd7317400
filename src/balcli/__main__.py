"""Entry point of `balcli` and `python -m balcli`."""

from __future__ import annotations

import os
import sys
from typing import NoReturn

from .errors import Exit, say
from .process import exit_on_signals, has_no_reader, ignore_matplotlib_settings


def main() -> NoReturn:
    """Run the command line; an unexpected error becomes one sentence and exit status 70."""
    exit_on_signals()
    for name, mode in (("stdin", "w"), ("stdout", "r"), ("stderr", "w")):
        if getattr(sys, name) is None:  # the caller closed the stream (`>&-`)
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the matrices are too small for threads
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "1")  # else pydantic searches for plugins
    status: int = Exit.DONE
    try:
        ignore_matplotlib_settings()
        from .cli import main as run  # imports libraries that read the environment

        run()
    except SystemExit as end:
        status = int(end.code or 0)
    except KeyboardInterrupt:
        status = Exit.INTERRUPTED
    except Exception as error:
        _report_fault(error)
        status = Exit.INTERNAL
    sys.exit(_flush_streams(status))


def _flush_streams(status: int) -> int:
    """Flush all output and return the exit status, which is 2 if a result cannot be written.

    A stream that fails is replaced by the null device; otherwise the interpreter's own flush at the
    end would fail as well.
    """
    for stream in (sys.stderr, sys.stdout):
        try:
            stream.flush()
        except OSError as error:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
            if stream is sys.stdout and status == Exit.DONE and not has_no_reader(error):
                say(f"balcli: standard output: {error.strerror or error}")
                status = Exit.BAD_INPUT
    return status


def _report_fault(error: Exception) -> None:
    """Print an error that only a fault of balcli can have caused. If BALCLI_TRACEBACK is set, print
    its traceback as well.
    """
    if sys.flags.dev_mode or os.environ.get("BALCLI_TRACEBACK"):
        import traceback

        say("".join(traceback.format_exception(error)).rstrip("\n"))
    fault = ": ".join(filter(None, (type(error).__name__, str(error))))
    say(
        f"balcli: internal error ({fault}); this is a fault of balcli, do not trust its figures: "
        "please report it with the command and its files (BALCLI_TRACEBACK=1 prints a traceback)"
    )


if __name__ == "__main__":
    main()
