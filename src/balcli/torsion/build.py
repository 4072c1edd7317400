"""Nodes and shafts, as chain files and engine files describe them -> torsional system with its
dampers fitted.

A chain file -> torsional system in SI units; joints that contradict each other are reported by
their paths.

[torsion] of an engine file and the engine -> torsional system: a node for each throw, with the
mean inertia of the parts that move with it, and one for each part in front and behind.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.loads import find_inertia, find_needed_series
from ..core.mechanisms.closed_form import select_cylinders
from ..core.phases import RPM
from ..core.vibration import Real
from ..engine.engine import Engine
from ..errors import InputError, Problem
from ..file.fields import counted, join_words, printable, shorten, suggest_nearest
from ..file.model import EngineFile
from ..file.plain_tables import STEADY
from ..file.torsion_tables import (
    STEEL,
    Damper,
    Part,
    ShaftKeys,
    Torsion,
    find_shaft_inertia,
    find_stiffness,
)
from ..forces.spectrum import compute_spectra, list_gas_orders
from ..limits import HIGHEST_TORSION_ORDER_UNASKED
from .chain import (
    SAME_RATIO,
    Chain,
    ChainShaft,
    Damping,
    find_pieces,
    find_still,
    join_chain,
    rigid_motions,
    trace_shafts,
)
from .system import Excitation, Pendulums, ShaftSection, TorsionalSystem, ViscousRing
from .tables import ChainFile, ChainShaft as ShaftTable, Gear

NO_DAMPERS: Mapping[str, Damper | None] = MappingProxyType({})
_LIGHT = 0.05  # of the smaller neighbor: an inertia of a shaft that nobody misses
_MOST_NAMED = 4  # shafts, in a message


class PlannedNode(NamedTuple):
    """A node: inertia in kg m2, damping in N m s/rad against ground, and the damper it has."""

    name: str
    inertia: float
    damping: float = 0.0
    damper: Damper | None = None


class PlannedShaft(NamedTuple):
    """A shaft between two nodes, with its loss factor, dashpot (N m s/rad), diameters and inertia
    (kg m2). `lost`: its inertia as of steel, left out because the file gives no density.
    """

    name: str
    shaft: ChainShaft
    loss: float = 0.0
    dashpot: float = 0.0
    section: ShaftSection | None = None
    inertia: float = 0.0
    lost: float = 0.0


def _plan_shaft(name: str, table: ShaftKeys, joined: ChainShaft, loss: float) -> PlannedShaft:
    """Return a shaft of a file.

    Args:
        name: Its name.
        table: Its table in the file.
        joined: Its ends and ratio.
        loss: Loss factor of shafts without one.
    """
    own, section = table.loss, find_section(table.diameter, table.bore)
    lost = find_shaft_inertia(table, STEEL) if table.density is None else 0.0
    return PlannedShaft(
        name,
        joined._replace(stiffness=find_stiffness(table)),
        loss if own is None else own,
        table.damping,
        section,
        find_shaft_inertia(table, table.density),
        lost,
    )


def _load_nodes(nodes: Sequence[PlannedNode], shafts: Sequence[PlannedShaft]) -> list[PlannedNode]:
    """Return the nodes with half of the inertia of every shaft on either end."""
    found = list(nodes)
    for each in shafts:
        for end, ratio in ((each.shaft.start, each.shaft.ratio), (each.shaft.end, 1.0)):
            more = each.inertia / 2 * ratio**2
            found[end] = found[end]._replace(inertia=found[end].inertia + more)
    return found


def _doubt_light_shafts(
    nodes: Sequence[PlannedNode], shafts: Sequence[PlannedShaft], clamped: Sequence[int]
) -> Iterator[str]:
    """Yield a warning of plain shafts without a density whose inertia would count."""
    heavy = []
    for each in shafts:
        start, end = (
            math.inf if k in clamped else nodes[k].inertia
            for k in (each.shaft.start, each.shaft.end)
        )
        if each.lost > _LIGHT * min(start / each.shaft.ratio**2, end):
            heavy.append(each)
    if heavy:
        names = [shorten(each.name) for each in heavy[:_MOST_NAMED]] + ["..."] * (
            len(heavy) > _MOST_NAMED
        )
        yield (
            f"{counted(len(heavy), 'plain shaft')} without a density ({', '.join(names)}): their "
            f"inertia, {sum(each.lost for each in heavy):.4g} kg m2 in steel, is left out; give "
            f"density = {STEEL} (g/cm3), which puts half of it at either end"
        )


def assemble_system(
    nodes: Sequence[PlannedNode],
    shafts: Sequence[PlannedShaft],
    limits: tuple[float | None, float | None],
    clamped: Sequence[int] = (),
    fitted: Mapping[str, Damper | None] = NO_DAMPERS,
    **others: Any,
) -> TorsionalSystem:
    """Return the system; its rubber rings are nodes and shafts after all others.

    Args:
        nodes: Front to rear, with the inertia of their shafts.
        shafts: Between them.
        limits: Stress (N/mm2) and half swing of the free end (deg) above which a speed is barred;
            None: no limit.
        clamped: Nodes that are held.
        fitted: Dampers by the name of their node, in place of those that nodes have.
        others: Further attributes of the system.
    """
    every, joined, rings, pendulums = list(nodes), list(shafts), [], []
    for k, node in enumerate(nodes):
        damper = fitted.get(node.name, node.damper)
        if damper is None:
            continue
        inertia = (damper.inertia or 0.0) / 1e6
        if damper.kind == "rubber":
            name, rubber = f"{node.name} ring", ChainShaft(k, len(every), damper.stiffness or 0.0)
            every.append(PlannedNode(name, inertia))
            joined.append(PlannedShaft(name, rubber, damper.loss or 0.0))
        elif damper.kind == "viscous":
            rings.append(ViscousRing(k, inertia, damper.damping or 0.0))
        else:
            radius, length = (damper.radius or 0.0) / 1e3, (damper.length or 0.0) / 1e3
            pendulums.append(Pendulums(k, damper.mass or 0.0, radius, length))
    stress, angle = limits
    return TorsionalSystem(
        nodes=tuple(node.name for node in every),
        shafts=tuple(each.name for each in joined),
        chain=join_chain(
            [node.inertia for node in every], [each.shaft for each in joined], clamped
        ),
        damping=Damping(
            np.array([each.loss for each in joined]),
            np.array([each.dashpot for each in joined]),
            np.array([node.damping for node in every]),
        ),
        sections=tuple(each.section for each in joined),
        rings=tuple(rings),
        pendulums=tuple(pendulums),
        limit_pa=None if stress is None else stress * 1e6,
        angle_limit=None if angle is None else float(np.radians(angle)),
        last=len(nodes) - 1,
        doubts=tuple(_doubt_light_shafts(nodes, shafts, clamped)),
        **others,
    )


def find_section(diameter: float | None, bore: float | None) -> ShaftSection | None:
    """Return a section in m, from a diameter and a bore in mm, where they are given."""
    return None if diameter is None else ShaftSection(diameter / 1e3, (bore or 0.0) / 1e3)


def build_chain(
    file: ChainFile, name: str = "", fitted: Mapping[str, Damper | None] = NO_DAMPERS
) -> TorsionalSystem:
    """Return the system of a chain file.

    Args:
        file: Tables of the file.
        name: Name of the file, for messages.
        fitted: Dampers of some nodes in place of those in the file.

    Raises:
        InputError: nodes without a shaft, gears that lock each other, no node that can turn.
    """
    index = {node.name: k for k, node in enumerate(file.node)}
    nodes = [
        PlannedNode(node.name, (node.inertia or 0.0) / 1e6, node.damping, node.damper)
        for node in file.node
    ]
    tables: list[ShaftTable | Gear] = [*file.shaft, *file.gear]
    shafts = []
    for label, each in zip(
        _tell_apart([f"{each.from_}-{each.to}" for each in tables]), tables, strict=True
    ):
        start, end = index[each.from_], index[each.to]
        if isinstance(each, Gear):
            shafts.append(PlannedShaft(label, ChainShaft(start, end, np.inf, each.ratio)))
            continue
        shafts.append(_plan_shaft(label, each, ChainShaft(start, end, 0.0), file.loss))
    nodes = _load_nodes(nodes, shafts)
    clamped = [index[each] for each in file.fixed]
    paths = [f"shaft.{k}" for k, _ in enumerate(file.shaft, 1)]
    paths += [f"gear.{k}" for k, _ in enumerate(file.gear, 1)]
    limited = file.angle_limit is not None
    if problems := list(_find_faults(nodes, shafts, paths, clamped, limited)):
        raise InputError(problems, name)
    limits, excitation = (file.limit, file.angle_limit), _excite(file, index)
    return assemble_system(
        nodes,
        shafts,
        limits,
        clamped,
        fitted,
        name=file.name or "",
        ends=(0, len(nodes) - 1),
        excitation=excitation,
        assumed=tuple(
            {
                f"shaft.shear_modulus = {s.shear_modulus:g}"
                for s in file.shaft
                if s.is_of_unnamed_steel
            }
        ),
        file=name,
    )


def _tell_apart(names: Sequence[str]) -> Iterator[str]:
    """Return the names, repeated ones with a number: `a-b`, `a-b (2)`."""
    for k, name in enumerate(names):
        before = names[:k].count(name)
        yield f"{name} ({before + 1})" if before else name


def _excite(file: ChainFile, index: dict[str, int]) -> Excitation | None:
    if not file.excitation:
        return None
    orders = np.unique(np.array([each.order for each in file.excitation]))
    sources = sorted({index[each.node] for each in file.excitation})
    steady = np.zeros((len(orders), len(sources)), complex)
    for each in file.excitation:
        row, column = int(np.searchsorted(orders, each.order)), sources.index(index[each.node])
        steady[row, column] += complex(each.cos, -each.sin)
    return Excitation(orders, np.array(sources), steady, np.zeros_like(steady))


def _find_faults(
    nodes: Sequence[PlannedNode],
    shafts: Sequence[PlannedShaft],
    paths: Sequence[str],
    clamped: Sequence[int],
    limited: bool,
) -> Iterator[Problem]:
    """Yield mistakes in how nodes are joined. `paths` are those of shafts and gears in the file;
    `limited` is whether the angle of the first node has a limit.
    """
    names = [node.name for node in nodes]
    inertia = [node.inertia for node in nodes]
    chain = join_chain(inertia, [each.shaft for each in shafts], clamped)
    apart = np.unique(find_pieces(chain).first)[1:].tolist()
    for node in apart:
        text = f"{shorten(names[node])} hangs on nothing that hangs on {shorten(names[0])}"
        yield Problem(f"node.{node + 1}", f"{text}; join them by a [[shaft]] or a [[gear]]")
    if locked := list(_find_contradiction(chain, paths, np.isinf(chain.stiffness))):
        yield from locked
        return
    still = find_still(chain)
    if np.all(still):
        yield Problem("fixed", "clamps every node; leave one free")
        return
    yield from _find_loops(chain, paths)
    if limited and still[0]:
        how = "is fixed" if chain.clamped[0] else "meshes with a fixed node"
        text = f"is of the first node, and {shorten(names[0])} {how}; leave it out, or begin with"
        yield Problem("angle_limit", f"{text} the node that may swing so far")
    ringed = [n.damper is not None and n.damper.kind == "rubber" for n in nodes]
    heavy, free = (chain.inertia > 0) | np.array(ringed), ~still
    pieces = [motion != 0 for motion in rigid_motions(chain)] or [free]
    for piece in [] if apart else pieces:
        if not np.any(heavy[piece]):
            node = int(np.argmax(piece))
            yield Problem.of_missing(f"node.{node + 1}.inertia", "nothing that turns has any")


def _find_loops(chain: Chain, paths: Sequence[str]) -> Iterator[Problem]:
    """Yield loops of meshes alone, whose torques are undetermined, and loops of shafts with a ratio
    that would wind them up without end.
    """
    group = np.where(chain.clamped, -1, np.arange(len(chain.inertia)))
    joining = np.zeros(len(chain.start), bool)
    for mesh in np.flatnonzero(np.isinf(chain.stiffness)).tolist():
        start, end = int(chain.start[mesh]), int(chain.end[mesh])
        if group[start] != group[end]:
            group[group == group[end]], joining[mesh] = group[start], True
            continue
        way, held = trace_shafts(chain, [start], end, joining), np.flatnonzero(chain.clamped)
        named = [paths[each] for each in way]
        if not way:
            ways = (trace_shafts(chain, held.tolist(), node, joining) for node in (start, end))
            named = [*(paths[each] for way in ways for each in way), "the fixed nodes"]
        hint = "nothing says how they share the torque; leave it out, or give a stiffness"
        yield Problem(
            paths[mesh], f"closes a loop of gears and rigid shafts with {join_words(named)}: {hint}"
        )
    if not np.any(chain.clamped):
        yield from _find_contradiction(chain, paths, np.ones(len(chain.start), bool))


def _find_contradiction(
    chain: Chain, paths: Sequence[str], joining: NDArray[np.bool_]
) -> Iterator[Problem]:
    """Yield the first of these shafts (shafts,) that closes a loop with contradictory ratios, and
    its partners: gears alone would lock, a turning chain would wind up its shafts.
    """
    pieces = find_pieces(chain, joining)
    found = pieces.pace[chain.end] / pieces.pace[chain.start]
    torn = joining & (np.abs(found - chain.ratio) > SAME_RATIO * np.abs(found))
    for shaft in np.flatnonzero(torn)[:1].tolist():
        ends = [int(chain.start[shaft])], int(chain.end[shaft])
        named = join_words([paths[k] for k in trace_shafts(chain, *ends, joining & ~torn)])
        yield Problem(
            paths[shaft],
            f"closes a loop with {named}, and the ratios contradict each other: "
            f"{chain.ratio[shaft]:.9g} here, {found[shaft]:.9g} by the others; give ratios with "
            "all digits, or leave one out",
        )


class _Joint(NamedTuple):
    """A part, and the name of the node that it is joined to; `path` is its place in the file."""

    path: str
    part: Part
    of: str


def build_engine_system(
    model: EngineFile,
    engine: Engine,
    excitation: Excitation,
    name: str = "",
    fitted: Mapping[str, Damper | None] = NO_DAMPERS,
) -> TorsionalSystem:
    """Return the system of an engine.

    Args:
        model: Its file, which has [torsion].
        engine: Of this file.
        excitation: Torques of its cylinders, from `excite_engine`.
        name: Name of the file, for messages.
        fitted: Dampers of some parts in place of those in the file.

    Raises:
        InputError: contradictions in [torsion], by their paths.
    """
    torsion = model.torsion
    if torsion is None:
        hint = "write [torsion] with throw_stiffness and throw_inertia, and [[torsion.rear]]"
        raise InputError([Problem.of_missing("torsion", hint)], name)
    throws = _name_throws(engine)
    if problems := list(_find_misfits(torsion, model, engine, throws)):
        raise InputError(problems, name)
    nodes = [
        *map(_plan_part, reversed(torsion.front)),
        *_plan_throws(torsion, engine, throws),
        *map(_plan_part, torsion.rear),
    ]
    front, joints = len(torsion.front), _join_parts(torsion, len(throws))
    place, gears = {node.name: k for k, node in enumerate(nodes)}, _find_gears(joints, throws)
    leading = []  # shaft of every part from what it hangs on, stiff in its own speed
    for _, part, of in joints:
        ratio = gears[part.name] / gears[of]
        joined = ChainShaft(place[of], place[part.name], 0.0, ratio)
        leading.append(_plan_shaft(part.name, part, joined, torsion.loss))
    section = find_section(torsion.throw_diameter, torsion.throw_bore)
    stiffness = _each(torsion.throw_stiffness or (), len(throws) - 1)
    between = [
        PlannedShaft(label, ChainShaft(front + k, front + k + 1, each), torsion.loss, 0.0, section)
        for k, (label, each) in enumerate(zip(_name_between(throws), stiffness, strict=True))
    ]
    shafts = [*reversed(leading[:front]), *between, *leading[front:]]
    foremost = find_free_end(torsion, len(throws))
    own_speed = "speed" in model.operation.model_fields_set
    return assemble_system(
        _load_nodes(nodes, shafts),
        shafts,
        (torsion.limit, torsion.angle_limit),
        fitted=fitted,
        name=engine.name,
        excitation=excitation,
        rated_rpm=model.operation.speed if own_speed else None,
        reference=front,
        ends=(place[foremost], place[_find_end(joints[front:], gears, throws[-1])]),
        silent=engine.silent,
        assumed=engine.list_assumed("gas", "torsion", without=(*STEADY, "operation.speed")) or (),
        file=name,
    )


def _plan_part(part: Part) -> PlannedNode:
    return PlannedNode(part.name, (part.inertia or 0.0) / 1e6, part.node_damping, part.damper)


def _plan_throws(torsion: Torsion, engine: Engine, throws: Sequence[str]) -> Iterator[PlannedNode]:
    """Yield a node for each throw, with its running gear and the damping of every cylinder."""
    gear, on_throw = weigh_running_gear(engine), engine.joined_throw_of_rows
    bare = _weigh_throws(torsion, engine)
    for throw, name in enumerate(throws):
        here = np.equal(on_throw, throw)
        inertia = bare[throw] + float(gear[here].sum())
        yield PlannedNode(name, inertia, torsion.damping * int(here.sum()))


def _name_throws(engine: Engine) -> list[str]:
    """Return the names of the nodes of throws, front to rear."""
    return [f"throw {k}" for k, _ in enumerate(engine.joined_throws, 1)]


def _name_between(throws: Sequence[str]) -> list[str]:
    return [f"throw {k}-{k + 1}" for k in range(1, len(throws))]


def _each(values: Sequence[float], count: int) -> list[float]:
    """Return one value for each of so many, from one for all or a list."""
    return list(values) * count if len(values) == 1 else list(values)


def _join_parts(torsion: Torsion, throws: int) -> list[_Joint]:
    """Return all parts with the nodes that they are joined to: front first, each list outward."""
    found = []
    for key, parts, before in (
        ("front", torsion.front, "throw 1"),
        ("rear", torsion.rear, f"throw {throws}"),
    ):
        for k, part in enumerate(parts, 1):
            found.append(_Joint(f"torsion.{key}.{k}", part, part.of or before))
            before = part.name
    return found


def _find_gears(joints: Sequence[_Joint], throws: Sequence[str]) -> dict[str, float]:
    """Return the speed over crank speed of every node that is joined to the crank, by name."""
    gears = dict.fromkeys(throws, 1.0)
    for _ in joints:  # a part may hang on one that comes later in the file
        before = len(gears)
        for _, part, of in joints:
            if of in gears:
                gears[part.name] = gears[of] if part.gear is None else part.gear
        if len(gears) == before:
            break
    return gears


def find_free_end(torsion: Torsion, throws: int) -> str:
    """Return the name of the foremost part, at the end of the main line (parts on gears are
    branches), or of the first throw if there is none.
    """
    names = [f"throw {k}" for k in range(1, throws + 1)]
    joints = _join_parts(torsion, throws)
    return _find_end(joints[: len(torsion.front)], _find_gears(joints, names), names[0])


def _find_end(joints: Sequence[_Joint], gears: Mapping[str, float], start: str) -> str:
    """Return the name of the node at crank speed with the most shafts between it and a start; of
    equals the one with the largest inertia. The order of the joints does not count.
    """
    steps = {start: (0, 0.0, start)}
    own = [joint for joint in joints if abs(gears[joint.part.name] - 1) <= SAME_RATIO]
    for _ in own:
        for _, part, of in own:
            if of in steps and part.name not in steps:
                steps[part.name] = (steps[of][0] + 1, part.inertia or 0.0, part.name)
    return max(steps.values())[2]


# ------------------------------------------------------------------ inertia and excitation
def weigh_running_gear(engine: Engine) -> Real:
    """Return the mean moment of inertia of each cylinder's running gear without the throw, kg m2,
    shape (cylinders,): `m_rot r^2 + mean(m_rec s'^2 - H beta'^2)`.
    """
    c = engine.cylinders
    mean_only = np.zeros(1)
    series = find_needed_series(c, {"torque"}, uneven=False)
    few, which = c.find_distinct_harmonics(mean_only, series)
    moving = find_inertia(c, select_cylinders(few, which), 1.0).c[0].real
    own = np.array([float(weighed.share) for weighed in engine.weighed])
    turning = (c.rotating - own) * c.radius**2
    return np.broadcast_to(moving, own.shape) + np.broadcast_to(turning, own.shape)


def _weigh_throws(torsion: Torsion, engine: Engine) -> Sequence[float]:
    """Return the moment of inertia of the crankshaft at each throw, kg m2, front to rear: the sum
    of those of the file's throws that are one.
    """
    joined, throws = engine.joined_throws, len(engine.throws_m)
    whole = 0.0 if engine.crank_inertia is None else float(engine.crank_inertia)
    given = torsion.throw_inertia or [whole * 1e6 / throws]
    if len(given) == len(joined) < throws:  # already those of the throws of the crank
        return [each / 1e6 for each in given]
    by_throw = _each(given, throws)
    return [sum(by_throw[throw] for throw in together) / 1e6 for together in joined]


def excite_engine(model: EngineFile, engine: Engine, orders: Real | None) -> Excitation:
    """Return the torque of every cylinder on the node of its throw, of inertia and of gas if the
    engine has gas.

    Args:
        orders: Orders, shape (orders,); None: orders to HIGHEST_TORSION_ORDER_UNASKED, with halves
            where gas has them, and the firing orders of `list_gas_orders`.
    """
    front = 0 if model.torsion is None else len(model.torsion.front)
    nodes = front + np.array(engine.joined_throw_of_rows)
    engine = replace(engine, ripple=(), speed_rpm=1 / RPM)  # 1 rad/s
    if orders is None:
        step = 1.0 if engine.gas is None else 2 / engine.strokes
        usual = np.arange(step, HIGHEST_TORSION_ORDER_UNASKED + step, step)
        orders = np.union1d(usual, list_gas_orders(engine))
    growing = compute_spectra(engine, orders, ("torque",), each=True)["torque"].x
    steady = np.zeros_like(growing)
    if engine.gas is not None:
        steady = compute_spectra(engine, orders, ("gas",), each=True)["gas"].x
    moves = np.any((growing != 0) | (steady != 0), axis=1)
    return Excitation(orders[moves], nodes, steady[moves], growing[moves])


# ------------------------------------------------------------------ what does not fit together
def _find_misfits(
    torsion: Torsion, model: EngineFile, engine: Engine, throws: Sequence[str]
) -> Iterator[Problem]:
    if engine.rotary:
        yield Problem("torsion", "needs a crankshaft that turns; that of a rotary engine does not")
        return
    yield from _check_throws(torsion, model, len(throws), len(engine.throws_m))
    joints = _join_parts(torsion, len(throws))
    names = [*throws, *(joint.part.name for joint in joints)]
    reserved = {*throws, *_name_between(throws)}
    led = _find_gears([j if j.of in names else j._replace(of=throws[0]) for j in joints], throws)
    for k, (path, part, of) in enumerate(joints, len(throws)):
        if part.name in reserved:
            yield Problem(f"{path}.name", f"{shorten(part.name)} is a name that throws have")
        elif part.name in names[:k]:
            yield Problem(f"{path}.name", f"{shorten(part.name)} is there twice; give each its own")
        if of not in names:
            listed = ", ".join(printable(each) for each in names[:8])
            hint = suggest_nearest(of, names, f"there are {listed}")
            yield Problem(f"{path}.of", f"{shorten(of)} is no part; {hint}")
        elif part.name not in led:
            text = f"{shorten(of)} is not connected to the crankshaft; name a part that is"
            yield Problem(f"{path}.of", text)


def _check_throws(
    torsion: Torsion, model: EngineFile, throws: int, in_file: int
) -> Iterator[Problem]:
    """Check the keys of throws; `in_file`: as many as the file has, before some are one."""
    places = throws - 1
    if torsion.throw_stiffness is None and places:
        hint = f"give that between neighbours of {counted(throws, 'throw')}, such as "
        yield Problem.of_missing("torsion.throw_stiffness", f"{hint}throw_stiffness = 1.25e6")
    counts = {"throw_stiffness": (places, places), "throw_inertia": (throws, in_file)}
    for key, (count, also) in counts.items():
        values = getattr(torsion, key)
        if values is not None and len(values) not in (1, count, also):
            yield Problem(
                f"torsion.{key}",
                f"has {counted(len(values), 'value')}, but {counted(throws, 'throw')} need "
                f"{count}; give one for all, or a list of these",
            )
    if torsion.throw_inertia is None and model.crank.inertia is None:
        hint = "give it, such as throw_inertia = 46700, or inertia of the whole [crank]"
        yield Problem.of_missing("torsion.throw_inertia", hint)
