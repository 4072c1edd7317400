"""Webs as DXF files for CAD, and as pictures for a review."""

import math
import re

import ezdxf
import pytest
from numpy.testing import assert_allclose
from shapely.geometry import Polygon
from support.commands import ask, run_here
from support.engines import TWIN

from balcli import analyze, load, plot
from balcli.errors import ArgumentError

SKEW = "hub = 62\nboss = 54\nouter_radius = 74\nopening = 96\nangle = 187\n"
HOLES = "holes = [{ x = 41, diameter = 15 }, { x = -58, y = 12, diameter = 16, density = 17 }]\n"
WEB = f"[[web]]\nthickness = 21\n{SKEW}{HOLES}clearance = 1\n"
WEIGHED = "[[web]]\nwebs = [2, 3]\nthickness = 18\nmass = 1.4\ncg = [-9, 0.2]\n"


def trace(edge):
    """Points along an edge of an outline that runs anticlockwise."""
    return edge.flattening(1e-6) if edge.dxftype() == "ARC" else [edge.dxf.start]


def test_the_outline_has_the_moments_that_are_printed(tmp_path):
    """A CAD program that reads the file finds the mass, the unbalance and the inertia of the parts
    table: here from polygons of many points by shapely.
    """
    (tmp_path / "e.toml").write_text(TWIN + WEB)
    ask("plot", str(tmp_path / "e.toml"), str(tmp_path / "web.dxf"), "--what", "webs")
    drawing = ezdxf.readfile(tmp_path / "web.dxf")
    assert drawing.dxfversion == "AC1009"
    assert not drawing.audit().errors
    (outline,) = drawing.query("POLYLINE[layer=='WEB']")
    assert outline.is_closed
    shape = Polygon([(point.x, point.y) for edge in outline.virtual_entities() for point in trace(edge)])
    circles = {circle.dxf.layer: circle.dxf for circle in drawing.query("CIRCLE")}
    assert set(circles) == {"HOLE", "SLUG"}
    mass = 7.85e-6 * 21 * shape.area
    first = mass * complex(shape.centroid.x, shape.centroid.y)
    for layer, density in (("HOLE", -7.85), ("SLUG", 17 - 7.85)):
        of_hole = density * 1e-6 * 21 * math.pi * circles[layer].radius ** 2
        mass += of_hole
        first += of_hole * complex(circles[layer].center.x, circles[layer].center.y)
    web = analyze(load(tmp_path / "e.toml"), only=["parts"]).parts.webs[0]
    assert_allclose(web.mass_kg, mass, rtol=1e-6)
    assert_allclose(1e3 * web.mass_kg * complex(*web.cg_m), first, rtol=1e-6)


def test_a_written_outline_read_as_profile_is_the_same_web(tmp_path):
    """A circle of the drawing that `holes` gives as well counts once, with its slug."""
    (tmp_path / "e.toml").write_text(TWIN + WEB)
    ask("plot", str(tmp_path / "e.toml"), str(tmp_path / "web.dxf"), "--what", "webs")
    slug = HOLES.replace("{ x = 41, diameter = 15 }, ", "")
    (tmp_path / "p.toml").write_text(TWIN + f'[[web]]\nthickness = 21\nprofile = "web.dxf"\n{slug}')
    drawn, read = (analyze(load(tmp_path / name), only=["parts"]).parts.webs[2] for name in ("e.toml", "p.toml"))
    for key in ("mass_kg", "cg_m", "inertia_kg_m2", "swing_radius_m", "clearance_m", "clearance_deg"):
        assert_allclose(getattr(read, key), getattr(drawn, key), rtol=1e-9, atol=1e-9)


def test_several_kinds_of_webs_have_several_files(tmp_path):
    bare = "[[web]]\nwebs = [2, 3]\nthickness = 18\nhub = 60\nboss = 50\n"
    (tmp_path / "e.toml").write_text(TWIN + WEB + bare)
    done = run_here("plot", tmp_path / "e.toml", tmp_path / "web.dxf", "--what", "webs")
    assert "web-1.dxf" in done.err
    assert sorted(file.name for file in tmp_path.glob("*.dxf")) == ["web-1.dxf", "web-2.dxf"]
    bulges = [vertex.dxf.bulge for vertex in ezdxf.readfile(tmp_path / "web-2.dxf").query("POLYLINE")[0].vertices]
    assert sorted(math.degrees(4 * math.atan(bulge)) for bulge in bulges)[:2] == [0, 0]
    assert_allclose(sum(math.degrees(4 * math.atan(bulge)) for bulge in bulges), 360)


