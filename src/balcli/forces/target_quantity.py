"""Quantities of something by its number or name: `mode.3.Hz`, `mount.left.force`, `guide.6.H`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from ..enginefile.fields import shorten, suggest_nearest
from ..errors import BalcliError


class Subject(NamedTuple):
    """What quantities are of, by the word that their names begin with.

    Attributes:
        example: one of its numbers or names, for messages.
        units: SI unit of everything that can be asked of it.
    """

    example: str
    units: Mapping[str, str]


@dataclass(frozen=True)
class TargetQuantity:
    """One figure.

    Attributes:
        kind: of what, such as `mount`.
        target: its number or name.
        part: what of it.
        unit: SI, or percent.
    """

    kind: str
    target: str
    part: str
    unit: str = field(compare=False)

    @property
    def name(self) -> str:
        """As a user writes it."""
        return f"{self.kind}.{self.target}.{self.part}"


def parse_target_quantity(text: str, subjects: Mapping[str, Subject]) -> TargetQuantity:
    """`kind.target.part`, the kind one of the subjects.

    Raises:
        BalcliError: a part that there is not, or no target, with what there is.
    """
    kind, _, rest = text.partition(".")
    target, _, part = rest.rpartition(".")
    units = subjects[kind].units
    if part not in units or not target:
        there = " or ".join(f"{kind}.{subjects[kind].example}.{each}" for each in units)
        raise BalcliError(f"{text} is no quantity: give {there}")
    return TargetQuantity(kind, target, part, units[part])


def refuse_stranger(q: TargetQuantity, there: Sequence[str]) -> None:
    """Nothing, unless the file does not have what a quantity is of.

    Args:
        there: names of what it has of this kind.

    Raises:
        BalcliError: with the nearest name, or some of those that there are.
    """
    if q.target in there:
        return
    some = f"there are {', '.join(there[:8])}" if there else "there is none"
    hint = suggest_nearest(q.target, there, some)
    raise BalcliError(f"{q.name}: the file has no {q.kind} {shorten(q.target)}; {hint}")
