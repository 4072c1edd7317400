"""Searches: the best of all candidates, each arrangement once."""

from itertools import permutations

import numpy as np
import pytest
from support.cases import cases
from support.commands import refusal
from support.engines import GOOD, changed, engine_text
from support.paths import ENGINES
from support.searches import search_least

from balcli.engine.build import build
from balcli.engine.layout import plan_cylinders
from balcli.engine.parse import parse as load
from balcli.errors import BalcliError, InputError
from balcli.file.model import EngineFile
from balcli.forces.quantity import evaluate_quantities
from balcli.studies.quantities import parse_quantities
from balcli.studies.search.answer import search_arrangements
from balcli.studies.search.designs import fires_evenly, parse_objective, write_design
from balcli.studies.search.throws import find_best_throws, tabulate_contributions

NO_ORDER = ("[layout]\nfiring_order = [1, 3, 4, 2]\n", "")
SHUFFLED = changed(("[0, 180, 180, 0]", "[0, 0, 180, 180]"), NO_ORDER)


def engine(throws: list[float], layout: str = "") -> EngineFile:
    return load(changed(("[0, 180, 180, 0]", str(throws)), ("firing_order = [1, 3, 4, 2]", layout)))


def test_in_line_four() -> None:
    found = search_least(load(SHUFFLED), "throws", "moment.1.major=1,force.1.major=1").results
    assert [r.design["throws"] for r in found] == [[0, 180, 180, 0], [0, 180, 0, 180], [0, 0, 180, 180]]
    assert found[0].objective == 0


@pytest.mark.parametrize(
    ("throws", "layout"),
    [
        ([0, 72, 144, 216, 288], ""),
        ([0, 100, 250, 190, 20, 300], ""),
        ([0, 120, 240, 240, 120, 0], "bank_angle = 60\nstagger = 20"),
        ([0, 90, 270, 180], "bank_angle = 90\nnumbering = [[5, 6, 7, 8], [1, 2, 3, 4]]"),
        ([0, 60, 120, 180, 240, 300, 30, 40], ""),
    ],
)
def test_branch_and_bound_finds_what_trying_all_finds(throws: list[float], layout: str) -> None:
    """Without a limit, and with one that two fifths of the cranks keep."""
    file = engine(throws, layout)
    goal = "moment.1.major=1,moment.2.backward=2,force.1.major=0.5"
    every = sorted(set(permutations(throws))) if len(throws) < 8 else [(0, *p) for p in permutations(throws[1:])]
    chosen = np.random.default_rng(1).permutation(len(every))[:1000]
    whole = build(file, {f"crank.throws.{t + 1}": column for t, column in enumerate(np.array(every)[chosen].T)})
    quantities = parse_objective(goal).quantities
    values = dict(zip(quantities, evaluate_quantities(whole, quantities), strict=True))
    bound = float(np.quantile(values[quantities[2]], 0.4)) * 1.001 + 1e-3
    for wanted in (parse_objective(goal), parse_objective(goal, [f"force.1.major<{bound!r}"])):
        tried = wanted.judge(values).min()
        first = search_arrangements(file, "throws", wanted, 1).results[0].objective
        if len(chosen) == len(every):
            assert first == pytest.approx(tried, rel=1e-12, abs=1e-8)
        assert first <= tried + 1e-8


def test_every_arrangement_of_a_five_once() -> None:
    found = search_least(engine([0, 72, 144, 216, 288]), "throws", "moment.1.major", count=100).results
    keys = {tuple(r.design["throws"]) for r in found}
    assert len(keys) == len(found) == 8  # 5!/5 rotations = 24 cranks, 8 but for mirror images
    assert all(r.design["throws"][0] == 0 for r in found)


NINE = [0, 31, 67, 95, 140, 170, 222, 260, 301]


def test_the_best_of_nine_distinct_throws_by_a_plain_sum() -> None:
    """In line, both parts of the first-order moment go with |Σ z exp(iφ)|: 9 x 8! arrangements."""
    others = np.array(list(permutations(range(1, 9))))
    every = [np.roll(NINE, -first)[np.insert(others, 0, 0, axis=1)] for first in range(9)]
    sizes = [np.abs(np.exp(1j * np.deg2rad(rows)) @ (np.arange(9) - 4.0)) for rows in every]
    best = np.concatenate(every)[np.concatenate(sizes).argmin()]
    file = engine(NINE)
    wanted = parse_objective("moment.1.major")
    (found,) = search_arrangements(file, "throws", wanted, 1).results
    assert found.objective == pytest.approx(evaluate_alone(file, best), rel=1e-9)


def test_who_is_told_hears_of_all_arrangements_and_may_stop() -> None:
    """It changes nothing; who has seen enough gets the best so far."""
    file = engine(NINE)
    wanted = parse_objective("moment.1.major")
    shares: list[float] = []
    told = find_best_throws(file, wanted, 3, tell=lambda share: bool(shares.append(share)))
    first, *_ = every = find_best_throws(file, wanted, 3)
    assert np.array_equal(told, every)
    assert shares == sorted(shares)
    assert shares[-1] == pytest.approx(1, abs=1e-12)
    assert len(shares) > 9
    shares.clear()
    (best,) = find_best_throws(file, wanted, 1, tell=lambda share: not shares.append(share))
    assert 0 < shares[-1] < 0.1
    assert evaluate_alone(file, first) <= evaluate_alone(file, best) < np.inf


