"""The shipped examples: all are listed, each is the file of the repository, and a wheel has
them.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
import zipfile
from itertools import pairwise

import pytest
from support.commands import run_command
from support.paths import ENGINE_FILES, ENGINES, ROOT

from balcli.enginefile import examples
from balcli.errors import BalcliError


def test_every_engine_is_listed_with_its_lesson():
    lines = run_command("engines").stdout.splitlines()
    listed = {line.split("  ")[0]: line.split("  ")[-1].strip() for line in lines if "  " in line}
    lessons = {file.stem: file.read_text(encoding="utf-8").splitlines()[0] for file in ENGINE_FILES}
    assert len(lessons) == len(ENGINE_FILES), "two engines of one name"
    assert {name: f"# {lesson}" for name, lesson in listed.items()} == lessons
    assert max(map(len, lines)) <= 80


@pytest.mark.stress
def test_classes_are_listed_one_after_the_other_layouts_first():
    lines = run_command("engines").stdout.splitlines()
    headings = [line for line, below in pairwise(lines) if below and set(below) == {"─"}]
    assert headings == examples.groups()
    folders = {path.parent.name for path in ENGINE_FILES if path.parent != ENGINES}
    assert headings == ["layout", *sorted(folders)]
    assert all(group in run_command("engines", "--help").stdout for group in headings)


def test_a_class_or_words_pick_engines():
    marine = run_command("engines", "--class", "marine").stdout.splitlines()
    assert marine[:2] == ["marine", "──────"]
    assert {line.split()[0] for line in marine[2:]} == {path.stem for path in (ENGINES / "marine").glob("*.toml")}
    assert "marine6" in [e.name for e in examples.find(group="marine")]
    assert [e.name for e in examples.find("WARTSILA six")] == ["wartsila_6rtflex96c"]
    assert {"v8_crossplane", "hispano_suiza_8"} <= {e.name for e in examples.find("v8")}
    assert [e.name for e in examples.find("v8", "car")] == [e.name for e in examples.find("v8") if e.group == "car"]


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (["--class", "cars"], 'there is no class "cars" of engines: layout, aero, car, historic, marine, motorcycle'),
        (["i4", "--find", "v8"], "--find and --class list engines; NAME prints one: give one of the two"),
        (["--find", "v3"], 'no example mentions "v3": balcli engines lists them all'),
    ],
)
def test_what_is_not_there_is_said(asked, message):
    done = run_command("engines", *asked)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"balcli: {message}\n")


@pytest.mark.parametrize("path", ENGINE_FILES, ids=lambda path: path.stem)
def test_every_engine_says_where_its_figures_come_from(path):
    """And which are assumed, or that all are."""
    source = tomllib.loads(path.read_text(encoding="utf-8"))["source"]
    assert re.search("assumed|made up|own figures", source), source


def test_a_copy_is_the_file(tmp_path):
    original = (ENGINES / "v8_crossplane.toml").read_text(encoding="utf-8")
    assert run_command("engines", "v8_crossplane").stdout == original
    target = tmp_path / "mine.toml"
    assert run_command("engines", "v8_crossplane", target).returncode == 0
    assert target.read_text(encoding="utf-8") == original
    again = run_command("engines", "i4", target)
    assert (again.returncode, again.stderr) == (
        2,
        f"balcli: {target}: already exists; choose another name, or --force to overwrite it\n",
    )
    assert run_command("engines", "i4", target, "--force").returncode == 0
    assert target.read_text(encoding="utf-8") == examples.text("i4")


@pytest.mark.parametrize("name", ["v8crossplane", "../engines/i4", "expected"])
def test_unknown_names(name):
    with pytest.raises(BalcliError, match=f'^there is no example "{name}": balcli engines lists them'):
        examples.text(name)


def test_a_misspelt_name_gets_a_hint():
    with pytest.raises(BalcliError, match=r"Did you mean v8_crossplane"):
        examples.text("v8_crosplane")


def test_the_beginning_of_a_name_or_a_class_gets_one_too():
    with pytest.raises(BalcliError, match=r"Did you mean v6_60 or v6_90_common or v6_90_split\?$"):
        examples.text("v6")
    with pytest.raises(BalcliError, match=r"It is a class: balcli engines --class marine\.$"):
        examples.text("Marine")


def test_examples_with_a_chapter_are_found_by_its_table():
    for chapter in ("torsion", "gas", "mount"):
        found = {example.name for example in examples.find(chapter)}
        having = {path.stem for path in ENGINE_FILES if f"\n[{chapter}]" in path.read_text("utf-8")}
        having |= {p.stem for p in ENGINE_FILES if f"\n[[{chapter}]]" in p.read_text("utf-8")}
        assert having
        assert having <= found


@pytest.mark.stress
def test_a_wheel_has_the_examples_and_the_page(tmp_path):
    pytest.importorskip("hatchling", reason="hatchling, which builds the wheel, is not installed")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as content:
        inside = content.namelist()
        shipped = {f"balcli/engines/{p.relative_to(ENGINES).as_posix()}" for p in ENGINE_FILES}
        assert shipped <= set(inside)
        assert {f"balcli/render/page/report.{end}" for end in ("html", "css", "js")} <= set(inside)
        content.extractall(tmp_path / "installed")
    listed = run_command("engines", env={"PYTHONPATH": str(tmp_path / "installed")}).stdout
    assert listed == run_command("engines").stdout


def test_an_installation_without_them_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(examples, "_PLACES", (tmp_path / "engines",))
    with pytest.raises(
        BalcliError, match=r"the example engines are missing from this installation .*: install balcli again"
    ):
        examples.names()
