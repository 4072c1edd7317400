"""The tables of docs/engine-file.md, made of the models; `python tools/engine_file_reference.py`
writes them anew.

They stand between two comments; what is above and below is written by hand.
"""

from __future__ import annotations

from collections.abc import Iterator
from inspect import cleandoc
from pathlib import Path
from typing import Any

from balcli.file.messages import (
    CHAPTER_LISTS,
    DEVICES,
    find_table,
    import_table,
    import_tables,
)
from balcli.file.model import EngineFile, Override
from balcli.file.schema import describe_engine_file
from balcli.file.table import FileTable, document_keys

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "engine-file.md"
BEGIN = "<!-- tables: python tools/engine_file_reference.py -->\n"
END = "<!-- end of tables -->\n"


def tables() -> str:
    """Every table of the engine file, each key with unit, default, meaning and an example."""
    definitions = describe_engine_file()["$defs"]
    parts = [
        _part(
            "At the top",
            "What stands before the first table.",
            EngineFile,
            describe_engine_file(),
            ("name", "source"),
        )
    ]
    named = {f"[{name}]": table for name, table in import_tables().items()}
    named["[cylinder.N]"] = Override
    named |= {f"[[{key}]]": import_table(key) for key in (*DEVICES, *CHAPTER_LISTS)}
    for heading, table in named.items():
        parts.append(_part(f"`{heading}`", str(table.__doc__), table, definitions[table.__name__]))
        if table is not Override:
            parts += _describe_inner(heading, table, definitions)
    return "\n".join(parts)


def document() -> str:
    """docs/engine-file.md with its tables as they should be."""
    head, rest = DOCUMENT.read_text(encoding="utf-8").split(BEGIN)
    return head + BEGIN + "\n" + tables() + "\n" + END + rest.split(END)[1]


def _part(
    heading: str,
    about: str,
    table: type[FileTable],
    definition: dict[str, Any],
    keys: tuple[str, ...] = (),
) -> str:
    rows = [_row(key, table, definition) for key in keys or definition["properties"]]
    return "\n".join(
        [
            f"### {heading}",
            "",
            cleandoc(about),
            "",
            "| key | unit | left out | meaning | example |",
            "| --- | --- | --- | --- | --- |",
            *rows,
            "",
        ]
    )


def _row(key: str, table: type[FileTable], definition: dict[str, Any]) -> str:
    shown = definition["properties"][key]
    document = document_keys(table)[key]
    unit = shown.get("unit") or shown.get("items", {}).get("unit", "")
    meaning = document.description
    if options := shown.get("enum"):
        meaning += f" ({' or '.join(map(_toml, options))})"
    example = "" if document.example is None else _toml(document.example)
    return (
        f"| `{key}` | {unit} | {_left_out(key, table, definition)} | {meaning} | "
        f"{f'`{example}`' if example else ''} |"
    )


def _left_out(key: str, table: type[FileTable], definition: dict[str, Any]) -> str:
    """What counts where a key is left out."""
    others = [
        " and ".join(f"`{k}`" for k in group)
        for choice in table.choices
        if choice.required
        for group in choice.groups
        if key not in group
    ]
    if key in definition.get("required", ()):
        return "needed"
    if others and any(
        key in group for choice in table.choices if choice.required for group in choice.groups
    ):
        return f"needed, or {' or '.join(others)}"
    default = table.model_fields[key].default
    return "–" if default is None or default in ((), "", {}) else f"{_toml(default)}"


def _describe_inner(
    heading: str, table: type[FileTable], definitions: dict[str, Any]
) -> Iterator[str]:
    """The tables within a table, each once, and those within these."""
    found: dict[type[FileTable], list[str]] = {}
    for key, field in table.model_fields.items():
        if inner := find_table(field.annotation):
            found.setdefault(inner, []).append(key)
    for inner, keys in found.items():
        shown = definitions[table.__name__]["properties"][keys[0]]
        listed = shown.get("type") == "array"
        dotted = heading.strip("[]")
        if listed:
            names = [f"[[{dotted}.{key}]]" for key in keys]
        else:
            names = [f"{key} = {{…}}" for key in keys]
        where = "" if listed else f" in `{heading}`"
        title = ", ".join(f"`{name}`" for name in names) + where
        yield _part(title, str(inner.__doc__), inner, definitions[inner.__name__])
        yield from _describe_inner(names[0], inner, definitions)


def _toml(value: Any) -> str:
    """A value as a file has it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_toml(part)}' for key, part in value.items())} }}"
    return f'"{value}"' if isinstance(value, str) else f"{value:g}"


if __name__ == "__main__":
    DOCUMENT.write_text(document(), encoding="utf-8")
