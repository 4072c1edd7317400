"""Engines for which tests size devices, and what they ask of a remedy."""

from typing import Any

import numpy as np
from support.engines import engine_text

from balcli.core.phasors import Phasors
from balcli.core.records import remove_unit
from balcli.engine.engine import Engine
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.options import SchemeOptions
from balcli.sizing.remedy import Remedy, fit_devices
from balcli.sizing.sizing import size


def figures(remedy: Remedy, group: str = "") -> dict[str, Any]:
    """The details of a group by their labels, SI."""
    found = remedy.details[group.replace(" ", "_")] if group else remedy.details
    labels = {key: remove_unit(key).removesuffix("_g").replace("_", " ") for key in found}
    return {labels[key]: value / 1e3 if key.endswith(("_mm", "_g")) else value for key, value in found.items()}


def size_scheme(engine: Engine, scheme: str = "auto", **options: Any) -> Remedy:
    """The devices of a scheme; lists of a table of cases are tuples."""
    given = {name: tuple(value) if isinstance(value, list) else value for name, value in options.items()}
    return size(engine, scheme, SchemeOptions(**given))


def fit_scheme(engine: Engine, scheme: str = "auto", **options: Any) -> Engine:
    """The engine with them."""
    return fit_devices(engine, size_scheme(engine, scheme, **options))


def find_orders(engine: Engine, kind: str = "force") -> Phasors:
    """Phasors of a kind, all orders."""
    return compute_spectra(engine, np.arange(1, 41), (kind,))[kind]


def write_engine(*throws: float, **tables: str) -> str:
    """The text of an engine with throws of 1 kg at these angles, 100 mm apart."""
    return engine_text(crank=f"stroke = 100\nthrows = {list(throws)}\nspacing = 100\nthrow_mass = 1", **tables)


def weigh(unbalance: float, angle: float = 180, position: float | str = 0) -> str:
    """A counterweight as a table of an engine file, g mm, degrees and mm."""
    return f"[[counterweight]]\nunbalance = {unbalance!r}\nangle = {angle!r}\nposition = {position}\n"


SMALL = {  # engine files by what they are
    "one": write_engine(0, piston="mass = 1\noffset = 4"),
    "two": write_engine(0, 180) + "[cylinder.2]\npiston_mass = 3\n",
    "three": write_engine(0, 240, 120),
    "four": write_engine(0, 180, 180, 0),
    "vee": write_engine(0, 100, layout="bank_angle = 50\nstagger = 20"),
}
