"""Grids of variants of an engine: numbers of the file over ranges, evaluated as arrays, in boxes of
bounded size.

Every parameter has its own trailing axis, so that figures that do not depend on it are computed
once: on a grid of bank angles and rod ratios, phases are computed once for each angle, coefficients
once for each ratio, and only their products for each variant. The last parameter varies fastest in
the rows.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import islice, tee
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.phasors import Array
from ..engine.engine import Engine, check_engine, take_model
from ..engine.load import concerns_gas
from ..engine.numbering import doubt_firing
from ..engine.parse import read
from ..errors import BalcliError, InputError, check_type, naming_file
from ..file.doubts import find_suspicious
from ..file.model import EngineFile
from ..file.toml import name_file
from ..forces.kinds import DEFAULT_QUANTITIES, GAS_KINDS
from ..forces.quantity import Quantity, find_orders, leave_out_unknown
from ..forces.spectrum import count_engine_samples
from ..limits import MOST_KEPT_FIGURES, MOST_PARAMETERS, MOST_THREADS
from ..process import count_cores
from ..shell.arguments import Words, check_count, join_names, tell_arguments
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
ALONE = 64  # variants at a time where each is computed by itself
CHUNK = 65_536  # variants at a time, at most: enough for what they share
BYTES = 1 << 24  # of an array that a box needs: no more than the cache holds
SAMPLES = 1 << 20  # of revolutions in a box: a tenth of a second


class Share(Protocol):
    """Yields the outcome of some work for each item, in their order."""

    def __call__(
        self, work: Callable[[Item], Outcome], items: Iterable[Item], /
    ) -> Iterator[Outcome]: ...


class Chunk(NamedTuple):
    """The variants in a box of the grid: each quantity, shape (variants in it,)."""

    box: Box
    values: list[Array]


@dataclass(frozen=True)
class Sweep:
    """A sweep: an engine file, the parameters that vary, and the requested quantities."""

    file: EngineFile
    parameters: tuple[Parameter, ...]
    quantities: tuple[AnyQuantity, ...]
    name: str = "engine"  # of the file, in messages

    @property
    def columns(self) -> list[str]:
        """Names of the parameters and quantities."""
        return [*(p.path for p in self.parameters), *(q.name for q in self.quantities)]

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column, by its name."""
        return {p.path: p.unit for p in self.parameters} | {q.name: q.unit for q in self.quantities}

    @cached_property
    def evaluator(self) -> Evaluator:
        """Evaluator of the quantities."""
        return Evaluator(self.file, self.quantities)

    @property
    def of_engine(self) -> tuple[Quantity, ...]:
        """Quantities of forces and moments."""
        return self.evaluator.of_engine

    @property
    def doubts(self) -> list[str]:
        """Warnings of unlikely figures of the file, without those that vary."""
        with naming_file(self.name):
            all_of_file = [
                doubt
                for crank in self.file.cranks
                for doubt in (*find_suspicious(crank), *doubt_firing(crank))
            ]
        varied = [p.path.rstrip(".0123456789") for p in self.parameters]
        return [d for d in all_of_file if not any(one in d for one in varied)]

    @cached_property
    def assumed(self) -> tuple[str, ...] | None:
        """Values taken because the file leaves them out; None: none."""
        return list_assumed(self.file, self.quantities, [p.path for p in self.parameters])

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each parameter."""
        return tuple(map(len, self.parameters))

    @property
    def variants(self) -> int:
        """Number of variants."""
        return math.prod(self.shape)

    def cut(self, box: Box) -> Sweep:
        """Return the variants in a box of the grid as a sweep."""
        cuts = zip(self.parameters, box, strict=True)
        return replace(self, parameters=tuple(replace(p, values=p.values[cut]) for p, cut in cuts))

    @property
    def figures(self) -> dict[str, Array]:
        """Return the figures that vary, each along its own axis."""
        grids = np.meshgrid(*(p.values for p in self.parameters), indexing="ij", sparse=True)
        return dict(zip((p.path for p in self.parameters), grids, strict=True))

    def engine(self) -> Engine:
        """Return all variants as one engine with an axis for each parameter.

        Raises:
            InputError: One of them is impossible; the first such is named.
        """
        try:
            return self.evaluator.build(self.figures, len(self.shape))
        except InputError:
            if self.variants == 1:
                one = {p.path: float(p.values[0]) for p in self.parameters}
                with naming_file(f"{self.name}: {tell_variant(one)}"):
                    raise
            for half in divide_grid(self.shape, math.ceil(self.variants / 2)):
                self.cut(half).engine()
            raise


def read_sweep(file: str, vary: Sequence[str], quantities: str | None = None) -> Sweep:
    """Return the sweep of an engine file by options of the command line.

    Args:
        vary: Parameters and their values, as typed.
        quantities: Names with commas; None: the usual ones, as far as they are known.

    Raises:
        BalcliError: Mistakes in the file, a parameter or a quantity, or an impossible variant.
    """
    model = read(file)
    parameters = tuple(parse_parameter(text, model) for text in vary)
    return plan_sweep(model, parameters, quantities, name_file(file))


def plan_sweep(
    model: EngineFile, parameters: tuple[Parameter, ...], quantities: str | None, name: str
) -> Sweep:
    """Return the sweep of an engine file; `name` is its name in messages; see `read_sweep`.

    The corners of the grid are checked before the sweep. A mechanism locks at one of them if it
    locks at all; mistakes of an uneven speed may be between them, and are found later.
    """
    paths = [p.path for p in parameters]
    if twice := [path for path in paths if paths.count(path) > 1]:
        raise BalcliError(f"{twice[0]} is varied twice; give all its values at once")
    if len(paths) > MOST_PARAMETERS:
        raise BalcliError(f"{len(paths)} numbers vary; at most {MOST_PARAMETERS} can at once")
    wanted = DEFAULT_QUANTITIES if quantities is None else quantities
    asked = parse_quantities(wanted, with_gas=model.has_gas)
    sweep = Sweep(model, parameters, asked, name)
    corners = build_corners(sweep)
    if quantities is None:
        return replace(sweep, quantities=leave_out_unknown(corners, sweep.of_engine))
    with naming_variant(name), naming_file(""):
        refuse_unknown(model, corners, asked)
    return sweep


def build_corners(sweep: Sweep) -> Engine:
    """Return the variants at the corners of the grid as one engine.

    Raises:
        InputError: One of them is impossible.
    """
    corners = tuple(
        Parameter(p.path, np.array([p.values.min(), p.values.max()]), p.unit)
        for p in sweep.parameters
    )
    return Sweep(sweep.file, corners, (), sweep.name).engine()


def evaluate_sweep(sweep: Sweep) -> list[Array]:
    """Return each quantity for all variants at once, SI or degrees, shape (variants,).

    Raises:
        InputError, BalcliError: One of them is impossible; the error has its figures.
    """
    engine = sweep.engine() if sweep.of_engine else None
    with naming_variant(sweep.name):
        values = sweep.evaluator.evaluate(sweep.figures, sweep.shape, engine)
    return [value.ravel() for value in values]


def count_at_once(sweep: Sweep) -> int:
    """Return how many variants to compute at a time, estimated at the corners of the grid: a box
    takes a fraction of a second and little memory.
    """
    of_gas = any(q.kind in GAS_KINDS for q in sweep.of_engine)
    gas_varies = of_gas and any(concerns_gas(p.path) for p in sweep.parameters)
    most = ALONE if sweep.evaluator.one_by_one or gas_varies else CHUNK
    if not sweep.of_engine:
        return most
    engine = build_corners(sweep)
    orders = find_orders(engine, sweep.of_engine)
    figures = max(len(engine.numbers) * max(map(len, orders)), 2 * max(map(max, orders)))
    samples = count_engine_samples(engine) // 2 ** len(sweep.parameters)
    return max(min(BYTES // (16 * int(figures)), SAMPLES // max(samples, 1), most), 1)


def divide_grid(shape: tuple[int, ...], most: int) -> Iterator[Box]:
    """Yield the grid in boxes of at most `most` variants, in the order of rows: the last axes
    whole, one cut into like parts, the first one by one.
    """
    axis = len(shape) - 1
    while axis > 0 and math.prod(shape[axis:]) <= most:
        axis -= 1
    longest = max(most // math.prod(shape[axis + 1 :]), 1)
    step = math.ceil(shape[axis] / math.ceil(shape[axis] / longest))
    for fixed in np.ndindex(shape[:axis]):
        for start in range(0, shape[axis], step):
            yield (
                *(slice(k, k + 1) for k in fixed),
                slice(start, min(start + step, shape[axis])),
                *(slice(0, n) for n in shape[axis + 1 :]),
            )


def evaluate_chunks(sweep: Sweep, share: Share = map) -> Iterator[Chunk]:
    """Return all variants, box by box, in the order of rows. The figures do not depend on how the
    work is shared.
    """
    boxes, parts = tee(divide_grid(sweep.shape, count_at_once(sweep)))
    return map(Chunk, boxes, share(evaluate_sweep, map(sweep.cut, parts)))


# ------------------------------------------------------------------ shared work
def share_among_threads(
    work: Callable[[Item], Outcome], items: Iterable[Item], threads: int
) -> Iterator[Outcome]:
    """Yield `work(item)` for each item, in their order; a bounded number of items is under way.

    Raises:
        BalcliError: The system gives no thread.
    """
    from concurrent.futures import ThreadPoolExecutor  # most sweeps have one box

    pool = ThreadPoolExecutor(threads)
    try:
        yield from run_in_order(pool.submit, work, items, 2 * threads)
    except RuntimeError as error:
        raise BalcliError(f"--jobs {threads}: {error}; give fewer, as --jobs 1") from None
    finally:
        pool.shutdown(cancel_futures=True)


def run_in_order(
    submit: Callable[..., Future[Outcome]],
    work: Callable[[Item], Outcome],
    items: Iterable[Item],
    ahead: int,
) -> Iterator[Outcome]:
    """Yield the results of work that `submit` makes futures of; `ahead` of them at a time."""
    to_do = iter(items)
    waiting = deque(submit(work, item) for item in islice(to_do, ahead))
    while waiting:
        found = waiting.popleft().result()
        waiting.extend(submit(work, item) for item in islice(to_do, 1))
        yield found


def split_columns(sweep: Sweep, chunk: Chunk) -> list[Array]:
    """Return a chunk as columns: parameters and quantities, each of shape (variants in it,)."""
    axes = [p.values[cut] for p, cut in zip(sweep.parameters, chunk.box, strict=True)]
    return [*(axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")), *chunk.values]


def join_chunks(sweep: Sweep, chunks: Iterable[Chunk]) -> list[Array]:
    """Return each quantity on the whole grid, from all its chunks in the order of rows: shape
    (values of the first parameter, of the second ...).
    """
    whole = np.concatenate([chunk.values for chunk in chunks], axis=1)
    return [*whole.reshape(-1, *sweep.shape)]


# ------------------------------------------------------------------ kept results
@dataclass(frozen=True, eq=False, repr=False)
class Swept(Result):
    """Variants of an engine with their figures.

    Attributes:
        sweep: File, parameters with their values, and quantities.
        values: Each quantity on the whole grid, SI or degrees, shape (values of the first
            parameter, of the second, ...).
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
        """Return a quantity on the whole grid, or the values of a parameter, by its name.

        Raises:
            KeyError: The name is unknown.
        """
        columns = [*(p.values for p in self.sweep.parameters), *self.values]
        with suppress(ValueError):
            return columns[self.sweep.columns.index(name)]
        raise KeyError(f"{name}; there are {', '.join(self)}")


