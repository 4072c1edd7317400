"""Loads of pins and bearings: virtual work, statics, and one cylinder by hand."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracle import momentum, newton_euler
from support.engines import build_text
from support.gas_engines import FOUR, WIEBE, draw_engine

from balcli.core.phasors import unit
from balcli.crank_torque import answer
from balcli.crank_torque.loads import analyze_loads
from balcli.engine import build_gas
from balcli.errors import BalcliError
from balcli.forces import loads_with_gas
from balcli.forces.curves import find_torque_curves
from balcli.forces.rod_forces import compute_rod_forces, list_hung_rows

ANGLES = np.arange(0.0, 720.0, 7.0)


def test_without_mass_the_rod_carries_the_gas_alone():
    """Thrust is P tan of the rod's angle, the rod P over its cosine; Khurmi and others."""
    light = FOUR.replace("mass = 0.6\ncg = 45\ninertia = 2600", "mass = 0").replace("mass = 0.5", "mass = 0")
    found = build_text(light + WIEBE)
    forces = compute_rod_forces(found, ANGLES)
    lean = np.arcsin(0.3 * np.sin(np.radians(ANGLES + found.cylinders.angle_deg[:, None])))
    assert forces.rod == pytest.approx(forces.gas / np.cos(lean), abs=1e-9)
    assert forces.thrust == pytest.approx(-forces.gas * np.tan(lean), abs=1e-9)


def test_the_largest_load_is_on_the_curve():
    found = draw_engine(2)
    fine = np.arange(0.0, 720.0, 0.25)
    sizes = np.abs(compute_rod_forces(found, fine).pin)
    for load in analyze_loads(found, ("pin",)).pin:
        row = found.numbers.index(load.cylinder)
        assert load.max_N >= sizes[row].max() * (1 - 1e-12)
        assert load.max_N == pytest.approx(sizes[row].max(), rel=5e-3)
        assert load.mean_N == pytest.approx(sizes[row].mean(), rel=2e-3)


def test_bearings_carry_what_the_throws_carry():
    found = replace(draw_engine(4), ripple=())
    places = loads_with_gas.place_main_bearings(found)
    on_pins = compute_rod_forces(found, ANGLES).pin  # banks stand along x
    throws = np.array([[w.share] for w in found.weighed]) * float(found.cylinders.radius[0])
    turning = throws * float(found.omega) ** 2 * unit(ANGLES + found.cylinders.pin_deg[:, None])
    bearings = loads_with_gas.compute_bearing_loads(found, ANGLES)
    loads = on_pins + turning
    size = np.abs(loads).max()
    assert bearings.sum(axis=0) == pytest.approx(loads.sum(axis=0), abs=1e-9 * size)
    moment = np.ravel(found.cylinders.z) @ loads
    assert places @ bearings == pytest.approx(moment, abs=1e-9 * size)


def test_a_bearing_whose_loads_cancel_bears_nothing():
    """The one between two pistons of a boxer that fire together."""
    text = FOUR.replace("[0, 180, 180, 0]", "[0, 180]\nthrow_mass = 0.3").replace(
        "firing_order = [1, 3, 4, 2]",
        'banks = [-90, 90]\nrods = "alternating"\nstrokes = 2\nfiring_order = [1, 2]\nfiring_intervals = [0, 360]',
    )
    outer, middle, _ = analyze_loads(build_text(text + WIEBE), ("main",)).main
    assert (middle.max_N, middle.max_deg, middle.mean_N) == (0, 0, 0)
    assert outer.max_N > outer.mean_N > 1000


BASE = """\
[crank]
stroke = 120
{crank}
[rod]
length = 240
mass = 1.9
cg = 55
inertia = 21000
[piston]
bore = 120
mass = 1.3
{piston}
[layout]
strokes = 2
{layout}
[operation]
speed = 2300
{operation}
{more}
[gas]
cycle = "wiebe"
compression_ratio = 9
imep = 8
"""
HUNG = """\
[articulation]
knuckle_radius = 52
rod = { length = 188, mass = 0.62, cg = 90, inertia = 3500 }
"""
RIPPLE = "speed_ripple = [{ order = 1, amplitude = 0.03, angle = 40 }]"
MECHANISMS = {
    "radial with a master rod": {"layout": "radial = 5", "more": HUNG},
    "the same, offset, unlike cylinders, uneven speed": {
        "layout": "radial = 5",
        "piston": "offset = 6",
        "operation": RIPPLE,
        "more": HUNG + "[cylinder.3]\ngas = 0.4\nrod_length = 180\npiston_mass = 1.5",
    },
    "vee with articulated rods on three throws": {
        "layout": "bank_angle = 60",
        "crank": "throws = [0, 120, 240]\nspacing = 160\nthrow_mass = 2",
        "more": HUNG.replace("knuckle", "master = 2\nknuckle_angles = [-66.5, 0]\nknuckle"),
    },
    "rotary, offset": {"layout": "radial = 3\nrotary = true", "piston": "offset = 11"},
    "rotary with a master rod": {"layout": "radial = 5\nrotary = true", "piston": "offset = -4", "more": HUNG},
    "rotary with a master rod, uneven speed": {
        "layout": "radial = 5\nrotary = true",
        "operation": RIPPLE,
        "more": HUNG,
    },
    "plain rods, uneven speed": {"layout": "bank_angle = 60", "piston": "offset = 6", "operation": RIPPLE},
}


