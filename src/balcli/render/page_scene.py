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
from ..forces.kinds import MOMENT, VECTORS
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
    shown = {"as in the file": now} | ({} if after is None else {"with the devices fitted": after})
    return {
        "stroke": stroke,
        "bore": bore,
        "rotary": isinstance(engine.cylinders.linkage, Rotary),
        "cylinders": _cylinder_entries(engine),
        "variants": [_variant_entry(name, each, system, bore) for name, each in shown.items()],
        "units": {
            kind.name: {
                "name": (unit := system.unit(kind)).name,
                "thousand": f"k{unit.name}" if unit.size == 1 else "",
                "least": unit.of(NEGLIGIBLE * now.of_one_cylinder[kind.name]),  # that counts
            }
            for kind in VECTORS
        },
        "orders": [
            order_number(n) for n in now.orders if any(_shakes(each, n) for each in shown.values())
        ],
    }


def _cylinder_entries(engine: Engine) -> list[dict[str, Any]]:
    """One entry a cylinder, mm and degrees: axis, its own crank angle at crank angle 0, rod,
    offset, place; knuckle pin and master's row.
    """
    c, linkage = engine.cylinders, engine.cylinders.linkage
    rods = linkage.hung if isinstance(linkage, Rotary) else linkage
    columns = {
        "number": engine.numbers,
        "axis": c.axis_of_each_deg,
        "phase": c.angle_deg,
        "z": c.z * 1e3,
        "rod": np.broadcast_to(np.ravel(c.radius / c.lam) * 1e3, c.count),
        "offset": np.broadcast_to(np.ravel(c.offset) * 1e3, c.count),
    }
    lists = [np.asarray(column).tolist() for column in columns.values()]
    found = [dict(zip(columns, values, strict=True)) for values in zip(*lists, strict=True)]
    if isinstance(rods, Articulated):
        pins = np.ravel(rods.knuckle) * float(c.radius) * 1e3
        for row, entry in enumerate(found):
            if rods.master[row] != row:
                entry |= {
                    "master": int(rods.master[row]),
                    "knuckle": [float(pins[row].real), float(pins[row].imag)],
                    "lead": float(rods.lead_deg[row]),
                }
    return found


def _variant_entry(label: str, result: Analysis, system: System, bore: float) -> dict[str, Any]:
    drawn = place_beside(result.engine, bore / 1e3)
    devices = enumerate(result.engine.devices)
    entry: dict[str, Any] = {"force": [], "moment": []} | {
        kind.name: _vector_rows(phasors, system.unit(kind))
        for kind, phasors in result.spectra.vectors()
        if result.moments_known or kind is not MOMENT
    }
    entry["devices"] = [_device_entry(device, drawn.get(row)) for row, device in devices]
    return {"label": label, **entry}


def _vector_rows(phasors: Phasors, unit: ShownUnit) -> list[list[float]]:
    """Return a row an order: the order, forward x and y, backward x and y."""
    forward, backward = phasors.forward / unit.size, phasors.backward / unit.size
    parts = (phasors.orders, forward.real, forward.imag, backward.real, backward.imag)
    rows: list[list[float]] = (np.stack(parts, axis=-1) + 0.0).tolist()
    return rows


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
    vectors = (phasors for _, phasors in result.spectra.vectors())
    return any(np.any((p.orders == order) & ~p.balanced) for p in vectors)
