"""Scatter: random variants against exact derivatives and against engines written out."""

import math
from pathlib import Path

import numpy as np
import pytest
from support.cases import cases
from support.commands import refusal, run_here
from support.engines import GOOD, RADIAL, build_text, changed
from support.gas_engines import PETROL_FOUR
from support.paths import ENGINES

import balcli
from balcli.engine.build import build
from balcli.engine.parse import parse as load
from balcli.errors import BalcliError
from balcli.forces.quantity import evaluate_quantities
from balcli.studies.deviations import Tolerances
from balcli.studies.quantities import parse_quantities
from balcli.studies.scatter import Spread, Variants, read_tolerances

FORCES = "force.1.major,force.2.major,moment.1.major"
TWIN = changed(
    ("[0, 180, 180, 0]", "[0, 180]"),
    ("throw_mass = 0.8", ""),
    ("mass = 0.6\ncg = 45\n", ""),
    ("[layout]\nfiring_order = [1, 3, 4, 2]\n", ""),
)
WHOLE = 0.5 * 0.045 * (3000 * math.pi / 30) ** 2  # force of order 1 of one of the twin's pistons
UNEVEN = changed(  # nothing of it is balanced
    ("[0, 180, 180, 0]", "[0, 100, 220, 30]"), ("[layout]\nfiring_order = [1, 3, 4, 2]\n", "")
)
FOUR = PETROL_FOUR.replace("[rod]", "inertia = 90000\n[rod]") + "[cylinder]\n"
ARTICULATED = RADIAL.replace("radial = 7", "radial = 5").replace("cg = 90", "cg = 30")


def evaluate(text: str, name: str) -> float:
    """A quantity of the engine of a file."""
    return float(evaluate_quantities(build(load(text)), parse_quantities(name))[0])


def scatter(text: str, name: str, within: Tolerances, samples: int = 10, shape: str = "uniform") -> list[Spread]:
    """The spreads of quantities of a file."""
    return [*Variants(load(text), name, within).draw(samples, 1, shape).quantities.values()]


def test_two_pistons_alone_have_a_triangular_difference() -> None:
    """The free force of order 1 is |d1 - d2| m r w^2; with uniform d of +-t its mean is 2t/3."""
    t = 0.01
    samples = 200_000
    (spread,) = scatter(TWIN, "force.1.major", Tolerances(mass=t), samples)
    deviation = t * math.sqrt(2 / 9) / math.sqrt(samples)  # of the mean of |d1 - d2|
    assert spread.mean == pytest.approx(2 * t / 3 * WHOLE, abs=6 * deviation * WHOLE)
    assert spread.p50 == pytest.approx(t * (2 - math.sqrt(2)) * WHOLE, rel=0.02)
    assert spread.bound == pytest.approx(2 * t * WHOLE, rel=1e-12)
    assert spread.bound * 0.98 < spread.max <= spread.bound
    assert spread.nominal == 0
    (normal,) = scatter(TWIN, "force.1.major", Tolerances(mass=t), 100_000, "normal")
    assert normal.mean == pytest.approx(2 * t / 3 / math.sqrt(math.pi) * WHOLE, rel=0.01)


@cases("studies/scatter", "effects_are_what_a_changed_file_gives", GOOD=GOOD, ARTICULATED=ARTICULATED)
def test_effects_are_what_a_changed_file_gives(text, name, within, source, own, close):
    (spread,) = scatter(text, name, Tolerances(**within))
    nominal = evaluate(text, name)
    assert spread.nominal == pytest.approx(nominal, rel=1e-14)
    assert spread.sensitivity[source] == pytest.approx(evaluate(text + own, name) - nominal, rel=close)


def test_a_throw_angle_that_changes_nothing_to_first_order() -> None:
    (spread,) = scatter(GOOD, "force.2.major", Tolerances(angle_deg=1e-5))
    assert abs(spread.sensitivity["throw angle 2"]) < 1e-9 * spread.nominal


def test_devices_stay_where_they_are_when_the_first_throw_moves() -> None:
    """Throws 1 and 4 of an in-line four with two shafts are alike."""
    shafts = "".join(f"[[shaft]]\nratio = {n}\nunbalance = 9000\nangle = 30\n" for n in (2, -2))
    weight = "[[counterweight]]\nunbalance = 7000\nangle = 180\n"
    text = UNEVEN.replace("[0, 100, 220, 30]", "[0, 180, 180, 0]") + shafts + weight
    for spread in scatter(text, "force.1.forward,force.2.forward,force.2.backward", Tolerances(angle_deg=0.1)):
        one, four = (spread.sensitivity[f"throw angle {k}"] for k in (1, 4))
        assert one == pytest.approx(four, rel=1e-9)


