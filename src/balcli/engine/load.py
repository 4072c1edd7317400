"""Build the engine of tables, vary keys of its file, or build its variants, one after the other or
those whose torque can be computed as arrays together.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

import numpy as np

from ..core.phasors import Figure
from ..core.records import Node
from ..core.vibration import Real
from ..errors import BalcliError, InputError, naming_file, wrong_type
from ..file.model import EngineFile
from ..file.plain_tables import change_tables
from ..file.toml import name_file
from .build import build
from .engine import Engine, take_model
from .parse import parse_dict
from .parts import list_joint_paths

if TYPE_CHECKING:
    from ..file.gas_tables import Gas
    from .gas import EngineGas

E = TypeVar("E", bound=Engine)
Key = TypeVar("Key")
Value = TypeVar("Value")
Asked = TypeVar("Asked")


def build_tables(tables: Mapping[str, object], name: str) -> Engine:
    """Return the engine that the tables of a file describe.

    Args:
        tables: Tables as `normalize_tables` returns them.
        name: Name of their file, or empty. Files that the tables name are in the same folder.

    Raises:
        InputError: The tables have mistakes; the error lists all of them.
    """
    return build_named(parse_dict(tables, Path(name).parent, name), name)


def build_named(model: EngineFile, path: str | Path) -> Engine:
    """Return the engine of a model that was read from a file.

    Args:
        model: Checked engine file.
        path: Path of the file, for messages; "-" is standard input.

    Raises:
        InputError: The file has contradictions; the error lists them.
    """
    with naming_file(name_file(path)):
        return build(model)


# ------------------------------------------------------------------ variants of an engine
_NO_FIRING_ORDER: Node = {"layout.firing_order": None, "layout.firing_intervals": None}


def vary_engine(engine: E, changes: Mapping[str, object]) -> E:
    """Return the engine of the same file with other values of some keys, as an engine of the same
    class.

    Args:
        engine: Engine that comes from a file.
        changes: Values by dotted names, in the units of the file.

    Raises:
        InputError: The changed file has mistakes; the error lists all of them.
        BalcliError: No file describes this engine.
        TypeError: A name is not a text.
    """
    for path in changes:
        if not isinstance(path, str):
            raise wrong_type("vary", path, 'name a key of the engine file, such as "rod.length"')
    model = take_model(engine)
    name = f"{engine.name or 'engine'} with {', '.join(changes)}"

    def build_with(changes: Mapping[str, object]) -> E:
        with naming_file(name):
            varied = build(parse_dict(change_tables(model, changes), model.folder))
        return type(engine).of(varied)

    try:
        return build_with(changes)
    except InputError as error:
        if model.engine:
            raise
        needed = model.crank.throws is None or model.gas is not None
        named = _NO_FIRING_ORDER.keys() & changes.keys()
        if needed or named or model.layout.firing_order is None:
            raise
        mistakes = error
    try:
        return build_with(_NO_FIRING_ORDER | {**changes})
    except InputError:
        raise mistakes from None


# Figures on which the gas torque of a cylinder depends, by their dotted names.
_OF_GAS = (
    r"(gas|layout|articulation)\..*|crank\.(stroke.*|throws.*|splay)|rod\.(length|ratio)"
    r"|piston\.(bore|offset|rod_diameter)"
    r"|cylinder\.\d+\.(stroke|bore|piston_offset|piston_rod_diameter|rod_length|rod_ratio|bank)"
    r"|cylinder\.\d+\.(throw|gas|heat)"
)


def concerns_gas(path: str, gas: Gas | None = None) -> bool:
    """Return whether the gas torque of a cylinder depends on a figure.

    Args:
        path: Dotted name of the figure.
        gas: Table [gas] of the file, which shows whether the gas depends on the speed; None if the
            speed does not matter to the caller.
    """
    of_speed = path == SPEED and gas is not None and gas.speeds
    return bool(of_speed or re.fullmatch(rf"(engine\.\d+\.)?({_OF_GAS})", path))


Values = tuple[tuple[str, float], ...]  # figures by dotted name
_KEPT = 64  # number of variants that are cached


SPEED = "operation.speed"


def choose_speeds(
    engine: Engine, values: Mapping[str, float], usual: Callable[[Engine], Real]
) -> Real:
    """Return the speeds (rpm) over which the largest value of a quantity is sought: only the
    variant's own speed if the speed is one of the varied figures, else the usual speeds.

    Args:
        engine: Engine of the variant.
        values: Varied figures of this variant, by dotted names.
        usual: Function that returns the usual speeds, rpm.
    """
    return np.array([float(engine.speed_rpm)]) if SPEED in values else usual(engine)


class EngineVariants:
    """Builder of variants of an engine, one by one, that caches recent variants. The gas is
    computed again only if a figure on which the gas depends (`concerns_gas`) has a new value.

    Args:
        model: Engine file.
    """

    def __init__(self, model: EngineFile) -> None:
        self._model = model
        self._engines: dict[Values, Engine] = {}
        self._gas: dict[Values, EngineGas | None] = {}

    def build(self, values: Mapping[str, float]) -> Engine:
        """Return the engine with these figures (by dotted name) instead of the file's.

        Raises:
            InputError, BalcliError: No engine can have these figures.
        """
        of_gas = tuple((path, value) for path, value in values.items() if concerns_gas(path))

        def make() -> Engine:
            engine = build(self._model, values, gas=self._gas.get(of_gas))
            remember(self._gas, of_gas, lambda: engine.gas)
            return engine

        return remember(self._engines, tuple(values.items()), make)


class JointEngine(NamedTuple):
    """Variants of an engine whose torque can be computed together.

    Attributes:
        places: Their places among all variants.
        engine: Engine whose gas and inertia are arrays of these variants, or plain where they do
            not differ.
    """

    places: list[int]
    engine: Engine


def build_jointly(
    model: EngineFile, variants: Sequence[Mapping[str, float]], *, only_gas: bool = False
) -> Iterator[JointEngine]:
    """Yield the variants of a file whose torque can be computed together, in groups. The members of
    a group differ only in joint figures (`find_joint_figures`). A variant that is alone in its
    group is left out, and so are all members of a group in which a variant is impossible.

    Args:
        model: Engine file.
        variants: Varied figures of each variant, by dotted name; all variants have the same names.
        only_gas: Whether the members of a group differ only in their gas.
    """
    joint = find_joint_figures(model, variants[0], only_gas=only_gas)
    groups: dict[Values, list[int]] = {}
    for place, values in enumerate(variants):
        own = tuple((path, value) for path, value in values.items() if path not in joint.all)
        groups.setdefault(own, []).append(place)
    for own, places in groups.items():
        if not joint.all or len(places) == 1:
            continue
        with suppress(BalcliError):
            engine = _build_group(model, dict(own), joint, [variants[k] for k in places])
            yield JointEngine(places, engine)


def _build_group(
    model: EngineFile,
    own: Mapping[str, float],
    joint: JointFigures,
    variants: Sequence[Mapping[str, float]],
) -> Engine:
    """Return variants as one engine.

    Args:
        model: Engine file.
        own: Varied figures that all these variants have in common.
        joint: Names of the figures in which they differ.
        variants: Varied figures of each variant.

    Raises:
        InputError: A variant is impossible.
    """
    arrays = {path: np.array([values[path] for values in variants]) for path in joint.all}
    of_gas: dict[str, Figure] = {**own, **{path: arrays[path] for path in joint.of_gas}}
    of_rest: dict[str, Figure] = {**own, **arrays}
    for path in joint.of_gas:
        del of_rest[path]
    first = {path: variants[0][path] for path in joint.of_mechanism}
    one = build(model, {**of_gas, **first})
    if not (joint.of_mechanism or joint.of_inertia):
        return one
    engine = build(model, of_rest, rank=1)
    if not joint.of_mechanism or one.gas is None:
        return replace(engine, gas=one.gas)
    from .build_gas import vary_pistons  # loaded only for files with [gas]

    return replace(engine, gas=vary_pistons(model, of_gas, one.gas, engine))


class JointFigures(NamedTuple):
    """Varied figures of which arrays can be computed together.

    Attributes:
        of_gas: Names of figures that change only the pressures of a computed cycle.
        of_mechanism: Names of lengths of a mechanism whose dead centres they do not move.
        of_inertia: Names of figures on which the gas does not depend.
    """

    of_gas: frozenset[str] = frozenset()
    of_mechanism: frozenset[str] = frozenset()
    of_inertia: frozenset[str] = frozenset()

    @property
    def all(self) -> frozenset[str]:
        """Names of all these figures."""
        return self.of_gas | self.of_mechanism | self.of_inertia


_LENGTHS = frozenset({"crank.stroke", "rod.length", "rod.ratio", "piston.bore"})
# Keys of [cylinder.N] with which its mechanism differs from that of other cylinders.
_OWN_LENGTHS = ("stroke", "bore", "piston_offset", "rod_length", "rod_ratio")


def find_joint_figures(
    model: EngineFile, varied: Iterable[str], *, only_gas: bool = False
) -> JointFigures:
    """Return those of the varied figures of which arrays can be computed together.

    Args:
        model: Engine file.
        varied: Dotted names of the figures that vary.
        only_gas: Whether to return only figures of the gas.
    """
    paths = frozenset(varied)
    if model.gas is None:
        return JointFigures()
    of_gas = list_joint_paths(model, paths)
    if only_gas or model.articulation is not None or model.layout.rotary:
        return JointFigures(of_gas & paths)
    of_inertia = frozenset(path for path in paths if not concerns_gas(path, model.gas))
    fixed = of_gas and _keeps_dead_centres(model, paths)
    return JointFigures(of_gas & paths, _LENGTHS & paths if fixed else frozenset(), of_inertia)


def _keeps_dead_centres(model: EngineFile, varied: Iterable[str]) -> bool:
    """Return whether all cylinders are equal in every variant, and have their dead centres at 0 and
    180 degrees; in two strokes, ports would close at angles that depend on the rod.
    """
    keys = {path.rpartition(".")[2] for path in varied if path.startswith("cylinder.")}
    own = any(table.has(key) for table in model.cylinder.values() for key in _OWN_LENGTHS)
    if own or not keys.isdisjoint(_OWN_LENGTHS) or isinstance(model.crank.stroke, tuple):
        return False
    centred = model.piston.offset == 0 and "piston.offset" not in varied
    return centred and model.layout.strokes == 4


class FiguresOfVariants(EngineVariants, Generic[Asked]):
    """Evaluator of quantities for the variants of an engine, one variant at a time.

    Args:
        evaluate: Function that returns the values of given quantities for an engine.
        model: Engine file.
        quantities: Quantities to evaluate.
    """

    def __init__(
        self,
        evaluate: Callable[[Engine, Sequence[Asked]], list[float]],
        model: EngineFile,
        quantities: Sequence[Asked],
    ) -> None:
        super().__init__(model)
        self._evaluate = evaluate
        self._quantities = quantities

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """Return the value of each quantity for the variant with these figures (by dotted name).

        Raises:
            InputError, BalcliError: No engine can have these figures, or a quantity is not known.
        """
        return self._evaluate(self.build(values), self._quantities)


def remember(cache: dict[Key, Value], key: Key, make: Callable[[], Value]) -> Value:
    """Return the cached value of a key; make it if it is new. A full cache is emptied.

    Args:
        cache: Cache.
        key: Key of the value.
        make: Function that makes the value.
    """
    value = cache.get(key)
    if value is None:
        value = make()
        if len(cache) >= _KEPT:
            cache.clear()
        cache[key] = value
    return value
