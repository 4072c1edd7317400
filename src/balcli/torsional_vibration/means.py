"""Compute the mean torque that each shaft of an engine carries: what the cylinders give on average
flows from their throws to the last part of `[[torsion.rear]]`, which takes all of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np

from ..core.phases import RPM
from ..core.vibration import Real
from ..engine.engine import Engine
from ..forces.spectrum import GasAtSpeeds, compute_spectra, follow_gas

_MEAN = np.zeros(1)  # the order of a mean
_ANY_RPM = 100.0  # a speed


class Link(NamedTuple):
    """A shaft as a way for torque.

    Attributes:
        start: Index of the node at its start.
        end: Index of the node at its end, at whose speed the shaft turns.
        gear: This speed over crank speed.
    """

    start: int
    end: int
    gear: float


def share_out(links: Sequence[Link], sources: Sequence[int], sink: int) -> Real:
    """Return the torque of each shaft for 1 N m of each source, shape (sources, shafts).

    A torque of 1 N m on a node at crank speed has the same power on its whole way to the sink, so
    that a shaft at another speed carries it divided by its `gear`.

    Args:
        links: Shafts, which form a tree.
        sources: Index of the node on which each source acts.
        sink: Index of the node that takes all power.
    """
    onward = _lead_to(links, sink)
    shares = np.zeros((len(sources), len(links)))
    for source, node in enumerate(sources):
        place = node
        while place != sink:
            shaft, place = onward[place]
            shares[source, shaft] = 1 / links[shaft].gear
    return shares


def _lead_to(links: Sequence[Link], sink: int) -> Mapping[int, tuple[int, int]]:
    """Return for each node the next shaft on its way to the sink, and the node behind this shaft:
    (shaft, node).
    """
    onward: dict[int, tuple[int, int]] = {}
    reached = [sink]
    for node in reached:  # grows as nodes are reached
        for shaft, link in enumerate(links):
            for near, far in ((link.start, link.end), (link.end, link.start)):
                if near == node and far != sink and far not in onward:
                    onward[far] = (shaft, node)
                    reached.append(far)
    return onward


class CylinderMeans(NamedTuple):
    """Mean torques of cylinders as functions of the speed; friction does not count.

    Attributes:
        at: Function that returns the mean torque of each cylinder, N m, shape (*speeds, cylinders),
            at speeds, rpm. It computes the gas when it is first called.
        nodes_rpm: Speeds at which the mean torque is not smooth.
    """

    at: Callable[[Real], Real]
    nodes_rpm: tuple[float, ...]

    def replace_cylinder(self, row: int, other: CylinderMeans | None) -> CylinderMeans:
        """Return the means in which one cylinder has its mean torque in other ones; None: 0."""

        def find_means(rpm: Real) -> Real:
            means = np.array(self.at(rpm))
            means[..., row] = 0.0 if other is None else other.at(rpm)[..., row]
            return means

        return self._replace(at=find_means)


def find_cylinder_means(engine: Engine) -> CylinderMeans | None:
    """Return the mean torques of the cylinders of an engine; None without gas."""
    if engine.gas is None:
        return None
    still = replace(engine, ripple=(), speed_rpm=1 / RPM)  # means depend on no speed

    @cache
    def follow() -> GasAtSpeeds:
        return follow_gas(still, _find_means)

    def find_means(rpm: Real) -> Real:
        return np.asarray(follow().torque(rpm)[0].real)

    return CylinderMeans(find_means, engine.gas.nodes_rpm)


@dataclass(frozen=True, eq=False)
class MeanTorques:
    """Mean torques of shafts as functions of the speed.

    Attributes:
        cylinders: Mean torques of cylinders.
        shares: Torque of each shaft for 1 N m of each cylinder, shape (cylinders, shafts).
    """

    cylinders: CylinderMeans
    shares: Real

    @property
    def nodes_rpm(self) -> Sequence[float]:
        """Speeds at which the mean torque is not smooth."""
        return self.cylinders.nodes_rpm

    @property
    def judged_rpm(self) -> Real:
        """Speeds that tell whether there is a mean torque at all."""
        return np.array(self.nodes_rpm or (_ANY_RPM,))

    def find_total(self, rpm: Real) -> Real:
        """Return the mean torque of all cylinders, N m, shape (*speeds,)."""
        return np.asarray(self.cylinders.at(rpm).sum(axis=-1))

    def at(self, rpm: Real) -> Real:
        """Return the mean torque of each shaft, N m, shape (*speeds, shafts)."""
        return np.asarray(self.cylinders.at(rpm) @ self.shares)

    def extend(self, shafts: int) -> MeanTorques:
        """Return the mean torques with further shafts, which carry none; `shafts`: number of all
        shafts.
        """
        further = shafts - self.shares.shape[1]
        return replace(self, shares=np.pad(self.shares, ((0, 0), (0, further))))


def _find_means(engine: Engine) -> np.ndarray:
    """Return the mean torque of the gas of each cylinder, shape (1, cylinders)."""
    return compute_spectra(engine, _MEAN, ["gas"], by_cylinder=True)["gas"].x
