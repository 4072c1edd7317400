"""`balcli numbers`: what can be varied and asked for is what `sweep` takes."""

from __future__ import annotations

import json

import pytest
from support.commands import ask, ask_json, refusal, run_here
from support.paths import ENGINES


def listed(file: str) -> dict:
    return ask_json("numbers", ENGINES / file)


@pytest.mark.parametrize("file", ["v8_wiebe.toml", "i4_shafts.toml", "i4_mounts.toml"])
def test_every_number_of_the_file_can_be_varied(file):
    """Some at once, each at the value that it has: a sweep of one variant."""
    there = [number for number in listed(file)["numbers"] if number["value"] is not None]
    assert len(there) > 10
    force = ("--quantity", "force.2.major")
    alone = run_here("sweep", ENGINES / file, "--vary", "piston.offset=0", *force).out
    expected = float(alone.splitlines()[1].split(",")[-1])
    for k in range(0, len(there), 12):
        some = there[k : k + 12]
        vary = [word for n in some for word in ("--vary", f"{n['path']}={n['value']!r}")]
        status, out, err = run_here("sweep", ENGINES / file, *vary, *force)
        assert (status, err) == (0, "")
        head, row = out.splitlines()
        assert head.split(",")[:-1] == [number["path"] for number in some]
        assert float(row.split(",")[-1]) == pytest.approx(expected, rel=1e-9)


def test_a_rigid_stiffness_is_told_as_the_file_says_it():
    """JSON failed of infinity, and the table said "inf"."""
    text = (ENGINES / "i6_diesel.toml").read_text().replace("1.106e6", '"rigid"')
    said = {form: run_here("numbers", "-", "-f", form, stdin=text) for form in ("json", "csv", "txt")}
    assert {outcome.status for outcome in said.values()} == {0}
    path = "torsion.front.2.stiffness"
    (number,) = (n for n in json.loads(said["json"].out)["numbers"] if n["path"] == path)
    assert number["value"] == "rigid"
    assert f"number,{path},rigid,N m/rad," in said["csv"].out
    assert f"{path}         rigid   N m/rad" in said["txt"].out


def test_more_than_arrays_have_axes_are_refused():
    vary = [word for n in range(1, 18) for word in ("--vary", f"cylinder.{n}.piston_mass=0.5")]
    engine = "crank.stroke = 90\nrod.length = 160\npiston.mass = 0.5\nlayout.radial = 17\n"
    assert refusal("sweep", "-", *vary, stdin=engine) == "17 numbers vary; at most 16 can at once"


@pytest.mark.parametrize("file", ["v8_wiebe.toml", "i4_mounts.toml", "i6_diesel.toml"])
def test_every_quantity_can_be_asked_for(file):
    names = [quantity["name"] for quantity in listed(file)["quantities"]]
    parts = {"force": "major", "moment": "major"}
    asked = [
        name.replace(".N.", ".2.").replace("PART", parts.get(name.partition(".")[0], "amplitude")) for name in names
    ]
    file = ENGINES / file
    out = ask("sweep", file, "--vary", "piston.offset=0", "--quantity", ",".join(asked))
    assert out.splitlines()[0] == "piston.offset," + ",".join(asked)


def test_values_units_and_meanings():
    found = {number["path"]: number for number in listed("i4.toml")["numbers"]}
    assert found["crank.stroke"] == {
        "path": "crank.stroke",
        "value": 86.0,
        "unit": "mm",
        "meaning": "twice the crank radius",
    }
    assert found["crank.throws.2"]["value"] == 180.0
    assert found["cylinder.3.piston_mass"] == {
        "path": "cylinder.3.piston_mass",
        "value": None,
        "unit": "kg",
        "meaning": "as piston.mass",
    }


def test_a_table_for_people_and_csv():
    out = run_here("numbers", ENGINES / "i4.toml").out
    assert "cylinder.N.piston_mass" in out
    assert "cylinder.1." not in out
    assert "force.N.PART" in out
    lines = run_here("numbers", ENGINES / "i4.toml", "-f", "csv").out.splitlines()
    assert lines[0] == "kind,name,value,unit,meaning"
    assert "number,crank.stroke,86.0,mm,twice the crank radius" in lines
    assert "quantity,peak.force,,N,largest free force over a revolution" in lines
