"""What builders of large engines state of an engine: external forces and moments by order, vertical
and horizontal, guide-force moments and torque, at one speed or several.

Vertical is along x, horizontal along y. A vertical force makes the moment about the y axis that is
called vertical, too: M1V is My of order 1, M1H its Mx.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..core.phasors import Array, Phasors
from ..engine.build import Engine
from ..forces.kinds import TORQUE, TORQUE_TOTAL
from .analysis import Analysis, analyze
from .comparison import analyze_alike


@dataclass(frozen=True, eq=False)
class MarineSheet:
    """Amplitudes by speed and order, shape (speeds, orders), SI; nan where they are not known.

    Attributes:
        engine: at the first of the speeds.
        speeds_rpm: shape (speeds,).
        orders: shape (orders,), ascending.
        force_v, force_h: external forces along x and y, N.
        moment_v, moment_h: external moments of the forces along x and along y, N m.
        guide_h, guide_x: H- and X-type guide-force moments, N m.
        torque: on the crank, of inertia, and of the gas where the engine has some, N m.
        height_m: from the crankshaft to the middle of each cylinder's guide, by its number, shape
            (cylinders,).
        force_of_one, moment_of_one: what one cylinder makes at each speed (N, N m), beside which an
            external force or moment may be negligible, shape (speeds,).
        every_order: whether people are shown orders that are negligible, too.
    """

    engine: Engine
    speeds_rpm: Array
    orders: Array
    force_v: Array
    force_h: Array
    moment_v: Array
    moment_h: Array
    guide_h: Array
    guide_x: Array
    torque: Array
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
    """External forces and moments, guide-force moments and torque of an engine by order.

    Args:
        engine: without trailing axes.
        speeds_rpm: default: the engine's own.
        orders: default: all that `analyze` shows of one of them at one of the speeds.
        guide_height_m: from the crankshaft to the middle of the guides; default: each rod's length.
        every_order: whether people are shown orders that are negligible, too; they are if orders
            are given.

    Raises:
        BalcliError: orders that are none or too high.
    """
    torque = TORQUE if engine.gas is None else TORQUE_TOTAL
    ask = partial(
        analyze, only=("force", "moment", "guide", torque.name), guide_height_m=guide_height_m
    )
    speeds = [float(speed) for speed in speeds_rpm] or [float(engine.speed_rpm)]
    engines = [replace(engine, speed_rpm=speed) for speed in speeds]
    found = analyze_alike(engines, orders, ask)
    guides = [one.guide for one in found if one.guide is not None]
    return MarineSheet(
        engines[0],
        np.array(speeds),
        found[0].orders,
        _stack(found, "force", _along_x),
        _stack(found, "force", _along_y),
        _stack(found, "moment", _along_y),
        _stack(found, "moment", _along_x),
        np.stack([guide.h.major for guide in guides]),
        np.stack([_size_or_unknown(guide.x, guide.h) for guide in guides]),
        _stack(found, torque.name, _along_x),
        guides[0].height_m,
        np.array([one.of_one_cylinder["force"] for one in found]),
        np.array([one.of_one_cylinder["moment"] for one in found]),
        every_order or orders is not None,
    )


def _stack(found: Sequence[Analysis], kind: str, size: Callable[[Phasors], Array]) -> Array:
    """Shape (speeds, orders); nan of moments that are not known."""
    spectra = (one.spectra.with_moment_if(one.moments_known) for one in found)
    return np.stack([size(one[kind]) for one in spectra])


def _along_x(phasors: Phasors) -> Array:
    sizes: NDArray[np.float64] = np.abs(phasors.x)
    return sizes


def _along_y(phasors: Phasors) -> Array:
    sizes: NDArray[np.float64] = np.abs(phasors.y)
    return sizes


def _size_or_unknown(moment: Phasors | None, like: Phasors) -> Array:
    return np.full(like.major.shape, np.nan) if moment is None else moment.major
