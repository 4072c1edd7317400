"""Read a firing order: numbers of cylinders, or their names with a letter for the bank
(`"1R-6L-5R-2L"`, `["A1", "B4"]`).

The number of such a name counts along its bank from the free end. The file does not say which
letter is which bank: `engine.firing` finds it out. Until then, the banks have the letters in
alphabetical order.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from itertools import accumulate
from typing import TYPE_CHECKING, NamedTuple

from ..core.records import Node
from .fields import counted, join_words, shorten

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic_core import CoreSchema

_SEPARATOR = r"[-–—,;\s]+"
_NUMBER = "[0-9]{1,5}"
_LETTERED = f"[A-Za-z]{_NUMBER}|{_NUMBER}[A-Za-z]"
_ANY = f"(?:{_LETTERED}|{_NUMBER})"


class CylinderName(NamedTuple):
    """Name of a cylinder.

    Attributes:
        letter: Letter of its bank, a capital; empty if the name is a number alone.
        number: Number in the bank, from the free end.
        text: The name as the file writes it.
    """

    letter: str
    number: int
    text: str


class NamedOrder(tuple[int, ...]):
    """A firing order of names with letters: the numbers of the cylinders, counted bank by bank.

    Attributes:
        names: Name of each cylinder, in the firing order.
        letters: Letter of each bank, first bank first.
    """

    names: tuple[CylinderName, ...]
    letters: tuple[str, ...]

    def __new__(cls, names: Sequence[CylinderName], letters: Sequence[str]) -> NamedOrder:
        sizes = Counter(name.letter for name in names)
        before = accumulate((sizes[letter] for letter in letters), initial=0)
        first = dict(zip(letters, before, strict=False))
        order = super().__new__(cls, [first[name.letter] + name.number for name in names])
        order.names = tuple(names)
        order.letters = tuple(letters)
        return order

    def __getnewargs__(
        self,
    ) -> tuple[tuple[CylinderName, ...], tuple[str, ...]]:
        return self.names, self.letters

    @property
    def bank_sizes(self) -> list[int]:
        """Number of cylinders of each bank."""
        return [len(self.list_bank(letter)) for letter in self.letters]

    @property
    def text(self) -> str:
        """The firing order as a file writes it: 1R-6L-5R-2L."""
        return "-".join(name.text for name in self.names)

    def with_letters(self, letters: Sequence[str]) -> NamedOrder:
        """Return the same order with the letters of the banks in another sequence."""
        return NamedOrder(self.names, letters)

    def list_bank(self, letter: str) -> list[int]:
        """Return the numbers of the cylinders of a bank, rising."""
        numbers = []
        for number, name in zip(self, self.names, strict=True):
            if name.letter == letter:
                numbers.append(number)
        return sorted(numbers)

    def find_name(self, number: int) -> str:
        """Return the name of the cylinder with this number."""
        return self.names[self.index(number)].text


def write_order(order: Iterable[int]) -> str:
    """Return a firing order in words: 1-3-4-2, or with the names of the file."""
    if isinstance(order, NamedOrder):
        return order.text
    return "-".join(map(str, order))


class FiringOrder:
    """A firing order: a list of numbers or of names with letters, or the same as one text."""

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        from pydantic_core import core_schema

        return core_schema.no_info_wrap_validator_function(read_firing_order, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> Node:
        name = {"type": "string", "pattern": f"^({_LETTERED})$"}
        names = {"type": "array", "items": name, "minItems": 1}
        text = {"type": "string", "pattern": rf"^\s*{_ANY}({_SEPARATOR}{_ANY})+\s*$"}
        return {"anyOf": [handler(schema), names, text]}


def read_firing_order(value: object, check: Callable[[object], object]) -> object:
    """Return a firing order as numbers; names with letters become a `NamedOrder`.

    Args:
        value: Value in the file.
        check: Function that checks a list of numbers and returns it.

    Raises:
        ValueError: The names have mistakes.
    """
    parts = _split(value)
    if any(re.fullmatch(_LETTERED, part) for part in parts):
        order = _order_names([_read_name(part) for part in parts])
        check([*order])
        return order
    if isinstance(value, str) and parts and all(re.fullmatch(_NUMBER, part) for part in parts):
        return check([int(part) for part in parts])
    return check(value)


def _split(value: object) -> list[str]:
    """Return the members of a list, or the parts of a text with several parts; else an empty
    list.
    """
    if isinstance(value, (list, tuple)):
        return [str(part) for part in value]
    if not isinstance(value, str):
        return []
    parts = re.split(_SEPARATOR, value.strip())
    if len(parts) == 1:
        return []
    return parts


def _read_name(text: str) -> CylinderName:
    name = text.strip()
    if not re.fullmatch(_ANY, name):
        message = (
            f"{shorten(text)} does not name a cylinder; write a letter and a number, such as 1R"
        )
        raise ValueError(message)
    number = name.strip("".join(filter(str.isalpha, name)))
    letter = name.replace(number, "")
    return CylinderName(letter.upper(), int(number), name)


def _order_names(names: Sequence[CylinderName]) -> NamedOrder:
    """Return the firing order of names, whose banks have the letters in alphabetical order.

    Raises:
        ValueError: Names are without a letter, occur twice, or do not count along their banks.
    """
    bare = [name.text for name in names if not name.letter]
    if bare:
        raise ValueError(
            f"has letters, but cylinder {bare[0]} has none; write a letter with every number, or "
            "numbers alone"
        )
    times = Counter((name.letter, name.number) for name in names)
    twice = [name for name in names if times[name.letter, name.number] > 1]
    if twice:
        raise ValueError(f"has cylinder {twice[0].text} more than once; name every cylinder once")
    letters = sorted({name.letter for name in names})
    order = NamedOrder(names, letters)
    if len(letters) == 1:
        numbers = [name.number for name in names]
        message = f"names a single bank, {letters[0]}; write the numbers alone: {numbers}"
        raise ValueError(message)
    for letter in letters:
        _check_bank(order, letter)
    return order


def _check_bank(order: NamedOrder, letter: str) -> None:
    """Raise ValueError unless the cylinders of a bank are numbered from 1."""
    in_bank = sorted(name.number for name in order.names if name.letter == letter)
    wanted = range(1, len(in_bank) + 1)
    if in_bank == [*wanted]:
        return
    missing = next(number for number in wanted if number not in in_bank)
    message = (
        f"has {counted(len(in_bank), 'cylinder')} of bank {letter}: {join_words(in_bank)}, without "
        f"{missing}; the number counts along the bank, from 1 to {len(in_bank)}"
    )
    numbers = [name.number for name in order.names]
    if sorted(numbers) == [*range(1, len(numbers) + 1)]:
        banks = []
        for bank in order.letters:
            banks.append(sorted(name.number for name in order.names if name.letter == bank))
        message += (
            f". If the numbers count through the engine, write firing_order = {numbers} and "
            f"numbering = {banks}, with the list of the first bank first"
        )
    raise ValueError(message)
