"""Lengths, angles, speeds, masses and shares as users type them on the command line: as in an
engine file, `40`, `2.5 in`, `1/7 turn`, `9000 rpm`, and shares as `0.51` or `51%`.

A bare number is in mm, kg, degrees or rpm. With `--units imperial` bare numbers for mm, kg and
kg mm2 are ambiguous and need a unit.

Also the declaration of optional options, and ranges of crank speeds (`--speeds`, `analyze
--speed`).
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import BalcliError, warn
from ..file.units import (
    ANGLE,
    FORTRAN,
    INERTIA,
    LENGTH,
    MASS,
    SPEED,
    Dimension,
    convert,
    refuse_thousands,
    wanted,
)
from ..limits import LARGEST_INERTIA, LONGEST_SHOWN, MOST_SPEEDS, SMALLEST_POSITIVE
from ..show.formats import Units

if TYPE_CHECKING:
    from ..core.vibration import Real


_SCALES = MASS._replace(unit="g", examples=("812 g", "1.8 lb"))
_IMPERIAL_AND_SI = {
    LENGTH: ("in", "mm"),
    MASS: ("lb", "kg"),
    _SCALES: ("oz", "g"),
    INERTIA: ("lb in^2", "kg mm^2"),
}


def read_length(option: str, text: str, units: Units = Units.SI) -> float:
    """Return a length, m; an error names the option and its text.

    Args:
        option: Name of the option, for messages.
        text: Number, with or without a unit.
        units: System of units of a bare number.

    Raises:
        BalcliError: It is no length.
    """
    return _read(option, text, LENGTH, units) / 1e3


def read_lengths(
    option: str, text: str, needed: str, count: int | None = None, units: Units = Units.SI
) -> tuple[float, ...]:
    """Return lengths with commas between them, in m.

    Args:
        needed: the wanted value, for the message: `one place along z in mm, such as 40`.
        count: how many there have to be; None: any number from one.

    Raises:
        BalcliError: anything else; lengths of which only some have a unit.
    """
    parts = [part.strip() for part in text.split(",")]
    if not all(any(map(str.isdigit, part)) for part in parts) or (
        count is not None and len(parts) != count
    ):
        raise BalcliError(f"{_shown(option, text)}: give {needed}")
    bare = [_as_bare(part) for part in parts]
    if None in bare and any(bare):  # 0 is 0 in every unit
        raise BalcliError(f"{_shown(option, text)}: give every number its unit, or none")
    found = tuple(_read(option, part, LENGTH, units) / 1e3 for part in parts)
    if not all(map(math.isfinite, found)):
        raise BalcliError(f"{_shown(option, text)}: give {needed}")
    return found


def read_mass(option: str, text: str, units: Units = Units.SI) -> float:
    """Return a mass in kg; BalcliError with the option and its text."""
    return _read(option, text, MASS, units)


def read_mass_on_scales(option: str, text: str, units: Units = Units.SI) -> float:
    """Return a mass as `read_mass` does, but a bare number is in g, as on the scales of a shop, and
    finite.
    """
    found = _read(option, text, _SCALES, units) / 1e3
    if not math.isfinite(found):
        raise BalcliError(f"{_shown(option, text)}: {wanted(_SCALES)}")
    return found


def read_inertia(option: str, text: str, units: Units = Units.SI) -> float:
    """Return a moment of inertia in kg m2; BalcliError with the option and its text, or for one
    that is not above 0.
    """
    found = _read(option, text, INERTIA, units) / 1e6
    if not 0 < found < LARGEST_INERTIA:
        raise BalcliError(f"{_shown(option, text)}: {wanted(INERTIA)}, above 0")
    return found


def read_angle(option: str, text: str) -> float:
    """Return an angle in degrees; BalcliError with the option and its text."""
    return _read(option, text, ANGLE, Units.SI)


def as_bare_angles(option: str, text: str) -> str:
    """Return a range or list such as `0 deg:0.5 turn:5 deg` in bare degrees: `0:180:5`. What has no
    unit stays as it is.

    Raises: BalcliError: It names the option and the text that is no angle.
    """
    parts = re.split(r"([:,])", text)
    with_unit = [any(map(str.isalpha, part.replace("e", ""))) or "°" in part for part in parts]
    return "".join(
        f"{read_angle(option, part):.15g}" if said else part
        for part, said in zip(parts, with_unit, strict=True)
    )


def read_speed(option: str, text: str) -> float:
    """Return a speed in rpm; BalcliError with the option and its text."""
    return _read(option, text, SPEED, Units.SI)


def read_number(option: str, text: str, needed: str) -> float:
    """Return a plain number; BalcliError with the option, its text and the wanted value."""
    value = _as_bare(text)
    if value is None or not math.isfinite(value):
        raise BalcliError(f"{_shown(option, text)}: give {needed}")
    return value


def read_share(option: str, text: str, needed: str) -> float:
    """Return a share, given as a number or in per cent; errors as of `read_number`."""
    number, percent, rest = text.strip().partition("%")
    value = read_number(option, text if rest else number, needed)
    return value / 100 if percent else value


def _read(option: str, text: str, dimension: Dimension, units: Units) -> float:
    """Return a figure in the dimension's bare unit; whether it is finite is for the caller to
    judge.
    """
    value = _as_bare(text)
    if units is Units.IMPERIAL and value and dimension in _IMPERIAL_AND_SI:
        ways = " or ".join(f'"{text.strip()} {name}"' for name in _IMPERIAL_AND_SI[dimension])
        raise BalcliError(
            f"{_shown(option, text)}: with --units imperial {dimension.name} needs its unit: {ways}"
        )
    try:
        if value is None:
            return convert(text, dimension)
        refuse_thousands(text, value, dimension)
    except ValueError as error:
        raise BalcliError(f"{_shown(option, text)}: {error}") from None
    return value


def _as_bare(text: str) -> float | None:
    """Return the number, if there is no unit to it."""
    try:
        return float(re.sub(FORTRAN, r"e\1", text))
    except ValueError:
        return None


def _shown(option: str, text: str) -> str:
    return f'{option} "{text[:LONGEST_SHOWN]}"'


def optional(metavar: str, text: str, *names: str, **more: Any) -> object:
    """Return an option whose help shows no default, because it is normally left out.

    Args:
        metavar: Placeholder of its value in help.
        text: Help of the option.
        names: Names as typed, such as --scheme; default: that of the parameter.
        more: Further arguments of `typer.Option`.
    """
    return typer.Option(*names, metavar=metavar, help=text, **{"show_default": False, **more})


def parse_cylinder(text: str) -> int | str:
    """Return a cylinder as an engine names it: `3`, or of geared engines `upper.3`."""
    return int(text) if text.isascii() and text.isdecimal() and len(text) < 6 else text


Speeds = Annotated[
    str | None,
    optional(
        "RPM:RPM:STEP|RPM,...",
        "Crank speeds; default: from an eighth of the file's speed to this.",
        "--speeds",
        "--speed",
    ),
]


def parse_speeds(
    text: str | None, option: str = "--speeds", most: int = MOST_SPEEDS
) -> Real | None:
    """Return speeds of `1000:2500:25` (first, last, step), `1000:2500` (100 steps) or `1500,2000`,
    rpm, rising.

    Args:
        option: by which they were given, for messages.
        most: how many there may be.

    Raises:
        BalcliError: anything else, with the text.
    """
    if text is None:
        return None
    import numpy as np

    right = "give first:last:step in rpm, such as 1000:2500:25, or speeds such as 1500,2000"
    start, ranged = f"{_shown(option, text)}: ", ":" in text
    try:
        figures = [read_speed(option, part) for part in text.split(":" if ranged else ",")]
    except BalcliError as error:
        hint = str(error).partition('": ')[2]
        raise BalcliError(f"{start}{f'{hint}; ' * ('thousands:' in hint)}{right}") from None
    if ranged and len(figures) > 3:
        raise BalcliError(start + right)
    if not all(SMALLEST_POSITIVE <= figure < 1e9 for figure in figures):
        wrong = "speeds and their step are" if ranged else "speeds are"
        raise BalcliError(f"{start}{wrong} above 0 and below 1e9 rpm; {right}")
    if figure := re.fullmatch(r"([1-9]),(\d00)", text.strip()):
        meant = f"{figure[1]}{figure[2]} rpm"
        warn(f"{start}a comma parts speeds, not thousands: was {meant} meant?")
    if not ranged:
        return np.array(sorted(set(figures)))
    first, last, step = (*figures, (figures[1] - figures[0]) / 100)[:3]
    if not (first <= last and (step > 0 or first == last)):
        raise BalcliError(f"{start}must rise; {right}")
    count = int((last - first) / step + 1e-9) + 1 if step else 1
    if count > most:
        raise BalcliError(f"{start}has {count} speeds; at most {most} are computed")
    speeds = np.round(first + step * np.arange(count), 9)
    return speeds if speeds[-1] >= last - 1e-9 * step else np.append(speeds, last)
