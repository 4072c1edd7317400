"""Figures of an engine file as pydantic types: how one is read, refused, and its JSON schema."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..limits import LONGEST_FILE_NAME, LONGEST_NAME, LONGEST_SHOWN, SMALLEST_POSITIVE
from .units import PLAIN, Dimension, convert, wanted

if TYPE_CHECKING:
    from pydantic_core import CoreSchema

STRING_PATTERN = r"^\s*[+-]?(?:pi|π|(?:[0-9.]|pi|π).*[A-Za-z°µμ²³¹π\"”″0-9])\s*$"
RIGID = "rigid"  # a stiffness without end: of a flange, or a mesh of gears


def printable(text: str) -> str:
    """The first 60 characters; what moves the cursor or colours a terminal becomes a "?"."""
    cut = text[:LONGEST_SHOWN] + ("..." if len(text) > LONGEST_SHOWN else "")
    return "".join(letter if letter.isprintable() else "?" for letter in cut)


def shorten(value: object) -> str:
    """A value as a reader may recognise it, cut to about 60 characters, however huge it is."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int) and value.bit_length() > 200:
        return f"an integer of about {int(value.bit_length() * math.log10(2)) + 1} digits"
    if isinstance(value, str):
        return f'"{printable(value)}"'
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, (list, tuple)):
        items = ", ".join(shorten(v) for v in value[:8])
        text = f"[{items}{', ...' if len(value) > 8 else ''}]"
        return text if len(text) <= LONGEST_SHOWN else f"a list of {len(value)}"
    return f"{value:.15g}" if isinstance(value, float) else str(value)[:LONGEST_SHOWN]


def counted(count: int, what: str) -> str:
    """ "1 place", "2 places"."""
    return f"{count} {what}{'s' * (count != 1)}"


def count_lambda_digits(ratio: float, usual: int = 4) -> int:
    """Of crank radius / rod length, as it is told: more next to 1, where the crank locks."""
    return usual if ratio < 0.999 else max(usual, 7)


def parse_firing_order(value: object) -> object:
    """A firing order as tables print it (`"1-3-4-2"`) as a list; anything else as it is.

    Raises:
        ValueError: cylinders are named by bank and place, A1-B1-A2-B2, with their numbers.
    """
    if isinstance(value, str) and re.fullmatch(r"\s*\d{1,5}(?:\s*[-, ]\s*\d{1,5})+\s*", value):
        return [int(number) for number in re.findall(r"\d+", value)]
    names = re.split(r"[-, ]+", value.strip()) if isinstance(value, str) else value
    if isinstance(names, (list, tuple)) and names:
        named = [re.fullmatch(r"([A-Za-z])(\d{1,3})", str(name)) for name in names]
        if all(named):
            numbers = _count_through([(each[1].upper(), int(each[2])) for each in named if each])
            raise ValueError(
                "names cylinders by bank and place; here they have numbers: without "
                f"layout.numbering, bank by bank from the free end, they are {numbers}"
            )
    return value


def _count_through(names: Sequence[tuple[str, int]]) -> list[int]:
    """Numbers of cylinders that are named by the letter of the bank and the place in it."""
    banks = sorted({bank for bank, _ in names})
    size = max(place for _, place in names)
    return [banks.index(bank) * size + place for bank, place in names]


def nearest(word: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """The known word that was probably meant; empty if none is near. `cutoff`: 1 for equal ones."""
    from difflib import get_close_matches

    near = get_close_matches(word.lower(), list(known), 1, cutoff) if len(word) < 100 else []
    return near[0] if near else ""


def suggest_nearest(word: str, known: Iterable[str], otherwise: str) -> str:
    """A question for the known word that was probably meant; what to say otherwise if none is."""
    near = nearest(word, known)
    return f"did you mean {near}?" if near else otherwise


class _Field:
    """A type of field: `read` gives the value or raises ValueError, `json` describes it."""

    def read(self, value: object) -> object:
        raise NotImplementedError

    def json(self) -> dict[str, Any]:
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: Callable[[CoreSchema], Any]
    ) -> dict[str, Any]:
        return self.json()


