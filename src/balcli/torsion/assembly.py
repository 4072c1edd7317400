"""Nodes and shafts, as chain files and engine files describe them -> torsional system with its
dampers fitted.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..core.torsional_chain import ChainShaft, Damping, join_chain
from ..enginefile.shafting import Damper, ShaftKeys
from .system import Excitation, Pendulums, ShaftSection, TorsionalSystem, ViscousRing


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


class Limits(NamedTuple):
    """What bars a speed: stress (N/mm2) and half swing of the first node (deg), if given."""

    stress: float | None
    angle: float | None


def assemble_system(
    name: str,
    nodes: Sequence[PlannedNode],
    shafts: Sequence[PlannedShaft],
    excitation: Excitation | None,
    limits: Limits,
    clamped: Sequence[int] = (),
    rated_rpm: float | None = None,
    reference: int = 0,
) -> TorsionalSystem:
    """The system; its rubber rings are nodes and shafts after all others."""
    rings, ring_shafts = _hang_rubber(nodes)
    every, joined = [*nodes, *rings], [*shafts, *ring_shafts]
    return TorsionalSystem(
        name=name,
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
        rings=tuple(
            ViscousRing(k, (damper.inertia or 0.0) / 1e6, damper.damping or 0.0)
            for k, damper in _find_dampers(nodes, "viscous")
        ),
        pendulums=tuple(
            Pendulums(k, damper.mass or 0.0, (damper.radius or 0) / 1e3, (damper.length or 0) / 1e3)
            for k, damper in _find_dampers(nodes, "pendulum")
        ),
        excitation=excitation,
        limit_pa=None if limits.stress is None else limits.stress * 1e6,
        angle_limit=None if limits.angle is None else float(np.radians(limits.angle)),
        last=len(nodes) - 1,
        rated_rpm=rated_rpm,
        reference=reference,
    )


def find_section(shaft: ShaftKeys) -> ShaftSection | None:
    """Diameters in m, where they are given."""
    if shaft.diameter is None:
        return None
    return ShaftSection(shaft.diameter / 1e3, (shaft.bore or 0.0) / 1e3)


def _hang_rubber(nodes: Sequence[PlannedNode]) -> tuple[list[PlannedNode], list[PlannedShaft]]:
    """Rings on rubber, and the rubber that joins each to its node."""
    rings: list[PlannedNode] = []
    shafts: list[PlannedShaft] = []
    for k, damper in _find_dampers(nodes, "rubber"):
        name = f"{nodes[k].name} ring"
        rubber = ChainShaft(k, len(nodes) + len(rings), damper.stiffness or 0.0)
        rings.append(PlannedNode(name, (damper.inertia or 0.0) / 1e6))
        shafts.append(PlannedShaft(name, rubber, damper.loss or 0.0))
    return rings, shafts


def _find_dampers(nodes: Sequence[PlannedNode], kind: str) -> list[tuple[int, Damper]]:
    """Dampers of a kind with the nodes that have them."""
    fitted = [(k, node.damper) for k, node in enumerate(nodes)]
    return [(k, damper) for k, damper in fitted if damper is not None and damper.kind == kind]
