"""Firing order <-> crank throws, on engines whose answer is known."""

from __future__ import annotations

import math

import pytest
from support.engines import engine, refused

from balcli.engine.firing import check_firing, find_dead_centres, find_intervals
from balcli.errors import InputError

TIGHT = 1e-9  # deg


def pins(**parts):
    """Crank pins by cylinder number, deg in [0, 360)."""
    return {n: round(float(a) % 360, 9) % 360 for n, a in sorted(engine(**parts).pins_deg.items())}


def fires(**parts):
    return {n: float(a) for n, a in engine(**parts).fires_deg.items()}


# ------------------------------------------------------------------ order -> throws
@pytest.mark.parametrize(
    ("layout", "wanted"),
    [
        ({"firing_order": [1, 3, 2]}, {1: 0, 2: 240, 3: 120}),
        ({"firing_order": [1, 2, 3], "strokes": 2}, {1: 0, 2: 240, 3: 120}),
        ({"firing_order": [1, 3, 4, 2]}, {1: 0, 2: 180, 3: 180, 4: 0}),
        ({"firing_order": [1, 2, 4, 5, 3]}, {1: 0, 2: 216, 3: 144, 4: 72, 5: 288}),
        ({"firing_order": [1, 5, 3, 6, 2, 4]}, {1: 0, 2: 240, 3: 120, 4: 120, 5: 240, 6: 0}),
        ({"firing_order": [1, 2], "firing_intervals": [360, 360]}, {1: 0, 2: 0}),
        ({"firing_order": [1, 2], "firing_intervals": [270, 450]}, {1: 0, 2: 90}),
        ({"firing_order": [2, 1], "firing_intervals": [540, 180]}, {1: 0, 2: 180}),
        ({"firing_order": [1, 2], "firing_intervals": [405, 315], "bank_angle": 45}, {1: 0, 2: 0}),
        ({"firing_order": [1, 2], "firing_intervals": [270, 450], "banks": [45, -45]}, {1: 0, 2: 0}),
        ({"firing_order": [1, 3, 5, 2, 4], "radial": 5}, {1: 0, 2: 0, 3: 0, 4: 0, 5: 0}),
        (
            {"firing_order": [1, 8, 4, 3, 6, 5, 7, 2], "banks": [45, -45], "numbering": [[1, 3, 5, 7], [2, 4, 6, 8]]},
            {1: 0, 2: 0, 3: 90, 4: 90, 5: 270, 6: 270, 7: 180, 8: 180},
        ),
    ],
)
def test_throws_follow_from_the_firing_order(layout, wanted):
    """Pins of in-line engines are minus the firing angle; the rest are the shared pins of real
    engines.
    """
    assert pins(layout=layout) == wanted


def test_the_first_bank_fires_405_and_315_degrees_apart_in_a_45_degree_v_twin():
    """The pin reaches the second bank 45 degrees after the first, and fires it one turn later."""
    assert fires(crank={"throws": [0]}, layout={"firing_order": [1, 2], "bank_angle": 45}) == {1: 0, 2: 405}


def test_vr6_pins_of_neighbours_are_split_by_the_offset_of_the_banks():
    """a_2 = g_2 - g_1 + tau_2 - tau_1 - f_2, sin tau = e/(r + l): 15 degrees of bank and twice tau
    of the offset.
    """
    e = engine(
        crank={"stroke": 90, "spacing": 65},
        rod={"length": 164},
        piston={"mass": 1, "offset": -12.5},
        layout={
            "banks": [-7.5, 7.5],
            "rods": "alternating",
            "firing_order": [1, 5, 3, 6, 2, 4],
            "numbering": [[1, 3, 5], [2, 4, 6]],
        },
        cylinder={str(n): {"piston_offset": 12.5} for n in (2, 4, 6)},
    )
    tau = math.degrees(math.asin(12.5 / (45 + 164)))
    wanted = {1: 0, 5: -120, 3: -240, 6: 15 + 2 * tau - 360, 2: 15 + 2 * tau - 480, 4: 15 + 2 * tau - 600}
    for n, pin in e.pins_deg.items():
        assert abs((float(pin) - wanted[n] + 180) % 360 - 180) < TIGHT, n
    assert fires(crank={"throws": [0]}, piston={"offset": 3, "mass": 1}, layout={"firing_order": [1]}) == {1: 0}


