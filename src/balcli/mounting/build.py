"""Tables of an engine file -> a rigid body on its mounts, SI, checked."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..core.rigid_body import Body, Mounts, complete_axes, find_free_motions, turn_axes
from ..core.vibration import Real
from ..enginefile.fields import counted, printable, shorten
from ..enginefile.model import EngineFile
from ..enginefile.mounting_tables import Body as BodyTable
from ..enginefile.mounting_tables import Mount, Point
from ..enginefile.units import STANDARD_GRAVITY
from ..errors import InputError, Problem
from ..limits import MOST_MOUNTS
from .motions import describe_free_motion

_STIFFNESS = 1e3  # N/m of N/mm
_DAMPING = 1e3  # N s/m of N s/mm
_INERTIA = 1e-6  # kg m2 of kg mm2
_LENGTH = 1e-3  # m of mm


class MountedBody(NamedTuple):
    """A body on its mounts, in the engine's axes.

    Attributes:
        body: with its centre of gravity and tensor.
        static, dynamic: the mounts with their stiffness at rest and in vibration.
        names: of the mounts.
        weight: (3,) N.
        point_names, points: (points, 3) m, whose motion is wanted.
        carries_load: whether what takes the engine's torque stands on the body, too.
    """

    body: Body
    static: Mounts
    dynamic: Mounts
    names: tuple[str, ...]
    weight: Real
    point_names: tuple[str, ...]
    points: Real
    carries_load: bool = False

    @property
    def up(self) -> Real:
        """(3,) unit vector against the weight."""
        return -self.weight / np.linalg.norm(self.weight)


def build_mounted_body(model: EngineFile, name: str = "") -> MountedBody:
    """The body and the mounts of a file; `name` is that of the file, for messages.

    Raises:
        InputError: what is missing or does not fit together; a motion that no mount holds.
    """
    problems = list(find_mounting_faults(model))
    if problems or model.body is None:
        raise InputError(problems, name)
    body, weight = _build_body(model.body)
    static = _build_mounts(model.mount)
    factors = np.array([mount.dynamic_factor for mount in model.mount])[:, None]
    mounted = MountedBody(
        body,
        static,
        static._replace(stiffness=static.stiffness * factors),
        tuple(mount.name for mount in model.mount),
        weight,
        tuple(point.name for point in model.point),
        _LENGTH * np.array([point.at for point in model.point], float).reshape(-1, 3),
        model.body.carries_load,
    )
    free = find_free_motions(body, static)
    if len(free):
        others = f", and {counted(len(free) - 1, 'other motion')}" if len(free) > 1 else ""
        message = (
            f"nothing holds the body against {describe_free_motion(free[0], body.centre)}{others}; "
            "give a mount that does, or stiffness along another axis"
        )
        raise InputError([Problem("mount", message)], name)
    return mounted


def find_mounting_faults(
    model: EngineFile, legible: frozenset[str] = frozenset({"body", "mount", "point"})
) -> Iterator[Problem]:
    """What is missing of a body on its mounts, or said twice.

    Args:
        legible: tables that could be read.
    """
    if "body" in legible and model.body is None:
        example = "mass = 163.9"
        yield Problem.of_missing("body", f'give it, such as "[body]" and "{example}" below it')
    if "mount" in legible and not model.mount:
        yield Problem.of_missing("mount", "write [[mount]] for every mount")
    lists: dict[str, Sequence[Mount | Point]] = {"mount": model.mount, "point": model.point}
    for key, tables in lists.items():
        if key in legible:
            yield from _find_list_faults(key, tables)


def _find_list_faults(key: str, tables: Sequence[Mount | Point]) -> Iterator[Problem]:
    """Too many tables of a kind, and names that come twice."""
    if len(tables) > MOST_MOUNTS:
        yield Problem(key, f"stands {len(tables)} times; at most {MOST_MOUNTS} are taken")
    met: dict[str, int] = {}
    for number, table in enumerate(tables, 1):
        first = met.setdefault(table.name, number)
        if first != number:
            message = (
                f"{shorten(printable(table.name))} is also the name of {key}.{first}; each needs "
                "one of its own"
            )
            yield Problem(f"{key}.{number}.name", message)


def _build_body(table: BodyTable) -> tuple[Body, Real]:
    """The body that a file tells of, and its weight (3,), N."""
    xx, yy, zz, xy, yz, zx = table.inertia
    tensor = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
    body = Body(table.mass, _LENGTH * np.array(table.cg, float), _INERTIA * tensor)
    down = np.array(table.gravity, float)
    return body, table.mass * STANDARD_GRAVITY * down / np.linalg.norm(down)


def _build_mounts(mounts: Sequence[Mount]) -> Mounts:
    return Mounts(
        _LENGTH * np.array([mount.at for mount in mounts], float),
        np.array([_find_axes(mount) for mount in mounts]),
        _STIFFNESS * np.array([mount.stiffness for mount in mounts], float),
        np.array([[mount.loss] * 3 for mount in mounts], float),
        _DAMPING * np.array([mount.damping for mount in mounts], float),
    )


def _find_axes(mount: Mount) -> Real:
    """(3, 3), columns: its own axes."""
    if mount.axes is not None:
        return complete_axes(*mount.axes)
    about_x, about_y, about_z = map(math.radians, mount.angles or (0.0, 0.0, 0.0))
    return turn_axes(about_x, about_y, about_z)
