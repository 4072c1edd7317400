"""Balancer shafts against the equilibrium of a beam, sectors against sums over small pieces, clearances against pistons
that are sampled, and the inertia of turning parts against the energy of the engine.
"""

import math

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from support.cases import cases
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.engines import GOOD, RADIAL, build_text, changed
from support.paths import ENGINES, write

from balcli import BalcliError, Shapes, analyze, curves, load, load_example
from balcli.analysis import parts
from balcli.balancing.answer import balance
from balcli.forces.curves import EngineMotion

PLACES = st.floats(-300, 300).map(lambda z: round(z, 1))
SECTOR = "sector = { inner_radius = 30, outer_radius = 75, opening = 140 }\n"
BALANCED = GOOD + "[[shaft]]\nratio = -1\ninertia = 150\nunbalance = 900\n"


def find_parts(engine):
    return parts.find_parts(engine, engine.model.shaft, engine.model.counterweight)


def describe_shaft(text, speed=3000):
    (shaft,) = find_parts(build_text(GOOD.replace("speed = 3000", f"speed = {speed}") + text)).shafts
    return shaft


@settings(max_examples=60)
@given(
    st.lists(st.tuples(st.floats(10, 9000), st.floats(-180, 180), PLACES), min_size=1, max_size=4),
    st.sampled_from([1, -1, 2, -2]),
    PLACES,
    st.floats(20, 400),
    st.booleans(),
)
def test_a_shaft_is_a_beam_on_two_supports(eccentrics, ratio, first, span, turned):
    """Bearing forces hold the loads in balance; the shear force adds up to the bending moment."""
    bearings = [first, first + span][:: -1 if turned else 1]
    text = f"[[shaft]]\nname = 's'\nratio = {ratio}\nbearings = {bearings}\ninertia = 150\nunbalance = 0\n" + "".join(
        f"[[shaft]]\nname = 's'\nratio = {ratio}\nunbalance = {u}\nangle = {a}\nposition = {z}\n"
        for u, a, z in eccentrics
    )
    shaft = describe_shaft(text)
    square = (ratio * 3000 * math.pi / 30) ** 2
    loads = [u * 1e-6 * square * np.exp(1j * math.radians(a)) for u, a, _ in eccentrics]
    z = [z / 1e3 for _, _, z in eccentrics]
    forces = [-b.rotating_N * np.exp(1j * math.radians(b.rotating_deg or 0)) for b in shaft.bearings]
    z += [b.position_mm / 1e3 for b in shaft.bearings]
    everything = np.array([*loads, *forces])
    size = np.abs(everything).sum()
    assert [b.position_mm for b in shaft.bearings] == bearings
    assert abs(everything.sum()) < 1e-10 * size
    assert abs(everything @ np.array(z)) < 1e-10 * size
    order = np.argsort(z)
    shear = np.cumsum(everything[order])[:-1]
    moments = np.abs(np.cumsum(shear * np.diff(np.array(z)[order])))
    assert shaft.bending_Nm == pytest.approx(moments.max(initial=0), rel=1e-8, abs=1e-9 * size)
    assert shaft.inertia_at_crank_kg_m2 == pytest.approx(150e-6 * ratio**2)


@pytest.mark.parametrize("ratio", [1, -1, 2, -2])
def test_a_gear_drives_its_shaft_against_the_drag(ratio):
    shaft = describe_shaft(
        f"[[shaft]]\nratio = {ratio}\nunbalance = 900\nbearings = [-130, 130]\ndrag = 0.7\n"
        "gear = { position = -150, radius = 35, direction = 70, pressure_angle = 25 }\n"
    )
    a, b = (bearing.fixed_N * np.exp(1j * math.radians(bearing.fixed_deg)) for bearing in shaft.bearings)
    radial = (a + b) * np.exp(-1j * math.radians(70))
    assert 0.035 * radial.imag == pytest.approx(math.copysign(0.7, ratio))  # torque that turns the shaft
    assert radial.real == pytest.approx(-math.tan(math.radians(25)) * 0.7 / 0.035)  # it pushes the gears apart
    assert -0.13 * a + 0.13 * b == pytest.approx(-0.15 * (a + b))
    assert shaft.gear.power_W == pytest.approx(0.7 * abs(ratio) * 100 * math.pi)
    angles = np.exp(1j * np.linspace(0, 2 * math.pi, 7201))
    turning = shaft.bearings[0].rotating_N * angles
    assert shaft.bearings[0].largest_N == pytest.approx(np.abs(turning + a).max(), rel=1e-6)


