"""Articulated rods of an engine file: which cylinders hang on which master rod, where their knuckle
pins are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ..core.cylinders import Cylinders
from ..enginefile.fields import counted
from ..enginefile.model import Articulation, EngineFile
from ..errors import Problem
from ..limits import NEAREST_TO_LOCK
from .arrays import column
from .layout import Plan

if TYPE_CHECKING:
    from ..core.mechanisms.articulated import Articulated


def masters(file: EngineFile, layout: Plan) -> dict[int, int]:
    """Number of the cylinder with the master rod, by number of each articulated cylinder; empty
    without the table.
    """
    if file.articulation is None:
        return {}
    chief = {c.throw: c.number for c in layout.cells if c.bank == file.articulation.master - 1}
    return {
        c.number: chief[c.throw] for c in layout.cells if chief.get(c.throw, c.number) != c.number
    }


def mistakes(file: EngineFile, layout: Plan) -> Iterator[Problem]:
    """What does not fit together in [articulation] and the tables that it concerns."""
    if file.articulation is None:
        return
    fault = _no_place(file.articulation.master, layout)
    if fault:
        yield fault
        return
    yield from _wrong_angles(file.articulation, len(layout.banks))
    if np.any(np.asarray(file.crank.splay) != 0):
        yield Problem(
            "crank.splay",
            "articulated rods hang on the master rod and have no crank pins to split: "
            "leave splay out, or [articulation]",
        )
    for number in masters(file, layout):
        if (own := file.cylinder.get(number)) is not None and own.throw is not None:
            yield Problem(
                f"cylinder.{number}.throw",
                f"cylinder {number} has an articulated rod, which hangs on the "
                "master rod and not on a crank pin: leave this out",
            )


def _no_place(master: int, layout: Plan) -> Problem | None:
    banks = len(layout.banks)
    if banks < 2:
        return Problem(
            "articulation",
            "needs a throw that carries the rods of several banks; this engine has 1 bank: "
            "give bank_angle, banks or radial",
        )
    if layout.rods_on_throw < banks:
        return Problem(
            "articulation",
            f"needs a throw that carries the rods of several banks; this engine has {banks} "
            'banks with rods = "alternating", one rod a throw: give rods = "shared"',
        )
    if master > banks:
        return Problem(
            "articulation.master", f"there is no bank {master}; this engine has banks 1 to {banks}"
        )
    return None


def _wrong_angles(table: Articulation, banks: int) -> Iterator[Problem]:
    path, angles, own = "articulation.knuckle_angles", table.knuckle_angles, table.master - 1
    if angles is not None and len(angles) != banks:
        yield Problem(
            path,
            f"has {counted(len(angles), 'angle')} for {counted(banks, 'bank')}: give one for "
            "each, the master's own is 0",
        )
    elif angles is not None and np.any(np.asarray(angles[own]) != 0):
        angle = max(np.ravel(angles[own]), key=abs)
        yield Problem(
            path, f"has {angle:g} for bank {own + 1}, which carries the master rod: its own is 0"
        )


def linkage(
    file: EngineFile,
    layout: Plan,
    numbers: Sequence[int],
    axis: Mapping[int, Any],
    on_knuckle: Sequence[Any],
    rank: int = 0,
) -> Articulated | None:
    """The mechanism, with a row for each of `numbers`; `on_knuckle`: what the lower end of each rod
    weighs, kg; `rank` as in `engine.build`.
    """
    table = file.articulation
    if table is None:
        return None
    from ..core.mechanisms.articulated import Articulated
    from ..core.phasors import unit

    chief = masters(file, layout)
    sense = (
        -1 if file.layout.rotary else 1
    )  # seen from turning cylinders, all angles are in the mirror (core.rotary)
    bank = {c.number: c.bank for c in layout.cells}

    def pin(n: int) -> Any:
        if n not in chief:
            return 0j
        angle = table.knuckle_angles[bank[n]] if table.knuckle_angles else axis[n] - axis[chief[n]]
        return table.knuckle_radius / (file.crank.stroke / 2) * unit(sense * angle)

    return Articulated(
        mass=column(
            [m if n in chief else 0.0 for n, m in zip(numbers, on_knuckle, strict=True)], rank
        ),
        master=np.array([numbers.index(chief.get(n, n)) for n in numbers]),
        knuckle=column([pin(n) for n in numbers], rank),
        lead_deg=column([sense * (axis[n] - axis[chief.get(n, n)]) for n in numbers], rank),
    )


def locked(file: EngineFile, c: Cylinders, numbers: Sequence[int]) -> Iterator[Problem]:
    """Articulated cylinders whose rod cannot follow its knuckle pin all the way round."""
    if file.articulation is None or c.linkage is None:
        return
    from ..core.mechanisms.articulated import Articulated
    from ..core.mechanisms.linkage import STEPS, revolution
    from ..core.mechanisms.rotary import Rotary

    linkage = c.linkage
    hung = cast(Articulated, linkage.hung if isinstance(linkage, Rotary) else linkage)
    with np.errstate(invalid="ignore"):  # beyond 1 there is no angle
        leans = (
            np.abs(linkage.sample(lambda motion: motion.lean, revolution(STEPS), c.lam, c.eps))
            .reshape(len(numbers), -1, STEPS)
            .max(axis=1)
        )
    turned = c.angle_deg.reshape(len(numbers), -1)[:, 0]
    for row, number in enumerate(numbers):
        worst = int(leans[row].argmax())
        lean = leans[row, worst] + _rise(leans[row], worst)
        if hung.master[row] != row and lean > 1 - NEAREST_TO_LOCK:
            yield _lock(file, number, lean, (360 / STEPS * worst - turned[row]) % 360)


def _lock(file: EngineFile, number: int, lean: float, crank: float) -> Problem:
    own = file.cylinder.get(number)
    general = own is None or own.rod_length is None is own.rod_ratio
    return Problem(
        "articulation.rod.length" if general else f"cylinder.{number}.rod_length",
        f"the crank cannot turn: at crank angle {crank:.4g} deg the knuckle pin of cylinder "
        f"{number} stands "
        f"{lean:.9g} rod lengths beside the path of its piston pin; at most 1 - "
        f"{NEAREST_TO_LOCK:g} is "
        "allowed: make the articulated rod longer or the knuckle radius smaller",
    )


def _rise(values: Any, top: int) -> float:
    """How far a parabola through a sampled maximum and its neighbours rises above it."""
    before, at, after = values[top - 1], values[top], values[(top + 1) % len(values)]
    bend = 2 * at - before - after
    return float((after - before) ** 2 / (8 * bend)) if bend > 0 else 0.0
