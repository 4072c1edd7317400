"""A crank at uneven speed, followed through equal steps of time."""

from collections.abc import Callable

import numpy as np


def run_in_time(speed: Callable, turns: int, steps: int = 1 << 13) -> tuple[np.ndarray, float]:
    """Crank angles after equal steps of the time of so many turns, by Runge and Kutta, and how long
    the turns take. `speed` is a function of the crank angle, both in rad.
    """
    fine = np.linspace(0, 2 * np.pi * turns, 1 << 12, endpoint=False)
    period = float(np.mean(1 / speed(fine)) * 2 * np.pi * turns)
    h = period / steps
    theta = 0.0
    passed = []
    for _ in range(steps):
        passed.append(theta)
        a = speed(theta)
        b = speed(theta + h / 2 * a)
        c = speed(theta + h / 2 * b)
        theta += h / 6 * (a + 2 * b + 2 * c + speed(theta + h * c))
    assert abs(theta - 2 * np.pi * turns) < 1e-9
    return np.array(passed), period
