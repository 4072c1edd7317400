"""Mistakes in [body], [[mount]] and [[point]]: all at once, by path, with what would be right."""

from __future__ import annotations

import pytest
from support.cases import cases
from support.mounts import ENGINE, block
from support.paths import write

from balcli.errors import InputError
from balcli.mounts.build import read_mounted


def mistakes(tmp_path, text):
    path = write(tmp_path / "x.toml", text)
    with pytest.raises(InputError) as caught:
        read_mounted(path)
    return [str(problem) for problem in caught.value.problems]


@cases("mounts/read", "mistakes_are_told", ENGINE=ENGINE, BLOCK=block("# more"))
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
