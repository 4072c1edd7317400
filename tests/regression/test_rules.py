"""[check] of an engine file: tolerances by quantity, limits that fail the check, and mistakes in both."""

import json

import pytest
from support.commands import run_here
from support.engines import GOOD, build_text, changed
from support.gas_engines import PETROL_FOUR
from support.paths import ENGINES, write

from balcli import load
from balcli.errors import InputError
from balcli.regression.rules import read_rules


def problems(rules, text=GOOD):
    """Mistakes in [check] as texts."""
    with pytest.raises(InputError) as caught:
        read_rules(build_text(text + rules), "x.toml", None)
    return [str(problem) for problem in caught.value.problems]


# ------------------------------------------------------------------ tolerances
HEAVIER = changed(("mass = 0.5", "mass = 0.505"))  # forces grow by 0.75 %, torque and roll by up to 2.2 %


@pytest.mark.parametrize(
    ("options", "rules", "strongest"),
    [
        ((), "", 1e-9),
        ((), "[check]\ntolerance = 1e-3\n", 1e-3),
        (("--tolerance", "1e-4"), "[check]\ntolerance = 1e-3\n", 1e-4),
        (("--tolerance", "1e-4"), "[check.tolerance]\nall = 1e-3\nforce = 1e-5\n", 1e-5),
    ],
    ids=["default", "the file's for all", "the command's", "the file's for a quantity"],
)
def test_which_tolerance_counts(check, file, edit_record, options, rules, strongest):
    """The recorded force of order 2 is changed by a little less, and by a little more than the tolerance."""
    file.write_text(GOOD + rules)
    expected = file.parent / "expected" / "four.json"
    largest = json.loads(expected.read_text())["peak"]["force_N"]
    for factor, status in ((0.9, 0), (1.1, 1)):
        before = expected.read_text()
        edit_record(file, lambda d, f=factor: d["orders"][1]["force_N"].update(minor=f * strongest * largest))
        assert check(file, *options)[0] == status
        expected.write_text(before)


@pytest.mark.parametrize(
    ("tolerance", "moved"),
    [
        ('force = "1 %"', {"torque", "roll"}),
        ('"force" = "1 %"', {"torque", "roll"}),
        ("force = 0.01", {"torque", "roll"}),
        ("force = 0.001", {"force", "torque", "roll"}),
        ('all = "3 %"', set()),
        ('all = "3 %"\nroll = 1e-6', {"roll"}),
        ('force = "1 %"\ntorque = "3 %"\nroll = "3 %"', set()),
        ('force = "1 %"\ntorque = "3 %"\nroll.2.amplitude = "3 %"', {"roll"}),  # roll of other orders moves as well
        ('force = "9 N"\ntorque = "1 kN m"\nroll = "1 kN m"', {"force"}),
        ('force = "0.3 kN"\ntorque = "1 kN m"\nroll = "1 kN m"', set()),
    ],
)
def test_tolerances_by_quantity(check, file, tolerance, moved):
    """A quantity's tolerance holds for all its figures: of all orders, or of one, with components and axes."""
    file.write_text(f"{HEAVIER}[check.tolerance]\n{tolerance}\n")
    engine = json.loads(check(file, "-f", "json")[1])["engines"][0]
    assert {each["cause"] for each in engine["differences"]} == moved


def test_a_tolerance_for_one_order(check, file):
    file.write_text(HEAVIER + '[check.tolerance]\nforce.2.major = "1 %"\n')
    engine = json.loads(check(file, "-f", "json")[1])["engines"][0]
    forces = {each["figure"] for each in engine["differences"] if each["cause"] == "force"}
    assert "order 4 force major" in forces
    assert not any("order 2" in figure for figure in forces)


def test_tolerances_of_gas_torque_and_mean_torque(check, tmp_path):
    """`torque` of an engine with gas is the whole torque and that of inertia."""
    engine = write(tmp_path / "petrol.toml", PETROL_FOUR)
    check("--update", engine)
    text = PETROL_FOUR.replace("imep = 12", "imep = 12.001")
    assert check(write(engine, text))[0] == 1
    rules = "[check.tolerance]\ntorque = 0.001\ngas = 0.001\nroll_total = 0.001\nfluctuation = 0.001\n"
    assert check(write(engine, text + rules)) == (0, "1 engine, as recorded\n", "")
    assert check(write(engine, f'{text}{rules}"torque.mean" = 1e-6\n'))[1].splitlines()[1].startswith("  torque mean")


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("forse = 0.1", "forse: is not recorded; did you mean force?"),
        ("guide.6.H = 0.1", "guide.6.H: is not recorded; a record has figures of force, moment, couple, torque, roll"),
        ("force.x = 0.1", "force.x: force.x is not a quantity: after force comes an order up to 4096"),
        ("force.2.majr = 0.1", "force.2.majr: force.2.majr is not a quantity: did you mean major?"),
        ("force = 5", 'force: 5 is not a share from 0 to 1, such as 1e-6 or "0.1 %"'),
        ("force = -1e-9", "force: -1e-09 is not a share from 0 to 1"),
        ('force = "120 %"', "force: 1.2 is not a share from 0 to 1"),
        ('force = "5 mm"', 'force: "5 mm" is a length, but a force is wanted'),
        ('force = "-5 N"', 'force: "-5 N" is less than 0; a force is wanted'),
        ('peak = "5 N"', 'peak: "5 N" is not a share; give a number or percentage: "0.1 %"'),
        ('all = "5 N"', 'all: "5 N" is not a share; give a number or percentage: "0.1 %"'),
        (
            '"force.2" = 1e-3\n"force.2.major" = 1e-3',
            "force.2.major: is the second tolerance of force.2; leave one out",
        ),
    ],
)
def test_mistakes_in_tolerances(line, problem):
    (found,) = problems(f"[check.tolerance]\n{line}\n")
    assert found.startswith(f"check.tolerance.{problem}")


