"""What every answer can do: one idea, tried on all that there are."""

import json
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from support.commands import ask
from support.paths import ENGINES, write
from support.rotors import three_runs

import balcli
from balcli.analysis.answer import QUANTITIES
from balcli.names import RENDERERS
from balcli.show import result as exchange
from balcli.show.result import Result

NAMES = ("i3", "i4", "i4_wiebe", "i6_diesel", "i4_mounts", "historic/locomotive4")
FILES = {name: str(ENGINES / f"{name}.toml") for name in NAMES}
SPREAD = "force.2.major"
ROUND = ["force.2.major", "force.1.axis"]  # the second is of a circle, and has no value
SPEEDS = np.array([1500.0, 2000.0])


def load(name: str) -> balcli.Engine:
    return balcli.load(FILES[name])


# How each answer is had, and the command that writes the same as JSON; an example stands for its file.
ANSWERS: dict[str, tuple[Callable[[], Result], str]] = {
    "Analysis": (lambda: balcli.analyze(load("i3"), only=QUANTITIES), "analyze i3"),
    "Balance": (lambda: balcli.balance(load("i3"), "counterweights"), "balance i3 --scheme counterweights"),
    "Combined": (
        lambda: balcli.sum(load("i3"), load("i4"), phase=90, at=(0.3, 0, 0)),
        "sum i3 i4 --phase 90 --at 300,0,0",
    ),
    "Comparison": (lambda: balcli.compare(load("i3"), load("i4")), "compare i3 i4"),
    "Curves": (lambda: balcli.curves(load("i3"), 30), "curves i3 --step 30"),
    "FieldBalance": (lambda: balcli.field(three_runs()), "field -"),
    "LocomotiveBalance": (
        lambda: balcli.locomotive(load("historic/locomotive4"), "1/2", speed="60 mph"),
        "locomotive historic/locomotive4 --factor 1/2 --speed 60mph",
    ),
    "MountReport": (
        lambda: balcli.mounts(load("i4_mounts"), SPEEDS, orders=[2]),
        "mounts i4_mounts --speeds 1500,2000 --orders 2",
    ),
    "SchemeComparison": (lambda: balcli.compare_schemes(load("i4")), "balance i4 --scheme all"),
    "Scatter": (
        lambda: balcli.scatter(load("i4"), SPREAD, mass_scatter=0.01, samples=100, seed=1),
        f"scatter i4 -q {SPREAD} --mass-scatter 1% --samples 100 --seed 1",
    ),
    "Search": (lambda: balcli.search(load("i4"), "throws", SPREAD), f"search i4 --over throws --minimise {SPREAD}"),
    "Pistons": (lambda: balcli.piston(load("i4")), "piston i4"),
    "Swept": (
        lambda: balcli.sweep(load("i4"), {"rod.ratio": [0.25, 0.3], "piston.mass": "0.4:0.5:0.05"}, ROUND),
        f"sweep i4 --vary rod.ratio=0.25,0.3 --vary piston.mass=0.4:0.5:0.05 -q {','.join(ROUND)}",
    ),
    "Table": (lambda: balcli.tables("liu-3"), "tables liu-3"),
    "TorqueAnalysis": (
        lambda: balcli.torque(load("i4_wiebe"), [2, 4], fluctuation=1 / 200),
        "torque i4_wiebe --orders 2,4 --fluctuation 1/200",
    ),
    "TorsionAnalysis": (
        lambda: balcli.torsion(load("i6_diesel"), SPEEDS, orders=[3, 4.5, 6]),
        "torsion i6_diesel --speeds 1500,2000 --orders 3,4.5,6",
    ),
}


@cache
def ask_library(name: str) -> Result:
    return ANSWERS[name][0]()


def print_answer(name: str, form: str) -> str:
    words = [FILES.get(word, word) for word in ANSWERS[name][1].split()]
    return ask(*words, "--format", form, stdin=three_runs())


def test_all_answers_are_tried():
    assert ANSWERS.keys() == RENDERERS.keys()


@pytest.mark.parametrize("name", ANSWERS)
def test_a_dict_is_the_document_that_the_command_writes(name):
    found = ask_library(name).to_dict()
    assert json.loads(json.dumps(found, allow_nan=False)) == json.loads(print_answer(name, "json"))


@pytest.mark.parametrize("name", ANSWERS)
def test_rows_are_the_same_everywhere(name, tmp_path):
    """With the same keys, no nan and one type a column; numbers stay numbers where some are missing."""
    pandas = pytest.importorskip("pandas")
    parquet = pytest.importorskip("pyarrow.parquet")
    answer = ask_library(name)
    rows = answer.rows()
    frame = answer.to_pandas()
    assert {tuple(row) for row in rows} == {tuple(frame)}
    for column in tuple(frame):
        values = [row[column] for row in rows if row[column] is not None]
        kinds = {type(value) for value in values}
        assert kinds <= {float, int} or kinds == {str}
        assert all(value == value for value in values)
        assert frame[column].dtype.kind in "iuf" or kinds == {str}, column
    pandas.testing.assert_frame_equal(frame, pandas.DataFrame(rows).astype(frame.dtypes))
    assert frame.attrs["units"].keys() <= set(frame)
    answer.to_parquet(tmp_path / "answer.parquet")
    assert parquet.read_table(tmp_path / "answer.parquet").to_pylist() == rows
    assert re.fullmatch(rf"<{name} .{{1,140}}>", repr(answer))
    assert "array" not in repr(answer)


def read_page(shown: Result) -> str:
    """The text of its page, all of whose tags are closed."""
    return "".join(ElementTree.fromstring(f"<div>{shown._repr_html_()}</div>").itertext())


