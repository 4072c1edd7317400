"""`balcli torsion` of chains: every format says the same figures, and they are right."""

import re
from itertools import pairwise

import numpy as np
import pytest
from support import chains
from support.cases import cases
from support.chains import chain_text
from support.commands import ask_csv, ask_torsion, refusal, run_here
from support.diesel import write_diesel

from balcli.file.examples import template

CHAIN = template("torsion")  # the file to start from


def text_of(chain, damping, *torque):
    """A chain file of a chain of arrays."""
    nodes = {
        f"n{k}": {"inertia": inertia * 1e6, "damping": own}
        for k, (inertia, own) in enumerate(zip(chain.inertia.tolist(), damping.nodes.tolist(), strict=True))
    }
    shafts = {}
    gears = {}
    columns = (chain.start, chain.end, chain.ratio, chain.stiffness, damping.loss, damping.dashpots)
    for start, end, ratio, stiffness, loss, dashpot in zip(*(each.tolist() for each in columns), strict=True):
        name = f"n{start}"
        if ratio != 1:  # a mesh without mass, then the shaft
            name = f"n{len(nodes)}"
            nodes[name] = 0
            gears[f"n{start}", name] = ratio
        written = "rigid" if np.isinf(stiffness) else stiffness
        shafts[name, f"n{end}"] = {"stiffness": written, "loss": loss, "damping": dashpot}
    held = [f"n{k}" for k in np.flatnonzero(chain.clamped)]
    return chain_text(nodes, shafts, torque, gears, fixed=held)


@pytest.mark.parametrize("kind", ["plain", "geared", "branched", "clamped", "massless"])
def test_forced_vibration_against_50_digits(kind):
    """One order alone: half of peak to peak is the amplitude, of every shaft."""
    chain = chains.random_chain(kind, 5)
    damping = chains.random_damping(chain, 5)
    driven = int(np.flatnonzero(~chain.clamped & (chain.inertia > 0))[0])
    text = text_of(chain, damping, (f"n{driven}", 1.5, 30, -40))
    said = ask_torsion(text, "--speeds", "700,1900")["response"]
    load = np.zeros(len(chain.inertia), complex)
    load[driven] = 30 + 40j
    shafts = [shaft for shaft in said["shafts"] if shaft["sum_of_amplitudes_Nm"]]
    for k, rpm in enumerate((700, 1900)):
        angle, torques = chains.exact_response(chain, damping, 1.5 * rpm * np.pi / 30, load)
        meshes = np.count_nonzero(chain.ratio != 1)
        named = shafts[: len(shafts) - meshes]
        found = [shaft["half_peak_to_peak_Nm"][k] for shaft in named]
        assert found == pytest.approx(np.abs(torques), rel=1e-9, abs=1e-12 * np.abs(torques).max())
        swing = np.degrees(abs(angle[0]))
        assert said["free_end_deg"][k] == pytest.approx(swing, rel=1e-9, abs=1e-15)


def test_holzers_table_leads_to_the_clamped_end():
    """Of equal discs, one end fixed: `2 sqrt(k/J) sin((2 i - 1) pi/(2 (2 n + 1)))`."""
    nodes = {str(k): 1 if k == 1 else 20 for k in range(1, 7)}
    said = ask_torsion(chain_text(nodes, dict.fromkeys(pairwise(nodes), 125), fixed=["1"]), "--holzer", "2", "-q")
    exact = [2 * np.sqrt(125 / 20) * np.sin((2 * i - 1) * np.pi / 22) for i in range(1, 6)]
    assert [2 * np.pi * mode["frequency_Hz"] for mode in said["modes"]] == pytest.approx(exact, rel=1e-13)
    first, *_, last = said["holzer"][0]["rows"]
    assert (first["angle"], last["angle"]) == (pytest.approx(0, abs=1e-12), 1)


def test_csv_lists_the_figures_of_json():
    options = ("--speeds", "1000:1100:50", "--holzer", "2")
    said = ask_torsion(CHAIN, *options)
    lines = ask_csv("torsion", "-", *options, stdin=CHAIN)

    def values(part, figure, name=""):
        found = (x for x in lines if (x["part"], x["figure"]) == (part, figure) and x["name"] in (name, ""))
        return [float(x["value"]) for x in found]

    assert values("mode", "frequency") == [mode["frequency_Hz"] for mode in said["modes"]]
    first = said["response"]["shafts"][0]
    name = first["name"]
    worst = first["worst"]
    assert values("response", "half_peak_to_peak", name) == first["half_peak_to_peak_Nm"]
    assert values("worst", "half_peak_to_peak", name) == [worst["half_peak_to_peak_Nm"]]
    assert values("worst", "amplitude", name) == [each["amplitude_Nm"] for each in worst["orders"]]
    orders = [float(x["order"]) for x in lines if (x["name"], x["figure"]) == (name, "amplitude")]
    assert orders == [each["order"] for each in worst["orders"]]
    assert values("holzer", "residual") == [said["holzer"][0]["residual_Nm"]]


