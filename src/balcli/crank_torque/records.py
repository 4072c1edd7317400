"""Define the records of the torque on the crank, which are the result of `balcli torque` and
`torque`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

from ..core.piecewise import PiecewiseCurve
from ..core.records import HIDDEN, INLINE, Asked
from ..core.shaft_speed import Surplus
from ..engine.engine import CylinderNumber, Engine
from ..file.assumed import Assumed
from ..file.fields import order_number
from ..forces.spectrum import Spectra
from ..show.figures import Harmonic, list_harmonics
from ..show.result import Result
from .ends import End
from .flywheel import Flywheel, degrees_in_cycle
from .loads import CycleLoads


class Torques(NamedTuple):
    """Torques of one order.

    Attributes:
        inertia_torque_Nm: Torque of the inertia.
        gas_torque_Nm: Torque of the gas.
        torque_Nm: Torque of inertia and gas together, or of the given curve.
    """

    inertia_torque_Nm: Harmonic | None = None
    gas_torque_Nm: Harmonic | None = None
    torque_Nm: Harmonic | None = None


class TorqueOrder(NamedTuple):
    """Torques of one order: of the engine and of one cylinder.

    Attributes:
        order: Order, in multiples of the crank speed.
        torques: Torques of the engine.
        one_cylinder: Torques of the chosen cylinder.
    """

    order: float
    torques: Annotated[Torques, INLINE]
    one_cylinder: Torques | None = None


class Extremes(NamedTuple):
    """Largest and smallest torque over a cycle.

    Attributes:
        max_Nm: Largest torque.
        max_deg: Crank angle of the largest torque.
        min_Nm: Smallest torque.
        min_deg: Crank angle of the smallest torque.
        reversals: Number of sign changes over the cycle.
    """

    max_Nm: float
    max_deg: float
    min_Nm: float
    min_deg: float
    reversals: int


class Energy(NamedTuple):
    """Surplus energy: work of the torque minus work of the mean torque, between two crank angles.

    Attributes:
        surplus_J: Largest surplus energy.
        from_deg: Crank angle at which the surplus begins and the crank is slowest.
        to_deg: Crank angle at which the surplus ends and the crank is fastest.
        work_J: Work of the torque in one cycle.
    """

    surplus_J: float
    from_deg: float
    to_deg: float
    work_J: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class TorqueAnalysis(Result):
    """Torque on the crank of an engine, or a given torque curve, over the cycle at the mean speed.

    Attributes:
        speed_rpm: Mean speed.
        no_gas_in: Cylinders without gas force.
        no_burning_in: Cylinders that compress and expand their charge without burning it.
        assumed: Values assumed because the engine file leaves them out.
        cycle_deg: Length of the engine's cycle or of the curve's period.
        imep_Pa: Indicated mean effective pressure: work of all cylinders divided by displacement
            (by the swept volume of all ends); negative where the machine takes work.
        bmep_Pa: Brake mean effective pressure.
        ends: Gas in the ends of all cylinders; left out unless a cylinder has a crank end or a
            compressor cycle.
        max_pressure_Pa: Highest pressure in any cylinder that has gas.
        max_pressure_deg: Cycle angle of the highest pressure, from the firing dead centre.
        mean_torque_Nm: Indicated mean torque.
        power_W: Indicated power; negative where the machine takes power.
        torque: Largest and smallest torque.
        orders: Torque by order.
        energy: Surplus energy of the torque.
        flywheel: Inertia and uneven speed; left out if neither an inertia is given nor a
            fluctuation requested.
        loads: Requested loads of pins and bearings.
        name: Name of the engine or curve.
        curve: Torque of gas and inertia, or the given curve, N m, over the crank angle (rad).
        engine: Analyzed engine; None for a given curve.
        spectra: Gas, inertia and total torque of the engine by order.
        cylinder: Number of the cylinder whose torques `orders` contains.
        load_Nm: Mean of the given load, and the constant load that is added to it, N m. Both
            together equal the mean torque.
    """

    format: Literal["balcli.torque/1"] = "balcli.torque/1"
    speed_rpm: float | None = None
    no_gas_in: tuple[CylinderNumber, ...] | None = None
    no_burning_in: tuple[CylinderNumber, ...] | None = None
    assumed: tuple[Assumed, ...] | None = None
    cycle_deg: float
    imep_Pa: float | None = None
    bmep_Pa: float | None = None
    max_pressure_Pa: float | None = None
    max_pressure_deg: float | None = None
    mean_torque_Nm: float
    power_W: float | None = None
    torque: Extremes
    ends: tuple[End, ...] | None = None
    orders: tuple[TorqueOrder, ...]
    energy: Energy
    flywheel: Asked[Flywheel] = Asked(
        "fluctuation=1 / 200, or with inertia in [crank] or [flywheel] of the file"
    )
    loads: Asked[CycleLoads] = Asked('loads=["pin", "main"]')
    name: Annotated[str, HIDDEN]
    curve: Annotated[PiecewiseCurve, HIDDEN]
    engine: Annotated[Engine | None, HIDDEN] = None
    spectra: Annotated[Spectra | None, HIDDEN] = None
    cylinder: Annotated[CylinderNumber, HIDDEN] = 0
    load_Nm: Annotated[tuple[float, float] | None, HIDDEN] = None

    @property
    def summary(self) -> str:
        """Name of the engine or curve, and its mean torque, in words."""
        of = self.name if self.engine is None else self.engine.summary
        return f"of {of}; mean {self.mean_torque_Nm:.4g} N m"


def find_brake_share(engine: Engine, imep_Pa: float) -> float | None:
    """Return brake work over indicated work: the mechanical efficiency, or its inverse where the
    machine takes work. None if the file gives no efficiency.
    """
    efficiency = engine.mechanical_efficiency
    if efficiency is None or imep_Pa >= 0:
        return efficiency
    return 1 / efficiency


def measure_curve(torque: PiecewiseCurve) -> Extremes:
    """Return the extremes of a torque (N m)."""
    lowest, highest = (
        (extreme.value, degrees_in_cycle(extreme.angle, torque.period))
        for extreme in torque.extremes()
    )
    return Extremes(*highest, *lowest, torque.reversals())


def measure_energy(surplus: Surplus, period: float, work: float) -> Energy:
    """Return the record of a surplus, given the period (rad) and the work in a period (J)."""
    start, end = (degrees_in_cycle(at, period) for at in (surplus.start, surplus.end))
    return Energy(surplus_J=surplus.energy, from_deg=start, to_deg=end, work_J=work)


def list_torques(spectra: Spectra) -> list[Torques]:
    """Return the torques of every order."""
    kinds = {kind.key: list_harmonics(phasors) for kind, phasors in spectra.items()}
    rows = zip(*kinds.values(), strict=True)
    return [Torques(**dict(zip(kinds, row, strict=True))) for row in rows]


def write_whole(value: float) -> float | int:
    """Return a number rounded to 1e-9, as an int if it is whole."""
    return order_number(round(float(value), 9))
