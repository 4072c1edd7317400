"""Build a torsional system, with its dampers, from a chain file or from [torsion] of an engine
file.

For a chain file, nodes and shafts are converted to SI units, and joints that contradict each other
are reported by their paths.

For an engine, each throw is a node with the mean inertia of the parts that move with it, and each
part in front or behind is another node.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.loads import find_inertia, find_needed_series
from ..core.mechanisms.closed_form import select_cylinders
from ..core.phases import RPM
from ..core.vibration import Complex, Real
from ..engine.engine import Engine, SilentCylinders
from ..errors import BalcliError, InputError, Problem
from ..file.assumed import STEADY, Assumed, assume
from ..file.doubt import Doubt
from ..file.fields import counted, limit_digits, shorten
from ..file.model import EngineFile
from ..file.torsion_tables import (
    MEAN,
    STEEL,
    ChainKeys,
    Damper,
    NodeKeys,
    Part,
    ShaftKeys,
    StressLimit,
    Torsion,
    find_shaft_inertia,
    find_stiffness,
)
from ..file.units import ask_unit
from ..forces.crankshaft import find_shear_stress
from ..forces.spectrum import compute_spectra, follow_gas, list_gas_orders
from ..limits import HIGHEST_TORSION_ORDER_UNASKED
from . import node_torques
from .chain import (
    SAME_RATIO,
    Chain,
    ChainShaft,
    Damping,
    find_pieces,
    find_still,
    grow_branches,
    join_chain,
    rigid_motions,
)
from .chain_file import ChainFile, refuse_node
from .means import Link, MeanTorques, find_cylinder_means, share_out
from .permitted import LimitTable, ShaftLimit, list_limits
from .system import Excitation, Pendulums, TorsionalSystem, ViscousRing
from .throw_stiffness import (
    ThrowSize,
    ThrowStiffness,
    find_problems,
    find_throw_size,
    find_throw_stiffness,
    find_web_thickness,
)

NO_DAMPERS: Mapping[str, Damper | None] = MappingProxyType({})
_LIGHT = 0.05  # negligible inertia of a shaft, as a share of the smaller inertia at its ends
_TINY = 1e-4  # inertia of a part over that of a throw, below which its unit is doubted
_MOST_NAMED = 4  # largest number of shafts that a message names
_MESH = ShaftKeys.model_construct(stiffness=math.inf)


class PlannedNode(NamedTuple):
    """A node: its table in the units of the file, its damping against ground (N m s/rad), and the
    dampers that it carries besides the damper in its table.
    """

    table: NodeKeys
    damping: float = 0.0
    further: tuple[Damper, ...] = ()


class PlannedShaft(NamedTuple):
    """A shaft between two nodes, given by their indices, and its table in the units of the file.
    `ratio` is the speed of the shaft's end divided by the speed of its start; `path` is the dotted
    name of its stiffness in the file, empty if the file gives none.
    """

    name: str
    start: int
    end: int
    table: ShaftKeys
    ratio: float = 1.0
    path: str = ""


def assemble_system(
    planned: Sequence[PlannedNode],
    joining: Sequence[PlannedShaft],
    keys: ChainKeys,
    clamped: Sequence[int] = (),
    fitted: Mapping[str, Damper | None] = NO_DAMPERS,
    means: MeanTorques | None = None,
    **others: Any,
) -> TorsionalSystem:
    """Return the system of these nodes and shafts. Each rubber ring becomes a node and a shaft,
    listed after all others. Half of the inertia of a shaft is added to the node at each end.

    Args:
        planned: Nodes, front to rear.
        joining: Shafts between these nodes.
        keys: Default loss of shafts, and limits of stress and angle.
        clamped: Indices of the nodes that are held.
        fitted: Dampers by the name of their node; each replaces the first damper of the node, and
            None removes it.
        means: Mean torques of these shafts; None: they are not known.
        others: Further attributes of `TorsionalSystem`.
    """
    nodes = list(planned)
    shafts = list(joining)
    rings = []
    pendulums = []
    for k, damper in _place_dampers(planned, fitted):
        if damper.kind == "rubber":
            rubber = ShaftKeys.model_construct(stiffness=damper.stiffness, loss=damper.loss)
            name = f"{planned[k].table.name} ring"
            ring = NodeKeys.model_construct(name=name, inertia=damper.inertia)
            shafts.append(PlannedShaft(ring.name, k, len(nodes), rubber))
            nodes.append(PlannedNode(ring))
        elif damper.kind == "viscous":
            rings.append(ViscousRing(k, (damper.inertia or 0.0) / 1e6, damper.damping or 0.0))
        else:
            radius = (damper.radius or 0.0) / 1e3
            length = damper.swinging_length / 1e3
            pendulums.append(Pendulums(k, damper.mass or 0.0, radius, length))
    tables = [each.table for each in shafts]
    joints = [ChainShaft(s.start, s.end, find_stiffness(s.table), s.ratio) for s in shafts]
    chain = join_chain([(node.table.inertia or 0.0) / 1e6 for node in nodes], joints, clamped)
    halves = np.array([find_shaft_inertia(table, table.density) / 2 for table in tables])
    np.add.at(chain.inertia, chain.start, halves * chain.ratio**2)
    np.add.at(chain.inertia, chain.end, halves)
    stress_by_torque = np.array([*map(_find_stress, tables)])
    own = len(joining)  # rubber rings have no limits
    rated_rpm = others.get("rated_rpm")
    limits = list_limits(tables[:own], stress_by_torque[:own], keys, rated_rpm, means)
    if keys.angle_limit is not None:
        permitted = LimitTable((1.0,), (math.radians(keys.angle_limit),))
        limits = *limits, ShaftLimit(len(shafts), "angle", 1.0, permitted)
    losses = (keys.loss if table.loss is None else table.loss for table in tables)
    return TorsionalSystem(
        nodes=tuple(node.table.name for node in nodes),
        shafts=tuple(each.name for each in shafts),
        chain=chain,
        damping=Damping(
            np.array([*losses]),
            np.array([table.damping for table in tables]),
            np.array([node.damping for node in nodes]),
        ),
        stress_by_torque=stress_by_torque,
        sections=tuple(map(_find_section, tables)),
        lengths=tuple((table.length or 0.0) / 1e3 for table in tables),
        limits=limits,
        unknown_stress=tuple(
            k
            for k, table in enumerate(tables[:own])
            if not stress_by_torque[k] and (table.limit or keys.limit) is not None
        ),
        rings=tuple(rings),
        pendulums=tuple(pendulums),
        means=None if means is None else means.extend(len(shafts)),
        angle_limit=None if keys.angle_limit is None else math.radians(keys.angle_limit),
        last=len(planned) - 1,
        doubts=(
            *_doubt_light_shafts(chain, shafts),
            *_doubt_stiffness(chain, shafts),
            *_doubt_pendulums(chain, pendulums, nodes),
        ),
        **others,
    )


def _place_dampers(
    planned: Sequence[PlannedNode], fitted: Mapping[str, Damper | None]
) -> Iterator[tuple[int, Damper]]:
    """Yield every damper together with the index of the node that carries it: (index, damper)."""
    for k, node in enumerate(planned):
        dampers = list(filter(None, (node.table.damper, *node.further)))
        if node.table.name in fitted:
            dampers[:1] = filter(None, [fitted[node.table.name]])
        yield from ((k, damper) for damper in dampers)


def _find_stress(table: ShaftKeys) -> float:
    """Return the shear stress at the surface of a shaft for 1 N m, Pa; 0 without a diameter."""
    outer, inner = _find_section(table)
    return find_shear_stress(outer, inner) if outer else 0.0


def _find_section(table: ShaftKeys) -> tuple[float, float]:
    """Return the outer and inner diameter of a shaft, m; 0 where they are not given."""
    return (table.diameter or 0.0) / 1e3, (table.bore or 0.0) / 1e3


def _doubt_light_shafts(chain: Chain, shafts: Sequence[PlannedShaft]) -> Iterator[Doubt]:
    """Yield a warning of plain shafts without a density if their inertia would matter."""
    lost = np.array([find_shaft_inertia(each.table, STEEL) for each in shafts])
    lost[[each.table.density is not None for each in shafts]] = 0
    ends = np.where(chain.clamped, np.inf, chain.inertia)
    near = np.minimum(ends[chain.start] / chain.ratio**2, ends[chain.end])
    if heavy := np.flatnonzero(lost > _LIGHT * near).tolist():
        named = [shorten(shafts[k].name) for k in heavy]
        if len(named) > _MOST_NAMED:
            named[_MOST_NAMED:] = ["..."]
        message = (
            f"{counted(len(heavy), 'plain shaft')} without a density ({', '.join(named)}): their "
            f"inertia, {lost[heavy].sum():.4g} kg m2 in steel, is left out; density = {STEEL} "
            "(g/cm3) adds half of the inertia to the node at each end"
        )
        yield Doubt("", message)


def _doubt_pendulums(
    chain: Chain, pendulums: Sequence[Pendulums], nodes: Sequence[PlannedNode]
) -> Iterator[Doubt]:
    """Yield a warning of pendulums with more inertia than all nodes together."""
    whole = float(chain.inertia.sum())
    for pendulum in pendulums:
        inertia = pendulum.mass * (pendulum.radius + pendulum.length) ** 2
        if inertia > whole:
            node = nodes[pendulum.node].table.name
            message = (
                f"the pendulums on {node} weigh {pendulum.mass:.4g} kg and have {inertia:.4g} kg "
                f"m2, more than all nodes together ({whole:.4g} kg m2); is their mass in kg, and "
                "their radius in mm?"
            )
            yield Doubt("", message)


# Usual stiffness of a shaft, as its natural frequency with both ends over that at which shear waves
# of steel cross the smaller end: rubber couplings have 0.001. Figures in other units lie outside.
_STIFFNESS = 3e-4, 2.0
_DENSITY = 7850.0  # of steel, kg/m3
_SHEAR_WAVE = 3200.0  # speed in steel, m/s


def _doubt_stiffness(chain: Chain, shafts: Sequence[PlannedShaft]) -> Iterator[Doubt]:
    """Yield a warning of the stiffness that fits the inertias at both ends of its shaft least."""
    ends = np.where(chain.clamped, np.inf, chain.inertia)
    before = ends[chain.start] / chain.ratio**2
    after = ends[chain.end]
    least, most = _STIFFNESS
    worst = 1.0
    doubt = None
    for shaft, stiffness, *inertias in zip(shafts, chain.stiffness, before, after, strict=True):
        smaller = min(inertias)
        if not shaft.path or not 0 < stiffness < math.inf or not 0 < smaller < math.inf:
            continue
        frequency = math.sqrt(stiffness * sum(1 / inertia for inertia in inertias))
        quickness = frequency * (smaller / _DENSITY) ** 0.2 / _SHEAR_WAVE
        beyond = max(least / quickness, quickness / most)
        if beyond > worst:
            worst = beyond
            size = "low" if quickness < least else "high"
            both = " and ".join(f"{inertia:.4g}" for inertia in inertias)
            message = (
                f"{stiffness:.4g} N m/rad, unusually {size} between inertias of {both} kg m2; are "
                'stiffness and inertias in N m/rad and kg mm^2? Other units: "1.2 MN m/rad", '
                '"15000 kg m^2"'
            )
            doubt = Doubt(shaft.path, message)
    if doubt is not None:
        yield doubt


# ------------------------------------------------------------------ a chain file
def build_chain(
    file: ChainFile,
    name: str = "",
    orders: Real | None = None,
    fitted: Mapping[str, Damper | None] = NO_DAMPERS,
) -> TorsionalSystem:
    """Return the system of a chain file.

    Args:
        file: Tables of the file.
        name: Name of the file, for messages.
        orders: Orders of the excitation to use, shape (orders,); None: all.
        fitted: Dampers by the name of their node, as for `assemble_system`.

    Raises:
        InputError: A node has no shaft, gears lock each other, or no node can turn.
    """
    index = {node.name: k for k, node in enumerate(file.node)}
    nodes = [PlannedNode(node, node.damping) for node in file.node]
    joints: list[tuple[str, str, ShaftKeys, float]] = [(s.from_, s.to, s, 1.0) for s in file.shaft]
    joints += [(g.from_, g.to, _MESH, g.ratio) for g in file.gear]
    labels = _tell_apart([f"{start}-{end}" for start, end, *_ in joints])
    shafts = []
    for number, (label, joint) in enumerate(zip(labels, joints, strict=True), 1):
        start, end, table, ratio = joint
        path = f"shaft.{number}.stiffness" if table.stiffness is not None else ""
        meshes = number > len(file.shaft)
        planned = PlannedShaft(label, index[start], index[end], table, ratio)
        shafts.append(planned if meshes else planned._replace(path=path))
    of_steel = [shaft for shaft in file.shaft if shaft.is_of_unnamed_steel]
    assumed: tuple[Assumed, ...] = ()
    if of_steel:
        assumed = (assume("shaft.shear_modulus", of_steel[0], of_steel[0].shear_modulus),)
    system = assemble_system(
        nodes,
        shafts,
        file,
        [index[each] for each in file.fixed],
        fitted,
        name=file.name or "",
        ends=(0, len(nodes) - 1),
        excitation=_excite(file, index, orders),
        assumed=assumed,
        file=name,
    )
    named = [(f"shaft.{k}", shaft) for k, shaft in enumerate(file.shaft, 1)]
    problems = list(_find_unrated(named, "rated_speed"))
    problems += _find_mean_limits(named)
    if problems:
        raise InputError(problems, name)
    paths = [f"shaft.{k}" for k, _ in enumerate(file.shaft, 1)]
    paths += [f"gear.{k}" for k, _ in enumerate(file.gear, 1)]
    if problems := list(_find_faults(system, paths)):
        raise InputError(problems, name)
    return system


def _find_mean_limits(tables: Iterable[tuple[str, ShaftKeys]]) -> Iterator[Problem]:
    """Yield the limits of a chain's shafts that are their mean torque."""
    for path, table in tables:
        if table.torque_limit == MEAN:
            message = 'is "mean", but a chain file gives no mean torque; give a torque in N m'
            yield Problem(f"{path}.torque_limit", message)


