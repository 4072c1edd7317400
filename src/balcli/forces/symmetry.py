"""Express free forces and moments as multiples of those of one cylinder, and find out whether an
order is balanced by symmetry or by chance.

Multiples: textbooks state forces of order n as multiples of one cylinder's `F_n = A_n F1`, with `F1
= m_rec r omega^2`: the product of reciprocating mass, crank radius and squared crank speed. A_n is
the coefficient of order n of the piston acceleration (docs/theory.md). Moments are multiples of
`F_n a`, where a is the smallest distance of neighbouring throws. The cylinder is number 1, or its
master cylinder if its rod is articulated.
Textbooks consider only reciprocating masses, each in the plane of its throw, because counterweights
balance rotating masses. Source: Bosch, Automotive Handbook, "Free forces and moments of the 1st and
2nd order".

Symmetry (docs/theory.md): an order that is balanced by symmetry stays balanced if masses, rod
length or gas change equally in all cylinders. So the engine is computed a few times with such
changes. If an order is still balanced to rounding, the layout balances it. The speed is a
common factor of all forces and needs no test.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from operator import attrgetter
from typing import NamedTuple, cast

import numpy as np

from ..core.mechanisms import harmonics
from ..core.mechanisms.linkage import Articulated
from ..core.phasors import Array
from ..engine.engine import Engine
from ..file.fields import order_number
from .kinds import EVERY_KIND, GAS, KINDS, ROLL, TORQUE, Kind
from .spectrum import Spectra, compute_spectra, merge_orders

# ------------------------------------------------------------------ multiples of one cylinder
_NO_FORCE = 1e-12  # smaller coefficients A_n count as 0


class TextbookUnits(NamedTuple):
    """Units of the multiples in which textbooks state forces and moments.

    Attributes:
        orders: Orders, shape (orders,).
        force: F1, N.
        arm: Smallest distance a of neighbouring throws, m; nan if all are in one plane.
        ratios: |A_n| of each order, shape (orders,).
        cylinder: Number of the cylinder to which the units refer.
        equal: Whether all cylinders are equal.
        crank_ratio: Crank radius over rod length of this cylinder; 0 in harmonic motion.
        offset: Whether its piston pin moves beside the crank axis.
    """

    orders: Array
    force: float
    arm: float
    ratios: Array
    cylinder: int
    equal: bool
    crank_ratio: float
    offset: bool

    def size(self, kind: Kind, order: float) -> float:
        """Return F_n of an order, N, or F_n a, N m; nan if there is no such force or arm.

        Args:
            kind: Kind of force or moment.
            order: One of the orders.
        """
        ratio = float(self.ratios[np.searchsorted(self.orders, order)])
        if not self.force or ratio < _NO_FORCE:
            return float("nan")
        return self.force * ratio * (1.0 if kind.dimension == "force" else self.arm)

    def name(self, kind: Kind, order: object = "n") -> str:
        """Return the symbol of the unit of an order.

        Args:
            kind: Kind of force or moment.
            order: Order as it is printed.
        """
        return f"F{order}" if kind.dimension == "force" else f"F{order}·a"


class Textbook(NamedTuple):
    """An engine's forces and moments with their units in textbooks.

    Attributes:
        units: Units of the multiples.
        reciprocating: Forces, N, and moments, N m, as textbooks count them: of reciprocating masses
            in the planes of their throws.
        built: Forces and moments of all masses of the cylinders at their real axial positions,
            without devices, at a steady speed.
    """

    units: TextbookUnits
    reciprocating: Spectra
    built: Spectra


def find_textbook(engine: Engine, orders: Array, kinds: Collection[str]) -> Textbook:
    """Return the forces of an engine as textbooks count them and as built, with the units of
    multiples.

    Args:
        engine: One engine, not an array of variants.
        orders: Orders, shape (orders,).
        kinds: Names of kinds of forces and moments.
    """
    built = without_devices(engine)
    return Textbook(
        find_textbook_units(engine, orders),
        compute_spectra(with_reciprocating_only(built), orders, kinds),
        compute_spectra(built, orders, kinds),
    )


def without_devices(engine: Engine) -> Engine:
    """Return the engine without devices, at a steady speed, with moments about the crank's axis."""
    return replace(engine, devices=(), ripple=(), reference_m=(0.0, 0.0, engine.reference_m[2]))


def with_reciprocating_only(engine: Engine) -> Engine:
    """Return the engine without rotating masses, every cylinder in the plane of its throw."""
    c = engine.cylinders
    planes = engine.throws_m[[weighed.throw for weighed in engine.weighed]]
    return replace(engine, cylinders=replace(c, z=planes, rotating=0 * c.rotating))


