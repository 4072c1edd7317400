"""Uneven crank speed against the time domain: momentum on a dense grid, differentiated numerically.

`tests/oracle/test_momentum.py` does the same with whole engines; here are the rules by themselves.
"""

from functools import partial

import numpy as np
import pytest
from support.engines import engine
from support.in_time import run_in_time

from balcli.analysis.curves import compute_engine_curves
from balcli.core import speed_ripple as ripple
from balcli.core.phasors import Phasors
from balcli.forces.spectrum import compute_spectra, find_relevant_orders

RELATIVE = 1e-9  # central differences of sixth order at STEP
STEP = 2e-3
THETA = np.linspace(0, 2 * np.pi, 97)
LINES = {
    "one": [(2, 0.05, 40.0)],
    "two": [(1, 0.2, 0.0), (3, 0.1, -120.0)],
    "none worth naming": [(4, 0.0, 10.0)],
    "the same twice": [(2, 0.05, 0.0), (2, 0.05, 90.0)],
}
ORDERS = np.arange(0.0, 15.0)
RANDOM = np.random.default_rng(4)
FORWARD, BACKWARD = (RANDOM.normal(size=(2, 15)) + 1j * RANDOM.normal(size=(2, 15))) * 0.5**ORDERS
FORWARD, BACKWARD = (np.where((ORDERS > 0) & (ORDERS <= 8), v, 0) for v in (FORWARD, BACKWARD))  # then room for W^2


def speed(lines, theta):
    """W at some crank angles, as the engine file defines it."""
    return 1 + sum(a * np.cos(n * theta - np.radians(angle)) for n, a, angle in lines)


def rate(function, theta):
    """Derivative by the sixth-order central difference."""
    weights = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
    return sum(w * (function(theta + k * STEP) - function(theta - k * STEP)) for k, w in weights.items()) / STEP


def momentum(theta, backward=BACKWARD):
    """G of a steady force F = -G': every order divided by -i n."""
    n = np.where(ORDERS, ORDERS, 1)
    return Phasors.of(ORDERS, FORWARD / (-1j * n), backward / (1j * n), np.zeros(15)).values(theta)


def steady(scalar=False):
    backward = np.conj(FORWARD) if scalar else BACKWARD
    return Phasors.of(ORDERS, FORWARD, backward, np.full(15, 1e-15))


@pytest.mark.parametrize("lines", LINES.values(), ids=LINES.keys())
def test_two_sided_coefficients_of_the_speed(lines):
    w = ripple.find_speed(lines)
    highest = len(w) // 2
    found = sum(c * np.exp(1j * (k - highest) * THETA) for k, c in enumerate(w))
    assert found == pytest.approx(speed(lines, THETA) + 0j, abs=1e-14)


@pytest.mark.parametrize("what", ["force", "couple", "torque"])
@pytest.mark.parametrize("lines", LINES.values(), ids=LINES.keys())
def test_force_couple_and_torque(lines, what):
    """-W (W G)'; the same of the moment of momentum with its mean; -(1/2 I W^2)', 1/2 I likewise with its mean."""
    w = partial(speed, lines)
    mean = 0.0 if what == "force" else 3.0
    last = what == "torque"

    def carried(theta):
        return momentum(theta) if what == "force" else mean + momentum(theta, np.conj(FORWARD)).real

    want = (
        -rate(lambda t: carried(t) * w(t) ** 2, THETA) if last else -w(THETA) * rate(lambda t: w(t) * carried(t), THETA)
    )
    found = ripple.apply_speed(steady(what != "force"), ripple.find_speed(lines), mean, rate_last=last)
    assert np.abs(found.values(THETA) - want).max() < RELATIVE * np.abs(want).max()
    assert not last or abs(found.forward[0]) < 1e-14


@pytest.mark.parametrize(
    "lines", [*LINES.values(), [(1, 0.9, 0.0), (2, 0.4, 180.0)], [(3, 0.7, 10.0), (256, 0.6, -50.0), (4, -0.4, 0.0)]]
)
def test_the_least_speed_is_that_of_a_dense_grid(lines):
    theta = np.linspace(0, 2 * np.pi, 400_001)
    least, at, _ = ripple.find_slowest(lines)
    grid = speed(lines, theta).min()
    bend = sum(n**2 * abs(a) for n, a, _ in lines)
    assert grid - bend * theta[1] ** 2 / 8 - 1e-14 <= least <= grid + 1e-14
    assert speed(lines, at) == pytest.approx(least, abs=1e-12)


def test_a_mean_force_is_a_mean_and_stands_in_forward_alone():
    """A first-order vector under a first-order ripple pushes to one side: the mean of -W W' G."""
    found = ripple.apply_speed(steady(), ripple.find_speed(LINES["two"]))
    theta = np.arange(64) * 2 * np.pi / 64
    assert found.backward[0] == 0
    assert found.forward[0] == pytest.approx(found.values(theta).mean(), rel=1e-12)
    assert abs(found.forward[0]) > 1e-3


