"""balcli against Exudyn: every example engine as a mechanism of rigid bodies, stepped in time.

Exudyn (https://exudyn.readthedocs.io) is an independent program for multibody dynamics. Every
engine file, also of several crankshafts, is built there as a whole and in three dimensions:

- One rigid body stands for each crankshaft, rod, piston and balancer shaft. Throw masses, bearing
  shells and counterweights are balls on the crankshaft. In a rotary engine the crankshaft is fixed,
  and the crankcase with its cylinders is a body that turns.
- The crankshaft turns in a bearing of the frame. Rods turn on crank pins, articulated rods on
  knuckle pins of their master rod. Pistons slide in guides of the frame, and piston pins join them
  to the rods. A Scotch yoke has a slot instead of a rod.
- A drive turns each crankshaft and each balancer shaft at a constant speed.
- The frame is a body as well. One joint with six components, the load cell, fixes it to the ground.

The mechanism starts from rest with a jerk. The integrator (generalized alpha: implicit, of second
order) damps it within `RUN_IN` steps. The following revolution is recorded: force and moment in the
load cell, and the torque of each drive. It is computed with each number of steps in `STEPS`, and
the orders are extrapolated to a step of zero (Richardson). Then

    force    = force of the load cell on the ground,
    moment   = its moment about x and y,
    roll     = its moment about z,
    torque   = minus the torque of the drive,
    couple   = roll + torque.

With several crankshafts, torque is the sum of all drives, each times its sense of rotation, and
couple is the moment of the load cell minus the torques of all drives; roll is then couple - torque,
because the load is on the first crankshaft.

Every order from 0 to `HIGHEST` is compared with `balcli.analyze` as a complex vector, so that
phases count. The speed is constant. Differences are relative to the largest order of the group,
which is force, moment, or turning (couple, torque and roll). A group that is balanced, or smaller
than a thousandth of what one cylinder does, is compared with this thousandth: `SMALL` times
`one_cylinder`.

The reader of `momentum` reads the numbers of the file (masses, lengths, angles). Plain geometry
places the parts at the start. After that Exudyn's joints find all places, velocities and
accelerations, and its equations of motion find all forces. Nothing comes from balcli.
"""

import math
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from oracle import momentum
from support.paths import ENGINE_FILES, ENGINES, GEARED_FILES

import balcli

exudyn = pytest.importorskip("exudyn")
items = pytest.importorskip("exudyn.itemInterface")
utilities = pytest.importorskip("exudyn.utilities")

pytestmark = pytest.mark.stress

TOLERANCE = 1e-6
HIGHEST = 8  # order
STEPS = (120, 160, 220, 300, 420, 580)  # in one revolution
RUN_IN = 30  # steps before it
SPECTRAL_RADIUS = 0.2  # of the integrator: the jerk of the start falls as 0.2^steps
SMALL = 1e-3  # share of one cylinder's force or moment below which a group counts as balanced
GROUPS = {"force": ("force",), "moment": ("moment",), "turning": ("couple", "torque", "roll")}
FILES = sorted(ENGINE_FILES + GEARED_FILES)

FIXED = [1, 1, 1, 1, 1, 1]  # held: x, y, z, and rotations about x, y, z
BEARING = [1, 1, 1, 1, 1, 0]
GUIDE = [0, 1, 1, 1, 1, 1]  # free along its own x axis
PIN = [1, 1, 0, 0, 0, 0]  # bearing and guide hold the other directions
SLOT = [1, 0, 0, 0, 0, 0]  # holds along the guide alone
ANGLE = 5  # number of a body's coordinate that is its angle about z


# ------------------------------------------------------------------ what an engine file contains
class NotBuiltError(Exception):
    """A table or key that is not built here."""


class Placed(NamedTuple):
    """One engine of a file, and where its crankshaft stands.

    Attributes:
        engine: Numbers of its file; its motion is not used.
        at: Place of its crank axis, m, x + iy.
        z: Axial place of its origin, m.
        turn: Angle by which it is turned about z, rad.
        ratio: 1, or -1 for the mirror image, which turns the other way.
        phase: Crank angle at the start, in its own sense of rotation, rad.
    """

    engine: momentum.Engine
    at: complex = 0j
    z: float = 0.0
    turn: float = 0.0
    ratio: int = 1
    phase: float = 0.0

    def point(self, place: complex, z: float) -> tuple[complex, float]:
        """Return a place of this engine's axes in the axes of the whole."""
        own = place if self.ratio == 1 else np.conj(place)
        return self.at + np.exp(1j * self.turn) * own, z + self.z

    def angle(self, angle: float) -> float:
        """Return an angle of this engine's axes in the axes of the whole."""
        return self.turn + self.ratio * angle


