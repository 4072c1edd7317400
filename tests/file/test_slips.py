"""What people type by mistake, and what balcli makes of it: understood, or answered with the right word."""

import re
import tomllib
from pathlib import Path

import pytest
from support.cases import cases
from support.commands import ask, refusal, run_here
from support.engines import GOOD, changed
from support.gas_engines import PETROL_FOUR
from support.mounts import block
from support.paths import write
from support.rotors import three_runs

from balcli import load
from balcli.engine.parse import parse
from balcli.errors import InputError
from balcli.file.doubts import find_suspicious
from balcli.file.examples import template
from balcli.file.units import LENGTH, SPEED, convert

NOT_TOML = "is not valid TOML: "
ORDER = "firing_order = [1, 3, 4, 2]"
THROWS = "throws = [0, 180, 180, 0]"


def told(*changes, args=()):
    return run_here("analyze", "-", "--only", "verdict", *args, stdin=changed(*changes))


@cases("file/slips", "a_line_that_is_no_toml_is_shown_with_what_it_should_be")
def test_a_line_that_is_no_toml_is_shown_with_what_it_should_be(old, new, answer):
    err = told((old, new)).err
    assert NOT_TOML in err
    assert err.endswith(f"{answer}\n")


def test_what_can_mean_one_thing_only_is_understood():
    for old, *others in ((ORDER, 'firing_order = "1-3-4-2"', 'firing_order = "1, 3, 4, 2"'), ("= 90", '= "90 MM"')):
        assert {told((old, new)) for new in others} == {told()}


def test_units_in_capitals_and_the_mark_of_inches():
    assert convert("6000 RPM", SPEED) == 6000
    assert convert('3.5"', LENGTH) == convert("3.5 ″", LENGTH) == convert("3.5 in", LENGTH)
    with pytest.raises(ValueError, match="is not a number followed by a unit"):
        convert('"', LENGTH)


def test_an_example_of_a_list_is_of_its_key():
    err = told((ORDER, "firing_order = 5")).err
    assert err.endswith("5 is not a list; write it in square brackets, such as [1, 3, 4, 2]\n")


@cases("file/slips", "other_words_for_a_key_lead_to_it")
def test_other_words_for_a_key_lead_to_it(old, new, meant):
    text = changed() if old in GOOD else f"{GOOD}\n[operation]\n"
    assert meant in run_here("analyze", "-", stdin=text.replace(old, new, 1)).err


COUNT = "the number of cylinders follows from throws and banks; give every throw its angle, such as"
WIEBE = {"cycle": "wiebe", "compression_ratio": 10, "imep": 9}


@cases("file/slips", "keys_of_newcomers_are_answered_with_what_to_write_instead", COUNT=COUNT, WIEBE=WIEBE)
def test_keys_of_newcomers_are_answered_with_what_to_write_instead(keys, answer):
    tables = tomllib.loads(GOOD)
    for name, value in keys.items():
        tables[name] = tables.get(name, {}) | value if isinstance(value, dict) else value
    with pytest.raises(InputError) as error:
        load(tables)
    assert str(error.value).partition(": ")[2].startswith(answer)


@cases("file/slips", "files_words_and_options_that_were_nearly_right")
def test_files_words_and_options_that_were_nearly_right(command, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "ford.toml", GOOD)
    (tmp_path / "sub").mkdir()
    assert re.search(message, run_here(*command.split()).err.removeprefix("balcli: ").removesuffix("\n"))


def test_other_spellings_of_options_and_words(tmp_path):
    file = write(tmp_path / "ford.toml", GOOD)
    slow = ask("analyze", file, "--rpm", "900", "--only", "force")
    assert slow == ask("analyze", file, "--speed", "900", "--only", "forces", "--units", "SI")


def test_a_crosshead_engine_is_ordinary():
    slow = parse(
        "[crank]\nstroke = 2000\n[rod]\nlength = 2214\nmass = 1600\ncg = 800\n"
        "[piston]\nbore = 500\nmass = 4800\n[layout]\nstrokes = 2\n[operation]\nspeed = 124\n"
    )
    assert find_suspicious(slow) == []


def test_the_head_says_two_or_four_strokes_where_the_file_does():
    four = changed((THROWS, ""))
    two = changed((THROWS, ""), ("[layout]", "[layout]\nstrokes = 2"))
    assert "deg, four-stroke\n" in ask("analyze", "-", stdin=four)
    assert "deg, two-stroke\n" in ask("analyze", "-", stdin=two)
    assert "stroke\n" not in ask("analyze", "-", stdin=changed((ORDER, "")))
    assert "cycle      four-stroke\n" in ask("analyze", "-", stdin=changed((ORDER, "strokes = 4")))


