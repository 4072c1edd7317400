"""The folders of `benchmark/` by calculations that know only their plain JSON and the README, and by balcli."""

import csv
import json
import runpy
from itertools import pairwise

import numpy as np
import pytest
from support.benchmark_set import CASES, FOLDER, Answer, compute_answers, read_folder

TURN = 1440  # samples of a revolution
ANGLE = np.arange(TURN) * 2 * np.pi / TURN


def load_plain(case):
    return json.loads((FOLDER / case.folder / case.plain_name).read_text(encoding="utf-8"))


def load_answers(case):
    with (FOLDER / case.folder / "answers.csv").open(encoding="utf-8") as file:
        return [
            Answer(r["quantity"], r["of"], r["part"], r["unit"], float(r["value"]), float(r["tolerance"]))
            for r in csv.DictReader(file)
        ]


def list_cases(*chapters, grades="AB"):
    return [pytest.param(c, id=c.folder) for c in CASES if c.chapter in chapters and c.grade in grades]


def find_misses(case, values):
    """Return the answers that these values miss; values have the keys of answers."""
    answers = load_answers(case)
    assert answers
    misses = []
    for answer in answers:
        difference = values[answer.key] - answer.value
        if answer.unit == "deg":
            difference = (difference + 180) % 360 - 180
        if not abs(difference) <= answer.tolerance:
            misses.append((answer, values[answer.key]))
    return misses


# ------------------------------------------------------------------ the set as a whole
def test_forty_cases_in_their_folders():
    folders = sorted(path.name for path in FOLDER.iterdir() if path.is_dir())
    assert folders == [case.folder for case in CASES]
    assert [int(name[:2]) for name in folders] == list(range(1, 41))


@pytest.mark.parametrize("case", [pytest.param(c, id=c.folder) for c in CASES])
def test_balcli_gives_the_answers(case):
    assert not find_misses(case, {a.key: a.value for a in compute_answers(case, read_folder(case))})


@pytest.mark.parametrize("case", [pytest.param(c, id=c.folder) for c in CASES])
def test_files_are_those_of_their_source(case):
    assert read_folder(case) == case.read_files()
    plain = case.describe()
    stored = load_plain(case)
    assert {k: stored[k] for k in ("title", "chapter", "grade", "source")} == {
        "title": case.title,
        "chapter": case.chapter,
        "grade": case.grade,
        "source": case.source,
    }
    assert flatten(stored) == pytest.approx(flatten(json.loads(json.dumps(plain))), rel=1e-12, abs=1e-15)


def flatten(node, path=""):
    """Return the numbers of a document by their paths."""
    if isinstance(node, dict):
        pairs = node.items()
    elif isinstance(node, list):
        pairs = enumerate(node)
    else:
        return {path: float(node)} if isinstance(node, int | float) else {}
    flat = {}
    for key, value in pairs:
        flat |= flatten(value, f"{path}/{key}")
    return flat


def test_script_of_the_set(capsys):
    runpy.run_path(str(FOLDER / "forces.py"))
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 14
    assert all(line.endswith(" 40 right") for line in lines)


# ------------------------------------------------------------------ engines: all motion sampled, differentiated by FFT
def slope(curve):
    """Return the derivative of a periodic curve."""
    return np.fft.ifft(1j * np.fft.fftfreq(len(curve), 1 / len(curve)) * np.fft.fft(curve))


