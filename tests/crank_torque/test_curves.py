"""What gas does in one cylinder, over the crank angle."""

import numpy as np

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
    return curves(engine, step=15, cylinder=1)


def test_gas_does_the_same_in_a_cylinder_that_turns():
    """At rest but for a hundredth of a turn in a minute. All that acts across counts to where the crank pin goes after
    top dead centre, the angle of the rod too: while gas presses, the piston leans away from the crank pin.
    """
    plain = of_cylinder().curves
    turning = of_cylinder(rotary=True).curves
    for name in ("rod_angle_deg", "side_thrust_N", "rod_force_N", "pin_x_N", "pin_y_N", "torque_Nm"):
        np.testing.assert_allclose(turning[name], plain[name], atol=1e-6 * np.abs(plain[name]).max())
    burning = slice(1, 9)  # 15 to 120 degrees
    assert (turning["rod_angle_deg"][burning] > 0).all()
    assert (turning["side_thrust_N"][burning] < 0).all()
    assert (turning["pin_y_N"][burning] > 0).all()
