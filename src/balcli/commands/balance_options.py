"""Options of `balance`, and what the schemes understand of them (SI)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import BalcliError
from ..limits import MOST_FACTORS
from ..sizing.schemes import KNUCKLES, NAMES
from .completion import complete_schemes
from .options import parse_numbers

if TYPE_CHECKING:
    from ..engine.build import Engine
    from ..enginefile.model import EngineFile
    from ..results.balance import Balance
    from ..sizing.sizing import Tools, Wish

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
    float | None,
    typer.Option(
        metavar="MM",
        show_default=False,
        help=("Radius at which masses are stated; default: crank radius."),
    ),
]
Thickness = Annotated[
    float | None,
    typer.Option(
        metavar="MM",
        show_default=False,
        help=("Thickness of the semicircular steel discs that are stated; default 20."),
    ),
]
Disc = Annotated[
    float | None,
    typer.Option(
        metavar="MM",
        show_default=False,
        help=("Radius of those discs, instead of their thickness."),
    ),
]
Drill = Annotated[
    float | None,
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
    float | None,
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


def wish_of(
    order: int | None,
    at: Sequence[str] | None,
    position: str | None,
    planes: str | None,
    factor: str | None,
    roll: str | None,
) -> Wish:
    """The wish; BalcliError for a text that says nothing, with the text."""
    from ..sizing.sizing import Wish

    return Wish(
        order=order,
        at=tuple(map(_place, at)) if at else None,
        position=None
        if position is None
        else parse_numbers("--position", position, "one place along z in mm, such as 40", 1)[0]
        / 1e3,
        planes=None if planes is None else _planes(planes),
        factor=None if factor is None else _factors(factor),
        roll=roll,
    )


def knuckles(
    scheme: str,
    wish: Wish,
    even: str | None,
    file: EngineFile,
    engine: Engine,
    orders: list[int] | None,
) -> Balance:
    """The scheme that changes knuckle angles; BalcliError for options that are not its own, or
    --even with another scheme.
    """
    from ..results.knuckles import GOALS, balanced
    from ..sizing.sizing import Wish

    if scheme != KNUCKLES:
        raise BalcliError(
            f"--even belongs to --scheme knuckles; scheme {scheme} has no such option"
        )
    if wish != Wish():
        raise BalcliError("scheme knuckles: has no option but --even")
    goal = next((known for known in GOALS if known == (even or GOALS[0])), None)
    if goal is None:
        raise BalcliError(f'--even "{str(even)[:60]}": choose from {", ".join(GOALS)}')
    return balanced(file, goal, orders, engine.speed_rpm)


def shop_tools(
    radius: float | None, thickness: float | None, disc: float | None, drill: float | None
) -> Tools:
    """mm -> m."""
    from ..sizing.sizing import Tools

    return Tools(
        *(None if length is None else length / 1e3 for length in (radius, thickness, disc, drill))
    )


def _place(text: str) -> complex:
    x, y = parse_numbers("--at", text, "x,y of a shaft in mm, such as -40,60", 2)
    return complex(x / 1e3, y / 1e3)


def _planes(text: str) -> str | tuple[float, ...]:
    if text in ("ends", "throws"):
        return text
    return tuple(
        z / 1e3
        for z in parse_numbers(
            "--planes", text, "ends, throws, or places along z in mm, such as -200,200"
        )
    )


def _factors(text: str) -> tuple[float, ...]:
    """`0.5`, `0.4,0.5` or `0:1:0.1` (ends included)."""
    wanted = "a share of the reciprocating mass such as 0.5, or a range such as 0:1:0.1"
    if ":" not in text:
        return parse_numbers("--factor", text, wanted)
    parts = [parse_numbers("--factor", part, wanted, 1)[0] for part in text.split(":")]
    if (
        len(parts) != 3
        or parts[2] <= 0
        or parts[1] < parts[0]
        or (parts[1] - parts[0]) / parts[2] > MOST_FACTORS
    ):
        raise BalcliError(
            f'--factor "{text}": a range is first:last:step, rising, with at most {MOST_FACTORS} '
            f"steps; give {wanted}"
        )
    first, last, step = parts
    return tuple(round(first + k * step, 12) for k in range(int((last - first) / step + 1e-9) + 1))
