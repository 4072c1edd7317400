"""Rotating vectors against what they stand for: the curve, angle by angle."""

import cmath
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from balcli.core.phasors import EPS, Phasors, unit, wrap_degrees

RELATIVE = 4 * EPS
THETA = np.linspace(0, 2 * np.pi, 7201)
VECTORS = [(3 + 4j, 1 - 2j), (1 + 0j, 1 + 0j), (1j, -1j), (2, 0.5j), (-0.3 + 0.1j, 2 - 1j), (1e-3, 5), (2 + 2j, 2 - 2j)]


def one(forward: complex, backward: complex, order: float = 2, noise: float = 0.0) -> Phasors:
    vectors = np.array([[forward], [backward]], complex)
    return Phasors.of(np.array([float(order)]), *vectors, np.array([noise]))


# ------------------------------------------------------------------ unit
SINES = {0: 0.0, 30: 0.5, 45: math.sqrt(0.5), 60: math.sqrt(0.75), 90: 1.0}


@pytest.mark.parametrize("turns", [0, -1, 123_456])
def test_unit_is_exact_at_multiples_of_30_and_45_degrees(turns):
    def sine(x: int) -> float:
        x %= 360
        return SINES[x if x <= 90 else 180 - x] if x <= 180 else -sine(x - 180)

    for angle in (*range(0, 360, 30), *range(45, 360, 90)):
        assert unit(angle + 360.0 * turns) == complex(sine(angle + 90), sine(angle)), angle


def test_unit_elsewhere_is_within_two_ulp():
    degrees = np.random.default_rng(1).uniform(-720, 720, 500)
    exact = np.array([cmath.exp(1j * math.radians(math.fmod(x, 360))) for x in degrees])
    assert np.abs(unit(degrees) - exact).max() < 4 * EPS
    assert np.abs(np.abs(unit(degrees)) - 1).max() <= 2 * EPS
    assert unit(degrees.reshape(5, 100)).shape == (5, 100)


# ------------------------------------------------------------------ the ellipse
@pytest.mark.parametrize(("forward", "backward"), VECTORS)
@pytest.mark.parametrize("order", [1, 2, 5])
def test_ellipse_against_the_curve(forward, backward, order):
    """Longest and shortest distance from the centre, and where the longest one points."""
    phasors = one(forward, backward, order)
    curve = forward * np.exp(1j * order * THETA) + backward * np.exp(-1j * order * THETA)
    assert_allclose(phasors.values(THETA), curve, rtol=0, atol=1e-12)
    size = np.abs(curve)
    assert phasors.major[0] == pytest.approx(size.max(), rel=1e-5)
    assert phasors.minor[0] == pytest.approx(size.min(), abs=1e-2)
    if phasors.minor[0] < 0.99 * phasors.major[0] and backward:
        along = np.degrees(np.angle(curve[size.argmax()]))
        assert abs((phasors.axis_deg[0] - along + 90) % 180 - 90) < 1
        assert -90 < phasors.axis_deg[0] <= 90


def test_axis_lies_above_minus_90_up_to_90():
    pairs = {0: [(1, 1), (1j, -1j), (-1, -1)], 90: [(1j, 1j), (-1j, -1j)], 45: [(1, 1j), (1j, 1)], -45: [(1, -1j)]}
    found = {axis: [one(*pair).axis_deg[0] for pair in these] for axis, these in pairs.items()}
    assert found == {axis: pytest.approx([axis] * len(these), abs=1e-12) for axis, these in pairs.items()}


@pytest.mark.parametrize("turn", [180, 360])
def test_a_direction_is_reduced_to_half_a_turn_either_way(turn):
    barely = math.nextafter(turn / 2, math.inf)  # its remainder rounds to a whole turn
    assert list(wrap_degrees([barely, -turn / 2, 1.5 * turn, 0, turn], turn)) == [turn / 2, turn / 2, turn / 2, 0, 0]


@pytest.mark.parametrize(("forward", "backward"), [(1, 0), (0, 1j), (0, 0)])
def test_a_circle_and_a_balanced_order_have_no_axis(forward, backward):
    assert math.isnan(one(forward, backward).axis_deg[0])
    assert one(forward, backward).balanced[0] == (forward == backward == 0)


