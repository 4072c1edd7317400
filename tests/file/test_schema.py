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

LISTS = map(import_table, (*DEVICES, *CHAPTER_LISTS))
MODELS: list[type[FileTable]] = [*import_tables().values(), *LISTS, Override, Pendulum, Ripple]


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    return describe_engine_file()


def list_fields(document: dict[str, Any]) -> list[tuple[str, str, dict[str, Any]]]:
    tables = {"": document, **document["$defs"]}
    return [(table, key, field) for table, body in tables.items() for key, field in body["properties"].items()]


def test_it_is_json_of_the_dialect_that_it_names(document):
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert document["$schema"] == DIALECT
    assert document["required"] == ["crank", "rod", "piston"]
    assert document["additionalProperties"] is False
    assert "null" not in json.dumps(document)


@pytest.mark.parametrize("table", MODELS)
def test_every_key_of_every_table_is_in_it(document, table):
    assert set(document["$defs"][table.__name__]["properties"]) == set(table.model_fields)


def test_every_key_is_described(document):
    count = 0
    for table, key, field in list_fields(document):
        described = field
        if "$ref" in field and "description" not in field:
            described = document["$defs"][field["$ref"].rpartition("/")[2]]
        assert len(described["description"]) > 5, f"{table}.{key}"
        inner = described.get("items", described)
        if "string" in inner.get("type", ()) and inner["type"] != "string":
            assert described["description"].endswith(f"[{inner['unit']}]"), f"{table}.{key}"
        count += 1
    assert count > 300


def list_examples() -> list[tuple[type[FileTable], str, object]]:
    """Table, key and example of every key that has one."""
    keys = [(table, key, described) for table in MODELS for key, described in document_keys(table).items()]
    return [(table, key, described.example) for table, key, described in keys if described.example is not None]


def test_examples_are_accepted():
    """Each alone: only other keys may be missing, or contradict it."""
    assert len(list_examples()) > 150
    for table, key, example in list_examples():
        refused: list[object] = []
        try:
            table.model_validate({key: example})
        except ValidationError as error:
            refused = [part for finding in error.errors() for part in finding["loc"]]
        assert key not in refused, f"{table.__name__}.{key} = {example!r}"


def test_keys_that_exclude_each_other(document):
    rules = document["$defs"]["Rod"]["allOf"]
    assert {"anyOf": [{"required": [key]} for key in ("length", "ratio", "motion")]} in rules
    assert {"not": {"required": ["length", "ratio"]}} in rules
    assert {"not": {"required": ["cg", "big_end"]}} in rules


def test_units_and_bounds(document):
    stroke = document["$defs"]["Crank"]["properties"]["stroke"]
    one, each = stroke["anyOf"]
    assert each["items"] == one
    assert one["type"] == ["number", "string"]
    assert (stroke["unit"], one["exclusiveMinimum"], stroke["examples"]) == ("mm", 0, [90])
    assert document["$defs"]["Shaft"]["properties"]["ratio"]["not"] == {"const": 0}
    assert document["$defs"]["Layout"]["properties"]["strokes"]["enum"] == [2, 4]


def test_it_needs_no_numpy():
    code = "import sys, balcli.file.schema as s; s.describe_engine_file(); sys.exit('numpy' in sys.modules)"
    assert run_python("-c", code).returncode == 0
