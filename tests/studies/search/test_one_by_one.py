"""Searches by quantities of gas, mounts and torsion: each design as a file that says so."""

import json
import math
import re
from itertools import permutations

import numpy as np
import pytest
from support.commands import ask_csv, ask_json, refusal, run_here
from support.diesel import write_diesel
from support.paths import ENGINES, write

import balcli
from balcli.engine.parse import parse
from balcli.process import tell_nobody
from balcli.studies.search import designs as evaluate
from balcli.studies.search.designs import BROKEN, parse_objective
from balcli.studies.search.local import Box, Effort, find_local_optima

GAS = '[gas]\ncycle = "wiebe"\ncompression_ratio = 16\nimep = 15\n'
SIX = write_diesel(extra=GAS)
ORDER = "firing_order = [1, 5, 3, 6, 2, 4]"


def search(path, *args):
    return ask_json("search", path, *args)["results"]


def find_merits(judge, *ranges, points=32, ring=False):
    """LocalOptima of a function of numbers that gives excess and cost, best first."""
    low, high = np.array(ranges, float).T
    box = Box(low, high, np.full(len(low), ring))

    def judge_all(rows):
        judged = np.array([judge(*row) for row in rows], float).reshape(-1, 2)
        return np.where(judged[:, 0] > 0, BROKEN * judged[:, 0], judged[:, 1])

    return find_local_optima(judge_all, box, Effort(points, 8, 1e-12)).places


def find_best(function, low, high) -> list[float]:
    """Where a function without limits is least."""
    return find_merits(lambda x: (0.0, function(x)), (low, high))[:, 0].tolist()


def find_torque(text: str) -> float:
    """Largest torque of the flywheel's shaft, by the command itself: at coarse speeds, then at fine
    ones beside the worst of them.
    """
    speeds, swings = list_torques(text, "1000:3000:20")
    worst = speeds[swings.index(max(swings))]
    return max(list_torques(text, f"{max(worst - 20, 1000)}:{min(worst + 20, 3000)}:0.25")[1])


def list_torques(text: str, speeds: str) -> tuple[list[float], list[float]]:
    options = ("--speeds", speeds, "--format", "json")
    said = json.loads(run_here("torsion", "-", *options, stdin=text).out)["response"]
    return said["speeds_rpm"], said["shafts"][-1]["half_peak_to_peak_Nm"]


@pytest.mark.slow
def test_firing_orders_by_shaft_torque(tmp_path):
    """All that the crank allows: in a six with mirrored throws, of each pair one and the other."""
    text = SIX.replace("spacing = 120", "spacing = 120\nthrows = [0, 240, 120, 120, 240, 0]")
    path = write(tmp_path / "six.toml", text)
    found = search(path, "--over", "firing_order", "--minimise", "shaft.flywheel.torque")
    possible = set()
    for row in permutations(range(2, 7)):
        order = (1, *row)
        half = {frozenset((order[k], order[k + 3])) for k in range(3)}
        if half == {frozenset(pair) for pair in ((1, 6), (2, 5), (3, 4))} and {order[1], order[4]} == {2, 5}:
            possible.add(order)
    orders = [tuple(one["firing_order"]) for one in found]
    torques = [one["quantities"]["shaft.flywheel.torque"] for one in found]
    assert torques == sorted(torques)
    assert torques[0] == pytest.approx(find_torque(text.replace(ORDER, f"firing_order = {list(orders[0])}")), rel=2e-5)
    every = {order: find_torque(text.replace(ORDER, f"firing_order = {list(order)}")) for order in possible}
    assert min(every.values()) == pytest.approx(torques[0], rel=2e-5)
    assert {*orders} == {*every}
    for order, torque in zip(orders, torques, strict=True):
        assert torque == pytest.approx(every[order], rel=2e-5)


def test_throws_by_shaft_torque_without_gas(tmp_path):
    plain = SIX.replace(GAS, "").replace(ORDER, "")
    text = plain.replace("spacing = 120", "spacing = 120\nthrows = [0, 120, 240, 240, 120, 0]")
    path = write(tmp_path / "three.toml", text)
    found = search(path, "--over", "throws", "--minimise", "shaft.flywheel.torque", "--top", "100")
    for one in (found[0], found[-1]):
        own = text.replace("[0, 120, 240, 240, 120, 0]", str(one["throws"]))
        torque = one["quantities"]["shaft.flywheel.torque"]
        assert torque == pytest.approx(find_torque(own), rel=2e-5)
    assert len(found) > 15
    assert found[0]["objective"] < found[-1]["objective"]