def evaluate_alone(file: EngineFile, throws: np.ndarray) -> float:
    engine = build(file.with_table("crank", throws=tuple(map(float, throws))))
    return float(evaluate_quantities(engine, parse_quantities("moment.1.major"))[0])


def test_limits_are_kept() -> None:
    file = engine([0, 90, 270, 180], "bank_angle = 90")
    free = search_least(file, "throws", "moment.1.major").results
    kept = search_least(file, "throws", "moment.1.major", ["moment.2.major<1"]).results
    assert free[0].design != kept[0].design
    assert kept[0].quantities["moment.2.major"] < 1
    with pytest.raises(BalcliError, match="no throws can keep these limits"):
        search_least(file, "throws", "moment.1.major", ["force.4.major<1e-9"])


def test_firing_orders_bring_their_cranks() -> None:
    text = changed(("throws = [0, 180, 180, 0]\n", ""))
    found = search_least(load(text), "firing_order", "moment.1.major").results
    assert len(found) == 3
    assert found[0].objective == 0
    for r in found:
        new = load(write_design(text.encode(), r.design))
        value = evaluate_quantities(build(new), parse_quantities("moment.1.major"))[0]
        assert float(value) == pytest.approx(r.objective, abs=1e-9)
        assert new.layout.firing_order == tuple(r.design["firing_order"])


def test_v8_firing_orders_fit_their_crank() -> None:
    file = engine([0, 90, 270, 180], "bank_angle = 90")
    found = search_least(file, "firing_order", "moment.1.major", count=100).results
    orders = {tuple(r.design["firing_order"]) for r in found}
    assert len(orders) == len(found) == 4  # 16, but for mirror images
    common = (1, 5, 4, 2, 6, 3, 7, 8)
    from_the_other_end = (1, 3, 7, 2, 6, 5, 4, 8)
    assert common in orders or from_the_other_end in orders


