"""`balcli check`: files and records that it finds, exit status, and what it writes."""

import json
import os
import shutil
from xml.etree import ElementTree

import pytest
from support.cases import cases
from support.engines import GOOD, changed
from support.paths import ENGINE_FILES, ENGINES, GEARED_FILES, write

from balcli.regression.recording import find_record

ADVICE = "; check --update records what is wanted"


def test_all_example_engines_are_as_recorded(check):
    count = len(ENGINE_FILES) + len(GEARED_FILES)
    assert check(ENGINES) == (0, f"{count} engines, all as recorded\n", "")


def test_folders_within_a_folder_are_checked_hidden_ones_and_settings_are_not(check, tmp_path):
    for place in ("a", "a/b", ".venv/c", "a/.tox"):
        (tmp_path / place).mkdir(parents=True)
        shutil.copy(ENGINES / "single.toml", tmp_path / place / "single.toml")
    (tmp_path / "pyproject.toml").write_text("[tool.balcli]\n")
    assert check("--update", tmp_path) == (0, "2 engines recorded\n", "")
    assert (tmp_path / "a/b/expected/single.json").exists()
    assert not (tmp_path / ".venv/c/expected").exists()
    assert check(tmp_path) == (0, "2 engines, all as recorded\n", "")


def test_files_of_other_kinds_in_a_folder_are_passed_over(check, file, tmp_path):
    """A rotor's runs and the drive line stand beside the engine; named, they are refused."""
    runs = tmp_path / "rotor.toml"
    line = tmp_path / "line.toml"
    runs.write_text("planes = ['a']\n[[run]]\nreadings = ['3 @ 0']\n")
    line.write_text("node = [{ name = 'a', inertia = 1 }]\n")
    assert check(tmp_path) == (0, "1 engine, as recorded\n", "")
    status, out, err = check(tmp_path, runs)
    assert (status, out) == (2, "1 engine, as recorded\n")
    assert "rotor.toml: is a file of runs, which balcli field reads; give an engine file" in err
    file.unlink()
    find_record(file).unlink()
    status, _, err = check(tmp_path)
    assert (status, err) == (2, f"balcli: {tmp_path}: has no engine files (*.toml)\n")


def test_recorded_results_are_the_product_of_todays_program(tmp_path, check):
    """check --update writes the same file again: keys and layout."""
    shutil.copy(ENGINES / "v8_crossplane.toml", tmp_path)
    assert check("--update", tmp_path) == (0, "1 engine recorded\n", "")
    old, new = (json.loads(p.joinpath("expected/v8_crossplane.json").read_text()) for p in (ENGINES, tmp_path))
    assert old.keys() == new.keys()
    assert old["inputs"] == new["inputs"]
    assert [o.keys() for o in old["orders"]] == [n.keys() for n in new["orders"]]


# ------------------------------------------------------------------ records that are missing or broken
def test_an_engine_without_a_recorded_result_is_a_difference(check, tmp_path):
    lonely = write(tmp_path / "lonely.toml", GOOD)
    reason = f"{lonely}: no result is recorded; check --update records it\n"
    assert check(lonely) == (1, f"{reason}1 engine: 1 without a record\n", "")
    assert not (tmp_path / "expected").exists()
    assert check(lonely, "--update") == (0, "1 engine recorded\n", "")
    assert check(lonely) == (0, "1 engine, as recorded\n", "")


def test_engines_without_records_are_one_cause(check, tmp_path):
    for name in "abcde":
        write(tmp_path / f"{name}.toml", GOOD)
    a, b, c, *_ = (str(tmp_path / f"{name}.toml") for name in "abcde")
    status, out, _ = check(tmp_path)
    assert (status, out.splitlines()) == (
        1,
        [
            "no result is recorded; check --update records it, in 5 engines",
            f"  {a}, {b}, {c} and 2 more",
            "5 engines: 5 without a record",
        ],
    )


GONE = "its result is recorded in expected/{0}.json, but there is no {0}.toml; restore it, or delete the record\n"


def test_a_record_whose_engine_is_gone_is_a_difference(check, file, tmp_path):
    """In a folder that is checked; where a file is checked, its neighbours are nobody's matter."""
    lost = write(tmp_path / "lost.toml", GOOD)
    assert check("--update", tmp_path) == (0, "1 engine recorded, 1 as recorded before\n", "")
    hidden = tmp_path / ".old" / "expected"
    hidden.mkdir(parents=True)
    (hidden / "x.json").write_text("{}")
    lost.unlink()
    reason = f"{lost}: {GONE.format('lost')}"
    last = "1 as recorded, 1 without an engine file\n"
    assert check(tmp_path) == (1, f"{reason}1 engine: {last}", "")
    assert check(tmp_path, file) == (1, f"{reason}2 engines: 2{last[1:]}", "")
    assert check(file) == (0, "1 engine, as recorded\n", "")
    assert check("--update", tmp_path)[:2] == (
        1,
        f"{reason}0 engines recorded, 1 as recorded before, 1 without an engine file\n",
    )


