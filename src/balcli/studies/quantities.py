"""Quantities that a user asks for, by their names: of forces and moments (`force.2.major`), and of
the chapters beyond (`mode.roll.Hz`, `torsion.1.Hz`, `torque.mean`, `guide.6.H`), whose modules are
loaded when one of theirs is asked for.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Protocol, cast

from ..enginefile.fields import suggest_nearest
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..forces.quantity import Quantity, parse_quantity
from .quantity_names import BEGINNINGS, CHAPTERS, ENGINE, Chapter, Form, find_chapter


@dataclass(frozen=True)
class NamedEngine:
    """The engine that a result is of.

    Attributes:
        name: Its name in its file.
    """

    name: str


class ChapterQuantity(Protocol):
    """A figure by its name, and its unit."""

    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...


AnyQuantity = Quantity | ChapterQuantity
Chapters = Mapping[Chapter, Sequence[ChapterQuantity]]


class Variants(Protocol):
    """Evaluates some quantities of variants of a file one by one."""

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """The value of each for one variant, by the figures that vary."""


class ChapterModule(Protocol):
    """What a module has that computes quantities of its own."""

    def parse_quantity(self, text: str) -> ChapterQuantity:
        """The quantity of this name. BalcliError: there is none."""

    def list_names(self, model: EngineFile) -> Iterable[str]:
        """Those that a file has, with N for any order."""

    def refuse_unknown(self, model: EngineFile, quantities: Sequence[ChapterQuantity]) -> None:
        """BalcliError if one is of what the file does not have."""

    def Variants(  # a class, which a function may be, too
        self, model: EngineFile, quantities: Sequence[ChapterQuantity]
    ) -> Variants: ...


def load_chapter(chapter: Chapter) -> ChapterModule:
    """The module that computes the quantities of a chapter, which is not ENGINE."""
    return cast(ChapterModule, import_module(f"balcli.{chapter.module}"))


def parse_quantities(text: str, *, with_gas: bool = False) -> tuple[AnyQuantity, ...]:
    """All that are named, in this order, each once.

    Args:
        with_gas: whether the engine has gas: its `torque` is then that of gas and inertia.

    Raises:
        BalcliError: what is none, with what there is.
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    if not words:
        raise BalcliError(
            "no quantity is given; name some, such as force.2.major,moment.1.backward"
        )
    return tuple(dict.fromkeys(_parse_quantity(word, with_gas) for word in words))


def _parse_quantity(word: str, with_gas: bool) -> AnyQuantity:
    chapter = find_chapter(word)
    if chapter is None:
        there = f"one begins with {', '.join(BEGINNINGS[:-1])} or {BEGINNINGS[-1]}"
        hint = suggest_nearest(word.partition(".")[0], BEGINNINGS, there)
        raise BalcliError(f"{word} is no quantity: {hint}")
    if chapter is ENGINE:
        return parse_quantity(word, with_gas=with_gas)
    return load_chapter(chapter).parse_quantity(word)


def choose_of_engine(wanted: Iterable[AnyQuantity]) -> tuple[Quantity, ...]:
    """Those of forces and moments, which are evaluated as arrays."""
    return tuple(q for q in wanted if isinstance(q, Quantity))


def group_by_chapter(wanted: Iterable[AnyQuantity]) -> Chapters:
    """All others by their chapters."""
    groups: dict[Chapter, list[ChapterQuantity]] = {}
    for q in wanted:
        if isinstance(q, Quantity):
            continue
        chapter = find_chapter(q.name)
        if chapter is not None:
            groups.setdefault(chapter, []).append(q)
    return groups


def refuse_unknown_of_chapters(model: EngineFile, wanted: Iterable[AnyQuantity]) -> None:
    """Nothing, unless one of these is of what the file does not have.

    Raises:
        BalcliError, InputError: it is, with what there is.
    """
    for chapter, members in group_by_chapter(wanted).items():
        load_chapter(chapter).refuse_unknown(model, members)


def list_quantities(model: EngineFile) -> Iterator[Form]:
    """What can be asked of an engine file, chapter by chapter; N stands for any order.

    Raises:
        BalcliError, InputError: a chapter of the file is not right.
    """
    for chapter in CHAPTERS:
        forms = [form for form in chapter.forms if not form.table or getattr(model, form.table)]
        if chapter is ENGINE:
            yield from forms
        elif forms:
            yield from _list_of_chapter(chapter, model)


def _list_of_chapter(chapter: Chapter, model: EngineFile) -> Iterator[Form]:
    module = load_chapter(chapter)
    for name in module.list_names(model):
        form = next(form for form in chapter.forms if form.matches(name))
        yield form._replace(pattern=name)
