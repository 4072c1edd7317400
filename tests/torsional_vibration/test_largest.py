"""Largest torques over a range of speeds, of resonances far narrower than the step of the speeds."""

from itertools import pairwise

import numpy as np
import pytest
from support.cases import cases
from support.chains import chain_text
from support.commands import ask_torsion
from support.diesel import write_diesel
from support.paths import ENGINES

from balcli import BalcliError, torsion
from balcli.core.peaks import find_swing
from balcli.engine.build import build
from balcli.engine.parse import parse
from balcli.forces.quantity import TargetQuantity
from balcli.torsional_vibration.build import build_engine_system, excite_engine
from balcli.torsional_vibration.motion import compute_curves
from balcli.torsional_vibration.quantity import Variants

GAS = '[gas]\ncycle = "wiebe"\ncompression_ratio = 16\nimep = 15\n'


def write_engine(loss: float, damper: str = "") -> str:
    text = write_diesel(extra=GAS).replace("damping = 2\n", "")
    text = text.replace("loss = 0.035", f"loss = {loss}")
    return text.replace('name = "pulley"\n', f'name = "pulley"\n{damper}\n')


def search_finely(text, shaft):
    """The largest half of peak to peak of a shaft, looked for every 0.5 rpm, then ever finer about
    the five highest of these peaks.
    """
    model = parse(text)
    engine = build(model)
    system = build_engine_system(model, engine, excite_engine(model, engine, None))

    def look(speeds):
        torques = compute_curves(system, speeds).phasors[:, :, : len(system.shafts)]
        return find_swing(system.excitation.orders, torques[:, :, shaft]).half

    speeds = np.linspace(1000, 3000, 4001)
    swings = look(speeds)
    inside = swings[1:-1]
    peaks = 1 + np.flatnonzero((inside >= swings[:-2]) & (inside >= swings[2:]))
    largest = swings.max()
    for peak in speeds[peaks[np.argsort(-swings[peaks])][:5]]:
        middle = peak
        for reach in (0.5, 0.02, 0.0008):
            near = np.clip(np.linspace(middle - reach, middle + reach, 101), 1000, 3000)
            there = look(near)
            middle = near[np.argmax(there)]
            largest = max(largest, there.max())
    return largest


@pytest.mark.slow
@cases("torsional_vibration/largest", "no_resonance_is_too_narrow_to_be_found")
def test_no_resonance_is_too_narrow_to_be_found(loss, damper):
    """A ring in thick oil and pendulums shift resonances, away from the modes without them."""
    text = write_engine(loss, damper)
    variants = Variants(parse(text), [TargetQuantity("shaft.flywheel.torque")])
    (found,) = variants.evaluate({})
    assert found == pytest.approx(search_finely(text, -1), rel=1e-6)


@pytest.mark.slow
def test_the_largest_of_an_answer_lies_between_its_speeds():
    """Torque, stress and swing of hardly damped shafts, 50 rpm apart and next to each other."""
    text = write_engine(0.005)
    coarse = ask_torsion(text, "--speeds", "1000:3000:50")["response"]
    by_name = {shaft["name"]: shaft["worst"] for shaft in coarse["shafts"]}
    worst = by_name["flywheel"]
    swing = coarse["free_end_worst"]
    assert worst["half_peak_to_peak_Nm"] == pytest.approx(search_finely(text, -1), rel=1e-6)
    beside_worst, beside_swing = (
        ask_torsion(text, "--speeds", f"{rpm - 0.5}:{rpm + 0.5}:0.01")["response"]
        for rpm in (worst["speed_rpm"], swing["speed_rpm"])
    )
    for shaft in beside_worst["shafts"]:
        told = by_name[shaft["name"]]
        torques = shaft["half_peak_to_peak_Nm"]
        if abs(told["speed_rpm"] - worst["speed_rpm"]) < 0.4:
            assert told["half_peak_to_peak_Nm"] == pytest.approx(max(torques), rel=1e-5)
        if "stress_Pa" in told:
            by_torque = shaft["stress_Pa"][0] / torques[0]
            assert told["stress_Pa"] == pytest.approx(told["half_peak_to_peak_Nm"] * by_torque)
    assert swing["half_swing_deg"] == pytest.approx(max(beside_swing["free_end_deg"]), rel=1e-5)
    assert swing["half_swing_deg"] > 1.5 * max(coarse["free_end_deg"])


