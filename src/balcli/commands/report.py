"""`balcli report`"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..enginefile.toml_text import name_file
from ..errors import BalcliError, warn
from ..forces.kinds import KINDS
from ..render.formats import Units
from ..render.units import SYSTEMS
from .file_names import choose_target, format_of, parse_output
from .options import (
    EnginePath,
    Orders,
    Scheme,
    Speed,
    Target,
    UnitsOption,
    parse_orders,
    parse_speed,
)
from .output import emit
from .overwrite_guard import refuse_overwriting
from .progress import reporting

if TYPE_CHECKING:
    from ..engine.build import Engine
    from ..enginefile.model import EngineFile
    from ..mounting.report import MountReport
    from ..torque.pictures import Running
    from ..torsion.analysis import TorsionAnalysis

Page = Annotated[
    Path | None,
    typer.Option(
        "--output",
        "-o",
        metavar="OUT.html",
        help="Write the page here; - is standard output.",
        show_default=False,
    ),
]


def report(
    path: EnginePath,
    target: Target = None,
    output: Page = None,
    scheme: Scheme = "auto",
    speed: Speed = None,
    orders: Orders = None,
    units: UnitsOption = Units.SI,
) -> None:
    """Write one self-contained page: the engine in motion, what it shakes, and a balance scheme
    before and after.
    """
    refuse_overwriting(reads=[path], writes={"OUT": target, "--output": output})
    output = parse_output(choose_target(target, output, "X.html"))
    format_of(output, None, {".html": "html", ".htm": "html"}, "html")
    from ..render.html import page
    from ..results.analysis import analyze
    from ..results.balance import balance
    from .inputs import read_engine

    asked = parse_orders(orders)
    _, model, engine = read_engine(path, parse_speed(speed))
    shown = {*KINDS, "peak", *(["gas"] if engine.gas is not None else [])}
    result = analyze(engine, asked, shown)
    balanced = balance(engine, scheme or "auto", orders=asked)
    mounted = _put_on_mounts(model, engine, scheme, name_file(path)) if model.body else None
    twisted = _twist(model, engine, name_file(path)) if model.torsion else None
    turning = None if engine.gas is None else _turn_gas(engine)
    with reporting("pictures") as tell:
        text = page(result, balanced, SYSTEMS[units], mounted, twisted, turning, tell)
    emit(text, output)


def _turn_gas(engine: Engine) -> Running:
    """What runs with the crank."""
    from ..torque.pictures import compute_running

    return compute_running(engine)


def _twist(model: EngineFile, engine: Engine, name: str) -> TorsionAnalysis | None:
    """How its crankshaft twists; None, with a warning, where that cannot be told."""
    from ..torsion.analysis import Question, analyze_torsion
    from ..torsion.load import make_source
    from ..torsion.quantity import choose_speeds

    try:
        source = make_source(model, engine, name)
        return analyze_torsion(source, Question(choose_speeds(engine)))
    except BalcliError as error:
        warn(f"the page does not show the torsion: {error}")
        return None


def _put_on_mounts(
    model: EngineFile, engine: Engine, scheme: str | None, name: str
) -> MountReport | None:
    """What the body does on its mounts; None, with a warning, where that cannot be told."""
    from ..mounting.report import report_mounts

    try:
        return report_mounts(model, engine, scheme=scheme, name=name)
    except BalcliError as error:
        warn(f"the page does not show the mounts: {error}")
        return None
