"""Where along the crank devices may stand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..engine.build import Engine
from .effects import Part, Rest


def ends(engine: Engine) -> tuple[float, float]:
    """First and last throw; where all stand in one plane, the outermost cylinders, or else
    devices.
    """
    reaches = [
        _reach(engine.throws_m),
        _reach(engine.cylinders.z),
        _reach([*engine.throws_m, *(float(d.z) for d in engine.devices)]),
    ]
    return next((r for r in reaches if r[0] < r[1]), reaches[0])


def length(engine: Engine) -> tuple[float, float]:
    """From the outermost throw or cylinder to the other."""
    return _reach([*engine.throws_m, *np.ravel(engine.cylinders.z)])


def middle(engine: Engine) -> float:
    """Half-way between the first and the last throw."""
    low, high = _reach(engine.throws_m)
    return (low + high) / 2


def single(wish: Rest, sense: int, within: tuple[float, float]) -> float | None:
    """The z at which one device takes force and moment together, `z_ref + Re(M / iV)`; None if
    there is none within those bounds.
    """
    force, moment = wish.at("force", sense), wish.at("moment", sense)
    if force == 0:
        return None
    z = wish.arm[1] + (moment / force).real
    low, high = within
    near = min(max(z, low), high)
    for place in (
        round(near, 12),
        near,
    ):  # a thousandth of a nanometre: figures that people can read
        arm = place - wish.arm[1]
        if abs(moment - arm * force) <= wish.noise[Part("moment", sense)]:
            return place
    return None


def of_part(engine: Engine, wish: Rest, sense: int) -> tuple[float, ...]:
    """One plane if that takes force and moment, else both ends; none where nothing is left."""
    if wish.at("force", sense) == 0 == wish.at("moment", sense):
        return ()
    one = single(wish, sense, length(engine))
    return ends(engine) if one is None else (one,)


def _reach(places: Sequence[float] | np.ndarray) -> tuple[float, float]:
    flat = np.ravel(places)
    return float(flat.min()), float(flat.max())
