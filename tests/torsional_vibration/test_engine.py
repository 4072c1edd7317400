"""`[torsion]` of an engine file: inertias and torques of its cylinders against quadrature and time
integration, and every mistake by its path.
"""

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask_json, ask_torsion, refusal, run_here
from support.diesel import INERTIAS, NATURAL_HZ, write_diesel
from support.paths import write

ODE = 1e-6  # of the largest: what a time integration agrees to
THETA = np.arange(4096) * 2 * np.pi / 4096


def slider_crank(theta, radius, length, offset=0.0):
    """Speed of the piston and of the rod's angle for a crank speed of 1 (m, 1)."""
    lean = (radius * np.sin(theta) - offset) / length
    rate = radius * np.cos(theta) / (length * np.sqrt(1 - lean**2))
    return -radius * np.sin(theta) - length * lean * rate, rate


def frequencies(text):
    return [mode["frequency_Hz"] for mode in ask_torsion(text)["modes"]]


# ------------------------------------------------------------------ inertias
def test_nodes_and_shafts_stand_from_front_to_rear():
    said = ask_torsion(write_diesel())
    throws = [f"throw {k}" for k in range(1, 7)]
    assert [node["name"] for node in said["nodes"]] == ["pulley", "gear", *throws, "flywheel"]
    between = [f"throw {k}-{k + 1}" for k in range(1, 6)]
    assert [shaft["name"] for shaft in said["shafts"]] == ["pulley", "gear", *between, "flywheel"]
    found = [node["inertia_kg_m2"] for node in said["nodes"]]
    assert found == pytest.approx(INERTIAS, rel=1e-7)
    assert [mode["frequency_Hz"] for mode in said["modes"]] == pytest.approx(NATURAL_HZ, rel=1e-7)
    assert [mode["nodes"] for mode in said["modes"]] == list(range(1, 9))


def test_mean_inertia_of_a_cylinder_against_quadrature():
    """`m_rot r^2 + mean(m_rec s'^2 - H beta'^2)`, with an offset and a rod that is no two masses."""
    radius = 0.045
    length = 0.145
    offset = 0.004
    mass = 0.7
    cg = 0.05
    about = 2600e-6
    text = f"""
        crank = {{ stroke = 90, throw_mass = 3.3 }}
        rod = {{ length = 145, mass = {mass}, cg = {cg * 1e3}, inertia = {about * 1e6} }}
        piston = {{ mass = 0.5, offset = 4 }}
        torsion.throw_inertia = 20000
        torsion.rear = [{{ name = "flywheel", inertia = 1e6, stiffness = 1e5 }}]
        """
    speed, rate = slider_crank(THETA, radius, length, offset)
    small = mass * cg / length
    big = mass * (length - cg) / length
    lacking = small * big / mass * length**2 - about
    expected = 0.02 + big * radius**2 + np.mean((0.5 + small) * speed**2 - lacking * rate**2)
    assert ask_torsion(text)["nodes"][0]["inertia_kg_m2"] == pytest.approx(expected, rel=1e-13)


def test_throws_of_a_vee_carry_two_rods():
    vee = """
        crank = { stroke = 80, throws = [0, 90], spacing = 100 }
        rod = { length = 140, small_end = 0.2, big_end = 0.4 }
        piston.mass = 0.5
        layout.bank_angle = 90
        [torsion]
        throw_inertia = [15000, 16000]
        throw_stiffness = 5e5
        damping = 3
        rear = [{ name = "flywheel", inertia = 1e6, stiffness = 1e6 }]
        """
    speed, _ = slider_crank(THETA, 0.04, 0.14)
    one = 0.4 * 0.04**2 + 0.7 * np.mean(speed**2)
    said = ask_torsion(vee)
    inertias = np.array([node["inertia_kg_m2"] for node in said["nodes"]])
    assert inertias[:2] == pytest.approx([0.015 + 2 * one, 0.016 + 2 * one], rel=1e-12)
    first = said["modes"][0]
    moved = np.square(first["shape"])
    loss = 2 * 3 * moved[:2].sum() / (2 * np.pi * first["frequency_Hz"] * (inertias @ moved))
    assert first["loss"] == pytest.approx(loss), "damping counts for each cylinder"


