"""The damper that the search for the best begins with: for which mode it is, and its figures as the
optimum of a system with one degree of freedom has them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from pydantic import ValidationError

from ..core.speeds import RPM
from ..core.torsional_dampers import best_viscous_damping
from ..core.vibration import Real
from ..enginefile.fields import printable
from ..enginefile.messages import describe_finding
from ..enginefile.shafting import Damper
from ..errors import BalcliError
from .largest import find_largest_torques
from .modes import NaturalMode, find_criticals, find_natural_modes
from .motion import move
from .system import TorsionalSystem

RUBBER_LOSS = 0.15  # usual for damper rubber
# of the mode's inertia at the node, where nothing says how heavy a damper is
_SHARE = {"viscous": 0.3, "rubber": 0.15, "pendulum": 0.05}
_LOSS = 0.01  # of shafts, where nothing damps a resonance: modes are compared with it
_MOVES = 1.001  # times the whole inertia: with more at a node in a mode it hardly moves there,
# unless in every other mode there is more still
_LITTLE = 2.0  # times that: it moves a little, and a damper helps where nothing else resonates


class DamperAsked(NamedTuple):
    """What is to be sized.

    Attributes:
        kind: viscous, rubber or pendulum.
        node: what carries it, by name; None: the first that can.
        inertia: of ring or pendulums, kg m2; None: that of the file's damper there, or a usual
            share of the mode's.
    """

    kind: str
    node: str | None = None
    inertia: float | None = None


def find_mode_to_damp(
    system: TorsionalSystem, speeds: Real, weights: Real, node: int
) -> tuple[NaturalMode, float]:
    """The mode that a damper at a node is for, and the order that drives it: of the largest order
    in the largest stress of the range the mode nearest in frequency. By work alone that of a soft
    coupling would be it, which hardly twists the crankshaft.

    Where the node hardly moves in that one, it is of those in which it does the one on which most
    work is done. If the range meets none of them, it is that one after all, in which the node
    moves a little, or else the nearest.
    """
    modes = find_natural_modes(system)
    if not modes:
        raise BalcliError("--damper: the system has no mode that could be damped")
    order, omega = _find_hardest(system, speeds, weights)

    def find_nearest(some: Sequence[NaturalMode]) -> NaturalMode:
        return min(some, key=lambda mode: abs(math.log(mode.omega / omega)))

    whole = float(np.sum(system.chain.inertia * (system.gears / system.gears[node]) ** 2))
    heavy = [_find_inertia_in(mode, system, node) for mode in modes]
    most = _MOVES * max(whole, min(heavy))
    moved = [mode for mode, inertia in zip(modes, heavy, strict=True) if inertia <= most]
    numbers = {mode.number for mode in moved}
    worst = find_nearest(modes)
    if worst.number in numbers:
        return worst, order
    span = float(speeds[0]), float(speeds[-1])
    for met in find_criticals(system.require_excitation(), modes, span):
        if met.mode in numbers:
            return modes[met.mode - 1], met.order
    if heavy[worst.number - 1] <= _LITTLE * most:
        return worst, order
    return find_nearest(moved), order


def _find_hardest(system: TorsionalSystem, speeds: Real, weights: Real) -> tuple[float, float]:
    """The largest order in the largest stress of the range, and its frequency there, rad/s; with
    some loss in every shaft where nothing damps a resonance.
    """
    shafts = range(len(weights))
    try:
        rpm, torque = find_largest_torques(system, speeds, shafts)
    except BalcliError:
        loss = np.maximum(system.damping.loss, _LOSS)
        system = replace(system, damping=system.damping._replace(loss=loss))
        rpm, torque = find_largest_torques(system, speeds, shafts)
    worst = int(np.argmax(weights * torque))
    by_order = np.abs(move(system, rpm[worst : worst + 1]).torque[:, 0, worst])
    order = float(system.require_excitation().orders[int(np.argmax(by_order))])
    return order, order * float(rpm[worst]) * RPM


def _find_inertia_in(mode: NaturalMode, system: TorsionalSystem, node: int) -> float:
    """What vibrates in a mode, as if all of it were at a node, kg m2; inf where that is still."""
    moved = mode.shape[node] ** 2
    return float(np.sum(system.chain.inertia * mode.shape**2)) / moved if moved else math.inf


def propose_damper(
    asked: DamperAsked,
    own: Damper | None,
    system: TorsionalSystem,
    node: int,
    mode: NaturalMode,
    order: float,
    crank_radius: float | None,
) -> Damper:
    """A damper of the inertia that is wanted, tuned as the optimum of a system with one degree of
    freedom has it: Houdaille's for oil, Den Hartog's tuning for rubber, the order itself for
    pendulums. Those hang where the file says, else as far out as the crank pins (m).

    Raises:
        BalcliError: what is to carry it stands still in the mode; nothing says where pendulums
            hang.
    """
    own = own if own is not None and own.kind == asked.kind else None
    if mode.shape[node] == 0:
        raise BalcliError(f"--damper: {system.nodes[node]} does not move in mode {mode.number}")
    there = _find_inertia_in(mode, system, node)
    known = None if own is None or own.inertia is None else own.inertia / 1e6
    inertia = asked.inertia or known or float(f"{_SHARE[asked.kind] * there:.4g}")
    ratio, written = inertia / there, float(f"{inertia * 1e6:.12g}")
    if asked.kind == "viscous":
        damping = best_viscous_damping(inertia, ratio, mode.omega)
        return _make("viscous", inertia=written, damping=damping)
    if asked.kind == "rubber":
        stiffness = inertia * (mode.omega / (1 + ratio)) ** 2
        loss = RUBBER_LOSS if own is None else own.loss
        return _make("rubber", inertia=written, stiffness=stiffness, loss=loss)
    radius = crank_radius if own is None or own.radius is None else own.radius / 1e3
    if radius is None:
        raise BalcliError(
            "--damper pendulum: a chain has no crank that says how far out pendulums hang: give "
            f"{printable(system.nodes[node])} one, such as damper = "
            '{ kind = "pendulum", mass = 2, radius = 60, length = 5 }'
        )
    length = radius * (system.gears[node] / order) ** 2
    mass = float(f"{inertia / (radius + length) ** 2:.4g}")
    if own is not None and own.mass is not None and asked.inertia is None:
        mass = own.mass
    return _make("pendulum", mass=mass, radius=radius * 1e3, length=length * 1e3)


def _make(kind: str, **figures: float | None) -> Damper:
    """A damper with these figures.

    Raises:
        BalcliError: one that no damper has.
    """
    try:
        return Damper.model_validate({"kind": kind} | figures)
    except ValidationError as error:
        wrong = describe_finding("damper", error.errors(include_url=False)[0], Damper)
        raise BalcliError(
            f"--damper {kind}: the best there cannot be: {wrong.path}: {wrong.message}; are "
            "inertias and stiffnesses of the system in the right units?"
        ) from None
