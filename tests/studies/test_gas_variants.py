"""Torque with gas over variants: as of each engine built by itself."""

import csv
import json
from contextlib import suppress
from io import StringIO
from itertools import product

import numpy as np
import pytest
from support.cases import cases
from support.commands import refusal, run_here
from support.engines import RADIAL, build_text
from support.gas_engines import PETROL_FOUR
from support.paths import ENGINES, write

import balcli
from balcli.engine.build import build
from balcli.engine.load import build_jointly, concerns_gas
from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_gas_torque, compute_spectra
from balcli.studies.parameters import find_places
from balcli.studies.search.designs import NumbersJudge, parse_objective

FOUR = PETROL_FOUR.replace("[rod]", "throw_mass = 0.8\n[rod]") + "[cylinder.2]\nrod_length = 151\n"
NAMES = "torque.2.amplitude,torque.1.5.cos,gas.0.5.sin,roll_total.3.amplitude,torque_total.4.amplitude"


def analyse(text: str) -> list[float]:
    """The same figures of one engine, by its spectra."""
    found = compute_spectra(build_text(text), [0.5, 1.5, 2, 3, 4], ["gas", "torque_total", "roll_total"])
    total = found["torque_total"]
    gas = found["gas"]
    roll = found["roll_total"]
    return [
        float(total.major[2]),
        float(total.x[1].real),
        float(-gas.x[0].imag),
        float(roll.major[3]),
        float(total.major[4]),
    ]


def test_a_grid_of_masses_lengths_and_pressures():
    grid = {"gas.imep": (9, 12), "piston.mass": (0.4, 0.5, 0.7), "rod.length": (140, 150)}
    vary = [part for key, values in grid.items() for part in ("--vary", f"{key}={','.join(map(str, values))}")]
    done = run_here("sweep", "-", *vary, "-q", NAMES, stdin=FOUR)
    assert (done.status, done.err) == (0, "")
    head, *rows = csv.reader(StringIO(done.out))
    assert head == [*grid, *NAMES.split(",")]
    assert [tuple(map(float, row[:3])) for row in rows] == list(product(*grid.values()))
    for row in rows:
        imep, mass, length = map(float, row[:3])
        text = FOUR.replace("imep = 12", f"imep = {imep}").replace("mass = 0.5", f"mass = {mass}")
        said = analyse(text.replace("length = 150", f"length = {length}", 1))
        largest = max(map(abs, said))
        assert [float(x) for x in row[3:]] == pytest.approx(said, rel=1e-12, abs=1e-12 * largest)


def test_cycles_that_cannot_be_are_told_with_their_figures(tmp_path):
    path = write(tmp_path / "four.toml", FOUR)
    told = refusal("sweep", path, "--vary", "gas.burn_duration=50,200", "-q", "gas.2.amplitude")
    assert told.startswith(f"{path}: gas.burn_duration = 200: 2 mistakes\n")


FIGURES = """
compression_ratio=9,11 compression_index=1.3,1.35 intake=0.9,1.1 expansion_index=1.25,1.3 exhaust=1.1,1.2 crankcase=1,1.2
imep=8,9.5 bmep=7,8 heat=900,1000 max_pressure=52,55 burn_start=-10,-8 burn_duration=40,50 burn_shape=1,2
exhaust_opens=130,140 intake_closes=570,580 phase=-1,1
"""
FIGURES = dict(figure.split("=") for figure in FIGURES.split())  # of [gas], at which each may stand


def list_numbers(path) -> set[str]:
    """The numbers of a file, those of the gas by their keys."""
    told = json.loads(run_here("numbers", path, "-f", "json").out)["numbers"]
    return {number["path"].removeprefix("gas.") for number in told}


