"""Compute the ladder: devices that balance an engine step by step, and the forces that each step
leaves.

Counterweights in the end planes cancel the part of order 1 that turns with the crank.
Counterweights at every throw cancel it where it arises, so that main bearings do not carry it.
Shafts cancel the part of order 1 that turns against the crank, and order 2. Ships' two-stroke
engines (`ship_engines`) get compensators in place of shafts. A step is listed if the part that it
cancels, or its reduction of the main bearing load, is not small compared with one cylinder's first
order.

Each step is judged by itself: shafts by the share of one cylinder's first order that they cancel,
compensators by their moment divided by the power of the engine. The steps that are worth their
devices are fitted by default (`Ladder.auto`); they need not be consecutive.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, NamedTuple

import numpy as np

from ..core.cylinders import Device
from ..core.peaks import find_largest
from ..core.phasors import Array, Complex
from ..core.records import HIDDEN
from ..engine.engine import Engine
from ..engine.figures import find_first_largest
from ..errors import ArgumentError, BalcliError, Message
from ..forces.crankshaft import find_crank_loads
from ..forces.kinds import ROLL, ROLL_TOTAL
from ..forces.power import Power, at_rated_speed, find_power, needs_compensator
from ..forces.spectrum import (
    compute_spectra,
    find_relevant_orders,
    list_gas_orders,
    merge_orders,
)
from ..limits import (
    FEWEST_CYLINDERS_COUNTED,
    SMALL,
    WORTH_A_SHAFT_OF_ORDER_1,
    WORTH_A_SHAFT_OF_ORDER_2,
)
from .fitting import LEFT, Fitting, find_effect
from .options import check_small
from .pairs import find_distance, find_moment_about_y, find_wanted_roll, place_pair
from .planes import as_millimetres, find_carriers, find_ends, find_unbalance
from .remedy import Remedy, fit_devices, join_remedies, remove_counterweights
from .residual import (
    BACKWARD,
    FORWARD,
    MOMENT,
    EngineLength,
    ReferencePoint,
    Residual,
    ResidualPart,
    Scales,
    compare_with_scale,
    find_scales,
    find_size,
    hold_steady,
    is_small,
    list_parts,
    measure_length,
)
from .room import find_rooms, weigh_steel
from .ship_engines import is_judged_by_power
from .steps import (
    add_at_ends,
    add_at_throws,
    add_compensators,
    add_shafts,
    ignore_compensators,
)

AS_DRAWN = "as drawn"
WEIGHTS = "counterweights"
WEIGHTS_AT_THROWS = "counterweights at every throw"
SHAFT = "shaft at -1"
NO_SHAFTS = (
    "a locomotive has no room for shafts; `balcli locomotive` sizes the weights in its wheels"
)

_OF_WEIGHTS = (*FORWARD, *BACKWARD)  # parts of order 1 to which counterweights may add
_SAME_SENSE = 1e-9  # a smaller share of the product of two sums of weights is rounding
_SUM = re.compile(r"\s+\+\s+|(?<=\d)\+(?=\d)")  # the plus in "2+4"; not the one in "shaft at +2"


def name_shafts(senses: Iterable[int]) -> str:
    """Return the name of the step with shafts of order 2 that turn in these directions (1 with the
    crank, -1 against it).
    """
    ratios = [f"{2 * sense:+d}" for sense in sorted(senses, reverse=True)]
    if len(ratios) == 1:
        return f"shaft at {ratios[0]}"
    return f"shafts at {' and '.join(ratios)}"


SHAFTS = name_shafts((1, -1))
SINGLE_SHAFTS = (SHAFT, name_shafts((1,)), name_shafts((-1,)))  # steps with one shaft


def name_compensators(order: int) -> str:
    """Return the name of the step with compensators of an order."""
    return f"compensators of order {order}"


# ------------------------------------------------------------------ records
class Scale(NamedTuple):
    """Force and moment of one cylinder, with which the forces and moments of orders are compared.

    Attributes:
        force_N: Largest first-order force of a cylinder alone.
        moment_Nm: This force times the length of the engine; left out where positions are unknown.
        length: This length; None for geared engines and where positions are unknown.
    """

    force_N: float
    moment_Nm: float | None = None
    length: Annotated[EngineLength | None, HIDDEN] = None


class LargestRoll(NamedTuple):
    """The largest order of the roll. No step changes it.

    Attributes:
        of: "inertia", or "total" if the engine has gas: inertia and gas.
        order: Order.
        amplitude_Nm: Amplitude of the roll.
        shafts_at_mm: Positions x, y at which shafts at +2 and -2 also cancel the roll of order 2,
            by their speed ratio; left out where no such positions exist, and for locomotives.
        distance_m: Distance of these shafts along the force.
    """

    of: str
    order: float
    amplitude_Nm: float
    shafts_at_mm: dict[str, tuple[float, float]] | None = None
    distance_m: Annotated[float | None, HIDDEN] = None


class FileCounterweights(NamedTuple):
    """Largest inertia load of a main bearing without and with the counterweights of the file.

    Attributes:
        without_N: Load without these counterweights.
        with_N: Load with them.
    """

    without_N: float
    with_N: float


@dataclass(frozen=True, kw_only=True)
class Step:
    """The engine with the devices of a step and of earlier steps; counterweights at every throw
    replace those in the end planes.

    Attributes:
        step: Name of the step.
        takes_back: True if the counterweights of the step work against those of the file; else left
            out.
        peak_force_N: Largest free force over a revolution, all orders added up.
        peak_moment_Nm: Largest free moment over a revolution; left out if positions are unknown.
        main_bearing_N: Largest load of a main bearing by inertia; left out if it is not known, or
            if all throws have the same position along the crank.
        inner_moment_Nm: Largest bending moment of the crankshaft by inertia.
        counterweights: Number of new counterweights.
        shafts: Number of new shafts.
        mass_kg: Sum of all new unbalances divided by the crank radius of cylinder 1.
        steel_kg: Mass of half discs of steel that make these unbalances: counterweights with the
            radius of the room around the crank, eccentrics of shafts as long as their diameter;
            left out if this room is not known.
        pru_Nm_per_kW: Power related unbalance of the moment that the step faces; only for
            ships' two-stroke engines of known power.
        order: Order that the step balances; 0 as drawn.
        share: Largest force or moment that the step cancels, as a share of one cylinder's first
            order.
        limit: Share from which the step is fitted by default; None if it is not judged by a share.
        worth_it: Whether the step is worth its devices, if the file has no weights against it.
        own: Devices that this step adds.
        remedy: All new devices.
    """

    step: str
    takes_back: bool | None = None
    peak_force_N: float
    peak_moment_Nm: float | None = None
    main_bearing_N: float | None = None
    inner_moment_Nm: float | None = None
    counterweights: int
    shafts: int
    mass_kg: float
    steel_kg: float | None = None
    pru_Nm_per_kW: float | None = None
    order: Annotated[int, HIDDEN] = 0
    share: Annotated[float, HIDDEN] = 0.0
    limit: Annotated[float | None, HIDDEN] = None
    worth_it: Annotated[bool, HIDDEN] = False
    own: Annotated[Remedy, HIDDEN]
    remedy: Annotated[Remedy, HIDDEN]


class LeftOut(NamedTuple):
    """A step that is not listed because its effect is small, or because its engine does not need
    it.

    Attributes:
        step: Name of the step.
        force_N: Largest rotating force that it would cancel.
        moment_Nm: Largest rotating moment that it would cancel; left out where positions are not
            known.
        main_bearing_N: Reduction of the largest load of a main bearing.
        buildable: Whether the engine has room for its devices: a locomotive has none for shafts.
    """

    step: str
    force_N: float
    moment_Nm: float | None = None
    main_bearing_N: float | None = None
    buildable: Annotated[bool, HIDDEN] = True


@dataclass(frozen=True, kw_only=True)
class Ladder:
    """Devices that balance an engine, step by step.

    Attributes:
        scale: Force and moment of one cylinder.
        auto: Steps that are fitted by default.
        roll: Largest order of the roll; left out if there is no roll.
        file_counterweights: Bearing loads without and with the counterweights of the file; left out
            without such counterweights, or if the loads are not known.
        steps: Steps that are worth listing.
        left_out: Steps that would cancel something but are not listed.
        small: Forces and moments below this share of one cylinder's first order are not balanced.
        by_power: Whether steps are judged by the power related unbalance: the engine is a
            ship's two-stroke engine.
        power: Power of such an engine; None if it is not known.
        of_locomotive: Whether the engine is that of a locomotive, for which no shaft is listed.
    """

    scale: Scale
    auto: tuple[str, ...]
    roll: LargestRoll | None = None
    file_counterweights: FileCounterweights | None = None
    steps: tuple[Step, ...]
    left_out: tuple[LeftOut, ...]
    small: Annotated[float, HIDDEN] = SMALL
    by_power: Annotated[bool, HIDDEN] = False
    power: Annotated[Power | None, HIDDEN] = None
    of_locomotive: Annotated[bool, HIDDEN] = False

    def fit(self, step: str | int | None = None) -> Remedy:
        """Return the devices of a listed step and of the steps before it, or only those of several
        steps.

        Args:
            step: Name or number of a step, or several, such as "2+4"; None: the steps that are
                fitted by default (`auto`).

        Raises:
            BalcliError: A step is not listed or fits nothing, or the steps exclude each other.
        """
        if step is None:
            return self._join("auto", self.auto)
        chosen = self._choose(str(step))
        if len(chosen) == 1:
            (name,) = chosen
            return self.find_step(name).remedy._replace(scheme="step", step=name)
        if {WEIGHTS, WEIGHTS_AT_THROWS} <= {*chosen}:
            raise BalcliError(
                f'step "{step}": {WEIGHTS_AT_THROWS} replace those of step "{WEIGHTS}"; give one '
                "of the two"
            )
        return self._join("step", chosen)

    def list_fitted(self, step: str | int | None = None) -> tuple[str, ...]:
        """Return the names of the steps whose devices `fit` returns for this argument."""
        if step is None:
            return self.auto
        chosen = self._choose(str(step))
        if len(chosen) > 1:
            return chosen
        names = [row.step for row in self.steps]
        fitted = names[1 : names.index(chosen[0]) + 1]
        replaced = {WEIGHTS} if WEIGHTS_AT_THROWS in fitted else set()
        return tuple(name for name in fitted if name not in replaced)

    def _join(self, scheme: str, names: tuple[str, ...]) -> Remedy:
        """Return the devices that these steps add, without those of other steps."""
        remedies = [self.find_step(name).own for name in names]
        return join_remedies(scheme, remedies)._replace(steps=names)

    def find_step(self, name: str) -> Step:
        """Return the listed step of this name."""
        return next(step for step in self.steps if step.step == name)

    def find_row(self, name: str) -> int:
        """Return the number of the row of a listed step."""
        return [step.step for step in self.steps].index(name)

    def _choose(self, text: str) -> tuple[str, ...]:
        """Return the names of the steps that a text names or numbers, in the ladder's order."""
        names = [self._find_name(part, text) for part in _SUM.split(text)]
        if len({*names}) < len(names):
            raise BalcliError(f'step "{text[:60]}" has a step twice')
        return tuple(step.step for step in self.steps if step.step in names)

    def _find_name(self, part: str, text: str) -> str:
        """Return the name of the step that a part of a text names or numbers."""
        names = [step.step for step in self.steps]
        plain = part.strip().lower().replace("−", "-")
        name = plain
        if plain.isdecimal() and len(plain) < 4 and int(plain) < len(names):
            name = names[int(plain)]
        if name in names[1:]:
            return name
        for out in self.left_out:
            if out.step == name:
                raise ArgumentError(
                    'step "{name}" is left out: {why}', name=name, why=self._explain(out)
                )
        rows = ", ".join(f"{number} {name}" for number, name in enumerate(names) if number)
        rows = rows or "none, because nothing is worth fitting"
        raise BalcliError(f'step "{text[:60]}": the choices are {rows}; 0 is the engine {AS_DRAWN}')

    def _explain(self, out: LeftOut) -> str:
        """Return in words the effect of an omitted step and the way to get it, if there is one."""
        if not out.buildable:
            return NO_SHAFTS
        fall = out.main_bearing_N
        if fall is not None and self.by_power:
            return Message(
                "the bearings of a ship's two-stroke engine also carry its gas forces; {scheme} "
                "counterweights {planes} throws fits them"
            )
        percent = self.measure_percent(out)
        size = f"{abs(percent):.2g} % of one cylinder's first order"
        lists_it = Message("{small} {percent}% lists it", percent=math.floor(percent))
        if fall is None:
            return Message("it would cancel {size}; {lists_it}", size=size, lists_it=lists_it)
        if fall > 0:
            return Message(
                "it would lower the largest main bearing load by {size}; {lists_it}",
                size=size,
                lists_it=lists_it,
            )
        return f"it would raise the largest main bearing load by {size}"

    def measure_percent(self, out: LeftOut) -> float:
        """Return the force or moment that an omitted step would cancel, or its reduction of the
        main bearing load, in % of one cylinder's first order; nan if one cylinder has no force of
        first order.
        """
        sizes = [(out.force_N, self.scale.force_N), (out.moment_Nm or 0.0, self.scale.moment_Nm)]
        if out.main_bearing_N is not None:
            sizes = [(out.main_bearing_N, self.scale.force_N)]
        return max((100 * size / scale for size, scale in sizes if scale), default=math.nan)


