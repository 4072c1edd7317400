"""Show the ends of double-acting cylinders and compressors, and loads along the piston rods."""

from __future__ import annotations

from collections.abc import Sequence

from ..show.sheet import UNKNOWN, Column, Grid, number
from ..show.units import System
from .ends import End
from .rod_loads import RodLoad, RodPeaks

_VALVES = (
    "Valves are ideal. Rod loads of API 618 count valve losses: give the pressures in the "
    "cylinder, not those in the line."
)


def show_ends(ends: Sequence[End], system: System) -> Grid:
    """Return the table of the ends of all cylinders."""
    volume = system.end_volume
    flow = system.flow
    power = system.power.fit(max((abs(end.power_W) for end in ends), default=0.0))
    efficiencies = []
    capacities = []
    for end in ends:
        compresses = end.volumetric_efficiency is not None
        efficiencies.append(number(end.volumetric_efficiency or 0.0) if compresses else UNKNOWN)
        capacities.append(number(flow.of(end.capacity_m3_per_s or 0.0)) if compresses else UNKNOWN)
    pressure = system.pressure.fit(max((abs(end.imep_Pa) for end in ends), default=0.0))
    columns = [
        Column("cylinder", [str(end.cylinder) for end in ends], words=True),
        Column("end", [end.end for end in ends], words=True),
        Column(f"swept, {volume.name}", [number(volume.of(end.swept_volume_m3)) for end in ends]),
        Column("vol. efficiency", efficiencies),
        Column(f"capacity, {flow.name}", capacities),
        Column(f"mean pressure, {pressure.name}", [number(pressure.of(e.imep_Pa)) for e in ends]),
        Column(f"power, {power.name}", [number(power.of(end.power_W)) for end in ends]),
    ]
    return Grid("Ends", columns, _VALVES if any(end.capacity_m3_per_s for end in ends) else "")


def show_rod_loads(loads: Sequence[RodLoad], system: System) -> Grid:
    """Return the table of loads along the piston rods."""
    unit = system.force.fit(max((_find_largest(load) for load in loads), default=0.0))
    columns = [Column("cylinder", [str(load.cylinder) for load in loads], words=True)]
    for head, key in (
        ("gas", "gas"),
        ("inertia", "inertia"),
        ("rod", "piston_rod"),
        ("pin", "pin"),
    ):
        peaks: list[RodPeaks] = [getattr(load, key) for load in loads]
        columns.append(Column(f"{head} c", [number(unit.of(each.compression_N)) for each in peaks]))
        columns.append(Column(f"{head} t", [number(unit.of(each.tension_N)) for each in peaks]))
    reversals = [load.reversal for load in loads]
    failing = [k for k, each in enumerate(reversals) if not each.reverses]
    spans = [f"{each.longest_deg:.1f}" for each in reversals]
    columns.append(Column("reversal, deg", spans, marked=failing))
    columns.append(Column("share", [number(each.ratio, 3) for each in reversals], marked=failing))
    guides = [max(abs(load.guide.max_N), abs(load.guide.min_N)) for load in loads]
    columns.append(Column("guide", [number(unit.of(guide)) for guide in guides]))
    return Grid(f"Rod load, {unit.name}", columns, _judge(loads))


def _find_largest(load: RodLoad) -> float:
    peaks = (load.gas, load.inertia, load.piston_rod, load.pin)
    return max(max(each.compression_N, each.tension_N) for each in peaks)


def _judge(loads: Sequence[RodLoad]) -> str:
    """Return the cylinder that reverses least, and whether it reverses."""
    worst = min(
        loads,
        key=lambda load: (load.reversal.reverses, load.reversal.longest_deg, load.reversal.ratio),
    )
    reversal = worst.reversal
    word = "reverses" if reversal.reverses else "does not reverse"
    return (
        f"c: compression, t: tension. The pin of cylinder {worst.cylinder} has the least reversal: "
        f"{reversal.longest_deg:.1f} deg and a share of {number(reversal.ratio, 3)}; it {word} "
        "(API 618, 5th edition: at least 15 deg and 0.03)."
    )
