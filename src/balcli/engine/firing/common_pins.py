"""List the firing intervals of a vee whose two rods of a throw share a common crank pin.

The two cylinders of a common pin fire one bank angle apart, or one bank angle and a turn. So the
engine fires evenly only if this is an even interval. Otherwise the file needs its firing intervals.
Cranks whose pins are evenly spaced are likely: each pin at an angle of its own, or in a four-stroke
also two pins at each angle. Only those count whose dead centres come in the firing order within one
cycle.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...core.phases import TURN
from ..layout import TOLERANCE_DEG, bank_angles, cycle_deg
from ..parts import Parts

Intervals = tuple[float, ...]

# A four-stroke with more pins has too many cranks to try; only alternating intervals are listed.
MOST_PINS = 8


def find_angle_between_banks(parts: Parts) -> float:
    """Return the angle between the two banks of a vee, deg, in [0, 180]."""
    first, second = map(float, bank_angles(parts.model.layout, parts.figures))
    return abs((second - first + 180) % TURN - 180)


def list_common_pin_intervals(parts: Parts) -> list[Intervals]:
    """Return the possible firing intervals of a vee with two rods on each pin, deg, without
    duplicates: two alternating ones, then those of evenly spaced cranks.

    Args:
        parts: Stages of an engine whose cylinders have their numbers.
    """
    two_stroke = parts.model.layout.strokes == 2
    intervals = list(_list_alternating(parts))
    if two_stroke or parts.plan.throws <= MOST_PINS:
        intervals += list_evenly_spaced(parts)
    return list(dict.fromkeys(intervals))


def _list_alternating(parts: Parts) -> Iterator[Intervals]:
    """Yield two alternating intervals, begun with either: one is the angle between the banks, or
    this angle plus a turn; both together are twice the interval of even firing.
    """
    both = 2 * cycle_deg(parts.model.layout) / len(parts.plan.cells)
    angle = find_angle_between_banks(parts)
    pairs = len(parts.plan.cells) // 2
    for vee in (angle, angle + TURN):
        if 0 < vee < both:
            yield _round([vee, both - vee] * pairs)
            yield _round([both - vee, vee] * pairs)


def list_evenly_spaced(parts: Parts) -> Iterator[Intervals]:
    """Yield the intervals of all evenly spaced cranks that the firing order allows."""
    pins = parts.plan.throws
    yield from _CrankSearch(parts, [TURN / pins * k for k in range(pins)], 1).run()
    if parts.model.layout.strokes == 4 and pins % 2 == 0:
        yield from _CrankSearch(parts, [2 * TURN / pins * k for k in range(pins // 2)], 2).run()


class _CrankSearch:
    """Search for the cranks whose dead centres come in the firing order. It follows the order: a
    throw gets one of the free angles when its first cylinder fires.

    Args:
        parts: Stages of an engine whose cylinders have their numbers.
        angles: Possible angles of pins, deg.
        pins_at_angle: Number of pins at each angle.
    """

    def __init__(self, parts: Parts, angles: list[float], pins_at_angle: int) -> None:
        cells = {cell.number: cell for cell in parts.plan.cells}
        splay = parts.model.crank.splay
        self._order = [cells[number] for number in parts.order or ()]
        # Crank angle of the dead centre of each cylinder, deg, if its throw is at 0.
        self._at_zero = {
            cell: parts.sense * float(parts.pins.tops_deg[cell.number] - cell.bank * splay)
            for cell in self._order
        }
        self._free = dict.fromkeys(angles, pins_at_angle)
        self._throws: dict[int, float] = {}
        self._cycle = cycle_deg(parts.model.layout)
        self._least = self._cycle / len(self._order) / 2 - 1e-6
        self._intervals: list[float] = []

    def run(self) -> Iterator[Intervals]:
        """Yield the intervals of each crank; the throw of the first firing is at angle 0."""
        first = self._order[0]
        self._throws[first.throw] = 0.0
        self._free[0.0] -= 1
        yield from self._fire(1, self._at_zero[first])

    def _fire(self, firing: int, last: float) -> Iterator[Intervals]:
        """Yield the intervals of all cranks with the throws set so far.

        Args:
            firing: Index of the next firing in the order.
            last: Crank angle of the last firing, deg.
        """
        if firing == len(self._order):
            if self._add(self._at_zero[self._order[0]], last, firings_left=0):
                yield _round(self._intervals)
                self._intervals.pop()
            return
        cell = self._order[firing]
        firings_left = len(self._order) - firing
        for throw in self._list_angles(cell.throw):
            dead_centre = self._at_zero[cell] - throw
            if not self._add(dead_centre, last, firings_left):
                continue
            is_new = cell.throw not in self._throws
            if is_new:
                self._throws[cell.throw] = throw
                self._free[throw] -= 1
            yield from self._fire(firing + 1, dead_centre)
            self._intervals.pop()
            if is_new:
                del self._throws[cell.throw]
                self._free[throw] += 1

    def _list_angles(self, throw: int) -> list[float]:
        """Return the angle of a throw if it is set, else all free angles."""
        if throw in self._throws:
            return [self._throws[throw]]
        return [angle for angle, count in self._free.items() if count]

    def _add(self, dead_centre: float, last: float, firings_left: int) -> bool:
        """Add the interval up to a dead centre, if the order can be completed within the cycle.
        Return whether it was added.
        """
        interval = (dead_centre - last) % TURN
        if interval < TOLERANCE_DEG:
            interval += TURN
        left = self._cycle - sum(self._intervals) - interval
        fits = left >= firings_left * self._least - 1e-6
        if firings_left == 0:
            fits = abs(left) < TOLERANCE_DEG
        if interval >= self._least and fits:
            self._intervals.append(interval)
            return True
        return False


def _round(intervals: list[float]) -> Intervals:
    return tuple(round(interval, 6) for interval in intervals)
