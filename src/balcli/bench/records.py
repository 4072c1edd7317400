"""Define the records of `balcli bench`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple, Self, TypeAlias

from ..core.phasors import EPS
from ..core.records import HIDDEN

# How a method computes: by a formula that leaves terms out, exactly, from samples of the exact
# curve, or from differences of positions.
Approach: TypeAlias = Literal["formula", "exact", "samples", "steps"]


class Times(NamedTuple):
    """Run time of one variant, s: quartiles of repeated runs."""

    lower: float
    median: float
    upper: float


class OrderError(NamedTuple):
    """Error relative to the exact value of an order; the order of a peak or a torque is None."""

    order: float | None
    error: float


class Measured(NamedTuple):
    """A method with its results.

    Attributes:
        method: Its name.
        approach: How it computes.
        seconds: Run time of one variant, s.
        errors: Errors by order.
    """

    method: str
    approach: Approach
    seconds: Times
    errors: tuple[OrderError, ...]

    @property
    def worst(self) -> float:
        """Error of the order that is the least exact; errors that are rounding are equal."""
        return max(ROUNDING, *(error.error for error in self.errors))


class Block(NamedTuple):
    """Methods that compute the same figures.

    Attributes:
        task: What is computed.
        methods: The methods.
        variants: Number of variants that are computed side by side.
        rod_ratio: Crank radius over rod length; None for tasks of whole engines.
    """

    task: str
    methods: tuple[Measured, ...]
    variants: int = 1
    rod_ratio: float | None = None


@dataclass(frozen=True, kw_only=True)
class Row:
    """Run time and error of one method for one order.

    Attributes:
        task: What is computed.
        method: Name of the method.
        rod_ratio: Crank radius over rod length; left out for tasks of whole engines.
        variants: Number of variants that are computed side by side.
        order: Order; left out for a peak and for a torque of all orders.
        seconds: Run time of one variant, s: median of repeated runs.
        seconds_lower: First quartile of these runs, s.
        seconds_upper: Third quartile of these runs, s.
        error: Error relative to the exact value of this order.
    """

    task: str
    method: str
    rod_ratio: float | None = None
    variants: int
    order: float | None = None
    seconds: float
    seconds_lower: float
    seconds_upper: float
    error: float


@dataclass(frozen=True, kw_only=True)
class Unbeaten:
    """Methods of a task that no other method beats (`list_unbeaten`).

    Attributes:
        task: What is computed.
        rod_ratio: Crank radius over rod length; left out for tasks of whole engines.
        variants: Number of variants that are computed side by side.
        methods: Names of the methods, the most exact first.
    """

    task: str
    rod_ratio: float | None = None
    variants: int
    methods: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Ratio:
    """A run time as a multiple of another.

    Attributes:
        what: Names of both runs, with a slash between them.
        value: The ratio.
    """

    what: str
    value: float


@dataclass(frozen=True, kw_only=True)
class Bench:
    """Results of one run of the benchmark.

    Attributes:
        rows: Run time and error of every method.
        unbeaten: For each task, the methods that no other method beats.
        ratios: Ratios of run times; the programs of a ratio are started alternately.
        blocks: The tasks with their methods.
    """

    format: Literal["balcli.bench/1"] = "balcli.bench/1"
    rows: tuple[Row, ...]
    unbeaten: tuple[Unbeaten, ...]
    ratios: tuple[Ratio, ...]
    blocks: Annotated[tuple[Block, ...], HIDDEN]

    @classmethod
    def of(cls, blocks: Iterable[Block], ratios: Iterable[Ratio]) -> Self:
        """Return the results of these tasks."""
        every = tuple(blocks)
        rows: list[Row] = []
        unbeaten = []
        for block in every:
            rows += _list_rows(block)
            unbeaten.append(
                Unbeaten(
                    task=block.task,
                    rod_ratio=block.rod_ratio,
                    variants=block.variants,
                    methods=tuple(method.method for method in list_unbeaten(block.methods)),
                )
            )
        return cls(rows=tuple(rows), unbeaten=tuple(unbeaten), ratios=tuple(ratios), blocks=every)


def _list_rows(block: Block) -> Iterator[Row]:
    for method in block.methods:
        for order, error in method.errors:
            yield Row(
                task=block.task,
                method=method.method,
                rod_ratio=block.rod_ratio,
                variants=block.variants,
                order=order,
                seconds=method.seconds.median,
                seconds_lower=method.seconds.lower,
                seconds_upper=method.seconds.upper,
                error=error,
            )


ROUNDING = 16 * EPS  # relative errors below it are equal: order 16 has about 16 roundings
_AS_QUICK = 1.1  # ratios of run times up to this one are no difference
_AS_EXACT = 4.0  # ratios of errors up to this one are no difference: rounding errors are random


def list_unbeaten(methods: Iterable[Measured]) -> list[Measured]:
    """Return the methods that no other method beats, the most exact first. A method is beaten by
    one that is as quick and as exact at every order, and clearly quicker or more exact at some
    order. Of methods without a clear difference, the quickest beats the others.
    """
    every = list(methods)
    unbeaten = []
    for measured in every:
        if not any(_beats(other, measured) for other in every):
            unbeaten.append(measured)
    return sorted(unbeaten, key=lambda method: (method.worst, method.seconds.median))


def _beats(method: Measured, other: Measured) -> bool:
    if method is other or _is_quicker(other, method):
        return False
    ratios = []
    for mine, theirs in zip(method.errors, other.errors, strict=True):
        ratios.append(max(mine.error, ROUNDING) / max(theirs.error, ROUNDING))
    if max(ratios) > _AS_EXACT:
        return False
    if min(ratios) < 1 / _AS_EXACT or _is_quicker(method, other):
        return True
    return method.seconds.median < other.seconds.median


def _is_quicker(method: Measured, other: Measured) -> bool:
    """Return whether a method is clearly quicker: by more than the spread of both run times."""
    apart = method.seconds.upper < other.seconds.lower
    return apart and method.seconds.median * _AS_QUICK < other.seconds.median
