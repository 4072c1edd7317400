"""Make the JSON Schema of the engine file, with which editors check and complete typed text."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations, product

from pydantic import BaseModel

from ..core.records import Node
from ..names import CHAPTER_LISTS, CHAPTERS
from .messages import DEVICES, TABLES, import_table
from .model import EngineFile, Override
from .table import FileTable

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def describe_engine_file() -> Node:
    """Return the JSON Schema (draft 2020-12) of an engine file. Every key has a description, unit,
    bounds and an example.
    """
    chapters = {key.capitalize(): import_table(key) for key in (*CHAPTERS, *CHAPTER_LISTS)}
    parts = map(import_table, (*TABLES, *DEVICES))
    tables: list[type[FileTable]] = [*parts, *chapters.values(), Override]
    EngineFile.model_rebuild(_types_namespace=chapters)
    document = describe_file(EngineFile, tables, "engine-file", "balcli engine file")
    for table in tables:
        rules: list[Node] = []
        for choice in table.choices:
            if choice.required:
                others = [*choice.instead, *([choice.unless] if choice.unless else [])]
                others += ["at"] * (table is chapters["Gas"])  # [[gas.at]] may have the key instead
                ways = (*choice.groups, *((key,) for key in others))
                rules.append({"anyOf": [{"required": list(group)} for group in ways]})
            for group, other in combinations(choice.groups, 2):
                rules += [{"not": {"required": list(pair)}} for pair in product(group, other)]
        document["$defs"][table.__name__] |= {"allOf": rules} if rules else {}
    document["properties"]["cylinder"]["propertyNames"] = {"pattern": "^[1-9][0-9]*$"}
    return document


def describe_file(
    file: type[BaseModel], tables: Iterable[type[BaseModel]], name: str, title: str
) -> Node:
    """Return the JSON Schema (draft 2020-12) of a kind of file, in the form that
    `describe_engine_file` returns.

    Args:
        file: Class of the whole file.
        tables: Classes of the tables in it.
        name: End of the schema's identifier, such as "engine-file".
        title: Title of the schema.
    """
    for table in tables:
        table.model_rebuild()  # pydantic < 2.13 omits defaults of tables that are not built yet
    document = tidy_schema(file.model_json_schema())
    return {"$schema": DIALECT, "$id": f"urn:balcli:schema:{name}", **document, "title": title}


def tidy_schema(schema: Node) -> Node:
    """Return a schema without pydantic's additions for Python: null (TOML has none), titles, empty
    defaults.
    """
    node: Node = {key: _tidy_member(value) for key, value in schema.items()}
    if isinstance(node.get("description"), str):
        node["description"] = " ".join(node["description"].split())  # docstrings are wrapped
    options = [option for option in node.get("anyOf", ()) if option != {"type": "null"}]
    if len(options) == 1:
        del node["anyOf"]
        node = options[0] | node
    elif options:
        node["anyOf"] = options
    for field in node.get("properties", {}).values():
        field.pop("title", None)
        if not field.get("default") or isinstance(field["default"], dict):
            field.pop("default", None)
        unit = field.get("unit") or field.get("items", {}).get("unit")
        if unit:
            field["description"] += f" [{unit}]"  # editors show only the description
    return node


def _tidy_member(value: object) -> object:
    """Return a tidied schema, or dict or list of schemas; any other value is returned unchanged."""
    if isinstance(value, dict):
        return tidy_schema(value)
    return [_tidy_member(item) for item in value] if isinstance(value, list) else value
