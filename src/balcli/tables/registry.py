"""Which tables there are, and what each may be asked."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from difflib import get_close_matches

from ..errors import BalcliError
from . import kvasnikov, liang, liu, series, tsinghua, wang
from .options import Options
from .printed import Print, load
from .table import Erratum, Table


@dataclass(frozen=True)
class Entry:
    """How a table is computed, and which options it takes."""

    compute: Callable[[Print, Options], Table]
    takes: tuple[str, ...] = ()


REGISTRY: dict[str, Entry] = {
    "tsinghua-1-1": Entry(tsinghua.engines),
    "tsinghua-1-2": Entry(tsinghua.travel, ("lambda", "angle")),
    "tsinghua-1-3": Entry(tsinghua.speed, ("lambda", "angle")),
    "tsinghua-1-4": Entry(tsinghua.extremes, ("lambda",)),
    "tsinghua-1-5": Entry(tsinghua.mean_speeds),
    "tsinghua-1-6": Entry(tsinghua.acceleration, ("lambda", "angle")),
    "liu-1": Entry(liu.paths),
    "liu-2": Entry(liu.vectors),
    "liu-3": Entry(liu.sliders),
    "wang-1": Entry(wang.optimum),
    "kvasnikov-1": Entry(kvasnikov.piston, ("lambda",)),
    "kvasnikov-2": Entry(kvasnikov.rod, ("lambda",)),
    "liang-examples": Entry(liang.examples),
    "series": Entry(series.coefficients, ("power",)),
}
NAMES = tuple(REGISTRY)


def recompute(name: str, options: Options | None = None) -> Table:
    """A table by its name.

    Raises:
        BalcliError: there is no such table, or it does not take an option that is given.
    """
    entry = REGISTRY.get(name)
    if entry is None:
        near = get_close_matches(name, NAMES, n=1, cutoff=0.0)[0]
        raise BalcliError(f"no table {name!r}; the nearest name is {near!r}. Tables: {', '.join(NAMES)}")
    asked = options or Options()
    for option in asked.given():
        if option not in entry.takes:
            takes = " and ".join(f"--{o}" for o in entry.takes) or "no other range"
            raise BalcliError(f"--{option}: table {name} takes {takes}")
    return entry.compute(load(name), asked)


def all_errata() -> Iterator[tuple[str, Erratum]]:
    """Every erratum of every table, with the table's name."""
    return ((name, erratum) for name in NAMES for erratum in recompute(name).errata)