# ------------------------------------------------------------------ the engine as drawn
class _Drawn(NamedTuple):
    """An engine without new devices.

    Attributes:
        engine: Engine as drawn.
        start: Fitting without devices; forces of compensators are ignored.
        first: Residual of order 1.
        second: Residual of order 2.
        scales: Force, moment and roll of one cylinder.
        small: Forces and moments below this share of one cylinder's first order are not balanced.
        by_power: Whether steps are judged by the power related unbalance.
        power: Power of the engine if `by_power`; None if it is not known.
    """

    engine: Engine
    start: Fitting
    first: Residual
    second: Residual
    scales: Scales
    small: float
    by_power: bool
    power: Power | None

    def find_pru(self, order: int, moment_kg_m2: float) -> float | None:
        """Return the power related unbalance of a moment, N m/kW; None if no power is known.

        Args:
            order: Order n of the moment.
            moment_kg_m2: Moment divided by `n^2 omega^2` (omega: crank speed).
        """
        if self.power is None:
            return None
        speed = order * float(at_rated_speed(self.engine).omega)
        return self.power.relate(speed**2 * moment_kg_m2)


def _draw(engine: Engine, small: float) -> _Drawn:
    """Return what the steps of the ladder need to know of an engine without new devices."""
    start = Fitting.start(ignore_compensators(engine), "")
    by_power = is_judged_by_power(engine)
    return _Drawn(
        engine=engine,
        start=start,
        first=start.find_residual(1),
        second=start.find_residual(2),
        scales=find_scales(engine),
        small=small,
        by_power=by_power,
        power=find_power(engine) if by_power else None,
    )


