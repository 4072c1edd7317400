"""Show the ends of double-acting cylinders and compressors, and loads along the piston rods."""

from __future__ import annotations

from collections.abc import Sequence

from ..show.sheet import Column, Grid, number, unit_cell
from ..show.units import System
from .ends import End
from .rod_loads import RodLoad, RodPeaks

_VALVES = (
    "Valves are ideal. Rod loads of API 618 count valve losses: give the pressures in the "
    "cylinder, not those in the line."
)
_COLUMNS = (
    "c: largest load in compression, t: in tension. gas: force on the piston; inertia: of piston "
    "and crosshead; rod: piston rod, gas and inertia of the piston; pin: crosshead pin (or piston "
    "pin), gas and inertia of piston and crosshead. reversal: longest span of the pin's load with "
    "the sign that lasts shorter in all; share: smaller of its two peaks over the larger. guide: "
    "largest force on the guide."
)


def show_ends(ends: Sequence[End], system: System) -> Grid:
    """Return the table of the ends of all cylinders."""
    volume = system.end_volume
    flow = system.flow
    power = system.power.fit_values(end.power_W for end in ends)
    pressure = system.pressure.fit_values(end.imep_Pa for end in ends)
    heads = [
        Column("cylinder", words=True),
        Column("end", words=True),
        Column(f"swept, {volume.name}"),
        Column("vol. efficiency"),
        Column(f"capacity, {flow.name}"),
        Column(f"mean pressure, {pressure.name}"),
        Column(f"power, {power.name}"),
    ]
    rows = []
    for end in ends:
        cells = (
            str(end.cylinder),
            end.end,
            unit_cell(end.swept_volume_m3, volume),
            number(end.volumetric_efficiency),
            unit_cell(end.capacity_m3_per_s, flow),
            unit_cell(end.imep_Pa, pressure),
            unit_cell(end.power_W, power),
        )
        rows.append(cells)
    compresses = any(end.capacity_m3_per_s for end in ends)
    return Grid.of_rows("Ends", heads, rows, _VALVES if compresses else "")


def show_rod_loads(loads: Sequence[RodLoad], system: System) -> Grid:
    """Return the table of loads along the piston rods."""
    unit = system.force.fit_values(map(_find_largest, loads))
    rows = []
    failing = []
    for k, load in enumerate(loads):
        row = [str(load.cylinder)]
        for peaks in _list_peaks(load):
            row += [unit_cell(peaks.compression_N, unit), unit_cell(peaks.tension_N, unit)]
        reversal = load.reversal
        guide = max(abs(load.guide.max_N), abs(load.guide.min_N))
        row += [f"{reversal.longest_deg:.1f}", number(reversal.ratio, 3), unit_cell(guide, unit)]
        rows.append(row)
        if not reversal.reverses:
            failing.append(k)
    heads = [Column("cylinder", words=True)]
    for name in ("gas", "inertia", "rod", "pin"):
        heads += [Column(f"{name} c"), Column(f"{name} t")]
    heads += [
        Column("reversal, deg", marked=failing),
        Column("share", marked=failing),
        Column("guide"),
    ]
    return Grid.of_rows(f"Rod load, {unit.name}", heads, rows, _judge(loads))


def _list_peaks(load: RodLoad) -> tuple[RodPeaks, ...]:
    return (load.gas, load.inertia, load.piston_rod, load.pin)


def _find_largest(load: RodLoad) -> float:
    return max(max(peaks.compression_N, peaks.tension_N) for peaks in _list_peaks(load))


def _rank_reversal(load: RodLoad) -> tuple[bool, float, float]:
    reversal = load.reversal
    return (reversal.reverses, reversal.longest_deg, reversal.ratio)


def _judge(loads: Sequence[RodLoad]) -> str:
    """Return the cylinder that reverses least, and whether it reverses."""
    worst = min(loads, key=_rank_reversal)
    reversal = worst.reversal
    word = "reverses" if reversal.reverses else "does not reverse"
    return (
        f"The pin of cylinder {worst.cylinder} has the least reversal: "
        f"{reversal.longest_deg:.1f} deg and a share of {number(reversal.ratio, 3)}; it {word} "
        f"(API 618, 5th edition: at least 15 deg and 0.03). {_COLUMNS}"
    )