def read_engines(file: Path) -> list[Placed]:
    """Return the engine of a file, or the engines that it gears together."""
    tables = tomllib.loads(file.read_text(encoding="utf-8"))
    if "engine" not in tables:
        return [Placed(momentum.Engine.read(file))]
    unknown = tables.keys() - {"name", "source", "frame", "engine"} | tables.get("frame", {}).keys() - {"up"}
    if unknown:
        raise NotBuiltError(f"several engines with {', '.join(sorted(unknown))}")
    return [place_engine(file.parent, one) for one in tables["engine"]]


def place_engine(folder: Path, table: dict[str, Any]) -> Placed:
    """Return the engine of a table `[[engine]]`; the first one's crankshaft drives the load."""
    if "load" in table:
        raise NotBuiltError("the crankshaft that drives the load")
    x, y, z = (each / 1e3 for each in table.get("at", (0, 0, 0)))
    return Placed(
        momentum.Engine.read(folder / table["file"]),
        complex(x, y),
        z,
        math.radians(table.get("turn", 0)),
        table.get("ratio", 1),
        math.radians(table.get("phase", 0)),
    )


# ------------------------------------------------------------------ the mechanism in Exudyn
class Part(NamedTuple):
    """A body in Exudyn: number of the body and of its node."""

    body: int
    node: int


def solid(mass: float, inertia: float) -> Any:
    """Return the inertia of a body that is alike in all directions."""
    return utilities.RigidBodyInertia(mass=mass, inertiaTensor=inertia * np.eye(3), com=[0, 0, 0])


