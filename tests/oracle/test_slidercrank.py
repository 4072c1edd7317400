"""The closed forms against mpmath with 50 digits, where every difference is taken as it stands."""

from functools import cache

import mpmath as mp
import numpy as np
import pytest
from support import two_term

from balcli.core.mechanisms import slidercrank as sc

RELATIVE = 1e-14
LAMBDAS = [1e-12, 1e-6, 0.01, 0.2, 0.2632, 0.3, 1 / 3, 0.5, 0.75, 0.9, 0.99, 0.999]
TINY = [1e-150, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 0.01]
NEAR = np.concatenate([TINY, -np.array(TINY)])
ANGLES = np.concatenate([np.radians(np.arange(-180.0, 541.0, 7.5)), NEAR, np.pi + NEAR, np.pi / 2 + NEAR])
NAMES = ["displacement", "velocity", "acceleration", "spin", "spin_rate"]
OFFSETS = [(0.28, 0.01), (0.3, -0.05), (0.5, 0.3), (0.25, 0.74)]


@pytest.fixture(autouse=True)
def digits():
    with mp.workdps(50):
        yield


@cache
def turn(psi, lam, eps):
    """Crank angle, ratios, and sine and cosine of the rod's angle, each exactly that of the floating-point arguments."""
    psi, lam, eps = (mp.mpf(float(value)) for value in (psi, lam, eps))
    sine = lam * mp.sin(psi) - eps
    return psi, lam, eps, sine, mp.sqrt(1 - sine**2)


def oracle(name, psi, lam, eps=0.0):
    """The textbook form, with 50 digits, and with 400 where the piston hardly moves."""
    with mp.workdps(400 if abs(psi) < 1e-20 else 50):
        psi, lam, eps, sine, cosine = turn(psi, lam, eps)
        rate = lam * mp.cos(psi) / cosine
        return {
            "displacement": lambda: mp.sqrt((1 + 1 / lam) ** 2 - (eps / lam) ** 2) - mp.cos(psi) - cosine / lam,
            "velocity": lambda: mp.sin(psi) + mp.cos(psi) * sine / cosine,
            "acceleration": lambda: mp.cos(psi) - mp.sin(psi) * sine / cosine + lam * mp.cos(psi) ** 2 / cosine**3,
            "spin": lambda: -rate,
            "spin_rate": lambda: lam * mp.sin(psi) / cosine - rate**2 * sine / cosine,
        }[name]()


def find_course(name, psi, lam, eps=0.0):
    """Motion of the piston as the module has it, or of the rod as its record has it."""
    return getattr(sc.SliderCrank(psi, lam, eps), name) if "spin" in name else getattr(sc, name)(psi, lam, eps)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("lam", LAMBDAS)
def test_centred_is_accurate_relative_to_the_largest_value(name, lam):
    want = [oracle(name, psi, lam) for psi in ANGLES]
    largest = max(abs(value) for value in want)
    for psi, got, value in zip(ANGLES, find_course(name, ANGLES, lam), want, strict=True):
        assert abs(mp.mpf(float(got)) - value) <= RELATIVE * largest, (psi, got)


@pytest.mark.parametrize("lam", LAMBDAS)
def test_centred_travel_is_accurate_however_near_to_the_top(lam):
    for psi, got in zip(NEAR, sc.displacement(NEAR, lam), strict=True):
        want = oracle("displacement", psi, lam)
        assert abs(mp.mpf(float(got)) - want) <= RELATIVE * abs(want), (psi, got)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("lam", "eps"), OFFSETS)
def test_offset(name, lam, eps):
    psi = np.radians(np.arange(0.0, 360.0, 7.5))
    for angle, got in zip(psi, find_course(name, psi, lam, eps), strict=True):
        want = oracle(name, angle, lam, eps)
        assert abs(mp.mpf(float(got)) - want) <= 1e-15 * (1 + abs(want)) * 10, (angle, got)


@pytest.mark.parametrize(("lam", "eps"), OFFSETS)
@pytest.mark.parametrize("delta", [1e-3, 1e-2])
def test_offset_travel_near_its_own_top_dead_centre(lam, eps, delta):
    """tau itself is good to an ulp, so the travel, which grows as (psi - tau)^2, is good to 2 ulp / delta."""
    tau = np.arcsin(eps / (1 + lam))
    got = sc.displacement(tau + delta, lam, eps)
    want = oracle("displacement", tau + delta, lam, eps)
    assert abs(mp.mpf(float(got)) - want) <= 1e-15 / delta * want


@pytest.mark.parametrize("lam", [0.01, 0.1, 0.3, 0.45, 0.7])
@pytest.mark.parametrize("clearance", [1e-12, 1e-9, 1e-4])
@pytest.mark.parametrize("side", [1, -1])
def test_the_rod_is_accurate_however_near_to_its_lock(lam, clearance, side):
    """At 90 degrees, where it lies almost across: its cosine is the root of what is left of 1 - lambda - |eps|."""
    eps = side * (1 - lam - clearance)
    sine, cosine = sc.rod_angle(-side * 1j, lam, eps)
    exact = -side * mp.mpf(lam) - mp.mpf(eps)
    assert abs(cosine / mp.sqrt((1 - exact) * (1 + exact)) - 1) < RELATIVE
    assert abs(sine - exact) < RELATIVE


@pytest.mark.parametrize("what", NAMES[1:])
@pytest.mark.parametrize("cosine", [1.0, -1.0])
def test_the_sign_of_a_zero_means_nothing(what, cosine):
    for eps in (-0.05, 0.05):
        below, above = (find_course(what, np.array(complex(cosine, zero)), 0.3, eps) for zero in (-0.0, 0.0))
        assert below == above


@pytest.mark.parametrize(("form", "find"), [(sc, sc.fastest), (two_term, sc.fastest_two_term)], ids=["exact", "two"])
@pytest.mark.parametrize("lam", [1e-6, 0.1, 0.25, 1 / 3, 0.6, 0.9, 0.99])
def test_the_fastest_point(lam, form, find):
    psi, value = find(lam)
    assert abs(form.acceleration(psi, lam)) < 1e-14
    assert value == pytest.approx(form.velocity(psi, lam), rel=1e-14)
    assert value == pytest.approx(form.velocity(np.linspace(0, np.pi, 20001), lam).max(), rel=1e-6)
