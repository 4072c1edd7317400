"""Engines that commands read: told apart, and doubted where they are unlikely."""

from support.cases import cases
from support.commands import ask, run_here

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
    assert err.startswith("warning: standard input: piston.mass is 500 kg in a bore of 80 mm, where ")


def test_what_varies_is_not_doubted():
    assert ask("sweep", "-", "--vary", "piston.mass=0.4,0.5", "-q", "force.2.major", stdin=HEAVY)
    assert ask("search", "-", "--over", "piston.mass=0.4:0.5", "--minimise", "force.2.major", stdin=HEAVY)


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
