"""The smallest enclosing circle against exhaustive search, a convex minimiser at high precision, and its own bound."""

import itertools
import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, strategies as st
from support.cases import cases
from support.engines import build_text, engine_text

from balcli.core.peaks import find_peak
from balcli.core.phasors import Phasors
from balcli.forces.spectrum import compute_spectra, find_relevant_orders
from balcli.sizing import minimax as circle

TRUE = 1e-10  # relative to the true optimum
VECTORS = st.complex_numbers(max_magnitude=1e3, allow_nan=False, allow_infinity=False)


def force(**tables: str) -> Phasors:
    e = build_text(engine_text(**tables))
    return compute_spectra(e, find_relevant_orders(e), ("force",)).force


def seen(curve: Phasors, theta: np.ndarray) -> np.ndarray:
    return curve.values(theta) * np.exp(-1j * theta)


def smallest_of_points(points: np.ndarray) -> float:
    """Radius by all triples, in exact fractions: the largest of the smallest circles around three points (Helly)."""

    exact = [(Fraction(p.real), Fraction(p.imag)) for p in points.tolist()]
    squares = {(p, q): (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 for p, q in itertools.combinations(exact, 2)}

    def around(a, b, c) -> Fraction:
        short, middle, long = sorted((squares[a, b], squares[b, c], squares[a, c]))
        if short + middle <= long:  # obtuse, or in line
            return long / 4
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        return short * middle * long / (4 * area**2)

    return math.sqrt(max(around(*triple) for triple in itertools.combinations(exact, 3)))


@given(st.lists(VECTORS, min_size=3, max_size=12, unique=True))
def test_points(points):
    points = np.array(points)
    centre, fixing = circle.enclose_points(points)
    radius = np.abs(points[fixing] - centre).max()
    assert np.all(np.abs(points - centre) <= radius * (1 + 1e-9) + 1e-12)
    assert radius == pytest.approx(smallest_of_points(points), rel=1e-9, abs=1e-12)
    assert len(fixing) <= 3


@pytest.mark.parametrize(
    ("lam", "offset"),
    [
        *((lam, 0) for lam in (0.05, 0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6)),
        *((lam, offset) for lam in (0.1, 0.3, 0.6) for offset in (4, -15)),
    ],
)
def test_single_cylinder_at_high_precision(lam, offset):
    """mpmath finds where the curve is farthest from the centre; three such points, solved to 30
    digits, are the true optimum.
    """
    tables = {"rod": f"ratio = {lam}", "piston": f"mass = 1\noffset = {offset}", "operation": "speed = 1000"}
    found = circle.enclose_curve(force(**tables))
    with mpmath.workdps(30):
        r = mpmath.mpf(50) / 1000
        length = mpmath.mpf(50) / 1000 / mpmath.mpf(str(lam))
        omega = mpmath.mpf(1000) * mpmath.pi / 30

        def curve(t):
            s = (r * mpmath.sin(t) - mpmath.mpf(offset) / 1000) / length
            root = mpmath.sqrt(1 - s * s)
            rate = r * mpmath.cos(t) / length  # of sin(beta)
            second = -r * mpmath.sin(t) / length
            root2 = -(rate**2 + s * second) / root - (s * rate) ** 2 / root**3
            return (r * mpmath.cos(t) - length * root2) * omega**2 * mpmath.exp(mpmath.mpc(0, -1) * t)

        def reach(x, y, t):
            return abs(curve(t) - mpmath.mpc(x, y)) ** 2

        def equations(x, y, *angles):
            values = [reach(x, y, t) for t in angles]
            slopes = [mpmath.diff(lambda t: reach(x, y, t), t) for t in angles]
            return [*(v - values[0] for v in values[1:]), *slopes]

        x = found.centre.real
        y = found.centre.imag
        if len(found.theta) == 3:
            x, y, *angles = mpmath.findroot(equations, (x, y, *found.theta), tol=1e-20)
            assert abs(found.centre - complex(x, y)) <= TRUE * found.radius
            assert float(mpmath.sqrt(reach(x, y, angles[0]))) == pytest.approx(found.radius, rel=TRUE)
        grid = max(abs(curve(t) - mpmath.mpc(x, y)) for t in mpmath.linspace(0, 2 * mpmath.pi, 200))
        assert grid <= found.radius * (1 + TRUE)
    assert found.excess <= 1e-13 * found.radius


@cases("oracle/circle", "nothing_near_is_better")
def test_nothing_near_is_better(tables):
    """Convex: if no centre on a small ring is better, none is; and points of the curve alone prove the radius."""
    curve = force(**tables)
    found = circle.enclose_curve(curve)
    samples = seen(curve, np.linspace(0, 2 * np.pi, 20001))
    assert np.abs(samples - found.centre).max() <= found.radius * (1 + 1e-13)
    # lower peaks are not named
    assert np.abs(seen(curve, found.theta) - found.centre) == pytest.approx(found.radius, rel=1e-10)
    for step in (1e-3, 1e-5):
        for direction in np.exp(1j * np.linspace(0, 2 * np.pi, 24)):
            other = found.centre + step * found.radius * direction
            forward = np.where(curve.orders == 1, curve.forward - other, curve.forward)
            moved = Phasors.of(curve.orders, forward, curve.backward, np.zeros(1))
            assert find_peak(moved).value >= found.radius * (1 - 1e-13)
    assert found.excess <= TRUE * found.radius


@pytest.mark.parametrize("first", [0, 3 + 4j])
@pytest.mark.parametrize(
    ("forward", "backward", "centre", "radius", "touching"),
    [
        ((0, 0, 2, 1), (0, 0, 0, 0), 0.5, 1.5 * 3**0.5, (60, 300)),
        ((2, 0, 0, 0), (0, 1, 0, 0), 0.5, 1.5 * 3**0.5, (60, 300)),
        ((0, 0, -2j, -1), (0, 0, 0, 0), 0.5, 1.5 * 3**0.5, (30, 150)),
        ((0, 0, 2, 0), (0, 1, 0, 0), 0, 3, (0, 120, 240)),
    ],
)
def test_cardioids_and_a_deltoid(forward, backward, centre, radius, touching, first):
    """Seen from the crank: a cardioid `2 e^{it} + e^{2it}` (mirrored, begun elsewhere) in a circle
    about 1/2 that it touches at t = +-60 deg, the deltoid `2 e^{it} + e^{-2it}` in one about 0.
    Whatever turns with the crank moves the centre alone.
    """
    orders = np.arange(4.0)
    whole = np.array(forward, complex) + np.where(orders == 1, first, 0)
    found = circle.enclose_curve(Phasors.of(orders, whole, np.array(backward, complex), np.zeros(1)))
    assert found.centre == pytest.approx(first + centre, abs=1e-12)
    assert found.radius == pytest.approx(radius, rel=1e-14)
    assert sorted((np.degrees(found.theta) + 1) % 360 - 1) == pytest.approx(touching, abs=1e-5)
    assert found.excess <= 1e-13 * radius


def test_a_small_circle_beside_a_large_first_order_is_touched_wherever_it_is_but_for_rounding():
    """Equal peaks 18 times a revolution, of a millionth of what a weight takes away."""
    eight = 1e-6
    ten = 2e-8
    vectors = np.array([[1.0, 0, ten], [0, eight, 0]], complex)
    found = circle.enclose_curve(Phasors(np.array([1.0, 8.0, 10.0]), vectors, np.zeros(1)))
    assert found.radius == pytest.approx(eight + ten, rel=1e-9)
    assert len(found.theta) == 18
    assert found.excess == 0
