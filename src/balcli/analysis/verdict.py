"""Judge free forces and moments: which orders matter, and which devices would cancel them.

The verdict is a record without words, and it repeats no size that the orders have. Documents
contain it as it is, and `analysis.verdict_words` puts it into words. The HTML page computes the
same records by itself.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.phasors import Phasors
from ..engine.engine import Engine
from ..engine.figures import find_first_largest
from ..file.fields import order_number
from ..forces.spectrum import Spectra
from ..limits import SMALL
from ..sizing.residual import Scales, is_small
from .compensator_need import CompensatorNeed, find_needs
from .couple import Couple, find_couple

VectorKind = Literal["force", "moment"]  # names in `forces.kinds`
BalancedKind = Literal["force", "moment", "couple"]
Vectors = Mapping[VectorKind, Phasors]

WITH_CRANK = 1
AGAINST_CRANK = -1
SENSES = (WITH_CRANK, AGAINST_CRANK)  # directions of rotation

_ROUNDING = 1e-9  # a smaller share of the vectors that should cancel is rounding


class Cure(NamedTuple):
    """A device that would cancel the vectors of an order that turn in one direction.

    Attributes:
        ratio: Speed of the device divided by crank speed; negative: it turns against the crank.
        on_crank: Whether a crank of the engine turns so, and can carry weights in place of a shaft.
        further: Whether the engine already has a device that turns so.
    """

    ratio: int
    on_crank: bool = False
    further: bool = False

    @property
    def sense(self) -> int:
        """Direction of rotation: WITH_CRANK or AGAINST_CRANK."""
        return WITH_CRANK if self.ratio > 0 else AGAINST_CRANK


class Finding(NamedTuple):
    """An order whose force or moment is not small.

    Attributes:
        order: Order.
        large: Which of force and moment are not small.
        cures: Devices that would cancel their large vectors; none at half orders and at uneven
            speed.
    """

    order: float
    large: tuple[VectorKind, ...]
    cures: tuple[Cure, ...] = ()


class Compensated(NamedTuple):
    """An order with moment compensators.

    Attributes:
        order: Order.
        at_m: Positions of the compensators.
        introduced_N: Force that the compensators introduce by design; 0 if they introduce none.
        vertical_Nm: Vertical moment that is left, 0 if it is balanced; left out if not known.
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
        of: What causes the roll: gas and inertia in total.
        order: Order of the largest roll; null if no order has a roll.
    """

    of: Literal["total"]
    order: float | None


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What the free forces and moments of an engine amount to. Sizes are those of the orders.

    Attributes:
        matter: Orders with a force or moment that is not small, except compensated orders.
        compensated: Orders with moment compensators.
        balanced: Balanced orders that are worth naming.
        balanced_kinds: Kinds that are balanced at all these orders.
        small: The largest small force and the largest small moment.
        uneven: Whether the speed is uneven. No device is named then, because most of an order may
            come from another order, and would vanish with that order.
        couple: The largest transverse couple; left out if it is negligible or not computed.
        rocking: The largest roll; left out if no roll with gas was computed.
        compensators: Orders 1 and 2 whose vertical moment is not small, with the need of
            compensators; left out unless the engine is a two-stroke engine with crossheads.
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
            if both its vectors (with the crank and against it) are below this share.
        engine: Engine with these spectra; None: one crank without devices at steady speed.
    """
    vectors = list_vectors(spectra)
    if not vectors:
        return Verdict()
    devices = () if engine is None else engine.every_device
    compensators = [device for device in devices if device.compensates]
    large = _find_large(vectors, scales, small)
    needs = find_needs(vectors.get("moment"), scales, small, engine)
    matter: list[Finding] = []
    compensated: list[Compensated] = []
    balanced: list[float] = []
    small_parts: list[Part] = []
    for row, order in enumerate(map(order_number, spectra.orders)):
        if order <= 0:
            continue
        pairs = [device for device in compensators if device.order == order]
        if engine is not None and pairs:
            compensated.append(_describe_compensated(vectors, row, pairs, engine, scales))
            continue
        parts = [Part(order, kind) for kind in vectors]
        large_parts = [part for part in parts if large[part]]
        if large_parts:
            finding = _find_cures(large_parts, large, engine)
            if needs is not None and order <= 2:  # compensators take the place of shafts
                finding = finding._replace(cures=())
            matter.append(finding)
        elif all(phasors.balanced[row] for phasors in vectors.values()):
            balanced.append(order)
        small_parts += [part for part in parts if not large[part]]
    largest_small = select_largest(small_parts, vectors)
    compensated_orders = [order.order for order in compensated]
    if needs is not None:
        needs = tuple(need for need in needs if need.order not in compensated_orders)
    named = bool(matter or compensated)
    listed = _choose_balanced(balanced, others_named=named, some_small=bool(largest_small))
    return Verdict(
        matter=tuple(matter),
        compensated=tuple(compensated),
        balanced=listed,
        balanced_kinds=_list_balanced_kinds(spectra, listed),
        small=largest_small,
        uneven=engine is not None and bool(engine.ripple),
        couple=None if engine is None else find_couple(spectra.couple, scales, engine),
        rocking=_find_rocking(spectra),
        compensators=needs,
    )


def list_vectors(spectra: Spectra) -> dict[VectorKind, Phasors]:
    """Return force and moment by name, whichever the spectra have."""
    vectors: dict[VectorKind, Phasors] = {}
    if spectra.force is not None:
        vectors["force"] = spectra.force
    if spectra.moment is not None:
        vectors["moment"] = spectra.moment
    return vectors


