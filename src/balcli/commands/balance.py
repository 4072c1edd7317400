"""`balcli balance`"""
from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import EngineFile, Format, FormatOption, Orders, Output, Speed, Units, UnitsOption, checked_speed, order_list
from .wishes import shop_tools, wish_of


def balance(
    file: EngineFile,
    scheme: Annotated[str, typer.Option("--scheme", "--with", metavar="NAME", help="What to fit: auto, counterweights, factor, minimax, "
        "single-shaft, two-shaft, four-shaft, couple-shaft, slider, eccentric-slider, oldham.")] = "auto",
    order: Annotated[int | None, typer.Option(metavar="N", help="Order to balance; default: the lowest that is free.", show_default=False)] = None,
    at: Annotated[list[str] | None, typer.Option(metavar="X,Y", help="Place of the shaft against the crank, mm; given twice: of both shafts.",
                                                    show_default=False)] = None,
    position: Annotated[str | None, typer.Option(metavar="Z", help="Axial place of new shafts, mm.", show_default=False)] = None,
    planes: Annotated[str | None, typer.Option(metavar="ends|throws|Z,Z...", help="Where counterweights stand.", show_default=False)] = None,
    factor: Annotated[str | None, typer.Option(metavar="K|K:K:STEP", help="Share of the reciprocating mass.", show_default=False)] = None,
    roll: Annotated[str | None, typer.Option(metavar="zero", help="two-shaft: place the second such that no roll is left.", show_default=False)] = None,
    radius: Annotated[float | None, typer.Option(metavar="MM", help="Radius at which masses are stated; default: crank radius.",
                                                    show_default=False)] = None,
    thickness: Annotated[float | None, typer.Option(metavar="MM", help="Of a semicircular steel disc; default: 20.", show_default=False)] = None,
    disc: Annotated[float | None, typer.Option(metavar="MM", help="Its radius, instead.", show_default=False)] = None,
    drill: Annotated[float | None, typer.Option(metavar="MM", help="Drill for a correction at --radius.", show_default=False)] = None,
    write: Annotated[Path | None, typer.Option("--write", metavar="OUT.toml", help="Write the engine with the devices fitted.",
                                                  show_default=False)] = None,
    speed: Speed = None,
    orders: Orders = None,
    format: FormatOption = Format.TABLE,                                    # noqa: A002 (the option's name)
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Size counterweights, balancer shafts or sliders, and show what is left with them."""
    from ..balancing import balance as balanced
    from ..render.formats import balances
    from .output import emit
    from .several import engine_and_text
    from .writing import write_fitted

    wish, tools = wish_of(order, at, position, planes, factor, roll), shop_tools(radius, thickness, disc, drill)
    asked = order_list(orders)
    text, engine = engine_and_text(file, checked_speed(speed))
    result = balanced(engine, scheme, wish, asked, tools)
    shown = balances(result, format, units, into_file=output is not None)
    if write is not None:
        write_fitted(file, text, result.remedy, write)
    emit(shown, output)