# ------------------------------------------------------------------ steps on offer
class _Cancelled(NamedTuple):
    """Forces and moments that a step cancels.

    Attributes:
        force: Largest rotating force, N.
        moment: Largest rotating moment, N m.
        share: The larger of the two as a share of one cylinder's first order.
    """

    force: float = 0.0
    moment: float = 0.0
    share: float = 0.0


class _Rung(NamedTuple):
    """An engine with the devices of a step and of earlier steps, and its figures."""

    engine: Engine
    step: Step


class _Offer(NamedTuple):
    """A step that the ladder lists or leaves out.

    Attributes:
        name: Name of the step.
        order: Order that it balances.
        listed: Whether the ladder lists it.
        own: Devices that it adds; none if all forces and moments that it could cancel are small.
        cancels: Forces and moments that it cancels.
        limit: Share from which it is fitted by default; None if it is not judged by a share.
        worth_it: Whether it is worth its devices.
        takes_back: Whether its counterweights work against those of the file.
        pru_Nm_per_kW: Power related unbalance of the moment that it faces; None if not known.
        fall: Reduction of the largest main bearing load, N; only for counterweights at every throw.
        buildable: Whether the engine has room for its devices.
        rung: The engine with its devices, if it is already known.
    """

    name: str
    order: int
    listed: bool
    own: Remedy
    cancels: _Cancelled = _Cancelled()
    limit: float | None = None
    worth_it: bool = True
    takes_back: bool = False
    pru_Nm_per_kW: float | None = None
    fall: float | None = None
    buildable: bool = True
    rung: _Rung | None = None

    @property
    def fits_something(self) -> bool:
        """Whether the step has an effect, however small."""
        return bool(self.cancels.share or self.own.devices)