# ------------------------------------------------------------------ excitation
def test_phase_sums_are_those_of_the_firing_order():
    said = ask_torsion(write_diesel(), "--orders", "1-12")
    shape = np.array(said["modes"][0]["shape"][2:8])
    pins = np.radians([0, 240, 120, 120, 240, 0])  # of 1-5-3-6-2-4
    first = [critical for critical in said["criticals"] if critical["mode"] == 1]
    for critical in first:
        assert critical["phase_sum"] == pytest.approx(abs(np.exp(1j * critical["order"] * pins) @ shape))
    assert sum(critical["work_share"] for critical in first) == pytest.approx(1)
    assert {c["order"] for c in said["criticals"] if c["phase_sum"] > 3} == {6, 9, 12}


def integrate(inertia, stiffness, dashpots, grounded, torque, omega, steps):
    """Half peak to peak of the torque in each shaft of a chain in a row, in its periodic state.

    Over one turn the state at the end is linear in that at the start; the start that returns to
    itself is solved for. Runge-Kutta, 4th order. `torque` is a function of the crank angle to the
    torques on all nodes.
    """
    count = len(inertia)
    stiffness = np.array(stiffness)
    dashpots = np.array(dashpots)
    twist = np.eye(count)[:-1] - np.eye(count)[1:]
    springs, losses = ((twist.T * each) @ twist for each in (stiffness, dashpots))
    below = [-springs / inertia[:, None], -(losses + np.diag(grounded)) / inertia[:, None]]
    system = np.block([[np.zeros((count, count)), np.eye(count)], below])
    span = 2 * np.pi / omega / steps
    pushed = np.array([torque(k * np.pi / steps) for k in range(2 * steps + 1)]) / inertia
    pushed = np.concatenate([np.zeros_like(pushed), pushed], axis=1)

    def step(k, state, forced):
        before, middle, after = (each[:, None] * forced for each in pushed[2 * k : 2 * k + 3])
        a = system @ state + before
        b = system @ (state + span / 2 * a) + middle
        c = system @ (state + span / 2 * b) + middle
        d = system @ (state + span * c) + after
        return state + span / 6 * (a + 2 * b + 2 * c + d)

    state = np.eye(2 * count, 2 * count + 1)
    forced = np.eye(2 * count + 1)[-1]
    for k in range(steps):
        state = step(k, state, forced)
    start = np.linalg.lstsq(np.eye(2 * count) - state[:, :-1], state[:, -1], rcond=1e-12)[0]
    state = start[:, None]
    torques = []
    for k in range(steps):
        bend = twist @ state[:count, 0]
        rate = twist @ state[count:, 0]
        torques.append(stiffness * bend + dashpots * rate)
        state = step(k, state, np.ones(1))
    return np.ptp(torques, axis=0) / 2


def test_time_integration_agrees_with_the_synthesis():
    """Inertia torque of the slider-crank itself, not of its harmonics; near a critical."""
    inertia = np.array([0.03, 0.05, 0.05, 0.05, 0.05, 0.9])
    stiffness = [9e5, 8e5, 8e5, 8e5, 1e6]
    radius = 0.043
    length = 0.145
    mass = 0.9
    omega = 5200 * np.pi / 30
    gear = mass * np.mean(slider_crank(THETA, radius, length)[0] ** 2)
    text = f"""
        crank = {{ stroke = 86, throws = [0, 180, 180, 0], spacing = 90 }}
        rod = {{ length = 145, mass = 0, cg = 0 }}
        piston.mass = {mass}
        [torsion]
        throw_inertia = {float(0.05 - gear) * 1e6!r}
        throw_stiffness = 8e5
        damping = 4
        front = [{{ name = "pulley", inertia = 30000, stiffness = 9e5, damping = 60 }}]
        rear = [{{ name = "flywheel", inertia = 900000, stiffness = 1e6, damping = 50, node_damping = 1 }}]
        """

    def torque(angle):
        """`-1/2 dI/dtheta` by the chain rule: `-m s' s''`, of two pairs of cylinders."""
        h = 1e-4
        turns = angle + np.array([[0], [np.pi]]) + h * np.array([1, -1, 2, -2])
        slopes = slider_crank(turns, radius, length)[0] ** 2 @ [8, -8, -1, 1] / (12 * h)
        one, two = -mass * omega**2 / 2 * slopes
        return np.array([0, one, two, two, one, 0])

    exact = integrate(inertia, stiffness, [60, 0, 0, 0, 50], [0, 4, 4, 4, 4, 1], torque, omega, 3000)
    said = ask_torsion(text, "--speeds", "5200", "--orders", "1-24")["response"]
    found = [shaft["half_peak_to_peak_Nm"][0] for shaft in said["shafts"]]
    assert found == pytest.approx(exact, abs=ODE * max(exact))


