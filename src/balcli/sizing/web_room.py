"""Solve the counterweight of one web for a wanted unbalance, in the room that it has, and list what
helps where it does not fit.

A counterweight is a sector from the hub's radius R_h to the radius R with the opening q, of the
thickness t and the density rho. Its unbalance is `2/3 rho t (R^3 - R_h^3) sin(q/2)`, which has one
solution for q up to 180 deg, for R, and for t. With t, the cheek grows as well: the unbalance of
the whole web is proportional to t.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from ..core.outline import find_direction
from ..core.unbalance import SLUGS
from ..engine.webs.bodies import MM, describe_web, find_cheek, weigh_bare
from ..errors import InputError, Problem
from .planes import measure_direction
from .remedy import WebCure

if TYPE_CHECKING:
    from ..core.outline import Cheek
    from ..engine.webs.build import PinSize
    from ..file.web_tables import Web

LARGEST_OPENING_DEG = 180.0  # more would take unbalance away
_RIM_M = 3 * MM  # steel between a slug and the rim of the counterweight
_ROUNDING = 1e-9  # a smaller share of what is wanted and there is rounding
_DEG_DIGITS = 9  # decimals of a fitted angle
_METRE_MM = 1e3


class WebRoom(NamedTuple):
    """Room for counterweights of webs, m; infinite where it is not known.

    Attributes:
        radius: Largest outer radius.
        thickness: Largest thickness of a web.
    """

    radius: float
    thickness: float


class OpenWeb(NamedTuple):
    """A web with a dimension "fit".

    Attributes:
        path: Dotted name of its table.
        table: Its table.
        throw_m: Crank radius, m.
        cheek: Its cheek, m.
        room: Room for its counterweight.
    """

    path: str
    table: Web
    throw_m: float
    cheek: Cheek
    room: WebRoom

    @classmethod
    def take(cls, path: str, table: Web, throw_m: float, room: WebRoom) -> OpenWeb:
        """Return a web without cheek given; arguments as the attributes."""
        return cls(path, table, throw_m, find_cheek(table, path, throw_m / MM), room)

    @property
    def bare(self) -> complex:
        """Its unbalance without the steel of its counterweight, kg m; nan if the thickness is
        fitted.
        """
        return weigh_bare(self.table, self.cheek)

    def measure_along(self, unbalance: complex) -> float:
        """Return the component of an unbalance along the angle that the table gives."""
        return (unbalance * find_direction(self.table.angle).conjugate()).real

    def thicken(self, thickness_mm: float) -> OpenWeb:
        """Return the web with another thickness."""
        update = {"thickness": thickness_mm}
        return self._replace(table=self.table.model_copy(update=update))


class Weight(NamedTuple):
    """A counterweight: a sector outside the hub, SI units.

    Attributes:
        density: Density.
        thickness: Thickness.
        hub: Inner radius.
        radius: Outer radius.
        opening_deg: Full angle, deg.
    """

    density: float
    thickness: float
    hub: float
    radius: float
    opening_deg: float

    @property
    def per_cube(self) -> float:
        """Unbalance per `R^3 - R_h^3`."""
        sine = math.sin(math.radians(self.opening_deg) / 2)
        return 2 / 3 * self.density * self.thickness * sine

    @property
    def unbalance(self) -> float:
        """Unbalance."""
        return self.per_cube * (self.radius**3 - self.hub**3)

    @property
    def is_there(self) -> bool:
        """Whether the counterweight has any opening, and any height above the hub."""
        return self.opening_deg > 0 and self.radius > self.hub

    def find_radius(self, unbalance: float) -> float:
        """Return the outer radius with which it has another unbalance; infinite without opening."""
        if not self.per_cube:
            return math.inf
        return math.cbrt(self.hub**3 + unbalance / self.per_cube)


class SolvedWeight(NamedTuple):
    """The counterweight of a web for a wanted unbalance.

    Attributes:
        weight: The counterweight.
        angle_deg: Angle of its middle from the crank pin.
        unbalance: Unbalance that it is to have, kg m.
        fits: Whether it has this unbalance; else it is the largest one that fits.
    """

    weight: Weight
    angle_deg: float
    unbalance: float
    fits: bool


def solve_weight(web: OpenWeb, wanted: complex) -> SolvedWeight:
    """Return the counterweight of a web.

    Args:
        web: The web.
        wanted: Unbalance that the web is to have, kg m, in its own axes.

    Raises:
        InputError: No counterweight at the given angle can make this unbalance, however large.
    """
    if web.table.is_open("thickness"):
        return _solve_thickness(web, wanted)
    bare = web.bare
    needed = wanted - bare
    angle_deg, unbalance = _measure_along(web, needed)
    rounding = _ROUNDING * (abs(wanted) + abs(bare))
    if unbalance < -rounding:
        told = (
            f"without a counterweight the web has {_in_g_mm(-unbalance)} more at "
            f"{angle_deg:.6g} deg than is wanted; leave the counterweight or its angle out"
        )
        raise InputError([Problem(f"{web.path}.{web.table.to_fit}", told)])
    if unbalance <= rounding:
        return SolvedWeight(_take_given(web)._replace(opening_deg=0.0), angle_deg, 0.0, fits=True)
    if web.table.is_open("opening"):
        return _solve_opening(web, angle_deg, unbalance)
    return _solve_radius(web, angle_deg, unbalance)


def _measure_along(web: OpenWeb, needed: complex) -> tuple[float, float]:
    """Return angle and size of a counterweight: those of the needed unbalance; at a given angle,
    its component along this angle.
    """
    if not web.table.has("angle"):
        return round(measure_direction(needed), _DEG_DIGITS) % 360, abs(needed)
    return web.table.angle, web.measure_along(needed)


def _take_given(web: OpenWeb) -> Weight:
    """Return the counterweight with the figures of the file; those that are "fit" are nan."""
    table = web.table
    assert table.outer_radius is not None
    assert table.opening is not None
    density = 1e3 * table.density
    radius = MM * table.outer_radius
    return Weight(density, MM * table.thickness, web.cheek.hub, radius, table.opening)


def _solve_opening(web: OpenWeb, angle_deg: float, unbalance: float) -> SolvedWeight:
    widest = min(LARGEST_OPENING_DEG, web.cheek.find_largest_opening(angle_deg))
    largest = _take_given(web)._replace(opening_deg=max(widest, 0.0))
    if unbalance > (1 + _ROUNDING) * largest.unbalance:
        return SolvedWeight(largest, angle_deg, unbalance, fits=False)
    at_most = largest._replace(opening_deg=LARGEST_OPENING_DEG).unbalance
    opening_deg = 2 * math.degrees(math.asin(min(unbalance / at_most, 1.0)))
    weight = largest._replace(opening_deg=min(opening_deg, widest))
    return SolvedWeight(weight, angle_deg, unbalance, fits=True)


def _solve_radius(web: OpenWeb, angle_deg: float, unbalance: float) -> SolvedWeight:
    given = _take_given(web)._replace(radius=web.cheek.hub)
    radius = given.find_radius(unbalance)
    if radius > (1 + _ROUNDING) * web.room.radius:
        largest = given._replace(radius=max(web.room.radius, web.cheek.hub))
        return SolvedWeight(largest, angle_deg, unbalance, fits=False)
    return SolvedWeight(given._replace(radius=radius), angle_deg, unbalance, fits=True)


class _PerMetre(NamedTuple):
    """Unbalance of a web along the angle of its counterweight for one metre of thickness, kg: with
    the counterweight, and without it.
    """

    whole: float
    bare: float

    @classmethod
    def of_web(cls, web: OpenWeb) -> _PerMetre:
        """Return the unbalance of a web whose thickness is fitted."""
        thick = web.thicken(_METRE_MM)
        whole = describe_web(thick.table, web.path, web.throw_m / MM, None).unbalance
        return cls(web.measure_along(whole), web.measure_along(thick.bare))


def measure_thickness(web: OpenWeb, wanted: complex) -> float:
    """Return the thickness (m) of a web that makes the component of an unbalance along the angle of
    its counterweight, whether it fits or not; negative if no thickness makes it.

    Args:
        web: The web, whose thickness is fitted.
        wanted: Unbalance that it is to have, kg m.
    """
    return web.measure_along(wanted) / _PerMetre.of_web(web).whole


def _solve_thickness(web: OpenWeb, wanted: complex) -> SolvedWeight:
    angle = web.table.angle
    whole, bare = _PerMetre.of_web(web)
    size = web.measure_along(wanted)
    if abs(size) <= _ROUNDING * abs(whole) * MM:
        size = 0.0
    if whole <= 0 or size <= 0:
        told = (
            f"the web has {_in_g_mm(whole * MM)} at {angle:.6g} deg for each mm of thickness, and "
            f"{_in_g_mm(size)} are wanted; give a larger outer_radius or opening"
        )
        raise InputError([Problem(f"{web.path}.thickness", told)])
    fits = size / whole <= (1 + _ROUNDING) * web.room.thickness
    thickness = size / whole if fits else max(web.room.thickness, 0.0)
    weight = _take_given(web)._replace(thickness=thickness)
    return SolvedWeight(weight, angle, size - thickness * bare, fits)


def _in_g_mm(unbalance: float) -> str:
    """Return an unbalance (kg m) for a message."""
    return f"{1e6 * unbalance:.6g} g·mm"


# ------------------------------------------------------------------ what helps
def list_cures(web: OpenWeb, largest: Weight, missing: float, pin: PinSize) -> tuple[WebCure, ...]:
    """Return the ways to make what does not fit, each alone.

    Args:
        web: The web.
        largest: The largest counterweight that fits.
        missing: Unbalance that does not fit, kg m.
        pin: Crank pin of its throw.
    """
    return tuple(_make_cures(web, largest, missing, pin))


def _make_cures(web: OpenWeb, largest: Weight, missing: float, pin: PinSize) -> Iterator[WebCure]:
    length = MM * pin.length / 2 + largest.thickness
    bored = missing / (largest.density * length * web.throw_m)
    bore = math.sqrt((MM * pin.bore) ** 2 + 4 / math.pi * bored)
    yield WebCure("pin bore", diameter_m=bore, enough=bore <= MM * pin.diameter / 2)
    yield WebCure("lightening", mass_kg=missing / web.throw_m)
    radius = largest.find_radius(largest.unbalance + missing)
    if math.isinf(radius):
        yield WebCure("outer radius", enough=False)
    else:
        known = math.isfinite(web.room.radius)
        yield WebCure(
            "outer radius", radius_m=radius, enough=radius <= web.room.radius if known else None
        )
    yield _find_slug(largest, missing)


def _find_slug(largest: Weight, missing: float) -> WebCure:
    """Return the smallest slug of tungsten that makes a missing unbalance.

    With `c = R - 3 mm` and `a = (rho_s - rho) t pi/4`, its diameter D is the smallest positive root
    of `a D^2 (c - D/2) = missing`, a cubic equation with three real roots up to `16/27 a c^3`
    (F. Viete; any handbook): `D = 2c/3 (1 + 2 cos((phi - 2 pi)/3))` with
    `cos phi = 1 - 27 missing/(8 a c^3)`.
    """
    density = SLUGS["tungsten"]
    reach = largest.radius - _RIM_M
    per_area = (density - largest.density) * largest.thickness * math.pi / 4
    most = 16 / 27 * per_area * reach**3
    if not largest.is_there or reach <= 0 or missing > most:
        return WebCure("heavy metal", enough=False)
    phi = math.acos(1 - 2 * missing / most)
    diameter = 2 / 3 * reach * (1 + 2 * math.cos((phi - 2 * math.pi) / 3))
    mass = density * largest.thickness * math.pi / 4 * diameter**2
    half_opening = math.radians(min(largest.opening_deg, LARGEST_OPENING_DEG)) / 2
    is_beside = (reach - diameter / 2) * math.sin(half_opening) >= diameter / 2
    enough = reach - diameter >= largest.hub and is_beside
    return WebCure("heavy metal", diameter_m=diameter, mass_kg=mass, enough=enough)
