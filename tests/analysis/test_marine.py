"""The marine sheet against motion sampled over a revolution: no series, no phasor of ours."""

import json
from pathlib import Path

import numpy as np
import pytest
from support.engines import build_text

from balcli.analysis.crank_drive import relate_to_power
from balcli.analysis.speeds import find_marine_sheet

RADIUS = 0.9
ROD = 2.4
MASS = 3000.0
SPACING = 0.8
THROWS = (0.0, 240.0, 120.0, 30.0)
MARINE = Path(__file__).parents[2] / "engines/marine/marine6.toml"
TEXT = f"""
crank = {{ stroke = {2e3 * RADIUS}, throws = {list(THROWS)}, throw_mass = 500, spacing = {1e3 * SPACING} }}
rod = {{ length = {1e3 * ROD}, small_end = 0, big_end = 0 }}
piston.mass = {MASS}
operation.speed = 100
layout.strokes = 2
"""
RPM = (80.0, 110.0)
Z = SPACING * (np.arange(4) - 1.5)
SAMPLES = 4096


def amplitude(values: np.ndarray, order: int) -> float:
    return float(2 * abs(np.fft.rfft(values)[order]) / SAMPLES)


def sampled(rpm: float) -> dict[str, np.ndarray]:
    """Forces along x and y, their moments, couples of the guides and torque, by crank angle."""
    turn = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
    omega = rpm * np.pi / 30
    theta = turn + np.radians(THROWS)[:, None]
    sine = RADIUS / ROD * np.sin(theta)
    travel = RADIUS * np.cos(theta) + ROD * np.sqrt(1 - sine**2)
    waves = np.fft.fftfreq(SAMPLES, 1 / SAMPLES)
    speed, acceleration = (np.fft.ifft((1j * waves) ** k * np.fft.fft(travel)).real for k in (1, 2))
    rotating = 500 * RADIUS * omega**2
    along_x = -MASS * omega**2 * acceleration + rotating * np.cos(theta)
    along_y = rotating * np.sin(theta)
    torque = -MASS * omega**2 * acceleration * speed
    return {
        "force_v": along_x.sum(axis=0),
        "force_h": along_y.sum(axis=0),
        "moment_v": Z @ along_x,
        "moment_h": Z @ along_y,
        "guide_h": torque.sum(axis=0),
        "guide_x": Z @ torque / ROD,
        "torque": torque.sum(axis=0),
    }


def test_every_column_is_that_of_the_motion() -> None:
    found = find_marine_sheet(build_text(TEXT), RPM, [1, 2, 3, 4])
    for i, rpm in enumerate(RPM):
        for name, curve in sampled(rpm).items():
            values = [line.values for line in found.lines if line.kind.name == name]
            largest = max(amplitude(curve, n) for n in (1, 2, 3, 4))
            for k in range(4):
                expected = pytest.approx(amplitude(curve, k + 1), abs=1e-9 * largest, rel=1e-9)
                assert values[k][i] == expected, (name, rpm, k + 1)


def test_the_guide_height_divides_x_alone() -> None:
    engine = build_text(TEXT)
    usual, given = (find_marine_sheet(engine, (), [1, 2], height) for height in (None, 3.0))
    for one, other in zip(given.speeds[0].orders, usual.speeds[0].orders, strict=True):
        assert one.guide_x_Nm == pytest.approx(other.guide_x_Nm * ROD / 3.0, rel=1e-12)
        assert one.guide_h_Nm == pytest.approx(other.guide_h_Nm, rel=1e-12)


def test_moments_that_are_not_known_are_none(balcli, tmp_path) -> None:
    nowhere = TEXT.replace(f", spacing = {1e3 * SPACING}", "")
    assert balcli("analyze", "-", "--format", "marine", "-o", tmp_path / "s.json", stdin=nowhere).status == 0
    entry = json.loads((tmp_path / "s.json").read_text())["speeds"][0]["orders"][0]
    assert entry["force_v_N"] > 0
    assert entry["moment_v_Nm"] is None
    assert entry["guide_x_Nm"] is None


