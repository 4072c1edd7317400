"""Percentiles of more numbers than are kept, against all of them sorted."""

from __future__ import annotations

import numpy as np
import pytest

from balcli.studies import percentiles
from balcli.studies.percentiles import Sample

ASKED = [0.1, 5, 50, 95, 99.9]


def sample_of(values: np.ndarray, at_once: int) -> Sample:
    found = Sample()
    for k in range(0, len(values), at_once):
        found.add(values[k : k + at_once])
    return found


@pytest.mark.parametrize("shape", ["normal", "exponential", "uniform"])
@pytest.mark.parametrize("at_once", [300, 1999])
def test_more_than_are_kept_are_told_to_the_error_stated(
    monkeypatch: pytest.MonkeyPatch, shape: str, at_once: int
) -> None:
    monkeypatch.setattr(percentiles, "KEPT", 5_000)
    values = getattr(np.random.default_rng(3), shape)(size=40_000)
    found = sample_of(values, at_once)
    first = values[: 5_000 + at_once]
    part = 3 * np.ptp(first) / percentiles.BINS
    ordered = np.sort(values)
    for percentage, value in zip(ASKED, found.find_percentiles(ASKED), strict=True):
        rank = int(percentage / 100 * len(values))
        assert ordered[rank - 1] - part <= value <= ordered[rank] + part
    assert found.mean == pytest.approx(values.mean(), rel=1e-12, abs=1e-15)
    assert found.largest == values.max()


def test_so_many_as_are_kept_are_told_exactly() -> None:
    values = np.random.default_rng(4).normal(size=10_000)
    found = sample_of(values, 999)
    assert found.find_percentiles(ASKED) == np.percentile(values, ASKED).tolist()
    assert (found.mean, found.largest) == (float(values.mean()), float(values.max()))


def test_equal_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(percentiles, "KEPT", 10)
    found = sample_of(np.full(100, 7.0), 20)
    assert found.find_percentiles([5, 95]) == [7, 7]
    assert (found.mean, found.largest) == (7, 7)


def test_none_is_beyond_the_smallest_and_the_largest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(percentiles, "KEPT", 10)
    found = sample_of(np.tile(np.linspace(0, 1, 10), 100), 20)
    assert found.find_percentiles([0, 100]) == [0, 1]


def test_memory_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing that has been counted is kept."""
    monkeypatch.setattr(percentiles, "KEPT", 100)
    found = sample_of(np.random.default_rng(5).normal(size=1_000), 60)
    assert found._kept == []
