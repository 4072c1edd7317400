"""Engine: what the computation needs of an engine file, in SI units, one row per cylinder, with its
devices.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import speed_ripple as ripple
from ..core.cylinders import Cylinders, Device
from ..core.mechanisms import harmonics
from ..enginefile.model import Bobweight, EngineFile
from ..errors import InputError, Problem
from ..limits import MOST_SAMPLES
from . import articulation
from .arrays import column, shared
from .devices import devices
from .layout import Plan, plan
from .positions import are_places_known, pins, places, reference, share_axes, strangers
from .rods import Parts, mistakes, own_or, rod_of

if TYPE_CHECKING:
    from ..core.mechanisms.articulated import Articulated
    from ..core.mechanisms.rotary import Rotary

STANDSTILL = 1e-12  # of the mean speed: rounding


class Ripple(NamedTuple):
    """One line of an uneven crank speed: `omega = mean (1 + sum amplitude cos(order theta -
    angle))`.
    """

    order: int
    amplitude: Any
    angle_deg: Any


class Weighed(NamedTuple):
    """Masses of one cylinder as a shop weighs them, kg, and on which throw (from 0) its rod runs.

    `share` is the pin's share of the throw mass; bearing and oil count on the bobweight card only.
    """

    throw: int
    piston: Any
    small_end: Any
    big_end: Any
    share: Any
    rod_bearing: Any
    oil: Any


@dataclass(frozen=True, eq=False)
class Engine:
    """An engine, SI except where a name says otherwise; arrays may have a trailing axis of
    variants.

    Attributes:
        numbers: cylinder number of each row of `cylinders`.
        fires_deg: firing angle by cylinder number, where the file gives a firing order.
        throws_m: place of each throw along the crank.
        reference_m: point about which moments are taken.
        weighed: masses behind each row of `cylinders`.
        devices: counterweights, shafts and sliders of the file, in this order.
        places_known: whether the file says where its throws stand along the crank; if not, they
            count as standing in one plane, and what is said of moments means nothing.
    """

    name: str
    source: str
    numbers: tuple[int, ...]
    cylinders: Cylinders
    fires_deg: Mapping[int, Any]
    strokes: int
    bore_m: Any
    throws_m: NDArray[np.float64]
    speed_rpm: Any
    ripple: tuple[Ripple, ...]
    reference_m: tuple[Any, Any, Any]
    devices: tuple[Device, ...]
    weighed: tuple[Weighed, ...]
    places_known: bool = True

    @property
    def omega(self) -> Any:
        """Mean crank speed, rad/s."""
        return self.speed_rpm * (math.pi / 30)

    @property
    def displacement_m3(self) -> Any:
        """Swept volume by bore and twice the crank radius."""
        return math.pi / 4 * self.bore_m**2 * (2 * self.cylinders.radius) * self.cylinders.count

    @property
    def first_axis_deg(self) -> Any:
        """Where cylinder 1's crank pin points at crank angle 0."""
        return self.cylinders.axis_deg[self.cylinders.first]

    @property
    def equal(self) -> bool:
        """Whether all cylinders have one mechanism and one set of reciprocating masses."""
        c = self.cylinders
        return len(c.lam) == len(c.eps) == len(c.reciprocating) == 1 and (
            c.linkage is None or len(c.linkage.mass) == 1
        )

    @property
    def rotary(self) -> bool:
        """Whether the cylinders turn and the crank stands still: then the cylinders have masses on
        a linkage only.
        """
        c = self.cylinders
        return c.linkage is not None and c.linkage.turning

    @property
    def pins_deg(self) -> dict[int, Any]:
        """Crank pin by cylinder number."""
        return dict(zip(self.numbers, self.cylinders.pin_deg, strict=True))


