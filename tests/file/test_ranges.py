"""Figures compared with others of the same file: both sides of each limit, at two sizes of engine, and angles."""

import math
import re

import pytest
import tomli_w
from support.commands import refusal, run_here
from support.paths import ENGINES, write

from balcli.engine.parse import parse, read
from balcli.file.doubts import find_suspicious

# A three of bore 75 and stroke 80 mm; masses are those of bore^3, so that it can be built larger.
BORE, STROKE, ROD = 75.0, 80.0, 140.0
PISTON, BIG, SMALL = 0.3, 0.3, 0.1
SWUNG = PISTON + BIG + SMALL


def make(scale=1.0, **changed):
    """Tables of the engine `scale` times as large, with other or further tables."""
    cube = scale**3
    tables = {
        "crank": {"stroke": STROKE * scale, "throws": [0, 240, 120], "spacing": 90 * scale},
        "rod": {"length": ROD * scale, "big_end": BIG * cube, "small_end": SMALL * cube},
        "piston": {"bore": BORE * scale, "mass": PISTON * cube},
        "operation": {"speed": 3000 / scale},
    }
    for key, table in changed.items():
        tables[key] = {**tables.get(key, {}), **table} if isinstance(table, dict) else table
    return tables


def list_doubted(tables):
    return [doubt.path for doubt in find_suspicious(parse(tomli_w.dumps(tables)))]


WHOLE = {"mass": SWUNG - PISTON, "cg": 60.0, "big_end": None, "small_end": None}
LIMITS = {  # path: limit, whether figures below it are doubted, and the tables that give a figure
    "crank.spacing": (BORE, True, 1, lambda x: {"crank": {"spacing": x}}),
    "crank.spacing most": (10 * STROKE, False, 1, lambda x: {"crank": {"spacing": x}}),
    "crank.positions": (BORE, True, 1, lambda x: {"crank": {"positions": [-x - 500, 0, x], "spacing": None}}),
    "layout.stagger": (0.02 * BORE, True, 1, lambda x: {"layout": {"bank_angle": 90, "stagger": x}}),
    "layout.stagger most": (STROKE, False, 1, lambda x: {"layout": {"bank_angle": 90, "stagger": x}}),
    "piston.offset": (0.001 * STROKE, True, 1, lambda x: {"piston": {"offset": x}}),
    "counterweight.1.radius": (
        0.1 * STROKE,
        True,
        1,
        lambda x: {"counterweight": [{"mass": 0.1, "radius": x, "position": 90}]},
    ),
    "shaft.1.radius": (
        5 * STROKE,
        False,
        1,
        lambda x: {"shaft": [{"ratio": -1, "mass": 0.1, "radius": x, "position": 90, "at": [90, 90]}]},
    ),
    "slider.1.position": (
        0.005 * STROKE,
        True,
        1,
        lambda x: {"slider": [{"order": 2, "direction": 0, "unbalance": 2000, "position": x, "at": [90, 90]}]},
    ),
    "shaft.1.at": (
        0.05 * STROKE,
        True,
        1,
        lambda x: {"shaft": [{"ratio": -1, "unbalance": 2000, "position": 90, "at": [x / 2, -x]}]},
    ),
    "counterweight.1.unbalance": (
        0.001 * SWUNG * 1e3 * STROKE / 2,
        True,
        4,
        lambda x: {"counterweight": [{"unbalance": -x, "position": 90}]},
    ),
}


WEB = {"thickness": 20.0, "hub": 60.0, "boss": 50.0, "outer_radius": 72.0, "opening": 100.0}
WEIGHED = {"thickness": 20.0, "mass": 1.5, "cg": [-10.0, 0.0], "inertia": 3600.0}
PINS = {"pin_diameter": 42.0, "pin_length": 24.0}


def give_web(key, form=WEB):
    return lambda x: {"web": [form | {key: x}], "bearing": PINS}


def give_pin(key):
    return lambda x: {"web": [WEB | {"thickness": 5.0}], "bearing": PINS | {key: x}}


def give_tolerance(key):
    return lambda x: {"web": [WEB | {"tolerance": {key: x}}], "bearing": PINS}


