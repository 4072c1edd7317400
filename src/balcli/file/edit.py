"""Change some keys of a table in the text of a TOML file, and keep comments, layout and other
tables. tomlkit makes the change; the changed text is read back and checked.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any

from ..core.records import Node
from .fields import drop_last_digits

HEADER = re.compile(r"^[ \t]*\[{1,2}[ \t]*([\w.-]+)[ \t]*\]{1,2}[ \t]*(?:#.*)?$", re.MULTILINE)


def set_keys(text: str, table: str, keys: Mapping[str, object], note: str) -> str:
    """Return the text with some keys of a table set; comments are kept.

    A key keeps its place and its comment, to which the note is added. A new key comes last in its
    table. If the table has a section of its own, only this section is edited, because tomlkit would
    reorder the file if tables of two lists alternate in it. If the result does not have the wanted
    values, the file is written anew, without comments.

    Args:
        text: Text of the file.
        table: Dotted name; a number names a cylinder (`cylinder.3`) or, from 1, a member of a list
            (`torsion.rear.2`).
        keys: Values of the keys; None removes a key.
        note: Comment that names the source of the new values.
    """
    from tomlkit.exceptions import TOMLKitError

    keys = {key: drop_last_digits(value) for key, value in keys.items()}
    wanted = tomllib.loads(text)
    place: Any = wanted
    for name in table.split("."):
        place = place[int(name) - 1] if isinstance(place, list) else place.setdefault(name, {})
    changes = {key: value for key, value in keys.items() if place.get(key) != value}
    if not changes:
        return text
    place |= changes
    for key in [key for key, value in changes.items() if value is None]:
        del place[key]
    line_end = "\r\n" if "\r\n" in text else "\n"
    old = text.replace("\r\n", "\n")
    for start, end, name in (*_find_section(old, table), (0, len(old), table)):
        with suppress(TOMLKitError, ValueError):
            new = old[:start] + _edit(old[start:end], name, changes, wanted, note) + old[end:]
            if tomllib.loads(new) == wanted:
                return new.replace("\n", line_end)
    return rewrite(wanted, f"its [{table}] is written in an unusual way")


def set_speed(text: str, rpm: float, note: str) -> str:
    """Return the text with a crank speed; a locomotive's speed on the track is removed."""
    text = set_keys(text, "locomotive", {"speed": None}, note)
    return set_keys(text, "operation", {"speed": rpm}, note)


def remove_tables(text: str, name: str) -> str:
    """Return the text without the tables of a list.

    Args:
        text: Text of the file.
        name: Name of the list, such as `counterweight`.
    """
    import tomlkit

    document = tomlkit.parse(text)
    document.pop(name, None)
    return tomlkit.dumps(document)


def repeat_table(text: str, name: str, number: int, times: int) -> str:
    """Return the text with a table of a list several times, one after the other, with its comments
    and the tables within it.

    Args:
        text: Text of the file.
        name: Name of the list, such as `web`.
        number: Number of the table, from 1.
        times: How often the table shall stand.
    """
    wanted = tomllib.loads(text)
    tables: list[object] = wanted[name]
    tables[number - 1 : number] = times * [tables[number - 1]]
    line_end = "\r\n" if "\r\n" in text else "\n"
    old = text.replace("\r\n", "\n")
    headers = list(HEADER.finditer(old))
    own = [row for row, header in enumerate(headers) if header[1] == name]
    if len(own) >= number:
        start = headers[own[number - 1]].start()
        later = headers[own[number - 1] + 1 :]
        outside = (h.start() for h in later if not h[1].startswith(f"{name}."))
        end = next(outside, len(old))
        section = old[start:end]
        gap = "" if section.endswith("\n") else "\n"
        new = old[:start] + (times - 1) * (section + gap) + old[start:]
        with suppress(ValueError):
            if tomllib.loads(new) == wanted:
                return new.replace("\n", line_end)
    return rewrite(wanted, f"its [[{name}]] is written in an unusual way")


def rewrite(data: Mapping[str, object], reason: str) -> str:
    """Return a whole file from its tables, headed by the reason why its comments are lost.

    Args:
        data: Tables of the file.
        reason: Why the original text could not be kept.
    """
    import tomli_w

    head = f"# Comments and layout of the original could not be kept: {reason}."
    return f"{head}\n{tomli_w.dumps(data)}"


def format_value(value: object) -> str:
    """Return a value, list or table in TOML, on one line. Rounding errors in the last digits are
    left out (40480.2 in place of 40480.200000000004); a seventh of a turn keeps all digits.
    """
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(format_value, value))}]"
    if isinstance(value, Mapping):
        inner = ", ".join(f"{key} = {format_value(part)}" for key, part in value.items())
        return f"{{ {inner} }}"
    if isinstance(value, (str, bool)):
        return json.dumps(value, ensure_ascii=False)
    return repr(drop_last_digits(value))


def _find_section(text: str, table: str) -> Iterator[tuple[int, int, str]]:
    """Yield start and end of the section that holds a table, and the name of the table within this
    section, in which a member of a list is number 1. Yield nothing if the table has no section of
    its own.
    """
    path, _, number = table.rpartition(".")
    in_list = number.isdigit() and path != "cylinder"
    name, place = (path, int(number)) if in_list else (table, 1)
    headers = list(HEADER.finditer(text))
    ends = [*(header.start() for header in headers[1:]), len(text)]
    own = [k for k, header in enumerate(headers) if header[1] == name]
    if len(own) >= place:
        k = own[place - 1]
        yield headers[k].start(), ends[k], f"{name}.1" if in_list else table


def _edit(text: str, table: str, changes: Node, wanted: Any, note: str) -> str:
    """Return the text with these changes; a table that is written in braces is written anew."""
    import tomlkit
    from tomlkit.items import AoT, InlineTable, Table

    document = tomlkit.parse(text)
    place: Any = document
    for name in table.split("."):
        if isinstance(place, list):
            place = place[int(name) - 1]
            wanted = wanted[int(name) - 1]
            continue
        if isinstance(place.get(name), InlineTable):
            changes = {name: wanted[name]}
            break
        if name not in place:
            place[name] = tomlkit.table()
        place = place[name]
        wanted = wanted[name]
    body = place.value.body if isinstance(place, Table) else ()
    for key, value in changes.items():
        if value is None:
            del place[key]
            continue
        item = tomlkit.value(format_value(value))
        before = [known for known, part in body if known and not isinstance(part, (AoT, Table))]
        if before and key not in place:
            place.value._insert_after(before[-1], key, item)
        else:
            place[key] = item
        if not item.trivia.comment:
            item.trivia.comment_ws = "    "
            item.trivia.comment = f"# {note}"
        elif note not in item.trivia.comment:
            item.trivia.comment = f"{item.trivia.comment.rstrip()} ({note})"
    return tomlkit.dumps(document)
