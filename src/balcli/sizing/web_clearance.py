"""Compute the smallest gap between a web and the lower edge of the pistons over a revolution.

The lower edge of a piston is at one height all round: `skirt` below its pin. A piston is over a web
if the web's nearer face is at a distance d < bore/2 from the axis of the cylinder; in the plane of
this face, the edge then is a line of the half width `sqrt(bore^2/4 - d^2)` about the path of the
piston pin.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.outline import Vertex, find_arc, list_edges
from ..core.phasors import Array, Complex

if TYPE_CHECKING:
    from ..engine.engine import CylinderNumber, Engine
    from ..engine.webs.build import CrankWeb

_STEPS = 720  # crank angles of a revolution
_ZOOMS = 3  # each takes the steps around the smallest gaps apart
_SPLITS = 64
_MINIMA = 4  # smallest gaps that are refined


class Gap(NamedTuple):
    """A gap, m, with the crank angle, deg, and the number of the cylinder; negative: overlap."""

    size: float
    crank_deg: float
    cylinder: CylinderNumber


class Edge(NamedTuple):
    """Lower edge of a piston: a line across the axis of its cylinder.

    Attributes:
        offset: Place of the middle of the edge across the axis, m.
        half_width: Half of its length, m.
    """

    offset: float
    half_width: float


class PistonView(NamedTuple):
    """A piston over a web at one crank angle.

    Attributes:
        turn: Factor that turns places in the axes of the web to places along (real part) and across
            (imaginary part) the cylinder.
        pin_height: Height of the piston pin over the crank axis, along the cylinder, m.
        edge_height: Height of the lower edge, m.
        edge: The lower edge in the plane of the web's nearer face.
    """

    turn: complex
    pin_height: float
    edge_height: float
    edge: Edge


class _Arc(NamedTuple):
    """An arc of an outline: centre and radius, direction of its middle, and half of its angle."""

    centre: complex
    radius: float
    middle: complex
    half_angle: float


class _Outline(NamedTuple):
    """An outline in numbers that are quick to turn: its vertices, straight edges and arcs."""

    vertices: Complex
    lines: tuple[tuple[complex, complex], ...]
    arcs: tuple[_Arc, ...]


def find_gap(engine: Engine, web: CrankWeb) -> Gap | None:
    """Return the smallest gap between a web and any piston over it; None if the web has no outline,
    if the file gives no skirt or bore, or if no piston is over it.

    Args:
        engine: One engine, not an array of variants.
        web: Web of this engine.
    """
    shape = web.body.shape
    skirt = None if engine.model is None else engine.model.piston.skirt
    if shape is None or skirt is None or math.isnan(float(engine.bore_m)):
        return None
    outline = _prepare(shape.outline)
    gaps = []
    for row, number in enumerate(engine.numbers):
        edge = _find_edge(engine, web, row)
        if edge is not None and not engine.cylinders.harmonic:
            size, degrees = _find_smallest(engine, web, outline, row, skirt / 1e3, edge)
            gaps.append(Gap(size, degrees, number))
    return min(gaps, key=lambda gap: round(gap.size, 9), default=None)


def view_piston(engine: Engine, web: CrankWeb, gap: Gap) -> PistonView:
    """Return the piston of a gap at its crank angle.

    Args:
        engine: One engine, not an array of variants.
        web: Web of this engine.
        gap: Gap between this web and the piston.
    """
    row = engine.numbers.index(gap.cylinder)
    edge = _find_edge(engine, web, row)
    assert edge is not None
    assert engine.model is not None
    assert engine.model.piston.skirt is not None
    crank_deg: Array = np.array([gap.crank_deg])
    height = float(_find_pin_height(engine, row, crank_deg)[0])
    turn = complex(_find_turns(engine, web, row, crank_deg)[0])
    return PistonView(turn, height, height - engine.model.piston.skirt / 1e3, edge)


def _find_edge(engine: Engine, web: CrankWeb, row: int) -> Edge | None:
    """Return the lower edge of a piston in the plane of the web's nearer face; None if the piston
    is not over the web.
    """
    apart = abs(float(engine.cylinders.z[row]) - float(web.z)) - web.body.thickness / 2
    square = float(engine.bore_m) ** 2 / 4 - max(apart, 0.0) ** 2
    if square <= 0:
        return None
    return Edge(_take_row(engine.cylinders.offset, row), square**0.5)


def _find_turns(engine: Engine, web: CrankWeb, row: int, crank_deg: Array) -> Complex:
    """Return the factors that turn places in the axes of a web to places along and across a
    cylinder, shape (angles,).
    """
    axis_deg = float(engine.cylinders.axis_of_each_deg[row])
    return np.exp(1j * np.radians(crank_deg + float(web.pin_deg) - axis_deg))


def _prepare(outline: Sequence[Vertex]) -> _Outline:
    lines = []
    arcs = []
    for start, end in list_edges(outline):
        arc = find_arc(start, end)
        if arc is None:
            lines.append((start.place, end.place))
        else:
            first = (start.place - arc.centre) / arc.radius
            middle = first * cmath.exp(0.5j * arc.angle)
            arcs.append(_Arc(arc.centre, arc.radius, middle, abs(arc.angle) / 2))
    vertices = np.array([vertex.place for vertex in outline])
    return _Outline(vertices, tuple(lines), tuple(arcs))


def _find_smallest(
    engine: Engine, web: CrankWeb, outline: _Outline, row: int, skirt: float, edge: Edge
) -> tuple[float, float]:
    """Return the smallest gap to one piston, m, and its crank angle, deg."""

    def measure(crank_deg: Array) -> Array:
        height = _find_pin_height(engine, row, crank_deg) - skirt
        turn = _find_turns(engine, web, row, crank_deg)
        return _measure_gaps(outline, turn, height, edge)

    step = 360 / _STEPS
    angles: Array = step * np.arange(_STEPS, dtype=float)
    gaps = measure(angles)
    places = angles[np.argsort(gaps, kind="stable")[:_MINIMA]]
    best = (float(gaps.min()), float(angles[int(gaps.argmin())]))
    for _ in range(_ZOOMS):
        angles = np.ravel(places[:, None] + step * np.linspace(-1, 1, _SPLITS + 1))
        gaps = measure(angles)
        least = int(gaps.argmin())
        if gaps[least] < best[0] - 1e-12:
            best = (float(gaps[least]), float(angles[least]) % 360)
        places = angles[np.argsort(gaps, kind="stable")[:_MINIMA]]
        step = step * 2 / _SPLITS
    return best


def _take_row(values: Array, row: int) -> float:
    """Return the figure of a cylinder; a single row is that of all cylinders."""
    return float(np.ravel(values)[row if len(values) > 1 else 0])


def _find_pin_height(engine: Engine, row: int, crank_deg: Array) -> Array:
    """Return the distance of a piston pin from the crank axis along its cylinder, m."""
    c = engine.cylinders
    first = float(engine.first_axis_deg)
    lead = first + float(np.ravel(c.pin_deg)[row]) - float(c.axis_of_each_deg[row])
    psi = np.radians(crank_deg + lead)
    radius = float(c.radius_of_each[row])
    lam = _take_row(c.lam, row)
    eps = _take_row(c.eps, row)
    if c.linkage is not None:
        turned = np.radians(crank_deg)[None, :] + np.radians(np.ravel(c.pin_deg) + first)[:, None]
        own = turned - np.radians(np.ravel(c.axis_of_each_deg))[:, None]
        place = c.linkage.motion(own, c.lam, c.eps).place
        return np.asarray(radius * place[row])
    lean = lam * np.sin(psi) - eps
    return np.asarray(radius * (np.cos(psi) + np.sqrt(1 - lean**2) / lam))


def _measure_gaps(outline: _Outline, turn: Complex, height: Array, edge: Edge) -> Array:
    """Return the gap between outline and edge for each turn of the outline, m, shape (angles,). The
    real part of a place is along the cylinder, the imaginary part across.
    """
    gaps = np.full(turn.shape, np.inf)
    for place in _list_high_points(outline, turn):
        over = np.abs(place.imag - edge.offset) <= edge.half_width
        gaps = np.minimum(gaps, np.where(over, height - place.real, np.inf))
    for side in (-1, 1):
        across = edge.offset + side * edge.half_width
        own = (height + 1j * across) / turn  # end of the edge in the axes of the web
        gaps = np.minimum(gaps, _measure_distances(outline, own))
        for top in _list_heights(outline, turn, across):
            gaps = np.minimum(gaps, height - top)
    return gaps


def _list_heights(outline: _Outline, turn: Complex, across: float) -> Iterator[Array]:
    """Yield the height of each straight edge and arc at a distance across the axis of the cylinder;
    -inf where it has no point there.
    """
    for start, end in outline.lines:
        low = start * turn
        along = end * turn - low
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (across - low.imag) / along.imag
        reached = (share >= 0) & (share <= 1)
        yield np.where(reached, low.real + share * along.real, -np.inf)
    for arc in outline.arcs:
        centre = arc.centre * turn
        aside = across - centre.imag
        rise = np.sqrt(np.maximum(arc.radius**2 - aside**2, 0.0))
        apart = np.abs(np.angle((rise + 1j * aside) / (turn * arc.middle)))
        reached = (np.abs(aside) <= arc.radius) & (apart <= arc.half_angle)
        yield np.where(reached, centre.real + rise, -np.inf)


def _list_high_points(outline: _Outline, turn: Complex) -> Iterator[Complex]:
    """Yield the places of the vertices, and of the highest point of each arc that has one."""
    for vertex in outline.vertices:
        yield vertex * turn
    for arc in outline.arcs:
        apart = np.abs(np.angle(turn * arc.middle))  # of the arc's middle from the cylinder's axis
        top = turn * arc.centre + arc.radius
        yield np.where(apart <= arc.half_angle, top, turn * arc.centre - arc.radius * 1e3)


def _measure_distances(outline: _Outline, points: Complex) -> Array:
    """Return the distance of points from an outline, m."""
    distances = np.abs(points[:, None] - outline.vertices).min(axis=1)
    for start, end in outline.lines:
        along = end - start
        share = np.clip(((points - start) / along).real, 0, 1)
        distances = np.minimum(distances, np.abs(points - start - share * along))
    for arc in outline.arcs:
        apart = points - arc.centre
        within = np.abs(np.angle(apart / arc.middle)) <= arc.half_angle
        gap = np.where(within, np.abs(np.abs(apart) - arc.radius), np.inf)
        distances = np.minimum(distances, gap)
    return distances
