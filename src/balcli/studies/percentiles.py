"""Mean, largest value and percentiles of many random numbers in bounded memory."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.phasors import Array

KEPT = 1_000_000  # numbers of which all is known exactly
BINS = 1 << 20  # into which more are counted
_WIDER = 1.0  # of the range of those kept, on either side: where the others may lie


class Sample:
    """Numbers as they come. The first KEPT are kept; where there are more, all are counted in BINS
    equal parts of three times their range, and percentiles are good to such a part, 3e-6 of it.
    """

    def __init__(self) -> None:
        self._kept: list[Array] = []
        self._count, self._sum = 0, 0.0
        self._counts: Array | None = None
        self._low, self._high = 0.0, 0.0
        self._smallest, self.largest = np.inf, -np.inf

    def add(self, values: Array) -> None:
        """Some more numbers, shape (numbers,)."""
        self._count += len(values)
        self._sum += float(values.sum())
        self._smallest = min(self._smallest, float(values.min(initial=np.inf)))
        self.largest = max(self.largest, float(values.max(initial=-np.inf)))
        if self._counts is not None:
            self._count_in_bins(values, self._counts)
            return
        self._kept.append(values)
        if self._count > KEPT:
            self._count_kept()

    @property
    def mean(self) -> float:
        """Of all numbers."""
        return self._sum / self._count if self._counts is not None else float(self._whole.mean())

    def find_percentiles(self, percentages: Sequence[float]) -> list[float]:
        """The numbers below which these shares of all are."""
        if self._counts is None:
            found: list[float] = np.percentile(self._whole, percentages).tolist()
            return found
        below = np.concatenate([[0.0], np.cumsum(self._counts)])
        edges = np.linspace(self._low, self._high, BINS + 1)
        ranks = np.asarray(percentages) / 100 * self._count
        inside = np.clip(np.interp(ranks, below, edges), self._smallest, self.largest)
        return [float(value) for value in inside]

    @property
    def _whole(self) -> Array:
        self._kept = [np.concatenate(self._kept)]
        return self._kept[0]

    def _count_kept(self) -> None:
        whole = self._whole
        low, high = float(whole.min()), float(whole.max())
        margin = _WIDER * (high - low) or 1.0
        self._low, self._high = low - margin, high + margin
        self._counts = np.zeros(BINS)
        self._count_in_bins(whole, self._counts)
        self._kept = []

    def _count_in_bins(self, values: Array, counts: Array) -> None:
        """Those beyond the ends in the last."""
        share = (values - self._low) / (self._high - self._low)
        np.add.at(counts, np.clip(share * BINS, 0, BINS - 1).astype(np.intp), 1.0)
