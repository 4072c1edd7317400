"""Free forces and moments straight from the momentum of every part, on a grid of crank angles: the oracle.

Nothing here comes from `src/`, nor any formula of the theory: pistons are points, rods rigid bodies
with centre of mass and moment of inertia, places come from plain geometry (where a rod's circle
meets its cylinder's axis), velocities from differentiating those places by Fourier transform,
forces from differentiating momentum. The engine file is read by its own few lines too. Good to
about 1e-12 of the largest force for the lower orders.
"""

import math
import re
import tomllib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

POINTS = 1024
THETA = np.arange(POINTS) * (2 * np.pi / POINTS)
GRAVITY = 9.80665
# Units in the files of `engines`; a load of wheels may be in tonnes.
UNITS = {"in": 25.4, "km/h": 1, "mph": 1.609344, "kN": 1e3, "t": 1e3 * GRAVITY}


RATES = 1j * np.fft.fftfreq(POINTS, 1 / POINTS)  # of each wave of the samples
RATES[POINTS // 2] = 0


def slope(values: np.ndarray) -> np.ndarray:
    """Derivative by the crank angle of samples over one revolution."""
    result = np.fft.ifft(RATES * np.fft.fft(values))
    return result if np.iscomplexobj(values) else result.real


PISTON = ("mass", "piston", "pin", "rings", "locks")  # keys of [piston] that are masses


@dataclass
class Body:
    """A part: place of its centre of mass over the crank angle (m, x + iy), mass, and its turning about that centre."""

    place: np.ndarray
    z: float
    mass: float
    inertia: float = 0.0
    spin: np.ndarray | float = 0.0  # its angular velocity for a crank speed of 1
    point: complex | None = None  # devices: where their force acts; their own turning counts nowhere


@dataclass
class Curves:
    """Sums over the bodies of one engine or one cylinder, over THETA."""

    force: np.ndarray
    moment: np.ndarray
    couple: np.ndarray
    torque: np.ndarray

    @classmethod
    def none(cls) -> "Curves":
        return cls(0j * THETA, 0j * THETA, 0 * THETA, 0 * THETA)

    def __add__(self, other: "Curves") -> "Curves":
        return Curves(
            self.force + other.force,
            self.moment + other.moment,
            self.couple + other.couple,
            self.torque + other.torque,
        )

    @property
    def roll(self) -> np.ndarray:
        return self.couple - self.torque

    def order(self, quantity: str, n: int) -> tuple[complex, complex]:
        """Forward and backward vector of an order (a mean stands in forward alone)."""
        spectrum = np.fft.fft(getattr(self, quantity), norm="forward")
        return complex(spectrum[n]), complex(spectrum[-n]) if n else 0j


@dataclass
class Engine:
    """An engine file, read and set in motion."""

    data: dict[str, Any]
    cylinders: dict[int, list[Body]] = field(default_factory=dict)
    devices: list[Body] = field(default_factory=list)
    throws: list[float] = field(default_factory=list)

    @classmethod
    def read(cls, source: str | Path) -> "Engine":
        text = source.read_text(encoding="utf-8") if isinstance(source, Path) else source
        return cls(_bare(tomllib.loads(text)))

    def __post_init__(self) -> None:
        data = self.data
        self.speed = data.get("operation", {}).get("speed", 1000.0) * 2 * math.pi / 60
        self.rotary = data.get("layout", {}).get("rotary", False)
        self._arrange()
        for cell in self.cells:
            self._move(cell)
        for kind in ("counterweight", "shaft", "slider"):
            self.devices += [self._device(kind, table) for table in data.get(kind, [])]
        self._couple(data.get("locomotive", {}))
        reference = data.get("frame", {}).get("reference") or [0, 0, (min(self.throws) + max(self.throws)) * 500]
        self.at = complex(reference[0], reference[1]) / 1e3
        self.z = reference[2] / 1e3

    def _couple(self, table: dict[str, Any]) -> None:
        """Speed of a locomotive, and the coupling masses of its axles."""
        if "speed" in table:
            self.speed = table["speed"] / 3.6 / (table["wheel_diameter"] / 2e3)
        radius = table.get("coupling_radius", self.first["radius"] * 1e3)
        places = list(zip(table.get("coupling_planes", []), table.get("coupling_angles", []), strict=True))
        for axle in self.data.get("axle", []):
            for mass, (z, angle) in zip(_of_each(axle.get("coupling_mass", 0), 2), places, strict=True):
                pin = {"mass": mass, "radius": radius, "angle": angle, "position": z}
                self.devices.append(self._device("counterweight", pin))

    # -------------------------------------------------------------- where everything stands
    def _arrange(self) -> None:
        crank = self.data["crank"]
        layout = self.data.get("layout", {})
        order = layout.get("firing_order")
        banks = layout.get("banks", [0])
        if "bank_angle" in layout:
            banks = [-layout["bank_angle"] / 2, layout["bank_angle"] / 2]
        elif "radial" in layout:
            banks = [360 / layout["radial"] * k for k in range(layout["radial"])]
        shared = layout.get("rods", "shared") == "shared"
        rods = len(banks) if shared else 1
        rows = layout.get("rows", 1)
        count = len(crank["throws"]) if "throws" in crank else len(order) // rods if order else rows
        turn = layout.get("row_angle", 360 / len(banks) / count if "rows" in layout else 0)
        where = [(b, t) for b in range(len(banks)) for t in range(count) if shared or t % len(banks) == b]
        if "rows" in layout or "row_angle" in layout:
            where = sorted(where, key=lambda place: place[::-1])
        numbers = [n for row in layout["numbering"] for n in row] if "numbering" in layout else range(1, len(where) + 1)
        along = crank.get("positions") or [(t - (count - 1) / 2) * crank.get("spacing", 0) for t in range(count)]
        lean = layout.get("stagger", 0) if shared else 0
        card = self.data.get("bobweight", {})
        self.shells = card.get("rod_bearing", 0) + card.get("oil", 0)  # on each rod of a crank pin
        self.cells = []
        for (bank, throw), number in zip(where, numbers, strict=True):
            own = self.data.get("cylinder", {}).get(str(number), {})
            self.cells.append(
                {
                    "number": number,
                    "bank": bank,
                    "throw": throw,
                    "own": own,
                    "axis": own.get("bank", banks[bank] + turn * throw),
                    "radius": own.get("stroke", _of_each(crank["stroke"], count)[throw]) / 2e3,
                    "share": _of_each(crank.get("throw_mass", 0), count)[throw] / rods,
                    "z": own.get("position", along[throw] + (bank - (rods - 1) / 2) * lean) / 1e3,
                }
            )
        self.first = next(c for c in self.cells if c["number"] == 1)
        self._pins(order, layout, crank)
        for t in range(count):
            mine = [c for c in self.cells if c["throw"] == t]
            self.throws.append(sum(c["z"] - (c["bank"] - (rods - 1) / 2) * lean / 1e3 for c in mine) / len(mine))

    def _pins(self, order: list[int] | None, layout: dict[str, Any], crank: dict[str, Any]) -> None:
        splay = crank.get("splay", 0)
        throws = dict(enumerate(crank.get("throws", [0, 180])))
        if "throws" not in crank and order:
            cycle = 180 * layout.get("strokes", 4)
            steps = layout.get("firing_intervals", [cycle / len(order)] * len(order))
            fires = {n: sum(steps[:k]) for k, n in enumerate(order)}
            for c in reversed(self.cells):
                need = self._top(c) - self._top(self.first) - (fires[c["number"]] - fires[1])
                throws[c["throw"]] = need - c["bank"] * splay
        for c in self.cells:
            c["pin"] = c["own"].get("throw", throws[c["throw"]] + c["bank"] * splay)
        zero = self.first["pin"]
        for c in self.cells:
            c["pin"] -= zero

    def _top(self, cell: dict[str, Any]) -> float:
        """Direction of the crank pin when the piston is at the top."""
        piston, rod = self._parts(cell)
        if "articulation" in self.data and cell["bank"] != self.data["articulation"].get("master", 1) - 1:
            return cell["axis"]
        return cell["axis"] + math.degrees(math.asin(piston["offset"] / (cell["radius"] + rod["length"])))

    def _parts(self, cell: dict[str, Any]) -> tuple[dict[str, float], dict[str, float]]:
        """Piston (mass, offset) and rod (length, mass, cg from its lower end, inertia) of a cylinder, SI."""
        own = cell["own"]
        table = self.data.get("articulation")
        hung = table is not None and cell["bank"] != table.get("master", 1) - 1
        rod = dict(table["rod"] if hung and table else self.data["rod"])
        for group in (("length", "ratio"), ("mass", "cg", "small_end", "big_end"), ("inertia", "pendulum")):
            mine = {k: own["rod_" + k] for k in group if "rod_" + k in own}
            whole = set(mine) <= {"mass", "cg"}
            ends = set(mine) <= {"small_end", "big_end"}
            if mine and not (whole and "small_end" not in rod) and not (ends and "small_end" in rod):
                rod = {k: v for k, v in rod.items() if k not in group}
            rod |= mine
        length = rod["length"] / 1e3 if "length" in rod else cell["radius"] / rod.get("ratio", 1)
        if "small_end" in rod:
            mass = rod["small_end"] + rod["big_end"]
            cg = length * rod["small_end"] / mass if mass else 0.0
        else:
            mass = rod.get("mass", 0.0)
            cg = rod.get("cg", 0.0) / 1e3
        inertia = mass * cg * (length - cg)  # as two points at the ends
        if "inertia" in rod:
            inertia = rod["inertia"] / 1e6
        elif "pendulum" in rod:
            arm = cg if rod["pendulum"]["pivot"] == "big_end" else length - cg
            inertia = mass * GRAVITY * arm * rod["pendulum"]["period"] ** 2 / (4 * math.pi**2) - mass * arm**2
        piston = self.data["piston"]
        # A crosshead moves with its piston.
        crosshead = own.get("crosshead_mass", self.data.get("crosshead", {}).get("mass", 0.0))
        return (
            {
                "mass": own.get("piston_mass", sum(piston.get(k, 0) for k in PISTON)) + crosshead,
                "offset": own.get("piston_offset", piston.get("offset", 0)) / 1e3,
            },
            {"length": length, "mass": mass, "cg": cg, "inertia": inertia},
        )

    # -------------------------------------------------------------- motion
    def _axis(self, cell: dict[str, Any]) -> np.ndarray:
        return np.exp(1j * (math.radians(cell["axis"]) + self.rotary * THETA))

    def _pin(self, cell: dict[str, Any]) -> np.ndarray:
        angle = math.radians(self.first["axis"] + cell["pin"])
        return cell["radius"] * np.exp(1j * (angle + (0 if self.rotary else 1) * THETA))

    def _piston(self, cell: dict[str, Any], foot: np.ndarray) -> np.ndarray:
        """Where the rod that stands on `foot` meets the path of the piston pin."""
        piston, rod = self._parts(cell)
        axis = self._axis(cell)
        local = foot * np.conj(axis)
        offset = -piston["offset"] if self.rotary else piston["offset"]  # to where the crank pin moves
        if self.data["rod"].get("motion") == "harmonic":
            return axis * (local.real + rod["length"] + 1j * offset)
        return axis * (local.real + np.sqrt(rod["length"] ** 2 - (local.imag - offset) ** 2) + 1j * offset)

    def _move(self, cell: dict[str, Any]) -> None:
        foot = self._pin(cell)
        table = self.data.get("articulation")
        if table is not None and cell["bank"] != (master := table.get("master", 1) - 1):
            chief = next(c for c in self.cells if c["throw"] == cell["throw"] and c["bank"] == master)
            angle = table["knuckle_angles"][cell["bank"]] if "knuckle_angles" in table else cell["axis"] - chief["axis"]
            along = self._piston(chief, foot) - foot
            knuckle = table["knuckle_radius"] / 1e3 * np.exp(1j * math.radians(angle)) * along / np.abs(along)
            bodies = [Body(foot, cell["z"], cell["share"])]
            foot = foot + knuckle
        else:
            bodies = [Body(foot, cell["z"], cell["share"] + self.shells)]
        piston, rod = self._parts(cell)
        top = self._piston(cell, foot)
        direction = (top - foot) / rod["length"]
        spin = (np.conj(direction) * slope(direction)).imag
        bodies += [
            Body(top, cell["z"], piston["mass"]),
            Body(foot + rod["cg"] * direction, cell["z"], rod["mass"], rod["inertia"], spin),
        ]
        self.cylinders[cell["number"]] = bodies

    def _device(self, kind: str, table: dict[str, Any]) -> Body:
        size = table["unbalance"] / 1e6 if "unbalance" in table else table["mass"] * table["radius"] / 1e3
        angle = math.radians(table.get("angle", 0))
        point = complex(*table.get("at", [0, 0])) / 1e3
        if kind == "counterweight":
            place = np.exp(1j * (THETA + angle + math.radians(self.first["axis"])))
        elif kind == "shaft":
            place = np.exp(1j * (table["ratio"] * THETA + angle))
        else:
            place = np.cos(table["order"] * THETA + angle) * np.exp(1j * math.radians(table["direction"]))
        return Body(size * place, table.get("position", 0) / 1e3, 1.0, point=point)

    # -------------------------------------------------------------- results
    @property
    def _pace(self) -> np.ndarray:
        """Crank speed over its mean."""
        lines = self.data.get("operation", {}).get("speed_ripple", [])
        angles = (line["order"] * THETA - math.radians(line.get("angle", 0)) for line in lines)
        return 1 + sum((line["amplitude"] * np.cos(a) for line, a in zip(lines, angles, strict=True)), 0 * THETA)

    def curves(self, numbers: list[int] | None = None) -> Curves:
        """Of the whole engine, or of some cylinders without the devices."""
        total = sum((self._of_each[n] for n in numbers or self.cylinders), Curves.none())
        return total if numbers is not None else total + self._sum(self.devices)

    @cached_property
    def _of_each(self) -> dict[int, Curves]:
        """Of the parts of every cylinder."""
        return {number: self._sum(bodies) for number, bodies in self.cylinders.items()}

    def _sum(self, bodies: list[Body]) -> Curves:
        """Of some parts."""
        omega = self.speed * self._pace
        total = Curves.none()
        for body in bodies:
            velocity = slope(body.place)
            force = -body.mass * omega * slope(omega * velocity)
            total.force += force
            total.moment += 1j * (body.z - self.z) * force
            if body.point is not None:
                total.couple += (np.conj(body.point - self.at) * force).imag
                continue
            swirl = body.mass * (np.conj(body.place - self.at) * velocity).imag + body.inertia * body.spin
            energy = body.mass * np.abs(velocity) ** 2 + body.inertia * body.spin**2
            total.couple -= omega * slope(omega * swirl)
            total.torque -= 0.5 * slope(energy * omega**2)
        return total

    def scales(self) -> dict[str, float]:
        """Largest first-order amplitude of one cylinder alone; for turning quantities the largest
        of all three, any low order.
        """
        alone = [self.curves([n]) for n in self.cylinders]

        def largest(quantity: str, orders: range) -> float:
            return max(sum(map(abs, c.order(quantity, n))) for c in alone for n in orders)

        force = largest("force", range(1, 2))
        turning = max(largest(q, range(1, 5)) for q in ("couple", "torque", "roll"))
        moment = max(largest("moment", range(1, 2)), force * max(cell["radius"] for cell in self.cells))
        return {"force": force, "moment": moment, "couple": turning, "torque": turning, "roll": turning}


def _of_each(value: float | list[float], count: int) -> list[float]:
    """One figure for all throws, or a list of them."""
    return value if isinstance(value, list) else [value] * count


def _bare(value: Any) -> Any:
    """Numbers in the file's units; text that is a number with a unit is converted."""
    if isinstance(value, dict):
        return {
            k: v if k in ("name", "source", "rods", "pivot", "motion") else _bare(v)
            for k, v in value.items()
            if k not in ("gas", "torsion", "factor", "web")  # no free force; the only example's webs cancel each other
        }
    if isinstance(value, list):
        return [_bare(v) for v in value]
    if isinstance(value, str):
        number, unit = re.fullmatch(r"\s*([-+0-9./e]+)\s*(.+?)\s*", value).groups()
        top, _, below = number.partition("/")
        return float(top) / float(below or 1) * UNITS[unit]
    return value
