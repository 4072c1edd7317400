"""Proofs of balance both ways: what is proved is exactly 0 in the figures, and what is symmetrical
by construction is proved, whatever its units, factors and whole turns.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from support.engines import build_text

from balcli.engine import build as engine
from balcli.forces.spectrum import compute_spectra
from balcli.forces.symmetry import Symmetry, explain_symmetry

ORDERS = np.arange(1.0, 7.0)
KINDS = {"force": ["force"], "moment": ["moment"], "turning": ["couple", "torque", "roll"]}
TEXT = """\
[crank]
stroke = {stroke}
throws = {throws}
spacing = {spacing}
throw_mass = {throw_mass}
[rod]
length = {length}
mass = {rod_mass}
cg = {cg}
inertia = 2500
[piston]
mass = {piston}
[layout]
{layout}
[operation]
speed = 3000
"""
METRIC = {
    "stroke": 90,
    "throws": [0],
    "spacing": 100,
    "throw_mass": 0.8,
    "length": 160,
    "rod_mass": 0.6,
    "cg": 45,
    "piston": 0.5,
    "layout": "banks = [0]",
}
IMPERIAL = {
    "stroke": '"3.48 in"',
    "spacing": '"4.1 in"',
    "throw_mass": '"1.37 lb"',
    "length": '"6.135 in"',
    "rod_mass": '"1.234 lb"',
    "cg": '"1.7 in"',
    "piston": '"1.113 lb"',
}
HUNG = """
[articulation]
knuckle_radius = 30
rod = { length = 140, mass = 0.4, cg = 50, inertia = 900 }
"""
LAYOUTS = {
    "in line": "banks = [0]",
    "vee": "bank_angle = 72.4",
    "articulated vee": "bank_angle = 60" + HUNG,
    "articulated star": "radial = 5" + HUNG,
    "rotary": "radial = 5\nrotary = true",
    "articulated rotary": "radial = 5\nrotary = true" + HUNG,
}


def explain(text: str) -> tuple[engine.Engine, Symmetry]:
    built = build_text(text)
    return built, explain_symmetry(built, ORDERS)


def exact(found: Symmetry, quantity: str) -> set[int]:
    """Orders that are proved, or of which no cylinder has any."""
    verdicts = ("exact", "none")
    return {r.order for r in found.reasons if r.quantity == quantity and r.verdict in verdicts}


def check_figures(built: engine.Engine, found: Symmetry) -> None:
    """What is proved is exactly 0."""
    bare = replace(built, devices=(), reference_m=(0.0, 0.0, built.reference_m[2]))
    spectra = compute_spectra(bare, ORDERS)
    for reason in found.reasons:
        if reason.verdict == "exact":
            for kind in KINDS[reason.quantity]:
                assert spectra[kind].balanced[reason.order - 1], (reason, kind)


# ------------------------------------------------------------------ proof => exactly 0
@pytest.mark.parametrize("seed", range(40))
def test_what_is_proved_is_exactly_0(seed: int) -> None:
    """Cranks and masses with some symmetry, and master rods, pistons and places that may break
    it.
    """
    random = np.random.default_rng(seed)
    parts = int(random.choice([2, 3, 4, 5, 7]))
    turns = np.tile(np.arange(parts), 2)[: int(random.integers(parts, 2 * parts + 1))]
    throws = [f"{k}/{parts} turn" for k in random.permutation(turns)]
    layout = random.choice([*LAYOUTS.values()])
    numbers = random.permutation(np.arange(1, len(throws) + 1))[:2]
    keys = ("rod_length = 190", "piston_mass = 1.0", "position = 33.3")
    own = "".join(f"[cylinder.{n}]\n{random.choice(keys)}\n" for n in numbers if random.random() < 0.7)
    text = TEXT.format(**METRIC | {"throws": str(throws).replace("'", '"'), "layout": layout}) + own
    check_figures(*explain(text))


@pytest.mark.parametrize("rotary", ["", "rotary = true\n"])
def test_slaves_of_unequal_masters_are_unequal(rotary: str) -> None:
    """Two throws opposed; only the slaves have pistons, the masters' rods differ."""
    hung = "[articulation]\nknuckle_radius = 30\nknuckle_angles = [0, 66]\nrod = { length = 140 }\n"
    massless = {"piston": 0, "rod_mass": 0, "spacing": 0, "throws": [0, 180]}
    layout = "bank_angle = 60\n" + rotary + hung
    text = TEXT.format(**METRIC | massless | {"layout": layout}).replace("inertia = 2500\n", "")
    pistons = "[cylinder.3]\npiston_mass = 1\n[cylinder.4]\npiston_mass = 1\n"
    built, equal = explain(text + pistons)
    check_figures(built, equal)
    odd = {"turning": {1, 3}, "force": {2, 4} if rotary else {1, 3}}
    unequal = explain(text + pistons + "[cylinder.1]\nrod_length = 190\n")[1]
    for quantity, orders in odd.items():
        assert orders <= exact(equal, quantity)
        assert not orders & exact(unequal, quantity)


