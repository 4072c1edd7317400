"""`balcli field`: every format says the same figures; files to start from, the schema, pictures and exit statuses."""

import json
import math
import re
import tomllib

import pytest
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.paths import write
from support.rotors import run, three_runs

from balcli.field_balancing.answer import field
from balcli.field_balancing.runs_file import parse_runs
from balcli.file.examples import template

SHOP = """
name = "fan"
unit = "um"
weights = "with"
radius = [200, 200]
places = [12, [0, 90]]
drill = [4, 4]
deepest = [20, 20]
grade = 6.3
mass = 120
speed = 3000
"""


@pytest.fixture
def runs(tmp_path):
    return write(tmp_path / "runs.toml", three_runs(SHOP))


def test_the_sheet_says_how_angles_count_and_what_to_do(runs):
    out = ask("field", runs)
    for text, way in ((out, ""), (ask("field", "-", stdin=three_runs('weights = "against"')), "against ")):
        told = f"a weight at 30 deg is 30 deg from the 0 mark, going {way}the way the rotor turns."
        assert told in " ".join(text.split())
    assert re.search(r"^front +1\.979 +123\.8 +200 +395\.9 +86%$", out, re.MULTILINE)
    assert re.search(r"^front +\d+ of 12 ", out, re.MULTILINE)
    assert re.search(r"^sensor 1 +170 +112\.0 +0 +–$", out, re.MULTILINE)


def test_holes(runs, tmp_path):
    """30 g at the rim: 38 g are drilled out further in. What was drilled before is in no file."""
    text = (
        'planes = ["rim"]\nradius = [100]\ndrill = [12]\n'
        '[[run]]\nreadings = ["30 @ 0"]\n'
        '[[run]]\nreadings = ["20 @ 0"]\nweights = { rim = "10 @ 0" }\n'
    )
    path = write(tmp_path / "rim.toml", text)
    (hole,) = ask_json("field", path)["corrections"][0]["pieces"]
    grams = 7.85e-3 * math.pi / 4 * 12**2 * hole["depth_mm"]
    assert grams * (100 - hole["depth_mm"] / 2) == pytest.approx(30 * 100)
    assert round(grams) == 38
    told = "Limits and depths ignore earlier weights and holes, which are not in the file"
    out = " ".join(run_here("field", runs).out.split())
    assert "Each hole has the effect of its weight at the rim; the removed steel, nearer the axis, is heavier." in out
    assert told not in out
    last = '[[run]]\nweights = { front = "1.98 @ 124", rear = "1.07 @ 238" }\nreadings = ["9 @ 40", "6 @ 310"]\n'
    text = runs.read_text() + last
    placed = text.replace("drill = [4, 4]\ndeepest = [20, 20]\n", "")
    for content, there in ((text, True), (placed, False), ("most = [9, 9]\n" + placed, True)):
        runs.write_text(content)
        assert (told in " ".join(run_here("field", runs).out.split())) == there


def test_a_shop_that_works_in_inches_reads_inches(runs):
    """Radius, unbalance, drill, depth and what is permitted; weights and readings stay."""
    metric, inches = (run_here("field", runs, *more).out for more in ((), ("--units", "imperial")))
    ounce_inch = 28.349523125 * 25.4  # g mm
    found = re.search(r"^front +1.979 +123.8 +7.874 +([\d.]+) +86%$", inches, re.MULTILINE)
    assert float(found[1]) == pytest.approx(395.9 / ounce_inch, rel=2e-4)
    depth = re.search(r"^front +\d+ of 12 .* 4 +([\d.]+)$", metric, re.MULTILINE)
    small = re.search(r"^front +\d+ of 12 .* 0.15748 +([\d.]+)$", inches, re.MULTILINE)
    assert float(small[1]) == pytest.approx(float(depth[1]) / 25.4, rel=6e-3)
    permitted = 120e3 * 6.3 / (100 * 3.14159265) / 2 / ounce_inch
    assert re.search(rf"^front +{permitted:.4g} ", inches, re.MULTILINE)
    assert "264.555 lb at 3000 rpm" in inches
    said = [run_here("field", runs, "-f", "csv", *more).out for more in ((), ("--units=imperial",))]
    assert said[0] == said[1]


