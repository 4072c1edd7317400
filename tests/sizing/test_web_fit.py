"""Webs whose counterweights are fitted: what is wanted of them, the room they have, what helps where they do not fit,
and the files that are written.
"""

import json
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from support.commands import ask, run_here
from support.engines import build_text

from balcli import SchemeOptions, analyze, balance, fit_webs, load
from balcli.analysis.web_parts import describe_throws
from balcli.engine.build import build
from balcli.engine.parse import parse_dict
from balcli.errors import BalcliError
from balcli.sizing.fit import remove_to_fit
from balcli.sizing.web_fit import size_webs

TWO = {
    "crank": {"stroke": 76, "throws": [0, 180], "spacing": 96},
    "rod": {"length": 132, "mass": 0.48, "cg": 35},
    "piston": {"bore": 80, "mass": 0.41, "skirt": 26},
    "layout": {"firing_order": [1, 2], "firing_intervals": [180, 540]},
    "operation": {"speed": 6000},
    "frame": {"crankcase": 74},
    "bearing": {"pin_diameter": 40, "pin_length": 25, "main_diameter": 52, "main_width": 24},
}
THREE = {
    "crank": {"stroke": 76, "throws": [0, 120, 240], "spacing": 96},
    "layout": {"firing_order": [1, 2, 3], "firing_intervals": None},
}
WEB = {"thickness": 19, "hub": 60, "boss": 50, "outer_radius": 66, "opening": 150, "clearance": 1}
RADIUS = 0.038
ROTATING = 0.48 * (132 - 35) / 132  # of a rod
RECIPROCATING = 0.41 + 0.48 * 35 / 132
PIN = 7.85e-6 * math.pi / 4 * 40**2 * 25


def write_tables(*webs, **more):
    tables = {key: {**TWO.get(key, {}), **more.get(key, {})} for key in TWO | more if key != "counterweight"}
    if "counterweight" in more:
        tables["counterweight"] = more["counterweight"]
    return tables | {"web": list(webs)}


def fit(*webs, scheme="factor", options=None, **more):
    return fit_webs(write_tables(*webs, **more), scheme, options)


def solve(*webs, factor=0.5, **more):
    """The fitted webs alone, without analyses, which take longer."""
    model = parse_dict(write_tables(*webs, **more))
    return size_webs(build(remove_to_fit(model)), model, options=SchemeOptions(factor=(factor,)))


def list_figures(result):
    return [(web.thickness_m, web.outer_radius_m, web.opening_deg, web.angle_own_deg) for web in result.parts.webs]


def weigh_sector(thickness, radius, opening):
    """Unbalance of a counterweight in kg m, by integration over polar coordinates."""
    radii = np.linspace(0.030, radius, 4001)
    return 7850 * thickness * np.trapezoid(2 * radii**2 * math.sin(math.radians(opening) / 2), radii)


# ------------------------------------------------------------------ what is wanted, what solves it
@pytest.mark.parametrize(("key", "factor"), [("opening", 0.1), ("outer_radius", 0.0), ("thickness", 0.0)])
def test_each_dimension_makes_the_wanted_factor(key, factor):
    """Two points of each dimension: the unbalance of both webs of a throw balances the masses on its pin."""
    for share in (factor, factor + 0.07):
        result = fit(WEB | {key: "fit"}, options=SchemeOptions(factor=(share,)))
        assert result.webs_fit
        web = result.parts.webs[2]
        wanted = (ROTATING + share * RECIPROCATING + PIN) * RADIUS / 2
        assert_allclose([web.unbalance_kg_m, web.wanted_kg_m], wanted, rtol=1e-10)
        assert (web.unbalance_own_deg, web.wanted_own_deg) == (180, 180)
        assert_allclose([throw.factor for throw in result.parts.throws], share, atol=1e-10)
        (bare,) = {web.body.unbalance.real for web in result.before.engine.webs.webs}
        sector = weigh_sector(web.thickness_m, web.outer_radius_m, web.opening_deg)
        assert_allclose(sector - bare, wanted, rtol=1e-6)
        assert all(web.body.shape.sector is None for web in result.before.engine.webs.webs)


