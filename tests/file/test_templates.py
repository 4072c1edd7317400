"""Starting files are valid, also with their optional keys switched on, and tell the truth about alternatives."""

import math
import re
import tomllib

import pytest

from balcli.engine.parse import parse
from balcli.errors import BalcliError
from balcli.file.examples import ENGINE_KINDS, template

OPTION = re.compile(r"^# *((?:\[+[a-z.0-9]+\]+)|(?:[a-z_]+ *= .*))")
THROWS_AND_BANKS = [(1, 1), (4, 1), (4, 2), (4, 2), (1, 9), (2, 7), (4, 3), (4, 1)]
INSTEAD = ("or instead of", "# big_end", "# pin ", "# rings", "# locks")


@pytest.mark.parametrize(("kind", "throws_and_banks"), [*zip(ENGINE_KINDS, THROWS_AND_BANKS, strict=True)])
def test_it_is_the_engine_that_it_says(kind, throws_and_banks):
    engine = parse(template(kind), kind)
    layout = engine.layout
    banks = 2 if layout.bank_angle else layout.radial or len(layout.banks or (0,))
    assert (len(engine.crank.throws or (0,)), banks) == throws_and_banks
    assert engine.name
    assert engine.source.endswith("replace every figure by your own")


@pytest.mark.parametrize("kind", ENGINE_KINDS)
def test_every_optional_key_can_be_switched_on(kind):
    """All of them at once, but for those that stand instead of others."""
    lines = [line for line in template(kind).splitlines() if not any(mark in line for mark in INSTEAD)]
    engine = parse("\n".join(OPTION.sub(r"\1", line) for line in lines), kind)
    assert all([engine.shaft, engine.slider, engine.counterweight, engine.cylinder, engine.operation.speed_ripple])
    assert engine.frame.reference == (0.0, 0.0, 0.0)
    assert "bobweight" in engine.model_fields_set


@pytest.mark.parametrize("kind", ENGINE_KINDS)
def test_alternatives_say_the_same(kind):
    text = template(kind)
    engine = parse(text)
    rod = engine.rod
    given = {}
    for line in text.partition("[rod]")[2].partition("[piston]")[0].splitlines():
        if line.startswith("#"):
            given |= tomllib.loads(OPTION.sub(r"\1", line))
    inertia = given.get("inertia", rod.inertia)
    arm = (rod.length - rod.cg) * 1e-3
    swing = 2 * math.pi * math.sqrt((inertia * 1e-6 + rod.mass * arm**2) / (rod.mass * 9.80665 * arm))
    assert given["ratio"] == pytest.approx(engine.crank.stroke / 2 / rod.length, abs=1e-4)
    assert given["small_end"] == pytest.approx(rod.mass * rod.cg / rod.length, abs=1e-4)
    assert given["small_end"] + given["big_end"] == pytest.approx(rod.mass, abs=1e-4)
    assert given["pendulum"] == {"pivot": "small_end", "period": pytest.approx(swing, abs=1e-4)}


@pytest.mark.parametrize("kind", ENGINE_KINDS)
def test_the_parts_of_a_piston_weigh_as_much_as_the_whole(kind):
    text = template(kind)
    table = text.partition("[piston]")[2].partition("[layout]")[0]
    parts = [OPTION.sub(r"\1", line) for line in table.splitlines() if re.match("# (piston|pin|rings|locks) ", line)]
    given = tomllib.loads("\n".join(parts))
    assert list(given) == ["piston", "pin", "rings", "locks"]
    assert sum(given.values()) == pytest.approx(parse(text).piston.mass, abs=1e-9)


@pytest.mark.parametrize("kind", ENGINE_KINDS)
def test_every_key_is_explained_and_lines_are_short(kind):
    lines = template(kind).splitlines()
    assert max(map(len, lines)) <= 120
    assert lines[3].startswith("# ")
    keys = [(found[1], line) for line in lines if (found := re.match(r"(?:# )?([a-z_]+) += ", line))]
    explained = set()
    for key, line in keys[2:]:  # after name and source
        explained |= {key} if " # " in line else set()
        assert key in explained, line


def test_the_compressor_is_complete_and_its_options_can_be_switched_on():
    text = template("compressor")
    lines = text.splitlines()
    assert max(map(len, lines)) <= 130
    assert lines[3].startswith("# ")
    engine = parse("\n".join(OPTION.sub(r"\1", line) for line in lines), "compressor")
    assert engine.source.endswith("replace every figure by your own")
    assert engine.gas.crank_end.clearance == 0.14
    assert engine.layout.numbering == ((1,), (2,))
    assert engine.cylinder[2].crosshead_mass == 24
    for line in lines[9:]:
        assert " # " in line or not re.match(r"(?:# )?[a-z_]+ += ", line), line


def test_unknown_kinds():
    with pytest.raises(BalcliError) as caught:
        template("boxxer")
    assert str(caught.value) == '"boxxer" is not a kind of file; did you mean boxer?'
    with pytest.raises(BalcliError, match=r"w, mounts, compressor, locomotive, field, four-runs, torsion$"):
        template("q" * 10_000)
