"""Define and check the tables of a chain file. Such a file describes inertias on shafts and gears,
and excitations, without an engine. All mistakes are reported at once by their paths.

Units: kg mm2, N m/rad, N m s/rad, mm, GPa, N m, N/mm2; a string carries its own unit.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated

from pydantic import Field

from ..errors import Problem
from ..file.fields import Number, Whole, printable, shorten, suggest_nearest
from ..file.messages import CHAIN
from ..file.read import TableReader
from ..file.table import FileTable, Name
from ..file.torsion_tables import ChainKeys, Damping, NodeKeys, ShaftKeys, SpeedRatio
from ..file.units import TORQUE
from ..limits import HIGHEST_TORSION_ORDER, MOST_LIST_VALUES, MOST_TORSION_NODES

Torque = Annotated[float, Number(TORQUE, most=1e18)]


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
    ratio: SpeedRatio
    """Speed of `to` over speed of `from`; negative: they turn against each other. Example: -0.5"""


class Excitation(FileTable):
    """A torque on a node, `cos * cos(n t) + sin * sin(n t)`, for the order n; t is the angle of the
    first node.
    """

    node: Name = Field(examples=["crank"], description="name of the node on which it acts")
    order: Annotated[float, Whole(least=0.5, most=HIGHEST_TORSION_ORDER, halves=True)]
    """Oscillations per turn of the first node; a multiple of 0.5. Example: 1.5"""
    cos: Torque = Field(0.0, examples=[120], description="amplitude of the cosine")
    sin: Torque = Field(0.0, examples=[-35], description="amplitude of the sine")


class ChainFile(ChainKeys):
    """Inertias on shafts and gears, and excitations."""

    name: Name | None = Field(None, examples=["pump drive"], description="name of the chain")
    fixed: Annotated[tuple[Name, ...], Field(max_length=MOST_TORSION_NODES)] = ()
    """Nodes that are clamped. Example: ['hull']"""
    node: tuple[Node, ...] = Field(examples=[], description="the nodes; speeds refer to the first")
    shaft: tuple[ChainShaft, ...] = Field((), examples=[], description="the shafts between them")
    gear: tuple[Gear, ...] = Field((), examples=[], description="meshes of gears between them")
    excitation: tuple[Excitation, ...] = Field((), examples=[], description="torques on nodes")


LISTS: tuple[type[FileTable], ...] = (Node, ChainShaft, Gear, Excitation)


# ------------------------------------------------------------------ contradictions between tables


KEYS = ("node", "shaft", "gear", "excitation")


# Keys that name nodes, in each kind of table.
_ENDS = {"shaft": ("from", "to"), "gear": ("from", "to"), "excitation": ("node",)}


def describes_chain(data: Mapping[str, object]) -> bool:
    """Return whether the tables of a file describe a chain, not an engine."""
    of_engine = {"crank", "piston", "rod", "engine"}
    return any(key in data for key in KEYS) and of_engine.isdisjoint(data)


def read_chain_tables(data: Mapping[str, object], file: str = "") -> ChainFile:
    """Return the chain that the tables of a file describe; `file` is the file's name in messages.

    Raises:
        InputError: The file has mistakes; the error lists all of them.
    """
    reader = TableReader(CHAIN.name)
    head = {key: value for key, value in data.items() if key not in KEYS}
    model = reader.read_table("", head | {"node": []}, ChainFile)
    lists = {}
    for key, table in zip(KEYS, LISTS, strict=True):
        most = MOST_TORSION_NODES if key == "node" else MOST_LIST_VALUES
        lists[key] = reader.read_list(key, data.get(key, []), table, most)
    reader.problems += _find_misfits(data)
    if reader.problems or model is None:
        raise reader.refusal(file)
    return model.model_copy(update=lists)


def _find_misfits(data: Mapping[str, object]) -> Iterator[Problem]:
    """Yield contradictions between the tables."""
    nodes = _tables(data, "node")
    if data.get("node", []) == []:
        hint = 'write [[node]] for every inertia, such as name = "flywheel"'
        yield Problem.of_missing("node", hint)
        return
    names = [node.get("name") for _, node in nodes]
    known_names = [name for name in names if isinstance(name, str)]
    for k, node in nodes:
        name = node.get("name")
        if isinstance(name, str) and name in names[: k - 1]:
            yield Problem(f"node.{k}.name", f"{shorten(name)} is given twice; rename one of them")
    fixed = data.get("fixed", ())
    named = [("fixed", name) for name in (fixed if isinstance(fixed, list) else ())]
    for key, ends in _ENDS.items():
        for k, table in _tables(data, key):
            named += [(f"{key}.{k}.{end}", table.get(end)) for end in ends]
            start = table.get("from")
            end = table.get("to")
            if isinstance(start, str) and start == end:
                text = f"goes from {shorten(start)} to itself; give two different nodes"
                yield Problem(f"{key}.{k}", text)
    for path, name in named:
        if isinstance(name, str) and name not in known_names:
            yield Problem(path, refuse_node(name, known_names))


def refuse_node(name: str, nodes: Sequence[str]) -> str:
    """Return the message about a name that no node has.

    Args:
        name: Name in the file.
        nodes: Names of the nodes.
    """
    listed = ", ".join(printable(each) for each in dict.fromkeys(nodes[:8])) or "none"
    return f"{shorten(name)} is not a node; {suggest_nearest(name, nodes, f'there are {listed}')}"


def _tables(data: Mapping[str, object], key: str) -> list[tuple[int, Mapping[str, object]]]:
    """Return the members of a list that are tables, with their numbers."""
    value = data.get(key)
    items = enumerate(value, 1) if isinstance(value, list) else ()
    return [(k, item) for k, item in items if isinstance(item, Mapping)]