class Mechanism:
    """Bodies and joints in the frame.

    All bodies have the axes of the whole at the start, so that a joint needs only its place.

    Attributes:
        speed: Crank speed, rad/s.
        sensors: Force of the load cell, its moment, and then the torque of each drive.
        ratios: Speed of each driven crankshaft over that of the first.
    """

    def __init__(self, speed: float, place: complex, z: float) -> None:
        """Start with the frame, which the load cell holds at this place."""
        self.speed = speed
        self.container = exudyn.SystemContainer()
        self.system = self.container.AddSystem()
        self.sensors: list[int] = []
        self.ratios: list[int] = []
        ground = Part(self.system.CreateGround(), -1)
        self.still = self.system.AddNode(items.NodePointGround())
        self.frame = self.add_body(solid(1, 1), place, z)
        load_cell = self.add_joint(ground, self.frame, place, z, FIXED)
        self.record(load_cell, exudyn.OutputVariableType.ForceLocal)
        self.record(load_cell, exudyn.OutputVariableType.TorqueLocal)

    # -------------------------------------------------------------- parts
    def record(self, item: int, kind: Any) -> None:
        options = {"storeInternal": True, "writeToFile": False}
        sensor = items.SensorObject(objectNumber=item, outputVariableType=kind, **options)
        self.sensors.append(self.system.AddSensor(sensor))

    def add_body(self, inertia: Any, place: complex, z: float) -> Part:
        """Return a body whose coordinates are three translations and three angles."""
        made = self.system.CreateRigidBody(
            referencePosition=[place.real, place.imag, z],
            inertia=inertia,
            nodeType=exudyn.NodeType.RotationRxyz,
            returnDict=True,
        )
        return Part(made["bodyNumber"], made["nodeNumber"])

    def add_rotor(self, place: complex, z: float, masses: list[tuple[float, complex, float]]) -> Part:
        """Return a shaft with balls on it: mass, and place in the axes of the whole, of each."""
        inertia = solid(1, 1)  # on the axis: makes no force
        for mass, where, along in masses:
            if mass:
                arm = where - place
                ball = solid(mass, mass * abs(arm) ** 2)
                inertia = inertia + ball.Translated([arm.real, arm.imag, along - z])
        return self.add_body(inertia, place, z)

    def add_joint(self, one: Part, other: Part, place: complex, z: float, held: list[int], axis: float = 0) -> int:
        """Return a joint that holds directions of axes which are turned by `axis` about z."""
        c = math.cos(axis)
        s = math.sin(axis)
        return self.system.CreateGenericJoint(
            itemNumbers=[one.body, other.body],
            position=[place.real, place.imag, z],
            rotationMatrixAxes=np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
            constrainedAxes=held,
        )

    def drive(self, part: Part, speed: float) -> int:
        """Return a drive, which turns a body at constant speed, rad/s."""

        def turn(system: Any, time: float, item: int, offset: float) -> float:
            return speed * time

        markers = [
            self.system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=number))
            for node, number in ((self.still, 0), (part.node, ANGLE))
        ]
        drive = items.ObjectConnectorCoordinate(markerNumbers=markers, offsetUserFunction=turn)
        return self.system.AddObject(drive)

    def drive_and_record(self, part: Part, ratio: int) -> None:
        drive = self.drive(part, ratio * self.speed)
        self.record(drive, exudyn.OutputVariableType.Force)
        self.ratios.append(ratio)

    # -------------------------------------------------------------- an engine
    @classmethod
    def build(cls, engines: list[Placed]) -> "Mechanism":
        """Return the mechanism of engines; the load cell is at the reference of the first."""
        first = engines[0]
        built = cls(first.engine.speed, *first.point(first.engine.at, first.engine.z))
        for one in engines:
            built.add_engine(one)
        return built

    def add_engine(self, one: Placed) -> None:
        data = one.engine.data
        if "slider" in data or "speed_ripple" in data.get("operation", {}):
            raise NotBuiltError("sliders or an uneven speed")
        if is_rotary(one.engine) and any(weights_of(one.engine)):
            raise NotBuiltError("counterweights of a rotary engine")
        axis = one.point(0j, 0)
        crank = turning = self.add_crank(one)
        guides = self.frame
        if is_rotary(one.engine):
            self.add_joint(self.frame, crank, *axis, FIXED)
            turning = guides = self.add_body(solid(1, 1), *axis)
        self.add_joint(self.frame, turning, *axis, BEARING)
        self.drive_and_record(turning, one.ratio)
        self.add_cylinders(one, crank, guides)
        for table in data.get("shaft", []):
            self.add_shaft(one, table)

    def add_crank(self, one: Placed) -> Part:
        """Return the crankshaft with the masses at its pins and its counterweights."""
        engine = one.engine
        masses = [
            (cell["share"] + (0 if is_articulated(engine, cell) else engine.shells), pin_of(one, cell), cell["z"])
            for cell in engine.cells
        ]
        radius = engine.first["radius"]
        for table in weights_of(engine):
            angle = math.radians(engine.first["axis"] + table.get("angle", 0)) + one.phase
            place = radius * np.exp(1j * angle), table.get("position", 0) / 1e3
            masses.append((unbalance_of(table) / radius, *place))
        return self.add_rotor(*one.point(0j, 0), [(mass, *one.point(*where)) for mass, *where in masses])

    def add_shaft(self, one: Placed, table: dict[str, Any]) -> None:
        if one.ratio != 1 or one.phase:
            raise NotBuiltError("balancer shafts of an engine that is turned")
        axis = complex(*table.get("at", [0, 0])) / 1e3
        z = table.get("position", 0) / 1e3
        arm = unbalance_of(table) * np.exp(1j * math.radians(table.get("angle", 0)))  # of 1 kg
        places = one.point(axis, z), one.point(axis + arm, z)
        shaft = self.add_rotor(*places[0], [(1.0, *places[1])])
        self.add_joint(self.frame, shaft, *places[0], BEARING)
        self.drive(shaft, table["ratio"] * self.speed)

    def add_cylinders(self, one: Placed, crank: Part, guides: Part) -> None:
        """Add rods and pistons; masters first, because articulated rods hang on them."""
        engine = one.engine
        masters = {}
        for cell in sorted(engine.cells, key=lambda cell: is_articulated(engine, cell)):
            foot = pin_of(one, cell)
            if not is_articulated(engine, cell):
                top = piston_pin(one, cell, foot)
                masters[cell["throw"]] = self.add_cylinder(one, cell, crank, guides, foot, top), foot, top
                continue
            master, *rod = masters[cell["throw"]]
            foot = knuckle_of(engine, cell, *rod)
            self.add_cylinder(one, cell, master, guides, foot, piston_pin(one, cell, foot))

    def add_cylinder(
        self, one: Placed, cell: dict[str, Any], carrier: Part, guides: Part, foot: complex, top: complex
    ) -> Part:
        """Return the rod from `foot`, on a crank or master rod, to the piston pin at `top`."""
        figures, rod = one.engine._parts(cell)
        axis = one.angle(math.radians(cell["axis"]))
        z = cell["z"]
        piston = self.add_body(solid(figures["mass"], 0), *one.point(top, z))
        self.add_joint(guides, piston, *one.point(top, z), GUIDE, axis)
        if is_harmonic(one.engine):
            self.add_joint(piston, carrier, *one.point(foot, z), SLOT, axis)
            return piston
        centre = foot + (top - foot) * (rod["cg"] / rod["length"])
        body = self.add_body(solid(rod["mass"], rod["inertia"]), *one.point(centre, z))
        self.add_joint(carrier, body, *one.point(foot, z), BEARING)
        self.add_joint(body, piston, *one.point(top, z), PIN)
        return body

    # -------------------------------------------------------------- motion
    def run(self, steps: int) -> np.ndarray:
        """Return crank angle and recorded quantities of a revolution, (steps, 1 + quantities).

        Args:
            steps: Time steps in one revolution.
        """
        period = 2 * math.pi / self.speed
        total = steps + RUN_IN
        settings = exudyn.SimulationSettings()
        integration = settings.timeIntegration
        integration.numberOfSteps = total
        integration.endTime = period * total / steps
        integration.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
        integration.newton.useModifiedNewton = False  # which leaves larger residuals
        integration.verboseMode = 0
        settings.solution.sensors.writePeriod = period / steps
        settings.solution.file.write = False
        settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
        self.system.Assemble()
        if not self.system.SolveDynamic(settings):
            raise RuntimeError(f"Exudyn failed with {steps} steps")
        records = [self.system.GetSensorStoredData(sensor)[-steps:] for sensor in self.sensors]
        theta = self.speed * records[0][:, :1]
        return np.hstack([theta, *(record[:, 1:] for record in records)])

    def compute_orders(self, steps: int) -> np.ndarray:
        """Return complex orders, shape (orders, quantities).

        The quantities are x, y and z of the force on the ground and of the moment on it, and the
        torque of each drive.
        """
        theta, values = np.split(self.run(steps), [1], axis=1)
        signs = find_signs()
        values = values * np.append(signs[:6], np.repeat(signs[6], len(self.ratios)))
        return np.exp(-1j * np.arange(HIGHEST + 1)[:, None] * theta.T) @ values / steps


