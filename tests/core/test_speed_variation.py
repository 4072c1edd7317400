"""Speed of a shaft from energy, against 50 digits and against the equation of motion."""

import mpmath as mp
import numpy as np
import pytest
from support.cases import slow

from balcli.core.piecewise import polyline, resolved
from balcli.core.shaft_speed import StallError, needed_inertia, speed_variation, surplus

TURN = 2 * np.pi
MEAN = 30.0  # rad/s


def torque(angle):
    """Its integral, for the 50 digits, is WORK."""
    return 20 + 300 * np.sin(angle) + 200 * np.cos(2 * angle)


def work(angle):
    return 300 * (1 - mp.cos(angle)) + 100 * mp.sin(2 * angle)


def steady(inertia):
    return lambda angle: np.full(np.shape(angle), inertia)


TORQUE = resolved(torque, [0, TURN])


# ---------------------------------------------------------------- energy
def test_surplus_energy_is_between_the_extremes_of_the_running_sum():
    """Slowest at 270 deg, fastest at 90 deg."""
    torque = resolved(lambda x: np.cos(x) * (3 + np.sin(x)) + 5, [0, TURN])
    found = surplus(torque)
    assert found.energy == pytest.approx(6, rel=1e-14)
    assert np.degrees(found.start) == pytest.approx(270, abs=1e-9)
    assert np.degrees(found.end) == pytest.approx(90, abs=1e-9)
    assert torque.integral == pytest.approx(5 * TURN, rel=1e-14)


def test_surplus_is_no_single_loop_and_no_work_of_a_cycle():
    """Two loops of 2 and 3 with a dip of 1 between them make 4, not 3 and not the sum of gains."""
    loops = polyline([0, 1, 1, 2, 2, 3, 3, 5], [2, 2, -1, -1, 3, 3, -2, -2])
    found = surplus(loops)
    assert found == (pytest.approx(4), pytest.approx(0), pytest.approx(3))
    assert loops.integral == pytest.approx(0, abs=1e-15)


# ---------------------------------------------------------------- speed
@pytest.mark.parametrize("inertia", [50.0, 4.0, 0.95, 0.7])
@pytest.mark.stress
def test_exact_fluctuation_of_a_constant_inertia(inertia):
    """From 0.015 to 1.3; the extremes are where 300 sin x + 200 cos 2x = 0."""
    with mp.workdps(30):
        sine = (3 - mp.sqrt(41)) / 8
        still = [mp.pi - mp.asin(sine), 2 * mp.pi + mp.asin(sine)]
        parts = [mp.mpf(0), 1, 2, still[0], 4, 5, still[1], 2 * mp.pi]

        def speed(constant, angle):
            return mp.sqrt((constant + 2 * work(angle)) / inertia)

        def excess(constant):
            return mp.quad(lambda a: speed(constant, a), parts) / (2 * mp.pi) - MEAN

        found = speed_variation(TORQUE, steady(inertia), MEAN)
        guess = inertia * mp.mpf(found.highest.value) ** 2 - 2 * work(still[0])
        constant = mp.findroot(excess, (guess, guess * (1 + mp.mpf("1e-9"))))
        highest, lowest = (float(speed(constant, a)) for a in still)
    assert found.fluctuation == pytest.approx((highest - lowest) / MEAN, rel=1e-11)
    assert found.highest == pytest.approx((float(still[0]), highest), rel=1e-10)
    assert found.lowest == pytest.approx((float(still[1]), lowest), rel=1e-8)
    assert found.speed.mean == pytest.approx(MEAN, rel=1e-13)


# ---------------------------------------------------------------- flywheels
@pytest.mark.parametrize("fluctuation", [1e-4, 0.005, 0.2, 0.9])
def test_the_needed_inertia_has_the_fluctuation(fluctuation):
    inertia = needed_inertia(TORQUE, MEAN, fluctuation)
    found = speed_variation(TORQUE, steady(inertia), MEAN).fluctuation
    assert found == pytest.approx(fluctuation, rel=1e-10)


def test_moving_parts_that_do_better_alone():
    more = needed_inertia(TORQUE, MEAN, 0.1, steady(50.0))
    assert 0 > more == pytest.approx(needed_inertia(TORQUE, MEAN, 0.1) - 50, rel=1e-10)
    assert needed_inertia(polyline([0, TURN], [9.0, 9.0]), MEAN, 0.1, steady(2.0)) == pytest.approx(-2)


@pytest.mark.parametrize("fluctuation", [1.75, *slow(1.6, 1.9, 2.0, 5.0)])
def test_a_fluctuation_beyond_the_stall_needs_what_does_not_stall(fluctuation):
    inertia = needed_inertia(TORQUE, MEAN, fluctuation)
    assert speed_variation(TORQUE, steady(inertia), MEAN).fluctuation < fluctuation
    with pytest.raises(StallError):
        speed_variation(TORQUE, steady(inertia * (1 - 1e-9)), MEAN)


def test_a_shaft_stalls_where_it_is_slowest():
    with pytest.raises(StallError) as stalled:
        speed_variation(TORQUE, steady(0.5), MEAN)
    assert str(stalled.value) == "the shaft stalls at 334.8°: with this inertia it needs a mean speed above 327.7 rpm"
    barely = float(str(stalled.value).split()[-2]) * (1 + 2e-4) * np.pi / 30  # printed with 4 digits
    assert speed_variation(TORQUE, steady(0.5), barely).lowest.value < 0.02 * barely


def test_of_an_inertia_that_nearly_vanishes_rounding_errors_are_not_resolved():
    """I = a + sin^2 and no torque: the mean of I^-1/2 is 1 over the arithmetic-geometric mean of
    its extremes. As it is written here, its rounding errors are a thousand times those of its
    least value, which half a million panels do not resolve.
    """
    a = 1e-6
    free = resolved(lambda angle: 0 * angle, [0, TURN])
    found = speed_variation(free, lambda angle: (2 + a - np.cos(angle) ** 2) - 1, MEAN)
    low = np.sqrt(a)
    high = np.sqrt(1 + a)
    exact = float(mp.agm(low, high)) * (1 / low - 1 / high)
    assert found.fluctuation == pytest.approx(exact, rel=1e-6)
    assert len(found.speed.breaks) < 20_000
