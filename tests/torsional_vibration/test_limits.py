"""Limits of stress and torque by part and speed, and the verdict on each shaft."""

import json

import pytest
from support.chains import chain_text
from support.commands import ask_torsion, refusal, run_here

from balcli.torsional_vibration.permitted import M68, LimitTable

TORQUES = [("engine", 2, 300, 60), ("engine", 1, 0, 95)]
NODES = {"engine": 12, "pump": {"inertia": "5 kg m^2", "damping": 30}}


def write_pair(torques=TORQUES, **shaft):
    own = {"stiffness": 9.0e4, "loss": 0.03, "diameter": 70} | shaft
    return chain_text(NODES, {("engine", "pump"): own}, torques)


def test_a_limit_over_the_speed_is_linear_and_judged_on_the_curve_itself():
    """Figures of a dense complex solution with the roots of the derivative's polynomial."""
    text = write_pair(limit={"speed": [600, 1500], "stress": [20, 11]})
    out = run_here("torsion", "-", "--speeds", "500:1600:25", "--format", "json", stdin=text)
    assert "outside its speeds the limit of 600 rpm is used at 500 rpm" in out.err
    answer = json.loads(out.out)
    (limit,) = answer["limits"]
    assert (limit["shaft"], limit["kind"], limit["verdict"]) == ("engine-pump", "stress", "barred")
    assert limit["share"] == pytest.approx(1.3092519018553002, rel=1e-8)
    assert limit["speed_rpm"] == pytest.approx(762.3125507640616, rel=1e-6)
    assert limit["value_Pa"] == pytest.approx(24059957.879277676, rel=1e-7)
    assert limit["limit_Pa"] == pytest.approx(18376874.492359385, rel=1e-7)
    (barred,) = limit["barred"]
    assert barred["from_rpm"] == pytest.approx(743.9019219602983, rel=1e-8)
    assert barred["to_rpm"] == pytest.approx(780.666410861686, rel=1e-8)
    assert answer["barred_rpm"] == [[barred["from_rpm"], barred["to_rpm"]]]


@pytest.mark.parametrize(
    ("speeds", "side"),
    [("700:760:5", "above"), ("770:900:5", "below"), ("750:770:5", "both"), ("700:900:5", None)],
)
def test_a_range_that_ends_only_with_the_speeds_is_open(speeds, side):
    (limit,) = ask_torsion(write_pair(limit=18), "--speeds", speeds)["limits"]
    (barred,) = limit["barred"]
    assert barred.get("open") == side


@pytest.mark.parametrize(("share", "verdict"), [(0.999, "barred"), (1.001, "passes")])
def test_a_shaft_passes_if_its_largest_value_is_below_the_limit(share, verdict):
    worst = ask_torsion(write_pair(), "--speeds", "700:900:5")["response"]["shafts"][0]["worst"]
    limits = {"limit": worst["stress_Pa"] / 1e6 * share, "torque_limit": worst["half_peak_to_peak_Nm"] * share}
    stress, torque = ask_torsion(write_pair(**limits), "--speeds", "700:900:5")["limits"]
    assert (stress["kind"], torque["kind"]) == ("stress", "torque")
    for limit in (stress, torque):
        assert limit["verdict"] == verdict
        assert limit["share"] == pytest.approx(1 / share, rel=1e-7)


def test_m68_at_two_diameters_and_speeds():
    """By hand: c_D = 0.35 + 0.93/sqrt(4) at 1024 mm and 0.35 + 0.93/2 = 0.815 at 32 mm."""
    rule = M68(tensile=560, factor=0.5, diameter=1024, rated_rpm=100)
    assert rule.at(50) == pytest.approx(40 * 0.5 * (0.35 + 0.93 / 4) * 2.5 * 1e6)
    assert rule.at(89.9999) == pytest.approx(float(rule.at(90)), rel=1e-5)
    assert rule.at(120) == pytest.approx(40 * 0.5 * (0.35 + 0.93 / 4) * 1.38 * 1e6)
    assert rule._replace(diameter=32).at(50) == pytest.approx(40 * 0.5 * 0.815 * 2.5 * 1e6)
    assert rule._replace(factor=1).transient == pytest.approx(1.7)
    assert rule._replace(factor=0.25).transient == pytest.approx(3.4)
    assert rule.range_about(50) == pytest.approx((16 * 50 / 17.5, 17.5 * 50 / 16))


@pytest.mark.parametrize(
    ("rated", "ck", "verdict", "reason"),
    [
        (1000, 0.3, "barred", None),
        (900, 0.3, "fails", "the barred range reaches 808.8 rpm, but M68 allows none above 720 rpm"),
        (3000, 0.01, "fails", "209% of the transient limit at 762.1 rpm"),
        (900, 0.01, "fails", "383% of the transient limit at 763.2 rpm"),
    ],
)
def test_m68_allows_no_range_near_the_rated_speed_or_above_the_transient_limit(rated, ck, verdict, reason):
    rule = {"rule": "M68", "tensile": 400, "ck": ck, "rated_speed": rated}
    text = write_pair([("engine", 2, 300, 60)], limit=rule)
    (limit,) = ask_torsion(text, "--speeds", "700:830:5")["limits"]
    assert (limit["verdict"], limit.get("reason")) == (verdict, reason)


