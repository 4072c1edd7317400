"""Load of an engine on a body on mounts: free forces, moments and gas torque about the center of
gravity, by order.

At uneven speed, orders of the time excite vibration. An order of the crank angle, cycles in a turn,
is then no frequency: a force of order 1 over the angle has sidebands over the time.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.phasors import Array, Phasors
from ..core.speed_ripple import (
    count_in_time,
    find_reach,
    find_slowest,
    find_speed,
    find_timetable,
)
from ..core.vibration import Complex, Real
from ..engine.engine import NONE_SILENT, Engine, SilentCylinders
from ..errors import MOMENTS_UNKNOWN, BalcliError
from ..forces.kinds import GAS_KINDS
from ..forces.spectrum import (
    Spectra,
    choose_orders,
    compute_spectra,
    dense_orders,
    find_relevant_orders,
    list_gas_orders,
    merge_orders,
)
from ..limits import MOST_SAMPLES
from .rigid_body import ROLL, load_at_centre

_MOST_COUNTED = 1 << 26  # samples, each for every order: seconds


def compute_spectra_in_time(
    engine: Engine, orders: Array, kinds: Collection[str]
) -> tuple[Spectra, float]:
    """Return the spectra of an engine with uneven speed by orders of the time; arguments as for
    `compute_spectra`.

    Returns:
        The spectra, and the mean speed over the time, as a multiple of that over the angle.

    Raises:
        BalcliError: The crank almost stops; a kind of gas for an engine without gas.
    """
    mixed = [*(line.order for line in engine.ripple), *orders]
    of_inertia, highest = find_relevant_orders(engine).max(), orders.max(initial=0)
    fastest = dense_orders(max(of_inertia, 2 * highest), mixed)
    slowest = find_slowest(engine.ripple).value
    samples = 1 << math.ceil(math.log2(32 * len(fastest) / slowest))  # enough where it is slowest
    if samples > MOST_SAMPLES or samples * len(orders) > _MOST_COUNTED:
        raise BalcliError(
            f"operation.speed_ripple: the crank slows down to {slowest:.3g} of its mean speed; "
            "its orders of the time need more samples than are computed; give a smaller amplitude "
            "or lower orders"
        )
    step = float(fastest[1])
    timetable = find_timetable(find_speed(engine.ripple, step), step, samples)
    in_time: dict[str, Phasors] = {}
    # Gas has orders without end: all that are felt in those of the time.
    of_gas = [name for name in kinds if name in GAS_KINDS]
    reach = max(of_inertia, find_reach(timetable, highest)) if of_gas else 0
    for some, most in ((set(kinds) - set(of_gas), of_inertia), (of_gas, reach)):
        if some:
            found = compute_spectra(engine, dense_orders(most, mixed), some)
            counted = count_in_time([p for _, p in found.items()], timetable, orders)
            in_time |= zip((kind.name for kind, _ in found.items()), counted, strict=True)
    return Spectra(orders, None, **in_time), timetable.turns


@dataclass(frozen=True, eq=False)
class BodyLoads:
    """Load of an engine on the body, by order.

    Attributes:
        orders: Orders, all above 0, shape (orders,).
        inertia: Force (N) and moment about the center of gravity (N m) at `omega`, shape
            (orders, 6); they grow with the square of the speed.
        omega: Speed of `inertia`, rad/s, mean over the time, as all speeds here are.
        gas: Roll that the gas torque leaves, the same at every speed, shape (orders, 6).
        mean: Steady torque about the crankshaft's axis on the body, N m: the reaction to a constant
            load, which takes the mean of the gas torque over the crank angle, at uneven speed as
            well, less the share that goes into friction, which acts between parts of the body.
        fired: Whether the file has gas.
        silent: Cylinders that do not fire.
    """

    orders: Real
    inertia: Complex
    omega: float
    gas: Complex
    mean: float
    fired: bool
    silent: SilentCylinders

    def at(self, omega: Real) -> Complex:
        """Return the load, shape (orders, *speeds, 6), at speeds (rad/s, any shape)."""
        square = np.asarray((omega / self.omega) ** 2)
        shape = (len(self.orders), *(1,) * square.ndim, 6)
        grown = self.inertia.reshape(shape) * square[..., None]
        return np.asarray(grown + self.gas.reshape(shape))

    @property
    def there(self) -> NDArray[np.bool_]:
        """Whether an order has any load, shape (orders,)."""
        return np.any((self.inertia != 0) | (self.gas != 0), axis=1)


def find_loads(
    engine: Engine, centre: Real, orders: Real | None = None, gas_orders: Real | None = None
) -> BodyLoads:
    """Return the free forces and moments of an engine as a load on the body.

    Args:
        engine: Engine without trailing axes.
        centre: Center of gravity of the body, m, shape (3,).
        orders: Orders of the load; default: all that are considerable.
        gas_orders: Orders of the gas torque among these; default: as of `list_gas_orders`.

    Raises:
        BalcliError: The file does not say where the throws stand.
    """
    if not engine.places_known:
        raise BalcliError(MOMENTS_UNKNOWN)
    fired = engine.gas is not None
    of_gas = list_gas_orders(engine) if gas_orders is None else gas_orders
    usual = merge_orders(find_relevant_orders(engine), of_gas if fired else ())
    wanted = np.array(usual if orders is None else orders, np.float64)
    wanted = wanted[wanted > 0]
    kinds = ("force", "moment", "roll", *["gas"] * fired)
    if engine.ripple:  # by orders of the time, in which the crank turns faster than over the angle
        found, turns = compute_spectra_in_time(engine, wanted, kinds)
    else:
        found, turns = compute_spectra(engine, wanted, kinds), 1.0
    if orders is None:
        found = found.select_orders(choose_orders(found, of_gas))
    force, moment, roll = (found[kind].drop_noise() for kind in ("force", "moment", "roll"))
    inertia = load_at_centre(
        np.stack([force.x, force.y, 0 * force.x], axis=-1),
        np.stack([moment.x, moment.y, roll.x], axis=-1),
        np.array([float(value) for value in engine.reference_m]),
        centre,
    )
    gas, mean = np.zeros_like(inertia), 0.0
    if fired:
        gas[:, ROLL] = -found["gas"].drop_noise().x
        indicated = float(compute_spectra(engine, [0.0], ["gas"])["gas"].x[0].real)
        mean = -(engine.mechanical_efficiency or 1.0) * indicated
    there = np.any((inertia != 0) | (gas != 0), axis=1)
    if orders is not None or not there.any():
        there[:] = True
    return BodyLoads(
        found.orders[there],
        inertia[there],
        turns * float(engine.omega),
        gas[there],
        mean,
        fired,
        engine.silent if fired else NONE_SILENT,
    )
