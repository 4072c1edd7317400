"""List parts that turn at other speeds than multiples of half the crank speed, such as an
alternator behind a belt.

They have no fixed phase to the crank, because belts creep, so they are no devices of the engine:
their forces are listed as amplitudes. With the unbalance U and the ratio k, a part makes the force
`F = U (k omega)^2` (omega: crank speed), the moment `|z - z_ref| F` and the couple about z
`|p - p_ref| F` (p: place x + iy of its axis; z_ref, p_ref: point of reference).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ..core.cylinders import Device
from ..engine.devices import build_device, group_eccentrics
from ..engine.engine import Engine
from ..file.fields import order_number
from ..file.model import EngineFile
from ..show.figures import FigureRow, Peaks, record_rows
from ..show.sheet import Column, Grid, number, unit_cell
from ..show.units import System
from .records import PartAtOtherSpeed

_NOTE = (
    "Amplitudes. These parts have no fixed phase to the crank, so they are no part of the orders "
    "above; the phase drifts through all values."
)


def find_other_speeds(engine: Engine) -> tuple[PartAtOtherSpeed, ...]:
    """Return the parts at other speeds, in the order of the file. Eccentrics of one shaft are one
    part, because they keep their phase to each other.

    Args:
        engine: One engine, not an array of variants.
    """
    parts = []
    for crank in engine.cranks if engine.placed else ():
        for name, devices, ratio in _list_drifting(crank.engine.model):
            placed = [crank.find_device(device) for device in devices]
            parts.append(_describe(engine, f"{crank.name} {name}", placed, ratio))
    for name, devices, ratio in _list_drifting(engine.model):
        parts.append(_describe(engine, name, devices, ratio))
    return tuple(parts)


def add_at_most(peaks: Peaks, parts: Sequence[PartAtOtherSpeed]) -> Peaks:
    """Return the peaks with the sizes that they have at most with parts at other speeds."""
    if not parts:
        return peaks
    moments = [part.moment_Nm for part in parts if part.moment_Nm is not None]
    return peaks._replace(
        force_at_most_N=peaks.force.value + sum(part.force_N for part in parts),
        moment_at_most_Nm=peaks.moment.value + sum(moments) if moments else None,
    )


def _list_drifting(
    model: EngineFile | None,
) -> Iterator[tuple[str, list[Device], float]]:
    """Yield name, eccentrics and speed ratio of each shaft without a fixed phase to the crank."""
    for name, entries in group_eccentrics(() if model is None else model.shaft):
        tables = [*entries.values()]
        if tables[0].drifts:
            yield name, [build_device(table, 0.0) for table in tables], tables[0].ratio


def _describe(
    engine: Engine, name: str, devices: Sequence[Device], ratio: float
) -> PartAtOtherSpeed:
    """Return the sizes of a shaft with these eccentrics, in the axes of the whole engine."""
    speed = abs(ratio) * float(engine.omega)
    x, y, z = (float(place) for place in engine.reference_m)
    forces = np.array([complex(d.forward + d.backward) for d in devices]) * speed**2
    arms = np.array([float(d.z) - z for d in devices])
    force = float(abs(forces.sum()))
    apart = abs(complex(devices[0].place) - complex(x, y))
    return PartAtOtherSpeed(
        name=name,
        ratio=order_number(ratio),
        frequency_Hz=speed / (2 * math.pi),
        force_N=force,
        moment_Nm=float(abs(forces @ arms)) if engine.places_known else None,
        couple_Nm=apart * force,
    )


def lay_out_other_speeds(parts: Sequence[PartAtOtherSpeed], system: System) -> Grid:
    """Return a table with one row for each part at another speed."""
    force = system.force.fit_values(part.force_N for part in parts)
    moment = system.moment
    heads = [
        Column("shaft", words=True),
        Column("times crank speed"),
        Column("Hz"),
        Column(f"force, {force.name}"),
        Column(f"moment, {moment.name}"),
        Column(f"couple, {moment.name}"),
    ]
    rows = []
    for part in parts:
        cells = (
            part.name,
            f"{part.ratio:g}",
            number(part.frequency_Hz),
            unit_cell(part.force_N, force),
            unit_cell(part.moment_Nm, moment),
            unit_cell(part.couple_Nm, moment),
        )
        rows.append(cells)
    return Grid.of_rows("Parts at other speeds", heads, rows, _NOTE)


def list_other_rows(parts: Sequence[PartAtOtherSpeed]) -> Iterator[FigureRow]:
    """Yield every figure of parts at other speeds in SI units."""
    for part in parts:
        yield from record_rows(0, f"other speed {part.name}", None, part, "name")
