"""All sizing is one weighted linear least squares over chosen devices: every one is linear in its
complex unbalance (docs/theory.md).

For one order n, a device of unbalance u at z and place p adds to what the engine shakes, per `n^2
omega^2`, `u` to the force, `(z - z_ref) u` to the moment (over i) and `Im(conj(p) u ...)` to the
roll; a slider adds to both rotating vectors at once. A scheme is only a choice of slots for devices
and of the parts that are to vanish.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import least_squares
from ..core.cylinders import Device
from ..core.phasors import EPS, unit
from ..engine.build import Engine
from ..enginefile.model import Counterweight, Shaft, Slider
from ..errors import BalcliError
from ..forces.spectrum import compute_spectra
from . import remedy

LEFT = 1e-12  # of what was there before: more must not remain of what a scheme promises to cancel


class Part(NamedTuple):
    """What may be cancelled: "force" or "moment" turning with the crank (sense 1) or against it
    (-1); "roll" (sense 0).
    """

    quantity: str
    sense: int


class Rest(NamedTuple):
    """What shakes an engine at one order, per `n^2 omega^2`: force (kg m), moment over i and roll
    (kg m2).

    Attributes:
        parts, noise: value and rounding error of every part.
        arm: place (x + iy) and z of the point about which moments are taken, m.
        newton: N per kg m (`n^2 omega^2`).
    """

    order: int
    parts: dict[Part, complex]
    noise: dict[Part, float]
    arm: tuple[complex, float]
    newton: float

    def at(self, quantity: str, sense: int) -> complex:
        return self.parts[Part(quantity, sense)]


def steady(engine: Engine) -> Engine:
    """The same at its mean speed; unbalance is sized for that."""
    return replace(engine, ripple=())


def rest(engine: Engine, order: int) -> Rest:
    """What is left to cancel at one order; of forces alone where moments are not known."""
    found = compute_spectra(steady(engine), [order], ("force", "moment", "roll"))
    newton = order**2 * float(engine.omega) ** 2
    x, y, z = engine.reference_m
    parts, noise = {}, {}
    for quantity, per in (("force", 1), ("moment", 1j)):
        phasors = getattr(found, quantity)
        for sense, vector in ((1, phasors.forward), (-1, phasors.backward)):
            known = quantity == "force" or engine.places_known
            parts[Part(quantity, sense)] = complex(vector[0]) / per / newton if known else 0j
            noise[Part(quantity, sense)] = (
                float(np.broadcast_to(phasors.noise, vector.shape)[0]) / newton
            )
    parts[Part("roll", 0)] = 2 * complex(found.roll.forward[0]) / newton if found.roll else 0j
    return Rest(order, parts, noise, (complex(x, y), float(z)), newton)


class Slot(NamedTuple):
    """Where a device may be fitted, by the table that describes it: "counterweight", "shaft" or
    "slider".
    """

    kind: str
    order: int
    sense: int  # 1 with the crank, -1 against it; of a slider 0
    z: float
    place: complex = 0j
    direction_deg: float = 0.0

    def device(self, u: complex) -> Device:
        """The device of unbalance u (kg m) in this slot."""
        if self.kind == "slider":
            half = complex(unit(self.direction_deg)) / 2
            return Device(self.order, half * u, half * u.conjugate(), self.place, self.z)
        return Device(self.order, *((u, 0j) if self.sense > 0 else (0j, u)), self.place, self.z)

    def table(self, u: complex, first_axis_deg: float) -> Counterweight | Shaft | Slider:
        """The same as a table of the engine file."""
        if self.kind == "counterweight":
            return remedy.counterweight(u, self.z, first_axis_deg)
        if self.kind == "shaft":
            return remedy.shaft(u, self.sense * self.order, self.z, self.place)
        return remedy.slider(u, self.order, self.direction_deg, self.z, self.place)


class Fit(NamedTuple):
    """Unbalance for each slot (kg m), the condition number of the scaled system, and the share of
    the wish that is left.
    """

    unbalances: tuple[complex, ...]
    condition: float
    left: float


def effect(
    device: Device, parts: Sequence[Part], arm: tuple[complex, float]
) -> NDArray[np.complex128]:
    """What a device adds to each part."""
    place, z = device.place - arm[0], device.z - arm[1]
    vectors = {
        1: device.forward,
        -1: device.backward,
        0: -1j * (np.conj(place) * device.forward - place * np.conj(device.backward)),
    }
    return np.array(
        [vectors[sense] * (z if quantity == "moment" else 1) for quantity, sense in parts], complex
    )


def solve(slots: Sequence[Slot], wish: Rest, parts: Sequence[Part]) -> Fit:
    """The smallest unbalances that cancel the parts as well as these slots can, moments and roll
    measured by the longest arm.

    Least squares by singular values, then refined on the residual, so that what is left is a few
    ulp of the parts.
    """
    length = _length(slots, wish)
    scale = np.repeat([1.0 if p.quantity == "force" else 1 / length for p in parts], 2)
    columns = [effect(slot.device(u), parts, wish.arm) for slot in slots for u in (1 + 0j, 1j)]
    matrix = np.column_stack([_real(c) for c in columns])
    target = -_real(np.array([wish.parts[p] for p in parts]))
    found = least_squares.solve(matrix, target, scale)
    size = np.abs(found.x)
    x = np.where(size <= 4 * EPS * size.max(), 0, found.x)
    return Fit(tuple(complex(a, b) for a, b in x.reshape(-1, 2)), found.condition, found.left)


def exactly(slots: Sequence[Slot], wish: Rest, parts: Sequence[Part], reason: str) -> Fit:
    """The same, but nothing may be left: neither by the system nor by the rounding of unbalances
    that work against each other.

    Raises BalcliError with the reason why these slots cannot do it, or with the condition number
    where it is hopeless.
    """
    fit = solve(slots, wish, parts)
    length = _length(slots, wish)
    size, noise = (
        max(abs(of[p]) / (1 if p.quantity == "force" else length) for p in parts)
        for of in (wish.parts, wish.noise)
    )
    if fit.condition == np.inf and fit.left * size > noise:
        raise BalcliError(reason)
    largest = max(map(abs, fit.unbalances))
    left = fit.left * size + 2 * EPS * largest
    if left > max(noise, LEFT * size):
        raise BalcliError(
            f"order {wish.order}: the places given are too much alike: unbalances of "
            f"{largest * 1e6:.3g} g mm would work "
            f"against each other (condition number {fit.condition:.3g}), and their rounding alone "
            "would leave "
            f"{left / size:.1g} of what shakes; choose planes farther apart"
        )
    if len(slots) == 1:  # a compromise would leave rounding in the force, too
        return fit._replace(unbalances=solve(slots, wish, parts[:1]).unbalances)
    return fit


def _length(slots: Sequence[Slot], wish: Rest) -> float:
    """The longest arm: a moment is measured by the force that makes it there."""
    return (
        max([abs(s.z - wish.arm[1]) for s in slots] + [abs(s.place - wish.arm[0]) for s in slots])
        or 1.0
    )


def _real(parts: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Real and imaginary parts in turn."""
    return np.asarray(parts, complex).view(float)
