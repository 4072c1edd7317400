"""Which engine a file means: usual numberings, tier by tier, on engines whose makers are known."""

import pickle
import re
import tomllib
from itertools import pairwise, permutations
from typing import Any

import numpy as np
import pytest
import tomli_w
from oracle import momentum
from support.cases import cases
from support.engines import engine, list_problems, refused
from support.paths import ROOT

from balcli import load
from balcli.engine.engine import Engine
from balcli.engine.firing import common_pins
from balcli.engine.firing.common_pins import list_evenly_spaced
from balcli.engine.firing.usual import list_tiers
from balcli.engine.parse import parse_dict
from balcli.engine.parts import Parts
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


def tables(order: str | list[str], bank_angle: float | None = 90, **more: Any) -> dict[str, Any]:
    """The tables of a maker's engine; `more` are keys of [crank] and [layout]."""
    crank = {key: more.pop(key) for key in ("splay", "throws") if key in more}
    layout = {"firing_order": order, **more}
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
    noted = "layout.numbering" in [doubt.path for doubt in engine.doubts]
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
    assert any("nobody builds" in doubt.message for doubt in engine.doubts)
    assert "layout.numbering" not in [value.path for value in engine.inferred]


@cases("engine/numbering", "where_nothing_fits_intervals_of_shared_pins_come_before_split_pins")
def test_where_nothing_fits_intervals_of_shared_pins_come_before_split_pins(order, angle, first):
    lines = read_lines(order=order, bank_angle=angle)
    assert len(lines) <= 4
    for line, beginning in zip(lines, first, strict=False):
        assert line.startswith(f"layout.numbering = {beginning}")


TWIN = {"crank": {"stroke": 62}, "layout": {"bank_angle": 52, "firing_order": [1, 2]}}


@pytest.mark.parametrize(("intervals", "splay"), [((488, 232), -76), ((360, 360), 52 - 360)])
def test_a_forgotten_splay_is_the_likeliest_mistake(intervals, splay):
    """A vee twin with offset pins: the usual numbering fits with the splay, so the splay is missing."""
    layout = TWIN["layout"] | {"firing_intervals": [*intervals]}
    told = refused(crank=TWIN["crank"], layout=layout).split("\n    ")
    assert told[0].endswith("crank.splay: is missing, and without it 1-2 fits no usual numbering; it may mean:")
    first = re.match(r"layout\.numbering = \[\[1\], \[2\]\], crank\.splay = (-?\d+): throws 0;", told[1])
    assert first is not None
    assert (int(first[1]) - splay) % 360 == 0
    assert "e+" not in told[1]


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
    assert not doubted or "usual is 1-" in doubts[0].message


BY_BANK = [[1, 2, 3], [4, 5, 6]]
ODD = [[1, 3, 5], [2, 4, 6]]


@pytest.mark.parametrize(
    ("order", "numbering", "doubted"),
    [
        *(
            ("1-4-3-2", [[1, 2], [3, 4]], False),
            ("1-3-2-4", [[1, 3], [2, 4]], False),
            ("1-3-2-4", [[1, 2], [3, 4]], True),
        ),
        *(("1-6-2-4-3-5", BY_BANK, False), ("1-6-3-2-5-4", ODD, False), ("1-4-5-2-3-6", ODD, False)),
        ("1-4-5-2-3-6", BY_BANK, True),
    ],
)
def test_in_a_boxer_pins_of_neighbours_are_opposite(order, numbering, doubted):
    doubts = load(tables(order, 180, numbering=numbering, **ALTERNATING)).doubts
    assert any("nobody builds" in doubt.message for doubt in doubts) == doubted


def test_a_flat_engine_with_common_pins_may_have_any_crank():
    """A twelve has the crank of an in-line six."""
    assert load(tables("1-9-5-12-3-8-6-10-2-7-4-11", 180)).doubts == ()


@pytest.mark.parametrize(
    ("angle", "doubted"), [(180, True), (179.1, True), (180.9, True), (178.9, False), (181.1, False)]
)
def test_a_flat_engine_is_flat_within_a_degree(angle, doubted):
    doubts = load(tables("1-3-2-4", angle, numbering=[[1, 2], [3, 4]], **ALTERNATING)).doubts
    assert any("nobody builds" in doubt.message for doubt in doubts) == doubted