@tell_arguments(quantity="quantities", jobs="threads")
def sweep(
    engine: Engine,
    vary: Mapping[str, ArrayLike],
    quantities: Words | None = None,
    threads: int | None = None,
) -> Swept:
    """Figures of many variants of an engine: numbers of its file over ranges, the full grid,
    evaluated as arrays.

    Args:
        engine: as `load` makes it.
        vary: by dotted name of a number of the engine file (`rod.ratio`, `crank.throws.2`,
            `layout.bank_angle`), its values in the unit of the file (mm, kg, deg, rpm): an array
            or list of one axis, texts with units of their own, or a range with both ends
            ("0:180:1"). Several names span a grid.
        quantities: names such as `force.2.major` (minor, forward, backward, axis, x, y),
            `moment.1.backward`, `couple.4.amplitude`, `peak.force`; of engines with mounts,
            torsion or gas also `mode.3.Hz`, `mount.left.force`, `torsion.1.Hz`, `torque.mean`.
            Default: force and moment of orders 1 and 2, as far as they are known.
        threads: Number of threads for sweeps of more than a second; at most 64; default: one a
            core.

    Returns:
        The grid: `result["force.2.major"]` has one axis a name in `vary`, in SI units or degrees;
        `result.to_pandas()` one row a variant, the last name fastest.

    Raises:
        BalcliError: an unknown name, with the nearest one; values out of bounds, or too many.
        InputError: one of the variants is impossible; the error has the reason.
        TypeError: an argument of another type.

    Example:
        >>> sweep(engine, {"layout.bank_angle": range(0, 181)}, ["force.1.major"]).to_pandas()
    """
    model = take_model(check_engine("sweep", engine))
    example = '{"rod.ratio": [0.24, 0.28, 0.32]}'
    check_type("sweep", vary, Mapping, f"give a dict, such as {example}")
    parameters = tuple(choose_values(str(path), values, model) for path, values in vary.items())
    if not parameters:
        raise BalcliError(f"sweep: nothing varies; give numbers and values, such as {example}")
    wanted = min(count_cores(), MOST_THREADS) if threads is None else threads
    share = partial(share_among_threads, threads=check_count("threads", wanted, most=MOST_THREADS))
    asked = join_names("sweep", quantities)
    plan = plan_sweep(model, parameters, asked, engine.name or "engine")
    count = plan.variants * len(plan.quantities)
    if count > MOST_KEPT_FIGURES:
        raise BalcliError(
            f"{count_name(count)} values are too many to keep; give at most "
            f"{count_name(MOST_KEPT_FIGURES)}, or use balcli sweep -o FILE.parquet, which writes "
            "them as they are computed"
        )
    return Swept(plan, tuple(join_chunks(plan, evaluate_chunks(plan, share))))
