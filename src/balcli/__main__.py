"""Entry point of `balcli` and `python -m balcli`."""

from __future__ import annotations

import os
import sys
from typing import NoReturn

from .errors import Exit, say
from .process import exit_on_signals


def main() -> NoReturn:
    """Run the command line; an unexpected error becomes one sentence and exit status 70."""
    exit_on_signals()
    for name, mode in (("stdin", "w"), ("stdout", "r"), ("stderr", "w")):
        if getattr(sys, name) is None:  # closed by the caller (`>&-`): its use shall be an OSError
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the matrices are too small for threads
    try:
        from .cli import main as run  # imports libraries that read the environment

        run()
    except KeyboardInterrupt:
        sys.exit(Exit.INTERRUPTED)
    except Exception as error:
        _report_fault(error)
        sys.exit(Exit.INTERNAL)


def _report_fault(error: Exception) -> None:
    """Print an error that only balcli itself can have caused; with BALCLI_TRACEBACK its traceback
    as well.
    """
    if sys.flags.dev_mode or os.environ.get("BALCLI_TRACEBACK"):
        import traceback

        say("".join(traceback.format_exception(error)).rstrip("\n"))
    what = ": ".join(filter(None, (type(error).__name__, str(error))))
    say(
        f"balcli: internal error ({what}); this is a fault of balcli, no figure is to be trusted: "
        "please report it with the command and its files (BALCLI_TRACEBACK=1 shows where it is)"
    )


if __name__ == "__main__":
    main()
