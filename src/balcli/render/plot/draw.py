"""What is drawn on given axes. The plane of forces and moments is seen from the free end: x up, y
to the right, so that the crank turns clockwise.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...core.phasors import Array, Complex, Phasors
from ..figures import order_number
from ..sheet import number
from ..units import Unit
from .style import BLUE, GREEN, INK, PAPER, RED, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHARE = 1e-3  # orders below this share of the largest are too small to be seen
FINE = np.radians(np.arange(0, 360.5, 1))
_PREFIXES = {"N": "kN", "N·m": "kN·m"}


class Scale(NamedTuple):
    """Values over `size` are in the unit `name`."""

    size: float
    name: str


def scale(unit: Unit, largest: float) -> Scale:
    """The unit, or its thousandfold where figures would be long."""
    if largest >= 5000 * unit.size and unit.name in _PREFIXES:
        return Scale(1e3 * unit.size, _PREFIXES[unit.name])
    return Scale(unit.size, unit.name)


# ------------------------------------------------------------------ locus
def locus(ax: Axes, curve: Phasors, what: str, unit: Unit, before: Phasors | None = None) -> None:
    """Where the tip of the vector goes in a revolution, with crank angles along it; `before`: a
    second locus to compare with.
    """
    values, old = _once(curve), None if before is None else _once(before)
    s = scale(unit, max(np.abs(v).max(initial=0) for v in (values, old) if v is not None))
    limit = plane(ax, [values, old], what, s)
    if old is not None:
        ax.plot(
            old.imag / s.size,
            old.real / s.size,
            color=SOFT,
            linewidth=1,
            linestyle=(0, (4, 2)),
            label="before",
        )
    ax.plot([], [], color=BLUE, label="after")
    if old is not None:
        legend_above(ax)
    largest = float(np.abs(values).max()) / s.size
    if largest < 0.02 * limit:
        ax.plot(0, 0, "o", color=BLUE, markersize=4)
        told = f"at most {number(largest, 3)} {s.name}" if largest else f"no free {what}"
        ax.text(
            0,
            0.06 * limit,
            told,
            ha="center",
            va="bottom",
            bbox={"facecolor": PAPER, "edgecolor": "none", "pad": 1},
        )
        return
    ax.plot(values.imag / s.size, values.real / s.size, color=BLUE)
    _crank_angles(ax, curve, s, limit)


def _once(curve: Phasors) -> Complex:
    """The locus, no part of it twice (dashes drawn over one another would make a full line)."""
    return curve.values(FINE[: 360 // repeats(curve) + 1])


def plane(ax: Axes, curves: Sequence[Complex | None], what: str, s: Scale) -> float:
    """A square with the origin in its middle, x up."""
    largest = max(np.abs(c).max(initial=0) for c in curves if c is not None) / s.size
    limit = float(largest or 1) * 1.25
    ax.set(
        xlim=(-limit, limit),
        ylim=(-limit, limit),
        aspect="equal",
        xlabel=f"{what} along y, {s.name}",
        ylabel=f"{what} along x, {s.name}",
    )
    ax.locator_params(nbins=5)
    ax.axhline(0, color=SOFT, linewidth=0.7)
    ax.axvline(0, color=SOFT, linewidth=0.7)
    if not largest:
        ax.set(xticks=[0], yticks=[0])
    return limit


def _crank_angles(ax: Axes, curve: Phasors, s: Scale, limit: float) -> None:
    """Dots at every twelfth of the period, crank angles at every second one, on the outer side of
    the curve.
    """
    period = 360 // repeats(curve)
    marks = np.arange(12) * period / 12
    at, along = curve.values(np.radians(marks)), _derivative(curve).values(np.radians(marks))
    ax.plot(at.imag / s.size, at.real / s.size, "o", color=BLUE, markersize=2.6)
    side = -1 if _turning(curve) >= 0 else 1  # left or right of the way, in x up and y right
    for mark, place, way in zip(marks[::2], at[::2], along[::2], strict=True):
        normal = 1j * side * way if abs(way) > 0.05 * np.abs(along).max(initial=0) else place
        out = normal / abs(normal) if abs(normal) else 1
        spot = place / s.size + 0.085 * limit * out
        ax.text(spot.imag, spot.real, f"{mark:g}°", ha="center", va="center", fontsize=7, color=INK)
    _arrow(ax, curve.values(np.radians([0.04 * period, 0.055 * period])) / s.size, limit)


def _arrow(ax: Axes, step: Complex, limit: float) -> None:
    """Which way the tip goes."""
    way = step[1] - step[0]
    if abs(way) > 1e-4 * limit:
        tip = step[0] + way / abs(way) * 0.02 * limit
        ax.annotate(
            "",
            (tip.imag, tip.real),
            (step[0].imag, step[0].real),
            arrowprops={"arrowstyle": "-|>", "color": BLUE, "linewidth": 1.2, "mutation_scale": 13},
        )


def repeats(curve: Phasors) -> int:
    """How many times a revolution the curve repeats itself, as far as can be seen."""
    seen = curve.orders[curve.major > SHARE * curve.major.max(initial=0)].astype(int)
    return min(max(int(np.gcd.reduce(seen, initial=0)), 1), 12)


def _turning(curve: Phasors) -> float:
    """Twice the area inside the locus, positive if it is run through with the crank."""
    return float((curve.orders * (np.abs(curve.forward) ** 2 - np.abs(curve.backward) ** 2)).sum())


def _derivative(curve: Phasors) -> Phasors:
    return Phasors(
        curve.orders,
        1j * curve.orders * curve.forward,
        -1j * curve.orders * curve.backward,
        np.zeros(1),
    )


# ------------------------------------------------------------------ one order
_SHOWN_AT = 36  # degrees of the order's own angle: both vectors are then seen apart


def ellipse(ax: Axes, curve: Phasors, k: int, what: str, unit: Unit) -> None:
    """The k-th order as the sum of two rotating vectors."""
    one = curve.select_orders(curve.orders[[k]])
    order, phase = order_number(curve.orders[k]), np.exp(1j * np.radians(_SHOWN_AT))
    s = scale(unit, float(one.major[0]))
    values = one.values(FINE)
    plane(ax, [values], what, s)
    ax.set_title(f"{what}, order {order}, at crank angle {_SHOWN_AT / order:g}°")
    ax.plot(values.imag / s.size, values.real / s.size, color=INK)
    forward, backward = complex(one.forward[0] * phase), complex(one.backward[0] / phase)
    _vector(ax, 0j, forward, s, (BLUE, "-", "with the crank"))
    _vector(ax, forward, backward, s, (RED, (0, (3, 1)), "against it"))
    ax.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2, handlelength=1.6, columnspacing=1
    )


def _vector(
    ax: Axes, start: complex, vector: complex, s: Scale, look: tuple[str, Any, str]
) -> None:
    """An arrow, and the circle on which it turns."""
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


# ------------------------------------------------------------------ spectrum
def vector_spectrum(
    ax: Axes, curve: Phasors, what: str, unit: Unit, before: Phasors | None = None
) -> None:
    """The largest value of each order as a bar: its part that turns with the crank, and upon it the
    part against.
    """
    shown = visible(curve, before)
    s = scale(unit, max([float(p.major.max(initial=0)) for p in (curve, before) if p is not None]))
    ahead, against, places = (
        np.abs(curve.forward[shown]) / s.size,
        np.abs(curve.backward[shown]) / s.size,
        np.arange(len(shown)),
    )
    if before is not None:
        old = _rows(before, curve.orders[shown]) / s.size
        ax.bar(
            places,
            old,
            0.72,
            facecolor="none",
            edgecolor=SOFT,
            linestyle=(0, (3, 2)),
            label="before",
        )
    ax.bar(places, ahead, 0.56, color=BLUE, label="with the crank")
    ax.bar(places, against, 0.56, bottom=ahead, color=RED, hatch="////", label="against it")
    _bars(ax, curve.orders[shown], ahead + against, f"{what}, {s.name}")


def scalar_spectrum(ax: Axes, curves: Mapping[str, Phasors], unit: Unit) -> None:
    """Amplitudes of several scalars, side by side."""
    shown = sorted({k for curve in curves.values() for k in visible(curve)})
    s = scale(unit, max(float(c.major.max(initial=0)) for c in curves.values()))
    for (label, curve), look, shift in zip(curves.items(), LOOKS, (-0.27, 0, 0.27), strict=False):
        ax.bar(
            np.arange(len(shown)) + shift,
            curve.major[shown] / s.size,
            0.25,
            color=look[0],
            hatch=look[2],
            label=label,
        )
    _bars(ax, next(iter(curves.values())).orders[shown], None, f"moment, {s.name}")


def visible(curve: Phasors, before: Phasors | None = None) -> list[int]:
    """Rows of the orders that are large enough to be seen, always with 1 and 2; at most ten."""
    major = curve.major if before is None else np.maximum(curve.major, _rows(before, curve.orders))
    due = np.flatnonzero(
        (major > SHARE * major.max(initial=0)) | ((curve.orders >= 1) & (curve.orders <= 2))
    )
    keep = due[np.argsort(-major[due], kind="stable")[:10]]
    return sorted(keep.tolist())


def _rows(curve: Phasors, orders: Array) -> Array:
    """Largest values for these orders, 0 where one is not there."""
    there = dict(zip(curve.orders.tolist(), curve.major.tolist(), strict=True))
    return np.array([there.get(n, 0.0) for n in orders.tolist()])


def _bars(ax: Axes, orders: Array, tops: Array | None, label: str) -> None:
    ax.set_xticks(np.arange(len(orders)), [str(order_number(n)) for n in orders])
    ax.set(xlabel="order", ylabel=label, xlim=(-0.6, len(orders) - 0.4))
    ax.grid(False, axis="x")
    ax.locator_params(axis="y", nbins=4)
    for place, top in enumerate(() if tops is None else tops):
        ax.annotate(
            number(float(top), 3),
            (place, top),
            (0, 2),
            textcoords="offset points",
            ha="center",
            fontsize=7,
        )
    highest = ax.dataLim.y1
    ax.set_ylim(0, 1.18 * highest or 1)
    if not highest:
        ax.set_yticks([0])
    legend_above(ax)


def legend_above(ax: Axes) -> None:
    """On one line between the axes and their title."""
    legend = ax.legend(
        loc="lower left",
        bbox_to_anchor=(0, 1),
        ncols=4,
        handlelength=1.6,
        columnspacing=1,
        borderpad=0,
        borderaxespad=0.3,
        handletextpad=0.5,
    )
    legend.set_in_layout(False)  # what is too long may not narrow the axes


# ------------------------------------------------------------------ curves over the crank angle
LOOKS = ((BLUE, "-", ""), (RED, (0, (5, 1.5)), "////"), (GREEN, (0, (1.5, 1)), "...."))


def vector_curves(
    ax: Axes, curve: Phasors, what: str, unit: Unit, before: Phasors | None = None
) -> None:
    """Components and size over the crank angle."""
    values = curve.values(FINE)
    _curves(
        ax,
        {"along x": values.real, "along y": values.imag, "size": np.abs(values)},
        what,
        unit,
        None if before is None else np.abs(before.values(FINE)),
    )


def scalar_curves(
    ax: Axes, curves: Mapping[str, Phasors], unit: Unit, before: Phasors | None = None
) -> None:
    """Scalars over the crank angle."""
    _curves(
        ax,
        {label: curve.values(FINE).real for label, curve in curves.items()},
        "moment",
        unit,
        None if before is None else before.values(FINE).real,
    )


def _curves(
    ax: Axes, lines: Mapping[str, Array], what: str, unit: Unit, before: Array | None
) -> None:
    everything = [*lines.values(), *([] if before is None else [before])]
    s = scale(unit, max(float(np.abs(v).max()) for v in everything))
    crank = np.degrees(FINE)
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
        xlim=(0, 360),
        xticks=np.arange(0, 361, 90),
        xlabel="crank angle, deg",
        ylabel=f"{what}, {s.name}",
    )
    ax.locator_params(axis="y", nbins=5)
    if not any(np.any(v) for v in everything):
        ax.set(ylim=(-1, 1), yticks=[0])
    legend_above(ax)