class Motion:
    """Motion of an engine over a revolution, from its plain description."""

    def __init__(self, plain):
        self.speed = plain["speed_rad_per_s"]
        x, y, self.z = plain["reference_m"]
        self.at = x + 1j * y
        self.force = np.zeros(TURN, complex)
        self.moment = np.zeros(TURN, complex)
        self.momentum = np.zeros(TURN)
        self.energy = np.zeros(TURN)
        self.pistons = []  # distance of every piston pin from the crank axis
        for cylinder in plain["cylinders"]:
            self.add_cylinder(cylinder)
        for device in plain["devices"]:
            self.add_device(device)

    def add_cylinder(self, c):
        axis = np.exp(1j * np.radians(c["axis_deg"]))
        pin = c["crank_radius_m"] * np.exp(1j * (ANGLE + np.radians(c["pin_deg"])))
        own = pin / axis
        along = own.real
        tilt = np.zeros(TURN)
        if c["rod_length_m"]:
            side = c["offset_m"] - own.imag
            along = own.real + np.sqrt(c["rod_length_m"] ** 2 - side**2)
            tilt = np.arcsin(side / c["rod_length_m"])
        self.pistons.append(along)
        piston = axis * (along + 1j * c["offset_m"])
        for mass, place in ((c["rotating_kg"], pin), (c["reciprocating_kg"], piston)):
            self.add_mass(mass, place, c["z_m"])
        turning = slope(tilt).real * self.speed
        self.momentum -= c["rod_couple_kg_m2"] * turning
        self.energy -= c["rod_couple_kg_m2"] * turning**2 / 2

    def add_mass(self, mass, place, z):
        velocity = slope(place) * self.speed
        self.add_force(-mass * slope(velocity) * self.speed, z)
        self.momentum += mass * ((place - self.at).conj() * velocity).imag
        self.energy += mass * abs(velocity) ** 2 / 2

    def add_force(self, force, z):
        self.force += force
        self.moment += 1j * (z - self.z) * force

    def add_device(self, d):
        wave = np.exp(1j * d["order"] * ANGLE)
        unbalance = complex(*d["forward_kg_m"]) * wave + complex(*d["backward_kg_m"]) / wave
        force = (d["order"] * self.speed) ** 2 * unbalance
        self.add_force(force, d["z_m"])
        arm = d["x_m"] + 1j * d["y_m"] - self.at
        self.momentum -= np.fft.ifft(integrate((arm.conjugate() * force).imag)).real / self.speed

    @property
    def couple(self):
        return -slope(self.momentum).real * self.speed

    @property
    def torque(self):
        return -slope(self.energy).real

    def list_values(self):
        """Return every answer by its key."""
        values = {}
        for name, curve in (("force", self.force), ("moment", self.moment)):
            values[name, "", "peak"] = find_peak(curve)
            spectrum = np.fft.fft(curve) / TURN
            for n in range(1, 13):
                forward, backward = abs(spectrum[[n, -n]])
                sizes = {"forward": forward, "backward": backward, "largest": forward + backward}
                values |= {(name, str(n), part): size for part, size in sizes.items()}
            for axis, along in (("x", curve.real), ("y", curve.imag)):
                values |= list_components(f"{name}_{axis}", along)
        for name, curve in (("couple", self.couple), ("torque", self.torque), ("roll", self.couple - self.torque)):
            values |= list_components(name, curve)
        return values


def integrate(curve):
    """Return the spectrum of the integral of a curve without mean."""
    numbers = np.fft.fftfreq(len(curve), 1 / len(curve))
    numbers[0] = 1
    spectrum = np.fft.fft(curve) / (1j * numbers)
    spectrum[0] = 0
    return spectrum


def list_components(name, curve):
    spectrum = 2 * np.fft.fft(curve) / TURN
    values = {}
    for n in range(1, 13):
        parts = {"cos": spectrum[n].real, "sin": -spectrum[n].imag, "amplitude": abs(spectrum[n])}
        values |= {(name, str(n), part): value for part, value in parts.items()}
    return values


def find_peak(curve):
    """Return the largest magnitude over a revolution, between the samples as well."""
    numbers = np.fft.fftfreq(TURN, 1 / TURN)
    spectrum = np.fft.fft(curve) / TURN
    middle = ANGLE[np.argmax(abs(curve))]
    step = 2 * np.pi / TURN
    for _ in range(6):
        near = middle + np.linspace(-step, step, 41)
        sizes = abs(np.exp(1j * np.outer(near, numbers)) @ spectrum)
        middle = near[np.argmax(sizes)]
        step /= 10
    return sizes.max()


@pytest.mark.parametrize("case", list_cases("forces"))
def test_forces_by_sampled_motion(case):
    assert not find_misses(case, Motion(load_plain(case)).list_values())


@pytest.mark.parametrize("case", list_cases("devices", grades="A") + list_cases("devices", grades="B")[:1])
def test_devices_by_least_squares(case):
    plain = load_plain(case)
    asked = plain["asked"]
    motion = Motion(plain)
    n = asked["order"]
    reference = plain["reference_m"][2]
    rows = []
    wanted = []
    for quantity in asked["quantities"]:
        for sense in asked["senses"]:
            sign = 1 if sense == "forward" else -1
            vector = (np.fft.fft(getattr(motion, quantity)) / TURN)[sign * n]
            turns = [sign * n == d["order"] for d in asked["devices"]]
            arms = [1 if quantity == "force" else 1j * (d["z_m"] - reference) for d in asked["devices"]]
            rows.append(np.array(turns) * arms * (n * motion.speed) ** 2)
            wanted.append(-vector)
    unbalances = np.linalg.lstsq(np.array(rows, complex), np.array(wanted), rcond=None)[0]
    values = {}
    pin = plain["cylinders"][0]["pin_deg"]
    for number, (device, unbalance) in enumerate(zip(asked["devices"], unbalances, strict=True), 1):
        on_crank = device["order"] == 1
        values["unbalance", str(number), ""] = abs(unbalance)
        values["angle", str(number), ""] = np.degrees(np.angle(unbalance)) - (pin if on_crank else 0)
        motion.add_device(fit_device(device, unbalance))
    assert not find_misses(case, {**motion.list_values(), **values})