def test_engines_of_one_name_are_told_apart_by_their_folders(check, file, tmp_path):
    """Two generations of an engine: whose figures moved is what a maintainer asks."""
    second = tmp_path / "second" / file.name
    second.parent.mkdir()
    second.write_bytes(file.read_bytes())
    reason = "no result is recorded; check --update records it\n"
    assert check(tmp_path)[1].startswith(f"{second}: {reason}")
    assert check(second)[1].startswith(f"{second}: {reason}")
    check("--update", tmp_path)
    second.unlink()
    assert check(tmp_path)[1].startswith(f"{second}: {GONE.format('four')}")


@pytest.mark.parametrize("text", ['{"status": 200}', "[1, 2]", "not JSON", '{"format": 3}'])
def test_what_others_expect_is_no_record(check, file, tmp_path, text):
    theirs = tmp_path / "tests" / "expected"
    theirs.mkdir(parents=True)
    (theirs / "answer.json").write_text(text)
    assert check(tmp_path) == (0, "1 engine, as recorded\n", "")


@cases("regression", "a_broken_record_is_a_difference", NOUGHTS=400 * "0")
def test_a_broken_record_is_a_difference(check, file, text, reason):
    find_record(file).write_text(text)
    told = f"the result recorded in expected/four.json cannot be read ({reason}); check --update records it anew"
    assert check(file) == (1, f"{file}: {told}\n1 engine: 1 changed{ADVICE}\n", "")
    assert check(file, "--update") == (0, "1 engine recorded\n", "")
    assert check(file) == (0, "1 engine, as recorded\n", "")


@cases("regression", "no_record_however_broken_brings_check_down", DEEP=100_000 * "a.", DIGITS=400 * "9")
def test_no_record_however_broken_brings_check_down(check, file, text):
    find_record(file).write_text(text, encoding="latin-1")
    status, out, err = check(file)
    assert (status, err) == (1, "")
    assert out.startswith(f"{file}:")


# ------------------------------------------------------------------ --update
def test_update_leaves_records_alone_that_still_hold(check, file, edit_record):
    """Last digits differ from machine to machine; a commit should have only the changed engines."""
    edit_record(file, lambda document: document["orders"][1]["force_N"].update(minor=1e-12))
    before = find_record(file).read_bytes()
    assert check("--update", file) == (0, "0 engines recorded, 1 as recorded before\n", "")
    assert find_record(file).read_bytes() == before
    file.write_text(changed(("mass = 0.5", "mass = 0.51")))
    assert check("--update", file) == (0, "1 engine recorded\n", "")
    assert json.loads(find_record(file).read_text())["inputs"]["piston.mass"] == 0.51


def test_update_ignores_the_tolerances_of_the_file(check, file):
    """Small changes must not add up unnoticed."""
    file.write_text(changed(("mass = 0.5", "mass = 0.50001")) + '[check]\ntolerance = "1 %"\n')
    assert check(file) == (0, "1 engine, as recorded\n", "")
    assert check(file, "--update") == (0, "1 engine recorded\n", "")


def test_update_records_inputs_that_changed_no_figure(check, file):
    file.write_text(changed(("bore = 86", "bore = 86\nskirt = 40")))
    assert check(file) == (0, "1 engine, as recorded\n", "")
    assert check(file, "--update") == (0, "1 engine recorded\n", "")


def test_update_with_a_tolerance_is_refused(check, file):
    status, _, err = check(file, "--update", "--tolerance", "0.1")
    assert (status, err) == (
        2,
        "balcli: --update records, --tolerance is for comparing: give one of them\n",
    )


# ------------------------------------------------------------------ mistakes in engine files
def test_a_bad_engine_file_among_good_ones(check, file, tmp_path):
    (tmp_path / "a.toml").write_text("[crank]")
    status, out, err = check(tmp_path)
    assert (status, out) == (2, "1 engine: 1 as recorded, 1 not read\n")
    assert err.startswith(f"balcli: {tmp_path / 'a.toml'}: ")


def test_mistakes_have_their_line(check, tmp_path):
    one = write(tmp_path / "one.toml", changed(("spacing = 100", "spacng = 100")))
    assert check(one)[2].startswith(f"balcli: {one}:5: crank.spacng: unknown key in [crank]; did you mean spacing?")
    syntax = write(tmp_path / "syntax.toml", "[crank]\nstroke = 90 mm\n")
    assert check(syntax)[2].startswith(f"balcli: {syntax}:2: is not valid TOML: ")
    two = write(tmp_path / "two.toml", changed(("mass = 0.5\n", 'mass = "5"\n'), ("stroke = 90", "stroke = -90")))
    lines = check(two)[2].splitlines()
    assert lines[0] == f"balcli: {two}: 2 mistakes"
    assert [line.partition(": ")[0] for line in lines[1:]] == ["  line 3", "  line 13"]


def test_a_broken_file_is_in_all_reports(check, file, tmp_path):
    check("--update", tmp_path)
    broken = write(tmp_path / "broken.toml", "x =")
    status, out, err = check(tmp_path, "-f", "json")
    first = json.loads(out)["engines"][0]
    assert status == 2
    assert first["error"] in err
    assert "not valid TOML" in first["error"]
    assert [mistake["line"] for mistake in first["mistakes"]] == [1]
    suite = ElementTree.fromstring(check(tmp_path, "-f", "junit")[1])
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("2", "0", "1")
    assert suite[0].get("name").endswith("broken.toml")
    assert "not valid TOML" in suite[0][0].get("message")
    assert check(tmp_path, "-f", "github")[1].startswith(f"::error file={broken},line=1,title=mistake")


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
