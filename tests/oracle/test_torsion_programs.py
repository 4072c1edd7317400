"""`balcli torsion` against openTorsion: natural modes, damped poles, forced vibration of chains.

openTorsion (https://github.com/Aalto-Arotor/openTorsion) is an independent program for torsional
vibration. The chains are three discs of a textbook (docs/torsion.md), geared, branched, damped and
clamped chains, the crankshaft of `engines/i6_diesel.toml` alone and with a camshaft behind a gear,
and random chains. Each is built in openTorsion of discs, shafts and gears, from the tables of its
file. The following are compared:

- the natural frequencies, relative to each;
- the shapes of the modes, relative to the largest angle;
- the poles of the damped chain, that is frequency and decay, relative to each, or to a hundredth of
  the largest pole if that is more;
- forced vibration: at each speed of a range the sum of the amplitudes of all orders in each shaft,
  and the swing of the free end if a single order excites it; relative to the largest at all speeds.

All differences are below `TOLERANCE`.

openTorsion has no clamps, and no shaft whose ends turn at different speeds. The rows and columns of
clamped nodes are struck out of its matrices, and a massless wheel at the foot of a shaft stands for
its gear. It has viscous damping alone: a loss factor becomes the viscous damping `k loss / w` at
each frequency w, and chains with loss factors have no poles there. The torque of a shaft is
computed from the angles that openTorsion finds. The engine's cylinders excite its throws with the
torques of balcli; the inertia of its rods and pistons comes from their kinetic energy in
`momentum`.
"""

import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pytest
from oracle import momentum
from support.chains import chain_text, random_chain, random_damping
from support.paths import ENGINES

import balcli
from balcli.torsional_vibration.chain import Chain, Damping
from balcli.torsional_vibration.modes import find_chain_modes
from balcli.torsional_vibration.poles import find_chain_poles, find_poles

opentorsion = pytest.importorskip("opentorsion")

pytestmark = pytest.mark.stress

TOLERANCE = 1e-9
RPM = 2 * np.pi / 60  # rad/s


# ------------------------------------------------------------------ chains in openTorsion
class Joint(NamedTuple):
    """A shaft or, without stiffness, a mesh of gears.

    Attributes:
        start: Number of the node where it starts.
        end: Number of the node where it ends.
        ratio: Speed of the end over that of the start.
        stiffness: N m/rad at the speed of the end; infinite for a mesh.
        loss: Loss factor.
        dashpot: Damping of a dashpot between its ends, N m s/rad.
    """

    start: int
    end: int
    ratio: float = 1.0
    stiffness: float = np.inf
    loss: float = 0.0
    dashpot: float = 0.0


