"""The commands `new`, `engines`, `schema`, `check` and `bench`."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from enum import StrEnum
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import typer

from .core.records import Node, describe_record, to_document
from .errors import BalcliError, Exit, OtherKindError, legible
from .file import examples
from .file.examples import template
from .file.fields import counted, suggest_nearest
from .names import DOCUMENTS, import_name
from .shell.file_names import (
    format_option,
    parse_output,
    require_ending,
    text_format,
)
from .shell.inputs import exit_on_errors, find_engine_files, find_expected, read_engine, try_each
from .shell.options import FormatOption, Output
from .shell.output import emit, make_folder_of, refuse_existing, show, write_file
from .shell.progress import each_until_stopped, exit_if_cut_short, reporting_until_stopped
from .shell.values import argument, optional
from .show.formats import Format, json_text

if TYPE_CHECKING:
    from .regression import CheckedEngine, Difference


Force = Annotated[bool, typer.Option("--force", help="Overwrite FILE if it exists.")]
KIND = (
    "single, inline, vee, boxer, radial, radial14 or w; mounts: an engine on its mounts; "
    "locomotive: balance of its wheels; field: balancing runs of a rotor; torsion: a chain of "
    "inertias and shafts."
)
WHERE = "File to write; default: standard output."


def new(
    kind: Annotated[str, argument("KIND", KIND)],
    path: Annotated[Path | None, argument("FILE", WHERE, callback=parse_output)] = None,
    force: Force = False,
) -> None:
    """Write a commented, valid engine file to start from; for `field` a file of runs, for `torsion`
    a chain file.

    \b
    Example:
      balcli new vee v6.toml
    """
    text = template(kind)
    require_ending(path, ".toml", "FILE")
    refuse_existing(path, force)
    emit(text, path)


def complete_examples(incomplete: str) -> list[str]:
    """Return the names of the example engines that begin with this text."""
    return [name for name in examples.names() if name.startswith(incomplete)]


NAME = "Name of an example; without it, all are listed."
COPY = "File to write; default: standard output."
FIND = (
    "List only examples with these words in name, class (aero, car, marine), title, source, lesson "
    "or tables (gas, torsion)."
)


def engines(
    name: Annotated[str | None, argument("NAME", NAME, autocompletion=complete_examples)] = None,
    path: Annotated[Path | None, argument("FILE", COPY, callback=parse_output)] = None,
    find: Annotated[str, optional("WORDS", FIND)] = "",
    force: Force = False,
) -> None:
    """List the example engines that come with balcli, print one, or copy it. A copy of an example
    with several engines includes their files.

    \b
    Examples:
      balcli engines --find v8
      balcli engines i4 my_engine.toml
    """
    if name is None:
        emit(_list(examples.find(find)))
        return
    if find:
        raise BalcliError("--find lists engines; NAME prints one: give one of the two")
    text = examples.text(name)
    require_ending(path, ".toml", "FILE")
    beside = {} if path is None else examples.list_engine_files(name)
    targets = {path.parent / file: own for file, own in beside.items()} if path else {}
    for target in (path, *targets):
        refuse_existing(target, force)
    emit(text, path)
    for target, own in targets.items():
        write_file(own, target)


def _list(found: list[examples.Example]) -> str:
    """Return the listing of examples: one line for each engine, under the name of its class."""
    width = max(map(len, examples.names()))
    parts = []
    for group, members in groupby(found, key=lambda example: example.group):
        lines = [f"{example.name:{width}}  {example.lesson}" for example in members]
        parts.append("\n".join([group, "─" * len(group), *lines]))
    return "\n\n".join(parts)


class File(StrEnum):
    """Files that have a schema."""

    ENGINE = "engine"
    FIELD = "field"
    TORSION = "torsion"


FILE = (
    "engine: the engine file; field: balancing runs of a rotor; torsion: a chain of inertias "
    "and shafts."
)
OF = f"Instead, print the schema of a command's JSON output: {', '.join(DOCUMENTS)}."


def schema(
    kind: Annotated[File | None, typer.Argument(show_default="engine", help=FILE)] = None,
    of: Annotated[str | None, optional("RESULT", OF, "--of")] = None,
    output: Output = None,
) -> None:
    """Print the JSON Schema of the engine file, a file of runs or a chain file (for editors), or of
    a command's JSON output.

    \b
    Examples:
      balcli schema -o balcli.schema.json
      balcli schema --of analysis
    """
    require_ending(output, ".json")
    described = _describe_file(kind or File.ENGINE) if of is None else _describe_result(of, kind)
    emit(json.dumps(described, indent=2, ensure_ascii=False), output)


def _describe_file(kind: File) -> Node:
    from .field_balancing import runs_file as runs
    from .file import schema as files  # pydantic
    from .file.torsion_tables import Damper
    from .torsional_vibration import chain_file as chain

    if kind is File.FIELD:
        return files.describe_file(runs.RunsFile, [runs.Run], "runs-file", "balcli file of runs")
    if kind is File.TORSION:
        name, title = "chain-file", "balcli chain file"
        return files.describe_file(chain.ChainFile, [Damper, *chain.LISTS], name, title)
    return files.describe_engine_file()


def _describe_result(name: str, kind: File | None) -> Node:
    if kind is not None:
        raise BalcliError(f"--of {name} names a result; leave out {kind}, which is a kind of file")
    if name not in DOCUMENTS:
        hint = suggest_nearest(name, DOCUMENTS, f"there are {', '.join(DOCUMENTS)}")
        raise BalcliError(f"--of {name[:60]}: there is no such result; {hint}")
    return describe_document(name)


def describe_document(name: str) -> Node:
    """Return the JSON Schema (draft 2020-12) of one of `DOCUMENTS`. It allows further keys, since
    keys may be added without a new version of the format.
    """
    from .file.schema import DIALECT  # pydantic

    found = describe_record(import_name(DOCUMENTS[name]))
    properties = {"version": {"type": "string"}} | found["properties"]
    head = {"$schema": DIALECT, "$id": f"urn:balcli:schema:{name}:1"}
    changed = {"properties": properties, "required": ["version", *found["required"]]}
    return head | found | changed | {"title": f"balcli.{name}/1"}


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
    from .regression import Check, find_abandoned

    files, expected = find_engine_files(paths), find_expected(paths)
    found, work = {*files} - {*paths}, partial(_check_engine, update=update, tolerance=tolerance)
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
    from .regression import (
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
        return CheckedEngine(engine=str(path), differences=(), error=str(error))
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


def bench(form: FormatOption = None, output: Output = None) -> None:
    """Measure run time and error of several methods that compute the same forces, on this machine.

    \b
    Example:
      balcli bench --format json
    """
    from .bench import RENDERER, measure

    show([measure()], RENDERER, text_format(output, form), output)
