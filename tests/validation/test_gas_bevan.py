"""T. Bevan: The Theory of Machines, chapter 12, as worked in the FOSSEE Python Textbook Companions; `tests/published`
has more examples.
"""

import numpy as np
import pytest

from balcli.core.shaft_speed import small_fluctuation


def test_example_12_8():
    """Page 443: flywheel for 2500 ft lb about 120 rpm within 1 %."""
    slugs = small_fluctuation(2500, 3.5**2, 120 * np.pi / 30) / 0.01
    assert round(slugs * 32.2 / 2240, 2) == 1.86
    assert slugs * 32.2 / 2240 == pytest.approx(1.857770427, rel=1e-9)
