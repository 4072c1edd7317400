"""Legends that stand between axes and their title."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend

_LINE = 12.0  # points from one line of a legend to the next


def put_legend_above(ax: Axes, columns: int = 4) -> None:
    """Put the legend between the axes and their title, with at most this many entries a line."""
    legend = ax.legend(
        loc="lower left",
        bbox_to_anchor=(0, 1),
        ncols=columns,
        handlelength=1.6,
        columnspacing=1,
        borderpad=0,
        borderaxespad=0.3,
        handletextpad=0.5,
        labelspacing=0.25,
    )
    legend.set_in_layout(False)  # what is too long may not narrow the axes


def fold_wide_legends(figure: Figure) -> bool:
    """Put on two lines, below a title that makes room, each legend above its axes that is wider
    than they are. Returns whether there were any: then the axes have to be laid out again.
    """
    from matplotlib import rcParams

    wide = [ax for ax in figure.axes if (legend := ax.get_legend()) and _is_too_wide(ax, legend)]
    for ax in wide:
        entries = len(ax.get_legend_handles_labels()[1])
        put_legend_above(ax, -(-entries // 2))
        ax.set_title(ax.get_title(loc="left"), pad=rcParams["axes.titlepad"] + _LINE)
    return bool(wide)


def _is_too_wide(ax: Axes, legend: Legend) -> bool:
    """Whether a legend above the axes reaches beyond them."""
    above = not legend.get_in_layout()
    return above and legend.get_window_extent().x1 > ax.get_window_extent().x1
