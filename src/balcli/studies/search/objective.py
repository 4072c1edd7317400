"""What makes an arrangement good: a weighted sum of quantities, and limits that must be kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...core.phasors import Array
from ...errors import BalcliError
from ...forces.quantity import Quantity, parse_quantity_list


@dataclass(frozen=True)
class Objective:
    """Weights by quantity, and upper limits by quantity (SI)."""

    weights: dict[Quantity, float]
    limits: dict[Quantity, float]

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """All that have to be known, each once."""
        return tuple(dict.fromkeys((*self.weights, *self.limits)))

    def evaluate(self, value: Callable[[Quantity], float | Array]) -> Array:
        """The weighted sum, infinite where a limit is broken, shape (candidates,).

        Args:
            value: gives a quantity for all candidates.
        """
        total = np.asarray(sum(weight * value(q) for q, weight in self.weights.items()), float)
        for q, limit in self.limits.items():
            total = np.where(value(q) < limit, total, np.inf)
        return total


def parse_objective(
    minimise: str, limits: Sequence[str] = (), *, with_gas: bool = False
) -> Objective:
    """`moment.1.major,force.2.major=0.5` and limits such as `moment.2.major<100` (N, N m).

    Args:
        with_gas: whether the engine has gas.

    Raises:
        BalcliError: what is no quantity, weight or limit.
    """
    weights: dict[Quantity, float] = {}
    for term in minimise.split(","):
        name, _, weight = term.partition("=")
        share = _parse_positive(weight, term) if weight else 1.0
        weights |= dict.fromkeys(_parse_sizes(name, with_gas), share)
    bounds: dict[Quantity, float] = {}
    for text in limits:
        name, less, bound = text.partition("<")
        if not less:
            raise BalcliError(
                f'--limit "{text}": give a quantity and what it must stay below, such as '
                '"moment.2.major<100"'
            )
        bounds |= dict.fromkeys(_parse_sizes(name, with_gas), _parse_positive(bound, text))
    return Objective(weights, bounds)


def _parse_sizes(name: str, with_gas: bool) -> tuple[Quantity, ...]:
    """Quantities that can be large or small."""
    found = parse_quantity_list(name, with_gas=with_gas)
    for q in found:
        if q.part == "axis":
            raise BalcliError(
                f"{q.name} is a direction, which cannot be large or small; name a size such as "
                f"{q.kind}.{q.order:g}.major"
            )
        if q.signed:
            raise BalcliError(
                f"{q.name} may be negative, and then would be the better the larger it is; "
                f"name a size such as {q.kind}.{q.order:g}.major"
            )
    return found


def _parse_positive(text: str, whole: str) -> float:
    """A positive number; `whole` is what it stands in."""
    try:
        number = float(text)
    except ValueError:
        number = float("nan")
    if not 0 < number < float("inf"):
        raise BalcliError(f'"{whole}": {text.strip() or "nothing"} is no positive number')
    return number
