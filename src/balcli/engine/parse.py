"""Text or tables of an engine file -> its checked model: every mistake at once, each by its path in
the file and with what would be right.

`RULES` say what fits together across tables. A rule looks at an engine as far as it is put
together, and names the tables that it needs. So the mistakes of a file of which some tables cannot
be read are found by the same rules.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..core.mechanisms import harmonics
from ..core.speed_ripple import RippleLine, find_slowest
from ..errors import InputError, Problem
from ..file.model import EngineFile
from ..file.plain_tables import normalize_tables
from ..file.read import Draft, check_tables, read_tables, refuse
from ..file.toml import name_file, read_bytes
from ..limits import MOST_SAMPLES
from .articulation import check_articulation, check_knuckles
from .numbering import check_numbering, infer_numbering
from .parts import Parts
from .rods import RodPlace, RunningGear, check_ends, check_rod_inertia, check_turning, weigh_rod

STANDSTILL = 1e-12  # of the mean speed: rounding
_BANKS = ("bank_angle", "banks", "radial", "rods", "numbering", "firing_order")
_PLAN = frozenset(  # which cylinders there are
    {"crank.throws", "crank.positions", *(f"layout.{key}" for key in _BANKS)}
)


class Rule(NamedTuple):
    """A check, and the keys of the file that it needs."""

    check: Callable[[Parts], Iterator[Problem]]
    needs: frozenset[str]


def find_contradictions(parts: Parts) -> list[Problem]:
    """Return what the tables of a file say against each other, as far as they could be read.

    All that the first rules that find something find, each mistake once: the others are about
    engines of which those hold.
    """
    for rules in RULES:
        applicable = [rule for rule in rules if rule.needs <= parts.legible]
        problems = [problem for rule in applicable for problem in _apply(rule, parts)]
        if problems:
            return list(dict.fromkeys(problems))
    return []


def _apply(rule: Rule, parts: Parts) -> Iterator[Problem]:
    """The mistakes that a rule finds, or those for which what it looks at cannot be worked out."""
    try:
        yield from rule.check(parts)
    except InputError as error:
        yield from error.problems


def check_cylinders(parts: Parts) -> Iterator[Problem]:
    """Throws and banks make an engine, and tables of single cylinders are of those that it has."""
    count = len(parts.plan.cells)
    made = (
        f"crank.throws and layout make {count} cylinder{'s' * (count > 1)}; give every throw its "
        "angle in crank.throws"
    )
    for number in parts.model.cylinder:
        if number not in parts.plan.numbers:
            yield Problem(f"cylinder.{number}", f"there is no cylinder {number}: {made}")


def check_masters(parts: Parts) -> Iterator[Problem]:
    """Articulated rods have a master rod on their throw, and knuckle pins that fit."""
    if parts.model.articulation is not None:
        yield from check_articulation(parts, parts.model.articulation)


def check_rods(parts: Parts) -> Iterator[Problem]:
    """Every rod has a moment of inertia, and lets its crank turn.

    How far an articulated rod can follow depends on its master: `check_knuckle_pins`.
    """
    looked_at = set()
    for number, articulated in _list_rods(parts):
        rod = (number if number in parts.own else 0, articulated)
        if rod not in looked_at:
            looked_at.add(rod)
            yield from _check_rod(parts, parts.find_rod(number, articulated))


def _list_rods(parts: Parts) -> list[tuple[int, bool]]:
    """Cylinders, and whether their rods are articulated; number 0 stands for what holds for all
    where it is not known which cylinders there are.
    """
    if not parts.legible >= {*_PLAN, "articulation"}:
        return [(0, False)]
    try:
        return [(number, number in parts.masters) for number in parts.plan.numbers]
    except InputError:
        own = () if parts.model.articulation else parts.own
        return [(number, False) for number in (0, *own)]


def _check_rod(parts: Parts, place: RodPlace) -> Iterator[Problem]:
    one_end = list(check_ends(place))
    yield from one_end
    gear = _weigh_rod(parts, place)
    if gear is None:
        return
    if not one_end:
        yield from check_rod_inertia(place, gear)
    if "crank.stroke" in parts.legible and not place.articulated:
        yield from check_turning(place, gear, parts.radius)


def _weigh_rod(parts: Parts, place: RodPlace) -> RunningGear | None:
    """A rod with its piston, or without where that is not known; None where its length is not."""
    if parts.legible >= {"crank.stroke", "piston"}:
        return parts.weigh_gear(place)
    if "crank.stroke" in parts.legible:
        return weigh_rod(place.rod, place.rod.length_for(parts.radius))
    return None if place.rod.length is None else weigh_rod(place.rod, place.rod.length)


def check_half_orders(parts: Parts) -> Iterator[Problem]:
    """Half orders of an uneven speed come of four strokes, and of the gas that makes them."""
    if parts.model.gas is not None and parts.model.layout.strokes == 4:
        return
    for number, line in enumerate(parts.model.operation.speed_ripple, 1):
        if line.order % 1:
            yield Problem(
                f"operation.speed_ripple.{number}.order",
                f"{line.order:g} is no whole number; half orders take four strokes and [gas]",
            )


def check_speed(parts: Parts) -> Iterator[Problem]:
    """An uneven speed stays above 0."""
    if not (lines := parts.find_ripple()):
        return
    orders = [line.order for line in lines]
    figures = [figure for line in lines for figure in (line.amplitude, line.angle_deg)]
    columns = map(np.ravel, np.broadcast_arrays(*figures))
    for variant in zip(*columns, strict=True):
        amplitudes, angles = variant[::2], variant[1::2]
        if sum(map(abs, amplitudes)) < 1 - STANDSTILL:
            continue
        slowest = find_slowest(list(map(RippleLine, orders, amplitudes, angles)))
        if slowest.value <= STANDSTILL:
            share = slowest.value if abs(slowest.value) > STANDSTILL else 0.0
            yield Problem(
                "operation.speed_ripple",
                f"the crank would {'turn back' if share else 'stop'}: at crank angle "
                f"{math.degrees(slowest.theta):.4g} deg its speed is {share:.4g} of the mean; it "
                "must stay above 0: make the amplitudes smaller, they are shares of the mean speed "
                "(0.01 is one per cent)",
            )
            return


def check_knuckle_pins(parts: Parts) -> Iterator[Problem]:
    """Articulated rods can follow their knuckle pins all the way round."""
    if parts.model.articulation is not None:
        yield from check_knuckles(parts.model, parts.cylinders, parts.numbers)


def check_samples(parts: Parts) -> Iterator[Problem]:
    """Not too many mechanisms differ and are near their lock: they would take minutes."""
    c = parts.cylinders
    if parts.rank or c.count * harmonics.HARDEST <= MOST_SAMPLES:
        return
    different, samples = c.count_all_samples()
    if samples > MOST_SAMPLES:
        yield Problem(
            "cylinder",
            f"the cylinders have {different} different mechanisms, some so near their lock that "
            f"all of them need {samples} samples of a revolution; at most {MOST_SAMPLES} are "
            "taken: make these rods longer, or more of them equal",
        )


def check_gas(parts: Parts) -> Iterator[Problem]:
    """Gas in every cylinder can be worked out; what a cylinder says of it has [gas] to refer to."""
    if parts.model.gas is None:
        for number, own in parts.model.cylinder.items():
            for key in ("gas", "heat", "indicator"):
                dummy = key == "gas" and parts.order is not None and number not in parts.order
                if getattr(own, key) is not None and not dummy:
                    yield Problem(
                        f"cylinder.{number}.{key}",
                        "needs [gas], which says what the gas does in all cylinders",
                    )
    elif parts.gas is None and not parts.rank:
        from .build_gas import build_gas  # files without [gas] do not pay for it

        parts.gas = build_gas(parts)  # raises InputError with all mistakes


_WHOLE = frozenset({"crank", "rod", "piston", "layout", "articulation", "cylinder"})
RULES = (
    (
        Rule(check_cylinders, _PLAN),
        Rule(check_masters, _PLAN | {"crank.splay", "articulation"}),
        Rule(check_rods, frozenset({"rod"})),
        Rule(check_half_orders, frozenset({"operation", "layout.strokes", "gas"})),
        Rule(check_speed, frozenset({"operation"})),
    ),
    (Rule(check_knuckle_pins, _WHOLE),),
    (Rule(check_numbering, _WHOLE),),
    (Rule(check_samples, _WHOLE),),
    (Rule(check_gas, _WHOLE | {"gas"}),),
)


def read(path: str | Path) -> EngineFile:
    """The model of the engine file at a path, or from standard input for "-".

    Raises:
        BalcliError: there is nothing to read.
        InputError: every mistake that the text has.
    """
    return parse(read_bytes(path), name_file(path))


def parse(text: str | bytes, name: str = "") -> EngineFile:
    """The model of an engine that a TOML text describes; `name` is that of its file, for messages.

    Raises:
        InputError: every mistake that the text has; and then also what does not fit together in the
            tables that could be read.
    """
    return _refuse_mistakes(read_tables(text, name), name)


def parse_tables(tables: Mapping[str, Any], name: str) -> EngineFile:
    """Return the model of an engine that normalized tables describe.

    Args:
        tables: As of `normalize_tables`.
        name: Name of the file, beside which those stand that it names, or empty.

    Raises:
        InputError: As of `parse`.
    """
    return _refuse_mistakes(check_tables(tables, Path(name).parent, name), name)


def parse_dict(tables: Mapping[str, Any], folder: Path | None = None) -> EngineFile:
    """The model of an engine that the tables of a dict describe.

    Args:
        tables: as a file has them.
        folder: in which the files are that they name; default: the working directory.

    Raises:
        InputError: as of `parse`.
    """
    return _refuse_mistakes(check_tables(normalize_tables(tables), folder or Path()))


def _refuse_mistakes(draft: Draft, name: str = "") -> EngineFile:
    if not draft.problems:
        return infer_numbering(draft.model)
    contradictions = find_contradictions(Parts(draft.model, legible=draft.legible))
    raise refuse([*draft.problems, *contradictions], name)
