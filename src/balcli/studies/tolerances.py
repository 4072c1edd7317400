"""How forces and moments spread when masses, rod lengths and throw angles vary."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from ..core.phasors import Array, Complex, Phasors
from ..core.telling import Tell, tell_nobody
from ..engine.build import build
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..forces.quantity import Quantity, evaluate_quantities, refuse_unknown
from ..limits import MOST_TOLERANCE_SAMPLES
from ..result import Result
from .deviations import DeviatingEngine, Source, Tolerances
from .percentiles import Sample

if TYPE_CHECKING:
    from .part_scatter import PartSource
    from .quantities import ChapterQuantity

RANDOM_ENGINES = 100_000  # samples, unless their number is given
CHUNK = 8_192  # samples at a time
AT_ONCE = 400_000  # deviations at a time, where there are many sources
_EQUAL = 1e-8  # of the largest share: those that differ by less are equal
PERCENTILES = {"p05": 5.0, "p50": 50.0, "p95": 95.0}
SPREADS = ("major", "forward", "backward", "amplitude")
Shape = Literal["uniform", "normal"]


class Drawing(NamedTuple):
    """What is drawn at random.

    Attributes:
        samples: how many.
        seed: of the random numbers, to repeat them.
        shape: uniform within the tolerances, or normal with a third of them as standard deviation.
        tell: is told how many samples have been computed, and says whether these are enough.
    """

    samples: int
    seed: int | None = None
    shape: Shape = "uniform"
    tell: Tell = tell_nobody

    def refuse_beyond(self, most: int, why: str = "") -> None:
        """Nothing, unless there are too many samples, or none; `why` there are no more, in words.

        Raises:
            BalcliError: there are.
        """
        if not 1 <= self.samples <= most:
            raise BalcliError(f"{self.samples} samples: {why}from 1 to {most} are allowed")


@dataclass(frozen=True)
class Spread:
    """One quantity over all samples.

    Attributes:
        nominal: without deviations.
        mean, percentiles, largest: of the samples.
        bound: what no combination of deviations within the tolerances exceeds: the nominal vectors
            and the sizes of all changes added up (exact for masses, to first order for lengths and
            angles). Normal deviations may be larger than their tolerances.
        shares: by source, the change that its tolerance alone makes, to first order; largest first.
    """

    quantity: Quantity | ChapterQuantity
    nominal: float
    mean: float
    percentiles: dict[str, float]
    largest: float
    bound: float
    shares: tuple[tuple[Source | PartSource, float], ...]


@dataclass(frozen=True, repr=False)
class Scatter(Result):
    """Spreads of some quantities of an engine file, over so many random engines.

    Attributes:
        model: the engine file.
        samples: how many.
        shape: of the distribution of each deviation.
        spreads: one a quantity: `nominal`, `mean`, `percentiles`, `largest`, `bound`, `shares`.
        varied: of what there are samples, in words: "engines".
    """

    model: EngineFile
    samples: int
    shape: Shape
    spreads: tuple[Spread, ...]
    varied: str = "engines"

    @property
    def summary(self) -> str:
        """Of what, and how many samples."""
        return f"of {self.model.name or 'an engine'}: {self.samples} samples"


def scatter_engine(
    model: EngineFile, tolerances: Tolerances, quantities: Sequence[Quantity], drawing: Drawing
) -> Scatter:
    """Spread of quantities over random engines.

    Raises:
        BalcliError: quantities that are no sizes of vectors, too many samples, no tolerance at all.
    """
    if strange := [q.name for q in quantities if q.part not in SPREADS]:
        raise BalcliError(
            f"{strange[0]} has no scatter of its own; choose one of {', '.join(SPREADS)} of an "
            "order, such as force.1.major"
        )
    drawing.refuse_beyond(MOST_TOLERANCE_SAMPLES)
    engines = DeviatingEngine(model, tolerances)
    refuse_unknown(build(model), quantities)
    drawn, count = [Sample() for _ in quantities], 0
    for deviations in _draw(engines.sources, drawing):
        found = evaluate_quantities(engines.deviate(deviations), quantities)
        for sample, values in zip(drawn, found, strict=True):
            sample.add(np.broadcast_to(values, deviations.shape[1:]))
        count += deviations.shape[1]
        if drawing.tell(count):
            break
    spreads = [_spread(engines, q, sample) for q, sample in zip(quantities, drawn, strict=True)]
    return Scatter(model, count, drawing.shape, tuple(spreads))


def _draw(sources: Sequence[Source], drawing: Drawing) -> Iterator[Array]:
    """Random deviations chunk by chunk, shape (sources, samples)."""
    random = np.random.default_rng(drawing.seed)
    tolerance = np.array([source.tolerance for source in sources])[:, None]
    most = min(CHUNK, max(AT_ONCE // len(sources), 1))
    for start in range(0, drawing.samples, most):
        size = len(sources), min(most, drawing.samples - start)
        if drawing.shape == "uniform":
            yield tolerance * (2 * random.random(size) - 1)
        else:
            yield tolerance / 3 * random.standard_normal(size)


def _spread(engines: DeviatingEngine, quantity: Quantity, sample: Sample) -> Spread:
    """What the samples and the slopes say of a quantity."""
    nominal, change = engines.find_slopes(quantity)
    vectors, changes = _sides(nominal, quantity.part), _sides(change, quantity.part)
    sizes = [float(np.abs(vector).sum()) for vector in vectors]
    reaches = [
        float(np.abs(vector).sum() + np.abs(each).sum())
        for vector, each in zip(vectors, changes, strict=True)
    ]
    slopes = _find_growth(vectors, changes, np.broadcast_to(change.noise, change.forward.shape)[0])
    percentiles = sample.find_percentiles([*PERCENTILES.values()])
    return Spread(
        quantity,
        nominal=sum(sizes),
        mean=sample.mean,
        percentiles=dict(zip(PERCENTILES, percentiles, strict=True)),
        largest=sample.largest,
        bound=sum(reaches),
        shares=rank_shares(engines.sources, np.broadcast_to(slopes, len(engines.sources))),
    )


def rank_shares(
    sources: Sequence[Source | PartSource], changes: Array
) -> tuple[tuple[Source | PartSource, float], ...]:
    """Each source with its change (sources,), largest first; equal ones in their order."""
    unit = np.abs(changes).max() * _EQUAL or 1.0
    shares = zip(sources, map(float, changes), strict=True)
    return tuple(sorted(shares, key=lambda share: -round(abs(share[1]) / unit)))


def _sides(phasors: Phasors, part: str) -> list[Complex]:
    """The rotating vectors of the only order whose sizes add up to a part of SPREADS, shape
    (*trailing).
    """
    sides = {"forward": phasors.forward[0], "backward": phasors.backward[0]}
    return [sides[part]] if part in sides else list(sides.values())


def _find_growth(vectors: Sequence[Complex], changes: Sequence[Complex], noise: Array) -> Array:
    """By how much the sizes of vectors (shape (1,)) grow together with each change (shape
    (sources,)), 0 within the noise of a change.
    """
    growth = np.asarray(sum(map(_grow, vectors, changes)))
    return np.where(np.abs(growth) <= len(vectors) * noise, 0.0, growth)


def _grow(vector: Complex, change: Complex) -> Array:
    """By how much a vector grows: along itself, or by all of the change where there is none."""
    size = np.abs(vector)
    along = (np.conj(vector) * change).real / np.where(size == 0, 1, size)
    return np.asarray(np.where(size == 0, np.abs(change), along))
