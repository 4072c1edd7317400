"""Random torsional chains, and what they do at 50 digits, from equations of every node."""

from typing import NamedTuple

import mpmath
import numpy as np
import tomli_w
from numpy.typing import NDArray
from support import high_precision

from balcli.torsional_vibration.chain import Chain, ChainShaft, Damping, follow_gears, incidence, join_chain

KINDS = ("plain", "geared", "branched", "clamped", "clamped at both ends", "massless", "looped")


def chain_of(inertia, stiffness, clamped=()) -> Chain:
    """Nodes in a row."""
    shafts = [ChainShaft(i, i + 1, k) for i, k in enumerate(stiffness)]
    return join_chain(inertia, shafts, clamped)


def chain_text(nodes, shafts=(), torques=(), gears=(), **head) -> str:
    """A chain file.

    Args:
        nodes: Inertia in kg m2 (0: none), or table, by name.
        shafts: Stiffness in N m/rad, or table, by the names of both ends.
        torques: Node, order, cos and sin of each.
        gears: Ratio by the names of both ends.
        head: Keys of the file.
    """

    def joined(key, found):
        given = ((ends, own if isinstance(own, dict) else {key: own}) for ends, own in dict(found).items())
        return [dict(zip(("from", "to"), ends, strict=True)) | own for ends, own in given]

    tables = ((name, own if isinstance(own, dict) else {"inertia": own * 1e6}) for name, own in nodes.items())
    lists = {
        "node": [{"name": name} | {key: each for key, each in own.items() if each} for name, own in tables],
        "shaft": joined("stiffness", shafts),
        "gear": joined("ratio", gears),
        "excitation": [dict(zip(("node", "order", "cos", "sin"), each, strict=False)) for each in torques],
    }
    return tomli_w.dumps(head | {key: each for key, each in lists.items() if each})


