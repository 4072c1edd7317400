"""Find the largest values of periodic curves, on the curves themselves and not on a grid of
samples.

A curve is `x(t) = Re sum over orders of c_n e^{i n t}`, where t is the crank angle in rad; a vector
has one such curve for each of its components. Orders are multiples of 1/2, so that a cycle is 4 pi.
Axes of arrays: orders, then any number of axes for several curves, then components of vectors.

Let a trigonometric polynomial of degree h have values from M - R to M + R. At a distance d from its
maximum it is then at least `M + R cos(h d)` (M. Riesz; h d at most pi). With 16 samples per period
of the highest order, the samples next to the highest peak are therefore among the highest samples.
Newton's method starts from these samples and climbs to the maxima of the curve.

For other functions of one variable, the search assumes that computing a function at many places at
once costs little more than at a few.
"""

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from heapq import nsmallest
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .phasors import Array, Phasors
from .vibration import Complex, Indices, Real

_SMALLEST = 1e10 * float(np.finfo(float).tiny)  # a division by a smaller number overflows
_TURN = 2 * np.pi  # rad
_SAMPLES = 16  # number of samples per period of the highest order
_AT_ONCE = 1 << 16  # largest number of samples, or of terms of curves: more leave the cache
_ROUNDS = 40  # largest number of steps of Newton's method; 3 or 4 suffice for a round peak
# A step of Newton's method is the last if it gains less than _SETTLED of the sum of all amplitudes,
# or if it is shorter than _SHORT of the distance of two samples.
_SETTLED = 1e-16
_SHORT = 1e-6
# Terms of the Taylor series about a sample. Up to the next sample, 2 pi/16 = 0.39 of the phase of
# the highest order away, the next term is below 0.39^13/13! = 1e-15 of the sum of all amplitudes.
_TERMS = 13
_ZERO = 1e-12  # rad; an angle this close to a whole turn is 0
_SAMPLED = math.cos(math.pi / _SAMPLES)  # least share of peak to peak that samples have
# Part of the swing below the highest sample in which the samples next to the highest peak lie.
_NEAR = 1 - _SAMPLED**2
_EQUAL = 1e-12  # peaks that differ by a smaller share of the sum of all amplitudes are equal


class Peak(NamedTuple):
    """Largest absolute value of a curve over a revolution, or over two revolutions if the curve has
    half orders.

    Attributes:
        value: Largest absolute value, in the unit of the curve.
        theta: First crank angle at which it is reached, rad.
        every: Angle after which the absolute value repeats, rad; 0: it is constant.
    """

    value: float
    theta: float
    every: float = _TURN


class CyclePeak(NamedTuple):
    """Largest values of curves over a cycle, and the first crank angles (rad, in [0, 4 pi)) at
    which they are reached, each of shape (*curves).
    """

    value: Real
    angle: Real


class Swing(NamedTuple):
    """Highest and lowest values of curves over a cycle."""

    highest: CyclePeak
    lowest: CyclePeak

    @property
    def half(self) -> Real:
        """Half the peak-to-peak value, shape (*curves)."""
        return (self.highest.value - self.lowest.value) / 2


# ------------------------------------------------------------------ curves by their phasors
def find_peak(curve: Phasors) -> Peak:
    """Return the largest size |F| of the vector F that the phasors describe, over a revolution. The
    phasors must have no trailing axes.
    """
    (peak,) = find_peaks(Phasors(curve.orders, curve.vectors[..., None], curve.noise))
    return peak


def find_peaks(curves: Phasors) -> tuple[Peak, ...]:
    """Return the largest |F| over a revolution at each place along the trailing axis."""
    values, angles = find_longest(curves.orders, _list_components(curves))
    orders = np.rint(2 * np.concatenate([curves.orders, -curves.orders])).astype(int)
    present = np.concatenate([curves.forward, curves.backward]) != 0
    return tuple(
        Peak(value, angle, _find_repeat(orders[present[:, place]])) if value else Peak(0.0, 0.0)
        for place, (value, angle) in enumerate(zip(values.tolist(), angles.tolist(), strict=True))
    )


