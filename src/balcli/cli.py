"""The command line: which commands there are, and the one place where errors become text and exit
codes.

Only the module of the command that is called is imported; what a command does is in `commands/`.
"""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Collection
from copy import copy
from importlib import import_module
from inspect import cleandoc
from io import StringIO
from typing import Annotated, Any, NoReturn

import typer
from typer.core import TyperGroup
from typer.main import get_command

from . import __version__
from .errors import BalcliError, Exit, Loudness, note, say, set_loudness

# What each does in a line; the first paragraph of its own help says the same.
GROUPS = {
    "Analyse": {
        "analyze": "Free forces and moments of an engine, order by order, and what balances them.",
        "compare": "Engines side by side: free forces and moments by order, peaks, and their "
        "ratios to the first engine's.",
        "sum": "Two engines on one frame, geared one to one: H, U and opposed-piston engines.",
        "layouts": "Free forces and moments of common engines at a glance, as multiples of "
        "one cylinder's.",
        "torque": "Torque of gas and inertia on the crank: by order and over the cycle, "
        "mean torque and power, the uneven speed and the flywheel; or what a "
        "given torque curve does.",
        "curves": "Force, moment, couple, torque and roll over the crank angle, or the "
        "motion of one piston.",
        "plot": "Draw free forces and moments: loci over a revolution, order by order, "
        "and over the crank angle; or torsional vibration.",
        "report": "Write one self-contained page: the engine in motion, what it shakes, and "
        "a balance scheme before and after.",
    },
    "Balance": {
        "balance": "Size counterweights, balancer shafts or sliders, and show what is left "
        "with them.",
        "field": "Balance a rotor on the machine or in its bearings: from readings with "
        "trial weights to correction weights, places or drill holes, and what is "
        "left.",
    },
    "Study": {
        "sweep": "Figures of many variants of an engine: numbers of its file over ranges, "
        "as a table, CSV, JSON or Parquet.",
        "search": "The best crank, firing order, bank angle or splay; mirror images and "
        "rotations once.",
        "scatter": "How free forces and moments spread when masses (rod lengths, throw "
        "angles) vary, and which tolerance matters most.",
        "mounts": "What the frame feels of an engine on its mounts: natural modes, rest, "
        "forces of the mounts and motion of points over a range of speeds.",
        "torsion": "Torsional vibration of a crankshaft, or of any shafts: natural modes, "
        "critical speeds, Holzer tables, vibratory torque and stress over a range "
        "of speeds, dampers, barred speeds.",
    },
    "Files and tables": {
        "new": "Write a commented, valid engine file (or file of runs, for `field`, or "
        "chain file, for `torsion`) to start from.",
        "engines": "List the example engines that come with balcli, print one, or copy it.",
        "schema": "Print the JSON Schema of the engine file, a file of runs or a chain "
        "file, for editors; or of what a command prints as JSON.",
        "check": "Recompute engines and compare with their recorded results; exit status 1 "
        "if anything moved.",
        "tables": "The printed coefficient tables of five books and papers, recomputed, and "
        "every misprint in them.",
        "bench": "Run time against error of every way to the same figures, on this "
        "machine; with -o X.svg also as a picture.",
    },
}
COMMANDS = {name: text for group in GROUPS.values() for name, text in group.items()}


class _OnDemand(TyperGroup):
    """The commands by name; the module of one is imported when it is called, or its help is asked
    for.
    """

    def list_commands(self, ctx: Any) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        if cmd_name not in COMMANDS:
            return None
        single = typer.Typer(
            add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None
        )
        function = getattr(import_module(f"balcli.commands.{cmd_name}"), cmd_name)
        single.command(cmd_name, help=_unwrapped(cleandoc(function.__doc__)))(function)
        command = get_command(single)
        taken = {word for option in command.params for word in option.opts}
        command.params += [_sparing(option, taken) for option in self.params if _is_shared(option)]
        return command

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        for title, group in GROUPS.items():
            with formatter.section(title):
                formatter.write_dl(list(group.items()))

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        try:
            return super().resolve_command(ctx, args)
        except typer.TyperException as error:
            from difflib import get_close_matches

            if near := get_close_matches(args[0].lower()[:100], COMMANDS, 1):
                error.message += f" Did you mean {near[0]}?"
            raise


def _unwrapped(text: str) -> str:
    """Paragraphs as one line each: the terminal wraps them to its own width. One that begins with a
    backspace keeps its lines (examples).
    """
    return re.sub(r"(?<=[^\s\b])\n(?=\S)", " ", text)


app = typer.Typer(
    cls=_OnDemand,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _is_shared(option: Any) -> bool:
    """Whether an option of the program stands after the command's name, too."""
    return option.name in ("quiet", "verbose")


def _sparing(option: Any, taken: Collection[str]) -> Any:
    """The option without the words that are a command's own: `-q` of `sweep` is its --quantity."""
    own = copy(option)
    own.opts = [word for word in option.opts if word not in taken]
    return own


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"balcli {__version__}")
        raise typer.Exit


def _quiet(wanted: bool) -> None:
    if wanted:
        set_loudness(Loudness.QUIET)


def _verbose(wanted: bool) -> None:
    if wanted:
        set_loudness(Loudness.VERBOSE)


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option(
            "-V", "--version", callback=_version, is_eager=True, help="Say which version this is."
        ),
    ] = False,
    quiet: Annotated[
        bool,
        typer.Option(
            "-q",
            "--quiet",
            callback=_quiet,
            expose_value=False,
            help="Results and errors alone: no warnings, no progress.",
        ),
    ] = False,
    verbose: Annotated[
        bool,
        typer.Option(
            "-v",
            "--verbose",
            callback=_verbose,
            expose_value=False,
            help="Also what was read and assumed, and how long it took, on standard error.",
        ),
    ] = False,
) -> None:
    """Engine balance: which free forces and moments an engine makes, order by order, and what
    cancels them.

    Describe the engine in a TOML file (`balcli new inline i4.toml` writes one to start from), then
    `balcli analyze i4.toml`.
    """


def main() -> NoReturn:
    """Run the command of `sys.argv` and exit. Whatever a user can mend becomes a message on
    standard error and exit status 2.
    """
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="replace")
    set_loudness(Loudness.USUAL)
    try:
        status = app(prog_name="balcli", standalone_mode=False)
        note(f"{time.process_time():.2f} s of processor time, the start of Python included")
        sys.exit(status)
    except BalcliError as error:
        say(f"balcli: {error}")
    except typer.TyperException as error:
        say(_usage(error))
    except BrokenPipeError:  # the reader of it has what they want
        sys.exit(Exit.DONE)
    except OSError as error:  # of what typer prints itself, such as help
        say(f"balcli: {error.filename or 'standard output'}: {error.strerror or error}")
    except typer.Abort:  # Ctrl-C, where balcli is no process of its own
        sys.exit(Exit.INTERRUPTED)
    except SystemExit as end:
        if isinstance(end.__context__, BrokenPipeError):  # the reader of help has what they want
            sys.exit(Exit.DONE)
        raise
    sys.exit(Exit.BAD_INPUT)


def _usage(error: Any) -> str:
    """How the command is used and what is wrong, plain: a box would fold it, even in a pipe."""
    text = StringIO()
    error.show(text)
    return text.getvalue().rstrip("\n").replace("Value error, ", "")  # pydantic's words
