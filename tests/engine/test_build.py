"""Engine file -> SI arrays: masses, rods, places, devices, and what cannot be an engine."""

import math

import numpy as np
import pytest
from support.cases import cases
from support.engines import engine, refused

from balcli.core.phasors import unit
from balcli.file.units import STANDARD_GRAVITY

TIGHT = 1e-14


def only(values: np.ndarray) -> float:
    """The one value that all cylinders share."""
    assert values.shape == (1,)
    return float(values[0])


# ------------------------------------------------------------------ SI
def test_si_values_of_a_whole_file():
    e = engine(
        name="x",
        source="y",
        crank={"stroke": 90, "throws": [0, 180], "spacing": 110, "throw_mass": 1.2},
        rod={"length": 150, "mass": 0.6, "cg": 50, "inertia": 2500},
        piston={"mass": 0.5, "bore": 80, "offset": 3},
        layout={"bank_angle": 60},
        operation={"speed": 3000},
    )
    c = e.cylinders
    assert (e.name, e.source, e.numbers, e.strokes, c.count) == ("x", "y", (1, 2, 3, 4), 4, 4)
    assert (float(c.radius[0]), only(c.lam), only(c.eps)) == pytest.approx((0.045, 0.3, 0.02), rel=TIGHT)
    assert only(c.offset) == pytest.approx(0.003, rel=TIGHT)
    assert only(c.reciprocating) == pytest.approx(0.5 + 0.6 * 50 / 150, rel=TIGHT)
    assert only(c.rotating) == pytest.approx(1.2 / 2 + 0.6 * 100 / 150, rel=TIGHT)
    assert only(c.couple) == pytest.approx(0.6 * 0.05 * 0.10 - 2500e-6, rel=TIGHT)
    assert list(c.axis_deg) == [-30, 30]
    assert e.first_axis_deg == -30
    assert e.omega == pytest.approx(100 * math.pi, rel=TIGHT)
    stroke = math.sqrt(0.195**2 - 0.003**2) - math.sqrt(0.105**2 - 0.003**2)  # offset 3 mm
    assert float(e.displacement_m3) == pytest.approx(4 * math.pi / 4 * 0.08**2 * stroke, rel=TIGHT)
    assert list(e.throws_m) == pytest.approx([-0.055, 0.055], rel=TIGHT)
    assert e.reference_m == pytest.approx((0, 0, 0), abs=TIGHT)
    assert e.equal


def test_two_masses_have_no_couple():
    """H = 0 exactly, not a rounding error that would show as a couple."""
    assert only(engine(rod={"length": 171, "mass": 0.83, "cg": 47.3}).cylinders.couple) == 0
    assert only(engine(rod={"length": 171, "small_end": 0.31, "big_end": 0.52}).cylinders.couple) == 0
    assert only(engine().cylinders.couple) == 0


# ------------------------------------------------------------------ rods
WEIGHED = {"length": 200, "small_end": 0.15, "big_end": 0.45, "inertia": 4000}


@cases("engine/build", "ways_to_say_the_same_rod")
def test_ways_to_say_the_same_rod(rod):
    one = engine(rod=rod).cylinders
    other = engine(rod=WEIGHED).cylinders
    for name in ("lam", "reciprocating", "rotating", "couple"):
        assert only(getattr(one, name)) == pytest.approx(only(getattr(other, name)), rel=1e-13), name


@pytest.mark.parametrize(("pivot", "arm"), [("small_end", 0.15), ("big_end", 0.05)])
def test_pendulum(pivot, arm):
    """J_g = m (g h T^2 / 4 pi^2 - h^2), h from the pivot to the centre of mass."""
    inertia = 4000e-6
    period = 2 * math.pi * math.sqrt((inertia + 0.6 * arm**2) / (0.6 * STANDARD_GRAVITY * arm))
    swung = engine(rod={"length": 200, "mass": 0.6, "cg": 50, "pendulum": {"pivot": pivot, "period": period}}).cylinders
    assert only(swung.couple) == pytest.approx(0.6 * 0.05 * 0.15 - inertia, rel=1e-12)


