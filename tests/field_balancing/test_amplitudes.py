"""Balancing without phase: a planted unbalance is found from amplitudes, two answers are both given, and
what cannot be found is refused.
"""

import re

import numpy as np
import pytest
from hypothesis import example, given, settings, strategies as st
from support.cases import cases
from support.commands import ask, ask_csv, ask_json, run_here
from support.paths import write
from support.rotors import head, names, polar, random_rotor

from balcli.errors import InputError
from balcli.field_balancing.answer import find_corrections
from balcli.field_balancing.runs_file import parse_runs

RELATIVE = 1e-9
THREE = [8, 8 * np.exp(2j * np.pi / 3), 8 * np.exp(-2j * np.pi / 3)]


def run(readings, weights=(), extra="") -> str:
    """One [[run]] without phases; weights are (plane, complex)."""
    on = ", ".join(f'{plane} = "{polar(weight)}"' for plane, weight in weights)
    listed = ", ".join(f"{float(np.abs(reading)):.17g}" for reading in readings)
    return f"[[run]]\nreadings = [{listed}]\nweights = {{ {on} }}\n{extra}\n"


def one_plane(alpha, unbalance, trials, extra="") -> str:
    """Runs of a rotor in one plane; alpha has one row for each sensor."""
    alpha = np.atleast_1d(alpha)
    states = [0, *trials]
    return head(1, extra) + "".join(run(alpha * (unbalance + w), [("p1", w)] if w else []) for w in states)


def balance(text: str, **options):
    return find_corrections(parse_runs(text), **options)


def refused(text: str) -> str:
    with pytest.raises(InputError) as caught:
        balance(text)
    return str(caught.value)


# ------------------------------------------------------------------ one answer
def test_the_closed_form_of_four_runs():
    """q = (mean of A_k^2 - A_0^2) / W^2 and u = sum of A_k^2 w_k / (3 W^2 q)."""
    alpha, unbalance = 0.37 * np.exp(0.4j), 12 * np.exp(1.1j)
    amplitudes = np.abs(alpha * (unbalance + np.array(THREE)))
    slope = (np.mean(amplitudes**2) - abs(alpha * unbalance) ** 2) / 64
    closed = np.sum(amplitudes**2 * THREE) / (3 * 64 * slope)
    result = balance(one_plane(alpha, unbalance, THREE))
    assert result.corrections[0].weight == pytest.approx(-closed, rel=RELATIVE)
    assert (result.method, result.ambiguous, result.fit_rms, result.solutions) == ("amplitudes", False, 0, None)
    assert result.before == pytest.approx([abs(alpha * unbalance)], rel=RELATIVE)
    assert abs(result.influence[0, 0]) == pytest.approx(abs(alpha), rel=RELATIVE)


@settings(max_examples=60, deadline=None)
@given(st.floats(0.1, 10), st.floats(0, 2 * np.pi), st.floats(0.01, 100), st.integers(1, 4))
@example(1.0, np.pi / 3, 1.0, 1)  # the unbalance on the circle of the trial weights
def test_a_planted_unbalance_is_found_in_one_plane(size, angle, gain, sensors):
    unbalance = size * 8 * np.exp(1j * angle)
    alpha = gain * np.exp(1j * np.arange(sensors)) * (1 + np.arange(sensors))
    result = balance(one_plane(alpha, unbalance, THREE))
    assert abs(result.corrections[0].weight + unbalance) <= 1e-7 * max(abs(unbalance), 8)
    assert result.fit_rms <= 1e-9 * gain


@pytest.mark.parametrize("seed", range(5))
def test_a_planted_unbalance_is_found_in_two_planes(seed):
    """Seven runs and one with weights in both planes; the correction refers to the rotor as found."""
    alpha, excess = random_rotor(seed, 3, 2)
    text = head(2) + run(alpha @ excess)
    for k, name in enumerate(names(2)):
        for w in (0.8, 0.7j, -0.5 - 0.6j):
            text += run(alpha @ (excess + np.where(np.arange(2) == k, w, 0)), [(name, w)])
    on = np.array([0.3, 0.2j])
    text += run(alpha @ (excess + on), list(zip(names(2), on, strict=True)))
    found = np.array([each.weight for each in balance(text).corrections])
    assert np.abs(found + excess).max() <= RELATIVE * np.linalg.cond(alpha) * np.abs(excess).max()
    assert balance(text, without=["p2"]).left_out == ["p2"]


