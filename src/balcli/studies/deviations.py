"""Engines of one file whose masses, rod lengths and throw angles deviate, as one engine with the
samples as its trailing axis.

Every piston, rod and throw deviates by itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np

from ..core.cylinders import Cylinders
from ..core.phasors import Array, Phasors
from ..engine.assembly import PISTON_PARTS
from ..engine.build import Engine, assemble, build
from ..engine.build_gas import build_gas
from ..engine.figures import RodFigures
from ..engine.gas import EngineGas
from ..engine.layout import plan_cylinders
from ..engine.rods import Weighed, weigh_rod
from ..enginefile.model import EngineFile
from ..errors import BalcliError, InputError
from ..forces.quantity import Quantity
from ..forces.spectrum import compute_spectra
from .deviating_gas import DeviatingGas

What = Literal["piston mass", "rod mass", "throw mass", "rod length", "throw angle"]
STEP = 1e-3  # of a tolerance, for derivatives; masses act linearly, so that theirs are exact


@dataclass(frozen=True)
class Tolerances:
    """Largest deviations: of masses and rod lengths relative to themselves, of throw angles in
    degrees. Of a longer rod stays what else the file says of it: mass and place of its centre of
    mass, or the masses of its ends.
    """

    mass: float = 0.0
    length: float = 0.0
    angle_deg: float = 0.0


class Source(NamedTuple):
    """One thing that deviates: what, of which cylinder or throw (from 1), and by how much."""

    what: What
    number: int
    tolerance: float

    @property
    def name(self) -> str:
        """As tables have it: `piston mass 3`."""
        return f"{self.what} {self.number}"

    @property
    def relative(self) -> bool:
        """Whether it deviates by a share of itself; else by degrees."""
        return self.what != "throw angle"


class DeviatingEngine:
    """An engine file and what may deviate from it.

    Attributes:
        sources: what deviates; tolerances of 0 and parts without mass are left out.

    Raises:
        BalcliError: the cylinders turn, rods might lock, or nothing deviates.
    """

    def __init__(self, model: EngineFile, tolerances: Tolerances) -> None:
        if model.layout.rotary:
            raise BalcliError(
                "there is no scatter of rotary engines, whose masses move on curves: vary single "
                "masses with sweep"
            )
        self._model, self._engine = model, build(model, rank=1)
        parts = assemble(model)
        self._radius = parts.radius
        self._rows_of_rods: dict[RodFigures, list[int]] = {}
        for row, n in enumerate(self._engine.numbers):
            rod = parts.rod_place(n, n in parts.masters).rod
            self._rows_of_rods.setdefault(rod, []).append(row)
        if tolerances.length:
            self._refuse_locks(tolerances.length)
        self._gas = None if model.gas is None else DeviatingGas(model, tolerances.length)
        cells = {cell.number: cell for cell in plan_cylinders(model.crank, model.layout).cells}
        self._throws = [cells[number].throw + 1 for number in self._engine.numbers]
        c = self._engine.cylinders
        without_pistons = build(_without_pistons(model), rank=1).cylinders
        without_throws = build(_without_throws(model), rank=1).cylinders
        self._pistons = self._of_each(c.reciprocating - without_pistons.reciprocating)
        self._webs = self._of_each(c.rotating - without_throws.rotating)
        self._hung = np.array([[n in parts.masters] for n in self._engine.numbers])
        self._of_file = self._weigh_rods(np.zeros((1, 1)))
        self.sources = tuple(self._find_sources(tolerances))
        if not self.sources:
            raise BalcliError("nothing deviates; give a tolerance, such as --mass-scatter 0.5%")

    def _refuse_locks(self, tolerance: float) -> None:
        """BalcliError where rods cannot be shorter by twice their tolerance, beyond which next to
        none is.
        """
        shortest = max(1 - 2 * tolerance, 1e-3)
        lengths = {
            f"cylinder.{self._engine.numbers[row]}.rod_length": (
                1e3 * shortest * rod.length_for(self._radius)
            )
            for rod, rows in self._rows_of_rods.items()
            for row in rows
        }
        try:
            assemble(self._model, lengths, rank=1)
        except InputError as error:
            raise BalcliError(
                f"--length-scatter {100 * tolerance:g}%: rods shorter by twice as much cannot be "
                f"({error.problems[0].message}); give a smaller one"
            ) from None

    def _of_each(self, rows: Array) -> Array:
        """One row a cylinder, shape (cylinders, 1)."""
        return np.broadcast_to(rows, (len(self._throws), rows.shape[1]))

    def _find_sources(self, tolerances: Tolerances) -> Iterator[Source]:
        cylinders = sorted(self._engine.numbers)
        throws = range(1, max(self._throws) + 1)
        if mass := tolerances.mass:
            if self._pistons.any():
                yield from _of_all("piston mass", cylinders, mass)
            if self._of_file[:2].any():
                yield from _of_all("rod mass", cylinders, mass)
            if self._webs.any():
                yield from _of_all("throw mass", throws, mass)
        if tolerances.length:
            yield from _of_all("rod length", cylinders, tolerances.length)
        if tolerances.angle_deg:
            yield from _of_all("throw angle", throws, tolerances.angle_deg)

    def deviate(self, deviations: Array) -> Engine:
        """Engines with deviations of the sources, shape (sources, samples); masses and lengths
        relative, angles in degrees.
        """
        c = self._engine.cylinders
        rod = self._of_cylinders("rod mass", deviations)
        piston = self._of_cylinders("piston mass", deviations) * self._pistons
        web = self._of_cylinders("throw mass", deviations) * self._webs
        longer = self._of_cylinders("rod length", deviations)
        ahead_deg = self._of_cylinders("throw angle", deviations)
        length = 1 + longer
        small_end, big_end, couple = (1 + rod) * self._weigh_rods(longer) - self._of_file
        cylinders = replace(
            c,
            reciprocating=c.reciprocating + piston + small_end,
            rotating=c.rotating + web + np.where(self._hung, 0.0, big_end),
            couple=c.couple + couple,
            lam=c.lam / length,
            eps=c.eps / length,
            pin_deg=c.pin_deg + ahead_deg,
            linkage=c.linkage
            and replace(c.linkage, mass=c.linkage.mass + np.where(self._hung, big_end, 0.0)),
        )
        engine = replace(self._engine, cylinders=cylinders)
        if self._gas is None:
            return engine
        gas = self._gas
        return replace(
            engine, gas_of_variants=lambda orders: gas.find_torque(orders, longer, ahead_deg)
        )

    def _weigh_rods(self, longer: Array) -> Array:
        """Masses at the small and at the big ends, and couples, of rods that are longer by a share
        of themselves (cylinders or 1, samples), shape (3, cylinders, samples).
        """
        each = np.broadcast_to(longer, (len(self._throws), longer.shape[1]))
        weighed = np.empty((3, *each.shape))
        for rod, rows in self._rows_of_rods.items():
            gear = weigh_rod(rod, rod.length_for(self._radius) * (1 + each[rows]))
            weighed[0, rows], weighed[1, rows] = gear.small_end, gear.big_end
            weighed[2, rows] = gear.couple
        return weighed

    def deviate_one(self, deviations: Array) -> Engine:
        """One engine without trailing axes, its gas and all, with deviations (sources,) as of
        `deviate`.
        """
        column = deviations[:, None]
        several, single = self.deviate(column).cylinders, self._single
        linkage = single.cylinders.linkage
        if linkage is not None and several.linkage is not None:
            linkage = replace(linkage, mass=several.linkage.mass[:, 0])
        cylinders = replace(
            single.cylinders,
            reciprocating=several.reciprocating[:, 0],
            rotating=several.rotating[:, 0],
            couple=several.couple[:, 0],
            lam=several.lam[:, 0],
            eps=several.eps[:, 0],
            pin_deg=several.pin_deg[:, 0],
            linkage=linkage,
        )
        engine = replace(single, cylinders=cylinders, weighed=self._weigh(column), model=None)
        if single.gas is None:
            return engine
        return replace(engine, gas=self._move_gas(single.gas, cylinders, column))

    def _weigh(self, column: Array) -> tuple[Weighed, ...]:
        """Masses of every cylinder with deviations (sources, 1)."""
        count = len(self._throws)
        whats: tuple[What, ...] = ("piston mass", "rod mass", "throw mass")
        pistons, rods, throws = (
            np.broadcast_to(1 + self._of_cylinders(what, column)[:, 0], count).tolist()
            for what in whats
        )
        ends = self._weigh_rods(self._of_cylinders("rod length", column))[:2, :, 0].tolist()
        return tuple(
            w._replace(
                piston=w.piston * pistons[row],
                piston_parts=tuple((key, mass * pistons[row]) for key, mass in w.piston_parts),
                small_end=ends[0][row] * rods[row],
                big_end=ends[1][row] * rods[row],
                share=w.share * throws[row],
            )
            for row, w in enumerate(self._single.weighed)
        )

    def _move_gas(self, gas: EngineGas, cylinders: Cylinders, column: Array) -> EngineGas:
        """With deviations (sources, 1): other rods have other torques, a throw that stands ahead
        has its cylinders fire ahead.
        """
        if self._of_cylinders("rod length", column).any():
            return build_gas(assemble(self._model), cylinders)
        ahead = np.broadcast_to(self._of_cylinders("throw angle", column), (len(self._throws), 1))
        moved = zip(gas.cylinders, ahead[:, 0].tolist(), strict=True)
        return replace(
            gas,
            cylinders=tuple(
                cylinder._replace(nominal_deg=(cylinder.nominal_deg - angle) % gas.cycle_deg)
                for cylinder, angle in moved
            ),
        )

    @cached_property
    def _single(self) -> Engine:
        """As the file has it, without trailing axes."""
        return build(self._model)

    def _of_cylinders(self, what: What, deviations: Array) -> Array:
        """Deviations as the cylinders have them, shape (cylinders, samples); a single 0 where this
        does not deviate.
        """
        rows = {source.number: k for k, source in enumerate(self.sources) if source.what == what}
        if not rows:
            return np.zeros((1, 1))
        owners = self._throws if what.startswith("throw") else self._engine.numbers
        return deviations[[rows[owner] for owner in owners]]

    def find_slopes(self, quantity: Quantity) -> tuple[Phasors, Phasors]:
        """The nominal vectors of a quantity's order, shape (1, 1), and their changes by each
        source's tolerance, shape (1, sources).
        """
        steps = np.diag([STEP * source.tolerance for source in self.sources])
        up, down, nominal = (
            compute_spectra(self.deviate(d), [quantity.order], [quantity.kind])[quantity.kind]
            for d in (steps, -steps, 0 * steps[:, :1])
        )
        return nominal, (1 / (2 * STEP)) * (up - down)


def _of_all(what: What, numbers: Iterable[int], tolerance: float) -> Iterator[Source]:
    return (Source(what, number, tolerance) for number in numbers)


def _without_pistons(model: EngineFile) -> EngineFile:
    """The file with all pistons weightless."""
    overrides = {
        number: own if own.piston_mass is None else own.model_copy(update={"piston_mass": 0.0})
        for number, own in model.cylinder.items()
    }
    parts = dict.fromkeys(PISTON_PARTS)
    bare = model.with_table("piston", **parts | {"mass": 0.0})
    return bare.model_copy(update={"cylinder": overrides})


def _without_throws(model: EngineFile) -> EngineFile:
    """The file with all throws weightless."""
    return model.with_table("crank", throw_mass=0.0)
