"""The slider-crank in closed form, centred or offset, without cancellation.

Everything is dimensionless: lengths in crank radii r, the crank angle psi in radians from the
position in which the crank pin lies along the cylinder's axis, derivatives with respect to psi.
`lam` = r/l, `eps` = e/l with the offset e of the piston pin's path towards the side to which the
crank pin moves; the mechanism turns if lam + |eps| < 1. All arguments are broadcast against each
other, so that scalars and arrays of any shape serve. Near its lock the mechanism is so quick that
the rounding of psi itself would show; rates and accelerations therefore also take the complex e^{i
psi} for psi.

Source: the closed forms are those of every textbook (Lu Jiqing, Meng Sizong, Automobile Engine
Design, 1990, (1-2), (1-7), (1-10)); here differences of nearly equal terms are multiplied out, so
that results are good to about 1e-15
relative: travel near the dead centres, velocity near both of them, acceleration but for the
neighbourhood of its zeros.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..cached_property import cached_property
from ..phasors import Array, Complex
from .motion import Motion


class Fastest(NamedTuple):
    """At which crank angle (rad) the piston is fastest, and its velocity there over r omega."""

    psi: Array
    value: Array


class SliderCrank(Motion):
    """Plain slider-cranks in motion; arguments as everywhere here."""

    def __init__(self, psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> None:
        self._sine, self._cosine, self._lam, self._eps = _given(psi, lam, eps)

    @cached_property
    def angle(self) -> tuple[Array, Array]:
        """(sin beta, cos beta) of the rod's angle; the rod stands at -beta from the cylinder's
        axis.

        sin beta = lam sin psi - eps. In cos^2 beta = (1 - sin beta)(1 + sin beta) the factor that
        can become small is written 1 - lam +- eps + lam (1 - |sin psi|), and 1 - |sin psi| =
        cos^2 psi/(1 + |sin psi|).
        """
        near = self._clearance + self._lam * self._cosine**2 / (1 + self._height)
        far = (1 - self._lean) + self._lam * self._height
        return self._lam * self._sine - self._eps, np.sqrt(near * far)

    @property
    def lean(self) -> Array:
        return self.angle[0]

    @cached_property
    def place(self) -> Array:
        return _real(self._cosine + self.angle[1] / self._lam)

    @cached_property
    def velocity(self) -> Array:
        """-sin(psi + beta)/cos beta.

        Where the two terms of the sine differ in sign, their difference is replaced by that of
        their squares, sin^2 psi - sin^2 beta, whose factors vanish exactly at the dead centres.
        """
        sin_beta, cos_beta = self.angle
        sine, cosine, lam, eps = self._sine, self._cosine, self._lam, self._eps
        crank, rod = sine * cos_beta, cosine * sin_beta
        opposed = crank * rod < 0
        safe = np.where(opposed, crank - rod, 1.0)
        product = ((1 - lam) * sine + eps) * (((1 + lam) * sine - eps) / safe)
        return _real(-(np.where(opposed, product, crank + rod) / cos_beta))

    @cached_property
    def acceleration(self) -> Array:
        """sin psi tan beta - cos psi - lam cos^2 psi/cos^3 beta. Accurate relative to its value
        without offset, and to about 1e-16/cos^3 beta absolute with one.
        """
        with_offset = np.count_nonzero(self._eps)
        if not with_offset:
            return -self._centred
        sin_beta, cos_beta = self.angle
        sine, cosine = self._sine, self._cosine
        offset = cosine - sine * sin_beta / cos_beta + self._lam * cosine**2 / self._cube
        if with_offset == np.size(self._eps):
            return _real(-offset)
        return _real(-np.where(self._eps == 0, self._centred, offset))

    @cached_property
    def spin(self) -> Array:
        """-lam cos psi/cos beta"""
        return _real(-(self._lam * self._cosine / self.angle[1]))

    @cached_property
    def spin_rate(self) -> Array:
        """lam ((w^2 - eps^2) sin psi + eps lam (1 + sin^2 psi))/cos^3 beta, w^2 = (1 - lam)(1 +
        lam).

        With h = |sin psi| and e = +-eps, by its sign, the bracket is h (1 - lam + e)(1 + lam - e) +
        e lam (1 - h)^2: near the lock, where both factors 1 - .. are small, nothing cancels.
        """
        bracket = self._height * self._clearance * ((1 - self._lean) + self._lam)
        bracket = bracket + self._lean * self._lam * self._short**2
        sign = np.where(self._sine < 0, -1.0, 1.0)  # as in `_lean`, whatever the sign of zero is
        return _real(self._lam * sign * bracket / self._cube)

    # -------------------------------------------------------------- what they share
    @cached_property
    def _height(self) -> Array:
        """|sin psi|"""
        return np.abs(self._sine)

    @cached_property
    def _short(self) -> Array:
        """1 - |sin psi|"""
        return _real(self._cosine**2 / (1 + self._height))

    @cached_property
    def _lean(self) -> Array:
        """The offset, negative where the crank leans to its side."""
        return np.where(self._sine < 0, -self._eps, self._eps)

    @cached_property
    def _clearance(self) -> Array:
        """1 - lam + lean, rounded once, however small it is."""
        most = 1 - self._lam
        return (most + self._lean) + ((1 - most) - self._lam)

    @cached_property
    def _cube(self) -> Array:
        """cos^3 beta"""
        return _real(self.angle[1] ** 3)

    @property
    def _centred(self) -> Array:
        """-s'' without offset: cos psi + P/cos^3 beta, P = lam (cos^4 psi - w^2 sin^4 psi), w^2 = 1
        - lam^2.

        Where the two differ in sign: P^2 - cos^6 beta cos^2 psi = -w^2 (cos^2 psi - lam^2 sin^4 psi
        cos^2 beta).
        """
        sine, cosine, lam = self._sine, self._cosine, self._lam
        cos_beta, cube = self.angle[1], self._cube
        w2, s2 = (1 - lam) * (1 + lam), sine**2
        w = np.sqrt(w2)
        rod = lam * (cosine**2 - w * s2) * (cosine**2 + w * s2)
        opposed = rod * cosine < 0
        safe = np.where(opposed, rod - cube * cosine, 1.0)
        product = -w2 * (cosine - lam * s2 * cos_beta) * (cosine + lam * s2 * cos_beta) / safe
        return _real(np.where(opposed, product, rod + cube * cosine) / cube)


def rod_angle(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> tuple[Array, Array]:
    """(sin beta, cos beta) of the rod's angle; the rod stands at -beta from the cylinder's axis."""
    return SliderCrank(psi, lam, eps).angle


def displacement(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> Array:
    """Travel x/r from top dead centre, which an offset mechanism reaches at tau with sin tau =
    eps/(1 + lam).

    From x/r = 2 sin((psi - tau)/2) sin((psi + beta)/2) / cos((beta - tau)/2), with beta = -tau at
    top dead centre.
    """
    psi, lam, eps = _floats(psi, lam, eps)
    sin_beta, cos_beta = rod_angle(psi, lam, eps)
    sin_tau, cos_tau = _top(lam, eps)
    half = np.sin((psi - np.arcsin(sin_tau)) / 2)
    lift = (cos_beta + cos_tau) + lam * (np.cos(psi) + cos_tau)
    return _real(2 * half * half * lift / (1 + cos_beta * cos_tau + sin_beta * sin_tau))


def velocity(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> Array:
    """Piston velocity v/(r omega) = sin(psi + beta)/cos beta, positive away from the top."""
    return -SliderCrank(psi, lam, eps).velocity


def acceleration(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> Array:
    """Piston acceleration j/(r omega^2), positive towards the crankshaft (as near the top)."""
    return -SliderCrank(psi, lam, eps).acceleration


def rod_rate(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> Array:
    """beta' = lam cos psi/cos beta; the rod turns at -beta' omega."""
    return -SliderCrank(psi, lam, eps).spin


def rod_acceleration(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> Array:
    """beta'', the derivative of `rod_rate`."""
    return -SliderCrank(psi, lam, eps).spin_rate


# ---------------------------------------------------------------- extremes of the velocity
def fastest(lam: ArrayLike) -> Fastest:
    """Crank angle (0 to 90 degrees) and size of the greatest piston velocity of the centred
    mechanism.

    The acceleration vanishes where cos psi = lam sin^2 psi cos beta, that is with t = sin^2 psi
    where 1 - t = lam^2 t^2 (1 - lam^2 t).
    """
    lam = np.asarray(lam, dtype=np.float64)
    square = lam**2
    t = _bisect(
        lambda t: (1 - t) - square * t**2 * (1 - square * t), 1 / (1 + square), np.ones_like(lam)
    )
    psi = np.arctan2(np.sqrt(t), lam * t * np.sqrt(1 - square * t))
    return Fastest(_real(psi), velocity(psi, lam))


def fastest_two_term(lam: ArrayLike) -> Fastest:
    """The same of the two-term form sin psi + lam/2 sin 2 psi: cos psi = (sqrt(1 + 8 lam^2) - 1)/(4
    lam).
    """
    lam = np.asarray(lam, dtype=np.float64)
    psi = np.arccos(2 * lam / (1 + np.sqrt(1 + 8 * lam**2)))
    return Fastest(_real(psi), _real(np.sin(psi) * (1 + lam * np.cos(psi))))


# ---------------------------------------------------------------- small helpers
def _floats(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike) -> tuple[Array, Array, Array]:
    return (
        np.asarray(psi, dtype=np.float64),
        np.asarray(lam, dtype=np.float64),
        np.asarray(eps, dtype=np.float64),
    )


def _given(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike) -> tuple[Array, Array, Array, Array]:
    """sin psi, cos psi, lam and eps, psi being an angle or e^{i psi}."""
    at = on_circle(psi)
    return at.imag, at.real, np.asarray(lam, dtype=np.float64), np.asarray(eps, dtype=np.float64)


def on_circle(psi: ArrayLike) -> Complex:
    """e^{i psi}, psi being an angle or e^{i psi} itself."""
    angle = np.asarray(psi)
    return angle if np.iscomplexobj(angle) else np.exp(1j * angle)


def _real(value: ArrayLike) -> Array:
    return np.asarray(value, dtype=np.float64)


def _top(lam: Array, eps: Array) -> tuple[Array, Array]:
    """(sin, cos) of the crank angle at top dead centre."""
    sine = eps / (1 + lam)
    return sine, np.sqrt((1 - sine) * (1 + sine))


def _bisect(falling: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Root of a function, positive at `low` and not at `high`, between neighbouring numbers."""
    for _ in range(60):
        middle = (low + high) / 2
        positive = falling(middle) > 0
        low, high = np.where(positive, middle, low), np.where(positive, high, middle)
    return _real((low + high) / 2)
