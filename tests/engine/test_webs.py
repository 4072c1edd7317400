"""Webs of a crankshaft: from dimensions, drawing and scales to forces."""

import json
import math

import ezdxf
import numpy as np
import pytest
from numpy.testing import assert_allclose
from support.commands import ask, ask_csv

from balcli import SchemeOptions, analyze, balance, load, sweep
from balcli.errors import ArgumentError, BalcliError, InputError
from balcli.studies.quantities import name_numbers

FOUR = {
    "crank": {"stroke": 88, "throws": [0, 180, 180, 0], "spacing": 93},
    "rod": {"length": 150, "mass": 0.62, "cg": 42, "inertia": 2480},
    "piston": {"bore": 85, "mass": 0.52, "skirt": 27},
    "layout": {"firing_order": [1, 3, 4, 2]},
    "operation": {"speed": 6500},
    "frame": {"crankcase": 82},
    "bearing": {"pin_diameter": 45, "pin_length": 27},
}
WEB = {"thickness": 20.5, "hub": 65, "boss": 53, "outer_radius": 78, "opening": 115.56941835258267}
TOLERANCE = {"thickness": 0.1, "outer_radius": 0.25, "opening": 0.5, "density": "0.3%"}
WEIGHED = {"thickness": 20.5, "mass": 1.7, "cg": [-14, 0.6], "inertia": 4100}


def find_parts(*webs, **more):
    tables = {key: {**FOUR.get(key, {}), **more.get(key, {})} for key in FOUR | more if key != "counterweight"}
    if "counterweight" in more:
        tables["counterweight"] = more["counterweight"]
    return load(tables | {"web": list(webs)})


def test_figures_of_a_web_from_dimensions():
    """Figures by an independent computation with polygons of 40 000 points an arc."""
    parts = analyze(find_parts(WEB | {"tolerance": TOLERANCE}), only=["parts"]).parts
    web = parts.webs[0]
    assert (web.web, web.throw, web.table, web.position_mm) == (1, 1, 1, -163.25)
    assert_allclose(web.mass_kg, 1.682160817746)
    assert_allclose(1e6 * web.unbalance_kg_m, 24866.42201961)
    assert_allclose(1e6 * web.inertia_kg_m2, 4020.248647953)
    assert_allclose([1e6 * web.worst_kg_m, 1e6 * web.rss_kg_m], [726.5308674, 451.5360374])
    assert_allclose([1e3 * web.clearance_m, web.clearance_deg], [1, 180], atol=1e-6)
    assert_allclose(1e3 * web.crankcase_m, 4)
    throw = parts.throws[3]
    assert_allclose([throw.throw_mass_kg, throw.degree_of_balance, throw.factor], [1.023066926, 1.236003951, 0.5])
    assert_allclose([parts.crank.mass_kg, 1e6 * parts.crank.inertia_kg_m2], [14.80565418, 35113.73449])


def test_webs_act_as_pins_and_counterweights():
    """Every order of force, moment and bearing load is that of the pin as throw mass and of each
    web as a counterweight in its own plane.
    """
    engine = find_parts(WEB | {"webs": [1, 4, 6]}, WEIGHED)
    pin = 7.85e-6 * math.pi / 4 * 45**2 * 27
    weights = [
        {
            "unbalance": 1e6 * abs(web.body.unbalance),
            "angle": math.degrees(np.angle(web.body.unbalance)) + (0, 180, 180, 0)[web.throw],
            "position": 1e3 * float(web.z),
        }
        for web in engine.webs.webs
    ]
    plain = load({**FOUR, "crank": {**FOUR["crank"], "throw_mass": pin}, "counterweight": weights})
    only = ["force", "moment", "couple", "roll", "inner"]
    found, wanted = (analyze(e, only=only, orders=[1, 2, 4]).to_dict() for e in (engine, plain))
    for place in ("orders", "inner"):
        assert_allclose(list_numbers(found[place]), list_numbers(wanted[place]), rtol=1e-9, atol=1e-6)


