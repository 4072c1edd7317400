"""Firing order <-> crank throws, on engines whose answer is known."""

import math

import pytest
from support.cases import cases
from support.engines import engine, refused

from balcli.engine.layout import find_intervals

TIGHT = 1e-9  # deg


def fires(**parts):
    return {n: float(a) for n, a in engine(**parts).fires_deg.items()}


# ------------------------------------------------------------------ order -> throws
@cases("engine/firing", "throws_follow_from_the_firing_order")
def test_throws_follow_from_the_firing_order(layout, wanted):
    """Pins of in-line engines are minus the firing angle; the rest are the shared pins of real engines."""
    found = engine(layout=layout).pins_deg
    assert [round(float(found[n]) % 360, 9) % 360 for n in sorted(found)] == wanted


def test_vr6_pins_of_neighbours_are_split_by_the_offset_of_the_banks():
    """a_2 = g_2 - g_1 + tau_2 - tau_1 - f_2, sin tau = e/(r + l): 15 degrees of bank and twice tau of the offset."""
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


def test_pins_split_by_30_degrees_fire_evenly():
    """The second bank's pins lag by 30 degrees, so that it fires 90 + 30 after the first."""
    layout = {"bank_angle": 90, "firing_order": [1, 4, 2, 5, 3, 6]}
    even = engine(crank={"throws": [0, 120, 240], "splay": -30}, layout=layout)
    assert list(even.fires_deg.values()) == [0, 120, 240, 360, 480, 600]
    assert {n: float(pin) for n, pin in even.pins_deg.items()} == {1: 0, 2: 120, 3: 240, 4: -30, 5: 90, 6: 210}


# ------------------------------------------------------------------ throws and order -> intervals
@cases("engine/firing", "intervals_follow_from_the_throws")
def test_intervals_follow_from_the_throws(throws, layout, instants):
    found = fires(crank={"throws": throws}, layout=layout)
    assert found == dict(zip(layout["firing_order"], instants, strict=True))


def test_an_order_that_takes_more_than_a_cycle():
    assert refused(crank={"throws": [0, 180, 180, 0]}, layout={"firing_order": [1, 4, 2, 3]}) == (
        "engine: layout.firing_order: 1-4-2-3 would take 1080 deg with these crank.throws, but a cycle has "
        "720; with even firing every 180 deg, cylinder 4 is the first that is not at top dead centre when it fires: "
        "change firing_order or crank.throws, or leave crank.throws out. If cylinders fire together, it fits "
        "with layout.firing_intervals = [0, 180, 360, 180] or with layout.firing_intervals = [360, 180, 0, 180]"
    )


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


def test_there_is_no_such_splay_where_throws_differ_or_intervals_are_said():
    vee = {"bank_angle": 90, "firing_order": [1, 4, 3, 6, 2, 5]}
    for throws, layout in (
        ([0, 230, 120], vee),
        ([0, 240, 120], vee | {"firing_intervals": [90, 150] * 3}),
        ([0], {"bank_angle": 45, "firing_order": [1, 2]}),
        ([0, 240, 100], {"firing_order": [1, 3, 2]}),
    ):
        assert engine(crank={"throws": throws}, layout=layout).splay_for_even_firing is None


@pytest.mark.parametrize(("throw", "good"), [(179.1, True), (180.9, True), (178.9, False), (181.1, False)])
def test_a_degree_is_forgiven(throw, good):
    parts = {"crank": {"throws": [0, throw]}, "layout": {"firing_order": [1, 2], "firing_intervals": [180, 540]}}
    if good:
        assert fires(**parts) == {1: 0, 2: 180}
    else:
        assert "cylinder 2 is not at top dead centre" in refused(**parts)


@pytest.mark.parametrize("count", [3, 5, 7, 9, 11])
def test_a_turn_that_is_left_over_goes_to_the_last_of_equal_intervals(count):
    """Of a seven-cylinder star it went to the last but one, whose interval is less by rounding."""
    order = list(range(1, count + 1))
    ready = {k: 360 * (k - 1) / count for k in order}
    expected = [360 / count] * (count - 1) + [360 / count + 360]
    assert find_intervals(order, ready, 720.0) == pytest.approx(expected, abs=TIGHT)


# ------------------------------------------------------------------ doubts
@cases("engine/firing", "an_order_is_not_doubted_where_it_is_even_or_none_is")
def test_an_order_is_not_doubted_where_it_is_even_or_none_is(parts):
    doubted = {doubt.path for doubt in engine(**parts).doubts}
    assert not doubted & {"layout.firing_order", "crank.splay"}


@pytest.mark.parametrize(
    ("splay", "more", "words"),
    [
        (60, {}, "with 60 deg, the part of order 1 that turns against the crank is 75 % of one"),
        (-60, {}, ""),
        (60, {"firing_order": [1, 2, 3, 4, 5, 6]}, ""),
    ],
)
def test_a_splay_of_the_wrong_sign_is_doubted(splay, more, words):
    """A 60-degree V6 with six pins has no moment against the crank; with the other sign it has."""
    pins = {"throws": [0, 240, 120], "spacing": 100, "splay": splay}
    found = engine(crank=pins, layout={"bank_angle": 60, **more}).doubts
    doubts = [doubt.message for doubt in found if doubt.path == "crank.splay"]
    assert len(doubts) == bool(words)
    assert all(doubt.startswith(words) and "0 % with -60 deg" in doubt for doubt in doubts)
