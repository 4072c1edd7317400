"""Which pictures there are, and how each page is laid out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...core.phasors import Phasors
from ...forces.crankshaft import InnerLoads
from ...forces.kinds import KINDS, VECTORS
from ...results.analysis import Analysis
from ...sizing.details import FactorPeaks
from ...studies.pictures import Banks
from ..sheet import NAMELESS
from ..units import SI, System, Unit
from . import draw, studied
from .style import Form, figure, inline, plain, saved

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_VECTORS = tuple(kind.name for kind in VECTORS)
_PICTURED = (*_VECTORS, "about")


@dataclass(frozen=True)
class Subject:
    """What a page shows: an analysis of all spectra, one of the engine before devices were fitted,
    to compare with, and studies.
    """

    now: Analysis
    before: Analysis | None = None
    system: System = SI
    factors: Sequence[FactorPeaks] = ()
    banks: Banks | None = None
    bent: tuple[InnerLoads, ...] = ()

    def phasors(self, quantity: str) -> tuple[Phasors, Phasors | None]:
        old = None if self.before is None else self.before.spectra[quantity]
        return self.now.spectra[quantity], old

    def unit(self, quantity: str) -> Unit:
        return self.system.unit(KINDS[quantity])

    @property
    def scalars(self) -> dict[str, Phasors]:
        return {kind.label: phasors for kind, phasors in self.now.spectra.scalars()}


def picture(subject: Subject, what: str, form: Form) -> bytes:
    """A page as a file's content. `what` is one of PAGES."""
    width, height, layout = PAGES[what]
    with figure(width, height, form) as fig:
        layout(fig, subject)
        engine = subject.now.engine
        fig.suptitle(
            f"{plain(engine.name) or NAMELESS}, {engine.speed_rpm:g} rpm",
            x=0.01,
            ha="left",
        )
        return saved(fig, form)


def panel(subject: Subject, what: str, quantity: str) -> str:
    """One picture of one quantity to stand in a page of ours."""
    with figure(*((4.2, 4.0) if what == "polar" else (5.2, 3.1)), "svg") as fig:
        fig.set_facecolor("none")
        _PANELS[what](fig, subject, quantity)
        return inline(saved(fig, "svg"), f"{what}-{quantity}{'-after' if subject.before else ''}")


# ------------------------------------------------------------------ layouts
def _all(fig: Figure, subject: Subject) -> None:
    grid = fig.add_gridspec(2, 3, height_ratios=(1.25, 1))
    bars = grid[0, 2].subgridspec(3, 1)
    for k, quantity in enumerate(_VECTORS):
        _locus(fig.add_subplot(grid[0, k]), subject, quantity)
    for k, quantity in enumerate(_PICTURED):
        _bars(fig.add_subplot(bars[k]), subject, quantity)
        _over_crank(fig.add_subplot(grid[1, k]), subject, quantity)


def _polar(fig: Figure, subject: Subject) -> None:
    for ax, quantity in zip(fig.subplots(1, 2), _VECTORS, strict=True):
        _locus(ax, subject, quantity)


def _spectrum(fig: Figure, subject: Subject) -> None:
    for ax, quantity in zip(fig.subplots(3, 1), _PICTURED, strict=True):
        _bars(ax, subject, quantity)


def _curves(fig: Figure, subject: Subject) -> None:
    for ax, quantity in zip(fig.subplots(3, 1, sharex=True), _PICTURED, strict=True):
        _over_crank(ax, subject, quantity)
        ax.label_outer()


