"""What the forces of an engine with gas do inside: to the crankshaft, which counts as cut in each
of its main bearings, to these bearings, and to the block.

On the shaft press the rods; what turns with the throws, and counterweights, pull at it; bearings
hold it. On the block press the gas on each head, the piston on each cylinder wall, the shaft on
each bearing, and balancer shafts and sliders. The gas presses on throw and head alike, so that
shaft and block together bear at every section what `forces.crankshaft` says of inertia, and what
the block's own devices add. Sections count as there, from the free end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.levers import find_ahead, find_arms, share_by_lever
from ..core.peaks import Peak
from ..core.phasors import Array, Complex, Phasors, unit
from ..core.piecewise import merged_breaks
from ..core.vectors_over_cycle import Vectors, find_panels
from ..engine.build import Engine
from ..errors import BalcliError
from ..limits import MOST_FORCES_OVER_CYCLE
from .crankshaft import AlongCrank, InnerLoads, is_counterweight, place_bearings
from .curves import compute_device_forces, compute_piecemeal, find_crank_speed
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
    reach = 2 * float(np.abs(sections).max())  # bounds what arms are differences of

    largest = float(np.abs(samples).max(axis=1).sum())

    def follow(z: Array, weights: Array, factor: complex = 1.0, size: float = 1.0) -> AlongCrank:
        """Orders and largest values of the sums at some places; what is rounding error is 0."""
        values, least = factor * (weights @ samples), NOTHING * size * largest
        forward, backward = panels.find_orders(values, shown)
        phasors = Phasors.of(shown, forward, backward, np.full(forward.shape, least))
        peaks = map(panels.find_largest, values)
        felt = tuple(peak if peak.value > least else Peak(0.0, 0.0) for peak in peaks)
        return AlongCrank(z, phasors.drop_noise(), felt)

    def cut(weigh: Callable[[Array, Array], Array]) -> tuple[Array, Array]:
        """Weights of all forces in the sum at each section, of the shaft and of the block."""
        borne = weigh(span, sections) @ shares
        own, of_block = weigh(on_shaft, sections), weigh(on_block, sections)
        return np.hstack([own - borne, 0 * of_block]), np.hstack([borne, of_block])

    shear, block_shear = cut(find_ahead)
    bending, block_bending = cut(find_arms)
    found = LoadsWithGas(
        follow(sections, shear),
        follow(sections, bending, 1j, reach),
        follow(span, np.pad(shares, ((0, 0), (0, len(on_block))))),
        follow(sections, block_shear),
        follow(sections, block_bending, 1j, reach),
    )
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
    return compute_piecemeal(engine, np.degrees(angles), lambda some: {"": compute(some)})[""]
