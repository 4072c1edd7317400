"""Gas and inertia shake the crankshaft together: the published Diesel, misfires, half orders."""

import numpy as np
import pytest
from support.commands import ask_json, refusal
from support.diesel import INERTIAS, STIFFNESSES, write_diesel
from support.paths import write

BORE = 0.105
RADIUS = 0.0685
ROD = 0.207
RECIPROCATING = 2.521
ORDER = (1, 5, 3, 6, 2, 4)
# crank angle from firing (deg), pressure (bar): a rough diagram, linear between rows
DIAGRAM = [(0, 140), (10, 149), (30, 85), (60, 27), (130, 7), (180, 3), (540, 2.7), (690, 50)]


@pytest.fixture
def diesel(tmp_path):
    angles = range(0, 720, 10)  # with all corners among them
    pressures = np.interp(angles, *np.array([*DIAGRAM, (720, DIAGRAM[0][1])]).T)
    rows = "".join(f"{a},{p}\n" for a, p in zip(angles, pressures, strict=True))
    write(tmp_path / "p.csv", f"angle_deg,pressure_bar\n{rows}")
    return write(tmp_path / "diesel.toml", write_diesel(extra='[gas]\nindicator = "p.csv"\ncrankcase = 1\n'))


def torque(rpm, angle):
    """Of one cylinder that fires at 0, N m: gas and inertia, from the piston's speed."""
    lean = RADIUS * np.sin(angle) / ROD
    arm = RADIUS * np.sin(angle) * (1 + RADIUS * np.cos(angle) / (ROD * np.sqrt(1 - lean**2)))
    cycle = np.degrees(angle) % 720
    rows = np.array([*DIAGRAM, (720, DIAGRAM[0][1])]).T
    gas = (np.interp(cycle, *rows) - 1) * 1e5 * np.pi / 4 * BORE**2 * arm
    slope = np.gradient(arm**2, angle, edge_order=2)
    return gas - RECIPROCATING * (rpm * np.pi / 30) ** 2 / 2 * slope


def respond(rpm):
    """Half peak to peak of torque in each shaft by plain equations of motion, orders to 12."""
    count = 1 << 15
    angle = np.arange(count) * 4 * np.pi / count
    harmonics = 2 * np.fft.rfft(torque(rpm, angle))[1:25] / count
    omega = rpm * np.pi / 30
    curve = 0
    twist = np.eye(9)[:-1] - np.eye(9)[1:]
    stiffness = np.array(STIFFNESSES) * (1 + 0.035j)
    grounded = np.diag([0, 0, 2, 2, 2, 2, 2, 2, 0.0])
    for k, harmonic in enumerate(harmonics, 1):
        w = k / 2 * omega
        load = np.zeros(9, complex)
        for place, number in enumerate(ORDER):
            load[1 + number] = harmonic * np.exp(-1j * k * place * np.pi / 3)
        dynamic = (twist.T * stiffness) @ twist + 1j * w * grounded - w**2 * np.diag(INERTIAS)
        shafts = stiffness * (twist @ np.linalg.solve(dynamic, load))
        curve = curve + np.real(shafts[:, None] * np.exp(1j * k / 2 * angle))
    return np.ptp(curve, axis=1) / 2


@pytest.mark.parametrize("rpm", [1000, 2170])
def test_vibratory_torque_against_plain_equations(diesel, rpm):
    said = ask_json("torsion", diesel, "--speeds", rpm, "--orders", "0.5-12")["response"]
    found = [shaft["half_peak_to_peak_Nm"][0] for shaft in said["shafts"]]
    assert found == pytest.approx(respond(rpm), rel=5e-6)
    orders = [each["order"] for each in said["shafts"][0]["worst"]["orders"]]
    assert orders == [k / 2 if k % 2 else k // 2 for k in range(1, 25)]


def test_a_misfire_takes_away_the_gas_of_one_cylinder(diesel):
    """Its inertia stays; orders that cancelled before shake now. The sum of the angles of order 6 in
    line lacks its own.
    """
    asked = ("torsion", diesel, "--speeds", "1000", "--orders", "0.5-12")
    every = (f"--misfire={n}" for n in range(1, 7))
    whole, missing, none = (ask_json(*asked, *options)["response"] for options in ((), ("--misfire", "4"), every))
    assert missing["free_end_deg"][0] > 3 * whole["free_end_deg"][0]
    without = ask_json("torsion", "-", *asked[2:], stdin=write_diesel())["response"]
    found, exact = ([s["half_peak_to_peak_Nm"][0] for s in r["shafts"]] for r in (none, without))
    assert found == pytest.approx(exact, rel=1e-9)
    said, short = (ask_json("torsion", diesel, *options) for options in ((), ("--misfire", "1")))
    whole, missing = (
        next(c["phase_sum"] for c in each["criticals"] if (c["mode"], c["order"]) == (1, 6)) for each in (said, short)
    )
    shape = said["modes"][0]["shape"]
    assert whole == pytest.approx(sum(shape[2:8]))
    assert sum(shape[3:8]) < missing < whole


def test_misfires_that_cannot_be(diesel):
    assert refusal("torsion", diesel, "--misfire", "7") == "there is no cylinder 7: six has cylinders 1 to 6"
    assert "has no [gas]" in refusal("torsion", "-", "--misfire", "1", stdin=write_diesel())
    chain = '[[node]]\nname = "a"\ninertia = 1\n'
    assert refusal("torsion", "-", "--misfire", "1", stdin=chain) == ("--misfire: a chain has no cylinders")


def test_crank_inertia_is_shared_by_the_throws():
    """Instead of throw_inertia; that of the whole [crank], its throws included."""
    text = write_diesel().replace("throw_inertia = ", "# ")
    text = text.replace("spacing = 120", "spacing = 120\ninertia = 240000")
    nodes = ask_json("torsion", "-", stdin=text)["nodes"][2:8]
    assert {node["inertia_kg_m2"] for node in nodes} == {nodes[0]["inertia_kg_m2"]}
    assert nodes[0]["inertia_kg_m2"] == pytest.approx(0.04 + 0.006086026, rel=1e-7)


def test_two_strokes_have_whole_orders():
    text = (
        write_diesel().replace("[layout]\n", "[layout]\nstrokes = 2\n").replace("1, 5, 3, 6, 2, 4", "1, 6, 2, 4, 3, 5")
    )
    gas = '[gas]\ncycle = "wiebe"\ncompression_ratio = 15\nimep = 8\n[torsion]'
    criticals = ask_json("torsion", "-", stdin=text.replace("[torsion]", gas))["criticals"]
    assert all(isinstance(c["order"], int) for c in criticals)


def test_orders_above_twelve_that_contribute_are_used_and_named(diesel):
    """A cycle has sharp corners: order 12 was the last, whatever came after it."""
    chosen, to_12 = (
        ask_json("torsion", diesel, "--speeds", "1500,2500", *options) for options in ((), ("--orders", "0.5-12"))
    )
    assert to_12["orders"] == [k / 2 for k in range(1, 25)]
    assert max(chosen["orders"]) > 12
    assert {each["order"] for each in chosen["criticals"]} <= {*chosen["orders"]}
