"""Fit the dimensions of webs that an engine file leaves open (`"fit"` in [[web]]).

A scheme says which unbalance each of these webs is to have (`_WANTED`); `web_room` solves the
dimension. What is wanted may depend on the thickness of the webs, which moves their planes and
changes their cheeks: wanted unbalances and thicknesses are computed in turn until they agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.phasors import Array, unit
from ..core.records import Node
from ..engine.build import build
from ..engine.engine import Engine, refuse_geared, take_model
from ..engine.placed import build_fitted
from ..engine.webs.bodies import draw_web, refuse_stray_holes
from ..engine.webs.build import WEBS_ON_THROW, CrankWeb, assign_tables, take_pin
from ..errors import Argument, ArgumentError, BalcliError
from ..file.fields import join_words, limit_digits
from ..file.model import EngineFile
from .bobweights import fill_card
from .factor import choose_factors, describe_factor
from .fit import list_open_webs, list_to_fit
from .fitting import Slot, solve_exactly
from .ladder import find_ladder
from .options import WEB_SCHEMES, SchemeOptions
from .placed_steps import fit_steps
from .planes import SAME_PLACE
from .remedy import FittedTable, FittedWeb, Remedy
from .residual import FORWARD, find_residual, hold_steady
from .room import find_half_distance, find_known_radius
from .throws import Throw, list_throws, sum_at_throws, sum_counterweights
from .web_room import OpenWeb, SolvedWeight, WebRoom, list_cures, measure_thickness, solve_weight

if TYPE_CHECKING:
    from ..file.web_tables import Web

MM = 1e-3
_MOST_ROUNDS = 50
_REMEMBERED = 12  # rounds from which the next guess is made
_SETTLED = 1e-12  # share of the largest thickness by which one may still change
_ALIKE_DIGITS = 9  # webs whose figures agree to so many digits have one table


class WebFit(NamedTuple):
    """The fitted webs of an engine.

    Attributes:
        remedy: Fitted webs, their tables, and the shafts of a step.
        before: Engine whose fitted webs have no counterweight.
        after: Engine with the fitted webs, without the shafts of the remedy.
    """

    remedy: Remedy
    before: Engine
    after: Engine


class _Crank(NamedTuple):
    """An engine whose webs to fit have no counterweight.

    Attributes:
        engine: The engine.
        model: Its file, with "fit".
        tables: Number of the table of each web.
        is_open: Whether a dimension of each web is "fit", by its number.
    """

    engine: Engine
    model: EngineFile
    tables: Mapping[int, int]
    is_open: Mapping[int, bool]

    @property
    def webs(self) -> tuple[CrankWeb, ...]:
        """All webs, from the free end."""
        assert self.engine.webs is not None
        return self.engine.webs.webs

    @property
    def open_webs(self) -> list[CrankWeb]:
        """Webs to fit, from the free end."""
        return [web for web in self.webs if self.is_open[web.number]]

    @property
    def throws(self) -> list[Throw]:
        """Throws, which have one pin each in a file with [[web]]."""
        throws = list_throws(self.engine)
        assert throws is not None
        return throws

    def find_table(self, web: CrankWeb) -> Web:
        """Return the table of a web, with "fit"."""
        return self.model.web[self.tables[web.number] - 1]

    def describe(self, web: CrankWeb) -> OpenWeb:
        """Return a web to fit, with its room."""
        table = self.find_table(web)
        path = f"web.{self.tables[web.number]}"
        throw_m = self.throws[web.throw].radius
        return OpenWeb.take(path, table, throw_m, self._find_room(table))

    def _find_room(self, table: Web) -> WebRoom:
        """Return the room for the counterweight of a web."""
        bearing = self.model.bearing
        assert bearing is not None
        length = take_pin(self.model).length + (bearing.main_width or 0.0)
        thickness = find_half_distance(self.engine) - MM * length / 2
        radius = find_known_radius(self.engine)
        clear = math.inf if radius is None else radius - MM * table.clearance
        return WebRoom(clear, thickness)


class _Wanted(NamedTuple):
    """What a scheme wants.

    Attributes:
        unbalances: Unbalance that each web to fit is to have, kg m, in its own axes, by its number.
        remedy: Other devices of the scheme, with reasons and details.
    """

    unbalances: Mapping[int, complex]
    remedy: Remedy


class _Solved(NamedTuple):
    """A fitted web, with its table and its counterweight."""

    web: FittedWeb
    table: Web
    weight: SolvedWeight


def size_webs(
    engine: Engine, model: EngineFile, scheme: str = "factor", options: SchemeOptions | None = None
) -> WebFit:
    """Fit the dimensions of webs that a file gives as "fit".

    A counterweight that does not fit is the largest one that does; the fitted web then has what is
    missing, and what helps.

    Args:
        engine: Engine of the file without what is to be fitted (`sizing.fit.remove_to_fit`).
        model: Engine file with "fit".
        scheme: One of `WEB_SCHEMES`: what the webs are to balance.
        options: Options of the scheme.

    Raises:
        BalcliError: The scheme or an option is not for such webs, or no dimension makes what is
            wanted.
    """
    refuse_geared(engine)
    asked = options or SchemeOptions()
    _refuse_others(model, scheme, asked)
    tables = assign_tables(model, len(engine.throws_m))
    is_open = {web: bool(model.web[table - 1].to_fit) for web, table in tables.items()}
    crank = _Crank(engine, model, tables, is_open)
    wanted, solved = _solve(crank, scheme, asked)
    fitted = _make_tables(solved, tables)
    remedy = wanted.remedy._replace(webs=tuple(own.web for own in solved), web_tables=tuple(fitted))
    by_number = {own.number: own.tables for own in fitted}
    with_weights: list[Web] = []
    without: list[Web] = []
    for number, table in enumerate(model.web, 1):
        own = by_number.get(number)
        with_weights += own or (table,)
        without += [part.remove_counterweight() for part in own] if own else [table]
    before = _rebuild(engine, model, without)
    return WebFit(remedy, before, _rebuild(engine, model, with_weights))


def _refuse_others(model: EngineFile, scheme: str, options: SchemeOptions) -> None:
    """Raise BalcliError for a scheme or an option that webs with "fit" do not take."""
    name = list_open_webs(model)[0]
    if scheme not in WEB_SCHEMES:
        raise ArgumentError(
            '{path} is "fit", which {scheme} {wrong:.60} does not take; choose one of {known}',
            path=name,
            wrong=scheme,
            known=join_words(WEB_SCHEMES),
        )
    options.check(scheme)
    for option in ("planes", "measured"):
        for_machine = option == "planes" and scheme == "factor"  # its correction planes
        if getattr(options, option) is not None and not for_machine:
            raise ArgumentError(
                '{argument}: {path} is "fit", so the weights are in the webs; leave the option out',
                argument=Argument(option),
                path=name,
            )
    if len(options.factor or ()) > 1:
        raise ArgumentError('{factor}: {path} is "fit"; give one factor, such as 50%', path=name)
    if options.order not in (None, 1):
        raise ArgumentError('{order}: {path} is "fit", and webs cancel only order 1', path=name)
    if devices := list_to_fit(model):
        raise BalcliError(
            f'{name} and {devices[0][0]}.unbalance are "fit"; give figures for one of the two'
        )


# ------------------------------------------------------------------ solution
def _solve(crank: _Crank, scheme: str, options: SchemeOptions) -> tuple[_Wanted, list[_Solved]]:
    """Return what is wanted, and the fitted webs from the free end."""
    want = _WANTED[scheme]
    wanted = want(crank, options)
    numbers = []
    for web in crank.open_webs:
        if crank.find_table(web).is_open("thickness"):
            numbers.append(web.number)
    guesses = [np.zeros(len(numbers))]
    answers: list[Array] = []
    for _ in range(_MOST_ROUNDS):
        answers.append(_measure_thicknesses(crank, numbers, wanted))
        change = np.abs(answers[-1] - guesses[-1]).max(initial=0.0)
        if change <= _SETTLED * np.abs(answers[-1]).max(initial=0.0):
            solved = [
                _fit_web(crank, web, wanted.unbalances[web.number]) for web in crank.open_webs
            ]
            return wanted, solved
        guesses.append(_extrapolate(guesses, answers))
        crank = _thicken(crank, dict(zip(numbers, guesses[-1].tolist(), strict=True)))
        wanted = want(crank, options)
    names = []
    for number, table in enumerate(crank.model.web, 1):
        if table.is_open("thickness"):
            names.append(f"web.{number}.thickness")
    raise BalcliError(
        f"{join_words(names)}: no thickness makes what is wanted; give figures, or a larger "
        "outer_radius or opening"
    )


def _measure_thicknesses(crank: _Crank, numbers: Iterable[int], wanted: _Wanted) -> Array:
    """Return the thicknesses that make what is wanted, m, whether they fit or not.

    Args:
        crank: Engine whose webs to fit have no counterweight.
        numbers: Numbers of the webs whose thickness is fitted.
        wanted: What is wanted.
    """
    open_webs = {web.number: crank.describe(web) for web in crank.open_webs}
    sizes = [measure_thickness(open_webs[web], wanted.unbalances[web]) for web in numbers]
    return np.array(sizes)


def _extrapolate(guesses: Sequence[Array], answers: Sequence[Array]) -> Array:
    """Return the next guess for a vector that equals its answer. The answers of such guesses are
    combined such that guess and answer would agree if the answer were linear in the guess
    (D. G. Anderson, "Iterative procedures for nonlinear integral equations", 1965).
    """
    last = np.array(answers[-_REMEMBERED:])
    apart = last - np.array(guesses[-_REMEMBERED:])
    if len(last) == 1:
        return last[-1]
    changes = np.diff(apart, axis=0).T
    shares = np.linalg.lstsq(changes, apart[-1], rcond=None)[0]
    return last[-1] - np.diff(last, axis=0).T @ shares


def _thicken(crank: _Crank, thicknesses: Mapping[int, float]) -> _Crank:
    """Return the engine with webs of these thicknesses, m, by their numbers."""
    tables: list[Web] = []
    for web in crank.webs:
        table = crank.find_table(web)
        update: Node = {"webs": (web.number,)}
        if web.number in thicknesses:
            update["thickness"] = thicknesses[web.number] / MM
        own = table.remove_counterweight() if table.to_fit else table
        tables.append(own.model_copy(update=update))
    return crank._replace(engine=_rebuild(crank.engine, crank.model, tables))


def _fit_web(crank: _Crank, web: CrankWeb, wanted: complex) -> _Solved:
    """Return a web with the counterweight that makes the wanted unbalance, as far as it fits."""
    open_web = crank.describe(web)
    found = solve_weight(open_web, wanted)
    table = open_web.table
    _refuse_stray_holes(open_web, found)
    fitted = FittedWeb(web.number, table.to_fit, wanted, found.unbalance)
    if not found.fits:
        fitted = fitted._replace(room=found.weight.unbalance)
        missing = found.unbalance - found.weight.unbalance
        cures = list_cures(open_web, found.weight, missing, take_pin(crank.model))
        fitted = fitted._replace(cures=cures)
    return _Solved(fitted, _fill(table, found), found)


def _refuse_stray_holes(open_web: OpenWeb, found: SolvedWeight) -> None:
    """Raise InputError if a hole is not within a fitted web."""
    table = _fill(open_web.table, found)
    shape = draw_web(table, open_web.path, open_web.throw_m / MM, None)
    key = open_web.table.to_fit
    outline = "the web, which needs no counterweight"
    if found.weight.is_there:
        unit = "deg" if key == "opening" else "mm"
        outline = f"the web with {key} = {getattr(table, key):.6g} {unit}"
    refuse_stray_holes(shape, open_web.path, outline)


def _fill(table: Web, found: SolvedWeight) -> Web:
    """Return the table of a web with its figure in place of "fit", and with the angle if the file
    leaves it out; without a counterweight if none is needed, or none fits.
    """
    weight = found.weight
    if not weight.is_there:
        return table.remove_counterweight()
    figures = {
        "opening": weight.opening_deg,
        "outer_radius": weight.radius / MM,
        "thickness": weight.thickness / MM,
    }
    update = {table.to_fit: limit_digits(figures[table.to_fit])}
    if not table.has("angle"):
        update["angle"] = limit_digits(found.angle_deg)
    return table.model_copy(update=update)


# ------------------------------------------------------------------ tables
def _make_tables(solved: Iterable[_Solved], tables: Mapping[int, int]) -> list[FittedTable]:
    """Return the tables of fitted webs: one for each result, in the order of their first webs."""
    results: dict[int, dict[tuple[object, ...], list[_Solved]]] = {}
    for own in solved:
        of_table = results.setdefault(tables[own.web.web], {})
        of_table.setdefault(_find_likeness(own.table), []).append(own)
    fitted = []
    for number, groups in sorted(results.items()):
        made = [group[0].table for group in groups.values()]
        if len(groups) > 1:
            for row, group in enumerate(groups.values()):
                webs = tuple(own.web.web for own in group)
                made[row] = made[row].model_copy(update={"webs": webs})
        fitted.append(FittedTable(number, tuple(made)))
    return fitted


def _find_likeness(table: Web) -> tuple[object, ...]:
    """Return what webs of one table have in common if they come out equal."""
    figures = (table.thickness, table.outer_radius, table.opening, table.angle)
    return tuple(None if figure is None else f"{figure:.{_ALIKE_DIGITS}g}" for figure in figures)


def _rebuild(engine: Engine, model: EngineFile, tables: Iterable[Web]) -> Engine:
    """Return an engine with other tables of webs, at the same speed.

    Args:
        engine: Engine without what is to be fitted.
        model: Its file, with "fit".
        tables: Tables of its webs.
    """
    update = {"web": tuple(tables)}
    built = build(model.model_copy(update=update)).at_speed(engine.speed_rpm)
    return replace(built, model=take_model(engine).model_copy(update=update))


# ------------------------------------------------------------------ what is wanted
def _want_by_factor(crank: _Crank, options: SchemeOptions) -> _Wanted:
    """Return what balances all rotating mass and a share of the reciprocating mass of each throw,
    less what the throw has already.
    """
    (factor,) = choose_factors(crank.engine, options)
    weights = sum_counterweights(crank.engine, crank.throws)
    of_throws = []
    for index, (throw, weight) in enumerate(zip(crank.throws, weights, strict=True)):
        mass = throw.rotating + factor * throw.reciprocating + throw.mass
        rest = -mass * throw.radius - weight * throw.pin.conjugate()
        for web in crank.webs:
            if web.throw == index and not crank.is_open[web.number]:
                rest -= web.body.unbalance
        of_throws.append(rest)
    reason = (
        f"Counterweights of the webs: all rotating mass and {factor:.6g} of the reciprocating mass "
        "of each throw, less its pin, counterweights and other webs"
    )
    remedy = Remedy("factor", 1, web_reason=reason, card=fill_card(crank.engine, factor))
    details = describe_factor(crank.engine, options, factor)
    return _Wanted(_divide(crank, of_throws), remedy.add_details(**details))


def _want_by_step(crank: _Crank, options: SchemeOptions) -> _Wanted:
    """Return what the webs of each throw have without counterweights, with the weights of a step of
    the ladder that are nearest to this throw.

    Raises:
        BalcliError: The step has no counterweights, or some at a throw without webs to fit.
    """
    remedy = fit_steps(crank.engine, find_ladder(crank.engine, options.read_small()), options)
    if not remedy.counterweights:
        raise ArgumentError(
            '{step} "{name}": the row fits no counterweights, which webs with "fit" could have; '
            "choose a row with counterweights",
            name=options.step,
        )
    devices = [build_fitted(weight, crank.engine) for weight in remedy.counterweights]
    of_throws = sum_at_throws(devices, crank.throws)
    for index, throw in enumerate(crank.throws):
        own = [web for web in crank.open_webs if web.throw == index]
        if of_throws[index] and not own:
            raise ArgumentError(
                '{step} "{name}": the row has a counterweight at throw {number}, and no web of '
                'this throw is "fit"; give one of webs {first} and {last} with "fit"',
                name=options.step,
                number=index + 1,
                first=WEBS_ON_THROW * index + 1,
                last=WEBS_ON_THROW * (index + 1),
            )
        of_throws[index] *= throw.pin.conjugate()
        of_throws[index] += sum(web.body.unbalance for web in own)
    others = []
    reasons = []
    for device, reason in zip(remedy.devices, remedy.reasons, strict=True):
        if device not in remedy.counterweights:
            others.append(device)
            reasons.append(reason)
    left = remedy._replace(
        devices=tuple(others),
        reasons=tuple(reasons),
        web_reason="Counterweights of the webs: those of the row, at the nearest throw",
    )
    return _Wanted(_divide(crank, of_throws), left)


def _want_in_planes(crank: _Crank, options: SchemeOptions) -> _Wanted:
    """Return what the webs have without counterweights, with the smallest unbalances in their
    planes that cancel the part of order 1 that turns with the crank.
    """
    del options  # the webs are the planes
    steady = hold_steady(crank.engine)
    residual = find_residual(steady, 1)
    parts = FORWARD if steady.places_known else FORWARD[:1]
    wanted = {web.number: web.body.unbalance for web in crank.open_webs}
    if any(residual.parts[part] for part in parts):
        slots = [Slot("counterweight", 1, 1, float(web.z)) for web in crank.open_webs]
        found = solve_exactly(slots, residual, parts, SAME_PLACE)
        for web, unbalance in zip(crank.open_webs, found.unbalances, strict=True):
            wanted[web.number] += unbalance * complex(unit(web.pin_deg)).conjugate()
    reason = (
        "Counterweights of the webs: the smallest ones in their planes that cancel the force and "
        "moment of order 1 turning with the crank"
    )
    return _Wanted(wanted, Remedy("counterweights", 1, web_reason=reason))


def _divide(crank: _Crank, of_throws: Iterable[complex]) -> dict[int, complex]:
    """Return the unbalance of each web to fit: equal parts of that of all these webs of its
    throw.

    Args:
        crank: Engine whose webs to fit have no counterweight.
        of_throws: Unbalance of all webs to fit of each throw, kg m, in the axes of its pin.
    """
    wanted = {}
    for index, unbalance in enumerate(of_throws):
        own = [web.number for web in crank.open_webs if web.throw == index]
        for number in own:
            wanted[number] = unbalance / len(own)
    return wanted


_WANTED: dict[str, Callable[[_Crank, SchemeOptions], _Wanted]] = {
    "factor": _want_by_factor,
    "step": _want_by_step,
    "counterweights": _want_in_planes,
}
