"""`balcli check`: what is recorded, what moved, and how it is named."""

import json
import math
import os
import shutil
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from support.cases import cases, slow
from support.engines import GOOD, build_text, changed
from support.paths import ENGINE_FILES, ENGINES, GEARED_FILES, write

from balcli import load_example
from balcli.analysis.answer import analyze
from balcli.regression import comparison
from balcli.regression.comparison import TOLERANCE, find_differences, find_record, record_result


@pytest.fixture
def check(balcli):
    return lambda *args: balcli("check", *args)


@pytest.fixture
def file(tmp_path):
    """An engine file with its recorded result."""
    engine_file = write(tmp_path / "four.toml", GOOD)
    target = find_record(engine_file)
    target.parent.mkdir()
    target.write_text(record_result(build_text(GOOD)))
    return engine_file


@pytest.fixture
def record(tmp_path):
    """Where the result of an engine is recorded."""
    (tmp_path / "expected").mkdir()
    return tmp_path / "expected" / "x.json"


def edited(file: Path, edit) -> None:
    """Changes the recorded result of an engine file."""
    target = find_record(file)
    document = json.loads(target.read_text())
    edit(document)
    target.write_text(json.dumps(document))


def test_all_example_engines_are_as_recorded(check):
    assert check(ENGINES) == (0, f"{len(ENGINE_FILES) + len(GEARED_FILES)} engines, 0 differences\n", "")


def test_each_assumed_value_has_a_scale_of_its_own(tmp_path):
    """An index that moves by 1e-6 is found next to an inertia of 3105 kg mm2."""
    text = changed(more='[gas]\ncycle = "otto"\ncompression_ratio = 10\nimep = 9\n')
    found = build_text(text)
    target = write(tmp_path / "four.json", record_result(found))
    document = json.loads(target.read_text())
    assert {"path": "rod.inertia", "value": 3105.0, "unit": "kg mm^2"} in document["assumed"]
    (index,) = (value for value in document["assumed"] if value["path"] == "gas.compression_index")
    index["value"] += 1e-6
    target.write_text(json.dumps(document))
    (difference,) = find_differences(found, target)
    assert difference.figure == "assumed path gas.compression_index value"
    assert difference.cause == "assumed"


def test_folders_within_a_folder_are_checked_hidden_ones_and_settings_are_not(check, tmp_path):
    for place in ("a", "a/b", ".venv/c", "a/.tox"):
        (tmp_path / place).mkdir(parents=True)
        shutil.copy(ENGINES / "single.toml", tmp_path / place / "single.toml")
    (tmp_path / "pyproject.toml").write_text("[tool.balcli]\n")
    assert check("--update", tmp_path) == (0, "2 engines recorded\n", "")
    assert (tmp_path / "a/b/expected/single.json").exists()
    assert not (tmp_path / ".venv/c/expected").exists()
    assert check(tmp_path) == (0, "2 engines, 0 differences\n", "")


def test_files_of_other_kinds_in_a_folder_are_passed_over(check, file, tmp_path):
    """A rotor's runs and the drive line stand beside the engine; named, they are refused."""
    runs, line = tmp_path / "rotor.toml", tmp_path / "line.toml"
    runs.write_text("planes = ['a']\n[[run]]\nreadings = ['3 @ 0']\n")
    line.write_text("node = [{ name = 'a', inertia = 1 }]\n")
    assert check(tmp_path) == (0, "1 engine, 0 differences\n", "")
    status, out, err = check(tmp_path, runs)
    assert (status, out) == (2, "1 engine, 0 differences\n")
    assert "rotor.toml: is a file of runs, which balcli field reads; give an engine file" in err
    file.unlink()
    find_record(file).unlink()
    status, _, err = check(tmp_path)
    assert (status, err) == (2, f"balcli: {tmp_path}: has no engine files (*.toml)\n")


def test_recorded_results_are_the_product_of_todays_program(tmp_path, check):
    """check --update writes the same file again: keys, digits and layout."""
    shutil.copy(ENGINES / "v8_crossplane.toml", tmp_path)
    assert check("--update", tmp_path) == (0, "1 engine recorded\n", "")
    old, new = (json.loads(p.joinpath("expected/v8_crossplane.json").read_text()) for p in (ENGINES, tmp_path))
    assert old.keys() == new.keys()
    assert [o.keys() for o in old["orders"]] == [n.keys() for n in new["orders"]]


def test_an_engine_without_a_recorded_result_is_a_difference(check, tmp_path):
    lonely = write(tmp_path / "lonely.toml", GOOD)
    told = f"{lonely}: no result is recorded in expected/lonely.json; check --update records it\n"
    assert check(lonely) == (1, f"{told}1 engine, 1 difference\n", "")
    assert not (tmp_path / "expected").exists()
    assert check(lonely, "--update") == (0, "1 engine recorded\n", "")
    assert check(lonely) == (0, "1 engine, 0 differences\n", "")


