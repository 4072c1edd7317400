"""Compute the load of an engine on the body that stands on mounts: free forces, moments and gas
torque about the centre of gravity, by order.

At uneven speed, an order of the crank angle (cycles in a turn) is not one frequency: a force of
order 1 over the angle has sidebands over time. The loads are then computed by orders of time, which
are multiples of the mean speed over time.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.phases import RPM
from ..core.phasors import Array, Phasors
from ..core.speed_ripple import count_in_time, find_reach, find_slowest, find_speed, find_timetable
from ..core.vibration import Complex, Real
from ..engine.engine import Engine, SilentCylinders
from ..errors import MOMENTS_UNKNOWN, BalcliError
from ..forces.kinds import GAS_KINDS
from ..forces.spectrum import (
    GasAtSpeeds,
    Spectra,
    choose_orders,
    compute_spectra,
    dense_orders,
    find_relevant_orders,
    follow_gas,
    list_gas_orders,
    merge_orders,
)
from ..limits import MOST_SAMPLES
from .rigid_body import ROLL, load_at_centre

if TYPE_CHECKING:
    from ..engine.gas import GasLaw

_MOST_COUNTED = 1 << 26  # largest product of samples and orders; it takes seconds


def compute_spectra_in_time(
    engine: Engine, orders: Array, kinds: Collection[str]
) -> tuple[Spectra, float]:
    """Return the spectra of an engine by orders of time; arguments as for `compute_spectra`. At
    uneven speed, the mean speed over time differs from the mean over the crank angle.

    Returns:
        The spectra, and the ratio of the mean speed over the time to the mean over the crank angle.

    Raises:
        BalcliError: The crank almost stops, or a kind includes gas but the engine has none.
    """
    if not engine.ripple:
        return compute_spectra(engine, orders, kinds), 1.0
    mixed = [*(line.order for line in engine.ripple), *orders]
    of_inertia = find_relevant_orders(engine).max()
    highest = orders.max(initial=0)
    fastest = dense_orders(max(of_inertia, 2 * highest), mixed)
    slowest = find_slowest(engine.ripple).value
    # The samples have to suffice where the crank is slowest.
    samples = 1 << math.ceil(math.log2(32 * len(fastest) / slowest))
    if samples > MOST_SAMPLES or samples * len(orders) > _MOST_COUNTED:
        raise BalcliError(
            f"operation.speed_ripple: the crank slows down to {slowest:.3g} of its mean speed, so "
            "that orders of time need too many samples; give a smaller ripple or lower orders"
        )
    step = float(fastest[1])
    timetable = find_timetable(find_speed(engine.ripple, step), step, samples)
    reach = find_reach(timetable, highest)
    in_time: dict[str, Phasors] = {}
    for name in kinds:  # the series of gas is infinite: take all orders with an effect in time
        most = max(of_inertia, reach) if name in GAS_KINDS else of_inertia
        found = compute_spectra(engine, dense_orders(most, mixed), [name])
        in_time[name] = count_in_time(found[name], timetable, orders)
    return Spectra(orders, None, in_time), timetable.turns


class BodyLoads(NamedTuple):
    """Load of an engine on the body, by order.

    Attributes:
        orders: Orders, all above 0, shape (orders,).
        inertia: Force (N) and moment about the centre of gravity (N m) by inertia at `omega`,
            shape (orders, 6); they grow with the square of the speed.
        omega: Speed for `inertia`, rad/s. Speeds in rad/s are mean speeds over time.
        turns: Ratio of `omega` to the mean speed over the crank angle.
        gas: Torque of the gas as a function of the mean speed over the crank angle; its reaction
            rolls the body. None: the file has no gas.
        mean: Steady torque about the crankshaft's axis on the body, N m, at the file's speed: the
            reaction to a constant load. The load takes the mean of the gas torque over the
            crank angle, less the share that goes into friction between parts of the body.
        silent: Cylinders that do not fire.
    """

    orders: Real
    inertia: Complex
    omega: float
    turns: float
    gas: GasAtSpeeds | None
    mean: float
    silent: SilentCylinders

    def at(self, omega: Real) -> Complex:
        """Return the load, shape (orders, *speeds, 6), at speeds (rad/s, any shape)."""
        square = np.asarray((omega / self.omega) ** 2)
        load = np.einsum("oi,...->o...i", self.inertia, square)
        if self.gas is not None:
            load[..., ROLL] -= self.gas.torque(self.to_crank_rpm(omega))
        return load

    def to_crank_rpm(self, omega: Real) -> Real:
        """Convert mean speeds over the time, rad/s, into mean speeds over the crank angle, rpm."""
        return np.asarray(omega / self.turns / RPM)

    @property
    def law(self) -> GasLaw | None:
        """Law by which the gas depends on the speed; None: the gas is the same at all speeds."""
        return None if self.gas is None else self.gas.law

    @property
    def there(self) -> NDArray[np.bool_]:
        """Whether an order has any load at some speed, shape (orders,)."""
        nodes = [] if self.law is None else [rpm * RPM * self.turns for rpm in self.law.nodes_rpm]
        return np.any(self.at(np.array([self.omega, *nodes])) != 0, axis=(1, 2))


def list_gas_kinds(engine: Engine) -> list[str]:
    """Return the kinds of spectra that `find_gas_reaction` needs."""
    return ["roll", "roll_total"] if engine.placed else ["gas"]


def find_gas_reaction(spectra: Spectra) -> Phasors:
    """Return the gas torque whose reaction acts on the frame, N m. In geared engines it is positive
    in the direction of rotation of the load, even if a crank turns the other way.
    """
    return spectra["gas"] if spectra.gas is not None else spectra["roll"] - spectra["roll_total"]


def find_loads(
    engine: Engine, centre: Real, orders: Real | None = None, gas_orders: Real | None = None
) -> BodyLoads:
    """Return the free forces and moments of an engine as a load on the body.

    Args:
        engine: Single engine, without axes of variants.
        centre: Centre of gravity of the body, m, shape (3,).
        orders: Orders of the load; default: all relevant orders.
        gas_orders: Orders of the gas torque if `orders` is None; default: `list_gas_orders`.

    Raises:
        BalcliError: The file does not give the positions of the throws.
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
    spectra, turns = compute_spectra_in_time(engine, wanted, kinds)
    if orders is None:
        each = (engine.at_speed(rpm) for rpm in (engine.gas.nodes_rpm if engine.gas else ()) if rpm)
        all_found = (spectra, *(compute_spectra_in_time(one, wanted, kinds)[0] for one in each))
        shown = merge_orders(*(choose_orders(one, of_gas) for one in all_found))
        spectra = spectra.select_orders(np.array(shown))
    force, moment, roll = (spectra[kind].drop_noise() for kind in ("force", "moment", "roll"))
    pull = np.stack([force.x, force.y, 0 * force.x], axis=-1)
    turn = np.stack([moment.x, moment.y, roll.x], axis=-1)
    inertia = load_at_centre(pull, turn, list(map(float, engine.reference_m)), centre)
    by_speed = None
    mean = 0.0
    if fired:

        def find_torque(own: Engine) -> NDArray[np.complex128]:
            gas, _ = compute_spectra_in_time(own, spectra.orders, list_gas_kinds(own))
            return np.asarray(find_gas_reaction(gas).drop_noise().x, complex)

        by_speed = follow_gas(engine, find_torque)
        still = compute_spectra(engine, [0.0], list_gas_kinds(engine))
        indicated = float(find_gas_reaction(still).x[0].real)
        mean = -(engine.mechanical_efficiency or 1.0) * indicated
    omega = turns * float(engine.omega)
    loads = BodyLoads(spectra.orders, inertia, omega, turns, by_speed, mean, engine.silent)
    kept = loads.there
    if orders is not None or not kept.any():
        return loads
    by_speed = by_speed and by_speed.select_orders(kept)
    return loads._replace(orders=loads.orders[kept], inertia=inertia[kept], gas=by_speed)
