"""The unbalance with which a crankshaft comes to the balancing machine, and the holes against it."""

import json
import math

import pytest
from numpy.testing import assert_allclose
from support.commands import ask, ask_csv, ask_json, run_here
from support.engines import TWIN

from balcli import Tools, balance, load
from balcli.balancing.initial import find_initial
from balcli.errors import NotComputedError
from balcli.sizing.remedy import Remedy

SHAPE = "hub = 62\nboss = 54\nouter_radius = 74\nopening = 96\n"
TOLERANT = f'[[web]]\nthickness = 21\n{SHAPE}tolerance = {{ outer_radius = 0.3, density = "0.4%" }}\n'
EXACT = f"[[web]]\nwebs = [3]\nthickness = 18\n{SHAPE}"
PLACES = (-72.5, -23.5, 72.5)  # of the webs 1, 2 and 4; web 3 is exact
PLANES = (-60.0, 80.0)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("initial") / "twin.toml"
    path.write_text(TWIN + TOLERANT + EXACT)
    return path


def find_deviations():
    """Worst and rss of one web, kg m, from its masses: cheek by a polygon's formula, sector by hand."""
    thickness, hub, boss, throw, radius, opening = 0.021, 0.031, 0.027, 0.041, 0.074, math.radians(96)
    gamma = math.acos((hub - boss) / throw)
    # first moment of the hull: its segments at hub and boss, and four triangles between them
    boss_part = throw * gamma * boss**2 + 2 / 3 * boss**3 * math.sin(gamma)
    hub_part = -2 / 3 * hub**3 * math.sin(math.pi - gamma)
    normal = complex(math.cos(gamma), math.sin(gamma))
    start = hub * normal
    end = throw + boss * normal
    triangles = 0.0
    for second, third in ((throw + 0j, end), (end, start)):
        doubled = abs((second.conjugate() * third).imag)
        triangles += doubled * (second + third).real / 3
    cheek = boss_part + hub_part + triangles

    def unbalance(r, density):
        return density * thickness * (cheek - 2 / 3 * (r**3 - hub**3) * math.sin(opening / 2))

    nominal = unbalance(radius, 7850)
    corners = [unbalance(radius + a * 3e-4, 7850 * (1 + b * 0.004)) for a in (-1, 1) for b in (-1, 1)]
    worst = max(abs(corner - nominal) for corner in corners)
    by_radius = 7850 * thickness * 2 * radius**2 * math.sin(opening / 2) * 3e-4
    return worst, math.hypot(by_radius, 0.004 * nominal)


def share(place):
    """Shares of both planes by the lever rule, as sizes."""
    low, high = PLANES
    return abs((high - place) / (high - low)), abs((place - low) / (high - low))


def test_the_lever_rule_divides_deviations_between_the_planes(file):
    """A web beyond a plane has more than its own deviation there; an exact web has none."""
    worst, rss = find_deviations()
    planes = ask_json("balance", file, "--factor", "50%", "--planes=-60,80")["initial"]["planes"]
    assert [plane["position_mm"] for plane in planes] == list(PLANES)
    for k, plane in enumerate(planes):
        shares = [share(place)[k] for place in PLACES]
        assert_allclose(plane["worst_kg_m"], sum(shares) * worst, rtol=1e-9)
        assert_allclose(plane["rss_kg_m"], math.hypot(*shares) * rss, rtol=1e-9)
        assert set(plane) == {"position_mm", "worst_kg_m", "rss_kg_m"}


def test_without_planes_the_ends_are_the_throws(file):
    (first, last) = ask_json("balance", file, "--factor", "50%")["initial"]["planes"]
    assert (first["position_mm"], last["position_mm"]) == (-48, 48)
    assert ask_json("balance", file)["initial"]["planes"] == [first, last]


HOLE = 7850 * math.pi / 4 * 0.011**2 * 0.016 * (0.074 - 0.008)  # kg m


def plan(file, tools):
    return find_initial(load(file), Remedy("factor"), (-0.06, 0.08), tools)


@pytest.mark.parametrize(("width", "count"), [(43.9, 3), (44, 4), (48, 4)])
def test_as_many_holes_as_fit_side_by_side(file, width, count):
    tools = Tools(radius=0.074, drill=0.011, max_depth=0.016, width=width / 1e3)
    for plane in plan(file, tools).planes:
        assert_allclose(plane.capacity_kg_m, count * HOLE, rtol=1e-12)


