"""Mistakes in [body], [[mount]] and [[point]]: all at once, by path, with what would be right."""

from __future__ import annotations

import pytest
from support.commands import run_here
from support.mounts import ENGINE, block
from support.paths import write

from balcli.errors import InputError
from balcli.mounting.read import read_mounted

CASES = [
    (ENGINE, 'body: is missing; give it, such as "[body]" and "mass = 163.9" below it'),
    (ENGINE, "mount: is missing; write [[mount]] for every mount"),
    (
        block().replace('name = "2"', 'name = "1"'),
        'mount.2.name: "1" is also the name of mount.1; each needs one of its own',
    ),
    (block().replace("8e6, 12e6", "-8e6, 12e6"), "body: inertia xx is -8e+06; a moment of inertia is above 0"),
    (
        block().replace("14e6, 0, 0, 0]", "14e6, 0, 13e6, 0]"),
        "body: inertia yz is 1.3e+07; beside yy and zz it must be within 1.29615e+07",
    ),
    (
        block().replace("14e6, 0, 0, 0]", "14e6, 9e6, 9e6, -9e6]"),
        "body: inertia xy, yz and zx are together too large: the tensor is not positive definite "
        "(they are elements of the matrix: products of inertia with minus)",
    ),
    (
        block().replace("gravity = [0, 0, -1]", "gravity = [0, 0, 0]"),
        "body: gravity [0, 0, 0] has no direction; leave it out for -x, downwards",
    ),
    (block("axes = [[1, 0, 0], [1, 1, 0]]"), "mount.1: axes are 45 degrees apart; they must be perpendicular"),
    (
        block("axes = [[0, 0, 0], [1, 1, 0]]"),
        "mount.1: axes has a direction of length 0; give two directions such as [0, 1, 0]",
    ),
    (
        block().replace("[200, 150, 400]", "[0, 0, 0]"),
        "mount.3: stiffness [0, 0, 0] holds nothing; give at least one above 0",
    ),
    (
        block().replace("[200, 150, 400]", "[200, 150]"),
        "mount.4.stiffness: [200, 150] has 2 values where 3 are wanted: static, along its three own axes",
    ),
    (block("loss = -0.1"), "mount.1.loss: -0.1 is less than 0; a plain number is wanted, without quotes, 0 or more"),
    (block("los = 0.1"), "mount.1.los: unknown key in [mount]; did you mean loss?"),
    (
        ENGINE.replace("mass = 0.5\n", "") + block().replace("mass = 200", ""),
        "piston: has neither mass nor piston, pin, rings and locks; give either mass or piston, pin, rings and locks",
    ),
    (
        ENGINE.replace("mass = 0.5\n", "") + block().replace("mass = 200", ""),
        "body.mass: is missing; give it, such as mass = 163.9",
    ),
    (
        block("angles = [0, 0, 3]\naxes = [[1, 0, 0], [0, 1, 0]]"),
        "mount.1: has axes and angles; give either axes or angles",
    ),
]


def mistakes(tmp_path, text):
    path = write(tmp_path / "x.toml", text)
    with pytest.raises(InputError) as caught:
        read_mounted(path)
    return [str(problem) for problem in caught.value.problems]


@pytest.mark.parametrize(("text", "message"), CASES)
def test_mistakes_are_told(tmp_path, text, message):
    assert message in mistakes(tmp_path, text)


def test_a_body_without_an_engine_needs_none(tmp_path):
    path = write(tmp_path / "x.toml", block())
    assert read_mounted(path).engine is None


def test_half_an_engine_is_not_none(tmp_path):
    found = mistakes(tmp_path, "[crank]\nstroke = 90\n" + block())
    assert any(text.startswith("rod: is missing") for text in found)


def test_units_of_their_own(tmp_path):
    path = tmp_path / "x.toml"
    imperial = block().replace("[200, 150, 400]", '["1000 lbf/in", 150, "400 N/mm"]')
    path.write_text(imperial, encoding="utf-8")
    assert read_mounted(path).model.mount[0].stiffness == pytest.approx((175.12683524647636, 150, 400), rel=1e-12)


