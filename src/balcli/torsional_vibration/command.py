"""The command `balcli torsion`: its options."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ..errors import BalcliError, warn
from ..file.toml import name_file
from ..shell.file_names import (
    TEXTS,
    engine_argument,
    format_of,
    format_option,
    picture_form,
    require_ending,
)
from ..shell.inputs import warn_each
from ..shell.options import Output, UnitsOption
from ..shell.output import (
    emit,
    refuse_leaving_files,
    refuse_overwriting,
    show,
    write_figure,
    write_file,
)
from ..shell.progress import reporting
from ..shell.values import optional
from ..show.formats import Format, Units
from ..show.units import SYSTEMS

if TYPE_CHECKING:
    from ..core.vibration import Real
    from .answer import TorsionQuestion

_FORMATS = {**TEXTS, ".html": Format.HTML}
FormatOption = Annotated[
    Format | None,
    format_option(
        _FORMATS.values(),
        "Default: by the ending of -o, else table. html: a page to print for a class society or a "
        "customer, with the worst misfire.",
    ),
]


def torsion(
    path: Annotated[
        str,
        engine_argument(
            "FILE",
            "Engine file with [torsion], or a chain file, or the name of an example; - reads "
            "standard input.",
        ),
    ],
    speeds: Annotated[
        str | None,
        optional("A:B:STEP", "Speeds for forced vibration, rpm.", "--speeds", "--speed"),
    ] = None,
    orders: Annotated[
        str | None,
        optional(
            "0.5-12|1,2.5",
            "Orders of excitation; default: all of a chain; of an engine, orders up to 32.",
        ),
    ] = None,
    holzer: Annotated[
        list[str] | None,
        optional("MODE|FREQUENCY", 'Holzer table of a mode, or at "20 rad/s"; may be repeated.'),
    ] = None,
    misfire: Annotated[
        list[str] | None,
        optional(
            "N|worst",
            "Cylinder without gas pressure; repeat for more cylinders. worst: every cylinder in "
            "turn, then the results of the worst one.",
        ),
    ] = None,
    compressing: Annotated[
        bool,
        typer.Option(
            "--compressing",
            help="Cylinders of --misfire compress but do not burn (computed cycles only).",
        ),
    ] = False,
    damper: Annotated[
        Literal["viscous", "rubber", "pendulum"] | None,
        optional("KIND", "Size a viscous, rubber or pendulum damper for the least stress."),
    ] = None,
    damper_at: Annotated[
        str | None,
        optional("NAME", "Node that carries the damper; default: foremost part (pendulum: throw)."),
    ] = None,
    damper_inertia: Annotated[
        str | None,
        optional("KGMM2", "Inertia of the damper; default: as in the file, else a usual value."),
    ] = None,
    write: Annotated[Path | None, optional("FILE", "Write a copy of FILE with the damper.")] = None,
    plot: Annotated[Path | None, optional("FILE", "Draw pictures; .svg, .png or .pdf.")] = None,
    what: Annotated[
        Literal["all", "modes", "campbell", "response", "waterfall"],
        typer.Option(help="Picture that --plot draws; the last two need --speeds."),
    ] = "all",
    units: UnitsOption = Units.SI,
    form: FormatOption = None,
    output: Output = None,
) -> None:
    """Torsional vibration of a crankshaft, or of any shafts: natural modes, critical speeds, Holzer
    tables, vibratory torque and stress over a range of speeds, dampers, barred speeds.

    `balcli new torsion chain.toml` writes a file to start from: nodes, shafts, gears, torques.

    \b
    Example:
      balcli torsion i6_diesel.toml --speeds 600:2400:20
    """
    refuse_overwriting(reads=[path], writes={"--output": output, "--write": write, "--plot": plot})
    form = format_of(output, form, _FORMATS, Format.TABLE)
    drawn = None if plot is None else picture_form(plot, "--plot")
    require_ending(write, ".toml", "--write")
    from ..file.doubt import Doubt
    from . import answer, dampers, load, misfire as silent, plot as picture, show as pages

    given = {"--misfire": misfire, "--damper": damper, "--holzer": holzer, "--plot": plot}
    asked = answer.parse_question(speeds, holzer or (), damper, damper_at, damper_inertia, units)
    if write is not None and damper is None:
        raise BalcliError("--write: give the kind of damper to write, with --damper")
    if plot is None and what != "all":
        raise BalcliError(f"--what {what}: give --plot and a file for the picture")
    answer.require_speeds(asked, what)
    if form is Format.HTML:
        _write_sheet(path, asked, answer.parse_half_orders(orders), units, output, given)
        return
    not_firing = silent.ask_misfire(misfire or (), compressing)
    source = load.load_source(path, answer.parse_half_orders(orders), not_firing)
    warn_each(source.doubts, name_file(path))
    with reporting("work") as tell:
        result = answer.answer_question(source, asked, tell)
    sized = result.damper if hasattr(result, "damper") else None
    doubts = (sized and sized.doubts) or ()
    warn_each([Doubt("", message) for message in doubts], "--damper")
    if doubts and damper_inertia is not None:
        warn("--damper-inertia without a unit is in kg mm2")
    warn_each(result.doubts, name_file(path))
    if write is not None and sized is not None:
        refuse_leaving_files(source.text, path, write)
        write_file(dampers.insert_damper(source.text, sized.node, sized.damper), write)
    if plot is not None and drawn is not None:
        write_figure(picture.make_torsion(result, what, SYSTEMS[units]), drawn, plot)
    show([result], pages.RENDERER, form, output, units)


def _write_sheet(
    path: str,
    asked: TorsionQuestion,
    orders: Real | None,
    units: Units,
    output: Path | None,
    given: Mapping[str, object],
) -> None:
    """Write the page for a classification society.

    Args:
        path: Path of the file.
        asked: Request.
        orders: Orders of the excitation; None: the default.
        units: System of units.
        output: File to write; None: standard output.
        given: Options that the page has no use for, by name; None if not given.

    Raises:
        BalcliError: The request has no speeds, or one of these options is given.
    """
    from . import class_sheet, load

    if asked.speeds_rpm is None:
        raise BalcliError("--format html: give the range of speeds, such as --speeds 1000:2500:10")
    for option, value in given.items():
        if value:
            raise BalcliError(
                f"--format html: leave {option} out; the page has its own tables, pictures and the "
                "worst misfire, and the dampers that the file has"
            )
    source = load.load_source(path, orders)
    warn_each(source.doubts, name_file(path))
    with reporting("work") as tell:
        cases = class_sheet.make_cases(source, asked, tell)
    warn_each(cases.firing.doubts, name_file(path))
    file = class_sheet.SheetFile(name_file(path), source.text)
    emit(class_sheet.write_sheet(cases, source, file, SYSTEMS[units]), output)
