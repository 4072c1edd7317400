"""Pistons, measured diagrams and gas torque: against geometry, closed forms and 50 digits."""

from functools import partial

import mpmath as mp
import numpy as np
import pytest
from oracle import gas
from support.paths import ENGINES
from support.pistons import slider_crank_piston

from balcli import load
from balcli.core.cylinder_pressure import crank_torque, find_highest, pistons, press
from balcli.core.gas_cycle import Goal, Process, gas_cycle
from balcli.core.mechanisms.harmonics import find_harmonics
from balcli.core.piecewise import PiecewiseCurve, polyline
from balcli.engine.indicator import draw_diagram, find_diagram_mistakes

OF_THE_LARGEST = 1e-12
HALVES = np.arange(49)
LENGTHS = 0.045, 0.15, 0.086  # radius, rod, bore


# ---------------------------------------------------------------- pistons
@pytest.mark.parametrize("offset", [0.0, 0.02, -0.05])
def test_an_offset_mechanism_has_its_own_dead_centres(offset):
    piston = slider_crank_piston(*LENGTHS, offset)
    with mp.workdps(30):
        exact = gas.Mechanism(*(mp.mpf(length) for length in (*LENGTHS, offset)))
        assert piston.top == pytest.approx(float(exact.top), abs=1e-15)
        assert piston.bottom == pytest.approx(float(exact.bottom), abs=1e-15)
        assert piston.swept == pytest.approx(float(exact.swept), rel=1e-14)
        for angle in (0.1, 1.0, 3.0, 5.0, 7.0, -2.0):
            at = np.array(angle)
            assert float(piston.travel(at)) == pytest.approx(float(exact.travel(angle)), rel=1e-13)
            assert float(piston.rate(at)) == pytest.approx(float(exact.rate(angle)), rel=1e-12)
            volume = float(exact.volume(mp.mpf(angle), 9))
            assert float(piston.volume(at, 9.0)) == pytest.approx(volume, rel=1e-14)
    assert piston.clearance(9.0) == pytest.approx(piston.swept / 8, rel=1e-15)


@pytest.mark.parametrize("offset", [0.0, 0.03])
def test_the_angle_of_a_travel(offset):
    piston = slider_crank_piston(*LENGTHS, offset)
    for travel in np.linspace(0, piston.stroke, 7):
        down = piston.angle_of(travel)
        up = piston.angle_of(travel, upward=True)
        assert 0 <= down <= piston.bottom <= up <= 2 * np.pi
        assert piston.travel(np.array([down, up])) == pytest.approx([travel, travel], abs=1e-16)


def hung_on_a_master_rod(psi, lead, crank=60.0, rod=240.0, knuckle=52.0, slave=188.0):
    """Pin path (mm) of a cylinder `lead` deg after its master, at its own crank angles psi."""
    pin = crank * np.exp(1j * (psi + np.radians(lead)))  # in the master's frame
    foot = pin.real + np.sqrt(rod**2 - pin.imag**2)
    knuckle_pin = pin + knuckle * np.exp(1j * np.radians(lead)) * (foot - pin) / rod
    seen = knuckle_pin * np.exp(-1j * np.radians(lead))
    return seen.real + np.sqrt(slave**2 - seen.imag**2)


def test_pistons_of_a_radial_with_a_master_rod():
    found = pistons(load(ENGINES / "radial7_articulated.toml").cylinders, 0.01)
    angle = np.linspace(0, 2 * np.pi, 721)
    strokes = []
    for row, piston in enumerate(found):
        place = partial(hung_on_a_master_rod, lead=row * 360 / 7, **({} if row else {"knuckle": 0.0, "slave": 240.0}))
        top = place(np.array(piston.top))
        expected = (top - place(angle + piston.top)) / 1e3
        np.testing.assert_allclose(piston.travel(angle), expected, rtol=0, atol=1e-15)
        assert piston.stroke == pytest.approx(expected.max(), rel=1e-5)
        at = np.array([0.0, piston.bottom])
        assert piston.travel(at) == pytest.approx([0, piston.stroke], abs=1e-15)
        assert piston.rate(at) == pytest.approx([0, 0], abs=1e-15)
        strokes.append(piston.stroke)
    assert np.ptp(strokes) > 4e-4