@dataclass
class Model:
    """A chain in the terms of openTorsion.

    Attributes:
        inertia: Moment of inertia of each node, kg m2.
        damping: Damping of each node against ground, N m s/rad.
        joints: Shafts and meshes.
        clamped: Numbers of the clamped nodes.
    """

    inertia: list[float]
    damping: list[float]
    joints: list[Joint]
    clamped: list[int]

    def __post_init__(self) -> None:
        self.shafts = [joint for joint in self.joints if np.isfinite(joint.stiffness)]
        self.program = self.assemble()
        self.lossy = self.assemble(lambda shaft: shaft.stiffness * shaft.loss)
        gears = self.program.gear_elements
        self.follow = np.eye(self.program.dofs) if gears is None else self.program.T(self.program.E())
        free = np.delete(np.arange(len(self.program.M)), self.clamped)  # clamped chains have no gears
        self.follow = self.follow[:, free]
        for program in (self.program, self.lossy):
            for name in "MCK":
                setattr(program, name, getattr(program, name)[np.ix_(free, free)])

    def assemble(self, stiffness=lambda shaft: shaft.stiffness) -> Any:
        """Return the chain as openTorsion's assembly, with this stiffness of each shaft."""
        discs = zip(self.inertia, self.damping, strict=True)
        discs = [opentorsion.Disk(k, inertia, c=c) for k, (inertia, c) in enumerate(discs)]
        shafts = []
        gears = []
        count = len(discs)
        for joint in self.joints:
            start = joint.start
            solid = joint.stiffness == np.inf
            if solid or joint.ratio != 1:
                foot, count = (joint.end, count) if solid else (count, count + 1)
                driver = opentorsion.Gear(start, 0, -joint.ratio)
                gears += [driver, opentorsion.Gear(foot, 0, 1.0, parent=driver)]
                start = foot
            if not solid:
                ends = sorted((start, joint.end))  # the last node must not be a left end
                shafts.append(opentorsion.Shaft(*ends, k=stiffness(joint), c=joint.dashpot))
        return opentorsion.Assembly(shafts, disk_elements=discs, gear_elements=gears or None)

    def find_modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return natural frequencies, rad/s, and shapes (modes, nodes), without rigid motions."""
        squares, vectors = self.program.undamped_modal_analysis()
        order = np.argsort(squares.real)
        omega = np.sqrt(squares.real[order].clip(0))
        shapes = (self.follow @ vectors[:, order]).T.real[:, : len(self.inertia)]
        twisting = omega > 1e-5 * omega[-1]
        return omega[twisting], scale(shapes[twisting])

    def find_poles(self) -> np.ndarray:
        """Return the poles of the damped chain, rad/s."""
        size, imaginary, ratio = self.program.modal_analysis()
        return -ratio * size + 1j * imaginary

    def respond(self, omegas: np.ndarray, torques: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return angles (frequencies, nodes) and torques of shafts (frequencies, shafts).

        Args:
            omegas: Frequencies, rad/s.
            torques: Torques on nodes, N m, complex, shape (frequencies, nodes).
        """
        loads = np.zeros((len(omegas), len(self.follow)), complex)
        loads[:, : len(self.inertia)] = torques

        def damping(w: float) -> np.ndarray:
            return self.program.C + self.lossy.K / w

        found, _ = self.program.ss_response((loads @ self.follow).T, omegas, C_func=damping)
        angles = (self.follow @ found).T
        torque = [
            (shaft.stiffness * (1 + 1j * shaft.loss) + 1j * omegas * shaft.dashpot)
            * (angles[:, shaft.end] - shaft.ratio * angles[:, shaft.start])
            for shaft in self.shafts
        ]
        return angles[:, : len(self.inertia)], np.transpose(torque)


def scale(shapes: np.ndarray) -> np.ndarray:
    """Return shapes whose largest angle is 1."""
    largest = np.abs(shapes).argmax(axis=1)[:, None]
    return shapes / np.take_along_axis(shapes, largest, axis=1)


# ------------------------------------------------------------------ chains in files
def read_chain(text: str) -> Model:
    """Return the chain of a file whose numbers are bare."""
    tables = tomllib.loads(text)
    names = [node["name"] for node in tables["node"]]

    def joint(table: dict[str, Any]) -> Joint:
        table = {"start": names.index(table["from"]), "end": names.index(table["to"]), **table}
        renamed = {"damping": "dashpot"}
        return Joint(**{renamed.get(k, k): v for k, v in table.items() if k not in ("from", "to")})

    return Model(
        [node.get("inertia", 0) / 1e6 for node in tables["node"]],
        [node.get("damping", 0) for node in tables["node"]],
        [joint(table) for table in [*tables.get("shaft", []), *tables.get("gear", [])]],
        [names.index(name) for name in tables.get("fixed", [])],
    )


def read_torques(text: str) -> tuple[np.ndarray, np.ndarray]:
    """Return orders, and torques on nodes (orders, nodes)."""
    tables = tomllib.loads(text)
    names = [node["name"] for node in tables["node"]]
    orders = sorted({table["order"] for table in tables["excitation"]})
    torques = np.zeros((len(orders), len(names)), complex)
    for table in tables["excitation"]:
        torque = table.get("cos", 0) - 1j * table.get("sin", 0)
        torques[orders.index(table["order"]), names.index(table["node"])] += torque
    return np.array(orders, float), torques