KNOWN_FORCE = (3.0, 5.0, 7.0)
KNOWN_MOMENT = (11.0, 13.0, 17.0)


@cache
def find_signs() -> np.ndarray:
    """Return the signs with which Exudyn's sensors count: force, moment and torque of a drive.

    They are read from a shaft at rest in the frame, which bears a known load. Exudyn's joint has
    another sign for the moment about x than for those about y and z.
    """
    bench = Mechanism(1.0, 0j, 0.0)
    shaft = bench.add_body(solid(1, 1), 0j, 0.0)
    bench.add_joint(bench.frame, shaft, 0j, 0.0, BEARING)
    bench.drive_and_record(shaft, 0)
    for part, moment in ((bench.frame, KNOWN_MOMENT), (shaft, (0.0, 0.0, 19.0))):
        marker = bench.system.AddMarker(items.MarkerBodyRigid(bodyNumber=part.body))
        bench.system.AddLoad(items.LoadTorqueVector(markerNumber=marker, loadVector=moment))
    bench.system.AddLoad(items.LoadForceVector(markerNumber=marker, loadVector=KNOWN_FORCE))
    read = bench.run(100)[-1, 1:]
    signs = read / np.array([*KNOWN_FORCE, *KNOWN_MOMENT, -19.0])
    assert np.abs(np.abs(signs) - 1).max() < 1e-9
    return np.sign(signs)


# ------------------------------------------------------------------ masses and places at the start
def is_rotary(engine: momentum.Engine) -> bool:
    return engine.data.get("layout", {}).get("rotary", False)


