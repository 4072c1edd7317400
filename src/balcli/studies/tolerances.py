"""How free forces and moments spread when masses, rod lengths and throw angles vary within
tolerances.

Every piston, rod and throw deviates by itself. Samples are variants of the engine along one
trailing axis.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.phasors import Phasors
from ..engine.build import Engine, build
from ..engine.layout import plan_cylinders
from ..enginefile.fields import Number
from ..enginefile.model import EngineFile
from ..enginefile.units import ANGLE
from ..errors import BalcliError
from ..forces.quantity import Quantity, evaluate
from ..forces.spectrum import spectra
from ..limits import MOST_TOLERANCE_SAMPLES

Array = NDArray[np.float64]
CHUNK = 8_192  # samples at a time
AT_ONCE = 400_000  # deviations at a time, where there are many sources
TOLD = 1e-8  # of the largest share: those that differ by less are equal
STEP = 1e-3  # of a tolerance, for derivatives; masses act linearly, so that theirs are exact
PERCENTILES = {"p05": 5.0, "p50": 50.0, "p95": 95.0}
SPREADS = ("major", "forward", "backward", "amplitude")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?", re.ASCII)
Shape = Literal["uniform", "normal"]


@dataclass(frozen=True)
class Tolerances:
    """Largest deviations: of masses and rod lengths relative to themselves, of throw angles in
    degrees.
    """

    mass: float = 0.0
    length: float = 0.0
    angle_deg: float = 0.0


def tolerances(mass: str, length: str, angle: str) -> Tolerances:
    """From texts such as `0.5%`, `0.05%` and `0.2 deg`.

    Raises:
        BalcliError: what is neither, negative or absurdly large.
    """
    degrees = Number(ANGLE, least=0, most=90)
    try:
        return Tolerances(
            _share(mass, "--mass-scatter"),
            _share(length, "--length-scatter"),
            degrees.read(float(angle) if _NUMBER.fullmatch(angle.strip()) else angle),
        )
    except ValueError as error:
        raise BalcliError(f"--angle-scatter {error}") from None


def _share(text: str, option: str) -> float:
    number = text.strip().removesuffix("%")
    if (
        text.strip() == number
        or not _NUMBER.fullmatch(number.strip())
        or not 0 <= float(number) < 100
    ):
        raise BalcliError(f'{option} "{text}": give a percentage of 0 to 100, such as 0.5%')
    return float(number) / 100


class Source(NamedTuple):
    """One thing that deviates: `piston mass`, `rod mass`, `throw mass`, `rod length` or `throw
    angle`, whose, and by how much.
    """

    what: str
    number: int
    tolerance: float

    @property
    def name(self) -> str:
        return f"{self.what} {self.number}"


@dataclass(frozen=True)
class Spread:
    """One quantity over all samples.

    Attributes:
        nominal: without deviations.
        mean, percentiles, largest: of the samples.
        bound: what no combination of deviations exceeds: the nominal vectors and the sizes of all
        changes added up (exact for
            masses, to first order for lengths and angles).
        shares: by source, the change that its tolerance alone makes, to first order; largest first.
    """

    quantity: Quantity
    nominal: float
    mean: float
    percentiles: dict[str, float]
    largest: float
    bound: float
    shares: tuple[tuple[Source, float], ...]


@dataclass(frozen=True)
class Scatter:
    """All quantities."""

    file: EngineFile
    samples: int
    spreads: tuple[Spread, ...]


def scatter(
    file: EngineFile,
    tolerances: Tolerances,
    quantities: Sequence[Quantity],
    samples: int,
    seed: int | None = None,
    shape: Shape = "uniform",
) -> Scatter:
    """Spread of quantities over random engines.

    Args:
        shape: uniform within the tolerances, or normal with a third of them as standard deviation.

    Raises:
        BalcliError: quantities that are no sizes of vectors, too many samples, no tolerance at all.
    """
    if strange := [q.name for q in quantities if q.part not in SPREADS]:
        raise BalcliError(
            f"{strange[0]} has no scatter of its own; choose one of {', '.join(SPREADS)} of an "
            "order, such as force.1.major"
        )
    if not 1 <= samples <= MOST_TOLERANCE_SAMPLES:
        raise BalcliError(f"{samples} samples: from 1 to {MOST_TOLERANCE_SAMPLES} are allowed")
    if file.layout.rotary:
        raise BalcliError(
            "there is no scatter of rotary engines, whose masses move on curves: vary single "
            "masses with sweep"
        )
    crowd = _Crowd(file, tolerances)
    if not crowd.sources:
        raise BalcliError("nothing deviates; give a tolerance, such as --mass-scatter 0.5%")
    found = np.concatenate(
        [
            np.stack(
                [np.broadcast_to(v, count) for v in evaluate(crowd.engine(deviations), quantities)]
            )
            for count, deviations in _drawn(crowd.sources, samples, seed, shape)
        ],
        axis=1,
    )
    return Scatter(
        file,
        samples,
        tuple(_spread(crowd, q, values) for q, values in zip(quantities, found, strict=True)),
    )


def _drawn(
    sources: Sequence[Source], samples: int, seed: int | None, shape: Shape
) -> Iterator[tuple[int, Array]]:
    """Deviations in chunks, shape (sources, samples)."""
    random = np.random.default_rng(seed)
    tolerance = np.array([s.tolerance for s in sources])[:, None]
    chunk = min(CHUNK, max(AT_ONCE // len(sources), 1))
    for start in range(0, samples, chunk):
        count = min(chunk, samples - start)
        if shape == "uniform":
            yield count, tolerance * (2 * random.random((len(sources), count)) - 1)
        else:
            yield count, tolerance / 3 * random.standard_normal((len(sources), count))


class _Crowd:
    """Engines of one file with deviations."""

    def __init__(self, file: EngineFile, tolerances: Tolerances) -> None:
        self._engine = build(file, rank=1)
        cells = {cell.number: cell for cell in plan_cylinders(file.crank, file.layout).cells}
        self._throws = [cells[n].throw for n in self._engine.numbers]
        bare = build(_without(file, "piston"), rank=1).cylinders
        self._pistons = self._whole(self._engine.cylinders.reciprocating - bare.reciprocating)
        self._webs = self._whole(
            self._engine.cylinders.rotating
            - build(_without(file, "throw"), rank=1).cylinders.rotating
        )
        rods, throws = sorted(self._engine.numbers), range(1, 1 + max(self._throws) + 1)
        self.sources = [
            Source(what, number, tolerance)
            for what, numbers, tolerance, there in (
                ("piston mass", rods, tolerances.mass, self._pistons.any()),
                ("rod mass", rods, tolerances.mass, self._rods.any()),
                ("throw mass", throws, tolerances.mass, self._webs.any()),
                ("rod length", rods, tolerances.length, True),
                ("throw angle", throws, tolerances.angle_deg, True),
            )
            if tolerance and there
            for number in numbers
        ]

    @property
    def _rods(self) -> Array:
        """Rods' masses at the piston pin and at the crank pin, shape (2, cylinders, 1)."""
        c = self._engine.cylinders
        return np.stack(
            [self._whole(c.reciprocating) - self._pistons, self._whole(c.rotating) - self._webs]
        )

    def _whole(self, rows: Array) -> Array:
        return np.broadcast_to(rows, (len(self._throws), rows.shape[1]))

    def engine(self, deviations: Array) -> Engine:
        """Engines with deviations of the sources, shape (sources, samples); masses and lengths
        relative, angles in degrees.
        """
        by_cylinder = {
            what: self._of_cylinders(what, deviations) for what in {s.what for s in self.sources}
        }
        c, none = self._engine.cylinders, np.zeros((1, 1))
        piston, rod, web, length, angle = (
            by_cylinder.get(what, none)
            for what in ("piston mass", "rod mass", "throw mass", "rod length", "throw angle")
        )
        small, big = self._rods
        changed = replace(
            c,
            reciprocating=c.reciprocating + piston * self._pistons + rod * small,
            rotating=c.rotating + web * self._webs + rod * big,
            couple=c.couple * (1 + rod),
            lam=c.lam / (1 + length),
            eps=c.eps / (1 + length),
            pin_deg=c.pin_deg + angle,
            linkage=c.linkage and replace(c.linkage, mass=c.linkage.mass * (1 + rod)),
        )
        return replace(self._engine, cylinders=changed)

    def _of_cylinders(self, what: str, deviations: Array) -> Array:
        """Deviations as the cylinders have them, shape (cylinders, samples)."""
        rows = {s.number: k for k, s in enumerate(self.sources) if s.what == what}
        owners = [t + 1 for t in self._throws] if what.startswith("throw") else self._engine.numbers
        return deviations[[rows[owner] for owner in owners]]

    def slopes(self, q: Quantity) -> tuple[Phasors, Phasors]:
        """The nominal vectors of a quantity's order, and their changes by each source's tolerance,
        shape (1, sources).
        """
        steps = np.diag([STEP * s.tolerance for s in self.sources])
        up, down, nominal = (
            spectra(self.engine(d), [q.order], {q.kind})[q.kind]
            for d in (steps, -steps, 0 * steps[:, :1])
        )
        return nominal, (1 / (2 * STEP)) * (up - down)


