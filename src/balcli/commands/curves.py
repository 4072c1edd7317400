"""`balcli curves`: numbers over the crank angle."""

from __future__ import annotations

from typing import Annotated, assert_never

import typer

from ..render.csv import csv_text
from ..render.json import json_text
from .amounts import read_angle
from .declare import optional
from .file_names import SERIES, SeriesFormat, format_of
from .format_names import format_option
from .options import EnginePath, Output, Speed, parse_speed
from .output import emit
from .overwrite_guard import refuse_overwriting

Cylinder = Annotated[
    int | None,
    optional(
        "N",
        "Piston travel, velocity, acceleration and rod angle of this one; with [gas] over its "
        "whole cycle, also pressure, volume, forces and torque.",
        "--cylinder",
    ),
]
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
    """Force, moment, couple, torque and roll over the crank angle, or the motion of one piston."""
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = format_of(output, form, SERIES, SeriesFormat.CSV)
    from ..forces.curves import compute_cylinder_curves, compute_engine_curves, divide_revolution
    from ..render import curves as renderer
    from .inputs import read_engine

    engine = read_engine(path, parse_speed(speed), None if cylinder is None else ()).engine
    turns = engine.period_revolutions if cylinder is None else engine.cycle_revolutions
    angles = divide_revolution(read_angle("--step", step), turns)
    if cylinder is None:
        found = compute_engine_curves(engine, angles)
    else:
        found = compute_cylinder_curves(engine, cylinder, angles)
    if cylinder is not None and engine.gas is not None:
        from ..torque.cylinder_curves import add_gas_curves

        found = add_gas_curves(engine, cylinder, found)
    match form:
        case SeriesFormat.CSV:
            text = csv_text([renderer.rows(found)])
        case SeriesFormat.JSON:
            text = json_text(renderer.document(found))
        case _:
            assert_never(form)
    emit(text, output)
