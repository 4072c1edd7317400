"""Evaluate quantities for a grid of variants of an engine. The parameters of the grid are numbers
of the engine file. The grid is divided into boxes, each of which is evaluated as arrays.

Each parameter has its own trailing axis, so that results that it does not affect are computed once.
On a grid of bank angles and rod ratios, for example, phases are computed once for each angle,
coefficients once for each ratio, and only their products for each variant. Where variants are rows,
the last parameter varies fastest from row to row.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import islice, tee
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.phasors import Array
from ..engine.build import build
from ..engine.engine import Engine, check_engine, take_model
from ..engine.load import SPEED, concerns_gas
from ..engine.numbering import doubt_firing
from ..engine.parse import read
from ..errors import ArgumentError, BalcliError, InputError, check_type, naming_file
from ..file.assumed import Assumed
from ..file.doubt import Doubt, name_files
from ..file.doubts import find_suspicious
from ..file.model import EngineFile
from ..file.toml import name_file
from ..forces.kinds import DEFAULT_QUANTITIES, GAS_KINDS
from ..forces.quantity import find_orders, leave_out_unknown
from ..forces.spectrum import count_engine_samples
from ..limits import MOST_KEPT_FIGURES, MOST_PARAMETERS, MOST_THREADS
from ..process import count_cores
from ..shell.arguments import Words, check_count, join_names
from ..show.result import Result
from ..show.sheet import count_name
from .parameters import Parameter, choose_values, parse_parameter, tell_variant
from .quantities import (
    AnyQuantity,
    Evaluator,
    list_assumed,
    naming_variant,
    parse_quantities,
    refuse_unknown,
)

if TYPE_CHECKING:
    from concurrent.futures import Future

Item = TypeVar("Item")
Outcome = TypeVar("Outcome")
Box: TypeAlias = tuple[slice, ...]
# Function that yields `work(item)` for each item, in order, and may share the work among threads:
Share: TypeAlias = Callable[[Callable[[Any], Any], Iterable[Any]], Iterator[Any]]
ALONE = 64  # number of variants in a box if each is computed by itself
JOINT = 256  # number of variants in a box if they are computed together
CHUNK = 65_536  # largest number of variants in a box; larger boxes save no more work
BYTES = 1 << 24  # size of the largest array of a box, which fits into the cache
SAMPLES = 1 << 20  # largest number of crank-angle samples in a box; they take a tenth of a second


class Chunk(NamedTuple):
    """Values of each quantity in a box of the grid, shape (variants in the box,) each."""

    box: Box
    values: list[Array]


def _doubt_fixed(model: EngineFile, varied: Sequence[str]) -> Iterator[Doubt]:
    """Yield the warnings of unlikely figures of a file that do not concern varied numbers.

    Args:
        model: File of a single engine.
        varied: Names of the numbers that vary.
    """
    yield from _select_fixed((*find_suspicious(model), *doubt_firing(model)), varied)


def _select_fixed(doubts: Iterable[Doubt], varied: Sequence[str]) -> Iterator[Doubt]:
    """Yield the doubts that do not concern varied numbers.

    Args:
        doubts: Doubts about a file.
        varied: Names of the numbers that vary.
    """
    for doubt in doubts:
        if not any(doubt.concerns(number) for number in varied):
            yield doubt


@dataclass(frozen=True)
class Sweep:
    """A sweep: an engine file, the parameters that vary, and the requested quantities."""

    file: EngineFile
    parameters: tuple[Parameter, ...]
    quantities: tuple[AnyQuantity, ...]
    name: str = "engine"  # name of the file, for messages

    @property
    def columns(self) -> list[str]:
        """Names of the parameters and quantities."""
        paths = [parameter.path for parameter in self.parameters]
        return paths + [quantity.name for quantity in self.quantities]

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column, by its name."""
        units = {parameter.path: parameter.unit for parameter in self.parameters}
        return units | {quantity.name: quantity.unit for quantity in self.quantities}

    @cached_property
    def evaluator(self) -> Evaluator:
        """Evaluator of the quantities."""
        return Evaluator(self.file, self.quantities)

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Warnings of unlikely figures of the file, and of speeds for which the file does not give
        the gas. Figures that vary cause no warning.
        """
        varied = [parameter.path for parameter in self.parameters]
        with naming_file(self.name):
            if self.file.engine:
                doubts = name_files(self._doubt_geared(varied))
                clearances = build(self.file).doubt_clearances()
                doubts += tuple(_select_fixed(clearances, varied))
            else:
                doubts = tuple(_doubt_fixed(self.file, varied))
            if any(crank.gas is not None and crank.gas.speeds for crank in self.file.cranks):
                speeds = self.figures.get(SPEED, self.file.operation.speed)
                doubts += build(self.file).doubt_speeds(speeds)
        return doubts

    def _doubt_geared(self, varied: Iterable[str]) -> Iterator[tuple[str, Iterator[Doubt]]]:
        """Yield the name of the file of each engine in [[engine]], and the doubts about this file.

        Args:
            varied: Names of the numbers that vary, such as `engine.1.rod.length`.
        """
        engines = zip(self.file.engine, self.file.cranks, strict=True)
        for number, (table, crank) in enumerate(engines, 1):
            start = f"engine.{number}."
            own = [path.removeprefix(start) for path in varied if path.startswith(start)]
            yield table.file, _doubt_fixed(crank, own)

    @cached_property
    def assumed(self) -> tuple[Assumed, ...] | None:
        """Values assumed because the file leaves them out; None if there are none."""
        return list_assumed(self.file, self.quantities, [p.path for p in self.parameters])

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each parameter."""
        return tuple(map(len, self.parameters))

    @property
    def variants(self) -> int:
        """Number of variants."""
        return math.prod(self.shape)

    def cut(self, box: Sequence[slice | list[np.intp]]) -> Sweep:
        """Return a sweep of the variants in a box of the grid. The box has a slice, or the indices
        of some values, for each parameter.
        """
        parameters = []
        for parameter, cut in zip(self.parameters, box, strict=True):
            parameters.append(replace(parameter, values=parameter.values[cut]))
        return replace(self, parameters=tuple(parameters))

    @property
    def figures(self) -> dict[str, Array]:
        """Values of the varied figures, each along its own axis."""
        paths = [parameter.path for parameter in self.parameters]
        values = [parameter.values for parameter in self.parameters]
        return dict(zip(paths, np.meshgrid(*values, indexing="ij", sparse=True), strict=True))

    def engine(self) -> Engine:
        """Return all variants as one engine with an axis for each parameter.

        Raises:
            InputError: A variant is impossible; the error names the first impossible one.
        """
        try:
            return self.evaluator.build(self.figures, len(self.shape))
        except InputError:
            if self.variants == 1:
                variant = {p.path: float(p.values[0]) for p in self.parameters}
                with naming_file(f"{self.name}: {tell_variant(variant)}"):
                    raise
            for half in divide_grid(self.shape, math.ceil(self.variants / 2)):
                self.cut(half).engine()
            raise


