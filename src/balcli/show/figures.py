"""Define records of an engine's figures (orders, peaks, size and state), and their rows of CSV."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.peaks import Peak, find_peak
from ..core.phasors import Array, Complex, Figure, Phasors
from ..core.records import INLINE, Key, Keys, Node, Reached, list_figures, to_document, write_each
from ..engine.engine import CylinderNumber, Engine, Placed, SilentCylinders, place_in_mm
from ..file.fields import order_number
from ..file.model import EngineFile
from ..forces.kinds import EVERY_KIND, FORCE, MOMENT, Dimension, Kind
from ..forces.spectrum import Spectra
from .sheet import sentence
from .units import ShownUnit, System


class Component(NamedTuple):
    """One order of a force or moment along an axis: amplitude * cos(order * crank angle - phase).

    Attributes:
        amplitude: Amplitude.
        phase_deg: Phase; null for order 0 (a mean) and for an amplitude of 0.
    """

    amplitude: float
    phase_deg: float


@dataclass(frozen=True, eq=False, repr=False)
class Vector:
    """One order of a force or moment: forward * e^(i n theta) + backward * e^(-i n theta), with
    order n and crank angle theta; real part along x, imaginary part along y. The vector's tip
    describes an ellipse.

    Attributes:
        forward: Vector that turns with the crank: real and imaginary part.
        backward: Vector that turns against the crank: real and imaginary part.
        major: Longer semi-axis of the ellipse, which is the largest magnitude.
        minor: Shorter semi-axis; 0 for a straight line.
        axis_deg: Direction of the major axis, from x; null for a circle and a point.
        x: Component along x.
        y: Component along y.
        balanced: Whether the force or moment is 0 except for rounding errors.
    """

    forward: complex
    backward: complex
    major: float
    minor: float
    axis_deg: float
    x: Component
    y: Component
    balanced: bool


@dataclass(frozen=True, eq=False, repr=False)
class FreeForce(Vector):
    """One order of a free force.

    Attributes:
        vertical: Component along `frame.up`; left out if the file does not give `frame.up`.
        horizontal: Component along the axis 90 deg after `frame.up` in the direction of crank
            rotation; left out without `frame.up`.
    """

    vertical: Component | None = None
    horizontal: Component | None = None


@dataclass(frozen=True, eq=False, repr=False)
class FreeMoment(Vector):
    """One order of a free moment.

    Attributes:
        yawing: Component about `frame.up`; left out if the file does not give `frame.up`.
        pitching: Component about the axis 90 deg after `frame.up` in the direction of crank
            rotation; left out without `frame.up`.
    """

    yawing: Component | None = None
    pitching: Component | None = None


class Harmonic(NamedTuple):
    """One order of a couple, torque or roll: cos * cos(n theta) + sin * sin(n theta), with order n
    and crank angle theta.

    Attributes:
        cos: Coefficient of the cosine, N·m.
        sin: Coefficient of the sine, N·m.
        amplitude: Amplitude, N·m.
        peak_deg: First crank angle of the largest value; null for order 0 and an amplitude of 0.
        balanced: Whether the value is 0 except for rounding errors.
    """

    cos: float
    sin: float
    amplitude: float
    peak_deg: float
    balanced: bool


_RECORDS: dict[Dimension, type[Vector]] = {"force": FreeForce, "moment": FreeMoment}


def _declare(kind: Kind) -> Key:
    """Return type and description of the figures of a kind in documents."""
    record = _RECORDS[kind.dimension] if kind.vector else Harmonic
    return Key(record, kind.description or sentence(kind.label))


_KEYS = Keys({kind.key: _declare(kind) for kind in EVERY_KIND.values()})


class OrderFigures(NamedTuple):
    """Figures of one order; those that are not computed or not known are left out.

    Attributes:
        order: Order, in multiples of the crank speed; four-stroke engines have half orders.
        figures: Figures of each kind of force or moment, by the key of the kind.
    """

    order: float
    figures: Annotated[Mapping[str, Vector | Harmonic], _KEYS, INLINE]


class Peaks(NamedTuple):
    """Largest values of all orders together over a revolution, and the first crank angles at which
    they are reached.

    Attributes:
        force: Free force, N.
        moment: Free moment, N·m.
        force_at_most_N: Free force with the parts at other speeds, which have no fixed phase to the
            crank: the sum of all sizes; left out without such parts.
        moment_at_most_Nm: Free moment with these parts; also left out if moments are not known.
    """

    force: Annotated[Peak, Reached("force_N", "force_deg"), INLINE]
    moment: Annotated[Peak, Reached("moment_Nm", "moment_deg"), INLINE]
    force_at_most_N: float | None = None
    moment_at_most_Nm: float | None = None

    @property
    def at_most(self) -> dict[str, float]:
        """Sizes with the parts at other speeds, by the name of the kind; only those known."""
        both = {FORCE.name: self.force_at_most_N, MOMENT.name: self.moment_at_most_Nm}
        return {name: size for name, size in both.items() if size is not None}


class EngineSize(NamedTuple):
    """Name and size of an engine.

    Attributes:
        name: Name of the engine.
        cylinders: Number of cylinders.
        displacement_m3: Displacement; null if the file gives no bore.
        engines: Engines that are geared together, if the file has several.
    """

    name: str
    cylinders: int
    displacement_m3: float
    engines: tuple[Placed, ...] | None = None


class EngineName(NamedTuple):
    """Name of an engine.

    Attributes:
        name: Name of the engine.
    """

    name: str


@dataclass(frozen=True, kw_only=True)
class EngineState:
    """Speed, gas and point of reference for which an engine is analyzed.

    Attributes:
        speed_rpm: Mean speed of the crank.
        no_gas_in: Cylinders without gas force.
        no_burning_in: Cylinders that compress their gas but burn nothing.
        reference_mm: Point of reference: x, y, z.
    """

    speed_rpm: float
    no_gas_in: tuple[CylinderNumber, ...] | None = None
    no_burning_in: tuple[CylinderNumber, ...] | None = None
    reference_mm: tuple[float, ...]


class OrdersAndPeaks:
    """A result with orders and peaks: an analysis, or the sum of two engines."""

    spectra: Spectra
    peak: Peaks  # of an analysis only on request

    @property
    def moments_known(self) -> bool:
        """Whether the file gives the positions of the throws, without which moments are unknown."""
        raise NotImplementedError

    @property
    def peaks(self) -> list[tuple[Kind, Peak]]:
        """Each kind whose peak was computed, with its peak."""
        if not hasattr(self, "peak"):
            return []
        return [(FORCE, self.peak.force), (MOMENT, self.peak.moment)]


class FigureRow(NamedTuple):
    """One figure of a result. Cylinder 0 is the whole engine; order None: all orders together."""

    cylinder: CylinderNumber
    quantity: str
    order: float | None
    figure: str
    value: float | bool | str | None
    unit: str


def find_peaks(spectra: Spectra) -> Peaks:
    """Return the peaks of force and moment, all orders together."""
    return Peaks(find_peak(spectra["force"]), find_peak(spectra["moment"]))


def measure_engine(engine: Engine) -> EngineSize:
    """Return name and size of a single engine (not of an array of variants)."""
    count = len(engine.numbers)
    volume = float(engine.displacement_m3)
    return EngineSize(engine.name, count, volume, engine.placed or None)


def name_engine(engine: Engine | EngineFile) -> EngineName:
    """Return the name of an engine, or of its file."""
    return EngineName(engine.name)


def describe_state(engine: Engine) -> EngineState:
    """Return speed, cylinders without gas and point of reference of an engine."""
    return EngineState(
        speed_rpm=float(engine.speed_rpm),
        **silent_entries(engine.silent),
        reference_mm=place_in_mm(engine.reference_m),
    )


def silent_entries(silent: SilentCylinders) -> dict[str, tuple[CylinderNumber, ...]]:
    """Return the cylinders without gas, and those that compress but burn nothing, by number."""
    entries = {"no_gas_in": silent.without_gas, "no_burning_in": silent.without_burning}
    return {key: numbers for key, numbers in entries.items() if numbers}


def clean(value: Figure) -> float | None:
    """Return a plain float, with None for nan and 0.0 for -0.0."""
    number = float(value)
    return None if math.isnan(number) else number + 0.0


# ------------------------------------------------------------------ order by order
def list_orders(spectra: Spectra) -> list[OrderFigures]:
    """Return one record for each order, with the computed kinds of force and moment."""
    columns: dict[str, Sequence[Vector | Harmonic]] = {}
    for kind, phasors in spectra.vectors():
        columns[kind.key] = list_vectors(phasors, _RECORDS[kind.dimension], spectra.up_deg)
    for kind, phasors in spectra.scalars():
        columns[kind.key] = list_harmonics(phasors)
    orders = []
    for k, order in enumerate(map(order_number, spectra.orders)):
        figures = {key: column[k] for key, column in columns.items()}
        orders.append(OrderFigures(order, figures))
    return orders


def list_vectors(
    phasors: Phasors, record: type[Vector] = Vector, up_deg: float | None = None
) -> list[Vector]:
    """Return a record of a force or moment for each order, with vertical and horizontal components
    if `up_deg` is given.
    """
    p = phasors
    columns = [column.tolist() for column in (p.forward, p.backward, p.major, p.minor, p.axis_deg)]
    columns += [*_list_components(p), p.balanced.tolist()]
    if up_deg is not None:
        columns += _list_components(p.turn(-up_deg))
    return list(map(record, *columns))


def _list_components(phasors: Phasors) -> Iterator[list[Component]]:
    """Yield the components of all orders along x, then those along y."""
    for c in (phasors.x, phasors.y):
        phases = np.where((c != 0) & (phasors.orders > 0), phase_deg(c), np.nan)
        yield list(map(Component, np.abs(c).tolist(), phases.tolist()))


def list_harmonics(phasors: Phasors) -> list[Harmonic]:
    """Return a record of a couple, torque or roll for each order."""
    return list_coefficients(phasors.orders, phasors.x, phasors.balanced)


def list_coefficients(orders: Array, c: Complex, balanced: NDArray[np.bool_]) -> list[Harmonic]:
    """Return a record for each order of `Re sum c_n e^{i n theta}`, with crank angle theta.

    Args:
        orders: Orders n, shape (orders,).
        c: Coefficients c_n, shape (orders,).
        balanced: Whether each order is 0 except for rounding errors, shape (orders,).
    """
    columns = (c.real, -c.imag, np.abs(c), peak_deg(c, orders), balanced)
    return list(map(Harmonic, *(column.tolist() for column in columns)))


def size_or_mean(c: complex, order: float) -> float:
    """Return the amplitude of `Re(c e^{i n theta})`, with crank angle theta; for order 0 the mean
    with its sign.

    Args:
        c: Coefficient.
        order: Order n.
    """
    return abs(c) if order else c.real


def peak_deg(c: complex | Complex, orders: ArrayLike) -> Array:
    """Return the first crank angle theta in [0, 360/n) at which `Re(c e^{i n theta})` is largest,
    deg; nan for order 0 and for an amplitude of 0.

    Args:
        c: Coefficients, any shape.
        orders: Orders n, of the same shape.
    """
    turning = np.not_equal(c, 0) & np.greater(orders, 0)
    n = np.where(turning, orders, 1.0)
    angle = np.degrees(-np.angle(c)) % 360 / n
    return np.where(turning, np.where(angle < 360 / n, angle, 0.0), np.nan)


def phase_deg(c: complex | Complex) -> Array:
    """Return the phase of `Re(c e^{i n theta}) = |c| cos(n theta - phase)`, in (-180, 180] deg."""
    angle = -np.degrees(np.angle(c))
    return np.where(angle <= -180, angle + 360, angle)


# ------------------------------------------------------------------ as a list
def figure_rows(
    result: OrdersAndPeaks,
    system: System,
    shares: Mapping[CylinderNumber, Spectra] = MappingProxyType({}),
) -> Iterator[FigureRow]:
    """Yield one row for each figure of the orders and peaks; unknown moments have no rows.

    Args:
        result: Analysis, or sum of two engines.
        system: Units.
        shares: Phasors of single cylinders, by number.
    """
    unknown = () if result.moments_known else (MOMENT,)
    for cylinder, spectra in ((0, result.spectra), *shares.items()):
        kinds = [kind for kind, _ in spectra.items() if kind not in unknown]
        for entry in write_each(list_orders(spectra)):
            for kind in kinds:
                unit = system.unit(kind)
                figures = entry[kind.key]
                yield from order_rows(kind.name, entry["order"], figures, unit, cylinder)
    for kind, peak in result.peaks:
        if kind not in unknown:
            yield from peak_rows(kind.name, peak, system.unit(kind))
    for kind in (FORCE, MOMENT):
        at_most = result.peak.at_most.get(kind.name) if result.peaks else None
        if at_most is not None:
            unit = system.unit(kind)
            yield FigureRow(0, kind.name, None, "peak_at_most", unit.of(at_most), unit.name)


def record_rows(
    cylinder: CylinderNumber, quantity: str, order: float | None, record: object, *without: str
) -> Iterator[FigureRow]:
    """Yield every figure of a record in SI units, except the keys `without`; the other arguments
    are those of `FigureRow`.
    """
    for figure in list_figures(to_document(record), without):
        yield FigureRow(cylinder, quantity, order, *figure)


def peak_rows(quantity: str, peak: Peak, unit: ShownUnit) -> Iterator[FigureRow]:
    """Yield the largest value over a revolution, and its crank angle.

    Args:
        quantity: Name of the quantity.
        peak: Largest value (SI) and its crank angle.
        unit: Unit of the value.
    """
    for figure in _flattened(Reached("peak", "peak_deg").split(peak), unit):
        yield FigureRow(0, quantity, None, *figure)


def order_rows(
    quantity: str, order: float, entry: Node, unit: ShownUnit, cylinder: CylinderNumber = 0
) -> Iterator[FigureRow]:
    """Yield all figures of one order.

    Args:
        quantity: Name of the quantity.
        order: Order.
        entry: Figures of the order in SI units, as in JSON.
        unit: Unit of the rows.
        cylinder: Number of the cylinder; 0 for the engine.
    """
    for figure in _flattened(entry, unit):
        yield FigureRow(cylinder, quantity, order_number(order), *figure)


def _flattened(
    entry: Node, unit: ShownUnit, prefix: str = ""
) -> Iterator[tuple[str, float | bool | None, str]]:
    """Yield name, value and unit of every figure of an entry. Nested names are joined:
    `x_amplitude`.
    """
    for name, value in entry.items():
        if isinstance(value, dict):
            yield from _flattened(value, unit, f"{prefix}{name}_")
        elif isinstance(value, list):
            for axis, part in zip("xy", value, strict=True):
                yield f"{prefix}{name}_{axis}", unit.of(part), unit.name
        elif name == "balanced":
            yield name, value, ""
        elif name.endswith("_deg"):
            yield f"{prefix}{name}", value, "deg"
        else:
            yield f"{prefix}{name}", None if value is None else unit.of(value), unit.name
