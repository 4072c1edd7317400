"""Articulated rods: which cylinders hang on which master rod, where their knuckle pins are, and
what does not fit together in [articulation].
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from ..core.cylinders import Cylinders
from ..core.mechanisms.articulated import Articulated
from ..core.mechanisms.linkage import STEPS, Linkage, revolution
from ..core.mechanisms.rotary import Rotary
from ..core.phasors import Array, Figure, unit
from ..enginefile.articulation_tables import Articulation
from ..enginefile.fields import counted
from ..enginefile.model import EngineFile
from ..errors import Problem
from ..limits import NEAREST_TO_LOCK
from .arrays import column
from .layout import Plan

_AT_ONCE = 1 << 17  # rods x crank angles that are looked at together


class KnucklePins(NamedTuple):
    """Knuckle pins of the articulated cylinders.

    Attributes:
        ratio: knuckle radius over crank radius.
        angles_deg: of the knuckle pin, from the master rod's axis, by number of the cylinder.
        master: number of the cylinder with the master rod, by number of the articulated one.
    """

    ratio: Figure
    angles_deg: Mapping[int, Figure]
    master: Mapping[int, int]


def find_masters(articulation: Articulation, plan: Plan) -> dict[int, int]:
    """Number of the cylinder with the master rod, by number of each articulated cylinder."""
    of_throw = {c.throw: c.number for c in plan.cells if c.bank == articulation.master - 1}
    on_throw = [(c.number, of_throw.get(c.throw, c.number)) for c in plan.cells]
    return {number: master for number, master in on_throw if number != master}


def build_linkage(
    knuckles: KnucklePins,
    numbers: Sequence[int],
    axes_deg: Mapping[int, Figure],
    on_knuckle: Sequence[Figure],
    sense: int,
    rank: int,
) -> Articulated:
    """The mechanism of master and articulated rods.

    Args:
        knuckles: where the rods hang.
        numbers: cylinder of each row.
        axes_deg: of each cylinder, from x.
        on_knuckle: what the lower end of each row's rod weighs, kg.
        sense: -1 seen from turning cylinders, where all angles are in the mirror (core.rotary).
        rank: trailing axes, as in `engine.build`.
    """
    master = knuckles.master
    hung = [n in master for n in numbers]
    pins_deg = column([sense * knuckles.angles_deg.get(n, 0.0) for n in numbers], rank)
    ratio = column([knuckles.ratio if here else 0.0 for here in hung], rank)
    leads_deg = [sense * (axes_deg[n] - axes_deg[master.get(n, n)]) for n in numbers]
    return Articulated(
        mass=column([m if here else 0.0 for here, m in zip(hung, on_knuckle, strict=True)], rank),
        master=np.array([numbers.index(master.get(n, n)) for n in numbers]),
        knuckle=ratio * unit(pins_deg),
        lead_deg=column(leads_deg, rank),
    )


# ------------------------------------------------------------------ what does not fit together
def check_articulation(
    articulation: Articulation,
    plan: Plan,
    angles_deg: Sequence[Figure] | None,
    splay_deg: Figure,
    with_own_throw: Collection[int],
) -> Iterator[Problem]:
    """What contradicts [articulation].

    Args:
        articulation: the table; its knuckle angles are in `angles_deg`.
        plan: the cylinders.
        splay_deg: lead of split pins.
        with_own_throw: cylinders that have a crank pin of their own.
    """
    fault = _find_no_place(articulation.master, plan)
    if fault:
        yield fault
        return
    if angles_deg is not None:
        yield from _check_angles(angles_deg, articulation.master - 1, plan.banks)
    if np.any(np.asarray(splay_deg) != 0):
        yield Problem(
            "crank.splay",
            "articulated rods hang on the master rod and have no crank pins to split: "
            "leave splay out, or [articulation]",
        )
    for number in find_masters(articulation, plan):
        if number in with_own_throw:
            yield Problem(
                f"cylinder.{number}.throw",
                f"cylinder {number} has an articulated rod, which hangs on the "
                "master rod and not on a crank pin: leave this out",
            )


def _find_no_place(master: int, plan: Plan) -> Problem | None:
    """Why there is no throw for a master rod and others, or no such bank."""
    banks = plan.banks
    needs = "needs a throw that carries the rods of several banks; this engine has"
    if banks < 2:
        return Problem("articulation", f"{needs} 1 bank: give bank_angle, banks or radial")
    if plan.rods_on_throw < banks:
        return Problem(
            "articulation",
            f'{needs} {banks} banks with rods = "alternating", one rod a throw: give rods = '
            '"shared"',
        )
    if master > banks:
        return Problem(
            "articulation.master", f"there is no bank {master}; this engine has banks 1 to {banks}"
        )
    return None


def _check_angles(angles_deg: Sequence[Figure], master: int, banks: int) -> Iterator[Problem]:
    path = "articulation.knuckle_angles"
    if len(angles_deg) != banks:
        yield Problem(
            path,
            f"has {counted(len(angles_deg), 'angle')} for {counted(banks, 'bank')}: give one for "
            "each, the master's own is 0",
        )
    elif np.any(np.asarray(angles_deg[master]) != 0):
        angle = max(np.ravel(angles_deg[master]), key=abs)
        yield Problem(
            path, f"has {angle:g} for bank {master + 1}, which carries the master rod: its own is 0"
        )


def check_knuckles(
    model: EngineFile, cylinders: Cylinders, numbers: Sequence[int]
) -> Iterator[Problem]:
    """Articulated cylinders whose rod cannot follow its knuckle pin all the way round.

    Args:
        model: the file of an engine with articulated rods, for the place of the figure.
        cylinders, numbers: of that engine; of variants the worst counts.
    """
    linkage = cast(Linkage, cylinders.linkage)
    hung = cast(Articulated, linkage.hung if isinstance(linkage, Rotary) else linkage)
    leans = _sample_leans(hung, cylinders.lam, cylinders.eps)
    turned = cylinders.angle_deg.reshape(len(numbers), -1)[:, 0]
    for row, number in enumerate(numbers):
        worst = int(leans[row].argmax())
        lean = leans[row, worst] + _rise_above(leans[row], worst)
        if hung.master[row] != row and lean > 1 - NEAREST_TO_LOCK:
            yield _lock(model, number, lean, (360 / STEPS * worst - turned[row]) % 360)


def _sample_leans(hung: Articulated, lam: Array, eps: Array) -> Array:
    """The largest |sine| of each rod's angle to its cylinder's axis, of all variants that might
    lock, over a revolution: shape (cylinders, STEPS).
    """
    count = len(hung.master)
    given = hung.figures(lam, eps)
    _, *variants_shape = np.broadcast_shapes(*(np.shape(f) for f in given))
    doubtful = np.any(hung.bound_lean(lam, eps) > 1 - NEAREST_TO_LOCK, axis=0)
    variants = np.flatnonzero(np.broadcast_to(doubtful, variants_shape))
    figures: list[NDArray[Any]] = [
        np.broadcast_to(f, (count, *variants_shape)).reshape(count, -1) for f in given
    ]
    leans = np.zeros((count, STEPS))
    step = max(_AT_ONCE // leans.size, 1)
    for k in range(0, len(variants), step):
        some = [values[:, variants[k : k + step], None] for values in figures]
        with np.errstate(invalid="ignore"):  # beyond 1 there is no angle
            found = np.abs(hung.move(revolution(STEPS), *some).lean).max(axis=1)
        leans = np.maximum(leans, found)
    return leans


def _lock(model: EngineFile, number: int, lean: float, crank_deg: float) -> Problem:
    own = model.cylinder.get(number)
    general = own is None or (own.rod_length is None and own.rod_ratio is None)
    return Problem(
        "articulation.rod.length" if general else f"cylinder.{number}.rod_length",
        f"the crank cannot turn: at crank angle {crank_deg:.4g} deg the knuckle pin of cylinder "
        f"{number} stands {lean:.9g} rod lengths beside the path of its piston pin; at most 1 - "
        f"{NEAREST_TO_LOCK:g} is allowed: make the articulated rod longer or the knuckle radius "
        "smaller",
    )


def _rise_above(values: Array, top: int) -> float:
    """How far a parabola through a sampled maximum (index `top`) and its neighbours rises above."""
    before, at, after = values[top - 1], values[top], values[(top + 1) % len(values)]
    bend = 2 * at - before - after
    return float((after - before) ** 2 / (8 * bend)) if bend > 0 else 0.0
