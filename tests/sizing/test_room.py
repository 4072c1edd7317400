"""The room around the crank, and half discs of steel for new counterweights and shafts."""

import math

import pytest
from support.commands import ask, run_here
from support.engines import GNOME, build_text
from support.paths import write

from balcli import SchemeOptions, balance
from balcli.sizing.ladder import find_ladder
from balcli.sizing.planes import find_unbalance
from balcli.sizing.room import HalfDisc, find_rooms
from balcli.sizing.workshop import Tools

THREE = """\
[crank]
stroke = 77.4
throws = [0, 240, 120]
spacing = 82
throw_mass = 0.55
[rod]
length = 130
mass = 0.39
cg = 36
inertia = 1200
[piston]
bore = 74
mass = 0.32
skirt = 24
[layout]
firing_order = [1, 3, 2]
[operation]
speed = 6000
"""
LOWEST = 130 - 38.7  # mm, of a piston pin
BARE = THREE.replace("skirt = 24\n", "")


def add(text, keys):
    """Return the file with keys in [frame]."""
    return f"{text}[frame]\n{keys}\n"


def test_steel_of_every_step_and_the_discs_of_one():
    """Figures of a calculation by hand: room 130 - 38.7 - 24 = 67.3 mm, `3 pi U/(4 R)` for weights, and
    `pi density R^3` with `R = (3U/(4 density))^(1/4)` for shafts.
    """
    engine = build_text(THREE)
    ladder = find_ladder(engine)
    steel = [step.steel_kg for step in ladder.steps]
    assert steel == pytest.approx(
        [0, 2.4547052348315974, 4.25167418433362, 5.426395252258969, 5.766954225531274], rel=1e-12
    )
    weight, *_, shaft = balance(engine, "step", SchemeOptions(step="shaft at -1")).practical
    assert (weight.disc_radius_mm, weight.disc_thickness_mm) == pytest.approx((67.3, 25.375760059688602))
    assert (shaft.disc_radius_mm, shaft.disc_thickness_mm) == pytest.approx((28.77144963680557, 57.54289927361114))
    assert (weight.disc_mass_kg, shaft.disc_mass_kg) == pytest.approx((1.4172247281112065, 0.5873605339626746))


@pytest.mark.parametrize(
    "disc", [HalfDisc.of_radius(0.04, 0.06), HalfDisc.of_thickness(0.04, 0.02), HalfDisc.as_long_as_wide(0.007)]
)
def test_a_half_disc_summed_up_in_rings_has_its_mass_and_unbalance(disc):
    """Thin half rings: mass `pi r dr`, centroid 2r/pi."""
    width = disc.radius / 4000
    radii = [(k + 0.5) * width for k in range(4000)]
    weight = 7850 * disc.thickness * width
    assert disc.mass == pytest.approx(sum(math.pi * r * weight for r in radii), rel=1e-6)
    unbalance = sum(2 * r * r * weight for r in radii)
    wanted = 0.007 if disc.thickness == 2 * disc.radius else 0.04
    assert unbalance == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "radius", "assumed"),
    [
        *((THREE, LOWEST - 24, None), (BARE, 0.7 * LOWEST, 0.3 * LOWEST)),
        *((add(THREE, "crankcase = 60"), 60, None), (add(THREE, "crankcase = 68"), LOWEST - 24, None)),
        *((add(BARE, "crankcase = 63.9"), 63.9, None), (add(BARE, "crankcase = 64"), 0.7 * LOWEST, 0.3 * LOWEST)),
    ],
)
def test_the_smaller_of_crankcase_and_pistons_limits(text, radius, assumed):
    """Without a skirt, the room is 0.7 of the distance of the piston pins, unless the crankcase is smaller."""
    engine = build_text(text)
    room = find_rooms(engine)[None]
    assert 1e3 * room.radius_m == pytest.approx(radius)
    assert 1e3 * room.thickness_m == pytest.approx(41)
    values = {one.path: one.value for one in balance(engine).assumed or ()}
    assert values.get("piston.skirt") == (None if assumed is None else pytest.approx(assumed))


def test_nothing_is_assumed_without_new_counterweights(tmp_path):
    told = ask("analyze", write(tmp_path / "three.toml", BARE), "--only", "force")
    assert "skirt" not in told
    told = ask("analyze", write(tmp_path / "three.toml", BARE), "--only", "ladder")
    assert "piston.skirt = 27.39 mm" in told


