"""A chain file -> torsional system in SI units; what hangs together wrongly is told by its path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..core.torsional_chain import (
    SAME_RATIO,
    Chain,
    ChainShaft,
    find_pieces,
    find_still,
    join_chain,
    rigid_motions,
)
from ..enginefile.fields import shorten
from ..enginefile.shafting import Damper, find_stiffness
from ..errors import InputError, Problem
from .assembly import NO_DAMPERS, PlannedNode, PlannedShaft, assemble_system, find_section
from .chain_file import ChainFile, Gear
from .chain_file import ChainShaft as ShaftTable
from .system import Excitation, TorsionalSystem


def build_chain(
    file: ChainFile, name: str = "", fitted: Mapping[str, Damper | None] = NO_DAMPERS
) -> TorsionalSystem:
    """Return the system of a chain file.

    Args:
        file: What it says.
        name: Name of the file, for messages.
        fitted: Dampers of some nodes in place of those in the file.

    Raises:
        InputError: nodes that hang on nothing, gears that lock each other, nothing that can turn.
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
        loss, section = each.loss, find_section(each.diameter, each.bore)
        shaft = ChainShaft(start, end, find_stiffness(each))
        loss = file.loss if loss is None else loss
        shafts.append(PlannedShaft(label, shaft, loss, each.damping, section))
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
        excitation=excitation,
        file=name,
    )


def _tell_apart(names: Sequence[str]) -> Iterator[str]:
    """The names, those that come again with a number: `a-b`, `a-b (2)`."""
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
    """What hangs together wrongly; `paths`: of the shafts, gears among them, in the file;
    `limited`: whether the angle of the first node is.
    """
    names = [node.name for node in nodes]
    inertia = [node.inertia for node in nodes]
    chain = join_chain(inertia, [each.shaft for each in shafts], clamped)
    apart = np.unique(find_pieces(chain).first)[1:].tolist()
    for node in apart:
        text = f"{shorten(names[node])} hangs on nothing that hangs on {shorten(names[0])}"
        yield Problem(f"node.{node + 1}", f"{text}; join them by a [[shaft]] or a [[gear]]")
    meshes = find_pieces(chain, np.isinf(chain.stiffness))
    for shaft in np.flatnonzero(np.isinf(chain.stiffness)).tolist():
        if meshes.locked[chain.start[shaft]]:
            yield Problem(paths[shaft], "is in a loop of gears whose ratios lock each other")
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
    """Loops of meshes alone, in which nothing says what each carries; and of shafts, which a chain
    that turns would wind up without end.
    """
    group = np.where(chain.clamped, -1, np.arange(len(chain.inertia)))
    for mesh in np.flatnonzero(np.isinf(chain.stiffness)).tolist():
        start, end = group[chain.start[mesh]], group[chain.end[mesh]]
        if start == end:
            text = "closes a loop of gears and rigid shafts, fixed nodes counted as one"
            hint = "nothing says how they share the torque; leave it out, or give a stiffness"
            yield Problem(paths[mesh], f"{text}: {hint}")
        group[group == end] = start
    pieces = find_pieces(chain)
    if not pieces.locked[0] or np.any(chain.clamped):
        return
    ahead, behind = pieces.pace[chain.start] * chain.ratio, pieces.pace[chain.end]
    shaft = int(np.argmax(np.abs(ahead - behind) > SAME_RATIO * np.abs(behind)))
    text = f"closes a loop whose ratios contradict each other, {ahead[shaft]:.9g} one way round"
    hint = "a chain that turns would wind up its shafts without end; give ratios with all digits"
    yield Problem(paths[shaft], f"{text} and {behind[shaft]:.9g} the other: {hint}")
