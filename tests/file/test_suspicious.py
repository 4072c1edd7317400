"""Warnings: silent for ordinary engines, and the whole text for each that is given."""

import pytest
from support.cases import cases
from support.engines import GOOD, build_text, changed
from support.paths import ENGINE_FILES

from balcli.engine.parse import parse
from balcli.file import examples as new
from balcli.file.assumed import Assumed
from balcli.file.doubt import Doubt, name_files
from balcli.file.doubts import find_suspicious

FREE = ("firing_order = [1, 3, 4, 2]\n", "")  # no firing order, which throws would have to fit
DEGREES = (
    'bare numbers are degrees; give another unit as in "1/2 turn" or "3.1416 rad"; a sequence '
    "of cylinders belongs in layout.firing_order"
)
LAMBDA = (
    "where 0.15 to 0.4 is usual; crank.stroke is twice the crank radius, rod.length the distance between its centres"
)


def list_doubts(text):
    """The doubts about a file, in words."""
    return [str(doubt) for doubt in find_suspicious(parse(text))]


@pytest.mark.parametrize("text", [GOOD, *map(new.template, new.ENGINE_KINDS)], ids=["good", *new.ENGINE_KINDS])
def test_ordinary_engines_pass(text):
    assert find_suspicious(parse(text)) == []


def test_one_throw_may_stand_at_the_origin_unsaid():
    """With both rods of a vee on it."""
    own = "".join(f"[cylinder.{n}]\nposition = {z}\n" for n, z in ((1, -60), (3, -60)))
    vee = changed(
        ("spacing = 100\n", ""),
        ("throws = [0, 180, 180, 0]", "throws = [0, 180]"),
        ("firing_order = [1, 3, 4, 2]", "bank_angle = 90"),
    )
    assert find_suspicious(parse(vee + own)) == []


@cases("file/suspicious", "warnings", DEGREES=DEGREES, FREE=FREE, LAMBDA=LAMBDA)
def test_warnings(changes, more, warning):
    assert list_doubts(changed(*changes, more=more)) == [warning]


@pytest.mark.parametrize(("key", "value"), [("intake", 14.7), ("exhaust", 0.101), ("crankcase", 14.7)])
def test_gas_of_no_engine_is_doubted(key, value):
    """Psi and MPa for bar."""
    gas = f'[gas]\ncycle = "otto"\ncompression_ratio = 10\nimep = 9\n{key} = {value}\n'
    told = 'where 0.15 to 12 is usual; is it in bar? Give another unit as in "130 psi" or "0.9 MPa"'
    assert list_doubts(changed(more=gas)) == [f"gas.{key}: {value:g} bar absolute, {told}"]


def test_engines_of_the_project_are_of_usual_size():
    """Places of cylinders and masses at the crank pin: no engine of the folder is doubted."""
    assert len(ENGINE_FILES) > 60
    doubts = {file.name: find_suspicious(parse(file.read_text("utf-8"))) for file in ENGINE_FILES}
    assert {name: told for name, told in doubts.items() if told} == {}


@pytest.mark.parametrize(
    ("layout", "doubted"),
    [
        ("", True),
        ("bank_angle = 90\n", True),
        ("firing_order = [1, 3, 4, 2]\n", False),
        ("radial = 5\n", False),
    ],
)
def test_a_spacing_without_several_throws_is_doubted(layout, doubted):
    """A four whose firing order was forgotten: it was a single, and nothing said so."""
    text = changed(("throws = [0, 180, 180, 0]\n", ""), ("firing_order = [1, 3, 4, 2]\n", layout))
    told = (
        "crank.throws: is not given, and one throw is taken, although the file has crank.spacing, for several throws; "
        "give layout.firing_order, or the angle of every throw"
    )
    assert list_doubts(text) == [told] * doubted
    assert list_doubts(text.replace("spacing = 100\n", "")) == []
    assert (Assumed("crank.throws", (0.0,), "deg") in build_text(text).list_assumed()) == doubted


def test_a_stiffness_between_throws_without_throws_is_doubted():
    text = changed(("throws = [0, 180, 180, 0]\n", ""), ("firing_order = [1, 3, 4, 2]\n", ""), more=TWIST)
    [doubt] = find_suspicious(parse(text))
    assert doubt.also == ("crank.spacing", "torsion.throw_stiffness")
    assert "the file has crank.spacing and torsion.throw_stiffness, for several throws" in str(doubt)


TWIST = """
[torsion]
throw_stiffness = 1e6
throw_inertia = 25000
[[torsion.rear]]
name = "Flywheel"
inertia = 250000
stiffness = 1e6
"""
LIGHT = "where 89 to 89000000 is usual; is it in kg mm^2? Give another unit as in "


@cases("file/suspicious", "inertias_in_kg_m2_are_asked_back", LIGHT=LIGHT)
def test_inertias_in_kg_m2_are_asked_back(more, told):
    assert "\n".join(list_doubts(changed(more=more))) == told


def test_loss_factors_in_percent_are_asked_back():
    more = TWIST.replace("[torsion]\n", "[torsion]\nloss = 3.5\n", 1)
    told = "where at most 0.5 is usual; {} % is {}, and a relative damping psi is a loss factor of"
    assert list_doubts(changed(more=more + "loss = 1.13\n")) == [
        f"torsion.loss: 3.5, {told.format(3.5, 0.035)} psi/(2 pi)",
        f"torsion.rear.1.loss: 1.13, {told.format(1.13, 0.0113)} psi/(2 pi)",
    ]


@pytest.mark.parametrize(("loss", "doubted"), [(0.5, False), (0.51, True)])
def test_relative_dampings_as_loss_factors_of_shafts_are_asked_back(loss, doubted):
    more = TWIST.replace("[torsion]\n", f"[torsion]\nloss = {loss}\n", 1)
    assert any(told.startswith("torsion.loss: 0.51,") for told in list_doubts(changed(more=more))) is doubted


def test_a_flywheel_that_torsion_lacks():
    """[flywheel] is for `torque`; without one of its own the crankshaft twists at far higher frequencies."""
    wheel = "[flywheel]\ninertia = 250000\n"
    alone = TWIST.partition("[[torsion.rear]]")[0]
    assert list_doubts(changed(more=wheel + alone)) == [
        "torsion.rear: is missing; `torsion` does not use [flywheel]: also write it as [[torsion.rear]]"
    ]
    assert find_suspicious(parse(changed(more=wheel + TWIST))) == []
    assert find_suspicious(parse(changed(more=alone))) == []


# ------------------------------------------------------------------ records
@pytest.mark.parametrize(
    ("number", "concerned"),
    [
        ("crank.throws", True),
        ("crank.throws.2", True),
        ("crank.throw_mass", False),
        ("layout.bank_angle", True),
        ("layout.bank", False),
        ("crank", False),
    ],
)
def test_a_doubt_concerns_its_keys_and_their_members(number, concerned):
    assert Doubt("crank.throws", "3 deg", ("layout.bank_angle",)).concerns(number) is concerned
    assert not Doubt("", "the free end swings").concerns(number)


def test_a_file_that_is_named_twice_is_doubted_once():
    doubt = Doubt("rod.cg", "-45 mm")
    named = name_files([("a.toml", [doubt]), ("b.toml", [doubt]), ("a.toml", [doubt])])
    assert [str(each) for each in named] == ["a.toml: rod.cg: -45 mm", "b.toml: rod.cg: -45 mm"]
    assert str(Doubt("", "the free end swings")) == "the free end swings"