def test_weights_moved_without_changing_force_and_moment_change_bending_alone():
    head = "[[shaft]]\nname = 's'\nratio = -1\n"
    far, near = (
        describe_shaft(
            f"{head}bearings = [-130, 130]\nunbalance = {u}\nangle = 20\nposition = {-z}\n"
            f"{head}unbalance = {u}\nangle = 200\nposition = {z}\n"
        )
        for u, z in ((9000, 100), (18000, 50))
    )
    assert near.bearings[0].rotating_N == pytest.approx(far.bearings[0].rotating_N)
    assert near.bending_Nm > 2 * far.bending_Nm


@pytest.mark.parametrize(("inner", "outer", "opening"), [(30, 75, 140), (0, 60, 200), (10, 40, 360)])
def test_a_sector_is_the_sum_of_its_pieces(inner, outer, opening):
    sector = f"sector = {{ inner_radius = {inner}, outer_radius = {outer}, opening = {opening}, thickness = 18 }}"
    (part,) = find_parts(build_text(GOOD + f"[[counterweight]]\nangle = 180\n{sector}\n")).counterweights
    n = 2000
    r = (inner + (np.arange(n) + 0.5) * (outer - inner) / n) / 1e3
    angle = np.radians(((np.arange(n) + 0.5) / n - 0.5) * opening)
    pieces = 7850 * 0.018 * r * (outer - inner) / 1e3 / n * math.radians(opening) / n
    mass = n * pieces.sum()
    assert part.mass_kg == pytest.approx(mass, rel=1e-6)
    assert part.unbalance_kg_m == pytest.approx((pieces @ r) * np.cos(angle).sum(), rel=1e-6, abs=1e-12)
    assert part.center_of_mass_m * part.mass_kg == pytest.approx(part.unbalance_kg_m)
    assert part.inertia_kg_m2 == pytest.approx(n * (pieces @ r**2), rel=1e-6)
    assert part.clearance_m is None
    if opening < 360:
        text = f"[[counterweight]]\nangle = 180\nunbalance = {part.unbalance_kg_m * 1e6}\n"
        (back,) = find_parts(build_text(GOOD + text + sector.replace(", thickness = 18", "") + "\n")).counterweights
        assert back[:7] == pytest.approx(part[:7])


# ------------------------------------------------------------------ eccentrics
ECCENTRIC = "[[shaft]]\nname = 'left'\nratio = -2\nsector = {{ inner_radius = 9, outer_radius = 20, opening = {} }}\n"


@pytest.mark.parametrize("opening", [180, 130])
def test_an_eccentric_is_the_sum_of_its_sector_and_its_core(opening):
    """A counterweight of the same sector, and a solid cylinder of the inner radius, 120 mm long."""
    thick = f"opening = {opening}, thickness = 120 }}"
    text = ECCENTRIC.format(opening).replace(f"opening = {opening} }}", thick)
    found = find_parts(
        build_text(GOOD + text + text.replace("[[shaft]]\nname = 'left'\nratio = -2", "[[counterweight]]"))
    )
    (part,), (bare,) = found.eccentrics, found.counterweights
    core = 7850 * math.pi * 0.009**2 * 0.12
    assert part.shaft == "left"
    assert part.thickness_m == pytest.approx(0.12)
    assert part.unbalance_kg_m == pytest.approx(bare.unbalance_kg_m)
    assert part.mass_kg == pytest.approx(bare.mass_kg + core)
    assert part.inertia_kg_m2 == pytest.approx(bare.inertia_kg_m2 + core * 0.009**2 / 2)
    unbalance = ECCENTRIC.format(opening) + f"unbalance = {part.unbalance_kg_m * 1e6!r}\n"
    (back,) = find_parts(build_text(GOOD + unbalance)).eccentrics
    assert back[1:] == pytest.approx(part[1:])


def test_sectors_of_one_name_add_up_to_the_inertia_of_the_shaft():
    """Figures of a calculation by hand: each has 123.505 kg mm2, which counts with the square of the ratio."""
    one = ECCENTRIC.format(180) + "unbalance = 4576.406537132128\n"
    (part,) = find_parts(build_text(GOOD + one)).eccentrics
    assert (part.mass_kg, part.thickness_m) == pytest.approx((0.7133237189313336, 0.12026854445236496))
    for count in (1, 2):
        engine = build_text(GOOD + count * one)
        (shaft,) = find_parts(engine).shafts
        assert shaft.inertia_at_crank_kg_m2 == pytest.approx(count * 4 * 0.00012350510597601024)
        turning = engine.find_turning_inertia()
        assert turning.energy - build_text(GOOD).find_turning_inertia().energy == pytest.approx(
            shaft.inertia_at_crank_kg_m2
        )


