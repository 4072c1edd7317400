"""A measured curve of the free end beside the computed one."""

import json
import math

import pytest
from support.commands import ask, ask_csv, ask_json, refusal
from support.diesel import write_diesel
from support.paths import write

from balcli import load, plot, torsion

GAS = '[gas]\ncycle = "wiebe"\ncompression_ratio = 16\nimep = 15\n'
POINTS = [(1200, 6), (1200, 4.5), (1850, 6), (1700, 6), (1850, 3)]
HEAD = "speed_rpm,order,amplitude_deg\n"


def name_curve(text):
    return text.replace("[torsion]\n", '[torsion]\nmeasured = "m.csv"\n')


@pytest.fixture(scope="module")
def diesel(tmp_path_factory):
    """A diesel with the curve that its own computation has, but for one point that is 0.01 deg higher."""
    folder = tmp_path_factory.mktemp("measured")
    plain = load(write_diesel(extra=GAS))
    rows = []
    for speed, order in POINTS:
        alone = torsion(plain, [speed], orders=[order])
        rows.append((speed, order, float(alone.response.free_end_deg[0])))
    speed, order, amplitude = rows[2]
    rows[2] = (speed, order, amplitude + 0.01)
    lines = "".join(f"{speed},{order},{amplitude!r}\n" for speed, order, amplitude in rows)
    write(folder / "m.csv", HEAD + lines)
    return write(folder / "diesel.toml", name_curve(write_diesel(extra=GAS)))


def test_every_point_stands_beside_the_response_of_its_order_alone(diesel):
    measured = ask_json("torsion", diesel)["measured"]
    assert [(row["speed_rpm"], row["order"]) for row in measured["rows"]] == POINTS
    differences = [row["measured_deg"] - row["computed_deg"] for row in measured["rows"]]
    assert differences == pytest.approx([0, 0, 0.01, 0, 0], abs=1e-12)
    assert measured["rms_deg"] == pytest.approx(0.01 / math.sqrt(5))


def test_orders_of_the_option_do_not_choose_those_of_the_curve(diesel):
    with_option = ask_json("torsion", diesel, "--orders", "1,2", "--speeds", "1000:1200:50")
    assert with_option["measured"] == ask_json("torsion", diesel)["measured"]


def test_the_largest_differences_are_printed(diesel):
    _, _, table = ask("torsion", diesel).partition("Measured amplitudes of pulley\n")
    assert table.splitlines()[2].split()[:2] == ["1850", "6"]
    assert "Root mean square difference of 5 measured points: 0.004472 deg." in table


def test_csv_has_each_point_and_the_difference(diesel):
    rows = [row for row in ask_csv("torsion", diesel) if row["part"] == "measured"]
    assert len(rows) == 2 * len(POINTS) + 1
    assert (rows[0]["speed_rpm"], rows[0]["order"], rows[0]["figure"]) == ("1200.0", "6", "measured")
    assert rows[-1]["figure"] == "rms"


def test_an_order_that_nothing_excites_is_computed_as_0(tmp_path):
    """Without gas, a four-stroke has no half orders."""
    write(tmp_path / "m.csv", HEAD + "1500,0.5,0.2\n")
    path = write(tmp_path / "bare.toml", name_curve(write_diesel()))
    (row,) = ask_json("torsion", path)["measured"]["rows"]
    assert (row["measured_deg"], row["computed_deg"]) == (0.2, 0)


def test_a_search_finds_the_loss_with_which_a_curve_was_made(tmp_path):
    made = load(write_diesel(extra=GAS).replace("loss = 0.035", "loss = 0.05"))
    assert made.model.torsion.loss == 0.05
    rows = HEAD
    for speed in range(1600, 2100, 50):
        rows += f"{speed},6,{torsion(made, [speed], orders=[6]).response.free_end_deg[0]}\n"
    write(tmp_path / "m.csv", rows)
    path = write(tmp_path / "diesel.toml", name_curve(write_diesel(extra=GAS)))
    best = ask_json("search", path, "--over", "torsion.loss=0.01:0.1", "--minimise", "torsion.misfit")["results"][0]
    assert best["torsion.loss"] == pytest.approx(0.05, rel=1e-4)
    assert best["quantities"]["torsion.misfit"] < 1e-5


def test_the_picture_has_the_points(diesel):
    axes = plot(torsion(diesel, range(1000, 2001, 50)), "response").axes[-1]
    points = [line for line in axes.lines if line.get_marker() == "o"]
    assert [len(line.get_xdata()) for line in points] == [1, 1, 3]


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ("speed_rpm,order\n1000,2\n", 'm.csv: the heading "speed_rpm,order" has no amplitude_deg'),
        (HEAD, "m.csv: has no rows; give speed, order and amplitude in each"),
        (HEAD + "1000,2,1\n1000,2.25,1\n", "m.csv: line 3: 2.25 is no order; give a multiple of 1/2 up to 256"),
        (HEAD + "1000,0,1\n", "m.csv: line 2: 0 is no order"),
        (HEAD + "1000,2,-0.5\n", "m.csv: line 2: the amplitude -0.5 deg is negative"),
        (HEAD + "-10,2,0.5\n", "m.csv: line 2: the speed -10 rpm is not above 0"),
    ],
)
def test_mistakes_of_a_curve_have_their_line(tmp_path, rows, told):
    write(tmp_path / "m.csv", rows)
    path = write(tmp_path / "diesel.toml", name_curve(write_diesel()))
    message = refusal("torsion", path)
    assert message.startswith(f"{path}: torsion.measured: ")
    assert told in message


def test_a_misfit_needs_a_curve(tmp_path):
    path = write(tmp_path / "diesel.toml", write_diesel())
    told = refusal("sweep", path, "--vary", "torsion.loss=0.01,0.02", "-q", "torsion.misfit")
    assert told.endswith("torsion.misfit: the file has no measured curve; name its file in torsion.measured")


def test_numbers_lists_the_misfit_of_a_file_with_a_curve(diesel, tmp_path):
    listed = json.loads(ask("numbers", diesel, "-f", "json"))["quantities"]
    assert "torsion.misfit" in [quantity["name"] for quantity in listed]
    plain = write(tmp_path / "plain.toml", write_diesel(extra=GAS))
    listed = json.loads(ask("numbers", plain, "-f", "json"))["quantities"]
    assert "torsion.misfit" not in [quantity["name"] for quantity in listed]
