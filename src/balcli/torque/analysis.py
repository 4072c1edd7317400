"""Torque of an engine: by order and over the cycle, its means and extremes, and the flywheel."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..core.cylinder_pressure import PressureOnPiston
from ..core.phasors import Array
from ..core.piecewise import Extreme
from ..core.speed_variation import Surplus, surplus
from ..engine.build import Engine, check_engine, find_row
from ..errors import BalcliError, check_number, check_type, list_words
from ..forces.gas import take_gas
from ..forces.orders import check_orders, list_gas_orders
from ..forces.spectrum import Spectra, compute_each_cylinder, compute_spectra
from ..limits import SMALLEST_FLUCTUATION
from ..result import Result
from .course import TorqueCurves, find_constant_inertia, find_moving_inertia, find_torque_curves
from .flywheel import Flywheel, FlywheelQuestion, find_flywheel
from .loads import KINDS_OF_LOAD, CycleLoads

KINDS_OF_TORQUE = ("gas", "torque", "torque_total")


@dataclass(frozen=True, eq=False, repr=False)
class TorqueAnalysis(Result):
    """What turns the crank of an engine, at its mean speed.

    Attributes:
        engine: as analysed.
        spectra: gas, inertia and total torque of the engine by order.
        cylinder: number of the cylinder that is looked at.
        single: the same of that cylinder alone, with its share.
        curves: over the cycle.
        imep: work of all cylinders over the swept volume of all, Pa.
        max_pressure: highest in any cylinder that has gas, Pa, at a cycle angle (rad); None where
            pressures are not known.
        surplus: of the total torque above its mean.
        flywheel: None where the file gives no inertia and none was asked for.
        loads: of pins and bearings, as far as they were asked for.
    """

    engine: Engine
    spectra: Spectra
    cylinder: int
    single: Spectra
    curves: TorqueCurves
    imep: float
    max_pressure: Extreme | None
    surplus: Surplus
    flywheel: Flywheel | None
    loads: CycleLoads

    @property
    def summary(self) -> str:
        """Of what, and its mean torque."""
        return f"of {self.engine.summary}; mean {self.mean_torque:.4g} N m"

    @property
    def orders(self) -> Array:
        """Those shown, shape (orders,)."""
        return self.spectra.orders

    @property
    def mechanical_efficiency(self) -> float | None:
        """Brake over indicated work, as the engine has it."""
        return self.engine.mechanical_efficiency

    @property
    def bmep(self) -> float | None:
        """Brake mean effective pressure, Pa; None where there is no mechanical efficiency."""
        efficiency = self.mechanical_efficiency
        return None if efficiency is None else self.imep * efficiency

    @property
    def mean_torque(self) -> float:
        """Indicated, N m."""
        return self.curves.gas.mean

    @property
    def power(self) -> float:
        """Indicated, W."""
        return self.mean_torque * float(self.engine.omega)

    @property
    def cycle_deg(self) -> int:
        """720, or 360 of a two-stroke engine."""
        return take_gas(self.engine).cycle_deg


def analyze_torque(
    engine: Engine,
    orders: Iterable[float] | None = None,
    *,
    cylinder: int = 1,
    fluctuation: float | None = None,
    loads: str | Iterable[str] = (),
) -> TorqueAnalysis:
    """Torque of gas and inertia on the crank of an engine.

    Args:
        engine: with gas, without trailing axes. An uneven speed in its file does not count here.
        orders: which to show; default: halves to 12, of a two-stroke engine whole ones; of many
            cylinders also the order of their firing and its double.
        cylinder: whose torque is shown beside the engine's.
        fluctuation: (highest - lowest)/mean speed, for which the inertia is wanted.
        loads: "pin" (of crank pins), "main" (of main bearings), or both.

    Raises:
        BalcliError: no gas; no such cylinder; a fluctuation that is not between 1e-9 and 2; loads
            that are not known.
        TypeError: what is no engine, no number, no words.

    Example:
        >>> analyze_torque(load("i4_wiebe.toml"), fluctuation=1 / 200).flywheel.needed
    """
    gas = take_gas(check_engine("analyze_torque", engine))
    check_type("cylinder", cylinder, (int, np.integer), "give a whole number from 1")
    if fluctuation is not None:
        fluctuation = check_number("fluctuation", fluctuation, "give a number, as 1 / 200")
        if not SMALLEST_FLUCTUATION <= fluctuation < 2:
            raise BalcliError(
                f"fluctuation {fluctuation:g}: give (highest - lowest)/mean speed, such as 1 / 200"
            )
    wanted = list_words("loads", loads, '["pin", "main"]')
    if strange := [word for word in wanted if word not in KINDS_OF_LOAD]:
        raise BalcliError(f"loads: {strange[0]!r}; choose from {', '.join(KINDS_OF_LOAD)}")
    steady = replace(engine, ripple=())
    shown = list_gas_orders(engine) if orders is None else check_orders(orders)
    row = find_row(engine, cylinder, "--cylinder")
    curves = find_torque_curves(steady)
    above = surplus(curves.total)._replace(work=curves.gas.integral)  # inertia does none
    swept = sum(c.piston.swept for c in gas.cylinders)
    asked = FlywheelQuestion(
        curves.gas_once,
        above.energy,
        float(engine.omega),
        find_constant_inertia(engine),
        find_moving_inertia(engine),
        fluctuation,
    )
    return TorqueAnalysis(
        engine,
        compute_spectra(steady, shown, KINDS_OF_TORQUE),
        cylinder,
        compute_each_cylinder(steady, shown, KINDS_OF_TORQUE).select_place(row),
        curves,
        sum(c.share * c.torque.work for c in gas.cylinders) / swept,
        _find_highest(engine),
        above,
        find_flywheel(asked),
        _find_loads(engine, tuple(wanted)),
    )


def _find_loads(engine: Engine, asked: tuple[str, ...]) -> CycleLoads:
    if not asked:
        return CycleLoads()
    from .find_loads import analyze_loads

    return analyze_loads(engine, asked)


def _find_highest(engine: Engine) -> Extreme | None:
    """The highest pressure of all cylinders whose gas does something, in the first that has it."""
    gas = take_gas(engine)
    torques = [torque for torque, rows in gas.group_equal() if gas.shares[rows].any()]
    found = [t.pressure.highest() for t in torques if isinstance(t, PressureOnPiston)]
    return max(found, key=lambda extreme: extreme.value, default=None)


def degrees_in_cycle(angle: float, cycle_deg: float) -> float:
    """A crank angle (rad) in [0, cycle) deg."""
    turned = float(np.degrees(angle)) % cycle_deg
    return 0.0 if cycle_deg - turned < 1e-9 else turned
