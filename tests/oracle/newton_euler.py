"""Forces on pins and cylinder walls straight from Newton's and Euler's equations of every piston
and rod, on the grid of crank angles of `momentum`, whose places and derivatives they are: rods are
rigid bodies with centre of mass and moment of inertia, and a linear system is solved at each angle.
"""

from typing import NamedTuple

import numpy as np
from oracle import momentum
from oracle.momentum import slope


class Forces(NamedTuple):
    """N, x + iy in the engine's axes, shape (points,).

    `pin` is what the rod presses on its crank pin or knuckle pin with, `wall` the piston on the
    wall, along its normal.
    """

    pin: np.ndarray
    wall: np.ndarray


def solve(engine: momentum.Engine, gas: dict[int, np.ndarray]) -> dict[int, Forces]:
    """Forces by cylinder; `gas` presses each piston towards the crank, N at the grid's angles."""
    omega = engine.speed * engine._pace

    def rate(velocity: np.ndarray | float) -> np.ndarray:
        return omega * slope(omega * (velocity + 0 * momentum.THETA))

    found: dict[int, Forces] = {}
    articulation = engine.data.get("articulation")
    chief = None if articulation is None else articulation.get("master", 1) - 1
    masters_last = sorted(engine.cells, key=lambda cell: cell["bank"] == chief)
    for cell in masters_last:
        on_rod = [
            (knuckle, found[other["number"]].pin)
            for other in masters_last
            if cell["bank"] == chief and other is not cell and other["throw"] == cell["throw"]
            for knuckle in [_foot(engine, other)]
        ]
        found[cell["number"]] = _one(engine, cell, gas[cell["number"]], on_rod, rate)
    return found


def _foot(engine: momentum.Engine, cell: dict) -> np.ndarray:
    """Where the lower end of a rod is."""
    _, piston, rod = engine.cylinders[cell["number"]]
    _, figures = engine._parts(cell)
    along = (piston.place - rod.place) / np.abs(piston.place - rod.place)
    return piston.place - figures["length"] * along


def _one(engine, cell, gas, on_rod, rate) -> Forces:
    """Unknown: force on the rod at its foot and at its piston pin (x and y each), and of the wall on the piston."""
    _, piston, rod = engine.cylinders[cell["number"]]
    foot = _foot(engine, cell)
    axis = engine._axis(cell)
    normal = 1j * axis
    push = rod.mass * rate(slope(rod.place))
    turn = rod.inertia * rate(rod.spin)
    head = piston.mass * rate(slope(piston.place)) + gas * axis
    below = foot - rod.place
    above = piston.place - rod.place
    rows = np.zeros((len(foot), 5, 5))
    right = np.zeros((len(foot), 5))
    for k, part in enumerate((np.real, np.imag)):
        rows[:, k, k] = rows[:, k, 2 + k] = 1  # rod: all forces are mass x acceleration
        right[:, k] = part(push - sum(load for _, load in on_rod))
        rows[:, 2 + k, 2 + k] = -1  # piston likewise
        rows[:, 2 + k, 4] = part(normal)
        right[:, 2 + k] = part(head)
    for k, arm in ((0, below), (2, above)):  # moments about the rod's centre of mass
        rows[:, 4, k] = -arm.imag
        rows[:, 4, k + 1] = arm.real
    moments = [(np.conj(at - rod.place) * load).imag for at, load in on_rod]
    right[:, 4] = turn - sum(moments)
    x = np.linalg.solve(rows, right[:, :, None])[:, :, 0]
    return Forces(-(x[:, 0] + 1j * x[:, 1]), -x[:, 4] * normal)
