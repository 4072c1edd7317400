"""Methods that compute a figure of a whole engine or chain: its largest force, orders of its gas
torque, and its vibratory torque.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple, TypeAlias

import numpy as np

from ..analysis.answer import analyze
from ..core.phasors import Array, Complex
from ..crank_torque.answer import torque
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.parse import parse
from ..torsional_vibration.answer import torsion
from .methods import tell_degrees
from .records import Approach, OrderError
from .timing import Run

V8 = """
name = "72-degree V8, uneven throws"
[crank]
stroke = 90
throws = [0, 100, 250, 190]      # no order is balanced, so that relative errors mean something
spacing = 110
throw_mass = 1.2
[rod]
ratio = 0.28
mass = 0.6
cg = 45
inertia = 4000
[piston]
mass = 0.5
[layout]
bank_angle = 72
stagger = 22
"""
SINGLE_WITH_GAS = """
name = "single with gas"
[crank]
stroke = 90
[rod]
ratio = 0.28
[piston]
mass = 0.5
bore = 86
[layout]
firing_order = [1]
[operation]
speed = 3000
[gas]
cycle = "wiebe"
compression_ratio = 10
imep = 10
burn_start = -15
burn_duration = 50
"""
GAS_ORDERS = [0.5, 6.0, 24.0]
CHAIN = """
name = "three inertias, six orders"
node = [
    { name = "crank", inertia = "0.05 kg m^2" },
    { name = "flywheel", inertia = "0.8 kg m^2" },
    { name = "load", inertia = "1.5 kg m^2" },
]
shaft = [
    { from = "crank", to = "flywheel", stiffness = 2e5, damping = 12 },
    { from = "flywheel", to = "load", stiffness = 5e4, damping = 8 },
]
excitation = [
    { node = "crank", order = 0.5, cos = 60, sin = 20 },
    { node = "crank", order = 1, cos = -30, sin = 45 },
    { node = "crank", order = 1.5, cos = 80, sin = -10 },
    { node = "crank", order = 2, cos = 120, sin = -35 },
    { node = "crank", order = 3, cos = 40, sin = 25 },
    { node = "crank", order = 4, cos = 15, sin = -20 },
]
"""
CHAIN_RPM = 2400.0

Errors: TypeAlias = tuple[OrderError, ...]


class Case(NamedTuple):
    """A method of a task, before its time is measured.

    Attributes:
        method: Its name.
        approach: How it computes.
        run: What is timed.
        errors: Errors of its result.
    """

    method: str
    approach: Approach
    run: Run
    errors: Errors


def list_engine_tasks() -> dict[str, list[Case]]:
    """Return the methods of the tasks of whole engines, by task."""
    return {
        "largest force of a V8": list(_list_peaks()),
        "orders of gas torque": list(_list_gas_orders()),
        "vibratory torque of a shaft": list(_list_torsion()),
    }


def _list_peaks() -> Iterator[Case]:
    engine = build(parse(V8))
    exact = _climb(engine)
    for step in (5.0, 1.0, 0.1):
        angles = np.radians(np.arange(0.0, 360.0, step))

        def search_grid(angles: Array = angles) -> float:
            return float(np.abs(find_force(engine, angles)).max())

        yield _case(f"grid of {tell_degrees(step)}", "samples", search_grid, exact)

    def ask() -> float:
        return analyze(engine, only="peak").peak.force.value

    yield _case("analyze: maximum of the curve", "exact", ask, exact)


def _case(method: str, approach: Approach, run: Callable[[], float], exact: float) -> Case:
    error = abs(run() - exact) / abs(exact)
    return Case(method, approach, run, (OrderError(None, error),))


def find_force(engine: Engine, angles: Array) -> Complex:
    """Return the force of an engine of centred slider-cranks at crank angles (rad), N, by plain
    numpy.
    """
    c = engine.cylinders
    psi = angles + np.radians(c.angle_deg)[:, None]
    lam = float(c.lam[0])
    secant = 1 / np.sqrt(1 - (lam * np.sin(psi)) ** 2)
    acceleration = np.cos(psi) + lam * secant * ((np.cos(psi) * secant) ** 2 - np.sin(psi) ** 2)
    scale = float(c.radius[0]) * float(engine.omega) ** 2
    reciprocating = float(c.reciprocating[0])
    rotating = float(c.rotating[0])
    along = np.exp(1j * np.radians(c.axis_of_each_deg))[:, None]
    force = reciprocating * acceleration + rotating * np.exp(1j * psi)
    return np.asarray(scale * (along * force).sum(axis=0))


def _climb(engine: Engine) -> float:
    """Return the largest force, by grids that close in on it."""
    middle = 0.0
    width = np.pi
    for _ in range(12):
        angles = middle + np.linspace(-width, width, 401)
        sizes = np.abs(find_force(engine, angles))
        middle = float(angles[np.argmax(sizes)])
        width /= 50
    return float(sizes.max())


def _list_gas_orders() -> Iterator[Case]:
    engine = build(parse(SINGLE_WITH_GAS))
    curve = torque(engine, GAS_ORDERS).curve
    exact = _integrate(curve.breaks, curve.at)
    for step in (1.0, 0.25):
        angles = np.radians(np.arange(0.0, 720.0, step))

        def add_steps(angles: Array = angles) -> Complex:
            waves = np.exp(-1j * np.outer(GAS_ORDERS, angles))
            return np.asarray(2 / len(angles) * waves @ curve.at(angles))

        name = f"{len(angles)} steps over the cycle"
        yield Case(name, "samples", add_steps, _compare(add_steps(), exact))

    def add_pieces() -> Complex:
        return curve.harmonics(np.array(GAS_ORDERS) * 2)

    yield Case("exact pieces", "exact", add_pieces, _compare(add_pieces(), exact))


def _integrate(breaks: Array, at: Callable[[Array], Array]) -> Complex:
    """Return the orders of a curve by 40 Gauss points between its breaks."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    half = np.diff(breaks) / 2
    angles = (breaks[:-1] + half)[:, None] + half[:, None] * nodes
    values = at(angles.ravel()) * (half[:, None] * weights).ravel()
    waves = np.exp(-1j * np.outer(GAS_ORDERS, angles.ravel()))
    return np.asarray(2 / (breaks[-1] - breaks[0]) * waves @ values)


