"""The commands `balcli numbers`, which lists the numbers of an engine file that can vary and its
quantities, and `balcli sweep`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import MOMENTS_UNKNOWN, BalcliError, warn
from ..forces.kinds import DEFAULT_QUANTITIES
from ..limits import MOST_THREADS
from ..shell.file_names import (
    VARIANTS,
    Place,
    format_of,
    format_option,
    picture_form,
    read_place,
    text_format,
)
from ..shell.inputs import read_engine, warn_each
from ..shell.options import EnginePath, FormatOption, Output
from ..shell.output import is_seen, refuse_overwriting, show, write_figure
from ..shell.progress import reporting
from ..shell.values import optional
from ..show.formats import Format, Renderer, Rows
from ..show.sheet import NAMELESS, UNKNOWN, Column, Grid, Sheet
from ..show.units import System
from .quantity_names import describe_names

if TYPE_CHECKING:
    from .quantities import FileNumber, NamedNumbers
    from .sweep import Chunk


_OF_CYLINDER = re.compile(r"cylinder\.\d+\.")


def sheet(result: NamedNumbers, _system: System) -> Sheet:
    """Return tables of the numbers and the quantities with one row for each name. A key of
    single cylinders that the file does not give has one row for all cylinders.
    """
    note = "–: not in the file; N stands for the number of a cylinder."
    heads = [
        Column("name", words=True),
        Column("value"),
        Column("unit"),
        Column("meaning", words=True),
    ]
    lines = dict.fromkeys(_list_rows(result.numbers))
    numbers = Grid.of_rows("Numbers: sweep --vary NAME=VALUES", heads, lines, note)
    columns = [
        Column("name", [q.name for q in result.quantities], words=True),
        Column("unit", [q.unit for q in result.quantities]),
        Column("meaning", [q.meaning for q in result.quantities], words=True),
    ]
    note = "N stands for an order or a number, PART for one of the words after the colon."
    quantities = Grid("Quantities: --quantity NAME,... (or search --minimise)", columns, note)
    return Sheet(result.engine.name or NAMELESS, (numbers, quantities))


def _list_rows(numbers: Iterable[FileNumber]) -> Iterator[tuple[str, str, str, str]]:
    """Yield the rows of the numbers; for lists, only the first member has its meaning."""
    before = ""
    for number in numbers:
        stem = number.path.rstrip("0123456789")
        meaning = "" if stem == before and stem.endswith(".") else number.meaning
        before = stem
        if number.value is not None:
            value = number.value if isinstance(number.value, str) else f"{number.value:.12g}"
            yield number.path, value, number.unit, meaning
        else:
            yield _OF_CYLINDER.sub("cylinder.N.", number.path), UNKNOWN, number.unit, meaning


def rows(result: NamedNumbers, _system: System) -> Rows:
    """Return CSV with one name in each line; quantities have no value."""
    numbers = (("number", n.path, n.value, n.unit, n.meaning) for n in result.numbers)
    quantities = (("quantity", q.name, None, q.unit, q.meaning) for q in result.quantities)
    return Rows(("kind", "name", "value", "unit", "meaning"), [*numbers, *quantities])


RENDERER = Renderer(sheet=sheet, rows=rows)


def numbers(path: EnginePath, form: FormatOption = None, output: Output = None) -> None:
    """List the numbers of an engine file that can vary, and its quantities: names for `sweep`,
    `search` and `scatter`, with values, units and meanings.

    \b
    Examples:
      balcli numbers v8.toml
      balcli numbers v8.toml --format csv
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    from .quantities import name_numbers

    show([name_numbers(read_engine(path, asked=()).model)], RENDERER, form, output)


VARY = (
    "A number of the engine file and its values: rod.ratio=0.24:0.32:0.01 (from:to:step) or "
    "crank.throws.2=90,180. Several numbers span a grid, in which the last varies fastest."
)
USUAL = DEFAULT_QUANTITIES.replace(",", ", ")  # help may fold lines at spaces
QUANTITY = f"Quantities by name: {describe_names()}"
FORM = (
    "Default: by the ending of -o; without -o, a table in a terminal and csv in a pipe. Tables "
    "show only the first 50 variants."
)
OUTPUT = (
    "File to write, or a folder for numbered Parquet files; repeating a sweep computes only "
    "the missing files. - is standard output."
)
FORCE = "Replace the earlier sweep in the folder."
PLOT = "Also draw the quantities over one or two parameters; .svg, .png or .pdf."
JOBS = "Threads of a long sweep; default: one for each core."


