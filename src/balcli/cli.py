"""The command line: it lists the commands, and turns errors into messages and exit codes.

Only the module of the called command is imported. Most commands are in the module `command` of a
package.
"""

from __future__ import annotations

import errno
import re
import sys
import time
from collections.abc import Iterable, Iterator
from copy import copy
from inspect import cleandoc
from io import StringIO
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer
from typer.core import TyperCommand, TyperGroup, TyperOption
from typer.main import get_command

from .errors import (
    BalcliError,
    Exit,
    Loudness,
    name_option,
    note,
    say,
    say_error,
    set_loudness,
    warn,
)
from .limits import MOST_DIGITS
from .names import import_name
from .show.sheet import USUAL_DIGITS, set_digits
from .version import __version__

if TYPE_CHECKING:
    from typer._click import Command, Context, HelpFormatter, Parameter

# Summary of each command; the help of the command itself is longer.
GROUPS = {
    "Analyse": {
        "analyze": "Free forces and moments by order, and devices that balance them.",
        "compare": "Engines side by side: free forces and moments by order, and their ratios.",
        "sum": "Two engines on one frame: H, U and opposed-piston engines.",
        "layouts": "Free forces and moments of common engines at a glance.",
        "torque": "Torque of gas and inertia, mean torque and power, uneven speed, flywheel.",
        "curves": "Forces, moments and torques over the crank angle, or one piston's motion.",
        "piston": "Strokes, dead centres, speeds and accelerations of the pistons.",
        "plot": "Draw the locus of the force, the spectrum of orders, or other pages.",
        "report": "Write a page with the engine in motion and its free forces and moments.",
    },
    "Balance": {
        "balance": "Size counterweights, balancer shafts or sliders, and show what is left.",
        "locomotive": "Hammer blow of a steam locomotive, and balance masses in its wheels.",
        "field": "Balance a rotor on its machine, from readings with trial weights.",
    },
    "Study": {
        "numbers": "List the numbers that a study can vary, and the quantities it can compute.",
        "sweep": "Quantities of an engine whose numbers vary over ranges.",
        "search": "Find the best crank, firing order, bank angle, splay, or other numbers.",
        "scatter": "Spread of forces and moments by tolerances, and which tolerances matter most.",
        "mounts": "Vibration of an engine on its mounts, over a range of speeds.",
        "torsion": "Torsional vibration of a crankshaft or any shafts; dampers, barred speeds.",
    },
    "Files and tables": {
        "new": "Write a commented, valid engine file, or a file of balancing runs or shafts.",
        "engines": "List the example engines that come with balcli, print one, or copy it.",
        "schema": "Print the JSON Schema of a file (for editors) or of a command's output.",
        "check": "Recompute engines and compare the results with recorded ones.",
        "tables": "Recompute the tables printed in five books and papers; list their errata.",
        "bench": "Measure run time and error of several methods of calculation.",
    },
}
COMMANDS = {name: text for group in GROUPS.values() for name, text in group.items()}

# The commands of each module. A command's function has the name of the command.
_COMMANDS_OF = {
    "analysis.command": ("analyze", "compare", "sum", "curves", "piston"),
    "balancing.command": ("balance",),
    "books.command": ("layouts", "tables"),
    "commands": ("new", "engines", "schema", "bench"),
    "field_balancing.command": ("field",),
    "locomotives.command": ("locomotive",),
    "mounting.command": ("mounts",),
    "regression.command": ("check",),
    "report.command": ("plot", "report"),
    "studies.scatter_command": ("scatter",),
    "studies.search.command": ("search",),
    "studies.sweep_command": ("numbers", "sweep"),
    "crank_torque.command": ("torque",),
    "torsional_vibration.command": ("torsion",),
}
MODULES = {name: module for module, names in _COMMANDS_OF.items() for name in names}

IN_FULL_PRECISION = ("curves", "sweep")  # commands whose figures --digits does not change


class _Command(TyperCommand):
    """A command that warns if an option for a single value is given more than once."""

    def parse_args(self, ctx: Context, args: list[str]) -> list[str]:
        given = [] if ctx.resilient_parsing else self.make_parser(ctx).parse_args([*args])[2]
        rest = super().parse_args(ctx, args)
        for option in dict.fromkeys(each for each in given if isinstance(each, TyperOption)):
            if given.count(option) > 1 and not (option.multiple or option.is_flag):
                warn(f"{option.opts[0]} is given {given.count(option)} times; the last one is used")
        return rest


class _OnDemand(TyperGroup):
    """The group of all commands; a command's module is imported when the command runs or
    its help is printed.
    """

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        self.commands: dict[str, Any] = dict.fromkeys(COMMANDS)  # for lists and suggestions

    def get_command(self, ctx: Context, cmd_name: str) -> Command | None:
        if cmd_name not in COMMANDS:
            return None
        single = typer.Typer(
            add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None
        )
        function = import_name(f"{MODULES[cmd_name]}:{cmd_name}")
        text = function.__doc__ or COMMANDS[cmd_name]  # `python -OO` has no docstrings
        single.command(cmd_name, cls=_Command, help=_unwrapped(cleandoc(text)))(function)
        command = get_command(single)
        command.params += _share(self.params, cmd_name, command.params)
        return command

    def format_commands(self, ctx: Context, formatter: HelpFormatter) -> None:
        for title, group in GROUPS.items():
            with formatter.section(title):
                formatter.write_dl(list(group.items()))


