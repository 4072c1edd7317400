"""Plain words on each order: which part turns with the crank and can be met by a counterweight, which part needs shafts."""
from __future__ import annotations

from ..core.phasors import Phasors
from ..spectrum import Spectra
from .figures import order_number
from .sheet import degrees, number
from .units import System, Unit

_NAMES = {1: "First", 2: "Second", 3: "Third", 4: "Fourth", 5: "Fifth", 6: "Sixth", 7: "Seventh", 8: "Eighth"}
NEGLIGIBLE = 1e-3               # higher orders are passed over below this share of the largest order


def verdict(spectra: Spectra, system: System) -> tuple[str, ...]:
    """A sentence for every order that matters; empty if neither forces nor moments were asked for."""
    found = [(name, phasors, unit) for name, phasors, unit in
             (("force", spectra.force, system.force), ("moment", spectra.moment, system.moment)) if phasors is not None]
    rows = [k for k, order in enumerate(spectra.orders) if order >= 1]
    return tuple(_order(k, spectra.orders[k], found) for k in rows if found and _matters(k, spectra.orders[k], found))


def _matters(k: int, order: float, found: list[tuple[str, Phasors, Unit]]) -> bool:
    return order <= 2 or any(p.major[k] > NEGLIGIBLE * p.major.max() for _, p, _ in found)


def _order(k: int, order: float, found: list[tuple[str, Phasors, Unit]]) -> str:
    name = _NAMES.get(int(order), f"{order:g}th")
    there = [(what, p, unit) for what, p, unit in found if not p.balanced[k]]
    free = [what for what, p, _ in found if p.balanced[k]]
    if not there:
        return f"{name} order: free of {' and '.join(free)}."
    told = [_vector(k, order, what, p, unit) for what, p, unit in there]
    if free:
        told.append(f"No {free[0]}.")
    return f"{name} order: " + " ".join(text[0].upper() + text[1:] for text in told)


def _vector(k: int, order: float, what: str, p: Phasors, unit: Unit) -> str:
    forward, backward = abs(p.forward[k]), abs(p.backward[k])
    n = order_number(order)
    size = f"{what} of {number(unit.of(float(p.major[k])), 4)} {unit.name}"
    if backward == 0:
        return f"{size}, turning with the crank: {'counterweights on the crankshaft cancel it' if n == 1 else _shafts(f'at +{n}')}."
    if forward == 0:
        return f"{size}, turning against the crank: {_shafts(f'at −{n}')}."
    shape = f"up to {size[len(what) + 4:]} along {degrees(float(p.axis_deg[k]))} deg"
    parts = f"{number(unit.of(forward), 4)} turns with the crank, {number(unit.of(backward), 4)} against it"
    return f"{what} {shape} ({parts}): {_both(n)}."


def _both(n: float) -> str:
    if n == 1:
        return "counterweights cancel the first part, a shaft at −1 the second"
    return _shafts(f"at +{n} for the first part and at −{n} for the second")


def _shafts(where: str) -> str:
    return f"nothing on the crankshaft cancels it; it takes a shaft {where}"
