"""Load of an engine on a body on mounts: free forces, moments and gas torque about the center of
gravity, by order.

At uneven speed, orders of the time excite vibration. An order of the crank angle, cycles in a turn,
is then no frequency: a force of order 1 over the angle has sidebands over the time.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace

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
    reach = find_reach(timetable, highest)
    in_time: dict[str, Phasors] = {}
    for name in kinds:  # gas has orders without end: all that are felt in those of the time
        most = max(of_inertia, reach) if name in GAS_KINDS else of_inertia
        found = compute_spectra(engine, dense_orders(most, mixed), [name])
        ((kind, phasors),) = found.items()
        (in_time[kind.name],) = count_in_time([phasors], timetable, orders)
    return Spectra(orders, None, **in_time), timetable.turns


@dataclass(frozen=True, eq=False)
class BodyLoads:
    """Load of an engine on the body, by order.

    Attributes:
        orders: Orders, all above 0, shape (orders,).
        inertia: Force (N) and moment about the centre of gravity (N m) at `omega`, shape
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
        gas = np.einsum("oi,...->o...i", self.gas, np.ones_like(square))
        return np.einsum("oi,...->o...i", self.inertia, square) + gas

    @property
    def there(self) -> NDArray[np.bool_]:
        """Whether an order has any load, shape (orders,)."""
        return np.any((self.inertia != 0) | (self.gas != 0), axis=1)


def list_gas_kinds(engine: Engine) -> list[str]:
    """Return the kinds by which `find_gas_reaction` is known."""
    return ["roll", "roll_total"] if engine.placed else ["gas"]


def find_gas_reaction(found: Spectra) -> Phasors:
    """Return the torque of the gas that the load takes from the frame, N m: of geared engines in
    the sense of the load, which is not that of the first crank everywhere.
    """
    return found["gas"] if found.gas is not None else found["roll"] - found["roll_total"]


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
    of_engine = ("force", "moment", "roll")
    kinds = tuple(dict.fromkeys((*of_engine, *list_gas_kinds(engine) * fired)))
    if engine.ripple:  # by orders of the time, in which the crank turns faster than over the angle
        found, turns = compute_spectra_in_time(engine, wanted, kinds)
    else:
        found, turns = compute_spectra(engine, wanted, kinds), 1.0
    if orders is None:
        found = found.select_orders(choose_orders(found, of_gas))
    force, moment, roll = (found[kind].drop_noise() for kind in ("force", "moment", "roll"))
    pull = np.stack([force.x, force.y, 0 * force.x], axis=-1)
    turn = np.stack([moment.x, moment.y, roll.x], axis=-1)
    inertia = load_at_centre(pull, turn, list(map(float, engine.reference_m)), centre)
    gas, mean, silent = np.zeros_like(inertia), 0.0, NONE_SILENT
    if fired:
        gas[:, ROLL] = -find_gas_reaction(found).drop_noise().x
        still = compute_spectra(engine, [0.0], list_gas_kinds(engine))
        indicated = float(find_gas_reaction(still).x[0].real)
        mean, silent = -(engine.mechanical_efficiency or 1.0) * indicated, engine.silent
    omega = turns * float(engine.omega)
    loads = BodyLoads(found.orders, inertia, omega, gas, mean, fired, silent)
    kept = loads.there
    if orders is not None or not kept.any():
        return loads
    return replace(loads, orders=loads.orders[kept], inertia=inertia[kept], gas=gas[kept])