def _find_unrated(tables: Iterable[tuple[str, ShaftKeys]], wanted: str) -> Iterator[Problem]:
    """Yield a problem for each rule of a limit that has no rated speed.

    Args:
        tables: Paths and tables of the shafts.
        wanted: What would give the rated speed.
    """
    for path, table in tables:
        limit = table.limit
        if isinstance(limit, StressLimit) and limit.rule and limit.rated_speed is None:
            yield Problem(f"{path}.limit", f"has no rated speed; give {wanted}")


def _tell_apart(names: Sequence[str]) -> Iterator[str]:
    """Yield the names, and number repeated ones: `a-b`, `a-b (2)`."""
    for k, name in enumerate(names):
        before = names[:k].count(name)
        yield f"{name} ({before + 1})" if before else name


def _excite(file: ChainFile, index: dict[str, int], orders: Real | None) -> Excitation | None:
    if not file.excitation:
        return None
    given, row = np.unique([float(each.order) for each in file.excitation], return_inverse=True)
    nodes = [index[each.node] for each in file.excitation]
    sources, column = np.unique(nodes, return_inverse=True)
    steady = np.zeros((len(given), len(sources)), complex)
    np.add.at(steady, (row, column), [complex(each.cos, -each.sin) for each in file.excitation])
    found = Excitation(given, sources, steady, np.zeros_like(steady))
    return found if orders is None else found.only(orders)


