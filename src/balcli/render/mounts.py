"""What a person reads of an engine on its mounts: what the frame feels, modes, rest, speeds."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ..core.vibration import Real
from ..engine.arrays import find_first_largest
from ..mounting.motions import AXES
from ..mounting.report import MountReport
from ..mounting.response import LargestAmplitude, MountingResponse
from .engine_facts import list_silent
from .mounts_document import document, rows
from .sheet import NAMELESS, Facts, Grid, Sheet, Text, degrees, number, order_name
from .units import ShownUnit, System

__all__ = ["document", "rows", "sheet"]

_COLUMNS = 6  # of orders and speeds in a table of a page's width
_ROWS = 9  # speeds of a table
_NEAR = 0.05  # distance of a speed from that at which an order meets a mode
_NEARLY_ALL = 0.99  # less: the rest is no round figure
_SAME = 0.005  # change of a force that is none
_SHARE = 1e-3  # of the largest free load: less is not worth a line
_FORCES, _MOMENTS = ("force x", "force y", "force z"), ("moment x", "moment y", "roll z")


def sheet(result: MountReport, system: System) -> Sheet:
    """What matters first: what the frame feels, then modes, rest and the range of speeds."""
    parts: list[Grid | Facts | Text] = []
    if result.response is not None:
        parts += [Text("What the frame feels", tuple(_answer(result, result.response, system)))]
        parts += _worst(result, system)
    parts += [_modes(result), _body(result, system), _rest(result, system)]
    if result.response is not None:
        if result.meetings:
            parts += [_meetings(result)]
        parts += [_by_speed(result, system), _passed(result.response, system)]
    return Sheet(f"{result.name or NAMELESS}: on its mounts", tuple(parts))


def _answer(result: MountReport, response: MountingResponse, system: System) -> Iterator[str]:
    """In words: where it is worst, and why; what a scheme is worth there."""
    name, worst = _find_hardest(result, response)
    force = system.force
    if worst.value == 0:
        yield "The mounts feel nothing of the orders that count."
    else:
        why = f" {_explain(result, response, worst)}".rstrip()
        yield (
            f"The mount {name} feels most: {_tell(worst, force)}, of which order "
            f"{order_name(worst.order)} alone makes {number(force.of(worst.alone), 4)} "
            f"{force.name}.{why}"
        )
    moved = _find_farthest(result, response)
    if moved and moved[1].value:
        yield f"The point {moved[0]} moves most: {_tell(moved[1], system.length)}."
    if response.loads.gas is None:
        yield "Of inertia alone: the torque of the gas, which rolls an engine too, is not in this."
    else:
        silent = _tell_silent(response)
        yield f"Of inertia and the torque of the gas, the same diagram at every speed{silent}."
    if result.assumed_rpm is not None:
        told = f"{number(result.assumed_rpm, 4)} rpm, which is assumed"
        yield f"The file gives no speed: these are the largest up to {told}."
    for other in result.beside:
        yield f"With {other.name} {''.join(_compare(result, response, other.response, system))}."


def _compare(
    result: MountReport, own: MountingResponse, other: MountingResponse, system: System
) -> Iterator[str]:
    """What is worst of another response, how much less than of the engine's own, and whether gas
    counts in the one and not in the other.
    """
    (_, before), (_, after) = _find_hardest(result, own), _find_hardest(result, other)
    yield f"the largest force of any mount is {_tell(after, system.force)}{_less(after, before)}"
    moved, farthest = _find_farthest(result, own), _find_farthest(result, other)
    if moved and farthest and (moved[1].value or farthest[1].value):
        yield (
            f"; the point {farthest[0]} moves most, {_tell(farthest[1], system.length)}"
            f"{_less(farthest[1], moved[1])}"
        )
    fired = other.loads.gas is not None
    if fired != (own.loads.gas is not None):
        yield ", its gas included" if fired else ", of inertia alone"
    if (silent := _tell_silent(other)) != _tell_silent(own):
        yield silent


def _tell_silent(response: MountingResponse) -> str:
    """Which cylinders do not fire, each after a semicolon."""
    silent = list_silent(response.loads.silent)
    return "".join(f"; {what} {numbers}" for what, numbers in silent)


def _tell(worst: LargestAmplitude, unit: ShownUnit) -> str:
    return f"{number(unit.of(worst.value), 4)} {unit.name} at {number(worst.speed_rpm, 4)} rpm"


def _less(after: LargestAmplitude, before: LargestAmplitude) -> str:
    """How much less that is, after a colon; nothing where there was nothing before."""
    if before.value == 0:
        return ""
    change = after.value / before.value - 1
    if after.value == 0:
        return ": nothing is left"
    less = f"{abs(change):.0%} {'less' if change < 0 else 'more'}"
    if change < -_NEARLY_ALL:
        less = f"over {_NEARLY_ALL:.0%} less"
    return ": as much" if abs(change) < _SAME else f": {less}"


def _find_farthest(
    result: MountReport, response: MountingResponse
) -> tuple[str, LargestAmplitude] | None:
    """The point that moves most, of equal ones the first; None: none is asked for."""
    names, each = result.mounted.point_names, response.worst_motion
    return _find_worst(names, each) if names else None


def _find_hardest(result: MountReport, response: MountingResponse) -> tuple[str, LargestAmplitude]:
    """The mount with the largest force, of equal ones the first."""
    return _find_worst(result.mounted.names, response.worst_force)


def _find_worst(
    names: Sequence[str], each: Sequence[LargestAmplitude]
) -> tuple[str, LargestAmplitude]:
    k = int(find_first_largest([one.value for one in each]))
    return names[k], each[k]


def _explain(result: MountReport, response: MountingResponse, worst: LargestAmplitude) -> str:
    """Why it is worst at this speed."""
    hertz = worst.order * worst.omega / (2 * math.pi)
    mode = result.modes.six[worst.mode]
    named = f"mode {worst.mode + 1} ({mode.motion}, {number(mode.hertz, 3)} Hz)"
    if abs(mode.hertz / hertz - 1) <= _NEAR:
        return f"There it meets {named}: resonance."
    if len(response.omega) == 1:
        return ""
    if worst.omega <= response.omega[0] * (1 + 1e-9):
        nearest = f", nearest to {named}, which makes most of it" if mode.hertz < hertz else ""
        return f"That is the slowest speed of the range{nearest}."
    if worst.omega >= response.omega[-1] * (1 - 1e-9):
        above = "far above all modes, it" if hertz > 1.5 * result.modes.six[-1].hertz else "it"
        return f"That is the fastest speed of the range: {above} grows to the end."
    return f"Most of it is {named}, which is not near the {number(hertz, 3)} Hz of that order."


def _worst(result: MountReport, system: System) -> Iterator[Grid]:
    """The largest force of each mount, and the largest motion of each point that is asked for."""
    several, mounted = _responses(result), result.mounted
    forces = [each.worst_force for each in several]
    yield _worst_grid(result, "force", "mount", mounted.names, forces, system.force)
    if mounted.point_names:
        motions = [each.worst_motion for each in several]
        yield _worst_grid(result, "motion", "point", mounted.point_names, motions, system.length)


def _responses(result: MountReport) -> list[MountingResponse]:
    """Of the engine itself, and of all beside it."""
    own = [] if result.response is None else [result.response]
    return [*own, *(other.response for other in result.beside)]


def _worst_grid(
    result: MountReport,
    figure: str,
    part: str,
    names: Sequence[str],
    several: Sequence[Sequence[LargestAmplitude]],
    unit: ShownUnit,
) -> Grid:
    """A row for each part of this name: of the engine itself, then of all beside it."""
    heads = [part, "all orders", "at, rpm", "largest order", "alone"]
    for other in result.beside:
        heads += [f"with {other.name}", "at, rpm"]
    rows = []
    for k, name in enumerate(names):
        first = several[0][k]
        cells = [name, number(unit.of(first.value), 4), number(first.speed_rpm, 4)]
        cells += [order_name(first.order), number(unit.of(first.alone), 4)]
        for beside in several[1:]:
            cells += [number(unit.of(beside[k].value), 4), number(beside[k].speed_rpm, 4)]
        rows.append(tuple(cells))
    note = (
        "The largest value over the cycle, orders added up in time; over all speeds of the range."
    )
    title = f"Largest {figure} of each {part}, {unit.name}"
    return Grid(title, tuple(heads), tuple(rows), note)


def _modes(result: MountReport) -> Grid:
    damped = any(mode.loss for mode in result.modes.six)
    heads = ("mode", "Hz", "motion", *(f"{axis} %" for axis in AXES))
    heads += ("damping %",) if damped else ()
    rows = [
        (
            str(k),
            number(mode.hertz, 4),
            mode.motion,
            *(f"{round(100 * share, 1) + 0.0:.1f}" for share in mode.shares),
            *((f"{50 * mode.loss:.1f}",) if damped else ()),
        )
        for k, mode in enumerate(result.modes.six, 1)
    ]
    note = (
        "Shares of the kinetic energy in moving along x, y, z and turning about them; products of "
        "inertia may make one negative. Without damping, dynamic stiffness."
    )
    return Grid("Natural modes", heads, tuple(rows), note, words=(0, 2))


def _body(result: MountReport, system: System) -> Facts:
    axis = result.modes.roll_axis
    angle = math.degrees(math.acos(min(1.0, abs(axis[2]))))
    point = [system.length.of(value) for value in result.modes.centre.point]
    place = ", ".join(number(round(value, 6) + 0.0, 4) for value in point)
    along = ", ".join(number(round(float(value), 9) + 0.0, 4) for value in axis)
    rolls = f"({along}) through the centre of gravity, {degrees(angle)} deg from z"
    return Facts(
        (("torque roll axis", rolls), ("elastic centre", f"({place}) {system.length.name}")),
        "The body",
    )


def _rest(result: MountReport, system: System) -> Grid:
    settled, force, length = result.modes.settled, system.force, system.length
    heads = ["mount", *(f"{axis}, {force.name}" for axis in "xyz")]
    heads += [f"travel {axis}, {length.name}" for axis in "xyz"]
    forces, travel = _wipe(settled.forces), _wipe(settled.travel)
    rows = [
        (
            name,
            *(number(force.of(value), 4) for value in forces[k]),
            *(number(length.of(value), 3) for value in travel[k]),
        )
        for k, name in enumerate(result.mounted.names)
    ]
    loads = None if result.response is None else result.response.loads
    leaning = within = ""
    if loads is not None and loads.mean:
        moment = f"{number(system.moment.of(abs(loads.mean)), 4)} {system.moment.name}"
        if result.mounted.carries_load:
            within = f" The load's mean torque of {moment} acts within the body."
        else:
            leaning = f" and the reaction to the load's mean torque of {moment}"
    note = f"Of the body on its mounts, under its weight{leaning}; static stiffness.{within}"
    return Grid("At rest", tuple(heads), tuple(rows), note)


def _wipe(values: Real) -> Real:
    """What is rounding beside the largest is 0."""
    return values * (abs(values) > 1e-12 * abs(values).max())


def _meetings(result: MountReport) -> Grid:
    met = {(one.mode, one.order): one.speed_rpm for one in result.meetings}
    every = sorted({order for _, order in met})
    orders, left = every[:_COLUMNS], len(every[_COLUMNS:])
    heads = ("mode", "Hz", *(f"order {order_name(order)}" for order in orders))
    rows = [
        (
            str(k + 1),
            number(mode.hertz, 4),
            *(number(met[k, order], 4) if (k, order) in met else "–" for order in orders),
        )
        for k, mode in enumerate(result.modes.six)
    ]
    note = f"JSON has {left} order{'s' * (left > 1)} more." if left else ""
    return Grid("Where orders meet modes, rpm", heads, tuple(rows), note)


def _pick(count: int, most: int) -> list[int]:
    """At most so many of a range, evenly, both ends included."""
    if count <= most:
        return list(range(count))
    return [round(k * (count - 1) / (most - 1)) for k in range(most)]


def _by_speed(result: MountReport, system: System) -> Grid:
    several = _responses(result)
    response = several[0]
    heads = ["rpm", *result.mounted.names]
    for other in result.beside:
        heads += [f"{name}, {other.name}" for name in result.mounted.names]
    rows = [
        (
            number(response.speeds_rpm[s], 4),
            *(number(system.force.of(v), 4) for each in several for v in each.force_peak[s]),
        )
        for s in _pick(len(response.omega), _ROWS)
    ]
    title = f"Force of each mount by speed, all orders together, {system.force.name}"
    return Grid(title, tuple(heads), tuple(rows))


def _passed(response: MountingResponse, system: System) -> Grid:
    speeds = _pick(len(response.omega), _COLUMNS - 1)
    last = len(response.omega) - 1
    units = (system.force,) * 3 + (system.moment,) * 3
    heads = ["order", "load", f"rigid, {number(float(response.speeds_rpm[-1]), 4)} rpm"]
    heads += [f"{number(response.speeds_rpm[s], 4)} rpm" for s in speeds]
    rows = []
    for n, order in enumerate(response.loads.orders):
        for k, name in enumerate((*_FORCES, *_MOMENTS)):
            size = response.free[n, last, k]
            largest = response.free[:, last, 3 * (k // 3) : 3 * (k // 3) + 3].max()
            if size > _SHARE * largest:
                cells = [order_name(order), name]
                cells += [f"{number(units[k].of(size), 4)} {units[k].name}"]
                cells += [f"{_ratio(response, n, s, k):.1%}" for s in speeds]
                rows.append(tuple(cells))
    note = (
        "What the mounts pass on, as a share of what the same engine would put on a frame in which "
        "it stood rigidly; moments about the centre of gravity."
    )
    return Grid("Passed on to the frame", tuple(heads), tuple(rows), note, words=(0, 1))


def _ratio(response: MountingResponse, n: int, s: int, k: int) -> float:
    return float(response.passed[n, s, k] / response.free[n, s, k])
