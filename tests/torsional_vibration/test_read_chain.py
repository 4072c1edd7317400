"""What a chain file may say, and how every mistake is told, by its path."""

import json
import math

import pytest
from support.cases import cases
from support.chains import chain_text
from support.commands import ask_torsion, refusal, run_here

from balcli.file.toml import parse_toml
from balcli.torsional_vibration.build import build_chain
from balcli.torsional_vibration.chain_file import read_chain_tables

TWO = """
[[node]]
name = "a"
inertia = 1e6
[[node]]
name = "b"
inertia = 2e6
[[shaft]]
from = "a"
to = "b"
stiffness = 1000
"""


def build(text):
    return build_chain(read_chain_tables(parse_toml(text, "")))


def mistakes(text):
    return refusal("torsion", "-", stdin=text).removeprefix("standard input: ").split("\n")


def test_figures_are_converted_once():
    pendulum = {"kind": "pendulum", "mass": "3 lb", "radius": 60, "length": "1 in"}
    nodes = {"a": {"inertia": 1500, "damping": "18 lbf in s/rad"}, "b": {"inertia": "1500 lb ft^2", "damper": pendulum}}
    shaft = {"stiffness": "24.17e6 lbf in/rad", "diameter": "3 in", "bore": 20}
    system = build(chain_text(nodes, {"ab": shaft}))
    pound = 0.45359237
    inch = 0.0254
    force = pound * 9.80665
    assert system.chain.inertia == pytest.approx([1.5e-3, 1500 * pound * (12 * inch) ** 2])
    assert system.chain.stiffness == pytest.approx([24.17e6 * force * inch])
    assert system.damping.nodes == pytest.approx([18 * force * inch, 0])
    outer = 3 * inch
    inner = 0.02
    stress = 16 * outer / (math.pi * (outer**4 - inner**4))
    assert system.stress_by_torque == pytest.approx([stress])
    assert system.pendulums[0] == pytest.approx((1, 3 * pound, 0.06, inch))


def test_a_plain_shaft_has_the_stiffness_of_its_steel():
    system = build(TWO.replace("stiffness = 1000", "diameter = 40\nlength = 500\nbore = 10"))
    polar = math.pi / 32 * (0.04**4 - 0.01**4)
    assert system.chain.stiffness == pytest.approx([79.3e9 * polar / 0.5])
    softer = build(TWO.replace("stiffness = 1000", 'diameter = 40\nlength = 500\nshear_modulus = "12e6 psi"'))
    modulus = 12e6 * 0.45359237 * 9.80665 / 0.0254**2
    assert softer.chain.stiffness == pytest.approx([modulus * math.pi / 32 * 0.04**4 / 0.5])


def test_loss_of_the_file_is_that_of_shafts_that_name_none_and_equal_names_are_told_apart():
    text = "loss = 0.03\n" + TWO + '[[shaft]]\nfrom = "b"\nto = "a"\nstiffness = 5\nloss = 0\n'
    system = build(text + '[[shaft]]\nfrom = "a"\nto = "b"\nstiffness = 5\n')
    assert system.damping.loss.tolist() == [0.03, 0, 0.03]
    assert system.shafts == ("a-b", "b-a", "a-b (2)")


def test_a_rubber_ring_is_a_node_and_a_shaft():
    hub = {"inertia": 1e6, "damper": {"kind": "rubber", "inertia": 4e4, "stiffness": 300, "loss": 0.2}}
    system = build(chain_text({"a": hub, "b": 2}, {"ab": 1000}))
    assert system.nodes == ("a", "b", "a ring")
    assert system.shafts == ("a-b", "a ring")
    assert system.chain.inertia.tolist() == [1, 2, 0.04]
    assert system.damping.loss.tolist() == [0, 0.2]
    assert system.last == 1


def test_torques_of_one_node_and_order_add_up():
    torques = [
        ("b", "order = 2", "cos = 3"),
        ("b", "order = 2", "cos = 1\nsin = 5"),
        ("a", "order = 0.5", 'sin = "1 lbf ft"'),
    ]
    more = "".join(f'[[excitation]]\nnode = "{node}"\n{order}\n{size}\n' for node, order, size in torques)
    excitation = build(TWO + more).excitation
    assert excitation is not None
    assert excitation.orders.tolist() == [0.5, 2]
    assert excitation.nodes.tolist() == [0, 1]
    foot_pound = 0.45359237 * 9.80665 * 0.3048
    assert excitation.steady.ravel() == pytest.approx([-1j * foot_pound, 0, 0, 4 - 5j])


@cases("torsional_vibration/read_chain", "a_mistake_says_what_would_be_right", TWO=TWO)
def test_a_mistake_says_what_would_be_right(text, message):
    assert mistakes(text) == [message]


def test_a_rubber_ring_is_inertia_enough():
    """Two springs in series, 10 and 30 kN m/rad, to a ring of 0.1 kg m2; the hub has no inertia."""
    hub = {"damper": {"kind": "rubber", "inertia": 1e5, "stiffness": 3e4, "loss": 0.1}}
    found = ask_torsion(chain_text({"hub": hub, "wall": 0}, {("hub", "wall"): 1e4}, fixed=["wall"]))
    (mode,) = found["modes"]
    assert mode["frequency_Hz"] == pytest.approx(math.sqrt(7500 / 0.1) / (2 * math.pi), rel=1e-14)


def test_sizes_are_limited():
    assert mistakes(chain_text({str(k): 1 for k in range(201)})) == ["node: is given 201 times; at most 200 are read"]


def test_the_schema_knows_all_keys():
    document = json.loads(run_here("schema", "torsion").out)
    assert document["title"] == "balcli chain file"
    assert set(document["properties"]) >= {"node", "shaft", "gear", "excitation", "fixed", "loss"}
    assert set(document["$defs"]["ChainShaft"]["properties"]) >= {"from", "to", "stiffness", "bore"}
    assert document["$defs"]["Node"]["properties"]["inertia"]["unit"] == "kg mm^2"