def is_harmonic(engine: momentum.Engine) -> bool:
    return engine.data["rod"].get("motion") == "harmonic"


def is_articulated(engine: momentum.Engine, cell: dict[str, Any]) -> bool:
    table = engine.data.get("articulation")
    return table is not None and cell["bank"] != table.get("master", 1) - 1


def weights_of(engine: momentum.Engine) -> Iterator[dict[str, Any]]:
    """Yield counterweights, and the coupling masses of a locomotive's axles."""
    yield from engine.data.get("counterweight", [])
    table = engine.data.get("locomotive", {})
    radius = table.get("coupling_radius", engine.first["radius"] * 1e3)
    places = list(zip(table.get("coupling_planes", []), table.get("coupling_angles", []), strict=True))
    for axle in engine.data.get("axle", []):
        for position, angle in places:
            mass = axle.get("coupling_mass", 0)
            yield {"mass": mass, "radius": radius, "angle": angle, "position": position}


def unbalance_of(table: dict[str, Any]) -> float:
    """Return mass times radius of a counterweight or balancer shaft, kg m."""
    if "unbalance" in table:
        return table["unbalance"] / 1e6
    return table["mass"] * table["radius"] / 1e3


def pin_of(one: Placed, cell: dict[str, Any]) -> complex:
    """Return the place of a cylinder's crank pin at the start, in its engine's axes."""
    return cell["radius"] * np.exp(1j * (math.radians(one.engine.first["axis"] + cell["pin"]) + one.phase))


def piston_pin(one: Placed, cell: dict[str, Any], foot: complex) -> complex:
    """Return the place of the piston pin at the start; the rod's lower end is at `foot`."""
    piston, rod = one.engine._parts(cell)
    axis = np.exp(1j * math.radians(cell["axis"]))
    offset = piston["offset"] * (-1 if is_rotary(one.engine) else 1)
    pin = foot / axis
    if is_harmonic(one.engine):
        return axis * (pin.real + rod["length"] + 1j * offset)
    return axis * (pin.real + math.sqrt(rod["length"] ** 2 - (pin.imag - offset) ** 2) + 1j * offset)


def knuckle_of(engine: momentum.Engine, cell: dict[str, Any], foot: complex, top: complex) -> complex:
    """Return the place of a knuckle pin on the master rod from `foot` to `top`."""
    table = engine.data["articulation"]
    master = next(
        other for other in engine.cells if other["throw"] == cell["throw"] and not is_articulated(engine, other)
    )
    angles = table.get("knuckle_angles")
    angle = cell["axis"] - master["axis"] if angles is None else angles[cell["bank"]]
    along = (top - foot) / abs(top - foot)
    return foot + table["knuckle_radius"] / 1e3 * np.exp(1j * math.radians(angle)) * along


# ------------------------------------------------------------------ orders of both programs
def extrapolate(values: list[np.ndarray]) -> np.ndarray:
    """Return the values for a step of zero; the error is a sum of h^2, h^3, h^4 and so on."""
    h = STEPS[0] / np.array(STEPS)
    powers = np.stack([h**0] + [h**k for k in range(2, len(h) + 1)], axis=1)
    return np.tensordot(np.linalg.inv(powers)[0], np.array(values), axes=1)


def simulate(engines: list[Placed]) -> dict[str, np.ndarray]:
    """Return the vectors of each quantity by Exudyn, forward and backward, (2, orders)."""
    runs = []
    for steps in STEPS:
        mechanism = Mechanism.build(engines)
        runs.append(mechanism.compute_orders(steps))
    fx, fy, _, mx, my, mz, *drives = extrapolate(runs).T
    torque = -sum(ratio * drive for ratio, drive in zip(mechanism.ratios, drives, strict=True))
    couple = mz - sum(drives)
    return {
        "force": vectors(fx, fy),
        "moment": vectors(mx, my),
        "couple": vectors(couple),
        "torque": vectors(torque),
        "roll": vectors(couple - torque),
    }


def vectors(x: np.ndarray, y: np.ndarray | float = 0.0) -> np.ndarray:
    """Return forward and backward vectors of x + iy; a mean is forward alone."""
    found = np.array([x + 1j * y, np.conj(x) + 1j * np.conj(y)])
    found[1, 0] = 0
    return found


