"""The best bank angle, splay or crank with limits and even firing, against dense sweeps and against
engines that are made to fire evenly at one angle.
"""

import itertools
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray
from support.cases import slow
from support.engines import engine_text
from support.searches import search_least

from balcli.engine.build import build
from balcli.engine.parse import parse as load
from balcli.errors import BalcliError
from balcli.file.model import EngineFile
from balcli.forces.quantity import evaluate_quantities
from balcli.forces.symmetry import explain_symmetry
from balcli.show.units import SYSTEMS
from balcli.studies.search.answer import search_arrangements
from balcli.studies.search.command import rows
from balcli.studies.search.designs import BROKEN, Objective, fires_evenly, parse_objective, write_design

Array = NDArray[np.float64]
PATHS = {"bank_angle": "layout.bank_angle", "splay": "crank.splay"}
SPANS = {"bank_angle": (0.0, 180.0), "splay": (-180.0, 180.0)}


def vee(
    throws: Sequence[float], bank: float = 90, splay: float = 0, stagger: float = 0, throw_mass: float = 0
) -> EngineFile:
    text = engine_text(
        crank=f"stroke = 80\nthrows = {throws}\nspacing = 100\nsplay = {splay}\nthrow_mass = {throw_mass}",
        rod="length = 150\nmass = 0.5\ncg = 40",
        piston="mass = 0.5",
        layout=f"bank_angle = {bank}\nstagger = {stagger}",
        operation="speed = 3000",
    )
    return load(text)


# ------------------------------------------------------------------ engines against dense sweeps
def sweep(file: EngineFile, over: str, wanted: Objective, x: Array) -> Array:
    engine = build(file, {PATHS[over]: x})
    figures = evaluate_quantities(engine, wanted.quantities)
    figures = [np.broadcast_to(figure, x.shape) for figure in figures]
    costs = wanted.judge(dict(zip(wanted.quantities, figures, strict=True)))
    return np.where(costs < BROKEN, costs, np.inf)


def found_by(file: EngineFile, over: str, wanted: Objective) -> tuple[Array, Array]:
    try:
        results = search_arrangements(file, over, wanted, 1000).results
    except BalcliError:
        return np.empty(0), np.empty(0)
    return np.array([[r.design[over], r.objective] for r in results]).T


@pytest.mark.stress
@pytest.mark.parametrize("seed", range(40))
def test_no_angle_of_a_dense_sweep_is_better(seed: int) -> None:
    random = np.random.default_rng(seed)
    over = ("bank_angle", "splay")[seed % 2]
    throws = random.choice([0, 60, 90, 120, 180, 240, 270, 33.7], random.integers(2, 15)).tolist()
    file = vee(
        throws=throws,
        splay=random.choice([0, -30, 18]),
        bank=random.choice([45, 60, 72.4, 90]),
        stagger=random.choice([0, 24]),
        throw_mass=random.choice([0, 1.1]),
    )
    names = [
        f"{kind}.{order}.{part}"
        for kind, part in (("force", "major"), ("moment", "backward"), ("moment", "major"))
        for order in (1, 2, 4)
    ]
    goal, *limited = random.choice([*names, "roll.2.amplitude"], 3, replace=False).tolist()
    x = np.linspace(*SPANS[over], 9001 if over == "bank_angle" else 18001)
    limits = []
    for name in limited[: random.integers(1, 3)]:
        values = sweep(file, over, parse_objective(name), x)
        level = float(np.quantile(values, random.choice([0.001, 0.05, 0.5])))
        if level > 1e-6:
            limits.append(f"{name}<{level * 1.0001}")
    wanted = parse_objective(goal, limits)
    dense = sweep(file, over, wanted, x)
    angles, values = found_by(file, over, wanted)
    if np.isfinite(dense).any():
        unlimited = sweep(file, over, parse_objective(goal), x).max()
        assert values.min() <= dense.min() + 1e-9 * unlimited
    if not len(angles):
        return
    for side in (-1e-3, 1e-3):
        beside = angles + side
        if over == "bank_angle":
            beside = np.clip(beside, 0, 180)
        assert (sweep(file, over, wanted, beside) >= values * (1 - 1e-9) - 1e-6).all()
    assert len(np.unique(np.round(np.mod(angles, 360), 6))) == len(angles)


