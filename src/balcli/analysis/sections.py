"""Show results of an analysis as tables and CSV: shear forces, bending moments and bearing loads
along the crankshaft, guide-force moments by order, strokes and dead centres, and the reasons why
orders are balanced.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.records import write_each
from ..forces.kinds import Kind
from ..show.figures import FigureRow, clean, order_rows, peak_rows
from ..show.sheet import (
    UNKNOWN,
    Column,
    Facts,
    Grid,
    Text,
    capitalized,
    degrees,
    number,
    order_name,
    size_cell,
    size_text,
    unit_cell,
)
from .order_tables import fit_largest
from .records import describe_guide, list_load_orders

if TYPE_CHECKING:
    from ..core.phasors import Array, Phasors
    from ..forces.crankshaft import AlongCrank, InnerLoads
    from ..forces.guide import GuideMoments
    from ..forces.stars import Bank, Star
    from ..forces.symmetry import Symmetry
    from ..show.units import ShownUnit, System
    from .records import Stroke


_OPEN_END = (
    "Bearing forces are not included. The value at the last position is therefore the free moment "
    "of all these loads about this position. The mounts carry this moment."
)
_TOGETHER = (
    "These are loads of inertia: gas presses equally on throw and cylinder head, so it does not "
    "bend crankshaft and block as a whole."
)
_BEHIND = "Values are those just behind each load, on its flywheel side."
_ASSUMED = (
    "Main bearings are assumed half-way between throws, and at the same distance outside the end "
    "throws."
)
_CUT = "The crankshaft is treated as if cut in each bearing."
ORDERS_SHOWN = 6  # largest number of orders in a table, which has a column for each


def _name_force(name: str, label: str) -> Kind:
    return Kind(name, label, "", f"{name}_N", vector=True, dimension="force")


def _name_moment(name: str, label: str) -> Kind:
    return Kind(name, label, "", f"{name}_Nm", vector=True)


LOADS = (  # along the crank, by inertia alone and with gas
    _name_force("shear", "shear force in the crankshaft"),
    _name_moment("bending", "bending moment in the crankshaft"),
    _name_force("bearing", "load of a main bearing"),
    _name_force("shaft_shear", "shear force in the crankshaft with gas"),
    _name_moment("shaft_bending", "bending moment in the crankshaft with gas"),
    _name_force("main", "load of a main bearing with gas"),
    _name_force("block_shear", "shear force in the block with gas"),
    _name_moment("block_bending", "bending moment in the block with gas"),
)


def list_loads(inner: InnerLoads) -> list[tuple[Kind, AlongCrank]]:
    """Return each load along the crank that is known, with its kind."""
    loads = {"shear": inner.shear, "bending": inner.bending, "bearing": inner.bearings}
    gas = inner.with_gas
    if gas is not None:
        loads["shaft_shear"] = gas.shear
        loads["shaft_bending"] = gas.bending
        loads["main"] = gas.bearings
        loads["block_shear"] = gas.block_shear
        loads["block_bending"] = gas.block_bending
    known = {name: along for name, along in loads.items() if along is not None}
    return [(kind, known[kind.name]) for kind in LOADS if kind.name in known]


def sheet_parts(inner: InnerLoads, system: System) -> Iterator[Grid | Facts | Text]:
    """Yield a table of each load, with a row for each place, and the largest bending moments.

    Args:
        inner: Loads along the crankshaft.
        system: System of units.
    """
    with_gas = inner.with_gas is not None
    bending = f"{_TOGETHER} {_OPEN_END}" if with_gas else _OPEN_END
    cut = _CUT if inner.has_given_bearings else f"{_ASSUMED} {_CUT}"
    notes = {"shear": _BEHIND, "bending": bending, "bearing": cut, "main": cut}
    moments = []
    for kind, along in list_loads(inner):
        title = capitalized(kind.label)
        if with_gas and kind.name in ("shear", "bending"):
            title = title.replace("crankshaft", "crankshaft and block together")
        if not (with_gas and kind.name == "bearing"):  # the table with gas replaces it
            yield _grid(along, title, system.unit(kind), system.length, notes.get(kind.name, ""))
        if kind.dimension == "moment":
            moments.append(_tell_largest(along, system))
    places = ("largest inner moment", "in the crankshaft", "in the block")
    yield Facts(tuple(zip(places, moments, strict=False)))
    if inner.obstacle:
        yield Text("", (f"{_TOGETHER} Loads with gas are not known: {inner.obstacle}.",))


def rows(inner: InnerLoads, system: System) -> Iterator[FigureRow]:
    """Yield the figures of every place. Places are numbered along the crank (`shear 1`), and the
    position of each is also a figure.

    Args:
        inner: Loads along the crankshaft.
        system: System of units.
    """
    length = system.length
    for kind, along in list_loads(inner):
        for k, z in enumerate(along.z_m):
            place = f"{kind.name} {k + 1}"
            unit = system.unit(kind)
            yield FigureRow(0, place, None, "position", clean(length.of(z)), length.name)
            yield from peak_rows(place, along.peaks[k], unit)
            for entry in write_each(list_load_orders(along.at(k))):
                yield from order_rows(place, entry.pop("order"), entry, unit)


def _grid(along: AlongCrank, title: str, unit: ShownUnit, length: ShownUnit, note: str) -> Grid:
    """Return a table with a row for each place: the peak over a revolution, and the largest value
    of each of the first orders.
    """
    unit = unit.fit_values(peak.value for peak in along.peaks)
    heads = [Column(f"place, {length.name}", words=True), Column("largest"), Column("deg")]
    for order in along.phasors.orders[:ORDERS_SHOWN]:
        heads.append(Column(f"order {order_name(order)}"))
    rows = []
    for k, (z, peak) in enumerate(zip(along.z_m, along.peaks, strict=True)):
        angle = degrees(math.degrees(peak.theta)) if peak.value else ""
        row = [unit_cell(float(z), length), size_cell(peak.value, unit, digits=None), angle]
        for size in along.at(k).major[:ORDERS_SHOWN]:
            row.append(unit_cell(float(size), unit))
        rows.append(row)
    return Grid.of_rows(f"{title}, {unit.name}", heads, rows, note)


def _tell_largest(bending: AlongCrank, system: System) -> str:
    moment, place_mm = bending.highest
    place = number(system.length.of(place_mm / 1e3))
    return f"{size_text(moment, system.moment, 5)} at {place} {system.length.name}"


_ALONE = "of inertia only, without gas"


def lay_out_guide(guide: GuideMoments, system: System) -> Grid:
    """Return a table of guide-force moments with a row for each order.

    Args:
        guide: Guide-force moments.
        system: System of units.
    """
    unit = fit_largest(system.moment, *filter(None, (guide.h, guide.x)))

    def write(moment: Phasors | None, k: int) -> str:
        size = None if moment is None else float(moment.major[k])
        return size_cell(size, unit, digits=None)

    heads = [Column("order", words=True), Column("H-type"), Column("X-type")]
    rows = []
    for k, order in enumerate(guide.h.orders):
        rows.append((order_name(order), write(guide.h, k), write(guide.x, k)))
    causes = "of inertia and gas" if guide.with_gas else _ALONE
    note = define_guide_moments(guide.height_m, system)
    return Grid.of_rows(f"Guide-force moments {causes}, {unit.name}", heads, rows, note)


def define_guide_moments(height_m: Array, system: System) -> str:
    """Return a note that defines the H- and X-type moments.

    Args:
        height_m: Height of the guides, m, shape (cylinders,).
        system: System of units.
    """
    return (
        "H-type: sum of the cylinders' guide-force couples. X-type: the same sum, with each couple "
        "multiplied by the axial distance of its cylinder from the point of reference and divided "
        f"by L = {_heights(height_m, system)} (crankshaft to middle of guide; default: rod length)."
    )


def list_guide(guide: GuideMoments, system: System) -> Iterator[FigureRow]:
    """Yield the guide-force moments of every order: H-type, then X-type.

    Args:
        guide: Guide-force moments.
        system: System of units.
    """
    for entry in write_each(describe_guide(guide).orders):
        for name, key in (("guide_h", "h_Nm"), ("guide_x", "x_Nm")):
            if key in entry:
                yield from order_rows(name, entry["order"], entry[key], system.moment)


def _heights(height_m: Array, system: System) -> str:
    """Return in words the height of all guides, or the lowest and the highest."""
    ends = (float(height_m.min()), float(height_m.max()))
    if not np.isfinite(ends).all():  # the rods of harmonic motion have no length
        return UNKNOWN
    texts = dict.fromkeys(number(system.length.of(height)) for height in ends)
    return f"{' to '.join(texts)} {system.length.name}"


def list_strokes(travel: Sequence[Stroke], system: System) -> Iterator[FigureRow]:
    """Yield the stroke and the angles of both dead centres of each cylinder.

    Args:
        travel: Strokes and dead centres of the cylinders.
        system: System of units.
    """
    length = system.length
    for stroke in travel:
        about = stroke.cylinder, "travel", None
        yield FigureRow(*about, "stroke", length.of(stroke.stroke_m), length.name)
        yield FigureRow(*about, "top_deg", stroke.top_deg, "deg")
        yield FigureRow(*about, "bottom_deg", stroke.bottom_deg, "deg")


UNITS = (
    "Fn: largest force of order n of one cylinder's reciprocating masses; a: smallest axial "
    "distance of two throws; as built: with rotating masses and stagger."
)


_TURNS = {"forward": "with", "backward": "against"}
_STARS = (
    "Vectors of the cylinders at crank angle 0, without devices: directions from x, cylinders in "
    "each direction, and sums. closes: the polygon of the vectors closes, so that their sum is 0. "
    "`balcli plot --what stars` draws the stars."
)


def lay_out_symmetry(why: Symmetry) -> Text:
    """Return a paragraph for each reason and its orders, then the meaning of the units."""
    units = (UNITS,) if any(reason.unit for reason in why.reasons) else ()
    return Text("Why", (*why.sentences, *units))


def lay_out_stars(stars: Sequence[Star], system: System) -> Grid:
    """Return a table of the stars: a row for each bank, and one for the sum of several banks.

    Args:
        stars: Vectors of each order, of which there is at least one.
        system: System of units.
    """
    every: list[Star | Bank] = [*stars]
    for star in stars:
        every += star.banks
    force = system.force.fit_values(abs(vectors.force) for vectors in every)
    moment = system.moment.fit_values(abs(vectors.moment or 0.0) for vectors in every)
    rows = []
    for star in stars:
        about = order_name(star.order), _TURNS[star.turns]
        for bank in star.banks:
            rows.append(_Sum(star, bank, *about, _tell_directions(bank)))
            about = "", ""
        if len(star.banks) > 1:
            rows.append(_Sum(star, star, "", "", "all banks"))
    heads = [
        Column("order", words=True),
        Column("turns", words=True),
        Column("directions, deg: cylinders", words=True),
        Column(f"force, {force.name}"),
    ]
    has_moments = stars[0].moment is not None
    if has_moments:
        heads.append(Column(f"moment, {moment.name}"))
    cells = []
    for row in rows:
        line = [row.order, row.turns, row.directions, row.write_force(force)]
        if has_moments:
            line.append(row.write_moment(moment))
        cells.append(line)
    return Grid.of_rows("Phasor stars", heads, cells, _STARS)


def _tell_directions(bank: Bank) -> str:
    """Return each direction of a bank's vectors with its cylinders."""
    directions = []
    for angle, numbers in bank.directions.items():
        directions.append(f"{degrees(angle)}: {', '.join(map(str, numbers))}")
    return "; ".join(directions)


