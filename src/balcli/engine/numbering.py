"""Infer the numbering of cylinders from a firing order, or list the engines that fit the file.

A firing order describes an engine only if each number has a known place (bank and throw). Makers
number bank by bank (1-2-3, 4-5-6) or along the crank (1-3-5, 2-4-6), and begin with different
banks. So one order can mean several engines with different moments. A numbering *fits* if, with all
keys of the file, every cylinder is within 1 deg of its dead centre when it fires. A file without
`layout.numbering` is read by these rules:

- If the file gives throws, numbering bank by bank is used if it fits.
- Otherwise the usual numberings are tried in up to three tiers, from the most usual on; the first
  tier with a numbering that fits decides. If the file gives no throws, and the numberings of tier 1
  that fit describe only one engine, this engine is used. Otherwise the user has to choose among the
  engines of the tier.
- Two numberings describe the same engine if their firing angles differ by the same shift at all
  places (throw, bank).

A numbering in the file is never replaced; if it does not fit, the error proposes changes of single
keys.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise

import numpy as np

from ..core.loads import Loads, find_needed_series
from ..core.mechanisms.closed_form import select_cylinders
from ..core.phases import RPM, TURN, Phases
from ..core.phasors import Phasors
from ..errors import InputError, Problem
from ..file.model import EngineFile
from ..limits import SMALL
from .devices import build_devices
from .figures import place_in_plane
from .layout import (
    TOLERANCE_DEG,
    Cell,
    Plan,
    are_places_known,
    bank_angles,
    check_firing,
    cycle_deg,
    find_instants,
    find_pins,
)
from .parts import Parts

LIST_LENGTH = 3  # largest number of engines in a list to choose from
FREE_END = (
    "Numbers count from the free end. If the maker counts from the flywheel end, reverse every "
    "list."
)
Rows = tuple[tuple[int, ...], ...]  # cylinder numbers in the lists of layout.numbering


# ------------------------------------------------------------------ usual numberings
def list_tiers(plan: Plan, *, radial: bool) -> Iterator[list[Rows]]:
    """Yield the usual numberings of an engine, tier by tier, the most usual first.

    Args:
        plan: Banks and throws.
        radial: Whether the banks are evenly spaced round the crank.
    """
    bank_by_bank = _number_rows(plan, chain(*plan.groups))
    if plan.in_rows:
        yield [bank_by_bank]
        yield [_number_rows(plan, plan.cells)]  # round the engine, from row to row
        return
    if radial:
        yield [bank_by_bank, (bank_by_bank[0], *reversed(bank_by_bank[1:]))]
        return
    along = _number_rows(plan, sorted(plan.cells, key=lambda c: (c.throw, c.bank)))
    if plan.banks > 2:
        from_last_bank = _number_rows(plan, sorted(plan.cells, key=lambda c: (c.throw, -c.bank)))
        yield [bank_by_bank, along, from_last_bank]
        return
    usual, shared = [bank_by_bank, along], plan.rods_on_throw > 1
    equal = usual if len(bank_by_bank[0]) == len(bank_by_bank[1]) else []
    exchanged = [(b, a) for a, b in equal]
    second_backwards = [(a, b[::-1]) for a, b in usual]
    either_first = [(b[::-1], a) for a, b in equal]
    yield [*usual, *(exchanged if shared else ())]
    yield [*second_backwards, *either_first, *(() if shared else exchanged)]
    yield [(a[::-1], b[::-1]) for a, b in (*usual, *exchanged)]


def _number_rows(plan: Plan, cells: Iterable[Cell]) -> Rows:
    """Return the numbering in which the cells are counted in this order."""
    numbers = {cell: number for number, cell in enumerate(cells, 1)}
    return tuple(tuple(numbers[cell] for cell in group) for group in plan.groups)


def list_numbers(plan: Plan) -> Rows:
    """Return the numbers of the cylinders as `layout.numbering` lists them."""
    return tuple(tuple(cell.number for cell in group) for group in plan.groups)


# ------------------------------------------------------------------ engines that a file may mean
@dataclass
class Candidate:
    """An engine that a file may mean.

    Attributes:
        model: The file with `layout.numbering` and, if needed to fit, other firing intervals or
            another splay.
        numberings: Numberings that describe this engine; the first is that of `model`.
        change: Key to change and its new value as text, `crank.splay = 30`, if this engine fits
            only with this change; else empty.
    """

    model: EngineFile
    numberings: list[Rows]
    change: str = ""

    @cached_property
    def parts(self) -> Parts:
        """Stages of the engine."""
        return Parts(self.model)

    def fits(self, least_interval: float = 0.0) -> bool:
        """Return whether every cylinder is at its dead centre when it fires, and no firing follows
        the firing before it by less than `least_interval` deg.
        """
        least = least_interval - TOLERANCE_DEG
        return not find_missed(self.parts) and min(list_gaps(self.parts)) >= least

    def is_same(self, other: Candidate) -> bool:
        """Return whether the firing angles of both engines differ by the same shift at all places
        (throw, bank), modulo the cycle if the file has gas, else modulo 360 deg.
        """
        turn = TURN if self.model.gas is None else cycle_deg(self.model.layout)
        mine, theirs = (
            np.array([float(one.parts.fires_deg.get(c.number, 0.0)) for c in one.parts.plan.cells])
            for one in (self, other)
        )
        shifts = theirs - mine
        off = np.remainder(shifts - shifts[0] + turn / 2, turn) - turn / 2
        return bool(np.all(np.abs(off) <= TOLERANCE_DEG))

    @cached_property
    def balance(self) -> tuple[Phasors, Phasors]:
        """Free force (N) and moment (N m) of orders 1 and 2 at the speed of the file, with throws
        0.1 m apart if the file gives no positions.
        """
        model, orders = self.model, np.array([1.0, 2.0])
        if not self._places_known:
            model = model.with_table("crank", spacing=100.0)
        parts = Parts(model)
        c, (x, y, z) = parts.cylinders, parts.places.reference
        needed = find_needed_series(c, {"force", "moment"}, uneven=False)
        few, which = c.find_distinct_harmonics(orders, needed)
        devices = tuple(build_devices(parts))
        square = (model.operation.speed * RPM) ** 2
        place, own = place_in_plane(x, y), select_cylinders(few, which)
        loads = Loads(c, devices, place, z, Phases(c, orders), own, square)
        return loads.force.drop_noise(), loads.moment.drop_noise()

    @property
    def backward_share(self) -> float:
        """Size of the vector of order 1 that turns against the crank, divided by one cylinder's
        force of order 1. The force and the moment (divided by the engine length) have such a
        vector, and the larger counts; if the positions are not known, only that of the force.
        """
        force, moment = (float(abs(p.backward[0])) for p in self.balance)
        parts, c = self.parts, self.parts.cylinders
        mass = max(float(each.reciprocating) for each in parts.weighed.values())
        radius = float(np.max(c.radius))
        one = mass * radius * (self.model.operation.speed * RPM) ** 2
        arm = max(float(np.ptp(c.z)), 2 * radius)
        return max(force, self._places_known * moment / arm) / (one or np.inf)

    @property
    def _places_known(self) -> bool:
        return are_places_known(self.model, self.parts.plan)

    def describe(self) -> str:
        """Return the line for this engine in a list: keys to copy, throws, forces and moments."""
        keys = f"layout.numbering = {write_rows(self.numberings[0])}"
        force, moment = (
            " and ".join(f"{v:.4g}" for v in sizes) for sizes in (p.major for p in self.balance)
        )
        told = f"{moment} N m" if self._places_known else "not known"
        same = " or ".join(map(write_rows, self.numberings[1:]))
        first = next(c for c in self.parts.plan.cells if c.number == 1)
        angles = bank_angles(self.model.layout, self.parts.figures)
        side = float(np.remainder(angles[first.bank] + 180.0, 360.0)) - 180.0
        bank = f"bank {first.bank + 1}"
        if len(angles) == 2 and side:
            bank = f"the {'left' if side < 0 else 'right'} bank seen from the free end"
        return (
            f"{keys}{self.change and ', '}{self.change}: throws "
            f"{_join(count_throws_from_first(self.parts))}; cylinder 1 on {bank}, throw "
            f"{first.throw + 1};"
            f" orders 1 and 2: force {force} N, moment {told}"
            + (f"; the same engine: {same}" if same else "")
        )

    def rank(self, position: int) -> tuple[float, ...]:
        """Return the key for sorting engines: force and moment that counterweights cannot cancel,
        splay, and position in the tier. With one rod on each throw, numbering along the crank comes
        before numbering bank by bank.
        """
        if self.parts.plan.rods_on_throw == 1:
            position = {0: 1, 1: 0}.get(position, position)
        left = (float(abs(p.backward[0]) + p.major[1]) for p in self.balance)
        return *(float(f"{size:.6g}") for size in left), abs(self.model.crank.splay), position


def _change(
    model: EngineFile, path: str, value: float | Sequence[float], numberings: Sequence[Rows] = ()
) -> Candidate:
    """Return the candidate of a file with another value of a key."""
    table, _, key = path.partition(".")
    text = f"{value:g}" if isinstance(value, (int, float)) else f"[{_join(value)}]"
    return Candidate(model.with_table(table, **{key: value}), [*numberings], f"{path} = {text}")


def find_missed(parts: Parts) -> list[Problem]:
    """Return the mistake of the first cylinder that is not at its dead centre when it fires.
    With articulated rods, cylinders may fire at their true dead centres, or at their nominal ones:
    crank pin on the cylinder's axis.
    """
    if parts.order is None:
        return []
    try:
        fires = parts.fires_deg
    except InputError as error:
        return list(error.problems)
    ways = [parts.true_tops_deg, *([parts.pins.tops_deg] if parts.model.articulation else [])]
    missed = [list(check_firing(fires, parts.pins.leads_deg, tops, parts.sense)) for tops in ways]
    return min(missed, key=len)


def find_fitting_splay(model: EngineFile) -> float | None:
    """Return the value of `crank.splay` (deg) with which the cylinders fire in the order and at the
    intervals of the file (evenly if the file gives no intervals). Return None if there is no such
    splay, no firing order, or if rods are articulated.
    """
    parts = Parts(model)
    if parts.order is None or parts.plan.rods_on_throw == 1 or model.articulation is not None:
        return None
    fires = find_instants(parts.order, model.layout.firing_intervals, cycle_deg(model.layout))
    wanted = find_pins(fires, parts.pins.tops_deg, parts.sense)
    first, second = (c.number for c in parts.plan.cells if c.throw == 0 and c.bank < 2)
    if not {first, second} <= fires.keys():
        return None
    lead = np.remainder(wanted[second] - wanted[first] + 180, 360) - 180
    splay = round(float(lead), 3) + 0.0
    split = Parts(model.with_table("crank", splay=splay))
    missed = any(check_firing(fires, split.pins.leads_deg, split.pins.tops_deg, split.sense))
    return None if missed else splay


def list_gaps(parts: Parts) -> list[float]:
    """Return the intervals from each firing to the next, deg, through one cycle."""
    times = [*map(float, parts.fires_deg.values()), cycle_deg(parts.model.layout)]
    return [b - a for a, b in pairwise(times)]


def count_throws_from_first(parts: Parts) -> list[float]:
    """Return the angle of each throw from the first one, deg, in [0, 360)."""
    throws = [float(parts.pins.throws_deg[t]) for t in range(parts.plan.throws)]
    return [round(throw - throws[0], 3) % TURN for throw in throws]


# ------------------------------------------------------------------ the rules
def is_open(parts: Parts) -> bool:
    """Return whether the file leaves the numbering open: it has several banks and a firing order,
    but neither a numbering nor a bank or throw of a single cylinder.
    """
    layout = parts.model.layout
    own = parts.model.cylinder.values()
    free = any(c.bank is not None or c.throw is not None for c in own)
    unsaid = layout.numbering is None and parts.order is not None and not free
    return unsaid and parts.plan.banks > 1


def infer_numbering(model: EngineFile) -> EngineFile:
    """Return the file with an inferred numbering if it gives neither numbering nor throws and the
    rules find a single engine; else the file unchanged.

    The inferred key still counts as not given: it is not in `model_fields_set`, and is not written
    to files.
    """
    parts = Parts(model)
    try:
        if not is_open(parts) or parts.throws_given:
            return model
        engines, tier = find_engines_meant(parts)
    except InputError:  # the rules of `engine.build` report it
        return model
    if tier != 1 or len(engines) != 1:
        return model
    changed = engines[0].model
    changed.layout.model_fields_set.discard("numbering")
    return changed


def check_numbering(parts: Parts) -> Iterator[Problem]:
    """Check that the firing order fits the crank and means a single engine. Varied figures do not
    affect which engine a file without throws means.
    """
    missed = find_missed(parts)
    if is_open(parts):
        parts = Parts(parts.model) if parts.varies and not parts.throws_given else parts
    else:
        named = ", or correct layout.numbering" * (parts.model.layout.numbering is not None)
        yield from (p._replace(message=p.message + named + _suggest(parts)) for p in missed)
        return
    if parts.throws_given and not missed:
        return
    engines, tier = find_engines_meant(parts)
    if tier == 1 and len(engines) == 1 and not parts.throws_given:
        return
    order = "-".join(map(str, parts.order or ()))
    if engines:
        several = f"one of {len(engines)} engines" if len(engines) > 1 else "this engine"
        told = f"is missing, and with the firing order {order} the file may mean {several}"
    elif engines := _find_remedies(parts):
        told = f"is missing, and the firing order {order} fits no usual numbering; it may mean"
    else:
        yield from (
            p._replace(message=f"{p.message}, or give layout.numbering" + _suggest(parts))
            for p in missed
            or [Problem("layout.firing_order", f"{order} fits no usual numbering of the cylinders")]
        )
        return
    lines = [engine.describe() for engine in engines[:LIST_LENGTH]]
    yield Problem("layout.numbering", "\n    ".join([f"{told}:", *lines, FREE_END]))


def find_engines_meant(parts: Parts) -> tuple[list[Candidate], int]:
    """Return the engines of the first tier of usual numberings in which a numbering fits, best
    balanced first, and the number of that tier (from 1). If no numbering fits, return an empty list
    and 0.

    If the file gives throws and no intervals, a numbering does not fit if two firings are closer
    than half the interval of even firing.
    """
    layout = parts.model.layout
    least = 0.0
    if parts.throws_given and layout.firing_intervals is None:
        least = cycle_deg(layout) / len(parts.plan.cells) / 2
    tiers = list_tiers(parts.plan, radial=layout.radial is not None)
    for number, tier in enumerate(tiers, 1):
        fitting = [one for one in _number(parts.model, tier) if one.fits(least)]
        if fitting:
            return _sort(fitting, tier), number
    return [], 0


def _number(model: EngineFile, tier: Iterable[Rows]) -> list[Candidate]:
    """Return a candidate for each different numbering of a tier."""
    numberings = dict.fromkeys(tier)
    return [Candidate(model.with_table("layout", numbering=rows), [rows]) for rows in numberings]


def _split_pins(one: Candidate) -> Iterator[Candidate]:
    """Yield the engine with the splay that makes it fit, if there is one."""
    splay = find_fitting_splay(one.model)
    if splay is not None:
        yield _change(one.model, "crank.splay", splay, one.numberings)


def _find_remedies(parts: Parts) -> list[Candidate]:
    """Return the engines of the first tier that fit with the uneven intervals of shared pins, then
    those that fit with another splay. There are none if the file gives the splay.
    """
    model, plan = parts.model, parts.plan
    two_on_throw = plan.banks == 2 and plan.rods_on_throw == 2
    if "splay" in model.crank.model_fields_set or not two_on_throw:
        return []
    tier = next(list_tiers(plan, radial=model.layout.radial is not None))
    uneven = [] if model.layout.firing_intervals else list(_list_shared_intervals(parts))
    by_intervals = [
        _change(one.model, "layout.firing_intervals", intervals, one.numberings)
        for one in _number(model, tier)
        for intervals in uneven
    ]
    by_splay = [split for one in _number(model, tier) for split in _split_pins(one)]
    common = _sort([one for one in by_intervals if one.fits()], tier)
    split = [one for one in _sort(by_splay, tier) if not any(map(one.is_same, common))]
    return [*common[: LIST_LENGTH - bool(split)], *split]


def _list_shared_intervals(parts: Parts) -> Iterator[tuple[float, ...]]:
    """Yield the possible firing intervals of a vee with two rods on each pin. Two intervals
    alternate, and either may be first: one is the bank angle, or the bank angle plus a turn; both
    together are twice the interval of even firing.
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
    """Return one candidate for each different engine, best balanced first."""
    engines: list[Candidate] = []
    for one in fitting:
        twin = next(filter(one.is_same, engines), None)
        if twin is None:
            engines.append(one)
        elif one.numberings[0] not in twin.numberings and one.change == twin.change:
            twin.numberings += one.numberings
    return sorted(engines, key=lambda one: one.rank(tier.index(one.numberings[0])))


