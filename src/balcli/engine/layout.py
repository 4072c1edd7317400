"""Compute the plan of an engine (bank, throw and number of each cylinder), and the crank pin angles
that its firing order needs.

Firing (docs/theory.md): cylinder i is at top dead centre when its crank pin is an angle `tau_i`
ahead of its axis, with `sin tau_i = e_i / (r + l_i)` (piston offset e, crank radius r, rod length
l). To fire at a crank angle `f_i` after cylinder 1, cylinder i needs its crank pin at an angle `g_i
- g_1 + tau_i - tau_1 - f_i` from cylinder 1's pin, where g is the angle of a cylinder's axis. In
the functions below, angles are in degrees, may be arrays of variants, and are given by cylinder
number: `fires` is the firing angle, `pins` the angle of the crank pin, `tops` the angle of the pin
at top dead centre, `g_i + tau_i`. `sense` is 1, or -1 if the cylinders turn about a crank at rest;
`tops` is then `g_i - tau_i`.
"""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import accumulate, groupby, pairwise, repeat
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from ..core.phases import TURN
from ..core.phasors import Array, Figure
from ..errors import InputError, Problem
from ..file.fields import counted, join_words
from ..file.firing_order import NamedOrder, write_order
from ..file.model import Crank, EngineFile, Layout
from ..limits import MOST_PARTS
from .figures import FileFigures, or_zero


class Cell(NamedTuple):
    """Cylinder with its bank and throw, counted from 0, and its number."""

    bank: int
    throw: int
    number: int


class Plan(NamedTuple):
    """All cylinders of an engine.

    Attributes:
        banks: Number of banks.
        throws: Number of throws.
        cells: The cylinders, sorted by bank and throw.
        rods_on_throw: Number of rods on each throw.
        in_rows: Whether `layout.numbering` has a list for each row (the cylinders of one throw)
            instead of a list for each bank.
    """

    banks: int
    throws: int
    cells: tuple[Cell, ...]
    rods_on_throw: int
    in_rows: bool = False

    @property
    def numbers(self) -> tuple[int, ...]:
        return tuple(cell.number for cell in self.cells)

    @property
    def groups(self) -> list[list[Cell]]:
        """The cylinders, grouped like the lists of `layout.numbering`."""
        key = attrgetter("throw" if self.in_rows else "bank")
        return [list(group) for _, group in groupby(sorted(self.cells, key=key), key)]