@pytest.mark.parametrize(("more", "enough"), [(1.001, True), (0.999, False)])
def test_the_verdict_changes_where_capacity_meets_the_worst(file, more, enough):
    worst = plan(file, Tools()).planes[0].worst_kg_m
    drill = math.sqrt(worst * more / (7850 * math.pi / 4 * 0.074**2 / 2))  # one hole to the axis
    plane = plan(file, Tools(radius=0.074, drill=drill, width=1.5 * drill)).planes[0]
    assert_allclose(plane.capacity_kg_m, more * worst)
    assert plane.enough == enough


def test_holes_that_do_not_suffice_for_the_weights_are_counted(file):
    """The missing weights need more holes than there is room for; the result says what fits."""
    asked = ("--factor", "50%", "--planes=-60,80", "--drill", 11, "--max-depth", 16, "--radius", 74, "--width", 25)
    done = run_here("balance", file, *asked, "-f", "json")
    assert done.status == 2
    planes = json.loads(done.out)["initial"]["planes"]
    assert_allclose([plane["capacity_kg_m"] for plane in planes], 2 * HOLE, rtol=1e-12)


@pytest.mark.parametrize(("z", "width", "wide"), [(-0.06, 20.9, 0), (-0.06, 21.1, 21), (0.03, 20, 18)])
def test_holes_wider_than_the_web_are_noted(file, z, width, wide):
    """The web nearest to the plane counts: web 3, nearest to 30 mm, has 18 mm, the others have 21 mm."""
    asked = ("--factor", "50%", f"--planes={1e3 * z:g},80", "--drill", 11, "--max-depth", 9, "--radius", 74)
    text = " ".join(run_here("balance", file, *asked, "--width", width).out.split())
    capacity = f"in {width:g} mm along the crank"
    told = f", wider than the web there, which is {wide} mm thick" if wide else ""
    assert f"{capacity}{told}." in text


@pytest.mark.parametrize(("share", "warned"), [(0.99, True), (1.01, False)])
def test_a_mass_below_that_of_webs_and_pins_is_doubted(file, share, warned):
    mass = share * load(file).webs.mass
    done = run_here("balance", file, "--factor", "50%", "--grade", "G16", "--mass", f"{mass:.5f}")
    told = "kg of webs and crank pins; give the mass of the whole crankshaft"
    assert (told in done.err) is warned


def test_card_and_csv_have_what_a_machine_needs(file):
    asked = ("--factor", "50%", "--planes=-60,80", "--drill", 11, "--max-depth", 16, "--radius", 74, "--width", 25)
    grade = ("--grade", "G16", "--mass", "9 kg")
    card = run_here("balance", file, *asked, *grade, "-f", "card").out
    head, *lines = card.partition("Initial unbalance within the tolerances of the webs, g·mm\n")[2].splitlines()
    assert head.split()[-5:] == ["worst", "rss", "permitted", "capacity", "verdict"]
    permitted = 9e3 * 16 / (6800 * math.pi / 30) / 2
    for row, z in zip(lines[1:3], ("-60", "80"), strict=True):
        assert row.split()[0] == z
        assert float(row.split()[3]) == pytest.approx(permitted, rel=1e-3)
        assert row.endswith(("holes suffice", "holes do not suffice"))
    assert "counted as exact: web 3." in card
    assert "2 holes, 16 mm deep from a rim of 74 mm, in 25 mm" in " ".join(card.split())
    rows = ask_csv("balance", file, *asked[:3])
    assert len([row for row in rows if row["part"] == "initial"]) == 6


def test_exact_webs_have_no_initial_unbalance(tmp_path):
    (tmp_path / "e.toml").write_text(TWIN + EXACT.replace("webs = [3]\n", ""))
    assert "initial" not in ask_json("balance", tmp_path / "e.toml")
    assert "Initial" not in ask("balance", tmp_path / "e.toml")
    with pytest.raises(NotComputedError, match="tolerances of webs"):
        balance(load(tmp_path / "e.toml")).initial  # noqa: B018
