"""What gas does in one cylinder, over the crank angle."""

from __future__ import annotations

import numpy as np
import pytest

from balcli import Curves, curves, load

ONE = {
    "crank": {"stroke": 80},
    "rod": {"length": 140},
    "piston": {"mass": 0.1, "bore": 80},
    "gas": {"cycle": "otto", "compression_ratio": 8, "imep": 8},
    "operation": {"speed": 0.01},
}


def of_cylinder(**layout: object) -> Curves:
    engine = load(ONE | {"layout": {"firing_order": [1], **layout}})
    return curves(engine, step_deg=15, cylinder=1)


@pytest.mark.parametrize("name", ["rod_angle_deg", "side_thrust_N", "rod_force_N", "pin_x_N", "pin_y_N", "torque_Nm"])
def test_gas_does_the_same_in_a_cylinder_that_turns(name):
    """At rest but for a hundredth of a turn in a minute. All that acts across counts to where the
    crank pin goes after top dead centre, the angle of the rod too.
    """
    plain, turning = of_cylinder().curves[name], of_cylinder(rotary=True).curves[name]
    np.testing.assert_allclose(turning, plain, atol=1e-6 * np.abs(plain).max())


def test_while_gas_presses_the_piston_leans_away_from_the_crank_pin():
    found = of_cylinder(rotary=True).curves
    burning = slice(1, 9)  # 15 to 120 degrees
    assert (found["rod_angle_deg"][burning] > 0).all()
    assert (found["side_thrust_N"][burning] < 0).all()
    assert (found["pin_y_N"][burning] > 0).all()
