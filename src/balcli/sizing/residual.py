"""Residual: free force, moment and roll of one order that a scheme has to cancel."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from ..engine.engine import Engine
from ..errors import MOMENTS_UNKNOWN, BalcliError
from ..file.fields import join_words
from ..forces.spectrum import compute_spectra
from ..limits import HIGHEST_ORDER_SOUGHT
from .options import SchemeOptions

PartKind = Literal["force", "moment", "roll"]  # names of kinds


class ResidualPart(NamedTuple):
    """One part of the free force, moment or roll of an order.

    Attributes:
        kind: "force", "moment" or "roll".
        sense: 1 turns with the crank, -1 against it; 0 for the roll, which does not turn.
    """

    kind: PartKind
    sense: int


FORWARD_FORCE, FORWARD_MOMENT = FORWARD = (ResidualPart("force", 1), ResidualPart("moment", 1))
BACKWARD_FORCE, BACKWARD_MOMENT = BACKWARD = (ResidualPart("force", -1), ResidualPart("moment", -1))
FORCE, MOMENT = (FORWARD_FORCE, BACKWARD_FORCE), (FORWARD_MOMENT, BACKWARD_MOMENT)
ROLL = ResidualPart("roll", 0)


class ReferencePoint(NamedTuple):
    """A point about which moments are taken: x + iy and z, m."""

    place: complex
    z: float


class Residual(NamedTuple):
    """Parts of one order that remain to be cancelled, as the unbalance that would make them.

    Attributes:
        order: n, times crank speed.
        parts: complex amplitude over `n^2 omega^2` of each part: force in kg m, moment (over i)
            and roll in kg m^2.
        noise: rounding error of each part, in the same units.
        reference: point about which moments and roll are taken.
        newtons_per_kg_m: `n^2 omega^2`, in N/(kg m).
        note: why lower orders are left, where a scheme chose this order.
    """

    order: int
    parts: dict[ResidualPart, complex]
    noise: dict[ResidualPart, float]
    reference: ReferencePoint
    newtons_per_kg_m: float
    note: str = ""

    def force(self, sense: int) -> complex:
        """Force turning in this sense (1 with the crank, -1 against it), kg m."""
        return self.parts[ResidualPart("force", sense)]

    def moment(self, sense: int) -> complex:
        """Moment over i turning in this sense (1 with the crank, -1 against it), kg m^2."""
        return self.parts[ResidualPart("moment", sense)]

    @property
    def roll(self) -> complex:
        """Amplitude of the roll, kg m^2."""
        return self.parts[ROLL]

    def has(self, kind: PartKind, senses: Sequence[int]) -> bool:
        """Whether anything of a kind turns in one of these senses."""
        return any(self.parts[ResidualPart(kind, sense)] for sense in senses)

    def size(self, *parts: ResidualPart) -> float:
        """Sum of the amplitudes of these parts at the engine's speed, N or N m."""
        return sum(abs(self.parts[part]) for part in parts) * self.newtons_per_kg_m


class Scales(NamedTuple):
    """Largest first-order force, moment and roll of one cylinder.

    Attributes:
        force: largest first-order force of a cylinder alone, N.
        moment: this force at the length of the engine, N m.
        roll: this force at the crank radius, N m.
    """

    force: float
    moment: float
    roll: float


def find_scales(engine: Engine) -> Scales:
    """Return the scales of an engine at its speed."""
    radius = np.ravel(engine.cylinders.radius).astype(float)
    masses = np.array([float(each.reciprocating) for each in engine.weighed])
    z = np.ravel(engine.cylinders.z)
    force = float(np.max(masses * radius)) * float(engine.omega) ** 2
    length = max(float(np.ptp(z)), 2 * float(radius.max()))
    return Scales(force, force * length, force * float(radius[0]))


def find_size(residual: Residual, sense: int, scales: Scales) -> float:
    """Return the size of what turns in a sense (1 with the crank, -1 against it): force and moment
    as shares of one cylinder's, the larger of both.
    """
    return max(find_share(residual, part, scales) for part in (FORWARD if sense > 0 else BACKWARD))


def find_share(residual: Residual, part: ResidualPart, scales: Scales) -> float:
    """Return the size of a force or moment as a share of one cylinder's."""
    size, scale = residual.size(part), scales.moment if part.kind == "moment" else scales.force
    return (size / scale if scale else math.inf) if size else 0.0


