"""Usual ranges of the figures of [[web]], by which figures in another unit are found.

This module is imported only for files that have such tables.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from .model import EngineFile
from .ranges import INERTIAS, LENGTHS, Range, Sizes, measure
from .units import ANGLE, DENSITY, INERTIA, LENGTH, MASS, PLAIN
from .web_tables import Web


class _Share(NamedTuple):
    """Usual range of a length, as shares of the stroke."""

    least: float
    most: float


# Cranks of cars have a thickness of 0.2 to 0.35 strokes, a hub of 0.7, and an outer radius of 0.9.
_OF_STROKE = {
    "thickness": _Share(0.05, 1.5),
    "hub": _Share(0.2, 4.0),
    "boss": _Share(0.15, 3.0),
    "outer_radius": _Share(0.3, 3.0),
}
_CG = 0.005  # least distance of a centre of mass from the axis, strokes
_HOLE = _Share(0.01, 1.5)  # diameter of a hole, strokes
_PIN = _Share(0.1, 2.0)  # length of a crank pin, strokes
_CLEARANCE = 0.2  # largest clearance, strokes
_WEB_MASS = 0.03, 30.0  # mass of a web / mass of a rod and piston
_GYRATION = 0.1, 2.0  # radius of gyration about the crank axis, strokes
_DENSITY = 2.0, 20.0  # g/cm3: aluminium, heavy metal
_LOOSE = 0.1  # largest tolerance / dimension
_LOOSE_OPENING = 10.0  # largest tolerance of an opening, deg
_LOOSE_DENSITY = 0.1
_MASSES = ("g", "lb")
_DENSITIES = ("lb/in^3",)
_KEYS_OF_STROKE = ("crank.stroke",)


def list_web_ranges(model: EngineFile) -> Iterator[Range]:
    """Yield the usual ranges of the figures of webs and crank pins.

    Args:
        model: Engine file with [[web]].
    """
    size = measure(model)
    stroke = f"a stroke of {size.stroke:g} mm"
    for key, share in _OF_STROKE.items():
        figures = _list_given(model, key)
        yield _compare_with_stroke(figures, share, size, stroke)
    yield from _list_room_between_throws(model)
    pins = []
    if model.bearing is not None:
        pins.append(("bearing.pin_length", model.bearing.pin_length or 0.0))
    yield _compare_with_stroke(pins, _PIN, size, stroke)
    yield _compare_with_stroke(_list_given(model, "clearance"), _Share(0, _CLEARANCE), size, stroke)
    holes = []
    centres = []
    for path, web in _list_webs(model):
        for number, hole in enumerate(web.holes, 1):
            holes.append((f"{path}.holes.{number}.diameter", hole.diameter))
        if web.cg is not None:
            centres.append((f"{path}.cg", max(map(abs, web.cg))))
    yield _compare_with_stroke(holes, _HOLE, size, stroke)
    yield _compare_with_stroke(centres, _Share(_CG, math.inf), size, stroke)
    yield from _list_masses(model, size)
    yield from _list_tolerances(model)


def _list_webs(model: EngineFile) -> list[tuple[str, Web]]:
    """Return path and table of each kind of web."""
    return [(f"web.{number}", web) for number, web in enumerate(model.web, 1)]


def _list_given(model: EngineFile, key: str) -> list[tuple[str, float]]:
    """Return path and value of a key in all tables that give it as a number."""
    figures = []
    for path, web in _list_webs(model):
        value = getattr(web, key)
        if value is not None and not math.isnan(value):
            figures.append((f"{path}.{key}", value))
    return figures


def _compare_with_stroke(
    figures: list[tuple[str, float]], share: _Share, size: Sizes, stroke: str
) -> Range:
    return Range(
        figures=figures,
        least=share.least * size.stroke,
        most=share.most * size.stroke,
        dimension=LENGTH,
        others=LENGTHS,
        basis=stroke,
        also=_KEYS_OF_STROKE,
    )


def _list_room_between_throws(model: EngineFile) -> Iterator[Range]:
    """Yield the range of the thickness that leaves neighbouring webs apart."""
    apart = model.crank.spacing
    if model.crank.positions is not None:
        steps = [after - before for before, after in pairwise(sorted(model.crank.positions))]
        apart = min(steps, default=None)
    if model.bearing is None or not model.bearing.pin_length or not apart:
        return
    pin = model.bearing.pin_length
    basis = f"throws {apart:g} mm apart and pins {pin:g} mm long"
    hint = "thicker webs of neighbouring throws overlap"
    width = 0.0
    if model.bearing.main_width and model.bearing.main_positions is None:
        width = model.bearing.main_width
        basis = (
            f"throws {apart:g} mm apart, pins {pin:g} mm long and main bearings {width:g} mm wide"
        )
        hint = "thicker webs of neighbouring throws overlap the main bearing between them"
    if apart <= pin + width:
        return
    yield Range(
        figures=_list_given(model, "thickness"),
        least=0.0,
        most=(apart - pin - width) / 2,
        dimension=LENGTH,
        others=(),
        basis=basis,
        hint=hint,
        also=("crank.spacing", "crank.positions", "bearing.pin_length", "bearing.main_width"),
    )


def _list_masses(model: EngineFile, size: Sizes) -> Iterator[Range]:
    """Yield the ranges of masses, inertias and densities."""
    yield Range(
        figures=_list_given(model, "density"),
        least=_DENSITY[0],
        most=_DENSITY[1],
        dimension=DENSITY,
        others=_DENSITIES,
        basis="a metal",
    )
    if size.mass:
        yield Range(
            figures=_list_given(model, "mass"),
            least=_WEB_MASS[0] * size.mass,
            most=_WEB_MASS[1] * size.mass,
            dimension=MASS,
            others=_MASSES,
            basis=f"rods and pistons of {size.mass:.4g} kg",
        )
    for path, web in _list_webs(model):
        if web.mass and web.inertia:
            least, most = (web.mass * (share * size.stroke) ** 2 for share in _GYRATION)
            yield Range(
                figures=[(f"{path}.inertia", web.inertia)],
                least=least,
                most=most,
                dimension=INERTIA,
                others=INERTIAS,
                basis=f"a web of {web.mass:.4g} kg",
                also=(f"{path}.mass",),
            )


def _list_tolerances(model: EngineFile) -> Iterator[Range]:
    """Yield the ranges of tolerances."""
    for path, web in _list_webs(model):
        tolerance = web.tolerance
        if tolerance is None:
            continue
        for key in ("thickness", "outer_radius"):
            value = getattr(web, key) or math.nan
            if math.isnan(value):
                continue
            yield Range(
                figures=[(f"{path}.tolerance.{key}", getattr(tolerance, key))],
                least=0.0,
                most=_LOOSE * value,
                dimension=LENGTH,
                others=(),
                basis=f"{key} = {value:g} mm",
                hint="the tolerance is the largest deviation, not the dimension",
                also=(f"{path}.{key}",),
            )
        yield Range(
            figures=[(f"{path}.tolerance.opening", tolerance.opening)],
            least=0.0,
            most=_LOOSE_OPENING,
            dimension=ANGLE,
            others=(),
            basis="a casting or forging",
        )
        yield Range(
            figures=[(f"{path}.tolerance.density", tolerance.density)],
            least=0.0,
            most=_LOOSE_DENSITY,
            dimension=PLAIN,
            others=(),
            basis="a metal",
            hint=f'a bare number is a share; in percent, write it: "{tolerance.density:g} %"',
        )
