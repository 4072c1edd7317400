"""Torques of [[torsion.excitation]]: propellers, fans and alternators, and the mean torque of shafts."""

import math

import numpy as np
import pytest
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.diesel import write_diesel
from support.paths import write

from balcli import load, torque, torsion
from balcli.file.assumed import Assumed
from balcli.torsional_vibration.means import Link, share_out

GAS = '[gas]\ncycle = "wiebe"\ncompression_ratio = 16\nimep = 15\n'
GEARED = """
[[torsion.rear]]
name = "propeller"
inertia = 9e5
stiffness = 4e5
gear = -0.4
diameter = 70
node_damping = 3
"""


def entry(**keys):
    text = "\n".join(f"{key} = {value!r}" for key, value in keys.items())
    return f"[[torsion.excitation]]\n{text}\n"


def run(more, speeds, extra=GAS, **options):
    return torsion(load(write_diesel(extra=extra) + more), speeds, **options)


def solve(system, node, order, rpm, torque_Nm):
    """Torques of shafts by one torque on a node: a dense complex solution of the chain's equations."""
    chain = system.chain
    count = len(chain.inertia)
    w = order * rpm * np.pi / 30
    twist = np.zeros((len(chain.stiffness), count))
    rows = np.arange(len(chain.stiffness))
    twist[rows, chain.end] += 1
    twist[rows, chain.start] -= chain.ratio
    losses = chain.stiffness * (1 + 1j * system.damping.loss) + 1j * w * system.damping.dashpots
    dynamic = (twist.T * losses) @ twist + np.diag(1j * w * system.damping.nodes - w**2 * chain.inertia)
    load_on = np.zeros(count, complex)
    load_on[node] = torque_Nm
    return losses * (twist @ np.linalg.solve(dynamic, load_on))


# ------------------------------------------------------------------ torques on nodes
def test_a_torque_without_a_phase_adds_what_it_causes_alone():
    speeds = [900.0, 1400.0, 1750.0]
    bare = run(GEARED, speeds, orders=[3, 6]).response
    found = run(GEARED + entry(node="propeller", order=3, amplitude=120.0), speeds, orders=[3, 6])
    node = found.system.nodes.index("propeller")
    for k, rpm in enumerate(speeds):
        alone = np.abs(solve(found.system, node, 3 * 0.4, rpm, 120.0))
        for shaft, without, own in zip(found.response.shafts, bare.shafts, alone, strict=True):
            added = shaft.half_peak_to_peak_Nm[k] - without.half_peak_to_peak_Nm[k]
            assert added == pytest.approx(own, rel=1e-9, abs=1e-9)
            assert shaft.sum_of_amplitudes_Nm[k] - without.sum_of_amplitudes_Nm[k] == pytest.approx(added, abs=1e-9)
    (listed,) = found.response.excitations
    assert (listed.node, listed.order, listed.crank_order, listed.phase) == (
        "propeller",
        3,
        1.2000000000000002,
        "unknown",
    )


@pytest.mark.parametrize(("angle", "sense"), [(0.0, 1), (35.0, 1), (35.0, -1)])
def test_a_known_phase_adds_as_a_phasor(angle, sense):
    """Order 2.5 of a part at -0.4 is order 1 of the crank, whose phasor is conjugate."""
    gear = sense * 0.4
    geared = GEARED.replace("gear = -0.4", f"gear = {gear}")
    known = entry(node="propeller", order=2.5, amplitude=80.0, angle=angle)
    found = run(geared + known, [1300.0], orders=[1])
    both = run(geared, [1300.0], orders=[1])
    node = found.system.nodes.index("propeller")
    phase = np.exp(-1j * sense * math.radians(angle))
    own = solve(found.system, node, 1.0, 1300.0, 80.0 * phase)
    cylinders = sum(
        solve(both.system, place, 1.0, 1300.0, torque)
        for place, torque in zip(
            both.system.excitation.nodes, both.system.excitation.at(np.array([1300 * np.pi / 30]))[0, 0], strict=True
        )
    )
    expected = np.abs(cylinders + own)
    amplitudes = [shaft.half_peak_to_peak_Nm[0] for shaft in found.response.shafts]
    assert amplitudes == pytest.approx(expected, rel=1e-9)
    assert found.response.excitations[0].phase == "known"