def test_the_firing_order_decides_where_gas_fires_in_two_turns(tmp_path):
    path = write(
        tmp_path / "six.toml", SIX.replace("spacing = 120", "spacing = 120\nthrows = [0, 240, 120, 120, 240, 0]")
    )
    told = refusal("search", path, "--over", "throws", "--minimise", "torque.2.amplitude")
    assert told.startswith("with [gas], results of four-stroke engines depend on the firing order as well")


def test_a_number_in_a_range(tmp_path):
    """The best is at least as good as all of a fine sweep, and a limit is kept."""
    path = ENGINES / "i4_mounts.toml"
    key = "mount.left.stiffness.2"
    quantity = "mode.roll.share"
    found = search(path, "--over", f"{key}=60:400", "--minimise", quantity)
    swept = ask_csv("sweep", path, "--vary", f"{key}=60:400:10", "-q", quantity)
    values = [float(row[quantity]) for row in swept]
    assert found[0]["objective"] <= min(values) * (1 + 1e-9)
    (row,) = ask_csv("sweep", path, "--vary", f"{key}={found[0][key]!r}", "-q", quantity)
    assert float(row[quantity]) == pytest.approx(found[0]["objective"], rel=1e-12)


def keep(share: float, cost: float) -> tuple[float, float]:
    """Excess and cost, where this share of a limit is reached."""
    return share if share >= 1 else 0.0, cost


def test_limits_are_kept_where_they_can_be():
    """|x - 5.3| < 0.01 leaves a sliver between two points of the grid, in which sin x is least at the lower end. Of two
    limits that which is broken most leads: each alone is kept at 2 and at 3, both about 2.5.
    """
    ((found,),) = find_merits(lambda x: keep(abs(x - 5.3) / 0.01, math.sin(x)), (0.0, 10.0))
    assert abs(found - 5.3) < 0.01
    assert found == pytest.approx(5.29, abs=1e-8)
    ((found,),) = find_merits(lambda x: keep(max(abs(x - 2), abs(x - 3)) / 0.501, x), (0.0, 10.0))
    assert found == pytest.approx(2.499, abs=1e-8)
    assert len(find_merits(lambda x: (1 + x, x), (0.0, 10.0))) == 0


@pytest.mark.parametrize("width", [1e-9, 1e-11])
def test_a_search_that_stops_on_a_line_goes_on_along_it(width):
    """A limit holds x and y equal, so that single steps leave the line; on it, the least cost is at 3.3."""
    found = find_merits(lambda x, y: keep(abs(x - y) / width, (x - 3.3) ** 2), (0, 10), (0, 10))
    assert found[0] == pytest.approx([3.3, 3.3], abs=1e-6)


def test_several_numbers_in_a_valley_with_a_kink():
    """|x - 2 y| + 100 |x + y - 6| is 0 at (4, 2) alone; a limit y < 1 leaves (5, 1), with 3."""
    found = find_merits(lambda x, y: (0.0, abs(x - 2 * y) + 100 * abs(x + y - 6)), (0, 10), (0, 10))
    assert found == pytest.approx(np.array([[4, 2]]), abs=1e-9)
    limited = find_merits(lambda x, y: (y if y >= 1 else 0.0, abs(x - 2 * y) + 100 * abs(x + y - 6)), (0, 10), (0, 10))
    assert limited[0] == pytest.approx([5, 1], abs=1e-8)


def test_every_distinct_optimum_of_several_numbers_once():
    """(cos x, sin y) of two turns: minima at 180 deg, and at 270; cos 2x has two, 180 apart."""
    found = find_merits(
        lambda x, y: (0.0, math.cos(math.radians(2 * x)) + math.sin(math.radians(y))),
        *((0, 360), (0, 360)),
        points=256,
        ring=True,
    )
    assert sorted(found.tolist()) == [pytest.approx([90, 270], abs=1e-5), pytest.approx([270, 270], abs=1e-5)]


