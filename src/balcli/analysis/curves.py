"""Compute curves over the crank angle of an engine or of one of its cylinders, with gas if the
engine has some; and define the result `Curves` and its output formats.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Literal

import numpy as np

from ..core.phasors import EPS, Array, Complex, compose, unit
from ..core.records import HIDDEN
from ..engine.engine import CylinderNumber, Engine, Placed, check_engine, find_crank
from ..errors import ArgumentError, check_number
from ..file.assumed import Assumed
from ..forces.curves import (
    EngineMotion,
    as_rows,
    compute_device_forces,
    compute_piecemeal,
    divide_revolution,
    torque_of_cylinders,
)
from ..forces.kinds import (
    COUPLE,
    EVERY_KIND,
    FORCE,
    FREE,
    GAS,
    KINDS,
    MOMENT,
    ROLL,
    ROLL_TOTAL,
    TORQUE,
    TORQUE_TOTAL,
    Kind,
)
from ..forces.rod_forces import compute_rod_forces
from ..forces.spectrum import (
    check_orders,
    compute_spectra,
    take_gas,
)
from ..shell.arguments import check_count
from ..show.formats import Columnar, Columns, Rows
from ..show.result import Result

_MOMENTS = [MOMENT.key_along(axis) for axis in ("x", "y", *MOMENT.upright)]

_EVERYWHERE = np.arange(0.0, 360.0, 15.0)  # crank angles at which sizes of terms are estimated, deg


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Curves(Result):
    """Figures over the crank angle.

    Attributes:
        engine: Name of the engine.
        speed_rpm: Crank speed.
        crank_deg: Crank angles, shape (angles,).
        curves: Figures by name with unit (`force_x_N`), each of the shape of `crank_deg`.
        assumed: Values that are used because the engine file leaves them out. If `crank.spacing` is
            one of them, moments are computed as if all throws were in one plane.
        moments_known: Whether the engine file gives the positions of the throws.
    """

    format: Literal["balcli.curves/1"] = "balcli.curves/1"
    engine: str
    speed_rpm: float
    crank_deg: Array
    curves: Mapping[str, Array]
    assumed: tuple[Assumed, ...] | None = None
    moments_known: Annotated[bool, HIDDEN] = True

    @property
    def summary(self) -> str:
        """Name of the engine and number of angles, in words."""
        return f"of {self.engine or 'an engine'}: {len(self.crank_deg)} crank angles"


def compute_engine_curves(engine: Engine, crank_deg: Array) -> dict[str, Array]:
    """Return free force (N), moment, couple, inertia torque and roll (N m) of an engine with its
    devices; force and moment also as vertical and horizontal components, if `frame.up` is given.

    Args:
        engine: One engine, not an array of variants.
        crank_deg: Crank angles, shape (angles,).
    """
    curves = _sum_parts(engine, crank_deg, lambda angles: _compute_engine_parts(engine, angles))
    return curves | _find_upright(engine, curves)


def compute_order_curves(
    engine: Engine, orders: Iterable[float], crank_deg: Array
) -> dict[str, Array]:
    """Return the curves of `compute_engine_curves`, with gas if the engine has some, but as sums of
    only the given orders.

    Args:
        engine: One engine, not an array of variants.
        orders: Orders to add up, multiples of 1/2.
        crank_deg: Crank angles, shape (angles,).

    Raises:
        BalcliError: A number is not a multiple of 1/2 from 0 to 4096.
    """
    kinds = EVERY_KIND if engine.gas is not None else KINDS
    spectra = compute_spectra(engine, check_orders(orders), tuple(kinds))
    curves: dict[str, Array] = {}
    for kind, phasors in spectra.items():
        values = phasors.values(np.radians(crank_deg))
        most = float(phasors.major.sum())
        curves[kind.key_along("x") if kind.vector else kind.key] = _settle(values.real, most)
        if kind.vector:
            curves[kind.key_along("y")] = _settle(values.imag, most)
    return curves | _find_upright(engine, curves)


def _find_upright(engine: Engine, curves: Mapping[str, Array]) -> dict[str, Array]:
    """Return the vertical and horizontal components of the curves of force and moment; empty if the
    file does not give `frame.up`.
    """
    upright: dict[str, Array] = {}
    if engine.up_deg is None:
        return upright
    for kind in FREE:
        x, y = (curves[kind.key_along(axis)] for axis in "xy")
        turned = unit(-engine.up_deg) * compose(x, y)
        most = float(np.abs(turned).max(initial=0))
        for word, part in zip(kind.upright, (turned.real, turned.imag), strict=True):
            upright[kind.key_along(word)] = _settle(part, most)
    return upright


def compute_cylinder_curves(
    engine: Engine, number: CylinderNumber, crank_deg: Array
) -> dict[str, Array]:
    """Return piston travel from top dead centre (m), velocity and acceleration away from top dead
    centre (m/s, m/s2) and rod angle (deg) of one cylinder.

    Args:
        engine: One engine, not an array of variants.
        number: Number of the cylinder.
        crank_deg: Crank angles, shape (angles,).

    Raises:
        BalcliError: The engine has no such cylinder.
    """
    crank, row = find_crank(engine, number)

    def compute(angles: Array) -> dict[str, Array]:
        return _compute_cylinder_parts(crank.engine, row, angles + crank.phase_deg)

    return _sum_parts(engine, crank_deg, compute)


def _sum_parts(
    engine: Engine, crank_deg: Array, compute: Callable[[Array], dict[str, Array]]
) -> dict[str, Array]:
    """Return the sum of the terms of each curve; a sum within the rounding error of its terms is 0.

    Args:
        engine: Engine.
        crank_deg: Crank angles, shape (angles,).
        compute: Function that returns the terms at some angles, by name, each of shape (terms,
            angles).
    """

    def add_up(angles: Array) -> dict[str, Array]:
        return {name: parts.sum(axis=0) for name, parts in compute(angles).items()}

    noise = {}
    for name, parts in compute(_EVERYWHERE).items():
        noise[name] = 8 * len(parts) * EPS * float(np.abs(parts).sum(axis=0).max())
    sums = compute_piecemeal(engine, crank_deg, add_up)
    for name, curve in sums.items():
        sums[name] = np.where(np.abs(curve) <= noise[name], 0.0, curve)
    return sums


def _compute_engine_parts(engine: Engine, crank_deg: Array) -> dict[str, Array]:
    """Return the terms of each curve: those of cylinders and devices of every crank, shape
    (terms, angles).
    """
    of_cranks: dict[str, list[Array]] = {}
    for crank in engine.cranks:
        for name, parts in _compute_crank_parts(crank, crank_deg + crank.phase_deg).items():
            of_cranks.setdefault(name, []).append(parts)
    return {name: np.concatenate(parts) for name, parts in of_cranks.items()}


def _compute_crank_parts(crank: Placed, crank_deg: Array) -> dict[str, Array]:
    """Return the terms of each curve for one crank, in the axes of the whole engine, shape (terms,
    angles).

    Args:
        crank: Engine with this crank, one of several engines or the only one.
        crank_deg: Angles of this crank, shape (angles,).
    """
    engine = crank.engine
    motion = EngineMotion(engine, crank_deg)
    of_devices = compute_device_forces(engine, crank_deg)
    own_force = np.concatenate([_force_of_cylinders(motion), of_devices])
    x, y, z = engine.reference_m
    levels = np.array([*np.ravel(engine.cylinders.z), *(d.z for d in engine.devices)], float)
    moment = crank.turn_axial(1j * (levels - float(z))[:, None] * own_force)
    force = crank.turn(own_force)
    on_crank = np.zeros(engine.cylinders.count)
    places = np.concatenate([on_crank, [d.place for d in engine.devices]]) - (x + 1j * y)
    arms = (np.conj(places)[:, None] * own_force).imag
    turning = engine.find_turning_inertia(beyond_pins=True)
    momentum, energy = (-inertia * motion.xi[None] for inertia in turning)
    couple = crank.ratio * np.concatenate([_couple_of_cylinders(motion), arms, momentum])
    torque = np.concatenate([torque_of_cylinders(motion), energy])
    curves = {
        FORCE.key_along("x"): force.real,
        FORCE.key_along("y"): force.imag,
        MOMENT.key_along("x"): moment.real,
        MOMENT.key_along("y"): moment.imag,
    }
    parts = {COUPLE.name: couple, TORQUE.name: torque}
    on_frame = {COUPLE.name: couple, TORQUE.name: crank.load_sense * torque}
    for kind in KINDS.values():
        if parts.keys() >= {*kind.parts}:
            curves[kind.key] = _join_terms(kind, parts if kind.on_crank else on_frame)
    return curves


def _join_terms(kind: Kind, parts: Mapping[str, Array]) -> Array:
    """Return the terms of a kind from those of its parts, shape (terms, angles)."""
    terms = [parts[name] for name in kind.plus or (kind.name,)]
    terms += [-parts[name] for name in kind.minus]
    return np.concatenate(terms)


def _compute_cylinder_parts(engine: Engine, row: int, crank_deg: Array) -> dict[str, Array]:
    """Return the terms of the motion of the cylinder in this row, each of shape (terms, angles)."""
    motion = EngineMotion(engine, crank_deg)
    m = motion.moved
    r = float(engine.cylinders.radius_of_each[row])
    v = -m.velocity[row]
    a = -m.acceleration[row]
    angles = np.broadcast_to(np.arctan2(m.lean, m.cosine), motion.psi.shape)
    # spin is positive in the sense of the crank, against which the rod's angle increases
    slope = 0.0 - np.broadcast_to(m.spin, motion.psi.shape)[row]
    slope_rate = 0.0 - np.broadcast_to(m.spin_rate, motion.psi.shape)[row]
    return {
        "travel_m": r * motion.travel()[row : row + 1],
        "velocity_m_per_s": (r * motion.omega * v)[None],
        "acceleration_m_per_s2": r * np.array([motion.omega**2 * a, motion.xi * v]),
        "rod_angle_deg": np.degrees(angles[row : row + 1]),
        "rod_speed_rad_per_s": (motion.omega * slope)[None],
        "rod_acceleration_rad_per_s2": np.array([motion.omega**2 * slope_rate, motion.xi * slope]),
    }


def _force_of_cylinders(motion: EngineMotion) -> Complex:
    """Return the free force of each cylinder, N, shape (cylinders, angles)."""
    c = motion.cylinders
    r = motion.radius
    w2 = motion.omega**2
    xi = motion.xi
    m = motion.moved
    on_axis = -as_rows(c.reciprocating) * r * (w2 * m.acceleration + xi * m.velocity)
    on_curve = motion.mass * r * (w2 * m.acceleration_of_mass + xi * m.velocity_of_mass)
    piston = (on_axis - on_curve) * motion.axis
    pins = as_rows(c.rotating) * r * (w2 - 1j * xi) * unit(motion.pin_deg)
    return piston + pins


def _couple_of_cylinders(motion: EngineMotion) -> Array:
    """Return the free couple of each cylinder about the crank's axis, N m, shape (cylinders,
    angles), from the moment of momentum at unit crank speed, h = -m_rec e s' + m_rot r^2 - H spin
    (+ masses of the linkage). m_rec is the reciprocating mass, e the offset of the cylinder, s' the
    derivative of the piston's distance from the crank axis by the crank angle, m_rot the mass that
    turns at the crank radius r, H the couple constant of the rod, and spin the rod's angular
    velocity.
    """
    c = motion.cylinders
    r = motion.radius
    m = motion.moved
    pull = as_rows(c.reciprocating) * as_rows(c.offset) * r
    on_curve = motion.mass * r**2
    couple = as_rows(c.couple)
    h = as_rows(c.rotating) * r**2 - pull * m.velocity - couple * m.spin + on_curve * m.swirl
    slope = on_curve * m.swirl_rate - pull * m.acceleration - couple * m.spin_rate
    return np.asarray(-(motion.omega**2 * slope + motion.xi * h))


_ROUNDING = 1e-14


def _find_gas_torque(engine: Engine, crank_deg: Array) -> dict[str, Array]:
    """Return two curves, N m, shape (angles,): the gas torque on the cranks and, as "borne", the
    gas torque on the loads of the cranks; the frame carries the opposite of the second one.
    """
    at = np.radians(crank_deg)
    torques = [c.share * c.torque.curve.at(at - c.fires) for c in take_gas(engine).cylinders]
    senses = [one.load_sense for one in engine.cranks for _ in one.engine.numbers]
    borne = (sense * torque for sense, torque in zip(senses, torques, strict=True))
    return {GAS.key: sum(torques, np.zeros(at.shape)), "borne": sum(borne, np.zeros(at.shape))}


def _find_cylinder_gas(engine: Engine, row: int, crank_deg: Array) -> dict[str, Array]:
    """Return curves of the cylinder in this row, each of shape (angles,): pressure (Pa), volume
    (m3), gas force, side thrust, force along the rod, force on the crank or knuckle pin along and
    across the cylinder (N), and torque of gas and inertia (N m). Unknown curves are omitted.

    Forces across the cylinder are positive towards the side to which the crank pin moves after top
    dead centre. (In a rotary engine, this side is behind the turning cylinder.)
    """
    curves: dict[str, Array] = {}
    gas = take_gas(engine)
    cylinder = gas.cylinders[row]
    at = np.radians(crank_deg) - cylinder.fires
    if cylinder.torque.pressure is not None:
        forces = compute_rod_forces(engine, crank_deg)
        side = -1 if engine.rotary else 1
        curves["pressure_Pa"] = forces.pressure[row]
        if gas.compression_ratio is not None:
            curves["volume_m3"] = cylinder.piston.volume(at, gas.compression_ratio)
        curves |= {
            "gas_force_N": forces.gas[row],
            "side_thrust_N": side * forces.thrust[row],
            "rod_force_N": forces.rod[row],
            "pin_x_N": forces.pin[row].real,
            "pin_y_N": side * forces.pin[row].imag,
        }
    inertia = torque_of_cylinders(EngineMotion(engine, crank_deg))[row]
    curves["torque_Nm"] = inertia + cylinder.share * cylinder.torque.curve.at(at)
    if cylinder.torque.is_double_acting:
        curves |= _find_crank_end(engine, row, crank_deg)
    return curves


def _find_crank_end(engine: Engine, row: int, crank_deg: Array) -> dict[str, Array]:
    """Return the pressure at the crank end (Pa) and the loads of piston rod and pin (N, positive in
    compression; `forces.rod_loads`) of the cylinder in this row, each of shape (angles,).
    """
    cylinder = take_gas(engine).cylinders[row]
    at = np.radians(crank_deg) - cylinder.fires
    forces = compute_rod_forces(engine, crank_deg)
    weighed = engine.weighed[row]
    rod_load = forces.gas[row] + weighed.piston * forces.acceleration[row]
    return {
        "pressure_crank_end_Pa": cylinder.torque.ends[1].pressure.at(at),
        "rod_load_N": rod_load,
        "pin_load_N": rod_load + weighed.crosshead * forces.acceleration[row],
    }


def _settle(values: Array, most: float | None = None) -> Array:
    """Return the values; those within the rounding error of the largest (or of `most`) are 0."""
    largest = np.abs(values).max(initial=0) if most is None else most
    return np.where(np.abs(values) <= _ROUNDING * largest, 0.0, values)


def curves(
    engine: Engine,
    step: float = 1.0,
    *,
    cylinder: int | str | None = None,
    orders: Iterable[float] | None = None,
) -> Curves:
    """Return force, moment, couple, torque and roll over the crank angle, or the motion of one
    piston.

    Args:
        engine: Engine from `load`.
        step: Step of the crank angle, deg, which runs from 0 over a revolution, or with gas over a
            cycle.
        cylinder: Number of a cylinder; for geared engines after the engine's name, as in "upper.3".
            Then the travel, velocity and acceleration of its piston and the angle of its rod are
            returned, and with gas also pressure and forces. Default: curves of the whole engine.
        orders: Orders of the whole engine to add up; default: all.

    Returns:
        `crank_deg` and, by name with unit (`force_x_N`), `curves` of the same shape (angles,).
        Forces of a cylinder are positive outward along its axis, and across it towards the side to
        which the crank pin moves after top dead centre; travel is positive towards the crank
        (docs/json.md).

    Raises:
        BalcliError: The step is too small or too large, or there is no such cylinder.
        TypeError: `engine` is not an Engine.

    Example:
        >>> curves(load("i4.toml"), 10).to_pandas()
    """
    engine = check_engine("curves", engine)
    step_deg = check_number("step", step, "give a step in degrees")
    number = cylinder
    if cylinder is not None and not isinstance(cylinder, str):
        number = check_count("cylinder", cylinder)
    return compute_curves_by_step(engine, number, step_deg, orders)


def compute_curves_by_step(
    engine: Engine,
    cylinder: CylinderNumber | None,
    step_deg: float,
    orders: Iterable[float] | None = None,
) -> Curves:
    """Return the curves at equal steps over a cycle; errors as for `curves`.

    Args:
        engine: One engine, not an array of variants.
        cylinder: Number of the cylinder whose motion is wanted; None: the whole engine.
        step_deg: Step of the crank angle, deg.
        orders: Orders whose sum is wanted; None: all.
    """
    crank_deg = divide_revolution(step_deg, engine.cycle_revolutions)
    if orders is not None:
        if cylinder is not None:
            raise ArgumentError("{orders} needs the whole engine; leave {cylinder} out")
        curves = compute_order_curves(engine, orders, crank_deg)
    elif cylinder is not None:
        curves = compute_cylinder_curves(engine, cylinder, crank_deg)
        crank, row = find_crank(engine, cylinder)
        if crank.engine.gas is not None:
            find_gas = partial(_find_cylinder_gas, crank.engine, row)
            of_gas = compute_piecemeal(engine, crank_deg + crank.phase_deg, find_gas)
            curves |= {name: _settle(curve) for name, curve in of_gas.items()}
    else:
        curves = compute_engine_curves(engine, crank_deg)
        if engine.gas is not None:
            of_gas = compute_piecemeal(engine, crank_deg, partial(_find_gas_torque, engine))
            curves[GAS.key] = _settle(of_gas[GAS.key])
            curves[TORQUE_TOTAL.key] = curves[TORQUE.key] + curves[GAS.key]
            curves[ROLL_TOTAL.key] = curves[ROLL.key] - _settle(of_gas["borne"])
    return Curves(
        engine=engine.name,
        speed_rpm=float(engine.speed_rpm),
        crank_deg=crank_deg,
        curves=curves,
        assumed=engine.list_assumed() if cylinder is None else None,
        moments_known=engine.places_known,
    )


def columns(curves: Curves) -> Columns:
    """Return crank angles and each quantity that is known; names include units."""
    unknown = () if curves.moments_known else _MOMENTS
    known = {name: values for name, values in curves.curves.items() if name not in unknown}
    return Columns({"crank_deg": curves.crank_deg, **known})


def rows(curves: Curves) -> Rows:
    """Return the rows of CSV: a line for each crank angle, a column for each known quantity."""
    found = columns(curves).values
    return Rows(tuple(found), np.column_stack([*found.values()]).tolist())


RENDERER = Columnar(columns=columns)
