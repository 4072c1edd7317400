"""Masses of pistons, rods and throws as they count: `analyze --only masses`.

With l the length of the rod, a the distance of its centre of mass from the piston pin and b from
the crank pin, its two masses are m b/l at the small and m a/l at the big end. They have the moment
of inertia m a b about the centre of mass, the rod has J; H = m a b - J. A rod that swings about the
piston pin has the reduced length (J + m a^2)/(m a), which is l if H = 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ..core.records import list_figures, to_document
from ..engine.engine import Engine
from ..file.fields import join_words
from ..show.figures import FigureRow
from ..show.sheet import Grid, number
from .records import Masses


def list_masses(engine: Engine) -> tuple[Masses, ...]:
    """Return the masses of each distinct set of parts, in the order of the lowest cylinder.

    Args:
        engine: Engine without trailing axes.
    """
    c, count = engine.cylinders, len(engine.numbers)
    lengths = np.broadcast_to(np.ravel(c.radius / c.lam), count)
    couples = np.broadcast_to(np.ravel(c.couple), count)
    found: dict[Masses, list[int]] = {}
    for number_, weighed, length, couple in sorted(
        zip(engine.numbers, engine.weighed, lengths.tolist(), couples.tolist(), strict=True),
        key=lambda row: row[0],
    ):
        small, big = float(weighed.small_end), float(weighed.big_end)
        one = Masses(
            cylinders=(),
            piston_kg=float(weighed.piston),
            crosshead_kg=float(weighed.crosshead),
            reciprocating_kg=float(weighed.reciprocating),
            rotating_kg=float(weighed.rotating),
            throw_kg=float(weighed.share),
        )
        if (mass := small + big) > 0:
            a, b = length * big / mass, length * small / mass
            inertia = mass * a * b - couple
            one = one._replace(
                rod_kg=mass,
                rod_small_end_kg=small,
                rod_big_end_kg=big,
                rod_inertia_kg_m2=inertia,
                radius_of_gyration_m=math.sqrt(max(inertia, 0.0) / mass),
                couple_constant_kg_m2=couple,
                reduced_length_m=(inertia + mass * a * a) / (mass * a) if a else None,
            )
        found.setdefault(one, []).append(number_)
    return tuple(one._replace(cylinders=tuple(numbers)) for one, numbers in found.items())


# ------------------------------------------------------------------ how it is shown
_LABELS = {
    "piston_kg": ("piston, g", 1e3),
    "crosshead_kg": ("crosshead, g", 1e3),
    "rod_kg": ("rod, g", 1e3),
    "rod_small_end_kg": ("rod at the small end, g", 1e3),
    "rod_big_end_kg": ("rod at the big end, g", 1e3),
    "reciprocating_kg": ("reciprocating, g", 1e3),
    "rotating_kg": ("rotating without throw, g", 1e3),
    "throw_kg": ("share of the throw, g", 1e3),
    "rod_inertia_kg_m2": ("inertia of the rod, kg·mm²", 1e6),
    "radius_of_gyration_m": ("its radius of gyration, mm", 1e3),
    "couple_constant_kg_m2": ("H, kg·mm²", 1e6),
    "reduced_length_m": ("reduced length, mm", 1e3),
}


def grid(masses: Sequence[Masses]) -> Grid:
    """Return a table: a figure a row, cylinders with equal parts a column."""
    heads = ["", *(f"cylinder {join_words([str(n) for n in one.cylinders])}" for one in masses)]
    rows = []
    for key, (label, factor) in _LABELS.items():
        values = [getattr(one, key) for one in masses]
        if any(values):
            cells = ("–" if value is None else number(factor * value) for value in values)
            rows.append((label, *cells))
    return Grid("Masses", tuple(heads), tuple(rows))


def list_rows(masses: Sequence[Masses]) -> Iterator[FigureRow]:
    """Yield every figure of the masses, SI, by the lowest cylinder of each set."""
    for one in masses:
        for name, value, unit in list_figures(to_document(one), ("cylinders",)):
            yield FigureRow(one.cylinders[0], "masses", None, name, value, unit)
