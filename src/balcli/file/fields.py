"""Define pydantic types for the values of an engine file. Each type checks a value and describes it
in JSON Schema. `Choice` is for keys of a table that exclude each other.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, get_args

from ..core.records import Node
from ..limits import (
    LONGEST_FILE_NAME,
    LONGEST_NAME,
    LONGEST_SHOWN,
    MOST_LIST_VALUES,
    SMALLEST_POSITIVE,
    WRITTEN_DIGITS,
)
from .units import PLAIN, Dimension, convert, wanted

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic_core import CoreSchema


_DIGITS = "0-9０-９¼-¾⅐-⅞"
_LAST = 'A-Za-zА-я°ºµμ²³¹π"”″㎀-㏟'
STRING_PATTERN = rf"^\s*[+−–-]?\s*(?:pi|π|(?:[{_DIGITS}.]|pi|π).*[{_LAST}{_DIGITS}.])\s*$"
RIGID = "rigid"  # text for the infinite stiffness of a flange or of meshing gears


def printable(text: str) -> str:
    """Return the first 60 characters, with "?" for characters that cannot be printed."""
    cut = text[:LONGEST_SHOWN] + ("..." if len(text) > LONGEST_SHOWN else "")
    return "".join(letter if letter.isprintable() else "?" for letter in cut)


def shorten(value: object) -> str:
    """Return a value in recognizable form, cut to about 60 characters."""
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


class WrittenFigure(float):
    """A figure that a file gives with its own unit; `text` is the text in the file."""

    text: str

    def __new__(cls, value: float, text: str) -> WrittenFigure:
        figure = super().__new__(cls, value)
        figure.text = text
        return figure

    def __getnewargs__(self) -> tuple[float, str]:  # type: ignore[override]
        return float(self), self.text


def as_written(value: float, unit: str) -> str:
    """Return a figure as its file writes it.

    Args:
        value: Figure.
        unit: Unit of a bare number.
    """
    text = value.text if isinstance(value, WrittenFigure) else f"{value:g} {unit}"
    return printable(text.strip())


def order_number(order: float) -> int | float:
    """Return an order for output: an int if it is whole."""
    return int(order) if order == int(order) else float(order)


def limit_digits(value: object) -> Any:
    """Return a value, list or table with every number rounded to twelve significant digits: 40480.2
    in place of 40480.200000000004.
    """
    if isinstance(value, float):
        return float(f"{value:.{WRITTEN_DIGITS}g}")
    if isinstance(value, Mapping):
        return {key: limit_digits(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(map(limit_digits, value))
    return value


_LAST_DIGITS = 1e-15  # relative rounding error of a few operations


def drop_last_digits(value: object) -> Any:
    """Return a value, list or table without the rounding errors in the last digits of its numbers:
    40480.2 in place of 40480.200000000004. Numbers that need all their digits keep them, such as
    the degrees of a seventh of a turn.
    """
    if isinstance(value, float):
        shorter = float(limit_digits(value))
        return shorter if abs(shorter - value) <= _LAST_DIGITS * abs(value) else value
    if isinstance(value, Mapping):
        return {key: drop_last_digits(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(map(drop_last_digits, value))
    return value


def counted(count: int, noun: str) -> str:
    """Return a number with its noun: "1 place", "2 places".

    Args:
        count: Number.
        noun: Noun in the singular.
    """
    return f"{count} {noun}{'s' * (count != 1)}"


def ordinal(number: int) -> str:
    """Return an ordinal number: 1st, 2nd, 3rd, 4th ..."""
    if number % 100 in (11, 12, 13):
        return f"{number}th"
    suffix = {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{suffix}"


def count_lambda_digits(ratio: float, usual: int = 4) -> int:
    """Return the number of digits of crank radius / rod length to show: more near 1, where the
    crank locks.

    Args:
        ratio: Crank radius / rod length.
        usual: Digits for a ratio that is not near 1.
    """
    return usual if ratio < 0.999 else max(usual, 7)


def nearest(word: str, names: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the known word that was probably meant; empty if none is near.

    Args:
        word: Unknown word.
        names: Known words.
        cutoff: Least similarity; equal words have 1.
    """
    from difflib import get_close_matches

    near = get_close_matches(word.lower(), list(names), 1, cutoff) if len(word) < 100 else []
    return near[0] if near else ""


