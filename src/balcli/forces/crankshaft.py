"""Inner balance: what the inertia of cylinders and counterweights does to the crankshaft, even
where nothing is free outside.

The shaft is rigid. At each section the shear force is the sum of all loads towards the free end,
the bending moment their moment about the section, `i sum (z_i - z) F_i` (M_x + iM_y). Beyond the
last load they are the free force and moment (there about the last load). Between loads the bending
moment runs straight, so that its largest values stand at loads.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..core.cylinders import Device
from ..core.levers import bound_arms, find_ahead, find_arms, share_by_lever
from ..core.peaks import Peak, find_peak
from ..core.phasors import Array, Phasors
from ..engine.arrays import find_first_largest
from ..engine.build import Engine
from ..errors import BalcliError
from ..limits import MOST_RESULTS_ALONG_CRANK
from .orders import find_relevant_orders, mark_considerable, merge_orders
from .spectrum import compute_device_force, compute_each_cylinder, refuse_too_many_loads

if TYPE_CHECKING:
    from .in_bearings import LoadsWithGas


@dataclass(frozen=True)
class AlongCrank:
    """A force or moment at several places along the crank.

    Attributes:
        z_m: shape (places,), ascending.
        phasors: shape (orders, places).
        peaks: largest over a revolution, all orders, and its crank angle, one a place.
    """

    z_m: Array
    phasors: Phasors
    peaks: tuple[Peak, ...]

    def at(self, place: int) -> Phasors:
        """Phasors at one of the places, by its index."""
        return self.phasors.select_place(place)

    def select_orders(self, orders: Array) -> AlongCrank:
        """The same without all other orders; the peaks remain those of all."""
        return replace(self, phasors=self.phasors.select_orders(orders))

    @property
    def largest(self) -> int:
        """Index of the place with the highest peak; of equal ones the first."""
        return int(find_first_largest([peak.value for peak in self.peaks]))


@dataclass(frozen=True)
class InnerLoads:
    """Shear force (N) and bending moment (N m) just behind each load, and inertia loads of the main
    bearings (N).

    The bearings are taken half-way between neighbouring throws and as far outside the end ones, and
    the shaft as cut in each of them, so that every span is statically determinate; None for a crank
    with one throw, whose bearings the file cannot tell.

    Attributes:
        with_gas: what inertia and gas do to shaft, bearings and block; None without gas, and where
            it is not known.
        obstacle: of an engine with gas, why it is not known.
    """

    shear: AlongCrank
    bending: AlongCrank
    bearings: AlongCrank | None
    with_gas: LoadsWithGas | None = None
    obstacle: str = ""


def compute_inner_loads(engine: Engine, orders: Array | None = None) -> InnerLoads:
    """Forces and moments within the crankshaft, for some orders, and their peaks over all orders.

    Args:
        engine: without trailing axes.
        orders: shape (orders,), ascending; default: 1 and 2 and those in which the bending moment
            is worth showing.

    Raises:
        BalcliError: too many orders of too many loads.
    """
    every = merge_orders(find_relevant_orders(engine), [1, 2] if orders is None else orders)
    loads, z = _compute_loads(engine, every)
    sections = np.unique(z)
    ahead = find_ahead(z, sections)
    shear = _sum_weighted(loads, ahead, ahead)
    bending = 1j * _sum_weighted(loads, find_arms(z, sections), bound_arms(z, sections))
    if orders is None:
        orders = every[mark_considerable(bending) | (every <= 2)]
    _refuse_too_many_results(len(orders), len(z))
    bearings = None
    if (span := place_bearings(engine.throws_m)) is not None:
        shares = share_by_lever(z, span)
        bearings = _with_peaks(span, _sum_weighted(loads, shares, shares), orders)
    return InnerLoads(
        _with_peaks(sections, shear, orders), _with_peaks(sections, bending, orders), bearings
    )


def _refuse_too_many_results(orders: int, loads: int) -> None:
    told = orders * loads
    if told > MOST_RESULTS_ALONG_CRANK:
        raise BalcliError(
            f"along the crankshaft, {orders} orders of {loads} cylinders and counterweights are "
            f"{told} results, and at most {MOST_RESULTS_ALONG_CRANK} are told: ask for fewer orders"
        )


def place_bearings(throws_m: Array) -> Array | None:
    """Places of main bearings half-way between throws and as far outside the end ones, m, shape
    (bearings,); None for throws in one place.
    """
    places = np.unique(throws_m)
    if len(places) < 2:
        return None
    between = (places[1:] + places[:-1]) / 2
    return np.array([2 * places[0] - between[0], *between, 2 * places[-1] - between[-1]])


def _compute_loads(engine: Engine, orders: Array) -> tuple[Phasors, Array]:
    """Forces of each cylinder and counterweight, phasors of shape (orders, loads), and their
    places, shape (loads,).
    """
    counterweights = [device for device in engine.devices if is_counterweight(device)]
    refuse_too_many_loads(engine, len(orders), engine.cylinders.count + len(counterweights))
    each = compute_each_cylinder(engine, orders, ["force"])["force"]
    more = [compute_device_force(engine, device, orders) for device in counterweights]
    vectors = np.concatenate([each.vectors, *(force.vectors[..., None] for force in more)], axis=2)
    noises = [np.broadcast_to(force.noise, force.forward.shape) for force in (each, *more)]
    together = Phasors(orders, vectors, np.column_stack(noises))
    places = [*np.ravel(engine.cylinders.z), *(device.z for device in counterweights)]
    return together, np.array(places, float)


def is_counterweight(device: Device) -> bool:
    """Whether a device turns on the crank's axis, with it."""
    return device.order == 1 and not device.backward and not device.place


def _sum_weighted(loads: Phasors, weights: Array, size: Array) -> Phasors:
    """Sums over the loads, weights of shape (places, loads); `size`, of the same shape: what the
    weights were computed from, which bounds their rounding.
    """
    noise = loads.noise @ np.abs(size).T
    return Phasors(loads.orders, loads.vectors @ weights.T, noise).drop_noise()


def _with_peaks(places: Array, phasors: Phasors, orders: Array) -> AlongCrank:
    """Phasors of all orders, (orders, places), and their peaks; only these orders are kept."""
    peaks = tuple(find_peak(phasors.select_place(place)) for place in range(len(places)))
    return AlongCrank(places, phasors.select_orders(orders), peaks)