# ---------------------------------------------------------------- gas torque
@pytest.mark.parametrize("offset", [0.0, 0.03])
def test_a_constant_pressure_has_the_harmonics_of_the_piston(offset):
    """-s''/r is Re sum c_n e^{i n psi}, so -s' is r Re sum c_n/(i n) e^{i n psi}."""
    radius, rod, bore = LENGTHS
    piston = slider_crank_piston(*LENGTHS, offset)
    cycle = np.array([0, 4 * np.pi])
    found = press(piston, polyline(cycle, [7e5, 7e5]), cycle).harmonics(HALVES)
    n = np.arange(1, 25)
    mechanism = find_harmonics(n, np.array([radius / rod]), np.array([offset / rod]))
    turned = mechanism["piston"].c[:, 0] / (1j * n) * np.exp(1j * n * piston.top)
    expected = 6e5 * np.pi / 4 * bore**2 * radius * turned
    assert np.abs(found[2::2] - expected).max() <= OF_THE_LARGEST * np.abs(expected).max()
    assert np.abs(found[1::2]).max() <= OF_THE_LARGEST * np.abs(expected).max()


CYCLE = gas_cycle(slider_crank_piston(*LENGTHS), Process(10.5, "wiebe"), Goal("imep", 10e5))
TORQUE = press(slider_crank_piston(*LENGTHS), CYCLE.pressure, CYCLE.breaks)


@pytest.mark.parametrize("fires", [0.3, 5.0, -2.0, 30.0])
def test_a_cylinder_that_fires_later_has_its_harmonics_turned_back(fires):
    found = crank_torque([(TORQUE, fires, 1.0)], TORQUE.curve.period).harmonics(np.arange(49))
    expected = TORQUE.harmonics(HALVES) * np.exp(-0.5j * HALVES * fires)
    assert np.abs(found - expected).max() <= OF_THE_LARGEST * np.abs(expected).max()


def test_force_and_torque_of_both_sides_of_a_jump():
    opens = np.radians(360.0)
    area = TORQUE.piston.area
    assert TORQUE.force_under(CYCLE.pressure.at(opens - 1e-9)) == pytest.approx(0.05e5 * area, rel=1e-9)
    assert TORQUE.force_under(CYCLE.pressure.at(opens)) == pytest.approx(0, abs=1e-9)
    angle = np.radians([20.0, 90.0, 450.0])
    lean = np.arcsin(0.3 * np.sin(angle))
    tangential = np.sin(angle + lean) / np.cos(lean) * 0.045
    force = TORQUE.force_under(CYCLE.pressure.at(angle))
    assert TORQUE.curve.at(angle) == pytest.approx(force * tangential, rel=1e-11)


def test_the_highest_pressure_beside_a_corner_is_at_the_corner():
    peak = PiecewiseCurve(np.array([-np.pi, 0.0, np.pi]), np.array([[0.0, 1], [1, -1], [0, 0]]) * 1e5)
    assert find_highest(peak) == (0.0, 2e5)


# ---------------------------------------------------------------- measured diagrams
ROWS = np.array([-180, -90, -40, -12, 0, 7, 15, 40, 90, 130, 165, 200, 300, 359, 420, 500])
BAR = np.array([1.1, 1.9, 6.4, 22.7, 34.9, 51.3, 47.0, 20.2, 6.1, 3.9, 2.2, 1.3, 1.1, 1.1, 0.9, 1.0])