# ------------------------------------------------------------------ a numbering that does not fit
def _suggest(parts: Parts) -> str:
    """Return in words changes of one key with which every cylinder fires at its dead centre; empty
    if none helps. The function tries intervals that begin one firing later, a usual numbering,
    throws with opposite sign, other throws, and another splay.
    """
    if parts.varies:
        return ""
    model, intervals = parts.model, parts.model.layout.firing_intervals
    ways: list[Candidate] = []
    if intervals is not None:
        later = (*intervals[1:], intervals[0])
        ways.append(_change(model, "layout.firing_intervals", later))
    usual = find_engines_meant(parts)[0][:1] if model.layout.numbering else []
    for one in usual:
        one.change = f"layout.numbering = {write_rows(one.numberings[0])}"
    ways += usual
    if model.crank.throws is not None:
        throws = tuple(-throw % TURN for throw in model.crank.throws)
        ways.append(_change(model, "crank.throws", throws))
        ways[-1].change += " (angles count in the direction of rotation)"
        if len(throws) > 1 and len(parts.order or ()) == len(parts.plan.cells):
            needed = count_throws_from_first(Parts(model.with_table("crank", throws=None)))
            ways.append(_change(model, "crank.throws", needed))
    if "splay" not in model.crank.model_fields_set:
        ways += _split_pins(Candidate(model, []))
    fitting = [way for way in ways if not find_missed(way.parts)]
    hints = dict.fromkeys(way.change for way in (*fitting[:1], *usual))
    return f". It fits with {' or with '.join(hints)}" if hints else ""


