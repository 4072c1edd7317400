"""Worked examples of crank torque and flywheels in textbooks: the exact answers, and what the
authors took instead.
"""

from __future__ import annotations

import numpy as np

from ..core.mechanisms import slidercrank
from ..core.phases import RPM
from ..core.phasors import Array
from ..core.piecewise import polyline, resolved
from ..core.speed_ripple import surplus
from .recomputed import Print, Ranges, Table

# fmt: off
_UICKER = [  # N m, every 10 deg of two turns
    0, 17, 812, 963, 1016, 937, 774, 641, 697, 849, 1031, 1027,
    902, 712, 607, 594, 544, 345, 0, -344, -540, -576, -570, -638,
    -785, -879, -814, -571, -324, -190, -203, -235, -164, -7, 150, 145,
    0, -145, -150, 7, 164, 235, 203, 490, 424, 571, 814, 879,
    785, 638, 570, 576, 540, 344, 0, -344, -540, -577, -572, -643,
    -793, -893, -836, -605, -379, -264, -300, -368, -334, -198, -56, -2,
]
# fmt: on


def tabulate_torque_examples(printed: Print, ranges: Ranges) -> Table:
    """Exact answers beside the printed ones."""
    uicker = polyline(np.radians(np.arange(0, 721, 10)), [*_UICKER, _UICKER[0]])
    energy = surplus(uicker).energy
    answers = (_bevan(), *_khurmi(), _simpson_mean(), _uicker_inertia(energy))
    whole = _uicker_inertia(_simpson_mean() * 4 * np.pi)
    others = (
        ("author's approximation: two terms of the motion", 0, _bevan(two_terms=True)),
        ("the largest while the torque first exceeds the load", 2, _khurmi_zero_side()),
        ("the work of a whole cycle is taken for the fluctuation of energy", 4, whole),
    )
    return printed.compare_answers(answers, others)


# ------------------------------------------------------------------ Bevan 12.3
def _bevan(*, two_terms: bool = False) -> float:
    """Steam engine: bore 9 in, stroke 24 in, rod 60 in, piston rod 2 in, 160 and 32 psi, at 40
    degrees.
    """
    force = 160 * np.pi / 4 * 9**2 - 32 * np.pi / 4 * (9**2 - 2**2)  # lbf
    psi, lam = np.radians(40.0), 12 / 60
    exact = float(slidercrank.velocity(psi, lam, 0.0))
    rate = np.sin(psi) + lam / 2 * np.sin(2 * psi) if two_terms else exact
    return float(force * rate)  # at a crank of 1 ft


# ------------------------------------------------------------------ Khurmi 16.12
def _khurmi() -> tuple[float, float]:
    """Torque 5000 + 600 sin 2t against 5000 + 500 sin t, a wheel of 500 kg on 0.4 m."""
    net = resolved(_khurmi_net, [0.0, 2 * np.pi])
    lowest, highest = net.extremes()
    return surplus(net).energy, max(highest.value, -lowest.value) / (500 * 0.4**2)


def _khurmi_net(angle: Array) -> Array:
    return 600 * np.sin(2 * angle) - 500 * np.sin(angle)


def _khurmi_zero_side() -> float:
    """The largest value of the excess before it first changes its sign."""
    first = resolved(_khurmi_net, [0.0, np.arccos(5 / 12)])
    return first.extremes()[1].value / (500 * 0.4**2)


# ------------------------------------------------------------------ Uicker 18.1
def _simpson_mean() -> float:
    """N m, by the book's rule."""
    weights = np.tile([2, 4], 36)
    return float(weights @ np.array(_UICKER)) * np.pi / 18 / 3 / (4 * np.pi)


def _uicker_inertia(energy: float) -> float:
    """Kg m2 for a fluctuation of 0.025 at 4600 rpm."""
    return energy / (0.025 * (4600 * RPM) ** 2)
