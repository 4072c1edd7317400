"""Loads of pins and bearings: virtual work, statics, and one cylinder by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.gas_engines import FOUR, WIEBE, draw_engine, engine

from balcli.core.phasors import unit
from balcli.errors import BalcliError
from balcli.forces.curves import compute_engine_curves
from balcli.forces.rod_forces import compute_rod_forces
from balcli.torque.course import find_torque_curves
from balcli.torque.loads import analyze_loads, find_bearing_loads, find_pin_loads

ANGLES = np.arange(0.0, 720.0, 7.0)


@pytest.mark.parametrize("seed", range(6))
def test_pin_forces_make_the_torque_of_virtual_work(seed):
    found = draw_engine(seed)
    psi = ANGLES + found.cylinders.angle_deg[:, None]
    forces = compute_rod_forces(found, ANGLES)
    torque = (np.conj(float(found.cylinders.radius) * unit(psi)) * forces.pin).imag.sum(axis=0)
    want = find_torque_curves(found).total.at(np.radians(ANGLES))
    assert torque == pytest.approx(want, abs=1e-10 * np.abs(want).max())


@pytest.mark.parametrize("ripple", [False, True])
def test_what_pins_walls_and_heads_feel_is_the_free_force(ripple):
    """Rod on pin, piston on wall and gas on head add up to the force on the frame, less what turns
    with the throws.
    """
    more = "[cylinder.2]\npiston_mass = 0.8\n"
    lines = "speed_ripple = [{ order = 1, amplitude = 0.05 }]" if ripple else ""
    text = FOUR.replace("mass = 0.5", "mass = 0.5\noffset = 6").replace(
        "speed = 3000", f"speed = 3000\n{lines}"
    )
    found = engine(text + WIEBE + more)
    forces = compute_rod_forces(found, ANGLES)
    total = (forces.pin + 1j * forces.thrust + forces.gas).sum(axis=0)
    curves = compute_engine_curves(found, ANGLES).values
    size = np.abs(forces.pin).max()
    assert total.real == pytest.approx(curves["force_x_N"], abs=1e-10 * size)
    assert total.imag == pytest.approx(curves["force_y_N"], abs=1e-10 * size)


def test_without_mass_the_rod_carries_the_gas_alone():
    """Thrust is P tan of the rod's angle, the rod P over its cosine; Khurmi and others."""
    light = FOUR.replace("mass = 0.6\ncg = 45\ninertia = 2600", "mass = 0").replace(
        "mass = 0.5", "mass = 0"
    )
    found = engine(light + WIEBE)
    forces = compute_rod_forces(found, ANGLES)
    lean = np.arcsin(0.3 * np.sin(np.radians(ANGLES + found.cylinders.angle_deg[:, None])))
    assert forces.rod == pytest.approx(forces.gas / np.cos(lean), abs=1e-9)
    assert forces.thrust == pytest.approx(-forces.gas * np.tan(lean), abs=1e-9)


def test_the_largest_load_is_on_the_curve():
    found = draw_engine(2)
    fine = np.arange(0.0, 720.0, 0.25)
    sizes = np.abs(find_pin_loads(found)(fine))
    for load in analyze_loads(found, ("pin",)).pin:
        row = found.numbers.index(load.name)
        assert load.largest.value >= sizes[row].max() * (1 - 1e-12)
        assert load.largest.value == pytest.approx(sizes[row].max(), rel=5e-3)
        assert load.mean == pytest.approx(sizes[row].mean(), rel=2e-3)


def test_bearings_carry_what_the_throws_carry():
    found = replace(draw_engine(4), ripple=())
    places, vectors = find_bearing_loads(found)
    on_pins = compute_rod_forces(found, ANGLES).pin  # banks stand along x
    throws = np.array([[w.share] for w in found.weighed]) * float(found.cylinders.radius)
    turning = throws * float(found.omega) ** 2 * unit(ANGLES + found.cylinders.pin_deg[:, None])
    bearings = vectors(ANGLES)
    loads = on_pins + turning
    size = np.abs(loads).max()
    assert bearings.sum(axis=0) == pytest.approx(loads.sum(axis=0), abs=1e-9 * size)
    moment = np.ravel(found.cylinders.z) @ loads
    assert places @ bearings == pytest.approx(moment, abs=1e-9 * size)


def test_loads_that_are_not_known():
    radial = (
        "[crank]\nstroke = 120\n[rod]\nlength = 240\nmass = 1.9\ncg = 55\n[piston]\nmass = 1.3\n"
    )
    radial += "bore = 120\n[layout]\nradial = 3\nfiring_order = [1, 3, 2]\n[articulation]\n"
    radial += "knuckle_radius = 52\nrod = { length = 188, mass = 0.62, cg = 90 }\n"
    with pytest.raises(BalcliError, match="not for articulated or turning"):
        analyze_loads(engine(radial + WIEBE))
    bare = engine(FOUR.replace("spacing = 100\n", "") + WIEBE)
    with pytest.raises(BalcliError, match=r"crank\.spacing is missing"):
        analyze_loads(bare)
    assert analyze_loads(bare, ("pin",)).main is None
