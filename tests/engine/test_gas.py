"""[gas] of an engine file: what is built of it, and every mistake by its path."""

import math
import os
import re

import numpy as np
import pytest
from support.cases import cases
from support.engines import RADIAL, build_text, list_problems
from support.gas_engines import FOUR, WIEBE
from support.paths import write

from balcli import load
from balcli.core.cylinder_pressure import find_highest
from balcli.engine.build import build
from balcli.engine.load import EngineVariants

TWO_STROKE = FOUR.replace("firing_order = [1, 3, 4, 2]", "strokes = 2")


# ------------------------------------------------------------------ what is built
def test_cylinders_fire_as_the_firing_order_has_it():
    gas = build_text(FOUR + WIEBE).gas
    assert [c.nominal_deg for c in gas.cylinders] == [0, 540, 180, 360]
    assert gas.cycle_deg == 720
    assert len({id(c.torque) for c in gas.cylinders}) == 1, "equal cylinders are computed once"


def test_dead_centres_are_those_of_the_mechanism():
    gas = build_text(FOUR.replace("mass = 0.5", "mass = 0.5\noffset = 12") + WIEBE).gas
    assert gas.cylinders[0].fires == pytest.approx(math.asin(12 / 195), abs=1e-14)
    assert gas.cylinders[1].fires - gas.cylinders[0].fires == pytest.approx(3 * math.pi, abs=1e-13)


def test_bmep_is_imep_times_mechanical_efficiency():
    """Which is not known where a cylinder burns nothing."""
    text = FOUR + WIEBE.replace("imep = 9", "bmep = 9\nmechanical_efficiency = 0.9")
    engine = build_text(text)
    assert engine.gas.cylinders[0].torque.imep == pytest.approx(10e5, rel=1e-12)
    assert engine.mechanical_efficiency == 0.9
    assert build_text(text + "[cylinder.4]\nheat = 0\n").mechanical_efficiency is None


def test_a_cylinder_without_heat_compresses_and_expands_alike():
    """Its pressure by hand, p V^1.32 both ways; work is that of changing the gas alone."""
    engine = build_text(FOUR + WIEBE + "intake = 1.6\nexhaust = 1.9\n[cylinder.3]\nheat = 0\n")
    dead = engine.gas.cylinders[engine.numbers.index(3)]
    swept = math.pi / 4 * 0.086**2 * 0.09
    angle = np.radians(np.arange(-179.0, 180.0, 7.0))
    height = 0.045 * np.cos(angle) + np.sqrt(0.15**2 - (0.045 * np.sin(angle)) ** 2)
    volume = swept / 9 + math.pi / 4 * 0.086**2 * (0.195 - height)
    exact = 1.6e5 * (swept / 9 * 10 / volume) ** 1.32
    assert dead.torque.pressure.at(angle) == pytest.approx(exact, rel=1e-12)
    assert dead.torque.work == pytest.approx(-0.3e5 * swept, rel=1e-12)
    assert engine.silent.without_burning == (3,)
    assert engine.silent.without_gas == ()
    assert len({id(c.torque) for c in engine.gas.cylinders}) == 2


def test_a_cylinder_may_have_a_heat_of_its_own():
    """And what it had with the same heat as all others."""
    alike = build_text(FOUR + WIEBE.replace("imep = 9", "heat = 900")).gas.cylinders[0].torque
    own = build_text(FOUR + WIEBE + "[cylinder.1]\nheat = 900\n")
    assert own.gas.cylinders[0].torque.imep == pytest.approx(alike.imep, rel=1e-13)
    assert own.gas.cylinders[1].torque.imep == pytest.approx(9e5, rel=1e-12)
    assert own.silent.without_burning == ()


def test_flywheel_crank_and_bearings():
    text = FOUR.replace("spacing = 100", "spacing = 100\ninertia = 40000") + "[flywheel]\nmass = 10\n"
    found = build_text(text + "radius_of_gyration = 120\n[bearing]\npin_diameter = 48\npin_width = 20\n")
    assert (found.crank_inertia, found.flywheel_inertia) == pytest.approx((0.04, 0.144))
    assert found.bearings.pin_m2 == pytest.approx(960e-6)
    assert (found.bearings.main_m2, found.gas) == (None, None)


