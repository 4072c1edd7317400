"""The tables [[web]] of an engine file: the webs of a crankshaft.

This module is imported only for files that have them (`names.CHAPTER_LISTS`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from typing import Annotated, NamedTuple

from pydantic import PrivateAttr

from .fields import FileName, Number, as_written, join_words
from .table import (
    FIT,
    Angle,
    Density,
    Distance,
    FileTable,
    Inertia,
    Length,
    Mass,
    Numbers,
    Place,
    Size,
)
from .units import ANGLE, DENSITY, LENGTH, PLAIN

SizeOrFit = Annotated[float, Number(LENGTH, above=0, most=1e9, word=FIT)]
OpeningOrFit = Annotated[float, Number(ANGLE, above=0, most=360, word=FIT)]
Deviation = Annotated[float, Number(LENGTH, least=0, most=1e9)]

_OPPOSITE_DEG = 180.0  # from the crank pin
VARIABLE = ("thickness", "outer_radius", "opening", "density")  # dimensions that may vary
FITTED_KEYS = ("opening", "outer_radius", "thickness")
_FORMS = "hub and boss, or profile, or mass and cg"
_SHAPE = ("hub", "boss", "outer_radius", "opening", "angle")
_WEIGHED = ("mass", "cg", "inertia")


class Fault(NamedTuple):
    """A contradiction in a table: the key (empty: the table) and the message."""

    key: str
    message: str


class _ShareOrPercent(Number):
    """A share, as a plain number or as text in percent."""

    def read(self, value: object) -> float:
        if isinstance(value, str) and value.strip().endswith("%"):
            with suppress(ValueError):
                return super().read(float(value.strip().removesuffix("%")) / 100)
        return super().read(value)


class Hole(FileTable):
    """A hole through a web, or a slug of another metal in it."""

    x: Length
    """Place along x, from the crank axis towards the crank pin. Example: 44"""
    y: Length = 0.0
    """Place along y, 90 degrees ahead in the direction of rotation. Example: 0"""
    diameter: Size
    """Diameter. Example: 22"""
    density: Annotated[float, Number(DENSITY, least=0, most=30)] = 0.0
    """Density of a slug that fills the hole. Example: 17"""


class WebTolerance(FileTable):
    """Largest deviations of a web's dimensions, in both directions."""

    thickness: Deviation = 0.0
    """Deviation of the thickness. Example: 0.1"""
    outer_radius: Deviation = 0.0
    """Deviation of the outer radius. Example: 0.25"""
    opening: Annotated[float, Number(ANGLE, least=0, most=360)] = 0.0
    """Deviation of the opening. Example: 0.5"""
    density: Annotated[float, _ShareOrPercent(PLAIN, least=0, below=1)] = 0.0
    """Deviation of the density, as a share. Example: '0.3 %'"""


