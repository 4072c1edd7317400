"""A remedy in the making: devices are added order by order, each with its reason, and the next ones
see what is left.

Why a device is fitted, in one sentence: what it cancels, and why nothing less will do. Sizes
stand in the tables, in the reader's units.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from ..engine.build import Engine
from ..forces.kinds import ROLL_TOTAL
from ..forces.spectrum import compute_spectra
from .effects import LEFT, Slot, solve_exactly
from .planes import SAME_PLACE
from .remedy import Remedy, fit_devices
from .residual import BACKWARD, FORWARD, ROLL, Residual, ResidualPart, find_residual, hold_steady


class Fitting(NamedTuple):
    """An engine at steady speed, without new devices, and the remedy so far."""

    engine: Engine
    remedy: Remedy

    @classmethod
    def start(
        cls, engine: Engine, scheme: str, order: int | None = None, note: str = ""
    ) -> Fitting:
        """Nothing is fitted yet; `order` is the one that the scheme balances, if it is one, and
        `note` what there is to say of that choice.
        """
        return cls(hold_steady(engine), Remedy(scheme, order, note=note))

    def find_residual(self, order: int) -> Residual:
        """What is left of an order with the devices so far."""
        return find_residual(fit_devices(self.engine, self.remedy), order)

    def add(self, slots: Sequence[Slot], unbalances: Iterable[complex], reason: str) -> Fitting:
        """With devices of these unbalances (kg m) in these slots; those of none are left out, and
        counterweights that are dust beside what moves.
        """
        first_axis_deg, dust = float(self.engine.first_axis_deg), LEFT * self._find_moving()
        tables = [
            slot.make_table(unbalance, first_axis_deg)
            for slot, unbalance in zip(slots, unbalances, strict=True)
            if abs(unbalance) > (dust if slot.kind == "counterweight" else 0)
        ]
        return self._replace(remedy=self.remedy.add_devices(tables, reason))

    def _find_moving(self) -> float:
        """All masses that move, at the crank radius, kg m."""
        masses = (w.rotating + w.share + w.reciprocating for w in self.engine.weighed)
        return float(sum(masses) * self.engine.cylinders.radius)

    def cancel(
        self,
        slots: Sequence[Slot],
        parts: Sequence[ResidualPart],
        reason: str,
        residual: Residual | None = None,
    ) -> Fitting:
        """With devices in these slots that leave nothing of the parts of their order.

        Args:
            residual: what is left of these parts with the devices so far, where that is known.

        Raises BalcliError if the slots cannot do so.
        """
        if not slots:
            return self
        left = residual or self.find_residual(slots[0].order)
        fit = solve_exactly(slots, left, parts, SAME_PLACE)
        fitting = self.add(slots, fit.unbalances, reason)
        if len(slots) > 1 and fit.condition < math.inf:
            return fitting.add_details(condition_number=fit.condition)
        return fitting

    def describe_roll(self, before: Residual, group: str = "") -> Fitting:
        """With details of what the devices so far leave of an order's roll, and of what it was; of
        an engine with gas, of the roll with the gas at its speed, too.
        """
        order = before.order
        details = {
            "roll_left_Nm": self.find_residual(order).size(ROLL),
            "roll_before_Nm": before.size(ROLL),
        }
        if self.engine.gas is not None:
            fitted = fit_devices(self.engine, self.remedy)
            details["roll_with_gas_left_Nm"] = _size_total_roll(fitted, order)
            details["roll_with_gas_before_Nm"] = _size_total_roll(self.engine, order)
        return self.add_details(group, **details)

    def add_details(self, group: str = "", /, **figures: Any) -> Fitting:
        """Return the fitting with further details in the remedy: `Remedy.add_details`."""
        return self._replace(remedy=self.remedy.add_details(group, **figures))


def _size_total_roll(engine: Engine, order: int) -> float:
    """Amplitude of an order of the roll with gas, N m."""
    return float(compute_spectra(engine, [order], (ROLL_TOTAL.name,))[ROLL_TOTAL.name].major[0])


def explain_counterweights(residual: Residual) -> str:
    """Return why weights are fitted for the part of order 1 that turns with the crank."""
    both = "both" if residual.force(1) and residual.moment(1) else "it"
    turn = "counterweights turn with it too and cancel"
    return f"{_name(residual, 1)} turning with the crank: {turn} {both}"


def explain_shaft(residual: Residual, sense: int, count: int) -> str:
    """Return why this many eccentrics on one shaft take all that turns in this sense."""
    what = "eccentrics in two planes" if residual.force(sense) else "two opposite eccentrics"
    what = "one eccentric" if count == 1 else what
    return (
        f"{_name(residual, sense)} turning {_turning(sense)} the crank: nothing on the crankshaft "
        f"can cancel it; {what} {_on_shaft(residual, sense)} can"
    )


def explain_one_eccentric(
    residual: Residual, sense: int, whole: bool, more: str, halves: bool = False
) -> str:
    """Return why one eccentric is fitted for the force that turns in this sense, or two halves.

    Args:
        residual: What is left at the order.
        sense: Sense of rotation: 1 with the crank, -1 against it.
        whole: Whether it takes the moment that turns so, too.
        more: What would take the moment that stays otherwise.
        halves: Whether it is divided.
    """
    what = _name(residual, sense) if whole else f"Order {residual.order} force"
    why = "nothing on the crankshaft can cancel it"
    if sense * residual.order == 1:
        why = "the scheme counterweights would cancel it without a shaft"
    reason = (
        f"{what} turning {_turning(sense)} the crank: {why}; "
        f"one eccentric {_on_shaft(residual, sense)} can"
    )
    if halves:
        reason += ", in two halves on opposite sides of the crank so that no roll is added"
    return reason if whole else f"{reason}; a moment stays, which {more}"


def explain_couple(residual: Residual, sense: int) -> str:
    """Return why two opposite eccentrics are fitted for the moment that turns in this sense."""
    needless = "; the scheme counterweights would do so without a shaft"
    return (
        f"Order {residual.order} moment turning {_turning(sense)} the crank: two opposite "
        f"eccentrics {_on_shaft(residual, sense)} make the opposite moment and no force, wherever "
        f"the shaft stands{needless * (sense * residual.order == 1)}"
    )


def explain_sliders(residual: Residual) -> str:
    """Return why two sliders are fitted for the force."""
    return (
        f"Order {residual.order} force: sliders driven at {residual.order} times crank speed along "
        "the axes of its ellipse, of sizes |V+| + |V-| and ||V+| - |V-||"
    )


def _name(residual: Residual, sense: int) -> str:
    """Return what turns at this order in this sense."""
    kinds = [part.kind for part in (FORWARD if sense > 0 else BACKWARD) if residual.parts[part]]
    return f"Order {residual.order} {' and '.join(kinds)}"


def _on_shaft(residual: Residual, sense: int) -> str:
    return f"on a shaft at {sense * residual.order:+d} times crank speed"


def _turning(sense: int) -> str:
    return "with" if sense > 0 else "against"
