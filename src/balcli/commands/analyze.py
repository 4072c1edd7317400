"""`balcli analyze`"""

from __future__ import annotations

from ..render.formats import Units
from . import analysis_options
from .options import (
    EnginePaths,
    GuideHeight,
    Misfire,
    OnlyParts,
    Orders,
    Output,
    UnitsOption,
    Whole,
    parse_guide_height,
    parse_orders,
    parse_parts,
)
from .output import refuse_overwriting


def analyze(
    paths: EnginePaths,
    form: analysis_options.AnalysisFormatOption = None,
    speed: analysis_options.SpeedsOption = None,
    orders: Orders = None,
    only: OnlyParts = None,
    whole: Whole = False,
    by: analysis_options.By = "",
    why: analysis_options.Why = False,
    guide_height: GuideHeight = None,
    misfire: Misfire = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Free forces and moments of an engine, order by order, and what balances them.

    \b
    Examples:
      balcli analyze v8.toml --why
      balcli analyze v8.toml --only xy,roll --orders 1-8
      balcli analyze s50.toml --format marine --speed 60:124:8
    """
    refuse_overwriting(reads=paths, writes={"--output": output})
    chosen, marine = analysis_options.choose_analysis_format(output, form)
    speeds_rpm = analysis_options.parse_analysed_speeds(speed)
    shown = parse_orders(orders)
    by_cylinder = analysis_options.is_by_cylinder(by)
    height_m = parse_guide_height(guide_height, units)
    words, misfires = parse_parts(only), tuple(misfire or ())
    asked = analysis_options.Request(
        speeds_rpm, shown, *words, whole, by_cylinder, why, height_m, misfires, marine
    ).check()
    from .analysis_answer import answer

    answer(paths, asked, chosen, output, units)
