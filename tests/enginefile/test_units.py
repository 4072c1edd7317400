"""Figures with units: exact where they can be, refused in words where they are none."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.commands import run_python

from balcli.enginefile import units
from balcli.enginefile.units import (
    ANGLE,
    INERTIA,
    LENGTH,
    MASS,
    PLAIN,
    SPEED,
    TIME,
    UNBALANCE,
    convert,
)


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("3.5 in", LENGTH, 88.9),  # the inch is 25.4 mm exactly
        ("1ft", LENGTH, 304.8),
        ("7/16 in", LENGTH, 11.1125),
        ("-.5 cm", LENGTH, -5.0),
        ("+1e3 m", LENGTH, 1e6),
        ("650 g", MASS, 0.65),
        ("1 lb", MASS, 0.45359237),  # the international pound, exactly
        ("16 oz", MASS, 0.45359237),
        ("1/7 turn", ANGLE, 360 / 7),
        ("1/3 turn", ANGLE, 120.0),
        ("-30 deg", ANGLE, -30.0),
        ("30°", ANGLE, 30.0),
        ("3.141592653589793 rad", ANGLE, 180.0),
        ("8.1 lb in^2", INERTIA, 8.1 * 0.45359237 * 25.4**2),
        ("8.1 lb*in**2", INERTIA, 8.1 * 0.45359237 * 25.4**2),
        ("2 kg·m²", INERTIA, 2e6),
        ("1 kg m", UNBALANCE, 1e6),
        ("12.5 oz in", UNBALANCE, 12.5 * 453.59237 / 16 * 25.4),
        ("6000 rpm", SPEED, 6000.0),
        ("100 turn/s", SPEED, 6000.0),
        ("1 rad/s", SPEED, 30 / math.pi),
        ("5500 1/min", SPEED, 5500.0),
        ("55001/min", SPEED, 55001.0),
        ("5500 min-1", SPEED, 5500.0),
        ("5500. min^-1", SPEED, 5500.0),
        ("5500 min⁻¹", SPEED, 5500.0),
        ("5500 U/min", SPEED, 5500.0),
        ("5500 r/min", SPEED, 5500.0),
        ("5500 rev/min", SPEED, 5500.0),
        ("150 Hz", SPEED, 9000.0),
        ("0.25 rev", ANGLE, 90.0),
        ("820 ms", TIME, 0.82),
    ],
)
def test_common_units(text, dimension, expected):
    assert convert(text, dimension) == pytest.approx(expected, rel=1e-15)


@given(st.integers(1, 10**6), st.integers(1, 10**6))
def test_fractions_of_a_turn_are_rounded_once(above, below):
    assert convert(f"{above}/{below} turn", ANGLE) == float(Fraction(360 * above, below))


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_the_bare_unit_changes_nothing(value):
    assert convert(f"{value!r} mm", LENGTH) == value


@pytest.mark.parametrize("name", [name for name in units.COMMON if name != "°"])
def test_the_table_agrees_with_pint(name):
    here, pint = units.COMMON[name], units._ask_pint(name)
    assert pint.powers == here.powers
    assert float(pint.scale / here.scale) == pytest.approx(1, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("1 yard", LENGTH, 914.4),
        ("1 slug", MASS, 14.5939029372064),  # 1 lbf s^2/ft; NIST SP 811, appendix B
        ("10 inches", LENGTH, 254.0),
        ("100 gon", ANGLE, 90.0),
        ("1 lbf s^2 in", INERTIA, 4.4482216152605 * 0.0254 * 1e6),  # lbf from NIST SP 811
        ("1 ounce inch", UNBALANCE, 28.349523125 * 25.4),
    ],
)
def test_units_that_only_pint_knows(text, dimension, expected):
    assert convert(text, dimension) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "dimension", "message"),
    [
        (
            "90 zorks",
            LENGTH,
            'has the unknown unit "zorks"; a length is wanted: a bare number in mm, or "90 mm" or '
            '"3.5 in"',
        ),
        (
            "775 gr",
            MASS,
            'has the unit "gr": g, or grain (65 mg)? a mass is wanted: a bare number in kg, or '
            '"650 g" or "0.8 lb"',
        ),
        (
            "90 kg",
            LENGTH,
            'is a mass, but a length is wanted: a bare number in mm, or "90 mm" or "3.5 in"',
        ),
        (
            "30 rpm",
            ANGLE,
            (
                'is a speed of rotation, but an angle is wanted: a bare number in deg, or "30 '
                'deg" or "1.2 '
                'rad" or "1/7 turn"'
            ),
        ),
        (
            "50 kHz",
            SPEED,
            'is a frequency, but a speed of rotation is wanted: a bare number in rpm, or "6000 '
            'rpm" or "300 rad/s"',
        ),
        (
            "300 1/s",  # turns, or radians
            SPEED,
            "is not a number followed by a unit; a speed of rotation is wanted: a bare number in "
            'rpm, or "6000 rpm" or "300 rad/s"',
        ),
        (
            "50 Hz",
            ANGLE,
            'is a frequency, but an angle is wanted: a bare number in deg, or "30 deg" or "1.2 '
            'rad" or "1/7 turn"',
        ),
        (
            "72 grad",
            ANGLE,
            'has the unit "grad": deg, or gon (0.9 deg)? an angle is wanted: a bare number in '
            'deg, or "30 deg" or "1.2 rad" or "1/7 turn"',
        ),
        (
            "3 ampere",
            TIME,
            'is of another dimension, but a time is wanted: a bare number in s, or "0.82 s" or '
            '"820 ms"',
        ),
        (
            "20 degC",
            MASS,
            'is of another dimension, but a mass is wanted: a bare number in kg, or "650 g" or '
            '"0.8 lb"',
        ),
        ("5 deg", PLAIN, "is an angle, but a plain number is wanted, without quotes"),
        ("0.25", PLAIN, "has no unit; a plain number is wanted, without quotes"),
        (
            "90",
            LENGTH,
            'has no unit; a length is wanted: a bare number in mm, or "90 mm" or "3.5 in"',
        ),
        ("1e999 mm", LENGTH, "is too large a number"),
        ("1/0 turn", ANGLE, "divides by zero"),
    ],
)
def test_refusals(text, dimension, message):
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - the whole text is compared
        convert(text, dimension)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    "text",
    [
        "mm",
        "",
        "long",
        "9**9**9 mm",
        "90 mm**999999999",
        "90 mm^22",
        "(40+50) mm",
        "40+50 mm",
        "3,5 in",
        "nan mm",
        "inf mm",
        "__import__('os') mm",
        "1e99999 mm",
        "9" * 200 + " mm",
        "90 mm/",
        "90 /mm",
        "90 mm 3",
        "９0 mm",
        "90 mm\n90 mm",
    ],
)
def test_what_is_no_figure_is_never_evaluated(text):
    with pytest.raises(
        ValueError, match=r"^is not a number followed by a unit; a length is wanted"
    ):
        convert(text, LENGTH)


@given(st.text(max_size=30))
def test_any_text_is_read_or_refused_in_words(text):
    outcome: object
    try:
        outcome = convert(text + " mm", LENGTH)
    except ValueError as refusal:
        outcome = str(refusal)
    if isinstance(outcome, str):
        assert "wanted" in outcome or outcome in ("is too large a number", "divides by zero")
    else:
        assert math.isfinite(outcome)


def test_common_units_need_no_pint():
    code = (
        "import sys; from balcli.enginefile.units import INERTIA, convert; convert('8.1 lb in^2', "
        "INERTIA); "
        "sys.exit('pint' in sys.modules)"
    )
    assert run_python("-c", code).returncode == 0


def test_pint_prints_nothing(capfd):
    units._ask_pint.cache_clear()
    units._registry.cache_clear()
    assert convert("1 yard", LENGTH) == pytest.approx(914.4)
    assert capfd.readouterr() == ("", "")
