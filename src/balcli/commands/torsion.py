"""`balcli torsion`"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ..render.formats import Units
from .declare import optional
from .file_names import picture_form, require_ending, text_format
from .options import FormatOption, Misfire, Output, ProgressAtOnce, UnitsOption
from .output import refuse_leaving_files, refuse_overwriting, show, write_figure, write_file


class DamperKind(StrEnum):
    """Kinds of dampers."""

    VISCOUS = "viscous"
    RUBBER = "rubber"
    PENDULUM = "pendulum"


class TorsionPicture(StrEnum):
    """Which pictures are drawn."""

    ALL = "all"
    MODES = "modes"
    CAMPBELL = "campbell"
    RESPONSE = "response"
    WATERFALL = "waterfall"


def torsion(
    path: Annotated[
        str,
        typer.Argument(
            metavar="FILE",
            help="Engine file with [torsion], or a chain of inertias and shafts (TOML); - reads "
            "standard input.",
            show_default=False,
        ),
    ],
    speeds: Annotated[
        str | None,
        optional(
            "A:B:STEP",
            "Forced vibration at these speeds, rpm; or a list such as 1500,2000.",
            "--speeds",
            "--speed",
        ),
    ] = None,
    orders: Annotated[
        str | None,
        optional(
            "0.5-12|1,2.5",
            "Orders that excite, 0.5-8 with halves, 1-8 whole ones; default: all of a chain, "
            "to 12 of an engine.",
        ),
    ] = None,
    holzer: Annotated[
        list[str] | None,
        optional(
            "MODE|FREQUENCY",
            'Holzer\'s table of a mode, or at "20 rad/s", "12 Hz"; may be given again.',
        ),
    ] = None,
    misfire: Misfire = None,
    damper: Annotated[
        DamperKind | None,
        typer.Option(
            show_default=False,
            help="Size a damper that makes the largest stress over --speeds least.",
        ),
    ] = None,
    damper_at: Annotated[
        str | None, optional("NAME", "What carries it; default: the foremost part.")
    ] = None,
    damper_inertia: Annotated[
        str | None,
        optional(
            "KGMM2",
            "Its ring, or its pendulums about the axis; default: that in the file, or a usual "
            "share.",
        ),
    ] = None,
    write: Annotated[Path | None, optional("FILE", "Write the file with the damper here.")] = None,
    plot: Annotated[Path | None, optional("FILE", "Draw pictures; .svg, .png or .pdf.")] = None,
    what: Annotated[
        TorsionPicture, typer.Option(help="Which, with --plot; the last two take --speeds.")
    ] = TorsionPicture.ALL,
    progress: ProgressAtOnce = False,
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
    form = text_format(output, form)
    drawn = None if plot is None else picture_form(plot, "--plot")
    require_ending(write, ".toml", "--write")
    from ..render import torsion as renderer
    from . import torsion_answer as answers

    asked = answers.parse_question(speeds, orders, holzer, damper, damper_at, damper_inertia, units)
    answers.require_options(asked, write, plot, what)
    source, result = answers.find_answer(path, asked, misfire or (), progress)
    if write is not None:
        refuse_leaving_files(source.text, path, write)
        write_file(answers.write_damper(source, result), write)
    if plot is not None and drawn is not None:
        write_figure(answers.draw(result, what, units), drawn, plot)
    show([result], renderer, form, output, units)