THICK = 'damper = { kind = "viscous", inertia = 60000, damping = 50000 }'


def ask_barred(text, limit, speeds, *options):
    text = text.replace("[torsion]\n", f"[torsion]\nlimit = {limit!r}\n")
    return ask_torsion(text, "--speeds", speeds, *options)["barred_rpm"]


def test_no_barred_range_is_too_narrow_to_be_found():
    """Neither criticals nor speeds 100 rpm apart are near it: the ring shifts the resonance."""
    text = write_engine(0.005, THICK)
    coarse, fine = (ask_barred(text, 300, speeds, "--orders", "1-12") for speeds in ("1000:3000:100", "1780:1800:1"))
    (span,) = fine
    assert coarse == [pytest.approx(span, rel=1e-8)]


def test_between_two_barred_resonances_runs_are_allowed():
    """Asked at two speeds alone, all from the first resonance to the last was barred."""
    shafts = {ends: {"stiffness": 1e5, "diameter": 30} for ends in ("ab", "bc")}
    text = chain_text({"a": 0.1, "b": 0.2, "c": 0.05}, shafts, [("a", 1, 3)], loss=0.001, limit=10)
    fine, coarse = (ask_torsion(text, "--speeds", speeds) for speeds in ("5000:20000:10", "5000,20000"))
    assert len(fine["barred_rpm"]) == 2
    assert np.ravel(coarse["barred_rpm"]) == pytest.approx(np.ravel(fine["barred_rpm"]), rel=1e-6)


def test_beside_a_single_speed_nothing_is_looked_for(monkeypatch):
    """A chain of two hundred took eight seconds."""
    monkeypatch.delattr("balcli.torsional_vibration.response.find_poles")
    text = write_engine(0.005)
    for shaft in ask_torsion(text, "--speeds", "1790")["response"]["shafts"]:
        assert shaft["worst"]["speed_rpm"] == 1790
        assert [shaft["worst"]["half_peak_to_peak_Nm"]] == shaft["half_peak_to_peak_Nm"]


def test_a_limit_that_the_largest_stress_alone_passes_bars_its_speed():
    """Orders add up to it beside all speeds asked for, resonances and criticals."""
    plain = (ENGINES / "i6_diesel.toml").read_text(encoding="utf-8").replace("limit = 50 ", "# ")
    asked = ("1000:2500:100", "--orders", "0.5-12")
    shafts = ask_torsion(plain, "--speeds", *asked)["response"]["shafts"]
    worst = max((shaft["worst"] for shaft in shafts), key=lambda w: w.get("stress_Pa", 0))
    (span,) = ask_barred(plain, worst["stress_Pa"] / 1e6 * (1 - 1e-5), *asked)
    assert span[0] < worst["speed_rpm"] < span[1]
    assert ask_barred(plain, worst["stress_Pa"] / 1e6 * (1 + 1e-5), *asked) == []


def test_the_top_of_a_wide_resonance_between_the_speeds_is_barred():
    """The ring shifts the resonance from the criticals, and steps of 24 rpm show it anyway, but not its top."""
    plain = write_engine(0.05, THICK)
    few = ("--orders", "1-12")
    shafts = ask_torsion(plain, *few, "--speeds", "1700:1900:200")["response"]["shafts"]
    top = max((shaft["worst"] for shaft in shafts), key=lambda worst: worst.get("stress_Pa", 0.0))
    limit = 0.9995 * top["stress_Pa"] / 1e6
    middle = top["speed_rpm"]
    coarse, fine = (
        ask_barred(plain, limit, f"{middle - reach}:{middle + reach}:{step}", *few)
        for reach, step in ((84, 24), (12, 1))
    )
    assert len(fine) == 1
    assert np.ravel(coarse) == pytest.approx(np.ravel(fine), rel=1e-8)


