"""The ladder: figures of an independent calculation, and what is true of any engine."""

import json
import re
import tomllib
from random import Random

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask, refusal, run_here
from support.engines import build_text
from support.paths import ROOT, write

from balcli import load
from balcli.balancing.answer import balance, insert_remedy
from balcli.errors import BalcliError
from balcli.forces.crankshaft import find_crank_loads
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.ladder import (
    AS_DRAWN,
    SHAFT,
    SHAFTS,
    WEIGHTS,
    WEIGHTS_AT_THROWS,
    Ladder,
    Step,
    find_ladder,
    name_shafts,
)
from balcli.sizing.options import SchemeOptions
from balcli.sizing.planes import find_unbalance
from balcli.sizing.remedy import fit_devices

FILE = ROOT / "tests" / "cases" / "sizing" / "ladder.toml"
ENGINES = tomllib.loads(FILE.read_text(encoding="utf-8"))["engines"]
FIGURES = ("peak_force_N", "peak_moment_Nm", "main_bearing_N", "inner_moment_Nm")
SEEDS = range(6)


def random_engine(seed: int, *, devices: bool = True) -> tuple[str, list[float], list[float]]:
    """An engine with throws anywhere, often a vee, and with devices: its text, places and angles of throws."""
    draw = Random(seed)
    count = draw.randint(1, 5)
    places = [round(z + draw.uniform(-20, 20), 2) for z in range(0, 100 * count, 100)]
    angles = [0.0, *(draw.choice([180.0, 120.0, draw.uniform(0, 360)]) for _ in range(count - 1))]
    own = (
        f"[[counterweight]]\nunbalance = {draw.uniform(1e4, 6e4)}\nangle = {draw.uniform(0, 360)}\nposition = 40\n"
        f"[[shaft]]\nratio = -1\nunbalance = {draw.uniform(1e3, 2e4)}\nangle = {draw.uniform(0, 360)}\n"
        "position = 15\nat = [-40, 60]\n"
    )
    layout = draw.choice(["", f"bank_angle = {draw.uniform(20, 120)}\n"])
    return write_engine(places, angles, layout) + own * devices, places, angles


def write_engine(places: list[float], angles: list[float], layout: str = "") -> str:
    return (
        f"[crank]\nstroke = 90\nthrows = {angles}\npositions = {places}\nthrow_mass = 0.8\n"
        "[rod]\nlength = 160\nmass = 0.6\ncg = 45\n[piston]\nbore = 86\nmass = 0.5\n"
        f"[layout]\n{layout}[operation]\nspeed = 3000\n"
    )


def figures(step: Step) -> dict[str, float]:
    """Those that are known."""
    found = {key: getattr(step, key) for key in (*FIGURES, "counterweights", "shafts", "mass_kg")}
    return {key: value for key, value in found.items() if value is not None}


def describe(ladder: Ladder) -> dict[str, float | str]:
    """All that a ladder lists, by paths."""
    found: dict[str, float | str] = {"auto": " + ".join(ladder.auto), "F1": ladder.scale.force_N}
    found["M1"] = ladder.scale.moment_Nm or 0.0
    for step in ladder.steps:
        found |= {f"{step.step}: {key}": value for key, value in figures(step).items()}
    for out in ladder.left_out:
        found |= {f"without {out.step}: {key}": getattr(out, key) or 0.0 for key in ("force_N", "moment_Nm")}
    return found


def agree(found: dict[str, float | str], expected: dict[str, float | str]) -> None:
    """Fail unless figures agree to 1e-9 of the largest of both."""
    assert list(found) == list(expected)
    most = max(value for value in expected.values() if not isinstance(value, str))
    for key, value in expected.items():
        assert found[key] == (value if isinstance(value, str) else pytest.approx(value, rel=1e-9, abs=1e-9 * most)), key


# ------------------------------------------------------------------ figures
@cases("sizing/ladder", "ladders")
def test_figures_are_those_of_rigid_bodies(name, auto, scale, steps, left_out):
    ladder = find_ladder(build_text(ENGINES[name]))
    assert ladder.auto == tuple(auto)
    assert ladder.scale.force_N == pytest.approx(scale["force_N"], rel=1e-9)
    assert ladder.scale.moment_Nm == (pytest.approx(scale["moment_Nm"], rel=1e-9) if len(scale) > 1 else None)
    assert [step.step for step in ladder.steps] == [step["step"] for step in steps]
    assert [out.step for out in ladder.left_out] == [out["step"] for out in left_out]
    for step, wanted in zip(ladder.steps, steps, strict=True):
        found = figures(step)
        assert found.keys() == wanted.keys() - {"step"}
        for key, value in found.items():
            most = scale.get("moment_Nm", 1) if key.endswith("Nm") else scale["force_N"] if key.endswith("N") else 1
            assert value == pytest.approx(wanted[key], rel=1e-9, abs=1e-9 * most), (step.step, key)
    for out, wanted in zip(ladder.left_out, left_out, strict=True):
        for key, value in wanted.items():
            assert getattr(out, key) == (value if key == "step" else pytest.approx(value, rel=1e-9, abs=1e-9))


