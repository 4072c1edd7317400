"""What new devices leave of the roll of an engine with gas: inertia and gas together."""

import json

import numpy as np
import pytest
from support.commands import ask_json, run_here
from support.engines import engine_text
from support.paths import write

from balcli.file import examples

# As of the file: crank radius, rod, bore (m), reciprocating mass (kg), crank speed (rad/s).
R = 0.043
L = 0.139
BORE = 0.086
MASS = 0.5
OMEGA = 4000 * np.pi / 30
COS = 2.0
SIN = 3.5  # bar, of order 2 of the mean tangential pressure of a cylinder
FILE = engine_text(
    crank="stroke = 86\nthrows = [0, 180, 180, 0]\nspacing = 94",
    rod="length = 139",
    piston="bore = 86\nmass = 0.5",
    layout="firing_order = [1, 3, 4, 2]",
    operation="speed = 4000",
    gas='harmonics = "tangential.csv"',
)


@pytest.fixture
def four(tmp_path):
    (tmp_path / "tangential.csv").write_text(f"order,cos,sin\n0,2,0\n0.5,1,3\n2,{COS},{SIN}\n")
    return str(write(tmp_path / "four.toml", FILE))


def find_second_order():
    """Phasors c of `Re c e^{2i theta}` of the roll (N m): of inertia, by the kinetic energy of four
    pistons on a grid, and of the gas.
    """
    theta = np.arange(256) * 2 * np.pi / 256
    waves = np.fft.fftfreq(256, 1 / 256)

    def derive(values):
        return np.fft.ifft(1j * waves * np.fft.fft(values)).real

    travel = R * np.cos(theta) + np.sqrt(L**2 - (R * np.sin(theta)) ** 2)
    torque = -derive(0.5 * MASS * (OMEGA * derive(travel)) ** 2)
    of_gas = 1e5 * np.pi / 4 * BORE**2 * R * complex(COS, -SIN)
    return -4 * 2 * np.fft.fft(torque)[2] / 256, -4 * of_gas


def test_shafts_that_cancel_the_roll_of_inertia_may_leave_more_with_gas(four):
    """Balance said that nothing was left, where the roll of the frame grew."""
    inertia, gas = find_second_order()
    asked = ("balance", four, "--scheme", "two-shaft", "--roll", "zero")
    found = ask_json(*asked)
    told = found["details"]["order_2"]
    assert told["roll_left_Nm"] == 0
    assert told["roll_before_Nm"] == pytest.approx(abs(inertia), rel=1e-12)
    assert told["roll_with_gas_left_Nm"] == pytest.approx(abs(gas), rel=1e-12)
    assert told["roll_with_gas_before_Nm"] == pytest.approx(abs(inertia + gas), rel=1e-12)
    for state, roll in (("before", inertia + gas), ("after", gas)):
        second = next(entry for entry in found[state]["orders"] if entry["order"] == 2)
        total = second["roll_total_Nm"]
        assert complex(total["cos"], -total["sin"]) == pytest.approx(roll, rel=1e-12)
    table = run_here(*asked).out
    growth = abs(gas) - abs(inertia + gas)
    assert growth > 0
    assert (
        f"The roll of order 2 with gas grows by {growth:.4g} N·m: the devices cancel inertia roll "
        "that opposes the gas roll at this speed." in " ".join(table.split())
    )
    assert "with gas," in table
    second = next(line for line in table.splitlines() if line.startswith("2  "))
    assert second.split()[-2:] == [f"{abs(inertia + gas):.4g}", f"{abs(gas):.4g}"]


def test_knuckle_angles_change_the_roll_of_the_gas_in_half_orders_too(tmp_path):
    """Before and after are those of the file, and of the one that is written."""
    gas = '[gas]\ncycle = "wiebe"\ncompression_ratio = 6\nimep = 8\n'
    radial = tmp_path / "radial.toml"
    even = tmp_path / "even.toml"
    radial.write_text(examples.text("radial7_articulated") + gas)
    asked = ("balance", radial, "--scheme", "knuckles", "--write", even, "-f", "json")
    found = json.loads(run_here(*asked).out)
    table = run_here(*asked[:4]).out
    assert "with gas," in table
    rows = {line[:6].strip(): line.split() for line in table.splitlines()}
    for state, file, column in (("before", radial, -2), ("after", even, -1)):
        told = {entry["order"]: entry["roll_total_Nm"] for entry in found[state]["orders"]}
        options = ("--only", "roll_total", "--orders", "3.5,7", "-f", "json")
        alone = json.loads(run_here("analyze", file, *options).out)
        for name, entry in zip(("3½", "7"), alone["orders"], strict=True):
            size = entry["roll_total_Nm"]["amplitude"]
            assert told[entry["order"]]["amplitude"] == pytest.approx(size, rel=1e-9)
            assert float(rows[name][column]) == pytest.approx(size, rel=1e-3)


def test_where_devices_add_roll_the_growth_is_that_with_gas(four):
    """Shafts at 120, 80 and 60, -40 mm: their forces along x make a roll about the crank axis."""
    inertia, gas = find_second_order()
    asked = ("balance", four, "--scheme", "two-shaft", "--at=120,80", "--at=60,-40")
    told = ask_json(*asked)["details"]["order_2"]
    theta = np.arange(256) * 2 * np.pi / 256
    travel = R * np.cos(theta) + np.sqrt(L**2 - (R * np.sin(theta)) ** 2)
    each = 4 * MASS * OMEGA**2 * 4 * np.fft.fft(travel)[2].real / 256  # a shaft's force, N
    added = -each * ((0.12 - 0.06) * 1j - (0.08 - 0.04))  # x Fy - y Fx of both
    assert told["roll_left_Nm"] == pytest.approx(abs(inertia + added), rel=1e-9)
    assert told["roll_with_gas_left_Nm"] == pytest.approx(abs(inertia + gas + added), rel=1e-9)
    said = run_here("balance", "-", *asked[2:], stdin=FILE.partition("[gas]")[0]).out
    assert "roll, N·m      after" in said or "roll of orders" in said
    assert "with gas" not in said


@pytest.mark.parametrize(("at", "grows"), [("0,-80", True), ("0,80", False)])
def test_a_slider_beside_the_crank_is_told_where_it_adds_roll(four, at, grows):
    asked = ("balance", four, "--scheme", "slider", f"--at={at}")
    told = ask_json(*asked)["details"]
    grown = told["roll_with_gas_left_Nm"] - told["roll_with_gas_before_Nm"]
    assert (grown > 0) == grows
    said = f"The roll of order 2 with gas grows by {grown:.4g} N·m: "
    assert (said in " ".join(run_here(*asked).out.split()) + " ") == grows