def test_counterweights_and_other_webs_of_the_throw_count():
    """A [[counterweight]] beside the pin turns the fitted counterweight; webs with figures keep them."""
    weight = {"unbalance": 3000, "angle": 90, "position": -40}  # nearest to throw 1
    webs = WEB | {"opening": "fit", "webs": [1, 3]}, WEB | {"opening": 60, "webs": [2, 4]}
    result = fit(*webs, options=SchemeOptions(factor=(-0.6,)), counterweight=[weight])
    assert result.webs_fit
    total = -(ROTATING - 0.6 * RECIPROCATING + PIN) * RADIUS
    given = result.after.engine.webs.webs[1].body.unbalance.real
    for web, across in ((0, -0.003j), (2, 0)):
        part = result.parts.webs[web]
        found = part.unbalance_kg_m * np.exp(1j * math.radians(part.unbalance_own_deg))
        assert_allclose(found, total - given + across, atol=1e-9 * abs(total))
    assert result.parts.webs[1].opening_deg == 60
    assert result.parts.webs[1].wanted_kg_m is None
    assert [web.table for web in result.parts.webs] == [1, 3, 2, 3]


@pytest.mark.parametrize("angle", [180, 150])
def test_a_given_angle_takes_the_component_along_it(angle):
    result = fit(WEB | {"opening": "fit", "angle": angle}, options=SchemeOptions(factor=(0.0,)))
    web = result.parts.webs[0]
    along = np.exp(-1j * math.radians(angle))
    needed = web.wanted_kg_m * np.exp(1j * math.radians(180)) - result.before.engine.webs.webs[0].body.unbalance
    assert_allclose(weigh_sector(0.019, 0.066, web.opening_deg), (needed * along).real, rtol=1e-6)
    assert web.angle_own_deg == angle


def test_weights_of_a_row_are_those_of_the_nearest_throw():
    """The two end weights of a three-cylinder crank are in the webs of throws 1 and 3, and cancel the whole moment that
    turns with the crank; shafts of the row stay devices.
    """
    webs = WEB | {"opening": "fit", "outer_radius": 70, "clearance": 0}
    result = fit(webs, scheme="step", options=SchemeOptions(step="1"), **THREE)
    moments = [abs(state.spectra["moment"].forward[0]) for state in (result.before, result.after)]
    assert moments[0] > 100
    assert moments[1] < 1e-6 * moments[0]
    assert [web.opening_deg is None for web in result.parts.webs] == [False, False, True, True, False, False]
    assert not result.remedy.devices
    more = fit(webs, scheme="step", options=SchemeOptions(step="1+3"), **THREE)
    assert list_figures(more) == list_figures(result)
    assert [shaft.ratio for shaft in more.remedy.shafts] == [-1, -1]
    assert more.remedy.reasons
    assert len(more.remedy.every_reason) == 1 + len(more.remedy.reasons)


def test_smallest_weights_in_the_planes_of_the_webs():
    """By the pseudo-inverse of forces and moments in the planes of all webs."""
    three = fit(WEB | {"opening": "fit", "hub": 90, "outer_radius": 74}, scheme="counterweights", **THREE)
    webs = three.before.engine.webs.webs
    places = np.array([web.z for web in webs])
    pins = np.exp(1j * np.radians([web.pin_deg for web in webs]))
    turning = analyze(three.before.engine, orders=[1]).spectra
    square = three.before.engine.omega**2
    wanted = [turning["force"].forward[0] / square, turning["moment"].forward[0] / 1j / square]
    added = np.linalg.pinv(np.array([np.ones(6), places])) @ -np.array(wanted)
    for web, part, own in zip(webs, three.parts.webs, added, strict=True):
        vector = web.body.unbalance + own * np.conj(pins[web.number - 1])
        found = part.wanted_kg_m * np.exp(1j * math.radians(part.wanted_own_deg))
        assert_allclose(found, vector, atol=1e-9)
    assert three.webs_fit
    assert abs(three.after.spectra["moment"].forward[0]) < 1e-6 * abs(turning["moment"].forward[0])


def test_thickness_and_planes_agree():
    """A thickness moves the plane of its web and the weights of the smallest sum: the written crank is balanced."""
    fitted = WEB | {"thickness": "fit", "outer_radius": 70, "opening": 160, "webs": [1, 2, 5, 6]}
    bare = {key: WEB[key] for key in ("thickness", "hub", "boss")} | {"webs": [3, 4]}
    three = fit(fitted | {"angle": 195}, bare, scheme="counterweights", crank=THREE["crank"], layout=THREE["layout"])
    assert {web.table for web in three.parts.webs} > {1, 2}
    for web, own in zip(three.parts.webs, three.after.engine.webs.webs, strict=True):
        assert_allclose(abs(own.z - (-0.096, 0, 0.096)[web.throw - 1]), (0.025 + web.thickness_m) / 2)
        if web.wanted_kg_m is not None:
            along = np.exp(-1j * math.radians(195))
            wanted = web.wanted_kg_m * np.exp(1j * math.radians(web.wanted_own_deg))
            assert_allclose((own.body.unbalance * along).real, (wanted * along).real, rtol=1e-9)


