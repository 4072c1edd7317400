"""JSON Schemas of all documents, from their types."""

from __future__ import annotations

from dataclasses import is_dataclass
from typing import Any

from pydantic import TypeAdapter

from ..core.records import describe_record, find_unit
from ..file.schema import DIALECT, Node
from ..names import DOCUMENTS, import_name


def describe_document(name: str) -> Node:
    """JSON Schema (draft 2020-12) of one of `DOCUMENTS`. Further keys are allowed: new ones may be
    added under the same version.
    """
    kind = import_name(DOCUMENTS[name])
    if is_dataclass(kind):
        described = describe_record(kind)  # type: ignore[arg-type]
        described["properties"] = {"version": {"type": "string"}} | described["properties"]
        described["required"] = ["version", *described["required"]]
    else:
        described = _tidy(TypeAdapter(kind).json_schema())
    head = {"$schema": DIALECT, "$id": f"urn:balcli:schema:{name}:1"}
    return {**head, **described, "title": f"balcli.{name}/1"}


def _tidy(node: Node) -> Node:
    """Without the titles that pydantic makes of names, with the units that stand in them."""
    if isinstance(node.get("title"), str):  # else it is a key of that name
        node = {key: value for key, value in node.items() if key != "title"}
    tidied = {key: _tidy_member(value) for key, value in node.items()}
    if isinstance(tidied.get("description"), str):
        tidied["description"] = " ".join(tidied["description"].split())
    for key, field_node in tidied.get("properties", {}).items():
        if (unit := find_unit(key)) and "$ref" not in field_node:
            field_node.setdefault("description", f"[{unit}]")
    return tidied


def _tidy_member(value: Any) -> Any:
    if isinstance(value, dict):
        return _tidy(value)
    return [_tidy_member(item) for item in value] if isinstance(value, list) else value
