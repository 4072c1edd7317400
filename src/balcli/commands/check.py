"""`balcli check`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def check(
    paths: Annotated[
        list[Path],
        typer.Argument(
            metavar="PATH...", help="Engine files, or folders of them.", show_default=False
        ),
    ],
    update: Annotated[
        bool,
        typer.Option(
            "--update", help="Record the present results in expected/ beside the engines."
        ),
    ] = False,
) -> None:
    """Recompute engines and compare with their recorded results; exit status 1 if anything
    moved.
    """
    from ..errors import Exit, legible
    from ..regression import Difference, differences, record, recorded_at
    from .inputs import each, engine_files, engine_of, tell
    from .output import emit, made, write

    def compared(file: Path) -> list[Difference]:
        _, engine = engine_of(str(file))
        target = recorded_at(file)
        if not update:
            return differences(file.stem, engine, target)
        write(record(engine), made(target))
        return []

    results, errors = each(engine_files(paths), compared)
    moved = [difference for found in results for difference in found]
    done = _count(len(results), "engine") + (
        " recorded" if update else f", {_count(len(moved), 'difference')}"
    )
    emit(legible("\n".join([*map(str, moved), done])))
    tell(errors)
    if moved:
        raise typer.Exit(Exit.DIFFERENCE)


def _count(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"
