"""New devices as tables of an engine file: plain angles and places, the file's units."""

from __future__ import annotations

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from balcli.sizing.device_tables import make_counterweight, make_shaft, make_slider, measure_direction


@given(st.floats(-720, 720), st.floats(-180, 180))
def test_angles_come_back(angle, origin):
    found = measure_direction(cmath.rect(1, math.radians(angle)), origin)
    assert -180 < found <= 180
    assert (found + origin - angle + 180) % 360 - 180 == pytest.approx(0, abs=1e-11)


@pytest.mark.parametrize("angle", [0, 15, 22.5, 30, 45, 90, 120, 135, 180, -30, -54, -162])
def test_plain_angles_are_written_plainly(angle):
    assert measure_direction(cmath.rect(3e-5, math.radians(angle))) == angle


def test_tables_are_in_the_units_of_the_file():
    weight = make_counterweight(-2e-3 + 0j, -0.0425, 45.0)
    assert (weight.unbalance, weight.angle, weight.position) == (2000.0, 135.0, -42.5)
    turning = make_shaft(1e-3j, -2, 0.1, -0.04 + 0.06j)
    assert (turning.ratio, turning.unbalance, turning.angle, turning.at, turning.position) == (
        -2,
        1000.0,
        90.0,
        (-40.0, 60.0),
        100.0,
    )
    sliding = make_slider(-1e-3 + 0j, 2, 90.0, 0.0, 0j)
    assert (sliding.order, sliding.unbalance, sliding.direction, sliding.angle) == (2, 1000.0, 90.0, 180.0)


def test_places_are_written_as_people_would():
    """Tenths of a millimetre, whatever metres times 1000 is in binary; and 0 without a sign."""
    assert all(make_counterweight(1e-3, tenth / 1e4, 0.0).position == tenth / 10 for tenth in range(-3000, 3001))
    nothing = make_counterweight(complex(1e-3, -0.0), -0.0, 0.0)
    assert (str(nothing.position), str(nothing.angle)) == ("0.0", "0.0")
    assert make_counterweight(1e-3, 0.1 / 3, 0.0).position == 100 / 3  # what has no short form keeps its digits
