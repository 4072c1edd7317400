"""Engine -> Analysis: free forces and moments by order, peaks and sizing, computing only what was
asked.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..core.mechanisms import harmonics
from ..core.peaks import Peak, peak
from ..core.phasors import Array
from ..engine.build import Engine
from ..errors import BalcliError
from ..forces.kinds import KINDS, SCALARS, VECTORS, Kind
from ..forces.spectrum import (
    Spectra,
    considerable,
    each,
    relevant_orders,
    spectra,
)
from ..limits import HIGHEST_ORDER, HIGHEST_ORDER_UNASKED, MOST_RESULTS_BY_CYLINDER
from ..sizing.auto import size_auto
from ..sizing.remedy import Remedy, fit_devices

if TYPE_CHECKING:
    from ..core.strokes import Travel
    from ..forces.crankshaft import Inner
    from ..forces.guide_moments import Guide
    from ..forces.symmetry import Why

QUANTITIES = (*KINDS, "peak", "sizing")
EXTRAS = ("inner", "guide")  # computed only when they are named


class Sizing(NamedTuple):
    """The devices that a scheme fits, and what is left with them."""

    remedy: Remedy
    after: Analysis


@dataclass(frozen=True, eq=False)
class Analysis:
    """What an engine does to its frame. Whatever was not asked for is None.

    Attributes:
        engine: as analysed.
        spectra: phasors of the orders shown. force, moment: largest value over a revolution (N, N
        m), of all orders, and its crank angle (rad).
        sizing: devices of the scheme `auto`, and the analysis with them.
        cylinders: phasors of each cylinder alone (no devices), by cylinder number.
        why: whether the orders shown are balanced by symmetry.
        inner: shear force and bending moment along the crankshaft.
        guide: H- and X-type guide-force moments.
        travel: strokes and dead centres of articulated cylinders and of the masters, by rows of
        `engine.numbers`.
    """

    engine: Engine
    spectra: Spectra
    force: Peak | None = None
    moment: Peak | None = None
    sizing: Sizing | None = None
    cylinders: tuple[tuple[int, Spectra], ...] = ()
    why: Why | None = None
    inner: Inner | None = None
    guide: Guide | None = None
    travel: Travel | None = None

    @property
    def orders(self) -> Array:
        return self.spectra.orders

    @property
    def peaks(self) -> list[tuple[Kind, Peak]]:
        """Each kind whose peak was asked for, with its peak."""
        found = [(kind, getattr(self, kind.name)) for kind in VECTORS]
        return [(kind, peak) for kind, peak in found if peak is not None]

    @property
    def beyond(self) -> bool:
        """Whether there may be orders above those that are shown unless they are asked for."""
        return bool(relevant_orders(self.engine)[-1] > HIGHEST_ORDER_UNASKED)

    @property
    def of_one_cylinder(self) -> dict[str, float]:
        """Force of cylinder 1's piston and rod end, `m r omega^2` (N), and its moment over the
        length of the crank (N m): what is small beside them is small.
        """
        engine = self.engine
        masses = engine.weighed[engine.numbers.index(1)]
        force = float(
            (masses.piston + masses.small_end) * engine.cylinders.radius * engine.omega**2
        )
        return {"force": force, "moment": force * float(np.ptp(engine.throws_m))}


def analyze(
    engine: Engine,
    orders: Iterable[float] | None = None,
    only: Collection[str] | None = None,
    by_cylinder: bool = False,
    reasons: bool = False,
) -> Analysis:
    """Free forces and moments of an engine, order by order.

    Args:
        engine: without trailing axes.
        orders: which orders to show; default: 1 and 2 (0 too under uneven speed) and all in which a
        quantity that was asked
            for exceeds 1e-6 of its own largest order, up to 512.
        only: any of QUANTITIES and EXTRAS; default: all QUANTITIES.
        by_cylinder: also the phasors of every cylinder alone.
        reasons: also why each order is balanced, or is not.

    Raises:
        BalcliError: an unknown quantity, an order that is negative or above HIGHEST_ORDER, too many
        orders of too many cylinders.
    """
    wanted = set(QUANTITIES if only is None else only)
    if strangers := sorted(wanted.difference(QUANTITIES, EXTRAS)):
        raise BalcliError(
            f"there is no quantity {', '.join(strangers)}: choose from "
            f"{', '.join((*QUANTITIES, *EXTRAS))}"
        )
    asked = None if orders is None else checked_orders(orders)
    curves = {kind.name for kind in VECTORS} if "peak" in wanted else set()
    shown = wanted.intersection(KINDS)
    due = np.array([1.0, 2.0]) if asked is None else asked
    whole = due
    if (
        asked is None or curves
    ):  # a set: np.union1d imports masked arrays, which takes longer than all the rest
        whole = np.array(sorted({*relevant_orders(engine).tolist(), *due.tolist()}))
    everything = spectra(engine, whole, shown | curves)
    visible = everything.only(shown)
    visible = visible.at(shown_orders(visible) if asked is None else asked)
    apart = len(visible.orders) * len(engine.numbers)
    if by_cylinder and apart > MOST_RESULTS_BY_CYLINDER:
        raise BalcliError(
            f"by cylinder, {len(visible.orders)} orders of {len(engine.numbers)} cylinders are "
            f"{apart} results, and at most "
            f"{MOST_RESULTS_BY_CYLINDER} are told: ask for fewer orders"
        )
    peaks = {q: peak(everything[q]) for q in curves}
    return Analysis(
        engine,
        visible,
        peaks.get("force"),
        peaks.get("moment"),
        sizing=_sized(engine, asked, wanted) if "sizing" in wanted else None,
        cylinders=_by_cylinder(engine, visible.orders, shown) if by_cylinder else (),
        why=_explained(engine, visible.orders, shown) if reasons else None,
        **_extras(engine, asked, wanted),
    )


def _by_cylinder(
    engine: Engine, orders: Array, quantities: Collection[str]
) -> tuple[tuple[int, Spectra], ...]:
    own = each(engine, orders, quantities)
    return tuple((n, own.of(engine.numbers.index(n))) for n in sorted(engine.numbers))


class Textbook(NamedTuple):
    """Units of textbooks: `F1 = m_rec r omega^2` of cylinder 1 (N), throw spacing a (m, nan for one
    throw), and A_n.
    """

    force: float
    arm: float
    ratios: Array
    equal: bool


def textbook(engine: Engine, orders: Array) -> Textbook:
    """What forces and moments are multiples of, with `F_n = A_n F1` for each order."""
    c, row = engine.cylinders, engine.numbers.index(1)

    def own(values: Array) -> Array:
        return values[row : row + 1] if len(values) > 1 else values

    lam, eps = own(c.lam), own(c.eps)
    series = harmonics.find_harmonics(orders, lam, eps, rod=False, energy=False).piston
    throws = engine.throws_m
    return Textbook(
        float(own(c.reciprocating)[0] * c.radius * engine.omega**2),
        float(np.ptp(throws) / (len(throws) - 1)) if len(throws) > 1 else float("nan"),
        np.abs(series.c[:, 0]),
        engine.equal,
    )


def _extras(engine: Engine, asked: Array | None, wanted: Collection[str]) -> dict[str, Any]:
    """What is computed only where it is asked for, or where the engine has it."""
    found: dict[str, Any] = {}
    if "inner" in wanted:
        from ..forces.crankshaft import inner

        found["inner"] = inner(engine, asked)
    if "guide" in wanted:
        from ..forces.guide_moments import guide

        found["guide"] = guide(engine, asked)
    if engine.cylinders.linkage is not None:
        from ..core.strokes import travel

        found["travel"] = travel(engine.cylinders)
    return found


def _explained(engine: Engine, orders: Array, quantities: Collection[str]) -> Why:
    from ..forces.symmetry import QUANTITIES, why

    turning = any(kind.name in quantities for kind in SCALARS)
    return why(
        engine,
        orders[orders > 0],
        [q for q in QUANTITIES if q in quantities or (q == "turning" and turning)],
    )


def _sized(engine: Engine, asked: Array | None, wanted: Collection[str]) -> Sizing:
    remedy = size_auto(engine)
    return Sizing(
        remedy,
        analyze(
            fit_devices(engine, remedy), asked, {*wanted, "force", "moment", "peak"} - {"sizing"}
        ),
    )


def checked_orders(orders: Iterable[float]) -> Array:
    """Orders that were asked for, ascending; BalcliError unless they are whole numbers up to
    HIGHEST_ORDER.
    """
    asked = np.array(sorted(set(orders)), float)
    if not len(asked) or asked[0] < 0 or asked[-1] > HIGHEST_ORDER or (asked % 1).any():
        raise BalcliError(
            f"orders must be whole numbers from 0 to {HIGHEST_ORDER}, not "
            f"{', '.join(f'{n:g}' for n in asked[:8]) or 'none'}"
        )
    return asked


def shown_orders(found: Spectra) -> Array:
    """Orders to 2, and those up to HIGHEST_ORDER_UNASKED in which a quantity exceeds SHOWN of its
    own largest order.
    """
    due = found.orders <= 2
    for _, phasors in found.items():
        due |= considerable(phasors)
    return found.orders[due]
