"""The commands `analyze`, `compare`, `curves` and `sum`."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from ..errors import BalcliError
from ..file.units import ANGLE
from ..shell.file_names import (
    SERIES,
    format_of,
    format_option,
    require_ending,
    text_format,
)
from ..shell.inputs import name_engines, named_by_file, read_engine
from ..shell.options import (
    OF_ONE,
    EnginePath,
    EnginePaths,
    FormatOption,
    GuideHeight,
    Misfire,
    Only,
    OnlyParts,
    Orders,
    Output,
    Small,
    Speed,
    UnitsOption,
    Whole,
    parse_guide_height,
    parse_only,
    parse_orders,
    parse_parts,
    parse_small,
    parse_speed,
)
from ..shell.output import emit, refuse_overwriting, show, write_file
from ..shell.values import optional, parse_cylinder, read_figure, read_lengths
from ..show.formats import Format, Units, csv_text, json_text
from . import options as analysis_options


def analyze(
    paths: EnginePaths,
    form: analysis_options.AnalysisFormatOption = None,
    speed: analysis_options.SpeedsOption = None,
    orders: Orders = None,
    only: OnlyParts = None,
    whole: Whole = False,
    by: analysis_options.By = None,
    why: analysis_options.Why = False,
    guide_height: GuideHeight = None,
    misfire: Misfire = None,
    small: Small = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Free forces and moments of an engine, order by order, and devices that balance them.

    \b
    Examples:
      balcli analyze v8.toml --why
      balcli analyze v8.toml --only xy,roll --orders 1-8
      balcli analyze s50.toml --format marine --speed 60:124:8
    """
    refuse_overwriting(reads=paths, writes={"--output": output})
    chosen, marine = analysis_options.choose_analysis_format(output, form)
    asked = analysis_options.Request(
        analysis_options.parse_analysed_speeds(speed),
        parse_orders(orders),
        *parse_parts(only),
        whole,
        by,
        why,
        parse_guide_height(guide_height, units),
        tuple(misfire or ()),
        marine,
        parse_small(small),
    ).check()
    from .ask import answer

    answer(paths, asked, chosen, output, units)