def find_textbook_units(engine: Engine, orders: Array) -> TextbookUnits:
    """Return the units in which textbooks express the forces of an engine.

    Args:
        engine: One engine, not an array of variants.
        orders: Orders, shape (orders,).
    """
    c = engine.cylinders
    row = engine.numbers.index(1)
    if c.linkage is not None and not engine.rotary:
        row = int(cast(Articulated, c.linkage).master[row])
    figures = (c.lam, c.eps, c.reciprocating * c.radius)
    lam, eps, unbalance = (np.broadcast_to(v, c.count)[row : row + 1] for v in figures)
    series = harmonics.find_harmonics(orders, lam, eps, {"piston"})["piston"]
    gaps = np.diff(np.unique(np.round(engine.throws_m, 9)))
    return TextbookUnits(
        orders=orders,
        force=float(unbalance[0]) * float(engine.omega) ** 2,
        arm=float(gaps.min()) if gaps.size else float("nan"),
        ratios=np.abs(series.c[:, 0]),
        cylinder=int(engine.numbers[row]),
        equal=engine.equal,
        crank_ratio=float(lam[0]),
        offset=bool(eps[0]),
    )


# ------------------------------------------------------------------ symmetry or chance
TURNING = "turning"  # group of torque and roll, which have one reason in common
_GROUPS = [TURNING if name == TORQUE.name else name for name in EVERY_KIND]  # in the order of print
_WORDS = {TURNING: "torque and roll", GAS.name: "gas torque"}  # names of groups in words
NEARLY = 1e-2  # an order is nearly balanced below this share of the amplitude of one cylinder
_DRAWS = 3
_SEED = 1
_EVEN = 1e-11  # intervals that differ by less than this share of a cycle are equal


class Reason(NamedTuple):
    """Whether one order of a group of kinds is balanced, and how.

    Attributes:
        order: Order, above 0.
        quantity: Group of kinds: force, moment, couple, turning (torque and roll) or gas.
        verdict: "none": no cylinder has this order; "symmetry": balanced for any masses and rod
            length that all cylinders have in common; "chance": balanced for these figures only;
            "nearly": less than 1 % of one cylinder remains; "unbalanced".
        size: Remaining amplitude, as a multiple of the largest amplitude of a single cylinder.
        reciprocating: Remaining amplitude of only the reciprocating masses, as textbooks state it,
            in `unit`.
        built: Remaining amplitude of the engine as built, in `unit`.
        unit: F_n of the order, or F_n a; empty if there is no such unit.
    """

    order: float
    quantity: str
    verdict: str
    size: float
    reciprocating: float | None
    built: float | None
    unit: str

    @property
    def finding(self) -> str:
        """The verdict in words, with the remaining amplitude in the textbook's unit if there is
        one.
        """
        rest = f"{self.size:.4g} times that of one cylinder"
        if self.reciprocating is not None:
            alone = f"{self.reciprocating:.4g}"
            built = f"{self.built:.4g}"
            rest = f"{alone} {self.unit}" + (f" ({built} as built)" if built != alone else "")
            if alone == "0":
                rest = f"{built} {self.unit} as built (0 without rotating masses and stagger)"
        return {
            "none": "zero in every cylinder",
            "symmetry": "balanced by symmetry of the layout",
            "chance": "balanced by chance, for these figures only",
            "nearly": f"nearly balanced: {self.size:.1g} times that of one cylinder",
            "unbalanced": f"unbalanced: {rest}",
        }[self.verdict]


class Symmetry(NamedTuple):
    """Whether each order of each group of kinds is balanced, and how.

    Attributes:
        reasons: Reason for every order and group.
        firing: Whether the engine fires evenly, in words; empty if it is not known.
        scope: What is ignored (devices, uneven speed, place of the point of reference), in words;
            omitted if nothing is ignored.
    """

    reasons: tuple[Reason, ...]
    firing: str
    scope: str | None = None

    @property
    def sentences(self) -> tuple[str, ...]:
        """All findings in words; orders with the same finding share a sentence."""
        orders: dict[tuple[str, str], list[str]] = {}
        for reason in sorted(self.reasons, key=lambda reason: _GROUPS.index(reason.quantity)):
            subject = _WORDS.get(reason.quantity, reason.quantity)
            orders.setdefault((subject, reason.finding), []).append(f"{reason.order:g}")
        findings = (
            f"order{'s' * (len(names) > 1)} {', '.join(names)} {subject}: {finding}"
            for (subject, finding), names in orders.items()
        )
        return tuple(filter(None, (self.scope, *findings, self.firing)))