def test_rigid_shafts_leave_the_fluctuation_of_one_inertia():
    """k to infinity: all turn as one, `T_n/(n^2 omega^2 J)`."""
    stiff = write_diesel().replace("throw_stiffness = [", "throw_stiffness = [1e16, 1e16, 1e16, 1e16, 1e16] # [")
    for stiffness in ("1631000.0", "1106000.0", "1976000.0"):
        stiff = stiff.replace(f"stiffness = {stiffness}", 'stiffness = "rigid"')
    said = ask_torsion(stiff.replace("damping = 2", "damping = 0"), "--speeds", "2000", "--orders", "6", "-q")
    speed = slider_crank(THETA, 0.0685, 0.207)[0]
    omega = 2000 * np.pi / 30
    sixth = 6 * 2 * np.abs(np.mean(2.521 * speed**2 * np.exp(-6j * THETA)))  # of six cylinders
    swing = np.degrees(0.5 * 6 * sixth * omega**2 / (36 * omega**2 * sum(INERTIAS)))
    assert said["response"]["free_end_deg"][0] == pytest.approx(swing, rel=1e-6)


# ------------------------------------------------------------------ parts
def test_branches_and_gears():
    more = """
        [[torsion.rear]]
        name = "camshaft"
        inertia = 8000
        stiffness = 20000
        of = "throw 2"
        gear = 0.5
        [[torsion.rear]]
        name = "pump"
        inertia = 3000
        stiffness = 9000
        """
    said = ask_torsion(write_diesel() + more)
    gears = {node["name"]: node["gear"] for node in said["nodes"]}
    assert (gears["flywheel"], gears["camshaft"], gears["pump"]) == (1, 0.5, 0.5)
    assert len(said["modes"]) == 10
    assert said["modes"][0]["frequency_Hz"] < np.sqrt(9000 / 0.003) / 2 / np.pi


def test_half_of_a_plain_shaft_turns_with_either_end():
    """4 times as much of a shaft that turns twice as fast as the crank, of 1000 mm and 40 mm in steel."""
    pump = '[[torsion.rear]]\nname = "pump"\ngear = 2\nof = "throw 6"\ninertia = 1000\nlength = 1000\ndiameter = 40\n'
    bare, heavy = (
        [n["inertia_kg_m2"] for n in ask_json("-q", "torsion", "-", stdin=write_diesel() + pump + more)["nodes"]]
        for more in ("", "density = 7.85")
    )
    half = 7850 * np.pi / 32 * 0.04**4 / 2
    assert np.subtract(heavy, bare) == pytest.approx([0] * 7 + [4 * half, 0, half], abs=1e-15)


def test_plain_shafts_without_a_density_are_named():
    pump = '[[torsion.rear]]\nname = "pump"\ngear = 2\nof = "throw 6"\ninertia = 1000\nlength = 1000\ndiameter = 40\n'
    assert '1 plain shaft without a density ("pump")' in run_here("torsion", "-", stdin=write_diesel() + pump).err


def test_a_rigid_part_adds_to_its_neighbour():
    apart = write_diesel().replace(f"inertia = {INERTIAS[8] * 1e6}", "inertia = 2000000")
    rest = '[[torsion.rear]]\nname = "clutch"\ninertia = 75000\nstiffness = "rigid"\n'
    assert frequencies(apart + rest) == pytest.approx(NATURAL_HZ, rel=1e-7)


@cases("torsional_vibration/engine", "mistakes_of_torsion_say_what_would_be_right")
def test_mistakes_of_torsion_say_what_would_be_right(torsion, message):
    head = write_diesel().partition("[torsion]")[0]
    assert refusal("torsion", "-", stdin=head + torsion) == f"standard input: {message}"


def test_a_rotary_has_no_crankshaft_that_twists():
    text = write_diesel().replace("firing_order = [1, 5, 3, 6, 2, 4]", "radial = 9\nrotary = true")
    assert refusal("torsion", "-", stdin=text.replace("spacing = 120", "")) == (
        "standard input: torsion: needs a crankshaft that turns; that of a rotary engine does not"
    )


