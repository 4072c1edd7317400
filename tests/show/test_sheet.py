"""Numbers for people: what two machines compute with other last digits reads the same."""

import pytest
from support.cases import cases

from balcli.file.assumed import Assumed, Value
from balcli.show.sheet import degrees, number, tell_assumed, write_value

NOISE = (-1e-10, -1e-13, 0.0, 1e-13, 1e-10)


@cases("show/sheet", "an_angle_reads_the_same_whatever_its_rounding")
def test_an_angle_reads_the_same_whatever_its_rounding(angle: float, turn: float, shown: str) -> None:
    assert [degrees(angle + noise, turn) for noise in NOISE] == [shown] * len(NOISE)


def test_no_angle_is_a_dash() -> None:
    assert degrees(float("nan")) == "–"


@cases("show/sheet", "a_half_is_rounded_to_the_same_side_whatever_its_last_digits")
def test_a_half_is_rounded_to_the_same_side_whatever_its_last_digits(value: float, digits: int, shown: str) -> None:
    assert {number(value * (1 + slip), digits) for slip in (-4e-15, 0.0, 4e-15)} == {shown}


# ------------------------------------------------------------------ assumed values
INTAKE = Assumed("gas.intake", 1.0, "bar")
INDEX = Assumed("gas.compression_index", 1.32)


def test_assumed_values_of_single_engines_follow_their_names() -> None:
    aft = [Assumed("rod.cg", 0.0, "mm", "aft"), Assumed("rod.mass", 0.0, "kg", "aft")]
    fore = Assumed("crank.throws", (0.0, 180.0), "deg", "fore")
    words = "layout.strokes = 4; aft: rod.cg = 0 mm, rod.mass = 0 kg; fore: crank.throws = [0, 180] deg"
    assert tell_assumed([*aft, Assumed("layout.strokes", 4), fore]) == words
    assert tell_assumed([fore]) == "fore: crank.throws = [0, 180] deg"
    assert tell_assumed([]) == ""


def test_the_table_gas_is_named_once_for_each_engine() -> None:
    of_a = [value._replace(engine="A") for value in (INTAKE, INDEX)]
    own = "gas.intake = 1 bar, compression_index = 1.32"
    assert tell_assumed([INTAKE, INDEX, *of_a]) == f"{own}; A: {own}"


def test_values_that_are_shown_elsewhere_are_only_named() -> None:
    assert tell_assumed([INTAKE, INDEX], shown={"gas.intake"}) == "gas.intake, compression_index = 1.32"
    assert tell_assumed([INTAKE, INDEX], shown={"gas.compression_index"}) == "gas.intake = 1 bar, compression_index"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (False, "false"),
        (True, "true"),
        (4, "4"),
        (0.0, "0"),
        (22852.84, "22852.8"),
        (3.24e8, "3.24e+08"),
        ("lower dead centre", "lower dead centre"),
        ((0.0, 261.853), "[0, 261.853]"),
        (((1, 3), (2, 4)), "[[1, 3], [2, 4]]"),
    ],
)
def test_values_are_written_as_in_a_file(value: Value, text: str) -> None:
    assert write_value(value) == text
