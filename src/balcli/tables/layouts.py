"""Free forces and moments of the common layouts in textbook units, computed from the example
engines.

What the textbook leaves out is taken off each engine: rotating masses, rods' inertia, pin offsets,
stagger of the banks, balancing devices. F_n = m_rec r omega^2 A_n is the force of order n of one
cylinder (F_1 with A_1 = 1), a the distance of neighbouring throws; moments are about the middle of
the crankshaft.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..core.mechanisms import closed_form
from ..enginefile.examples import folder
from .printed import Print
from .ranges import Ranges
from .recomputed import Row, Table

if TYPE_CHECKING:
    from ..engine.build import Engine
    from ..enginefile.model import EngineFile

ORDERS = (1, 2, 4, 6)


def tabulate_layouts(printed: Print, ranges: Ranges) -> Table:
    """One row an engine; semi-axes (equal: a circle) of the force F and the moment M of each
    order.
    """
    ends = [f"{letter}{n}_{axis}" for n in ORDERS for letter in "FM" for axis in ("major", "minor")]
    rows = [_row(name or "") for name in printed.column("engine")]
    return printed.compare(("engine", "layout", "cylinders", *ends), rows, stub=3)


def _row(name: str) -> Row:
    from ..engine.build import build
    from ..engine.load import parse
    from ..forces.spectrum import compute_spectra

    file = parse((folder() / f"{name}.toml").read_text(encoding="utf-8"), name)
    engine = build(_bare(file))
    found = compute_spectra(engine, ORDERS, ("force", "moment"))
    c = engine.cylinders
    unit = engine.omega**2 * float(c.reciprocating.ravel()[0] * c.radius.ravel()[0])
    each = unit * closed_form.piston(ORDERS, c.lam.ravel()[:1]).ravel()
    axes = np.stack(
        [axis.ravel() for q in ("force", "moment") for axis in (found[q].major, found[q].minor)],
        axis=-1,
    )
    scale = np.abs(each)[:, None] * np.array([1, 1, _distance(engine), _distance(engine)])
    return (name, file.name, len(engine.numbers), *(axes / scale).ravel().tolist())


def _bare(file: EngineFile) -> EngineFile:
    """The engine as the textbook has it."""
    rod = file.rod.model_copy(
        update={
            "mass": None,
            "cg": None,
            "small_end": None,
            "big_end": None,
            "inertia": None,
            "pendulum": None,
        }
    )
    return file.model_copy(
        update={
            "crank": file.crank.model_copy(update={"throw_mass": 0.0}),
            "rod": rod,
            "piston": file.piston.model_copy(update={"offset": 0.0}),
            "layout": file.layout.model_copy(update={"stagger": 0.0}),
            "bobweight": Bobweight.model_construct(),
            "counterweight": (),
            "shaft": (),
            "slider": (),
        }
    )


def _distance(engine: Engine) -> float:
    """Of neighbouring throws, m; 1 for a single throw, which has no moment."""
    gaps = np.diff(np.unique(np.round(np.asarray(engine.throws_m, float).ravel(), 9)))
    return float(gaps.min()) if gaps.size else 1.0
