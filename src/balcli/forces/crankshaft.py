"""Compute the internal loads of an engine: shear force and bending moment in crankshaft and block,
and loads of the main bearings.

Inertia: the shaft is rigid. At each section the shear force is the sum of all loads between the
free end and the section, and the bending moment is the moment of these loads about the section,
`i sum (z_i - z) F_i` (M_x + iM_y). Just behind the last load, the shear force is the free force,
and the bending moment is the free moment about the position of this load. The bending moment is
linear between loads, so its maxima are at loads.

Gas and inertia: the shaft is treated as cut in each main bearing, so that every span is statically
determinate. The shaft carries the forces of the rods, of the masses that turn with the throws and
of counterweights, and the bearings hold it. The block carries the forces of gas on heads, of
pistons on cylinder walls, of the shaft on bearings, and of balancer shafts and sliders. Gas presses
equally on throw and head. So at every section, the loads of shaft and block add up to the loads by
inertia alone (including balancer shafts and sliders).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from ..core.cylinders import DeviceKind
from ..core.loads import (
    find_ahead,
    find_arms,
    share_by_lever,
    sum_by_lever,
    sum_to_sections,
)
from ..core.peaks import Peak, find_largest, find_peaks
from ..core.phasors import Array, Complex, Phasors, join_places, unit
from ..core.piecewise import Vectors, cut, find_panels, merged_breaks, quadrature
from ..engine.engine import Engine
from ..engine.figures import find_first_largest
from ..errors import BalcliError
from ..limits import MOST_FORCES_OVER_CYCLE, MOST_RESULTS_ALONG_CRANK
from .curves import as_rows, compute_device_forces, compute_piecemeal, find_crank_speed
from .rod_forces import compute_rod_forces, list_hung_rows
from .spectrum import (
    compute_forces_of_devices,
    compute_spectra,
    find_relevant_orders,
    list_gas_orders,
    mark_considerable,
    merge_orders,
    refuse_too_many_loads,
    take_gas,
)


class AlongCrank(NamedTuple):
    """A force or moment at several places along the crank.

    Attributes:
        z_m: Position along the crank, m, shape (places,), ascending.
        phasors: Force, N, or moment, N m, shape (orders, places).
        peaks: Largest value over a revolution at each place (sum of all orders), and its crank
            angle.
    """

    z_m: Array
    phasors: Phasors
    peaks: tuple[Peak, ...]

    def at(self, place: int) -> Phasors:
        """Return the phasors at one of the places, by its index."""
        return self.phasors.select_place(place)

    def select_orders(self, orders: Array) -> AlongCrank:
        """Return the force or moment with these orders; peaks remain those of all orders."""
        return self._replace(phasors=self.phasors.select_orders(orders))

    @property
    def largest(self) -> int:
        """Index of the place with the highest peak; the first of several equal ones."""
        return int(find_first_largest([peak.value for peak in self.peaks]))

    @property
    def highest(self) -> tuple[float, float]:
        """Value of the highest peak, and its position, mm."""
        return self.peaks[self.largest].value, 1e3 * float(self.z_m[self.largest])


class InnerLoads(NamedTuple):
    """Inertia loads: shear force (N) and bending moment (N m) just behind each load, and loads of
    the main bearings (N).

    The file gives the positions of the bearings (`bearing.main_positions`), or bearings are assumed
    half-way between neighbouring throws, and outside the end throws. An assumed end bearing is as
    far from the end throw as the bearing on the other side of this throw. The shaft is treated as
    cut in each bearing, so that every span is statically determinate. For a crank with one throw
    and without given positions, the positions are not known, and `bearings` is None.

    Attributes:
        with_gas: Loads of shaft, bearings and block by inertia and gas; None without gas, or if
            they are not known.
        obstacle: Reason why the loads with gas are not known.
        has_given_bearings: Whether the file gives the positions of the bearings.
    """

    shear: AlongCrank
    bending: AlongCrank
    bearings: AlongCrank | None
    with_gas: LoadsWithGas | None = None
    obstacle: str = ""
    has_given_bearings: bool = False


@dataclass(frozen=True, kw_only=True)
class CrankLoads:
    """Largest inertia loads within a crankshaft.

    Attributes:
        main_N: Largest load of a main bearing; left out where all throws are at one position.
        main_mm: Axial position of this bearing; left out where all throws are at one position.
        inner_moment_Nm: Largest bending moment.
        inner_mm: Axial position of the largest bending moment.
    """

    main_N: float | None = None
    main_mm: float | None = None
    inner_moment_Nm: float
    inner_mm: float


class _Sums(NamedTuple):
    """Sums of the loads along the crank.

    Attributes:
        orders: Orders that are returned, shape (orders,).
        loads: Forces of cylinders and counterweights, N, shape (every order, loads).
        z: Positions of the loads, m, shape (loads,).
        sections: Different positions of the loads, m, ascending, shape (sections,).
        shear: Shear force just behind each section, N, shape (every order, sections).
        bending: Bending moment there, N m, of the same shape.
        span: Positions of the main bearings, m, shape (bearings,); None: not known.
    """

    orders: Array
    loads: Phasors
    z: Array
    sections: Array
    shear: Phasors
    bending: Phasors
    span: Array | None

    def find_bearing_forces(self, span: Array) -> Phasors:
        """Return the forces on main bearings at these positions, N, shape (every order,
        bearings).
        """
        return compute_bearing_forces(self.loads, self.z, span)


def _sum_along(engine: Engine, orders: Array | None) -> _Sums:
    """Return the sums of the loads along the crank; see `compute_inner_loads` for the arguments."""
    every = merge_orders(find_relevant_orders(engine), [1, 2] if orders is None else orders)
    loads, z = compute_loads(engine, every)
    sections = list_places(z)
    shear, arms = sum_to_sections(loads, z, sections)
    bending = 1j * arms
    if orders is None:
        orders = every[mark_considerable(bending) | (every <= 2)]
    if len(orders) * len(z) > MOST_RESULTS_ALONG_CRANK:
        raise BalcliError(
            f"along the crankshaft, {len(orders)} orders of {len(z)} cylinders and counterweights "
            f"are {len(orders) * len(z)} results, and at most {MOST_RESULTS_ALONG_CRANK} are "
            "listed; give fewer orders"
        )
    return _Sums(orders, loads, z, sections, shear, bending, place_bearings(engine))


def compute_inner_loads(engine: Engine, orders: Array | None = None) -> InnerLoads:
    """Return forces and moments in the crankshaft by inertia, and the peaks of the sum of all
    orders.

    Args:
        engine: One engine, not an array of variants.
        orders: Orders that are returned, ascending, shape (orders,); default: 1, 2 and those in
            which the bending moment is worth showing.

    Raises:
        BalcliError: Orders x loads exceed a limit; the error states this limit.
    """
    along = _sum_along(engine, orders)
    bearings = None
    if along.span is not None:
        bearings = _with_peaks(along.span, along.find_bearing_forces(along.span), along.orders)
    return InnerLoads(
        shear=_with_peaks(along.sections, along.shear, along.orders),
        bending=_with_peaks(along.sections, along.bending, along.orders),
        bearings=bearings,
        has_given_bearings=engine.has_given_bearings,
    )


def find_crank_loads(engine: Engine) -> CrankLoads | None:
    """Return the largest inertia loads in the crankshaft of an engine with its counterweights; None
    if axial positions are not known, for rotary and geared engines, and if there are too many
    loads.
    """
    if not engine.places_known or engine.rotary or engine.placed:
        return None
    try:
        along = _sum_along(engine, None)
    except BalcliError:
        return None
    main_N = None
    main_mm = None
    if along.span is not None:
        main_N, main_mm = _find_highest(along.span, along.find_bearing_forces(along.span))
    moment, inner_mm = _find_highest(along.sections, along.bending)
    return CrankLoads(main_N=main_N, main_mm=main_mm, inner_moment_Nm=moment, inner_mm=inner_mm)


def _find_highest(places: Array, phasors: Phasors) -> tuple[float, float]:
    """Return the highest peak of phasors of shape (orders, places), and its position, mm, for
    places in m.
    """
    values = find_largest(phasors).tolist()
    largest = int(find_first_largest(values))
    return values[largest], 1e3 * float(places[largest])


def place_bearings(engine: Engine) -> Array | None:
    """Return positions of main bearings (see `InnerLoads`), m, shape (bearings,); None if the file
    gives none and all throws have the same position.
    """
    bearings = engine.bearings
    if bearings is not None and bearings.main_positions_m is not None:
        return np.array(bearings.main_positions_m)
    places = list_places(engine.joined_throws_m)
    if len(places) < 2:
        return None
    between = (places[1:] + places[:-1]) / 2
    return np.array([2 * places[0] - between[0], *between, 2 * places[-1] - between[-1]])


def compute_bearing_forces(loads: Phasors, z: Array, bearings_m: Array) -> Phasors:
    """Return the forces on main bearings, N, phasors of shape (orders, bearings).

    Args:
        loads: Forces, shape (orders, loads).
        z: Positions of the forces, m, shape (loads,).
        bearings_m: Positions of the bearings, from `place_bearings`.
    """
    return sum_by_lever(loads, z, bearings_m)


def compute_loads(engine: Engine, orders: Array) -> tuple[Phasors, Array]:
    """Return the forces of each cylinder and counterweight, phasors of shape (orders, loads), and
    their positions, m, shape (loads,).
    """
    counterweights = [d for d in engine.devices if d.kind is DeviceKind.COUNTERWEIGHT]
    refuse_too_many_loads(engine, len(orders), engine.cylinders.count + len(counterweights))
    by_cylinder = compute_spectra(engine, orders, ["force"], by_cylinder=True)["force"]
    more = compute_forces_of_devices(engine, counterweights, orders)
    places = [*np.ravel(engine.cylinders.z), *(device.z for device in counterweights)]
    return join_places([by_cylinder, more]), np.array(places, float)


def list_places(z: Array) -> Array:
    """Return the different positions, ascending (not by `numpy.unique`, which imports more)."""
    return np.array(sorted(set(z.tolist())))


def _with_peaks(places: Array, phasors: Phasors, orders: Array) -> AlongCrank:
    """Return phasors of shape (orders, places) at some orders, with the peaks of all orders."""
    return AlongCrank(places, phasors.select_orders(orders), find_peaks(phasors))


ROUNDING = 1e-13  # a sum below this share of its terms is a rounding error


class LoadsWithGas(NamedTuple):
    """Forces (N) and moments (N m) over the cycle by inertia and gas, exact for rods of distributed
    mass.

    Attributes:
        shear: Shear force in the crankshaft, just behind each load and bearing.
        bending: Bending moment in the crankshaft.
        bearings: Forces of the shaft on the main bearings.
        block_shear: Shear force in the block, without the forces of its mounts.
        block_bending: Bending moment in the block, without the forces of its mounts.
    """

    shear: AlongCrank
    bending: AlongCrank
    bearings: AlongCrank
    block_shear: AlongCrank
    block_bending: AlongCrank


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


def find_shear_stress(diameter: float, bore: float) -> float:
    """Return the nominal shear stress at the surface of a round shaft under a torque of 1 N m, Pa:
    `16 D/(pi (D^4 - d^4))`.

    Args:
        diameter: Outer diameter D, m.
        bore: Inner diameter d, m.
    """
    return 16 * diameter / (math.pi * (diameter**4 - bore**4))
