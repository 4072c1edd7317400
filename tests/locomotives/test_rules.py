"""Rules of a locomotive: figures by hand, each formula at two points of each argument, which of two places holds, and
both sides of each limit.
"""

import math

import pytest
import tomli_w
from support.commands import ask, ask_csv
from support.engines import list_problems

from balcli import BalcliError, load, locomotive

TABLES = {
    "crank": {"stroke": 600, "throws": [0, 90], "positions": [-300, 300], "throw_mass": 250},
    "rod": {"motion": "harmonic"},
    "piston": {"mass": 300},
    "locomotive": {"planes": [-750, 750], "radius": 800, "wheel_diameter": 2000, "wheel_load": 4e4, "factor": 0.6},
    "operation": {"speed": 240},
}
LEVER = math.hypot(0.7, 0.3)  # parts of cranks 1 and 2 in the first plane: 1.05 m and 0.45 m of 1.5 m, at right angles


def change(**parts):
    """The tables with some keys changed; a key that is None is left out."""
    tables = dict(TABLES)
    for name, part in parts.items():
        tables[name] = part
        if isinstance(part, dict):
            table = TABLES.get(name, {}) | part
            tables[name] = {key: value for key, value in table.items() if value is not None}
    return {name: part for name, part in tables.items() if part}


def balance(factor=None, speed=None, hammer_blow=None, **parts):
    return locomotive(load(change(**parts)), factor, speed=speed, hammer_blow=hammer_blow)


# ------------------------------------------------------------------ figures by hand
def test_a_locomotive_by_hand():
    """Two cranks at right angles, 0.6 m apart between wheels 1.5 m apart; half of its figures do not depend on speed."""
    found = balance()
    square = (8 * math.pi) ** 2
    blow = 0.6 * 300 * 0.3 * square * LEVER
    first, second = found.wheels
    assert first.hammer_blow_N == pytest.approx(blow)
    assert second.hammer_blow_N == pytest.approx(blow)
    assert found.hammer_blow_N == pytest.approx(0.6 * 300 * 0.3 * square * math.sqrt(2))
    assert [rail.hammer_blow_N for rail in found.rails] == pytest.approx([blow, blow])
    assert abs(first.unbalance) == pytest.approx((250 + 0.6 * 300) * 0.3 * LEVER)
    assert math.degrees(math.atan2(-first.unbalance.imag, -first.unbalance.real)) == pytest.approx(23.199, abs=1e-3)
    assert first.mass_kg == pytest.approx((250 + 0.6 * 300) * 0.3 * LEVER / 0.8)
    assert (first.least_rail_load_N, first.most_rail_load_N) == pytest.approx((4e4 - blow, 4e4 + blow))
    assert first.lift_rpm == pytest.approx(240 * math.sqrt(4e4 / blow))
    assert first.lift_km_h == pytest.approx(first.lift_rpm * math.pi * 2.0 * 60 / 1000)
    assert found.speed_km_h == pytest.approx(240 * math.pi * 2.0 * 60 / 1000)


@pytest.mark.parametrize("figure", ["wheel", "rail", "all wheels"])
def test_a_hammer_blow_rises_with_the_square_of_the_speed(figure):
    def measure(speed):
        found = balance(speed=speed)
        blows = {"wheel": found.wheels[0], "rail": found.rails[0], "all wheels": found}
        return blows[figure].hammer_blow_N

    assert measure(120) == pytest.approx(measure(240) / 4)


def test_the_speed_of_lifting_depends_on_load_and_mass_and_not_on_the_speed():
    def lift(**parts):
        return balance(**parts).wheels[0].lift_rpm

    usual = lift()
    assert lift(operation={"speed": 120}) == pytest.approx(usual)
    assert lift(locomotive={"wheel_load": 16e4}) == pytest.approx(2 * usual)
    assert lift(piston={"mass": 1200}) == pytest.approx(usual / 2)


@pytest.mark.parametrize(("radius", "diameter"), [(800, 2000), (400, 2000), (800, 1000)])
def test_mass_and_speed_on_the_track_follow_from_the_sizes_of_the_wheel(radius, diameter):
    wheel = balance(locomotive={"radius": radius, "wheel_diameter": diameter}).wheels[0]
    assert wheel.mass_kg * radius == pytest.approx(1e3 * abs(wheel.unbalance))
    assert wheel.lift_km_h / wheel.lift_rpm == pytest.approx(0.06 * math.pi * diameter / 1e3)


def test_the_table_has_both_ends_of_the_rail_load_and_the_size_of_each_unbalance(tmp_path):
    file = tmp_path / "locomotive.toml"
    file.write_text(tomli_w.dumps(TABLES))
    wheel = balance().wheels[0]
    told = ask("locomotive", file)
    row = next(line.split() for line in told.splitlines() if line.startswith("driving"))
    assert f"{wheel.least_rail_load_N / 1e3:.4g}…{wheel.most_rail_load_N / 1e3:.4g}" in row
    assert f"{abs(wheel.unbalance):.4g}" in row
    assert "Angles count from cylinder 1's crank pin" in told
    assert "No factor is given" not in told