def fit_device(device, unbalance):
    """Return a device of the plain description that turns with this unbalance."""
    turning = [unbalance.real, unbalance.imag]
    senses = {"forward_kg_m": turning, "backward_kg_m": [0, 0]}
    if device["order"] < 0:
        senses = {"forward_kg_m": [0, 0], "backward_kg_m": turning}
    return {"order": abs(device["order"]), "x_m": 0.0, "y_m": 0.0, "z_m": device["z_m"], **senses}


# ------------------------------------------------------------------ torque of gas: Gauss points between the breaks
@pytest.mark.parametrize("case", list_cases("torque"))
def test_torque_by_quadrature(case):
    plain = load_plain(case)
    cycle = np.radians(plain["cycle_deg"])
    total = {}
    mean = 0.0
    for cylinder in plain["cylinders"]:
        angles, weights, pressure = list_gauss_points(plain["pressure_deg_Pa"])
        crank = angles + np.radians(plain["fires_deg"][str(cylinder["number"])])
        area = np.pi / 4 * plain["bore_m"] ** 2
        torque = -(pressure - plain["crankcase_Pa"]) * area * find_piston_slope(cylinder, crank)
        mean += weights @ torque / cycle
        for order in np.arange(1, 13) / 2:
            share = 2 / cycle * (weights * torque) @ np.exp(-1j * order * crank)
            total[order] = total.get(order, 0) + share
    inertia = Motion(plain).list_values()
    values = {("mean_torque", "", ""): mean}
    for order, vector in total.items():
        name = f"{order:g}"
        for part, gas in (("cos", vector.real), ("sin", -vector.imag)):
            values["gas_torque", name, part] = gas
            values["total_torque", name, part] = gas + inertia.get(("torque", name, part), 0)
    assert not find_misses(case, values)


