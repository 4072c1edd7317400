"""Decide which engines are judged as shipbuilders judge them: slow two-stroke engines with
crossheads, whose free moments are compared with their power (power related unbalance), and which
get moment compensators in place of balancer shafts.

A crosshead is recognized by the stroke. Its mass alone tells little, because it may stand in
`crosshead.mass` or in `piston.mass`, and because pumps, compressors and steam engines have
crossheads, too.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..engine.engine import Engine
from ..forces.power import takes_power

_UPRIGHT_DEG = 45.0  # farthest direction from x that is still up: the cylinders stand


class CrossheadStroke(NamedTuple):
    """Strokes by which a two-stroke engine is recognized as one with crossheads.

    Attributes:
        least_m: No ship's engine with crossheads has a shorter stroke, m; plunger pumps and
            reciprocating compressors seldom have a longer one.
        trunk_m: Longer strokes need crossheads, m. Two-stroke engines with trunk pistons reach
            0.79 m (Nordberg, 21.5 x 31 in).
        bores: So do strokes that are longer than this number of bores.
    """

    least_m: float = 0.5
    trunk_m: float = 0.8
    bores: float = 2.5

    def find_limit(self, bore_m: float) -> float:
        """Return the stroke, m, above which an engine of this bore (m; nan: not known) has
        crossheads.
        """
        return max(self.least_m, min(self.trunk_m, self.bores * bore_m))


def find_crosshead_stroke(engine: Engine) -> CrossheadStroke:
    """Return the strokes by which a single engine is recognized: if its file gives the mass of a
    crosshead, the least stroke of ships' engines suffices.
    """
    usual = CrossheadStroke()
    if any(float(masses.crosshead) > 0 for masses in engine.weighed):
        return usual._replace(trunk_m=usual.least_m)
    return usual


def is_judged_by_power(engine: Engine) -> bool:
    """Return whether devices are judged by the power related unbalance: every crank has the stroke
    of a ship's engine, and nothing in the file says that the machine is another one.
    """
    are_long = all(has_crossheads(crank.engine) for crank in engine.cranks)
    return are_long and may_be_ship_engine(engine)


def has_crossheads(engine: Engine) -> bool:
    """Return whether a single two-stroke engine has crossheads, as ships' engines have them."""
    stroke_m = 2 * float(np.max(engine.throw_radii_m))
    return stroke_m > find_crosshead_stroke(engine).find_limit(float(engine.bore_m))


def may_be_ship_engine(engine: Engine) -> bool:
    """Return whether a machine may be a ship's two-stroke engine, whatever its stroke: it has two
    strokes, its gas delivers power or is not known, and x may point up.

    Excluded are four-stroke engines, compressors, pumps, double-acting steam engines, locomotives,
    and machines that lie on their side.
    """
    lies = engine.up_deg is not None and not stands(engine.up_deg)
    if engine.of_locomotive or lies:
        return False
    engines = [crank.engine for crank in engine.cranks]
    if any(single.strokes != 2 or single.is_pump for single in engines):
        return False
    return not takes_power(engine)


def is_type_open(engine: Engine) -> bool:
    """Return whether only the size of a machine tells that it is a ship's engine: its file has no
    power, no gas and no firing order.
    """
    has_power = engine.rated is not None and bool(engine.rated.power_W)
    fires = any(crank.engine.fires_deg for crank in engine.cranks)
    return not (has_power or fires or engine.gas is not None)


def stands(up_deg: float) -> bool:
    """Return whether x, along which compensators act, points up.

    Args:
        up_deg: Direction that points up, deg from x.
    """
    return bool(np.cos(np.radians(up_deg)) > np.cos(np.radians(_UPRIGHT_DEG)))
