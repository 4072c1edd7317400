"""What the forces of an engine with gas do inside: to the crankshaft, which counts as cut in each
of its main bearings, to these bearings, and to the block.

On the shaft press the rods; what turns with the throws, and counterweights, pull at it; bearings
hold it. On the block press the gas on each head, the piston on each cylinder wall, the shaft on
each bearing, and balancer shafts and sliders. The gas presses on throw and head alike, so that
shaft and block together bear at every section what `forces.crankshaft` says of inertia, and what
the block's own devices add. Sections count as there, from the free end.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.levers import bound_arms, find_ahead, find_arms, share_by_lever
from ..core.peaks import Peak
from ..core.phasors import Array, Complex, Phasors, unit
from ..core.piecewise import merged_breaks
from ..core.vectors_over_cycle import Panels, Vectors, find_panels
from ..engine.build import Engine
from ..errors import BalcliError
from ..limits import MOST_FORCES_OVER_CYCLE
from .crankshaft import AlongCrank, InnerLoads, is_counterweight, place_bearings
from .curves import AT_ONCE, compute_device_forces, find_crank_speed
from .gas import take_gas
from .orders import list_gas_orders, mark_considerable
from .rod_forces import compute_rod_forces, list_hung_rows

NOTHING = 1e-13  # share of what is added up below which a sum is rounding errors


class LoadsWithGas(NamedTuple):
    """Forces (N) and moments (N m) over the cycle, of inertia and gas, with a distributed rod.

    Attributes:
        shear, bending: in the crankshaft, the shear just behind each load and bearing.
        bearings: of the shaft on each.
        block_shear, block_bending: in the block likewise, which nothing else holds.
    """

    shear: AlongCrank
    bending: AlongCrank
    bearings: AlongCrank
    block_shear: AlongCrank
    block_bending: AlongCrank


class ForcesAlongCrank(NamedTuple):
    """Forces on shaft and block, x + iy, N, each of shape (places, angles): of every cylinder in
    the order of `engine.numbers`, then of the devices.
    """

    on_shaft: Complex
    on_block: Complex


class _Sums(NamedTuple):
    """Sums of all forces at places along the crank, and the sizes that they are made of, each of
    shape (places, forces); `factor` is i for moments.
    """

    z: Array
    weights: Array
    sizes: Array
    factor: complex = 1.0


class BearingsUnknownError(BalcliError):
    """It is not known where the main bearings stand, for a reason."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(f"main bearings: {reason}")


def add_gas_loads(inner: InnerLoads, engine: Engine, orders: Array | None = None) -> InnerLoads:
    """The inner loads of an engine with gas, with what gas does inside as far as it is known;
    arguments and errors else as of `compute_loads_with_gas`.
    """
    try:
        place_main_bearings(engine)
        compute_rod_forces(engine, np.zeros(1))
    except BearingsUnknownError as error:
        return replace(inner, obstacle=error.reason)
    except BalcliError as error:
        return replace(inner, obstacle=str(error))
    return replace(inner, with_gas=compute_loads_with_gas(engine, orders))


def compute_loads_with_gas(engine: Engine, orders: Array | None = None) -> LoadsWithGas:
    """Loads of shaft, bearings and block for some orders, and the largest over the cycle.

    Args:
        engine: with gas of known pressure, without trailing axes.
        orders: shape (orders,), ascending; default: those of `list_gas_orders` in which some
            bending moment is worth showing.

    Raises:
        BalcliError: no gas, no pressures; bearings that `place_main_bearings` refuses; so many
            cylinders that all forces would fill the memory.
    """
    span = place_main_bearings(engine)
    shown = list_gas_orders(engine) if orders is None else orders

    def compute(angles: Array) -> Complex:
        return compute_in_pieces(
            engine, lambda degrees: np.concatenate(compute_forces_along(engine, degrees)), angles
        )

    panels = find_panels(compute, find_breaks(engine), float(shown.max()))
    samples = compute(panels.angles)
    on_shaft, on_block = _place_forces(engine)
    shares = share_by_lever(on_shaft, span)
    sections = np.unique(np.concatenate([on_shaft, on_block, span]))
    every = (
        *_cut_shaft(sections, on_shaft, len(on_block), span, shares),
        _load_bearings(span, shares, len(on_block)),
        *_cut_block(sections, on_block, span, shares),
    )
    found = LoadsWithGas(*(_follow(sums, samples, panels, shown) for sums in every))
    if orders is not None:
        return found
    bent = found.bending.phasors, found.block_bending.phasors
    due = np.any([mark_considerable(phasors) for phasors in bent], axis=0)
    return LoadsWithGas(*(along.select_orders(shown[due]) for along in found))


def place_main_bearings(engine: Engine) -> Array:
    """Places of the main bearings, m: half-way between throws and as far outside the end ones.

    Raises:
        BearingsUnknownError: it is not known where the throws stand, there is one alone, or the
            crank stands still.
    """
    if engine.rotary:
        raise BearingsUnknownError(
            "the crank of turning cylinders stands still, clamped at its end"
        )
    if not engine.places_known:
        raise BearingsUnknownError("crank.spacing is missing, so that no bearing is known to stand")
    span = place_bearings(engine.throws_m)
    if span is None:
        raise BearingsUnknownError("a crank with one throw does not say where its bearings stand")
    return span


