"""Whether orders are balanced by symmetry or by chance; and how engines fire."""

from dataclasses import replace

import numpy as np
import pytest
from support.cases import cases
from support.engines import build_text
from support.paths import ENGINE_FILES, ENGINES

from balcli import analyze, load
from balcli.forces.spectrum import compute_spectra
from balcli.forces.symmetry import explain_symmetry

BASE = """\
crank = {{ stroke = 90, throws = {throws}, spacing = {spacing} }}
rod = {{ length = 160 }}
piston.mass = 0.5
"""


def sentences(throws, *, spacing=100, more="", orders=(1, 2)):
    text = BASE.format(throws=throws, spacing=spacing) + more
    return explain_symmetry(build_text(text), orders).sentences


def test_the_inline_four():
    """Textbook: order 1 balanced; order 2 adds up to four times one cylinder."""
    assert sentences([0, 180, 180, 0], more="[layout]\nfiring_order = [1, 3, 4, 2]\n") == (
        "order 1 force: balanced by symmetry of the layout",
        "order 2 force: unbalanced: 4 F2",
        "orders 1, 2 moment: balanced by symmetry of the layout",
        "orders 1, 2 couple: zero in every cylinder",
        "order 1 torque and roll: balanced by symmetry of the layout",
        "order 2 torque and roll: unbalanced: 4 times that of one cylinder",
        "firing: even, every 180 deg",
    )


def test_master_and_articulated_rods_of_a_rotary_engine_are_not_alike():
    """Alike in mass and length, they differ in where they hang: without knuckle pins the first
    order would vanish by symmetry.
    """
    star = "[layout]\nradial = 5\nrotary = true\n"
    hung = "[articulation]\nknuckle_radius = 30\nrod = { length = 160, mass = 0 }\n"
    assert sentences([0], more=star)[0].startswith("orders 1, 2 force: balanced by symmetry")
    assert sentences([0], more=star + hung)[0].startswith("order 1 force: unbalanced: ")


@pytest.mark.parametrize(
    ("throws", "heavy"),
    [([0, 180, 0], (2,)), ([0, np.degrees(np.arccos(-0.25)), -np.degrees(np.arccos(-0.25))], (2, 3))],
)
def test_balanced_by_masses_that_fit_is_chance(throws, heavy):
    """1 - 2 + 1 = 0, and 1 + 2 * 2 cos a = 0: not with other pistons for all cylinders."""
    more = "".join(f"[cylinder.{n}]\npiston_mass = 1.0\n" for n in heavy)
    found = sentences(list(map(float, throws)), more=more)
    assert found[0] == "order 1 force: balanced by chance, for these figures only"


def test_two_banks_of_different_mechanisms_that_are_each_balanced():
    """A VR6: neighbouring pins stand at no fraction of a turn, but each bank is a balanced three."""
    assert explain_symmetry(load(ENGINES / "vr6.toml"), [1]).reasons[0].verdict == "symmetry"


@cases("forces/symmetry", "even_and_uneven_fire_in_words")
def test_even_and_uneven_fire_in_words(layout, text):
    base = "crank.stroke = 90\nrod.length = 160\npiston.mass = 0.5\n[layout]\n"
    assert explain_symmetry(build_text(base + layout), [1]).firing == text


@pytest.mark.parametrize("path", ENGINE_FILES, ids=lambda path: path.stem)
def test_verdicts_agree_with_the_figures(path):
    """What is called balanced has no force left but rounding, and nothing else has."""
    built = load(path)
    found = compute_spectra(replace(built, devices=()), np.arange(1.0, 9.0))
    for reason in explain_symmetry(built, range(1, 9)).reasons:
        kinds = ["couple", "torque"] if reason.quantity == "turning" else [reason.quantity]
        balanced = all(found[kind].balanced[reason.order - 1] for kind in kinds)
        assert balanced == (reason.verdict in ("symmetry", "none", "chance")), reason


@pytest.mark.parametrize(
    ("more", "left_out"),
    [
        ("[[counterweight]]\nunbalance = 9000", "without counterweights, shafts and sliders"),
        ("[operation]\nspeed_ripple = [{ order = 1, amplitude = 0.02 }]", "at steady speed"),
        ("[frame]\nreference = [0, 40, 0]", "couple and roll about the crank's axis"),
    ],
)
def test_what_the_reasons_leave_out_is_said(more, left_out):
    """Else "balanced" stands below a force that is not."""
    told = sentences([0, 180], more=more, orders=[1])
    assert told[0] == f"cylinders only: {left_out}"
    assert told[1:] == sentences([0, 180], orders=[1])
    text = BASE.format(throws=[0, 180], spacing=100) + more
    assert analyze(build_text(text), [1], ["force"], why=True).to_dict()["why"]["scope"] == told[0]


LAYOUTS = {
    "in line": "banks = [0]",
    "vee": "bank_angle = 72.4",
    "articulated star": "radial = 5\n[articulation]\nknuckle_radius = 30\n"
    "rod = { length = 140, mass = 0.4, cg = 50, inertia = 900 }",
    "rotary": "radial = 5\nrotary = true",
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("parts", [2, 3, 5, 7])
def test_what_is_symmetrical_by_construction_is_balanced_by_symmetry(layout, parts):
    """Throws evenly round the crank and again from its other end: orders that are no multiple of
    their number vanish, and moments of all orders. The pins of a rotary engine stand still: its
    forces vanish unless an order next to theirs is such a multiple.
    """
    given = np.random.default_rng(parts).permutation(parts)
    throws = str([f"{k}/{parts} turn" for k in [*given, *given[::-1]]]).replace("'", '"')
    text = BASE.format(throws=throws, spacing=77.777) + f"[layout]\n{LAYOUTS[layout]}\n"
    text = text.replace("length = 160 }", "length = 160, mass = 0.6, cg = 45, inertia = 2500 }")
    verdicts = {(r.quantity, r.order): r.verdict for r in explain_symmetry(build_text(text), range(1, 7)).reasons}
    none = {n for n in range(1, 7) if n % parts}
    beside = {n for n in range(1, 7) if (n - 1) % parts and (n + 1) % parts}
    wanted = {("moment", n) for n in range(1, 7)} | {("turning", n) for n in none}
    wanted |= {("force", n) for n in (beside if layout == "rotary" else none)}
    assert {verdicts[one] for one in wanted} <= {"symmetry", "none"}
    assert "unbalanced" in verdicts.values() or parts == 7
