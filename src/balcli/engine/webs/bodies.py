"""Compute mass, unbalance and inertia of a crank web from its table, in SI units.

Axes of a web: origin on the crank axis, x towards its own crank pin, y 90 degrees ahead in the
direction of rotation. The net unbalance is `u = rho t S + sum (rho_hole - rho) t A z` with the
density rho, the thickness t and the first moment S of the outline, and the area A and the place
z = x + iy of each hole; mass and polar inertia alike.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ...core.outline import (
    Cheek,
    Circle,
    Moments,
    Sector,
    Vertex,
    find_moments,
    find_swing_radius,
    holds_circle,
)
from ...errors import InputError, Problem
from ...file.fields import as_written
from ...file.web_tables import Hole, Web
from .dxf import Drawing

MM = 1e-3
ROUNDING_DEG = 1e-9
_SAME_PLACE = 1e-6  # m; circles that differ by less are one hole


class WebShape(NamedTuple):
    """Outline of a web, m.

    Attributes:
        outline: Vertices of the outline.
        holes: Holes and slugs.
        hole_densities: Density of what fills each hole, kg/m3; 0: nothing.
        cheek: The cheek; None for an outline from a drawing.
        sector: The counterweight; None if there is none, or for an outline from a drawing.
    """

    outline: tuple[Vertex, ...]
    holes: tuple[Circle, ...]
    hole_densities: tuple[float, ...]
    cheek: Cheek | None = None
    sector: Sector | None = None

    @property
    def swing_radius(self) -> float:
        """Largest distance of the outline from the crank axis, m."""
        return find_swing_radius(self.outline)

    @property
    def stray_holes(self) -> list[Circle]:
        """Holes that are not within the outline."""
        return [hole for hole in self.holes if not holds_circle(self.outline, hole)]

    def leave_stray_holes_out(self) -> WebShape:
        """Return the shape with the holes within its outline."""
        stray = self.stray_holes
        kept = []
        densities = []
        for hole, density in zip(self.holes, self.hole_densities, strict=True):
            if hole not in stray:
                kept.append(hole)
                densities.append(density)
        return self._replace(holes=tuple(kept), hole_densities=tuple(densities))


class WebBody(NamedTuple):
    """Mass and unbalance of a web, SI units, in its own axes.

    Attributes:
        mass: Mass, kg.
        unbalance: Mass times x + iy of the centre of mass, kg m.
        inertia: Polar moment of inertia about the crank axis, kg m2; None if it is not known.
        thickness: Axial thickness, m.
        at_pin: Part of the unbalance that belongs to the throw: the cheek, and holes with x > 0;
            None if it is not known.
        shape: Outline; None for a web given by its mass.
    """

    mass: float
    unbalance: complex
    inertia: float | None
    thickness: float
    at_pin: complex | None = None
    shape: WebShape | None = None


def describe_web(table: Web, path: str, throw_mm: float, drawing: Drawing | None) -> WebBody:
    """Return mass, unbalance and inertia of a web.

    Args:
        table: Table of the web, without "fit".
        path: Dotted name of the table, for messages.
        throw_mm: Crank radius, mm.
        drawing: Outline of the table's profile; None if it has none.

    Raises:
        InputError: The dimensions make no web.
    """
    thickness = MM * table.thickness
    if table.mass is not None and table.cg is not None:
        unbalance = table.mass * MM * complex(*table.cg)
        inertia = None if table.inertia is None else table.inertia * MM**2
        return WebBody(table.mass, unbalance, inertia, thickness)
    shape = draw_web(table, path, throw_mm, drawing)
    if table.counterweight_removed:
        shape = shape.leave_stray_holes_out()
    else:
        refuse_stray_holes(shape, path, "the outline of the web")
    per_area = 1e3 * table.density * thickness
    body = _weigh(find_moments(shape.outline), per_area)
    at_pin = None if shape.cheek is None else _find_cheek_unbalance(shape.cheek, per_area)
    for hole, density in zip(shape.holes, shape.hole_densities, strict=True):
        filled = _weigh_hole(hole, density, table)
        body = body.add(filled)
        if at_pin is not None and hole.x > 0:
            at_pin += filled.first
    return WebBody(body.area, body.first, body.polar, thickness, at_pin, shape)


def _weigh(moments: Moments, per_area: float) -> Moments:
    """Return mass, unbalance and inertia of a plate; `per_area`: mass per area, kg/m2."""
    return Moments(per_area * moments.area, per_area * moments.first, per_area * moments.polar)


def _weigh_hole(hole: Circle, density: float, table: Web) -> Moments:
    """Return mass, unbalance and inertia that a hole adds to a web; `density`: that of what fills
    it, kg/m3.
    """
    return _weigh(hole.moments, MM * table.thickness * (density - 1e3 * table.density))


def weigh_bare(table: Web, cheek: Cheek) -> complex:
    """Return the unbalance of a web without the steel of its counterweight, kg m: that of its cheek
    and of all its holes and slugs, also those in the counterweight.

    Args:
        table: Table of the web.
        cheek: Its cheek.
    """
    unbalance = _find_cheek_unbalance(cheek, 1e3 * table.density * MM * table.thickness)
    for hole in table.holes:
        unbalance += _weigh_hole(_draw_hole(hole), 1e3 * hole.density, table).first
    return unbalance


def _find_cheek_unbalance(cheek: Cheek, per_area: float) -> complex:
    return per_area * find_moments(cheek.draw()).first


# ------------------------------------------------------------------ shape
def draw_web(table: Web, path: str, throw_mm: float, drawing: Drawing | None) -> WebShape:
    """Return the outline and holes of a web, m; arguments and errors as for `describe_web`, but the
    holes may be anywhere.
    """
    holes = [_draw_hole(hole) for hole in table.holes]
    densities = [1e3 * hole.density for hole in table.holes]
    if drawing is not None:
        outline = [Vertex(MM * x, MM * y, bulge) for x, y, bulge in drawing.outline]
        open_holes = _list_open_holes(drawing, holes)
        densities = [0.0] * len(open_holes) + densities
        shape = WebShape(tuple(outline), (*open_holes, *holes), tuple(densities))
    else:
        cheek = find_cheek(table, path, throw_mm)
        sector = find_sector(table, path, cheek)
        outline = cheek.draw(sector)
        shape = WebShape(tuple(outline), tuple(holes), tuple(densities), cheek, sector)
    return shape


def refuse_stray_holes(shape: WebShape, path: str, outline: str) -> None:
    """Raise InputError if a web has a hole that is not within its outline.

    Args:
        shape: Outline and holes.
        path: Dotted name of the table of the web.
        outline: What the outline is called.
    """
    for hole in shape.stray_holes:
        place = f"x = {hole.x / MM:g}, y = {hole.y / MM:g}, diameter = {2 * hole.radius / MM:g}"
        told = f"the hole at {place} mm is not within {outline}"
        raise InputError([Problem(f"{path}.holes", f"{told}; move it or make it smaller")])


def _draw_hole(hole: Hole) -> Circle:
    """Return the circle of a hole, m."""
    return Circle(MM * hole.x, MM * hole.y, MM * hole.diameter / 2)


def _list_open_holes(drawing: Drawing, holes: Sequence[Circle]) -> list[Circle]:
    """Return the circles of a drawing, m, without those that the key `holes` gives as well: that
    key says what fills them.
    """
    circles = []
    for x, y, radius in drawing.holes:
        circle = Circle(MM * x, MM * y, MM * radius)
        if not any(circle.is_same(hole, _SAME_PLACE) for hole in holes):
            circles.append(circle)
    return circles


def find_cheek(table: Web, path: str, throw_mm: float) -> Cheek:
    """Return the cheek of a web, m; arguments and errors as for `describe_web`."""
    assert table.hub is not None
    assert table.boss is not None
    cheek = Cheek(MM * table.hub / 2, MM * table.boss / 2, MM * throw_mm)
    if cheek.boss >= cheek.throw + cheek.hub:
        message = (
            f"{as_written(table.boss, 'mm')}: encloses the hub; at most {2 * throw_mm:g} mm more "
        )
        message += f"than hub = {as_written(table.hub, 'mm')}"
        raise InputError([Problem(f"{path}.boss", message)])
    return cheek


def find_sector(table: Web, path: str, cheek: Cheek) -> Sector | None:
    """Return the counterweight of a web, m; None if it has none.

    Args:
        table: Table of the web.
        path: Dotted name of the table, for messages.
        cheek: Its cheek.
    """
    if table.outer_radius is None or table.opening is None:
        return None
    most = cheek.find_largest_opening(table.angle)
    if table.opening > most + ROUNDING_DEG:
        at_most = "no counterweight at this angle" if most <= 0 else f"at most {most:.5g} deg"
        told = f"{as_written(table.opening, 'deg')}; {at_most} with this hub and boss"
        raise InputError([Problem(f"{path}.opening", told)])
    return Sector(MM * table.outer_radius, table.opening, table.angle)


# ------------------------------------------------------------------ crank pin
class Pin(NamedTuple):
    """A crank pin: its mass, kg, at the crank radius, and its polar inertia about the crank axis,
    kg m2.
    """

    mass: float
    inertia: float


def weigh_pin(
    diameter_mm: float, bore_mm: float, length_mm: float, throw_mm: float, density: float
) -> Pin:
    """Return a crank pin: `m = rho pi/4 (d^2 - b^2) l`, `J = m r^2 + m (d^2 + b^2)/8`.

    Args:
        diameter_mm: Diameter d, mm.
        bore_mm: Bore b, mm.
        length_mm: Length l between its webs, mm.
        throw_mm: Crank radius r, mm.
        density: Density, g/cm3.
    """
    ring = math.pi / 4 * (diameter_mm**2 - bore_mm**2) * MM**2
    mass = 1e3 * density * ring * length_mm * MM
    about_itself = (diameter_mm**2 + bore_mm**2) / 8
    return Pin(mass, mass * (throw_mm**2 + about_itself) * MM**2)
