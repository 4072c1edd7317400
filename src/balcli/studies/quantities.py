"""Parse the names of quantities and evaluate them for variants of an engine file; list the numbers
that can vary.

Quantities of forces and moments (`force.2.major`) are evaluated for all variants as arrays. Other
quantities (`mode.roll.Hz`, `torsion.1.Hz`, `torque.mean`, `guide.6.H`) are evaluated by the module
of their chapter (a subject such as mounts), which is loaded only if one of its quantities is
requested: together the variants that the chapter can join (`JointVariants`), the others one after
the other. Gas torque is computed on demand, once for all variants with the same gas.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Literal, Protocol, cast, runtime_checkable

import numpy as np

from ..core.phasors import Array, Figure, Phasors
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.figures import select_varied
from ..engine.left_out import list_inferred, list_varied_defaults
from ..engine.load import JointEngine, build_jointly, concerns_gas, find_joint_figures
from ..engine.parts import Parts
from ..errors import BalcliError, naming_file
from ..file.assumed import DEVICES, Assumed, join_assumed, select_assumed
from ..file.fields import RIGID, suggest_nearest
from ..file.model import EngineFile
from ..file.table import document_keys
from ..forces.kinds import EVERY_CAUSE, EVERY_KIND, GAS_KINDS
from ..forces.quantity import (
    Quantity,
    TargetQuantity,
    evaluate_quantities,
    parse_quantity,
    refuse_unknown as refuse_unknown_of_engine,
)
from ..forces.spectrum import compute_gas_torque
from ..names import QUANTITIES, import_name
from ..show.figures import EngineName
from .parameters import Place, find_places, tell_variant
from .quantity_names import BEGINNINGS, ENGINE, FORMS, MOUNTS, PISTON, TORSION, Form, join_patterns

AnyQuantity = Quantity | TargetQuantity


class Variants(Protocol):
    """Object that evaluates some quantities, one variant of a file after the other."""

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """Return the value of each quantity for one variant; `values` are its varied figures by
        path.
        """


@runtime_checkable
class JointVariants(Variants, Protocol):
    """Object that can also evaluate some variants together."""

    def joins(self, different: Collection[str], varied: Collection[str]) -> bool:
        """Return whether variants that differ only in some figures are computed together.

        Args:
            different: Dotted names of these figures.
            varied: Dotted names of all figures that vary.
        """

    def evaluate_jointly(self, variants: Sequence[Mapping[str, float]]) -> dict[int, list[float]]:
        """Return the value of each quantity for the variants that can be computed together, by
        their places in `variants`. Variants that are impossible are not among them.
        """


class ChapterModule(Protocol):
    """Interface of a module that computes the quantities of one chapter."""

    def list_names(self, model: EngineFile) -> Iterable[str]:
        """Return the names of the quantities of a file; N stands for any order."""

    def refuse_unknown(self, model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
        """Raise BalcliError if the file lacks what a quantity refers to, such as a mount."""

    def Variants(  # a class or a function that returns an instance
        self, model: EngineFile, quantities: Sequence[TargetQuantity]
    ) -> Variants: ...


def load_chapter(chapter: str) -> ChapterModule:
    """Return the module that computes the quantities of a chapter other than ENGINE."""
    return cast(ChapterModule, import_name(QUANTITIES[chapter]))


def parse_quantities(text: str, *, with_gas: bool = False) -> tuple[AnyQuantity, ...]:
    """Return the quantities with these names, in this order and without repetition.

    Args:
        text: Names with commas between them.
        with_gas: Whether the engine has gas: `torque` is then the torque of gas and inertia.

    Raises:
        BalcliError: A name is unknown; the error lists the known names.
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    if not words:
        raise BalcliError(
            "no quantity is given; name some, such as force.2.major,moment.1.backward"
        )
    return tuple(dict.fromkeys(_parse_quantity(word, with_gas) for word in words))


def _parse_quantity(word: str, with_gas: bool) -> AnyQuantity:
    for form in FORMS:
        if form.chapter != ENGINE and form.matches(word):
            return TargetQuantity(word, form.unit, form.chapter)
    alike = [form for form in FORMS if form.beginning == word.partition(".")[0]]
    if any(form.chapter == ENGINE for form in alike):
        return parse_quantity(word, with_gas=with_gas)
    there = f"names begin with {', '.join(BEGINNINGS[:-1])} or {BEGINNINGS[-1]}"
    hint = suggest_nearest(word.partition(".")[0], BEGINNINGS, there)
    if alike:
        hint = f"give {' or '.join(join_patterns(alike))}"
    raise BalcliError(f"{word} is not a quantity: {hint}")


