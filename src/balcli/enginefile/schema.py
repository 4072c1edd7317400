"""JSON Schema of the engine file, for editors that check and complete while one types."""

from __future__ import annotations

from itertools import combinations, product
from typing import Any

from .messages import CHAPTER_LISTS, CHAPTERS, DEVICES, TABLES, import_table
from .model import EngineFile, Override, Table

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of an engine file: every key with description, unit, bounds and
    an example.
    """
    chapters = {key.capitalize(): import_table(key) for key in (*CHAPTERS, *CHAPTER_LISTS)}
    tables: list[type[Table]] = [
        *TABLES.values(),
        *chapters.values(),
        *DEVICES.values(),
        Override,
    ]
    EngineFile.model_rebuild(_types_namespace=chapters)
    for table in tables:
        table.model_rebuild()  # pydantic before 2.13 writes no default of a table not built yet
    document: dict[str, Any] = tidy_schema(EngineFile.model_json_schema())
    for table in tables:
        document["$defs"][table.__name__] |= _exclusions(table)
    document["properties"]["cylinder"]["propertyNames"] = {"pattern": "^[1-9][0-9]*$"}
    return {"$schema": DIALECT, **document, "title": "balcli engine file"}


def tidy_schema(node: Any) -> Any:
    """Without what pydantic adds for Python's sake: null (TOML has none), titles of keys, empty
    defaults.
    """
    if isinstance(node, list):
        return [tidy_schema(item) for item in node]
    if not isinstance(node, dict):
        return node
    node = {key: tidy_schema(value) for key, value in node.items()}
    if isinstance(node.get("description"), str):
        node["description"] = " ".join(node["description"].split())  # docstrings are wrapped
    options = [option for option in node.get("anyOf", ()) if option != {"type": "null"}]
    if len(options) == 1:
        del node["anyOf"]
        node = options[0] | node
    for field in node.get("properties", {}).values():
        field.pop("title", None)
        if not field.get("default") or isinstance(field["default"], dict):
            field.pop("default", None)
        unit = field.get("unit") or field.get("items", {}).get("unit")
        if unit:
            field["description"] += f" [{unit}]"  # editors show the description alone
    return node


def _exclusions(table: type[Table]) -> dict[str, Any]:
    """What `Table.choices` says, in the words of JSON Schema."""
    rules: list[dict[str, Any]] = []
    for choice in table.choices:
        if choice.required:
            rules.append({"anyOf": [{"required": list(group)} for group in choice.groups]})
        for group, other in combinations(choice.groups, 2):
            rules += [{"not": {"required": list(pair)}} for pair in product(group, other)]
    return {"allOf": rules} if rules else {}