def random_chain(kind: str, seed: int, spread: float = 1.0) -> Chain:
    """A chain of 3 to 9 nodes with inertias and stiffnesses over `spread` powers of ten either way."""
    rng = np.random.default_rng([KINDS.index(kind), seed])
    count = int(rng.integers(3, 10))
    inertia = 10 ** rng.uniform(-spread, spread, count)
    stiffness = 1e6 * 10 ** rng.uniform(-spread, spread, count - 1)
    branched = kind in ("branched", "massless", "looped")
    parents = [int(rng.integers(0, i)) if branched else i - 1 for i in range(1, count)]
    ratios = np.ones(count - 1)
    if kind in ("geared", "massless", "looped"):
        ratios = rng.choice([1, 1, -2.5, 0.4, 3], count - 1)
    if kind == "geared":
        stiffness[count // 2] = np.inf
    if kind == "massless":
        inertia[1 : count - 1 : 2] = 0
    shafts = [
        ChainShaft(*ends, float(k), float(ratio)) if rng.random() < 0.7 else turned(*ends, k, ratio)
        for *ends, k, ratio in zip(parents, range(1, count), stiffness, ratios, strict=True)
    ]
    if kind == "looped":
        pace = np.ones(count)
        for i, parent, ratio in zip(range(1, count), parents, ratios, strict=True):
            pace[i] = pace[parent] * ratio
        shafts.append(ChainShaft(0, count - 1, 1e6, float(pace[-1])))
    held = {"clamped": [0], "clamped at both ends": [0, count - 1]}.get(kind, [])
    return join_chain(inertia, shafts, held)


def turned(start, end, stiffness, ratio):
    """The same shaft named from its other end: its stiffness then counts in the other speed."""
    return ChainShaft(end, start, float(stiffness * ratio**2), 1 / float(ratio))


def random_damping(chain: Chain, seed: int) -> Damping:
    rng = np.random.default_rng(seed)
    shafts = len(chain.start)
    return Damping(
        rng.uniform(0.005, 0.05, shafts), rng.choice([0, 2.0], shafts), rng.choice([0, 3.0], len(chain.inertia))
    )


def no_damping(chain: Chain) -> Damping:
    shafts = len(chain.start)
    return Damping(np.zeros(shafts), np.zeros(shafts), np.zeros(len(chain.inertia)))


def exact_frequencies(chain: Chain):
    """All natural frequencies, rising (rad/s); meshes lead from nodes to later ones."""
    rows = np.zeros((len(chain.start), len(chain.inertia)))
    for row, start, end, ratio in zip(rows, chain.start, chain.end, chain.ratio, strict=True):
        row[start] = ratio
        row[end] = -1
    mass = chain.inertia.copy()
    free = ~chain.clamped
    elastic = np.isfinite(chain.stiffness)
    for shaft in reversed(np.flatnonzero(~elastic)):
        start = chain.start[shaft]
        end = chain.end[shaft]
        ratio = chain.ratio[shaft]
        if start > end:
            start, end = end, start
            ratio = 1 / ratio
        rows[:, start] += ratio * rows[:, end]
        mass[start] += ratio**2 * mass[end]
        free[end] = False
    return high_precision.angular_frequencies(rows[np.ix_(elastic, free)], chain.stiffness[elastic], mass[free])


def exact_response(chain: Chain, damping: Damping, w, load, attached=0.0):
    """Angles (nodes,) and torques of shafts (shafts,) at one frequency, from equations of both, solved at 50 digits."""
    nodes = len(chain.inertia)
    shafts = len(chain.start)
    with mpmath.workdps(high_precision.DIGITS):
        matrix = mpmath.zeros(nodes + shafts)
        right = mpmath.zeros(nodes + shafts, 1)
        w = mpmath.mpf(float(w))
        i = mpmath.mpc(0, 1)
        inertia = np.broadcast_to(chain.inertia + attached, nodes)
        for node in range(nodes):
            own = mpmath.mpmathify(complex(inertia[node]))
            matrix[node, node] = -w * w * own + i * w * mpmath.mpf(float(damping.nodes[node]))
            right[node] = mpmath.mpmathify(complex(load[node]))
        for shaft in range(shafts):
            row = nodes + shaft
            ratio = mpmath.mpf(float(chain.ratio[shaft]))
            for node, far in ((int(chain.end[shaft]), -1), (int(chain.start[shaft]), ratio)):
                matrix[node, row] += far
                matrix[row, node] += far
            if np.isfinite(chain.stiffness[shaft]):
                k = mpmath.mpf(float(chain.stiffness[shaft]))
                k *= 1 + i * mpmath.mpf(float(damping.loss[shaft]))
                matrix[row, row] = -1 / (k + i * w * mpmath.mpf(float(damping.dashpots[shaft])))
        for node in np.flatnonzero(chain.clamped):
            for other in range(nodes + shafts):
                matrix[int(node), other] = matrix[other, int(node)] = 0
            matrix[int(node), int(node)] = 1
            right[int(node)] = 0
        solution = high_precision.to_complex(mpmath.lu_solve(matrix, right))
    return solution[:nodes], solution[nodes:]


class ChainMatrices(NamedTuple):
    """Dense equations of motion of the independent angles.

    Attributes:
        stiffness, damping, mass: (dof, dof), stiffness complex where shafts have loss.
        follow: (nodes, dof), every node's angle for a unit of each independent one.
    """

    stiffness: NDArray[np.complex128]
    damping: NDArray[np.float64]
    mass: NDArray[np.float64]
    follow: NDArray[np.float64]


def chain_matrices(chain: Chain, damping: Damping) -> ChainMatrices:
    follow, _ = follow_gears(chain)
    elastic = np.isfinite(chain.stiffness)
    twist = (incidence(chain) @ follow)[elastic]
    stiffness = chain.stiffness[elastic] * (1 + 1j * damping.loss[elastic])
    return ChainMatrices(
        np.asarray((twist.T * stiffness) @ twist, complex),
        twist.T @ (damping.dashpots[elastic, None] * twist) + (follow.T * damping.nodes) @ follow,
        (follow.T * chain.inertia) @ follow,
        follow,
    )


class Power(NamedTuple):
    """Mean power by frequency, W.

    Attributes:
        fed: (*frequency,) by the loads.
        shafts: (*frequency, shafts) lost in each.
        nodes: (*frequency, nodes) lost at each, its damper included.
    """

    fed: NDArray[np.float64]
    shafts: NDArray[np.float64]
    nodes: NDArray[np.float64]


def balance_power(chain: Chain, damping: Damping, w, load, angle, attached=0.0) -> Power:
    """What harmonic torques (*frequency, nodes) feed into a chain that turns by angles (*frequency,
    nodes), and where it is lost: `k loss + w c` of every shaft's twist, `c` and damper of nodes.
    """
    w = np.asarray(w, float)[..., None]
    fed = w[..., 0] / 2 * np.sum((load * angle.conj()).imag, axis=-1)
    twist = angle @ incidence(chain).T
    held = np.isfinite(chain.stiffness)
    lossy = np.where(held, chain.stiffness, 0) * damping.loss + w * damping.dashpots
    shafts = w / 2 * np.where(held, lossy, 0) * np.abs(twist) ** 2
    resisting = w**2 * (damping.nodes - w * np.imag(chain.inertia + attached))
    return Power(fed, shafts, resisting / 2 * np.abs(angle) ** 2)
