"""Planted unbalance is found: with trial weights on and off, at several speeds, in either sense of
angles, with a correction in; and what cannot be found is refused.
"""

import math

import numpy as np
import pytest
from support.cases import cases, slow
from support.rotors import head, names, random_rotor, run, table, three_runs

from balcli.core.unbalance import STEEL
from balcli.errors import BalcliError
from balcli.field_balancing.answer import find_corrections
from balcli.field_balancing.runs_file import parse_runs

RELATIVE = 1e-12


def balance(text: str, *args, **options):
    return find_corrections(parse_runs(text), *args, **options)


def totals(text: str, **options):
    return np.array([p.weight for p in balance(text, **options).corrections])


def agree(found, planted, coefficients) -> bool:
    """Within rounding errors, which the condition makes larger."""
    condition = np.linalg.cond(coefficients)
    return np.abs(found - planted).max() <= RELATIVE * condition * np.abs(planted).max()


SIZES = [(p, r) for p in range(2, 7) for r in (2, 4, 7, 12, 24) if r >= p]


@pytest.mark.parametrize(("planes", "readings"), SIZES)
@pytest.mark.parametrize("keep", [False, True])
def test_planted_unbalance_is_found(planes, readings, keep):
    """Runs with one trial weight each, taken off or left in."""
    alpha, excess = random_rotor(planes * 100 + readings, readings, planes)
    trials = np.exp(1j * np.arange(planes)) * 0.7
    text = head(planes)
    on = np.zeros(planes, dtype=complex)
    text += run(alpha @ excess)
    for k, name in enumerate(names(planes)):
        on = on if keep else np.zeros(planes, dtype=complex)
        on[k] += trials[k]
        text += run(alpha @ (excess + on), [(name, trials[k])], f"keep_trial = {str(keep).lower()}")
    assert agree(totals(text), -excess, alpha)
    assert agree(totals(text, minimise="max"), -excess, alpha)


@pytest.mark.parametrize("trims", [[], [(1500, "a")], [(3000, "a")], [(3000, "a"), (1500, "b")]])
def test_corrections_go_on_from_the_last_run_at_whatever_speed(trims):
    """Two planes at two speeds, one sensor at each: neither speed alone tells both weights. Corrections are tried at none
    of them, at one, or at one after the other.
    """
    alpha, excess = random_rotor(1, 2, 2)
    put_on = {"a": np.array([0.7 - 0.2j, 0.1j]), "b": np.array([-0.3, 0.4 + 0.1j])}
    text = head(2)
    row = {1500: 0, 3000: 1}
    for states in ([], [("p1", 0.5)], [("p2", 0.5j)]):
        on = np.array([dict(states).get(name, 0) for name in names(2)])
        for speed in row:
            text += run([alpha[row[speed]] @ (excess + on)], states, f"speed = {speed}")
    for speed, name in trims:
        states = list(zip(names(2), put_on[name], strict=True))
        reading = alpha[row[speed]] @ (excess + put_on[name])
        text += run([reading], states, f'speed = {speed}\nname = "{name}"')
    found = balance(text)
    assert found.trimmed == (trims[-1][1] if trims else None)
    assert agree(np.array([p.weight for p in found.corrections]), -excess, alpha)
    on = put_on.get(found.trimmed, 0)
    assert agree(np.array([p.step for p in found.corrections]), -excess - on, alpha)


@pytest.mark.parametrize("rotation", ["lag", "lead"])
@pytest.mark.parametrize("sense", ["with", "against"])
def test_senses_of_angles(rotation, sense):
    """Of a rotor in real angles with rotation; what is read and written counts as the file says."""
    alpha, excess = random_rotor(2, 3, 2)
    readings = np.conj if rotation == "lag" else np.asarray
    weights = np.conj if sense == "against" else np.asarray
    trial = np.array([0.4 + 0.3j, -0.2 + 0.5j])
    text = head(2, f'rotation = "{rotation}"\nweights = "{sense}"') + run(readings(alpha @ excess))
    for k, name in enumerate(names(2)):
        on = np.where(np.arange(2) == k, trial, 0)
        text += run(readings(alpha @ (excess + on)), [(name, complex(weights(trial)[k]))])
    assert agree(totals(text), weights(-excess), alpha)
    if (rotation, sense) in (("lag", "against"), ("lead", "with")):  # without a sense they count as phases do
        assert np.array_equal(totals(text), totals(text.replace(f'weights = "{sense}"', "")))


