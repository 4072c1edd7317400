"""Tables of an engine file about its mounts: [body], [[mount]] and [[point]].

This module is imported only for files that have one of these tables (`names.CHAPTERS`).
"""

import math
from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from .fields import Choice, Number, OneOrEach, as_written
from .table import Angle, FileTable, Name, Switch, Triple
from .units import DAMPING, INERTIA, MASS, PLAIN, STIFFNESS

_Stiffness, _Damping = (Number(dimension, least=0, most=1e12) for dimension in (STIFFNESS, DAMPING))
_two, _three, _six = (Field(min_length=count, max_length=count) for count in (2, 3, 6))
Direction = Annotated[tuple[Annotated[float, Number(PLAIN, most=1e9)], ...], _three]

UNIT = INERTIA.unit
_PERPENDICULAR = 1e-6  # largest cosine between perpendicular axes


class Body(FileTable):
    """The body on the mounts: the engine with its gearbox, as one rigid body."""

    mass: Annotated[float, Number(MASS, above=0, most=1e12)]
    """Mass of the whole body. Example: 163.9"""
    cg: Triple
    """x, y, z of the centre of gravity, in the engine's axes. Example: [12, -8, 35]"""
    inertia: Annotated[tuple[Annotated[float, Number(INERTIA, most=1e24)], ...], _six]
    """Elements xx, yy, zz, xy, yz, zx of the inertia tensor about the centre of gravity; xy, yz and
    zx are the negative products of inertia. Example: [9.91e6, 4.12e6, 9.09e6, -0.813e6,
    1.34e6, -0.472e6]"""
    gravity: Direction = (-1.0, 0.0, 0.0)
    """Direction of the weight, a vector of any length. Example: [-1, 0, 0]"""
    carries_load: Switch = False
    """Whether the load that takes the engine's torque is also on the body, such as the generator of
    a genset; then no mount carries the mean torque. Example: true
    """

    def _check_gravity(self) -> Iterator[str]:
        if not any(self.gravity):
            yield "gravity [0, 0, 0] has no direction; leave it out for -x, downwards"

    def _check_inertia(self) -> Iterator[str]:
        """Yield only the first mistake in the inertia tensor."""
        a, b, c, d, e, f = self.inertia
        for name, value in (("xx", a), ("yy", b), ("zz", c)):
            if value <= 0:
                yield f"inertia {name} is {as_written(value, UNIT)}; a moment of inertia is above 0"
                return
        for name, value, square in (("xy", d, a * b), ("yz", e, b * c), ("zx", f, c * a)):
            if value**2 >= square:
                yield (
                    f"inertia {name} is {as_written(value, UNIT)}; with {2 * name[0]} and "
                    f"{2 * name[1]} its magnitude must be below {math.sqrt(square):g} {UNIT}"
                )
                return
        if a * b * c + 2 * d * e * f <= a * e**2 + b * f**2 + c * d**2:
            yield (
                "inertia xy, yz and zx are together too large: the tensor is not positive definite "
                "(as elements of the matrix they are the negative products of inertia)"
            )


class Mount(FileTable):
    """A mount: three springs at a point, between the body and the frame."""

    choices = (Choice((("axes",), ("angles",))),)

    name: Name
    """Name of the mount. Example: 'left'"""
    at: Triple
    """x, y, z of the mount, in the engine's axes. Example: [-66, 463, 156]"""
    stiffness: Annotated[tuple[float, ...], OneOrEach(_Stiffness, 3, copies=3)]
    """Static stiffness along the mount's three axes, or one figure for all three. Example: [349.5,
    370.5, 453]
    """
    axes: Annotated[tuple[Direction, ...], _two] | None = None
    """First and second axis of the mount: perpendicular vectors of any length in the engine's axes;
    left out: x and y. Example: [[0, 1, 0], [-1, 0, 0]]
    """
    angles: Annotated[tuple[Angle, ...], _three] | None = None
    """Instead of axes: angles by which the mount's axes are turned about the engine's x, then its
    y, then its z. Example: [0, -10, 0]
    """
    loss: Annotated[float, Number(PLAIN, least=0, most=10)] = 0.0
    """Loss factor of the stiffness. Example: 0.1"""
    damping: Annotated[tuple[float, ...], OneOrEach(_Damping, 3, copies=3)] = (0.0, 0.0, 0.0)
    """Viscous damping along the mount's three axes, or one figure for all three. Example: [0.4,
    0.4, 0.4]
    """
    dynamic_factor: Annotated[float, Number(PLAIN, above=0, most=100)] = 1.0
    """Ratio of dynamic to static stiffness; not used for the body at rest. Example: 1.3"""

    def _check_stiffness(self) -> Iterator[str]:
        if not any(self.stiffness):
            yield "stiffness [0, 0, 0] carries no load; give at least one value above 0"

    def _check_axes(self) -> Iterator[str]:
        if self.axes:
            first, second = self.axes
            sizes = math.hypot(*first) * math.hypot(*second)
            cosine = sum(a * b for a, b in zip(first, second, strict=True)) / (sizes or 1.0)
            if sizes == 0:
                yield "axes has a direction of length 0; give two directions such as [0, 1, 0]"
            elif abs(cosine) > _PERPENDICULAR:
                angle = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
                yield f"axes are {angle:.4g} degrees apart; they must be perpendicular"


class Point(FileTable):
    """A point of the body whose motion is wanted."""

    name: Name
    """Name of the point. Example: 'seat rail'"""
    at: Triple
    """x, y, z of the point, in the engine's axes. Example: [0, 500, 0]"""
