"""Plain words on each order: which part turns with the crank and can be met by a counterweight, which part needs shafts."""
from __future__ import annotations

from ..core.phasors import Phasors
from ..spectrum import Spectra
from .sheet import degrees, number
from .units import System, Unit

_NAMES = {1: "First", 2: "Second", 3: "Third", 4: "Fourth", 5: "Fifth", 6: "Sixth", 7: "Seventh", 8: "Eighth"}
_AXES = {"0.0": "x", "90.0": "y"}
NEGLIGIBLE = 1e-3               # higher orders are passed over below this share of the largest order


def verdict(spectra: Spectra, system: System) -> tuple[str, ...]:
    """A sentence for every order that matters; empty if neither forces nor moments were asked for."""
    found = [(name, phasors, unit) for name, phasors, unit in
             (("force", spectra.force, system.force), ("moment", spectra.moment, system.moment)) if phasors is not None]
    if not found:
        return ()
    told = (_low(k, int(order), found) if order <= 2 else _high(k, order, found) for k, order in enumerate(spectra.orders) if order >= 1)
    return tuple(filter(None, told))


def _name(order: float) -> str:
    return f"{_NAMES.get(int(order)) or f'{order:g}th'} order"


def _low(k: int, order: int, found: list[tuple[str, Phasors, Unit]]) -> str:
    """Orders 1 and 2: what is there, which way it turns, and what meets it."""
    there = [_vector(k, order, *one) for one in found if not one[1].balanced[k]]
    free = [what for what, p, _ in found if p.balanced[k]]
    if not there:
        return f"{_name(order)}: free of {' and '.join(free)}."
    rest = [f"no {what}." for what in free]
    return f"{_name(order)}: " + " ".join([there[0], *(text[0].upper() + text[1:] for text in [*there[1:], *rest])])


def _high(k: int, order: float, found: list[tuple[str, Phasors, Unit]]) -> str:
    """Higher orders: their size, if it is worth a word."""
    sizes = [f"{what} up to {number(unit.of(float(p.major[k])), 4)} {unit.name}" for what, p, unit in found
             if p.major[k] > NEGLIGIBLE * p.major.max()]
    return f"{_name(order)}: {', '.join(sizes)}; rarely balanced, it would take shafts at {order:g} times crank speed." if sizes else ""


def _vector(k: int, order: int, what: str, p: Phasors, unit: Unit) -> str:
    forward, backward = abs(p.forward[k]), abs(p.backward[k])
    size = f"{number(unit.of(float(p.major[k])), 4)} {unit.name}"
    if backward == 0:
        cure = "counterweights on the crankshaft cancel it" if order == 1 else _shafts(f"a shaft at +{order}")
        return f"{what} of {size}, turning with the crank: {cure}."
    if forward == 0:
        return f"{what} of {size}, turning against the crank: {_shafts(f'a shaft at −{order}')}."
    parts = f"{number(unit.of(forward), 4)} turns with the crank, {number(unit.of(backward), 4)} against it"
    cure = "counterweights cancel the first part, a shaft at −1 times crank speed the second" if order == 1 else \
        _shafts(f"shafts at +{order} and −{order}")
    return f"{what} of up to {size} {_direction(what, float(p.axis_deg[k]))} ({parts}): {cure}."


def _direction(what: str, axis_deg: float) -> str:
    """A force acts along an axis, a moment about it."""
    angle = degrees(axis_deg)
    return f"{'about' if what == 'moment' else 'along'} {_AXES.get(angle) or f'an axis at {angle} deg'}"


def _shafts(which: str) -> str:
    return f"nothing on the crankshaft cancels it; it takes {which} times crank speed"
