"""Inner balance: what the inertia of cylinders and counterweights does to the crankshaft, even
where nothing is free outside.

The shaft is rigid. At each section the shear force is the sum of all loads towards the free end,
the bending moment their moment about the section, `i sum (z_i - z) F_i` (M_x + iM_y). Beyond the
last load they are the free force and moment (there about the last load). Between loads the bending
moment runs straight, so that its largest values stand at loads.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.cylinders import Device
from ..core.peaks import Peak, peak
from ..core.phasors import Array, Phasors
from ..engine.arrays import ranked
from ..engine.build import Engine
from ..errors import BalcliError
from ..limits import MOST_RESULTS_ALONG_CRANK
from .spectrum import considerable, each, few_enough, relevant_orders, weight


@dataclass(frozen=True)
class Along:
    """A force or moment at several places along the crank.

    Attributes:
        z_m: shape (places,).
        phasors: shape (orders, places).
        peaks: largest over a revolution, all orders, and its crank angle, one a place.
    """

    z_m: Array
    phasors: Phasors
    peaks: tuple[Peak, ...]

    def at(self, place: int) -> Phasors:
        """Phasors at one of the places."""
        return self.phasors.select_place(place)

    @property
    def largest(self) -> int:
        """Which place has the highest peak; of equal ones the first."""
        return int(np.argmax(ranked([found.value for found in self.peaks])))


@dataclass(frozen=True)
class Inner:
    """Shear force (N) and bending moment (N m) just behind each load, and inertia loads of the main
    bearings (N).

    The bearings are taken half-way between neighbouring throws and as far outside the end ones, and
    the shaft as cut in each of them, so that every span is statically determinate; None for a crank
    with one throw, whose bearings the file cannot tell.
    """

    shear: Along
    bending: Along
    bearings: Along | None


def inner(engine: Engine, orders: Array | None = None) -> Inner:
    """Inner forces and moments of an engine without trailing axes, for these orders, and their
    peaks over all orders.

    By default orders 1 and 2 and those in which the bending moment is worth showing. BalcliError
    where they are too many.
    """
    every = np.union1d(relevant_orders(engine), [1, 2] if orders is None else orders)
    loads, z = _loads(engine, every)
    sections = np.unique(z)
    ahead = (z <= sections[:, None]).astype(float)  # which loads stand on the free-end side
    arms = ahead * (z - sections[:, None])
    size = ahead * (np.abs(z) + np.abs(sections[:, None]))
    span, moments = bearings(engine.throws_m), 1j * _weighted(loads, arms, size)
    if orders is None:
        orders = every[considerable(moments) | (every <= 2)]
    if (told := len(orders) * len(z)) > MOST_RESULTS_ALONG_CRANK:
        raise BalcliError(
            f"along the crankshaft, {len(orders)} orders of {len(z)} cylinders and counterweights "
            f"are {told} results, and at "
            f"most {MOST_RESULTS_ALONG_CRANK} are told: ask for fewer orders"
        )
    return Inner(
        shear=_along(sections, _weighted(loads, ahead, ahead), orders),
        bending=_along(sections, moments, orders),
        bearings=None
        if span is None
        else _along(span, _weighted(loads, *2 * [_shares(z, span)]), orders),
    )


def bearings(throws_m: Array) -> Array | None:
    """Places of main bearings half-way between throws and as far outside; None for throws in one
    place.
    """
    places = np.unique(throws_m)
    if len(places) < 2:
        return None
    between = (places[1:] + places[:-1]) / 2
    return np.array([2 * places[0] - between[0], *between, 2 * places[-1] - between[-1]])


def _shares(z: Array, span: Array) -> Array:
    """Share of each load that each bearing carries: by the lever in its own span; loads outside
    hang on the end spans.
    """
    left = np.clip(np.searchsorted(span, z, side="right") - 1, 0, len(span) - 2)
    right_share = (z - span[left]) / (span[left + 1] - span[left])
    shares = np.zeros((len(span), len(z)))
    loads = np.arange(len(z))
    shares[left, loads] += 1 - right_share
    shares[left + 1, loads] += right_share
    return shares


def _loads(engine: Engine, orders: Array) -> tuple[Phasors, Array]:
    """Forces of each cylinder and counterweight, phasors of shape (orders, loads), and their
    places.
    """
    counterweights = [device for device in engine.devices if on_crank(device)]
    few_enough(engine, len(orders), engine.cylinders.count + len(counterweights))
    forces = [
        each(engine, orders, ["force"])["force"],
        *(weight(engine, device, orders) for device in counterweights),
    ]
    columns = [[f.forward, f.backward, np.broadcast_to(f.noise, f.forward.shape)] for f in forces]
    forward, backward, noise = (np.column_stack(column) for column in zip(*columns, strict=True))
    return Phasors(orders, forward, backward, noise), np.array(
        [*np.ravel(engine.cylinders.z), *(d.z for d in counterweights)], float
    )


def on_crank(device: Device) -> bool:
    """Whether a device turns on the crank's axis, with it: a counterweight."""
    return device.order == 1 and not device.backward and not device.place


def _weighted(loads: Phasors, weights: Array, size: Array) -> Phasors:
    """Sums over the loads, weights of shape (places, loads)."""
    return Phasors(
        loads.orders,
        loads.forward @ weights.T,
        loads.backward @ weights.T,
        loads.noise @ np.abs(size).T,
    ).settled()


def _along(places: Array, phasors: Phasors, orders: Array) -> Along:
    every = Along(places, phasors, ())
    return Along(
        places, phasors.select_orders(orders), tuple(peak(every.at(k)) for k in range(len(places)))
    )
