"""Scatter: random engines against exact derivatives and against engines written out."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.engines import GOOD, RADIAL, changed

import balcli
from balcli.engine.build import build
from balcli.engine.load import parse as load
from balcli.errors import BalcliError
from balcli.forces.quantity import evaluate_quantities
from balcli.studies.deviations import Tolerances
from balcli.studies.quantities import parse_quantities
from balcli.studies.stated_tolerances import parse_tolerances
from balcli.studies.tolerances import Drawing, scatter_engine

FORCES = parse_quantities("force.1.major,force.2.major,moment.1.major")
TWIN = changed(
    ("[0, 180, 180, 0]", "[0, 180]"),
    ("throw_mass = 0.8", ""),
    ("mass = 0.6\ncg = 45\n", ""),
    ("[layout]\nfiring_order = [1, 3, 4, 2]\n", ""),
)

UNEVEN = changed(  # nothing of it is balanced
    ("[0, 180, 180, 0]", "[0, 100, 220, 30]"), ("[layout]\nfiring_order = [1, 3, 4, 2]\n", "")
)


def evaluate(text: str, name: str) -> float:
    """A quantity of the engine of a file."""
    return float(evaluate_quantities(build(load(text)), parse_quantities(name))[0])


def test_two_pistons_alone_have_a_triangular_difference() -> None:
    """180-degree twin of pistons alone: the free force of order 1 is |d1 - d2| m r w^2, with
    uniform d of +-t: its mean is 2t/3.
    """
    t, samples = 0.01, 200_000
    (spread,) = scatter_engine(
        load(TWIN), Tolerances(mass=t), parse_quantities("force.1.major"), Drawing(samples, 1)
    ).spreads
    whole = 0.5 * 0.045 * (3000 * math.pi / 30) ** 2
    deviation = t * math.sqrt(2 / 9) / math.sqrt(samples)  # of the mean of |d1 - d2|
    assert spread.mean == pytest.approx(2 * t / 3 * whole, abs=6 * deviation * whole)
    assert spread.bound == pytest.approx(2 * t * whole, rel=1e-12)
    assert spread.bound * 0.98 < spread.largest <= spread.bound
    assert spread.nominal == 0


def test_shares_are_what_a_changed_file_gives() -> None:
    (spread,) = scatter_engine(
        load(GOOD), Tolerances(mass=0.01), parse_quantities("force.2.major"), Drawing(10, 1)
    ).spreads
    share = {source.name: value for source, value in spread.shares}
    nominal = evaluate(GOOD, "force.2.major")
    heavier = evaluate(GOOD + "[cylinder.2]\npiston_mass = 0.505\n", "force.2.major")
    assert share["piston mass 2"] == pytest.approx(heavier - nominal, rel=1e-9)
    assert spread.nominal == pytest.approx(nominal, rel=1e-14)


def test_a_rod_deviates_without_its_shells() -> None:
    """What a rod's tolerance does is the same with shells and oil on the pins as without."""
    shells = "[bobweight]\nrod_bearing = 0.05\noil = 0.01\n"
    quantity = parse_quantities("force.1.forward")
    without, with_shells = (
        scatter_engine(load(text), Tolerances(mass=0.01), quantity, Drawing(10, 1)).spreads[0]
        for text in (GOOD, GOOD + shells)
    )
    assert with_shells.bound == pytest.approx(without.bound, rel=1e-12)


def test_shares_of_angles_and_lengths_are_derivatives() -> None:
    weighed = changed(("mass = 0.6\ncg = 45\n", "small_end = 0.17\nbig_end = 0.43\n"))
    (spread,) = scatter_engine(
        load(weighed), Tolerances(length=1e-6, angle_deg=1e-5), parse_quantities("force.2.major"), Drawing(10, 1)
    ).spreads
    share = {source.name: value for source, value in spread.shares}
    nominal = evaluate(weighed, "force.2.major")
    longer = evaluate(weighed + "[cylinder.3]\nrod_length = 160.00016\n", "force.2.major")
    assert share["rod length 3"] == pytest.approx(longer - nominal, rel=1e-4)
    assert abs(share["throw angle 2"]) < 1e-9 * nominal  # to first order, all vectors lie along one line


