"""Place the devices of the ladder's steps, and of the scheme `complete`, where a designer has room
for them. Without places, they stand where the ladder puts them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ..engine.engine import Engine
from ..errors import MOMENTS_UNKNOWN, Argument, ArgumentError
from ..file.fields import join_words
from .fitting import Fitting, Slot, explain_shaft, tell_moment
from .ladder import WEIGHTS, WEIGHTS_AT_THROWS, Ladder, Step
from .options import SchemeOptions
from .planes import SAME_PLACE, find_carriers, find_planes, read_planes, takes_moment
from .remedy import MomentLeft, Remedy, join_remedies
from .residual import Residual, list_parts
from .steps import add_at_ends, add_at_throws, ignore_compensators
from .weights import add_weights

_CURE = "eccentrics in two planes cancel"


class _Places(NamedTuple):
    """Places of the shafts of a row.

    Attributes:
        at: Place x + iy of each shaft, m, by its speed ratio.
        along: Positions z of the eccentrics of every shaft, m; empty: as the ladder places them.
        given: Whether places x, y are given.
    """

    at: dict[int, complex]
    along: tuple[float, ...]
    given: bool


def fit_steps(engine: Engine, ladder: Ladder, options: SchemeOptions) -> Remedy:
    """Return the devices of a step of the ladder, of several steps, or of those that are fitted by
    default, in the given places.

    Args:
        engine: Engine as drawn.
        ladder: Its ladder.
        options: Options `step`, `at`, `position` and `planes`.

    Raises:
        BalcliError: A step is not listed, or its devices cannot stand in the given places.
    """
    remedy = ladder.fit(options.step)
    if not _has_places(options):
        return remedy
    steps = [ladder.find_step(name) for name in ladder.list_fitted(options.step)]
    _refuse_idle(options, remedy)
    start = Fitting.start(ignore_compensators(engine), remedy.scheme)
    ratios = {int(shaft.ratio) for shaft in remedy.shafts}  # the ladder fits orders 1 and 2
    places = _assign(options, _sort_ratios(ratios))
    placed = [_place_step(start, step, options, places) for step in steps]
    joined = join_remedies(remedy.scheme, placed)
    return joined._replace(
        step=remedy.step,
        steps=remedy.steps,
        note=" ".join(filter(None, (own.note for own in placed))),
        moments_left=tuple(left for own in placed for left in own.moments_left),
    )


def size_complete(engine: Engine, options: SchemeOptions) -> Remedy:
    """Return devices that cancel all forces and moments of orders 1 and 2, even small ones."""
    fitting = Fitting.start(ignore_compensators(engine), "complete")
    residuals = [fitting.find_residual(order) for order in (1, 2)]
    first = residuals[0]
    carriers = find_carriers(engine)
    due = [sense for sense in carriers if any(first.parts[part] for part in list_parts(sense))]
    if options.planes is not None and not due:
        raise ArgumentError("{planes}: scheme complete fits no counterweights to this engine")
    for sense in due:
        if options.planes is None:
            fitting = add_at_ends(fitting, first, sense)
        else:
            fitting = _add_weights(fitting, options, first, [sense])
    ratios = []
    for residual in residuals:
        for sense in (1, -1):
            turns_with_crank = residual.order == 1 and sense in carriers
            parts = [residual.parts[part] for part in list_parts(sense)]
            if any(parts) and not turns_with_crank:
                ratios.append(sense * residual.order)
    if not ratios and (options.at, options.position) != (None, None):
        argument = Argument("position" if options.at is None else "at")
        raise ArgumentError(
            "{argument}: scheme complete fits no shafts to this engine", argument=argument
        )
    return _place_shafts(fitting, residuals, ratios, _assign(options, _sort_ratios(ratios))).remedy


def _has_places(options: SchemeOptions) -> bool:
    """Return whether any place of devices is given."""
    return any(place is not None for place in (options.at, options.position, options.planes))


def _sort_ratios(ratios: Iterable[int]) -> list[int]:
    """Return speed ratios of shafts in the order of their places: -1, -2, +2."""
    return sorted(ratios, key=lambda ratio: (abs(ratio), ratio))


def _refuse_idle(options: SchemeOptions, remedy: Remedy) -> None:
    """Raise ArgumentError for places of devices that a row does not have, and for places of
    compensators.
    """
    fitted = {"at": remedy.shafts, "position": remedy.shafts, "planes": remedy.counterweights}
    for name, devices in fitted.items():
        if getattr(options, name) is not None and not devices:
            kind = "counterweights" if name == "planes" else "shafts"
            raise ArgumentError(
                "{argument}: the row fits no {kind}; leave the option out",
                argument=Argument(name),
                kind=kind,
            )
    compensators = any(shaft.role == "compensator" for shaft in remedy.shafts)
    if compensators and (options.at, options.position) != (None, None):
        argument = Argument("position" if options.at is None else "at")
        raise ArgumentError(
            "{argument}: the row has compensators; {scheme} compensator places them",
            argument=argument,
        )


def _assign(options: SchemeOptions, ratios: Sequence[int]) -> _Places:
    """Return the places of shafts.

    Args:
        options: Options `at` and `position`.
        ratios: Speed ratios of the shafts, in the order of `at`.

    Raises:
        ArgumentError: There is not one place for each shaft, or there are more than two positions.
    """
    position = options.position
    along: tuple[float, ...] = ()
    if position is not None:
        along = position if isinstance(position, tuple) else (position,)
    if len(along) > 2:
        raise ArgumentError(
            "{position}: {count} places along z; give one, or two for eccentrics in two planes",
            count=len(along),
        )
    if len(along) == 2 and along[0] == along[1]:
        raise ArgumentError("{position}: {same}", same=SAME_PLACE)
    if options.at is None:
        return _Places(dict.fromkeys(ratios, 0j), along, given=False)
    if len(options.at) != len(ratios):
        names = join_words([f"{ratio:+d}" for ratio in ratios])
        shafts = "a shaft" if len(ratios) == 1 else "shafts"
        raise ArgumentError(
            "{at}: {given} of {wanted} places; the row has {shafts} at {names}: give one place for "
            "each, in this order",
            given=len(options.at),
            wanted=len(ratios),
            shafts=shafts,
            names=names,
        )
    return _Places(dict(zip(ratios, options.at, strict=True)), along, given=True)


def _place_step(start: Fitting, step: Step, options: SchemeOptions, places: _Places) -> Remedy:
    """Return the devices that a step adds, in the given places."""
    own = step.own
    if own.counterweights:
        if options.planes is None:
            return own
        if step.step == WEIGHTS_AT_THROWS:
            return _stay_at_throws(own, options, start.engine)
        names = {weight.engine or "" for weight in own.counterweights}
        carriers = find_carriers(start.engine)
        due = [sense for sense, crank in carriers.items() if crank.name in names]
        return _add_weights(start, options, start.find_residual(1), due).remedy
    if places.given or places.along:
        ratios = dict.fromkeys(int(shaft.ratio) for shaft in own.shafts)
        return _place_shafts(start, [start.find_residual(step.order)], ratios, places).remedy
    return own


def _stay_at_throws(own: Remedy, options: SchemeOptions, engine: Engine) -> Remedy:
    """Return counterweights at every throw, or halves of them in the planes of the webs;
    ArgumentError for other planes.
    """
    if options.planes == "webs":
        return _halve_between_webs(own, engine)
    if options.planes != "throws":
        raise ArgumentError(
            "{planes}: the row has counterweights at every throw, which stay in the planes of the "
            "throws; give throws, or {step} {weights}",
            weights=WEIGHTS,
        )
    return own


def _halve_between_webs(own: Remedy, engine: Engine) -> Remedy:
    """Return the remedy with half of each counterweight in the plane of each web of its throw."""
    planes = np.array(read_planes(engine, SchemeOptions(planes="webs")))
    devices = []
    reasons = []
    for weight, reason in zip(own.counterweights, own.reasons, strict=True):
        for nearest in sorted(np.argsort(np.abs(1e3 * planes - weight.position))[:2]):
            half = {"unbalance": (weight.unbalance or 0.0) / 2, "position": 1e3 * planes[nearest]}
            devices.append(weight.model_copy(update=half))
            reasons.append(reason)
    return own._replace(devices=tuple(devices), reasons=tuple(reasons))


def _add_weights(
    fitting: Fitting, options: SchemeOptions, first: Residual, senses: Iterable[int]
) -> Fitting:
    """Return the fitting with counterweights in the given planes, as scheme counterweights fits
    them, on the cranks that turn in these directions.
    """
    if options.planes == "throws":
        return add_at_throws(fitting)
    carriers = find_carriers(fitting.engine)
    for sense in senses:
        fitting = add_weights(fitting, carriers[sense], options, first)
    return fitting


def _place_shafts(
    fitting: Fitting, residuals: Sequence[Residual], ratios: Iterable[int], places: _Places
) -> Fitting:
    """Return the fitting with a shaft of each speed ratio, in its place.

    Args:
        fitting: Devices so far.
        residuals: Residual of each order.
        ratios: Speed ratios of the shafts.
        places: Places of the shafts.

    Raises:
        BalcliError: A moment is to be cancelled in one plane, or moments are not known.
    """
    for ratio in ratios:
        residual = next(own for own in residuals if own.order == abs(ratio))
        fitting = _place_shaft(fitting, residual, 1 if ratio > 0 else -1, places)
    if places.given:
        for residual in residuals:
            if any(abs(ratio) == residual.order for ratio in places.at):
                fitting = fitting.describe_roll(residual, f"order_{residual.order}")
    return fitting


def _place_shaft(fitting: Fitting, residual: Residual, sense: int, places: _Places) -> Fitting:
    """Return the fitting with a shaft that turns in the direction `sense`."""
    ratio = sense * residual.order
    planes = places.along or find_planes(fitting.engine, residual, sense)
    slots = [Slot("shaft", residual.order, sense, z, places.at[ratio]) for z in planes]
    if not places.along:
        reason = explain_shaft(residual, sense, len(slots))
        return fitting.cancel(slots, list_parts(sense), reason, residual)
    if len(planes) > 1 and not fitting.engine.places_known:
        raise ArgumentError("{position}: {unknown}", unknown=MOMENTS_UNKNOWN)
    if len(planes) == 1 and not residual.force(sense):
        raise ArgumentError(
            "{position}: the shaft at {ratio} cancels a moment and no force; give two places",
            ratio=f"{ratio:+d}",
        )
    stays = tell_moment(residual, sense, planes[0], _CURE) if len(planes) == 1 else ""
    reason = explain_shaft(residual, sense, len(slots), stays)
    fitting = fitting.cancel(slots, list_parts(sense)[: len(slots)], reason, residual)
    if len(planes) == 1 and not takes_moment(residual, sense, planes[0]):
        arm = planes[0] - residual.reference.z
        left = residual.moment(sense) - arm * residual.force(sense)
        size = abs(left) * residual.newtons_per_kg_m
        remedy = fitting.remedy
        moments = (*remedy.moments_left, MomentLeft(ratio, size))
        fitting = fitting._replace(remedy=remedy._replace(moments_left=moments))
    return fitting
