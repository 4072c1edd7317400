"""The JSON Schema knows every key with its unit, and its examples are true."""

import json
from typing import Any

import pytest
from pydantic import ValidationError
from support.commands import run_python

from balcli.file.messages import CHAPTER_LISTS, DEVICES, import_table, import_tables
from balcli.file.model import Override, Pendulum, Ripple
from balcli.file.schema import DIALECT, describe_engine_file
from balcli.file.table import FileTable, document_keys

DOCUMENT = describe_engine_file()
LISTS = map(import_table, (*DEVICES, *CHAPTER_LISTS))
MODELS: list[type[FileTable]] = [*import_tables().values(), *LISTS, Override, Pendulum, Ripple]


def fields() -> list[tuple[str, str, dict[str, Any]]]:
    tables = {"": DOCUMENT, **DOCUMENT["$defs"]}
    return [(table, key, field) for table, body in tables.items() for key, field in body["properties"].items()]


def test_it_is_json_of_the_dialect_that_it_names():
    assert json.loads(json.dumps(DOCUMENT, allow_nan=False)) == DOCUMENT
    assert DOCUMENT["$schema"] == DIALECT
    assert DOCUMENT["required"] == ["crank", "rod", "piston"]
    assert DOCUMENT["additionalProperties"] is False
    assert "null" not in json.dumps(DOCUMENT)


@pytest.mark.parametrize("table", MODELS)
def test_every_key_of_every_table_is_in_it(table):
    assert set(DOCUMENT["$defs"][table.__name__]["properties"]) == set(table.model_fields)


@pytest.mark.parametrize(("table", "key", "field"), fields(), ids=lambda v: v if isinstance(v, str) else "")
def test_every_key_is_described(table, key, field):
    if "$ref" in field and "description" not in field:
        field = DOCUMENT["$defs"][field["$ref"].rpartition("/")[2]]
    assert len(field["description"]) > 5
    if "string" in (inner := field.get("items", field)).get("type", ()) and inner["type"] != "string":
        assert field["description"].endswith(f"[{inner['unit']}]")


@pytest.mark.parametrize(
    ("table", "key", "example"),
    [
        (table, key, document.example)
        for table in MODELS
        for key, document in document_keys(table).items()
        if document.example is not None
    ],
)
def test_examples_are_accepted(table, key, example):
    """Each alone: only other keys may be missing, or contradict it."""
    refused: list[object] = []
    try:
        table.model_validate({key: example})
    except ValidationError as error:
        refused = [part for finding in error.errors() for part in finding["loc"]]
    assert key not in refused


def test_keys_that_exclude_each_other():
    rules = DOCUMENT["$defs"]["Rod"]["allOf"]
    assert {"anyOf": [{"required": [key]} for key in ("length", "ratio", "motion")]} in rules
    assert {"not": {"required": ["length", "ratio"]}} in rules
    assert {"not": {"required": ["cg", "big_end"]}} in rules


def test_units_and_bounds():
    stroke = DOCUMENT["$defs"]["Crank"]["properties"]["stroke"]
    one, each = stroke["anyOf"]
    assert each["items"] == one
    assert one["type"] == ["number", "string"]
    assert (stroke["unit"], one["exclusiveMinimum"], stroke["examples"]) == ("mm", 0, [90])
    assert DOCUMENT["$defs"]["Shaft"]["properties"]["ratio"]["not"] == {"const": 0}
    assert DOCUMENT["$defs"]["Layout"]["properties"]["strokes"]["enum"] == [2, 4]


def test_it_needs_no_numpy():
    code = "import sys, balcli.file.schema as s; s.describe_engine_file(); sys.exit('numpy' in sys.modules)"
    assert run_python("-c", code).returncode == 0
