"""What a file leaves out and a result depends on stands in its document, and at the head of its table."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from support.cases import cases
from support.commands import run_here
from support.engines import GOOD, build_text, changed
from support.paths import ENGINES, write

from balcli import analyze
from balcli.engine.parse import parse
from balcli.file.assumed import Assumed, Value
from balcli.show.sheet import tell_assumed
from balcli.studies import quantities

MOUNTS = "".join(
    f'[[mount]]\nname = "{name}"\nat = [0, {at}]\nstiffness = 200\nloss = 0.1\n'
    for name, at in (("left", "290, 10"), ("right", "-290, 10"), ("rear", "0, 500"))
)
FILE = f"""
[crank]
stroke = 80
spacing = 90
[rod]
length = 140
[piston]
bore = 80
mass = 0.4
[layout]
firing_order = [1, 3, 4, 2]
[operation]
speed = 3000
[gas]
cycle = "otto"
compression_ratio = 10
imep = 9
[body]
mass = 150
cg = [0, 0, 0]
inertia = [9e6, 9e6, 5e6, 0, 0, 0]
{MOUNTS}[torsion]
throw_stiffness = 1e6
throw_inertia = 10000
loss = 0.03
rear = [{{ name = "flywheel", inertia = 200000, length = 300, diameter = 60 }}]
"""
CRANK = ["layout.strokes = 4", "crank.throws = [0, 180, 180, 0] deg"]
GAS = ["gas.compression_index = 1.32", "gas.expansion_index = 1.28", "gas.exhaust_opens = lower dead centre"]
MODULUS = "torsion.rear.shear_modulus = 79.3 GPa"
GRAVITY = "body.gravity = [-1, 0, 0]"
FACTOR = "mount.dynamic_factor = 1"
PARTS = {"CRANK": CRANK, "GAS": GAS, "MODULUS": MODULUS, "MOUNTS": [GRAVITY, FACTOR]}


@pytest.fixture
def file(tmp_path: Path) -> str:
    return str(write(tmp_path / "four.toml", FILE))


def read_assumed(command: str, file: object, *options: str, stdin: str = "") -> list[Assumed]:
    found = run_here(command, file, *options, "-f", "json", stdin=stdin)
    assert found.status == 0, found.err
    records = json.loads(found.out).get("assumed", [])
    return [Assumed(**record)._replace(value=as_value(record["value"])) for record in records]


def as_value(value: Any) -> Value:
    return tuple(map(as_value, value)) if isinstance(value, list) else value


def list_assumed(command: str, file: object, *options: str, stdin: str = "") -> list[str]:
    """The assumed values of a document, each in words."""
    return [tell_assumed([value]) for value in read_assumed(command, file, *options, stdin=stdin)]


@cases("shell/assumed", "each_document_lists_the_defaults_that_it_depends_on", **PARTS)
def test_each_document_lists_the_defaults_that_it_depends_on(
    command: str, options: list[str], there: list[str], absent: list[str], file: str
) -> None:
    assumed = list_assumed(command, file, *options)
    assert {*there} <= {*assumed}
    assert not {*absent} & {*assumed}
    if command != "curves":  # which has no table
        head = " ".join(run_here(command, file, *options, "-f", "table").out.split())
        words = [line.partition(" = ")[0].removeprefix("gas.") for line in there]
        assert [word for word in words if word not in head] == []


@cases("shell/assumed", "masses_that_are_left_out_are_assumed_where_they_count")
def test_masses_that_are_left_out_are_assumed_where_they_count(
    command: str, options: list[str], changes: list[list[str]], there: list[str], absent: list[str]
) -> None:
    text = FILE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    assumed = read_assumed(command, "-", *options, stdin=text)
    assert {*there} <= {tell_assumed([value]) for value in assumed}
    assert not {*absent} & {value.path for value in assumed}


def test_what_the_file_gives_is_not_assumed() -> None:
    text = FILE.replace("[layout]", "[layout]\nstrokes = 4").replace("[gas]", "[gas]\nexpansion_index = 1.28")
    text = text.replace("length = 300", "length = 300, shear_modulus = 79.3")
    text = text.replace("spacing", "throws = [0, 180, 180, 0]\nspacing")
    keys = [value.path for value in read_assumed("torsion", "-", stdin=text)]
    assert "gas.compression_index" in keys
    assert not {"layout.strokes", "crank.throws", "gas.expansion_index", "torsion.rear.shear_modulus"} & {*keys}


def test_two_engines_have_what_holds_for_one_after_its_name(file: str, tmp_path: Path) -> None:
    other = write(tmp_path / "other.toml", FILE.replace("[layout]", "[layout]\nstrokes = 4"))
    assumed = list_assumed("sum", file, str(other))
    assert CRANK[1] in assumed
    assert "first: layout.strokes = 4" in assumed


def test_on_mounts_each_engine_has_its_own_after_its_name(file: str, tmp_path: Path) -> None:
    """What holds for both, and for body and mounts, has no name."""
    two_stroke = FILE.partition("[gas]")[0].replace("[layout]", "[layout]\nstrokes = 2")
    other = write(tmp_path / "other.toml", 'name = "other four"\n' + two_stroke)
    assumed = list_assumed("mounts", file, str(other))
    assert {GRAVITY, FACTOR, "crank.throw_mass = 0 kg"} <= {*assumed}
    assert "other four: crank.throws = [0, 90, 270, 180] deg" in assumed
    nameless = "engine without a name"
    assert {f"{nameless}: {CRANK[1]}", f"{nameless}: {GAS[0]}"} <= {*assumed}


def test_a_chain_names_the_steel_of_its_shafts() -> None:
    chain = 'node = [{ name = "a", inertia = 1e6 }, { name = "b", inertia = 2e6 }]\n'
    chain += 'shaft = [{ from = "a", to = "b", length = 300, diameter = 60 }]\n'
    assert list_assumed("torsion", "-", stdin=chain) == ["shaft.shear_modulus = 79.3 GPa"]
    assert list_assumed("torsion", "-", stdin=chain.replace("diameter", "shear_modulus = 80, diameter")) == []


# ------------------------------------------------------------------ records
def test_a_document_has_path_value_and_unit() -> None:
    """Lists, words and whole numbers, in the units of the file."""
    found = run_here("analyze", "-", "-f", "json", stdin=FILE)
    assert json.loads(found.out)["assumed"][:4] == [
        {"path": "crank.throws", "value": [0.0, 180.0, 180.0, 0.0], "unit": "deg"},
        {"path": "layout.firing_intervals", "value": [180.0, 180.0, 180.0, 180.0], "unit": "deg"},
        {"path": "layout.strokes", "value": 4},
        {"path": "crank.throw_mass", "value": 0.0, "unit": "kg"},
    ]
    assert {"path": "gas.exhaust_opens", "value": "lower dead centre"} in json.loads(found.out)["assumed"]
    on_mounts = run_here("mounts", "-", "-f", "json", stdin=FILE)
    assert {"path": "body.carries_load", "value": False} in json.loads(on_mounts.out)["assumed"]


def test_geared_engines_have_theirs_after_their_names(tmp_path: Path) -> None:
    """What holds for all of them has no name; in a comparison, the name of the whole comes first."""
    single = "[crank]\nstroke = 90{}\n[rod]\nlength = 150\nmass = 0.6\ncg = 45\n[piston]\nmass = 0.5\n"
    write(tmp_path / "open.toml", single.format(""))
    write(tmp_path / "given.toml", single.format("\nthrow_mass = 0.8"))
    engines = "".join(f'[[engine]]\nname = "{name}"\nfile = "{name}.toml"\n' for name in ("open", "given"))
    pair = write(tmp_path / "pair.toml", f'name = "pair"\n[operation]\nspeed = 1000\n{engines}')
    alone = write(tmp_path / "alone.toml", 'name = "alone"\n' + single.format("") + "[operation]\nspeed = 1000\n")
    own = "crank.throw_mass = 0 kg"
    assumed = list_assumed("analyze", pair)
    assert [one for one in assumed if one != "piston.skirt = 31.5 mm"] == ["rod.inertia = 2835 kg mm^2", f"open: {own}"]
    assert len(assumed) == 3
    both = list_assumed("compare", str(pair), str(alone))
    assert both == ["rod.inertia = 2835 kg mm^2", f"pair, open: {own}", f"alone: {own}"]


# ------------------------------------------------------------------ the speed
TOLD = "operation.speed = 1000 rpm"
OF_ORDER_2 = ("--minimise", "force.2.major")


@cases("shell/assumed_speed", "an_assumed_speed_is_told", OF_ORDER_2=OF_ORDER_2)
def test_an_assumed_speed_is_told(command: str, options: list[str], others: list[str]) -> None:
    """And not where the file gives one, or the speed is chosen or varied (`others`)."""
    without = changed(("speed = 3000", ""))
    assert TOLD in run_here(command, "-", *options, stdin=without).out
    assert TOLD not in run_here(command, "-", *options, stdin=GOOD).out
    if others:
        found = run_here(command, "-", *others, stdin=without)
        assert found.status == 0
        assert TOLD not in found.out


def test_mounts_say_up_to_which_assumed_speed_they_go() -> None:
    own = (ENGINES / "i4_mounts.toml").read_text(encoding="utf-8")
    without = re.sub(r"(?m)^speed .*", "", own)
    assert TOLD in run_here("mounts", "-", stdin=without).out
    assert TOLD not in run_here("mounts", "-", stdin=own).out
    assert TOLD not in run_here("mounts", "-", "--speeds", "800:900:50", stdin=without).out


DEVICES = """
[[counterweight]]
unbalance = 9000
[[shaft]]
ratio = -1
unbalance = 3000
[[shaft]]
ratio = 0.7
unbalance = 50
position = 20
at = [9, 9]
[[slider]]
order = 2
unbalance = 200
direction = 0
at = [0, 30]
"""
ANGLES = ["counterweight.angle = 0 deg", "shaft.angle = 0 deg", "slider.angle = 0 deg"]
KINDS = ("counterweight", "shaft", "slider")
PLACES = [f"{kind}.position = 0 mm" for kind in KINDS]


WHERE_THEY_MATTER = pytest.mark.parametrize(
    ("only", "listed"),
    [("force", ANGLES), ("moment", ANGLES + PLACES), ("roll", [*ANGLES[1:], "shaft.at = [0, 0] mm"]), ("torque", [])],
)


@WHERE_THEY_MATTER
def test_angles_and_places_of_devices_are_listed_where_they_matter(only, listed):
    """A shaft without a fixed phase to the crank (0.7) has no part in these quantities."""
    engine = build_text(changed(more=DEVICES))
    told = [tell_assumed([value]) for value in engine_values(engine, only)]
    assert sorted(told) == sorted(listed)


@WHERE_THEY_MATTER
def test_sweeps_list_angles_and_places_of_devices_where_they_matter(only, listed):
    part = "major" if only in ("force", "moment") else "amplitude"
    wanted = quantities.parse_quantities(f"{only}.2.{part}")
    values = quantities.list_assumed(parse(changed(more=DEVICES)), wanted) or ()
    told = [tell_assumed([value]) for value in values if value.table in KINDS]
    assert sorted(told) == sorted(listed)


def test_angles_that_vary_are_not_assumed():
    """An angle is assumed as long as one device of the kind takes it."""
    model = parse(changed(more="[[counterweight]]\nunbalance = 100\n" * 2))
    one = ["counterweight.1.angle"]
    for varied, assumed in ((one, True), ([*one, "counterweight.2.angle"], False)):
        values = quantities.list_assumed(model, quantities.parse_quantities("force.1.major"), varied) or ()
        assert ("counterweight.angle" in [value.path for value in values]) == assumed


def engine_values(engine, only):
    return [value for value in analyze(engine, only=[only]).assumed or () if value.table in KINDS]
