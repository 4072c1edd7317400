"""Define assumed values: values that are used because a file leaves their keys out.

`engine.left_out` lists them for an engine. A chapter selects those on which its results depend, and
a result of several engines joins their lists. Documents contain the records, and
`show.sheet.tell_assumed` puts them into words.
"""

from collections.abc import Collection, Iterable, Sequence
from typing import NamedTuple, TypeAlias

from .table import FileTable

Value: TypeAlias = float | bool | str | tuple[float, ...] | tuple[tuple[int, ...], ...]


class Assumed(NamedTuple):
    """A value that is used because the file leaves its key out.

    Attributes:
        path: Dotted name of the key, such as `rod.cg`.
        value: Value in the form of the file, or a description of the value.
        unit: Unit of the value; left out if it has none.
        engine: Name of the engine for which the value is used; left out if it holds for every
            engine of the result.
    """

    path: str
    value: Value
    unit: str | None = None
    engine: str | None = None

    @property
    def table(self) -> str:
        """Table of the key, such as `rod`."""
        return self.path.partition(".")[0]


def assume(path: str, table: FileTable, value: Value) -> Assumed:
    """Return the assumed value of a key, with the unit in which files give this key.

    Args:
        path: Dotted name of the key.
        table: Table that leaves the key out.
        value: Value in this unit.
    """
    key = path.rpartition(".")[2]
    return Assumed(path, value, table.find_unit(key) or None)


# Tables on which only the results of certain commands depend.
_OF_CHAPTERS = {"gas", "torsion", "body", "mount", "flywheel"}
# Tables on which only forces and moments depend, and on counterweights the loads of main bearings.
DEVICES = ("counterweight", "shaft", "slider")
# Keys and tables on which the torque at steady speed does not depend.
STEADY = ("crank.spacing", "layout.stagger", "crank.throw_mass", "crank.inertia", *DEVICES)


def select_assumed(
    inferred: Iterable[Assumed], chapters: Collection[str], without: Collection[str] = ()
) -> tuple[Assumed, ...]:
    """Return the assumed values on which certain results depend.

    Args:
        inferred: Values from `engine.left_out.list_inferred`.
        chapters: Which of the tables gas, torsion, body, mount and flywheel the results depend on;
            each is needed by some results only.
        without: Keys and tables to omit.
    """
    idle = _OF_CHAPTERS.difference(chapters).union(without)
    return tuple(one for one in inferred if idle.isdisjoint((one.path, one.table)))


def join_assumed(
    names: Sequence[str], of_engines: Sequence[Sequence[Assumed] | None]
) -> tuple[Assumed, ...]:
    """Return the assumed values of several engines: first the values that all engines have, then
    those of single engines, with the name of the engine.

    Args:
        names: Names of the engines.
        of_engines: Values of each engine; None: there are none.
    """
    lists = [values or () for values in of_engines]
    first = lists[0] if lists else ()
    common = [value for value in first if all(value in values for values in lists)]
    joined = [*common]
    for name, values in zip(names, lists, strict=True):
        joined += [_assign(value, name) for value in values if value not in common]
    return tuple(joined)


def _assign(value: Assumed, name: str) -> Assumed:
    """Return an assumed value with the name of its engine. If this engine consists of several
    engines that are geared together, the name of the one with this value follows.
    """
    return value._replace(engine=name if value.engine is None else f"{name}, {value.engine}")
