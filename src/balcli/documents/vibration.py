"""`balcli.mounts/1`."""

from __future__ import annotations

from typing import Literal, NotRequired

from typing_extensions import TypedDict

from .figures import Document, Order, Place

Row = list[float | None]


class Axes(TypedDict):
    """Along and about x, y, z."""

    x: float
    y: float
    z: float
    rx: float
    ry: float
    rz: float


class Meeting(TypedDict):
    """An order meets a natural frequency at this speed."""

    order: Order
    speed_rpm: float


class BodyMode(TypedDict):
    """A natural mode of the body on its mounts."""

    frequency_Hz: float
    energy_percent: Axes
    shape: Row
    motion: str
    loss_factor: float
    meets: list[Meeting]


class MountAtRest(TypedDict):
    """Of weight and mean torque."""

    name: str
    force_N: Place
    travel_mm: Place


class AtRest(TypedDict):
    """All mounts at rest."""

    mounts: list[MountAtRest]


class ForceOfOrder(TypedDict):
    """Largest force of one order, by speed."""

    order: Order
    force_N: Row


class WorstForce(TypedDict):
    """Of all speeds."""

    force_N: float
    speed_rpm: float
    order: Order
    order_force_N: float


class MountForce(TypedDict):
    """Of one mount, by order and speed; peak: all orders together."""

    name: str
    orders: list[ForceOfOrder]
    peak_N: Row
    worst: WorstForce


class MotionOfOrder(TypedDict):
    """Largest motion of one order, by speed."""

    order: Order
    motion_mm: Row


class WorstMotion(TypedDict):
    """Of all speeds."""

    motion_mm: float
    speed_rpm: float
    order: Order
    order_motion_mm: float


class PointMotion(TypedDict):
    """Of one point, by order and speed; peak: all orders together."""

    name: str
    orders: list[MotionOfOrder]
    peak_mm: Row
    worst: WorstMotion


class Load(TypedDict):
    """Amplitudes by speed of force and moment about the centre of gravity, where there are any."""

    force_x_N: NotRequired[Row]
    force_y_N: NotRequired[Row]
    force_z_N: NotRequired[Row]
    moment_x_Nm: NotRequired[Row]
    moment_y_Nm: NotRequired[Row]
    moment_z_Nm: NotRequired[Row]


class Passed(TypedDict):
    """What the frame gets of one order from a rigid engine, and through the mounts."""

    order: Order
    rigid: Load
    on_mounts: Load


class BodyResponse(TypedDict):
    """Of the body to the engine, over speeds."""

    no_gas_in: NotRequired[list[int]]
    no_burning_in: NotRequired[list[int]]
    speeds_rpm: Row
    mounts: list[MountForce]
    points: list[PointMotion]
    passed: list[Passed]


class Fitted(TypedDict):
    """With the devices of a scheme."""

    scheme: str
    response: BodyResponse


class Other(TypedDict):
    """With another engine."""

    name: str
    response: BodyResponse


class Mounts(Document):
    """An engine on its mounts."""

    format: Literal["balcli.mounts/1"]
    name: str
    modes: list[BodyMode]
    roll_axis: Place
    elastic_centre_mm: Place
    static: AtRest
    stiffness_N_per_m: list[Row]
    response: NotRequired[BodyResponse]
    fitted: NotRequired[Fitted]
    others: NotRequired[list[Other]]
