"""`balcli torque`: what it prints in every format, and what it refuses."""

from __future__ import annotations

import cmath
import json
import math
import re
import tomllib

import numpy as np
import pytest
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.gas_engines import FOUR, WIEBE
from support.paths import ENGINES, write

TORQUE = "angle_deg,torque_Nm\n0,0\n90,1000\n180,0\n360,0\n"
WHOLE = {"format", "version", "speed_rpm", "cycle_deg", "imep_Pa", "max_pressure_Pa", "max_pressure_deg"}
WHOLE |= {"mean_torque_Nm", "power_W", "torque", "orders", "energy"}


@pytest.fixture
def four(tmp_path):
    path = write(tmp_path / "four.toml", FOUR + WIEBE + "mechanical_efficiency = 0.8\n[flywheel]\ninertia = 200000\n")
    return str(path)


@pytest.fixture
def curve(tmp_path):
    path = write(tmp_path / "press.csv", TORQUE)
    return str(path)


def test_the_table_says_why_nothing_is_told_of_the_speed(four, tmp_path):
    missing = "The uneven speed is not known: no inertia is given ([crank] inertia, [flywheel])."
    assert missing not in ask("torque", four)
    light = write(tmp_path / "light.toml", FOUR + WIEBE)
    assert f"Flywheel\n{missing}\n" in ask("torque", light)
    assert missing not in ask("torque", light, "--fluctuation", "1/200")


def test_the_table_says_of_which_speed_it_is(four, tmp_path):
    """An uneven speed in the file counts in `analyze`, not in `torque`, which finds its own."""
    uneven, nameless = tmp_path / "uneven.toml", tmp_path / "nameless.toml"
    assert ask("torque", four, "--write", str(uneven))
    text = ask("torque", str(uneven))
    assert "\nspeed             3000 rpm, the file's uneven one does not count\n" in text
    same = text.replace(", the file's uneven one does not count", "")
    assert same.splitlines()[1:] == ask("torque", four).splitlines()[1:]
    nameless.write_text(FOUR.replace("speed = 3000", "") + WIEBE, encoding="utf-8")
    assert "\nspeed             1000 rpm, assumed: the file gives none\n" in ask("torque", str(nameless))


def test_json_has_what_the_file_allows(four):
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


def test_what_the_file_does_not_allow_is_left_out(four):
    assert set(ask_json("torque", "-", stdin=FOUR + WIEBE)) == WHOLE


def test_a_misfire_is_told_wherever_its_figures_are(four):
    for command in ("torque", "analyze"):
        asked = (command, four, "--misfire", "3")
        assert ask_json(*asked)["no_gas_in"] == [3]
        assert "no_gas_in" not in ask_json(command, four)
    assert "no gas in" in run_here("analyze", four, "--misfire", "3", "--only", "gas").out


def test_text_fits_a_terminal_of_80_columns(four):
    text = ask("torque", four, "--fluctuation", "0.5%", "--misfire", "3")
    assert max(map(len, text.splitlines())) <= 80
    for told in ("mean pressure", "6.75 bar indicated", "no gas in", "needed"):
        assert told in text
    assert "| ½ |" in ask("torque", four, "--format", "markdown")


def test_csv_lists_every_figure(four):
    lines = ask("torque", four, "--format", "csv").splitlines()
    assert lines[0] == "cylinder,quantity,order,figure,value,unit"
    assert any(line.startswith("0,flywheel,,fluctuation,0.0") for line in lines)
    assert any(line.startswith("1,gas,0.5,amplitude,") for line in lines)
    assert any(line.startswith("0,torque_total,2,peak_deg,") for line in lines)
    assert any(line.startswith("0,torque_total,,max,") for line in lines)
    silent = ask("torque", four, "--misfire", "3", "--misfire", "1", "--format", "csv").splitlines()
    assert "0,engine,,no_gas_in,1 3," in silent


def test_what_is_written_turns_as_unevenly(four, tmp_path):
    out = tmp_path / "uneven.toml"
    ask("torque", four, "--write", out)
    assert "order = 2, amplitude = 0.0" in out.read_text()
    found = ask_json("analyze", out, "--only", "force")
    assert found["orders"][0]["order"] == 0, "an uneven speed has a mean force"
    again = ask_json("torque", out)
    assert again == ask_json("torque", four), "torque is that of the mean speed"


