"""Draw torsional vibration: shapes of modes, Campbell diagram, torque over speed, and a waterfall
of the torque by order over speed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from ..core.vibration import Complex, Indices, Real
from ..errors import ArgumentError
from ..file.fields import counted
from ..show.formats import Units
from ..show.plot_style import (
    BLUE,
    FAINT,
    INK,
    MANY_LOOKS,
    PAPER,
    RED,
    SOFT,
    Look,
    fit_name,
    open_figure,
    put_legend_above,
    put_title,
)
from ..show.sheet import number, order_name
from ..show.units import SI, SYSTEMS, ShownUnit, System
from .answer import (
    TorsionAnalysis,
    answer_question,
    parse_half_orders,
    parse_question,
    require_speeds,
)
from .load import load_source
from .modes import Critical
from .motion import compute_curves
from .permitted import Limit, ShaftLimit
from .quantity import choose_torsion_speeds
from .response import TorsionResponse, add_resonances

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_MOST_MODES = 4  # largest number of drawn shapes; more would hide each other
_MOST_SHAFTS = 8  # largest number of shafts whose torque is drawn
_WIDEST = 0.9  # largest width of an order in a waterfall, as a share of the gap between orders
_MOST_ORDERS = 15  # largest number of orders in a Campbell diagram or waterfall
_LEAST_ORDER = 0.01  # orders below this share of the largest order's work or torque are left out
_APART = 0.042  # distance of two texts along an axis, as a share of the axis
_ON_PAPER: Look = {"facecolor": PAPER, "edgecolor": "none", "pad": 0.5}
_LIMIT_POINTS = 241  # number of speeds at which a limit is drawn
_LIMITS_ON_PAGE = 6
_OF_CASES = (("-", BLUE), ("--", RED))  # looks of the cases in a picture of limits
Kind = Literal["stress", "torque"]
_WORTH = 1e-3  # criticals with a smaller share of the work on their mode are not drawn


class _Curves(NamedTuple):
    """Torques of shafts and the swing of the free end, in SI units, at the given speeds and at the
    speeds of their peaks. `phasors` has the shape (orders, speeds, curves); `swings` (speeds,
    curves) is half of peak to peak.
    """

    rpm: Real
    orders: Real
    phasors: Complex
    swings: Real


def _compute_curves(result: TorsionAnalysis, response: TorsionResponse) -> _Curves:
    """Return the curves at the given speeds and at those of the peaks."""
    peaks = [shaft.worst.speed_rpm for shaft in response.shafts]
    peaks += [response.free_end_worst.speed_rpm]
    return _compute_at(result, np.union1d(response.speeds_rpm, peaks))


def _compute_at(result: TorsionAnalysis, rpm: Real) -> _Curves:
    """Return the curves at these speeds."""
    orders = result.system.require_excitation().orders
    curves = compute_curves(result.system, rpm)
    return _Curves(rpm, orders, curves.phasors, curves.swings)


def make_figures_of_torsion(
    path: str, pages: Sequence[str], speeds: str | None, orders: str | None, units: Units
) -> list[Figure]:
    """Return one figure for each page of pictures of the chain or engine in a file.

    Args:
        path: Path of the file; - for standard input.
        pages: Names of the pictures.
        speeds: Range of speeds, as typed; None: the default range about an engine's own speed.
        orders: Orders of the excitation, as typed.
        units: System of units.
    """
    asked = parse_question(speeds)
    source = load_source(path, parse_half_orders(orders))
    missing = asked.speeds_rpm is None and {"response", "waterfall"} & {*pages}
    if missing and source.engine is not None:
        asked = asked._replace(speeds_rpm=choose_torsion_speeds(source.engine))
    for page in pages:
        require_speeds(asked, page)
    found = answer_question(source, asked)
    return [make_torsion(found, page, SYSTEMS[units]) for page in pages]


def make_torsion(
    result: TorsionAnalysis, page: str, system: System = SI, *, titled: bool = True
) -> Figure:
    """Return a page of pictures; `what` is "all" or one of `report.names.OF_TORSION`.

    Raises:
        BalcliError: A waterfall needs a shaft, and there is none.
    """
    if page == "waterfall" and not result.shafts:
        raise ArgumentError("{what} waterfall: there is no shaft whose torque could be drawn")
    parts = list(_choose_parts(result, page, system))
    columns = 2 if page == "all" else 1
    rows = -(-len(parts) // columns)
    with open_figure(5.6 * columns + 1.2 * (columns == 1), 4.1 * rows + 0.3) as fig:
        for place, draw in enumerate(parts, 1):
            draw(fig.add_subplot(rows, columns, place))
        if titled:
            put_title(fig, f"{fit_name(result.name or '') or 'shafts without a name'}: torsion")
        return fig


def _choose_parts(
    result: TorsionAnalysis, page: str, system: System
) -> Iterator[Callable[[Axes], None]]:
    """Yield one drawing function for each picture of a page. Some need a response; without a
    response, they are left out.
    """
    if page in ("all", "modes"):
        yield lambda ax: _draw_modes(ax, result)
    if page in ("all", "campbell"):
        yield lambda ax: _draw_campbell(ax, result)
    if not hasattr(result, "response") or page in ("modes", "campbell"):
        return
    curves = _compute_curves(result, result.response)
    if page in ("all", "response") and result.shafts:
        yield lambda ax: _draw_torque(ax, result, curves, system)
    if page == "response":
        yield lambda ax: _draw_swing(ax, result, curves)
    if page in ("all", "waterfall") and result.shafts:
        yield lambda ax: _draw_waterfall(ax, result, curves, system)


def _draw_modes(ax: Axes, result: TorsionAnalysis) -> None:
    """Draw the angle of each node, joined along the shafts; a mesh of gears is dotted."""
    chain = result.system.chain
    names = result.system.nodes
    for mode, (line, colour) in zip(result.modes[:_MOST_MODES], MANY_LOOKS, strict=False):
        for start, end, stiffness in zip(chain.start, chain.end, chain.stiffness, strict=True):
            style = (0, (1, 2)) if np.isinf(stiffness) else line
            ends = [start, end]
            ax.plot(ends, mode.shape[ends], color=colour, linestyle=style, linewidth=1.4)
        label = f"{mode.number}: {number(mode.frequency_Hz)} Hz"
        ax.plot(range(len(names)), mode.shape, "o", color=colour, markersize=3, zorder=3)
        ax.plot([], [], line, color=colour, linewidth=1.4, marker="o", markersize=3, label=label)
    ax.axhline(0, color=SOFT, linewidth=0.8)
    ax.set_xticks(range(len(names)), [fit_name(name, 14) for name in names])
    ax.tick_params(axis="x", labelrotation=90 if len(names) > 5 else 0)
    ax.set(ylim=(-1.1, 1.1), title="Shapes of modes: angle of each node")
    if result.modes:
        put_legend_above(ax)


def _find_span(result: TorsionAnalysis, first: float) -> float:
    """Return the highest speed of a Campbell diagram, rpm, given the frequency of mode 1, Hz."""
    if hasattr(result, "response"):
        return float(result.response.speeds_rpm[-1])
    criticals: tuple[Critical, ...] = getattr(result, "criticals", ())
    worth = [each.speed_rpm for each in criticals if each.work_share > 0.02]
    return 1.1 * min(max(worth, default=60 * first), 120 * first)


def _draw_campbell(ax: Axes, result: TorsionAnalysis) -> None:
    """Draw natural frequencies over speed, a ray for each order, a dot for each critical."""
    first = result.modes[0].frequency_Hz if result.modes else 1000 / 60
    top = _find_span(result, first)
    criticals: tuple[Critical, ...] = getattr(result, "criticals", ())
    met = [c for c in criticals if c.work_share > _WORTH and c.speed_rpm <= top]
    every = np.array(sorted({c.order for c in met}) or getattr(result, "orders", []))
    work = [max((c.work for c in met if c.order == order), default=0.0) for order in every]
    orders = every[_find_largest(np.array(work))].tolist()
    dots = [(c.speed_rpm, c.order * c.speed_rpm / 60, c.work) for c in met if c.order in orders]
    rpm, hertz, works = np.array(dots).reshape(-1, 3).T
    ceiling = 1.25 * hertz.max(initial=first)
    hertz_of_modes = [one.frequency_Hz for one in result.modes if one.frequency_Hz < ceiling]
    for height, place in zip(hertz_of_modes, _spread(hertz_of_modes, ceiling), strict=True):
        ax.axhline(height, color=INK, linewidth=1)
        label = f"{number(height)} Hz"
        spot = place + 0.012 * ceiling
        ax.text(0.01 * top, spot, label, va="bottom", fontsize=7, bbox=_ON_PAPER)
    _draw_rays(ax, orders, top, ceiling)
    sizes = 12 + 240 * works / works.max(initial=0.0)
    ax.scatter(rpm, hertz, s=sizes, color=RED, alpha=0.7, zorder=3)
    ax.set(xlim=(0, 1.03 * top), ylim=(0, ceiling), xlabel="rpm", ylabel="Hz")
    title = "Campbell diagram: orders, and criticals by work"
    ax.set_title(title + _count_left_out(len(every) - len(orders)))
    _shade_barred(ax, result)


def _draw_rays(ax: Axes, orders: Sequence[float], top: float, ceiling: float) -> None:
    """Draw a ray for each order. Its number stands at its end, right of the axes or above them;
    numbers that would touch each other are moved along the edge.

    Args:
        ax: Axes to draw on.
        orders: Orders, rising.
        top: Highest speed, rpm.
        ceiling: Highest frequency, Hz.
    """
    for order in orders:
        end = min(top, 60 * ceiling / order)
        ax.plot([0, end], [0, order * end / 60], color=FAINT, linewidth=0.9, zorder=1)
    look: Look = {"fontsize": 7, "color": SOFT}
    beside = [order for order in orders if order * top / 60 <= ceiling]
    heights = [order * top / 60 for order in beside]
    for order, height in zip(beside, _spread(heights, ceiling), strict=True):
        ax.text(1.01 * top, height, order_name(order), va="center", **look)
    above = [order for order in reversed(orders) if order not in beside]
    speeds = [60 * ceiling / order for order in above]
    for order, speed in zip(above, _spread(speeds, top), strict=True):
        ax.text(speed, 1.01 * ceiling, order_name(order), ha="center", va="bottom", **look)


def _spread(places: Sequence[float], span: float) -> list[float]:
    """Return rising places on an axis, moved upwards so far that their texts do not touch."""
    moved: list[float] = []
    for place in places:
        free = moved[-1] + _APART * span if moved else place
        moved.append(max(place, free))
    return moved


def _find_largest(sizes: Real) -> Indices:
    """Return the indices of the orders to draw, given the size (orders,) of each order."""
    largest = np.argsort(-sizes, kind="stable")[:_MOST_ORDERS]
    return np.sort(largest[sizes[largest] >= _LEAST_ORDER * sizes.max(initial=0.0)])


def _count_left_out(count: int) -> str:
    """Return the second line of a title, which counts the orders that are not drawn."""
    return f"\n({counted(count, 'smaller order')} left out)" if count else ""


def _shade_barred(ax: Axes, result: TorsionAnalysis) -> None:
    for low, high in getattr(result, "barred_rpm", ()):
        ax.axvspan(low, high, color=RED, alpha=0.12, linewidth=0)


def _draw_torque(ax: Axes, result: TorsionAnalysis, curves: _Curves, system: System) -> None:
    """Draw half of peak to peak of the largest torques of shafts with their limits, or of their
    stresses if the file limits the stress and a shaft has a diameter.
    """
    stress = result.system.stress_by_torque
    limits = result.system.limits
    kind: Kind = "stress" if any(limit.kind == "stress" for limit in limits) else "torque"
    by_torque = stress if kind == "stress" else np.ones(len(stress))
    values = curves.swings[:, : len(by_torque)] * by_torque
    peaks = values.max(axis=0)
    unit = (system.stress if kind == "stress" else system.moment).fit(peaks.max())
    largest = np.argsort(-peaks, kind="stable")[:_MOST_SHAFTS]
    shown = np.sort(largest[by_torque[largest] > 0]).tolist()
    permitted = {limit.column: limit.limit for limit in limits if limit.kind == kind}
    common = len({permitted.get(k) for k in shown}) == 1
    for k, (line, colour) in zip(shown, cycle(MANY_LOOKS), strict=False):
        name = fit_name(result.shafts[k].name, 22)
        ax.plot(curves.rpm, values[:, k] / unit.size, line, color=colour, label=name)
        if k in permitted and not common:
            _draw_limit(ax, permitted[k], curves.rpm, unit, colour)
    if common and shown[0] in permitted:
        _draw_limit(ax, permitted[shown[0]], curves.rpm, unit, INK)
    title = f"Vibratory {kind}"
    if permitted:
        title += ", limits thin"
    _finish(ax, result, curves, title, unit.name)


def _draw_limit(
    ax: Axes, limit: Limit, rpm: Real, unit: ShownUnit, colour: str, *, labelled: bool = False
) -> None:
    """Draw a limit as a thin line, and the transient limit of a rule as a dashed one; `labelled`:
    the legend names both.
    """
    labels = ("limit", "transient limit") if labelled else (None, None)
    corners = [corner for corner in limit.corners if rpm[0] < corner < rpm[-1]]
    speeds = np.union1d(np.linspace(rpm[0], rpm[-1], _LIMIT_POINTS), corners)
    heights = limit.at(speeds) / unit.size
    ax.plot(speeds, heights, color=colour, linewidth=0.8, label=labels[0])
    transient = getattr(limit, "transient", None)
    if transient is not None:
        (line,) = ax.plot(speeds, heights * transient, color=colour, linewidth=0.8, label=labels[1])
        line.set_linestyle((0, (4, 3)))


class DrawnCase(NamedTuple):
    """A case whose curves a picture of limits shows: its name and its result."""

    name: str
    result: TorsionAnalysis


def make_limits(cases: Sequence[DrawnCase], system: System = SI) -> Iterator[Figure]:
    """Yield pages with a picture for each limit of a shaft: stress or torque over speed in every
    case, with the limit (solid) and the transient limit of a rule (dashed).

    Args:
        cases: Results of the same system and speeds, with a response.
        system: System of units.
    """
    curves = [_refine_curves(case.result) for case in cases]
    limits = [limit for limit in cases[0].result.system.limits if limit.kind != "angle"]
    for start in range(0, len(limits), _LIMITS_ON_PAGE):
        own = limits[start : start + _LIMITS_ON_PAGE]
        rows = -(-len(own) // 2)
        with open_figure(8.6, 2.7 * rows + 0.2) as fig:
            for place, limit in enumerate(own, 1):
                _draw_judged(fig.add_subplot(rows, 2, place), limit, cases, curves, system)
            yield fig


def _refine_curves(result: TorsionAnalysis) -> _Curves:
    """Return the curves at so many speeds that a picture shows every resonance."""
    given = result.response.speeds_rpm
    speeds = np.union1d(given, np.linspace(given[0], given[-1], _LIMIT_POINTS))
    peaks = [shaft.worst.speed_rpm for shaft in result.response.shafts]
    rpm = np.union1d(add_resonances(result.system, speeds), peaks)
    return _compute_at(result, rpm)


def _draw_judged(
    ax: Axes,
    limit: ShaftLimit,
    cases: Sequence[DrawnCase],
    curves: Sequence[_Curves],
    system: System,
) -> None:
    """Draw the curve of one limit in every case, and the limit."""
    rpm = curves[0].rpm
    values = [of_case.swings[:, limit.column] * limit.by_torque for of_case in curves]
    largest = max(float(each.max()) for each in values)
    unit = (system.stress if limit.kind == "stress" else system.moment).fit(largest)
    for case, of_case, heights, look in zip(cases, curves, values, _OF_CASES, strict=False):
        line, colour = look
        ax.plot(of_case.rpm, heights / unit.size, line, color=colour, label=case.name)
    _draw_limit(ax, limit.limit, rpm, unit, INK, labelled=True)
    name = fit_name(cases[0].result.shafts[limit.column].name, 24)
    ax.set(xlim=(float(rpm[0]), float(rpm[-1]) + 1e-9), ylim=(0, None))
    ax.set(xlabel="rpm", ylabel=f"± {unit.name}")
    ax.set_title(f"{name}: {limit.kind}", pad=20)
    put_legend_above(ax, 2)


def _draw_swing(ax: Axes, result: TorsionAnalysis, curves: _Curves) -> None:
    """Draw the half swing of the free end, and its largest orders."""
    end = len(result.shafts)
    amplitudes = np.degrees(np.abs(curves.phasors[:, :, end]))
    ax.plot(curves.rpm, np.degrees(curves.swings[:, end]), color=INK, label="all orders")
    sizes = amplitudes.max(axis=1)
    if result.measured is not None:  # measured orders come first
        measured = [row.order for row in result.measured.rows]
        sizes = sizes + np.where(np.isin(curves.orders, measured), sizes.max(), 0.0)
    largest = np.argsort(-sizes, kind="stable")[:5]
    for k, (line, colour) in zip(sorted(largest), MANY_LOOKS, strict=False):
        order = float(curves.orders[k])
        label = f"order {order_name(order)}"
        ax.plot(curves.rpm, amplitudes[k], line, color=colour, linewidth=1, label=label)
        _draw_measured(ax, result, order, colour)
    title = f"Half swing of {fit_name(result.system.free_end, 30)}"
    _finish(ax, result, curves, title, "deg", columns=3)


def _draw_measured(ax: Axes, result: TorsionAnalysis, order: float, colour: str) -> None:
    """Draw the measured amplitudes of an order as points."""
    if result.measured is None:
        return
    rows = [row for row in result.measured.rows if row.order == order]
    if not rows:
        return
    speeds = [row.speed_rpm for row in rows]
    amplitudes = [row.measured_deg for row in rows]
    ax.plot(speeds, amplitudes, "o", color=colour, markersize=3.5)


def _finish(
    ax: Axes, result: TorsionAnalysis, curves: _Curves, title: str, unit: str, columns: int = 4
) -> None:
    ends = float(curves.rpm[0]), float(curves.rpm[-1]) + 1e-9
    ax.set(xlim=ends, ylim=(0, None), xlabel="rpm", ylabel=f"± {unit}")
    ax.set_title(title, pad=30)
    put_legend_above(ax, columns)
    _shade_barred(ax, result)


def _draw_waterfall(ax: Axes, result: TorsionAnalysis, curves: _Curves, system: System) -> None:
    """Draw a waterfall of the shaft with the largest torque: one band for each order, whose width
    is proportional to the amplitude of the order at each speed.
    """
    shaft = int(curves.swings[:, : len(result.shafts)].max(axis=0).argmax())
    every = np.abs(curves.phasors[:, :, shaft])
    shown = _find_largest(every.max(axis=1))
    amplitudes = every[shown]
    orders = curves.orders[shown]
    most = float(amplitudes.max())
    gap = float(np.diff(orders).min()) if len(orders) > 1 else 1.0
    half = _WIDEST * gap / 2 / (most or 1.0)
    for order, sizes in zip(orders, amplitudes, strict=True):
        left = order - half * sizes
        right = order + half * sizes
        ax.axvline(order, color=FAINT, linewidth=0.5, zorder=0)
        ax.fill_betweenx(curves.rpm, left, right, color=BLUE, linewidth=0.4)
    ax.set(xlim=(0, float(orders[-1]) + gap), xlabel="order", ylabel="rpm")
    ax.grid(visible=False, axis="x")
    unit = system.moment.fit(most)
    name = fit_name(result.shafts[shaft].name, 22)
    title = f"Torque of {name} by order: widest {number(unit.of(most), 3)} {unit.name}"
    ax.set_title(title + _count_left_out(len(every) - len(orders)))
