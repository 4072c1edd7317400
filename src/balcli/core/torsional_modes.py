"""Natural modes of torsional chains, and what they say about excitation and loss."""

from __future__ import annotations

import numpy as np

from .torsional_chain import (
    Chain,
    Damping,
    find_still,
    follow_gears,
    incidence,
    rigid_motions,
)
from .vibration import Complex, Indices, Modes, Real, find_modes

_AT_REST = 1e-9  # a node that moves less than this share of the largest counts as at rest
_SIGMA = np.exp(0.25j * np.pi)  # where no pole can be: off both axes, and it would grow
_INFINITE = 1e-6  # share of the largest: eigenvalues below are a double 0, but for rounding


def find_chain_modes(chain: Chain) -> Modes:
    """Natural modes with shapes (modes, nodes), of unit modal mass; each frequency is good to about
    1e-15 of itself, a rigid motion has exactly 0. Massless nodes add no mode.
    """
    follow, independent = follow_gears(chain)
    mass = chain.inertia @ follow**2
    elastic = np.isfinite(chain.stiffness) & (chain.stiffness > 0)
    heavy = mass > 0
    springs, stiffness, carried = _condense(
        (incidence(chain) @ follow)[elastic], chain.stiffness[elastic], np.flatnonzero(~heavy)
    )
    rigid = rigid_motions(chain)[:, independent][:, heavy]
    modes = find_modes(springs[:, heavy], stiffness, mass[heavy], rigid)
    shapes = np.zeros((len(modes.omega), len(mass)))
    shapes[:, heavy] = modes.shapes
    for dof, by_others in reversed(carried):
        shapes[:, dof] = shapes @ by_others
    return Modes(modes.omega, shapes @ follow.T, modes.rigid)


def _condense(
    springs: Real, stiffness: Real, massless: Indices
) -> tuple[Real, Real, list[tuple[int, Real]]]:
    """Springs (springs, dof) and stiffness (springs,) without the massless degrees of freedom, and
    how each of those follows the ones that are left after it: (dof, (dof,)).

    A star of springs k_i that meet becomes a spring `k_i k_j/sum k` between any two of its ends
    (Lagrange's identity): sums of positive terms alone, so that nothing cancels.
    """
    carried = []
    for dof in massless.tolist():
        meet = springs[:, dof] != 0
        a, k, ends = springs[meet, dof], stiffness[meet], springs[meet].copy()
        ends[:, dof] = 0
        total = (k * a) @ a
        carried.append((dof, -(k * a) @ ends / total))
        i, j = np.triu_indices(len(a), 1)
        between = a[j, None] * ends[i] - a[i, None] * ends[j]
        springs = np.concatenate([springs[~meet], between])
        stiffness = np.concatenate([stiffness[~meet], k[i] * k[j] / total])
    return springs, stiffness, carried


def chain_loss(
    chain: Chain, damping: Damping, modes: Modes, attached: Complex | float = 0.0
) -> Real:
    """Loss factor (modes,) of every mode, energy lost in a cycle over 2 pi times the energy that
    swings; rigid modes have 0.

    Args:
        attached: complex inertias (modes, nodes) of dampers at the modes' own frequencies, or one
            that broadcasts.
    """
    elastic = np.isfinite(chain.stiffness)
    twist = (modes.shapes @ incidence(chain)[elastic].T) ** 2
    moved = modes.shapes**2
    loss = chain.stiffness[elastic] * damping.loss[elastic]
    lost = twist @ loss - modes.omega**2 * np.sum(
        np.asarray(attached, complex).imag * moved, axis=1
    )
    lost += modes.omega * (twist @ damping.dashpots[elastic] + moved @ damping.nodes)
    return np.where(modes.omega > 0, lost / np.where(modes.omega > 0, modes.omega, 1) ** 2, 0)


def locate_nodes(chain: Chain, shape: Real) -> tuple[Indices, Indices]:
    """Return where the nodes of a mode lie: shafts whose ends turn against each other, and nodes of
    the chain at rest between others that turn against each other.

    Args:
        chain: Inertias and shafts.
        shape: (nodes,) angle of each node.
    """
    moves = np.abs(shape) > _AT_REST * np.abs(shape).max()
    ahead = np.where(moves, np.sign(shape), 0)
    across = ahead[chain.start] * ahead[chain.end] * np.sign(chain.ratio)
    pulled = np.zeros((2, len(shape)), bool)  # one way and the other
    for here, there in ((chain.start, chain.end), (chain.end, chain.start)):
        way = ahead[there] * np.sign(chain.ratio)
        pulled[0, here[way > 0]] = pulled[1, here[way < 0]] = True
    at_rest = pulled.all(axis=0) & ~moves & ~find_still(chain)
    return np.flatnonzero((across < 0) & np.isfinite(chain.stiffness)), np.flatnonzero(at_rest)


def find_chain_poles(chain: Chain, damping: Damping) -> Complex:
    """Poles (poles,) of the damped chain, rad/s: where its vibration `x e^{s t}` needs no load. One
    at `s` is a resonance about the frequency `Im s`, `-2 Re s` wide between half powers. Only those
    with `Im s > 0` mean anything where shafts have loss factors.

    They are `s = sigma + 1/mu` of the eigenvalues mu of `(A - sigma B)^-1 B`, with the equations of
    motion `A z = s B z` of angles and speeds z: massless nodes have mu = 0, and no pole.
    """
    follow, _ = follow_gears(chain)
    bends = np.isfinite(chain.stiffness)
    twist = (incidence(chain) @ follow)[bends]
    stiffness = chain.stiffness[bends] * (1 + 1j * damping.loss[bends])
    k = (twist.T * stiffness) @ twist
    c = (twist.T * damping.dashpots[bends]) @ twist + (follow.T * damping.nodes) @ follow
    m = (follow.T * chain.inertia) @ follow
    scale = np.abs(k).max(initial=0.0)
    if not scale:
        return np.zeros(0, complex)
    unit = np.sqrt(scale / np.median(np.abs(np.diag(m)[np.diag(m) != 0])))  # rad/s
    k, c, m = k / scale, c * (unit / scale), m * (unit**2 / scale)
    one, none = np.eye(len(m)), np.zeros_like(m)
    shifted = np.block([[-_SIGMA * one, one], [-k, -c - _SIGMA * m]])
    mu = np.linalg.eigvals(np.linalg.solve(shifted, np.block([[one, none], [none, m]])))
    finite = np.abs(mu) > _INFINITE * np.abs(mu).max()
    return np.asarray(unit * (_SIGMA + 1 / mu[finite]), complex)
