"""Files of runs: every mistake at once, by path, with the value and what would be right."""

from __future__ import annotations

import pytest
from support.cases import cases
from support.rotors import three_runs

from balcli.errors import InputError
from balcli.field.read import parse_runs
from balcli.field.tables import make_polar


def mistakes(text: str) -> list[str]:
    with pytest.raises(InputError) as caught:
        parse_runs(text, "runs.toml")
    return [str(problem) for problem in caught.value.problems]


@cases("field/read", "every_mistake_of_a_file_of_runs_is_told", RUNS=three_runs("# head"))
def test_every_mistake_of_a_file_of_runs_is_told(text, message):
    assert message in mistakes(text)


def test_several_mistakes_are_told_at_once():
    found = mistakes(
        three_runs("rotaton = 'lag'\nradius = ['1 kg', 2]").replace("1.15 @ 0", "0 @ 0").replace("53 @", "")
    )
    assert [message.partition(":")[0] for message in found] == [
        "rotaton",
        "radius",
        "run.1.readings",
        "run.2.weights.front",
        "run.3.weights.rear",
    ]


def test_all_broken_keys_of_the_head_are_listed():
    head = "most = [60, 60, 60]\ndrill = [0, 1]\ngrade = 6.3\nmass = 'x'\nspeed = 3000"
    assert [message.partition(";")[0] for message in mistakes(three_runs(head))] == [
        "drill: the 1st value 0 is not above 0",
        'mass: "x" is not a number followed by a unit',
    ]


def test_a_run_without_readings_hides_no_wrong_plane():
    found = mistakes('planes = ["front"]\nrun = [{ readings = ["5 @ 3"] }, { weights.fornt = "3 @ 0" }]')
    assert found == [
        'run.2.readings: is missing; give it, such as readings = ["170 @ 112", "53 @ 78"]',
        "run.2.weights.fornt: is no plane; did you mean front?",
    ]


def test_only_the_first_twenty_are_shown():
    text = 'planes = ["a"]\n' + '[[run]]\nreadings = ["x"]\n' * 30
    with pytest.raises(InputError) as caught:
        parse_runs(text)
    assert str(caught.value).startswith("engine: 30 mistakes") or "30 mistakes" in str(caught.value)
    assert caught.value.more == 10


def test_too_many_of_anything_is_refused():
    runs = 'planes = ["a"]\n' + '[[run]]\nreadings = ["1 @ 0"]\n' * 501
    assert mistakes(runs) == ["run: stands 501 times; at most 500 are taken"]
    planes = ", ".join(f'"p{k}"' for k in range(51))
    assert "planes" in mistakes(f'planes = [{planes}]\n[[run]]\nreadings = ["1 @ 0"]\n')[0]


def test_toml_that_is_none():
    assert mistakes("planes = [")[0].startswith("is not valid TOML")


@pytest.mark.parametrize("text", ["170@112", " 170 @ 112 deg ", "1.7e2 @ 112°", "170 @ -248"])
def test_ways_to_write_a_reading(text):
    (one,) = parse_runs(f'planes = ["a"]\n[[run]]\nreadings = ["{text}"]\n').run[0].readings
    assert one == pytest.approx(make_polar(170, 112), rel=1e-14)


def test_quarters_are_exact():
    assert [make_polar(2, angle) for angle in (0, 90, 180, 270, 360, -90)] == [2, 2j, -2, -2j, 2, -2j]


def test_a_run_that_cannot_be_read_makes_up_no_mistake_of_influence():
    """Its speed is one of two, each with its rows."""
    text = """
        planes = ["front"]
        influence = [["1 @ 0"], ["2 @ 0"]]
        [[run]]
        speed = 1000
        readings = ["3 @ 0"]
        [[run]]
        speed = 2000
        readings = ["4"]
        """
    assert mistakes(text) == [
        'run.2.readings: the 1st value "4" is no amplitude @ angle in degrees; write it like "170 @ 112"'
    ]