class Web(FileTable):
    """Webs of the crankshaft that are alike: their dimensions, a drawing of their outline, or their
    mass and centre of mass. Webs count from the free end: webs 1 and 2 belong to throw 1.
    """

    webs: Numbers | None = None
    """Numbers of these webs; left out: all webs that no other table lists. Example: [1, 4, 5, 8]"""
    thickness: SizeOrFit
    """Axial thickness; "fit": balance finds it, with given outer_radius and opening.
    Example: 20.5"""
    hub: Size | None = None
    """Diameter of the web around the main journal; the convex hull of both diameters is the cheek.
    Example: 65"""
    boss: Size | None = None
    """Diameter of the web around the crank pin. Example: 53"""
    outer_radius: SizeOrFit | None = None
    """Outer radius of the counterweight, a sector from the hub outwards; left out with opening: no
    counterweight; "fit": balance finds it. Example: 78"""
    opening: OpeningOrFit | None = None
    """Full angle of the counterweight; "fit": balance finds it. Example: 115"""
    angle: Angle = _OPPOSITE_DEG
    """Angle of the middle of the counterweight from the web's own crank pin; with an opening or
    outer radius that is "fit", a left out angle is found as well. Example: 180"""
    profile: Annotated[str, FileName()] | None = None
    """A DXF file with the outline, instead of hub, boss and counterweight. Example: 'web.dxf'"""
    mass: Mass | None = None
    """Mass of the web from CAD or scales, with cg, instead of any shape. Example: 1.94"""
    cg: Place | None = None
    """x, y of the centre of mass, from the crank axis; x points to the web's own crank pin.
    Example: [-9.2, 0.4]"""
    inertia: Inertia | None = None
    """Polar moment of inertia about the crank axis, with mass. Example: 4900"""
    density: Density = 7.85
    """Density; that of the front web of a throw is also the density of its crank pin. Example:
    7.85"""
    holes: tuple[Hole, ...] = ()
    """Holes through the web. Example: [{ x = 44, diameter = 22 }]"""
    clearance: Distance = 0.0
    """Gap to pistons and crankcase; a smaller one gets a warning, and an outer radius that is "fit"
    keeps it. Example: 1"""
    tolerance: WebTolerance | None = None
    """Largest deviations of the dimensions."""

    _counterweight_removed: bool = PrivateAttr(default=False)

    @property
    def to_fit(self) -> str:
        """Key whose value is "fit"; empty if there is none."""
        return next((key for key in FITTED_KEYS if self.is_open(key)), "")

    @property
    def is_weighed(self) -> bool:
        """Whether mass and centre of mass are given instead of a shape."""
        return self.mass is not None

    @property
    def counterweight_removed(self) -> bool:
        """Whether the file gives a counterweight, which this table is without."""
        return self._counterweight_removed

    @property
    def has_cheek(self) -> bool:
        """Whether the dimensions are given: hub and boss."""
        return self.hub is not None and self.boss is not None

    def is_open(self, key: str) -> bool:
        """Return whether the value of a key is "fit"."""
        value = getattr(self, key)
        return value is not None and math.isnan(value)

    def take_open_away(self) -> Web:
        """Return the table without what is to be fitted: a web with a dimension "fit" has no
        counterweight, and no thickness (0) if this is the dimension. A table with contradictions
        stays as it is.
        """
        if not self.to_fit or any(self.find_faults()):
            return self
        bare = self.remove_counterweight()
        return bare.model_copy(update={"thickness": 0.0}) if self.is_open("thickness") else bare

    def remove_counterweight(self) -> Web:
        """Return the table without its counterweight. Holes in the counterweight stay listed, and
        are no part of the web.
        """
        nothing = {"outer_radius": None, "opening": None, "angle": _OPPOSITE_DEG}
        bare = self.model_copy(update=nothing)
        bare.model_fields_set.difference_update(nothing)
        bare._counterweight_removed = self.outer_radius is not None or self.counterweight_removed
        return bare

    def find_faults(self) -> Iterator[Fault]:
        """Yield the contradictions between the keys of this table."""
        yield from self._find_faults_of_form()
        yield from self._find_faults_of_counterweight()
        if self.hub is None or self.outer_radius is None or self.is_open("outer_radius"):
            return
        if self.outer_radius <= self.hub / 2:
            told = f"{as_written(self.outer_radius, 'mm')}; give more than the hub's radius, "
            yield Fault("outer_radius", f"{told}{self.hub / 2:g} mm")

    def _find_faults_of_form(self) -> Iterator[Fault]:
        """Yield a fault unless the web has one of the three forms, and all keys of it."""
        begun = []
        for keys in (_SHAPE, ("profile",), _WEIGHED):
            given = [key for key in keys if self.has(key)]
            if given:
                begun.append(given[0])
        if len(begun) > 1:
            told = f"given with {begun[1]}; give one of hub and boss, profile, or mass and cg"
            yield Fault(begun[0], told)
            return
        needed: tuple[str, ...] = ("hub", "boss")
        if begun and begun[0] in _WEIGHED:
            needed = ("mass", "cg")
        elif self.has("profile"):
            needed = ()
        for key in needed:
            if getattr(self, key) is None:
                yield Fault(key, f"is missing; give {_FORMS}")
        if self.is_weighed and self.holes:
            yield Fault("holes", "given with mass, which includes the holes; leave one of them out")

    def _find_faults_of_counterweight(self) -> Iterator[Fault]:
        """Yield a fault unless the counterweight is complete, with "fit" at most once."""
        given = [key for key in ("outer_radius", "opening") if self.has(key)]
        if len(given) == 1:
            other = "opening" if given[0] == "outer_radius" else "outer_radius"
            message = f"is given without {other}; give both, or none for no counterweight"
            yield Fault(given[0], message)
        open_keys = [key for key in FITTED_KEYS if self.is_open(key)]
        if len(open_keys) > 1:
            message = f'{join_words(open_keys)} are "fit"; give figures for all but one'
            yield Fault("", message)
        elif open_keys and (not self.has_cheek or not given):
            message = 'is "fit"; this needs hub, boss, outer_radius and opening'
            yield Fault(open_keys[0], message)
