"""The table of quantities: what it names can be asked for, and nothing else."""

import csv
from io import StringIO

import pytest
from support.commands import ask_json, refusal, run_here
from support.paths import ENGINES

from balcli.engine.parse import read
from balcli.studies.quantities import list_quantities, parse_quantities
from balcli.studies.quantity_names import BEGINNINGS, FORMS, describe_names

FILES = ("i4_mounts", "i6_diesel", "marine/marine6", "i4_wiebe")
PARTS = {"force": "major", "moment": "backward"}


def ask_for(pattern: str) -> str:
    """A name of this pattern."""
    kind = pattern.partition(".")[0]
    return pattern.replace(".N.", ".2.").replace("PART", PARTS.get(kind, "amplitude"))


@pytest.mark.parametrize("file", FILES)
def test_every_name_that_a_file_has_can_be_swept(file):
    path = ENGINES / f"{file}.toml"
    listed = list(list_quantities(read(path)))
    names = [ask_for(form.name) for form in listed]
    assert len(names) == len(set(names))
    assert [form["name"] for form in ask_json("numbers", path)["quantities"]] == [form.name for form in listed]
    done = run_here("sweep", path, "--vary", "operation.speed=1200", "-q", ",".join(names))
    assert (done.status, done.err) == (0, "")
    head, values = csv.reader(StringIO(done.out))
    assert head[1:] == names
    assert all(values)
    units = {q.name: q.unit for q in parse_quantities(",".join(names), with_gas=True)}
    assert units == {name: form.unit for name, form in zip(names, listed, strict=True)}


def test_files_name_what_they_have_only():
    beginnings = {form.name.partition(".")[0] for form in list_quantities(read(ENGINES / "i4.toml"))}
    assert beginnings == {"force", "moment", "couple", "torque", "roll", "peak", "guide", "piston", "journal", "pin"}
    diesel = [form.name for form in list_quantities(read(ENGINES / "i6_diesel.toml"))]
    assert {"torsion.1.Hz", "shaft.flywheel.stress", "gas.N.PART"} <= {*diesel}
    assert not any(name.startswith(("mode", "mount", "shaft.gear.stress")) for name in diesel)


def test_errors_and_help_name_all():
    told = refusal("sweep", ENGINES / "i4.toml", "--vary", "rod.length=150", "-q", "noise.2.major")
    assert told == (
        "noise.2.major is not a quantity: names begin with force, moment, couple, torque, roll, gas, "
        "torque_total, roll_total, peak, guide, fluctuation, piston, journal, pin, mode, mount, point, torsion or shaft"
    )
    told = refusal("sweep", ENGINES / "i4.toml", "--vary", "rod.length=150", "-q", "tortion.1.Hz")
    assert told == "tortion.1.Hz is not a quantity: did you mean torsion?"
    said = describe_names()
    assert all(beginning in said for beginning in BEGINNINGS)
    assert "mount.NAME.force|static" in said
    assert len(FORMS) > 20
