"""Draw forces and moments in their plane: loci and rotating vectors.

The plane is seen from the free end, with x up and y to the right, so that the crank turns
clockwise. If the file gives `frame.up`, that direction is up in the pictures.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.phasors import Array, Complex, Phasors, unit as unit_vector
from ..forces.stars import Star, find_direction
from .plot_style import (
    BEFORE,
    BLUE,
    GREEN,
    INK,
    PAPER,
    RED,
    SOFT,
    Look,
    measure_room,
    put_legend_above,
)
from .sheet import NOTHING, VISIBLE, number, order_name, size_text
from .units import ShownUnit

if TYPE_CHECKING:
    from matplotlib.axes import Axes


FINE = np.radians(np.arange(361))  # crank angles at which one order is drawn
_ORDER_ANGLE = 36  # order * crank angle, deg, at which both vectors are drawn
_BOX: Look = {"facecolor": PAPER, "edgecolor": "none", "pad": 0.5}
_LIGHT = "#a9cfe8"
_DARK = "#00253d"  # ends of the colours of several paths
_MOST_ANGLES = 8  # crank angles that are written at a path
_HEIGHT_IN = 0.11  # height of an angle, inches
_LETTER_IN = 0.062  # width of one of its letters
_GAP_IN = 0.045  # distance from the path
_SHARE_OF_SIDE = 0.4  # half the side of square axes, as a share of their part of the figure
_CENTERED: Look = {"fontsize": 7, "ha": "center", "va": "center", "bbox": _BOX}


def set_up_plane(ax: Axes, largest: float, names: Sequence[str] = (), unit: str = "") -> float:
    """Make the axes a square with the origin in its middle; return half its side.

    Args:
        ax: Axes of the picture.
        largest: Size of the largest vector, in the unit of the axes.
        names: Names of the upward and rightward components, for the axes; empty: no labels.
        unit: Unit of the axes.
    """
    limit = 1.25 * (largest or 1.0)
    ax.set(xlim=(-limit, limit), ylim=(-limit, limit), aspect="equal")
    if names:
        up, right = names
        ax.set(xlabel=f"{right}, {unit}", ylabel=f"{up}, {unit}")
    ax.locator_params(nbins=5)
    ax.axhline(0, color=SOFT, linewidth=0.7, zorder=1)
    ax.axvline(0, color=SOFT, linewidth=0.7, zorder=1)
    return limit


def draw_path(ax: Axes, path: Complex, crank_deg: Array, step: float, limit: float) -> None:
    """Draw the path of a vector's tip, with a dot every `step` degrees. The crank angle at every
    second dot is written beside the path where it touches neither the path nor another angle; at
    most eight are written.

    Args:
        path: Path in the unit of the axes, real part upwards, shape (angles,).
        crank_deg: Crank angles, deg, shape (angles,).
        step: Crank angle between dots, deg.
        limit: Half the side of the axes.
    """
    ax.plot(path.imag, path.real, color=BLUE)
    marks = np.arange(0, crank_deg[-1], step)
    rows = np.abs(crank_deg[:, None] - marks).argmin(axis=0)
    at = path[rows]
    along = np.gradient(path)[rows]
    ax.plot(at.imag, at.real, "o", color=BLUE, markersize=2.6)
    normal = 1j * along * np.where((1j * along * at.conj()).real < 0, -1, 1)
    normal = np.where(np.abs(along) > 0.05 * np.abs(along).max(initial=0), normal, at)
    inch = limit / (_SHARE_OF_SIDE * min(measure_room(ax)))
    written: list[_Box] = []
    for mark, place, out in zip(marks[::2], at[::2], normal[::2], strict=True):
        text = f"{mark:g}°"
        size = complex(_HEIGHT_IN, _LETTER_IN * len(text)) * inch / 2
        way = out / (abs(out) or 1)
        for side in (way, -way, 1j * way, -1j * way):
            reach = abs(side.real) * size.real + abs(side.imag) * size.imag + _GAP_IN * inch
            box = _Box(place + reach * side, size)
            is_free = not any(map(box.touches, written)) and not box.holds_any(path)
            if is_free and box.is_within(limit) and len(written) < _MOST_ANGLES:
                ax.text(box.middle.imag, box.middle.real, text, **_CENTERED)
                written.append(box)
                break


class _Box(NamedTuple):
    """Place of a text: its middle, and half its height (real part) and width (imaginary part)."""

    middle: complex
    size: complex

    def touches(self, other: _Box) -> bool:
        """Return whether two texts touch each other."""
        apart = self.middle - other.middle
        both = self.size + other.size
        return abs(apart.real) <= both.real and abs(apart.imag) <= both.imag

    def holds_any(self, path: Complex) -> bool:
        """Return whether a path runs through the text."""
        apart = path - self.middle
        inside = (np.abs(apart.real) <= self.size.real) & (np.abs(apart.imag) <= self.size.imag)
        return bool(inside.any())

    def is_within(self, limit: float) -> bool:
        """Return whether the text lies within axes of this half side."""
        far = abs(self.middle.real) + self.size.real, abs(self.middle.imag) + self.size.imag
        return max(far) <= limit


def draw_locus(
    ax: Axes,
    curve: Phasors,
    names: Sequence[str],
    unit: ShownUnit,
    before: Phasors | None = None,
) -> None:
    """Draw the path of the tip of a vector over a revolution.

    Args:
        ax: Axes to draw on.
        curve: Phasors of the vector, shape (orders,).
        names: Names of the axes.
        unit: Unit of the vector.
        before: Phasors of a second path, which is dashed; None: no second path.
    """
    shown = [curve] if before is None else [curve, before]
    path, *others = map(values_over_period, shown)
    largest = float(np.abs(path).max())
    most = float(np.abs(np.concatenate([path, *others])).max())
    tiny = largest <= 0.3 * most  # a tiny path is enlarged in a corner
    s = unit.fit(most)
    limit = set_up_plane(ax, (1.25 if tiny else 1) * most / s.size, names, s.name)
    for old in others:
        look: Look = {
            "color": BEFORE,
            "linewidth": 1.3,
            "linestyle": (0, (4, 2)),
            "label": "before",
        }
        ax.plot(old.imag / s.size, old.real / s.size, **look)
        ax.plot([], [], color=BLUE, label="after")
        put_legend_above(ax)
    if tiny:
        ax.plot(path.imag / s.size, path.real / s.size, color=BLUE)
        if largest:
            inset = ax.inset_axes((0.7, 0.7, 0.3, 0.3))
            t = unit.fit(largest)
            set_up_plane(inset, largest / t.size)
            inset.plot(path.imag / t.size, path.real / t.size, color=BLUE)  # no room for angles
            inset.set_title(f"after, {t.name}", fontsize=8)
            inset.tick_params(labelsize=6)
        else:
            ax.text(0, 0.06 * limit, NOTHING, ha="center", va="bottom", bbox=_BOX)
        return
    path = path / s.size
    angles = np.arange(len(path), dtype=float)
    draw_path(ax, path, angles, angles[-1] / 12, limit)
    start = len(path) // 25
    way = path[start + 1] - path[start]
    tip = path[start] + 0.02 * limit * way / (abs(way) or 1)
    _draw_arrow(ax, path[start], tip, color=BLUE, linewidth=1.2, mutation_scale=13)


def draw_paths(ax: Axes, paths: Mapping[str, Complex], names: Sequence[str], unit: str) -> None:
    """Draw several paths of a vector's tip, from light to dark.

    Args:
        ax: Axes of the picture.
        paths: Paths by label, in the unit of the axes, real part upwards; each of shape (angles,).
        names: Names of the axes.
        unit: Unit of the axes.
    """
    from matplotlib.colors import LinearSegmentedColormap

    set_up_plane(ax, max(float(np.abs(path).max()) for path in paths.values()), names, unit)
    shades = LinearSegmentedColormap.from_list("blue", [_LIGHT, BLUE, _DARK])
    for (label, path), shade in zip(paths.items(), np.linspace(0, 1, len(paths)), strict=True):
        look: Look = {"color": shades(shade), "linewidth": 1.5, "label": label}
        ax.plot(path.imag, path.real, "o-", markevery=360, markersize=3, **look)


def draw_whole_path(
    ax: Axes, curve: Phasors, names: Sequence[str], unit: ShownUnit, colour: str
) -> None:
    """Draw the path of a vector's tip in a scale of its own, with a dot at crank angle 0.

    Args:
        ax: Axes to draw on.
        curve: Phasors of the vector, shape (orders,).
        names: Names of the axes.
        unit: Unit of the vector.
        colour: Colour of the path.
    """
    path = values_over_period(curve)
    largest = float(np.abs(path).max())
    s = unit.fit(largest)
    path = path / s.size
    set_up_plane(ax, largest / s.size, names, s.name)
    ax.plot(path.imag, path.real, color=colour, linewidth=2)
    ax.plot(path.imag[:1], path.real[:1], "o", color=colour, markersize=5)


def _draw_arrow(ax: Axes, start: complex, tip: complex, **look: object) -> None:
    """Draw an arrow between two places of the plane."""
    ends = (tip.imag, tip.real), (start.imag, start.real)
    ax.annotate("", *ends, arrowprops={"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, **look})


def values_over_period(curve: Phasors) -> Complex:
    """Return the values of a curve at every degree until its visible orders repeat."""
    return curve.values(np.radians(np.arange(find_period_deg(curve) + 1)))


def find_period_deg(curve: Phasors) -> int:
    """Return the crank angle after which the visible orders of a curve repeat, degrees."""
    seen = curve.orders[curve.major > VISIBLE * curve.major.max(initial=0)]
    repeats = int(np.gcd.reduce((2 * seen).astype(int), initial=0))  # per two revolutions
    return 720 // min(repeats, 24) if repeats else 360


def draw_order(
    ax: Axes, curve: Phasors, k: int, quantity: str, names: Sequence[str], unit: ShownUnit
) -> None:
    """Draw one order: its ellipse, and the two rotating vectors whose sum it is.

    Args:
        ax: Axes to draw on.
        curve: Phasors of the vector, shape (orders,).
        k: Row of the order.
        quantity: Name of the quantity.
        names: Names of the axes.
        unit: Unit of the vector.
    """
    order = float(curve.orders[k])
    phase = np.exp(1j * np.radians(_ORDER_ANGLE))
    s = unit.fit(float(curve.major[k]))
    forward = curve.forward[k] / s.size
    backward = curve.backward[k] / s.size
    path = forward * np.exp(1j * FINE) + backward * np.exp(-1j * FINE)
    set_up_plane(ax, float(np.abs(path).max()), names, s.name)
    ax.set_title(f"{quantity}, order {order_name(order)}, at crank angle {_ORDER_ANGLE / order:g}°")
    ax.plot(path.imag, path.real, color=INK)
    start = 0j
    for vector, colour, style, way in (
        (complex(forward * phase), BLUE, "-", "with the crank"),
        (complex(backward / phase), BLUE, (0, (3, 1)), "against it"),
    ):
        if not vector:
            continue
        ring = start + vector * np.exp(1j * FINE)
        tip = start + vector
        ax.plot(ring.imag, ring.real, color=colour, linewidth=0.7, linestyle=":")
        look: Look = {"color": colour, "linestyle": style}
        _draw_arrow(ax, start, tip, linewidth=1.5, mutation_scale=11, **look)
        label = f"{number(abs(vector), 3)} {s.name} {way}"
        ax.plot([], [], label=label, **look)
        start = tip
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2, columnspacing=1)


# ------------------------------------------------------------------ stars
_BANKS = (BLUE, RED, GREEN, SOFT)
_WAYS = {"forward": "with the crank", "backward": "against it"}
_SAME = 1e-6  # vectors whose directions differ by less (rad) are parallel
# Sideways shift of a number from its vector, and of a vector that runs back along the vector before
# it, as a share of half the side of the picture.
_GAP = 0.07


def draw_star(ax: Axes, star: Star, turn_deg: float) -> None:
    """Draw the forces of all cylinders from one point, with the numbers of the cylinders.

    Args:
        ax: Axes to draw on.
        star: Vectors of one order.
        turn_deg: Angle by which the picture is turned.
    """
    rays = _list_rays(star, "force", turn_deg)
    largest = max(abs(ray.vector) for ray in rays)
    ax.set(title=f"order {order_name(star.order)}, {_WAYS[star.turns]}")
    _set_up_square(ax, 0j, 1.4)
    ax.plot([0], [0], "o", color=INK, markersize=4)
    numbers = []
    for ray in rays:
        tip = ray.vector / largest
        _draw_arrow(ax, 0j, tip, **_look(ray.bank, len(star.banks)))
        numbers.append(_Number(tip, 2 * _GAP * ray.vector / abs(ray.vector), ray.cylinder))
    _write_numbers(ax, numbers)


class _Ray(NamedTuple):
    """A drawn vector of a star, its cylinder, and the number of its bank."""

    vector: complex
    cylinder: str
    bank: int


class _Number(NamedTuple):
    """The number of a cylinder, its place in a picture, and its shift from this place."""

    place: complex
    shift: complex
    text: str


def _list_rays(star: Star, quantity: str, turn_deg: float) -> list[_Ray]:
    """Return the turned vectors that are not 0, bank by bank and by direction within a bank."""
    turn = complex(unit_vector(turn_deg))
    rays = []
    for bank, own in enumerate(star.banks):
        by_direction = sorted(own.cylinders, key=lambda ray: find_direction(getattr(ray, quantity)))
        for ray in by_direction:
            vector = getattr(ray, quantity)
            if vector:
                rays.append(_Ray(turn * vector, str(ray.cylinder), bank))
    return rays


def draw_polygon(ax: Axes, star: Star, quantity: str, turn_deg: float, unit: ShownUnit) -> None:
    """Draw the vectors of force or moment one after the other, bank by bank, and their sum. In a
    bank they follow each other by direction, so that a polygon that closes is convex.

    Args:
        ax: Axes to draw on.
        star: Vectors of one order.
        quantity: "force" or "moment".
        turn_deg: Angle by which the picture is turned.
        unit: Unit of the vectors.
    """
    rays = _list_rays(star, quantity, turn_deg)
    corners = np.cumsum([0j, *(ray.vector for ray in rays)])
    spans = np.ptp(corners.real), np.ptp(corners.imag)
    limit = 0.62 * float(max(spans)) or 1.0
    middle = complex(corners.real.min(), corners.imag.min()) + complex(*spans) / 2
    total = complex(unit_vector(turn_deg)) * getattr(star, quantity)
    ax.set(title=f"{quantity}: {size_text(abs(total), unit) if total else 'closes'}")
    _set_up_square(ax, middle, limit)
    shift = 0j
    last = 0j
    numbers = []
    for ray, start in zip(rays, corners, strict=False):
        way = ray.vector / abs(ray.vector)
        if abs(way + last) < _SAME:  # the vector runs back along the one before it
            shift += 1j * last * _GAP * limit
        last = way
        place = complex(start) + shift
        _draw_arrow(ax, place, place + ray.vector, **_look(ray.bank, len(star.banks)))
        numbers.append(_Number(place + ray.vector / 2, -1j * way * _GAP * limit, ray.cylinder))
    _write_numbers(ax, numbers)
    if total:
        beside = 0j  # a sum along a straight line of vectors is drawn beside them
        if all(abs((ray.vector / total).imag) < _SAME for ray in rays):
            beside = 1j * _GAP * limit * total / abs(total)
        look: Look = {"color": INK, "linewidth": 1.6, "linestyle": (0, (4, 2))}
        _draw_arrow(ax, beside, beside + total, mutation_scale=11, **look)
    else:
        ax.plot([0], [0], "o", color=INK, markersize=4)


def _look(bank: int, banks: int) -> Look:
    """Return the look of a bank's vectors; lines of later banks are narrower, so that equal vectors
    remain visible.
    """
    width = 1.4 + 1.3 * max(0, min(banks, 4) - 1 - bank)
    return {"color": _BANKS[bank % len(_BANKS)], "linewidth": width, "mutation_scale": 9 + width}


def _set_up_square(ax: Axes, middle: complex, limit: float) -> None:
    """Make the axes an invisible square with this centre and half side."""
    ends = np.array([-limit, limit])
    ax.set(aspect="equal", xlim=middle.imag + ends, ylim=middle.real + ends)
    ax.set_axis_off()


def _write_numbers(ax: Axes, numbers: Iterable[_Number]) -> None:
    """Write each number at its place plus its shift; where numbers would overlap, they stand side
    by side.
    """
    groups: list[list[_Number]] = []
    for shown in numbers:
        for group in groups:
            if _overlap(group[0], shown):
                group.append(shown)
                break
        else:
            groups.append([shown])
    for group in groups:
        place, shift, _ = group[0]
        wide = abs(shift.imag) / abs(shift)  # share of the shift along the text
        spot = place + shift * (1 + 0.5 * wide * (len(group) - 1))
        text = ", ".join(shown.text for shown in group)
        ax.text(spot.imag, spot.real, text, **_CENTERED)


def _overlap(first: _Number, other: _Number) -> bool:
    """Return whether two numbers would overlap."""
    apart = first.place + first.shift - other.place - other.shift
    return abs(apart) < abs(other.shift)