def test_of_two_peaks_within_one_step_the_higher_is_found():
    """Order 1 swells as order 6.5 passes: one peak at 1195 rpm, a higher one 2 rpm on, with the
    speeds 100 rpm apart. Against plain equations of motion.
    """
    inertias = [18e4, 5e4, 15e4]
    stiffnesses = [9e4, 14e4]
    torques = [(2, 1, 83, 83), (0, 1.5, -64, -98), (2, 6.5, 81, -77), (0, 7.5, 18, -88)]
    drawn = [("abc"[node], *torque) for node, *torque in torques]
    text = chain_text({"a": 0.18, "b": 0.05, "c": 0.15}, {"ab": 9e4, "bc": 14e4}, drawn, loss=0.1)
    told = ask_torsion(text, "--speeds", "600:3000:100")["response"]["shafts"][0]["worst"]
    twist = np.array([[1, -1, 0], [0, 1, -1]])
    angle = np.arange(20000) * 4 * np.pi / 20000

    def swing(rpm):
        curve = 0
        for node, order, cos, sin in torques:
            w = order * rpm * np.pi / 30
            springs = (twist.T * (np.array(stiffnesses) * (1 + 0.1j))) @ twist
            dynamic = springs - w**2 * np.diag(inertias) / 1e6
            turned = np.linalg.solve(dynamic, np.eye(3)[node] * (cos - 1j * sin))
            curve = curve + np.real(9e4 * (1 + 0.1j) * (twist @ turned)[0] * np.exp(1j * order * angle))
        return np.ptp(curve) / 2

    largest = max(map(swing, np.arange(1190, 1200, 0.1)))
    assert told["half_peak_to_peak_Nm"] == pytest.approx(largest, rel=1e-6)
    assert told["speed_rpm"] == pytest.approx(1196.82, abs=0.1)


def test_a_peak_beside_its_resonance_is_found():
    """Two resonances side by side push the peaks of the first shaft away from both: the higher one
    passes what the shaft has at either resonance by far.
    """
    ring = {"kind": "viscous", "inertia": 11e4, "damping": 3.3}
    nodes = {"a": {"inertia": 38e3, "damping": 4.5, "damper": ring}, "b": 0.447, "c": 8.2, "d": 1.63}
    text = chain_text(nodes, {"ab": 1.1e6, "bc": 17e3, "cd": 45.3e3}, [("a", 1, 80)], loss=0.002)
    speeds = np.linspace(1830, 1850, 2001)
    w = speeds * np.pi / 30
    stiffness = np.array([1.1e6, 17e3, 45.3e3]) * (1 + 0.002j)
    twist = np.diff(np.eye(4), axis=0)
    dynamic = twist.T * stiffness @ twist - w[:, None, None] ** 2 * np.diag([0.038, 0.447, 8.2, 1.63])
    dynamic[:, 0, 0] += 4.5j * w - w**2 * 0.11 / (1 + 1j * w * 0.11 / 3.3)
    angle = np.linalg.solve(dynamic, np.array([[[80.0], [0], [0], [0]]]))[:, :, 0]
    torque = np.abs(stiffness[0] * (angle[:, 0] - angle[:, 1]))
    worst = torsion(text, np.linspace(1400, 6100, 6)).response.shafts[0].worst
    assert worst.half_peak_to_peak_Nm == pytest.approx(torque.max(), rel=1e-7)
    assert worst.speed_rpm == pytest.approx(speeds[torque.argmax()], abs=0.02)


