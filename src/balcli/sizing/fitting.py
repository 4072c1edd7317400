"""Size devices order by order by least squares, and explain them in sentences.

For each order, devices are fitted to the residual that all earlier devices leave. A reason is one
sentence: it names the part that a device cancels, and why a simpler device cannot cancel it. Sizes
are not in the reasons but in the tables, which use the units of the reader.

The effect of a device is linear in its complex unbalance (docs/theory.md), so all sizing is
weighted linear least squares. Take a shaft that turns with the crank at n times crank speed omega,
with the unbalance u at z along the crank and at `p = x + iy` from the point of reference, whose z
is z_ref. Divided by `n^2 omega^2`, the shaft adds `u` to the free force, `(z - z_ref) u` to the
moment divided by i, and at the crank angle theta `Im(conj(p) u e^{in theta})` to the roll. A slider
adds to both rotating vectors: the one that turns with the crank and the one that turns against it.
A *slot* is a place and kind for a device. A *part* is one rotating vector of force or moment, or
the roll. A scheme chooses slots and the parts to cancel.
"""

import math
from collections.abc import Iterable, Sequence
from typing import Literal, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ..core import least_squares
from ..core.cylinders import Device, DeviceKind
from ..core.phasors import EPS, Array, unit
from ..core.records import Node
from ..engine.devices import build_device
from ..engine.engine import Engine, Placed
from ..engine.figures import place_in_plane
from ..errors import BalcliError
from ..file.model import Counterweight, Shaft, Slider
from ..forces.kinds import ROLL_TOTAL
from ..forces.spectrum import compute_spectra
from .planes import (
    SAME_PLACE,
    DeviceTable,
    as_millimetres,
    find_planes,
    measure_direction,
    takes_moment,
)
from .remedy import Remedy, fit_devices
from .residual import (
    FORCE,
    FORWARD,
    FORWARD_FORCE,
    FORWARD_MOMENT,
    MOMENT,
    ROLL,
    ReferencePoint,
    Residual,
    ResidualPart,
    find_residual,
    hold_steady,
    list_parts,
    tell_sense,
)

_ROTATING = "Weights opposite the rotating mass of throws and rods"
_LEFT_OF = {  # keys of details, and the parts whose remaining size each detail states
    "force_left_N": FORCE,
    "moment_left_Nm": MOMENT,
    "force_with_crank_left_N": (FORWARD_FORCE,),
    "moment_with_crank_left_Nm": (FORWARD_MOMENT,),
}
LEFT = 1e-12  # a cancelled part may remain up to this share of its size


class Slot(NamedTuple):
    """Place and kind of a device that may be fitted.

    Attributes:
        kind: Kind of the device.
        order: Speed of the device over crank speed.
        sense: Direction of rotation: 1 with the crank, -1 against it; 0 for a slider.
        z: Position along the crank, m.
        place: Position x + iy in the plane, m.
        direction_deg: Direction of a slider's path, from x.
        role: Role of a shaft: "balancer" or "compensator".
        carrier: For geared engines, the engine whose crank carries the counterweight.
    """

    kind: Literal["counterweight", "shaft", "slider"]
    order: int
    sense: int
    z: float
    place: complex = 0j
    direction_deg: float = 0.0
    role: str = "balancer"
    carrier: Placed | None = None

    @classmethod
    def on_crank(cls, crank: Placed, z: float) -> Self:
        """Return the slot of a counterweight on the crank of a single engine or a geared engine."""
        if not crank.name:
            return cls("counterweight", 1, 1, z)
        place = complex(place_in_plane(*crank.at_m[:2]))
        return cls("counterweight", 1, crank.ratio, z, place, carrier=crank)

    def make_device(self, unbalance: complex) -> Device:
        """Return the device of this unbalance (kg m) in this slot, as rotating vectors."""
        if self.carrier is not None:
            both = (unbalance, 0j) if self.sense > 0 else (0j, unbalance)
            return Device(1, *both, self.place, self.z, DeviceKind.COUNTERWEIGHT)
        return build_device(self.make_table(unbalance, 0.0), 0.0)

    def make_table(self, unbalance: complex, first_axis_deg: float) -> DeviceTable:
        """Return the device of this unbalance in this slot as a table of the engine file.

        Args:
            unbalance: Unbalance, kg m; its direction at crank angle 0 counts from x.
            first_axis_deg: Direction of cylinder 1's crank pin, deg, from which the angle of a
                counterweight counts.
        """
        x, y, z = map(as_millimetres, (self.place.real, self.place.imag, self.z))
        values: Node = {"position": z}
        if self.kind == "counterweight":
            if self.carrier is not None:
                first_axis_deg = float(self.carrier.engine.first_axis_deg)
                unbalance = self.carrier.find_own_unbalance(unbalance)
                values["engine"] = self.carrier.name
            values["unbalance"] = abs(unbalance) * 1e6
            values["angle"] = measure_direction(unbalance, first_axis_deg)
            return Counterweight.model_construct(**values)
        values["unbalance"] = abs(unbalance) * 1e6
        values["angle"] = measure_direction(unbalance)
        values["at"] = (x, y)
        if self.kind == "shaft":
            ratio = self.sense * self.order
            return Shaft.model_construct(ratio=ratio, role=self.role, **values)
        return Slider.model_construct(order=self.order, direction=self.direction_deg, **values)


