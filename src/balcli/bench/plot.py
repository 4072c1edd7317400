"""Draw error over run time, both logarithmic, with a panel for each task, λ and number of
variants.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..show.plot_style import BLUE, FAINT, GREEN, INK, RED, SOFT, open_figure
from ..show.sheet import capitalized
from .records import ROUNDING
from .show import TITLE, tell_place

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .records import Approach, Bench, Block, Measured

_LEAST = 1e-16  # smaller errors are drawn here
_MOST = 1.0
_TICKS = (1e-16, 1e-12, 1e-8, 1e-4, 1.0)
_PLAIN = 1e-3  # larger figures are written without an exponent
_MARKERS = ("o", "s", "^")  # of the orders
_LOOKS: dict[Approach, tuple[str, str]] = {
    "exact": (BLUE, "exact: closed form, pieces, maximum, synthesis"),
    "samples": (GREEN, "samples of the exact curve: FFT, grid, steps over the cycle"),
    "steps": (RED, "differences of positions: time steps"),
    "formula": (SOFT, "approximate: series of two terms, sum of amplitudes"),
}
_WIDTH = 11.0
_ROW = 3.0  # height of a row of panels, inches
_LEGEND = 0.8


def make_picture(result: Bench) -> Figure:
    """Return the picture."""
    rows = _arrange(result.blocks)
    with open_figure(_WIDTH, _ROW * len(rows) + _LEGEND) as figure:
        columns = max(map(len, rows))
        listed: list[tuple[float | None, ...]] = [(None,)]  # a peak needs no legend of markers
        grid = figure.subplots(len(rows), columns, sharey=True, sharex="row", squeeze=False)
        for panels, blocks in zip(grid, rows, strict=True):
            for ax, block in zip(panels, blocks, strict=False):
                _draw_block(ax, block)
                orders = tuple(error.order for error in block.methods[0].errors)
                if orders not in listed:
                    _list_orders(ax, orders)
                    listed.append(orders)
            for ax in panels[len(blocks) :]:
                ax.set_axis_off()
            panels[0].set_ylabel(_label_errors(blocks))
        figure.legend(handles=_make_key(), loc="outside lower center", ncols=3)
        figure.suptitle(TITLE)
        return figure


def _arrange(blocks: tuple[Block, ...]) -> list[list[Block]]:
    """Return rows of blocks: orders of a cylinder by number of variants, then whole engines."""
    rows: dict[tuple[bool, int], list[Block]] = {}
    for block in blocks:
        rows.setdefault((block.rod_ratio is None, block.variants), []).append(block)
    return list(rows.values())


def _label_errors(blocks: list[Block]) -> str:
    """Return the label of the errors of a row, with the task where all panels have the same."""
    tasks = {block.task for block in blocks}
    return f"{tasks.pop()}: relative error" if len(tasks) == 1 else "relative error"


def _make_key() -> list[Artist]:
    """Return the handles of a legend that explains the colours."""
    from matplotlib.lines import Line2D  # only for a picture
    from matplotlib.patches import Patch

    handles: list[Artist] = []
    for colour, label in _LOOKS.values():
        handles.append(Line2D([], [], marker="o", color=colour, linewidth=0.8, label=label))
    handles.append(Patch(color=FAINT, alpha=0.5, linewidth=0, label="rounding"))
    return handles


def _draw_block(ax: Axes, block: Block) -> None:
    ax.set_title(tell_place(block) or capitalized(block.task), pad=5)
    ax.axhspan(_LEAST, ROUNDING, color=FAINT, alpha=0.5, linewidth=0)
    for approach, (colour, _) in _LOOKS.items():
        methods = [method for method in block.methods if method.approach == approach]
        if methods:
            for k in range(len(methods[0].errors)):
                _draw_methods(ax, methods, k, colour)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_ylim(_LEAST, _MOST)
    ax.set_yticks(_TICKS)
    ax.set_xlabel("µs per variant")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_formatter(_write_tick)


def _draw_methods(ax: Axes, methods: list[Measured], k: int, colour: str) -> None:
    """Draw the errors of one order; a bar is the range between the quartiles of the time."""
    times = []
    errors = []
    for method in methods:
        times.append(1e6 * method.seconds.median)
        errors.append(min(max(method.errors[k].error, _LEAST), _MOST))
        ends = (1e6 * method.seconds.lower, 1e6 * method.seconds.upper)
        ax.plot(ends, (errors[-1], errors[-1]), color=colour, linewidth=3, alpha=0.4)
    ax.plot(times, errors, marker=_MARKERS[k], color=colour, linewidth=0.8, clip_on=False)


def _list_orders(ax: Axes, orders: tuple[float | None, ...]) -> None:
    """Draw a legend of the markers."""
    marks = []
    for order, marker in zip(orders, _MARKERS, strict=False):
        marks += ax.plot([], [], marker, color=INK, markersize=4, label=f"order {order:g}")
    ax.legend(handles=marks, loc="center left")


def _write_tick(value: float, _position: float) -> str:
    return f"{value:g}" if value >= _PLAIN else f"{value:.0e}"