@pytest.mark.slow
def test_four_numbers_together_balance_four_cranks(tmp_path):
    """Masses and angles of the inner two cranks, against the two closed equations of forces and
    moments: sum m exp(i phi) = sum m z exp(i phi) = 0.
    """
    path = write(
        tmp_path / "four.toml",
        "[crank]\nstroke = 600\nthrows = [0, 90, 270, 120]\npositions = [0, 450, 1200, 1800]\n"
        "[rod]\nlength = 1200\n[piston]\nmass = 400\n",
    )
    keys = ["crank.throws.2", "crank.throws.3", "cylinder.2.piston_mass", "cylinder.3.piston_mass"]
    ends = ["0:360"] * 2 + ["100:2000"] * 2
    over = [word for each in map("=".join, zip(keys, ends, strict=True)) for word in ("--over", each)]
    found = search(path, *over, "--minimise", "force.1.major=1,moment.1.major=1")
    end = np.exp(1j * np.radians(120))
    inner = np.linalg.solve(np.array([[1, 1], [450, 1200]]), -400 * np.array([1 + end, 1800 * end]))
    expected = [*(np.degrees(np.angle(inner)) % 360), *np.abs(inner)]
    assert [found[0][key] for key in keys] == pytest.approx(expected, rel=1e-9)
    assert found[0]["objective"] == 0
    assert len(found) == 1


def test_maximise():
    """force.2 of a V60's bank angle is largest where sweep says; and of throws, by trying all."""
    path = ENGINES / "v6_60.toml"
    swept = ask_csv("sweep", path, "--vary", "layout.bank_angle=0:180:1", "-q", "roll.3.amplitude")
    best = max(float(row["roll.3.amplitude"]) for row in swept)
    found = search(path, "--over", "bank_angle", "--maximise", "roll.3.amplitude")
    assert found[0]["objective"] >= best * (1 - 1e-12)
    five = ENGINES / "i5.toml"
    small = search(five, "--over", "throws", "--minimise", "moment.1.major", "--top", "100")
    large = search(five, "--over", "throws", "--maximise", "moment.1.major", "--top", "100")
    assert [one["objective"] for one in large] == pytest.approx([one["objective"] for one in small[::-1]])


def test_designs_one_by_one_are_limited_and_may_end_early(monkeypatch):
    model = parse(SIX)
    goal = parse_objective("torque.3.amplitude", with_gas=True)
    designs = [{"rod.length": 200.0 + k} for k in range(4)]
    assert len(list(evaluate.rank_one_by_one(model, designs, goal, lambda share: share >= 0.5))) == 2
    monkeypatch.setattr(evaluate, "MOST_DESIGNS_ONE_BY_ONE", 3)
    with pytest.raises(balcli.BalcliError, match=r"^more than 3 arrangements, too many"):
        evaluate.rank_one_by_one(model, designs, goal, tell_nobody)


def test_a_firing_order_of_no_account_leaves_room_for_a_bank_angle():
    """As in a sweep: this file's intervals fit 45 degrees alone, and no gas asks for them."""
    path = ENGINES / "vtwin45.toml"
    found = search(path, "--over", "layout.bank_angle=80:100", "--minimise", "force.1.backward")
    assert found[0]["layout.bank_angle"] == pytest.approx(90, abs=1e-4)


def test_ends_of_a_turn_are_one_angle():
    """Guides of a V6 feel nothing of order 3 at splays of -60, which it has, 60 and 180."""
    found = search(ENGINES / "v6_60.toml", "--over", "splay", "--minimise", "guide.3.X")
    assert sorted(one["splay"] for one in found) == [-60, 60, 180]


def test_throws_that_fire_evenly_are_tried_whatever_the_files_firing_order():
    """Those of a six are three pairs, so that all their arrangements do."""
    asked = ("--over", "throws", "--minimise", "guide.3.X", "--top", "100")
    every = search(ENGINES / "i6.toml", *asked)
    assert search(ENGINES / "i6.toml", *asked, "--require", "even-firing") == every
    assert len(every) > 5


def test_where_no_value_makes_an_engine_the_reason_is_told():
    """With gas the order in which it fires has to fit."""
    asked = ("--over", "layout.bank_angle=80:85", "--minimise", "torque.4.amplitude")
    told = refusal("search", ENGINES / "v8_wiebe.toml", *asked)
    assert "layout.firing_order: 1-8-4-3-6-5-7-2 would take" in told


