"""Read figures with a unit, such as "3.5 in", "1/7 turn" or "8.1 lb in^2".

A figure is first brought to one spelling (`_RESPELT`), then matched by a regular expression; no
text is ever evaluated. The arithmetic uses exact fractions, so a figure is rounded only once. Most
units are defined by other units in a table (`_DEFINED`), of which only the needed rows are read.

Sources: the SI brochure (2019) for metric units; the international yard and pound (1959) for the
inch, the pound and the units made of them; CGPM 1901 for standard gravity; NIST SP 811 (2008),
appendix B, for the rest.
"""

import math
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache
from typing import NamedTuple
from unicodedata import normalize

from ..limits import LONGEST_FIGURE

# Names of units, and the figures that define them. r, U (German Umdrehung) and tr (French tour) are
# revolutions; mmHg is 13 595.1 kg/m3 at standard gravity; Btu is that of the International Table.
# No key takes a volume, temperature or current; their units are here so that messages name them.
_DEFINED = """
metre meter = 1 m; micron = 1 um; inch inches = 1 in; mil thou = 0.001 in; ft foot feet = 12 in
yd yard = 3 ft; mile = 5280 ft; mph = 1 mile/h
gram gramme = 1 g; t tonne = 1000 kg; pound lbm = 1 lb; oz ozm ounce = 1/16 lb; stone = 14 lb
long_ton = 2240 lb; grain = 1/7000 lb; slug = 1 lbf s^2/ft; slinch blob = 1 lbf s^2/in
sec second = 1 s; min minute = 60 s; h hr hour = 3600 s; d day = 24 h
rev revolution r U tr = 1 turn; radian = 1 rad; pi = 1/2 turn; deg degree ° = 1/360 turn
arcmin arcminute = 1/60 deg; arcsec arcsecond = 1/3600 deg; gon gradian = 1/400 turn
rpm = 1 turn/min; rps = 1 turn/s; Hz hertz = 1 s^-1
N newton = 1 kg m/s^2; dyn dyne = 1e-5 N; kgf kp kilopond = 1 kg g_n; gf pond = 1 g g_n
tf = 1 t g_n; lbf = 1 lb g_n; ozf = 1 oz g_n; kip = 1000 lbf; pdl poundal = 1 lb ft/s^2
Pa pascal = 1 N/m^2; bar bara = 100000 Pa; atm atmosphere = 101325 Pa; at = 1 kgf/cm^2
torr Torr = 1/760 atm; mmHg = 133.322387415 Pa; inHg = 25.4 mmHg
psi psia = 1 lbf/in^2; psf = 1 lbf/ft^2; ksi = 1000 psi; Msi = 1000000 psi
J joule = 1 N m; erg = 1e-7 J; Wh = 3600 J; Btu BTU = 1055.05585262 J
W watt = 1 J/s; hp = 550 ft lbf/s; PS ch cv = 75 kgf m/s
Nm = 1 N m; Nmm = 1 N mm; Ns = 1 N s; Nms = 1 N m s; gmm = 1 g mm
l L litre liter = 1 dm^3; cc ccm = 1 cm^3
K kelvin °C degC celsius °F degF fahrenheit = 1 of_another_kind
A amp ampere V volt ohm mol mole cd candela = 1 of_another_kind
"""

# Names with several meanings, and the question which of them is meant.
AMBIGUOUS = {
    "gr": "g, or grain (65 mg)?",
    "gm": "g, or gigametre?",
    "Mm": "mm, or megametre?",
    "MG": "mg, or Mg (1000 kg)?",
    "NM": "N m, or nanometre?",
    "ton": "t (1000 kg), or 2000 lb, or 2240 lb?",
    "cwt": "100 lb, or 112 lb?",
    "barg": "bar above the atmosphere? The absolute pressure is 1.01325 bar higher;",
    "psig": "psi above the atmosphere? The absolute pressure is 14.696 psi higher;",
    "grad": "deg, or gon (0.9 deg)?",
    "grade": "deg, or gon (0.9 deg)?",
    "Grad": "deg, or gon (0.9 deg)?",
    "cycle": "turn, or the two of a four-stroke engine?",
    "cpm": "rpm, or cycles of two turns in a minute?",
    "cal": "4.184 J, or 4.1868 J?",
    "kcal": "4184 J, or 4186.8 J?",
}


