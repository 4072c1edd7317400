"""The cases of `benchmark/`: where the data of each come from, what is asked, and what balcli answers.

`tools/benchmark_set.py` writes the folders from this list; `test_benchmark_set.py` compares them with balcli and with
calculations that know nothing but the folders and their README.
"""

import contextlib
import json
import os
import shlex
import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from balcli.engine.build import build
from balcli.engine.engine import Engine
from balcli.engine.parse import read
from balcli.field_balancing.runs_file import parse_runs
from balcli.mounting.build import build_mounted_body, read_mounted
from balcli.torsional_vibration.load import load_source

from .commands import run_here
from .paths import ROOT
from .published import Figure, load_problem

FOLDER = ROOT / "benchmark"
HEADS = ("quantity", "of", "part", "unit", "value", "tolerance")
EXACT = 1e-9  # tolerance of computed answers, as a share of the size of their quantity
WITHIN_DEG = 1e-6  # tolerance of computed angles, deg
ORDERS = (1, 2, 3, 4, 6)
COMPONENTS = {"force": ("force_N", "N"), "moment": ("moment_Nm", "N m")}
ABOUT_CRANK = {"couple": "couple_Nm", "torque": "inertia_torque_Nm", "roll": "roll_Nm"}


class Answer(NamedTuple):
    """A row of `answers.csv`.

    Attributes:
        quantity: what it is: a word of the README of the set.
        of: order, number of a mode, or name of a plane or device; empty for the whole.
        part: cos, sin, amplitude, largest, angle, ...; empty for a plain figure.
        unit: its unit, SI or degrees.
        value: its value.
        tolerance: largest difference that is right.
    """

    quantity: str
    of: str
    part: str
    unit: str
    value: float
    tolerance: float

    @property
    def key(self) -> tuple[str, str, str]:
        return self.quantity, self.of, self.part


@dataclass(frozen=True, slots=True)
class Case:
    """A case of the set.

    Attributes:
        folder: name of its folder, with its number.
        title: what is computed.
        chapter: a key of `CHAPTERS`.
        data: file of the data, relative to the project, or NAME:FILE of a published problem.
        command: command of balcli that answers it, with `data` for the file.
        asked: what the devices of a balancing case are, as in the README of the set.
        printed: for a published case, name of the figure that prints each answer, by key.
    """

    folder: str
    title: str
    chapter: str
    data: str
    command: str = ""
    asked: dict[str, Any] | None = None
    printed: dict[tuple[str, str, str], str] | None = None

    @property
    def grade(self) -> str:
        """Return A for computed figures, B for printed ones."""
        return "B" if self.printed else "A"

    @property
    def problem(self) -> str:
        """Return the name of the published problem; empty for an example."""
        return self.data.partition(":")[0] if ":" in self.data else ""

    @property
    def source(self) -> str:
        """Return where data and answers come from."""
        if self.problem:
            return _load(self.problem).source
        if self.data.startswith("engines/"):
            return f"example {Path(self.data).stem} of balcli: made-up masses; answers by two independent calculations"
        return "made up; answers by two independent calculations"

    @property
    def input_name(self) -> str:
        """Return the name of the TOML file of data, with its ending."""
        return f"{CHAPTERS[self.chapter].input_name}.toml"

    @property
    def plain_name(self) -> str:
        """Return the name of the plain JSON file."""
        return f"{CHAPTERS[self.chapter].input_name}.json"

    def read_files(self) -> dict[str, str]:
        """Return name and text of each file of data: those of an example, of a published problem, or of the folder."""
        if self.problem:
            files = dict(_load(self.problem).files)
            main = files.pop(self.data.partition(":")[2])
            others = {name: text for name, text in files.items() if name.endswith(".csv") and name in main}
            return {self.input_name: main.lstrip("\n"), **others}
        if self.data:
            return {self.input_name: (ROOT / self.data).read_text(encoding="utf-8")}
        return read_folder(self)

    def describe(self) -> dict[str, Any]:
        """Return the content of the plain JSON: SI values, without defaults and short forms."""
        head = {"title": self.title, "chapter": self.chapter, "grade": self.grade, "source": self.source}
        asked = {"asked": self.asked} if self.asked else {}
        with in_folder(self.read_files()):
            return head | asked | CHAPTERS[self.chapter].describe(self.input_name)

    def list_answers(self) -> list[Answer]:
        """Return the right answers: those in print, or balcli's."""
        computed = self.compute()
        if not self.printed:
            return computed
        figures = {figure.name: figure for figure in _load(self.problem).figures}
        by_key = {answer.key: answer for answer in computed}
        return [_take_printed(by_key[key], figures[name]) for key, name in self.printed.items()]

    def compute(self) -> list[Answer]:
        """Return balcli's answers."""
        return compute_answers(self, self.read_files())


