"""Shafts at multiples of half the crank speed, which are orders, and parts without a fixed phase to the crank."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.engines import build_text
from support.paths import write

from balcli import BalcliError, analyze, load
from balcli.forces.curves import compute_device_forces
from balcli.forces.spectrum import check_orders, find_relevant_orders
from balcli.report.live import explain_still

FOUR = """\
[crank]
stroke = 86
spacing = 90
throws = [0, 180, 180, 0]
[rod]
length = 150
mass = 0.5
cg = 40
[piston]
mass = 0.4
[operation]
speed = 6000
"""
SHAFT = '[[shaft]]\nname = "{}"\nratio = {}\nunbalance = {}\nposition = 20\nat = [300, 0]\n'
OMEGA = 200 * math.pi  # rad/s
CAM = FOUR + SHAFT.format("cam", 0.5, 500)
BELT = FOUR + SHAFT.format("alternator", 1.3, 500)


# ------------------------------------------------------------------ half orders
def test_a_camshaft_is_an_order_like_any_other():
    """U (k w)^2 as force, 20 mm times it as moment, 300 mm times it as couple."""
    found = analyze(build_text(CAM), [0.5, 1, 2]).spectra
    force = 500e-6 * (OMEGA / 2) ** 2
    assert found.force.forward[0] == pytest.approx(force)
    assert found.force.backward[0] == 0
    assert found.moment.major[0] == pytest.approx(0.02 * force)
    assert found.couple.major[0] == pytest.approx(0.3 * force)
    plain = analyze(build_text(FOUR), [1, 2]).spectra
    assert found.force.major[1:] == pytest.approx(plain.force.major)


@pytest.mark.parametrize(("ratio", "turns"), [(0.5, 1), (-1.5, -3), (2.5, 5)])
def test_the_peak_with_half_orders_is_the_largest_of_20_000_angles(ratio, turns):
    """Sums in time of all forces over two revolutions, in which the shaft turns `turns` times: `-m x''` of
    the pistons with `x = r cos + sqrt(l^2 - r^2 sin^2)`, and the shaft. Rotating masses are balanced.
    """
    engine = build_text(FOUR + SHAFT.format("pump", ratio, 6000))
    crank_deg = np.arange(20_000) * 720 / 20_000
    whole = np.zeros(len(crank_deg))
    for throw in (0, 180, 180, 0):
        psi = np.radians(crank_deg + throw)
        side = np.sqrt(0.15**2 - (0.043 * np.sin(psi)) ** 2)
        bend = 0.043**2 * np.cos(2 * psi) / side + 0.043**4 * np.sin(2 * psi) ** 2 / (4 * side**3)
        whole = whole + (0.4 + 0.5 * 40 / 150) * OMEGA**2 * (0.043 * np.cos(psi) + bend)
    pump = 6000e-6 * (ratio * OMEGA) ** 2 * np.exp(2j * np.pi * turns * np.arange(20_000) / 20_000)
    sizes = np.abs(whole + pump)
    peak = analyze(engine).peak.force
    assert peak.value == pytest.approx(sizes.max(), rel=1e-6)
    at = sizes[round(math.degrees(peak.theta) / 720 * 20_000) % 20_000]
    assert at == pytest.approx(sizes.max(), rel=1e-5)
    assert_allclose(compute_device_forces(engine, crank_deg)[0], pump, rtol=1e-6)


def test_orders_and_cycle_of_an_engine_with_a_half_order():
    assert find_relevant_orders(build_text(CAM))[:3].tolist() == [0.5, 1, 2]
    assert find_relevant_orders(build_text(FOUR + SHAFT.format("pump", 1.5, 9)))[:3].tolist() == [1, 1.5, 2]
    assert build_text(CAM).cycle_revolutions == 2
    assert build_text(FOUR).cycle_revolutions == 1
    assert check_orders([0.5], [build_text(CAM)]).tolist() == [0.5]
    with pytest.raises(BalcliError, match=r"half orders need \[gas\] and four strokes, or a shaft at a half order"):
        check_orders([0.5], [build_text(FOUR)])


def test_other_commands_have_the_half_order(tmp_path):
    file = write(tmp_path / "cam.toml", CAM)
    assert "½" in ask("analyze", file, "--orders", "0.5", "--only", "force")
    rows = ask_csv("curves", file, "--step", "90")
    assert [row["crank_deg"] for row in rows][-1] == "630.0"
    once, twice = ask_csv("sweep", file, "--vary", "shaft.1.unbalance=500,1000", "-q", "force.0.5.major")
    assert float(twice["force.0.5.major"]) == pytest.approx(2 * float(once["force.0.5.major"]))
    assert "shaft at +0" not in ask("balance", file)


def test_verdict_and_ladder_name_the_shaft(tmp_path):
    heavy = FOUR + SHAFT.format("cam", 0.5, 50000)
    file = write(tmp_path / "cam.toml", heavy)
    told = " ".join(ask("analyze", file).split())
    assert "it comes from shaft 'cam'; balance that shaft" in told
    assert "Order ½ comes from shaft 'cam'; balance that shaft." in told
    (half, *_) = ask_json("analyze", file, "--only", "verdict")["verdict"]["matter"]
    assert (half["order"], half["shafts"]) == (0.5, ["cam"])
    assert "cures" not in half
    two = heavy.replace('name = "cam"\n', "") + SHAFT.format("b", -0.5, 50000)
    told = " ".join(ask("analyze", write(tmp_path / "two.toml", two)).split())
    assert "Order ½ comes from shafts 1 and 'b'; balance these shafts." in told


def test_the_page_is_drawn_without_sliders():
    assert explain_still(build_text(FOUR)) == ""
    for text in (CAM, BELT):
        assert "a shaft turns at another speed than a whole multiple" in explain_still(build_text(text))


# ------------------------------------------------------------------ parts without a fixed phase
def test_a_belt_driven_part_is_listed_apart():
    force = 500e-6 * (1.3 * OMEGA) ** 2
    found = analyze(build_text(BELT))
    plain = analyze(build_text(FOUR))
    (part,) = found.other_speeds
    assert part.name == "alternator"
    assert part[1:] == pytest.approx((1.3, 130, force, 0.02 * force, 0.3 * force), rel=1e-12)
    assert found.spectra.force.major.tolist() == plain.spectra.force.major.tolist()
    assert found.peak.force_at_most_N == pytest.approx(plain.peak.force.value + force)
    assert found.peak.moment_at_most_Nm == pytest.approx(plain.peak.moment.value + 0.02 * force)
    assert (found.peak.force_at_most_N, part.moment_Nm) == pytest.approx((11169.9875432344, 6.671852575136642))


def test_nothing_changes_without_such_parts():
    for text in (FOUR, CAM):
        document = analyze(build_text(text)).to_dict()
        assert "other_speeds" not in document
        assert not {"force_at_most_N", "moment_at_most_Nm"} & {*document["peak"]}


def test_eccentrics_of_one_shaft_keep_their_phase():
    """Two opposite eccentrics 60 mm apart make a moment and no force."""
    pair = "".join(
        f'[[shaft]]\nname = "fan"\nratio = -2.2\nunbalance = 100\nangle = {angle}\nposition = {z}\n'
        for angle, z in ((20, -30), (200, 30))
    )
    (part,) = analyze(build_text(FOUR + pair)).other_speeds
    assert part.ratio == -2.2
    assert part.frequency_Hz == pytest.approx(220)
    assert part.force_N == pytest.approx(0, abs=1e-9)
    assert part.moment_Nm == pytest.approx(0.06 * 100e-6 * (2.2 * OMEGA) ** 2)


def test_the_table_stands_by_default_and_with_parts(tmp_path):
    file = write(tmp_path / "belt.toml", BELT)
    for options, shown in (((), True), (("--only", "parts"), True), (("--all",), True), (("--only", "force"), False)):
        assert ("Parts at other speeds" in ask("analyze", file, *options)) == shown
    told = " ".join(ask("analyze", file).split())
    assert "with the parts at other speeds at most 11.17 kN" in told
    rows = ask_csv("analyze", file)
    figures = {(row["quantity"], row["figure"]): row["value"] for row in rows if not row["order"]}
    assert float(figures["other speed alternator", "frequency_Hz"]) == pytest.approx(130)
    assert float(figures["force", "peak_at_most"]) == pytest.approx(11169.9875432344)


def test_other_commands_leave_it_out_with_a_warning(tmp_path):
    file = write(tmp_path / "belt.toml", BELT + SHAFT.format("pump", 0.7, 40))
    for command in (("curves", file), ("balance", file), ("sweep", file, "--vary", "operation.speed=5000,6000")):
        result = run_here(*command)
        assert result.status == 0
        assert result.err.count("alternator (1.3) and pump (0.7): a speed that is no multiple of half") == 1
    assert run_here("analyze", file).err == ""
    assert "shaft" not in run_here("scatter", file, "--samples", "5", "--seed", "1", "-f", "json").out


def test_a_number_of_such_a_shaft_cannot_vary(tmp_path):
    file = write(tmp_path / "belt.toml", BELT)
    assert "shaft.1.unbalance" in refusal("sweep", file, "--vary", "shaft.1.unbalance=1,2")


def test_fit_is_refused_by_balance_as_well(tmp_path):
    file = write(tmp_path / "fit.toml", BELT.replace("unbalance = 500", 'unbalance = "fit"'))
    for command in ("balance", "analyze"):
        assert 'shaft.1.ratio: 1.3 does not go together with unbalance = "fit"' in refusal(command, file)


def test_parts_of_geared_engines(tmp_path):
    """Those of an engine's own file have its name and place."""
    write(tmp_path / "own.toml", BELT)
    engines = "".join(
        f'[[engine]]\nname = "{name}"\nfile = "own.toml"\nat = [0, 0, {z}]\n' for name, z in (("a", 0), ("b", 400))
    )
    engine = load(write(tmp_path / "pair.toml", engines + SHAFT.format("fan", 2.7, 30)))
    found = analyze(engine)
    assert [part.name for part in found.other_speeds] == ["a alternator", "b alternator", "fan"]
    force = 500e-6 * (1.3 * OMEGA) ** 2
    z_ref = engine.reference_m[2]
    moments = [part.moment_Nm for part in found.other_speeds[:2]]
    assert moments == pytest.approx([abs(0.02 - z_ref) * force, abs(0.42 - z_ref) * force])
    assert not any(device.order % 1 for device in engine.every_device)


def test_inertia_and_bearings_work_for_every_ratio(tmp_path):
    text = BELT + "inertia = 900\nbearings = [-40, 60]\n"
    (shaft,) = ask_json("analyze", write(tmp_path / "belt.toml", text), "--only", "parts")["parts"]["shafts"]
    assert shaft["inertia_at_crank_kg_m2"] == pytest.approx(1.3**2 * 900e-6)
    force = 500e-6 * (1.3 * OMEGA) ** 2
    assert [bearing["rotating_N"] for bearing in shaft["bearings"]] == pytest.approx([0.4 * force, 0.6 * force])
