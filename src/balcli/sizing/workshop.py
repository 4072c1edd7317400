"""What a workshop asks of a device: how heavy at which radius, how it pulls, and a first guess of
its size in steel.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..core.drilled_hole import STEEL, find_drill_depth
from ..engine.build import Engine
from ..enginefile.model import Counterweight, Shaft
from ..errors import BalcliError
from .device_tables import DeviceTable, find_unbalance
from .remedy import Remedy

THICKNESS = 0.020  # m, of a semicircular disc if nothing else is said


class Tools(NamedTuple):
    """What a workshop has, m; None: not said.

    Attributes:
        radius: at which masses are stated; the crank radius if not said.
        thickness, disc: thickness, or radius, of semicircular discs; THICKNESS if neither is said.
        drill: diameter; no depth of holes is stated if not said.
    """

    radius: float | None = None
    thickness: float | None = None
    disc: float | None = None
    drill: float | None = None


class Practical(NamedTuple):
    """Figures of one device, SI.

    Attributes:
        mass: at `radius`, which makes the unbalance (a slider: of this amplitude).
        force: centrifugal force (largest force of a slider) at the engine's speed.
        speed_rpm: of the shaft; of a slider its strokes a minute.
        disc_radius, disc_thickness: semicircular steel disc, its diameter through the axis of
            rotation.
        depth: of a radial hole, from the rim at `radius` inwards, that removes as much; nan if the
            drill is too small for it, None if there is no drill.
    """

    unbalance: float
    mass: float
    radius: float
    force: float
    speed_rpm: float
    disc_radius: float
    disc_thickness: float
    depth: float | None = None


def find_practical(engine: Engine, remedy: Remedy, tools: Tools) -> tuple[Practical, ...]:
    """Figures of all devices, in the order of `remedy.devices`.

    Raises BalcliError unless all lengths are positive and at most one of disc and thickness is
    given.
    """
    if any(length is not None and not 0 < length < math.inf for length in tools):
        raise BalcliError("radius, thickness, disc and drill must be positive lengths in mm")
    if tools.thickness is not None and tools.disc is not None:
        raise BalcliError(
            "a semicircular disc has its radius or its thickness given, not both: the other follows"
        )
    return tuple(_find_figures(engine, device, tools) for device in remedy.devices)


def _find_figures(engine: Engine, device: DeviceTable, tools: Tools) -> Practical:
    unbalance, order = find_unbalance(device), _find_order(device)
    radius = tools.radius or float(engine.cylinders.radius)
    disc_radius, disc_thickness = _find_disc(unbalance, tools)
    return Practical(
        unbalance,
        mass=unbalance / radius,
        radius=radius,
        force=unbalance * (order * float(engine.omega)) ** 2,
        speed_rpm=order * float(engine.speed_rpm),
        disc_radius=disc_radius,
        disc_thickness=disc_thickness,
        depth=find_drill_depth(unbalance, radius, tools.drill) if tools.drill else None,
    )


def _find_order(device: DeviceTable) -> int:
    """Turns or strokes for each turn of the crank."""
    match device:
        case Counterweight():
            return 1
        case Shaft():
            return abs(device.ratio)
        case _:
            return device.order


def _find_disc(unbalance: float, tools: Tools) -> tuple[float, float]:
    """Radius and thickness: the centroid of a half disc lies 4R/(3 pi) from its diameter, so `m r =
    density t 2/3 R^3`.
    """
    if tools.disc is not None:
        return tools.disc, 1.5 * unbalance / (STEEL * tools.disc**3)
    thickness = tools.thickness or THICKNESS
    return (1.5 * unbalance / (STEEL * thickness)) ** (1 / 3), thickness