# ------------------------------------------------------------------ limits
FIRED = (ENGINES / "i4_wiebe.toml").read_text(encoding="utf-8").replace("speed = 4000", "speed = 3000")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """The file of an engine with gas whose result is recorded; limits do not change it."""
    file = write(tmp_path_factory.mktemp("recorded") / "i4.toml", FIRED)
    assert run_here("check", "--update", file).status == 0
    return file


@pytest.mark.parametrize(
    ("limit", "shown"),
    [
        ("force.2.major = { below = 3606 }", "force.2.major is 3606.29 N; limit: below 3606 N"),
        ('force.2.major = { below = "3.6 kN" }', "force.2.major is 3606.29 N; limit: below 3600 N"),
        ("force.2.major = { above = 3607, below = 5000 }", "limit: above 3607 and below 5000 N"),
        ("piston.mean_speed = { below = 8.6 }", "piston.mean_speed is 8.6 m/s; limit: below 8.6 m/s"),
        ('piston.stroke = { below = "85 mm" }', "piston.stroke is 0.086 m; limit: below 0.085 m"),
        ("force.1.axis = { below = 5 }", "force.1.axis has no value; limit: below 5 deg"),
        ("torque.mean = { above = 207 }", "torque.mean is 206.718 N·m; limit: above 207 N·m"),
    ],
)
def test_a_quantity_beyond_its_limit_fails_the_check(check, recorded, limit, shown):
    engine = write(recorded, f"{FIRED}[check.limits]\n{limit}\n")
    status, out, err = check(engine)
    line = len(engine.read_text().splitlines())
    first, last = out.splitlines()
    assert (status, err) == (1, "")
    assert first.startswith(f"{engine}:{line}: {limit.partition(' ')[0]} ")
    assert first.endswith(shown)
    assert last == "1 engine: 1 as recorded, 1 beyond a limit"


def test_both_sides_of_a_limit(check, file):
    """A limit is not reached: below 1000 and above 1000 exclude 1000 itself."""
    for speed, status in (("999.99", 0), ("1000", 1), ("1000.01", 1)):
        file.write_text(changed(("speed = 3000", f"speed = {speed}")) + "[check.limits]\npiston.mean_speed.below = 3\n")
        assert check(file, "--update")[0] == status
        assert check(file)[0] == status


def test_limits_in_json(check, file):
    file.write_text(GOOD + '[check.limits]\n"peak.force" = { below = 100 }\n')
    (broken,) = json.loads(check(file, "-f", "json")[1])["engines"][0]["broken_limits"]
    assert broken["value"] > 1000
    del broken["value"]
    assert broken == {"quantity": "peak.force", "unit": "N", "below": 100.0, "above": None, "line": 19}


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("force.2.majr = { below = 1 }", "force.2.majr: force.2.majr is not a quantity: did you mean major?"),
        ("forse.2.major = { below = 1 }", "forse.2.major: forse.2.major is not a quantity: did you mean force?"),
        ('force.2.major = { below = "1 kg" }', 'force.2.major: "1 kg" is a mass, but a force is wanted'),
        ("force.2.major = { below = 1, above = 2 }", "force.2.major: no value is above 2 and below 1"),
        ("mode.1.Hz = { above = 8 }", "mode.1.Hz: mode.1.Hz: the file has no [body]"),
        ("gas.2.amplitude = { above = 8 }", "gas.2.amplitude: gas.2.amplitude: the engine file has no [gas]"),
        ('"force.2.major,peak.force" = { below = 8 }', "force.2.major,peak.force: names several quantities"),
    ],
)
def test_mistakes_in_limits(line, problem):
    (found,) = problems(f"[check.limits]\n{line}\n")
    assert found.startswith(f"check.limits.{problem}")


@pytest.mark.parametrize(
    ("rules", "problem"),
    [
        ("[check]\ntolerances = 1", "check.tolerances: unknown key in [check]; did you mean tolerance?"),
        ("[check]\ntolerance = true", "check.tolerance.all: true is not a figure; give a number, or text with a unit"),
        ("[check]\ntolerance = nan", "check.tolerance.all: nan is not a finite number"),
        ("[check.limits]\nforce.2.major = 5", "check.limits.force.2.major: 5 is not a limit; write { below = … }"),
        ("[check.limits]\nforce.2.major = {}", "check.limits.force.2.major: gives no limit; write { below = … }"),
        (
            "[check.limits]\nforce.2.major = { below = 5, abov = 1 }",
            "check.limits.force.2.major.abov: unknown key in [check.limits]; did you mean above?",
        ),
        ("[check]\nlimits = 5", "check.limits: 5 is not a table; write it in braces with its keys"),
    ],
)
def test_the_form_of_the_table_is_checked_like_that_of_any_other(rules, problem):
    with pytest.raises(InputError) as caught:
        build_text(f"{GOOD}{rules}\n")
    assert str(caught.value.problems[0]).startswith(problem)
    assert len(caught.value.problems) == 1


def test_other_commands_ignore_names_of_quantities(balcli, tmp_path):
    """An unknown quantity is reported by `check`, the only command that knows what it needs."""
    engine = write(tmp_path / "x.toml", GOOD + "[check.limits]\nforse.2.major.below = 5\n")
    plain = write(tmp_path / "y.toml", GOOD)
    for command in (("analyze", "-f", "json"), ("numbers",)):
        assert balcli(command[0], engine, *command[1:])[:2] == balcli(command[0], plain, *command[1:])[:2]
    assert balcli("check", engine)[0] == 2
    varied = load(engine).vary({"rod.length": 170})
    assert varied.model.check.limits["forse.2.major"].below == 5
