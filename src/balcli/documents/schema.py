"""JSON Schemas of all documents, from their types."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from pydantic import TypeAdapter

from ..enginefile.schema import DIALECT, Node
from .names import DOCUMENTS

_UNITS = {  # endings of names
    "N": "N",
    "Nm": "N·m",
    "J": "J",
    "W": "W",
    "Pa": "Pa",
    "Hz": "Hz",
    "deg": "deg",
    "rpm": "rpm",
    "mm": "mm",
    "m": "m",
    "m3": "m³",
    "kg": "kg",
    "kg_m": "kg·m",
    "kg_m2": "kg·m²",
    "g_mm": "g·mm",
    "N_per_m": "N/m",
    "Nm_per_rad": "N·m/rad",
    "Nms_per_rad": "N·m·s/rad",
    "percent": "%",
}


def describe_document(name: str) -> Node:
    """JSON Schema (draft 2020-12) of one of `DOCUMENTS`. Further keys are allowed: new ones may be
    added under the same version.
    """
    module = import_module(f".{DOCUMENTS[name]}", __package__)
    described = _tidy(TypeAdapter(getattr(module, name.capitalize())).json_schema())
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
        if (unit := _find_unit(key)) and "$ref" not in field_node:
            field_node.setdefault("description", f"[{unit}]")
    return tidied


def _tidy_member(value: Any) -> Any:
    if isinstance(value, dict):
        return _tidy(value)
    return [_tidy_member(item) for item in value] if isinstance(value, list) else value


def _find_unit(key: str) -> str:
    """The unit in which a name ends: `kg_m` before `m`."""
    parts = key.split("_")
    ends = ("_".join(parts[k:]) for k in range(1, len(parts)))
    return next((_UNITS[end] for end in ends if end in _UNITS), "")
