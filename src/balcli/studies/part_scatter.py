"""How figures of mounts and of torsion spread when the parts that make them vary within tolerances:
rubber is made to 15 %, the stiffness of a crankshaft is known to about 5 %.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isfinite
from typing import NamedTuple

import numpy as np

from ..core.phasors import Array
from ..engine.build import build
from ..enginefile.model import EngineFile, label_table
from ..enginefile.shafting import find_stiffness
from ..enginefile.torsion_tables import Part
from ..errors import BalcliError
from ..forces.target_quantity import TargetQuantity
from ..limits import MOST_MOUNT_SAMPLES
from .quantities import group_by_chapter, load_chapter
from .quantity_names import MOUNTS
from .spread_one_by_one import spread_one_by_one
from .tolerances import Drawing, Scatter

OF_MOUNTS, OF_SHAFTS = 0.15, 0.05  # tolerance of stiffness, unless another is given


class PartSource(NamedTuple):
    """What deviates as one.

    Attributes:
        name: as tables have it: `stiffness left`.
        tolerance: relative.
        figures: of the file, by dotted name, as they are.
        relative: to themselves, as all of these deviate.
    """

    name: str
    tolerance: float
    figures: Mapping[str, float]
    relative: bool = True


def scatter_parts(
    model: EngineFile,
    stiffness: float | None,
    mass: float,
    quantities: Sequence[TargetQuantity],
    drawing: Drawing,
) -> Scatter:
    """Spread of quantities over random mounts, or shafts and inertias, each variant computed by
    itself.

    Args:
        stiffness: tolerance of that of every mount or shaft; None: OF_MOUNTS, OF_SHAFTS.
        mass: of every inertia and piston, for quantities of torsion.
        quantities: of mounts, or of torsion.

    Raises:
        InputError, BalcliError: what is wrong with the file; quantities of what it does not have;
            too many samples, no tolerance.
    """
    (chapter,) = group_by_chapter(quantities)
    of_mounts = chapter is MOUNTS
    where = "on mounts" if of_mounts else "of torsion"
    drawing.refuse_beyond(MOST_MOUNT_SAMPLES, f"{where}, where each is computed by itself, ")
    load_chapter(chapter).refuse_unknown(model, quantities)
    if stiffness is None:
        stiffness = OF_MOUNTS if of_mounts else OF_SHAFTS
    if not of_mounts:
        model = _spell_out(model)
    every = _list_mounts(model, stiffness) if of_mounts else _list_shafting(model, stiffness, mass)
    sources = [source for source in every if source.tolerance]
    if not sources:
        raise BalcliError("nothing deviates; give a tolerance, such as --stiffness-scatter 15%")
    variants = load_chapter(chapter).Variants(model, quantities)

    def evaluate(deviations: Array) -> Array:
        values = {
            path: value * (1 + float(deviation))
            for source, deviation in zip(sources, deviations, strict=True)
            for path, value in source.figures.items()
        }
        return np.array(variants.evaluate(values))

    count, spreads = spread_one_by_one(sources, quantities, evaluate, drawing)
    varied = "sets of mounts" if of_mounts else "crankshafts"
    return Scatter(model, count, drawing.shape, spreads, varied)


# ------------------------------------------------------------------ what deviates
def _list_mounts(model: EngineFile, tolerance: float) -> Iterator[PartSource]:
    """The stiffness of every mount, along all its axes alike."""
    for number, mount in enumerate(model.mount, 1):
        label = label_table(mount, number)
        figures = {
            f"mount.{label}.stiffness.{axis}": value
            for axis, value in enumerate(mount.stiffness, 1)
        }
        yield PartSource(f"stiffness {label}", tolerance, figures)


def _spell_out(model: EngineFile) -> EngineFile:
    """The file with a stiffness and an inertia for every throw, and one for every shaft that is
    given by its length.
    """
    torsion = model.torsion
    if torsion is None:
        return model
    throws = len(build(model).throws_m)
    stiffness, inertia = torsion.throw_stiffness or (), torsion.throw_inertia
    return model.with_table(
        "torsion",
        throw_stiffness=stiffness * (throws - 1) if len(stiffness) == 1 else stiffness,
        throw_inertia=inertia * throws if inertia and len(inertia) == 1 else inertia,
        front=tuple(map(_stiffen, torsion.front)),
        rear=tuple(map(_stiffen, torsion.rear)),
    )


def _stiffen(part: Part) -> Part:
    return part.model_copy(update={"stiffness": find_stiffness(part), "length": None})


def _list_shafting(model: EngineFile, stiffness: float, mass: float) -> Iterator[PartSource]:
    """Stiffness of every shaft, inertia of every node, mass of every piston."""
    torsion = model.torsion
    if torsion is None:
        return
    for k, value in enumerate(torsion.throw_stiffness or (), 1):
        path = f"torsion.throw_stiffness.{k}"
        yield PartSource(f"stiffness throw {k}-{k + 1}", stiffness, {path: value})
    for k, value in enumerate(torsion.throw_inertia or (), 1):
        yield PartSource(f"inertia throw {k}", mass, {f"torsion.throw_inertia.{k}": value})
    if not torsion.throw_inertia and model.crank.inertia is not None:
        yield PartSource("inertia crankshaft", mass, {"crank.inertia": model.crank.inertia})
    for key, parts in (("front", torsion.front), ("rear", torsion.rear)):
        for k, part in enumerate(parts, 1):
            yield from _list_part(part, f"torsion.{key}.{k}", stiffness, mass)
    engine = build(model)
    for number, weighed in sorted(zip(engine.numbers, engine.weighed, strict=True)):
        figures = {f"cylinder.{number}.piston_mass": float(weighed.piston)}
        yield PartSource(f"piston mass {number}", mass, figures)


def _list_part(part: Part, path: str, stiffness: float, mass: float) -> Iterator[PartSource]:
    """Stiffness of a part's shaft unless that is rigid, and the part's inertia."""
    if part.stiffness is not None and isfinite(part.stiffness):
        figures = {f"{path}.stiffness": part.stiffness}
        yield PartSource(f"stiffness {part.name}", stiffness, figures)
    if part.inertia is not None:
        yield PartSource(f"inertia {part.name}", mass, {f"{path}.inertia": part.inertia})