def _read_definitions(rows: str) -> Iterator[tuple[str, str]]:
    """Yield name and definition of each unit in rows such as "metre meter = 1 m; yard = 3 ft"."""
    for row in re.split(r"[;\n]", rows.strip()):
        names, definition = row.split(" = ")
        for name in names.split():
            yield name, definition


DEFINITIONS = dict(_read_definitions(_DEFINED))

# Powers of ten of prefixes: of symbols of units, and of their names.
_PREFIXES = {
    "G": 9,
    "M": 6,
    "k": 3,
    "h": 2,
    "da": 1,
    "d": -1,
    "c": -2,
    "m": -3,
    "µ": -6,  # micro sign
    "μ": -6,  # Greek mu
    "u": -6,
    "n": -9,
}
_PREFIX_NAMES = {
    "giga": 9,
    "mega": 6,
    "kilo": 3,
    "hecto": 2,
    "deca": 1,
    "deka": 1,
    "deci": -1,
    "centi": -2,
    "milli": -3,
    "micro": -6,
    "nano": -9,
}
# Units that take prefixes.
_SYMBOLS = (
    *("m", "g", "s", "rad", "N", "Pa", "bar", "J", "W", "Wh", "Hz"),
    *("Nm", "Ns", "Nms", "psi", "rpm"),
)
_NAMES = (
    *("metre", "meter", "gram", "gramme", "second", "radian", "newton", "pascal"),
    *("bar", "joule", "watt", "hertz"),
)


def _add_prefixes(units: Iterable[str], prefixes: Mapping[str, int]) -> Iterator[tuple[str, str]]:
    """Yield name and definition of each unit with each prefix: "kPa" and "1e3 Pa"."""
    for prefix, power in prefixes.items():
        for unit in units:
            yield prefix + unit, f"1e{power} {unit}"


PREFIXED = dict(_add_prefixes(_SYMBOLS, _PREFIXES)) | dict(_add_prefixes(_NAMES, _PREFIX_NAMES))


def find_near_name(name: str) -> str:
    """Return the unit that was probably meant; empty if none is near."""
    from difflib import get_close_matches  # needed only after a mistake

    usual = [prefix + unit for prefix in "mcMk" for unit in _SYMBOLS]
    units = (*usual, *_SYMBOLS, *DEFINITIONS)
    by_lower_case = {unit.lower(): unit for unit in units if unit not in AMBIGUOUS}
    near = get_close_matches(name.lower(), by_lower_case, 1, 0.75)
    return by_lower_case[near[0]] if near else ""


PI = Fraction("3.14159265358979323846264338327950288419716939937510")


class Unit(NamedTuple):
    """A unit as a product of powers of m, kg, s and turns: a scale and the exponents of these four.
    The angle has an exponent as well, so that rpm is not 1/s and degrees are not plain numbers.
    """

    scale: Fraction
    powers: tuple[int, ...]


class Dimension(NamedTuple):
    """A dimension of figures in engine files.

    Attributes:
        unit: Unit of bare numbers.
        name: Name in words, with its article.
        examples: Figures for messages.
    """

    unit: str
    name: str
    examples: tuple[str, ...] = ()

    @property
    def powers(self) -> tuple[int, ...]:
        """Exponents of m, kg, s and turns in its unit."""
        return read_unit(self.unit, self).powers


# By definition: the international inch and pound (1959), standard gravity (CGPM 1901).
INCH = Fraction(254, 10_000)  # m
POUND = Fraction(45_359_237, 100_000_000)  # kg
_GRAVITY = Fraction(980_665, 100_000)  # m/s2
STANDARD_GRAVITY = float(_GRAVITY)
POUND_FORCE = float(POUND) * STANDARD_GRAVITY  # N
BAR = 1e5  # Pa

