"""Analyze the torque on an engine's crank (`torque`): by order and over the cycle, with
means, extremes and the flywheel.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from ..core.cylinder_pressure import find_highest
from ..core.shaft_speed import surplus
from ..engine.engine import CylinderNumber, Engine, check_engine, find_row, refuse_geared
from ..engine.layout import find_first
from ..errors import ArgumentError, check_number, check_type, list_words
from ..file.assumed import DEVICES, STEADY
from ..forces.curves import find_moving_inertia, find_torque_curves
from ..forces.loads_with_gas import refuse_too_many_forces
from ..forces.spectrum import check_orders, compute_spectra, list_gas_orders, take_gas
from .ends import list_ends
from .flywheel import find_flywheel
from .loads import KINDS_OF_LOAD, analyze_loads
from .records import (
    TorqueAnalysis,
    TorqueOrder,
    find_brake_share,
    list_torques,
    measure_curve,
    measure_energy,
    write_whole,
)

KINDS_OF_TORQUE = ("gas", "torque", "torque_total")


def choose_firing_cylinder(engine: Engine) -> CylinderNumber:
    """Return the number of the cylinder whose gas torque is shown by default: 1, or the first to
    fire if cylinder 1 is a dummy; in geared engines, the first cylinder of the first engine.
    """
    if engine.placed:
        return engine.numbers[0]
    return find_first(engine.fires_deg) if engine.fires_deg else 1


def torque(
    engine: Engine,
    orders: Iterable[float] | None = None,
    *,
    cylinder: CylinderNumber | None = None,
    fluctuation: float | None = None,
    loads: str | Iterable[str] = (),
) -> TorqueAnalysis:
    """Return the torque of gas and inertia on the crank of an engine.

    Args:
        engine: One engine with gas, not an array of variants. An uneven speed in its file is
            ignored.
        orders: Orders to show; default: all multiples of 1/2 (two-stroke engine: of 1) up to 12. If
            the engine fires more than 12 times per turn, the order equal to this number and twice
            this order are added.
        cylinder: Cylinder whose torque is shown next to the engine's torque, such as 3, or
            "upper.3" in geared engines; default: 1, or the first to fire if cylinder 1 is a dummy.
        fluctuation: Allowed fluctuation of speed, (highest - lowest)/mean; the result has the
            inertia that limits the fluctuation to this value.
        loads: "pin" (loads of crank pins), "main" (loads of main bearings), "rod" (loads along the
            piston rods), or several of them.

    Raises:
        BalcliError: The engine has no gas, the cylinder does not exist, the fluctuation is not
            between 1e-9 and 2, or a name in `loads` is unknown.
        TypeError: An argument has the wrong type.

    Example:
        >>> torque(load("i4_wiebe.toml"), fluctuation=1 / 200).flywheel.needed_kg_m2
    """
    gas = take_gas(check_engine("torque", engine))
    if cylinder is None:
        cylinder = choose_firing_cylinder(engine)
    kinds = (str, int, np.integer) if engine.placed else (int, np.integer)
    check_type("cylinder", cylinder, kinds, "give a whole number from 1")
    if fluctuation is not None:
        fluctuation = check_number("fluctuation", fluctuation, "give a number, such as 1 / 200")
    wanted = list_words("loads", loads, '["pin", "main"]')
    if strange := [word for word in wanted if word not in KINDS_OF_LOAD]:
        raise ArgumentError(
            "{loads}: {strange!r}; choose from {kinds}",
            strange=strange[0],
            kinds=", ".join(KINDS_OF_LOAD),
        )
    if wanted:
        refuse_geared(engine)
        refuse_too_many_forces(engine)
    steady = replace(engine, ripple=())
    shown = list_gas_orders(engine) if orders is None else check_orders(orders)
    row = find_row(engine, cylinder)
    curves = find_torque_curves(steady)
    above = surplus(curves.total)
    omega = float(engine.omega)
    imep = gas.work / (gas.swept if gas.has_pump_ends else float(engine.displacement_m3))
    brake_share = find_brake_share(engine, imep)
    working = [torque for torque, rows in gas.group_equal() if gas.shares[rows].any()]
    tops = [find_highest(end.pressure) for torque in working for end in torque.ends]
    highest = max(tops, key=lambda extreme: extreme.value, default=None)
    spectra = compute_spectra(steady, shown, KINDS_OF_TORQUE)
    single = compute_spectra(steady, shown, KINDS_OF_TORQUE, by_cylinder=True).select_place(row)
    idle = {"crank.inertia", *DEVICES} if wanted else {*STEADY}
    if "main" in wanted:
        idle.discard("counterweight")
    if engine.flywheel_inertia is not None:
        idle.discard("crank.inertia")
    by_order = zip(spectra.orders, list_torques(spectra), list_torques(single), strict=True)
    return TorqueAnalysis(
        speed_rpm=float(engine.speed_rpm),
        no_gas_in=engine.silent.without_gas or None,
        no_burning_in=engine.silent.without_burning or None,
        assumed=engine.list_assumed("gas", "flywheel", without=idle),
        cycle_deg=gas.cycle_deg,
        imep_Pa=imep,
        bmep_Pa=None if brake_share is None else imep * brake_share,
        max_pressure_Pa=None if highest is None else highest.value,
        max_pressure_deg=None if highest is None else float(np.degrees(highest.angle)),
        mean_torque_Nm=curves.gas.mean,
        power_W=curves.gas.mean * omega,
        torque=measure_curve(curves.total),
        ends=list_ends(engine, gas),
        orders=tuple(
            TorqueOrder(order=write_whole(n), torques=all_of_it, one_cylinder=one)
            for n, all_of_it, one in by_order
        ),
        energy=measure_energy(above, gas.cycle, curves.gas.integral),  # inertia does no work
        flywheel=find_flywheel(
            curves.gas_once,
            above.energy,
            omega,
            engine.find_constant_inertia(),
            find_moving_inertia(engine),
            fluctuation,
        ),
        loads=analyze_loads(engine, wanted) if wanted else None,
        name=engine.name,
        curve=curves.total,
        engine=engine,
        spectra=spectra,
        cylinder=cylinder,
    )
