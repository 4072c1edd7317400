"""Which engine a file means: usual numberings, tier by tier, on engines whose makers are known."""

import re
from typing import Any

import numpy as np
import pytest
from support.cases import cases
from support.engines import engine, list_problems, refused

from balcli.engine.engine import Engine
from balcli.engine.load import load
from balcli.errors import InputError
from balcli.file.assumed import Assumed

# Pistons alone: F = 1 kg x 40 mm x (3000 rpm)^2, throws a = 0.1 m apart.
FORCE = 0.04 * (100 * np.pi) ** 2
UNIT = FORCE * 0.1
BASE = {
    "crank": {"stroke": 80, "spacing": 100},
    "rod": {"ratio": 0.3},
    "piston": {"mass": 1},
    "operation": {"speed": 3000},
}


def tables(order: str, bank_angle: float | None = 90, **more: Any) -> dict[str, Any]:
    """The tables of a maker's engine; `more` are keys of [crank] and [layout]."""
    crank = {key: more.pop(key) for key in ("splay", "throws") if key in more}
    layout = {"firing_order": [int(n) for n in order.split("-")], **more}
    if bank_angle is not None:
        layout["bank_angle"] = bank_angle
    return BASE | {"crank": BASE["crank"] | crank, "layout": layout}


def find_throws(engine: Engine) -> list[float]:
    """Angles of the throws after the first one, deg."""
    rows = zip(engine.weighed, engine.pins_deg.values(), strict=True)
    pins = {w.throw: float(pin) for w, pin in reversed(list(rows))}
    return [round(pins[t] - pins[0], 3) % 360 for t in sorted(pins)]


def read_refusal(*order_and_angle: Any, **keys: Any) -> str:
    """The first mistake of an engine."""
    return list_problems(tables(*order_and_angle, **keys))[0]


def read_lines(*order_and_angle: Any, **keys: Any) -> list[str]:
    """The lines of the list in it, and its last line."""
    return read_refusal(*order_and_angle, **keys).split("\n    ")[1:]


def find_moment(engine: Engine) -> float:
    """Largest moment of order 1, in F a."""
    from balcli.forces.spectrum import compute_spectra

    return float(compute_spectra(engine, [1.0], ["moment"])["moment"].major[0]) / UNIT


ALTERNATING = {"rods": "alternating"}