def test_a_long_wait_is_doubted():
    doubts = load(tables("1-2-3", None, throws=[0, 240, 120])).doubts
    assert len(doubts) == 1
    assert str(doubts[0]).startswith("layout.firing_order: 1-2-3 has the intervals 120, 120, 480 deg")
    said = tables("1-2-3", None, throws=[0, 240, 120], firing_intervals=[120, 120, 480])
    assert load(said).doubts == ()


@pytest.mark.parametrize(
    ("throws", "doubted"),
    [([0, 180, 180], False), ([0, 180, 178.5], True), ([0, 180, 181.5], False), ([0, 240, 120], True)],
)
def test_a_wait_of_a_turn_is_not_long(throws, doubted):
    """Intervals of 180, 360 and 180 deg; 361.5 deg is above a turn by more than the degree that is forgiven."""
    assert len(load(tables("1-2-3", None, throws=throws)).doubts) == doubted


@pytest.mark.parametrize("throw", [90, 270])
def test_one_of_two_cylinders_always_waits_for_a_turn_or_more(throw):
    assert load(tables("1-2", None, throws=[0, throw])).doubts == ()


@pytest.mark.parametrize(("strokes", "doubted"), [(4, True), (2, False)])
def test_only_of_a_four_stroke_is_a_crank_unusual(strokes, doubted):
    assert len(load(tables("1-2-3-4", None, strokes=strokes)).doubts) == doubted


@pytest.mark.parametrize(("splay", "spacing", "doubted"), [(54, 100, True), (53, 100, False), (60, None, False)])
def test_a_splay_is_doubted_if_its_opposite_leaves_a_small_part(splay, spacing, doubted):
    """Six pins of a 60-degree six at a splay s leave sqrt(3)/2 sin((60 + s)/2) of moment against the crank, as a share of
    one cylinder's force times the length: 4.53 % with -54 deg and 5.29 % with -53 deg. Unknown places make no moment.
    """
    crank = {"throws": [0, 240, 120], "splay": splay} | ({"spacing": spacing} if spacing else {})
    doubts = engine(crank=crank, layout={"bank_angle": 60}).doubts
    assert any(str(doubt).startswith("crank.splay") for doubt in doubts) == doubted
    if doubted:
        assert "72.6 % of one cylinder's first order, and 4.53 % with -54 deg" in doubts[0].message


@pytest.mark.parametrize(("angle", "fits"), [(88, False), (92, True)])
def test_half_of_the_even_interval_is_the_least_of_another_numbering(angle, fits):
    """With both pins at 0 deg, cylinder 2 would fire a bank angle after cylinder 1."""
    told = read_refusal("1-2-3-4", angle, throws=[0, 0])
    assert ("the file may mean this engine" in told) == fits


def test_with_gas_a_turn_tells_two_engines_apart():
    """Numbered along the crank, cylinders 2 and 3 of this boxer change places, which are a turn apart. Without gas, the
    throws alone count. Of equally balanced engines with one rod on each throw, the one numbered along the crank comes
    first.
    """
    boxer = tables("1-2-4-3", 180, **ALTERNATING)
    assert [list(row) for row in load(boxer).model.layout.numbering] == [[1, 2], [3, 4]]
    burning = {"gas": {"cycle": "otto", "compression_ratio": 9, "imep": 9}, "piston": {"mass": 1, "bore": 80}}
    first, second = list_problems(boxer | burning)[0].split("\n    ")[1:-1]
    assert first.startswith("layout.numbering = [[1, 3], [2, 4]]: throws 0, 0, 180, 180;")
    assert second.startswith("layout.numbering = [[1, 2], [3, 4]]: throws 0, 0, 180, 180;")


