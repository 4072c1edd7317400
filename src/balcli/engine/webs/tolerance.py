"""Compute how far the unbalance of a web may deviate within the tolerances of its dimensions."""

from __future__ import annotations

import cmath
import math
from itertools import product
from typing import NamedTuple

from ...core.outline import find_direction, find_moments
from ...file.web_tables import Web
from .bodies import MM, WebShape


class Deviation(NamedTuple):
    """Deviation of an unbalance, kg m: the largest one, and the root of the sum of squares of the
    linear changes by each dimension.
    """

    worst: float
    rss: float


class _Model(NamedTuple):
    """The unbalance of a web as a function of its dimensions, by closed forms.

    Attributes:
        plate: First moment of the outline without counterweight and with all holes open, m3.
        slugs: Mass per thickness of the slugs times their places, kg.
        hub: Inner radius of the counterweight, m.
        direction: Direction of its middle.
    """

    plate: complex
    slugs: complex
    hub: float
    direction: complex

    def find_unbalance(
        self, thickness: float, radius: float, opening: float, density: float
    ) -> complex:
        """Return the unbalance, kg m.

        Args:
            thickness: Thickness, m.
            radius: Outer radius of the counterweight, m.
            opening: Opening of the counterweight, rad.
            density: Density, kg/m3.
        """
        sector = 2 / 3 * (radius**3 - self.hub**3) * math.sin(opening / 2) * self.direction
        return thickness * (density * (self.plate + sector) + self.slugs)


def find_deviation(table: Web, shape: WebShape | None) -> Deviation | None:
    """Return the deviation of a web's unbalance; None without tolerances, or for a web given by its
    mass.

    Args:
        table: Table of the web.
        shape: Its outline.
    """
    tolerance = table.tolerance
    if tolerance is None or shape is None:
        return None
    model = _build_model(shape)
    sector = shape.sector
    density = 1e3 * table.density
    dimensions = [MM * table.thickness, model.hub, 0.0, density]
    if sector is not None:
        dimensions[1] = sector.radius
        dimensions[2] = math.radians(sector.opening)
    deviations = [
        MM * tolerance.thickness,
        MM * tolerance.outer_radius if sector is not None else 0.0,
        math.radians(tolerance.opening) if sector is not None else 0.0,
        density * tolerance.density,
    ]
    nominal = model.find_unbalance(*dimensions)
    sides = [(-1.0, 1.0) if deviation else (0.0,) for deviation in deviations]
    worst = 0.0
    for corner in product(*sides):
        moved = [d + side * t for d, side, t in zip(dimensions, corner, deviations, strict=True)]
        worst = max(worst, abs(model.find_unbalance(*moved) - nominal))
    slopes = _find_slopes(model, *dimensions)
    changes = [abs(slope) * t for slope, t in zip(slopes, deviations, strict=True)]
    return Deviation(worst, math.hypot(*changes))


def _build_model(shape: WebShape) -> _Model:
    outline = shape.outline if shape.cheek is None else shape.cheek.draw()
    plate = find_moments(outline, shape.holes).first
    slugs = 0j
    for hole, density in zip(shape.holes, shape.hole_densities, strict=True):
        slugs += density * hole.moments.first
    hub = 0.0 if shape.cheek is None else shape.cheek.hub
    angle = 0.0 if shape.sector is None else shape.sector.angle
    return _Model(plate, slugs, hub, find_direction(angle))


def _find_slopes(
    model: _Model, thickness: float, radius: float, opening: float, density: float
) -> tuple[complex, ...]:
    """Return the derivatives of the unbalance by thickness, radius, opening and density."""
    weight = thickness * density * model.direction
    cube = radius**3 - model.hub**3
    return (
        model.find_unbalance(1.0, radius, opening, density),
        2 * weight * radius**2 * math.sin(opening / 2),
        weight / 3 * cube * math.cos(opening / 2),
        model.find_unbalance(thickness, radius, opening, 1.0) - thickness * model.slugs,
    )


def measure_own_deg(vector: complex) -> float | None:
    """Return a direction from the web's own pin, deg, in [0, 360); None for no vector."""
    if not vector:
        return None
    degrees = math.degrees(cmath.phase(vector)) % 360
    return 0.0 if degrees == 360 else degrees
