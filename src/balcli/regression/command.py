"""The command `balcli check`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import typer

from ..core.records import to_document
from ..errors import BalcliError, Exit, OtherKindError, legible, name_option
from ..file.fields import counted
from ..shell.file_names import format_option
from ..shell.inputs import exit_on_errors, find_engine_files, find_expected, read_engine, try_each
from ..shell.output import emit, make_folder_of, write_file
from ..shell.progress import each_until_stopped, exit_if_cut_short, reporting_until_stopped
from ..shell.values import argument
from ..show.formats import Format, json_text

if TYPE_CHECKING:
    from .comparison import CheckedEngine, Difference


REPORTS = (Format.TABLE, Format.JSON, Format.JUNIT)
REPORT = "junit: an XML report for continuous integration."
UPDATE = "Record the present results in the folder expected/ next to each engine file."
TOLERANCE = "Allowed change of a figure, as a share of the largest figure of the same quantity."


def check(
    paths: Annotated[list[Path], argument("PATH...", "Engine files, or folders of them.")],
    update: Annotated[bool, typer.Option("--update", help=UPDATE)] = False,
    tolerance: Annotated[float, typer.Option(help=TOLERANCE, min=0, max=1)] = 1e-9,
    form: Annotated[Format | None, format_option(REPORTS, REPORT)] = None,
) -> None:
    """Recompute engines and compare them with their recorded results; exit status 1 if a figure
    changed.

    A record holds the result of `analyze` (orders, peaks, displacement, dead centres) and, if the
    file has tables for them, main figures of `torque`, `mounts` and `torsion`. A record whose
    engine file is missing counts as a difference. Other kinds of files in a folder are skipped.

    \b
    Examples:
      balcli check v8.toml --update
      balcli check v8.toml
      balcli check v8.toml --tolerance 1e-6 --format junit
    """
    from .comparison import Check, find_abandoned

    files = find_engine_files(paths)
    expected = find_expected(paths)
    found = {*files} - {*paths}
    work = partial(_check_engine, update=update, tolerance=tolerance)
    with reporting_until_stopped("engines", len(files)) as progress:
        results, others = try_each(each_until_stopped(files, progress), work, found)
    checked = [*results, *find_abandoned(expected)]
    errors = [*(each.error for each in results if each.error), *others]
    compared = sum(each.error is None for each in results)
    moved = sum(len(each.differences) for each in checked)
    if form is Format.JSON:
        emit(json_text(to_document(Check(engines=tuple(checked)))))
    elif form is Format.JUNIT:
        emit(_write_junit(checked))
    else:
        done = " recorded" if update else f", {counted(moved, 'difference')}"
        lines = [line for each in checked for line in _list_lines(each)]
        emit(legible("\n".join([*lines, counted(compared, "engine") + done])))
    exit_on_errors(errors)
    exit_if_cut_short(progress)
    if not checked:
        raise BalcliError(f"{paths[0]}: has no engine files (*.toml)")
    if moved:
        raise typer.Exit(Exit.DIFFERENCE)


def _check_engine(path: Path, *, update: bool, tolerance: float) -> CheckedEngine:
    """Compare an engine file with its record, or (`update`) write the record."""
    from .comparison import (
        CheckedEngine,
        check_target,
        find_differences,
        find_record,
        record_result,
    )

    differences: list[Difference] = []
    try:
        engine = read_engine(str(path)).engine
        if update:
            write_file(record_result(engine), make_folder_of(check_target(path)))
        else:
            differences = find_differences(engine, find_record(path), tolerance)
    except OtherKindError:
        raise
    except BalcliError as error:
        return CheckedEngine(engine=str(path), differences=(), error=error.tell(name_option))
    return CheckedEngine(engine=str(path), differences=tuple(differences))


def _list_lines(checked: CheckedEngine) -> Iterator[str]:
    """Yield a line for each quantity with changed figures, followed by these figures."""
    for cause in dict.fromkeys(each.cause for each in checked.differences):
        moved = [each for each in checked.differences if each.cause == cause]
        if cause is None:
            yield from (f"{checked.engine}: {each}" for each in moved)
            continue
        largest = max((each.share for each in moved if each.share is not None), default=None)
        share = "" if largest is None else f", by up to {largest:.1e} of the largest figure"
        yield f"{checked.engine}: {cause}: {counted(len(moved), 'figure')} changed{share}"
        yield from (f"  {each}" for each in moved)


def _write_junit(checked: Sequence[CheckedEngine]) -> str:
    """Return an XML report in JUnit's format, with a test case for each engine."""
    suite = Element("testsuite", name="balcli check", tests=str(len(checked)))
    suite.set("failures", str(sum(bool(each.differences) for each in checked)))
    suite.set("errors", str(sum(each.error is not None for each in checked)))
    for each in checked:
        case = SubElement(suite, "testcase", classname="balcli", name=legible(each.engine))
        if each.error:
            first = legible(each.error.partition("\n")[0])
            SubElement(case, "error", message=first).text = legible(each.error)
        if each.differences:
            message = counted(len(each.differences), "difference")
            failure = SubElement(case, "failure", message=message)
            failure.text = legible("\n".join(_list_lines(each)))
    indent(suite)
    return tostring(suite, encoding="utf-8", xml_declaration=True).decode()