@cases("engine/numbering", "the_only_engine_of_the_first_tier_is_used")
def test_the_only_engine_of_the_first_tier_is_used(order, angle, keys, numbering, throws, moment):
    if isinstance(keys, list):
        keys = {"firing_intervals": keys * (len(order.split("-")) // 2)}
    engine = load(tables(order, angle, **keys))
    assert engine.model is not None
    assert [list(row) for row in engine.model.layout.numbering or ()] == numbering
    assert find_throws(engine) == throws
    assert find_moment(engine) == pytest.approx(moment, abs=5e-4)
    noted = any("layout.numbering" in doubt for doubt in engine.doubts)
    assert noted == (numbering != [sorted(row) for row in sorted(numbering)] or numbering[0][1] == 3)
    assert Assumed("layout.numbering", tuple(map(tuple, numbering))) in engine.inferred
    assert "numbering" not in engine.to_dict()["layout"]


@cases("engine/numbering", "several_engines_are_listed_the_better_balanced_first")
def test_several_engines_are_listed_the_better_balanced_first(order, angle, numbering, throws, moment):
    first, second, last = read_lines(order=order, bank_angle=angle, **ALTERNATING)
    assert first.startswith(f"layout.numbering = {numbering}: throws {throws};")
    assert second.startswith("layout.numbering = ")
    told = re.search(r"moment (\S+) and", first)
    assert told is not None
    assert float(told[1]) == pytest.approx(moment * UNIT, rel=2e-3)
    assert "flywheel end" in last


def test_what_a_line_of_the_list_says():
    """A boxer whose throws have no known distance."""
    parts = tables("1-3-2-4", 180, **ALTERNATING)
    del parts["crank"]["spacing"]
    assert list_problems(parts)[0].split("\n    ")[1] == (
        "layout.numbering = [[1, 3], [2, 4]]: throws 0, 180, 180, 0; cylinder 1 on the left bank seen "
        "from the free end, throw 1; orders 1 and 2: force 0 and 0 N, moment not known"
    )


def test_a_numbering_in_the_file_is_not_doubted():
    named = tables("1-3-2-4", 180, numbering=[[1, 2], [3, 4]], **ALTERNATING)
    engine = load(named)
    assert find_throws(engine) == [0, 0, 0, 0]
    assert engine.to_dict()["layout"]["numbering"] == [[1, 2], [3, 4]]
    assert any("nobody builds" in doubt for doubt in engine.doubts)
    assert "layout.numbering" not in [value.path for value in engine.inferred]


@cases("engine/numbering", "where_nothing_fits_intervals_of_shared_pins_come_before_split_pins")
def test_where_nothing_fits_intervals_of_shared_pins_come_before_split_pins(order, angle, first):
    lines = read_lines(order=order, bank_angle=angle)
    assert len(lines) <= 4
    for line, beginning in zip(lines, first, strict=False):
        assert line.startswith(f"layout.numbering = {beginning}")


def test_a_splay_in_the_file_is_not_contradicted():
    """20 deg of splay fits no numbering of a 60-degree six."""
    told = read_refusal("1-2-3-4-5-6", 60, splay=20)
    assert "layout.numbering" in told
    assert "crank.splay = " not in told


def test_given_throws_decide_between_the_numberings():
    """A small block with its throws: bank by bank does not fit, and is not guessed."""
    lines = read_lines("1-8-4-3-6-5-7-2", 90, throws=[0, 90, 270, 180])
    assert [line.partition(":")[0] for line in lines[:-1]] == ["layout.numbering = [[2, 4, 6, 8], [1, 3, 5, 7]]"]


@pytest.mark.parametrize("varied", [{"operation.speed": 4000.0}, {"crank.splay": 60.0}])
def test_a_variant_is_no_more_guessed_than_its_file(varied):
    """The boxer may be two engines, of which one has all its throws at 0; the six needs a splay."""
    from balcli.engine.build import build
    from balcli.engine.parse import parse_dict

    boxer = tables("1-3-2-4", 180, **ALTERNATING)
    for parts in [boxer] if "operation.speed" in varied else [tables("1-2-3-4-5-6", 60)]:
        for figures in (varied, {key: np.array([value, value]) for key, value in varied.items()}):
            with pytest.raises(InputError, match=r"layout\.numbering"):
                build(parse_dict(parts), figures, rank=np.ndim(next(iter(figures.values()))))


def test_places_along_the_crank_do_not_say_which_number_stands_where():
    places = {str(n): {"position": x} for n, x in zip(range(1, 5), (-165, -50, 60, 175), strict=True)}
    assert "[[1, 3], [2, 4]]" in list_problems(tables("1-3-2-4", 180, **ALTERNATING) | {"cylinder": places})[0]


def test_a_second_and_a_third_tier_is_never_taken_unasked():
    """A V6 with its second bank counted from the flywheel end."""
    order = "1-4-3-6-2-5".translate(str.maketrans({"4": "6", "6": "4"}))
    lines = read_lines(order=order, bank_angle=90, splay=-30)
    assert any("[[1, 2, 3], [6, 5, 4]]" in line for line in lines)


@cases("engine/numbering", "what_would_make_a_given_numbering_fit")
def test_what_would_make_a_given_numbering_fit(crank, layout, hint):
    """Names before physics: no other splay, no other throws where another numbering fits."""
    assert refused(crank=crank, layout=layout).partition("It fits with ")[2] == hint


def test_a_radial_is_counted_with_or_against_the_rotation():
    """One throw is at 0. A rotary's cylinders come to the top against the sense of their numbers."""
    radial = {"crank": {}, "layout": {"radial": 5, "firing_order": [1, 3, 5, 2, 4]}}
    assert load(BASE | {"layout": radial["layout"]}).doubts == ()
    told = refused(crank={"throws": [0]}, layout=radial["layout"] | {"rotary": True})
    assert "layout.numbering = [[1], [5], [4], [3], [2]]" in told


@cases("engine/numbering", "a_crank_that_nobody_builds_is_doubted_in_one_line")
def test_a_crank_that_nobody_builds_is_doubted_in_one_line(order, doubted):
    doubts = load(tables(order, None)).doubts
    assert len(doubts) == doubted
    assert not doubted or "usual is 1-" in doubts[0]


def test_a_long_wait_is_doubted():
    doubts = load(tables("1-2-3", None, throws=[0, 240, 120])).doubts
    assert len(doubts) == 1
    assert "the intervals 120, 120, 480 deg" in doubts[0]
    said = tables("1-2-3", None, throws=[0, 240, 120], firing_intervals=[120, 120, 480])
    assert load(said).doubts == ()


def test_articulated_rods_fire_at_their_true_dead_centres():
    layout = {"radial": 3, "strokes": 2, "firing_order": [1, 2, 3]}
    parts = {"crank": {"stroke": 120}, "rod": {"length": 240}, "piston": {"mass": 1.3}}
    parts |= {"articulation": {"knuckle_radius": 70, "rod": {"length": 170}}, "layout": layout}
    assert [*engine(**parts).fires_deg.values()] == pytest.approx([0, 125.4068, 234.5932], abs=1e-4)
    engine(**parts | {"layout": layout | {"firing_intervals": [125.4068, 109.1864, 125.4068]}})
    assert refused(**parts | {"layout": layout | {"firing_intervals": [130, 100, 130]}})


@pytest.mark.parametrize(
    ("stroke", "bore", "speed", "keys", "doubted"),
    [
        *((1001, 500, 900, {}, True), (999, 500, 900, {}, False), (700, 340, 249, {}, True)),
        *((700, 340, 251, {}, False), (700, 360, 249, {}, False), (3260, 900, 78, {"strokes": 2}, False)),
    ],
)
def test_strokes_left_out_of_a_crosshead_engine_are_doubted(stroke, bore, speed, keys, doubted):
    piston, operation = {"mass": 2e-6 * bore**3, "bore": bore}, {"speed": speed}
    parts = {"crank": {"stroke": stroke}, "rod": {"ratio": 0.3}, "piston": piston, "operation": operation}
    found = engine(**parts, layout={"firing_order": [1, 2, 3], **keys}).unlikely
    assert any("layout.strokes" in doubt for doubt in found) == doubted


def test_a_turn_between_firings_that_the_crank_leaves_open_is_assumed():
    """A vee twin on one pin fires 45 or 405 deg after its first cylinder."""
    twin = {
        "crank": {"stroke": 90},
        "rod": {"length": 150},
        "piston": {"mass": 0.5, "bore": 90},
        "layout": {"bank_angle": 45, "firing_order": [1, 2]},
    }
    gas = {"gas": {"cycle": "otto", "compression_ratio": 9, "imep": 9}}
    assert Assumed("layout.firing_intervals", (405.0, 315.0), "deg") in load(twin | gas).inferred
    assert "layout.firing_intervals" not in [value.path for value in load(twin).inferred]