def compare(
    paths: EnginePaths,
    form: FormatOption = None,
    speed: Speed = None,
    orders: Orders = None,
    only: Only = None,
    whole: Whole = False,
    small: Small = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Engines side by side: free forces and moments by order, peaks, and their ratios to the first
    engine's.

    \b
    Example:
      balcli compare i4.toml v8.toml --only force,moment
    """
    refuse_overwriting(reads=paths, writes={"--output": output})
    form = text_format(output, form)
    from .comparison import RENDERER, compare as compare_engines

    rpm = parse_speed(speed)
    asked = parse_orders(orders)
    chosen = parse_only(only)
    _refuse_parts(chosen or (), paths)
    engines = [read_engine(path, rpm, chosen).engine for path in paths]
    names = name_engines([engine.name for engine in engines], paths)
    least = parse_small(small)
    comparison = compare_engines(
        *engines, names=names, orders=asked, only=chosen, all=whole, small=least
    )
    show([comparison], RENDERER, form, output, units)


def _refuse_parts(words: Sequence[str], paths: Sequence[str]) -> None:
    """Reject words of `--only` that ask for results on a single engine.

    Raises:
        BalcliError: There is such a word; the error names the command that shows its results.
    """
    if of_one := [word for word in words if word in OF_ONE]:
        command = shlex.join(["balcli", "analyze", *paths, "--only", of_one[0]])
        raise BalcliError(f"--only {of_one[0]} describes a single engine; {command} shows it")


Cylinder = Annotated[
    str | None, optional("N|NAME.N", "Motion of one cylinder's piston; with [gas], also pressure.")
]
Step = Annotated[str, typer.Option("--step", metavar="DEG", help="Step of the crank angle.")]
SumOrders = Annotated[str | None, optional("1-8|1,3", "Only the sum of these orders.", "--orders")]
Form = Annotated[
    Format | None,
    format_option(
        SERIES.values(), "How to write the curves; default: by the ending of -o, else csv."
    ),
]


def curves(
    path: EnginePath,
    cylinder: Cylinder = None,
    step: Step = "1",
    orders: SumOrders = None,
    speed: Speed = None,
    form: Form = None,
    output: Output = None,
) -> None:
    """Force, moment, couple, torque and roll over the crank angle, or the motion of one piston.

    With [gas], the curves span the whole cycle and include the torque of the gas.

    \b
    Examples:
      balcli curves i4.toml --step 5 -o curves.csv
      balcli curves i4.toml --cylinder 1
      balcli curves i4.toml --orders 2
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = format_of(output, form, SERIES, Format.CSV)
    from . import curves as chapter

    asked = parse_orders(orders)
    step_deg = read_figure("step", step, ANGLE)
    engine = read_engine(path, parse_speed(speed), None if cylinder is None else ()).engine
    number = None if cylinder is None else parse_cylinder(cylinder)
    curves = chapter.compute_curves_by_step(engine, number, step_deg, asked)
    if form is Format.CSV:
        text = csv_text([chapter.rows(curves)])
    else:
        text = json_text(chapter.RENDERER.document(curves))
    emit(text, output)


def piston(
    path: EnginePath,
    cylinder: Annotated[int | None, optional("N", "Only this cylinder.")] = None,
    speed: Speed = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Motion of the pistons: strokes, dead centres, speeds and accelerations, exact and by the
    two-term formulas.

    \b
    Examples:
      balcli piston i4.toml
      balcli piston vr6.toml --cylinder 2 -f json
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    from . import piston as chapter

    motion = chapter.piston(read_engine(path, parse_speed(speed), ()).engine)
    if cylinder is not None:
        motion = chapter.choose_cylinder(motion, cylinder)
    show([motion], chapter.RENDERER, form, output, units)


Phase = Annotated[
    str,
    typer.Option(
        metavar="DEG",
        help="Angle of the second crank, from its own engine's x axis, when the first crank is at "
        "0: with --turn 90, both cranks point the same way at --phase -90.",
    ),
]
At = Annotated[str, typer.Option(metavar="X,Y,Z", help="Place of the second engine's origin, mm.")]
Turn = Annotated[
    str, typer.Option(metavar="DEG", help="Angle by which the second engine is turned about z.")
]
Reverse = Annotated[bool, typer.Option("--reverse", help="The second crank turns the other way.")]
Write = Annotated[Path | None, optional("OUT.toml", "Write a file with both as [[engine]] tables.")]
LoadOption = Annotated[
    str, typer.Option(metavar="first|second|both", help="With --reverse: the crank with the load.")
]


def sum(  # noqa: A001 (the command's name)
    first: EnginePath,
    second: EnginePath,
    phase: Phase = "0",
    at: At = "0,0,0",
    turn: Turn = "0",
    reverse: Reverse = False,
    load: LoadOption = "first",
    write: Write = None,
    speed: Speed = None,
    orders: Orders = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Two engines on one frame, geared one to one: H, U and opposed-piston engines. A file with
    [[engine]] can describe the same two engines; --write writes this file.

    \b
    Examples:
      balcli sum i4.toml i4.toml --phase 90 --at 300,0,0
      balcli sum i4.toml i4.toml --phase 90 --at 300,0,0 --write h8.toml
    """
    paths = [first, second]
    refuse_overwriting(reads=paths, writes={"--output": output, "--write": write})
    form = text_format(output, form)
    require_ending(write, ".toml", "--write")
    from .two_engines import RENDERER, Arrangement, combine_engines, describe_file

    rpm = parse_speed(speed)
    asked = parse_orders(orders)
    x, y, z = read_lengths("at", at, "three numbers, X,Y,Z in mm, such as 0,300,0", 3, units)
    lead = read_figure("phase", phase, ANGLE)
    turned = read_figure("turn", turn, ANGLE)
    arrangement = Arrangement(lead, (x, y, z), turned, reverse, load)
    engines = [named_by_file(read_engine(path, rpm).engine, path) for path in paths]
    result = combine_engines(engines[0], engines[1], arrangement, asked)
    if write is not None:
        write_file(describe_file(result, paths, write, rpm), write)
    show([result], RENDERER, form, output, units)
