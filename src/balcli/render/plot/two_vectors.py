"""One order as the sum of its two rotating vectors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.phasors import Phasors
from ..sheet import number, order_name
from ..units import ShownUnit
from .axes import FINE, set_up_plane
from .style import BLUE, INK, RED

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SHOWN_AT = 36  # degrees of the order's own angle: both vectors are then seen apart


def draw_order(ax: Axes, curve: Phasors, k: int, what: str, unit: ShownUnit) -> None:
    """Draw the k-th order: its ellipse, and the two rotating vectors whose sum it is."""
    one = curve.select_orders(curve.orders[[k]])
    order, phase = float(curve.orders[k]), np.exp(1j * np.radians(_SHOWN_AT))
    s = unit.fit(float(one.major[0]))
    values = one.values(FINE)
    set_up_plane(ax, [values], what, s)
    ax.set_title(f"{what}, order {order_name(order)}, at crank angle {_SHOWN_AT / order:g}°")
    ax.plot(values.imag / s.size, values.real / s.size, color=INK)
    forward, backward = complex(one.forward[0] * phase), complex(one.backward[0] / phase)
    _draw_vector(ax, 0j, forward, s, (BLUE, "-", "with the crank"))
    _draw_vector(ax, forward, backward, s, (RED, (0, (3, 1)), "against it"))
    ax.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2, handlelength=1.6, columnspacing=1
    )


def _draw_vector(
    ax: Axes, start: complex, vector: complex, s: ShownUnit, look: tuple[str, Any, str]
) -> None:
    """Draw an arrow, and the circle on which it turns."""
    if not vector:
        return
    colour, style, way = look
    ring = (start + vector * np.exp(1j * FINE)) / s.size
    ax.plot(ring.imag, ring.real, color=colour, linewidth=0.7, linestyle=":")
    tip, foot = (start + vector) / s.size, start / s.size
    ax.annotate(
        "",
        (tip.imag, tip.real),
        (foot.imag, foot.real),
        arrowprops={
            "arrowstyle": "-|>",
            "color": colour,
            "linewidth": 1.5,
            "linestyle": style,
            "shrinkA": 0,
            "shrinkB": 0,
            "mutation_scale": 11,
        },
    )
    ax.plot(
        [],
        [],
        color=colour,
        linestyle=style,
        label=f"{number(abs(vector) / s.size, 3)} {s.name} {way}",
    )
