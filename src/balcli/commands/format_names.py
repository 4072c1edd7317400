"""The option `--format`: a format by its name, or by the ending of its files, in any case."""

from __future__ import annotations

from enum import StrEnum
from types import MappingProxyType
from typing import Any

import typer

from .declare import optional

SHORT = MappingProxyType({"md": "markdown", "txt": "table", "text": "table"})

LATEX = "for LaTeX let pandoc convert Markdown (pandoc X.md -o X.tex)"


def format_option(formats: type[StrEnum], text: str) -> Any:
    """An option `--format`, `-f` that takes one of these formats.

    Args:
        formats: by the names that people type.
        text: its help.
    """

    def parse(name: str) -> StrEnum:
        return _find_format(formats, name)

    def complete(incomplete: str) -> list[str]:
        return [name for name in formats if name.startswith(incomplete.lower())]

    return optional(
        "|".join(formats), text, "--format", "-f", parser=parse, autocompletion=complete
    )


def _find_format(formats: type[StrEnum], name: str) -> StrEnum:
    small = name.lower()
    try:
        return formats(SHORT.get(small, small))
    except ValueError:
        known = ", ".join(f"'{one}'" for one in formats)
        latex = f"; {LATEX}" if small in ("latex", "tex") and "markdown" in [*formats] else ""
        raise typer.BadParameter(f"'{name}' is not one of {known}{latex}.") from None