@pytest.mark.parametrize(
    ("tables", "options", "told"),
    [
        (WEB, ["web.dxf"], "web.dxf: a .dxf file has the outlines of webs alone; give --what webs"),
        (WEB, ["web.dxf", "--what", "webs,polar"], "the outlines of webs alone"),
        (WEB, ["web.dxf", "--what", "webs", "--factor", "50%"], "leave --scheme and its options out"),
        (WEB, ["web.svg", "--what", "webs", "--factor", "50%"], "leave --scheme and its options out"),
        ("", ["web.dxf", "--what", "webs"], r"e.toml: has no \[\[web\]\]"),
        ("", ["web.svg", "--what", "webs"], r"--what webs: the file has no \[\[web\]\]"),
        (
            WEIGHED.replace("[2, 3]", "[1, 2, 3, 4]"),
            ["web.dxf", "--what", "webs"],
            "for web.1, given by mass; give hub",
        ),
        ('[[web]]\nthickness = 9\nprofile = "web.dxf"\n', ["web.dxf", "--what", "webs"], "web.dxf: this file is read"),
    ],
)
def test_what_cannot_be_drawn_is_named(tmp_path, monkeypatch, tables, options, told):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "e.toml").write_text(TWIN + tables)
    if "profile" in tables:
        (tmp_path / "web.dxf").write_text("0\nEOF\n")
    done = run_here("plot", "e.toml", *options)
    assert done.status == 2
    assert re.search(told, done.err)


def test_the_picture_shows_the_nearest_piston_at_its_crank_angle(tmp_path):
    (tmp_path / "e.toml").write_text(TWIN + WEB + WEIGHED)
    figure = plot(load(tmp_path / "e.toml"), "webs")
    (axes,) = figure.axes  # web.2 has no outline
    assert "web.2" in figure.get_supxlabel()
    web = analyze(load(tmp_path / "e.toml"), only=["parts"]).parts.webs[0]
    lines = {line.get_label(): line for line in axes.lines}
    (edge,) = (line for label, line in lines.items() if label.startswith("piston"))
    assert edge.get_label() == f"piston {web.clearance_cylinder} at {web.clearance_deg:.4g}°"
    psi = math.radians(web.clearance_deg)
    height = 41 * math.cos(psi) + math.sqrt(142**2 - (41 * math.sin(psi)) ** 2) - 24
    assert_allclose(edge.get_ydata(), height)
    half = math.sqrt(42**2 - (28 / 2) ** 2)  # the nearer face is half the pin's length away
    assert_allclose(edge.get_xdata(), [-half, half])
    (outline, *_) = axes.patches
    assert_allclose(max(math.hypot(*place) for place in outline.get_xy()), 74)
    top = max(y for x, y in outline.get_xy() if abs(x) <= half)
    assert_allclose(height - top, 1e3 * web.clearance_m, atol=5e-3)
    assert f"gap {1e3 * web.clearance_m:.4g} mm" in [text.get_text() for text in axes.texts]


@pytest.mark.parametrize("name", ["web.dxf", "web.svg"])
def test_a_web_that_strikes_a_piston_is_not_drawn_in_silence(tmp_path, name):
    (tmp_path / "e.toml").write_text(TWIN.replace("skirt = 24", "skirt = 28") + WEB)
    done = run_here("plot", tmp_path / "e.toml", tmp_path / name, "--what", "webs")
    assert done.status == 0
    assert "web 1 has a clearance of -1 mm to the piston of cylinder 1" in done.err


def test_the_drawing_of_one_of_several_tables_has_its_number(tmp_path):
    (tmp_path / "e.toml").write_text(TWIN + WEB + WEIGHED)
    done = run_here("plot", tmp_path / "e.toml", tmp_path / "web.dxf", "--what", "webs")
    assert "no outline is known for web.2, given by mass" in done.err
    assert [file.name for file in tmp_path.glob("*.dxf")] == ["web-1.dxf"]


def test_without_a_skirt_the_crank_pin_is_upwards(tmp_path):
    (tmp_path / "e.toml").write_text(TWIN.replace("skirt = 24\n", "") + WEB)
    figure = plot(load(tmp_path / "e.toml"), "webs")
    assert "give piston.bore and piston.skirt" in figure.get_supxlabel()
    (axes,) = figure.axes
    assert not any(line.get_label().startswith("piston") for line in axes.lines)
    outline = axes.patches[0].get_xy()
    assert_allclose(max(y for _, y in outline), 41 + 27, rtol=1e-4)  # boss, drawn in steps of a degree
    assert not any("gap" in text.get_text() for text in axes.texts)


def test_a_picture_needs_webs():
    with pytest.raises(ArgumentError, match=r"webs: the file has no \[\[web\]\]"):
        plot(
            load(
                {"crank": {"stroke": 80}, "rod": {"length": 140}, "piston": {"mass": 0.5}, "operation": {"speed": 3000}}
            ),
            "webs",
        )