def test_what_is_written_misfires_as_it_did(four, tmp_path):
    """Else gas of all cylinders would stand beside the speed of three."""
    out = tmp_path / "misfire.toml"
    told = ask("torque", four, "--misfire", "3", "--write", out, "--format", "json")
    assert "[cylinder.3]\ngas = 0    # by balcli torque\n" in out.read_text()
    assert ask("torque", out, "--format", "json") == told


def test_lines_that_no_engine_file_may_have_are_not_written(tmp_path):
    """Twenty-four cylinders fire every 15 degrees: orders 24, 48, ..., and the corners of an Otto
    cycle reach beyond order 256.
    """
    count = 24
    path, out = tmp_path / "many.toml", tmp_path / "uneven.toml"
    throws = [360 / count * k for k in range(count)]
    path.write_text(
        FOUR.replace("[0, 180, 180, 0]", str(throws)).replace(
            "firing_order = [1, 3, 4, 2]", f"strokes = 2\nfiring_order = {[1, *range(count, 1, -1)]}"
        )
        + WIEBE.replace("wiebe", "otto")
        + "[flywheel]\ninertia = 900000\n"
    )
    ask("torque", path, "--write", out)
    lines = tomllib.loads(out.read_text())["operation"]["speed_ripple"]
    assert [line["order"] for line in lines] == [24 * k for k in range(1, 11)]
    assert run_here("analyze", out, "--only", "force")[0] == 0


def test_what_a_crank_needs_that_stalls(four, tmp_path):
    arguments = (four, "--speed", "100", "--fluctuation", "1/50")
    assert "speed    the shaft stalls at" in ask("torque", *arguments)
    found = ask_json("torque", *arguments)["flywheel"]
    assert set(found) == {"inertia_kg_m2", "moving_parts_kg_m2", "needed_kg_m2", "stall"}
    assert found["stall"].startswith("the shaft stalls at")
    told = refusal("torque", *arguments, "--write", tmp_path / "out.toml")
    assert told.startswith("--write: the shaft stalls at")


def test_a_crank_that_stalls_is_an_error_with_the_angle_beside_all_else(four, curve):
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
        assert run_here("torque", *arguments, "--fluctuation", "1/50")[::2] == (0, "")


def test_a_curve_needs_no_engine(curve):
    found = ask_json("torque", "--curve", curve)
    assert set(found) == {"format", "version", "cycle_deg", "mean_torque_Nm", "torque", "orders", "energy"}
    assert found["mean_torque_Nm"] == pytest.approx(250)
    assert found["cycle_deg"] == 360
    assert found["torque"]["max_Nm"] == 1000
    assert found["energy"]["work_J"] == pytest.approx(250 * 2 * 3.141592653589793)
    assert set(found["orders"][0]) == {"order", "torque_Nm"}
    arguments = ("--curve", curve, "--speed", "300", "--inertia", "2e6", "--fluctuation", "1/100")
    text = ask("torque", *arguments)
    assert "Flywheel\ninertia      2 kg·m²" in text
    metric = ask("torque", *arguments[:5], "2 kg m^2", *arguments[6:])
    assert metric == text


def test_a_curve_of_several_turns_has_orders_below_1(tmp_path):
    (tmp_path / "t.csv").write_text("angle_deg,torque_Nm\n0,1\n300,5\n1080,1\n")
    orders = ask_json("torque", "--curve", tmp_path / "t.csv")["orders"]
    assert [entry["order"] for entry in orders[:3]] == pytest.approx([1 / 3, 2 / 3, 1])


@pytest.mark.parametrize(
    ("last", "doubted"),
    [(359, True), (719, True), (6.2832, True), (360, False), (240, False), (1080, False), (102.86, False)],
)
def test_a_period_that_nothing_has_is_doubted(tmp_path, last, doubted):
    """A curve sampled from 0 to 359 deg lacks the row that closes it."""
    path = write(tmp_path / "t.csv", f"angle_deg,torque_Nm\n0,1\n5,5\n{last},1\n")
    told = (
        f"warning: {path}: its period is {last} deg, neither whole turns nor an even share of two; "
        "the last row closes the period: is it there?\n"
    )
    assert run_here("torque", "--curve", path).err == (told if doubted else "")


