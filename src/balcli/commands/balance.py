"""`balcli balance`"""

from __future__ import annotations

from ..sizing.schemes import KNUCKLES
from . import balance_options as asked
from .options import (
    EngineFile,
    Format,
    FormatOption,
    Orders,
    Output,
    Speed,
    Units,
    UnitsOption,
    checked_speed,
    order_list,
)


def balance(
    file: EngineFile,
    scheme: asked.Scheme = "auto",
    order: asked.Order = None,
    at: asked.At = None,
    position: asked.Position = None,
    planes: asked.Planes = None,
    factor: asked.Factor = None,
    roll: asked.Roll = None,
    radius: asked.Radius = None,
    thickness: asked.Thickness = None,
    disc: asked.Disc = None,
    drill: asked.Drill = None,
    even: asked.Even = None,
    write: asked.Write = None,
    speed: Speed = None,
    orders: Orders = None,
    format: FormatOption = Format.TABLE,  # noqa: A002 (the option's name)
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Size counterweights, balancer shafts or sliders, and show what is left with them."""
    from ..engine.load import name_of, parse
    from ..render.formats import balances
    from ..results.balance import balance as balance_engine
    from .fitted_engine import write_fitted
    from .inputs import engine_and_text
    from .output import emit

    options = asked.parse_scheme_options(order, at, position, planes, factor, roll)
    tools = asked.parse_tools(radius, thickness, disc, drill)
    wanted = order_list(orders)
    text, engine = engine_and_text(file, rpm := checked_speed(speed))
    if scheme == KNUCKLES or even is not None:
        model = parse(text, name_of(file))
        result = asked.balance_knuckles(scheme, options, even, model, engine, wanted)
    else:
        result = balance_engine(engine, scheme, options, wanted, tools)
    shown = balances(result, format, units, into_file=output is not None)
    if write is not None:
        write_fitted(file, text, result.remedy, write, rpm)
    emit(shown, output)