@pytest.mark.parametrize(("forward", "backward"), VECTORS)
def test_components_along_x_and_y(forward, backward):
    phasors = one(forward, backward, 3)
    curve = phasors.values(THETA)
    assert_allclose((phasors.x[0] * np.exp(3j * THETA)).real, curve.real, rtol=0, atol=1e-13)
    assert_allclose((phasors.y[0] * np.exp(3j * THETA)).real, curve.imag, rtol=0, atol=1e-13)


# ------------------------------------------------------------------ scalars and means
def test_a_scalar_is_a_real_curve():
    orders = np.array([0.0, 1.0, 4.0])
    c = np.array([2 + 0j, 3 - 1j, -0.5j])
    phasors = Phasors.from_scalar(orders, c, np.zeros(3))
    curve = sum((c[k] * np.exp(1j * n * THETA)).real for k, n in enumerate(orders))
    assert_allclose(phasors.values(THETA).real, curve, rtol=0, atol=1e-14)
    assert np.abs(phasors.values(THETA).imag).max() < 1e-14
    assert np.array_equal(phasors.x, c)
    assert phasors.major == pytest.approx(np.abs(c), rel=RELATIVE)
    assert np.abs(phasors.y).max() == 0


# ------------------------------------------------------------------ arithmetic
def test_sums_scales_and_turns_are_those_of_the_curve():
    a = one(3 + 4j, 1 - 2j, noise=1e-3)
    b = one(-1j, 2, noise=2e-3)
    assert_allclose((a + b).values(THETA), a.values(THETA) + b.values(THETA), rtol=0, atol=1e-13)
    assert_allclose((a - b).values(THETA), a.values(THETA) - b.values(THETA), rtol=0, atol=1e-13)
    assert_allclose((2j * a).values(THETA), 2j * a.values(THETA), rtol=0, atol=1e-13)
    assert np.array_equal((np.array([2.0]) * a).forward, 2 * a.forward)
    assert [float(p.noise[0]) for p in (a + b, a - b, 2j * a, -3.0 * a)] == pytest.approx([3e-3, 3e-3, 2e-3, 3e-3])


@pytest.mark.parametrize("order", [0, 1, 3])
@pytest.mark.parametrize("p", [0.3 - 0.2j, 2, 1j, 0])
def test_moment_of_a_force_about_z(order, p):
    """x F_y - y F_x, angle by angle."""
    force = one(3 + 4j, 0 if order == 0 else 1 - 2j, order, noise=0.5)
    curve = force.values(THETA)
    want = p.real * curve.imag - p.imag * curve.real if isinstance(p, complex) else p * curve.imag
    moment = force.about(p)
    assert_allclose(moment.values(THETA).real, want, rtol=0, atol=1e-13)
    assert np.abs(moment.values(THETA).imag).max() < 1e-13
    assert moment.noise[0] == abs(p)  # 2 |p| 0.5


def test_settled_clears_each_vector_for_itself():
    """At its bound a vector is rounding, just above it is not."""
    orders = np.array([1.0, 2.0, 3.0])
    vectors = np.array([[1e-3, 1.1e-3j, 5e-4], [7, 5e-4, -1e-3]])
    phasors = Phasors.of(orders, *vectors, np.full(3, 1e-3)).drop_noise()
    assert list(phasors.forward) == [0, 1.1e-3j, 0]
    assert list(phasors.backward) == [7, 0, 0]
    assert list(phasors.balanced) == [False, False, True]


def test_trailing_axes_are_variants():
    orders = np.array([0.0, 1.0])
    many = Phasors.of(orders, np.arange(6.0).reshape(2, 3) + 1j, np.array([[0, 0, 0], [1, 2j, 3]]), np.zeros((2, 1)))
    for k in range(3):
        single = Phasors.of(orders, many.forward[:, k], many.backward[:, k], np.zeros(2))
        for name in ("major", "minor", "axis_deg", "x", "y", "balanced"):
            assert np.array_equal(getattr(many, name)[:, k], getattr(single, name), equal_nan=name == "axis_deg"), name