def _without(file: EngineFile, part: str) -> EngineFile:
    """The file with all pistons, or all throws, weightless."""
    if part == "throw":
        return file.model_copy(update={"crank": file.crank.model_copy(update={"throw_mass": 0.0})})
    own = {
        n: o if o.piston_mass is None else o.model_copy(update={"piston_mass": 0.0})
        for n, o in file.cylinder.items()
    }
    return file.model_copy(
        update={"piston": file.piston.model_copy(update={"mass": 0.0}), "cylinder": own}
    )


def _spread(crowd: _Crowd, q: Quantity, values: Array) -> Spread:
    nominal, change = crowd.slopes(q)
    sides: list[Any] = [
        (getattr(nominal, side), getattr(change, side))
        for side in ("forward", "backward")
        if q.part in ("major", "amplitude", side)
    ]
    noise = len(sides) * np.broadcast_to(change.noise, change.forward.shape)[0]
    slope = np.asarray(sum(_grown(v[0], d[0]) for v, d in sides))
    slope = np.where(np.abs(slope) <= noise, 0.0, slope)
    unit = np.abs(slope).max(initial=0) * TOLD or 1.0
    bound = sum(float(np.abs(v).sum() + np.abs(d).sum()) for v, d in sides)
    shares = sorted(
        zip(
            crowd.sources,
            (float(s) for s in np.broadcast_to(slope, len(crowd.sources))),
            strict=True,
        ),
        key=lambda pair: -round(abs(pair[1]) / unit),
    )
    percentiles = dict(
        zip(PERCENTILES, np.percentile(values, list(PERCENTILES.values())).tolist(), strict=True)
    )
    return Spread(
        q,
        float(sum(np.abs(v).sum() for v, _ in sides)),
        float(values.mean()),
        percentiles,
        float(values.max()),
        bound,
        tuple(shares),
    )


def _grown(vector: Any, change: Any) -> Array:
    """By how much a vector grows: along itself, or by all of the change where there is none."""
    size = np.abs(vector)
    along = (np.conj(vector) * change).real / np.where(size == 0, 1, size)
    return np.asarray(np.where(size == 0, np.abs(change), along))