V6 = {"bank_angle": 90, "firing_order": [1, 4, 2, 5, 3, 6]}


def test_common_pins_of_a_90_degree_v6_fire_unevenly():
    assert list(fires(crank={"throws": [0, 120, 240]}, layout=V6).values()) == [0, 90, 240, 330, 480, 570]


def test_pins_split_by_30_degrees_fire_evenly():
    """The second bank's pins lag by 30 degrees, so that it fires 90 + 30 after the first."""
    even = engine(crank={"throws": [0, 120, 240], "splay": -30}, layout=V6)
    assert list(even.fires_deg.values()) == [0, 120, 240, 360, 480, 600]
    assert {n: float(pin) for n, pin in even.pins_deg.items()} == {1: 0, 2: 120, 3: 240, 4: -30, 5: 90, 6: 210}


def test_throws_that_follow_from_the_order_respect_the_splay():
    assert pins(crank={"splay": -30}, layout=V6) == {1: 0, 2: 120, 3: 240, 4: 330, 5: 90, 6: 210}


# ------------------------------------------------------------------ throws and order -> intervals
@pytest.mark.parametrize(
    ("throws", "layout", "instants"),
    [
        ([0, 0], {"firing_order": [1, 2]}, {1: 0, 2: 360}),
        ([0, 90], {"firing_order": [1, 2]}, {1: 0, 2: 270}),
        ([0, 180], {"firing_order": [1, 2]}, {1: 0, 2: 180}),
        ([0, 270], {"firing_order": [1, 2]}, {1: 0, 2: 450}),
        ([0, 180], {"firing_order": [1, 2], "strokes": 2}, {1: 0, 2: 180}),
        ([0, 180, 180, 0], {"firing_order": [1, 2, 4, 3]}, {1: 0, 2: 180, 4: 360, 3: 540}),
        ([0, 90, 270, 180], {"firing_order": [1, 3, 2, 4]}, {1: 0, 3: 90, 2: 270, 4: 540}),
        ([0], {"firing_order": [1, 2], "bank_angle": 90}, {1: 0, 2: 450}),
        ([0], {"firing_order": [1, 2], "bank_angle": 180}, {1: 0, 2: 180}),
        ([0, 180], {"firing_order": [1, 2], "banks": [-90, 90], "rods": "alternating"}, {1: 0, 2: 360}),
        ([0], {"firing_order": [1]}, {1: 0}),
    ],
)
def test_intervals_follow_from_the_throws(throws, layout, instants):
    assert fires(crank={"throws": throws}, layout=layout) == instants


def test_without_a_firing_order_nothing_fires():
    assert fires(crank={"throws": [0, 180]}) == {}


def test_pins_count_from_cylinder_1_wherever_it_stands():
    assert pins(crank={"throws": [30, 210]}, layout={"numbering": [[2, 1]]}) == {1: 0, 2: 180}


# ------------------------------------------------------------------ what disagrees
def test_given_both_they_must_agree():
    assert refused(
        crank={"throws": [0, 180, 180, 0]}, layout={"firing_order": [1, 2, 3, 4], "firing_intervals": [180] * 4}
    ) == (
        "engine: layout.firing_order: cylinder 3 is not at top dead centre when it fires: its "
        "crank pin stands 180 deg ahead of cylinder 1's, and would have to stand at 0 deg (allowed "
        "difference 1 deg); change crank.throws, crank.splay, firing_order or firing_intervals, or "
        "leave crank.throws out"
    )


def test_an_order_that_takes_more_than_a_cycle():
    assert refused(crank={"throws": [0, 180, 180, 0]}, layout={"firing_order": [1, 4, 2, 3]}) == (
        "engine: layout.firing_order: 1-4-2-3 would take 1080 deg with these throws, a cycle has "
        "720; firing evenly, every 180 deg, cylinder 4 is the first that is not at top dead centre "
        "when it fires (allowed difference 1 deg): change firing_order or crank.throws, or leave "
        "crank.throws out"
    )


