"""What `balcli check` prints: the changed input first, then at most two lines about the figures that follow."""

import json
import os
import shutil
import sys

import numpy as np
import pytest
from support.engines import GOOD, changed
from support.paths import ENGINES, write

from balcli.regression.recording import find_record
from balcli.regression.records import Difference
from balcli.regression.show import describe_difference
from balcli.version import __version__

ADVICE = "; check --update records what is wanted"


def test_two_numbers_that_differ_in_the_last_digit_are_shown_with_it():
    difference = Difference("force", "order 2 force major", 1.0, float(np.nextafter(1.0, 2.0)), unit="N")
    assert describe_difference(difference) == "order 2 force major: 1 -> 1.0000000000000002 N"


def test_a_changed_input_is_named_before_what_follows_from_it(check, file):
    """One stroke of forty engines: the line to open, old and new value, and how much it matters."""
    file.write_text(changed(("stroke = 90", "stroke = 92")))
    status, out, err = check(file)
    first, second, third, last = out.splitlines()
    assert (status, err) == (1, "")
    assert first == f"{file}:3: crank.stroke: 90 -> 92 mm"
    assert second == "  50 figures of displacement, force, torque, roll, travel"
    assert third.startswith("  most: ")
    assert third.endswith(" %)")
    assert last == f"1 engine: 1 changed{ADVICE}"
    assert all(len(line) <= 80 for line in (second, third, last))


@pytest.mark.parametrize(
    ("edits", "cause"),
    [
        ([("stroke = 90", 'stroke = "3.5 in"')], "3: crank.stroke: 90 -> 88.9 mm"),
        ([("throws = [0, 180, 180, 0]", "throws = [0, 180, 181, 0]")], "4: crank.throws.3: 180 -> 181 deg"),
        ([("cg = 45\n", "")], "7: rod.cg: 45 mm -> left out"),
        (
            [("throw_mass = 0.8\n", "throw_mass = [0.8, 0.7, 0.7, 0.8]\n")],
            "6: crank.throw_mass: 0.8 -> [0.8, 0.7, 0.7, 0.8] kg",
        ),
        (
            [("mass = 0.5\n", "mass = 0.6\n"), ("stroke = 90", "stroke = 92")],
            "3: crank.stroke: 90 -> 92 mm; piston.mass: 0.5 -> 0.6 kg",
        ),
        (
            [("90", "92"), ("160", "162"), ("45", "46"), ("= 100", "= 101"), ("mass = 0.5\n", "mass = 0.6\n")],
            "3: crank.stroke: 90 -> 92 mm; crank.spacing: 100 -> 101 mm; rod.length: 160 -> 162 mm; and 2 more",
        ),
    ],
)
def test_how_changed_inputs_are_written(check, file, edits, cause):
    text = GOOD
    for before, after in edits:
        assert before in text
        text = text.replace(before, after, 1)
    file.write_text(text)
    assert check(file)[1].startswith(f"{file}:{cause}")


def test_a_single_figure_takes_one_line(check, file, edit_record):
    """A record that was edited, or another machine: no input explains it."""
    edit_record(file, lambda document: document["orders"][1]["force_N"].update(axis_deg=1.5))
    assert check(file) == (
        1,
        f"{file}: no input changed, but figures did: was the record edited?\n"
        "  order 2 force axis: 1.5 -> 0 deg\n"
        f"1 engine: 1 changed{ADVICE}\n",
        "",
    )


def test_another_version_of_balcli_is_named(check, file, edit_record):
    def change(document):
        document["version"] = "0.0.1"
        document["peak"]["force_N"] *= 1.01

    edit_record(file, change)
    first = check(file)[1].splitlines()[0]
    assert first == f"{file}: no input changed, but figures did: recorded with balcli 0.0.1, this is {__version__}"


def test_a_record_without_inputs_says_so(check, file, edit_record):
    """Records of balcli 0.1.0 still work."""
    edit_record(file, lambda document: (document.pop("inputs"), document.pop("travel"), document.pop("version")))
    assert check(file) == (0, "1 engine, as recorded\n", "")
    file.write_text(changed(("stroke = 90", "stroke = 92")))
    out = check(file)[1]
    assert out.startswith(f"{file}: figures changed; the record has no inputs that could tell why (check --update)\n")
    assert check(file, "--update")[1] == "1 engine recorded\n"
    assert "inputs" in json.loads(find_record(file).read_text())


