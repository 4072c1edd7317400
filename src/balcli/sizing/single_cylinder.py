"""Schemes for one cylinder whose devices no engine file can describe: shafts of variable speed, and
Oldham couplings (Wang).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.cylinders import Device
from ..core.phasors import unit
from ..engine.build import Engine
from ..errors import BalcliError
from . import eccentric_slider as eccentric
from .effects import Slot
from .fitting import Fitting
from .options import Wish
from .remedy import Remedy

_DEFINITION = (
    "k = r_b/e, mu = m_b r_b/(m r) of each of the two shafts; forces in units of m r omega^2 (m "
    "reciprocates); "
    "design a: pin on the shaft, slot in the disc; b: pin on the disc, slot on the shaft; "
    "criteria: largest and mean force"
)
_SMALLEST = 1e-17  # harmonics of the shafts below this share are left out


def eccentric_slider(engine: Engine, wish: Wish) -> Remedy:
    """Two shafts, symmetric to the cylinder axis, that a slider on an eccentric disc turns
    unevenly; a weight takes the rotating mass.

    The details have the best k = r_b/e and mu = m_b r_b/(m r) of both designs by both criteria, for
    the force of orders 1 and 2 in Wang's two terms and for that of all orders. Fitted is design a
    with the smallest peak for orders 1 and 2.
    """
    _one_cylinder(engine, "eccentric-slider")
    c = engine.cylinders
    if np.any(c.eps):
        raise BalcliError(
            "eccentric-slider: two shafts symmetric to the cylinder axis suit a centred mechanism "
            "alone; this one has "
            f"a piston offset of {float(c.offset[0]) * 1e3:g} mm"
        )
    lam, mass, radius = (float(np.ravel(v)[0]) for v in (c.lam, c.reciprocating, c.radius))
    used = eccentric.best("a", "largest", "orders 1+2", lam)
    optima = eccentric.settled(lam)
    fitting = _rotating_mass(Fitting.of(engine, "eccentric-slider"))
    axis, z = complex(unit(float(c.axis_deg[0]))), float(c.z[0])
    wave = eccentric.shafts(used.design, used.k)[0]
    devices = tuple(
        Device(m, u := -used.mu * mass * radius * float(a) * axis, u, 0j, z)
        for m, a in enumerate(wave)
        if m and abs(a) > _SMALLEST
    )
    return (
        fitting._replace(beyond=devices)
        .note(
            unit_force_N=mass * radius * float(engine.omega) ** 2,
            fitted=_figures(used, mass * radius),
            optima=[_figures(optimum, mass * radius) for optimum in optima],
            definition=_DEFINITION,
        )
        .remedy
    )


def _figures(optimum: eccentric.Optimum, unit_unbalance: float) -> dict[str, Any]:
    return {
        "design": optimum.design,
        "criterion": optimum.criterion,
        "engine_force": optimum.force,
        "k": optimum.k,
        "mu": optimum.mu,
        "unbalance_kg_m": optimum.mu * unit_unbalance,
        "largest": optimum.largest,
        "mean": optimum.mean,
    }


def oldham(engine: Engine, wish: Wish) -> Remedy:
    """Two Oldham couplings, one turning with and one against the crank: first-order weights m r/2,
    and blocks whose centres go round at twice the speed, A2 m r/8 a side; a counterweight takes the
    rotating mass.
    """
    _one_cylinder(engine, "oldham")
    fitting = _rotating_mass(Fitting.of(engine, "oldham"))
    z = float(engine.cylinders.z[0])
    devices, sides = [], {}
    for order, name in ((1, "first_order_kg_m"), (2, "block_kg_m")):
        left = fitting.rest(order)
        pair = left.at("force", 1), left.at("force", -1)
        devices += [Device(order, -pair[0], 0j, 0j, z), Device(order, 0j, -pair[1], 0j, z)]
        sides[name] = abs(pair[1])
    return (
        fitting._replace(beyond=tuple(devices))
        .note(
            **sides,
            definition="a side: first-order weight = m r/2 opposite the piston's motion, block "
            "mass x e = A2 m r/8, "
            "e half the distance of the coupling's shafts; m the reciprocating mass",
        )
        .remedy
    )


def _one_cylinder(engine: Engine, scheme: str) -> None:
    if engine.cylinders.count != 1:
        raise BalcliError(
            f"{scheme} is for a single cylinder; this engine has {engine.cylinders.count} cylinders"
        )


def _rotating_mass(fitting: Fitting) -> Fitting:
    """With a counterweight for whatever turns with the crank beyond the half of the piston's
    straight motion.
    """
    left = fitting.rest(1)
    axis = complex(unit(float(fitting.engine.cylinders.axis_deg[0])))
    excess = left.at("force", 1) - axis**2 * left.at("force", -1).conjugate()
    slot = Slot("counterweight", 1, 1, float(fitting.engine.cylinders.z[0]))
    if abs(excess) <= 4 * left.noise[next(p for p in left.noise if p.quantity == "force")]:
        return fitting
    return fitting.add(
        [slot],
        [-excess],
        "The rotating mass of the throw and the rod is removed by a weight opposite the pin",
    )
