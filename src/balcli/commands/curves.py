"""`balcli curves`: numbers over the crank angle."""

from __future__ import annotations

from typing import Annotated, assert_never

import typer

from ..render.csv import csv_text
from ..render.json import json_text
from .amounts import read_angle
from .declare import optional
from .file_names import SERIES, SeriesFormat, format_of, format_option
from .options import EnginePath, Output, Speed, parse_speed
from .output import emit, refuse_overwriting

Cylinder = Annotated[int | None, optional("N", "Motion of this piston, with [gas] its pressure.")]
Step = Annotated[str, typer.Option("--step", metavar="DEG", help="Step of the crank angle.")]
Form = Annotated[
    SeriesFormat | None,
    format_option(SeriesFormat, "How to write the curves; default: by the ending of -o, else csv."),
]


def curves(
    path: EnginePath,
    cylinder: Cylinder = None,
    step: Step = "1",
    speed: Speed = None,
    form: Form = None,
    output: Output = None,
) -> None:
    """Force, moment, couple, torque and roll over the crank angle, or the motion of one piston.

    With [gas] over the whole cycle, its torque too.

    \b
    Examples:
      balcli curves i4.toml --step 5 -o curves.csv
      balcli curves i4.toml --cylinder 1
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = format_of(output, form, SERIES, SeriesFormat.CSV)
    from ..forces.curves import divide_revolution
    from ..render import curves as renderer
    from ..studies.curves import compute_curves
    from .inputs import read_engine

    engine = read_engine(path, parse_speed(speed), None if cylinder is None else ()).engine
    angles = divide_revolution(read_angle("--step", step), engine.cycle_revolutions)
    found = compute_curves(engine, cylinder, angles)
    match form:
        case SeriesFormat.CSV:
            text = csv_text([renderer.rows(found)])
        case SeriesFormat.JSON:
            text = json_text(renderer.document(found))
        case _:
            assert_never(form)
    emit(text, output)