LIMITS |= {
    "web.1.thickness": (0.05 * STROKE, True, 1, give_web("thickness")),
    "web.1.thickness between throws": ((90 - 24) / 2, False, 1, give_web("thickness")),
    "web.1.hub": (0.2 * STROKE, True, 1, give_web("hub")),
    "web.1.boss": (0.15 * STROKE, True, 1, give_web("boss")),
    "web.1.outer_radius": (3 * STROKE, False, 1, give_web("outer_radius")),
    "web.1.clearance": (0.2 * STROKE, False, 1, give_web("clearance")),
    "web.1.density": (2.0, True, 0, give_web("density")),
    "web.1.density most": (20.0, False, 0, give_web("density")),
    "web.1.holes.1.diameter": (0.01 * STROKE, True, 1, lambda x: give_web("holes")([{"x": 0, "diameter": x}])),
    "web.1.mass": (30 * SWUNG, False, 3, give_web("mass", {**WEIGHED, "inertia": None})),
    "web.1.cg": (0.005 * STROKE, True, 1, lambda x: give_web("cg", WEIGHED)([x / 2, -x])),
    "web.1.inertia": (1.5 * (0.1 * STROKE) ** 2, True, 5, give_web("inertia", WEIGHED)),
    "web.1.inertia most": (1.5 * (2 * STROKE) ** 2, False, 5, give_web("inertia", WEIGHED)),
    "web.1.tolerance.thickness": (2.0, False, 1, give_tolerance("thickness")),
    "web.1.tolerance.opening": (10, False, 0, give_tolerance("opening")),
    "web.1.tolerance.density": (0.1, False, 0, give_tolerance("density")),
    "bearing.pin_length": (0.1 * STROKE, True, 1, give_pin("pin_length")),
    "frame.crankcase": (0.55 * STROKE, True, 1, lambda x: {"frame": {"crankcase": x}}),
    "piston.skirt": (0.05 * BORE, True, 1, lambda x: {"piston": {"skirt": x}}),
    "bearing.main_positions": (
        0.2 * BORE,
        True,
        1,
        lambda x: {"bearing": {"main_positions": [500, 500 + x, 900]}},
    ),
}


def give_torsion(key):
    return lambda x: {"torsion": {key: x}}


def give_shaft(key, **other):
    """A flywheel on a shaft."""
    return lambda x: {"torsion": {"rear": [{"name": "flywheel", "stiffness": 1e6, **other, key: x}]}}


def give_wheel(key, **other):
    """A locomotive."""
    return lambda x: {"locomotive": {"planes": [-700, 700], **other, key: x}}