@pytest.mark.parametrize(
    ("layout", "splay"),
    [
        ("firing_order = [1, 5, 3, 6, 2, 4]", 0),
        ("bank_angle = 120\nfiring_order = [1, 4, 2, 5, 3, 6]", 0),
        ('banks = [-90, 90]\nfiring_order = [1, 4, 5, 2, 3, 6]\nrods = "alternating"', 0),
        ("bank_angle = 90\nfiring_order = [1, 4, 2, 5, 3, 6]", -30),
        ("strokes = 2\nfiring_order = [1, 5, 3, 6, 2, 4]", 0),
        ("radial = 5\nfiring_order = [1, 3, 5, 2, 4]", 0),
        ("radial = 5\nrotary = true\nfiring_order = [1, 3, 5, 2, 4]", 0),
        ("bank_angle = 180\nrotary = true\nfiring_order = [1, 2, 4, 3]", 0),
        ("radial = 5\nfiring_order = [1, 3, 5, 2, 4]\n[articulation]\nknuckle_radius = 30\nrod.length = 130", 0),
    ],
)
def test_firing_orders_are_those_that_an_engine_file_may_have(layout: str, splay: float) -> None:
    count = layout[layout.index("firing_order") :].partition("]")[0].count(",") + 1
    ends = range(0, count, 1 if "radial" in layout else count // 2) if "bank" in layout or "radial" in layout else [0]
    size = count // len(ends)
    numbering = [list(range(end + 1, end + size + 1)) for end in ends]
    even = [(360 if "strokes = 2" in layout else 720) / count] * count

    def text(order: tuple[int, ...], more: str = "") -> str:
        at = layout.index("firing_order"), layout.index("]", layout.index("firing_order")) + 1
        own = layout[: at[0]] + f"firing_order = {list(order)}\nnumbering = {numbering}\n{more}" + layout[at[1] :]
        return changed(
            ("throws = [0, 180, 180, 0]\n", f"splay = {splay}\n"),
            ("firing_order = [1, 3, 4, 2]", own),
            ("[piston]\n", "[piston]\noffset = 5\n"),
        )

    first = load(text(tuple(range(1, count + 1)), f"firing_intervals = {even}\n"))

    def fits(order: tuple[int, ...]) -> bool:
        try:
            build(first.with_table("layout", firing_order=order))
        except InputError:
            return False
        return True

    every = {order for rest in permutations(range(2, count + 1)) if fits(order := (1, *rest))}
    given = load(text(next(iter(every))))
    results = search_least(given, "firing_order", "moment.1.major", count=1000).results
    found = [tuple(r.design["firing_order"]) for r in results]
    mirrored = {other for order in found for other in _images(order, given)}
    assert every <= mirrored
    assert set(found) <= every
    assert len(found) == len(set(found))


def _images(order: tuple[int, ...], file: EngineFile) -> list[tuple[int, ...]]:
    cells = {(c.bank, c.throw): c.number for c in plan_cylinders(file).cells}
    last = max(throw for _, throw in cells)
    other_end = {n: cells.get((bank, last - throw), n) for (bank, throw), n in cells.items()}
    ends = [order, tuple(other_end[n] for n in order)]
    turned = [(*row[row.index(1) :], *row[: row.index(1)]) for row in ends]
    return turned + [(1, *reversed(row[1:])) for row in turned]


def test_millions_of_firing_orders_are_no_hindrance() -> None:
    order = [1, 2, 3, 4, 5, 6, 7, 8, 15, 16, 9, 10, 11, 12, 13, 14]
    layout = f"bank_angle = 90\nfiring_order = {order}"
    text = changed(("throws = [0, 180, 180, 0]\n", ""), ("firing_order = [1, 3, 4, 2]", layout))
    found = search_least(load(text), "firing_order", "moment.1.major,moment.2.major=1", count=3).results
    assert [one.objective for one in found] == [0, 0, 0]
    for one in found:
        assert fires_evenly(build(load(write_design(text.encode(), one.design))), load(text)).all()


CHOICES = (
    "choose from throws, firing_order, bank_angle, splay, or give a number of the file with its "
    "range, such as mount.left.loss=0.05:0.3"
)


@cases("studies/search", "mistakes", CHOICES=CHOICES)
def test_mistakes_in_words(over: str, goal: list[str], message: str) -> None:
    told = refusal("search", ENGINES / "i4.toml", "--over", over, *goal)
    assert told.removeprefix(f"{ENGINES / 'i4.toml'}: ").startswith(message)


@pytest.mark.parametrize("over", ["bank_angle", "splay"])
def test_an_angle_is_looked_for_on_a_given_crank(over: str) -> None:
    """Two rods on one pin, 90 degrees apart, fire in turn with this bank angle alone."""
    file = load(
        changed(("throws = [0, 180, 180, 0]\n", ""), ("[1, 3, 4, 2]", "[1, 3, 2, 4]\nbank_angle = 90\nstrokes = 2"))
    )
    with pytest.raises(BalcliError, match=r"give crank\.throws, so that the crank stays as it is"):
        search_least(file, over, "force.1.major")


def test_written_file_keeps_its_comments() -> None:
    pairs = ("throws = [0, 180, 180, 0]", "throws = [0, 180, 180, 0]  # deg"), ("firing_order = [1, 3, 4, 2]\n", "")
    text = changed(*pairs, more="# the end\n")
    wanted = text.replace("[0, 180, 180, 0]  # deg", "[0.0, 180.0, 0.0, 180.0]  # deg (found by balcli)")
    assert write_design(text.encode(), {"throws": [0.0, 180.0, 0.0, 180.0]}) == wanted


def test_written_file_drops_a_firing_order_that_no_longer_fits() -> None:
    new = load(write_design(GOOD.encode(), {"throws": [0.0, 0.0, 180.0, 180.0]}))
    assert new.crank.throws == (0, 0, 180, 180)
    assert new.layout.firing_order is None
    build(new)


ARTICULATED = engine_text(
    crank="stroke = 100\nthrows = [0, 100, 190, 250]\nspacing = 100",
    rod="length = 200\nmass = 1\ncg = 60",
    layout="banks = [-50, 10, 60]",
    articulation="knuckle_radius = 40\nrod = { length = 160, mass = 0.9, cg = 20 }",
)


def test_articulated_rods_count_once_for_their_throw() -> None:
    """The shares of all throws add up to the whole."""
    file = load(ARTICULATED)
    quantities = parse_quantities("force.1.major,moment.2.major")
    angles = np.array([0.0, 100, 190, 250])
    found = tabulate_contributions(file, angles, 0, quantities)
    for q, whole in zip(quantities, evaluate_quantities(build(file), quantities), strict=True):
        sums = found.throws[:, :, range(4), range(4)].sum(axis=2)[..., None]
        assert found.read(q, sums)[0] == pytest.approx(float(whole), rel=1e-9)


def test_throws_that_follow_from_the_firing_order_are_permuted_like_those_given():
    """1-5-3-6-2-4 asks for 0, 240, 120, 120, 240, 0 of a six with four strokes."""
    six = changed(("[1, 3, 4, 2]", "[1, 5, 3, 6, 2, 4]"))
    goal = parse_objective("moment.1.major,moment.2.major")
    derived, given = (
        search_arrangements(load(six.replace("throws = [0, 180, 180, 0]", throws)), "throws", goal, 5)
        for throws in ("", "throws = [0, 240, 120, 120, 240, 0]")
    )
    assert len(given.results) == 5
    assert given.results[0].objective == 0
    assert derived.results == given.results


@pytest.mark.parametrize("limit", ["shaft.a.stress<6e7", "shaft.a.stress<60 N/mm^2", "shaft.a.stress<60 MPa"])
def test_a_limit_may_have_a_unit(limit):
    assert list(parse_objective("moment.1.major", [limit]).limits.values()) == [pytest.approx(6e7, rel=1e-15)]
