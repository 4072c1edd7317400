"""Compute the poles of a damped torsional system, and its forced vibration as a sum over them.

The equations of motion are `B z' = A z + g`, where the vector z has all angles and speeds, g is the
load, and A and B are constant matrices. Let mu be the eigenvalues and V the eigenvectors of `(A -
sigma B)^-1 B`, where sigma is any number that is not a pole. The poles are then `s = sigma + 1/mu`,
and a load `g e^{s t}` causes the vibration

    z = -V (1 - (s - sigma) mu)^-1 V^-1 (A - sigma B)^-1 g

where each factor `-1/(1 - (s - sigma) mu)` is `1/(mu (s - p))` with the pole `p = sigma + 1/mu`.
Massless nodes have mu = 0, an infinite pole and the factor -1. Angles are in rad; the equations are
divided by the largest stiffness, and their unit of time makes frequencies about 1.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.phases import RPM
from ..core.phasors import compose
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
_INFINITE = 1e-6  # eigenvalues mu below this share of the largest: no resonance is that high
_MASSLESS = 1e-14  # eigenvalues mu below this share of the largest are 0 but for rounding
# Eigenvectors with a larger condition number, of poles that almost coincide, lose too many digits.
_ILL = 1e7
_MOST = 128  # terms; the tree of nodes takes less time than the eigenvectors of more poles
_SLOW = 1e-6  # poles with a lower frequency do not swing
_AT_ONCE = 1 << 17  # number of values that are computed at once: more leave the cache


class _Equations(NamedTuple):
    """Equations of motion, divided by a stiffness and with a unit of time.

    Attributes:
        chain: Chain, with viscous rings as its last nodes.
        damping: Damping of this chain.
        follow: (nodes, dof) angle of every node for unit angles of the independent nodes.
        independent: (dof,) indices of the independent nodes.
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
    independent: Indices
    twist: Real
    stiffness: Complex | Real
    damped: Real
    mass: Real
    scale: float
    unit: float

    def shift(self) -> tuple[NDArray[np.inexact], Real]:
        """Return the matrices `A - sigma B` and B."""
        dof = len(self.mass)
        angles = np.arange(dof)
        speeds = angles + dof
        shifted = np.zeros_like(self.stiffness, shape=(2 * dof, 2 * dof))
        shifted[angles, angles] = -_SIGMA
        shifted[angles, speeds] = 1
        shifted[dof:, :dof] = -self.stiffness
        shifted[dof:, dof:] = -self.damped - _SIGMA * self.mass
        second = np.zeros((2 * dof, 2 * dof))
        second[angles, angles] = 1
        second[dof:, dof:] = self.mass
        return shifted, second

    def list_free_turns(self) -> Real:
        """Return the rigid motions (motions, dof) that nothing holds, springs or dampers."""
        held = self.chain.stiffness + self.damping.dashpots
        turns = rigid_motions(self.chain._replace(stiffness=held))
        free = turns**2 @ self.damping.nodes == 0
        return np.asarray(turns[free][:, self.independent])


def _write_equations(chain: Chain, damping: Damping) -> _Equations:
    follow, independent = follow_gears(chain)
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
    return _Equations(chain, damping, follow, independent, twist, k, c, m, scale, unit)


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
    if not rings and not system.pendulums:
        return chain, damping
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
    """Sizes of terms for an excitation, as a sum over inputs. Without an `excitation`, the inputs
    are 1 and the square of the speed (rad/s); with it, they are the torques of its sources.

    Attributes:
        sizes: (orders or 1, inputs, terms) size of each term for 1 unit of each input.
        excitation: Excitation that depends on the speed in its own way; None: it does not.
    """

    sizes: Complex
    excitation: Excitation | None

    def add_inputs(self, parts: Real, speeds: Real) -> Complex:
        """Return the sum over inputs (orders, curves, places) at speeds (places,), rad/s.

        Args:
            parts: Real and imaginary part for 1 unit of each input, shape (orders, curves, inputs,
                2, places).
            speeds: Speeds.
        """
        if self.excitation is not None:
            torques = self.excitation.at(speeds).swapaxes(1, 2)
            by_input = compose(parts[..., 0, :], parts[..., 1, :]) * torques[:, None]
            return np.asarray(by_input.sum(axis=2))
        steady = parts[:, :, 0]
        if parts.shape[2] > 1:
            steady = steady + parts[:, :, 1] * speeds**2
        return compose(steady[..., 0, :], steady[..., 1, :])