def test_the_fit_is_the_least_sum_of_squares():
    """With errors in all readings, no unknown can be moved to a smaller sum."""
    rng = np.random.default_rng(3)
    trials = np.array([*THREE, 5j, -3 + 2j])
    states = np.array([0, *trials])
    read = np.abs(0.4 * (9 - 4j + states)) * (1 + 0.04 * rng.normal(size=6))
    text = head(1) + "".join(run([a], [("p1", w)] if w else []) for a, w in zip(read, states, strict=True))
    result = balance(text)
    unknowns = np.array([result.before[0].real, result.influence[0, 0].real, result.influence[0, 0].imag])

    def total(x):
        return np.sum((read - np.abs(x[0] + (x[1] + 1j * x[2]) * states)) ** 2)

    least = total(unknowns)
    assert result.fit_rms == pytest.approx(np.sqrt(least / 6), rel=1e-12)
    for direction in rng.normal(size=(50, 3)):
        assert total(unknowns * (1 + 1e-4 * direction)) > least


def test_trial_weights_that_stay_and_at_another_radius():
    """As found, 8 at 0 (at twice the radius: 16), and two more on top of it."""
    unbalance = 5 - 3j
    on = 16
    states = [on, on + 8j, on - 8 - 8j]
    text = head(1, "radius = [100]") + run([unbalance])
    text += run([unbalance + states[0]], [("p1", 8)], "keep_trial = true\nradius = { p1 = 200 }")
    text += run([unbalance + states[1]], [("p1", 8j)])
    text += run([unbalance + states[2]], [("p1", -8 - 8j)])
    assert balance(text).corrections[0].weight == pytest.approx(-unbalance, rel=RELATIVE)


# ------------------------------------------------------------------ two answers
@pytest.mark.parametrize(
    ("trials", "decides"),
    [
        ([8, 8j], -8),
        ([8, 8 + 8j, 8j], 4 + 4j),  # all on one circle with 0
        ([8, -4], 3j),  # on a line
    ],
)
def test_two_answers_fit_until_a_weight_off_the_circle_decides(trials, decides):
    """Both answers predict all readings that were taken, and differ in the one that decides."""
    unbalance = 3 + 7j
    result = balance(one_plane([0.5, 0.2j], unbalance, trials))
    assert (result.ambiguous, result.corrections, result.permitted) == (True, (), None)
    pair = np.array(result.solutions)
    assert min(np.abs(pair + unbalance)) <= RELATIVE * abs(unbalance)
    assert abs(pair[0]) <= abs(pair[1]) * (1 + 1e-12)
    ratios = np.abs(pair[:, None] - np.array([0, *trials])) / np.abs(pair[:, None])
    assert ratios[0] == pytest.approx(ratios[1], rel=RELATIVE)
    unique = balance(one_plane([0.5, 0.2j], unbalance, [*trials, decides]))
    assert unique.corrections[0].weight == pytest.approx(-unbalance, rel=1e-7)


def test_the_prediction_for_the_lighter_answer(tmp_path):
    """If the heavier one is right, the lighter weight leaves |u - lighter| of the reading."""
    unbalance = 12 * np.exp(1j * np.radians(61))
    path = write(tmp_path / "runs.toml", one_plane(0.37, unbalance, [8, 8j]))
    said = ask_json("field", path)
    lighter = said["solutions"][0]
    put_on = lighter["weight"] * np.exp(1j * np.radians(lighter["angle_deg"]))
    assert abs(put_on + unbalance) > 1
    out = ask("field", path)
    assert re.search(rf"^sensor 1 +4\.44 +0 +{0.37 * abs(put_on + unbalance):.4g}$", out, re.MULTILINE)
    assert "Two answers fit. Put the lighter one on" in " ".join(out.split())
    assert run_here("field", "-", "--check", stdin=graded(path.read_text())).status == 1
    found = {(r["part"], r["figure"]) for r in ask_csv("field", path)}
    assert {("solution", "weight"), ("details", "fit_rms")} <= found
    picture = tmp_path / "polar.svg"
    assert run_here("field", path, "--plot", picture).status == 0
    assert "amplitudes only" in picture.read_text(encoding="utf-8")
    assert "angles as they are marked" in picture.read_text(encoding="utf-8")
    assert "heavier: 12" in picture.read_text(encoding="utf-8")


def graded(text: str) -> str:
    return text.replace("[[run]]", "grade = 6.3\nmass = 60\nspeed = 1500\nradius = [180]\n[[run]]", 1)


def test_a_centre_has_no_image():
    """The unbalance is opposite to the centre of the circle: all readings are equal, and one answer is left."""
    result = balance(one_plane(1, -4 - 4j, [8, 8j]))
    assert result.ambiguous is False
    assert result.corrections[0].weight == pytest.approx(4 + 4j, rel=1e-6)


