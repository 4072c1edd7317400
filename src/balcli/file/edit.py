"""The text of a TOML file with some keys of a table changed, and all else as it was: comments,
layout, other tables. tomlkit does the work; what it writes is read back before anyone gets it.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from typing import Any

_HEADER = re.compile(r"^[ \t]*\[{1,2}[ \t]*([\w.-]+)[ \t]*\]{1,2}[ \t]*(?:#.*)?$", re.MULTILINE)


def set_keys(text: str, table: str, keys: Mapping[str, Any], note: str) -> str:
    """Return the text with some keys of a table set; comments are kept.

    A key keeps its place and its comment, to which the note is added; a new one comes last in its
    table. Where tomlkit does not get the wanted values right, the file is written anew, without
    comments.

    Args:
        text: as the file has it.
        table: dotted name; a number names a cylinder (`cylinder.3`) or, from 1, a member of a list
            (`torsion.rear.2`).
        keys: values of the keys; None leaves a key out.
        note: of where the new values come from.
    """
    from tomlkit.exceptions import TOMLKitError

    wanted = tomllib.loads(text)
    place = _open(wanted, table)
    changes = {key: value for key, value in keys.items() if place.get(key) != value}
    if not changes:
        return text
    for key, value in changes.items():
        place[key] = value
        if value is None:
            del place[key]
    for edit in (_edit_section, _edit):
        try:
            new = edit(text.replace("\r\n", "\n"), table, changes, wanted, note)
            if tomllib.loads(new) == wanted:
                return new.replace("\n", "\r\n") if "\r\n" in text else new
        except (TOMLKitError, ValueError):
            continue
    return rewrite(wanted, f"its [{table}] is written in an unusual way")


def remove_tables(text: str, name: str) -> str:
    """Return the text without the tables of a list, such as `counterweight`."""
    import tomlkit

    document = tomlkit.parse(text)
    if name not in document:
        return text
    del document[name]
    return tomlkit.dumps(document)


def _open(data: Any, table: str) -> Any:
    """Return a table in the data of a file; it is put there if it is missing."""
    for name in table.split("."):
        data = data[int(name) - 1] if isinstance(data, list) else data.setdefault(name, {})
    return data


def _edit_section(text: str, table: str, changes: Mapping[str, Any], wanted: Any, note: str) -> str:
    """Return the text with these changes in the section of one table, all others byte for byte:
    tomlkit puts lists of tables that stand between each other in another order.

    Raises:
        ValueError: The table has no section of its own.
    """
    path, _, number = table.rpartition(".")
    name, place = (path, int(number)) if number.isdigit() and path != "cylinder" else (table, 1)
    headers = list(_HEADER.finditer(text))
    own = [k for k, header in enumerate(headers) if header[1] == name]
    if len(own) < place:
        raise ValueError(f"[{table}] has no section")
    k = own[place - 1]
    start, end = headers[k].start(), headers[k + 1].start() if k + 1 < len(headers) else len(text)
    inner = f"{name}.1" if name != table else table
    return text[:start] + _edit(text[start:end], inner, changes, wanted, note) + text[end:]


def _edit(text: str, table: str, changes: Mapping[str, Any], wanted: Any, note: str) -> str:
    """Return the text with these changes; a table in braces is written anew as it is wanted."""
    import tomlkit
    from tomlkit.items import InlineTable, Table

    document = tomlkit.parse(text)
    place: Any = document
    for name in table.split("."):
        if isinstance(place, list):
            place, wanted = place[int(name) - 1], wanted[int(name) - 1]
            continue
        if isinstance(place.get(name), InlineTable):
            changes = {name: wanted[name]}
            break
        if name not in place:
            place[name] = tomlkit.table()
        place, wanted = place[name], wanted[name]
    for key, value in changes.items():
        if value is None:
            del place[key]
            continue
        item = tomlkit.value(format_value(value))
        last = _find_last_key(place) if isinstance(place, Table) and key not in place else None
        if last is None:
            place[key] = item
        else:
            place.value._insert_after(last, key, item)
        if not item.trivia.comment:
            item.trivia.comment_ws, item.trivia.comment = "    ", f"# {note}"
        elif note not in item.trivia.comment:
            item.trivia.comment = f"{item.trivia.comment.rstrip()} ({note})"
    return tomlkit.dumps(document)


def _find_last_key(table: Any) -> Any:
    """Return the last key of a table whose value is no table; None if it has none."""
    from tomlkit.items import AoT, Table

    keys = [key for key, item in table.value.body if key and not isinstance(item, (AoT, Table))]
    return keys[-1] if keys else None


def rewrite(data: Mapping[str, Any], reason: str) -> str:
    """Return a whole file in the order of its keys, under a comment that says why no other is left.

    Args:
        data: the tables of the file.
        reason: why its comments are lost.
    """
    import tomli_w

    return (
        "# Comments and lay-out of the original could not be kept: "
        f"{reason}.\n{tomli_w.dumps(data)}"
    )


def format_value(value: Any) -> str:
    """Return a number, a text, or lists and tables of them, as TOML has it in one line: the
    shortest decimals that read back to the same number.
    """
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(format_value, value))}]"
    if isinstance(value, Mapping):
        inner = ", ".join(f"{key} = {format_value(part)}" for key, part in value.items())
        return f"{{ {inner} }}"
    return f'"{value}"' if isinstance(value, str) else repr(value)