GONE = "its result is recorded in expected/{0}.json, but there is no {0}.toml; restore it, or delete the record\n"


def test_a_record_whose_engine_is_gone_is_a_difference(check, file, tmp_path):
    """In a folder that is checked; where a file is checked, its neighbours are nobody's matter."""
    lost = write(tmp_path / "lost.toml", GOOD)
    assert check("--update", tmp_path) == (0, "2 engines recorded\n", "")
    hidden = tmp_path / ".old" / "expected"
    hidden.mkdir(parents=True)
    (hidden / "x.json").write_text("{}")
    lost.unlink()
    told = f"{lost}: {GONE.format('lost')}"
    assert check(tmp_path) == (1, f"{told}1 engine, 1 difference\n", "")
    assert check(tmp_path, file) == (1, f"{told}2 engines, 1 difference\n", "")
    assert check(file) == (0, "1 engine, 0 differences\n", "")
    assert check("--update", tmp_path) == (1, f"{told}1 engine recorded\n", "")


def test_engines_of_one_name_are_told_apart_by_their_folders(check, file, tmp_path):
    """Two generations of an engine: whose figures moved is what a maintainer asks."""
    second = tmp_path / "second" / file.name
    second.parent.mkdir()
    second.write_bytes(file.read_bytes())
    told = "no result is recorded in expected/four.json; check --update records it\n"
    assert check(tmp_path)[1] == f"{second}: {told}2 engines, 1 difference\n"
    assert check(second)[1] == f"{second}: {told}1 engine, 1 difference\n"
    check("--update", tmp_path)
    second.unlink()
    assert check(tmp_path)[1] == f"{second}: {GONE.format('four')}1 engine, 1 difference\n"


@pytest.mark.parametrize("text", ['{"status": 200}', "[1, 2]", "not JSON", '{"format": 3}'])
def test_what_others_expect_is_no_record(check, file, tmp_path, text):
    theirs = tmp_path / "tests" / "expected"
    theirs.mkdir(parents=True)
    (theirs / "answer.json").write_text(text)
    assert check(tmp_path) == (0, "1 engine, 0 differences\n", "")


@cases("regression", "a_broken_record_is_a_difference", NOUGHTS=400 * "0")
def test_a_broken_record_is_a_difference(check, file, text, reason):
    find_record(file).write_text(text)
    told = (
        f"{file}: the result recorded in expected/four.json cannot be read ({reason}); check --update records it anew"
    )
    assert check(file) == (1, f"{told}\n1 engine, 1 difference\n", "")
    assert check(file, "--update") == (0, "1 engine recorded\n", "")
    assert check(file) == (0, "1 engine, 0 differences\n", "")


@cases("regression", "no_record_however_broken_brings_check_down")
def test_no_record_however_broken_brings_check_down(check, file, text):
    find_record(file).write_text(text, encoding="latin-1")
    status, out, err = check(file)
    assert (status, err) == (1, "")
    assert out.startswith(f"{file}: ")


def test_a_bad_engine_file_among_good_ones(check, file, tmp_path):
    (tmp_path / "a.toml").write_text("[crank]")
    status, out, err = check(tmp_path)
    assert (status, out) == (2, "1 engine, 0 differences\n")
    assert err.startswith(f"balcli: {tmp_path / 'a.toml'}: ")


# ------------------------------------------------------------------ figures
def test_every_figure_that_moved_is_named(check, file):
    """A tenth of a per cent more piston moves forces, torque and roll; one line sums up each of them."""
    before = {e["order"]: e["force_N"] for e in json.loads(find_record(file).read_text())["orders"]}
    file.write_text(changed(("mass = 0.5", "mass = 0.5005")))
    status, out, err = check(file)
    assert (status, err) == (1, "")
    *lines, last = out.splitlines()
    figures = [line for line in lines if line.startswith("  ")]
    assert last == f"1 engine, {len(figures)} differences"
    assert [line.split(": ")[1] for line in lines if line.startswith(str(file))] == ["force", "torque", "roll"]
    (line,) = [line for line in figures if line.startswith("  order 2 force_N forward x: ")]
    old, new = (float(text.split()[0]) for text in line.split(": ")[1].split(" -> "))
    assert old == pytest.approx(before[2]["forward"][0], rel=1e-9)
    recip = 0.5 + 0.6 * 45 / 160
    assert new == pytest.approx(old * (recip + 0.0005) / recip, rel=1e-9)
    assert check(file, "--tolerance", "0.01") == (0, "1 engine, 0 differences\n", "")


def test_differences_as_json_and_for_continuous_integration(check, file, tmp_path):
    write(tmp_path / "good & well.toml", GOOD)
    check("--update", tmp_path)
    edited(file, lambda document: document["peak"].update(force_N=1.0))
    status, out, _ = check(tmp_path, "-f", "json")
    first, second = json.loads(out)["engines"]
    assert (status, first["engine"], len(first["differences"]), second["differences"]) == (1, str(file), 1, [])
    assert first["differences"][0]["recorded"] == 1
    status, out, _ = check(tmp_path, "-f", "junit")
    suite = ElementTree.fromstring(out)
    assert (status, suite.get("tests"), suite.get("failures")) == (1, "2", "1")
    assert [len(case) for case in suite] == [1, 0]


