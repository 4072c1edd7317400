"""`balcli torque`: what it prints in every format, and what it refuses."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.gas_engines import FOUR, WIEBE
from support.paths import ENGINES, write

from balcli import analyze, load

TORQUE = "angle_deg,torque_Nm\n0,0\n90,1000\n180,0\n360,0\n"
WHOLE = {"assumed", "format", "version", "speed_rpm", "cycle_deg", "imep_Pa", "max_pressure_Pa", "max_pressure_deg"}
WHOLE |= {"mean_torque_Nm", "power_W", "torque", "orders", "energy"}


@pytest.fixture
def four(tmp_path):
    more = "mechanical_efficiency = 0.8\n[flywheel]\ninertia = 200000\n"
    return str(write(tmp_path / "four.toml", FOUR + WIEBE + more))


@pytest.fixture
def curve(tmp_path):
    return str(write(tmp_path / "press.csv", TORQUE))


def test_json_and_csv_have_what_the_file_allows(four):
    found = ask_json("torque", four, "--fluctuation", "1/300")
    assert set(found) == WHOLE | {"bmep_Pa", "flywheel"}
    assert found["format"] == "balcli.torque/1"
    assert found["imep_Pa"] == pytest.approx(9e5)
    assert found["bmep_Pa"] == pytest.approx(7.2e5)
    assert set(found["torque"]) == {"max_Nm", "max_deg", "min_Nm", "min_deg", "reversals"}
    assert set(found["energy"]) == {"surplus_J", "from_deg", "to_deg", "work_J"}
    assert set(found["flywheel"]) == {
        *("inertia_kg_m2", "moving_parts_kg_m2", "fluctuation", "fluctuation_small"),
        *("needed_kg_m2", "speed_max_rpm", "speed_min_rpm"),
    }
    assert [entry["order"] for entry in found["orders"]] == [n / 2 for n in range(1, 25)]
    kinds = {"gas_torque_Nm", "inertia_torque_Nm", "torque_Nm"}
    assert set(found["orders"][0]) == kinds | {"order", "one_cylinder"}
    assert set(found["orders"][0]["one_cylinder"]) == kinds
    assert found["orders"][0]["gas_torque_Nm"]["balanced"]
    assert set(ask_json("torque", "-", stdin=FOUR + WIEBE)) == WHOLE
    lines = ask("torque", four, "--misfire", "3", "--misfire", "1", "--format", "csv").splitlines()
    assert lines[0] == "cylinder,quantity,order,figure,value,unit"
    assert "0,engine,,no_gas_in,1 3," in lines
    begins = (
        "0,flywheel,,fluctuation,0.",
        "1,gas,0.5,amplitude,",
        "0,torque_total,2,peak_deg,",
        "0,torque_total,,max,",
    )
    assert [begin for begin in begins if not any(line.startswith(begin) for line in lines)] == []
    for command in ("torque", "analyze"):
        assert ask_json(command, four, "--misfire", "3")["no_gas_in"] == [3]
        assert "no_gas_in" not in ask_json(command, four)
    assert "no gas in" in run_here("analyze", four, "--misfire", "3", "--only", "gas").out


def test_what_is_written_turns_as_unevenly(four, tmp_path):
    out = tmp_path / "uneven.toml"
    ask("torque", four, "--write", out)
    assert "order = 2, amplitude = 0.0" in out.read_text()
    found = ask_json("analyze", out, "--only", "force", "-q")  # without crank.inertia
    assert found["orders"][0]["order"] == 0, "an uneven speed has a mean force"
    again = ask_json("torque", out, "-q")
    assert again == ask_json("torque", four), "torque is that of the mean speed"


def test_at_the_speed_that_is_written_the_torque_is_constant(tmp_path):
    """Energy: gas and inertia of all turning parts leave the mean torque, which the load takes."""
    out = tmp_path / "uneven.toml"
    ask("torque", ENGINES / "i4_wiebe.toml", "--write", out)
    found = analyze(load(out), range(1, 13), "torque_total,gas").spectra
    assert found.torque_total.major.max() < 1e-8 * found.gas.major.max()


def test_a_crank_that_stalls_is_an_error_with_the_angle_next_to_all_else(four, curve, tmp_path):
    for arguments in ((four, "--speed", "100"), ("--curve", curve, "--inertia", "1", "--speed", "9")):
        status, out, err = run_here("torque", *arguments)
        assert status == 2
        assert "Torque over the cycle" in out
        name = arguments[0] if arguments[0] == four else curve
        stall = r"the shaft stalls at \d+\.\d°: with this inertia it needs a mean speed above \d+"
        assert re.match(rf"balcli: {re.escape(str(name))}: {stall}", err)
        status, out, _ = run_here("torque", *arguments, "--format", "json")
        assert status == 2
        assert json.loads(out)["flywheel"]["stall"] in err
        found = ask_json("torque", *arguments, "--fluctuation", "1/50")["flywheel"]
        assert set(found) == {"inertia_kg_m2", "moving_parts_kg_m2", "needed_kg_m2", "stall"}
    told = refusal("torque", four, "--speed", "100", "--write", tmp_path / "out.toml")
    assert told.startswith("--write: the shaft stalls at")


def test_a_curve_needs_no_engine(curve, tmp_path):
    found = ask_json("torque", "--curve", curve)
    assert set(found) == {"format", "version", "cycle_deg", "mean_torque_Nm", "torque", "orders", "energy"}
    assert found["mean_torque_Nm"] == pytest.approx(250)
    assert found["cycle_deg"] == 360
    assert found["torque"]["max_Nm"] == 1000
    assert found["energy"]["work_J"] == pytest.approx(250 * 2 * np.pi)
    assert set(found["orders"][0]) == {"order", "torque_Nm"}
    arguments = ("--curve", curve, "--speed", "300", "--inertia", "2e6", "--fluctuation", "1/100")
    text = ask("torque", *arguments)
    assert "Flywheel\ninertia      2 kg·m²" in text
    assert ask("torque", *arguments[:5], "2 kg m^2", *arguments[6:]) == text
    several = write(tmp_path / "t.csv", "angle_deg,torque_Nm\n0,1\n300,5\n1080,1\n")
    orders = ask_json("torque", "--curve", several)["orders"]
    assert [entry["order"] for entry in orders[:3]] == pytest.approx([1 / 3, 2 / 3, 1])


def test_the_load_takes_its_share_wherever_its_rows_begin(curve, tmp_path):
    """A triangle at 30 deg is there in any rows, and a load that is the torque itself leaves nothing over."""
    rows = ("0,50\n30,80\n60,50\n360,50", "-90,50\n0,50\n30,80\n60,50\n270,50")
    paths = [write(tmp_path / f"{k}.csv", f"angle_deg,torque_Nm\n{text}\n") for k, text in enumerate(rows)]
    for path in paths:
        one = ask_json("torque", "--curve", path)
        assert one["torque"]["max_deg"] == pytest.approx(30)
        assert one["orders"][0]["torque_Nm"]["peak_deg"] == pytest.approx(30)
        ends = [one["energy"][key] for key in ("from_deg", "to_deg")]
        assert ends == pytest.approx([30 - 30 * (1 - 1 / 12), 30 + 30 * (1 - 1 / 12)])
    for torque, taken in ((paths[0], paths[1]), (curve, curve)):
        energy = ask_json("torque", "--curve", torque, "--load", taken)["energy"]
        assert energy["surplus_J"] == pytest.approx(0, abs=1e-9)
    assert energy["work_J"] == pytest.approx(250 * 2 * np.pi), "that of the torque"
    other = write(tmp_path / "l.csv", "angle_deg,torque_Nm\n0,250\n720,250\n")
    told = refusal("torque", "--curve", curve, "--load", other)
    assert "--load: has a period of 720 deg, the torque 360 deg; give both over the same angle" in told


IN_OTHER_UNITS = {  # NIST SP 811 (2008), appendix B.8, but for the last: pound times square inch
    "N": ("lbf", 4.4482216152605),
    "N·m": ("lbf·ft", 1.3558179483314004),
    "J": ("lbf·ft", 1.3558179483314004),
    "Pa": ("psi", 6894.757293168361),
    "W": ("hp", 745.6998715822702),
    "kg·m²": ("lb·in²", 0.45359237 * 0.0254**2),
}


def test_imperial_figures_are_the_metric_ones_in_other_units(four):
    """Pressure, power, work and inertia, too: in tables and CSV. Assumed values keep the units of the file."""
    bearings = "[bearing]\npin_diameter = 48\npin_width = 20\nmain_diameter = 60\nmain_width = 22\n"
    with open(four, "a") as file:
        file.write(bearings)
    asked = (four, "--fluctuation", "1/300", "--loads", "pin,main")

    def rows(*more):
        return ask_csv("torque", *asked, *more)

    units = set()
    for si, imperial in zip(rows(), rows("--units", "imperial"), strict=True):
        name, size = IN_OTHER_UNITS.get(si["unit"], (si["unit"], 1.0))
        assert imperial | {"value": "", "unit": si["unit"]} == si | {"value": ""}
        assert imperial["unit"] == name
        if name != si["unit"]:
            assert float(imperial["value"]) == pytest.approx(float(si["value"]) / size, rel=1e-14)
            units.add(name)
    assert units == {name for name, _ in IN_OTHER_UNITS.values()}
    table = ask("torque", *asked, "--units", "imperial")
    assumed = re.compile(r"^assumed .*(\n .*)*", re.M)
    assert "intake = 1 bar" in " ".join(table.split())
    assert not re.search(r"\b(N|J|kJ|N·m|bar|kW|kg·m²|N/mm²)\b", assumed.sub("", table))
    assert re.search(r"^mean pressure +130\.5 psi indicated, 104\.4 psi brake$", table, re.M)
    metric = ask("torque", *asked)
    assert re.search(r"^mean pressure +9 bar indicated, 7\.2 bar brake$", metric, re.M)


@cases("shell/torque", "what_is_refused")
def test_what_is_refused(four, curve, arguments, told):
    assert told in refusal("torque", *(a.format(four=four, curve=curve) for a in arguments))


@cases("shell/torque", "an_engine_without_gas_is_refused_by_its_file")
def test_an_engine_without_gas_is_refused_by_its_file(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bare.toml").write_text(f'name = "four"\n{FOUR}')
    (tmp_path / "gas.toml").write_text(FOUR + WIEBE)
    assert run_here(*command.split()) == (
        2,
        "",
        "balcli: bare.toml: has no [gas]; give a diagram, a cycle or harmonics, such as "
        'cycle = "wiebe", compression_ratio = 10.5, imep = 10\n',
    )


# ------------------------------------------------------------------ loads and curves
def test_loads_are_told_when_they_are_asked_for(tmp_path):
    path = tmp_path / "four.toml"
    bearing = "[bearing]\npin_diameter = 48\npin_width = 20\n"
    path.write_text(FOUR + WIEBE + bearing)
    loads = ask_json("torque", path, "--loads", "pin,main")["loads"]
    assert [pin["cylinder"] for pin in loads["pin"]] == [1, 2, 3, 4]
    assert [main["bearing"] for main in loads["main"]] == [1, 2, 3, 4, 5]
    for pin in loads["pin"]:
        assert pin["pressure_Pa"] == pytest.approx(pin["max_N"] / 960e-6)
    assert set(loads["main"][0]) == {"bearing", "position_mm", "max_N", "max_deg", "mean_N"}
    text = ask("torque", path, "--loads", "pin")
    assert "Crank pins\ncylinder   largest, kN   at, deg   mean, kN   N/mm²" in text
    assert "Main bearings" not in text
    rows = ask("torque", path, "--loads", "pin,main", "-f", "csv").splitlines()
    assert any(row.startswith("2,pin,,max,") for row in rows)
    assert any(row.startswith("0,main,3,mean,") for row in rows)
    status, _, err = run_here("torque", path, "--loads", "wrist")
    assert (status, err) == (2, "balcli: --loads: 'wrist'; choose from pin, main, rod\n")


# ------------------------------------------------------------------ sweeps and pictures
def test_curves_of_an_engine_have_the_gas_torque_over_the_cycle(four, tmp_path):
    cylinder = ask_json("curves", four, "--cylinder", "3", "--step", "5")["curves"]
    names = {"pressure_Pa", "volume_m3", "gas_force_N", "side_thrust_N", "rod_force_N", "pin_x_N"}
    assert names | {"pin_y_N", "torque_Nm"} <= set(cylinder)
    assert len(cylinder["torque_Nm"]) == 144
    found = ask_json("curves", four, "--step", "4")
    curves = found["curves"]
    assert len(found["crank_deg"]) == 180
    orders = ask_json("torque", four, "--orders", "0-80")["orders"]
    for name in ("gas_torque_Nm", "inertia_torque_Nm", "torque_Nm"):
        angle = np.radians(found["crank_deg"])
        waves = [
            entry[name]["cos"] * np.cos(entry["order"] * angle) + entry[name]["sin"] * np.sin(entry["order"] * angle)
            for entry in orders
        ]
        size = np.abs(curves[name]).max()
        assert sum(waves) == pytest.approx(curves[name], abs=5e-3 * size)
    rolled = np.array(curves["couple_Nm"]) - curves["torque_Nm"]
    assert curves["roll_total_Nm"] == pytest.approx(rolled, abs=1e-9 * np.abs(rolled).max())
    bare = write(tmp_path / "bare.toml", FOUR)
    assert "gas" not in run_here("curves", bare).out
    assert len(run_here("curves", bare, "--step", "4").out.splitlines()) == 91


def test_sweeps_of_gas_and_torque_are_what_torque_says(four, tmp_path):
    """Each variant as if the file said so."""
    asked = "gas.1.5.amplitude,torque.2.amplitude,roll_total.2.cos,torque.mean,torque.max,fluctuation"
    lines = run_here("sweep", four, "--vary", "gas.imep=6,9", "--vary", "cylinder.3.gas=0,1", "--quantity", asked)
    assert lines.err == ""
    header, *rows = lines.out.splitlines()
    assert header == f"gas.imep,cylinder.3.gas,{asked}"
    text = Path(four).read_text().replace("imep = 9", "imep = 6") + "[cylinder.3]\ngas = 0\n"
    other = write(tmp_path / "other.toml", text)
    found = ask_json("torque", other, "--orders", "0.5-2")
    by_order = {entry["order"]: entry for entry in found["orders"]}
    row = [float(cell) for cell in rows[0].split(",")]
    assert row[:2] == [6, 0]
    assert row[2] == pytest.approx(by_order[1.5]["gas_torque_Nm"]["amplitude"], rel=1e-12)
    assert row[3] == pytest.approx(by_order[2]["torque_Nm"]["amplitude"], rel=1e-12)
    assert row[4] == pytest.approx(-by_order[2]["torque_Nm"]["cos"], rel=1e-9)
    assert row[5] == pytest.approx(found["mean_torque_Nm"], rel=1e-12)
    assert row[6] == pytest.approx(found["torque"]["max_Nm"], rel=1e-12)
    assert row[7] == pytest.approx(found["flywheel"]["fluctuation"], rel=1e-9)
    bare = write(tmp_path / "bare.toml", FOUR)
    asked = ("--vary", "rod.length=140,150", "--quantity")
    assert ask("sweep", bare, *asked, "torque.2.amplitude").startswith("rod.length,torque.2.amplitude")
    assert refusal("sweep", bare, *asked, "gas.2.amplitude") == f"{bare}: gas.2.amplitude: the engine file has no [gas]"


# ------------------------------------------------------------------ other commands
@pytest.mark.slow
def test_what_names_a_file_beside_it_is_written_beside_it(tmp_path):
    """A diagram would be left behind, unless the other folder has it as well."""
    (tmp_path / "far").mkdir()
    rows = "\n".join(f"{angle},{5 if angle == 10 else 1}" for angle in range(0, 721, 10))
    write(tmp_path / "p.csv", f"angle_deg,pressure_bar\n{rows}\n")
    shaft = 'name = "flywheel"\ninertia = 9e6\nstiffness = 1e6\ndiameter = 60\n'
    more = f"[torsion]\nthrow_stiffness = 1e6\nthrow_inertia = 3e4\n[[torsion.rear]]\n{shaft}"
    wanted = '[gas]\nindicator = "p.csv"\n[flywheel]\ninertia = 9e6\n'
    path = write(tmp_path / "four.toml", FOUR.replace("throws = [0, 180, 180, 0]\n", "") + wanted + more)
    commands = (
        ("torque",),
        ("balance",),
        ("torsion", "--damper", "viscous", "--speeds", "1000:2000:500", "--damper-inertia", "2e6"),
        ("search", "--over", "firing_order", "--minimise", "force.1.major"),
    )
    for command, *options in commands:
        far = tmp_path / "far" / "out.toml"
        told = refusal(command, path, *options, "--write", far)
        assert told == f'{far}: first copy "p.csv", which the file names, from {tmp_path}'
        assert not far.exists()
    (tmp_path / "far" / "p.csv").write_bytes((tmp_path / "p.csv").read_bytes())
    for folder in (tmp_path, tmp_path / "far"):
        for command, *options in commands:
            written = folder / f"{command}.toml"
            assert run_here(command, path, *options, "--write", written)[::2] == (0, "")
            assert run_here("torque", written).status == 0


@pytest.mark.parametrize("only", ["gas", "inner", "guide"])
def test_engines_of_different_cycles_are_compared_by_the_orders_of_both(tmp_path, only):
    """A misfire makes half orders, which a two-stroke engine does not have."""
    four = tmp_path / "four.toml"
    two = tmp_path / "two.toml"
    four.write_text(FOUR + WIEBE + "[cylinder.3]\ngas = 0\n")
    two.write_text(FOUR.replace("firing_order = [1, 3, 4, 2]", "strokes = 2") + WIEBE)
    found = ask_json("compare", four, two, "--only", only)
    halves = [line for line in found["figures"] if (line["order"] or 0) % 1]
    assert halves
    assert all(line["values"][0] > 0 and line["values"][1] == 0 for line in halves)


def test_guide_moments_include_the_gas(four, tmp_path):
    arguments = ("--only", "guide", "--orders", "0.5-4", "-f", "json")
    found = json.loads(run_here("analyze", four, *arguments).out)["guide"]
    assert found["includes"] == "inertia and gas"
    roll = ask_json("analyze", four, "--orders", "2", "--only", "gas")
    by_order = {entry["order"]: entry for entry in found["orders"]}
    assert by_order[2]["h_Nm"]["amplitude"] == pytest.approx(roll["orders"][0]["roll_total_Nm"]["amplitude"], rel=1e-12)
    assert by_order[0.5]["h_Nm"]["balanced"]
    assert by_order[0.5]["x_Nm"]["amplitude"] > 1


@cases("shell/torque", "curves_that_cannot_be")
def test_curves_that_cannot_be(tmp_path, content, told):
    path = write(tmp_path / "t.csv", content)
    assert told in refusal("torque", "--curve", path)


@cases("shell/torque", "one_curve_in_other_words")
def test_one_curve_in_other_words(tmp_path, text):
    path = write(tmp_path / "t.csv", "angle_deg,torque_Nm\n0,1.5\n90.5,-2.25\n360,1.5\n")
    plain = ask("torque", "--curve", path)
    path.write_text(text)
    assert ask("torque", "--curve", path) == plain


@cases("shell/torque", "quantities_that_are_none")
def test_quantities_that_are_none(four, text, message):
    err = run_here("sweep", four, "--vary", "gas.imep=6,9", "--quantity", text).err
    assert err == f"balcli: {text} is not a quantity: {message}\n"


def test_a_dummy_first_cylinder_does_not_stand_for_all(tmp_path: Path) -> None:
    file = tmp_path / "opposed.toml"
    gas = '[gas]\ncycle = "diesel"\ncompression_ratio = 12\nimep = 6\n'
    file.write_text((ENGINES / "historic/doxford_1913.toml").read_text(encoding="utf-8") + "\n" + gas, encoding="utf-8")
    out = run_here("torque", file).out
    assert "of cylinder 2 only" in out
    first = ask_json("torque", file)["orders"][0]
    assert first["one_cylinder"]["gas_torque_Nm"]["amplitude"] == pytest.approx(first["gas_torque_Nm"]["amplitude"])
    assert refusal("torque", file, "--misfire", "1") == "cylinder 1 is a dummy piston, which never fires"
