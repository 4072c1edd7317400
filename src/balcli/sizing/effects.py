"""All sizing is one weighted linear least squares over chosen devices: every one is linear in its
complex unbalance (docs/theory.md).

For one order n, a device of unbalance u at z and place p adds to what the engine shakes, per `n^2
omega^2`, `u` to the force, `(z - z_ref) u` to the moment (over i) and `Im(conj(p) u ...)` to the
roll; a slider adds to both rotating vectors at once. A scheme is only a choice of slots for devices
and of the parts that are to vanish.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import least_squares
from ..core.cylinders import Device
from ..core.phasors import EPS, unit
from ..errors import BalcliError
from ..file.model import Counterweight, Shaft, Slider
from .planes import DeviceTable, as_millimetres, measure_direction
from .residual import ReferencePoint, Residual, ResidualPart

LEFT = 1e-12  # of what was there before: more must not remain of what a scheme promises to cancel


class Slot(NamedTuple):
    """Where a device may be fitted.

    Attributes:
        kind: of the device.
        order: times crank speed.
        sense: of rotation, 1 with the crank, -1 against it; 0 for a slider.
        z, place: m, x + iy.
        direction_deg: of a slider's path, from x.
    """

    kind: Literal["counterweight", "shaft", "slider"]
    order: int
    sense: int
    z: float
    place: complex = 0j
    direction_deg: float = 0.0

    def make_device(self, unbalance: complex) -> Device:
        """The device of this unbalance (kg m) in this slot, as rotating vectors."""
        u = unbalance
        if self.kind == "slider":
            half = complex(unit(self.direction_deg)) / 2
            return Device(self.order, half * u, half * u.conjugate(), self.place, self.z)
        forward, backward = (u, 0j) if self.sense > 0 else (0j, u)
        return Device(self.order, forward, backward, self.place, self.z)

    def make_table(self, unbalance: complex, first_axis_deg: float) -> DeviceTable:
        """Return the device of this unbalance (kg m; its direction at crank angle 0 counts from x)
        as a table of the engine file; a counterweight's angle counts from cylinder 1's crank pin at
        `first_axis_deg`.
        """
        origin_deg = first_axis_deg if self.kind == "counterweight" else 0.0
        values: dict[str, Any] = {
            "unbalance": abs(unbalance) * 1e6,
            "angle": measure_direction(unbalance, origin_deg),
            "position": as_millimetres(self.z),
        }
        if self.kind == "counterweight":
            return Counterweight.model_construct(**values)
        values["at"] = (as_millimetres(self.place.real), as_millimetres(self.place.imag))
        if self.kind == "shaft":
            return Shaft.model_construct(ratio=self.sense * self.order, **values)
        return Slider.model_construct(order=self.order, direction=self.direction_deg, **values)


class Fit(NamedTuple):
    """What the least squares found.

    Attributes:
        unbalances: one for each slot, kg m.
        condition: condition number of the weighted system; infinite where the slots cannot make
            some combination of the parts.
        left: share of the parts that is not cancelled.
    """

    unbalances: tuple[complex, ...]
    condition: float
    left: float


def find_effect(
    device: Device, parts: Sequence[ResidualPart], reference: ReferencePoint
) -> NDArray[np.complex128]:
    """What a device adds to each part, shape (parts,), in the units of `Residual.parts`."""
    place, z = device.place - reference.place, device.z - reference.z
    vectors = {
        1: device.forward,
        -1: device.backward,
        0: -1j * (np.conj(place) * device.forward - place * np.conj(device.backward)),
    }
    effects = [vectors[part.sense] * (z if part.kind == "moment" else 1) for part in parts]
    return np.array(effects, complex)


def size_unbalances(
    slots: Sequence[Slot], residual: Residual, parts: Sequence[ResidualPart], least_arm: float = 0.0
) -> Fit:
    """The smallest unbalances that cancel these parts as well as the slots can.

    Least squares of force, and of moment and roll over the longest arm of a slot, so that what is
    left of parts that can be cancelled is a few ulp of them.

    Args:
        least_arm: moments and roll are divided by this (m) where no slot has a longer arm.
    """
    weights = _weigh(parts, max(least_arm, _find_longest_arm(slots, residual.reference)))
    columns = [
        find_effect(slot.make_device(u), parts, residual.reference)
        for slot in slots
        for u in (1 + 0j, 1j)
    ]
    target = -np.array([residual.parts[part] for part in parts], complex)
    matrix = np.array(columns).view(float).T  # real and imaginary parts in turn
    found = least_squares.solve(matrix, target.view(float), np.repeat(weights, 2))
    rounding = 4 * EPS * np.abs(found.x).max()
    x = np.where(np.abs(found.x) <= rounding, 0, found.x)
    return Fit(tuple(complex(a, b) for a, b in x.reshape(-1, 2)), found.condition, found.left)


def solve_exactly(
    slots: Sequence[Slot], residual: Residual, parts: Sequence[ResidualPart], reason: str
) -> Fit:
    """The same, but nothing may be left: neither by the system nor by the rounding of unbalances
    that work against each other.

    Raises BalcliError with the reason given if these slots cannot make the parts, or with the
    condition number if they are too much alike.
    """
    fit = size_unbalances(slots, residual, parts)
    weights = _weigh(parts, _find_longest_arm(slots, residual.reference))
    size = float(max(weights * [abs(residual.parts[part]) for part in parts]))
    noise = float(max(weights * [residual.noise[part] for part in parts]))
    if fit.condition == np.inf and fit.left * size > noise:
        raise BalcliError(reason)
    largest = max(map(abs, fit.unbalances))
    left = fit.left * size + 2 * EPS * largest
    if left > max(noise, LEFT * size):
        raise BalcliError(
            f"order {residual.order}: the places given are too much alike: unbalances of "
            f"{largest * 1e6:.3g} g mm would work against each other (condition number "
            f"{fit.condition:.3g}), and their rounding alone would leave {left / size:.1g} of what "
            "shakes; choose planes farther apart"
        )
    if len(slots) == 1:  # a compromise would leave rounding in the force, too
        return fit._replace(unbalances=size_unbalances(slots, residual, parts[:1]).unbalances)
    return fit


def _find_longest_arm(slots: Sequence[Slot], reference: ReferencePoint) -> float:
    """Of all slots about the point of reference, m; 1 if none has an arm."""
    along = [abs(slot.z - reference.z) for slot in slots]
    across = [abs(slot.place - reference.place) for slot in slots]
    return max(along + across) or 1.0


def _weigh(parts: Sequence[ResidualPart], arm: float) -> NDArray[np.float64]:
    """Return weights by which moments are measured by the force that makes them at this arm."""
    return np.array([1.0 if part.kind == "force" else 1 / arm for part in parts])
