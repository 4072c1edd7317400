"""Every scheme side by side: Wang's comparison of methods for a single cylinder, and what is left out."""

import numpy as np
import pytest
from support.commands import ask_csv, ask_json, refusal, run_here
from support.engines import engine
from support.paths import ENGINES

from balcli import compare_schemes, load_example

LAM = 0.25
# A cylinder without rotating mass
SINGLE = {
    "crank": {"stroke": 80, "throws": [0], "throw_mass": 0},
    "rod": {"length": 40 / LAM, "big_end": 0, "small_end": 0.1},
    "piston": {"mass": 0.4, "bore": 80},
    "operation": {"speed": 3000},
}


def shares(comparison):
    return {(row.scheme, row.design): row.force_share for row in comparison.schemes}


def test_methods_for_a_single_cylinder():
    """Shares of m r w^2 at lambda = 0.25, from the acceleration of the piston on a grid of crank angles."""
    theta = np.linspace(0, 2 * np.pi, 200_001)
    sine = LAM * np.sin(theta)
    force = np.cos(theta) + (LAM * np.cos(2 * theta) + sine**4 / LAM) / (1 - sine**2) ** 1.5
    turning = np.exp(1j * theta)
    second = 2 * np.mean(force[:-1] * np.cos(2 * theta[:-1]))
    found = shares(compare_schemes(engine(**SINGLE)))
    assert found["as drawn", None] == pytest.approx(1.25, rel=1e-9)
    assert found["factor", None] == pytest.approx(np.abs(force - turning / 2).max(), rel=1e-9)
    assert found["factor", None] == pytest.approx(0.75, rel=1e-9)
    least = min(np.abs(force - k * turning).max() for k in np.linspace(0.58, 0.62, 41))
    assert found["minimax", None] == pytest.approx(least, abs=1e-3)
    without_first = np.abs(force - np.cos(theta)).max()
    for scheme in ("auto", "single-shaft", "two-shaft", "slider"):
        assert found[scheme, None] == pytest.approx(without_first, rel=1e-9)
    without_second = np.abs(force - np.cos(theta) - second * np.cos(2 * theta)).max()
    for scheme in ("complete", "four-shaft", "oldham"):
        assert found[scheme, None] == pytest.approx(without_second, rel=1e-6)
    rounded = {key: round(share, 7) for key, share in found.items()}
    assert rounded["two-shaft", None] == pytest.approx(0.25820, abs=5e-6)
    assert rounded["four-shaft", None] == 0.0041738
    assert rounded["minimax", None] == pytest.approx(0.66007, abs=5e-6)
    assert rounded["eccentric-slider", "a"] == pytest.approx(0.0191, abs=5e-5)


def test_parts_and_masses_are_those_of_the_schemes_alone():
    parts = {(row.scheme, row.design): row for row in compare_schemes(load_example("single")).schemes}
    for scheme in ("minimax", "two-shaft", "four-shaft"):
        alone = ask_json("balance", ENGINES / "single.toml", "--scheme", scheme)
        row = parts[scheme, None]
        assert row.parts == len(alone["practical"])
        assert row.mass_kg == pytest.approx(sum(device["mass_kg"] for device in alone["practical"]))
        assert row.peak_force_N == alone["after"]["peak"]["force_N"]
    details = ask_json("balance", ENGINES / "single.toml", "--scheme", "oldham")
    weights = sum(device["mass_kg"] for device in details["practical"])
    assert parts["oldham", None].mass_kg == pytest.approx(weights + 4 * details["details"]["mass_kg"])
    assert parts["oldham", None].parts == 5


def test_schemes_that_do_not_fit_are_told_with_the_reason():
    comparison = compare_schemes(load_example("i3"))
    reasons = {unfit.scheme: unfit.reason for unfit in comparison.left_out}
    assert reasons["oldham"] == "oldham is for one cylinder; this engine has 3"
    assert "such as 90 and 50%" in reasons["ellipse"]
    fitted = {row.scheme for row in comparison.schemes}
    assert not fitted & {*reasons}
    told = run_here("balance", ENGINES / "i3.toml", "--scheme", "all").out
    assert "give --direction and --ratio" in " ".join(told.split())


def test_the_command_in_its_formats():
    single = ENGINES / "single.toml"
    document = ask_json("balance", single, "--scheme", "all")
    rows = ask_csv("balance", single, "--scheme", "all")
    assert document["format"] == "balcli.schemes/1"
    assert [row["scheme"] for row in rows] == [row["scheme"] for row in document["schemes"]]
    text = run_here("balance", single, "--scheme", "all").out
    assert max(map(len, text.splitlines())) <= 80
    assert "eccentric-slider, design b" in text


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (("--planes", "ends"), "--planes"),
        (("--orders", "1,2"), "--orders"),
        (("--radius", "30"), "--radius"),
        (("--grade", "G16", "--mass", "12"), "--grade, --mass"),
        (("--write", "out.toml"), "--write"),
    ],
)
def test_options_of_one_scheme_are_refused_beside_all(options, named):
    message = refusal("balance", ENGINES / "single.toml", "--scheme", "all", *options)
    assert f"leave {named} out, or name one scheme" in message


def test_places_that_are_not_known_leave_the_moment_out():
    tables = SINGLE | {"crank": {"stroke": 80, "throws": [0, 120], "throw_mass": 0.1}}
    comparison = compare_schemes(engine(**tables))
    assert {row.peak_moment_Nm for row in comparison.schemes} == {None}


def test_every_scheme_that_is_left_out_has_a_reason():
    """Of balanced cranks that are geared together, where most schemes have nothing to do."""
    comparison = compare_schemes(load_example("brm_h16"))
    assert [unfit.scheme for unfit in comparison.left_out if not unfit.reason] == []
    assert {"auto", "complete"} <= {unfit.scheme for unfit in comparison.left_out}
