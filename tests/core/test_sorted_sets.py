"""Sets of numbers as numpy has them, which imports masked arrays for it."""

import numpy as np
import pytest

from balcli.core.sorted_sets import are_among, find_middle, sort_distinct, sort_others


@pytest.mark.parametrize("kind", [float, np.intp])
@pytest.mark.parametrize("shape", [(0,), (1,), (40,), (8, 5)])
@pytest.mark.parametrize("count", [0, 1, 20])
def test_as_numpy_has_them(kind, shape, count):
    random = np.random.default_rng(count)
    values = random.integers(-9, 9, shape).astype(kind)
    known = random.integers(-9, 9, count).astype(kind)
    found = sort_distinct(values)
    assert found.dtype == values.dtype
    np.testing.assert_array_equal(found, np.unique(values))
    np.testing.assert_array_equal(sort_others(values, known), np.setdiff1d(values, known))
    np.testing.assert_array_equal(are_among(values, known), np.isin(values, known))


def test_the_middle_one():
    assert find_middle(np.array([3.0, -1.0, 7.0])) == 3
    assert find_middle(np.array([[4, 1], [2, 3]])) == 3
