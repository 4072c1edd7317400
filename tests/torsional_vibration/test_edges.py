"""Largest values at the ends of the range of speeds, and critical speeds just outside."""

import pytest
from support.chains import chain_text
from support.commands import ask_torsion, run_here

# Two inertias of 1 kg m2: the mode is at sqrt(2 k) rad/s, so order 2 meets it at 1000 rpm.
STIFFNESS = 0.5 * (2 * 1000 * 3.141592653589793 / 30) ** 2
TORQUES = [("a", 2, 100), ("a", 1, 1)]
OUTSIDE = {10: "10", 9: "9", 8.5: "8½", 7.5: "7½", 7: "7"}
PAIR = chain_text({"a": 1, "b": 1}, {"ab": STIFFNESS}, TORQUES, loss=0.02)


@pytest.mark.parametrize(
    ("speeds", "edge", "at"),
    [
        ("1010:1300:10", "first", 1010),
        ("700:990:10", "last", 990),
        ("700:1300:10", None, 1000),
        ("1010", None, 1010),
    ],
)
def test_the_largest_value_at_an_end_of_the_range_is_marked(speeds, edge, at):
    response = ask_torsion(PAIR, "--speeds", speeds)["response"]
    for worst in (response["shafts"][0]["worst"], response["free_end_worst"]):
        assert worst.get("edge") == edge
        assert worst["speed_rpm"] == pytest.approx(at, rel=2e-3)


def test_no_vibration_is_largest_nowhere():
    held = chain_text({"a": 1, "b": 1, "c": 1}, {"ab": 1e5, "bc": 1e5}, [("a", 1, 1)], loss=0.02, fixed=["b"])
    first, second = ask_torsion(held, "--speeds", "500:900:100")["response"]["shafts"]
    assert "edge" in first["worst"]
    assert second["worst"]["half_peak_to_peak_Nm"] == 0
    assert "edge" not in second["worst"]


@pytest.mark.parametrize(
    ("speeds", "outside"),
    [
        ("1249:1500:10", [1000]),  # 0.8 * 1249 rpm is just below the critical speed
        ("1251:1500:10", []),
        ("700:834:1", [1000]),  # 1.2 * 834 rpm is just above it
        ("700:833:1", []),
        ("1000:1500:10", []),  # it is inside, at the first speed
        ("1001:1667:1", [1000, 2000]),
    ],
)
def test_critical_speeds_within_a_fifth_of_the_range_are_told(speeds, outside):
    answer = ask_torsion(PAIR, "--speeds", speeds)
    assert [each["speed_rpm"] for each in answer["criticals_outside"]] == pytest.approx(outside, rel=1e-12)
    inside = [each["speed_rpm"] for each in answer["criticals"]]
    assert not set(outside) & set(inside)


def test_a_critical_speed_outside_has_mode_order_and_phase_sum():
    (outside,) = ask_torsion(PAIR, "--speeds", "1010:1300:10")["criticals_outside"]
    assert outside == {
        "mode": 1,
        "order": 2,
        "speed_rpm": pytest.approx(1000, rel=1e-12),
        "phase_sum": pytest.approx(1, rel=1e-12),
    }
    assert "criticals_outside" not in ask_torsion(PAIR)


def test_the_tables_tell_what_lies_at_and_beyond_the_ends():
    said = " ".join(run_here("torsion", "-", "--speeds", "1010:1300:10", stdin=PAIR).out.split())
    assert "< 1010" in said
    assert "Largest at 1010 rpm, the lowest speed: a-b, swing of a; below, more may occur. Widen" in said
    assert "Just outside: 1000 rpm (mode 1, order 2)." in said
    said = " ".join(run_here("torsion", "-", "--speeds", "700:990:10", stdin=PAIR).out.split())
    assert "> 990" in said
    assert "the highest speed: a-b, swing of a; above, more may occur." in said


def test_the_three_critical_speeds_with_most_work_on_each_side_are_named():
    """Order n meets the mode at 2000/n rpm, and order 9½ works least."""
    amplitudes = {7: 5, 7.5: 5, 8: 5, 8.5: 5, 9: 5, 9.5: 1, 10: 5}
    torques = [("a", order, amplitude) for order, amplitude in amplitudes.items()]
    text = chain_text({"a": 1, "b": 1}, {"ab": STIFFNESS}, torques, loss=0.02)
    said = " ".join(run_here("torsion", "-", "--speeds", "249:251:1", stdin=text).out.split())
    named = [f"{2000 / order:.4g} rpm (mode 1, order {name})" for order, name in OUTSIDE.items()]
    assert f"Just outside: {', '.join(named)}." in said
