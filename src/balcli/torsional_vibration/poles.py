"""Compute the poles of a damped torsional system, and its forced vibration as a sum over them.

The equations of motion are `B z' = A z + g`, where the vector z has all angles and speeds, g is the
load, and A and B are constant matrices. Let mu be the eigenvalues and V the eigenvectors of `(A -
sigma B)^-1 B`, where sigma is any number that is not a pole. The poles are then `s = sigma + 1/mu`,
and a load `g e^{s t}` causes the vibration

    z = -V (1 - (s - sigma) mu)^-1 V^-1 (A - sigma B)^-1 g

Massless nodes have mu = 0 and no pole. Angles are in rad; the equations are divided by the largest
stiffness, and their unit of time makes frequencies about 1.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.phases import RPM
from ..core.vibration import UNDAMPED, Complex, Indices, Real
from .chain import (
    Chain,
    ChainShaft,
    Damping,
    follow_gears,
    incidence,
    join_chain,
    rigid_motions,
)
from .system import Excitation, TorsionalSystem

# Shift of the eigenvalues; a pole here would be a motion that grows, which only pendulums can make,
# and hardly at such a number. It is real because real equations, those without loss factors, take
# a quarter of the time.
_SIGMA = 0.836
_HELD = -0.25  # stiffness of a motion that turns freely: its poles 0.5 and -0.5 are no _SIGMA
_INFINITE = 1e-6  # eigenvalues mu below this share of the largest count as 0: they have no pole
# Eigenvectors with a larger condition number, of poles that almost coincide, lose too many digits.
_ILL = 1e7
_MOST = 128  # terms; the tree of nodes takes less time than the eigenvectors of more poles
_SLOW = 1e-6  # poles with a lower frequency do not swing
_AT_ONCE = 1 << 14  # number of terms that are computed at once: more leave the cache


class _Equations(NamedTuple):
    """Equations of motion, divided by a stiffness and with a unit of time.

    Attributes:
        chain: Chain, with viscous rings as its last nodes.
        damping: Damping of this chain.
        follow: (nodes, dof) angle of every node for unit angles of the independent nodes.
        twist: (shafts, dof) twist of every shaft for the same.
        stiffness: K, (dof, dof).
        damped: C, (dof, dof).
        mass: M, (dof, dof).
        scale: Stiffness by which the equations are divided, N m/rad; 0: no shaft is elastic.
        unit: Frequency that counts as 1, rad/s.
    """

    chain: Chain
    damping: Damping
    follow: Real
    twist: Real
    stiffness: Complex | Real
    damped: Real
    mass: Real
    scale: float
    unit: float

    def shift(self) -> tuple[Complex | Real, Real]:
        """Return the matrices `A - sigma B` and B."""
        identity = np.eye(len(self.mass))
        none = np.zeros_like(identity)
        below = -self.damped - _SIGMA * self.mass
        shifted = np.block([[-_SIGMA * identity, identity], [-self.stiffness, below]])
        return shifted, np.block([[identity, none], [none, self.mass]])

    def list_free_turns(self) -> Real:
        """Return the rigid motions (motions, dof) that nothing holds, springs or dampers."""
        held = self.chain.stiffness + self.damping.dashpots
        turns = rigid_motions(self.chain._replace(stiffness=held))
        free = turns**2 @ self.damping.nodes == 0
        _, independent = follow_gears(self.chain)
        return np.asarray(turns[free][:, independent])


def _write_equations(chain: Chain, damping: Damping) -> _Equations:
    follow, _ = follow_gears(chain)
    twist = incidence(chain) @ follow
    bends = np.isfinite(chain.stiffness)
    stretched = twist[bends]
    stiffness = chain.stiffness[bends]
    if np.any(damping.loss):
        stiffness = stiffness * (1 + 1j * damping.loss[bends])
    k: Complex | Real = (stretched.T * stiffness) @ stretched
    c = (stretched.T * damping.dashpots[bends]) @ stretched + (follow.T * damping.nodes) @ follow
    m = (follow.T * chain.inertia) @ follow
    scale = float(np.abs(k).max(initial=0.0))
    unit = 1.0
    if scale:
        unit = float(np.sqrt(scale / np.median(np.abs(np.diag(m)[np.diag(m) != 0]))))
        k = k / scale
        c = c * (unit / scale)
        m = m * (unit**2 / scale)
    return _Equations(chain, damping, follow, twist, k, c, m, scale, unit)


def find_chain_poles(chain: Chain, damping: Damping) -> Complex:
    """Return the poles (poles,) of the damped chain, rad/s: the s of free vibrations `x e^{s t}`. A
    pole s is a resonance at the frequency `Im s` with a half-power width of `-2 Re s`. With loss
    factors of shafts, only poles with `Im s > 0` have a meaning.
    """
    equations = _write_equations(chain, damping)
    if not equations.scale:
        return np.zeros(0, complex)
    mu = np.linalg.eigvals(np.linalg.solve(*equations.shift()))
    return _find_finite(mu, equations.unit)


def _find_finite(mu: Complex, unit: float) -> Complex:
    finite = np.abs(mu) > _INFINITE * np.abs(mu).max()
    return np.asarray(unit * (_SIGMA + 1 / mu[finite]), complex)


def find_poles(system: TorsionalSystem, order: float | None = None) -> Complex:
    """Return the poles (poles,) of the damped system, rad/s (see `find_chain_poles`).

    Args:
        system: Torsional system. Each viscous ring becomes a node behind a dashpot.
        order: Order for which the inertia of pendulums is computed; None: they are left out.
    """
    return find_chain_poles(*_attach_rings(system, order))


def _attach_rings(system: TorsionalSystem, order: float | None) -> tuple[Chain, Damping]:
    """Return the chain with viscous rings as its last nodes; see `find_poles`."""
    chain = system.chain
    damping = system.damping
    rings = system.rings
    inertia = chain.inertia
    more = (0, len(rings))
    if order is not None:
        inertia = inertia + system.attached_pendulums(np.array(order)).real
    shafts = [*map(ChainShaft, chain.start, chain.end, chain.stiffness, chain.ratio)]
    shafts += [ChainShaft(ring.node, k, 0.0) for k, ring in enumerate(rings, len(inertia))]
    inertia = np.append(inertia, [ring.inertia for ring in rings])
    oil = np.append(damping.dashpots, [ring.damping for ring in rings])
    return (
        join_chain(inertia, shafts, np.flatnonzero(chain.clamped).tolist()),
        Damping(np.pad(damping.loss, more), oil, np.pad(damping.nodes, more)),
    )


class DrivenTerms(NamedTuple):
    """Sizes of terms for an excitation.

    Attributes:
        steady: (systems, orders, terms) part that does not depend on the speed.
        growing: (systems, orders, terms) part that is proportional to the square of the speed,
            divided by this square, (s/rad)^2; None: there is no such part.
        excitation: Excitation of a single system that depends on the speed in another way; it
            replaces the two parts. None: it does not.
        by_source: (sources, terms) size of each term for 1 N m of each source of this excitation.
    """

    steady: Complex
    growing: Complex | None
    excitation: Excitation | None
    by_source: Complex

    def at(self, speeds: Real, system: int | Indices) -> Complex:
        """Return the sizes of the terms at speeds (places,), rad/s, shape (places or 1, orders,
        terms).

        Args:
            speeds: Speeds.
            system: Index of the system, or (places,) of the system of each place.
        """
        if self.excitation is not None:
            torques = self.excitation.at(speeds)
            return np.asarray((torques @ self.by_source).swapaxes(0, 1))
        systems = np.atleast_1d(system)
        steady = self.steady[systems]
        if self.growing is None:
            return steady
        growing = self.growing[systems] * (speeds**2)[:, None, None]
        return np.add(growing, steady, out=growing)


@dataclass(frozen=True)
class PoleSum:
    """Torques of elastic shafts and the swing of the free end as sums of terms: one for each pole,
    and one for each rigid motion that nothing holds. The systems are one or more variants of a
    system, whose terms have the same meaning.

    The sums take a fraction of the time of `compute_curves` for some curves, or if each speed asks
    for another curve. They lose some digits where poles almost coincide.

    Attributes:
        poles: Poles of each system, rad/s.
        orders: (orders,) orders of the excitation.
        spanned: (curves,) whether a curve is such a sum in all systems; rigid shafts are not.
        unit: (systems,) frequency that counts as 1, rad/s.
        mu: (systems, poles) eigenvalues.
        driven: Size of each term for the excitation.
        of_nodes: (systems, terms, nodes) size of each term for 1 N m on each node.
        felt: (systems, curves, terms) share of each term in each twist, and in the angle of the
            free end.
        stiffness: (systems, curves) factor of this twist or angle, N m/rad.
        dashpots: (systems, curves) factor of its rate, N m s/rad.
    """

    poles: tuple[Complex, ...]
    orders: Real
    spanned: NDArray[np.bool_]
    unit: Real
    mu: Complex
    driven: DrivenTerms
    of_nodes: Complex
    felt: Complex
    stiffness: Complex
    dashpots: Real

    def can_join(self, other: PoleSum) -> bool:
        """Return whether the sums of both systems can be computed as one."""
        mine = self.driven
        others = other.driven
        return (
            mine.excitation is None
            and others.excitation is None
            and (mine.growing is None) == (others.growing is None)
            and self.mu.shape[1:] == other.mu.shape[1:]
            and self.felt.shape[1:] == other.felt.shape[1:]
            and np.array_equal(self.orders, other.orders)
            and np.array_equal(self.spanned, other.spanned)
        )

    def drive(self, excitation: Excitation) -> PoleSum:
        """Return the sums of a single system for another excitation."""
        driven = _drive_terms(self.of_nodes, excitation)
        return replace(self, orders=excitation.orders, driven=driven)

    def find_curves(self, rpm: Real, system: Indices, which: Indices) -> Complex:
        """Return phasors (orders, places) at speeds (places,), each of the system and the curve
        that the other two arguments name by their indices.
        """
        curves = np.empty((len(rpm), len(self.orders)), complex)
        several = len(self.mu) > 1
        for some in self._divide(len(rpm)):
            own = system[some] if several else 0
            w, terms = self._respond(rpm[some], own)
            named = system[some], which[some]
            twist = (terms @ self.felt[named][..., None])[..., 0]
            stiffness = self.stiffness[named][:, None]
            curves[some] = twist * (stiffness + 1j * w * self.dashpots[named][:, None])
        return curves.T

    def sum_amplitudes(self, rpm: Real, which: Indices, system: int = 0) -> Real:
        """Return the sums of the amplitudes of all orders, shape (speeds, len(which))."""
        sums = np.empty((len(rpm), len(which)))
        felt = self.felt[system, which].T
        stiffness = self.stiffness[system, which]
        dashpots = self.dashpots[system, which]
        for some in self._divide(len(rpm)):
            w, terms = self._respond(rpm[some], system)
            curves = terms @ felt
            curves *= stiffness + 1j * w[..., None] * dashpots
            sums[some] = np.abs(curves).sum(axis=1)
        return sums

    def _divide(self, count: int) -> Iterator[slice]:
        """Yield consecutive parts of this number of places, few enough to be computed at once."""
        terms = len(self.orders) * self.felt.shape[-1]
        step = max(_AT_ONCE // max(terms, 1), 1)  # without a phase there may be no order at all
        for start in range(0, count, step):
            yield slice(start, start + step)

    def _respond(self, rpm: Real, system: int | Indices) -> tuple[Real, Complex]:
        """Return frequencies (places, orders), rad/s, and the terms (places, orders, terms)."""
        speeds = rpm * RPM
        w = np.multiply.outer(speeds, self.orders)
        paced = w / self.unit[system, None]
        mu = self.mu[system][..., None, :]
        terms = np.empty((*w.shape, self.felt.shape[-1]), complex)
        poles = self.mu.shape[-1]
        of_poles = terms[..., :poles]
        np.multiply(paced[..., None], 1j * mu, out=of_poles)
        of_poles -= 1 + _SIGMA * mu
        np.reciprocal(of_poles, out=of_poles)
        if terms.shape[-1] > poles:
            paced_twice = paced**2
            of_turns = 1 / (paced_twice - _HELD) - 1 / paced_twice
            terms[..., poles:] = of_turns[..., None]
        terms *= self.driven.at(speeds, system)
        return w, terms


def expand_in_poles(system: TorsionalSystem) -> PoleSum | None:
    """Return the torques of a system as sums over its poles; None if there is no such sum, because
    pendulums make the poles depend on the order, or poles almost coincide, or nothing damps some;
    None also if there are too many.

    A motion that turns freely has a double pole at 0, with a single eigenvector. No shaft twists in
    it, so it gets a stiffness of its own, `_HELD`, without any effect on torques. The difference of
    the angles of the free end, without and with this stiffness, is a term of its own.
    """
    if system.pendulums or len(system.nodes) + len(system.rings) > _MOST // 2:
        return None
    equations = _write_equations(*_attach_rings(system, None))
    if not equations.scale:
        return None
    turns = equations.list_free_turns()
    moved = turns @ equations.mass
    weights = np.sum(moved * turns, axis=1)
    held = _HELD * (moved.T / weights) @ moved
    shifted, second = equations._replace(stiffness=equations.stiffness + held).shift()
    mu, vectors = np.linalg.eig(np.linalg.solve(shifted, second))
    try:
        inverse = np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        return None
    poles = _find_finite(mu, equations.unit)
    swinging = poles.imag > _SLOW * equations.unit
    undamped = swinging & (-poles.real <= UNDAMPED * np.abs(poles))
    if np.any(undamped) or np.linalg.norm(vectors) * np.linalg.norm(inverse) > _ILL:
        return None
    dof = len(equations.mass)
    by_torque = np.linalg.solve(shifted.T, inverse.T).T[:, dof:]
    driven = np.concatenate([by_torque, turns / weights[:, None]]) @ equations.follow.T
    shafts = len(system.shafts)
    seen = np.concatenate([equations.twist[:shafts], equations.follow[[system.ends[0]]]])
    felt = np.concatenate([vectors[:dof].T @ seen.T, turns @ seen.T])
    elastic = np.isfinite(system.chain.stiffness)
    stiffness = np.where(elastic, system.chain.stiffness, 0) * (1 + 1j * system.damping.loss)
    of_nodes = np.asarray(driven / equations.scale, complex)
    excitation = system.require_excitation()
    return PoleSum(
        poles=(poles,),
        orders=excitation.orders,
        spanned=np.append(elastic, True),
        unit=np.array([equations.unit]),
        mu=mu[None],
        driven=_drive_terms(of_nodes[None], excitation),
        of_nodes=of_nodes[None],
        felt=np.ascontiguousarray(felt.T, complex)[None],
        stiffness=np.append(stiffness, 1)[None],
        dashpots=np.append(system.damping.dashpots, 0)[None],
    )


def _drive_terms(of_nodes: Complex, excitation: Excitation) -> DrivenTerms:
    """Return the sizes of the terms of a single system for an excitation."""
    by_source = of_nodes[0][:, excitation.nodes].T
    if excitation.gas is not None or excitation.further:
        none = np.zeros((1, 0, len(by_source)), complex)
        return DrivenTerms(none, None, excitation, by_source)
    steady = excitation.steady @ by_source
    growing = excitation.growing @ by_source if np.any(excitation.growing) else None
    return DrivenTerms(steady[None], None if growing is None else growing[None], None, by_source)


def join_sums(sums: Sequence[PoleSum | None]) -> PoleSum | None:
    """Return the sums of several variants of a system as one; None if there are none, or if their
    terms differ.
    """
    known = [own for own in sums if own is not None]
    if len(known) < len(sums):
        return None
    first, *others = known
    if not others:
        return first
    if not all(first.can_join(own) for own in known):
        return None
    growing = [own.driven.growing for own in known if own.driven.growing is not None]
    driven = first.driven._replace(
        steady=np.concatenate([own.driven.steady for own in known]),
        growing=np.concatenate(growing) if growing else None,
    )
    return PoleSum(
        poles=tuple(poles for own in known for poles in own.poles),
        orders=first.orders,
        spanned=first.spanned,
        unit=np.concatenate([own.unit for own in known]),
        mu=np.concatenate([own.mu for own in known]),
        driven=driven,
        of_nodes=np.concatenate([own.of_nodes for own in known]),
        felt=np.concatenate([own.felt for own in known]),
        stiffness=np.concatenate([own.stiffness for own in known]),
        dashpots=np.concatenate([own.dashpots for own in known]),
    )
