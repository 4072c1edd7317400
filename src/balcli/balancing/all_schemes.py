"""Compare what every scheme leaves: force, moment and roll, with the parts that it takes.

Each scheme has its default options. A scheme that does not fit the engine, or that needs an option,
is listed with the reason. Comparison of methods as in Wang Yongding, Methods of balancing
single-cylinder engines.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

from ..analysis.answer import Analysis, analyze
from ..core.records import HIDDEN
from ..engine.engine import Engine, check_engine
from ..errors import ArgumentError, BalcliError, name_option, tell
from ..forces.kinds import ROLL
from ..limits import SMALL
from ..show.formats import Renderer, Rows
from ..show.result import Result
from ..show.sheet import (
    NAMELESS,
    UNKNOWN,
    Column,
    Grid,
    Sheet,
    number,
    order_name,
    size_cell,
    size_text,
    unit_cell,
)
from ..show.units import System
from ..sizing.ladder import find_ladder
from ..sizing.options import DESIGNS, LADDER, SCHEMES, SchemeOptions
from ..sizing.remedy import Remedy, fit_devices
from ..sizing.sizing import size
from ..sizing.workshop import Tools, find_practical

AS_DRAWN = "as drawn"
_NO_DEVICE = "it fits no device to this engine"


class SchemeResult(NamedTuple):
    """What a scheme leaves, and what it takes.

    Attributes:
        scheme: Name of the scheme; "as drawn": the engine without new devices.
        design: Design of the scheme eccentric-slider; None for other schemes.
        peak_force_N: Largest free force over a revolution, all orders.
        force_share: This force over that of one cylinder's first order.
        peak_moment_Nm: Largest free moment over a revolution; None if places along the crank are
            not known.
        roll_order: Order of the largest roll; None without a roll.
        roll_Nm: Its amplitude, of inertia.
        parts: Number of new counterweights, eccentrics, sliders or couplings.
        mass_kg: Mass of these parts at their radii.
    """

    scheme: str
    design: str | None
    peak_force_N: float
    force_share: float
    peak_moment_Nm: float | None
    roll_order: float | None
    roll_Nm: float
    parts: int
    mass_kg: float


class Unfit(NamedTuple):
    """A scheme that is left out.

    Attributes:
        scheme: Name of the scheme.
        reason: Reason, as the error of the scheme says it.
    """

    scheme: str
    reason: str


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SchemeComparison(Result):
    """Every scheme with what it leaves.

    Attributes:
        scale_N: Amplitude of one cylinder's first order (mass times radius times squared speed).
        schemes: Engine as drawn, then all schemes that fit it.
        left_out: Schemes that do not fit it.
        engine: The engine.
    """

    format: Literal["balcli.schemes/1"] = "balcli.schemes/1"
    scale_N: float
    schemes: tuple[SchemeResult, ...]
    left_out: tuple[Unfit, ...]
    engine: Annotated[Engine, HIDDEN]

    @property
    def summary(self) -> str:
        """Number of schemes and the engine, in words."""
        return f"{len(self.schemes) - 1} schemes for {self.engine.summary}"


def compare_schemes(engine: Engine) -> SchemeComparison:
    """Return what every scheme leaves of an engine's forces and moments, with default options.

    Args:
        engine: One engine, not an array of variants.

    Raises:
        TypeError: `engine` is not an Engine.

    Example:
        >>> compare_schemes(load_example("single")).schemes[1].force_share
    """
    check_engine("compare_schemes", engine)
    ladder = find_ladder(engine, SMALL)
    scale = ladder.scale.force_N
    rows = [_measure(AS_DRAWN, None, analyze(engine), scale, 0, 0.0)]
    left_out: list[Unfit] = []
    for scheme, design in _list_schemes():
        try:
            if scheme in LADDER:
                remedy = ladder.fit(None)
            else:
                remedy = size(engine, scheme, SchemeOptions(design=design))
        except BalcliError as error:
            reason = error.message if isinstance(error, ArgumentError) else str(error)
            left_out.append(Unfit(scheme, reason))
            continue
        if not remedy.devices and not remedy.beyond:
            left_out.append(Unfit(scheme, remedy.note or _NO_DEVICE))
            continue
        start = engine if remedy.start is None else remedy.start
        parts, mass = _count_parts(start, remedy)
        left = analyze(fit_devices(start, remedy))
        rows.append(_measure(scheme, design, left, scale, parts, mass))
    unique = {unfit.scheme: unfit for unfit in left_out}
    return SchemeComparison(
        scale_N=scale, schemes=tuple(rows), left_out=tuple(unique.values()), engine=engine
    )


def _list_schemes() -> Iterator[tuple[str, str | None]]:
    """Yield each scheme but the rows of the ladder, with its designs. A scheme that needs an option
    is left out by its error.
    """
    for scheme, options in SCHEMES.items():
        if "design" in options:
            yield from ((scheme, design) for design in DESIGNS)
        elif scheme not in LADDER or scheme == "auto":
            yield scheme, None


def _measure(
    scheme: str, design: str | None, left: Analysis, scale: float, parts: int, mass: float
) -> SchemeResult:
    roll = left.spectra[ROLL.name].major
    largest = int(roll.argmax()) if roll.size else 0
    rolls = bool(roll.size and roll[largest] > 0)
    force = left.peak.force.value
    return SchemeResult(
        scheme=scheme,
        design=design,
        peak_force_N=force,
        force_share=force / scale if scale else 0.0,
        peak_moment_Nm=left.peak.moment.value if left.moments_known else None,
        roll_order=float(left.spectra.orders[largest]) if rolls else None,
        roll_Nm=float(roll[largest]) if rolls else 0.0,
        parts=parts,
        mass_kg=mass,
    )


def _count_parts(engine: Engine, remedy: Remedy) -> tuple[int, float]:
    """Return number and mass of a scheme's parts."""
    parts = len(remedy.devices)
    mass = sum(device.mass_kg for device in find_practical(engine, remedy, Tools()))
    if remedy.parts_beyond is not None:
        parts += remedy.parts_beyond.number
        mass += remedy.parts_beyond.mass_kg
    return parts, mass


