"""Torque along the crankshaft against the sum of single cylinders; masses against a uniform rod."""

import math
import re

import numpy as np
import pytest
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.engines import GOOD, build_text, changed
from support.paths import ENGINES

from balcli import analyze, curves, load_example, torque
from balcli.analysis.crank_drive import find_journals, list_masses

BEARING = "[bearing]\nmain_diameter = 60\nmain_width = 20\npin_diameter = 50\npin_width = 20\npin_bore = 30\n"


@pytest.mark.parametrize("name", ["i4_wiebe", "v8_wiebe"])
def test_journals_carry_the_torque_of_the_throws_before_them(name):
    engine = load_example(name)
    each = {n: curves(engine, 0.5, cylinder=n).curves["torque_Nm"] for n in engine.numbers}
    throws = np.array(engine.joined_throw_of_rows)
    by_throw = [
        sum(each[n] for n, throw in zip(engine.numbers, throws, strict=True) if throw == k)
        for k in range(max(throws) + 1)
    ]
    before = np.zeros_like(by_throw[0])
    found = {journal.place: journal.total for journal in find_journals(engine)}
    for k, own in enumerate(by_throw, 1):
        for place, curve in ((f"main {k}", before), (f"pin {k}", before + own / 2)):
            total = found[place]
            assert total.max_Nm >= curve.max() - 1e-9
            assert (total.max_Nm, total.min_Nm) == pytest.approx(
                (curve.max(), curve.min()), abs=2e-3 * np.ptp(curve) + 1e-9
            )
            assert total.mean_Nm == pytest.approx(curve.mean(), abs=1e-3 * np.ptp(curve) + 1e-9)
        before = before + own
    last = found[f"main {len(by_throw) + 1}"]
    whole = torque(engine)
    assert last.mean_Nm == pytest.approx(whole.mean_torque_Nm, rel=1e-9)
    assert (last.max_Nm, last.min_Nm) == pytest.approx((whole.torque.max_Nm, whole.torque.min_Nm), rel=1e-7)
    assert found["main 1"].range_Nm == 0
    assert found["main 1"].max_deg is None


def test_the_stress_of_a_hollow_pin():
    engine = build_text(GOOD + BEARING)
    journals = {journal.place: journal for journal in find_journals(engine)}
    pin = journals["pin 2"]
    section = math.pi / 32 * (0.05**4 - 0.03**4)  # polar second moment of area
    assert pin.stress.amplitude_Pa == pytest.approx(pin.inertia.range_Nm / 2 * 0.025 / section)
    assert pin.position_mm == pytest.approx(-50)
    assert journals["main 5"].position_mm == pytest.approx(200)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (BEARING.replace("pin_bore = 30", "pin_bore = 50"), "pin_bore = 50 mm: has to be below pin_diameter = 50 mm"),
        ("[bearing]\nmain_bore = 10\n", "main_bore = 10 mm: has to be below main_diameter"),
    ],
)
def test_a_bore_is_smaller_than_its_journal(tmp_path, table, message):
    (tmp_path / "four.toml").write_text(GOOD + table)
    assert message in refusal("analyze", tmp_path / "four.toml")


def test_a_uniform_rod():
    """J = m L^2/12 about its middle; as a pendulum from its end it has the reduced length 2/3 L."""
    mass = 0.6
    length = 160.0
    text = changed(("cg = 45", f"cg = {length / 2}\ninertia = {mass * length**2 / 12}"))
    (one,) = list_masses(build_text(text))
    assert one.cylinders == (1, 2, 3, 4)
    assert (one.rod_small_end_kg, one.rod_big_end_kg) == pytest.approx((0.3, 0.3))
    assert one.reduced_length_m == pytest.approx(2 / 3 * 0.16)
    assert one.radius_of_gyration_m == pytest.approx(0.16 / math.sqrt(12))
    assert one.couple_constant_kg_m2 == pytest.approx(mass * 0.08**2 - mass * 0.16**2 / 12)
    assert one.throw_kg == pytest.approx(0.8)


