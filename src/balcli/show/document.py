"""Types of the JSON documents that are not records yet: analysis, sum, balance, sweeps, searches,
curves and tables.
"""

from __future__ import annotations

from typing import Any, Literal, NotRequired

from pydantic import ConfigDict, with_config
from typing_extensions import TypedDict

Order = int | float  # times the crank speed; halves of four-stroke engines
Place = list[float]  # x, y, z
Complex = list[float]  # real and imaginary part


class Component(TypedDict):
    """value = amplitude * cos(order * angle - phase); no phase where there is no amplitude."""

    amplitude: float
    phase_deg: float | None


class Vector(TypedDict):
    """One order of a force or moment: F = forward e^(i order angle) + backward e^(-i order angle),
    whose tip runs round an ellipse; no axis where that is a circle or a point.
    """

    forward: Complex
    backward: Complex
    major: float
    minor: float
    axis_deg: float | None
    x: Component
    y: Component
    balanced: bool


class Harmonic(TypedDict):
    """One order of a torque: cos * cos(order * angle) + sin * sin(order * angle)."""

    cos: float
    sin: float
    amplitude: float
    peak_deg: float | None
    balanced: bool


class Kinds(TypedDict):
    """What was computed and is known, of one order."""

    force_N: NotRequired[Vector]
    moment_Nm: NotRequired[Vector]
    couple_Nm: NotRequired[Harmonic]
    inertia_torque_Nm: NotRequired[Harmonic]
    roll_Nm: NotRequired[Harmonic]
    gas_torque_Nm: NotRequired[Harmonic]
    torque_Nm: NotRequired[Harmonic]
    roll_total_Nm: NotRequired[Harmonic]


class OrderFigures(Kinds):
    """One order of all that was computed."""

    order: Order


class Peaks(TypedDict):
    """Largest values over a revolution, all orders together, and the crank angles where they are
    reached.
    """

    force_N: NotRequired[float]
    force_deg: NotRequired[float | None]
    moment_Nm: NotRequired[float]
    moment_deg: NotRequired[float | None]


class OrdersAndPeaks(TypedDict):
    """Peaks and orders of an engine that is known."""

    peak: Peaks
    orders: list[OrderFigures]


class NamedEngine(TypedDict):
    """The engine that a result is of."""

    name: str


class EngineSize(NamedEngine):
    """An engine; no displacement where the file gives no bore."""

    cylinders: int
    displacement_m3: float | None


class Counterweight(TypedDict):
    """Unbalance fixed to the crankshaft; angle from cylinder 1's crank pin."""

    unbalance_kg_m: float
    angle_deg: float
    position_mm: float


class Shaft(TypedDict):
    """A balancer shaft; free: it may stand anywhere."""

    ratio: Order
    unbalance_kg_m: float
    angle_deg: float
    at_mm: list[float]
    position_mm: float
    free: bool


class Slider(TypedDict):
    """A mass that runs to and fro."""

    order: int
    unbalance_kg_m: float
    direction_deg: float
    angle_deg: float
    at_mm: list[float]
    position_mm: float


class Devices(TypedDict):
    """What a scheme fits, as an engine file would describe it, at crank angle 0."""

    scheme: str
    counterweights: list[Counterweight]
    shafts: list[Shaft]
    sliders: list[Slider]


class Document(TypedDict):
    """Every document says which version of balcli wrote it."""

    version: str


Assumed = list[str]


class Sizing(Devices):
    """Devices of the scheme `auto`, and what is left with them."""

    after: OrdersAndPeaks


class OfCylinder(TypedDict):
    """One cylinder's share."""

    cylinder: int
    orders: list[OrderFigures]


class VectorOfOrder(Vector):
    """One order at one place."""

    order: Order


class AlongCrank(TypedDict):
    """A load at one place: its largest value over the cycle, and its orders."""

    peak: float | None
    peak_deg: float | None
    orders: list[VectorOfOrder]


class Section(TypedDict):
    """Shear force and bending moment in one section."""

    position_mm: float
    shear_N: AlongCrank
    bending_Nm: AlongCrank


class Bent(TypedDict):
    """A shaft, or the block, section by section."""

    largest_bending_Nm: float | None
    largest_at_mm: float
    sections: list[Section]


class BearingLoad(TypedDict):
    """The load of one main bearing."""

    position_mm: float
    load_N: AlongCrank


class WithGas(TypedDict):
    """The same with the forces of gas; they bend crankshaft and block one against the other."""

    crankshaft: Bent
    bearings: list[BearingLoad]
    block: Bent


class Inner(Bent):
    """Loads along the crankshaft; obstacle: why those with gas are not known."""

    bearings: NotRequired[list[BearingLoad]]
    with_gas: NotRequired[WithGas]
    obstacle: NotRequired[str]


class GuideOrder(TypedDict):
    """Guide-force moments of one order."""

    order: Order
    h_Nm: NotRequired[Harmonic]
    x_Nm: NotRequired[Harmonic]


class Guide(TypedDict):
    """Guide-force moments about the height of the guides."""

    includes: Literal["inertia and gas", "inertia, without gas"]
    height_m: list[float]
    orders: list[GuideOrder]


class Reason(TypedDict):
    """Whether one order of one quantity is balanced by symmetry."""

    order: Order
    quantity: str
    verdict: str
    size: float
    reciprocating: float | None
    built: float | None
    unit: str


class Why(TypedDict):
    """What symmetry balances, how the engine fires, and what the reasons leave out, if anything."""

    reasons: list[Reason]
    firing: str
    scope: NotRequired[str]


