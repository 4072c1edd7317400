"""Mistakes in [body], [[mount]] and [[point]]: all at once, by path, with what would be right."""

import pytest
from support.cases import cases
from support.mounts import ENGINE, block
from support.paths import write

from balcli.errors import InputError
from balcli.mounting.build import read_mounted


def mistakes(tmp_path, text):
    with pytest.raises(InputError) as caught:
        read_mounted(write(tmp_path / "x.toml", text))
    return [str(problem) for problem in caught.value.problems]


@cases("mounting/read", "mistakes_are_told", ENGINE=ENGINE, BLOCK=block("# more"))
def test_mistakes_are_told(tmp_path, text, message):
    assert message in mistakes(tmp_path, text)


@cases("mounting/read", "doubts", BLOCK=block())
def test_doubts(tmp_path, text, doubt):
    found = read_mounted(write(tmp_path / "x.toml", text))[2]
    assert [str(each) for each in found] == ([doubt] if doubt else [])


def test_half_an_engine_is_not_none(tmp_path):
    assert read_mounted(write(tmp_path / "x.toml", block()))[1] is None
    found = mistakes(tmp_path, "[crank]\nstroke = 90\n" + block())
    assert any(text.startswith("rod: is missing") for text in found)


@pytest.mark.parametrize(
    ("written", "wanted"),
    [
        ('["1000 lbf/in", 150, "400 N/mm"]', (175.12683524647636, 150, 400)),
        ("300", (300, 300, 300)),
        ('"300 N/mm"', (300, 300, 300)),
    ],
)
def test_stiffness_in_other_units_and_along_all_axes(tmp_path, written, wanted):
    path = write(tmp_path / "x.toml", block("damping = 0.2").replace("[200, 150, 400]", written, 1))
    first, second = read_mounted(path)[0].mount[:2]
    assert first.stiffness == pytest.approx(wanted, rel=1e-12)
    assert second.stiffness == (200, 150, 400)
    assert first.damping == (0.2, 0.2, 0.2)