_BASE = {
    "m": Unit(Fraction(1), (1, 0, 0, 0)),
    "g": Unit(Fraction(1, 1000), (0, 1, 0, 0)),
    "s": Unit(Fraction(1), (0, 0, 1, 0)),
    "turn": Unit(Fraction(1), (0, 0, 0, 1)),
    "rad": Unit(1 / (2 * PI), (0, 0, 0, 1)),
    "in": Unit(INCH, (1, 0, 0, 0)),
    "lb": Unit(POUND, (0, 1, 0, 0)),
    "g_n": Unit(_GRAVITY, (1, 0, -2, 0)),
    "of_another_kind": Unit(Fraction(1), (99, 0, 0, 0)),
}

LENGTH = Dimension("mm", "a length", ("90 mm", "3.5 in"))
MASS = Dimension("kg", "a mass", ("650 g", "0.8 lb"))
ANGLE = Dimension("deg", "an angle", ("30 deg", "1.2 rad", "1/7 turn"))
INERTIA = Dimension("kg mm^2", "a moment of inertia", ("4200 kg mm^2", "8.1 lb in^2"))
UNBALANCE = Dimension("g mm", "an unbalance (mass times radius)", ("9000 g mm", "12.5 oz in"))
SPEED = Dimension("rpm", "a speed of rotation", ("6000 rpm", "300 rad/s"))
TIME = Dimension("s", "a time", ("0.82 s", "820 ms"))
PRESSURE = Dimension("bar", "a pressure", ("9.5 bar", "1.2 MPa", "150 psi"))
ENERGY = Dimension("J", "an energy", ("1400 J", "1.4 kJ"))
STIFFNESS = Dimension("N/mm", "a stiffness", ("350 N/mm", "2000 lbf/in"))
DAMPING = Dimension("N s/mm", "a damping", ("0.5 N s/mm", "3 lbf s/in"))
TORQUE = Dimension("N m", "a torque", ("250 N m", "184 lbf ft"))
TORSIONAL_STIFFNESS = Dimension(
    "N m/rad", "a torsional stiffness", ("1.25e6 N m/rad", "24.17e6 lbf in/rad")
)
TORSIONAL_DAMPING = Dimension(
    "N m s/rad", "a torsional damping", ("2 N m s/rad", "18 lbf in s/rad")
)
DENSITY = Dimension("g/cm^3", "a density", ("7.85 g/cm^3", "7850 kg/m^3"))
SHEAR_MODULUS = Dimension("GPa", "a modulus of elasticity", ("79.3 GPa", "11.5e6 psi"))
FORCE = Dimension("N", "a force", ("98 kN", "22000 lbf"))
VELOCITY = Dimension("km/h", "a velocity", ("80 km/h", "50 mph"))
STRESS = Dimension("N/mm^2", "a stress", ("40 N/mm^2", "5800 psi"))
POWER = Dimension("kW", "a power", ("3820 kW", "5200 hp"))
PLAIN = Dimension("", "a plain number")
# In a figure below this value, a point with exactly three digits behind it probably separates
# thousands.
_LEAST_WITH_DECIMALS = {SPEED: 100, STIFFNESS: 1, TORSIONAL_STIFFNESS: 1000}
_KINDS = (  # names of dimensions for messages; the first with the same exponents is used
    Dimension("J", "a torque or an energy"),
    *(LENGTH, MASS, ANGLE, INERTIA, UNBALANCE, SPEED, TIME, PRESSURE, STIFFNESS, DAMPING),
    *(TORSIONAL_STIFFNESS, TORSIONAL_DAMPING, PLAIN),
    FORCE,
    Dimension("W", "a power"),
    Dimension("Hz", "a frequency"),
    Dimension("m^2", "an area"),
    Dimension("m^3", "a volume"),
    VELOCITY,
)