class Fit(NamedTuple):
    """Solution of the least squares problem.

    Attributes:
        unbalances: Unbalance for each slot, kg m.
        condition: Condition number of the weighted system; infinite if the slots cannot produce
            some combination of the parts.
        left: Share of the parts that the devices leave.
    """

    unbalances: tuple[complex, ...]
    condition: float
    left: float


def find_effect(
    device: Device, parts: Sequence[ResidualPart], reference: ReferencePoint
) -> NDArray[np.complex128]:
    """Return the effect of a device on each part, shape (parts,), in units of `Residual.parts`."""
    place = device.place - reference.place
    z = device.z - reference.z
    vectors = {
        1: device.forward,
        -1: device.backward,
        0: -1j * (np.conj(place) * device.forward - place * np.conj(device.backward)),
    }
    effects = []
    for part in parts:
        effect = vectors[part.sense]
        effects.append(z * effect if part.kind == "moment" else effect)
    return np.array(effects, complex)


def find_effects(
    devices: Iterable[Device], parts: Sequence[ResidualPart], reference: ReferencePoint
) -> Array:
    """Return the effects of devices, real and imaginary parts in turn, shape (2 x parts,
    devices).
    """
    return np.array([find_effect(one, parts, reference) for one in devices]).view(float).T


def size_unbalances(
    slots: Sequence[Slot], residual: Residual, parts: Sequence[ResidualPart], least_arm: float = 0.0
) -> Fit:
    """Return the smallest unbalances that cancel these parts as well as the slots can.

    Before the least squares, moments and roll are divided by the longest lever arm of a slot. Parts
    that can be cancelled leave a residual of a few ulp.

    Args:
        slots: Slots for devices.
        residual: Residual of the order of the slots.
        parts: Parts to cancel.
        least_arm: Moments and roll are divided by at least this arm, m.
    """
    weights = _weigh(slots, residual, parts, least_arm)
    devices = [slot.make_device(u) for slot in slots for u in (1 + 0j, 1j)]
    matrix = find_effects(devices, parts, residual.reference)
    target = -np.array([residual.parts[part] for part in parts], complex)
    solution = least_squares.solve(matrix, target.view(float), np.repeat(weights, 2))
    rounding = 4 * EPS * np.abs(solution.x).max()
    x = np.where(np.abs(solution.x) <= rounding, 0, solution.x)
    return Fit(tuple(complex(a, b) for a, b in x.reshape(-1, 2)), solution.condition, solution.left)


def solve_exactly(
    slots: Sequence[Slot], residual: Residual, parts: Sequence[ResidualPart], reason: str
) -> Fit:
    """Return unbalances that cancel these parts completely, up to rounding.

    Raises:
        BalcliError: The slots cannot cancel the parts (the message is `reason`), or are too close
            to each other.
    """
    fit = size_unbalances(slots, residual, parts)
    weights = _weigh(slots, residual, parts)
    size = float(max(weights * [abs(residual.parts[part]) for part in parts]))
    noise = float(max(weights * [residual.noise[part] for part in parts]))
    if fit.condition == np.inf and fit.left * size > noise:
        raise BalcliError(reason)
    largest = max(map(abs, fit.unbalances))
    left = fit.left * size + 2 * EPS * largest
    if left > max(noise, LEFT * size):
        raise BalcliError(
            f"order {residual.order}: unbalances of {largest * 1e6:.3g} g mm would work against "
            f"each other, leaving {left / size:.1g} of force or moment; choose planes farther apart"
        )
    if len(slots) == 1:  # least squares would leave rounding in the force
        return fit._replace(unbalances=size_unbalances(slots, residual, parts[:1]).unbalances)
    return fit