BORE2_STROKE = (BORE / 1e3) ** 2 * STROKE / 1e3
RIGIDITY = 79.3e9 * math.pi / 32  # of a steel shaft, over the fourth power of its diameter
LIMITS |= {
    "torsion.throw_stiffness": (2.5e7 * BORE2_STROKE, True, 3, give_torsion("throw_stiffness")),
    "torsion.throw_stiffness most": (
        4e10 * BORE2_STROKE,
        False,
        3,
        lambda x: give_torsion("throw_stiffness")([1e5, x]),
    ),
    "torsion.throw_diameter": (0.05 * STROKE, True, 1, give_torsion("throw_diameter")),
    "torsion.throw_diameter most": (4 * STROKE, False, 1, give_torsion("throw_diameter")),
    "torsion.web_thickness": (0.05 * STROKE, True, 1, give_torsion("web_thickness")),
    "torsion.web_width": (0.2 * STROKE, True, 1, give_torsion("web_width")),
    "torsion.rear.1.stiffness": (RIGIDITY * 0.07**3 / 500, True, 3, give_shaft("stiffness", diameter=70)),
    "torsion.rear.1.diameter": (1e3 * (0.02 * 1e6 / RIGIDITY) ** (1 / 3), True, 1, give_shaft("diameter")),
    "torsion.rear.1.diameter rigid": (0.05 * STROKE, True, 1, give_shaft("diameter", stiffness="rigid")),
    "torsion.rear.1.diameter most": (4 * STROKE, False, 1, give_shaft("diameter", stiffness="rigid")),
    "torsion.throw_inertia": (0.02 * SWUNG * (STROKE / 2) ** 2, True, 5, give_torsion("throw_inertia")),
    "crank.inertia": (
        0.1 * 3 * 3000,
        True,
        5,
        lambda x: {"crank": {"inertia": x}, "torsion": {"throw_inertia": 3000.0}},
    ),
    "crank.inertia most": (
        10 * (3000 + 5000 + 9000),
        False,
        5,
        lambda x: {"crank": {"inertia": x}, "torsion": {"throw_inertia": [3000.0, 5000.0, 9000.0]}},
    ),
    "flywheel.mass": (0.05 * SWUNG, True, 3, lambda x: {"flywheel": {"mass": x, "radius_of_gyration": 100}}),
    "flywheel.mass most": (2000 * SWUNG, False, 3, lambda x: {"flywheel": {"mass": x, "radius_of_gyration": 100}}),
    "flywheel.radius_of_gyration": (
        0.05 * STROKE,
        True,
        1,
        lambda x: {"flywheel": {"mass": 9, "radius_of_gyration": x}},
    ),
    "flywheel.radius_of_gyration most": (
        20 * STROKE,
        False,
        1,
        lambda x: {"flywheel": {"mass": 9, "radius_of_gyration": x}},
    ),
    "locomotive.wheel_diameter": (1.2 * STROKE, True, 1, give_wheel("wheel_diameter")),
    "locomotive.wheel_diameter most": (8 * STROKE, False, 1, give_wheel("wheel_diameter")),
    "locomotive.radius": (0.2 * 150, True, 1, give_wheel("radius", wheel_diameter=300)),
    "locomotive.radius most": (150, False, 1, give_wheel("radius", wheel_diameter=300)),
    "locomotive.radius alone": (0.5 * STROKE / 2, True, 1, give_wheel("radius")),
    "locomotive.radius far": (8 * STROKE / 2, False, 1, give_wheel("radius", wheel_diameter=9000)),
    "locomotive.coupling_radius": (0.2 * STROKE / 2, True, 1, give_wheel("coupling_radius")),
    "rod.length": (
        STROKE / 2 / 0.6,
        True,
        1,
        lambda x: {"rod": {"length": x}, "crosshead": {"mass": 0.5}},
    ),
    "rod.length most": (
        STROKE / 2 / 0.05,
        False,
        1,
        lambda x: {"rod": {"length": x}, "crosshead": {"mass": 0.5}},
    ),
    "piston.mass": (
        250_000 * (BORE / 1e3) ** 3 - 0.5,
        False,
        3,
        lambda x: {"piston": {"mass": x}, "crosshead": {"mass": 0.5}},
    ),
    "bearing.pin_diameter": (0.1 * STROKE, True, 1, lambda x: {"bearing": {"pin_diameter": x}}),
    "bearing.main_diameter": (
        3 * STROKE,
        False,
        1,
        lambda x: {"bearing": {"main_diameter": x, "main_width": 20}},
    ),
}


def strip(tables):
    """Leave out what is None, and scale places that the cases give for the small engine."""
    if isinstance(tables, list):
        return [strip(table) for table in tables] if tables and isinstance(tables[0], dict) else tables
    if isinstance(tables, dict):
        return {key: strip(table) for key, table in tables.items() if table is not None}
    return tables


@pytest.mark.parametrize("name", LIMITS)
def test_a_figure_is_doubted_on_one_side_of_its_limit(name):
    limit, below, _, give = LIMITS[name]
    path = name.partition(" ")[0]
    for factor, doubted in ((0.99, below), (1.01, not below)):
        tables = strip(make(**give(limit * factor)))
        assert (path in list_doubted(tables)) == doubted, factor


@pytest.mark.parametrize("name", ["crank.spacing", "piston.offset", "counterweight.1.unbalance"])
@pytest.mark.parametrize("scale", [0.125, 25.0])
def test_limits_grow_with_the_engine(name, scale):
    """Lengths with the size, unbalances with its fourth power: from a stroke of 10 mm to one of 2 m."""
    limit, _, power, give = LIMITS[name]
    for factor, doubted in ((0.99, True), (1.01, False)):
        tables = strip(make(scale, **give(limit * factor * scale**power)))
        assert (name in list_doubted(tables)) == doubted


def test_a_centre_of_mass_as_a_share_is_doubted():
    for cg, doubted in ((0.3, True), (0.099 * ROD, True), (0.101 * ROD, False), (0, False)):
        tables = make(rod=WHOLE | {"cg": cg})
        assert ("rod.cg" in list_doubted(strip(tables))) == doubted
    (doubt,) = find_suspicious(parse(tomli_w.dumps(strip(make(rod=WHOLE | {"cg": 0.3})))))
    assert "as a share of the length it is 42 mm" in doubt.message


def test_without_a_bore_throws_may_be_nearer():
    for spacing, doubted in ((0.29 * STROKE, True), (0.31 * STROKE, False)):
        tables = make(crank={"spacing": spacing}, piston={"bore": None})
        assert ("crank.spacing" in list_doubted(strip(tables))) == doubted