@contextlib.contextmanager
def in_folder(files: dict[str, str]) -> Iterator[None]:
    """Work in an empty folder that has only these files."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            Path(folder, name).write_text(text, encoding="utf-8")
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)


def read_folder(case: Case) -> dict[str, str]:
    """Return name and text of the files of data in the folder of a case."""
    paths = [FOLDER / case.folder / case.input_name, *(FOLDER / case.folder).glob("*.csv")]
    return {path.name: path.read_text(encoding="utf-8") for path in paths if path.name != "answers.csv"}


def compute_answers(case: Case, files: dict[str, str]) -> list[Answer]:
    """Return balcli's answers to a case with these files of data."""
    with in_folder(files):
        status, out, err = run_here("-q", *shlex.split(case.command), "--format", "json")
    if status:
        raise AssertionError(f"{case.folder}: {err}")
    return _set_tolerances(CHAPTERS[case.chapter].answer(json.loads(out)), find_sizes(case.describe()))


def _load(name: str) -> Any:
    return load_problem(ROOT / "tests" / "published" / f"{name}.toml")


def _take_printed(computed: Answer, figure: Figure) -> Answer:
    """Return the printed figure in the unit of the computed answer, with half of its last digit as tolerance."""
    printed = float(figure.printed)
    half = 0.5 * 10.0 ** int(Decimal(figure.printed).as_tuple().exponent)
    tolerance = max(half, figure.within * abs(printed))
    return computed._replace(value=printed / figure.times, tolerance=tolerance / figure.times)


def _set_tolerances(answers: Iterable[Answer], sizes: dict[str, float]) -> list[Answer]:
    """Return answers with their tolerances: a share of the size of their unit, or of the largest answer in this unit."""
    rows = list(answers)
    largest = dict(sizes)
    for row in rows:
        if row.unit not in sizes:
            largest[row.unit] = max(largest.get(row.unit, 0.0), abs(row.value))
    with_tolerances = []
    for row in rows:
        tolerance = WITHIN_DEG if row.unit == "deg" else EXACT * largest[row.unit]
        with_tolerances.append(row._replace(tolerance=tolerance))
    return with_tolerances


def find_sizes(plain: dict[str, Any]) -> dict[str, float]:
    """Return the first-order force of the reciprocating mass of a cylinder, and its moment at the length of the engine:
    what balances is small against them, not against what is left.
    """
    if "cylinders" not in plain:
        return {}
    cylinders = plain["cylinders"]
    speed = plain["speed_rad_per_s"]
    places = [c["z_m"] for c in cylinders]
    arm = max(max(places) - min(places), 2 * cylinders[0]["crank_radius_m"])
    heaviest = max((c["reciprocating_kg"] + c["rotating_kg"]) * c["crank_radius_m"] for c in cylinders)
    return {"N": heaviest * speed**2, "N m": heaviest * speed**2 * arm}


# ------------------------------------------------------------------ engines: forces and moments
def describe_engine(name: str) -> dict[str, Any]:
    """Return speed, reference point, cylinders and devices of an engine file."""
    engine = build(read(name))
    devices = [
        {
            "order": int(device.order),
            "forward_kg_m": _pair(device.forward),
            "backward_kg_m": _pair(device.backward),
            "x_m": float(np.real(device.place)),
            "y_m": float(np.imag(device.place)),
            "z_m": float(device.z),
        }
        for device in engine.devices
    ]
    return {
        "speed_rad_per_s": float(engine.speed_rpm) * np.pi / 30,
        "reference_m": [float(v) for v in engine.reference_m],
        "cylinders": list(_describe_cylinders(engine)),
        "devices": devices,
    }