@lru_cache(maxsize=16)  # analysis, balance and page of an engine share one
def find_ladder(engine: Engine, small: float = SMALL) -> Ladder:
    """Return the ladder of an engine.

    Args:
        engine: One engine, not an array of variants.
        small: Forces and moments below this share of one cylinder's first order are not balanced.

    Raises:
        BalcliError: `small` is not a share from 0 to 50 %.
    """
    check_small(small)
    drawn = _draw(engine, small)
    rungs = [_Rung(engine, _make_step(engine, AS_DRAWN, []))]
    listed: list[_Offer] = []
    left_out: list[_Offer] = []

    def consider(offer: _Offer) -> None:
        """List the step, or leave it out."""
        if not offer.listed:
            left_out.append(offer)
            return
        if offer.name == WEIGHTS_AT_THROWS:  # these replace the counterweights in the end planes
            listed.clear()
        listed.append(offer)
        rungs.append(offer.rung or _climb(rungs[-1].engine, listed))

    consider(_offer_weights(drawn))
    for offer in _offer_weights_at_throws(drawn, rungs[-1].step, listed):
        consider(offer)
    for offer in _offer_compensators(drawn, listed) if drawn.by_power else _offer_shafts(drawn):
        consider(offer)
    rooms = find_rooms(engine)
    steps = []
    for _, step in rungs:
        steps.append(replace(step, steel_kg=weigh_steel(step.remedy, rooms)))
    replaced = _list_replaced(steps)
    omitted = [offer for offer in left_out if offer.fits_something and offer.name not in replaced]
    return Ladder(
        scale=_describe_scale(engine, drawn.scales),
        auto=_choose_usual(steps),
        roll=_find_roll(drawn),
        file_counterweights=_weigh_file_counterweights(engine, steps[0]),
        steps=tuple(steps),
        left_out=tuple(_leave_out(engine, offer) for offer in omitted),
        small=small,
        by_power=drawn.by_power,
        power=drawn.power,
        of_locomotive=engine.of_locomotive,
    )


