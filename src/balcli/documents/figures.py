"""Parts that several documents have."""

from __future__ import annotations

from typing import NotRequired

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