def test_a_fitted_eccentric_has_its_length(tmp_path):
    """The unbalance that cancels the force turning against the crank of a single; the file keeps the sector."""
    ask("engines", "single", tmp_path / "single.toml")
    text = (tmp_path / "single.toml").read_text(encoding="utf-8")
    shaft = ECCENTRIC.format(180).replace("-2", "-1") + "unbalance = 'fit'\n"
    file = write(tmp_path / "fit.toml", text + shaft)
    found = ask_json("balance", file, "--write", tmp_path / "out.toml")
    (eccentric,) = found["parts"]["eccentrics"]
    assert eccentric["unbalance_kg_m"] == found["shafts"][0]["unbalance_kg_m"]
    (written,) = find_parts(load(tmp_path / "out.toml")).eccentrics
    assert written.thickness_m == pytest.approx(eccentric["thickness_m"])
    assert "Eccentrics" in ask("analyze", tmp_path / "out.toml", "--only", "parts")
    rows = ask_csv("analyze", tmp_path / "out.toml", "--only", "parts")
    (mass,) = (row["value"] for row in rows if (row["quantity"], row["figure"]) == ("eccentric 1", "mass_kg"))
    assert float(mass) == pytest.approx(written.mass_kg)


@pytest.mark.parametrize(
    "text",
    [
        changed(("mass = 0.5", "mass = 0.5\nskirt = 38\noffset = 6")),
        RADIAL.replace("mass = 1.3", "mass = 1.3\nskirt = 38"),
        changed(("mass = 0.5", "mass = 0.5\nskirt = 38"), ("[layout]", "[cylinder.3]\nrod_length = 150\n[layout]")),
    ],
)
def test_the_clearance_to_the_lowest_of_all_pistons(text):
    engine = build_text(text + "[[counterweight]]\nunbalance = 900\n" + SECTOR)
    motion = EngineMotion(engine, np.arange(0, 360, 0.05))
    lowest = float(engine.cylinders.radius[0]) * float(motion.moved.place.min())
    (part,) = find_parts(engine).counterweights
    assert part.clearance_m == pytest.approx(lowest - 0.038 - 0.075, abs=1e-8)


# ------------------------------------------------------------------ inertia
UNEVEN = "[[operation.speed_ripple]]\norder = 1\namplitude = 0.02\nangle = 20\n"
WEIGHT = "[[counterweight]]\nangle = 180\nunbalance = 9000\ninertia = 5000\n"


@pytest.mark.parametrize(
    ("text", "momentum", "energy"),
    [
        ("[[shaft]]\nratio = -2\ninertia = 150\n", -2 * 150, 4 * 150),
        ("[[shaft]]\nratio = 1\ninertia = 150\n[flywheel]\ninertia = 250000\n", 250150, 250150),
        ("[[counterweight]]\nunbalance = 0\ninertia = 5000\n", 5000, 5000),
    ],
)
def test_turning_parts_resist_an_uneven_speed(text, momentum, energy):
    """Couple: minus the change of moment of momentum; torque: minus that of energy, over the crank angle."""
    plain = load(tables := GOOD + UNEVEN)
    full = load(tables + text)
    angle = np.radians(np.arange(360))
    speed = 100 * math.pi * (1 + 0.02 * np.cos(angle - math.radians(20)))
    rate = -speed * 100 * math.pi * 0.02 * np.sin(angle - math.radians(20))
    before, after = (curves(engine, 1.0).curves for engine in (plain, full))
    for key, inertia in (("couple_Nm", momentum), ("inertia_torque_Nm", energy)):
        assert after[key] - before[key] == pytest.approx(-inertia * 1e-6 * rate, rel=1e-9, abs=1e-9)
    spectra = analyze(full, [1, 2, 3]).spectra
    for key, kind in (("couple_Nm", "couple"), ("inertia_torque_Nm", "torque"), ("roll_Nm", "roll")):
        sampled = np.abs(np.fft.rfft(after[key]))[1:4] / 180
        assert spectra[kind].major == pytest.approx(sampled, rel=1e-9, abs=1e-9 * sampled.max())


def test_counterweights_are_part_of_the_crankshaft():
    whole = GOOD.replace("throw_mass", "inertia = 90000\nthrow_mass")
    for text in (whole, GOOD):
        without, with_it = (analyze(load(text + UNEVEN + more), [1]).spectra.torque.major[0] for more in ("", WEIGHT))
        assert (without == pytest.approx(with_it, rel=1e-12)) == (text is whole)


