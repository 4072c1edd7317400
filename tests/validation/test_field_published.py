"""Field balancing against published cases.

E01: Bruel & Kjaer Application Note 17-227, example 6. E02: Goodman, J. Eng. Ind. 86 (1964) 273.
E03: Feese and Grazier, Balance This!, 33rd Turbomachinery Symposium 2004. E08: ISO 21940-11.
"""

import numpy as np
import pytest
from support.rotors import three_runs

from balcli.core.records import angle_deg
from balcli.core.unbalance import find_permitted_unbalance
from balcli.field.answer import find_corrections
from balcli.field.runs_file import parse_runs

GOODMAN = """
planes = ["1", "2"]
influence = [["3 @ 0", "2 @ 180"], ["5 @ 0", "2 @ 180"], ["5 @ 0", "3 @ 180"]]
[[run]]
readings = ["1 @ 0", "1 @ 180", "0 @ 0"]
"""
FAN = """
planes = ["1", "2"]
[[run]]
readings = ["0.68 @ 32", "0.56 @ 86", "1.94 @ 231", "2.07 @ 335"]
[[run]]
weights = {{ 1 = "11.1 @ 35" }}
readings = ["1.31 @ 1", "1.25 @ 75", "0.93 @ 251", "1.0 @ 342"]
keep_trial = {keep}
[[run]]
weights = {{ 2 = "3.7 @ 135" }}
readings = ["0.54 @ 9", "0.52 @ 75", "0.81 @ 196", "0.9 @ 296"]
"""


def weights(text: str):
    return [(abs(p.weight), angle_deg(p.weight)) for p in find_corrections(parse_runs(text)).corrections]


def test_bruel_kjaer_example_6():
    """Printed by another program: 1.979 at 236.2, 1.071 at 121.8."""
    (front, rear), result = weights(three_runs()), find_corrections(parse_runs(three_runs()))
    assert front == pytest.approx((1.979467642, 236.1703733), rel=1e-9)
    assert rear == pytest.approx((1.070509308, 121.8438999), rel=1e-9)
    assert np.abs(result.influence) == pytest.approx(
        np.array([[78.43258624, 15.3399355], [9.461969824, 32.55988224]]), rel=1e-9
    )
    assert not result.residual.any()


def test_the_notes_own_answer_belongs_to_another_reading():
    """1.96 at -122 and 1.06 at 121 follow from 189, not 185, in the third run."""
    front, rear = weights(three_runs().replace("185 @ 115", "189 @ 115"))
    assert front == pytest.approx((1.956, 237.4), rel=5e-4)
    assert rear == pytest.approx((1.073, 121.1), rel=5e-4)


def test_goodman_least_squares():
    """17/21 and 31/21; residuals 10/21, 2/21, -8/21."""
    result = find_corrections(parse_runs(GOODMAN))
    assert [p.weight for p in result.corrections] == pytest.approx([17 / 21, 31 / 21], rel=1e-13)
    assert result.residual == pytest.approx(np.array([10, 2, -8]) / 21, rel=1e-13)
    assert result.rms == pytest.approx(0.3563483225, rel=1e-9)


def test_goodman_smallest_largest():
    """By hand: all three residuals are 0.4 at (1, 1.8)."""
    result = find_corrections(parse_runs(GOODMAN), "max")
    assert [p.weight for p in result.corrections] == pytest.approx([1, 1.8], abs=1e-7)
    assert (result.largest, result.bound) == pytest.approx((0.4, 0.4), rel=1e-7)
    assert np.abs(result.residual) == pytest.approx([0.4] * 3, rel=1e-7)


def test_fan_whose_first_trial_weight_stays_in():
    """The paper's 15.3 at 3 and 6.6 at 113, not the 5.4 at -137 of a program that takes the first
    trial weight for taken off.
    """
    first, second = weights(FAN.format(keep="true"))
    assert first == pytest.approx((15.32979775, 2.900369967), rel=1e-8)
    assert second == pytest.approx((6.616894702, 112.8743621), rel=1e-8)
    left = np.abs(find_corrections(parse_runs(FAN.format(keep="true"))).residual)
    assert left == pytest.approx([0.07833039767, 0.09071362293, 0.0504433618, 0.05116882373], rel=1e-8)


def test_fan_if_the_trial_weight_were_taken_off():
    """What the other program expects is the answer to another test: 5.44 at 222.1."""
    first, _ = weights(FAN.format(keep="false"))
    assert first != pytest.approx((15.32979775, 2.900369967), rel=0.1)


@pytest.mark.parametrize(
    ("grade", "permitted"),
    [(4000, 127323.9545), (630, 20053.52283), (16, 509.2958179), (6.3, 200.5352283), (0.4, 12.73239545)],
)
def test_iso_21940_11(grade, permitted):
    """Crankshaft of 20 kg at 6000 rpm, g mm."""
    assert find_permitted_unbalance(grade, 20, 6000) == pytest.approx(permitted, rel=1e-9)


DEPENDENT = """
planes = ["front", "middle", "rear"]
influence = [["1 @ 0", "2 @ 0", "1 @ 90"], ["2 @ 30", "4 @ 30", "1 @ 0"], ["1 @ 60", "2 @ 60", "3 @ 0"]]
[[run]]
readings = ["5 @ 0", "6 @ 0", "7 @ 0"]
"""


def test_planes_that_depend_on_one_another_are_named():
    """The middle does twice what the front does; without one of them it balances."""
    with pytest.raises(Exception, match="cannot separate the effects of front and middle") as caught:
        find_corrections(parse_runs(DEPENDENT), name="runs.toml")
    assert "rear" not in str(caught.value)
    assert len(find_corrections(parse_runs(DEPENDENT), without=["middle"]).corrections) == 2
