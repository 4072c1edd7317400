"""Free forces over the balance factor of a counterweight."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...sizing.scheme_figures import FactorPeaks
from ..sheet import size_text
from ..units import ShownUnit
from .axes import LOOKS
from .legends import put_legend_above
from .style import BLUE, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_factors(
    ax: Axes, rows: Sequence[FactorPeaks], force: ShownUnit, moment: ShownUnit | None
) -> None:
    """Draw the largest force and its components over the balance factor; the moment on an axis of
    its own where there is one (its unit is None where it is not known).
    """
    share = [row.factor for row in rows]
    s = force.fit(max(row.force for row in rows))
    lines = (
        ([row.force for row in rows], "force"),
        ([row.along for row in rows], "along the first bank"),
        ([row.across for row in rows], "across it"),
    )
    for (values, label), look in zip(lines, LOOKS, strict=True):
        ax.plot(share, np.array(values) / s.size, color=look[0], linestyle=look[1], label=label)
    best = min(rows, key=lambda row: row.cost)
    ax.plot(best.factor, best.force / s.size, "o", color=BLUE)
    ax.set(
        xlabel="balance factor: share of the reciprocating mass in the counterweights",
        ylabel=f"largest over a revolution, {s.name}",
        xlim=(share[0], share[-1]),
    )
    ax.set_ylim(bottom=0)
    least = size_text(best.force, force)
    if best.by_moment and moment is not None:
        least = f"moment {size_text(best.moment, moment)}"
    ax.set_title(f"Largest free force over the balance factor; best at {best.factor:.4g} ({least})")
    moments = np.array([row.moment for row in rows])
    if moment is not None and moments.max() > 0:
        t = moment.fit(float(moments.max()))
        right = ax.twinx()
        right.plot(share, moments / t.size, color=SOFT, linestyle=(0, (4, 2)), linewidth=1.2)
        right.set_ylabel(f"moment (dashed grey), {t.name}")
        right.set_ylim(bottom=0)
        right.grid(False)
    put_legend_above(ax)
