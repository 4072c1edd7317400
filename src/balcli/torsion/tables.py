"""Tables of a chain file, which describes inertias on shafts and gears, and excitations, without an
engine.

Units: kg mm2, N m/rad, N m s/rad, mm, GPa, N m, N/mm2; a string carries its own unit.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ..file.fields import Number
from ..file.table import FileTable, Name
from ..file.torsion_tables import ChainKeys, Damping, NodeKeys, ShaftKeys, SpeedRatio
from ..file.units import PLAIN, TORQUE
from ..limits import HIGHEST_TORSION_ORDER, MOST_TORSION_NODES

Torque = Annotated[float, Number(TORQUE, most=1e18)]


class _HalfOrder(Number):
    """An order: a multiple of 1/2."""

    def read(self, value: object) -> float:
        order = super().read(value)
        if 2 * order != round(2 * order):
            raise ValueError(
                f"{order:g} is no order that can be added up over two turns of the first node; "
                "give a multiple of 0.5"
            )
        return order


class Node(NodeKeys):
    """A node: an inertia, or a place where shafts meet."""

    damping: Damping = Field(0.0, examples=[2], description="of the node against ground")


class ChainShaft(ShaftKeys):
    """A shaft between two nodes."""

    from_: Name = Field(
        alias="from", examples=["crank"], description="name of the node where it starts"
    )
    to: Name = Field(examples=["flywheel"], description="name of the node where it ends")


class Gear(FileTable):
    """A mesh of gears without mass."""

    from_: Name = Field(
        alias="from", examples=["pinion"], description="name of the node that drives"
    )
    to: Name = Field(examples=["wheel"], description="name of the node that is driven")
    ratio: Annotated[float, SpeedRatio()] = Field(
        examples=[-0.5],
        description="speed of `to` over speed of `from`; negative: they turn against each other",
    )


class Excitation(FileTable):
    """A torque on a node, `cos * cos(n t) + sin * sin(n t)`; t is the angle of the first node."""

    node: Name = Field(examples=["crank"], description="name of the node on which it acts")
    order: Annotated[float, _HalfOrder(PLAIN, above=0, most=HIGHEST_TORSION_ORDER)] = Field(
        examples=[1.5], description="how often in a turn of the first node; a multiple of 0.5"
    )
    cos: Torque = Field(0.0, examples=[120], description="amplitude of its cosine")
    sin: Torque = Field(0.0, examples=[-35], description="amplitude of its sine")


class ChainFile(ChainKeys):
    """Inertias on shafts and gears, and excitations."""

    name: Name | None = Field(None, examples=["pump drive"], description="what to call it")
    fixed: tuple[Name, ...] = Field(
        (), examples=[["hull"]], max_length=MOST_TORSION_NODES, description="nodes that are clamped"
    )
    node: tuple[Node, ...] = Field(examples=[], description="the nodes; the first gives the speed")
    shaft: tuple[ChainShaft, ...] = Field((), examples=[], description="the shafts between them")
    gear: tuple[Gear, ...] = Field((), examples=[], description="meshes of gears between them")
    excitation: tuple[Excitation, ...] = Field((), examples=[], description="torques on nodes")


LISTS: tuple[type[FileTable], ...] = (Node, ChainShaft, Gear, Excitation)


# ------------------------------------------------------------------ what does not fit together
