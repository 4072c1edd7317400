"""Figures with a unit, as an engine file may give them: "3.5 in", "1/7 turn", "8.1 lb in^2".

A figure is matched by a regular expression first and nothing is ever evaluated. The arithmetic is
exact (fractions), so that a figure is rounded once. The commonest units are in a table here; pint
is imported only for any other.
"""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple

from ..limits import LONGEST_FIGURE

PI = Fraction("3.14159265358979323846264338327950288419716939937510")


class Powers(NamedTuple):
    """Exponents of a dimension. Angle counts as one, so that rpm is no angle and degrees are no
    plain number.
    """

    length: int = 0
    mass: int = 0
    time: int = 0
    angle: int = 0


class Unit(NamedTuple):
    """`scale` in m, kg, s and turns."""

    scale: Fraction
    powers: Powers


class Dimension(NamedTuple):
    """What a field of the engine file measures: its bare unit, how one speaks of it, and figures to
    show a reader.
    """

    unit: str
    name: str
    powers: Powers
    examples: tuple[str, ...]


_FOREIGN = Powers(99)  # ampere, kelvin: known, but no field has such a dimension
_LENGTH, _MASS, _TIME, _ANGLE = Powers(length=1), Powers(mass=1), Powers(time=1), Powers(angle=1)
_ENERGY = Powers(2, 1, -2)
# By definition: the international inch and pound (1959), standard gravity (CGPM 1901).
INCH = Fraction(254, 10_000)  # m
POUND = Fraction(45_359_237, 100_000_000)  # kg
STANDARD_GRAVITY = 9.80665  # m/s2
_FORCE, _PRESSURE = Powers(1, 1, -2), Powers(-1, 1, -2)
_POUND_FORCE = POUND * Fraction("9.80665")  # N

COMMON = {
    "mm": Unit(Fraction(1, 1000), _LENGTH),
    "cm": Unit(Fraction(1, 100), _LENGTH),
    "m": Unit(Fraction(1), _LENGTH),
    "in": Unit(INCH, _LENGTH),
    "ft": Unit(12 * INCH, _LENGTH),
    "kg": Unit(Fraction(1), _MASS),
    "g": Unit(Fraction(1, 1000), _MASS),
    "lb": Unit(POUND, _MASS),
    "oz": Unit(POUND / 16, _MASS),
    "s": Unit(Fraction(1), _TIME),
    "ms": Unit(Fraction(1, 1000), _TIME),
    "min": Unit(Fraction(60), _TIME),
    "turn": Unit(Fraction(1), _ANGLE),
    "deg": Unit(Fraction(1, 360), _ANGLE),
    "°": Unit(Fraction(1, 360), _ANGLE),
    "rad": Unit(1 / (2 * PI), _ANGLE),
    "rpm": Unit(Fraction(1, 60), Powers(time=-1, angle=1)),
    "bar": Unit(Fraction(100_000), _PRESSURE),
    "J": Unit(Fraction(1), _ENERGY),
    "N": Unit(Fraction(1), _FORCE),
    "lbf": Unit(_POUND_FORCE, _FORCE),
    "MPa": Unit(Fraction(10**6), _PRESSURE),
    "GPa": Unit(Fraction(10**9), _PRESSURE),
    "psi": Unit(_POUND_FORCE / INCH**2, _PRESSURE),
}

AMBIGUOUS = {
    "gr": "g, or grain (65 mg)?",
    "gm": "g, or gigametre?",
    "grad": "deg, or gon (0.9 deg)?",
    "grade": "deg, or gon (0.9 deg)?",
}
ALSO = {"rev": "turn", "r": "turn", "U": "turn"}  # revolution; German Umdrehung

