"""Define the base class of all tables of a file, and types for their keys."""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Callable, Iterator
from functools import cache
from inspect import getsource
from itertools import pairwise
from textwrap import dedent
from typing import TYPE_CHECKING, Annotated, ClassVar, NamedTuple, get_args

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic.fields import FieldInfo

from ..core.records import Node
from ..limits import MOST_LIST_VALUES
from .fields import Choice, Label, ListOrEach, Number, OneOf, OneOrEach, Whole, as_written
from .units import (
    ANGLE,
    DENSITY,
    ENERGY,
    INERTIA,
    LENGTH,
    MASS,
    PLAIN,
    SPEED,
)

if TYPE_CHECKING:
    from pydantic import GetJsonSchemaHandler
    from pydantic_core import CoreSchema

INTERVAL_TOLERANCE_DEG = 0.5  # of the sum of firing intervals, which are often printed rounded

# The bounds of figures are far beyond any engine; products and powers of bounds do not overflow.
Length = Annotated[float, Number(LENGTH, most=1e9)]

Distance = Annotated[float, Number(LENGTH, least=0, most=1e9)]

Size = Annotated[float, Number(LENGTH, above=0, most=1e9)]

Density = Annotated[float, Number(DENSITY, above=0, most=30)]

Mass = Annotated[float, Number(MASS, least=0, most=1e12)]

Masses = Annotated[float | tuple[float, ...], OneOrEach(Number(MASS, least=0, most=1e12))]

Angle = Annotated[float, Number(ANGLE, most=1e9)]  # about 3 million turns

Interval = Annotated[float, Number(ANGLE, least=0, most=720)]

Inertia = Annotated[float, Number(INERTIA, least=0, most=1e24)]

INERTIA_ABOVE_0 = Number(INERTIA, above=0, most=1e24)
GivenInertia = Annotated[float, INERTIA_ABOVE_0]

FIT = "fit"  # text in place of a number, for an unbalance that `balance` computes

Speed = Annotated[float, Number(SPEED, above=0, most=1e9)]

Heat = Annotated[float, Number(ENERGY, least=0, most=1e12)]

RodRatio = Annotated[float, Number(PLAIN, above=0, below=1)]

Share = Annotated[float, Number(PLAIN, least=-1, most=1)]

Count = Annotated[int, Whole(least=1, most=MOST_LIST_VALUES)]

Name = Annotated[str, Label()]

Switch = Annotated[bool, OneOf(True, False, meaning="write it without quotes")]