def _orders(fig: Figure, subject: Subject) -> None:
    """The largest orders of force and of moment, a row each; a row without any is left out."""
    shown = {
        q: [k for k in draw.visible(curve) if not curve.balanced[k] and curve.orders[k] >= 1][:4]
        for q in _VECTORS
        for curve in subject.phasors(q)[:1]
    }
    rows = {q: found for q, found in shown.items() if found} or {"force": []}
    columns = max(2, *map(len, rows.values()))
    fig.set_size_inches(0.6 + 3.3 * columns, 0.4 + 3.5 * len(rows))
    grid = fig.subplots(len(rows), columns, squeeze=False)
    for ax in grid.flat:
        ax.set_axis_off()
    for row, (quantity, found) in zip(grid, rows.items(), strict=True):
        for ax, k in zip(row, found, strict=False):
            ax.set_axis_on()
            draw.ellipse(ax, subject.phasors(quantity)[0], k, quantity, subject.unit(quantity))
    if not any(rows.values()):
        grid[0, 0].text(0, 0.5, "no free force and no free moment")


def _factor(fig: Figure, subject: Subject) -> None:
    studied.factors(fig.subplots(), subject.factors, subject.system.force, subject.system.moment)


def _bank(fig: Figure, subject: Subject) -> None:
    if subject.banks is None:
        raise ValueError("a page of bank angles needs a study of them")
    grid = fig.add_gridspec(1, 2)
    studied.end_curves(fig.add_subplot(grid[0]), subject.banks, subject.system.force)
    studied.roses(fig.add_subplot(grid[1], projection="polar"), subject.banks, subject.system.force)


def _inner(fig: Figure, subject: Subject) -> None:
    shear, bending, bearings = fig.subplots(3, 1, sharex=True)
    studied.along(
        shear,
        [b.shear for b in subject.bent],
        ("Shear force along the crankshaft", "force"),
        subject.system.force,
        "steps-post",
    )
    studied.along(
        bending,
        [b.bending for b in subject.bent],
        ("Bending moment", "moment"),
        subject.system.moment,
    )
    studied.along(
        bearings,
        [b.bearings for b in subject.bent if b.bearings],
        ("Inertia load of each main bearing", "force"),
        subject.system.force,
        "",
    )
    bearings.set_xlabel("z, mm (free end on the left)")
    for ax in (shear, bending):
        ax.label_outer()


# ------------------------------------------------------------------ panels
def _locus(ax: Axes, subject: Subject, quantity: str) -> None:
    curve, before = subject.phasors(quantity)
    draw.locus(ax, curve, quantity, subject.unit(quantity), before)
    ax.set_title(f"Free {quantity}", pad=6 if before is None else None)


def _bars(ax: Axes, subject: Subject, quantity: str) -> None:
    if quantity == "about":
        draw.scalar_spectrum(ax, subject.scalars, subject.system.moment)
        ax.set_title("About the crank")
        return
    curve, before = subject.phasors(quantity)
    draw.vector_spectrum(ax, curve, quantity, subject.unit(quantity), before)
    ax.set_title(f"Free {quantity}")


def _over_crank(ax: Axes, subject: Subject, quantity: str) -> None:
    if quantity == "about":
        draw.scalar_curves(ax, subject.scalars, subject.system.moment, subject.phasors("roll")[1])
        ax.set_title("About the crank")
        return
    curve, before = subject.phasors(quantity)
    draw.vector_curves(ax, curve, quantity, subject.unit(quantity), before)
    ax.set_title(f"Free {quantity}")


Layout = Callable[["Figure", Subject], None]
PAGES: dict[str, tuple[float, float, Layout]] = {
    "all": (11.7, 8.3, _all),
    "polar": (9.6, 5.6, _polar),
    "orders": (11.7, 7.4, _orders),
    "spectrum": (6.5, 8.0, _spectrum),
    "curves": (7.5, 8.6, _curves),
    "factor": (7.2, 4.6, _factor),
    "bank": (9.6, 5.4, _bank),
    "inner": (7.5, 7.6, _inner),
}
_PANELS: dict[str, Callable[[Figure, Subject, str], None]] = {
    "polar": lambda fig, subject, quantity: _locus(fig.subplots(), subject, quantity),
    "spectrum": lambda fig, subject, quantity: _bars(fig.subplots(), subject, quantity),
    "curves": lambda fig, subject, quantity: _over_crank(fig.subplots(), subject, quantity),
}