# Replacements for spellings that can mean only one thing
_SIGNS = str.maketrans("−–º˚“”″⁄’", '--°°"""/\'')
_CYRILLIC = {
    "мкм": "um",
    "мм": "mm",
    "Мм": "Mm",
    "см": "cm",
    "дм": "dm",
    "м": "m",
    "мг": "mg",
    "г": "g",
    "гр": "gr",
    "кг": "kg",
    "т": "t",
    "мс": "ms",
    "с": "s",
    "сек": "s",
    "мин": "min",
    "ч": "h",
    "рад": "rad",
    "град": "deg",
    "об": "turn",
    "Гц": "Hz",
    "кГц": "kHz",
    "Н": "N",
    "кН": "kN",
    "МН": "MN",
    "Нм": "Nm",
    "кНм": "kNm",
    "кгм": "kgm",
    "гмм": "gmm",
    "гсм": "gcm",
    "кгс": "kgf",
    "тс": "tf",
    "ат": "at",
    "атм": "atm",
    "бар": "bar",
    "Па": "Pa",
    "кПа": "kPa",
    "МПа": "MPa",
    "ГПа": "GPa",
    "Дж": "J",
    "кДж": "kJ",
    "МДж": "MJ",
    "Вт": "W",
    "кВт": "kW",
    "л": "l",
}
_CHINESE = {
    "微米": "um",
    "毫米": "mm",
    "厘米": "cm",
    "分米": "dm",
    "米": "m",
    "英寸": "in",
    "英尺": "ft",
    "毫克": "mg",
    "克": "g",
    "千克": "kg",
    "公斤": "kg",
    "吨": "t",
    "磅": "lb",
    "盎司": "oz",
    "毫秒": "ms",
    "秒": "s",
    "分": "min",
    "分钟": "min",
    "小时": "h",
    "转": "turn",
    "度": "deg",
    "弧度": "rad",
    "赫": "Hz",
    "赫兹": "Hz",
    "牛": "N",
    "牛顿": "N",
    "千牛": "kN",
    "公斤力": "kgf",
    "千克力": "kgf",
    "帕": "Pa",
    "千帕": "kPa",
    "兆帕": "MPa",
    "巴": "bar",
    "焦": "J",
    "千焦": "kJ",
    "瓦": "W",
    "千瓦": "kW",
    "马力": "PS",
    "升": "l",
}
_CHINESE_POWERS = {"": "", "平方": "^2", "立方": "^3"}  # 平方厘米: square centimetre
FORTRAN = r"(?<=[\d.])[dD]([+-]?\d{1,3})(?![\d.])"  # the exponent of 1.5D3
_SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def _spell_fraction(match: re.Match[str]) -> str:
    """Return a figure with a fraction of one character, `3½`, as `3 1/2`."""
    return f"{match[1]} {normalize('NFKC', match[2])}"


def _spell_wide(match: re.Match[str]) -> str:
    """Return characters of full width, units of one character and special blanks as plain ones."""
    return normalize("NFKC", match[0])


def _spell_exponent(found: re.Match[str]) -> str:
    return "^" + found[0].translate(_SUPERSCRIPTS)


def _spell_signs(found: re.Match[str]) -> str:
    return found[0].translate(_SIGNS)


def _spell_cyrillic(match: re.Match[str]) -> str:
    """Return a Russian unit as balcli writes it; other words are returned unchanged."""
    return _CYRILLIC.get(match[0]) or _CYRILLIC.get(match[0].lower(), match[0])


def _spell_chinese(match: re.Match[str]) -> str:
    """Return Chinese units that stand side by side (克毫米) as balcli writes them; other words are
    returned unchanged.
    """
    units = "|".join(sorted(_CHINESE, key=len, reverse=True))
    one_unit = f"(平方|立方|)({units})"
    if not re.fullmatch(f"(?:{one_unit})+", match[0]):
        return match[0]
    factors = re.findall(one_unit, match[0])
    return " ".join(f"{_CHINESE[unit]}{_CHINESE_POWERS[power]}" for power, unit in factors)


