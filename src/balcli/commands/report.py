"""`balcli report`"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ..enginefile.toml_text import name_file
from ..errors import BalcliError, warn
from ..render.formats import Units
from ..render.units import SYSTEMS
from . import scheme_options
from .declare import optional
from .file_names import choose_target, format_of, parse_output
from .options import EnginePath, Orders, Speed, Target, UnitsOption, parse_orders, parse_speed
from .output import emit, refuse_overwriting
from .progress import reporting
from .scheme_options import choose_scheme, parse_scheme_options

if TYPE_CHECKING:
    from ..engine.build import Engine
    from ..enginefile.model import EngineFile
    from ..mounting.records import MountReport
    from ..sizing.options import SchemeOptions
    from ..torsion.analysis import TorsionAnalysis

Page = Annotated[
    Path | None,
    optional("OUT.html", "Write the page here; - is standard output.", "--output", "-o"),
]


def report(
    path: EnginePath,
    target: Target = None,
    output: Page = None,
    scheme: scheme_options.Scheme = None,
    order: scheme_options.Order = None,
    at: scheme_options.At = None,
    position: scheme_options.Position = None,
    planes: scheme_options.Planes = None,
    factor: scheme_options.Factor = None,
    measured: scheme_options.Measured = None,
    roll: scheme_options.Roll = None,
    speed: Speed = None,
    orders: Orders = None,
    units: UnitsOption = Units.SI,
) -> None:
    """Write one self-contained page: the engine in motion, what it shakes, and a balance scheme
    before and after.

    \b
    Example:
      balcli report v8.toml v8.html
    """
    refuse_overwriting(reads=[path], writes={"OUT": target, "--output": output})
    output = parse_output(choose_target(target, output, "X.html"))
    format_of(output, None, {".html": "html", ".htm": "html"}, "html")
    from ..render.html import page
    from ..results.analysis import analyze
    from ..results.balance import balance
    from .inputs import read_engine

    options = parse_scheme_options(order, at, position, planes, factor, measured, roll, units)
    scheme = choose_scheme(scheme, options)
    asked = parse_orders(orders)
    _, model, engine = read_engine(path, parse_speed(speed))
    result = analyze(engine, asked)
    balanced = balance(engine, scheme, options, asked)
    mounted = None
    if model.body:
        fitted = scheme if balanced.remedy.reasons else None  # without devices nothing is compared
        mounted = _put_on_mounts(model, engine, fitted, options, name_file(path))
    twisted = _twist(model, engine, name_file(path)) if model.torsion else None
    turning = None if engine.gas is None else engine
    with reporting("pictures") as tell:
        text = page(result, balanced, SYSTEMS[units], mounted, twisted, turning, tell)
    emit(text, output)


def _twist(model: EngineFile, engine: Engine, name: str) -> TorsionAnalysis | None:
    """How its crankshaft twists; None, with a warning, where that cannot be told."""
    from ..torsion.analysis import TorsionQuestion, answer_question
    from ..torsion.load import make_source
    from ..torsion.quantity import choose_torsion_speeds

    try:
        source = make_source(model, engine, name)
        return answer_question(source, TorsionQuestion(choose_torsion_speeds(engine)))
    except BalcliError as error:
        warn(f"the page does not show the torsion: {error}")
        return None


def _put_on_mounts(
    model: EngineFile, engine: Engine, scheme: str | None, options: SchemeOptions, name: str
) -> MountReport | None:
    """What the body does on its mounts; None, with a warning, where that cannot be told."""
    from ..mounting.report import report_mounts

    try:
        return report_mounts(model, engine, scheme=scheme, name=name, options=options)
    except BalcliError as error:
        warn(f"the page does not show the mounts: {error}")
        return None