# ------------------------------------------------------------------ devices
SINGLE = changed(("[0, 180, 180, 0]", "[0]"), ("spacing = 100\n", ""), ("[layout]\nfiring_order = [1, 3, 4, 2]\n", ""))
WEIGHT = "[[counterweight]]\nangle = {}\nposition = 3\n{}\n"
OF_SHAFT = "[[shaft]]\nratio = -1\nat = [-60, 55]\nangle = {}\n{}\n"
OF_SLIDER = "[[slider]]\norder = 2\ndirection = 20\nangle = {}\n{}\n"
SECTOR = "sector = {{ inner_radius = 9, outer_radius = 40, opening = 170, thickness = {} }}"


@pytest.mark.parametrize(
    ("table", "angle", "weight", "size", "name"),
    [
        *((WEIGHT, 176, "unbalance = {}", 52000, "counterweight"), (OF_SHAFT, 183, "unbalance = {}", 9800, "shaft")),
        *(
            (OF_SLIDER, 30, "unbalance = {}", 5000, "slider"),
            (WEIGHT, 176, "radius = 40\nmass = {}", 1.2, "counterweight"),
        ),
        *((WEIGHT, 170, SECTOR, 30, "counterweight"), (OF_SHAFT, 190, SECTOR, 25, "shaft")),
    ],
)
def test_devices_deviate_in_unbalance_and_angle(table, angle, weight, size, name):
    """As in files with other figures, at both ends of the tolerances."""
    forces = "force.2.major" if name == "slider" else "force.1.major"
    (spread,) = scatter(SINGLE + table.format(angle, weight.format(size)), forces, Tolerances(mass=0.01, angle_deg=0.5))
    for part, changes in ((name, ((angle, 1.01 * size), (angle, 0.99 * size))),
                          (f"{name} angle", ((angle + 0.5, size), (angle - 0.5, size)))):  # fmt: skip
        ends = [evaluate(SINGLE + table.format(at, weight.format(what)), forces) for at, what in changes]
        assert spread.sensitivity[f"{part} 1"] == pytest.approx((ends[0] - ends[1]) / 2, rel=1e-7)


WEBBED = (
    "[crank]\nstroke = 80\nthrows = [0, 140]\nspacing = 95\n[rod]\nlength = 141\nmass = 0.5\ncg = 38\n"
    "[piston]\nbore = 82\nmass = 0.4\n[operation]\nspeed = 6100\n[bearing]\npin_diameter = 44\npin_length = 26\n"
    "[[web]]\nwebs = [1, 3]\nthickness = 20\nmass = 1.5\ncg = [-13, 0.5]\n"
    "[[web]]\nwebs = [2]\nthickness = 17\nhub = 60\nboss = 52\n[[web]]\n"
)
DIMENSIONS = {"thickness": 19, "outer_radius": 71, "opening": 105, "density": 7.8}
MIDDLE = "hub = 60\nboss = 52\nangle = 186\nholes = [{ x = -55, diameter = 14, density = 17 }]\n"
TOLERANCE = {"thickness": 0.2, "outer_radius": 0.3, "opening": 0.6, "density": 0.01}


def write_web(dimensions, tolerance=""):
    lines = [f"{key} = {value!r}\n" for key, value in dimensions.items()]
    return WEBBED + "".join(lines) + MIDDLE + tolerance


@pytest.mark.parametrize("key", DIMENSIONS)
def test_each_dimension_of_a_web_deviates_by_itself(key):
    """As in files with other dimensions, at both ends: the thickness also moves the web. Weighed webs, and those
    without tolerances, are exact; and the change is another for each quantity.
    """
    written = ", ".join(f"{name} = {size}" for name, size in TOLERANCE.items())
    spreads = scatter(write_web(DIMENSIONS, f"tolerance = {{ {written} }}\n"), FORCES, Tolerances())
    size = TOLERANCE[key] * (DIMENSIONS[key] if key == "density" else 1)
    moved = [DIMENSIONS | {key: DIMENSIONS[key] + side * size} for side in (1, -1)]
    for spread, name in zip(spreads, FORCES.split(","), strict=True):
        ends = [evaluate(write_web(dimensions), name) for dimensions in moved]
        found = spread.sensitivity[f"web 4 {key.replace('_', ' ')}"]
        assert found == pytest.approx((ends[0] - ends[1]) / 2, rel=1e-6, abs=1e-9)
    assert [part for part in spreads[0].sensitivity if part.startswith("web") and " 4 " not in part] == []


