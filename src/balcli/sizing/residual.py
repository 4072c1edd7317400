"""Compute the free force, moment and roll of one order that a scheme has to cancel (`Residual`), as
rotating vectors, and their sizes compared with one cylinder.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Literal, NamedTuple, cast

import numpy as np

from ..engine.engine import Engine
from ..errors import MOMENTS_UNKNOWN, ArgumentError, BalcliError, Message
from ..file.fields import join_words
from ..forces.spectrum import compute_spectra
from ..limits import HIGHEST_ORDER_SOUGHT
from .options import SchemeOptions

PartKind = Literal["force", "moment", "roll"]  # names in `forces.kinds`


class ResidualPart(NamedTuple):
    """One rotating vector of the free force or moment of an order, or the roll of an order.

    Attributes:
        kind: "force", "moment" or "roll".
        sense: 1 if the vector turns with the crank, -1 if it turns against it; 0 for the roll, a
            scalar.
    """

    kind: PartKind
    sense: int


FORWARD_FORCE = ResidualPart("force", 1)
FORWARD_MOMENT = ResidualPart("moment", 1)
BACKWARD_FORCE = ResidualPart("force", -1)
BACKWARD_MOMENT = ResidualPart("moment", -1)
FORWARD = (FORWARD_FORCE, FORWARD_MOMENT)
BACKWARD = (BACKWARD_FORCE, BACKWARD_MOMENT)
FORCE = (FORWARD_FORCE, BACKWARD_FORCE)
MOMENT = (FORWARD_MOMENT, BACKWARD_MOMENT)
ROLL = ResidualPart("roll", 0)
_SCHEMES = {FORWARD_FORCE: "two-shaft", BACKWARD_FORCE: "single-shaft"}  # schemes that cancel parts
_SCHEMES |= dict.fromkeys(MOMENT, "couple-shaft")


def list_parts(sense: int) -> tuple[ResidualPart, ResidualPart]:
    """Return the force and moment that turn in one direction: 1 with the crank, -1 against it."""
    return FORWARD if sense > 0 else BACKWARD


class ReferencePoint(NamedTuple):
    """A point about which moments are taken: x + iy and z, m."""

    place: complex
    z: float


class Residual(NamedTuple):
    """Force, moment and roll of one order that remain to be cancelled, as the unbalances that would
    cause them.

    Attributes:
        order: Order n.
        parts: Complex amplitude of each part divided by `n^2 omega^2` (omega: crank speed): force
            in kg m, moment (also divided by the imaginary unit i) and roll in kg m^2.
        noise: Rounding error of each part, in the same units.
        reference: Point about which moments and roll are taken.
        newtons_per_kg_m: `n^2 omega^2`, in N/(kg m).
    """

    order: int
    parts: dict[ResidualPart, complex]
    noise: dict[ResidualPart, float]
    reference: ReferencePoint
    newtons_per_kg_m: float

    def force(self, sense: int) -> complex:
        """Return the force that turns in one direction (1 with the crank, -1 against it), kg m."""
        return self.parts[ResidualPart("force", sense)]

    def moment(self, sense: int) -> complex:
        """Return the moment (divided by i) that turns in one direction (1 with the crank, -1
        against it), kg m^2.
        """
        return self.parts[ResidualPart("moment", sense)]

    def size(self, *parts: ResidualPart) -> float:
        """Return the sum of the amplitudes of these parts at the engine's speed, N or N m."""
        return sum(abs(self.parts[part]) for part in parts) * self.newtons_per_kg_m


class Scales(NamedTuple):
    """Largest first-order force, moment and roll of one cylinder.

    Attributes:
        force: Largest first-order force of a single cylinder, N.
        moment: This force times the length of the engine, N m.
        roll: This force times the crank radius, N m.
    """

    force: float
    moment: float
    roll: float


def find_scales(engine: Engine) -> Scales:
    """Return the scales of an engine at its speed; for several geared engines, the largest force,
    moment and roll among them.
    """
    if engine.placed:
        of_cranks = [find_scales(crank.engine) for crank in engine.cranks]
        return Scales(*map(max, zip(*of_cranks, strict=True)))
    radius = np.ravel(engine.cylinders.radius).astype(float)
    masses = np.array([float(weighed.reciprocating) for weighed in engine.weighed])
    force = float(np.max(masses * radius)) * float(engine.omega) ** 2
    return Scales(force, force * measure_length(engine).metres, force * float(radius.max()))


