"""Numbers of an engine file by dotted names: found, read, replaced."""

from __future__ import annotations

from fractions import Fraction

import pytest
from support.engines import GOOD, changed
from support.paths import ENGINES

from balcli.engine.parse import parse as load
from balcli.errors import BalcliError
from balcli.studies.parameters import find_numbers, ladder, parse_parameter

DEVICES = """
[[shaft]]
ratio = -2
unbalance = 9000
at = [-40, 60]
[[counterweight]]
mass = 2
radius = 30
[cylinder.3]
piston_mass = 0.51
"""


def values(text: str, engine: str = GOOD) -> list[float]:
    return parse_parameter(text, load(engine)).values.tolist()


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ("rod.length=" + "1" * 5000, "is not a number followed by a unit; a length is wanted: "),
        ("rod.length=1:" + "1" * 5000 + ":1", "is not a number followed by a unit; a length"),
        ("rod.length=1e999", '"rod.length=1e999": has too large a number'),
    ],
)
def test_numbers_beyond_number_are_refused_in_words(asked, told):
    with pytest.raises(BalcliError) as caught:
        parse_parameter(asked, load(GOOD))
    assert told in str(caught.value)
    assert len(str(caught.value)) < 300


def test_range_includes_its_end_and_has_no_accumulated_error() -> None:
    found = values("rod.ratio=0.1:0.4:0.1")
    assert found == [0.1, 0.2, 0.3, 0.4]  # repeated addition gives 0.30000000000000004


@pytest.mark.parametrize(
    ("asked", "wanted"),
    [
        ("piston.mass=500 g:700 g:100 g", [0.5, 0.6, 0.7]),
        ("crank.spacing=3in:5in:0.1in", [float(Fraction(254 * k, 100)) for k in range(30, 51)]),
        ("piston.mass=1 oz:20 oz:1 oz", [float(k * Fraction("0.028349523125")) for k in range(1, 21)]),
        ("operation.speed=10 Hz:100 Hz:10 Hz", [600.0 * k for k in range(1, 11)]),
        ("crank.splay=0:1/7 turn:1/70 turn", [float(Fraction(360 * k, 70)) for k in range(11)]),
    ],
)  # fmt: skip
def test_a_range_with_units_includes_its_end_too(asked: str, wanted: list[float]) -> None:
    """An inch is 25.4 mm, an ounce 28.349523125 g, both exactly: not one of them is rounded."""
    assert values(asked) == wanted


def test_long_range_is_correctly_rounded_everywhere() -> None:
    found = ladder(Fraction("0.1"), Fraction("0.001"), 100_000)
    assert found[::7919].tolist() == [float(Fraction("0.1") + k * Fraction("0.001")) for k in range(0, 100_000, 7919)]


def test_values_beyond_exact_whole_numbers_are_correctly_rounded_too() -> None:
    step = Fraction(1, 3**40)
    assert ladder(Fraction(1, 7), step, 5).tolist() == [float(Fraction(1, 7) + k * step) for k in range(5)]


def test_range_may_fall() -> None:
    assert values("crank.stroke=90:80:-5") == [90, 85, 80]


def test_list_keeps_its_order_and_figures_may_bear_units() -> None:
    assert values("crank.stroke=3.5 in,80,0.1 m") == [88.9, 80, 100]


@pytest.mark.parametrize(
    "path", ["crank.throws.4", "rod.cg", "operation.speed", "cylinder.4.piston_mass", "cylinder.1.throw"]
)
def test_numbers_that_the_file_has_or_might_have(path: str) -> None:
    assert values(f"{path}=1,2") == [1, 2]


