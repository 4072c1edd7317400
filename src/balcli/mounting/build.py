"""Build a rigid body on its mounts, in SI units, from the tables of an engine file; find its
natural modes.

The file may describe an engine, or only body and mounts. `read_mounted` checks it and reports all
mistakes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.vibration import Complex, Modes, Real, modal_loss
from ..engine.build import list_contradictions
from ..engine.engine import Engine
from ..engine.figures import find_first_largest
from ..engine.load import build_named
from ..engine.parse import join_engines
from ..errors import InputError, Problem
from ..file.doubt import Doubt, walk_figures
from ..file.doubts import LOSS_OF_MOUNTS, doubt_losses
from ..file.fields import printable, shorten
from ..file.model import EngineFile
from ..file.mount_tables import Mount, Point
from ..file.plain_tables import list_tables
from ..file.read import REQUIRED, Draft, read_tables, refuse
from ..file.toml import name_file, read_bytes
from ..file.units import STANDARD_GRAVITY, ask_unit
from ..limits import MOST_MOUNTS
from .rigid_body import (
    AXES,
    Body,
    Mounts,
    complete_axes,
    damping_matrix,
    describe_free_motion,
    drop_rounding,
    find_body_modes,
    find_free_motions,
    mass_matrix,
    name_mode,
    name_motions,
    settle_body,
    share_energy,
    stiffness_matrix,
    turn_axes,
)

_MM = 1e-3  # m


class MountedBody(NamedTuple):
    """A body on its mounts, in the engine's axes.

    Attributes:
        body: Body with its centre of gravity and inertia tensor.
        static: Mounts with their stiffness at rest.
        dynamic: Mounts with their stiffness in vibration.
        names: Names of the mounts.
        weight: Weight of the body, N, shape (3,).
        point_names: Names of the points whose motion is computed.
        points: Positions of these points, m, shape (points, 3).
        carries_load: Whether the driven machine is part of the body.
    """

    body: Body
    static: Mounts
    dynamic: Mounts
    names: tuple[str, ...]
    weight: Real
    point_names: tuple[str, ...]
    points: Real
    carries_load: bool = False


def build_mounted_body(model: EngineFile, name: str = "") -> MountedBody:
    """Return the body and the mounts of a file.

    Args:
        model: Engine file.
        name: Name of the file, for messages.

    Raises:
        InputError: Tables are missing or contradictory, or a motion of the body is unrestrained.
    """
    problems = list(find_mounting_faults(model))
    table = model.body
    mounts = model.mount
    if problems or table is None:
        raise InputError(problems, name)
    xx, yy, zz, xy, yz, zx = table.inertia
    tensor = 1e-6 * np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])  # kg mm2 to kg m2
    body = Body(table.mass, _MM * np.array(table.cg), tensor)
    down = np.array(table.gravity)
    static = _read_mounts(mounts)
    free = find_free_motions(body, static)
    if len(free):
        message = (
            f"nothing holds the body against {describe_free_motion(free[0])}; give a "
            "mount that does, or stiffness along another axis"
        )
        raise InputError([Problem("mount", message)], name)
    factors = np.array([[mount.dynamic_factor] for mount in mounts])
    places = np.array([point.at for point in model.point])
    return MountedBody(
        body,
        static,
        static._replace(stiffness=static.stiffness * factors),
        tuple(mount.name for mount in mounts),
        table.mass * STANDARD_GRAVITY * down / np.linalg.norm(down),
        tuple(point.name for point in model.point),
        _MM * places.reshape(-1, 3),
        table.carries_load,
    )


def _read_mounts(mounts: Sequence[Mount]) -> Mounts:
    """Return the arrays of mounts at rest, SI."""
    places = np.array([mount.at for mount in mounts])
    axes = np.array([_find_axes(mount) for mount in mounts])
    stiffness = np.array([mount.stiffness for mount in mounts])
    loss = np.array([[mount.loss] * 3 for mount in mounts])
    damping = np.array([mount.damping for mount in mounts])
    return Mounts(_MM * places, axes, 1e3 * stiffness, loss, 1e3 * damping)  # N/mm to N/m


def _find_axes(mount: Mount) -> Real:
    """Return the axes of a mount as the columns of a matrix (3, 3)."""
    if mount.axes is not None:
        return complete_axes(*mount.axes)
    return turn_axes(*np.radians(mount.angles or (0.0, 0.0, 0.0)))


def find_mounting_faults(
    model: EngineFile, readable: frozenset[str] = frozenset({"body", "mount", "point"})
) -> Iterator[Problem]:
    """Yield problems of body, mounts and points: missing or too many tables, and repeated names.

    Args:
        model: Engine file.
        readable: Names of the tables that could be read.
    """
    if "body" in readable and model.body is None:
        yield Problem.of_missing("body", 'give it, such as "[body]" and "mass = 163.9" below it')
    if "mount" in readable and not model.mount:
        yield Problem.of_missing("mount", "write [[mount]] for every mount")
    lists: dict[str, Sequence[Mount | Point]] = {"mount": model.mount, "point": model.point}
    for key, tables in lists.items():
        if len(tables) > MOST_MOUNTS:
            yield Problem(key, f"is given {len(tables)} times; at most {MOST_MOUNTS} are allowed")
        names = [table.name for table in tables if key in readable]
        for number, name in enumerate(names, 1):
            if (first := names.index(name) + 1) < number:
                text = f"{shorten(printable(name))} is also the name of {key}.{first}"
                yield Problem(f"{key}.{number}.name", f"{text}; each needs its own name")


# ------------------------------------------------------------------ equations of motion
class Meeting(NamedTuple):
    """Crank speed at which an order has the natural frequency of a mode.

    Attributes:
        order: Order.
        speed_rpm: Crank speed.
    """

    order: float
    speed_rpm: float


class BodyMode(NamedTuple):
    """A natural mode of the body on its mounts.

    Attributes:
        frequency_Hz: Natural frequency without damping, with dynamic stiffness.
        energy_percent: Shares of the motions x, y, z, rx, ry, rz in the kinetic energy, %.
        shape: Displacement and rotation about the centre of gravity for unit modal mass, m and rad,
            shape (6,).
        motion: Names of the largest motions in the mode.
        loss_factor: Loss factor; its inverse is the magnification at resonance.
        meets: Orders that have the frequency of the mode at a speed within the range.
    """

    frequency_Hz: float
    energy_percent: dict[str, float]
    shape: Real
    motion: str
    loss_factor: float
    meets: tuple[Meeting, ...]


class BodyModes(NamedTuple):
    """Equations of motion about the centre of gravity, and their natural modes. The motion q under
    a load f at the frequency w (rad/s) follows from `(K + i w C - w^2 M) q = f`.

    Attributes:
        stiffness: Dynamic stiffness K in SI units, shape (6, 6).
        damping: Damping C in SI units, shape (6, 6).
        mass: Mass M in SI units, shape (6, 6).
        modes: Undamped modes, lowest first.
        loss: Loss factor of each mode, shape (6,).
        each: Records of the modes, without the orders that meet them.
    """

    stiffness: Complex
    damping: Real
    mass: Real
    modes: Modes
    loss: Real
    each: tuple[BodyMode, ...]


def find_mounted_modes(mounted: MountedBody) -> BodyModes:
    """Return the equations of motion and the natural modes of a body on its mounts."""
    body = mounted.body
    mounts = mounted.dynamic
    modes = find_body_modes(body, mounts)
    names = name_motions(-mounted.weight)
    stiffness = stiffness_matrix(body, mounts)
    damping = damping_matrix(body, mounts)
    mass = mass_matrix(body)
    loss = modal_loss(modes, stiffness, damping)
    energy = share_energy(modes, body)
    shapes = drop_rounding(modes.shapes, 1 / np.sqrt(np.diag(mass)))
    body_modes = tuple(
        BodyMode(
            float(omega / (2 * np.pi)),
            dict(zip(AXES, (100 * share).tolist(), strict=True)),
            shape * np.copysign(1.0, shape[find_first_largest(share)]),
            name_mode(share, names),
            float(lost),
            (),
        )
        for omega, share, shape, lost in zip(modes.omega, energy, shapes, loss, strict=True)
    )
    return BodyModes(stiffness, damping, mass, modes, loss, body_modes)


def settle(mounted: MountedBody, torque: float = 0.0) -> tuple[Real, Real]:
    """Return the forces on the mounts (N) and their travel (m), shape (mounts, 3) each, for the
    body at rest under its weight, with static stiffness.

    Args:
        torque: Mean torque on the body about the crankshaft's axis, N m. It has no effect if the
            body carries the driven machine: then it acts between parts of the body.
    """
    leaning = 0.0 if mounted.carries_load else torque
    load = np.concatenate([mounted.weight, [0.0, 0.0, leaning]])
    return settle_body(mounted.body, mounted.static, load)


SAG_LEAST = 0.02
SAG_MOST = 200.0  # plausible travel under the weight, mm; rubber mounts: 1 to 20
SMALL_BODY = 0.01  # least plausible ratio of radius of gyration to mount distance; usual: 0.2 to 1


def read_mounted(path: str | Path) -> tuple[EngineFile, Engine | None, tuple[Doubt, ...]]:
    """Return the file at a path (or standard input for "-"), its engine if it has one, and
    warnings.

    Raises:
        BalcliError: The file cannot be read.
        InputError: The file has mistakes; the error lists all of them.
    """
    name = name_file(path)
    return check_mounted(read_tables(read_bytes(path), name, bare=True), name)


def check_mounted(draft: Draft, name: str) -> tuple[EngineFile, Engine | None, tuple[Doubt, ...]]:
    """Check the readable part of a file, and build its engine if it has one.

    Args:
        draft: Readable part, with the mistakes of the text.
        name: Name of the file, for messages.

    Returns:
        The file, its engine if it has one, and warnings.

    Raises:
        InputError: The file has mistakes; the error lists all of them.
    """
    draft = join_engines(draft)
    faults = list(find_mounting_faults(draft.model, draft.readable))
    has_engine = any(key in draft.model.model_fields_set for key in (*REQUIRED, "engine"))
    if draft.problems or faults:
        contradictions = list_contradictions(draft) if draft.problems else []
        raise refuse([*draft.problems, *contradictions, *faults], name)
    engine = build_named(draft.model, name) if has_engine else None
    doubts = () if engine is None else engine.unlikely
    return draft.model, engine, (*doubts, *_find_doubts(draft.model))


def _find_doubts(model: EngineFile) -> Iterator[Doubt]:
    """Yield warnings of impossible or unlikely figures of body and mounts, such as wrong units."""
    body = model.body
    mounts = model.mount
    if body is None:
        return
    moments = dict(zip(("xx", "yy", "zz"), body.inertia, strict=False))
    name, largest = max(moments.items(), key=lambda moment: moment[1])
    others = sum(moments.values()) - largest
    if largest > others:
        message = (
            f"{name} of {largest:g} exceeds the sum of the other two ({others:g}), which is "
            "impossible; are the axes right? z is along the crankshaft"
        )
        yield Doubt("body.inertia", message)
    across = math.sqrt(largest / body.mass)
    farthest = max(math.dist(mount.at, body.cg) for mount in mounts)
    if not SMALL_BODY * farthest <= across <= farthest / SMALL_BODY:
        message = (
            f"{name} of {largest:g} kg mm^2 is a radius of gyration of {across:.2g} mm, and the "
            f"farthest mount is {farthest:.3g} mm away; are the units kg mm^2 and mm?"
        )
        yield Doubt("body.inertia", message)
    sag = STANDARD_GRAVITY * body.mass / sum(sum(mount.stiffness) / 3 for mount in mounts)
    if not SAG_LEAST <= sag <= SAG_MOST:
        message = (
            f"under its weight the body would sink by about {sag:.2g} mm, where {SAG_LEAST:g} to "
            f"{SAG_MOST:g} mm is usual; {ask_unit('N/mm', '250 kN/m')}"
        )
        yield Doubt("mount.stiffness", message, ("body.mass",))
    yield from doubt_losses(walk_figures("mount", list_tables(mounts)), LOSS_OF_MOUNTS)