class EngineLength(NamedTuple):
    """Length by which a force is multiplied to get the scale of moments.

    Attributes:
        metres: Length, m.
        of_crank: Whether it is twice the largest crank radius, because the cylinder axes are
            closer together.
    """

    metres: float
    of_crank: bool


def measure_length(engine: Engine) -> EngineLength:
    """Return the axial distance of the outermost cylinder axes, but at least twice the largest
    crank radius.

    Args:
        engine: One crank, not several geared ones.
    """
    between = float(np.ptp(np.ravel(engine.cylinders.z)))
    twice_radius = 2 * float(np.max(engine.cylinders.radius))
    return EngineLength(max(between, twice_radius), of_crank=twice_radius > between)


def find_size(residual: Residual, parts: Iterable[ResidualPart], scales: Scales) -> float:
    """Return the size of the largest of these parts as a share of one cylinder's first order."""
    return max(find_share(residual, part, scales) for part in parts)


def find_share(residual: Residual, part: ResidualPart, scales: Scales) -> float:
    """Return the size of a force or moment as a share of one cylinder's first order."""
    scale = scales.moment if part.kind == "moment" else scales.force
    return compare_with_scale(residual.size(part), scale)


def compare_with_scale(size: float, scale: float) -> float:
    """Return a force or moment as a share of that of one cylinder; inf if this is 0, as with
    pistons without mass.
    """
    if not size:
        return 0.0
    return size / scale if scale else math.inf


def is_small(size: float, least: float) -> bool:
    """Return whether a part is 0 or below a limit.

    Args:
        size: Size of the part.
        least: Limit; a part of this size (within rounding) is not small.
    """
    return not size or size < least * (1 - 1e-9)


class NothingToBalanceError(Exception):
    """There is nothing to balance, so a scheme fits no device; the text gives the reason, and
    `details` are further figures of the scheme.
    """

    def __init__(self, text: str, **details: float) -> None:
        super().__init__(text)
        self.text = text
        self.details = details


class OnlySmallError(ArgumentError):
    """All parts that a scheme could cancel are small; the text names the largest."""


def hold_steady(engine: Engine) -> Engine:
    """Return the engine at constant speed, for which devices are sized."""
    return replace(engine, ripple=())


def find_residual(engine: Engine, order: float) -> Residual:
    """Return the residual of an order for an engine with its devices, at its mean speed. Moments
    that are not known are 0.
    """
    spectra = compute_spectra(hold_steady(engine), [order], ("force", "moment", "roll"))
    newtons_per_kg_m = order**2 * float(engine.omega) ** 2
    x, y, z = engine.reference_m
    parts: dict[ResidualPart, complex] = dict.fromkeys((*FORWARD, *BACKWARD, ROLL), 0j)
    noise: dict[ResidualPart, float] = {}
    for part in (*FORWARD, *BACKWARD):
        phasors = spectra[part.kind]
        vector = phasors.forward if part.sense > 0 else phasors.backward
        if part.kind == "force" or engine.places_known:
            per = 1j if part.kind == "moment" else 1
            parts[part] = complex(vector[0]) / per / newtons_per_kg_m
        noise[part] = float(np.broadcast_to(phasors.noise, vector.shape)[0]) / newtons_per_kg_m
    if spectra.roll:
        parts[ROLL] = 2 * complex(spectra.roll.forward[0]) / newtons_per_kg_m
    reference = ReferencePoint(complex(x, y), float(z))
    number = cast("int", order)  # only devices with "fit" may be at half orders
    return Residual(number, parts, noise, reference, newtons_per_kg_m)


def choose_residual(
    engine: Engine,
    options: SchemeOptions,
    kinds: Sequence[Literal["force", "moment"]],
    senses: Sequence[int] = (1, -1),
) -> Residual:
    """Return the residual of the given order; by default of the lowest order in which a part of
    these kinds is not small.

    Args:
        engine: Engine with its devices.
        options: Options of the scheme.
        kinds: Kinds of parts that the scheme cancels.
        senses: Directions of rotation of the force and moment that the scheme cancels: 1 with the
            crank, -1 against it.

    Raises:
        NothingToBalanceError: The engine has no force or moment that the scheme could cancel.
        BalcliError: A moment is wanted but not known.
        OnlySmallError: All forces and moments that the scheme could cancel are small.
    """
    if "moment" in kinds and not engine.places_known:
        raise BalcliError(MOMENTS_UNKNOWN)
    free_parts = " or ".join(kinds)
    if tuple(senses) == (-1,):
        free_parts += " turning against the crank"
    sought = [ResidualPart(kind, sense) for kind in kinds for sense in senses]
    if options.order is None:
        return _find_lowest(engine, options, sought, free_parts)
    residual = find_residual(engine, options.order)
    if any(residual.parts[part] for part in sought):
        return residual
    details = {}
    with_crank = residual.size(FORWARD_FORCE)
    if with_crank and 1 not in senses:
        details["force_with_crank_left_N"] = with_crank
    raise NothingToBalanceError(
        f"order {options.order} has no free {free_parts}: nothing to balance{_tell_rest(residual)}",
        **details,
    )