@pytest.mark.parametrize("minimise", ["squares", "max"])
def test_what_does_not_fit_is_said_in_every_form(tmp_path, minimise):
    """No form says that readings are cancelled; all have what is left, and what would be best."""
    path = write(tmp_path / "runs.toml", three_runs('name = "fan"\nplaces = [[0, 40, 80], "free"]'))
    out = run_here("field", path, "--minimise", minimise).out
    assert "All readings are cancelled" not in out
    assert re.search(r"^front +– +– +–$", out, re.MULTILINE)
    assert "Without its limit, front would need 1.979 g at 236.2 deg." in " ".join(out.split())
    said = ask_json("field", path, "--minimise", minimise)
    front, rear = said["corrections"]
    assert (front["weight"], front["pieces"], front["at_limit"]) == (0, [], True)
    assert front["wanted"]["weight"] == pytest.approx(1.979467642, rel=1e-9)
    assert ("wanted" in rear, rear["at_limit"]) == (False, False)
    largest = max(reading["amplitude"] for reading in said["residual"])
    assert largest == pytest.approx(said["largest"], rel=1e-12)
    assert largest > 100
    for form in ("table", "markdown"):
        assert f"{largest:.4g}" in ask("field", path, "--minimise", minimise, "-f", form)


def test_what_does_not_fit_is_said_in_rows_and_on_the_picture(tmp_path):
    path = write(tmp_path / "runs.toml", three_runs('name = "fan"\nplaces = [[0, 40, 80], "free"]'))
    figures = {(r["part"], r["name"], r["figure"]): r["value"] for r in ask_csv("field", path)}
    assert figures["correction", "front", "at_limit"] == "true"
    assert float(figures["details", "", "largest"]) > 100
    picture = tmp_path / "polar.svg"
    assert run_here("field", path, "--plot", picture).status == 0
    assert "wanted: 1.98 at 236.2 deg" in picture.read_text(encoding="utf-8")


def test_json_is_what_it_promises(runs):
    said = ask_json("field", runs)
    assert said["format"] == "balcli.field/1"
    front, rear = said["corrections"]
    assert (front["plane"], front["weight"]) == ("front", pytest.approx(1.979467642, rel=1e-9))
    assert front["angle_deg"] == pytest.approx(360 - 236.1703733, rel=1e-9)
    assert front["pieces"][0].keys() == {"weight", "angle_deg", "place", "depth_mm"}
    assert rear["at_limit"] is False
    assert [piece["place"] for piece in rear["pieces"]] == [1, 2]
    assert said["influence"][0][0] == {
        "amplitude": pytest.approx(78.43258624, rel=1e-9),
        "phase_deg": pytest.approx(58.37900733, rel=1e-9),
    }
    assert said["residual"] == [{"amplitude": 0, "phase_deg": None}] * 2
    assert said["permitted"]["unbalance_g_mm"] == pytest.approx(2406.42, rel=1e-5)
    assert said["permitted"]["reached"] is True
    assert "bound" not in said
    assert ask_json("field", runs, "--minimise", "max")["bound"] == 0
    found = {(r["part"], r["name"], r["figure"]): (r["value"], r["unit"]) for r in ask_csv("field", runs)}
    assert found["correction", "front", "weight"] == (str(front["weight"]), "g")
    depth = front["pieces"][1]["depth_mm"]
    assert found["correction", "front", "pieces.2.depth_mm"] == (str(depth), "mm")
    assert found["before", "sensor 2", "phase_deg"] == (str(said["before"][1]["phase_deg"]), "deg")
    assert found["permitted", "rear", "reached"] == ("true", "")
    assert found["influence", "sensor 1 by rear", "amplitude"][0] == str(said["influence"][0][1]["amplitude"])


@pytest.mark.parametrize("head", ["", 'weights = "with"'], ids=["one sense", "opposite senses"])
def test_a_trim_is_shown_next_to_the_total(tmp_path, head):
    """The readings of the last run are with what stays on in a plane that is left out."""
    last = '[[run]]\nname = "in"\nweights = { front = "2 @ 236", rear = "1 @ 122" }\nreadings = ["9 @ 40", "6 @ 310"]'
    path = write(tmp_path / "runs.toml", three_runs(head, last=last))
    out = run_here("field", path, "-f", "markdown").out
    assert "add now, g" in out
    assert "in addition to the weights of 'in'" in out
    assert json.loads(run_here("field", path, "-f", "json").out)["trimmed"] == "in"
    told = "Planes left out: rear. The weight of 'in' in rear stays on: 1 g at 122.0 deg."
    assert told in " ".join(run_here("field", path, "--without", "rear").out.split())
    path.write_text(three_runs(head), encoding="utf-8")
    assert "stays on" not in run_here("field", path, "--without", "rear").out