@pytest.mark.parametrize("strokes", [pytest.param(2, marks=pytest.mark.stress), 4])
@cases("studies/gas_variants", "kinds")
def test_what_can_be_varied_of_the_gas_changes_it(kind, gas, strokes, tmp_path):
    """The rest is no number of this file: the same figures in every row told nothing of that."""
    cycle = np.arange(0, 180 * strokes + 1, 10)
    pressure = 1 + 40 * np.exp(-(((cycle - 20) / 60) ** 2))
    pressure[-1] = pressure[0]
    rows = "".join(f"{a},{p!r}\n" for a, p in zip(cycle, pressure.tolist(), strict=True))
    (tmp_path / "p.csv").write_text(f"angle_deg,pressure_bar\n{rows}", encoding="utf-8")
    (tmp_path / "h.csv").write_text("order,cos,sin\n0,2,0\n1,3,4\n", encoding="utf-8")
    path = tmp_path / "four.toml"
    text = PETROL_FOUR.partition("[gas]")[0].replace("[layout]", f"[layout]\nstrokes = {strokes}")
    if strokes == 2:
        text = text.replace("[0, 180, 180, 0]", "[0, 90, 270, 180]")
    path.write_text(f"{text}[gas]\n{gas}", encoding="utf-8")
    known = list_numbers(path)
    for key, values in FIGURES.items():
        vary = f"gas.{key}={values}"
        if kind != "harmonics" and key == "bmep":
            vary = f"gas.mechanical_efficiency=0.9 --vary {vary}"
        done = run_here("sweep", path, "--vary", *vary.split(), "-q", "torque.max,gas.1.sin")
        if key in known:
            assert done.status == 0, done.err
            first, second = done.out.splitlines()[1:]
            assert first.split(",")[-2:] != second.split(",")[-2:]
        else:
            assert done.err == f"balcli: gas.{key} has no effect on the gas of this file\n"


@pytest.mark.parametrize(
    ("own", "idle"), [("heat = 900\n", {"imep", "bmep", "max_pressure", "cut_off", "heat"}), ("gas = 0.5\n", set())]
)
def test_what_all_cylinders_have_of_their_own_is_no_number_of_the_gas(own, idle, tmp_path):
    path = write(tmp_path / "four.toml", PETROL_FOUR + "".join(f"[cylinder.{n}]\n{own}" for n in (1, 2, 3, 4)))
    known = list_numbers(path)
    assert known.isdisjoint(idle)
    assert "compression_ratio" in known
    assert ("imep" in known) == (not idle)
    assert "cylinder.2.heat" in known


def test_where_all_cylinders_have_diagrams_no_number_is_of_the_cycle(tmp_path):
    rows = "".join(f"{angle},{1 + (angle == 370)}\n" for angle in range(0, 721, 10))
    (tmp_path / "p.csv").write_text("angle_deg,pressure_bar\n" + rows, "utf-8")
    path = tmp_path / "four.toml"
    own = "".join(f'[cylinder.{n}]\nindicator = "p.csv"\n' for n in (1, 2, 3, 4))
    path.write_text(PETROL_FOUR + own, "utf-8")
    of_gas = {"compression_ratio", "imep", "phase", "mechanical_efficiency", "crankcase", *FIGURES}
    assert list_numbers(path) & of_gas == {"phase", "mechanical_efficiency", "crankcase"}


@cases("studies/gas_variants", "goals_that_contradict_each_other")
def test_goals_that_contradict_each_other_are_refused(vary, told, tmp_path):
    """The first alone counted; nothing counted, and cells stayed empty."""
    path = write(tmp_path / "four.toml", FOUR)
    varied = (word for one in vary for word in ("--vary", one))
    assert refusal("sweep", path, *varied, "-q", "torque.mean") == told.format(path)


def test_a_search_puts_one_goal_in_place_of_another(tmp_path):
    """The file says imep; a search for the heat said that it has both."""
    path = write(tmp_path / "four.toml", FOUR)
    over = ("--over", "gas.heat=900:1000")
    minimise = ("--minimise", "torque.max")
    done = run_here("search", path, *over, *minimise, "-f", "json")
    row = run_here("sweep", path, "--vary", "gas.heat=900", "-q", "torque.max").out.split()[1]
    assert json.loads(done.out)["results"][0]["objective"] == float(row.split(",")[1])