def is_small(size: float, least: float) -> bool:
    """Return whether a part is nothing, or small; one of the limit's size is not, but for
    rounding.

    Args:
        size: Size of the part.
        least: Size from which on a part is not small.
    """
    return not size or size < least * (1 - 1e-9)


class NothingToBalanceError(Exception):
    """There is nothing to balance, and a scheme fits no device; the text gives the reason.

    `details`: further figures of the scheme.
    """

    def __init__(self, text: str, **details: float) -> None:
        super().__init__(text)
        self.details = details


class OnlySmallError(Exception):
    """All parts that a scheme cancels are small; the text names the largest."""


def hold_steady(engine: Engine) -> Engine:
    """Return the engine at its mean speed, without speed ripple: devices are sized for that."""
    return replace(engine, ripple=())


def find_residual(engine: Engine, order: int) -> Residual:
    """Return the residual of an engine with its devices at one order and its mean speed; forces
    alone where moments are not known.
    """
    found = compute_spectra(hold_steady(engine), [order], ("force", "moment", "roll"))
    newtons_per_kg_m = order**2 * float(engine.omega) ** 2
    x, y, z = engine.reference_m
    parts: dict[ResidualPart, complex] = dict.fromkeys((*FORWARD, *BACKWARD, ROLL), 0j)
    noise: dict[ResidualPart, float] = {}
    for part in (*FORWARD, *BACKWARD):
        phasors = found[part.kind]
        vector = phasors.forward if part.sense > 0 else phasors.backward
        if part.kind == "force" or engine.places_known:
            per = 1j if part.kind == "moment" else 1
            parts[part] = complex(vector[0]) / per / newtons_per_kg_m
        noise[part] = float(np.broadcast_to(phasors.noise, vector.shape)[0]) / newtons_per_kg_m
    if found.roll:
        parts[ROLL] = 2 * complex(found.roll.forward[0]) / newtons_per_kg_m
    return Residual(order, parts, noise, ReferencePoint(complex(x, y), float(z)), newtons_per_kg_m)


def choose_residual(
    engine: Engine,
    options: SchemeOptions,
    kinds: Sequence[Literal["force", "moment"]],
    senses: Sequence[int] = (1, -1),
) -> Residual:
    """Return the residual of the given order, or else of the lowest order that has a part of these
    kinds that is not small.

    Args:
        senses: Senses of rotation that count: 1 with the crank, -1 against it.

    Raises NothingToBalanceError if no such part is left, BalcliError for a moment that is not
    known, OnlySmallError if all parts that are left are small.
    """
    if "moment" in kinds and not engine.places_known:
        raise BalcliError(MOMENTS_UNKNOWN)
    what = f"{' or '.join(kinds)}{' turning against the crank' * (tuple(senses) == (-1,))}"
    if options.order is None:
        return _find_lowest(engine, options, kinds, senses, what)
    residual = find_residual(engine, options.order)
    if any(residual.has(kind, senses) for kind in kinds):
        return residual
    rest = _tell_rest(residual, kinds, senses)
    with_crank = residual.size(FORWARD_FORCE) if 1 not in senses else 0.0
    raise NothingToBalanceError(
        f"order {options.order} has no free {what}: {'; '.join(['nothing to balance', *rest])}",
        **({"force_with_crank_left_N": with_crank} if with_crank else {}),
    )