# ------------------------------------------------------------------ tables
_NOTE = (
    "Force, moment: largest left over a revolution, all orders. Share: of one cylinder's first "
    "order ({scale}). Roll: largest order that inertia leaves. kg: sum of the parts, each at its "
    "radius. A scheme by its name shows more, and has options of its own."
)


def sheet(comparison: SchemeComparison, system: System) -> Sheet:
    """Return the table of schemes, and the schemes left out with their reasons."""
    rows = comparison.schemes
    force = system.force.fit_values(row.peak_force_N for row in rows)
    moment = system.moment.fit_values(row.peak_moment_Nm for row in rows)
    roll = system.moment.fit_values(row.roll_Nm for row in rows)
    heads = [
        Column("scheme", words=True),
        Column(f"force, {force.name}"),
        Column("share"),
        Column(f"moment, {moment.name}"),
        Column(f"roll, {roll.name}"),
        Column("order"),
        Column("parts"),
        Column(system.mass.name),
    ]
    cells = []
    for row in rows:
        left = (
            size_cell(row.peak_force_N, force),
            number(row.force_share, 5),
            size_cell(row.peak_moment_Nm, moment),
            size_cell(row.roll_Nm, roll),
            _tell_order(row),
        )
        mass = unit_cell(row.mass_kg, system.mass, 3)
        cells.append((_name(row), *left, str(row.parts), mass))
    note = _NOTE.format(scale=size_text(comparison.scale_N, system.force))
    parts = [Grid.of_rows("", heads, cells, note)]
    if comparison.left_out:
        reasons = [tell(unfit.reason, name_option) for unfit in comparison.left_out]
        names = Column("scheme", [unfit.scheme for unfit in comparison.left_out], words=True)
        parts.append(Grid("Left out", [names, Column("reason", reasons, words=True)]))
    return Sheet(f"{comparison.engine.name or NAMELESS}: what every scheme leaves", tuple(parts))


def _name(row: SchemeResult) -> str:
    return row.scheme if row.design is None else f"{row.scheme}, design {row.design}"


def _tell_order(row: SchemeResult) -> str:
    return UNKNOWN if row.roll_order is None else order_name(row.roll_order)


def list_rows(comparison: SchemeComparison, _system: System) -> Rows:
    """Return CSV with a line for each scheme, in SI units."""
    return Rows(SchemeResult._fields, comparison.schemes)


RENDERER = Renderer(sheet=sheet, rows=list_rows)