def _compare(found: Complex, exact: Complex) -> Errors:
    shares = np.abs(found - exact) / np.abs(exact)
    return tuple(OrderError(n, float(e)) for n, e in zip(GAS_ORDERS, shares, strict=True))


def _list_torsion() -> Iterator[Case]:
    orders, torques = _solve_chain()
    exact = float((_climb_wave(orders, torques) + _climb_wave(orders, -torques)) / 2)

    def add_amplitudes() -> float:
        return float(np.abs(_solve_chain()[1]).sum())

    yield _case("sum of amplitudes, dense matrices", "formula", add_amplitudes, exact)

    def ask() -> float:
        response = torsion(CHAIN, [CHAIN_RPM]).response
        return float(response.shafts[0].half_peak_to_peak_Nm[0])

    yield _case("torsion: synthesis of all orders", "exact", ask, exact)


def _climb_wave(orders: Array, torques: Complex) -> float:
    """Return the largest value of a sum of orders over two revolutions."""
    middle = 2 * np.pi
    width = 2 * np.pi
    for _ in range(8):
        angles = middle + np.linspace(-width, width, 2001)
        values = (torques @ np.exp(1j * np.outer(orders, angles))).real
        middle = float(angles[np.argmax(values)])
        width /= 100
    return float(values.max())


def _solve_chain() -> tuple[Array, Complex]:
    """Return the orders, and the torque of each order in the first shaft of CHAIN, N m."""
    inertia = np.diag([0.05, 0.8, 1.5])
    stiffness = np.array([[2e5, -2e5, 0], [-2e5, 2.5e5, -5e4], [0, -5e4, 5e4]])
    damping = np.array([[12.0, -12, 0], [-12, 20, -8], [0, -8, 8]])
    orders = np.array([0.5, 1, 1.5, 2, 3, 4])
    loads = np.array([60 - 20j, -30 - 45j, 80 + 10j, 120 + 35j, 40 - 25j, 15 + 20j])
    torques = []
    for order, load in zip(orders, loads, strict=True):
        w = order * CHAIN_RPM * np.pi / 30
        dynamic = stiffness + 1j * w * damping - w**2 * inertia
        angles = np.linalg.solve(dynamic, np.array([load, 0, 0]))
        torques.append((2e5 + 12j * w) * (angles[1] - angles[0]))
    return orders, np.array(torques)