def write_mechanism(name):
    parts = {"crank": "", "piston": "", "layout": "", "operation": "", "more": ""}
    return BASE.format(**parts | MECHANISMS[name])


@pytest.mark.parametrize("name", MECHANISMS)
def test_pins_and_walls_bear_what_newton_and_euler_say(name):
    """The momentum of pistons and rigid rods on a grid, differentiated by Fourier transform."""
    text = write_mechanism(name)
    found = build_text(text)
    forces = compute_rod_forces(found, np.degrees(momentum.THETA))
    gas = dict(zip(found.numbers, forces.gas, strict=True))
    wanted = newton_euler.solve(momentum.Engine.read(text), gas)
    size = np.abs(forces.pin).max()
    for row, number in enumerate(found.numbers):
        pin = forces.axis[row] * forces.pin[row]
        wall = forces.axis[row] * 1j * forces.thrust[row]
        assert_allclose(pin, wanted[number].pin, rtol=0, atol=5e-10 * size)
        assert_allclose(wall, wanted[number].wall, rtol=0, atol=5e-10 * size)


@pytest.mark.parametrize("name", [*range(6), *(name for name in MECHANISMS if "uneven" not in name)])
def test_forces_make_the_torque_of_virtual_work(name):
    """Of a crank that turns, what its pins feel; of cylinders that turn, what walls and heads do."""
    text = "" if isinstance(name, int) else write_mechanism(name)
    found = build_text(text) if text else draw_engine(name)
    forces = compute_rod_forces(found, np.degrees(momentum.THETA))
    if found.rotary:
        places = momentum.Engine.read(text).cylinders
        pistons = np.stack([places[number][1].place for number in found.numbers])
        on_block = forces.axis * (forces.gas + 1j * forces.thrust)
        torque = (np.conj(pistons) * on_block).imag.sum(axis=0)
    else:
        hung = {row for rows in list_hung_rows(found).values() for row in rows}
        masters = [row for row in range(len(found.numbers)) if row not in hung]
        arms = float(found.cylinders.radius[0]) * forces.throw
        torque = (np.conj(arms) * forces.pin).imag[masters].sum(axis=0)
    want = find_torque_curves(found).total.at(momentum.THETA)
    assert torque == pytest.approx(want, abs=1e-10 * np.abs(want).max())


def test_loads_that_are_not_known():
    with pytest.raises(BalcliError, match="the crank of a rotary engine stands still"):
        analyze_loads(build_text(write_mechanism("rotary, offset")), ("main",))
    with pytest.raises(BalcliError, match="main bearings: a crank with one throw does not determine"):
        analyze_loads(build_text(write_mechanism("radial with a master rod")), ("main",))
    bare = build_text(FOUR.replace("spacing = 100\n", "") + WIEBE)
    with pytest.raises(BalcliError, match=r"crank\.spacing is missing"):
        analyze_loads(bare, ("main",))
    assert not hasattr(analyze_loads(bare, ("pin",)), "main")
    both = analyze_loads(bare)
    assert both.pin == analyze_loads(bare, ("pin",)).pin
    assert not hasattr(both, "main")
    assert both.obstacle.startswith("crank.spacing is missing")


def test_too_much_is_refused_before_anything_is_computed(monkeypatch):
    """1000 cylinders took a minute and 900 MB before they were refused, or were not at all."""
    monkeypatch.setattr(loads_with_gas, "MOST_FORCES_OVER_CYCLE", 1000)
    monkeypatch.setattr(answer, "find_torque_curves", lambda engine: pytest.fail("computed"))
    with pytest.raises(BalcliError, match=r"8 forces of 4 cylinders at \d+ angles .* at most 1000"):
        answer.torque(build_text(FOUR + WIEBE), loads="pin")
    monkeypatch.setattr(build_gas, "MOST_DIFFERENT_GAS", 3)
    heats = "".join(f"[cylinder.{k}]\nheat = {500 + k}\n" for k in range(1, 5))
    with pytest.raises(BalcliError, match="4 cylinders differ in mechanism, heat or diagram; at most 3"):
        build_text(FOUR + WIEBE + heats)
