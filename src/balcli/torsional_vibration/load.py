"""Read a file that describes a chain or an engine, for `balcli torsion`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, partial
from typing import Any, NamedTuple

from ..core.vibration import Real
from ..engine.engine import CylinderNumber, Engine, find_row, refuse_geared
from ..engine.load import build_named
from ..engine.parse import parse
from ..errors import ArgumentError
from ..file.doubt import Doubt, walk_figures
from ..file.doubts import LOSS_OF_SHAFTS, doubt_losses
from ..file.messages import CHAIN, ENGINE, refuse_other_kind
from ..file.model import EngineFile
from ..file.plain_tables import list_tables
from ..file.toml import name_file, parse_toml, read_bytes
from ..file.torsion_tables import Damper
from ..file.units import ask_unit
from ..forces.spectrum import follow_imep
from .build import (
    build_chain,
    build_engine_system,
    excite_cylinders,
    list_dampers,
    list_throws,
    require_torsion,
)
from .chain_file import ChainFile, describes_chain, read_chain_tables
from .measured import MeasuredPoints, read_measured
from .misfire import ALL_FIRE, MisfireAsked, stop_burning, stop_firing
from .system import Excitation, TorsionalSystem

# kg mm2 or mm; smaller figures are unlikely: they belong to tiny parts, such as a steel disc of
# 10 mm diameter and 10 mm width, which has 0.08 kg mm2.
_SMALL = 1.0


class Source(NamedTuple):
    """A chain or engine file that has been read.

    Attributes:
        text: Text of the file; empty if no damper is to be written into it.
        doubts: Warnings of figures that are allowed but unlikely.
        system: Function that returns the system of the file. Its argument is a dict of dampers by
            node name, which replace those of the file. It raises InputError if the file
            contradicts itself.
        dampers: For each node that may carry a damper, by its name: its first damper in the file;
            None: it has no damper.
        engine: Engine of the file; None: the file describes a chain.
        throws: Names of the nodes of the engine's throws.
        measured: Measured curve of the free end; None: the file names none.
        misfire: Request for cylinders that do not fire; those with a number do not fire in
            `system`.
        without: Function that returns the source with one more cylinder that does not fire, given
            its number and whether it compresses; None: the file describes a chain.
    """

    text: bytes
    doubts: tuple[Doubt, ...]
    system: Callable[[Mapping[str, Damper | None]], TorsionalSystem]
    dampers: Mapping[str, Damper | None]
    engine: Engine | None = None
    throws: tuple[str, ...] = ()
    measured: MeasuredPoints | None = None
    misfire: MisfireAsked = ALL_FIRE
    without: Callable[[CylinderNumber, bool], Source] | None = None


def make_chain_source(
    model: ChainFile, name: str, orders: Real | None = None, text: bytes = b""
) -> Source:
    """Return the source for the tables of a chain file."""
    figures = list(walk_figures("", list_tables(model)))
    doubts = *doubt_losses(figures, LOSS_OF_SHAFTS), *_doubt_units(figures)
    dampers = {node.name: node.damper for node in model.node}
    return Source(text, doubts, partial(build_chain, model, name, orders), dampers)


def _doubt_units(figures: Iterable[tuple[str, Any, Any]]) -> Iterator[Doubt]:
    """Yield warnings of inertias and diameters that were probably meant in kg m2 and m; `figures`
    is the result of `walk_figures`.
    """
    units = {"inertia": "kg mm^2", "diameter": "mm"}
    for path, key, value in figures:
        if key in units and value < _SMALL:
            larger = ask_unit(units[key], f"{value:.4g} {units[key].replace('mm', 'm')}")
            yield Doubt(path, f"{value:.4g} {units[key]}; {larger}")


def load_source(path: str, orders: Real | None = None, misfire: MisfireAsked = ALL_FIRE) -> Source:
    """Return the source for a file, or for standard input if the path is "-".

    Args:
        orders: Orders of the excitation to use, shape (orders,); None: all orders of a chain; for
            an engine, the default of `excite_cylinders`.
        misfire: Request for cylinders that do not fire.

    Raises:
        BalcliError: The file cannot be read or has mistakes, a misfire is given for an engine
            without gas, or the engine has no such cylinder.
    """
    name = name_file(path)
    text = read_bytes(path)
    data: Mapping[str, object] = parse_toml(text, name)
    if describes_chain(data):
        if misfire != ALL_FIRE:
            raise ArgumentError("{misfire}: a chain has no cylinders")
        return make_chain_source(read_chain_tables(data, name), name, orders, text)
    refuse_other_kind(data, name, ENGINE, CHAIN)
    model = parse(text, name)
    engine = build_named(model, name)
    refuse_geared(engine)
    return make_source(model, engine, name, orders, text, misfire)


def make_source(
    model: EngineFile,
    engine: Engine,
    name: str,
    orders: Real | None = None,
    text: bytes = b"",
    misfire: MisfireAsked = ALL_FIRE,
) -> Source:
    """Return the source for an engine and its file. The text is only needed to write a damper.

    Raises:
        BalcliError: The file has no [torsion], or the engine has no such cylinder.
        InputError: The measured curve has mistakes.
    """
    for number in misfire.cylinders:
        engine = stop_firing(engine, number, misfire.compressing)
    torques = excite_cylinders(model, engine, orders)
    return _make_source(model, engine, torques, name, text, misfire)


def _make_source(
    model: EngineFile,
    engine: Engine,
    torques: Excitation,
    name: str,
    text: bytes,
    misfire: MisfireAsked,
) -> Source:
    """Return the source for an engine in which the requested cylinders do not fire already.

    Args:
        torques: Torques of its cylinders, from `excite_cylinders`.
    """

    @cache
    def compress() -> Excitation:
        """Return the torques of cylinders that all compress without burning."""
        return excite_cylinders(model, stop_burning(engine), torques.orders)

    def without(number: CylinderNumber, compressing: bool) -> Source:
        """Return the source with one more cylinder that does not fire. The gas of the others is
        not computed again: it does not depend on this cylinder.
        """
        silent = stop_firing(engine, number, compressing)
        idle = compress() if compressing else torques.without_gas()
        left = torques.replace_gas(find_row(engine, number), idle, follow_imep(silent))
        return _make_source(model, silent, left, name, text, misfire)

    torsion = require_torsion(model, name)
    excitation = torques.without_idle_orders()
    system = partial(build_engine_system, model, engine, excitation, name)
    dampers: dict[str, Damper | None] = {
        part.name: part.damper for part in (*reversed(torsion.front), *torsion.rear)
    }
    throws = tuple(list_throws(engine))
    dampers |= {throw: next(iter(list_dampers(torsion, throw)), None) for throw in throws}
    measured = read_measured(model, engine, name)
    return Source(
        text=text,
        doubts=engine.unlikely,
        system=system,
        dampers=dampers,
        engine=engine,
        throws=throws,
        measured=measured,
        misfire=misfire,
        without=without,
    )
