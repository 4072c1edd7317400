"""Make tables of forces and moments order by order, of their largest values over a revolution, and
of the torque and roll that gas and inertia make together.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..file.fields import order_number
from ..forces.kinds import FORCE, GAS_KINDS, KINDS, MOMENT, ROLL, Kind
from ..show.figures import peak_deg, phase_deg, size_or_mean
from ..show.sheet import (
    NEGLIGIBLE,
    NOTHING,
    UNKNOWN,
    Column,
    Facts,
    Grid,
    Shade,
    capitalized,
    degrees,
    number,
    order_name,
    size_cell,
    size_text,
    small_text,
)
from ..sizing.residual import is_small

if TYPE_CHECKING:
    from ..core.peaks import Peak
    from ..core.phasors import Complex, Phasors
    from ..forces.spectrum import Spectra
    from ..forces.symmetry import Textbook
    from ..show.figures import OrdersAndPeaks
    from ..show.sheet import View
    from ..show.units import ShownUnit, System


WHOLE_TURN = 360 - 1e-6  # deg; a longer interval between peaks counts as a whole turn
_LEVERS = "Forces along x make the moment My (marine: M1V, M2V), forces along y make Mx (M1H)."
_UPRIGHT_LEVERS = "A vertical force makes a pitching moment, a horizontal one a yawing moment."
_AS_BUILT = (
    "Values are for reciprocating masses in the planes of the throws, without devices, at steady "
    "speed; as built: with rotating masses and stagger as well."
)


def order_tables(
    spectra: Spectra,
    system: System,
    pivot: str,
    roll: str = "",
    *,
    with_gas: bool = False,
    every: bool = False,
) -> Iterator[Grid]:
    """Yield a table of each vector, a table of the torques about z, and one of torques with gas.

    Args:
        spectra: Spectra to show.
        system: System of units.
        pivot: Axis of couple and roll, in words.
        roll: Sentence that defines the roll, if it is not the couple C minus the torque T.
        with_gas: Whether the engine has gas; torques of inertia alone are then labelled as such.
        every: Whether to show orders above 2 that are balanced as well.
    """
    for kind, phasors in spectra.vectors():
        yield _vector_table(kind, phasors, system.unit(kind), every)
    inertia = f"{pivot} of inertia alone" if with_gas else pivot
    for kinds, subject, note in ((KINDS, inertia, roll), (GAS_KINDS, f"{pivot} with gas", "")):
        if (part := spectra.only(kinds)).scalars():
            yield _scalar_table(part, system.moment, note, subject, every)


def direction_tables(spectra: Spectra, system: System, *, every: bool = False) -> Iterator[Grid]:
    """Yield a table of the components of vectors, if there are any: along x and y, or vertical and
    horizontal if the file gives `frame.up`.

    Args:
        spectra: Spectra to show.
        system: System of units.
        every: As for `order_tables`.
    """
    up = spectra.up_deg
    kinds = []
    vectors = []
    units = []
    for kind, phasors in spectra.vectors():
        kinds.append(kind)
        vectors.append(phasors.turn(-(up or 0.0)))
        units.append(fit_largest(system.unit(kind), phasors))
    if not vectors:
        return

    def cells(k: int) -> Iterator[str]:
        for phasors, unit in zip(vectors, units, strict=True):
            for c in (phasors.x[k], phasors.y[k]):
                yield size_cell(abs(c), unit)
                yield degrees(float(phase_deg(c))) if c else ""

    if up is None:
        title = "Along x and y"
        levers = _LEVERS
        axes = [kind.symbol + axis for kind in kinds for axis in "xy"]
    else:
        title = f"Components with up at {up:g} deg from x"
        levers = _UPRIGHT_LEVERS
        axes = [word for kind in kinds for word in kind.upright]
    yield _table(
        f"{title}, {', '.join(unit.name for unit in units)}",
        [head for axis in axes for head in (axis, "deg")],
        vectors,
        cells,
        every,
        f"At crank angle θ: amplitude · cos(order θ − angle). {levers}",
    )


def textbook_tables(book: Textbook, system: System, *, every: bool = False) -> Iterator[Grid]:
    """Yield tables of force and moment as multiples of the units of textbooks (for order n: the
    largest force of order n of one cylinder's reciprocating mass), if the engine has such units.

    Args:
        book: Forces and moments, and their units in textbooks.
        system: System of units.
        every: As for `order_tables`.
    """
    units = book.units
    built = book.built
    if not units.force:
        return
    if built.force is not None:
        cylinder = "one cylinder" if units.equal else f"cylinder {units.cylinder}"
        note = (
            f"F1 = m r ω² = {size_text(units.force, system.force, 5)} "
            f"(m: reciprocating mass of {cylinder}); unit of order n: Fn = A_n F1. {_AS_BUILT}"
        )
        yield _textbook_table(FORCE, book, note, every)
    if built.moment is not None and not math.isnan(units.arm):
        arm = f"{number(system.length.of(units.arm))} {system.length.name}"
        note = f"a = {arm}, the smallest distance of neighbouring throws."
        if built.force is None:
            note += f" {_AS_BUILT}"
        yield _textbook_table(MOMENT, book, note, every)


def cylinder_tables(
    title: str, share: Spectra, system: System, *, about_crank: bool
) -> Iterator[Grid]:
    """Yield tables of the share of a cylinder or bank: vectors as size and angle, couple and
    torques as amplitude and phase.

    Args:
        title: Title of the tables.
        share: Spectra of the cylinder or bank.
        system: System of units.
        about_crank: Whether couple and torques are wanted.
    """
    orders = Column("order", [*map(order_name, share.orders)], words=True)
    vectors = [orders]
    scalars = [orders]
    for kind, phasors in share.vectors():
        for way, part in (("with", phasors.forward), ("against", phasors.backward)):
            vectors.append(_column(f"{kind.name} {way}", part, system.unit(kind)))
    for kind, phasors in share.scalars() if about_crank else ():
        scalars.append(_column(kind.name, phasors.x.conj(), system.moment))
    if len(vectors) > 1:
        yield Grid(title, vectors)
        title += ", about the crank"
    if len(scalars) > 1:
        yield Grid(title, scalars, "At crank angle θ: amplitude · cos(order θ − angle).")


def _column(name: str, values: Complex, unit: ShownUnit) -> Column:
    """Return a column of vectors as size and angle."""
    cells = [_write_polar(vector, unit) for vector in values.tolist()]
    return Column(f"{name}, {unit.name}", cells)


def _write_polar(vector: complex, unit: ShownUnit) -> str:
    """Return size and angle of a vector; a word if it is 0."""
    if not vector:
        return NOTHING
    angle = math.degrees(cmath.phase(vector))
    return f"{number(unit.of(abs(vector)))} ∠ {degrees(angle)}"


def peak_facts(
    result: OrdersAndPeaks, system: System, title: str, single: Mapping[str, float] | None = None
) -> Facts:
    """Return lines on the peaks (largest values over a revolution) that were computed.

    Args:
        result: Result with peaks.
        system: System of units.
        title: Title of the block.
        single: Value of each kind for one cylinder; peaks below 0.1 % of it are negligible.
    """
    pairs = []
    for kind, peak in result.peaks:
        is_known = kind is not MOMENT or result.moments_known
        least = NEGLIGIBLE * (single or {}).get(kind.name, 0.0)
        text = _peak(peak, system.unit(kind), least) if is_known else UNKNOWN
        at_most = result.peak.at_most.get(kind.name)
        if at_most is not None:
            size = size_text(at_most, system.unit(kind), 5)
            text = f"{text}; with the parts at other speeds at most {size}"
        pairs.append((kind.name, text))
    return Facts(tuple(pairs), title)


def _table(
    title: str,
    heads: Iterable[str],
    phasors: Sequence[Phasors],
    cells: Callable[[int], Iterable[str]],
    every: bool,
    note: str = "",
) -> Grid:
    """Return a table with a row for each order up to 2 and each higher order that is not balanced;
    with `every`, a row for each order.
    """
    columns = [Column("order", words=True), *map(Column, heads)]
    rows = []
    for k, order in enumerate(phasors[0].orders):
        if every or order <= 2 or not all(p.balanced[k] for p in phasors):
            rows.append((order_name(order), *cells(k)))
    return Grid.of_rows(title, columns, rows, note)


class VectorCells(NamedTuple):
    """Cells of one order of a force or moment.

    Attributes:
        largest: Largest value.
        smallest: Smallest value.
        axis: Direction of the largest value, deg.
        ahead: Size of the vector that turns with the crank.
        against: Size of the vector that turns against the crank.
    """

    largest: str
    smallest: str = ""
    axis: str = ""
    ahead: str = ""
    against: str = ""


def write_vector(
    phasors: Phasors, k: int, unit: ShownUnit, digits: int | None = None
) -> VectorCells:
    """Return the cells of one order of a force or moment.

    Args:
        phasors: Force or moment.
        k: Row of the order.
        unit: Unit of the cells.
        digits: As for `number`.
    """
    if phasors.balanced[k]:
        return VectorCells(NOTHING)
    largest = number(unit.of(float(phasors.major[k])), digits)
    if not phasors.orders[k]:  # a mean does not turn
        return VectorCells(largest, UNKNOWN, UNKNOWN, UNKNOWN, UNKNOWN)
    return VectorCells(
        largest,
        smallest=number(unit.of(float(phasors.minor[k])), digits),
        axis=degrees(float(phasors.axis_deg[k]), 180),
        ahead=number(unit.of(float(abs(phasors.forward)[k])), digits),
        against=number(unit.of(float(abs(phasors.backward)[k])), digits),
    )


def _vector_table(kind: Kind, phasors: Phasors, unit: ShownUnit, every: bool) -> Grid:
    unit = fit_largest(unit, phasors)
    heads = ("largest", "smallest", "axis, deg", "with crank", "against")
    title = f"{capitalized(kind.label)} by order, {unit.name}"
    return _table(title, heads, [phasors], lambda k: write_vector(phasors, k, unit), every)


def shade_sizes(phasors: Phasors, least: float | None) -> dict[int, Shade]:
    """Return the shades of the largest values of all orders.

    Args:
        phasors: Force or moment.
        least: Size from which a value is not small, SI; None: it is not known.
    """
    shades = {}
    for k, size in enumerate(phasors.major.tolist()):
        if phasors.balanced[k]:
            shades[k] = Shade.BALANCED
        elif least is not None and not is_small(size, least):
            shades[k] = Shade.LARGE
    return shades


def _scalar_table(spectra: Spectra, unit: ShownUnit, roll: str, subject: str, every: bool) -> Grid:
    kinds, phasors = zip(*spectra.scalars(), strict=True)
    unit = fit_largest(unit, *phasors)

    def cells(k: int) -> Iterator[str]:
        order = spectra.orders[k]
        for p in phasors:
            c = p.x[k]
            yield number(unit.of(size_or_mean(c, order))) if c else NOTHING
            yield degrees(float(peak_deg(c, order))) if c else ""

    heads: list[str] = []
    for kind in kinds:
        heads += [ROLL.name if roll and kind == ROLL else kind.label, "peak, deg"]
    return _table(f"About {subject}, {unit.name}", heads, phasors, cells, every, roll)


def fit_largest(unit: ShownUnit, *columns: Phasors) -> ShownUnit:
    """Return the unit that fits the largest known value."""
    return unit.fit(max(float(np.nan_to_num(p.major).max(initial=0)) for p in columns))


def _textbook_table(kind: Kind, book: Textbook, note: str, every: bool) -> Grid:
    """Return a table of multiples of each order's unit; a dash if the order has no unit."""
    alone = book.reciprocating[kind.name]
    built = book.built[kind.name]

    turning = (abs(alone.forward), abs(alone.backward))
    components = (abs(alone.x), abs(alone.y))
    columns = (alone.major, *turning, *components, built.major)

    def cells(k: int) -> Iterator[str]:
        size = book.units.size(kind, order_number(built.orders[k]))
        for column in columns:
            value = float(column[k])
            yield number(value / size) if value else NOTHING

    largest = f"largest, {book.units.name(kind)}"
    heads = (largest, "with crank", "against", "along x", "along y", "as built")
    title = f"{capitalized(kind.label)} in textbook units"
    return _table(title, heads, [alone, built], cells, every, note)


def _peak(peak: Peak, unit: ShownUnit, least: float) -> str:
    if not peak.value or peak.value < least:
        return small_text(peak.value, unit)
    size = size_text(peak.value, unit, 5)
    if not peak.every:
        return f"{size} at every crank angle"
    at = degrees(float(np.degrees(peak.theta)))
    every = float(np.degrees(peak.every))
    again = f" and every {every:.6g} deg" if every < WHOLE_TURN else ""
    return f"{size} at crank angle {at} deg{again}"


def gas_grid(spectra: Spectra, system: System, pivot: str, view: View) -> Iterator[Grid]:
    """Yield a table by order of inertia torque, gas torque, their sum and the roll of the frame, if
    all are known. Negligible orders are omitted by default.

    Args:
        spectra: Spectra to show.
        system: System of units.
        pivot: Axis of the roll, in words.
        view: Whether to show negligible orders as well, and to name the command that shows more.
    """
    torque = spectra.torque
    gas = spectra.gas
    total = spectra.torque_total
    roll = spectra.roll_total
    if torque is None or gas is None or total is None or roll is None:
        return
    every = (torque, gas, total, roll)
    unit = fit_largest(system.moment, *every)
    least = NEGLIGIBLE * max(float(p.major.max(initial=0)) for p in (torque, gas))
    rows = []
    for k, order in enumerate(spectra.orders.tolist()):
        if order in (1, 2) or view.every_order or max(p.major[k] for p in every) > least:
            sizes = [size_or_mean(complex(p.x[k]), order) for p in every]
            at = float(peak_deg(roll.x[k], order))
            peak = "" if math.isnan(at) else degrees(at)
            rows.append((order_name(order), *(size_cell(size, unit) for size in sizes), peak))
    heads = [
        Column("order", words=True),
        Column("inertia torque"),
        Column("gas torque"),
        Column("torque"),
        Column("roll of the frame"),
        Column("peak, deg"),
    ]
    note = "Torque = inertia + gas."
    if view.hints:
        note += " Mean torque, flywheel and more: balcli torque."
    yield Grid.of_rows(f"About {pivot} with gas, {unit.name}", heads, rows, note)
