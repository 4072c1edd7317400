"""Engines of one file of which some figures vary, one engine after the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Generic, TypeVar

from ..enginefile.model import EngineFile
from .build import Engine, build
from .gas import EngineGas
from .gas_figures import concerns_gas

Key = TypeVar("Key")
Value = TypeVar("Value")
Asked = TypeVar("Asked")
Values = tuple[tuple[str, float], ...]  # figures by dotted name
_KEPT = 64  # variants that are remembered: as many as are computed at a time


class EngineVariants:
    """Builds variants of an engine; what their figures do not change is not built again: the same
    engine, or the gas of one that has other masses, or runs at another speed.

    Args:
        model: the file.
    """

    def __init__(self, model: EngineFile) -> None:
        self._model = model
        self._engines: dict[Values, Engine] = {}
        self._gas: dict[Values, EngineGas | None] = {}

    def build(self, values: Mapping[str, float]) -> Engine:
        """The engine with these figures, by dotted name, in place of the file's.

        Raises:
            InputError, BalcliError: it cannot be.
        """
        of_gas = tuple((path, value) for path, value in values.items() if concerns_gas(path))

        def make() -> Engine:
            engine = build(self._model, values, gas=self._gas.get(of_gas))
            remember(self._gas, of_gas, lambda: engine.gas)
            return engine

        return remember(self._engines, tuple(values.items()), make)


class FiguresOfVariants(Generic[Asked]):
    """Evaluates quantities of variants of a file one by one.

    Args:
        evaluate: the value of each quantity of one engine.
        model: whose engine has what they are of.
    """

    def __init__(
        self,
        evaluate: Callable[[Engine, Sequence[Asked]], list[float]],
        model: EngineFile,
        quantities: Sequence[Asked],
    ) -> None:
        self._evaluate, self._quantities = evaluate, quantities
        self._engines = EngineVariants(model)

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """The value of each quantity for one variant, by the figures that vary.

        Raises:
            InputError, BalcliError: it cannot be, or what is asked of it is not known.
        """
        return self._evaluate(self._engines.build(values), self._quantities)


def remember(known: dict[Key, Value], key: Key, make: Callable[[], Value]) -> Value:
    """What is known under a key, or is now made; all is forgotten when there is much of it."""
    found = known.get(key)
    if found is None:
        found = make()
        if len(known) >= _KEPT:
            known.clear()
        known[key] = found
    return found
