"""Put a verdict into words: a sentence for each order that matters, one on the higher orders, one
on what is balanced or small, one on the couple and one on the roll. A sentence on an order has at
most 25 words, or 35 if both its force and its moment are large.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..core.phasors import Phasors, wrap_degrees
from ..engine.engine import Engine
from ..file.fields import join_words, ordinal
from ..forces.kinds import EVERY_KIND, GAS, ROLL, ROLL_TOTAL, Kind
from ..forces.spectrum import Spectra
from ..show.engine_facts import tell_pivot
from ..show.sheet import (
    NEGLIGIBLE,
    degrees,
    number,
    order_name,
    round_degrees,
    sentence,
    size_text,
)
from ..show.units import ShownUnit, System
from ..sizing.residual import Scales
from ..sizing.ship_engines import is_type_open, stands
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
    select_largest,
    select_phasors,
)

_NEARLY_ROUND = 0.9  # smallest / largest value from which a vector has no axis, but turns
_MOST_WORDS = 25  # largest number of words in a sentence on a force or a moment
_MOST_WORDS_OF_BOTH = 35  # the same for a sentence on a force and a moment
_MOST_NAMED = 5  # largest number of orders that a sentence names
_ORDERS = ("First", "Second", "Third", "Fourth", "Fifth", "Sixth", "Seventh", "Eighth")
_AXES = {0.0: "x", 90.0: "y"}  # by angle, deg
_NAMED = {"moment": "longitudinal moment"}  # distinguishes it from the couple, another moment
_SENSES = {WITH_CRANK: "with", AGAINST_CRANK: "against"}
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
GIVE_POWER = "Give operation.power: compensators are judged by power related unbalance."
GIVE_GAS = (
    "Only its size says that it is a ship's two-stroke engine; give [gas] if it is a pump, a "
    "compressor or a steam engine."
)
_EQUIVALENT_ROD = "a rod dynamically equivalent to two masses at its ends has none"


class _Rotor(NamedTuple):
    """Words for what turns: the crank, or the cylinders of a rotary engine."""

    name: str
    speed: str


_CRANK = _Rotor("the crank", "crank speed")
_CYLINDERS = _Rotor("the cylinders", "the speed of the cylinders")


class _PartInWords(NamedTuple):
    """The force or moment of an order (`Part`) with what its words need. It consists of two vectors
    that turn in opposite directions.
    """

    kind: Kind
    phasors: Phasors  # of this order alone
    unit: ShownUnit
    up_deg: float | None
    rotor: _Rotor

    def find_vector(self, sense: int) -> float:
        """Return the size of the vector that turns in one direction."""
        turning = self.phasors.forward if sense == WITH_CRANK else self.phasors.backward
        return float(abs(turning[0]))

    def is_whole(self, sense: int) -> bool:
        """Return whether all but a negligible part turns in one direction."""
        return self.find_vector(-sense) <= NEGLIGIBLE * self.find_vector(sense)

    @property
    def has_axis(self) -> bool:
        """Whether the force or moment has a direction; if its size hardly changes, it turns."""
        return bool(self.phasors.minor[0] < _NEARLY_ROUND * self.phasors.major[0])

    @property
    def has_comma(self) -> bool:
        """Whether the description with the direction has a comma: that of a force or moment which
        turns at a multiple of crank speed.
        """
        return not self.has_axis and self.order != 1

    @property
    def order(self) -> float:
        """Order of the force or moment."""
        return float(self.phasors.orders[0])

    def tell_vector(self, sense: int) -> str:
        """Return in words the size of the vector that turns in one direction."""
        return size_text(self.find_vector(sense), self.unit)

    def describe(self) -> str:
        """Return kind and largest value in words: `force of 4 N`."""
        name = _NAMED.get(self.kind.name, self.kind.name)
        return f"{name} of {size_text(float(self.phasors.major[0]), self.unit)}"

    def describe_with_direction(self) -> str:
        """Return kind, largest value and direction in words: `force of 4 N along x`, or `turning
        with the crank` if the size hardly changes.
        """
        if self.has_axis:
            return f"{self.describe()} {self._tell_axis()}"
        ahead = self.find_vector(WITH_CRANK) > self.find_vector(AGAINST_CRANK)
        sense = f"{_SENSES[WITH_CRANK if ahead else AGAINST_CRANK]} {self.rotor.name}"
        if self.order == 1:
            return f"{self.describe()} turning {sense}"
        times = "twice" if self.order == 2 else f"{self.order:g} times"
        return f"{self.describe()} turning at {times} {self.rotor.speed}, {sense}"

    def _tell_axis(self) -> str:
        """Return the direction of the largest value in words. If the file gives `frame.up`, the
        axis is also called vertical or horizontal.
        """
        axis_deg = float(self.phasors.axis_deg[0])
        other = f"an axis at {degrees(axis_deg, 180)} deg"
        axis = self.kind.tell_axis(_AXES.get(round_degrees(axis_deg, 180), other))
        if self.up_deg is None:
            return axis
        from_up = round_degrees(float(wrap_degrees(axis_deg - self.up_deg, 180)), 180)
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
        elif not (verdict.matter or verdict.compensated) and self.spectra.orders.any():
            yield "All free forces and moments are negligible."
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
            yield from self._ask_for_power()

    def _ask_for_power(self) -> Iterator[str]:
        """Yield sentences on what the file has to give so that compensators can be judged."""
        yield GIVE_POWER
        if self.engine is not None and is_type_open(self.engine):
            yield GIVE_GAS

    def _prepare(self, part: Part) -> _PartInWords:
        """Return a force or moment with what its words need."""
        kind = EVERY_KIND[part.kind]
        phasors = self.spectra[part.kind].select_orders([part.order])
        rotary = self.engine is not None and self.engine.rotary
        rotor = _CYLINDERS if rotary else _CRANK
        return _PartInWords(kind, phasors, self.system.unit(kind), self.spectra.up_deg, rotor)

    # -------------------------------------------------------------- orders
    def write_order(self, finding: Finding) -> str:
        """Return the sentence on an order: the most detailed one that is not too long."""
        parts = [self._prepare(Part(finding.order, kind)) for kind in finding.large]
        joint = ", and " if any(part.has_comma for part in parts) else " and "
        directed = joint.join(part.describe_with_direction() for part in parts)
        plain = " and ".join(part.describe() for part in parts)
        shares = tell_cures(finding, parts, with_shares=True)
        cures = tell_cures(finding, parts)
        choices = [(directed, shares), (directed, cures), (plain, cures)]
        most = _MOST_WORDS
        if len(parts) > 1:  # shares are worth more than directions
            choices.insert(1, (plain, shares))
            most = _MOST_WORDS_OF_BOTH
        sentences = [_join_order(finding.order, size, cure) for size, cure in choices]
        for written in sentences:
            if len(written.split()) <= most:
                return written
        return sentences[-1]

    def write_need(self, finding: Finding, need: CompensatorNeed) -> str:
        """Return the sentence on an order that compensators may have to cancel."""
        moment = self._prepare(Part(finding.order, "moment"))
        size = size_text(float(abs(moment.phasors.y[0])), moment.unit)
        written = f"{name_order(finding.order)}: "
        if "force" in finding.large:
            force = self._prepare(Part(finding.order, "force"))
            written += f"{force.describe_with_direction()} and "
        written += self._tell_moment_about_y(size)
        if need.need is None or need.Nm_per_kW is None:
            return f"{written}."
        written += f", PRU {number(need.Nm_per_kW, 3)} N·m/kW: {_NEEDS[need.need]}"
        if need.need not in _NEEDED:
            return f"{written}."
        cure = _AT_ENDS if finding.order > 1 else f"counterweights and {_AT_ENDS}"
        return f"{written}; {cure}."

    def _tell_moment_about_y(self, size: str) -> str:
        """Return in words a moment about y, which compensators cancel: that of the forces along x.
        It is called vertical if the file says that x points up.
        """
        if self._is_x_up():
            return f"vertical moment of {size}"
        return f"{_NAMED['moment']} of {size} about y"

    def _is_x_up(self) -> bool:
        """Return whether the file says that x points up."""
        return self.spectra.up_deg is not None and stands(self.spectra.up_deg)

    def _write_higher(self, high: Sequence[Finding]) -> str:
        """Return one sentence on several orders above 2."""
        parts = [Part(finding.order, kind) for finding in high for kind in finding.large]
        largest = select_largest(parts, select_phasors(self.spectra))
        orders = name_orders([finding.order for finding in high])
        written = f"{orders}: {self._describe_parts(largest)}"
        if any(finding.cures is not None for finding in high):
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
            f"{self._prepare(part).describe()} (order {order_name(part.order)})" for part in parts
        ]
        return ", ".join(written)

    def write_compensated(self, compensated: Compensated) -> str:
        """Return sentences on an order with moment compensators."""
        system = self.system
        sentences = [self._write_vertical(compensated)]
        if compensated.across_Nm and compensated.across_Nm > NEGLIGIBLE * self.scales.moment:
            left = size_text(compensated.across_Nm, system.moment)
            sentences.append(f"Moment left: up to {left} about x.")
        if compensated.force_N and compensated.force_N > NEGLIGIBLE * self.scales.force:
            most = size_text(compensated.force_N, system.force)
            sentences.append(f"The engine's own force of this order is up to {most}.")
        return " ".join(sentences)

    def _write_vertical(self, compensated: Compensated) -> str:
        """Return a sentence on the moment about y that compensators leave, unless moments were not
        asked for, and on their force.
        """
        vertical_Nm = compensated.vertical_Nm
        unit = self.system.length
        where = join_words([f"z = {number(unit.of(z))} {unit.name}" for z in compensated.at_m])
        named = "compensators"
        verb = "introduce"
        if len(compensated.at_m) == 1:
            named = "compensator"
            verb = "introduces"
        left = "balanced by"
        if vertical_Nm:
            left = f"of {size_text(vertical_Nm, self.system.moment)} left with"
        force = "no force"
        if compensated.introduced_N:
            force = f"a force of {size_text(compensated.introduced_N, self.system.force)} by design"
        order = name_order(compensated.order)
        if vertical_Nm is None:
            return f"{order}: the {named} at {where} {verb} {force}."
        moment = "vertical moment" if self._is_x_up() else "moment about y"
        return f"{order}: {moment} {left} the {named} at {where}; the {named} {verb} {force}."

    # -------------------------------------------------------------- couple and roll
    def write_couple(self, couple: Couple) -> str:
        """Return a sentence on the largest transverse couple and its causes."""
        largest = self.spectra["couple"].select_orders([couple.order]).major[0]
        size = size_text(float(largest), self.system.moment)
        written = f"Transverse couple: up to {size} (order {order_name(couple.order)})"
        if not couple.causes:
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
        at_order = self.spectra.select_orders([rocking.order])
        if rocking.of == "inertia":
            most = self._tell_moment(at_order, ROLL)
            causes = "inertia alone"
        else:
            most = self._tell_moment(at_order, ROLL_TOTAL)
            causes = self._tell_causes_of_roll(at_order)
        order = order_name(rocking.order)
        return f"Order {order} rocks the engine most: roll of {most} ({causes})."

    def _tell_causes_of_roll(self, at_order: Spectra) -> str:
        """Return gas and inertia with their rolls in words; only the name of the one that causes
        all of it.
        """
        causes = []
        for name, kind in (("gas", GAS), ("inertia", ROLL)):
            if at_order[kind.name].major[0]:
                causes.append((name, self._tell_moment(at_order, kind)))
        if len(causes) == 1:
            return f"from {causes[0][0]}"
        return ", ".join(f"{name} {size}" for name, size in causes)

    def _tell_moment(self, at_order: Spectra, kind: Kind) -> str:
        """Return the size of a moment in words; the spectra have a single order."""
        return size_text(float(at_order[kind.name].major[0]), self.system.moment)


def _join_order(order: float, size: str, cure: str) -> str:
    """Return the sentence on an order from its parts; there may be no cure."""
    if not cure:
        return f"{name_order(order)}: {size}."
    return f"{name_order(order)}: {size}; {cure}."


# ------------------------------------------------------------------ devices
def tell_cures(
    finding: Finding, parts: Sequence[_PartInWords], *, with_shares: bool = False
) -> str:
    """Return in words what the devices of a finding cancel; empty if no devices are named.

    Args:
        finding: Order with its devices.
        parts: Large force and moment of the order.
        with_shares: Whether to state how much of force and moment each of two devices cancels.
    """
    if finding.shafts is not None:
        return f"it {tell_own_shafts(finding.shafts)}"
    if finding.cures is None:
        return ""
    if finding.order > 2:
        speed = parts[0].rotor.speed
        return f"usually left: its shafts would turn at {finding.order:g} times {speed}"
    if not finding.cures:
        return "none of its parts is worth a shaft"
    if any(cure.takes_back for cure in finding.cures):
        against = "it" if len(parts) == 1 else "them"
        return f"counterweights against {against} would take back those of the file"
    if len(finding.cures) == 1:
        return _tell_shares(finding.cures, parts)
    everything = "it" if len(parts) == 1 else "both"
    if finding.order == 2:
        further = "further " if any(cure.further for cure in finding.cures) else ""
        return f"{further}shafts at +2 and -2 cancel {everything}"
    if with_shares:
        return _tell_shares(finding.cures, parts)
    first, second = finding.cures
    return f"{name_cure(first)} and {name_cure(second)} cancel {everything}"


def _tell_shares(cures: Sequence[Cure], parts: Sequence[_PartInWords]) -> str:
    """Return in words how much each device cancels: `counterweights cancel the force and 40 N·m of
    the moment, a shaft at -1 the other 10 N·m`.
    """
    first = cures[0]
    verb = "cancel" if first.on_crank else "cancels"
    share = _tell_share(first, parts)
    if len(cures) == 1:
        return f"{name_cure(first)} {verb} {share}"
    second = cures[1]
    divided = not any(part.is_whole(cure.sense) for part in parts for cure in cures)
    if len(parts) > 1 and divided:  # units distinguish force and moment
        share = " and ".join(part.tell_vector(first.sense) for part in parts)
    rest = _tell_rest(second, parts)
    return f"{name_cure(first)} {verb} {share}, {name_cure(second)} {rest}"


def _tell_share(cure: Cure, parts: Sequence[_PartInWords]) -> str:
    """Return in words what the first device cancels."""
    turning = _list_turning(cure, parts)
    if len(turning) == len(parts) and all(part.is_whole(cure.sense) for part in turning):
        return "it" if len(parts) == 1 else "both"
    shares = []
    for part in turning:
        named = "it" if len(parts) == 1 else f"the {part.kind.name}"
        if not part.is_whole(cure.sense):
            named = f"{part.tell_vector(cure.sense)} of {named}"
        shares.append(named)
    return " and ".join(shares)


def _tell_rest(cure: Cure, parts: Sequence[_PartInWords]) -> str:
    """Return in words what the second device cancels: what the first one does not."""
    turning = _list_turning(cure, parts)
    whole = [f"the {part.kind.name}" for part in turning if part.is_whole(cure.sense)]
    rest = [part.tell_vector(cure.sense) for part in turning if not part.is_whole(cure.sense)]
    if rest:
        whole.append(f"the other {' and '.join(rest)}")
    return " and ".join(whole)


def _list_turning(cure: Cure, parts: Sequence[_PartInWords]) -> list[_PartInWords]:
    """Return the force and moment of which a part worth naming turns as the device does."""
    turning = [part for part in parts if not part.is_whole(-cure.sense)]
    return turning or [part for part in parts if part.find_vector(cure.sense)]


def tell_own_shafts(names: Sequence[str]) -> str:
    """Return in words that a half order comes from shafts of the engine, which no device cancels:
    `comes from shaft 'cam'; balance that shaft`.
    """
    if not names:
        return "comes from shafts of the file; balance these shafts"
    quoted = join_words([_quote_shaft(name) for name in names])
    if len(names) > 1:
        return f"comes from shafts {quoted}; balance these shafts"
    return f"comes from shaft {quoted}; balance that shaft"


def _quote_shaft(name: str) -> str:
    """Return the number of a shaft without a name (`shaft 2`), or its name in quotes."""
    if name.startswith("shaft "):
        return name.removeprefix("shaft ")
    return f"'{name}'"


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
    """Return in words the numbers of some orders: their range or their count if they are many."""
    if len(orders) > _MOST_NAMED:
        first = min(orders)
        last = max(orders)
        if last - first == len(orders) - 1:
            return f"orders {order_name(first)} to {order_name(last)}"
        return f"{len(orders)} orders, the highest {order_name(last)}"
    names = join_words([order_name(order) for order in orders])
    return f"order {names}" if len(orders) == 1 else f"orders {names}"
