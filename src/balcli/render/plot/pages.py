"""The pages of an engine: which pictures each one has, and where they stand.

A force or moment that is balanced, negligible or unknown has no picture; a line below the page says
so.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.phasors import Array, Phasors
from ...forces.kinds import EVERY_KIND, GAS, KINDS, ROLL, ROLL_TOTAL, SCALARS, TORQUE, VECTORS
from ...results.analysis import Analysis
from ...sizing.remedy import Remedy
from ...studies.pictures import Study
from ...torque.pictures import MainLoads, PinLoads, Pressures, Torques
from ..bobweight_page import percent
from ..engine_facts import tell_pivot
from ..sheet import NAMELESS, NEGLIGIBLE, size_text, small_text
from ..units import SI, ShownUnit, System
from .charts import (
    draw_along,
    draw_curves,
    draw_factors,
    draw_scalar_bars,
    draw_vector_bars,
    visible_rows,
)
from .gas import draw_main, draw_p_v, draw_pin, draw_pressure, draw_torque
from .plane import draw_end_curves, draw_locus, draw_order, draw_roses
from .style import fit_name, inline_svg, open_figure, put_title, save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_VECTORS = tuple(kind.name for kind in VECTORS)
ABOUT = "about"  # couple, torque and roll about the crank, in one picture
PICTURED = (*_VECTORS, ABOUT)
_TITLES = {"force": "Free force", "moment": "Free moment", ABOUT: "About the crank"}


@dataclass(frozen=True)
class PageSubject:
    """The engine of a page, and the units in which it is drawn."""

    study: Study
    system: System = SI

    @property
    def now(self) -> Analysis:
        """The engine, with the devices of the scheme if there is one."""
        return self.study.now

    def phasors(self, quantity: str) -> tuple[Phasors, Phasors | None]:
        """Return a force or moment now, and before the devices of a scheme were fitted."""
        before = self.study.before
        return self.now.spectra[quantity], None if before is None else before.spectra[quantity]

    def unit(self, quantity: str) -> ShownUnit:
        return self.system.moment if quantity == ABOUT else self.system.unit(KINDS[quantity])

    def list_scalars(self, *, with_gas: bool) -> dict[str, Phasors]:
        """Return the moments about the crank by label, the roll last."""
        kinds = [kind.name for kind in SCALARS]
        if with_gas and self.now.spectra.gas is not None:
            kinds = [TORQUE.name, GAS.name, ROLL_TOTAL.name]
        return {EVERY_KIND[name].label: self.now.spectra[name] for name in kinds}

    def find_words(self, quantity: str) -> str:
        """Return what is said of a quantity without a picture, which is unknown, balanced or
        negligible; empty if there is a picture.
        """
        if quantity == "moment" and not self.now.moments_known:
            return "not known: crank.spacing is missing"
        if quantity == ABOUT:
            curves = list(self.list_scalars(with_gas=True).values())
        else:
            curves = [curve for curve in self.phasors(quantity) if curve is not None]
        largest = float(max(np.abs(c.values(_divide_cycle(c))).max(initial=0) for c in curves))
        kind = ROLL.name if quantity == ABOUT else quantity
        if not largest or largest < NEGLIGIBLE * self.now.of_one_cylinder[kind]:
            return small_text(largest, self.unit(quantity))
        return ""

    def title(self, what: str, quantity: str) -> str:
        """Return the title of one of the pictures of a quantity."""
        title = _TITLES[quantity]
        if quantity == ABOUT and self.now.engine.gas is not None:
            title += ", with gas" if what == "spectrum" else ", of inertia alone"
        return title.replace("the crank", tell_pivot(self.now.engine).removesuffix(" axis"))


def _divide_cycle(*curves: Phasors | None) -> Array:
    """Return the crank angles of a curve, rad, every degree: to 720 degrees with half orders."""
    halves = any(np.any(c.orders[~c.balanced] % 1) for c in curves if c is not None)
    return np.radians(np.arange((720 if halves else 360) + 1))


def make_page(subject: PageSubject, what: str) -> Figure:
    """Return a page of pictures; `what` is one of `PAGES` that is not of torsion."""
    width, height, lay_out = _LAYOUTS[what]
    engine = subject.now.engine
    title = f"{fit_name(engine.name) or NAMELESS}, {engine.speed_rpm:g} rpm"
    with open_figure(width, height) as fig:
        fig.set_layout_engine("constrained", h_pad=0.1)
        words = lay_out(fig, subject) or ""
        if words:
            fig.supxlabel(words, x=0.01, ha="left", fontsize=9)
        if not fig.axes:
            fig.set_size_inches(6.4, 0.7)
        put_title(fig, f"{title}{_describe_devices(subject.study.remedy)}")
        return fig


def _describe_devices(remedy: Remedy | None) -> str:
    """Return a line with the scheme whose devices are fitted, if there are any."""
    if remedy is None:
        return ""
    share = f" {percent(remedy.card[0].factor)}" if remedy.card else ""
    order = "" if remedy.order is None else f", order {remedy.order}"
    return f"\nwith scheme {remedy.scheme}{share}{order}"


def draw_panel(subject: PageSubject, what: str, quantity: str) -> str:
    """Return one picture of one quantity, or words in its place, as an SVG for an HTML page."""
    words = subject.find_words(quantity)
    width, height = (4.2, 4.0) if what == "polar" else (5.2, 3.1)
    with open_figure(width, 0.6 if words else height) as fig:
        fig.set_facecolor("none")
        ax = fig.subplots()
        if words:
            ax.set_axis_off()
            ax.set_title(subject.title(what, quantity), pad=6)
            ax.text(0, 1, words, va="top", transform=ax.transAxes)
        else:
            _draw(ax, subject, what, quantity)
        name = f"{what}-{quantity}{'-after' if subject.study.before else ''}"
        return inline_svg(save_figure(fig, "svg"), name)


# ------------------------------------------------------------------ forces and moments
def _draw(ax: Axes, subject: PageSubject, what: str, quantity: str) -> None:
    """Draw one picture of a force or moment, or of what acts about the crank."""
    unit = subject.unit(quantity)
    ax.set_title(subject.title(what, quantity))
    if quantity == ABOUT:
        scalars = subject.list_scalars(with_gas=what == "spectrum")
        if what == "spectrum":
            draw_scalar_bars(ax, scalars, unit)
            return
        before = subject.phasors(ROLL.name)[1]
        crank = _divide_cycle(*scalars.values(), before)
        lines = {label: curve.values(crank).real for label, curve in scalars.items()}
        old = None if before is None else before.values(crank).real
        draw_curves(ax, crank, lines, "moment", unit, old)
        return
    curve, before = subject.phasors(quantity)
    if what == "polar":
        draw_locus(ax, curve, quantity, unit, before)
    elif what == "spectrum":
        draw_vector_bars(ax, curve, quantity, unit, before)
    else:
        crank = _divide_cycle(curve, before)
        values = curve.values(crank)
        lines = {"along x": values.real, "along y": values.imag, "size": np.abs(values)}
        old = None if before is None else np.abs(before.values(crank))
        draw_curves(ax, crank, lines, quantity, unit, old)


def _find_pictured(subject: PageSubject, quantities: Sequence[str]) -> tuple[list[str], str]:
    """Return the quantities that have a picture, and a line about the others."""
    words = {quantity: subject.find_words(quantity) for quantity in quantities}
    line = "; ".join(f"{_TITLES[each]}: {said}" for each, said in words.items() if said)
    return [quantity for quantity, said in words.items() if not said], line


def _lay_out_overview(fig: Figure, subject: PageSubject) -> str:
    """The locus of the force, or of the moment where no force is left, and the orders."""
    shown, words = _find_pictured(subject, PICTURED)
    loci = [quantity for quantity in shown if quantity in _VECTORS][:1]
    fig.set_size_inches(5.2 + 5.6 * len(loci), max(3.4, 2.2 * len(shown) + 0.4, 6.0 * len(loci)))
    grid = fig.add_gridspec(len(shown) or 1, 1 + len(loci))
    for quantity in loci:
        _draw(fig.add_subplot(grid[:, 0]), subject, "polar", quantity)
    for row, quantity in enumerate(shown):
        _draw(fig.add_subplot(grid[row, -1]), subject, "spectrum", quantity)
    return words


def _lay_out_all(fig: Figure, subject: PageSubject) -> str:
    """A row for each quantity: locus, orders, and curves over the crank angle."""
    shown, words = _find_pictured(subject, PICTURED)
    fig.set_size_inches(11.7, 0.5 + 3.6 * len(shown))
    grid = fig.add_gridspec(len(shown) or 1, 6)
    for row, quantity in enumerate(shown):
        pictures = ("spectrum", "curves") if quantity == ABOUT else ("polar", "spectrum", "curves")
        span = 6 // len(pictures)
        for k, what in enumerate(pictures):
            _draw(fig.add_subplot(grid[row, k * span : (k + 1) * span]), subject, what, quantity)
    return words


def _lay_out_polar(fig: Figure, subject: PageSubject) -> str:
    shown, words = _find_pictured(subject, _VECTORS)
    fig.set_size_inches(max(4.8 * len(shown), 5.2), 5.6)
    for k, quantity in enumerate(shown):
        _draw(fig.add_subplot(1, len(shown), k + 1), subject, "polar", quantity)
    return words


def _lay_out_rows(what: str, height: float) -> Callable[[Figure, PageSubject], str]:
    """Return a layout with one picture of each quantity, below one another."""

    def lay_out(fig: Figure, subject: PageSubject) -> str:
        shown, words = _find_pictured(subject, PICTURED)
        fig.set_figheight(0.5 + height * len(shown))
        for k, quantity in enumerate(shown):
            _draw(fig.add_subplot(len(shown), 1, k + 1), subject, what, quantity)
        return words

    return lay_out


def _lay_out_orders(fig: Figure, subject: PageSubject) -> str:
    """The largest four orders of force and of moment."""
    shown, words = _find_pictured(subject, _VECTORS)
    found = []
    for quantity in shown:
        curve = subject.phasors(quantity)[0]
        least = NEGLIGIBLE * subject.now.of_one_cylinder[quantity]
        rows = [k for k in visible_rows(curve) if curve.major[k] > least and curve.orders[k] >= 1]
        found += [(quantity, curve, k) for k in rows[:4]]
    height = 1 if len(found) <= 3 else 2
    columns = -(-len(found) // height)
    fig.set_size_inches(max(1.0 + 3.3 * columns, 4.3), 0.4 + 3.5 * height)
    for place, (quantity, curve, k) in enumerate(found, 1):
        ax = fig.add_subplot(height, columns, place)
        draw_order(ax, curve, k, quantity, subject.unit(quantity))
    return words


# ------------------------------------------------------------------ other pages
def _lay_out_factor(fig: Figure, subject: PageSubject) -> None:
    moment = subject.system.moment if subject.now.moments_known else None
    draw_factors(fig.subplots(), subject.study.factors, subject.system.force, moment)


def _lay_out_bank(fig: Figure, subject: PageSubject) -> str:
    banks, unit = subject.study.banks, subject.system.force
    if banks is None:
        raise ValueError("a page of bank angles needs a study of them")
    largest = float(banks.force.major.max(initial=0))
    if largest < NEGLIGIBLE * subject.now.of_one_cylinder["force"]:
        size = size_text(largest, unit, 2)
        return f"Force of order {banks.order:g}: negligible ({size}), whatever the bank angle"
    draw_end_curves(fig.add_subplot(1, 2, 1), banks, unit)
    draw_roses(fig.add_subplot(1, 2, 2, projection="polar"), banks, unit)
    return ""


def _lay_out_inner(fig: Figure, subject: PageSubject) -> str:
    """Shear, bending and bearings along the crankshaft; with gas bending of both, and bearings."""
    bent, system, words = subject.study.bent, subject.system, ""
    gas = [inner.with_gas for inner in bent if inner.with_gas is not None]
    pictures: list[tuple[str, str, list[Any], str]]
    if gas:
        pictures = [
            (
                "Bending moment in the crankshaft, with gas",
                "moment",
                [b.bending for b in gas],
                "default",
            ),
            (
                "Bending moment in the block, with gas",
                "moment",
                [b.block_bending for b in gas],
                "default",
            ),
            ("Load of each main bearing, with gas", "force", [b.bearings for b in gas], ""),
        ]
    else:
        shear, bending = [b.shear for b in bent], [b.bending for b in bent]
        pictures = [
            ("Shear force along the crankshaft", "force", shear, "steps-post"),
            ("Bending moment", "moment", bending, "default"),
        ]
        if loads := [b.bearings for b in bent if b.bearings]:
            pictures.append(("Inertia load of each main bearing", "force", loads, ""))
        else:
            words = "Inertia load of each main bearing: one throw, bearings not known"
    fig.set_figheight(0.4 + 2.4 * len(pictures))
    axes = fig.subplots(len(pictures), 1, sharex=True)
    for ax, (title, what, curves, joints) in zip(axes, pictures, strict=True):
        draw_along(ax, curves, what, system, joints, "the cycle" if gas else "a revolution")
        ax.set_title(title)
        ax.label_outer()
    axes[-1].set_xlabel(f"z, {system.length.name} (free end on the left)")
    return words


def _lay_out_gas(fig: Figure, subject: PageSubject) -> None:
    system = subject.system
    match subject.study.gas:
        case Pressures() as found:
            draw_pressure(fig.subplots(), found, system.pressure)
        case Torques() as found:
            draw_torque(fig.subplots(), found, system.moment)
        case PinLoads() as found:
            draw_pin(fig, found, system.force)
        case MainLoads() as found:
            draw_main(fig, found, system.force)


def _lay_out_p_v(fig: Figure, subject: PageSubject) -> None:
    if isinstance(subject.study.gas, Pressures):
        draw_p_v(fig.subplots(), subject.study.gas, subject.system)


_LAYOUTS: dict[str, tuple[float, float, Callable[[Figure, PageSubject], str | None]]] = {
    "overview": (10.8, 6.4, _lay_out_overview),
    "all": (11.7, 8.3, _lay_out_all),
    "polar": (9.6, 5.6, _lay_out_polar),
    "orders": (11.7, 7.4, _lay_out_orders),
    "spectrum": (6.5, 8.0, _lay_out_rows("spectrum", 2.5)),
    "curves": (7.5, 8.6, _lay_out_rows("curves", 2.7)),
    "factor": (7.2, 4.6, _lay_out_factor),
    "bank": (9.6, 5.4, _lay_out_bank),
    "inner": (7.5, 7.6, _lay_out_inner),
    "pressure": (7.2, 4.4, _lay_out_gas),
    "p-v": (6.4, 4.8, _lay_out_p_v),
    "torque": (8.4, 4.8, _lay_out_gas),
    "pin": (9.6, 5.9, _lay_out_gas),
    "main": (9.6, 6.4, _lay_out_gas),
}
