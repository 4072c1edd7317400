"""What `--why` says that cancels, against the engine's own angles and arms in floating point."""

from __future__ import annotations

import re
from fractions import Fraction

import numpy as np
import pytest
from support.engines import build_text
from support.paths import ENGINES

from balcli import load
from balcli.forces.cancellation import Term, are_in_phase, tell_cancellation
from balcli.forces.spectrum import compute_each_cylinder, compute_spectra
from balcli.forces.symmetry import explain_symmetry

ORDERS = range(1, 13)
FILES = sorted(ENGINES.glob("*.toml"))


def polygon(corners: int, first: int, turned: Fraction = Fraction(0), weight: int = 1):
    return [Term(first + k, Fraction(weight), turned + Fraction(k, corners)) for k in range(corners)]


@pytest.mark.parametrize(
    ("terms", "told"),
    [
        (polygon(3, 1), "phasors at 0, 120, 240 deg sum to nothing"),
        (polygon(3, 1) + polygon(3, 4), "phasors at 0, 120, 240 deg, 2 each, sum to nothing"),
        (polygon(7, 1), "7 evenly spaced phasors sum to nothing"),
        (
            polygon(3, 1) + polygon(2, 4, Fraction(1, 8)),
            "phasors form opposite pairs and triangles, which sum to nothing",
        ),
        (polygon(5, 1) + polygon(5, 6, Fraction(1, 12)), "phasors form pentagons, which sum to nothing"),
        (
            [Term(1, Fraction(-3), Fraction(1, 3)), Term(4, Fraction(3), Fraction(1, 3))],
            "the mirror pair (1 and 4) pulls alike on opposite arms",
        ),
        (
            [Term(k, Fraction(w), Fraction(0)) for k, w in enumerate((-3, 1, 2), 1)],
            "cylinders that pull alike have arms that sum to nothing",
        ),
        (  # minus a phasor is one half a turn further
            [*polygon(3, 1)[:2], Term(3, Fraction(-1), Fraction(1, 6))],
            "phasors at 0, 120, 240 deg sum to nothing",
        ),
        (  # the corner at 180 deg of five and three, less both: no polygon of positive weights
            [*polygon(5, 1)[1:], *(Term(t.number, -t.weight, t.angle) for t in polygon(3, 6)[1:])],
            "phasors are roots of unity that sum to nothing",
        ),
    ],
)
def test_how_terms_cancel(terms, told):
    assert abs(sum(float(t.weight) * np.exp(2j * np.pi * float(t.angle)) for t in terms)) < 1e-12
    assert tell_cancellation([terms]) == told


def test_terms_of_different_sets_are_no_pairs():
    sets = [
        [Term(1, Fraction(1), Fraction(0)), Term(5, Fraction(-1), Fraction(0))],
        [Term(2, Fraction(1), Fraction(0)), Term(4, Fraction(-1), Fraction(0))],
    ]
    assert tell_cancellation(sets) == "mirror pairs (1 and 5, 2 and 4) pull alike on opposite arms"


def test_what_adds_up_in_full():
    alike = [Term(1, Fraction(1), Fraction(1, 3)), Term(2, Fraction(-1), Fraction(5, 6))]
    assert are_in_phase(alike)
    assert not are_in_phase(alike[:1])
    assert not are_in_phase([alike[0], alike[1]._replace(angle=Fraction(1, 3))])


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_phasors_and_pairs_are_those_of_the_engine(file):
    """Angles that are listed are a phasor's of each sense, and mirror pairs have opposite arms; of
    engines in line, whose phasors are n times the pin's angle.
    """
    engine = load(file)
    c = engine.cylinders
    in_line = len(np.ravel(c.axis_deg)) == 1 and not engine.rotary
    pins = np.ravel(c.pin_deg)
    arms = dict(zip(engine.numbers, np.ravel(c.z - engine.reference_m[2]), strict=True))
    kinds = ("force", "moment", "couple", "torque")
    for reason in explain_symmetry(engine, ORDERS, kinds).reasons:
        assert bool(reason.because) >= (reason.verdict == "exact"), reason
        if not in_line:
            continue
        for one, other in re.findall(r"(\d+) and (\d+)", reason.because):
            if "mirror" in reason.because:
                assert arms[int(one)] == pytest.approx(-arms[int(other)], rel=1e-12)
        if listed := re.search(r"phasors at ([\d., ]+?) deg", reason.because):
            found = {round(float(angle), 3) for angle in listed[1].split(", ")}
            own = reason.order * (pins - pins[engine.numbers.index(1)])
            turn = 360 if reason.quantity != "moment" else 180  # an arm turns its phasor over
            own = np.round(own % 360, 3) % turn
            assert {angle % turn for angle in found} == set(own.tolist()), reason
        if reason.because == "all in phase" and reason.quantity != "moment":
            own = reason.order * (pins - pins[0]) / 360
            assert own == pytest.approx(np.round(own), abs=1e-9)


def test_offset_mechanisms_are_not_in_phase_where_one_piston_is_lighter():
    """Throws side by side. The first order of an offset piston stands aslant to its crank pin, what
    turns with the pin does not, and counts for more beside the lighter piston.
    """
    text = """
[crank]
stroke = 80
throws = [0, 0]
spacing = 100
throw_mass = 1
[rod]
length = 110
[piston]
mass = 0.5
offset = 15
[cylinder.2]
piston_mass = 0.1
"""
    found = explain_symmetry(build_text(text), [1, 2], ["force"]).reasons
    assert [reason.because for reason in found] == ["", "all in phase"]
    alike = explain_symmetry(build_text(text.replace("offset = 15", "")), [1, 2], ["force"]).reasons
    assert [reason.because for reason in alike] == ["all in phase", "all in phase"]


def test_unequal_mechanisms_are_not_in_phase_because_equal_ones_are():
    """Two master rods and two articulated ones: those of a kind are in phase, but both kinds have
    phases of their own, and their forces add up to less than the sum of their sizes.
    """
    engine = build_text(
        """
[crank]
stroke = 80
throws = [0, 0]
spacing = 100
[rod]
length = 180
mass = 0.8
cg = 50
[piston]
mass = 0.5
[layout]
bank_angle = 60
[articulation]
knuckle_radius = 30
rod = { length = 150, mass = 0.5, cg = 40 }
"""
    )
    found = compute_spectra(engine, [2], ("force",)).force.major[0]
    each = compute_each_cylinder(engine, [2], ("force",))["force"].major[0]
    assert found < 0.95 * each.sum()
    assert all("phase" not in told for told in explain_symmetry(engine, [2]).sentences)