def test_a_balanced_web_needs_no_counterweight():
    weight = {"angle": 180, "position": -48}
    bare = fit(WEB | {"opening": "fit"}).before.engine.webs.webs[0].body.unbalance.real
    needed = (ROTATING + RECIPROCATING / 2 + PIN) * RADIUS + 2 * bare
    weights = [weight | {"unbalance": 1e6 * needed}, weight | {"unbalance": 1e6 * needed, "position": 48, "angle": 0}]
    result = fit(WEB | {"opening": "fit"}, counterweight=weights)
    assert result.webs_fit
    assert {web.opening_deg for web in result.parts.webs} == {None}
    weights[0]["unbalance"] *= 1.1
    with pytest.raises(BalcliError, match=r"web\.1\.opening: without a counterweight the web has .* more at 180 deg"):
        fit(WEB | {"opening": "fit", "angle": 180}, counterweight=weights)


# ------------------------------------------------------------------ room
SIZES = {
    "outer_radius": lambda body: 1e3 * body.shape.sector.radius,
    "thickness": lambda body: 1e3 * body.thickness,
}


@pytest.mark.parametrize(
    ("key", "limit"),
    [
        ("outer_radius", lambda size: {"frame": {"crankcase": size + 1}}),  # clearance = 1
        ("outer_radius", lambda size: {"piston": {"skirt": 132 - 38 - 1 - size}}),
        ("thickness", lambda size: {"bearing": {"main_diameter": 52, "main_width": 96 - 25 - 2 * size}}),
    ],
)
def test_room_ends_where_the_file_says(key, limit):
    free = {"frame": {"crankcase": None}, "piston": {"skirt": None}}
    free["bearing"] = {"main_diameter": None, "main_width": None}
    fitted = solve(WEB | {key: "fit"}, factor=0.3, **free)
    size = SIZES[key](fitted.after.webs.webs[0].body)
    for change, fits in ((1e-6, True), (-1e-2, False)):
        limits = {name: free[name] | table for name, table in limit(size + change).items()}
        found = solve(WEB | {key: "fit"}, factor=0.3, **free | limits)
        assert [web.missing is None for web in found.remedy.webs] == [fits] * 4
        assert_allclose(SIZES[key](found.after.webs.webs[0].body), size + min(change, 0), rtol=1e-9)


@pytest.mark.parametrize(
    ("hub", "boss", "most"), [(60, 50, 180), (60, 100, 2 * (180 - math.degrees(math.acos(-20 / 38))))]
)
def test_room_of_the_opening_ends_at_the_cheek(hub, boss, most):
    """At most 180 deg, and at most to where the tangents of the cheek leave the hub."""
    found = solve(WEB | {"opening": "fit", "hub": hub, "boss": boss, "outer_radius": 40})
    assert_allclose([web.body.shape.sector.opening for web in found.after.webs.webs], most)
    web = found.remedy.webs[0]
    assert_allclose(web.room, weigh_sector(0.019, 0.040, most), rtol=1e-6)
    assert_allclose(web.room + web.missing, found.before.webs.webs[0].body.unbalance.real - web.wanted.real)


def test_no_room_at_all():
    """Weights that outweigh the throw want the web's own weight on the side of the pin, where the cheek is."""
    weights = [{"unbalance": 90000, "angle": 180, "position": -48}, {"unbalance": 90000, "position": 48}]
    found = solve(WEB | {"opening": "fit"}, counterweight=weights)
    web = found.remedy.webs[0]
    assert found.after.webs.webs[0].body.shape.sector is None
    assert web.room == 0
    assert [cure.enough for cure in web.cures][2:] == [False, False]
    assert web.cures[3].diameter_m is None


# ------------------------------------------------------------------ what helps
SHORT = WEB | {"opening": "fit", "outer_radius": 58}


# A slug of 29 mm reaches both edges of a counterweight of 20 degrees.
NARROW = {"web": {"outer_radius": "fit", "opening": 20}, "rod": {"length": 190}, "piston": {"skirt": 1}}


def find_cures(web=SHORT, **more):
    cures = solve(web, **more).remedy.webs[0].cures
    assert [cure.remedy for cure in cures] == ["pin bore", "lightening", "outer radius", "heavy metal"]
    return cures


