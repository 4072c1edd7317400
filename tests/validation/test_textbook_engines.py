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


def of(throws: list[float], **layout: Any) -> Spectra:
    return compute_spectra(engine(crank={"throws": throws, "spacing": 100}, layout=layout), list(ORDERS))


def units(found: Spectra, quantity: str, order: int, part: str) -> float:
    """A size in multiples of F_n (or F_n a) of one cylinder; odd orders above 1, which no piston has, of F1."""
    phasors = getattr(found, quantity)
    one = F1 * abs(A[order] or 1.0) * (ARM if quantity == "moment" else 1)
    k = list(ORDERS).index(order)
    return float(abs(getattr(phasors, part)[k])) / one


def free(found: Spectra, quantity: str) -> list[int]:
    """The orders up to 12 that are there."""
    return [n for n, balanced in zip(ORDERS, getattr(found, quantity).balanced, strict=True) if not balanced]


# ------------------------------------------------------------------ in line
@pytest.mark.parametrize(
    ("name", "orders"),
    [
        ("single", dict.fromkeys([1, 2, 4, 6, 8, 10, 12], 1)),
        ("twin 180", dict.fromkeys([2, 4, 6, 8, 10, 12], 2)),
        ("twin 360", dict.fromkeys([1, 2, 4, 6, 8, 10, 12], 2)),
        ("twin 270", {1: sqrt(2), 4: 2, 8: 2, 12: 2}),
        ("three", {6: 3, 12: 3}),
        ("four", dict.fromkeys([2, 4, 6, 8, 10, 12], 4)),
        ("four, cross-plane", {4: 4, 8: 4, 12: 4}),
        ("five", {10: 5}),
        ("six", {6: 6, 12: 6}),
        ("eight", {4: 8, 8: 8, 12: 8}),
    ],
)
def test_forces_in_line(name, orders):
    """Order n adds up where all n phi_i agree; everything else is balanced, and said to be so."""
    found = of(INLINE[name])
    assert free(found, "force") == list(orders)
    for n, factor in orders.items():
        assert units(found, "force", n, "major") == pytest.approx(factor, rel=RELATIVE)
        assert units(found, "force", n, "minor") == 0


@pytest.mark.parametrize(
    ("name", "first", "second"),
    [
        ("twin 180", 1, 0),
        ("twin 360", 0, 0),
        ("twin 270", 1 / sqrt(2), 1),
        ("three", sqrt(3), sqrt(3)),
        ("four", 0, 0),
        ("four, cross-plane", sqrt(10), 0),
        ("six", 0, 0),
        ("eight", 0, 0),
    ],
)
def test_moments_in_line(name, first, second):
    found = of(INLINE[name])
    for order, factor in ((1, first), (2, second)):
        assert units(found, "moment", order, "major") == pytest.approx(factor, rel=RELATIVE, abs=1e-14), order
        assert (order in free(found, "moment")) is (factor != 0), order


@pytest.mark.parametrize(("order", "printed"), [(1, 0.449), (2, 4.980)])
def test_moments_of_the_five(order, printed):
    """Firing 1-2-4-5-3; the printed figures are those of every book, |sum z e^(i n phi)| makes them exact."""
    exact = abs(sum(z * exp(1j * order * radians(phi)) for z, phi in zip(range(-2, 3), INLINE["five"], strict=True)))
    assert exact == pytest.approx(printed, abs=5e-4)
    assert units(of(INLINE["five"]), "moment", order, "major") == pytest.approx(exact, rel=RELATIVE)


def test_in_line_moments_turn_half_with_and_half_against_the_crank():
    """So that counterweights alone can take half of it."""
    found = of(INLINE["three"])
    assert units(found, "moment", 1, "forward") == pytest.approx(sqrt(3) / 2, rel=RELATIVE)
    assert units(found, "moment", 1, "backward") == pytest.approx(sqrt(3) / 2, rel=RELATIVE)
    assert units(found, "moment", 1, "minor") < 1e-14


# ------------------------------------------------------------------ vees
def test_90_degree_v_twin():
    """First order: a vector of F1 turning with the crank, which a counterweight balances; second: sqrt 2 F2, across."""
    found = of([0], bank_angle=90)
    assert units(found, "force", 1, "forward") == pytest.approx(1, rel=RELATIVE)
    assert found.force.backward[0] == 0
    assert units(found, "force", 2, "major") == pytest.approx(sqrt(2), rel=RELATIVE)
    assert found.force.axis_deg[1] == pytest.approx(90)
    assert units(found, "force", 2, "minor") < 1e-14


