"""The text of an engine file with some keys of a table changed, and all else as it was: comments,
lay-out, other tables.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from typing import Any

HEAD = re.compile(r"(?m)^[ \t]*\[\[?[ \t\w.\"'-]+\]\]?[ \t]*(?:#.*)?$")
# that can be replaced: a flat list, a string, a number
_VALUE = r"""\[[^\[\]]*\]|"[^"\n]*"|'[^'\n]*'|[^\s,#\[\]{}"']+"""
_COMMENT = r"([ \t]*#.*)|[ \t]*$"


def set_keys(text: str, table: str, keys: Mapping[str, Any], note: str) -> str:
    """With these keys of a table set (None: left out), comments kept.

    A key keeps its place and its comment, to which the note is added; a new one comes first in its
    table. The table, which may be one within another (`cylinder.3`), may have its own heading,
    dotted keys or braces; where it is written in a more unusual way, so that a key cannot be put
    in, the file is written anew, without comments.
    """
    wanted = tomllib.loads(text)
    changed = _open(wanted, table)
    new: str | None = text.replace("\r\n", "\n")
    for key, value in keys.items():
        if changed.get(key) == value:
            continue
        if value is None:
            del changed[key]
        else:
            changed[key] = value
        if new is not None:
            ways = (edit(new, table, key, value, note) for edit in _EDITS)
            new = next((found for found in ways if _says(found, table, wanted)), None)
    if new is None:
        return rewrite(wanted, f"its [{table}] is written in an unusual way")
    return new.replace("\n", "\r\n") if "\r\n" in text else new


def _open(data: dict[str, Any], table: str) -> dict[str, Any]:
    """A table in the data of a file, put there if it is missing."""
    for name in table.split("."):
        data = data.setdefault(name, {})
    return data


def _says(text: str, table: str, wanted: Mapping[str, Any]) -> bool:
    """Whether a text is TOML that says what is wanted, but for an empty table."""
    try:
        said = tomllib.loads(text)
        _open(said, table)
    except (tomllib.TOMLDecodeError, AttributeError):
        return False
    return said == wanted


def rewrite(data: Mapping[str, Any], reason: str) -> str:
    """All of a file in the order of its keys, under a comment that says why no other is left."""
    import tomli_w

    return (
        "# Comments and lay-out of the original could not be kept: "
        f"{reason}.\n{tomli_w.dumps(data)}"
    )


def format_value(value: Any) -> str:
    """A number, or lists and tables of them, as TOML has it: the shortest decimals that read back
    to the same number.
    """
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(format_value, value))}]"
    if isinstance(value, Mapping):
        return (
            f"{{ {', '.join(f'{key} = {format_value(inner)}' for key, inner in value.items())} }}"
        )
    return repr(value)


# ------------------------------------------------------------------ one key, in one way of writing
def _change_in_table(text: str, table: str, key: str, value: Any, note: str) -> str:
    """Under the table's own heading; with a new one at the end where there is none."""
    head = re.search(rf"(?m)^[ \t]*\[[ \t]*{table}[ \t]*\][ \t]*(?:#.*)?$", text)
    line = f"{key} = {format_value(value)}    # {note}\n"
    if head is None:
        return text if value is None else f"{text.rstrip()}\n\n[{table}]\n{line}"
    following = HEAD.search(text, head.end())
    end = following.start() if following else len(text)
    before, body, after = text[: head.end()] + "\n", text[head.end() + 1 : end], text[end:]
    changed_body = _change_line(body, key, value, note)
    if changed_body is None:
        changed_body = line * (value is not None) + body
    return before + changed_body + after


def _change_dotted(text: str, table: str, key: str, value: Any, note: str) -> str:
    """As `table.key = value`, above all headings; a new key before the others of its table."""
    first = HEAD.search(text)
    end = first.start() if first else len(text)
    top, rest = text[:end], text[end:]
    dotted = rf"{table}[ \t]*\.[ \t]*"
    found = _change_line(top, dotted + key, value, note)
    if found is None:
        line = f"{table}.{key} = {format_value(value)}    # {note}\n" if value is not None else ""
        found = re.sub(rf"(?m)^(?=[ \t]*{dotted}\w)", lambda _: line, top, count=1)
    return found + rest


def _change_line(lines: str, key: str, value: Any, note: str) -> str | None:
    """Lines with the value of a key (a regular expression) changed, or without it; None if there is
    no such line.
    """
    old = re.search(rf"(?m)^([ \t]*{key}[ \t]*=[ \t]*)(?:{_VALUE})(?:{_COMMENT})\n?", lines)
    if old is None:
        return None
    line = "" if value is None else f"{old[1]}{format_value(value)}{_add_note(old[2], note)}\n"
    return lines[: old.start()] + line + lines[old.end() :]


def _change_inline(text: str, table: str, key: str, value: Any, note: str) -> str:
    """Within `table = { key = value, ... }`; a new key comes first."""
    braces = rf"(?m)^([ \t]*{table}[ \t]*=[ \t]*\{{)([^#\n]*)\}}(?:{_COMMENT})"
    old = re.search(braces, text)
    if old is None:
        return text
    item = "" if value is None else f" {key} = {format_value(value)}"
    place = rf"(^|,)[ \t]*{key}[ \t]*=[ \t]*(?:{_VALUE})[ \t]*(?=,|$)"
    inside, there = re.subn(place, lambda found: (found[1] + item) if item else "", old[2])
    items = [part for part in ("" if there else item, inside) if part.strip(" \t,")]
    inside = ",".join(items).strip(" \t,")
    line = f"{old[1]} {inside} }}{_add_note(old[3], note)}"
    return text[: old.start()] + line + text[old.end() :]


def _add_note(comment: str | None, note: str) -> str:
    """A comment, or none, with the note after it."""
    if comment is None:
        return f"    # {note}"
    return comment.rstrip() + f" ({note})" * (note not in comment)


_EDITS = (_change_in_table, _change_dotted, _change_inline)