def _find_faults(system: TorsionalSystem, paths: Sequence[str]) -> Iterator[Problem]:
    """Yield mistakes in how nodes are joined; `paths` are the paths of shafts and gears in the
    file.
    """
    chain = system.chain
    names = system.nodes
    meshes = np.isinf(chain.stiffness)
    free = ~np.any(chain.clamped)
    apart = np.unique(find_pieces(chain).first)[1:].tolist()
    for node in apart:
        text = f"{shorten(names[node])} is not connected to {shorten(names[0])}"
        yield Problem(f"node.{node + 1}", f"{text}; join them by a [[shaft]] or a [[gear]]")
    if locked := list(_find_contradiction(chain, paths, meshes)):
        yield from locked
        return
    still = find_still(chain)
    if np.all(still[: system.last + 1]):
        yield Problem("fixed", "clamps every node; leave one free")
        return
    first = find_pieces(chain, meshes).first
    held = np.flatnonzero(chain.clamped)
    roots = [*held.tolist(), *np.setdiff1d(first, first[held]).tolist()]
    joined = [branch.shaft for branch in grow_branches(chain, roots, meshes)]
    for mesh in np.setdiff1d(np.flatnonzero(meshes), joined).tolist():
        hint = "their shares of the torque are not determined; leave it out, or give a stiffness"
        yield Problem(paths[mesh], f"closes a loop of gears and rigid shafts: {hint}")
    yield from _find_contradiction(chain, paths, np.full(len(meshes), free))
    if system.angle_limit is not None and still[0]:
        text = f"applies to the first node, and {shorten(names[0])} is fixed; leave it out"
        yield Problem("angle_limit", f"{text}, or begin the chain with the node that it limits")
    if apart:
        return
    turning = [motion != 0 for motion in rigid_motions(chain)]
    for piece in turning or [~still]:  # of a clamped chain, all nodes that can move
        if not np.any(chain.inertia[piece]):
            path = f"node.{np.argmax(piece) + 1}.inertia"
            yield Problem.of_missing(path, "no node that turns with this node has an inertia")


