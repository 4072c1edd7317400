"""Judge free forces and moments: which orders matter, and which devices would cancel them.

The verdict is a record without words, and it repeats no size that the orders have. Documents
contain it as it is, and `analysis.verdict_words` puts it into words. The HTML page computes the
same records by itself.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.phasors import Phasors
from ..engine.engine import Engine
from ..engine.figures import find_first_largest
from ..engine.half_orders import list_shafts_of_order
from ..file.fields import order_number
from ..forces.spectrum import Spectra
from ..limits import SMALL
from ..show.sheet import NEGLIGIBLE
from ..sizing.ladder import would_take_back
from ..sizing.residual import ResidualPart, Scales, is_small
from .compensator_need import CompensatorNeed, find_needs
from .couple import Couple, find_couple

VectorKind = Literal["force", "moment"]  # names in `forces.kinds`
BalancedKind = Literal["force", "moment", "couple"]
PhasorsByKind = Mapping[VectorKind, Phasors]

WITH_CRANK = 1
AGAINST_CRANK = -1
SENSES = (WITH_CRANK, AGAINST_CRANK)  # directions of rotation

_ROUNDING = 1e-9  # a smaller share of the vectors that should cancel is rounding
_ROCKS = 0.25  # share of one cylinder's first-order force times crank radius that rocks an engine


class Cure(NamedTuple):
    """A device that would cancel the vectors of an order that turn in one direction.

    Attributes:
        ratio: Speed of the device divided by crank speed; negative: it turns against the crank.
        on_crank: Whether a crank of the engine turns so, and can carry weights in place of a shaft.
        further: Whether the engine already has a device that turns so.
        takes_back: True if counterweights would work against those of the file, which settles the
            order in another way; else left out.
    """

    ratio: int
    on_crank: bool = False
    further: bool = False
    takes_back: bool | None = None

    @property
    def sense(self) -> int:
        """Direction of rotation: WITH_CRANK or AGAINST_CRANK."""
        return WITH_CRANK if self.ratio > 0 else AGAINST_CRANK


class Finding(NamedTuple):
    """An order whose force or moment is not small.

    Attributes:
        order: Order.
        large: Which of force and moment are not small.
        cures: Devices that would cancel their large vectors; none if each of their vectors is
            small; left out at half orders and at uneven speed, where compensators take the place
            of shafts, and where only a shaft would cancel them but the engine is that of a
            locomotive, which has no room for one.
        shafts: At half orders, the shafts that cause it and have to be balanced themselves; else
            left out.
    """

    order: float
    large: tuple[VectorKind, ...]
    cures: tuple[Cure, ...] | None = None
    shafts: tuple[str, ...] | None = None


class Compensated(NamedTuple):
    """An order with moment compensators.

    Attributes:
        order: Order.
        at_m: Positions of the compensators.
        introduced_N: Force that the compensators introduce by design; 0 if they introduce none.
        vertical_Nm: Moment about y that is left, vertical in ships' engines; 0 if it is
            balanced; left out if not known.
        across_Nm: Largest moment about x that is left; left out if not known.
        force_N: Largest force of the engine without the compensators; left out if not known.
    """

    order: float
    at_m: tuple[float, ...]
    introduced_N: float
    vertical_Nm: float | None = None
    across_Nm: float | None = None
    force_N: float | None = None


class Part(NamedTuple):
    """The force or moment of an order.

    Attributes:
        order: Order.
        kind: Force or moment.
    """

    order: float
    kind: VectorKind


class Rocking(NamedTuple):
    """The order that rocks the engine most.

    Attributes:
        of: What causes the roll: inertia alone, or inertia and gas in total.
        order: Order of the largest roll; null if no order has a roll.
    """

    of: Literal["inertia", "total"]
    order: float | None


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What the free forces and moments of an engine amount to. Sizes are those of the orders.

    Attributes:
        matter: Orders with a force or moment that is not small, except compensated orders.
        compensated: Orders with moment compensators.
        balanced: Balanced orders that are worth naming.
        balanced_kinds: Kinds that are balanced at all these orders.
        small: The largest small force and the largest small moment that are not negligible.
        uneven: Whether the speed is uneven. No device is named then, because most of an order may
            come from another order, and would vanish with that order.
        couple: The largest transverse couple; left out if it is below 1 % of one cylinder's
            first-order force times the crank radius, or not computed.
        rocking: The largest roll; left out if it was not computed, and without gas if it is below a
            quarter of one cylinder's first-order force times the crank radius.
        compensators: Orders 1 and 2 whose moment about y is not small, with the need of
            compensators; left out unless the engine is a ship's two-stroke engine.
    """

    matter: tuple[Finding, ...] = ()
    compensated: tuple[Compensated, ...] = ()
    balanced: tuple[float, ...] = ()
    balanced_kinds: tuple[BalancedKind, ...] = ()
    small: tuple[Part, ...] = ()
    uneven: bool = False
    couple: Couple | None = None
    rocking: Rocking | None = None
    compensators: tuple[CompensatorNeed, ...] | None = None


