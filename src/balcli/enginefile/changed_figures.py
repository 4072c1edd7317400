"""An engine file with other figures in some of its tables, by their dotted names."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from ..errors import InputError, Problem
from .model import EngineFile, FileTable, change_figure, label_table


def change_figures(
    model: EngineFile, values: Mapping[str, float], tables: Collection[str]
) -> EngineFile:
    """The file with other figures in tables of these kinds (`mount.left.stiffness.2`,
    `torsion.rear.1.inertia`); those of all others are left alone.

    Raises:
        InputError: what a table then says against itself, such as a bore wider than its shaft.
    """
    varied = {
        path: _number_members(model, path) for path in values if path.partition(".")[0] in tables
    }
    for path, keys in varied.items():
        model = change_figure(model, keys, values[path])
    faults = [fault for path, keys in varied.items() for fault in _find_faults(model, path, keys)]
    if faults:
        raise InputError(list(dict.fromkeys(faults)))
    return model


def _number_members(model: EngineFile, path: str) -> list[str]:
    """The keys that lead to a figure; a table of several by its number."""
    kind, member, *rest = path.split(".")
    tables = getattr(model, kind)
    if isinstance(tables, tuple):
        labels = [label_table(table, number) for number, table in enumerate(tables, 1)]
        member = str(labels.index(member) + 1)
    return [kind, member, *rest]


def _find_faults(model: EngineFile, path: str, keys: Sequence[str]) -> Iterator[Problem]:
    """What tables say against themselves on the way to a figure."""
    names, place = path.split("."), getattr(model, keys[0])
    for depth, key in enumerate(keys[1:], 1):
        if isinstance(place, FileTable):
            name = ".".join(names[:depth])
            yield from (Problem(name, fault) for fault in place.list_faults())
            place = getattr(place, key)
        else:
            place = place[int(key) - 1]
