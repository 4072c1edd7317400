"""Analyze the vibration of an engine on its mounts: `mounts`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import NoneType

import numpy as np
from numpy.typing import ArrayLike

from ..core.phases import RPM
from ..core.vibration import Real
from ..engine.engine import Engine, check_engine, take_model
from ..engine.left_out import list_chapter_defaults
from ..errors import BalcliError, check_type
from ..file.assumed import Assumed, join_assumed, select_assumed
from ..file.fields import order_number
from ..file.model import EngineFile
from ..file.plain_tables import take_tables
from ..file.read import check_tables
from ..forces.spectrum import check_orders
from ..process import Tell, tell_nobody
from ..shell.arguments import check_speeds
from ..show.sheet import NAMELESS
from ..sizing.options import SchemeOptions
from ..sizing.remedy import fit_devices
from ..sizing.sizing import size
from .build import Meeting, build_mounted_body, check_mounted, find_mounted_modes, settle
from .records import AtRest, Fitted, MountAtRest, MountReport, Other
from .response import RunningBody, list_meetings, respond
from .rigid_body import drop_rounding, elastic_centre, roll_axis

_SLOWEST = 1 / 8  # lowest default speed, as a share of the file's speed
_SPEEDS = 141
_OF_BODY = ("body", "mount")  # tables of the file whose default values are listed as assumed


def choose_mount_speeds(engine: Engine) -> Real:
    """Return the default speeds (rpm), from an eighth of the engine's speed to its speed."""
    return np.asarray(np.linspace(_SLOWEST, 1.0, _SPEEDS) * float(engine.speed_rpm))


def report_mounts(
    model: EngineFile,
    engine: Engine | None,
    speeds_rpm: Real | None = None,
    orders: Iterable[float] | None = None,
    scheme: str | None = None,
    others: Sequence[tuple[str, Engine]] = (),
    name: str = "",
    tell: Tell = tell_nobody,
    options: SchemeOptions | None = None,
    *,
    ranged: bool = True,
) -> MountReport:
    """Return the natural modes of a body on its mounts, its position at rest, and its response to
    the engine.

    Args:
        model: File with [body] and [[mount]].
        engine: Engine of the file; None: the first of `others` takes its place. Without any engine,
            only modes and rest are computed.
        speeds_rpm: Rising speeds, shape (speeds,); default: those of `choose_mount_speeds`.
        orders: Orders of the load; default: all that contribute to the response.
        scheme: Name of a balance scheme; the response with its devices is computed as well.
        others: Names and engines for further responses on the same body and mounts, at the same
            speeds.
        name: Name of the file, for messages.
        tell: Called with the share of the responses computed so far.
        options: Options of the scheme.
        ranged: Whether the speeds represent a whole range, so that resonances between them count.

    Raises:
        InputError: Tables of the file do not fit together.
        BalcliError: The scheme cannot be fitted, or `respond` fails.
    """
    mounted = build_mounted_body(model, name)
    title = model.name
    if engine is None and others:
        (title, engine), *others = others
    modes = find_mounted_modes(mounted)
    responses = []
    remedy = None
    try:
        asked = None if orders is None else check_orders(orders)
        if asked is not None and asked[0] == 0:
            raise BalcliError(
                'order 0 is steady and does not vibrate; leave it out (see the table "At rest")'
            )
        engines = [] if engine is None else [engine]
        if engine is not None and scheme is not None:
            remedy = size(engine, scheme, options)
            engines.append(fit_devices(engine, remedy))
        engines += [other for _, other in others]
        for running_engine in engines:
            rpm = choose_mount_speeds(engines[0]) if speeds_rpm is None else speeds_rpm
            omega = rpm * RPM
            running = RunningBody.choose(
                mounted, modes, running_engine, omega, asked, ranged=ranged
            )
            responses.append(respond(mounted, running, rpm, ranged=ranged))
            tell(len(responses) / len(engines))
    except BalcliError as error:
        raise error.within(name) from None
    first = [] if engine is None else [(title or NAMELESS, engine)]
    idle = () if speeds_rpm is None else ("operation.speed",)
    response = responses.pop(0) if responses else None
    forces, travel = settle(mounted, response.loads.mean if response else 0.0)
    rest = (mounted.names, drop_rounding(forces), drop_rounding(1e3 * travel))
    meetings: list[list[Meeting]] = [[] for _ in modes.each]  # by mode
    if response is not None:
        for k, order, met_rpm in list_meetings(modes, response.loads, response.speeds_rpm):
            meetings[k].append(Meeting(order_number(order), met_rpm))
    stiffness = modes.stiffness.real
    centre = elastic_centre(stiffness, mounted.body.centre)
    farthest = np.abs(mounted.dynamic.at).max(initial=0.0)
    return MountReport(
        name=title,
        assumed=_list_assumed(model, [*first, *others], without=idle),
        modes=tuple(
            mode._replace(meets=tuple(met)) for mode, met in zip(modes.each, meetings, strict=True)
        ),
        roll_axis=drop_rounding(roll_axis(mounted.body)),
        elastic_centre_mm=1e3 * drop_rounding(centre, farthest),
        static=AtRest(tuple(map(MountAtRest, *rest))),
        stiffness_N_per_m=stiffness,
        response=response,
        fitted=Fitted(remedy.scheme, responses.pop(0), remedy) if remedy else None,
        others=tuple(map(Other, (label for label, _ in others), responses)) or None,
        mounted=mounted,
    )


