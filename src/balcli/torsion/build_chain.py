"""A chain file -> torsional system in SI units; what hangs together wrongly is told by its path."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..core.torsional_chain import Chain, Damping, Shaft, find_pieces, join_chain, rigid_motions
from ..enginefile.fields import shorten
from ..enginefile.shafting import ShaftKeys, find_stiffness
from ..errors import InputError, Problem
from .chain_file import ChainFile
from .dampers import fit_dampers
from .system import Excitation, Section, TorsionalSystem


def build_chain(file: ChainFile, name: str = "") -> TorsionalSystem:
    """The system of a chain file; `name` is that of the file, for messages.

    Raises:
        InputError: nodes that hang on nothing, gears that lock each other, nothing that can turn.
    """
    names = [node.name for node in file.node]
    index = {each: k for k, each in enumerate(names)}
    fitted = fit_dampers(names, [node.damper for node in file.node])
    joined = [
        Shaft(index[shaft.from_], index[shaft.to], find_stiffness(shaft)) for shaft in file.shaft
    ]
    meshes = [Shaft(index[g.from_], index[g.to], np.inf, g.ratio) for g in file.gear]
    inertia = [(node.inertia or 0.0) / 1e6 for node in file.node] + list(fitted.inertias)
    clamped = [index[each] for each in file.fixed]
    shafts = [*joined, *meshes, *fitted.shafts]
    chain = _join(names, inertia, shafts, clamped, name, len(file.shaft))
    losses = [file.loss if shaft.loss is None else shaft.loss for shaft in file.shaft]
    dashpots = [shaft.damping for shaft in file.shaft]
    extra = len(meshes) + len(fitted.shafts)
    joints = [f"{shaft.from_}-{shaft.to}" for shaft in file.shaft]
    joints += [f"{gear.from_}-{gear.to}" for gear in file.gear]
    return TorsionalSystem(
        file.name or "",
        (*names, *fitted.names),
        (*_tell_apart(joints), *fitted.names),
        chain,
        Damping(
            np.array([*losses, *[0.0] * len(meshes), *fitted.losses]),
            np.array([*dashpots, *[0.0] * extra]),
            np.array([*(node.damping for node in file.node), *[0.0] * len(fitted.inertias)]),
        ),
        (*map(find_section, file.shaft), *[None] * extra),
        fitted.rings,
        fitted.pendulums,
        _excite(file, index),
        None if file.limit is None else file.limit * 1e6,
        None if file.angle_limit is None else float(np.radians(file.angle_limit)),
        len(names) - 1,
    )


def _tell_apart(names: Sequence[str]) -> Iterator[str]:
    """The names, those that come again with a number: `a-b`, `a-b (2)`."""
    for k, name in enumerate(names):
        before = names[:k].count(name)
        yield f"{name} ({before + 1})" if before else name


def find_section(shaft: ShaftKeys) -> Section | None:
    """Diameters in m, where they are given."""
    if shaft.diameter is None:
        return None
    return Section(shaft.diameter / 1e3, (shaft.bore or 0.0) / 1e3)


def _excite(file: ChainFile, index: dict[str, int]) -> Excitation | None:
    if not file.excitation:
        return None
    orders = np.unique([each.order for each in file.excitation])
    sources = sorted({index[each.node] for each in file.excitation})
    steady = np.zeros((len(orders), len(sources)), complex)
    for each in file.excitation:
        row, column = int(np.searchsorted(orders, each.order)), sources.index(index[each.node])
        steady[row, column] += complex(each.cos, -each.sin)
    return Excitation(orders, np.array(sources), steady, np.zeros_like(steady))


def _join(
    names: Sequence[str],
    inertia: Sequence[float],
    shafts: Sequence[Shaft],
    clamped: Sequence[int],
    file: str,
    first_gear: int,
) -> Chain:
    """The chain, or an error by the paths of what is wrong."""
    table = np.array(shafts, float).reshape(-1, 4)
    ends = table[:, :2].astype(np.intp)
    held = np.isin(np.arange(len(inertia)), clamped)
    loose = Chain(np.array(inertia), ends[:, 0], ends[:, 1], table[:, 3], table[:, 2], held)
    problems = list(_find_faults(names, loose, first_gear))
    if problems:
        raise InputError(problems, file)
    return join_chain(inertia, shafts, clamped)


def _find_faults(names: Sequence[str], chain: Chain, first_gear: int) -> Iterator[Problem]:
    apart = np.unique(find_pieces(chain).first)[1:].tolist()
    for node in apart:
        text = f"{shorten(names[node])} hangs on nothing that hangs on {shorten(names[0])}"
        yield Problem(f"node.{node + 1}", f"{text}; join them by a [[shaft]] or a [[gear]]")
    meshes = find_pieces(chain, np.isinf(chain.stiffness))
    for shaft in np.flatnonzero(np.isinf(chain.stiffness)).tolist():
        if meshes.locked[chain.start[shaft]]:
            path = f"gear.{shaft - first_gear + 1}" if shaft >= first_gear else f"shaft.{shaft + 1}"
            yield Problem(path, "is in a loop of gears whose ratios lock each other")
            return
    if np.all(chain.clamped):
        yield Problem("fixed", "clamps every node; leave one free")
        return
    heavy = chain.inertia > 0
    for motion in [] if apart else rigid_motions(chain):
        if not np.any(heavy[motion != 0]):
            node = int(np.argmax(motion != 0))
            yield Problem(f"node.{node + 1}.inertia", "is missing; nothing that turns has any")