def test_a_rod_of_its_own():
    """What a cylinder gives displaces what the engine says otherwise of the same thing; the rest stays."""
    e = engine(
        crank={"throws": [0, 120, 240, 0]},
        rod={"length": 200, "mass": 0.6, "cg": 50, "inertia": 4000},
        cylinder={
            "2": {"rod_small_end": 0.2, "rod_big_end": 0.5, "piston_mass": 1.1},
            "3": {"rod_ratio": 0.2, "rod_mass": 0.7, "piston_offset": -5},
            "4": {"rod_pendulum": {"pivot": "small_end", "period": 0.9}},
        },
    )
    c = e.cylinders
    assert not e.equal
    assert list(c.lam) == pytest.approx([0.25, 0.25, 0.2, 0.25], rel=TIGHT)
    assert list(c.eps) == pytest.approx([0, 0, -5 / 250, 0], rel=TIGHT)
    assert list(c.reciprocating) == pytest.approx([1.15, 1.3, 1 + 0.7 * 50 / 250, 1.15], rel=TIGHT)
    assert list(c.rotating) == pytest.approx([0.45, 0.5, 0.7 * 200 / 250, 0.45], rel=TIGHT)
    swung = 0.6 * (STANDARD_GRAVITY * 0.15 * (0.9 / 2 / math.pi) ** 2 - 0.15**2)
    two_masses = np.array([0.6 * 0.05 * 0.15, 0.7 * (0.2 * 2 / 7) * (0.2 * 5 / 7), 0.7 * 0.05 * 0.2, 0.6 * 0.05 * 0.15])
    assert list(c.couple) == pytest.approx(two_masses - [4000e-6, 4000e-6, 4000e-6, swung], rel=1e-12)


def test_overrides_that_change_nothing_leave_the_cylinders_equal():
    assert engine(crank={"throws": [0, 180]}, cylinder={"2": {"piston_mass": 1, "rod_length": 200}}).equal


# ------------------------------------------------------------------ where cylinders stand
def test_a_free_layout():
    e = engine(
        crank={"throws": [0, 0, 0]},
        cylinder={
            "1": {"bank": 30, "throw": 10, "position": -70},
            "2": {"bank": -30, "throw": 100, "position": 0},
            "3": {"bank": 30, "throw": 190, "position": 80},
        },
    )
    c = e.cylinders
    rows = zip(e.numbers, *(map(float, each) for each in (c.axis_of_each_deg, c.pin_deg, c.z)), strict=True)
    assert sorted(rows) == [(1, 30, 0, -0.07), (2, -30, 90, 0), (3, 30, 180, 0.08)]
    assert list(c.axis_deg) == [30, -30]
    assert c.axis_deg[c.first] == 30
    assert e.reference_m == pytest.approx((0, 0, 0.005))


def test_cylinders_on_equal_axes_are_one_bank_however_the_file_says_so():
    turned = engine(crank={"throws": [0, 180, 180, 0]}, cylinder={str(number): {"bank": 45} for number in range(1, 5)})
    assert list(turned.cylinders.axis_deg) == [45]
    assert list(engine(layout={"banks": [30, -30, 30]}).cylinders.axis_deg) == [30, -30]
    assert list(engine(layout={"bank_angle": 0}).cylinders.axis_deg) == [0]


def test_pins_count_from_cylinder_1s_which_may_be_in_the_second_bank():
    e = engine(crank={"throws": [0, 90]}, layout={"banks": [-45, 45], "numbering": [[2, 4], [1, 3]]})
    assert e.numbers == (2, 4, 1, 3)
    assert e.first_axis_deg == 45
    assert {n: float(p) for n, p in e.pins_deg.items()} == {2: 0, 4: 90, 1: 0, 3: 90}


def test_reference_of_the_file():
    assert engine(frame={"reference": [10, -20, "0.3 m"]}).reference_m == pytest.approx((0.01, -0.02, 0.3), rel=TIGHT)
    uneven = engine(crank={"positions": [-10, 0, 50], "throws": [0, 0, 0]})
    assert uneven.reference_m == pytest.approx((0, 0, 0.02))