@cases("engine/numbering", "usual_numberings")
def test_usual_numberings_of_each_kind_of_engine(layout, throws, tiers):
    crank = {"crank": BASE["crank"] | {"throws": throws}}
    plan = Parts(parse_dict(BASE | crank | {"layout": layout})).plan
    found = [[[list(row) for row in rows] for rows in tier] for tier in list_tiers(plan, radial="radial" in layout)]
    assert found[: len(tiers)] == tiers


def test_articulated_rods_fire_at_their_true_dead_centres():
    layout = {"radial": 3, "strokes": 2, "firing_order": [1, 2, 3]}
    parts = {"crank": {"stroke": 120}, "rod": {"length": 240}, "piston": {"mass": 1.3}}
    parts |= {"articulation": {"knuckle_radius": 70, "rod": {"length": 170}}, "layout": layout}
    assert [*engine(**parts).fires_deg.values()] == pytest.approx([0, 125.4068, 234.5932], abs=1e-4)
    engine(**parts | {"layout": layout | {"firing_intervals": [125.4068, 109.1864, 125.4068]}})
    engine(**parts | {"layout": layout | {"firing_intervals": [120, 120, 120]}})  # nominal dead centres
    assert refused(**parts | {"layout": layout | {"firing_intervals": [130, 100, 130]}})


@pytest.mark.parametrize(
    ("stroke", "bore", "speed", "keys", "doubted"),
    [
        *((1001, 500, 900, {}, True), (999, 500, 900, {}, False), (700, 340, 249, {}, True)),
        *((700, 340, 251, {}, False), (700, 360, 249, {}, False), (3260, 900, 78, {"strokes": 2}, False)),
    ],
)
def test_strokes_left_out_of_a_crosshead_engine_are_doubted(stroke, bore, speed, keys, doubted):
    piston = {"mass": 2e-6 * bore**3, "bore": bore}
    operation = {"speed": speed}
    parts = {"crank": {"stroke": stroke}, "rod": {"ratio": 0.3}, "piston": piston, "operation": operation}
    found = engine(**parts, layout={"firing_order": [1, 2, 3], **keys}).unlikely
    assert ("layout.strokes" in [doubt.path for doubt in found]) == doubted


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


# ------------------------------------------------------------------ cylinders that fire together
FLAT_TWO_STROKE = {"banks": [-90, 90], "rods": "alternating", "strokes": 2}


def read_flat(order: str, layout: dict[str, Any]) -> list[str]:
    """The lines of the list for a flat two-stroke, without the last one."""
    return read_lines(order, None, **FLAT_TWO_STROKE | layout)[:-1]


@cases("engine/numbering", "a_flat_two_stroke_may_fire_evenly_or_in_pairs")
def test_a_flat_two_stroke_may_fire_evenly_or_in_pairs(order, layout, lines):
    found = read_flat(order, layout)
    assert len(found) == len(lines)
    for line, beginning in zip(found, lines, strict=True):
        assert line.startswith(beginning)


@cases("engine/numbering", "no_flat_two_stroke_is_asked_about_pairs")
def test_no_flat_two_stroke_is_asked_about_pairs(order, crank, layout):
    assert load(tables(order, None, **crank, **FLAT_TWO_STROKE | layout)).fires_deg


def test_a_free_layout_may_fire_in_pairs_as_well():
    twin = tables("1-2", None, strokes=2) | {"cylinder": {"1": {"bank": -90}, "2": {"bank": 90}}}
    mistake = list_problems(twin)[0]
    assert "one of 2 engines:\n    layout.firing_intervals = [0, 360]: throws 0, 180; cylinder 1 on throw 1;" in mistake


@cases("engine/numbering", "cylinders_that_fire_together_on_a_given_crank")
def test_cylinders_that_fire_together_on_a_given_crank(order, throws, banks, intervals, words):
    layout = {"banks": banks, "strokes": 2} | ({"rods": "alternating"} if len(banks) > 1 else {})
    engine = load(tables(order, None, throws=throws, **layout))
    starts = [sum(intervals[:k]) for k in range(len(intervals))]
    assert list(engine.fires_deg.values()) == pytest.approx(starts)
    assert Assumed("layout.firing_intervals", tuple(intervals), "deg") in (engine.list_assumed() or ())
    assert any(str(doubt).startswith(f"layout.firing_order: {words}") for doubt in engine.doubts)
    given = tables(order, None, throws=throws, **layout, firing_intervals=intervals)
    assert not load(given).doubts


