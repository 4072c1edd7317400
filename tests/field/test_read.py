"""Files of runs: every mistake at once, by path, with the value and what would be right."""

from __future__ import annotations

import pytest
from support.rotors import three_runs

from balcli.errors import InputError
from balcli.field.read import parse_runs
from balcli.field.tables import make_polar


def mistakes(text: str) -> list[str]:
    with pytest.raises(InputError) as caught:
        parse_runs(text, "runs.toml")
    return [str(problem) for problem in caught.value.problems]


def with_first(old: str, new: str) -> str:
    return three_runs().replace(old, new, 1)


CASES = [
    (
        with_first('"53 @ 78"', '"5,3 @ 78"'),
        'run.1.readings: the 2nd value "5,3 @ 78" is no amplitude @ angle in degrees; write it like "170 @ 112"; decimals take a point, thousands no comma',
    ),
    (
        with_first('"53 @ 78"', '"53"'),
        'run.1.readings: the 2nd value "53" is no amplitude @ angle in degrees; write it like "170 @ 112"',
    ),
    (
        with_first('"53 @ 78"', "53"),
        'run.1.readings: the 2nd value 53 is no amplitude @ angle in degrees; write it like "170 @ 112"',
    ),
    (
        with_first('"53 @ 78"', '"53 µm @ 78°"'),
        'run.1.readings: the 2nd value "53 µm @ 78°" names a unit, which stands once at the head of the file: write "53 @ 78", and unit = "µm" there',
    ),
    (
        with_first("1.15 @ 0", "1.15 oz in @ 0"),
        'run.2.weights.front: "1.15 oz in @ 0" names a unit, which stands once at the head of the file: write "1.15 @ 0", and weight_unit = "oz in" there',
    ),
    (
        three_runs("influence = [['1 um/g @ 0', '2 @ 0']]"),
        'influence.1: the 1st value "1 um/g @ 0" is no amplitude @ angle in degrees; write it like "0.0155 @ 113"',
    ),
    (
        with_first('"53 @ 78"', '"-53 @ 78"'),
        'run.1.readings: the 2nd value "-53 @ 78" has a negative amplitude; leave the minus out, turn the angle by 180 degrees',
    ),
    (
        with_first('"53 @ 78"', '"1e99 @ 78"'),
        'run.1.readings: the 2nd value "1e99 @ 78" is too large or small; amplitudes are 0 or 1e-12 to 1e+12, angles up to 1e+06 degrees',
    ),
    (
        with_first('"53 @ 78"', '"1e-13 @ 78"'),
        'run.1.readings: the 2nd value "1e-13 @ 78" is too large or small; amplitudes are 0 or 1e-12 to 1e+12, angles up to 1e+06 degrees',
    ),
    (
        with_first('"53 @ 78"', '"nan @ 78"'),
        'run.1.readings: the 2nd value "nan @ 78" is no amplitude @ angle in degrees; write it like "170 @ 112"',
    ),
    (
        with_first(', "53 @ 78"', ""),
        "run.2.readings: has 2 readings, but run.1 has 1; give one for each sensor, in the same order in every run",
    ),
    (
        with_first("1.15 @ 0", "0 @ 0"),
        'run.2.weights.front: "0 @ 0" is a weight of 0, which has no effect; give the weight that was on, or leave the plane out',
    ),
    (with_first("{ front", "{ frnt"), "run.2.weights.frnt: is no plane; did you mean front?"),
    (with_first("{ front", "{ x"), "run.2.weights.x: is no plane; there are front, rear"),
    (
        with_first('{ front = "1.15 @ 0" }', "3"),
        'run.2.weights: 3 is not a table; write it like { front = "1.15 @ 0" }',
    ),
    (
        three_runs('sensors = ["a"]'),
        "run.1.readings: has 2 readings, but sensors names 1; give one for each sensor, in the same order in every run",
    ),
    (three_runs('sensors = ["a", "a"]'), 'sensors: names "a" twice; each needs a name of its own'),
    (three_runs("radius = [200]"), "radius: has 1 value, but there are 2 planes; give one for each"),
    (
        three_runs("radius = [200, -1]"),
        'radius: the 2nd value -1 is not above 0; a length is wanted: a bare number in mm, or "90 mm" or "3.5 in", above 0',
    ),
    (three_runs("rotaton = 'lag'"), "rotaton: unknown key in a file of runs; did you mean rotation?"),
    (three_runs().replace("[[run]]", "[[runs]]"), "runs: unknown key in a file of runs; did you mean run?"),
    (with_first('planes = ["front", "rear"]', "planes = []"), "planes: is an empty list; give at least one value"),
    (
        three_runs("rotation = 'left'"),
        'rotation: "left" is not "lag" or "lead"; lag: phases count against rotation, as most '
        "instruments do; lead: with it",
    ),
    (
        three_runs("weights = 'cw'"),
        'weights: "cw" is not "with" or "against"; with: their angles go the way the rotor turns; '
        "against: the other way",
    ),
    (
        three_runs("weight_unit = 'Åg'"),  # a gram with something before it
        'weight_unit: "Åg" is no unit of weights; write g, kg, oz or lb, or of unbalances g mm or oz in',
    ),
    (
        three_runs("weight_unit = 'mm'"),
        'weight_unit: "mm" is no unit of weights; write g, kg, oz or lb, or of unbalances g mm or oz in',
    ),
    (
        three_runs("reading_weights = [1]"),
        "reading_weights: has 1 value, but there are 2 readings in a run; give one for each",
    ),
    (three_runs("places = 8"), "places: 8 is one value; give one for each plane, such as places = [8, 8]"),
    (
        three_runs("places = [4, 0]"),
        'places: the 2nd value 0 does not say where weights can go; give the number of places all round (up to 720), a list of their angles, or "free" for any angle',
    ),
    (
        three_runs("influence = [['1 @ 0', '2 @ 0']]"),
        "influence: has 1 row, but there are 2 readings; give one for each",
    ),
    (
        three_runs("influence = [['1 @ 0', '2 @ 0'], ['1 @ 0']]"),
        "influence.2: has 1 coefficient, but there are 2 planes; give one for each",
    ),
    (
        three_runs("grade = 6.3\nspeed = 3000\nradius = [1, 1]"),
        "mass: is missing; a grade permits an unbalance by it, such as mass = 120",
    ),
    (
        three_runs("grade = 6.3\nmass = 20\nspeed = 3000"),
        'radius: is missing; a grade permits an unbalance, which is weight times radius: give the radius of every plane, such as radius = [200, 200], or the weights as unbalances, with weight_unit = "g mm"',
    ),
    (three_runs("drill = [10, 10]"), "radius: is missing; a drill needs the radius of the rim, in every plane"),
    (
        three_runs("mass = 120\nshares = [1, 3]"),
        "grade: is missing; shares are of what it permits, such as grade = 6.3",
    ),
    (three_runs("deepest = [10, 10]"), "drill: is missing; deepest belongs to holes, which have a diameter"),
    (three_runs("radius = [20, 20]\ndrill = [5, 50]"), "drill: hole 2 of 50 mm is wider than its rim of radius 20 mm"),
    (
        three_runs("radius = [20, 20]\ndrill = [5, 5]\ndeepest = [10, 30]"),
        "deepest: hole 2 of 30 mm passes the axis, 20 mm below the rim",
    ),
    (three_runs(last="speed = 1500"), "run.1.speed: is missing; run.3 gives its speed, so every run must"),
    ('planes = ["a"]\n', "run: is missing; write [[run]] for every run, the rotor as found first"),
    ('planes = ["a"]\nrun = []\n', "run: is an empty list; write [[run]] for every run, the rotor as found first"),
    (
        '[[run]]\nreadings = ["1 @ 0"]\n',
        'planes: is missing; name the planes that take weights, such as planes = ["front", "rear"]',
    ),
    ('planes = ["a", "a"]\n[[run]]\nreadings = ["1 @ 0"]\n', 'planes: names "a" twice; each needs a name of its own'),
    (
        'planes = ["a\\u001b"]\n[[run]]\nreadings = ["1 @ 0"]\n',
        'planes: the 1st value "a?" is no name; use up to 200 letters, digits and signs, in quotes',
    ),
    (
        'planes = ["a"]\n[run]\nreadings = ["1 @ 0"]\n',
        "run: is one of several; write [[run]] in double brackets, once for each run",
    ),
    ('planes = ["a"]\nrun = [3]\n', "run.1: 3 stands where a table belongs; write [[run]] and its keys below it"),
    (
        'planes = ["a"]\n[[run]]\nname = "x"\n',
        'run.1.readings: is missing; give it, such as readings = ["170 @ 112", "53 @ 78"]',
    ),
]


@pytest.mark.parametrize(("text", "message"), CASES)
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


def test_a_broken_key_of_the_head_hides_nothing_else():
    head = "most = [60, 60, 60]\ndrill = [0, 1]\ngrade = 6.3\nmass = 'x'\nspeed = 3000"
    assert [message.partition(";")[0] for message in mistakes(three_runs(head))] == [
        "drill: the 1st value 0 is not above 0",
        'mass: "x" is not a number followed by a unit',
        "most: has 3 values, but there are 2 planes",
        "radius: is missing",
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
