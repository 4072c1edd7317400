"""Numbers of an engine file by dotted names: found, read, replaced."""

from fractions import Fraction

import pytest
from support.cases import cases
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
    ("asked", "wanted"),
    [
        ("rod.ratio=0.1:0.4:0.1", [0.1, 0.2, 0.3, 0.4]),  # repeated addition gives 0.30000000000000004
        ("crank.stroke=90:80:-5", [90, 85, 80]),
        ("crank.stroke=3.5 in,80,0.1 m", [88.9, 80, 100]),
        ("piston.mass=500 g:700 g:100 g", [0.5, 0.6, 0.7]),
        ("crank.spacing=3in:5in:0.1in", [float(Fraction(254 * k, 100)) for k in range(30, 51)]),
        ("piston.mass=1 oz:20 oz:1 oz", [float(k * Fraction("0.028349523125")) for k in range(1, 21)]),
        ("operation.speed=10 Hz:100 Hz:10 Hz", [600.0 * k for k in range(1, 11)]),
        ("crank.splay=0:1/7 turn:1/70 turn", [float(Fraction(360 * k, 70)) for k in range(11)]),
    ],
)  # fmt: skip
def test_a_range_includes_its_end_and_figures_may_have_units(asked: str, wanted: list[float]) -> None:
    """An inch is 25.4 mm, an ounce 28.349523125 g, both exactly: not one of them is rounded."""
    assert values(asked) == wanted


def test_ranges_are_correctly_rounded_everywhere() -> None:
    found = ladder(Fraction("0.1"), Fraction("0.001"), 100_000)
    assert found[::7919].tolist() == [float(Fraction("0.1") + k * Fraction("0.001")) for k in range(0, 100_000, 7919)]
    step = Fraction(1, 3**40)  # beyond whole numbers that are exact
    assert ladder(Fraction(1, 7), step, 5).tolist() == [float(Fraction(1, 7) + k * step) for k in range(5)]


def test_numbers_that_the_file_has_or_might_have() -> None:
    might = ("crank.throws.4", "rod.cg", "operation.speed", "cylinder.4.piston_mass", "cylinder.1.throw")
    has = ("shaft.1.unbalance", "shaft.1.at.2", "counterweight.1.radius", "cylinder.3.piston_mass")
    for path in (*might, *has):
        assert values(f"{path}=1,2", GOOD + DEVICES) == [1, 2]


@cases("studies/parameters", "mistakes", LONG="1" * 5000)
def test_mistakes_in_words(text: str, message: str) -> None:
    with pytest.raises(BalcliError) as caught:
        values(text)
    assert message in str(caught.value)
    assert len(str(caught.value)) < 600


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
    with pytest.raises(BalcliError, match=r"1: firing intervals add up to a cycle, so that a single one cannot vary$"):
        parse_parameter("layout.firing_intervals.1=170,180", load(text))


def test_a_figure_that_stands_for_all_axes_of_a_mount_varies_as_one():
    text = (ENGINES / "i4_mounts.toml").read_text()
    left = text.replace("stiffness = [190, 90, 90]", "stiffness = 140", 1)
    assert "mount.left.stiffness" not in find_numbers(load(text))
    assert {"mount.left.stiffness", "mount.left.stiffness.2"} <= find_numbers(load(left)).keys()