def test_a_curve_of_a_thousand_turns_ends_soon(tmp_path):
    """All its orders to 12 are 12 000 lines, and those to 4096 four million."""
    path = write(tmp_path / "t.csv", "angle_deg,torque_Nm\n0,1\n180,5\n360000,1\n")
    shown = ask_json("torque", "--curve", path)["orders"]
    assert [entry["order"] for entry in shown] == [k / 1000 for k in range(1, 513)]
    assert refusal("torque", "--curve", path, "--orders", "65,66") == (
        "order 66: of a period of 1000 turns there are orders to 65.5"
    )
    # Slopes jump by 4 b/(a (b - a)) at 0 and back at a, in turns of a period b.
    found = ask_json("torque", "--curve", path, "--orders", "0.5,65.5")
    sizes = [entry["torque_Nm"]["amplitude"] for entry in found["orders"]]
    a, b = 0.5, 1000
    for order, size in zip((0.5, 65.5), sizes, strict=True):
        wave = 2 * math.pi * order
        jumps = 4 * b / (a * (b - a)) * abs(1 - cmath.exp(-1j * wave * a))
        assert size == pytest.approx(2 / b * jumps / wave**2, rel=1e-8)


def test_a_curve_in_place_of_an_engine_is_told_where_it_belongs(curve):
    told = f"balcli: {curve}: an engine file ends in .toml; is it a torque, for --curve?\n"
    assert run_here("torque", curve).err == told


def test_angles_of_a_curve_have_an_end(tmp_path):
    path = write(tmp_path / "t.csv", "angle_deg,torque_Nm\n0,1\n180,5\n36e12,1\n")
    assert refusal("torque", "--curve", path) == f"{path}: has angles beyond 1e+06 deg"


def test_a_short_period_has_two_orders_at_least(tmp_path):
    (tmp_path / "t.csv").write_text("angle_deg,torque_Nm\n0,1\n5,5\n20,1\n")
    orders = ask_json("torque", "--curve", tmp_path / "t.csv")["orders"]
    assert [entry["order"] for entry in orders] == [18, 36]


def test_the_load_takes_its_share(curve, tmp_path):
    """A load that is the torque itself leaves nothing over."""
    found = ask_json("torque", "--curve", curve, "--load", curve)
    assert found["energy"]["surplus_J"] == pytest.approx(0, abs=1e-9)
    assert found["energy"]["work_J"] == pytest.approx(250 * 2 * np.pi), "that of the torque"
    other = write(tmp_path / "l.csv", "angle_deg,torque_Nm\n0,250\n720,250\n")
    told = refusal("torque", "--curve", curve, "--load", other)
    assert "--load: has a period of 720 deg, the torque 360: give both over the same angle" in told


@pytest.mark.parametrize(
    ("load", "told"),  # 1000 N m over a sixth of a turn: 166.67 N m in the mean
    [
        ("0,1000\n60,1000\n60,0\n360,0", "166.67 N·m in the mean, and 33.333 N·m evenly"),
        ("0,2000\n60,2000\n60,0\n360,0", "333.33 N·m in the mean, and -133.33 N·m evenly"),
        ("0,400\n180,400\n180,0\n360,0", "200 N·m in the mean"),
        ("0,0.1\n70,0.8\n140,0.1\n290,-0.6\n360,0.1", "0.022222 N·m in the mean, and 199.98 N·m evenly"),
        ("0,0\n70,0.7\n140,0\n250,-0.7\n320,0\n360,0", "-0.038889 N·m in the mean, and 200.04 N·m evenly"),
        ("0,0\n70,0.7\n140,0\n210,-0.7\n280,0\n360,0", "0 N·m in the mean, and 200 N·m evenly"),
    ],
)
def test_what_the_mean_of_a_load_leaves_is_told(tmp_path, load, told):
    motor, press = tmp_path / "motor.csv", tmp_path / "press.csv"
    motor.write_text("angle_deg,torque_Nm\n0,200\n360,200\n")
    press.write_text(f"angle_deg,torque_Nm\n{load}\n")
    out = ask("torque", "--curve", motor, "--load", press)
    assert [line for line in out.splitlines() if line.startswith("load")] == [f"load         {told}"]


