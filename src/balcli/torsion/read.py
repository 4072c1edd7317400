"""Read and check a chain file; all mistakes are reported at once by their paths."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ..errors import Problem
from ..file.fields import printable, shorten, suggest_nearest
from ..file.messages import CHAIN
from ..file.read import TableReader
from ..limits import MOST_LIST_VALUES, MOST_TORSION_NODES
from .tables import LISTS, ChainFile

KEYS = ("node", "shaft", "gear", "excitation")


# Keys that name nodes, in each kind of table.
_ENDS = {"shaft": ("from", "to"), "gear": ("from", "to"), "excitation": ("node",)}


def describes_chain(data: Mapping[str, object]) -> bool:
    """Return whether the tables of a file describe a chain, not an engine."""
    return any(key in data for key in KEYS) and not ({"crank", "piston", "rod"} & set(data))


def read_chain_tables(data: Mapping[str, object], file: str = "") -> ChainFile:
    """Return the chain that the tables of a file describe; `file` is its name in messages.

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
            yield Problem(f"node.{k}.name", f"{shorten(name)} is given twice; rename one of them")
    fixed = data.get("fixed", ())
    named = [("fixed", name) for name in (fixed if isinstance(fixed, list) else ())]
    for key, ends in _ENDS.items():
        for k, table in _tables(data, key):
            named += [(f"{key}.{k}.{end}", table.get(end)) for end in ends]
            start, end = table.get("from"), table.get("to")
            if isinstance(start, str) and start == end:
                text = f"goes from {shorten(start)} to itself; it joins two nodes"
                yield Problem(f"{key}.{k}", text)
    for path, name in named:
        if isinstance(name, str) and name not in known:
            yield Problem(path, refuse_node(name, known))


def refuse_node(name: str, known: Sequence[str]) -> str:
    """Return the message about a name that no node has.

    Args:
        name: Name in the file.
        known: Names of the nodes.
    """
    listed = ", ".join(printable(each) for each in dict.fromkeys(known[:8])) or "none"
    return f"{shorten(name)} is not a node; {suggest_nearest(name, known, f'there are {listed}')}"


def _tables(data: Mapping[str, object], key: str) -> list[tuple[int, Mapping[str, object]]]:
    """Return the members of a list that are tables, with their numbers."""
    value = data.get(key)
    items = enumerate(value, 1) if isinstance(value, list) else ()
    return [(k, item) for k, item in items if isinstance(item, Mapping)]
