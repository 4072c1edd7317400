"""List the parts of an engine that deviate independently within tolerances: pistons, rods, throws,
mounts, shafts and inertias. Every part has a list of the figures of the file that change with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from math import isfinite
from typing import NamedTuple

import numpy as np

from ..engine.build import assemble, build
from ..engine.parts import Parts
from ..file.model import Counterweight, EngineFile, Shaft, Slider
from ..file.table import label_table
from ..file.torsion_tables import Part
from ..torsional_vibration.throw_stiffness import (
    ThrowStiffness,
    find_throw_size,
    find_throw_stiffness,
)
from .quantity_names import ENGINE, MOUNTS, TORSION

# Keys of the masses and inertia of a rod, with the number of file units in one SI unit.
_ROD_UNITS = {"mass": 1.0, "small_end": 1.0, "big_end": 1.0, "inertia": 1e6}
_WHOLE_RING_DEG = 360.0  # a sector of this opening has no unbalance
OF_MOUNTS = 0.15
OF_SHAFTS = 0.05  # default tolerances of stiffness


@dataclass(frozen=True)
class Tolerances:
    """Largest deviations of each kind of part.

    Attributes:
        mass: Relative tolerance of piston, rod and throw masses, of the unbalances of devices, and
            of inertias.
        length: Relative tolerance of rod lengths. The other figures of a rod, such as its mass or
            the masses of its ends, do not change with the length.
        angle_deg: Tolerance of the angles of throws and devices.
        stiffness: Relative tolerance of the stiffness of mounts or shafts; None: OF_MOUNTS or
            OF_SHAFTS.
    """

    mass: float = 0.0
    length: float = 0.0
    angle_deg: float = 0.0
    stiffness: float | None = None


class Line(NamedTuple):
    """Dependence of a figure of the file on a deviation d: `value + slope d` in the file's unit."""

    value: float
    slope: float


class Source(NamedTuple):
    """A part that deviates independently of all others.

    Attributes:
        kind: What deviates, such as `piston mass` or `stiffness`.
        part: Number or name of the part, such as `3` or `left`.
        tolerance: Largest deviation, in `unit`.
        figures: Figures of the file that vary with the deviation, by dotted name.
        unit: Unit of the deviation, such as deg; empty for a relative deviation.
        group: Word before the number, if other parts of this kind have other words: `throw`.
        engine: Name of the engine, if the file has several.
        aspect: Word behind the number, such as the dimension that deviates: `thickness`.
        by_formulas: Whether the tolerance is half of the difference of two formulas.
    """

    kind: str
    part: str
    tolerance: float
    figures: Mapping[str, Line]
    unit: str = ""
    group: str = ""
    engine: str = ""
    aspect: str = ""
    by_formulas: bool = False

    @property
    def stem(self) -> str:
        """Name in tables without the part."""
        return " ".join(filter(None, (self.engine, self.kind, self.group)))

    @property
    def name(self) -> str:
        """Name in tables, such as `piston mass 3`, `stiffness left`, `stiffness throw 1-2` or `web
        3 thickness`.
        """
        return " ".join(filter(None, (self.stem, self.part, self.aspect)))

    @property
    def is_relative(self) -> bool:
        """Whether the deviation is a share of the figure."""
        return not self.unit


def _relative(
    kind: str, part: object, tolerance: float, figures: Mapping[str, float], group: str = ""
) -> Source:
    """Return a source whose figures are all proportional to 1 + deviation."""
    lines = {path: Line(value, value) for path, value in figures.items()}
    return Source(kind, str(part), tolerance, lines, group=group)