def test_fits_by_hand():
    """Readings 4, 5, 1 at weights 0, 1, -2: the slope of the regression line is 19/14, and the correction goes on from 1
    at -2. Read twice as found, 9 and 11: their mean counts. A repeated run has no correction in.
    """
    result = balance(head(1) + run([4]) + run([5], [("p1", 1)]) + run([1], [("p1", -2)]))
    assert result.influence[0, 0] == pytest.approx(19 / 14, rel=1e-13)
    assert result.corrections[0].step == pytest.approx(-14 / 19, rel=1e-13)
    assert result.corrections[0].weight == pytest.approx(-2 - 14 / 19, rel=1e-13)
    result = balance(head(1) + run([9]) + run([11]) + run([15], [("p1", 1)]))
    assert result.runs.found == pytest.approx([10], rel=1e-13)
    assert result.influence[0] == pytest.approx([5], rel=1e-13)
    assert result.corrections[0].weight == pytest.approx(-2, rel=1e-13)
    found = run([40, 30j])
    trials = run([50, 31.5j], [("p1", 5)]) + run([40 + 3j, 39j], [("p2", 6)])
    again = head(2) + found + trials + run([50, 31.5j], [("p1", 5)]) + found
    assert (balance(again).trimmed, balance(again).corrections[0].add) == (None, None)
    assert balance(again + run([50 + 3j, 39 + 1.5j], [("p1", 5), ("p2", 6)])).trimmed == "run 6"


def test_weights_of_readings():
    """One plane: the mean of what two sensors want, weighted by the squares."""
    text = 'planes = ["p1"]\ninfluence = [["1 @ 0"], ["1 @ 0"]]\n'
    runs = run([1, 4])
    assert totals(text + runs)[0] == pytest.approx(-2.5, rel=1e-13)
    assert totals(text + "reading_weights = [1, 2]\n" + runs)[0] == pytest.approx(-17 / 5, rel=1e-13)


# ------------------------------------------------------------------ trial weights at another radius
AT_150 = """
planes = ["fan"]
weights = "with"
radius = [250]
grade = 6.3
mass = 100
speed = 3000
[[run]]
readings = ["8.5 @ 45"]
[[run]]
readings = ["6.2 @ 95"]
weights = { fan = "10 @ 0" }
radius = { fan = 150 }
"""


def test_a_trial_weight_counts_at_its_radius():
    """By hand: the trial of 10 g at 150 mm is 6 g at 250 mm; the correction is -8.5 @ 45 / alpha, in angles against those
    of the readings.
    """
    alpha = (6.2 * np.exp(1j * np.radians(95)) - 8.5 * np.exp(1j * np.radians(45))) / 6
    wanted = np.conj(-8.5 * np.exp(1j * np.radians(45)) / alpha)
    result = balance(AT_150)
    assert result.corrections[0].weight == pytest.approx(wanted, rel=1e-13)
    assert result.corrections[0].unbalance_g_mm == pytest.approx(250 * abs(wanted), rel=1e-13)
    assert result.permitted.planes[0].present_g_mm == pytest.approx(250 * abs(wanted), rel=1e-13)
    same = balance(AT_150.replace("radius = { fan = 150 }", "").replace("10 @ 0", "6 @ 0"))
    assert same.corrections[0].weight == pytest.approx(wanted, rel=1e-13)


@pytest.mark.parametrize("keep", [False, True])
def test_a_trial_weight_that_stays_keeps_its_radius(keep):
    alpha, excess = random_rotor(5, 3, 2)
    text = head(2, "radius = [200, 300]") + run(alpha @ excess)
    on = np.array([0.4 * 150 / 200, 0])
    kept = f"keep_trial = {str(keep).lower()}\n"
    text += run(alpha @ (excess + on), [("p1", 0.4)], kept + "radius = { p1 = 150 }")
    on = on * keep + np.array([0, 0.3j * 350 / 300])
    text += run(alpha @ (excess + on), [("p2", 0.3j)], "radius = { p2 = 350 }")
    assert agree(totals(text), -excess, alpha)


# ------------------------------------------------------------------ the shop
def test_drilled_holes_remove_what_weights_would_add():
    """The steel of all holes, from the rim inwards, has the unbalance of the correction."""
    text = three_runs(
        "radius = [90, 80]\nplaces = [12, [0, 60, 120, 180, 240, 300]]\ndrill = [6, 8]\ndeepest = [12, 20]"
    )
    for p, rim, drill in zip(balance(text).corrections, (90, 80), (6, 8), strict=True):
        removed = 0
        for piece in p.pieces:
            area = math.pi * (drill / 2e3) ** 2
            depth = piece.depth_mm / 1e3
            unbalance = STEEL * area * depth * (rim / 1e3 - depth / 2)
            removed += unbalance * np.exp(1j * np.radians(piece.angle_deg))
        assert -removed == pytest.approx(p.weight * 1e-3 * rim / 1e3, rel=1e-9)
    one = "radius = [90, 90]\nplaces = [24, 24]\ndrill = [6, 6]"
    free, shallow = (balance(three_runs(one + more)).corrections[0].pieces for more in ("", "\ndeepest = [3, 3]"))
    assert len(free) == 2 < len(shallow)
    assert max(piece.depth_mm for piece in shallow) <= 3 * (1 + 1e-9)


