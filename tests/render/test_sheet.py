"""Numbers for people: what two machines compute with other last digits reads the same."""

from __future__ import annotations

import pytest

from balcli.render.sheet import degrees, number

NOISE = (-1e-10, -1e-13, 0.0, 1e-13, 1e-10)


@pytest.mark.parametrize(
    ("angle", "turn", "shown"),
    [
        (180, 360, "180.0"),
        (-180, 360, "180.0"),
        (360, 360, "0.0"),
        (0, 360, "0.0"),
        (-90, 360, "-90.0"),
        (-90, 180, "90.0"),
        (90, 180, "90.0"),
        (11.25, 360, "11.2"),
        (33.75, 360, "33.8"),
        (-0.04, 360, "0.0"),
        (359.9, 360, "359.9"),
    ],
)
@pytest.mark.parametrize("noise", NOISE)
def test_an_angle_reads_the_same_whatever_its_rounding(angle: float, turn: float, shown: str, noise: float) -> None:
    assert degrees(angle + noise, turn) == shown


def test_no_angle_is_a_dash() -> None:
    assert degrees(float("nan")) == "–"


@pytest.mark.parametrize(
    ("value", "digits", "shown"),
    [
        (52270.5, 5, "52270"),
        (2409697.5, 5, "2409698"),
        (0.25625, 4, "0.2562"),
        (12.3455, 5, "12.345"),
        (1.5e-5, 1, "2e-5"),
    ],
)
def test_a_half_is_rounded_to_the_same_side_whatever_its_last_digits(value: float, digits: int, shown: str) -> None:
    assert {number(value * (1 + slip), digits) for slip in (-4e-15, 0.0, 4e-15)} == {shown}
