"""`balcli check`"""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any
from xml.sax.saxutils import escape, quoteattr

import typer

from ..enginefile.fields import counted
from ..errors import BalcliError, Exit, legible
from ..render.json import json_text
from .output import emit, make_folder_of, write_file
from .progress import each_until_stopped, exit_if_cut_short, reporting_until_stopped

if TYPE_CHECKING:
    from ..regression import Difference


class CheckFormat(StrEnum):
    """How `check` prints its result."""

    TABLE = "table"
    JSON = "json"
    JUNIT = "junit"


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
            "--update", help="Record the present results in expected/ next to the engines."
        ),
    ] = False,
    tolerance: Annotated[
        float,
        typer.Option(
            help="Allowed move of a figure, as a share of the largest figure of its group.",
            min=0,
            max=1,
        ),
    ] = 1e-9,
    form: Annotated[
        CheckFormat,
        typer.Option("--format", "-f", help="junit: an XML report for continuous integration."),
    ] = CheckFormat.TABLE,
) -> None:
    """Recompute engines and compare them with their recorded results; exit status 1 if anything
    moved.

    A record holds the result of `analyze` (orders, peaks, displacement, dead centers) and, if the
    file has these chapters, torque, mounts and torsion. A record whose engine file is missing is a
    difference as well. Files of runs and chain files in a folder are passed over.

    \b
    Examples:
      balcli check v8.toml --update
      balcli check v8.toml
      balcli check v8.toml --tolerance 1e-6 --format junit
    """
    from .. import regression
    from .inputs import exit_on_errors, find_engine_files, find_expected, read_engine, try_each

    def compare_or_record(path: Path) -> list[Difference]:
        engine = read_engine(str(path)).engine
        if not update:
            record = regression.find_record(path)
            return regression.find_differences(str(path), engine, record, tolerance)
        write_file(regression.record_result(engine), make_folder_of(regression.check_target(path)))
        return []

    files, expected = find_engine_files(paths), find_expected(paths)
    with reporting_until_stopped("engines", len(files)) as progress:
        each, found = each_until_stopped(files, progress), {*files} - {*paths}
        results, errors = try_each(each, compare_or_record, found)
    abandoned = regression.find_abandoned(expected)
    moved = [difference for listed in (*results, abandoned) for difference in listed]
    done = " recorded" if update else f", {counted(len(moved), 'difference')}"
    match form:
        case CheckFormat.TABLE:
            lines = [*_list_lines(moved), counted(len(results), "engine") + done]
            emit(legible("\n".join(lines)))
        case CheckFormat.JSON:
            emit(json_text(_describe(files, moved)))
        case CheckFormat.JUNIT:
            emit(_write_junit(files, moved))
    exit_on_errors(errors)
    exit_if_cut_short(progress)
    if not results and not moved:
        raise BalcliError(f"{paths[0]}: has no engine files (*.toml)")
    if moved:
        raise typer.Exit(Exit.DIFFERENCE)


def _group(moved: Iterable[Difference]) -> dict[tuple[str, str], list[Difference]]:
    """Return differences by engine and cause."""
    groups: dict[tuple[str, str], list[Difference]] = {}
    for each in moved:
        groups.setdefault((each.engine, each.cause), []).append(each)
    return groups


def _list_lines(moved: Iterable[Difference]) -> Iterable[str]:
    """Yield a line for each engine and cause, with the figures that moved below it."""
    for (engine, cause), group in _group(moved).items():
        if not cause:
            yield from (f"{engine}: {each}" for each in group)
            continue
        largest = max((each.share for each in group if each.share is not None), default=None)
        share = "" if largest is None else f", by up to {largest:.1e} of the largest"
        yield f"{engine}: {cause}: {counted(len(group), 'figure')} moved{share}"
        yield from (f"  {each}" for each in group)


def _describe(files: list[Path], moved: list[Difference]) -> dict[str, Any]:
    names = dict.fromkeys([*map(str, files), *(each.engine for each in moved)])
    return {
        "format": "balcli.check/1",
        "engines": [
            {
                "engine": name,
                "differences": [
                    {
                        "cause": each.cause or None,
                        "figure": each.figure,
                        "recorded": each.recorded,
                        "now": each.now,
                        "share": each.share,
                    }
                    for each in moved
                    if each.engine == name
                ],
            }
            for name in names
        ],
    }


def _write_junit(files: list[Path], moved: list[Difference]) -> str:
    """Return an XML report in the form of JUnit: a test case for each engine."""
    names = dict.fromkeys([*map(str, files), *(each.engine for each in moved)])
    failed = {each.engine for each in moved}
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f'<testsuite name="balcli check" tests="{len(names)}" failures="{len(failed)}">',
    ]
    for name in names:
        found = [each for each in moved if each.engine == name]
        case = f'  <testcase classname="balcli" name={quoteattr(legible(name))}'
        if not found:
            lines.append(f"{case}/>")
            continue
        text = legible("\n".join(_list_lines(found)))
        message = quoteattr(counted(len(found), "difference"))
        lines.append(f"{case}><failure message={message}>{escape(text)}</failure></testcase>")
    return "\n".join([*lines, "</testsuite>"])