# ------------------------------------------------------------------ variants that are computed together
V8 = (ENGINES / "v8_crossplane.toml").read_text(encoding="utf-8")
OTTO = '[gas]\ncycle = "otto"\ncompression_ratio = 9\nheat = 1500\n[cylinder.3]\ngas = 0.9\n'
TWO_STROKE = PETROL_FOUR.replace("[layout]", "[layout]\nstrokes = 2").replace("[0, 180, 180, 0]", "[0, 90, 270, 180]")
CENTRED = PETROL_FOUR.replace("offset = 0.8\n", "")
MASTER_ROD = RADIAL.replace("mass = 1.3", "mass = 1.3\nbore = 100").replace(
    "radial = 7", "radial = 7\nfiring_order = [1, 3, 5, 7, 2, 4, 6]"
)
JOINT = {
    "in line": (FOUR, {"gas.imep": [1, 4, 11], "gas.intake": [0.8, 1.5]}),
    "vee": (V8 + OTTO, {"gas.heat": [0, 900, 2500], "gas.compression_ratio": [7, 11]}),
    "two-stroke": (TWO_STROKE, {"gas.burn_shape": [0, 0.6, 3], "gas.expansion_index": [1.2, 1.35]}),
    "with a mass and a length": (FOUR, {"piston.mass": [0.4, 0.6], "rod.length": [150, 160], "gas.imep": [8, 9, 12]}),
    "lengths": (CENTRED, {"rod.length": [140, 160], "crank.stroke": [80, 90], "gas.imep": [8, 11]}),
    "bore and ratio": (
        V8 + OTTO,
        {"piston.bore": [90, 104], "rod.ratio": [0.27, 0.31], "operation.speed": [3000, 5000]},
    ),
    "masses and speeds": (FOUR, {"cylinder.2.piston_mass": [0.4, 0.9], "operation.speed": [900, 5000]}),
    "masses that balance": (FOUR.replace("rod_length = 151", ""), {"piston.mass": [0.0, 0.5], "gas.imep": [8, 9]}),
    "masses of a diesel": (FOUR.replace('"wiebe"', '"diesel"'), {"rod.mass": [0.4, 0.9], "piston.mass": [0.3, 0.4]}),
    "master rod, with a mass": (MASTER_ROD + OTTO, {"piston.mass": [1, 2], "gas.exhaust": [1, 3]}),
}
OF_CYCLE = "torque.max,torque.min,torque.mean"
OF_ORDERS = "gas.0.cos,gas.0.5.sin,gas.3.amplitude,torque.2.cos,torque.6.sin,roll_total.1.amplitude,gas.24.amplitude"


