"""What every table of a file shares: types of its figures, rules among its keys."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Set
from typing import Annotated, Any, ClassVar, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, model_validator
from pydantic.fields import FieldInfo

from ..limits import HIGHEST_RIPPLE_ORDER, HIGHEST_SHAFT_ORDER, MOST_LIST_VALUES
from .fields import Choice, Label, Number, Whole
from .units import ANGLE, ENERGY, INERTIA, LENGTH, MASS, PLAIN, SPEED, TIME, UNBALANCE

INTERVAL_TOLERANCE_DEG = 0.5  # firing intervals are often printed rounded

# Bounds of figures are far beyond every engine; products and powers of them overflow nothing.
Length = Annotated[float, Number(LENGTH, most=1e9)]

Distance = Annotated[float, Number(LENGTH, least=0, most=1e9)]

Size = Annotated[float, Number(LENGTH, above=0, most=1e9)]

Mass = Annotated[float, Number(MASS, least=0, most=1e12)]

Angle = Annotated[float, Number(ANGLE, most=1e9)]  # a million turns, and then some

Interval = Annotated[float, Number(ANGLE, least=0, most=720)]

Inertia = Annotated[float, Number(INERTIA, least=0, most=1e24)]

GivenInertia = Annotated[float, Number(INERTIA, above=0, most=1e24)]

FIT = "fit"  # in place of an unbalance: `balance` finds it
Unbalance = Annotated[float, Number(UNBALANCE, most=1e24, word=FIT)]

Speed = Annotated[float, Number(SPEED, above=0, most=1e9)]

Period = Annotated[float, Number(TIME, above=0, most=1e6)]

ShareOfGas = Annotated[float, Number(PLAIN, least=0, most=100)]

Heat = Annotated[float, Number(ENERGY, least=0, most=1e12)]

RodRatio = Annotated[float, Number(PLAIN, above=0, below=1)]

Share = Annotated[float, Number(PLAIN, least=-1, most=1)]

Count = Annotated[int, Whole(least=1, most=MOST_LIST_VALUES)]

RippleOrder = Annotated[float, Whole(least=0.5, most=HIGHEST_RIPPLE_ORDER, halves=True)]

ShaftRatio = Annotated[int, Whole(least=-HIGHEST_SHAFT_ORDER, most=HIGHEST_SHAFT_ORDER, zero=False)]

Name = Annotated[str, Label()]

Angles = Annotated[tuple[Angle, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

Lengths = Annotated[tuple[Length, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

Intervals = Annotated[tuple[Interval, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

Numbers = Annotated[tuple[Count, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

NumbersOfBanks = Annotated[tuple[Numbers, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

Place = Annotated[tuple[Length, ...], Field(min_length=2, max_length=2)]

Triple = Annotated[tuple[Length, ...], Field(min_length=3, max_length=3)]


def key(description: str, *examples: object, default: Any = None) -> Any:
    """Return the pydantic field of a key that may be left out.

    Args:
        description: what it means, for the schema and the reference.
        examples: a value that it may have.
        default: what counts where it is left out; None: nothing, or what the description says.
    """
    return Field(default, description=description, examples=list(examples) or None)


def needed(description: str, *examples: object) -> Any:
    """Return the pydantic field of a key that has to be there; arguments as of `key`."""
    return Field(description=description, examples=list(examples) or None)


class TableRule(NamedTuple):
    """A rule for the keys of a table.

    Attributes:
        check: yields what is wrong, in words.
        needs: keys without whose values nothing can be said of it.
        wants: keys of which one is enough.
    """

    check: Callable[[Any], Iterator[str]]
    needs: Set[str]
    wants: Set[str] = frozenset()


class FileTable(BaseModel):
    """A table of the engine file: frozen, and an unknown key is a mistake."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)
    choices: ClassVar[tuple[Choice, ...]] = ()
    rules: ClassVar[tuple[TableRule, ...]] = ()

    @model_validator(mode="after")
    def _consistent(self, info: ValidationInfo) -> FileTable:
        """Refuse contradictions. A context stands for a table that is known to have mistakes."""
        if info.context is None:
            given = self.model_fields_set
            of_choices = [fault for choice in self.choices for fault in choice.mistakes(given)]
            if found := [*of_choices, *self.contradictions()]:
                raise ValueError("; ".join(found))
        return self

    def contradictions(self) -> Iterator[str]:
        """Yield what the fields of this table say against each other."""
        for rule in self.rules:
            yield from rule.check(self)

    def rivals(self, key: str) -> tuple[str, ...]:
        """Return the keys that exclude this one, since they say the same."""
        return tuple(rival for choice in self.choices for rival in choice.rivals(key))

    @classmethod
    def keys(cls) -> dict[str, FieldInfo]:
        """Return the fields of this table by their keys, as a file has them."""
        return {field.alias or name: field for name, field in cls.model_fields.items()}
