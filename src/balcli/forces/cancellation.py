"""How a sum of phasors vanishes: which of them are mirror pairs, and which stand evenly spaced. All
of it in fractions, nothing judged by size.

A term of weight w and angle x (turns) is `w e^{2 pi i x}`; one of weight -w stands half a turn
further. Weights of a moment are arms: two cylinders with the same phasor on opposite arms are a
mirror pair. What is left is taken apart into regular polygons, whose corners sum to nothing.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from math import lcm
from typing import NamedTuple

from ..core.roots_of_unity import even, vanishes

ANGLES_SHOWN = 6  # of phasors; where there are more, only how many
PAIRS_SHOWN = 6
WEIGHT_DENOMINATOR = 1_000_000  # to which the ratio of two weights counts as a fraction
_HALF = Fraction(1, 2)
_POLYGONS = {2: "opposite pairs", 3: "triangles", 5: "pentagons", 7: "heptagons"}


class Term(NamedTuple):
    """One phasor: the number of its cylinder, its weight, and its angle in turns."""

    number: int
    weight: Fraction
    angle: Fraction


def tell_cancellation(sets: Iterable[Sequence[Term]]) -> str:
    """How terms sum to nothing, in words.

    Args:
        sets: of terms, each with a sum that is exactly 0.
    """
    pairs: set[tuple[int, int]] = set()
    told: dict[str, None] = {}  # each once, in order
    for terms in sets:
        mirrored, others = _split_mirrored(terms)
        own = _find_pairs(mirrored)
        if own is None:
            told["cylinders that pull alike have arms that sum to nothing"] = None
        else:
            pairs.update(own)
        if others:
            told[_tell_polygons(others)] = None
    first = [_tell_pairs(sorted(pairs))] if pairs else []
    return "; ".join([*first, *told])


def sum_to_nothing(terms: Sequence[Term]) -> bool:
    """Whether the sum of terms is exactly 0."""
    return vanishes([term.weight for term in terms], [term.angle for term in terms])


def are_in_phase(terms: Sequence[Term]) -> bool:
    """Whether several terms all point the same way, so that they add up in full."""
    return len(terms) > 1 and len(_collect(terms)) == 1


# ------------------------------------------------------------------ mirror pairs
def _split_mirrored(terms: Sequence[Term]) -> tuple[list[Term], list[Term]]:
    """Terms whose weights cancel those of equal angle, and all others."""
    at: dict[Fraction, list[Term]] = defaultdict(list)
    for term in terms:
        at[term.angle % 1].append(term)
    sums = {angle: sum(term.weight for term in alike) for angle, alike in at.items()}
    cancelled = [term for term in terms if not sums[term.angle % 1]]
    return cancelled, [term for term in terms if sums[term.angle % 1]]


def _tell_pairs(pairs: Sequence[tuple[int, int]]) -> str:
    shown = ", ".join(f"{one} and {other}" for one, other in pairs[:PAIRS_SHOWN])
    if len(pairs) == 1:
        return f"the mirror pair ({shown}) pulls alike on opposite arms"
    more = ", …" if len(pairs) > PAIRS_SHOWN else ""
    return f"mirror pairs ({shown}{more}) pull alike on opposite arms"


def _find_pairs(terms: Sequence[Term]) -> list[tuple[int, int]] | None:
    """Numbers of cylinders with equal angles and opposite weights; None if some have no other."""
    waiting: dict[tuple[Fraction, Fraction], list[int]] = defaultdict(list)
    pairs = []
    for number, weight, angle in sorted(terms):
        others = waiting[angle % 1, -weight]
        if others:
            pairs.append((others.pop(0), number))
        else:
            waiting[angle % 1, weight].append(number)
    return None if any(waiting.values()) else pairs


# ------------------------------------------------------------------ evenly spaced phasors
def _tell_polygons(terms: Sequence[Term]) -> str:
    """Terms that are left: all at even angles, or in groups of such."""
    sizes = _collect(terms)
    corners = sorted(sizes)
    if len(set(sizes.values())) == 1 and even(corners, Fraction(1)):
        return f"{_tell_corners(corners, len(terms))} sum to nothing"
    polygons = _take_apart(sizes)
    if polygons is None:
        return "phasors are roots of unity that sum to nothing"
    kinds = " and ".join(_POLYGONS.get(p, f"regular {p}-gons") for p in sorted(polygons))
    return f"phasors form {kinds}, which sum to nothing"


def _collect(terms: Iterable[Term]) -> dict[Fraction, Fraction]:
    """Positive weights by angle; a negative one stands half a turn further."""
    total: dict[Fraction, Fraction] = defaultdict(Fraction)
    for _, weight, angle in terms:
        total[(angle + (_HALF if weight < 0 else 0)) % 1] += abs(weight)
    return total


def _tell_corners(corners: Sequence[Fraction], count: int) -> str:
    """`phasors at 0, 120, 240 deg, 2 each,`."""
    m = len(corners)
    if m > ANGLES_SHOWN:
        return f"{m} evenly spaced phasors"
    each = f", {count // m} each," if count > m and count % m == 0 else ""
    angles = ", ".join(f"{float(360 * corner):.6g}" for corner in corners)
    return f"phasors at {angles} deg{each}"


def _take_apart(sizes: Mapping[Fraction, Fraction]) -> set[int] | None:
    """How many corners the regular polygons have that these positive weights are made of, opposite
    pairs taken out first; None if they cannot be taken apart so.
    """
    left = dict(sizes)
    found = set()
    primes = _prime_factors(lcm(*(angle.denominator for angle in left)))
    for p in (p for p in primes if p <= len(left)):
        for angle in sizes:
            corners = [(angle + Fraction(k, p)) % 1 for k in range(p)]
            least = min(left.get(corner, Fraction(0)) for corner in corners)
            if least:
                found.add(p)
                left.update({corner: left[corner] - least for corner in corners})
    return None if any(left.values()) else found


def _prime_factors(n: int) -> list[int]:
    """Ascending, each once."""
    found, p = [], 2
    while n > 1:
        if n % p == 0:
            found.append(p)
            while n % p == 0:
                n //= p
        p += 1
    return found
