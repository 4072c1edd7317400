"""Compute the motion of the pistons: strokes, dead centres, mean and largest speed, and
accelerations; exactly, and by the two terms that textbooks use.

Angles named "own" are crank angles of one cylinder: at 0, the crank pin is on the cylinder's axis.
The acceleration towards the crank is a series of cosines (`core.mechanisms.closed_form`), and the
velocity is the integral of this series. The extremes are computed from both series.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Annotated, Literal, NamedTuple

import numpy as np

from ..core.cylinders import find_travel
from ..core.mechanisms.linkage import Articulated
from ..core.mechanisms.slidercrank import fastest_two_term
from ..core.peaks import find_swing
from ..core.phasors import Array, Complex
from ..core.records import HIDDEN, find_unit, list_figures, remove_unit, to_document
from ..engine.build import build
from ..engine.engine import Engine, check_engine, find_row, refuse_geared
from ..engine.load import FiguresOfVariants
from ..file.assumed import DEVICES, Assumed
from ..file.model import EngineFile
from ..forces.quantity import TargetQuantity, refuse_stranger
from ..show.engine_facts import name_cylinders, tell_speed
from ..show.formats import Renderer, Rows
from ..show.result import Result
from ..show.sheet import NAMELESS, UNKNOWN, Column, Facts, Grid, Sheet, assumed_facts, number
from ..show.units import IMPERIAL, INCH, ShownUnit, System, name_with_unit

# Rod ratio lam of a centred slider-crank for which the fourth derivative of the piston travel, by
# crank angle, is 0 at 180 deg: 3 lam^3 - 4 lam + 1 = 0. The acceleration has two minima above it.
TYPE_LIMIT = (math.sqrt(7 / 3) - 1) / 2
_TWO_TERM_LIMIT = 1 / 4
_USUAL = (  # Lu and Meng, Automobile Engine Design, 1990, section 1.1.1.1 and Table 1-5
    "Usual rod ratios of car engines: {:.3f} to {:.3f}; mean speed of high-speed engines: above {} "
    "(Lu and Meng, 1990)."
)
_HIGH_SPEED = 9.0  # mean piston speed above which an engine is a high-speed one, m/s
_SAMPLES = 32  # samples per period of the highest order, to count minima
_TWO_TERM_SAMPLES = 2048  # as above: near the limit, the minima of two terms are close together


@dataclass(frozen=True)
class Velocity:
    """Highest and lowest velocity of a piston, positive towards the crank.

    Attributes:
        max_m_per_s: Highest velocity.
        max_own_deg: Crank angle of the highest velocity.
        min_m_per_s: Lowest velocity.
        min_own_deg: Crank angle of the lowest velocity.
    """

    max_m_per_s: float
    max_own_deg: float
    min_m_per_s: float
    min_own_deg: float


@dataclass(frozen=True)
class Acceleration:
    """Highest and lowest acceleration of a piston, positive towards the crank.

    Attributes:
        max_m_per_s2: Highest acceleration.
        max_own_deg: Crank angle of the highest acceleration.
        min_m_per_s2: Lowest acceleration.
        min_own_deg: Crank angle of the lowest acceleration.
        type: Number of local minima in a revolution.
    """

    max_m_per_s2: float
    max_own_deg: float
    min_m_per_s2: float
    min_own_deg: float
    type: int


@dataclass(frozen=True, kw_only=True)
class TwoTerm:
    """Velocity and acceleration by the first two terms of their series. The velocity at crank angle
    psi is r omega (sin psi + lam/2 sin 2 psi - lam xi cos psi); r: crank radius, omega: crank
    speed, lam: r over the rod length, xi: offset over r.

    Attributes:
        velocity_max_m_per_s: Highest velocity.
        velocity_max_own_deg: Crank angle of the highest velocity.
        velocity_min_m_per_s: Lowest velocity.
        velocity_min_own_deg: Crank angle of the lowest velocity.
        acceleration_max_m_per_s2: Highest acceleration.
        acceleration_max_own_deg: Crank angle of the highest acceleration.
        acceleration_min_m_per_s2: Lowest acceleration.
        acceleration_min_own_deg: Crank angle of the lowest acceleration.
        type: Number of local minima of the acceleration in a revolution.
    """

    velocity_max_m_per_s: float
    velocity_max_own_deg: float
    velocity_min_m_per_s: float
    velocity_min_own_deg: float
    acceleration_max_m_per_s2: float
    acceleration_max_own_deg: float
    acceleration_min_m_per_s2: float
    acceleration_min_own_deg: float
    type: int


@dataclass(frozen=True, kw_only=True)
class PistonMotion:
    """Motion of the pistons of cylinders with equal mechanisms.

    Attributes:
        cylinders: Numbers of the cylinders.
        rod_ratio: Crank radius over rod length; left out for articulated rods and harmonic motion.
        offset_ratio: Offset over crank radius; left out for centred pistons, and where `rod_ratio`
            is.
        stroke_m: True stroke.
        swept_volume_m3: Swept volume of one cylinder; left out without a bore.
        outer_dead_center_own_deg: Crank angle at which the piston is farthest from the crank.
        inner_dead_center_own_deg: Crank angle at which the piston is nearest to the crank.
        inward_stroke_deg: Crank angle from the outer to the inner dead centre.
        outward_stroke_deg: Crank angle from the inner to the outer dead centre.
        mean_speed_m_per_s: Mean piston speed.
        velocity: Highest and lowest velocity.
        acceleration: Highest and lowest acceleration.
        two_term: Velocity and acceleration by two terms; only for slider-cranks.
    """

    cylinders: tuple[int, ...]
    rod_ratio: float | None = None
    offset_ratio: float | None = None
    stroke_m: float
    swept_volume_m3: float | None = None
    outer_dead_center_own_deg: float
    inner_dead_center_own_deg: float
    inward_stroke_deg: float
    outward_stroke_deg: float
    mean_speed_m_per_s: float
    velocity: Velocity
    acceleration: Acceleration
    two_term: TwoTerm | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Pistons(Result):
    """Motion of all pistons of an engine.

    Attributes:
        format: Name and version of the document.
        speed_rpm: Crank speed, assumed to be steady.
        type_limit_rod_ratio: Rod ratio above which the acceleration of a centred piston has two
            minima.
        swept_volume_m3: Swept volume of the engine; left out without a bore.
        assumed: Values that are used because the engine file leaves them out.
        mechanisms: Motion of each distinct mechanism.
        engine: Analyzed engine.
    """

    format: Literal["balcli.piston/1"] = "balcli.piston/1"
    speed_rpm: float
    type_limit_rod_ratio: float = TYPE_LIMIT
    swept_volume_m3: float | None = None
    assumed: tuple[Assumed, ...] | None = None
    mechanisms: tuple[PistonMotion, ...]
    engine: Annotated[Engine, HIDDEN]

    @property
    def summary(self) -> str:
        """Name of the engine, in words."""
        return f"of {self.engine.name or 'an engine'}"


def piston(engine: Engine) -> Pistons:
    """Return the motion of the pistons of an engine at its mean speed.

    Args:
        engine: Engine from `load`.

    Raises:
        TypeError: `engine` is not an Engine.

    Example:
        >>> piston(load("i4.toml")).mechanisms[0].velocity.max_m_per_s
    """
    engine = check_engine("piston", engine)
    refuse_geared(engine)
    c = engine.cylinders
    numbers = np.array(engine.numbers)
    orders = np.arange(1.0, max(c.find_highest_order(), 2) + 1)
    harmonics, which = c.find_distinct_harmonics(orders, {"piston"})
    omega = float(engine.omega)
    travel = find_travel(c)
    bore = float(engine.bore_m)
    kinds = np.broadcast_to(which, len(numbers)) + 1j * c.radius_of_each  # mechanism and size
    mechanisms = []
    for kind in dict.fromkeys(kinds[np.argsort(numbers)].tolist()):
        rows = np.flatnonzero(kinds == kind)
        radius = kind.imag
        first = rows[0]
        stroke, top, bottom = (float(v[first]) for v in travel)
        inward = (bottom + 180 - top) % 360
        hung = isinstance(c.linkage, Articulated) and bool(c.linkage.master[first] != first)
        lam = float(np.broadcast_to(c.lam, len(numbers))[first])
        eps = float(np.broadcast_to(c.eps, len(numbers))[first])
        xi = eps / lam if lam else 0.0
        slides = c.linkage is None and lam
        series = np.asarray(harmonics["piston"].c[:, int(kind.real)], complex)
        velocity = _find_extremes(orders, series / (1j * orders), radius * omega)
        mechanisms.append(
            PistonMotion(
                cylinders=tuple(sorted(numbers[rows].tolist())),
                rod_ratio=None if hung or not lam else lam,
                offset_ratio=None if hung or not xi else xi,
                stroke_m=stroke,
                swept_volume_m3=math.pi / 4 * bore**2 * stroke if bore > 0 else None,
                outer_dead_center_own_deg=(top + 180) % 360 - 180,
                inner_dead_center_own_deg=(bottom + 180) % 360,
                inward_stroke_deg=inward,
                outward_stroke_deg=360 - inward,
                mean_speed_m_per_s=stroke * omega / math.pi,
                velocity=Velocity(*velocity),
                acceleration=_find_acceleration(orders, series, radius * omega**2),
                two_term=_use_two_terms(lam, xi, radius, omega) if slides else None,
            )
        )
    return Pistons(
        speed_rpm=float(engine.speed_rpm),
        swept_volume_m3=float(engine.displacement_m3) if bore > 0 else None,
        assumed=engine.list_assumed(without=DEVICES),
        mechanisms=tuple(mechanisms),
        engine=engine,
    )


def choose_cylinder(result: Pistons, number: int) -> Pistons:
    """Return the motion of one cylinder.

    Args:
        result: Motion of all pistons.
        number: Number of the cylinder.

    Raises:
        BalcliError: The engine has no such cylinder.
    """
    find_row(result.engine, number)
    chosen = []
    for motion in result.mechanisms:
        if number in motion.cylinders:
            chosen.append(replace(motion, cylinders=(number,)))
    return replace(result, mechanisms=tuple(chosen))


def _find_acceleration(
    orders: Array, series: Complex, scale: float, samples: int = _SAMPLES
) -> Acceleration:
    """Return the extremes of the acceleration from its phasors by order."""
    angles = np.linspace(0, 2 * np.pi, samples * len(orders), endpoint=False)
    jerk = (np.exp(1j * np.outer(angles, orders)) @ (1j * orders * series)).real
    turns = (jerk <= 0) & (np.roll(jerk, -1) > 0)
    return Acceleration(*_find_extremes(orders, series, scale), int(np.count_nonzero(turns)))


def _find_extremes(
    orders: Array, series: Complex, scale: float
) -> tuple[float, float, float, float]:
    """Return value (times `scale`) and crank angle (0 to 360 deg) of maximum, then of minimum."""
    high, low = (
        (scale * float(peak.value), math.degrees(float(peak.angle)) % 360)
        for peak in find_swing(orders, series)
    )
    return *high, *low


def _use_two_terms(lam: float, xi: float, radius: float, omega: float) -> TwoTerm:
    """Return velocity and acceleration of a slider-crank by their first two terms.

    The acceleration in units of r omega^2 is `cos psi + lam xi sin psi + lam cos 2 psi`.

    Source: Lu and Meng, Automobile Engine Design, 1990, (1-11); the term with the offset follows
    from the travel `1 - cos psi + lam/2 (sin psi - xi)^2`.
    """
    if xi:
        orders = np.array([1.0, 2.0])
        series = np.array([1 - 1j * lam * xi, lam])
        velocity = Velocity(*_find_extremes(orders, series / (1j * orders), radius * omega))
        scale = radius * omega**2
        acceleration = _find_acceleration(orders, series, scale, _TWO_TERM_SAMPLES)
    else:
        velocity = _find_centred_velocity(lam, radius * omega)
        acceleration = _find_centred_acceleration(lam, radius * omega**2)
    return TwoTerm(
        velocity_max_m_per_s=velocity.max_m_per_s,
        velocity_max_own_deg=velocity.max_own_deg,
        velocity_min_m_per_s=velocity.min_m_per_s,
        velocity_min_own_deg=velocity.min_own_deg,
        acceleration_max_m_per_s2=acceleration.max_m_per_s2,
        acceleration_max_own_deg=acceleration.max_own_deg,
        acceleration_min_m_per_s2=acceleration.min_m_per_s2,
        acceleration_min_own_deg=acceleration.min_own_deg,
        type=acceleration.type,
    )


def _find_centred_velocity(lam: float, scale: float) -> Velocity:
    """Return the extremes of the two-term velocity without an offset."""
    angle, value = fastest_two_term(lam)
    highest = scale * float(value)
    highest_deg = math.degrees(float(angle))
    return Velocity(highest, highest_deg, -highest, 360 - highest_deg)


def _find_centred_acceleration(lam: float, scale: float) -> Acceleration:
    """Return the extremes of the two-term acceleration without an offset. The minimum is at `cos
    psi = -1/(4 lam)` if there is such an angle psi, otherwise at 180 deg.
    """
    if lam > _TWO_TERM_LIMIT:
        lowest = lam + 1 / (8 * lam)
        lowest_deg = math.degrees(math.acos(-1 / (4 * lam)))
        minima = 2
    else:
        lowest = 1 - lam
        lowest_deg = 180.0
        minima = 1
    return Acceleration(scale * (1 + lam), 0.0, -scale * lowest, lowest_deg, minima)


# ------------------------------------------------------------------ quantities of variants
_PARTS = ("mean_speed", "max_speed", "max_acceleration", "stroke")


def list_names(model: EngineFile) -> Iterator[str]:
    """Yield names of the quantities of piston 1, and name patterns for the other pistons."""
    if model.engine:
        return
    for stem in ("piston", "piston.N"):
        for part in _PARTS:
            yield f"{stem}.{part}"


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Raise BalcliError if a quantity names a cylinder that the engine does not have."""
    refuse_geared(model)
    cylinders = list(map(str, sorted(build(model).numbers)))
    for quantity in quantities:
        if quantity.target:
            refuse_stranger(quantity, cylinders)


