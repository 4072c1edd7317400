"""Schemes for one cylinder whose devices no engine file can describe: shafts of variable speed, and
Oldham couplings (Wang).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..core.cylinders import Device
from ..core.phasors import unit
from ..documents.records import to_document
from ..engine.build import Engine
from ..errors import BalcliError
from .eccentric_slider import Optimum, expand_shaft_wave, find_optima
from .effects import Slot
from .fitting import Fitting
from .options import SchemeOptions
from .remedy import Remedy
from .residual import FORWARD_FORCE

_SMALLEST = 1e-17  # harmonics of the shafts below this share are left out
_ECCENTRIC_SLIDER = (
    "k = r_b/e, mu = m_b r_b/(m r) of each of the two shafts; forces in units of m r omega^2 (m "
    "reciprocates); design a: pin on the shaft, slot in the disc; b: pin on the disc, slot on the "
    "shaft; criteria: largest and mean force"
)
_OLDHAM = (
    "a side: first-order weight = m r/2 opposite the piston's motion, block mass x e = A2 m r/8, "
    "e half the distance of the coupling's shafts; m the reciprocating mass"
)


def size_eccentric_slider(engine: Engine, options: SchemeOptions) -> Remedy:
    """Two shafts, symmetric to the cylinder axis, that a slider on an eccentric disc turns
    unevenly; a weight takes the rotating mass.

    Fitted is design a with the smallest peak for orders 1 and 2 (Wang's two terms); the remedy has
    the optima of both designs.

    Raises BalcliError for several cylinders, a piston offset, or a rod too short for an optimum.
    """
    _require_one_cylinder(engine, "eccentric-slider")
    c = engine.cylinders
    if np.any(c.eps):
        raise BalcliError(
            "eccentric-slider: two shafts symmetric to the cylinder axis suit a centred mechanism "
            f"alone; this one has a piston offset of {float(c.offset[0]) * 1e3:g} mm"
        )
    mass, radius = float(np.ravel(c.reciprocating)[0]), float(np.ravel(c.radius)[0])
    optima = tuple(
        replace(one, unbalance_kg_m=one.mu * mass * radius)
        for one in find_optima(float(np.ravel(c.lam)[0]))
    )
    fitting = _balance_rotating_mass(Fitting.start(engine, "eccentric-slider")).add_details(
        unit_force_N=mass * radius * float(engine.omega) ** 2,
        fitted=to_document(optima[0]),
        optima=[to_document(one) for one in optima],
        definition=_ECCENTRIC_SLIDER,
    )
    return fitting.remedy._replace(beyond=_make_shafts(engine, optima[0]))


def _make_shafts(engine: Engine, fitted: Optimum) -> tuple[Device, ...]:
    """Both shafts: a device for each order of their motion, which shakes along the cylinder."""
    axis = complex(unit(float(engine.cylinders.axis_deg[0])))
    z = float(engine.cylinders.z[0])
    wave, _ = expand_shaft_wave(fitted.design, fitted.k)
    halves = {
        order: -fitted.unbalance_kg_m * float(amplitude) * axis
        for order, amplitude in enumerate(wave)
        if order and abs(amplitude) > _SMALLEST
    }
    return tuple(Device(order, half, half, 0j, z) for order, half in halves.items())


def size_oldham(engine: Engine, options: SchemeOptions) -> Remedy:
    """Two Oldham couplings, one turning with and one against the crank: first-order weights m r/2,
    and blocks whose centres go round at twice the speed, A2 m r/8 a side; a counterweight takes the
    rotating mass.

    Raises BalcliError for several cylinders.
    """
    _require_one_cylinder(engine, "oldham")
    fitting = _balance_rotating_mass(Fitting.start(engine, "oldham"))
    z = float(engine.cylinders.z[0])
    first, second = (fitting.find_residual(order) for order in (1, 2))
    devices = [
        Device(one.order, *vectors, 0j, z)
        for one in (first, second)
        for vectors in ((-one.force(1), 0j), (0j, -one.force(-1)))
    ]
    fitting = fitting.add_details(
        first_order_kg_m=abs(first.force(-1)),
        block_kg_m=abs(second.force(-1)),
        definition=_OLDHAM,
    )
    return fitting.remedy._replace(beyond=tuple(devices))


def _require_one_cylinder(engine: Engine, scheme: str) -> None:
    if engine.cylinders.count != 1:
        raise BalcliError(
            f"{scheme} is for a single cylinder; this engine has {engine.cylinders.count} cylinders"
        )


def _balance_rotating_mass(fitting: Fitting) -> Fitting:
    """With a counterweight for whatever turns with the crank beyond the half of the piston's
    straight motion.
    """
    residual = fitting.find_residual(1)
    axis = complex(unit(float(fitting.engine.cylinders.axis_deg[0])))
    excess = residual.force(1) - axis**2 * residual.force(-1).conjugate()
    if abs(excess) <= 4 * residual.noise[FORWARD_FORCE]:
        return fitting
    slot = Slot("counterweight", 1, 1, float(fitting.engine.cylinders.z[0]))
    return fitting.add(
        [slot],
        [-excess],
        "The rotating mass of the throw and the rod is removed by a weight opposite the pin",
    )
