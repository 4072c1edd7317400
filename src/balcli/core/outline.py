"""Compute area and moments of flat shapes of lines and arcs, and the outline of a crank web.

An outline is a closed polyline as in a DXF file: vertices (x, y) with the bulge of the edge that
begins there. The bulge is the tangent of a quarter of the arc's angle, positive anticlockwise; 0: a
straight line.

Green's theorem gives the moments of the polygon of the vertices. An edge from (x0, y0) to (x1, y1)
with `k = x0 y1 - x1 y0` adds `k/2` to the area, `(x0 + x1) k/6` and `(y0 + y1) k/6` to the first
moments, and `k (x0^2 + x0 x1 + x1^2 + y0^2 + y0 y1 + y1^2)/12` to the polar moment (P. Bourke,
"Calculating the area and centroid of a polygon", 1988). An arc adds its circular segment: with the
angle alpha and the radius R, it has the area `R^2 (alpha - sin alpha)/2`, its centroid is at
`4 R sin^3(alpha/2)/(3 (alpha - sin alpha))` from the centre, and its polar moment about the centre
is `R^4 alpha/4 - R^4 sin alpha (2 + cos alpha)/12` (any handbook). Lengths have any one unit.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

_HALF_TURN = 180.0
_ROUNDING = 1e-12  # share of the size of a shape; smaller differences are rounding


class Vertex(NamedTuple):
    """A vertex of an outline, and the bulge of the edge that begins at it."""

    x: float
    y: float
    bulge: float = 0.0

    @property
    def place(self) -> complex:
        """Place x + iy."""
        return complex(self.x, self.y)


class Circle(NamedTuple):
    """A circle with its centre x, y."""

    x: float
    y: float
    radius: float

    def is_same(self, other: Circle, tolerance: float) -> bool:
        """Return whether place and radius of another circle differ by at most a tolerance."""
        return all(abs(a - b) <= tolerance for a, b in zip(self, other, strict=True))

    @property
    def moments(self) -> Moments:
        """Moments of the disc."""
        area = math.pi * self.radius**2
        centre = complex(self.x, self.y)
        return Moments(area, area * centre, area * (self.radius**2 / 2 + abs(centre) ** 2))


class Moments(NamedTuple):
    """Area of a shape, its first moment (area times x + iy of the centroid), and its polar second
    moment about the origin.
    """

    area: float
    first: complex
    polar: float

    def add(self, other: Moments, factor: float = 1.0) -> Moments:
        """Return the sum of these moments and `factor` times other ones."""
        return Moments(
            self.area + factor * other.area,
            self.first + factor * other.first,
            self.polar + factor * other.polar,
        )


class Arc(NamedTuple):
    """An edge of an outline that is an arc.

    Attributes:
        centre: Centre x + iy.
        radius: Radius.
        start: Place of its first vertex.
        angle: Angle of the arc, rad, positive anticlockwise.
    """

    centre: complex
    radius: float
    start: complex
    angle: float

    def has(self, direction: complex) -> bool:
        """Return whether the arc has a point in this direction from its centre."""
        turn = cmath.phase(direction / (self.start - self.centre))
        if self.angle < 0:
            turn = -turn
        return turn % (2 * math.pi) <= abs(self.angle)


def find_arc(start: Vertex, end: Vertex) -> Arc | None:
    """Return the arc between two vertices; None for a straight edge."""
    chord = end.place - start.place
    if not start.bulge or not chord:
        return None
    angle = 4 * math.atan(start.bulge)
    radius = abs(chord) / (2 * abs(math.sin(angle / 2)))
    # distance of the centre to the left of the chord, in halves of the chord
    left = (1 - start.bulge**2) / (2 * start.bulge)
    return Arc(start.place + chord / 2 * (1 + 1j * left), radius, start.place, angle)


def list_edges(outline: Sequence[Vertex]) -> Iterator[tuple[Vertex, Vertex]]:
    """Yield first and last vertex of each edge of a closed outline."""
    for k, start in enumerate(outline):
        yield start, outline[(k + 1) % len(outline)]


def find_moments(outline: Sequence[Vertex], holes: Iterable[Circle] = ()) -> Moments:
    """Return the moments of a shape with holes. The outline may run in either sense."""
    whole = Moments(0.0, 0j, 0.0)
    for start, end in list_edges(outline):
        whole = whole.add(_find_edge_moments(start, end))
    if whole.area < 0:
        whole = Moments(-whole.area, -whole.first, -whole.polar)
    for hole in holes:
        whole = whole.add(hole.moments, -1.0)
    return whole


def _find_edge_moments(start: Vertex, end: Vertex) -> Moments:
    """Return the moments of the triangle between the origin and an edge, and of its segment."""
    x0, y0, _ = start
    x1, y1, _ = end
    k = x0 * y1 - x1 * y0
    squares = x0 * x0 + x0 * x1 + x1 * x1 + y0 * y0 + y0 * y1 + y1 * y1
    triangle = Moments(k / 2, complex(x0 + x1, y0 + y1) * k / 6, k * squares / 12)
    arc = find_arc(start, end)
    return triangle if arc is None else triangle.add(_find_segment_moments(arc, end.place))


def _find_segment_moments(arc: Arc, end: complex) -> Moments:
    """Return the moments of a circular segment, negative for a clockwise arc.

    Args:
        arc: Arc of the segment.
        end: Place of its last vertex.
    """
    angle = abs(arc.angle)
    sense = math.copysign(1.0, arc.angle)
    sine = math.sin(angle)
    radius = arc.radius
    area = radius**2 * (angle - sine) / 2
    chord = end - arc.start
    outwards = -1j * sense * chord / abs(chord)  # from the centre to the middle of the arc
    reach = 2 * radius**3 * math.sin(angle / 2) ** 3 / 3  # area times distance from the centre
    about_centre = radius**4 * (angle / 4 - sine * (2 + math.cos(angle)) / 12)
    first = area * arc.centre + reach * outwards
    moved = 2 * reach * (outwards * arc.centre.conjugate()).real + area * abs(arc.centre) ** 2
    return Moments(sense * area, sense * first, sense * (about_centre + moved))


def trace(outline: Sequence[Vertex], step_deg: float = 1.0) -> list[complex]:
    """Return places x + iy along a closed outline, from its first vertex back to it.

    Args:
        outline: Vertices.
        step_deg: Largest angle between two places on an arc, deg.
    """
    places = []
    for start, end in list_edges(outline):
        places.append(start.place)
        arc = find_arc(start, end)
        if arc is None:
            continue
        steps = math.ceil(math.degrees(abs(arc.angle)) / step_deg)
        for k in range(1, steps):
            turn = cmath.exp(1j * arc.angle * k / steps)
            places.append(arc.centre + (arc.start - arc.centre) * turn)
    return [*places, places[0]]


# ------------------------------------------------------------------ distances
def find_swing_radius(outline: Sequence[Vertex]) -> float:
    """Return the largest distance of an outline from the origin."""
    radii = [abs(vertex.place) for vertex in outline]
    for start, end in list_edges(outline):
        arc = find_arc(start, end)
        if arc is not None and (not arc.centre or arc.has(arc.centre)):
            radii.append(abs(arc.centre) + arc.radius)
    return max(radii)


def holds_circle(outline: Sequence[Vertex], circle: Circle) -> bool:
    """Return whether a circle is within an outline; it may touch the outline."""
    centre = complex(circle.x, circle.y)
    size = find_swing_radius(outline)
    if _find_distance(outline, centre) < circle.radius - _ROUNDING * size:
        return False
    return _wind(outline, centre)


def _find_distance(outline: Sequence[Vertex], point: complex) -> float:
    """Return the smallest distance of a point from the edges of an outline."""
    distances = []
    for start, end in list_edges(outline):
        distances.append(abs(point - start.place))
        arc = find_arc(start, end)
        if arc is None:
            distances.append(_find_distance_of_line(start.place, end.place, point))
        elif point == arc.centre or arc.has(point - arc.centre):
            distances.append(abs(abs(point - arc.centre) - arc.radius))
    return min(distances)


def _find_distance_of_line(start: complex, end: complex, point: complex) -> float:
    along = end - start
    if not along:
        return abs(point - start)
    share = ((point - start) / along).real
    return abs(point - start - min(max(share, 0.0), 1.0) * along)


def _wind(outline: Sequence[Vertex], point: complex) -> bool:
    """Return whether an outline winds around a point that is not on it."""
    turn = 0.0
    for start, end in list_edges(outline):
        if start.place == end.place:
            continue
        arc = find_arc(start, end)
        of_chord = cmath.phase((end.place - point) / (start.place - point))
        turn += of_chord if arc is None else _wind_along(arc, end.place, point, of_chord)
    return abs(turn) > math.pi


def _wind_along(arc: Arc, end: complex, point: complex, of_chord: float) -> float:
    """Return the angle that an arc turns about a point, rad: that of its chord, or a whole turn
    more if the point is between arc and chord.

    Args:
        arc: Arc.
        end: Place of its last vertex.
        point: The point, not on the arc.
        of_chord: Angle that the chord turns about the point, rad.
    """
    sense = math.copysign(1.0, arc.angle)
    beyond_chord = -sense * ((point - arc.start) / (end - arc.start)).imag
    is_within = abs(point - arc.centre) < arc.radius
    if is_within and abs(beyond_chord) <= _ROUNDING:  # on the chord, whose angle has no sign
        return sense * math.pi
    return of_chord + 2 * math.pi * sense if is_within and beyond_chord > 0 else of_chord


# ------------------------------------------------------------------ webs
class Sector(NamedTuple):
    """Counterweight of a web: a sector from the hub's radius outwards.

    Attributes:
        radius: Outer radius.
        opening: Full angle, deg.
        angle: Angle of its middle from the crank pin, deg.
    """

    radius: float
    opening: float
    angle: float = _HALF_TURN


class Cheek(NamedTuple):
    """Convex hull of the circles around main journal and crank pin.

    Attributes:
        hub: Radius of the circle around the main journal, whose centre is the origin.
        boss: Radius of the circle around the crank pin.
        throw: Distance of the crank pin from the origin, along x.
    """

    hub: float
    boss: float
    throw: float

    @property
    def is_disc(self) -> bool:
        """Whether the hub encloses the boss."""
        return self.hub >= self.throw + self.boss

    @property
    def tangent_deg(self) -> float:
        """Angle gamma at which the tangents leave the hub, deg: `cos gamma = (Rh - Rb)/r`."""
        if self.is_disc:
            return 0.0
        return math.degrees(math.acos((self.hub - self.boss) / self.throw))

    def find_largest_opening(self, angle: float = _HALF_TURN) -> float:
        """Return the largest opening of a counterweight that touches the cheek only at the hub,
        deg; negative if there is none.

        Args:
            angle: Angle of its middle from the crank pin, deg.
        """
        aside = abs(_HALF_TURN - angle % 360)
        return 2 * (_HALF_TURN - self.tangent_deg - aside)

    def draw(self, sector: Sector | None = None) -> list[Vertex]:
        """Return the outline of the cheek, anticlockwise, with its counterweight.

        Args:
            sector: Counterweight; its opening is at most `find_largest_opening`.
        """
        gamma = self.tangent_deg
        bounds = [(gamma, 360 - gamma, self.hub)]
        if sector is not None:
            first = sector.angle % 360 - sector.opening / 2
            last = first + sector.opening
            bounds = [
                (gamma, first, self.hub),
                (first, last, sector.radius),
                (last, 360 - gamma, self.hub),
            ]
        outline = [] if self.is_disc else _draw_arc(self.throw, self.boss, -gamma, gamma)
        for start, end, radius in bounds:
            if end - start > _ROUNDING * 360:
                outline += _draw_arc(0.0, radius, start, end)
            elif radius == self.hub:  # the sector begins or ends at the tangent: only a point
                outline.append(_place(radius, start))
        return _join(outline)


def _draw_arc(centre: float, radius: float, start: float, end: float) -> list[Vertex]:
    """Return vertices of an arc and its end; an arc of more than 180 degrees has two parts.

    Args:
        centre: Place of its centre along x.
        radius: Radius.
        start: Angle of its start, deg.
        end: Angle of its end, deg.
    """
    parts = 1 if end - start <= _HALF_TURN else 2
    step = (end - start) / parts
    bulge = math.tan(math.radians(step) / 4)
    vertices = []
    for k in range(parts + 1):
        turn = find_direction(start + k * step)
        x = centre + radius * turn.real
        vertices.append(Vertex(x, radius * turn.imag, bulge if k < parts else 0.0))
    return vertices


def _place(radius: float, angle: float) -> Vertex:
    """Return a vertex around the origin; `angle`: its direction, deg."""
    turn = find_direction(angle)
    return Vertex(radius * turn.real, radius * turn.imag)


def find_direction(degrees: float) -> complex:
    """Return the unit vector in a direction; exact at multiples of 90 degrees."""
    quarters = round(degrees / 90)
    rest = math.radians(degrees - 90 * quarters)
    return complex(math.cos(rest), math.sin(rest)) * (1, 1j, -1, -1j)[quarters % 4]


def _join(outline: Sequence[Vertex]) -> list[Vertex]:
    """Return an outline without edges of no length: of two vertices at one place, the later one
    begins the next edge.
    """
    size = max(abs(vertex.place) for vertex in outline)
    joined = []
    for start, end in list_edges(outline):
        if abs(start.place - end.place) > _ROUNDING * size:
            joined.append(start)
    return joined
