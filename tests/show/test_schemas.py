"""JSON Schemas of results: what commands print keeps to them, and every key is described."""

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from support.cases import slow
from support.commands import ask, run_here
from support.gas_engines import WIEBE
from support.paths import ENGINES, GEARED_FILES

from balcli import __version__
from balcli.bench.records import Bench, Block, Measured, OrderError, Ratio, Times
from balcli.commands import describe_document
from balcli.core.records import to_document
from balcli.file.examples import template
from balcli.names import DOCUMENTS

FILES = sorted(path for path in ENGINES.rglob("*.toml"))
I4 = ENGINES / "i4.toml"
V8 = ENGINES / "v8_wiebe.toml"
GAS = ENGINES / "i4_wiebe.toml"
SINGLE = ENGINES / "single.toml"
TWO_BANKS = ENGINES / "vtwin90.toml"
DIESEL = ENGINES / "i6_diesel.toml"
SPEEDS = "--speeds 1000:1100:50"
CURVE = "angle_deg,torque_Nm\n0,0\n180,900\n360,-100\n540,300\n720,0\n"


def close(node: Any) -> Any:
    """A schema that allows no key which it does not describe."""
    if isinstance(node, list):
        return [close(item) for item in node]
    if not isinstance(node, dict):
        return node
    closed = {key: close(value) for key, value in node.items()}
    if closed.get("type") == "object" and "properties" in closed:
        closed.setdefault("additionalProperties", False)
    return closed


@lru_cache
def validator(name: str) -> Draft202012Validator:
    schema = describe_document(name)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(close(schema))


def check(text: str) -> dict[str, Any]:
    """Every document of a command's output; the last one."""
    for line in text.splitlines() if text.count('"format"') > 1 else [text]:
        document = json.loads(line)
        assert [*document][:2] == ["format", "version"]
        assert document["version"] == __version__
        name = document["format"].removeprefix("balcli.").removesuffix("/1")
        problems = [
            f"{'.'.join(map(str, error.absolute_path))}: {error.message[:200]}"
            for error in validator(name).iter_errors(document)
        ]
        assert problems == []
    return document


@pytest.mark.stress
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_the_analysis_and_the_balance_of_every_example(file: Path) -> None:
    for command in (("analyze", file), ("balance", file)):
        out = ask(*command, "-f", "json")
        check(out)