def test_short_names_of_numbers_are_understood_where_one_number_has_them(tmp_path):
    file = write(tmp_path / "i4.toml", GOOD)

    def swept(name):
        return run_here("sweep", file, "--vary", f"{name}=80,90", "-q", "force.2.major")

    for name, path in (("rpm", "operation.speed"), ("speed", "operation.speed"), ("stroke", "crank.stroke")):
        assert swept(name).out == swept(path).out
        assert swept(path).out.startswith(f"{path},force.2.major\n")
    assert run_here("sweep", file, "--vary", "offset=0,3").out.startswith("piston.offset,")
    assert swept("mass").err.endswith("did you mean rod.mass or piston.mass or crosshead.mass?\n")


def test_what_a_command_cannot_do_names_the_one_that_does(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("i4.toml").write_text(GOOD)
    assert refusal("compare", "i4.toml", "i4.toml", "--only", "verdict") == (
        "--only verdict describes a single engine; balcli analyze i4.toml i4.toml --only verdict shows it"
    )


def search(file, over, minimise, *more):
    return run_here("search", file, "--over", over, "--minimise", minimise, *more).out


@pytest.mark.slow
def test_a_search_says_that_the_best_is_an_end_of_the_range(tmp_path):
    file = write(tmp_path / "i4.toml", GOOD)
    assert "The best rod.length is an end of its range" in search(file, "rod.length=140:180", "force.2.major")
    inside = search(file, "crank.throws.2=90:270", "force.1.major")
    assert "180" in inside
    assert "an end of its range" not in inside
    file.write_text(PETROL_FOUR)
    assert "an end of its range" not in search(file, "cylinder.2.heat=0:300", "gas.2.amplitude")
    assert "an end of its range" in search(file, "cylinder.2.heat=1:300", "gas.2.amplitude")


def test_a_search_says_that_a_number_changes_nothing(tmp_path):
    """What turns with the crank has no second order; of one value nobody knows."""
    file = write(tmp_path / "i4.toml", GOOD)
    nothing = "No effect on force.2.major, which is the same at every searched value."
    told = search(file, "crank.throw_mass=0:6", "force.2.major")
    assert nothing in told
    assert "an end of its range" not in told
    assert nothing not in search(file, "crank.stroke=60:90", "force.2.major", "--limit", "force.2.major<3000")
    assert nothing not in search(file, "piston.mass=0.5:0.5", "force.2.major")


def test_a_search_says_that_not_all_of_a_range_makes_an_engine(tmp_path):
    """A firing order fits one splay alone: of a 60-degree V6 that fires evenly, -60."""
    six = changed((THROWS, "splay = -60"), (ORDER, "firing_order = [1, 4, 2, 5, 3, 6]\nbank_angle = 60"))
    file = write(tmp_path / "v6.toml", six)
    told = search(file, "crank.splay=-80:80", "moment.1.backward")
    assert "\n-60 " in told
    assert "With some values the engine is impossible, such as crank.splay = -80: layout.f" in " ".join(told.split())
    assert "No effect" not in told


def test_a_place_that_makes_the_roll_grow_is_told_so(tmp_path):
    file = write(tmp_path / "twin.toml", changed((THROWS, "throws = [0, 90]"), (ORDER, "")))
    near, far = (run_here("balance", file, "--scheme", "single-shaft", f"--at={at}").out for at in ("0,0", "-200,90"))
    assert "The roll of order 1 grows by " in far
    assert "single-shaft" in near
    assert "grows by" not in near


# ------------------------------------------------------------------ a file of another kind
CHAIN = template("torsion")
BODY = block()
RUNS = three_runs()


@cases("file/file_kinds", "a_file_of_another_kind", BODY=BODY, CHAIN=CHAIN, GOOD=GOOD, RUNS=RUNS)
def test_a_file_of_another_kind(command, text, message):
    assert refusal(command, "-", stdin=text) == f"standard input: {message}"


@cases("file/file_kinds", "an_engine_file_with_slips_is_an_engine_file")
def test_an_engine_file_with_slips_is_an_engine_file(old, new):
    with pytest.raises(InputError, match=r" mistakes\n"):
        parse(GOOD.replace(old, new, 1) if old else new + GOOD)


def test_what_could_be_two_kinds_is_judged_by_what_was_wanted():
    with pytest.raises(InputError, match="5 mistakes"):
        parse("[[run]]\n[[node]]\n")