@cases("sizing/ladder", "balances")
def test_devices_and_loads_of_a_balance(name, scheme, options, steps, devices, before, after, first_row):
    """And the engine that is written stands as drawn where the balance left it."""
    text = ENGINES[name]
    result = balance(build_text(text), scheme, SchemeOptions(**options))
    remedy = result.remedy
    assert [*(remedy.steps or filter(None, [remedy.step]))] == steps
    found = [
        (getattr(d, "ratio", 0), d.position, find_unbalance(d) * np.exp(1j * np.radians(d.angle)))
        for d in remedy.devices
    ]
    wanted = [(ratio, z, complex(re, im)) for ratio, z, re, im in devices]
    assert len(found) == len(wanted)
    most = max(abs(u) for _, _, u in wanted)
    for ratio, z, u in wanted:
        assert any((ratio, z) == (a, pytest.approx(b)) and abs(u - v) < 1e-9 * most for a, b, v in found)
    for state, figure in ((result.before, before), (result.after, after)):
        loads = find_crank_loads(state.engine)
        assert loads.main_N == pytest.approx(figure["main_N"], rel=1e-9)
        assert loads.inner_moment_Nm == pytest.approx(figure["inner_moment_Nm"], rel=1e-9)
        assert state.peak.force.value == pytest.approx(figure["force_N"], rel=1e-9, abs=1e-5)
        assert state.peak.moment.value == pytest.approx(figure["moment_Nm"], rel=1e-9, abs=1e-5)
    row = figures(find_ladder(build_text(insert_remedy(text.encode(), remedy, name))).steps[0])
    assert {key: row[key] for key in first_row} == pytest.approx(first_row, rel=1e-9, abs=1e-5)


# ------------------------------------------------------------------ any engine
@pytest.mark.parametrize("seed", SEEDS)
def test_a_step_is_what_the_written_engine_does_as_drawn(seed):
    text = random_engine(seed)[0]
    engine = build_text(text)
    for k, step in enumerate(find_ladder(engine).steps[1:], 1):
        remedy = balance(engine, "step", SchemeOptions(step=str(k))).remedy
        assert remedy.step == step.step
        written = find_ladder(build_text(insert_remedy(text.encode(), remedy, "random"))).steps[0]
        agree(
            {key: getattr(written, key) or 0.0 for key in FIGURES}, {key: getattr(step, key) or 0.0 for key in FIGURES}
        )


@pytest.mark.parametrize("seed", SEEDS)
def test_a_ladder_does_not_depend_on_the_order_or_the_side_of_throws(seed):
    """Throws listed from the other end; its picture in a mirror along the crank; the engine turned end for end, in which
    the moments that bend the crankshaft are those of the other side of a cut.
    """
    text, places, angles = random_engine(seed, devices=False)
    layout = "".join(re.findall("bank_angle.*\n", text))
    expected = describe(find_ladder(build_text(text)))
    agree(describe(find_ladder(build_text(write_engine(places[::-1], angles[::-1], layout)))), expected)
    agree(describe(find_ladder(build_text(write_engine(places, [-a % 360 for a in angles], layout)))), expected)
    found = describe(find_ladder(build_text(write_engine([-z for z in places], angles, layout))))
    outside, expected = ({k: v for k, v in d.items() if "inner" not in k} for d in (found, expected))
    agree(outside, expected)


@pytest.mark.parametrize("text", [*ENGINES.values(), *(random_engine(seed, devices=False)[0] for seed in SEEDS)])
def test_auto_takes_each_step_by_its_own_part(text):
    """The last counterweights; shafts whose part is 18 % in order 1, 12 % of all cylinders in order 2."""
    engine = build_text(text)
    ladder = find_ladder(engine)
    names = [step.step for step in ladder.steps]
    expected = [name for name in (WEIGHTS, WEIGHTS_AT_THROWS) if name in names][-1:]
    if SHAFT in names and max(measure(engine, 1, ["backward"])) >= 0.18:
        expected.append(SHAFT)
    second = {name for name in names if "2" in name}
    if max(measure(engine, 2, ["forward", "backward"])) >= 0.12 * max(len(engine.numbers), 3):
        expected += second
    assert [*ladder.auto] == expected


def measure(engine, order: int, senses: list[str]) -> list[float]:
    """What turns in these senses, as a share of one cylinder's first order (by hand)."""
    c = engine.cylinders
    one = float(np.max(c.reciprocating) * c.radius[0]) * float(engine.omega) ** 2
    length = max(float(np.ptp(c.z)), 2 * float(c.radius[0]))
    spectra = compute_spectra(engine, [order], ("force", "moment"))
    moments = (
        [abs(getattr(spectra.moment, sense)[0]) / (one * length) for sense in senses] if engine.places_known else []
    )
    return [float(size) for size in [*(abs(getattr(spectra.force, s)[0]) / one for s in senses), *moments]]