def test_an_angle_is_no_phase_at_an_order_that_is_not_of_the_cycle():
    found = run(GEARED + entry(node="propeller", order=3, amplitude=80.0, angle=20.0), [1300.0])
    assert found.response.excitations[0].phase == "unknown"


@pytest.mark.parametrize(("law", "exponent"), [({}, 0), ({"law": "propeller", "rated_speed": 1000}, 2)])
def test_laws_of_an_amplitude(law, exponent):
    found = run(GEARED + entry(node="flywheel", order=2, amplitude=50.0, **law), [1000.0, 1500.0, 3000.0])
    (listed,) = found.response.excitations
    assert listed.amplitude_Nm == pytest.approx(50 * np.array([1, 1.5, 3]) ** exponent, rel=1e-12)


def test_the_rated_speed_of_a_law_is_that_of_the_file():
    found = run(entry(node="flywheel", order=2, amplitude=50.0, law="propeller"), [1000.0])
    assert found.response.excitations[0].amplitude_Nm == pytest.approx([50 / 4])
    assert Assumed("torsion.excitation.rated_speed", 2000.0, "rpm") in found.assumed


@pytest.mark.parametrize("rated", ["", ", rated_speed = 1900"])
def test_the_rated_speed_of_a_rule_is_that_of_the_file(rated):
    """The speed that is taken is listed, for the limit depends on it."""
    rule = f'limit = {{ rule = "M68", tensile = 400, ck = 0.5{rated} }}\n'
    found = run(GEARED.replace('name = "propeller"\n', 'name = "propeller"\n' + rule), [1000.0])
    taken = Assumed("torsion.rear.limit.rated_speed", 2000.0, "rpm")
    assert (taken in (found.assumed or ())) is (rated == "")


@pytest.mark.parametrize(("node", "gear"), [("flywheel", 1.0), ("propeller", 0.4)])
def test_a_share_is_one_of_the_mean_torque_at_the_node(node, gear):
    found = run(GEARED + entry(node=node, order=2, share=0.05), [1500.0])
    mean = torque(load(write_diesel(extra=GAS))).mean_torque_Nm
    assert found.response.excitations[0].amplitude_Nm == pytest.approx([0.05 * mean / gear], rel=1e-9)


def test_orders_choose_those_of_the_cylinders_only():
    more = entry(node="flywheel", order=4, amplitude=90.0, angle=0.0)
    found = run(more, [1000.0, 1500.0], orders=[3])
    assert found.orders == (3, 4)
    assert [share.order for share in found.response.shafts[0].worst.orders] == [3, 4]


def test_the_worst_orders_name_a_torque_without_a_phase_by_itself():
    found = run(GEARED + entry(node="propeller", order=3, amplitude=120.0), [1500.0], orders=[3])
    worst = found.response.shafts[-1].worst
    assert [share.order for share in worst.orders] == pytest.approx([3, 1.2])
    assert sum(share.amplitude_Nm for share in worst.orders) == pytest.approx(worst.half_peak_to_peak_Nm)


def test_the_largest_value_counts_the_worst_phase_between_the_speeds():
    """The blade order alone meets a resonance between two given speeds."""
    more = GEARED + entry(node="propeller", order=7, amplitude=400.0)
    wide = run(more, [600.0, 2600.0], orders=[0.5])
    dense = run(more, np.linspace(600, 2600, 2001), orders=[0.5])
    for shaft, fine in zip(wide.response.shafts, dense.response.shafts, strict=True):
        assert shaft.worst.half_peak_to_peak_Nm >= fine.half_peak_to_peak_Nm.max() * (1 - 1e-9)
        assert shaft.worst.half_peak_to_peak_Nm == pytest.approx(fine.half_peak_to_peak_Nm.max(), rel=1e-3)


