"""`balcli new`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from . import completion


def new(
    kind: Annotated[
        str,
        typer.Argument(
            metavar="KIND",
            help="single, inline, vee, boxer, radial or w.",
            show_default=False,
            autocompletion=completion.kinds,
        ),
    ],
    file: Annotated[
        Path | None,
        typer.Argument(
            metavar="FILE", help="Where to write it; default: standard output.", show_default=False
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite FILE if it is there.")] = False,
) -> None:
    """Write a commented, valid engine file to start from."""
    from ..enginefile.templates import template
    from .output import emit, keep

    text = template(kind)
    keep(file, force)
    emit(text, file)
