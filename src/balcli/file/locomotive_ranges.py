"""Usual ranges of the figures of [locomotive], by which figures in another unit are found.

This module is imported only for files that have this table.
"""

from __future__ import annotations

from collections.abc import Iterator

from .locomotive_tables import Locomotive
from .model import EngineFile
from .ranges import Range, measure
from .units import LENGTH

_WHEEL = 1.2, 8.0  # wheel diameter, strokes: small wheels have 1.5, the largest ones 5
# Radius of the balance masses / radius of the wheel: they lie inside the tyre.
_BALANCE = 0.2, 1.0
_BALANCE_OF_CRANK = 0.5, 8.0  # the same radius / crank radius, without a wheel diameter
_COUPLING = 0.2, 5.0  # radius of the coupling pins / crank radius
_LENGTHS = ("ft", "in", "cm", "m")


def list_locomotive_ranges(model: EngineFile, locomotive: Locomotive) -> Iterator[Range]:
    """Yield the usual ranges of the wheels' dimensions.

    Args:
        model: Engine file.
        locomotive: Its table [locomotive].
    """
    size = measure(model)
    wheel = locomotive.wheel_diameter
    stroke = f"a stroke of {size.stroke:g} mm"
    yield Range(
        figures=[("locomotive.wheel_diameter", wheel or 0.0)],
        least=_WHEEL[0] * size.stroke,
        most=_WHEEL[1] * size.stroke,
        dimension=LENGTH,
        others=_LENGTHS,
        basis=stroke,
        also=("crank.stroke",),
    )
    basis = stroke
    also = "crank.stroke"
    least, most = (share * size.radius for share in _BALANCE_OF_CRANK)
    if wheel is not None and _WHEEL[0] <= wheel / size.stroke <= _WHEEL[1]:
        basis = f"a wheel diameter of {wheel:g} mm"
        also = "locomotive.wheel_diameter"
        least, most = (share * wheel / 2 for share in _BALANCE)
    radius = locomotive.radius or 0.0
    yield Range(
        figures=[("locomotive.radius", radius)],
        least=least,
        most=most,
        dimension=LENGTH,
        others=_LENGTHS,
        basis=basis,
        hint="balance masses are inside their wheel" if radius > most else "",
        also=(also,),
    )
    yield Range(
        figures=[("locomotive.coupling_radius", locomotive.coupling_radius or 0.0)],
        least=_COUPLING[0] * size.radius,
        most=_COUPLING[1] * size.radius,
        dimension=LENGTH,
        others=_LENGTHS,
        basis=stroke,
        also=("crank.stroke",),
    )
