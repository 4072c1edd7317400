"""`balcli balance`"""

from __future__ import annotations

from ..render.formats import Format, Units
from ..sizing.schemes import KNUCKLES
from . import balance_options as wishes
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
    scheme: wishes.Scheme = "auto",
    order: wishes.Order = None,
    at: wishes.At = None,
    position: wishes.Position = None,
    planes: wishes.Planes = None,
    factor: wishes.Factor = None,
    roll: wishes.Roll = None,
    radius: wishes.Radius = None,
    thickness: wishes.Thickness = None,
    disc: wishes.Disc = None,
    drill: wishes.Drill = None,
    even: wishes.Even = None,
    grade: wishes.Grade = None,
    mass: wishes.Mass = None,
    write: wishes.Write = None,
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
    from ..results.permitted_unbalance import permit_unbalance
    from .fitted_engine import write_fitted
    from .inputs import read_engine

    wish = wishes.wish_of(order, at, position, planes, factor, roll)
    tools = wishes.shop_tools(radius, thickness, disc, drill)
    asked, rpm = parse_orders(orders), check_speed(speed)
    text, model, engine = read_engine(path, rpm)
    if scheme == KNUCKLES or even is not None:
        result = wishes.knuckles(scheme, wish, even, model, engine, asked)
    else:
        result = balance_engine(engine, scheme, wish, asked, tools)
    result = permit_unbalance(result, grade, mass)
    if write is not None:
        write_fitted(path, text, result.remedy, write, rpm)
    show([result], renderer, form, output, units)
