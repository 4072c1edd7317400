"""What devices in their slots do, and the least squares that sizes them."""

import cmath

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support.engines import build_text
from support.remedies import write_engine

from balcli.errors import BalcliError
from balcli.sizing.fitting import Slot, find_effect, size_unbalances, solve_exactly
from balcli.sizing.remedy import Remedy, fit_devices
from balcli.sizing.residual import ReferencePoint, Residual, ResidualPart, find_residual

FORCE = ResidualPart("force", 1)
MOMENT = ResidualPart("moment", 1)
BACK = ResidualPart("force", -1)
ROLL = ResidualPart("roll", 0)
VECTOR = st.complex_numbers(min_magnitude=1e-3, max_magnitude=1e3, allow_nan=False, allow_infinity=False)


def residual(noise: float = 1e-16, **parts: complex) -> Residual:
    """Parts by name: forward, backward, moment, roll."""
    names = {"forward": FORCE, "backward": BACK, "moment": MOMENT, "roll": ROLL}
    found = {names[name]: value for name, value in parts.items()}
    return Residual(2, found, dict.fromkeys(found, noise), ReferencePoint(0j, 0.0), 1.0)


def find_total(slots: list[Slot], unbalances: tuple[complex, ...], parts: tuple[ResidualPart, ...]) -> np.ndarray:
    """Effect of all devices on each part, about a point of reference on the crank axis."""
    devices = [slot.make_device(u) for slot, u in zip(slots, unbalances, strict=True)]
    return sum(find_effect(device, parts, ReferencePoint(0j, 0.0)) for device in devices)


@given(VECTOR, VECTOR)
def test_two_planes_take_any_force_and_moment(force, moment):
    slots = [Slot("shaft", 2, 1, z) for z in (-0.3, 0.2)]
    fit = size_unbalances(slots, residual(forward=force, moment=moment), (FORCE, MOMENT))
    total = find_total(slots, fit.unbalances, (FORCE, MOMENT))
    assert total == pytest.approx([-force, -moment], rel=1e-13, abs=1e-13 * (abs(force) + abs(moment)))


@given(VECTOR, VECTOR)
def test_sliders_in_two_directions_take_any_ellipse(forward, backward):
    slots = [Slot("slider", 2, 0, 0.0, 0j, direction) for direction in (20, 75)]
    fit = size_unbalances(slots, residual(forward=forward, backward=backward), (FORCE, BACK))
    assert fit.left <= 1e-14


def test_a_force_and_a_roll_by_shafts_at_three_places():
    """The roll couples both senses; with a shaft to spare it is cancelled together with the force."""
    slots = [Slot("shaft", 2, sense, 0.0, place) for sense, place in ((1, 0.1 + 0j), (-1, -0.1 + 0.05j), (1, -0.2j))]
    parts = (FORCE, BACK, ROLL)
    asked = residual(forward=1 + 2j, backward=0.5 - 1j, roll=0.3 + 0.1j)
    fit = size_unbalances(slots, asked, parts)
    total = find_total(slots, fit.unbalances, parts)
    assert total == pytest.approx([-asked.parts[p] for p in parts], rel=1e-13)


@pytest.mark.parametrize(
    "slot",
    [
        Slot("slider", 2, 0, 0.07, 0.03 - 0.02j, 33),
        Slot("shaft", 2, 1, 0.07, 0.03 - 0.02j),
        Slot("shaft", 2, -1, -0.04, -0.01 + 0.05j),
    ],
)
def test_effect_is_what_the_analysis_says(slot):
    """Moments and roll about a point that is neither on the crank axis nor in the middle of the throws."""
    engine = build_text(write_engine(0, 180, 180, 0, frame="reference = [40, -25, 130]"))
    reference = ReferencePoint(complex(*engine.reference_m[:2]), float(engine.reference_m[2]))
    u = cmath.rect(2e-3, 0.4)
    table = slot.make_table(u, 0.0)
    with_it = fit_devices(engine, Remedy("", devices=(table,)))
    parts = [ResidualPart(q, s) for q in ("force", "moment") for s in (1, -1)] + [ROLL]
    before = find_residual(engine, 2)
    after = find_residual(with_it, 2)
    change = np.array([after.parts[p] - before.parts[p] for p in parts])
    assert change == pytest.approx(find_effect(slot.make_device(u), parts, reference), abs=1e-14)


@pytest.mark.parametrize("force", [3.7, -3.7, 0.3j, -0.3j])
def test_what_is_not_needed_is_exactly_nothing(force):
    """A force in one of the two planes; its part that is 0 stays 0, so that angles are plain."""
    slots = [Slot("counterweight", 1, 1, z) for z in (-0.13, 0.29)]
    fit = solve_exactly(slots, residual(forward=force, moment=-0.13 * force), (FORCE, MOMENT), "")
    assert fit.unbalances == (pytest.approx(-force, rel=1e-14), 0)
    assert 0 in (fit.unbalances[0].real, fit.unbalances[0].imag)


@pytest.mark.parametrize("scale", [1e-9, 1, 1e9])
def test_one_slot_does_what_it_can(scale):
    """Least squares of force and of moment over the arm: u = -(f + m/z)/2 at z."""
    asked = residual(noise=1e-16 * scale, forward=scale, moment=0.6 * scale)
    fit = size_unbalances([Slot("counterweight", 1, 1, 0.2)], asked, (FORCE, MOMENT))
    assert fit.unbalances == pytest.approx([-(1 + 0.6 / 0.2) / 2 * scale])
    assert fit.left == pytest.approx(1 / 5**0.5)  # (f - m/z)/sqrt 2 of |f, m/z|, f = 1, m/z = 3
    with pytest.raises(BalcliError, match="the reason"):
        solve_exactly([Slot("counterweight", 1, 1, 0.2)] * 2, asked, (FORCE, MOMENT), "the reason")


def test_arms_count_from_the_point_of_reference_in_all_directions():
    """A slot beside the crank on that point's own axis has no arm but along it: u = -(f + m/z)/2 at z from there."""
    asked = residual(forward=1, moment=0.6)._replace(reference=ReferencePoint(0.3 + 0.4j, 0.1))
    fit = size_unbalances([Slot("shaft", 2, 1, 0.3, 0.3 + 0.4j)], asked, (FORCE, MOMENT))
    assert fit.unbalances == pytest.approx([-(1 + 0.6 / 0.2) / 2])
