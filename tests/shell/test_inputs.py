"""Engines that commands read: told apart, and doubted where they are unlikely."""

import pytest
from support.cases import cases
from support.commands import run_here
from support.paths import write

HEAVY = """crank.stroke = 90
rod.length = 160
piston = { bore = 80, mass = 500 }
gas = { cycle = "otto", compression_ratio = 9, imep = 8 }
torsion = { throw_inertia = 20000, rear = [{ name = "wheel", inertia = 500000, stiffness = 1e6 }] }
body = { mass = 100, cg = [0, 0, 0], inertia = [4e6, 4e6, 4e6, 0, 0, 0] }
mount = [{ name = "all", at = [0, 0, 0], stiffness = [100, 100, 100] }]
"""


@cases("shell/inputs", "every_command_that_reads_an_engine_doubts_what_is_unlikely")
def test_every_command_that_reads_an_engine_doubts_what_is_unlikely(args):
    err = run_here(*args, stdin=HEAVY).err
    assert err.startswith("warning: standard input: piston.mass: 500 kg in a bore of 80 mm, where ")


@pytest.mark.parametrize(
    ("changes", "number", "doubted"),
    [
        ((), "piston.mass=0.4:0.5", False),
        (("mass = 500", "mass = 0.5", "rod.length = 160", "rod.ratio = 0.45"), "rod.ratio=0.25:0.3", False),
        (("mass = 500", "mass = 0.5", "rod.length = 160", "rod.ratio = 0.45"), "ratio=0.25:0.3", False),
        (("mass = 500", "mass = 0.5", "rod.length = 160", "rod.ratio = 0.45"), "piston.offset=0:1", True),
        (("mass = 500", "mass = 0.5", "stroke = 90", "stroke = 150"), "crank.stroke=80:90", False),
    ],
)
def test_what_varies_is_not_doubted(changes, number, doubted):
    """Neither by its short name, nor where a doubt concerns several keys."""
    text = HEAVY
    for old, new in zip(changes[::2], changes[1::2], strict=True):
        assert old in text
        text = text.replace(old, new)
    over = ("--over", number, "--minimise", "force.2.major")
    vary = ("--vary", number.replace(":", ","), "-q", "force.2.major")
    for found in (run_here("search", "-", *over, stdin=text), run_here("sweep", "-", *vary, stdin=text)):
        assert (found.status, "where 0.15 to 0.4 is usual" in found.err) == (0, doubted)
        assert bool(found.err) is doubted


def test_what_varies_in_one_geared_engine_is_doubted_in_the_others(tmp_path):
    for name in ("first", "second"):
        write(tmp_path / f"{name}.toml", "crank.stroke = 90\nrod.length = 160\npiston = { bore = 80, mass = 500 }\n")
    engines = "".join(
        f'[[engine]]\nfile = "{name}.toml"\nat = [{x}, 0, 0]\n' for name, x in (("first", 0), ("second", 200))
    )
    pair = write(tmp_path / "pair.toml", engines)
    err = run_here("sweep", pair, "--vary", "engine.1.piston.mass=0.4,0.5", "-q", "force.2.major").err
    assert err.startswith(f"warning: {pair}: second.toml: piston.mass: 500 kg in a bore of 80 mm")
    assert err.count("\n") == 1


ALONG = """crank = { stroke = 90, throws = [0, 240, 120], spacing = 100 }
rod = { length = 160, mass = 0.5, cg = 45 }
piston = { bore = 80, mass = 0.5 }
layout.firing_order = [1, 2, 3]
gas = { cycle = "otto", compression_ratio = 9, imep = 8 }
"""


@cases("shell/inputs", "a_firing_order_is_doubted_unless_it_is_searched_for")
def test_a_firing_order_is_doubted_unless_it_is_searched_for(args, doubted):
    status, _, err = run_here(*args, stdin=ALONG)
    told = "warning: standard input: layout.firing_order: 1-2-3 has the intervals 120, 120, 480 deg"
    assert (status, err.startswith(told)) == (0, doubted)
    assert bool(err) == doubted