@pytest.mark.parametrize("mean", [0.0, 300.0, -300.0])
@pytest.mark.parametrize("lines", [[(2, 0.3, 40.0)], [(1, 0.2, 170.0), (3, 0.1, -120.0)]])
def test_the_bound_holds_for_errors_of_the_parts(lines, mean):
    """Errors of the size that the parts' noise tells, with signs as they come, move no order by
    more than the bound; and the bound knows of lines no more than their sizes.
    """
    w = ripple.find_speed(lines)
    level = ripple.find_speed([(order, size, 0.0) for order, size, _ in lines])
    random = np.random.default_rng(7)
    for of_torque in (False, True):
        noise = 1e-9 * random.uniform(1, 2, 15)

        def apply(ahead, astern, w, last=of_torque, noise=noise):
            return ripple.apply_speed(Phasors.of(ORDERS, ahead, astern, noise), w, mean, rate_last=last)

        backward = np.conj(FORWARD) if of_torque else BACKWARD
        found = apply(FORWARD, backward, w)
        assert found.noise == pytest.approx(apply(FORWARD, backward, level).noise, rel=1e-12, abs=0)
        for _ in range(20):
            errors = [noise * np.where(ORDERS > 0, np.exp(2j * np.pi * random.random(15)), 0) for _ in range(2)]
            if of_torque:
                errors[1] = np.conj(errors[0])
            moved = apply(FORWARD + errors[0], backward + errors[1], w) - found
            assert np.all(np.abs(moved.vectors) <= found.noise + 1e-13)


# ------------------------------------------------------------------ half orders
def test_a_speed_of_half_orders_mixes_into_half_orders_as_the_curves_over_the_angle_say():
    """`curves` evaluates the motion at each angle and knows no orders."""
    lines = [{"order": 0.5, "amplitude": 0.1, "angle": 30}, {"order": 2, "amplitude": 0.05}]
    gas = {"cycle": "otto", "compression_ratio": 9, "imep": 8}
    single = engine(gas=gas, piston={"mass": 1, "bore": 90}, operation={"speed": 2000, "speed_ripple": lines})
    angles = np.arange(0.0, 720.0, 11.0)
    direct = compute_engine_curves(single, angles)
    spectra = compute_spectra(single, find_relevant_orders(single), ["force", "torque"])
    assert spectra.force.balanced.sum() == 0
    assert spectra.force.orders[:3].tolist() == [0, 0.5, 1]
    for name, phasors in (("force_x_N", spectra.force), ("inertia_torque_Nm", spectra.torque)):
        found = phasors.values(np.radians(angles)).real
        assert found == pytest.approx(direct[name], abs=1e-11 * np.abs(direct[name]).max())


@pytest.mark.parametrize(
    ("lines", "step"),
    [([(2, 0.2, 30.0), (1, 0.05, 0.0)], 1.0), ([(0.5, 0.1, -70.0), (2, 0.2, 30.0)], 0.5), ([(1, 0.6, 200.0)], 0.5)],
)
def test_orders_of_the_time(lines, step):
    """Phasors of a curve over equal steps of time: mean, halves where there are some, in both senses of rotation."""
    turns = round(1 / step)
    over_angle = np.arange(0, 8 + step, step)
    orders = np.arange(0, 12 + step, step)
    rng = np.random.default_rng(5)
    forward, backward = rng.normal(size=(2, len(over_angle), 2)) @ [1, 1j]
    backward[0] = 0
    phasors = Phasors.of(over_angle, forward, backward, np.zeros(1))
    timetable = ripple.find_timetable(ripple.find_speed(list(lines), step), step, 1 << 10)
    found = ripple.count_in_time(phasors, timetable, orders)

    theta, period = run_in_time(partial(speed, lines), turns)
    curve = phasors.values(theta)
    ahead = np.fft.fft(curve, norm="forward")
    rows = np.rint(orders / step).astype(int)
    began = np.exp(1j * orders * timetable.clock[0])
    assert timetable.turns == pytest.approx(2 * np.pi * turns / period, rel=1e-12)
    assert found.forward * began == pytest.approx(ahead[rows], rel=1e-9, abs=1e-9)
    astern = np.where(orders, ahead[-rows], 0)
    assert found.backward / began == pytest.approx(astern, rel=1e-9, abs=1e-9)


def test_no_order_beyond_reach_is_felt():
    lines = [(2, 0.2, 30.0)]
    timetable = ripple.find_timetable(ripple.find_speed(lines, 1.0), 1.0, 1 << 10)
    theta, _ = run_in_time(partial(speed, lines), 1)
    reach = ripple.find_reach(timetable, 12.0)

    def find_share(order):
        """Of an order over the angle in order 12 of the time: by steps, and as counted."""
        one = Phasors.of(np.array([order]), np.ones(1, complex), np.zeros(1, complex), np.zeros(1))
        found = ripple.count_in_time(one, timetable, np.array([12.0]))
        return [abs(np.fft.fft(one.values(theta), norm="forward")[12]), abs(found.forward[0])]

    assert find_share(reach + 2) == pytest.approx([0, 0], abs=2e-13)
    own, found = find_share(reach / 2)
    assert found == pytest.approx(own, rel=1e-6)
    assert found > 1e-6