def _join_thousands(match: re.Match[str]) -> str:
    """Return a figure without the characters that separate its thousands."""
    return match[1] + re.sub(r"[ '_]", "", match[2])


_RESPELT: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    (r"(\d?)\s*([¼-¾⅐-⅞])", _spell_fraction),
    (r"[\uff01-\uff5e\u3380-\u33df\u00a0\u2007\u2009\u202f]", _spell_wide),
    (r"⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+", _spell_exponent),
    (r".+", _spell_signs),
    (r"(?i)(?<![^\W\d_])r\.p\.m\.?", "rpm"),
    (r"(?i)\blong tons?\b", "long_ton"),
    (r"M(?:PA|pa)\b", "MPa"),
    (r"(?<=[^\W\d_])\.(?=\s*$|/)", ""),  # "3.5 in.", "об./мин"
    (r"[а-яёА-ЯЁ]+", _spell_cyrillic),
    (r"[\u4e00-\u9fff]+", _spell_chinese),
    (r"(?<=\d)\s*[x×·⋅*]\s*10\^([+-]?\d{1,3})\b", r"e\1"),
    (FORTRAN, r"e\1"),
    (
        r"^(\s*[+-]?[1-9]\d{0,2})((?:[ '_]\d{3})+)(?![\d/]| \d{3}|\s*/\s*\d)",
        _join_thousands,
    ),
    # A decimal comma, unless three digits behind it might be thousands
    (r"^(\s*[+-]?(?:0|\d{4,}|\d+(?=,(?:\d{1,2}|\d{4,})(?!\d)))),(\d+)(?![\d,.])", r"\1.\2"),
    (r"""^([^"']*\d)\s*(?:"|'')\s*$""", r"\1 in"),
)


# Patterns are compiled when the first figure with a unit is read
BARE_FIGURE = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?"  # a number without a unit
_NUMBER = r"(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,4})?"
_PERCENTAGE = rf"\s*([+-]?{_NUMBER})\s*%\s*"
_FACTOR = r"[A-Za-zµμ°_]+(?:(?:\^|\*\*)-?[1-9]|[23])?"
_JOINT = r"\s*[*·⋅/]\s*|[.-]|\s+"
_UNIT = rf"{_FACTOR}(?:(?:{_JOINT}){_FACTOR})*"
_WHOLE = r"(\d+)(?:\s+|-)(?=[1-9]\d*\s*/)"  # the 3 of "3 1/2" or "3-1/2"
FIGURE = rf"\s*([+-]?)(?:{_WHOLE})?({_NUMBER})(?:\s*/\s*({_NUMBER}))?\s*({_UNIT})?\s*"
_LARGE_AND_SMALL = r"\s*([+-]?)(\d+ *[A-Za-z]+) +(\d.*[A-Za-z])\s*"  # 1 lb 4 oz, 3 ft 2 1/2 in
# A crank speed in 1/min or Hz counts turns. 1/s is rejected, because it often means rad/s.
_PER_MINUTE = r"(\d\.?)(?:(?:\s+1)?\s*/\s*min|\s*min(?:\^|\*\*)?-1)\s*$"
_PER_SECOND = r"\d\.?(?:(?:\s+1)?\s*/\s*|\s*(?=\w+(?:\^|\*\*)?-))s(?:ec)?(?:(?:\^|\*\*)?-1)?\s*$"
_HERTZ = r"(\d\.?)\s*(k?)(?:Hz|hertz)\s*$"
# pi/2, -3*pi/4 rad
_PI = rf"\s*([+-]?)(?:({_NUMBER})\s*[*·⋅]?)?\s*(?:pi|π)(?:\s*/\s*({_NUMBER}))?(?:\s+rad)?\s*"
# A mass unit stands for a force if only a force fits: 24 lb in/rad, 0.3 lb in s2, 70 kg/cm2
_FORCES = (
    (r"(?i)(?:\b|(?<=ft|in))(?:lbs?|pounds?)(?=\b|ft|in)", "lbf"),
    (r"(?i)\bkgs?(?=(?:\b|[cm]?m).*[/s])", "kgf"),  # "3 kgm" as a torque is rejected
)
_PART = r"([*·⋅/]?)\s*([A-Za-zµμ°_]+)(?:(?:\^|\*\*)(-?[1-9])|([23]))?"


