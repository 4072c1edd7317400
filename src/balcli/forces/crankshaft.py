"""Compute the internal loads of an engine by inertia: shear force and bending moment in the
crankshaft, and loads of the main bearings.

Inertia: the shaft is rigid. At each section the shear force is the sum of all loads between the
free end and the section, and the bending moment is the moment of these loads about the section,
`i sum (z_i - z) F_i` (M_x + iM_y). Just behind the last load, the shear force is the free force,
and the bending moment is the free moment about the position of this load. The bending moment is
linear between loads, so its maxima are at loads.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from ..core.cylinders import DeviceKind
from ..core.loads import sum_by_lever, sum_to_sections
from ..core.peaks import Peak, find_largest, find_peaks
from ..core.phasors import Array, Phasors, join_places
from ..engine.engine import Engine
from ..engine.figures import find_first_largest
from ..errors import BalcliError
from ..limits import MOST_RESULTS_ALONG_CRANK
from .spectrum import (
    compute_forces_of_devices,
    compute_spectra,
    find_relevant_orders,
    mark_considerable,
    merge_orders,
    refuse_too_many_loads,
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

    def select_orders(self, orders: Array) -> Self:
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


class InnerLoads(NamedTuple):
    """Inertia loads: shear force (N) and bending moment (N m) just behind each load, and loads of
    the main bearings (N).

    The file gives the positions of the bearings (`bearing.main_positions`), or bearings are assumed
    half-way between neighbouring throws, and outside the end throws. An assumed end bearing is as
    far from the end throw as the bearing on the other side of this throw. The shaft is treated as
    cut in each bearing, so that every span is statically determinate. For a crank with one throw
    and without given positions, the positions are not known, and `bearings` is None.

    Attributes:
        with_gas: Loads of shaft, bearings and block by inertia and gas (`forces.loads_with_gas`);
            None without gas, or if they are not known.
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


def find_shear_stress(diameter: float, bore: float) -> float:
    """Return the nominal shear stress at the surface of a round shaft under a torque of 1 N m, Pa:
    `16 D/(pi (D^4 - d^4))`.

    Args:
        diameter: Outer diameter D, m.
        bore: Inner diameter d, m.
    """
    return 16 * diameter / (math.pi * (diameter**4 - bore**4))
