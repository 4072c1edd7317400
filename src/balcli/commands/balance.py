"""`balcli balance`"""

from __future__ import annotations

from ..render.formats import Format, Units
from ..sizing.schemes import KNUCKLES
from . import balance_options as asked
from .options import (
    EnginePath,
    FormatOption,
    Orders,
    Output,
    Speed,
    UnitsOption,
    check_speed,
    parse_orders,
)
from .output import show
from .overwrite_guard import refuse_overwriting


def balance(
    path: EnginePath,
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
    form: FormatOption = Format.TABLE,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Size counterweights, balancer shafts or sliders, and show what is left with them."""
    refuse_overwriting(reads=[path], writes={"--output": output, "--write": write})
    from ..render import balance as renderer
    from ..results.balance import balance as balance_engine
    from .fitted_engine import write_fitted
    from .inputs import read_engine

    options = asked.parse_scheme_options(order, at, position, planes, factor, roll)
    tools = asked.parse_tools(radius, thickness, disc, drill)
    shown, rpm = parse_orders(orders), check_speed(speed)
    text, model, engine = read_engine(path, rpm)
    if scheme == KNUCKLES or even is not None:
        result = asked.balance_knuckles(scheme, options, even, model, engine, shown)
    else:
        result = balance_engine(engine, scheme, options, shown, tools)
    if write is not None:
        write_fitted(path, text, result.remedy, write, rpm)
    show([result], renderer, form, output, units)
