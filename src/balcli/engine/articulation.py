"""Articulated rods: the rules that [articulation] has to keep."""

from __future__ import annotations

from collections.abc import Iterator
from typing import cast

import numpy as np

from ..core.mechanisms.linkage import STEPS, Articulated, Linkage, Rotary, revolution
from ..core.mechanisms.motion import Motion
from ..core.phasors import Array
from ..errors import Problem
from ..file.fields import counted
from ..limits import NEAREST_TO_LOCK
from .layout import Plan
from .parts import Parts


def check_articulation(parts: Parts) -> Iterator[Problem]:
    """Check that articulated rods have a master rod on their throw, one knuckle angle for each
    bank, and no crank pins of their own.
    """
    if (articulation := parts.model.articulation) is None:
        return
    if fault := _find_no_place(articulation.master, parts.plan):
        yield fault
        return
    angles, path = parts.find_knuckle_angles(), "articulation.knuckle_angles"
    banks, master = parts.plan.banks, articulation.master
    if angles is not None and len(angles) != banks:
        told = f"has {counted(len(angles), 'angle')} for {counted(banks, 'bank')}"
        yield Problem(path, f"{told}: give one for each, the master's own is 0")
    elif angles is not None and np.any(np.asarray(angles[master - 1]) != 0):
        angle = max(np.ravel(angles[master - 1]), key=abs)
        told = f"has {angle:g} for bank {master}, which carries the master rod: its own is 0"
        yield Problem(path, told)
    if np.any(np.asarray(parts.figures.take("crank.splay", parts.model.crank.splay)) != 0):
        told = "articulated rods have no crank pins to split: leave splay out, or [articulation]"
        yield Problem("crank.splay", told)
    for number in parts.masters:
        if parts.override(number, "throw") is not None:
            told = "its articulated rod hangs on the master rod: leave this out"
            yield Problem(f"cylinder.{number}.throw", told)


def _find_no_place(master: int, plan: Plan) -> Problem | None:
    """Return the mistake if no throw carries a master rod and others, or the bank is missing."""
    banks = plan.banks
    needs = f"needs a throw that carries the rods of several banks; this engine has {banks} bank"
    if banks < 2:
        return Problem("articulation", f"{needs}: give bank_angle, banks or radial")
    if plan.rods_on_throw < banks:
        told = f'{needs}s with rods = "alternating", one rod a throw: give rods = "shared"'
        return Problem("articulation", told)
    if master > banks:
        told = f"there is no bank {master}; this engine has banks 1 to {banks}"
        return Problem("articulation.master", told)
    return None


def check_knuckles(parts: Parts) -> Iterator[Problem]:
    """Check that every articulated rod can follow its knuckle pin through a revolution, for the
    worst of all variants.
    """
    if parts.model.articulation is None:
        return
    cylinders, numbers = parts.cylinders, parts.numbers
    linkage, lam, eps = cast(Linkage, cylinders.linkage), cylinders.lam, cylinders.eps
    hung = cast(Articulated, linkage.hung if isinstance(linkage, Rotary) else linkage)
    # Knuckle pins are at most a crank and a knuckle radius away.
    if np.all(lam * (1 + np.abs(hung.knuckle)) + np.abs(eps) <= 1 - NEAREST_TO_LOCK):
        return

    def find_largest(motion: Motion) -> Array:
        lean = np.abs(motion.lean)
        return lean.reshape(len(numbers), -1, lean.shape[-1]).max(axis=1)

    with np.errstate(invalid="ignore"):  # beyond 1 there is no angle
        leans = hung.sample(find_largest, revolution(STEPS), lam, eps)
    turned = cylinders.angle_deg.reshape(len(numbers), -1)[:, 0]
    for row, number in enumerate(numbers):
        worst = int(leans[row].argmax())
        before, at, after = (leans[row, (worst + k) % STEPS] for k in (-1, 0, 1))
        bend = 2 * at - before - after
        # The top of the parabola through the sampled maximum and its neighbours
        lean = at + ((after - before) ** 2 / (8 * bend) if bend > 0 else 0.0)
        if hung.master[row] == row or lean <= 1 - NEAREST_TO_LOCK:
            continue
        own, crank_deg = parts.model.cylinder.get(number), (360 / STEPS * worst - turned[row]) % 360
        general = own is None or (own.rod_length is None and own.rod_ratio is None)
        yield Problem(
            "articulation.rod.length" if general else f"cylinder.{number}.rod_length",
            f"the crank cannot turn: at crank angle {crank_deg:.4g} deg the knuckle pin of "
            f"cylinder {number} stands {lean:.9g} rod lengths off the path of its piston pin; at "
            f"most 1 - {NEAREST_TO_LOCK:g} is allowed: make the articulated rod longer or the "
            "knuckle radius smaller",
        )
