"""What the page needs to turn the mechanism and its vectors: plain figures in mm, deg and the
reader's units, ready for JSON.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.mechanisms.articulated import Articulated
from ..core.mechanisms.rotary import Rotary
from ..core.phasors import Phasors
from ..engine.build import Engine
from ..forces.kinds import VECTORS, Kind
from ..results.analysis import Analysis
from .figures import clean
from .sheet import NEGLIGIBLE, order_number
from .units import ShownUnit, System

_SHAFT_WIDTH = 1.6  # crank radii that a shaft takes in the picture
ASSUMED_BORE = 0.95  # of the stroke, where a file gives none: pistons have to be drawn


def scene(now: Analysis, after: Analysis | None, system: System) -> dict[str, Any]:
    """The mechanism, and what shakes as the engine is and with devices fitted."""
    engine = now.engine
    stroke, bore = 2e3 * float(engine.cylinders.radius), clean(engine.bore_m * 1e3)
    bore = bore or ASSUMED_BORE * stroke
    variants = [_variant_entry("as in the file", now, system, bore)]
    if after is not None:
        variants.append(_variant_entry("with the devices fitted", after, system, bore))
    return {
        "stroke": stroke,
        "bore": bore,
        "rotary": isinstance(engine.cylinders.linkage, Rotary),
        "cylinders": _cylinder_entries(engine),
        "variants": variants,
        "units": {kind.name: _unit_entry(system.unit(kind), kind, now) for kind in VECTORS},
        "orders": [
            order_number(n)
            for n in now.orders
            if _shakes(now, n) or (after is not None and _shakes(after, n))
        ],
    }


def _cylinder_entries(engine: Engine) -> list[dict[str, Any]]:
    """One entry a cylinder, mm and degrees: axis, its own crank angle at crank angle 0, rod,
    offset, place; knuckle pin and master's row.
    """
    c, linkage = engine.cylinders, engine.cylinders.linkage
    rods = linkage.hung if isinstance(linkage, Rotary) else linkage
    axes = c.axis_of_each_deg
    lengths, offsets = (
        np.broadcast_to(np.ravel(v) * 1e3, c.count) for v in (c.radius / c.lam, c.offset)
    )
    found = []
    for row, number in enumerate(engine.numbers):
        entry: dict[str, Any] = {
            "number": number,
            "axis": float(axes[row]),
            "phase": float(c.angle_deg[row]),
            "z": float(c.z[row]) * 1e3,
            "rod": float(lengths[row]),
            "offset": float(offsets[row]),
        }
        if isinstance(rods, Articulated) and rods.master[row] != row:
            pin = complex(rods.knuckle[row]) * float(c.radius) * 1e3
            entry |= {
                "master": int(rods.master[row]),
                "knuckle": [pin.real, pin.imag],
                "lead": float(rods.lead_deg[row]),
            }
        found.append(entry)
    return found


def _variant_entry(label: str, result: Analysis, system: System, bore: float) -> dict[str, Any]:
    force, moment = result.spectra.force, result.spectra.moment
    drawn = place_beside(result.engine, bore / 1e3)
    return {
        "label": label,
        "devices": [
            _device_entry(device, drawn.get(row))
            for row, device in enumerate(result.engine.devices)
        ],
        "force": [] if force is None else _vector_rows(force, system.force),
        "moment": []
        if moment is None or not result.moments_known
        else _vector_rows(moment, system.moment),
    }


def _vector_rows(phasors: Phasors, unit: ShownUnit) -> list[list[float]]:
    """A row an order: the order, forward x and y, backward x and y."""
    vectors = zip(phasors.orders, phasors.forward, phasors.backward, strict=True)
    return [
        [float(n), *(unit.of(float(v)) + 0.0 for v in (f.real, f.imag, b.real, b.imag))]
        for n, f, b in vectors
    ]


def _unit_entry(unit: ShownUnit, kind: Kind, now: Analysis) -> dict[str, Any]:
    """Names of the unit and of its thousand, and the value below which all is negligible."""
    least = unit.of(NEGLIGIBLE * now.of_one_cylinder[kind.name])
    return {
        "name": unit.name,
        "thousand": f"k{unit.name}" if unit.size == 1 else "",
        "least": least,
    }


def place_beside(engine: Engine, bore: float) -> dict[int, complex]:
    """Where to draw the shafts that stand within the circle of the crank pins, where none can be:
    beside the engine, those that turn with the crank on the right, the others on the left; x + iy
    (m) by rows of the devices.

    Args:
        bore: m.
    """
    c = engine.cylinders
    r = float(c.radius)
    across, reach = np.sin(np.radians(c.axis_of_each_deg)), r + r / c.lam + bore
    width = float(np.max(np.abs(across) * reach + (1 - np.abs(across)) * bore, initial=1.5 * r))
    found: dict[int, complex] = {}
    rows: dict[tuple[int, bool], int] = {}  # of each shaft on its side of the engine
    for k, device in enumerate(engine.devices):
        if device.kind is not DeviceKind.SHAFT or abs(complex(device.place)) >= r:
            continue
        ahead = bool(device.forward)
        side = rows.setdefault((device.order, ahead), sum(way == ahead for _, way in rows))
        found[k] = complex(-_SHAFT_WIDTH * r * side, (1 if ahead else -1) * (width + r))
    return found


def _device_entry(device: Device, drawn: complex | None) -> dict[str, Any]:
    """A device for the page: unbalance in g mm, places in mm; `drawn`: where it is shown instead of
    its place.
    """
    forward, backward = complex(device.forward), complex(device.backward)
    place = complex(device.place) if drawn is None else drawn
    return {
        "order": order_number(device.order),
        "forward": [forward.real * 1e6, forward.imag * 1e6],
        "backward": [backward.real * 1e6, backward.imag * 1e6],
        "at": [place.real * 1e3, place.imag * 1e3],
        "z": float(device.z) * 1e3,
        "beside": drawn is not None,
    }


def _shakes(result: Analysis, order: float) -> bool:
    rows = [p.select_orders([order]) for _, p in result.spectra.vectors() if order in p.orders]
    return any(not row.balanced[0] for row in rows)
