"""What gas and inertia do inside an engine: statics and quadratures of their own."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from support.commands import ask
from support.engines import build_text
from support.gas_engines import FOUR, WIEBE, draw_engine
from support.in_time import run_in_time
from support.paths import ENGINES

from balcli import load
from balcli.core.phasors import Phasors
from balcli.errors import BalcliError, InputError
from balcli.forces.crankshaft import compute_inner_loads, compute_loads, place_bearings
from balcli.forces.loads_with_gas import compute_bearing_loads, compute_forces_along, compute_loads_with_gas
from balcli.forces.spectrum import compute_forces_of_devices

DEVICES = """
[[counterweight]]
unbalance = 60000
angle = 170
position = -230
[[counterweight]]
unbalance = 50000
angle = 30
position = 40
[[shaft]]
ratio = -2
unbalance = 9000
angle = 35
at = [-40, 60]
position = -30
[[slider]]
order = 2
unbalance = 2000
direction = 20
position = 90
"""
ORDERS = np.array([0.0, 0.5, 1.0, 1.5, 2.0, 4.5, 12.0, 40.0])


@cache
def draw(seed):
    """Two cylinders at least, with devices on shaft and block."""
    found = draw_engine(seed, more=DEVICES)
    return found if len(found.throws_m) > 1 else draw(seed + 100)


@cache
def find_loads(seed):
    """The loads of the drawn engine, with gas."""
    return compute_loads_with_gas(draw(seed), ORDERS)


def solve_statics(found, angles):
    """Bearing loads, shear and bending moment of the shaft just behind each section, one load at a
    time: in the span that it stands in, or by the two bearings that it hangs on, reactions hold it.
    """
    loads = compute_forces_along(found, np.degrees(angles))[0]
    weights = [d.z for d in found.devices if d.order == 1 and not d.place and not d.backward]
    z = np.array([*np.ravel(found.cylinders.z), *weights])
    span = place_bearings(found)
    sections = np.unique([*z, *span, *(d.z for d in found.devices)])
    bearings = np.zeros((len(span), len(angles)), complex)
    shear = np.zeros((len(sections), len(angles)), complex)
    bending = np.zeros_like(shear)
    for place, press in zip(z, loads, strict=True):
        left = min(max(np.searchsorted(span, place, side="right") - 1, 0), len(span) - 2)
        levers = np.array([[1.0, 1.0], [span[left], span[left + 1]]])
        held = np.linalg.solve(levers, np.array([press, place * press]))
        bearings[left : left + 2] += held
        forces = ((place, press), (span[left], -held[0]), (span[left + 1], -held[1]))
        for row, section in enumerate(sections):
            before = [(at, force) for at, force in forces if at <= section]
            shear[row] += sum(force for _, force in before)
            bending[row] += 1j * sum((at - section) * force for at, force in before)
    return {"bearings": bearings, "shear": shear, "bending": bending}


def integrate(found, function, orders):
    """Orders of functions by Gauss-Legendre sums of 24 points over short pieces between jumps."""
    jumps = [(cylinder.torque.breaks + cylinder.fires) % (4 * np.pi) for cylinder in found.gas.cylinders]
    even = np.linspace(0, 4 * np.pi, 241)
    edges = np.unique(np.round(np.concatenate([even, *jumps]), 13))
    nodes, weights = np.polynomial.legendre.leggauss(24)
    middle = (edges[1:] + edges[:-1]) / 2
    half = np.diff(edges) / 2
    angles = (middle + half * nodes[:, None]).ravel()
    share = (half * weights[:, None]).ravel() / (4 * np.pi)
    values = function(angles)
    turn = np.exp(-1j * np.multiply.outer(angles, orders)) * share[:, None]
    return {name: (v @ turn, v @ np.conj(turn)) for name, v in values.items()}


@pytest.mark.parametrize("seed", [1, 4])
def test_orders_are_those_of_statics_load_by_load(seed):
    found = draw(seed)
    loads = find_loads(seed)
    wanted = integrate(found, lambda angles: solve_statics(found, angles), ORDERS)
    for name, (forward, backward) in wanted.items():
        phasors = getattr(loads, name).phasors
        size = np.abs(forward).max()
        assert np.abs(phasors.forward.T - forward).max() < 1e-12 * size
        assert np.abs(phasors.backward.T - backward)[:, 1:].max() < 1e-12 * size
        assert not phasors.backward[0].any()


@pytest.mark.parametrize("seed", [1, 4])
def test_largest_values_are_on_the_curves(seed):
    found = draw(seed)
    loads = find_loads(seed)
    fine = np.radians(np.arange(0, 720, 0.2))
    for name, curves in solve_statics(found, fine).items():
        sizes = np.abs(curves)
        for k, peak in enumerate(getattr(loads, name).peaks):
            assert peak.value >= sizes[k].max() * (1 - 1e-10) - 1e-9 * sizes.max()
            assert peak.value == pytest.approx(sizes[k].max(), rel=0.02, abs=1e-9 * sizes.max())


def draw_uneven():
    lines = "[{ order = 1, amplitude = 0.03, angle = 40 }, { order = 0.5, amplitude = 0.02 }]"
    return build_text(FOUR + f"speed_ripple = {lines}\n" + WIEBE + DEVICES)


@pytest.mark.parametrize("seed", [1, 4, None])
def test_shaft_and_block_together_bear_what_inertia_makes(seed):
    """Gas presses on throw and head alike; the block has its shafts and sliders besides. Of an uneven speed, too."""
    found = draw_uneven() if seed is None else draw(seed)
    orders = np.arange(1.0, 7.0)
    loads = compute_loads_with_gas(found, orders)
    inertia = compute_inner_loads(found, orders)
    others = [d for d in found.devices if d.order != 1 or d.place or d.backward]
    for row, z in enumerate(inertia.shear.z_m):
        shear = inertia.shear.at(row)
        bending = inertia.bending.at(row)
        for device in others:
            if device.z <= z:
                force = compute_forces_of_devices(found, [device], orders).select_place(0)
                shear = shear + force
                bending = bending + 1j * (device.z - z) * force
        pairs = (loads.shear, loads.block_shear, shear), (loads.bending, loads.block_bending, bending)
        for shaft, block, want in pairs:
            both = pick(shaft, z) + pick(block, z)
            size = np.abs(shaft.phasors.forward).max()
            assert both.forward == pytest.approx(want.forward, abs=1e-11 * size)
            assert both.backward == pytest.approx(want.backward, abs=1e-11 * size)


def pick(along, z) -> Phasors:
    return along.at(int(np.flatnonzero(np.isclose(along.z_m, z))[0]))


# ------------------------------------------------------------------ what users see
def analyze(*arguments):
    return ask("analyze", *arguments, "--only", "inner")


def test_json_and_csv_have_every_place():
    path = ENGINES / "i4_wiebe.toml"
    inner = json.loads(analyze(path, "--orders", "0.5-2", "-f", "json"))["inner"]
    found = inner["with_gas"]
    assert [len(found[part]["sections"]) for part in ("crankshaft", "block")] == [9, 9]
    assert len(found["bearings"]) == 5
    bent = found["crankshaft"]["sections"][1]
    assert [entry["order"] for entry in bent["bending_Nm"]["orders"]] == [0.5, 1, 1.5, 2]
    assert bent["bending_Nm"]["peak"] == pytest.approx(found["crankshaft"]["largest_bending_Nm"])
    rows = analyze(path, "--orders", "0.5-2", "-f", "csv").splitlines()
    nine = ("shaft_shear", "shaft_bending", "block_shear", "block_bending")
    for name, places in (("main", 5), *((name, 9) for name in nine)):
        for place in range(1, places + 1):
            assert any(f",{name} {place},,peak," in row for row in rows)


def test_so_many_cylinders_that_they_would_fill_the_memory_are_refused(monkeypatch):
    monkeypatch.setattr("balcli.forces.loads_with_gas.MOST_FORCES_OVER_CYCLE", 1000)
    with pytest.raises(BalcliError, match="loads with gas: 8 forces of 4 cylinders"):
        compute_loads_with_gas(replace(build_text(FOUR + WIEBE)))


def test_throw_masses_load_bearings_at_uneven_speed_as_their_acceleration_in_time():
    """What throw masses add to the load of the first bearing, half of the first throw's, against
    the second derivative in time of where they are.
    """
    ripple = "speed_ripple = [{order = 2, amplitude = 0.05, angle = 40}]\n"
    engines = [build_text(FOUR.replace("[rod]", f"throw_mass = {m}\n[rod]") + ripple + WIEBE) for m in (0, 0.8)]
    angles, period = run_in_time(lambda a: 100 * np.pi * (1 + 0.05 * np.cos(2 * a - np.radians(40))), 1)
    place = 0.045 * np.exp(1j * angles)
    waves = 2j * np.pi * np.fft.fftfreq(len(place), period / len(place))
    expected = -0.5 * 0.8 * np.fft.ifft(waves**2 * np.fft.fft(place))
    without, loads = (compute_bearing_loads(each, np.degrees(angles[::64]))[0] for each in engines)
    assert loads - without == pytest.approx(expected[::64], abs=1e-6 * np.abs(expected).max())


# ------------------------------------------------------------------ bearings at given places
def test_two_throws_between_given_bearings_share_by_lever():
    """Four throws on three bearings: every bearing load is the lever sum over its spans."""
    model = load(ENGINES / "i4.toml").to_dict()
    engine = load(model | {"bearing": {"main_positions": [-195, 0, 195]}})
    orders = np.array([1, 2, 4])
    loads, z = compute_loads(engine, orders)
    inner = compute_inner_loads(engine, orders)
    front = np.clip((0 - z) / 0.195, 0, None) * (z < 0)
    rear = np.clip(z / 0.195, 0, None) * (z > 0)
    found = inner.bearings.phasors.forward
    for place, shares in enumerate((front, 1 - front - rear, rear)):
        assert_allclose(found[:, place], loads.forward @ shares, rtol=1e-12, atol=1e-9)
    assert inner.bearings.z_m.tolist() == [-0.195, 0.0, 0.195]


def test_given_bearings_make_the_loads_of_a_single_known():
    """Beyond the last bearing, the last two bearings carry the load."""
    single = load(ENGINES / "single.toml").to_dict()
    engine = load(single | {"bearing": {"main_positions": [30, 90]}})
    forces, _ = compute_loads(engine, np.array([1]))
    found = compute_inner_loads(engine, np.array([1])).bearings.phasors.forward[0]
    assert_allclose(found, [1.5 * forces.forward.sum(), -0.5 * forces.forward.sum()])


@pytest.mark.parametrize(
    ("places", "told"),
    [
        ([-195, 195, 0], "bearing.main_positions: \\[-195, 195, 0\\]: 0 follows 195"),
        ([0], "bearing.main_positions: \\[0\\] is a single place"),
        ([-195, -50, 195], "bearing.main_positions.*-50 mm is the position of a throw"),
    ],
)
def test_wrong_places_of_bearings_are_named(places, told):
    model = load(ENGINES / "i4.toml").to_dict()
    model["crank"] |= {"positions": [-150, -50, 50, 150]}
    model["crank"].pop("spacing", None)
    with pytest.raises(InputError, match=told):
        load(model | {"bearing": {"main_positions": places}})
