"""Curves over the crank angle."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ...core.phasors import Array, Phasors
from ..units import ShownUnit
from .axes import LOOKS, divide_cycle
from .legends import put_legend_above
from .style import SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_vector_curves(
    ax: Axes, curve: Phasors, what: str, unit: ShownUnit, before: Phasors | None = None
) -> None:
    """Draw components and size of a vector over the crank angle, dashed its size `before`."""
    crank = divide_cycle(curve, before)
    values = curve.values(crank)
    _draw_lines(
        ax,
        crank,
        {"along x": values.real, "along y": values.imag, "size": np.abs(values)},
        what,
        unit,
        None if before is None else np.abs(before.values(crank)),
    )


def draw_scalar_curves(
    ax: Axes, curves: Mapping[str, Phasors], unit: ShownUnit, before: Phasors | None = None
) -> None:
    """Draw scalars over the crank angle, dashed the last one `before`."""
    crank = divide_cycle(*curves.values(), before)
    _draw_lines(
        ax,
        crank,
        {label: curve.values(crank).real for label, curve in curves.items()},
        "moment",
        unit,
        None if before is None else before.values(crank).real,
    )


def _draw_lines(
    ax: Axes,
    angles: Array,
    lines: Mapping[str, Array],
    what: str,
    unit: ShownUnit,
    before: Array | None,
) -> None:
    everything = [*lines.values(), *([] if before is None else [before])]
    s = unit.fit(max(float(np.abs(v).max()) for v in everything))
    crank = np.degrees(angles)
    cycle = round(crank[-1])
    if before is not None:
        ax.plot(
            crank,
            before / s.size,
            color=SOFT,
            linewidth=1,
            linestyle=(0, (4, 2)),
            label=f"{list(lines)[-1].split()[0]} before",
        )
    for (label, values), look in zip(lines.items(), LOOKS, strict=False):
        ax.plot(crank, values / s.size, color=look[0], linestyle=look[1], label=label)
    ax.axhline(0, color=SOFT, linewidth=0.7)
    ax.set(
        xlim=(0, cycle),
        xticks=np.arange(0, cycle + 1, cycle // 4),
        xlabel="crank angle, deg",
        ylabel=f"{what}, {s.name}",
    )
    ax.locator_params(axis="y", nbins=5)
    if not any(np.any(v) for v in everything):
        ax.set(ylim=(-1, 1), yticks=[0])
    put_legend_above(ax)