def test_criticals_have_the_work_of_a_torque():
    more = GEARED + entry(node="propeller", order=3, amplitude=120.0)
    found = run(more, [300.0, 6000.0])
    (critical,) = [c for c in found.criticals if c.order == pytest.approx(1.2) and c.mode == 1]
    node = found.system.nodes.index("propeller")
    moved = abs(found.modes[0].shape[node])
    assert critical.speed_rpm == pytest.approx(60 * found.modes[0].frequency_Hz / 1.2)
    assert critical.phase_sum == pytest.approx(moved)
    assert critical.work == pytest.approx(math.pi * 120 * moved)


def test_a_torque_without_a_phase_adds_its_work_to_that_of_its_order():
    plain = run("", [300.0, 6000.0], orders=[6]).criticals[0]
    more = entry(node="flywheel", order=6, amplitude=500.0)
    found = run(more, [300.0, 6000.0], orders=[6])
    (critical,) = [c for c in found.criticals if c.mode == plain.mode]
    moved = abs(found.modes[plain.mode - 1].shape[found.system.nodes.index("flywheel")])
    assert critical.work - plain.work == pytest.approx(math.pi * 500 * moved, rel=1e-9)


def test_a_torque_that_drives_an_undamped_mode_is_refused():
    text = write_diesel(more="").replace("damping = 2\nloss = 0.035\n", "") + entry(
        node="flywheel", order=2.2, amplitude=5.0
    )
    with pytest.raises(Exception, match=r"excited by order 2\.2 at .* nothing damps it"):
        torsion(load(text), [5000.0, 6500.0], orders=[0.5])


def test_a_torque_without_a_phase_may_stand_alone():
    """Without gas, cylinders have no order 1/2."""
    found = run(entry(node="flywheel", order=2.2, amplitude=5.0), [1000.0, 2000.0], extra="", orders=[0.5])
    node = found.system.nodes.index("flywheel")
    alone = np.abs(solve(found.system, node, 2.2, 1000.0, 5.0))
    assert [shaft.half_peak_to_peak_Nm[0] for shaft in found.response.shafts] == pytest.approx(alone, rel=1e-9)
    assert {critical.order for critical in found.criticals} <= {2.2}


def test_text_and_csv_have_a_line_for_each_torque(tmp_path):
    more = entry(node="propeller", order=3, amplitude=120.0, law="propeller")
    more += entry(node="flywheel", order=2, amplitude=50.0, angle=25.0)
    path = write(tmp_path / "e.toml", write_diesel(extra=GAS) + GEARED + more)
    _, _, text = ask("torsion", path, "--speeds", "1000:3000:500").partition("Torques on nodes\n")
    lines = text.splitlines()
    assert lines[0] == "propeller, order 3 (crank order 1.2): ±120 N·m at 2000 rpm, phase not known."
    assert lines[1] == "flywheel, order 2 (crank order 2): ±50 N·m at 2000 rpm, phase 25°."
    rows = [row for row in ask_csv("torsion", path, "--speeds", "1000:3000:500") if row["figure"] == "amplitude"]
    of_propeller = [float(row["value"]) for row in rows if row["part"] == "response" and row["name"] == "propeller"]
    assert of_propeller == pytest.approx([120 * (rpm / 2000) ** 2 for rpm in range(1000, 3001, 500)])


# ------------------------------------------------------------------ mean torque
def test_the_mean_torque_flows_to_the_last_part():
    found = run(GEARED, [1500.0])
    mean = torque(load(write_diesel(extra=GAS))).mean_torque_Nm
    carried = {shaft.name: shaft.mean_Nm[0] for shaft in found.response.shafts}
    between = [carried[f"throw {k}-{k + 1}"] for k in range(1, 6)]
    assert between == pytest.approx([mean * k / 6 for k in range(1, 6)], rel=1e-9)
    assert (carried["flywheel"], carried["propeller"]) == pytest.approx((mean, mean / -0.4), rel=1e-9)
    assert (carried["gear"], carried["pulley"]) == (0, 0)


def test_a_misfire_and_a_branch_change_the_mean_torque(tmp_path):
    path = write(tmp_path / "e.toml", write_diesel(extra=GAS))
    shafts = ask_json("torsion", path, "--speeds", "1500", "--misfire", "3")["response"]["shafts"]
    means = [shaft["mean_Nm"][0] for shaft in shafts if shaft["name"].startswith("throw")]
    assert means == pytest.approx([means[0] * k for k in (1, 2, 2, 3, 4)], rel=1e-9)


