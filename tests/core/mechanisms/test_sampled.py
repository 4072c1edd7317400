"""As many samples as each mechanism needs: no fewer than its bound of errors allows, whatever stands beside it."""

from functools import cache

import numpy as np
import pytest

from balcli.core.mechanisms import harmonics as sampled
from balcli.core.mechanisms.closed_form import SERIES
from balcli.core.mechanisms.linkage import Rotary, hang

MANY = 4096  # samples: of nothing here an order is left beyond them
FEW = 32
HIGHEST = 40  # order


def random_rods(count: int = 400) -> list[np.ndarray]:
    """Articulated rods up to near their lock: lambda, offset, knuckle, lead, and the master's lambda and offset."""
    rng = np.random.default_rng(5)
    lam = rng.uniform(0.05, 0.6, count)
    master = rng.uniform(0.1, 0.5, count)
    offset, offset_of_master = rng.uniform(-0.1, 0.1, (2, count))
    knuckle = rng.uniform(0.05, 1.2, count) * np.exp(1j * rng.uniform(-0.2, 0.2, count))
    turns = (lam * (1 + np.abs(knuckle)) + np.abs(offset)) < 0.97
    turns &= master + np.abs(offset_of_master) < 0.97
    figures = lam, offset, knuckle, rng.uniform(0, 360, count), master, offset_of_master
    return [values[turns] for values in figures]


def mechanisms(kind: str):
    """How random mechanisms of a kind move, and their figures."""
    rods = random_rods()
    figures = {"articulated": rods, "rotary": rods[:2], "both": [*rods, np.full(len(rods[0]), 0.3)]}
    return hang if kind == "articulated" else Rotary(np.ones(1)).move, figures[kind]


@cache
def of_many_samples(kind: str):
    """All the orders that are asked for."""
    move, figures = mechanisms(kind)
    first = np.full(len(figures[0]), MANY)
    return sampled.sample_mechanisms(range(HIGHEST + 1), SERIES, move, figures, first, HIGHEST)


@pytest.mark.parametrize("orders", [[1, 2], [0, 1, 2, 3, 4], [8], [HIGHEST]], ids=str)
@pytest.mark.parametrize("kind", ["articulated", "rotary", "both"])
def test_few_samples_keep_the_bound(kind, orders):
    move, figures = mechanisms(kind)
    first = np.full(len(figures[0]), FEW)
    few = sampled.sample_mechanisms(orders, SERIES, move, figures, first, max(orders))
    many = of_many_samples(kind)
    assert few[1].max() < MANY
    for name in SERIES:
        error = np.abs(few[0][name].c - many[0][name].c[orders])
        assert np.all(error <= 0.5 * many[0][name].noise), name


def test_a_mechanism_is_the_same_among_any_others(monkeypatch):
    """To the last bit, in large blocks and in small ones."""
    rods = random_rods(60)
    first = np.full(len(rods[0]), FEW)
    together = sampled.sample_mechanisms([1, 2], SERIES, hang, rods, first, 2)
    monkeypatch.setattr(sampled, "_AT_ONCE", 5 * FEW)
    parted = sampled.sample_mechanisms([1, 2], SERIES, hang, rods, first, 2)
    for k in range(0, len(first), 7):
        own = [values[k : k + 1] for values in rods]
        alone = sampled.sample_mechanisms([1, 2], SERIES, hang, own, first[:1], 2)
        assert together[1][k] == parted[1][k] == alone[1][0]
        for name in SERIES:
            values = together[0][name].c[:, k]
            assert np.array_equal(values, parted[0][name].c[:, k]), name
            assert np.array_equal(values, alone[0][name].c[:, 0]), name