def test_banks_that_are_the_other_way_round_are_told():
    """A cross-plane V8 with odd numbers on the driver's left, which is the right bank seen from the
    free end.
    """
    crank = {"throws": [0, 90, 270, 180]}
    layout = {"bank_angle": 90, "firing_order": [1, 8, 4, 3, 6, 5, 7, 2]}
    odd, even = [1, 3, 5, 7], [2, 4, 6, 8]
    hint = (
        "leave crank.throws out. They fit with the banks exchanged: layout.numbering = [[2, 4, 6, "
        "8], [1, 3, 5, 7]], where the first bank is the left one seen from the free end (front), "
        "the driver's right"
    )
    assert refused(crank=crank, layout=layout | {"numbering": [odd, even]}).endswith(hint)
    banks = {"banks": [-45, 45], "firing_order": layout["firing_order"], "numbering": [odd, even]}
    assert refused(crank=crank, layout=banks).endswith("= [[2, 4, 6, 8], [1, 3, 5, 7]]")
    intervals = {"firing_intervals": [90] * 8}
    told = refused(crank=crank, layout=layout | intervals | {"numbering": [odd, even]})
    assert told.endswith(hint)
    assert list(fires(crank=crank, layout=layout | {"numbering": [even, odd]}).values()) == [90 * k for k in range(8)]
    wrong = {"numbering": [odd, even], "firing_order": [1, 2, 3, 4, 5, 6, 7, 8]}
    assert "exchanged" not in refused(crank=crank, layout=layout | wrong)


def test_throws_that_count_the_other_way_are_told():
    """1-5-3-6-2-4 as 1-4-2-6-3-5: throws counted as the cylinders fire."""
    order = {"firing_order": [1, 5, 3, 6, 2, 4]}
    found = refused(crank={"throws": [0, 120, 240, 240, 120, 0]}, layout=order)
    assert found.endswith(
        "leave crank.throws out. They fit with throws that count in the sense of rotation: "
        "crank.throws = [0, 240, 120, 120, 240, 0]"
    )
    crank = {"throws": [0, 240, 120, 120, 240, 0]}
    assert list(fires(crank=crank, layout=order).values()) == [0, 120, 240, 360, 480, 600]
    wrong = {"firing_order": [1, 2, 3, 4, 5, 6]}
    assert "sense" not in refused(crank=crank, layout=wrong)


ODD_AND_EVEN = [[1, 3, 5], [2, 4, 6]]


@pytest.mark.parametrize(
    ("crank", "hint"),
    [
        # Seen from the free end odd numbers are on the right, and the throws counted as they fire.
        (
            {"throws": [0, 120, 240], "splay": -30},
            "the driver's right; and with throws that count in the sense of rotation: crank.throws = [0, 240, 120]",
        ),
        ({"throws": [0, 240, 120], "splay": 30}, "and with split pins: crank.splay = -30"),
        # By exchanged banks alone they would fire after 60, 60, 60, 60, 60, 420 deg.
        ({"throws": [0, 120, 240], "splay": 30}, "or leave crank.throws out"),
    ],
)
def test_what_is_proposed_fires_as_one_would_want_it(crank, hint):
    """An American V6 with 30-degree split pins and more than one mistake in it."""
    layout = {"bank_angle": 90, "firing_order": [1, 6, 5, 4, 3, 2], "numbering": ODD_AND_EVEN}
    assert refused(crank=crank, layout=layout).endswith(hint)


def test_a_rotary_numbered_as_its_cylinders_come_to_the_top():
    """Cylinders that turn come to the top in the reverse of the sense in which they are numbered;
    one pin cannot be split for that.
    """
    layout = {"radial": 5, "rotary": True, "firing_order": [1, 3, 5, 2, 4]}
    numbering = [[1], [5], [4], [3], [2]]
    found = refused(crank={"throws": [0]}, layout=layout)
    assert found.endswith(
        f"crank.throws out. They fit with cylinders numbered the other way round: layout.numbering = {numbering}"
    )
    turned = engine(crank={"throws": [0]}, layout=layout | {"numbering": numbering})
    assert sorted(turned.fires_deg.values()) == [144 * k for k in range(5)]


