"""Infer the numbering of the cylinders from a firing order, or list the engines that fit the file.
The rules are those of the package's docstring.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ...errors import InputError, Problem
from ...file.firing_order import NamedOrder, write_order
from ...file.model import EngineFile
from ..layout import cycle_deg
from ..parts import Parts
from .candidates import Candidate, merge_same
from .fits import find_missed
from .hints import describe_changes
from .letters import describe_letters, list_lettered
from .pins import (
    describe_pin_angle,
    list_with_common_pins,
    list_with_split_pins,
    may_fire_unevenly,
)
from .together import is_flat_two_stroke, list_flat_intervals
from .usual import list_tiers, number_groups

LIST_LENGTH = 3  # largest number of engines in a list to choose from
FREE_END = (
    "Numbers count from the free end. If the maker counts from the flywheel end, reverse every "
    "list."
)


def is_numbering_open(parts: Parts) -> bool:
    """Return whether the file leaves the numbering open: it has several banks and a firing order,
    but neither a numbering nor a bank or throw of a single cylinder.
    """
    tables = parts.model.cylinder.values()
    free = any(table.bank is not None or table.throw is not None for table in tables)
    given = parts.model.layout.numbering is not None or free
    return parts.order is not None and not given and parts.plan.banks > 1


def has_open_letters(parts: Parts) -> bool:
    """Return whether the firing order has letters, and it is open which bank each letter means."""
    return isinstance(parts.order, NamedOrder) and parts.model.layout.numbering is None


def is_open(parts: Parts) -> bool:
    """Return whether the file may mean several engines."""
    return is_numbering_open(parts) or has_open_letters(parts) or is_flat_two_stroke(parts)


class Meant(NamedTuple):
    """The engines that a file may mean.

    Attributes:
        engines: Engines of the first tier in which one fits, best balanced first.
        tier: Number of this tier, from 1; 0 if no engine fits.
    """

    engines: list[Candidate]
    tier: int

    @property
    def only(self) -> Candidate | None:
        """The only engine of tier 1; None if there are several, or only less usual ones."""
        return self.engines[0] if self.tier == 1 and len(self.engines) == 1 else None


def find_engines_meant(parts: Parts) -> Meant:
    """Return the engines that a file may mean. With letters in the firing order, firings may be
    close to each other if nothing else fits.
    """
    least = _find_least_interval(parts)
    meant = _choose_tier(_list_tiers(parts), least)
    if has_open_letters(parts) and not meant.engines:
        return _choose_tier(_list_tiers(parts), 0.0)
    return meant


def find_usual(parts: Parts) -> list[Candidate]:
    """Return the engines that the file may mean without its numbering, best balanced first."""
    return _choose_tier(_list_usual(parts), _find_least_interval(parts)).engines


def _find_least_interval(parts: Parts) -> float:
    """Return the smallest firing interval above 0 with which a numbering fits, deg: half the
    interval of even firing if the file gives throws and no intervals, else 0.
    """
    layout = parts.model.layout
    if parts.throws_given and layout.firing_intervals is None:
        return cycle_deg(layout) / len(parts.plan.cells) / 2
    return 0.0


def _choose_tier(tiers: Iterable[list[Candidate]], least_interval: float) -> Meant:
    """Return the engines of the first tier in which one fits; no engines if none fits."""
    for number, tier in enumerate(tiers, 1):
        fitting = [candidate for candidate in tier if candidate.fits(least_interval)]
        if fitting:
            return Meant(sorted(merge_same(fitting), key=lambda engine: engine.rank), number)
    return Meant([], 0)


def _list_tiers(parts: Parts) -> Iterator[list[Candidate]]:
    """Yield the engines that a file may mean, whether they fit or not, tier by tier."""
    for tier in _list_numbered(parts):
        if is_flat_two_stroke(parts):
            yield [
                candidate.with_setting("layout.firing_intervals", intervals)
                for candidate in tier
                for intervals in list_flat_intervals(len(parts.plan.cells))
            ]
        else:
            yield tier


def _list_numbered(parts: Parts) -> Iterator[list[Candidate]]:
    """Yield the engine with each meaning of the letters in its firing order; or with each usual
    numbering, tier by tier; or as the file numbers it.
    """
    if has_open_letters(parts):
        yield [Candidate(model) for model in list_lettered(parts.model, parts.plan)]
    elif is_numbering_open(parts):
        yield from _list_usual(parts)
    else:
        yield [Candidate(parts.model)]


def _list_usual(parts: Parts) -> Iterator[list[Candidate]]:
    """Yield the engine with each usual numbering, tier by tier."""
    model = parts.model
    for tier in list_tiers(parts.plan, radial=model.layout.radial is not None):
        numberings = dict.fromkeys(tier)
        yield [
            Candidate(model.with_inferred("layout", numbering=rows), place)
            for place, rows in enumerate(numberings)
        ]


# ------------------------------------------------------------------ a single engine
def infer_numbering(model: EngineFile) -> EngineFile:
    """Return the file with an inferred numbering, if the file leaves the numbering open and the
    rules find a single engine; else the file unchanged. Letters in the firing order get their
    banks.

    The inferred key still counts as not given: it is not in `model_fields_set`, and is not written
    to files.
    """
    parts = Parts(model)
    try:
        only = find_engines_meant(parts).only if _is_inferred(parts) else None
    except InputError:  # the rules of `engine.build` report it
        return model
    return model if only is None else only.model


def _is_inferred(parts: Parts) -> bool:
    """Return whether an engine that is the only one is used without a question. If the file gives
    throws, cylinders are numbered bank by bank, or as the letters say.
    """
    return has_open_letters(parts) or (is_open(parts) and not parts.throws_given)


def check_numbering(parts: Parts) -> Iterator[Problem]:
    """Check that the firing order fits the crank and means a single engine. Varied figures do not
    affect which engine a file without throws means.
    """
    if not is_open(parts):
        yield from _check_given(parts)
        return
    if parts.varies and not parts.throws_given:
        parts = Parts(parts.model)
    inferred = _is_inferred(parts)
    if not inferred and not find_missed(parts):
        return
    meant = find_engines_meant(parts)
    if inferred and meant.only is not None:
        return
    if meant.engines:
        yield _list_engines(parts, meant.engines)
    else:
        yield _list_remedies(parts)


def _check_given(parts: Parts) -> Iterator[Problem]:
    """Check that the firing order fits the numbers that the file gives."""
    numbered = parts.model.layout.has("numbering")
    for problem in find_missed(parts):
        message = problem.message
        usual = []
        if numbered:
            message += ", or correct layout.numbering"
            usual = [] if parts.varies else find_usual(parts)
        yield problem._replace(message=message + describe_changes(parts, usual))


# ------------------------------------------------------------------ lists to choose from
def _list_engines(parts: Parts, engines: Sequence[Candidate]) -> Problem:
    """Return the mistake of a file that may mean any of these engines."""
    order = write_order(parts.order or ())
    count = f"one of {len(engines)} engines" if len(engines) > 1 else "this engine"
    if has_open_letters(parts) and not is_flat_two_stroke(parts):
        path = "layout.firing_order"
        message = f"{order} may mean {count}, for either bank may have either letter"
    else:
        path = "layout.firing_intervals" if is_flat_two_stroke(parts) else "layout.numbering"
        message = f"is missing, and with the firing order {order} the file may mean {count}"
    return _join_lines(path, message, _describe_engines(engines))


def _join_lines(path: str, message: str, lines: Sequence[str]) -> Problem:
    """Return a mistake whose message is followed by a list, a line for each engine."""
    return Problem(path, "\n    ".join([f"{message}:", *lines, FREE_END]))


def _describe_engines(engines: Sequence[Candidate]) -> list[str]:
    """Return a line for each of the first engines. The letters of the firing order are kept if only
    one engine has these settings.
    """
    for engine in engines:
        alike = [other for other in engines if other.settings == engine.settings]
        engine.letters_suffice = len(alike) == 1
    return [engine.describe() for engine in engines[:LIST_LENGTH]]


def _list_remedies(parts: Parts) -> Problem:
    """Return the mistake of a firing order that fits no usual numbering, with the engines that fit
    with common pins or with split pins.
    """
    common: list[Candidate] = []
    split: list[Candidate] = []
    first_tier = next(_list_numbered(parts))
    two_on_throw = parts.plan.banks == 2 and parts.plan.rods_on_throw == 2
    if two_on_throw and not parts.model.crank.has("splay"):
        common = list_with_common_pins(first_tier)
        split = list_with_split_pins(first_tier)
    split = [engine for engine in split if not any(map(engine.is_same, common))]
    if not common and not split:
        return _describe_unfit(parts, first_tier)
    lines = _describe_engines([*common[: LIST_LENGTH - bool(split)], *split])
    if not common and may_fire_unevenly(parts):
        lines.insert(0, f"common pins: give layout.firing_intervals ({describe_pin_angle(parts)})")
    order = write_order(parts.order or ())
    if has_open_letters(parts):
        message = f"{order} fits no way to give the letters to the banks; it may mean"
        return _join_lines("layout.firing_order", message, lines)
    if not common:
        message = f"is missing, and without it {order} fits no usual numbering; it may mean"
        return _join_lines("crank.splay", message, lines)
    message = f"is missing, and the firing order {order} fits no usual numbering; it may mean"
    return _join_lines("layout.numbering", message, lines)


def _describe_unfit(parts: Parts, first_tier: Sequence[Candidate]) -> Problem:
    """Return the mistake of a firing order for which no numbering and no other pins are known."""
    hints = (_describe_changes_of(candidate) for candidate in first_tier)
    hint = next(filter(None, hints), "")
    if may_fire_unevenly(parts) and not parts.model.crank.has("splay"):
        hint += f"; with common pins, give layout.firing_intervals ({describe_pin_angle(parts)})"
    missed = find_missed(first_tier[0].parts)[0]
    order = first_tier[0].parts.order
    if not has_open_letters(parts) or not isinstance(order, NamedOrder):
        return missed._replace(message=f"{missed.message}, or give layout.numbering{hint}")
    message = f"{order.text} fits no way to give the letters to the banks. If "
    message += f"{describe_letters(order)}, {missed.message}{hint}"
    return Problem("layout.firing_order", message)


def _describe_changes_of(candidate: Candidate) -> str:
    """Return the changes with which a usual numbering fits, in words; a numbering that is not bank
    by bank is one of the changes.
    """
    plan = candidate.parts.plan
    numbering = candidate.numbering
    if numbering == number_groups(plan):
        return describe_changes(candidate.parts)
    return describe_changes(candidate.parts, with_numbering=numbering)
