"""Quantities of variants of an engine file: forces and moments of all of them as arrays, quantities
of chapters (mounts, torsion, the cycle, guides) one variant after the other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..core.phasors import Array
from ..engine.build import Engine, build
from ..enginefile.model import EngineFile
from ..errors import BalcliError, InputError
from ..forces.quantity import evaluate_quantities
from .parameters import tell_variant
from .quantities import AnyQuantity, choose_of_engine, group_by_chapter, load_chapter
from .varied_gas import attach_gas_torque


class Evaluator:
    """Evaluates some quantities of variants of an engine file.

    Args:
        model: Engine file.
        quantities: Quantities that it has.

    Attributes:
        of_engine: Those of forces and moments.
        one_by_one: Whether some take each variant by itself.
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
            InputError: One of them cannot be.
        """
        engine = build(self._model, figures, rank=rank)
        return attach_gas_torque(engine, self._model, figures)

    def evaluate(
        self, figures: Mapping[str, Array], shape: tuple[int, ...], engine: Engine | None = None
    ) -> list[Array]:
        """Return each quantity, SI or degrees, of this shape.

        Args:
            figures: Figures that vary, by dotted name; they broadcast to the shape.
            shape: Of the variants.
            engine: Result of `build`, if that is known.

        Raises:
            InputError, BalcliError: One of the variants cannot be; those that are computed one by
                one are named.
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
            try:
                rows.append([v for _, one in self._chapters for v in one.evaluate(own)])
            except InputError as error:
                raise InputError(error.problems, tell_variant(own)) from None
            except BalcliError as error:
                raise BalcliError(f"{tell_variant(own)}: {error}" if own else str(error)) from None
        names = [q for members, _ in self._chapters for q in members]
        return {q: column.reshape(shape) for q, column in zip(names, np.array(rows).T, strict=True)}
