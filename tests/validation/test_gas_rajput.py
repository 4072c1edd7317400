"""R. K. Rajput: A Textbook of Internal Combustion Engines, chapter 3, as worked in the FOSSEE Python
Textbook Companions. Ideal cycles: nothing is lost while the valves are open.
"""

import pytest
from support.pistons import slider_crank_piston

from balcli.core.gas_cycle import Goal, Process, gas_cycle

PISTON = slider_crank_piston(0.1875, 0.7, 0.25)
AIR = {"compression_index": 1.4, "expansion_index": 1.4, "intake": 1e5, "exhaust": 1e5}


def test_example_3_8():
    """Page 96: Otto, 25 bar, with the ratio rounded to 8."""
    cycle = gas_cycle(PISTON, Process(8.0, **AIR), Goal("max_pressure", 25e5))
    assert round(cycle.imep / 1e5, 2) == 1.34
    assert cycle.imep / 1e5 == pytest.approx(1.335337242, rel=1e-9)
    efficiency = cycle.imep * PISTON.swept / cycle.heat
    assert round(100 * efficiency, 2) == 56.47
    exact = Process(1 + PISTON.swept / 0.00263, **AIR)
    cycle = gas_cycle(PISTON, exact, Goal("max_pressure", 25e5))
    assert cycle.imep / 1e5 == pytest.approx(1.336005605, rel=1e-9)