def convert(text: str, dimension: Dimension) -> float:
    """Return a figure in the bare unit of a dimension, correctly rounded.

    Args:
        text: Number and unit, such as "3 1/2 in".
        dimension: Dimension that the figure must have.

    Raises:
        ValueError: The text is not such a figure; the message names the mistake and the remedy.
    """
    return float(convert_exactly(text, dimension))


def convert_exactly(text: str, dimension: Dimension) -> Fraction:
    """Return the exact figure in the bare unit of a dimension; errors as for `convert`.

    Args:
        text: Number, with or without a unit.
        dimension: Dimension of the figure.
    """
    if len(text) > LONGEST_FIGURE:
        raise ValueError(f"is not a number followed by a unit; {wanted(dimension)}")
    figure = text
    for pattern, new in _RESPELT:
        figure = re.sub(pattern, new, figure)
    try:
        exact = _measure(figure, dimension) / read_unit(dimension.unit, dimension).scale
        float(exact)
    except ZeroDivisionError:
        raise ValueError("divides by zero") from None
    except OverflowError:
        raise ValueError("is too large a number") from None
    refuse_thousands(text, exact, dimension)
    return exact


def read_fraction(text: str) -> float:
    """Return a plain number that is written as `0.51`, `51%` or `2/3`.

    Raises:
        ValueError: The text is not such a number.
    """
    figure, percent, rest = text.strip().partition("%")
    above, slash, below = re.sub(FORTRAN, r"e\1", figure).partition("/")
    try:
        number = float(above) / (float(below) if slash else 1.0)
    except (ValueError, ZeroDivisionError):
        number = math.nan
    if rest or not math.isfinite(number):
        raise ValueError('is not a number, fraction or percentage, such as 0.67, "2/3" or "67%"')
    return number / 100 if percent else number


class ThousandsError(ValueError):
    """A point in a figure probably separates thousands."""


def refuse_thousands(text: str, value: float | Fraction, dimension: Dimension) -> None:
    """Raise ThousandsError for a figure whose point probably separates thousands: "6.000 rpm".

    Args:
        text: Figure as it is typed, with or without a unit.
        value: Its value in the bare unit of its dimension.
        dimension: Dimension of the figure.
    """
    point = re.match(r"\s*[+-]?([1-9]\d{0,2})\.(\d{3})(?![\d.,/eE])", text)
    if point and abs(float(value)) < _LEAST_WITH_DECIMALS.get(dimension, 0):
        decimals = f"{point[1]}.{point[2]}0"
        thousands = point[1] + point[2]
        raise ThousandsError(
            f"has three decimals, or a point between thousands: write {decimals} or {thousands}; "
            f"{wanted(dimension)}"
        )