def test_a_swing_can_be_the_limit():
    text = CHAIN.replace("limit = 40", "angle_limit = 0.1", 1)
    said = ask_torsion(text, "--speeds", "800:1600:20")
    (span,) = said["barred_rpm"]
    assert span[0] == 800
    assert ask_torsion(text, "--speeds", repr(span[1]))["response"]["free_end_deg"] == pytest.approx([0.1])


def test_a_limit_of_stress_without_any_diameter_is_not_judged():
    """It said that no speed is barred."""
    text = re.sub(r"diameter = .*\nlength = .*", "stiffness = 9e4", CHAIN)
    text = re.sub(r"(?m)^(diameter|density) = .*\n", "", text)
    asked = ("torsion", "-", "--speeds", "800,1600")
    said = run_here(*asked, stdin=text).out
    assert "barred speeds" not in said
    assert "engine-flywheel, flywheel-pinion, wheel-pump: not checked (no diameter)." in said
    said = run_here(*asked, stdin=text.replace("limit = 40", "limit = 40\nangle_limit = 0.1")).out
    assert "limit          ±0.1 deg at engine\nbarred speeds  below " in said
    assert "wheel-pump: not checked (no diameter)." in said


def test_what_pendulums_leave_undamped_is_told():
    """1 kg m2 and pendulums with 2 kg (0.09 + 0.009)^2/(1 - 9/90) kg m2 in order 1, on a spring."""
    disc = {"inertia": 1e6, "damper": {"kind": "pendulum", "mass": 2, "radius": 90, "length": 9}}
    text = chain_text({"disc": disc, "wall": 0}, {("disc", "wall"): 1e4}, [("disc", 1, 100)], fixed=["wall"])
    hertz = np.sqrt(1e4 / (1 + 2 * 0.099**2 / 0.9)) / (2 * np.pi)
    assert refusal("torsion", "-", "--speeds", "850:1150:50", stdin=text) == (
        f"standard input: the natural frequency of {hertz:.6g} Hz is excited by order 1 at "
        f"{60 * hertz:.6g} rpm and nothing damps it: its vibration has no bound; give a loss factor "
        "(loss = 0.02), or damping"
    )
    assert run_here("torsion", "-", "--speeds", "950:1150:50", stdin=text).status == 0


def test_a_viscous_ring_takes_heat_as_power_is_fed():
    """Alone against the torque, it turns all power to heat."""
    hub = {"inertia": 2e5, "damper": {"kind": "viscous", "inertia": 5e4, "damping": 3}}
    text = chain_text({"hub": hub, "end": 0.7}, {("hub", "end"): 4e4}, [("end", 3, 20)])
    said = ask_torsion(text, "--speeds", "1500")["response"]
    w = 3 * 1500 * np.pi / 30
    ring = 0.05 / (1 + 1j * w * 0.05 / 3)
    k = 40000
    hub = -(w**2) * (0.2 + ring)
    end = -(w**2) * 0.7
    angle = np.linalg.solve(np.array([[k + hub, -k], [-k, k + end]]), [0, 20])
    power = w / 2 * (20 * np.conj(angle[1])).imag
    assert said["dampers"][0]["node"] == "hub"
    assert said["dampers"][0]["heat_W"] == pytest.approx([power])


def test_a_rubber_ring_takes_heat_as_power_is_fed():
    hub = {"inertia": 2e5, "damper": {"kind": "rubber", "inertia": 5e4, "stiffness": 3000, "loss": 0.2}}
    said = ask_torsion(chain_text({"hub": hub}, {}, [("hub", 1, 20)]), "--speeds", "1500")["response"]
    w = 1500 * np.pi / 30
    ring = 0.05 / (1 - w**2 * 0.05 / (3000 * (1 + 0.2j)))
    angle = 20 / (-(w**2) * (0.2 + ring))
    assert said["dampers"][0]["heat_W"] == pytest.approx([w / 2 * (20 * np.conj(angle)).imag])
    assert said["free_end_deg"] == pytest.approx([np.degrees(abs(angle))])


