"""`balcli new`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..enginefile.templates import template
from .file_names import parse_output, require_ending
from .output import emit, refuse_existing


def new(
    kind: Annotated[
        str,
        typer.Argument(
            metavar="KIND",
            help="single, inline, vee, boxer, radial or w; mounts: an engine on its mounts; field: "
            "runs of a rotor on a machine; torsion: a chain of inertias and shafts.",
            show_default=False,
        ),
    ],
    path: Annotated[
        Path | None,
        typer.Argument(
            metavar="FILE",
            callback=parse_output,
            help="Where to write it; default: standard output.",
            show_default=False,
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite FILE if it is there.")] = False,
) -> None:
    """Write a commented, valid engine file (or file of runs, for `field`, or chain file, for
    `torsion`) to start from.

    \b
    Example:
      balcli new vee v6.toml
    """
    text = template(kind)
    require_ending(path, ".toml", "FILE")
    refuse_existing(path, force)
    emit(text, path)
