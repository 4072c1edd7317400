"""An analysis in brief: the orders that matter, roll, peaks, and the devices in one line.

Plain words on each order: which part turns with the crank and can be met by a counterweight,
which part needs shafts.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.phasors import Phasors, wrap_degrees
from ..file.fields import join_words
from ..file.messages import ordinal
from ..forces.kinds import MOMENT, ROLL, ROLL_TOTAL, Kind
from ..forces.spectrum import Spectra
from ..limits import SMALL
from ..show.engine_facts import tell_pivot
from ..show.sheet import (
    NEGLIGIBLE,
    Facts,
    Grid,
    degrees,
    number,
    order_name,
    sentence,
    size_text,
    small_text,
)
from ..show.units import ShownUnit, System
from ..sizing.residual import Scales, is_small
from .order_tables import fit_largest, peak_facts, vector_cells

if TYPE_CHECKING:
    from .answer import Analysis


def find_orders_that_matter(spectra: Spectra, single: dict[str, float]) -> list[float]:
    """Return orders to 2, and those with a force or moment that is not small against one
    cylinder's.

    Args:
        spectra: Spectra to show.
        single: Size of each kind for one cylinder; kinds not in it are never small.
    """
    return [
        float(order)
        for k, order in enumerate(spectra.orders)
        if order in (0, 1, 2)
        or any(p.major[k] > NEGLIGIBLE * single.get(kind.name, 0.0) for kind, p in spectra.items())
    ]


def vectors_grid(spectra: Spectra, shown: list[float], system: System, *, hints: bool) -> Grid:
    """Return force and moment side by side, with the parts of each that turn with the crank and
    against it; the other orders are listed in one line, with a hint how to see them.

    Args:
        spectra: Spectra to show.
        shown: Orders that have rows.
        system: System of units.
        hints: Whether the option that shows more is named.
    """
    chosen = spectra.select_orders(shown)
    heads = ["order"]
    columns: list[Sequence[str]] = [[order_name(order) for order in chosen.orders]]
    for kind, phasors in chosen.vectors():
        unit = fit_largest(system.unit(kind), phasors)
        heads += [f"{kind.name}, {unit.name}", "with crank", "against"]
        cells = (vector_cells(phasors, k, unit, 4) for k in range(len(shown)))
        largest, _, _, ahead, against = zip(*cells, strict=True)
        columns += [largest, ahead, against]
    return Grid(
        "Largest by order, and its parts that turn with the crank and against it",
        tuple(heads),
        tuple(zip(*columns, strict=True)),
        tell_others([spectra], shown, system, hints=hints),
    )


def name_column(kind: Kind) -> str:
    """Return a kind at the head of a column, or in a sentence."""
    return "roll with gas" if kind is ROLL_TOTAL else kind.name


def tell_others(
    states: Sequence[Spectra], shown: list[float], system: System, *, hints: bool
) -> str:
    """Return one line on the orders that are not shown, or nothing.

    Args:
        states: of one engine, as of now or before and after, with the same orders.
    """
    others = [
        float(order)
        for k, order in enumerate(states[0].orders)
        if order not in shown and any(p.major[k] > 0 for one in states for _, p in one.items())
    ]
    if not others:
        return ""
    rest = [one.select_orders(others) for one in states]
    sizes = []
    for kind, _ in rest[0].items():
        largest = max(float(np.nan_to_num(one[kind.name].major).max()) for one in rest)
        if largest:  # nan, and so 0 here, where it is not known
            sizes.append(f"{name_column(kind)} {size_text(largest, system.unit(kind))}")
    names = ", ".join(map(order_name, others[:6]))
    more = ", …" if len(others) > 6 else ""
    plural = "s" * (len(others) > 1)
    told = f"Negligible: order{plural} {names}{more} (at most {', '.join(sizes)})."
    return f"{told} All: --all." if hints else told


def roll_and_peaks(result: Analysis, system: System, *, every_order: bool) -> Facts:
    """Return moments about the crank's axis and the largest values over a revolution, a line each.

    Args:
        result: Analysis to show.
        system: System of units.
        every_order: Whether the caller chose the orders.
    """
    peaks = peak_facts(result, system, "", result.of_one_cylinder).pairs
    roll = result.spectra.roll
    name = ROLL.label if result.engine.gas is None else f"{ROLL.label}, inertia alone"
    pairs = []
    if roll is not None:
        pairs = [(name, _tell_roll(result, roll, system, every_order=every_order))]
    title = "Largest over a revolution" if peaks else f"About {tell_pivot(result.engine)}"
    return Facts((*pairs, *peaks), title)


def _tell_roll(result: Analysis, roll: Phasors, system: System, *, every_order: bool) -> str:
    """Return every order that matters: `order 2: 458, 4: 26.3 N m`; arguments as of
    `roll_and_peaks`.
    """
    least = NEGLIGIBLE * result.of_one_cylinder[ROLL.name]
    rows = [k for k, size in enumerate(roll.major) if size > least]
    largest = float(roll.major.max(initial=0))
    if not rows:
        nothing = small_text(largest, system.moment)
        return f"{nothing} in the orders shown" if every_order else nothing
    unit = system.moment.fit(largest)
    sizes = (f"{order_name(roll.orders[k])}: {number(unit.of(float(roll.major[k])))}" for k in rows)
    return f"order {', '.join(sizes)} {unit.name}"


_NAMES = ("First", "Second", "Third", "Fourth", "Fifth", "Sixth", "Seventh", "Eighth")
_MOST_WORDS = 25  # of a sentence
_MOST_NAMED = 5  # orders in a row
_AXES = {"0.0": "x", "90.0": "y"}
_SENSES = {1: "with the crank", -1: "against the crank"}
_UNEVEN = (
    "The uneven speed mixes the orders. Devices are sized at steady speed; one that cancels an "
    "order there also cancels what that order adds to others."
)


class _Vector(NamedTuple):
    """Force or moment, and what one cylinder makes of it (0: not known)."""

    kind: Kind
    phasors: Phasors
    unit: ShownUnit
    scale: float
    up_deg: float | None

    def part(self, k: int, sense: int) -> float:
        """Return the size of what turns with the crank (1), or against it (-1)."""
        turning = self.phasors.forward if sense > 0 else self.phasors.backward
        return float(abs(turning[k]))

    def tell_size(self, k: int, sense: int = 0) -> str:
        """Return the largest value of an order, or of its part in one sense."""
        size = self.part(k, sense) if sense else float(self.phasors.major[k])
        return size_text(size, self.unit)

    def describe(self, k: int, *, directed: bool) -> str:
        """Return size and direction: `force of 4 N along x`; the axis is also named where the file
        says which way is up.
        """
        told = f"{self.kind.name} of {self.tell_size(k)}"
        if not directed:
            return told
        for sense, turning in _SENSES.items():
            if not self.part(k, -sense):
                return f"{told} turning {turning}"
        axis_deg = float(self.phasors.axis_deg[k])
        angle = degrees(axis_deg, 180)
        axis = self.kind.tell_axis(_AXES.get(angle) or f"an axis at {angle} deg")
        if self.up_deg is not None:
            names = dict(zip(_AXES, self.kind.upright, strict=True))
            from_up = degrees(float(wrap_degrees(axis_deg - self.up_deg, 180)), 180)
            axis = f"{names[from_up]} ({axis})" if from_up in names else axis
        return f"{told} {axis}"


class _Order(NamedTuple):
    """An order, and the parts of its sentence in the verdict.

    Attributes:
        k, order: Its index, and the order.
        large: Force and moment, as far as they are not small.
        rest: Force and moment, as far as they are small.
        couple: Its roll couple in words, where the moment is balanced and the couple is not.
        cures: Devices that would cancel the parts that are not small, by sense of rotation.
    """

    k: int
    order: float
    large: list[_Vector]
    rest: list[_Vector]
    couple: str
    cures: Mapping[int, str]

    @property
    def balanced(self) -> bool:
        """Whether force and moment are balanced."""
        return not self.large and all(vector.phasors.balanced[self.k] for vector in self.rest)

    def tell(self) -> str:
        """Return the longest sentence on the order that is not too long."""
        n = int(self.order)
        name = f"{_NAMES[n - 1] if n <= len(_NAMES) else ordinal(n)} order"
        if self.order % 1:
            name = f"Order {order_name(self.order)}"
        if not self.large:
            names = " and ".join(vector.kind.name for vector in self.rest)
            return f"{name}: {self.couple}; {names} {'balanced' if self.balanced else 'small'}."
        told = ""
        for directed, sizes in ((True, True), (True, False), (False, False)):
            there = " and ".join(one.describe(self.k, directed=directed) for one in self.large)
            there = ", ".join(filter(None, (there, self.couple)))
            told = f"{name}: {'; '.join(filter(None, (there, self._tell_cure(sizes))))}."
            if len(told.split()) <= _MOST_WORDS:
                break
        return told

    def _tell_cure(self, sizes: bool) -> str:
        """Return what cancels the order; with the sizes of its parts, if there is one vector."""
        if not self.cures:
            return ""
        if self.order > 2:
            return f"usually left: its shafts would turn at {self.order:g} times crank speed"
        one = self.large[0] if len(self.large) == 1 else None
        everything = "both" if one is None else f"the {one.kind.name}" if self.couple else "it"
        devices = [*self.cures.values()]
        if len(devices) == 1:
            (sense,) = self.cures
            cancel = f"{devices[0]} cancel{'s' * devices[0].startswith('a ')}"
            if not any(vector.part(self.k, -sense) for vector in self.large):
                return f"{cancel} {everything}"
            if one is None:
                return f"{cancel} what turns {_SENSES[sense]}"
            return f"{cancel} {one.tell_size(self.k, sense)} of it"
        if self.order == 2:
            return f"shafts at +2 and -2 cancel {everything}"
        if one and sizes:
            ahead, against = (one.tell_size(self.k, sense) for sense in self.cures)
            return f"{devices[0]} cancel {ahead} of it, {devices[1]} the other {against}"
        return f"{' and '.join(devices)} cancel {everything}"


def verdict(
    spectra: Spectra,
    system: System,
    scales: Scales | None = None,
    *,
    small: float = SMALL,
    steady: bool = True,
    turning: Collection[int] = (1,),
) -> tuple[str, ...]:
    """Return a sentence for every order that is not small, and one on the others, each of at most
    25 words; none without forces and moments.

    Args:
        spectra: Spectra to judge.
        system: System of units.
        scales: What one cylinder makes; None: not known, and nothing is small.
        small: Share of it below which a part is small.
        steady: Whether the speed is. If not, no cure is named: most of an order may come from
            another one through the unevenness, and vanishes with that one.
        turning: Senses in which cranks turn, seen from the first: they carry counterweights.
    """
    of_one = {} if scales is None else scales._asdict()
    vectors = [
        _Vector(kind, phasors, system.unit(kind), of_one.get(kind.name, 0.0), spectra.up_deg)
        for kind, phasors in spectra.vectors()
    ]
    if not vectors:
        return ()

    def judge(k: int, order: float) -> _Order:
        senses = {
            vector: [s for s in _SENSES if not is_small(vector.part(k, s), small * vector.scale)]
            for vector in vectors
        }
        due = {sense for found in senses.values() for sense in found}
        moments = (vector for vector in vectors if vector.kind is MOMENT)
        couple = 0.0
        if spectra.couple and order <= 2 and all(one.phasors.balanced[k] for one in moments):
            couple = float(spectra.couple.major[k])
        told = couple > NEGLIGIBLE * of_one.get("roll", 0.0)
        return _Order(
            k=k,
            order=order,
            large=[vector for vector, found in senses.items() if found],
            rest=[vector for vector, found in senses.items() if not found],
            couple=f"roll couple of {size_text(couple, system.moment)}" if told else "",
            cures=_find_cures(order, due, turning) if steady else {},
        )

    every = [judge(k, float(order)) for k, order in enumerate(spectra.orders) if order > 0]
    matter = [one for one in every if one.large or one.couple]
    told = [one.tell() for one in matter]
    if not steady and any(one.large for one in every):
        told.append(_UNEVEN)
    names = " and ".join(vector.kind.name for vector in vectors)
    balanced = [one.order for one in every if one.balanced and one not in matter]
    small_ones = _tell_largest([(one, vector) for one in every for vector in one.rest])
    if told or small_ones or min(balanced, default=3) <= 2:  # odd ones are of no interest then
        usual = [order for order in balanced if order in (1, 2)]
        balanced = usual or [order for order in balanced if order < 2 and not told]
    rest = (_tell_balanced(balanced, names), small_ones and f"small: {small_ones}")
    last = "; ".join(filter(None, rest))
    return (*told, sentence(last)) if last else tuple(told)


def _find_cures(order: float, due: Collection[int], turning: Collection[int]) -> dict[int, str]:
    """Return what would cancel the parts of an order that turn in these senses, by sense."""
    if order % 1:
        return {}  # no device turns at half orders
    weights = {1: "counterweights", -1: "weights on the opposite crank"}
    ratios = {sense: round(order) * sense for sense in sorted(due, reverse=True)}
    return {s: weights[n] if n in turning else f"a shaft at {n:+d}" for s, n in ratios.items()}


def _tell_balanced(orders: Sequence[float], names: str) -> str:
    """Return which orders are balanced."""
    if not orders:
        return ""
    which = f"{len(orders)} orders"
    if len(orders) <= _MOST_NAMED:
        which = f"order{'s' * (len(orders) > 1)} {join_words([*map(order_name, orders)])}"
    return f"{names} of {which} {'are' if ' ' in names else 'is'} balanced"


def _tell_largest(found: Sequence[tuple[_Order, _Vector]]) -> str:
    """Return the largest force and the largest moment of some orders; empty if all are balanced."""
    largest: dict[str, tuple[float, str]] = {}
    for one, vector in found:
        size, name = float(vector.phasors.major[one.k]), vector.kind.name
        if size > largest.get(name, (0.0, ""))[0]:
            text = f"{name} of {vector.tell_size(one.k)} (order {order_name(one.order)})"
            largest[name] = size, text
    return ", ".join(text for _, text in largest.values())