def build(file: EngineFile, rank: int = 0) -> Engine:
    """The engine that a file describes.

    Args:
        file: a checked model; numbers in it may have been replaced by arrays of variants.
        rank: number of axes of those arrays, which broadcast against each other; what does not vary
        along an axis has length 1
            there, here and in all that is computed.

    Raises:
        InputError: what does not fit together, by its path in the file.
    """
    layout, rods = _parts(file)
    axis = _axes(file, layout)
    pin, fires = pins(file, layout, _tops(file, rods, axis))
    along, throws = places(file, layout, rank)
    cylinders, numbers = _cylinders(file, layout, rods, axis, pin, along, rank)
    _refuse(articulation.locked(file, cylinders, numbers))
    if not rank:
        _refuse(_strained(cylinders))
    return Engine(
        name=file.name,
        source=file.source,
        numbers=numbers,
        cylinders=cylinders,
        fires_deg=fires,
        strokes=file.layout.strokes,
        bore_m=math.nan if file.piston.bore is None else file.piston.bore / 1e3,
        throws_m=throws,
        speed_rpm=file.operation.speed,
        ripple=tuple(
            Ripple(line.order, line.amplitude, line.angle) for line in file.operation.speed_ripple
        ),
        reference_m=reference(file, throws),
        devices=tuple(devices((*file.counterweight, *file.shaft, *file.slider), axis[1])),
        weighed=tuple(
            _weighed(file, layout, {c.number: c.throw for c in layout.cells}[n], rods[n])
            for n in numbers
        ),
        places_known=are_places_known(file, layout),
    )


def _parts(file: EngineFile) -> tuple[Plan, dict[int, Parts]]:
    """Cylinders and rods; InputError with all that does not fit together in them."""
    try:
        layout = plan(file.crank, file.layout)
    except (
        InputError
    ) as error:  # rods can be looked at all the same, as far as it is known which they are
        _refuse(
            [
                *error.problems,
                *_rods(file, (0, *(() if file.articulation else file.cylinder)), {})[1],
                *_stopped(file),
            ]
        )
        raise
    masters = articulation.masters(file, layout)
    rods, faults = _rods(file, layout.numbers, masters)
    _refuse(
        [
            *articulation.mistakes(file, layout),
            *strangers(layout, file.cylinder),
            *faults,
            *_stopped(file),
        ]
    )
    return layout, rods


def _stopped(file: EngineFile) -> Iterator[Problem]:
    """An uneven speed (or the first of its variants) at which the crank would not turn on."""
    lines = file.operation.speed_ripple
    figures = np.broadcast_arrays(
        0.0, *(figure for line in lines for figure in (line.amplitude, line.angle))
    )[1:]
    for variant in zip(*map(np.ravel, figures), strict=True):
        if sum(map(abs, variant[::2])) < 1 - STANDSTILL:
            continue
        least, theta = ripple.find_slowest(
            [
                (line.order, *own)
                for line, *own in zip(lines, variant[::2], variant[1::2], strict=True)
            ]
        )
        if least <= STANDSTILL:
            yield Problem(
                "operation.speed_ripple",
                f"the crank would {'turn back' if least < -STANDSTILL else 'stop'}: at crank angle "
                f"{math.degrees(theta):.4g} deg its speed is "
                f"{least if abs(least) > STANDSTILL else 0:.4g} of the mean; it must "
                "stay above 0: make the amplitudes smaller, they are shares of the mean speed "
                "(0.01 is one per cent)",
            )
            return


def _rods(
    file: EngineFile, numbers: Iterable[int], masters: Mapping[int, int]
) -> tuple[dict[int, Parts], list[Problem]]:
    """Rods of these cylinders (0: the engine's own), and what is wrong with them."""
    rods = {n: rod_of(file, n, n in masters) for n in numbers}
    return rods, [
        p
        for n, rod in rods.items()
        for p in mistakes(file, n, rod, file.crank.stroke / 2e3, n in masters)
    ]


def tops(file: EngineFile) -> dict[int, Any]:
    """Where the crank pin of each cylinder stands when it is at top dead centre, deg from x;
    InputError with mistakes of the file.

    Nominally on its axis where rods are articulated: only then do all cylinders of a throw fire
    evenly.
    """
    layout, rods = _parts(file)
    return _tops(file, rods, _axes(file, layout))


def _tops(file: EngineFile, rods: Mapping[int, Parts], axis: Mapping[int, Any]) -> dict[int, Any]:
    if file.articulation is not None:
        return dict(axis)
    sense = -1 if file.layout.rotary else 1  # in which the crank turns, seen from a cylinder
    return {n: axis[n] + sense * rod.top_deg(file.crank.stroke / 2e3) for n, rod in rods.items()}