def test_the_reason_is_the_range_with_the_largest_share_of_the_transient_limit():
    rule = {"rule": "M68", "tensile": 400, "ck": 1, "rated_speed": 20000}
    text = write_pair([("engine", 2, 2400, 480), ("engine", 1, 0, 3000)], limit=rule)
    (limit,) = ask_torsion(text, "--speeds", "500:2000:25")["limits"]
    first, second = (span["transient_share"] for span in limit["barred"])
    assert 1 < first < second
    assert limit["reason"] == f"{second:.0%} of the transient limit at 1524 rpm"


def test_a_limit_by_speed_has_the_nearest_value_outside():
    table = LimitTable((40, 60, 100), (70, 52, 30))
    assert [float(table.at(rpm)) for rpm in (20, 40, 50, 80, 100, 200)] == pytest.approx([70, 70, 61, 41, 30, 30])


@pytest.mark.parametrize(
    ("shaft", "told"),
    [
        ({"limit": {"rule": "M68", "ck": 1, "rated_speed": 900}}, 'shaft.1.limit: has rule = "M68" and lacks tensile'),
        ({"limit": {"rule": "M68", "tensile": 500, "ck": 1}}, "shaft.1.limit: has no rated speed; give rated_speed"),
        ({"limit": {"rule": "M68", "tensile": 399, "ck": 1}}, "399 is less than 400"),
        ({"limit": {"rule": "M53", "tensile": 500, "ck": 1}}, '"M53" is not "M68"'),
        ({"limit": {"rule": "M68", "tensile": 500, "ck": "hub"}}, "keyed-taper"),
        ({"limit": {"speed": [600, 500], "stress": [1, 2]}}, "speeds that do not rise: 500 rpm after 600 rpm"),
        ({"limit": {"speed": [600, 700], "stress": [1, 2, 3]}}, "has 2 speeds, but 3 values of stress"),
        ({"torque_limit": {"speed": [600, 700]}}, "lacks torque"),
        (
            {"limit": {"speed": [600, 700], "stress": [1, 2], "tensile": 500}},
            'shaft.1.limit: has tensile without a rule; give rule = "M68", or leave tensile out',
        ),
        ({"limit": {"tensile": 500, "ck": 1}}, "shaft.1.limit: has tensile and ck without a rule"),
    ],
)
def test_a_mistake_in_a_limit_is_told(shaft, told):
    assert told in refusal("torsion", "-", "--speeds", "700:900:5", stdin=write_pair(**shaft))


@pytest.mark.parametrize("own", [{}, {"torque_limit": 999}])
def test_a_table_for_all_shafts_holds_where_a_shaft_has_none_of_its_own(own):
    tables = {"limit": {"speed": [600, 1500], "stress": [20, 11]}}
    tables["torque_limit"] = {"speed": [600, 1500], "torque": [1300, 700]}
    stiff = {"stiffness": 9.0e4, "loss": 0.03, "diameter": 70}
    for_all = chain_text(NODES, {("engine", "pump"): stiff | own}, TORQUES, **tables)
    for_one = write_pair(**(tables | own))
    speeds = ("--speeds", "700:1400:25")
    assert ask_torsion(for_all, *speeds)["limits"] == ask_torsion(for_one, *speeds)["limits"]


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"limit": {"rule": "M68", "tensile": 500, "ck": 1, "rated_speed": 900}}, 'limit with rule = "M68", which is'),
        ({"torque_limit": "mean"}, 'torque_limit = "mean", which is for single shafts'),
    ],
)
def test_a_rule_is_not_for_all_shafts(keys, told):
    text = chain_text(NODES, {("engine", "pump"): 9.0e4}, TORQUES, **keys)
    assert told in refusal("torsion", "-", stdin=text)


def test_one_warning_names_all_shafts_with_a_limit():
    nodes = NODES | {"fan": 3}
    shafts = {
        ("engine", "pump"): {"stiffness": 9.0e4, "loss": 0.03},
        ("pump", "fan"): {"stiffness": 4.0e4, "loss": 0.03},
    }
    table = {"speed": [600, 1500], "torque": [1300, 700]}
    text = chain_text(nodes, shafts, TORQUES, torque_limit=table)
    told = run_here("torsion", "-", "--speeds", "700:1600:25", stdin=text).err
    assert told.count("torque limit of engine-pump, pump-fan: outside its speeds") == 1


def test_barred_speeds_that_end_with_the_speeds_are_open_in_words():
    text = write_pair(limit=18)
    for speeds, told in (("700:760:5", "above 7"), ("770:900:5", "below 7"), ("750:770:5", "750 to 770 rpm")):
        out = run_here("torsion", "-", "--speeds", speeds, stdin=text).out
        assert out.splitlines()[-1].startswith(f"barred speeds  {told}")


def test_barred_ranges_name_the_kind_of_limit_where_both_kinds_are_exceeded():
    out = run_here("torsion", "-", "--speeds", "700:900:5", stdin=write_pair(limit=18, torque_limit=1200)).out
    _, _, table = out.partition("Barred speeds\n")
    assert [line.split()[1] for line in table.splitlines()[2:4]] == ["stress", "torque"]
