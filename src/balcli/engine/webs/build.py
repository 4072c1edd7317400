"""Place the webs of a file along its crank, and weigh its crank pins."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, cast

from ...core.cylinders import Device, DeviceKind
from ...core.phasors import Complex, Figure, unit
from ...errors import BalcliError, InputError, Message, Problem
from ...file.model import EngineFile
from ...file.toml import locate_beside
from .bodies import MM, Pin, WebBody, describe_web, weigh_pin
from .dimensions import refuse_impossible, vary_body
from .dxf import Drawing, read_drawing

if TYPE_CHECKING:
    from ...file.gas_tables import Bearing
    from ...file.web_tables import Web
    from ..figures import FileFigures

WEBS_ON_THROW = 2


class CrankWeb(NamedTuple):
    """A web of a crankshaft.

    Attributes:
        number: Its number, from 1 at the free end.
        table: Number of its [[web]] table, from 1.
        throw: Index of its throw, from 0.
        z: Position along the crank, m.
        pin_deg: Direction of its crank pin at crank angle 0, deg.
        body: Mass, unbalance and inertia, in its own axes.
    """

    number: int
    table: int
    throw: int
    z: Figure
    pin_deg: Figure
    body: WebBody

    @property
    def device(self) -> Device:
        """The web as an unbalance on the crank."""
        turning = self.body.unbalance * unit(self.pin_deg)
        return Device(1, turning, 0j, 0j, self.z, DeviceKind.COUNTERWEIGHT, web=self.number)

    @property
    def own_weight(self) -> Device:
        """The counterweight of the web without its cheek. Where the cheek is not known, this is the
        whole web if its centre of mass is opposite the crank pin, else nothing.
        """
        body = self.body
        at_pin = body.at_pin
        if at_pin is None:
            at_pin = 0j if body.unbalance.real < 0 else body.unbalance
        return self.device._replace(forward=(body.unbalance - at_pin) * unit(self.pin_deg))


class Webs(NamedTuple):
    """All webs of a crankshaft, and the pin of each throw."""

    webs: tuple[CrankWeb, ...]
    pins: tuple[Pin, ...]

    @property
    def mass(self) -> float:
        """Mass of webs and pins, kg."""
        return sum(web.body.mass for web in self.webs) + sum(pin.mass for pin in self.pins)

    @property
    def kinds(self) -> dict[int, tuple[CrankWeb, ...]]:
        """Webs of each [[web]] table, by its number."""
        kinds: dict[int, tuple[CrankWeb, ...]] = {}
        for web in self.webs:
            kinds[web.table] = (*kinds.get(web.table, ()), web)
        return dict(sorted(kinds.items()))

    def find_cheeks(self, throw: int) -> float | None:
        """Return the unbalance of the cheeks of a throw (index from 0) towards its crank pin, kg m;
        None if the file gives a web of it without its shape.
        """
        unbalances = [web.body.at_pin for web in self.webs if web.throw == throw]
        known = [unbalance.real for unbalance in unbalances if unbalance is not None]
        return sum(known) if len(known) == len(unbalances) else None

    def find_unbalance(self, throw: int) -> complex | Complex:
        """Return the unbalance of the webs of a throw (index from 0) at crank angle 0, kg m."""
        return sum(web.device.forward for web in self.webs if web.throw == throw)

    def find_nearest(self, z: float) -> CrankWeb:
        """Return the web whose middle is nearest to a position along the crank, m."""
        return min(self.webs, key=lambda web: abs(float(web.z) - z))

    @property
    def inertia(self) -> float | None:
        """Polar inertia of webs and pins about the crank axis, kg m2; None if that of a web is not
        known.
        """
        inertias = [web.body.inertia for web in self.webs]
        of_webs = [inertia for inertia in inertias if inertia is not None]
        if len(of_webs) < len(inertias):
            return None
        return sum(of_webs) + sum(pin.inertia for pin in self.pins)


def assign_tables(model: EngineFile, throws: int) -> dict[int, int]:
    """Return the number of the [[web]] table of each web, by the number of the web.

    Args:
        model: Engine file.
        throws: Number of throws.

    Raises:
        InputError: A web does not exist, or has two tables or none.
    """
    count = WEBS_ON_THROW * throws
    tables: dict[int, int] = {}
    problems = []
    rest = []
    for number, table in enumerate(model.web, 1):
        if table.webs is None:
            rest.append(number)
        for web in table.webs or ():
            if web > count:
                message = f"{web}, but the crank has {count} webs; give numbers from 1 to {count}"
                problems.append(Problem(f"web.{number}.webs", message))
            elif web in tables:
                message = f"web {web} stands in web.{tables[web]} as well; give each web once"
                problems.append(Problem(f"web.{number}.webs", message))
            else:
                tables[web] = number
    if len(rest) > 1:
        message = (
            f"is left out in web.{rest[0]} as well; give the numbers of the webs in all but one"
        )
        problems.append(Problem(f"web.{rest[1]}.webs", message))
    missing = [web for web in range(1, count + 1) if web not in tables]
    if missing and not rest and not problems:
        message = (
            f"no table has web {missing[0]}; the crank has {count} webs: list each in a [[web]]"
        )
        problems.append(Problem("web", message))
    if problems:
        raise InputError(problems)
    if rest:
        tables |= dict.fromkeys(missing, rest[0])
    return dict(sorted(tables.items()))


class BareThrow(NamedTuple):
    """A throw without webs.

    Attributes:
        radius_mm: Crank radius, mm.
        z: Position along the crank, m.
        pin_deg: Direction of its crank pin at crank angle 0, deg.
    """

    radius_mm: float
    z: Figure
    pin_deg: Figure


def build_webs(model: EngineFile, throws: Sequence[BareThrow], figures: FileFigures) -> Webs:
    """Return the webs and pins of a file with [[web]] tables.

    Args:
        model: Engine file.
        throws: Throws of its crank, from the free end.
        figures: Figures of the file. A dimension of all webs of a table may vary
            (`web.1.thickness`), or of a single web (`webs.3.thickness` of web 3).

    Raises:
        InputError: A table has "fit", or the dimensions make no web.
    """
    bearing = take_pin(model)
    tables = assign_tables(model, len(throws))
    drawings = {number: _read_profile(model, number) for number in sorted(set(tables.values()))}
    bodies: dict[tuple[int, float], WebBody] = {}
    webs = []
    pins = []
    for throw, (throw_mm, z, pin_deg) in enumerate(throws):
        for side in range(WEBS_ON_THROW):
            web = WEBS_ON_THROW * throw + side + 1
            number = tables[web]
            key = number, throw_mm
            if key not in bodies:
                table = model.web[number - 1]
                path = f"web.{number}"
                _refuse_fit(table, number)
                bodies[key] = describe_web(table, path, throw_mm, drawings[number])
                refuse_impossible(bodies[key], table, path, figures.of_table(path))
            body = bodies[key]
            of_table = figures.of_table(f"web.{number}")
            if varied := of_table | figures.of_table(f"webs.{web}"):
                body = vary_body(body, model.web[number - 1], varied)
            apart = (MM * bearing.length + body.thickness) / 2
            place = z - apart if side == 0 else z + apart
            webs.append(CrankWeb(web, number, throw, place, pin_deg, body))
        front = tables[WEBS_ON_THROW * throw + 1]
        own = model.web[front - 1].density
        density = cast("float", figures.take(f"web.{front}.density", own))  # or variants of it
        pins.append(weigh_pin(bearing.diameter, bearing.bore, bearing.length, throw_mm, density))
    return Webs(tuple(webs), tuple(pins))


class PinSize(NamedTuple):
    """Diameter, bore and length of the crank pins, mm."""

    diameter: float
    bore: float
    length: float


def take_pin(model: EngineFile) -> PinSize:
    """Return the dimensions of the crank pins.

    Raises:
        InputError: One of them is missing.
    """
    bearing: Bearing | None = model.bearing
    problems = []
    for key, example in (("pin_diameter", 45), ("pin_length", 27)):
        if bearing is None or getattr(bearing, key) is None:
            hint = f"[[web]] needs it; give it, such as {key} = {example}"
            problems.append(Problem.of_missing(f"bearing.{key}", hint))
    if problems or bearing is None or bearing.pin_diameter is None or bearing.pin_length is None:
        raise InputError(problems)
    return PinSize(bearing.pin_diameter, bearing.pin_bore, bearing.pin_length)


def _read_profile(model: EngineFile, number: int) -> Drawing | None:
    """Return the drawing of a table's profile; None if it has none."""
    name = model.web[number - 1].profile
    if name is None:
        return None
    try:
        return read_drawing(locate_beside(model.folder, name))
    except BalcliError as error:
        raise InputError([Problem(f"web.{number}.profile", str(error))]) from None


def _refuse_fit(table: Web, number: int) -> None:
    if key := table.to_fit:
        message = Message(
            '{path} is "fit": run balcli balance FILE {write} OUT, which puts a figure in its '
            "place (fit_webs in Python)",
            path=f"web.{number}.{key}",
        )
        raise InputError([Problem("", message)])