def read_engine(text: str) -> Model:
    """Return the chain of the crankshaft in an engine file, front to rear; numbers are bare."""
    engine = momentum.Engine.read(text)
    table = tomllib.loads(text)["torsion"]
    front = table.get("front", [])
    rear = table.get("rear", [])
    throws = len(engine.throws)
    nodes = [part["name"] for part in reversed(front)]
    nodes += [f"throw {k + 1}" for k in range(throws)] + [part["name"] for part in rear]
    inertia = dict.fromkeys(nodes, 0.0)
    damping = dict.fromkeys(nodes, 0.0)
    speed = dict.fromkeys(nodes, 1.0)
    loss = table.get("loss", 0)
    joints = []
    for k, own in enumerate(table["throw_inertia"]):
        inertia[f"throw {k + 1}"] = own / 1e6
    for cell in engine.cells:
        throw = f"throw {cell['throw'] + 1}"
        inertia[throw] += mean_inertia(engine.cylinders[cell["number"]][1:])
        damping[throw] += table.get("damping", 0)
    for k, stiffness in enumerate(table["throw_stiffness"], 1):
        numbers = nodes.index(f"throw {k}"), nodes.index(f"throw {k + 1}"), 1.0
        joints.append(Joint(*numbers, stiffness, loss))
    for parts, throw, place in ((front, "throw 1", 0), (rear, f"throw {throws}", None)):
        before = throw
        for part in parts:
            name = part["name"]
            foot = part.get("of", before)
            speed[name] = part.get("gear", speed[foot])
            inertia[name] = part["inertia"] / 1e6
            numbers = nodes.index(foot), nodes.index(name), speed[name] / speed[foot]
            joint = Joint(*numbers, part["stiffness"], part.get("loss", loss))
            joints.insert(len(joints) if place is None else place, joint)
            before = name
    return Model([*inertia.values()], [*damping.values()], joints, [])


def mean_inertia(bodies: Iterable[momentum.Body]) -> float:
    """Return the inertia at the crank with the mean kinetic energy of rods and pistons, kg m2."""
    return sum(
        np.mean(body.mass * np.abs(momentum.slope(body.place)) ** 2 + body.inertia * body.spin**2) for body in bodies
    )


def read_arrays(chain: Chain, damping: Damping) -> Model:
    shafts = zip(chain.start, chain.end, chain.ratio, chain.stiffness, strict=True)
    losses = zip(damping.loss, damping.dashpots, strict=True)
    joints = [Joint(*shaft, *loss) for shaft, loss in zip(shafts, losses, strict=True)]
    return Model(list(chain.inertia), list(damping.nodes), joints, [*np.flatnonzero(chain.clamped)])