def _choose_usual(steps: Sequence[Step]) -> tuple[str, ...]:
    """Return the names of the steps that are fitted by default.

    If counterweights of a step take back some of the file's, the file settles order 1 in its own
    way, and no step of order 1 is fitted.
    """
    settled = any(step.takes_back for step in steps)
    replaced = _list_replaced(steps)
    return tuple(
        step.step
        for step in steps
        if step.worth_it and step.step not in replaced and not (settled and step.order == 1)
    )


def _list_replaced(steps: Sequence[Step]) -> set[str]:
    """Return the names of the steps that a later step replaces: counterweights at every throw
    replace those in the end planes.
    """
    names = [step.step for step in steps]
    return {WEIGHTS} if WEIGHTS_AT_THROWS in names else set()


def _offer_weights(drawn: _Drawn) -> _Offer:
    """Return the step with counterweights in the end planes."""
    first = drawn.first
    scales = drawn.scales
    senses = [*find_carriers(drawn.engine)]
    due = [sense for sense in senses if not is_small(_size(first, [sense], scales), drawn.small)]
    fitting = drawn.start
    for sense in due:
        fitting = add_at_ends(fitting, first, sense)
    offer = _Offer(
        WEIGHTS,
        1,
        listed=bool(due),
        own=fitting.remedy,
        cancels=_measure(first, senses, scales),
        takes_back=_takes_back(drawn, fitting.remedy),
    )
    if not drawn.by_power:
        return offer
    pru = drawn.find_pru(1, sum(abs(first.parts[part]) for part in MOMENT))
    worth_it = pru is not None and needs_compensator(pru)
    return offer._replace(pru_Nm_per_kW=pru, worth_it=worth_it)