def _find_repeat(halves: NDArray[np.int64]) -> float:
    """Return the angle after which |F| repeats, rad; 0 if it is constant. F is a sum of vectors
    that turn `halves` times in two revolutions (below 0: backward); |F| depends only on the
    differences of their angles.
    """
    times = int(np.gcd.reduce(halves - halves[0]))
    return 2 * _TURN / times if times else 0.0


def find_largest(curves: Phasors) -> Array:
    """Return the largest |F| over a cycle, shape (*trailing)."""
    return np.asarray(find_longest(curves.orders, _list_components(curves)).value, float)


def find_near_peaks(curve: Phasors) -> Real:
    """Return the angles (rad, ascending) of all maxima of |F| over a revolution that are within
    about 2 % of the highest. A maximum may be listed twice. The phasors must have whole orders and
    no trailing axes.
    """
    parts = np.ascontiguousarray(_list_components(curve).T[None])
    scaled = parts / np.abs(parts).sum()
    harmonics = curve.orders.astype(np.int64)
    waves = _sample(harmonics, scaled)
    return np.sort(_find_tops(harmonics, scaled, waves, squared=True)[2])


def _list_components(curves: Phasors) -> Complex:
    """Return the coefficients c of the components `Re(c e^{i n theta})` along x and y, shape
    (orders, *trailing, 2).
    """
    ahead = curves.forward
    astern = np.conj(curves.backward)
    return np.stack([ahead + astern, -1j * (ahead - astern)], axis=-1)


# ------------------------------------------------------------------ curves by their harmonics
def find_swing(orders: ArrayLike, phasors: Complex, least: Real | None = None) -> Swing:
    """Return the highest and lowest values of curves over the cycle.

    Args:
        orders: Multiples of 1/2, shape (orders,).
        phasors: Phasors of the curves, shape (orders, *curves).
        least: Half of the peak-to-peak value from which a curve matters, shape (*curves). A curve
            that is clearly below it takes less time: only the result's `half` has a meaning then,
            which is an upper bound of half of its peak-to-peak value, and is below `least`, too.
            None: all curves matter.

    Raises:
        ValueError: An order is no multiple of 1/2, is negative or comes twice.
    """
    values, angles = _search(orders, phasors[..., None], squared=False, least=least)
    return Swing(CyclePeak(values[0], angles[0]), CyclePeak(-values[1], angles[1]))


def find_longest(orders: ArrayLike, phasors: Complex) -> CyclePeak:
    """Return the largest lengths of vectors over the cycle.

    Args:
        orders: Multiples of 1/2, shape (orders,).
        phasors: Phasors of the components, shape (orders, *curves, components).

    Raises:
        ValueError: An order is no multiple of 1/2, is negative or comes twice.
    """
    (value,), (angle,) = _search(orders, phasors, squared=True)
    return CyclePeak(value, angle)


def sum_amplitudes(phasors: Complex) -> Real:
    """Return the sum of the amplitudes of all orders, shape (*curves), which would be the largest
    value if all orders peaked at once. It is commonly 1.2 to 2.5 times the largest value that
    occurs.
    """
    return np.sum(np.abs(phasors), axis=0)


def largest_of_ellipse(phasors: Complex) -> Real:
    """Return the longer semi-axis (*curves) of the ellipse `Re(c e^{i t})` of phasors (*curves,
    components): `sqrt((|c|^2 + |c . c|)/2)`.
    """
    power = np.sum(np.abs(phasors) ** 2, axis=-1)
    return np.sqrt((power + np.abs(np.sum(phasors**2, axis=-1))) / 2)


