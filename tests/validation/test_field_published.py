"""Field balancing against Goodman, J. Eng. Ind. 86 (1964) 273, and ISO 21940-11; `tests/published` has more."""

import numpy as np
import pytest

from balcli.core.unbalance import find_permitted_unbalance
from balcli.field_balancing.answer import find_corrections
from balcli.field_balancing.runs_file import parse_runs

GOODMAN = """
planes = ["1", "2"]
influence = [["3 @ 0", "2 @ 180"], ["5 @ 0", "2 @ 180"], ["5 @ 0", "3 @ 180"]]
[[run]]
readings = ["1 @ 0", "1 @ 180", "0 @ 0"]
"""


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