@pytest.mark.parametrize("text", [*ENGINES.values(), *(random_engine(seed)[0] for seed in SEEDS)])
def test_with_no_part_small_everything_is_listed(text):
    engine = build_text(text)
    usual = find_ladder(engine)
    whole = find_ladder(engine, 0.0)
    assert {out.step for out in whole.left_out} <= {WEIGHTS_AT_THROWS}
    assert all((out.main_bearing_N or 0) <= 0 for out in whole.left_out)
    listed = {step.step for step in whole.steps} | {out.step for out in whole.left_out}
    halves = {name_shafts((sense,)) for sense in (1, -1)} if SHAFTS in listed else set()
    named = {step.step for step in usual.steps} | {out.step for out in usual.left_out}
    assert named <= listed | halves | {WEIGHTS}
    after = fit_devices(engine, whole.steps[-1].remedy)
    spectra = compute_spectra(after, [1, 2], ("force", "moment"))
    scale = whole.scale.force_N
    assert spectra.force.major.max() < 1e-9 * scale
    assert not engine.places_known or spectra.moment.major.max() < 1e-9 * scale


# ------------------------------------------------------------------ --step, --small
@cases("sizing/ladder", "wrong_steps")
def test_a_step_that_cannot_be_fitted(name, step, told):
    with pytest.raises(BalcliError, match=f"^{re.escape(told)}$"):
        find_ladder(build_text(ENGINES[name])).fit(step)


def test_small_lists_a_step_that_is_left_out(tmp_path):
    path = write(tmp_path / "radial.toml", ENGINES["radial7"])
    assert "--small 2% lists it" in refusal("balance", path, "--step", "shaft at -1")
    remedy = balance(build_text(ENGINES["radial7"]), "step", SchemeOptions(step=SHAFT, small=0.02)).remedy
    assert {shaft.ratio for shaft in remedy.shafts} == {-1}
    for command in ("analyze", "balance", f"compare {path}", "plot -o x.svg", "report -o x.html"):
        assert "from 0 to 50%" in refusal(*command.split(), path, "--small", "60%")


@pytest.mark.parametrize(
    ("step", "right"), [(1, "counterweights"), ("1", "counterweights"), ("shaft at -1", "shaft at -1")]
)
def test_a_step_is_named_or_numbered(step, right):
    found = balance(load(ROOT / "engines" / "i3.toml"), "step", SchemeOptions(step=step))
    assert (found.remedy.scheme, found.remedy.step) == ("step", right)


def test_scheme_step_without_a_step_is_refused():
    assert "scheme step: give a step" in refusal("balance", ROOT / "engines" / "i3.toml", "--scheme", "step")
    with pytest.raises(TypeError, match="step"):
        balance(load(ROOT / "engines" / "i3.toml"), "step", SchemeOptions(step=1.5))


@pytest.mark.parametrize("engine", ["v5.toml", "car/ford_ecoboost_1_0.toml"])
def test_the_third_step_that_is_left_out_says_what_it_would_do(engine):
    ladder = find_ladder(load(ROOT / "engines" / engine), small=0.5)
    (out,) = (one for one in ladder.left_out if one.step == WEIGHTS_AT_THROWS)
    with pytest.raises(BalcliError) as refused:
        ladder.fit(WEIGHTS_AT_THROWS)
    told = str(refused.value)
    assert ("would lower" if out.main_bearing_N > 0 else "would raise") in told
    assert ("small" in told) == (out.main_bearing_N > 0)


@pytest.mark.parametrize("small", [-0.01, 0.51, float("nan")])
def test_what_counts_as_small_is_checked_by_every_function(small):
    with pytest.raises(BalcliError, match="give a share from 0 to 50"):
        find_ladder(load(ROOT / "engines" / "i3.toml"), small=small)


def test_the_command_that_fits_the_same_is_named():
    told = ask("analyze", ROOT / "engines" / "i3.toml", "--only", "ladder", "--small", "2%")
    assert "By default, `balcli balance --small 2%` fits steps" in " ".join(told.split())
    assert "balcli balance" not in ask("balance", ROOT / "engines" / "i3.toml", "--step", "1").partition("What is")[0]


ROTATING = (
    write_engine([0, 100, 200, 300], [0, 180, 180, 0])
    .replace("mass = 0.6", "mass = 0")
    .replace("mass = 0.5", "mass = 0")
)


@pytest.mark.parametrize("command", ["analyze", "balance"])
def test_an_engine_of_rotating_masses_alone_has_a_ladder(command, tmp_path):
    """One cylinder makes nothing beside which a part is small."""
    path = write(tmp_path / "rotating.toml", ROTATING)
    found = json.loads(run_here(command, path, "-f", "json").out)["ladder"]
    assert found["scale"] == {"force_N": 0.0, "moment_Nm": 0.0}
    assert [step["step"] for step in found["steps"]] == [AS_DRAWN, WEIGHTS_AT_THROWS]
    assert "What balances it" in run_here(command, path).out


def test_a_scheme_is_not_told_to_take_what_is_small():
    """With --small 50% most is: then no other scheme is named for it."""
    told = refusal("balance", ROOT / "engines" / "i5.toml", "--scheme", "couple-shaft", "--small", "50%")
    assert "small compared with one cylinder's" in told
    assert "Scheme " not in told