def _unwrapped(text: str) -> str:
    """Return a text with each paragraph on one line, for the terminal to wrap. A paragraph that
    begins with a backspace (examples) keeps its lines.
    """
    return re.sub(r"(?<=[^\s\b])\n(?=\S)", " ", text)


app = typer.Typer(
    cls=_OnDemand,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _share(
    options: Iterable[Parameter], command: str, own: Iterable[Parameter]
) -> Iterator[Parameter]:
    """Yield the program's options that may also follow a command's name. A spelling that the
    command itself uses is left out: in `sweep`, `-q` is --quantity.
    """
    taken = {word for option in own for word in option.opts}
    tables = "--format" in taken and command not in IN_FULL_PRECISION
    for option in options:
        if option.name in ("quiet", "verbose") or (option.name == "digits" and tables):
            shared = copy(option)
            shared.opts = [word for word in option.opts if word not in taken]
            shared.expose_value = False
            shared.envvar = None  # the group reads BALCLI_DIGITS
            if shared.opts:
                yield shared


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"balcli {__version__}")
        raise typer.Exit


def _loudness_option(loudness: Loudness, text: str, *names: str) -> object:
    """Return an option that sets how much is printed; it takes effect as soon as it is read."""

    def apply(wanted: bool) -> None:
        if wanted:
            set_loudness(loudness)

    return typer.Option(*names, callback=apply, is_eager=True, expose_value=False, help=text)


def _digits(wanted: int | None) -> int | None:
    if wanted is not None:
        set_digits(wanted)
    return wanted


VERSION = "Print the version of balcli."
QUIET = "No warnings and no progress."
VERBOSE = "Also print what was read, and the run time."
DIGITS = f"Significant digits in tables; default: {USUAL_DIGITS}."
Version = Annotated[
    bool, typer.Option("-V", "--version", callback=_version, is_eager=True, help=VERSION)
]
Digits = Annotated[
    int | None,
    typer.Option(
        "--digits",
        callback=_digits,
        min=1,
        max=MOST_DIGITS,
        metavar="N",
        envvar="BALCLI_DIGITS",
        show_envvar=False,
        show_default=False,
        help=DIGITS,
    ),
]


@app.callback()
def _options(
    version: Version = False,
    quiet: Annotated[bool, _loudness_option(Loudness.QUIET, QUIET, "-q", "--quiet")] = False,
    verbose: Annotated[
        bool, _loudness_option(Loudness.VERBOSE, VERBOSE, "-v", "--verbose")
    ] = False,
    digits: Digits = None,
) -> None:
    """Engine balance: free forces and moments of an engine, order by order, and devices that cancel
    them.

    Describe the engine in a TOML file (`balcli new inline i4.toml` writes one to start from), then
    run `balcli analyze i4.toml`.
    """
    set_digits(digits)


def main() -> NoReturn:
    """Run the command of `sys.argv` and exit. A mistake that the user can correct becomes a message
    on standard error and exit status 2.
    """
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="replace")
    try:
        sys.exit(_run())
    except BalcliError as error:
        say_error(error.tell(name_option))
    except typer.TyperException as error:
        say(_usage(error))
    except BrokenPipeError:  # the reader of the output closed the pipe
        sys.exit(Exit.DONE)
    except (OSError, MemoryError, UnicodeEncodeError) as error:
        say_error(_tell_what_the_system_lacks(error))
    except typer.Abort:  # Ctrl-C when balcli runs inside another process
        sys.exit(Exit.INTERRUPTED)
    except SystemExit as end:
        if isinstance(end.__context__, BrokenPipeError):  # the reader of the help closed the pipe
            sys.exit(Exit.DONE)
        raise
    sys.exit(Exit.BAD_INPUT)


def _run() -> int | None:
    """Return the exit status of the command of `sys.argv`."""
    set_loudness(Loudness.USUAL)
    status: int | None = app(prog_name="balcli", standalone_mode=False)
    note(f"{time.process_time():.2f} s of processor time, including the start of Python")
    return status


# Name of the thing that failed if a system error names no file; empty if the error needs no name.
_UNNAMED = {errno.ENOENT: "working folder", errno.EAGAIN: "", None: ""}


def _tell_what_the_system_lacks(error: OSError | MemoryError | UnicodeEncodeError) -> str:
    if isinstance(error, OSError):
        # without a file name, usually standard output failed, for instance because of a full disk
        named = error.filename or _UNNAMED.get(error.errno, "standard output")
        return ": ".join(filter(None, (named, error.strerror or str(error))))
    if isinstance(error, MemoryError):
        return f"there is not enough memory for this{f' ({error})' if str(error) else ''}"
    # printed text is UTF-8, which always succeeds: only a file name can fail
    return f"{error.object}: cannot be a file name on this system ({error})"


def _usage(error: Any) -> str:
    """Return the usage and the mistake as plain text. (Typer would fold the text in a box.)"""
    text = StringIO()
    error.show(text)
    return text.getvalue().rstrip("\n").replace("Value error, ", "")  # pydantic's prefix
