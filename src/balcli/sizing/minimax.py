"""The scheme `minimax`: the counterweight with which the largest force over a revolution is as
small as a weight on the crankshaft can make it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..core import enclosing_circle
from ..core.cylinders import DeviceKind
from ..engine.build import Engine
from ..errors import BalcliError
from .balance_factor import find_curve, find_factor_peaks
from .effects import Slot, size_unbalances
from .fitting import Fitting
from .options import SchemeOptions
from .planes import SAME_PLACE, find_crank_middle, read_planes
from .remedy import Remedy
from .residual import FORWARD, FORWARD_FORCE, NothingToBalanceError

_LEFT = 1e-9  # of what is to be cancelled: more, and these planes cannot take the moment


def size_minimax(engine: Engine, options: SchemeOptions) -> Remedy:
    """The counterweight that moves the centre of the smallest circle around `F e^{-i theta}` to the
    origin (docs/theory.md).

    One weight in the middle of the throws, or in the planes asked for such that the moment turning
    with the crank vanishes too.

    Raises:
        BalcliError: the planes asked for cannot take the moment.
        NothingToBalanceError: no weight makes the largest force smaller.
    """
    fitting = Fitting.start(engine, "minimax", 1)
    circle = enclosing_circle.enclose_curve(find_curve(fitting.engine, "force"))
    newtons_per_kg_m = float(engine.omega) ** 2
    noise = fitting.find_residual(1).noise[FORWARD_FORCE] * newtons_per_kg_m
    centred = abs(circle.centre) <= max(noise, circle.noise)
    nothing_gained = (
        "no counterweight makes the largest force smaller than it is: the smallest circle around "
        "the force as seen from the crank has its centre at 0"
    )
    if centred and options.planes is None:
        raise NothingToBalanceError(nothing_gained)
    unbalance = 0j if centred else -circle.centre / newtons_per_kg_m
    slots, unbalances = _split(engine, options, fitting, unbalance)
    reason = (
        "The largest force over a revolution, all orders, becomes as small as a counterweight can "
        "make it (smallest circle around the force as seen from the crank)"
    )
    fitting = fitting.add(slots, unbalances, reason)
    remedy = fitting.remedy.add_details(
        peak_force_N=circle.radius,
        reached_deg=sorted(round(float(angle), 9) % 360 for angle in np.degrees(circle.theta)),
        relative_error_bound=circle.excess / circle.radius if circle.radius else 0.0,
        **_compare_with_half(fitting.engine, circle),
    )
    return remedy if remedy.devices else remedy._replace(note=nothing_gained)


def _split(
    engine: Engine, options: SchemeOptions, fitting: Fitting, unbalance: complex
) -> tuple[Sequence[Slot], Sequence[complex]]:
    """Slots and unbalances (kg m) that add up to this one: in one plane, or in the planes asked for
    such that no moment of order 1 turning with the crank is left.
    """
    if options.planes is None:
        z = find_crank_middle(engine) if options.position is None else options.position
        return [Slot("counterweight", 1, 1, z)], [unbalance]
    slots = [Slot("counterweight", 1, 1, z) for z in read_planes(engine, options)]
    residual = fitting.find_residual(1)
    wanted = residual._replace(parts={**residual.parts, FORWARD_FORCE: -unbalance})
    fit = size_unbalances(slots, wanted, FORWARD)
    if fit.left > _LEFT:
        raise BalcliError(f"--planes: {SAME_PLACE}")
    return slots, fit.unbalances


def _compare_with_half(engine: Engine, circle: enclosing_circle.Circle) -> dict[str, float]:
    """Return the largest force with the weights of factor 0.5 instead of the engine's own, and by
    which share the circle is smaller; nothing of a rotary engine, which has no factor.
    """
    if engine.rotary:
        return {}
    off_crank = tuple(d for d in engine.devices if d.kind is not DeviceKind.COUNTERWEIGHT)
    half = find_factor_peaks(replace(engine, devices=off_crank), 0.5).peak_force_N
    gain = 1 - circle.radius / half if abs(half - circle.radius) > circle.noise else 0.0
    return {"factor_half_peak_N": half, "improvement": gain}