def find_sources(
    model: EngineFile, chapter: str, within: Tolerances
) -> tuple[EngineFile, tuple[Source, ...]]:
    """Return the file with a separate figure for each part, and the parts that deviate.

    Args:
        model: Engine file.
        chapter: Kind of quantities whose parts deviate: ENGINE (pistons, rods, throws and devices),
            MOUNTS or TORSION.
        within: Tolerances; parts with a tolerance of 0 are left out.
    """
    if model.engine and chapter == ENGINE:
        several, sources = _find_sources_of_several(model, within)
        return several, (*sources, *_drop_exact(_list_devices(model, within)))
    deviating: Iterator[Source]
    if chapter == MOUNTS:
        deviating = _list_mounts(model, within)
    elif chapter == TORSION:
        spread = _find_half_spread(model)
        model = _spell_out_shafting(model)
        deviating = _list_shafting(model, within, spread)
    else:
        model = _spell_out_throws(model, angles=bool(within.angle_deg))
        of_devices = _list_devices(model, within)
        deviating = chain(_list_parts(model, within), of_devices, _list_webs(model))
    return model, _drop_exact(deviating)


def _drop_exact(sources: Iterable[Source]) -> tuple[Source, ...]:
    """Return the parts whose tolerance is not 0."""
    return tuple(source for source in sources if source.tolerance)


def _find_sources_of_several(
    model: EngineFile, within: Tolerances
) -> tuple[EngineFile, tuple[Source, ...]]:
    """Return the file and the parts of geared engines; part names begin with the engine's name."""
    cranks = list[EngineFile]()
    sources = list[Source]()
    for k, (name, crank) in enumerate(zip(model.crank_names, model.cranks, strict=True), 1):
        own, found = find_sources(crank, ENGINE, within)
        cranks.append(own)
        for source in found:
            figures = {f"engine.{k}.{path}": line for path, line in source.figures.items()}
            sources.append(source._replace(engine=name, figures=figures))
    return model.with_cranks(cranks), tuple(sources)


# ------------------------------------------------------------------ pistons, rods and throws
def _spell_out_throws(model: EngineFile, *, angles: bool) -> EngineFile:
    """Return the file with a mass for every throw.

    Args:
        model: Engine file.
        angles: Whether to add the throw angles that the firing order needs, if none are given.
    """
    parts = assemble(model)
    masses = model.crank.throw_masses
    if len(masses) == 1 and not model.web:
        model = model.with_table("crank", throw_mass=masses * parts.plan.throws)
    if model.crank.throws is not None or not angles:
        return model
    return model.with_table("crank", throws=tuple(parts.pins.throws_deg.values()))


def _list_parts(model: EngineFile, within: Tolerances) -> Iterator[Source]:
    """Yield masses of pistons, rods and throws, lengths of rods, and angles of throws."""
    parts = assemble(model)
    yield from _list_masses(model, parts, within.mass)
    for n in sorted(parts.numbers):
        rod = parts.find_rod(n, n in parts.masters).rod
        if rod.length is None and rod.ratio is None:
            continue  # a rod in harmonic motion has no length
        length = 1e3 * float(rod.length_for(parts.find_radius(n)))
        yield _relative("rod length", n, within.length, {f"cylinder.{n}.rod_length": length})
    for k, angle in parts.pins.throws_deg.items():
        lines = {f"crank.throws.{k + 1}": Line(float(angle), 1.0)}
        numbers = [cell.number for cell in parts.plan.cells if cell.throw == k]
        for n in numbers:
            if (pin := parts.override(n, "throw")) is not None:
                lines[f"cylinder.{n}.throw"] = Line(float(pin), 1.0)
        if 1 in numbers:
            lines |= _hold_devices(model)
        yield Source("throw angle", str(k + 1), within.angle_deg, lines, "deg")


def _list_masses(model: EngineFile, parts: Parts, mass: float) -> Iterator[Source]:
    """Yield the masses of pistons, crossheads, rods and throws that are not 0."""
    yield from _list_pistons(model, mass)
    for n in sorted(parts.numbers):
        rod = parts.find_rod(n, n in parts.masters).rod
        figures = {
            f"cylinder.{n}.rod_{key}": unit * float(given)
            for key, unit in _ROD_UNITS.items()
            if (given := getattr(rod, key)) is not None
        }
        if any(figures.values()):
            yield _relative("rod mass", n, mass, figures)
    for k, given in enumerate(() if model.layout.rotary else model.crank.throw_masses, 1):
        if given:
            yield _relative("throw mass", k, mass, {f"crank.throw_mass.{k}": given})


