"""Mistakes in [body], [[mount]] and [[point]]: all at once, by path, with what would be right."""

from __future__ import annotations

import pytest
from support.mounts import ENGINE, block
from support.paths import write

from balcli.errors import InputError
from balcli.mounts.build import read_mounted

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


@pytest.mark.parametrize("one", ["300", '"300 N/mm"'])
def test_one_stiffness_holds_along_all_three_axes(tmp_path, one):
    path = write(tmp_path / "body.toml", block("damping = 0.2").replace("[200, 150, 400]", one, 1))
    first, second = read_mounted(path).model.mount[:2]
    assert first.stiffness == (300, 300, 300)
    assert second.stiffness == (200, 150, 400)
    assert first.damping == (0.2, 0.2, 0.2)