# ------------------------------------------------------------------ symmetrical => proof
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize(("parts", "units"), [(2, "imperial"), (3, "metric"), (5, "imperial"), (7, "metric")])
def test_what_is_symmetrical_is_proved(parts: int, layout: str, units: str) -> None:
    """Throws evenly round the crank and then again from its other end: forces and torques of orders
    that are no multiple of their number vanish, and moments of all orders. Of a rotary engine the
    pins stand still, and forces of the orders beside such multiples stay instead.
    """
    random = np.random.default_rng(parts)
    share = Fraction(1, parts)
    given = random.permutation(parts)
    throws = [f"{k * share + int(random.integers(-9, 9))} turn" for k in [*given, *given[::-1]]]
    file = METRIC | (IMPERIAL if units == "imperial" else {"spacing": 77.777, "length": 139.73})
    file |= {"throws": str(throws).replace("'", '"'), "layout": LAYOUTS[layout]}
    built, found = explain(TEXT.format(**file))
    none = {n for n in range(1, 7) if n % parts}
    beside = {n for n in range(1, 7) if (n - 1) % parts and (n + 1) % parts}
    assert none <= exact(found, "turning")
    assert (beside if "rotary" in layout else none) <= exact(found, "force")
    assert exact(found, "moment") == set(range(1, 7))
    check_figures(built, found)


def test_whole_turns_are_no_angle() -> None:
    file = METRIC | {"throws": [3420, 3420 + 1320, 3420 - 1320]}
    found = explain(TEXT.format(**file))[1]
    assert {1, 2, 4, 5} <= exact(found, "force")


def test_masses_and_places_in_any_proportion() -> None:
    """Pistons of 1:2:1 at 0-180-0; the same times an odd factor."""
    for factor in (1.0, 0.731, 1 / 3):
        file = METRIC | {"throws": [0, 180, 0], "rod_mass": 0, "throw_mass": 0}
        text = TEXT.format(**file | {"piston": factor}).replace("inertia = 2500\n", "")
        own = f"[cylinder.2]\npiston_mass = {2 * factor}\n"
        found = explain(text + own)[1]
        assert {1, 3, 5} <= exact(found, "force")
        assert {1, 3, 5} <= exact(found, "turning")


def test_pairs_at_places_that_share_no_unit() -> None:
    """Each pair of throws in one plane cancels by itself."""
    file = METRIC | {"throws": [0, 180, 90, 270], "spacing": 0}
    text = TEXT.format(**file).replace("spacing = 0", "positions = [31.4159265, 31.4159265, 271.8281828, 271.8281828]")
    found = explain(text)[1]
    assert {1, 3, 5} <= exact(found, "moment")


# ------------------------------------------------------------------ words
def test_nearly_even_to_how_much() -> None:
    intervals = [720 / 7] * 6
    intervals[0] += 3e-7
    intervals.append(720 - sum(intervals))
    file = METRIC | {"layout": f"firing_order = [1,2,3,4,5,6,7]\nfiring_intervals = {intervals}"}
    text = TEXT.format(**file).replace("throws = [0]\n", "")
    assert explain(text)[1].firing == "firing: even to 6e-07 deg, every 102.857 deg"
