"""`balcli sweep`"""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Annotated

import typer

from ..errors import Exit
from ..forces.kinds import DEFAULT_QUANTITIES
from .options import EnginePath, Output, SeriesFormat
from .output import write_file
from .overwrite_guard import refuse_overwriting


def sweep(
    path: EnginePath,
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
    ] = DEFAULT_QUANTITIES,
    form: Annotated[
        SeriesFormat, typer.Option("--format", "-f", help="How to write the variants.")
    ] = SeriesFormat.CSV,
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
    refuse_overwriting(reads=[path], writes={"--output": output, "--plot": plot})
    from ..render.sweep_plot import draw
    from ..studies.dask_cluster import connect_cluster, evaluate_on_cluster
    from ..studies.sweep import evaluate_chunks, evaluate_grid, read_sweep
    from .sweep_output import noting_interrupt, showing_progress, until_interrupted, write_sweep

    job = read_sweep(path, vary, quantity)
    kind = "parquet" if output is not None and output.suffix == ".parquet" else form.value
    cluster = connect_cluster(dask) if dask else nullcontext()
    with noting_interrupt() as interrupt, cluster as workers:
        chunks = evaluate_on_cluster(job, workers) if dask else evaluate_chunks(job)
        shown = showing_progress(until_interrupted(chunks, interrupt), job.variants, progress)
        write_sweep(job, shown, kind, output)
    if interrupt.noted:
        typer.echo(f"balcli: stopped after {interrupt.done} of {job.variants} variants", err=True)
        raise typer.Exit(Exit.INTERRUPTED)
    if plot:
        write_file(draw(job, evaluate_grid(job)), plot)