def choose_of_engine(wanted: Iterable[AnyQuantity]) -> tuple[Quantity, ...]:
    """Return the quantities of forces and moments, which are evaluated as arrays."""
    return tuple(q for q in wanted if isinstance(q, Quantity))


def group_by_chapter(wanted: Iterable[AnyQuantity]) -> dict[str, list[TargetQuantity]]:
    """Return the quantities of other chapters, grouped by chapter."""
    groups: dict[str, list[TargetQuantity]] = {}
    for q in wanted:
        if isinstance(q, TargetQuantity):
            groups.setdefault(q.chapter, []).append(q)
    return groups


def refuse_unknown(model: EngineFile, engine: Engine, wanted: Iterable[AnyQuantity]) -> None:
    """Raise an error if the file or its variants lack what a quantity refers to.

    Args:
        model: Engine file.
        engine: Engine of the file; it may hold variants along trailing axes.
        wanted: Requested quantities.

    Raises:
        BalcliError, InputError: A quantity does not exist; the error lists those that do.
    """
    wanted = tuple(wanted)
    for chapter, members in group_by_chapter(wanted).items():
        load_chapter(chapter).refuse_unknown(model, members)
    refuse_unknown_of_engine(engine, choose_of_engine(wanted))


# Tables whose default values affect the quantities of a chapter, besides tables that affect all.
_TABLES = {MOUNTS: {"gas", "body", "mount"}, TORSION: {"gas", "torsion"}, PISTON: set[str]()}
# Beginnings of the names of quantities of chapters that do not depend on the inertia of rods, and
# of those that depend on the masses of throws and on devices.
_WITHOUT_RODS = ("mode.", "torque.mean", "piston.")
_WITH_THROWS = ("mount.", "point.")


def list_assumed(
    model: EngineFile, quantities: Collection[AnyQuantity], varied: Iterable[str] = ()
) -> tuple[Assumed, ...] | None:
    """Return the values assumed because a file leaves them out, if quantities depend on them; None
    if there are none.

    Args:
        model: Engine file.
        quantities: Requested quantities.
        varied: Names of the figures that vary.
    """
    names = [q.name for q in quantities]
    tables = {"flywheel"} if "fluctuation" in names else set[str]()
    for q in quantities:
        if isinstance(q, TargetQuantity):
            tables |= _TABLES.get(q.chapter, {"gas"})
        elif q.kind in GAS_KINDS:
            tables.add("gas")
    idle = set(varied)
    idle.update(list_varied_defaults(model, idle))
    if not model.operation.speed_ripple:
        off_axis = any((model.frame.reference or (0.0,))[:2])
        if not any(_depends_on_throws(q, off_axis=off_axis) for q in quantities):
            idle.add("crank.throw_mass")
        if not ("flywheel" in tables and model.flywheel):
            idle.add("crank.inertia")
    if not any(map(_depends_on_rods, quantities)):
        idle.add("rod.inertia")
    idle.update(_list_idle_of_devices(quantities))
    lists = [select_assumed(list_inferred(Parts(crank)), tables, idle) for crank in model.cranks]
    if not model.engine:
        return lists[0] or None
    return join_assumed(model.crank_names, lists) or None


def _depends_on_throws(q: AnyQuantity, *, off_axis: bool) -> bool:
    """Return whether a quantity depends on the masses of throws at steady speed, which only make
    forces of order 1.

    Args:
        q: Quantity.
        off_axis: Whether the point of reference is off the axis of the crankshaft.
    """
    if isinstance(q, TargetQuantity):
        return q.name.startswith(_WITH_THROWS)
    causes = EVERY_KIND[q.kind].causes
    has_order = q.order == 1 or q.part == "peak"
    return has_order and ("throws" in causes or (off_axis and "arms" in causes))


def _list_idle_of_devices(quantities: Iterable[AnyQuantity]) -> Iterator[str]:
    """Yield the keys and tables of devices on which no quantity depends."""
    causes = set[str]()
    for q in quantities:
        if not isinstance(q, TargetQuantity):
            causes.update(EVERY_KIND[q.kind].causes)
        elif q.name.startswith(_WITH_THROWS):
            causes.update(EVERY_CAUSE)
    if "planes" not in causes:
        yield from (f"{kind}.position" for kind in DEVICES)
    if "throws" not in causes:
        yield "counterweight"
    if "arms" not in causes:
        yield from ("shaft.at", "slider.at")
    if causes.isdisjoint(("throws", "arms")):
        yield from DEVICES


def _depends_on_rods(q: AnyQuantity) -> bool:
    if isinstance(q, TargetQuantity):
        return not q.name.startswith(_WITHOUT_RODS)
    return "rods" in EVERY_KIND[q.kind].causes


