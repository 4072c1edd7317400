"""Numbers for people: what two machines compute with other last digits reads the same."""

import pytest
from support.cases import cases

from balcli.show.sheet import degrees, number

NOISE = (-1e-10, -1e-13, 0.0, 1e-13, 1e-10)


@cases("show/sheet", "an_angle_reads_the_same_whatever_its_rounding")
@pytest.mark.parametrize("noise", NOISE)
def test_an_angle_reads_the_same_whatever_its_rounding(angle: float, turn: float, shown: str, noise: float) -> None:
    assert degrees(angle + noise, turn) == shown


def test_no_angle_is_a_dash() -> None:
    assert degrees(float("nan")) == "–"


@cases("show/sheet", "a_half_is_rounded_to_the_same_side_whatever_its_last_digits")
def test_a_half_is_rounded_to_the_same_side_whatever_its_last_digits(value: float, digits: int, shown: str) -> None:
    assert {number(value * (1 + slip), digits) for slip in (-4e-15, 0.0, 4e-15)} == {shown}