def judge(
    spectra: Spectra,
    scales: Scales,
    *,
    small: float = SMALL,
    engine: Engine | None = None,
) -> Verdict:
    """Return the verdict on free forces and moments.

    Args:
        spectra: Spectra to judge, without moments if they are not known.
        scales: Force, moment and roll of one cylinder; if a scale is 0, no vector is small.
        small: Share of one cylinder's force or moment. The force or moment of an order is small
            if its largest value is below this share.
        engine: Engine with these spectra; None: one crank without devices at steady speed.
    """
    by_kind = select_phasors(spectra)
    if not by_kind:
        return Verdict()
    devices = () if engine is None else engine.every_device
    every_compensator = [device for device in devices if device.compensates]
    large = _find_large(by_kind, scales, small)
    needs = find_needs(by_kind.get("moment"), scales, small, engine)
    matter: list[Finding] = []
    compensated: list[Compensated] = []
    balanced: list[float] = []
    small_parts: list[Part] = []
    for row, order in enumerate(map(order_number, spectra.orders)):
        if order <= 0:
            continue
        compensators = [device for device in every_compensator if device.order == order]
        if engine is not None and compensators:
            compensated.append(_describe_compensated(by_kind, row, compensators, engine, scales))
            continue
        kinds = tuple(kind for kind in by_kind if Part(order, kind) in large)
        if kinds:
            due = {sense for kind in kinds for sense in large[Part(order, kind)]}
            cures = _find_cures(order, due, engine)
            if cures and engine is not None:
                cures = _mark_taken_back(cures, by_kind, row, engine)
            if needs is not None and order <= 2:  # compensators take the place of shafts
                cures = None
            matter.append(Finding(order, kinds, cures, _find_causes(order, engine)))
        elif all(phasors.balanced[row] for phasors in by_kind.values()):
            balanced.append(order)
        small_parts += [Part(order, kind) for kind in by_kind if kind not in kinds]
    largest_small = select_largest(small_parts, by_kind)
    compensated_orders = [part.order for part in compensated]
    if needs is not None:
        needs = tuple(need for need in needs if need.order not in compensated_orders)
    named = bool(matter or compensated)
    listed = _choose_balanced(balanced, others_named=named, some_small=bool(largest_small))
    return Verdict(
        matter=tuple(matter),
        compensated=tuple(compensated),
        balanced=listed,
        balanced_kinds=_list_balanced_kinds(spectra, listed),
        small=_drop_negligible(largest_small, by_kind, scales),
        uneven=engine is not None and bool(engine.ripple),
        couple=None if engine is None else find_couple(spectra.couple, scales, engine),
        rocking=_find_rocking(spectra, scales, engine),
        compensators=needs,
    )


def select_phasors(spectra: Spectra) -> dict[VectorKind, Phasors]:
    """Return force and moment by name, whichever the spectra have."""
    by_kind: dict[VectorKind, Phasors] = {}
    if spectra.force is not None:
        by_kind["force"] = spectra.force
    if spectra.moment is not None:
        by_kind["moment"] = spectra.moment
    return by_kind


# ------------------------------------------------------------------ what is large
def _find_large(
    by_kind: PhasorsByKind, scales: Scales, small: float
) -> dict[Part, tuple[int, ...]]:
    """Return the forces and moments of orders that are not small, and for each the directions in
    which its large vectors turn.

    A force or moment is judged by its largest value, which is the figure that tables print. Its two
    vectors are judged as the ladder judges them, each by itself. So both may be small although the
    force is not. The HTML page follows the same rule.
    """
    of_one = scales._asdict()
    large: dict[Part, tuple[int, ...]] = {}
    for kind, phasors in by_kind.items():
        least = small * of_one[kind]
        for row, order in enumerate(phasors.orders.tolist()):
            if not is_small(float(phasors.major[row]), least):
                large[Part(order, kind)] = _find_senses(phasors, row, least)
    return large


