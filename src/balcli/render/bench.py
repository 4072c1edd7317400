"""Results of the benchmark: table, JSON, CSV, and run time against error as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..documents.records import to_document
from .csv import Rows
from .formats import Renderer
from .plot import style
from .sheet import Grid, Sheet, number

if TYPE_CHECKING:
    from ..bench import Bench, Row
    from .units import System

ROUNDING = 1e-13  # errors below it are rounding, which a picture shows here


def document(result: Bench) -> dict[str, Any]:
    """Return `balcli.bench/1`."""
    return to_document(result)


def rows(result: Bench, _system: System) -> Rows:
    """CSV: run times in seconds and relative errors, then ratios."""
    return Rows(
        ("task", "method", "seconds", "error", "ratio"),
        [
            *((r.task, r.method, r.seconds, r.error, None) for r in result.rows),
            *(("ratio", r.what, None, None, r.value) for r in result.ratios),
        ],
    )


def sheet(result: Bench, _system: System) -> Sheet:
    """A table a task, and the ratios."""
    grids = [
        Grid(
            f"{task[0].upper()}{task[1:]}",
            ("method", "µs", "relative error"),
            tuple(
                (r.method, number(r.seconds * 1e6, 3), _error(r))
                for r in result.rows
                if r.task == task
            ),
        )
        for task in dict.fromkeys(r.task for r in result.rows)
    ]
    ratios = Grid(
        "Ratios of run times",
        ("", "ratio"),
        tuple((r.what, number(r.value, 3)) for r in result.ratios),
    )
    return Sheet("Run time against error", (*grids, ratios))


def _error(row: Row) -> str:
    """Two digits, where it is more than rounding."""
    return "rounding" if row.error < ROUNDING else f"{row.error:.1e}"


def draw_bench(result: Bench) -> bytes:
    """SVG: run time and error of every method, a panel a task, both axes logarithmic."""
    tasks = list(dict.fromkeys(r.task for r in result.rows))
    with style.open_figure(5.2 * len(tasks), 4.6) as page:
        for axes, task in zip(page.subplots(1, len(tasks), squeeze=False)[0], tasks, strict=True):
            points = [r for r in result.rows if r.task == task]
            for r in points:
                spot = r.seconds * 1e6, max(r.error, ROUNDING)
                axes.plot(
                    *spot,
                    "o",
                    color=style.RED if r.method.startswith("closed form") else style.BLUE,
                )
                axes.annotate(r.method, spot, xytext=(4, 3), textcoords="offset points", fontsize=7)
            axes.set(xscale="log", yscale="log", xlabel="µs", ylabel="relative error", title=task)
            for axis in (axes.xaxis, axes.yaxis):  # no mathematical text in our style
                axis.set_major_formatter(
                    lambda value, _: f"{value:.0e}" if not 0.01 <= value < 1e5 else f"{value:g}"
                )
        return style.save_figure(page, "svg")


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)
