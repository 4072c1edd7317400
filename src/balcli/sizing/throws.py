"""List the throws of a crankshaft with the masses on their pins and the counterweights nearest to
them.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ..core.cylinders import Device
from ..core.phasors import unit
from ..engine.engine import Engine

_SAME_DEG = 1e-9


class Throw(NamedTuple):
    """A throw of a crankshaft, SI units.

    Attributes:
        pin: Direction of its crank pin at crank angle 0, a unit vector.
        z: Position along the crank.
        radius: Crank radius.
        rotating: Rotating mass of its rods.
        reciprocating: Reciprocating mass of its cylinders.
        mass: Unbalanced mass at the crank radius that turns with the pin: the pin alone if the file
            has [[web]].
    """

    pin: complex
    z: float
    radius: float
    rotating: float
    reciprocating: float
    mass: float


def list_throws(engine: Engine) -> list[Throw] | None:
    """Return the throws of an engine, from the free end; None if a throw has several pins.

    Args:
        engine: One engine, not an array of variants.
    """
    c = engine.cylinders
    throws = []
    for index in range(len(engine.throws_m)):
        rows = [row for row, own in enumerate(engine.weighed) if own.throw == index]
        pins = [float(c.pin_deg[row]) for row in rows]
        radii = [float(c.radius_of_each[row]) for row in rows]
        apart = np.abs((np.array(pins) - pins[0] + 180) % 360 - 180)
        if np.any(apart > _SAME_DEG) or np.ptp(radii) > 0:
            return None
        weighed = [engine.weighed[row] for row in rows]
        throws.append(
            Throw(
                pin=complex(unit(float(engine.first_axis_deg) + pins[0])),
                z=float(np.ravel(engine.pins_m)[index]),
                radius=radii[0],
                rotating=sum(float(own.rotating) for own in weighed),
                reciprocating=sum(float(own.reciprocating) for own in weighed),
                mass=sum(float(own.share) for own in weighed),
            )
        )
    return throws


def sum_at_throws(devices: Iterable[Device], throws: Sequence[Throw]) -> list[complex]:
    """Return the sum of the unbalances nearest to each throw at crank angle 0, kg m; of equally
    near throws, the first has the device.

    Args:
        devices: Counterweights.
        throws: Throws of their crank.
    """
    sums = [0j] * len(throws)
    for device in devices:
        distances = [round(abs(throw.z - float(device.z)), 9) for throw in throws]
        sums[distances.index(min(distances))] += complex(device.forward)
    return sums


def sum_counterweights(engine: Engine, throws: Sequence[Throw]) -> list[complex]:
    """Return the sum of the [[counterweight]] tables nearest to each throw, kg m, without webs."""
    own = [device for device in engine.devices if device.is_counterweight and not device.web]
    return sum_at_throws(own, throws)