def _offer_weights_at_throws(
    drawn: _Drawn, before: Step, listed: Sequence[_Offer]
) -> Iterator[_Offer]:
    """Yield the step with counterweights at every throw, if the crank has throws in three or more
    planes and its loads are known.

    Args:
        drawn: Engine as drawn.
        before: Last listed step.
        listed: Steps that are listed, without "as drawn".
    """
    engine = drawn.engine
    scales = drawn.scales
    planes = {*engine.joined_throws_m.tolist()}
    if before.inner_moment_Nm is None or len(planes) < 3:
        return
    remedy = add_at_throws(drawn.start).remedy
    back = _takes_back(drawn, remedy)
    offer = _Offer(WEIGHTS_AT_THROWS, 1, listed=False, own=remedy, takes_back=back)
    if not listed:  # else the step before has cancelled order 1
        offer = offer._replace(cancels=_measure(drawn.first, [1], scales))
    rung = _climb(engine, [offer])
    load = before.main_bearing_N or 0.0
    fall = load - (rung.step.main_bearing_N or 0.0)
    relieves = fall > LEFT * load and not is_small(fall, drawn.small * scales.force)
    yield offer._replace(listed=relieves and not drawn.by_power, fall=fall, rung=rung)


def _offer_shafts(drawn: _Drawn) -> Iterator[_Offer]:
    """Yield the steps with balancer shafts, for order 1 and for order 2. A locomotive has no room
    for them.
    """
    buildable = not drawn.engine.of_locomotive
    cylinders = max(len(drawn.engine.rising_numbers), FEWEST_CYLINDERS_COUNTED)
    without_crank = {-1}.difference(find_carriers(drawn.engine))
    for residual, senses, limit in (
        (drawn.first, without_crank, WORTH_A_SHAFT_OF_ORDER_1),
        (drawn.second, (1, -1), WORTH_A_SHAFT_OF_ORDER_2 * cylinders),
    ):
        sizes = {sense: _size(residual, [sense], drawn.scales) for sense in senses}
        due = [sense for sense, size in sizes.items() if not is_small(size, drawn.small)]
        named = due or [sense for sense, size in sizes.items() if size]
        if not named:
            continue
        yield _Offer(
            SHAFT if residual.order == 1 else name_shafts(named),
            residual.order,
            listed=buildable and bool(due),
            own=add_shafts(drawn.start, residual, due).remedy,
            cancels=_measure(residual, named, drawn.scales),
            limit=limit,
            worth_it=not is_small(max(sizes.values()), limit),
            buildable=buildable,
        )


def _offer_compensators(drawn: _Drawn, listed: Sequence[_Offer]) -> Iterator[_Offer]:
    """Yield the steps with compensators at both ends of the engine, for orders 1 and 2.

    Args:
        drawn: Engine as drawn.
        listed: Steps with counterweights that are listed.
    """
    if not drawn.engine.places_known:
        return
    weighted = drawn.start._replace(remedy=join_remedies("", [offer.own for offer in listed]))
    for residual in (weighted.find_residual(1), drawn.second):
        moment_kg_m2 = abs(find_moment_about_y(residual))
        moment = moment_kg_m2 * residual.newtons_per_kg_m
        share = compare_with_scale(moment, drawn.scales.moment)
        due = not is_small(share, drawn.small)
        fitting = drawn.start
        if due:
            fitting = add_compensators(fitting, residual, find_ends(drawn.engine))
        pru = drawn.find_pru(residual.order, moment_kg_m2)
        yield _Offer(
            name_compensators(residual.order),
            residual.order,
            listed=due,
            own=fitting.remedy,
            cancels=_Cancelled(moment=moment, share=share),
            worth_it=pru is not None and needs_compensator(pru),
            pru_Nm_per_kW=pru,
        )


def _size(residual: Residual, senses: Iterable[int], scales: Scales) -> float:
    """Return the largest force or moment that turns in these directions, as a share of one
    cylinder's first order; 0 for no direction.
    """
    return max((find_size(residual, list_parts(sense), scales) for sense in senses), default=0.0)


def _measure(residual: Residual, senses: Sequence[int], scales: Scales) -> _Cancelled:
    """Return the largest force and moment of an order that turn in these directions."""
    pairs = [list_parts(sense) for sense in senses]
    return _Cancelled(
        force=max((residual.size(force) for force, _ in pairs), default=0.0),
        moment=max((residual.size(moment) for _, moment in pairs), default=0.0),
        share=_size(residual, senses, scales),
    )


def _takes_back(drawn: _Drawn, remedy: Remedy) -> bool:
    """Return whether new counterweights work against those of the file."""
    before = _list_counterweights(drawn.engine)
    if not before:
        return False
    after = _list_counterweights(fit_devices(drawn.engine, remedy))
    reference = drawn.first.reference
    added = _sum_effects(drawn.engine, after, reference)
    added -= _sum_effects(drawn.engine, before, reference)
    size_added = sum(map(find_unbalance, remedy.devices))
    return _work_against_file(drawn.engine, added, size_added, reference)


