"""T. Bevan: The Theory of Machines, chapter 12, as worked in the FOSSEE Python Textbook Companions;
pounds, feet and inches as printed.
"""

import numpy as np
import pytest
from support import two_term
from support.pistons import slider_crank_piston

from balcli.core.speed_ripple import small_fluctuation


def test_example_12_3():
    """Page 415: crank effort of a steam engine at 40 deg. The figure is that of the two-term
    velocity; exact is 0.11 % more.
    """
    effort = 160 * np.pi / 4 * 9**2 - 32 * np.pi / 4 * (9**2 - 2**2)  # lb
    psi = np.array(np.radians(40))
    two = effort * float(two_term.velocity(psi, 1 / 5))  # the crank is 1 ft
    assert two == pytest.approx(6110, abs=1)
    assert two == pytest.approx(6110.674932, rel=1e-9)
    exact = effort * float(slider_crank_piston(1.0, 5.0, 0.75).rate(psi))
    assert exact == pytest.approx(6117.467822, rel=1e-9)


def test_example_12_8():
    """Page 443: flywheel for 2500 ft lb about 120 rpm within 1 %."""
    speed = 120 * np.pi / 30
    slugs = small_fluctuation(2500, 3.5**2, speed) / 0.01
    assert round(slugs * 32.2 / 2240, 2) == 1.86
    assert slugs * 32.2 / 2240 == pytest.approx(1.857770427, rel=1e-9)