def list_numbers(node):
    if isinstance(node, dict):
        return [x for key, part in node.items() if not key.endswith("deg") for x in list_numbers(part)]
    if isinstance(node, list):
        return [x for part in node for x in list_numbers(part)]
    return [float(node)] if isinstance(node, (int, float)) else []


def test_inertia_of_webs_counts_as_that_of_the_crank():
    engine = find_parts(WEB)
    assert_allclose(1e6 * engine.crank_inertia, 35113.73449)
    weight = {"unbalance": 5000, "inertia": 1000}
    assert_allclose(1e6 * find_parts(WEB, counterweight=[weight]).crank_inertia, 36113.73449)
    assert find_parts(WEB, crank={"inertia": 50000}).crank_inertia == 0.05
    assert find_parts({**WEIGHED, "inertia": None}).crank_inertia is None


def test_holes_and_slugs_change_mass_and_unbalance():
    bare = analyze(find_parts(WEB), only=["parts"]).parts.webs[0]
    for x, y, diameter, density in ((44, 0, 22, 0), (-60, 9, 18, 17)):
        hole = {"x": x, "y": y, "diameter": diameter, "density": density}
        web = analyze(find_parts(WEB | {"holes": [hole]}), only=["parts"]).parts.webs[0]
        mass = (density - 7.85) * 1e-6 * 20.5 * math.pi / 4 * diameter**2
        assert_allclose(web.mass_kg - bare.mass_kg, mass)
        moved = web.mass_kg * complex(*web.cg_m) - bare.mass_kg * complex(*bare.cg_m)
        assert_allclose(moved, mass * complex(x, y) / 1e3, atol=1e-12)


@pytest.mark.parametrize("kind", ["LWPOLYLINE", "POLYLINE"])
@pytest.mark.parametrize(("unit", "scale"), [(4, 1.0), (1, 25.4), (0, 1.0)])
def test_drawing_of_a_cad_program_is_read(tmp_path, kind, unit, scale):
    """A stadium of two lines and two half circles with a hole, by its closed form."""
    drawing = ezdxf.new("R2010" if kind == "LWPOLYLINE" else "R2000")
    drawing.header["$INSUNITS"] = unit
    points = [(-60, -30, 0), (44, -30, 1), (44, 30, 0), (-60, 30, 1)]
    points = [(x / scale, y / scale, bulge) for x, y, bulge in points]
    space = drawing.modelspace()
    if kind == "LWPOLYLINE":
        space.add_lwpolyline(points, format="xyb", close=True)
    else:
        space.add_polyline2d(points, format="xyb", close=True)
    space.add_circle((44 / scale, 0), 11 / scale)
    drawing.saveas(tmp_path / "web.dxf")
    (tmp_path / "e.toml").write_text(write_toml(FOUR) + '[[web]]\nthickness = 20.5\nprofile = "web.dxf"\n')
    web = analyze(load(tmp_path / "e.toml"), only=["parts"]).parts.webs[0]
    plate = 104 * 60 + math.pi * 30**2
    hole = math.pi * 11**2
    assert_allclose(web.mass_kg, 7.85e-6 * 20.5 * (plate - hole))
    assert_allclose(web.unbalance_kg_m, 7.85e-9 * 20.5 * (8 * plate + 44 * hole))
    assert web.opening_deg is None
    assert_allclose(web.swing_radius_m, 0.09)


def write_toml(tables):
    lines = []
    for name, table in tables.items():
        lines.append(f"[{name}]")
        lines += [f"{key} = {json.dumps(value)}" for key, value in table.items()]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("add", "told"),
    [
        (lambda space: space.add_lwpolyline([(0, 0), (9, 0), (5, 5)]), "is open"),
        (lambda space: space.add_circle((0, 0), 5), "no POLYLINE"),
        (lambda space: space.add_line((0, 0), (5, 5)), "has a LINE"),
        (lambda space: space.add_spline([(0, 0, 0), (5, 5, 0), (9, 0, 0)]), "has a SPLINE"),
    ],
)
def test_wrong_drawings_are_refused(tmp_path, add, told):
    drawing = ezdxf.new()
    drawing.header["$INSUNITS"] = 4
    add(drawing.modelspace())
    drawing.saveas(tmp_path / "web.dxf")
    (tmp_path / "e.toml").write_text(write_toml(FOUR) + '[[web]]\nthickness = 20.5\nprofile = "web.dxf"\n')
    with pytest.raises(InputError, match=f"web.1.profile: web.dxf.*{told}.*closed polyline of lines and arcs"):
        load(tmp_path / "e.toml")


