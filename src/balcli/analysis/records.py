"""Define the records of an analysis: each cylinder's share, loads along the crank, guide-force
moments, strokes, devices, journals and masses.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, NamedTuple

from ..core.peaks import Peak
from ..core.phasors import Array, Phasors
from ..core.records import HIDDEN, INLINE, Reached, WrittenAs, remove_unit
from ..engine.engine import CylinderNumber
from ..file import model
from ..file.doubt import Doubt
from ..file.fields import order_number
from ..forces.crankshaft import AlongCrank, CrankLoads, InnerLoads
from ..forces.guide import GuideMoments
from ..forces.spectrum import Spectra
from ..show.figures import (
    Harmonic,
    Peaks,
    Vector,
    list_harmonics,
    list_orders,
    list_vectors,
)
from ..sizing.planes import DeviceTable, find_free, find_unbalance
from ..sizing.remedy import Remedy, WebCure


class CylinderShare(NamedTuple):
    """Forces and moments of a single cylinder.

    Attributes:
        cylinder: Number of the cylinder; for geared engines, with the name of its engine.
        spectra: Orders of the cylinder's forces and moments.
    """

    cylinder: CylinderNumber
    spectra: Annotated[Spectra, WrittenAs(list_orders, "orders")]


class BankShare(NamedTuple):
    """Forces and moments of a single bank: the sum of those of its cylinders.

    Attributes:
        axis_deg: Angle of the cylinder axes of the bank, from x.
        cylinders: Numbers of its cylinders.
        spectra: Orders of the bank's forces and moments.
    """

    axis_deg: float
    cylinders: tuple[CylinderNumber, ...]
    spectra: Annotated[Spectra, WrittenAs(list_orders, "orders")]


@dataclass(frozen=True, eq=False, repr=False)
class PeaksAndOrders:
    """Peaks and orders of an engine.

    Attributes:
        peak: Largest values over a revolution.
        spectra: All orders that were computed.
        bearings: Largest loads within the crankshaft.
    """

    peak: Peaks
    spectra: Annotated[Spectra, WrittenAs(list_orders, "orders")]
    bearings: CrankLoads | None = None


# ------------------------------------------------------------------ along the crank
class LoadOrder(NamedTuple):
    """One order of a load at one place.

    Attributes:
        order: Order.
        vector: Load of this order.
    """

    order: float
    vector: Annotated[Vector, INLINE]


def list_load_orders(load: Phasors) -> list[LoadOrder]:
    """Return the orders of a load at one place."""
    return list(map(LoadOrder, map(order_number, load.orders), list_vectors(load)))


class Load(NamedTuple):
    """A load at one place: its largest value over the cycle, and its orders.

    Attributes:
        peak: Largest value and its crank angle.
        phasors: Orders of the load.
    """

    peak: Annotated[Peak, Reached("peak", "peak_deg"), INLINE]
    phasors: Annotated[Phasors, WrittenAs(list_load_orders, "orders")]


class Section(NamedTuple):
    """Shear force and bending moment just behind one load, on its flywheel side.

    Attributes:
        position_mm: Position along the crank.
        shear_N: Shear force.
        bending_Nm: Bending moment.
    """

    position_mm: float
    shear_N: Load
    bending_Nm: Load


class Bent(NamedTuple):
    """Shear force and bending moment of the crankshaft or the block, section by section.

    Attributes:
        largest_bending_Nm: Largest bending moment of all sections.
        largest_at_mm: Position of the largest bending moment.
        sections: All sections, from the free end.
    """

    largest_bending_Nm: float
    largest_at_mm: float
    sections: tuple[Section, ...]


class BearingLoad(NamedTuple):
    """The load of one main bearing.

    Attributes:
        position_mm: Position of the bearing along the crank.
        load_N: Load of the bearing.
    """

    position_mm: float
    load_N: Load


class WithGas(NamedTuple):
    """Loads of inertia and gas; gas bends crankshaft and block in opposite directions.

    Attributes:
        crankshaft: Loads of the crankshaft, cut in each main bearing.
        bearings: Loads of the main bearings.
        block: Loads of the block.
    """

    crankshaft: Bent
    bearings: tuple[BearingLoad, ...]
    block: Bent


class Inner(NamedTuple):
    """Loads along the crankshaft.

    Attributes:
        inertia: Loads of inertia only.
        bearings: Inertia loads of the main bearings; left out for a crank with one throw.
        with_gas: Loads of inertia and gas.
        obstacle: Reason why loads with gas are not known.
    """

    inertia: Annotated[Bent, INLINE]
    bearings: tuple[BearingLoad, ...] | None = None
    with_gas: WithGas | None = None
    obstacle: str | None = None


def describe_inner(inner: InnerLoads) -> Inner:
    """Return the record of the loads along the crankshaft."""
    gas = inner.with_gas
    return Inner(
        _describe_bent(inner.shear, inner.bending),
        None if inner.bearings is None else tuple(map(BearingLoad, *_list_loads(inner.bearings))),
        None
        if gas is None
        else WithGas(
            _describe_bent(gas.shear, gas.bending),
            tuple(map(BearingLoad, *_list_loads(gas.bearings))),
            _describe_bent(gas.block_shear, gas.block_bending),
        ),
        inner.obstacle or None,
    )


def _describe_bent(shear: AlongCrank, bending: AlongCrank) -> Bent:
    """Return the record of shear force and bending moment at the same sections."""
    places, forces = _list_loads(shear)
    _, moments = _list_loads(bending)
    return Bent(*bending.highest, tuple(map(Section, places, forces, moments)))


def _list_loads(along: AlongCrank) -> tuple[list[float], list[Load]]:
    """Return the positions, mm, and the loads there."""
    loads = [Load(peak, along.at(k)) for k, peak in enumerate(along.peaks)]
    return (along.z_m * 1e3).tolist(), loads


# ------------------------------------------------------------------ guides and strokes
Includes = Literal["inertia and gas", "inertia, without gas"]


class GuideOrder(NamedTuple):
    """Guide-force moments of one order.

    Attributes:
        order: Order.
        h_Nm: H-type: sum of the roll moments of all cylinders.
        x_Nm: X-type: sum of the roll moments, each multiplied by the axial distance of its cylinder
            from the point of reference and divided by the height of its guide; left out if all
            cylinders have the same position, or positions are not known.
    """

    order: float
    h_Nm: Harmonic
    x_Nm: Harmonic | None = None


class Guide(NamedTuple):
    """Guide-force moments.

    Attributes:
        includes: Whether the moments include the gas.
        height_m: Height of the middle of each guide above the crankshaft, by cylinder number.
        orders: Moments by order.
    """

    includes: Includes
    height_m: Array
    orders: tuple[GuideOrder, ...]


def describe_guide(guide: GuideMoments) -> Guide:
    """Return guide-force moments order by order."""
    columns = [list_harmonics(moment) for moment in (guide.h, guide.x) if moment is not None]
    orders = map(GuideOrder, map(order_number, guide.h.orders), *columns)
    return Guide(name_included(guide.with_gas), guide.height_m, tuple(orders))


def name_included(with_gas: bool) -> Includes:
    """Return in words whether moments include the gas."""
    return "inertia and gas" if with_gas else "inertia, without gas"


class Stroke(NamedTuple):
    """Stroke and dead centres of one piston.

    Attributes:
        cylinder: Number of the cylinder.
        stroke_m: Stroke.
        top_deg: Crank angle at top dead centre, measured from the position in which the crank pin
            is on the cylinder's axis, towards the piston.
        bottom_deg: Crank angle at bottom dead centre, measured from the position half a turn later.
    """

    cylinder: int
    stroke_m: float
    top_deg: float
    bottom_deg: float


# ------------------------------------------------------------------ devices
class Counterweight(NamedTuple):
    """Unbalance fixed to the crankshaft.

    Attributes:
        unbalance_kg_m: Unbalance.
        angle_deg: Angle from cylinder 1's crank pin.
        position_mm: Position along the crank.
        engine: Engine whose crank carries the counterweight; only for geared engines.
    """

    unbalance_kg_m: float
    angle_deg: float
    position_mm: float
    engine: str | None = None


class Shaft(NamedTuple):
    """A balancer shaft, in its position at crank angle 0.

    Attributes:
        ratio: Speed over crank speed; negative: it turns against the crank.
        unbalance_kg_m: Unbalance.
        angle_deg: Angle from x, positive in the direction in which the crank turns.
        at_mm: Position of the shaft's axis: x, y.
        position_mm: Position along the crank.
        free: Whether the shaft may be at any x and y, because it makes only a moment.
        role: "compensator"; left out for balancer shafts.
    """

    ratio: int
    unbalance_kg_m: float
    angle_deg: float
    at_mm: tuple[float, ...]
    position_mm: float
    free: bool
    role: str | None = None


class Slider(NamedTuple):
    """A reciprocating mass.

    Attributes:
        order: Number of oscillations in a turn of the crank.
        unbalance_kg_m: Mass times amplitude.
        direction_deg: Direction of the path of the mass from x.
        angle_deg: Phase at crank angle 0.
        at_mm: Position of the middle of the path: x, y.
        position_mm: Position along the crank.
    """

    order: int
    unbalance_kg_m: float
    direction_deg: float
    angle_deg: float
    at_mm: tuple[float, ...]
    position_mm: float


class Devices(NamedTuple):
    """Devices that a scheme fits, in the terms of an engine file.

    Attributes:
        counterweights: Counterweights on the crankshaft.
        shafts: Balancer shafts.
        sliders: Reciprocating masses.
    """

    counterweights: tuple[Counterweight, ...]
    shafts: tuple[Shaft, ...]
    sliders: tuple[Slider, ...]


class SizedDevices(NamedTuple):
    """Devices of a scheme.

    Attributes:
        scheme: Name of the scheme.
        steps: Steps of the ladder whose devices are fitted.
        devices: New devices.
    """

    scheme: str
    steps: tuple[str, ...]
    devices: Annotated[Devices, INLINE]


def name_devices(remedy: Remedy) -> SizedDevices:
    """Return the scheme, its steps and its devices."""
    return SizedDevices(remedy.scheme, remedy.steps or (), describe_devices(remedy))


def describe_devices(remedy: Remedy) -> Devices:
    """Return the devices of a remedy, grouped by kind."""
    return Devices(
        tuple(Counterweight(*_list_values(d, Counterweight)) for d in remedy.counterweights),
        tuple(map(_describe_shaft, remedy.shafts, find_free(remedy.shafts))),
        tuple(Slider(*_list_values(d, Slider)) for d in remedy.sliders),
    )


def _describe_shaft(shaft: model.Shaft, free: bool) -> Shaft:
    role = None if shaft.role == "balancer" else shaft.role
    return Shaft._make([*_list_values(shaft, Shaft), free, role])


def _list_values(device: DeviceTable, record: Any) -> list[Any]:
    """Return the values of a device for the fields of a record. Each field is named like a key of
    the engine file, plus a unit.
    """
    others = ("free", "role")
    return [find_value(device, remove_unit(key)) for key in record._fields if key not in others]


def find_value(device: DeviceTable, field: str) -> Any:
    """Return a figure of a device as in the engine file, but the unbalance in kg m.

    Args:
        device: Table of the device.
        field: Key of the figure in the engine file.
    """
    return find_unbalance(device) if field == "unbalance" else getattr(device, field)


class JournalTorque(NamedTuple):
    """Torque over a cycle, positive in the direction of rotation.

    Attributes:
        max_Nm: Highest torque.
        min_Nm: Lowest torque.
        range_Nm: Highest less lowest torque.
        mean_Nm: Mean torque.
        max_deg: Crank angle of the highest torque; left out if the torque is always 0.
        min_deg: Crank angle of the lowest torque; left out if the torque is always 0.
    """

    max_Nm: float
    min_Nm: float
    range_Nm: float
    mean_Nm: float
    max_deg: float | None = None
    min_deg: float | None = None


class ShearStress(NamedTuple):
    """Nominal shear stress of a journal.

    Attributes:
        mean_Pa: Half of the sum of the extreme stresses.
        amplitude_Pa: Half of the difference of the extreme stresses.
    """

    mean_Pa: float
    amplitude_Pa: float


class Journal(NamedTuple):
    """A main journal or crank pin.

    Attributes:
        place: Name: `main 1`, `pin 1`, ...
        inertia: Torque of inertia.
        position_mm: Position along the crank; left out if positions of throws are not known.
        total: Torque of gas and inertia; left out without gas.
        stress: Stress under the total torque (without gas: the inertia torque); left out if the
            file gives no diameter.
    """

    place: str
    inertia: JournalTorque
    position_mm: float | None = None
    total: JournalTorque | None = None
    stress: ShearStress | None = None


class ShaftBearing(NamedTuple):
    """Load of one bearing of a balancer shaft.

    Attributes:
        position_mm: Position along the crank.
        rotating_N: Load of the eccentrics, which turns with the shaft.
        fixed_N: Load of the gear force, whose direction is fixed.
        largest_N: Largest load over a turn: the sum of both loads.
        rotating_deg: Direction of the turning load at crank angle 0; left out if this load is 0.
        fixed_deg: Direction of the fixed load; left out if this load is 0.
    """

    position_mm: float
    rotating_N: float
    fixed_N: float
    largest_N: float
    rotating_deg: float | None = None
    fixed_deg: float | None = None


class ShaftGear(NamedTuple):
    """The gear that drives a balancer shaft against its drag.

    Attributes:
        tangential_N: Tangential force.
        radial_N: Radial force, towards the axis of the shaft.
        power_W: Power of the drag.
    """

    tangential_N: float
    radial_N: float
    power_W: float


class BalancerShaft(NamedTuple):
    """A balancer shaft with all its eccentrics. Directions count from x, deg, in (-180, 180].

    Attributes:
        name: Name of the shaft.
        ratio: Speed over crank speed; negative: it turns against the crank.
        inertia_at_crank_kg_m2: Moment of inertia of the shaft times the square of the ratio.
        bearings: Loads of the bearings. If the file gives no bearings, this and all later
            attributes are left out.
        bending_Nm: Largest bending moment of the turning loads.
        bending_position_mm: Position of this bending moment; left out if nothing bends the shaft.
        gear: Gear of the shaft; left out if the file gives none.
    """

    name: str
    ratio: float
    inertia_at_crank_kg_m2: float
    bearings: tuple[ShaftBearing, ...] | None = None
    bending_Nm: float | None = None
    bending_position_mm: float | None = None
    gear: ShaftGear | None = None


class CounterweightPart(NamedTuple):
    """A counterweight. `mass_kg` and all later attributes are known only for a sector.

    Attributes:
        position_mm: Position along the crank.
        angle_deg: Angle from cylinder 1's crank pin, in (-180, 180].
        unbalance_kg_m: Unbalance.
        mass_kg: Mass.
        center_of_mass_m: Distance of the centre of mass from the crank axis.
        thickness_m: Thickness.
        inertia_kg_m2: Polar moment of inertia about the crank axis.
        clearance_m: Smallest distance of a piston's lowest edge from the rim, as if each piston
            were at its inner dead centre over the counterweight; left out without `piston.skirt`.
    """

    position_mm: float
    angle_deg: float
    unbalance_kg_m: float
    mass_kg: float | None = None
    center_of_mass_m: float | None = None
    thickness_m: float | None = None
    inertia_kg_m2: float | None = None
    clearance_m: float | None = None


class Eccentric(NamedTuple):
    """An eccentric in the shape of a sector on the core of its shaft.

    Attributes:
        shaft: Name of the shaft.
        position_mm: Position along the crank.
        unbalance_kg_m: Unbalance.
        mass_kg: Mass with the core.
        inertia_kg_m2: Polar moment of inertia about the axis of the shaft, with the core.
        thickness_m: Length along the shaft.
    """

    shaft: str
    position_mm: float
    unbalance_kg_m: float
    mass_kg: float
    inertia_kg_m2: float
    thickness_m: float


class WebPart(NamedTuple):
    """A web of the crankshaft. Angles named `own` count from the web's own crank pin in the
    direction of rotation, deg, in [0, 360). What is not known or does not apply is left out.

    Attributes:
        web: Its number, from the free end.
        table: Number of its [[web]] table.
        throw: Number of its throw.
        position_mm: Position along the crank.
        mass_kg: Mass.
        unbalance_kg_m: Unbalance.
        thickness_m: Axial thickness.
        cg_m: Centre of mass: x towards the web's own crank pin, and y.
        unbalance_own_deg: Direction of the unbalance.
        inertia_kg_m2: Polar moment of inertia about the crank axis.
        outer_radius_m: Outer radius of the counterweight.
        opening_deg: Full angle of the counterweight.
        angle_own_deg: Angle of the middle of the counterweight.
        swing_radius_m: Largest radius of the outline.
        clearance_m: Smallest gap to the lower edge of a piston over a revolution.
        clearance_deg: Crank angle of this gap.
        clearance_cylinder: Cylinder of this piston.
        crankcase_m: Gap to the crankcase.
        worst_kg_m: Largest deviation of the unbalance within the tolerances.
        rss_kg_m: Root of the sum of squares of the deviations by each dimension.
        wanted_kg_m: Unbalance that a fitted web is to have.
        wanted_own_deg: Direction of this unbalance.
        room_kg_m: Unbalance of the largest counterweight that fits, if the wanted one does not.
        missing_kg_m: Unbalance of the counterweight that does not fit.
        remedies: Ways to make what does not fit, each alone.
        asked_clearance_m: Clearance that the file asks for.
    """

    web: int
    table: int
    throw: int
    position_mm: float
    mass_kg: float
    unbalance_kg_m: float
    thickness_m: float
    cg_m: tuple[float, float] | None = None
    unbalance_own_deg: float | None = None
    inertia_kg_m2: float | None = None
    outer_radius_m: float | None = None
    opening_deg: float | None = None
    angle_own_deg: float | None = None
    swing_radius_m: float | None = None
    clearance_m: float | None = None
    clearance_deg: float | None = None
    clearance_cylinder: CylinderNumber | None = None
    crankcase_m: float | None = None
    worst_kg_m: float | None = None
    rss_kg_m: float | None = None
    wanted_kg_m: float | None = None
    wanted_own_deg: float | None = None
    room_kg_m: float | None = None
    missing_kg_m: float | None = None
    remedies: tuple[WebCure, ...] | None = None
    asked_clearance_m: Annotated[float, HIDDEN] = 0.0

    @property
    def doubts(self) -> Iterator[Doubt]:
        """Warnings about gaps below the clearance of the file."""
        least = f"at least {1e3 * self.asked_clearance_m:.4g} mm (web.{self.table}.clearance)"
        limit = self.asked_clearance_m - _CLEARANCE_ROUNDING_M
        if self.clearance_m is not None and self.clearance_m < limit:
            yield Doubt(
                f"web.{self.table}",
                f"web {self.web} has a clearance of {1e3 * self.clearance_m:.4g} mm to the piston "
                f"of cylinder {self.clearance_cylinder} at crank angle {self.clearance_deg:.4g} "
                f"deg, where {least} is wanted; make it smaller",
            )
        if self.crankcase_m is not None and self.crankcase_m < limit:
            yield Doubt(
                f"web.{self.table}",
                f"web {self.web} has a clearance of {1e3 * self.crankcase_m:.4g} mm to the "
                f"crankcase, where {least} is wanted; make it smaller",
            )


_CLEARANCE_ROUNDING_M = 1e-6


def _choose_nearest(webs: Iterable[WebPart]) -> Iterator[WebPart]:
    """Yield of each [[web]] table the web nearest to a piston, or else to the crankcase."""
    nearest: dict[int, tuple[float, WebPart]] = {}
    for web in webs:
        gaps = [gap for gap in (web.clearance_m, web.crankcase_m) if gap is not None]
        gap = round(min(gaps, default=0.0), 9)
        if web.table not in nearest or gap < nearest[web.table][0]:
            nearest[web.table] = gap, web
    for _, web in nearest.values():
        yield web


class ThrowPart(NamedTuple):
    """A throw of the crankshaft and what balances it.

    Attributes:
        throw: Its number, from the free end.
        throw_mass_kg: Unbalanced mass of the throw itself (pin and cheeks) at the crank radius;
            left out if it is not known.
        degree_of_balance: Unbalance of its counterweights over that of throw and big ends; left out
            if it is not known.
        factor: Share of the reciprocating mass that its counterweights balance besides all rotating
            mass; negative if they do not balance all of it; left out without such a mass.
    """

    throw: int
    throw_mass_kg: float | None = None
    degree_of_balance: float | None = None
    factor: float | None = None


class CrankPart(NamedTuple):
    """Webs and pins of the crankshaft together.

    Attributes:
        mass_kg: Mass.
        inertia_kg_m2: Polar moment of inertia; left out if that of a web is not known.
    """

    mass_kg: float
    inertia_kg_m2: float | None = None


class BalanceParts(NamedTuple):
    """Bearing loads of balancer shafts, and shapes of counterweights and eccentrics.

    Attributes:
        shafts: Balancer shafts.
        counterweights: Counterweights.
        eccentrics: Eccentrics in the shape of a sector; left out if there are none.
        webs: Webs of the crankshaft; left out without [[web]].
        throws: Throws of the crankshaft; left out where no counterweight belongs to a throw.
        crank: Webs and pins together; left out without [[web]].
    """

    shafts: tuple[BalancerShaft, ...]
    counterweights: tuple[CounterweightPart, ...]
    eccentrics: tuple[Eccentric, ...] | None = None
    webs: tuple[WebPart, ...] | None = None
    throws: tuple[ThrowPart, ...] | None = None
    crank: CrankPart | None = None

    @property
    def doubts(self) -> Iterator[Doubt]:
        """Warnings about counterweights that would touch a piston, and about webs too close to
        piston or crankcase.
        """
        for web in _choose_nearest(self.webs or ()):
            yield from web.doubts
        for number, part in enumerate(self.counterweights, 1):
            if part.clearance_m is not None and part.clearance_m < 0:
                gap = f"{1e3 * part.clearance_m:.4g} mm"
                message = (
                    f"has a clearance of {gap} to the lowest piston; make its outer radius smaller"
                )
                yield Doubt(f"counterweight.{number}", message)


class PartAtOtherSpeed(NamedTuple):
    """A part that turns at another speed than a multiple of half the crank speed. Sizes are
    amplitudes, because it has no fixed phase to the crank.

    Attributes:
        name: Name of the shaft.
        ratio: Speed over crank speed; negative: against the crank.
        frequency_Hz: Turns per second.
        force_N: Centrifugal force.
        moment_Nm: Moment of this force; left out if the positions of the throws are not known.
        couple_Nm: Couple of this force about the direction of the crankshaft.
    """

    name: str
    ratio: float
    frequency_Hz: float
    force_N: float
    moment_Nm: float | None = None
    couple_Nm: float = 0.0


class RelatedMoment(NamedTuple):
    """Power related unbalance of an order.

    Attributes:
        order: Order.
        moment_Nm: Largest free moment; null where it is not known.
        Nm_per_kW: This moment divided by the power; null where it is not known.
        need: Need of a compensator; null where the moment is not known.
    """

    order: int
    moment_Nm: Annotated[float, HIDDEN]
    Nm_per_kW: float
    need: Annotated[str | None, WrittenAs(key="class")]


class PowerRelatedUnbalance(NamedTuple):
    """Free moments divided by the power, as builders of marine engines list them.

    Attributes:
        power_W: Power.
        power_kind: "file": brake power in the file; "indicated": power of the gas; "brake": power
            of the gas times the mechanical efficiency.
        orders: Orders 1 and 2.
    """

    power_W: float
    power_kind: str
    orders: tuple[RelatedMoment, ...]


class Masses(NamedTuple):
    """Masses of cylinders with equal parts.

    Attributes:
        cylinders: Numbers of the cylinders.
        piston_kg: Mass of the piston with pin, rings and locks.
        crosshead_kg: Mass of the crosshead with piston rod and pin.
        reciprocating_kg: Mass of piston, crosshead and small end.
        rotating_kg: Mass of the big end with bearing shells and oil, without the throw.
        throw_kg: Share of the throw's unbalanced mass that counts for one cylinder. With webs, of
            pin and cheeks; of the pin alone if the file gives a web by its profile or mass.
        rod_kg: Mass of the rod; left out, with all figures that depend on it, if the file gives no
            mass.
        rod_small_end_kg: Share of the rod's mass at the piston pin.
        rod_big_end_kg: Share of the rod's mass at the crank pin.
        rod_inertia_kg_m2: Moment of inertia of the rod about its centre of mass.
        radius_of_gyration_m: Radius of gyration of the rod.
        couple_constant_kg_m2: Couple constant H: moment of inertia of the two shares of the rod's
            mass as points at the two pins, minus that of the rod, both about its centre of mass.
        reduced_length_m: Length of a pendulum that swings like the rod about the piston pin.
        is_whole_throw: Whether `throw_kg` has the cheeks as well.
    """

    cylinders: tuple[int, ...]
    piston_kg: float
    crosshead_kg: float
    reciprocating_kg: float
    rotating_kg: float
    throw_kg: float
    rod_kg: float | None = None
    rod_small_end_kg: float | None = None
    rod_big_end_kg: float | None = None
    rod_inertia_kg_m2: float | None = None
    radius_of_gyration_m: float | None = None
    couple_constant_kg_m2: float | None = None
    reduced_length_m: float | None = None
    is_whole_throw: Annotated[bool, HIDDEN] = True
