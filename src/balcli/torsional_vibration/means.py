"""Compute the mean torque that each shaft of an engine carries: what the cylinders give on average
flows from their throws to the last part of `[[torsion.rear]]`, which takes all of it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
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


@dataclass(frozen=True, eq=False)
class EngineMeans:
    """Mean torques of the cylinders of an engine with gas; friction does not count. The gas is
    computed when it is first needed.

    Attributes:
        engine: The engine.
    """

    engine: Engine

    @cached_property
    def _gas(self) -> Real | GasAtSpeeds:
        """Mean torque of each cylinder, N m, shape (cylinders,), or the gas that depends on the
        speed.
        """
        still = replace(self.engine, ripple=(), speed_rpm=1 / RPM)  # means depend on no speed
        if self.nodes_rpm:
            return follow_gas(still, _find_means)
        return np.asarray(_find_means(still)[0].real)

    @property
    def nodes_rpm(self) -> tuple[float, ...]:
        """Speeds at which the mean torque is not smooth."""
        gas = self.engine.gas
        return () if gas is None else gas.nodes_rpm

    def at(self, rpm: Real) -> Real:
        """Return the mean torque of each cylinder, N m, shape (*speeds, cylinders)."""
        gas = self._gas
        if isinstance(gas, GasAtSpeeds):
            return np.asarray(gas.torque(rpm)[0].real)
        return np.broadcast_to(gas, (*np.shape(rpm), len(gas)))


class CylinderMeans(NamedTuple):
    """Mean torques of cylinders, some of which may be those of other engines.

    Attributes:
        own: Mean torques of the cylinders of the engine.
        others: Row of each replaced cylinder, and the means that hold for it; None: 0.
    """

    own: EngineMeans
    others: tuple[tuple[int, CylinderMeans | None], ...] = ()

    @property
    def nodes_rpm(self) -> tuple[float, ...]:
        """Speeds at which the mean torque is not smooth."""
        return self.own.nodes_rpm

    def at(self, rpm: Real) -> Real:
        """Return the mean torque of each cylinder, N m, shape (*speeds, cylinders)."""
        means = np.array(self.own.at(rpm))
        for row, other in self.others:
            means[..., row] = 0.0 if other is None else other.at(rpm)[..., row]
        return means

    def replace_cylinder(self, row: int, other: CylinderMeans | None) -> CylinderMeans:
        """Return the means in which one cylinder has its mean torque in other ones; None: 0."""
        return self._replace(others=(*self.others, (row, other)))


def find_cylinder_means(engine: Engine) -> CylinderMeans | None:
    """Return the mean torques of the cylinders of an engine; None without gas."""
    return None if engine.gas is None else CylinderMeans(EngineMeans(engine))


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
