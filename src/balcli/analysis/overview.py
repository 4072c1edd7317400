"""Lay out an analysis in brief: a table of the orders that matter, one line each on roll and peaks,
and the verdict. The verdict has a sentence for each order. It names the part that turns with the
crank, which counterweights can cancel, and the part that needs shafts.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.phasors import Array, Complex, Phasors, wrap_degrees
from ..file.fields import join_words, ordinal
from ..forces.kinds import COUPLE, FORCE, MOMENT, ROLL, ROLL_TOTAL, Kind
from ..forces.spectrum import Spectra, compute_spectra
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
    from ..engine.engine import Engine
    from .answer import Analysis


def find_orders_that_matter(spectra: Spectra, single: dict[str, float]) -> list[float]:
    """Return the orders up to 2, and those with a force or moment that is not negligible compared
    with one cylinder.

    Args:
        spectra: Spectra to show.
        single: Size of each kind for one cylinder; a kind that is missing is never negligible.
    """
    return [
        float(order)
        for k, order in enumerate(spectra.orders)
        if order in (0, 1, 2)
        or any(p.major[k] > NEGLIGIBLE * single.get(kind.name, 0.0) for kind, p in spectra.items())
    ]


def vectors_grid(spectra: Spectra, shown: list[float], system: System, *, hints: bool) -> Grid:
    """Return a table of force and moment side by side, each with its vectors that turn with and
    against the crank. A line on the other orders follows.

    Args:
        spectra: Spectra to show.
        shown: Orders that have rows.
        system: System of units.
        hints: Whether to name the option that shows more.
    """
    chosen = spectra.select_orders(shown)
    columns: list[tuple[str, Sequence[str]]] = [("order", [*map(order_name, chosen.orders)])]
    for kind, phasors in chosen.vectors():
        unit = fit_largest(system.unit(kind), phasors)
        cells = (vector_cells(phasors, k, unit, 4) for k in range(len(shown)))
        largest, _, _, ahead, against = zip(*cells, strict=True)
        columns.append((f"{kind.name}, {unit.name}", largest))
        columns += [("with crank", ahead), ("against", against)]
    title = "Largest by order, and its parts that turn with the crank and against it"
    return Grid.of_columns(title, columns, tell_others(spectra, shown, system, hints=hints))


def name_column(kind: Kind) -> str:
    """Return the name of a kind for headings of columns and for sentences."""
    return "roll with gas" if kind is ROLL_TOTAL else kind.name


def tell_others(spectra: Spectra, shown: list[float], system: System, *, hints: bool) -> str:
    """Return a line on the orders that are not shown; empty if there are none.

    Args:
        spectra: All orders that were computed.
        shown: Orders that are shown.
        system: System of units.
        hints: Whether to name the option that shows more.
    """
    others = [
        float(order)
        for k, order in enumerate(spectra.orders)
        if order not in shown and any(p.major[k] > 0 for _, p in spectra.items())
    ]
    if not others:
        return ""
    sizes = []
    for kind, phasors in spectra.select_orders(others).items():
        if largest := float(np.nan_to_num(phasors.major).max()):  # not known (nan): counts as 0
            sizes.append(f"{name_column(kind)} {size_text(largest, system.unit(kind))}")
    names = ", ".join(map(order_name, others[:6]))
    more = ", …" if len(others) > 6 else ""
    plural = "s" * (len(others) > 1)
    told = f"Negligible: order{plural} {names}{more} (at most {', '.join(sizes)})."
    return f"{told} --all shows them." if hints else told


def roll_and_peaks(result: Analysis, system: System, *, every_order: bool) -> Facts:
    """Return lines on the roll by order and on the largest values over a revolution.

    Args:
        result: Analysis to show.
        system: System of units.
        every_order: Whether the caller chose the orders.
    """
    peaks = peak_facts(result, system, "", result.of_one_cylinder).pairs
    roll = result.spectra.roll
    name = ROLL.label if result.engine.gas is None else f"{ROLL.label}, inertia alone"
    title = "Largest over a revolution" if peaks else f"About {tell_pivot(result.engine)}"
    if roll is None:
        return Facts(peaks, title)
    told = _tell_roll(result, roll, system, every_order=every_order)
    return Facts(((name, told), *peaks), title)


def _tell_roll(result: Analysis, roll: Phasors, system: System, *, every_order: bool) -> str:
    """Return the roll of every order that matters: `order 2: 458, 4: 26.3 N m`; arguments as for
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
_ROUNDING = 1e-9  # a smaller share of the vectors that should cancel is rounding
_MOST_WORDS = 25  # largest number of words in a sentence
_MOST_NAMED = 5  # largest number of orders that a sentence names
_AXES = {"0.0": "x", "90.0": "y"}
_NAMED = {"moment": "longitudinal moment"}  # distinguishes it from the couple, another moment
_SENSES = {1: "with the crank", -1: "against the crank"}
NEARLY_ROUND = 0.01  # smaller / larger part up to which a vector turns at nearly constant size
_UNEVEN = (
    "Uneven speed mixes the orders. Devices are sized at steady speed; a device that cancels an "
    "order at steady speed also cancels what this order adds to other orders at uneven speed."
)