def test_a_longer_rod_has_less_of_its_weight_at_its_small_end() -> None:
    """The centre of mass keeps its distance c from the big end. Of one cylinder the first order
    turns against the crank with (m_p + m c/l) r w^2 / 2, and the couple is H D_1 w^2 with
    H = m c (l - c) - J and D_1 = lambda, but for lambda cubed.
    """
    text = (
        "[crank]\nstroke = 4\n[rod]\nlength = 200\nmass = 0.6\ncg = 45\ninertia = 3000\n"
        "[piston]\nmass = 0.5\n[operation]\nspeed = 3000\n"
    )
    against, couple = scatter_engine(
        load(text), Tolerances(length=1e-4), parse_quantities("force.1.backward,couple.1.amplitude"), Drawing(10, 1)
    ).spreads
    w2 = (3000 * math.pi / 30) ** 2
    assert against.shares[0][1] == pytest.approx(-1e-4 * 0.6 * 0.045 / 0.2 * 0.002 * w2 / 2)
    h = 0.6 * 0.045 * 0.155 - 0.003
    change = 1e-4 * (0.6 * 0.045 * 0.2 - h) * 0.01 * w2  # of H lambda, lambda = r/l
    assert couple.shares[0][1] == pytest.approx(change, rel=1e-3)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        (UNEVEN.replace("cg = 45", "cg = 45\ninertia = 3000"), 3),
        (UNEVEN.replace("cg = 45", 'cg = 45\npendulum = {pivot = "small_end", period = 0.75}'), 3),
        (UNEVEN.replace("length = 160", "ratio = 0.28") + "[cylinder.3]\nrod_cg = 60\n", 3),
        (RADIAL, 1),
        (RADIAL, 2),
    ],
    ids=["inertia", "pendulum", "ratio", "master", "articulated"],
)
def test_shares_of_lengths_are_what_a_changed_file_gives(text: str, number: int) -> None:
    quantities = parse_quantities("force.1.forward,force.2.backward,couple.1.amplitude")
    step, key = 1e-5, f"cylinder.{number}.rod_length"
    model = load(text)
    spreads = scatter_engine(model, Tolerances(length=step), quantities, Drawing(10, 1)).spreads
    engine = build(model)
    row = engine.numbers.index(number)
    lam = engine.cylinders.lam[row % len(engine.cylinders.lam)]
    length = 1e3 * engine.cylinders.radius / lam
    up, down = (
        evaluate_quantities(build(model, {key: np.array([length * x])}), quantities) for x in (1 + step, 1 - step)
    )
    for spread, more, less in zip(spreads, up, down, strict=True):
        shares = {source.name: value for source, value in spread.shares}
        size = max(map(abs, shares.values()))
        expected = (float(more[0]) - float(less[0])) / 2
        assert shares[f"rod length {number}"] == pytest.approx(expected, rel=1e-5, abs=1e-6 * size)


@pytest.mark.parametrize("text", [GOOD, RADIAL], ids=["plain", "articulated"])
def test_rods_that_might_lock_are_refused(text: str) -> None:
    """They were no figures, or 64 GB."""
    quantities = parse_quantities("force.2.major")
    with pytest.raises(BalcliError) as caught:
        scatter_engine(load(text), Tolerances(length=0.8), quantities, Drawing(10))
    said = "--length-scatter 80%: rods shorter by twice as much cannot be ("
    assert str(caught.value).startswith(said)
    assert str(caught.value).endswith("give a smaller one")
    scatter_engine(load(text), Tolerances(length=0.1), quantities, Drawing(10))


def test_nothing_exceeds_the_bound_of_masses() -> None:
    for shape in ("uniform", "normal"):
        result = scatter_engine(load(GOOD), Tolerances(mass=0.02), FORCES, Drawing(5000, 3, shape))
        for s in result.spreads:
            assert s.percentiles["p05"] <= s.percentiles["p50"] <= s.percentiles["p95"] <= s.largest
            assert shape == "normal" or s.largest <= s.bound * (1 + 1e-12)


