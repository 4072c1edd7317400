"""`balcli search`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..render.formats import Format
from .options import EngineFile, FormatOption, Output


def search(
    file: EngineFile,
    over: Annotated[
        str,
        typer.Option(
            "--over",
            metavar="throws|firing_order|bank_angle|splay",
            show_default=False,
            help=(
                "What to arrange: the file's throw angles along the crank, the firing order, the "
                "angle of the vee, or of its split pins."
            ),
        ),
    ],
    minimise: Annotated[
        str,
        typer.Option(
            "--minimise",
            "--minimize",
            metavar="WHAT[=WEIGHT],...",
            show_default=False,
            help=("What should be small, such as moment.1.major,force.2.major=0.5."),
        ),
    ],
    limit: Annotated[
        list[str] | None,
        typer.Option(
            "--limit",
            metavar="WHAT<VALUE",
            show_default=False,
            help=("What must stay below a value (N, N·m), such as 'moment.2.major<100'."),
        ),
    ] = None,
    require: Annotated[
        str,
        typer.Option(
            "--require",
            metavar="even-firing",
            show_default=False,
            help=("even-firing: only what can fire at even intervals."),
        ),
    ] = "",
    top: Annotated[int, typer.Option("--top", min=1, max=1000, help="How many to show.")] = 10,
    format: FormatOption = Format.TABLE,  # noqa: A002 (the option's name)
    output: Output = None,
    write: Annotated[
        Path | None,
        typer.Option(
            "--write",
            metavar="OUT.toml",
            show_default=False,
            help=("Write the engine file with the best one."),
        ),
    ] = None,
) -> None:
    """The best crank, firing order, bank angle or splay; mirror images and rotations once."""
    from ..engine.load import build_named, parse
    from ..enginefile.read import name_file, read_bytes
    from ..render import search as rendered
    from ..render.formats import render
    from ..studies.search import search as searches
    from ..studies.search.write import arranged
    from .output import emit
    from .output import write as write_file

    if require not in ("", "even-firing"):
        raise typer.BadParameter(
            f'"{require}": only even-firing can be required', param_hint="--require"
        )
    text, name = read_bytes(file), name_file(file)
    model = parse(text, name)
    build_named(model, name)  # what is wrong with the file itself is told with its name
    found = searches.search(
        model, over, searches.objective(minimise, limit or ()), top, bool(require)
    )
    emit(
        render(
            format,
            sheets=lambda: [rendered.sheet(found)],
            documents=lambda: [rendered.document(found)],
            rows=lambda: rendered.rows(found),
            into_file=output is not None,
        ),
        output,
    )
    if write is not None:
        write_file(arranged(text, found.results[0].arrangement), write)