def sweep(
    path: EnginePath,
    vary: Annotated[list[str], optional("NUMBER=VALUES", VARY)],
    quantity: Annotated[
        str | None,
        optional("WHAT,...", QUANTITY, "--quantity", "-q", show_default=USUAL),
    ] = None,
    form: Annotated[Format | None, format_option(VARIANTS.values(), FORM)] = None,
    output: Annotated[
        Place | None, optional("FILE|FOLDER/", OUTPUT, "--output", "-o", parser=read_place)
    ] = None,
    force: Annotated[bool, typer.Option("--force", help=FORCE)] = False,
    plot: Annotated[Path | None, optional("FILE", PLOT)] = None,
    jobs: Annotated[
        int | None, optional("N", JOBS, "--jobs", "-j", min=1, max=MOST_THREADS)
    ] = None,
    dask: Annotated[str, optional("ADDRESS|local", "Compute on a dask cluster.")] = "",
) -> None:
    """Quantities of an engine whose numbers vary over ranges, as a table, CSV, JSON or Parquet.

    Ctrl-C leaves an older file unchanged. In a folder, repeating the sweep computes the missing
    files.

    \b
    Examples:
      balcli sweep v8.toml --vary layout.stagger=0:30:10 -q moment.1.major
      balcli sweep i4.toml --vary rod.ratio=0.24:0.32:0.01 -o ratios.csv --jobs 2
    """
    refuse_overwriting(reads=[path], writes={"--output": output and output.path, "--plot": plot})
    file, kind = _choose_target(output, form, plot)
    drawn = picture_form(plot, "--plot") if plot is not None else None
    from . import sweep as chapter, sweep_show, sweep_write

    job = chapter.read_sweep(path, vary, quantity)
    if quantity is None and all(asked.kind != "moment" for asked in job.evaluator.of_engine):
        warn(f"{job.name}: {MOMENTS_UNKNOWN}")
    warn_each(job.doubts, job.name)
    if drawn is not None:
        sweep_show.check_drawable(job)
    shown = not is_seen(file) or kind in (Format.TABLE, Format.MARKDOWN)
    kept: list[Chunk] = []

    def report(chunks: Iterable[Chunk]) -> Iterator[Chunk]:
        done = 0
        for chunk in chunks:
            if drawn is not None:
                kept.append(chunk)
            yield chunk
            done += len(chunk.values[0])
            watch(done)

    with (
        reporting("variants", job.variants, shown) as watch,
        sweep_write.share_work(jobs, dask) as share,
    ):
        if output is not None and output.is_folder:
            sweep_write.write_blocks(job, output.path, share, watch, force=force)
        else:
            chunks = report(chapter.evaluate_chunks(job, share))
            sweep_write.write_sweep(job, chunks, kind, file)
    if plot is not None and drawn is not None:
        write_figure(sweep_show.make_sweep(job, chapter.join_chunks(job, kept)), drawn, plot)


def _choose_target(
    output: Place | None, form: Format | None, plot: Path | None
) -> tuple[Path | None, Format]:
    """Return the path for the variants (None: standard output) and the format.

    Raises:
        BalcliError: Format and ending contradict each other, or an option is not possible
            with a folder.
    """
    file = None if output is None else output.path
    if output is None or not output.is_folder:
        usual = Format.TABLE if is_seen(file) else Format.CSV
        return file, format_of(file, form, VARIANTS, usual)
    if form not in (None, Format.PARQUET):
        raise BalcliError(
            f"--output {output.path}/: a folder takes Parquet files, but --format is {form}; "
            "leave one of them out"
        )
    if plot is not None:
        raise BalcliError(
            f"--plot {plot}: variants in a folder are not kept for a picture; write one file, or "
            "leave --plot out"
        )
    return file, Format.PARQUET