def evaluate_engine(engine: Engine, quantities: Sequence[TargetQuantity]) -> list[float]:
    """Return the value of each quantity of one engine in SI units."""
    of_cylinder: dict[int, PistonMotion] = {}
    for motion in piston(engine).mechanisms:
        of_cylinder |= dict.fromkeys(motion.cylinders, motion)
    return [_read_quantity(of_cylinder[int(q.target or 1)], q.part) for q in quantities]


def _read_quantity(motion: PistonMotion, part: str) -> float:
    match part:
        case "mean_speed":
            return motion.mean_speed_m_per_s
        case "max_speed":
            return max(motion.velocity.max_m_per_s, -motion.velocity.min_m_per_s)
        case "max_acceleration":
            return motion.acceleration.max_m_per_s2
        case _:
            return motion.stroke_m


class _FigureColumn(NamedTuple):
    """A column of the table of figures: its heading, and the cells by the names of the figures."""

    head: str
    cells: dict[str, str]


Variants = partial(FiguresOfVariants, evaluate_engine)


# ------------------------------------------------------------------ how it is shown
def sheet(result: Pistons, system: System) -> Sheet:
    """Return a table with a row for each figure. Each mechanism has a column of exact figures and,
    if they are known, a column of two-term figures.

    Args:
        result: Motion of the pistons.
        system: System of units.
    """
    columns = []
    notes = []
    for motion in result.mechanisms:
        exact = _write_figures(motion, system)
        columns.append(_FigureColumn(name_cylinders(motion.cylinders), exact))
        if motion.two_term is not None:
            two_term = _write_two_term(motion.two_term, exact, system)
            columns.append(_FigureColumn("two-term", two_term))
            if motion.offset_ratio is None and motion.two_term.type != motion.acceleration.type:
                notes.append(
                    f"The acceleration has two minima above a rod ratio of {TYPE_LIMIT:.4f}; by the"
                    f" two-term formula, above {_TWO_TERM_LIMIT}."
                )
    names = dict.fromkeys(name for column in columns for name in column.cells)
    table = [Column("", [_label(name, system) for name in names], words=True)]
    for column in columns:
        table.append(Column(column.head, [column.cells.get(name, "") for name in names]))
    facts = Facts((("speed", tell_speed(result.engine, steady=True)),))
    speed = choose_unit("mean_speed_m_per_s", system)
    high_speed = f"{number(speed.of(_HIGH_SPEED))} {speed.name}"
    notes.append(_USUAL.format(1 / 3.8, 1 / 3.2, high_speed))
    grid = Grid("Piston motion", table, " ".join(dict.fromkeys(notes)))
    return Sheet(result.engine.name or NAMELESS, (facts, *assumed_facts(result.assumed), grid))