# ------------------------------------------------------------------ corrections on
def test_a_correction_run_is_told_what_to_add(tmp_path):
    """The planted unbalance of 12 g at 57.3 deg is opposed by 11 g: 1 g is missing. JSON `before` and `present_g_mm`
    stay those of the rotor as found."""
    unbalance = 12 * np.exp(1j)
    text = graded(one_plane(0.37, unbalance, [*THREE, -11 * np.exp(1j)], "places = [4]"))
    result = balance(text)
    (correction,) = result.corrections
    assert correction.weight == pytest.approx(-unbalance, rel=RELATIVE)
    assert correction.add == pytest.approx(-np.exp(1j), rel=1e-7)
    assert sum(piece.weight * np.exp(1j * np.radians(piece.angle_deg)) for piece in correction.pieces) == (
        pytest.approx(correction.add, rel=1e-7)
    )
    assert result.before == pytest.approx([0.37 * 12], rel=RELATIVE)
    assert result.runs.latest == pytest.approx([0.37], rel=1e-7)
    (plane,) = result.permitted.planes
    assert plane.present_g_mm == pytest.approx(12 * 180, rel=RELATIVE)
    assert plane.trimmed_g_mm == pytest.approx(180, rel=1e-7)
    assert plane.reached is (plane.permitted_g_mm >= 180)
    out = " ".join(ask("field", write(tmp_path / "runs.toml", text)).split())
    assert "in addition to the weights of 'run 5'" in out
    assert "sensor 1 4.44 0.37 0" in out


@pytest.mark.parametrize(
    ("extra", "trimmed"), [([], None), ([THREE[1]], None), ([0], None), ([3j], "run 5"), ([3j, 0], "run 5")]
)
def test_only_new_weights_after_the_runs_that_suffice_are_corrections(extra, trimmed):
    assert balance(one_plane(0.37, 12 * np.exp(1j), [*THREE, *extra])).trimmed == trimmed


def test_two_planes_have_correction_runs():
    """Both planes at once after the seven runs."""
    alpha = np.array([[0.3, 0.1j], [0.05, 0.2 - 0.1j]])
    unbalance = np.array([10, -6j])
    trials = [(w, 0) for w in THREE] + [(0, w) for w in THREE]
    text = head(2)
    for on in [(0, 0), *trials, (-9, 5j)]:
        weights = [(name, w) for name, w in zip(("p1", "p2"), on, strict=True) if w]
        text += run(alpha @ (unbalance + np.array(on)), weights)
    corrections = balance(text).corrections
    assert [each.add for each in corrections] == pytest.approx([-1, 1j], rel=1e-6)


def test_as_found_is_what_was_measured(tmp_path):
    """The mean of both runs without weights, where the fit has another value."""
    text = one_plane(0.37, 12 * np.exp(1j), THREE) + run([4.0])
    result = balance(text)
    assert result.fit.measured == pytest.approx([(4.0 + 0.37 * 12) / 2])
    assert abs(result.before[0] - result.fit.measured[0]) > 0.01
    assert "sensor 1 4.22 0" in " ".join(ask("field", write(tmp_path / "runs.toml", text)).split())


# ------------------------------------------------------------------ text
def test_the_sheet_speaks_of_amplitudes(tmp_path):
    path = write(tmp_path / "runs.toml", graded(one_plane(0.37, 12 * np.exp(1j), THREE, 'unit = "um"')))
    out = " ".join(ask("field", path).split())
    assert "Readings are amplitudes only; angles of weights count as they are marked." in out
    assert "Misfit of the amplitudes: 0 um (rms), 0.0% of the largest reading." in out
    for absent in ("Phases of readings", "like phases", "scatter"):
        assert absent not in out
    (plane,) = ask_json("field", path)["permitted"]["planes"]
    assert "scatter_g_mm" not in plane
    assert plane["present_g_mm"] == pytest.approx(12 * 180, rel=1e-9)


@pytest.mark.parametrize(("error", "doubted"), [(1.1, False), (1.4, True)])
def test_readings_that_do_not_fit_are_doubted(error, doubted):
    unbalance = 12 * np.exp(1j)
    states = [0, *THREE, 8j, -8j, -8]
    text = head(1, 'unit = "um"')
    for k, w in enumerate(states):
        reading = 0.37 * abs(unbalance + w) * (error if k == 1 else 1)
        text += run([reading], [("p1", w)] if w else [], f'name = "number {k}"')
    doubts = [each for each in balance(text).doubts if "do not fit one unbalance" in each.message]
    assert bool(doubts) == doubted
    assert all("repeat 'number 1', which fits worst" in each.message for each in doubts)


# ------------------------------------------------------------------ what is refused
@cases("field_balancing/amplitudes", "amplitudes_that_do_not_suffice_are_refused")
def test_amplitudes_that_do_not_suffice_are_refused(text, message):
    assert message in refused(text)