def put_on(planes, drilled=False):
    """What the shop's pieces are together, in each plane."""
    pieces = [[p.weight * np.exp(1j * np.radians(p.angle_deg)) for p in q.pieces] for q in planes]
    return (-1 if drilled else 1) * np.array([sum(piece) for piece in pieces])


@pytest.mark.parametrize(("sense", "minimise"), [("with", "squares"), ("against", "max")])
@cases("field_balancing/balance_rotor", "limits")
def test_what_does_not_fit_leaves_what_it_says(limits, sense, minimise):
    """The readings after are those of the pieces, and pieces a little otherwise leave more."""
    last = run([60, 70j], [("front", 0.3), ("rear", 0.2j)]) if "drill" in limits else ""
    text = three_runs(f'weights = "{sense}"\n{limits}', last)
    result = balance(text, minimise)
    on = put_on(result.corrections, "drill" in limits)
    assert on == pytest.approx([p.step for p in result.corrections], rel=1e-8, abs=1e-9)
    turn = np.conj if sense == "with" else np.asarray
    after = result.before + result.influence @ turn(on)
    assert result.residual == pytest.approx(after, rel=1e-7, abs=1e-7)
    assert result.limited
    assert np.abs(result.residual).max() > 1
    free = balance(three_runs(f'weights = "{sense}"', last), minimise)
    for one, other in zip(result.corrections, free.corrections, strict=True):
        assert one.at_limit == (one.wanted is not None)
        assert one.wanted is None or one.wanted == pytest.approx(other.weight, rel=1e-9)


def test_a_plane_that_fits_makes_up_for_one_that_does_not():
    """One sensor, by hand: 10 at 0 deg; what goes on at 90 deg only cannot help, the other can."""
    text = head(2, 'places = [[90], "free"]\ninfluence = [["1 @ 0", "1 @ 0"], ["0 @ 0", "0.1 @ 0"]]')
    result = balance(text + run([10, 0]))
    assert result.corrections[0].pieces == ()
    assert result.corrections[1].step == pytest.approx(-10 / 1.01, rel=1e-9)
    assert [p.at_limit for p in result.corrections] == [True, False]


def test_the_grade_judges_what_is_there_not_what_fits():
    """Whatever the limits, the unbalance now is what would cancel the readings."""
    grade = "grade = 6.3\nmass = 120\nspeed = 3000\nradius = [200, 200]\n"
    free = balance(three_runs(grade))
    tight = balance(three_runs(grade + "most = [0.5, 0.5]"))
    for one, other, limited in zip(free.permitted.planes, tight.permitted.planes, tight.corrections, strict=True):
        assert one.present_g_mm == pytest.approx(other.present_g_mm, rel=1e-12)
        assert one.after_g_mm == 0
        assert other.after_g_mm == pytest.approx(200 * abs(limited.wanted - limited.weight), rel=1e-12)


GRADE = "grade = 6.3\nmass = 1\nspeed = 3000\nradius = [1, 1]\n"


@pytest.mark.parametrize("case", ["as found", *slow("corrected", "given", "weighted", "two speeds")])
def test_the_true_unbalance_lies_within_its_scatter_as_often_as_promised(case):
    """Planted unbalance, readings with errors of known size: 95 of 100 estimates."""
    speeds, sensors = (2, 2) if case == "two speeds" else (1, 3)
    alpha, excess = random_rotor(7, sensors * speeds, 2)
    scale = np.array([1.0, 2, 3][:sensors]) if case == "weighted" else np.ones(sensors)
    start = head(2, GRADE + f"reading_weights = {scale.tolist()}")
    start += f"influence = [{', '.join(map(table, alpha))}]\n" if case == "given" else ""
    states = [[]] + [[(name, 1 + 0.3j)] for name in names(2)] * (case != "given")
    states += [list(zip(names(2), -0.97 * excess, strict=True))] * (case != "as found")
    there = excess * (1 if case == "as found" else 0.03)
    within = []
    rng = np.random.default_rng(1)
    for _ in range(150 if case == "as found" else 400):
        text = start
        for state in states:
            on = excess + np.array([dict(state).get(name, 0) for name in names(2)])
            for speed in range(speeds if len(state) < 2 else 1):  # corrected at one of them
                errors = 0.02 / scale * (rng.normal(size=(sensors, 2)) @ [1, 1j])
                readings = alpha[speed * sensors : (speed + 1) * sensors] @ on + errors
                text += run(readings, state, f"speed = {1000 * (speed + 1)}")
        found = balance(text)
        for plane, exact, each in zip(found.permitted.planes, there, found.corrections, strict=True):
            within.append(abs(each.step + exact) <= plane.scatter_g_mm)
            assert plane.reached == (plane.present_g_mm + plane.scatter_g_mm <= plane.permitted_g_mm)
    assert np.mean(within) == pytest.approx(0.95, abs=0.035)


