"""[torsion] of an engine file and the engine -> torsional system: a node for each throw, with the
mean inertia of what moves on it, and one for each part before and behind.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.loads import find_inertia, find_needed_series
from ..core.speeds import RPM
from ..core.torsional_chain import ChainShaft
from ..core.vibration import Real
from ..engine.build import Engine
from ..enginefile.fields import counted, printable, shorten, suggest_nearest
from ..enginefile.model import EngineFile
from ..enginefile.shafting import find_stiffness
from ..enginefile.torsion_tables import Part, Torsion
from ..errors import InputError, Problem
from ..forces.orders import list_gas_orders
from ..forces.spectrum import compute_each_cylinder
from ..limits import HIGHEST_TORSION_ORDER, HIGHEST_TORSION_ORDER_UNASKED
from .assembly import PlannedNode, PlannedShaft, assemble_system, find_section
from .system import Excitation, ShaftSection, TorsionalSystem


class _Joint(NamedTuple):
    """A part and the name of what it hangs on; `path` is its place in the file."""

    path: str
    part: Part
    of: str


def build_engine_system(
    model: EngineFile, engine: Engine, excitation: Excitation, name: str = ""
) -> TorsionalSystem:
    """The system of an engine.

    Args:
        model: its file, which has [torsion].
        engine: of this file.
        excitation: by its cylinders, as of `excite_engine`.
        name: of the file, for messages.

    Raises:
        InputError: what does not fit together in [torsion], by its path.
    """
    torsion = model.torsion
    if torsion is None:
        hint = "write [torsion] with throw_stiffness and throw_inertia, and [[torsion.rear]]"
        raise InputError([Problem.of_missing("torsion", hint)], name)
    throws = len(engine.throws_m)
    problems = list(_find_misfits(torsion, model, engine, throws))
    if problems:
        raise InputError(problems, name)
    nodes = [
        *map(_plan_part, reversed(torsion.front)),
        *_plan_throws(torsion, engine, throws),
        *map(_plan_part, torsion.rear),
    ]
    leading = list(_lead_shafts(torsion, [node.name for node in nodes], throws))
    front = len(torsion.front)
    shafts = [*reversed(leading[:front]), *_join_throws(torsion, front, throws), *leading[front:]]
    own_speed = "speed" in model.operation.model_fields_set
    rated = model.operation.speed if own_speed else None
    return assemble_system(
        nodes,
        shafts,
        (torsion.limit, torsion.angle_limit),
        name=engine.name,
        excitation=excitation,
        rated_rpm=rated,
        reference=front,
        silent=engine.silent,
        file=name,
    )


def _plan_part(part: Part) -> PlannedNode:
    return PlannedNode(part.name, (part.inertia or 0.0) / 1e6, part.node_damping, part.damper)


def _plan_throws(torsion: Torsion, engine: Engine, throws: int) -> Iterator[PlannedNode]:
    """A node for each throw, with what runs on it and the damping of every cylinder."""
    gear, on_throw = weigh_running_gear(engine), [weighed.throw for weighed in engine.weighed]
    bare = _weigh_throws(torsion, engine, throws)
    for throw, name in enumerate(_name_throws(throws)):
        here = np.equal(on_throw, throw)
        inertia = bare[throw] + float(gear[here].sum())
        yield PlannedNode(name, inertia, torsion.damping * int(here.sum()))


def _join_throws(torsion: Torsion, front: int, throws: int) -> Iterator[PlannedShaft]:
    """The shafts between neighbouring throws, the first of which is the node `front`."""
    section = None
    if torsion.throw_diameter is not None:
        section = ShaftSection(torsion.throw_diameter / 1e3, (torsion.throw_bore or 0.0) / 1e3)
    stiffnesses = _each(torsion.throw_stiffness or (), throws - 1)
    for k, (name, stiffness) in enumerate(zip(_name_between(throws), stiffnesses, strict=True)):
        shaft = ChainShaft(front + k, front + k + 1, stiffness)
        yield PlannedShaft(name, shaft, torsion.loss, section=section)


def _lead_shafts(torsion: Torsion, names: Sequence[str], throws: int) -> Iterator[PlannedShaft]:
    """Shaft of every part, front ones first, from what it hangs on, stiff in its own speed."""
    joints = _join_parts(torsion, throws)
    gears = _find_gears(joints, throws)
    for _, part, of in joints:
        ends, ratio = (names.index(of), names.index(part.name)), gears[part.name] / gears[of]
        loss = torsion.loss if part.loss is None else part.loss
        shaft = ChainShaft(*ends, find_stiffness(part), ratio)
        yield PlannedShaft(part.name, shaft, loss, part.damping, find_section(part))


def _name_throws(throws: int) -> list[str]:
    return [f"throw {k}" for k in range(1, throws + 1)]


def _name_between(throws: int) -> list[str]:
    return [f"throw {k}-{k + 1}" for k in range(1, throws)]


def _each(values: Sequence[float], count: int) -> list[float]:
    """One value for each of so many, from one for all or a list."""
    return list(values) * count if len(values) == 1 else list(values)


def _join_parts(torsion: Torsion, throws: int) -> list[_Joint]:
    """Every part with what it hangs on: front parts first, each list outward."""
    found = []
    for key, parts, throw in (("front", torsion.front, 1), ("rear", torsion.rear, throws)):
        before = f"throw {throw}"
        for k, part in enumerate(parts, 1):
            found.append(_Joint(f"torsion.{key}.{k}", part, part.of or before))
            before = part.name
    return found


def _find_gears(joints: Sequence[_Joint], throws: int) -> dict[str, float]:
    """Speed of every node over that of the crank, by name."""
    gears = dict.fromkeys(_name_throws(throws), 1.0)
    waiting = list(joints)
    while waiting:
        for joint in waiting:
            if joint.of in gears:
                own = joint.part.gear
                gears[joint.part.name] = gears[joint.of] if own is None else own
        left = [joint for joint in waiting if joint.part.name not in gears]
        if len(left) == len(waiting):
            break
        waiting = left
    return gears


# ------------------------------------------------------------------ inertia and excitation
def weigh_running_gear(engine: Engine) -> Real:
    """Mean moment of inertia (cylinders,) in kg m2 of what each cylinder moves, without the throw:
    `m_rot r^2 + mean(m_rec s'^2 - H beta'^2)`.
    """
    c = engine.cylinders
    mean_only = np.zeros(1)
    series = find_needed_series(c, {"torque"}, uneven=False)
    few, which = c.find_distinct_harmonics(mean_only, series)
    moving = find_inertia(c, few.select_cylinders(which), 1.0).c[0].real
    own = np.array([float(weighed.share) for weighed in engine.weighed])
    turning = (c.rotating - own) * c.radius**2
    return np.broadcast_to(moving, own.shape) + np.broadcast_to(turning, own.shape)


def _weigh_throws(torsion: Torsion, engine: Engine, throws: int) -> Sequence[float]:
    """Moment of inertia of the crankshaft at each throw, kg m2."""
    if torsion.throw_inertia is not None:
        return [each / 1e6 for each in _each(torsion.throw_inertia, throws)]
    whole = 0.0 if engine.crank_inertia is None else float(engine.crank_inertia)
    return [whole / throws] * throws


def excite_engine(model: EngineFile, engine: Engine, orders: Real | None) -> Excitation:
    """Torque of every cylinder on the node of its throw: by inertia of what it moves, and by gas
    where the engine has some.

    Args:
        orders: (orders,); None: to 12, with halves where gas has them, and as of
            `list_gas_orders` that of firing.
    """
    front = 0 if model.torsion is None else len(model.torsion.front)
    nodes = front + np.array([weighed.throw for weighed in engine.weighed])
    engine = replace(engine, ripple=(), speed_rpm=1 / RPM)  # 1 rad/s
    if orders is None:
        orders = _list_orders(engine)
    growing = compute_each_cylinder(engine, orders, ("torque",))["torque"].x
    steady = np.zeros_like(growing)
    if engine.gas is not None:
        steady = compute_each_cylinder(engine, orders, ("gas",))["gas"].x
    moves = np.any((growing != 0) | (steady != 0), axis=1)
    return Excitation(orders[moves], nodes, steady[moves], growing[moves])


def _list_orders(engine: Engine) -> Real:
    if engine.gas is None:
        return np.arange(1.0, HIGHEST_TORSION_ORDER_UNASKED + 1)
    listed = list_gas_orders(engine)
    return listed[listed <= HIGHEST_TORSION_ORDER]


# ------------------------------------------------------------------ what does not fit together
def _find_misfits(
    torsion: Torsion, model: EngineFile, engine: Engine, throws: int
) -> Iterator[Problem]:
    if engine.rotary:
        yield Problem("torsion", "is for crankshafts that turn; that of a rotary stands still")
        return
    yield from _check_throws(torsion, model, throws)
    joints = _join_parts(torsion, throws)
    names = [*_name_throws(throws), *(joint.part.name for joint in joints)]
    reserved = {*_name_throws(throws), *_name_between(throws)}
    taken: set[str] = set()
    for joint in joints:
        name = joint.part.name
        if name in reserved:
            yield Problem(f"{joint.path}.name", f"{shorten(name)} is a name that throws have")
        elif name in taken:
            yield Problem(
                f"{joint.path}.name", f"{shorten(name)} is there twice; give each its own"
            )
        taken.add(name)
        if joint.of not in names:
            listed = ", ".join(printable(each) for each in names[:8])
            hint = suggest_nearest(joint.of, names, f"there are {listed}")
            yield Problem(f"{joint.path}.of", f"{shorten(joint.of)} is no part; {hint}")
    led = [j if j.of in names else j._replace(of="throw 1") for j in joints]  # told already
    hanging = _find_gears(led, throws)
    for joint in joints:
        if joint.of in names and joint.part.name not in hanging:
            yield Problem(
                f"{joint.path}.of",
                f"{shorten(joint.of)} does not lead to the crankshaft; name what the part hangs on",
            )


def _check_throws(torsion: Torsion, model: EngineFile, throws: int) -> Iterator[Problem]:
    places = throws - 1
    if torsion.throw_stiffness is None and places:
        hint = f"give that between neighbours of {counted(throws, 'throw')}, such as "
        yield Problem.of_missing("torsion.throw_stiffness", f"{hint}throw_stiffness = 1.25e6")
    for key, count in (("throw_stiffness", places), ("throw_inertia", throws)):
        values = getattr(torsion, key)
        if values is not None and len(values) not in (1, count):
            yield Problem(
                f"torsion.{key}",
                f"has {counted(len(values), 'value')}, but {counted(throws, 'throw')} need "
                f"{count}; give one for all, or a list of these",
            )
    if torsion.throw_inertia is None and model.crank.inertia is None:
        hint = "give it, such as throw_inertia = 46700, or inertia of the whole [crank]"
        yield Problem.of_missing("torsion.throw_inertia", hint)