def test_a_crosshead_moves_with_the_piston(tmp_path):
    crosshead = GOOD + "[crosshead]\nmass = 2\n[cylinder.3]\ncrosshead_mass = 3\n"
    first, third = list_masses(build_text(crosshead))
    assert (first.crosshead_kg, third.crosshead_kg, third.cylinders) == (2, 3, (3,))
    assert third.reciprocating_kg - first.reciprocating_kg == pytest.approx(1)
    heavier = build_text(GOOD.replace("mass = 0.5", "mass = 2.5"))
    same = build_text(GOOD + "[crosshead]\nmass = 2\n")
    np.testing.assert_allclose(analyze(same).spectra.force.vectors, analyze(heavier).spectra.force.vectors, rtol=1e-14)
    (tmp_path / "four.toml").write_text(crosshead)
    card = ask_json("balance", tmp_path / "four.toml", "--factor", "50%")["details"]["card"]
    assert card[0]["reciprocating_g"] == pytest.approx(1e3 * (0.5 + 2 + 0.6 * 45 / 160))


def test_tables_have_the_units_and_the_defaults_that_count():
    """Masses in pounds, and what the gas assumes above the torques that follow from it."""
    masses = ask("analyze", ENGINES / "i4_wiebe.toml", "--only", "masses", "--units", "imperial")
    assert re.search(rf"^piston, lb +{0.51 / 0.45359237:.4g}$", masses, re.MULTILINE)
    assert "Torque along the crankshaft" not in masses
    table = ask("analyze", ENGINES / "i4_wiebe.toml", "--only", "journals")
    assert "gas.compression_index = 1.32" in table
    assert "Torque along the crankshaft" in table
    rows = ask("analyze", "-", "--only", "masses", "-f", "csv", stdin=GOOD)
    assert "masses,,piston_kg,0.5,kg" in rows


def test_the_crank_of_a_rotary_engine_gives_no_torque_off():
    assert "journals: the crank of a rotary engine stands still" in refusal(
        "analyze", ENGINES / "rotary9.toml", "--only", "journals"
    )


def test_uneven_speed_does_not_count_and_nothing_is_largest_without_torque():
    uneven = GOOD + "speed_ripple = [{ order = 2, amplitude = 0.02 }]\n"
    assert "rpm, steady; the uneven speed of the file is not used" in ask(
        "analyze", "-", "--only", "journals", stdin=uneven
    )
    still = changed(("mass = 0.5", "mass = 0"), ("mass = 0.6", "mass = 0"))
    assert "The range is largest" not in run_here("analyze", "-", "--only", "journals", stdin=still).out


def test_a_misfire_counts_and_leaves_the_stress_known():
    journals = ask_json("analyze", ENGINES / "i4_wiebe.toml", "--only", "journals", "--misfire", "2")["journals"]
    whole = ask_json("analyze", ENGINES / "i4_wiebe.toml", "--only", "journals")["journals"]
    assert journals[2]["total"] == whole[2]["total"]  # in front of the throw of cylinder 2
    assert journals[4]["total"]["mean_Nm"] == pytest.approx(whole[2]["total"]["mean_Nm"])
    assert all("stress" in journal for journal in journals)


@pytest.mark.parametrize(("name", "split"), [("v6_90_split", True), ("v6_90_common", False)])
def test_split_pins_have_a_note(name, split):
    assert ("Split pins" in ask("analyze", ENGINES / f"{name}.toml", "--only", "journals")) == split


@pytest.mark.parametrize("name", ["i4", "i4_wiebe"])
def test_quantities_are_those_of_the_table(name):
    path = ENGINES / f"{name}.toml"
    names = ("journal.3.range", "journal.3.max", "journal.1.min", "pin.2.range")
    (row,) = ask_csv("sweep", path, "--vary", "operation.speed=4000", "-q", ",".join(names))
    journals = {
        one["place"]: one for one in ask_json("analyze", path, "--speed", "4000", "--only", "journals")["journals"]
    }
    for name_ in names:
        kind, number, part = name_.split(".")
        one = journals[f"{kind.replace('journal', 'main')} {number}"]
        torque = one.get("total") or one["inertia"]
        assert float(row[name_]) == pytest.approx(torque[f"{part}_Nm"], rel=1e-12)
    told = refusal("sweep", path, "--vary", "operation.speed=4000", "-q", "journal.6.max")
    assert told.endswith('journal.6.max: the file has no journal "6"; there are 1, 2, 3, 4, 5')
