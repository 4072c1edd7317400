"""Tolerances of shafts and inertias."""

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask_json, refusal, run_here
from support.paths import write

TWO = """
name = "one throw and a wheel"
crank.stroke = 80
rod = { length = 140, mass = 0, cg = 0 }
piston.mass = 0.4
[torsion]
throw_inertia = 20000
loss = 0.05
rear = [{ name = "wheel", inertia = 30000, stiffness = 2e5, diameter = 40 }]
"""
THREE = """
crank.stroke = 100
rod = { length = 165, mass = 0.9, cg = 50 }
piston = { bore = 86, mass = 0.6 }
operation.speed = 3000
layout.firing_order = [1, 3, 2]
gas = { cycle = "wiebe", compression_ratio = 10, imep = 9 }
[torsion]
throw_stiffness = 0.9e6
throw_inertia = 20000
damping = 1.5
loss = 0.03
rear = [{ name = "wheel", inertia = 300000, diameter = 70, length = 200 }]
"""


def test_two_inertias_by_hand():
    """`f = sqrt(k (1/J1 + 1/J2))/2 pi`, with the same random numbers."""
    options = ("--samples", "60", "--seed", "5", "--stiffness-scatter", "8%", "--mass-scatter", "2%")
    found = ask_json("scatter", "-", "-q", "torsion.1.Hz", *options, stdin=TWO)["quantities"]["torsion.1.Hz"]
    names = ["inertia throw 1", "stiffness wheel", "inertia wheel", "piston mass 1"]
    assert {*found["sensitivity"]} == {*names}
    theta = np.linspace(0, 2 * np.pi, 4096, endpoint=False)
    across = 0.04 * np.sin(theta)
    travel = across * (1 + 0.04 * np.cos(theta) / np.sqrt(0.14**2 - across**2))
    gear = 0.4 * np.mean(travel**2)
    shares = 2 * np.random.default_rng(5).random((60, 4)) - 1
    one, spring, two, piston = 1 + (shares * [0.02, 0.08, 0.02, 0.02]).T
    mass = 1 / (0.02 * one + gear * piston) + 1 / (0.03 * two)
    hertz = np.sqrt(2e5 * spring * mass) / (2 * np.pi)
    assert found["mean"] == pytest.approx(hertz.mean(), rel=1e-12)
    assert found["max"] == pytest.approx(hertz.max(), rel=1e-12)
    assert found["p05"] == pytest.approx(np.percentile(hertz, 5), rel=1e-12)
    nominal = np.sqrt(2e5 * (1 / (0.02 + gear) + 1 / 0.03)) / (2 * np.pi)
    assert found["nominal"] == pytest.approx(nominal, rel=1e-12)
    assert found["sensitivity"]["stiffness wheel"] == pytest.approx(nominal * 0.04, rel=1e-2)
    assert -0.01 * nominal < found["sensitivity"]["piston mass 1"] < 0


def test_a_plain_shaft_with_a_density_deviates_and_keeps_its_inertia(tmp_path):
    """It was refused, as its length was replaced by a stiffness."""
    heavy = THREE.replace("length = 200", "length = 200, density = 7.85")
    path = write(tmp_path / "heavy.toml", heavy)
    asked = ("scatter", path, "--samples", "3", "--seed", "1", "-q", "torsion.1.Hz", "--stiffness-scatter", "8%")
    found = ask_json(*asked)["quantities"]["torsion.1.Hz"]
    assert found["nominal"] == ask_json("torsion", path)["modes"][0]["frequency_Hz"]
    low, high = (
        ask_json("torsion", "-", stdin=heavy.replace("7.85", f"7.85, shear_modulus = {79.3 * share}"))
        for share in (0.92, 1.08)
    )
    change = (high["modes"][0]["frequency_Hz"] - low["modes"][0]["frequency_Hz"]) / 2
    assert found["sensitivity"]["stiffness wheel"] == pytest.approx(change, rel=1e-9)


def test_every_throw_deviates_by_itself_and_with_gas(tmp_path):
    path = write(tmp_path / "three.toml", THREE)
    asked = ("scatter", path, "--samples", "3", "--seed", "1", "-q", "torsion.1.Hz")
    found = ask_json(*asked)["quantities"]["torsion.1.Hz"]
    assert {*found["sensitivity"]} == {
        *("stiffness throw 1-2", "stiffness throw 2-3", "stiffness wheel", "inertia wheel"),
        *(f"{what} {k}" for what in ("inertia throw", "piston mass") for k in (1, 2, 3)),
    }
    assert found["p05"] < found["p95"]
    assert "Spread of 3 random crankshafts" in run_here(*asked).out


def test_stress_of_a_shaft_scatters(tmp_path):
    said = ask_json("scatter", write(tmp_path / "three.toml", THREE), "-q", "shaft.wheel.stress", "--samples", "3")
    found = said["quantities"]["shaft.wheel.stress"]
    assert 0 < found["p05"] < found["p95"]


@cases("torsional_vibration/quantity", "what_does_not_scatter")
def test_what_does_not_scatter(tmp_path, quantity, options, told):
    assert refusal("scatter", write(tmp_path / "two.toml", TWO), "-q", quantity, *options) == told
