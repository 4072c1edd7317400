"""New devices as tables of an engine file: plain angles and places, the file's units."""

import cmath
import math

import pytest
from hypothesis import given, strategies as st

from balcli.sizing.fitting import Slot
from balcli.sizing.planes import measure_direction


@given(st.floats(-720, 720), st.floats(-180, 180))
def test_angles_come_back(angle, origin):
    found = measure_direction(cmath.rect(1, math.radians(angle)), origin)
    assert -180 < found <= 180
    assert (found + origin - angle + 180) % 360 - 180 == pytest.approx(0, abs=1e-11)


@pytest.mark.parametrize("angle", [0, 15, 22.5, 30, 45, 90, 120, 135, 180, -30, -54, -162])
def test_plain_angles_are_written_plainly(angle):
    assert measure_direction(cmath.rect(3e-5, math.radians(angle))) == angle


def weigh(unbalance: complex, z: float, first_axis_deg: float = 0.0):
    return Slot("counterweight", 1, 1, z).make_table(unbalance, first_axis_deg)


def test_tables_are_in_the_units_of_the_file():
    weight = weigh(-2e-3 + 0j, -0.0425, 45.0)
    assert (weight.unbalance, weight.angle, weight.position) == (2000.0, 135.0, -42.5)
    turning = Slot("shaft", 2, -1, 0.1, -0.04 + 0.06j).make_table(1e-3j, 45.0)
    assert (turning.ratio, turning.unbalance, turning.angle) == (-2, 1000.0, 90.0)
    assert (turning.at, turning.position) == ((-40.0, 60.0), 100.0)
    sliding = Slot("slider", 2, 0, 0.0, 0j, 90.0).make_table(-1e-3 + 0j, 45.0)
    assert (sliding.order, sliding.unbalance, sliding.direction, sliding.angle) == (2, 1000.0, 90.0, 180.0)


def test_places_are_written_as_people_would():
    """Tenths of a millimetre, whatever metres times 1000 is in binary; and 0 without a sign."""
    assert all(weigh(1e-3, tenth / 1e4).position == tenth / 10 for tenth in range(-3000, 3001))
    nothing = weigh(complex(1e-3, -0.0), -0.0)
    assert (str(nothing.position), str(nothing.angle)) == ("0.0", "0.0")
    assert weigh(1e-3, 0.1 / 3).position == 100 / 3  # what has no short form keeps its digits