def test_one_cause_in_many_engines_takes_three_lines(check, tmp_path):
    """A new piston in five engines."""
    files = [write(tmp_path / f"{name}.toml", GOOD) for name in "abcde"]
    check("--update", tmp_path)
    for engine in files:
        engine.write_text(changed(("mass = 0.5", "mass = 0.51")))
    first, second, third, last = check(tmp_path)[1].splitlines()
    assert first == "piston.mass: 0.5 -> 0.51 kg, in 5 engines"
    a, b, c = (f"{engine}:13" for engine in files[:3])
    assert second.startswith(f"  {a}, {b}, {c} and 2 more: ")
    assert second.endswith(" figures of force, torque, roll")
    assert third.startswith(f"  most: {files[0]}: ")
    assert last == f"5 engines: 5 changed{ADVICE}"


def test_verbose_lists_every_figure(check, file):
    file.write_text(changed(("mass = 0.5", "mass = 0.500001")))
    count = int(check(file)[1].splitlines()[1].split()[0])
    out = check(file, "--verbose")[1]
    figures = [line for line in out.splitlines() if line.startswith("  ")]
    assert len(figures) == count > 10
    assert all(len({*line.partition(": ")[2].split(" -> ")}) == 2 for line in figures)  # enough digits


DIAGRAM = "angle_deg,pressure_MPa\n" + "\n".join(f"{a},{6 if a == 10 else 0.1}" for a in range(0, 721, 10))


def test_a_changed_diagram_is_named(check, tmp_path):
    """A diagram is a file next to the engine file; its name may stay."""
    diagram = write(tmp_path / "p.csv", DIAGRAM)
    text = changed() + '[gas]\nindicator = "p.csv"\n'
    engine = write(tmp_path / "gas.toml", text)
    check("--update", engine)
    diagram.write_bytes(diagram.read_bytes().replace(b"\n", b"\r\n"))
    assert check(engine)[1] == "1 engine, as recorded\n"
    write(diagram, DIAGRAM.replace(",6", ",7"))
    assert check(engine)[1].startswith(f'{engine}:19: gas.indicator: the content of "p.csv" changed\n')
    diagram.rename(tmp_path / "q.csv")
    write(engine, text.replace("p.csv", "q.csv"))
    assert check(engine)[1].startswith(f'{engine}:19: gas.indicator: "p.csv" -> "q.csv"\n')


def test_inputs_of_geared_engines_are_those_of_their_files(check, tmp_path):
    """An H engine whose two cranks have one file."""
    for name in ("brm_h16.toml", "brm_flat8.toml"):
        shutil.copy(next(ENGINES.rglob(name)), tmp_path)
    h16 = tmp_path / "brm_h16.toml"
    flat8 = tmp_path / "brm_flat8.toml"
    check("--update", h16)
    flat8.write_text(flat8.read_text().replace("[piston]\n", "[piston]\nmass_ = 1\n").replace("mass_ = 1\n", ""))
    assert check(h16)[0] == 0
    stroke = json.loads(find_record(h16).read_text())["inputs"]["brm_flat8.toml: crank.stroke"]
    text = flat8.read_text()
    line = next(line for line in text.splitlines() if line.startswith("stroke"))
    flat8.write_text(text.replace(line, f"stroke = {stroke + 1}"))
    assert check(h16)[1].startswith(f"{h16}: brm_flat8.toml: crank.stroke: {stroke:g} -> {stroke + 1:g} mm\n")


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="file names are Unicode there")
def test_a_file_name_that_is_no_text_is_spelled_in_every_format(check, tmp_path):
    """Before, the JUnit report had a reference to half a character, which is no XML."""
    from xml.etree import ElementTree

    name = os.fsdecode(b"b\xffd & good.toml")
    write(tmp_path / name, GOOD)
    spelled = f"{tmp_path}/b\\xffd & good.toml"
    assert check(tmp_path)[1].startswith(f"{spelled}: no result")
    suite = ElementTree.fromstring(check(tmp_path, "-f", "junit")[1].encode())
    assert suite[0].get("name") == spelled
    assert json.loads(check(tmp_path, "-f", "json")[1])["engines"][0]["engine"] == spelled
    assert check(tmp_path, "-f", "github")[1].startswith(f"::error file={spelled},title=")
