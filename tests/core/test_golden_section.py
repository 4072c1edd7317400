"""Where a function of one number is least."""

from __future__ import annotations

import math

import pytest

from balcli.core.extrema import find_least


@pytest.mark.parametrize("place", [0.0, 0.1, math.pi / 10, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("power", [1, 2])
def test_the_bottom_of_a_valley(place, power):
    assert find_least(lambda x: abs(x - place) ** power, 0, 1) == pytest.approx(place, abs=1e-4)


def test_on_a_flat_bottom_the_next_part_counts():
    """Flat from 0.3 to 0.6, where the second part falls; beyond, it goes on falling."""
    found = find_least(lambda x: (max(0.3 - x, 0.0, x - 0.6), -x), 0, 1)
    assert found == pytest.approx(0.6, abs=1e-4)


def test_it_judges_few_places():
    judged = []
    find_least(lambda x: judged.append(x) or abs(x - 0.4), 0, 1)
    assert len(judged) == len(set(judged)) <= 22
