"""Grids of variants of an engine: numbers of the file over ranges, evaluated as arrays, in boxes of
bounded size.

Every parameter has a trailing axis of its own, so that what does not depend on it is not computed
again: on a grid of bank angles and rod ratios, phases are computed once for each angle,
coefficients once for each ratio, and only their products for each variant. Rows run with the last
parameter fastest.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import product
from typing import NamedTuple

import numpy as np

from ..core.phasors import Array
from ..engine.build import Engine, build
from ..engine.gas_figures import concerns_gas
from ..engine.load import read
from ..enginefile.model import EngineFile
from ..enginefile.toml_text import name_file
from ..errors import BalcliError, InputError, naming_file
from ..forces.kinds import DEFAULT_QUANTITIES, GAS_KINDS
from ..forces.quantity import (
    Quantity,
    evaluate_quantities,
    find_orders,
    leave_out_unknown,
    refuse_unknown,
)
from ..forces.spectrum import count_engine_samples
from ..limits import MOST_PARAMETERS
from .boxes import Box, BoxSize, divide_grid, divide_into_boxes, divide_into_tiles
from .parameters import Parameter, parse_parameter, tell_variant
from .quantities import (
    AnyQuantity,
    ChapterQuantity,
    Variants,
    choose_of_engine,
    group_by_chapter,
    load_chapter,
    parse_quantities,
    refuse_unknown_of_chapters,
)
from .threads import ALONE_S, share_work
from .varied_gas import attach_gas_torque

ALONE = 64  # variants at a time where each is computed by itself
PRODUCTS = 8  # times as many where each is but a product of what is computed for fewer
CHUNK = 32_768  # variants at a time, at most: enough for what they share
BYTES = 1 << 23  # of an array that a box needs: no more than the cache holds
_BOXES = 8  # in a block, each with a tenth of a second's work
SAMPLES = 1 << 20  # of revolutions in a box: a tenth of a second


class Chunk(NamedTuple):
    """The variants in a box of the grid: each quantity, shape (variants in it,)."""

    box: Box
    values: list[Array]


@dataclass(frozen=True)
class Sweep:
    """What to compute: an engine file, the parameters that vary, and the quantities asked for."""

    file: EngineFile
    parameters: tuple[Parameter, ...]
    quantities: tuple[AnyQuantity, ...]
    name: str = "engine"  # of the file, in messages

    @property
    def columns(self) -> list[str]:
        """Names of the parameters and quantities."""
        return [*(p.path for p in self.parameters), *(q.name for q in self.quantities)]

    @property
    def of_engine(self) -> tuple[Quantity, ...]:
        """Quantities of forces and moments."""
        return choose_of_engine(self.quantities)

    @cached_property
    def of_chapters(self) -> tuple[tuple[Sequence[ChapterQuantity], Variants], ...]:
        """Quantities that are computed variant by variant, and what evaluates them."""
        groups = group_by_chapter(self.quantities).items()
        return tuple(
            (members, load_chapter(chapter).Variants(self.file, members))
            for chapter, members in groups
        )

    @property
    def shape(self) -> tuple[int, ...]:
        """How many values each parameter has."""
        return tuple(map(len, self.parameters))

    @property
    def variants(self) -> int:
        """How many there are."""
        return math.prod(self.shape)

    @property
    def whole(self) -> Box:
        """The box of all variants."""
        return tuple(slice(0, n) for n in self.shape)

    def cut(self, box: Box) -> Sweep:
        """The variants in a box of the grid as a sweep of their own."""
        cuts = zip(self.parameters, box, strict=True)
        return replace(self, parameters=tuple(replace(p, values=p.values[cut]) for p, cut in cuts))

    def engine(self, box: Box) -> Engine:
        """All variants in a box of the grid, as one engine with an axis for each parameter.

        Raises:
            InputError: one of them cannot be; it is named.
        """
        try:
            return self._build(box)
        except InputError:
            self._refuse_first_bad(box)
            raise

    def _refuse_first_bad(self, box: Box) -> None:
        """Halve a box that has a variant which cannot be, axis by axis, until that is alone.

        Raises:
            InputError: what is wrong with it, with its figures.
        """
        for axis, n in enumerate(self.shape):
            low, high, _ = box[axis].indices(n)
            while high - low > 1:
                middle = (low + high) // 2
                try:
                    self._build((*box[:axis], slice(low, middle), *box[axis + 1 :]))
                    low = middle
                except InputError:
                    high = middle
            box = (*box[:axis], slice(low, high), *box[axis + 1 :])
        pairs = zip(self.parameters, box, strict=True)
        figures = {p.path: float(p.values[cut][0]) for p, cut in pairs}
        with naming_file(f"{self.name}: {tell_variant(figures)}"):
            self._build(box)

    def _build(self, box: Box) -> Engine:
        rank = len(self.parameters)
        arrays = {
            p.path: p.values[cut].reshape((1,) * k + (-1,) + (1,) * (rank - 1 - k))
            for k, (p, cut) in enumerate(zip(self.parameters, box, strict=True))
        }
        with naming_file(self.name):
            return attach_gas_torque(build(self.file, arrays, rank=rank), self.file, arrays)


def read_sweep(file: str, vary: Sequence[str], quantities: str | None = None) -> Sweep:
    """The sweep of an engine file that a user asks for.

    Args:
        vary: parameters and their values, as typed.
        quantities: by name, with commas; None: the usual ones, as far as they are known.

    Raises:
        BalcliError: what is wrong with the file, a parameter or a quantity, or if one of the
        variants cannot be.
    """
    model = read(file)
    parameters = tuple(parse_parameter(text, model) for text in vary)
    return plan_sweep(model, parameters, quantities, name_file(file))


def plan_sweep(
    model: EngineFile, parameters: tuple[Parameter, ...], quantities: str | None, name: str
) -> Sweep:
    """The sweep of an engine file; `name`: of the file, in messages; else as of `read_sweep`."""
    paths = [p.path for p in parameters]
    if twice := [path for path in paths if paths.count(path) > 1]:
        raise BalcliError(f"{twice[0]} is varied twice; give all its values at once")
    wanted = DEFAULT_QUANTITIES if quantities is None else quantities
    asked = parse_quantities(wanted, with_gas=model.gas is not None)
    sweep = Sweep(model, parameters, asked, name)
    if quantities is None:
        known = leave_out_unknown(build_corners(sweep), sweep.of_engine)
        sweep = replace(sweep, quantities=known)
    check_corners(sweep)
    return sweep


def check_corners(sweep: Sweep) -> None:
    """A first look whether all variants can be, at the corners of the grid: what can lock a
    mechanism grows towards one of them (what an uneven speed can do to it may lie between them, and
    is found on the way).

    Raises:
        InputError: one of them cannot be.
        BalcliError: a moment is asked for, and the file does not say where the throws stand; too
            many numbers vary.
    """
    if len(sweep.parameters) > MOST_PARAMETERS:
        raise BalcliError(
            f"{len(sweep.parameters)} numbers vary; at most {MOST_PARAMETERS} can at once"
        )
    refuse_unknown(build_corners(sweep), sweep.of_engine)
    try:
        refuse_unknown_of_chapters(sweep.file, sweep.quantities)
    except InputError as error:
        raise InputError(error.problems, sweep.name) from None
    except BalcliError as error:
        raise BalcliError(f"{sweep.name}: {error}") from None


def build_corners(sweep: Sweep) -> Engine:
    """The variants at the corners of the grid, as one engine.

    Raises:
        InputError: one of them cannot be.
    """
    corners = tuple(
        Parameter(p.path, np.array([p.values.min(), p.values.max()]), p.unit)
        for p in sweep.parameters
    )
    return Sweep(sweep.file, corners, (), sweep.name).engine((slice(None),) * len(corners))


def evaluate_box(sweep: Sweep, box: Box, size: BoxSize) -> list[Array]:
    """Each quantity for all variants of a box, SI or degrees, shape (variants in it,).

    Args:
        sweep: what to compute.
        box: of its grid.
        size: of what is computed at a time, and figures that some axes do not change once.

    Raises:
        InputError: one of them cannot be.
    """
    shape = tuple(len(range(*cut.indices(n))) for cut, n in zip(box, sweep.shape, strict=True))
    tiles = list(divide_into_tiles(shape, size))
    if len(tiles) == 1:
        values = _evaluate_tile(sweep, box)
        return [np.broadcast_to(one, shape).ravel() for one in values]
    found = [np.empty(shape) for _ in sweep.quantities]
    for tile in tiles:
        here = tuple(
            slice(cut.start + part.start, cut.start + part.stop)
            for cut, part in zip(box, tile, strict=True)
        )
        for whole, part_of_it in zip(found, _evaluate_tile(sweep, here), strict=True):
            whole[tile] = part_of_it
    return [whole.ravel() for whole in found]


def _evaluate_tile(sweep: Sweep, box: Box) -> list[Array]:
    """Each quantity for all variants of a box, of its shape, or of length 1 along some axes."""
    values: dict[AnyQuantity, Array] = {}
    if sweep.of_engine:
        found = _evaluate_engine(sweep, sweep.engine(box))
        values |= dict(zip(sweep.of_engine, found, strict=True))
    for members, variants in sweep.of_chapters:
        evaluated = _evaluate_one_by_one(sweep, box, variants, len(members))
        values |= dict(zip(members, evaluated, strict=True))
    return [values[q] for q in sweep.quantities]


def _evaluate_engine(sweep: Sweep, engine: Engine) -> list[Array]:
    """Quantities of forces and moments for all variants of an engine."""
    try:
        return evaluate_quantities(engine, sweep.of_engine)
    except InputError as error:  # of the gas of a variant
        raise InputError(error.problems, f"{sweep.name}: {error.file}") from None


def _evaluate_one_by_one(sweep: Sweep, box: Box, variants: Variants, count: int) -> list[Array]:
    """So many quantities for all variants of a box, each of the box's shape.

    Args:
        variants: evaluates them.

    Raises:
        InputError, BalcliError: one of them cannot be, with its figures.
    """
    axes = [p.values[cut] for p, cut in zip(sweep.parameters, box, strict=True)]
    paths = [p.path for p in sweep.parameters]
    rows = []
    for figures in product(*axes):
        own = dict(zip(paths, map(float, figures), strict=True))
        try:
            rows.append(variants.evaluate(own))
        except InputError as error:
            raise InputError(error.problems, f"{sweep.name}: {tell_variant(own)}") from None
        except BalcliError as error:
            raise BalcliError(f"{sweep.name}: {tell_variant(own)}: {error}") from None
    table = np.array(rows).reshape(*map(len, axes), count)
    return list(np.moveaxis(table, -1, 0))


def size_boxes(sweep: Sweep) -> BoxSize:
    """How much to compute at a time, by what the variants at the corners of the grid need: so much
    that a box is done in a fraction of a second and in little memory.
    """
    if not sweep.of_engine:
        return BoxSize(ALONE, ALONE)
    engine = build_corners(sweep)
    orders = find_orders(engine, sweep.of_engine)
    figures = max(engine.cylinders.count * max(map(len, orders)), 2 * max(map(max, orders)))
    samples = count_engine_samples(engine) // 2 ** len(sweep.parameters)
    alone = bool(sweep.of_chapters) or _has_many_cycles(sweep)
    most = ALONE if alone else CHUNK
    side = max(min(BYTES // (16 * int(figures)), SAMPLES // max(samples, 1), most), 1)
    peaks = any(q.part == "peak" for q in sweep.of_engine)
    products = engine.equal and not (alone or peaks or _asks_for_gas(sweep))
    return BoxSize(PRODUCTS * side if products and len(sweep.shape) > 1 else side, side)


def _has_many_cycles(sweep: Sweep) -> bool:
    """Whether gas is asked for, of more variants than are computed one by one at a time."""
    cycles = math.prod(len(p) for p in sweep.parameters if concerns_gas(p.path))
    return _asks_for_gas(sweep) and cycles > ALONE


def _asks_for_gas(sweep: Sweep) -> bool:
    return any(q.kind in GAS_KINDS for q in sweep.of_engine)


def divide_sweep(sweep: Sweep, size: BoxSize) -> Iterator[Box]:
    """The boxes of a sweep of which so much is computed at a time, in the order of rows."""
    if sweep.of_chapters:
        return divide_grid(sweep.shape, size.variants)
    return divide_into_boxes(sweep.shape, size)


def evaluate_chunks(sweep: Sweep, threads: int = 1, alone_s: float = ALONE_S) -> Iterator[Chunk]:
    """All variants, box by box, in the order of rows; the same figures by any number of threads.

    Args:
        sweep: what to compute.
        threads, alone_s: as of `share_work`.
    """
    size = size_boxes(sweep)
    compute = partial(_evaluate_chunk, sweep, size)
    return share_work(compute, divide_sweep(sweep, size), threads, alone_s)


class Block(NamedTuple):
    """A part of a sweep that is computed and written by itself.

    Attributes:
        number: from 0, in the order of rows.
        box: in the whole grid.
        sweep: the part as a sweep of its own.
    """

    number: int
    box: Box
    sweep: Sweep

    def place(self, chunk: Chunk) -> Chunk:
        """Return a chunk of this part with its box in the whole grid."""
        pairs = zip(self.box, chunk.box, strict=True)
        box = (slice(own.start + cut.start, own.start + cut.stop) for own, cut in pairs)
        return Chunk(tuple(box), chunk.values)


def divide_into_blocks(sweep: Sweep, rows: int) -> Iterator[Block]:
    """Yield the blocks of a sweep in the order of rows, of at most so many rows; fewer where a
    variant takes long.
    """
    most = min(rows, _BOXES * size_boxes(sweep).variants)
    for number, box in enumerate(divide_grid(sweep.shape, most)):
        yield Block(number, box, sweep.cut(box))


def _evaluate_chunk(sweep: Sweep, size: BoxSize, box: Box) -> Chunk:
    return Chunk(box, evaluate_box(sweep, box, size))


def split_columns(sweep: Sweep, chunk: Chunk) -> list[Array]:
    """A chunk as columns: parameters and quantities, each of shape (variants in it,)."""
    axes = [p.values[cut] for p, cut in zip(sweep.parameters, chunk.box, strict=True)]
    return [*(axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")), *chunk.values]


def join_chunks(sweep: Sweep, chunks: Iterable[Chunk]) -> list[Array]:
    """Each quantity on the whole grid, from all its chunks in the order of rows: shape (values of
    the first parameter, of the second ...).
    """
    found = zip(*(chunk.values for chunk in chunks), strict=True)
    return [np.concatenate(parts).reshape(sweep.shape) for parts in found]
