"""Loads of crank pins and main bearings over a cycle: which may be asked for, and what is told."""

from __future__ import annotations

from typing import NamedTuple

from ..core.piecewise import Extreme

KINDS_OF_LOAD = ("pin", "main")


class CycleLoad(NamedTuple):
    """Load of one pin or bearing.

    Attributes:
        name: number of the cylinder whose rod turns on the pin, or of the bearing from the free
            end.
        z_m: place along the crank.
        largest: N, and the crank angle (rad) at which it is reached.
        mean: over the cycle, N.
        pressure: largest load over diameter times width, Pa; None: the file does not say these.
    """

    name: int
    z_m: float
    largest: Extreme
    mean: float
    pressure: float | None


class CycleLoads(NamedTuple):
    """What was asked for.

    Attributes:
        pin: of crank pins, by the cylinders whose rods turn on them.
        knuckle: of the knuckle pins in master rods, by their articulated cylinders; None where
            there are none.
        main: of main bearings.
        obstacle: why these are not known, though asked for beside others; else empty.
    """

    pin: tuple[CycleLoad, ...] | None = None
    knuckle: tuple[CycleLoad, ...] | None = None
    main: tuple[CycleLoad, ...] | None = None
    obstacle: str = ""
