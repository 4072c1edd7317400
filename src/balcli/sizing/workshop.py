"""What a workshop asks of a device: how heavy at which radius, how it pulls, and a first guess of
its size in steel.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..core.drilled_hole import STEEL, find_drill_depth
from ..engine.build import Engine
from ..errors import BalcliError
from .remedy import Remedy

THICKNESS = 0.020  # m, of a semicircular disc if nothing else is said


class Tools(NamedTuple):
    """At which radius masses are stated, thickness (or radius) of the discs, and drill diameter, m;
    None: see `practical`.
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
        speed_rpm: of the shaft; of a slider its strokes a minute. disc_radius, disc_thickness:
        semicircular steel disc, its diameter through the axis of rotation.
        depth: of a radial hole, from the rim at `radius` inwards, that removes as much; nan if the
        drill is too small for it.
    """

    unbalance: float
    mass: float
    radius: float
    force: float
    speed_rpm: float
    disc_radius: float
    disc_thickness: float
    depth: float | None = None


def practical(engine: Engine, remedy: Remedy, tools: Tools) -> tuple[Practical, ...]:
    """Figures of all devices, in the order of `remedy.devices`; masses are stated at the crank
    radius if not told otherwise.

    Raises BalcliError unless all lengths are positive.
    """
    lengths = (tools.radius, tools.thickness, tools.disc, tools.drill)
    if any(length is not None and not 0 < length < math.inf for length in lengths):
        raise BalcliError("radius, thickness, disc and drill must be positive lengths in mm")
    if tools.thickness is not None and tools.disc is not None:
        raise BalcliError(
            "a semicircular disc has its radius or its thickness given, not both: the other follows"
        )
    radius = tools.radius or float(engine.cylinders.radius)
    multiples = (
        [1] * len(remedy.counterweights)
        + [abs(d.ratio) for d in remedy.shafts]
        + [d.order for d in remedy.sliders]
    )

    def figures(unbalance: float, times: int) -> Practical:
        r, t = _disc(unbalance, tools)
        depth = find_drill_depth(unbalance, radius, tools.drill) if tools.drill else None
        return Practical(
            unbalance,
            unbalance / radius,
            radius,
            unbalance * (times * float(engine.omega)) ** 2,
            times * float(engine.speed_rpm),
            r,
            t,
            depth,
        )

    return tuple(
        figures((d.unbalance or 0.0) / 1e6, n)
        for d, n in zip(remedy.devices, multiples, strict=True)
    )


def _disc(unbalance: float, tools: Tools) -> tuple[float, float]:
    """Radius and thickness: the centroid of a half disc lies 4R/(3 pi) from its diameter, so `m r =
    density t 2/3 R^3`.
    """
    if tools.disc is not None:
        return tools.disc, 1.5 * unbalance / (STEEL * tools.disc**3)
    thickness = tools.thickness or THICKNESS
    return (1.5 * unbalance / (STEEL * thickness)) ** (1 / 3), thickness
