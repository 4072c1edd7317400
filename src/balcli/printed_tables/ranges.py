"""What a reader may ask of a table: other columns and rows than the printed ones.

Ranges are written as on the command line: `0.20:0.40:0.01`, `0.24,0.28,1/3`.
"""

from __future__ import annotations

import re
from decimal import Decimal
from fractions import Fraction
from typing import NamedTuple

from ..errors import BalcliError
from ..limits import LARGEST_TABLE_VALUE, MOST_TABLE_VALUES
from .recomputed import parse_number

_PLAIN = re.compile(r"\s*[-+.\d/]{1,30}(e-?\d{1,2})?\s*", re.IGNORECASE)


class Ranges(NamedTuple):
    """Other columns and rows; None: as printed.

    Attributes:
        lam: columns: crank radius over rod length, as headings.
        angle: rows: crank angles in degrees, as headings.
        power: the highest power of lambda.
    """

    lam: tuple[str, ...] | None = None
    angle: tuple[str, ...] | None = None
    power: int | None = None


def parse_range(text: str, option: str) -> tuple[str, ...]:
    """Return the numbers of a range as they would be printed; START:STOP:STEP includes both ends.

    Raises:
        BalcliError: The text is neither a range nor a list of numbers, or too long.
    """
    try:
        found = [heading for item in text.split(",") for heading in _expand(*item.split(":"))]
    except (ValueError, TypeError, ArithmeticError):
        hint = "give START:STOP:STEP (0.20:0.40:0.01) or a list (0.24,0.28,1/3)"
        raise BalcliError(f"{option} {text!r} is no range: {hint}") from None
    return tuple(dict.fromkeys(found))


def parse_crank_ratios(text: str) -> tuple[str, ...]:
    """Return a range of lambda = crank radius / rod length.

    Raises:
        BalcliError: as of `parse_range`, or a mechanism of the range cannot turn.
    """
    found = parse_range(text, "--lambda")
    bad = next((heading for heading in found if not 0 < _read(heading) < 1), None)
    if bad is not None:
        raise BalcliError(
            f"--lambda {text!r}: lambda = {bad}, but a crank turns only with 0 < lambda < 1; give "
            "crank radius over rod length, such as 0.25 or 1/3.5"
        )
    return found


def _read(text: str) -> Fraction:
    """Return a number that can be an angle or a ratio."""
    value = parse_number(text) if _PLAIN.fullmatch(text) else None
    if value is None or abs(value) > LARGEST_TABLE_VALUE:
        raise ValueError(text)
    return value


def _expand(start: str, stop: str | None = None, step: str = "1") -> list[str]:
    first, stride = _read(start), _read(step)
    if stop is None:
        return [start.strip()]
    count = (_read(stop) - first) / stride
    if not 0 <= count < MOST_TABLE_VALUES:
        raise ValueError(count)
    return [_heading(first + k * stride) for k in range(int(count) + 1)]


def _heading(value: Fraction) -> str:
    """Return 0.24 for 6/25; a fraction that ends in no decimal stays one."""
    decimal = Decimal(value.numerator) / value.denominator
    return f"{decimal.normalize():f}" if Fraction(decimal) == value else str(value)
