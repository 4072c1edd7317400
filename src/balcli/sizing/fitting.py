"""A remedy in the making: devices are added order by order, each with its reason, and the next ones
see what is left.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple, TypeVar

from ..core.cylinders import Device
from ..engine.build import Engine
from ..enginefile.model import Counterweight, Shaft, Slider
from .effects import Part, Rest, Slot, exactly, rest, steady
from .remedy import Remedy, fitted

FORWARD = (Part("force", 1), Part("moment", 1))
BACKWARD = (Part("force", -1), Part("moment", -1))
SAME_PLACE = (
    "one plane, or planes at the same z, cannot take a moment; choose two planes with "
    "some "
    "distance between them"
)

T = TypeVar("T")


class Fitting(NamedTuple):
    """An engine at steady speed, and what has been fitted so far: tables of the engine file with
    their reasons.
    """

    engine: Engine
    scheme: str
    order: int | None = None
    fits: tuple[tuple[Counterweight | Shaft | Slider, str], ...] = ()
    beyond: tuple[Device, ...] = ()
    details: Mapping[str, Any] = MappingProxyType({})

    @classmethod
    def of(cls, engine: Engine, scheme: str, order: int | None = None) -> Fitting:
        return cls(steady(engine), scheme, order)

    @property
    def remedy(self) -> Remedy:
        weights, shafts, sliders = self._of(Counterweight), self._of(Shaft), self._of(Slider)
        reasons = [
            reason
            for kind in (Counterweight, Shaft, Slider)
            for table, reason in self.fits
            if isinstance(table, kind)
        ]
        return Remedy(
            self.scheme,
            self.order,
            weights,
            shafts,
            sliders,
            tuple(reasons),
            self.details,
            self.beyond,
        )

    def rest(self, order: int) -> Rest:
        """What is left of an order with the devices so far."""
        return rest(fitted(self.engine, self.remedy), order)

    def add(self, slots: Sequence[Slot], unbalances: Iterable[complex], reason: str) -> Fitting:
        """With the devices in these slots; those of no unbalance are left out."""
        axis = float(self.engine.first_axis_deg)
        new = tuple(
            (slot.table(u, axis), reason) for slot, u in zip(slots, unbalances, strict=True) if u
        )
        return self._replace(fits=self.fits + new)

    def cancel(
        self,
        slots: Sequence[Slot],
        parts: Sequence[Part],
        reason: str,
        impossible: str = SAME_PLACE,
    ) -> Fitting:
        """With devices in these slots that leave nothing of the parts; BalcliError if they
        cannot.
        """
        if not slots:
            return self
        fit = exactly(slots, self.rest(slots[0].order), parts, impossible)
        told = (
            self.note(condition_number=fit.condition)
            if len(slots) > 1 and fit.condition < math.inf
            else self
        )
        return told.add(slots, fit.unbalances, reason)

    def note(self, **details: Any) -> Fitting:
        """With further figures in the details."""
        return self._replace(details={**self.details, **details})

    def _of(self, kind: type[T]) -> tuple[T, ...]:
        return tuple(table for table, _ in self.fits if isinstance(table, kind))
