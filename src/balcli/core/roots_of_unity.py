"""Sums of roots of unity decided exactly, by integer arithmetic: does `sum w e^{2 pi i x}` vanish
for rational w and x?

With N the common denominator of the x, the sum is a polynomial in zeta_N, and vanishes if and only
if the N-th cyclotomic polynomial divides it. Instead of dividing, the fields are descended prime by
prime (as Lenstra, Vanishing sums of roots of unity, 1979), which is as quick for N in the millions:
with a prime p of N and m = N/p,
- p divides m: 1, zeta_N, .. zeta_N^(p-1) are independent over the field of m, so every class of
exponents mod p must vanish;
- it does not: zeta_N^k = zeta_p^s zeta_m^t, and all p classes by s must have one and the same sum.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import lru_cache

from .phases import TURN

LARGEST_DENOMINATOR = 5040  # of a fraction of a turn: 7!, so that all common divisions are in it
_ULPS = 2  # by which an angle may differ from its fraction
_KEPT = 1 << 12  # fractions: the angles and masses of an engine are few, and asked for every order


@lru_cache(_KEPT)
def turns(degrees: float, largest: float = TURN) -> Fraction | None:
    """The fraction of a turn that an angle is, modulo a turn; None if no denominator to 5040 gives
    it to within 2 ulp of `largest`, the size of the angles that it comes from (360 at least).
    """
    tolerance = _ULPS * math.ulp(max(largest, float(TURN)))
    found = rational(math.fmod(degrees, TURN) / TURN, LARGEST_DENOMINATOR, tolerance / TURN)
    return None if found is None else found % 1


@lru_cache(_KEPT)
def rational(value: float, largest: int, tolerance: float) -> Fraction | None:
    """The fraction with the smallest such error and a denominator up to `largest`, if it is within
    the tolerance.
    """
    exact = Fraction(value)
    found = exact.limit_denominator(largest)
    return found if abs(found - exact) <= tolerance else None


def vanishes(weights: Iterable[Fraction | int], angles: Iterable[Fraction]) -> bool:
    """Whether `sum w e^{2 pi i x}` is exactly 0, for weights w and angles x in turns."""
    terms = list(zip(weights, angles, strict=True))
    n = math.lcm(*(x.denominator for _, x in terms))
    return _zero(_collected(((int(x * n) % n, Fraction(w)) for w, x in terms)), n)


def even(instants: Sequence[Fraction], cycle: Fraction) -> bool:
    """Whether instants divide a cycle into equal intervals."""
    return sorted((t - instants[0]) % cycle for t in instants) == [
        cycle * k / len(instants) for k in range(len(instants))
    ]


Sum = dict[int, Fraction]  # weight by exponent of zeta_N


def _zero(total: Sum, n: int) -> bool:
    if len(total) < 2:
        return not total
    p = _prime(n)
    m = n // p
    classes: dict[int, Sum] = defaultdict(dict)
    if m % p == 0:
        for k, w in total.items():
            classes[k % p][k // p] = w
        return all(_zero(part, m) for part in classes.values())
    to_s, to_t = pow(m, -1, p), pow(p, -1, m)  # k = s m + t p (mod N)
    for k, w in total.items():
        classes[k * to_s % p][k * to_t % m] = w
    if len(classes) < p:  # an empty class has the sum 0
        return all(_zero(part, m) for part in classes.values())
    first = classes[0]
    return all(
        _zero(_collected([*part.items(), *((t, -w) for t, w in first.items())]), m)
        for part in classes.values()
    )


def _collected(terms: Iterable[tuple[int, Fraction]]) -> Sum:
    """Weights of equal exponents added up, those that cancel left out."""
    total: Sum = defaultdict(Fraction)
    for k, w in terms:
        total[k] += w
    return {k: w for k, w in total.items() if w}


def _prime(n: int) -> int:
    """Smallest prime factor of n > 1."""
    return next((p for p in range(2, math.isqrt(n) + 1) if n % p == 0), n)