def test_a_tuned_pendulum_holds_its_node_still():
    """Tuned to the order of its own node: R/L = n^2, which turns half as fast: n = 4."""
    wheel = {"inertia": 3e5, "damper": {"kind": "pendulum", "mass": 2, "radius": 160, "length": 10}}
    tuned, detuned = (
        chain_text({"crank": 0.2, "wheel": wheel}, {}, [("crank", order, 20)], {("crank", "wheel"): 0.5})
        for order in (2, 2.5)
    )
    response = ask_torsion(tuned, "--speeds", "1500")["response"]
    assert response["free_end_deg"][0] < 1e-9
    # the wheel stands still against 40 N m: m R (R + L) times its speed squared for each rad
    swing = np.degrees(40 / (2 * 0.16 * 0.17 * (750 * np.pi / 30) ** 2))
    (pendulums,) = response["pendulums"]
    assert (pendulums["node"], pendulums["half_swing_deg"]) == ("wheel", pytest.approx([swing]))
    assert pendulums["worst"] == {"speed_rpm": 1500, "half_swing_deg": pytest.approx(swing), "order": 2}
    assert ask_torsion(detuned, "--speeds", "1500")["response"]["free_end_deg"][0] > 1e-4


@cases("torsional_vibration/command", "options_that_cannot_be")
def test_options_that_cannot_be(options, message):
    assert refusal("torsion", "-", *options, stdin=CHAIN) == message


def test_trial_frequencies_have_units():
    same = ("20 rad/s", "3.183098861837907 Hz", "190.98593171027443 rpm")
    tables = ask_torsion(CHAIN, *(word for each in same for word in ("--holzer", each)))["holzer"]
    assert [table["frequency_Hz"] for table in tables] == pytest.approx([10 / np.pi] * 3)


def test_orders_are_those_asked_for():
    said = ask_torsion(CHAIN, "--speeds", "2315", "--orders", "3-8")
    assert said["criticals"] == []  # order 4 meets no mode at this speed
    assert [x["order"] for x in said["response"]["shafts"][0]["worst"]["orders"]] == [4]


LONE = chain_text({"a": 1}, {}, [("a", 1, 3)])


def test_a_node_alone_swings_rigidly(tmp_path):
    """No shaft, no mode: what is left is `T/(J w^2)`."""
    said = ask_torsion(LONE, "--speeds", "100,200")
    assert (said["modes"], said["shafts"], said["criticals"]) == ([], [], [])
    swing = [np.degrees(3 / (rpm * np.pi / 30) ** 2) for rpm in (100, 200)]
    assert said["response"]["free_end_deg"] == pytest.approx(swing)
    out = run_here("torsion", "-", "--speeds", "100,200", stdin=LONE).out
    assert "None: no inertia can swing on a shaft." in out
    assert "a swings by ±1.567 deg at 100 rpm." in out
    assert refusal("torsion", "-", "--holzer", "1", stdin=LONE) == (
        "standard input: has 0 modes, but --holzer asks for mode 1"
    )
    asked = ("torsion", "-", "--speeds", "100,200")
    told = refusal(*asked, "--damper", "viscous", stdin=LONE)
    assert told == "--damper: the system has no mode that could be damped"
    assert run_here(*asked, "--plot", tmp_path / "lone.svg", stdin=LONE).status == 0
    assert run_here(*asked, "--plot", tmp_path / "lone.svg", "--what", "response", stdin=LONE).status == 0
    assert refusal(*asked, "--plot", tmp_path / "lone.svg", "--what", "waterfall", stdin=LONE) == (
        "--what waterfall: there is no shaft whose torque could be drawn"
    )


@pytest.mark.parametrize("fixed", ["a", "b"])
def test_at_a_fixed_node_the_angle_is_left_over(fixed):
    """The reaction stood there as left over, of a natural mode as well."""
    text = chain_text({"a": 2, "b": 2}, {"ab": 800}, fixed=[fixed])  # 20 rad/s
    out = run_here("torsion", "-", "--holzer", "1", "--holzer", "10 rad/s", stdin=text).out
    told = f"Left over at the end: an angle of (.*) at {fixed}, which is fixed"
    assert re.findall(f"^{told}\\.$", out, re.MULTILINE) == ["0", "0.75"]


@pytest.mark.parametrize("first", ["a", "hub"])
def test_a_mode_that_no_table_can_follow_has_none(first):
    """Two equal branches swing against each other, and the hub is at rest: torques of 1e16 or 14
    kN m were left over.
    """
    inertia = {"hub": 1, "b": 0.1, "c": 0.3, "a": 0.1}
    nodes = {first: inertia[first]} | inertia
    text = chain_text(nodes, {("hub", "a"): 1e4, ("hub", "b"): 1e4, ("hub", "c"): 1e5})
    told = refusal("torsion", "-", "--holzer", "1", stdin=text)
    assert "cannot be followed from" in told or "at resonance by itself" in told  # as rounding has it
    assert abs(ask_torsion(text, "--holzer", "2")["holzer"][0]["residual_Nm"]) < 1e-6


