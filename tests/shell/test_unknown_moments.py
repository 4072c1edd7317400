"""A file that does not say where its throws stand: their moments are not known, and nobody may take them for balanced."""

import csv
import io
import json
import re

import pytest
from support.cases import cases
from support.commands import ask, ask_json, refusal
from support.engines import changed
from support.paths import write

from balcli import analyze, load

UNKNOWN = (
    "moments are not known, because crank.spacing is missing: give it (or crank.positions); 0 "
    "means that all throws are in one plane"
)
WARNING = f"warning: {{}}: {UNKNOWN}\n"
FLAT_CRANK = ("throws = [0, 180, 180, 0]", "throws = [0, 180]")
NO_ORDER = ("firing_order = [1, 3, 4, 2]", "")
NO_SPACING = ("spacing = 100\n", "")
NO_PLACES = {"path": "crank.spacing", "value": 0.0, "unit": "mm"}


@pytest.fixture
def twin(tmp_path):
    """A 180-degree twin, whose large moment the file leaves open."""
    return write(tmp_path / "twin.toml", changed(FLAT_CRANK, NO_ORDER, NO_SPACING))


def test_a_table_has_dashes_and_the_verdict_judges_forces_alone(balcli, twin):
    status, out, err = balcli("analyze", twin, "--all")
    assert (status, err) == (0, WARNING.format(twin))
    moments = out.partition("Free moment by order")[2].partition("About the crank axis")[0]
    rows = [line.split() for line in moments.splitlines() if line[:1] in "12"][:2]
    assert rows == [[order, *5 * "–"] for order in "12"]
    assert "Free moment in textbook units" not in out
    assert "moment  –" in out
    told = " ".join(out.partition("\nVerdict\n")[2].split())
    assert told.startswith(
        "Second order: force of 1705 N along x; shafts at +2 and -2 cancel it. Order 1: force and couple balanced"
    )
    assert UNKNOWN[1:] in told
    assert "moment balanced" not in told
    assert "no moment" not in told
    brief = balcli("analyze", twin)[1]
    assert "moment – N" not in brief
    assert re.search(r"^1 +balanced +– +– +–$", brief, re.MULTILINE)
    ladder = brief.partition("What balances it, step by step")[2]
    assert "force, " in ladder
    assert "moment" not in ladder


def test_json_keeps_the_figures_of_one_plane_and_says_so(balcli, twin, tmp_path):
    said = write(tmp_path / "said.toml", twin.read_text().replace("[rod]", "spacing = 0\n[rod]"))
    for command in ("analyze", "balance"):
        known = ask_json(command, said)
        found = json.loads(balcli(command, twin, "--format", "json").out)
        assert NO_PLACES not in known["assumed"]
        assert "moment_Nm" in known["ladder"]["scale"]
        assert "moment_Nm" not in found["ladder"]["scale"]
        assert "bearings" not in found.get("after", {})
        for state in ("before", "after"):
            known.get(state, {}).pop("bearings", None)
        for one in (found, known):  # of what moments decide nothing is told
            for key in ("ladder", "sizing", "step", "verdict"):
                one.pop(key, None)
        assert found == known | {"assumed": [NO_PLACES, *known["assumed"]]}


def test_csv_has_no_moments(balcli, twin):
    for command in ("analyze", "balance"):
        rows = list(csv.DictReader(io.StringIO(balcli(command, twin, "--format", "csv")[1])))
        assert {"force", "roll"} <= {row["quantity"] for row in rows}
        assert "moment" not in {row["quantity"] for row in rows}


@cases("shell/unknown_moments", "a_moment_by_name_is_an_error")
def test_a_moment_by_name_is_an_error(twin, command, args, message):
    asked = [arg.format(file=twin) for arg in args]
    assert refusal(command, twin, *asked) == f"{message.format(file=twin)}{UNKNOWN}"


def test_a_weight_in_one_plane_takes_the_whole_force(balcli, tmp_path):
    """What moment it makes is not known, and lessens nothing."""
    file = write(tmp_path / "skew.toml", changed((FLAT_CRANK[0], "throws = [0, 90]"), NO_ORDER, NO_SPACING))
    found = json.loads(balcli("balance", file, "--scheme", "counterweights", "--planes=20", "-f", "json").out)
    assert found["after"]["orders"][0]["force_N"]["forward"] == [0, 0]
    *failed, err = balcli("balance", file, "--scheme", "counterweights", "--planes=-100,20")
    assert failed == [2, ""]
    assert err.endswith(f"--planes: {UNKNOWN}\n")


def test_forces_are_swept_and_a_spacing_that_is_varied_is_known(twin):
    assert ask("sweep", twin, "--vary", "rod.length=150,160", "-q", "force.2.major")
    out = ask("sweep", twin, "--vary", "crank.spacing=80,100", "-q", "moment.1.major")
    low, high = (float(line.split(",")[1]) for line in out.splitlines()[1:])
    assert high / low == pytest.approx(100 / 80)


@pytest.mark.parametrize("command", [["sweep", "--vary", "rod.length=150,160"], ["scatter"]])
def test_the_usual_quantities_are_those_that_are_known(balcli, twin, command):
    status, out, err = balcli(command[0], twin, *command[1:], "--format", "csv")
    assert (status, err) == (0, WARNING.format(twin))
    assert "force.2.major" in out
    assert "moment" not in out


def test_curves_have_no_moments(balcli, twin):
    status, out, err = balcli("curves", twin, "--step", "90")
    assert (status, err) == (0, WARNING.format(twin))
    assert out.splitlines()[0] == "crank_deg,force_x_N,force_y_N,couple_Nm,inertia_torque_Nm,roll_Nm"
    found = json.loads(balcli("curves", twin, "--format", "json")[1])
    assert NO_PLACES in found["assumed"]
    assert "moment_x_Nm" in found["curves"]


def test_rows_in_python_have_no_figure_of_a_moment(twin):
    """Nor a direction: the axis of a vector that is not known was 90 deg."""
    row, *_ = analyze(load(twin)).rows()
    moments = {name: value for name, value in row.items() if name.startswith("moment.")}
    assert len(moments) == 5
    assert set(moments.values()) == {None}
