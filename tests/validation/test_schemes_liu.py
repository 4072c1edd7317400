"""Liu Xianzhi 1979: balance of the second-order force of flat-plane V8 engines with two shafts, one
shaft, or two sliders.

K = 4 A2 m r omega^2. Misprints of the source that are corrected here: (4.2) prints the inverse of
b1/b2; (5.6) has a factor 4 too many; (5.5) and the first line of 6.1 print Z_x with the opposite
sign. A2 stands for the source's lambda, its leading term.
"""

import cmath
import math

import pytest
from support.engines import build_text, engine_text
from support.remedies import fit_scheme, size_scheme

from balcli.core.mechanisms import closed_form
from balcli.engine.engine import Engine
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.remedy import fit_devices

K = 4 * float(closed_form.piston([2], 0.25)[0]) * 1.0 * 0.05  # per omega^2 (kg m): A2 m r, four cylinders in a row
EVERY_ANGLE = [0, 15, 30, 45, 59, 60, 61, 75, 90, 105, 120, 135, 150, 165, 179, 180]


def flat_plane(gamma: float) -> Engine:
    return build_text(
        engine_text(
            crank="stroke = 100\nthrows = [0, 180, 180, 0]\nspacing = 100\nthrow_mass = 1",
            layout=f"bank_angle = {gamma}",
        )
    )


def unbalances(engine: Engine, **options: object) -> dict[int, complex]:
    """Sum of the unbalances (kg m) at each ratio."""
    found: dict[int, complex] = {}
    for s in size_scheme(engine, "two-shaft", order=2, **options).shafts:
        found[s.ratio] = found.get(s.ratio, 0j) + cmath.rect(s.unbalance / 1e6, math.radians(s.angle))
    return found


@pytest.mark.parametrize("gamma", EVERY_ANGLE)
def test_shafts_cancel_both_rotating_vectors_at_every_bank_angle(gamma):
    engine = flat_plane(gamma)
    half = math.radians(gamma / 2)
    found = unbalances(engine)
    assert abs(found.get(2, 0j)) * 4 == pytest.approx(K * abs(math.cos(half)), abs=1e-11 * K)  # (2 omega)^2 = 4 omega^2
    assert abs(found.get(-2, 0j)) * 4 == pytest.approx(K * abs(math.cos(3 * half)), abs=1e-11 * K)
    after = compute_spectra(fit_scheme(engine, "two-shaft", order=2), [2], ("force", "moment"))
    assert after.force.balanced.all()
    assert after.moment.balanced.all()


@pytest.mark.parametrize("gamma", [g for g in EVERY_ANGLE if g not in (60, 180)])
def test_places_that_add_no_roll(gamma):
    engine = flat_plane(gamma)
    half = math.radians(gamma / 2)
    remedy = size_scheme(engine, "two-shaft", order=2, at=(0.06 + 0.08j,))
    place = {s.ratio: complex(*s.at) for s in remedy.shafts}
    ratio = abs(place[2]) / abs(place[-2])
    assert ratio == pytest.approx(abs(math.cos(3 * half)) / math.cos(half), rel=1e-11)  # (4.2), corrected
    between = (cmath.phase(place[2]) + cmath.phase(place[-2])) / math.pi  # beta1 + beta2 = k pi from its x axis
    assert between == pytest.approx(round(between), abs=1e-12)  # (4.1); his x is our y: k odd and even swap
    rolls = [compute_spectra(e, [2], ("roll",)).roll.forward[0] for e in (engine, fit_devices(engine, remedy))]
    assert abs(rolls[1] - rolls[0]) <= 1e-11 * K * engine.omega**2 * 0.1


def test_sixty_degrees_needs_one_shaft_on_the_crank_axis_or_two_halves():
    engine = flat_plane(60)
    (one,) = size_scheme(engine, "two-shaft", order=2).shafts
    assert (one.ratio, one.at) == (2, (0.0, 0.0))
    assert 4 * one.unbalance / 1e6 == pytest.approx(2 * math.sqrt(3) * K / 4, rel=1e-11)  # 2 sqrt3 A2 m r omega^2
    halves = size_scheme(engine, "two-shaft", order=2, at=(0.03 + 0.04j,)).shafts
    assert sorted(h.at for h in halves) == [(-30.0, -40.0), (30.0, 40.0)]
    assert [h.unbalance for h in halves] == pytest.approx([one.unbalance / 2] * 2, rel=1e-11)


@pytest.mark.parametrize("gamma", EVERY_ANGLE)
def test_sliders(gamma):
    """Corrected (5.6): m_z r_z = A2 m r |Z|max of either direction, the pins turning at 2 omega."""
    half = math.radians(gamma / 2)
    wanted = sorted(K / 4 * abs(math.cos(3 * half) + sign * math.cos(half)) for sign in (1, -1))
    found = {s.direction: s.unbalance / 1e6 for s in size_scheme(flat_plane(gamma), "slider", order=2).sliders}
    sizes = sorted([0.0] * (2 - len(found)) + list(found.values()))
    assert sizes == pytest.approx(wanted, abs=1e-11 * K)
    assert set(found) <= {0.0, 90.0, -90.0}
    if gamma == 90:
        assert set(found) <= {90.0, -90.0}  # m_zv = 0
    if gamma == 180:
        assert not found


def test_largest_horizontal_slider():
    """|Z_x|max = 8/(3 sqrt3) at gamma = 2 arctan sqrt2."""
    gamma = math.degrees(2 * math.atan(math.sqrt(2)))
    largest, *others = (
        max(s.unbalance for s in size_scheme(flat_plane(g), "slider", order=2).sliders) / 1e6
        for g in (gamma, gamma - 1, gamma + 1)
    )
    assert largest == pytest.approx(K / 4 * 8 / (3 * math.sqrt(3)), rel=1e-14)
    assert max(others) < largest
