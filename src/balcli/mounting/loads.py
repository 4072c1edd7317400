"""What an engine does to the body that stands on mounts: free forces, moments and gas torque as a
load about the center of gravity, by order.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.rigid_body import load_at_centre
from ..core.vibration import Complex, Real
from ..engine.build import NONE_SILENT, Engine, SilentCylinders
from ..engine.positions import MOMENTS_UNKNOWN
from ..errors import BalcliError
from ..forces.in_time import compute_spectra_in_time
from ..forces.orders import choose_orders, find_relevant_orders, list_gas_orders, merge_orders
from ..forces.spectrum import compute_spectra
from .motions import ROLL


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


def find_loads(engine: Engine, centre: Real, orders: Real | None = None) -> BodyLoads:
    """Return the free forces and moments of an engine as a load on the body.

    Args:
        engine: Engine without trailing axes.
        centre: Center of gravity of the body, m, shape (3,).
        orders: Orders of the load; default: all that are considerable.

    Raises:
        BalcliError: The file does not say where the throws stand.
    """
    if not engine.places_known:
        raise BalcliError(MOMENTS_UNKNOWN)
    fired = engine.gas is not None
    of_gas = list_gas_orders(engine) if fired else ()
    wanted = merge_orders(find_relevant_orders(engine), of_gas) if orders is None else orders
    wanted = np.array(wanted[wanted > 0], np.float64)
    kinds = ("force", "moment", "roll", *(["gas"] if fired else []))
    if engine.ripple:  # by orders of the time, in which the crank turns faster than over the angle
        found, turns = compute_spectra_in_time(engine, wanted, kinds)
    else:
        found, turns = compute_spectra(engine, wanted, kinds), 1.0
    if orders is None:
        found = found.select_orders(choose_orders(found, engine))
    force, moment = found["force"], found["moment"]
    inertia = load_at_centre(
        np.stack([force.x, force.y, 0 * force.x], axis=-1),
        np.stack([moment.x, moment.y, found["roll"].x], axis=-1),
        np.array([float(value) for value in engine.reference_m]),
        centre,
    )
    gas, mean = np.zeros_like(inertia), 0.0
    if fired:
        gas[:, ROLL] = -found["gas"].x
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
