"""Decide which engines are judged as shipbuilders judge them: slow two-stroke engines with
crossheads, whose free moments are compared with their power (power related unbalance), and which
get moment compensators in place of balancer shafts.

The decision uses facts that do not depend on how a file divides its masses. A crosshead is
recognized by the stroke, because its mass may stand in `crosshead.mass` or in `piston.mass`, and
because pumps, compressors and steam engines have crossheads, too.
"""

from __future__ import annotations

import numpy as np

from ..engine.engine import Engine
from ..forces.power import takes_power

# m; longer strokes need crossheads. Two-stroke engines with trunk pistons reach 0.79 m (Nordberg,
# 21.5 x 31 in), the shortest ships' engines with crossheads of the last decades have 0.88 m
# (Mitsubishi UEC37LA); plunger pumps and reciprocating compressors seldom exceed 0.5 m.
CROSSHEAD_STROKE_M = 0.8
_UPRIGHT_DEG = 45.0  # farthest direction from x that is still up: the cylinders stand


def is_judged_by_power(engine: Engine) -> bool:
    """Return whether devices are judged by the power related unbalance: every crank has the stroke
    of a ship's engine, and nothing in the file says that the machine is another one.
    """
    strokes_m = [find_longest_stroke(crank.engine) for crank in engine.cranks]
    return min(strokes_m) > CROSSHEAD_STROKE_M and may_be_ship_engine(engine)


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


def find_longest_stroke(engine: Engine) -> float:
    """Return the longest stroke of a single engine, m: twice its largest crank radius."""
    return 2 * float(np.max(engine.throw_radii_m))


def stands(up_deg: float) -> bool:
    """Return whether x, along which compensators act, points up.

    Args:
        up_deg: Direction that points up, deg from x.
    """
    return bool(np.cos(np.radians(up_deg)) > np.cos(np.radians(_UPRIGHT_DEG)))
