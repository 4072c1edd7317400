"""Compute the spread of quantities over random variants of an engine whose parts deviate within
tolerances (`scatter`). Variants are evaluated as in `sweep`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from ..core.phasors import Array
from ..core.records import HIDDEN
from ..engine.build import build
from ..engine.engine import Engine, check_engine, take_model
from ..engine.load import concerns_gas
from ..errors import Argument, ArgumentError, BalcliError, InputError, Message, check_type
from ..file.assumed import Assumed
from ..file.fields import Number, shorten
from ..file.model import EngineFile
from ..file.units import ANGLE
from ..forces.kinds import DEFAULT_QUANTITIES, GAS_KINDS
from ..forces.quantity import TargetQuantity, leave_out_unknown
from ..limits import MOST_SLOW_SAMPLES, MOST_TOLERANCE_SAMPLES
from ..process import Tell, tell_nobody
from ..shell.arguments import Words, check_count, join_names
from ..shell.values import read_figure, read_share
from ..show.figures import EngineName
from ..show.result import Result
from ..show.sheet import count_name
from .deviations import Source, Tolerances, find_sources
from .quantities import (
    Evaluator,
    choose_of_engine,
    list_assumed,
    parse_quantities,
    refuse_unknown,
)
from .quantity_names import ENGINE, MOUNTS, TORSION

# Default numbers of samples of quantities that are sums over the cylinders, and of slower ones.
RANDOM_ENGINES = 100_000
RANDOM_SLOW = 500
CHUNK = 8_192
SLOW_AT_ONCE = 64  # number of variants at once that are slow, but can be computed together
AT_ONCE = 400_000  # most samples, and most (samples x parts), at once
_EQUAL = 1e-8  # effects that differ by less than this share of the largest are equal
_ROUNDING = 1e-12  # changes below this share of the nominal value are rounding errors
_LEAST = -0.99  # least relative deviation, so that no mass or spring becomes negative
_DEGREES = Number(ANGLE, least=0, most=90)
# For each kind of quantities: name of the variants in tables, and a tolerance that they need.
_VARIED = {
    ENGINE: ("engines", Message("{mass_scatter} 0.5%")),
    MOUNTS: ("sets of mounts", Message("{stiffness_scatter} 15%")),
    TORSION: ("crankshafts", Message("{stiffness_scatter} 15%")),
}
Shape = Literal["uniform", "normal"]


@dataclass(frozen=True, kw_only=True)
class Spread:
    """Spread of one quantity over all samples, in its SI unit.

    Attributes:
        nominal: Value without deviations.
        mean: Mean of the samples.
        p05: 5th percentile.
        p50: Median.
        p95: 95th percentile.
        max: Largest value.
        bound: First-order bound: nominal value plus the magnitudes of all changes in `sensitivity`.
        sensitivity: Change by the tolerance of each part alone, by the part's name, largest first.
    """

    nominal: float
    mean: float
    p05: float
    p50: float
    p95: float
    max: float
    bound: float
    sensitivity: dict[str, float]


@dataclass(frozen=True, repr=False, kw_only=True)
class Scatter(Result):
    """Spread of quantities when masses, lengths, angles or stiffnesses vary within tolerances.

    Attributes:
        format: Name and version of the document.
        engine: The engine.
        assumed: Values assumed because the engine file leaves them out.
        samples: Number of random variants.
        distribution: Distribution of each deviation.
        quantities: Spread of each quantity, by its name.
        model: The engine file.
        units: SI unit of each quantity, by its name.
        varied: Word for the variants in tables, such as "engines".
        parts: Parts that deviate, with their tolerances.
    """

    format: Literal["balcli.scatter/1"] = "balcli.scatter/1"
    engine: EngineName
    assumed: tuple[Assumed, ...] | None = None
    samples: int
    distribution: Shape
    quantities: dict[str, Spread]
    model: Annotated[EngineFile, HIDDEN]
    units: Annotated[dict[str, str], HIDDEN]
    varied: Annotated[str, HIDDEN]
    parts: Annotated[tuple[Source, ...], HIDDEN]

    @property
    def summary(self) -> str:
        """The engine and the number of samples."""
        return f"of {self.model.name or 'an engine'}: {count_name(self.samples)} samples"


# ------------------------------------------------------------------ reading of tolerances
def read_tolerances(
    mass: float | str, length: float | str, angle: float | str, stiffness: float | str | None
) -> Tolerances:
    """Return tolerances from shares (`0.005` or `"0.5%"`) and an angle (`0.2` or `"0.2 deg"`).

    Raises:
        ArgumentError: A value cannot be read, is negative or too large.
    """
    if isinstance(angle, str):
        angle = read_figure("angle_scatter", angle, ANGLE)
    try:
        angle_deg = _DEGREES.read(angle)
    except ValueError as error:
        raise ArgumentError("{angle_scatter}: {error}", error=str(error)) from None
    return Tolerances(
        _read_share("mass_scatter", mass),
        _read_share("length_scatter", length),
        angle_deg,
        None if stiffness is None else _read_share("stiffness_scatter", stiffness),
    )


def _read_share(argument: str, value: float | str) -> float:
    """Return a share from 0 to 1, given as a number or as a percentage in a text."""
    wanted = "a percentage of 0 to 100, such as 0.5%"
    percent = isinstance(value, str) and "%" in value
    share = read_share(argument, str(value), wanted) if percent else value
    is_number = isinstance(share, (int, float, np.number)) and not isinstance(share, bool)
    if is_number and 0 <= float(share) < 1:
        return float(share)
    raise ArgumentError(
        "{argument} {value}: give {wanted}",
        argument=Argument(argument),
        value=shorten(value),
        wanted=wanted,
    )


# ------------------------------------------------------------------ random variants
class Variants:
    """Random variants of an engine file, and the quantities to compute for them.

    Args:
        model: Engine file.
        names: Names of the quantities, separated by commas; None: force and moment of orders 1 and
            2, or only force if positions of throws are unknown.
        within: Tolerances.

    Attributes:
        usual: Default number of samples.

    Raises:
        InputError, BalcliError: The file has mistakes or lacks what a quantity refers to, the
            quantities need different kinds of tolerances, or all tolerances are 0.
    """

    def __init__(self, model: EngineFile, names: str | None, within: Tolerances) -> None:
        asked = parse_quantities(names or DEFAULT_QUANTITIES, with_gas=model.has_gas)
        engine = build(model)
        of_engine = choose_of_engine(asked)
        if names is None:
            asked = of_engine = leave_out_unknown(engine, of_engine)
        self.asked = asked
        self.assumed = list_assumed(model, asked)
        kinds = {q.chapter if isinstance(q, TargetQuantity) else ENGINE for q in asked}
        apart = kinds & {MOUNTS, TORSION}
        if apart and len(kinds) > 1:
            raise BalcliError(
                f"{', '.join(q.name for q in asked)}: engine, mounts and torsion have different "
                "tolerances; ask for quantities of one of them at a time"
            )
        if within.stiffness is not None and not apart:
            raise ArgumentError(
                "{stiffness_scatter}: {names} depends on no mount and no shaft; leave the option "
                "out, or give a quantity such as mode.roll.Hz",
                names=", ".join(q.name for q in asked),
            )
        if angles := [q.name for q in of_engine if q.unit == "deg"]:
            raise BalcliError(
                f"{angles[0]} is a direction and has no mean; ask for a magnitude, such as "
                f"{angles[0].rpartition('.')[0]}.major"
            )
        refuse_unknown(model, engine, asked)
        chapter = next(iter(apart), ENGINE)
        self.varied, give = _VARIED[chapter]
        self.model, self.sources = find_sources(model, chapter, within)
        if not self.sources:
            raise ArgumentError("all tolerances are 0; give one, such as {example}", example=give)
        self._evaluator = Evaluator(self.model, asked)
        paths = [path for source in self.sources for path in source.figures]
        of_gas = any(q.kind in GAS_KINDS for q in of_engine)
        self._slow = self._evaluator.of_chapters or (of_gas and any(map(concerns_gas, paths)))
        self._joint = self._evaluator.computes_jointly(paths, paths)
        self.usual = RANDOM_SLOW if self._slow else RANDOM_ENGINES

    def evaluate(self, deviations: Array) -> Array:
        """Return all quantities in SI units, shape (samples, quantities).

        Args:
            deviations: Deviations of the sources, relative or in degrees, shape (samples, sources).

        Raises:
            BalcliError: A variant is impossible.
        """
        figures: dict[str, Array] = {}
        for source, column in zip(self.sources, deviations.T, strict=True):
            for path, line in source.figures.items():
                # several parts may change a figure, such as the angle of a counterweight
                figures[path] = figures.get(path, line.value) + line.slope * column
        try:
            values = self._evaluator.evaluate(figures, (len(deviations),))
        except InputError as error:
            raise BalcliError(
                f"some engines within these tolerances are impossible: "
                f"{error.problems[0].message}; give smaller tolerances"
            ) from None
        return np.stack([*values.values()], axis=1)

    def draw(
        self,
        samples: int | None = None,
        seed: int | None = None,
        shape: Shape = "uniform",
        tell: Tell = tell_nobody,
    ) -> Scatter:
        """Return the spread of the quantities over random variants.

        Args:
            samples: Number of variants; None: the default number `usual`.
            seed: Seed of the random numbers, for repeatable results.
            shape: Distribution of deviations: uniform within the tolerances, or normal with a
                standard deviation of a third of the tolerance.
            tell: Called with the number of samples so far; it returns whether to stop.

        Raises:
            BalcliError: The number of samples is too large or 0, or a variant is impossible.
        """
        samples = self.usual if samples is None else samples
        most = MOST_SLOW_SAMPLES if self._slow else MOST_TOLERANCE_SAMPLES
        if not 1 <= samples <= most:
            why = f", because {self.asked[0].name} takes longer to compute" if self._slow else ""
            raise BalcliError(
                f"{count_name(samples)} samples: give from 1 to {count_name(most)}{why}"
            )
        ends = np.diag([source.tolerance for source in self.sources])
        nominal = np.ravel([*self._evaluator.evaluate({}, (1,)).values()])
        changes = _find_changes(nominal, self.evaluate(ends), self.evaluate(-ends))
        chunks = list[Array]()
        done = 0
        for deviations in self._draw_deviations(samples, seed, shape):
            chunks.append(self.evaluate(deviations))
            done += len(deviations)
            if tell(done):
                break
        values = np.concatenate(chunks)
        spreads = map(self._spread, nominal, values.T, changes.T)
        return Scatter(
            engine=EngineName(self.model.name),
            assumed=self.assumed,
            samples=len(values),
            distribution=shape,
            quantities={q.name: spread for q, spread in zip(self.asked, spreads, strict=True)},
            model=self.model,
            units={q.name: q.unit for q in self.asked},
            varied=self.varied,
            parts=self.sources,
        )

    def _draw_deviations(self, samples: int, seed: int | None, shape: Shape) -> Iterator[Array]:
        """Yield random deviations, shape (samples at a time, sources)."""
        random = np.random.default_rng(seed)
        tolerances = np.array([source.tolerance for source in self.sources])
        least = [_LEAST if source.is_relative else -np.inf for source in self.sources]
        at_once = min(CHUNK, max(AT_ONCE // len(tolerances), 1))
        if self._slow:
            at_once = SLOW_AT_ONCE if self._joint else 1
        for start in range(0, samples, at_once):
            size = min(at_once, samples - start), len(tolerances)
            if shape == "uniform":
                yield tolerances * (2 * random.random(size) - 1)
            else:
                yield np.maximum(tolerances / 3 * random.standard_normal(size), least)

    def _spread(self, nominal: float, values: Array, changes: Array) -> Spread:
        p05, p50, p95 = np.percentile(values, [5, 50, 95]).tolist()
        unit = np.abs(changes).max() * _EQUAL or 1.0
        pairs = zip(self.sources, changes.tolist(), strict=True)
        ranked = sorted(pairs, key=lambda pair: -round(abs(pair[1]) / unit))
        return Spread(
            nominal=float(nominal),
            mean=float(values.mean()),
            p05=p05,
            p50=p50,
            p95=p95,
            max=float(values.max()),
            bound=float(nominal + np.abs(changes).sum()),
            sensitivity={source.name: change for source, change in ranked},
        )


def _find_changes(nominal: Array, above: Array, below: Array) -> Array:
    """Return the change of each quantity by each tolerance, shape (sources, quantities). It is half
    the difference between the values at both ends of the tolerance. If both ends change a quantity
    in the same direction, such as an amplitude that is nominally 0, the larger change counts.
    """
    up = above - nominal
    down = below - nominal
    larger = np.where(np.abs(up) >= np.abs(down), up, down)
    change = np.where(up * down > 0, larger, (up - down) / 2)
    return np.where(np.abs(change) <= _ROUNDING * np.abs(nominal), 0.0, change)


def scatter(
    engine: Engine,
    quantity: Words | None = None,
    *,
    mass_scatter: float | str = 0.005,
    length_scatter: float | str = 0.0,
    angle_scatter: float | str = 0.0,
    stiffness_scatter: float | str | None = None,
    samples: int | None = None,
    seed: int | None = None,
    distribution: Literal["uniform", "normal"] = "uniform",
) -> Scatter:
    """Return the spread of free forces and moments when masses, rod lengths, throw angles and the
    dimensions of webs with tolerances vary, and the tolerances that matter most. For quantities of
    mounts, the stiffness of each mount
    varies; for torsion, the stiffness of each shaft, the inertias and the piston masses vary.

    Args:
        engine: Engine, from `load`.
        quantity: Magnitudes of forces and moments (`force.1.major`, `couple.4.amplitude`),
            quantities of the cycle (`torque.max`, `fluctuation`, `guide.6.H`), of mounts
            (`mode.roll.Hz`, `mount.left.force`) or of torsion (`torsion.1.Hz`). Default: force and
            moment of orders 1 and 2, or only force if positions of throws are unknown.
        mass_scatter: Tolerance of every piston, rod and throw mass, and of the unbalance of every
            counterweight, shaft and slider, as a share (0.005) or a text ("0.5%").
        length_scatter: Tolerance of every rod length, a share or a text; other figures of rods do
            not change.
        angle_scatter: Tolerance of every throw angle, in degrees or a text with its unit.
        stiffness_scatter: Tolerance of the stiffness of every mount (default: 15 %) or shaft (5 %),
            a share or a text.
        samples: Number of random engines; default: 100000, or 500 if quantities are computed for
            one engine after another (cycle, mounts and torsion).
        seed: Seed of the random numbers, for repeatable results.
        distribution: Distribution of deviations: uniform within the tolerances, or normal with a
            standard deviation of a third of the tolerance.

    Returns:
        The result, in which `quantities` has for each name the nominal value, mean, percentiles,
        largest value, a bound, and the change by each tolerance, in SI units.

    Raises:
        BalcliError: A quantity has no spread, all tolerances are 0, or there are too many samples.
        TypeError: An argument has the wrong type.

    Example:
        >>> found = scatter(engine, "force.1.major", mass_scatter="1%", seed=1)
        >>> found.quantities["force.1.major"].p95
    """
    model = take_model(check_engine("scatter", engine))
    names = join_names("scatter", quantity)
    count = None if samples is None else check_count("samples", samples)
    seed = None if seed is None else check_count("seed", seed, 0)
    check_type("distribution", distribution, str, 'give "uniform" or "normal"')
    if distribution not in ("uniform", "normal"):
        raise ArgumentError(
            '{distribution} {other!r}: choose "uniform" or "normal"', other=distribution
        )
    within = read_tolerances(mass_scatter, length_scatter, angle_scatter, stiffness_scatter)
    variants = Variants(model, names, within)
    return variants.draw(count, seed, distribution)
