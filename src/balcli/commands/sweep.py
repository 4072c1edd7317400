"""`balcli sweep`"""

from __future__ import annotations

from contextlib import nullcontext
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from .options import EngineFile, Output


class Form(StrEnum):
    """How variants are written."""

    CSV = "csv"
    JSON = "json"


def sweep(
    file: EngineFile,
    vary: Annotated[
        list[str],
        typer.Option(
            "--vary",
            metavar="NUMBER=VALUES",
            show_default=False,
            help=(
                "A number of the engine file and its values: rod.ratio=0.24:0.32:0.01 "
                "(from:to:step, ends included) or crank.throws.2=90,180. "
                "Several span a grid, the last one fastest."
            ),
        ),
    ],
    quantity: Annotated[
        str,
        typer.Option(
            "--quantity",
            "-q",
            metavar="WHAT,...",
            help=(
                "force.2.major (or minor, forward, backward, axis, x, y, x_cos, x_sin, y_cos, "
                "y_sin), moment...; couple.4.amplitude (or cos, sin), "
                "torque..., roll...; peak.force, peak.moment."
            ),
        ),
    ] = "force.1.major,force.2.major,moment.1.major,moment.2.major",
    format: Annotated[  # noqa: A002
        Form, typer.Option("--format", "-f", help="How to write the variants.")
    ] = Form.CSV,
    output: Output = None,
    progress: Annotated[
        bool, typer.Option("--progress", help="Show a bar on standard error.")
    ] = False,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot",
            metavar="X.svg",
            show_default=False,
            help=("Also draw the quantities over one parameter (curves) or two (contours)."),
        ),
    ] = None,
    dask: Annotated[
        str,
        typer.Option(
            "--dask", metavar="ADDRESS|local", show_default=False, help="Compute on a dask cluster."
        ),
    ] = "",
) -> None:
    """Figures of many variants of an engine: numbers of its file over ranges, as CSV, JSON or (by
    the name of -o) Parquet.
    """
    from ..studies import dask_cluster as cluster
    from ..studies import sweep as sweeps
    from .sweep_output import heeding, interruptible, with_progress, write

    job = sweeps.ask(file, vary, quantity)
    form = "parquet" if output is not None and output.suffix == ".parquet" else format.value
    with interruptible() as stopped, cluster.client(dask) if dask else nullcontext() as workers:
        chunks = cluster.chunks(job, workers) if dask else sweeps.chunks(job)
        write(job, with_progress(heeding(chunks, stopped), job.variants, progress), form, output)
    if stopped.asked:
        typer.echo(f"balcli: stopped after {stopped.at} of {job.variants} variants", err=True)
        raise typer.Exit(130)
    if plot:
        from ..render.sweep_plot import draw
        from .output import write as write_file

        write_file(draw(job, sweeps.grid(job)), plot)