def test_all_torque_is_constant_at_the_speed_that_it_makes(tmp_path):
    """The speed of `torque` and the torques of `analyze` count the same parts."""
    text = (ENGINES / "i4_wiebe.toml").read_text() + "[[shaft]]\nratio = -2\ninertia = 9000\n" + WEIGHT
    file = write(tmp_path / "four.toml", text)
    ask("torque", file, "--write", tmp_path / "uneven.toml")
    found = analyze(load(tmp_path / "uneven.toml"), [2, 4, 6], only="gas,torque").spectra
    assert (found.torque_total.major < 1e-3 * found.gas.major).all()


# ------------------------------------------------------------------ commands
def test_devices_of_a_scheme_as_parts(tmp_path):
    """Sectors and bearings are written, and read back as they were shown."""
    file = ENGINES / "i3.toml"
    out = tmp_path / "out.toml"
    options = ("--scheme", "complete", "--bearings=-130,130", "--sector", "30,90,140")
    found = ask_json("balance", file, *options, "--write", out)
    assert all(shaft["name"].startswith("balancer") for shaft in found["parts"]["shafts"])
    assert found["parts"]["counterweights"][0]["thickness_m"] > 0
    assert "disc_thickness_mm" not in found["practical"][0]
    written = ask_json("analyze", out, "--only", "parts")["parts"]
    assert len(written.pop("throws")) == 3
    assert written == found["parts"]
    table = ask("balance", file, *options)
    assert "balancer 1" in table
    assert "thickness" in table
    rows = ask_csv("balance", file, *options)
    assert any(row["part"] == "parts" and row["figure"].endswith("largest_N") for row in rows)


def test_new_shafts_have_names_of_their_own(tmp_path):
    names = []
    file = ENGINES / "i4.toml"
    for order in (2, 4):
        scheme = ("--scheme", "two-shaft", "--order", order, "--bearings=-90,90")
        options = (*scheme, "--write", tmp_path / f"{order}.toml")
        names += [shaft["name"] for shaft in ask_json("balance", file, *options)["parts"]["shafts"]]
        file = options[-1]
    assert names == ["balancer 1", "balancer 2", "balancer 3", "balancer 4"]


def test_shapes_in_python():
    found = balance(load_example("i3"), "complete", shapes=Shapes((-0.13, 0.13), (0.03, 0.09, 140)))
    assert found.parts.shafts[0].bearings[0].position_mm == -130
    with pytest.raises(BalcliError, match="bearings: bearings are both at 10 mm"):
        balance(load_example("i3"), "complete", shapes=Shapes(bearings=(0.01, 0.01)))


@cases("analysis/balance", "what_shapes_cannot_be")
def test_what_shapes_cannot_be(tmp_path, options, told):
    assert told in refusal("balance", write(tmp_path / "engine.toml", GOOD), *options)


def test_parts_at_a_speed_in_every_format(tmp_path):
    file = write(
        tmp_path / "four.toml", BALANCED.replace("ratio = -1", "name = 'left'\nbearings = [0, 100]\nratio = -1")
    )
    (whole,), (half,) = (
        ask_json("analyze", file, "--only", "parts", "--speed", rpm)["parts"]["shafts"] for rpm in (3000, 1500)
    )
    assert whole["bearings"][0]["rotating_N"] == pytest.approx(4 * half["bearings"][0]["rotating_N"])
    assert "fixed_deg" not in whole["bearings"][0]
    rows = ask_csv("analyze", file, "--only", "parts")
    throws = {f"throw {number}" for number in (1, 2, 3, 4)}
    assert {row["quantity"] for row in rows} == {"shaft left", *throws}
    assert "bearing, in" in ask("analyze", file, "--only", "parts", "--units", "imperial")
    assert "The file has no balancer shafts" in ask("analyze", "-", "--only", "parts", stdin=GOOD)


def test_a_counterweight_that_meets_a_piston_is_warned_of():
    text = GOOD.replace("mass = 0.5", "mass = 0.5\nskirt = 60") + "[[counterweight]]\nunbalance = 900\n" + SECTOR
    low = 1e3 * (0.16 - 0.045 - 0.06 - 0.075)
    assert (
        f"counterweight.1: has a clearance of {low:.4g} mm"
        in run_here("analyze", "-", "--only", "parts", stdin=text).err
    )