def find_factor(web, **more):
    (throw, _) = describe_throws(load(write_tables(web, **more)))
    return throw.factor


def test_each_remedy_alone_makes_what_is_missing():
    """Each is applied to the file by itself; 50 % are then balanced."""
    bore, light, radius, slug = find_cures()
    full = SHORT | {"opening": 180}
    assert find_factor(full) < 0.45
    hole = {"x": 38, "diameter": 1e3 * bore.diameter_m}
    assert find_factor(full | {"holes": [hole]}, bearing={"pin_bore": hole["diameter"]}) == pytest.approx(0.5)
    taken = {"x": 38, "diameter": 2e3 * math.sqrt(light.mass_kg / (7850 * 0.019 * math.pi))}
    assert find_factor(full | {"holes": [taken]}) == pytest.approx(0.5)
    assert find_factor(full | {"outer_radius": 1e3 * radius.radius_m}) == pytest.approx(0.5)
    metal = {"x": -(58 - 3 - 5e2 * slug.diameter_m), "diameter": 1e3 * slug.diameter_m, "density": 17}
    assert find_factor(full | {"holes": [metal]}) == pytest.approx(0.5)
    assert slug.mass_kg == pytest.approx(17e3 * 0.019 * math.pi / 4 * slug.diameter_m**2)


@pytest.mark.parametrize("key", ["opening", "outer_radius", "thickness"])
@pytest.mark.parametrize("density", [0, 17])
def test_holes_in_a_fitted_counterweight_count(key, density):
    """Behind the cheek, where no web is before the counterweight is fitted."""
    holes = [{"x": -50, "y": 5, "diameter": 16, "density": density}, {"x": 38, "diameter": 20}]
    result = solve(WEB | {key: "fit", "holes": holes, "angle": 180}, factor=0.1)
    assert {web.missing for web in result.remedy.webs} == {None}
    fitted = result.after.webs.webs[0].body
    assert len(fitted.shape.holes) == 2
    assert [hole.x for hole in result.before.webs.webs[0].body.shape.holes] == [0.038]
    wanted = (ROTATING + 0.1 * RECIPROCATING + PIN) * RADIUS / 2
    assert fitted.unbalance.real == pytest.approx(-wanted, rel=1e-9)


def test_holes_that_the_fitted_counterweight_does_not_hold():
    aside = {"x": -20, "y": 50, "diameter": 10}
    told = r"web\.1\.holes: the hole at x = -20, y = 50, diameter = 10 mm is not within the web with opening = [\d.]+ deg; "
    with pytest.raises(BalcliError, match=told):
        solve(WEB | {"opening": "fit", "holes": [aside]}, factor=-0.2)
    slug = {"x": -50, "diameter": 20, "density": 17}
    bare = solve(WEB | {"opening": "fit"}).before.webs.webs[0].body.unbalance.real
    alone = bare - (17 - 7.85) * 1e3 * 0.019 * math.pi * 0.010**2 * 0.050
    factor = (-2 * alone / RADIUS - ROTATING - PIN) / RECIPROCATING
    with pytest.raises(BalcliError, match="mm is not within the web, which needs no counterweight; move"):
        solve(WEB | {"opening": "fit", "angle": 180, "holes": [slug]}, factor=factor)


def test_a_bore_that_is_there_counts():
    wider = find_cures(bearing={"pin_bore": 12})[0].diameter_m
    missing = solve(SHORT, bearing={"pin_bore": 12}).remedy.webs[0].missing
    ring = 7850 * math.pi / 4 * (wider**2 - 0.012**2) * (0.0125 + 0.019) * RADIUS
    assert ring == pytest.approx(missing)


@pytest.mark.parametrize(
    ("row", "more", "enough"),
    [
        (0, {"web": {"outer_radius": 64.9}}, True),
        (0, {"web": {"outer_radius": 63}}, False),
        (2, {"frame": {"crankcase": 68}}, True),
        (2, {"frame": {"crankcase": 66}}, False),
        (2, {"frame": {"crankcase": None}, "piston": {"skirt": None}}, None),
        (3, {"web": {"outer_radius": 64}}, True),
        (3, {"web": {"outer_radius": 58}}, False),
        (3, NARROW | {"frame": {"crankcase": 103}}, True),
        (3, NARROW | {"frame": {"crankcase": 102}}, False),
    ],
)
def test_enough(row, more, enough):
    own = dict(more)
    web = SHORT | own.pop("web", {})
    assert find_cures(web, **own)[row].enough is enough