RESULTS = {
    "why": f"analyze {I4} --why --by cylinder --orders 0-4",
    "inner": f"analyze {I4} --only inner,guide --orders 1,2",
    "inner with gas": f"analyze {GAS} --only inner,guide,gas --orders 1,1.5",
    "offsets": f"analyze {ENGINES / 'vr6.toml'}",
    "speeds": f"analyze {I4} --speed 1000:3000:2000 --orders 1,2",
    "marine": f"analyze {ENGINES / 'marine/marine6.toml'} --format marine -o m.json",
    "no places": "analyze -",
    "factor": f"balance {TWO_BANKS} --factor 51% --planes ends --drill 30 --slug 19.3 --width 300 --grade 6.3 --mass 12",
    "factors": f"balance {TWO_BANKS} --factor 50%:54%:1% --planes ends",
    "slider": f"balance {I4} --scheme slider",
    "eccentric slider": f"balance {SINGLE} --scheme eccentric-slider",
    "oldham": f"balance {SINGLE} --scheme oldham",
    "compare": f"compare {I4} {SINGLE} --all",
    "sum with gas": f"sum {V8} {I4}",
    "geared": f"analyze {GEARED_FILES[-1]} --by cylinder --orders 1,2",
    "geared weights": f"balance {GEARED_FILES[-1]} --scheme factor",
    "layouts": "layouts",
    "table": "tables tsinghua-1-2",
    "series": "tables series",
    "curves": f"curves {I4} --step 30",
    "curves of a cylinder": f"curves {V8} --cylinder 1 --step 30",
    "sweep": f"sweep {I4} --vary rod.ratio=0.2,0.3 --quantity force.2.axis",
    "throws": f"search {I4} --over throws --minimise moment.1.major",
    "firing order": f"search {I4} --over firing_order --minimise moment.1.major",
    "bank angle": f"search {TWO_BANKS} --over bank_angle --minimise force.1.major",
    "a number": f"search {I4} --over rod.ratio=0.2:0.3 --minimise force.2.major",
    "numbers": f"numbers {V8}",
    "scatter": f"scatter {I4} --samples 50",
    "mounts": f"mounts {ENGINES / 'i4_mounts.toml'} {I4} --scheme auto {SPEEDS}",
    "torsion": f"torsion {DIESEL} --holzer 1 --holzer 12Hz {SPEEDS} --orders 3,4.5 --damper viscous",
    "rubber": f"torsion {DIESEL} {SPEEDS} --damper rubber",
    "pendulum": f"torsion {DIESEL} {SPEEDS} --damper pendulum",
    "locomotive": f"locomotive {ENGINES / 'historic/locomotive4.toml'}",
    "locomotive, several factors": f"locomotive {ENGINES / 'historic/locomotive2.toml'} --factor 0:1:0.5",
    "torque": f"torque {V8} --loads pin,main",
    "misfire": f"torque {V8} --misfire 1 --fluctuation 2%",
    "stall": f"torque {ENGINES / 'i4_wiebe.toml'} --speed 100 --fluctuation 2%",
    "bearings not known": "torque - --loads pin,main",
    "given torque": "torque --curve curve.csv --speed 1000",
}
NO_UNIT = """\
planes = ["fan"]
run = [{ readings = ["5 @ 0"] }, { readings = ["3 @ 0"], weights = { fan = "1 @ 180" } }]"""
NO_PLACES = f"""\
crank = {{ stroke = 90, throws = [0, 180] }}
rod.length = 160
piston = {{ bore = 80, mass = 0.5 }}
layout.firing_order = [1, 2]
operation.speed = 3000
{WIEBE}"""


@pytest.mark.parametrize("what", [*sorted({*RESULTS} - {"rubber", "pendulum"}), *slow("rubber", "pendulum")])
def test_what_every_command_prints_keeps_to_its_schema(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("curve.csv").write_text(CURVE)
    command = RESULTS[what].split()
    form = () if "-o" in command else ("-f", "json")
    status, out, err = run_here(*command, *form, stdin=NO_PLACES)
    out = out or Path("m.json").read_text(encoding="utf-8")
    assert (status, out != "") == (0, True), err
    check(out)


def test_field_and_a_chain_of_shafts() -> None:
    assert check(run_here("field", "-", "-f", "json", stdin=template("field")).out)["corrections"]
    assert check(run_here("field", "-", "-f", "json", stdin=NO_UNIT).out)["unit"] is None
    assert check(run_here("torsion", "-", "-f", "json", stdin=template("torsion")).out)["modes"]


def test_a_bench() -> None:
    """Of a document as `bench` prints it: running it takes seconds."""
    method = Measured("way", "exact", Times(1e-6, 1e-6, 2e-6), (OrderError(2, 1e-3), OrderError(None, 1e-3)))
    blocks = [Block("task", (method,)), Block("task", (method,), 100, 0.25)]
    found = Bench.of(blocks, [Ratio(what="a / b", value=2.0)])
    check(json.dumps({"format": "", "version": __version__} | to_document(found)))


@pytest.mark.parametrize("name", DOCUMENTS)
def test_the_command_prints_the_schema_with_its_address_and_units(name: str) -> None:
    out = ask("schema", "--of", name)
    schema = json.loads(out)
    assert schema["$id"] == f"urn:balcli:schema:{name}:1"
    assert schema["properties"]["format"]["const"] == f"balcli.{name}/1"
    assert {"format", "version"} <= {*schema["required"]}
    assert "additionalProperties" not in schema  # new keys may be added


def test_units_come_from_the_names() -> None:
    node = describe_document("torsion")["$defs"]
    shown = {key: field.get("description", "") for part in node.values() for key, field in part["properties"].items()}
    assert shown["inertia_kg_m2"].endswith("[kg·m²]")
    assert shown["stiffness_Nm_per_rad"].endswith("[N·m/rad]")
    assert "[" not in shown["node_in"]