def test_a_seed_repeats_and_chunks_do_not_matter() -> None:
    runs = [scatter_engine(load(GOOD), Tolerances(mass=0.01), FORCES, Drawing(20_000, seed)) for seed in (7, 7, 8)]
    assert runs[0].spreads == runs[1].spreads
    assert runs[0].spreads[0].mean != runs[2].spreads[0].mean


def test_tolerances_in_words() -> None:
    assert parse_tolerances("0.5%", "0 %", "0.2 deg") == Tolerances(0.005, 0.0, 0.2)
    assert parse_tolerances("1%", "0%", "0.1").angle_deg == 0.1


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (("much", "0%", "0"), '--mass-scatter "much": give a percentage of 0 to 100, such as 0.5%'),
        (("0.5", "0%", "0"), '--mass-scatter "0.5": give a percentage of 0 to 100, such as 0.5%'),
        (("1%", "-1%", "0"), '--length-scatter "-1%": give a percentage of 0 to 100, such as 0.5%'),
        (("1%", "0%", "wide"), '--angle-scatter "wide" is not a number followed by a unit'),
    ],
)
def test_mistakes_in_words(given: tuple[str, str, str], message: str) -> None:
    with pytest.raises(BalcliError) as caught:
        parse_tolerances(*given)
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("tolerance", "quantity", "samples", "message"),
    [
        (Tolerances(), "force.1.major", 10, "nothing deviates; give a tolerance"),
        (Tolerances(0.01), "force.1.axis", 10, "force.1.axis has no scatter of its own"),
        (Tolerances(0.01), "force.1.major", 0, "0 samples: from 1 to 20000000 are allowed"),
    ],
)
def test_what_cannot_be_scattered_is_told(tolerance: Tolerances, quantity: str, samples: int, message: str) -> None:
    with pytest.raises(BalcliError) as caught:
        scatter_engine(load(GOOD), tolerance, parse_quantities(quantity), Drawing(samples))
    assert str(caught.value).startswith(message)


def test_percentiles_are_those_of_the_samples() -> None:
    result = scatter_engine(load(TWIN), Tolerances(mass=0.01), parse_quantities("force.1.major"), Drawing(50_000, 1))
    whole = 0.5 * 0.045 * (3000 * math.pi / 30) ** 2
    median = 0.01 * (2 - math.sqrt(2)) * whole  # of a triangular distribution on [0, 2t], densest at 0
    assert result.spreads[0].percentiles["p50"] == pytest.approx(median, rel=0.02)
    assert np.isfinite(result.spreads[0].mean)


ARTICULATED = RADIAL.replace("radial = 7", "radial = 5").replace("cg = 90", "cg = 30")


def test_an_articulated_rods_mass_deviates_at_its_knuckle_pin_too() -> None:
    nominal = evaluate(ARTICULATED, "force.1.major")
    more = "[cylinder.3]\nrod_mass = 0.6231\nrod_cg = 30\n"
    heavier = evaluate(ARTICULATED + more, "force.1.major")
    (found,) = scatter_engine(
        load(ARTICULATED), Tolerances(mass=0.005), parse_quantities("force.1.major"), Drawing(10, 1)
    ).spreads
    share = {source.name: value for source, value in found.shares}
    assert share["rod mass 3"] == pytest.approx(heavier - nominal, rel=1e-3)


def test_rotary_engines_have_no_scatter() -> None:
    rotary = ARTICULATED[: ARTICULATED.index("[articulation]")] + "rotary = true\n"
    with pytest.raises(BalcliError, match="there is no scatter of rotary engines, whose masses move on curves"):
        scatter_engine(load(rotary), Tolerances(mass=0.005), parse_quantities("force.1.major"), Drawing(10, 1))


def test_normal_deviations_have_a_third_of_the_tolerance_as_standard_deviation() -> None:
    """The free force of the twin is |d1 - d2| m r w^2; of two normal d its mean is 2 s / sqrt(pi)."""
    t, samples = 0.01, 100_000
    twin = build(load(TWIN))
    found = balcli.scatter(twin, "force.1.major", mass=t, samples=samples, seed=1, distribution="normal")
    whole = 0.5 * 0.045 * (3000 * math.pi / 30) ** 2
    assert found.spreads[0].mean == pytest.approx(2 * t / 3 / math.sqrt(math.pi) * whole, rel=0.01)