def _find_senses(phasors: Phasors, row: int, least: float) -> tuple[int, ...]:
    """Return the directions in which the vectors of an order turn that are not small."""
    sizes = {WITH_CRANK: phasors.forward[row], AGAINST_CRANK: phasors.backward[row]}
    return tuple(sense for sense, size in sizes.items() if not is_small(float(abs(size)), least))


def select_largest(parts: Iterable[Part], by_kind: PhasorsByKind) -> tuple[Part, ...]:
    """Return the largest force and the largest moment among some parts, if they are not balanced.

    Args:
        parts: Forces and moments of orders.
        by_kind: Force and moment of all orders by name.
    """
    largest: dict[VectorKind, Part] = {}
    sizes: dict[VectorKind, float] = {}
    for part in parts:
        size = _find_size(part, by_kind)
        if size > sizes.get(part.kind, 0.0):
            largest[part.kind] = part
            sizes[part.kind] = size
    return tuple(largest.values())


def _drop_negligible(
    parts: Iterable[Part], by_kind: PhasorsByKind, scales: Scales
) -> tuple[Part, ...]:
    """Return the parts that are not negligible compared with one cylinder; arguments as for
    `select_largest`.
    """
    of_one = scales._asdict()
    return tuple(
        part
        for part in parts
        if not is_small(_find_size(part, by_kind), NEGLIGIBLE * of_one[part.kind])
    )


def _find_size(part: Part, by_kind: PhasorsByKind) -> float:
    """Return the largest value of a force or moment."""
    phasors = by_kind[part.kind]
    row = int(np.searchsorted(phasors.orders, part.order))
    return float(phasors.major[row])


# ------------------------------------------------------------------ what would cancel it
def _find_cures(
    order: float, due: Collection[int], engine: Engine | None
) -> tuple[Cure, ...] | None:
    """Return a device for each direction in which a large vector of an order turns; None if no
    device turns so, or if devices are not named. A locomotive can have weights, but no shafts.

    Args:
        order: Order.
        due: Directions in which the large vectors turn.
        engine: Engine, or None as for `judge`.
    """
    if order % 1 or (engine is not None and engine.ripple):
        return None
    crank_ratios = {1}
    devices: tuple[Device, ...] = ()
    if engine is not None:
        crank_ratios = {crank.ratio for crank in engine.cranks}
        devices = engine.every_device
    cures = []
    for sense in SENSES:
        if sense in due:
            ratio = int(order) * sense
            further = any(_turns(device, ratio) for device in devices)
            cures.append(Cure(ratio, on_crank=ratio in crank_ratios, further=further))
    if engine is not None and engine.of_locomotive:
        return tuple(cure for cure in cures if cure.on_crank) or None
    return tuple(cures)


def _find_causes(order: float, engine: Engine | None) -> tuple[str, ...] | None:
    """Return the names of the shafts that cause a half order; None for whole orders and without
    such shafts.
    """
    if order % 1 == 0 or engine is None:
        return None
    return tuple(list_shafts_of_order(engine, order)) or None


def _mark_taken_back(
    cures: tuple[Cure, ...], by_kind: PhasorsByKind, row: int, engine: Engine
) -> tuple[Cure, ...]:
    """Return the cures of an order; counterweights that would take back those of the file are
    marked.

    Args:
        cures: Devices that would cancel the order.
        by_kind: Force and moment of all orders by name.
        row: Index of the order.
        engine: Engine with its counterweights.
    """
    cancelled: dict[ResidualPart, complex] = {}
    for cure in cures:
        if not cure.on_crank:
            continue
        for kind, phasors in by_kind.items():
            vectors_of_sense = phasors.forward if cure.sense == WITH_CRANK else phasors.backward
            cancelled[ResidualPart(kind, cure.sense)] = complex(vectors_of_sense[row])
    if not would_take_back(engine, cancelled):
        return cures
    return tuple(cure._replace(takes_back=cure.on_crank or None) for cure in cures)


