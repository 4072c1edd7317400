"""The ending of a file's name says what is written into it; `-` is standard output."""

import csv
import io
import json
import os
import sys
from pathlib import Path
from unittest.mock import Mock

import pytest
from support.cases import cases
from support.commands import ask_csv, refusal, run_command, run_here
from support.engines import GOOD, changed

from balcli import __version__
from balcli.studies import sweep as studies

unix = pytest.mark.skipif(sys.platform == "win32", reason="needs /dev/stdout")
VARY = ("--vary", "crank.stroke=80,90")
SEARCH = ("--over", "throws", "--minimise", "moment.1.major")


@pytest.fixture(autouse=True)
def good(tmp_path, monkeypatch):
    """A folder with good.toml, in which commands run."""
    monkeypatch.chdir(tmp_path)
    Path("good.toml").write_text(GOOD)


def written(*args: object) -> bytes:
    """What the last argument, a new file, then contains."""
    *_, name = args
    assert run_here(*args)[0] == 0
    return Path(str(name)).read_bytes()


TEXTS = {"txt": "table", "json": "json", "csv": "csv", "md": "markdown"}
SERIES = {"csv": "csv", "json": "json"}
COMMANDS = [
    *(("analyze", TEXTS), ("balance", TEXTS), ("curves --step 90", SERIES), ("scatter --samples 9 --seed 1", TEXTS)),
    *((f"sweep {' '.join(VARY)}", TEXTS), (f"search {' '.join(SEARCH)}", TEXTS)),
]


@pytest.mark.parametrize(("command", "formats"), COMMANDS, ids=lambda v: str(v).split()[0])
def test_the_ending_chooses_the_format(command, formats):
    name, *rest = command.split()
    for ending, form in formats.items():
        printed = run_here(name, "good.toml", *rest, "--format", form)[1].encode()
        assert written(name, "good.toml", *rest, "-o", f"x.{ending}") == printed


def test_the_ending_may_be_in_capitals():
    for ending, form in TEXTS.items():
        printed = run_here("piston", "good.toml", "--format", form)[1].encode()
        assert written("piston", "good.toml", "-o", f"X.{ending.upper()}") == printed


@pytest.mark.parametrize("name", ["results", "results.2024"])
def test_a_format_that_is_said_needs_no_ending_that_is_known(name):
    printed = run_here("analyze", "good.toml", "-f", "json")[1].encode()
    assert written("analyze", "good.toml", "-f", "json", "-o", name) == printed


PICTURES = ".svg, .png or .pdf"


@cases("shell/file_names", "an_ending_that_cannot_be_is_refused", PICTURES=PICTURES, SEARCH=SEARCH, VARY=VARY)
def test_an_ending_that_cannot_be_is_refused(args, can):
    name, *rest = args
    option = {"-o": "--output"}.get(rest[-2], rest[-2])
    target = rest[-1]
    assert refusal(name, "good.toml", *rest) == (
        f"{option} {target}: {Path(target).suffix.lower()} cannot be written here; give a name that ends in {can}"
    )
    assert os.listdir() == ["good.toml"]


@cases("shell/file_names", "a_contradiction_is_refused", VARY=VARY)
def test_a_contradiction_is_refused(args, said):
    name, *rest = args
    assert refusal(name, "good.toml", *rest) == (f"--output {rest[-1]}: {said}; leave one of them out")
    assert os.listdir() == ["good.toml"]


@pytest.mark.parametrize("name", ["new", "engines"])
def test_an_engine_file_is_toml(name):
    kind = {"new": "inline", "engines": "i4"}[name]
    assert refusal(name, kind, "x.csv") == ("FILE x.csv: .csv cannot be written here; give a name that ends in .toml")
    assert run_here(name, kind, "-") == run_here(name, kind)
    assert os.listdir() == ["good.toml"]


def test_the_schema_is_json():
    assert "ends in .json" in refusal("schema", "-o", "x.toml")


