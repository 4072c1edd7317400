"""Draw the pages of pictures of an engine: the pictures on each page, and their layout.

A force or moment that is balanced, negligible or unknown has no picture; a line below the page
reports it.

The page `bank` shows the force of a vee over its bank angle: the path of the vector's tip,
and the two rotating vectors that make up the force.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from textwrap import wrap
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..analysis.answer import Analysis
from ..analysis.plot import (
    draw_along,
    draw_curves,
    draw_factors,
    draw_journals,
    draw_piston,
    draw_scalar_bars,
    draw_scalars,
    draw_vector_bars,
    set_order_axis,
    visible_rows,
)
from ..analysis.web_plot import draw_web
from ..balancing.scheme_show import percent
from ..core.peaks import find_largest
from ..core.phasors import Array, Complex, Phasors
from ..crank_torque.plot import draw_gas
from ..engine.engine import take_model
from ..forces.crankshaft import AlongCrank
from ..forces.kinds import (
    COUPLE,
    FORCE,
    FREE,
    GAS,
    KINDS,
    MOMENT,
    ROLL,
    ROLL_TOTAL,
    TORQUE,
    Kind,
)
from ..forces.stars import find_stars
from ..show.engine_facts import tell_pivot
from ..show.plane import (
    FINE,
    draw_locus,
    draw_order,
    draw_paths,
    draw_polygon,
    draw_star,
    draw_whole_path,
)
from ..show.plot_style import (
    BEFORE,
    BLUE,
    INK,
    Look,
    fit_name,
    open_figure,
    put_legend_above,
    put_title,
)
from ..show.sheet import NAMELESS, NEGLIGIBLE, NOTHING, order_name, size_text, small_text
from ..show.units import SI, ShownUnit, System
from .study import Banks, Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_LARGEST_RATIO = 10.0  # largest ratio of radii that is drawn
_JUMP = 0.5  # a larger change of a radius between neighbouring angles is a change of its sign
_MOST_STARS = 8
_IMPORTANT = 0.05  # least share of one cylinder's first order of a second quantity
_ALIKE = 5.0  # most by which its share is smaller than that of the first quantity
_WEBS_BESIDE = 3  # largest number of webs side by side
_STEPS_BESIDE = 3  # largest number of steps of a ladder side by side
_STEP_LETTERS = 28  # largest number of letters in a line of a step's title
_OWN_SCALES = "Each step has its own scale; its title tells the largest value. Dot: crank angle 0°."
_WEBS = "Seen from the free end (clockwise), with the cylinder of the nearest piston upwards."
_WEBS_ALONE = (
    "Seen from the free end (clockwise), with the crank pin upwards.\n"
    "The file does not tell where pistons are: give piston.bore and piston.skirt."
)
_STARS = (
    "Left: forces of the cylinders (numbers) at crank angle 0, without devices. Then: polygons of\n"
    "force and moment, with a colour for each bank. Dashed: the sum; a dot: the sum is 0."
)
_BANKS_DEG = (0, 30, 60, 90, 120, 150, 180)


def draw_end_curves(ax: Axes, banks: Banks, unit: ShownUnit) -> None:
    """Draw the path of the force's tip for several bank angles, and dotted for the engine's own."""
    s = unit.fit(float(banks.force.major.max(initial=0)))
    turn = np.exp(1j * FINE)

    def find_path(angle: float) -> Complex:
        row = int(np.argmin(np.abs(banks.angles_deg - angle)))
        ahead = banks.force.forward[0, row]
        against = banks.force.backward[0, row]
        return np.asarray((ahead * turn + against / turn) / s.size, complex)

    paths = {f"{angle}°": find_path(angle) for angle in _BANKS_DEG}
    draw_paths(ax, paths, FORCE.name_components(None), s.name)
    if banks.own_deg <= 180:
        own = find_path(banks.own_deg)
        look: Look = {"color": INK, "linestyle": ":", "linewidth": 1.6}
        ax.plot(own.imag, own.real, label=_name_own(banks), **look)
    ax.set_title(f"Force of order {banks.order:g}: path of its tip by bank angle")
    put_legend_above(ax, len(_BANKS_DEG) + 1)


def _name_own(banks: Banks) -> str:
    return f"this engine, {banks.own_deg:.4g}°"


def draw_radii(ax: Axes, banks: Banks) -> None:
    """Draw the radii of two shafts that cancel the force without a roll moment, and their ratio,
    over the bank angle, as figure 4 of Liu's paper (docs/theory.md).
    """
    with_crank, against, ratio = banks.find_radii()
    angles = banks.angles_deg
    with_crank[1:][np.abs(np.diff(with_crank)) > _JUMP] = np.nan
    ax.plot(angles, with_crank, color=BLUE, label="with the crank")
    ax.plot(angles, against, color=BLUE, linestyle=(0, (5, 1.5)), label="against it")
    ratio[np.abs(ratio) >= _LARGEST_RATIO] = np.nan
    ax.plot(angles, ratio, color=BEFORE, linestyle=(0, (3, 1, 1, 1)), label="ratio")
    ax.axhline(0, color=INK, linewidth=0.7)
    ax.set(
        xlim=(0, 180),
        xticks=_BANKS_DEG,
        xlabel=f"bank angle, deg (dotted: {_name_own(banks)})",
        ylabel="radius / longest radius; ratio",
    )
    if banks.own_deg <= 180:
        ax.axvline(banks.own_deg, color=INK, linewidth=0.9, linestyle=":")
    ax.set_title(f"Shafts at +{banks.order:g} and -{banks.order:g}: radii without a roll moment")
    put_legend_above(ax, 3)


def _set_up_compass(ax: Any, banks: Banks) -> Array:
    """Make polar axes start at the top and run clockwise; return the directions of both banks for
    every bank angle, rad, shape (2 * angles,).
    """
    ax.set_theta_zero_location("N")
    ax.set_theta_direction(-1)
    half = np.radians(banks.angles_deg) / 2
    return np.concatenate([-half[::-1], half])


def _mirrored(values: Array) -> Array:
    """Return the values of both banks from those over the bank angle, shape (2 * angles,)."""
    return np.concatenate([values[::-1], values])


def draw_radius_roses(ax: Any, banks: Banks) -> None:
    """Draw the curves of `draw_radii` in polar coordinates, in the directions of both banks. For a
    flat-plane V8 (Liu, figure 8), the backward radius is a circle, the forward radius a rose of
    three leaves, and the ratio a rose of four leaves. The curve of the ratio continues over a whole
    turn; beyond a bank angle of 180 deg its line is thin.
    """
    sides = _set_up_compass(ax, banks)
    with_crank, against, ratio = (np.abs(_mirrored(radii)) for radii in banks.find_radii())
    ratio[ratio >= _LARGEST_RATIO] = np.nan
    ax.plot(sides, ratio, color=BEFORE, linewidth=2.4)
    ax.plot(np.pi + sides, ratio, color=BEFORE, linewidth=1.0)
    ax.plot(sides, with_crank, color=BLUE)
    ax.plot(sides, against, color=BLUE, linestyle="--")
    marks = np.arange(0, 360, 30)
    angles = np.where(marks > 180, 720 - 2 * marks, 2 * marks)
    ax.set_thetagrids(marks, [f"{angle}°" if angle <= 180 else "" for angle in angles])
    ax.set_title("Radii and ratio in the directions of the banks", pad=6)


def draw_roses(ax: Any, banks: Banks, unit: ShownUnit) -> None:
    """Draw the magnitudes of both rotating vectors over the bank angle in polar coordinates: the
    radius is the magnitude, and the directions are those of the two banks.
    """
    ahead = np.abs(banks.force.forward[0])
    against = np.abs(banks.force.backward[0])
    largest = float(max(ahead.max(), against.max()))
    s = unit.fit(largest)
    sides = _set_up_compass(ax, banks)
    dashed = (0, (5, 1.5))
    ax.plot(sides, _mirrored(ahead) / s.size, color=BLUE, label="with the crank")
    ax.plot(sides, _mirrored(against) / s.size, color=BLUE, linestyle=dashed, label="against it")
    if banks.own_deg <= 180:
        for side in (-0.5, 0.5):
            ax.axvline(np.radians(side * banks.own_deg), color=INK, linewidth=0.9, linestyle=":")
    marks = np.arange(-90, 91, 30)
    ax.set_thetagrids(marks, [f"{abs(2 * mark):g}°" for mark in marks])
    ax.set(thetamin=-90, thetamax=90, rmax=1.08 * largest / s.size or 1)
    title = f"Rotating vectors by bank angle, {s.name}\n(dotted: {_name_own(banks)})"
    ax.set_title(title, pad=6)
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 0.02), ncols=2)


_VECTORS = tuple(kind.name for kind in FREE)
ABOUT = "about"  # one picture of couple, torque and roll
PICTURED = (*_VECTORS, ABOUT)
_TITLES = {"force": "Free force", "moment": "Free moment", ABOUT: "About the crank"}


@dataclass(frozen=True)
class PageSubject:
    """Engine of a page, units in which it is drawn, and the cylinder of the page `piston`."""

    study: Study
    system: System = SI
    cylinder: int = 1

    @property
    def now(self) -> Analysis:
        """Analysis of the engine, with the devices of the scheme if a scheme is given."""
        return self.study.now

    def phasors(self, quantity: str) -> tuple[Phasors, Phasors | None]:
        """Return the phasors of a force, a moment or the roll now, and those before devices were
        fitted (None without a scheme). Forces and moments are along the axes of the picture.
        """
        name = quantity
        turn = -(self.now.engine.up_deg or 0.0)
        if quantity == ABOUT:
            name = ROLL.name
            turn = 0.0
        now = self.now.spectra[name].turn(turn)
        before = self.study.before
        return now, None if before is None else before.spectra[name].turn(turn)

    def name_components(self, quantity: str) -> tuple[str, str]:
        """Return the names of the upward and rightward components of a force or moment."""
        return KINDS[quantity].name_components(self.now.engine.up_deg)

    def unit(self, quantity: str) -> ShownUnit:
        """Return the unit in which a quantity is drawn."""
        return self.system.moment if quantity == ABOUT else self.system.unit(KINDS[quantity])

    def list_scalars(self, *, with_gas: bool) -> dict[Kind, Phasors]:
        """Return the moments about the crank by kind, the roll last."""
        gas_counts = with_gas and self.now.spectra.gas is not None
        kinds = (TORQUE, GAS, ROLL_TOTAL) if gas_counts else (COUPLE, TORQUE, ROLL)
        return {kind: self.now.spectra[kind.name] for kind in kinds}

    def find_words(self, quantity: str) -> str:
        """Return a text for a quantity without a picture (unknown, balanced or negligible); empty
        if there is a picture.
        """
        if quantity == "moment" and not self.now.moments_known:
            return "not known: crank.spacing is missing"
        curves: Iterable[Phasors | None] = self.phasors(quantity)
        kind = quantity
        if quantity == ABOUT:
            curves = self.list_scalars(with_gas=True).values()
            kind = ROLL.name
        largest = 0.0
        for curve in curves:
            if curve is not None:
                values = curve.values(_divide_cycle(curve))
                largest = max(largest, float(np.abs(values).max(initial=0)))
        if not largest or largest < NEGLIGIBLE * self.now.of_one_cylinder[kind]:
            return small_text(largest, self.unit(quantity))
        return ""

    def choose_important(self) -> list[str]:
        """Return force, moment or both: the one whose largest value is the larger share of one
        cylinder's first order, and the other one if its share is at least 5 % and not less than a
        fifth of that of the first. Before balancing, if the page compares.
        """
        drawn = self.study.before or self.now
        shares = {}
        for quantity in _VECTORS:
            if quantity == MOMENT.name and not drawn.moments_known:
                continue
            scale = drawn.of_one_cylinder[quantity]
            peak = float(find_largest(drawn.spectra[quantity]))
            shares[quantity] = peak / scale if scale else 0.0
        ordered = sorted(shares, key=lambda quantity: -round(shares[quantity], 9))
        first, *others = ordered
        least = max(_IMPORTANT, shares[first] / _ALIKE)
        return [first, *(quantity for quantity in others if shares[quantity] >= least)]

    def find_pictured(self, quantities: Sequence[str]) -> tuple[list[str], str]:
        """Return the quantities with a picture, and a line of text on the others."""
        pictured = []
        others = []
        for quantity in quantities:
            words = self.find_words(quantity)
            if words:
                others.append(f"{_TITLES[quantity]}: {words}")
            else:
                pictured.append(quantity)
        return pictured, "; ".join(others)

    def title(self, what: str, quantity: str) -> str:
        """Return the title of a picture of a quantity."""
        title = _TITLES[quantity]
        if quantity == ABOUT and self.now.engine.gas is not None:
            title += ", with gas" if what == "spectrum" else ", of inertia only"
        return title.replace("the crank", tell_pivot(self.now.engine).removesuffix(" axis"))


def _divide_cycle(*curves: Phasors | None) -> Array:
    """Return the crank angles of a curve, rad, in steps of a degree: to 360 degrees, or to 720 with
    half orders.
    """
    halves = any(np.any(c.orders[~c.balanced] % 1) for c in curves if c is not None)
    cycle = 720 if halves else 360
    return np.radians(np.arange(cycle + 1))


def make_page(subject: PageSubject, what: str, *, titled: bool = True) -> Figure:
    """Return a page of pictures.

    Args:
        subject: Engine, units and cylinder.
        what: One of `PAGES` except those of torsion.
        titled: Whether the page has the name of the engine as its title.
    """
    width, height, lay_out = _LAYOUTS[what]
    engine = subject.now.engine
    remedy = subject.study.remedy
    title = f"{fit_name(engine.name) or NAMELESS}, {engine.speed_rpm:g} rpm"
    if remedy is not None:
        title += f"\nwith scheme {remedy.scheme}"
        if remedy.card:
            title += f" {percent(remedy.card[0].factor)}"
        if remedy.order is not None:
            title += f", order {remedy.order}"
    with open_figure(width, height) as fig:
        fig.set_layout_engine("constrained", h_pad=0.1)
        if words := lay_out(fig, subject):
            fig.supxlabel(words, x=0.01, ha="left", fontsize=9)
        if not fig.axes:
            fig.set_size_inches(6.4, 0.7)
        if titled:
            put_title(fig, title)
        return fig


# ------------------------------------------------------------------ forces and moments
def _draw(ax: Axes, subject: PageSubject, what: str, quantity: str) -> None:
    """Draw one picture of a force or moment, or of the moments about the crank."""
    unit = subject.unit(quantity)
    curve, before = subject.phasors(quantity)
    ax.set_title(subject.title(what, quantity))
    if what == "polar":
        draw_locus(ax, curve, subject.name_components(quantity), unit, before)
    elif what == "spectrum" and quantity == ABOUT:
        draw_scalar_bars(ax, subject.list_scalars(with_gas=True), unit)
    elif what == "spectrum":
        draw_vector_bars(ax, curve, quantity, unit, before)
    elif quantity == ABOUT:
        _draw_scalars(ax, subject, curve, before)
    else:
        crank = _divide_cycle(curve, before)
        values = curve.values(crank)
        up, across = subject.name_components(quantity)
        lines = {up: values.real, across: values.imag, "magnitude": np.abs(values)}
        old = {}
        if before is not None:
            old["magnitude before"] = np.abs(before.values(crank))
        draw_curves(ax, crank, lines, quantity, unit, old)


def _draw_scalars(ax: Axes, subject: PageSubject, roll: Phasors, before: Phasors | None) -> None:
    """Draw the moments about the crank, of inertia only, over the crank angle.

    Args:
        ax: Axes to draw on.
        subject: Engine and units.
        roll: Roll of the frame.
        before: Roll before devices were fitted; None: not drawn.
    """
    scalars = subject.list_scalars(with_gas=False)
    crank = _divide_cycle(*scalars.values(), roll, before)
    old = {}
    if before is not None:
        old[f"{ROLL.name} before"] = np.real(before.values(crank))
    draw_scalars(ax, crank, scalars, subject.unit(ABOUT), old)


class _DrawnOrder(NamedTuple):
    """An order to draw: quantity, its phasors, and the row of the order."""

    quantity: str
    curve: Phasors
    row: int


def _lay_out_overview(fig: Figure, subject: PageSubject) -> str:
    """Draw the locus of force or moment, the more important one, or of both if they are alike; and
    the spectra.
    """
    shown, words = subject.find_pictured(PICTURED)
    important = subject.choose_important()
    loci = [quantity for quantity in important if quantity in shown]
    bars = sorted(shown, key=(*important, *PICTURED).index)
    fig.set_size_inches(5.2 + 5.6 * len(loci), max(3.4, 2.2 * len(shown) + 0.4, 6.0 * bool(loci)))
    grid = fig.add_gridspec(len(shown) or 1, 1 + len(loci))
    for column, quantity in enumerate(loci):
        _draw(fig.add_subplot(grid[:, column]), subject, "polar", quantity)
    spectra = [fig.add_subplot(grid[row, -1]) for row in range(len(bars))]
    for ax, quantity in zip(spectra, bars, strict=True):
        _draw(ax, subject, "spectrum", quantity)
    _align_orders(spectra, subject, bars)
    return words


def _align_orders(spectra: Sequence[Axes], subject: PageSubject, bars: Sequence[str]) -> None:
    """Give the bars of several quantities one axis of orders."""
    orders = []
    for quantity in bars:
        curves: Iterable[Phasors | None] = subject.phasors(quantity)
        if quantity == ABOUT:
            curves = subject.list_scalars(with_gas=True).values()
        for curve in curves:
            if curve is not None:
                orders.append(curve.orders[visible_rows(curve)])
    if orders:
        set_order_axis(spectra, np.concatenate(orders))


def _lay_out_rows(fig: Figure, subject: PageSubject, *, whats: Sequence[str], height: float) -> str:
    """Draw a row of pictures for each quantity; moments about the crank have no locus."""
    shown, words = subject.find_pictured(PICTURED)
    fig.set_figheight(0.5 + height * len(shown))
    grid = fig.add_gridspec(len(shown) or 1, 6)
    spectra = []
    for row, quantity in enumerate(shown):
        pictures = [what for what in whats if what != "polar" or quantity != ABOUT]
        span = 6 // len(pictures)
        for k, what in enumerate(pictures):
            ax = fig.add_subplot(grid[row, k * span : (k + 1) * span])
            _draw(ax, subject, what, quantity)
            if what == "spectrum":
                spectra.append(ax)
    if spectra:
        _align_orders(spectra, subject, shown)
    return words


def _lay_out_loci(fig: Figure, subject: PageSubject, *, what: str, height: float) -> str:
    shown, words = subject.find_pictured(_VECTORS)
    fig.set_size_inches(max(4.8 * len(shown), 5.2), height)
    for k, quantity in enumerate(shown, 1):
        _draw(fig.add_subplot(1, len(shown), k), subject, what, quantity)
    return words


def _lay_out_ladder(fig: Figure, subject: PageSubject) -> str:
    """Draw the locus with the devices of each step of the ladder, each in its own scale."""
    pictured, words = subject.find_pictured(_VECTORS)
    shown = sorted(pictured, key=(*subject.choose_important(), *_VECTORS).index)
    steps = subject.study.steps
    columns = min(len(steps), _STEPS_BESIDE)
    rows = -(-len(steps) // columns)
    if not shown:
        return words
    fig.set_size_inches(max(3.3 * columns, 6.6), 0.9 + 3.5 * rows * len(shown))
    fig.set_layout_engine("constrained", h_pad=0.2)
    grid = fig.add_gridspec(rows * len(shown), columns)
    for above, quantity in enumerate(shown):
        for k, (name, step) in enumerate(steps.items()):
            ax = fig.add_subplot(grid[above * rows + k // columns, k % columns])
            _draw_step(ax, subject, quantity, name, step)
    return f"{_OWN_SCALES}\n{words}".strip()


def _draw_step(ax: Axes, subject: PageSubject, quantity: str, name: str, step: Analysis) -> None:
    """Draw the locus of a step of the ladder, gray without devices."""
    unit = subject.unit(quantity)
    curve = step.spectra[quantity].turn(-(subject.now.engine.up_deg or 0.0))
    largest = float(find_largest(curve))
    size = size_text(largest, unit, 4) if largest else NOTHING
    colour = BLUE if step.engine.devices != subject.now.engine.devices else BEFORE
    draw_whole_path(ax, curve, subject.name_components(quantity), unit, colour)
    title = "\n".join(wrap(name, _STEP_LETTERS))
    ax.set_title(f"{title}\n{quantity} {size}", pad=6)


def _lay_out_orders(fig: Figure, subject: PageSubject) -> str:
    """Draw the first four visible orders of force and of moment."""
    shown, words = subject.find_pictured(_VECTORS)
    drawn = []
    for quantity in shown:
        curve = subject.phasors(quantity)[0]
        least = NEGLIGIBLE * subject.now.of_one_cylinder[quantity]
        rows = [k for k in visible_rows(curve) if curve.major[k] > least and curve.orders[k] >= 1]
        drawn += [_DrawnOrder(quantity, curve, k) for k in rows[:4]]
    height = 1 if len(drawn) <= 3 else 2
    columns = -(-len(drawn) // height)
    fig.set_size_inches(max(1.0 + 3.3 * columns, 4.3), 0.4 + 3.5 * height)
    for place, (quantity, curve, row) in enumerate(drawn, 1):
        ax = fig.add_subplot(height, columns, place)
        names = subject.name_components(quantity)
        draw_order(ax, curve, row, quantity, names, subject.unit(quantity))
    return words


# ------------------------------------------------------------------ other pages
def _lay_out_factor(fig: Figure, subject: PageSubject) -> None:
    moment = subject.system.moment if subject.now.moments_known else None
    draw_factors(fig.subplots(), subject.study.factors, subject.system.force, moment)


def _lay_out_bank(fig: Figure, subject: PageSubject) -> str:
    banks = subject.study.banks
    unit = subject.system.force
    assert banks is not None
    largest = float(banks.force.major.max(initial=0))
    if largest < NEGLIGIBLE * subject.now.of_one_cylinder["force"]:
        size = size_text(largest, unit, 2)
        return f"Force of order {banks.order:g}: negligible ({size}), whatever the bank angle"
    if subject.study.pair:
        draw_radii(fig.add_subplot(1, 2, 1), banks)
        draw_radius_roses(fig.add_subplot(1, 2, 2, projection="polar"), banks)
        return ""
    draw_end_curves(fig.add_subplot(1, 2, 1), banks, unit)
    draw_roses(fig.add_subplot(1, 2, 2, projection="polar"), banks, unit)
    return ""


def _lay_out_inner(fig: Figure, subject: PageSubject) -> str:
    """Draw shear, bending and bearing loads along the crankshaft; with gas, bending of crankshaft
    and block, and bearing loads.
    """
    bent = subject.study.bent
    system = subject.system
    gas = [inner.with_gas for inner in bent if inner.with_gas is not None]
    # Title, curves, and how their points are joined.
    pictures: list[tuple[str, Sequence[AlongCrank], str]]
    if gas:
        bending = [inner.bending for inner in gas]
        of_block = [inner.block_bending for inner in gas]
        bearings = [inner.bearings for inner in gas]
        pictures = [
            ("Bending moment in the crankshaft, with gas", bending, "default"),
            ("Bending moment in the block, with gas", of_block, "default"),
            ("Load of each main bearing, with gas", bearings, ""),
        ]
    else:
        shear = [inner.shear for inner in bent]
        bending = [inner.bending for inner in bent]
        bearings = [inner.bearings for inner in bent if inner.bearings]
        pictures = [
            ("Shear force along the crankshaft", shear, "steps-post"),
            ("Bending moment", bending, "default"),
            ("Inertia load of each main bearing", bearings, ""),
        ]
    shown = [picture for picture in pictures if picture[1]]
    fig.set_figheight(0.4 + 2.4 * len(shown))
    axes = fig.subplots(len(shown), 1, sharex=True)
    for ax, (title, curves, steps) in zip(axes, shown, strict=True):
        what = "moment" if "moment" in title else "force"
        draw_along(ax, curves, what, system, steps, "the cycle" if gas else "a revolution")
        ax.set_title(title)
        ax.label_outer()
    axes[-1].set_xlabel(f"z, {system.length.name} (free end on the left)")
    missing = (title for title, curves, _ in pictures if not curves)
    return "".join(f"{title}: not known for a single throw" for title in missing)


def _lay_out_gas(fig: Figure, subject: PageSubject, *, what: str) -> None:
    draw_gas(fig, subject.now.engine, what, subject.system)


def _lay_out_stars(fig: Figure, subject: PageSubject) -> str:
    """Draw star and polygons of the first orders."""
    engine = subject.now.engine
    kinds = ("force", "moment") if subject.now.moments_known else ("force",)
    every = list(find_stars(engine, subject.now.orders, kinds))
    if not every:
        return "No cylinder has a force of these orders."
    stars = every[:_MOST_STARS]
    rays = [ray for star in stars for bank in star.banks for ray in bank.cylinders]
    with_moment = any(ray.moment for ray in rays)
    quantities = ("force", "moment") if with_moment else ("force",)
    fig.set_size_inches(2.9 * (1 + len(quantities)), 0.6 + 2.5 * len(stars))
    axes = fig.subplots(len(stars), 1 + len(quantities), squeeze=False)
    turn = -(engine.up_deg or 0.0)
    for star, (first, *others) in zip(stars, axes, strict=True):
        draw_star(first, star, turn)
        for ax, quantity in zip(others, quantities, strict=True):
            draw_polygon(ax, star, quantity, turn, subject.unit(quantity))
    if len(every) == len(stars):
        return _STARS
    left_out = dict.fromkeys(order_name(star.order) for star in every[_MOST_STARS:])
    return f"{_STARS}\nNot drawn: orders {', '.join(left_out)}."


def _lay_out_piston(fig: Figure, subject: PageSubject) -> None:
    draw_piston(fig, subject.now.engine, subject.cylinder, subject.system)


def _lay_out_journals(fig: Figure, subject: PageSubject) -> None:
    draw_journals(fig, subject.now.engine, subject.system.moment)


def _lay_out_webs(fig: Figure, subject: PageSubject) -> str:
    """Draw each kind of web that has an outline."""
    engine = subject.now.engine
    assert engine.webs is not None
    kinds = engine.webs.kinds
    drawn = [webs for webs in kinds.values() if webs[0].body.shape is not None]
    if drawn:
        columns = min(len(drawn), _WEBS_BESIDE)
        rows = -(-len(drawn) // columns)
        fig.set_size_inches(max(4.6 * columns, 6.0), 0.8 + 6.6 * rows)
        for place, webs in enumerate(drawn, 1):
            draw_web(fig.add_subplot(rows, columns, place), engine, webs, subject.system)
    weighed = [f"web.{table}" for table, webs in kinds.items() if webs[0].body.shape is None]
    words = []
    if drawn:
        piston = take_model(engine).piston
        words.append(_WEBS if piston.skirt is not None and piston.bore else _WEBS_ALONE)
    if weighed:
        words.append(f"Not drawn: {', '.join(weighed)}, which the file gives by mass.")
    return "\n".join(words)


# Width and height in inches (some layouts change them), and the drawing function.
_LAYOUTS: dict[str, tuple[float, float, Callable[[Figure, PageSubject], str | None]]] = {
    "overview": (10.8, 6.4, _lay_out_overview),
    "all": (11.7, 8, partial(_lay_out_rows, whats=("polar", "spectrum", "curves"), height=3.6)),
    "polar": (9.6, 5.6, partial(_lay_out_loci, what="polar", height=5.6)),
    "ladder": (9.9, 7.9, _lay_out_ladder),
    "orders": (11.7, 7.4, _lay_out_orders),
    "spectrum": (6.5, 8.0, partial(_lay_out_rows, whats=("spectrum",), height=2.5)),
    "curves": (7.5, 8.6, partial(_lay_out_rows, whats=("curves",), height=2.7)),
    "stars": (8.7, 11.3, _lay_out_stars),
    "factor": (7.2, 4.6, _lay_out_factor),
    "bank": (9.6, 5.4, _lay_out_bank),
    "inner": (7.5, 7.6, _lay_out_inner),
    "piston": (7.2, 7.8, _lay_out_piston),
    "journals": (8.4, 4.8, _lay_out_journals),
    "webs": (6.0, 7.4, _lay_out_webs),
    "pressure": (7.2, 4.4, partial(_lay_out_gas, what="pressure")),
    "p-v": (6.4, 4.8, partial(_lay_out_gas, what="p-v")),
    "torque": (8.4, 4.8, partial(_lay_out_gas, what="torque")),
    "pin": (9.6, 5.9, partial(_lay_out_gas, what="pin")),
    "main": (9.6, 6.4, partial(_lay_out_gas, what="main")),
}
