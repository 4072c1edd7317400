"""Draw error over run time, both logarithmic, with a panel for each λ and number of variants."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..show.plot_style import BLUE, GREEN, INK, RED, SOFT, open_figure
from .methods import POINTS, STEPS_DEG
from .show import TITLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .records import Bench, Block

_LEAST = 1e-16  # smaller errors are drawn here
_MOST = 1.0
_MARKERS = ("o", "s", "^")  # of the orders
_WIDTH = 11.0
_HEIGHT = 6.5


def make_picture(result: Bench) -> Figure:
    """Return the picture."""
    blocks = [block for block in result.blocks if block.rod_ratio is not None]
    ratios = list(dict.fromkeys(block.rod_ratio for block in blocks))
    sizes = list(dict.fromkeys(block.variants for block in blocks))
    with open_figure(_WIDTH, _HEIGHT) as figure:
        grid = figure.subplots(len(sizes), len(ratios), sharey=True, sharex="row", squeeze=False)
        for block in blocks:
            ax = grid[sizes.index(block.variants)][ratios.index(block.rod_ratio)]
            _draw_block(ax, block)
        for row in grid:
            row[0].set_ylabel("relative error of the order")
        for ax in grid[-1]:
            ax.set_xlabel("µs per variant")
        handles, labels = grid[0][0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=5)
        figure.suptitle(TITLE)
        return figure


def _draw_block(ax: Axes, block: Block) -> None:
    several = "one variant" if block.variants == 1 else f"{block.variants} variants"
    ax.set_title(f"λ = {block.rod_ratio:g}, {several}")
    families = {
        "series of two terms": (SOFT, ["series of two terms"]),
        "closed form": (BLUE, ["closed form"]),
        f"FFT of {POINTS[0]} to {POINTS[-1]} points": (
            GREEN,
            [row.method for row in block.methods if row.method.startswith("FFT")],
        ),
        f"time steps of {STEPS_DEG[0]} and {STEPS_DEG[1]} degrees": (
            RED,
            [row.method for row in block.methods if row.method.startswith("time")],
        ),
    }
    rows = {row.method: row for row in block.methods}
    for family, (colour, methods) in families.items():
        for k in range(len(block.methods[0].errors)):
            times = [1e6 * rows[method].seconds.median for method in methods]
            errors = [rows[method].errors[k].error for method in methods]
            shown = [min(max(error, _LEAST), _MOST) for error in errors]
            label = family if k == 0 else None
            ax.plot(times, shown, marker=_MARKERS[k], color=colour, linewidth=0.8, label=label)
    for k, (order, _) in enumerate(block.methods[0].errors):
        ax.plot([], [], _MARKERS[k], color=INK, linestyle="none", label=f"order {order:g}")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_ylim(_LEAST / 2, 2 * _MOST)
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_formatter(_write_tick)


def _write_tick(value: float, _position: float) -> str:
    return f"{value:g}"
