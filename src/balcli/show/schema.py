"""JSON Schemas of all documents, from the records that declare them."""

from __future__ import annotations

from ..core.records import describe_record
from ..file.schema import DIALECT, Node
from ..names import DOCUMENTS, import_name


def describe_document(name: str) -> Node:
    """JSON Schema (draft 2020-12) of one of `DOCUMENTS`. Further keys are allowed: new ones may be
    added under the same version.
    """
    found = describe_record(import_name(DOCUMENTS[name]))
    properties = {"version": {"type": "string"}} | found["properties"]
    head = {"$schema": DIALECT, "$id": f"urn:balcli:schema:{name}:1"}
    changed = {"properties": properties, "required": ["version", *found["required"]]}
    return head | found | changed | {"title": f"balcli.{name}/1"}
