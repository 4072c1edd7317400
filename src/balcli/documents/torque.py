"""`balcli.torque/1`."""

from __future__ import annotations

from typing import Literal, NotRequired

from typing_extensions import TypedDict

from .figures import Document, Kinds, OrderFigures


class Extremes(TypedDict):
    """Of the torque over a cycle; reversals: how often it changes its sign."""

    max_Nm: float
    max_deg: float
    min_Nm: float
    min_deg: float
    reversals: int


class TorqueOrder(OrderFigures):
    """One order of the engine, and of one cylinder."""

    one_cylinder: NotRequired[Kinds]


class Energy(TypedDict):
    """What the torque gives above its mean between two angles."""

    surplus_J: float
    from_deg: float | None
    to_deg: float | None
    work_J: float


class Flywheel(TypedDict):
    """What keeps the speed even, and how even that is, as far as it is known; stall: why
    nothing of its speed is.
    """

    inertia_kg_m2: NotRequired[float]
    moving_parts_kg_m2: NotRequired[float]
    fluctuation: NotRequired[float]
    fluctuation_small: NotRequired[float]
    needed_kg_m2: NotRequired[float]
    speed_max_rpm: NotRequired[float]
    speed_min_rpm: NotRequired[float]
    stall: NotRequired[str]


class PinLoad(TypedDict):
    """Load of a crank pin or knuckle pin over the cycle; pressure on its projected area."""

    cylinder: int | str
    max_N: float
    max_deg: float
    mean_N: float
    pressure_Pa: NotRequired[float]


class MainLoad(TypedDict):
    """Load of a main bearing over the cycle."""

    bearing: int | str
    position_mm: float
    max_N: float
    max_deg: float
    mean_N: float
    pressure_Pa: NotRequired[float]


class CycleLoads(TypedDict):
    """Of pins and bearings, as asked for; obstacle: why those of main bearings are not known."""

    pin: NotRequired[list[PinLoad]]
    knuckle: NotRequired[list[PinLoad]]
    main: NotRequired[list[MainLoad]]
    obstacle: NotRequired[str]


class Torque(Document):
    """Torque on the crank over the cycle, of an engine or of a given curve."""

    format: Literal["balcli.torque/1"]
    speed_rpm: NotRequired[float]
    no_gas_in: NotRequired[list[int]]
    no_burning_in: NotRequired[list[int]]
    cycle_deg: int | float
    imep_Pa: NotRequired[float]
    bmep_Pa: NotRequired[float]
    max_pressure_Pa: NotRequired[float]
    max_pressure_deg: NotRequired[float]
    mean_torque_Nm: float
    power_W: NotRequired[float]
    torque: Extremes
    orders: list[TorqueOrder]
    energy: Energy
    flywheel: NotRequired[Flywheel]
    loads: NotRequired[CycleLoads]
