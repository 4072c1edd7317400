"""Compute the internal loads of an engine by inertia and gas: shear force and bending moment in
crankshaft and block, and loads of the main bearings.

The shaft is treated as cut in each main bearing, so that every span is statically
determinate. The shaft carries the forces of the rods, of the masses that turn with the throws and
of counterweights, and the bearings hold it. The block carries the forces of gas on heads, of
pistons on cylinder walls, of the shaft on bearings, and of balancer shafts and sliders. Gas presses
equally on throw and head. So at every section, the loads of shaft and block add up to the loads by
inertia alone (including balancer shafts and sliders).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from ..core.cylinders import DeviceKind
from ..core.loads import find_ahead, find_arms, share_by_lever
from ..core.peaks import Peak
from ..core.phasors import Array, Complex, Phasors, unit
from ..core.piecewise import Vectors, cut, find_panels, merged_breaks, quadrature
from ..engine.engine import Engine
from ..errors import BalcliError
from ..limits import MOST_FORCES_OVER_CYCLE
from .crankshaft import AlongCrank, InnerLoads, LoadsWithGas, list_places, place_bearings
from .curves import as_rows, compute_device_forces, compute_piecemeal, find_crank_speed
from .rod_forces import compute_rod_forces, list_hung_rows
from .spectrum import list_gas_orders, mark_considerable, take_gas

ROUNDING = 1e-13  # a sum below this share of its terms is a rounding error


class BearingsUnknownError(BalcliError):
    """The positions of the main bearings are not known; `reason` gives the reason."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(f"main bearings: {reason}")


def add_gas_loads(inner: InnerLoads, engine: Engine, orders: Array | None = None) -> InnerLoads:
    """Return the internal loads, completed by `with_gas`, or by the reason why the loads with gas
    are not known (`obstacle`). Other errors are raised as by `compute_loads_with_gas`.

    Args:
        inner: Internal loads of inertia.
        engine: One engine with gas, not an array of variants.
        orders: Orders, shape (orders,); None: the default of `compute_loads_with_gas`.
    """
    try:
        place_main_bearings(engine)
        compute_rod_forces(engine, np.zeros(1))
    except BalcliError as error:
        return inner._replace(obstacle=getattr(error, "reason", str(error)))
    return inner._replace(with_gas=compute_loads_with_gas(engine, orders))


def compute_loads_with_gas(engine: Engine, orders: Array | None = None) -> LoadsWithGas:
    """Return loads of shaft, bearings and block by order, and their largest values over the cycle.

    Args:
        engine: One engine with gas of known pressure, not an array of variants.
        orders: Orders that are returned, ascending, shape (orders,); default: those of
            `list_gas_orders` in which a bending moment is worth showing.

    Raises:
        BalcliError: There is no gas, no pressure or no main bearing (`place_main_bearings`), or
            there are so many cylinders that their forces would fill the memory.
    """
    span = place_main_bearings(engine)
    shown = list_gas_orders(engine) if orders is None else orders

    def add_up(crank_deg: Array) -> Complex:
        return np.concatenate(compute_forces_along(engine, crank_deg))

    compute = partial(compute_in_pieces, engine, add_up)
    panels = find_panels(compute, find_breaks(engine), float(shown.max()))
    samples = compute(panels.angles)
    on_shaft, on_block = _place_forces(engine)
    shares = share_by_lever(on_shaft, span)
    sections = list_places(np.concatenate([on_shaft, on_block, span]))
    reach = 2 * float(np.abs(sections).max())  # bound of the terms of the arms

    largest = float(np.abs(samples).max(axis=1).sum())

    def follow(z: Array, weights: Array, factor: complex = 1.0, size: float = 1.0) -> AlongCrank:
        """Return orders and largest values of weighted sums of the forces at some places. Values
        below rounding become 0.

        Args:
            z: Axial places, m, shape (places,).
            weights: Share of each force at each place, shape (places, forces).
            factor: Factor of all values.
            size: Bound of the terms from which the weights are computed; it determines the rounding
                error of the values.
        """
        values = factor * (weights @ samples)
        least = ROUNDING * size * largest
        forward, backward = panels.find_orders(values, shown)
        phasors = Phasors.of(shown, forward, backward, np.full(forward.shape, least))
        peaks = map(panels.find_largest, values)
        felt = tuple(peak if peak.value > least else Peak(0.0, 0.0) for peak in peaks)
        return AlongCrank(z, phasors.drop_noise(), felt)

    def cut(weigh: Callable[[Array, Array], Array]) -> tuple[Array, Array]:
        """Return the weights of all forces in the sums at each section, for the shaft and for the
        block.
        """
        borne = weigh(span, sections) @ shares
        own = weigh(on_shaft, sections)
        of_block = weigh(on_block, sections)
        return np.hstack([own - borne, 0 * of_block]), np.hstack([borne, of_block])

    shear, block_shear = cut(find_ahead)
    bending, block_bending = cut(find_arms)
    loads = LoadsWithGas(
        follow(sections, shear),
        follow(sections, bending, 1j, reach),
        follow(span, np.pad(shares, ((0, 0), (0, len(on_block))))),
        follow(sections, block_shear),
        follow(sections, block_bending, 1j, reach),
    )
    if orders is not None:
        return loads
    due = mark_considerable(loads.bending.phasors) | mark_considerable(loads.block_bending.phasors)
    return LoadsWithGas(*(along.select_orders(shown[due]) for along in loads))