# ------------------------------------------------------------------ evaluation of variants
@contextmanager
def naming_variant(name: str) -> Iterator[None]:
    """Add the name of a variant, or of its file, to errors that are raised within this context."""
    try:
        yield
    except BalcliError as error:
        raise error.within(name) from None


def _list_variants(
    figures: Mapping[str, Figure], shape: tuple[int, ...]
) -> Iterator[dict[str, float]]:
    """Yield the figures of each variant in a grid; the figures broadcast to its shape."""
    columns = {path: np.broadcast_to(v, shape).ravel() for path, v in figures.items()}
    for k in range(math.prod(shape)):
        yield {path: float(column[k]) for path, column in columns.items()}


class _VariedGas:
    """Gas torque of variants by order, shape (orders, *parameters): each parameter has an axis,
    which has length 1 if the parameter has no effect on the gas.

    Args:
        model: Engine file.
        figures: Figures that vary, by dotted name.
        rank: Number of parameters.
        within: Beginning of messages, which names the geared engine; empty for a single engine.
    """

    def __init__(
        self, model: EngineFile, figures: Mapping[str, Figure], rank: int, within: str
    ) -> None:
        self._model = model
        self._within = within
        self._groups = list[JointEngine]()
        self._figures = {k: value for k, value in figures.items() if concerns_gas(k, model.gas)}
        self._shape = np.broadcast_shapes((1,) * rank, *map(np.shape, self._figures.values()))

    def __call__(self, orders: Array) -> Phasors:
        """Return the torque at these orders; raise InputError for an impossible cycle."""
        groups = self._groups or list(self._build())
        self._groups = groups
        count = math.prod(self._shape)
        vectors = np.empty((2, len(orders), count), complex)
        noise = np.empty((len(orders), count))
        for places, engine in groups:
            torque = compute_gas_torque(engine, orders)
            vectors[:, :, places] = torque.vectors.reshape(2, len(orders), -1)
            noise[:, places] = torque.noise.reshape(len(orders), -1)
        shape = (len(orders), *self._shape)
        return Phasors(orders, vectors.reshape(2, *shape), noise.reshape(shape))

    def _build(self) -> Iterator[JointEngine]:
        """Yield the engines of all variants, those that can be computed together first."""
        variants = list(_list_variants(self._figures, self._shape))
        left = set(range(len(variants)))
        for group in build_jointly(self._model, variants):
            left.difference_update(group.places)
            yield group
        for place in sorted(left):
            own = variants[place]
            with naming_file(f"{self._within}{tell_variant(own)}"):
                yield JointEngine([place], build(self._model, own))


def _vary_gas(
    model: EngineFile, engine: Engine, figures: Mapping[str, Figure], rank: int, within: str = ""
) -> Engine:
    """Return an engine of variants with the gas of each variant, if the file has gas."""
    if not model.has_gas:
        return engine
    if not engine.placed:
        return replace(engine, gas_of_variants=_VariedGas(model, figures, rank, within))
    placed = []
    for k, (crank, one) in enumerate(zip(model.cranks, engine.placed, strict=True), 1):
        own = dict(select_varied(figures, k))
        varied = _vary_gas(crank, one.engine, own, rank, f"engine.{k}: ")
        placed.append(one._replace(engine=varied))
    some = next(filter(None, (one.engine.gas_of_variants for one in placed)))
    return replace(engine, placed=tuple(placed), gas_of_variants=some)