@pytest.mark.parametrize(("name", "begins"), [("p.svg", b"<?xml"), ("p.PNG", b"\x89PNG"), ("p.pdf", b"%PDF")])
def test_pictures_of_a_sweep_have_the_forms_of_all_pictures(name, begins):
    assert written("sweep", "good.toml", *VARY, "-o", "x.csv", "--plot", name).startswith(begins)


# ------------------------------------------------------------------ standard output and input
@pytest.mark.parametrize("command", ["analyze good.toml", "curves good.toml", "tables layouts"])
def test_a_dash_is_standard_output(command):
    assert run_here(*command.split(), "-o", "-") == run_here(*command.split())
    assert os.listdir() == ["good.toml"]


def test_a_page_goes_to_standard_output_and_a_picture_does_not():
    assert run_here("report", "good.toml", "-o", "-")[1].startswith("<!doctype html>")
    assert "has no ending" in refusal("plot", "good.toml", "-o", "-")


@unix
def test_the_device_of_standard_output_into_a_pipe():
    done = run_command("analyze", "good.toml", "-o", "/dev/stdout")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == run_here("analyze", "good.toml")[1]


@unix
def test_a_pipe_that_has_no_name():
    """As a shell's `>(…)` is: what it points to is no path."""
    reading, writing = os.pipe()
    args = ("curves", "good.toml", "--step", "90", "-f", "csv", "-o", f"/dev/fd/{writing}")
    done = run_command(*args, pass_fds=[writing])
    os.close(writing)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    with os.fdopen(reading, encoding="utf-8") as stream:
        assert stream.read() == run_here("curves", "good.toml", "--step", "90")[1]


@pytest.mark.parametrize("args", [("analyze", "-", "-"), ("compare", "-", "-"), ("sum", "-", "-")])
def test_standard_input_is_read_once(args):
    assert refusal(*args, stdin=GOOD) == ("standard input (-) is named twice, and can be read only once")


# ------------------------------------------------------------------ pictures of sweeps
def test_a_picture_that_cannot_be_is_refused_before_the_sweep(monkeypatch):
    monkeypatch.setattr(studies, "evaluate_sweep", Mock(side_effect=AssertionError))
    large = ("--vary", "piston.mass=0:2:0.001", "--vary", "crank.stroke=80:100:0.01")
    options = ("-o", "x.csv", "--plot", "x.svg")
    assert refusal("sweep", "good.toml", *large, *options).startswith("4 004 001 variants are too many for a picture")
    told = refusal("sweep", "good.toml", "--vary", "crank.stroke=80", *options)
    assert told.startswith("0 parameters have several values; a picture shows one or two")
    assert os.listdir() == ["good.toml"]


def test_a_picture_takes_the_figures_that_are_written(monkeypatch):
    counted = Mock(side_effect=studies.evaluate_sweep)
    monkeypatch.setattr(studies, "evaluate_sweep", counted)
    assert run_here("sweep", "good.toml", *VARY, "-o", "x.csv", "--plot", "x.svg")[0] == 0
    assert counted.call_count == 1


# ------------------------------------------------------------------ spreadsheets
@pytest.mark.parametrize("name", ["=1+1", "-1", "\uff1d1+1"])
def test_a_spreadsheet_takes_no_name_for_a_formula(name):
    for file in ("a.toml", "b.toml"):
        Path(file).write_text(changed(('"in-line four"', json.dumps(name + file))))
    lines = ask_csv("analyze", "a.toml")
    assert {line["engine"] for line in lines} == {f"'{name}a.toml"}
    assert any(line["value"].startswith("-") for line in lines)  # numbers stay numbers
    heads = next(csv.reader(io.StringIO(run_here("compare", "a.toml", "b.toml", "-f", "csv")[1])))
    assert heads[3:] == [f"'{name}a.toml", f"'{name}b.toml"]


@pytest.mark.parametrize("name", ["a;=1+1;b", 'a "b", c'])
def test_a_name_stays_in_one_cell_whatever_parts_cells(name):
    Path("a.toml").write_text(changed(('"in-line four"', json.dumps(name))))
    cell = '"' + name.replace('"', '""') + '"'
    assert run_here("compare", "a.toml", "good.toml", "-f", "csv")[1].splitlines()[0].split(cell)[1] == ",in-line four"


