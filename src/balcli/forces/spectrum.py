"""Engine -> free forces and moments by order, computing only the quantities and orders that are
asked for.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core import speed_ripple as ripple
from ..core.cylinders import Device
from ..core.loads import Loads, find_device_force
from ..core.mechanisms import harmonics
from ..core.phases import Phases, SeparatePhases
from ..core.phasors import Array, Complex, Phasors, joined
from ..engine.build import Engine
from ..errors import BalcliError

SPECTRAL = ("force", "moment", "couple", "torque", "roll")
_ONLY_FORCES = {"force", "moment"}
SHOWN = 1e-6  # share of a quantity's largest order below which an order is not worth showing
# highest order that is shown unless it is asked for: only a mechanism near its lock has more
UNASKED = 512
# orders x loads that are kept one by one at a steady speed; half as many at an uneven one
MOST_APART = 1_100_000
_ALL = slice(None)
_AT_ONCE = (
    1 << 18
    # orders x cylinders that are computed together: bounds the memory, about 16 arrays of complex
    # numbers
)


class Spectra(NamedTuple):
    """Phasors by order: force (N), moment, couple, inertia torque on the crank and roll (N m);
    None: not asked for.
    """

    orders: Array
    force: Phasors | None = None
    moment: Phasors | None = None
    couple: Phasors | None = None
    torque: Phasors | None = None
    roll: Phasors | None = None

    def at(self, orders: ArrayLike) -> Spectra:
        """Only these orders."""
        if orders is self.orders:
            return self
        rows = {q: phasors.at(orders) for q, phasors in self.items()}
        return Spectra(np.asarray(orders, float), **rows)

    def of(self, place: int) -> Spectra:
        """Only one place of the trailing axis."""
        return Spectra(self.orders, **{q: phasors.of(place) for q, phasors in self.items()})

    def items(self) -> list[tuple[str, Phasors]]:
        """Name and phasors of everything that was asked for."""
        return [(q, phasors) for q in SPECTRAL if (phasors := getattr(self, q)) is not None]


def spectra(engine: Engine, orders: ArrayLike, quantities: Collection[str] = SPECTRAL) -> Spectra:
    """Free forces and moments of an engine.

    Args:
        engine: the engine; trailing axes of its arrays become those of the phasors.
        orders: shape (orders,), ascending, not negative.
        quantities: any of SPECTRAL.
    """
    return _spectra(engine, orders, quantities, apart=False)


def each(engine: Engine, orders: ArrayLike, quantities: Collection[str] = SPECTRAL) -> Spectra:
    """What each cylinder does by itself, as if no other had a mass (`alone`), the devices left out.

    The phasors have the shape (orders, cylinders), the cylinders as in `engine.numbers`; the engine
    has no trailing axes.

    Raises:
        BalcliError: more than MOST_APART of them.
    """
    few_enough(engine, np.size(orders), engine.cylinders.count)
    return _spectra(replace(engine, devices=()), orders, quantities, apart=True)


def few_enough(engine: Engine, orders: int, loads: int) -> None:
    """BalcliError for so many orders of so many loads one by one that they would fill the
    memory.
    """
    most = MOST_APART // 2 if engine.ripple else MOST_APART
    if orders * loads > most:
        raise BalcliError(
            f"{orders} orders of {loads} cylinders and counterweights one by one are "
            f"{orders * loads} forces, and at most "
            f"{most} are kept: an engine farther from its lock has fewer orders"
        )


def weight(engine: Engine, device: Device, orders: Array) -> Phasors:
    """Force of one device, of an engine without trailing axes, N."""
    if not engine.ripple:
        return find_device_force(device, orders, engine.omega**2).settled()
    w, dense = _uneven_speed(engine, orders)
    steady = find_device_force(device, dense, engine.omega**2).settled()
    return ripple.force(steady, w).at(orders).settled()


def _spectra(
    engine: Engine, orders: ArrayLike, quantities: Collection[str], *, apart: bool
) -> Spectra:
    wanted = np.asarray(orders, float)
    needed = {*quantities, *(("couple", "torque") if "roll" in quantities else ())}
    found = (
        _uneven(engine, wanted, needed, apart)
        if engine.ripple
        else _steady(engine, wanted, needed, apart)[0]
    )
    if "roll" in quantities:
        found["roll"] = found["couple"] - found["torque"]
    return Spectra(
        wanted, **{q: phasors.settled() for q, phasors in found.items() if q in quantities}
    )


def relevant_orders(engine: Engine) -> Array:
    """The orders 1 .. n (0 .. n under uneven speed) beyond which nothing exceeds rounding
    errors.
    """
    c = engine.cylinders
    own = c.linkage.highest(c.lam, c.eps) if c.linkage else harmonics.points(c.lam, c.eps) // 2
    highest = max([own, *(d.order for d in engine.devices)])
    if not engine.ripple:
        return np.arange(1.0, highest + 1)
    return np.arange(0.0, highest + 2 * max(line.order for line in engine.ripple) + 1)


def considerable(phasors: Phasors) -> NDArray[np.bool_]:
    """Orders up to UNASKED in which something exceeds SHOWN of its own largest order, shape
    (orders,).
    """
    sizes = phasors.major.reshape(len(phasors.orders), -1).max(axis=1, initial=0)
    return np.asarray((sizes > SHOWN * sizes.max(initial=0)) & (phasors.orders <= UNASKED))


def alone(engine: Engine, number: int) -> Engine:
    """The engine with only this cylinder's masses moving, and no devices."""
    c = engine.cylinders
    here = np.array([n == number for n in engine.numbers], float).reshape(
        -1, *(1,) * (c.pin_deg.ndim - 1)
    )
    masses = {key: here * getattr(c, key) for key in ("reciprocating", "rotating", "couple")}
    linkage = c.linkage and replace(c.linkage, mass=here * c.linkage.mass)
    return replace(engine, cylinders=replace(c, linkage=linkage, **masses), devices=())