def _find_lowest(
    engine: Engine,
    options: SchemeOptions,
    kinds: Sequence[PartKind],
    senses: Sequence[int],
    what: str,
) -> Residual:
    """Return the residual of the lowest order with a part of these kinds that is not small; its
    note lists the parts of lower orders.
    """
    scales, least = find_scales(engine), options.read_small()
    sought = [ResidualPart(kind, sense) for kind in kinds for sense in senses]
    rests: dict[str, list[int]] = {}
    found, small = [], []
    for order in range(1, HIGHEST_ORDER_SOUGHT + 1):
        residual = find_residual(engine, order)
        share = max(find_share(residual, part, scales) for part in sought)
        if not is_small(share, least):
            lowest = f"Order {order} is the lowest with a free {what}.{_tell_left_alone(rests)}"
            return residual._replace(note=lowest if rests else "")
        rest = _tell_rest(residual, kinds, senses)
        if share:
            small.append((share, residual))
            rest.append(f"its {what} is small")
        if rest:
            rests.setdefault("; ".join(rest), []).append(order)
        found.append(residual)
    if small:
        largest = max(small, key=lambda one: one[0])[1]
        raise OnlySmallError(tell_small(largest, sought, found, scales, least))
    left_alone = _tell_left_alone(rests)
    raise NothingToBalanceError(
        f"there is no free {what} of orders 1 to {HIGHEST_ORDER_SOUGHT}: nothing to balance; "
        f"--order names a higher one{'.' if left_alone else ''}{left_alone.removesuffix('.')}"
    )


def tell_small(
    largest: Residual,
    sought: Sequence[ResidualPart],
    found: Sequence[Residual],
    scales: Scales,
    least: float,
) -> str:
    """Return why nothing is fitted (all parts that the scheme cancels are small), and which scheme
    cancels the largest part of all.

    Args:
        largest: Residual of the order with the largest part that the scheme cancels.
        sought: Parts that it cancels.
        found: Residuals of all orders.
        scales: Force, moment and roll of one cylinder.
        least: Share of it below which a part is small.
    """
    part = max(sought, key=lambda one: find_share(largest, one, scales))
    told = (
        f"the largest {part.kind} {_turning(part)} is {_tell_size(largest, part)} "
        f"(order {largest.order}), small compared with one cylinder's; "
        f"--order {largest.order} fits it"
    )
    senses = {part.sense for part in sought}
    parts = [part for part in (*FORWARD, *BACKWARD) if part.sense in senses]
    every = [(find_share(one, part, scales), one, part) for one in found for part in parts]
    if is_small(max(share for share, *_ in every), least):  # in these senses
        parts = [*FORWARD, *BACKWARD]
        every = [(find_share(one, part, scales), one, part) for one in found for part in parts]
    share, one, part = max(every, key=lambda each: each[0])
    if is_small(share, least):
        return told
    takes = "couple-shaft" if part.kind == "moment" else "two-shaft"
    takes = "single-shaft" if part == BACKWARD_FORCE else takes
    takes = "counterweights" if one.order * part.sense == 1 else takes
    size, ratio = _tell_size(one, part), part.sense * one.order
    return f"{told}. {takes} takes the {part.kind} of {size} at {ratio:+d}"


def _turning(part: ResidualPart) -> str:
    return "with the crank" if part.sense > 0 else "against the crank"


def _tell_size(residual: Residual, part: ResidualPart) -> str:
    return f"{residual.size(part):.4g} {'N·m' if part.kind == 'moment' else 'N'}"


def _tell_left_alone(rests: Mapping[str, Sequence[int]]) -> str:
    """Return sentences on the orders that are left, grouped by the parts that they have."""
    told = ""
    for rest, orders in rests.items():
        if len(orders) == 1:
            told += f" Order {orders[0]} stays as it is ({rest})."
        else:
            of_several = rest.replace("it has", "they have").replace("its ", "their ")
            each = join_words([f"{order}" for order in orders])
            told += f" Orders {each} stay as they are ({of_several})."
    return told


def _tell_rest(residual: Residual, kinds: Sequence[PartKind], senses: Sequence[int]) -> list[str]:
    """Return the other parts of an order, and the schemes that cancel them."""
    if 1 in senses:
        takes: dict[PartKind, str] = {"moment": "couple-shaft", "force": "two-shaft"}
        others = [what for what in takes if what not in kinds and residual.has(what, senses)]
        far = ", or far from the engine two-shaft with --order and --position as moment compensator"
        return [f"it has a free {what}: {takes[what]}{far * (what == 'moment')}" for what in others]
    rest = []
    if forward := [part.kind for part in FORWARD if residual.parts[part]]:
        shaft = f"a shaft at +{residual.order}"
        cure = "the scheme counterweights" if residual.order == 1 else shaft
        rest.append(f"its {' and '.join(forward)} turning with the crank: {cure}")
    if "moment" not in kinds and residual.has("moment", senses):
        rest.append("its moment turning against the crank: eccentrics in two planes")
    return rest