def test_check(runs, tmp_path):
    assert run_here("field", runs, "--check").status == 0
    status, out, _ = run_here("field", "-", "--check", stdin=three_runs(SHOP).replace("6.3", "0.4"))
    assert status == 1
    assert "not reached" in out
    plain = write(tmp_path / "plain.toml", three_runs())
    assert refusal("field", plain, "--check") == (
        f"{plain}: --check needs grade = 6.3, mass = 120, speed = 3000, radius = [200, 200] (or "
        'give weights as unbalances, weight_unit = "g mm")'
    )


def test_picture(runs, tmp_path):
    picture = tmp_path / "polar.svg"
    assert run_here("field", runs, "--plot", picture).status == 0
    for words in ("phases count against rotation", "angles count with rotation", "sensor 1: 170"):
        assert words in picture.read_text(encoding="utf-8")
    message = refusal("field", runs, "--plot", tmp_path / "x.gif")
    assert "give a name that ends in .svg, .png or .pdf" in message
    assert "must not change" in refusal("field", runs, "-o", runs)


def test_mistakes_of_the_file_and_standard_input(runs, tmp_path):
    text = runs.read_text(encoding="utf-8")
    assert run_here("field", "-", stdin=text).out == run_here("field", runs).out
    assert refusal("field", tmp_path / "none.toml").endswith("none.toml: no such file")
    bad = text.replace("53 @ 78", "53")
    assert refusal("field", "-", stdin=bad).startswith("standard input: run.1.readings.2: ")


def test_doubts_are_warnings(tmp_path):
    path = write(tmp_path / "runs.toml", three_runs().replace("235 @ 94", "171 @ 112").replace("58 @ 68", "53 @ 78"))
    assert run_here("field", path).err.startswith(f"warning: {path}: the trial weight in front changes no reading")


# ------------------------------------------------------------------ to start from
OPTION = re.compile(r"^# *(\[\[run\]\]|[a-z_]+ *= .*)", re.MULTILINE)


def test_the_starting_file_balances_and_all_its_options_can_be_switched_on(tmp_path):
    path = tmp_path / "runs.toml"
    text = template("field")
    assert run_here("new", "field", path) == (0, "", "")
    assert path.read_text(encoding="utf-8") == text
    keys = tomllib.loads(OPTION.sub(r"\1", text).replace("speed  = 2900", ""))
    assert len(keys["run"]) == 4
    assert {"places", "drill", "deepest", "most", "shares", "reading_weights"} <= keys.keys()
    everything = OPTION.sub(r"\1", text).replace("speed  = 2900", "").replace("keep_trial = true", "")
    assert parse_runs(everything).run[3].name == "correction in"
    assert max(map(len, text.splitlines())) <= 130


def test_the_starting_file_without_phase_has_four_runs_and_one_with_the_correction_on():
    text = template("four-runs")
    assert max(map(len, text.splitlines())) <= 130
    assert len(parse_runs(text).run) == 4
    everything = OPTION.sub(r"\1", text)
    result = field(everything)
    assert (result.method, result.trimmed) == ("amplitudes", "correction on")
    assert result.file.places == (tuple(45.0 * k for k in range(8)),)


def test_the_schema_names_every_key():
    described = json.loads(run_here("schema", "field").out)
    assert described["title"] == "balcli file of runs"
    example = tomllib.loads(template("field"))
    assert set(example) <= set(described["properties"])
    assert all(key.get("description") for key in described["properties"].values())
    assert described["required"] == ["planes", "run"]


def test_the_library_offers_it(runs):
    import balcli

    result = balcli.field(runs, "max")
    text = runs.read_text(encoding="utf-8")
    assert isinstance(result, balcli.FieldBalance)
    for source in (text, str(runs), tomllib.loads(text)):
        assert balcli.field(source, "max").corrections == result.corrections


def test_readings_at_several_speeds_are_of_no_one_run():
    """A correction was tried at 1500 rpm alone: at 3000 rpm the rotor was last read as found."""
    text = 'planes = ["disc"]\n'
    for speed, scale in ((1500, 1), (3000, 4)):
        text += run([5 * scale], [], f"speed = {speed}") + run([7 * scale], [("disc", 2)], f"speed = {speed}")
    text += run([1], [("disc", -4)], 'speed = 1500\nname = "trim"')
    out = run_here("field", "-", stdin=text).out
    assert re.search(r"\nreading +as found +at, deg +last read +at, deg +after", out)
    assert re.search(r"\nsensor 1, 3000 rpm +20 +0\.0 +20 +0\.0 +0 ", out)
    assert re.search(r"\ndisc +5 +180\.0 +1 +180\.0 ", out), "add now, on top of 4 at 180"
