"""Engines of a file that are geared together one to one: their tables, and their files."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, ClassVar

from ..errors import Problem
from ..limits import MOST_ENGINES
from .fields import FileName, Label, OneOf, shorten
from .table import Angle, FileTable, Switch, Triple

if TYPE_CHECKING:
    from .model import EngineFile


class EngineLabel(Label):
    """The name of an engine, which stands before those of its cylinders: `upper.3`."""

    wanted = "leave out dots, commas and spaces, which part names of cylinders"

    def read(self, value: object) -> str:
        name = super().read(value)
        if any(sign in ",." or sign.isspace() for sign in name):
            raise ValueError(f"{shorten(value)} is no {self.kind} of an engine; {self.wanted}")
        return name


class Engine(FileTable):
    """One of several engines that are geared together one to one."""

    by_number: ClassVar[bool] = True

    name: Annotated[str, EngineLabel()] = ""
    """Its name; left out: A, B and so on. Example: 'upper'"""
    file: Annotated[str, FileName()]
    """An engine file in the folder of this file or below it. Several engines may have the same one.
    Example: 'flat4.toml'"""
    ratio: Annotated[int, OneOf(1, -1, meaning="the cranks turn at one speed")] = 1
    """1: turns as the first crank; -1: against it. Example: -1"""
    phase: Angle = 0.0
    """Crank angle by which it leads the first engine, in its own sense of rotation; with
    four-stroke gas over 720 degrees. Example: 180"""
    at: Triple = (0.0, 0.0, 0.0)
    """x, y, z of its origin (its crank axis at its z = 0) in the axes of this file.
    Example: [-250, 0, 0]"""
    turn: Angle = 0.0
    """How far it is turned about z. Example: 90"""
    load: Switch = False
    """Whether its crank drives the load; left out in all engines: the first one's does. All true:
    each has a load of its own. Example: true"""


def check_engines(model: EngineFile) -> Iterator[Problem]:
    """Yield the contradictions between the engines of a file, all of which could be read."""
    engines = model.engine
    if len(engines) < 2:
        yield Problem("engine", f"one engine; analyze {engines[0].file} itself")
    if len(engines) > MOST_ENGINES:
        yield Problem("engine", f"{len(engines)} engines; at most {MOST_ENGINES} are read")
        return
    for key in ("ratio", "phase"):
        if getattr(engines[0], key) != type(engines[0]).model_fields[key].default:
            told = "the first engine is the reference; its ratio is 1 and its phase 0"
            yield Problem(f"engine.1.{key}", told)
    names = model.crank_names
    for k, name in enumerate(names):
        if name in names[:k]:
            told = f'"{name}" is engine {names.index(name) + 1} as well; give each its own name'
            yield Problem(f"engine.{k + 1}.name", told)
    for k, weight in enumerate(model.counterweight, 1):
        if weight.engine is not None and weight.engine not in names:
            told = f'"{weight.engine}" is no engine; there are {", ".join(names)}'
            yield Problem(f"counterweight.{k}.engine", told)
    loads = sum(engine.load for engine in engines)
    given = any(engine.has("load") for engine in engines)
    if given and loads not in (1, len(engines)):
        told = f"true for {loads} of {len(engines)} engines; mark one engine, or all"
        yield Problem("engine.load", told)
