"""Two engines on one frame, geared one to one (H, U and opposed-piston engines): their phasors
added.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..core.peaks import Peak, peak
from ..core.phasors import Phasors, unit
from ..engine.arrays import Figure
from ..engine.assembly import Ripple
from ..engine.build import Engine
from ..forces.kinds import KINDS, VECTORS, Kind
from ..forces.spectrum import Spectra, assembled, relevant_orders, spectra
from .analysis import checked_orders, shown_orders


@dataclass(frozen=True)
class Arrangement:
    """How the second engine stands to the first.

    Attributes:
        phase_deg: crank angle by which it leads, in its own sense of rotation.
        at_m: place of its origin (its crank axis at its z = 0) in the first engine's axes.
        turn_deg: how far it is turned about z, with all its banks.
        reverse: whether its crank turns against the first: it is then built as its own mirror image
        (y changed in sign), so
            that its file still counts everything in its own sense of rotation.
    """

    phase_deg: float = 0.0
    at_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn_deg: float = 0.0
    reverse: bool = False


@dataclass(frozen=True)
class Combined:
    """What two engines do to their common frame, about the first one's point of reference.

    The inertia torque is the sum of both about z, in the first one's sense: what a common gear
    train would feel.
    """

    engines: tuple[Engine, Engine]
    arrangement: Arrangement
    spectra: Spectra
    force: Peak
    moment: Peak
    cylinders: tuple[tuple[int, Spectra], ...] = ()

    @property
    def peaks(self) -> list[tuple[Kind, Peak]]:
        """Force and moment, with their peaks."""
        return list(zip(VECTORS, (self.force, self.moment), strict=True))


def combine(
    first: Engine, second: Engine, arrangement: Arrangement, orders: Iterable[float] | None = None
) -> Combined:
    """Both engines together, at the first one's speed and unevenness of speed; engines without
    trailing axes.

    Args:
        orders: which to show; default as in `analyze`.

    Raises:
        BalcliError: orders that are negative or too high.
    """
    asked = None if orders is None else checked_orders(orders)
    second = geared(second, first, arrangement.phase_deg)
    whole = sorted(
        {
            *relevant_orders(first),
            *relevant_orders(second),
            *([1.0, 2.0] if asked is None else asked),
        }
    )
    own = replace(second, reference_m=(0.0, 0.0, 0.0))
    everything = _sum(
        spectra(first, whole), placed(spectra(own, whole), arrangement, first.reference_m)
    )
    return Combined(
        (first, second),
        arrangement,
        everything.at(shown_orders(everything) if asked is None else asked),
        peak(everything["force"]),
        peak(everything["moment"]),
    )


def geared(engine: Engine, leader: Engine, phase_deg: float) -> Engine:
    """An engine at another's speed, which it leads by an angle; the unevenness is that of the
    other's crank angle.
    """
    ripple = tuple(
        Ripple(line.order, line.amplitude, line.angle_deg + line.order * phase_deg)
        for line in leader.ripple
    )
    return replace(engine, speed_rpm=leader.speed_rpm, ripple=ripple)


def placed(own: Spectra, arrangement: Arrangement, reference_m: Collection[Figure]) -> Spectra:
    """Phasors of an engine about its own origin, by its own crank angle -> where it stands, by the
    leading one's.
    """
    n = own.orders
    x, y, z = (place - point for place, point in zip(arrangement.at_m, reference_m, strict=True))
    lead = unit(n * arrangement.phase_deg)
    parts = {kind.name: _led(phasors, lead) for kind, phasors in own.items()}
    if arrangement.reverse:
        parts = {name: _mirrored(phasors, KINDS[name]) for name, phasors in parts.items()}
    turn = unit(arrangement.turn_deg)
    force = turn * parts["force"]
    parts["force"] = force
    parts["moment"] = turn * parts["moment"] + 1j * z * force
    parts["couple"] = parts["couple"] + force.about(x + 1j * y)
    return Spectra(n, **{name: assembled(kind, parts) for name, kind in KINDS.items()})


def _led(phasors: Phasors, lead: np.ndarray) -> Phasors:
    return Phasors(
        phasors.orders, lead * phasors.forward, np.conj(lead) * phasors.backward, phasors.noise
    )


def _mirrored(phasors: Phasors, kind: Kind) -> Phasors:
    """In the mirror that changes the sign of y a vector becomes its conjugate, and what turns
    changes its sign besides.
    """
    sign = 1.0 if kind.dimension == "force" else -1.0
    mean = phasors.orders == 0
    forward = np.where(mean, np.conj(phasors.forward), np.conj(phasors.backward))
    return Phasors(
        phasors.orders,
        sign * forward,
        sign * np.where(mean, 0, np.conj(phasors.forward)),
        phasors.noise,
    )


def _sum(one: Spectra, other: Spectra) -> Spectra:
    return Spectra(one.orders, **{name: (one[name] + other[name]).settled() for name in KINDS})
