"""[torsion] of an engine file and the engine -> torsional system: a node for each throw, with the
mean inertia of what moves on it, and one for each part before and behind.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.loads import find_inertia, find_needed_series
from ..core.mechanisms.fourier import select_cylinders
from ..core.speeds import RPM
from ..core.torsional_chain import ChainShaft
from ..core.vibration import Real
from ..engine.build import Engine
from ..enginefile.fields import counted, printable, shorten, suggest_nearest
from ..enginefile.model import EngineFile
from ..enginefile.shafting import Damper, find_stiffness
from ..enginefile.torsion_tables import Part, Torsion
from ..errors import InputError, Problem
from ..forces.orders import list_gas_orders
from ..forces.spectrum import compute_each_cylinder
from ..limits import HIGHEST_TORSION_ORDER, HIGHEST_TORSION_ORDER_UNASKED
from .assembly import NO_DAMPERS, PlannedNode, PlannedShaft, assemble_system, find_section
from .system import Excitation, TorsionalSystem


class _Joint(NamedTuple):
    """A part and the name of what it hangs on; `path` is its place in the file."""

    path: str
    part: Part
    of: str


def build_engine_system(
    model: EngineFile,
    engine: Engine,
    excitation: Excitation,
    name: str = "",
    fitted: Mapping[str, Damper | None] = NO_DAMPERS,
) -> TorsionalSystem:
    """Return the system of an engine.

    Args:
        model: Its file, which has [torsion].
        engine: Of this file.
        excitation: By its cylinders, as of `excite_engine`.
        name: Name of the file, for messages.
        fitted: Dampers of some parts in place of those in the file.

    Raises:
        InputError: what does not fit together in [torsion], by its path.
    """
    torsion = model.torsion
    if torsion is None:
        hint = "write [torsion] with throw_stiffness and throw_inertia, and [[torsion.rear]]"
        raise InputError([Problem.of_missing("torsion", hint)], name)
    throws = [f"throw {k}" for k, _ in enumerate(engine.throws_m, 1)]
    if problems := list(_find_misfits(torsion, model, engine, throws)):
        raise InputError(problems, name)
    nodes = [
        *map(_plan_part, reversed(torsion.front)),
        *_plan_throws(torsion, engine, throws),
        *map(_plan_part, torsion.rear),
    ]
    front, joints = len(torsion.front), _join_parts(torsion, throws)
    place, gears = {node.name: k for k, node in enumerate(nodes)}, _find_gears(joints, throws)
    leading = []  # shaft of every part from what it hangs on, stiff in its own speed
    for _, part, of in joints:
        ratio = gears[part.name] / gears[of]
        shaft = ChainShaft(place[of], place[part.name], find_stiffness(part), ratio)
        loss, section = part.loss, find_section(part.diameter, part.bore)
        loss = torsion.loss if loss is None else loss
        leading.append(PlannedShaft(part.name, shaft, loss, part.damping, section))
    section = find_section(torsion.throw_diameter, torsion.throw_bore)
    stiffness = _each(torsion.throw_stiffness or (), len(throws) - 1)
    between = [
        PlannedShaft(label, ChainShaft(front + k, front + k + 1, each), torsion.loss, 0.0, section)
        for k, (label, each) in enumerate(zip(_name_between(throws), stiffness, strict=True))
    ]
    own_speed = "speed" in model.operation.model_fields_set
    return assemble_system(
        nodes,
        [*reversed(leading[:front]), *between, *leading[front:]],
        (torsion.limit, torsion.angle_limit),
        fitted=fitted,
        name=engine.name,
        excitation=excitation,
        rated_rpm=model.operation.speed if own_speed else None,
        reference=front,
        silent=engine.silent,
        file=name,
    )


def _plan_part(part: Part) -> PlannedNode:
    return PlannedNode(part.name, (part.inertia or 0.0) / 1e6, part.node_damping, part.damper)


def _plan_throws(torsion: Torsion, engine: Engine, throws: Sequence[str]) -> Iterator[PlannedNode]:
    """Yield a node for each throw, with what runs on it and the damping of every cylinder."""
    gear, on_throw = weigh_running_gear(engine), [weighed.throw for weighed in engine.weighed]
    bare = _weigh_throws(torsion, engine, len(throws))
    for throw, name in enumerate(throws):
        here = np.equal(on_throw, throw)
        inertia = bare[throw] + float(gear[here].sum())
        yield PlannedNode(name, inertia, torsion.damping * int(here.sum()))


def _name_between(throws: Sequence[str]) -> list[str]:
    return [f"throw {k}-{k + 1}" for k in range(1, len(throws))]


def _each(values: Sequence[float], count: int) -> list[float]:
    """Return one value for each of so many, from one for all or a list."""
    return list(values) * count if len(values) == 1 else list(values)


def _join_parts(torsion: Torsion, throws: Sequence[str]) -> list[_Joint]:
    """Return every part with what it hangs on: front parts first, each list outward."""
    found = []
    for key, parts, before in (
        ("front", torsion.front, throws[0]),
        ("rear", torsion.rear, throws[-1]),
    ):
        for k, part in enumerate(parts, 1):
            found.append(_Joint(f"torsion.{key}.{k}", part, part.of or before))
            before = part.name
    return found


def _find_gears(joints: Sequence[_Joint], throws: Sequence[str]) -> dict[str, float]:
    """Return the speed over that of the crank of every node that hangs on it, by name."""
    gears = dict.fromkeys(throws, 1.0)
    for _ in joints:  # a part may hang on one that comes later in the file
        before = len(gears)
        for _, part, of in joints:
            if of in gears:
                gears[part.name] = gears[of] if part.gear is None else part.gear
        if len(gears) == before:
            break
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
    moving = find_inertia(c, select_cylinders(few, which), 1.0).c[0].real
    own = np.array([float(weighed.share) for weighed in engine.weighed])
    turning = (c.rotating - own) * c.radius**2
    return np.broadcast_to(moving, own.shape) + np.broadcast_to(turning, own.shape)


def _weigh_throws(torsion: Torsion, engine: Engine, throws: int) -> Sequence[float]:
    """Return the moment of inertia of the crankshaft at each throw, kg m2."""
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
    if orders is None and engine.gas is None:
        orders = np.arange(1.0, HIGHEST_TORSION_ORDER_UNASKED + 1)
    elif orders is None:
        orders = list_gas_orders(engine)
        orders = orders[orders <= HIGHEST_TORSION_ORDER]
    growing = compute_each_cylinder(engine, orders, ("torque",))["torque"].x
    steady = np.zeros_like(growing)
    if engine.gas is not None:
        steady = compute_each_cylinder(engine, orders, ("gas",))["gas"].x
    moves = np.any((growing != 0) | (steady != 0), axis=1)
    return Excitation(orders[moves], nodes, steady[moves], growing[moves])


# ------------------------------------------------------------------ what does not fit together
def _find_misfits(
    torsion: Torsion, model: EngineFile, engine: Engine, throws: Sequence[str]
) -> Iterator[Problem]:
    if engine.rotary:
        yield Problem("torsion", "is for crankshafts that turn; that of a rotary stands still")
        return
    yield from _check_throws(torsion, model, len(throws))
    joints = _join_parts(torsion, throws)
    names = [*throws, *(joint.part.name for joint in joints)]
    reserved = {*throws, *_name_between(throws)}
    led = _find_gears([j if j.of in names else j._replace(of=throws[0]) for j in joints], throws)
    for k, (path, part, of) in enumerate(joints, len(throws)):
        if part.name in reserved:
            yield Problem(f"{path}.name", f"{shorten(part.name)} is a name that throws have")
        elif part.name in names[:k]:
            yield Problem(f"{path}.name", f"{shorten(part.name)} is there twice; give each its own")
        if of not in names:
            listed = ", ".join(printable(each) for each in names[:8])
            hint = suggest_nearest(of, names, f"there are {listed}")
            yield Problem(f"{path}.of", f"{shorten(of)} is no part; {hint}")
        elif part.name not in led:
            text = f"{shorten(of)} does not lead to the crankshaft; name what the part hangs on"
            yield Problem(f"{path}.of", text)


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
