"""Usual ranges of the figures of [torsion], by which figures in another unit are found.

This module is imported only for files that have this table.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from .model import EngineFile
from .ranges import INERTIAS, LENGTHS, MASSES, Range, Sizes, compare_with_stroke, measure
from .torsion_tables import Part, Torsion
from .units import INERTIA, LENGTH, TORSIONAL_STIFFNESS

# Stiffness of a throw / (bore^2 x stroke), N/(m^2 rad): crankshafts from cars to ships have 4e8 to
# 3e9. A slip from kN m, MN m or N mm is a factor of 1000 or more.
_THROW = 2.5e7, 4e10
# Length of a plain shaft with the stiffness and diameter of a given shaft, diameters: from a flange
# to a long intermediate shaft. Figures in kN m are 1000 times longer; diameters in cm make the
# shaft 1000 times shorter, in diameters.
_SHORTEST = 0.02
_LONGEST = 500.0
_PART = 0.05, 4.0  # diameter of a shaft before or behind the throws, strokes
_WEB_THICKNESS = 0.05, 1.5  # strokes
_WEB_WIDTH = 0.2, 4.0  # strokes
_THROW_INERTIA = 0.02, 1000.0  # inertia of a throw / that of rod and piston at the crank radius
# crank.inertia / inertia of all throws: they are equal, but for the ends of the crankshaft
_WHOLE = 0.1, 10.0
_STIFFNESSES = ("kN m/rad", "MN m/rad", "N mm/rad", "N m/deg")
_STEEL = 79.3e9  # shear modulus, N/m^2


def list_torsion_ranges(model: EngineFile, torsion: Torsion, throws: int) -> Iterator[Range]:
    """Yield the usual ranges of stiffnesses, diameters and inertias.

    Args:
        model: Engine file.
        torsion: Its table [torsion].
        throws: Number of its throws.
    """
    size = measure(model)
    yield _describe_throw(torsion, size)
    yield compare_with_stroke("torsion.throw_diameter", torsion.throw_diameter, _PART, size)
    yield compare_with_stroke("torsion.web_thickness", torsion.web_thickness, _WEB_THICKNESS, size)
    yield compare_with_stroke("torsion.web_width", torsion.web_width, _WEB_WIDTH, size)
    for key in ("front", "rear"):
        for number, part in enumerate(getattr(torsion, key), 1):
            yield from _list_shaft(f"torsion.{key}.{number}", part, size)
    yield from _list_inertias(model, torsion, size, throws)


def _describe_throw(torsion: Torsion, size: Sizes) -> Range:
    """Return the range of the stiffness between throws."""
    volume = (size.bore / 1e3) ** 2 * (size.stroke / 1e3)
    bore = f"a bore of {size.bore:g} mm and " if size.bore_known else ""
    return Range(
        figures=[("torsion.throw_stiffness", stiffness) for stiffness in torsion.given_stiffness],
        least=_THROW[0] * volume,
        most=_THROW[1] * volume,
        dimension=TORSIONAL_STIFFNESS,
        others=_STIFFNESSES,
        basis=f"{bore}a stroke of {size.stroke:g} mm",
        also=("piston.bore", "crank.stroke"),
    )


def _list_shaft(path: str, part: Part, size: Sizes) -> Iterator[Range]:
    """Yield the ranges of a shaft's stiffness and diameter: what one of them says of the other."""
    if part.diameter is None or part.stiffness is None or math.isinf(part.stiffness):
        yield compare_with_stroke(f"{path}.diameter", part.diameter, _PART, size)
        return
    rigidity = _STEEL * math.pi / 32
    cube = (part.diameter / 1e3) ** 3
    yield Range(
        figures=[(f"{path}.stiffness", part.stiffness)],
        least=rigidity * cube / _LONGEST,
        most=math.inf,
        dimension=TORSIONAL_STIFFNESS,
        others=_STIFFNESSES,
        basis=f"a diameter of {part.diameter:g} mm",
        also=(f"{path}.diameter",),
    )
    thinnest = (_SHORTEST * part.stiffness / rigidity) ** (1 / 3)
    yield Range(
        figures=[(f"{path}.diameter", part.diameter)],
        least=thinnest * 1e3,
        most=math.inf,
        dimension=LENGTH,
        others=LENGTHS,
        basis=f"a stiffness of {part.stiffness:g} N m/rad",
        also=(f"{path}.stiffness",),
    )


def _list_inertias(
    model: EngineFile, torsion: Torsion, size: Sizes, throws: int
) -> Iterator[Range]:
    """Yield the ranges of the inertias of throws and of the whole crankshaft."""
    of_throws = torsion.throw_inertia or ()
    if of_throws and size.mass:
        swung = size.mass * size.radius**2
        yield Range(
            figures=[("torsion.throw_inertia", inertia) for inertia in of_throws],
            least=_THROW_INERTIA[0] * swung,
            most=_THROW_INERTIA[1] * swung,
            dimension=INERTIA,
            others=INERTIAS,
            basis=f"rods and pistons of {size.mass:.4g} kg",
            also=MASSES,
        )
    whole = model.crank.inertia
    if of_throws and whole is not None:
        sum_of_throws = sum(of_throws) if len(of_throws) > 1 else throws * of_throws[0]
        yield Range(
            figures=[("crank.inertia", whole)],
            least=_WHOLE[0] * sum_of_throws,
            most=_WHOLE[1] * sum_of_throws,
            dimension=INERTIA,
            others=INERTIAS,
            basis=f"torsion.throw_inertia = {sum_of_throws:.4g} kg mm^2 for all throws together",
            hint="both are without rods, pistons and flywheel; is one of them in another unit?",
            also=("torsion.throw_inertia",),
        )