def test_a_broken_file_is_in_both_reports(check, file, tmp_path):
    check("--update", tmp_path)
    write(tmp_path / "broken.toml", "x =")
    status, out, err = check(tmp_path, "-f", "json")
    first = json.loads(out)["engines"][0]
    assert status == 2
    assert first["error"] in err
    assert "not valid TOML" in first["error"]
    suite = ElementTree.fromstring(check(tmp_path, "-f", "junit")[1])
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("2", "0", "1")
    assert suite[0].get("name").endswith("broken.toml")
    assert "not valid TOML" in suite[0][0].get("message")


def _list_paths(value, path=()):
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _list_paths(part, (*path, key))
    else:
        yield path, value


# What follows from the vectors of an order, which are recorded and compared themselves.
FOLLOWING = {"axis_deg", "phase_deg", "peak_deg", "balanced"}


@pytest.mark.parametrize(
    "name",
    ["i3", *slow("vtwin45", "i4_wiebe", "i6_diesel", "i4_mounts", "radial7_articulated", "rotary9", "v8_crossplane")],
)
def test_a_change_of_any_leaf_is_noticed(record, monkeypatch, name):
    """Vectors, sizes, texts, dead centers, and the figures of further chapters."""
    engine = load_example(name)
    text, described = record_result(engine), comparison._describe(engine)
    monkeypatch.setattr(comparison, "_describe", lambda *_: described)
    record.write_text(text)
    assert find_differences(engine, record) == []
    unnoticed = set()
    for path, value in _list_paths(json.loads(text)):
        document = json.loads(text)
        part = document
        for key in path[:-1]:
            part = part[key]
        changes = {bool: lambda v: not v, float: lambda v: v * 1.1 + 2, int: lambda v: v * 1.1 + 1, str: "{}!".format}
        part[path[-1]] = changes.get(type(value), lambda v: 12.5)(value)
        record.write_text(json.dumps(document))
        angle_of_nothing = path[0] == "peak" and value is None
        if not (find_differences(engine, record) or angle_of_nothing):
            unnoticed.add(path)
    assert {path for path in unnoticed if path[-1] not in FOLLOWING} == set()


def test_the_angle_of_a_peak_may_move_to_an_equal_one(record):
    """The force of an in-line four has two equal peaks a turn, at which it points up and down."""
    engine = load_example("i4")
    document = json.loads(record_result(engine))
    for turn, moved in ((180, 0), (90, 1), (0.01, 1)):
        document["peak"]["force_deg"] = math.degrees(analyze(engine).peak.force.theta) + turn
        record.write_text(json.dumps(document))
        found = [one.figure for one in find_differences(engine, record)]
        assert found == ["peak force_deg"] * moved


def test_where_all_large_orders_cancel_rounding_is_no_difference(record):
    """The rotary's only forces are millionths of what each cylinder makes: their rounding is more than 1e-9 of them."""
    engine = load_example("rotary9")
    force = analyze(engine).spectra.force
    noise = float(np.broadcast_to(force.noise, force.forward.shape)[force.orders == 9][0])
    assert noise > TOLERANCE * force.major.max() > 0
    for roundings in (1.9, 4):
        document = json.loads(record_result(engine))
        (entry,) = [entry for entry in document["orders"] if entry["order"] == 9]
        entry["force_N"]["forward"][0] += roundings * noise
        record.write_text(json.dumps(document))
        assert len(find_differences(engine, record)) == (roundings > 2)


def test_an_order_that_is_not_recorded(check, file):
    edited(file, lambda document: document["orders"].pop(1))
    status, out, _ = check(file)
    assert status == 1
    assert "  order 2 force_N forward x: None -> " in out


# ------------------------------------------------------------------ files of others
def test_a_record_is_not_written_through_a_link_out_of_the_folder(check, tmp_path):
    """An archive may bring such a link; what it points at stays as it is."""
    theirs = write(tmp_path / "theirs.txt", "precious")
    (tmp_path / "mine/expected").mkdir(parents=True)
    engine = write(tmp_path / "mine" / "four.toml", GOOD)
    (tmp_path / "mine/expected/four.json").symlink_to(theirs)
    status, _, err = check(engine, "--update")
    assert (status, theirs.read_text()) == (2, "precious")
    assert "is a link that leads out of the engine's folder" in err


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_an_enormous_record_or_a_pipe_is_a_difference(check, file):
    with find_record(file).open("r+b") as record:
        record.truncate(10**10)  # sparse
    assert "has more than" in check(file)[1]
    find_record(file).unlink()
    os.mkfifo(find_record(file))
    assert "not a regular file" in check(file)[1]
