"""A file -> what `balcli torsion` works on, whichever it describes: a chain or an engine."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from ..core.vibration import Real
from ..engine.build import Engine
from ..engine.load import build_named, parse
from ..enginefile.file_kinds import CHAIN, ENGINE, refuse_other_kind
from ..enginefile.model import EngineFile
from ..enginefile.shafting import Damper
from ..enginefile.suspicious import doubt_losses
from ..enginefile.toml_text import name_file, parse_toml, read_bytes
from ..enginefile.torsion_tables import Part
from ..enginefile.units import ask_unit
from ..errors import BalcliError
from ..torque.course import silence
from .build_chain import build_chain
from .build_engine import build_engine_system, excite_engine
from .chain_file import ChainFile, Node
from .read_chain import describes_chain, read_chain_tables
from .system import Excitation, TorsionalSystem

_LIGHT = 1.0  # kg mm2: a steel disc of 10 mm across and 10 mm thick has 0.08
_THIN = 1.0  # mm


@dataclass(frozen=True)
class ChainSource:
    """A chain file that has been read: its name, its text, what it says."""

    file: str
    text: bytes
    model: ChainFile

    @property
    def doubts(self) -> tuple[str, ...]:
        """What it says that is allowed and yet unlikely, in words."""
        model = self.model
        losses = doubt_losses(model.list_losses())
        return (*losses, *_doubt_units(model), *_doubt_torques(model))

    def system(self) -> TorsionalSystem:
        """What it describes. Raises InputError: what hangs together wrongly."""
        return build_chain(self.model, self.file)

    @property
    def crank_radius(self) -> float | None:
        """None: it has no crank."""
        return None

    def dampers(self) -> Mapping[str, Damper | None]:
        """What may carry a damper, by name, and those that do."""
        return {node.name: node.damper for node in self.model.node}

    def with_damper(self, name: str, damper: Damper | None) -> ChainSource:
        """The same with this damper on a node."""
        nodes = _put_damper(self.model.node, name, damper)
        return replace(self, model=self.model.model_copy(update={"node": nodes}))


@dataclass(frozen=True)
class EngineSource:
    """An engine file that has been read: its name, its text, what it says, the engine, what
    excites it; what its file says that is allowed and yet unlikely, in words.
    """

    file: str
    text: bytes
    model: EngineFile
    engine: Engine
    excitation: Excitation
    doubts: tuple[str, ...]

    def system(self) -> TorsionalSystem:
        """What it describes. Raises InputError: what does not fit together in [torsion]."""
        return build_engine_system(self.model, self.engine, self.excitation, self.file)

    @property
    def crank_radius(self) -> float | None:
        """Half the stroke, m."""
        return float(self.engine.cylinders.radius)

    def dampers(self) -> Mapping[str, Damper | None]:
        """What may carry a damper, by name, and those that do."""
        torsion = self.model.torsion
        parts = () if torsion is None else (*reversed(torsion.front), *torsion.rear)
        return {part.name: part.damper for part in parts}

    def with_damper(self, name: str, damper: Damper | None) -> EngineSource:
        """The same with this damper on a part."""
        torsion = self.model.torsion
        if torsion is None:
            return self
        front, rear = (_put_damper(each, name, damper) for each in (torsion.front, torsion.rear))
        return replace(self, model=self.model.with_table("torsion", front=front, rear=rear))


def _doubt_torques(model: ChainFile) -> Iterator[str]:
    """Excitations of which only node and order are given, and those that a fixing takes."""
    for number, torque in enumerate(model.excitation, 1):
        if not {"cos", "sin"} & torque.model_fields_set:
            yield (
                f"excitation.{number} on '{torque.node}' has neither cos nor sin, and so no "
                "torque; give one of them, such as cos = 150 (N m)"
            )
        elif torque.node in model.fixed:
            yield f"excitation.{number} is on '{torque.node}', which is fixed: it moves nothing"


def _doubt_units(model: ChainFile) -> Iterator[str]:
    """Inertias of kg m2 and diameters of m without their units, most likely."""
    for number, node in enumerate(model.node, 1):
        if node.inertia is not None and node.inertia < _LIGHT:
            yield (
                f"node.{number}.inertia of '{node.name}' is {node.inertia:.4g} kg mm^2; "
                f"{ask_unit('kg mm^2', f'{node.inertia:.4g} kg m^2')}"
            )
    for number, shaft in enumerate(model.shaft, 1):
        if shaft.diameter is not None and shaft.diameter < _THIN:
            yield (
                f"shaft.{number}.diameter is {shaft.diameter:.4g} mm; "
                f"{ask_unit('mm', f'{shaft.diameter:.4g} m')}"
            )


Source = ChainSource | EngineSource
Carrier = TypeVar("Carrier", Node, Part)


def _put_damper(
    carriers: Sequence[Carrier], name: str, damper: Damper | None
) -> tuple[Carrier, ...]:
    """The same with this damper on the one of this name."""
    fitted = {"damper": damper}
    return tuple(c.model_copy(update=fitted) if c.name == name else c for c in carriers)


def load_source(path: str, orders: Real | None = None, misfires: Sequence[int] = ()) -> Source:
    """A file, or standard input for "-".

    Args:
        orders: (orders,) by which an engine is excited; None: to 12.
        misfires: numbers of cylinders of an engine without gas force.

    Raises:
        BalcliError: it cannot be read; all its mistakes.
    """
    name, text = name_file(path), read_bytes(path)
    data: Mapping[str, Any] = parse_toml(text, name)
    if describes_chain(data):
        if misfires:
            raise BalcliError("--misfire: a chain has no cylinders")
        return ChainSource(name, text, read_chain_tables(data, name))
    refuse_other_kind(data, name, ENGINE, CHAIN)
    model = parse(text, name)
    made = make_source(model, build_named(model, name), name, orders, misfires)
    return replace(made, text=text)


def make_source(
    model: EngineFile,
    engine: Engine,
    name: str,
    orders: Real | None = None,
    misfires: Sequence[int] = (),
) -> EngineSource:
    """Of an engine file that has been read and built; without its text, so that nothing can be
    written into it.

    Raises:
        BalcliError: it has no [torsion]; a misfire of an engine without gas, or of a cylinder that
            there is not.
    """
    if model.torsion is None:
        raise BalcliError(
            f"{name}: has no [torsion]; write it with throw_stiffness, throw_inertia and "
            "[[torsion.rear]] for the flywheel, or a chain of [[node]] and [[shaft]]"
        )
    doubts = engine.unlikely
    for number in misfires:
        engine = silence(engine, number)
    return EngineSource(name, b"", model, engine, excite_engine(model, engine, orders), doubts)