def _list_pistons(model: EngineFile, mass: float) -> Iterator[Source]:
    """Yield the masses of pistons and crossheads that are not 0."""
    engine = build(model)
    for n, weighed in sorted(zip(engine.numbers, engine.weighed, strict=True)):
        if weighed.piston:
            figures = {f"cylinder.{n}.piston_mass": float(weighed.piston)}
            yield _relative("piston mass", n, mass, figures)
        if weighed.crosshead:
            figures = {f"cylinder.{n}.crosshead_mass": float(weighed.crosshead)}
            yield _relative("crosshead mass", n, mass, figures)


# ------------------------------------------------------------------ devices
def _list_devices(model: EngineFile, within: Tolerances) -> Iterator[Source]:
    """Yield the unbalances of counterweights, shafts and sliders that are not 0, and their
    angles.
    """
    kinds: dict[str, Sequence[Counterweight | Shaft | Slider]] = {
        "counterweight": model.counterweight,
        "shaft": model.shaft,
        "slider": model.slider,
    }
    for kind, tables in kinds.items():
        for number, table in enumerate(tables, 1):
            if isinstance(table, Shaft) and table.drifts:
                continue
            path = f"{kind}.{label_table(table, number)}"
            figures = {f"{path}.{key}": value for key, value in _find_weight(table).items()}
            if any(figures.values()):
                yield _relative(kind, number, within.mass, figures)
                lines = {f"{path}.angle": Line(table.angle, 1.0)}
                angle = f"{kind} angle"
                yield Source(angle, str(number), within.angle_deg, lines, "deg")


def _find_weight(table: Counterweight | Shaft | Slider) -> dict[str, float]:
    """Return the figure of a device's file to which its unbalance is proportional: the unbalance,
    the mass, or the thickness of its sector; empty for a shaft without an eccentric.
    """
    if table.unbalance is not None:
        return {"unbalance": table.unbalance}
    if table.mass is not None:
        return {"mass": table.mass}
    sector = None if isinstance(table, Slider) else table.sector
    if sector is not None and sector.thickness is not None and sector.opening < _WHOLE_RING_DEG:
        return {"sector.thickness": sector.thickness}
    return {}


def _hold_devices(model: EngineFile) -> dict[str, Line]:
    """Return the angle of each device as a function of the deviation of cylinder 1's throw. The
    file counts the angles from this throw; if the throw deviates, the functions keep the devices in
    place on the crank.
    """
    lines = {}
    for path, table in model.tables():
        if isinstance(table, (Counterweight, Shaft, Slider)):
            turns = getattr(table, "ratio", getattr(table, "order", 1))
            lines[f"{path}.angle"] = Line(table.angle, -float(turns))
    return lines


# ------------------------------------------------------------------ webs
_WEB_UNITS = {"thickness": "mm", "outer_radius": "mm", "opening": "deg", "density": ""}


def _list_webs(model: EngineFile) -> Iterator[Source]:
    """Yield the dimensions of each web that has tolerances; every web deviates by itself."""
    if not any(table.tolerance for table in model.web):
        return
    from ..engine.webs.dimensions import WebModel  # loaded only for files with [[web]]

    webs = build(model).webs
    for web in () if webs is None else webs.webs:
        table = model.web[web.table - 1]
        if table.tolerance is None or web.body.shape is None:
            continue
        for key in WebModel.of(table, web.body.shape).deviating:
            value = float(getattr(table, key))
            slope = 1.0 if _WEB_UNITS[key] else value
            lines = {f"webs.{web.number}.{key}": Line(value, slope)}
            tolerance = getattr(table.tolerance, key)
            aspect = key.replace("_", " ")
            unit = _WEB_UNITS[key]
            yield Source("web", str(web.number), tolerance, lines, unit, aspect=aspect)


