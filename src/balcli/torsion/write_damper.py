"""A damper written into the text of the file that was sized, comments and all."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from typing import Any

from ..enginefile.edit import HEAD, format_value, rewrite
from ..enginefile.shafting import Damper

_INLINE = r"\{[^{}\n]*\}"


def insert_damper(text: bytes, name: str, damper: Damper) -> str:
    """The text of a chain or engine file with this damper on the node or part of that name.

    Where its table is written in an unusual way (inline), the file is written anew, without
    comments.
    """
    old = text.decode("utf-8-sig").replace("\r\n", "\n")
    data = tomllib.loads(old)
    key, number, place = _find_table(data, name)
    table = damper.model_dump(exclude_none=True)
    place["damper"] = table
    new = _insert(old, key, number, _write_inline(table))
    try:
        done = tomllib.loads(new) == data
    except tomllib.TOMLDecodeError:
        done = False
    if not done:
        new = rewrite(data, f"the table of {name} is written in an unusual way")
    return new.replace("\n", "\r\n") if b"\r\n" in text else new


def _find_table(data: Mapping[str, Any], name: str) -> tuple[str, int, dict[str, Any]]:
    """Key of the list, place in it (from 0) and the table of a node or part."""
    torsion = data.get("torsion", {})
    lists = {
        "node": data.get("node", []),
        "torsion.front": torsion.get("front", []),
        "torsion.rear": torsion.get("rear", []),
    }
    return next(
        (key, number, table)
        for key, tables in lists.items()
        for number, table in enumerate(tables)
        if table.get("name") == name
    )


def _write_inline(table: Mapping[str, Any]) -> str:
    figures = [f'kind = "{table["kind"]}"']
    figures += [f"{key} = {format_value(value)}" for key, value in table.items() if key != "kind"]
    return f"{{ {', '.join(figures)} }}"


def _insert(text: str, key: str, number: int, inline: str) -> str:
    """With the damper at the end of the numbered table of a list, or in place of an older one."""
    heads = list(re.finditer(rf"(?m)^[ \t]*\[\[[ \t]*{re.escape(key)}[ \t]*\]\][^\n]*$", text))
    if number >= len(heads):
        return text
    start = heads[number].end()
    following = HEAD.search(text, start)
    end = following.start() if following else len(text)
    body = text[start:end]
    line = f"damper = {inline}    # by balcli"
    old = re.search(rf"(?m)^[ \t]*damper[ \t]*=[ \t]*{_INLINE}[ \t]*(?:#.*)?$", body)
    if old is not None:
        return text[:start] + body[: old.start()] + line + body[old.end() :] + text[end:]
    filled = re.search(r"(?ms)\A.*^[ \t]*[\w\"'-]+[ \t]*=[^\n]*$", body)
    at = filled.end() if filled else 0
    return f"{text[:start]}{body[:at]}\n{line}{body[at:]}{text[end:]}"
