"""`balcli.torsion/1`."""

from __future__ import annotations

from typing import Literal, NotRequired

from typing_extensions import TypedDict

from .figures import Document, Order

Row = list[float | None]


class Node(TypedDict):
    """An inertia of the chain; gear: its speed over the first one's."""

    name: str
    inertia_kg_m2: float
    gear: float


class Joint(TypedDict):
    """A shaft; null: rigid."""

    name: str
    stiffness_Nm_per_rad: float | None


class TorsionMode(TypedDict):
    """A natural mode; nodes: how many places stand still, and in which shafts, or at which nodes of
    the chain.
    """

    frequency_Hz: float
    shape: Row
    nodes: int
    node_in: list[str]
    node_at: list[str]
    loss: float


class Critical(TypedDict):
    """A speed at which an order drives a mode."""

    mode: int
    order: Order
    speed_rpm: float
    phase_sum: float
    work_share: float


class HolzerRow(TypedDict):
    """One inertia of Holzer's table; stiffness null: rigid, or no further shaft."""

    node: str
    inertia_kg_m2: float
    angle: float | None
    torque_Nm: float | None
    sum_Nm: float | None
    stiffness_Nm_per_rad: float | None
    twist: float | None


class Holzer(TypedDict):
    """Holzer's table."""

    mode: NotRequired[int]
    frequency_Hz: float
    rows: list[HolzerRow]
    residual_Nm: float


class TorqueOfOrder(TypedDict):
    """Amplitude of one order."""

    order: Order
    amplitude_Nm: float


class WorstTorque(TypedDict):
    """Of all speeds, and between them."""

    speed_rpm: float
    half_peak_to_peak_Nm: float
    stress_Pa: NotRequired[float]
    orders: list[TorqueOfOrder]


class ShaftResponse(TypedDict):
    """Vibratory torque of one shaft, by speed; stress: half peak to peak, where there is a
    diameter.
    """

    name: str
    half_peak_to_peak_Nm: Row
    sum_of_amplitudes_Nm: Row
    stress_Pa: NotRequired[Row]
    worst: WorstTorque


class WorstSwing(TypedDict):
    """Of all speeds, and between them."""

    speed_rpm: float
    half_swing_deg: float


class WorstHeat(TypedDict):
    """Of all speeds, and between them."""

    speed_rpm: float
    heat_W: float


class Heat(TypedDict):
    """Power that a damper turns to heat, by speed."""

    node: str
    heat_W: Row
    worst: WorstHeat


class PendulumSwing(TypedDict):
    """How far pendulums swing against their node, by speed; half of peak to peak."""

    node: str
    half_swing_deg: Row
    worst: WorstSwing


class TorsionResponse(TypedDict):
    """Forced vibration over speeds."""

    speeds_rpm: Row
    shafts: list[ShaftResponse]
    free_end_deg: Row
    free_end_worst: WorstSwing
    dampers: NotRequired[list[Heat]]
    pendulums: NotRequired[list[PendulumSwing]]


class SizedDamper(TypedDict):
    """A damper that was sized, and the largest stress (or torque) without and with it."""

    node: str
    kind: str
    inertia_kg_m2: NotRequired[float]
    damping_Nms_per_rad: NotRequired[float]
    stiffness_Nm_per_rad: NotRequired[float]
    loss: NotRequired[float]
    mass_kg: NotRequired[float]
    radius_m: NotRequired[float]
    length_m: NotRequired[float]
    mode: int
    before_Pa: NotRequired[float | None]
    after_Pa: NotRequired[float | None]
    before_Nm: NotRequired[float | None]
    after_Nm: NotRequired[float | None]
    heat_W: float
    heat_rpm: float
    doubts: NotRequired[list[str]]


class Torsion(Document):
    """Torsional vibration of a chain of inertias and shafts."""

    format: Literal["balcli.torsion/1"]
    name: str | None
    no_gas_in: NotRequired[list[int]]
    no_burning_in: NotRequired[list[int]]
    nodes: list[Node]
    shafts: list[Joint]
    modes: list[TorsionMode]
    criticals: NotRequired[list[Critical]]
    holzer: NotRequired[list[Holzer]]
    response: NotRequired[TorsionResponse]
    damper: NotRequired[SizedDamper]
    barred_rpm: NotRequired[list[list[float]]]