THREE_DISCS = chain_text(
    {"1": 5, "2": 11, "3": 22},
    {("1", "2"): 0.10e6, ("2", "3"): 0.20e6},
    [("1", 2, 300)],
)
GEARED = chain_text(
    {"turbine": 40, "pinion": 2.5, "wheel": 90, "propeller": {"inertia": 700e6, "damping": 900}},
    {
        ("turbine", "pinion"): {"stiffness": 3.5e6, "loss": 0.01},
        ("wheel", "propeller"): {"stiffness": 8e6, "damping": 250},
    },
    [("propeller", 0.5, 40, 15), ("turbine", 1, 0, 60), ("turbine", 2, 25)],
    {("pinion", "wheel"): -0.125},
)
BRANCHED = chain_text(
    {
        "engine 1": {"inertia": 60e6, "damping": 40},
        "engine 2": {"inertia": 55e6, "damping": 40},
        "pinion 1": 3,
        "pinion 2": 3,
        "wheel": 120,
        "propeller": {"inertia": 400e6, "damping": 1500},
        "generator": 20,
    },
    {
        ("engine 1", "pinion 1"): {"stiffness": 0.9e6, "damping": 120},
        ("engine 2", "pinion 2"): {"stiffness": 1.0e6, "damping": 100},
        ("wheel", "propeller"): {"stiffness": 4e6, "damping": 300},
        ("wheel", "generator"): 1.5e6,
    },
    [("engine 1", 1.5, 700, 90), ("engine 2", 1.5, -200, 640), ("engine 1", 3, 1500)],
    {("pinion 1", "wheel"): -0.4, ("pinion 2", "wheel"): -0.4},
)
DAMPED = chain_text(
    {
        "ring": 0.08,
        "hub": {"inertia": 0.02e6, "damping": 1},
        "crank": {"inertia": 0.3e6, "damping": 6},
        "flywheel": 2,
    },
    {
        ("ring", "hub"): {"stiffness": 6e4, "loss": 0.15, "damping": 9},
        ("hub", "crank"): {"stiffness": 9e5, "loss": 0.03},
        ("crank", "flywheel"): {"stiffness": 1.4e6, "damping": 30},
    },
    [("crank", 3, 220, -40), ("crank", 4.5, 150), ("crank", 6, 30, 90)],
)
CLAMPED = chain_text(
    {"free": 3, "middle": {"inertia": 2e6, "damping": 5}, "wall": 0.5},
    {("free", "middle"): 4e5, ("middle", "wall"): {"stiffness": 2e5, "damping": 60}},
    [("free", 1, 80)],
    fixed=["wall"],
)
CHAINS = {
    "three discs (Thomson)": THREE_DISCS,
    "turbine, gear and propeller": GEARED,
    "two engines on one wheel, with branches": BRANCHED,
    "crankshaft with rubber damper": DAMPED,
    "clamped": CLAMPED,
}
ENGINE = (ENGINES / "i6_diesel.toml").read_text(encoding="utf-8")
CAMSHAFT = """
[[torsion.front]]
name = "camshaft"
of = "gear"
gear = -0.5
inertia = 6000
stiffness = 4.0e4
loss = 0.02
"""
ENGINE_CASES = {"i6_diesel": ENGINE, "i6_diesel with a camshaft": ENGINE + CAMSHAFT}
SPEEDS = {  # rpm
    "three discs (Thomson)": np.arange(600.0, 960, 20),
    "turbine, gear and propeller": np.arange(500.0, 4000, 131),
    "two engines on one wheel, with branches": np.arange(300.0, 1500, 41),
    "crankshaft with rubber damper": np.arange(800.0, 6000, 170),
    "clamped": np.arange(1000.0, 6000, 173),
    **dict.fromkeys(ENGINE_CASES, np.arange(1000.0, 2501, 60)),
}
KINDS = ("plain", "geared", "branched", "clamped", "clamped at both ends")


# ------------------------------------------------------------------ agreement
class Agreement(NamedTuple):
    """Largest relative differences of balcli and openTorsion for one chain.

    Attributes:
        chain: Name of the chain.
        modes: Number of modes that were compared.
        frequency: Relative difference of natural frequencies.
        shape: Difference of angles relative to the largest of the mode.
        pole: Relative difference of damped poles; None: the chain has loss factors, which make
            no poles in openTorsion.
        torque: Difference of torques in shafts relative to the largest; None: nothing excites it.
        swing: Difference of the free end's swing relative to the largest, or None.
    """

    chain: str
    modes: int
    frequency: float
    shape: float
    pole: float | None = None
    torque: float | None = None
    swing: float | None = None

    @property
    def largest(self) -> float:
        """Largest of all differences."""
        return max(each for each in self[2:] if each is not None)


