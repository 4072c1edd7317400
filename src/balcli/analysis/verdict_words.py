"""Put a verdict into words: a sentence for each order that matters, one on the higher orders, one
on what is balanced or small, one on the couple and one on the roll. A sentence on an order has at
most 25 words.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..core.phasors import Phasors, wrap_degrees
from ..engine.engine import Engine
from ..file.fields import join_words, ordinal
from ..forces.kinds import EVERY_KIND, Kind
from ..forces.spectrum import Spectra
from ..show.engine_facts import tell_pivot
from ..show.sheet import NEGLIGIBLE, degrees, number, order_name, sentence, size_text
from ..show.units import ShownUnit, System
from ..sizing.residual import Scales
from .compensator_need import CompensatorNeed
from .couple import Couple, CoupleCause
from .verdict import (
    AGAINST_CRANK,
    WITH_CRANK,
    Compensated,
    Cure,
    Finding,
    Part,
    Rocking,
    Verdict,
    list_vectors,
    select_largest,
)

NEARLY_ROUND = 0.01  # smaller / larger part up to which a vector turns at nearly constant size
_MOST_WORDS = 25  # largest number of words in a sentence
_MOST_NAMED = 5  # largest number of orders that a sentence names
_ORDERS = ("First", "Second", "Third", "Fourth", "Fifth", "Sixth", "Seventh", "Eighth")
_AXES = {"0.0": "x", "90.0": "y"}
_NAMED = {"moment": "longitudinal moment"}  # distinguishes it from the couple, another moment
_SENSES = {WITH_CRANK: "with the crank", AGAINST_CRANK: "against the crank"}
_WEIGHTS = {WITH_CRANK: "counterweights", AGAINST_CRANK: "weights on the opposite crank"}
_UNEVEN = (
    "Uneven speed mixes the orders. Devices are sized at steady speed; a device that cancels an "
    "order at steady speed also cancels what this order adds to other orders at uneven speed."
)
_CAUSES: dict[CoupleCause, str] = {
    "rods": "the rods",
    "offset_pistons": "offset pistons",
    "turning_cylinders": "pistons in cylinders that turn",
    "reference_point": "forces whose lines miss the point of reference",
    "angular_acceleration": "the acceleration of turning parts",
}
_NEEDS = {  # sentences on compensators, by the need in the words of project guides
    "not relevant": "a compensator is not relevant",
    "unlikely": "a compensator is unlikely to be needed",
    "likely": "a compensator is likely needed",
    "most likely": "a compensator is most likely needed",
}
_NEEDED = ("likely", "most likely")
_AT_ENDS = "pairs at the engine's ends cancel it"
_GIVE_POWER = "Give operation.power: compensators are judged by power related unbalance."
_EQUIVALENT_ROD = "a rod dynamically equivalent to two masses at its ends has none"


class _Vector(NamedTuple):
    """The force or moment of an order, with what its words need."""

    kind: Kind
    phasors: Phasors  # of this order alone
    unit: ShownUnit
    up_deg: float | None

    def find_part(self, sense: int) -> float:
        """Return the size of the vector that turns in one direction."""
        turning = self.phasors.forward if sense == WITH_CRANK else self.phasors.backward
        return float(abs(turning[0]))

    def tell_part(self, sense: int) -> str:
        """Return in words the size of the vector that turns in one direction."""
        return size_text(self.find_part(sense), self.unit)

    def describe(self) -> str:
        """Return kind and largest value in words: `force of 4 N`."""
        name = _NAMED.get(self.kind.name, self.kind.name)
        return f"{name} of {size_text(float(self.phasors.major[0]), self.unit)}"

    def describe_with_direction(self) -> str:
        """Return kind, largest value and direction in words: `force of 4 N along x`, or `turning
        with the crank` if the part that turns against it is negligible.
        """
        for sense, turning in _SENSES.items():
            if self.find_part(-sense) <= NEARLY_ROUND * self.find_part(sense):
                return f"{self.describe()} turning {turning}"
        return f"{self.describe()} {self._tell_axis()}"

    def _tell_axis(self) -> str:
        """Return the direction of the largest value in words. If the file gives `frame.up`, the
        axis is also called vertical or horizontal.
        """
        axis_deg = float(self.phasors.axis_deg[0])
        angle = degrees(axis_deg, 180)
        axis = self.kind.tell_axis(_AXES.get(angle, f"an axis at {angle} deg"))
        if self.up_deg is None:
            return axis
        from_up = degrees(float(wrap_degrees(axis_deg - self.up_deg, 180)), 180)
        names = dict(zip(_AXES, self.kind.upright, strict=True))
        if from_up not in names:
            return axis
        return f"{names[from_up]} ({axis})"


class VerdictWords(NamedTuple):
    """Words for the verdict on some spectra.

    Attributes:
        spectra: Spectra, for sizes and directions.
        scales: Force, moment and roll of one cylinder.
        system: System of units.
        engine: Engine with these spectra; None: one crank without articulated rods, and the point
            of reference on its axis.
    """

    spectra: Spectra
    scales: Scales
    system: System
    engine: Engine | None = None

    def write(self, verdict: Verdict) -> tuple[str, ...]:
        """Return the sentences of a verdict; none if there is nothing to say."""
        return tuple(self._write_each(verdict))

    def _write_each(self, verdict: Verdict) -> Iterator[str]:
        high = [finding for finding in verdict.matter if finding.order > 2]
        yield from self._write_low(verdict)
        if len(high) == 1:
            yield self.write_order(high[0])
        for compensated in verdict.compensated:
            yield self.write_compensated(compensated)
        if len(high) > 1:
            yield self._write_higher(high)
        if verdict.uneven and verdict.matter:
            yield _UNEVEN
        rest = "; ".join(self._write_rest(verdict))
        if rest:
            yield sentence(rest)
        if verdict.couple is not None:
            yield self.write_couple(verdict.couple)
        if verdict.rocking is not None:
            yield self.write_rocking(verdict.rocking)

    def _write_low(self, verdict: Verdict) -> Iterator[str]:
        """Yield a sentence for each order up to 2 that matters."""
        needs = {need.order: need for need in verdict.compensators or ()}
        for finding in verdict.matter:
            if finding.order in needs:
                yield self.write_need(finding, needs[finding.order])
            elif finding.order <= 2:
                yield self.write_order(finding)
        if any(need.need is None for need in needs.values()):
            yield _GIVE_POWER

    def _find_vector(self, part: Part) -> _Vector:
        kind = EVERY_KIND[part.kind]
        phasors = self.spectra[part.kind].select_orders([part.order])
        return _Vector(kind, phasors, self.system.unit(kind), self.spectra.up_deg)

    # -------------------------------------------------------------- orders
    def write_order(self, finding: Finding) -> str:
        """Return the sentence on an order: the most detailed one that is not too long."""
        vectors = [self._find_vector(Part(finding.order, kind)) for kind in finding.large]
        directed = " and ".join(vector.describe_with_direction() for vector in vectors)
        plain = " and ".join(vector.describe() for vector in vectors)
        sentences = [
            _join_order(finding, directed, tell_cures(finding, vectors, with_sizes=True)),
            _join_order(finding, directed, tell_cures(finding, vectors)),
            _join_order(finding, plain, tell_cures(finding, vectors)),
        ]
        for written in sentences:
            if len(written.split()) <= _MOST_WORDS:
                return written
        return sentences[-1]

    def write_need(self, finding: Finding, need: CompensatorNeed) -> str:
        """Return the sentence on an order that compensators may have to cancel."""
        moment = self._find_vector(Part(finding.order, "moment"))
        vertical = size_text(float(abs(moment.phasors.y[0])), moment.unit)
        written = f"{name_order(finding.order)}: "
        if "force" in finding.large:
            force = self._find_vector(Part(finding.order, "force"))
            written += f"{force.describe_with_direction()} and "
        written += f"vertical moment of {vertical}"
        if need.need is None or need.Nm_per_kW is None:
            return f"{written}."
        written += f", PRU {number(need.Nm_per_kW, 3)} N·m/kW: {_NEEDS[need.need]}"
        if need.need not in _NEEDED:
            return f"{written}."
        cure = _AT_ENDS if finding.order > 1 else f"counterweights and {_AT_ENDS}"
        return f"{written}; {cure}."

    def _write_higher(self, high: Sequence[Finding]) -> str:
        """Return one sentence on several orders above 2."""
        parts = [Part(finding.order, kind) for finding in high for kind in finding.large]
        largest = select_largest(parts, list_vectors(self.spectra))
        orders = name_orders([finding.order for finding in high])
        written = f"{orders}: {self._describe_parts(largest)}"
        if any(finding.cures for finding in high):
            written += "; usually left"
        return sentence(written)

    def _write_rest(self, verdict: Verdict) -> Iterator[str]:
        """Yield what is balanced and what is small."""
        if verdict.balanced:
            yield f"{name_orders(verdict.balanced)}: {join_words(verdict.balanced_kinds)} balanced"
        if verdict.small:
            yield f"small: {self._describe_parts(verdict.small)}"

    def _describe_parts(self, parts: Sequence[Part]) -> str:
        """Return sizes and orders in words: `force of 4 N (order 2)`."""
        written = [
            f"{self._find_vector(part).describe()} (order {order_name(part.order)})"
            for part in parts
        ]
        return ", ".join(written)

    def write_compensated(self, found: Compensated) -> str:
        """Return sentences on an order with moment compensators."""
        system = self.system
        sentences = []
        if found.vertical_Nm is not None:
            sentences.append(self._write_vertical(found, found.vertical_Nm))
        if found.across_Nm and found.across_Nm > NEGLIGIBLE * self.scales.moment:
            left = size_text(found.across_Nm, system.moment)
            sentences.append(f"Moment left: up to {left} about x.")
        if found.force_N and found.force_N > NEGLIGIBLE * self.scales.force:
            most = size_text(found.force_N, system.force)
            sentences.append(f"The engine's own force of this order is up to {most}.")
        return " ".join(sentences)

    def _write_vertical(self, found: Compensated, vertical_Nm: float) -> str:
        """Return a sentence on the vertical moment that compensators leave, and on their force."""
        unit = self.system.length
        where = join_words([f"z = {number(unit.of(z))} {unit.name}" for z in found.at_m])
        named = "compensators"
        verb = "introduce"
        if len(found.at_m) == 1:
            named = "compensator"
            verb = "introduces"
        left = "balanced by"
        if vertical_Nm:
            left = f"of {size_text(vertical_Nm, self.system.moment)} left with"
        force = "no force"
        if found.introduced_N:
            force = f"a force of {size_text(found.introduced_N, self.system.force)} by design"
        return (
            f"{name_order(found.order)}: vertical moment {left} the {named} at {where}; "
            f"the {named} {verb} {force}."
        )

    # -------------------------------------------------------------- couple and roll
    def write_couple(self, couple: Couple) -> str:
        """Return a sentence on the largest transverse couple and its causes."""
        largest = self.spectra["couple"].select_orders([couple.order]).major[0]
        size = size_text(float(largest), self.system.moment)
        written = f"Transverse couple: up to {size} (order {order_name(couple.order)})"
        if couple.causes is None:
            return f"{written}."
        written += f", from {join_words([_CAUSES[cause] for cause in couple.causes])}"
        if couple.causes == ("rods",) and not self._has_linkage():
            written += f"; {_EQUIVALENT_ROD}"
        return f"{written}."

    def _has_linkage(self) -> bool:
        return self.engine is not None and self.engine.cylinders.linkage is not None

    def write_rocking(self, rocking: Rocking) -> str:
        """Return a sentence on the order with the largest roll."""
        if rocking.order is None:
            pivot = "the crank axis" if self.engine is None else tell_pivot(self.engine)
            return f"No order rocks the engine about {pivot}."
        moment = self.system.moment
        at_order = self.spectra.select_orders([rocking.order])
        causes = []
        for name in ("gas", "inertia"):
            kind = "roll" if name == "inertia" else name
            size = float(at_order[kind].major[0])
            if size:
                causes.append(f"{name} {size_text(size, moment)}")
        most = size_text(float(at_order["roll_total"].major[0]), moment)
        return (
            f"Order {order_name(rocking.order)} rocks the engine most: roll of {most} "
            f"({', '.join(causes)})."
        )


def _join_order(finding: Finding, size: str, cure: str) -> str:
    written = f"{name_order(finding.order)}: {size}"
    return f"{written}; {cure}." if cure else f"{written}."


def tell_cures(finding: Finding, vectors: Sequence[_Vector], *, with_sizes: bool = False) -> str:
    """Return in words what the devices of a finding cancel; empty without devices.

    Args:
        finding: Order with its devices.
        vectors: Large force and moment of the order.
        with_sizes: Whether to state the size that each of two devices cancels, if only the force
            or only the moment is large.
    """
    if not finding.cures:
        return ""
    if finding.order > 2:
        return f"usually left: its shafts would turn at {finding.order:g} times crank speed"
    if len(finding.cures) == 1:
        return _tell_cure(finding.cures[0], vectors)
    everything = "it" if len(vectors) == 1 else "both"
    if finding.order == 2:
        further = "further " if any(cure.further for cure in finding.cures) else ""
        return f"{further}shafts at +2 and -2 cancel {everything}"
    first, second = finding.cures
    if with_sizes and len(vectors) == 1:
        ahead = vectors[0].tell_part(first.sense)
        against = vectors[0].tell_part(second.sense)
        return f"{name_cure(first)} cancel {ahead} of it, {name_cure(second)} the other {against}"
    return f"{name_cure(first)} and {name_cure(second)} cancel {everything}"


def _tell_cure(cure: Cure, vectors: Sequence[_Vector]) -> str:
    """Return in words what the only device cancels."""
    verb = "cancel" if cure.on_crank else "cancels"
    cancel = f"{name_cure(cure)} {verb}"
    leaves = any(vector.find_part(-cure.sense) for vector in vectors)
    if len(vectors) > 1:
        return f"{cancel} what turns {_SENSES[cure.sense]}" if leaves else f"{cancel} both"
    return f"{cancel} {vectors[0].tell_part(cure.sense)} of it" if leaves else f"{cancel} it"


def name_cure(cure: Cure) -> str:
    """Return a device in words: `a further shaft at -1`."""
    further = "further " if cure.further else ""
    if cure.on_crank:
        return f"{further}{_WEIGHTS[cure.sense]}"
    return f"a {further}shaft at {cure.ratio:+d}"


def name_order(order: float) -> str:
    """Return an order in words, for the beginning of a sentence."""
    if order % 1:
        return f"Order {order_name(order)}"
    if order <= len(_ORDERS):
        return f"{_ORDERS[int(order) - 1]} order"
    return f"{ordinal(int(order))} order"


def name_orders(orders: Sequence[float]) -> str:
    """Return in words the numbers of some orders, or their count if they are many."""
    if len(orders) > _MOST_NAMED:
        return f"{len(orders)} orders up to {order_name(max(orders))}"
    names = join_words([order_name(order) for order in orders])
    return f"order {names}" if len(orders) == 1 else f"orders {names}"