@pytest.mark.parametrize(
    ("function", "place"),
    [
        (lambda x: 3000 * (2 - math.sin(math.radians(x))), 90.0),  # smooth, and flat about 90
        (lambda x: abs(math.cos(math.radians(x))), 90.0),  # a kink
        (lambda x: 5 + abs(x - 90) ** 0.5, 90.0),
        (lambda x: 5 + abs(x - 88.125), 88.125),
    ],
)
def test_the_place_of_a_minimum_is_the_round_number_that_it_is(function, place):
    assert find_best(function, 13.0, 160.0)[0] == place


def test_places_of_flat_stretches_zeros_and_poles():
    """A stretch of equal values is one minimum, at its first point, or at its roundest."""
    assert find_best(lambda _: 0.0, 2.0, 10.0) == [2.0]
    assert find_best(lambda x: max(abs(x - 5.0), 2.0), 0.0, 16.0) == [3.0]
    assert str(find_best(lambda x: max(abs(x + 0.1), 0.2), -10.0, 20.0)[0]) == "0.0"  # a zero has no sign
    (place,) = find_best(lambda x: 1e20 if x < 0.02 else (x - math.pi) ** 2, 0.0, 10.0)
    assert place == pytest.approx(math.pi, abs=1e-6)  # no number is as good for a pole elsewhere


def test_where_no_round_number_is_as_good_the_place_is_as_exact_as_the_function():
    (kink,) = find_best(lambda x: abs(x - math.e), 0.0, 10.0)
    assert kink == pytest.approx(math.e, abs=1e-9)
    (smooth,) = find_best(lambda x: 1 + (x - math.e) ** 2, 0.0, 10.0)
    assert smooth == pytest.approx(math.e, abs=3e-6)
    (edge,) = find_best(lambda x: x if x > math.e else math.inf, 0.0, 10.0)
    assert 0 < edge - math.e < 1e-9
    assert find_best(lambda _: math.inf, 0.0, 10.0) == []


@pytest.mark.slow
def test_numbers_are_shown_as_they_are_typed_and_not_written(tmp_path):
    path = ENGINES / "i4_wiebe.toml"
    out = tmp_path / "new.toml"
    args = ("--over", "gas.imep=8:12", "--minimise", "fluctuation")
    done = run_here("search", path, *args, "--write", out)
    told = "balcli: --write takes throws, firing orders and angles; edit the file: gas.imep = 12\n"
    assert (done.status, done.err, out.exists()) == (2, told, False)
    assert "Best gas.imep\n" in done.out
    head = next(line for line in done.out.splitlines() if line.startswith("gas.imep"))
    assert re.split(r" {2,}", head) == ["gas.imep, bar", "fluctuation"]
    lines = run_here("search", path, *args, "-f", "csv").out.splitlines()
    assert lines[0] == "gas.imep,objective,fluctuation"


@pytest.mark.slow
def test_on_a_line_on_which_limits_are_kept_only_its_optima_are_results():
    """Even firing keeps bank angle less splay at a multiple of 120 deg: each result is the least of
    its line, by engines at every 5 deg of the bank angle; so is each least value there a result.
    """
    engine = balcli.load_example("v6_90_split")
    over = ["bank_angle", "splay"]
    goal = "moment.1.major"
    found = balcli.search(engine, over, goal, require="even-firing")
    reached = sorted(one.objective for one in found.results)
    banks = np.arange(0, 181, 5.0)
    least = []
    for turn in (0, 120, 240):
        splays = (banks - turn + 180) % 360 - 180
        changed = [
            engine.vary({"layout.bank_angle": b, "crank.splay": s, "layout.firing_order": None})
            for b, s in zip(banks, splays, strict=True)
        ]
        sizes = [balcli.analyze(each, [1], "moment").spectra.moment.major[0] for each in changed]
        ends = np.concatenate([[np.inf], sizes, [np.inf]])
        least += [v for v, a, b in zip(sizes, ends[:-2], ends[2:], strict=True) if v < min(a, b)]
    np.testing.assert_allclose(reached, sorted(least), rtol=1e-6, atol=1e-6)


@pytest.mark.slow
def test_a_line_of_equally_good_points_is_one_result():
    """Pistons 1 and 2 of an in-line four as heavy as each other leave no first-order force."""
    engine = balcli.load_example("i4")
    over = [f"cylinder.{n}.piston_mass=0.4:0.6" for n in (1, 2)]
    found = balcli.search(engine, over, "force.1.major")
    assert [one.objective for one in found.results] == [pytest.approx(0, abs=1e-6)]