def test_without_a_factor_the_table_says_so(tmp_path):
    file = tmp_path / "locomotive.toml"
    file.write_text(tomli_w.dumps(change(locomotive={"factor": None})))
    told = " ".join(ask("locomotive", file).split())
    assert "No factor is given: the figures are those of the counterweights in the file." in told


# ------------------------------------------------------------------ which of two places holds
@pytest.mark.parametrize(
    ("of_all", "own", "wanted"), [(4e4, None, 4e4), (4e4, 5e4, 5e4), (None, 5e4, 5e4), (None, None, None)]
)
def test_the_wheel_load_of_an_axle_holds_before_that_of_the_locomotive(of_all, own, wanted):
    axle = {"name": "driving", "cylinders": [1, 2]} | ({"wheel_load": own} if own else {})
    wheel = balance(locomotive={"wheel_load": of_all}, axle=[axle]).wheels[0]
    loads = wheel.least_rail_load_N, wheel.most_rail_load_N
    if wanted is None:
        assert loads == (None, None)
    else:
        assert sum(loads) / 2 == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("of_file", "given", "wanted"),
    [(0.6, None, 0.6), (0.6, 0.4, 0.4), (None, 0.4, 0.4), (None, None, None), (0.6, 0, 0)],
)
def test_a_factor_that_is_given_holds_before_that_of_the_file(of_file, given, wanted):
    assert balance(given, locomotive={"factor": of_file}).factor == wanted


@pytest.mark.parametrize(
    ("of_file", "given", "wanted"), [(240, None, 240), (240, 120, 120), (None, 120, 120), (None, None, None)]
)
def test_a_speed_that_is_given_holds_before_that_of_the_file(of_file, given, wanted):
    operation = {"speed": of_file}
    if wanted is None:
        with pytest.raises(BalcliError, match=r"locomotive\.speed: is missing"):
            balance(speed=given, operation=operation)
    else:
        assert balance(speed=given, operation=operation).speed_rpm == wanted


# ------------------------------------------------------------------ both sides of a limit
@pytest.mark.parametrize(
    ("degrees", "doubted"), [(45, False), (45.1, True), (-45.1, True), (134.9, True), (135.1, False), (180, False)]
)
def test_a_cylinder_more_than_45_deg_from_the_track_is_doubted(degrees, doubted):
    doubts = balance(layout={"banks": [degrees]}).doubts
    assert [doubt.message.partition(" is ")[0] for doubt in doubts] == (["cylinder 1", "cylinder 2"] if doubted else [])


@pytest.mark.parametrize("speed", [0, -1])
def test_a_speed_is_above_0(speed):
    with pytest.raises(BalcliError, match=r"^speed: .* is not above 0"):
        balance(speed=speed)


def test_without_reciprocating_mass_the_whole_factor_reaches_any_hammer_blow():
    assert balance(hammer_blow=1000, piston={"mass": 0}).factor == 1


@pytest.mark.parametrize(("blow", "wanted"), [(1.01, 1), (0.99, 0.99)])
def test_a_factor_from_a_hammer_blow_is_at_most_1(blow, wanted):
    whole = balance(1).wheels[0].hammer_blow_N
    assert balance(hammer_blow=blow * whole).factor == pytest.approx(wanted)


@pytest.mark.parametrize(("factor", "hint"), [(1.5, '"1.5%"'), (100, '"100%"'), (101, "")])
def test_a_percentage_without_its_sign_is_guessed_up_to_100(factor, hint):
    (told,) = list_problems(change(locomotive={"factor": factor}))
    assert told.startswith("locomotive.factor: ")
    assert ("did you mean" in told) == bool(hint)
    assert hint in told


# ------------------------------------------------------------------ unequal wheels
def test_tables_of_factors_have_the_worst_wheel(tmp_path):
    """One axle has three times the hammer blow and twelve times the load of the other."""
    axles = [
        {"name": "leading", "cylinders": [1], "part": 3, "wheel_load": 4e4},
        {"name": "trailing", "cylinders": [2], "part": 1, "wheel_load": 4e4 / 12},
    ]
    tables = change(axle=axles)
    file = tmp_path / "two_axles.toml"
    file.write_text(tomli_w.dumps(tables))
    wheels = locomotive(load(tables)).wheels
    row = ask_csv("locomotive", file, "--factor", "0.6,0.7")[0]
    lifts = [wheel.lift_km_h for wheel in wheels]
    assert min(lifts) == pytest.approx(max(lifts) / 2)
    assert float(row["lifts at, km/h"]) == pytest.approx(min(lifts))
    assert float(row["largest mass, kg"]) == pytest.approx(max(wheel.mass_kg for wheel in wheels))
    assert float(row["wheel blow, N"]) == pytest.approx(max(wheel.hammer_blow_N for wheel in wheels))
    slowest = min(wheel.lift_rpm for wheel in wheels)
    assert f"The first wheel lifts at {min(lifts):.4g} km/h, {slowest:.4g} rpm." in " ".join(
        ask("locomotive", file).split()
    )
