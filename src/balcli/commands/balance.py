"""`balcli balance`"""

from __future__ import annotations

from dataclasses import replace

from ..enginefile.edit import set_keys
from ..enginefile.toml_text import name_file
from ..render.formats import Units
from ..sizing.schemes import KNUCKLES
from . import balance_options, scheme_options
from .amounts import read_mass
from .file_names import require_ending
from .options import EnginePath, Orders, Output, Speed, UnitsOption, parse_orders, parse_speed
from .output import refuse_leaving_files, refuse_overwriting, write_file
from .scheme_options import choose_scheme, parse_scheme_options


def balance(
    path: EnginePath,
    scheme: balance_options.Scheme = None,
    _schemes: balance_options.Schemes = False,
    order: scheme_options.Order = None,
    at: scheme_options.At = None,
    position: scheme_options.Position = None,
    planes: scheme_options.Planes = None,
    factor: scheme_options.Factor = None,
    measured: scheme_options.Measured = None,
    roll: scheme_options.Roll = None,
    radius: balance_options.Radius = None,
    thickness: balance_options.Thickness = None,
    disc: balance_options.Disc = None,
    drill: balance_options.Drill = None,
    max_depth: balance_options.MaxDepth = None,
    slug: balance_options.Slug = None,
    even: balance_options.Even = None,
    grade: balance_options.Grade = None,
    mass: balance_options.Mass = None,
    write: balance_options.Write = None,
    speed: Speed = None,
    orders: Orders = None,
    form: balance_options.FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Size counterweights, balancer shafts or sliders, and show what is left with them.

    \b
    Examples:
      balcli balance i4.toml --scheme two-shaft --at=-60,80
      balcli balance v8.toml --factor 51% --planes=-8.5in,9in --format card
      balcli balance v8.toml --factor 50%:54%:1% --planes ends
      balcli balance v8.toml --factor 51% --planes ends --drill 19 --max-depth 32
      balcli balance twin.toml --measured "812 g"
    """
    refuse_overwriting(reads=[path], writes={"--output": output, "--write": write})
    form = balance_options.choose_balance_format(output, form)
    require_ending(write, ".toml", "--write")
    from ..results.balance import balance as balance_engine
    from ..results.balance import permit_unbalance
    from ..sizing.write import insert_remedy
    from .inputs import read_engine

    options = parse_scheme_options(order, at, position, planes, factor, measured, roll, units)
    usual = "factor" if form is balance_options.BalanceFormat.CARD else "auto"
    scheme = choose_scheme(scheme, options, usual)
    lengths = {"radius": radius, "thickness": thickness, "disc": disc, "drill": drill}
    tools = balance_options.parse_tools(units, slug, **lengths, max_depth=max_depth)
    grade_mm_s = balance_options.parse_grade(grade)
    mass_kg = None if mass is None else read_mass("--mass", mass, units)
    asked, rpm = parse_orders(orders), parse_speed(speed)
    text, model, engine = read_engine(path, rpm)
    if scheme == KNUCKLES or even is not None:
        result = balance_options.answer_knuckles(scheme, options, even, model, engine, asked)
    else:
        result = balance_engine(engine, scheme, options, asked, tools)
    permitted = permit_unbalance(result.remedy, grade_mm_s, mass_kg, float(engine.speed_rpm))
    result = replace(result, permitted=permitted)
    if write is not None:
        refuse_leaving_files(text, path, write)
        new = insert_remedy(text, result.remedy, name_file(path))
        if rpm is not None:
            new = set_keys(new, "operation", {"speed": rpm}, "as balanced by balcli")
        write_file(new, write)
    balance_options.show_balance(result, form, output, units)