@pytest.mark.parametrize("case", JOINT)
def test_variants_that_are_computed_together_are_each_of_them(case):
    text, grid = JOINT[case]
    engine = build_text(text)
    variants = [dict(zip(grid, values, strict=True)) for values in product(*grid.values())]
    assert any(build_jointly(engine.model, variants))
    found = balcli.sweep(engine, grid, f"{OF_CYCLE},{OF_ORDERS}")
    every = np.stack([found[name] for name in [*OF_CYCLE.split(","), *OF_ORDERS.split(",")]])
    places = [*np.ndindex(every.shape[1:])]
    for place in (places[len(places) // 2], places[-1]):
        own = {path: values[k] for (path, values), k in zip(grid.items(), place, strict=True)}
        alone = balcli.sweep(engine, own, f"{OF_CYCLE},{OF_ORDERS}")
        expected = np.array([alone[name].item() for name in list(alone)[len(grid) :]])
        here = every[(slice(None), *place)]
        assert here == pytest.approx(expected, rel=1e-12, abs=1e-12 * np.abs(expected).max())


def test_fluctuations_share_their_gas_and_the_variant_that_stalls_is_told(tmp_path):
    text = FOUR + "[flywheel]\ninertia = 150000\n"
    engine = build_text(text)
    grid = {"piston.mass": [0.4, 0.6], "gas.imep": [6, 9]}
    found = balcli.sweep(engine, grid, "fluctuation,torque.max")
    for k, mass in enumerate(grid["piston.mass"]):
        for j, mean in enumerate(grid["gas.imep"]):
            alone = balcli.sweep(engine, {"piston.mass": mass, "gas.imep": mean}, "fluctuation,torque.max")
            for name in ("fluctuation", "torque.max"):
                assert found[name][k, j] == pytest.approx(alone[name].item(), rel=1e-12)
    path = write(tmp_path / "four.toml", text.replace("speed = 4000", "speed = 320"))
    told = refusal("sweep", path, "--vary", "gas.imep=1,8,9", "-q", "fluctuation")
    assert told.startswith(f"{path}: gas.imep = 8: the shaft stalls at")


def test_what_cannot_be_computed_together_is_left_out():
    """Angles of the cycle, cycles that turn at angles of their own, single cylinders, linkages; impossible variants."""

    def group(text, *variants):
        return [places for places, _ in build_jointly(build_text(text).model, variants)]

    two = {"gas.imep": 8.0}, {"gas.imep": 9.0}
    assert group(FOUR, *two) == [[0, 1]]
    masses = [{**own, "piston.mass": mass} for mass in (0.4, 0.5) for own in two]
    lengths = [{**own, "rod.length": length} for length in (150.0, 160.0) for own in two]
    assert group(FOUR, *masses) == [[0, 1, 2, 3]]
    assert group(FOUR, *lengths) == [[0, 1], [2, 3]]
    assert group(CENTRED, *lengths) == [[0, 1, 2, 3]]
    assert group(CENTRED + "[cylinder.2]\nrod_length = 151\n", *lengths) == [[0, 1], [2, 3]]
    assert group(CENTRED, *({**own, "cylinder.2.piston_offset": 0.5} for own in lengths)) == [[0, 1], [2, 3]]
    assert group(CENTRED.replace("stroke = 86", "stroke = [86, 86, 84, 84]"), *lengths) == [[0, 1], [2, 3]]
    assert group(TWO_STROKE.replace("offset = 0.8\n", ""), *lengths) == [[0, 1], [2, 3]]
    assert group(MASTER_ROD + OTTO, *({**own, "gas.heat": 900.0 + k} for k, own in enumerate(masses))) == []
    assert group(FOUR, *({**own, "gas.burn_start": -10.0 - k} for k, own in enumerate(two))) == []
    assert group(FOUR.replace('"wiebe"', '"diesel"'), *two) == []
    assert group(FOUR + "[cylinder.3]\nheat = 900\n", *two) == []
    assert group(FOUR, *({**own, "cylinder.3.heat": 900.0} for own in two)) == []
    assert group(FOUR, *lengths, {"gas.imep": -20.0, "rod.length": 150.0}) == [[2, 3]]


@pytest.mark.parametrize("quantity", ["torque.max", "gas.2.amplitude"])
@pytest.mark.parametrize(
    ("values", "told"),
    [
        ("gas.imep=8,-20,-30", "gas.imep = -20: 2 mistakes\n  gas.imep: is -20 bar: this cycle has at least"),
        ("gas.compression_index=1.3,0.9", "gas.compression_index = 0.9: gas: has compression_index = 0.9; in a cycle"),
        ("gas.expansion_index=1.2,0.9,0.8", "gas.expansion_index = 0.9: gas: has expansion_index = 0.9; in a cycle"),
        ("gas.max_pressure=60,2,1", "gas.max_pressure = 2: gas.max_pressure: is 2 bar: this cycle has at least"),
    ],
)
def test_the_first_impossible_variant_is_told(values, told, quantity, tmp_path):
    path = write(tmp_path / "four.toml", FOUR)
    assert refusal("sweep", path, "--vary", values, "-q", quantity).startswith(f"{path}: {told}")


def test_a_search_judges_candidates_together_and_impossible_ones_as_infinitely_bad():
    model = build_text(FOUR).model
    told = []
    judge = NumbersJudge(model, ["gas.imep"], parse_objective("torque.max"), False, told.append)
    points = np.array([[8.0], [-20.0], [9.0], [10.0]])
    costs = judge(points)
    assert told[-1] == 4
    assert str(judge.refused.file) == "gas.imep = -20"
    assert np.isinf(costs).tolist() == [False, True, False, False]
    alone = np.concatenate([judge(point[None]) for point in points])
    assert costs[[0, 2, 3]] == pytest.approx(alone[[0, 2, 3]], rel=1e-12)


@pytest.mark.parametrize("file", ["i4_wiebe.toml", "pumps/compressor.toml"])
def test_all_figures_on_which_the_gas_depends_are_known(file):
    """The gas of another bore of a single cylinder was that of the variant before it."""
    engine = balcli.load(ENGINES / file)
    orders = np.array([0.0, 1.0, 2.0, 3.0])
    nominal = compute_gas_torque(engine, orders).vectors
    unknown = []
    for path, place in find_places(engine.model).items():
        value = place.value if isinstance(place.value, float) else 50.0
        if concerns_gas(path, engine.model.gas):
            continue
        with suppress(BalcliError):
            varied = compute_gas_torque(build(engine.model, {path: 1.02 * value}), orders).vectors
            if not np.array_equal(varied, nominal):
                unknown.append(path)
    assert unknown == []
