"""Spreads of the whole cycle and of guides: every sample is the engine of its own file."""

from __future__ import annotations

import json

import numpy as np
import pytest
from support.commands import refusal, run_here
from support.engines import build_text
from support.gas_engines import PETROL_FOUR
from support.paths import ENGINES, write

import balcli
from balcli.engine.load import parse
from balcli.forces.guide_moments import compute_guide_moments
from balcli.studies.deviations import DeviatingEngine, Tolerances
from balcli.torque.analysis import analyze_torque

pytestmark = pytest.mark.slow

FOUR = PETROL_FOUR.replace("[rod]", "inertia = 90000\n[rod]")
PLAIN = f"{FOUR}[cylinder]\n"


def deviated(found: dict[str, float]) -> str:
    """The file with these deviations, by the names of their sources."""
    own, throws = [], []
    for k, throw in enumerate((0, 180, 180, 0), 1):
        throws.append(throw + found.get(f"throw angle {k}", 0.0))
        piston = 0.5 * (1 + found.get(f"piston mass {k}", 0.0))
        rod = 0.6 * (1 + found.get(f"rod mass {k}", 0.0))
        length = 150 * (1 + found.get(f"rod length {k}", 0.0))
        own.append(f"{k} = {{piston_mass = {piston!r}, rod_mass = {rod!r}, rod_length = {length!r}}}")
    own_throws = FOUR.replace("[0, 180, 180, 0]", repr(throws))
    return "\n".join([own_throws, "[cylinder]", *own])


def draw(engines: DeviatingEngine, seed: int) -> np.ndarray:
    drawn = np.random.default_rng(seed).uniform(-1, 1, len(engines.sources))
    return drawn * [source.tolerance for source in engines.sources]


@pytest.mark.parametrize("length", [0.0, 0.003])
def test_a_deviating_engine_is_that_of_its_own_file(length):
    """Torque over the cycle, uneven speed, and guide moments, by a file that says each figure."""
    engines = DeviatingEngine(parse(PLAIN), Tolerances(0.02, length, 0.4))
    drawn = draw(engines, 3)
    named = {source.name: value for source, value in zip(engines.sources, drawn.tolist(), strict=True)}
    one, other = engines.deviate_one(drawn), build_text(deviated(named))
    found, expected = analyze_torque(one, [1, 2]), analyze_torque(other, [1, 2])
    ends = [[one.torque.min_Nm, one.torque.max_Nm] for one in (found, expected)]
    assert ends[0] == pytest.approx(ends[1], abs=1e-12 * ends[1][1])
    assert found.mean_torque_Nm == pytest.approx(expected.mean_torque_Nm, rel=1e-12)
    swing = expected.flywheel.fluctuation
    assert found.flywheel.fluctuation == pytest.approx(swing, rel=1e-11)
    orders = np.array([0.5, 2.0, 4.0])
    guides, others = (compute_guide_moments(e, orders) for e in (one, other))
    np.testing.assert_allclose(guides.h.major, others.h.major, rtol=1e-11, atol=1e-9)
    np.testing.assert_allclose(guides.x.major, others.x.major, rtol=1e-11, atol=1e-9)


def test_throw_masses_are_in_the_inertia_of_a_crank_that_is_given():
    """Moving parts have none of them, however they deviate."""
    text = PLAIN.replace("spacing = 95", "spacing = 95\nthrow_mass = 0.8")
    engines = DeviatingEngine(parse(text), Tolerances(mass=0.1))
    drawn = draw(engines, 1)
    named = [source.name for source in engines.sources]
    web = np.array([name.startswith("throw mass") for name in named])
    assert web.any()
    moving = [
        analyze_torque(engines.deviate_one(np.where(web, d, 0.0)), [1]).flywheel.moving_parts_kg_m2
        for d in (drawn, 0 * drawn)
    ]
    assert moving[0] == pytest.approx(moving[1], rel=1e-14)


def test_samples_and_shares_are_those_of_single_engines(tmp_path):
    path = write(tmp_path / "four.toml", PLAIN)
    names = "torque.max,torque.min,torque.mean,fluctuation"
    told = json.loads(
        run_here(
            *("scatter", path, "-q", names, "--samples", "5", "--seed", "4", "-f", "json"),
            *("--mass-scatter", "1%", "--angle-scatter", "0.3"),
        ).out
    )
    model = parse(PLAIN)
    engines = DeviatingEngine(model, Tolerances(0.01, 0.0, 0.3))
    tolerance = np.array([source.tolerance for source in engines.sources])
    random = np.random.default_rng(4).random((5, len(tolerance)))
    curves = [analyze_torque(engines.deviate_one(row), [1]) for row in tolerance * (2 * random - 1)]
    highest = [one.torque.max_Nm for one in curves]
    swings = [one.flywheel.fluctuation for one in curves]
    found = told["quantities"]
    assert found["torque.max"]["max"] == pytest.approx(max(highest), rel=1e-13)
    assert found["torque.max"]["mean"] == pytest.approx(np.mean(highest), rel=1e-13)
    assert found["fluctuation"]["max"] == pytest.approx(max(swings), rel=1e-13)
    assert set(found["torque.mean"]["sensitivity"].values()) == {0.0}  # imep is given
    heavier = PLAIN.replace("[cylinder]", "[cylinder]\n2 = {piston_mass = 0.505}")
    lighter = PLAIN.replace("[cylinder]", "[cylinder]\n2 = {piston_mass = 0.495}")
    ends = [analyze_torque(build_text(text), [1]).torque.max_Nm for text in (heavier, lighter)]
    share = found["torque.max"]["sensitivity"]["piston mass 2"]
    assert share == pytest.approx((ends[0] - ends[1]) / 2, rel=1e-9)


def test_what_is_0_by_design_has_a_bound():
    """X of order 2 is nothing in four equal cylinders; every deviation makes some."""
    engine = balcli.load(ENGINES / "i4_wiebe.toml")
    found = balcli.scatter(engine, "guide.2.X", samples=30, seed=2).spreads[0]
    assert found.nominal == 0.0
    assert 0 < found.largest <= found.bound
    assert all(share >= 0 for _, share in found.shares)
    assert found.shares[0][1] > 0


def test_what_is_not_drawn_so():
    path = ENGINES / "i4_wiebe.toml"
    told = refusal("scatter", path, "-q", "force.2.major,torque.max")
    assert told == (
        "force.2.major and torque.max are not drawn together: of the cycle and of guides, engines "
        "are computed one by one; ask for one after the other"
    )
    told = refusal("scatter", path, "-q", "torque.max", "--samples", "30000")
    assert told == (
        "30000 samples: of torque.max, where each engine is computed by itself, from 1 to 20000 are allowed"
    )
    told = refusal("scatter", path, "-q", "guide.2.H", "--mass-scatter", "0%")
    assert told == "nothing deviates; give a tolerance, such as --mass-scatter 0.5%"
    told = refusal("scatter", ENGINES / "i4.toml", "-q", "torque.max")
    assert told == "torque.max: the engine file has no [gas]"
    told = refusal("scatter", "-", "-q", "fluctuation", stdin=PLAIN.replace("inertia = 90000\n", ""))
    assert told.startswith("fluctuation: the file gives no inertia")


def test_a_table_says_what_is_bound():
    out = run_here("scatter", ENGINES / "i4_wiebe.toml", "-q", "fluctuation", "--samples", "2").out
    assert "Spread of 2 engines, one by one" in out
    assert "\nfluctuation   0.005377" in out
    assert "an engine may go a little beyond" in out