def suggest_nearest(word: str, names: Iterable[str], otherwise: str) -> str:
    """Return "did you mean ...?" for the known word that was probably meant, else another text.

    Args:
        word: Unknown word.
        names: Known words.
        otherwise: Text if no known word is near.
    """
    near = nearest(word, names)
    return f"did you mean {near}?" if near else otherwise


class _Field:
    """A type of value. `read` returns a value or raises ValueError; `json` returns a schema."""

    def read(self, value: object) -> object:
        raise NotImplementedError

    def json(self) -> Node:
        raise NotImplementedError

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> Node:
        return self.json()


class Number(_Field):
    """A figure of some dimension: a bare number in the unit of the file, or text with a unit."""

    def __init__(
        self,
        dimension: Dimension,
        *,
        above: float | None = None,
        least: float | None = None,
        below: float | None = None,
        most: float = math.inf,
        word: str = "",
        meaning: float = math.nan,
    ) -> None:
        self.dimension = dimension
        self.above = above
        self.below = below
        self.most = most
        self.word = word
        self.meaning = meaning  # text allowed instead of a number, and its value
        self.least = -most if least is None and above is None else least

    def read(self, value: object) -> float:
        if self.word and value == self.word:
            return WrittenFigure(self.meaning, self.word)
        try:
            number = self._measure(value)
        except ValueError as error:
            raise ValueError(f"{shorten(value)} {error}") from None
        return WrittenFigure(number, value) if isinstance(value, str) else number

    def _measure(self, value: object) -> float:
        """Return a figure in the unit of the file; if it is not valid, raise ValueError with the
        reason.
        """
        if isinstance(value, str):
            number = convert(value, self.dimension)
        elif isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(f"is not a number; {wanted(self.dimension)}")
        else:
            number = math.inf if abs(value) > sys.float_info.max else float(value)
        if not math.isfinite(number):
            raise ValueError(f"is not a finite number; {wanted(self.dimension)}")
        if fault := self._fault(number):
            raise ValueError(f"is {fault[0]}; {wanted(self.dimension)}, {fault[1]}")
        return number

    def _fault(self, number: float) -> tuple[str, str] | None:
        """Return how a number is out of bounds, and the bound; None if it is within the bounds."""
        if self.above is not None and number <= self.above:
            return f"not above {self.above:g}", f"above {self.above:g}"
        if self.above == 0 and number < SMALLEST_POSITIVE:
            return "too small", f"at least {SMALLEST_POSITIVE:g}"
        if self.least is not None and number < self.least:
            return f"less than {self.least:g}", f"{self.least:g} or more"
        if self.below is not None and number >= self.below:
            return f"not below {self.below:g}", f"below {self.below:g}"
        if number > self.most:
            return f"more than {self.most:g}", f"up to {self.most:g}"
        return None

    def json(self) -> Node:
        bounds = {
            "exclusiveMinimum": self.above,
            "minimum": self.least,
            "exclusiveMaximum": self.below,
            "maximum": self.most,
        }
        limits = {key: bound for key, bound in bounds.items() if bound not in (None, math.inf)}
        if self.dimension is PLAIN:
            return {"type": "number", **limits}
        pattern = f"{STRING_PATTERN}|^{self.word}$" if self.word else STRING_PATTERN
        unit = {"unit": self.dimension.unit, "pattern": pattern}
        return {"type": ["number", "string"], **unit, **limits}


class AnyFigure(_Field):
    """A number, or text with a unit. Its dimension is not known here; the reader of the table
    checks it.
    """

    def read(self, value: object) -> float | str:
        if isinstance(value, str) and value.strip():
            return value
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError(
                f"{shorten(value)} is not a figure; give a number, or text with a unit"
            )
        if not abs(value) <= sys.float_info.max:  # also nan, and integers too large for a float
            raise ValueError(f"{shorten(value)} is not a finite number")
        return float(value)

    def json(self) -> Node:
        return {"anyOf": [{"type": "number"}, {"type": "string"}]}


