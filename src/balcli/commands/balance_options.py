"""Options of `balance` alone, and what it does with them: the workshop's, grades, the card."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.drilled_hole import SLUGS
from ..errors import BalcliError, note
from ..render.formats import Format, Units
from ..sizing.options import SchemeOptions
from ..sizing.schemes import KNUCKLES, MEANINGS, NAMES, SCHEMES
from .amounts import read_length, read_number
from .declare import optional
from .file_names import format_of, format_option, text_format
from .output import emit, show
from .scheme_options import complete_schemes

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
        "How to write the result; default: by the ending of -o, else table. card: a page for the "
        "wall of a shop, per pin, in g and oz.",
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
    bool, typer.Option("--schemes", callback=_list_schemes, is_eager=True, help="List all schemes.")
]
Radius = Annotated[str | None, optional("MM", "Radius of the weights; default: crank radius.")]
Thickness = Annotated[str | None, optional("MM", "Thickness of half discs of steel; default 20.")]
Disc = Annotated[str | None, optional("MM", "Radius of those discs, instead of their thickness.")]
Drill = Annotated[str | None, optional("MM", "Drill: list radial holes, from --radius inwards.")]
MaxDepth = Annotated[str | None, optional("MM", "Deepest hole, for --drill; default: to the axis.")]
Slug = Annotated[
    str | None, optional("METAL", "With --drill: slugs of tungsten, lead, or of a density, g/cm3.")
]
Even = Annotated[str | None, optional("dead-centres|strokes", "What --scheme knuckles makes even.")]
Grade = Annotated[
    str | None, optional("G", "Balance grade of ISO 21940-11, such as G16: what may be left.")
]
Mass = Annotated[str | None, optional("KG", "Mass of the crankshaft, for --grade.")]
Write = Annotated[
    Path | None, optional("OUT.toml", "Write the engine with these devices, and with --speed.")
]


def choose_balance_format(output: Path | None, asked: BalanceFormat | None) -> BalanceFormat:
    """How to write the balance; errors as `file_names.format_of`."""
    if asked is BalanceFormat.CARD:
        return format_of(output, asked, {".txt": asked}, asked)
    plain = None if asked is None else Format(asked)
    return BalanceFormat(text_format(output, plain))


def show_balance(result: Balance, form: BalanceFormat, output: Path | None, units: Units) -> None:
    """Print or write the balance, or its bobweight card, in this format."""
    for reason in dict.fromkeys(result.remedy.reasons):
        note(f"scheme {result.remedy.scheme}: {reason}")
    if form is BalanceFormat.CARD:
        from ..render.bobweight_page import write_page

        emit(write_page(result), output)
    else:
        from ..render.balance import RENDERER

        show([result], RENDERER, Format(form), output, units)


def parse_tools(units: Units, slug: str | None, **lengths: str | None) -> Tools:
    """Return what a workshop has.

    Args:
        units: Units of the command.
        slug: A metal, or its density in g/cm3.
        lengths: Texts of the options with lengths, by their names in `Tools`.

    Raises:
        BalcliError: a text that is no length, or no metal.
    """
    from ..sizing.workshop import Tools

    found = {
        name: read_length(f"--{name.replace('_', '-')}", text, units)
        for name, text in lengths.items()
        if text is not None
    }
    if slug is not None:
        wanted = f"{', '.join(SLUGS)}, or a density in g/cm3 such as 18.5"
        known = SLUGS.get(slug.strip().lower())
        found["slug"] = known or 1e3 * read_number("--slug", slug, wanted)
    return Tools(**found)


def parse_grade(text: str | None) -> float | None:
    """Return the grade of `--grade` (`16` or `G16`), mm/s."""
    if text is None:
        return None
    wanted = "a grade of ISO 21940-11 such as G16 or 6.3"
    return read_number("--grade", text.strip().removeprefix("G"), wanted)


def answer_knuckles(
    scheme: str,
    options: SchemeOptions,
    even: str | None,
    model: EngineFile,
    engine: Engine,
    orders: list[float] | None,
) -> Balance:
    """Return the balance of the scheme that changes knuckle angles, at the engine's speed.

    Raises:
        BalcliError: options that are not its own, and --even with another scheme.
    """
    from ..results import knuckles

    if scheme != KNUCKLES:
        raise BalcliError(
            f"--even belongs to --scheme knuckles; scheme {scheme} has no such option"
        )
    if options != SchemeOptions():
        raise BalcliError("scheme knuckles: has no option but --even")
    goal = next((goal for goal in knuckles.GOALS if goal == (even or knuckles.GOALS[0])), None)
    if goal is None:
        raise BalcliError(f'--even "{even or "":.60}": choose from {", ".join(knuckles.GOALS)}')
    return knuckles.balance_knuckles(model, goal, orders, float(engine.speed_rpm))
