"""Compute how far the unbalance of a web may deviate within the tolerances of its dimensions."""

from __future__ import annotations

import cmath
import math
from itertools import product
from typing import NamedTuple

from ...file.web_tables import Web, WebTolerance
from .bodies import MM, WebShape
from .dimensions import Dimensions, WebModel


class Deviation(NamedTuple):
    """Deviation of an unbalance, kg m: the largest one, and the root of the sum of squares of the
    linear changes by each dimension.
    """

    worst: float
    rss: float


def find_deviation(table: Web, shape: WebShape | None) -> Deviation | None:
    """Return the deviation of a web's unbalance; None without tolerances, or for a web given by its
    mass.

    Args:
        table: Table of the web.
        shape: Its outline.
    """
    if table.tolerance is None or shape is None:
        return None
    model = WebModel.of(table, shape)
    deviations = _list_deviations(table.tolerance, model)
    nominal = complex(model.weigh(model.nominal).unbalance)
    sides = [(-1.0, 1.0) if deviation else (0.0,) for deviation in deviations]
    worst = 0.0
    for corner in product(*sides):
        moved = []
        for dimension, side, deviation in zip(model.nominal, corner, deviations, strict=True):
            moved.append(dimension + side * deviation)
        unbalance = complex(model.weigh(Dimensions(*moved)).unbalance)
        worst = max(worst, abs(unbalance - nominal))
    slopes = _find_slopes(model)
    changes = [abs(slope) * t for slope, t in zip(slopes, deviations, strict=True)]
    return Deviation(worst, math.hypot(*changes))


def _list_deviations(tolerance: WebTolerance, model: WebModel) -> tuple[float, ...]:
    """Return the largest deviation of each of the `Dimensions`, SI units."""
    sizes = {
        "thickness": MM * tolerance.thickness,
        "outer_radius": MM * tolerance.outer_radius,
        "opening": math.radians(tolerance.opening),
        "density": float(model.nominal.density) * tolerance.density,
    }
    return tuple(size if key in model.deviating else 0.0 for key, size in sizes.items())


def _find_slopes(model: WebModel) -> tuple[complex, ...]:
    """Return the derivatives of the unbalance by thickness, radius, opening and density."""
    thickness, radius, opening, density = map(float, model.nominal)
    weight = thickness * density * model.direction
    cube = radius**3 - model.hub**3
    of_unit_thickness = model.weigh(model.nominal._replace(thickness=1.0)).unbalance
    of_unit_density = model.weigh(model.nominal._replace(density=1.0)).unbalance
    return (
        complex(of_unit_thickness),
        2 * weight * radius**2 * math.sin(opening / 2),
        weight / 3 * cube * math.cos(opening / 2),
        complex(of_unit_density) - thickness * model.slugs.first,
    )


def measure_own_deg(vector: complex) -> float | None:
    """Return a direction from the web's own pin, deg, in [0, 360); None for no vector."""
    if not vector:
        return None
    degrees = math.degrees(cmath.phase(vector)) % 360
    return 0.0 if degrees == 360 else degrees