def read_sweep(file: str, vary: Sequence[str], quantities: str | None = None) -> Sweep:
    """Return the sweep that options of the command line describe.

    Args:
        vary: Parameters and their values, as typed.
        quantities: Names, separated by commas; None: force and moment of orders 1 and 2, or only
            force if positions of throws are unknown.

    Raises:
        BalcliError: The file, a parameter or a quantity has a mistake, or a variant is impossible.
    """
    model = read(file)
    parameters = tuple(parse_parameter(text, model) for text in vary)
    return plan_sweep(model, parameters, quantities, name_file(file))


def plan_sweep(
    model: EngineFile, parameters: tuple[Parameter, ...], quantities: str | None, name: str
) -> Sweep:
    """Return the sweep of an engine file, after a check of the grid's corners: the variants whose
    parameters all have their smallest or largest value.

    A mechanism that locks anywhere in the grid also locks at a corner. An uneven speed may be
    impossible only between the corners; the error is then raised when these variants are computed.
    `name` is the file's name in messages; see `read_sweep` for the other arguments.
    """
    paths = [p.path for p in parameters]
    if twice := [path for path in paths if paths.count(path) > 1]:
        raise BalcliError(f"{twice[0]} is varied twice; give all its values at once")
    if len(paths) > MOST_PARAMETERS:
        raise BalcliError(f"{len(paths)} numbers vary; at most {MOST_PARAMETERS} can vary")
    wanted = DEFAULT_QUANTITIES if quantities is None else quantities
    asked = parse_quantities(wanted, with_gas=model.has_gas)
    sweep = Sweep(model, parameters, asked, name)
    corners = build_corners(sweep)
    if quantities is None:
        return replace(sweep, quantities=leave_out_unknown(corners, sweep.evaluator.of_engine))
    with naming_variant(name), naming_file(""):
        refuse_unknown(model, corners, asked)
    return sweep


def build_corners(sweep: Sweep) -> Engine:
    """Return the variants at the corners of the grid as one engine.

    Raises:
        InputError: A variant is impossible.
    """
    ends = [[p.values.argmin(), p.values.argmax()] for p in sweep.parameters]
    return replace(sweep.cut(ends), quantities=()).engine()