def test_a_branch_off_the_way_carries_none():
    links = [Link(0, 1, 1.0), Link(1, 2, 1.0), Link(1, 3, 0.5)]
    assert share_out(links, [0, 1], 3).tolist() == [[1, 0, 2], [0, 0, 2]]
    assert share_out(links, [0, 1], 2).tolist() == [[1, 1, 0], [0, 1, 0]]


def test_the_mean_torque_follows_the_gas_of_each_speed():
    gas = '[gas]\ncycle = "wiebe"\ncompression_ratio = 16\nimep = 15\nlaw = "propeller"\nrated_speed = 2000\n'
    found = run("", [1000.0, 1500.0, 2000.0], extra=gas, orders=[3])
    flywheel = found.response.shafts[-1].mean_Nm
    assert flywheel == pytest.approx(flywheel[-1] * np.array([0.25, 0.5625, 1]), rel=1e-9)


def test_without_gas_no_mean_torque_is_known():
    assert run("", [1500.0], extra="").response.shafts[0].mean_Nm is None


def test_a_limit_by_the_mean_torque():
    limited = write_diesel(extra=GAS).replace('name = "flywheel"\n', 'name = "flywheel"\ntorque_limit = "mean"\n')
    found = torsion(load(limited), range(1000, 2001, 50))
    (verdict,) = [limit for limit in found.limits if limit.verdict != "not checked"]
    mean = torque(load(write_diesel(extra=GAS))).mean_torque_Nm
    assert (verdict.kind, verdict.limit_Nm) == ("torque", pytest.approx(mean, rel=1e-9))
    assert verdict.share == pytest.approx(found.response.shafts[-1].worst.half_peak_to_peak_Nm / mean, rel=1e-6)


def test_the_phase_in_words_is_that_of_the_file(tmp_path):
    """Order 2.5 of a part that turns backwards at 0.4 is order 1 of the crank."""
    more = GEARED + entry(node="propeller", order=2.5, amplitude=120.0, angle=35.0)
    path = write(tmp_path / "e.toml", write_diesel(extra=GAS) + more)
    assert "±120 N·m at 2000 rpm, phase 35°." in ask("torsion", path, "--speeds", "1000:3000:500")


AT_SPEEDS = """
[[gas.at]]
speed = 1000
harmonics = "low.csv"
[[gas.at]]
speed = 2000
harmonics = "high.csv"
"""


@pytest.mark.parametrize(("low", "high", "checked"), [(-1, 3, False), (0, 3, False), (1, 3, True)])
def test_a_mean_torque_that_vanishes_is_no_limit(tmp_path, low, high, checked):
    for name, mean in (("low", low), ("high", high)):
        write(tmp_path / f"{name}.csv", f"order,cos,sin\n0,{mean},0\n0.5,2,4\n1.5,1,3\n3,1,2\n")
    text = write_diesel(extra=AT_SPEEDS).replace('name = "flywheel"\n', 'name = "flywheel"\ntorque_limit = "mean"\n')
    path = write(tmp_path / "e.toml", text)
    (of_flywheel,) = [
        limit
        for limit in ask_json("torsion", path, "--speeds", "1000:2000:500")["limits"]
        if limit["shaft"] == "flywheel"
    ]
    if checked:
        assert of_flywheel["share"] > 0
    else:
        assert (of_flywheel["verdict"], of_flywheel["reason"]) == (
            "not checked",
            "its mean torque is 0 at one of the speeds",
        )


def test_a_limit_by_the_mean_torque_of_gas_without_one_is_refused(tmp_path):
    write(tmp_path / "h.csv", "order,cos,sin\n0,0,0\n0.5,2,4\n3,1,2\n")
    text = write_diesel(extra='[gas]\nharmonics = "h.csv"\n')
    limited = text.replace('name = "flywheel"\n', 'name = "flywheel"\ntorque_limit = "mean"\n')
    assert "and needs [gas] with a mean; give a torque in N m" in refusal(
        "torsion", write(tmp_path / "e.toml", limited)
    )


