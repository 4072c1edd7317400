"""Files of runs: every mistake at once, by path, with the value and what would be right."""

import pytest
from support.cases import cases
from support.rotors import three_runs

from balcli.errors import InputError
from balcli.field_balancing.runs_file import make_polar, parse_runs


def mistakes(text: str) -> list[str]:
    with pytest.raises(InputError) as caught:
        parse_runs(text, "runs.toml")
    return [str(problem) for problem in caught.value.problems]


@cases("field_balancing/read", "every_mistake_of_a_file_of_runs_is_told", RUNS=three_runs("# head"))
def test_every_mistake_of_a_file_of_runs_is_told(text, message):
    assert message in mistakes(text)


def test_several_mistakes_are_told_at_once():
    found = mistakes(
        three_runs("rotaton = 'lag'\nradius = ['1 kg', 2]").replace("1.15 @ 0", "0 @ 0").replace("53 @", "")
    )
    assert [message.partition(":")[0] for message in found] == [
        "rotaton",
        "radius.1",
        "run.1.readings.2",
        "run.2.weights.front",
        "run.3.weights.rear",
    ]


def test_contradictions_are_told_once_all_values_can_be_read():
    head = "most = [60, 60, 60]\ndrill = [{}, 1]\ngrade = 6.3\nmass = 'x'\nspeed = 3000"
    found = [message.partition(";")[0] for message in mistakes(three_runs(head.format(0)))]
    assert found == ["drill.1: 0 is not above 0", 'mass: "x" is not a number followed by a unit']
    found = [message.partition(";")[0] for message in mistakes(three_runs(head.format(1).replace("'x'", "3")))]
    assert found == ["most: has 3 values, but there are 2 planes", "radius: is missing"]


def test_too_many_of_anything_is_refused():
    with pytest.raises(InputError, match="30 mistakes") as caught:
        parse_runs('planes = ["a"]\n' + '[[run]]\nreadings = ["x"]\n' * 30)
    assert caught.value.more == 10
    runs = 'planes = ["a"]\n' + '[[run]]\nreadings = ["1 @ 0"]\n' * 501
    assert mistakes(runs) == ["run: is given 501 times; at most 500 are read"]
    planes = ", ".join(f'"p{k}"' for k in range(51))
    assert "planes" in mistakes(f'planes = [{planes}]\n[[run]]\nreadings = ["1 @ 0"]\n')[0]
    assert mistakes("planes = [")[0].startswith("is not valid TOML")


@pytest.mark.parametrize("text", ["170@112", " 170 @ 112 deg ", "1.7e2 @ 112°", "170 @ -248"])
def test_ways_to_write_a_reading(text):
    (one,) = parse_runs(f'planes = ["a"]\n[[run]]\nreadings = ["{text}"]\n').run[0].readings
    assert one == pytest.approx(make_polar(170, 112), rel=1e-14)
    assert [make_polar(2, angle) for angle in (0, 90, 180, 270, 360, -90)] == [2, 2j, -2, -2j, 2, -2j]


@pytest.mark.parametrize("grade", ['"G6.3"', '"G 6.3"', '"g6.3"'])
def test_a_grade_may_be_written_with_its_letter(grade):
    assert parse_runs(three_runs(f"grade = {grade}")).grade == 6.3