def _describe_cylinders(engine: Engine) -> Iterator[dict[str, Any]]:
    rows = engine.cylinders
    first_axis = float(rows.axis_deg[rows.first])
    for k, number in enumerate(engine.numbers):
        length = _take(rows.rod_length, k)
        yield {
            "number": number,
            "z_m": _take(rows.z, k),
            "axis_deg": _take(rows.axis_of_each_deg, k),
            "pin_deg": (first_axis + _take(rows.pin_deg, k)) % 360,
            "crank_radius_m": _take(rows.radius, k),
            "rod_length_m": length if np.isfinite(length) else None,
            "offset_m": _take(rows.offset, k),
            "reciprocating_kg": _take(rows.reciprocating, k),
            "rotating_kg": _take(rows.rotating, k),
            "rod_couple_kg_m2": _take(rows.couple, k),
        }


def _take(column: Any, row: int) -> float:
    """Return the figure of a row, in a column that may have one figure for all rows."""
    return float(column[row if len(column) > 1 else 0])


def _pair(value: Any) -> list[float]:
    return [float(np.real(value)), float(np.imag(value))]


def answer_forces(document: dict[str, Any]) -> Iterator[Answer]:
    """Yield components of each order, and the largest force and moment of a revolution."""
    for line in document["orders"]:
        yield from _list_order(line)
    for quantity, (key, unit) in COMPONENTS.items():
        if key in document["peak"]:
            yield Answer(quantity, "", "peak", unit, float(document["peak"][key]), 0.0)


def _list_order(line: dict[str, Any]) -> Iterator[Answer]:
    order = f"{line['order']:g}"
    for quantity, (key, unit) in COMPONENTS.items():
        if key not in line:
            continue
        forward, backward = (complex(*line[key][sense]) for sense in ("forward", "backward"))
        cos = forward + backward
        sin = 1j * (forward - backward)
        for axis, part in (("x", np.real), ("y", np.imag)):
            yield Answer(f"{quantity}_{axis}", order, "cos", unit, float(part(cos)), 0.0)
            yield Answer(f"{quantity}_{axis}", order, "sin", unit, float(part(sin)), 0.0)
            yield Answer(f"{quantity}_{axis}", order, "amplitude", unit, float(np.hypot(part(cos), part(sin))), 0.0)
        yield Answer(quantity, order, "forward", unit, abs(forward), 0.0)
        yield Answer(quantity, order, "backward", unit, abs(backward), 0.0)
        yield Answer(quantity, order, "largest", unit, abs(forward) + abs(backward), 0.0)
    for quantity, key in ABOUT_CRANK.items():
        for part in ("cos", "sin") if key in line else ():
            yield Answer(quantity, order, part, "N m", float(line[key][part]), 0.0)


# ------------------------------------------------------------------ balancing devices
def answer_devices(document: dict[str, Any]) -> Iterator[Answer]:
    """Yield unbalance and angle of each new device, and what is left of orders 1 and 2."""
    devices = [*document["counterweights"], *document["shafts"]]
    for number, device in enumerate(devices, 1):
        yield Answer("unbalance", str(number), "", "kg m", float(device["unbalance_kg_m"]), 0.0)
        yield Answer("angle", str(number), "", "deg", float(device["angle_deg"]) % 360, 0.0)
    for line in document["after"]["orders"]:
        for quantity, (key, unit) in COMPONENTS.items():
            if key in line:
                yield Answer(quantity, f"{line['order']:g}", "largest", unit, float(line[key]["major"]), 0.0)


