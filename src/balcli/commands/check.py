"""`balcli check`"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import typer

from ..enginefile.fields import counted
from ..errors import BalcliError, Exit, legible
from ..render.json import json_text
from .output import emit, make_folder_of, write_file
from .progress import each_until_stopped, exit_if_cut_short, reporting_until_stopped

if TYPE_CHECKING:
    from ..regression import CheckedEngine, Difference


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
    from ..documents.records import to_document
    from ..regression import (
        Check,
        CheckedEngine,
        check_target,
        find_abandoned,
        find_differences,
        find_record,
        record_result,
    )
    from .inputs import exit_on_errors, find_engine_files, find_expected, read_engine, try_each

    def compare_or_record(path: Path) -> CheckedEngine:
        engine = read_engine(str(path)).engine
        differences: list[Difference] = []
        if update:
            write_file(record_result(engine), make_folder_of(check_target(path)))
        else:
            differences = find_differences(engine, find_record(path), tolerance)
        return CheckedEngine(engine=str(path), differences=tuple(differences))

    files, expected = find_engine_files(paths), find_expected(paths)
    with reporting_until_stopped("engines", len(files)) as progress:
        each, found = each_until_stopped(files, progress), {*files} - {*paths}
        results, errors = try_each(each, compare_or_record, found)
    checked = [*results, *find_abandoned(expected)]
    moved = sum(len(each.differences) for each in checked)
    match form:
        case CheckFormat.TABLE:
            done = " recorded" if update else f", {counted(moved, 'difference')}"
            lines = [line for each in checked for line in _list_lines(each)]
            emit(legible("\n".join([*lines, counted(len(results), "engine") + done])))
        case CheckFormat.JSON:
            emit(json_text(to_document(Check(engines=tuple(checked)))))
        case CheckFormat.JUNIT:
            emit(_write_junit(checked))
    exit_on_errors(errors)
    exit_if_cut_short(progress)
    if not checked:
        raise BalcliError(f"{paths[0]}: has no engine files (*.toml)")
    if moved:
        raise typer.Exit(Exit.DIFFERENCE)


def _list_lines(checked: CheckedEngine) -> Iterator[str]:
    """Yield a line for each cause, with the figures that moved below it."""
    for cause in dict.fromkeys(each.cause for each in checked.differences):
        moved = [each for each in checked.differences if each.cause == cause]
        if cause is None:
            yield from (f"{checked.engine}: {each}" for each in moved)
            continue
        largest = max((each.share for each in moved if each.share is not None), default=None)
        share = "" if largest is None else f", by up to {largest:.1e} of the largest"
        yield f"{checked.engine}: {cause}: {counted(len(moved), 'figure')} moved{share}"
        yield from (f"  {each}" for each in moved)


def _write_junit(checked: Sequence[CheckedEngine]) -> str:
    """Return an XML report in the form of JUnit: a test case for each engine."""
    failures = str(sum(bool(each.differences) for each in checked))
    suite = Element("testsuite", name="balcli check", tests=str(len(checked)), failures=failures)
    for each in checked:
        case = SubElement(suite, "testcase", classname="balcli", name=legible(each.engine))
        if each.differences:
            message = counted(len(each.differences), "difference")
            failure = SubElement(case, "failure", message=message)
            failure.text = legible("\n".join(_list_lines(each)))
    indent(suite)
    return tostring(suite, encoding="utf-8", xml_declaration=True).decode()
