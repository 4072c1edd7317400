"""Which engine a file means: the usual numberings of cylinders, and which of them fit.

The numbers of a firing order mean an engine only with a place for each number. Makers count bank by
bank (B: 1-2-3, 4-5-6) or along the crank (O: 1-3-5, 2-4-6), and which bank comes first differs, so
that one order can mean several engines with different moments. A numbering *fits* if, with all keys
of the file, every cylinder is at its dead centre within 1 deg when it fires. A file without
`layout.numbering` is read by these rules:

- With given throws, bank by bank is meant if it fits.
- Without, the usual numberings are tried in three tiers, and the first tier in which any fits
  decides. One engine in the first tier is used; several engines, or engines of a later tier alone,
  are listed for the user to choose from.
- Two numberings describe the same engine if every place (throw, bank) fires at the same angle, but
  for one shift.

A numbering that the file gives is not doubted; if it does not fit, other keys are proposed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import accumulate, groupby, pairwise
from typing import NamedTuple

import numpy as np

from ..core.loads import Loads, find_needed_series
from ..core.phases import TURN, Phases
from ..core.speeds import RPM
from ..enginefile.model import EngineFile
from ..errors import InputError, Problem
from .arrays import place_in_plane
from .assembly import Assembly
from .devices import build_devices
from .firing import TOLERANCE_DEG, check_firing, find_instants, find_pins, find_splay
from .layout import Plan, bank_angles, cycle_deg

LIST_LENGTH = 3  # engines among which a user is asked to choose
FREE_END = (
    "Numbers count from the free end; a maker who counts from the flywheel end: write every list "
    "the other way round."
)
Rows = tuple[tuple[int, ...], ...]  # cylinder numbers of each bank, free end to flywheel end


# ------------------------------------------------------------------ usual numberings
def list_tiers(plan: Plan, *, radial: bool) -> Iterator[list[Rows]]:
    """Yield the usual numberings of an engine, tier by tier, the most usual first.

    Args:
        plan: banks and throws.
        radial: whether the banks stand evenly round the crank.
    """
    by_bank = [
        [(c.throw, c.bank) for c in plan.cells if c.bank == bank] for bank in range(plan.banks)
    ]
    sizes = [len(row) for row in by_bank]
    ends = list(accumulate(sizes))
    bank_by_bank: Rows = tuple(
        tuple(range(end - size + 1, end + 1)) for size, end in zip(sizes, ends, strict=True)
    )
    if radial:
        yield _distinct([bank_by_bank, (bank_by_bank[0], *reversed(bank_by_bank[1:]))])
    elif plan.banks > 2:
        leftwards = [_count_along(by_bank, sense) for sense in (1, -1)]
        yield _distinct([bank_by_bank, *leftwards])
    else:
        yield from _list_tiers_of_two(bank_by_bank, _count_along(by_bank, 1), plan)


def _count_along(by_bank: Sequence[Sequence[tuple[int, int]]], sense: int) -> Rows:
    """Number the places (throw, bank) along the crank, from the first bank or from the last."""
    places = sorted((p for row in by_bank for p in row), key=lambda p: (p[0], sense * p[1]))
    numbers = {place: number for number, place in enumerate(places, 1)}
    return tuple(tuple(numbers[place] for place in row) for row in by_bank)


def _list_tiers_of_two(bank_by_bank: Rows, odd_and_even: Rows, plan: Plan) -> Iterator[list[Rows]]:
    usual = [bank_by_bank, odd_and_even]
    equal = len(bank_by_bank[0]) == len(bank_by_bank[1])
    exchanged = [(b, a) for a, b in usual] if equal else []
    shared = plan.rods_on_throw > 1
    second_backwards = [(a, b[::-1]) for a, b in usual]
    either_first = [(b, a) for a, b in second_backwards] if equal else []
    yield _distinct([*usual, *(exchanged if shared else ())])
    yield _distinct([*second_backwards, *either_first, *(() if shared else exchanged)])
    yield _distinct([(a[::-1], b[::-1]) for a, b in (*usual, *exchanged)])


def _distinct(numberings: Iterable[Rows]) -> list[Rows]:
    return list(dict.fromkeys(numberings))


# ------------------------------------------------------------------ engines that a file may mean
class FreeLoads(NamedTuple):
    """Free force (N) and moment (N m), largest values of orders 1 and 2, and what counterweights
    leave of both orders together.
    """

    force: tuple[float, float]
    moment: tuple[float, float]
    force_left: float
    moment_left: float


class Candidate:
    """An engine that a file may mean: the file with `layout.numbering` and, where these make it
    fit, other firing intervals or another splay.

    Attributes:
        model: the file with these keys.
        numberings: numberings of this engine; the first one is that of `model`.
        intervals, splay: what the candidate changes besides, deg; None: nothing.
    """

    def __init__(
        self,
        model: EngineFile,
        rows: Rows,
        intervals: tuple[float, ...] | None = None,
        splay: float | None = None,
    ) -> None:
        changed = model.with_table("layout", numbering=rows)
        if intervals is not None:
            changed = changed.with_table("layout", firing_intervals=intervals)
        if splay is not None:
            changed = changed.with_table("crank", splay=splay)
        self.model, self.numberings = changed, [rows]
        self.intervals, self.splay = intervals, splay

    @cached_property
    def parts(self) -> Assembly:
        """The engine, part by part."""
        return Assembly(self.model)

    def fits(self, least_interval: float = 0.0) -> bool:
        """Return whether every cylinder is at its dead centre when it fires, and no firing follows
        the one before it by less than `least_interval` deg.
        """
        if find_missed(self.parts):
            return False
        times = [*map(float, self.parts.fires_deg.values()), cycle_deg(self.model.layout)]
        return min(b - a for a, b in pairwise(times)) >= least_interval - TOLERANCE_DEG

    def is_same(self, other: Candidate) -> bool:
        """Return whether every place fires at the same angle in both engines, but for one shift;
        modulo the cycle if the file has gas, else modulo 360 deg.
        """
        turn = TURN if self.model.gas is None else cycle_deg(self.model.layout)
        mine, theirs = self._fires_at_places(), other._fires_at_places()
        shifts = np.array([theirs[place] - at for place, at in mine.items()])
        off = np.remainder(shifts - shifts[0] + turn / 2, turn) - turn / 2
        return bool(np.all(np.abs(off) <= TOLERANCE_DEG))

    def _fires_at_places(self) -> dict[tuple[int, int], float]:
        fires = self.parts.fires_deg
        return {(c.throw, c.bank): float(fires[c.number]) for c in self.parts.plan.cells}

    @cached_property
    def balance(self) -> FreeLoads:
        """Free forces and moments at the speed of the file; where the file does not say how far
        apart the throws are, moments are those of throws 0.1 m apart.
        """
        model = self.model
        if model.crank.spacing is None and model.crank.positions is None:
            model = model.with_table("crank", spacing=100.0)
        parts, orders = Assembly(model), np.array([1.0, 2.0])
        c, (x, y, z) = parts.cylinders, parts.reference_m
        few, which = c.find_distinct_harmonics(
            orders, find_needed_series(c, {"force", "moment"}, uneven=False)
        )
        devices = tuple(build_devices(model, parts.figures, parts.axes_deg[1]))
        square = (model.operation.speed * RPM) ** 2
        place, own = place_in_plane(x, y), few.select_cylinders(which)
        loads = Loads(c, devices, place, z, Phases(c, orders), own, square)
        force, moment = loads.force.drop_noise(), loads.moment.drop_noise()
        left = [float(abs(p.backward[0]) + p.major[1]) for p in (force, moment)]
        first, second = ((float(p.major[0]), float(p.major[1])) for p in (force, moment))
        return FreeLoads(first, second, *left)

    def describe(self) -> str:
        """Return the line of this engine in a list: keys to copy, throws, balance."""
        keys = [f"layout.numbering = {write_rows(self.numberings[0])}"]
        if self.intervals is not None:
            keys.append(f"layout.firing_intervals = [{_join(self.intervals)}]")
        if self.splay is not None:
            keys.append(f"crank.splay = {self.splay:g}")
        force, moment = (
            " and ".join(f"{value if value > 1e-9 * scale else 0:.4g}" for value in values)
            for values, scale in zip(self.balance[:2], self._scales, strict=True)
        )
        crank = self.model.crank
        known = crank.spacing is not None or crank.positions is not None
        told = f"{moment} N m" if known or self.parts.plan.throws == 1 else "not known"
        same = " or ".join(map(write_rows, self.numberings[1:]))
        return (
            f"{', '.join(keys)}: throws {_join(self.throws_deg)}; cylinder 1 {self._place_first()};"
            f" orders 1 and 2: force {force} N, moment {told}"
            + (f"; the same engine: {same}" if same else "")
        )

    @property
    def throws_deg(self) -> list[float]:
        """Angle of each throw after the first one, deg, in [0, 360)."""
        return _count_throws_from_first(self.parts)

    @property
    def _scales(self) -> tuple[float, float]:
        """Force and moment of one cylinder beside which rounding errors count as 0."""
        c = self.parts.cylinders
        mass = float(np.max(c.reciprocating) + np.max(c.rotating)) or 1.0
        force = mass * float(c.radius.flat[0]) * (self.model.operation.speed * RPM) ** 2
        return force, force * (float(np.ptp(self.parts.throws_m)) or 1.0)

    def _place_first(self) -> str:
        cell = next(c for c in self.parts.plan.cells if c.number == 1)
        angles = bank_angles(self.model.layout, self.parts.figures)
        side = float(np.remainder(angles[cell.bank] + 180.0, 360.0)) - 180.0
        bank = f"bank {cell.bank + 1}"
        if len(angles) == 2 and side:
            bank = f"the {'left' if side < 0 else 'right'} bank seen from the free end"
        return f"on {bank}, throw {cell.throw + 1}"

    def rank(self, position: int) -> tuple[float, float, float, float]:
        """Return the key to sort lines by: less of what counterweights leave, less splay, and the
        position in the tier; with one rod a throw, odd and even numbers before bank by bank.
        """
        force, moment = self._scales
        if self.parts.plan.rods_on_throw == 1:
            position = {0: 1, 1: 0}.get(position, position)
        return (
            round(self.balance.force_left / force, 6),
            round(self.balance.moment_left / moment, 6),
            abs(self.splay or 0.0),
            position,
        )


def find_missed(parts: Assembly) -> list[Problem]:
    """Return what is wrong with the first cylinder that is not at its dead centre when it fires;
    articulated rods may be at their true dead centres, or at their nominal ones.
    """
    if parts.order is None:
        return []
    try:
        fires = parts.fires_deg
    except InputError as error:
        return list(error.problems)
    ways = [parts.true_tops_deg, *([parts.tops_deg] if parts.model.articulation else [])]
    missed = [list(check_firing(fires, parts.leads_deg, tops, parts.sense)) for tops in ways]
    return min(missed, key=len)


def find_fitting_splay(model: EngineFile) -> float | None:
    """`crank.splay` (deg) with which the cylinders of a file fire in its order and at its
    intervals, evenly where it gives none; None where there is none, or no firing order.
    """
    parts = Assembly(model)
    if parts.order is None or parts.plan.rods_on_throw == 1:
        return None
    fires = find_instants(parts.order, model.layout.firing_intervals, cycle_deg(model.layout))
    wanted = find_pins(fires, parts.tops_deg, parts.sense)
    cells = sorted(parts.plan.cells, key=lambda cell: (cell.throw, cell.bank))
    by_throw = groupby(cells, key=lambda cell: cell.throw)
    splay = find_splay([wanted[cell.number] for cell in on_throw] for _, on_throw in by_throw)
    if splay is None:
        return None
    split = Assembly(model.with_table("crank", splay=splay))
    missed = any(check_firing(fires, split.leads_deg, split.tops_deg, split.sense))
    return None if missed else splay


# ------------------------------------------------------------------ the rules
def is_open(parts: Assembly) -> bool:
    """Return whether the file leaves open which cylinder has which number: it has several banks, a
    firing order and no numbering, and gives no cylinder a place of its own.
    """
    layout = parts.model.layout
    own = parts.model.cylinder.values()
    free = any(c.bank is not None or c.throw is not None or c.position is not None for c in own)
    unsaid = layout.numbering is None and parts.order is not None and not free
    return unsaid and not parts.varies and parts.plan.banks > 1


def infer_numbering(model: EngineFile) -> EngineFile:
    """Return the file with the numbering that it leaves out, if the throws are left out as well and
    the rules decide on one; else the file as it is.

    The key counts as not given: it is not in `model_fields_set` and is not written.
    """
    parts = Assembly(model)
    try:
        if not is_open(parts) or parts.throws_given:
            return model
        engines, tier = find_engines_meant(parts)
    except InputError:  # which the rules of `engine.rules` report
        return model
    if tier != 1 or len(engines) != 1:
        return model
    changed = engines[0].model
    changed.layout.model_fields_set.discard("numbering")
    return changed


def check_numbering(parts: Assembly) -> Iterator[Problem]:
    """Find a firing order that does not fit the crank, or that could mean several engines."""
    missed = find_missed(parts)
    if not is_open(parts):
        yield from (p._replace(message=p.message + _suggest(parts)) for p in missed)
        return
    if parts.throws_given and not missed:
        return
    engines, tier = find_engines_meant(parts)
    if tier == 1 and len(engines) == 1 and not parts.throws_given:
        return
    order = "-".join(map(str, parts.order or ()))
    if engines:
        several = f"one of {len(engines)} engines" if len(engines) > 1 else "this engine"
        told = f"is not given, and with the firing order {order} the file may mean {several}"
    elif engines := _find_remedies(parts):
        told = f"is not given, and no usual one fits the firing order {order}; it may mean"
    else:
        yield from (
            p._replace(message=f"{p.message}, or give layout.numbering" + _suggest(parts))
            for p in missed or _miss_everywhere(order)
        )
        return
    lines = [engine.describe() for engine in engines[:LIST_LENGTH]]
    yield Problem("layout.numbering", "\n    ".join([f"{told}:", *lines, FREE_END]))


def _miss_everywhere(order: str) -> list[Problem]:
    return [Problem("layout.firing_order", f"{order} fits no usual numbering of the cylinders")]


def find_engines_meant(parts: Assembly) -> tuple[list[Candidate], int]:
    """Return the engines that the usual numberings of the first tier describe in which any fits,
    the better balanced first, and that tier from 1; none and 0 if none fits.

    With given throws and no intervals, firings nearer than half the even interval do not fit.
    """
    layout = parts.model.layout
    least = 0.0
    if parts.throws_given and layout.firing_intervals is None:
        least = cycle_deg(layout) / len(parts.plan.cells) / 2
    tiers = list_tiers(parts.plan, radial=layout.radial is not None)
    for number, tier in enumerate(tiers, 1):
        fitting = [one for rows in tier if (one := Candidate(parts.model, rows)).fits(least)]
        if fitting:
            return _sort(fitting, tier), number
    return [], 0


def _find_remedies(parts: Assembly) -> list[Candidate]:
    """Return the engines that fit with the intervals of shared pins, and then those that fit with
    another splay, of the numberings of the first tier; none where the file gives the splay.
    """
    model, plan = parts.model, parts.plan
    two_on_throw = plan.banks == 2 and plan.rods_on_throw == 2
    if "splay" in model.crank.model_fields_set or not two_on_throw:
        return []
    tier = next(list_tiers(plan, radial=model.layout.radial is not None))
    uneven = [] if model.layout.firing_intervals else list(_list_shared_intervals(parts))
    by_intervals = [Candidate(model, rows, intervals) for rows in tier for intervals in uneven]
    by_splay = []
    for rows in tier:
        splay = find_fitting_splay(model.with_table("layout", numbering=rows))
        if splay is not None:
            by_splay.append(Candidate(model, rows, splay=splay))
    common = _sort([one for one in by_intervals if one.fits()], tier)
    split = [one for one in _sort(by_splay, tier) if not any(map(one.is_same, common))]
    return [*common[: LIST_LENGTH - bool(split)], *split]


def _list_shared_intervals(parts: Assembly) -> Iterator[tuple[float, ...]]:
    """Yield the intervals of two rods on one pin: the bank angle and the rest of two even intervals
    in turn, begun with either.
    """
    first, second = map(float, bank_angles(parts.model.layout, parts.figures))
    both = 2 * cycle_deg(parts.model.layout) / len(parts.plan.cells)
    angle = abs((second - first + 180) % TURN - 180)
    for vee in (angle, angle + TURN):
        if 0 < vee < both:
            pairs = len(parts.plan.cells) // 2
            yield (vee, both - vee) * pairs
            yield (both - vee, vee) * pairs


def _sort(fitting: Sequence[Candidate], tier: Sequence[Rows]) -> list[Candidate]:
    """Return one candidate for each different engine, the better balanced first."""
    engines: list[Candidate] = []
    for one in fitting:
        twin = next(filter(one.is_same, engines), None)
        if twin is None:
            engines.append(one)
        elif one.numberings[0] not in twin.numberings and one.splay == twin.splay:
            twin.numberings += one.numberings
    return sorted(engines, key=lambda one: one.rank(tier.index(one.numberings[0])))


# ------------------------------------------------------------------ a numbering that does not fit
def _suggest(parts: Assembly) -> str:
    """Return other keys with which every cylinder fires at its dead centre, in words: intervals
    begun one later, throws counted the other way round, other throws, another splay; else empty.
    """
    if parts.varies:
        return ""
    model, intervals = parts.model, parts.model.layout.firing_intervals
    ways: list[tuple[str, EngineFile]] = []
    if intervals is not None:
        later = (*intervals[1:], intervals[0])
        keys = f"layout.firing_intervals = [{_join(later)}]"
        ways.append((keys, model.with_table("layout", firing_intervals=later)))
    if model.crank.throws is not None:
        throws = tuple(-throw % TURN for throw in model.crank.throws)
        keys = f"crank.throws = [{_join(throws)}], which count in the sense of rotation"
        ways.append((keys, model.with_table("crank", throws=throws)))
        if len(throws) > 1:
            free = model.with_table("crank", throws=None)
            listed = _join(_count_throws_from_first(Assembly(free)))
            ways.append((f"crank.throws = [{listed}]", free))
    if "splay" not in model.crank.model_fields_set:
        splay = find_fitting_splay(model)
        if splay is not None:
            keys = f"crank.splay = {splay:g}"
            ways.append((keys, model.with_table("crank", splay=splay)))
    fitting = (keys for keys, changed in ways if not find_missed(Assembly(changed)))
    return next((f". It fits with {keys}" for keys in fitting), "")


# ------------------------------------------------------------------ what a file leaves out
def list_inferred(parts: Assembly) -> Iterator[str]:
    """Yield keys with values that are taken because the file leaves them out, where results depend
    on them: `layout.strokes = 4`.
    """
    model, plan = parts.model, parts.plan
    layout, given = model.layout, model.layout.model_fields_set
    if parts.order is None or parts.rank:
        return
    inferred = not parts.throws_given
    if plan.banks > 1 and "numbering" not in given and (inferred or model.gas is not None):
        cells = groupby(plan.cells, key=lambda cell: cell.bank)
        yield f"layout.numbering = {write_rows([[c.number for c in bank] for _, bank in cells])}"
    if inferred:
        yield f"crank.throws = [{_join(_count_throws_from_first(parts))}]"
        if layout.firing_intervals is None:
            times = [*map(float, parts.fires_deg.values()), cycle_deg(layout)]
            yield f"layout.firing_intervals = [{_join(b - a for a, b in pairwise(times))}]"
    if "strokes" not in given and (inferred or model.gas is not None):
        yield f"layout.strokes = {layout.strokes}"


def _count_throws_from_first(parts: Assembly) -> list[float]:
    """Return the angle of each throw after the first one, deg, in [0, 360)."""
    throws = [float(parts.throws_deg[t]) for t in range(parts.plan.throws)]
    return [round(throw - throws[0], 3) % TURN for throw in throws]


# ------------------------------------------------------------------ what is allowed and unlikely
USUAL_ORDERS = {
    4: "1-3-4-2 or 1-2-4-3",
    5: "1-2-4-5-3 or 1-3-5-4-2",
    6: "1-5-3-6-2-4 or 1-4-2-6-3-5",
    8: "1-6-2-5-8-3-7-4",
}
USUAL_FLAT_ORDERS = {
    4: "1-4-3-2 bank by bank, 1-3-2-4 with odd numbers in one bank",
    6: "1-6-2-4-3-5 bank by bank, 1-6-3-2-5-4 or 1-4-5-2-3-6 with odd numbers in one bank",
}


def doubt_firing(model: EngineFile) -> Iterator[str]:
    """Yield warnings: a numbering that was inferred, a crank inferred from an order that nobody
    builds, and throws with which all cylinders fire in one revolution of two.
    """
    parts = Assembly(model)
    if parts.order is None:
        return
    layout, plan = model.layout, parts.plan
    if layout.numbering is not None and "numbering" not in layout.model_fields_set:
        rows = layout.numbering
        if rows != next(list_tiers(plan, radial=layout.radial is not None))[0]:
            yield (
                f"layout.numbering is not given; {write_rows(rows)} is used, with which the firing "
                "order fits; give it if it is so"
            )
    order = "-".join(map(str, parts.order))
    if parts.throws_given:
        times = [*map(float, parts.fires_deg.values()), cycle_deg(layout)]
        gaps = [b - a for a, b in pairwise(times)]
        if layout.firing_intervals is None and len(gaps) > 2 and max(gaps) > TURN + TOLERANCE_DEG:
            yield (
                f"layout.firing_order: {order} fires after {_join(gaps)} deg with these throws; "
                f"if it is so, say layout.firing_intervals = [{_join(gaps)}]"
            )
    elif layout.firing_intervals is None and layout.strokes == 4:
        usual = ""
        if plan.banks == 1 and not _is_usual(parts.order):
            usual = USUAL_ORDERS.get(len(parts.order), "")
        elif plan.banks == 2 and plan.rods_on_throw == 1 and not _has_opposite_pins(parts):
            usual = USUAL_FLAT_ORDERS.get(len(parts.order), "")
        if usual:
            listed = _join(_count_throws_from_first(parts))
            yield (
                f"layout.firing_order: {order} needs the throws {listed}, which nobody builds; "
                f"usual is {usual}; if it is so, give crank.throws"
            )


def _is_usual(order: Sequence[int]) -> bool:
    """Return whether an in-line engine is built with this order: its crank is its own mirror image
    end for end, or that of a usual five.
    """
    count, begin = len(order), order.index(1)
    turned = (*order[begin:], *order[:begin])
    if count % 2:
        return count != 5 or "-".join(map(str, turned)) in USUAL_ORDERS[5].split(" or ")
    pairs = zip(turned[: count // 2], turned[count // 2 :], strict=True)
    return all(a + b == count + 1 for a, b in pairs)


def _has_opposite_pins(parts: Assembly) -> bool:
    """Return whether the pins of neighbouring cylinders of a flat engine stand 180 deg apart; true
    for other engines.
    """
    first, second = map(float, bank_angles(parts.model.layout, parts.figures))
    if abs((second - first) % TURN - 180) > TOLERANCE_DEG:
        return True
    throws = [float(parts.throws_deg[t]) for t in range(parts.plan.throws)]
    pairs = zip(throws[::2], throws[1::2], strict=False)
    return all(abs((b - a) % TURN - 180) <= TOLERANCE_DEG for a, b in pairs)


def write_rows(rows: Sequence[Sequence[int]]) -> str:
    """Return a numbering as a file has it."""
    return str([list(row) for row in rows])


def _join(numbers: Iterable[float]) -> str:
    return ", ".join(f"{number:.6g}" for number in numbers)
