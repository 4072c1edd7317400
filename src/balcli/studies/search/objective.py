"""What makes an arrangement good: a weighted sum of quantities, and limits that must be kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeGuard, TypeVar

import numpy as np

from ...core.phasors import Array
from ...errors import BalcliError
from ...forces.kinds import GAS_KINDS
from ...forces.quantity import Quantity
from ..quantities import AnyQuantity, parse_quantities

Asked = TypeVar("Asked", bound=AnyQuantity)
_SIGNED = ("torque.mean", "torque.min")


class Merit(NamedTuple):
    """How good one arrangement is: the less the better, what keeps its limits before all else.

    Attributes:
        excess: the largest share of its limit that a quantity has, if that is 1 or more; else 0.
        value: the weighted sum.
    """

    excess: float
    value: float


@dataclass(frozen=True)
class Objective(Generic[Asked]):
    """Weights by quantity, and upper limits by quantity (SI)."""

    weights: dict[Asked, float]
    limits: dict[Asked, float]

    @property
    def quantities(self) -> tuple[Asked, ...]:
        """All that have to be known, each once."""
        return tuple(dict.fromkeys((*self.weights, *self.limits)))

    def evaluate(self, value: Callable[[Asked], float | Array]) -> Array:
        """The weighted sum, infinite where a limit is broken, shape (candidates,).

        Args:
            value: gives a quantity for all candidates.
        """
        total = self._add_up(value)
        for q, limit in self.limits.items():
            total = np.where(value(q) < limit, total, np.inf)
        return total

    def judge(self, value: Callable[[Asked], float]) -> Merit:
        """How good one candidate is, whose quantities `value` gives."""
        shares = [value(q) / limit for q, limit in self.limits.items()]
        broken = [share for share in shares if not share < 1]
        return Merit(max(broken, default=0.0), float(self._add_up(value)))

    def _add_up(self, value: Callable[[Asked], float | Array]) -> Array:
        """The weighted sum, limits left aside."""
        return np.asarray(sum(weight * value(q) for q, weight in self.weights.items()), float)


def parse_objective(
    minimise: str, limits: Sequence[str] = (), *, with_gas: bool = False
) -> Objective[AnyQuantity]:
    """`moment.1.major,force.2.major=0.5` and limits such as `moment.2.major<100` (N, N m).

    Args:
        with_gas: whether the engine has gas.

    Raises:
        BalcliError: what is no quantity, weight or limit.
    """
    weights: dict[AnyQuantity, float] = {}
    for term in minimise.split(","):
        name, _, weight = term.partition("=")
        share = _parse_positive(weight, term) if weight else 1.0
        weights |= dict.fromkeys(_parse_sizes(name, with_gas), share)
    bounds: dict[AnyQuantity, float] = {}
    for text in limits:
        name, less, bound = text.partition("<")
        if not less:
            raise BalcliError(
                f'--limit "{text}": give a quantity and what it must stay below, such as '
                '"moment.2.major<100"'
            )
        bounds |= dict.fromkeys(_parse_sizes(name, with_gas), _parse_positive(bound, text))
    return Objective(weights, bounds)


def choose_sums(objective: Objective[AnyQuantity]) -> Objective[Quantity] | None:
    """The same objective, if all its quantities are sums over the cylinders by inertia, which are
    evaluated for many candidates at once; else None.
    """
    weights = {q: w for q, w in objective.weights.items() if _is_sum(q)}
    limits = {q: limit for q, limit in objective.limits.items() if _is_sum(q)}
    if len(weights) < len(objective.weights) or len(limits) < len(objective.limits):
        return None
    return Objective(weights, limits)


def _is_sum(q: AnyQuantity) -> TypeGuard[Quantity]:
    return isinstance(q, Quantity) and q.kind not in GAS_KINDS


def _parse_sizes(name: str, with_gas: bool) -> tuple[AnyQuantity, ...]:
    """Quantities that can be large or small."""
    found = parse_quantities(name, with_gas=with_gas)
    for q in found:
        if not isinstance(q, Quantity):
            if q.name in _SIGNED:
                raise BalcliError(f"{q.name} may be negative; name a size such as torque.max")
            continue
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