def _search(
    orders: ArrayLike, phasors: Complex, *, squared: bool, least: Real | None = None
) -> CyclePeak:
    """Return the largest lengths (`squared`) or the highest values of the curves and of their
    negatives, and the first angles of these, each of shape (1 or 2, *curves). See `find_swing` for
    `least`.
    """
    halves = 2 * np.asarray(orders, float)
    present = (phasors != 0).any(axis=tuple(range(1, phasors.ndim)))
    present |= not present.any()
    harmonics = np.rint(halves).astype(np.int64)
    wrong = (harmonics != halves) | (harmonics < 0)
    if wrong.any() or len(set(halves.tolist())) < len(halves):
        raise ValueError("orders have to be different multiples of 1/2, none below 0")
    common = max(int(np.gcd.reduce(harmonics[present])), 1)  # shortens the cycle as far as possible
    harmonics = harmonics[present] // common
    shape = phasors.shape[1:-1]
    components = phasors.shape[-1]
    parts = phasors[present].reshape(len(harmonics), -1, components)
    parts = np.ascontiguousarray(parts.transpose(1, 2, 0), complex)
    step = max(_AT_ONCE // (_SAMPLES * int(harmonics.max(initial=1)) * components), 1)
    signs = 1 if squared else 2
    tops = [np.zeros((2, signs, 0))]
    for start in range(0, len(parts), step):
        some = parts[start : start + step]
        size = np.abs(some).sum(axis=(1, 2))
        scaled = np.asarray(some / np.where(size > _SMALLEST, size, 1)[:, None, None], complex)
        waves = _sample(harmonics, scaled)
        going = np.arange(len(some))
        values, angles = np.zeros((2, signs, len(some)))
        if least is not None:
            values[:] = np.ptp(waves[:, 0], axis=1) / 2 / _SAMPLED
            going = np.flatnonzero(values[0] * size >= least.ravel()[start : start + step])
        if len(going):
            highest = _find_first_tops(harmonics, scaled[going], waves[going], squared)
            values[:, going] = highest.value
            angles[:, going] = highest.angle
        tops.append(np.stack([values * size, angles * 2 / common]))
    value, angle = np.concatenate(tops, axis=2).reshape(2, signs, *shape)
    return CyclePeak(value, angle)


def _find_first_tops(
    harmonics: NDArray[np.int64], parts: Complex, waves: Real, squared: bool
) -> CyclePeak:
    """Return the highest values as `_search` does, shape (1 or 2, curves), of scaled curves; see
    `_find_tops` for the arguments.
    """
    curve, values, angles, at_zero = _find_tops(harmonics, parts, waves, squared)
    starts = np.searchsorted(curve, np.arange(len(at_zero)))
    top = np.maximum.reduceat(values, starts)
    among = values >= (top - _EQUAL)[curve]
    first = np.minimum.reduceat(np.where(among, angles, _TURN), starts)
    first[at_zero >= top - _EQUAL] = 0.0
    value = np.sqrt(top) if squared else top
    return CyclePeak(value.reshape(-1, len(parts)), first.reshape(-1, len(parts)))


def _sample(harmonics: NDArray[np.int64], parts: Complex) -> Real:
    """Return samples of the components of curves over a turn, shape (curves, components, samples);
    see `_find_tops` for the arguments.
    """
    highest = int(harmonics.max(initial=1))
    spectrum = np.zeros((*parts.shape[:-1], highest + 1), complex)
    spectrum[..., harmonics] = np.where(harmonics, parts / 2, parts.real)
    return np.fft.irfft(spectrum, _SAMPLES * max(highest, 1), axis=-1, norm="forward")


def _find_tops(
    harmonics: NDArray[np.int64], parts: Complex, waves: Real, squared: bool
) -> tuple[Indices, Real, Real, Real]:
    """Return the maxima that may be the highest of their curves, and the value of each curve at 0.
    Maxima are given by the indices of their curves (ascending), values, and angles in [0, 2 pi),
    each of shape (tops,); values at 0 have shape (curves,). Unless the curves are `squared`, their
    negatives, whose maxima are the minima of the curves, follow them as further curves.

    Args:
        harmonics: Whole numbers, shape (orders,).
        parts: Phasors of the components, scaled so that the sum of their sizes is 1 for each curve,
            shape (curves, components, orders).
        waves: Samples of the components, shape (curves, components, samples).
        squared: Whether the squared length is wanted, not the value of a single component.
    """
    samples = (waves**2).sum(axis=1) if squared else waves[:, 0]
    curves, count = samples.shape
    high = samples.max(axis=1)
    low = np.zeros(curves) if squared else samples.min(axis=1)
    margin = _NEAR * (high - low)
    near = [samples >= (high - margin)[:, None]]
    highest_at = [samples.argmax(axis=1)]
    at_zero = [samples[:, 0]]
    if not squared:
        near.append(samples <= (low + margin)[:, None])
        highest_at.append(samples.argmin(axis=1))
        at_zero.append(-samples[:, 0])
    row, at = np.divmod(np.flatnonzero(np.concatenate(near)), count)
    curve = row % curves
    sign = np.where(row < curves, 1.0, -1.0)
    before, here, after = (sign * samples[curve, (at + k) % count] for k in (-1, 0, 1))
    peaked = ((here > before) & (here >= after)) | (at == np.concatenate(highest_at)[row])
    row, curve, at, sign = (each[peaked] for each in (row, curve, at, sign))
    vertex = _find_vertex(before[peaked], here[peaked], after[peaked])
    most = max(_AT_ONCE // parts[0].size, 1)  # maxima that are refined at once
    climbed = []
    for start in range(0, len(curve), most):
        some = slice(start, start + most)
        own = parts[curve[some]] * sign[some, None, None]
        climbed.append(_climb(harmonics, own, squared, at[some], vertex[some], count))
    value, angle = np.concatenate(climbed, axis=1)
    angle = angle % _TURN
    angle[angle > _TURN - _ZERO] = 0.0
    return row, value, angle, np.concatenate(at_zero)


def _find_vertex(before: Real, here: Real, after: Real) -> Real:
    """Return the place of the vertex of the parabola through three values, relative to the middle
    one, in steps; 0 if there is no maximum.
    """
    bend = before - 2 * here + after
    return (before - after) / (2 * np.where(bend < 0, bend, -np.inf))


def _climb(
    harmonics: NDArray[np.int64],
    parts: Complex,
    squared: bool,
    at: Indices,
    vertex: Real,
    count: int,
) -> tuple[Real, Real]:
    """Return values and angles of the maxima next to samples, by Newton's method on the Taylor
    series of the curves about these samples.

    Args:
        harmonics: As in `_find_tops`.
        parts: As in `_find_tops`, with a row for each maximum.
        squared: As in `_find_tops`.
        at: Index of the sample next to each maximum, no lower than its neighbours.
        vertex: About where the maximum is from this sample, as a share of a step.
        count: Number of samples in a turn.
    """
    highest = max(int(harmonics.max(initial=1)), 1)
    turned = parts * _find_roots(count)[at[:, None] * harmonics % count][:, None]
    pairs = turned.view(float).reshape(-1, 2 * len(harmonics))
    shares = tuple((harmonics / highest).tolist())
    derivatives = (pairs @ _differentiate(shares)).reshape(*parts.shape[:2], -1)
    step = highest * _TURN / count
    value = np.empty(len(at))
    away = vertex * step  # from the sample, as phase of the highest harmonic
    moving = np.arange(len(at))
    powers = np.empty((len(at), _TERMS, 1))
    for _ in range(_ROUNDS):
        series = derivatives[moving]
        here = powers[: len(moving)]  # away^k / k!
        here[:, 0] = 1
        here[:, 1:, 0] = away[moving, None] / np.arange(1, _TERMS)
        np.multiply.accumulate(here, axis=1, out=here)
        x, slope, bend = ((series[..., k : k + _TERMS] @ here)[..., 0] for k in range(3))
        if squared:
            bend = 2 * (slope * slope + x * bend)
            slope = 2 * x * slope
            x = x * x
        x = x.sum(axis=1)
        slope = slope.sum(axis=1)
        bend = bend.sum(axis=1)
        rounded = bend < 0
        uphill = np.where(rounded, -slope / np.where(rounded, bend, -1), np.sign(slope) * step)
        move = np.minimum(np.maximum(away[moving] + uphill, -step), step) - away[moving]
        gain = slope * move / 2  # exact for a parabola
        value[moving] = x + gain
        away[moving] += move
        moving = moving[(np.abs(move) > _SHORT * step) & (2 * np.abs(gain) > _SETTLED)]
        if not len(moving):
            break
    return value, at * (_TURN / count) + away / highest


@lru_cache(maxsize=64)
def _find_roots(count: int) -> Complex:
    """Return the roots of 1, shape (count,)."""
    return np.exp(1j * (_TURN / count) * np.arange(count))


@lru_cache(maxsize=64)
def _differentiate(shares: tuple[float, ...]) -> Real:
    """Return the matrix that makes the derivatives of curves, `d^k/du^k Re sum of c e^{i s u}` at
    u = 0, of their phasors c, written as pairs of real and imaginary parts.

    Args:
        shares: s of each order.

    Returns:
        Shape (2 orders, derivatives).
    """
    powers = np.vander(np.array(shares), _TERMS + 2, increasing=True)
    turns = 1j ** np.arange(_TERMS + 2)  # Re(i^k c) = Re i^k Re c - Im i^k Im c
    pairs = np.stack([powers * turns.real, -powers * turns.imag], axis=1)
    return pairs.reshape(-1, _TERMS + 2)


# ------------------------------------------------------------------ functions of one variable
_PARTS = 8  # parts into which an interval is cut; the two next to a peak are the next interval
_CUTS = 3  # number of times that an interval is cut
_BESIDE = 1 / 4  # distance of the last three places, as a share of the last step


def find_highest(
    judge: Callable[[Real, Indices], Real], places: Real, heights: Real, level: Real, near: float
) -> tuple[Real, Real]:
    """Return place and height of the maximum of each function, shape (functions,). A maximum may
    lie between the given places.

    An interval between neighbouring places is searched under two conditions. The higher of the
    values at its ends must be at least `near * level`. A peak in it may reach the level: either the
    sum of this value and of the largest change of the function, over this interval or one of its
    two neighbours, does, or the point where the chords of the two neighbours meet.

    Args:
        judge: The functions, as in `find_peaks_between`.
        places: Rising places, shape (places,), or of each function, shape (places, functions).
        heights: Values of the functions at these places, shape (places, functions).
        level: Lowest height that matters, shape (functions,).
        near: Share of the level that a value at an end of a searched interval must reach.
    """
    functions = np.arange(heights.shape[1])
    places = np.broadcast_to(places.reshape(len(heights), -1), heights.shape)
    best = places[heights.argmax(axis=0), functions]
    highest = heights.max(axis=0)
    higher = np.maximum(heights[1:], heights[:-1])
    rise = np.abs(np.diff(np.pad(heights, ((1, 1), (0, 0)), mode="edge"), axis=0))
    beside = np.maximum(np.maximum(rise[:-2], rise[1:-1]), rise[2:])
    reach = np.maximum(higher + beside, _extend_chords(places, heights))
    may = (higher >= near * level) & (reach >= level) & (level > 0)
    at, which = np.nonzero(may)
    if len(at):
        between = np.stack([places[at, which], places[at + 1, which]])
        ends = np.stack([heights[at, which], heights[at + 1, which]])
        place, height = find_peaks_between(judge, between, ends, which)
        _raise(best, highest, which, place, height)
    return best, highest


def _extend_chords(places: Real, heights: Real) -> Real:
    """Return the height at which the chords of the two neighbours of each interval meet, shape
    (intervals, functions); -inf where they do not meet within the interval. A concave function
    stays below it. The first and the last interval have one neighbour, and a horizontal line in
    place of the other's chord, so that their height is no larger than the values at their ends.
    """
    width = np.diff(places, axis=0)
    slope = np.diff(heights, axis=0) / np.where(width > 0, width, np.inf)
    none = np.zeros_like(slope[:1])
    before = np.concatenate([none, slope[:-1]])
    after = np.concatenate([slope[1:], none])
    turn = before - after
    # distance from the start of the interval at which the chords meet
    away = (heights[1:] - heights[:-1] - after * width) / np.where(turn > 0, turn, 1)
    inside = (turn > 0) & (away > 0) & (away < width)
    return np.where(inside, heights[:-1] + before * away, -np.inf)


def find_peaks_between(
    judge: Callable[[Real, Indices], Real], between: Real, ends: Real, which: Indices
) -> tuple[Real, Real]:
    """Return place and height of a peak of a function in each of several intervals, shape
    (intervals,). The highest peak of each function is accurate to 1e-8 if the function is smooth
    and the interval no wider than the peak. The search ends early in all other intervals.

    Each interval is cut into eighths. Every peak among these places that may be the highest is
    enclosed in a smaller interval, which is cut again. The peak is near the vertex of a parabola
    through the last three points; it is the vertex of a parabola through three points close to this
    one. A peak that is narrower than an eighth may be missed.

    Args:
        judge: Function that computes several functions, one for each column of its arguments:
            places, shape (places, columns), and indices of the functions, shape (columns,).
        between: Lower and upper ends of the intervals, shape (2, intervals).
        ends: Values of the functions at these ends, shape (2, intervals).
        which: Index of the function of each interval, shape (intervals,).
    """
    shares = np.arange(1, _PARTS)[:, None] / _PARTS
    low, high = between
    best = np.where(ends[1] > ends[0], high, low)
    highest = ends.max(axis=0)
    going = np.arange(len(low))
    for _ in range(_CUTS):
        step = (high - low) / _PARTS
        inner = judge(low + (high - low) * shares, which[going])
        heights = np.concatenate([ends[:1], inner, ends[1:]])
        beyond = np.full((1, len(low)), -np.inf)
        rises = np.diff(np.concatenate([beyond, heights, beyond]), axis=0) >= 0
        top, at = np.nonzero(rises[:-1] & ~rises[1:])
        going = going[at]
        step = step[at]
        place = low[at] + step * top
        here = heights[top, at]
        middle = np.clip(top, 1, _PARTS - 1)
        around = np.stack([heights[middle + k, at] for k in (-1, 0, 1)])
        _raise(best, highest, going, place, here)
        of_function = np.full(which.max(initial=0) + 1, -np.inf)
        np.maximum.at(of_function, which, highest)
        # The peak may lie above the value at its place by as much as the next values lie below it.
        may = 2 * here - around.min(axis=0) >= of_function[which[going]]
        going, at, place, step, top = (each[may] for each in (going, at, place, step, top))
        around = around[:, may]
        left = np.maximum(top - 1, 0)
        right = np.minimum(top + 1, _PARTS)
        ends = np.stack([heights[left, at], heights[right, at]])
        low = place - step * (top - left)
        high = place + step * (right - top)
    middle = np.clip(top, 1, _PARTS - 1)
    beside = step * _BESIDE
    about = place + step * (middle - top + _find_vertex(*around))
    about = np.clip(about, low + beside, high - beside)
    # Of these places none is taken: rounding alone would decide between it and the vertex.
    heights = judge(about + beside * np.array([[-1], [0], [1]]), which[going])
    vertex = np.clip(about + beside * _find_vertex(*heights), low, high)
    _raise(best, highest, going, vertex, judge(vertex[None], which[going])[0])
    return best, highest


def _raise(best: Real, highest: Real, going: Indices, place: Real, height: Real) -> None:
    """Replace `best` and `highest`, shape (intervals,), by a new place and height of an interval if
    this height is larger. `going` has the interval of each new height; it may list one repeatedly.
    """
    rising = np.argsort(height, kind="stable")  # the highest is written last
    higher = rising[height[rising] > highest[going[rising]]]
    improved = going[higher]
    best[improved] = place[higher]
    highest[improved] = height[higher]


Judged = TypeVar("Judged", float, tuple[float, float])
ROUNDS = 20  # steps of golden section, which narrow an interval to 1e-4 of its width
_GOLDEN = (math.sqrt(5) - 1) / 2


def find_least(
    judge: Callable[[float], Judged], low: float, high: float, rounds: int = ROUNDS
) -> float:
    """Return the place of the minimum of a function with one valley between two places, by golden
    section.

    Args:
        judge: The function; tuples are compared by their first value, then by the next.
        low: Lower end of the interval.
        high: Upper end of the interval.
        rounds: Number of steps, each of which narrows the interval to 0.618 of its width.
    """
    left = high - _GOLDEN * (high - low)
    right = low + _GOLDEN * (high - low)
    at_left = judge(left)
    at_right = judge(right)
    for _ in range(rounds):
        if at_left <= at_right:
            high = right
            right = left
            at_right = at_left
            left = high - _GOLDEN * (high - low)
            at_left = judge(left)
        else:
            low = left
            left = right
            at_left = at_right
            right = low + _GOLDEN * (high - low)
            at_right = judge(right)
    return left if at_left <= at_right else right


def find_least_smooth(
    judge: Callable[[float], float], low: float, high: float, rounds: int = ROUNDS
) -> float:
    """Return the place of the minimum as `find_least` does, by Brent's method: a function that is
    smooth near its minimum is called a third as often.

    The next place is the bottom of the parabola through the three lowest points so far. If it is
    not between the neighbours of the lowest point, or if the steps do not become half as long in
    two rounds, the next place is that of golden section.

    Args:
        judge: The function; its values may be infinite.
        low: Lower end of the interval.
        high: Upper end of the interval.
        rounds: Number of steps of golden section that would be as accurate.

    Source: R. P. Brent, Algorithms for Minimization without Derivatives, 1973, chapter 5.
    """
    shortest = (high - low) * _GOLDEN**rounds / 2
    place = low + (1 - _GOLDEN) * (high - low)
    tried = [(judge(place), place)]
    steps = [high - low, high - low]
    for _ in range(2 * rounds):
        _, best = min(tried)
        below = max((place for _, place in tried if place < best), default=low)
        above = min((place for _, place in tried if place > best), default=high)
        wider = above if above - best > best - below else below
        if abs(wider - best) <= 2 * shortest:
            break
        step = _find_bottom(nsmallest(3, tried)) - best
        halved = abs(step) < abs(steps[-2]) / 2
        if not (halved and below < best + step < above):
            step = (1 - _GOLDEN) * (wider - best)
        if abs(step) < shortest:
            step = math.copysign(shortest, wider - best)
        steps.append(step)
        tried.append((judge(best + step), best + step))
    return min(tried)[1]


def _find_bottom(points: Sequence[tuple[float, float]]) -> float:
    """Return the place of the extreme of the parabola through three points (value, place); inf if
    there is none.
    """
    if len(points) < 3:
        return math.inf
    (lowest, x), (second, y), (third, z) = points
    to_second = (x - z) * (second - lowest)
    to_third = (x - y) * (third - lowest)
    turn = 2 * (to_third - to_second)
    if turn == 0 or not math.isfinite(turn):
        return math.inf
    return x + ((x - z) * to_second - (x - y) * to_third) / turn