def replace_keys(**keys):
    return [{key: value for key, value in (WEB | keys).items() if value is not None}]


@pytest.mark.parametrize(
    ("webs", "more", "told"),
    [
        (replace_keys(), {"crank": {"throw_mass": 1.0}}, "crank.throw_mass: it follows from \\[\\[web\\]\\]"),
        (replace_keys(opening=200), {}, "web.1.opening: 200 deg; at most 195.67 deg with this hub and boss"),
        (replace_keys(opening=100, angle=120), {}, "web.1.opening: 100 deg; at most 75.67"),
        (replace_keys(outer_radius=32.5), {}, "web.1.outer_radius: 32.5 mm; give more than"),
        (replace_keys(boss=154), {}, "web.1.boss: 154 mm: encloses the hub"),
        (replace_keys(holes=[{"x": 44, "diameter": 54}]), {}, "web.1.holes: .*not within"),
        (replace_keys(opening="fit", outer_radius="fit"), {}, 'web.1: opening and outer_radius are "fit"'),
        (replace_keys(opening=None), {}, "web.1.outer_radius: is given without opening"),
        (replace_keys(profile="x.dxf"), {}, "web.1.hub: given with profile"),
        (replace_keys(boss=None), {}, "web.1.boss: is missing"),
        ([{"thickness": 20, "mass": 1.5}], {}, "web.1.cg: is missing"),
        (replace_keys(webs=[9]), {}, "web.1.webs: 9, but the crank has 8 webs"),
        ([WEB | {"webs": [1, 8]}, WEB | {"webs": [8, 2]}], {}, "web.2.webs: web 8"),
        ([WEB | {"webs": [1, 2]}, WEB | {"webs": [4, 5, 6, 7, 8]}], {}, "web 3"),
        (replace_keys(), {"bearing": {"pin_length": None}}, "bearing.pin_length"),
        (replace_keys(), {"crank": {"splay": 10}}, "crank.splay"),
        (replace_keys(), {"crank": {"spacing": None}}, "crank.spacing"),
        (replace_keys(), {"crank": {"stroke": [88, 88, 88, 90]}}, "crank.stroke: web 7 has a stroke of 90"),
        (replace_keys(opening="fit"), {}, 'web.1.opening is "fit": run balcli balance FILE write OUT'),
    ],
)
def test_contradictions_are_named(webs, more, told):
    with pytest.raises(InputError, match=told):
        find_parts(*webs, **more)


def test_clearance_counts_neighbours():
    """The web beside the first cylinder lies under the next cylinder's piston as well: on a crank
    of 88 mm stroke with a spacing of 60, that piston is nearest at another crank angle.
    """
    crank = {"stroke": 88, "throws": [0, 90, 270, 180], "spacing": 60}
    layout = {"firing_order": None}
    parts = analyze(find_parts(WEB | {"angle": 90, "opening": 14}, crank=crank, layout=layout), only=["parts"]).parts
    assert {web.clearance_cylinder for web in parts.webs} > {1}
    angles = np.radians(np.arange(0, 360, 0.05))
    web = parts.webs[1]
    tip = np.radians(90 + np.linspace(-7, 7, 281))
    gaps = []
    for cylinder, pin in ((0, 0), (1, 90)):
        psi = angles + math.radians(pin)
        height = 44 * np.cos(psi) + np.sqrt(150**2 - (44 * np.sin(psi)) ** 2) - 27
        apart = abs((-90, -30)[cylinder] - web.position_mm) - 10.25
        half = math.sqrt(42.5**2 - apart**2)
        places = 78 * np.exp(1j * (angles[:, None] + tip))
        over = abs(places.imag) <= half
        gaps.append(np.where(over, height[:, None] - places.real, np.inf).min())
    assert_allclose(1e3 * web.clearance_m, min(gaps), atol=2e-3)