def test_shared_pins_that_an_order_cannot_have():
    """Throws from the first bank, and then the second bank must agree with them."""
    assert refused(layout={"firing_order": [1, 2, 3, 4], "bank_angle": 60}) == (
        "engine: layout.firing_order: cylinder 3 is not at top dead centre when it fires: its "
        "crank pin stands 0 deg ahead of cylinder 1's, and would have to stand at 60 deg (allowed "
        "difference 1 deg); change crank.splay, firing_order or firing_intervals, or give "
        "crank.throws and no firing_order. They fit with split pins: crank.splay = 60"
    )


def test_intervals_in_another_turn_are_told():
    """The pin of a 45-degree twin meets the second bank 45 deg after the first, and a turn later."""
    twin = {"bank_angle": 45, "firing_order": [1, 2]}
    found = refused(layout=twin | {"firing_intervals": [315, 405]})
    assert found.endswith("They fit with layout.firing_intervals = [405, 315]")


def test_a_twin_on_one_pin_is_told_its_intervals_first():
    """The one pin of a 45-degree vee comes to the second bank 45 degrees after the first, and fires
    it a turn later, for 360 would take a pin of its own, 45 degrees ahead.
    """
    assert refused(layout={"bank_angle": 45, "firing_order": [1, 2]}).endswith(
        "They fit with layout.firing_intervals = [405, 315]; or evenly with split pins: crank.splay = 45"
    )


EXCHANGED = ", where the first bank is the left one seen from the free end (front), the driver's right"


@pytest.mark.parametrize(
    ("angle", "order", "said", "hint"),
    [
        # A cross-plane V8, odd numbers on the driver's left: 2 fires 270 deg after 1, whose pin it
        # shares if its bank stands 270 deg behind, or 90 deg ahead.
        (90, [1, 8, 4, 3, 6, 5, 7, 2], {}, f"[[2, 4, 6, 8], [1, 3, 5, 7]]{EXCHANGED}"),
        # 2 fires 240 deg after 1. With 1 on the left, its pin leads by 90 - 240 = -150 deg; with 1
        # on the right by -90 - 240 = 30, and the second bank is that of 1: -30.
        (90, [1, 6, 5, 4, 3, 2], {}, f"[[2, 4, 6], [1, 3, 5]]{EXCHANGED}; and with split pins: crank.splay = -30"),
        (90, [1, 6, 5, 4, 3, 2], {"splay": -30}, f"[[2, 4, 6], [1, 3, 5]]{EXCHANGED}"),
        # 3 fires 180 deg after 1: split by 60 - 180 or 60 + 180, which is as much; as the file has it
        (60, [1, 4, 2, 3], {"numbering": [[1, 2], [3, 4]]}, "with split pins: crank.splay = -120"),
    ],
)  # fmt: skip
def test_banks_are_exchanged_where_that_splits_pins_less(angle, order, said, hint):
    odd_and_even = [sorted(order)[::2], sorted(order)[1::2]]
    numbering = {"numbering": said.get("numbering", odd_and_even)}
    crank = {key: value for key, value in said.items() if key != "numbering"}
    layout = {"bank_angle": angle, "firing_order": order} | numbering
    assert refused(crank=crank, layout=layout).endswith(hint)


def test_the_order_in_which_a_radial_fires_evenly_is_told():
    """The pin comes by the cylinders as they are numbered, and every second one fires."""
    found = refused(layout={"radial": 5, "firing_order": [1, 2, 3, 4, 5]})
    assert found.endswith("They would fire evenly as 1-3-5-2-4")


@pytest.mark.parametrize("angle", [60, 72, 90])
def test_the_splay_that_makes_a_vee_six_fire_evenly(angle):
    """The second rod of a throw fires 120 degrees after the first, its bank stands `angle` further
    on: its pin leads by the difference.
    """
    layout = {"bank_angle": angle, "firing_order": [1, 4, 3, 6, 2, 5]}
    crank = {"throws": [0, 240, 120]}
    assert engine(crank=crank, layout=layout).splay_for_even_firing == angle - 120
    split = engine(crank=crank | {"splay": angle - 120}, layout=layout)
    assert list(split.fires_deg.values()) == [120 * k for k in range(6)]
    assert refused(layout=layout).endswith(f"with split pins: crank.splay = {angle - 120}")


