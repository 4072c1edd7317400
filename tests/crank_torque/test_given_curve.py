"""A given torque curve: figures by hand, both sides of each limit, what holds with a load and without."""

import math

import numpy as np
import pytest
from support.paths import write

from balcli import BalcliError
from balcli.core.piecewise import polyline
from balcli.crank_torque import given_curve
from balcli.crank_torque.given_curve import analyze_curve, doubt_period, read_curve


def make_curve(degrees, torques):
    return polyline(np.radians(degrees), np.array(torques, float))


def read_rows(folder, *rows):
    lines = "\n".join(f"{angle!r},{torque!r}" for angle, torque in rows)
    return read_curve(write(folder / "curve.csv", f"angle_deg,torque_Nm\n{lines}\n"))


def make_triangle(period=360.0, highest=1000.0):
    """From 0 to the highest torque in the middle of the period, and back."""
    return make_curve([0, period / 2, period], [0, highest, 0])


# ------------------------------------------------------------------ rows of a file
def test_a_period_is_above_0_and_angles_may_stay(tmp_path):
    for rows in ([(0.0, 1.0), (0.0, 2.0)], [(10.0, 1.0), (350.0, 2.0), (10.0, 1.0)]):
        with pytest.raises(BalcliError, match="needs two rising angles"):
            read_rows(tmp_path, *rows)
    step = read_rows(tmp_path, (0.0, 0.0), (90.0, 0.0), (90.0, 100.0), (360.0, 100.0))
    assert step.mean == pytest.approx(75)


def test_angles_reach_to_a_million_degrees(tmp_path):
    assert read_rows(tmp_path, (999_640.0, 1.0), (1e6, 1.0)).period == pytest.approx(2 * math.pi)
    with pytest.raises(BalcliError, match="beyond 1e\\+06 deg"):
        read_rows(tmp_path, (999_640.0, 1.0), (1_000_000.5, 1.0))


@pytest.mark.parametrize(
    ("period", "doubted"),
    [
        *((360, False), (720, False), (1080, False), (144, False), (102.86, False), (51.43, False)),
        *((359, True), (719, True), (143, True), (102.9, True), (540, True)),
    ],
)
def test_a_period_is_whole_turns_or_720_deg_over_a_whole_number(period, doubted):
    """Angles in a file are rounded: 102.86 deg is 720/7."""
    assert len(list(doubt_period(make_triangle(period)))) == doubted


# ------------------------------------------------------------------ orders
@pytest.mark.parametrize(
    ("period", "orders"),
    [
        *((360, list(range(1, 13))), (720, [k / 2 for k in range(1, 25)]), (120, [3, 6, 9, 12])),
        *((40, [9, 18]), (30, [12, 24])),  # at least two
    ],
)
def test_orders_up_to_12_are_shown(period, orders):
    found = analyze_curve("x", make_triangle(period)).orders
    assert [line.order for line in found] == pytest.approx(orders)


def test_at_most_512_harmonics_are_shown():
    assert len(analyze_curve("x", make_triangle(360 * 42)).orders) == 504
    assert len(analyze_curve("x", make_triangle(360 * 43)).orders) == 512


def test_an_order_between_those_of_the_period_is_refused():
    with pytest.raises(BalcliError, match=r"^order 0\.5: a period of 1080 deg has only multiples of 0\.333333$"):
        analyze_curve("x", make_triangle(1080), orders=[1, 0.5])


def test_orders_reach_to_the_highest_harmonic(monkeypatch):
    """Of which there are 64 here: order 16 of 4 turns is the last, and order 21 of 3 turns the last but one."""
    monkeypatch.setattr(given_curve, "HIGHEST_HARMONIC", 64)
    for turns, order in ((4, 16), (3, 21)):
        (line,) = analyze_curve("x", make_triangle(360 * turns), orders=[order]).orders
        assert line.order == order
    with pytest.raises(BalcliError, match=r"^order 22: 3 turns have only orders up to 21$"):
        analyze_curve("x", make_triangle(1080), orders=[22])