def test_card_of_a_file_with_webs(tmp_path):
    (tmp_path / "e.toml").write_text(write_toml(FOUR) + "[[web]]\n" + write_toml({"": WEB}).replace("[]\n", ""))
    result = json.loads(ask("balance", str(tmp_path / "e.toml"), "--factor", "50%", "-f", "json"))
    assert result["counterweights"] == []


def write_four(folder, *webs):
    file = folder / "e.toml"
    tables = "".join("[[web]]\n" + write_toml({"": web}).replace("[]\n", "") for web in webs)
    file.write_text(write_toml(FOUR) + tables)
    return file


def test_card_and_masses_have_the_throw_with_its_cheeks(tmp_path):
    """Pin and cheeks as in the parts table; of weighed webs, the cheeks are not known: the pin alone."""
    pin = 7.85e-6 * math.pi / 4 * 45**2 * 27
    for webs, kilograms, label in (
        ([WEB], 1.023066926, "throw itself, at the crank radius"),
        ([WEIGHED], pin, "crank pin alone"),
        ([WEB | {"webs": [2, 3, 4, 5, 6, 7, 8]}, WEIGHED], None, "crank pin alone"),
    ):
        file = write_four(tmp_path, *webs)
        card = json.loads(ask("balance", file, "--factor", "50%", "-f", "json"))["details"]["card"]
        wanted = [kilograms] * 4 if kilograms else [pin, *[1.023066926] * 3]
        assert_allclose([own["throw_g"] / 1e3 for own in card], wanted)
        masses = json.loads(ask("analyze", file, "--only", "masses", "-f", "json"))["masses"]
        found = {number: own["throw_kg"] for own in masses for number in own["cylinders"]}
        assert_allclose([found[number] for number in (1, 2, 3, 4)], wanted)
        table = ask("balance", file, "--factor", "50%", "-f", "card")
        assert label in table
        assert ("does not tell what belongs to its cheek" in " ".join(table.split())) == (label == "crank pin alone")
    assert "Bobweight of pins 2, 3, 4" in table
    assert "Bobweight of pin 1\n" in table


def test_rods_on_one_pin_share_the_throw():
    """A vee: half of the throw counts for each of its cylinders."""
    tables = {key: table for key, table in FOUR.items() if key != "layout"}
    vee = load(tables | {"layout": {"bank_angle": 90}, "web": [WEB]})
    result = analyze(vee, only=["masses", "parts"])
    whole = result.parts.throws[0].throw_mass_kg
    assert_allclose(whole, 1.023066926)
    assert_allclose([own.throw_kg for own in result.masses], whole / 2)


UNEVEN = {key: FOUR[key] for key in ("rod", "piston", "operation", "bearing")} | {
    "crank": {"stroke": 88, "throws": [0, 100], "spacing": 93}
}


@pytest.mark.parametrize(
    ("key", "values"),
    [("thickness", [18, 22]), ("outer_radius", [70, 80]), ("opening", [90, 120]), ("density", [7.1, 8])],
)
def test_dimensions_of_webs_vary_as_in_files_of_their_own(key, values):
    """All webs of the table vary together; the density is that of the pin, too."""
    names = ["force.1.major", "moment.1.major"]
    web = WEB | {"angle": 184, "webs": [1, 3, 4]}
    other = {"thickness": 18, "hub": 65, "boss": 53}
    swept = sweep(load(UNEVEN | {"web": [web, other]}), {f"web.1.{key}": values}, names)
    for k, value in enumerate(values):
        alone = analyze(load(UNEVEN | {"web": [web | {key: value}, other]}), orders=[1])
        wanted = [float(alone.spectra[name].major[0]) for name in ("force", "moment")]
        assert_allclose([column[k] for column in swept.values], wanted, rtol=1e-9)


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        ("web.1.opening", 200, "web.1.opening: 200 deg; at most 195.67 deg"),
        ("web.1.outer_radius", 32.5, "web.1.outer_radius: 32.5 mm; give more than the hub's radius"),
        ("web.1.hub", 60, "but for thickness, outer_radius, opening and density of webs with an outline"),
        ("web.2.thickness", 20, "give each value a file of its own"),
        ("bearing.pin_length", 30, "give each value a file of its own"),
    ],
)
def test_other_figures_of_webs_do_not_vary(path, value, told):
    engine = find_parts(WEB | {"webs": [1, 2, 3]}, WEIGHED)
    with pytest.raises(BalcliError, match=told):
        sweep(engine, {path: [value]}, ["force.1.major"])