# ------------------------------------------------------------------ what is allowed and unlikely
USUAL_ORDERS = {
    4: "1-3-4-2 or 1-2-4-3",
    5: "1-2-4-5-3 or 1-3-5-4-2",
    6: "1-5-3-6-2-4 or 1-4-2-6-3-5",
    8: "1-6-2-5-8-3-7-4, or 1-5-2-6-4-8-3-7 with two cranks of fours at 90 deg",
}
USUAL_FLAT_ORDERS = {
    4: "1-4-3-2 bank by bank, 1-3-2-4 with odd numbers in one bank",
    6: "1-6-2-4-3-5 bank by bank, 1-6-3-2-5-4 or 1-4-5-2-3-6 with odd numbers in one bank",
}


def doubt_firing(model: EngineFile) -> Iterator[str]:
    """Yield warnings of unlikely firing: a less usual numbering was inferred, nobody builds the
    crank for this order, or with these throws all cylinders fire within one of two revolutions.
    Without a firing order, warn of a splay with the wrong sign.
    """
    parts = Parts(model)
    if parts.order is None:
        yield from _doubt_splay(model) if model.crank.splay else ()
        return
    layout, plan = model.layout, parts.plan
    if layout.numbering is not None and "numbering" not in layout.model_fields_set:
        rows = layout.numbering
        if rows != next(list_tiers(plan, radial=layout.radial is not None))[0]:
            yield (
                f"layout.numbering is not given; {write_rows(rows)} is used, with which the firing "
                "order fits; add this key if it is right"
            )
    order = "-".join(map(str, parts.order))
    if parts.throws_given:
        gaps = list_gaps(parts)
        if layout.firing_intervals is None and len(gaps) > 2 and max(gaps) > TURN + TOLERANCE_DEG:
            yield (
                f"layout.firing_order: {order} has the intervals {_join(gaps)} deg with these "
                f"crank.throws; if that is right, give layout.firing_intervals = [{_join(gaps)}]"
            )
    elif layout.firing_intervals is None and layout.strokes == 4:
        usual = _find_usual_orders(parts)
        if usual:
            listed = _join(count_throws_from_first(parts))
            yield (
                f"layout.firing_order: {order} needs the throws {listed}, which nobody builds; "
                f"usual is {usual}; if this order is right, give crank.throws"
            )