# ------------------------------------------------------------------ even firing
@pytest.mark.parametrize("pairs", [*range(2, 7), *slow(*range(7, 15))])
@pytest.mark.parametrize("over", ["bank_angle", "splay"])
def test_the_angle_at_which_a_vee_fires_evenly(pairs: int, over: str) -> None:
    """The throws of one bank fire evenly, two intervals apart; the other bank's have to stand
    between them, or a turn away: a second way of counting says where.
    """
    bank = 72.4
    interval = 720 / (2 * pairs)
    throws = [-2 * k * interval for k in range(pairs)]
    file = vee(throws=throws, bank=bank)
    results = search_least(file, over, "moment.1.major", count=100, even_firing=True).results
    found = [r.design[over] for r in results]
    assert all(fires_evenly(build(file, {PATHS[over]: angle}), file) for angle in found)
    slots = np.mod(np.arange(2 * pairs) * interval, 360)
    expected = {
        round(float(angle), 6)
        for slot, turn in itertools.product(np.unique(np.round(slots, 9)), (-720, -360, 0, 360))
        for angle in ((slot + turn) if over == "bank_angle" else bank - slot - turn,)
        if (0 <= angle <= 180 if over == "bank_angle" else -180 < angle <= 180)
        and _even(angle if over == "bank_angle" else bank - angle, throws, interval)
    }
    assert {round(a, 6) for a in found} == expected
    assert expected


def _even(second: float, throws: list[float], interval: float) -> bool:
    """Whether firings at minus the pins, of the second bank `second` later, are even."""
    ready = sorted(round(v % 360, 6) % 360 for t in throws for v in (-t, -t + second))
    even = sorted(round(k * interval % 360, 6) % 360 for k in range(2 * len(throws)))
    return bool(np.allclose(ready, even, atol=1e-5))


@pytest.mark.parametrize(
    ("throws", "over", "even"),
    [
        ([0, 240, 120], "layout.bank_angle=50:170", [120.0]),  # 720 / 6; 0 is out of the range
        ([0, 240, 120], "crank.splay=-70:70", [-60.0, 60.0]),  # of banks 60 apart: 120, or both
        ([0, 230, 120], "crank.throws.2=200:250", []),  # banks 60 apart fire 60 apart
        ([0, 240, 120], "piston.mass=0.3:0.5", []),  # nor do these at any mass
    ],
)
def test_even_firing_is_required_of_a_number_too(throws, over, even) -> None:
    file = vee(throws=throws, bank=60)
    objective = parse_objective("moment.1.major")
    if not even:
        with pytest.raises(BalcliError, match="can fire evenly"):
            search_arrangements(file, over, objective, even_firing=True)
        return
    found = search_arrangements(file, over, objective, even_firing=True).results
    assert sorted(one.design[over.partition("=")[0]] for one in found) == even


def test_even_firing_and_a_limit() -> None:
    """V6 of 72.4 degrees: splays of -47.6, -167.6 and 72.4 fire evenly; the limit leaves two."""
    file = vee(throws=[0, 240, 120], bank=72.4)
    free = search_least(file, "splay", "moment.1.major", even_firing=True).results
    assert sorted(r.design["splay"] for r in free) == [-167.6, -47.6, 72.4]
    limit = f"moment.1.major<{free[-1].objective * (1 - 1e-6)!r}"
    kept = search_least(file, "splay", "moment.1.major", [limit], even_firing=True).results
    assert sorted(r.design["splay"] for r in kept) == [-167.6, -47.6]
    impossible = parse_objective("moment.1.major", ["moment.1.major<1e-9"])
    with pytest.raises(BalcliError, match="no splay can keep these limits and fire evenly"):
        search_arrangements(file, "splay", impossible, even_firing=True)