def _weigh(
    slots: Sequence[Slot], residual: Residual, parts: Sequence[ResidualPart], least_arm: float = 0.0
) -> NDArray[np.float64]:
    """Return the weights of the parts: 1 for forces; for moments and roll the inverse of the
    longest arm of a slot about the point of reference (at least `least_arm`; 1 m if all arms are
    0).
    """
    place, z = residual.reference
    arms = [max(abs(slot.z - z), abs(slot.place - place)) for slot in slots]
    arm = max(least_arm, max(arms) or 1.0)
    return np.array([1.0 if part.kind == "force" else 1 / arm for part in parts])


class Fitting(NamedTuple):
    """An engine at steady speed without new devices, and the devices fitted so far."""

    engine: Engine
    remedy: Remedy

    @classmethod
    def start(cls, engine: Engine, scheme: str, order: int | None = None) -> Self:
        """Return a fitting without devices. `order` is the order that the scheme balances if it has
        only one.
        """
        return cls(hold_steady(engine), Remedy(scheme, order))

    def find_residual(self, order: int) -> Residual:
        """Return the residual of an order with the devices so far."""
        return find_residual(fit_devices(self.engine, self.remedy), order)

    def add(self, slots: Sequence[Slot], unbalances: Iterable[complex], reason: str) -> Self:
        """Return the fitting with devices of these unbalances (kg m) in these slots. Devices of
        zero unbalance are omitted, and so are counterweights that are negligible against the moving
        masses.
        """
        first_axis_deg = float(self.engine.first_axis_deg)
        negligible = LEFT * sum(_sum_unbalances(crank.engine) for crank in self.engine.cranks)
        tables = []
        for slot, unbalance in zip(slots, unbalances, strict=True):
            least = negligible if slot.kind == "counterweight" else 0
            if abs(unbalance) > least:
                tables.append(slot.make_table(unbalance, first_axis_deg))
        return self._replace(remedy=self.remedy.add_devices(tables, reason))

    def cancel(
        self,
        slots: Sequence[Slot],
        parts: Sequence[ResidualPart],
        reason: str,
        residual: Residual | None = None,
    ) -> Self:
        """Return the fitting with devices in these slots that cancel these parts.

        Args:
            slots: Slots for devices.
            parts: Parts to cancel.
            reason: Reason for these devices.
            residual: Residual with the devices so far; None: it is computed.

        Raises:
            BalcliError: The slots cannot cancel the parts.
        """
        if not slots:
            return self
        left = residual or self.find_residual(slots[0].order)
        fit = solve_exactly(slots, left, parts, SAME_PLACE)
        fitting = self.add(slots, fit.unbalances, reason)
        if len(slots) > 1 and fit.condition < math.inf:
            return fitting.add_details(condition_number=fit.condition)
        return fitting

    def balance_rotating(self, *, keep_overbalance: bool = True) -> Self:
        """Return the fitting with counterweights for masses that turn with the crank pins and are
        not yet balanced by counterweights of the file: one weight if that suffices, else two at the
        ends.

        Args:
            keep_overbalance: Whether nothing is fitted if counterweights of the file balance more
                than these masses.
        """
        engine = self.engine
        residual = self.find_residual(1)
        if engine.rotary or engine.placed:
            return self
        masses = np.array([float(weighed.rotating + weighed.share) for weighed in engine.weighed])
        directions = unit(engine.first_axis_deg + engine.cylinders.pin_deg)
        pins = masses * engine.cylinders.radius * directions
        own = [device for device in engine.devices if device.kind is DeviceKind.COUNTERWEIGHT]
        vectors = np.array([*pins, *(weight.forward for weight in own)])
        z = np.array([*engine.cylinders.z, *(weight.z for weight in own)])
        force = complex(vectors.sum())
        moment = complex(vectors @ (z - residual.reference.z))
        if keep_overbalance and (pins.sum().conjugate() * force).real < 0:
            return self
        parts = {**residual.parts, FORWARD_FORCE: force, FORWARD_MOMENT: moment}
        for part, vector in parts.items():
            if abs(vector) <= 4 * residual.noise.get(part, 0):
                parts[part] = 0j
        turning = residual._replace(parts=parts)
        slots = [Slot("counterweight", 1, 1, z) for z in find_planes(engine, turning, 1)]
        return self.cancel(slots, FORWARD, _ROTATING, turning)

    def describe_left(self, order: int, *keys: str, group: str = "") -> Self:
        """Return the fitting with the residual in its details; `keys` are keys of `_LEFT_OF`."""
        left = self.find_residual(order)
        return self.add_details(group, **{key: left.size(*_LEFT_OF[key]) for key in keys})

    def describe_roll(self, before: Residual, group: str = "") -> Self:
        """Return the fitting with details on the roll of an order, without and with the devices so
        far. For an engine with gas, the roll of inertia and gas is stated as well.
        """
        order = before.order
        left = self.find_residual(order).size(ROLL)
        details = {"roll_left_Nm": left, "roll_before_Nm": before.size(ROLL)}
        if self.engine.gas is not None:
            fitted = fit_devices(self.engine, self.remedy)
            details["roll_with_gas_left_Nm"] = _size_total_roll(fitted, order)
            details["roll_with_gas_before_Nm"] = _size_total_roll(self.engine, order)
        return self.add_details(group, **details)

    def add_details(self, group: str = "", /, **figures: object) -> Self:
        """Return the fitting with further details in its remedy (`Remedy.add_details`)."""
        return self._replace(remedy=self.remedy.add_details(group, **figures))


