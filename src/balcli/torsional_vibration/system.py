"""Define a torsional system in SI units: nodes and shafts with names, damping and excitation.
Speeds and orders refer to a reference node, the crankshaft or the first node of a chain.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.phases import RPM
from ..core.phasors import Array
from ..core.vibration import Complex, Indices, Real
from ..engine.engine import NONE_SILENT, SilentCylinders
from ..errors import BalcliError
from ..file.assumed import Assumed
from ..file.doubt import Doubt
from ..forces.spectrum import GasAtSpeeds
from .chain import Chain, Damping, find_pieces, pendulum_inertia, pendulum_swing, viscous_inertia
from .means import CylinderMeans, MeanTorques
from .permitted import ShaftLimit
from .throw_stiffness import ThrowStiffness


class ViscousRing(NamedTuple):
    """A viscous damper on a node: inertia of the ring (kg m2) and damping of the oil (N m s)."""

    node: int
    inertia: float
    damping: float


class Pendulums(NamedTuple):
    """Pendulums on a node: total mass (kg), radius of the pivots (m) and length of an arm (m)."""

    node: int
    mass: float
    radius: float
    length: float


class NodeTorque(NamedTuple):
    """A torque of one order on a node, such as that of a propeller's blades.

    Attributes:
        node: Index of the node.
        own_order: Oscillations per turn of the node.
        order: Order at the reference node.
        turn: Phasor of 1 N m; None: its phase to the cylinders is not known.
        amplitude: Function that returns the amplitude, N m, at speeds, rpm.
    """

    node: int
    own_order: float
    order: float
    turn: complex | None
    amplitude: Callable[[Real], Real]

    def at(self, speeds: Real) -> Complex:
        """Return the phasors of a torque with a known phase, N m, at speeds, rad/s."""
        return np.asarray((self.turn or 0.0) * self.amplitude(speeds / RPM), complex)

    @property
    def alone(self) -> Excitation:
        """Excitation by this torque alone; its phase does not matter then."""
        known = self._replace(turn=self.turn or 1.0)
        none = np.zeros((1, 0), complex)
        nodes = np.array([self.node])
        return Excitation(np.array([self.order]), nodes, none, none, further=(known,))


class Excitation(NamedTuple):
    """Complex torques c by order n. The torque of one order is `Re(c e^{i n t})`, where t is the
    angle of the reference node.

    Attributes:
        orders: (orders,) orders, rising, above 0.
        nodes: (sources,) node on which each source acts: cylinders (or torques of a chain), then
            further torques.
        steady: (orders, cylinders) torque that does not depend on the speed, N m; if the gas
            depends on the speed, the gas torque at the engine's own speed.
        growing: (orders, cylinders) torque that is proportional to the square of the speed, divided
            by this square, kg m2.
        gas: Gas torque by cylinder as a function of the speed, which replaces `steady`; None: the
            gas torque does not depend on the speed.
        further: Further torques, whose phases are known.
        means: Mean torques of cylinders; None: they are not known.
    """

    orders: Real
    nodes: Indices
    steady: Complex
    growing: Complex
    gas: GasAtSpeeds | None = None
    further: tuple[NodeTorque, ...] = ()
    means: CylinderMeans | None = None

    def at(self, speeds: Real) -> Complex:
        """Return the torques (orders, speeds, sources), N m, at speeds (speeds,), rad/s."""
        steady = self.steady[:, None, :] if self.gas is None else self.gas.torque(speeds / RPM)
        of_cylinders = np.asarray(steady, complex)
        if np.any(self.growing):
            of_cylinders = of_cylinders + self.growing[:, None, :] * speeds[:, None] ** 2
        shape = len(self.orders), len(speeds), self.steady.shape[1]
        of_cylinders = np.broadcast_to(of_cylinders, shape)
        if not self.further:
            return of_cylinders
        of_others = np.zeros((*shape[:2], len(self.further)), complex)
        for source, torque in enumerate(self.further):
            row = np.searchsorted(self.orders, torque.order)
            of_others[row, :, source] = torque.at(speeds)
        return np.concatenate([of_cylinders, of_others], axis=-1)

    def at_own(self, speeds: Real) -> Complex:
        """Return the torques (*, orders, sources), N m, at speeds (*, orders), rad/s, of which each
        order has its own.
        """
        steady = self.steady
        if self.gas is not None:
            of_all = self.gas.torque(speeds / RPM)  # (orders, *, orders, sources)
            each = np.arange(len(self.orders))
            steady = np.moveaxis(of_all[each, ..., each, :], 0, -2)
        of_cylinders = np.asarray(steady + self.growing * speeds[..., None] ** 2, complex)
        if not self.further:
            return of_cylinders
        of_others = np.zeros((*speeds.shape, len(self.further)), complex)
        for source, torque in enumerate(self.further):
            row = np.searchsorted(self.orders, torque.order)
            of_others[..., row, source] = torque.at(speeds[..., row])
        return np.concatenate([of_cylinders, of_others], axis=-1)

    def only(self, orders: Real) -> Excitation:
        """Return the excitation restricted to some orders."""
        kept = np.isin(self.orders, orders)
        gas = None if self.gas is None else self.gas.select_orders(kept)
        further = tuple(torque for torque in self.further if torque.order in orders)
        cylinders = self.nodes[: self.steady.shape[1]]
        nodes = np.append(cylinders, [torque.node for torque in further]).astype(int)
        return self._replace(
            orders=self.orders[kept],
            nodes=nodes,
            steady=self.steady[kept],
            growing=self.growing[kept],
            gas=gas,
            further=further,
        )

    def without_idle_orders(self) -> Excitation:
        """Return the excitation without the orders in which no cylinder has a torque."""
        acts = np.any((self.growing != 0) | (self.steady != 0), axis=1)
        if self.gas is not None and self.gas.law is not None:
            acts |= np.any(self.gas.torque(self.gas.law.nodes_rpm) != 0, axis=(1, 2))
        return self.only(self.orders[acts])

    def find_gas(self, row: int, rpm: ArrayLike) -> NDArray[np.complex128]:
        """Return the gas torque of one cylinder, N m, at speeds, rpm; its shape is
        (orders, *speeds) or, if it does not depend on the speed, the same with axes of length 1.
        """
        if self.gas is not None:
            return np.asarray(self.gas.torque(rpm)[..., row])
        column = self.steady[:, row].reshape(-1, *(1,) * np.ndim(rpm))
        return np.asarray(column, complex)

    def replace_gas(
        self, row: int, other: Excitation, imep: Callable[[ArrayLike], Array]
    ) -> Excitation:
        """Return the excitation in which one cylinder has the gas that it has in another one.

        Args:
            row: Row of the cylinder.
            other: Excitation of the same orders.
            imep: Function that returns the indicated mean effective pressure, Pa, at speeds, rpm.
        """
        steady = self.steady.copy()
        steady[:, row] = other.steady[:, row]
        gas = self.gas
        if gas is not None:
            gas = gas.replace_cylinder(row, partial(other.find_gas, row))._replace(imep=imep)
        means = self.means
        if means is not None:
            means = means.replace_cylinder(row, other.means)
        return self._replace(steady=steady, gas=gas, means=means)

    def without_gas(self) -> Excitation:
        """Return the excitation by the inertia of the cylinders alone."""
        return self._replace(steady=np.zeros_like(self.steady), gas=None, means=None)

    def with_torques(self, torques: Sequence[NodeTorque]) -> Excitation:
        """Return the excitation with further torques, whose phases are known."""
        if not torques:
            return self
        orders = np.union1d(self.orders, [torque.order for torque in torques])
        rows = np.searchsorted(orders, self.orders)
        steady = np.zeros((len(orders), self.steady.shape[1]), complex)
        growing = np.zeros_like(steady)
        steady[rows] = self.steady
        growing[rows] = self.growing
        gas = None if self.gas is None else self.gas.spread_orders(rows, len(orders))
        nodes = np.append(self.nodes, [torque.node for torque in torques]).astype(int)
        further = (*self.further, *torques)
        return Excitation(orders, nodes, steady, growing, gas, further, self.means)


@dataclass(frozen=True)
class TorsionalSystem:
    """Nodes, shafts, damping and excitation.

    Attributes:
        name: Name of the engine or chain; may be empty.
        nodes: Names of the nodes, front to rear.
        shafts: Names of the chain's shafts.
        chain: Inertias and shafts, including rubber rings.
        damping: Losses of shafts and nodes.
        stress_by_torque: (shafts,) shear stress at the surface for 1 N m, Pa; 0 without a diameter.
        sections: Outer and inner diameter of each shaft, m; 0 where they are not given.
        lengths: Length of each plain shaft, m; 0 where the stiffness is given.
        rings: Viscous dampers, which are not nodes of the chain.
        pendulums: Pendulums, which are not nodes of the chain.
        excitation: Torques by order; None: no excitation.
        torques: Torques of [[torsion.excitation]]; those with a known phase are part of the
            excitation, too.
        means: Mean torques of shafts; None: they are not known.
        unknown_stress: Indices of shafts with a stress limit, but without a diameter.
        limits: Limits of stress and torque, in the order of the shafts, stress first; then that of
            the free end's swing.
        angle_limit: Half swing of the free end, rad, above which a speed is barred.
        last: Index of the last node that is not a rubber ring.
        ends: Indices of the nodes at the free end and at the rear end, without branches.
        doubts: Warnings of unlikely figures.
        reference: Index of the node to which speeds and orders refer.
        rated_rpm: Speed in the file; None if it gives none.
        silent: Cylinders of the engine that do not fire.
        throw: Stiffness of the throws from their dimensions; None without dimensions.
        assumed: Values assumed because the file leaves them out.
        file: Name of the file, for messages; may be empty.
    """

    name: str
    nodes: tuple[str, ...]
    shafts: tuple[str, ...]
    chain: Chain
    damping: Damping
    stress_by_torque: Real
    sections: tuple[tuple[float, float], ...] = ()
    lengths: tuple[float, ...] = ()
    rings: tuple[ViscousRing, ...] = ()
    pendulums: tuple[Pendulums, ...] = ()
    excitation: Excitation | None = None
    torques: tuple[NodeTorque, ...] = ()
    means: MeanTorques | None = None
    angle_limit: float | None = None
    unknown_stress: tuple[int, ...] = ()
    limits: tuple[ShaftLimit, ...] = ()
    last: int = -1
    ends: tuple[int, int] = (0, -1)
    doubts: tuple[Doubt, ...] = ()
    rated_rpm: float | None = None
    reference: int = 0
    silent: SilentCylinders = NONE_SILENT
    throw: ThrowStiffness | None = None
    assumed: tuple[Assumed, ...] = ()
    file: str = ""

    @cached_property
    def unphased(self) -> tuple[Excitation, ...]:
        """Torques whose phase to the cylinders is not known, each by itself."""
        return tuple(torque.alone for torque in self.torques if torque.turn is None)

    @property
    def every_order(self) -> Real:
        """All orders, rising, shape (orders,): those of the excitation and of torques without a
        known phase.
        """
        orders = self.require_excitation().orders
        if not self.unphased:
            return orders
        return np.union1d(orders, np.concatenate([own.orders for own in self.unphased]))

    def require_excitation(self) -> Excitation:
        """Return the excitation.

        Raises:
            BalcliError: The system has no excitation, or none at the requested orders.
        """
        if self.excitation is None:
            wanted = "give an [[excitation]] with node, order and cos"
            raise BalcliError(f"has no excitation; {wanted}").within(self.file)
        if not len(self.excitation.orders) and not self.unphased:
            raise BalcliError("has no excitation at the requested orders").within(self.file)
        return self.excitation

    @property
    def rubber_rings(self) -> int:
        """Number of rubber rings, which are the last nodes and hang on the last shafts."""
        return len(self.nodes) - 1 - self.last

    @property
    def checkable(self) -> frozenset[int]:
        """Indices of the shafts that a limit may judge: elastic, and not the rubber of a ring."""
        first_ring = len(self.shafts) - self.rubber_rings
        elastic = np.flatnonzero(np.isfinite(self.chain.stiffness)).tolist()
        return frozenset(shaft for shaft in elastic if shaft < first_ring)

    @property
    def without_diameter(self) -> frozenset[int]:
        """Indices of the shafts with a stress limit whose stress is not known."""
        return frozenset(self.unknown_stress)

    @property
    def free_end(self) -> str:
        """Name of the node at the free end."""
        return self.nodes[self.ends[0]]

    @cached_property
    def gears(self) -> Real:
        """Speed of each node over the speed of the reference, if the two are connected; shape
        (nodes,).
        """
        pace = find_pieces(self.chain).pace
        return np.asarray(pace / pace[self.reference])

    def attached_rings(self, frequency: Real) -> Complex:
        """Return the complex inertias, kg m2, that viscous rings add to nodes at frequencies
        (rad/s), shape (*frequency, nodes), or (nodes,) without rings.
        """
        if not self.rings:
            return np.zeros(len(self.nodes), complex)
        inertia = np.zeros((*frequency.shape, len(self.nodes)), complex)
        for ring in self.rings:
            inertia[..., ring.node] += viscous_inertia(ring.inertia, ring.damping, frequency)
        return inertia

    def attached_pendulums(self, order: Real) -> Complex:
        """Return the inertias, kg m2, that pendulums add to nodes at orders of the reference node,
        shape (*order, nodes), or (nodes,) without pendulums.
        """
        if not self.pendulums:
            return np.zeros(len(self.nodes), complex)
        inertia = np.zeros((*order.shape, len(self.nodes)), complex)
        for swung in self.pendulums:
            own = order / self.gears[swung.node]
            inertia[..., swung.node] += pendulum_inertia(
                swung.mass, swung.radius, swung.length, own
            )
        return inertia

    def swing_pendulums(self, orders: Real, angle: Complex) -> Complex:
        """Return the angles of pendulums relative to their nodes, shape (orders, speeds,
        pendulums), for angles of nodes (orders, speeds, nodes) at orders (orders,) of the
        reference node.
        """
        angles = [angle[..., :0]]
        for swung in self.pendulums:
            ratio = pendulum_swing(swung.radius, swung.length, orders / self.gears[swung.node])
            angles.append((ratio[:, None] * angle[..., swung.node])[..., None])
        return np.concatenate(angles, axis=-1)
