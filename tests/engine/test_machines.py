"""Strokes and throw masses per throw, harmonic motion, radials in rows."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support.engines import engine

from balcli import InputError, curves, load, search, torque
from balcli.core.cylinders import find_travel
from balcli.forces.spectrum import compute_spectra
from balcli.torsional_vibration.build import weigh_running_gear

KINDS = ("force", "moment", "couple", "torque")
ORDERS = [1, 2, 3, 4, 6]
OTTO = {"cycle": "otto", "compression_ratio": 9, "imep": 8}
numbers = st.floats(0.1, 1)
lists = st.integers(2, 5).flatmap(lambda n: st.tuples(*[st.lists(numbers, min_size=n, max_size=n)] * 4))


def spectra(**parts):
    found = compute_spectra(engine(**parts), ORDERS, KINDS)
    return np.stack([found[kind].vectors for kind in KINDS])


def in_line(strokes, throws, masses, weights, **parts):
    """An engine in line, whose lists are shares of usual figures; with an offset and a distributed rod."""
    own = {str(k): {"piston_mass": mass} for k, mass in enumerate(weights, 1)}
    return {
        "crank": {"stroke": strokes, "throws": [360 * t for t in throws], "spacing": 90, "throw_mass": masses},
        "rod": {"length": 170, "mass": 0.7, "cg": 50, "inertia": 2500},
        "piston": {"mass": 0.5, "bore": 80, "offset": 3},
        "cylinder": own,
    } | parts


# ------------------------------------------------------------------ strokes and throw masses
@given(lists)
def test_equal_strokes_and_masses_in_a_list_are_the_single_number_bit_for_bit(shares):
    throws, weights, *_ = shares
    count = len(throws)
    one, several = (in_line(s, throws, m, weights) for s, m in ((90, 1.5), ([90] * count, [1.5] * count)))
    assert np.array_equal(spectra(**one), spectra(**several))


@given(lists)
def test_an_engine_is_the_sum_of_its_throws(shares):
    """Each of them alone, with one stroke for all and nothing that moves in the other cylinders."""
    strokes, throws, masses, weights = shares
    strokes = [100 * stroke for stroke in strokes]
    total = spectra(**in_line(strokes, throws, masses, weights))
    alone = []
    for k, stroke in enumerate(strokes):
        only = [weight * (k == j) for j, weight in enumerate(weights)]
        parts = in_line(stroke, throws, [mass * (k == j) for j, mass in enumerate(masses)], only)
        for j, own in enumerate(parts["cylinder"].values()):
            if j != k:
                own.update(rod_mass=0, rod_inertia=0)
        alone.append(spectra(**parts))
    assert np.allclose(total, sum(alone), rtol=0, atol=1e-12 * sum(np.abs(one).max() for one in alone))


@given(lists)
def test_the_stroke_of_a_cylinder_is_that_of_its_throw(shares):
    strokes, throws, masses, weights = shares
    by_throw = in_line([100 * s for s in strokes], throws, masses, weights)
    by_cylinder = in_line(100, throws, masses, weights)
    for own, share in zip(by_cylinder["cylinder"].values(), strokes, strict=True):
        own["stroke"] = 100 * share
    assert np.array_equal(spectra(**by_throw), spectra(**by_cylinder))


@given(numbers, numbers, numbers)
def test_opposed_pistons_on_one_crank_balance_order_1(mass, inner, outer):
    """Masses go as the inverse of the strokes; in two planes the force alone is balanced."""
    parts = {
        "crank": {"stroke": [outer, inner, outer], "throws": [0, 180, 0], "positions": [-300, 0, 300]},
        "rod": {"ratio": 0.25},
        "piston": {"mass": mass},
        "cylinder": {n: {"piston_mass": mass * inner / outer / 2} for n in "13"},
    }
    found = compute_spectra(engine(**parts), [1, 2])
    assert found.force.balanced[0]
    assert found.moment.balanced[0]
    assert not found.force.balanced[1]
    parts["crank"] = {"stroke": [outer, inner], "throws": [0, 180], "spacing": 300}
    parts["cylinder"] = {"1": {"piston_mass": mass * inner / outer}}
    found = compute_spectra(engine(**parts), [1])
    assert found.force.balanced[0]
    assert not found.moment.balanced[0]


def test_gas_motion_and_torsion_take_the_stroke_of_the_cylinder():
    order = {"strokes": 2, "firing_order": [1, 2]}
    parts = in_line([90, 60], [0, 0.5], [1, 2], [0.5, 0.4], layout=order, gas=OTTO, operation={"speed": 1800})
    both = engine(**parts)
    swept = float(both.displacement_m3)
    assert swept == pytest.approx(np.pi / 4 * 0.08**2 * find_travel(both.cylinders).stroke.sum(), rel=1e-12)
    assert torque(both).mean_torque_Nm == pytest.approx(8e5 * swept / (2 * np.pi), rel=1e-9)
    for k, stroke in enumerate((90, 60)):
        one = engine(**parts | {"crank": {**parts["crank"], "stroke": stroke}})
        mine, its = (curves(each, 7, cylinder=k + 1).curves for each in (both, one))
        for name in ("travel_m", "pin_x_N", "pin_y_N", "torque_Nm"):
            assert mine[name] == pytest.approx(its[name], rel=1e-9, abs=1e-6)
        assert weigh_running_gear(both)[k] == pytest.approx(weigh_running_gear(one)[k], rel=1e-12)


def test_a_mass_without_a_radius_has_that_of_the_nearest_throw():
    made = engine(**in_line([60, 80, 100], [0, 0.3, 0.6], 1, [0.5] * 3))
    assert [made.find_radius(z / 1e3) for z in (-200, -45, 20, 46, 90)] == [0.03, 0.03, 0.04, 0.05, 0.05]


def test_a_crank_seen_from_its_other_end_is_another_where_strokes_or_masses_differ():
    """0-0-180 is 180-0-0 from the other end; no force of order 3 tells them apart."""

    def count(stroke, mass):
        parts = in_line(stroke, [0, 0, 1 / 2], mass, [0.5] * 3, piston={"mass": 0.5})
        return len(search(engine(**parts), "throws", "force.3.major").results)

    assert count(90, 1) == count([90, 80, 90], [1, 0, 1]) == 2
    assert count([80, 90, 90], 1) == count(90, [0, 1, 1]) == 3


# ------------------------------------------------------------------ harmonic motion
def harmonic(motion, offset=0, **rod):
    return {
        "crank": {"stroke": 90, "throws": [0, 120], "spacing": 80, "throw_mass": 1},
        "rod": {"small_end": 0.2, "big_end": 0.5, **motion, **rod},
        "piston": {"mass": 2, "bore": 90, "offset": offset},
        "operation": {"speed": 1200},
    }


def test_harmonic_motion_is_the_limit_of_a_long_rod():
    cosine, long = (spectra(**harmonic(m)) for m in ({"motion": "harmonic"}, {"ratio": 1e-9}))
    scale = np.abs(long).max(axis=(1, 2), keepdims=True)
    assert np.allclose(cosine[[0, 1, 3]] / scale[[0, 1, 3]], long[[0, 1, 3]] / scale[[0, 1, 3]], rtol=0, atol=1e-8)
    assert not cosine[:2, :, 1:].any()
    assert not cosine[3][:, [0, 2, 3, 4]].any()
    assert not cosine[2].any()


def test_an_offset_piston_in_harmonic_motion_has_a_couple_and_even_strokes():
    made = engine(**harmonic({"motion": "harmonic"}, offset=5))
    each = compute_spectra(made, [1], ["couple"], by_cylinder=True)["couple"].major[0]
    assert each == pytest.approx(2.2 * 0.005 * 0.045 * float(made.omega) ** 2, rel=1e-12)
    travel = find_travel(made.cylinders)
    assert travel.stroke == pytest.approx(0.09, rel=1e-15)
    assert not np.any(travel.top_deg)
    assert not np.any(travel.bottom_deg)


def test_forces_on_the_pin_of_a_yoke_do_its_work():
    parts = harmonic({"motion": "harmonic"}, offset=4) | {"layout": {"firing_order": [1, 2]}, "gas": OTTO}
    found = curves(engine(**parts), 5, cylinder=1)
    along = found.curves["pin_x_N"]
    across = found.curves["pin_y_N"]
    turned = np.radians(found.crank_deg)
    torque = 0.045 * (across * np.cos(turned) - along * np.sin(turned))
    assert torque == pytest.approx(found.curves["torque_Nm"], rel=1e-9, abs=1e-6)
    assert not found.curves["side_thrust_N"].any()
    assert not found.curves["rod_angle_deg"].any()


def test_a_length_divides_the_mass_of_a_rod_in_harmonic_motion():
    parts = {**harmonic({}), "rod": {"motion": "harmonic", "mass": 0.7, "cg": 40}}
    with pytest.raises(InputError, match=r"rod\.length: is missing; rod\.mass and rod\.cg need it"):
        load(parts)
    for rod in ({"length": 140}, {"ratio": 45 / 140}, {"mass": None, "cg": None, "small_end": 0.2, "big_end": 0.5}):
        (weighed, _) = load({**parts, "rod": {**parts["rod"], **rod}}).weighed
        assert (weighed.small_end, weighed.big_end) == pytest.approx((0.2, 0.5))


# ------------------------------------------------------------------ radials in rows
def radial(rows, **parts):
    return {
        "crank": {"stroke": 140, "spacing": 180, "throws": [180.0 * j for j in range(rows)], "throw_mass": 3},
        "rod": {"length": 280, "mass": 2, "cg": 80, "inertia": 30000},
        "piston": {"mass": 2, "bore": 130},
    } | parts


HUNG = {"knuckle_radius": 50, "rod": {"length": 230, "mass": 1, "cg": 90}}


@given(st.integers(3, 9), st.integers(1, 3), st.none() | st.floats(-50, 50), st.data())
def test_rows_are_banks_of_single_cylinders(count, rows, turn, data):
    masters = data.draw(st.none() | st.lists(st.integers(1, count), min_size=rows, max_size=rows))
    more = {} if masters is None else {"articulation": HUNG | {"master": masters}}
    layout = {"radial": count, "rows": rows} | ({} if turn is None else {"row_angle": turn})
    short = engine(**radial(rows, layout=layout, **more))
    step = 360 / count / rows if turn is None else turn
    banks = {str(count * j + k + 1): {"bank": 360 * k / count + j * step} for j in range(rows) for k in range(count)}
    by_bank = [[count * j + k + 1 for j in range(rows)] for k in range(count)]
    written = engine(**radial(rows, layout={"radial": count, "numbering": by_bank}, cylinder=banks, **more))
    assert short.numbers == written.numbers
    found, same = (compute_spectra(each, ORDERS, KINDS) for each in (short, written))
    assert all(np.array_equal(found[kind].vectors, same[kind].vectors) for kind in KINDS)


def test_each_row_has_its_master():
    made = engine(**radial(2, layout={"radial": 7, "rows": 2}, articulation=HUNG | {"master": [1, 3]}))
    strokes = zip(made.numbers, find_travel(made.cylinders).stroke, strict=True)
    assert {number for number, stroke in strokes if abs(stroke - 0.14) < 1e-9} == {1, 10}


@pytest.mark.parametrize(("count", "step"), [(14, 9), (18, 11)])
def test_the_orders_of_makers_fire_evenly_round_two_rows(count, step):
    order = [(step * k) % count + 1 for k in range(count)]
    numbering = [[*range(1, count, 2)], [*range(2, count + 1, 2)]]
    layout = {"radial": count // 2, "rows": 2, "numbering": numbering}
    for throws in (None, [0, 180]):
        parts = radial(2, layout={**layout, "firing_order": order})
        parts["crank"] = {**parts["crank"], "throws": throws} if throws else {"stroke": 140, "spacing": 180}
        made = engine(**parts)
        assert np.diff([*made.fires_deg.values()]) == pytest.approx(720 / count, abs=1e-9)
        found = compute_spectra(made, [1, 2])
        assert found.force.balanced.all()
        assert found.moment.balanced[1]
        assert found.moment.minor[0] == pytest.approx(found.moment.major[0])