# ------------------------------------------------------------------ files beside the engine file
DIAGRAM = "angle_deg,pressure_MPa\n# a note\n" + "\n".join(
    f"{angle},{6 if angle == 370 else 0.1}" for angle in range(0, 721, 10)
)


@pytest.fixture
def beside(tmp_path):
    """Writes an engine file and a file beside it; returns the engine file's path."""

    def write_both(gas: str, name: str = "p.csv", content: str = DIAGRAM) -> str:
        write(tmp_path / name, content)
        return str(write(tmp_path / "engine.toml", FOUR + "[gas]\n" + gas))

    return write_both


def test_a_diagram_may_count_from_the_other_dead_centre_and_be_shifted(beside):
    path = beside('indicator = "p.csv"\nzero = "gas-exchange"\nphase = 5\npressure = "gauge"\n')
    gas = load(path).gas.cylinders[0].torque
    angle, value = find_highest(gas.pressure)
    assert math.degrees(angle) == pytest.approx(15)
    assert value == pytest.approx(6e6 + 101325)


@pytest.mark.parametrize(("head", "unit"), [("barg", 0.1), ("psig", 0.006894757293168361)])
def test_a_heading_may_say_that_pressures_are_over_the_atmosphere(beside, head, unit):
    rows = "\n".join(f"{a},{(6 if a == 10 else 0.1) / unit}" for a in range(0, 721, 10))
    gas = load(beside('indicator = "p.csv"', content=f"angle_deg,pressure_{head}\n{rows}"))
    assert find_highest(gas.gas.cylinders[0].torque.pressure).value == pytest.approx(6e6 + 101325)


def test_one_cylinder_may_have_a_diagram_of_its_own(beside, tmp_path):
    path = beside('indicator = "p.csv"\nzero = "gas-exchange"\n[cylinder.3]\nindicator = "q.csv"\n')
    (tmp_path / "q.csv").write_text(DIAGRAM.replace(",6", ",3"), encoding="utf-8")
    found = load(path).gas
    highest = [find_highest(c.torque.pressure).value for c in found.cylinders]
    assert highest == pytest.approx([6e6, 6e6, 3e6, 6e6])


def test_harmonics_are_of_the_mean_tangential_pressure(beside):
    content = "order,cos,sin\n0,2,0\n0.5,1,3\n"
    path = beside('harmonics = "h.csv"\n', "h.csv", content)
    torque = load(path).gas.cylinders[0].torque
    unit = math.pi / 4 * 0.086**2 * 0.045 * 1e5
    assert torque.harmonics([0, 1, 2]) == pytest.approx([2 * unit, (1 - 3j) * unit, 0])


def test_where_a_diagram_may_lie(beside, tmp_path):
    outside = 'gas.indicator: "../p.csv" is outside the folder of the engine file; put it there'
    for name, told in {"q.csv": f"gas.indicator: {tmp_path}/q.csv: no such file", "../p.csv": outside}.items():
        assert list_problems(beside(f'indicator = "{name}"\n')) == [told]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_diagram_that_is_a_named_pipe_is_refused(beside, tmp_path):
    """Reading it would wait for ever."""
    path = beside('indicator = "pipe.csv"\n')
    os.mkfifo(tmp_path / "pipe.csv")
    told = 'gas.indicator: "pipe.csv" is a named pipe or a device; give a regular file'
    assert list_problems(path) == [told]


UNITS = "(or pressure_MPa, pressure_kPa, pressure_Pa, pressure_psi, pressure_barg, pressure_psig)"


@cases("engine/gas", "mistakes_of_a_diagram", DIAGRAM=DIAGRAM, UNITS=UNITS)
def test_mistakes_of_a_diagram(beside, tmp_path, content, told):
    path = beside('indicator = "p.csv"\n', content=content)
    assert list_problems(path) == ["gas.indicator: " + told.format(folder=tmp_path)]


@cases("engine/gas", "mistakes_of_harmonics")
def test_mistakes_of_harmonics(beside, rows, told):
    path = beside('harmonics = "p.csv"\n', content="order,cos,sin\n" + rows)
    assert list_problems(path) == [f"gas.harmonics: p.csv: {told}"]