def test_a_throw_mass_is_shared_by_the_pins_of_its_throw():
    layout = {"banks": [0, 60, 120]}
    throws = [0, 120, 240]
    shared = engine(crank={"throw_mass": 6}, layout=layout)
    alternating = engine(crank={"throw_mass": 6, "throws": throws}, layout=layout | {"rods": "alternating"})
    assert (only(shared.cylinders.rotating), only(alternating.cylinders.rotating)) == pytest.approx((2, 6))


# ------------------------------------------------------------------ devices
def test_devices():
    """A counterweight counts from pin 1, a shaft and a slider from the x axis; unbalance or mass and radius."""
    e = engine(
        crank={"throws": [0]},
        layout={"banks": [45, -45]},
        counterweight=[{"unbalance": 40000, "angle": 180, "position": -50}, {"mass": 0.5, "radius": 60}],
        shaft=[
            {"ratio": -2, "unbalance": 9000, "angle": 90, "at": [-40, 60], "position": 7},
            {"ratio": 3, "unbalance": 1000},
        ],
        slider=[{"order": 2, "unbalance": 8000, "direction": 90, "angle": 60, "at": [1, 2], "position": 3}],
    )
    weight, light, against, ahead, slider = e.devices
    assert [d.order for d in e.devices] == [1, 1, 2, 3, 2]
    assert weight.forward == pytest.approx(0.04 * unit(225), rel=TIGHT)
    assert light.forward == pytest.approx(0.03 * unit(45), rel=TIGHT)
    assert (against.forward, against.backward) == (0, pytest.approx(0.009j, rel=TIGHT))
    assert (ahead.forward, ahead.backward) == (pytest.approx(0.001, rel=TIGHT), 0)
    assert slider.forward == pytest.approx(0.004 * unit(150), rel=TIGHT)
    assert slider.backward == pytest.approx(0.004 * unit(30), rel=TIGHT)
    assert [d.place for d in e.devices] == pytest.approx([0, 0, -0.04 + 0.06j, 0, 0.001 + 0.002j], rel=TIGHT)
    assert [d.z for d in e.devices] == pytest.approx([-0.05, 0, 0.007, 0, 0.003], rel=TIGHT)


# ------------------------------------------------------------------ what cannot be
@cases("engine/build", "what_cannot_be_an_engine")
def test_what_cannot_be_an_engine(parts, message):
    assert refused(**parts) == f"engine: {message}"


@cases("engine/build", "what_cannot_be_a_locomotive")
def test_what_cannot_be_a_locomotive(parts, message):
    crank = {"stroke": 60, "throws": [0, 90], "positions": [-300, 300]}
    assert refused(crank=crank, **parts) == f"engine: {message}"


def test_a_pendulum_that_swings_too_quickly_for_a_cylinders_own_rod():
    """J = m (g h T^2 / 4 pi^2 - h^2) would be negative below T = 2 pi sqrt(h / g)."""
    text = refused(
        crank={"throws": [0, 0]},
        rod={"length": 200, "mass": 1, "cg": 50},
        cylinder={"2": {"rod_pendulum": {"pivot": "small_end", "period": 0.1}}},
    )
    shortest = 2 * math.pi * math.sqrt(0.15 / STANDARD_GRAVITY)
    assert text == (
        "engine: cylinder.2.rod_pendulum: period 0.1 s is too short: a full swing takes more "
        f"than {shortest:.4g} s with the centre of mass 150 mm from the pivot"
    )


@cases("engine/build", "a_centre_of_mass_outside_the_rod_needs_an_inertia")
def test_a_centre_of_mass_outside_the_rod_needs_an_inertia(parts, message):
    """Two masses at the ends would have m s_a s_b < 0; with its own inertia it is a rod like any other."""
    assert refused(**parts) == f"engine: {message}: give a cg from 0 to 200 mm, or the rod's inertia"
    assert engine(**parts | {"rod": parts["rod"] | {"inertia": 1000}}).cylinders.count == 1
