"""A damper sized on the whole system: from the optimum of a system with one degree of freedom to
the one that makes the largest stress over a range of speeds least.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import count
from typing import NamedTuple

import numpy as np

from ..core.golden_section import ROUNDS, find_least
from ..core.telling import Tell, tell_nobody
from ..core.vibration import Real
from ..enginefile.fields import printable
from ..enginefile.shafting import Damper
from ..errors import BalcliError
from .damper_proposal import DamperAsked, find_mode_to_damp, propose_damper
from .largest import find_hottest, find_largest_of_all
from .load import Source
from .motion import stress_by_torque
from .system import TorsionalSystem

_FIGURE = {"viscous": "damping", "rubber": "stiffness", "pendulum": "length"}  # that is sized
_WIDTH = {"viscous": 30.0, "rubber": 4.0, "pendulum": 1.2}  # range of the search, times and over
_PLACES = 13  # looked at over this range before the best is approached
_END = 0.99  # of this range: a best one farther out is at its end
_HARDLY = 0.99  # of the largest stress without it: one that leaves more is no use
_HEAVY = 10.0  # times the inertia of what carries it: for more there is no room
_RESPONSES = _PLACES + 2 + ROUNDS + 2  # of one valley; the last of the best damper, and of none


class SizedDamper(NamedTuple):
    """A damper and what it does.

    Attributes:
        node: what carries it.
        damper: as a file describes it.
        start: its figure that was sized (damping, stiffness or length), as the optimum of a system
            with one degree of freedom has it, in the file's unit.
        sized: the same, sized on the whole system.
        figure: name of that figure.
        mode: number of the mode it was tuned to.
        measure: what was made least: "stress" in Pa, or "torque" in N m where no shaft has a
            diameter.
        before, after: largest over all shafts and speeds without a damper there, and with it.
        heat: largest power it turns to heat, W, and at which speed, rpm.
        doubts: what is unlikely of it, in words.
    """

    node: str
    damper: Damper
    start: float
    sized: float
    figure: str
    mode: int
    measure: str
    before: float
    after: float
    heat: float
    heat_rpm: float
    doubts: tuple[str, ...]


def size_damper(
    source: Source,
    asked: DamperAsked,
    speeds: Real,
    orders: Real | None = None,
    tell: Tell = tell_nobody,
) -> SizedDamper:
    """The damper that makes the largest stress of all shafts over speeds (rpm) least; `tell` is
    told which share of the work is done.

    Raises:
        BalcliError: nothing can carry it, or nothing excites the system.
    """
    node, own = _find_carrier(source.dampers(), asked.node)

    def build(damper: Damper | None) -> TorsionalSystem:
        return _excite(source.with_damper(node, damper).system(), orders)

    bare = build(None)
    measure, weights = "torque", np.ones(len(bare.shafts))
    if any(bare.sections):
        measure, weights = "stress", np.nan_to_num(stress_by_torque(bare))
    place = bare.nodes.index(node)
    mode, order = find_mode_to_damp(bare, speeds, weights, place)
    first = propose_damper(asked, own, bare, place, mode, order, source.crank_radius)
    figure = _FIGURE[asked.kind]
    start = float(getattr(first, figure))
    tried = count(1)

    def judge(damper: Damper | None) -> float:
        """Largest stress or torque of the shafts there without it, between the speeds, too."""
        system = build(damper)
        shafts = [system.shafts.index(name) for name in bare.shafts]
        tell(min(next(tried) / _RESPONSES, 1.0))
        return find_largest_of_all(system, speeds, shafts, weights)

    width = math.log(_WIDTH[asked.kind])
    farther = _minimise(
        lambda logarithm: _bound(judge, _with(first, figure, start * math.exp(logarithm))),
        -width,
        width,
    )
    best = float(f"{start * math.exp(farther):.6g}")
    damper = _with(first, figure, best)
    heat, heat_rpm = _find_heat(build(damper), node, speeds)
    found = SizedDamper(
        node,
        damper,
        start=start,
        sized=best,
        figure=figure,
        mode=mode.number,
        measure=measure,
        before=_bound(judge, None),
        after=judge(damper),
        heat=heat,
        heat_rpm=heat_rpm,
        doubts=(),
    )
    of_file = own is not None and own.kind == asked.kind
    doubts = _doubt(found, bare, of_file or asked.inertia is not None)
    return found._replace(doubts=tuple(doubts))


def _doubt(found: SizedDamper, bare: TorsionalSystem, given: bool) -> Iterator[str]:
    """What is unlikely of a damper; `given`: its size was not proposed here."""
    inertia, node = _find_inertia(found.damper), printable(found.node)
    carrier = float(bare.chain.inertia[bare.nodes.index(found.node)])
    whole = float(np.sum(bare.chain.inertia))
    if found.after > _HARDLY * found.before:
        does = "raises", ""
        if found.after <= found.before:
            does = "lowers", f" by less than {1 - _HARDLY:.0%}"
        yield (
            f"a {found.damper.kind} damper of {inertia:.4g} kg m2 at {node} {does[0]} the largest "
            f"{found.measure}{does[1]}; the whole system has {whole:.4g} kg m2. Is it of the right "
            "size (on the command line bare numbers are kg mm2), and in the right place?"
        )
    elif given and inertia > whole:
        yield (
            f"the damper has {inertia:.4g} kg m2, more than the whole system ({whole:.4g} kg m2): "
            "on the command line bare numbers are kg mm2"
        )
    elif not given and inertia > _HEAVY * carrier > 0:
        yield (
            f"the damper that is proposed has {inertia:.4g} kg m2, {inertia / carrier:.3g} times "
            f"as much as {node}, which carries it ({carrier:.4g} kg m2): say what there is room "
            'for, such as --damper-inertia "'
            f'{float(f"{carrier:.2g}"):.12g} kg m^2"{_ask_radius(found.damper)}'
        )
    else:
        yield from _doubt_end(found)


def _doubt_end(found: SizedDamper) -> Iterator[str]:
    """That the best lies where the search ends."""
    width = _WIDTH[found.damper.kind]
    if abs(math.log(found.sized / found.start)) > _END * math.log(width):
        more = "more" if found.sized > found.start else "less"
        yield (
            f"the best {found.figure} is at the end of what is looked at, {1 / width:.2g} to "
            f"{width:g} times that of mode {found.mode} by itself; {more} may be better still"
        )


def _ask_radius(damper: Damper) -> str:
    if damper.kind != "pendulum":
        return ""
    return "; pendulums farther out are lighter: give a pendulum damper with its radius in the file"


def _find_inertia(damper: Damper) -> float:
    """About the axis, kg m2: of the ring, or of the pendulums as they hang."""
    if damper.inertia is not None:
        return damper.inertia / 1e6
    out = ((damper.radius or 0.0) + (damper.length or 0.0)) / 1e3
    return (damper.mass or 0.0) * out**2


def _find_heat(system: TorsionalSystem, node: str, speeds: Real) -> tuple[float, float]:
    """Largest power that the damper of a node turns to heat, W, and at which speed, rpm."""
    rpm, heat = find_hottest(system, speeds)
    mine = (k for k, name in enumerate(system.dampers) if name.removesuffix(" ring") == node)
    ring = next(mine, None)
    return (0.0, float(speeds[0])) if ring is None else (float(heat[ring]), float(rpm[ring]))


def _bound(judge: Callable[[Damper | None], float], damper: Damper | None) -> float:
    """Largest with a damper or none; inf where nothing damps a resonance."""
    try:
        return judge(damper)
    except BalcliError:
        return math.inf


def _find_carrier(
    carriers: Mapping[str, Damper | None], asked: str | None
) -> tuple[str, Damper | None]:
    """Name of the node that is to carry the damper, and the one it has."""
    name = next(iter(carriers), None) if asked is None else asked
    if name is None:
        raise BalcliError("--damper: nothing can carry one; give a part in [[torsion.front]]")
    if name not in carriers:
        raise BalcliError(
            f'--damper-at "{printable(name)}": cannot carry a damper; what can is '
            f"{', '.join(printable(each) for each in carriers)}"
        )
    return name, carriers[name]


def _excite(system: TorsionalSystem, orders: Real | None) -> TorsionalSystem:
    """The same, excited at these orders alone; None: at all."""
    excitation = system.excitation
    if excitation is None:
        raise BalcliError("--damper: nothing excites the system; give an [[excitation]]")
    if orders is not None:
        excitation = excitation.only(orders)
    if not len(excitation.orders):
        raise BalcliError("--damper: nothing excites the system at the orders asked for")
    return replace(system, excitation=excitation)


def _with(damper: Damper, figure: str, value: float) -> Damper:
    return damper.model_copy(update={figure: value})


def _minimise(judge: Callable[[float], float], low: float, high: float) -> float:
    """Where a function is least: golden section in every valley that a few places show."""
    places = np.linspace(low, high, _PLACES).tolist()
    values = np.array([judge(place) for place in places])
    around = np.concatenate([[np.inf], values, [np.inf]])
    bottoms = np.flatnonzero((values < around[:-2]) & (values <= around[2:])).tolist()
    found = [
        find_least(judge, places[max(k - 1, 0)], places[min(k + 1, _PLACES - 1)]) for k in bottoms
    ]
    return min(found, key=judge, default=low)