def _measure(figure: str, dimension: Dimension) -> Fraction:
    """Return a figure in m, kg, s and turns; a large and a small unit add up ("1 lb 4 oz")."""
    if dimension is SPEED and re.search(_PER_SECOND, figure):
        message = 'has the unit "1/s": rad/s, or turns per second (Hz)?'
        raise ValueError(f"{message} {wanted(dimension)}")
    figures = _split(_spell_out(figure, dimension))
    both = None if figures else re.fullmatch(_LARGE_AND_SMALL, figure, re.ASCII)
    if both:
        sign, large, small = both.groups()
        least_text = re.sub(r"\d+", "1", large)
        whole, rest, least = (_measure(part, dimension) for part in (large, small, least_text))
        if rest >= least:
            raise ValueError(f'has "{small}" after "{large}"; it must be less than "{least_text}"')
        return -(whole + rest) if sign == "-" else whole + rest
    if figures is None:
        raise ValueError(_explain(figure, dimension))
    number, names = figures
    if not names:
        plain = f": {float(number):.6g}" if dimension is PLAIN else ""
        raise ValueError(f"has no unit; {wanted(dimension)}{plain}")
    unit = read_unit(names, dimension)
    if unit.powers != dimension.powers:
        for mass, name in _FORCES:
            force = read_unit(re.sub(mass, name, names), dimension)
            if force.powers == dimension.powers:
                return number * force.scale
        inverse_powers = tuple(-power for power in unit.powers)
        if dimension in (STIFFNESS, TORSIONAL_STIFFNESS) and inverse_powers == dimension.powers:
            bare = read_unit(dimension.unit, dimension)
            inverse = 1 / (number * unit.scale * bare.scale)
            size = f"{float(inverse):.6g}".replace("e+0", "e").replace("e+", "e")
            message = f"is a flexibility; its inverse is {size} {dimension.unit}"
            raise ValueError(message)
        names_of_kinds = (kind.name for kind in _KINDS if kind.powers == unit.powers)
        name = next(names_of_kinds, "of another dimension")
        raise ValueError(f"is {name}, but {wanted(dimension)}")
    return number * unit.scale


def _explain(figure: str, dimension: Dimension) -> str:
    """Return why a figure cannot be read, and what is wanted."""
    percentage = re.fullmatch(_PERCENTAGE, figure)
    if dimension is PLAIN and percentage is not None:
        share = float(percentage[1]) / 100
        return f"is a percentage; write the plain number {share:.6g}, without quotes"
    return f"{_name_fault(figure)} {wanted(dimension)}"


def _name_fault(figure: str) -> str:
    """Return why a figure cannot be read; `wanted` supplies the rest of the message."""
    if strange := re.search(r"[а-яёА-ЯЁ]+", figure):
        return f'has "{strange[0]}" in Cyrillic letters, which is no unit; use Latin letters;'
    hint = ""
    if comma := re.match(r"\s*[+-]?(\d+),(\d{3})(?![\d,.])", figure):
        hint = f" is {comma[1]}.{comma[2]} meant, or {comma[1]}{comma[2]}?"
    return f"is not a number followed by a unit;{hint}"


def _spell_out(figure: str, dimension: Dimension) -> str:
    """Return a figure in another spelling: a speed in turns, or an angle such as pi/2 with `pi` as
    its unit.
    """
    if dimension is SPEED:  # "150 Hz" -> "150 turn/s", "5500 1/min" -> rpm
        counted = re.sub(_HERTZ, lambda hz: f"{hz[1]} turn/{hz[2] and 'm'}s", figure)
        return re.sub(_PER_MINUTE, r"\1 rpm", counted)
    # "3 pi/4 rad" -> "3/4 pi"; the unit pi is half a turn
    parts = re.fullmatch(_PI, figure, re.ASCII) if dimension is ANGLE else None
    return f"{parts[1]}{parts[2] or 1}/{parts[3] or 1} pi" if parts else figure


def _split(figure: str) -> tuple[Fraction, str] | None:
    """Return the number of a figure and the names of its unit; None if it is no figure."""
    match = re.fullmatch(FIGURE, figure, re.ASCII)
    if match is None:
        return None
    sign, whole, above, below, names = match.groups()
    number = Fraction(above) / Fraction(below or 1)
    if whole and number >= 1:  # not "3 5/2"
        return None
    number += Fraction(whole or 0)
    return (-number if sign == "-" else number), names or ""