def test_a_curve_may_begin_at_any_angle(tmp_path):
    """A triangle at 30 deg is there wherever its rows begin, and a load of it leaves nothing."""
    rows = {"a.csv": "0,50\n30,80\n60,50\n360,50", "b.csv": "-90,50\n0,50\n30,80\n60,50\n270,50"}
    paths = {name: tmp_path / name for name in rows}
    for name, text in rows.items():
        paths[name].write_text(f"angle_deg,torque_Nm\n{text}\n")
    found = [ask_json("torque", "--curve", p) for p in paths.values()]
    for one in found:
        assert one["torque"]["max_deg"] == pytest.approx(30)
        assert one["orders"][0]["torque_Nm"]["peak_deg"] == pytest.approx(30)
        assert [one["energy"][key] for key in ("from_deg", "to_deg")] == pytest.approx(
            [30 - 30 * (1 - 1 / 12), 30 + 30 * (1 - 1 / 12)]
        )
    both = ask_json("torque", "--curve", paths["a.csv"], "--load", paths["b.csv"])
    assert both["energy"]["surplus_J"] == pytest.approx(0, abs=1e-9)


IN_OTHER_UNITS = {  # NIST SP 811 (2008), appendix B.8, but for the last: pound times square inch
    "N": ("lbf", 4.4482216152605),
    "N·m": ("lbf·ft", 1.3558179483314004),
    "J": ("lbf·ft", 1.3558179483314004),
    "Pa": ("psi", 6894.757293168361),
    "W": ("hp", 745.6998715822702),
    "kg·m²": ("lb·in²", 0.45359237 * 0.0254**2),
}


def test_imperial_figures_are_the_metric_ones_in_other_units(four):
    """Pressure, power, work and inertia, too: in tables and CSV."""
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
    assert not re.search(r"\b(N|J|kJ|N·m|bar|kW|kg·m²|N/mm²)\b", table)
    assert re.search(r"^mean pressure +130\.53 psi indicated, 104\.43 psi brake$", table, re.M)
    metric = ask("torque", *asked)
    assert re.search(r"^mean pressure +9 bar indicated, 7\.2 bar brake$", metric, re.M)


def test_with_imperial_units_a_bare_inertia_asks_for_its_unit(curve):
    asked = ("torque", "--curve", curve, "--speed", "3000", "--units", "imperial", "--inertia")
    told = '"3": with --units imperial a moment of inertia needs its unit: "3 lb in^2" or "3 kg mm^2"'
    assert refusal(*asked, "3") == f"--inertia {told}"
    assert "inertia      800 lb·in²" in run_here(*asked, "800 lb in^2").out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([], "give an engine file, or --curve with a torque"),
        (["{four}", "--curve", "{curve}"], "give an engine file, or --curve with a torque"),
        (["--curve", "{curve}", "--misfire", "1"], "--misfire needs an engine file"),
        (
            ["{four}", "--inertia", "3"],
            "--inertia needs --curve; that of an engine stands in its file: [crank] inertia, [flywheel]",
        ),
        (["{four}", "--fluctuation", "1e-10"], '--fluctuation "1e-10": give (highest - lowest)/m'),
        (["{four}", "--fluctuation", "x"], '--fluctuation "x": give (highest - lowest)/mean sp'),
        (["{four}", "--fluctuation", "1/0"], '--fluctuation "1/0": give (highest - lowest)/mea'),
        (["{four}", "--cylinder", "7"], "--cylinder 7: four has the cylinders 1, 2, 3, 4"),
        (
            ["--curve", "{curve}", "--inertia", "0"],
            '--inertia "0": a moment of inertia is wanted: a bare number in kg mm^2, or '
            '"4200 kg mm^2" or "8.1 lb in^2", above 0',
        ),
        (["--curve", "{curve}", "--inertia", "3 s"], '--inertia "3 s": is a time, but a moment of'),
        (
            ["--curve", "{curve}", "--fluctuation", "1/100"],
            "--fluctuation needs the mean speed; give it, such as --speed 300",
        ),
        (["--curve", "{four}"], "the heading"),
        (["--curve", "{curve}", "--orders", "0.5"], "order 0.5: a period of 360 deg has multiples of 1"),
    ],
)
def test_what_is_refused(four, curve, arguments, told):
    assert told in refusal("torque", *(a.format(four=four, curve=curve) for a in arguments))