LENGTH = Dimension("mm", "a length", _LENGTH, ("90 mm", "3.5 in"))
MASS = Dimension("kg", "a mass", _MASS, ("650 g", "0.8 lb"))
ANGLE = Dimension("deg", "an angle", _ANGLE, ("30 deg", "1.2 rad", "1/7 turn"))
INERTIA = Dimension(
    "kg mm^2", "a moment of inertia", Powers(length=2, mass=1), ("4200 kg mm^2", "8.1 lb in^2")
)
UNBALANCE = Dimension(
    "g mm",
    "an unbalance (mass times radius)",
    Powers(length=1, mass=1),
    ("9000 g mm", "12.5 oz in"),
)
SPEED = Dimension("rpm", "a speed of rotation", Powers(time=-1, angle=1), ("6000 rpm", "300 rad/s"))
TIME = Dimension("s", "a time", _TIME, ("0.82 s", "820 ms"))
PRESSURE = Dimension("bar", "a pressure", _PRESSURE, ("9.5 bar", "1.2 MPa", "150 psi"))
ENERGY = Dimension("J", "an energy", _ENERGY, ("1400 J", "1.4 kJ"))
STIFFNESS = Dimension("N/mm", "a stiffness", Powers(0, 1, -2), ("350 N/mm", "2000 lbf/in"))
DAMPING = Dimension("N s/mm", "a damping", Powers(0, 1, -1), ("0.5 N s/mm", "3 lbf s/in"))
TORQUE = Dimension("N m", "a torque", Powers(2, 1, -2), ("250 N m", "184 lbf ft"))
TORSIONAL_STIFFNESS = Dimension(
    "N m/rad",
    "a torsional stiffness",
    Powers(2, 1, -2, -1),
    ("1.25e6 N m/rad", "24.17e6 lbf in/rad"),
)
TORSIONAL_DAMPING = Dimension(
    "N m s/rad", "a torsional damping", Powers(2, 1, -1, -1), ("2 N m s/rad", "18 lbf in s/rad")
)
SHEAR_MODULUS = Dimension("GPa", "a modulus of elasticity", _PRESSURE, ("79.3 GPa", "11.5e6 psi"))
STRESS = Dimension("N/mm^2", "a stress", _PRESSURE, ("40 N/mm^2", "5800 psi"))
PLAIN = Dimension("", "a plain number", Powers(), ())
_DIMENSIONS = (
    *(LENGTH, MASS, ANGLE, INERTIA, UNBALANCE, SPEED, TIME, PRESSURE, ENERGY, PLAIN),
    *(TORQUE, TORSIONAL_STIFFNESS, TORSIONAL_DAMPING, STRESS, STIFFNESS, DAMPING),
)

_NUMBER = r"(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,4})?"
_FACTOR = r"[A-Za-zµμ°_]+(?:(?:\^|\*\*)-?[1-9]|[²³])?"
_JOINT = r"\s*[*·⋅/]\s*|\s+"
_UNIT = rf"{_FACTOR}(?:(?:{_JOINT}){_FACTOR})*"
FIGURE = (
    rf"\s*([+-]?{_NUMBER})(?:\s*/\s*({_NUMBER}))?\s*({_UNIT})?\s*"  # compiled when a string is met
)
_INCH_MARK = r'^([^"”″]*\d)\s*["”″]\s*$'  # 3.5"
# A crank speed counts turns, said or not. 1/s stays out: it is as often meant as rad/s.
_PER_MINUTE = r"(\d\.?)(?:(?:\s+1)?\s*/\s*min|\s*min(?:\^|\*\*)?-1|\s*min⁻¹)\s*$"
_HERTZ = r"(\d\.?)\s*Hz\s*$"
_PART = r"([*·⋅/]?)\s*([A-Za-zµμ°_]+)(?:(?:\^|\*\*)(-?[1-9])|([²³]))?"


