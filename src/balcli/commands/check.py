"""`balcli check`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..enginefile.fields import counted
from ..errors import BalcliError, Exit, legible
from .output import emit, make_folder_of, write_file
from .progress import each_until_stopped, exit_if_cut_short, reporting_until_stopped


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

    Recorded is what `analyze` tells: orders of force, moment, couple, torque, roll and gas torque,
    and the peaks; nothing of mounts, torsion and the flywheel. A record in a folder whose engine is
    gone is a difference, too; files of runs and chain files in a folder are passed over.

    \b
    Examples:
      balcli check v8.toml --update
      balcli check v8.toml
    """
    from .. import regression
    from .inputs import exit_on_errors, find_engine_files, find_expected, read_engine, try_each

    def compare_or_record(path: Path) -> list[regression.Difference]:
        engine, target = read_engine(str(path)).engine, regression.find_record(path)
        if not update:
            return regression.find_differences(str(path), engine, target)
        write_file(regression.record_result(engine), make_folder_of(target))
        return []

    files, expected = find_engine_files(paths), find_expected(paths)
    with reporting_until_stopped("engines", len(files)) as progress:
        each, found = each_until_stopped(files, progress), {*files} - {*paths}
        results, errors = try_each(each, compare_or_record, found)
    abandoned = regression.find_abandoned(expected)
    moved = [difference for listed in (*results, abandoned) for difference in listed]
    done = " recorded" if update else f", {counted(len(moved), 'difference')}"
    emit(legible("\n".join([*map(str, moved), counted(len(results), "engine") + done])))
    exit_on_errors(errors)
    exit_if_cut_short(progress)
    if not results and not moved:
        raise BalcliError(f"{paths[0]}: has no engine files (*.toml)")
    if moved:
        raise typer.Exit(Exit.DIFFERENCE)
