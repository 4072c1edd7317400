"""Compressors and double-acting cylinders: work in closed form, capacity, loads along the piston rod, cards."""

import numpy as np
import pytest
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.paths import ENGINES

PUMP = """
[crank]
stroke = 250
[rod]
length = 625
mass = 62
cg = 220
inertia = 5200000
[piston]
bore = 300
mass = 40
rod_diameter = 70
[crosshead]
mass = 25
[layout]
strokes = 2
[operation]
speed = 420
[gas]
cycle = "compressor"
suction = 1
discharge = 4
clearance = 0.12
compression_index = 1.3
expansion_index = 1.25
[gas.crank_end]
clearance = 0.15
"""
SWEPT = {"head": np.pi / 4 * 0.3**2 * 0.25, "crank": np.pi / 4 * (0.3**2 - 0.07**2) * 0.25}


@pytest.mark.parametrize(("strokes", "start"), [(2, "the outer dead centre"), (4, "firing")])
def test_a_pump_with_a_diagram_does_not_fire(tmp_path, strokes, start):
    """Its diagram absorbs work. A four-stroke engine that is motored still has a dead centre of firing."""
    rows = []
    for angle in range(0, 180 * strokes, 10):
        pressure = 4 if 10 <= angle % 360 <= 180 else 300
        rows.append(f"{angle},{pressure}\n")
    (tmp_path / "p.csv").write_text("angle_deg,pressure_bar\n" + "".join(rows))
    file = tmp_path / "pump.toml"
    layout = f"[layout]\nfiring_order = [1]\nstrokes = {strokes}"
    file.write_text(
        PUMP.partition("[gas]")[0].replace("[layout]\nstrokes = 2", layout) + '[gas]\nindicator = "p.csv"\n'
    )
    assert f"0.0 deg after {start}\n" in run_here("torque", file).out


@pytest.fixture
def pump(tmp_path):
    path = tmp_path / "pump.toml"
    path.write_text(PUMP)
    return path


def closed_form(c: float, nc: float = 1.3, ne: float = 1.25) -> tuple[float, float]:
    """Mean pressure (Pa) and volumetric efficiency of an end, with volumes over the swept volume."""
    ps, pd = 1e5, 4e5
    expanded = c * 4 ** (1 / ne)
    compressed = (1 + c) * 4 ** (-1 / nc)
    expansion = (pd * c - ps * expanded) / (ne - 1)
    compression = (ps * (1 + c) - pd * compressed) / (nc - 1)
    work = expansion + ps * (1 + c - expanded) + compression - pd * (compressed - c)
    return work, 1 + c - expanded


def test_work_and_capacity_in_closed_form(pump):
    found = ask_json("torque", pump)
    total = 0.0
    for end, c in zip(found["ends"], (0.12, 0.15), strict=True):
        work, efficiency = closed_form(c)
        swept = SWEPT[end["end"]]
        assert end["imep_Pa"] == pytest.approx(work, rel=1e-10)
        assert end["volumetric_efficiency"] == pytest.approx(efficiency, rel=1e-12)
        assert end["capacity_m3_per_s"] == pytest.approx(efficiency * swept * 7, rel=1e-12)
        total += work * swept
    assert found["power_W"] == pytest.approx(7 * total, rel=1e-10)
    assert found["imep_Pa"] == pytest.approx(total / sum(SWEPT.values()), rel=1e-10)


def test_loads_along_the_rod(pump):
    """Inertia by hand at the dead centres; figures of the largest loads by an independent program."""
    (rod,) = ask_json("torque", pump, "--loads", "rod")["loads"]["rod"]
    largest = 65 * 0.125 * (np.pi * 14) ** 2
    assert rod["inertia"]["tension_N"] == pytest.approx(largest * 1.2, rel=1e-9)
    assert rod["inertia"]["compression_N"] == pytest.approx(largest * 0.8, rel=1e-9)
    assert rod["pin"]["compression_N"] == pytest.approx(14015.85395331285, rel=1e-8)
    assert rod["pin"]["tension_N"] == pytest.approx(11342.604290596342, rel=1e-8)
    assert rod["reversal"]["longest_deg"] == pytest.approx(163.15515160630395, rel=1e-8)
    assert rod["reversal"]["reverses"] is True
    text = " ".join(ask("torque", pump, "--loads", "rod").split())
    for words in ("absorbed", "Rod load", "it reverses", "Valves are ideal", "cycle compressor, 360 deg", "guide: "):
        assert words in text


