"""The command `balcli sweep`: its options."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import BalcliError, warn
from ..forces.kinds import DEFAULT_QUANTITIES
from ..limits import MOST_THREADS
from ..shell.file_names import (
    VARIANTS,
    Place,
    VariantsFormat,
    format_of,
    format_option,
    picture_form,
    read_place,
)
from ..shell.inputs import warn_each, warn_of_unknown_moments
from ..shell.options import EnginePath, ProgressAtOnce
from ..shell.output import is_seen, refuse_overwriting, write_figure
from ..shell.progress import reporting
from ..shell.values import optional
from .quantity_names import describe_names

if TYPE_CHECKING:
    from .sweep import Chunk


VARY = (
    "A number of the engine file and its values: rod.ratio=0.24:0.32:0.01 (from:to:step) or "
    "crank.throws.2=90,180. Several numbers span a grid, in which the last varies fastest."
)
QUANTITY = f"Figures by name: {describe_names()}"
FORM = (
    "Default: by the ending of -o, else a table in a terminal and csv in a pipe. With more than 50 "
    "variants, tables show only the first and last ones."
)
OUTPUT = (
    "File to write, or a folder for numbered Parquet files; repeating a sweep computes only "
    "the missing ones. - is standard output."
)
FORCE = "Replace the earlier sweep in the folder."
PLOT = "Also draw the quantities over one or two parameters; .svg, .png or .pdf."
JOBS = "Threads of a long sweep; default: one for each core."


def sweep(
    path: EnginePath,
    vary: Annotated[list[str], optional("NUMBER=VALUES", VARY)],
    quantity: Annotated[
        str | None,
        optional("WHAT,...", QUANTITY, "--quantity", "-q", show_default=DEFAULT_QUANTITIES),
    ] = None,
    form: Annotated[VariantsFormat | None, format_option(VariantsFormat, FORM)] = None,
    output: Annotated[
        Place | None, optional("FILE|FOLDER/", OUTPUT, "--output", "-o", parser=read_place)
    ] = None,
    force: Annotated[bool, typer.Option("--force", help=FORCE)] = False,
    progress: ProgressAtOnce = False,
    plot: Annotated[Path | None, optional("FILE", PLOT)] = None,
    jobs: Annotated[
        int | None, optional("N", JOBS, "--jobs", "-j", min=1, max=MOST_THREADS)
    ] = None,
    dask: Annotated[str, optional("ADDRESS|local", "Compute on a dask cluster.")] = "",
) -> None:
    """Quantities for many variants of an engine, whose numbers vary over ranges, as a table, CSV,
    JSON or Parquet.

    Ctrl-C leaves an older file unchanged. In a folder, repeating the sweep computes the missing
    files.

    \b
    Examples:
      balcli sweep v8.toml --vary layout.stagger=0:30:10 -q moment.1.major
      balcli sweep i4.toml --vary rod.ratio=0.24:0.32:0.01 -o ratios.csv --jobs 2
    """
    refuse_overwriting(reads=[path], writes={"--output": output, "--plot": plot})
    file, kind = _choose_target(output, form, plot)
    if force and not (output and output.is_folder):
        warn("--force is for a folder of parts (-o variants/); a file is replaced without it")
    drawn = picture_form(plot, "--plot") if plot is not None else None
    from . import sweep as chapter, sweep_show, sweep_write

    job = chapter.read_sweep(path, vary, quantity)
    if quantity is None and all(asked.kind != "moment" for asked in job.of_engine):
        warn_of_unknown_moments(job.name)
    warn_each(job.doubts, job.name)
    if drawn is not None:
        sweep_show.check_drawable(job)
    shown = not is_seen(file) or kind in (VariantsFormat.TABLE, VariantsFormat.MARKDOWN)
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
        reporting("variants", job.variants, progress, shown) as watch,
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
    output: Place | None, form: VariantsFormat | None, plot: Path | None
) -> tuple[Path | None, VariantsFormat]:
    """Return the path for the variants (None: standard output) and the format.

    Raises:
        BalcliError: Format and ending contradict each other, or an option does not go with a
            folder.
    """
    file = None if output is None else output.path
    if output is None or not output.is_folder:
        usual = VariantsFormat.TABLE if is_seen(file) else VariantsFormat.CSV
        return file, format_of(file, form, VARIANTS, usual)
    if form not in (None, VariantsFormat.PARQUET):
        raise BalcliError(
            f"--output {output.path}/: a folder takes Parquet files, but --format is {form}; "
            "leave one of them out"
        )
    if plot is not None:
        raise BalcliError(
            f"--plot {plot}: figures in a folder are not kept for a picture; write one file, or "
            "leave --plot out"
        )
    return file, VariantsFormat.PARQUET