def _find_contradiction(
    chain: Chain, paths: Sequence[str], joining: NDArray[np.bool_]
) -> Iterator[Problem]:
    """Yield a problem for the first shaft or gear in the mask `joining` that closes a loop with
    contradictory ratios. A loop of gears would lock; elastic shafts in a loop would be wound up as
    they turn.
    """
    pieces = find_pieces(chain, joining)
    paces = pieces.pace[chain.end] / pieces.pace[chain.start]
    torn = joining & (np.abs(paces - chain.ratio) > SAME_RATIO * np.abs(paces))
    for shaft in np.flatnonzero(torn)[:1].tolist():
        ratios = f"{chain.ratio[shaft]:.9g} here, {paces[shaft]:.9g} by the rest of the loop"
        hint = "give ratios with all digits, or leave out one of the gears"
        yield Problem(paths[shaft], f"closes a loop of contradictory ratios: {ratios}; {hint}")


# ------------------------------------------------------------------ an engine file
class _Joint(NamedTuple):
    """A part, its path in the file, and the name of the node (`of`) that it is joined to."""

    path: str
    part: Part
    of: str


def require_torsion(model: EngineFile, name: str) -> Torsion:
    """Return the table [torsion] of an engine file.

    Args:
        model: Engine file.
        name: Name of the file, for messages.

    Raises:
        BalcliError: The file has no [torsion].
    """
    if model.torsion is None:
        raise BalcliError(
            f"{name}: has no [torsion]; write it with throw_stiffness, throw_inertia and "
            "[[torsion.rear]] for the flywheel, or a chain of [[node]] and [[shaft]]"
        )
    return model.torsion