class _Sum(NamedTuple):
    """A row of the table of stars: a bank, or the sum of all banks.

    Attributes:
        star: Star to which the row belongs.
        vectors: The bank, or the star for the sum of all banks.
        order: Order; empty if the row above has it.
        turns: Direction in which the vectors turn; empty if the row above has it.
        directions: Directions of the vectors, and their cylinders.
    """

    star: Star
    vectors: Star | Bank
    order: str
    turns: str
    directions: str

    def write_force(self, unit: ShownUnit) -> str:
        """Return the size of the force; a word if it is 0."""
        force = self.vectors.force
        return number(unit.of(abs(force))) if force else "closes"

    def write_moment(self, unit: ShownUnit) -> str:
        """Return the size of the moment; a word if it is 0, a dash if no cylinder has one."""
        rays = [ray for bank in self.star.banks for ray in bank.cylinders]
        if not any(ray.moment for ray in rays):
            return UNKNOWN
        moment = self.vectors.moment
        return number(unit.of(abs(moment))) if moment else "closes"


def list_symmetry(why: Symmetry) -> Iterator[FigureRow]:
    """Yield the reasons for each order, and the remaining amplitudes relative to one cylinder and
    in units of textbooks.
    """
    for reason in why.reasons:
        about = 0, reason.quantity, reason.order
        yield FigureRow(*about, "why", reason.verdict, "")
        yield FigureRow(*about, "why_size", clean(reason.size), "of one cylinder")
        if reason.reciprocating is not None:
            yield FigureRow(*about, "why_reciprocating", clean(reason.reciprocating), reason.unit)
            yield FigureRow(*about, "why_built", reason.built, reason.unit)
    for name, reason_of_all in (("scope", why.scope), ("firing", why.firing)):
        if reason_of_all:
            yield FigureRow(0, name, None, "why", reason_of_all, "")
