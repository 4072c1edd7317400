"""Compute schemes for a single cylinder with devices that no engine file can describe: shafts of
variable speed, and Oldham couplings (Wang).

Eccentric slider (Wang, section 2.4): a slider on an eccentric disc turns two balance shafts
unevenly; the best eccentricity of the disc and mass of the shafts' weights are sought.

The shafts, symmetric to the cylinder axis, have the angle phi(theta) at the crank angle theta;
omega is the crank speed, primes are derivatives by theta. Each shaft has a weight of mass m_b at
radius r_b. The force of both along the axis is `2 m_b r_b omega^2 (phi'^2 cos phi + phi'' sin phi)
= -2 m_b r_b omega^2 (cos phi)''` (the sign of the second term is misprinted in the source). Forces
are in units of m r omega^2 (m: reciprocating mass, r: crank radius). The remaining force is then
the even function `P = f(theta) - 2 mu g(theta; k)`, with the engine's force f and the force mu g
that each shaft makes along the axis; k and mu are the unknowns (`Optimum`).

Below, `c` holds cosine coefficients of an even function, shape (orders,), and `x` the two unknowns
k and mu, shape (2,).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from itertools import combinations, product
from math import sqrt
from typing import NamedTuple

import numpy as np

from ..core.cylinders import Device
from ..core.mechanisms import closed_form
from ..core.phasors import Array, Complex, unit
from ..core.records import Node, to_document
from ..engine.engine import Engine
from ..errors import BalcliError
from .fitting import Fitting
from .options import CRITERIA, DESIGNS, SchemeOptions
from .remedy import PartsBeyond, Remedy

FORCES = ("orders 1+2", "all orders")  # engine force: cos theta + lambda cos 2 theta; exact force
_LEAST_K = 1.2
_MOST_K = 1e12  # limits of k; nearer to 1, the series is too long
_COUNT = 512  # number of samples of a revolution, enough for k above _LEAST_K
_GRID = np.linspace(0, np.pi, 1025)
_ORDERS = np.arange(_COUNT // 4)
_ROUNDS = 60
_NOISE = 5e-16  # smaller coefficients count as 0: rounding, which order^2 would enlarge
_SETTLED = 1e-10  # a relative step below this ends the search
_FARTHEST_TO_PEAK = 0.25
_FARTHEST_TO_MEAN = 0.1  # largest change of k in one step, as a share of k
_SINGULAR = 1e-14  # matrices with smaller determinants are singular
_NEWTON_STEPS = 8  # steps from the middle of an interval of _GRID to a root, up to rounding


class Optimum(NamedTuple):
    """The best pair of unevenly turning shafts by one criterion.

    Attributes:
        design: One of `DESIGNS`.
        criterion: One of `CRITERIA`.
        engine_force: One of `FORCES`.
        k: Radius r_b of driving pin and weight over the eccentricity e of the disc.
        mu: Unbalance of each shaft in units of m r (reciprocating mass times crank radius).
        largest: Largest absolute value of the remaining force, in units of m r omega^2.
        mean: Mean absolute value of the remaining force, in units of m r omega^2.
    """

    design: str
    criterion: str
    engine_force: str
    k: float
    mu: float
    largest: float
    mean: float


def find_optimum(design: str, criterion: str, engine_force: str, lam: float) -> Optimum:
    """Return the best k and mu of one design by one criterion.

    Args:
        design: One of `DESIGNS`.
        criterion: One of `CRITERIA`.
        engine_force: One of `FORCES`.
        lam: Crank radius over rod length.

    Raises:
        BalcliError: Lambda is so large that the search does not converge.
    """
    engine = np.where(_ORDERS == 1, 1.0, np.where(_ORDERS == 2, lam, 0.0))
    engine = closed_form.piston(_ORDERS, lam) if engine_force == FORCES[1] else engine
    try:
        start = np.array([2 / lam, 0.5])
        x = _iterate(lambda x: _step_to_peak(design, engine, x), start, _FARTHEST_TO_PEAK)
        if criterion == "mean":
            x = _iterate(lambda x: _step_to_mean(design, engine, x), x, _FARTHEST_TO_MEAN)
    except (np.linalg.LinAlgError, ArithmeticError):
        raise BalcliError(
            f"eccentric-slider: there is no optimum of design {design} at lambda = {lam:g}"
        ) from None
    remaining, _ = _linearize(design, engine, x)
    primitive = _evaluate(remaining, _find_zeros(remaining), -1)
    largest = float(np.abs(_evaluate(remaining, _find_zeros(remaining, 1))).max())
    mean = float(np.abs(np.diff(primitive)).sum()) / np.pi
    return Optimum(design, criterion, engine_force, float(x[0]), float(x[1]), largest, mean)


@lru_cache(16)  # a comparison of schemes asks for it once a design
def find_optima(lam: float) -> tuple[Optimum, ...]:
    """Return the optima of both designs by both criteria for both forces. The first optimum is
    design a with the smallest peak for orders 1 and 2.

    Above lambda = 0.6 some searches do not converge, because k would fall below 1; their optima are
    omitted.

    Raises:
        BalcliError: The search for the first optimum does not converge.
    """
    optima = [find_optimum(DESIGNS[0], CRITERIA[0], FORCES[0], lam)]
    for force, design, criterion in [*product(FORCES, DESIGNS, CRITERIA)][1:]:
        with suppress(BalcliError):
            optima.append(find_optimum(design, criterion, force, lam))
    return tuple(optima)


def expand_shaft_wave(design: str, k: float) -> tuple[Array, Array]:
    """Return the cosine coefficients of cos phi over the crank angle, where phi is the angle of the
    shafts, and the derivatives of these coefficients by k.
    """
    theta = np.arange(_COUNT) * np.float64(2 * np.pi / _COUNT)
    cosine = np.cos(theta)
    step = 1e-30
    moved = k + 1j * step  # a complex step gives the derivative to rounding
    wave: Complex
    if design == "a":
        wave = (cosine * np.sqrt(moved**2 - np.sin(theta) ** 2) - np.sin(theta) ** 2) / moved
    else:
        wave = (moved * cosine - 1) / np.sqrt(1 + moved**2 - 2 * moved * cosine)
    c = np.fft.rfft([wave.real, wave.imag / step]).real / _COUNT * 2
    values, by_k = np.where(np.abs(c) > _NOISE, c, 0)[:, : len(_ORDERS)]
    return values, by_k


def find_shaft_rates(design: str, k: float) -> tuple[float, float, float]:
    """Return the largest and smallest `phi'` (shaft speed over crank speed, at theta = 0 and pi),
    and the largest `phi''`.

    Args:
        design: One of `DESIGNS`.
        k: Radius of the driving pin over the eccentricity, above 1.
    """
    if design == "a":  # phi = theta + arcsin(sin(theta)/k)
        return 1 + 1 / k, 1 - 1 / k, 1 / sqrt(k**2 - 1)
    square = 1 + k**2  # phi = arg(k e^{i theta} - 1); phi'' is largest at this cosine
    cosine = 8 * k / (square + sqrt(square**2 + 32 * k**2))
    bend = k * (k**2 - 1) * sqrt(1 - cosine**2) / (square - 2 * k * cosine) ** 2
    return k / (k - 1), k / (k + 1), bend


def _linearize(design: str, engine: Array, x: Array) -> tuple[Array, Array]:
    """Return the cosine coefficients of the remaining force P, and their derivatives by k and by
    mu, shape (2, orders).
    """
    if not _LEAST_K < x[0] < _MOST_K:
        raise ArithmeticError(f"k must stay above {_LEAST_K}")
    wave, by_k = expand_shaft_wave(design, x[0])
    slopes = -2 * _ORDERS**2 * np.stack([x[1] * by_k, wave])
    return engine + x[1] * slopes[1], slopes


# ------------------------------------------------------------------ even series
def _evaluate(c: Array, theta: Array, derivative: int = 0) -> Array:
    """Return the values of the n-th derivative of a series (n = `derivative`; -1: its integral) at
    the angles, shape (angles,), or (angles, 2) if `c` has two series in rows.
    """
    orders = np.flatnonzero(np.atleast_2d(c).any(axis=0))  # most of the high ones are 0
    rate = (np.where(orders, orders, np.inf) if derivative < 0 else orders) ** float(derivative)
    angle = np.multiply.outer(theta, orders) + derivative * np.pi / 2
    values: Array = np.cos(angle) @ (rate * c[..., orders]).T
    return values


def _find_zeros(c: Array, derivative: int = 0) -> Array:
    """Return 0, the zeros of the n-th derivative (n = `derivative`) of a series between 0 and pi,
    and pi. Newton's method finds each zero within an interval of `_GRID`.
    """
    values = _evaluate(c, _GRID, derivative)
    if derivative == 1:  # the function is even about 0 and pi
        values[[0, -1]] = 0
    cells = np.flatnonzero(values[:-1] * values[1:] < 0)
    low = _GRID[cells]
    high = _GRID[cells + 1]
    theta = (low + high) / 2
    for _ in range(_NEWTON_STEPS):
        move = _evaluate(c, theta, derivative) / _evaluate(c, theta, derivative + 1)
        theta = np.clip(theta - move, low, high)
    return np.concatenate([[0.0], theta, [np.pi]])


# ------------------------------------------------------------------ the two criteria
def _iterate(step: Callable[[Array], Array], x: Array, farthest: float) -> Array:
    """Repeat steps from x until they converge, and return the last x. A step changes k by at most
    the share `farthest`.
    """
    for _ in range(_ROUNDS):
        move = step(x)
        share: float = farthest * x[0] / max(abs(move[0]), 1e-300)
        x = x + move * min(1.0, share)
        if np.all(np.abs(move) <= _SETTLED * np.abs(x)):
            return x
    raise ArithmeticError("no convergence")


def _step_to_peak(design: str, engine: Array, x: Array) -> Array:
    """Return the step d of k and mu that minimises the largest of `|values + slopes d|` over the
    extremes of P (values: P at the extremes; slopes: its derivatives by k and mu, so that the sum
    is P after the step). This step gives three extremes the same size. So the step for each three
    extremes is computed, and the best of these steps is returned.
    """
    remaining, by_x = _linearize(design, engine, x)
    theta = _find_zeros(remaining, 1)
    values = _evaluate(remaining, theta)
    sizes = np.abs(values)
    slopes = np.sign(values)[:, None] * _evaluate(by_x, theta)
    triples = np.array([*combinations(range(len(values)), 3)])
    systems = np.insert(slopes, 2, -1.0, axis=1)[triples]  # size + slopes d = common size
    regular = np.abs(np.linalg.det(systems)) >= _SINGULAR
    solutions = np.linalg.solve(systems[regular], -sizes[triples[regular], None])
    steps: Array = solutions[:, :2, 0]
    return steps[(sizes + steps @ slopes.T).max(axis=1).argmin()]


def _step_to_mean(design: str, engine: Array, x: Array) -> Array:
    """Return the step of Newton's method on the gradient of the integral of |P|; the gradient has a
    closed form in the zeros of P.
    """

    def find_gradient(x: Array) -> Array:
        remaining, by_x = _linearize(design, engine, x)
        zeros = _find_zeros(remaining)
        signs = np.sign(_evaluate(remaining, (zeros[:-1] + zeros[1:]) / 2))
        gradient: Array = signs @ np.diff(_evaluate(by_x, zeros, -1), axis=0)
        return gradient

    columns = [
        (find_gradient(x + step) - find_gradient(x - step)) / (2 * step.sum())
        for step in np.diag(1e-6 * x)
    ]
    return -np.linalg.solve(np.column_stack(columns), find_gradient(x))


_ECCENTRIC_SLIDER = (
    "k = r_b/e, mu = m_b r_b/(m r); m: reciprocating mass, r: crank radius, m_b: weight of each of "
    "the two shafts, r_b: radius of its weight and of its pin, e: distance of the axes of shaft "
    "and disc; forces in units of m r omega^2; design a: pin on the shaft, slot in the disc; b: "
    "pin on the disc, slot on the shaft; criteria: largest and mean remaining force; "
    "engine force: orders 1+2 are cos theta + lambda cos 2 theta (Wang's two terms, with lambda "
    "instead of A2), all orders are exact; the shafts are symmetric to the cylinder axis"
)
_SPEED_LAW = (
    "a: 1 + cos theta/sqrt(k^2 - sin^2 theta), b: k (k - cos theta)/(1 + k^2 - 2 k cos theta) "
    "times crank speed"
)
_OLDHAM = (
    "each coupling has a first-order weight of m r/2 opposite the piston's motion and a block with "
    "block mass x e = A2 m r/8; m: reciprocating mass, A2: coefficient of the second order of the "
    "piston force, e: half the distance of the coupling's shafts; e is given for a block as heavy "
    "as the weight (a block of half the mass needs 2 e); the block slides by 2 e to both sides"
)


def size_eccentric_slider(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit two shafts, symmetric to the cylinder axis, which a slider on an eccentric disc turns
    unevenly, and a counterweight for the rotating mass.

    Masses and eccentricities are for the given radius, or else the crank radius. By default, design
    a with the smallest peak for orders 1 and 2 (Wang's two terms) is fitted; the remedy lists the
    optima of both designs.

    Raises:
        BalcliError: There are several cylinders or a piston offset, or the rod is too short for an
            optimum.
    """
    _require_one_cylinder(engine, "eccentric-slider")
    c = engine.cylinders
    if np.any(c.eps):
        raise BalcliError("eccentric-slider is for a cylinder without piston offset")
    if c.harmonic:
        raise BalcliError("eccentric-slider is for a rod of finite length, not harmonic motion")
    unit_kg_m = float(np.ravel(c.reciprocating)[0]) * float(np.ravel(c.radius)[0])
    optima = find_optima(float(np.ravel(c.lam)[0]))
    designs = [_describe_shaft(engine, one, unit_kg_m, options.radius) for one in optima]
    wanted = options.design or DESIGNS[0], options.criterion or CRITERIA[0]
    chosen = [n for n, one in enumerate(optima) if (one.design, one.criterion) == wanted]
    if not chosen:
        raise BalcliError(f"eccentric-slider: no optimum of design {wanted[0]} ({wanted[1]} force)")
    fitting = Fitting.start(engine, "eccentric-slider").balance_rotating(keep_overbalance=False)
    fitting = fitting.add_details(
        unit_force_N=unit_kg_m * float(engine.omega) ** 2,
        fitted=designs[chosen[0]],
        optima=designs,
        speed_law=_SPEED_LAW,
        definition=_ECCENTRIC_SLIDER,
    )
    return fitting.remedy._replace(
        beyond=_make_shafts(engine, optima[chosen[0]], unit_kg_m),
        parts_beyond=PartsBeyond(2, 2 * designs[chosen[0]]["mass_kg"]),  # a pair of equal shafts
    )