def test_cylinders_that_turn_and_pistons_in_harmonic_motion_leave_the_room_unknown():
    assert find_rooms(build_text(GNOME.format(offset=0, layout="radial = 7")))[None].radius_m is None
    rod = "length = 130\nmass = 0.39\ncg = 36\ninertia = 1200"
    harmonic = THREE.replace(rod, "motion = 'harmonic'\nsmall_end = 0.1\nbig_end = 0.29")
    assert find_rooms(build_text(harmonic))[None].radius_m is None
    assert find_rooms(build_text(add(harmonic, "crankcase = 90")))[None].radius_m == pytest.approx(0.09)


@pytest.mark.parametrize(("thickness", "fits"), [(40.9, True), (41.1, False)])
def test_a_disc_thicker_than_half_the_distance_of_throws_does_not_fit(tmp_path, thickness, fits):
    """The crankcase sets the radius at which the weights of the ladder have this thickness."""
    unbalance = find_unbalance(find_ladder(build_text(THREE)).find_step("counterweights").remedy.devices[0])
    radius = (1.5e3 * unbalance / (7850 * thickness)) ** (1 / 3)
    text = add(THREE, f"crankcase = {1e3 * radius!r}")
    engine = build_text(text)
    figures = balance(engine, "step", SchemeOptions(step="counterweights")).practical[0]
    assert (figures.disc_thickness_mm is not None) == fits
    if fits:
        assert figures.disc_thickness_mm == pytest.approx(thickness)
    step = find_ladder(engine).find_step("counterweights")
    assert step.steel_kg == pytest.approx(2 * 3 * math.pi * unbalance / (4 * radius))
    told = ask("balance", write(tmp_path / "three.toml", text), "--step", "counterweights")
    assert ("No half disc of steel fits" in " ".join(told.split())) != fits
    row = next(line for line in told.splitlines() if line.startswith("1 counterweight "))
    assert row.split()[-3:].count("–") == (0 if fits else 3)


def test_pistons_that_reach_the_crank_axis_leave_no_room(tmp_path):
    text = THREE.replace("skirt = 24", "skirt = 95")
    assert find_rooms(build_text(text))[None].radius_m == 0
    assert find_ladder(build_text(text)).find_step("counterweights").steel_kg is None
    told = ask("balance", write(tmp_path / "three.toml", text), "--step", "1")
    assert "No half disc of steel fits for counterweights 1 and 2" in " ".join(told.split())


def test_asked_sizes_beyond_the_room_are_warned_of(tmp_path):
    """A disc of 67.2 mm fits, one of 67.4 mm does not."""
    file = write(tmp_path / "three.toml", THREE)
    warned = {}
    for disc in ("67.2", "67.4"):
        *_, warned[disc] = run_here("balance", file, "--step", "1", "--disc", disc)
    assert warned["67.2"] == ""
    assert "--disc: half discs beyond the room around the crank (radius 67.3 mm" in warned["67.4"]


def test_a_given_thickness_sets_the_radius():
    figures = balance(build_text(THREE), "step", SchemeOptions(step=1), tools=Tools(thickness=0.02)).practical[0]
    assert figures.disc_thickness_mm == pytest.approx(20)
    assert 7850 * 2 / 3 * 0.02 * (figures.disc_radius_mm / 1e3) ** 3 == pytest.approx(figures.unbalance_kg_m)


def test_mass_is_that_of_the_shape_and_radius_adds_a_column(tmp_path):
    file = write(tmp_path / "three.toml", THREE)
    plain = ask("balance", file, "--step", "1")
    assert "Mass: at a radius of" not in plain
    row = next(line for line in plain.splitlines() if line.startswith("1 counterweight "))
    assert row.split()[4] == "1.227"
    at_radius = " ".join(ask("balance", file, "--step", "1", "--radius", "50").split())
    assert "Last column: mass at a radius of 50 mm." in at_radius
    sector = ask("balance", file, "--step", "1", "--sector", "30,67,140")
    row = next(line for line in sector.splitlines() if line.startswith("1 counterweight "))
    centroid = 2 / 3 * (67**3 - 30**3) * math.sin(math.radians(70)) / (math.radians(70) * (67**2 - 30**2))
    unbalance = find_unbalance(find_ladder(build_text(THREE)).find_step("counterweights").remedy.devices[0])
    assert row.split()[4:] == [f"{1e3 * unbalance / centroid:.4g}", "–", "–"]