def test_a_card_has_the_area_of_its_polygon(tmp_path):
    loop = np.array([[0, 9], [0.5, 9], [1, 3], [1, 2], [0.4, 1.2], [0.1, 4]])
    area = 0.5 * abs(np.sum(loop[:, 0] * np.roll(loop[:, 1], -1) - np.roll(loop[:, 0], -1) * loop[:, 1]))
    path = tmp_path / "steam.toml"
    head = PUMP.partition("[gas]")[0].replace("rod_diameter = 70\n", "")
    path.write_text(head + '[gas]\nindicator = "card.csv"\n')
    for column, scale in (("stroke", 1.0), ("volume_cm3", 40.0)):
        rows = "\n".join(f"{scale * (x + 0.1 * (scale > 1))},{p}" for x, p in loop)
        (tmp_path / "card.csv").write_text(f"{column},pressure_bar\n{rows}\n")
        assert ask_json("torque", path)["imep_Pa"] == pytest.approx(1e5 * area, rel=1e-10)


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ([2, 4, 1, 3], "line 2: the first row is not at the smallest value"),
        ([1, 3, 2, 4, 2], "line 4: the value turns back between the dead centres"),
        ([1, 2, 4], "line 4: no row follows in the stroke that begins here"),
        ([1, 3, 4, 2, 1, 2, 4, 2], "line 6: the card has 4 strokes; a cycle has 2"),
    ],
)
def test_mistakes_in_a_card_have_lines(tmp_path, rows, told):
    path = tmp_path / "steam.toml"
    head = PUMP.partition("[gas]")[0].replace("rod_diameter = 70\n", "")
    path.write_text(head + '[gas]\nindicator = "card.csv"\n')
    lines = "\n".join(f"{value},5" for value in rows)
    (tmp_path / "card.csv").write_text(f"volume_cm3,pressure_bar\n{lines}\n")
    assert f"gas.indicator: card.csv: {told}" in refusal("torque", path)


def test_what_is_refused(pump):
    for old, new, told in (
        ("discharge = 4", "discharge = 1", "gas.discharge: 1 bar is not above suction = 1 bar"),
        ("suction = 1", "", "gas: needs suction for a compressor cycle"),
        ("clearance = 0.12", "clearance = 0.5", "leaves no suction at a pressure ratio of 4"),
        ("clearance = 0.12", "clearance = 0.12\nimep = 5", "gas: has imep"),
        ("rod_diameter = 70", "rod_diameter = 300", "piston.rod_diameter: 300 mm is not below the bore"),
        ("strokes = 2", "strokes = 4", "layout.strokes: is 4, but all cylinders compress"),
        ("clearance = 0.12", "clearance = 12", "up to 2; it is a share of the swept volume: 0.12 for 12 %"),
        ("clearance = 0.12", "clearance = 0", "gas.clearance: 0 is not above 0; a plain number is wanted"),
        (PUMP.partition("[gas]")[2], '\nharmonics = "h.csv"\ncrank_end = {}', "gas.harmonics: is the torque of whole"),
    ):
        pump.write_text(PUMP.replace(old, new, 1))
        assert told in refusal("torque", pump)


IDLE = "has no meaning without an indicator diagram in the same table; leave it out"


def test_keys_of_a_diagram_belong_to_the_table_with_the_diagram(pump):
    """A crank end or a [[gas.of]] with a diagram stands for itself, so it takes no such key from [gas]."""
    (pump.parent / "c.csv").write_text("stroke,pressure_bar\n0,1\n1,3\n1,3\n0,1\n")
    own_diagram = PUMP.partition("[gas.crank_end]")[0] + '[gas.crank_end]\nindicator = "c.csv"\n'
    of_crank_end = '[[gas.of]]\ncylinders = [1]\ncrank_end = { indicator = "c.csv" }\n'
    for text, told in (
        (own_diagram.replace("[gas]\n", '[gas]\npressure = "gauge"\n'), f"gas.pressure: {IDLE}"),
        (PUMP + of_crank_end.replace("1]\n", "1]\nphase = 1\n"), f"gas.of.1.phase: {IDLE}"),
        (PUMP + 'pressure = "gauge"\n', f"gas.crank_end.pressure: {IDLE}"),
    ):
        pump.write_text(text)
        assert told in refusal("torque", pump)
    pump.write_text(own_diagram + 'pressure = "gauge"\n')
    assert ask_json("torque", pump)["ends"][1]["end"] == "crank"


def test_torque_is_virtual_work_of_the_gas_and_the_moment_of_the_pin(pump):
    """Two ways to the torque: pressures times the change of volume, and the force on the crank pin times its arm."""
    rows = ask_csv("curves", pump, "--cylinder", "1", "--step", "5")
    angle = np.radians([float(row["crank_deg"]) for row in rows])
    read = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
    head = (read["pressure_Pa"] - 1e5) * SWEPT["head"] / 0.25
    crank = (read["pressure_crank_end_Pa"] - 1e5) * SWEPT["crank"] / 0.25
    assert read["gas_force_N"] == pytest.approx(head - crank, rel=1e-9, abs=1e-6)
    moment = 0.125 * (np.cos(angle) * read["pin_y_N"] - np.sin(angle) * read["pin_x_N"])
    assert read["torque_Nm"] == pytest.approx(moment, rel=1e-9, abs=1e-6)