def test_a_diagram_may_have_so_many_rows(beside):
    rows = [f"{k * 0.036:.3f},0.1\n" for k in range(20001)]
    head = "# measured\nangle_deg,pressure_MPa\n\n"
    load(beside('indicator = "p.csv"\n', content=head + "".join(rows[:-1])))
    for content, told in (
        (head + "".join(rows), "has more than 20000 rows; give only the mean of the cycles"),
        (f"{head}1,{'0' * 20_000}\n", "line 4: has more than 10000 characters"),
        (f"angle_deg,pressure_MPa\n{' ' * 6_000_000}", "has more than 6 MB"),
    ):
        (found,) = list_problems(beside('indicator = "p.csv"\n', content=content))
        assert f"p.csv: {told}" in found


# ------------------------------------------------------------------ mistakes
@cases("engine/gas", "a_mistake_by_its_path", FOUR=FOUR, TWO_STROKE=TWO_STROKE, WIEBE=WIEBE)
def test_a_mistake_by_its_path(text, told):
    (found,) = list_problems(text)
    assert found.startswith(told)


@pytest.mark.parametrize(("share", "asked"), [(0.049, False), (0.051, True), (0.49, True), (0.51, False)])
def test_a_pressure_in_megapascals_is_asked_back(share, asked):
    """A tenth of a pressure that is possible; a file that names the unit is not asked."""
    lowest = WIEBE.replace("imep = 9", "max_pressure = 3")
    least = float(re.search(r"at least (\S+) bar", list_problems(FOUR + lowest)[0])[1])
    for unit, may_ask in (("", True), (" bar", False)):
        figure = f"{least * share:.6g}"
        given = f'"{figure} bar"' if unit else figure
        (told,) = list_problems(FOUR + WIEBE.replace("imep = 9", f"max_pressure = {given}"))
        question = f'; is it in bar? Give another unit as in "{float(figure):g} MPa"'
        assert told.endswith(question) == (asked and may_ask)


@cases("engine/gas", "mistakes_of_heat_of_a_cylinder", WIEBE=WIEBE)
def test_mistakes_of_heat_of_a_cylinder(gas, own, told):
    assert list_problems(f"{FOUR}{gas}[cylinder.2]\n{own}\n")[0].startswith(told)


THREE = RADIAL.replace("radial = 7", "radial = 3\nfiring_order = [1, 3, 2]").replace("[piston]", "[piston]\nbore = 120")


def test_articulated_cylinders_have_cycles_of_their_own():
    gas = build_text(THREE + WIEBE).gas
    strokes = {round(c.piston.stroke, 6) for c in gas.cylinders}
    assert len(strokes) == 2
    assert len({id(c.torque) for c in gas.cylinders}) == 3
    for c in gas.cylinders:
        assert c.torque.work / c.piston.swept == pytest.approx(9e5, rel=1e-10)


@pytest.mark.parametrize(("strokes", "order"), [(2, [1, 3, 2]), (4, [1, 2, 3])])
def test_cylinders_that_turn_have_gas_too(strokes, order):
    """A rotary engine: seen from its cylinder, the crank turns; the torque turns the cylinders."""
    text = FOUR.replace("throws = [0, 180, 180, 0]", "").replace("spacing = 100", "")
    layout = f"radial = 3\nrotary = true\nstrokes = {strokes}\nfiring_order = {order}"
    found = build_text(text.replace("firing_order = [1, 3, 4, 2]", layout) + WIEBE)
    fires = [c.nominal_deg for c in found.gas.cylinders]
    assert fires == pytest.approx([found.fires_deg[number] for number in found.numbers])
    assert sorted(fires) == pytest.approx([0, 60 * strokes, 120 * strokes])


@pytest.mark.parametrize(
    "figures",
    [{"crank.stroke": 80}, {"rod.length": 180}, {"piston.bore": 80}, {"gas.imep": 8}, {"cylinder.1.piston_offset": 2}],
)
def test_the_gas_of_another_variant_serves_where_it_is_the_same(figures):
    model = load(FOUR + WIEBE).model
    variants = EngineVariants(model)
    variants.build({})
    found, own = (e.gas.cylinders[0].torque for e in (variants.build(figures), build(model, figures)))
    assert (found.work, found.pressure.mean) == (own.work, own.pressure.mean)