def test_speeds_and_pendulums_count_from_the_crankshaft_with_a_geared_part_foremost():
    """A part on throw 1 does the same whichever list names it, foremost or not: pendulums stay
    tuned to orders of the crankshaft.
    """
    pump = '{ name = "pump", inertia = 4000, gear = -2.5, stiffness = 1e5, of = "throw 1" }'
    pendulums = 'damper = { kind = "pendulum", mass = 2, radius = 80, length = 20 }'
    flywheel = f'{{ name = "flywheel", inertia = 2e5, stiffness = 3e5, of = "throw 1", {pendulums} }}'
    found = []
    for front, rear in ((pump, ""), ("", pump + ", ")):
        text = f"""
            crank.stroke = 90
            rod = {{ length = 145, mass = 0.7, cg = 50 }}
            piston = {{ mass = 0.5, bore = 86 }}
            [torsion]
            throw_inertia = 20000
            loss = 0.02
            front = [{front}]
            rear = [{rear}{flywheel}]
            """
        said = ask_torsion(text, "--speeds", "900,2100,4000")
        assert {node["name"]: node["gear"] for node in said["nodes"]} == {"throw 1": 1, "pump": -2.5, "flywheel": 1}
        found.append({each["name"]: each["half_peak_to_peak_Nm"] for each in said["response"]["shafts"]})
    for name in ("pump", "flywheel"):
        assert found[0][name] == pytest.approx(found[1][name], rel=1e-12)


# ------------------------------------------------------------------ throws
EIGHT = [(n, -45, 100 * n - 260) for n in range(1, 5)] + [(n, 45, 100 * n - 640) for n in range(5, 9)]
TWELVE = [(n, bank, 100 * pin - 250) for n, (bank, pin) in enumerate(np.ndindex(3, 4), 1)]


@pytest.mark.parametrize(
    ("rows", "pins"),
    [
        ("\n".join(f"cylinder.{n} = {{ bank = {bank}, position = {z} }}" for n, bank, z in EIGHT), 2),
        ("\n".join(f"cylinder.{n} = {{ bank = {60 * b - 60}, position = {z} }}" for n, b, z in TWELVE), 3),
    ],
)
def test_a_throw_for_each_cylinder_has_the_modes_of_the_pins(rows, pins):
    """A V8 or W12 typed with a throw for each cylinder, in any order, has four pins in order of
    position that share them: those of a chain by hand.
    """
    text = f"""{rows}
        crank = {{ stroke = 90, throws = {[0, 90, 270, 180] * pins} }}
        rod = {{ length = 150, small_end = 0.2, big_end = 0.4 }}
        piston = {{ bore = 95, mass = 0.5 }}
        [torsion]
        throw_stiffness = [1e6, 2e6, 3e6]
        throw_inertia = {[10000 * k for k in range(1, 4 * pins + 1)]}
        rear = [{{ name = "flywheel", inertia = 200000, stiffness = 1.2e6 }}]
        """
    speed, _ = slider_crank(THETA, 0.045, 0.15)
    gear = 0.4 * 0.045**2 + 0.7 * np.mean(speed**2)
    throws = np.arange(1, 4 * pins + 1).reshape(pins, 4).sum(axis=0) * 0.01 + pins * gear
    root = 1 / np.sqrt([*throws, 0.2])
    twist = np.diff(np.eye(5), axis=0)
    squares = np.linalg.eigvalsh(root[:, None] * (twist.T * [1e6, 2e6, 3e6, 1.2e6] @ twist) * root)
    assert frequencies(text) == pytest.approx(np.sqrt(squares[1:]) / (2 * np.pi), rel=1e-9)


def test_the_position_of_a_cylinder_moves_its_rod_and_not_its_throw(tmp_path):
    """Where [crank] places the throws, in a file as in its variants."""
    text = (
        "crank.stroke = 90\ncrank.throws = [0, 120, 240]\ncrank.spacing = 100\nrod.length = 150\n"
        "piston = { mass = 0.5, bore = 85 }\n[torsion]\nthrow_stiffness = [1e6, 2e6]\n"
        'throw_inertia = [20000, 30000, 60000]\nrear = [{ name = "wheel", inertia = 2e5, stiffness = 1.5e6 }]\n'
    )
    moved = text + "[cylinder.3]\nposition = -60\n"
    plain = frequencies(text)
    assert frequencies(moved) == pytest.approx(plain, rel=1e-12)
    file = write(tmp_path / "three.toml", moved)
    row = run_here("sweep", file, "--vary", "piston.mass=0.5", "-q", "torsion.1.Hz").out.splitlines()[1]
    assert float(row.split(",")[-1]) == pytest.approx(plain[0], rel=1e-12)