def test_there_is_no_such_splay_where_throws_differ_or_intervals_are_said():
    vee = {"bank_angle": 90, "firing_order": [1, 4, 3, 6, 2, 5]}
    assert engine(crank={"throws": [0, 230, 120]}, layout=vee).splay_for_even_firing is None
    said = vee | {"firing_intervals": [90, 150, 90, 150, 90, 150]}
    assert engine(crank={"throws": [0, 240, 120]}, layout=said).splay_for_even_firing is None
    twin = {"bank_angle": 45, "firing_order": [1, 2]}
    assert engine(crank={"throws": [0]}, layout=twin).splay_for_even_firing is None
    in_line = {"firing_order": [1, 3, 2]}
    assert engine(crank={"throws": [0, 240, 100]}, layout=in_line).splay_for_even_firing is None


@pytest.mark.parametrize(("throw", "good"), [(179.1, True), (180.9, True), (178.9, False), (181.1, False)])
def test_a_degree_is_forgiven(throw, good):
    parts = {"crank": {"throws": [0, throw]}, "layout": {"firing_order": [1, 2], "firing_intervals": [180, 540]}}
    if good:
        assert fires(**parts) == {1: 0, 2: 180}
    else:
        assert "cylinder 2 is not at top dead centre" in refused(**parts)


def test_the_first_cylinder_that_cannot_fire_in_time_is_named():
    """Cylinders 2, 3 and 4 come to top dead centre at 170, 160 and 150 deg: 1-2-3-4 waits 170 + 350
    + 350 + 210 deg.
    """
    pin = {1: 0.0, 2: -170.0, 3: -160.0, 4: -150.0}
    message = (
        "1-2-3-4 would take 1080 deg with these throws, a cycle has 720; firing evenly, every 180 "
        "deg, cylinder 2 is the"
    )
    with pytest.raises(InputError, match=message):
        find_intervals([1, 2, 3, 4], find_dead_centres(pin, dict.fromkeys(pin, 0.0)), 720.0)


@pytest.mark.parametrize("count", [3, 5, 7, 9, 11])
def test_a_turn_that_is_left_over_goes_to_the_last_of_equal_intervals(count):
    """Of a seven-cylinder star it went to the last but one, whose interval is less by rounding."""
    order = list(range(1, count + 1))
    pin = {k: -360 * (k - 1) / count for k in order}
    ready = find_dead_centres(pin, dict.fromkeys(order, 0.0))
    step = 360 / count
    expected = [step] * (count - 1) + [step + 360]
    assert find_intervals(order, ready, 720.0) == pytest.approx(expected, abs=TIGHT)


def test_a_pin_a_rounding_error_short_of_a_turn_is_at_its_place():
    both = {1: 0.0, 2: 0.0}
    assert list(check_firing(both, {1: 0.0, 2: 360 - 1e-12}, both)) == []
    (problem,) = check_firing(both, {1: 0.0, 2: 340.0}, both)
    assert problem.message.startswith("cylinder 2 is not at top dead centre")


# ------------------------------------------------------------------ a slip that fits all the same
ANOTHER = "would evenly, every {} deg; change it{}, or say layout.firing_intervals = {} if it is so"
OR_THROWS = " (or crank.throws, which count in the sense of rotation)"


@pytest.mark.parametrize(
    ("parts", "told"),
    [
        (
            {"crank": {"throws": [0, 240, 120]}, "layout": {"firing_order": [1, 2, 3]}},
            "1-2-3 fires after 120, 120, 480 deg with these throws, and 1-3-2 "
            + ANOTHER.format(240, OR_THROWS, "[120, 120, 480]"),
        ),
        (
            {"crank": {"throws": [0, 120, 240]}, "layout": {"firing_order": [2, 1, 3]}},
            "2-1-3 fires after 120, 120, 480 deg with these throws, and 2-3-1 "
            + ANOTHER.format(240, OR_THROWS, "[120, 120, 480]"),
        ),
        (
            {"crank": {"throws": [0]}, "layout": {"radial": 5, "firing_order": [1, 2, 3, 4, 5]}},
            "1-2-3-4-5 fires after 72, 72, 72, 72, 432 deg with these throws, and 1-3-5-2-4 "
            + ANOTHER.format(144, "", "[72, 72, 72, 72, 432]"),
        ),
    ],
)
def test_an_order_that_fires_unevenly_beside_an_even_one_is_doubted(parts, told):
    """An odd number of cylinders has all its dead centres in one turn: an order of one turn and a
    long wait takes no more than a cycle.
    """
    doubts = [doubt for doubt in engine(**parts).doubts if "firing" in doubt]
    assert doubts == [f"layout.firing_order: {told}"]


