"""Recompute what Liu Xianzhi (received 1979) says in words about the flat-plane V8: where the two
shafts meet, how far they move, and the extremes of the sliders' forces.

With x = gamma/2 (half the bank angle) and c = cos x, the distances of the shafts from the crank
axis are b'' = -b cos 3x and b''' = b cos x, with the ratio b' = b b''/b'''. Drawn over the polar
angle x, they are a three-leaf rose, a circle and a four-leaf curve (7.1). The largest forces of the
sliders over the crank angle are cos 3x - c (Zx) and cos 3x + c (Zy), in units of K.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from .recomputed import Print, Ranges, Table

_C = Polynomial([0, 1])
_ROSE = -(4 * _C**3 - 3 * _C)  # b''/b, because cos 3x = 4 c^3 - 3 c
_CIRCLE = _C  # b'''/b
_FOUR_LEAVES = 3 - 4 * _C**2  # b'/b, the rose divided by the circle
_SLIDER_X = -_ROSE - _C
_SLIDER_Y = -_ROSE + _C


class _Turning(NamedTuple):
    """A curve over x, as a polynomial of c = cos x."""

    polynomial: Polynomial

    def at(self, x: float) -> float:
        return float(self.polynomial(np.cos(x)))

    def slope(self, x: float) -> float:
        """Return the derivative by x."""
        return float(-np.sin(x) * self.polynomial.deriv()(np.cos(x)))

    def walk(self) -> float:
        """Return the length of the path for x from 0 to 90 degrees."""
        turns = _find_angles(self.polynomial.deriv())
        stops = [self.at(x) for x in (0.0, *turns, np.pi / 2)]
        return float(np.abs(np.diff(stops)).sum())


def _find_angles(zero: Polynomial) -> list[float]:
    """Return the angles x between 0 and 90 degrees at which a polynomial of cos x is 0, rising."""
    roots = np.asarray(zero.roots(), complex)
    real = roots.real[np.abs(roots.imag) < 1e-12]
    inside = real[(real > 1e-12) & (real < 1 - 1e-12)]
    angles: list[float] = np.sort(np.arccos(inside)).tolist()
    return angles


class _Extreme(NamedTuple):
    """The extreme of a curve inside the range of bank angles."""

    bank_deg: float
    value: float


def _find_extreme(curve: Polynomial) -> _Extreme:
    (x,) = _find_angles(curve.deriv())
    return _Extreme(float(np.degrees(2 * x)), _Turning(curve).at(x))


class _Crossing(NamedTuple):
    """Where a curve crosses the circle: the bank angle, and the angle between both curves."""

    bank_deg: float
    between_deg: float


def _find_crossing(other: Polynomial) -> _Crossing:
    (x,) = _find_angles(other - _CIRCLE)
    curve = _Turning(other)
    circle = _Turning(_CIRCLE)
    direction_of_curve = np.arctan2(curve.at(x), curve.slope(x))
    direction_of_circle = np.arctan2(circle.at(x), circle.slope(x))
    between = np.degrees(direction_of_circle - direction_of_curve) % 180
    return _Crossing(float(np.degrees(2 * x)), float(min(between, 180 - between)))


def _find_fastest() -> float:
    """Return the ratio of the shafts' speeds that is largest in size; at gamma = 0, where both
    speeds are 0, it is the ratio of the derivatives by c.
    """
    ratio = (_ROSE.deriv() / _CIRCLE.deriv().coef[0])(np.cos(np.linspace(0, np.pi / 2, 91)))
    return float(ratio[np.abs(ratio).argmax()])


def _compute_quantities() -> dict[str, float]:
    """Return the figures by their names in the print, angles in degrees."""
    rose = _find_crossing(_ROSE)
    four_leaves = _find_crossing(_FOUR_LEAVES)
    slider_x = _find_extreme(_SLIDER_X)
    slider_y = _find_extreme(_SLIDER_Y)
    return {
        "bank angle, from opposite sides": rose.bank_deg,
        "bank angle, at the crank axis": float(np.degrees(2 * np.arccos(0))),
        "path of the shaft at b''": _Turning(_ROSE).walk(),
        "path of the shaft at b'''": _Turning(_CIRCLE).walk(),
        "largest ratio of speeds": _find_fastest(),
        "bank angle of the extreme of Zx": slider_x.bank_deg,
        "extreme of Zx": slider_x.value,
        "bank angle of the extreme of Zy": slider_y.bank_deg,
        "extreme of Zy": slider_y.value,
        "bank angle, circle and rose": rose.bank_deg,
        "angle between circle and rose": rose.between_deg,
        "bank angle, circle and four leaves": four_leaves.bank_deg,
        "angle between circle and four leaves": four_leaves.between_deg,
    }


def tabulate_liu_statements(printed: Print, ranges: Ranges) -> Table:
    """Return the computed figures of Liu's statements, and of crossings for which he gives the
    formula (7.2) alone.
    """
    quantities = _compute_quantities()
    answers = [quantities[name] for name in printed.column("quantity")]
    return printed.compare_answers(answers, [])
