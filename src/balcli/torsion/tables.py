"""What a chain file may say: inertias on shafts and gears, and what excites them. It knows no
engine.

Units: kg mm2, N m/rad, N m s/rad, mm, GPa, N m, N/mm2; a string carries its own.

A chain file -> model: every mistake at once, by its path and with what would be right.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any

from pydantic import Field

from ..errors import Problem
from ..file.fields import Number, printable, shorten, suggest_nearest
from ..file.messages import CHAIN
from ..file.read import TableReader
from ..file.table import FileTable, Name
from ..file.torsion_tables import ChainKeys, Damping, NodeKeys, ShaftKeys, SpeedRatio
from ..file.units import PLAIN, TORQUE
from ..limits import HIGHEST_TORSION_ORDER, MOST_LIST_VALUES, MOST_TORSION_NODES

Torque = Annotated[float, Number(TORQUE, most=1e18)]


class _HalfOrder(Number):
    """An order: a multiple of 1/2."""

    def __init__(self) -> None:
        super().__init__(PLAIN, above=0, most=HIGHEST_TORSION_ORDER)

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
    """A torque on a node, `cos * cos(n t) + sin * sin(n t)`, t the angle of the first node."""

    node: Name = Field(examples=["crank"], description="name of the node on which it acts")
    order: Annotated[float, _HalfOrder()] = Field(
        examples=[1.5], description="how often in a turn of the first node; a multiple of 0.5"
    )
    cos: Torque = Field(0.0, examples=[120], description="amplitude of its cosine")
    sin: Torque = Field(0.0, examples=[-35], description="amplitude of its sine")


class ChainFile(ChainKeys):
    """Inertias on shafts and gears, and what excites them."""

    name: Name | None = Field(None, examples=["pump drive"], description="what to call it")
    fixed: tuple[Name, ...] = Field(
        (), examples=[["hull"]], max_length=MOST_TORSION_NODES, description="nodes that are clamped"
    )
    node: tuple[Node, ...] = Field(examples=[], description="the nodes; the first gives the speed")
    shaft: tuple[ChainShaft, ...] = Field((), examples=[], description="the shafts between them")
    gear: tuple[Gear, ...] = Field((), examples=[], description="meshes of gears between them")
    excitation: tuple[Excitation, ...] = Field((), examples=[], description="torques on nodes")

    def list_losses(self) -> Iterator[tuple[str, float | None]]:
        """Loss factors of all shafts and dampers, by their paths."""
        yield "loss", self.loss
        for number, shaft in enumerate(self.shaft, 1):
            yield f"shaft.{number}.loss", shaft.loss
        for number, node in enumerate(self.node, 1):
            if node.damper is not None:
                yield f"node.{number}.damper.loss", node.damper.loss


LISTS: tuple[type[FileTable], ...] = (Node, ChainShaft, Gear, Excitation)
KEYS = ("node", "shaft", "gear", "excitation")
# keys of these tables that name nodes
_ENDS = {"shaft": ("from", "to"), "gear": ("from", "to"), "excitation": ("node",)}


def describes_chain(data: Mapping[str, Any]) -> bool:
    """Whether tables of a file are those of a chain, not of an engine."""
    return any(key in data for key in KEYS) and not ({"crank", "piston", "rod"} & set(data))


def read_chain_tables(data: Mapping[str, Any], file: str = "") -> ChainFile:
    """The chain that the tables of a file describe; `file` is its name in messages.

    Raises:
        InputError: with every mistake.
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


# ------------------------------------------------------------------ what does not fit together
def _find_misfits(data: Mapping[str, Any]) -> Iterator[Problem]:
    """What the tables say against each other, as far as they can be read."""
    nodes = _tables(data, "node")
    if "node" not in data:
        hint = 'write [[node]] for every inertia, such as name = "flywheel"'
        yield Problem.of_missing("node", hint)
        return
    if data["node"] == []:
        yield Problem("node", "is an empty list; a chain has at least one node")
    names = [node.get("name") for _, node in nodes]
    known = [name for name in names if isinstance(name, str)]
    for k, node in nodes:
        name = node.get("name")
        if isinstance(name, str) and name in names[: k - 1]:
            yield Problem(f"node.{k}.name", f"{shorten(name)} is there twice; give each its own")
    for key, ends in _ENDS.items():
        for k, table in _tables(data, key):
            yield from _check_ends(f"{key}.{k}", table, ends, known)
    fixed = data.get("fixed", ())
    for name in fixed if isinstance(fixed, list) else ():
        if isinstance(name, str) and name not in known:
            yield Problem("fixed", _refuse_node(name, known))


def _check_ends(
    path: str, table: Mapping[str, Any], ends: Sequence[str], known: Sequence[str]
) -> Iterator[Problem]:
    named = [table.get(end) for end in ends]
    for end, name in zip(ends, named, strict=True):
        if isinstance(name, str) and name not in known:
            yield Problem(f"{path}.{end}", _refuse_node(name, known))
    if len(named) == 2 and isinstance(named[0], str) and named[0] == named[1]:
        yield Problem(path, f"goes from {shorten(named[0])} to itself; it joins two nodes")


def _refuse_node(name: str, known: Sequence[str]) -> str:
    """Return what is wrong with a name that no node has."""
    listed = ", ".join(printable(each) for each in dict.fromkeys(known[:8])) or "none"
    return f"{shorten(name)} is no node; {suggest_nearest(name, known, f'there are {listed}')}"


def _tables(data: Mapping[str, Any], key: str) -> list[tuple[int, Mapping[str, Any]]]:
    """The tables of a list with their numbers, those that are tables."""
    value = data.get(key)
    items = enumerate(value, 1) if isinstance(value, list) else ()
    return [(k, item) for k, item in items if isinstance(item, Mapping)]