# ------------------------------------------------------------------ files
TEXT = """
[crank]
stroke = 76
throws = [0, 120, 240]
spacing = 96
[rod]
length = 132
mass = 0.48
cg = 35
[piston]
bore = 80
mass = 0.41
skirt = 22
[layout]
firing_order = [1, 2, 3]
[operation]
speed = 6000
[bearing]
pin_diameter = 40
pin_length = 25
# webs of the ends
[[web]]
webs = [1, 2, 5, 6]
thickness = "19 mm"   # as forged
hub = 60
boss = 50
outer_radius = 70
opening = "fit"   # to be found
[[web.holes]]
x = 38
diameter = 12
# webs of the middle
[[web]]
thickness = 19
hub = 60
boss = 50
"""


def write_fitted(folder, text, *options):
    (folder / "e.toml").write_bytes(text.encode())
    answer = json.loads(ask("balance", folder / "e.toml", *options, "-f", "json", "--write", folder / "out.toml"))
    return answer["parts"]["webs"], (folder / "out.toml").read_bytes().decode()


FITTED = ("wanted_kg_m", "wanted_own_deg")


@pytest.mark.parametrize(
    ("options", "line_end"),
    [(("--factor", "0"), "\n"), (("--step", "1"), "\r\n"), (("--scheme", "counterweights"), "\n")],
)
def test_written_file_has_the_same_webs(tmp_path, options, line_end):
    webs, text = write_fitted(tmp_path, TEXT.replace("\n", line_end), *options)
    assert '"fit"' not in text
    assert text.count('thickness = "19 mm"   # as forged') == len({web["table"] for web in webs}) - 1
    assert "# to be found (fitted by balcli)" in text
    assert "# webs of the middle" in text
    assert text.count("\n") == text.count(line_end)
    again = json.loads(ask("analyze", tmp_path / "out.toml", "--only", "parts", "-f", "json"))["parts"]["webs"]
    assert again == [{key: figure for key, figure in web.items() if key not in FITTED} for web in webs]


def test_unequal_webs_have_tables_of_their_own(tmp_path):
    """Mirror images of each other: the table of four webs becomes two, before the table that followed it."""
    webs, text = write_fitted(tmp_path, TEXT, "--step", "1")
    assert [web["table"] for web in webs] == [1, 1, 3, 3, 2, 2]
    tables = [table.webs for table in build_text(text).model.web]
    assert tables == [(1, 2), (5, 6), None]
    angles = [table.angle for table in build_text(text).model.web]
    assert angles[0] == pytest.approx(360 - angles[1])
    assert [len(table.holes) for table in build_text(text).model.web] == [1, 1, 0]


def test_tables_after_a_divided_one_keep_their_figures(tmp_path):
    middle = 'boss = 50\nouter_radius = "fit"\nopening = 120\n'
    text = TEXT.replace("outer_radius = 70", "outer_radius = 80").removesuffix("boss = 50\n") + middle
    weights = "".join(f"[[counterweight]]\nunbalance = {u}\nposition = {z}\n" for u, z in ((900, -96), (400, 96)))
    (tmp_path / "e.toml").write_text(text + weights)
    run_here("balance", tmp_path / "e.toml", "--factor", "-0.5", "--write", tmp_path / "out.toml")
    written = build_text((tmp_path / "out.toml").read_text()).model.web
    assert [table.webs for table in written] == [(1, 2), (5, 6), None]
    assert [table.outer_radius == 80 for table in written] == [True, True, False]
    assert written[2].opening == 120


def test_nothing_is_missing_of_a_fit():
    """The opening has 12 digits; what this leaves is no weight."""
    options = SchemeOptions(factor=(0.1,))
    fitted = fit(WEB | {"opening": "fit"}, options=options).after.engine
    assert {need.missing for need in balance(fitted, "factor", options).remedy.needs} == {0}


def test_an_inline_list_is_written_anew(tmp_path):
    web = '{ thickness = 19, hub = 60, boss = 50, outer_radius = 70, opening = "fit" }'
    text = f"web = [{web}]\n{TEXT[: TEXT.index('# webs of the ends')]}"
    webs, new = write_fitted(tmp_path, text, "--step", "1")
    assert new.startswith("# Comments and layout of the original could not be kept")
    openings = [table.opening for table in build_text(new).model.web if table.opening]
    assert len(openings) == 2
    assert {web["opening_deg"] for web in webs if "opening_deg" in web} == {*openings}


