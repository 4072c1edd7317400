"""Which pictures there are, and how each page is laid out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...core.phasors import Phasors
from ...forces.kinds import EVERY_KIND, GAS, KINDS, ROLL, ROLL_TOTAL, SCALARS, TORQUE, VECTORS
from ...results.analysis import Analysis
from ...sizing.remedy import Remedy
from ...studies.pictures import Study
from ...torque.pictures import MainLoads, PinLoads, Pressures, Torques
from ..bobweights import percent
from ..engine_facts import tell_pivot
from ..sheet import NAMELESS, NEGLIGIBLE, size_text, small_text
from ..units import SI, ShownUnit, System
from .along_crankshaft import draw_along
from .axes import divide_cycle
from .balance_factor import draw_factors
from .bank_angle import draw_end_curves, draw_roses
from .bars import draw_scalar_bars, draw_vector_bars, visible_rows
from .crank_curves import draw_scalar_curves, draw_vector_curves
from .gas import draw_main, draw_p_v, draw_pin, draw_pressure, draw_torque
from .locus import draw_locus
from .style import Form, fit_name, inline_svg, open_figure, put_title, save_figure
from .two_vectors import draw_order

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_VECTORS = tuple(kind.name for kind in VECTORS)
BELOW_TITLE = 0.1  # inches between the title of a page and those of its panels
ABOUT = "about"  # the crank: couple, torque and roll in one picture
ABOUT_WITH_GAS = "about-with-gas"  # by order; over the crank angle gas has a picture of its own
_ABOUT = {
    ABOUT: tuple(kind.name for kind in SCALARS),
    ABOUT_WITH_GAS: (TORQUE.name, GAS.name, ROLL_TOTAL.name),
}
PICTURED = (*_VECTORS, ABOUT)
_TITLES = {"force": "Free force", "moment": "Free moment", ABOUT: "About the crank"}
_TITLES[ABOUT_WITH_GAS] = "About the crank, with gas"


@dataclass(frozen=True)
class PageSubject:
    """What a page shows, and in which units."""

    study: Study
    system: System = SI

    @property
    def now(self) -> Analysis:
        """With the devices that were fitted, if any were."""
        return self.study.now

    def phasors(self, quantity: str) -> tuple[Phasors, Phasors | None]:
        """Now, and before devices were fitted, if any were."""
        before = self.study.before
        return self.now.spectra[quantity], None if before is None else before.spectra[quantity]

    def find_largest(self, quantity: str) -> float:
        """The largest over a revolution, with devices and without, SI; quantity one of PICTURED."""
        kinds = _ABOUT.get(quantity, (quantity,))
        curves = [p for kind in kinds for p in self.phasors(kind) if p is not None]
        return float(max(np.abs(p.values(divide_cycle(p))).max(initial=0) for p in curves))

    def of_bars(self, quantity: str) -> str:
        """What the bars of a quantity show."""
        has_gas = self.now.spectra.gas is not None
        return ABOUT_WITH_GAS if quantity == ABOUT and has_gas else quantity

    def unit(self, quantity: str) -> ShownUnit:
        return self.system.unit(KINDS[quantity])

    def is_unknown(self, quantity: str) -> bool:
        """A moment of throws of which nobody has said where they stand."""
        return quantity == "moment" and not self.now.moments_known

    def title(self, quantity: str) -> str:
        """Of a picture."""
        of_inertia = quantity == ABOUT and self.now.engine.gas is not None
        title = _TITLES[quantity] + (", of inertia alone" if of_inertia else "")
        pivot = tell_pivot(self.now.engine).removesuffix(" axis")
        return title.replace("the crank", pivot)

    def list_scalars(self, quantity: str) -> dict[str, Phasors]:
        """What is drawn about the crank, by label, the roll last."""
        return {EVERY_KIND[name].label: self.now.spectra[name] for name in _ABOUT[quantity]}


def make_page(subject: PageSubject, what: str, form: Form) -> Figure:
    """A page of pictures, as a figure of matplotlib; `what` is one of PAGES."""
    width, height, layout = PAGES[what]
    with open_figure(width, height, form) as fig:
        fig.set_layout_engine("constrained", h_pad=BELOW_TITLE)
        layout(fig, subject)
        engine = subject.now.engine
        name = fit_name(engine.name) or NAMELESS
        put_title(fig, f"{name}, {engine.speed_rpm:g} rpm{_tell_fitted(subject.study.remedy)}")
        return fig


def _tell_fitted(remedy: Remedy | None) -> str:
    """A line with the scheme of the devices that are fitted."""
    if remedy is None:
        return ""
    share = f" {percent(remedy.card[0].factor)}" if remedy.card else ""
    order = "" if remedy.order is None else f", order {remedy.order}"
    return f"\nwith scheme {remedy.scheme}{share}{order}"


def draw_panel(subject: PageSubject, what: str, quantity: str) -> str:
    """One picture of one quantity, as an SVG to stand in a page of ours."""
    width, height = (4.2, 4.0) if what == "polar" else (5.2, 3.1)
    quantity = subject.of_bars(quantity) if what == "spectrum" else quantity
    if _find_words(subject, quantity):
        height = 0.6
    with open_figure(width, height, "svg") as fig:
        fig.set_facecolor("none")
        _PANELS[what](fig.subplots(), subject, quantity)
        return inline_svg(
            save_figure(fig, "svg"), f"{what}-{quantity}{'-after' if subject.study.before else ''}"
        )


# ------------------------------------------------------------------ layouts
def _lay_out_all(fig: Figure, subject: PageSubject) -> None:
    grid = fig.add_gridspec(2, 3, height_ratios=(1.25, 1))
    bars = grid[0, 2].subgridspec(3, 1)
    for k, quantity in enumerate(_VECTORS):
        _locus_panel(fig.add_subplot(grid[0, k]), subject, quantity)
    for k, quantity in enumerate(PICTURED):
        _bars_panel(ax := fig.add_subplot(bars[k]), subject, quantity)
        ax.set_xlabel("order" if quantity == PICTURED[-1] else "")  # leaves room for the bars
        _curves_panel(fig.add_subplot(grid[1, k]), subject, quantity)


def _lay_out_polar(fig: Figure, subject: PageSubject) -> None:
    for ax, quantity in zip(fig.subplots(1, 2), _VECTORS, strict=True):
        _locus_panel(ax, subject, quantity)


def _lay_out_spectrum(fig: Figure, subject: PageSubject) -> None:
    for ax, quantity in zip(fig.subplots(3, 1), PICTURED, strict=True):
        _bars_panel(ax, subject, quantity)


def _lay_out_curves(fig: Figure, subject: PageSubject) -> None:
    for ax, quantity in zip(fig.subplots(3, 1, sharex=True), PICTURED, strict=True):
        _curves_panel(ax, subject, quantity)
        ax.label_outer()


def _lay_out_orders(fig: Figure, subject: PageSubject) -> None:
    """The largest orders of force and of moment, a row each; of one that has none, words."""
    shown = {quantity: _find_orders(subject, quantity) for quantity in _VECTORS}
    columns = max(map(len, shown.values()))
    heights = [3.5 if found else 0.7 for found in shown.values()]
    if columns == 1 and all(shown.values()):  # side by side
        fig.set_size_inches(0.6 + 3.3 * len(shown), 0.4 + max(heights))
        grid = fig.subplots(1, len(shown), squeeze=False).T
    else:
        columns = max(columns, 1)
        fig.set_size_inches(1.0 + 3.3 * columns, 0.4 + sum(heights))
        grid = fig.subplots(len(shown), columns, squeeze=False, height_ratios=heights)
    for row, (quantity, found) in zip(grid, shown.items(), strict=True):
        for ax in row[len(found) :]:
            ax.set_axis_off()
        if not found:
            _write_words(row[0], _TITLES[quantity], _find_words(subject, quantity))
        for ax, k in zip(row, found, strict=False):
            draw_order(ax, subject.phasors(quantity)[0], k, quantity, subject.unit(quantity))


def _find_orders(subject: PageSubject, quantity: str) -> list[int]:
    """Rows of the first four orders of a force or moment that can be seen and matter; none where
    words stand in place of its picture.
    """
    if _find_words(subject, quantity):
        return []
    curve = subject.phasors(quantity)[0]
    least = NEGLIGIBLE * subject.now.of_one_cylinder[quantity]
    seen = [k for k in visible_rows(curve) if curve.major[k] > least and curve.orders[k] >= 1]
    return seen[:4]


def _lay_out_factor(fig: Figure, subject: PageSubject) -> None:
    moment = None if subject.is_unknown("moment") else subject.system.moment
    draw_factors(fig.subplots(), subject.study.factors, subject.system.force, moment)


def _lay_out_bank(fig: Figure, subject: PageSubject) -> None:
    banks, unit = subject.study.banks, subject.system.force
    if banks is None:
        raise ValueError("a page of bank angles needs a study of them")
    largest = float(banks.force.major.max(initial=0))
    if largest < NEGLIGIBLE * subject.now.of_one_cylinder["force"]:
        told = f"negligible ({size_text(largest, unit, 2)}), whatever the bank angle"
        fig.set_size_inches(6.4, 1.1)
        _write_words(fig.subplots(), f"Force of order {banks.order:g}", told)
        return
    grid = fig.add_gridspec(1, 2)
    draw_end_curves(fig.add_subplot(grid[0]), banks, unit)
    draw_roses(fig.add_subplot(grid[1], projection="polar"), banks, unit)


def _lay_out_inner(fig: Figure, subject: PageSubject) -> None:
    """Shear, bending and bearings along the crankshaft; with gas bending of both, and bearings."""
    bent, system = subject.study.bent, subject.system
    if gas := [inner.with_gas for inner in bent if inner.with_gas is not None]:
        over = "the cycle"
        pictures = (
            ("Bending moment in the crankshaft, with gas", "moment", [b.bending for b in gas]),
            ("Bending moment in the block, with gas", "moment", [b.block_bending for b in gas]),
            ("Load of each main bearing, with gas", "force", [b.bearings for b in gas]),
        )
        joints = "default", "default", ""
    else:
        over = "a revolution"
        loads = [b.bearings for b in bent if b.bearings]
        pictures = (
            ("Shear force along the crankshaft", "force", [b.shear for b in bent]),
            ("Bending moment", "moment", [b.bending for b in bent]),
            ("Inertia load of each main bearing", "force", loads),
        )
        joints = "steps-post", "default", ""
    axes = fig.subplots(3, 1, sharex=True)
    for ax, (title, what, curves), steps in zip(axes, pictures, joints, strict=True):
        draw_along(ax, curves, title, what, system, steps, over)
        ax.label_outer()
    axes[-1].set_xlabel(f"z, {system.length.name} (free end on the left)")


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


# ------------------------------------------------------------------ panels
def has_picture(subject: PageSubject, quantity: str) -> bool:
    """Whether a force or moment, or what is about the crank, is drawn; else words are written."""
    return not _find_words(subject, quantity)


def _find_words(subject: PageSubject, quantity: str) -> str:
    """What stands in place of a picture: of a moment that is not known, of what is nothing, and of
    what is negligible beside one cylinder's; else nothing.
    """
    if subject.is_unknown(quantity):
        return "not known:\ncrank.spacing is missing"
    largest = subject.find_largest(quantity)
    kind = ROLL.name if quantity in _ABOUT else quantity
    if not largest or largest < NEGLIGIBLE * subject.now.of_one_cylinder[kind]:
        return small_text(largest, subject.unit(kind))
    return ""


def _is_told(ax: Axes, subject: PageSubject, quantity: str) -> bool:
    """Whether words stand in place of a picture; they are written."""
    if words := _find_words(subject, quantity):
        _write_words(ax, subject.title(quantity), words)
    return bool(words)


def _write_words(ax: Axes, title: str, words: str) -> None:
    """In place of a picture."""
    ax.set_axis_off()
    ax.set_title(title, pad=6)
    ax.text(0, 1, words, ha="left", va="top", transform=ax.transAxes)


def _locus_panel(ax: Axes, subject: PageSubject, quantity: str) -> None:
    if _is_told(ax, subject, quantity):
        return
    curve, before = subject.phasors(quantity)
    draw_locus(ax, curve, quantity, subject.unit(quantity), before)
    ax.set_title(_TITLES[quantity], pad=6 if before is None else None)


def _bars_panel(ax: Axes, subject: PageSubject, quantity: str) -> None:
    quantity = subject.of_bars(quantity)
    if _is_told(ax, subject, quantity):
        return
    ax.set_title(subject.title(quantity))
    if quantity in _ABOUT:
        draw_scalar_bars(ax, subject.list_scalars(quantity), subject.system.moment)
        return
    curve, before = subject.phasors(quantity)
    draw_vector_bars(ax, curve, quantity, subject.unit(quantity), before)


def _curves_panel(ax: Axes, subject: PageSubject, quantity: str) -> None:
    if _is_told(ax, subject, quantity):
        return
    ax.set_title(subject.title(quantity))
    if quantity == ABOUT:
        roll_before = subject.phasors(ROLL.name)[1]
        scalars = subject.list_scalars(quantity)
        draw_scalar_curves(ax, scalars, subject.system.moment, roll_before)
        return
    curve, before = subject.phasors(quantity)
    draw_vector_curves(ax, curve, quantity, subject.unit(quantity), before)


Layout = Callable[["Figure", PageSubject], None]
PAGES: dict[str, tuple[float, float, Layout]] = {
    "all": (11.7, 8.3, _lay_out_all),
    "polar": (9.6, 5.6, _lay_out_polar),
    "orders": (11.7, 7.4, _lay_out_orders),
    "spectrum": (6.5, 8.0, _lay_out_spectrum),
    "curves": (7.5, 8.6, _lay_out_curves),
    "factor": (7.2, 4.6, _lay_out_factor),
    "bank": (9.6, 5.4, _lay_out_bank),
    "inner": (7.5, 7.6, _lay_out_inner),
    "pressure": (7.2, 4.4, _lay_out_gas),
    "p-v": (6.4, 4.8, _lay_out_p_v),
    "torque": (8.4, 4.8, _lay_out_gas),
    "pin": (9.6, 5.9, _lay_out_gas),
    "main": (9.6, 6.4, _lay_out_gas),
}
_PANELS: dict[str, Callable[[Axes, PageSubject, str], None]] = {
    "polar": _locus_panel,
    "spectrum": _bars_panel,
    "curves": _curves_panel,
}
