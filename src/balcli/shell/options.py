"""Options that several commands share, and the parsers of their values."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

import typer

from ..errors import BalcliError
from ..file.units import SPEED
from ..forces.kinds import FREE, GAS_KINDS, KINDS
from ..limits import (
    HIGHEST_GUIDE_M,
    HIGHEST_ORDER,
    LONGEST_SHOWN,
    SMALL,
    SMALLEST_POSITIVE,
)
from ..show.formats import Format, Units
from ..sizing.options import check_small
from .file_names import TEXTS, engine_argument, format_option, parse_output
from .values import argument, optional, read_figure, read_length, read_share

# Words of `analyze --only` for views of force and moment, which need no further computation.
PARTS = ("xy", "textbook", "verdict")
# Words for results that are computed only on request
CLOSER = ("inner", "guide", "journals", "masses", "parts", "pru")
OF_ONE = (*PARTS, *CLOSER[2:])  # words for tables that describe one engine at one speed
WORDS_OF_ONLY = (*KINDS, "peak", "sizing", "ladder", *GAS_KINDS, *CLOSER, *PARTS)


_ENGINE = "(TOML), or the name of an example such as i3; - reads standard input."
EnginePath = Annotated[str, engine_argument("FILE", f"Engine file {_ENGINE}")]
EnginePaths = Annotated[list[str], engine_argument("FILE...", f"Engine files {_ENGINE}")]
FormatOption = Annotated[
    Format | None,
    format_option(
        TEXTS.values(), "Default: by the ending of -o (.txt, .json, .csv, .md), else table."
    ),
]
UnitsOption = Annotated[
    Units,
    typer.Option(
        "--units",
        case_sensitive=False,
        envvar="BALCLI_UNITS",
        show_envvar=False,
        help="imperial: lbf, lbf·ft, oz·in, psi, hp; JSON stays SI.",
    ),
]
Output = Annotated[
    Path | None,
    optional(
        "FILE", "File to write; - is standard output.", "--output", "-o", callback=parse_output
    ),
]
Target = Annotated[Path | None, argument("OUT", "The file to write; the same as -o.")]
Speed = Annotated[
    str | None, optional("RPM", "Crank speed instead of the file's, rpm.", "--speed", "--rpm")
]
Orders = Annotated[
    str | None,
    optional(
        "1-8|0.5-8|1,2,4",
        "Orders to show; default: 1, 2 and others that are not negligible; with gas, all up to 12.",
        "--orders",
    ),
]
_ONLY = (
    f"Show only these: {', '.join(KINDS)}, peak, sizing, ladder, gas, inner (shear, bending, "
    "bearing loads along crankshaft and block), guide (H- and X-type moments)"
)
Only = Annotated[str | None, optional("WHAT,...", f"{_ONLY}.", "--only")]
OnlyParts = Annotated[
    str | None,
    optional(
        "WHAT,...",
        f"{_ONLY}, journals (torque along the crankshaft), masses, parts (balancer shafts in their "
        "bearings, counterweights as sectors), pru (power related unbalance); or these "
        "views: xy (components), textbook (multiples of F1, m r ω²), verdict.",
        "--only",
    ),
]
Small = Annotated[
    str | None,
    optional("5%", "Ignore orders below this share of one cylinder's first order."),
]
Whole = Annotated[
    bool, typer.Option("--all", help="Show every table, and orders that are negligible.")
]
Misfire = Annotated[
    list[str] | None,
    optional(
        "N|NAME.N",
        "Cylinder without gas pressure (NAME.N: cylinder N of engine NAME in [[engine]]); repeat "
        "for more cylinders. If a cylinder still compresses, give it heat = 0 in [cylinder.N].",
    ),
]
GuideHeight = Annotated[
    str | None,
    optional(
        "MM",
        "With --only guide: distance of the middle of the guides from the crankshaft, mm or "
        "'80 in'; default: rod length.",
        "--guide-height",
    ),
]


def parse_orders(text: str | None) -> list[float] | None:
    """Return the orders in a text such as `1-8`, `1,2,4`, `1-4,8`, or `0.5-8` in steps of a half.

    Raises:
        BalcliError: The text has another form.
    """
    if text is None:
        return None
    bounds = f"must rise and end at {HIGHEST_ORDER} at most"
    return read_orders(text, "give orders such as 1-8, 1,2,4 or 0.5-8", bounds, 0, HIGHEST_ORDER)


def read_orders(text: str, right: str, bounds: str, least: float, most: float) -> list[float]:
    """Return orders from a text of orders and ranges, separated by commas. A range that begins or
    ends with a half order includes half orders.

    Args:
        right: Text for messages about a text of another form.
        bounds: Text for messages about a range that does not rise or is out of bounds.

    Raises:
        BalcliError: The text has another form.
    """
    start = f'--orders "{text[:LONGEST_SHOWN]}": '
    orders: list[float] = []
    for part in text.split(","):
        first, dash, last = part.partition("-")
        low = _count_halves(first)
        high = _count_halves(last) if dash else low
        if low is None or high is None:
            raise BalcliError(start + right)
        if not 2 * least <= low <= high <= 2 * most:
            raise BalcliError(f"{start}{part.strip()} {bounds}")
        step = 1 if low % 2 or high % 2 else 2
        orders += [half / 2 for half in range(low, high + 1, step)]
    return orders


def _count_halves(text: str) -> int | None:
    """Return twice the order in a text such as `8` or `0.5`; None for other texts."""
    if not re.fullmatch(r"\s*[0-9]{1,12}(\.[05]0*)?\s*", text, re.ASCII):
        return None
    return round(2 * float(text))


def parse_only(text: str | None) -> list[str] | None:
    """Return the names in the value of `--only`, which commas or blanks separate; some plurals are
    accepted.

    Raises:
        BalcliError: The word "all" is among them.
    """
    if text is None:
        return None
    words = [word.lower() for word in re.split(r"\s*,\s*|\s+", text.strip())]
    if "all" in words:
        raise BalcliError(
            "--only all: leave --only out for the usual tables, or give --all instead"
        )
    return [word[:-1] if word[:-1] in (*KINDS, "peak", "guide") else word for word in words]


def parse_parts(text: str | None) -> tuple[list[str] | None, frozenset[str]]:
    """Return the quantities to compute for `analyze --only`, and all its words.

    For a view (`PARTS`), force and moment are computed, unless the text names at least one of these
    two.

    Raises:
        BalcliError: A word is unknown.
    """
    words = parse_only(text)
    if words is None:
        return None, frozenset()
    if strangers := sorted({*words}.difference(WORDS_OF_ONLY)):
        named = ", ".join(stranger or '""' for stranger in strangers)
        raise BalcliError(f"--only {named}: choose from {', '.join(WORDS_OF_ONLY)}")
    quantities = [word for word in words if word not in PARTS]
    vectors = {kind.name for kind in FREE}
    if len(quantities) < len(words) and not vectors.intersection(quantities):
        quantities += sorted(vectors)
    return quantities, frozenset(words)


def parse_small(text: str | None) -> float:
    """Return the share in the value of `--small`; the default without a value.

    Raises:
        BalcliError: The value is not a share from 0 to MOST_SMALL.
    """
    wanted = "a share of one cylinder's first order, such as 2%"
    return check_small(SMALL if text is None else read_share("small", text, wanted))


_SEVERAL_SPEEDS = re.compile(r"[\d.]+(:[\d.]+)+|\d\d[\d.]*(,[1-9]\d[\d.]*)+")


def parse_speed(text: str | None) -> float | None:
    """Return the speed in the value of `--speed`, rpm; None if not given.

    Raises:
        BalcliError: The speed is not positive and finite.
    """
    if text is None:
        return None
    if _SEVERAL_SPEEDS.fullmatch(text.replace(" ", "")):
        raise BalcliError(f'--speed "{text}": give one speed here, such as --speed 3000')
    speed = read_figure("speed", text, SPEED)
    if not SMALLEST_POSITIVE <= speed < 1e9:
        raise BalcliError(f"--speed {speed:g}: give rpm above 0, below 1e9")
    return speed


def parse_guide_height(text: str | None, units: Units) -> float | None:
    """Return the height in the value of `--guide-height`, m; None if not given.

    Args:
        text: Value of the option.
        units: System of units of a bare number.

    Raises:
        BalcliError: The height is not positive and finite.
    """
    if text is None:
        return None
    height = read_length("guide_height", text, units)
    if not 0 < height < HIGHEST_GUIDE_M:
        raise BalcliError(f"--guide-height {text}: give above 0, below {HIGHEST_GUIDE_M:g} m")
    return height