def would_take_back(engine: Engine, cancelled: Mapping[ResidualPart, complex]) -> bool:
    """Return whether counterweights that cancel parts of order 1 would work against those of the
    file.

    Args:
        engine: One engine, not an array of variants.
        cancelled: Parts that the counterweights cancel, in N and N m.
    """
    added: Complex = np.zeros(len(_OF_WEIGHTS), complex)
    square = float(engine.omega) ** 2
    for part, size in cancelled.items():
        per = 1j if part.kind == "moment" else 1
        added[_OF_WEIGHTS.index(part)] = -size / per / square
    size_added = float(np.sum(np.abs(added) / _list_arms(engine)))
    x, y, z = engine.reference_m
    reference = ReferencePoint(complex(x, y), float(z))
    return _work_against_file(engine, added, size_added, reference)


def _work_against_file(
    engine: Engine, added: Complex, size_added: float, reference: ReferencePoint
) -> bool:
    """Return whether an effect of new counterweights is opposite to that of the file's: the scalar
    product of force and moment, both as shares of one cylinder's first order, is negative.

    Args:
        engine: Engine with the counterweights of the file.
        added: Effect of the new counterweights on the parts `_OF_WEIGHTS`, in units of
            `Residual.parts`, shape (parts,).
        size_added: Size of the new counterweights, kg m, with which rounding is compared.
        reference: Point about which moments are taken.
    """
    devices = _list_counterweights(engine)
    of_file = _sum_effects(engine, devices, reference)
    product = float(np.sum((added * of_file.conj()).real / _list_arms(engine) ** 2))
    size_of_file = sum(_measure_unbalance(device) for device in devices)
    return product < -_SAME_SENSE * size_of_file * size_added


def _list_arms(engine: Engine) -> Array:
    """Return the lengths by which forces (1) and moments are divided to compare them, shape
    (parts of `_OF_WEIGHTS`,).
    """
    arm = max(measure_length(crank.engine).metres for crank in engine.cranks)
    return np.array([1.0 if part.kind == "force" else arm for part in _OF_WEIGHTS])


def _list_counterweights(engine: Engine) -> list[Device]:
    """Return the counterweights of all cranks, and those of webs without their cheeks."""
    weights = []
    for device in engine.every_device:
        if device.web and engine.webs is not None:
            own = engine.webs.webs[device.web - 1].own_weight
            weights += [own] if own.forward else []
        elif device.is_counterweight:
            weights.append(device)
    return weights


def _measure_unbalance(device: Device) -> float:
    """Return the unbalance of a counterweight, kg m."""
    return abs(complex(device.forward)) + abs(complex(device.backward))


def _sum_effects(engine: Engine, devices: Iterable[Device], reference: ReferencePoint) -> Complex:
    """Return what devices add to the parts `_OF_WEIGHTS`, in units of `Residual.parts`, shape
    (parts,). Moments that are not known are 0.
    """
    total: Complex = np.zeros(len(_OF_WEIGHTS), complex)
    for device in devices:
        total += find_effect(device, _OF_WEIGHTS, reference)
    known = [part.kind == "force" or engine.places_known for part in _OF_WEIGHTS]
    return np.where(known, total, 0)


# ------------------------------------------------------------------ figures
def _climb(before: Engine, offers: Sequence[_Offer]) -> _Rung:
    """Return the rung of the last of several steps.

    Args:
        before: Engine with the devices of the other steps.
        offers: Steps whose devices are fitted.
    """
    fitted = fit_devices(before, offers[-1].own)
    return _Rung(fitted, _make_step(fitted, offers[-1].name, offers))


