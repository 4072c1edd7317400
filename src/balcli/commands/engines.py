"""`balcli engines`"""

from __future__ import annotations

from itertools import groupby
from pathlib import Path
from typing import Annotated

import typer

from ..enginefile import examples
from ..errors import BalcliError
from .file_names import parse_output, require_ending
from .output import emit, refuse_existing


def complete_examples(incomplete: str) -> list[str]:
    """Return the example engines that begin with this text."""
    from ..enginefile import examples

    return [name for name in examples.names() if name.startswith(incomplete)]


def engines(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            help="An example; without it all are listed.",
            autocompletion=complete_examples,
        ),
    ] = None,
    path: Annotated[
        Path | None,
        typer.Argument(
            metavar="FILE", callback=parse_output, help="Copy it here; default: standard output."
        ),
    ] = None,
    find: Annotated[
        str,
        typer.Option(
            metavar="WORDS",
            help="List those whose name, title, source, lesson or tables (gas, torsion) have the "
            "words.",
        ),
    ] = "",
    group: Annotated[
        str | None,
        typer.Option(
            "--class",
            metavar="CLASS",
            help="List one class: layout, aero, car, historic, marine or motorcycle.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite FILE if it is there.")] = False,
) -> None:
    """List the example engines that come with balcli, print one, or copy it.

    \b
    Examples:
      balcli engines --find v8
      balcli engines i4 my_engine.toml
    """
    if name is None:
        emit(_list(examples.find(find, group)))
        return
    if find or group:
        raise BalcliError("--find and --class list engines; NAME prints one: give one of the two")
    text = examples.text(name)
    require_ending(path, ".toml", "FILE")
    refuse_existing(path, force)
    emit(text, path)


def _list(found: list[examples.Example]) -> str:
    """Each class under its name: an engine a line, with what it teaches."""
    width = max(map(len, examples.names()))
    parts = []
    for group, members in groupby(found, key=lambda example: example.group):
        lines = [f"{example.name:{width}}  {example.lesson}" for example in members]
        parts.append("\n".join([group, "─" * len(group), *lines]))
    return "\n\n".join(parts)