def test_writing_needs_inertia(tmp_path):
    told = refusal("torque", "-", "--write", tmp_path / "out.toml", stdin=FOUR + WIEBE)
    assert "--write: the speed is not known; give inertia in [crank] or [flywheel]" in told


@pytest.mark.parametrize(
    "command",
    [
        "torque bare.toml",
        "torque bare.toml --misfire 1",
        "analyze bare.toml --only gas",
        "analyze bare.toml --misfire 1 --speed 1000",
        "compare gas.toml bare.toml --only gas",
        "plot bare.toml x.svg --what polar,torque",
    ],
)
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
    assert (status, err) == (2, 'balcli: --loads "wrist": there are pin and main\n')


def test_knuckle_pins_are_told_beside_the_crank_pin(tmp_path):
    path = tmp_path / "radial.toml"
    radial = (ENGINES / "radial7_articulated.toml").read_text()
    bearing = "[bearing]\npin_diameter = 70\npin_width = 60\n"
    path.write_text(f"{radial}\n{WIEBE}\n{bearing}")
    loads = ask_json("torque", path, "--loads", "pin")["loads"]
    assert [pin["cylinder"] for pin in loads["pin"]] == [1]
    assert loads["pin"][0]["pressure_Pa"] == pytest.approx(loads["pin"][0]["max_N"] / 4.2e-3)
    assert [pin["cylinder"] for pin in loads["knuckle"]] == [2, 3, 4, 5, 6, 7]
    assert set(loads["knuckle"][0]) == {"cylinder", "max_N", "max_deg", "mean_N"}
    assert "Knuckle pins\ncylinder   largest, kN" in ask("torque", path, "--loads", "pin")
    rows = ask("torque", path, "--loads", "pin", "-f", "csv").splitlines()
    assert any(row.startswith("3,knuckle,,max,") for row in rows)
    status, _, err = run_here("torque", path, "--loads", "main")
    why = "a crank with one throw does not say where its bearings stand"
    assert (status, err) == (2, f"balcli: main bearings: {why}\n")
    status, out, err = run_here("torque", path, "--loads", "pin,main")
    assert (status, err) == (0, f"warning: {path}: main bearings: {why}\n")
    assert "Knuckle pins" in out
    assert f"\nMain bearings\nNot known: {why}.\n" in out
    markdown = run_here("torque", path, "--loads", "pin,main", "-f", "markdown").out
    assert f"\n## Main bearings\n\nNot known: {why}.\n" in markdown
    both = json.loads(run_here("torque", path, "--loads", "pin,main", "-f", "json").out)
    assert both["loads"] == loads | {"obstacle": why}
    rows = run_here("torque", path, "--loads", "pin,main", "-f", "csv").out.splitlines()
    assert f"0,main,,obstacle,{why}," in rows
    curves = run_here("curves", path, "--cylinder", "3", "--step", "90").out
    assert curves.splitlines()[0].endswith("side_thrust_N,rod_force_N,pin_x_N,pin_y_N,torque_Nm")


def test_curves_of_a_cylinder_go_over_its_cycle(four):
    out = ask("curves", four, "--cylinder", "3", "--step", "5", "-f", "json")
    curves = json.loads(out)["curves"] if "curves" in json.loads(out) else json.loads(out)
    names = {"pressure_Pa", "volume_m3", "gas_force_N", "side_thrust_N", "rod_force_N", "pin_x_N"}
    assert names | {"pin_y_N", "torque_Nm"} <= set(curves)
    assert len(curves["torque_Nm"]) == 144


# ------------------------------------------------------------------ sweeps and pictures
def test_curves_of_an_engine_have_the_gas_torque_over_the_cycle(four, tmp_path):
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
    other = tmp_path / "other.toml"
    with open(four) as file:
        text = file.read().replace("imep = 9", "imep = 6") + "[cylinder.3]\ngas = 0\n"
    other.write_text(text)
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


def test_sweeps_of_engines_without_gas_have_the_inertia_torque(tmp_path):
    bare = write(tmp_path / "bare.toml", FOUR)
    out = ask("sweep", bare, "--vary", "rod.length=140,150", "--quantity", "torque.2.amplitude")
    assert out.startswith("rod.length,torque.2.amplitude")
    refused = ("sweep", str(bare), "--vary", "rod.length=140,150", "--quantity", "gas.2.amplitude")
    assert refusal(*refused) == "gas.2.amplitude: the engine file has no [gas]"