def test_an_order_of_one_revolution_is_doubted_where_two_are_less_uneven():
    """A 90-degree V6 on common pins: dead centres at 0, 240, 120 and 90 later; 1-4-3-6-2-5 goes on
    to the next throw after 150 degrees, 1-4-2-5-3-6 waits for more than a turn.
    """
    vee = {"bank_angle": 90, "firing_order": [1, 4, 2, 5, 3, 6]}
    doubts = engine(crank={"throws": [0, 240, 120]}, layout=vee).doubts
    (told,) = (doubt for doubt in doubts if "firing" in doubt)
    assert told == (
        "layout.firing_order: 1-4-2-5-3-6 fires after 90, 30, 90, 30, 90, 390 deg with these "
        "throws, and 1-4-3-6-2-5 would after 90, 150, 90, 150, 90, 150; change it"
        f"{OR_THROWS}, or say layout.firing_intervals = [90, 30, 90, 30, 90, 390] if it is so"
    )


def test_pins_that_are_split_the_wrong_way_are_doubted():
    """A 90-degree V6: its banks are 30 degrees short of the 120 from firing to firing."""
    vee = {"bank_angle": 90, "firing_order": [1, 4, 3, 6, 2, 5]}
    doubts = engine(crank={"throws": [0, 240, 120], "splay": 30}, layout=vee).doubts
    (told,) = (doubt for doubt in doubts if "splay" in doubt)
    assert told == (
        "crank.splay is 30, with which the cylinders fire after 60, 180, 60, 180, 60, 180 deg, and "
        "with -30 they would evenly; change it, or say layout.firing_intervals = [60, 180, 60, "
        "180, 60, 180] if it is so"
    )


@pytest.mark.parametrize(
    "parts",
    [
        {  # split by 180 - 2 * 60: nothing of order 1 turns against the crank
            "crank": {"throws": [0], "splay": -60},
            "layout": {"bank_angle": 60, "firing_order": [1, 2]},
        },
        {  # less than even firing takes, and more even than common pins
            "crank": {"throws": [0, 240, 120], "splay": -18},
            "layout": {"bank_angle": 90, "firing_order": [1, 4, 3, 6, 2, 5]},
        },
        {"crank": {"throws": [0, 240, 120]}, "layout": {"bank_angle": 90, "firing_order": [1, 4, 3, 6, 2, 5]}},
        {"crank": {"throws": [0, 240, 120]}, "layout": {"firing_order": [1, 3, 2]}},
        {"crank": {"throws": [0, 239.5, 120.5]}, "layout": {"firing_order": [1, 3, 2]}},
        {
            "crank": {"throws": [0, 240, 120]},
            "layout": {"firing_order": [1, 2, 3], "firing_intervals": [120, 120, 480]},
        },
        {"crank": {"throws": [0, 240, 120]}, "layout": {"firing_order": [1, 2, 3], "strokes": 2}},
        {"crank": {"throws": [0, 90]}, "layout": {"firing_order": [1, 2]}},
        {"crank": {"throws": [0, 90, 270, 180]}, "layout": {"firing_order": [1, 3, 2, 4]}},
        {"crank": {"throws": [0]}, "layout": {"bank_angle": 45, "firing_order": [1, 2]}},
        {"crank": {"throws": [0, 240, 120]}, "layout": {}},
    ],
)
def test_an_order_is_not_doubted_where_it_is_even_or_none_is(parts):
    doubts = engine(**parts).doubts
    assert not [doubt for doubt in doubts if "firing" in doubt or "splay" in doubt]
