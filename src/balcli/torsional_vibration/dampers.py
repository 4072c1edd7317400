"""Size a damper so that the largest stress of the whole system over a range of speeds is least.

The search begins at the optimum of a system with one degree of freedom: Houdaille's damping for a
viscous ring, Den Hartog's stiffness for rubber, or for pendulums the length that is tuned to the
order with the largest torque. The search varies this damping, stiffness or length.

`insert_damper` writes a damper into the text of a file and keeps the comments of the file.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import count
from operator import itemgetter
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import ValidationError

from ..core.peaks import find_least_smooth
from ..core.phases import RPM
from ..core.records import HIDDEN
from ..core.vibration import Real
from ..errors import ArgumentError, BalcliError, Message
from ..file.edit import format_value, set_keys
from ..file.fields import printable
from ..file.torsion_tables import Damper
from ..process import Tell, tell_nobody
from .build import NO_DAMPERS, name_throw
from .chain import best_viscous_damping
from .load import Source
from .modes import NaturalMode, find_natural_modes
from .motion import compute_curves
from .response import find_largest
from .system import TorsionalSystem

# Figures of a damper: key in JSON, number of the file's units in an SI unit, and label.
DAMPER_KEYS = {
    "inertia": ("inertia_kg_m2", 1e6, "ring"),
    "damping": ("damping_Nms_per_rad", 1.0, "damping"),
    "stiffness": ("stiffness_Nm_per_rad", 1.0, "stiffness"),
    "loss": ("loss", 1.0, "loss factor"),
    "mass": ("mass_kg", 1.0, "mass of all pendulums"),
    "radius": ("radius_m", 1e3, "radius of the pivots"),
    "length": ("length_m", 1e3, "length to the centre of mass"),
}
RUBBER_LOSS = 0.15  # usual loss factor of damper rubber
# Figure that is sized, by kind of damper.
FIGURES = {"viscous": "damping", "rubber": "stiffness", "pendulum": "length"}
# The search runs from start/width to start*width; each kind of damper has its own width.
_WIDTH = {"viscous": 30.0, "rubber": 4.0, "pendulum": 1.2}
# default inertia of a damper, as a share of the equivalent inertia of the mode at the node
_SHARE = {"viscous": 0.3, "rubber": 0.15, "pendulum": 0.05}
# Largest half swing of pendulums, deg. At this swing the frequency of a pendulum on a circle is
# swing^2/16 = 0.8 % lower than at small swings.
WIDE_SWING = 20.0
_MASSES = 16  # largest number of masses that are tried to bring the swing below WIDE_SWING
_HEAVIER = 1.1  # margin on the next mass: swing is only about inversely proportional to mass
_MOST_AT_ONCE = 3.0  # largest factor from one tried mass to the next, without the margin
_MOST_PENDULUM = 0.5  # largest inertia of pendulums, as a share of the inertia of their node
_PLACES = 13  # number of grid points of the search, which then refines each valley
_RESPONSES = _PLACES + 10 + 1  # expected number of computed responses; the last has the best damper
_END = 0.99  # an optimum beyond this share of the (logarithmic) range counts as at an end
_HARDLY = 0.99  # a damper that leaves more than this share of the largest stress is useless
_HEAVY = 10.0  # a damper with more than this multiple of the inertia of its node is too large
_LOSS = 0.01  # least loss factor assumed for shafts if nothing damps a resonance
# If the equivalent inertia of a mode at a node is above this multiple of the inertia of the whole
# system, the node hardly moves.
_MOVES = 2.0


class DamperAsked(NamedTuple):
    """Damper to size.

    Attributes:
        kind: Kind of damper: viscous, rubber or pendulum; None: no damper.
        node: Name of the node that carries the damper; None: the default of `_find_carrier`.
        inertia: Inertia of ring or pendulums, kg m2; None: the inertia of the file's damper on that
            node, or a usual share of the equivalent inertia of the damped mode at the node.
    """

    kind: str | None = None
    node: str | None = None
    inertia: float | None = None


@dataclass(frozen=True, kw_only=True)
class SizedDamper:
    """Sized damper, and the largest stress (or torque) without and with it.

    Attributes:
        node: Name of the node that carries the damper.
        kind: Kind of damper.
        inertia_kg_m2: Moment of inertia of the ring.
        damping_Nms_per_rad: Damping of the oil film.
        stiffness_Nm_per_rad: Stiffness of the rubber.
        loss: Loss factor of the rubber.
        mass_kg: Mass of all pendulums.
        radius_m: Distance of the pivots of pendulums from the axis.
        length_m: Length of a pendulum.
        mode: Number of the mode that the damper is tuned to.
        before_Pa: Largest stress without a damper on the node; null if this stress has no bound.
        after_Pa: Largest stress with the damper.
        before_Nm: Largest torque without a damper on the node, if no shaft has a diameter; null if
            this torque has no bound.
        after_Nm: Largest torque with the damper, if no shaft has a diameter.
        heat_W: Largest power that the damper dissipates.
        heat_rpm: Speed at which the damper dissipates this power.
        doubts: Warnings of unlikely figures; left out if there are none.
        damper: Damper in the units of a file.
        start: Value of the sized figure (damping, stiffness or length) at which the search began,
            in the file's unit.
        measure: Minimised quantity: stress, or torque if no shaft has a diameter.
        before: Largest stress (Pa) or torque (N m) without a damper on the node; inf: no bound.
        after: Largest stress (Pa) or torque (N m) with the damper.
    """

    node: str
    kind: str
    inertia_kg_m2: float | None = None
    damping_Nms_per_rad: float | None = None
    stiffness_Nm_per_rad: float | None = None
    loss: float | None = None
    mass_kg: float | None = None
    radius_m: float | None = None
    length_m: float | None = None
    mode: int
    before_Pa: float | None = None
    after_Pa: float | None = None
    before_Nm: float | None = None
    after_Nm: float | None = None
    heat_W: float = 0.0  # replaced once the whole system is computed
    heat_rpm: float
    doubts: tuple[str, ...] | None = None
    damper: Annotated[Damper, HIDDEN]
    start: Annotated[float, HIDDEN]
    measure: Annotated[str, HIDDEN]
    before: Annotated[float, HIDDEN]
    after: Annotated[float, HIDDEN]


def size_damper(
    source: Source, asked: DamperAsked, speeds: Real, tell: Tell = tell_nobody
) -> SizedDamper:
    """Return the damper that minimises the largest stress of all shafts over a range of speeds.

    Args:
        source: File of the chain or engine.
        asked: Damper to size.
        speeds: Rising speeds, rpm, shape (speeds,).
        tell: Function that is called with the share of the work done so far.

    Raises:
        BalcliError: No node can carry the damper, or the system has no excitation.
    """
    node = _find_carrier(source, asked, speeds)
    own = source.dampers[node]
    bare = source.system({node: None})
    place = bare.nodes.index(node)
    target = _find_mode_to_damp(bare, speeds, place)
    own = own if own is not None and own.kind == asked.kind else None
    radius = None if source.engine is None else float(source.engine.throw_radii_m[0])
    first = _propose(asked, own, bare, place, target, radius)
    figure = FIGURES[first.kind]
    width = math.log(_WIDTH[first.kind])
    start = float(getattr(first, figure))
    tried = count(1)
    free = first.kind == "pendulum" and asked.inertia is None
    if free:
        first = _limit_swing(source, speeds, node, first, float(bare.chain.inertia[place]))

    def judge(damper: Damper) -> float:
        """Return the largest stress or torque with a damper; inf if this has no bound, or if
        pendulums swing too far and their inertia was not requested.
        """
        tell(min(next(tried) / _RESPONSES, 1.0))
        if free and _find_pendulum_swing(source, node, damper, speeds) > WIDE_SWING:
            return math.inf
        try:
            return _find_hardest(source.system({node: damper}), speeds)[2]
        except BalcliError:
            return math.inf

    farther = _minimise(
        lambda each: judge(first.model_copy(update={figure: start * math.exp(each)})), width
    )
    damper = first.model_copy(update={figure: float(f"{start * math.exp(farther):.6g}")})
    damper = min(damper, first, key=judge) if free else damper
    measure, unit = ("stress", "Pa") if any(bare.stress_by_torque) else ("torque", "Nm")
    before = target.largest
    after = judge(damper)
    tell(1.0)
    figures: dict[str, Any] = {f"before_{unit}": before, f"after_{unit}": after}
    for key, value in damper.model_dump(exclude={"kind"}, exclude_none=True).items():
        name, size, _ = DAMPER_KEYS[key]
        figures[name] = value / size
    sized = SizedDamper(
        node=node,
        kind=damper.kind,
        mode=target.mode.number,
        heat_rpm=float(speeds[0]),
        damper=damper,
        start=start,
        measure=measure,
        before=before,
        after=after,
        **figures,
    )
    doubts = _doubt(sized, bare, given=own is not None or asked.inertia is not None)
    return replace(sized, doubts=tuple(doubts) or None)


def _find_carrier(source: Source, asked: DamperAsked, speeds: Real) -> str:
    """Return the name of the node that is to carry the damper.

    By default, pendulums are placed on the node that has pendulums in the file, else on the throw
    with the largest amplitude in the mode to be damped. Other dampers are placed at the free end if
    it can carry one, else on the foremost part.
    """
    carriers = source.dampers
    if asked.node is not None:
        if asked.node not in carriers:
            raise ArgumentError(
                '{damper_at} "{node}": cannot carry a damper; choose from {carriers}',
                node=printable(asked.node),
                carriers=", ".join(map(printable, carriers)),
            )
        return asked.node
    system = source.system(NO_DAMPERS)
    if asked.kind == "pendulum" and source.throws:
        for name, own in carriers.items():
            if own is not None and own.kind == asked.kind:
                return name
        mode = _find_mode_to_damp(system, speeds, system.ends[0]).mode
        return max(source.throws, key=lambda throw: abs(mode.shape[system.nodes.index(throw)]))
    parts = [name for name in carriers if name not in source.throws]
    return system.free_end if system.free_end in parts or not parts else parts[0]


def _limit_swing(
    source: Source, speeds: Real, node: str, proposed: Damper, inertia: float
) -> Damper:
    """Return the proposed pendulums with a mass and a length at which they swing by at most
    WIDE_SWING; the length is within the searched range. The swing is about inversely proportional
    to the mass. `inertia` (kg m2) is the inertia of the node that carries the pendulums.

    Raises:
        ArgumentError: The pendulums would need more than half of the inertia of their node, and
            more mass than the proposed pendulums have.
    """
    start = proposed.swinging_length
    width = _WIDTH["pendulum"]
    mass = given = proposed.mass or 0.0
    lengths = [start, *np.geomspace(start / width, start * width, _PLACES).tolist()]
    reach = ((proposed.radius or 0.0) + start) / 1e3
    most = _MOST_PENDULUM * inertia / reach**2
    for _ in range(_MASSES):
        changes = [{"mass": float(f"{mass:.4g}"), "length": length} for length in lengths]
        tried = [proposed.model_copy(update=change) for change in changes]
        swings = [_find_pendulum_swing(source, node, each, speeds) for each in tried]
        least, proposed = min(zip(swings, tried, strict=True), key=itemgetter(0))
        if least <= WIDE_SWING:
            break
        mass *= _HEAVIER * min(least / WIDE_SWING, _MOST_AT_ONCE)
    if mass > max(most, given) or least > WIDE_SWING:
        raise ArgumentError(
            "{damper} pendulum: at {node}, pendulums need {mass:.3g} kg to swing by at most "
            "{wide:g} deg; with {most:.3g} kg they already have half of the inertia of the node; "
            "choose another place ({damper_at}) or give the inertia ({damper_inertia})",
            node=printable(node),
            mass=mass,
            wide=WIDE_SWING,
            most=most,
        )
    return proposed


def _find_pendulum_swing(source: Source, node: str, damper: Damper, speeds: Real) -> float:
    """Return the largest half swing, deg, of pendulums on a node; inf: no bound."""
    system = source.system({node: damper})
    number = [each.node for each in system.pendulums].index(system.nodes.index(node))
    try:
        _, largest = find_largest(system, speeds)
    except BalcliError:
        return math.inf
    return math.degrees(largest[len(system.shafts) + 1 + number])


def _find_hardest(system: TorsionalSystem, speeds: Real) -> tuple[int, float, float]:
    """Return the index of the shaft with the largest stress over a range of speeds, the speed (rpm)
    and the stress (Pa). If no shaft has a diameter, torque (N m) takes the place of stress. The
    shafts of rubber rings are ignored.

    Args:
        system: System with an excitation.
        speeds: Rising speeds, rpm, shape (speeds,).
    """
    rings = system.rubber_rings
    stress = system.stress_by_torque
    weights = (stress if any(stress) else np.ones(len(stress)))[: len(stress) - rings]
    rpm, value = find_largest(system, speeds, weights, together=True)
    worst = int(value.argmax())
    return worst, float(rpm[worst]), float(value[worst])


def _minimise(judge: Callable[[float], float], width: float) -> float:
    """Return the argument within [-width, width] at which a function is least, by a search in every
    valley of a coarse grid.
    """
    places = np.linspace(-width, width, _PLACES).tolist()
    values = np.array([judge(place) for place in places])
    around = np.concatenate([[np.inf], values, [np.inf]])
    bottoms = np.flatnonzero((values < around[:-2]) & (values <= around[2:])).tolist()
    minima = [
        find_least_smooth(judge, places[max(k - 1, 0)], places[min(k + 1, _PLACES - 1)])
        for k in bottoms
    ]
    if len(minima) == 1:
        return minima[0]
    return min(minima, key=judge, default=-width)


# ------------------------------------------------------------------ start of the search
class _Target(NamedTuple):
    """Mode that a damper should damp.

    Attributes:
        mode: The mode.
        order: Order that drives it.
        largest: Largest stress (Pa) or torque (N m) of the range of speeds without the damper; inf:
            it has no bound.
    """

    mode: NaturalMode
    order: float
    largest: float


def _find_mode_to_damp(system: TorsionalSystem, speeds: Real, node: int) -> _Target:
    """Return the mode that a damper on a node should damp.

    The largest stress of the range occurs in one shaft at one speed. The order with the largest
    torque in this shaft at this speed is returned. Of the modes in which the node moves, the mode
    whose frequency is nearest to the frequency of this order at this speed is returned. Selection
    by work would pick the mode of a soft coupling, which hardly twists the crankshaft.
    """
    modes = find_natural_modes(system)
    if not modes:
        raise ArgumentError("{damper}: the system has no mode that could be damped")
    try:
        worst, rpm, largest = _find_hardest(system, speeds)
    except BalcliError:  # nothing damps a resonance
        largest = math.inf
        loss = np.maximum(system.damping.loss, _LOSS)
        system = replace(system, damping=system.damping._replace(loss=loss))
        worst, rpm, _ = _find_hardest(system, speeds)
    phasors = compute_curves(system, np.array([rpm])).phasors
    by_order = np.abs(phasors[:, 0, worst])
    order = float(system.require_excitation().orders[by_order.argmax()])
    whole = float(np.sum(system.chain.inertia * (system.gears / system.gears[node]) ** 2))
    heavy = [_find_inertia_in(mode, system, node) for mode in modes]
    moving = [mode for mode, own in zip(modes, heavy, strict=True) if own <= _MOVES * whole]
    best = moving or [modes[int(np.argmin(heavy))]]
    nearest = min(best, key=lambda mode: abs(math.log(mode.omega / (order * rpm * RPM))))
    return _Target(nearest, order, largest)


def _find_inertia_in(mode: NaturalMode, system: TorsionalSystem, node: int) -> float:
    """Return the equivalent inertia of a mode at a node, kg m2; inf if the node is at rest."""
    moved = mode.shape[node] ** 2
    return float(np.sum(system.chain.inertia * mode.shape**2)) / moved if moved else math.inf


def _propose(
    asked: DamperAsked,
    own: Damper | None,
    system: TorsionalSystem,
    node: int,
    target: _Target,
    crank_radius: float | None,
) -> Damper:
    """Return a damper of the requested inertia with the optimal tuning for a system with one degree
    of freedom. The pivots of pendulums are at the radius of the file, else at the crank radius (m).

    Raises:
        ArgumentError: The node is at rest in the mode, the radius of pendulums is unknown, or the
            tuning is impossible.
    """
    mode = target.mode
    if mode.shape[node] == 0:
        raise ArgumentError(
            "{damper}: {node} does not move in mode {mode}",
            node=system.nodes[node],
            mode=mode.number,
        )
    kind = str(asked.kind)
    carried = _find_inertia_in(mode, system, node)
    given = {} if own is None else own.model_dump(exclude_none=True)
    usual = given["inertia"] / 1e6 if "inertia" in given else None
    inertia = asked.inertia or usual or float(f"{_SHARE[kind] * carried:.4g}")
    figures: dict[str, object] = {"kind": kind, "inertia": float(f"{inertia * 1e6:.12g}")}
    if kind == "viscous":
        figures["damping"] = best_viscous_damping(inertia, inertia / carried, mode.omega)
    elif kind == "rubber":
        figures["stiffness"] = inertia * (mode.omega / (1 + inertia / carried)) ** 2
        figures["loss"] = given.get("loss", RUBBER_LOSS)
    else:
        radius = given["radius"] / 1e3 if "radius" in given else crank_radius
        if radius is None:
            raise ArgumentError(
                "{damper} pendulum: a chain has no crank radius; give the node a damper = "
                "{example}",
                example='{ kind = "pendulum", mass = 2, radius = 60, length = 5 }',
            )
        length = radius * (system.gears[node] / target.order) ** 2
        mass = float(f"{inertia / (radius + length) ** 2:.4g}")
        if asked.inertia is None:
            mass = given.get("mass", mass)
        figures = {"kind": kind, "mass": mass, "radius": radius * 1e3, "length": length * 1e3}
    try:
        return Damper.model_validate(figures)
    except ValidationError:
        raise ArgumentError(
            "{damper} {kind}: the best damper is impossible; check the units of inertias and "
            "stiffnesses",
            kind=kind,
        ) from None


# ------------------------------------------------------------------ doubts
def _doubt(damper: SizedDamper, bare: TorsionalSystem, *, given: bool) -> Iterator[str]:
    """Yield warnings of unlikely figures of a damper; `given`: whether its inertia was requested or
    is that of a damper in the file.
    """
    node = printable(damper.node)
    inertia = damper.inertia_kg_m2
    if inertia is None:  # pendulums, about the axis
        inertia = (damper.mass_kg or 0.0) * (
            (damper.radius_m or 0.0) + (damper.length_m or 0.0)
        ) ** 2
    carrier = float(bare.chain.inertia[bare.nodes.index(damper.node)])
    whole = float(np.sum(bare.chain.inertia))
    width = _WIDTH[damper.kind]
    sized = float(getattr(damper.damper, FIGURES[damper.kind]))
    if damper.after > _HARDLY * damper.before:
        does = "raises" if damper.after > damper.before else "hardly lowers"
        yield Message(
            "a {kind} damper of {inertia:.4g} kg m2 at {node} {does} the largest {measure}; the "
            "whole system has {whole:.4g} kg m2; check {damper_at} and {damper_inertia}",
            kind=damper.kind,
            inertia=inertia,
            node=node,
            does=does,
            measure=damper.measure,
            whole=whole,
        )
    elif inertia > (whole if given else _HEAVY * carrier) > 0:
        smaller = float(f"{carrier or whole / _HEAVY:.2g}")
        yield Message(
            "the damper has {inertia:.4g} kg m2, its node {node} {carrier:.4g} and the whole "
            "system {whole:.4g} kg m2: choose a smaller damper, such as {damper_inertia} "
            '"{smaller:.12g} kg m^2"',
            inertia=inertia,
            node=node,
            carrier=carrier,
            whole=whole,
            smaller=smaller,
        )
    elif abs(math.log(sized / damper.start)) > _END * math.log(width):
        ends = f"{1 / width:.2g} to {width:g} times the optimum for mode {damper.mode} alone"
        yield f"the best {FIGURES[damper.kind]} is at an end of the searched range, {ends}"


def insert_damper(text: bytes, name: str, damper: Damper) -> str:
    """Return the text of a chain or engine file with this damper on one of its nodes.

    Args:
        text: Text of the file, UTF-8.
        name: Name of the node, part or throw.
        damper: New damper, in place of an older one.
    """
    old = text.decode("utf-8-sig")
    data = tomllib.loads(old)
    torsion = data.get("torsion", {})
    keys = damper.model_dump(exclude_none=True)
    lists = {f"torsion.{key}": torsion.get(key, ()) for key in ("front", "rear", "throw")}
    for key, tables in (lists | {"node": data.get("node", ())}).items():
        for number, table in enumerate(tables, 1):
            own = name_throw(table["throw"]) if key == "torsion.throw" else table.get("name")
            if own == name:
                return set_keys(old, f"{key}.{number}", {"damper": keys}, "by balcli")
    table = f"throw = {name.split()[-1]}\ndamper = {format_value(keys)}\n"
    return f"{old.rstrip()}\n\n[[torsion.throw]]    # by balcli\n{table}"
