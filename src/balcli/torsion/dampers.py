"""Dampers as a file gives them, fitted to the nodes that have them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..core.torsional_chain import Shaft
from ..enginefile.shafting import Damper
from .system import Pendulums, ViscousRing


class FittedDampers(NamedTuple):
    """Rings and pendulums, and what rubber rings add to a chain.

    Attributes:
        rings, pendulums: dampers that are no nodes.
        inertias: kg m2 of the nodes that rubber rings add.
        names: of those.
        shafts: of rubber, one for each.
        losses: loss factors of the rubber.
    """

    rings: tuple[ViscousRing, ...]
    pendulums: tuple[Pendulums, ...]
    inertias: tuple[float, ...]
    names: tuple[str, ...]
    shafts: tuple[Shaft, ...]
    losses: tuple[float, ...]


def fit_dampers(names: Sequence[str], dampers: Sequence[Damper | None]) -> FittedDampers:
    """Dampers (or None) of all nodes, by the nodes' names."""
    rings, pendulums, rubber = [], [], []
    for node, damper in enumerate(dampers):
        if damper is None:
            continue
        if damper.kind == "viscous":
            rings.append(ViscousRing(node, _si(damper.inertia), damper.damping or 0.0))
        elif damper.kind == "rubber":
            rubber.append((node, damper))
        else:
            radius, length = (damper.radius or 0.0) / 1e3, (damper.length or 0.0) / 1e3
            pendulums.append(Pendulums(node, damper.mass or 0.0, radius, length))
    first = len(names)
    return FittedDampers(
        tuple(rings),
        tuple(pendulums),
        tuple(_si(damper.inertia) for _, damper in rubber),
        tuple(f"{names[node]} ring" for node, _ in rubber),
        tuple(
            Shaft(node, first + k, damper.stiffness or 0.0)
            for k, (node, damper) in enumerate(rubber)
        ),
        tuple(damper.loss or 0.0 for _, damper in rubber),
    )


def _si(inertia: float | None) -> float:
    """kg mm2 to kg m2."""
    return (inertia or 0.0) / 1e6
