"""Pictures of characters for a terminal of 80 columns: orders as bars, loci in Braille dots."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest

import numpy as np

from ..core.phasors import Complex, Phasors
from ..results.analysis import Analysis
from .sheet import NEGLIGIBLE, Text, capitalized, number, order_name, size_text, small_text
from .units import ShownUnit, System
from .view import VISIBLE

BAR_COLUMNS = 52  # of the longest bar
LOCUS_ROWS = 17  # and twice as many columns
# Bits of the dots in a Braille character, by row and column (Unicode 17.0, chapter 21.1).
_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))


def sketches(result: Analysis, system: System) -> Iterator[Text]:
    """Bars and loci of the force and the moment that were computed; words of one that is nothing,
    or negligible beside one cylinder's.
    """
    computed = [(kind, p, system.unit(kind)) for kind, p in result.spectra.vectors()]
    shown = []
    for kind, phasors, unit in computed:
        least = NEGLIGIBLE * result.of_one_cylinder[kind.name]
        if (largest := _find_largest(phasors)) < least:
            yield Text(capitalized(kind.label), (small_text(largest, unit),))
        else:
            shown.append((kind, phasors, unit))
    for kind, phasors, unit in shown:
        yield Text(
            f"{capitalized(kind.label)} by order, {unit.name} (█ with the crank, ▒ against it)",
            tuple(bars(phasors, unit)),
        )
    if shown:
        blocks = [
            [
                f"{kind.name}, up to {size_text(_find_largest(p), unit)}".ljust(2 * LOCUS_ROWS),
                *locus(p),
            ]
            for kind, p, unit in shown
        ]
        yield Text(
            "Over a revolution: x up, y right, + at crank angle 0",
            tuple("   ".join(row).rstrip() for row in zip_longest(*blocks, fillvalue="")),
        )


def bars(phasors: Phasors, unit: ShownUnit) -> Iterator[str]:
    """A line an order: its largest value, as the sum of the two vectors that turn with and against
    the crank.
    """
    largest = phasors.major.max(initial=0)
    for k, order in enumerate(phasors.orders):
        if order <= 2 or phasors.major[k] > VISIBLE * largest:
            ahead, whole = (
                round(BAR_COLUMNS * float(v) / largest) if largest else 0
                for v in (abs(phasors.forward[k]), phasors.major[k])
            )
            bar = "█" * ahead + "▒" * (whole - ahead) or ("▏" if phasors.major[k] else "")
            yield " ".join(
                filter(
                    None,
                    (f"{order_name(order):>4}", bar, number(unit.of(float(phasors.major[k])), 4)),
                )
            )


def locus(phasors: Phasors) -> list[str]:
    """The way of the vector's tip in a square of LOCUS_ROWS rows with its axes; all dots are
    equally far apart.
    """
    curve = phasors.values(np.radians(np.arange(0, 360, 0.25)))
    largest = np.abs(curve).max()
    dots, grid = 4 * LOCUS_ROWS, np.zeros((LOCUS_ROWS, 2 * LOCUS_ROWS), int)
    middle = dots // 2
    for k in range(0, dots, 4):
        set_dot(grid, k, middle)
        set_dot(grid, middle, k)
    for row, column in sorted({_dot_place(v, middle) for v in curve / (largest or 1)}):
        set_dot(grid, row, column)
    lines = [[chr(0x2800 + bits) if bits else " " for bits in row] for row in grid]
    if largest:
        row, column = _dot_place(complex(curve[0] / largest), middle)
        lines[row // 4][column // 2] = "+"
    return ["".join(line) for line in lines]


def _dot_place(v: complex, middle: int) -> tuple[int, int]:
    """Row and column of the dot for a vector of at most 1."""
    return round(middle - (middle - 1) * v.real), round(middle + (middle - 1) * v.imag)


def set_dot(grid: np.ndarray, row: int, column: int) -> None:
    """Set one of the 4 x 2 dots of a Braille character in a grid of characters."""
    grid[row // 4, column // 2] |= _DOTS[row % 4][column % 2]


def _find_largest(phasors: Phasors) -> float:
    """The largest size over a revolution, SI."""
    curve: Complex = phasors.values(np.radians(np.arange(0, 360, 0.25)))
    return float(np.abs(curve).max(initial=0))