def _describe_shaft(
    engine: Engine, optimum: Optimum, unit_kg_m: float, radius: float | None
) -> Node:
    """Return an optimum with the figures of each shaft. The weight loads its shaft with the forces
    `m_b r_b omega^2 phi'^2` outwards and `m_b r_b omega^2 phi''` along the path, and with the
    torque `m_b r_b^2 omega^2 phi''`.

    Args:
        engine: Engine.
        optimum: Optimum.
        unit_kg_m: Reciprocating mass times crank radius, kg m.
        radius: Radius of pin and weight, m; None: the crank radius.
    """
    unbalance = optimum.mu * unit_kg_m
    r_b = radius or float(engine.cylinders.radius[0])
    fastest, slowest, bend = find_shaft_rates(optimum.design, optimum.k)
    force = unbalance * float(engine.omega) ** 2
    rpm = float(engine.speed_rpm)
    return {
        **to_document(optimum),
        "unbalance_kg_m": unbalance,
        "radius_mm": 1e3 * r_b,
        "eccentricity_mm": 1e3 * r_b / optimum.k,
        "mass_kg": unbalance / r_b,
        "largest_speed_rpm": rpm * fastest,
        "smallest_speed_rpm": rpm * slowest,
        "largest_radial_force_N": force * fastest**2,
        "largest_tangential_force_N": force * bend,
        "largest_torque_Nm": force * bend * r_b,
    }