class Whole(_Field):
    """A whole number (4.0 counts as 4); if `halves` is true, a multiple of 1/2."""

    def __init__(self, *, least: float, most: int, zero: bool = True, halves: bool = False) -> None:
        self.least = least
        self.most = most
        self.zero = zero
        self.halves = halves

    def read(self, value: object) -> float:
        wanted = (
            f"a whole{' or half' * self.halves} number from {self.least:g} to {self.most}"
            f"{'' if self.zero else ', not 0,'} is wanted"
        )
        if isinstance(value, str) and re.fullmatch(r"\s*[+-]?[0-9]{1,6}\s*", value):
            value = int(value)
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not is_number or (2 * value if self.halves else value) % 1:  # type: ignore[operator]
            kind = "multiple of 1/2" if self.halves else "whole number"
            raise ValueError(f"{shorten(value)} is not a {kind}; {wanted}")
        number: float = value  # type: ignore[assignment]
        if not self.least <= number <= self.most or (number == 0 and not self.zero):
            raise ValueError(f"{shorten(value)} is out of range; {wanted}")
        return order_number(number)

    def json(self) -> Node:
        kind = {"type": "number", "multipleOf": 0.5} if self.halves else {"type": "integer"}
        limits = {"minimum": self.least, "maximum": self.most}
        return kind | limits | ({} if self.zero else {"not": {"const": 0}})


class SpeedRatio(_Field):
    """A speed over crank speed: any number but 0, positive or negative. Whole numbers are ints."""

    def __init__(self, most: int) -> None:
        self.most = most

    def read(self, value: object) -> float:
        wanted = f"a number from -{self.most} to {self.most}, not 0, is wanted"
        if isinstance(value, str) and re.fullmatch(r"\s*[+-]?[0-9]{1,6}(\.[0-9]{0,15})?\s*", value):
            value = float(value)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or value != value:
            raise ValueError(f"{shorten(value)} is not a number; {wanted}")
        if not SMALLEST_POSITIVE <= abs(value) <= self.most:
            raise ValueError(f"{shorten(value)} is out of range; {wanted}")
        return order_number(value)

    def json(self) -> Node:
        return {"type": "number", "minimum": -self.most, "maximum": self.most, "not": {"const": 0}}


class OneOrEach:
    """A figure that holds for all members of a group, or a list with a figure for each member.

    Args:
        one: Type of a figure.
        count: Number of figures in a list; 0: any number.
        copies: Number of members for which a single figure is repeated; 0: it is not repeated.
        words: Words that may stand in place of figures.
    """

    def __init__(
        self, one: _Field, count: int = 0, copies: int = 0, words: tuple[str, ...] = ()
    ) -> None:
        self.one = one
        self.count = count
        self.copies = copies
        self.words = words

    def read_one(self, value: object) -> object:
        """Return the stored form of a figure that holds for all members, or a word."""
        if self.words and isinstance(value, str) and value.strip()[:1].isalpha():
            if value in self.words:
                return value
            words = " or ".join(f'"{word}"' for word in self.words)
            raise ValueError(
                f"{shorten(value)} is no known word; give a figure, a list, or {words}"
            )
        return (self.one.read(value),) * self.copies if self.copies else self.one.read(value)

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        from pydantic import Field
        from pydantic_core import core_schema

        def read(value: object, each: Callable[[object], object]) -> object:
            return each(value) if isinstance(value, (list, tuple)) else self.read_one(value)

        limits = Field(min_length=self.count or 1, max_length=self.count or MOST_LIST_VALUES)
        members = tuple[Annotated[float, self.one], ...]
        each_schema = handler.generate_schema(Annotated[members, limits])
        return core_schema.no_info_wrap_validator_function(read, each_schema)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> Node:
        one = self.one.json()
        forms = [one, handler(schema)]
        if self.words:
            forms.append({"enum": list(self.words)})
        return {"anyOf": forms} | {key: one[key] for key in one.keys() & {"unit"}}


class NumberOrTable:
    """A figure, or a table that says how it depends on something else.

    Args:
        number: Type of a figure.
        words: Words that may stand for the figure.
    """

    def __init__(self, number: Number, *words: str) -> None:
        self.number = number
        self.words = words

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        from pydantic_core import core_schema

        def read(value: object, read_table: Callable[[object], object]) -> object:
            if isinstance(value, Mapping):
                return read_table(value)
            return value if value in self.words else self.number.read(value)

        table = next(part for part in get_args(source) if part not in (float, str))
        schema = handler.generate_schema(table)
        return core_schema.no_info_wrap_validator_function(read, schema)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> Node:
        kinds = [self.number.json(), handler(schema)]
        if self.words:
            kinds.append({"enum": list(self.words)})
        return {"anyOf": kinds}


