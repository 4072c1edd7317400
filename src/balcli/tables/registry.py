"""Which tables there are, and what each may be asked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..enginefile.fields import nearest
from ..errors import BalcliError
from . import kvasnikov, layouts, liang, liu, series, tsinghua, wang
from .options import Options
from .printed import Print, load
from .ranges import crank_ratios, headings
from .table import Table


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
    "layouts": Entry(layouts.textbook),
}
NAMES = tuple(REGISTRY)


def recompute(name: str, options: Options | None = None) -> Table:
    """A table by its name.

    Raises:
        BalcliError: there is no such table, or it does not take an option that is given.
    """
    entry = REGISTRY.get(name)
    if entry is None:
        near = nearest(name, NAMES)
        raise BalcliError(
            f"no table {name!r}{f'; the nearest name is {near!r}' if near else ''}. Tables: "
            f"{', '.join(NAMES)}"
        )
    asked = options or Options()
    for option in asked.given():
        if option not in entry.takes:
            takes = " and ".join(f"--{o}" for o in entry.takes) or "no other range"
            raise BalcliError(f"--{option}: table {name} takes {takes}")
    return entry.compute(load(name), asked)


def select(
    name: str | None, lam: str | None = None, angle: str | None = None, power: int | None = None
) -> list[Table]:
    """The table of this name, or all of them; ranges as text (`0.20:0.40:0.01`).

    Raises:
        BalcliError: no such table or range, an option that the table does not take, or a range
        without a name.
    """
    options = Options(
        crank_ratios(lam) if lam else None, headings(angle, "--angle") if angle else None, power
    )
    if name is None and options.given():
        some = ", ".join(_taking(options)) or "these do not go together"
        raise BalcliError(f"--{options.given()[0]}: name the table that it is for ({some})")
    return [recompute(name, options)] if name else [recompute(each) for each in NAMES]


def _taking(options: Options) -> list[str]:
    return [name for name, entry in REGISTRY.items() if set(options.given()) <= set(entry.takes)]
