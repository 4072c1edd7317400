"""`balcli engines`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import completion


def engines(
    name: Annotated[
        str | None,
        typer.Argument(
            metavar="NAME",
            help="An example; without it all are listed.",
            autocompletion=completion.examples,
        ),
    ] = None,
    file: Annotated[
        Path | None, typer.Argument(metavar="FILE", help="Copy it here; default: standard output.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite FILE if it is there.")] = False,
) -> None:
    """List the example engines that come with balcli, print one, or copy it."""
    from ..enginefile import examples
    from .output import emit, keep

    if name is None:
        known = examples.names()
        emit("\n".join(f"{short:{max(map(len, known))}}  {long}" for short, long in known.items()))
        return
    text = examples.text(name)
    keep(file, force)
    emit(text, file)
