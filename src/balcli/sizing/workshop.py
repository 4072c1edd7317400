"""What a workshop asks of a device: how heavy at which radius, how it pulls, and a first guess of
its size in steel.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..core.drilled_hole import STEEL, find_drill_depth, find_drilled_unbalance
from ..core.phasors import wrap_degrees
from ..engine.build import Engine
from ..enginefile.model import Counterweight, Shaft, Slider
from ..errors import BalcliError, check_number
from ..limits import MOST_HOLES
from .device_tables import DeviceTable, find_unbalance
from .remedy import Remedy

ROUNDING = 1e-12  # of a hole: that much more than the deepest one is still one
THICKNESS = 0.020  # m, of a semicircular disc if nothing else is said


class Tools(NamedTuple):
    """What a workshop has, m; None: not said.

    Attributes:
        radius: at which masses are stated; the crank radius if not said.
        thickness: of semicircular discs; 20 mm if not said.
        disc: their radius, instead of their thickness.
        drill: diameter; no holes are stated if not said.
        max_depth: of holes; to the axis if not said.
        slug: density of slugs that fill the holes, kg/m3; empty holes if not said.
    """

    radius: float | None = None
    thickness: float | None = None
    disc: float | None = None
    drill: float | None = None
    max_depth: float | None = None
    slug: float | None = None


class Holes(NamedTuple):
    """Radial holes side by side along the axis, all alike: they remove an unbalance opposite to
    it, or add it with slugs on its own side.

    Attributes:
        angle_deg: of the holes, counted as that of the device.
        number: how many.
        depth: of each, from the rim inwards, m; nan where more are needed than MOST_HOLES.
        reason: why one is not enough; empty where it is.
    """

    angle_deg: float
    number: int
    depth: float
    reason: str


class Practical(NamedTuple):
    """Figures of one device, SI.

    Attributes:
        mass: at `radius`, which makes the unbalance (a slider: of this amplitude).
        force: centrifugal force (largest force of a slider) at the engine's speed.
        speed_rpm: of the shaft; of a slider its strokes a minute.
        disc_radius, disc_thickness: semicircular steel disc, its diameter through the axis of
            rotation.
        holes: into a rim at `radius`; None without a drill, and for sliders.
    """

    unbalance: float
    mass: float
    radius: float
    force: float
    speed_rpm: float
    disc_radius: float
    disc_thickness: float
    holes: Holes | None = None


def find_practical(engine: Engine, remedy: Remedy, tools: Tools) -> tuple[Practical, ...]:
    """Figures of all devices, in the order of `remedy.devices`.

    Raises:
        BalcliError: tools that cannot be, or that do not go together.
        TypeError: one is no number.
    """
    tools = Tools(*map(_check_figure, Tools._fields, tools))
    _refuse_impossible(tools)
    rim = tools.radius or float(engine.cylinders.radius)
    if tools.drill is not None and tools.drill > 2 * rim:
        raise BalcliError(
            f"--drill: a hole of {1e3 * tools.drill:g} mm is wider than its rim of radius "
            f"{1e3 * rim:g} mm (--radius, else the crank radius)"
        )
    return tuple(_find_figures(engine, device, tools) for device in remedy.devices)


def _refuse_impossible(tools: Tools) -> None:
    """BalcliError for figures that are not above 0, or that do not go together."""
    strange = {
        name.replace("_", "-"): figure
        for name, figure in tools._asdict().items()
        if figure is not None and not 0 < figure < math.inf
    }
    if strange:
        told = (
            f"--{name}: {f'{figure / 1e3:g} g/cm3' if name == 'slug' else f'{1e3 * figure:g} mm'}"
            for name, figure in strange.items()
        )
        raise BalcliError(f"{', '.join(told)}; give figures above 0")
    for_holes = tools.max_depth is not None or tools.slug is not None
    if for_holes and tools.drill is None:
        raise BalcliError(
            "--max-depth and --slug are for holes: give the diameter of the drill, too, "
            "with --drill"
        )
    if tools.slug is not None and tools.slug <= STEEL:
        raise BalcliError(
            f"--slug: {tools.slug / 1e3:g} g/cm3 is not heavier than the steel in whose place it "
            f"is put ({STEEL / 1e3:g} g/cm3); tungsten alloy has 17 to 18.5"
        )
    if tools.thickness is not None and tools.disc is not None:
        raise BalcliError(
            "a semicircular disc has its radius or its thickness given, not both: the other follows"
        )


def _check_figure(name: str, figure: float | None) -> float | None:
    wanted = (
        "a density in kg/m3, such as 17500" if name == "slug" else "a length in m, such as 0.02"
    )
    return None if figure is None else check_number(f"Tools: {name}", figure, f"give {wanted}")


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
        holes=_plan_holes(device, unbalance, radius, tools),
    )


def _plan_holes(device: DeviceTable, unbalance: float, rim: float, tools: Tools) -> Holes | None:
    """As few holes as the depth allows."""
    if tools.drill is None or isinstance(device, Slider):
        return None
    density = STEEL if tools.slug is None else tools.slug - STEEL
    deepest = min(rim, tools.max_depth or rim)
    angle = wrap_degrees(device.angle + (180 if tools.slug is None else 0), 360)
    of_one = find_drilled_unbalance(deepest, rim, tools.drill, density)
    share = unbalance / of_one * (1 - ROUNDING) if of_one else math.inf
    count = max(math.ceil(share), 1) if share <= MOST_HOLES else MOST_HOLES + 1
    depth = math.nan
    if count <= MOST_HOLES:
        depth = find_drill_depth(unbalance / count, rim, tools.drill, density)
        depth = deepest if math.isnan(depth) else min(depth, deepest)
    reason = "one hole would be deeper than " + ("--max-depth" if deepest < rim else "the radius")
    return Holes(float(angle), count, depth, reason if count > 1 else "")


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
