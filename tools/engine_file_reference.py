"""The tables of docs/engine-file.md, made of the models; `python tools/engine_file_reference.py`
writes them anew.

They stand between two comments; what is above and below is written by hand.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from balcli.enginefile.messages import DEVICES, import_tables
from balcli.enginefile.model import EngineFile, Override, Table
from balcli.enginefile.schema import schema

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "engine-file.md"
BEGIN, END = "<!-- tables: python tools/engine_file_reference.py -->\n", "<!-- end of tables -->\n"


def tables() -> str:
    """Every table of the engine file, each key with unit, default, meaning and an example."""
    definitions = schema()["$defs"]
    parts = [
        _part(
            "At the top",
            "What stands before the first table.",
            EngineFile,
            schema(),
            ("name", "source"),
        )
    ]
    named = {f"[{name}]": table for name, table in import_tables().items()}
    named["[cylinder.N]"] = Override
    for heading, table in (
        named | {f"[[{name}]]": table for name, table in DEVICES.items()}
    ).items():
        parts.append(_part(f"`{heading}`", str(table.__doc__), table, definitions[table.__name__]))
        parts += [
            _part(
                f"`{key} = {{…}}` in `{heading}`",
                str(inner.__doc__),
                inner,
                definitions[inner.__name__],
            )
            for key, inner in _inner(table)
            if table is not Override
        ]
    return "\n".join(parts)


def document() -> str:
    """docs/engine-file.md with its tables as they should be."""
    head, rest = DOCUMENT.read_text(encoding="utf-8").split(BEGIN)
    return head + BEGIN + "\n" + tables() + "\n" + END + rest.split(END)[1]


def _part(
    heading: str,
    about: str,
    table: type[Table],
    definition: dict[str, Any],
    keys: tuple[str, ...] = (),
) -> str:
    rows = [_row(key, table, definition) for key in keys or definition["properties"]]
    return "\n".join(
        [
            f"### {heading}",
            "",
            about.strip(),
            "",
            "| key | unit | left out | meaning | example |",
            "| --- | --- | --- | --- | --- |",
            *rows,
            "",
        ]
    )


def _row(key: str, table: type[Table], definition: dict[str, Any]) -> str:
    shown, field = definition["properties"][key], table.model_fields[key]
    unit = shown.get("unit") or shown.get("items", {}).get("unit", "")
    meaning = field.description or ""
    if options := shown.get("enum"):
        meaning += f" ({' or '.join(map(_toml, options))})"
    example = _toml(field.examples[0]) if field.examples else ""
    return (
        f"| `{key}` | {unit} | {_left_out(key, table, definition)} | {meaning} | "
        f"{f'`{example}`' if example else ''} |"
    )


def _left_out(key: str, table: type[Table], definition: dict[str, Any]) -> str:
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
    return "–" if default is None or default in ((), "") else f"{_toml(default)}"


def _inner(table: type[Table]) -> Iterator[tuple[str, type[Table]]]:
    """Tables within a table."""
    for key, field in table.model_fields.items():
        for name in re.findall(r"balcli\.model\.(\w+)", str(field.annotation)):
            import balcli.enginefile.model

            yield key, getattr(balcli.model, name)


def _toml(value: Any) -> str:
    """A value as a file has it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_toml, value))}]"
    return f'"{value}"' if isinstance(value, str) else f"{value:g}"


if __name__ == "__main__":
    DOCUMENT.write_text(document(), encoding="utf-8")
