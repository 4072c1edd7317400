"""Balance of a locomotive against particles on a grid of crank angles, and against textbooks."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.engines import engine
from support.paths import ENGINES

from balcli import load, locomotive, sweep
from balcli.engine.load import vary_engine
from balcli.file.examples import template
from balcli.forces.spectrum import compute_spectra

POINTS = 720
THETA = np.arange(POINTS) * 2 * math.pi / POINTS
INSIDE = {
    "crank": {"stroke": 600, "throws": [0, 90], "positions": [-300, 300], "throw_mass": 250},
    "rod": {"motion": "harmonic"},
    "piston": {"mass": 300},
    "locomotive": {"planes": [-750, 750], "radius": 800, "wheel_diameter": 2000, "wheel_load": 4e4, "factor": 0.6},
    "operation": {"speed": 240},
}


def changed(**parts):
    return {**INSIDE, **{key: {**INSIDE.get(key, {}), **part} for key, part in parts.items()}}


def turning(degrees):
    return np.exp(1j * (THETA + math.radians(degrees)))


def slope(values):
    return np.fft.ifft(1j * np.fft.fftfreq(POINTS, 1 / POINTS) * np.fft.fft(values))


class Particles:
    """Points of a locomotive with one axle: those that revolve, and the pistons."""

    def __init__(self, parts):
        crank = parts["crank"]
        rod = parts["rod"]
        self.table = parts["locomotive"]
        banks = [parts.get("cylinder", {}).get(str(k + 1), {}).get("bank", 0) for k in range(len(crank["throws"]))]
        self.revolving = []
        self.pistons = []
        self.imaged = []
        for throw, z, bank, share in zip(crank["throws"], crank["positions"], banks, crank["throw_mass"], strict=True):
            pin = crank["stroke"] / 2e3 * turning(banks[0] + throw - crank["throws"][0])
            along = pin * np.exp(-1j * math.radians(bank))
            length = rod["length"] / 1e3
            place = (along.real + np.sqrt(length**2 - along.imag**2)) * np.exp(1j * math.radians(bank))
            mass = parts["piston"]["mass"] + rod["small_end"]
            self.revolving.append((share + rod["big_end"], pin, z / 1e3))
            self.pistons.append((mass, place, z / 1e3))
            self.imaged.append((mass, along, z / 1e3))  # what turns in its place, for a share of it
        for weight in parts.get("counterweight", ()):
            at = weight["radius"] / 1e3 * turning(banks[0] + weight["angle"])
            self.revolving.append((weight["mass"], at, weight["position"] / 1e3))

    def press(self, bodies, plane):
        """Vertical force of bodies on the wheel in a plane, for a crank speed of 1."""
        first, second = (z / 1e3 for z in self.table["planes"])
        here, there = (first, second) if plane == 0 else (second, first)
        return sum(-mass * slope(slope(at)).imag * (there - z) / (there - here) for mass, at, z in bodies)

    def act(self):
        """Force along x and moment about y, for a crank speed of 1."""
        each = [(-mass * slope(slope(at)).real, z) for mass, at, z in (*self.revolving, *self.pistons)]
        return sum(force for force, _ in each), sum(z * force for force, z in each)


def first_order(curve):
    return np.abs(np.fft.fft(curve)[1]) * 2 / POINTS


signed = st.floats(-1, 1)
small = st.floats(0.1, 1)


@st.composite
def locomotives(draw):
    """Two to four cylinders, some inclined, with weights in the file, moments about z = 0."""
    count = draw(st.integers(2, 4))

    def of_each(values):
        return draw(st.lists(values, min_size=count, max_size=count))

    inclined = {str(k): {"bank": 10 * bank} for k, bank in enumerate(of_each(signed), 1)}
    weights = [
        {"mass": 100 * draw(small), "radius": 500, "angle": 180 * draw(signed), "position": 800 * draw(signed)}
        for _ in range(draw(st.integers(0, 2)))
    ]
    crank = {
        "throws": [180 * throw for throw in of_each(signed)],
        "positions": [1000 * z for z in of_each(signed)],
        "throw_mass": [300 * mass for mass in of_each(small)],
    }
    more = {"cylinder": inclined} | ({"counterweight": weights} if weights else {})
    parts = changed(crank=crank, locomotive={"factor": draw(st.floats(0, 1))}, frame={"reference": [0, 0, 0]})
    rod = {"length": 1800, "small_end": 90, "big_end": 140}
    return parts | {"rod": rod, "piston": {"mass": 300 * draw(small)}} | more


@given(locomotives())
def test_wheels_and_track_feel_what_particles_do(parts):
    made = engine(**parts)
    factor = parts["locomotive"]["factor"]
    found = locomotive(made)
    square = float(made.omega) ** 2
    particles = Particles(parts)
    start = float(made.first_axis_deg)
    for wheel in found.wheels:
        at = turning(np.angle(wheel.unbalance, deg=True) + start)
        particles.revolving.append((abs(wheel.unbalance), at, wheel.plane_mm / 1e3))
    imaged = [(factor * mass, at, z) for mass, at, z in particles.imaged]
    size = sum(mass for mass, *_ in (*particles.revolving, *particles.pistons)) * square
    for plane, wheel in enumerate(found.wheels):
        blow, nothing = (particles.press(particles.revolving + more, plane) for more in ([], imaged))
        assert first_order(blow) * square == pytest.approx(wheel.hammer_blow_N, abs=1e-9 * size)
        assert np.abs(nothing).max() * square < 1e-9 * size
    along = [part * square for part in particles.act()]
    firsts = found.tractive_variation_N
    peaks = found.tractive_variation_peak_N
    firsts = (firsts, found.swaying_couple_Nm)
    peaks = (peaks, found.swaying_couple_peak_Nm)
    assert [first_order(part) for part in along] == pytest.approx(firsts, abs=1e-9 * size)
    assert [np.abs(part).max() for part in along] == pytest.approx(peaks, rel=1e-3, abs=1e-6 * size)


@given(st.floats(0, 1), st.floats(100, 600))
def test_two_cranks_at_right_angles_are_those_of_textbooks(factor, apart):
    made = engine(**changed(crank={"positions": [-apart / 2, apart / 2]}))
    found = locomotive(made, factor)
    one = (1 - factor) * 300 * 0.3 * float(made.omega) ** 2
    assert found.tractive_variation_N == pytest.approx(math.sqrt(2) * one, abs=1e-6)
    assert found.swaying_couple_Nm == pytest.approx(one * apart / 1e3 / math.sqrt(2), abs=1e-6)


@pytest.mark.parametrize(
    ("positions", "reference", "about", "lever"),
    [
        ([-300, 300], None, 50.0, [-0.35, 0.25]),
        ([700, 1300], None, 50.0, [0.65, 1.25]),
        ([700, 1300], [0, 0, 400], 400.0, [0.3, 0.9]),
        ([-300, 300], [0, 0, 0], 0.0, [-0.3, 0.3]),
    ],
)
def test_the_swaying_couple_is_about_the_middle_of_the_track(positions, reference, about, lever):
    """The middle lies between the planes of the wheels at -700 and 800 mm; `frame.reference` names
    another point. Textbook: (1 - c) m r w^2 times the levers of two cranks at right angles.
    """
    frame = {"frame": {"reference": reference}} if reference else {}
    crank = {"positions": positions}
    made = engine(**changed(crank=crank, locomotive={"planes": [-700, 800]}, **frame))
    swaying = locomotive(made, 0.6)
    of_one = 0.4 * 300 * 0.3 * float(made.omega) ** 2
    assert swaying.swaying_couple_z_mm == about
    assert swaying.swaying_couple_Nm == pytest.approx(of_one * math.hypot(*lever), rel=1e-9)


COUPLED = {
    "axle": [
        {"name": "leading", "cylinders": [2], "coupling_mass": 110, "part": 0.5},
        {"name": "second", "cylinders": [1], "coupling_mass": [120, 90]},
        {"name": "trailing", "wheel_load": 3e4},
    ],
    "counterweight": [{"unbalance": 2e7, "angle": 200, "position": 700, "axle": "second"}],
}
PINS = {"coupling_planes": [-900, 900], "coupling_angles": [180, 270]}


def coupled(**locomotive):
    return changed(locomotive={**PINS, **locomotive}) | COUPLED


def test_revolving_parts_are_balanced_and_the_rest_is_the_hammer_blow():
    """Force across and moment about x, about a plane of the wheels, of the engine with all balance masses."""
    parts = coupled() | {"frame": {"reference": [0, 0, -750]}}
    found = locomotive(engine(**parts))
    one_axle = locomotive(engine(**INSIDE)).rails[0].hammer_blow_N
    shares = [axle.wheels[0].hammer_blow_N / one_axle for axle in found.axles]
    assert shares == pytest.approx([0.2, 0.4, 0.4], rel=1e-12)
    weights = [weight.model_dump(exclude_none=True) for weight in found.remedy.devices]
    fitted = engine(**parts | {"counterweight": COUPLED["counterweight"] + weights})
    across = compute_spectra(fitted, [1])
    assert abs(across.force.y[0]) == pytest.approx(found.hammer_blow_N, rel=1e-9)
    assert abs(across.moment.x[0]) == pytest.approx(1.5 * found.rails[1].hammer_blow_N, rel=1e-9)


def test_coupling_masses_are_counterweights():
    """As `analyze` and sweeps count them, at the radius of cylinder 1 unless another is given."""
    parts = coupled()
    angles = PINS["coupling_angles"]
    planes = PINS["coupling_planes"]
    for radius in ({}, {"coupling_radius": 250}):
        parts["locomotive"] |= radius
        arm = radius.get("coupling_radius", 300)
        pins = [
            {"mass": mass, "radius": arm, "angle": angle, "position": z, "axle": "second"}
            for masses in ([110, 110], [120, 90])
            for mass, angle, z in zip(masses, angles, planes, strict=True)
        ]
        plain = {**parts, "axle": [{k: v for k, v in axle.items() if k != "coupling_mass"} for axle in parts["axle"]]}
        plain["counterweight"] = pins + parts["counterweight"]
        for kind in ("force", "moment"):
            one, other = (compute_spectra(engine(**each), [1, 2])[kind].vectors for each in (parts, plain))
            assert one == pytest.approx(other, rel=1e-12, abs=1e-6)
    heavier = vary_engine(engine(**parts), {"axle.second.coupling_mass.2": 190})
    swept = sweep(engine(**parts), {"axle.second.coupling_mass.2": [90, 190]}, ["force.1.major"])
    assert swept["force.1.major"][1] == pytest.approx(compute_spectra(heavier, [1]).force.major[0], rel=1e-12)


def test_a_limit_of_the_hammer_blow_gives_the_factor():
    made = engine(**coupled())
    found = locomotive(made, hammer_blow="5 kN")
    assert max(wheel.hammer_blow_N for wheel in found.wheels) == pytest.approx(5000, rel=1e-12)
    assert locomotive(made, found.factor).to_dict() == found.to_dict()
    assert locomotive(made, hammer_blow=1e9).factor == 1


@pytest.mark.parametrize("parts", [INSIDE, coupled(), coupled(speed="60 mph")], ids=["one axle", "several", "speed"])
def test_the_written_file_has_the_same_blows(parts, tmp_path):
    import tomli_w

    tables = {**parts}
    out = tmp_path / "out.toml"
    if "speed" in tables["locomotive"]:
        del tables["operation"]
    (tmp_path / "in.toml").write_text("# kept\n" + tomli_w.dumps(tables))
    before = ask_json("locomotive", tmp_path / "in.toml", "--factor", "2/3", "--speed", "50 mph", "--write", out)
    after = ask_json("locomotive", out)
    text = out.read_text()
    assert "# kept" in text or "counterweight" in parts
    assert "factor =" not in text
    assert after.pop("factor") is None
    assert before.pop("factor") == pytest.approx(2 / 3)
    for axle in (*before["axles"], *after["axles"]):
        for wheel in axle["wheels"]:
            sized = [wheel.pop(key) for key in ("unbalance_kg_m", "angle_deg", "mass_kg")]
            assert sized == [0, None, 0] or axle in before["axles"]
    flat, same = (np.array(list_numbers(document)) for document in (before, after))
    assert flat == pytest.approx(same, rel=1e-9, abs=1e-6)


def list_numbers(node):
    if isinstance(node, (dict, list)):
        return [number for part in (node.values() if isinstance(node, dict) else node) for number in list_numbers(part)]
    return [node] if isinstance(node, float) else []


def test_the_speed_on_the_track_is_the_speed_of_the_file():
    tables = {key: table for key, table in changed(locomotive={"speed": "90 km/h"}).items() if key != "operation"}
    rpm = 25 / (math.pi * 2) * 60
    made = load(tables)
    assert [made.speed_rpm, load(made.to_dict()).speed_rpm] == pytest.approx([rpm, rpm], rel=1e-12)
    assert made.vary({"locomotive.speed": 45}).speed_rpm == pytest.approx(rpm / 2, rel=1e-12)
    assert made.vary({"operation.speed": 100}).speed_rpm == 100
    assert locomotive(made).speed_km_h == pytest.approx(90, rel=1e-12)
    heavy = load(changed(locomotive={"wheel_load": "9 long ton"})).model.locomotive
    assert heavy.wheel_load == pytest.approx(89_676.15, rel=1e-6)


def test_every_optional_key_of_the_starting_file_can_be_switched_on():
    text = re.sub(r"(?m)^# *(\[+[a-z.0-9]+\]+|[a-z_]+ *= .*)", r"\1", template("locomotive"))
    assert [axle.name for axle in locomotive(load(text)).axles] == ["leading", "driving"]


def test_every_format_and_unit(tmp_path):
    file = tmp_path / "locomotive.toml"
    file.write_text(template("locomotive"))
    found = ask_json("locomotive", file)
    wheel = found["axles"][0]["wheels"][0]
    rows = {(r["axle"], r["plane"], r["figure"]): r["value"] for r in ask_csv("locomotive", file)}
    assert float(rows["driving", "-750.0", "unbalance"]) == pytest.approx(1e6 * wheel["unbalance_kg_m"])
    assert float(rows["driving", "-750.0", "lift"]) == pytest.approx(wheel["lift_km_h"])
    imperial = ask_csv("locomotive", file, "--units", "imperial")
    shown = {(r["plane"], r["figure"], r["unit"]): r["value"] for r in imperial if r["axle"]}
    z = str(-750 / 25.4)
    assert float(shown[z, "lift", "mph"]) == pytest.approx(wheel["lift_km_h"] / 1.609344)
    assert float(shown[z, "unbalance", "oz·in"]) == pytest.approx(wheel["unbalance_kg_m"] / 0.45359237 * 16 / 0.0254)
    assert "mph" in ask("locomotive", file, "--units", "imperial")
    table = ask_csv("locomotive", file, "--factor", "0:100%:50%")
    assert [row["factor"] for row in table] == ["0.0", "0.5", "1.0"]
    assert [row["lifts at, km/h"] == "" for row in table] == [True, False, False]
    assert ask("locomotive", file, "--factor", "0,1/2", "-f", "json").count('"format"') == 2
    assert "wheel blow, kN" in ask("locomotive", file, "--factor", "0,1/2", "-f", "markdown")


def test_what_the_command_refuses_and_doubts(tmp_path):
    file = tmp_path / "x.toml"
    file.write_text(template("locomotive"))
    for option, message in (
        ("--factor=67", '--factor: 67 is above 1; did you mean "67%" or 0.67?'),
        ("--hammer-blow=0", "--hammer-blow: 0 is not above 0"),
        ("--speed=80 kg", '--speed: "80 kg" is a mass, but a speed of rotation is wanted'),
    ):
        assert refusal("locomotive", file, option).startswith(message)
    assert refusal("locomotive", file, "--factor=1", "--hammer-blow=1") == (
        "--hammer-blow determines the factor; leave --factor out"
    )
    text = template("locomotive")
    for old, new, message in (
        ("[locomotive]", "[loco]", "locomotive: is missing; write [locomotive] with planes and factor"),
        ("wheel_diameter =", "#", "locomotive.wheel_diameter: is missing; a speed in km/h needs it"),
        (
            "speed  ",
            "# speed",
            "locomotive.speed: is missing; give it in km/h (with wheel_diameter), or give operation.speed",
        ),
        ("positions  =", "# ", "crank.spacing: moments are not known, because crank.spacing is missing"),
    ):
        file.write_text(text.replace(old, new) if new != "[loco]" else text.partition(old)[0])
        assert refusal("locomotive", file).startswith(f"{file}: {message}")
    file.write_text(text + "[layout]\nbanks = [90]\n")
    wanted = "cylinder 1 is 90 deg from the track; in a locomotive file x points along the track"
    assert wanted in run_here("locomotive", file).err


def test_examples_of_books():
    """The blows of their answers; sources are in the files."""
    found = locomotive(load(ENGINES / "historic" / "locomotive2.toml"))
    assert found.wheels[0].hammer_blow_N == pytest.approx(22_565, abs=0.5)


def test_no_scheme_divides_weights_between_axles(tmp_path: Path) -> None:
    engine_file = ENGINES / "historic/locomotive4.toml"
    done = run_here("balance", engine_file, "--scheme", "counterweights", "--write", tmp_path / "out.toml")
    assert done.status == 2
    assert "several axles have cranks" in done.err
    assert "balcli locomotive does" in done.err


def test_an_uneven_speed_is_said_to_be_ignored() -> None:
    ripple = {"speed": 240, "speed_ripple": [{"order": 2, "amplitude": 0.02, "angle": 0}]}
    (doubt,) = locomotive(engine(**changed(operation=ripple))).doubts
    assert str(doubt) == "operation.speed_ripple: has no effect, because the speed is taken as steady"
