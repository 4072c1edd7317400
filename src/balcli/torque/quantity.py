"""Single figures of an engine with gas, for variants: `gas.1.5.amplitude`, `torque.mean`,
`fluctuation`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..engine.build import Engine, build
from ..engine.variants import EngineVariants
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..forces.orders import split_order
from ..forces.quantity import SCALAR_PARTS, Quantity
from ..forces.spectrum import compute_spectra
from ..limits import HIGHEST_ORDER
from .analysis import analyze_torque
from .course import find_constant_inertia, find_torque_curves

# What the kinds of `forces.kinds` are called here.
KINDS = {
    "gas": "gas",
    "torque": "torque_total",
    "torque_total": "torque_total",
    "roll_total": "roll_total",
}
_OF_CYCLE = ("mean", "max", "min")


@dataclass(frozen=True)
class TorqueQuantity:
    """One figure.

    Attributes:
        kind: one of KINDS, or `fluctuation`; `torque` is that of gas and inertia.
        order: None for what is of the whole cycle.
        part: one of SCALAR_PARTS; of the cycle `mean`, `max`, `min`; empty for the fluctuation.
    """

    kind: str
    order: float | None
    part: str

    @property
    def name(self) -> str:
        """As a user writes it."""
        if self.kind == "fluctuation":
            return self.kind
        return f"{self.kind}.{self.part}" if self.order is None else self._of_order

    @property
    def _of_order(self) -> str:
        return f"{self.kind}.{self.order:g}.{self.part}"

    @property
    def unit(self) -> str:
        """SI."""
        return "" if self.kind == "fluctuation" else "N·m"


def parse_quantity(text: str) -> TorqueQuantity:
    """`gas.1.5.amplitude` and its like.

    Raises:
        BalcliError: anything else, with what there is.
    """
    kind, _, rest = text.partition(".")
    if kind == "fluctuation" and not rest:
        return TorqueQuantity(kind, None, "")
    if kind == "torque" and rest in _OF_CYCLE:
        return TorqueQuantity(kind, None, rest)
    order, part = split_order(rest)
    if kind not in KINDS or order is None or part not in SCALAR_PARTS:
        raise BalcliError(
            f"{text} is no quantity: give gas, torque or roll_total with an order up to "
            f"{HIGHEST_ORDER} and one of {', '.join(SCALAR_PARTS)}, such as gas.1.5.amplitude; or "
            f"{', '.join(f'torque.{part}' for part in _OF_CYCLE)}, fluctuation"
        )
    return TorqueQuantity(kind, order, part)


def list_names(model: EngineFile) -> Iterator[str]:
    """Those that an engine with gas has, with N for the order."""
    for kind in dict.fromkeys(KINDS.values()):
        yield from (f"{kind}.N.{part}" for part in SCALAR_PARTS)
    yield from (f"torque.{part}" for part in _OF_CYCLE)
    if find_constant_inertia(build(model)) is not None:
        yield "fluctuation"


def refuse_unknown(model: EngineFile, quantities: Sequence[TorqueQuantity]) -> None:
    """Nothing, unless the engine has no gas.

    Raises:
        BalcliError: it has none.
    """
    if model.gas is None:
        raise BalcliError(f"{quantities[0].name}: the engine file has no [gas]")


class Variants:
    """Evaluates quantities of variants of a file one by one.

    Args:
        model: with gas.
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TorqueQuantity]) -> None:
        self._engines, self._quantities = EngineVariants(model), quantities

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """The value of each quantity for one variant, by the figures that vary.

        Raises:
            InputError, BalcliError: it cannot be; a fluctuation without inertia.
        """
        return _evaluate(self._engines.build(values), self._quantities)


def _evaluate(engine: Engine, quantities: Sequence[TorqueQuantity]) -> list[float]:
    found: dict[TorqueQuantity, float] = {}
    by_order = [q for q in quantities if q.order is not None]
    if by_order:
        found |= _evaluate_orders(engine, by_order)
    if any(q.kind == "torque" and q.order is None for q in quantities):
        curves = find_torque_curves(engine)
        lowest, highest = curves.total.extremes()
        values = {"mean": curves.gas.mean, "max": highest.value, "min": lowest.value}
        found |= {TorqueQuantity("torque", None, part): value for part, value in values.items()}
    fluctuation = TorqueQuantity("fluctuation", None, "")
    if fluctuation in quantities:
        found[fluctuation] = _find_fluctuation(engine)
    return [found[q] for q in quantities]


def _evaluate_orders(
    engine: Engine, quantities: Sequence[TorqueQuantity]
) -> dict[TorqueQuantity, float]:
    orders = np.array(sorted({q.order for q in quantities if q.order is not None}))
    spectra = compute_spectra(engine, orders, {KINDS[q.kind] for q in quantities})
    found = {}
    for q in quantities:
        same = Quantity(KINDS[q.kind], q.order or 0, q.part)
        found[q] = float(same.read_from(spectra[KINDS[q.kind]]))
    return found


def _find_fluctuation(engine: Engine) -> float:
    flywheel = analyze_torque(engine, [1]).flywheel
    if flywheel is None or flywheel.speed is None:
        raise BalcliError(
            "fluctuation: the file gives no inertia; give inertia in [crank] or [flywheel]"
        )
    return flywheel.speed.fluctuation