# ------------------------------------------------------------------ energy, power, flywheel
def test_a_triangle_by_hand():
    """Half the area above the mean is a triangle of 500 N m over half a turn: 250 pi J. Its speed at 2 kg m2 and 30 rad/s
    varies by 250 pi/(2 30^2).
    """
    speed = 30 * 30 / math.pi
    found = analyze_curve("x", make_triangle(), speed_rpm=speed, inertia=2.0)
    assert found.mean_torque_Nm == pytest.approx(500)
    assert found.power_W == pytest.approx(500 * 30)
    assert found.energy.surplus_J == pytest.approx(250 * math.pi)
    assert (found.energy.from_deg, found.energy.to_deg) == pytest.approx((90, 270))
    assert found.flywheel.fluctuation_small == pytest.approx(250 * math.pi / (2 * 30**2))
    assert found.flywheel.fluctuation == pytest.approx(250 * math.pi / (2 * 30**2), rel=2e-2)
    faster = analyze_curve("x", make_triangle(), speed_rpm=2 * speed, inertia=2.0)
    heavier = analyze_curve("x", make_triangle(), speed_rpm=speed, inertia=4.0)
    stronger = analyze_curve("x", make_triangle(highest=2000), speed_rpm=speed, inertia=2.0)
    for other, share in ((faster, 1 / 4), (heavier, 1 / 2), (stronger, 2)):
        assert other.flywheel.fluctuation_small == pytest.approx(share * found.flywheel.fluctuation_small)
    assert found.flywheel.speed_max_deg == pytest.approx(270)
    assert found.flywheel.speed_min_deg == pytest.approx(90)


def test_inertia_that_is_needed_gives_the_fluctuation():
    speed = 30 * 30 / math.pi
    needed = analyze_curve("x", make_triangle(), speed_rpm=speed, fluctuation=0.02).flywheel.needed_kg_m2
    assert needed == pytest.approx(250 * math.pi / (0.02 * 30**2), rel=1e-3)
    found = analyze_curve("x", make_triangle(), speed_rpm=speed, inertia=needed).flywheel
    assert found.fluctuation == pytest.approx(0.02)


@pytest.mark.parametrize(("fluctuation", "good"), [(9e-10, False), (1e-9, True), (1.99, True), (2, False)])
def test_a_fluctuation_is_below_2(fluctuation, good):
    """One that is good lacks only the speed."""
    with pytest.raises(BalcliError) as refused:
        analyze_curve("x", make_triangle(), fluctuation=fluctuation)
    assert ("needs the mean speed" in str(refused.value)) == good


def test_a_load_takes_its_part_of_energy_and_speed():
    """Power and orders remain those of the torque; where the load is the torque itself, the speed is even."""
    load = make_curve([0, 360], [500, 500])
    plain, constant, equal = (
        analyze_curve("x", make_triangle(), each, speed_rpm=300, inertia=2.0) for each in (None, load, make_triangle())
    )
    assert constant.energy.surplus_J == pytest.approx(plain.energy.surplus_J)
    assert constant.flywheel.fluctuation == pytest.approx(plain.flywheel.fluctuation)
    assert equal.flywheel.fluctuation == pytest.approx(0, abs=1e-12)
    assert equal.energy.surplus_J == pytest.approx(0, abs=1e-9)
    assert equal.power_W == constant.power_W == plain.power_W
    sizes = [[line.torques.torque_Nm.amplitude for line in each.orders] for each in (equal, plain)]
    assert sizes[0] == sizes[1]
    assert plain.load_Nm is None
    assert constant.load_Nm == (pytest.approx(500), 0)


def test_a_varying_load_slows_the_shaft_where_it_is_large():
    """The load has the shape of a constant torque's opposite: surplus from 270 to 90 deg."""
    found = analyze_curve("x", make_curve([0, 360], [500, 500]), make_triangle(), speed_rpm=300, inertia=2.0)
    assert found.energy.surplus_J == pytest.approx(250 * math.pi)
    assert (found.energy.from_deg, found.energy.to_deg) == pytest.approx((270, 90))


@pytest.mark.parametrize(("mean", "counted"), [(2e-3, True), (5e-4, False)])
def test_a_mean_below_a_millionth_of_the_largest_torque_is_0(mean, counted):
    """The largest torque of the two curves, 1000 N m, is that of the torque."""
    torque = make_curve([0, 90, 270, 360], [0, 1000, -1000, 0])
    load = make_curve([0, 360], [mean, mean])
    share, rest = analyze_curve("x", torque, load).load_Nm
    assert share == pytest.approx(mean if counted else 0, abs=1e-15)
    assert rest == pytest.approx(-mean if counted else 0, abs=1e-12)


@pytest.mark.parametrize("period", [360.001, 720])
def test_torque_and_load_have_one_period(period):
    with pytest.raises(BalcliError, match="give both over the same angle"):
        analyze_curve("x", make_triangle(), make_triangle(period))
    assert analyze_curve("x", make_triangle(720), make_triangle(720)).cycle_deg == 720
