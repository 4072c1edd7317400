"""The options of `balcli analyze`, and what they ask for."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from ..errors import BalcliError, warn
from ..limits import MOST_ANALYSED_SPEEDS
from ..render.formats import Format, Units
from .declare import optional
from .file_names import format_option, text_format
from .options import PARTS, parse_guide_height, parse_orders, parse_parts, parse_speed
from .speed_range import parse_speeds


class AnalysisFormat(StrEnum):
    """How an analysis is written: as all results, or as the sheet of marine builders."""

    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    MARKDOWN = "markdown"
    MARINE = "marine"


AnalysisFormatOption = Annotated[
    list[AnalysisFormat] | None,
    format_option(
        AnalysisFormat,
        "How to write the result, md for short of markdown; default: by the ending of -o (.txt, "
        ".json, .csv, .md), else table. marine: external forces and moments (M1V, M1H, M2V), "
        "guide moments and torque by order; with -f csv or -o X.csv beside it, so written.",
    ),
]
SpeedsOption = Annotated[
    str | None,
    optional(
        "RPM|RPM:RPM:STEP|RPM,...",
        "Crank speed instead of the file's, rpm; of several, such as 60:124:8, a sheet over speed.",
        "--speed",
        "--rpm",
    ),
]
By = Annotated[str, optional("cylinder", "cylinder: also each cylinder's share.", "--by")]
Why = Annotated[
    bool,
    typer.Option("--why", help="Also print what is balanced by symmetry, and what by chance."),
]


class Request(NamedTuple):
    """What is asked of every engine.

    Attributes:
        speeds_rpm: at which speeds; empty: at the file's.
        orders: which; None: those that there are.
        quantities: what to compute; None: what there is of every engine.
        parts: words of `--only`; empty: none was given.
        whole: every table and every order.
        by_cylinder, why: whether these were asked for.
        height_m: from the crankshaft to the middle of the guides; None: the rods' lengths.
        misfires: numbers of the cylinders without gas.
        marine: whether it is the sheet of marine builders.
    """

    speeds_rpm: tuple[float, ...]
    orders: list[float] | None
    quantities: list[str] | None
    parts: frozenset[str]
    whole: bool
    by_cylinder: bool
    why: bool
    height_m: float | None
    misfires: tuple[int, ...]
    marine: bool

    @property
    def over_speed(self) -> bool:
        """Whether there are several speeds."""
        return len(self.speeds_rpm) > 1

    @property
    def words(self) -> frozenset[str] | None:
        """What was named, for warnings; None: nothing in particular."""
        return None if self.quantities is None else self.parts


def choose_analysis_format(
    output: Path | None, asked: Sequence[AnalysisFormat] | None
) -> tuple[Format, bool]:
    """How to write, and whether it is the marine sheet; errors as `file_names.format_of`."""
    given = asked or ()
    plain = [Format(one) for one in given if one is not AnalysisFormat.MARINE]
    if len(plain) > 1:
        warn(f"--format is given {len(plain)} times: the last one counts")
    return text_format(output, plain[-1] if plain else None), AnalysisFormat.MARINE in given


def parse_request(
    speed: str | None,
    orders: str | None,
    only: str | None,
    whole: bool,
    by: str,
    why: bool,
    guide_height: str | None,
    misfire: Sequence[int] | None,
    units: Units,
    marine: bool,
) -> Request:
    """What the options ask for.

    Raises:
        BadParameter, BalcliError: one that cannot be read, or that does not go with another.
    """
    quantities, parts = parse_parts(only)
    asked = Request(
        _parse_speeds(speed),
        parse_orders(orders),
        quantities,
        parts,
        whole,
        _is_by_cylinder(by),
        why,
        parse_guide_height(guide_height, units),
        tuple(misfire or ()),
        marine,
    )
    _refuse_what_does_not_go_together(asked)
    if asked.height_m is not None and not (marine or whole or "guide" in parts):
        warn(
            "--guide-height changes guide-force moments alone: ask for them with --only guide, "
            "--all or --format marine"
        )
    return asked


def _parse_speeds(text: str | None) -> tuple[float, ...]:
    """One speed, or a range or list of them."""
    if text is not None and (":" in text or "," in text):
        several = parse_speeds(text, "--speed", MOST_ANALYSED_SPEEDS)
        return () if several is None else tuple(several.tolist())
    one = parse_speed(text)
    return () if one is None else (one,)


def _is_by_cylinder(by: str) -> bool:
    """Whether --by asks for each cylinder's share.

    Raises:
        BadParameter: it asks for something else.
    """
    if by not in ("", "cylinder"):
        raise typer.BadParameter(f'"{by}": only "cylinder" can be chosen', param_hint="--by")
    return bool(by)


def _refuse_what_does_not_go_together(asked: Request) -> None:
    """Options that would be passed over in silence are refused.

    Raises:
        BalcliError: with both.
    """
    given = {"--by": asked.by_cylinder}
    if asked.marine:
        given |= {"--only": bool(asked.parts), "--why": asked.why}
    named = [option for option, is_given in given.items() if is_given]
    if asked.marine and named:
        raise BalcliError(
            f"--format marine: {named[0]} adds nothing to this sheet; leave one of them out"
        )
    if asked.over_speed and named:
        raise BalcliError(f"--speed: {named[0]} is of one speed; give one, such as --speed 3000")
    if asked.over_speed and (texts := sorted(asked.parts.intersection(PARTS))):
        raise BalcliError(
            f"--only {texts[0]}: is of one speed; over several there are force, moment, couple, "
            "torque, roll, gas, peak, sizing, inner and guide"
        )