def explain_symmetry(
    engine: Engine, orders: Iterable[float], kinds: Collection[str] = tuple(KINDS)
) -> Symmetry:
    """Find out whether the cylinders alone, without devices and at steady speed, are balanced by
    symmetry or by chance.

    Moments are about the engine's point of reference; couple, torque and roll are about the crank's
    axis.

    Args:
        engine: One engine, not an array of variants.
        orders: Orders, multiples of 1/2 above 0.
        kinds: Names of kinds (`kinds.EVERY_KIND`); torque and roll have one reason in common.
    """
    groups = dict(_list_groups(kinds, with_gas=engine.gas is not None))
    reasons = _find_reasons(without_devices(engine), merge_orders(orders), groups)
    devices = engine.devices
    coupling = sum(device.is_coupling for device in devices)
    scope = {
        "without counterweights, shafts and sliders": len(devices) > coupling,
        "without coupling rods": coupling,
        "at steady speed": engine.ripple,
        "couple and roll about the crank's axis": any(engine.reference_m[:2]),
    }
    left_out = ", ".join(text for text, there in scope.items() if there)
    return Symmetry(
        tuple(sorted(reasons, key=attrgetter("order"))),
        describe_firing(engine),
        f"cylinders only: {left_out}" if left_out else None,
    )


def _list_groups(
    kinds: Collection[str], *, with_gas: bool
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield each group of kinds that are judged together, with the kinds that are computed for it,
    in the order of the table of kinds. Sums of gas and inertia are not judged.
    """
    for name, kind in KINDS.items():
        if name in kinds and kind not in (TORQUE, ROLL):
            yield name, kind.parts
        elif name in kinds:
            yield TURNING, ROLL.parts
    if GAS.name in kinds and with_gas:
        yield GAS.name, GAS.parts


def _find_reasons(
    engine: Engine, orders: Array, groups: Mapping[str, tuple[str, ...]]
) -> Iterator[Reason]:
    parts = [part for own in groups.values() for part in own]
    book = find_textbook(engine, orders, parts)
    by_cylinder = compute_spectra(engine, orders, parts, by_cylinder=True)
    redrawn = [compute_spectra(other, orders, parts) for other in _draw(engine)]
    for group, own in groups.items():
        for row, order in enumerate(orders.tolist()):
            largest = {part: by_cylinder[part].major[row].max() for part in own}
            present = [part for part in own if largest[part]]
            left = [book.built[part].major[row] / largest[part] for part in present]
            size = float(max(left, default=0.0))
            balanced = [
                all(found[part].balanced[row] for part in present)
                for found in (book.built, *redrawn)
            ]
            verdict = "none" if not present else "nearly" if size < NEARLY else "unbalanced"
            if present and balanced[0]:
                verdict = "symmetry" if all(balanced) else "chance"
            number = order_number(order)
            alone = None
            built = None
            unit = ""
            if present and group in ("force", "moment"):
                kind = KINDS[group]
                force = book.units.size(KINDS[group], number)
                if not np.isnan(force):
                    alone, built = (float(found[group].major[row] / force) for found in book[1:])
                    unit = book.units.name(kind, number)
            rest = 0.0 if balanced[0] else size
            yield Reason(number, group, verdict, rest, alone, built, unit)


def _draw(engine: Engine) -> Iterator[Engine]:
    """Yield the engine with other masses, rod length and gas, changed equally in all cylinders."""
    c = engine.cylinders
    random = np.random.default_rng(_SEED)

    def redraw(masses: Array) -> Array:
        factor, more = random.uniform(0.5, 2, 2)
        return np.where(masses, factor * masses + more * np.abs(masses).max(), 0)

    for _ in range(_DRAWS):
        longer = random.uniform(0.5, 0.9)
        cylinders = replace(
            c,
            lam=longer * c.lam,
            eps=longer * c.eps,
            reciprocating=redraw(c.reciprocating),
            rotating=redraw(c.rotating),
            couple=redraw(c.couple),
        )
        factors = random.uniform(0.5, 2, c.count)
        gas = engine.gas
        if gas is not None:  # cylinders with the same torque over their cycle have one factor
            each = (g._replace(share=g.share * float(factors[g.like])) for g in gas.cylinders)
            gas = replace(gas, cylinders=tuple(each))
        yield replace(engine, cylinders=cylinders, gas=gas)


def describe_firing(engine: Engine) -> str:
    """Return in words whether the engine fires evenly; empty if the firing order is not known."""
    if not engine.fires_deg:
        return ""
    cycle = 180 * engine.strokes
    instants = sorted(float(t) % cycle for t in engine.fires_deg.values())
    gaps = [b - a for a, b in pairwise([*instants, instants[0] + cycle])]
    uneven = max(gaps) - min(gaps)
    least = f"{min(gaps):.6g}"
    most = f"{max(gaps):.6g}"
    if uneven <= _EVEN * cycle or least == most:
        return f"firing: even, every {cycle / len(gaps):.6g} deg"
    if uneven < NEARLY * cycle / len(gaps):
        return f"firing: nearly even, every {least} to {most} deg"
    return f"firing: uneven, at intervals of {', '.join(f'{gap:.6g}' for gap in gaps)} deg"