def _write_figures(motion: PistonMotion, system: System) -> dict[str, str]:
    """Return the exact figures of a mechanism as text, by their names."""
    cells = {}
    for name, value, _ in list_figures(to_document(motion), ("cylinders", "two_term")):
        cells[name] = UNKNOWN if value is None else _write(name, float(value), system)
    return cells


def _write_two_term(motion: TwoTerm, exact: Iterable[str], system: System) -> dict[str, str]:
    """Return two-term figures as text, by the names of the exact figures beside which they
    stand.
    """
    figures = to_document(motion)
    figures["acceleration_type"] = figures.pop("type")
    cells = {}
    for name in exact:
        key = name.replace(".", "_")
        if key in figures:
            cells[name] = _write(name, figures[key], system)
    return cells


def choose_unit(name: str, system: System) -> ShownUnit:
    """Return the unit in which a figure is printed, from its dotted name."""
    unit = find_unit(name)
    shown = {"m": system.length, "m³": system.volume}
    if system is IMPERIAL:
        shown |= {"m/s": ShownUnit("ft/s", 12 * INCH), "m/s²": ShownUnit("ft/s²", 12 * INCH)}
    return shown.get(unit, ShownUnit(unit, 1))


def _write(name: str, value: float, system: System) -> str:
    return number(choose_unit(name, system).of(value))


def _label(name: str, system: System) -> str:
    """Return the label of a figure, with its unit."""
    plain = remove_unit(name).removesuffix("_own").replace("center", "centre")
    plain = plain.replace("type", "minima").replace(".", " ").replace("_", " ")
    return name_with_unit(plain, choose_unit(name, system).name)


def rows(result: Pistons, system: System) -> Rows:
    """Return the rows of CSV in SI units: a line for each figure, with the cylinder numbers in the
    first column.
    """
    del system
    lines = [
        (" ".join(map(str, each.cylinders)), name, value, unit)
        for each in result.mechanisms
        for name, value, unit in list_figures(to_document(each), ("cylinders",))
    ]
    return Rows(("cylinders", "figure", "value", "unit"), lines)


RENDERER = Renderer(sheet=sheet, rows=rows)
