"""`balcli curves`: numbers over the crank angle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, assert_never

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

if TYPE_CHECKING:
    from ..core.phasors import Array
    from ..engine.build import Engine
    from ..forces.curves import Curves

Cylinder = Annotated[
    int | None,
    optional(
        "N",
        "Piston travel, velocity, acceleration and rod angle of this one; with [gas] also "
        "pressure, volume, forces and torque.",
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
    """Force, moment, couple, torque and roll over the crank angle, or the motion of one piston.

    With [gas] over the whole cycle, its torque too.
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = format_of(output, form, SERIES, SeriesFormat.CSV)
    from ..forces.curves import divide_revolution
    from ..render import curves as renderer
    from .inputs import read_engine

    engine = read_engine(path, parse_speed(speed), None if cylinder is None else ()).engine
    angles = divide_revolution(read_angle("--step", step), engine.cycle_revolutions)
    found = _compute(engine, cylinder, angles)
    match form:
        case SeriesFormat.CSV:
            text = csv_text([renderer.rows(found)])
        case SeriesFormat.JSON:
            text = json_text(renderer.document(found))
        case _:
            assert_never(form)
    emit(text, output)


def _compute(engine: Engine, cylinder: int | None, crank_deg: Array) -> Curves:
    """Curves of the engine, or of one of its cylinders, with gas if it has some."""
    from ..forces.curves import compute_cylinder_curves, compute_engine_curves

    if cylinder is None:
        found = compute_engine_curves(engine, crank_deg)
    else:
        found = compute_cylinder_curves(engine, cylinder, crank_deg)
    if engine.gas is None:
        return found
    from ..torque.curves import add_cylinder_gas, add_gas_torque

    if cylinder is None:
        return add_gas_torque(engine, found)
    return add_cylinder_gas(engine, cylinder, found)
