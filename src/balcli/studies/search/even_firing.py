"""Which designs of an engine fire evenly, and at which angles they do."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array
from ...engine.build import Engine
from ...engine.firing import TOLERANCE_DEG
from ...engine.layout import cycle_deg
from ...enginefile.model import EngineFile
from .angles import STEP, Span, neaten
from .designs import build_candidates, find_buildable


def fires_evenly(engine: Engine, model: EngineFile) -> NDArray[np.bool_]:
    """Whether the cylinders reach top dead centre in turn at even distances (within TOLERANCE_DEG),
    shape (candidates,).
    """
    ready = np.sort(np.mod(_find_top_dead_centres(engine, model) + TOLERANCE_DEG, TURN), axis=0)
    even = np.sort(np.mod(_list_slots(len(ready), model), TURN))
    even = even.reshape(-1, *(1,) * (ready.ndim - 1))
    fits: NDArray[np.bool_] = (np.abs(ready - TOLERANCE_DEG - even) <= TOLERANCE_DEG).all(axis=0)
    return fits


def find_even_angles(model: EngineFile, key: str, span: Span) -> Array | None:
    """The angles in a span at which the cylinders fire evenly, deg; None if they do at any angle.
    `key`: bank_angle, splay, or the dotted name of an angle of the file.

    Where the crank stands at a cylinder's top dead centre depends on the angle in proportion: that
    of one cylinder that moves against cylinder 1 has to be at one of the slots of the cycle.
    """
    some = find_two_buildable(model, key, span)
    two = build_candidates(model, {key: some})
    ready = _find_top_dead_centres(two, model)
    speeds = np.round((ready[:, 1] - ready[:, 0]) / (some[1] - some[0]), 9)
    moving = np.flatnonzero(speeds)
    if not len(moving):
        return None if fires_evenly(two, model).all() else np.empty(0)
    row = moving[0]
    turns = TURN * np.arange(-len(ready), len(ready) + 1)
    ahead = (_list_slots(len(ready), model) + turns[:, None] - ready[row, 0]) / speeds[row]
    places = some[0] + ahead
    places = neaten(places[(span.low <= places) & (places <= span.high)])
    angles = np.unique(span.bring_inside(places))
    angles = angles[find_buildable(model, key, angles)]
    if not len(angles):
        return angles
    return angles[fires_evenly(build_candidates(model, {key: angles}), model)]


def find_two_buildable(model: EngineFile, key: str, span: Span) -> Array:
    """Two angles of a span at which nothing locks, deg: 0 and 1, if that can be."""
    first = np.array([0.0, 1.0])
    if find_buildable(model, key, first).all():
        return first
    grid = span.divide(STEP)
    there = grid[find_buildable(model, key, grid)]
    return there[[0, -1]]


def _list_slots(count: int, model: EngineFile) -> Array:
    """Where the crank stands at each of so many even firings, deg after the first."""
    return cycle_deg(model.layout) * np.arange(count) / count


def _find_top_dead_centres(engine: Engine, model: EngineFile) -> Array:
    """Where the crank stands at each cylinder's top dead centre, deg after cylinder 1's, shape
    (cylinders, *candidates).
    """
    c = engine.cylinders
    # of plain slider-cranks, as `Assembly.tops_deg`; articulated pins are set for their lead
    late = 0.0 if model.articulation else np.degrees(np.arcsin(c.eps / (1 + c.lam)))
    ready = c.axis_of_each_deg + late - c.pin_deg
    return np.asarray(ready - ready[engine.numbers.index(1)])
