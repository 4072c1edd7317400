"""Figures with units: exact where they can be, refused in words where they are none."""

import math
import re
from fractions import Fraction

import pytest
from hypothesis import given, strategies as st
from support.cases import cases

from balcli.file import units as unit_table
from balcli.file.fields import STRING_PATTERN
from balcli.file.units import ANGLE, INERTIA, LENGTH, MASS, PLAIN, SPEED, TORQUE, UNBALANCE, convert, read_unit

A_LENGTH = 'a length is wanted: a bare number in mm, or "90 mm" or "3.5 in"'
AN_ANGLE = 'an angle is wanted: a bare number in deg, or "30 deg" or "1.2 rad" or "1/7 turn"'
A_MASS = 'a mass is wanted: a bare number in kg, or "650 g" or "0.8 lb"'
NAMES = {name: unit for name, unit in vars(unit_table).items() if isinstance(unit, type(LENGTH))}
NAMES |= {"AN_ANGLE": AN_ANGLE, "A_LENGTH": A_LENGTH, "A_MASS": A_MASS}


COMMON = cases("file/units", "common_units", **NAMES)


def list_rows(table):
    """The rows of a table of cases, of which there are many and each is tried in no time."""
    return table.args[1]


def test_common_units():
    for text, dimension, expected in list_rows(COMMON):
        assert convert(text, dimension) == pytest.approx(expected, rel=1e-15), text


@given(st.integers(1, 10**6), st.integers(1, 10**6))
def test_fractions_of_a_turn_are_rounded_once(above, below):
    assert convert(f"{above}/{below} turn", ANGLE) == float(Fraction(360 * above, below))


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_the_bare_unit_changes_nothing(value):
    assert convert(f"{value!r} mm", LENGTH) == value


@cases("file/units", "refusals", **NAMES)
def test_refusals(text, dimension, message):
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - the whole text is compared
        convert(text, dimension)
    assert str(caught.value) == message


@cases("file/units", "what_is_no_figure_is_never_evaluated")
def test_what_is_no_figure_is_never_evaluated(text):
    with pytest.raises(ValueError, match=r"^is not a number followed by a unit; a length is wanted"):
        convert(text, LENGTH)


@given(st.text(max_size=30))
def test_any_text_is_read_or_refused_in_words(text):
    try:
        told = "" if math.isfinite(convert(text + " mm", LENGTH)) else "is read as no number"
    except ValueError as refusal:
        told = str(refusal)
    assert "wanted" in told or told in ("", "is too large a number", "divides by zero")


EXACT = cases("file/units", "a_unit_is_as_it_was_defined")
PRINTED = cases("file/units", "a_unit_is_as_tables_print_it")


@pytest.mark.parametrize(("table", "share"), [(EXACT, 2e-16), (PRINTED, 5e-7)], ids=["defined", "printed"])
def test_a_unit_is_as_it_was_defined_or_as_tables_print_it(table, share):
    for names, value in list_rows(table):
        for name in names.split():
            assert float(read_unit(name, PLAIN).scale) == pytest.approx(value, rel=share), name


def test_every_unit_is_among_them():
    listed = {name for table in (EXACT, PRINTED) for names, _ in list_rows(table) for name in names.split()}
    assert set(unit_table.DEFINITIONS) <= listed


def test_no_name_has_two_meanings():
    """Neither a listed unit nor another prefix reads otherwise what a prefix makes."""
    for name in unit_table.DEFINITIONS:
        if found := unit_table.PREFIXED.get(name):
            power, unit = found.split()
            prefixed = read_unit(unit, PLAIN)
            listed = read_unit(name, PLAIN)
            assert (Fraction(power) * prefixed.scale, prefixed.powers) == listed, name
    assert set(unit_table.DEFINITIONS).isdisjoint(unit_table.AMBIGUOUS)