def test_a_four_stroke_is_proposed_to_fire_together_and_no_crank():
    """All dead centres of this flat three are at one angle: one large piston against two small ones."""
    three = tables("1-3-2", None, throws=[0, 180, 0]) | {
        "cylinder": {"1": {"bank": -90}, "3": {"bank": -90}, "2": {"bank": 90}}
    }
    hint = list_problems(three)[0].partition("If cylinders fire together, it fits with ")[2]
    lists = ["[0, 360, 360]", "[360, 0, 360]", "[360, 360, 0]"]
    assert hint == " or with ".join(f"layout.firing_intervals = {each}" for each in lists)


def test_few_cylinders_fire_together_before_many_do():
    """All four pistons are up at once. The last firing and the first are neighbours: [0, 360, 360, 0] has two together."""
    told = list_problems(tables("1-2-3-4", None, throws=[0, 0, 0, 0]))[0]
    hint = told.partition("If cylinders fire together, it fits with ")[2]
    lists = ["[0, 360, 0, 360]", "[0, 0, 360, 360]", "[0, 360, 360, 0]"]
    assert hint == " or with ".join(f"layout.firing_intervals = {each}" for each in lists)


def test_a_numbering_along_the_crank_may_fire_together_as_well():
    """Bank by bank, 1 and 2 would be at their dead centres a turn apart, and 3 and 4, too."""
    boxer = tables("1-2-3-4", 180, throws=[0, 180, 0, 180], rods="alternating")
    assert (
        "If cylinders fire together, it fits with layout.firing_intervals = [0, 360, 0, 360] or with"
        in list_problems(boxer)[0]
    )


# ------------------------------------------------------------------ common pins
@cases("engine/numbering", "common_pins_that_fire_unevenly")
def test_common_pins_that_fire_unevenly(order, angle, strokes, first):
    lines = read_lines(order, angle, strokes=strokes)
    assert lines[0].startswith(first)
    assert "crank.splay" not in lines[0]
    assert "crank.splay" in lines[1]


@pytest.mark.parametrize(
    ("order", "numbering", "hint"),
    [
        (
            "1-2-7-3-4-5-6-8",
            [[1, 3, 5, 7], [2, 4, 6, 8]],
            "layout.firing_intervals = [60, 120, 90, 60, 120, 60, 90, 120] or with crank.splay = -30",
        ),
        (
            "1-2-3-4-5-6",
            [[1, 3, 5], [2, 4, 6]],
            "layout.firing_intervals = [60, 180, 60, 180, 60, 180] or with crank.splay = -60",
        ),
    ],
)
def test_common_pins_are_a_hint_where_the_numbering_is_given(order, numbering, hint):
    assert read_refusal(order, 60, numbering=numbering).partition("It fits with ")[2] == hint


def test_pins_that_are_not_evenly_spaced_are_named_where_the_numbering_is_given():
    told = read_refusal(
        "1-12-7-4-3-10-9-5-2-11-8-6", 45, strokes=2, numbering=[[1, 2, 3, 4, 5, 6], [7, 8, 9, 10, 11, 12]]
    )
    assert told.endswith(
        "It fits with the layout.firing_intervals of common pins (the two cylinders of a pin fire 45 deg apart) or with crank.splay = -15"
    )


