"""Torque over the cycle and the speed it makes uneven: identities on engines drawn at random, and a
step-by-step integration of the equation of motion.
"""

from itertools import pairwise, product

import numpy as np
import pytest
from support.engines import build_text
from support.gas_engines import FOUR, WIEBE, draw_engine

from balcli import load
from balcli.core.shaft_speed import speed_variation
from balcli.crank_torque.answer import torque
from balcli.errors import BalcliError
from balcli.forces.curves import (
    find_inertia_torque,
    find_moving_inertia,
    find_torque_curves,
    silence,
)
from balcli.forces.spectrum import compute_spectra

HALVES = np.arange(25)
FLYWHEEL = "[flywheel]\ninertia = {}\n"


def on_crank(inertia_kg_mm2: float, seed: int):
    return draw_engine(seed, more=FLYWHEEL.format(inertia_kg_mm2))


@pytest.mark.parametrize("seed", range(4))
def test_the_curve_has_the_harmonics_of_the_orders(seed):
    """Two ways: the curve is added up at angles, the orders by phases."""
    found = draw_engine(seed)
    total = find_torque_curves(found).total
    orders = HALVES / 2
    phasors = compute_spectra(found, orders, ["torque_total"])["torque_total"]
    want = phasors.forward + np.conj(phasors.backward)
    assert total.harmonics(np.arange(25)) == pytest.approx(want, abs=1e-12 * np.abs(want).max())


@pytest.mark.parametrize("seed", range(3))
def test_mean_torque_and_pressure(seed):
    found = torque(draw_engine(seed), [0.5, 1], cylinder=1)
    gas = found.engine.gas
    one = gas.cylinders[found.engine.numbers.index(1)]
    shown = [order.one_cylinder.gas_torque_Nm.amplitude for order in found.orders]
    assert shown == pytest.approx(one.share * np.abs(one.torque.harmonics([1, 2])), rel=1e-12)
    swept = sum(c.piston.swept for c in gas.cylinders)
    work = sum(c.share * c.torque.imep * c.piston.swept for c in gas.cylinders)
    assert found.imep_Pa == pytest.approx(work / swept, rel=1e-12)
    assert found.mean_torque_Nm * gas.cycle == pytest.approx(work, rel=1e-12)
    assert found.energy.work_J == pytest.approx(work, rel=1e-12)
    assert found.power_W == pytest.approx(found.mean_torque_Nm * found.speed_rpm * np.pi / 30)


def test_gas_without_work_has_no_mean_torque(tmp_path):
    """A table without order 0: what the panels leave of the mean is rounding."""
    (tmp_path / "h.csv").write_text("order,cos,sin\n1,3,9\n2,5,6\n3.5,5,3\n")
    (tmp_path / "four.toml").write_text(FOUR + '[gas]\nharmonics = "h.csv"\n')
    found = torque(silence(load(tmp_path / "four.toml"), 3))
    assert found.torque.max_Nm > 100
    assert (found.mean_torque_Nm, found.power_W, found.energy.work_J) == (0, 0, 0)


def test_a_misfire_takes_a_quarter_of_the_work():
    four = build_text(FOUR + WIEBE)
    missing = torque(silence(four, 3))
    assert missing.imep_Pa == pytest.approx(0.75 * torque(four).imep_Pa, rel=1e-13)
    written = torque(build_text(FOUR + WIEBE + "[cylinder.3]\ngas = 0\n"))
    assert written.torque == missing.torque
    with pytest.raises(BalcliError, match=r"^there is no cylinder 5: the engine has cylinders 1 to 4"):
        silence(four, 5)