def test_speed_of_the_command_counts(tmp_path):
    """A fit does not depend on the speed, loads do."""
    (tmp_path / "e.toml").write_text(TEXT)
    slow, fast = (
        json.loads(ask("balance", tmp_path / "e.toml", "--factor", "0", "--speed", speed, "-f", "json"))
        for speed in ("3000", "6000")
    )
    assert slow["parts"] == fast["parts"]
    assert fast["after"]["peak"]["force_N"] == pytest.approx(4 * slow["after"]["peak"]["force_N"])


# ------------------------------------------------------------------ words and refusals
def test_what_does_not_fit_is_shown_and_nothing_is_written(tmp_path):
    (tmp_path / "e.toml").write_text(TEXT.replace("outer_radius = 70", "outer_radius = 45"))
    out = tmp_path / "out.toml"
    done = run_here("balance", tmp_path / "e.toml", "--write", out)
    assert done.status == 2
    assert not out.exists()
    assert "What would help" in done.out
    assert "Room and missing: of its counterweight." in done.out
    assert "do not fit in an opening of 180 deg and a radius of 45 mm; what helps:" in done.err
    assert "e.toml: webs 1-2,5-6: " in done.err
    for name in ("pin bore", "lightening", "outer radius", "heavy metal"):
        assert f"\n  {name}" in done.err


def test_text_of_a_fit(tmp_path):
    (tmp_path / "e.toml").write_text(TEXT)
    text = ask("balance", tmp_path / "e.toml", "--factor", "0")
    assert "Counterweights of the webs: all rotating mass and 0 of the reciprocating mass" in " ".join(text.split())
    assert "What would help" not in text
    assert "Room and missing" not in text
    assert "of the file raise" not in text
    turned = TEXT.replace("# to be found", "\nangle = 170")
    (tmp_path / "e.toml").write_text(turned)
    assert "Across: what the given angle" in ask("balance", tmp_path / "e.toml", "--factor", "0")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (
            ("--scheme", "two-shaft"),
            'web.1.opening is "fit", which --scheme two-shaft does not take; choose one of factor',
        ),
        (("--scheme", "all"), 'is "fit", which --scheme all does not take'),
        (("--scheme", "fit"), 'is "fit", which --scheme fit does not take'),
        (("--target", "force"), "--target have nothing to fit"),
        (("--scheme", "counterweights", "--planes", "ends"), '--planes: web.1.opening is "fit"'),
        (("--measured", "800 g"), '--measured: web.1.opening is "fit"'),
        (("--factor", "40%,50%"), '--factor: web.1.opening is "fit"; give one factor'),
        (("--step", "2"), "the row has a counterweight at throw 2, and no web of this throw"),
        (("--step", "3+4"), "the row fits no counterweights"),
    ],
)
def test_refusals(tmp_path, options, told):
    (tmp_path / "e.toml").write_text(TEXT)
    done = run_here("balance", tmp_path / "e.toml", *options)
    assert done.status == 2
    assert told in " ".join(done.err.split())


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("outer_radius = 70", 'outer_radius = "fit"'), 'web.1: opening and outer_radius are "fit"'),
        (("outer_radius = 70\n", ""), "web.1.opening: is given without outer_radius"),
        (('thickness = "19 mm"', 'thickness = "fit"'), 'web.1: opening and thickness are "fit"'),
        (("# webs of the ends", "[[counterweight]]\nunbalance = 'fit'"), "counterweight.1.unbalance are"),
    ],
)
def test_contradictions_of_files_to_fit(tmp_path, change, told):
    assert TEXT.replace(*change) != TEXT
    (tmp_path / "e.toml").write_text(TEXT.replace(*change))
    done = run_here("balance", tmp_path / "e.toml")
    assert done.status == 2
    assert told in done.err


def test_no_thickness_helps_a_small_counterweight():
    with pytest.raises(BalcliError, match=r"web\.1\.thickness: the web has -\d+.* at 180 deg for each mm of thickness"):
        fit(WEB | {"thickness": "fit", "opening": 20})


def test_other_commands_say_what_to_run(tmp_path):
    (tmp_path / "e.toml").write_text(TEXT)
    for command in ("analyze", "torque"):
        done = run_here(command, tmp_path / "e.toml")
        assert done.status == 2
        assert 'web.1.opening is "fit": run balcli balance FILE --write OUT' in done.err


def test_files_without_fit_are_for_balance():
    with pytest.raises(BalcliError, match=r"no \[\[web\]\] has a dimension that is"):
        fit(WEB)
