"""Compute mass, unbalance and inertia of a web as functions of its dimensions, by closed forms.

A plate of the thickness t and the density rho has the counterweight as a sector from the hub's
radius h to the outer radius R with the opening q. The sector has the area `q (R^2 - h^2)/2`, the
first moment `2/3 (R^3 - h^3) sin(q/2)` in the direction of its middle, and the polar moment
`q (R^4 - h^4)/4`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, cast

import numpy as np

from ...core.outline import Cheek, Moments, Sector, find_direction, find_moments
from ...core.phasors import Complex, Figure
from ...errors import InputError, Problem
from ...file.web_tables import VARIABLE, Web
from .bodies import MM, ROUNDING_DEG, WebBody, WebShape, refuse_stray_holes

_SECTOR = ("outer_radius", "opening")


class Dimensions(NamedTuple):
    """Dimensions of a web that may deviate, SI units; numbers or arrays.

    Attributes:
        thickness: Thickness, m.
        outer_radius: Outer radius of the counterweight, m; that of the hub without counterweight.
        opening: Opening of the counterweight, rad.
        density: Density, kg/m3.
    """

    thickness: Figure
    outer_radius: Figure
    opening: Figure
    density: Figure


class Weight(NamedTuple):
    """Mass (kg), unbalance (kg m) and polar inertia (kg m2) of a web; numbers or arrays."""

    mass: Figure
    unbalance: complex | Complex
    inertia: Figure


class WebModel(NamedTuple):
    """A web as a function of its dimensions.

    Attributes:
        plate: Moments of the outline without counterweight and with all holes open.
        slugs: Moments of the slugs, each times its density.
        hub: Inner radius of the counterweight, m.
        direction: Direction of its middle.
        nominal: Dimensions as the file gives them.
        deviating: Names of the dimensions that the web has.
    """

    plate: Moments
    slugs: Moments
    hub: float
    direction: complex
    nominal: Dimensions
    deviating: tuple[str, ...]

    @classmethod
    def of(cls, table: Web, shape: WebShape) -> WebModel:
        """Return the model of a web.

        Args:
            table: Table of the web.
            shape: Its outline.
        """
        outline = shape.outline if shape.cheek is None else shape.cheek.draw()
        slugs = Moments(0.0, 0j, 0.0)
        for hole, density in zip(shape.holes, shape.hole_densities, strict=True):
            slugs = slugs.add(hole.moments, density)
        hub = 0.0 if shape.cheek is None else shape.cheek.hub
        sector = shape.sector
        nominal = Dimensions(MM * table.thickness, hub, 0.0, 1e3 * table.density)
        deviating = [key for key in VARIABLE if sector is not None or key not in _SECTOR]
        angle = 0.0
        if sector is not None:
            angle = sector.angle
            opening = float(np.radians(sector.opening))
            nominal = nominal._replace(outer_radius=sector.radius, opening=opening)
        return cls(
            plate=find_moments(outline, shape.holes),
            slugs=slugs,
            hub=hub,
            direction=find_direction(angle),
            nominal=nominal,
            deviating=tuple(deviating),
        )

    def weigh(self, dimensions: Dimensions) -> Weight:
        """Return mass, unbalance and inertia of the web with other dimensions."""
        thickness, radius, opening, density = dimensions
        area = opening * (radius**2 - self.hub**2) / 2
        first = 2 / 3 * (radius**3 - self.hub**3) * np.sin(opening / 2) * self.direction
        polar = opening * (radius**4 - self.hub**4) / 4
        unbalance = thickness * (density * (self.plate.first + first) + self.slugs.first)
        return Weight(
            thickness * (density * (self.plate.area + area) + self.slugs.area),
            cast("Complex", unbalance),
            thickness * (density * (self.plate.polar + polar) + self.slugs.polar),
        )


def refuse_impossible(body: WebBody, table: Web, path: str, varied: Mapping[str, Figure]) -> None:
    """Raise InputError for varied dimensions that make no web.

    Args:
        body: Web as the file gives it.
        table: Its table.
        path: Dotted name of the table.
        varied: Dimensions that vary, by their keys, in the units of the file.
    """
    shape = body.shape
    if not varied or shape is None or shape.cheek is None:
        return
    most = shape.cheek.find_largest_opening(table.angle)
    widest = float(np.max(varied.get("opening", 0.0)))
    if widest > most + ROUNDING_DEG:
        message = f"{widest:g} deg; at most {most:.5g} deg with this hub and boss"
        raise InputError([Problem(f"{path}.opening", message)])
    smallest = float(np.min(varied.get("outer_radius", np.inf)))
    if smallest <= shape.cheek.hub / MM:
        message = f"{smallest:g} mm; give more than the hub's radius, {shape.cheek.hub / MM:g} mm"
        raise InputError([Problem(f"{path}.outer_radius", message)])
    if shape.sector is not None:
        _refuse_stray_holes(shape, shape.cheek, shape.sector, path, varied)


def _refuse_stray_holes(
    shape: WebShape, cheek: Cheek, sector: Sector, path: str, varied: Mapping[str, Figure]
) -> None:
    """Raise InputError if a hole is not within the outline of a variant. The smallest outer radius
    with the smallest opening has an outline within all others, and is tried first.

    Args:
        shape: Outline and holes as the file gives them.
        cheek: Cheek of the web.
        sector: Counterweight as the file gives it.
        path: Dotted name of the table.
        varied: Dimensions that vary, by their keys, in the units of the file.
    """
    radii = MM * np.asarray(varied.get("outer_radius", sector.radius / MM))
    openings = np.asarray(varied.get("opening", sector.opening))
    smallest = sector._replace(radius=float(radii.min()), opening=float(openings.min()))
    if not shape._replace(outline=tuple(cheek.draw(smallest))).stray_holes:
        return
    for radius, opening in np.broadcast(radii, openings):
        outline = cheek.draw(sector._replace(radius=radius, opening=opening))
        variant = shape._replace(outline=tuple(outline))
        refuse_stray_holes(variant, path, "the outline of the web")


def vary_body(body: WebBody, table: Web, varied: Mapping[str, Figure]) -> WebBody:
    """Return a web with other dimensions; its figures are arrays if the dimensions are. Outline and
    part at the pin stay those of the file: no quantity of variants depends on them.

    Args:
        body: Web as the file gives it, with an outline.
        table: Its table.
        varied: Dimensions that differ, by their keys, in the units of the file.
    """
    assert body.shape is not None
    model = WebModel.of(table, body.shape)
    units = {"thickness": MM, "outer_radius": MM, "opening": np.pi / 180, "density": 1e3}
    changed = {key: units[key] * value for key, value in varied.items()}
    dimensions = model.nominal._replace(**changed)
    weight = model.weigh(dimensions)
    return body._replace(
        mass=cast("float", weight.mass),
        unbalance=cast("complex", weight.unbalance),
        inertia=cast("float", weight.inertia),
        thickness=cast("float", dimensions.thickness),
    )