def list_gauss_points(points):
    """Return angles, weights and pressures between the points of a polyline over a cycle."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    angles = []
    shares = []
    pressures = []
    for (a, p), (b, q) in pairwise(points):
        share = (nodes + 1) / 2
        angles.append(np.radians(a + share * (b - a)))
        shares.append(weights / 2 * np.radians(b - a))
        pressures.append(p + share * (q - p))
    return np.concatenate(angles), np.concatenate(shares), np.concatenate(pressures)


def find_piston_slope(c, crank):
    """Return the change of the distance of the piston pin from the crank axis per crank angle."""
    psi = crank + np.radians(c["pin_deg"] - c["axis_deg"])
    r = c["crank_radius_m"]
    side = r * np.sin(psi) - c["offset_m"]
    return -r * np.sin(psi) - side * r * np.cos(psi) / np.sqrt(c["rod_length_m"] ** 2 - side**2)


# ------------------------------------------------------------------ shafts: dense matrices
@pytest.mark.parametrize("case", list_cases("torsion"))
def test_torsion_by_dense_matrices(case):
    plain = load_plain(case)
    names = [node["name"] for node in plain["nodes"]]
    count = len(names)
    stiffness = np.zeros((count, count))
    damping = np.zeros((count, count))
    twists = {}
    for shaft in plain["shafts"]:
        row = np.zeros(count)
        row[names.index(shaft["to"])] += 1
        row[names.index(shaft["from"])] -= 1
        twists[f"{shaft['from']}-{shaft['to']}"] = (row, shaft)
        stiffness += shaft["stiffness_Nm_per_rad"] * np.outer(row, row)
        damping += shaft["damping_Nms_per_rad"] * np.outer(row, row)
    free = find_free_motions(plain, names)
    inertia = free.T @ np.diag([node["inertia_kg_m2"] for node in plain["nodes"]]) @ free
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(inertia, free.T @ stiffness @ free)).real)
    frequencies = [np.sqrt(s) / (2 * np.pi) for s in squares if s > 1e-6 * squares[-1]]
    values = {("frequency", str(k), ""): f for k, f in enumerate(frequencies, 1)}
    for answer in load_answers(case):
        if answer.quantity == "vibratory_torque":
            row, shaft = twists[answer.of]
            speed = float(answer.part.split()[0]) * np.pi / 30
            wave = np.zeros(200_000)
            for order in {torque["order"] for torque in plain["torques"]}:
                w = order * speed
                force = np.zeros(count, complex)
                for torque in plain["torques"]:
                    if torque["order"] == order:
                        force[names.index(torque["node"])] += torque["cos_Nm"] - 1j * torque["sin_Nm"]
                moved = np.linalg.solve(-(w**2) * inertia + 1j * w * damping + stiffness, force)
                through = (shaft["stiffness_Nm_per_rad"] + 1j * w * shaft["damping_Nms_per_rad"]) * (row @ moved)
                wave += (through * np.exp(1j * order * np.linspace(0, 2 * np.pi, len(wave)))).real
            values[answer.key] = (wave.max() - wave.min()) / 2
    assert not find_misses(case, values)


def find_free_motions(plain, names):
    """Return the motions of the nodes that gears and clamps allow, as columns."""
    rules = []
    for gear in plain["gears"]:
        row = np.zeros(len(names))
        row[names.index(gear["to"])] = 1
        row[names.index(gear["from"])] = -gear["ratio"]
        rules.append(row)
    for k, node in enumerate(plain["nodes"]):
        if node["held"]:
            rules.append(np.eye(len(names))[k])
    if not rules:
        return np.eye(len(names))
    _, sizes, vectors = np.linalg.svd(np.array(rules))
    return vectors[len(sizes) :].T


# ------------------------------------------------------------------ mounts and rotors
@pytest.mark.parametrize("case", list_cases("mounts"))
def test_mounts_by_dense_matrices(case):
    plain = load_plain(case)
    stiffness = np.zeros((6, 6))
    for mount in plain["mounts"]:
        arm = np.array(mount["at_m"]) - plain["centre_m"]
        x, y, z = arm
        turned = np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])  # displacement by small rotations
        for axis, k in zip(mount["axes"], mount["stiffness_N_per_m"], strict=True):
            row = np.concatenate([axis, np.array(axis) @ turned])
            stiffness += k * np.outer(row, row)
    mass = np.zeros((6, 6))
    mass[:3, :3] = plain["mass_kg"] * np.eye(3)
    mass[3:, 3:] = plain["inertia_kg_m2"]
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
    values = {("frequency", str(k), ""): np.sqrt(s) / (2 * np.pi) for k, s in enumerate(squares, 1)}
    assert not find_misses(case, values)


@pytest.mark.parametrize("case", list_cases("field"))
def test_rotors_by_least_squares(case):
    plain = load_plain(case)
    planes = len(plain["planes"])
    if "amplitudes" in plain["runs"][0]:
        weights = fit_without_phase(plain)
    else:
        influence, found = fit_influence(plain, planes)
        weights = np.linalg.lstsq(influence, -found, rcond=None)[0]
    values = {}
    for plane, weight in zip(plain["planes"], weights, strict=True):
        values["weight", plane, ""] = abs(weight)
        values["angle", plane, ""] = np.degrees(np.angle(weight))
    assert not find_misses(case, values)


def fit_influence(plain, planes):
    """Return influence coefficients and readings as found of all speeds, one below the other."""
    if "influence" in plain:
        influence = np.array([[complex(*c) for c in row] for row in plain["influence"]])
        return influence, np.array([complex(*v) for v in plain["runs"][0]["readings"]])
    blocks = []
    found = []
    for speed in dict.fromkeys(run.get("speed_rpm") for run in plain["runs"]):
        on = np.zeros(planes, complex)
        rows = []
        readings = []
        for run in plain["runs"]:
            if run.get("speed_rpm") != speed:
                continue
            now = on + [complex(*w) for w in run["weights"]]
            rows.append([1, *now])
            readings.append([complex(*v) for v in run["readings"]])
            if run.get("stays"):
                on = now
        solved = np.linalg.lstsq(np.array(rows), np.array(readings), rcond=None)[0]
        found.append(solved[0])
        blocks.append(solved[1:].T)
    return np.concatenate(blocks), np.concatenate(found)


def fit_without_phase(plain):
    """Return the correction of one plane, from three equal weights at 120 degrees and the rotor as found."""
    weights = np.array([complex(*run["weights"][0]) for run in plain["runs"]])
    squares = np.array([run["amplitudes"][0] for run in plain["runs"]]) ** 2
    size = abs(weights[1])
    gain = (squares[1:].mean() - squares[0]) / size**2
    unbalance = (squares[1:] @ weights[1:]) / (3 * size**2 * gain)
    return [-unbalance]