def place_main_bearings(engine: Engine) -> Array:
    """Return the positions of the main bearings (`place_bearings`), m, shape (bearings,).

    Raises:
        BearingsUnknownError: The positions of the throws are not known, there is one throw, or the
            crank stands still.
    """
    if engine.rotary:
        raise BearingsUnknownError("the crank of a rotary engine stands still, clamped at its end")
    if not engine.places_known:
        raise BearingsUnknownError("crank.spacing is missing, so their positions are not known")
    span = place_bearings(engine)
    if span is None:
        raise BearingsUnknownError("a crank with one throw does not determine their positions")
    return span


def find_breaks(engine: Engine) -> Array:
    """Return crank angles (rad) from 0 to the end of a cycle, between which forces are smooth."""
    gas = take_gas(engine)
    parts = [(cylinder.torque.breaks, cylinder.fires) for cylinder in gas.cylinders]
    return merged_breaks(parts, gas.cycle)


def compute_bearing_loads(engine: Engine, crank_deg: Array) -> Complex:
    """Return the force of the shaft on each main bearing, x + iy, N, shape (bearings, angles);
    errors are raised as by `place_main_bearings` and `compute_rod_forces`.

    Args:
        engine: One engine with gas, not an array of variants.
        crank_deg: Crank angles, deg, shape (angles,).
    """
    shares = share_by_lever(_place_forces(engine)[0], place_main_bearings(engine))
    return np.asarray(shares @ compute_forces_along(engine, crank_deg)[0])


def compute_forces_along(engine: Engine, crank_deg: Array) -> tuple[Complex, Complex]:
    """Return the forces on shaft and on block over the crank angle, x + iy, N, each of shape
    (places, angles): forces of the cylinders in the order of `engine.numbers`, then of the devices.
    Articulated rods press on the shaft at the positions of their own cylinders.

    Args:
        engine: One engine, not an array of variants.
        crank_deg: Crank angles, deg, shape (angles,).
    """
    rods = compute_rod_forces(engine, crank_deg)
    pressed = rods.axis * rods.pin
    for master, hung in list_hung_rows(engine).items():
        pressed[master] -= pressed[hung].sum(axis=0)
    c = engine.cylinders
    speed, rate = find_crank_speed(engine, crank_deg)
    throws = np.array([[float(weighed.share)] for weighed in engine.weighed]) * as_rows(c.radius)
    pins_deg = float(engine.first_axis_deg) + np.ravel(c.pin_deg)[:, None]
    turning = throws * (speed**2 - 1j * rate) * unit(crank_deg + pins_deg)
    devices = compute_device_forces(engine, crank_deg)
    on_crank = np.array([d.kind is DeviceKind.COUNTERWEIGHT for d in engine.devices], bool)
    on_walls = rods.axis * (rods.gas + 1j * rods.thrust)
    on_shaft = np.concatenate([pressed + turning, devices[on_crank]])
    return on_shaft, np.concatenate([on_walls, devices[~on_crank]])


def _place_forces(engine: Engine) -> tuple[Array, Array]:
    """Return the axial positions of the forces on shaft and on block, m."""
    cylinders = np.ravel(engine.cylinders.z).tolist()
    turning = [float(d.z) for d in engine.devices if d.kind is DeviceKind.COUNTERWEIGHT]
    others = [float(d.z) for d in engine.devices if d.kind is not DeviceKind.COUNTERWEIGHT]
    return np.array([*cylinders, *turning]), np.array([*cylinders, *others])


def refuse_too_many_forces(engine: Engine, angles: int = 0) -> None:
    """Raise an error if there are too many forces over a cycle.

    Args:
        engine: Engine with gas.
        angles: Number of crank angles; 0: the smallest number that the breaks of the cycle need.

    Raises:
        BalcliError: There are too many; the error states the numbers.
    """
    angles = angles or quadrature(cut(find_breaks(engine), 0.5))[0].size
    cylinders = engine.cylinders.count
    count = 2 * engine.cylinders.count + len(engine.devices)
    if count * angles > MOST_FORCES_OVER_CYCLE:
        raise BalcliError(
            f"loads with gas: {count} forces of {cylinders} cylinders at {angles} angles of the "
            f"cycle are {count * angles}, and at most {MOST_FORCES_OVER_CYCLE} are computed; "
            "give fewer cylinders, or an indicator diagram with fewer rows"
        )


def compute_in_pieces(engine: Engine, compute: Vectors, angles: Array) -> Complex:
    """Return forces of an engine at crank angles, shape (forces, angles), computed piece by piece
    to save memory.

    Args:
        engine: Engine.
        compute: Function that returns the forces at crank angles (deg).
        angles: Crank angles, rad, shape (angles,).

    Raises:
        BalcliError: There are too many forces.
    """
    refuse_too_many_forces(engine, len(angles))
    return compute_piecemeal(engine, np.degrees(angles), lambda some: {"": compute(some)})[""]