def test_a_line_of_csv_is_an_order_of_a_speed(balcli, tmp_path) -> None:
    sheet = tmp_path / "s.csv"
    given = ("--speed", "80,110", "--orders", "1,2", "--format", "marine", "-o", sheet)
    assert balcli("analyze", "-", *given, stdin=TEXT) == (0, "", "")
    head, *lines = sheet.read_text().splitlines()
    assert head == (
        "engine,speed_rpm,order,force_v_N,force_h_N,moment_v_Nm,moment_h_Nm,guide_h_Nm,guide_x_Nm,torque_Nm"
    )
    assert [line.split(",")[1:3] for line in lines] == [["80.0", "1"], ["80.0", "2"], ["110.0", "1"], ["110.0", "2"]]


def test_a_misfire_takes_the_gas_of_a_cylinder_from_the_sheet(balcli):
    """As `gas = 0` in the file does."""
    text = MARINE.read_text(encoding="utf-8")
    sheet = ("--format", "marine", "--format", "csv")
    found = balcli("analyze", MARINE, *sheet, "--misfire", "3").out
    assert found == balcli("analyze", "-", *sheet, stdin=f"{text}\n[cylinder.3]\ngas = 0\n").out
    assert found != balcli("analyze", MARINE, *sheet).out
    told = balcli("analyze", MARINE, "--format", "marine", "--misfire", "3").out
    assert "\nno gas in  3\n" in told


# ------------------------------------------------------------------ power related unbalance
def sampled_moment(rpm: float, order: int) -> float:
    """Largest moment of an order about the crank's middle, N m."""
    curves = sampled(rpm)
    phasors = np.fft.fft(curves["moment_v"] + 1j * curves["moment_h"]) / SAMPLES
    return abs(phasors[order]) + abs(phasors[-order])


@pytest.mark.parametrize("speed", [(), ("--speed", "80")])
def test_the_power_related_unbalance_is_the_moment_at_the_rated_speed_over_the_power(balcli, speed):
    text = TEXT.replace("speed = 100", "speed = 100\noperation.power = 4000")
    said = json.loads(balcli("analyze", "-", "--only", "pru", "-f", "json", *speed, stdin=text).out)
    found = said["power_related_unbalance"]
    assert (found["power_W"], found["power_kind"]) == (4e6, "file")
    wanted = [sampled_moment(100, order) / 4000 for order in (1, 2)]
    assert [each["Nm_per_kW"] for each in found["orders"]] == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize(
    ("limit", "below", "above"),
    [(60, "not relevant", "unlikely"), (120, "unlikely", "likely"), (220, "likely", "most likely")],
)
def test_classes_of_need_change_at_their_limits(limit, below, above):
    power = sampled_moment(100, 1) / limit
    for share, need in ((1.001, below), (0.999, above)):
        engine = build_text(TEXT.replace("speed = 100", f"speed = 100\noperation.power = {share * power}"))
        assert relate_to_power(engine).orders[0].need == need


@pytest.mark.parametrize(
    ("keys", "kind"), [("imep = 16", "indicated"), ("bmep = 14\nmechanical_efficiency = 0.9", "brake")]
)
def test_without_a_power_that_of_the_gas_counts(keys, kind):
    gas = f'[gas]\ncycle = "diesel"\ncompression_ratio = 12\n{keys}\n'
    engine = build_text(TEXT.replace("mass = 3000.0", "mass = 3000.0\npiston.bore = 500") + gas)
    found = relate_to_power(engine)
    mean = 16e5 if kind == "indicated" else 14e5
    volume = 4 * np.pi / 4 * 0.25 * 2 * RADIUS
    assert (found.power_W, found.power_kind) == (pytest.approx(mean * volume * 100 / 60, rel=1e-9), kind)


def test_power_is_needed(balcli):
    assert balcli("analyze", "-", "--only", "pru", stdin=TEXT).err == "balcli: pru needs operation.power, or [gas]\n"