def relative(found: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest difference relative to the largest value."""
    assert np.shape(found) == np.shape(exact)
    return float(np.abs(found - exact).max() / np.abs(exact).max())


def compare_modes(model: Model, omega: np.ndarray, shapes: np.ndarray) -> tuple[int, float, float]:
    """Return the number of modes and the differences of frequencies and shapes."""
    exact, exact_shapes = model.find_modes()
    assert len(omega) == len(exact)
    differences = np.abs(scale(shapes) - exact_shapes)
    return len(exact), float(np.abs(omega / exact - 1).max()), float(differences.max())


def compare_poles(model: Model, found: np.ndarray) -> float | None:
    """Return the difference of poles; rigid motions are left out.

    Both programs compute poles to rounding errors of the largest one, so that the smallest poles,
    of strongly damped motions, have fewer correct figures.
    """
    if any(shaft.loss for shaft in model.shafts):
        return None
    exact = model.find_poles()
    exact, found = (poles[np.abs(poles) > 1e-4 * np.abs(exact).max()] for poles in (exact, found))
    assert len(exact) == len(found)
    sizes = np.maximum(np.abs(exact), np.abs(exact).max() / 100)
    gaps = np.abs(exact[:, None] - found) / sizes[:, None]
    return float(max(gaps.min(axis=0).max(), gaps.min(axis=1).max()))


def compare_file(name: str, text: str) -> Agreement:
    """Return the agreement for a chain file or an engine file."""
    speeds = SPEEDS[name]
    found = balcli.torsion(text, speeds)
    nodes = len(found.nodes)
    if name in ENGINE_CASES:
        model = read_engine(text)
        excitation = found.system.excitation
        orders = excitation.orders
        sources = excitation.at(speeds * RPM)
        torques = np.zeros((len(orders), len(speeds), nodes), complex)
        for k, node in enumerate(excitation.nodes):
            torques[..., node] += sources[..., k]
    else:
        model = read_chain(text)
        orders, steady = read_torques(text)
        torques = np.repeat(steady[:, None], len(speeds), axis=1)
    responses = [model.respond(order * speeds * RPM, torque) for order, torque in zip(orders, torques, strict=True)]
    sums = sum(np.abs(torque) for _, torque in responses)
    told = [
        response.sum_of_amplitudes_Nm
        for response, shaft in zip(found.response.shafts, found.shafts, strict=True)
        if np.isfinite(shaft.stiffness_Nm_per_rad)
    ]
    swing = None
    if len(orders) == 1:
        swing = relative(found.response.free_end_deg, np.degrees(np.abs(responses[0][0][:, 0])))
    omega = 2 * np.pi * np.array([mode.frequency_Hz for mode in found.modes])
    return Agreement(
        name,
        *compare_modes(model, omega, np.array([mode.shape for mode in found.modes])),
        compare_poles(model, find_poles(found.system)),
        relative(np.transpose(told), sums),
        swing,
    )


def compare_random(kind: str, seed: int) -> Agreement:
    """Return the agreement of modes and poles for a random chain."""
    chain = random_chain(kind, seed)
    damping = random_damping(random_chain(kind, seed), seed)
    damping = damping._replace(loss=0 * damping.loss)
    model = read_arrays(chain, damping)
    modes = find_chain_modes(chain)
    return Agreement(
        f"random: {kind}, {seed}",
        *compare_modes(model, modes.omega[modes.rigid :], modes.shapes[modes.rigid :]),
        compare_poles(model, find_chain_poles(chain, damping)),
    )


def compare_chains() -> list[Agreement]:
    """Return the agreement for every chain; takes some seconds."""
    files = [compare_file(*case) for case in (CHAINS | ENGINE_CASES).items()]
    return files + [compare_random(kind, seed) for kind in KINDS for seed in range(8)]


# ------------------------------------------------------------------ tests
@pytest.mark.parametrize("name", CHAINS | ENGINE_CASES)
def test_file(name):
    assert compare_file(name, (CHAINS | ENGINE_CASES)[name]).largest < TOLERANCE


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(8))
def test_random_chain(kind, seed):
    assert compare_random(kind, seed).largest < TOLERANCE
