"""How modes and forces of mounts spread when the stiffness of each mount varies within a tolerance:
rubber is made to 15 %.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..core.phasors import Array
from ..core.telling import Tell, tell_nobody
from ..enginefile.model import EngineFile, label_table
from ..errors import BalcliError
from ..forces.target_quantity import TargetQuantity
from ..limits import MOST_MOUNT_SAMPLES
from ..mounting.quantity import Variants, refuse_unknown
from .tolerances import PERCENTILES, TOLD, Scatter, Shape, Spread


class MountSource(NamedTuple):
    """The stiffness of one mount, along all its axes alike."""

    mount: str
    tolerance: float

    @property
    def name(self) -> str:
        """As tables have it: `stiffness left`."""
        return f"stiffness {self.mount}"


def scatter_mounts(
    model: EngineFile,
    tolerance: float,
    quantities: Sequence[TargetQuantity],
    samples: int,
    seed: int | None = None,
    shape: Shape = "uniform",
    tell: Tell = tell_nobody,
) -> Scatter:
    """Spread of quantities over random mounts, each variant computed by itself.

    Args:
        tolerance: share of every mount's stiffness.
        seed: of the random numbers, to repeat them.
        shape: uniform within the tolerance, or normal with a third of it as standard deviation.
        tell: is told how many samples have been computed, and says whether these are enough.

    Raises:
        InputError, BalcliError: what is wrong with body and mounts; quantities of none of them; too
            many samples, no tolerance.
    """
    if not 1 <= samples <= MOST_MOUNT_SAMPLES:
        raise BalcliError(
            f"{samples} samples: on mounts, where each is computed by itself, from 1 to "
            f"{MOST_MOUNT_SAMPLES} are allowed"
        )
    if tolerance == 0:
        raise BalcliError("nothing deviates; give a tolerance, such as --stiffness-scatter 15%")
    refuse_unknown(model, quantities)
    variants = Variants(model, quantities)
    labels = [label_table(table, k) for k, table in enumerate(model.mount, 1)]

    def evaluate(factors: Array) -> Array:
        return np.array(variants.evaluate(_vary_stiffness(model, labels, factors)))

    nominal = evaluate(np.ones(len(labels)))
    rows = np.eye(len(labels)) * tolerance
    changes = np.array([(evaluate(1 + row) - evaluate(1 - row)) / 2 for row in rows])
    deviations = _draw(len(labels), samples, tolerance, seed, shape)
    rows_of_values = []
    for row in deviations:
        rows_of_values.append(evaluate(1 + row))
        if tell(len(rows_of_values)):
            break
    values = np.array(rows_of_values)
    sources = [MountSource(label, tolerance) for label in labels]
    spreads = tuple(
        _spread(q, float(nominal[k]), values[:, k], sources, changes[:, k])
        for k, q in enumerate(quantities)
    )
    return Scatter(model, len(values), shape, spreads, of_mounts=True)


def _vary_stiffness(
    model: EngineFile, labels: Sequence[str], factors: Array
) -> Mapping[str, float]:
    return {
        f"mount.{label}.stiffness.{axis}": value * float(factor)
        for label, mount, factor in zip(labels, model.mount, factors, strict=True)
        for axis, value in enumerate(mount.stiffness, 1)
    }


def _draw(count: int, samples: int, tolerance: float, seed: int | None, shape: Shape) -> Array:
    """(samples, count) deviations; of normal ones none makes a spring negative."""
    random = np.random.default_rng(seed)
    if shape == "uniform":
        return tolerance * (2 * random.random((samples, count)) - 1)
    return np.maximum(tolerance / 3 * random.standard_normal((samples, count)), -0.99)


def _spread(
    quantity: TargetQuantity,
    nominal: float,
    values: Array,
    sources: Sequence[MountSource],
    changes: Array,
) -> Spread:
    unit = np.abs(changes).max() * TOLD or 1.0
    shares = sorted(
        zip(sources, map(float, changes), strict=True),
        key=lambda share: -round(abs(share[1]) / unit),
    )
    percentiles = np.percentile(values, list(PERCENTILES.values())).tolist()
    return Spread(
        quantity,
        nominal,
        mean=float(values.mean()),
        percentiles=dict(zip(PERCENTILES, percentiles, strict=True)),
        largest=float(values.max()),
        bound=nominal + float(np.abs(changes).sum()),
        shares=tuple(shares),
    )
