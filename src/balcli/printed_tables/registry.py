"""Which tables there are, and what each may be asked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..enginefile.fields import nearest
from ..errors import BalcliError
from . import kvasnikov, layouts, liang, liu, series_coefficients, torque_examples, tsinghua, wang
from .printed import Print, load_print
from .ranges import Ranges, parse_crank_ratios, parse_range
from .recomputed import Table


@dataclass(frozen=True)
class Entry:
    """How a table is computed, and which options it takes."""

    compute: Callable[[Print, Ranges], Table]
    takes: tuple[str, ...] = ()


REGISTRY: dict[str, Entry] = {
    "tsinghua-1-1": Entry(tsinghua.tabulate_engines),
    "tsinghua-1-2": Entry(tsinghua.tabulate_travel, ("lambda", "angle")),
    "tsinghua-1-3": Entry(tsinghua.tabulate_speed, ("lambda", "angle")),
    "tsinghua-1-4": Entry(tsinghua.tabulate_extremes, ("lambda",)),
    "tsinghua-1-5": Entry(tsinghua.tabulate_mean_speeds),
    "tsinghua-1-6": Entry(tsinghua.tabulate_acceleration, ("lambda", "angle")),
    "liu-1": Entry(liu.tabulate_paths),
    "liu-2": Entry(liu.tabulate_vectors),
    "liu-3": Entry(liu.tabulate_sliders),
    "wang-1": Entry(wang.tabulate_optimum),
    "kvasnikov-1": Entry(kvasnikov.tabulate_piston, ("lambda",)),
    "kvasnikov-2": Entry(kvasnikov.tabulate_rod, ("lambda",)),
    "liang-examples": Entry(liang.tabulate_liang_examples),
    "torque-examples": Entry(torque_examples.tabulate_torque_examples),
    "series": Entry(series_coefficients.tabulate_series, ("power",)),
    "layouts": Entry(layouts.tabulate_layouts),
}
NAMES = tuple(REGISTRY)
OTHER_NAMES = {"layout": "layouts", "bosch": "layouts"}  # what people look for


def recompute(name: str, ranges: Ranges | None = None) -> Table:
    """A table by its name.

    Raises:
        BalcliError: there is no such table, or it does not take an option that is given.
    """
    name = OTHER_NAMES.get(name.lower(), name)
    entry = REGISTRY.get(name)
    if entry is None:
        if several := [each for each in NAMES if each.startswith(f"{name.lower()}-")]:
            raise BalcliError(f"{name!r} is the source of {', '.join(several)}: name one")
        near = nearest(name, NAMES)
        raise BalcliError(
            f"no table {name!r}{f'; the nearest name is {near!r}' if near else ''}. Tables: "
            f"{', '.join(NAMES)}"
        )
    asked = ranges or Ranges()
    for option in asked.given():
        if option not in entry.takes:
            takes = " and ".join(f"--{o}" for o in entry.takes) or "no other range"
            raise BalcliError(f"--{option}: table {name} takes {takes}")
    return entry.compute(load_print(name), asked)


def select_tables(
    name: str | None, lam: str | None = None, angle: str | None = None, power: int | None = None
) -> list[Table]:
    """The table of this name, or all of them; ranges as text (`0.20:0.40:0.01`).

    Raises:
        BalcliError: no such table or range, an option that the table does not take, or a range
        without a name.
    """
    lams = parse_crank_ratios(lam) if lam else None
    angles = parse_range(angle, "--angle") if angle else None
    ranges = Ranges(lams, angles, power)
    if name is not None:
        return [recompute(name, ranges)]
    if ranges.given():
        some = ", ".join(_names_taking(ranges)) or "these do not go together"
        raise BalcliError(f"--{ranges.given()[0]}: name the table that it is for ({some})")
    return [recompute(each) for each in NAMES]


def _names_taking(ranges: Ranges) -> list[str]:
    """The tables that take all of these options."""
    given = set(ranges.given())
    return [name for name, entry in REGISTRY.items() if given <= set(entry.takes)]
