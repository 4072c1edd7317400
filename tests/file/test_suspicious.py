"""Warnings: silent for ordinary engines, and the whole text for each that is given."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.engines import GOOD, changed

from balcli.engine.parse import parse
from balcli.file import examples as new
from balcli.file.doubts import find_suspicious

FREE = ("firing_order = [1, 3, 4, 2]\n", "")  # no firing order, which throws would have to fit
DEGREES = (
    'bare numbers are degrees, another unit is said as in "1/2 turn" or "3.1416 rad", and numbers of '
    "cylinders stand in layout.firing_order"
)
LAMBDA = (
    "where 0.15 to 0.4 is usual; crank.stroke is twice the crank radius, rod.length the distance of its two centres"
)


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


@pytest.mark.parametrize(
    ("changes", "more", "warning"),
    [
        ([("mass = 0.5", "mass = 65"), ("bore = 86", "bore = 80"), ("mass = 0.6", "mass = 60")], "", "piston.mass is 65 kg in a bore of 80 mm, where 0.051 to 2.6 is usual; are the units right? Bare numbers are kg and mm"),
        ([("spacing = 100\n", "")], "[cylinder.2]\nposition = -50\n", "cylinder.2.position is given, but 3 cylinders have no place and all stand at 0: give the position of each, or crank.spacing"),
        ([("mass = 0.5\n", "piston = 0.4\npin = 0.1\nrings = 3.6\nlocks = 0\n")], "", "the parts of [piston] weigh 4.1 kg in a bore of 86 mm, where 0.064 to 3.2 is usual; are the units right? Bare numbers are kg and mm"),
        ([("mass = 0.5", "mass = 0")], "", "piston.mass is 0: only the rod moves to and fro; give the mass of piston, pin, rings and locks"),
        # no bore: that of 0.2 to 3 strokes of 90 mm, by 100 and 5000 kg per m^3 of its cube
        ([("mass = 0.5", "mass = 500"), ("bore = 86\n", ""), ("mass = 0.6", "mass = 600")], "", "piston.mass is 500 kg at a stroke of 90 mm, where 0.00058 to 98 is usual; are the units right? Bare numbers are kg and mm"),
        ([("[0, 180, 180, 0]", "[1, 3, 4, 2]"), FREE], "", f"crank.throws: the largest difference of two is 3 deg, where at least 10 is usual; {DEGREES}"),
        ([("[0, 180, 180, 0]", "[0, 3.14159, 3.14159, 0]"), FREE], "", f"crank.throws: the largest difference of two is 3.142 deg, where at least 10 is usual; {DEGREES}"),
        ([("length = 160", "length = 100")], "", f"crank radius / rod length is 0.45, {LAMBDA}"),
        ([("length = 160", "ratio = 0.99999"), ("cg = 45", "cg = 15")], "", f"crank radius / rod length is 0.99999, {LAMBDA}"),
        ([("length = 160", "ratio = 0.1")], "", f"crank radius / rod length is 0.1, {LAMBDA}"),
        ([("bore = 86", "bore = 300"), ("spacing = 100", "spacing = 400"), ("mass = 0.5", "mass = 20"), ("mass = 0.6", "mass = 16")], "", "piston.bore / crank.stroke is 3.333, where 0.2 to 3 is usual; are both in the same unit?"),
        ([("mass = 0.6\ncg = 45", "small_end = 1.2\nbig_end = 3.8")], "", "the rod weighs 5 kg, 10 times the piston, where 0.1 to 8 is usual; are both in the same unit?"),
        ([("cg = 45\n", "")], "", "rod.cg is not given: all of the rod counts at the crank pin; measure it from the big-end centre"),
        ([("cg = 45", "cg = -45")], "", "rod.cg is -45 mm, where 0 to 88 is usual; it is measured from the big-end centre; the small end is at 160 mm"),
        ([("cg = 45", "cg = 115")], "", "rod.cg is 115 mm, where at most 88 is usual; it is measured from the big-end centre; the small end is at 160 mm"),
        ([("mass = 0.6\ncg = 45", "small_end = 0.42\nbig_end = 0.18")], "", "rod.small_end is 0.42 kg, where at most 0.33 is usual; are small_end and big_end exchanged?"),
        ([("cg = 45", "cg = 45\ninertia = 0.0023")], "", "rod.inertia is 0.0023 kg mm^2, where 310 to 6100 is usual; it is taken about the centre of mass, in kg mm^2"),
        ([("speed = 3000", "speed = 3.000")], "", "operation.speed is 3 rpm, where at least 9 is usual; a point parts decimals, not thousands"),
        ([("speed = 3000", "speed = 30000")], "", "the mean piston speed is 90 m/s, where at most 40 is usual; are operation.speed and crank.stroke right?"),
        ([("bore = 86", "bore = 86\noffset = -20")], "", "piston.offset is -20 mm, where -18 to 18 is usual; is it in mm?"),
        # 5 x (4 x 0.8 + 4 x (0.5 + 0.6)) kg x 45 mm
        ([], "[[counterweight]]\nunbalance = 10\n[[counterweight]]\nmass = 40\nradius = 60\n", "counterweight.2: its unbalance is 2.4e+06 g mm, where at most 1700000 is usual; is it in g mm?"),
        ([], '[gas]\ncycle = "otto"\ncompression_ratio = 10\nimep = 130\n', 'gas.imep is 130 bar, where at most 60 is usual; is it in bar? Another unit is said as in "130 psi" or "0.9 MPa"'),
        # all of a forged two-litre crankshaft
        ([("throw_mass = 0.8", "throw_mass = 16")], "", "crank.throw_mass is 16 kg, where at most 6.6 is usual; is it in kg? It is what one throw has off the axis, not what the crankshaft weighs"),
        ([], "[bobweight]\nrod_bearing = 47\noil = 0.004\n", 'bobweight.rod_bearing is 47 kg, where at most 0.55 is usual; is it in kg? Grams are said as in "47 g"'),
        ([], "[bobweight]\nrod_bearing = 0.047\noil = 4\n", 'bobweight.oil is 4 kg, where at most 0.55 is usual; is it in kg? Grams are said as in "47 g"'),
    ],
)  # fmt: skip
def test_warnings(changes, more, warning):
    assert find_suspicious(parse(changed(*changes, more=more))) == [warning]


BAR = ' bar absolute, where %s is usual; is it in bar? Another unit is said as in "130 psi" or "0.9 MPa"'


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("intake", 14.7, BAR % "0.15 to 12"),
        ("exhaust", 0.101, BAR % "0.15 to 12"),
        ("crankcase", 14.7, BAR % "0.15 to 12"),
    ],
)  # fmt: skip
def test_gas_of_no_engine_is_doubted(key, value, told):
    """Psi and MPa for bar."""
    gas = {"cycle": '"otto"', "compression_ratio": 10, "imep": 9} | {key: value}
    text = "\n".join(f"{name} = {figure}" for name, figure in gas.items())
    assert find_suspicious(parse(changed(more=f"[gas]\n{text}\n"))) == [f"gas.{key} is {value:g}{told}"]


@pytest.mark.parametrize("throws", ["[0, 0, 0, 0]", "[0, 0.5, 0, 0]", "[0, 20, 40, 60]"])
def test_throws_side_by_side_are_no_slip(throws):
    assert find_suspicious(parse(changed(("[0, 180, 180, 0]", throws), FREE))) == []


ENGINES = Path(__file__).parents[2] / "engines"


def test_engines_of_the_project_are_of_usual_size():
    """Places of cylinders and masses at the crank pin: no engine of the folder is doubted."""
    files = sorted(ENGINES.rglob("*.toml"))
    assert len(files) > 60
    doubts = {file.name: find_suspicious(parse(file.read_text("utf-8"))) for file in files}
    assert {name: told for name, told in doubts.items() if told} == {}


def test_moving_masses_count_every_rod_of_a_vee():
    """A weight that would be too much for four rods is not for the eight of a vee, nor for a
    radial's nine.
    """
    weight = "[[counterweight]]\nunbalance = 2.4e6\n"
    assert len(find_suspicious(parse(changed(more=weight)))) == 1
    assert find_suspicious(parse(changed(("firing_order = [1, 3, 4, 2]", "bank_angle = 90"), more=weight))) == []
    assert find_suspicious(parse(changed(("firing_order = [1, 3, 4, 2]", "radial = 9"), more=weight))) == []
    alternating = 'banks = [-90, 90]\nrods = "alternating"'
    assert len(find_suspicious(parse(changed(("firing_order = [1, 3, 4, 2]", alternating), more=weight)))) == 1


TWIST = """
[torsion]
throw_stiffness = 1e6
throw_inertia = %s
[[torsion.rear]]
name = "Flywheel"
inertia = %s
stiffness = 1e6
"""


LIGHT = "where at least 89 is usual; is it in kg mm^2? Another unit is said as in "


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ("[flywheel]\ninertia = 1.15\n", f'flywheel.inertia is 1.15 kg mm^2, {LIGHT}"1.15 kg m^2"'),
        (
            "[flywheel]\nmass = 12\nradius_of_gyration = 0.14\n",
            f'flywheel.inertia is 0.2352 kg mm^2, {LIGHT}"0.2352 kg m^2"',
        ),
        (TWIST % ("20000", "250000"), ""),
        ("[flywheel]\ninertia = 100\n", ""),
    ],
)
def test_inertias_in_kg_m2_are_asked_back(more, told):
    assert "\n".join(find_suspicious(parse(changed(more=more)))) == told


def test_loss_factors_in_percent_are_asked_back():
    more = (TWIST % ("20000", "250000")).replace("[torsion]\n", "[torsion]\nloss = 3.5\n", 1)
    told = "where at most 1 is usual; {} % is {}, and of a relative damping psi the loss factor is"
    assert find_suspicious(parse(changed(more=more + "loss = 1.13\n"))) == [
        f"torsion.loss is 3.5, {told.format(3.5, 0.035)} psi/(2 pi)",
        f"torsion.rear.1.loss is 1.13, {told.format(1.13, 0.0113)} psi/(2 pi)",
    ]


def test_a_crank_in_kg_m2_is_asked_back():
    crank = changed(("throw_mass = 0.8", "throw_mass = 0.8\ninertia = 0.09"))
    (told,) = find_suspicious(parse(crank))
    assert told == f'crank.inertia is 0.09 kg mm^2, {LIGHT}"0.09 kg m^2"'


def test_a_flywheel_that_torsion_lacks():
    """[flywheel] is for `torque`; without one of its own the crankshaft twists at far higher
    frequencies.
    """
    wheel, twist = "[flywheel]\ninertia = 250000\n", TWIST % ("25000", "250000")
    alone = twist.partition("[[torsion.rear]]")[0]
    assert find_suspicious(parse(changed(more=wheel + alone))) == [
        "[flywheel] counts for `torque`, not for `torsion`; write it as [[torsion.rear]], too"
    ]
    assert find_suspicious(parse(changed(more=wheel + twist))) == []
    assert find_suspicious(parse(changed(more=alone))) == []