@pytest.mark.stress
@pytest.mark.parametrize("what", ["pressure", "p-v", "torque", "pin", "main"])
def test_pictures_of_gas(four, tmp_path, what):
    target = tmp_path / "x.svg"
    ask("plot", four, "--what", what, "-o", target)
    assert target.read_text().startswith("<?xml")


@pytest.mark.parametrize(
    ("what", "metric", "imperial"),
    [
        ("pressure", ["pressure, bar"], ["pressure, psi"]),
        ("p-v", ["pressure, bar", "volume, cm³"], ["pressure, psi", "volume, in³"]),
        ("inner", ["z, mm", "moment, N·m"], ["z, in", "moment, lbf·ft"]),
    ],
)
def test_axes_name_the_units_asked_for(four, tmp_path, what, metric, imperial):
    target = tmp_path / "x.svg"
    for units, names in (("si", metric), ("imperial", imperial)):
        run_here("plot", four, "--what", what, "-o", target, "--units", units)
        picture = target.read_text(encoding="utf-8")
        assert [name in picture for name in names] == [True] * len(names)


def test_the_page_runs_pressure_in_the_units_asked_for(four, tmp_path):
    target = tmp_path / "x.html"
    highest = []
    for units, name in (("si", "bar"), ("imperial", "psi")):
        assert run_here("report", four, target, "--units", units).status == 0
        page = target.read_text(encoding="utf-8")
        found = json.loads(re.search(r'id="running">(.*?)</script>', page, re.DOTALL)[1])
        pressure = next(each for each in found["curves"] if each["id"] == "pressure")
        assert pressure["unit"] == name
        highest.append(max(pressure["total"]))
    assert highest[0] == pytest.approx(highest[1] * 6894.757293168361 / 1e5, rel=1e-4)


def test_pictures_that_cannot_be(tmp_path):
    bare = write(tmp_path / "bare.toml", FOUR)
    target = str(tmp_path / "x.svg")
    err = run_here("plot", bare, "--what", "pressure", "-o", target).err
    assert "has no [gas]" in err
    (tmp_path / "h.csv").write_text("order,cos,sin\n0,2,0\n0.5,1,3\n")
    bare.write_text(FOUR + '[gas]\nharmonics = "h.csv"\n')
    err = run_here("plot", bare, "--what", "p-v", "-o", target).err
    assert err == "balcli: the file has harmonics of the torque, and no pressures\n"
    err = run_here("plot", bare, "--what", "pin", "-o", target).err
    assert err == "balcli: loads of pins need pressures; harmonics of the torque have none\n"
    found = ask_json("torque", bare)
    assert not {"max_pressure_Pa", "max_pressure_deg"} & set(found)


# ------------------------------------------------------------------ other commands
def test_what_names_a_file_beside_it_is_written_beside_it(tmp_path):
    """A diagram would be left behind, unless the other folder has it, too."""
    (tmp_path / "far").mkdir()
    rows = "\n".join(f"{angle},{5 if angle == 10 else 1}" for angle in range(0, 721, 10))
    (tmp_path / "p.csv").write_text(f"angle_deg,pressure_bar\n{rows}\n")
    path = tmp_path / "four.toml"
    shaft = 'name = "flywheel"\ninertia = 9e6\nstiffness = 1e6\ndiameter = 60\n'
    more = f"[torsion]\nthrow_stiffness = 1e6\nthrow_inertia = 3e4\n[[torsion.rear]]\n{shaft}"
    turned = FOUR.replace("throws = [0, 180, 180, 0]\n", "")
    wanted = '[gas]\nindicator = "p.csv"\n[flywheel]\ninertia = 9e6\n'
    path.write_text(turned + wanted + more)
    commands = (
        ("torque",),
        ("balance",),
        ("torsion", "--damper", "viscous", "--speeds", "1000:2000:500", "--damper-inertia", "2e6"),
        ("search", "--over", "firing_order", "--minimise", "force.1.major"),
    )
    for command, *options in commands:
        far = tmp_path / "far" / "out.toml"
        told = refusal(command, path, *options, "--write", far)
        assert f'{far}: the engine file names "p.csv", which stands beside it in {tmp_path}' in told
        assert f"or copy p.csv into {far.parent} first" in told
        assert not far.exists()
        near = tmp_path / f"{command}.toml"
        status, _, err = run_here(command, path, *options, "--write", near)
        assert (status, err) == (0, "")
        assert run_here("torque", near).status == 0
    (tmp_path / "far" / "p.csv").write_bytes((tmp_path / "p.csv").read_bytes())
    for command, *options in commands:
        copied = tmp_path / "far" / f"{command}.toml"
        assert run_here(command, path, *options, "--write", copied).status == 0
        assert run_here("torque", copied).status == 0


