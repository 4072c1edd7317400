"""Cranks of [[engine]] that would strike each other are doubted; cranks that pass each other are not."""

import pytest
import tomli_w
from support.commands import run_here
from support.paths import ROOT, write

from balcli import load

TWO_THROWS = {
    "crank": {"stroke": 90, "throws": [0, 180], "positions": [-50, 50], "throw_mass": 1},
    "rod": {"length": 150, "mass": 0.6, "cg": 45, "inertia": 2500},
    "piston": {"mass": 0.5, "bore": 80},
    "operation": {"speed": 3000},
}
SHORT = {**TWO_THROWS, "crank": {**TWO_THROWS["crank"], "stroke": 70}}
UNPLACED = {**TWO_THROWS, "crank": {"stroke": 90, "throws": [0, 180], "throw_mass": 1}}
SINGLE = {**TWO_THROWS, "crank": {"stroke": 90, "throw_mass": 1}}
NO_BORE = {**SINGLE, "piston": {"mass": 0.5}}


@pytest.fixture
def gear(tmp_path):
    """A function of the places of engines and their files to the path of a file with [[engine]]."""

    def make(*places, files=(TWO_THROWS, TWO_THROWS, TWO_THROWS)):
        engines = []
        for number, (place, tables) in enumerate(zip(places, files, strict=False), 1):
            write(tmp_path / f"{number}.toml", tomli_w.dumps(tables))
            engines.append({"file": f"{number}.toml", "at": [*place]})
        return write(tmp_path / "geared.toml", tomli_w.dumps({"engine": engines}))

    return make


def list_clearances(file):
    return [doubt for doubt in load(file).unlikely if doubt.path.endswith(".at")]


@pytest.mark.parametrize(
    ("place", "doubted"),
    [
        ((0, 0, 0), True),
        ((79.9, 0, 0), True),  # radii of 45 and 35 mm
        ((80, 0, 0), False),
        ((0, 79.9, 0), True),
        ((0, 80.1, 0), False),
        ((60, 60, 0), False),  # 84.9 mm from axis to axis
        ((50, 60, 0), True),  # 78.1 mm
        ((0, 0, 123.9), True),  # throws end 12 mm (0.15 bores) beyond 50 mm
        ((0, 0, 124.1), False),
        ((0, 0, -123.9), True),
        ((0, 0, -124.1), False),
        ((79.9, 0, 123.9), True),
    ],
)
def test_cranks_closer_than_both_radii_are_doubted_where_their_throws_overlap(gear, place, doubted):
    file = gear((0, 0, 0), place, files=(TWO_THROWS, SHORT))
    assert bool(list_clearances(file)) is doubted


@pytest.mark.parametrize(
    ("tables", "z", "doubted"),
    [
        (UNPLACED, 0, True),  # throws without positions are all in one plane
        (SINGLE, 23.9, True),  # a throw is at least 0.3 bores wide
        (SINGLE, 24.1, False),
        (NO_BORE, 0, True),
        (NO_BORE, 0.1, False),
    ],
)
def test_throws_in_one_plane_overlap(gear, tables, z, doubted):
    file = gear((0, 0, 0), (0, 0, z), files=(tables, tables))
    assert bool(list_clearances(file)) is doubted


def test_the_doubt_names_both_cranks_and_the_distance_that_they_need(gear):
    (doubt,) = list_clearances(gear((0, 0, 0), (30, 40, 10), files=(TWO_THROWS, SHORT)))
    assert str(doubt) == (
        "engine.2.at: the crank axis is 50 mm from that of engine 1, where at least 80 mm (both crank radii) is usual "
        "for throws that overlap along the crank; give x, y, z of each engine"
    )
    assert doubt.concerns("engine.1.at.1")
    assert doubt.concerns("engine.2.crank.stroke")
    assert not doubt.concerns("engine.2.rod.length")


def test_each_crank_is_doubted_once(gear):
    doubts = list_clearances(gear((0, 0, 0), (0, 0, 0), (0, 0, 0)))
    assert [doubt.path for doubt in doubts] == ["engine.2.at", "engine.3.at"]
    apart = list_clearances(gear((0, 0, 0), (200, 0, 0), (200, 10, 0)))
    assert [doubt.path for doubt in apart] == ["engine.3.at"]
    assert "10 mm from that of engine 2" in str(apart[0])


def test_the_command_warns_and_a_sweep_of_the_place_does_not(gear):
    file = gear((0, 0, 0), (0, 0, 0))
    told = "engine.2.at: the crank axis is 0 mm from that of engine 1"
    assert told in run_here("analyze", file).err
    assert told in run_here("sweep", file, "--vary", "engine.1.piston.mass=0.4,0.5", "-q", "force.2.major").err
    for varied in ("engine.2.at.1=100,200", "engine.1.crank.stroke=80,90"):
        assert "crank axis" not in run_here("sweep", file, "--vary", varied, "-q", "force.2.major").err


@pytest.mark.parametrize("name", ["brm_h16", "napier_deltic"])
def test_geared_engines_of_makers_are_not_doubted(name):
    assert load(ROOT / "engines" / "geared" / f"{name}.toml").unlikely == ()
