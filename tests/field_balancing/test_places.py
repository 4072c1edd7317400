"""A weight spread over places: it adds up, is the lightest, and what cannot be is said."""

from itertools import combinations

import numpy as np
import pytest

from balcli.field_balancing.places import find_region, split_weight


def total(placed):
    return sum(p.weight * np.exp(1j * np.radians(p.angle_deg)) for p in placed)


def test_two_neighbours_share_by_the_law_of_sines():
    """30 deg between holes at 0 and 90: cos 30 and sin 30; a place that is just right takes all."""
    at = split_weight(10 * np.exp(1j * np.pi / 6), np.array([0.0, 90, 180, 270]), np.inf)
    assert [p.angle_deg for p in at] == [0, 90]
    assert [p.weight for p in at] == pytest.approx([10 * np.sqrt(0.75), 5], rel=1e-12)
    (one,) = split_weight(-3j, np.arange(0.0, 360, 30), 5)
    assert (one.angle_deg, one.weight) == (270, pytest.approx(3, rel=1e-12))


def inside(region, x, noise: float) -> bool:
    return abs(region.project(x)[0] - x) <= noise


def lightest(wanted, angles, most):
    """The least total of all basic solutions: two places free, every other empty or full."""
    unit = np.exp(1j * np.radians(angles))
    best = np.inf
    for i, j in combinations(range(len(angles)), 2):
        others = [k for k in range(len(angles)) if k not in (i, j)]
        system = np.array([[unit[i].real, unit[j].real], [unit[i].imag, unit[j].imag]])
        if abs(np.linalg.det(system)) < 1e-9:
            continue
        for filled in range(2 ** len(others)):
            full = [k for n, k in enumerate(others) if filled >> n & 1]
            rest = wanted - most * unit[full].sum()
            free = np.linalg.solve(system, [rest.real, rest.imag])
            if free.min() >= -1e-9 and free.max() <= most * (1 + 1e-9):
                best = min(best, most * len(full) + free.sum())
    return best


@pytest.mark.parametrize("seed", range(25))
def test_it_is_the_lightest_within_the_limit(seed):
    rng = np.random.default_rng(seed)
    angles = rng.uniform(0, 360, 7)
    wanted = complex(*rng.normal(size=2))
    most = float(rng.uniform(0.2, 1))
    placed = split_weight(wanted, angles, most)
    best = lightest(wanted, angles, most)
    if placed is None:
        assert best == np.inf
        assert not inside(find_region(angles, most), wanted, 1e-9)
        return
    assert inside(find_region(angles, most), wanted, 1e-12)
    assert [angles[p.place - 1] for p in placed] == pytest.approx([p.angle_deg for p in placed])
    assert total(placed) == pytest.approx(wanted, rel=1e-9)
    assert max(p.weight for p in placed) <= most * (1 + 1e-9)
    assert sum(p.weight for p in placed) == pytest.approx(best, rel=1e-9)


def test_a_region_is_where_weights_reach():
    square = find_region(np.array([0.0, 90, 180, 270]), 2)
    assert split_weight(3 + 0j, np.array([0.0, 90, 180, 270]), 2) is None
    assert (inside(square, 2, 1e-9), inside(square, 2.01, 1e-9)) == (True, False)
    assert (inside(square, 2 + 2j, 1e-9), inside(square, 2 + 2.01j, 1e-9)) == (True, False)
    wedge = find_region(np.array([-60.0, 0, 60]), np.inf)
    assert (inside(wedge, 1e6, 0), inside(wedge, -1, 1e-9)) == (True, False)
    assert inside(wedge, np.exp(1j * np.pi / 3), 1e-9)
    assert not inside(wedge, np.exp(1j * np.pi / 2.9), 1e-9)
    assert split_weight(0j, np.array([0.0]), 1) == ()


@pytest.mark.parametrize("most", [2.0, np.inf])
def test_regions_without_area(most):
    """One place, and two that are opposite: a ray and a line."""
    ray = find_region(np.array([90.0]), most)
    line = find_region(np.array([90.0, 270]), most)
    assert (inside(ray, 1.9j, 1e-9), inside(ray, -1j, 1e-9), inside(ray, 1, 1e-9)) == (True, False, False)
    assert (inside(line, 1.9j, 1e-9), inside(line, -1.9j, 1e-9), inside(line, 1, 1e-9)) == (True, True, False)
    assert inside(ray, 2.1j, 1e-9) == (most == np.inf)


def test_many_places_of_small_weights():
    """720 of them, of which an arc is full: quick, and right."""
    angles = np.arange(720) / 2
    placed = split_weight(100j, angles, 0.6)
    assert total(placed) == pytest.approx(100j, rel=1e-9)
    assert len(placed) > 150
    region = find_region(angles, 0.6)
    whole = 0.6 / np.sin(np.radians(0.25))  # all places of half a turn: a chord of the polygon
    assert inside(region, 1j * whole * 0.99999, 0)
    assert not inside(region, 1j * whole * 1.00001, 0)