def _doubt_splay(model: EngineFile) -> Iterator[str]:
    """Yield a warning if split pins leave a backward vector of order 1 that the opposite splay
    would balance.
    """
    splay = model.crank.splay
    opposite = model.with_table("crank", splay=-splay)
    here, there = (Candidate(each, []).backward_share for each in (model, opposite))
    if there < SMALL <= here:
        yield (
            f"crank.splay = {splay:g}: the part of order 1 that turns against the crank is "
            f"{100 * here:.3g} % of one cylinder's first order, and {100 * there:.3g} % with "
            f"crank.splay = {-splay:g}; change the sign, or give layout.firing_order"
        )


def _find_usual_orders(parts: Parts) -> str:
    """Return usual firing orders if nobody builds the crank of this engine, else an empty text.
    Usual cranks of in-line engines are symmetrical end for end, have one of the usual orders of
    five cylinders, or are two cranks of fours at 90 deg. In a flat engine, pins of neighbouring
    cylinders are 180 deg apart.
    """
    throws, plan = count_throws_from_first(parts), parts.plan
    angles = [*map(float, bank_angles(parts.model.layout, parts.figures))]
    if plan.banks == 1:
        order = parts.order or ()
        turned = "-".join(map(str, order[order.index(1) :] + order[: order.index(1)]))
        built = len(throws) % 2 or throws == throws[::-1]
        if len(throws) == 5:
            built = turned in USUAL_ORDERS[5]
        if len(throws) == 8 and not built:  # two cranks of in-line fours in series, at 90 deg
            fours = [[round((t - one[0]) % TURN) for t in one] for one in (throws[:4], throws[4:])]
            across = round(abs(throws[4] - 180)) == 90
            built = across and fours == [[0, 180, 180, 0]] * 2
        return "" if built else USUAL_ORDERS.get(len(throws), "")
    if plan.banks > 2 or plan.rods_on_throw > 1 or not _are_opposite(*angles):
        return ""
    built = all(map(_are_opposite, throws[::2], throws[1::2]))
    return "" if built else USUAL_FLAT_ORDERS.get(len(throws), "")


def _are_opposite(first: float, second: float) -> bool:
    return abs((second - first) % TURN - 180) <= TOLERANCE_DEG


def write_rows(rows: Sequence[Sequence[int]]) -> str:
    """Return a numbering in the form that a file has."""
    return str([list(row) for row in rows])


def _join(numbers: Iterable[float]) -> str:
    return ", ".join(f"{number:.6g}" for number in numbers)
