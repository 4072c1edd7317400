"""Compute the initial unbalance of a crankshaft in its correction planes, as the tolerances of its
webs allow it, and the capacity of the holes that can be drilled there.

The lever rule divides the deviation of each web between the planes, with the shares p. The worst
initial unbalance of a plane is `sum |p| worst`, and `sqrt(sum (p rss)^2)` is the one to expect.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from ..core.loads import share_by_lever
from ..core.phasors import Array
from ..core.records import HIDDEN
from ..engine.engine import Engine, take_model
from ..sizing.options import SchemeOptions
from ..sizing.planes import find_ends, read_planes
from ..sizing.remedy import Remedy
from ..sizing.workshop import HoleRow, Tools, plan_hole_row


class InitialPlane(NamedTuple):
    """Initial unbalance of a crankshaft in a correction plane.

    Attributes:
        position_mm: Position of the plane along the crankshaft.
        worst_kg_m: Largest unbalance within the tolerances of the webs.
        rss_kg_m: Root of the sum of squares of the unbalances by each dimension.
        capacity_kg_m: Unbalance that the holes of a plane can remove; left out without a drill.
        permitted_kg_m: Residual unbalance that a grade permits in the plane; left out without a
            grade.
        enough: Whether the holes can remove the worst unbalance; left out without a drill.
    """

    position_mm: float
    worst_kg_m: float
    rss_kg_m: float
    capacity_kg_m: float | None = None
    permitted_kg_m: float | None = None
    enough: bool | None = None


@dataclass(frozen=True, kw_only=True)
class InitialUnbalance:
    """Initial unbalance of a crankshaft in its correction planes.

    Attributes:
        planes: The correction planes, from the free end.
        holes: The holes of each plane; empty without a drill.
        exact: Numbers of the webs without tolerances.
    """

    planes: tuple[InitialPlane, ...]
    holes: Annotated[tuple[HoleRow, ...], HIDDEN] = ()
    exact: Annotated[tuple[int, ...], HIDDEN] = ()


class _Deviations(NamedTuple):
    """Places of the webs along the crankshaft, m, and the deviations of their unbalances, kg m,
    each of shape (webs,); and the numbers of the webs without tolerances, which count as exact.
    """

    places: Array
    worst: Array
    rss: Array
    exact: tuple[int, ...]


def choose_correction_planes(engine: Engine, options: SchemeOptions | None) -> tuple[float, ...]:
    """Return the given planes of a scheme (z, m), ascending, each once; without them, both ends."""
    if options is None or options.planes is None:
        return find_ends(engine)
    return tuple(sorted(set(read_planes(engine, options))))


def find_initial(
    engine: Engine,
    remedy: Remedy,
    planes: tuple[float, ...],
    tools: Tools,
    permitted_kg_m: float | None = None,
) -> InitialUnbalance | None:
    """Return the initial unbalance of a crankshaft; None without tolerances of webs.

    Args:
        engine: Engine without new devices.
        remedy: New devices, whose planes limit the room for holes.
        planes: Correction planes (z, m), ascending.
        tools: Tools of the workshop.
        permitted_kg_m: Residual unbalance that is permitted in all planes together, kg m; None: no
            grade is given.
    """
    deviations = _list_deviations(engine)
    if deviations is None:
        return None
    shares = np.abs(share_by_lever(deviations.places, np.array(planes)))
    worst = shares @ deviations.worst
    rss = np.sqrt(shares**2 @ deviations.rss**2)
    holes = []
    rows = []
    for z, largest, expected in zip(planes, worst.tolist(), rss.tolist(), strict=True):
        plane = InitialPlane(round(1e3 * z, 9) + 0.0, largest, expected)
        if (hole_row := plan_hole_row(engine, remedy, tools, z)) is not None:
            holes.append(hole_row)
            capacity = hole_row.unbalance
            plane = plane._replace(capacity_kg_m=capacity, enough=capacity >= largest)
        if permitted_kg_m is not None:
            plane = plane._replace(permitted_kg_m=permitted_kg_m / len(planes))
        rows.append(plane)
    return InitialUnbalance(planes=tuple(rows), holes=tuple(holes), exact=deviations.exact)


def _list_deviations(engine: Engine) -> _Deviations | None:
    """Return the deviations of all webs; None if no web has tolerances."""
    if engine.webs is None:
        return None
    from ..engine.webs.tolerance import find_deviation

    tables = take_model(engine).web
    places = []
    worst = []
    rss = []
    exact = []
    for web in engine.webs.webs:
        deviation = find_deviation(tables[web.table - 1], web.body.shape)
        places.append(float(web.z))
        worst.append(0.0 if deviation is None else deviation.worst)
        rss.append(0.0 if deviation is None else deviation.rss)
        if deviation is None:
            exact.append(web.number)
    if not math.fsum(worst):
        return None
    return _Deviations(np.array(places), np.array(worst), np.array(rss), tuple(exact))