# ------------------------------------------------------------------ torque of gas
def describe_gas(name: str) -> dict[str, Any]:
    """Return an engine with the pressure in its cylinders over the cycle angle."""
    engine = build(read(name))
    assert engine.gas is not None
    curve = engine.gas.cylinders[0].torque.pressure
    assert curve is not None
    points = [[float(np.degrees(a)), float(curve.at(a))] for a in curve.breaks]
    return {
        **describe_engine(name),
        "cycle_deg": engine.gas.cycle_deg,
        "bore_m": float(engine.bore_m),
        "crankcase_Pa": float(engine.gas.cylinders[0].torque.crankcase),
        "fires_deg": {str(n): float(np.degrees(a)) for n, a in zip(engine.numbers, engine.gas.fires, strict=True)},
        "pressure_deg_Pa": points,
    }


def answer_torque(document: dict[str, Any]) -> Iterator[Answer]:
    """Yield the mean torque, and the torque of gas and the whole torque by order."""
    yield Answer("mean_torque", "", "", "N m", float(document["mean_torque_Nm"]), 0.0)
    for line in document["orders"]:
        for quantity, key in (("gas_torque", "gas_torque_Nm"), ("total_torque", "torque_Nm")):
            for part in ("cos", "sin"):
                yield Answer(quantity, f"{line['order']:g}", part, "N m", float(line[key][part]), 0.0)


# ------------------------------------------------------------------ torsional vibration
def describe_chain(name: str) -> dict[str, Any]:
    """Return the inertias, shafts, gears and torques of a chain."""
    system = load_source(name).system({})
    chain = system.chain
    shafts = []
    gears = []
    for k, stiffness in enumerate(chain.stiffness.tolist()):
        ends = {"from": system.nodes[chain.start[k]], "to": system.nodes[chain.end[k]]}
        if np.isinf(stiffness):
            gears.append({**ends, "ratio": float(chain.ratio[k])})
        else:
            damping = float(system.damping.dashpots[k])
            shafts.append({**ends, "stiffness_Nm_per_rad": stiffness, "damping_Nms_per_rad": damping})
    nodes = [
        {"name": node, "inertia_kg_m2": inertia, "held": held}
        for node, inertia, held in zip(system.nodes, chain.inertia.tolist(), chain.clamped.tolist(), strict=True)
    ]
    return {"nodes": nodes, "shafts": shafts, "gears": gears, "torques": list(_describe_torques(system))}


def _describe_torques(system: Any) -> Iterator[dict[str, Any]]:
    excitation = system.excitation
    if excitation is None:
        return
    for order, row in zip(excitation.orders.tolist(), excitation.steady, strict=True):
        for node, torque in zip(excitation.nodes.tolist(), row.tolist(), strict=True):
            if torque:
                # Re(c e^(int)) = cos cos(nt) + sin sin(nt) with c = cos - i sin
                yield {"node": system.nodes[node], "order": order, "cos_Nm": torque.real, "sin_Nm": -torque.imag}


def answer_torsion(document: dict[str, Any]) -> Iterator[Answer]:
    """Yield the natural frequencies, and the vibratory torque of every shaft."""
    for number, mode in enumerate(document["modes"], 1):
        yield Answer("frequency", str(number), "", "Hz", float(mode["frequency_Hz"]), 0.0)
    response = document.get("response", {"shafts": (), "speeds_rpm": ()})
    for shaft in response["shafts"]:
        for rpm, torque in zip(response["speeds_rpm"], shaft["half_peak_to_peak_Nm"], strict=True):
            yield Answer("vibratory_torque", shaft["name"], f"{rpm:g} rpm", "N m", float(torque), 0.0)


# ------------------------------------------------------------------ mounts
def describe_body(name: str) -> dict[str, Any]:
    """Return the body and its mounts, in the axes of the engine."""
    model, _, _ = read_mounted(name)
    body, static, mounts, *_ = build_mounted_body(model)
    springs = [
        {
            "at_m": at.tolist(),
            "axes": axes.T.tolist(),
            "stiffness_N_per_m": stiffness.tolist(),
        }
        for at, axes, stiffness in zip(static.at, mounts.axes, mounts.stiffness, strict=True)
    ]
    return {
        "mass_kg": float(body.mass),
        "centre_m": body.centre.tolist(),
        "inertia_kg_m2": body.inertia.tolist(),
        "mounts": springs,
    }