class Number(_Field):
    """A figure of some dimension: a bare number in the file's unit, or a string with its own."""

    def __init__(
        self,
        dimension: Dimension,
        *,
        above: float | None = None,
        least: float | None = None,
        below: float | None = None,
        most: float = math.inf,
    ) -> None:
        self.dimension, self.above, self.least = dimension, above, least
        self.below, self.most = below, most

    def read(self, value: object) -> float:
        number = self._number(value)
        if not math.isfinite(number):
            raise ValueError(f"{shorten(value)} is no finite number; {wanted(self.dimension)}")
        if fault := self._fault(number):
            raise ValueError(
                f"{shorten(value)} is {fault[0]}; {wanted(self.dimension)}, {fault[1]}"
            )
        return number

    def _fault(self, number: float) -> tuple[str, str] | None:
        """How a number is out of bounds, and what bounds it has; None if it is within."""
        least = -self.most if self.least is None else self.least
        if self.above is not None and number <= self.above:
            return f"not above {self.above:g}", f"above {self.above:g}"
        if self.above == 0 and number < SMALLEST_POSITIVE:
            return "too small", f"at least {SMALLEST_POSITIVE:g}"
        if number < least:
            return f"less than {least:g}", f"{least:g} or more"
        if self.below is not None and number >= self.below:
            return f"not below {self.below:g}", f"below {self.below:g}"
        if number > self.most:
            return f"more than {self.most:g}", f"up to {self.most:g}"
        return None

    def _number(self, value: object) -> float:
        if isinstance(value, str):
            try:
                return convert(value, self.dimension)
            except ValueError as error:
                raise ValueError(f"{shorten(value)} {error}") from None
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(f"{shorten(value)} is not a number; {wanted(self.dimension)}")
        try:
            return float(value)
        except OverflowError:
            raise ValueError(
                f"{shorten(value)} is too large a number; {wanted(self.dimension)}"
            ) from None

    def json(self) -> dict[str, Any]:
        unbounded = self.above is None and self.least is None
        least = -self.most if unbounded else self.least
        bounds = {
            "exclusiveMinimum": self.above,
            "minimum": least,
            "exclusiveMaximum": self.below,
            "maximum": self.most,
        }
        limits = {
            key: bound
            for key, bound in bounds.items()
            if bound is not None and math.isfinite(bound)
        }
        if self.dimension is PLAIN:
            return {"type": "number", **limits}
        return {
            "type": ["number", "string"],
            "unit": self.dimension.unit,
            "pattern": STRING_PATTERN,
            **limits,
        }


class Whole(_Field):
    """A whole number; 4.0 counts as 4."""

    def __init__(self, *, least: int, most: int, zero: bool = True) -> None:
        self.least, self.most, self.zero = least, most, zero

    def read(self, value: object) -> int:
        whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not whole:
            raise ValueError(f"{shorten(value)} is not a whole number; {self._wanted()}")
        if not self.least <= value <= self.most or (value == 0 and not self.zero):
            raise ValueError(f"{shorten(value)} is out of range; {self._wanted()}")
        return int(value)

    def _wanted(self) -> str:
        return (
            f"a whole number from {self.least} to {self.most}{'' if self.zero else ', not 0,'} is "
            "wanted"
        )

    def json(self) -> dict[str, Any]:
        limits = {"type": "integer", "minimum": self.least, "maximum": self.most}
        return limits if self.zero else limits | {"not": {"const": 0}}


class Halves(_Field):
    """A multiple of 1/2 above 0."""

    def __init__(self, *, most: int) -> None:
        self.most = most

    def read(self, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or 2 * value % 1:
            raise ValueError(f"{shorten(value)} is not a multiple of 1/2; {self._wanted()}")
        if not 0.5 <= value <= self.most:
            raise ValueError(f"{shorten(value)} is out of range; {self._wanted()}")
        return int(value) if value == int(value) else value

    def _wanted(self) -> str:
        return f"a whole number or a half from 0.5 to {self.most} is wanted"

    def json(self) -> dict[str, Any]:
        return {"type": "number", "multipleOf": 0.5, "minimum": 0.5, "maximum": self.most}


class Flag(_Field):
    """true or false."""

    def read(self, value: object) -> bool:
        if not isinstance(value, bool):
            raise ValueError(
                f"{shorten(value)} is neither true nor false; write one of these, without quotes"
            )
        return value

    def json(self) -> dict[str, Any]:
        return {"type": "boolean"}


class FileName(_Field):
    """The name of a file, of at most some hundred characters."""

    def read(self, value: object) -> str:
        wanted = 'give the name of a file, such as "p_2000rpm.csv"'
        if not isinstance(value, str):
            raise ValueError(f"{shorten(value)} is not text; {wanted}")
        if not value.strip() or not value.isprintable() or len(value) > LONGEST_FILE_NAME:
            raise ValueError(f"{shorten(value)} is no name of a file; {wanted}")
        return value

    def json(self) -> dict[str, Any]:
        return {"type": "string", "minLength": 1, "maxLength": LONGEST_FILE_NAME}


class OneOf(_Field):
    """One of a few words or numbers; `meaning`: of these, for who writes another."""

    def __init__(self, *options: str | int, meaning: str = "") -> None:
        self.options, self.meaning = options, meaning

    def read(self, value: object) -> str | int:
        for option in self.options:
            if type(value) is not bool and value == option:
                return option
        near = nearest(value, [str(o) for o in self.options]) if isinstance(value, str) else ""
        hint = f"; did you mean {near}?" if near else f"; {self.meaning}" if self.meaning else ""
        raise ValueError(f"{shorten(value)} is not {' or '.join(map(shorten, self.options))}{hint}")

    def json(self) -> dict[str, Any]:
        return {"enum": list(self.options)}


class Label(_Field):
    """A short name."""

    def read(self, value: object) -> str:
        if not isinstance(value, str) or not value.strip():
            raise ValueError(f"{shorten(value)} is no name; write it in quotes")
        if len(value) > LONGEST_NAME or not value.isprintable():
            raise ValueError(
                f"{shorten(value)} is no name; use up to {LONGEST_NAME} letters, digits and signs"
            )
        return value

    def json(self) -> dict[str, Any]:
        return {"type": "string", "minLength": 1, "maxLength": LONGEST_NAME}
