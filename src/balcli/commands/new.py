"""`balcli new`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..enginefile.templates import template
from ..field_balancing import starting_file as field
from ..torsion import starting_file as torsion
from .completion import complete_kinds
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
            autocompletion=complete_kinds,
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
    chapters = {chapter.KIND: chapter.read_starting_file for chapter in (field, torsion)}
    text = chapters[kind]() if kind in chapters else template(kind, chapters)
    require_ending(path, ".toml", "FILE")
    refuse_existing(path, force)
    emit(text, path)
