"""Describe the figures of an engine for the charts and tables of its page.

The description is a document of `balcli analyze --why -f json`. In addition, each step of the
ladder has its devices and the orders that these change, and "page" has what only the page needs.
After a change, the page itself makes the same description (`assets/engine.js`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

from ..analysis.answer import Analysis
from ..balancing.answer import Balance
from ..core.cylinders import Device
from ..core.peaks import Peak, find_largest, find_peak
from ..core.phasors import Array, Phasors
from ..core.records import Node, to_document
from ..engine.engine import Engine
from ..engine.placed import build_fitted
from ..file.fields import order_number
from ..file.model import Counterweight, Shaft
from ..forces.kinds import FORCE, MOMENT
from ..forces.spectrum import Spectra, compute_spectra, find_relevant_orders
from ..forces.stars import find_stars
from ..sizing.ladder import Ladder, Step, find_ladder
from ..sizing.planes import DeviceTable, find_free, find_unbalance, name_kind
from ..sizing.remedy import Remedy, fit_devices
from ..sizing.room import find_rooms, weigh_steel
from ..sizing.ship_engines import is_judged_by_power

MOST_STARS = 8
_KINDS = (FORCE.name, MOMENT.name)


def describe_figures(result: Analysis, balanced: Balance, small: float) -> Node:
    """Return the figures on the page.

    Args:
        result: Analysis of the engine as drawn.
        balanced: Engine with the devices of the scheme.
        small: Share of one cylinder's first order below which a force or moment is ignored.
    """
    engine = result.engine
    ladder = getattr(balanced, "ladder", None) or find_ladder(engine, small)
    document = result.to_dict()
    kept = ("format", "speed_rpm", "reference_mm", "orders", "verdict", "peak")
    figures = {key: document[key] for key in kept if key in document}
    figures["ladder"] = to_document(ladder)
    for described, step in zip(figures["ladder"]["steps"], ladder.steps, strict=True):
        described.update(_describe_devices(result, step.remedy))
    figures["stars"] = list(_describe_stars(result))
    scales = result.scales
    assert result.peak is not None
    figures["page"] = {
        "extra": list(_describe_extra(result, balanced, ladder)),
        "crossheads": is_judged_by_power(engine),
        "scales": {"moment_Nm": scales.moment, "roll_Nm": scales.roll},
        "every": {
            FORCE.name: _measure_repeat(result.peak.force),
            MOMENT.name: _measure_repeat(result.peak.moment),
        },
        "devices": [_describe_vectors(device) for device in engine.devices],
        "roll": _describe_roll(result.whole_roll),
    }
    return figures


def _describe_roll(roll: Phasors | None) -> Node:
    """Return the largest roll by inertia over a revolution (N m) and its crank angle (deg)."""
    assert roll is not None
    peak = find_peak(roll)
    return {"value_Nm": peak.value, "deg": math.degrees(peak.theta)}


def _measure_repeat(peak: Peak) -> float:
    """Return the angle after which the size of a vector repeats, deg; 0 if it is constant."""
    return math.degrees(peak.every)


def _describe_extra(result: Analysis, balanced: Balance, ladder: Ladder) -> Iterator[Node]:
    """Yield choices beside the rows of the ladder: the steps that are fitted by default, if they
    are not those of a row, and the scheme of the page, if the reader asked for another than auto.
    """
    rows = [step.remedy.devices for step in ladder.steps]
    usual = ladder.fit()
    if usual.devices not in rows:
        numbers = [str(ladder.find_row(step)) for step in ladder.auto]
        steps = (
            f"step {numbers[0]} alone" if len(numbers) == 1 else f"steps {' and '.join(numbers)}"
        )
        yield _describe_choice(result, f"default: {steps}", usual)
    remedy = balanced.remedy
    is_row = remedy.devices in (*rows, usual.devices)
    if remedy.devices and not (is_row and remedy.scheme == "auto"):
        yield _describe_choice(result, f"scheme {remedy.scheme}", remedy, balanced.after)


def _describe_choice(
    result: Analysis, name: str, remedy: Remedy, after: Analysis | None = None
) -> Node:
    """Return a choice in the form of a step of the ladder.

    Args:
        result: Analysis of the engine as drawn.
        name: Name of the choice.
        remedy: Its devices.
        after: Analysis with these devices; None: it is computed.
    """
    engine = fit_devices(result.engine, remedy) if after is None else after.engine
    spectra = compute_spectra(engine, find_relevant_orders(engine), _KINDS)
    shafts = {(shaft.ratio, shaft.at) for shaft in remedy.shafts}
    row = result.engine.cranks[0].engine
    radius = float(row.cylinders.radius_of_each[row.numbers.index(1)])
    step = Step(
        step=name,
        peak_force_N=float(find_largest(spectra[FORCE.name])),
        peak_moment_Nm=float(find_largest(spectra[MOMENT.name])) if result.moments_known else None,
        counterweights=len(remedy.counterweights),
        shafts=len(shafts),
        mass_kg=sum(map(find_unbalance, remedy.devices)) / radius,
        steel_kg=weigh_steel(remedy, find_rooms(result.engine)),
        own=remedy,
        remedy=remedy,
    )
    return to_document(step) | _describe_devices(result, remedy, engine)


# ------------------------------------------------------------------ devices
def _describe_devices(result: Analysis, remedy: Remedy, fitted: Engine | None = None) -> Node:
    """Return the devices of a step, and force and moment of the orders that they change."""
    devices = remedy.devices
    engine = result.engine
    built = [build_fitted(device, engine) for device in devices]
    free = find_free(devices)
    described = [
        _describe_table(device, anywhere) | _describe_vectors(vectors)
        for device, anywhere, vectors in zip(devices, free, built, strict=True)
    ]
    after = fitted or fit_devices(engine, remedy)
    orders = result.orders[result.orders > 0]
    changed = list(_list_changes(engine, after, orders)) if devices or fitted else []
    return {"devices": described, "changes": changed}


def _describe_table(device: DeviceTable, free: bool) -> Node:
    """Return a device as the tables of the page show it."""
    vectors: Node = {
        "device": name_kind(device),
        "unbalance_kg_m": find_unbalance(device),
        "angle_deg": device.angle,
        "position_mm": device.position,
    }
    if isinstance(device, Counterweight):
        return vectors | ({"crank": device.engine} if device.engine else {})
    speed = device.ratio if isinstance(device, Shaft) else device.order
    return vectors | {"ratio": speed, "at_mm": list(device.at), "free": free}


def _describe_vectors(device: Device) -> Node:
    """Return a device as the drawing shows it: its vectors (kg m) and its place (mm)."""
    forward = complex(device.forward)
    backward = complex(device.backward)
    place = complex(device.place)
    return {
        "kind": str(device.kind.name).lower(),
        "order": order_number(device.order),
        "forward": [forward.real, forward.imag],
        "backward": [backward.real, backward.imag],
        "at_mm": [1e3 * place.real, 1e3 * place.imag],
        "position_mm": 1e3 * float(device.z),
    }


def _list_changes(before: Engine, after: Engine, orders: Array) -> Iterator[Node]:
    """Yield force and moment of each order that differs between two engines."""
    states = [compute_spectra(engine, orders, _KINDS) for engine in (before, after)]
    for row, order in enumerate(orders.tolist()):
        vectors = [_pick_vectors(state, row) for state in states]
        if vectors[0] != vectors[1]:
            yield {"order": order_number(order), **vectors[1]}


def _pick_vectors(spectra: Spectra, row: int) -> dict[str, list[list[float]]]:
    """Return the two vectors of force and moment of an order."""
    of_kinds = {}
    for kind, phasors in spectra.vectors():
        parts = (complex(phasors.forward[row]), complex(phasors.backward[row]))
        of_kinds[kind.name] = [[part.real + 0.0, part.imag + 0.0] for part in parts]
    return of_kinds


# ------------------------------------------------------------------ stars
def _describe_stars(result: Analysis) -> Iterable[Node]:
    """Return the first stars of the orders shown; none for several cranks."""
    if result.engine.placed:
        return []
    kinds = _KINDS[: 1 + result.moments_known]
    stars = list(find_stars(replace(result.engine, ripple=()), result.orders, kinds))
    return [to_document(star) for star in stars[:MOST_STARS]]
