"""The well-known engines in textbook units, as every book on engine dynamics has them.

See C. F. Taylor, The Internal-Combustion Engine in Theory and Practice, vol. 2; W. Thomson,
Fundamentals of Automotive Engine Balance; J. P. Den Hartog, Mechanical Vibrations. All are of rods
without mass and equal reciprocating masses m on cranks without unbalance: forces are multiples of
F1 = m r w^2 and of F_n = A_n F1, moments of these times the distance a of neighbouring throws,
about the middle of the crank.
"""

from cmath import exp
from math import cos, pi, radians, sin, sqrt
from typing import Any

import pytest
from support.engines import engine

from balcli.core.mechanisms import closed_form
from balcli.forces.spectrum import Spectra, compute_spectra

RELATIVE = 1e-13
LAM = 0.25
ORDERS = range(1, 13)
A = dict(zip(ORDERS, closed_form.piston(list(ORDERS), LAM), strict=True))
F1 = 1.0 * 0.05 * (2 * pi) ** 2  # N, at 60 rpm
ARM = 0.1  # m

INLINE = {
    "single": [0],
    "twin 180": [0, 180],
    "twin 360": [0, 0],
    "twin 270": [0, 90],
    "three": [0, 240, 120],
    "four": [0, 180, 180, 0],
    "four, cross-plane": [0, 90, 270, 180],
    "five": [0, 216, 144, 72, 288],
    "six": [0, 240, 120, 120, 240, 0],
    "eight": [0, 180, 90, 270, 270, 90, 180, 0],
}


def of(throws: list[float], splay: float = 0, **layout: Any) -> Spectra:
    crank = {"throws": throws, "spacing": 100, "splay": splay}
    return compute_spectra(engine(crank=crank, layout=layout), list(ORDERS))


def units(found: Spectra, quantity: str, order: int, part: str) -> float:
    """A size in multiples of F_n (or F_n a) of one cylinder; odd orders above 1, which no piston has, of F1."""
    phasors = getattr(found, quantity)
    one = F1 * abs(A[order] or 1.0) * (ARM if quantity == "moment" else 1)
    k = list(ORDERS).index(order)
    return float(abs(getattr(phasors, part)[k])) / one


def free(found: Spectra, quantity: str) -> list[int]:
    """The orders up to 12 that are there."""
    return [n for n, balanced in zip(ORDERS, getattr(found, quantity).balanced, strict=True) if not balanced]


# ------------------------------------------------------------------ vectors of every order
def line(size: float) -> tuple[float, float]:
    """Vectors with and against the crank of a force along a line."""
    return size / 2, size / 2


V90 = {"bank_angle": 90}
BOXER = {"banks": [-90, 90], "rods": "alternating"}
CROSS_PLANE = [0, 90, 270, 180]
FLAT_PLANE = [0, 180, 180, 0]
V6 = [0, 120, 240]
SIX_PINS = {"bank_angle": 60, "splay": -60}
SPLIT = {"bank_angle": 90, "splay": -30}


@pytest.mark.parametrize(
    ("throws", "layout", "vectors"),
    [
        ("single", {}, dict.fromkeys([1, 2, 4, 6, 8, 10, 12], line(1))),
        ("twin 180", {}, dict.fromkeys([2, 4, 6, 8, 10, 12], line(2))),
        ("twin 360", {}, dict.fromkeys([1, 2, 4, 6, 8, 10, 12], line(2))),
        ("twin 270", {}, {1: line(sqrt(2)), 4: line(2), 8: line(2), 12: line(2)}),
        ("three", {}, {6: line(3), 12: line(3)}),
        ("four", {}, dict.fromkeys([2, 4, 6, 8, 10, 12], line(4))),
        ("four, cross-plane", {}, dict.fromkeys([4, 8, 12], line(4))),
        ("five", {}, {10: line(5)}),
        ("six", {}, {6: line(6), 12: line(6)}),
        ("eight", {}, dict.fromkeys([4, 8, 12], line(8))),
        # a counterweight balances order 1 of a 90-degree V-twin; order 2 is across
        ([0], V90, {1: (1, 0)} | dict.fromkeys([2, 4, 6, 8, 10, 12], line(sqrt(2)))),
        (CROSS_PLANE, V90, dict.fromkeys([4, 8, 12], line(4 * sqrt(2)))),
        (FLAT_PLANE, V90, dict.fromkeys([2, 4, 6, 8, 10, 12], line(4 * sqrt(2)))),
        (V6, SIX_PINS, {6: line(3 * sqrt(3)), 12: line(3 * sqrt(3))}),
        (V6, V90, {6: line(3 * sqrt(2)), 12: line(3 * sqrt(2))}),
        (V6, SPLIT, {6: line(3 * sqrt(2)), 12: line(3 * sqrt(2))}),
        ([0, 180], BOXER, {}),
        (FLAT_PLANE, BOXER, {}),
        ([0, 180, 120, 300, 240, 60], BOXER, {}),
    ],
)
def test_forces(throws, layout, vectors):
    """Order n adds up where all n phi_i agree; everything else is balanced, and said to be so."""
    found = of(INLINE.get(str(throws), throws), **layout)
    assert free(found, "force") == list(vectors)
    assert not found.force.major[found.force.balanced].any()
    for n, (forward, backward) in vectors.items():
        assert forward != backward or found.force.minor[n - 1] == 0, n
        assert backward or found.force.backward[n - 1] == 0, n
        assert units(found, "force", n, "forward") == pytest.approx(forward, rel=RELATIVE)
        assert units(found, "force", n, "backward") == pytest.approx(backward, rel=RELATIVE)
        if layout == V90 and n > 1:  # across the bisector or along it
            assert found.force.axis_deg[n - 1] == pytest.approx(90 if n % 4 else 0, abs=1e-10), n