# ------------------------------------------------------------------ mounts, shafts and inertias
def _list_mounts(model: EngineFile, within: Tolerances) -> Iterator[Source]:
    """Yield the stiffness of every mount; the three axes of a mount deviate together."""
    tolerance = OF_MOUNTS if within.stiffness is None else within.stiffness
    for number, mount in enumerate(model.mount, 1):
        label = label_table(mount, number)
        figures = {f"mount.{label}.stiffness.{k}": v for k, v in enumerate(mount.stiffness, 1)}
        yield _relative("stiffness", label, tolerance, figures)


def _find_throw(model: EngineFile) -> ThrowStiffness | None:
    """Return the stiffness of throws if it follows from dimensions, else None."""
    if model.torsion is None or model.torsion.given_stiffness:
        return None
    size = find_throw_size(model, build(model))
    return find_throw_stiffness(model.torsion, size, np.arange(1))


def _find_half_spread(model: EngineFile) -> float:
    """Return half of the relative difference of the two formulas by which the stiffness of throws
    follows from dimensions; 0 if the file gives the stiffness.
    """
    throw = _find_throw(model)
    return 0.0 if throw is None or throw.spread is None else throw.spread / 2


def _spell_out_shafting(model: EngineFile) -> EngineFile:
    """Return the file with separate stiffnesses and inertias for all throws."""
    torsion = model.torsion
    if torsion is None:
        return model
    throws = len(build(model).throws_m)
    throw = _find_throw(model)
    own = () if throw is None or throw.used is None else (throw.used,)
    stiffness = torsion.given_stiffness or own
    inertia = torsion.throw_inertia
    return model.with_table(
        "torsion",
        throw_stiffness=stiffness * (throws - 1) if len(stiffness) == 1 else stiffness,
        throw_inertia=inertia * throws if inertia and len(inertia) == 1 else inertia,
    )


def _find_shaft_figures(part: Part) -> dict[str, float]:
    """Return the figure to which the stiffness of a part's shaft is proportional, by its key: the
    stiffness, or the shear modulus of a plain shaft; empty for a rigid shaft.
    """
    if part.length is not None:
        return {"shear_modulus": part.shear_modulus}
    if part.stiffness is not None and isfinite(part.stiffness):
        return {"stiffness": part.stiffness}
    return {}


def _list_shafting(model: EngineFile, within: Tolerances, spread: float) -> Iterator[Source]:
    """Yield the stiffness of each shaft, the inertia of each node, and the mass of each piston.

    Args:
        model: File that gives a stiffness and an inertia for each throw.
        within: Tolerances.
        spread: Least tolerance of the stiffness of throws.
    """
    torsion = model.torsion
    mass = within.mass
    if torsion is None:
        return
    elastic = OF_SHAFTS if within.stiffness is None else within.stiffness
    for k, value in enumerate(torsion.given_stiffness, 1):
        path = f"torsion.throw_stiffness.{k}"
        tolerance = max(elastic, spread)
        of_throw = _relative("stiffness", f"{k}-{k + 1}", tolerance, {path: value}, "throw")
        yield of_throw._replace(by_formulas=spread > elastic)
    for k, value in enumerate(torsion.throw_inertia or (), 1):
        path = f"torsion.throw_inertia.{k}"
        yield _relative("inertia", k, mass, {path: value}, "throw")
    if not torsion.throw_inertia and model.crank.inertia is not None:
        yield _relative("inertia", "crankshaft", mass, {"crank.inertia": model.crank.inertia})
    for key, parts in (("front", torsion.front), ("rear", torsion.rear)):
        for k, part in enumerate(parts, 1):
            path = f"torsion.{key}.{k}"
            of_shaft = _find_shaft_figures(part)
            if of_shaft:
                figures = {f"{path}.{key}": value for key, value in of_shaft.items()}
                yield _relative("stiffness", part.name, elastic, figures)
            if part.inertia is not None:
                figures = {f"{path}.inertia": part.inertia}
                yield _relative("inertia", part.name, mass, figures)
    yield from _list_pistons(model, mass)
