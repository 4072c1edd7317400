"""Define the records of the results of `balcli mounts`, from which JSON, CSV and schema derive
(`core.records`).

Forces act from the body on its mounts, along the engine's axes. Arrays over speeds have the shape
(speeds,).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

import numpy as np

from ..core.phases import RPM
from ..core.records import HIDDEN, Asked, Axes
from ..core.vibration import Complex, Real
from ..engine.engine import CylinderNumber
from ..file.assumed import Assumed
from ..file.doubt import Doubt
from ..file.fields import printable
from ..show.result import Result
from ..sizing.remedy import Remedy
from .build import BodyMode, MountedBody
from .loads import BodyLoads

TRAVEL_MOST = 0.05  # m; a warning is given if a mount has a larger amplitude


class MountAtRest(NamedTuple):
    """A mount of the body at rest, under its weight and the mean torque.

    Attributes:
        name: Name of the mount.
        force_N: Force along x, y, z.
        travel_mm: Travel of the mounting point along x, y, z.
    """

    name: str
    force_N: Real
    travel_mm: Real


class AtRest(NamedTuple):
    """The body at rest, with static stiffness.

    Attributes:
        mounts: All mounts.
    """

    mounts: tuple[MountAtRest, ...]


class ForceOfOrder(NamedTuple):
    """Force of one order on a mount.

    Attributes:
        order: Order.
        force_N: Largest force in a cycle, by speed.
    """

    order: float
    force_N: Real


class MetMode(NamedTuple):
    """An order that has the frequency of a mode at, or close to, the speed of the largest value.

    Attributes:
        order: Order; if several orders have a mode's frequency, the one with the largest amplitude.
        mode: Number of the mode, from 1.
        speed_rpm: Speed at which the order and the mode have the same frequency.
    """

    order: float
    mode: int
    speed_rpm: float


class WorstForce(NamedTuple):
    """The largest force of a mount over all speeds, which may occur between the given speeds.

    Attributes:
        force_N: Largest force, all orders together.
        speed_rpm: Speed at which this force occurs.
        order: Order with the largest force at this speed.
        order_force_N: Force of this order alone.
        mode: Number, from 0, of the mode that contributes most to the force of this order.
        resonance: Order in resonance at this speed; left out if there is none.
    """

    force_N: float
    speed_rpm: float
    order: float
    order_force_N: float
    mode: Annotated[int, HIDDEN]
    resonance: MetMode | None = None

    @property
    def largest(self) -> float:
        """Largest force, N."""
        return self.force_N

    @property
    def alone(self) -> float:
        """Force of the order alone, N."""
        return self.order_force_N


class MountForce(NamedTuple):
    """Force of one mount by order and speed.

    Attributes:
        name: Name of the mount.
        orders: Force of each order alone.
        peak_N: Largest force over the cycle, all orders added with their phases, by speed.
        worst: Largest force over all speeds.
    """

    name: str
    orders: tuple[ForceOfOrder, ...]
    peak_N: Real
    worst: WorstForce


class MotionOfOrder(NamedTuple):
    """Motion of a point by one order.

    Attributes:
        order: Order.
        motion_mm: Largest motion in a cycle, by speed.
    """

    order: float
    motion_mm: Real


class WorstMotion(NamedTuple):
    """The largest motion of a point over all speeds, which may occur between the given speeds.

    Attributes:
        motion_mm: Largest motion, all orders together.
        speed_rpm: Speed at which this motion occurs.
        order: Order with the largest motion at this speed.
        order_motion_mm: Motion by this order alone.
        mode: Number, from 0, of the mode that contributes most to the motion by this order.
        resonance: Order in resonance at this speed; left out if there is none.
    """

    motion_mm: float
    speed_rpm: float
    order: float
    order_motion_mm: float
    mode: Annotated[int, HIDDEN]
    resonance: MetMode | None = None

    @property
    def largest(self) -> float:
        """Largest motion, mm."""
        return self.motion_mm

    @property
    def alone(self) -> float:
        """Motion by the order alone, mm."""
        return self.order_motion_mm


class PointMotion(NamedTuple):
    """Motion of one point by order and speed.

    Attributes:
        name: Name of the point.
        orders: Motion by each order alone.
        peak_mm: Largest motion over the cycle, all orders added with their phases, by speed.
        worst: Largest motion over all speeds.
    """

    name: str
    orders: tuple[MotionOfOrder, ...]
    peak_mm: Real
    worst: WorstMotion


class Passed(NamedTuple):
    """Load of one order on the frame: amplitudes of the force (`force_x_N` ...) and of the moment
    about the centre of gravity (`moment_x_Nm` ...) by speed. Components that are 0 are left out.

    Attributes:
        order: Order.
        rigid: Load if the engine were mounted rigidly.
        on_mounts: Load through the mounts.
    """

    order: float
    rigid: dict[str, Real]
    on_mounts: dict[str, Real]


@dataclass(frozen=True, eq=False, kw_only=True)
class BodyResponse:
    """Response of the body to an engine over a range of speeds.

    Attributes:
        no_gas_in: Cylinders without gas; left out if there are none.
        no_burning_in: Cylinders that compress but do not burn; left out if there are none.
        orders: Orders in the response: those requested, or all that contribute.
        speeds_rpm: Crank speeds.
        imep_Pa: Indicated mean effective pressure, by speed; left out if it is the same at all
            speeds.
        mounts: Force of each mount.
        points: Motion of each point.
        passed: Load on the frame, by order.
        loads: Load of the engine on the body.
        body: Motion of the centre of gravity, m and rad, shape (orders, speeds, 6).
    """

    no_gas_in: tuple[CylinderNumber, ...] | None = None
    no_burning_in: tuple[CylinderNumber, ...] | None = None
    orders: list[float]
    speeds_rpm: Real
    imep_Pa: Real | None = None
    mounts: tuple[MountForce, ...]
    points: tuple[PointMotion, ...]
    passed: tuple[Passed, ...]
    loads: Annotated[BodyLoads, HIDDEN]
    body: Annotated[Complex, HIDDEN]


class Fitted(NamedTuple):
    """Response of the engine with the devices of a balance scheme.

    Attributes:
        scheme: Name of the scheme.
        response: Response of the body.
        remedy: The fitted devices.
    """

    scheme: str
    response: BodyResponse
    remedy: Annotated[Remedy, HIDDEN]


class Other(NamedTuple):
    """Another engine on the same body and mounts.

    Attributes:
        name: Name of the engine.
        response: Response of the body.
    """

    name: str
    response: BodyResponse


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class MountReport(Result):
    """An engine on its mounts, or a body on mounts without an engine.

    Attributes:
        format: Name and version of the document.
        name: Name of the engine, or of the body.
        assumed: Values assumed because the file leaves them out.
        modes: The six natural modes, lowest first.
        roll_axis: Torque roll axis, a unit vector: the axis through the centre of gravity about
            which the free body turns under a torque about the crankshaft.
        elastic_centre_mm: Point x, y, z at which forces move the body with the least turning.
        static: The body at rest.
        stiffness_N_per_m: Dynamic stiffness matrix about the centre of gravity: forces (N) and
            moments (N·m) for displacements of 1 m and rotations of 1 rad.
        response: Response to the engine; left out without an engine.
        fitted: Response with a balance scheme, if requested.
        others: Responses to other engines.
        mounted: The body on its mounts.
    """

    format: Literal["balcli.mounts/1"] = "balcli.mounts/1"
    name: str
    assumed: tuple[Assumed, ...] | None = None
    modes: tuple[BodyMode, ...]
    roll_axis: Real
    elastic_centre_mm: Real
    static: AtRest
    stiffness_N_per_m: Annotated[Real, Axes(2)]
    response: Asked[BodyResponse] = Asked("[crank], [rod] and [piston] in the file")
    fitted: Asked[Fitted] = Asked('scheme="counterweights"')
    others: Asked[tuple[Other, ...]] = Asked('others={"V8": engine}')
    mounted: Annotated[MountedBody, HIDDEN]

    @property
    def summary(self) -> str:
        """Name and natural frequencies."""
        modes = ", ".join(f"{mode.frequency_Hz:.3g}" for mode in self.modes)
        return f"of {self.name or 'a body'}: modes at {modes} Hz"

    @property
    def beside(self) -> tuple[Other, ...]:
        """Responses to compare with the engine's own: with the scheme, and to other engines."""
        responses: list[Other] = []
        if hasattr(self, "fitted"):
            responses.append(Other(self.fitted.scheme, self.fitted.response))
        if hasattr(self, "others"):
            responses += self.others
        return tuple(responses)

    @property
    def responses(self) -> tuple[BodyResponse, ...]:
        """All responses; the engine's own is the first."""
        own = [self.response] if hasattr(self, "response") else []
        return (*own, *(other.response for other in self.beside))

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Warnings of speeds for which the file gives no gas, and of the mount that travels most
        if its travel exceeds TRAVEL_MOST.
        """
        if not hasattr(self, "response"):
            return ()
        law = self.response.loads.law
        of_gas = tuple(law.list_doubts(self.response.speeds_rpm)) if law else ()
        stiffness, loss, damping = self.mounted.dynamic[2:]
        worst = [mount.worst for mount in self.response.mounts]
        frequency = np.array([[each.order * each.speed_rpm * RPM] for each in worst])
        springs = np.abs(stiffness * (1 + 1j * loss) + 1j * frequency * damping).max(axis=1)
        travels = np.array([each.force_N for each in worst]) / springs
        farthest = int(travels.argmax())
        if (travel := travels[farthest]) <= TRAVEL_MOST:
            return of_gas
        message = (
            f"the mount {printable(self.response.mounts[farthest].name)} would travel by "
            f"{1e3 * travel:.3g} mm or more at {worst[farthest].speed_rpm:.4g} rpm, but stops "
            "usually allow 10 to 20 mm; are loss and damping right, and does the engine run at "
            "that speed, or only pass through it?"
        )
        return (*of_gas, Doubt("", message))
