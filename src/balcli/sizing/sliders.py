"""The scheme `slider`: reciprocating masses for any order."""

from __future__ import annotations

import cmath

from ..core.phasors import wrap_degrees
from ..engine.build import Engine
from .device_tables import measure_direction
from .effects import Slot, size_unbalances
from .fitting import Fitting
from .options import SchemeOptions
from .planes import choose_plane
from .reasons import explain_sliders
from .remedy import Remedy
from .residual import (
    BACKWARD_FORCE,
    BACKWARD_MOMENT,
    FORWARD_FORCE,
    FORWARD_MOMENT,
    choose_residual,
)


def size_sliders(engine: Engine, options: SchemeOptions) -> Remedy:
    """Two reciprocating masses along the axes of the ellipse of order N: `m r = (|V+| +- |V-|) /
    (n^2 omega^2)`.

    They stand where the stronger of the two rotating forces acts, unless a place is asked for.
    """
    residual = choose_residual(engine, options, ("force",))
    forward, backward = residual.force(1), residual.force(-1)
    stronger = 1 if abs(forward) >= abs(backward) else -1
    z, place = choose_plane(engine, options, residual, stronger), options.read_place()
    axis = float(wrap_degrees(measure_direction(cmath.sqrt(forward * backward)), 180))
    across = axis + 90 if axis <= 0 else axis - 90
    slots = [Slot("slider", residual.order, 0, z, place, direction) for direction in (axis, across)]
    fit = size_unbalances(slots, residual, (FORWARD_FORCE, BACKWARD_FORCE))
    rounding = 2 * residual.noise[FORWARD_FORCE]
    unbalances = [u if abs(u) > rounding else 0j for u in fit.unbalances]
    fitting = Fitting.start(engine, "slider", residual.order, residual.note)
    fitting = fitting.add(slots, unbalances, explain_sliders(residual))
    left = fitting.find_residual(residual.order)
    moment = left.size(FORWARD_MOMENT, BACKWARD_MOMENT)
    return fitting.add_details(moment_left_Nm=moment).describe_roll(residual).remedy