def one_cylinder(engine: momentum.Engine) -> dict[str, float]:
    """Return the size of the force and moments of the first cylinder's reciprocating mass."""
    piston, rod = engine._parts(engine.first)
    radius = engine.first["radius"]
    mass = piston["mass"] + rod["mass"] * rod["cg"] / rod["length"]
    force = mass * radius * engine.speed**2
    arm = max(engine.throws) - min(engine.throws) or 2 * radius
    return {"force": force, "moment": force * arm, "turning": force * radius}


class Agreement(NamedTuple):
    """Largest relative difference of balcli and Exudyn for one engine file, by group.

    Attributes:
        file: Path of the file below the folder of examples.
        compared: What was built and compared.
        force: Relative difference of the force, or None.
        moment: Relative difference of the moment about x and y, or None.
        turning: Relative difference of couple, torque and roll, or None.
        reason: Why the file is left out, or empty.
    """

    file: str
    compared: str = ""
    force: float | None = None
    moment: float | None = None
    turning: float | None = None
    reason: str = ""


def compare_engine(file: Path) -> Agreement:
    """Return the agreement for one engine file."""
    name = file.relative_to(ENGINES).as_posix()
    try:
        engines = read_engines(file)
        exact = simulate(engines)
    except NotBuiltError as reason:
        return Agreement(name, reason=f"not built in Exudyn: {reason}")
    return Agreement(name, describe(engines), *compare(balcli.load(file), engines, exact))


def compare(engine: balcli.Engine, engines: list[Placed], exact: dict[str, np.ndarray]) -> list[float]:
    """Return the relative difference of each group.

    Args:
        engine: Engine of balcli.
        engines: The same as it was built in Exudyn.
        exact: Vectors of each quantity by Exudyn.
    """
    only = [kind for kinds in GROUPS.values() for kind in kinds]
    spectra = balcli.analyze(engine, orders=range(HIGHEST + 1), only=only).spectra
    sizes = one_cylinder(engines[0].engine)
    differences = []
    for group, kinds in GROUPS.items():
        largest = max(np.abs(exact[kind]).sum(axis=0).max() for kind in kinds)
        error = max(np.abs(getattr(spectra, kind).vectors - exact[kind]).max() for kind in kinds)
        differences.append(float(error / max(largest, SMALL * sizes[group])))
    return differences


def describe(engines: list[Placed]) -> str:
    """Return what was built, in words."""
    first = engines[0].engine
    count = sum(len(one.engine.cells) for one in engines)
    parts = [f"{count} cylinder{'s' if count > 1 else ''}"]
    if len(engines) > 1:
        parts.append(f"{len(engines)} crankshafts")
    if "articulation" in first.data:
        parts.append("articulated rods")
    if is_rotary(first):
        parts.append("rotary")
    if is_harmonic(first):
        parts.append("Scotch yokes")
    if any(weights_of(first)):
        parts.append("counterweights")
    if shafts := len(first.data.get("shaft", [])):
        parts.append(f"{shafts} balancer shaft{'s' if shafts > 1 else ''}")
    return ", ".join(parts)


def compare_engines() -> list[Agreement]:
    """Return the agreement for every example engine; takes about two minutes."""
    return [compare_engine(file) for file in FILES]


# ------------------------------------------------------------------ tests
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_example_engine(file):
    found = compare_engine(file)
    assert not found.reason
    assert max(found.force, found.moment, found.turning) < TOLERANCE


@pytest.fixture(scope="module")
def crossplane():
    """A four-cylinder engine with force, moment and torque left, and its vectors by Exudyn."""
    file = ENGINES / "i4_crossplane.toml"
    engines = read_engines(file)
    return file, engines, simulate(engines)


@pytest.mark.parametrize("key", ["crank.stroke", "rod.length", "rod.mass", "piston.mass"])
def test_a_change_of_a_hundred_thousandth_is_found(crossplane, key):
    """A length or mass that is 1e-5 larger in balcli's engine alone fails the comparison."""
    file, engines, exact = crossplane
    table, name = key.split(".")
    value = engines[0].engine.data[table][name] * (1 + 1e-5)
    assert max(compare(balcli.load(file).vary({key: value}), engines, exact)) > TOLERANCE
