"""Engine file -> what its body does on its mounts: the answer of `balcli mounts`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from typing import NamedTuple

import numpy as np

from ..core.speeds import RPM
from ..core.telling import Tell, tell_nobody
from ..core.vibration import Real
from ..engine.build import Engine
from ..enginefile.fields import printable
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..forces.orders import check_orders
from ..result import Result
from ..sizing.options import SchemeOptions
from ..sizing.remedy import Remedy, fit_devices
from ..sizing.sizing import size
from .build import MountedBody, build_mounted_body
from .modes import BodyModes, find_mounted_modes
from .response import BodyLoads, Meeting, MountingResponse, find_loads, find_meetings, respond

TRAVEL_MOST = 0.05  # m, of a mount that vibrates
_SLOWEST = 1 / 8  # of the file's speed, where nobody says which speeds
_SPEEDS = 141


class Fitted(NamedTuple):
    """The same engine with the devices of a balance scheme."""

    remedy: Remedy
    response: MountingResponse


class Other(NamedTuple):
    """What is shown beside: the engine with a scheme, or another engine on the same mounts."""

    name: str
    response: MountingResponse


@dataclass(frozen=True, eq=False, repr=False)
class MountReport(Result):
    """What the frame feels of a body on its mounts, with its engine or without.

    Attributes:
        name: of the engine, or of the body.
        mounted: the body on its mounts.
        modes: what it is by itself.
        response: to its engine; None where the file has no engine.
        fitted: with a scheme, if one was asked for.
        others: other engines on the same body and mounts.
        assumed_rpm: to which the response goes, where neither the file nor the caller says.
    """

    name: str
    mounted: MountedBody
    modes: BodyModes
    response: MountingResponse | None = None
    fitted: Fitted | None = None
    others: tuple[Other, ...] = ()
    assumed_rpm: float | None = None

    @property
    def summary(self) -> str:
        """Of what, and its natural frequencies."""
        modes = ", ".join(f"{mode.hertz:.3g}" for mode in self.modes.six)
        return f"of {self.name or 'a body'}: modes at {modes} Hz"

    @property
    def beside(self) -> tuple[Other, ...]:
        """All that is shown beside the engine itself."""
        if self.fitted is None:
            return self.others
        return (Other(self.fitted.remedy.scheme, self.fitted.response), *self.others)

    @property
    def doubts(self) -> tuple[str, ...]:
        """That a mount would have to travel farther than any does, in words; of the one that
        travels most.
        """
        if self.response is None:
            return ()
        stiffness, loss, damping = self.mounted.dynamic[2:]
        travels = []
        for k, worst in enumerate(self.response.worst_force):
            dashpot = 1j * worst.order * worst.omega * damping[k]
            travels.append(worst.value / np.abs(stiffness[k] * (1 + 1j * loss[k]) + dashpot).max())
        farthest = int(np.argmax(travels))
        if travels[farthest] <= TRAVEL_MOST:
            return ()
        name = printable(self.mounted.names[farthest])
        rpm = self.response.worst_force[farthest].speed_rpm
        told = (
            f"the mount {name} would travel by {1e3 * travels[farthest]:.3g} mm or more at "
            f"{rpm:.4g} rpm, where stops hold others at 10 to 20; are loss and damping right, "
            "and does it run at that speed, or pass it?"
        )
        return (told,)

    @property
    def meetings(self) -> tuple[Meeting, ...]:
        """Orders that meet modes within the range of speeds, by mode and order."""
        if self.response is None:
            return ()
        return find_meetings(self.modes, self.response.loads, self.response.omega)


def choose_mount_speeds(engine: Engine) -> Real:
    """(speeds,) rpm, where nobody says which: from an eighth of the engine's speed to this."""
    return np.asarray(np.linspace(_SLOWEST, 1.0, _SPEEDS) * float(engine.speed_rpm))


def report_mounts(
    model: EngineFile,
    engine: Engine | None,
    speeds_rpm: Real | None = None,
    orders: Sequence[float] | None = None,
    scheme: str | None = None,
    others: Sequence[tuple[str, Engine]] = (),
    name: str = "",
    tell: Tell = tell_nobody,
    options: SchemeOptions | None = None,
) -> MountReport:
    """Modes and rest of a body on its mounts, and its response to its engine.

    Args:
        model: with [body] and [[mount]].
        engine: None: the first of the others, or modes and rest alone.
        speeds_rpm: (speeds,), rising; default: from an eighth of the engine's speed to this.
        orders: default: all that are considerable.
        scheme: of `sizing.schemes.SCHEMES`; the response is also that with its devices.
        others: names and engines that are put on the same body and mounts, at the same speeds.
        name: of the file, for messages.
        tell: is told which share of the responses is done.
        options: of the scheme.

    Raises:
        InputError: what does not fit together in the file.
        BalcliError: as of `respond`; a scheme that cannot be fitted.
    """
    mounted = build_mounted_body(model, name)
    title = model.name
    if engine is None and others:
        (title, engine), *others = others
    if engine is None:
        return MountReport(title, mounted, find_mounted_modes(mounted))
    try:
        remedy = None if scheme is None else size(engine, scheme, options)
        return _run(title, mounted, engine, speeds_rpm, orders, remedy, others, tell)
    except BalcliError as error:
        raise BalcliError(f"{name}: {error}" if name else str(error)) from None


def _run(
    name: str,
    mounted: MountedBody,
    engine: Engine,
    speeds_rpm: Real | None,
    orders: Sequence[float] | None,
    remedy: Remedy | None,
    others: Sequence[tuple[str, Engine]],
    tell: Tell,
) -> MountReport:
    rpm = choose_mount_speeds(engine) if speeds_rpm is None else speeds_rpm
    omega = rpm * RPM
    asked = None if orders is None else check_orders(orders)
    if asked is not None and asked[0] == 0:
        raise BalcliError("order 0 does not vibrate: what is steady is told as rest; leave it out")
    loads = find_loads(engine, mounted.body.centre, asked)
    modes = find_mounted_modes(mounted, loads.mean)
    done, responses = count(), 1 + (remedy is not None) + len(others)

    def respond_to(loads: BodyLoads) -> MountingResponse:
        before = next(done)
        return respond(
            mounted, modes, loads, omega, lambda share: tell((before + share) / responses)
        )

    response = respond_to(loads)
    fitted = None
    if remedy is not None:
        balanced = fit_devices(engine, remedy)
        left = find_loads(balanced, mounted.body.centre, asked)
        fitted = Fitted(remedy, respond_to(left))
    beside = tuple(
        Other(label, respond_to(find_loads(other, mounted.body.centre, asked)))
        for label, other in others
    )
    assumed = float(engine.speed_rpm) if speeds_rpm is None and engine.speed_assumed else None
    return MountReport(name, mounted, modes, response, fitted, beside, assumed)