def build_engine_system(
    model: EngineFile,
    engine: Engine,
    excitation: Excitation,
    name: str = "",
    fitted: Mapping[str, Damper | None] = NO_DAMPERS,
) -> TorsionalSystem:
    """Return the system of an engine.

    Args:
        model: Engine file with [torsion].
        engine: Engine of this file.
        excitation: Torques of its cylinders, from `excite_engine`.
        name: Name of the file, for messages.
        fitted: Dampers by the name of their node, as for `assemble_system`.

    Raises:
        InputError: [torsion] contradicts itself; the error lists each contradiction by its path.
    """
    torsion = require_torsion(model, name)
    throws = list_throws(engine)
    joints = _join_parts(torsion, throws)
    front = len(torsion.front)
    problems = list(_find_misfits(model, torsion, engine, throws, joints))
    own_speed = "speed" in model.operation.model_fields_set
    if not own_speed:
        wanted = "rated_speed, or the engine's operation.speed"
        problems += _find_unrated(((path, part) for path, part, _ in joints), wanted)
    known_nodes = [*(joint.part.name for joint in joints), *throws]
    has_gas = engine.gas is not None
    problems += node_torques.find_mistakes(
        torsion, known_nodes, has_gas=has_gas, has_speed=own_speed
    )
    if problems:
        raise InputError(problems, name)
    parts = [PlannedNode(part, part.node_damping) for _, part, _ in joints]
    nodes = [*parts[:front][::-1], *_plan_throws(torsion, engine, throws), *parts[front:]]
    place = {node.table.name: k for k, node in enumerate(nodes)}
    led = _lead_outward(joints, throws)
    gears = dict.fromkeys(throws, 1.0)
    for _, part, of in led:
        gears[part.name] = gears[of] if part.gear is None else part.gear
    leading = list(_plan_part_shafts(joints, place, gears))
    size = find_throw_size(model, engine)
    throw = find_throw_stiffness(torsion, size, np.arange(front, front + len(throws) - 1))
    assumed = engine.list_assumed("gas", "torsion", without=(*STEADY, "operation.speed")) or ()
    if throw is not None and throw.follows:
        assumed = *assumed, *_assume_throw(model, torsion, throw)
    plain = _make_section(torsion, size)
    own = () if throw is None or throw.used is None else (throw.used,)
    stiffness = _each(torsion.given_stiffness or own, len(throws) - 1)
    tables = [plain.model_copy(update={"stiffness": each}) for each in stiffness]
    given = "torsion.throw_stiffness" if torsion.given_stiffness else ""
    names = enumerate(zip(_name_between(throws), tables, strict=False), front)
    between = [
        PlannedShaft(name, first, first + 1, table, path=given) for first, (name, table) in names
    ]
    ends = (
        place[_find_end([j for j in led if j.path.startswith(f"torsion.{key}")], gears, start)]
        for key, start in (("front", throws[0]), ("rear", throws[-1]))
    )
    shafts = [*leading[:front][::-1], *between, *leading[front:]]
    output = joints[-1].part.name if torsion.rear else throws[-1]
    means = _find_means(excitation, shafts, [*map(gears.__getitem__, place)], place[output])
    by_mean = [(path, part) for path, part, _ in joints if part.torque_limit == MEAN]
    if by_mean:
        carrying = set() if means is None else _name_carrying(shafts, means, engine.silent)
        problems += node_torques.find_idle_limits(by_mean, carrying)
    if problems:
        raise InputError(problems, name)
    rated_rpm = model.operation.speed if own_speed else None
    torques = tuple(node_torques.make_torques(torsion, place, gears, means, rated_rpm))
    phased = [torque for torque in torques if torque.turn is not None]
    system = assemble_system(
        nodes,
        shafts,
        torsion,
        fitted=fitted,
        means=means,
        name=engine.name,
        excitation=excitation.with_torques(phased),
        torques=torques,
        rated_rpm=rated_rpm,
        reference=front,
        ends=tuple(ends),
        silent=engine.silent,
        throw=throw,
        assumed=assumed,
        file=name,
    )
    of_throws = system.chain.inertia[front : front + len(throws)]
    doubts = _doubt_inertias(joints, gears, float(of_throws.min()))
    return replace(system, doubts=(*system.doubts, *doubts))


