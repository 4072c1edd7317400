"""`balcli engines`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..enginefile import examples
from .completion import complete_examples
from .file_names import parse_output, require_ending
from .output import emit, refuse_existing


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
    force: Annotated[bool, typer.Option("--force", help="Overwrite FILE if it is there.")] = False,
) -> None:
    """List the example engines that come with balcli, print one, or copy it."""
    if name is None:
        known = examples.names()
        width = max(map(len, known))
        emit("\n".join(f"{short:{width}}  {long}" for short, long in known.items()))
        return
    text = examples.text(name)
    require_ending(path, ".toml", "FILE")
    refuse_existing(path, force)
    emit(text, path)