class ListOrEach:
    """A list that holds for all rows of cylinders, or a list of such lists, one for each row.

    Args:
        one: Type of a list.
    """

    def __init__(self, one: object) -> None:
        self.one = one

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        from pydantic_core import core_schema

        def read(value: object, read_row: Callable[[object], object]) -> object:
            rows = value if isinstance(value, (list, tuple)) else ()
            several = any(isinstance(row, (list, tuple)) for row in rows)
            return tuple(map(read_row, rows)) if several else read_row(value)

        one_schema = handler.generate_schema(self.one)
        return core_schema.no_info_wrap_validator_function(read, one_schema)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> Node:
        one = handler(schema)
        return {"anyOf": [one, {"type": "array", "items": one}], "unit": one["items"]["unit"]}


class OneOf(_Field):
    """One of a few words or numbers. `meaning` explains them in messages about other values."""

    def __init__(self, *options: str | int, meaning: str = "") -> None:
        self.options = options
        self.meaning = meaning

    def read(self, value: object) -> str | int:
        for option in self.options:
            if value == option and isinstance(value, bool) == isinstance(option, bool):
                return option
        hint = suggest_nearest(str(value), map(str, self.options), self.meaning)
        message = f"{shorten(value)} is not {' or '.join(map(shorten, self.options))}"
        raise ValueError(f"{message}; {hint}" if hint else message)

    def json(self) -> Node:
        return {"enum": list(self.options)}


class Label(_Field):
    """A name, of limited length."""

    most = LONGEST_NAME
    kind = "name"
    wanted = f"use up to {LONGEST_NAME} letters, digits and signs, in quotes"

    def read(self, value: object) -> str:
        is_text = isinstance(value, str) and value.strip() and value.isprintable()
        if not is_text or len(str(value)) > self.most:
            raise ValueError(f"{shorten(value)} is not a {self.kind}; {self.wanted}")
        return str(value)

    def json(self) -> Node:
        return {"type": "string", "minLength": 1, "maxLength": self.most}


class FileName(Label):
    """The name of a file, of limited length."""

    most = LONGEST_FILE_NAME
    kind = "name of a file"
    wanted = 'give the name of a file, such as "p_2000rpm.csv"'


class Choice(NamedTuple):
    """Groups of keys that exclude each other.

    Attributes:
        groups: Groups of keys, of which one may be given.
        required: Whether one group must be given.
        unless: Key that makes all groups optional if it is given; empty: there is no such key.
        complete: Whether all keys of a group must be given if one of them is given. If the value
            is a group, this is required only of this group.
        instead: Keys that may be given in place of a required group, or in addition to it.
    """

    groups: tuple[tuple[str, ...], ...]
    required: bool = False
    complete: bool | tuple[str, ...] = False
    instead: tuple[str, ...] = ()
    unless: str = ""

    def mistakes(self, given: Collection[str]) -> Iterator[str]:
        """Yield the mistakes in the given keys, as text that follows the name of the table."""
        begun = [group for group in self.groups if any(key in given for key in group)]
        keys = [key for group in begun for key in group if key in given]
        instead = [] if begun else self.instead
        choices = " or ".join([*map(join_words, self.groups), *instead])
        wanted = f"give {'either' if len(self.groups) > 1 else 'both'} {choices}"
        if len(begun) > 1:
            yield f"has {join_words(keys)}; {wanted}"
        elif not begun and self.required and not {*self.instead, self.unless}.intersection(given):
            yield f"has neither {' nor '.join(map(join_words, self.groups))}; {wanted}"
        elif begun and self.complete in (True, begun[0]) and len(keys) < len(begun[0]):
            missing = [key for key in begun[0] if key not in given]
            yield f"has {join_words(keys)} without {join_words(missing)}; {wanted}"

    def rivals(self, key: str) -> tuple[str, ...]:
        """Return the keys that exclude this key; empty if the key is in no group."""
        if not any(key in group for group in self.groups):
            return ()
        return tuple(other for group in self.groups if key not in group for other in group)

    def for_overrides(self, prefix: str) -> Choice:
        """Return this choice for keys with a prefix, without any required keys."""
        return Choice(tuple(tuple(prefix + key for key in group) for group in self.groups))


def join_words(words: Iterable[object]) -> str:
    """Return words or numbers joined as in a sentence: `a, b and c`."""
    *front, last = map(str, words)
    return f"{', '.join(front)} and {last}" if front else last
