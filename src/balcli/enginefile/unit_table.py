"""The units that a figure may have: each is told by others, down to the few of `units.py`.

Sources: the SI brochure (2019) for what is metric; the international yard and pound (1959) for the
inch and the pound, which `units.py` has, and all that is made of them; CGPM 1901 for standard
gravity; NIST SP 811 (2008), appendix B, for the rest.
"""

from __future__ import annotations

_ROWS = {
    # length
    "metre meter": "1 m",
    "micron": "1 um",
    "inch inches": "1 in",
    "mil thou": "0.001 in",
    "ft foot feet": "12 in",
    "yd yard": "3 ft",
    # mass
    "gram gramme": "1 g",
    "t tonne": "1000 kg",
    "pound lbm": "1 lb",
    "oz ozm ounce": "1/16 lb",
    "stone": "14 lb",
    "grain": "1/7000 lb",
    "slug": "1 lbf s^2/ft",
    "slinch blob": "1 lbf s^2/in",
    # time
    "sec second": "1 s",
    "min minute": "60 s",
    "h hr hour": "3600 s",
    "d day": "24 h",
    # angle; r, U (German Umdrehung) and tr (French tour) are revolutions
    "rev revolution r U tr": "1 turn",
    "radian": "1 rad",
    "pi": "1/2 turn",
    "deg degree °": "1/360 turn",
    "arcmin arcminute": "1/60 deg",
    "arcsec arcsecond": "1/3600 deg",
    "gon gradian": "1/400 turn",
    # speed of rotation, frequency
    "rpm": "1 turn/min",
    "rps": "1 turn/s",
    "Hz hertz": "1 s^-1",
    # force
    "N newton": "1 kg m/s^2",
    "dyn dyne": "1e-5 N",
    "kgf kp kilopond": "1 kg g_n",
    "gf pond": "1 g g_n",
    "tf": "1 t g_n",
    "lbf": "1 lb g_n",
    "ozf": "1 oz g_n",
    "kip": "1000 lbf",
    "pdl poundal": "1 lb ft/s^2",
    # pressure and stress
    "Pa pascal": "1 N/m^2",
    "bar bara": "100000 Pa",
    "atm atmosphere": "101325 Pa",
    "at": "1 kgf/cm^2",
    "torr Torr": "1/760 atm",
    "mmHg": "133.322387415 Pa",  # 13 595.1 kg/m3, standard gravity
    "inHg": "25.4 mmHg",
    "psi psia": "1 lbf/in^2",
    "psf": "1 lbf/ft^2",
    "ksi": "1000 psi",
    "Msi": "1000000 psi",
    # torque, energy, power
    "J joule": "1 N m",
    "erg": "1e-7 J",
    "Wh": "3600 J",
    "Btu BTU": "1055.05585262 J",  # of the International Table
    "W watt": "1 J/s",
    "hp": "550 ft lbf/s",
    "PS ch cv": "75 kgf m/s",
    # written together
    "Nm": "1 N m",
    "Nmm": "1 N mm",
    "Ns": "1 N s",
    "Nms": "1 N m s",
    "gmm": "1 g mm",
    # volume: no field has it, but people know it
    "l L litre liter": "1 dm^3",
    "cc ccm": "1 cm^3",
    # known, but no field has anything to do with them
    "K kelvin °C degC celsius °F degF fahrenheit": "1 of_another_kind",
    "A amp ampere V volt ohm mol mole cd candela": "1 of_another_kind",
}
DEFINITIONS = {name: figure for names, figure in _ROWS.items() for name in names.split()}

AMBIGUOUS = {
    "gr": "g, or grain (65 mg)?",
    "gm": "g, or gigametre?",
    "Mm": "mm, or megametre?",
    "MG": "mg, or Mg (1000 kg)?",
    "NM": "N m, or nanometre?",
    "ton": "t (1000 kg), or 2000 lb, or 2240 lb?",
    "cwt": "100 lb, or 112 lb?",
    "barg": "bar over the atmosphere? Absolute it is 1.01325 bar more;",
    "psig": "psi over the atmosphere? Absolute it is 14.696 psi more;",
    "grad": "deg, or gon (0.9 deg)?",
    "grade": "deg, or gon (0.9 deg)?",
    "cycle": "turn, or the two of a four-stroke engine?",
    "cpm": "rpm, or cycles of two turns in a minute?",
    "cal": "4.184 J, or 4.1868 J?",
    "kcal": "4184 J, or 4186.8 J?",
}

_PREFIXES = {
    "G giga": 9,
    "M mega": 6,
    "k kilo": 3,
    "h hecto": 2,
    "da deca deka": 1,
    "d deci": -1,
    "c centi": -2,
    "m milli": -3,
    "µ μ u micro": -6,
    "n nano": -9,
}
_SYMBOLS = "m g s rad N Pa bar J W Wh Hz Nm Ns Nms psi rpm"
_WORDS = "metre meter gram gramme second radian newton pascal bar joule watt hertz"


# "kPa" -> (3, "Pa"), "millimetre" -> (-3, "metre")
PREFIXED = {
    prefix + unit: (power, unit)
    for prefixes, power in _PREFIXES.items()
    for prefix in prefixes.split()
    for unit in (_SYMBOLS if len(prefix) < 3 else _WORDS).split()
}


def find_near_name(name: str) -> str:
    """The unit that was probably meant; empty if none comes to mind."""
    from difflib import get_close_matches  # after a mistake alone

    usual = [prefix + unit for prefix in "mcMk" for unit in _SYMBOLS.split()]
    units = (*usual, *_SYMBOLS.split(), *DEFINITIONS)
    known = {unit.lower(): unit for unit in units if unit not in AMBIGUOUS}
    near = get_close_matches(name.lower(), known, 1, 0.75)
    return known[near[0]] if near else ""