@pytest.mark.parametrize("strokes", [2, 4])
def test_inertia_that_cancels_makes_no_torque(strokes):
    """Twenty-four cylinders: what is left of orders 24 (two strokes) and 12 is nothing or little, and does no work."""
    throws = [15 * strokes // 2 * k % 360 for k in range(24)]
    order = ", ".join(map(str, [1, *range(24, 1, -1)]))
    text = FOUR.replace("throws = [0, 180, 180, 0]", f"throws = {throws}")
    text = text.replace("firing_order = [1, 3, 4, 2]", f"firing_order = [{order}]")
    engine = build_text(text.replace("[layout]", f"[layout]\nstrokes = {strokes}") + WIEBE)
    for number in engine.numbers:
        engine = silence(engine, number)
    found = torque(engine)
    lowest = found.torque.min_Nm
    highest = found.torque.max_Nm
    assert found.energy.work_J == 0
    if strokes == 2:
        assert (lowest, highest, found.energy.surplus_J) == (0, 0, 0)
    else:
        want = compute_spectra(engine, np.array([12.0]), ["torque"])["torque"].major[0]
        assert 0 < want == pytest.approx(highest, rel=1e-4)


# ------------------------------------------------------------------ speed
def speed_by_steps(found, first: float, steps: int = 24):
    """Speed at the breaks of the gas torque, by classical Runge-Kutta steps of
    `I omega omega' + 1/2 I' omega^2 = T - mean`, from the speed at angle 0; I' by differences.
    """
    torque = find_torque_curves(found).gas
    moving = find_moving_inertia(found)
    still = found.flywheel_inertia
    breaks = torque.breaks
    angle = []
    end = []
    for low, high in pairwise(breaks):
        width = (high - low) / steps
        angle += [low + k * width / 2 for k in range(2 * steps)]
        end.append(len(angle))
    angle = np.array([*angle, breaks[-1]])
    inside = torque.at(angle) - torque.mean
    before = torque.at(angle - 1e-10) - torque.mean
    inertia = still + moving(angle)
    shift = 2e-3
    weights = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
    slope = sum(w * (moving(angle + k * shift) - moving(angle - k * shift)) for k, w in weights.items())
    slope = slope / shift

    def rate(k, omega, values):
        return (values[k] - 0.5 * slope[k] * omega**2) / (inertia[k] * omega)

    omega = first
    speeds = [first]
    for k in range(0, len(angle) - 1, 2):
        h = angle[k + 2] - angle[k]
        a = rate(k, omega, inside)
        b = rate(k + 1, omega + h / 2 * a, inside)
        c = rate(k + 1, omega + h / 2 * b, inside)
        d = rate(k + 2, omega + h * c, before)
        omega += h / 6 * (a + 2 * b + 2 * c + d)
        if k + 2 in end:
            speeds.append(omega)
    return breaks, np.array([*speeds, omega])[: len(breaks)]


@pytest.mark.parametrize("seed", [0, 5])
def test_the_speed_against_steps_in_time(seed):
    found = on_crank(150000, seed)
    parts = find_moving_inertia(found)
    still = found.flywheel_inertia
    gas = find_torque_curves(found).gas
    exact = speed_variation(gas, lambda angle: still + parts(angle), float(found.omega))
    breaks, speeds = speed_by_steps(found, float(exact.speed.at(gas.breaks[0])))
    assert speeds == pytest.approx(exact.speed.at(breaks), rel=2e-9)
    assert exact.speed.mean == pytest.approx(found.omega, rel=1e-12)
    told = torque(found).flywheel
    assert told.fluctuation == pytest.approx(exact.fluctuation, rel=1e-9)


def test_fluctuation_and_needed_inertia():
    """With a heavy flywheel the rule for small fluctuations is exact; the needed inertia keeps the fluctuation."""
    for seed, (inertia, agreement) in product(range(3), ((1e8, 1e-2), (1e11, 1e-5))):
        speed = torque(on_crank(inertia, seed)).flywheel
        assert speed.fluctuation == pytest.approx(speed.fluctuation_small, rel=agreement)
    found = torque(on_crank(3e5, 2), fluctuation=0.01).flywheel
    needed = (found.needed_kg_m2 - found.moving_parts_kg_m2) * 1e6
    again = torque(on_crank(needed, 2)).flywheel
    assert again.fluctuation == pytest.approx(0.01, rel=1e-9)
    assert again.inertia_kg_m2 == pytest.approx(found.needed_kg_m2, rel=1e-12)


def test_lines_of_the_speed_add_up_to_it():
    found = torque(on_crank(2e5, 4))
    speed = found.flywheel
    theta = np.radians(found.flywheel.speed_max_deg)
    lines = sum(line.amplitude * np.cos(line.order * theta - np.radians(line.angle_deg)) for line in speed.lines)
    share = speed.speed_max_rpm / found.speed_rpm - 1
    assert lines == pytest.approx(share, rel=2e-3)


def test_inertia_of_the_crank():
    """Throw masses are counted once; neither the throws nor the own inertia of a rotary engine's crank turn."""
    text = FOUR.replace("spacing = 100", "spacing = 100\nthrow_mass = 0.5")
    without = find_moving_inertia(build_text(text))(np.array([0.3]))
    given = text.replace("spacing = 100", "spacing = 100\ninertia = 9000")
    assert without - find_moving_inertia(build_text(given))(np.array([0.3])) == pytest.approx(4 * 0.5 * 0.045**2)
    rotary = FOUR.replace("throws = [0, 180, 180, 0]", "throw_mass = 0.5").replace(
        "firing_order = [1, 3, 4, 2]", "radial = 3\nrotary = true\nstrokes = 2"
    )
    rotary += WIEBE + FLYWHEEL.format(1e5)
    more = rotary.replace("throw_mass = 0.5", "throw_mass = 0.5\ninertia = 90000")
    plain = build_text(rotary)
    given = build_text(more)
    angle = np.linspace(0, 6, 7)
    assert find_moving_inertia(given)(angle) == pytest.approx(find_moving_inertia(plain)(angle))
    assert given.find_constant_inertia() == plain.find_constant_inertia() == pytest.approx(0.1)


def test_the_inertia_torque_is_half_the_slope_of_the_inertia():
    """-1/2 I' omega^2, by differences."""
    found = draw_engine(3)
    angle = np.linspace(0, 6, 7)
    shift = 1e-4
    moving = find_moving_inertia(found)
    slope = (moving(angle + shift) - moving(angle - shift)) / (2 * shift)
    want = -0.5 * slope * float(found.omega) ** 2
    assert find_inertia_torque(found)(angle) == pytest.approx(want, abs=1e-6 * np.abs(want).max())