def _steady(
    engine: Engine, orders: Array, quantities: Collection[str], apart: bool
) -> tuple[dict[str, Phasors], Loads]:
    """Phasors at a steady speed, and the loads of the lowest orders."""
    c, names, (x, y, z) = (
        engine.cylinders,
        [q for q in SPECTRAL[:4] if q in quantities],
        engine.reference_m,
    )
    find = c.linkage.harmonics if c.linkage else harmonics.of_distinct
    rod = bool(np.count_nonzero(c.couple)) and not _ONLY_FORCES.issuperset(quantities)
    few, which = find(orders, c.lam, c.eps, rod=rod, energy="torque" in quantities)

    def loads(block: slice) -> Loads:
        own = few if block == _ALL else few.of_orders(block)
        phases = (SeparatePhases if apart else Phases)(c, orders[block])
        square = engine.omega**2
        return Loads(c, engine.devices, x + 1j * y, z, phases, own.of_rows(which), square)

    most = max(_AT_ONCE // c.count, 1)
    blocks = (
        [slice(k, k + most) for k in range(0, len(orders), most)] if len(orders) > most else [_ALL]
    )
    lowest = loads(blocks[0])
    parts = [{q: getattr(lowest, q) for q in names}]
    for block in blocks[1:]:
        these = loads(block)
        parts.append({q: getattr(these, q) for q in names})
    return {
        q: joined([part[q] for part in parts]) if parts[1:] else parts[0][q] for q in names
    }, lowest


def _uneven(
    engine: Engine, orders: Array, quantities: Collection[str], apart: bool
) -> dict[str, Phasors]:
    w, dense = _uneven_speed(engine, orders)
    steady, loads = _steady(engine, dense, quantities, apart)
    means = {"couple": loads.mean_momentum} if "couple" in quantities else {}
    if "torque" in quantities:
        means["torque"] = loads.mean_inertia
    return {
        q: (ripple.torque if q == "torque" else ripple.force)(
            phasors.settled(), w, means.get(q, 0.0)
        ).at(orders)
        for q, phasors in steady.items()
    }


def _uneven_speed(engine: Engine, orders: Array) -> tuple[Complex, Array]:
    """Coefficients of the speed (`ripple.speed`), and the dense orders that it mixes into these."""
    w = ripple.speed((line.order, line.amplitude, line.angle_deg) for line in engine.ripple)
    return w, np.arange(0.0, orders.max(initial=0) + len(w))
