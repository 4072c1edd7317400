"""Shapes of lines and arcs, against polygons of many points by shapely."""

import cmath
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from shapely.geometry import Point, Polygon

from balcli.core.outline import (
    Cheek,
    Circle,
    Sector,
    Vertex,
    find_arc,
    find_moments,
    find_swing_radius,
    holds_circle,
    list_edges,
)

SHAPES = {
    "cheek": Cheek(32.5, 26.5, 44).draw(),
    "web": Cheek(32.5, 26.5, 44).draw(Sector(78, 115.5, 180)),
    "skew web": Cheek(29, 31, 38.7).draw(Sector(66, 70, 205)),
    "disc": Cheek(80, 26, 44).draw(),
    "disc with a weight": Cheek(80, 26, 44).draw(Sector(95, 300, 180)),
    "clockwise": [Vertex(0, 0, -0.4), Vertex(-3, 7), Vertex(9, 8, 0.3), Vertex(11, -2, -1.9)],
}


def sample(outline, steps=4000):
    """Places along an outline, dense on arcs, by the turn of the radius."""
    places = []
    for start, end in list_edges(outline):
        angle = 4 * math.atan(start.bulge)
        places.append(start.place)
        if angle:
            centre = (end.place - start.place * cmath.exp(1j * angle)) / (1 - cmath.exp(1j * angle))
            turn = np.exp(1j * angle * np.arange(1, steps) / steps)
            places += (centre + (start.place - centre) * turn).tolist()
    return np.array(places)


def find_polar(places):
    """Polar moment of a polygon: triangles from the origin, each by its three corners' mean."""
    z0, z1 = places, np.roll(places, -1)
    doubled = (np.conj(z0) * z1).imag
    return (doubled * (abs(z0) ** 2 + abs(z1) ** 2 + (np.conj(z0) * z1).real)).sum() / 12


@pytest.mark.parametrize("name", SHAPES)
def test_moments_are_those_of_polygons(name):
    outline = SHAPES[name]
    places = sample(outline)
    polygon = Polygon(np.column_stack([places.real, places.imag]))
    found = find_moments(outline)
    size = abs(places).max()
    assert_allclose(found.area, polygon.area, rtol=1e-6)
    centroid = complex(polygon.centroid.x, polygon.centroid.y)
    assert abs(found.first - polygon.area * centroid) < 1e-6 * size * polygon.area
    assert_allclose(found.polar, abs(find_polar(places)), rtol=1e-6)
    assert_allclose(find_swing_radius(outline), size, rtol=1e-6)


@pytest.mark.parametrize("name", SHAPES)
def test_turned_and_mirrored_shapes_keep_area_and_inertia(name):
    outline = SHAPES[name]
    turn = cmath.exp(0.83j)
    turned = [Vertex((v.place * turn).real, (v.place * turn).imag, v.bulge) for v in outline]
    mirrored = [Vertex(v.x, -v.y, -v.bulge) for v in outline]
    own = find_moments(outline)
    for other in (find_moments(turned), find_moments(mirrored)):
        assert_allclose([other.area, other.polar], [own.area, own.polar], rtol=1e-12)
    assert_allclose(find_moments(turned).first, own.first * turn, atol=1e-9 * own.area)


def test_cheek_is_the_convex_hull_of_both_circles():
    circles = Point(0, 0).buffer(32.5, 2000).union(Point(44, 0).buffer(26.5, 2000))
    assert_allclose(find_moments(SHAPES["cheek"]).area, circles.convex_hull.area, rtol=1e-6)


def test_weight_is_a_sector_from_the_hub():
    """Closed forms of a ring sector, at two openings and radii."""
    cheek = Cheek(32.5, 26.5, 44)
    for radius, opening in ((78, 115.5), (61, 40)):
        added = find_moments(cheek.draw(Sector(radius, opening))).add(find_moments(cheek.draw()), -1)
        half = math.radians(opening) / 2
        assert_allclose(added.area, half * (radius**2 - 32.5**2))
        assert_allclose(added.first, -2 / 3 * (radius**3 - 32.5**3) * math.sin(half), atol=1e-6)
        assert_allclose(added.polar, half / 2 * (radius**4 - 32.5**4))


@pytest.mark.parametrize("angle", [150, 180, 215])
def test_a_weight_up_to_the_tangent_is_the_limit_of_smaller_ones(angle):
    """At the largest opening, an edge of the sector is on the tangent of the cheek."""
    cheek = Cheek(38, 32, 42)
    most = cheek.find_largest_opening(angle)
    assert most > 0
    whole = find_moments(cheek.draw(Sector(55, most, angle)))
    alone = find_moments(cheek.draw())
    opening = math.radians(most)
    assert_allclose(whole.area - alone.area, opening * (55**2 - 38**2) / 2, rtol=1e-9)
    middle = cmath.exp(1j * math.radians(angle))
    first = 2 / 3 * (55**3 - 38**3) * math.sin(opening / 2) * middle
    assert abs(whole.first - alone.first - first) < 1e-9 * abs(first)
    almost = find_moments(cheek.draw(Sector(55, most - 1e-5, angle)))
    assert_allclose(almost.area, whole.area, rtol=1e-6)


def test_largest_opening_touches_the_tangent():
    cheek = Cheek(32.5, 26.5, 44)
    most = cheek.find_largest_opening()
    assert_allclose(math.cos(math.radians(180 - most / 2)), (32.5 - 26.5) / 44)
    assert_allclose(cheek.find_largest_opening(190), most - 20)
    outline = cheek.draw(Sector(78, most))
    assert Polygon([(p.real, p.imag) for p in sample(outline, 50)]).is_valid


@pytest.mark.parametrize("name", SHAPES)
def test_holes_are_within_where_shapely_says_so(name):
    outline = SHAPES[name]
    places = sample(outline, 400)
    polygon = Polygon(np.column_stack([places.real, places.imag]))
    steps = np.linspace(-1, 1, 9) * abs(places).max()
    for x in steps:
        for y in steps:
            for radius in (0.7, 9.0):
                margin = polygon.exterior.distance(Point(x, y)) - radius
                if abs(margin) > 1e-2:
                    inside = polygon.contains(Point(x, y)) and margin > 0
                    assert holds_circle(outline, Circle(x, y, radius)) is inside, (x, y, radius)


def test_arcs_have_the_given_bulge():
    arc = find_arc(Vertex(1, 0, math.tan(math.radians(90) / 4)), Vertex(0, 1))
    assert abs(arc.centre) < 1e-15
    assert_allclose([arc.radius, arc.angle], [1, math.pi / 2])