def test_figures_of_a_calculation_by_hand():
    text = (
        "[crank]\nstroke = 84\nthrow_mass = 0.9\n[rod]\nlength = 150\nmass = 0.42\ncg = 42\ninertia = 1700\n"
        "[piston]\nbore = 94\nmass = 0.4\n[operation]\nspeed = 6500\n"
    )
    devices = WEIGHT.format(176, "unbalance = 52000") + OF_SHAFT.format(183, "unbalance = 9800")
    (spread,) = scatter(text + devices, "force.1.major", Tolerances(mass=0.01, angle_deg=0.5))
    wanted = {
        "counterweight 1": -218.47445593111843,
        "shaft 1": -39.93304389759669,
        "counterweight angle 1": -88.44657606702185,
        "shaft angle 1": 18.767724702894157,
    }
    assert {name: spread.sensitivity[name] for name in wanted} == pytest.approx(wanted)


def test_a_throw_and_a_weight_that_turn_together_add_up():
    """Both change the angle of the weight in the file, which counts from the throw."""
    text = SINGLE + WEIGHT.format(150, "unbalance = 40000")
    variants = Variants(load(text), "force.1.major", Tolerances(angle_deg=2))
    names = [source.name for source in variants.sources]
    deviations = np.zeros((1, len(names)))
    for name in ("throw angle 1", "counterweight angle 1"):
        deviations[0, names.index(name)] = 2.0
    turned = evaluate(text, "force.1.major")  # the throw and its weight have turned by 2 deg
    assert variants.evaluate(deviations)[0, 0] == pytest.approx(turned, rel=1e-12)
    deviations[0, names.index("counterweight angle 1")] = 0.0
    assert variants.evaluate(deviations)[0, 0] != pytest.approx(turned, rel=1e-4)


def test_shafts_without_an_eccentric_do_not_deviate():
    text = SINGLE + "[[shaft]]\nratio = -1\ninertia = 90\n" + WEIGHT.format(0, "unbalance = 0")
    (spread,) = scatter(text, "force.1.major", Tolerances(mass=0.01, angle_deg=1))
    assert not {name for name in spread.sensitivity if name.startswith(("shaft", "counterweight"))}


def test_devices_of_geared_engines_and_of_the_whole(tmp_path):
    """Those of an engine's own file have its name."""
    (tmp_path / "twin.toml").write_text(TWIN + WEIGHT.format(10, "unbalance = 900"))
    table = '[[engine]]\nname = "{}"\nfile = "twin.toml"\nat = [0, 0, {}]\n'
    shaft = OF_SHAFT.format(20, "unbalance = 700")
    (tmp_path / "pair.toml").write_text(table.format("upper", 0) + table.format("lower", 500) + shaft)
    pair = balcli.load(tmp_path / "pair.toml")
    spread = balcli.scatter(pair, "force.1.major", mass_scatter="1%", samples=10, seed=1).quantities["force.1.major"]
    assert {"upper counterweight 1", "lower counterweight 1", "shaft 1"} <= {*spread.sensitivity}
    assert spread.sensitivity["shaft 1"] != 0


def test_a_rod_deviates_without_its_shells() -> None:
    """What a rod's tolerance does is the same with shells and oil on the pins as without."""
    shells = "[bobweight]\nrod_bearing = 0.05\noil = 0.01\n"
    without, loaded = (scatter(text, "force.1.forward", Tolerances(0.01))[0] for text in (GOOD, GOOD + shells))
    assert loaded.bound == pytest.approx(without.bound, rel=1e-12)


def test_a_throw_has_a_mass_of_its_own() -> None:
    (spread,) = scatter(GOOD, "force.1.forward", Tolerances(0.01))
    assert spread.sensitivity["throw mass 2"] == pytest.approx(0.01 * 0.8 * 0.045 * (3000 * math.pi / 30) ** 2)


@pytest.mark.parametrize("text", [GOOD, RADIAL], ids=["plain", "articulated"])
def test_rods_that_might_lock_are_refused(text: str) -> None:
    with pytest.raises(
        BalcliError, match=r"^some engines within these tolerances are impossible: .*give smaller tolerances$"
    ):
        scatter(text, "force.2.major", Tolerances(length=0.8))
    scatter(text, "force.2.major", Tolerances(length=0.1))


def test_percentiles_rise_and_a_seed_repeats() -> None:
    variants = Variants(load(GOOD), FORCES, Tolerances(0.02))
    runs = [variants.draw(20_000, seed).quantities for seed in (7, 7, 8)]
    assert runs[0] == runs[1]
    assert runs[0]["force.1.major"].mean != runs[2]["force.1.major"].mean
    for s in runs[0].values():
        assert s.p05 <= s.p50 <= s.p95 <= s.max <= s.bound * (1 + 1e-12)