class Travel(TypedDict):
    """Stroke and dead centres of one piston."""

    cylinder: int
    stroke_m: float
    top_deg: float
    bottom_deg: float


class AnalysisFigures(TypedDict):
    """Free forces and moments of an engine, order by order."""

    format: Literal["balcli.analysis/1"]
    engine: EngineSize
    speed_rpm: float
    no_gas_in: NotRequired[list[int]]
    no_burning_in: NotRequired[list[int]]
    reference_mm: Place
    orders: list[OrderFigures]
    assumed: NotRequired[Assumed]
    peak: NotRequired[Peaks]
    sizing: NotRequired[Sizing]
    cylinders: NotRequired[list[OfCylinder]]
    inner: NotRequired[Inner]
    guide: NotRequired[Guide]
    travel: NotRequired[list[Travel]]
    why: NotRequired[Why]


class Analysis(AnalysisFigures, Document):
    """Free forces and moments of an engine, order by order."""


class Speeds(Document):
    """The analysis at each of several speeds."""

    format: Literal["balcli.speeds/1"]
    engine: NamedEngine
    analyses: list[AnalysisFigures]


class CountedEngine(NamedEngine):
    """An engine and its cylinders."""

    cylinders: int


class MarineAxes(TypedDict):
    """Which axis builders call vertical and horizontal."""

    v: str
    h: str


class MarineOrder(TypedDict):
    """Amplitudes of one order."""

    order: Order
    force_v_N: NotRequired[float | None]
    force_h_N: NotRequired[float | None]
    moment_v_Nm: NotRequired[float | None]
    moment_h_Nm: NotRequired[float | None]
    guide_h_Nm: NotRequired[float | None]
    guide_x_Nm: NotRequired[float | None]
    torque_Nm: NotRequired[float | None]


class MarineSpeed(TypedDict):
    """All orders at one speed."""

    speed_rpm: float
    orders: list[MarineOrder]


class Marine(Document):
    """External forces and moments and guide-force moments, as builders of marine engines list
    them.
    """

    format: Literal["balcli.marine/1"]
    engine: CountedEngine
    includes: Literal["inertia and gas", "inertia, without gas"]
    axes: MarineAxes
    height_m: list[float]
    speeds: list[MarineSpeed]


class EngineOfTwo(EngineSize):
    """One of two engines; gas: whether its file has some, if either has."""

    gas: NotRequired[bool]


class Arrangement(TypedDict):
    """How the second engine stands to the first."""

    phase_deg: float
    at_mm: Place
    turn_deg: float
    reverse: bool
    load: str


class Sum(Document):
    """Two engines on one frame."""

    format: Literal["balcli.sum/1"]
    engines: list[EngineOfTwo]
    arrangement: Arrangement
    speed_rpm: float
    reference_mm: Place
    orders: list[OrderFigures]
    assumed: NotRequired[Assumed]
    peak: Peaks


class Practical(TypedDict):
    """The workshop's figures of a device."""

    unbalance_kg_m: float | None
    mass_kg: float | None
    radius_mm: float | None
    force_N: float | None
    speed_rpm: float | None
    disc_radius_mm: float | None
    disc_thickness_mm: float | None
    drill_depth_mm: NotRequired[float | None]
    holes: NotRequired[int]
    hole_angle_deg: NotRequired[float | None]


class PermittedUnbalance(TypedDict):
    """What a balance grade permits in each plane."""

    grade: float
    mass_kg: float
    each_g_mm: float


class Balance(Devices, Document):
    """Devices that a scheme fits, and what shakes without and with them. What the scheme says
    besides stands in `details`, under names that end in the unit.
    """

    format: Literal["balcli.balance/1"]
    order: int | None
    reasons: list[str]
    practical: list[Practical]
    details: dict[str, Any]
    assumed: NotRequired[Assumed]
    before: OrdersAndPeaks
    after: OrdersAndPeaks
    permitted: NotRequired[PermittedUnbalance]


Cell = float | int | str | None


class Sweep(Document):
    """Variants of an engine, a row each: the figures that vary, in the units of the file, then the
    quantities, in those of `balcli numbers`; null: what has no value, such as the axis of a circle.
    """

    format: Literal["balcli.sweep/1"]
    engine: NamedEngine
    columns: list[str]
    rows: list[list[float | None]]


@with_config(ConfigDict(extra="allow"))
class Arranged(TypedDict):
    """One arrangement: one of the first four says it, or a key that is called as `over`."""

    throws: NotRequired[list[float]]
    firing_order: NotRequired[list[int]]
    bank_angle: NotRequired[float]
    splay: NotRequired[float]
    objective: float
    quantities: dict[str, float]


class Search(Document):
    """Best arrangements, best first; over: throws, firing_order, bank_angle, splay, or the dotted
    name of a number.
    """

    format: Literal["balcli.search/1"]
    engine: NamedEngine
    over: str
    results: list[Arranged]


class Curves(Document):
    """Quantities over the crank angle; null: what has no value there."""

    format: Literal["balcli.curves/1"]
    engine: str
    speed_rpm: float
    crank_deg: list[float]
    curves: dict[str, list[float | None]]
    assumed: NotRequired[Assumed]


class Erratum(TypedDict("_Classified", {"class": str})):  # a keyword of Python
    """A printed figure that is not the exact one rounded, or a statement that is wrong."""

    row: int
    label: str
    column: str
    printed: str
    exact: Cell
    kind: str


class Table(Document):
    """A printed table, recomputed."""

    format: Literal["balcli.table/1"]
    name: str
    title: str
    source: str
    columns: list[str]
    rows: list[list[Cell]]
    printed: list[list[str | None]]
    errata: list[Erratum]