def _find_lowest(
    engine: Engine, options: SchemeOptions, sought: Sequence[ResidualPart], free_parts: str
) -> Residual:
    """Return the residual of the lowest order in which a sought part is not small."""
    scales = find_scales(engine)
    least = options.read_small()
    residuals: list[Residual] = []
    for order in range(1, HIGHEST_ORDER_SOUGHT + 1):
        residual = find_residual(engine, order)
        if not is_small(find_size(residual, sought, scales), least):
            return residual
        residuals.append(residual)
    if any(residual.parts[part] for residual in residuals for part in sought):
        raise refuse_small(sought, residuals, scales, least)
    message = Message(
        "there is no free {what} of orders 1 to {highest}: nothing to balance; {order} selects a "
        "higher order",
        what=free_parts,
        highest=HIGHEST_ORDER_SOUGHT,
    )
    raise NothingToBalanceError(message)


class _PartOfOrder(NamedTuple):
    """A force or moment of one order, and its share of one cylinder's first order."""

    residual: Residual
    part: ResidualPart
    share: float


def refuse_small(
    sought: Sequence[ResidualPart], residuals: Sequence[Residual], scales: Scales, least: float
) -> OnlySmallError:
    """Return the error for parts that are all small. It states the largest part that the scheme
    could cancel, and which other scheme cancels a large part, preferably a part with the same
    direction of rotation.

    Args:
        sought: Parts that the scheme cancels.
        residuals: Residuals of all orders.
        scales: Force, moment and roll of one cylinder.
        least: Share of one cylinder's first order below which a part is small.
    """
    small = max(_list_shares(residuals, sought, scales), key=_get_share)
    every = _list_shares(residuals, (*FORWARD, *BACKWARD), scales)
    large = [each for each in every if not is_small(each.share, least)]
    advice = ""
    if large:
        senses = {part.sense for part in sought}
        alike = [each for each in large if each.part.sense in senses]
        advice = _name_cure(max(alike or large, key=_get_share))
    return OnlySmallError(
        "the largest {kind} turning {sense} is {size} (order {n}), small compared with one "
        "cylinder's; {order} {n} cancels it{advice}",
        kind=small.part.kind,
        sense=tell_sense(small.part.sense),
        size=_tell_size(small.residual, small.part),
        n=small.residual.order,
        advice=advice,
    )


def _list_shares(
    residuals: Iterable[Residual], parts: Sequence[ResidualPart], scales: Scales
) -> Iterator[_PartOfOrder]:
    """Yield these parts of all orders."""
    for residual in residuals:
        for part in parts:
            yield _PartOfOrder(residual, part, find_share(residual, part, scales))


def _get_share(of_order: _PartOfOrder) -> float:
    return of_order.share


def _name_cure(large: _PartOfOrder) -> str:
    """Return a sentence that names the scheme that cancels a part."""
    residual, part, _ = large
    ratio = part.sense * residual.order
    scheme = "counterweights" if ratio == 1 else _SCHEMES[part]
    size = _tell_size(residual, part)
    return f". Scheme {scheme} cancels a {part.kind} of {size} at {ratio:+d}"


def tell_sense(sense: int) -> str:
    """Return a direction of rotation in words."""
    return "with the crank" if sense > 0 else "against the crank"


def _tell_size(residual: Residual, part: ResidualPart) -> str:
    unit = "N·m" if part.kind == "moment" else "N"
    return f"{residual.size(part):.4g} {unit}"


def _tell_rest(residual: Residual) -> str:
    """Return in words the forces and moments of an order, and the schemes that cancel them."""
    schemes = {"force": "two-shaft", "moment": "couple-shaft"}  # they cancel both directions
    rest = []
    for part in (*FORWARD, *BACKWARD):
        if residual.parts[part]:
            rest.append(f"a {part.kind} turning {tell_sense(part.sense)} ({schemes[part.kind]})")
    return f"; it has {join_words(rest)}" if rest else ""