# ------------------------------------------------------------------ Parquet
def test_parquet_says_nothing_where_there_is_nothing_and_what_it_is():
    parquet = pytest.importorskip("pyarrow.parquet")
    asked = ("-q", "force.1.major,force.1.axis", "-o", "x.parquet")
    assert run_here("sweep", "good.toml", *VARY, *asked) == (0, "", "")
    table = parquet.read_table("x.parquet")
    assert table["force.1.axis"].null_count == 2  # order 1 is balanced and has none
    assert table["crank.stroke"].to_pylist() == [80, 90]
    assert table.schema.field("force.1.major").metadata == {b"unit": b"N"}
    assert table.schema.field("crank.stroke").metadata == {b"unit": b"mm"}
    assert table.schema.metadata[b"balcli.engine"] == b"in-line four"
    assert table.schema.metadata[b"balcli.version"] == __version__.encode()


@pytest.mark.parametrize(("command", "ending"), [("plot", ".svg"), ("report", ".html")])
def test_one_file_is_named_to_write_and_may_be_the_second_name(command, ending):
    """Without a name, the file has that of the engine file, and standard error says so."""
    little = ("--what", "polar") if command == "plot" else ()
    assert run_here(command, "good.toml", f"X{ending}", *little) == (0, "", "")
    assert Path(f"X{ending}").stat().st_size > 1000
    assert run_here(command, "good.toml", *little) == (0, "", f"written: good{ending}\n")
    assert Path(f"good{ending}").stat().st_size > 1000
    assert run_here("-q", command, "good.toml", *little) == (0, "", "")
    assert refusal(command, "-") == f"name the file to write, such as -o X{ending}"
    assert refusal(command, "good.toml", "a.svg", "-o", "b.svg") == (
        "a.svg and --output b.svg: one file is written; leave one out"
    )


def test_a_page_is_opened_in_the_browser(monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or len(opened) < 2)
    assert run_here("report", "good.toml", "X.html", "--open") == (0, "", "")
    assert opened == [Path("X.html").resolve().as_uri()]
    assert run_here("report", "good.toml", "X.html", "--open") == (0, "", "warning: no browser was found for X.html\n")
    assert refusal("report", "good.toml", "-o", "-", "--open") == "--open needs a file"


# ------------------------------------------------------------------ names of examples
@pytest.mark.parametrize(
    ("typed", "there", "title"),
    [
        ("i3", False, "in-line three"),
        ("i3", True, "mine"),  # a file of this name has precedence
        ("./i3", True, "mine"),
        ("./i3", False, None),
    ],
)
def test_the_name_of_an_example_stands_for_its_file(typed, there, title):
    if there:
        Path("i3").write_text(changed(("in-line four", "mine")))
    status, out, err = run_here("analyze", typed, "--only", "force")
    assert (out.partition("\n")[0] if status == 0 else None) == title
    assert (err == "i3: the example engine\n") == (title == "in-line three")


def test_a_file_that_the_name_may_mean_is_told():
    Path("i3.toml").write_text(GOOD)
    assert run_here("numbers", "i3").err == "i3: the example engine, not i3.toml\n"
    assert run_here("numbers", "i3", "-q").err == ""


@pytest.mark.parametrize(
    "command", ["numbers i3", "compare i3 i4 --only force", "torque i4_wiebe", "torsion i6_diesel"]
)
def test_commands_of_one_engine_take_the_name_of_an_example(command):
    status, _, err = run_here(*command.split())
    name = command.split()[1]
    assert status == 0
    assert err.startswith(f"{name}: the example engine\n")


def test_messages_call_an_example_by_its_name():
    assert "balcli: i3: has no [gas]" in run_here("torque", "i3").err


def test_a_page_of_an_example_has_its_name():
    assert run_here("plot", "i3", "--what", "polar").err == "i3: the example engine\nwritten: i3.svg\n"
    assert Path("i3.svg").is_file()