@cache
def read_unit(names: str, dimension: Dimension) -> Unit:
    """Return a unit as the product of its parts.

    Args:
        names: Names of the parts, such as "kg mm^2".
        dimension: Dimension, for the examples in messages.

    Raises:
        ValueError: A part is unknown or ambiguous.
    """
    if re.sub(_PART, "", names, flags=re.ASCII).strip(" .-"):
        raise ValueError(f'has the unknown unit "{names}"; {wanted(dimension)}')
    scale = Fraction(1)
    powers: tuple[int, ...] = (0, 0, 0, 0)
    for joint, name, power, raised in re.findall(_PART, names, re.ASCII):
        if question := AMBIGUOUS.get(name) or AMBIGUOUS.get(name.removesuffix("s")):
            raise ValueError(f'has the unit "{name}": {question} {wanted(dimension)}')
        parts = (part,) if (part := _find(name)) else _find_pair(name)
        if not parts:
            near = find_near_name(name)
            hint = f" did you mean {near}?" if near else ""
            raise ValueError(f'has the unknown unit "{name}";{hint} {wanted(dimension)}')
        sign = -1 if joint == "/" else 1
        exponents = (sign, sign * int(power or raised or 1))[-len(parts) :]  # ozin^2: oz in^2
        for unit, exponent in zip(parts, exponents, strict=True):
            scale *= unit.scale**exponent
            each = zip(powers, unit.powers, strict=True)
            powers = tuple(p + exponent * q for p, q in each)
    return Unit(scale, powers)


@cache
def _find(name: str) -> Unit | None:
    """Return a unit by its name, which may have a prefix or a plural s; None if there is no such
    unit.
    """
    if name in _BASE:
        return _BASE[name]
    if definition := DEFINITIONS.get(name) or PREFIXED.get(name):
        number, names = _split(definition) or (Fraction(), "")
        unit = read_unit(names, PLAIN)
        return Unit(number * unit.scale, unit.powers)
    singular = name.removesuffix("s")
    if singular != name and len(singular) > 1 and name.islower():
        return _find(singular)
    lower = name.lower()
    if not name[1:]:
        return None
    if name.isupper() and (found := _find(lower)):
        return found
    alike = _by_lower_case()[lower] or _by_lower_case()[lower.removesuffix("s")]
    return _find(next(iter(alike))) if len(alike) == 1 else None  # Kg, KPa, Rpm, Lbs


@cache
def _by_lower_case() -> defaultdict[str, set[str]]:
    """Return the names of all units, grouped by their spelling in lower case."""
    by_lower_case = defaultdict[str, set[str]](set)
    for name in (*_BASE, *DEFINITIONS, *PREFIXED):
        by_lower_case[name.lower()].add(name)
    return by_lower_case


@cache
def _find_pair(name: str) -> tuple[Unit, ...]:
    """Return the two units, a mass or force and a length, that are written as one word: ozin, gcm,
    Ncm, lbft. Return () if there are no such units, or several.
    """
    length = LENGTH.powers
    loads = ((0, 1, 0, 0), (1, 1, -2, 0))
    pairs = {
        (first, second)
        for cut in range(1, len(name))
        if not re.fullmatch("[cdm]?ms", name[cut:])  # "kgcms2" might be kgf cm s^2
        if (first := _find(name[:cut])) and (second := _find(name[cut:]))
        if (first.powers in loads and second.powers == length)
        or (first.powers == length and second.powers in loads)
    }
    return pairs.pop() if len(pairs) == 1 else ()


def ask_unit(unit: str, *others: str) -> str:
    """Return the text for a warning that asks whether a figure is in the unit of bare numbers.

    Args:
        unit: Unit of bare numbers.
        others: Examples of figures in other units, such as "3.5 in".
    """
    said = " or ".join(f'"{other}"' for other in others)
    return f"is it in {unit}? Give another unit as in {said}"


def wanted(dimension: Dimension) -> str:
    """Return in words which kind of figure is wanted, with examples."""
    if dimension is PLAIN:
        return "a plain number is wanted, without quotes"
    examples = " or ".join(f'"{e}"' for e in dimension.examples)
    return f"{dimension.name} is wanted: a bare number in {dimension.unit}, or {examples}"