@pytest.mark.parametrize("name", [name for name in ANSWERS if name not in ("Curves", "Swept")])
def test_a_notebook_shows_what_the_command_prints(name):
    """Every word but the name of an option, in tables whose tags are closed."""
    page = read_page(ask_library(name))
    assert "--all" not in page
    plain = print_answer(name, "markdown").replace("--all shows them.", "")
    words = re.sub(r"[\\|*#]|^- |--+:?", " ", plain, flags=re.MULTILINE).split()
    assert [word for word in words if word.rstrip(":") not in page] == []


@pytest.mark.parametrize(
    "name", [name for name in ANSWERS if name not in ("Analysis", "Curves", "Swept", "FieldBalance")]
)
def test_a_text_is_what_the_command_prints(name):
    assert ask_library(name).text() == print_answer(name, "table").rstrip("\n")


def test_a_text_has_a_width_and_units():
    found = load("i4").analyze(only=["force"], orders=[1, 2, 4])
    assert "lbf" in found.text(units="imperial")
    assert "lbf" not in found.text()
    series = balcli.curves(load("i4"), 90)
    assert [series.text(width).count("crank_deg") for width in (None, 100, 60)] == [1, 1, 2]


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"width": 0}, balcli.BalcliError, "width: 0; give a whole number from 1"),
        ({"width": "80"}, TypeError, "width: '80' (str): give a whole number, such as 80"),
        ({"units": "metric"}, balcli.BalcliError, "units 'metric': choose from si, imperial"),
        ({"units": 1}, TypeError, 'units: 1 (int): give "si" or "imperial"'),
    ],
)
def test_a_text_refuses_what_is_no_width_or_unit(arguments, error, message):
    with pytest.raises(error, match=f"^{re.escape(message)}$"):
        load("i4").analyze().text(**arguments)


def test_a_notebook_shows_the_ends_of_what_is_long():
    found = balcli.curves(load("i3"))
    shown = re.findall(r"<tr><td>([\d.]+)</td>", found._repr_html_())
    assert shown == ["0", "1", "2", "3", "4", "...", "355", "356", "357", "358", "359"]
    assert "360 rows" in read_page(found)
    assert "..." not in read_page(balcli.curves(load("i3"), 36))


def test_names_of_others_are_no_html():
    engine = load("i4").vary(name="<script>alert(1)</script>")
    for shown in (engine, balcli.analyze(engine), balcli.balance(engine, "four-shaft")):
        assert "<script" not in shown._repr_html_()
        assert "&lt;script&gt;" in shown._repr_html_()


def test_orders_of_an_analysis_are_a_table_with_units():
    found = balcli.analyze(load("i4"), [2, 4])
    rows = found.rows()
    assert [row["order"] for row in rows] == [2, 4]
    assert rows[0]["force.major"] == found.spectra.force.major[0]
    assert rows[0]["roll.amplitude"] == found.spectra.roll.major[0]
    theta = 0.3
    value = sum(
        r["torque.cos"] * np.cos(r["order"] * theta) + r["torque.sin"] * np.sin(r["order"] * theta) for r in rows
    )
    assert value == pytest.approx(found.spectra.torque.values(np.array([theta]))[0].real, rel=1e-12)
    units = found.to_pandas().attrs["units"]
    assert (units["force.major"], units["force.axis"], units["moment.minor"]) == ("N", "deg", "N·m")


def test_columns_of_one_name_stay_apart():
    four = load("i4")
    rows = balcli.compare(four, four.vary({"operation.speed": 2 * four.speed_rpm}), names=["order", "order"]).rows()
    largest = next(row for row in rows if row["quantity"] == "force" and row["order"] == 2)
    assert largest["order (5)"] == pytest.approx(4 * largest["order (4)"])


@pytest.mark.parametrize(
    ("library", "method", "install"), [("pandas", "to_pandas", "pandas"), ("pyarrow", "to_parquet", r"balcli\[scale\]")]
)
def test_a_library_that_is_missing_is_named(library, method, install, monkeypatch, tmp_path):
    found = balcli.analyze(load("i4"), [2])
    for name in [each for each in sys.modules if each.partition(".")[0] == library]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, library, None)
    arguments = (tmp_path / "a.parquet",) if method == "to_parquet" else ()
    with pytest.raises(balcli.BalcliError, match=rf"^{method}\(\) needs {library}: pip install {install}$"):
        getattr(found, method)(*arguments)


def test_a_parquet_file_that_fails_leaves_the_older_one(monkeypatch, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    place = write(tmp_path / "a.parquet", "old")

    def run_full(table, path):
        Path(path).write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(parquet, "write_table", run_full)
    with pytest.raises(balcli.BalcliError, match=r"a\.parquet: cannot be written \(No space"):
        balcli.analyze(load("i4"), [2]).to_parquet(str(place))
    assert place.read_text() == "old"
    assert list(tmp_path.iterdir()) == [place]


def test_a_balance_has_a_row_for_every_device_with_its_units():
    found = balcli.balance(load("i3"))
    rows = found.rows()
    assert len(rows) == len(found.remedy.devices)
    kinds = [row["device"] for row in rows]
    assert kinds == sorted(kinds)
    first = found.remedy.devices[0]
    assert (rows[0]["unbalance"], rows[0]["position"]) == (first.unbalance, first.position)
    assert rows[0]["mass"] == found.practical[0].mass_kg
    units = exchange.list_columns(found).units
    assert (units["unbalance"], units["mass"], units["force"]) == ("g·mm", "kg", "N")