@pytest.mark.parametrize("cylinders", [4, 6, 10, 16, 28])
def test_four_strokes_of_any_even_number_have_firing_orders(cylinders: int) -> None:
    """In line: each throw twice, 720/n apart; as a vee: each pin once, the banks 720/n apart."""
    interval = 720 / cylinders
    half = cylinders // 2
    once = [k * interval for k in range(half)]
    row = load(engine_text(crank=f"stroke = 80\nspacing = 100\nthrows = {[*once, *reversed(once)]}"))
    (found,) = search_least(row, "firing_order", "moment.1.major", count=1).results
    assert sorted(found.design["firing_order"]) == list(range(1, cylinders + 1))
    file = vee([2 * angle for angle in once], bank=interval % 360)
    (best,) = search_least(file, "firing_order", "moment.1.major", count=1).results
    built = build(file.with_table("layout", firing_order=tuple(best.design["firing_order"])))
    fires = np.sort(np.mod([float(v) for v in built.fires_deg.values()], 720))
    assert np.diff(fires) == pytest.approx(interval, abs=1e-6)


def test_sevenths_of_a_turn_stay_such() -> None:
    text = engine_text(crank=f"stroke = 80\nspacing = 100\nthrows = {[f'{k}/7 turn' for k in range(7)]}")
    found = search_least(load(text), "throws", "moment.1.major", count=1)
    (best,) = found.results
    assert sorted(best.design["throws"]) == [k * 360 / 7 for k in range(7)]
    written = build(load(write_design(text.encode(), best.design)))
    (line,) = rows(found, SYSTEMS["si"]).lines
    assert list(map(float, line[0].split("-"))) == list(best.design["throws"])
    verdicts = [reason.verdict for reason in explain_symmetry(written, [1, 2], ["force"]).reasons]
    assert verdicts == ["symmetry", "symmetry"]


@pytest.mark.parametrize("over", ["bank_angle", "splay"])
def test_one_throw_does_not_follow_from_the_firing_order(over: str) -> None:
    """The crank of a vee twin is the same whether its firing order or its throw is given; of an eight it is not."""
    wanted = parse_objective("force.1.major")
    twin = vee([0], bank=52, throw_mass=0.9)
    (expected, *_) = search_arrangements(twin, over, wanted).results
    ordered = twin.with_table("layout", firing_order=(1, 2))
    without_throws = ordered.with_table("crank", throws=None)
    (best, *_) = search_arrangements(without_throws, over, wanted).results
    assert best.design[over] == pytest.approx(expected.design[over])
    assert best.objective == pytest.approx(expected.objective)
    of_eight = {"firing_order": (1, 5, 4, 2, 6, 3, 7, 8), "numbering": ((1, 2, 3, 4), (5, 6, 7, 8))}
    eight = vee([0, 90, 270, 180]).with_table("layout", **of_eight).with_table("crank", throws=None)
    with pytest.raises(BalcliError, match="the crank follows from the firing order"):
        search_arrangements(eight, over, wanted)


@pytest.mark.slow
def test_bank_angles_at_which_articulated_rods_lock_are_no_candidates() -> None:
    text = engine_text(
        crank="stroke = 120\nthrows = [0, 120, 240]\nspacing = 160",
        rod="length = 200\nmass = 1.9\ncg = 55",
        piston="mass = 1.3",
        layout="bank_angle = 60",
        articulation="knuckle_radius = 90\nknuckle_angles = [0, 60]\nrod = { length = 115, mass = 0.62, cg = 60 }",
    )
    file = load(text)
    wanted = parse_objective("force.6.major")
    found = search_arrangements(file, "bank_angle", wanted)
    low = 4.8
    high = 93.8
    assert found.refused.startswith("layout.bank_angle = 0: ")
    for locked in (low, high):
        with pytest.raises(BalcliError, match="the crank cannot turn"):
            sweep(file, "bank_angle", wanted, np.array([locked]))
    dense = np.arange(low + 1, high - 1, 0.5)
    best = found.results[0]
    assert best.objective <= sweep(file, "bank_angle", wanted, dense).min() * (1 + 1e-9)
    assert low < best.design["bank_angle"] < high
