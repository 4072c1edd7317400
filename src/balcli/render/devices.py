"""Counterweights, balancer shafts and sliders."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..sizing.sizing import Practical, Remedy
from .figures import clean
from .sheet import Grid, degrees, number
from .units import System, Unit


def device_grid(remedy: Remedy, system: System) -> Grid:
    """One row a device, in the units of the shop."""

    def length(mm: float) -> str:
        return number(mm / 1e3 / system.length.size)

    def unbalance(g_mm: float | None) -> str:
        return number((g_mm or 0.0) / 1e6 / system.unbalance.size)

    rows = [
        (
            "counterweight",
            "1",
            unbalance(d.unbalance),
            f"{degrees(d.angle)} from pin 1",
            "on the crank",
            length(d.position),
        )
        for d in remedy.counterweights
    ]
    rows += [
        (
            "shaft",
            f"{d.ratio:+d}".replace("-", "−"),
            unbalance(d.unbalance),
            degrees(d.angle),
            f"{length(d.at[0])}, {length(d.at[1])}",
            length(d.position),
        )
        for d in remedy.shafts
    ]
    rows += [
        (
            "slider",
            str(d.order),
            unbalance(d.unbalance),
            f"{degrees(d.angle)} along {degrees(d.direction)}",
            f"{length(d.at[0])}, {length(d.at[1])}",
            length(d.position),
        )
        for d in remedy.sliders
    ]
    heads = (
        "device",
        "turns",
        f"{system.unbalance.name}",
        "angle, deg",
        f"x, y, {system.length.name}",
        f"z, {system.length.name}",
    )
    return Grid("", heads, tuple(rows), words=(0, 3, 4))


def device_entries(remedy: Remedy) -> dict[str, list[dict[str, Any]]]:
    """New devices, as an engine file would describe them."""
    return {
        "counterweights": [
            {
                "unbalance_kg_m": (d.unbalance or 0.0) / 1e6,
                "angle_deg": d.angle,
                "position_mm": d.position,
            }
            for d in remedy.counterweights
        ],
        "shafts": [
            {
                "ratio": d.ratio,
                "unbalance_kg_m": (d.unbalance or 0.0) / 1e6,
                "angle_deg": d.angle,
                "at_mm": list(d.at),
                "position_mm": d.position,
            }
            for d in remedy.shafts
        ],
        "sliders": [
            {
                "order": d.order,
                "unbalance_kg_m": (d.unbalance or 0.0) / 1e6,
                "direction_deg": d.direction,
                "angle_deg": d.angle,
                "at_mm": list(d.at),
                "position_mm": d.position,
            }
            for d in remedy.sliders
        ],
    }


def practical_entry(p: Practical) -> dict[str, float | None]:
    """What JSON says of the mass of a device in the workshop."""
    figures = {
        "unbalance_kg_m": p.unbalance,
        "mass_kg": p.mass,
        "radius_mm": p.radius * 1e3,
        "force_N": p.force,
        "speed_rpm": p.speed_rpm,
        "disc_radius_mm": p.disc_radius * 1e3,
        "disc_thickness_mm": p.disc_thickness * 1e3,
    }
    return {key: clean(value) for key, value in figures.items()} | (
        {} if p.depth is None else {"drill_depth_mm": clean(p.depth * 1e3)}
    )


def device_rows(device: Any, system: System) -> Iterator[tuple[str, Any, str]]:
    """Name, value and unit of every figure of a device, as an engine file would say it."""

    unbalance, length = system.unbalance, system.length
    for name in ("ratio", "order"):
        if hasattr(device, name):
            yield name, getattr(device, name), ""
    yield "unbalance", _converted(unbalance, device.unbalance or 0.0, 1e-6), unbalance.name
    for name in ("angle", "direction"):
        if hasattr(device, name):
            yield name, getattr(device, name), "deg"
    yield "position", _converted(length, device.position, 1e-3), length.name
    for axis, place in zip("xy", getattr(device, "at", ()), strict=False):
        yield f"at_{axis}", _converted(length, place, 1e-3), length.name


def _converted(unit: Unit, value: float, size: float) -> float:
    """A value in units of this size (of the SI unit) in another unit; as it is where that is the
    same.
    """
    return value if unit.size == size else unit.of(value * size)