def test_moments_that_no_body_has_are_doubted(tmp_path):
    path = write(tmp_path / "x.toml", block().replace("12e6, 14e6", "12e6, 24e6"))
    assert read_mounted(path).doubts == (
        "body.inertia: zz of 2.4e+07 is more than xx and yy together (2e+07), which no body has; are "
        "the axes right? z is the crankshaft's",
    )
    status, _, err = run_here("mounts", path)
    assert (status, err.startswith(f"warning: {path}: body.inertia: zz")) == (0, True)
    path.write_text(ENGINE.replace("speed = 3000", "speed = 30000") + block("loss = 0.1"), encoding="utf-8")
    assert "piston speed" in read_mounted(path).doubts[0]


def test_inertias_in_kg_m2_are_doubted(tmp_path):
    path = write(tmp_path / "x.toml", block().replace("8e6, 12e6, 14e6", "8, 12, 14"))
    assert read_mounted(path).doubts == (
        "body.inertia: 14 kg mm^2 is that of 200 kg within 0.26 mm, and a mount stands 539 mm away; "
        'is it in kg mm^2? Another unit is said as in "14 kg m^2"',
    )


def test_places_in_metres_are_doubted(tmp_path):
    """A point at the origin itself is no slip."""
    path = tmp_path / "x.toml"
    point = '[[point]]\nname = "seat"\nat = [0, %s, 0]\n'
    path.write_text(block() + point % "0.5", encoding="utf-8")
    assert read_mounted(path).doubts == (
        "point.1.at of 'seat' is within 0.5 mm of the origin; is it in mm? Another unit is said as in \"0.5 m\"",
    )
    for there in ("0", "1e-14"):
        path.write_text(block() + point % there, encoding="utf-8")
        assert read_mounted(path).doubts == ()


@pytest.mark.parametrize(
    ("stiffness", "sag"),  # 200 kg x g over four mounts' mean stiffness
    [("[200e3, 150e3, 400e3]", "0.002"), ("[0.2, 0.15, 0.4]", "2e+03")],
)
def test_mounts_that_give_way_like_none_are_doubted(tmp_path, stiffness, sag):
    path = write(tmp_path / "x.toml", block().replace("[200, 150, 400]", stiffness))
    assert read_mounted(path).doubts == (
        f"mount.stiffness: under its weight the body would sink by about {sag} mm, where 0.02 to 200 "
        'mm is usual; is it in N/mm? Another unit is said as in "250 kN/m"',
    )


def test_a_loss_factor_in_percent_is_doubted(tmp_path):
    path = write(tmp_path / "x.toml", block().replace("[200, 150, 400]", "[200, 150, 400]\nloss = 8"))
    told = "is 8, where at most 1 is usual; 8 % is 0.08, and of a relative damping psi the loss factor"
    assert read_mounted(path).doubts == tuple(f"mount.{k}.loss {told} is psi/(2 pi)" for k in range(1, 5))


@pytest.mark.parametrize("one", ["300", '"300 N/mm"'])
def test_one_stiffness_holds_along_all_three_axes(tmp_path, one):
    path = write(tmp_path / "body.toml", block("damping = 0.2").replace("[200, 150, 400]", one, 1))
    first, second = read_mounted(path).model.mount[:2]
    assert first.stiffness == (300, 300, 300)
    assert second.stiffness == (200, 150, 400)
    assert first.damping == (0.2, 0.2, 0.2)


def test_one_stiffness_that_cannot_be_is_told_once(tmp_path):
    path = write(tmp_path / "body.toml", block().replace("[200, 150, 400]", "-5", 1))
    with pytest.raises(InputError) as caught:
        read_mounted(path)
    told = 'a bare number in N/mm, or "350 N/mm" or "2000 lbf/in", 0 or more'
    assert [str(problem) for problem in caught.value.problems] == [
        f"mount.1.stiffness: -5 is less than 0; a stiffness is wanted: {told}"
    ]
