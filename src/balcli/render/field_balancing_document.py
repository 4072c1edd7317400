"""What a program reads of field balancing: JSON, and the same figures as CSV."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from ..field_balancing.balance import FieldBalance, PlaneCorrection, find_eccentricity
from ..field_balancing.influence import find_senses, name_sensor
from ..field_balancing.shop import Piece, find_angle_deg
from .csv import Rows, name_cell
from .figures import clean, clean_finite
from .units import System

_HEADER = ("part", "speed_rpm", "name", "figure", "value", "unit")


def document(result: FieldBalance) -> dict[str, Any]:
    """`balcli.field/1`: readings and weights in the units of the file."""
    file, influence = result.file, result.influence
    found: dict[str, Any] = {
        "format": "balcli.field/1",
        "name": file.name,
        "unit": file.unit,
        "weight_unit": file.weight_unit,
        "phases": find_senses(file)[0],
        "weights": find_senses(file)[1],
        "minimise": result.minimise,
        "readings": [_reading(result, k) for k in range(len(result.after))],
        "influence": [
            [_figures(complex(value)) for value in row] for row in influence.coefficients
        ],
        "corrections": [
            {"plane": p.plane} | _correction(p, bool(influence.trimmed)) for p in result.planes
        ],
        "before": [_figures(complex(value)) for value in influence.now],
        "residual": [_figures(complex(value)) for value in result.after],
        "largest": clean(result.largest),
        "rms": clean(result.rms),
        "condition": clean_finite(result.condition),
    }
    if result.minimise == "max":
        found["bound"] = clean(result.bound)
    if influence.trimmed:
        found["trimmed"] = influence.trimmed
    eccentricity = find_eccentricity(file)
    if eccentricity is not None and file.mass is not None:
        found["permitted"] = {
            "specific_mm": clean(eccentricity),
            "unbalance_g_mm": clean(1e3 * file.mass * eccentricity),
            "planes": [{"plane": plane} | entry for plane, entry in _list_permitted(result)],
            "reached": result.reached,
        }
    return found


def _list_permitted(result: FieldBalance) -> Iterator[tuple[str, dict[str, Any]]]:
    """Each plane by its name, with what may be left in it; none where there is no grade."""
    for p in result.planes:
        if (found := p.permitted) is not None:
            figures = {
                "permitted_g_mm": clean(found.permitted),
                "present_g_mm": clean(found.present),
                "reached": found.reached,
                "after_g_mm": clean(found.after),
            }
            yield p.plane, figures


def _reading(result: FieldBalance, k: int) -> dict[str, Any]:
    speed = result.influence.speeds_rpm[k]
    return {
        "sensor": find_sensor_name(result, k),
        "speed_rpm": None if speed is None else clean(speed),
    }


def find_sensor_name(result: FieldBalance, k: int) -> str:
    """The sensor of a reading, as the file calls it or by its number."""
    return name_sensor(result.file, result.influence.sensors[k])


def _figures(
    value: complex, amount: str = "amplitude", angle: str = "phase_deg"
) -> dict[str, float | None]:
    """A reading, or a weight, under these keys; nothing has no angle."""
    return {amount: clean(abs(value)), angle: clean(find_angle_deg(value)) if value else None}


_weight = partial(_figures, amount="weight", angle="angle_deg")


def _correction(p: PlaneCorrection, trimmed: bool) -> dict[str, Any]:
    """What is to be set in a plane."""
    found: dict[str, Any] = {**_weight(p.total)}
    if trimmed:
        found["add"] = _weight(p.step)
    if p.unbalance is not None:
        found["unbalance_g_mm"] = clean(p.unbalance)
    found |= {"own_effect": clean(p.own), "at_limit": p.limited}
    if p.limited:
        found["wanted"] = _weight(p.total - p.step + p.wanted)
    found["pieces"] = [_piece(piece) for piece in p.pieces]
    return found


def _piece(piece: Piece) -> dict[str, float | None]:
    found = {"weight": clean(piece.weight), "angle_deg": clean(piece.angle_deg)}
    if piece.place is not None:
        found["place"] = piece.place
    if piece.depth_mm is not None:
        found["depth_mm"] = clean(piece.depth_mm)
    return found


def rows(result: FieldBalance, system: System) -> Rows:
    """Every figure of the corrections and readings a row, in the units of the file."""
    return Rows(_HEADER, _lines(result))


def _lines(result: FieldBalance) -> Iterator[tuple[Any, ...]]:
    file, influence = result.file, result.influence
    readings = [_reading(result, k) for k in range(len(result.after))]
    for p in result.planes:
        figures = _correction(p, bool(influence.trimmed))
        yield from _list(("correction", None), p.plane, figures, file.weight_unit)
    for kind, values in (("before", influence.now), ("residual", result.after)):
        for reading, value in zip(readings, values, strict=True):
            where = (kind, reading["speed_rpm"])
            yield from _list(where, reading["sensor"], _figures(complex(value)), file.unit or "")
    for reading, row in zip(readings, influence.coefficients, strict=True):
        for plane, value in zip(file.planes, row, strict=True):
            where = ("influence", reading["speed_rpm"])
            name = f"{reading['sensor']} by {plane}"
            yield from _list(where, name, _figures(complex(value)), "")
    for plane, figures in _list_permitted(result):
        yield from _list(("permitted", None), plane, figures, "")
    details = {
        "condition": clean_finite(result.condition),
        "largest": clean(result.largest),
        "rms": clean(result.rms),
    }
    if result.minimise == "max":
        details["bound"] = clean(result.bound)
    for name, value in details.items():
        yield ("details", None, "", name, value, "")


def _list(
    where: tuple[str, float | None], name: str, figures: dict[str, Any], unit: str, path: str = ""
) -> Iterator[tuple[Any, ...]]:
    """Every figure of an entry of the document, its inner entries by dotted names.

    Args:
        where: part of the table, and speed in rpm.
        unit: of weights or amplitudes.
    """
    for key, value in figures.items():
        if isinstance(value, dict):
            yield from _list(where, name, value, unit, f"{path}{key}.")
        elif isinstance(value, list):
            for k, item in enumerate(value, 1):
                yield from _list(where, name, item, unit, f"{path}{key}.{k}.")
        else:
            own = {"weight": unit, "amplitude": unit}.get(key, _unit_of(key))
            yield *where, name_cell(name), f"{path}{key}", value, name_cell(own)


def _unit_of(key: str) -> str:
    return next((unit for end, unit in _UNITS.items() if key.endswith(end)), "")


_UNITS = {"_deg": "deg", "_g_mm": "g mm", "_mm": "mm"}