class _Vector(NamedTuple):
    """Free force or moment of all orders; `scale`: first order of one cylinder (0: not known)."""

    kind: Kind
    phasors: Phasors
    unit: ShownUnit
    scale: float
    up_deg: float | None

    def part(self, k: int, sense: int) -> float:
        """Return the size of the vector that turns with the crank (1) or against it (-1)."""
        turning = self.phasors.forward if sense > 0 else self.phasors.backward
        return float(abs(turning[k]))

    def tell_size(self, k: int, sense: int = 0) -> str:
        """Return in words the largest value of an order or, with `sense`, of the vector `part`."""
        size = self.part(k, sense) if sense else float(self.phasors.major[k])
        return size_text(size, self.unit)

    def describe(self, k: int, *, directed: bool) -> str:
        """Return in words the size and, if `directed`, the direction: `force of 4 N along x`, or
        `turning with the crank` if the part that turns against the crank is negligible. If
        the file gives `frame.up`, the axis is also called vertical or horizontal.
        """
        told = f"{_NAMED.get(self.kind.name, self.kind.name)} of {self.tell_size(k)}"
        if not directed:
            return told
        for sense, turning in _SENSES.items():
            if self.part(k, -sense) <= NEARLY_ROUND * self.part(k, sense):
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
        k: Index of the order in the spectra.
        order: Order.
        large: Force, moment or both, whichever are not small at this order.
        rest: Force, moment or both, whichever are small at this order.
        couple: Whether the transverse couple of this order was computed and is balanced.
        cures: Devices that would cancel the vectors that are not small, by the direction in which
            these vectors turn: 1 with the crank, -1 against it.
    """

    k: int
    order: float
    large: list[_Vector]
    rest: list[_Vector]
    couple: bool
    cures: Mapping[int, str]

    @property
    def balanced(self) -> bool:
        """Whether force and moment are balanced."""
        return not self.large and all(vector.phasors.balanced[self.k] for vector in self.rest)

    @property
    def name(self) -> str:
        """The order in words, for the beginning of a sentence."""
        n = int(self.order)
        if self.order % 1:
            return f"Order {order_name(self.order)}"
        return f"{_NAMES[n - 1] if n <= len(_NAMES) else ordinal(n)} order"

    def tell(self) -> str:
        """Return the sentence on the order: the most detailed one that is not too long."""
        told = ""
        for directed, sizes in ((True, True), (True, False), (False, False)):
            there = " and ".join(one.describe(self.k, directed=directed) for one in self.large)
            told = f"{self.name}: {'; '.join(filter(None, (there, self._tell_cure(sizes))))}."
            if len(told.split()) <= _MOST_WORDS:
                break
        return told

    def _tell_cure(self, sizes: bool) -> str:
        """Return in words the devices that cancel the order. If `sizes` is true and either only the
        force or only the moment is large, the size that each device cancels is stated.
        """
        if not self.cures:
            return ""
        if self.order > 2:
            return f"usually left: its shafts would turn at {self.order:g} times crank speed"
        one = self.large[0] if len(self.large) == 1 else None
        everything = "both" if one is None else "it"
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
            further = "further " * any("further" in device for device in devices)
            return f"{further}shafts at +2 and -2 cancel {everything}"
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
    engine: Engine | None = None,
) -> tuple[str, ...]:
    """Return a sentence for every order up to 2 that is not small, one sentence on the higher
    orders that are not small, and one on the small orders; empty if the spectra have neither forces
    nor moments. A sentence has at most 25 words.

    Args:
        spectra: Spectra to judge.
        system: System of units.
        scales: Force and moment of one cylinder; None: not known, so that no order is small.
        small: Share of one cylinder's force or moment. The force or moment of an order is small
            if both its vectors (with the crank and against it) are below this share.
        engine: Engine with these spectra; None: one crank without devices at steady speed. A named
            device that turns like one of the engine's devices is called a further one. At uneven
            speed no device is named, because most of an order may come from another order, and
            would vanish with that order.
    """
    of_one = {} if scales is None else scales._asdict()
    steady = engine is None or not engine.ripple
    devices = () if engine is None else engine.every_device
    turning = {1} if engine is None else {one.ratio for one in engine.cranks}
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
        return _Order(
            k=k,
            order=order,
            large=[vector for vector, found in senses.items() if found],
            rest=[vector for vector, found in senses.items() if not found],
            couple=spectra.couple is not None and bool(spectra.couple.balanced[k]),
            cures=_find_cures(order, due, devices, turning) if steady else {},
        )

    every = [judge(k, float(order)) for k, order in enumerate(spectra.orders) if order > 0]
    compensated = {device.order for device in devices if device.compensates}
    matter = [one for one in every if one.large and one.order not in compensated]
    high = [one for one in matter if one.order > 2]
    told = [one.tell() for one in matter if len(high) < 2 or one not in high]
    for one in every:
        if engine is not None and one.order in compensated:
            told.append(_tell_compensated(one, engine, system))
    if len(high) > 1:
        told.append(_tell_higher(high))
    if not steady and matter:
        told.append(_UNEVEN)
    names = [vector.kind.name for vector in vectors]
    balanced = [one.order for one in every if one.balanced and one.order not in compensated]
    small_ones = _tell_largest(
        [(one, vector) for one in every if one.order not in compensated for vector in one.rest]
    )
    if told or small_ones or min(balanced, default=3) <= 2:  # name no higher balanced orders
        usual = [order for order in balanced if order in (1, 2)]
        balanced = usual or [order for order in balanced if order < 2 and not told]
    if all(one.couple for one in every if one.order in balanced):
        names.append(COUPLE.name)
    rest = [f"{name_orders(balanced)}: {join_words(names)} balanced"] if balanced else []
    rest += [f"small: {small_ones}"] if small_ones else []
    return (*told, sentence("; ".join(rest))) if rest else tuple(told)


def _tell_compensated(one: _Order, engine: Engine, system: System) -> str:
    """Return sentences on an order with moment compensators: the vertical moment (about y, of
    forces along x), the force that the compensators introduce, and the engine's own force.
    """
    devices = engine.every_device
    pairs = [device for device in devices if device.compensates and device.order == one.order]
    places = sorted({float(device.z) for device in pairs})
    square, unit = (one.order * float(engine.omega)) ** 2, system.length
    where = join_words([f"z = {number(unit.of(z))} {unit.name}" for z in places])
    named = "compensators" if len(places) > 1 else "compensator"
    forward = square * sum(complex(device.forward) for device in pairs)
    backward = square * sum(complex(device.backward) for device in pairs)
    size = abs(forward + backward.conjugate())
    rounding = _ROUNDING * square * sum(abs(complex(device.forward)) for device in pairs)
    introduced = f"a force of {size_text(size, system.force)} by design"
    introduced = introduced if size > rounding else "no force"
    by_kind = {vector.kind: vector for vector in (*one.large, *one.rest)}
    told = []
    if (moment := by_kind.get(MOMENT)) is not None:
        vertical, across = (abs(part[one.k]) for part in (moment.phasors.y, moment.phasors.x))
        noise = float(np.broadcast_to(moment.phasors.noise, moment.phasors.x.shape)[one.k])
        left = f"of {size_text(vertical, system.moment)} left with"
        is_balanced = vertical <= max(noise, _ROUNDING * moment.scale)
        told.append(
            f"{one.name}: vertical moment {'balanced by' if is_balanced else left} the {named} at "
            f"{where}; the {named} introduce{'s' * (len(places) == 1)} {introduced}."
        )
        if across > NEGLIGIBLE * moment.scale:
            told.append(f"Moment left: up to {size_text(across, system.moment)} about x.")
    if (force := by_kind.get(FORCE)) is not None:
        own = force.phasors.forward[one.k] - forward, force.phasors.backward[one.k] - backward
        if (largest := float(sum(map(abs, own)))) > NEGLIGIBLE * force.scale:
            most = size_text(largest, system.force)
            told.append(f"The engine's own force of this order is up to {most}.")
    return " ".join(told)


_RODS = "the rods"


def find_couple(result: Analysis) -> Phasors | None:
    """Return the orders of the transverse couple that are not negligible compared with the moment
    of one cylinder; None if there are none.
    """
    couple, least = result.spectra.couple, NEGLIGIBLE * result.scales.moment
    if couple is None:
        return None
    due = (couple.orders > 0) & (couple.major > least)
    return couple.select_orders(couple.orders[due]) if due.any() else None


def tell_couple(result: Analysis, system: System) -> str:
    """Return a sentence on the largest transverse couple and, for a single crank, its causes; empty
    if the couple is negligible at all orders.
    """
    if (couple := find_couple(result)) is None:
        return ""
    k = int(np.argmax(couple.major))
    order, size = couple.orders[k], size_text(float(couple.major[k]), system.moment)
    told = f"Transverse couple: up to {size} (order {order_name(order)})"
    if result.engine.placed:
        return f"{told}."
    causes = _find_causes(result.engine, couple.orders, NEGLIGIBLE * result.scales.moment)
    told += f", from {join_words(causes)}"
    alone = causes == [_RODS] and result.engine.cylinders.linkage is None
    return f"{told}{'; a rod dynamically equivalent to two masses at its ends has none' * alone}."


def _find_causes(engine: Engine, orders: Array, least: float) -> list[str]:
    """Return in words the causes of the transverse couple at some orders. The couple is computed
    for the rods alone, then with one further cause after the other. Those that change it are named.

    Args:
        engine: Engine.
        orders: Orders, shape (orders,).
        least: Smallest change of the couple that makes a cause worth naming, N m.
    """
    c, z = engine.cylinders, engine.reference_m[2]
    steady = replace(engine, ripple=())
    about_crank = replace(steady, devices=(), reference_m=(0.0, 0.0, z))
    rods = replace(about_crank, cylinders=replace(c, reciprocating=0 * c.reciprocating))
    pistons = "pistons in cylinders that turn" if engine.rotary else "offset pistons"
    steps = {
        _RODS: rods,
        pistons: about_crank,
        "forces whose lines miss the point of reference": steady,
        "the acceleration of turning parts": engine,
    }
    before: Complex = np.zeros(len(orders), complex)
    causes = []
    for cause, state in steps.items():
        couple = compute_spectra(state, orders, [COUPLE.name])[COUPLE.name].x
        if np.any(np.abs(couple - before) > least):
            causes.append(cause)
        before = couple
    return causes


def _find_cures(
    order: float, due: Collection[int], devices: Sequence[Device], turning: Collection[int]
) -> dict[int, str]:
    """Return in words, for each direction of rotation in `due` (1: with the crank, -1: against it),
    the device that would cancel the vector of this order that turns in this direction.
    """
    if order % 1:
        return {}  # no device turns at half orders
    weights = {1: "counterweights", -1: "weights on the opposite crank"}
    cures = {}
    alike = [one for one in devices if one.order == order and one.kind is not DeviceKind.SLIDER]
    for sense in sorted(due, reverse=True):
        there = any(np.any(one.forward if sense > 0 else one.backward) for one in alike)
        further, ratio = "further " * there, round(order) * sense
        on_crank = ratio in turning
        cures[sense] = further + weights[ratio] if on_crank else f"a {further}shaft at {ratio:+d}"
    return cures


def _tell_higher(high: Sequence[_Order]) -> str:
    """Return one sentence on several orders above 2 that are not small."""
    largest = _tell_largest([(one, vector) for one in high for vector in one.large])
    left = "; usually left" * any(one.cures for one in high)
    return sentence(f"{name_orders([one.order for one in high])}: {largest}{left}")


def name_orders(orders: Sequence[float]) -> str:
    """Return in words the numbers of some orders, or their count if they are many."""
    if len(orders) > _MOST_NAMED:
        return f"{len(orders)} orders up to {order_name(max(orders))}"
    return f"order{'s' * (len(orders) > 1)} {join_words([*map(order_name, orders)])}"


def _tell_largest(found: Sequence[tuple[_Order, _Vector]]) -> str:
    """Return in words the largest force and the largest moment of some orders; empty if all are
    balanced.
    """
    largest: dict[str, tuple[float, str]] = {}
    for one, vector in found:
        size, name = float(vector.phasors.major[one.k]), vector.kind.name
        if size > largest.get(name, (0.0, ""))[0]:
            text = f"{vector.describe(one.k, directed=False)} (order {order_name(one.order)})"
            largest[name] = size, text
    return ", ".join(text for _, text in largest.values())