@pytest.mark.parametrize("gamma", [15, 45, 60, 75.5, 120, 170])
def test_v_twins_of_any_angle(gamma):
    """Along the bisector 2 cos^2(g/2) F1 and 2 cos(g/2) cos g F2, across it 2 sin^2(g/2) F1 and 2 sin(g/2) sin g F2."""
    found, half = of([0], bank_angle=gamma), radians(gamma / 2)
    along, across = abs(found.force.x) / F1, abs(found.force.y) / F1
    assert along[:2] == pytest.approx([2 * cos(half) ** 2, A[2] * abs(2 * cos(half) * cos(2 * half))], rel=RELATIVE)
    assert across[:2] == pytest.approx([2 * sin(half) ** 2, A[2] * 2 * sin(half) * sin(2 * half)], rel=RELATIVE)


def test_cross_plane_v8():
    """sqrt 10 F1 a turning with the crank, no second order; the eighth is small, but there: 4 sqrt 2 F8."""
    found = of([0, 90, 270, 180], bank_angle=90)
    assert free(found, "force") == [4, 8, 12]
    assert units(found, "moment", 1, "forward") == pytest.approx(sqrt(10), rel=RELATIVE)
    assert found.moment.backward[0] == 0
    assert 2 not in free(found, "moment")
    assert units(found, "force", 4, "major") == pytest.approx(4 * sqrt(2), rel=RELATIVE)
    assert units(found, "force", 8, "major") == pytest.approx(4 * sqrt(2), rel=RELATIVE)
    assert found.force.axis_deg[[3, 7]] == pytest.approx([0, 0], abs=1e-10)


def test_flat_plane_v8():
    """4 sqrt 2 F2 across the bisector, no moments."""
    found = of([0, 180, 180, 0], bank_angle=90)
    assert 1 not in free(found, "force")
    assert units(found, "force", 2, "major") == pytest.approx(4 * sqrt(2), rel=RELATIVE)
    assert found.force.axis_deg[1] == pytest.approx(90)
    assert free(found, "moment") == []


@pytest.mark.parametrize("gamma", [45, 60, 90, 180])
def test_v12(gamma):
    """Two sixes: nothing below the sixth order, 12 cos(g/2) cos(6 g/2) F6 along the bisector."""
    found, half = of(INLINE["six"], bank_angle=gamma), radians(gamma / 2)
    assert min(free(found, "force"), default=99) >= 6
    assert free(found, "moment") == []
    sixth = F1 * abs(A[6])
    assert abs(found.force.x[5]) / sixth == pytest.approx(abs(12 * cos(half) * cos(6 * half)), abs=1e-12)
    assert abs(found.force.y[5]) / sixth == pytest.approx(abs(12 * sin(half) * sin(6 * half)), abs=1e-12)


def v6(gamma: float, splay: float) -> Spectra:
    crank = {"throws": [0, 120, 240], "spacing": 100, "splay": splay}
    return compute_spectra(engine(crank=crank, layout={"bank_angle": gamma}), list(ORDERS))


def test_v6_of_60_degrees_on_six_pins():
    """3/2 F1 a turning with the crank, 3/2 F2 a against it: counterweights, and one shaft at -2."""
    found = v6(60, -60)
    assert {1, 2, 3, 4, 5} & set(free(found, "force")) == set()
    assert units(found, "moment", 1, "forward") == pytest.approx(1.5, rel=RELATIVE)
    assert units(found, "moment", 2, "backward") == pytest.approx(1.5, rel=RELATIVE)
    assert found.moment.backward[0] == found.moment.forward[1] == 0


@pytest.mark.parametrize("splay", [0, -30])
def test_v6_of_90_degrees(splay):
    """sqrt 3 F1 a turning with the crank; with pins split by s cos(s/2) of it, and sin(s/2) against the crank."""
    found = v6(90, splay)
    assert {1, 2, 3, 4, 5} & set(free(found, "force")) == set()
    half = radians(abs(splay) / 2)
    assert units(found, "moment", 1, "forward") == pytest.approx(sqrt(3) * cos(half), rel=RELATIVE)
    assert units(found, "moment", 1, "backward") == pytest.approx(sqrt(3) * sin(half), rel=RELATIVE)


# ------------------------------------------------------------------ boxers: opposed pistons on pins of their own
@pytest.mark.parametrize(
    ("pins", "first", "second"),
    [([0, 180], 1, 1), ([0, 180, 180, 0], 0, 2), ([0, 180, 120, 300, 240, 60], 0, 0)],
    ids=["twin", "four", "six"],
)
def test_boxers(pins, first, second):
    """No forces, and moments F1 a and F2 a about x. Pins stand at half the spacing of a bank's cylinders: the
    textbook's a is the distance of neighbouring pins.
    """
    found = of(pins, banks=[-90, 90], rods="alternating")
    assert free(found, "force") == []
    for order, factor in ((1, first), (2, second)):
        assert (order in free(found, "moment")) is (factor != 0)
        assert units(found, "moment", order, "major") == pytest.approx(factor, rel=RELATIVE)
    if len(pins) == 2:
        assert found.moment.axis_deg[:2] == pytest.approx([0, 0])


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