def five(order: int) -> float:
    """|sum z e^(i n phi)|: 0.449 and 4.980 in every book."""
    return abs(sum(z * exp(1j * order * radians(phi)) for z, phi in zip(range(-2, 3), INLINE["five"], strict=True)))


@pytest.mark.parametrize(
    ("throws", "layout", "first", "second"),
    [
        ("twin 180", {}, line(1), (0, 0)),
        ("twin 360", {}, (0, 0), (0, 0)),
        ("twin 270", {}, line(1 / sqrt(2)), line(1)),
        ("three", {}, line(sqrt(3)), line(sqrt(3))),  # counterweights alone can take half of it
        ("four", {}, (0, 0), (0, 0)),
        ("four, cross-plane", {}, line(sqrt(10)), (0, 0)),
        ("five", {}, line(five(1)), line(five(2))),
        ("six", {}, (0, 0), (0, 0)),
        ("eight", {}, (0, 0), (0, 0)),
        (CROSS_PLANE, V90, (sqrt(10), 0), (0, 0)),
        (FLAT_PLANE, V90, (0, 0), (0, 0)),
        # six pins: counterweights, and one shaft at -2
        (V6, SIX_PINS, (1.5, 0), (0, 1.5)),
        (V6, V90, (sqrt(3), 0), line(sqrt(6))),
        (V6, SPLIT, (sqrt(3) * cos(pi / 12), sqrt(3) * sin(pi / 12)), (sqrt(3) * sin(pi / 12), sqrt(3) * cos(pi / 12))),
        # pins stand at half the spacing of a bank's cylinders: the textbook's a is the distance of neighbouring pins
        ([0, 180], BOXER, line(1), line(1)),
        (FLAT_PLANE, BOXER, (0, 0), line(2)),
        ([0, 180, 120, 300, 240, 60], BOXER, (0, 0), (0, 0)),
    ],
)
def test_moments(throws, layout, first, second):
    found = of(INLINE.get(str(throws), throws), **layout)
    for order, vectors in ((1, first), (2, second)):
        parts = [units(found, "moment", order, part) for part in ("forward", "backward")]
        assert parts == pytest.approx(vectors, rel=RELATIVE, abs=1e-14), order
        assert (order in free(found, "moment")) is any(vectors), order
        if layout == BOXER and any(vectors):  # about x
            assert found.moment.axis_deg[order - 1] == pytest.approx(0, abs=1e-10), order
    assert (round(five(1), 3), round(five(2), 3)) == (0.449, 4.980)


# ------------------------------------------------------------------ other vees
@pytest.mark.parametrize("gamma", [15, 45, 60, 75.5, 120, 170])
def test_v_twins_of_any_angle(gamma):
    """Along the bisector 2 cos^2(g/2) F1 and 2 cos(g/2) cos g F2, across it 2 sin^2(g/2) F1 and 2 sin(g/2) sin g F2."""
    found = of([0], bank_angle=gamma)
    half = radians(gamma / 2)
    along = abs(found.force.x) / F1
    across = abs(found.force.y) / F1
    assert along[:2] == pytest.approx([2 * cos(half) ** 2, A[2] * abs(2 * cos(half) * cos(2 * half))], rel=RELATIVE)
    assert across[:2] == pytest.approx([2 * sin(half) ** 2, A[2] * 2 * sin(half) * sin(2 * half)], rel=RELATIVE)


@pytest.mark.parametrize("gamma", [45, 60, 90, 180])
def test_v12(gamma):
    """Two sixes: nothing below the sixth order, 12 cos(g/2) cos(6 g/2) F6 along the bisector."""
    found = of(INLINE["six"], bank_angle=gamma)
    half = radians(gamma / 2)
    assert min(free(found, "force"), default=99) >= 6
    assert free(found, "moment") == []
    sixth = F1 * abs(A[6])
    assert abs(found.force.x[5]) / sixth == pytest.approx(abs(12 * cos(half) * cos(6 * half)), abs=1e-12)
    assert abs(found.force.y[5]) / sixth == pytest.approx(abs(12 * sin(half) * sin(6 * half)), abs=1e-12)


# ------------------------------------------------------------------ radials
@pytest.mark.parametrize("count", [3, 5, 7, 9])
def test_radials_on_one_pin(count):
    """m cylinders, equal rods: m/2 F_n with the crank if n = i m + 1, against it if n = i m - 1; no other order."""
    found = of([0], radial=count)
    forward = {n for n in ORDERS if A[n] and n % count == 1}
    backward = {n for n in ORDERS if A[n] and (n + 1) % count == 0}
    assert {n for n, v in zip(ORDERS, found.force.forward, strict=True) if v} == forward
    assert {n for n, v in zip(ORDERS, found.force.backward, strict=True) if v} == backward
    for n in forward:
        assert units(found, "force", n, "forward") == pytest.approx(count / 2, rel=RELATIVE)
    for n in backward:
        assert units(found, "force", n, "backward") == pytest.approx(count / 2, rel=RELATIVE)