def _make_shafts(engine: Engine, fitted: Optimum, unit_kg_m: float) -> tuple[Device, ...]:
    """Return devices along the cylinder, one for each order of the motion of both shafts."""
    axis = complex(unit(float(engine.cylinders.axis_deg[0])))
    z = float(engine.cylinders.z[0])
    wave, _ = expand_shaft_wave(fitted.design, fitted.k)
    halves = (-fitted.mu * unit_kg_m * wave * axis).tolist()
    return tuple(
        Device(order, half, half, 0j, z) for order, half in enumerate(halves) if order and half
    )


def size_oldham(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit two Oldham couplings, of which one turns with and one against the crank, and a
    counterweight for the rotating mass.

    Each coupling has a first-order weight of unbalance m r/2, and a block of unbalance A2 m r/8,
    whose centre turns at twice crank speed. A2 is the coefficient of the second order of the
    piston force. Masses are for the given radius, by default the crank radius.

    Raises:
        BalcliError: There are several cylinders.
    """
    _require_one_cylinder(engine, "oldham")
    fitting = Fitting.start(engine, "oldham").balance_rotating()
    z = float(engine.cylinders.z[0])
    first, second = (fitting.find_residual(order) for order in (1, 2))
    devices = [
        Device(one.order, *vectors, 0j, z)
        for one in (first, second)
        for vectors in ((-one.force(1), 0j), (0j, -one.force(-1)))
    ]
    weight = abs(first.force(-1))
    block = abs(second.force(-1))
    radius = options.radius or float(engine.cylinders.radius[0])
    mass = weight / radius  # of a weight, and of a block
    fitting = fitting.add_details(
        first_order_kg_m=weight,
        block_kg_m=block,
        radius_mm=1e3 * radius,
        mass_kg=mass,
        eccentricity_mm=1e3 * radius * block / weight if weight else 0.0,
        shaft_speed_rpm=float(engine.speed_rpm),
        block_speed_rpm=2 * float(engine.speed_rpm),
        weight_force_N=weight * first.newtons_per_kg_m,
        block_force_N=block * second.newtons_per_kg_m,
        definition=_OLDHAM,
    )
    return fitting.remedy._replace(beyond=tuple(devices), parts_beyond=PartsBeyond(4, 4 * mass))


def _require_one_cylinder(engine: Engine, scheme: str) -> None:
    if engine.cylinders.count != 1:
        raise BalcliError(f"{scheme} is for one cylinder; this engine has {engine.cylinders.count}")