def test_loads_over_the_angle_are_those_of_the_table(pump):
    rows = ask_csv("curves", pump, "--cylinder", "1", "--step", "0.05")
    (rod,) = ask_json("torque", pump, "--loads", "rod")["loads"]["rod"]
    for key, column in (("piston_rod", "rod_load_N"), ("pin", "pin_load_N")):
        load = np.array([float(row[column]) for row in rows])
        assert rod[key]["compression_N"] == pytest.approx(load.max(), rel=5e-4)
        assert rod[key]["tension_N"] == pytest.approx(-load.min(), rel=5e-4)


def test_an_end_that_is_missing_adds_no_columns(pump):
    text = PUMP.partition("[gas.crank_end]")[0]
    pump.write_text(text.replace("rod_diameter = 70\n", ""))
    assert "pressure_crank_end_Pa" not in ask_csv("curves", pump, "--cylinder", "1", "--step", "90")[0]


def test_a_rod_diameter_that_is_left_out_is_told(pump):
    told = ask_json("torque", pump)["assumed"]
    assert "piston.rod_diameter" not in {value["path"] for value in told}
    pump.write_text(PUMP.replace("rod_diameter = 70\n", ""))
    told = ask_json("torque", pump)["assumed"]
    assert {"path": "piston.rod_diameter", "value": 0.0, "unit": "mm"} in told


def test_a_second_stage_has_its_own_gas_and_bore(tmp_path):
    """Keys that [[gas.of]] leaves out are those of [gas]; its crank end takes them first from [gas.crank_end]."""
    found = ask_json("torque", ENGINES / "pumps" / "compressor.toml")
    ends = {(end["cylinder"], end["end"]): end for end in found["ends"]}
    for (cylinder, name), clearance in {(1, "head"): 0.12, (1, "crank"): 0.14, (2, "crank"): 0.16}.items():
        ratio = 3.6 if cylinder == 1 else 12.5 / 3.5
        efficiency = 1 + clearance - clearance * ratio ** (1 / 1.35)
        assert ends[cylinder, name]["volumetric_efficiency"] == pytest.approx(efficiency, rel=1e-12)
    areas = [np.pi / 4 * (0.19**2 - d**2) for d in (0, 0.05)]
    volumes = [ends[2, name]["swept_volume_m3"] for name in ("head", "crank")]
    assert volumes == pytest.approx([area * 0.15 for area in areas], rel=1e-12)


def test_pictures_have_both_ends(pump, tmp_path):
    ask("plot", pump, tmp_path / "p.svg", "--what", "p-v")
    picture = (tmp_path / "p.svg").read_text(encoding="utf-8")
    assert "head end" in picture
    assert "crank end" in picture


def test_a_sheet_names_the_orders_as_packagers_do(pump):
    sheet = ask("analyze", pump, "--format", "marine")
    assert "Unbalanced forces and couples" in sheet
    assert "1 (primary)" in sheet
    assert "2 (secondary)" in sheet
    assert "Moments are about x, y, z = 0, 0, 0 mm." in sheet


def test_a_compressor_is_balanced_as_machines_with_frames_are_and_not_as_ships_engines(pump):
    """Two strokes and crossheads do not make a marine engine: the whole moment counts, not the vertical one alone."""
    two_stage = ENGINES / "pumps" / "compressor.toml"
    verdict = ask("analyze", two_stage, "--only", "verdict")
    (moment,) = ask_json("analyze", two_stage, "--orders", "1")["orders"]
    assert f"moment of {moment['moment_Nm']['major'] / 1e3:.4g} kN·m" in verdict
    assert "shaft at -1" in verdict
    assert "compensator" not in ask("analyze", two_stage)


def test_power_related_unbalance_is_not_that_of_a_machine_that_takes_power(pump):
    assert refusal("analyze", pump, "--only", "pru").endswith(
        "pru: the gas of this machine takes power; give operation.power"
    )


def test_a_rod_diameter_without_a_crank_end_is_doubted(pump):
    text = PUMP.partition("[gas.crank_end]")[0]
    idle = "it changes nothing without gas at the crank end: give [gas.crank_end], or leave it out"
    for changed, told in (
        (PUMP, ""),
        (text, f"warning: {pump}: piston.rod_diameter: 70 mm; {idle}\n"),
        (text.replace("rod_diameter = 70\n", ""), ""),
        (
            text.replace("rod_diameter = 70\n", "") + "[cylinder.1]\npiston_rod_diameter = 60\n",
            f"warning: {pump}: cylinder.1.piston_rod_diameter: 60 mm; {idle}\n",
        ),
    ):
        pump.write_text(changed)
        assert run_here("analyze", pump, "--only", "force").err == told


def test_heat_belongs_to_no_cylinder_that_compresses(pump):
    for text, told in (
        (
            "[cylinder.1]\nheat = 3\n",
            "cylinder.1.heat: belongs to a cycle with combustion, and the cylinder compresses",
        ),
        (
            "[[gas.of]]\ncylinders = [1]\n[cylinder.1]\nheat = 3\n",
            "cylinder.1.heat: cylinder 1 has its gas in gas.of.1",
        ),
    ):
        pump.write_text(PUMP + text)
        assert told in refusal("torque", pump)
        assert refusal("torque", pump).count("heat:") == 1
