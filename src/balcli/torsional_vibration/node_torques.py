"""Make the torques of `[[torsion.excitation]]`: those of propellers, fans and alternators on their
nodes.

A torque on a node is `A cos(order theta - angle)`, with the angle theta of the node: its gear times
the crank angle. It is positive in the sense in which the crank turns.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np

from ..core.vibration import Real
from ..errors import Problem
from ..file.torsion_tables import NodeExcitation, Part, Torsion
from .chain_file import refuse_node
from .means import MeanTorques
from .system import NodeTorque

_WHOLE = 1e-9  # twice an order is whole if it is this close to a whole number


def find_mistakes(
    torsion: Torsion, nodes: Sequence[str], *, has_gas: bool, has_speed: bool
) -> Iterator[Problem]:
    """Yield the mistakes of [[torsion.excitation]].

    Args:
        torsion: Table [torsion].
        nodes: Names of all nodes.
        has_gas: Whether the engine has gas.
        has_speed: Whether the file gives the engine's speed.
    """
    for number, entry in enumerate(torsion.excitation, 1):
        path = f"torsion.excitation.{number}"
        if entry.node not in nodes:
            yield Problem(f"{path}.node", refuse_node(entry.node, nodes))
        if entry.share is not None and not has_gas:
            message = "is a share of the mean torque, which needs [gas]; give amplitude instead"
            yield Problem(f"{path}.share", message)
        if entry.law is not None and entry.rated_speed is None and not has_speed:
            message = "needs the speed of the amplitude; give rated_speed, or operation.speed"
            yield Problem(f"{path}.law", message)


def find_idle_limits(
    parts: Sequence[tuple[str, Part]], carrying: Collection[str]
) -> Iterator[Problem]:
    """Yield the parts whose shaft carries no mean torque.

    Args:
        parts: Paths and tables of the parts whose limit is their mean torque.
        carrying: Names of the shafts that carry a mean torque.
    """
    for path, part in parts:
        if part.name not in carrying:
            message = (
                'is "mean", but its shaft carries no mean torque: that of the cylinders flows to '
                "the last part of [[torsion.rear]], and needs [gas] with a mean; give a torque in "
                "N m"
            )
            yield Problem(f"{path}.torque_limit", message)


def make_torques(
    torsion: Torsion,
    places: Mapping[str, int],
    gears: Mapping[str, float],
    means: MeanTorques | None,
    rated_rpm: float | None,
) -> Iterator[NodeTorque]:
    """Yield the torques of [[torsion.excitation]].

    Args:
        torsion: Table [torsion], without mistakes.
        places: Index of each node, by its name.
        gears: Speed of each node over crank speed, by its name.
        means: Mean torques; None: the engine has no gas.
        rated_rpm: Speed of the engine; None: the file gives none.
    """
    for entry in torsion.excitation:
        gear = gears[entry.node]
        order = entry.order * abs(gear)
        halves = round(2 * order)
        # Cylinders have only half orders; a torque of another order has no phase to them.
        is_order = halves > 0 and abs(2 * order - halves) <= _WHOLE * halves
        if is_order:
            order = halves / 2
        yield NodeTorque(
            node=places[entry.node],
            own_order=entry.order,
            order=order,
            turn=_find_turn(entry, gear) if is_order else None,
            amplitude=_Amplitude(entry, gear, means, rated_rpm),
        )


def _find_turn(entry: NodeExcitation, gear: float) -> complex | None:
    """Return the phasor of 1 N m; None if the phase to the cylinders is not known. A node that
    turns backwards has a conjugate phasor.
    """
    if entry.angle is None:
        return None
    angle = math.radians(entry.angle)
    return cmath.exp(-1j * angle if gear > 0 else 1j * angle)


class _Amplitude:
    """Function that returns the amplitude of an entry, N m, at speeds, rpm."""

    def __init__(
        self,
        entry: NodeExcitation,
        gear: float,
        means: MeanTorques | None,
        rated_rpm: float | None,
    ) -> None:
        self._entry = entry
        self._gear = gear
        self._means = means
        self._rated_rpm = entry.rated_speed or rated_rpm or math.nan

    def __call__(self, rpm: Real) -> Real:
        entry = self._entry
        if entry.share is not None and self._means is not None:
            mean = np.abs(self._means.find_total(rpm)) / abs(self._gear)
            return np.asarray(entry.share * mean)
        amplitude = np.full(np.shape(rpm), entry.amplitude or 0.0)
        if entry.law is None:
            return amplitude
        return np.asarray(amplitude * (rpm / self._rated_rpm) ** 2)
