"""`balcli.analysis/1`, `balcli.sum/1` and `balcli.balance/1`."""

from __future__ import annotations

from typing import Any, Literal, NotRequired

from typing_extensions import TypedDict

from .figures import (
    Assumed,
    Devices,
    Document,
    EngineSize,
    Harmonic,
    NamedEngine,
    Order,
    OrderFigures,
    OrdersAndPeaks,
    Peaks,
    Place,
    Vector,
)


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