@pytest.mark.slow
def test_the_largest_of_a_long_chain_are_those_of_close_speeds():
    """Forty random nodes and eight orders, asked every 37.5 rpm and every 0.2 rpm."""
    rng = np.random.default_rng(40)
    names = [f"n{k}" for k in range(40)]
    nodes = {each: rng.uniform(0.05, 0.3) for each in names}
    shafts = {ends: 10 ** rng.uniform(5.5, 6.5) for ends in pairwise(names)}
    torques = [(str(rng.choice(names)), k / 2, *rng.normal(size=2).tolist()) for k in range(1, 9)]
    tables = chain_text(nodes, shafts, torques, loss=0.01)
    coarse, fine = (torsion(tables, np.linspace(600, 1200, count)).response.shafts for count in (17, 3001))
    for few, many in zip(coarse, fine, strict=True):
        assert few.worst.half_peak_to_peak_Nm == pytest.approx(many.half_peak_to_peak_Nm.max(), rel=1e-3)


def write_disc(loss: float) -> str:
    """1 N m on a disc of 1 kg m2 on 10 kN m/rad."""
    shaft = {("disc", "wall"): {"stiffness": 1e4, "loss": loss}}
    return chain_text({"disc": 1, "wall": 0}, shaft, [("disc", 1, 1)], fixed=["wall"])


@pytest.mark.parametrize("loss", [0.0, 1e-11, 1e-9])
def test_what_hardly_anything_damps_has_no_bound(loss):
    """So narrow a resonance no search between the speeds climbs: of 1e-11 to a thousandth."""
    with pytest.raises(BalcliError, match=r"15\.9155 Hz is excited by order 1 at 954\.93 rpm"):
        torsion(write_disc(loss), [800, 1100])
    assert torsion(write_disc(loss), [960, 1100]).response.shafts


@pytest.mark.parametrize("loss", [3e-9, 1e-6])
def test_what_something_damps_is_found(loss):
    """At the resonance 1/loss times as much as 1 N m."""
    (shaft,) = torsion(write_disc(loss), [800, 1100]).response.shafts
    assert shaft.worst.half_peak_to_peak_Nm == pytest.approx(1 / loss, rel=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_barred_ranges_do_not_depend_on_the_steps_of_the_speeds(seed):
    """Random chains: steps of 25 and 100 rpm, and a dense grid of speeds."""
    draw = np.random.default_rng(seed)
    nodes = dict(zip("abcd", draw.uniform(0.02, 0.2, 4).tolist(), strict=True))
    springs = zip(("ab", "bc", "cd"), draw.uniform(5e3, 5e4, 3).tolist(), strict=True)
    shafts = {ends: {"diameter": 30, "stiffness": stiffness} for ends, stiffness in springs}
    orders = (0.5, 1, 1.5, 2, 3, 4.5)
    torques = [("abcd"[draw.integers(4)], order, *draw.normal(0, 0.5, 2).tolist()) for order in orders]
    text = chain_text(nodes, shafts, torques, loss=0.02)
    dense = ask_torsion(text, "--speeds", "1000:3000:1")["response"]
    stress = np.max([shaft["stress_Pa"] for shaft in dense["shafts"]], axis=0)
    tops = stress[1:-1][(stress[1:-1] > stress[:-2]) & (stress[1:-1] > stress[2:])]
    limit = 0.999 * (np.sort(tops)[len(tops) // 2] if len(tops) else stress.max())
    found = [
        ask_torsion(f"limit = {float(limit) / 1e6!r}\n{text}", "--speeds", f"1000:3000:{step}")["barred_rpm"]
        for step in (25, 100)
    ]
    assert np.array(found[1]) == pytest.approx(np.array(found[0]), rel=1e-8)
    speeds = np.array(dense["speeds_rpm"])
    inside = np.any([(speeds >= low) & (speeds <= high) for low, high in found[0]], axis=0)
    assert np.array_equal(inside, stress > limit)
    ends = [end for end in np.ravel(found[0]).tolist() if end not in (1000, 3000)]  # where the limit is just met
    at_ends = ask_torsion(text, "--speeds", ",".join(map(repr, ends)))["response"]["shafts"]
    assert np.max([shaft["stress_Pa"] for shaft in at_ends], axis=0) == pytest.approx(limit, rel=1e-6)
