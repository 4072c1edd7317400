"""Gas torque of a slider-crank in arithmetic of 50 digits, from the definitions alone.

A cycle is a list of pieces, each an interval of the cycle angle with its law of pressure, and every
integral over it is a Gauss-Legendre sum over short panels, with mpmath's nodes and weights. The
pressure of a Wiebe burn is the integral of `V^(n-1) dx` as it stands; the burn runs over u = xi^2,
so that exponents of whole and half numbers are smooth.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property

import mpmath as mp
from mpmath.calculus.quadrature import GaussLegendre

DIGITS = 50
PANEL = mp.mpf("0.3")  # rad


@cache
def gauss() -> list[tuple[mp.mpf, mp.mpf]]:
    """12 nodes and weights on [-1, 1]: on panels so short they leave less than 2e-16 of the largest value."""
    with mp.workdps(DIGITS + 10):
        return GaussLegendre(mp.mp).calc_nodes(3, mp.mp.prec)


def nodes(start: mp.mpf, end: mp.mpf) -> list[tuple[mp.mpf, mp.mpf]]:
    """Points and weights of a sum that integrates from `start` to `end`."""
    count = max(int(mp.ceil((end - start) / PANEL)), 1)
    half = (end - start) / count / 2
    return [(start + (2 * k + 1) * half + half * x, half * w) for k in range(count) for x, w in gauss()]


@dataclass(frozen=True)
class Mechanism:
    """Lengths in m; angles from the upper dead centre."""

    radius: mp.mpf
    rod: mp.mpf
    bore: mp.mpf
    offset: mp.mpf

    @cached_property
    def top(self):
        return mp.asin(self.offset / (self.rod + self.radius))

    @cached_property
    def bottom(self):
        return mp.pi + mp.asin(self.offset / (self.rod - self.radius)) - self.top

    @cached_property
    def area(self):
        return mp.pi / 4 * self.bore**2

    @cached_property
    def swept(self):
        return self.area * self.travel(self.bottom)

    def _place(self, psi):
        across = self.radius * mp.sin(psi) - self.offset
        return self.radius * mp.cos(psi) + mp.sqrt(self.rod**2 - across**2)

    def travel(self, c):
        return self._highest - self._place(c + self.top)

    @cached_property
    def _highest(self):
        return self._place(self.top)

    def rate(self, c):
        psi = c + self.top
        across = self.radius * mp.sin(psi) - self.offset
        lean = across / mp.sqrt(self.rod**2 - across**2)
        return self.radius * (mp.sin(psi) + mp.cos(psi) * lean)

    def volume(self, c, ratio):
        return self.swept / (ratio - 1) + self.area * self.travel(c)


@dataclass
class Sampled:
    """The pressure of a cycle at the points of a sum over it: (angle, weight, pressure)."""

    mechanism: Mechanism
    points: list[tuple[mp.mpf, mp.mpf, mp.mpf]]
    period: mp.mpf

    @cached_property
    def sweeps(self) -> list[mp.mpf]:
        """Volume swept at every point, m3 a rad times the weight."""
        m = self.mechanism
        return [w * m.area * m.rate(c) for c, w, _ in self.points]

    def harmonic(self, h: int, crankcase=0):
        """t_h of `Re sum t_h e^{i h c/2}`, N m."""
        total = mp.fsum(
            v * (p - crankcase) * mp.expj(-h * c / 2) for v, (c, _, p) in zip(self.sweeps, self.points, strict=True)
        )
        return total / self.period * (1 if h == 0 else 2)

    @property
    def imep(self):
        works = (v * p for v, (_, _, p) in zip(self.sweeps, self.points, strict=True))
        return mp.fsum(works) / self.mechanism.swept


def law(pressure: Callable, start, end) -> list[tuple[mp.mpf, mp.mpf, mp.mpf]]:
    """Points of one piece."""
    return [(c, w, pressure(c)) for c, w in nodes(start, end)]


def wiebe_burn(volume: Callable, constant, heat, n, start, duration, shape):
    """Points of a burn that begins with p V^n = `constant`, and that product at its end."""
    exponent = shape + 1
    rate = mp.mpf("6.908")

    def growth(u):
        """Rate over u of the integral of V^(n-1) dx, xi = u^2."""
        power = u ** (2 * exponent)
        burning = rate * exponent * power / u * 2 * mp.exp(-rate * power)
        return volume(start + duration * u * u) ** (n - 1) * burning

    points = []
    done = mp.mpf(0)
    count = max(6, int(2 * shape))  # a steep burn ends suddenly
    for k in range(count):
        low = mp.mpf(k) / count
        high = mp.mpf(k + 1) / count
        for x, w in gauss():
            u = low + (high - low) * (1 + x) / 2
            inner = (u - low) / 2
            part = mp.fsum(v * growth(low + inner * (1 + y)) for y, v in gauss()) * inner
            c = start + duration * u * u
            pressure = (constant + (n - 1) * heat * (done + part)) / volume(c) ** n
            points.append((c, w * (high - low) / 2 * 2 * u * duration, pressure))
        half = (high - low) / 2
        done += mp.fsum(v * growth(low + half * (1 + y)) for y, v in gauss()) * half
    return points, constant + (n - 1) * heat * done


def computed(m: Mechanism, burn: tuple, heat, *, strokes, ratio, nc, ne, intake, exhaust, **valves):
    """A cycle by its heat. `burn`: ("otto",), ("limited", pressure or None) or ("wiebe", start,
    duration, shape); `valves`: `opens` and, four-stroke, `closes`, rad, else the lower dead centre.
    """
    opens = valves.get("opens", m.bottom)
    if strokes == 4:
        closes = valves.get("closes", m.bottom + 2 * mp.pi) - 4 * mp.pi
    else:
        down = m.travel(opens)
        mirror = 2 * mp.pi - opens - mp.mpf("1e-3")
        closes = mp.findroot(lambda c: m.travel(c) - down, (mirror, mirror + mp.mpf("1e-3"))) - 2 * mp.pi

    def volume(c):
        return m.volume(c, ratio)

    compressed = intake * volume(closes) ** nc
    start = min(burn[1], 0) if burn[0] == "wiebe" else mp.mpf(0)
    points = law(lambda c: compressed / volume(c) ** nc, closes, start)
    first = volume(start)
    p2 = compressed / first**nc
    constant = p2 * first**ne
    end = start
    if burn[0] == "otto":
        constant = (p2 + (ne - 1) * heat / first) * first**ne
    elif burn[0] == "limited":
        p3 = burn[1] or p2
        rho = 1 + (heat - (p3 - p2) * first / (ne - 1)) * (ne - 1) / (ne * p3 * first)
        end = mp.findroot(lambda c: volume(c) - rho * first, (0.2, 0.9), solver="anderson")
        points += law(lambda c: p3, start, end)
        constant = p3 * (rho * first) ** ne
    else:
        before = constant
        points += law(lambda c: before / volume(c) ** ne, start, burn[1])
        burnt, constant = wiebe_burn(volume, constant, heat, ne, *burn[1:])
        points += burnt
        end = burn[1] + burn[2]
    points += law(lambda c: constant / volume(c) ** ne, end, opens)
    if strokes == 4:
        points += law(lambda c: exhaust, opens, 2 * mp.pi)
        points += law(lambda c: intake, 2 * mp.pi, closes + 4 * mp.pi)
    else:
        points += law(lambda c: intake, opens, closes + 2 * mp.pi)
    return Sampled(m, points, strokes * mp.pi)