def _plan_part_shafts(
    joints: Iterable[_Joint], place: Mapping[str, int], gears: Mapping[str, float]
) -> Iterator[PlannedShaft]:
    """Yield the shaft from each part's neighbour to the part; its stiffness is that at the part's
    speed.

    Args:
        joints: Parts and their paths.
        place: Index of each node, by its name.
        gears: Speed of each node over crank speed, by its name.
    """
    for path, part, of in joints:
        ratio = gears[part.name] / gears[of]
        given = f"{path}.stiffness" if part.stiffness is not None else ""
        yield PlannedShaft(part.name, place[of], place[part.name], part, ratio, given)


def _doubt_inertias(
    joints: Iterable[_Joint], gears: Mapping[str, float], of_throw: float
) -> Iterator[Doubt]:
    """Yield warnings of parts whose inertia is tiny beside that of a throw, as if it were in kg m2.

    Args:
        joints: Parts and their paths.
        gears: Speed of each node over crank speed, by its name.
        of_throw: Smallest inertia of a throw, kg m2.
    """
    for path, part, _ in joints:
        inertia = part.inertia or 0.0
        at_crank = inertia / 1e6 * gears[part.name] ** 2
        if 0 < at_crank < _TINY * of_throw:
            size = f"{inertia:.4g} kg mm^2, beside {1e6 * of_throw:.4g} kg mm^2 of a throw"
            question = ask_unit("kg mm^2", f"{inertia:.4g} kg m^2")
            yield Doubt(f"{path}.inertia", f"{size}; {question}")


def _make_section(torsion: Torsion, size: ThrowSize | None) -> ShaftKeys:
    """Return diameter and bore of the crankshaft between throws: those of [torsion], else those of
    the journal or pin with the larger stress.
    """
    diameter = torsion.throw_diameter
    bore = torsion.throw_bore
    if diameter is None and size is not None:
        outer, inner = size.weakest_section
        diameter = 1e3 * outer
        bore = 1e3 * inner
    return ShaftKeys.model_construct(diameter=diameter, bore=bore)


def _assume_throw(model: EngineFile, torsion: Torsion, throw: ThrowStiffness) -> Iterator[Assumed]:
    """Yield the values that are used because the file leaves out how stiff its throws are."""
    if throw.source == "mean" and throw.used is not None:
        yield assume("torsion.throw_stiffness", torsion, limit_digits(throw.used))
    thickness = find_web_thickness(model)
    if torsion.web_thickness is None and thickness is not None:
        yield assume("torsion.web_thickness", torsion, thickness)
    if not torsion.has("shear_modulus"):
        yield assume("torsion.shear_modulus", torsion, torsion.shear_modulus)


def _find_means(
    excitation: Excitation, shafts: Sequence[PlannedShaft], gears: Sequence[float], output: int
) -> MeanTorques | None:
    """Return the mean torques of shafts; None without gas.

    Args:
        excitation: Torques of the cylinders.
        shafts: Shafts between the nodes.
        gears: Speed of each node over crank speed.
        output: Index of the node that takes the power.
    """
    if excitation.means is None:
        return None
    links = [Link(shaft.start, shaft.end, gears[shaft.end]) for shaft in shafts]
    sources = excitation.nodes.tolist()  # of the cylinders
    return MeanTorques(excitation.means, share_out(links, sources, output))


def _name_carrying(
    shafts: Sequence[PlannedShaft], means: MeanTorques, silent: SilentCylinders
) -> set[str]:
    """Return the names of the shafts that carry a mean torque if all cylinders fire."""
    if not any(silent) and not np.any(means.find_total(means.judged_rpm)):
        return set()
    carries = np.any(means.shares, axis=0).tolist()
    return {shaft.name for shaft, carried in zip(shafts, carries, strict=True) if carried}


def _plan_throws(torsion: Torsion, engine: Engine, throws: Sequence[str]) -> Iterator[PlannedNode]:
    """Yield a node for each throw, with the running gear and the damping of its cylinders."""
    gear = weigh_running_gear(engine)
    on_throw = engine.joined_throw_of_rows
    inertias = _weigh_throws(torsion, engine) + np.bincount(on_throw, gear, len(throws))
    damping = torsion.damping * np.bincount(on_throw, None, len(throws))
    for name, j, c in zip(throws, inertias.tolist(), damping.tolist(), strict=True):
        table = NodeKeys.model_construct(name=name, inertia=1e6 * j)
        yield PlannedNode(table, c, list_dampers(torsion, name))