@pytest.mark.parametrize(("silent", "verdict"), [((), "fails"), ((3,), "barred")])
def test_m68_allows_ranges_near_the_rated_speed_with_a_misfire_only(silent, verdict):
    rule = 'limit = { rule = "M68", tensile = 400, ck = 0.5, rated_speed = 1550 }'
    text = write_diesel(extra=GAS).replace("diameter = 85\n", f"diameter = 85\n{rule}\n")
    limit = torsion(load(text), [1500.0, 1600.0], misfire=silent).limits[-1]
    assert (limit.shaft, limit.verdict) == ("flywheel", verdict)
    assert (limit.reason is None) == (verdict == "barred")


# ------------------------------------------------------------------ doubts and mistakes
@pytest.mark.parametrize(("inertia", "doubted"), [(3, True), (3.8, False), ("3 kg m^2", False)])
def test_a_tiny_part_is_doubted(tmp_path, inertia, doubted):
    """The lightest throw has 0.0327 kg m2: a ten-thousandth is 3.27 kg mm2."""
    part = f'[[torsion.rear]]\nname = "propeller"\ninertia = {inertia!r}\nstiffness = 4e5\n'.replace("'", '"')
    done = run_here("torsion", write(tmp_path / "e.toml", write_diesel() + part))
    told = "torsion.rear.2.inertia: 3 kg mm^2, beside 3.27e+04 kg mm^2 of a throw; is it in kg mm^2?"
    assert (told in done.err) is doubted


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (
            entry(node="fan", order=2, amplitude=5.0),
            'torsion.excitation.1.node: "fan" is not a node; there are gear, pulley, flywheel',
        ),
        (
            entry(node="flywheel", order=2, amplitude=5.0, share=0.1),
            "torsion.excitation.1: has share and amplitude; leave one of them out",
        ),
        (entry(node="flywheel", order=2), "torsion.excitation.1: has neither share nor amplitude; give one of them"),
        (entry(node="flywheel", order=2, share=0.1, law="propeller"), "torsion.excitation.1: has share and law"),
        (entry(node="flywheel", order=0, amplitude=5.0), "torsion.excitation.1.order: 0"),
        (
            entry(node="flywheel", order=2, amplitude=5.0, rated_speed=90),
            "torsion.excitation.1: has rated_speed without law",
        ),
    ],
)
def test_mistakes_of_a_torque(tmp_path, more, told):
    path = write(tmp_path / "e.toml", write_diesel(extra=GAS) + more)
    assert refusal("torsion", path).startswith(f"{path}: {told}")


def test_what_a_torque_needs_of_the_engine(tmp_path):
    bare = write_diesel().replace("[operation]\nspeed = 2000\n", "")
    path = write(tmp_path / "e.toml", bare + entry(node="flywheel", order=2, amplitude=5.0, law="propeller"))
    told = "torsion.excitation.1.law: needs the speed of the amplitude; give rated_speed, or operation.speed"
    assert refusal("torsion", path) == f"{path}: {told}"
    path = write(tmp_path / "e.toml", write_diesel() + entry(node="flywheel", order=2, share=0.1))
    assert "torsion.excitation.1.share: is a share of the mean torque, which needs [gas]" in refusal("torsion", path)


@pytest.mark.parametrize(
    ("extra", "part"), [("", "flywheel"), (GAS, "pulley")], ids=["without gas", "off the way of the power"]
)
def test_a_limit_by_the_mean_torque_needs_one(tmp_path, extra, part):
    text = write_diesel(extra=extra).replace(f'name = "{part}"\n', f'name = "{part}"\ntorque_limit = "mean"\n')
    told = refusal("torsion", write(tmp_path / "e.toml", text))
    assert 'torque_limit: is "mean", but its shaft carries no mean torque' in told


def test_a_chain_has_no_mean_torque(tmp_path):
    chain = '[[node]]\nname = "a"\ninertia = 1e6\n[[node]]\nname = "b"\ninertia = 1e6\n'
    chain += '[[shaft]]\nfrom = "a"\nto = "b"\nstiffness = 1e6\ntorque_limit = "mean"\n'
    done = run_here("torsion", write(tmp_path / "c.toml", chain))
    assert done.status == 2
    assert 'shaft.1.torque_limit: is "mean", but a chain file gives no mean torque' in done.err