def test_throws_that_fit_no_firing_order_are_not_written_beside_gas(four, tmp_path):
    """What a search over throws finds leaves the firing order open, which gas needs."""
    target = tmp_path / "out.toml"
    arguments = ("--over", "throws", "--minimise", "force.1.major")
    status, out, err = run_here("search", four, *arguments, "--write", target)
    assert (status, "0-180-" in out) == (2, True)
    assert err.startswith("balcli: --write: the firing order of the file does not fit what was")
    assert not target.exists()


def test_engines_with_gas_are_compared_by_what_it_does(four):
    found = ask_json("compare", four, four, "--orders", "2")
    assert "torque_Nm" in json.dumps(found)
    mixed = run_here("compare", four, "-", "-f", "json", "--orders", "2", stdin=FOUR)
    assert (mixed.status, mixed.err) == (0, "")
    assert "gas_torque_Nm" not in mixed.out


@pytest.mark.parametrize("only", ["gas", "inner", "guide"])
def test_engines_of_different_cycles_are_compared_by_the_orders_of_both(tmp_path, only):
    """A misfire makes half orders, which a two-stroke engine does not have."""
    four, two = tmp_path / "four.toml", tmp_path / "two.toml"
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


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("angle_deg,torque_Nm\n0,1\n", "has no two angles; the last row has to close the period"),
        ("angle_deg,torque_Nm\n0,1\n90,2\n80,2\n360,1\n", "line 4: the angle 80 deg is below the 90"),
        ("angle_deg,torque_Nm\n0,1\n90\n", "line 3: has 1 of 2 columns"),
        ("angle_deg,torque\n0,1\n", 'the heading "angle_deg,torque" has no torque_Nm; head the'),
        ("angle_deg,torque_Nm\n0,inf\n", 'line 2: "inf" is not a number'),
        ("angle_deg;torque_Nm\n0;1.000,5\n", 'line 2: "1.000.5" is not a number'),
        ("angle_deg,torque_Nm\n0,1,000.5 Nm\n", "line 2: has 3 columns, the heading 2; name"),
        (
            "angle_deg,torque_Nm\n0,5,1,3\n",
            "line 2: has 4 columns, the heading 2; name every column in the heading, or, where "
            "decimals have commas, part columns by semicolons there and below",
        ),
    ],
)
def test_curves_that_cannot_be(tmp_path, content, told):
    path = write(tmp_path / "t.csv", content)
    assert told in refusal("torque", "--curve", path)


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(
            "angle_deg;torque_Nm\n0;1,5\n90,5;-2,25\n360;1.5\n", id="semicolons part columns, and commas decimals"
        ),
        pytest.param("angle_deg\ttorque_Nm\n0\t1,5\n90,5\t-2,25\n360\t1.5\n", id="so do tabs"),
        pytest.param(
            "angle_deg,\t\ttorque_Nm\n0,\t\t1.5\n90.5,\t\t-2.25\n360,\t\t1.5\n", id="tabs after commas are room"
        ),
        pytest.param(
            "angle_deg,torque_Nm\n0,1.5,first\n90.5,-2.25,,idle\n360,1.5,\n",
            id="words without a heading count for nothing",
        ),
        pytest.param(
            "angle_deg;torque_Nm\n0;1,5;7\n90,5;-2,25;8,5\n360;1,5;ok\n",
            id="nor do numbers, where semicolons part columns",
        ),
    ],
)
def test_one_curve_in_other_words(tmp_path, text):
    path = write(tmp_path / "t.csv", "angle_deg,torque_Nm\n0,1.5\n90.5,-2.25\n360,1.5\n")
    plain = ask("torque", "--curve", path)
    path.write_text(text)
    assert ask("torque", "--curve", path) == plain