def answer_mounts(document: dict[str, Any]) -> Iterator[Answer]:
    """Yield the natural frequencies."""
    for number, mode in enumerate(document["modes"], 1):
        yield Answer("frequency", str(number), "", "Hz", float(mode["frequency_Hz"]), 0.0)


# ------------------------------------------------------------------ field balancing
def describe_runs(name: str) -> dict[str, Any]:
    """Return the runs of a rotor: weights and readings as complex numbers, both angles in one direction."""
    file = parse_runs(Path(name).read_text(encoding="utf-8"))
    runs = []
    for run in file.run:
        weights = [file.turn(np.array([w]))[0] for w in file.list_weights(run)]
        told: dict[str, Any] = {"weights": [_pair(w) for w in weights]}
        if file.has_only_amplitudes:
            told["amplitudes"] = [float(np.real(v)) for v in run.readings]
        else:
            told["readings"] = [_pair(v) for v in run.readings]
        if run.speed is not None:
            told["speed_rpm"] = run.speed
        if run.keep_trial:
            told["stays"] = True
        runs.append(told)
    known = {} if file.influence is None else {"influence": [[_pair(c) for c in row] for row in file.influence]}
    return {"planes": list(file.planes), **known, "runs": runs}


def answer_field(document: dict[str, Any]) -> Iterator[Answer]:
    """Yield the correction weights, their angles, and the readings that remain."""
    for row in document["corrections"]:
        yield Answer("weight", row["plane"], "", "", float(row["weight"]), 0.0)
        yield Answer("angle", row["plane"], "", "deg", float(row["angle_deg"]) % 360, 0.0)


class Chapter(NamedTuple):
    """A kind of case: name of its file of data, its plain description, and balcli's answers."""

    input_name: str
    describe: Callable[[str], dict[str, Any]]
    answer: Callable[[dict[str, Any]], Iterator[Answer]]


CHAPTERS = {
    "forces": Chapter("engine", describe_engine, answer_forces),
    "devices": Chapter("engine", describe_engine, answer_devices),
    "torque": Chapter("engine", describe_gas, answer_torque),
    "torsion": Chapter("shaft", describe_chain, answer_torsion),
    "mounts": Chapter("engine", describe_body, answer_mounts),
    "field": Chapter("rotor", describe_runs, answer_field),
}


# ------------------------------------------------------------------ the cases
_FORCES = "analyze engine.toml --orders 1-4,6"


def _forces(folder: str, title: str, example: str) -> Case:
    return Case(folder, title, "forces", f"engines/{example}.toml", _FORCES)


# Published figures: the key of an answer, and the name of the figure that prints it.
_V16 = {
    ("moment_x", "1", "amplitude"): "moment of order 1, horizontal",
    ("moment_y", "1", "amplitude"): "moment of order 1, vertical",
    ("force_y", "2", "amplitude"): "force of order 2, horizontal",
    ("moment_y", "2", "amplitude"): "moment of order 2, horizontal",
    ("moment_x", "2", "amplitude"): "moment of order 2, vertical",
    ("moment_y", "4", "amplitude"): "moment of order 4, horizontal",
}


def _modes(count: int, name: str) -> dict[tuple[str, str, str], str]:
    """Return the names of printed frequencies, which count from 1."""
    return {("frequency", str(n), ""): name.format(n) for n in range(1, count + 1)}


def _published(
    folder: str,
    title: str,
    chapter: str,
    data: str,
    command: str,
    printed: dict[tuple[str, str, str], str],
    asked: dict[str, Any] | None = None,
) -> Case:
    return Case(folder, title, chapter, data, command, asked, printed)


def _ask(cancel: str, *devices: str) -> dict[str, Any]:
    """Return what is asked of devices, from `force+moment forward of order 1` and a `1 at z` for each device."""
    quantities, _, rest = cancel.partition(" ")
    senses, _, order = rest.rpartition(" of order ")
    rows = []
    for device in devices:
        turns, _, place = device.partition(" at ")
        rows.append({"order": int(turns), "z_m": float(place)})
    return {
        "order": int(order),
        "quantities": quantities.split("+"),
        "senses": senses.split("+"),
        "devices": rows,
    }