@dataclass(frozen=True)
class PoleSum:
    """Torques of elastic shafts and the swing of the free end as sums over poles.

    Each sum has a term `1/(i w - p)` for each finite pole p, the same constant for all infinite
    poles, and the same function of w for all rigid motions that nothing holds. Written in real
    numbers, with p = a + i b and d = w - b, the term is `-(a + i d)/(a^2 + d^2)`. So real functions
    of the frequency, which all curves share, are multiplied by constant weights.

    The sums take a fraction of the time of `compute_curves` for some curves, or if each speed asks
    for another curve. They lose some digits where poles almost coincide.

    Attributes:
        poles: (poles,) finite poles, rad/s.
        orders: (orders,) orders of the excitation.
        spanned: (curves,) whether a curve is such a sum; torques of rigid shafts are not.
        unit: Frequency that counts as 1, rad/s.
        driven: Size of each term for the excitation: finite poles, infinite poles, rigid motions.
        of_nodes: (terms, nodes) size of each term for 1 N m on each node.
        felt: (curves, terms) share of each term in each twist, and in the angle of the free end.
        infinite: Number of infinite poles.
        stiffness: (curves,) factor of this twist or angle, N m/rad.
        dashpots: (curves,) factor of its rate, N m s/rad.
        weights: Weights of the curves that were asked for so far; see `_weigh`.
    """

    poles: Complex
    orders: Real
    spanned: NDArray[np.bool_]
    unit: float
    driven: DrivenTerms
    of_nodes: Complex
    felt: Complex
    infinite: int
    stiffness: Complex
    dashpots: Real
    weights: dict[int, Real] = field(default_factory=dict, repr=False)

    def drive(self, excitation: Excitation) -> PoleSum:
        """Return the sums for another excitation."""
        driven = _drive_terms(self.of_nodes, excitation)
        return replace(self, orders=excitation.orders, driven=driven, weights={})

    def find_curves(self, rpm: Real, which: Indices) -> Complex:
        """Return phasors (orders, places) at speeds (places,), each of the curve in `which`."""
        curves = np.empty((len(self.orders), len(rpm)), complex)
        by_curve = np.argsort(which, kind="stable")
        for some in self._divide(len(rpm)):
            places = by_curve[some]
            speeds = rpm[places] * RPM
            functions = self._find_functions(speeds)
            asked, starts = np.unique(which[places], return_index=True)
            for curve, start, end in zip(asked, starts, [*starts[1:], len(places)], strict=True):
                own = slice(start, end)
                terms = self._add_terms(functions[..., own], speeds[own], [int(curve)])
                curves[:, places[own]] = terms[:, 0]
        return curves

    def sum_amplitudes(self, rpm: Real, which: Indices) -> Real:
        """Return the sums of the amplitudes of all orders, shape (speeds, len(which))."""
        sums = np.empty((len(rpm), len(which)))
        for some in self._divide(len(rpm)):
            speeds = rpm[some] * RPM
            curves = self._add_terms(self._find_functions(speeds), speeds, which.tolist())
            sums[some] = np.abs(curves).sum(axis=0).T
        return sums

    def _divide(self, count: int) -> Iterator[slice]:
        """Yield consecutive parts of this number of places, few enough to be computed at once."""
        values = len(self.orders) * (2 * len(self.poles) + 2)
        step = max(_AT_ONCE // max(values, 1), 1)  # without a phase there may be no order at all
        for start in range(0, count, step):
            yield slice(start, start + step)

    def _find_functions(self, speeds: Real) -> Real:
        """Return the functions of the frequency (functions, orders, places) at speeds (places,),
        rad/s: `1/(a^2 + d^2)` and `d/(a^2 + d^2)` of each finite pole, 1, and the function of the
        rigid motions.
        """
        poles = self.poles[:, None] / self.unit
        count = len(poles)
        w = np.multiply.outer(self.orders, speeds / self.unit).ravel()
        functions = np.empty((2 * count + 2, len(w)))
        inverse = functions[:count]
        away = functions[count : 2 * count]
        np.subtract(w, poles.imag, out=away)
        np.multiply(away, away, out=inverse)
        inverse += poles.real**2
        np.reciprocal(inverse, out=inverse)
        away *= inverse
        functions[-2] = 1
        functions[-1] = 1 / (w**2 - _HELD) - 1 / w**2
        return functions.reshape(len(functions), len(self.orders), len(speeds))

    def _weigh(self, curve: int) -> Real:
        """Return the weights of the functions for a curve, shape (orders or 1, inputs x 2,
        functions): for each input, those of the real and of the imaginary part.
        """
        if curve not in self.weights:
            terms = self.driven.sizes * self.felt[curve]
            poles = self.poles / self.unit
            finite = terms[..., : len(poles)]
            infinite = terms[..., len(poles) : len(poles) + self.infinite]
            turns = terms[..., len(poles) + self.infinite :]
            one_each = [part.sum(axis=-1, keepdims=True) for part in (infinite, turns)]
            weights = np.concatenate([-poles.real * finite, -1j * finite, *one_each], axis=-1)
            both = np.stack([weights.real, weights.imag], axis=2)
            self.weights[curve] = both.reshape(len(both), 2 * both.shape[1], both.shape[-1])
        return self.weights[curve]

    def _add_terms(self, functions: Real, speeds: Real, curves: Sequence[int]) -> Complex:
        """Return phasors (orders, len(curves), places) at speeds (places,), rad/s."""
        weights = np.concatenate([self._weigh(curve) for curve in curves], axis=1)
        parts = weights @ functions.swapaxes(0, 1)
        inputs = self.driven.sizes.shape[1]
        parts = parts.reshape(len(self.orders), len(curves), inputs, 2, len(speeds))
        twist = self.driven.add_inputs(parts, speeds)
        stiffness = self.stiffness[curves, None]
        rate = self.dashpots[curves, None] * np.multiply.outer(self.orders, speeds)[:, None]
        twist *= compose(stiffness.real, stiffness.imag + rate)
        return twist


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
    finite = np.abs(mu) > _MASSLESS * np.abs(mu).max()
    poles = equations.unit * (_SIGMA + 1 / mu[finite])
    swinging = poles.imag > _SLOW * equations.unit
    undamped = swinging & (-poles.real <= UNDAMPED * np.abs(poles))
    with np.errstate(over="ignore"):
        condition = np.linalg.norm(vectors) * np.linalg.norm(inverse)  # inf if they coincide
    if np.any(undamped) or not condition <= _ILL:
        return None
    dof = len(equations.mass)
    by_torque = np.linalg.solve(shifted.T, inverse.T).T[:, dof:]
    of_finite = by_torque[finite] / mu[finite, None]
    of_turns = turns / weights[:, None]
    driven = np.concatenate([of_finite, -by_torque[~finite], of_turns]) @ equations.follow.T
    shafts = len(system.shafts)
    seen = np.concatenate([equations.twist[:shafts], equations.follow[[system.ends[0]]]])
    by_pole = vectors[:dof].T @ seen.T
    felt = np.concatenate([by_pole[finite], by_pole[~finite], turns @ seen.T])
    elastic = np.isfinite(system.chain.stiffness)
    stiffness = np.where(elastic, system.chain.stiffness, 0) * (1 + 1j * system.damping.loss)
    of_nodes = np.asarray(driven / equations.scale, complex)
    excitation = system.require_excitation()
    return PoleSum(
        poles=poles,
        orders=excitation.orders,
        spanned=np.append(elastic, True),
        unit=equations.unit,
        driven=_drive_terms(of_nodes, excitation),
        of_nodes=of_nodes,
        felt=np.ascontiguousarray(felt.T, complex),
        infinite=int(np.count_nonzero(~finite)),
        stiffness=np.append(stiffness, 1),
        dashpots=np.append(system.damping.dashpots, 0),
    )


def _drive_terms(of_nodes: Complex, excitation: Excitation) -> DrivenTerms:
    """Return the sizes of the terms for an excitation."""
    by_source = of_nodes[:, excitation.nodes].T
    if excitation.gas is not None or excitation.further:
        return DrivenTerms(by_source[None], excitation)
    inputs = [excitation.steady @ by_source]
    if np.any(excitation.growing):
        inputs.append(excitation.growing @ by_source)
    return DrivenTerms(np.stack(inputs, axis=1), None)