def test_curves_that_are_no_text(tmp_path):
    path = tmp_path / "t.csv"
    path.write_bytes(b"angle_deg,torque_Nm\n0,\xff\n")
    assert "is not UTF-8 text" in run_here("torque", "--curve", path).err


def test_a_curve_as_csv_and_markdown(curve):
    rows = ask("torque", "--curve", curve, "-f", "csv").splitlines()
    assert "0,torque,,max,1000.0,N·m" in rows
    assert any(row.startswith("0,torque,1,amplitude,") for row in rows)
    assert ask("torque", "--curve", curve, "-f", "markdown").startswith("# press: torque")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("gas.x.amplitude", "after gas comes an order up to 4096, as in gas.2.amplitude"),
        ("torque.2.axis", "after the order comes one of amplitude, major, cos, sin"),
        ("fluctuation.2", "give torque.mean, torque.max, torque.min, fluctuation"),
        ("gas.2", "after the order comes one of amplitude, major, cos, sin"),
    ],
)
def test_quantities_that_are_none(four, text, message):
    err = run_here("sweep", four, "--vary", "gas.imep=6,9", "--quantity", text).err
    assert err == f"balcli: {text} is no quantity: {message}\n"


def test_a_fluctuation_needs_inertia():
    arguments = ("--vary", "gas.imep=6,9", "--quantity", "fluctuation")
    assert "fluctuation: the file gives no inertia" in run_here("sweep", "-", *arguments, stdin=FOUR + WIEBE).err


def test_power_and_torque_say_whether_they_are_indicated(four, curve, tmp_path):
    """A shaft gives away less than the gas does: 2 litres at 9 bar are 143.2 N m, 80 % of it 114.6."""
    volume = 4 * np.pi / 4 * 0.086**2 * 0.09
    mean = 9e5 * volume / (4 * np.pi)
    told = " ".join(ask("torque", four).split())
    speed = ask_json("torque", four)["speed_rpm"] * np.pi / 30
    assert f"mean torque {mean:.5g} N·m indicated, {0.8 * mean:.5g} N·m brake" in told
    kilowatts = mean * speed / 1e3
    assert f"power {kilowatts:.5g} kW indicated, {0.8 * kilowatts:.5g} kW brake" in told
    bare = write(tmp_path / "bare.toml", FOUR + WIEBE)
    assert f"power {kilowatts:.5g} kW indicated Torque" in " ".join(ask("torque", bare).split())
    silent = ask("torque", four, "--misfire", "3")
    assert "indicated" in silent
    assert "brake" not in silent  # a cylinder without gas keeps its friction
    assert "bmep_Pa" not in ask_json("torque", four, "--misfire", "3")
    assert "indicated" not in ask("torque", "--curve", curve, "--speed", "300")


def test_what_a_flywheel_needs_is_told_without_the_crankshaft(tmp_path):
    """What is in all, less what moves and, where it is known, less the crankshaft."""
    asked = ("--fluctuation", "1/300")

    def told(text: str) -> tuple[dict, str]:
        path = write(tmp_path / "x.toml", text)
        found = ask_json("torque", path, *asked)["flywheel"]
        return found, " ".join(ask("torque", path, *asked).split())

    found, words = told(FOUR + WIEBE)
    both = found["needed_kg_m2"] - found["moving_parts_kg_m2"]
    assert f"in all, {both:.5g} of it in crankshaft and flywheel" in words
    found, words = told(FOUR.replace("[crank]", "[crank]\ninertia = 40000") + WIEBE)
    assert f"in all, {both - 0.04:.5g} of it in the flywheel" in words
    found, words = told(FOUR.replace("[crank]", "[crank]\ninertia = 4e6") + WIEBE)
    assert "in all, which is there without a flywheel" in words
    rotary = FOUR.replace("throws = [0, 180, 180, 0]", "inertia = 4e6")
    rotary = rotary.replace("firing_order = [1, 3, 4, 2]", "radial = 3\nrotary = true\nstrokes = 2")
    code, words, warning = run_here("torque", "-", *asked, stdin=rotary + WIEBE)
    assert (code, "stands still" in warning) == (0, True)
    assert "of it in the flywheel" in words


def test_help_tells_the_orders_that_there_are():
    help_text = " ".join(ask("torque", "--help").split())
    assert "default: all to 12, and of an engine that fires more than 12 times a turn" in help_text