def list_dampers(torsion: Torsion, throw: str) -> tuple[Damper, ...]:
    """Return the dampers of [[torsion.throw]] on the throw of this name (`throw 1`)."""
    return tuple(each.damper for each in torsion.throw if name_throw(each.throw) == throw)


def list_throws(engine: Engine) -> list[str]:
    """Return the names of the nodes of the throws, front to rear."""
    return [name_throw(number) for number, _ in enumerate(engine.joined_throws, 1)]


def name_throw(number: int) -> str:
    """Return the name of a throw's node."""
    return f"throw {number}"


def _name_between(throws: Sequence[str]) -> list[str]:
    return [f"throw {k}-{k + 1}" for k in range(1, len(throws))]


def _each(values: Sequence[float], count: int) -> list[float]:
    """Return a list of `count` values: the single value repeated, or the list itself."""
    return list(values) * count if len(values) == 1 else list(values)


def _join_parts(torsion: Torsion, throws: Sequence[str]) -> list[_Joint]:
    """Return every part with the node that it is joined to: front parts, then rear parts."""
    front = _join_chain("torsion.front", torsion.front, throws[0])
    return front + _join_chain("torsion.rear", torsion.rear, throws[-1])


def _join_chain(path: str, parts: Sequence[Part], throw: str) -> list[_Joint]:
    """Return parts, each joined to the node that it names, or else to the part before it; the
    first part is joined to the throw.
    """
    joints = []
    before = throw
    for number, part in enumerate(parts, 1):
        joints.append(_Joint(f"{path}.{number}", part, part.of or before))
        before = part.name
    return joints


def _lead_outward(joints: Sequence[_Joint], throws: Sequence[str]) -> list[_Joint]:
    """Return the joints in order from the throws outward, since a part may be joined to a part
    that comes later in the file. Parts without a connection to a throw are left out.
    """
    reached = {*throws}
    attached = list[_Joint]()
    while new := [each for each in joints if each.of in reached and each.part.name not in reached]:
        attached += new
        reached |= {each.part.name for each in new}
    return attached


def _find_end(led: Sequence[_Joint], gears: Mapping[str, float], start: str) -> str:
    """Return the name of an end of the system: of the nodes at crank speed, the node with the most
    shafts between it and the first or last throw. Of several such nodes, the node with the largest
    inertia is returned. Parts at another speed are branches and do not count.

    Args:
        led: Joints from the throw outward.
        gears: Speed of every node over crank speed, by name.
        start: Name of the first or last throw.
    """
    steps = {start: (0, 0.0, start)}
    for _, part, of in led:
        if of in steps and abs(gears[part.name] - 1) <= SAME_RATIO:
            steps[part.name] = (steps[of][0] + 1, part.inertia or 0.0, part.name)
    return max(steps.values())[2]


# ------------------------------------------------------------------ inertia and excitation
def weigh_running_gear(engine: Engine) -> Real:
    """Return the mean moment of inertia of each cylinder's running gear without the throw, kg m2,
    shape (cylinders,): `m_rot r^2 + mean(m_rec s'^2 - H beta'^2)`. Here m_rot and m_rec are the
    rotating and reciprocating masses, r is the crank radius, s' and beta' are the derivatives of
    piston position and rod angle by the crank angle, and docs/theory.md defines H.
    """
    c = engine.cylinders
    mean_only = np.zeros(1)
    series = find_needed_series(c, {"torque"}, uneven=False)
    few, which = c.find_distinct_harmonics(mean_only, series)
    moving = find_inertia(c, select_cylinders(few, which), 1.0).c[0].real
    own = np.array([float(weighed.share) for weighed in engine.weighed])
    turning = (c.rotating - own) * c.radius**2
    return np.broadcast_to(moving, own.shape) + np.broadcast_to(turning, own.shape)


def _weigh_throws(torsion: Torsion, engine: Engine) -> Real:
    """Return the moment of inertia of the crankshaft at each throw, kg m2, front to rear. The
    inertias of throws that form one node are added.
    """
    joined = engine.joined_throws
    throws = len(engine.throws_m)
    given = torsion.throw_inertia or [float(engine.crank_inertia or 0.0) * 1e6 / throws]
    if len(given) == len(joined) < throws:  # one value for each joined throw
        return np.array(given) / 1e6
    by_throw = _each(given, throws)
    return np.array([sum(by_throw[throw] for throw in together) for together in joined]) / 1e6