Angles = Annotated[tuple[Angle, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

Lengths = Annotated[tuple[Length, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

Intervals = Annotated[tuple[Interval, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

Numbers = Annotated[tuple[Count, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

AnglesOfRows = Annotated[tuple[float, ...] | tuple[tuple[float, ...], ...], ListOrEach(Angles)]

NumbersOfBanks = Annotated[tuple[Numbers, ...], Field(min_length=1, max_length=MOST_LIST_VALUES)]

Place = Annotated[tuple[Length, ...], Field(min_length=2, max_length=2)]

Triple = Annotated[tuple[Length, ...], Field(min_length=3, max_length=3)]


class KeyDocument(NamedTuple):
    """The documentation of a key.

    Attributes:
        description: Meaning of the key.
        example: Example of a value; None if there is none.
    """

    description: str = ""
    example: object = None


@cache
def _list_rules(table: type) -> tuple[Callable[[object], Iterator[str]], ...]:
    """Return the rules of a class of tables; rules of base classes come first."""
    rules = []
    for base in reversed(table.__mro__):
        rules += [rule for name, rule in vars(base).items() if name.startswith("_check_")]
    return tuple(rules)


class FileTable(BaseModel):
    """A table of an engine file. It is frozen and rejects unknown keys. Its methods `_check_...`
    are rules: each yields messages about contradictions between keys.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)
    choices: ClassVar[tuple[Choice, ...]] = ()
    by_number: ClassVar[bool] = False  # whether dotted names have numbers even if tables have names

    @model_validator(mode="after")
    def _consistent(self) -> FileTable:
        """If keys contradict each other, raise ValueError; its arguments are the messages."""
        of_choices = [fault for choice in self.choices for fault in choice.mistakes(self.given)]
        if found := [*of_choices, *self.contradictions()]:
            raise ValueError(*found)
        return self

    def contradictions(self) -> Iterator[str]:
        """Yield messages about the contradictions that the rules of this table find. Rules of base
        classes come first.
        """
        for rule in _list_rules(type(self)):
            yield from rule(self)

    @property
    def given(self) -> set[str]:
        """Keys that the file gives."""
        return self.model_fields_set

    def check_below(self, inner: str, outer: str) -> Iterator[str]:
        """Yield a message if a length (mm) such as a bore is not below the length around it.

        Args:
            inner: Key of the length.
            outer: Key of the length around it.
        """
        bore = getattr(self, inner)
        diameter = getattr(self, outer)
        if bore and (diameter is None or bore >= diameter):
            limit = ", which is missing" if diameter is None else f" = {as_written(diameter, 'mm')}"
            yield f"{inner} = {as_written(bore, 'mm')}: has to be below {outer}{limit}"

    def has(self, key: str) -> bool:
        """Return whether the file gives a key."""
        return key in self.given

    def rivals(self, key: str) -> tuple[str, ...]:
        """Return the keys that exclude this key, because they give the same figure."""
        return tuple(rival for choice in self.choices for rival in choice.rivals(key))

    @classmethod
    def keys(cls) -> dict[str, FieldInfo]:
        """Return the fields of this table by their keys in a file."""
        return {field.alias or name: field for name, field in cls.model_fields.items()}

    @classmethod
    def find_unit(cls, key: str) -> str:
        """Return the unit of a bare number; empty for a plain number, a word or a whole number."""
        number = find_number(cls, key)
        return "" if number is None else number.dimension.unit

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> Node:
        node = handler(schema)
        properties = handler.resolve_ref_schema(node)["properties"]
        for key, document in document_keys(cls).items():
            if document.description:
                properties[key]["description"] = document.description
            if document.example is not None:
                properties[key]["examples"] = [document.example]
        return node


@cache
def find_number(table: type[FileTable], key: str) -> Number | None:
    """Return the reader of a field that is a number or a list of numbers; None for other fields.
    Whole numbers count as other fields.
    """
    field = table.model_fields[key]
    marks = [*field.metadata, *_list_marks(field.annotation)]
    for mark in tuple(marks):
        if isinstance(mark, OneOrEach):
            marks.append(mark.one)
        elif isinstance(mark, ListOrEach):
            marks += _list_marks(mark.one)
    return next((mark for mark in marks if isinstance(mark, Number)), None)


def _list_marks(annotation: object) -> Iterator[object]:
    """Yield the parts of an annotation, without the fields of inner tables."""
    for part in get_args(annotation):
        if isinstance(part, type) and issubclass(part, FileTable):
            continue
        yield part
        yield from _list_marks(part)


@cache
def document_keys(table: type[FileTable]) -> dict[str, KeyDocument]:
    """Return the documentation of every key of a table: the string below the key, which ends with
    an example in TOML. Python does not keep such strings, so the source is read.
    """
    documents = dict.fromkeys(table.keys(), KeyDocument())
    for base in reversed(table.__mro__):
        if issubclass(base, FileTable) and base is not FileTable:
            documents |= _read_documents(base)
    for key, field in table.keys().items():
        if field.description:  # a table may use pydantic's own descriptions
            documents[key] = KeyDocument(field.description, *(field.examples or ())[:1])
    return documents


def _read_documents(table: type[FileTable]) -> dict[str, KeyDocument]:
    """Return the documentation of the keys that the class of a table itself declares."""
    documents = {}
    (declared,) = ast.parse(dedent(getsource(table))).body
    for key, text in pairwise(declared.body):  # type: ignore[attr-defined]
        match key, text:
            case (
                ast.AnnAssign(target=ast.Name(id=name)),
                ast.Expr(value=ast.Constant(value=str(document))),
            ):
                words, _, example = " ".join(document.split()).partition(". Example: ")
                meaning = words.removesuffix(".")
                if not meaning[1].isupper():  # no abbreviation, such as CSV
                    meaning = meaning[0].lower() + meaning[1:]
                read = tomllib.loads(f"example = {example}")["example"] if example else None
                documents[name] = KeyDocument(meaning, read)
    return documents


def label_table(table: FileTable, number: int) -> str:
    """Return the part of a dotted name that stands for a table in a list: the table's name with `_`
    for spaces, if this is an identifier; otherwise the table's number.

    Args:
        table: Table, which may have a name.
        number: Number of the table, from 1.
    """
    # Balancer shafts are numbered: `shaft.NAME` is a shaft of [torsion].
    name = "" if table.by_number else getattr(table, "name", "").replace(" ", "_")
    return name if name.isidentifier() else str(number)
