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
_VALUE = r"""\[[^\[\]]*\]|"[^"\n]*"|'[^'\n]*'|[^\s#\[\]{"']+"""


def changed(text: str, table: str, keys: Mapping[str, Any], note: str) -> str:
    """With these keys of a table set (None: left out), comments kept.

    A key keeps its place and its comment, to which the note is added; a new one comes first in its
    table. Where the table is written in an unusual way (inline, dotted), so that a key cannot be
    put in, the file is written anew, without comments.
    """
    new = text.replace("\r\n", "\n")
    wanted = tomllib.loads(new)
    for key, value in keys.items():
        if wanted.get(table, {}).get(key) == value:
            continue
        wanted[table] = {
            k: v for k, v in {**wanted.get(table, {}), key: value}.items() if v is not None
        }
        new = _changed(new, table, key, value, note)
    try:
        done = {table: {}, **tomllib.loads(new)} == {table: {}, **wanted}
    except tomllib.TOMLDecodeError:
        done = False
    if not done:
        return anew(wanted, f"its [{table}] is written in an unusual way")
    return new.replace("\n", "\r\n") if "\r\n" in text else new


def anew(data: Mapping[str, Any], reason: str) -> str:
    """All of a file in the order of its keys, under a comment that says why no other is left."""
    import tomli_w

    return (
        "# Comments and lay-out of the original could not be kept: "
        f"{reason}.\n{tomli_w.dumps(data)}"
    )


def written(value: Any) -> str:
    """A number, or lists and tables of them, as TOML has it: the shortest decimals that read back
    to the same number.
    """
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(written, value))}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {written(inner)}' for key, inner in value.items())} }}"
    return repr(value)


def _changed(text: str, table: str, key: str, value: Any, note: str) -> str:
    head = re.search(rf"(?m)^[ \t]*\[[ \t]*{table}[ \t]*\][ \t]*(?:#.*)?$", text)
    line = f"{key} = {written(value)}    # {note}\n"
    if head is None:
        return text if value is None else f"{text.rstrip()}\n\n[{table}]\n{line}"
    following = HEAD.search(text, head.end())
    end = following.start() if following else len(text)
    before, body, after = text[: head.end()] + "\n", text[head.end() + 1 : end], text[end:]
    old = re.search(rf"(?m)^([ \t]*{key}[ \t]*=[ \t]*)(?:{_VALUE})(?:([ \t]*#.*)|[ \t]*$)\n?", body)
    if old is None:
        return before + line * (value is not None) + body + after
    comment = (
        f"    # {note}" if old[2] is None else old[2].rstrip() + f" ({note})" * (note not in old[2])
    )
    line = "" if value is None else f"{old[1]}{written(value)}{comment}\n"
    return before + body[: old.start()] + line + body[old.end() :] + after