def find_breaks(engine: Engine) -> Array:
    """Crank angles (rad) from 0 to the end of a cycle, between which all forces are smooth."""
    gas = take_gas(engine)
    parts = [(cylinder.torque.breaks, cylinder.fires) for cylinder in gas.cylinders]
    return merged_breaks(parts, gas.cycle)


def compute_bearing_loads(engine: Engine, crank_deg: Array) -> Complex:
    """Force of the shaft on each main bearing, x + iy, N, shape (bearings, angles); errors as of
    `place_main_bearings` and `compute_rod_forces`.
    """
    shares = share_by_lever(_place_forces(engine)[0], place_main_bearings(engine))
    return np.asarray(shares @ compute_forces_along(engine, crank_deg).on_shaft)


def compute_forces_along(engine: Engine, crank_deg: Array) -> ForcesAlongCrank:
    """Forces at crank angles, shape (angles,); articulated rods press on the shaft where their own
    cylinders stand.
    """
    found = compute_rod_forces(engine, crank_deg)
    pressed = found.axis * found.pin
    for master, hung in list_hung_rows(engine).items():
        pressed[master] -= pressed[hung].sum(axis=0)
    c, (speed, rate) = engine.cylinders, find_crank_speed(engine, crank_deg)
    throws = np.array([[float(weighed.share)] for weighed in engine.weighed]) * float(c.radius)
    pins_deg = float(engine.first_axis_deg) + np.ravel(c.pin_deg)[:, None]
    turning = throws * (speed**2 - 1j * rate) * unit(crank_deg + pins_deg)
    devices = compute_device_forces(engine, crank_deg)
    on_crank = np.array([is_counterweight(device) for device in engine.devices], bool)
    on_walls = found.axis * (found.gas + 1j * found.thrust)
    return ForcesAlongCrank(
        np.concatenate([pressed + turning, devices[on_crank]]),
        np.concatenate([on_walls, devices[~on_crank]]),
    )


def _place_forces(engine: Engine) -> tuple[Array, Array]:
    """z of the forces on shaft and block, m."""
    cylinders = np.ravel(engine.cylinders.z).tolist()
    turning = [float(d.z) for d in engine.devices if is_counterweight(d)]
    others = [float(d.z) for d in engine.devices if not is_counterweight(d)]
    return np.array([*cylinders, *turning]), np.array([*cylinders, *others])


def compute_in_pieces(engine: Engine, compute: Vectors, angles: Array) -> Complex:
    """Forces of an engine at crank angles (rad), a row each, by so many angles at a time that
    memory stays small.

    Args:
        compute: the forces at crank angles (deg).

    Raises:
        BalcliError: more figures than are kept.
    """
    count = 2 * engine.cylinders.count + len(engine.devices)
    if count * len(angles) > MOST_FORCES_OVER_CYCLE:
        raise BalcliError(
            f"loads with gas of {engine.cylinders.count} cylinders are {count * len(angles)} "
            f"forces over the cycle, and at most {MOST_FORCES_OVER_CYCLE} are kept"
        )
    step, degrees = max(AT_ONCE // count, 1), np.degrees(angles)
    parts = [compute(degrees[k : k + step]) for k in range(0, len(degrees), step)]
    return np.concatenate(parts, axis=1)


# ------------------------------------------------------------------ sums along the crank
# Of shear force and bending moment: how much a force adds at a section, a bound of that, and what
# the sum is multiplied by.
_CUTS = ((find_ahead, find_ahead, 1.0), (find_arms, bound_arms, 1j))


def _beside(weights: Array, more: int) -> Array:
    """Weights of the forces on the shaft, and none of so many on the block."""
    return np.pad(weights, ((0, 0), (0, more)))


def _load_bearings(span: Array, shares: Array, more: int) -> _Sums:
    """Loads of the bearings."""
    return _Sums(span, _beside(shares, more), _beside(np.abs(shares), more))


def _cut_shaft(sections: Array, z: Array, more: int, span: Array, shares: Array) -> Iterator[_Sums]:
    """Shear behind, and bending moment at, each section: of its own forces less the bearings'."""
    for weigh, bound, factor in _CUTS:
        weights = weigh(z, sections) - weigh(span, sections) @ shares
        sizes = bound(z, sections) + bound(span, sections) @ np.abs(shares)
        yield _Sums(sections, _beside(weights, more), _beside(sizes, more), factor)


def _cut_block(sections: Array, z: Array, span: Array, shares: Array) -> Iterator[_Sums]:
    """Shear behind, and bending moment at, each section: of the bearings' forces and its own."""
    for weigh, bound, factor in _CUTS:
        weights = np.hstack([weigh(span, sections) @ shares, weigh(z, sections)])
        sizes = np.hstack([bound(span, sections) @ np.abs(shares), bound(z, sections)])
        yield _Sums(sections, weights, sizes, factor)


def _follow(sums: _Sums, samples: Complex, panels: Panels, orders: Array) -> AlongCrank:
    """Orders and largest values of sums of forces; what is rounding error is 0."""
    values = sums.factor * (sums.weights @ samples)
    noise = NOTHING * (sums.sizes @ np.abs(samples).max(axis=1))
    forward, backward = panels.find_orders(values, orders)
    phasors = Phasors.of(orders, forward, backward, np.broadcast_to(noise, forward.shape))
    peaks = (
        peak if peak.value > least else Peak(0.0, 0.0)
        for peak, least in zip(map(panels.find_largest, values), noise, strict=True)
    )
    return AlongCrank(sums.z, phasors.drop_noise(), tuple(peaks))
