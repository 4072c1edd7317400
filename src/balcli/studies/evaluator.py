"""Quantities of variants of an engine file: forces and moments of all of them as arrays, quantities
of chapters (mounts, torsion, the cycle, guides) one variant after the other.

Torque of the gas of variants of an engine: computed when it is asked for, once for all variants
whose cylinders are alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from ..core.phasors import Array, Phasors
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.load import concerns_gas
from ..errors import BalcliError, InputError, naming_file
from ..file.model import EngineFile
from ..forces.quantity import evaluate_quantities
from ..forces.spectrum import compute_gas_torque
from .parameters import tell_variant
from .quantities import AnyQuantity, choose_of_engine, group_by_chapter, load_chapter


@contextmanager
def naming_variant(name: str) -> Iterator[None]:
    """Add the name of a variant, or of its file, to the errors that arise within this context."""
    try:
        yield
    except InputError as error:
        raise InputError(error.problems, ": ".join(filter(None, (name, error.file)))) from None
    except BalcliError as error:
        raise BalcliError(": ".join(filter(None, (name, str(error))))) from None


class _VariedGas:
    """Gas torque by order, shape (orders, *trailing), of length 1 along axes without effect on the
    gas.
    """

    def __init__(self, model: EngineFile, figures: Mapping[str, Array], rank: int) -> None:
        self._model, self._engines = model, list[Engine]()
        self._figures = {path: value for path, value in figures.items() if concerns_gas(path)}
        self._shape = np.broadcast_shapes((1,) * rank, *map(np.shape, self._figures.values()))

    def __call__(self, orders: Array) -> Phasors:
        """Return the torque at these orders; InputError for an impossible cycle."""
        self._engines = self._engines or list(self._build())
        found = [compute_gas_torque(engine, orders) for engine in self._engines]
        shape = (len(orders), *self._shape)
        return Phasors(
            orders,
            np.stack([one.vectors for one in found], axis=2).reshape(2, *shape),
            np.stack([one.noise for one in found], axis=1).reshape(shape),
        )

    def _build(self) -> Iterator[Engine]:
        columns = [np.broadcast_to(each, self._shape).ravel() for each in self._figures.values()]
        for row in range(int(np.prod(self._shape))):
            own = {
                path: float(column[row])
                for path, column in zip(self._figures, columns, strict=True)
            }
            with naming_file(tell_variant(own)):
                yield build(self._model, own)


class Evaluator:
    """Evaluates some quantities of variants of an engine file.

    Args:
        model: Engine file.
        quantities: Quantities that it has.

    Attributes:
        of_engine: Quantities of forces and moments.
        one_by_one: Whether some quantities are computed variant by variant.
    """

    def __init__(self, model: EngineFile, quantities: Sequence[AnyQuantity]) -> None:
        self._model, self._quantities = model, quantities
        self.of_engine = choose_of_engine(quantities)
        self._chapters = [
            (members, load_chapter(chapter).Variants(model, members))
            for chapter, members in group_by_chapter(quantities).items()
        ]
        self.one_by_one = bool(self._chapters)

    def build(self, figures: Mapping[str, Array], rank: int) -> Engine:
        """Return all variants as one engine with so many trailing axes, with their gas.

        Raises:
            InputError: One of them is impossible.
        """
        engine = build(self._model, figures, rank=rank)
        if self._model.gas is None:
            return engine
        return replace(engine, gas_of_variants=_VariedGas(self._model, figures, rank))

    def evaluate(
        self, figures: Mapping[str, Array], shape: tuple[int, ...], engine: Engine | None = None
    ) -> list[Array]:
        """Return each quantity, SI or degrees, of this shape.

        Args:
            figures: Figures that vary, by dotted name; they broadcast to the shape.
            shape: Of the variants.
            engine: Result of `build`, if that is known.

        Raises:
            InputError, BalcliError: One of the variants is impossible; the error names it if
                variants are computed one by one.
        """
        found: dict[AnyQuantity, Array] = {}
        if self.of_engine:
            engine = engine or self.build(figures, len(shape))
            values = evaluate_quantities(engine, self.of_engine)
            found |= dict(zip(self.of_engine, values, strict=True))
        if self._chapters:
            found |= self._evaluate_one_by_one(figures, shape)
        return [np.broadcast_to(found[q], shape) for q in self._quantities]

    def _evaluate_one_by_one(
        self, figures: Mapping[str, Array], shape: tuple[int, ...]
    ) -> dict[AnyQuantity, Array]:
        columns = {path: np.broadcast_to(v, shape).ravel() for path, v in figures.items()}
        rows: list[list[float]] = []
        for k in range(int(np.prod(shape))):
            own = {path: float(column[k]) for path, column in columns.items()}
            with naming_variant(tell_variant(own)), naming_file(""):
                rows.append([v for _, one in self._chapters for v in one.evaluate(own)])
        names = [q for members, _ in self._chapters for q in members]
        return {q: column.reshape(shape) for q, column in zip(names, np.array(rows).T, strict=True)}