def _make_step(fitted: Engine, name: str, offers: Sequence[_Offer]) -> Step:
    """Return the figures of the engine with the devices of a step.

    Args:
        fitted: Engine with these devices.
        name: Name of the step.
        offers: Steps whose devices are fitted, this step last; none as drawn.
    """
    remedy = join_remedies("", [offer.own for offer in offers])
    kinds = ("force", "moment") if fitted.places_known else ("force",)
    orders = merge_orders(find_relevant_orders(fitted), [1, 2])
    spectra = compute_spectra(fitted, orders, kinds)
    loads = find_crank_loads(fitted)
    step = Step(
        step=name,
        peak_force_N=float(find_largest(spectra["force"])),
        peak_moment_Nm=float(find_largest(spectra["moment"])) if fitted.places_known else None,
        main_bearing_N=None if loads is None else loads.main_N,
        inner_moment_Nm=None if loads is None else loads.inner_moment_Nm,
        counterweights=len(remedy.counterweights),
        shafts=len({(shaft.ratio, shaft.at) for shaft in remedy.shafts}),
        mass_kg=sum(map(find_unbalance, remedy.devices)) / _find_first_radius(fitted),
        own=Remedy(""),
        remedy=remedy,
    )
    if not offers:
        return step
    offer = offers[-1]
    return replace(
        step,
        takes_back=offer.takes_back or None,
        pru_Nm_per_kW=offer.pru_Nm_per_kW,
        order=offer.order,
        share=offer.cancels.share,
        limit=offer.limit,
        worth_it=offer.worth_it,
        own=offer.own,
    )


def _find_first_radius(engine: Engine) -> float:
    """Return the crank radius of cylinder 1 (of the first engine), m."""
    first = engine.cranks[0].engine
    return float(first.cylinders.radius_of_each[first.numbers.index(1)])


def _leave_out(engine: Engine, offer: _Offer) -> LeftOut:
    """Return a step that is not listed."""
    return LeftOut(
        step=offer.name,
        force_N=offer.cancels.force,
        moment_Nm=offer.cancels.moment if engine.places_known else None,
        main_bearing_N=offer.fall,
        buildable=offer.buildable,
    )


def _describe_scale(engine: Engine, scales: Scales) -> Scale:
    """Return force and moment of one cylinder."""
    if not engine.places_known:
        return Scale(scales.force)
    length = None if engine.placed else measure_length(engine)
    return Scale(scales.force, scales.moment, length)


def _weigh_file_counterweights(engine: Engine, drawn: Step) -> FileCounterweights | None:
    """Return the largest main bearing load without and with the counterweights of the file; None
    without such counterweights, or if the load is not known. Cheeks of webs are no counterweights.

    Args:
        engine: Engine as drawn.
        drawn: First step of the ladder.
    """
    weights = _list_counterweights(engine)
    if not weights or drawn.main_bearing_N is None:
        return None
    cheeks = [device for device in engine.devices if device.web]
    cheeks += [weight._replace(forward=-weight.forward) for weight in weights if weight.web]
    bare = remove_counterweights(engine)
    loads = find_crank_loads(replace(bare, devices=(*cheeks, *bare.devices)))
    if loads is None or loads.main_N is None:
        return None
    return FileCounterweights(without_N=loads.main_N, with_N=drawn.main_bearing_N)


def _find_roll(drawn: _Drawn) -> LargestRoll | None:
    """Return the largest order of the roll; None if there is no roll."""
    engine = drawn.engine
    kind = ROLL
    orders = merge_orders(find_relevant_orders(engine), [1, 2])
    if engine.gas is not None:
        kind = ROLL_TOTAL
        orders = merge_orders(orders, list_gas_orders(engine))
    phasors = compute_spectra(engine, orders, (kind.name,))[kind.name]
    sizes = np.where(phasors.orders > 0, phasors.major, 0.0)
    largest = int(find_first_largest(sizes))
    if not sizes[largest]:
        return None
    roll = LargestRoll(
        of="inertia" if kind is ROLL else "total",
        order=float(phasors.orders[largest]),
        amplitude_Nm=float(sizes[largest]),
    )
    second = drawn.second
    of_order_2 = compute_spectra(hold_steady(engine), [2], (kind.name,))[kind.name]
    amplitude = 2 * complex(of_order_2.forward[0])
    if engine.of_locomotive or not (amplitude and second.force(1) and second.force(-1)):
        return roll
    places = place_pair(second, find_wanted_roll(second, amplitude / second.newtons_per_kg_m))
    distance = find_distance(second, places)
    if distance is None:
        return roll
    at = {
        f"{2 * sense:+d}": (as_millimetres(place.real), as_millimetres(place.imag))
        for sense in (1, -1)
        for place in places[sense]
    }
    return roll._replace(shafts_at_mm=at, distance_m=distance)
