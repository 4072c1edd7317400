"""A sheet as Markdown."""

from __future__ import annotations

import re

from ..errors import legible
from .sheet import Facts, Grid, Sheet, Text

_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|~])")


def markdown(sheets: list[Sheet]) -> str:
    """All sheets, one after the other."""
    return (
        "\n\n".join(
            block
            for sheet in sheets
            for block in [f"# {escape(sheet.title)}", *map(_part, sheet.parts)]
        )
        + "\n"
    )


def escape(text: str) -> str:
    """Text that Markdown leaves as it is."""
    return _SPECIAL.sub(r"\\\1", legible(text.replace("\n", " ")))


def _part(part: Grid | Facts | Text) -> str:
    head = f"## {escape(part.title)}\n\n" if part.title else ""
    match part:
        case Grid():
            marked = [
                [
                    f"**{escape(cell)}**" if (i, k) in part.marked else escape(cell)
                    for k, cell in enumerate(row)
                ]
                for i, row in enumerate(part.rows)
            ]
            rule = ["---" if k in part.words else "---:" for k in range(len(part.columns))]
            lines = [_row([escape(c) for c in part.columns]), _row(rule), *map(_row, marked)]
            return head + "\n".join(lines) + (f"\n\n{escape(part.note)}" if part.note else "")
        case Facts():
            return head + "\n".join(
                f"- {escape(name)}: {escape(value)}" for name, value in part.pairs
            )
        case Text():
            return head + "\n\n".join(escape(p) for p in part.paragraphs)


def _row(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"
