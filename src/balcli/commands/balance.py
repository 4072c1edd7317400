"""`balcli balance`"""

from __future__ import annotations

from ..sizing.schemes import KNUCKLES
from . import balance_options as wishes
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
    write: wishes.Write = None,
    speed: Speed = None,
    orders: Orders = None,
    format: FormatOption = Format.TABLE,  # noqa: A002 (the option's name)
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Size counterweights, balancer shafts or sliders, and show what is left with them."""
    from ..engine.load import parse
    from ..enginefile.read import name_file
    from ..render.formats import balances
    from ..results.balance import balance as balanced
    from .fitted_engine import write_fitted
    from .inputs import engine_and_text
    from .output import emit

    wish, tools = (
        wishes.wish_of(order, at, position, planes, factor, roll),
        wishes.shop_tools(radius, thickness, disc, drill),
    )
    asked = order_list(orders)
    text, engine = engine_and_text(file, rpm := checked_speed(speed))
    if scheme == KNUCKLES or even is not None:
        result = wishes.knuckles(scheme, wish, even, parse(text, name_file(file)), engine, asked)
    else:
        result = balanced(engine, scheme, wish, asked, tools)
    shown = balances(result, format, units, into_file=output is not None)
    if write is not None:
        write_fitted(file, text, result.remedy, write, rpm)
    emit(shown, output)
