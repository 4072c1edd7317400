"""Options of `balance`, and what the schemes understand of them (SI)."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.drilled_hole import SLUGS
from ..errors import BalcliError, note
from ..limits import MOST_FACTORS
from ..render.formats import Format, Units
from ..sizing.options import SchemeOptions
from ..sizing.schemes import KNUCKLES, MEANINGS, NAMES, SCHEMES
from .amounts import is_bare, read_length, read_lengths, read_mass, read_number, read_share
from .completion import complete_schemes
from .file_names import format_of, text_format
from .format_names import format_option
from .output import emit, show

if TYPE_CHECKING:
    from ..engine.build import Engine
    from ..enginefile.model import EngineFile
    from ..results.balance import Balance
    from ..sizing.workshop import Tools


class BalanceFormat(StrEnum):
    """How a balance is written: as all results, or as a bobweight card."""

    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    MARKDOWN = "markdown"
    CARD = "card"


FormatOption = Annotated[
    BalanceFormat | None,
    format_option(
        BalanceFormat,
        "How to write the result, md for short of markdown; default: by the ending of -o (.txt, "
        ".json, .csv, .md), else table. card: a page for the wall of a shop, per pin, in g and oz.",
    ),
]
Scheme = Annotated[
    str | None,
    typer.Option(
        "--scheme",
        "--with",
        metavar="NAME",
        autocompletion=complete_schemes,
        show_default="auto; factor where --factor or --measured is given",
        help=f"What to fit: {', '.join(NAMES[:-1])} or {NAMES[-1]}; --schemes explains them.",
    ),
]


def _list_schemes(wanted: bool) -> None:
    """Print what each scheme does and which options it takes, and end."""
    if not wanted:
        return
    width = max(map(len, MEANINGS))
    lines = []
    for name, meaning in MEANINGS.items():
        options = " ".join(f"--{option}" for option in SCHEMES.get(name, ("even",)))
        lines.append(f"{name:{width}}  {meaning}")
        lines += [f"{'':{width}}    {options}"] if options else []
    emit("\n".join(lines))
    raise typer.Exit


Schemes = Annotated[
    bool,
    typer.Option(
        "--schemes",
        callback=_list_schemes,
        is_eager=True,
        help="Say what each scheme does and which options it takes.",
    ),
]
Order = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        show_default=False,
        help=(
            "Order to balance; default: the lowest that has what the scheme takes (single-shaft: a "
            "force turning against the crank); a note says what it leaves at lower ones."
        ),
    ),
]
At = Annotated[
    list[str] | None,
    typer.Option(
        metavar="X,Y",
        show_default=False,
        help=(
            "Place in mm of the shaft; of a pair, of the one turning against the crank. Given "
            "twice: of that one, then of the other."
        ),
    ),
]
Position = Annotated[
    str | None,
    typer.Option(metavar="Z", show_default=False, help=("Axial place of new devices, mm.")),
]
Planes = Annotated[
    str | None,
    typer.Option(
        metavar="ends|throws|Z,Z...",
        show_default=False,
        help=(
            "Where along the crank: at its end throws, at every throw, or at these z in mm. With a "
            "factor the default is where the counterweights of the file stand, else every throw."
        ),
    ),
]
Factor = Annotated[
    str | None,
    typer.Option(
        metavar="K|K:K:STEP",
        show_default=False,
        help=(
            "Share of the reciprocating mass that counterweights take, such as 51% or 0.51; "
            "default 50%. A range such as 50%:54%:1% gives a table, and fits the best."
        ),
    ),
]
Measured = Annotated[
    str | None,
    typer.Option(
        metavar="MASS",
        show_default=False,
        help=(
            'Instead of --factor: what balances each bare pin, such as "812 g" (a bare number is '
            "g): says which factor that is."
        ),
    ),
]
Roll = Annotated[
    str | None,
    typer.Option(
        metavar="zero",
        show_default=False,
        help=("Place two shafts such that they cancel the roll of this order, too."),
    ),
]
Radius = Annotated[
    str | None,
    typer.Option(
        metavar="MM",
        show_default=False,
        help="Radius at which masses are stated, in mm or as '2.5 in'; default: crank radius.",
    ),
]
Thickness = Annotated[
    str | None,
    typer.Option(
        metavar="MM",
        show_default=False,
        help=("Thickness of the semicircular steel discs that are stated; default 20."),
    ),
]
Disc = Annotated[
    str | None,
    typer.Option(
        metavar="MM",
        show_default=False,
        help=("Radius of those discs, instead of their thickness."),
    ),
]
Drill = Annotated[
    str | None,
    typer.Option(
        metavar="MM",
        show_default=False,
        help=(
            "Diameter of a drill: also say where radial holes from --radius inwards belong, how "
            "many and how deep, to remove as much."
        ),
    ),
]
MaxDepth = Annotated[
    str | None,
    typer.Option(
        metavar="MM",
        show_default=False,
        help="Deepest hole, for --drill; default: to the axis of the crank.",
    ),
]
Slug = Annotated[
    str | None,
    typer.Option(
        metavar="METAL",
        show_default=False,
        help=(
            "With --drill: fill the holes with slugs of tungsten (heavy alloy, 17 g/cm3), lead, or "
            "of a density in g/cm3: they add weight where drilling would remove it."
        ),
    ),
]
Even = Annotated[
    str | None,
    typer.Option(
        "--even",
        metavar="dead-centres|strokes",
        show_default=False,
        help="What --scheme knuckles makes even; default: dead-centres.",
    ),
]
Grade = Annotated[
    str | None,
    typer.Option(
        metavar="G",
        show_default=False,
        help="Balance quality grade of ISO 21940-11, such as G16: say what may be left beside each "
        "counterweight.",
    ),
]
Mass = Annotated[
    str | None,
    typer.Option(
        metavar="KG",
        show_default=False,
        help="Mass of the crankshaft as it is balanced, for --grade.",
    ),
]
Write = Annotated[
    Path | None,
    typer.Option(
        "--write",
        metavar="OUT.toml",
        show_default=False,
        help="Write the engine with the devices fitted, and with the speed of --speed.",
    ),
]


def parse_scheme_options(
    order: int | None,
    at: Sequence[str] | None,
    position: str | None,
    planes: str | None,
    factor: str | None,
    measured: str | None,
    roll: str | None,
    units: Units,
) -> SchemeOptions:
    """What a scheme is asked for, in SI; BalcliError for a text that says nothing, with the
    text.
    """
    return SchemeOptions(
        order=order,
        at=tuple(_parse_place(text, units) for text in at) if at else None,
        position=None if position is None else _parse_position(position, units),
        planes=None if planes is None else _parse_planes(planes, units),
        factor=None if factor is None else _parse_factors(factor),
        measured=None if measured is None else _parse_measured(measured, units),
        roll=roll,
    )


def choose_format(output: Path | None, asked: BalanceFormat | None) -> BalanceFormat:
    """How to write the balance; errors as `file_names.format_of`."""
    if asked is BalanceFormat.CARD:
        return format_of(output, asked, {".txt": asked}, asked)
    plain = None if asked is None else Format(asked)
    return BalanceFormat(text_format(output, plain))


def choose_scheme(asked: str | None, options: SchemeOptions, form: BalanceFormat) -> str:
    """The scheme asked for; without one `factor` for a factor or a card, else `auto`."""
    if asked is not None:
        return asked
    by_factor = options.factor is not None or options.measured is not None
    return "factor" if by_factor or form is BalanceFormat.CARD else "auto"


def show_balance(result: Balance, form: BalanceFormat, output: Path | None, units: Units) -> None:
    """The balance, or its bobweight card, in this format."""
    for reason in dict.fromkeys(result.remedy.reasons):
        note(f"scheme {result.remedy.scheme}: {reason}")
    if form is BalanceFormat.CARD:
        from ..render.bobweight_page import write_page

        emit(write_page(result), output)
    else:
        from ..render import balance as renderer

        show([result], renderer, Format(form), output, units)


def parse_tools(
    radius: str | None,
    thickness: str | None,
    disc: str | None,
    drill: str | None,
    max_depth: str | None,
    slug: str | None,
    units: Units,
) -> Tools:
    """What a workshop has; BalcliError for a text that is no length, or no metal."""
    from ..sizing.workshop import Tools

    given = {"radius": radius, "thickness": thickness, "disc": disc, "drill": drill}
    given["max-depth"] = max_depth
    lengths = {
        name.replace("-", "_"): read_length(f"--{name}", text, units)
        for name, text in given.items()
        if text is not None
    }
    return Tools(**lengths, slug=None if slug is None else _parse_slug(slug))


def _parse_slug(text: str) -> float:
    """Density of a metal, kg/m3: by its name, or in g/cm3."""
    if (known := SLUGS.get(text.strip().lower())) is not None:
        return known
    wanted = f"{', '.join(SLUGS)}, or a density in g/cm3 such as 18.5"
    return 1e3 * read_number("--slug", text, wanted)


def parse_grading(
    grade: str | None, mass: str | None, units: Units
) -> tuple[float | None, float | None]:
    """The grade of `--grade` (`16` or `G16`), mm/s, and the mass of `--mass`, kg."""
    return (
        None if grade is None else _parse_grade(grade),
        None if mass is None else read_mass("--mass", mass, units),
    )


def _parse_grade(text: str) -> float:
    figure = text.strip().removeprefix("G")
    return read_number("--grade", figure, "a grade of ISO 21940-11 such as G16 or 6.3")


def balance_knuckles(
    scheme: str,
    options: SchemeOptions,
    even: str | None,
    model: EngineFile,
    engine: Engine,
    orders: list[float] | None,
) -> Balance:
    """The scheme that changes knuckle angles, at the engine's speed.

    Raises BalcliError for options that are not its own, and for --even with another scheme.
    """
    from ..results import knuckles

    if scheme != KNUCKLES:
        raise BalcliError(
            f"--even belongs to --scheme knuckles; scheme {scheme} has no such option"
        )
    if options != SchemeOptions():
        raise BalcliError("scheme knuckles: has no option but --even")
    wanted = even or knuckles.GOALS[0]
    for goal in knuckles.GOALS:
        if goal == wanted:
            return knuckles.balance_knuckles(model, goal, orders, float(engine.speed_rpm))
    raise BalcliError(f'--even "{wanted[:60]}": choose from {", ".join(knuckles.GOALS)}')


def _parse_place(text: str, units: Units) -> complex:
    x, y = read_lengths("--at", text, "x,y of a shaft in mm, such as -40,60", 2, units)
    return complex(x, y)


def _parse_position(text: str, units: Units) -> float:
    (z,) = read_lengths("--position", text, "one place along z in mm, such as 40", 1, units)
    return z


def _parse_planes(text: str, units: Units) -> str | tuple[float, ...]:
    if text in ("ends", "throws"):
        return text
    wanted = "ends, throws, or places along z in mm, such as -200,200"
    return read_lengths("--planes", text, wanted, units=units)


def _parse_measured(text: str, units: Units) -> float:
    """A mass in kg; a bare number is in g, as on the scales of a shop."""
    mass = read_mass("--measured", text, units)
    if mass < 0:
        raise BalcliError(f'--measured "{text[:60]}": a mass on the pin is not negative')
    return mass / 1e3 if is_bare(text) else mass


def _parse_factors(text: str) -> tuple[float, ...]:
    """`0.5`, `51%`, `0.4,0.5` or `0:1:0.1` (ends included)."""
    wanted = "a share of the reciprocating mass such as 51% or 0.51, or a range such as 50%:54%:1%"
    if ":" not in text:
        return tuple(read_share("--factor", part, wanted) for part in text.split(","))
    parts = [read_share("--factor", part, wanted) for part in text.split(":")]
    if not _is_range(parts):
        raise BalcliError(
            f'--factor "{text}": a range is first:last:step, rising, with at most {MOST_FACTORS} '
            f"steps; give {wanted}"
        )
    first, last, step = parts
    steps = int((last - first) / step + 1e-9)
    return tuple(round(first + k * step, 12) for k in range(steps + 1))


def _is_range(parts: Sequence[float]) -> bool:
    """Whether these are first, last and step of a range of no more than MOST_FACTORS steps."""
    if len(parts) != 3:
        return False
    first, last, step = parts
    return step > 0 and last >= first and (last - first) / step <= MOST_FACTORS