def plan_cylinders(model: EngineFile) -> Plan:
    """Return the cylinders of an engine.

    Raises:
        InputError: Positions, numbering or firing order do not fit the throws and banks.
    """
    crank = model.crank
    layout = model.layout
    banks = count_banks(layout)
    if problems := list(_check_letters(layout, banks)):
        raise InputError(problems)
    shared = layout.rods == "shared" or banks == 1
    rods = banks if shared else 1
    cylinders = len(layout.firing_order or ())
    if crank.throws is None and cylinders % rods:
        message = f"has {cylinders} cylinders, which {rods} banks cannot share evenly: "
        message += f"give crank.throws, or a multiple of {rods} cylinders"
        raise InputError([Problem("layout.firing_order", message)])
    silent = [number for number, own in model.cylinder.items() if own.gas == 0]
    left_out = [number for number in silent if number not in (layout.firing_order or silent)]
    if crank.throws is None and left_out:
        message = f"the firing order gives no throw for cylinder {left_out[0]}, which it leaves out"
        raise InputError([Problem.of_missing("crank.throws", message)])
    throws = max(cylinders // rods, 1) if crank.throws is None else len(crank.throws)
    if crank.throws is None and not cylinders and layout.rows is not None:
        throws = layout.rows
    if max(banks, throws, throws * banks * shared) > MOST_PARTS:  # memory might not suffice
        message = (
            f"{counted(banks, 'bank')} on {counted(throws, 'throw')} are too many; "
            f"no engine has more than {MOST_PARTS} cylinders"
        )
        raise InputError([Problem("layout" if banks > 1 else "crank.throws", message)])
    all_places = ((bank, throw) for bank in range(banks) for throw in range(throws))
    places = [(bank, throw) for bank, throw in all_places if shared or throw % banks == bank]
    in_rows = layout.in_rows and layout.radial is not None
    blank = Plan(banks, throws, tuple(Cell(*place, 0) for place in places), rods, in_rows)
    numbers, problems = _number_cylinders(layout, blank)
    problems += [*_check_rows(model, throws), *_check_throws(crank, throws)]
    problems += _check_bank_sizes(layout, blank)
    if not shared and throws < banks:
        message = f'is "alternating", one rod a throw, for {counted(banks, "bank")} and '
        message += f'{counted(throws, "throw")}: give more throws, or "shared"'
        problems.append(Problem("layout.rods", message))
    problems += _check_firing_order(model, sorted(numbers.values()), throws)
    if problems:
        raise InputError(problems)
    return blank._replace(cells=tuple(c._replace(number=numbers[c]) for c in blank.cells))


def _check_rows(model: EngineFile, throws: int) -> Iterator[Problem]:
    """Check that each row of a radial has its own throw, and that the throws' angles are known."""
    crank = model.crank
    layout = model.layout
    if not layout.in_rows:
        return
    key = "rows" if layout.rows is not None else "row_angle"
    if layout.radial is None:
        yield Problem(f"layout.{key}", "needs layout.radial")
    elif layout.rods != "shared":
        yield Problem(f"layout.{key}", 'a throw carries a whole row: give rods = "shared"')
    elif layout.rows not in (None, throws):
        message = f"crank.throws has {counted(throws, 'throw')}"
        if crank.throws is None:
            message = f"layout.firing_order has cylinders for {throws}"
        yield Problem("layout.rows", f"{counted(layout.rows or 0, 'row')}, but {message}")
    elif throws > len(OPPOSED) and crank.throws is None and layout.firing_order is None:
        yield Problem.of_missing("crank.throws", f"{throws} rows need the angle of every throw")


def _check_throws(crank: Crank, throws: int) -> Iterator[Problem]:
    """Check that lists of figures of the throws have a figure for each throw."""
    for key in ("positions", "stroke", "throw_mass"):
        given = getattr(crank, key)
        if isinstance(given, tuple) and len(given) != throws:
            message = f"has {counted(len(given), 'value')} for {counted(throws, 'throw')}"
            yield Problem(f"crank.{key}", f"{message}; give one per throw")


OPPOSED = (0.0, 180.0)  # default angles of one or two throws, deg


def count_banks(layout: Layout) -> int:
    """Return the number of banks."""
    if layout.bank_angle is not None:
        return 2
    return layout.radial or len(layout.banks or (0.0,))


def bank_angles(layout: Layout, figures: FileFigures) -> tuple[Figure, ...]:
    """Return the angle of each bank from x, deg. A vee is symmetrical about x; the first bank of a
    radial engine is on x.

    Args:
        layout: Table of the engine file.
        figures: Figures of the file, which may vary.
    """
    angle = figures.take_optional("layout.bank_angle", layout.bank_angle)
    if angle is not None:
        return -angle / 2, angle / 2
    if layout.radial is not None:
        return tuple(TURN * k / layout.radial for k in range(layout.radial))
    return figures.take_each("layout.banks", layout.banks or (0.0,))


def find_row_angle(layout: Layout, throws: int, figures: FileFigures) -> Figure:
    """Return the angle by which the row on each throw is turned from the one before it, deg; 0
    unless the engine is a radial in rows.

    Args:
        layout: Table of the engine file.
        throws: Number of throws.
        figures: Figures of the file, which may vary.
    """
    given = figures.take_optional("layout.row_angle", layout.row_angle)
    if given is None and layout.rows is not None:
        return TURN / (count_banks(layout) * throws)
    return or_zero(given)


def cycle_deg(layout: Layout) -> float:
    """Return the crank angle from one firing of a cylinder to its next, deg."""
    return TURN * layout.strokes / 2


def _number_cylinders(layout: Layout, plan: Plan) -> tuple[dict[Cell, int], list[Problem]]:
    """Return the number of each cylinder of a plan without numbers, as given by the file or counted
    group by group; and the mistakes in the given numbers.
    """
    cells = [cell for group in plan.groups for cell in group]
    default = dict(zip(cells, range(1, len(cells) + 1), strict=True))
    if layout.numbering is None:
        return default, []
    sizes, given = [[len(row) for row in rows] for rows in (plan.groups, layout.numbering)]
    if given != sizes:
        right = "bank, from the free end to the flywheel end"
        if plan.in_rows:
            right = "row, in the direction of rotation"
        message = f"has lists of {join_words(given)} cylinders, but {join_words(sizes)} are there"
        return default, [Problem("layout.numbering", f"{message}: give one list per {right}")]
    numbers = [number for row in layout.numbering for number in row]
    if sorted(numbers) != [*default.values()]:
        message = _describe_not_once(numbers, [*default.values()])
        return default, [Problem("layout.numbering", message)]
    return dict(zip(cells, numbers, strict=True)), []


def _check_firing_order(
    model: EngineFile, numbers: Sequence[int], throws: int
) -> Iterator[Problem]:
    """Check that the firing order has every cylinder once; dummies, which have no gas, may be left
    out. If its length is the number of throws, the message proposes alternating rods.
    """
    layout = model.layout
    order = model.layout.firing_order
    silent = {number for number, own in model.cylinder.items() if own.gas == 0}
    silent |= find_compressing(model, numbers)
    if order is None or (
        len({*order}) == len(order) and {*numbers} - silent <= {*order} <= {*numbers}
    ):
        return
    message = _describe_not_once(order, numbers)
    banks = count_banks(layout)
    in_turn = 1 < banks <= throws == len(order) and layout.rods == "shared"
    dummies = {*numbers} if {*order} <= {*numbers} and not in_turn else model.cylinder.keys()
    if first := next((n for n in numbers if n not in order and n in dummies), 0):
        message += f"; write [cylinder.{first}] gas = 0 if cylinder {first} is a dummy piston"
    if in_turn:
        message += (
            f"; every throw carries a rod of each of the {banks} banks: if the banks take the "
            'throws in turn, as in a boxer, give layout.rods = "alternating"'
        )
    yield Problem("layout.firing_order", message)


def find_compressing(model: EngineFile, numbers: Sequence[int]) -> set[int]:
    """Return the cylinders with a compressor cycle, which do not fire."""
    if model.gas is None:
        return set()
    from ..file.gas_tables import list_compressing  # loaded only for files with [gas]

    return list_compressing(model.gas, numbers)


MOST_LETTERED_BANKS = 4  # as an X engine has; every way to give letters to banks is tried


def _check_letters(layout: Layout, banks: int) -> Iterator[Problem]:
    """Check that a firing order with letters has a letter for each bank, and that the file has no
    other numbering.
    """
    order = layout.firing_order
    if not isinstance(order, NamedOrder):
        return
    if layout.has("numbering"):
        message = "firing_order has letters, and the letters say it; leave numbering out"
        yield Problem("layout.numbering", message)
    message = f"names the banks {join_words(order.letters)}"
    if layout.in_rows or banks > MOST_LETTERED_BANKS:
        message += (
            f"; letters are read for 2 to {MOST_LETTERED_BANKS} banks without rows: write the "
        )
        yield Problem("layout.firing_order", f"{message}numbers of the cylinders")
    elif len(order.letters) != banks:
        message += f", but layout has {counted(banks, 'bank')}; give bank_angle, or the angle of "
        yield Problem("layout.firing_order", f"{message}every bank in banks")


def _check_bank_sizes(layout: Layout, plan: Plan) -> Iterator[Problem]:
    """Check that a firing order with letters has as many cylinders of each letter as a bank has."""
    order = layout.firing_order
    sizes = [len(group) for group in plan.groups]
    if isinstance(order, NamedOrder) and sorted(order.bank_sizes) != sorted(sizes):
        message = f"{_describe_bank_sizes(order)}, but the banks have {join_words(sizes)} cylinders"
        yield Problem("layout.firing_order", message)


def _describe_bank_sizes(order: NamedOrder) -> str:
    """Return how many cylinders the names in a firing order give to each bank."""
    sizes = map(counted, order.bank_sizes, repeat("cylinder"))
    banks = [f"{size} of {letter}" for size, letter in zip(sizes, order.letters, strict=True)]
    return f"has {join_words(banks)}"


def _describe_not_once(given: Sequence[int], wanted: Sequence[int]) -> str:
    """Return in words which numbers are doubled, unknown or missing."""
    times = Counter(given)
    doubled = [n for n in sorted(times) if times[n] > 1 and n in wanted]
    parts = [f"cylinder {n} occurs {times[n]} times" for n in doubled]
    parts += [f"there is no cylinder {n}" for n in sorted(times) if n not in wanted]
    if missing := [n for n in wanted if n not in times]:
        parts.append(f"missing: {join_words(missing)}")
    return f"{', '.join(parts)}; each of the cylinders 1 to {len(wanted)} must occur once"


def are_places_known(model: EngineFile, plan: Plan, varied: Collection[str] = ()) -> bool:
    """Return whether the file gives the positions of the throws along the crank; a single throw
    needs none.

    Args:
        model: Engine file.
        plan: Its cylinders.
        varied: Names of figures that vary, which count as given.
    """
    crank = model.crank
    said = crank.spacing is not None or crank.positions is not None or "crank.spacing" in varied
    own = any(cylinder.position is not None for cylinder in model.cylinder.values())
    return plan.throws == 1 or said or own


# Tolerance of angles, deg: offsets, angles and intervals in files are rounded; real mistakes amount
# to tens of degrees.
TOLERANCE_DEG = 1.0


def find_instants(
    order: Sequence[int], intervals: Sequence[Figure] | None, cycle: float
) -> dict[int, Figure]:
    """Return the crank angle from the first firing to that of each cylinder, by cylinder number.

    Args:
        order: Firing order, numbers of cylinders.
        intervals: Angles from each firing to the next, deg; None for even firing.
        cycle: Length of a cycle, deg.
    """
    if intervals is None:
        return {number: cycle * k / len(order) for k, number in enumerate(order)}
    return dict(zip(order, accumulate(intervals, initial=0.0), strict=False))


def find_pins(
    fires: Mapping[int, Figure], tops: Mapping[int, Figure], sense: int
) -> dict[int, Array]:
    """Return the crank pin angle that each cylinder needs, deg in [0, 360), from the pin of the
    cylinder that `find_first` returns.

    Args:
        fires: Crank angle of firing by cylinder, deg.
        tops: Angle of each cylinder's crank pin at top dead centre, deg.
        sense: 1, or -1 for cylinders that turn about a crank at rest.
    """
    first = find_first(fires)
    return {
        i: np.remainder((tops[i] - tops[first]) - sense * (f - fires[first]), 360.0)
        for i, f in fires.items()
    }


def find_first(fires: Mapping[int, Figure]) -> int:
    """Return the cylinder from which firing angles count: 1, or the first of the firing order if
    cylinder 1 is a dummy.
    """
    return 1 if 1 in fires else next(iter(fires))


def find_intervals(order: Sequence[int], ready: Mapping[int, float], cycle: float) -> list[float]:
    """Return the intervals from each firing to the next of a firing order on a given crank: the
    shortest that the dead centres allow.

    In a two-stroke, cylinders that are at top dead centre together fire together: their interval is
    0. In a four-stroke, it is a whole turn: a parallel twin whose pistons move together fires every
    360 degrees. If the intervals add up to less than a cycle, the missing turns are added one by
    one to the shortest interval; of equally short intervals, to the last.

    Args:
        order: Firing order, numbers of cylinders.
        ready: Crank angle at which each cylinder is at top dead centre, deg, from any zero.
        cycle: Length of a cycle, deg.

    Raises:
        InputError: The order takes more than a cycle.
    """
    find_each = _find_two_stroke_intervals if cycle == TURN else _find_four_stroke_intervals
    intervals = find_each([ready[number] for number in [*order, order[0]]])
    total = round(sum(intervals) / TURN) * TURN
    if total > cycle:
        raise InputError([_describe_too_long(order, ready, total, cycle)])
    for _ in range(int((cycle - total) // TURN)):
        shortest = min(reversed(range(len(intervals))), key=lambda k: round(intervals[k], 6))
        intervals[shortest] += TURN
    return intervals


def _find_four_stroke_intervals(ready: Sequence[float]) -> list[float]:
    """Return the angles from each dead centre to the next, deg: above `TOLERANCE_DEG`, up to a turn
    more.
    """
    turned = [(after - before) % TURN for before, after in pairwise(ready)]
    return [angle if angle > TOLERANCE_DEG else angle + TURN for angle in turned]


def _find_two_stroke_intervals(ready: Sequence[float]) -> list[float]:
    """Return the angles from each dead centre to the next, deg, from 0 up to a turn. An angle
    within `TOLERANCE_DEG` of a whole turn counts as 0, and the next angle makes up for the
    difference.
    """
    intervals: list[float] = []
    left_over = 0.0
    for before, after in pairwise(ready):
        angle = (after - before + left_over) % TURN
        apart = (angle + TURN / 2) % TURN - TURN / 2
        if abs(apart) <= TOLERANCE_DEG:
            intervals.append(0.0)
            left_over = apart
        else:
            intervals.append(angle)
            left_over = 0.0
    return intervals


def _describe_too_long(
    order: Sequence[int], ready: Mapping[int, float], total: float, cycle: float
) -> Problem:
    """Return the mistake of a firing order that takes more than a cycle."""
    first = ready[order[0]]
    even = find_instants(order, None, cycle)
    gaps = {number: float(ready[number] - first - fires) for number, fires in even.items()}
    off = (number for number, gap in gaps.items() if abs((gap + 180) % 360 - 180) > TOLERANCE_DEG)
    message = (
        f"{write_order(order)} would take {total:g} deg with these crank.throws, but a "
        f"cycle has {cycle:g}; with even firing every {cycle / len(order):g} deg, cylinder "
        f"{next(off, order[-1])} is the first that is not at top dead centre when it fires: "
        "change firing_order or crank.throws, or leave crank.throws out"
    )
    return Problem("layout.firing_order", message)


def check_firing(
    fires: Mapping[int, Figure],
    pins: Mapping[int, Figure],
    tops: Mapping[int, Figure],
    sense: int = 1,
) -> Iterator[Problem]:
    """Yield the mistake of the first cylinder that is not at top dead centre when it fires.

    Args:
        fires: Crank angle of firing by cylinder, deg.
        pins: Crank pin angle of each cylinder, deg, from cylinder 1's.
        tops: Angle of each cylinder's crank pin at top dead centre, deg.
        sense: 1, or -1 for cylinders that turn about a crank at rest.
    """
    first = find_first(fires)
    for i, wanted in find_pins(fires, tops, sense).items():
        ahead = pins[i] - pins[first]
        off = float(np.max(np.abs(np.remainder(ahead - wanted + 180.0, 360.0) - 180.0)))
        if off > TOLERANCE_DEG:
            yield Problem(
                "layout.firing_order",
                f"cylinder {i} is not at top dead centre when it fires: its crank pin is "
                f"{float(np.ravel(ahead)[0]) % 360:.6g} deg ahead of cylinder {first}'s, but would "
                f"have to be {float(np.ravel(wanted)[0]):.6g} deg ahead (within {TOLERANCE_DEG:g} "
                "deg); change crank.throws, crank.splay, firing_order or firing_intervals",
            )
            return