def test_numbers_lists_what_varies():
    model = find_parts(WEB | {"webs": [1, 2, 3]}, WEIGHED).model
    listed = [number.path for number in name_numbers(model).numbers]
    fixed = ("web.", "bearing.", "crank.stroke", "crank.throw_mass")
    wanted = [f"web.1.{key}" for key in ("thickness", "outer_radius", "opening", "density")]
    assert [name for name in listed if name.startswith(fixed)] == wanted
    assert "crank.spacing" in listed


@pytest.mark.parametrize(("key", "narrow"), [("outer_radius", 68), ("opening", 60)])
def test_variants_of_webs_hold_their_holes(key, narrow):
    """As a file does: a hole through the outline of a variant is refused."""
    engine = find_parts(WEB | {"holes": [{"x": -55, "y": 35, "diameter": 10}]})
    wide = sweep(engine, {f"web.1.{key}": [WEB[key] - 1, WEB[key]]}, ["force.1.major"])
    assert np.isfinite(wide["force.1.major"]).all()
    with pytest.raises(BalcliError, match=rf"web.1.{key} = {narrow}: web.1.holes: .*not within the outline"):
        sweep(engine, {f"web.1.{key}": [WEB[key], narrow]}, ["force.1.major"])


def test_csv_has_the_figures_of_every_web(tmp_path):
    """For the foundry: one line a figure, with x and y of the centre of mass."""
    rows = ask_csv("analyze", write_four(tmp_path, WEB | {"angle": 186}), "--only", "parts")
    web = analyze(load(tmp_path / "e.toml"), only=["parts"]).parts.webs[2]
    found = {row["figure"]: row["value"] for row in rows if row["quantity"] == "web 3"}
    assert_allclose([float(found[f"cg_m.{axis}"]) for axis in (1, 2)], web.cg_m)
    for key in ("mass_kg", "unbalance_kg_m", "inertia_kg_m2", "opening_deg", "clearance_m", "position_mm"):
        assert_allclose(float(found[key]), getattr(web, key))
    assert {row["quantity"] for row in rows} == {
        *(f"web {number}" for number in range(1, 9)),
        *(f"throw {number}" for number in range(1, 5)),
        "crank",
    }


def test_a_measured_mass_counts_beside_the_webs(tmp_path):
    """Measured at 700 g on each pin, the crank is that of (700 - 446.4)/693.6: what the webs of 50 % have too
    much is written as counterweights at the throws.
    """
    file = write_four(tmp_path, WEB)
    out = tmp_path / "out.toml"
    ask("balance", file, "--measured", "700 g", "--factor", "40%", "--planes=-160,160", "--write", out)
    has = (0.7 - 0.4464) / 0.6936
    throws = analyze(load(out), only=["parts"]).parts.throws
    change = (0.4 - has) * 0.6936 * 0.044
    said = json.loads(ask("balance", file, "--measured", "700 g", "--factor", "40%", "-f", "json"))["details"]
    assert_allclose([said["measured_factor"], said["factor"]], [has, 0.4])
    assert_allclose([own["unbalance_kg_m"] for own in said["change"]], change)
    assert_allclose([throw.factor for throw in throws], has)  # the added weights of a flat crank cancel in two planes
    alone = json.loads(ask("balance", file, "--measured", "700 g", "-f", "json"))
    places = [weight["position_mm"] for weight in alone["counterweights"]]
    assert_allclose(places, [-163.25, -115.75, -70.25, -22.75, 22.75, 70.25, 115.75, 163.25])
    assert_allclose(
        [weight["unbalance_kg_m"] for weight in alone["counterweights"]], (0.5 - has) * 0.6936 * 0.022, rtol=1e-9
    )