def _devices(folder: str, title: str, example: str, options: str, asked: dict[str, Any]) -> Case:
    """Return a case that sizes devices."""
    command = f"balance engine.toml {options} --orders 1,2"
    return Case(folder, title, "devices", f"engines/{example}.toml", command, asked)


def _made_up(folder: str, title: str, chapter: str, command: str) -> Case:
    return Case(folder, title, chapter, "", command)


CASES = (
    _forces("01-single", "single: every order of the force, and the roll", "single"),
    _forces("02-twin-270", "twin with a 270-degree crank", "twin270"),
    _forces("03-vee-twin-45", "vee twin of 45 degrees, both rods on one pin", "vtwin45"),
    _forces("04-boxer-twin", "boxer twin: moments, and no force", "boxer2"),
    _forces("05-inline-three", "in-line three: moments of orders 1 and 2", "i3"),
    _forces("06-inline-four", "in-line four: force and roll of order 2", "i4"),
    _forces("07-inline-five", "in-line five: hardly any moment of order 1", "i5"),
    _forces("08-vr6", "narrow vee of six with offset cylinders", "vr6"),
    _forces("09-v6-90", "V6 of 90 degrees with three common pins", "v6_90_common"),
    _forces("10-v8-cross-plane", "cross-plane V8", "v8_crossplane"),
    _forces("11-v10-split", "V10 of 90 degrees with split pins", "v10_split"),
    _forces("12-w12", "four banks of three", "w12"),
    _forces("13-radial-nine", "nine cylinders around one pin", "radial9"),
    _forces("14-inline-four-with-shafts", "in-line four with balancer shafts at +2 and -2", "i4_shafts"),
    _published(
        "15-v16-reciprocating",
        "V16: moments and forces of the reciprocating masses",
        "forces",
        "innio_v16_case_8207:osc.toml",
        "analyze engine.toml --orders 1,2,4",
        _V16,
    ),
    _published(
        "16-v16-rotating",
        "V16 with counterweights: moment of the rotating masses",
        "forces",
        "innio_v16_case_8207:rot.toml",
        "analyze engine.toml --orders 1",
        {("moment", "1", "largest"): "moment of the rotating masses"},
    ),
    _published(
        "17-marine-four",
        "marine engine with four cranks at right angles: primary couple",
        "forces",
        "sarkar_12_4:marine.toml",
        "analyze engine.toml --orders 1",
        {("moment_y", "1", "amplitude"): "largest primary couple"},
    ),
    _devices(
        "18-single-counterweight",
        "single: the counterweight that cancels the forward force of order 1",
        "single",
        "--scheme counterweights --planes throws",
        _ask("force forward of order 1", "1 at 0"),
    ),
    _devices(
        "19-single-with-shaft",
        "single: counterweight and shaft that cancel the force of order 1",
        "single",
        "--scheme single-shaft",
        _ask("force+moment forward+backward of order 1", "1 at -0.0435", "1 at 0.0435", "-1 at 0"),
    ),
    _devices(
        "20-inline-three-counterweights",
        "in-line three: counterweights at the end throws that cancel the forward moment of order 1",
        "i3",
        "--scheme counterweights --planes ends",
        _ask("force+moment forward of order 1", "1 at -0.082", "1 at 0.082"),
    ),
    _devices(
        "21-v8-counterweights",
        "cross-plane V8: counterweights at the end throws that cancel the moment of order 1",
        "v8_crossplane",
        "--scheme counterweights --planes ends",
        _ask("force+moment forward of order 1", "1 at -0.16764", "1 at 0.16764"),
    ),
    _devices(
        "22-inline-four-two-shafts",
        "in-line four: two shafts that cancel the force of order 2",
        "i4",
        "--scheme two-shaft --order 2 --position 0",
        _ask("force forward+backward of order 2", "-2 at 0", "2 at 0"),
    ),
    _published(
        "23-four-masses",
        "two masses in balance with two others in given planes: the angles of those",
        "devices",
        "sarkar_8_5:shaft.toml",
        "balance engine.toml --scheme counterweights --planes 0,1800",
        {
            ("unbalance", "1", ""): "mass of A at a radius of 100 mm",
            ("angle", "1", ""): "angle from B to A",
            ("angle", "2", ""): "angle from B to D",
        },
        _ask("force+moment forward of order 1", "1 at 0", "1 at 1.8"),
    ),
    _published(
        "24-two-thirds",
        "single with two thirds of the reciprocating mass balanced",
        "devices",
        "sarthaks_491921:single.toml",
        "balance engine.toml --factor 2/3 --planes throws",
        {("unbalance", "1", ""): "unbalance of the balance mass"},
    ),
    _made_up(
        "25-gas-of-a-single",
        "four-stroke single: torque of gas and inertia from a measured diagram",
        "torque",
        "torque engine.toml --orders 0.5-6",
    ),
    _made_up(
        "26-gas-of-a-four",
        "in-line four: torque by order, the cylinders fire one after the other",
        "torque",
        "torque engine.toml --orders 0.5-6",
    ),
    _made_up(
        "27-gas-of-a-two-stroke",
        "two-stroke twin: torque by order",
        "torque",
        "torque engine.toml --orders 1-6",
    ),
    _published(
        "28-five-discs",
        "five discs on four shafts",
        "torsion",
        "opentorsion_five_discs:discs.toml",
        "torsion shaft.toml",
        _modes(2, "mode {}"),
    ),
    _published(
        "29-equal-gears",
        "a motor drives two rotors, one through a pair of equal gears",
        "torsion",
        "friswell_geared_rotors:set.toml",
        "torsion shaft.toml",
        _modes(3, "natural frequency {}"),
    ),
    _published(
        "30-branched-gears",
        "a shaft drives two others through gears",
        "torsion",
        "friswell_9_6_3:set.toml",
        "torsion shaft.toml",
        _modes(3, "natural frequency {}"),
    ),
    _made_up(
        "31-uniform-chain",
        "five equal discs on equal shafts, one end held",
        "torsion",
        "torsion shaft.toml",
    ),
    _made_up(
        "32-forced-torsion",
        "three inertias: vibratory torque of their shafts at two speeds",
        "torsion",
        "torsion shaft.toml --speeds 1000,3000",
    ),
    _published(
        "33-powertrain-on-mounts",
        "powertrain on three turned mounts: six natural frequencies",
        "mounts",
        "saipa_quick_mounts:body.toml",
        "mounts engine.toml",
        _modes(6, "natural frequency {}"),
    ),
    _made_up(
        "34-block-on-mounts",
        "block on four equal mounts below its centre of mass",
        "mounts",
        "mounts engine.toml",
    ),
    _published(
        "35-one-plane-two-readings",
        "least squares of three readings with two planes, influence given",
        "field",
        "goodman_1964:runs.toml",
        "field rotor.toml",
        {("weight", "1", ""): "weight in plane 1", ("weight", "2", ""): "weight in plane 2"},
    ),
    _published(
        "36-two-planes",
        "corrections in two planes from readings at two bearings",
        "field",
        "bk_17_227_6:runs.toml",
        "field rotor.toml",
        {("weight", "1", ""): "weight in plane 1", ("weight", "2", ""): "weight in plane 2"},
    ),
    _published(
        "37-trial-weight-stays",
        "fan with two planes: the first trial weight stays on",
        "field",
        "feese_2004:runs.toml",
        "field rotor.toml",
        {("weight", "aft", ""): "weight in the aft plane", ("weight", "forward", ""): "weight in the forward plane"},
    ),
    _published(
        "38-two-speeds",
        "blower: least squares of readings at two speeds",
        "field",
        "jeong_2016_1:runs.toml",
        "field rotor.toml",
        {("weight", "1", ""): "weight in plane 1", ("weight", "2", ""): "weight in plane 2"},
    ),
    _made_up(
        "39-known-unbalance",
        "rotor with unbalances that are known: readings without error",
        "field",
        "field rotor.toml",
    ),
    _made_up(
        "40-without-phase",
        "fan without phase: four runs, unbalance known",
        "field",
        "field rotor.toml",
    ),
)
