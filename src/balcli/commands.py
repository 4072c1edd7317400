"""The commands `new`, `engines`, `schema` and `bench`."""

from __future__ import annotations

import json
from enum import StrEnum
from itertools import groupby
from pathlib import Path
from typing import Annotated

import typer

from .core.records import Node, describe_record
from .errors import BalcliError
from .file import examples
from .file.examples import template
from .file.fields import suggest_nearest
from .names import DOCUMENTS, import_name
from .shell.file_names import PICTURES, parse_output, require_ending, text_format
from .shell.options import FormatOption, Output
from .shell.output import emit, refuse_existing, show, write_file
from .shell.values import argument, optional

Force = Annotated[bool, typer.Option("--force", help="Overwrite FILE if it exists.")]
KIND = (
    "single, inline, vee, boxer, radial, radial14 or w; mounts: an engine on its mounts; "
    "compressor: two throws, gas in both ends; locomotive: balance of its wheels; field: balancing "
    "runs of a rotor; four-runs: the same without phase; torsion: a chain of inertias and shafts."
)
WHERE = "File to write; default: standard output."


def new(
    kind: Annotated[str, argument("KIND", KIND)],
    path: Annotated[Path | None, argument("FILE", WHERE, callback=parse_output)] = None,
    force: Force = False,
) -> None:
    """Write a commented, valid engine file to start from; for `field` and `four-runs` a file of
    runs, for `torsion` a chain file.

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


def _list(listed: list[examples.Example]) -> str:
    """Return the listing of examples: one line for each engine, under the name of its class."""
    width = max(map(len, examples.names()))
    parts = []
    for group, members in groupby(listed, key=lambda example: example.group):
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
        name = "chain-file"
        title = "balcli chain file"
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

    record = describe_record(import_name(DOCUMENTS[name]))
    properties = {"version": {"type": "string"}} | record["properties"]
    head = {"$schema": DIALECT, "$id": f"urn:balcli:schema:{name}:1"}
    changed = {"properties": properties, "required": ["version", *record["required"]]}
    return head | record | changed | {"title": f"balcli.{name}/1"}


def bench(form: FormatOption = None, output: Output = None) -> None:
    """Measure error against run time of several methods, on this machine: orders of a cylinder,
    peaks, gas torque, torsion, and a cold start. Errors are relative to the exact value of the same
    order; below 16 roundings they are "rounding". Times are processor times of one
    variant. An output that ends in .svg, .png or .pdf is a picture, in addition to the tables.

    \b
    Examples:
      balcli bench
      balcli bench -o bench.svg
    """
    picture = None if output is None else PICTURES.get(output.suffix.lower())
    text_output = output if picture is None else None
    written = text_format(text_output, form)
    from .bench.show import RENDERER
    from .bench.tasks import measure

    result = measure()
    if output is not None and picture is not None:
        from .bench.plot import make_picture
        from .show.plot_style import save_figure

        write_file(save_figure(make_picture(result), picture), output)
    show([result], RENDERER, written, text_output)
