"""Place pairs of shafts that turn in opposite directions at N times crank speed.

In a pair, one shaft turns with the crank and cancels V+, the vector of the force of order N that
turns with the crank. The other one turns against it and cancels V-, the vector that turns against
the crank. With the shafts at p_B (with the crank) and p_A (against it), both x + iy from the crank
axis, and theta as the crank angle, they cause the roll `Re c e^{iN theta}` with
`c = i conj(p_B) V+ - i p_A conj(V-)`.

A compensator is a pair of equal masses far from the engine: their force along x makes a moment.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from ..errors import ArgumentError
from .residual import FORCE, MOMENT, ROLL, Residual

Places = dict[int, tuple[complex, ...]]  # positions x + iy, m; keys: 1 with crank, -1 against
_ROUNDING = 1e-9  # a smaller share of a distance is rounding


# ------------------------------------------------------------------ pairs that take the roll
def find_wanted_roll(residual: Residual, roll: complex | None = None) -> complex:
    """Return the value that `conj(p_B) V+ - p_A conj(V-)` takes for a pair that cancels the roll
    about the crank axis, kg m2 (docs/theory.md).

    Args:
        residual: Residual of the order; its point of reference may differ from the crank axis.
        roll: Roll about this point of reference, as in `Residual.parts`; None: the inertia roll.
    """
    forward = residual.force(1)
    backward = residual.force(-1)
    here = residual.reference.place
    moved = here.conjugate() * forward - here * backward.conjugate()
    about_reference = residual.parts[ROLL] if roll is None else roll
    return 1j * about_reference + moved


def place_pair(residual: Residual, wanted: complex, against: complex | None = None) -> Places:
    """Return places of a pair of shafts for which `conj(p_B) V+ - p_A conj(V-)` has the wanted
    value. Both V+ and V- must not be 0.

    Args:
        residual: Residual of the order.
        wanted: Wanted value, kg m2; 0 for a pair that adds no roll.
        against: Place of the shaft that turns against the crank, m; None: the places nearest to
            the crank axis (least squares).
    """
    forward = residual.force(1)
    backward = residual.force(-1)
    # Squares of tiny forces would be 0; a power of two changes no digit.
    scale = 2.0 ** math.frexp(max(abs(forward), abs(backward)))[1]
    forward = forward / scale
    backward = backward / scale
    wanted = wanted / scale
    if against is None:
        against = -wanted * backward / (abs(forward) ** 2 + abs(backward) ** 2)
    with_crank = (wanted + against * backward.conjugate()) / forward
    return {-1: (against,), 1: (with_crank.conjugate(),)}


def find_distance(residual: Residual, places: Places) -> float | None:
    """Return the distance of two shafts along the force, m, if this distance alone determines their
    roll; else None.

    That is so if the force runs on a line (V+ and V- have one size), and if the roll that the
    shafts make varies in phase with the force. The two shafts are then equally far to both sides of
    this line.

    Args:
        residual: Residual of the order.
        places: Places of the two shafts.
    """
    forward = residual.force(1)
    backward = residual.force(-1)
    if not forward or abs(abs(forward) - abs(backward)) > sum(residual.noise[p] for p in FORCE):
        return None
    line = cmath.sqrt(forward * backward) / abs(forward)
    with_crank, against = (places[sense][0] * line.conjugate() for sense in (1, -1))
    apart = abs(with_crank.real - against.real)
    if abs(with_crank.imag + against.imag) > _ROUNDING * apart:
        return None
    return apart


# ------------------------------------------------------------------ compensators
def find_moment_about_y(residual: Residual) -> complex:
    """Return the complex amplitude of the moment about y, divided by `n^2 omega^2` (n: order,
    omega: crank speed), kg m^2; 0 if it is within rounding errors.
    """
    moment = residual.moment(1) + residual.moment(-1).conjugate()
    noise = sum(residual.noise[part] for part in MOMENT)
    return moment if abs(moment) > noise else 0j


def place_forces(moment: complex, places: Sequence[float], z_ref: float) -> dict[float, complex]:
    """Return forces (kg m) that together make a moment (kg m^2), by their places (z, m).

    Args:
        moment: Amplitude of the moment about y.
        places: One or two places.
        z_ref: With a single place, the moment is taken about this z, m.

    Raises:
        ArgumentError: There are more than two places, or the force has no lever arm.
    """
    if len(places) > 2:
        raise ArgumentError("{position} takes one z, or two")
    if len(places) == 1:
        (first,) = places
        other = z_ref
    else:
        first, other = places
    if first == other:
        raise ArgumentError(
            "{position} {first:g} mm: no lever arm to z = {other:g} mm",
            first=1e3 * first,
            other=1e3 * other,
        )
    force = moment / (first - other)
    if len(places) == 1:
        return {first: force}
    return {first: force, other: -force}