def find_intervals_of(pins: list[float], order: list[int], angle: float) -> tuple[float, ...] | None:
    """Intervals of a four-stroke vee on these pins, numbered bank by bank, if its dead centres come in the firing
    order within one cycle, and none is under half the even one.
    """
    count = len(pins)
    ready = {n: (angle * (n > count) - pins[(n - 1) % count]) % 360 for n in order}
    found = [round((ready[b] - ready[a]) % 360, 6) or 360.0 for a, b in pairwise([*order, order[0]])]
    return tuple(found) if abs(sum(found) - 720) < 1 and min(found) >= 180 / count - 1e-3 else None


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_every_evenly_spaced_crank_is_tried(count):
    """Against all arrangements of the pins, one by one; the orders are those of such cranks."""
    random = np.random.default_rng(count)
    fitting = 0
    angles = [[360 / count * k for k in range(count)]]
    angles += [] if count % 2 else [[720 / count * (k // 2) for k in range(count)]]
    cranks = [list(pins) for each in angles for pins in permutations(each) if pins[0] == 0]
    numbering = [[*range(1, count + 1)], [*range(count + 1, 2 * count + 1)]]
    for _ in range(60):
        angle = float(random.choice([45, 60, 72, 90]))
        pins = cranks[random.integers(len(cranks))]
        times = [(angle * bank - pin) % 360 + 360 * random.integers(2) for bank in (0, 1) for pin in pins]
        order = [n + 1 for n in np.argsort(times).tolist()]
        order = [*order[order.index(1) :], *order[: order.index(1)]]
        wanted = {found for pins in cranks if (found := find_intervals_of(pins, order, angle))}
        fitting += bool(wanted)
        parts = Parts(parse_dict(tables("-".join(map(str, order)), angle, numbering=numbering)))
        assert set(list_evenly_spaced(parts)) == wanted, (order, angle)
    assert fitting > 3


@pytest.mark.parametrize(("most", "found"), [(3, True), (2, False)])
def test_cranks_of_many_pins_are_not_searched(monkeypatch, most, found):
    """The three pins of a six, whose intervals do not alternate."""
    monkeypatch.setattr(common_pins, "MOST_PINS", most)
    intervals = (120, 120, 180, 120, 120, 60)
    layout = {"bank_angle": 60, "firing_order": [1, 2, 3, 4, 5, 6], "numbering": [[1, 2, 3], [4, 5, 6]]}
    parts = Parts(parse_dict(BASE | {"layout": layout}))
    assert (intervals in common_pins.list_common_pin_intervals(parts)) == found


def test_a_two_stroke_has_no_pairs_of_pins():
    """Pins at 0, 0, 180, 180 would give the dead centres in this order, and fire four cylinders within half a turn."""
    parts = Parts(parse_dict(tables("1-2-5-6-3-4-7-8", 90, strokes=2, numbering=[[1, 2, 3, 4], [5, 6, 7, 8]])))
    assert list(list_evenly_spaced(parts)) == []


# ------------------------------------------------------------------ names with letters
@cases("engine/numbering", "letters_name_the_banks")
def test_letters_name_the_banks(order, keys, numbers, throws, words):
    engine = load(tables(order, **{"bank_angle": None} | keys))
    assert engine.model is not None
    assert list(engine.model.layout.firing_order or ()) == numbers
    assert find_throws(engine) == throws
    assert Assumed("layout.firing_order", words) in engine.inferred
    assert "layout.numbering" in [value.path for value in engine.inferred]
    assert not any("numbering" in doubt.path for doubt in engine.doubts)


@cases("engine/numbering", "letters_that_do_not_name_the_banks")
def test_letters_that_do_not_name_the_banks(order, layout, words):
    mistakes = list_problems(tables(order, **{"bank_angle": None} | layout))
    assert len(mistakes) == 1
    assert words in mistakes[0]


def test_letters_that_fit_either_way_are_listed_in_numbers():
    """One rod on each throw: every order has a crank."""
    lines = read_lines("1L-1R-2L-2R-3L-3R", 180, **ALTERNATING)
    numbering = "layout.numbering = [[1, 2, 3], [4, 5, 6]]"
    assert lines[0].startswith(f"layout.firing_order = [1, 4, 2, 5, 3, 6], {numbering}: throws 0, 60, 120, 180,")
    assert "cylinder 1 (1L) on the left bank" in lines[0]
    assert lines[1].startswith(
        f"layout.firing_order = [4, 1, 5, 2, 6, 3], {numbering}: throws 0, 300, 120, 60, 240, 180;"
    )
    assert "cylinder 1 (1R) on the left bank" in lines[1]


def test_letters_stay_in_the_file_and_are_read_again():
    order = "1R-6L-5R-2L-3R-4L-6R-1L-2R-5L-4R-3L"
    engine = load(tables([name.lower() for name in order.split("-")], 60))
    assert engine.to_dict()["layout"] == {"firing_order": order.lower(), "bank_angle": 60}
    assert engine.vary({"operation.speed": 2000}).inferred == engine.inferred
    numbered = engine.vary({"layout.firing_order": [*engine.model.layout.firing_order]})  # type: ignore[union-attr]
    assert "layout.firing_order" not in [value.path for value in numbered.inferred]
    copied = pickle.loads(pickle.dumps(engine.model))
    assert copied.layout.firing_order.letters == ("R", "L")


# ------------------------------------------------------------------ the lines of a list
def list_engines_to_choose_from() -> list[dict[str, Any]]:
    """The tables of each engine above that has a list."""
    content = tomllib.loads((ROOT / "tests/cases/engine/numbering.toml").read_text(encoding="utf-8"))
    several = content["several_engines_are_listed_the_better_balanced_first"]["rows"]
    split = content["where_nothing_fits_intervals_of_shared_pins_come_before_split_pins"]["rows"]
    flat = content["a_flat_two_stroke_may_fire_evenly_or_in_pairs"]["rows"]
    common = content["common_pins_that_fire_unevenly"]["rows"]
    return [
        *(tables(order, angle, **ALTERNATING) for order, angle, *_ in several),
        *(tables(order, angle) for order, angle, _ in split),
        *(tables(order, None, **FLAT_TWO_STROKE | layout) for order, layout, _ in flat),
        *(tables(order, angle, strokes=strokes) for order, angle, strokes, _ in common),
        tables("1L-1R-2L-2R-3L-3R", 180, **ALTERNATING),
    ]


def paste(of_engine: dict[str, Any], line: str) -> dict[str, Any]:
    """The tables with the keys of a line."""
    keys = re.sub(r", (layout|crank)\.", r"\n\1.", line.partition(": throws")[0])
    pasted = tomllib.loads(keys)
    return of_engine | {name: of_engine[name] | pasted.get(name, {}) for name in ("crank", "layout")}


def write_numbers(layout: dict[str, Any], line: str) -> list[int]:
    """The firing order in numbers; cylinder 1 is on the first bank, and the line has its letter."""
    order = layout["firing_order"]
    if not isinstance(order, str):
        return order
    names = order.split("-")
    if order.replace("-", "").isdecimal():
        return [int(name) for name in names]
    first = re.search(r"cylinder 1 \((\w+)\)", line)
    assert first is not None
    letter = first[1].strip("0123456789")
    number = {name: int(name.strip("ABLR")) for name in names}
    return [number[name] + (letter not in name) * len(names) // 2 for name in names]


@pytest.mark.parametrize("of_engine", list_engines_to_choose_from(), ids=lambda of: str(of["layout"]["firing_order"]))
def test_a_pasted_line_is_the_engine_that_it_describes(of_engine):
    """Forces and moments of orders 1 and 2 from the momentum of every part."""
    for line in list_problems(of_engine)[0].split("\n    ")[1:-1]:
        if not line.startswith("common pins"):
            check_pasted(paste(of_engine, line), line)


def check_pasted(pasted: dict[str, Any], line: str) -> None:
    """The engine has the throws, forces and moments that the line shows."""
    throws = re.search(r": throws ([^;]*);", line)
    assert throws is not None
    assert find_throws(load(pasted)) == pytest.approx([float(angle) for angle in throws[1].split(", ")], abs=1e-3)
    layout = pasted["layout"] | {"firing_order": write_numbers(pasted["layout"], line)}
    curves = momentum.Engine.read(tomli_w.dumps(pasted | {"layout": layout})).curves()
    for kind in ("force", "moment"):
        shown = re.search(rf"{kind} (\S+) and (\S+) N", line)
        assert shown is not None
        for order in (1, 2):
            right = sum(map(abs, curves.order(kind, order)))
            assert float(shown[order]) == pytest.approx(right, rel=6e-4, abs=1e-6 * UNIT)