# ------------------------------------------------------------------ the whole cycle
def deviated(found: dict[str, float]) -> str:
    """The file with these deviations, by the names of their sources."""
    own = []
    throws = []
    for k, throw in enumerate((0, 180, 180, 0), 1):
        throws.append(throw + found.get(f"throw angle {k}", 0.0))
        piston = 0.5 * (1 + found.get(f"piston mass {k}", 0.0))
        rod = 0.6 * (1 + found.get(f"rod mass {k}", 0.0))
        length = 150 * (1 + found.get(f"rod length {k}", 0.0))
        own.append(f"{k} = {{piston_mass = {piston!r}, rod_mass = {rod!r}, rod_length = {length!r}}}")
    return "\n".join([FOUR.replace("[0, 180, 180, 0]", repr(throws)), *own])


@pytest.mark.slow
@pytest.mark.parametrize("length", [0.0, 0.003])
def test_a_variant_is_the_engine_of_its_own_file(length):
    """Torque over the cycle, uneven speed, guide moments and torque by order."""
    names = "torque.max,torque.min,torque.mean,fluctuation,guide.2.H,guide.2.X,torque.2.amplitude,force.2.major"
    variants = Variants(load(FOUR), names, Tolerances(0.02, length, 0.4))
    tolerances = [source.tolerance for source in variants.sources]
    drawn = np.random.default_rng(3).uniform(-1, 1, (2, len(tolerances))) * tolerances
    for found, row in zip(variants.evaluate(drawn), drawn.tolist(), strict=True):
        named = {source.name: value for source, value in zip(variants.sources, row, strict=True)}
        engine = build_text(deviated(named))
        expected = balcli.sweep(engine, {"operation.speed": engine.speed_rpm}, names)
        assert found == pytest.approx([expected[name][0] for name in names.split(",")], rel=1e-9)


def test_what_is_0_by_design_has_a_bound():
    """X of order 2 is nothing in four equal cylinders; every deviation makes some."""
    found = balcli.scatter(balcli.load_example("i4_wiebe"), "guide.2.X", samples=30, seed=2).quantities["guide.2.X"]
    assert found.nominal == 0.0
    assert 0 < found.max <= found.bound
    assert all(change >= 0 for change in found.sensitivity.values())
    assert next(iter(found.sensitivity.values())) > 0


def test_masses_leave_the_gas_alone():
    (total, gas) = scatter(FOUR, "torque.2.amplitude,gas.2.amplitude", Tolerances(0.01), 2000)
    assert gas.mean == pytest.approx(gas.nominal, rel=1e-12)
    assert gas.max == pytest.approx(gas.nominal, rel=1e-12)
    assert total.p95 > total.p05


# ------------------------------------------------------------------ what users give
def test_tolerances_in_words() -> None:
    assert read_tolerances("0.5%", "0 %", "0.2 deg", None) == Tolerances(0.005, 0.0, 0.2)
    assert read_tolerances("1%", 0.01, "0.1", "15%") == Tolerances(0.01, 0.01, 0.1, 0.15)


@cases("studies/scatter", "mistakes_in_words")
def test_mistakes_in_words(given: tuple[str, str, str], message: str) -> None:
    with pytest.raises(BalcliError) as caught:
        read_tolerances(*given, None)
    assert str(caught.value).startswith(message)


@cases("studies/scatter", "what_cannot_be_scattered_is_refused", GOOD=GOOD, FOUR=FOUR)
def test_what_cannot_be_scattered_is_refused(text, options, message):
    assert refusal("scatter", "-", *options, stdin=text).startswith(message)


def test_a_table_says_tolerances_parts_and_units_that_fit():
    """Equal parts share a row, and a force of 19 634 N is in kN."""
    out = run_here("scatter", ENGINES / "i4.toml", "--length-scatter", "0.2%", "--samples", "20000").out
    told = " ".join(out.split())
    assert "Spread of 20 000 random engines" in told
    assert "piston mass, rod mass, throw mass ±0.5 %; rod length ±0.2 %" in told
    assert "force.2.major, kN 19.63" in told
    assert "92.4 throw mass 1, 2, 3, 4" in told


def test_tolerances_of_geared_engines_are_named_by_what_deviates(tmp_path: Path) -> None:
    """An engine called "stiffness" is no stiffness."""
    (tmp_path / "twin.toml").write_text(TWIN)
    table = '[[engine]]\nname = "{}"\nfile = "twin.toml"\nat = [0, 0, {}]\n'
    (tmp_path / "pair.toml").write_text(table.format("stiffness", 0) + table.format("lower", 500))
    pair = balcli.load(tmp_path / "pair.toml")
    told = balcli.scatter(pair, "force.1.major", mass_scatter="1%", samples=10, seed=1).text()
    assert "Tolerances: piston mass ±1 %" in told
    assert "lower piston mass 1" in told
