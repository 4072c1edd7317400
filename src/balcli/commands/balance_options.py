"""Options of `balance`, and what the schemes understand of them (SI)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import BalcliError
from ..limits import MOST_FACTORS
from ..render.formats import Units
from ..sizing.options import SchemeOptions
from ..sizing.schemes import KNUCKLES, NAMES
from .amounts import read_length, read_lengths, read_mass, read_share
from .completion import complete_schemes

if TYPE_CHECKING:
    from ..engine.build import Engine
    from ..enginefile.model import EngineFile
    from ..results.balance import Balance
    from ..sizing.workshop import Tools

Scheme = Annotated[
    str,
    typer.Option(
        "--scheme",
        "--with",
        metavar="NAME",
        autocompletion=complete_schemes,
        help=f"What to fit: {', '.join(NAMES[:-1])} or {NAMES[-1]}.",
    ),
]
Order = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        show_default=False,
        help=("Order to balance; default: the lowest that is not balanced."),
    ),
]
At = Annotated[
    list[str] | None,
    typer.Option(
        metavar="X,Y",
        show_default=False,
        help=("Place in mm of the shaft that turns against the crank; given twice: of both."),
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
        help=("Where along the crank: at its end throws, at every throw, or at these z in mm."),
    ),
]
Factor = Annotated[
    str | None,
    typer.Option(
        metavar="K|K:K:STEP",
        show_default=False,
        help=(
            "Share of the reciprocating mass that counterweights take; default 0.5. Of a range, "
            "the best."
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
        help=("Radius at which masses are stated; default: crank radius."),
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
            "Diameter of a drill: also say how deep a radial hole from --radius inwards removes "
            "as much."
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
    float | None,
    typer.Option(
        metavar="G",
        show_default=False,
        help="Balance quality grade of ISO 21940-11, mm/s: say what may be left beside each "
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
        roll=roll,
    )


def parse_tools(
    radius: str | None, thickness: str | None, disc: str | None, drill: str | None, units: Units
) -> Tools:
    """What a workshop has; BalcliError for a text that is no length."""
    from ..sizing.workshop import Tools

    given = {"radius": radius, "thickness": thickness, "disc": disc, "drill": drill}
    said = {name: text for name, text in given.items() if text is not None}
    return Tools(**{name: read_length(f"--{name}", text, units) for name, text in said.items()})


def parse_mass(text: str | None, units: Units) -> float | None:
    """The mass of `--mass`, kg."""
    return None if text is None else read_mass("--mass", text, units)


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


def _parse_factors(text: str) -> tuple[float, ...]:
    """`0.5`, `51%`, `0.4,0.5` or `0:1:0.1` (ends included)."""
    wanted = "a share of the reciprocating mass such as 0.5 or 50%, or a range such as 0:1:0.1"
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