def ask_weights(file, *options):
    return json.loads(ask("balance", str(file), *options, "-f", "json"))["counterweights"]


def test_planes_of_the_webs_halve_the_weights_at_every_throw(tmp_path):
    """The webs balance 50 %: for 90 %, each needs 40 % of half of a cylinder's reciprocating mass."""
    file = tmp_path / "e.toml"
    file.write_text(write_toml(FOUR) + "[[web]]\n" + write_toml({"": WEB}).replace("[]\n", ""))
    halves = ask_weights(file, "--factor", "90%", "--planes=webs")
    assert_allclose([half["unbalance_kg_m"] for half in halves], 0.4 * 0.6936 * 0.044 / 2, rtol=1e-9)
    places = [half["position_mm"] for half in halves]
    assert_allclose(places, [-163.25, -115.75, -70.25, -22.75, 22.75, 70.25, 115.75, 163.25])
    bare = {key: value for key, value in WEB.items() if key not in ("outer_radius", "opening")}
    file.write_text(write_toml(FOUR) + "[[web]]\n" + write_toml({"": bare}).replace("[]\n", ""))
    step = ["--step", "counterweights at every throw"]
    whole = ask_weights(file, *step)
    halves = ask_weights(file, *step, "--planes=webs")
    assert [half["position_mm"] for half in halves] == pytest.approx(places)
    sizes = np.array(
        [[weight["unbalance_kg_m"] for weight in weights] for weights in (halves[::2], halves[1::2], whole)]
    )
    assert_allclose(sizes[:2], [sizes[2] / 2] * 2)


def test_planes_of_webs_need_webs():
    with pytest.raises(ArgumentError, match="webs: the file has no"):
        balance(load({**FOUR}), "auto", SchemeOptions(planes="webs"))


@pytest.mark.parametrize(
    ("places", "width", "told"),
    [
        ([-181, 0, 181], 15, None),
        ([-180.9, 0, 181], 15, "web 1 (z = -173.5 to -153 mm) overlaps the main bearing at -180.9 mm, 15 mm wide"),
        ([-181, 0, 180], 15, "web 8 (z = 153 to 173.5 mm) overlaps the main bearing at 180 mm, 15 mm wide"),
        ([-173.4, 0, 181], None, "overlaps the main bearing at -173.4 mm; check thickness, main_positions"),
        ([-174, 0, 181], None, None),
    ],
)
def test_webs_within_main_bearings_are_doubted(places, width, told):
    bearing = FOUR["bearing"] | {"main_positions": places}
    sizes = {"main_diameter": 60, "main_width": width} if width else {}
    doubts = [doubt for doubt in find_parts(WEB, bearing=bearing | sizes).doubts if "overlap" in doubt.message]
    assert [doubt.path for doubt in doubts] == ["web.1.thickness"] * (told is not None)
    assert all(told in doubt.message for doubt in doubts)


@pytest.mark.parametrize(("width", "doubted"), [(24.9, False), (25.1, True)])
def test_webs_leave_room_for_bearings_between_throws(width, doubted):
    """Bearings without positions are half-way between throws."""
    bearing = FOUR["bearing"] | {"main_diameter": 60, "main_width": width}
    told = "thicker webs of neighbouring throws overlap the main bearing between them"
    assert any(told in doubt.message for doubt in find_parts(WEB, bearing=bearing).doubts) is doubted


@pytest.mark.parametrize(("mass", "noted"), [(0.999, False), (1.001, True)])
def test_a_throw_with_unbalanced_rotating_mass_is_noted(mass, noted):
    """A counterweight for a throw of 1 kg and the big end of its rod, 0.62 (1 - 42/150) kg."""
    single = FOUR | {"crank": {"stroke": 88, "throws": [0], "throw_mass": mass}, "layout": {}}
    weight = {"unbalance": 1e3 * 44 * (1 + 0.62 * 108 / 150), "angle": 180, "position": 0}
    text = analyze(load(single | {"counterweight": [weight]}), only=["parts"]).text()
    assert ("A negative factor: not even all rotating mass is balanced." in " ".join(text.split())) is noted
