"""The tables of engines that are geared together one to one."""

from __future__ import annotations

from typing import Annotated, ClassVar

from .fields import FileName, Label, OneOf, shorten
from .table import Angle, FileTable, Switch, Triple


class EngineLabel(Label):
    """The name of an engine. The names of its cylinders begin with it: `upper.3`."""

    wanted = "leave out dots, commas and spaces, which separate names of cylinders"

    def read(self, value: object) -> str:
        name = super().read(value)
        if any(sign in ",." or sign.isspace() for sign in name):
            raise ValueError(f"{shorten(value)} is not a {self.kind} of an engine; {self.wanted}")
        return name


class Engine(FileTable):
    """One of several engines that are geared together one to one."""

    by_number: ClassVar[bool] = True

    name: Annotated[str, EngineLabel()] = ""
    """Name of the engine; left out: A, B and so on. Example: 'upper'"""
    file: Annotated[str, FileName()]
    """An engine file in the folder of this file or below it. Several engines may share a file.
    Example: 'flat4.toml'"""
    ratio: Annotated[int, OneOf(1, -1, meaning="the cranks turn at one speed")] = 1
    """1: the crank turns with the crank of the first engine; -1: against it. Example: -1"""
    phase: Angle = 0.0
    """Crank angle by which this engine leads the first one, in its own direction of rotation; in
    four-stroke engines with gas, 360 degrees more is another phase. Example: 180"""
    at: Triple = (0.0, 0.0, 0.0)
    """x, y, z of the engine's origin (the point z = 0 of its crank axis) in the axes of this file.
    Example: [-250, 0, 0]"""
    turn: Angle = 0.0
    """Angle by which the engine is turned about z. Example: 90"""
    load: Switch = False
    """Whether the crank of this engine drives the load. Left out in all engines: the first crank
    drives it; true in all engines: each crank drives its own load. Example: true"""
