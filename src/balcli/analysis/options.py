"""Options of `balcli analyze`, and the request that holds their values."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal, NamedTuple, Self

import typer

from ..errors import BalcliError, warn
from ..limits import MOST_ANALYSED_SPEEDS
from ..shell.file_names import TEXTS, format_option, text_format
from ..shell.options import OF_ONE, parse_speed
from ..shell.values import optional, parse_speeds
from ..show.formats import Format

AnalysisFormatOption = Annotated[
    list[Format] | None,
    format_option(
        (*TEXTS.values(), Format.MARINE),
        "Format of the result; default: by the ending of -o, else table. marine: sheet of external "
        "forces and moments (of a compressor: unbalanced forces and couples), guide moments and "
        "torque by order; in CSV with `-f marine -f csv`.",
    ),
]
SpeedsOption = Annotated[
    str | None,
    optional(
        "RPM|RPM:RPM:STEP|RPM,...",
        "Crank speed, rpm, instead of the speed in the file; or several, such as 60:124:8 (first, "
        "last, step). The last speed of a range is always computed.",
        "--speed",
        "--rpm",
    ),
]
By = Annotated[
    Literal["cylinder", "bank"] | None,
    optional(
        "cylinder|bank", "Also show forces and moments of each single cylinder or bank.", "--by"
    ),
]
Why = Annotated[
    bool, typer.Option("--why", help="Print why orders are balanced or not, and phasor stars.")
]


class Request(NamedTuple):
    """Options of `balcli analyze`, which hold for every engine.

    Attributes:
        speeds_rpm: Crank speeds; empty: the speed of the file.
        orders: Orders to show; None: the default orders of each engine.
        quantities: Quantities to compute; None: the default quantities of each engine.
        parts: Words of `--only`; empty if it is not given.
        whole: Whether every table and every order is shown.
        by: "cylinder" or "bank": forces and moments of each single one are shown as well.
        why: Whether to show why orders are balanced or not, and phasor stars.
        height_m: Distance from the crankshaft to the middle of the guides; None: each rod's length.
        misfires: Numbers of the cylinders without gas.
        marine: Whether the sheet that builders of marine engines use is wanted.
        small: Share of one cylinder's first order. Ladder and sizing leave a rotating force or
            moment below this share unbalanced.
    """

    speeds_rpm: tuple[float, ...]
    orders: list[float] | None
    quantities: list[str] | None
    parts: frozenset[str]
    whole: bool
    by: Literal["cylinder", "bank"] | None
    why: bool
    height_m: float | None
    misfires: tuple[str, ...]
    marine: bool
    small: float

    @property
    def over_speed(self) -> bool:
        """Whether there are several speeds."""
        return len(self.speeds_rpm) > 1

    def check(self) -> Self:
        """Return the request; options without effect cause an error or a warning.

        Raises:
            BalcliError: Two options exclude each other.
        """
        given = {"--by": self.by is not None}
        if self.marine:
            given |= {"--only": bool(self.parts), "--why": self.why}
        elif self.over_speed:
            given |= {f"--only {word}": word in self.parts for word in OF_ONE}
        for option in (option for option, is_given in given.items() if is_given):
            if self.marine:
                raise BalcliError(f"{option} has no effect with --format marine; leave one out")
            if self.over_speed:
                raise BalcliError(f"{option} needs a single speed, such as --speed 3000")
        if self.height_m is not None and not (self.marine or self.whole or "guide" in self.parts):
            warn("--guide-height changes only guide-force moments; --only guide shows them")
        return self


def choose_analysis_format(
    output: Path | None, asked: Sequence[Format] | None
) -> tuple[Format, bool]:
    """Return the format of the output, and whether it is the marine sheet; errors as for
    `file_names.format_of`.

    Args:
        output: File to write; None: standard output.
        asked: Values of `--format`; None if it is not given.
    """
    given = asked or ()
    plain = [one for one in given if one is not Format.MARINE]
    if len(plain) > 1:
        warn(f"--format is given {len(plain)} times; the last one is used")
    return text_format(output, plain[-1] if plain else None), Format.MARINE in given


def parse_analysed_speeds(text: str | None) -> tuple[float, ...]:
    """Return the speeds (rpm) of a number, a range or a list; empty without a text."""
    if text is not None and (":" in text or "," in text):
        several = parse_speeds(text, "speed", MOST_ANALYSED_SPEEDS)
        return () if several is None else tuple(several.tolist())
    one = parse_speed(text)
    return () if one is None else (one,)
