"""Read lengths, angles, speeds, masses and shares from the command line. They are written as in an
engine file (`40`, `2.5 in`, `1/7 turn`, `9000 rpm`), and shares as `0.51` or `51%`.

A bare number is in mm, kg, kg mm2, degrees or rpm. With `--units imperial`, lengths, masses and
inertias need a unit, because bare numbers would be ambiguous.

The module also declares options (`optional`) and arguments (`argument`), and reads ranges of crank
speeds (`--speeds`, `analyze --speed`).
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import Argument, ArgumentError, Message, name_option, warn
from ..file.units import (
    ANGLE,
    FORTRAN,
    INERTIA,
    LENGTH,
    MASS,
    SPEED,
    Dimension,
    ThousandsError,
    convert,
    read_fraction,
    refuse_thousands,
    wanted,
)
from ..limits import LARGEST_INERTIA, LONGEST_SHOWN, MOST_SPEEDS, SMALLEST_POSITIVE
from ..show.formats import Units

if TYPE_CHECKING:
    from ..core.vibration import Real


SCALES = MASS._replace(unit="g", examples=("812 g", "1.8 lb"))  # a shop's scales show grams
_IMPERIAL_AND_SI = {
    LENGTH: ("in", "mm"),
    MASS: ("lb", "kg"),
    SCALES: ("oz", "g"),
    INERTIA: ("lb in^2", "kg mm^2"),
}


def read_length(argument: str, text: str, units: Units = Units.SI) -> float:
    """Return a length, m. Errors name the argument and the text.

    Args:
        argument: Name of the argument, for messages.
        text: Number, with or without a unit.
        units: System of units of a bare number.

    Raises:
        ArgumentError: The text is not a length.
    """
    return read_figure(argument, text, LENGTH, units) / 1e3


def read_lengths(
    argument: str, text: str, needed: str, count: int | None = None, units: Units = Units.SI
) -> tuple[float, ...]:
    """Return the lengths (m) in a text, which commas separate; see `read_length`.

    Args:
        needed: Description of valid values, for messages: `one place along z in mm, such as 40`.
        count: Required number of lengths; None: one or more.

    Raises:
        ArgumentError: The text has another form, or only some of the lengths have a unit.
    """
    parts = [part.strip() for part in text.split(",")]
    have_digits = all(any(map(str.isdigit, part)) for part in parts)
    if not have_digits or count not in (None, len(parts)):
        raise _refuse(argument, text, f"give {needed}")
    bare = [_as_bare(part) for part in parts]
    if None in bare and any(bare):  # 0 is 0 in every unit
        raise _refuse(argument, text, "give all numbers a unit, or none")
    return tuple(read_length(argument, part, units) for part in parts)


def read_inertia(argument: str, text: str, units: Units = Units.SI) -> float:
    """Return a moment of inertia, kg m2. If the text is not such a figure, or not above 0, raise
    ArgumentError with the argument and the text.
    """
    inertia = read_figure(argument, text, INERTIA, units) / 1e6
    if not 0 < inertia < LARGEST_INERTIA:
        raise _refuse(argument, text, f"{wanted(INERTIA)}, above 0")
    return inertia


def as_bare_angles(argument: str, text: str) -> str:
    """Return a range or list of angles converted to bare degrees: `0:180:5` for `0 deg:0.5 turn:5
    deg`. Angles without a unit are unchanged.

    Raises:
        ArgumentError: A text is not an angle; the error names the text and the argument.
    """
    parts = re.split(r"([:,])", text)
    for k, part in enumerate(parts):
        if "°" in part or any(map(str.isalpha, part.replace("e", ""))):
            parts[k] = f"{read_figure(argument, part, ANGLE):.15g}"
    return "".join(parts)


def read_number(argument: str, text: str, needed: str) -> float:
    """Return a finite number without a unit. If the text is anything else, raise ArgumentError with
    the argument, the text and `needed`, which describes valid values.
    """
    value = _as_bare(text)
    if value is None or not math.isfinite(value):
        raise _refuse(argument, text, f"give {needed}")
    return value


def read_share(argument: str, text: str, needed: str) -> float:
    """Return a share, given as a number, fraction or percentage; errors as for `read_number`."""
    try:
        return read_fraction(text)
    except ValueError:
        raise _refuse(argument, text, f"give {needed}") from None


def read_figure(argument: str, text: str, dimension: Dimension, units: Units = Units.SI) -> float:
    """Return a finite figure, converted to the default unit of its dimension (mm for a length).

    Args:
        argument: Name of the argument, for messages.
        text: Number, with or without a unit.
        dimension: Dimension of the figure.
        units: System of units of a bare number.

    Raises:
        ArgumentError: The text is not a figure of this dimension; the error names argument and
            text.
    """
    if units is Units.IMPERIAL and _as_bare(text) and dimension in _IMPERIAL_AND_SI:
        ways = " or ".join(f'"{text.strip()} {name}"' for name in _IMPERIAL_AND_SI[dimension])
        needs = f"imperial {dimension.name} needs its unit: {ways}"
        raise _refuse(argument, text, Message("with {units} {needs}", needs=needs))
    try:
        return _read(text, dimension)
    except ValueError as error:
        raise _refuse(argument, text, str(error)) from None


def _read(text: str, dimension: Dimension) -> float:
    """Return a finite figure in the default unit of its dimension.

    Raises:
        ValueError: The text is not such a figure.
    """
    value = _as_bare(text)
    if value is None:
        return convert(text, dimension)
    refuse_thousands(text, value, dimension)
    if not math.isfinite(value):
        raise ValueError(f"is not a finite number; {wanted(dimension)}")
    return value


def _as_bare(text: str) -> float | None:
    """Return the number in a text without a unit; None for other texts."""
    try:
        return float(re.sub(FORTRAN, r"e\1", text))
    except ValueError:
        return None


def _refuse(argument: str, text: str, wrong: str) -> ArgumentError:
    """Return the error for the text of an argument."""
    shown = text[:LONGEST_SHOWN]
    return ArgumentError(
        '{argument} "{text}": {wrong}', argument=Argument(argument), text=shown, wrong=wrong
    )


def optional(metavar: str, text: str, *names: str, **more: Any) -> object:
    """Return an option whose help shows no default.

    Args:
        metavar: Placeholder for the option's value in help.
        text: Help of the option.
        names: Names as typed, such as --scheme; default: the parameter's name.
        more: Further arguments of `typer.Option`.
    """
    return typer.Option(*names, metavar=metavar, help=text, **{"show_default": False, **more})


def argument(metavar: str, text: str, **more: Any) -> object:
    """Return an argument of a command; help shows no default for it. See `optional`."""
    return typer.Argument(metavar=metavar, help=text, **{"show_default": False, **more})


def parse_cylinder(text: str) -> int | str:
    """Return a cylinder as an engine names it: `3`, or `upper.3` in geared engines."""
    return int(text) if text.isascii() and text.isdecimal() and len(text) < 6 else text


Speeds = Annotated[
    str | None,
    optional(
        "RPM:RPM:STEP|RPM,...",
        "Crank speeds; default: from 1/8 of the file's speed to the file's speed.",
        "--speeds",
        "--speed",
    ),
]


def parse_speeds(
    text: str | None, argument: str = "speeds", most: int = MOST_SPEEDS
) -> Real | None:
    """Return rising speeds, rpm, from a text such as `1000:2500:25` (first, last, step),
    `1000:2500` (100 steps) or `1500,2000`.

    Args:
        argument: Name of the argument, for messages.
        most: Largest number of speeds.

    Raises:
        ArgumentError: The text has another form.
    """
    if text is None:
        return None
    import numpy as np

    right = "give first:last:step in rpm, such as 1000:2500:25, or speeds such as 1500,2000"
    ranged = ":" in text
    try:
        parts = text.split(":") if ranged else text.split(",")
        figures = [_read(part, SPEED) for part in parts]
    except ThousandsError as error:
        raise _refuse(argument, text, f"{error}; {right}") from None
    except ValueError:
        raise _refuse(argument, text, right) from None
    if ranged and len(figures) > 3:
        raise _refuse(argument, text, right)
    if not all(SMALLEST_POSITIVE <= figure < 1e9 for figure in figures):
        wrong = "speeds and their step are" if ranged else "speeds are"
        raise _refuse(argument, text, f"{wrong} above 0 and below 1e9 rpm; {right}")
    if figure := re.fullmatch(r"([1-9]),(\d00)", text.strip()):
        meant = f"{figure[1]}{figure[2]} rpm"
        doubt = f"a comma separates speeds, not thousands: was {meant} meant?"
        warn(f'{name_option(argument)} "{text}": {doubt}')
    if not ranged:
        return np.array(sorted(set(figures)))
    first, last, step = (*figures, (figures[1] - figures[0]) / 100)[:3]
    if not (first <= last and (step > 0 or first == last)):
        raise _refuse(argument, text, f"must rise; {right}")
    count = int((last - first) / step + 1e-9) + 1 if step else 1
    if count > most:
        raise _refuse(argument, text, f"has {count} speeds; at most {most} are computed")
    speeds = np.round(first + step * np.arange(count), 9)
    return speeds if speeds[-1] >= last - 1e-9 * step else np.append(speeds, last)
