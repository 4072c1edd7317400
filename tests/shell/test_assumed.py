"""What a file leaves out and a result depends on stands in its document, and at the head of its table."""

import json
from pathlib import Path
from typing import Any

import pytest
from support.cases import cases
from support.commands import run_here

FILE = """
[crank]
stroke = 80
spacing = 90
[rod]
length = 140
[piston]
bore = 80
mass = 0.4
[layout]
firing_order = [1, 3, 4, 2]
[operation]
speed = 3000
[gas]
cycle = "otto"
compression_ratio = 10
imep = 9
[body]
mass = 150
cg = [0, 0, 0]
inertia = [9e6, 9e6, 5e6, 0, 0, 0]
[[mount]]
name = "left"
at = [0, 290, 10]
stiffness = 200
loss = 0.1
[[mount]]
name = "right"
at = [0, -290, 10]
stiffness = 200
loss = 0.1
[[mount]]
name = "rear"
at = [0, 0, 500]
stiffness = 200
loss = 0.1
[torsion]
throw_stiffness = 1e6
throw_inertia = 10000
loss = 0.03
[[torsion.rear]]
name = "flywheel"
inertia = 200000
length = 300
diameter = 60
"""
CRANK = ["layout.strokes = 4", "crank.throws = [0, 180, 180, 0]"]
GAS = ["gas.compression_index = 1.32", "gas.expansion_index = 1.28", "gas.exhaust_opens = lower dead centre"]
MODULUS, GRAVITY = "torsion.rear.shear_modulus = 79.3", "body.gravity = [-1, 0, 0]"
FACTOR = "mount.dynamic_factor = 1"
PARTS = {"CRANK": CRANK, "GAS": GAS, "MODULUS": MODULUS, "MOUNTS": [GRAVITY, FACTOR]}


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "four.toml"
    path.write_text(FILE, encoding="utf-8")
    return str(path)


def ask(command: str, file: str, *options: str) -> dict[str, Any]:
    found = run_here(command, file, *options, "-f", "json")
    assert found.status == 0, found.err
    answer: dict[str, Any] = json.loads(found.out)
    return answer


@cases("shell/assumed", "each_document_lists_the_defaults_that_it_depends_on", **PARTS)
def test_each_document_lists_the_defaults_that_it_depends_on(
    command: str, options: list[str], there: list[str], absent: list[str], file: str
) -> None:
    assumed = ask(command, file, *options)["assumed"]
    assert {*there} <= {*assumed}
    assert not {*absent} & {*assumed}
    if command != "curves":  # which has no table
        head = run_here(command, file, *options, "-f", "table").out.replace("\n", " ")
        keys = [line.partition(" = ")[0].removeprefix("gas.") for line in there]
        assert [key for key in keys if key not in head] == []


@cases("shell/assumed", "masses_that_are_left_out_are_assumed_where_they_count")
def test_masses_that_are_left_out_are_assumed_where_they_count(
    command: str, options: list[str], changes: list[list[str]], there: list[str], absent: list[str], file: str
) -> None:
    text = FILE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    Path(file).write_text(text, encoding="utf-8")
    assumed = ask(command, file, *options)["assumed"]
    assert {*there} <= {*assumed}
    assert not {*absent} & {line.partition(" = ")[0] for line in assumed}


def test_what_the_file_gives_is_not_assumed(file: str) -> None:
    text = FILE.replace("[layout]", "[layout]\nstrokes = 4").replace("[gas]", "[gas]\nexpansion_index = 1.28")
    text = text.replace("length = 300", "length = 300\nshear_modulus = 79.3").replace(
        "spacing", "throws = [0, 180, 180, 0]\nspacing"
    )
    Path(file).write_text(text, encoding="utf-8")
    keys = [line.partition(" = ")[0] for line in ask("torsion", file)["assumed"]]
    assert "gas.compression_index" in keys
    assert not {"layout.strokes", "crank.throws", "gas.expansion_index", "torsion.rear.shear_modulus"} & {*keys}


def test_two_engines_have_what_holds_for_one_after_its_name(file: str, tmp_path: Path) -> None:
    other = tmp_path / "other.toml"
    other.write_text(FILE.replace("[layout]", "[layout]\nstrokes = 4"), encoding="utf-8")
    assumed = ask("sum", file, str(other))["assumed"]
    assert CRANK[1] in assumed
    assert "first: layout.strokes = 4" in assumed


def test_on_mounts_other_engines_have_theirs_after_their_names(file: str, tmp_path: Path) -> None:
    other = tmp_path / "other.toml"
    other.write_text('name = "other four"\n' + FILE.partition("[gas]")[0], encoding="utf-8")
    assumed = ask("mounts", file, str(other))["assumed"]
    assert {*CRANK, GRAVITY, FACTOR} <= {*assumed}
    assert [line for line in assumed if line.startswith("other four: crank.throws = [0, 180, 180, 0]")]


def test_a_chain_names_the_steel_of_its_shafts() -> None:
    chain = """
node = [{ name = "a", inertia = 1e6 }, { name = "b", inertia = 2e6 }]
shaft = [{ from = "a", to = "b", length = 300, diameter = 60 }]
"""
    found = json.loads(run_here("torsion", "-", "-f", "json", stdin=chain).out)
    assert found["assumed"] == ["shaft.shear_modulus = 79.3"]
    given = chain.replace("diameter", "shear_modulus = 80, diameter")
    assert "assumed" not in json.loads(run_here("torsion", "-", "-f", "json", stdin=given).out)
