"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import BalcliError
from ..forces.kinds import KINDS
from ..limits import HIGHEST_ORDER
from ..render.formats import Format, Units
from .amounts import read_length, read_speed
from .completion import complete_schemes
from .file_names import parse_output

EnginePath = Annotated[
    str,
    typer.Argument(
        metavar="FILE", help="Engine file (TOML); - reads standard input.", show_default=False
    ),
]
EnginePaths = Annotated[
    list[str],
    typer.Argument(
        metavar="FILE...", show_default=False, help="Engine files (TOML); - reads standard input."
    ),
]
FormatOption = Annotated[
    Format | None,
    typer.Option(
        "--format",
        "-f",
        show_default=False,
        help="How to write the result; default: by the ending of -o (.txt, .json, .csv, .md), "
        "else table.",
    ),
]
UnitsOption = Annotated[
    Units, typer.Option("--units", help="imperial: lbf, lbf·ft, oz·in; JSON stays SI.")
]
Output = Annotated[
    Path | None,
    typer.Option(
        "--output",
        "-o",
        metavar="FILE",
        callback=parse_output,
        show_default=False,
        help="Write into this file instead; its ending says the format. - is standard output.",
    ),
]


Speed = Annotated[
    str | None,
    typer.Option(
        "--speed", metavar="RPM", help="Crank speed instead of the file's, rpm.", show_default=False
    ),
]
Orders = Annotated[
    str | None,
    typer.Option(
        "--orders",
        metavar="1-8|1,2,4",
        show_default=False,
        help="Orders to show; default: 1, 2 and all to 512 that are not negligible.",
    ),
]
Only = Annotated[
    str | None,
    typer.Option(
        "--only",
        metavar="WHAT,...",
        show_default=False,
        help=f"Compute only some of {', '.join(KINDS)}, peak, sizing; or inner "
        "(shear, bending, bearing loads along the crankshaft) and guide (H- and X-type).",
    ),
]
GuideHeight = Annotated[
    str | None,
    typer.Option(
        "--guide-height",
        metavar="MM",
        show_default=False,
        help="With --only guide: from the crankshaft to the middle of the guides, in mm or as "
        "'80 in'; default: length of the rod.",
    ),
]
Scheme = Annotated[
    str | None,
    typer.Option(
        "--scheme",
        metavar="NAME",
        show_default=False,
        autocompletion=complete_schemes,
        help="Also with the devices of a balance scheme, such as auto: before and after.",
    ),
]


def parse_orders(text: str | None) -> list[int] | None:
    """Orders as in `1-8`, `1,2,4` or `1-4,8`.

    Raises:
        BalcliError: anything else, with the text.
    """
    if text is None:
        return None
    orders: list[int] = []
    for part in text.split(","):
        first, dash, last = part.strip().partition("-")
        if not _is_whole(first) or (dash and not _is_whole(last)) or len(first + last) > 12:
            raise BalcliError(f'--orders "{text}": give whole numbers such as 1-8 or 1,2,4')
        low, high = int(first), int(last or first)
        if low > high or high > HIGHEST_ORDER:
            raise BalcliError(
                f'--orders "{text}": {part.strip()} must rise and end at {HIGHEST_ORDER} at most'
            )
        orders += range(low, high + 1)
    return orders


def _is_whole(text: str) -> bool:
    return text.isascii() and text.isdigit()


def parse_quantities(text: str | None) -> list[str] | None:
    """The quantities of `--only`, by name."""
    return None if text is None else [word.strip() for word in text.split(",")]


def parse_speed(text: str | None) -> float | None:
    """The speed of `--speed`, rpm.

    Raises:
        BalcliError: unless it is positive and finite.
    """
    if text is None:
        return None
    speed = read_speed("--speed", text)
    if not 0 < speed < 1e9:
        raise BalcliError(
            f"--speed {speed:g}: the crank speed must be a positive number of rpm, below 1e9"
        )
    return speed


def parse_guide_height(text: str | None, units: Units) -> float | None:
    """The height of `--guide-height`, m.

    Raises:
        BalcliError: unless it is positive and finite.
    """
    if text is None:
        return None
    height = read_length("--guide-height", text, units)
    if not 0 < height < 1e3:
        raise BalcliError(
            f"--guide-height {text}: the distance from the crankshaft to the middle of the guides "
            "must be positive, below 1000 m"
        )
    return height