def convert(text: str, dimension: Dimension) -> float:
    """The figure in the bare unit of `dimension`, correctly rounded. ValueError: what is wrong,
    what would be right.
    """
    inches = re.sub(_INCH_MARK, r"\1 in", text[:LONGEST_FIGURE])
    figure = _count_turns(inches) if dimension is SPEED else inches
    match = re.fullmatch(FIGURE, figure, re.ASCII) if len(text) <= LONGEST_FIGURE else None
    if match is None:
        raise ValueError(f"is not a number followed by a unit; {wanted(dimension)}")
    above, below, names = match.groups()
    if not names:
        raise ValueError(f"has no unit; {wanted(dimension)}")
    unit = read_unit(names, dimension)
    if unit.powers != dimension.powers:
        raise ValueError(f"is {_name(unit.powers)}, but {wanted(dimension)}")
    try:
        return float(
            Fraction(above)
            / Fraction(below or 1)
            * unit.scale
            / read_unit(dimension.unit, dimension).scale
        )
    except ZeroDivisionError:
        raise ValueError("divides by zero") from None
    except OverflowError:
        raise ValueError("is too large a number") from None


def read_unit(names: str, dimension: Dimension) -> Unit:
    """The product of a unit's parts; ValueError for an unknown one, with examples of
    `dimension`.
    """
    scale, powers = Fraction(1), Powers()
    for joint, name, power, superscript in re.findall(_PART, names, re.ASCII):
        if name in AMBIGUOUS:
            raise ValueError(f'has the unit "{name}": {AMBIGUOUS[name]} {wanted(dimension)}')
        name = ALSO.get(name, name)
        part = COMMON.get(name) or COMMON.get(_in_small(name)) or _ask_pint(name)
        if part is None:
            raise ValueError(f'has the unknown unit "{name}"; {wanted(dimension)}')
        exponent = int(power or {"²": 2, "³": 3}.get(superscript, 1)) * (-1 if joint == "/" else 1)
        scale *= part.scale**exponent
        powers = Powers(*(p + exponent * q for p, q in zip(powers, part.powers, strict=True)))
    return Unit(scale, powers)


def _count_turns(speed: str) -> str:
    """A speed of rotation with its turns said: "150 Hz" -> "150 turn/s", "5500 1/min" -> rpm."""
    return re.sub(_PER_MINUTE, r"\1 rpm", re.sub(_HERTZ, r"\1 turn/s", speed))


def _in_small(name: str) -> str:
    """A unit of several letters that is written in capitals throughout, such as RPM."""
    return name.lower() if len(name) > 1 and name.isupper() else name


def wanted(dimension: Dimension) -> str:
    """What would be right, with examples."""
    if dimension is PLAIN:
        return "a plain number is wanted, without quotes"
    examples = " or ".join(f'"{e}"' for e in dimension.examples)
    return f"{dimension.name} is wanted: a bare number in {dimension.unit}, or {examples}"


def _name(powers: Powers) -> str:
    named = {d.powers: d.name for d in _DIMENSIONS} | {
        Powers(time=-1): "a frequency",
        Powers(1, 1, -2): "a force",
    }
    return named.get(powers, "of another dimension")


@cache
def _ask_pint(name: str) -> Unit | None:
    """A unit that is not in the table above; None if there is no such unit of length, mass, time
    and angle.
    """
    registry = _registry()
    try:
        scale, _ = registry.get_base_units(name)  # in m, kg, s, rad
        parts = dict(registry.get_dimensionality(name))
    except (
        AttributeError,
        KeyError,
        TypeError,
        ValueError,
    ):  # pint has no common base class for these
        return None
    powers = [parts.pop(key, 0) for key in ("[length]", "[mass]", "[time]", "[angle]")]
    if parts or any(p != int(p) for p in powers):
        return Unit(Fraction(scale), _FOREIGN)
    return Unit(Fraction(scale) / (2 * PI) ** int(powers[3]), Powers(*map(int, powers)))


@cache
def _registry() -> Any:
    import logging

    import pint

    log = logging.getLogger("pint")
    level = log.level
    log.setLevel(logging.ERROR)  # it would report the redefinition, which is meant
    try:
        registry: Any = pint.UnitRegistry()
        registry.define(
            "radian = [angle] = rad"
        )  # pint takes an angle for a plain number; here it is a dimension
        registry._build_cache()
    finally:
        log.setLevel(level)
    return registry