@cases("file/units", "pounds_are_a_force_where_only_that_fits", **NAMES)
def test_pounds_are_a_force_where_only_that_fits(pounds, force, dimension):
    """American drawings have lb for both."""
    assert convert(f"3 {pounds}", dimension) == convert(f"3 {force}", dimension)


def test_pounds_stay_a_mass_where_that_fits():
    assert convert("3 lb ft2", INERTIA) == pytest.approx(3 * 0.45359237 * 304.8**2, rel=1e-15)


@cases("file/units", "refusals_say_what_is_near", **NAMES)
def test_refusals_say_what_is_near(text, dimension, begin):
    if begin is None:
        assert convert(text, dimension) == 50.8
        return
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - its beginning is compared
        convert(text, dimension)
    assert str(caught.value).startswith(begin)


@pytest.mark.parametrize(
    "text",
    ["pi", "-π", "pi/2", "2π", '3.5"', "5500 min⁻¹", "86 мм", "０,5 Kg", "½ in.", "3 1/2 in", "3-1/2 in", "9 kgf/cm2"],
)
def test_editors_take_what_is_read(text):
    assert re.search(STRING_PATTERN, text)


SPELLINGS = {  # of one unit, with the dimension of the figure
    LENGTH: (["mm", "MM", "мм", "㎜", "millimetre"], ["in", "In", "in.", "inches", '"', "″"], ["cm", "см", "CM"]),
    MASS: (["kg", "Kg", "KG", "кг", "㎏"], ["g", "г", "gram"], ["oz", "Oz", "ounces"]),
    UNBALANCE: (
        ["g mm", "gmm", "g·mm", "g.mm", "г·мм"],
        ["oz in", "ozin", "in-oz", "oz·in"],
        ["kg cm", "kgcm", "кг·см"],
    ),
    SPEED: (["rpm", "RPM", "Rpm", "r.p.m.", "1/min", "min⁻¹", "об/мин"], ["rad/s", "рад/с"]),
    TORQUE: (["N m", "Nm", "N·m", "Н·м", "Нм"], ["kN m", "kNm", "кН·м", "KN m"], ["lbf ft", "lbfft", "ftlb", "lb-ft"]),
    INERTIA: (["kg m^2", "kg m²", "kgm2", "кг·м²", "kg*m**2"],),
}
GROUPS = [(dimension, group) for dimension, groups in SPELLINGS.items() for group in groups]


def numbers_as_people_write_them(number):
    """Spellings of a number of at most two decimals."""
    plain = f"{number:.2f}"
    yield from (plain, plain.replace(".", ","), f"+{plain}", plain.translate({48 + k: 0xFF10 + k for k in range(10)}))
    yield f"{plain}e0"
    if number >= 1000:
        for blank in (" ", "\u00a0", "\u202f", "'"):
            yield f"{number:,.2f}".replace(",", blank)


@given(st.integers(1, 10**9), st.sampled_from(GROUPS), st.data())
def test_one_figure_in_any_spelling_has_one_value(hundredths, group, data):
    dimension, units = group
    number = hundredths / 100
    expected = convert(f"{number:.2f} {units[0]}", dimension)
    figure = data.draw(st.sampled_from(list(numbers_as_people_write_them(number))))
    unit = data.draw(st.sampled_from(units))
    blank = data.draw(st.sampled_from(["", " ", "\u00a0"]))
    if unit == "1/min":
        blank = " "
    assert convert(f"{figure}{blank}{unit}", dimension) == expected


@given(st.integers(1, 999), st.integers(0, 999), st.sampled_from(GROUPS))
def test_thousands_with_a_comma_are_asked_back(thousands, rest, group):
    dimension, units = group
    with pytest.raises(ValueError, match=f"is {thousands}.{rest:03d} meant, or {thousands}{rest:03d}") as caught:
        convert(f"{thousands},{rest:03d} {units[0]}", dimension)
    assert " wanted" in str(caught.value)