class Evaluator:
    """Evaluator of some quantities for variants of an engine file.

    Args:
        model: Engine file.
        quantities: Quantities that the engine has.

    Attributes:
        of_engine: Quantities of forces and moments.
        of_chapters: Whether some quantities are those of chapters, which compute one variant after
            another, or some variants together (`computes_jointly`).
    """

    def __init__(self, model: EngineFile, quantities: Sequence[AnyQuantity]) -> None:
        self._model = model
        self._quantities = quantities
        self.of_engine = choose_of_engine(quantities)
        self._chapters = [
            (members, load_chapter(chapter).Variants(model, members))
            for chapter, members in group_by_chapter(quantities).items()
        ]
        self.of_chapters = bool(self._chapters)

    def computes_jointly(self, different: Collection[str], varied: Collection[str]) -> bool:
        """Return whether variants that differ only in some figures are computed together.

        Args:
            different: Dotted names of these figures.
            varied: Dotted names of all figures that vary.
        """
        if not self._chapters:
            return find_joint_figures(self._model, varied).all.issuperset(different)
        return all(
            isinstance(chapter, JointVariants) and chapter.joins(different, varied)
            for _, chapter in self._chapters
        )

    def build(self, figures: Mapping[str, Array], rank: int) -> Engine:
        """Return all variants, with their gas, as one engine with `rank` trailing axes.

        Raises:
            InputError: A variant is impossible.
        """
        return _vary_gas(self._model, build(self._model, figures, rank=rank), figures, rank)

    def evaluate(
        self, figures: Mapping[str, Array], shape: tuple[int, ...], engine: Engine | None = None
    ) -> dict[AnyQuantity, Array]:
        """Return each quantity, in the order of the constructor, as an array of this shape, in SI
        units or degrees.

        Args:
            figures: Figures that vary, by dotted name; they broadcast to the shape.
            shape: Shape of the variants.
            engine: Result of `build`, if known.

        Raises:
            InputError, BalcliError: A variant is impossible. The error names it if variants are
                computed one by one.
        """
        of_quantities: dict[AnyQuantity, Array] = {}
        if self.of_engine:
            engine = engine or self.build(figures, len(shape))
            values = evaluate_quantities(engine, self.of_engine)
            of_quantities |= dict(zip(self.of_engine, values, strict=True))
        if self._chapters:
            of_quantities |= self._evaluate_chapters(figures, shape)
        return {q: np.broadcast_to(of_quantities[q], shape) for q in self._quantities}

    def _evaluate_chapters(
        self, figures: Mapping[str, Array], shape: tuple[int, ...]
    ) -> dict[AnyQuantity, Array]:
        variants = list(_list_variants(figures, shape))
        joint = [_evaluate_jointly(chapter, variants) for _, chapter in self._chapters]
        rows: list[list[float]] = []
        for place, own in enumerate(variants):
            values: list[float] = []
            with naming_variant(tell_variant(own)), naming_file(""):
                for known, (_, chapter) in zip(joint, self._chapters, strict=True):
                    values += known.get(place) or chapter.evaluate(own)
            rows.append(values)
        quantities = [quantity for members, _ in self._chapters for quantity in members]
        columns = [column.reshape(shape) for column in np.array(rows).T]
        return dict(zip(quantities, columns, strict=True))


def _evaluate_jointly(
    chapter: Variants, variants: Sequence[Mapping[str, float]]
) -> dict[int, list[float]]:
    """Return what a chapter can evaluate together, as `JointVariants.evaluate_jointly`."""
    if len(variants) > 1 and isinstance(chapter, JointVariants):
        return chapter.evaluate_jointly(variants)
    return {}


# ------------------------------------------------------------------ lists of names
@dataclass(frozen=True)
class FileNumber:
    """A number of an engine file.

    Attributes:
        path: Dotted name, as used in `--vary`.
        value: Value in its unit, or "rigid" (infinite); null if it is not in the file.
        unit: Unit that the file assumes for a bare number; empty for plain numbers.
        meaning: Meaning in words.
    """

    path: str
    value: float | str | None
    unit: str
    meaning: str


@dataclass(frozen=True, kw_only=True)
class NamedNumbers:
    """Numbers of an engine file that can vary, and its quantities.

    Attributes:
        format: Name and version of the document.
        engine: The engine.
        numbers: Numbers of the file.
        quantities: Quantities of the engine.
    """

    format: Literal["balcli.numbers/1"] = "balcli.numbers/1"
    engine: EngineName
    numbers: tuple[FileNumber, ...]
    quantities: tuple[Form, ...]


def list_quantities(model: EngineFile) -> Iterator[Form]:
    """Yield the quantities of an engine file, chapter by chapter; N stands for any order.

    Raises:
        BalcliError, InputError: A chapter of the file has mistakes.
    """
    there = [form for form in FORMS if not form.table or getattr(model, form.table)]
    for chapter, forms in groupby(there, lambda form: form.chapter):
        if chapter == ENGINE:
            yield from forms
            continue
        listed = list(forms)
        for name in load_chapter(chapter).list_names(model):
            number = name.replace(".N.", ".1.")
            yield next(f for f in listed if f.matches(number))._replace(name=name)


def name_numbers(model: EngineFile) -> NamedNumbers:
    """Return the numbers of a file that `sweep` can vary, and the quantities of the file."""
    places = find_places(model)
    if model.web:
        from ..engine.web_rules import list_fixed  # loaded only for files with [[web]]

        for path in list_fixed(model, places):
            del places[path]
    return NamedNumbers(
        engine=EngineName(model.name),
        numbers=tuple(_describe(path, place) for path, place in places.items()),
        quantities=tuple(list_quantities(model)),
    )


def _describe(path: str, place: Place) -> FileNumber:
    value = float(place.value) if isinstance(place.value, int | float) else None
    meaning = document_keys(place.table)[place.key].description
    unit = place.reader.dimension.unit
    return FileNumber(path, RIGID if value == math.inf else value, unit, meaning)