def test_readings_that_fit_badly_do_not_prove_that_the_grade_is_reached():
    """The weights left in cancel what they can, but 9 of 10 stay, in a way no weight makes."""
    runs = run([10, 10]) + run([11, 11], [("p1", 1)]) + run([9, -9], [("p1", -10)])
    grade = GRADE.replace("1, 1", "1").replace("mass = 1", "mass = 0.4")
    (plane,) = balance(head(1, grade) + runs).permitted.planes
    assert plane.present_g_mm < plane.permitted_g_mm
    assert plane.present_g_mm + plane.scatter_g_mm > plane.permitted_g_mm
    assert (plane.reached, plane.verdict) == (False, "uncertain")


def test_the_smallest_largest_reading_is_no_estimate_of_the_unbalance():
    """Three readings of one plane: the weight for the smallest largest one differs from the best
    estimate, by which the grade is judged.
    """
    text = head(1, GRADE.replace("1, 1", "1") + 'influence = [["1 @ 0"], ["1 @ 0"], ["1 @ 0"]]')
    squares, largest = (balance(text + run([1, 1, 4]), m) for m in ("squares", "max"))
    assert abs(largest.corrections[0].weight) == pytest.approx(2.5, rel=1e-6)
    (one,) = squares.permitted.planes
    (other,) = largest.permitted.planes
    assert (one.present_g_mm, one.scatter_g_mm) == (other.present_g_mm, other.scatter_g_mm)
    assert one.present_g_mm == pytest.approx(2, rel=1e-12)
    assert other.after_g_mm == pytest.approx(0.5, rel=1e-6)


@pytest.mark.parametrize("key", ["grade", "mass", "speed", "radius"])
def test_a_grade_that_lacks_a_figure_refuses_nothing(key):
    lines = "grade = 6.3\nmass = 120\nspeed = 3000\nradius = [200, 200]\nshares = [1, 2]".splitlines()
    text = three_runs("\n".join(line for line in lines if not line.startswith(key)))
    found = balance(text)
    assert found.permitted is None
    assert found.corrections[0].weight == balance(three_runs()).corrections[0].weight
    (doubt,) = found.doubts
    assert str(doubt).startswith(f"{key}: is missing, so the grade is not checked; give it, such as {key} = ")


def test_places_are_numbered_as_the_file_has_them():
    text = head(2, 'places = [8, [200, 90, 100]]\ninfluence = [["1 @ 0", "0 @ 0"], ["0 @ 0", "1 @ 0"]]')
    first, second = balance(text + run([5j, -3j])).corrections
    assert [(p.place, p.angle_deg) for p in first.pieces] == [(7, 270)]
    assert [(p.place, p.angle_deg) for p in second.pieces] == [(2, 90)]


def test_unbalances_instead_of_weights():
    """230 g mm is 1.15 g at 200 mm; grades permit the same."""
    grade = "grade = 6.3\nmass = 120\nspeed = 3000\nshares = [1, 3]\n"
    grams = balance(three_runs(grade + "radius = [200, 200]"))
    text = three_runs(grade + 'weight_unit = "g mm"').replace("1.15 @", "230 @")
    moments = balance(text)
    whole = 120e3 * 6.3 / (100 * math.pi)
    for one, other in zip(grams.corrections, moments.corrections, strict=True):
        assert one.unbalance_g_mm == pytest.approx(other.unbalance_g_mm, rel=1e-12)
        assert one.unbalance_g_mm == pytest.approx(200 * abs(one.weight), rel=1e-12)
    for one, other, share in zip(grams.permitted.planes, moments.permitted.planes, (1 / 4, 3 / 4), strict=True):
        assert one.permitted_g_mm == pytest.approx(whole * share, rel=1e-12)
        assert one.present_g_mm == pytest.approx(other.present_g_mm, rel=1e-12)
    assert grams.permitted.reached
    ounces = balance(three_runs('weight_unit = "oz"\nradius = [100, 100]'))
    assert ounces.corrections[0].unbalance_g_mm == pytest.approx(28.349523125 * 100 * 1.97946764, rel=1e-8)