def _axes(file: EngineFile, layout: Plan) -> dict[int, Any]:
    return {c.number: own_or(file, c.number, "bank", layout.banks[c.bank]) for c in layout.cells}


def _cylinders(
    file: EngineFile,
    layout: Plan,
    rods: Mapping[int, Parts],
    axis: Mapping[int, Any],
    pin: Mapping[int, Any],
    along: Mapping[int, Any],
    rank: int,
) -> tuple[Cylinders, tuple[int, ...]]:
    """Rows sorted by axis, and the number of each."""
    still, turning = axis, {n: pin[n] - pin[1] for n in layout.numbers}
    if file.layout.rotary:  # cylinders turn about pins that stand still (core.rotary)
        still = {n: axis[1] + turning[n] for n in axis}
        turning = {n: axis[n] - axis[1] for n in axis}
    banks = share_axes(still)
    numbers = tuple(chain.from_iterable(banks))
    starts = np.cumsum([0, *map(len, banks[:-1])])
    parts, radius = [rods[n] for n in numbers], file.crank.stroke / 2e3
    masters = articulation.masters(file, layout)
    at_pistons = shared([rod.piston + rod.small_end for rod in parts], rank)
    hung = articulation.linkage(file, layout, numbers, axis, [rod.big_end for rod in parts], rank)
    return Cylinders(
        axis_deg=column([still[bank[0]] for bank in banks], rank),
        pin_deg=column([turning[n] for n in numbers], rank),
        starts=starts,
        first=next(k for k, bank in enumerate(banks) if 1 in bank),
        z=column([along[n] for n in numbers], rank),
        radius=column([radius], rank)[0],
        lam=shared([radius / rod.length for rod in parts], rank),
        eps=shared([rod.offset / rod.length for rod in parts], rank),
        reciprocating=0 * at_pistons if file.layout.rotary else at_pistons,
        rotating=shared(
            [
                _at_pin(file, layout, rod, n in masters)
                for n, rod in zip(numbers, parts, strict=True)
            ],
            rank,
        ),
        couple=shared([rod.couple for rod in parts], rank),
        linkage=_rotary(at_pistons, hung) if file.layout.rotary else hung,
    ), numbers


def _rotary(at_pistons: NDArray[np.float64], hung: Articulated | None) -> Rotary:
    from ..core.mechanisms.rotary import Rotary

    if hung is None:
        return Rotary(at_pistons)
    both = at_pistons + hung.mass
    return Rotary(both, hung, hung.mass / np.where(both == 0, 1.0, both))


def _weighed(file: EngineFile, layout: Plan, throw: int, rod: Parts) -> Weighed:
    extra = file.bobweight or Bobweight.model_construct()
    return Weighed(
        throw,
        rod.piston,
        rod.small_end,
        rod.big_end,
        file.crank.throw_mass / layout.rods_on_throw,
        extra.rod_bearing,
        extra.oil,
    )


def _at_pin(file: EngineFile, layout: Plan, rod: Parts, articulated: bool) -> Any:
    """What turns with a crank pin because of one cylinder, kg; the pins of a rotary engine stand
    still.
    """
    if file.layout.rotary:
        return 0.0
    return (0.0 if articulated else rod.big_end) + file.crank.throw_mass / layout.rods_on_throw


def _strained(c: Cylinders) -> Iterator[Problem]:
    """So many different mechanisms so near their lock that they would take minutes."""
    if c.count * harmonics.HARDEST <= MOST_SAMPLES:
        return
    count = c.linkage.count_all_samples if c.linkage else harmonics.count_all_samples
    different, samples = count(c.lam, c.eps)
    if samples > MOST_SAMPLES:
        yield Problem(
            "cylinder",
            f"the cylinders have {different} different mechanisms, some so near their lock that "
            "all of them need "
            f"{samples} samples of a revolution; at most {MOST_SAMPLES} are taken: make these "
            "rods longer, or more "
            "of them equal",
        )


def _refuse(problems: Iterable[Problem]) -> None:
    if found := tuple(dict.fromkeys(problems)):
        raise InputError(found)
