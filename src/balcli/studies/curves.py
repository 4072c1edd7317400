"""Curves over the crank angle of an engine, or of one of its cylinders, with gas if it has some."""

from __future__ import annotations

from ..core.phasors import Array
from ..engine.build import Engine
from ..forces.curves import Curves, compute_cylinder_curves, compute_engine_curves


def compute_curves(engine: Engine, cylinder: int | None, crank_deg: Array) -> Curves:
    """Curves of the engine (cylinder None), or of the cylinder with this number.

    Args:
        engine: without trailing axes.
        cylinder: as the engine file counts them.
        crank_deg: shape (angles,).

    Raises:
        BalcliError: the engine has no such cylinder.
    """
    if cylinder is None:
        found = compute_engine_curves(engine, crank_deg)
    else:
        found = compute_cylinder_curves(engine, cylinder, crank_deg)
    if engine.gas is None:
        return found
    from ..torque.curves import add_cylinder_gas, add_gas_torque  # few engines have gas

    if cylinder is None:
        return add_gas_torque(engine, found)
    return add_cylinder_gas(engine, cylinder, found)