# ------------------------------------------------------------------ what is large
def _find_large(vectors: Vectors, scales: Scales, small: float) -> dict[Part, tuple[int, ...]]:
    """Return, for the force and the moment of each order, the directions in which its large vectors
    turn; none if it is small.
    """
    of_one = scales._asdict()
    large: dict[Part, tuple[int, ...]] = {}
    for kind, phasors in vectors.items():
        least = small * of_one[kind]
        for row, order in enumerate(phasors.orders.tolist()):
            large[Part(order, kind)] = _find_senses(phasors, row, least)
    return large


def _find_senses(phasors: Phasors, row: int, least: float) -> tuple[int, ...]:
    """Return the directions in which the vectors of an order turn that are not small."""
    sizes = {WITH_CRANK: phasors.forward[row], AGAINST_CRANK: phasors.backward[row]}
    return tuple(sense for sense, size in sizes.items() if not is_small(float(abs(size)), least))


def select_largest(parts: Iterable[Part], vectors: Vectors) -> tuple[Part, ...]:
    """Return the largest force and the largest moment among some parts, if they are not balanced.

    Args:
        parts: Forces and moments of orders.
        vectors: Force and moment of all orders by name.
    """
    largest: dict[VectorKind, Part] = {}
    sizes: dict[VectorKind, float] = {}
    for part in parts:
        phasors = vectors[part.kind]
        row = int(np.searchsorted(phasors.orders, part.order))
        size = float(phasors.major[row])
        if size > sizes.get(part.kind, 0.0):
            largest[part.kind] = part
            sizes[part.kind] = size
    return tuple(largest.values())


# ------------------------------------------------------------------ what would cancel it
def _find_cures(
    parts: Sequence[Part], large: Mapping[Part, Collection[int]], engine: Engine | None
) -> Finding:
    """Return the finding on an order, with a device for each direction of rotation of its large
    vectors.

    Args:
        parts: Large force and moment of the order.
        large: Directions in which their large vectors turn.
        engine: Engine, or None as for `judge`.
    """
    order = parts[0].order
    kinds = tuple(part.kind for part in parts)
    if order % 1 or (engine is not None and engine.ripple):
        return Finding(order, kinds)
    turning = {1}
    devices: tuple[Device, ...] = ()
    if engine is not None:
        turning = {crank.ratio for crank in engine.cranks}
        devices = engine.every_device
    cures = []
    for sense in SENSES:
        if not any(sense in large[part] for part in parts):
            continue
        ratio = int(order) * sense
        further = any(_turns(device, ratio) for device in devices)
        cures.append(Cure(ratio, on_crank=ratio in turning, further=further))
    return Finding(order, kinds, tuple(cures))


def _turns(device: Device, ratio: int) -> bool:
    """Return whether a device turns at this ratio; a slider does not turn."""
    if device.kind is DeviceKind.SLIDER or device.order != abs(ratio):
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
    kinds: list[BalancedKind] = [*list_vectors(spectra)]
    couple = spectra.couple
    if couple is not None and couple.balanced[np.isin(couple.orders, [*orders])].all():
        kinds.append("couple")
    return tuple(kinds)


# ------------------------------------------------------------------ compensators and roll
def _describe_compensated(
    vectors: Vectors, row: int, pairs: Sequence[Device], engine: Engine, scales: Scales
) -> Compensated:
    """Return what the moment compensators of an order leave, and the force that they introduce.

    Args:
        vectors: Force and moment of all orders by name.
        row: Index of the order.
        pairs: Compensators of the order.
        engine: Engine with the compensators.
        scales: Force, moment and roll of one cylinder.
    """
    order = pairs[0].order
    square = (order * float(engine.omega)) ** 2
    forward = square * sum(complex(device.forward) for device in pairs)
    backward = square * sum(complex(device.backward) for device in pairs)
    introduced = abs(forward + backward.conjugate())
    if introduced <= _ROUNDING * square * sum(abs(complex(device.forward)) for device in pairs):
        introduced = 0.0
    found = Compensated(
        order=order,
        at_m=tuple(sorted({float(device.z) for device in pairs})),
        introduced_N=introduced,
    )
    if "moment" in vectors:
        moment = vectors["moment"]
        vertical = float(abs(moment.y[row]))  # forces along x
        noise = float(np.broadcast_to(moment.noise, moment.y.shape)[row])
        if vertical <= max(noise, _ROUNDING * scales.moment):
            vertical = 0.0
        found = found._replace(vertical_Nm=vertical, across_Nm=float(abs(moment.x[row])))
    if "force" in vectors:
        force = vectors["force"]
        ahead = abs(force.forward[row] - forward)
        against = abs(force.backward[row] - backward)
        found = found._replace(force_N=float(ahead + against))
    return found


def _find_rocking(spectra: Spectra) -> Rocking | None:
    """Return the order with the largest roll of gas and inertia; None if it is not known."""
    roll = spectra.roll_total
    if roll is None or spectra.gas is None or spectra.roll is None:
        return None
    sizes = np.where(roll.orders > 0, roll.major, 0.0)
    if not sizes.any():
        return Rocking("total", None)
    row = int(find_first_largest(sizes))
    return Rocking("total", order_number(roll.orders[row]))