@pytest.mark.parametrize(
    "path", ["shaft.1.unbalance", "shaft.1.at.2", "counterweight.1.radius", "cylinder.3.piston_mass"]
)
def test_numbers_of_devices_and_cylinders(path: str) -> None:
    assert values(f"{path}=1,2", GOOD + DEVICES) == [1, 2]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rod.raito=0.2,0.3", "rod.raito: unknown parameter; did you mean rod.ratio?"),
        ("crank.throws.5=0", "crank.throws.5: unknown parameter; did you mean crank.throws.4?"),
        ("shaft.1.ratio=1,2", "shaft.1.ratio: unknown parameter"),
        ("rod.ratio", '"rod.ratio": give a number of the engine file and its values, such as rod.ratio=0.24:0.32:0.01'),
        ("rod.ratio=", '"rod.ratio=": has no values; give some, such as 0.24,0.28 or 0.24:0.32:0.01'),
        ("rod.ratio=0.2:0.3", '"rod.ratio=0.2:0.3": a range is from:to:step, such as 0.24:0.32:0.01'),
        ("rod.ratio=0.2:0.3:0", '"rod.ratio=0.2:0.3:0": the step is 0; give the distance of neighbouring values'),
        ("rod.ratio=0.3:0.2:0.1", '"rod.ratio=0.3:0.2:0.1": has 0 values'),
        ("rod.ratio=0:1:1e-300", '"rod.ratio=0:1:1e-300": has 1'),
        ("rod.ratio=0.2:1.4:0.2", "rod.ratio: 1.4 is not below 1; a plain number is wanted"),
        ("piston.mass=-1,2", "piston.mass: -1 is less than 0; a mass is wanted"),
        ("piston.mass=heavy", '"piston.mass=heavy": "heavy" is not a number followed by a unit; a mass is wanted'),
    ],
)
def test_mistakes_in_words(text: str, message: str) -> None:
    with pytest.raises(BalcliError) as caught:
        values(text)
    assert str(caught.value).startswith(message)


def test_a_bank_angle_is_that_of_a_vee() -> None:
    """An in-line four would become a V8, a W9 a V6."""
    vee = changed(("firing_order = [1, 3, 4, 2]", "banks = [-30, 60]"))
    assert "layout.bank_angle" in find_numbers(load(vee))
    for other in (GOOD, changed(("firing_order = [1, 3, 4, 2]", "banks = [-60, 0, 60]"))):
        with pytest.raises(BalcliError, match=r"^layout\.bank_angle: unknown parameter"):
            parse_parameter("layout.bank_angle=0:90:10", load(other))


def test_firing_intervals_vary_together_or_not_at_all() -> None:
    """They add up to a cycle: with one of them changed, no file could say the rest."""
    text = GOOD.replace("[layout]", "[layout]\nfiring_intervals = [180, 180, 180, 180]")
    with pytest.raises(BalcliError, match=r"1: firing intervals add up to a cycle, so that none varies alone$"):
        parse_parameter("layout.firing_intervals.1=170,180", load(text))


def test_more_values_than_are_kept_are_refused_before_there_are_any() -> None:
    with pytest.raises(BalcliError) as found:
        parse_parameter("rod.ratio=0.2:0.3:1e-10", load(GOOD))
    assert str(found.value) == (
        '"rod.ratio=0.2:0.3:1e-10": has 1 000 000 001 values; give a step with 1 to 10 000 000 '
        "values from the first to the last"
    )


def test_names_that_begin_as_an_unknown_one_are_told():
    """A vee's `bank` is its bank angle rather than that of one cylinder."""
    with pytest.raises(BalcliError) as caught:
        parse_parameter("bank=30,60", load((ENGINES / "vtwin45.toml").read_text()))
    assert str(caught.value) == (
        "bank: unknown parameter; did you mean layout.bank_angle or cylinder.1.bank or cylinder.2.bank?"
    )


@pytest.mark.parametrize(
    ("name", "meant"), [("rod_length", "rod.length?"), ("rod", "rod.length or rod.ratio or rod.mass or ")]
)
def test_a_name_of_the_whole_engine_comes_before_that_of_one_cylinder(name, meant):
    """Every cylinder has a `rod_length` of its own, too: with one of them varied, the others stay."""
    with pytest.raises(BalcliError) as caught:
        parse_parameter(f"{name}=120,130", load(GOOD))
    assert str(caught.value).startswith(f"{name}: unknown parameter; did you mean {meant}")


def test_a_figure_that_stands_for_all_axes_of_a_mount_varies_as_one():
    text = (ENGINES / "i4_mounts.toml").read_text()
    left = text.replace("stiffness = [190, 90, 90]", "stiffness = 140", 1)
    assert "mount.left.stiffness" not in find_numbers(load(text))
    assert {"mount.left.stiffness", "mount.left.stiffness.2"} <= find_numbers(load(left)).keys()
