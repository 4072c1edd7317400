"""A damper written into the text of the file that was sized, comments and all."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from typing import Any

from ..enginefile.edit import set_keys
from ..enginefile.shafting import Damper


def insert_damper(text: bytes, name: str, damper: Damper) -> str:
    """Return the text of a chain or engine file with this damper on the node or part of that name.

    Args:
        text: of the file, UTF-8.
        name: of the node or part, which the file has.
        damper: what it gets, in place of an older one.
    """
    old = text.decode("utf-8-sig")
    table = _find_table(tomllib.loads(old), name)
    return set_keys(old, table, {"damper": damper.model_dump(exclude_none=True)}, "by balcli")


def _find_table(data: Mapping[str, Any], name: str) -> str:
    """Return the dotted name of the table of a node or part, such as `torsion.rear.2`."""
    torsion = data.get("torsion", {})
    lists = {
        "node": data.get("node", []),
        "torsion.front": torsion.get("front", []),
        "torsion.rear": torsion.get("rear", []),
    }
    return next(
        f"{key}.{number}"
        for key, tables in lists.items()
        for number, table in enumerate(tables, 1)
        if table.get("name") == name
    )