def test_what_stays_on_in_a_plane_left_out_counts_at_every_speed():
    """An exact rotor, read again at one speed with weights in both planes: at the other the weight
    of the plane that is left out counts, too.
    """
    alpha, excess = random_rotor(11, 4, 2)
    on = np.array([0.3 + 0.1j, -0.2 + 0.4j])
    text = head(2)
    for rows, speed in ((alpha[:2], "speed = 1000"), (alpha[2:], "speed = 2000")):
        text += run(rows @ excess, (), speed)
        for k, name in enumerate(names(2)):
            text += run(rows @ (excess + np.eye(2)[k]), [(name, 1.0)], speed)
    text += run(alpha[:2] @ (excess + on), list(zip(names(2), on, strict=True)), "speed = 1000")
    result = balance(text, without=["p2"])
    left = alpha @ (excess + np.array([result.corrections[0].weight, on[1]]))
    assert result.residual == pytest.approx(left, rel=1e-10)


# ------------------------------------------------------------------ doubts and refusals
def at_speeds() -> str:
    """What a heavy trial weight does at the other speed hid that of 0.01 here."""
    text = head(1)
    for speed, weight, after in ((1500, 0.01, 10.011), (3000, 50, 14)):
        text += run([10], [], f"speed = {speed}") + run([after], [("p1", weight)], f"speed = {speed}")
    return text


def in_other_sense(known: bool, sense: str) -> str:
    """With trials at 0 the sense makes no difference, but the correction is 8j where -8j was needed."""
    runs = run([8j]) + ("" if known else run([8j + 2], [("p1", 2)])) + run([16j], [("p1", 8j)], 'name = "in"')
    return sense + head(1, 'influence = [["1 @ 0"]]' if known else "") + runs


OFF = run([8]) + run([9], [("p1", 1)])
GRADED = "radius = [100, 100]\ngrade = 2.5\nmass = 30\nspeed = 1800"
QUIET = {
    "plain": three_runs(),
    "the right sense": in_other_sense(True, ""),
    "a run near its prediction": head(1) + OFF + run([5], [("p1", -5)]),
    "0.1 next to a change of 8": head(1) + run([0.05]) + run([8], [("p1", 4)]) + run([-7.8], [("p1", -4)]),
    "rounding next to 0": head(1) + run([0]) + run([1 / 3], [("p1", 0.1j)]) + run([1], [("p1", 0.3j)]),
    "a grade": three_runs(GRADED),
}


RUNS = {"RUNS": three_runs("# head"), "SPEEDS": at_speeds(), "OFF": OFF + run([9], [("p1", -5)])}
SENSES = {name: in_other_sense(known, 'weights = "with"\n') for name, known in (("FITTED", False), ("KNOWN", True))}


@cases("field_balancing/balance_rotor", "doubts", **RUNS, **SENSES, HEAD=head(1))
def test_doubts(text, doubt):
    assert doubt in map(str, balance(text).doubts)


@pytest.mark.parametrize("text", QUIET.values(), ids=QUIET)
def test_nothing_to_doubt(text):
    assert balance(text).doubts == ()


def test_what_is_permitted_is_not_judged_in_a_plane_left_out():
    found = balance(three_runs(GRADED), without=["rear"])
    assert str(found.doubts[0]) == (
        "the permitted unbalance is checked without rear, whose unbalance is unknown; readings of "
        f"up to {found.largest:.4g} remain"
    )


def refused(text: str, **options) -> str:
    with pytest.raises(BalcliError) as caught:
        balance(text, name="runs.toml", **options)
    return str(caught.value)


@cases("field_balancing/balance_rotor", "runs_that_do_not_tell_are_refused")
def test_runs_that_do_not_tell_are_refused(text, message):
    assert refused(text) == message


def test_planes_to_leave_out_must_be_there():
    assert refused(three_runs(), without=["reer"]) == ('without "reer" is not a plane; did you mean rear?')
    assert refused(three_runs(), without=["rear", "front"]) == ("without leaves no plane for a weight")


def test_a_rotor_without_unbalance_needs_nothing():
    text = head(1, 'influence = [["1 @ 0"]]') + run([0])
    for minimise in ("squares", "max"):
        result = balance(text, minimise)
        assert result.corrections[0].weight == 0
        assert result.largest == 0
