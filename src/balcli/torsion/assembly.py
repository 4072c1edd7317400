"""Nodes and shafts, as chain files and engine files describe them -> torsional system with its
dampers fitted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from ..core.torsional_chain import ChainShaft, Damping, join_chain
from ..enginefile.shafting import Damper
from .system import Pendulums, ShaftSection, TorsionalSystem, ViscousRing

NO_DAMPERS: Mapping[str, Damper | None] = MappingProxyType({})


class PlannedNode(NamedTuple):
    """A node: inertia in kg m2, damping in N m s/rad against ground, and the damper it has."""

    name: str
    inertia: float
    damping: float = 0.0
    damper: Damper | None = None


class PlannedShaft(NamedTuple):
    """A shaft between two nodes, with its loss factor, dashpot (N m s/rad) and diameters."""

    name: str
    shaft: ChainShaft
    loss: float = 0.0
    dashpot: float = 0.0
    section: ShaftSection | None = None


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
        nodes: Front to rear.
        shafts: Between them.
        limits: Stress (N/mm2) and half swing of the first node (deg) above which a speed is barred;
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
        **others,
    )


def find_section(diameter: float | None, bore: float | None) -> ShaftSection | None:
    """Return a section in m, from a diameter and a bore in mm, where they are given."""
    return None if diameter is None else ShaftSection(diameter / 1e3, (bore or 0.0) / 1e3)
