"""Why orders are balanced: exact, nearly, free; and how engines fire."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from support.engines import build_text
from support.paths import ENGINE_FILES

from balcli.engine import build as engine
from balcli.engine import load as enginefile
from balcli.forces import spectrum
from balcli.forces.symmetry import explain_symmetry
from balcli.render.analysis_document import document as analysis_document
from balcli.render.json import json_text
from balcli.results import analysis

BASE = """\
[crank]
stroke = 90
throws = {throws}
spacing = {spacing}
[rod]
length = 160
[piston]
mass = 0.5
"""


def sentences(throws, *, spacing=100, more="", orders=(1, 2)):
    text = BASE.format(throws=throws, spacing=spacing) + more
    return explain_symmetry(build_text(text), orders).sentences


def test_the_inline_four():
    """Textbook: orders 1 balanced; order 2 adds up to four times one cylinder, on one line through
    the middle.
    """
    opposite = "balanced exactly: phasors at 0, 180 deg, 2 each, sum to nothing"
    mirrored = "mirror pairs (1 and 4, 2 and 3) pull alike on opposite arms"
    assert sentences([0, 180, 180, 0], more="[layout]\nfiring_order = [1, 3, 4, 2]\n") == (
        f"order 1 force: {opposite}",
        "order 2 force: free: 4 F2, all in phase",
        f"orders 1, 2 moment: balanced exactly: {mirrored}",
        f"order 1 couple, torque and roll: {opposite}",
        "order 2 couple, torque and roll: free: 4 of one cylinder, all in phase",
        "firing: even, every 180 deg",
    )


def test_orders_that_no_cylinder_has():
    found = sentences([0, 120, 240], orders=[3])
    assert found[0] == "order 3 force: no cylinder has any"
    assert found[2] == "order 3 couple, torque and roll: free: 3 of one cylinder, all in phase"


def test_master_and_articulated_rods_of_a_rotary_engine_are_not_alike():
    """Alike in mass and length, they differ in where they hang: without knuckle pins the first
    order would vanish by symmetry.
    """
    star = "[layout]\nradial = 5\nrotary = true\n"
    hung = "[articulation]\nknuckle_radius = 30\nrod = { length = 160, mass = 0 }\n"
    assert sentences([0], more=star)[0].startswith("orders 1, 2 force: balanced exactly: ")
    assert sentences([0], more=star + hung)[0].startswith("order 1 force: free: ")


def test_a_hundredth_of_a_degree_is_nearly_balanced():
    """|1 + e^{i 120.01 deg} + e^{i 240 deg}| = 2 sin(0.005 deg)."""
    assert (
        sentences([0, 120.01, 240])[0]
        == f"order 1 force: nearly balanced: {2 * np.sin(np.radians(0.005)):.1g} of one cylinder"
    )


def test_places_that_are_no_exact_numbers_in_binary():
    """Moments of order 2 of 0-120-240-240-120-0 vanish by mirror symmetry for any spacing, also 0.1
    in.
    """
    found = sentences([0, 120, 240, 240, 120, 0], spacing='"4.1 in"')
    mirrored = "mirror pairs (1 and 6, 2 and 5, 3 and 4) pull alike on opposite arms"
    assert found[1] == f"orders 1, 2 moment: balanced exactly: {mirrored}"


def test_the_middle_piston_as_heavy_as_both_others():
    """0-180-0 with masses 1:2:1: the first order vanishes by weight, the second does not."""
    more = "[cylinder.2]\npiston_mass = 1.0\n"
    found = sentences([0, 180, 0], more=more)
    summed = "phasors at 0, 180 deg sum to nothing"
    assert found[:2] == (f"order 1 force: balanced exactly: {summed}", "order 2 force: free: 4 F2, all in phase")


def test_two_banks_of_different_mechanisms_that_are_each_balanced():
    """A VR6: neighbouring pins stand at no fraction of a turn, but each bank is a balanced
    three.
    """
    vr6 = engine.build(enginefile.read(next(p for p in ENGINE_FILES if p.stem == "vr6")))
    assert explain_symmetry(vr6, [1]).reasons[0].verdict == "exact"


def test_pairs_that_stand_at_no_fraction_of_a_turn_to_each_other():
    assert (
        sentences([0, 33.3333333333, 180, 213.3333333333])[0]
        == "order 1 force: balanced exactly: phasors at 0, 180 deg sum to nothing"
    )


def test_balanced_by_figures_only():
    """Worked out: 1 + 2 · 2 cos a = 0 for masses 1:2:2; no symmetry, and nothing left but
    rounding.
    """
    found = sentences(
        [0, float(np.degrees(np.arccos(-0.25))), -float(np.degrees(np.arccos(-0.25)))],
        more="[cylinder.2]\npiston_mass = 1\n[cylinder.3]\npiston_mass = 1\n",
    )
    assert found[0] == "order 1 force: balanced to rounding, but not by exact fractions of a turn"


@pytest.mark.parametrize(
    ("layout", "text"),
    [
        ("firing_order = [1, 2, 3]\nfiring_intervals = [240, 240, 240]", "firing: even, every 240 deg"),
        (
            "firing_order = [1, 2, 3]\nfiring_intervals = [240, 239.9, 240.1]",
            "firing: nearly even, every 239.9 to 240.1 deg",
        ),
        (
            "firing_order = [1, 2, 3]\nfiring_intervals = [180, 270, 270]",
            "firing: uneven, at intervals of 180, 270, 270 deg",
        ),
    ],
)
def test_even_and_uneven_fire_in_words(layout, text):
    base = "[crank]\nstroke = 90\n[rod]\nlength = 160\n[piston]\nmass = 0.5\n[layout]\n"
    assert explain_symmetry(build_text(base + layout), [1]).firing == text


@pytest.mark.parametrize("path", ENGINE_FILES, ids=lambda path: path.stem)
def test_exact_and_numeric_decisions_agree(path):
    """What is balanced exactly has no force left but rounding, and what is free is not reported as
    balanced.
    """
    built = engine.build(enginefile.read(path))
    bare = replace(built, devices=())
    found = spectrum.compute_spectra(bare, np.arange(1.0, 9.0))
    for reason in explain_symmetry(built, range(1, 9)).reasons:
        numeric = [
            getattr(found, q).balanced[reason.order - 1]
            for q in (["couple", "torque"] if reason.quantity == "turning" else [reason.quantity])
        ]
        assert all(numeric) == (reason.verdict in ("exact", "none", "rounding")), reason


@pytest.mark.parametrize(
    ("more", "left_out"),
    [
        ("[[counterweight]]\nunbalance = 9000", "without counterweights, shafts and sliders"),
        ("[operation]\nspeed_ripple = [{ order = 1, amplitude = 0.02 }]", "at steady speed"),
        ("[frame]\nreference = [0, 40, 0]", "couple and roll about the crank's axis"),
    ],
)
def test_what_the_reasons_leave_out_is_said(more, left_out):
    """Else "balanced exactly" stands below a force that is not."""
    told = sentences([0, 180], more=more, orders=[1])
    assert told[0] == f"of the cylinders alone: {left_out}"
    assert told[1:] == sentences([0, 180], orders=[1])
    text = BASE.format(throws=[0, 180], spacing=100) + more
    result = analysis.analyze(build_text(text), [1], ["force"], reasons=True)
    assert analysis_document(result)["why"]["scope"] == told[0]


def test_only_what_is_asked_and_as_json():
    built = build_text(BASE.format(throws=[0, 180], spacing=100))
    result = analysis.analyze(built, [1, 2], ["force"], reasons=True)
    document = json.loads(json_text(analysis_document(result)))
    assert document["why"] == {
        "reasons": [
            {
                "order": 1,
                "quantity": "force",
                "verdict": "exact",
                "size": 0.0,
                "reciprocating": 0.0,
                "built": 0.0,
                "unit": "F1",
                "because": "phasors at 0, 180 deg sum to nothing",
            },
            {
                "order": 2,
                "quantity": "force",
                "verdict": "free",
                "size": pytest.approx(2),
                "reciprocating": pytest.approx(2),
                "built": pytest.approx(2),
                "unit": "F2",
                "because": "all in phase",
            },
        ],
        "firing": "",
    }