def test_a_node_that_stands_still_is_told():
    """Of three equal discs the one in the middle: "nodes 1, node in –" stood there."""
    three = dict.fromkeys("abc", 1), {"ab": 1e5, "bc": 1e5}
    text = chain_text(*three)
    held = chain_text(*three, fixed=["b"])
    first, second = ask_torsion(text)["modes"]
    assert (first["nodes"], first["node_in"], first["node_at"]) == (1, [], ["b"])
    assert (second["nodes"], second["node_in"], second["node_at"]) == (2, ["a-b", "b-c"], [])
    out = run_here("torsion", "-", "--holzer", "1", stdin=text).out
    assert [line.split()[3:] for line in out.splitlines() if line.startswith("1 ")] == [["1", "at", "b"]]
    assert re.search(r"(?m)^b +1 +0 +0 ", out.partition("Holzer's")[2]), "rounding errors stood there"
    assert [(mode["nodes"], mode["node_at"]) for mode in ask_torsion(held)["modes"]] == [(0, []), (0, [])]


@pytest.mark.parametrize("ratio", [-1.0, 1.0, -0.5])
def test_a_mesh_that_stands_still_is_one_node(ratio):
    """Alike on both sides of a mesh, as felt at its first wheel: "nodes 0, node in –" stood there."""
    discs = {"a": 0.1, "b": 0.001, "c": 0.001, "d": 0.1 / ratio**2}
    text = chain_text(discs, {"ab": 1e5, "cd": 1e5 / ratio**2}, gears={"bc": ratio})
    first, second = ask_torsion(text)["modes"]
    assert (first["nodes"], first["node_in"], first["node_at"]) == (1, [], ["b"])
    assert (second["nodes"], second["node_in"], second["node_at"]) == (2, ["a-b", "c-d"], [])


def test_loops_have_no_holzer_table():
    loop = chain_text({"a": 1e-6, "b": 2e-6, "c": 3e-6}, {"ab": 3, "bc": 3, "ac": 3})
    assert len(ask_torsion(loop)["modes"]) == 2
    assert refusal("torsion", "-", "--holzer", "1", stdin=loop) == (
        "standard input: --holzer: Holzer's table needs a chain in one piece, without loops"
    )


FOOT_POUND = 0.3048 * 0.45359237 * 9.80665
IMPERIAL = {  # SI units of the CSV: what stands instead, and its size
    "N m": ("lbf·ft", FOOT_POUND),
    "N m/rad": ("lbf·ft/rad", FOOT_POUND),
    "N m s/rad": ("lbf·ft·s/rad", FOOT_POUND),
    "kg m2": ("lb·in²", 0.45359237 * 0.0254**2),
    "Pa": ("psi", 0.45359237 * 9.80665 / 0.0254**2),
    "W": ("hp", 550 * FOOT_POUND),
    "kg": ("lb", 0.45359237),
    "m": ("in", 0.0254),
}


@pytest.mark.parametrize("kind", ["viscous", "pendulum"])
def test_imperial_figures_are_the_metric_ones_in_other_units(kind):
    size = ("--damper", kind, "--damper-at", "pulley", "--damper-inertia", "4000 kg mm^2")
    options = ("--speeds", "4300,4330", "--orders", "3", "--holzer", "1", *size, "--units")
    metric, imperial = (
        ask_csv("torsion", "-q", "-", *options, units, stdin=write_diesel()) for units in ("si", "imperial")
    )
    for si, ours in zip(metric, imperial, strict=True):
        name, size = IMPERIAL.get(si["unit"], (si["unit"], 1))
        assert ours | {"value": "", "unit": si["unit"]} == si | {"value": ""}
        assert ours["unit"] == name
        if si["value"] != ours["value"]:
            assert float(ours["value"]) == pytest.approx(float(si["value"]) / size, rel=1e-14)


def test_more_torques_than_are_kept_are_refused_with_the_number(monkeypatch):
    monkeypatch.setattr("balcli.torsional_vibration.motion.MOST_TORSION_TORQUES", 800)
    assert refusal("torsion", "-", "--speeds", "1000:2000", stdin=CHAIN) == (
        "808 torques (orders x speeds x shafts), but at most 800 can be kept: take fewer speeds or orders"
    )