def _sum_unbalances(engine: Engine) -> float:
    """Return the sum of all moving masses times their crank radii, kg m."""
    masses = [float(w.rotating + w.share + w.reciprocating) for w in engine.weighed]
    return float(masses @ engine.cylinders.radius_of_each)


def _size_total_roll(engine: Engine, order: int) -> float:
    """Return the amplitude of an order of the roll of inertia and gas, N m."""
    return float(compute_spectra(engine, [order], (ROLL_TOTAL.name,))[ROLL_TOTAL.name].major[0])


def explain_counterweights(residual: Residual, sense: int = 1, places: str = "") -> str:
    """Return the reason for counterweights against the part of order 1 that turns in one direction.

    Args:
        residual: Residual of order 1.
        sense: Direction of rotation: 1 as the first crank, -1 against it.
        places: Words on the planes of the weights; empty if they need none.
    """
    both = "both" if residual.force(sense) and residual.moment(sense) else "it"
    turn = "counterweights also turn with it and cancel"
    crank = "with the crank" if sense > 0 else "with the crank that turns against the first"
    reason = f"{_name(residual, sense)} turning {crank}: {turn} {both}"
    return f"{reason}; {places}" if places else reason


def explain_shaft(
    residual: Residual, sense: int, count: int, stays: str = "", *, halves: bool = False
) -> str:
    """Return the reason for a shaft with this many eccentrics against the force and moment that
    turn in one direction.

    Args:
        residual: Residual of the order.
        sense: Direction of rotation: 1 with the crank, -1 against it.
        count: Number of eccentrics.
        stays: Words on the moment that remains (`tell_moment`); empty if no moment remains.
        halves: Whether the eccentric is divided into two halves.
    """
    vector = f"Order {residual.order} force" if stays else _name(residual, sense)
    why = "nothing on the crankshaft can cancel it"
    if sense * residual.order == 1:
        why = "the scheme counterweights would cancel it without a shaft"
    if count == 1:
        kind = "one eccentric"
    elif residual.force(sense):
        kind = "eccentrics in two planes"
    else:
        kind = "two opposite eccentrics"
    text = f"{vector} turning {tell_sense(sense)}: {why}; {kind}"
    text += f" on a shaft at {sense * residual.order:+d} times crank speed can"
    if halves:
        text += ", in two halves on opposite sides of the crank so that no roll is added"
    return f"{text}{stays}"


def tell_moment(residual: Residual, sense: int, z: float, cure: str) -> str:
    """Return words on the moment that one eccentric at z (m) leaves, ending in `cure`, a clause on
    how to cancel that moment; empty if no moment remains.
    """
    return "" if takes_moment(residual, sense, z) else f"; a moment remains, which {cure}"


def _name(residual: Residual, sense: int) -> str:
    """Return in words the order and whether force, moment or both turn in this direction."""
    kinds = [part.kind for part in list_parts(sense) if residual.parts[part]]
    return f"Order {residual.order} {' and '.join(kinds)}"