def _list_assumed(
    model: EngineFile, engines: Sequence[tuple[str, Engine]], without: Sequence[str]
) -> tuple[Assumed, ...] | None:
    """Return the assumed values of all engines on the mounts, of the body and of the mounts; None
    if there are none.

    Args:
        model: File with [body] and [[mount]].
        engines: Engines and their names.
        without: Keys to omit.
    """
    names = [name for name, _ in engines]
    lists = [engine.list_assumed("gas", without=without) for _, engine in engines]
    of_body = select_assumed(list_chapter_defaults(model), _OF_BODY)
    return (*join_assumed(names, lists), *of_body) or None


def mounts(
    source: Engine | str | Path | Mapping[str, object],
    speeds: ArrayLike | None = None,
    *,
    orders: Iterable[float] | None = None,
    scheme: str | None = None,
    others: Mapping[str, Engine] | None = None,
) -> MountReport:
    """Return the vibration of an engine on its mounts: natural modes, rest, forces of the mounts on
    the frame and motion of points over a range of speeds.

    Args:
        source: Engine whose file has [body] and [[mount]]; or the path of such a file, its text or
            a dict of its tables. A file may also describe body and mounts without an engine.
        speeds: Speeds, rpm, in any order; default: from an eighth of the file's speed to it.
            Three or more speeds at equal steps are a range, within which no order may drive an
            undamped mode at its natural frequency.
        orders: Orders of the load; default: all that contribute to the response.
        scheme: Balance scheme; `fitted` is the response with its devices.
        others: Further engines on the same mounts, by name.

    Returns:
        The document of `balcli mounts` as records: `modes` (`frequency_Hz`, `motion`, ...),
        `response` (`mounts` and `points`, with `peak_N` or `peak_mm` at each of `speeds_rpm`,
        and the largest value as `worst`; None without an engine), `fitted`, `others`.

    Raises:
        BalcliError: An undamped mode is driven within the range, or the scheme cannot be fitted.
        InputError: The file has mistakes, or a motion of the body is not restrained by any mount.
        TypeError: The source or an argument has a wrong type.

    Example:
        >>> [mode.frequency_Hz for mode in mounts("i4_mounts.toml").modes]
    """
    rpm = check_speeds("mounts", speeds)
    beside = others or {}
    check_type("mounts", beside, Mapping, 'give a dict, such as {"V8": engine}')
    engines = [(str(name), check_engine("mounts", one)) for name, one in beside.items()]
    check_type("scheme", scheme, (str, NoneType), 'give its name, such as "counterweights"')
    model, engine, name = _read(source)
    steps = np.diff([] if rpm is None else rpm)
    ranged = rpm is None or (len(steps) > 1 and np.ptp(steps) <= 1e-9 * steps.max())
    return report_mounts(model, engine, rpm, orders, scheme, engines, name, ranged=ranged)


def _read(source: object) -> tuple[EngineFile, Engine | None, str]:
    """Return the file, its engine if it has one, and its name."""
    if isinstance(source, Engine):
        return take_model(source), source, ""
    wanted = "give an Engine, or the path, text or dict of a file with [body] and [[mount]]"
    tables, name = take_tables("mounts", source, wanted)
    draft = check_tables(tables, Path(name).parent, name, bare=True)
    return (*check_mounted(draft, name)[:2], name)
