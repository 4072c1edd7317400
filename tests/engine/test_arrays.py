"""Figures as arrays: what rounding alone sets apart is equal."""

from __future__ import annotations

import numpy as np

from balcli.engine.figures import find_first_largest, ranked


def test_what_differs_by_rounding_alone_is_equal_where_it_is_put_in_order():
    values = np.array([1e-7, 3.0, 2.0, 1e9, 0.0, np.inf])
    assert np.array_equal(ranked(values * (1 + 1e-14)), ranked(values))
    assert (np.argsort(ranked(values)) == np.argsort(values)).all()
    assert np.all(ranked(values[:4] * (1 + 1e-9)) > ranked(values[:4]))


def test_of_equal_values_the_first_is_the_largest_whatever_rounding_says():
    third = 0.1 + 0.2  # an ulp above 0.3
    assert find_first_largest([0.2, 0.3, third]) == 1
    assert find_first_largest([0.2, 0.3, 0.3 * (1 + 1e-6)]) == 2
    assert find_first_largest([-third, -0.3, -0.3]) == 0
    columns = [[1.0, 0.0], [1.0 + 1e-15, 0.0], [0.5, 2.0]]
    assert find_first_largest(columns).tolist() == [0, 2]