def excite_engine(model: EngineFile, engine: Engine, orders: Real | None) -> Excitation:
    """Return the torque of every cylinder on the node of its throw (`excite_cylinders`), without
    orders in which no cylinder has a torque.
    """
    return excite_cylinders(model, engine, orders).without_idle_orders()


def excite_cylinders(
    model: EngineFile, engine: Engine, orders: Real | None, of_gas: Complex | None = None
) -> Excitation:
    """Return the torque of every cylinder on the node of its throw: inertia torque and, if the
    engine has gas, gas torque.

    Args:
        model: Engine file.
        engine: Engine of this file.
        orders: Orders, shape (orders,); None: all orders up to HIGHEST_TORSION_ORDER_UNASKED (with
            half orders for a four-stroke engine with gas), and the orders of
            `list_gas_orders`.
        of_gas: `steady` of the excitation by an engine with the same gas; None: it is computed.
    """
    front = 0 if model.torsion is None else len(model.torsion.front)
    nodes = front + np.array(engine.joined_throw_of_rows)
    means = find_cylinder_means(engine)
    engine = replace(engine, ripple=(), speed_rpm=1 / RPM)  # 1 rad/s
    if orders is None:
        step = 1.0 if engine.gas is None else 2 / engine.strokes
        usual = np.arange(step, HIGHEST_TORSION_ORDER_UNASKED + step, step)
        orders = np.union1d(usual, list_gas_orders(engine))
    growing = compute_spectra(engine, orders, ["torque"], by_cylinder=True)["torque"].x
    steady: Complex = np.zeros_like(growing)
    if of_gas is not None:
        steady = of_gas
    elif engine.gas is not None:
        steady = compute_spectra(engine, orders, ["gas"], by_cylinder=True)["gas"].x
    gas = None
    if engine.gas is not None and engine.gas.nodes_rpm:
        gas = follow_gas(
            engine, lambda own: compute_spectra(own, orders, ["gas"], by_cylinder=True)["gas"].x
        )
    return Excitation(orders, nodes, steady, growing, gas, means=means)


# ------------------------------------------------------------------ contradictions in [torsion]
def _find_misfits(
    model: EngineFile,
    torsion: Torsion,
    engine: Engine,
    throws: Sequence[str],
    joints: Sequence[_Joint],
) -> Iterator[Problem]:
    if engine.rotary:
        yield Problem("torsion", "needs a crankshaft that turns; that of a rotary engine does not")
        return
    if len(throws) > 1 and not torsion.given_stiffness:
        yield from find_problems(model, engine, counted(len(throws), "throw"))
    yield from _check_throws(torsion, engine, len(throws))
    names = [*throws, *(joint.part.name for joint in joints)]
    reserved = {*throws, *_name_between(throws)}
    joined = [j if j.of in names else j._replace(of=throws[0]) for j in joints]
    led = {joint.part.name for joint in _lead_outward(joined, throws)}
    for k, (path, part, of) in enumerate(joints, len(throws)):
        name = shorten(part.name)
        if part.name in reserved:
            yield Problem(f"{path}.name", f"{name} is the name of a throw")
        elif part.name in names[:k]:
            yield Problem(f"{path}.name", f"{name} is given twice; rename one of them")
        if of not in names:
            yield Problem(f"{path}.of", refuse_node(of, names))
        elif part.name not in led and part.name not in reserved:
            text = f"{shorten(of)} is not connected to the crankshaft; name one that is connected"
            yield Problem(f"{path}.of", text)


def _check_throws(torsion: Torsion, engine: Engine, throws: int) -> Iterator[Problem]:
    """Check the keys of throws. The list of inertias may have a value for each throw of the file,
    even where several throws form one node.
    """
    places = throws - 1
    in_file = len(engine.throws_m)
    stiffness = "throw_stiffness", torsion.given_stiffness, places, places
    inertia = "throw_inertia", torsion.throw_inertia or (), throws, in_file
    for key, values, needed, also in (stiffness, inertia):
        if len(values) not in (0, 1, needed, also):
            text = f"has {len(values)} values, but the crankshaft has {counted(throws, 'throw')}"
            wanted = "give one value"
            if needed > 1:
                counts = str(needed) if also == needed else f"{needed} or {also}"
                wanted = f"give one value for all, or {counts} values"
            yield Problem(f"torsion.{key}", f"{text}; {wanted}")
    for number, each in enumerate(torsion.throw, 1):
        if each.throw > throws:
            text = f"is {each.throw}, but the crankshaft has {counted(throws, 'throw')}"
            yield Problem(f"torsion.throw.{number}.throw", text)
    if torsion.throw_inertia is None and engine.crank_inertia is None:
        hint = "give it, such as throw_inertia = 46700, or give inertia in [crank]"
        yield Problem.of_missing("torsion.throw_inertia", hint)