def _turns(device: Device, ratio: int) -> bool:
    """Return whether a device turns at this ratio to balance the engine; a slider does not turn,
    and coupling rods drive an axle.
    """
    balances = device.kind is not DeviceKind.SLIDER and not device.is_coupling
    if not balances or device.order != abs(ratio):
        return False
    return bool(np.any(device.forward if ratio > 0 else device.backward))


# ------------------------------------------------------------------ what is balanced
def _choose_balanced(
    balanced: Sequence[float], *, others_named: bool, some_small: bool
) -> tuple[float, ...]:
    """Return the balanced orders that are worth naming: orders 1 and 2; others only if no order is
    named otherwise, and orders above 2 only if there is nothing else to say.
    """
    usual = tuple(order for order in balanced if order in (1, 2))
    if usual or others_named:
        return usual
    low = tuple(order for order in balanced if order < 2)
    if low or some_small:
        return low
    return tuple(balanced)


def _list_balanced_kinds(spectra: Spectra, orders: Collection[float]) -> tuple[BalancedKind, ...]:
    """Return the kinds that are balanced at these orders, all of which have balanced vectors."""
    if not orders:
        return ()
    kinds: list[BalancedKind] = [*select_phasors(spectra)]
    couple = spectra.couple
    if couple is not None and couple.balanced[np.isin(couple.orders, [*orders])].all():
        kinds.append("couple")
    return tuple(kinds)


# ------------------------------------------------------------------ compensators and roll
def _describe_compensated(
    by_kind: PhasorsByKind, row: int, compensators: Sequence[Device], engine: Engine, scales: Scales
) -> Compensated:
    """Return what the moment compensators of an order leave, and the force that they introduce.

    Args:
        by_kind: Force and moment of all orders by name.
        row: Index of the order.
        compensators: Compensators of the order.
        engine: Engine with the compensators.
        scales: Force, moment and roll of one cylinder.
    """
    order = compensators[0].order
    square = (order * float(engine.omega)) ** 2
    forward = square * sum(complex(device.forward) for device in compensators)
    backward = square * sum(complex(device.backward) for device in compensators)
    introduced = abs(forward + backward.conjugate())
    all_forward = square * sum(abs(complex(device.forward)) for device in compensators)
    if introduced <= _ROUNDING * all_forward:
        introduced = 0.0
    compensated = Compensated(
        order=order,
        at_m=tuple(sorted({float(device.z) for device in compensators})),
        introduced_N=introduced,
    )
    if "moment" in by_kind:
        moment = by_kind["moment"]
        vertical = float(abs(moment.y[row]))  # forces along x
        noise = float(np.broadcast_to(moment.noise, moment.y.shape)[row])
        if vertical <= max(noise, _ROUNDING * scales.moment):
            vertical = 0.0
        compensated = compensated._replace(
            vertical_Nm=vertical, across_Nm=float(abs(moment.x[row]))
        )
    if "force" in by_kind:
        force = by_kind["force"]
        ahead = abs(force.forward[row] - forward)
        against = abs(force.backward[row] - backward)
        compensated = compensated._replace(force_N=float(ahead + against))
    return compensated


def _find_rocking(spectra: Spectra, scales: Scales, engine: Engine | None) -> Rocking | None:
    """Return the order with the largest roll, with gas if the engine has gas; None if it is not
    known, or if it is small and without gas.

    Args:
        spectra: Spectra with the roll.
        scales: Force, moment and roll of one cylinder.
        engine: Engine, or None for an engine without gas.
    """
    if spectra.roll_total is not None and spectra.gas is not None and spectra.roll is not None:
        return Rocking("total", _find_largest_order(spectra.roll_total))
    if spectra.roll is None or (engine is not None and engine.gas is not None):
        return None
    order = _find_largest_order(spectra.roll)
    if order is None:
        return None
    (size,) = spectra.roll.select_orders([order]).major
    if is_small(float(size), _ROCKS * scales.roll):
        return None
    return Rocking("inertia", order)


def _find_largest_order(roll: Phasors) -> float | None:
    """Return the order with the largest amplitude; None if there is none."""
    sizes = np.where(roll.orders > 0, roll.major, 0.0)
    if not sizes.any():
        return None
    row = int(find_first_largest(sizes))
    return order_number(roll.orders[row])