@pytest.mark.parametrize("key", ["imep", "bmep"])
@pytest.mark.parametrize("intake", [None, 2.0])
def test_a_mean_pressure_lies_above_the_intake(key, intake):
    for pressure, doubted in ((1.29 * (intake or 1), True), (1.31 * (intake or 1), False)):
        gas = {"cycle": "otto", "compression_ratio": 10, key: pressure}
        gas |= {"intake": intake} if intake else {}
        gas |= {"mechanical_efficiency": 0.9} if key == "bmep" else {}
        tables = make(gas=gas, layout={"firing_order": [1, 3, 2]})
        assert (f"gas.{key}" in list_doubted(tables)) == doubted


@pytest.mark.parametrize(
    ("angle", "doubted"),
    [
        (math.pi / 2, True),
        (2.618, True),
        (-2.0944, True),
        (4 * math.pi / 7, True),
        (1.5738, False),
        (2 * math.pi + 0.1, False),
        (90, False),
        (0.4488, False),
    ],
)
def test_a_round_part_of_a_turn_in_radians_is_doubted(angle, doubted):
    weight = {"unbalance": 3000, "position": 90, "angle": angle}
    assert ("counterweight.1.angle" in list_doubted(make(counterweight=[weight]))) == doubted


@pytest.mark.parametrize("key", ["opening", "angle"])
def test_angles_of_webs_in_radians_are_doubted(key):
    for angle, doubted in ((2.618, True), (150, False)):
        tables = make(**give_web(key, WEB | {"opening": 20.0})(angle))
        assert (f"web.1.{key}" in list_doubted(tables)) == doubted


def test_open_dimensions_of_webs_are_not_doubted():
    for key in ("thickness", "outer_radius", "opening"):
        assert list_doubted(make(**give_web(key)("fit"))) == []


def test_a_percentage_without_its_sign_is_asked_back():
    (doubt,) = find_suspicious(parse(tomli_w.dumps(make(**give_tolerance("density")(0.3)))))
    assert str(doubt) == (
        "web.1.tolerance.density: 0.3, where at most 0.1 is usual with a metal; a bare number is a share; in percent, "
        'write it: "0.3 %"'
    )


@pytest.mark.parametrize(("opening", "doubted"), [(2.618, True), (150, False)])
def test_the_opening_of_a_sector_in_radians_is_doubted(opening, doubted):
    """Which keys are angles follows from the types of the tables, also of tables within tables."""
    sector = {"outer_radius": 75, "opening": opening, "thickness": 18}
    weight = {"position": 90, "sector": sector}
    assert ("counterweight.1.sector.opening" in list_doubted(make(counterweight=[weight]))) == doubted


def test_an_angle_with_its_unit_is_not_doubted():
    weight = {"unbalance": 3000, "position": 90, "angle": "2.618 deg"}
    assert list_doubted(make(counterweight=[weight])) == []


def test_of_a_list_the_member_farthest_out_is_named():
    weights = [{"unbalance": size, "position": 90, "angle": 180} for size in (20, 3, 5)]
    assert list_doubted(make(counterweight=weights)) == ["counterweight.2.unbalance"]


def test_no_example_is_doubted():
    for file in sorted(ENGINES.rglob("*.toml")):
        model = read(str(file))
        if not model.engine:
            assert find_suspicious(model) == [], file


# ---------------------------------------------------------------- torsion
CHAIN = """node = [{{name = "a", inertia = "{inertia} kg m^2"}}, {{name = "b", inertia = "40000 kg m^2"}}]
shaft = [{{from = "a", to = "b", stiffness = {stiffness}}}]
"""


def quickness(stiffness, inertia):
    """Natural frequency with both ends, over the frequency of shear waves in a body of steel of the smaller inertia."""
    frequency = math.sqrt(stiffness * (1 / inertia + 1 / 40000))
    return frequency * (inertia / 7850) ** 0.2 / 3200


@pytest.mark.parametrize("inertia", [0.02, 15000])
@pytest.mark.parametrize(("limit", "doubted_below"), [(3e-4, True), (2.0, False)])
def test_a_stiffness_fits_its_inertias(tmp_path, inertia, limit, doubted_below):
    for factor, doubted in ((0.99, doubted_below), (1.01, not doubted_below)):
        stiffness = (limit * factor / quickness(1.0, inertia)) ** 2
        file = write(tmp_path / "chain.toml", CHAIN.format(inertia=inertia, stiffness=f"{stiffness:.9e}"))
        told = run_here("torsion", file).err
        assert ("shaft.1.stiffness" in told) == doubted