@pytest.mark.parametrize("offset", [0.0, -0.03])
@pytest.mark.parametrize("strokes", [4, 2])
def test_harmonics_of_a_measured_diagram(strokes, offset):
    rows, bar = (ROWS, BAR) if strokes == 4 else (ROWS[:11], BAR[:11])
    diagram = draw_diagram(rows, bar * 1e5, strokes=strokes)
    found = press(slider_crank_piston(*LENGTHS, offset), diagram, diagram.breaks).harmonics(HALVES)
    halves = HALVES[:: 4 if strokes == 4 else 8]
    with mp.workdps(gas.DIGITS):
        corners = [mp.radians(mp.mpf(int(a))) for a in (*rows, rows[0] + 180 * strokes)]
        values = [mp.mpf(float(b * 1e5)) for b in (*bar, bar[0])]
        points = []
        for a, b, p, q in zip(corners, corners[1:], values, values[1:], strict=False):
            points += gas.law(lambda c, a=a, b=b, p=p, q=q: p + (q - p) * (c - a) / (b - a), a, b)
        mechanism = gas.Mechanism(*(mp.mpf(length) for length in (*LENGTHS, offset)))
        exact = gas.Sampled(mechanism, points, strokes * mp.pi)
        expected = np.array([complex(exact.harmonic(int(h), mp.mpf(1e5))) for h in halves])
    assert np.abs(found[halves] - expected).max() <= OF_THE_LARGEST * np.abs(found).max()


@pytest.mark.parametrize("firing", [360.0, -3.0])
def test_a_diagram_that_counts_from_elsewhere(firing):
    shifted = draw_diagram(ROWS + firing, BAR * 1e5, firing_deg=firing)
    first = draw_diagram(ROWS, BAR * 1e5)
    assert shifted.breaks == pytest.approx(first.breaks)
    assert find_highest(shifted) == (pytest.approx(np.radians(7)), 51.3e5)


def test_the_first_of_two_rows_at_the_ends_of_the_period_holds():
    diagram = draw_diagram([*ROWS, 540], [*BAR * 1e5, 1.5e5])
    np.testing.assert_array_equal(diagram.breaks, draw_diagram(ROWS, BAR * 1e5).breaks)
    assert diagram.at(np.radians([540.0, -180.0])).tolist() == [1.1e5, 1.1e5]
    assert float(diagram.at(np.radians(539.999999))) == pytest.approx(1.1e5, rel=1e-6)


@pytest.mark.parametrize(
    ("angle", "expected"),
    [
        ([0], [(None, "has 1 rows; a cycle of 720° needs more")]),
        (np.where(ROWS == 7, -5, ROWS), [(5, "the angle -5° does not exceed the 0° before it")]),
        (np.arange(0, 760, 20), [(None, "covers 740°; a cycle of 4 strokes has 720°")]),
        (
            np.delete(np.arange(0, 720, 20), [4, 5]),
            [(4, "is 60° after the row before it: give rows at most 30° apart")],
        ),
        (np.arange(0, 660, 20), [(None, "covers 640° of 720°, a gap of 80° at its end: give rows at most 30° apart")]),
        (np.arange(0, 721, 20), []),
    ],
    ids=["too few", "falling", "too long", "gap", "gap at the end", "nothing"],
)
def test_mistakes_of_a_diagram(angle, expected):
    assert [*find_diagram_mistakes(angle, BAR if len(angle) == len(BAR) else np.ones(len(angle)))] == expected


def test_a_gap_may_be_wider_where_the_pressure_hardly_changes():
    """As in a published diagram, digitised with 33.5 deg between two rows of gas exchange."""
    angle = [*range(0, 676, 15), 709]
    values = np.full(len(angle), 1e5)
    values[1] = 20e5
    assert list(find_diagram_mistakes(angle, values)) == []
    values[-1] = 4e5
    (wrong,) = find_diagram_mistakes(angle, values)
    assert wrong[0] == len(angle) - 1
    assert wrong[1].startswith("is 34° after the row before it")
    assert list(find_diagram_mistakes(angle[:-1], values[:-1])) == []
    assert [row for row, _ in find_diagram_mistakes(angle[:-2], values[:-2])] == [None]
