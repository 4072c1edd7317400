"""Engine file -> what its body does on its mounts: the answer of `balcli mounts`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.rigid_body import elastic_centre, roll_axis
from ..core.speeds import RPM
from ..core.telling import Tell, tell_nobody
from ..core.vibration import Real
from ..engine.arrays import find_first_largest
from ..engine.build import Engine
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..forces.orders import check_orders
from ..sizing.options import SchemeOptions
from ..sizing.remedy import fit_devices
from ..sizing.sizing import size
from .build import build_mounted_body, find_mounted_modes, settle
from .loads import find_loads
from .motions import AXES
from .records import (
    AtRest,
    BodyMode,
    Fitted,
    Meeting,
    MountAtRest,
    MountReport,
    Other,
)
from .response import RunningBody, list_meetings, plain_order, respond

_SLOWEST = 1 / 8  # of the file's speed, where nobody says which speeds
_SPEEDS = 141


def choose_mount_speeds(engine: Engine) -> Real:
    """Return the default speeds (rpm): from an eighth of the engine's speed to this."""
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
    """Return the modes and rest of a body on its mounts, and its response to its engine.

    Args:
        model: File with [body] and [[mount]].
        engine: Engine of the file; None: the first of the others, or modes and rest alone.
        speeds_rpm: Speeds, rising, shape (speeds,); default: as of `choose_mount_speeds`.
        orders: Orders of the load; default: all that are considerable.
        scheme: Name of a balance scheme, with whose devices the response is computed as well.
        others: Names and engines that are put on the same body and mounts, at the same speeds.
        name: Name of the file, for messages.
        tell: Function that is called with the share of the responses that is done.
        options: Options of the scheme.

    Raises:
        InputError: Tables of the file do not fit together.
        BalcliError: The scheme cannot be fitted, or as of `respond`.
    """
    mounted = build_mounted_body(model, name)
    title = model.name
    if engine is None and others:
        (title, engine), *others = others
    modes, found, remedy = find_mounted_modes(mounted), [], None
    try:
        asked = None if orders is None else check_orders(orders)
        if asked is not None and asked[0] == 0:
            raise BalcliError(
                "order 0 does not vibrate: what is steady is told as rest; leave it out"
            )
        engines = [] if engine is None else [engine]
        if engine is not None and scheme is not None:
            remedy = size(engine, scheme, options)
            engines.append(fit_devices(engine, remedy))
        for each in (*engines, *(other for _, other in others)):
            rpm = choose_mount_speeds(engines[0]) if speeds_rpm is None else speeds_rpm
            loads = find_loads(each, mounted.body.centre, asked)
            found.append(respond(mounted, RunningBody.of(mounted, modes, loads), rpm * RPM))
            tell(len(found) / (len(engines) + len(others)))
    except BalcliError as error:
        raise BalcliError(f"{name}: {error}" if name else str(error)) from None
    assumed = engine is not None and engine.speed_assumed and speeds_rpm is None
    response = found.pop(0) if found else None
    settled = settle(mounted, response.loads.mean if response else 0.0)
    met = list_meetings(modes, response.loads, response.speeds_rpm) if response else []
    stiffness = modes.stiffness.real
    return MountReport(
        name=title,
        modes=tuple(
            BodyMode(
                float(modes.hertz[k]),
                dict(zip(AXES, (100 * share).tolist(), strict=True)),
                shape * np.copysign(1.0, shape[find_first_largest(share)]),
                modes.motions[k],
                float(modes.loss[k]),
                tuple(Meeting(plain_order(order), rpm) for mode, order, rpm in met if mode == k),
            )
            for k, (shape, share) in enumerate(zip(modes.modes.shapes, modes.shares, strict=True))
        ),
        roll_axis=roll_axis(mounted.body),
        elastic_centre_mm=1e3 * elastic_centre(stiffness, mounted.body.centre).point,
        static=AtRest(tuple(map(MountAtRest, mounted.names, settled.forces, 1e3 * settled.travel))),
        stiffness_N_per_m=stiffness,
        response=response,
        fitted=Fitted(remedy.scheme, found.pop(0), remedy) if remedy else None,
        others=tuple(map(Other, (label for label, _ in others), found)) or None,
        mounted=mounted,
        assumed_rpm=float(engine.speed_rpm) if engine and assumed else None,
    )