def test_a_flexibility_with_its_unit_is_told_with_its_inverse(tmp_path):
    file = write(tmp_path / "chain.toml", CHAIN.format(inertia=15000, stiffness='"4e-9 rad/Nm"'))
    assert refusal("torsion", file).endswith('"4e-9 rad/Nm" is a flexibility; its inverse is 2.5e8 N m/rad')


@pytest.mark.parametrize(("mass", "doubted"), [(0.99, False), (1.01, True)])
def test_a_pendulum_has_less_inertia_than_the_whole_chain(tmp_path, mass, doubted):
    """Two nodes of 2 kg m2 each; mass times the square of radius and length: 3 kg m2 per kg at 1.5 and 0.232 m."""
    reach = 1.5 * (1 + 1 / 2.5**2)
    damper = f'{{ kind = "pendulum", mass = {mass * 4 / reach**2:.9f}, radius = 1500, order = 2.5 }}'
    nodes = f'node = [{{name = "a", inertia = 2e6, damper = {damper}}}, {{name = "b", inertia = 2e6}}]\n'
    file = write(tmp_path / "chain.toml", f'{nodes}shaft = [{{from = "a", to = "b", stiffness = 1e6}}]\n')
    assert ("more than all nodes together" in run_here("torsion", file).err) == doubted


def test_a_balance_mass_outside_its_wheel_has_no_other_unit():
    tables = make(**give_wheel("radius", wheel_diameter=300)(160))
    (doubt,) = find_suspicious(parse(tomli_w.dumps(tables)))
    assert str(doubt) == (
        "locomotive.radius: 160 mm, where 30 to 150 is usual with a wheel diameter of 300 mm; balance masses are inside "
        "their wheel"
    )


@pytest.mark.parametrize(
    ("tables", "usual"),
    [
        ({}, False),
        ({"crosshead": {"mass": 0.5}}, True),
        ({"locomotive": {"planes": [-700, 700]}}, True),
        ({"gas": {"cycle": "compressor", "suction": 1.0, "discharge": 3.6, "clearance": 0.12}}, True),
    ],
)
def test_rods_behind_a_crosshead_may_be_longer(tables, usual):
    """11 ft in a locomotive, 44 in for a stroke of 12 in a pump: the rod is 7 to 10 crank radii long."""
    long = make(rod={"length": STROKE / 2 / 0.106}, **tables)
    assert ("rod.length" not in list_doubted(long)) == usual


@pytest.mark.parametrize(("speed", "doubted"), [(19.8, True), (20.2, False)])
def test_the_speed_of_a_locomotive_is_doubted_by_its_key(speed, doubted):
    """Of the crank, in rpm: at a stroke of 80 mm, 18.75 rpm are 0.05 m/s. The largest is 40 m/s, 15000 rpm."""
    wheel = {"planes": [-700, 700], "wheel_diameter": 300}
    for factor in (18.75 / 20, 15000 / 20):
        upper = factor > 1
        tables = make(locomotive=wheel | {"speed": speed * factor * 60e-6 * math.pi * 300})
        del tables["operation"]
        doubts = find_suspicious(parse(tomli_w.dumps(tables)))
        assert [doubt.path for doubt in doubts] == ["locomotive.speed"] * (doubted != upper)
        assert all(doubt.also == ("locomotive.wheel_diameter", "crank.stroke") for doubt in doubts)


def test_positions_that_do_not_rise_are_doubted():
    for positions, doubted in (([-90, 0, 90], False), ([-90, 90, 0], True), ([90, 0, -90], True)):
        tables = strip(make(crank={"positions": positions, "spacing": None}))
        assert ("crank.positions" in list_doubted(tables)) == doubted


@pytest.mark.parametrize(("size", "place"), [(25.4, 0), (10.0, 1), (1000.0, 0)])
def test_the_unit_that_is_proposed_is_read_as_such(size, place):
    """Spacing in inches, centimetres or metres: what the doubt proposes gives the right spacing, and no doubt."""
    bare = 90 / size
    (doubt,) = find_suspicious(parse(tomli_w.dumps(make(crank={"spacing": bare}))))
    proposed = re.findall(r'"([^"]+)"', doubt.message)[place]
    model = parse(tomli_w.dumps(make(crank={"spacing": proposed})))
    assert model.crank.spacing == pytest.approx(90, rel=1e-4)
    assert find_suspicious(model) == []
