"""`balcli curves`: numbers over the crank angle."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from .options import EngineFile, Output, Speed, checked_speed


class CurveFormat(StrEnum):
    """How curves are written."""

    CSV = "csv"
    JSON = "json"


Cylinder = Annotated[
    int | None,
    typer.Option(
        "--cylinder",
        metavar="N",
        show_default=False,
        help="Piston travel, velocity, acceleration and rod angle of this one.",
    ),
]
Step = Annotated[float, typer.Option("--step", metavar="DEG", help="Step of the crank angle.")]
Form = Annotated[CurveFormat, typer.Option("--format", "-f", help="How to write the curves.")]


def curves(
    file: EngineFile,
    cylinder: Cylinder = None,
    step: Step = 1.0,
    speed: Speed = None,
    form: Form = CurveFormat.CSV,
    output: Output = None,
) -> None:
    """Force, moment, couple, torque and roll over the crank angle, or the motion of one piston."""
    from ..forces.curves import compute_cylinder_curves, compute_engine_curves, divide_revolution
    from ..render.curves import curves_csv, curves_json
    from .inputs import engine_of
    from .output import emit

    angles = divide_revolution(step)
    _, engine = engine_of(file, checked_speed(speed))
    found = (
        compute_engine_curves(engine, angles)
        if cylinder is None
        else compute_cylinder_curves(engine, cylinder, angles)
    )
    emit(curves_json(found) if form is CurveFormat.JSON else curves_csv(found), output)
