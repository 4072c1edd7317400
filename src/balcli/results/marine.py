"""What builders of large engines state of an engine: external forces and moments by order, vertical
and horizontal, guide-force moments and torque, at one speed or several.

Vertical is along x, horizontal along y. A vertical force makes the moment about the y axis that is
called vertical, too: M1V is My of order 1, M1H its Mx.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..core.phasors import Array
from ..engine.build import Engine
from ..forces.kinds import TORQUE, TORQUE_TOTAL
from .analysis import Analysis, analyze
from .comparison import analyze_alike

FIGURES = (
    "force_v_N",
    "force_h_N",
    "moment_v_Nm",
    "moment_h_Nm",
    "guide_h_Nm",
    "guide_x_Nm",
    "torque_Nm",
)


@dataclass(frozen=True, eq=False)
class MarineSheet:
    """Amplitudes by speed and order.

    Attributes:
        engine: Engine at the first of the speeds.
        speeds_rpm: Speeds, shape (speeds,).
        orders: Orders, ascending, shape (orders,).
        figures: Amplitudes by their names in `FIGURES`, shape (speeds, orders); nan: not known.
            force_v, force_h: external forces along x and y; moment_v, moment_h: external moments of
            the forces along x and along y; guide_h, guide_x: H- and X-type guide-force moments;
            torque: on the crank, of inertia, and of the gas where the engine has some.
        height_m: Distance from the crankshaft to the middle of each cylinder's guide, by its
            number, shape (cylinders,).
        force_of_one: Force of one cylinder at each speed, N, next to which an external force may be
            negligible, shape (speeds,).
        moment_of_one: Moment of one cylinder, N m, shape (speeds,).
        every_order: Whether people are shown orders that are negligible, too.
    """

    engine: Engine
    speeds_rpm: Array
    orders: Array
    figures: dict[str, Array]
    height_m: Array
    force_of_one: Array
    moment_of_one: Array
    every_order: bool = False


def find_marine_sheet(
    engine: Engine,
    speeds_rpm: Sequence[float] = (),
    orders: Iterable[float] | None = None,
    guide_height_m: float | None = None,
    every_order: bool = False,
) -> MarineSheet:
    """Compute external forces and moments, guide-force moments and torque of an engine by order.

    Args:
        engine: Engine without trailing axes.
        speeds_rpm: Speeds; default: the engine's own.
        orders: Orders; default: all that `analyze` shows of one of them at one of the speeds.
        guide_height_m: Distance from the crankshaft to the middle of the guides; default: each
            rod's length.
        every_order: Whether people are shown orders that are negligible, too; they are if orders
            are given.

    Raises:
        BalcliError: orders that are none or too high.
    """
    torque = TORQUE if engine.gas is None else TORQUE_TOTAL
    ask = partial(
        analyze, only=("force", "moment", "guide", torque.name), guide_height_m=guide_height_m
    )
    speeds = [float(speed) for speed in speeds_rpm] or [float(engine.speed_rpm)]
    found = analyze_alike([replace(engine, speed_rpm=speed) for speed in speeds], orders, ask)
    each = [_list_amplitudes(one, torque.name) for one in found]
    guide = found[0].guide
    return MarineSheet(
        replace(engine, speed_rpm=speeds[0]),
        np.array(speeds),
        found[0].orders,
        {name: np.stack(sizes) for name, *sizes in zip(FIGURES, *each, strict=True)},
        np.array([]) if guide is None else guide.height_m,
        np.array([one.of_one_cylinder["force"] for one in found]),
        np.array([one.of_one_cylinder["moment"] for one in found]),
        every_order or orders is not None,
    )


def _list_amplitudes(one: Analysis, torque: str) -> tuple[Array, ...]:
    """Return amplitudes at one speed in the order of `FIGURES`, each of shape (orders,)."""
    spectra = one.spectra.with_moment_if(one.moments_known)
    force, moment = spectra["force"], spectra["moment"]
    guides = (None, None) if one.guide is None else (one.guide.h, one.guide.x)
    unknown = np.full(one.orders.shape, np.nan)
    return (
        *(np.abs(component) for component in (force.x, force.y, moment.y, moment.x)),
        *(unknown if guide is None else guide.major for guide in guides),
        np.abs(spectra[torque].x),
    )
