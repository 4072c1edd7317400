"""Counterweights, balancer shafts and sliders in a table."""

from __future__ import annotations

from ..sizing.sizing import Remedy
from .sheet import Grid, degrees, number
from .units import System


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
