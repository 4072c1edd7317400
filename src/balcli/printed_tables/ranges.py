"""What a reader may ask of a table: other columns and rows than the printed ones.

Ranges are written as on the command line: `0.20:0.40:0.01`, `0.24,0.28,1/3`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction

from ..errors import BalcliError
from ..limits import LARGEST_TABLE_VALUE, MOST_TABLE_VALUES
from .printed import parse_number

_PLAIN = re.compile(r"[-+.\d/]{1,30}(e-?\d{1,2})?", re.IGNORECASE)


@dataclass(frozen=True)
class Ranges:
    """What is asked of a table beside its name; None: as printed.

    Attributes:
        lam: columns: crank radius over rod length, as headings.
        angle: rows: crank angles in degrees, as headings.
        power: the highest power of lambda.
    """

    lam: tuple[str, ...] | None = None
    angle: tuple[str, ...] | None = None
    power: int | None = None

    def given(self) -> tuple[str, ...]:
        """The options that are set, by their names on the command line."""
        named = {"lambda": self.lam, "angle": self.angle, "power": self.power}
        return tuple(name for name, value in named.items() if value is not None)


def parse_range(text: str, option: str) -> tuple[str, ...]:
    """The numbers of a range as they would be printed; both ends of START:STOP:STEP are included.

    Raises:
        BalcliError: it is neither a range nor a list of numbers, or too long.
    """
    try:
        parts = [list(map(_exact, item.split(":"))) for item in text.split(",")]
        found = [heading for part in parts for heading in _run(*part)]
    except (ValueError, TypeError, ArithmeticError):
        hint = "give START:STOP:STEP (0.20:0.40:0.01) or a list (0.24,0.28,1/3)"
        raise BalcliError(f"{option} {text!r} is no range: {hint}") from None
    return tuple(dict.fromkeys(found))


def as_numbers(headings: tuple[str, ...]) -> list[float]:
    """The numbers that these headings are."""
    return [float(parse_number(heading)) for heading in headings]


def parse_crank_ratios(text: str) -> tuple[str, ...]:
    """A range of lambda = crank radius / rod length.

    Raises:
        BalcliError: as of `parse_range`, or a mechanism of the range cannot turn.
    """
    found = parse_range(text, "--lambda")
    bad = next((heading for heading in found if not 0 < float(parse_number(heading)) < 1), None)
    if bad is not None:
        hint = ""
        if re.fullmatch(r"0,\d+", text):
            hint = f"; decimals take a point: {text.replace(',', '.')}"
        elif parse_number(bad) > 1:
            hint = f"; of a rod {bad} times as long as the crank radius it is 1/{bad}"
        raise BalcliError(
            f"--lambda {text!r}: lambda = {bad}, but a crank turns only with 0 < lambda < 1{hint}"
        )
    return found


def _exact(text: str) -> tuple[str, Fraction]:
    """The text and its number, as long as that can be an angle or a ratio."""
    if not _PLAIN.fullmatch(text.strip()):
        raise ValueError(text)
    value = parse_number(text)
    if abs(value) > LARGEST_TABLE_VALUE:
        raise ValueError(text)
    return text.strip(), value


def _run(
    start: tuple[str, Fraction],
    stop: tuple[str, Fraction] | None = None,
    step: tuple[str, Fraction] | None = None,
) -> list[str]:
    if stop is None:
        return [start[0]]
    stride = step[1] if step else Fraction(1)
    count = (stop[1] - start[1]) / stride
    if not 0 <= count < MOST_TABLE_VALUES:
        raise ValueError(count)
    return [_heading(start[1] + i * stride) for i in range(int(count) + 1)]


def _heading(value: Fraction) -> str:
    """0.24 for 6/25; a fraction that ends in no decimal stays one."""
    decimal = Decimal(value.numerator) / value.denominator
    return f"{decimal.normalize():f}" if Fraction(decimal) == value else str(value)