def evaluate_sweep(sweep: Sweep) -> list[Array]:
    """Return each quantity for all variants, in SI units or degrees, shape (variants,).

    Raises:
        InputError, BalcliError: A variant is impossible; the error states the variant's figures.
    """
    engine = sweep.engine() if sweep.evaluator.of_engine else None
    with naming_variant(sweep.name):
        values = sweep.evaluator.evaluate(sweep.figures, sweep.shape, engine)
    return [value.ravel() for value in values.values()]


def count_at_once(sweep: Sweep) -> int:
    """Return how many variants a box may have if it is to take a fraction of a second and little
    memory, estimated at the corners of the grid.
    """
    of_gas = any(q.kind in GAS_KINDS for q in sweep.evaluator.of_engine)
    gases = [crank.gas for crank in sweep.file.cranks]
    paths = [parameter.path for parameter in sweep.parameters]
    gas_varies = of_gas and any(concerns_gas(path, gas) for path in paths for gas in gases)
    most = CHUNK
    if sweep.evaluator.of_chapters or gas_varies:
        joint = sweep.evaluator.computes_jointly(paths[-1:], paths)
        most = JOINT if joint else ALONE
    if not sweep.evaluator.of_engine:
        return most
    engine = build_corners(sweep)
    orders = find_orders(engine, sweep.evaluator.of_engine)
    figures = max(len(engine.numbers) * max(map(len, orders)), 2 * max(map(max, orders)))
    samples = count_engine_samples(engine) // 2 ** len(sweep.parameters)
    return max(min(BYTES // (16 * int(figures)), SAMPLES // max(samples, 1), most), 1)


def divide_grid(shape: tuple[int, ...], most: int) -> Iterator[Box]:
    """Yield boxes of at most `most` variants that make up the grid, in the order of rows. A box has
    the full length of the last axes, a part of one axis, and length 1 along the first axes.
    """
    axis = len(shape) - 1
    while axis > 0 and math.prod(shape[axis:]) <= most:
        axis -= 1
    longest = max(most // math.prod(shape[axis + 1 :]), 1)
    step = math.ceil(shape[axis] / math.ceil(shape[axis] / longest))
    last = [slice(0, length) for length in shape[axis + 1 :]]
    for fixed in np.ndindex(shape[:axis]):
        first = [slice(k, k + 1) for k in fixed]
        for start in range(0, shape[axis], step):
            part = slice(start, min(start + step, shape[axis]))
            yield (*first, part, *last)


def evaluate_chunks(sweep: Sweep, share: Share = map) -> Iterator[Chunk]:
    """Yield the values of all variants, box by box, in the order of rows. The values do not depend
    on the way in which the work is shared.
    """
    boxes, parts = tee(divide_grid(sweep.shape, count_at_once(sweep)))
    return map(Chunk, boxes, share(evaluate_sweep, map(sweep.cut, parts)))


# ------------------------------------------------------------------ shared work
def share_among_threads(
    work: Callable[[Item], Outcome], items: Iterable[Item], threads: int
) -> Iterator[Outcome]:
    """Yield `work(item)` for each item, in order; a bounded number of items is in progress.

    Raises:
        BalcliError: The system cannot start a thread.
    """
    from concurrent.futures import ThreadPoolExecutor  # rarely needed: most sweeps have one box

    pool = ThreadPoolExecutor(threads)
    try:
        yield from run_in_order(pool.submit, work, items, 2 * threads)
    except RuntimeError as error:
        raise ArgumentError(
            "{jobs} {threads}: {error}; give fewer, such as {jobs} 1",
            threads=threads,
            error=str(error),
        ) from None
    finally:
        pool.shutdown(cancel_futures=True)


def run_in_order(
    submit: Callable[..., Future[Outcome]],
    work: Callable[[Item], Outcome],
    items: Iterable[Item],
    ahead: int,
) -> Iterator[Outcome]:
    """Yield `work(item)` for each item, in order. `submit` returns futures; `ahead` of them are
    pending at a time.
    """
    to_do = iter(items)
    waiting = deque(submit(work, item) for item in islice(to_do, ahead))
    while waiting:
        outcome = waiting.popleft().result()
        waiting.extend(submit(work, item) for item in islice(to_do, 1))
        yield outcome


def split_columns(sweep: Sweep, chunk: Chunk) -> list[Array]:
    """Return a chunk as columns: parameters, then quantities, shape (variants in the box,) each."""
    axes = [p.values[cut] for p, cut in zip(sweep.parameters, chunk.box, strict=True)]
    return [*(axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")), *chunk.values]


def join_chunks(sweep: Sweep, chunks: Iterable[Chunk]) -> list[Array]:
    """Return each quantity on the whole grid, with an axis for each parameter, from all chunks in
    the order of rows.
    """
    whole = np.concatenate([chunk.values for chunk in chunks], axis=1)
    return [*whole.reshape(-1, *sweep.shape)]


# ------------------------------------------------------------------ kept results
@dataclass(frozen=True, eq=False, repr=False)
class Swept(Result):
    """Quantities on a grid of variants of an engine.

    Attributes:
        sweep: File, parameters with their values, and quantities.
        values: Each quantity on the whole grid, in SI units or degrees, with an axis for each
            parameter.
    """

    sweep: Sweep
    values: tuple[Array, ...]

    @property
    def summary(self) -> str:
        """The engine, the parameters and the quantities."""
        sweep = self.sweep
        over = ", ".join(f"{p.path} ({len(p)})" for p in sweep.parameters)
        what = ", ".join(q.name for q in sweep.quantities)
        return f"of {sweep.file.name or 'an engine'} over {over}: {what}"

    def __iter__(self) -> Iterator[str]:
        """Yield the names of the parameters, then of the quantities."""
        return iter(self.sweep.columns)

    def __getitem__(self, name: str) -> Array:
        """Return a quantity on the whole grid, or the values of a parameter, by name.

        Raises:
            KeyError: The name is unknown.
        """
        columns = [*(p.values for p in self.sweep.parameters), *self.values]
        with suppress(ValueError):
            return columns[self.sweep.columns.index(name)]
        raise KeyError(f"{name}; there are {', '.join(self)}")


def sweep(
    engine: Engine,
    vary: Mapping[str, ArrayLike],
    quantity: Words | None = None,
    jobs: int | None = None,
) -> Swept:
    """Return quantities for many variants of an engine. Numbers of its file vary over ranges, which
    span a grid.

    Args:
        engine: Engine, from `load`.
        vary: Values of numbers of the engine file, by dotted name (`rod.ratio`, `crank.throws.2`,
            `layout.bank_angle`): a one-dimensional array or list in the unit of the file (mm, kg,
            deg, rpm), texts with units, or a range from:to:step ("0:180:1"). Several
            names span a grid.
        quantity: Names such as `force.2.major` (or minor, forward, backward, axis, x, y),
            `moment.1.backward`, `couple.4.amplitude`, `peak.force`; for engines with mounts,
            torsion or gas also `mode.3.Hz`, `mount.left.force`, `torsion.1.Hz`, `torque.mean`.
            Default: force and moment of orders 1 and 2, or only force if positions of throws are
            unknown.
        jobs: Number of threads for long sweeps, at most 64; default: one for each core.

    Returns:
        The grid: `result["force.2.major"]` has an axis for each name in `vary` and is in SI units
        or degrees; `result.to_pandas()` has a row for each variant, with the last name varying
        fastest.

    Raises:
        BalcliError: A name is unknown (the message suggests the nearest), or values are out of
            bounds or too many.
        InputError: A variant is impossible; the error states the reason.
        TypeError: An argument has the wrong type.

    Example:
        >>> sweep(engine, {"layout.bank_angle": range(0, 181)}, ["force.1.major"]).to_pandas()
    """
    model = take_model(check_engine("sweep", engine))
    example = '{"rod.ratio": [0.24, 0.28, 0.32]}'
    check_type("sweep", vary, Mapping, f"give a dict, such as {example}")
    parameters = tuple(choose_values(str(path), values, model) for path, values in vary.items())
    if not parameters:
        raise BalcliError(f"sweep: nothing varies; give numbers and values, such as {example}")
    wanted = min(count_cores(), MOST_THREADS) if jobs is None else jobs
    share = partial(share_among_threads, threads=check_count("jobs", wanted, most=MOST_THREADS))
    asked = join_names("sweep", quantity)
    plan = plan_sweep(model, parameters, asked, engine.name or "engine")
    count = plan.variants * len(plan.quantities)
    if count > MOST_KEPT_FIGURES:
        raise BalcliError(
            f"{count_name(count)} values are too many to keep; give at most "
            f"{count_name(MOST_KEPT_FIGURES)}, or use the command balcli sweep, which writes them "
            "into a file as they are computed"
        )
    return Swept(plan, tuple(join_chunks(plan, evaluate_chunks(plan, share))))
