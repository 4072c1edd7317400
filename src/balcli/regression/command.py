"""The command `balcli check`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.records import to_document
from ..errors import (
    ArgumentError,
    BalcliError,
    Exit,
    InputError,
    OtherKindError,
    is_verbose,
    legible,
    name_option,
    tell,
)
from ..shell.file_names import format_option
from ..shell.inputs import exit_on_errors, find_engine_files, find_expected, read_engine, try_each
from ..shell.output import emit, make_folder_of, write_file
from ..shell.progress import each_until_stopped, exit_if_cut_short, reporting_until_stopped
from ..shell.values import argument
from ..show.formats import Format, json_text

if TYPE_CHECKING:
    from ..engine.engine import Engine
    from ..file.lines import LineFinder
    from .records import CheckedEngine
    from .rules import Rules

FORMATS = (Format.TABLE, Format.JSON, Format.JUNIT, Format.GITHUB)
FORMAT = (
    "junit: an XML report for continuous integration; github: annotations for GitHub Actions, with "
    "file and line."
)
UPDATE = (
    "Record the present results in the folder expected/ next to each engine file. Records that "
    "still hold are not written."
)
TOLERANCE = (
    "Allowed change of a figure, as a share of the largest figure of the same quantity; default: "
    "[check] of the engine file, else 1e-9."
)


def check(
    paths: Annotated[list[Path], argument("PATH...", "Engine files, or folders of them.")],
    update: Annotated[bool, typer.Option("--update", help=UPDATE)] = False,
    tolerance: Annotated[
        float | None, typer.Option(help=TOLERANCE, min=0, max=1, show_default=False)
    ] = None,
    form: Annotated[Format | None, format_option(FORMATS, FORMAT)] = None,
) -> None:
    """Recompute engines and compare them with their recorded results; exit status 1 if a figure
    changed, or if a quantity is beyond a limit of the engine file.

    A record holds the result of `analyze` (orders, peaks, displacement, strokes, dead centres), the
    main figures of `torque`, `mounts` and `torsion` if the file has tables for them, and the inputs
    of the file. So changed inputs are named first; figures that follow from them are summed up
    (--verbose lists them). A record whose engine file is missing counts as a difference. Other
    kinds of files in a folder are skipped.

    The table [check] of an engine file has tolerances and limits by quantity.

    \b
    Examples:
      balcli check --update engines
      balcli check engines
      balcli check engines --format github
      balcli check engines/v8.toml --tolerance 1e-6 --verbose
    """
    from .comparison import find_abandoned

    if update and tolerance is not None:
        raise ArgumentError("{update} records, {tolerance} is for comparing: give one of them")
    files = find_engine_files(paths)
    expected = find_expected(paths)
    in_folders = {*files} - {*paths}
    work = partial(_check_file, update=update, tolerance=tolerance)
    with reporting_until_stopped("engines", len(files)) as progress:
        results, others = try_each(each_until_stopped(files, progress), work, in_folders)
    checked = [*results, *find_abandoned(expected)]
    emit(_render(checked, form or Format.TABLE, updated=update))
    exit_on_errors([*(each.error for each in results if each.error), *others])
    exit_if_cut_short(progress)
    if not checked:
        raise BalcliError(f"{paths[0]}: has no engine files (*.toml)")
    if any(each.differences or each.broken_limits for each in checked):
        raise typer.Exit(Exit.DIFFERENCE)


def _check_file(path: Path, *, update: bool, tolerance: float | None) -> CheckedEngine:
    """Compare an engine file with its record and its limits; with `update`, write the record.

    Raises:
        OtherKindError: The file is no engine file.
    """
    from ..file.lines import LineFinder
    from .comparison import check_engine
    from .records import CheckedEngine, spell_path
    from .rules import read_rules

    try:
        loaded = read_engine(str(path))
        rules = read_rules(loaded.engine, str(path), tolerance)
        lines = LineFinder(loaded.text)
        if update:
            return _record(loaded.engine, path, rules, lines)
        return check_engine(loaded.engine, path, rules, lines)
    except OtherKindError:
        raise
    except InputError as error:
        return _refuse(path, error)
    except BalcliError as error:
        return CheckedEngine(engine=spell_path(path), error=error.tell(name_option))


def _record(engine: Engine, path: Path, rules: Rules, lines: LineFinder) -> CheckedEngine:
    """Write the record of an engine, unless its record has the present inputs and holds within the
    default tolerance; tolerances of the file do not count.
    """
    from .comparison import check_engine
    from .recording import check_target, record_result
    from .rules import Tolerances

    target = check_target(path)
    checked = check_engine(engine, path, rules._replace(tolerances=Tolerances()), lines)
    if not checked.differences and checked.changed_inputs == ():
        return checked
    write_file(record_result(engine), make_folder_of(target))
    return replace(checked, differences=(), changed_inputs=(), fault=None, written=True)


def _refuse(path: Path, error: InputError) -> CheckedEngine:
    """Return the result for a file with mistakes, each with its line."""
    from ..file.lines import LineFinder
    from ..file.toml import read_bytes
    from .records import CheckedEngine, Mistake, spell_path
    from .show import describe_mistakes

    lines = LineFinder(read_bytes(path) if path.is_file() else b"")
    mistakes = [
        Mistake(each.path, tell(each.message, name_option), each.line or lines.find(each.path))
        for each in error.problems
    ]
    mistakes.sort(key=lambda mistake: mistake.line or 0)
    engine = spell_path(path)
    message = describe_mistakes(engine, mistakes, error.more)
    return CheckedEngine(engine=engine, mistakes=tuple(mistakes), error=message)


def _render(checked: Sequence[CheckedEngine], form: Format, *, updated: bool) -> str:
    """Return the result in a format."""
    from . import reports, show
    from .records import Check

    if form is Format.JSON:
        return json_text(to_document(Check(engines=tuple(checked))))
    if form is Format.JUNIT:
        return reports.write_junit(checked)
    if form is Format.GITHUB:
        return "\n".join(reports.list_annotations(checked))
    lines = [*show.list_lines(checked, every_figure=is_verbose())]
    lines.append(show.count_recorded(checked) if updated else show.count_engines(checked))
    return legible("\n".join(lines))
