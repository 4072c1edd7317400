"""The command `balcli mounts`: its options."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from ..errors import warn
from ..file.toml import name_file
from ..shell import scheme_options
from ..shell.file_names import picture_form, text_format
from ..shell.inputs import name_engines, read_engine, silence_cylinders, warn_each
from ..shell.options import EnginePaths, FormatOption, Misfire, Output, UnitsOption, parse_orders
from ..shell.output import refuse_overwriting, show, write_figure
from ..shell.progress import reporting
from ..shell.scheme_options import choose_beside, parse_scheme_options
from ..shell.values import Speeds, optional, parse_speeds
from ..show.formats import Units
from ..show.units import SYSTEMS

Orders = Annotated[
    str | None, optional("1-8|1,2,4", "Orders to include; default: all with an effect.", "--orders")
]
Plot = Annotated[
    Path | None, optional("FILE", "Draw forces, orders, modes and motion; .svg, .png or .pdf.")
]


def mounts(
    paths: EnginePaths,
    speeds: Speeds = None,
    orders: Orders = None,
    misfire: Misfire = None,
    scheme: scheme_options.Scheme = None,
    order: scheme_options.Order = None,
    at: scheme_options.At = None,
    position: scheme_options.Position = None,
    planes: scheme_options.Planes = None,
    factor: scheme_options.Factor = None,
    measured: scheme_options.Measured = None,
    roll: scheme_options.Roll = None,
    plot: Plot = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Vibration of an engine on its mounts: natural modes, position at rest, forces on the frame
    and motion of points over a range of speeds.

    The file has [body], [[mount]] and, for the motion of points, [[point]]; `balcli new mounts`
    writes one to start from. If it has no engine, only modes and position at rest are printed.
    Engines of further files are placed on the same mounts and compared.

    \b
    Example:
      balcli mounts i4_mounts.toml --speeds 700:6000:50
    """
    refuse_overwriting(reads=paths, writes={"--output": output, "--plot": plot})
    form = text_format(output, form)
    drawn = picture_form(plot, "--plot") if plot is not None else None
    rpm = parse_speeds(speeds)
    asked = parse_orders(orders)
    options = parse_scheme_options(order, at, position, planes, factor, measured, roll, units)
    scheme = choose_beside(scheme, options)
    from . import answer, build, plot as picture, show as pages

    name = name_file(paths[0])
    silent = misfire or ()
    model, engine, doubts = build.read_mounted(paths[0])
    warn_each(doubts, name)
    if engine is not None:
        engine = silence_cylinders(engine, silent, paths[0])
    others = [silence_cylinders(read_engine(path).engine, silent, path) for path in paths[1:]]
    names = name_engines([model.name, *(other.name for other in others)], paths)
    beside = list(zip(names[1:], others, strict=True))
    ranged = speeds is None or ":" in speeds
    with reporting("work") as tell:
        result = answer.report_mounts(
            model, engine, rpm, asked, scheme, beside, name, tell, options, ranged=ranged
        )
    if not hasattr(result, "response") and any((speeds, orders, scheme, misfire)):
        warn(
            f"{name}: has no engine, so --speeds, --orders, --misfire and --scheme have no effect; "
            "add [crank], [rod] and [piston], or name an engine file after this one"
        )
    warn_each(result.doubts, name)
    if plot is not None and drawn is not None:
        write_figure(picture.make_mounts(result, SYSTEMS[units]), drawn, plot)
    show([result], pages.RENDERER, form, output, units)
