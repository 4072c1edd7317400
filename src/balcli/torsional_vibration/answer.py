"""Analyze torsional vibration: `torsion`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import NoneType
from typing import Annotated, Literal, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike

from ..core.phases import RPM
from ..core.phasors import Array
from ..core.records import HIDDEN, Asked, change_attributes
from ..core.vibration import Indices, Real
from ..engine.engine import CylinderNumber, Engine, take_model
from ..engine.load import build_tables
from ..errors import Argument, ArgumentError, check_type
from ..file.assumed import Assumed
from ..file.doubt import Doubt
from ..file.fields import counted, order_number, printable
from ..file.plain_tables import take_tables
from ..file.units import SPEED, convert
from ..limits import HIGHEST_TORSION_ORDER
from ..process import Tell, tell_nobody
from ..shell.arguments import check_inertia, check_speeds, check_torsion_orders
from ..shell.options import read_orders
from ..shell.values import parse_speeds, read_inertia
from ..show.formats import Units
from ..show.result import Result
from .build import NO_DAMPERS
from .chain_file import describes_chain, read_chain_tables
from .dampers import FIGURES, WIDE_SWING, DamperAsked, SizedDamper, size_damper
from .load import Source, make_chain_source, make_source
from .measured import MeasuredCurve, compare_measured
from .misfire import ALL_FIRE, WORST, MisfireAsked, ask_misfire
from .modes import (
    Critical,
    NaturalMode,
    OutsideCritical,
    find_chain_modes,
    find_criticals,
    find_criticals_outside,
    find_natural_modes,
    tabulate_holzer,
)
from .response import TorsionResponse, find_response
from .system import TorsionalSystem
from .throw_stiffness import ThrowStiffness, Used
from .verdicts import Judgment, LimitVerdict, judge_system
from .worst_misfire import WorstMisfire, find_worst_misfire

BEYOND = 1.5  # criticals up to this multiple of the file's speed are listed: engines overspeed
BREAKING = 1000e6  # vibratory stress above which a warning is given, Pa: no steel bears it
ASTOUNDING = 45.0  # half swing above which a warning is given, deg; a few degrees are usual
_MOST_NAMED = 4  # largest number of shafts that a warning names
_ASTRAY = 1e-3  # a Holzer table whose angles differ more from the mode's is mostly rounding error


class HolzerAsked(NamedTuple):
    """Request for a Holzer table: at the frequency of a mode or, if `mode` is None, at `omega`
    (rad/s).
    """

    mode: int | None
    omega: float = 0.0


class TorsionQuestion(NamedTuple):
    """Request for an analysis of torsional vibration.

    Attributes:
        speeds_rpm: Rising speeds of the response, shape (speeds,); None: no response.
        holzer: Requested Holzer tables.
        damper: Damper to size; the results include it.
    """

    speeds_rpm: Real | None = None
    holzer: Sequence[HolzerAsked] = ()
    damper: DamperAsked = DamperAsked()


class ChainNode(NamedTuple):
    """One inertia of the chain.

    Attributes:
        name: Name of the node.
        inertia_kg_m2: Moment of inertia.
        gear: Speed divided by that of the crankshaft or, in a chain file, of the first node.
    """

    name: str
    inertia_kg_m2: float
    gear: float


class ChainJoint(NamedTuple):
    """Shaft between two nodes.

    Attributes:
        name: Name of the shaft.
        stiffness_Nm_per_rad: Torsional stiffness; null if the shaft is rigid.
    """

    name: str
    stiffness_Nm_per_rad: float


class HolzerRow(NamedTuple):
    """One inertia of Holzer's table.

    Attributes:
        node: Name of the node.
        inertia_kg_m2: Moment of inertia.
        angle: Angle of the node divided by the angle of the first node.
        torque_Nm: Torque of the node's inertia if the first node swings by 1 rad.
        sum_Nm: Torque of all inertias up to this node, carried by the shaft to the next node.
        stiffness_Nm_per_rad: Stiffness of the shaft to the next node; null if this shaft is rigid,
            0 at the last node.
        twist: Twist of the shaft to the next node divided by the angle of the first node.
    """

    node: str
    inertia_kg_m2: float
    angle: float
    torque_Nm: float
    sum_Nm: float
    stiffness_Nm_per_rad: float
    twist: float


@dataclass(frozen=True, kw_only=True)
class HolzerTable:
    """Holzer's table.

    Attributes:
        mode: Number of the mode; left out for a trial frequency.
        frequency_Hz: Frequency.
        rows: One row for each node.
        residual_Nm: Torque that is left at the last node.
        end: Node at which the table ends.
    """

    mode: int | None = None
    frequency_Hz: float
    rows: tuple[HolzerRow, ...]
    residual_Nm: float
    end: Annotated[int, HIDDEN]


@dataclass(frozen=True, kw_only=True)
class ThrowFormulas:
    """Stiffness of the throws by two formulas.

    Attributes:
        ker_wilson_Nm_per_rad: By Ker Wilson; left out if journal and pin overlap.
        carter_Nm_per_rad: By Carter.
        used_Nm_per_rad: Used stiffness; left out if the file gives several.
        used: Where the used stiffness comes from.
        spread: Difference of the formulas over their mean; left out if journal and pin overlap.
        ker_wilson_mode_1_Hz: Frequency of the first mode with Ker Wilson's stiffness in all throws;
            left out if journal and pin overlap.
        carter_mode_1_Hz: Frequency of the first mode with Carter's stiffness.
    """

    ker_wilson_Nm_per_rad: float | None = None
    carter_Nm_per_rad: float
    used_Nm_per_rad: float | None = None
    used: Used
    spread: float | None = None
    ker_wilson_mode_1_Hz: float | None = None
    carter_mode_1_Hz: float


_LIMITED = "speeds=[1500, 2000], and a limit in the file"
_EXCITED = "[gas] in the engine file, or [[excitation]] in the chain file"


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class TorsionAnalysis(Result):
    """Torsional vibration of a chain of inertias and shafts.

    Attributes:
        format: Name and version of the document.
        name: Name of the engine or chain; null if the file gives none.
        no_gas_in: Cylinders without gas; left out if there are none.
        no_burning_in: Cylinders that compress but do not burn; left out if there are none.
        assumed: Values assumed because the file leaves them out.
        nodes: Inertias, front to rear.
        shafts: Shafts.
        modes: Modes in which shafts twist, lowest first.
        orders: Orders of the excitation that were used; left out without an excitation.
        criticals: Critical speeds in the range of speeds, sorted by falling work. Without a range,
            they are listed up to one and a half times the file's speed, or all of them if the file
            gives no speed. Left out without an excitation.
        criticals_outside: Critical speeds in the 20 % below and above the range of speeds, by
            rising speed; left out without speeds.
        holzer: Holzer's tables; left out if none was requested.
        response: Forced vibration; left out without speeds.
        damper: Sized damper, included in the other results; left out if none was requested.
        misfire: Misfires of all cylinders, one at a time; the other results are those of the worst
            one. Left out unless the worst one was requested.
        limits: Verdict on each limit of a shaft, and the shafts that are not checked; left out
            without a limit or without speeds.
        barred_rpm: First and last speed of each range in which a limit is exceeded; left out
            without a limit or without speeds.
        measured: Measured curve of the free end beside the computed one; left out if the file names
            none.
        throw: Stiffness of the throws from their dimensions; left out without dimensions.
        system: Analyzed system.
    """

    format: Literal["balcli.torsion/1"] = "balcli.torsion/1"
    name: str | None
    no_gas_in: tuple[CylinderNumber, ...] | None = None
    no_burning_in: tuple[CylinderNumber, ...] | None = None
    assumed: tuple[Assumed, ...] | None = None
    nodes: tuple[ChainNode, ...]
    shafts: tuple[ChainJoint, ...]
    modes: tuple[NaturalMode, ...]
    orders: Asked[tuple[float, ...]] = Asked(_EXCITED)
    criticals: Asked[tuple[Critical, ...]] = Asked(_EXCITED)
    criticals_outside: Asked[tuple[OutsideCritical, ...]] = Asked("speeds=[1500, 2000]")
    holzer: tuple[HolzerTable, ...] | None = None
    response: Asked[TorsionResponse] = Asked("speeds=[1500, 2000]")
    damper: Asked[SizedDamper] = Asked('damper="viscous", speeds=[1500, 2000]')
    misfire: Asked[WorstMisfire] = Asked('misfire="worst", speeds=[1500, 2000]')
    limits: Asked[tuple[LimitVerdict, ...]] = Asked(_LIMITED)
    barred_rpm: Asked[tuple[tuple[float, float], ...]] = Asked(_LIMITED)
    measured: MeasuredCurve | None = None
    throw: ThrowFormulas | None = None
    system: Annotated[TorsionalSystem, HIDDEN]

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Warnings of shafts whose inertia is left out, of formulas that differ much, of speeds for
        which the file describes no gas, of swings that are too large for the linear model, and of a
        stress that breaks a shaft.
        """
        throw = self.system.throw
        of_system = *self.system.doubts, *(() if throw is None else throw.list_doubts())
        if not hasattr(self, "response"):
            return of_system
        excitation = self.system.excitation
        of_response = _find_doubts(self.response)
        law = excitation and excitation.gas and excitation.gas.law
        of_gas = law.list_doubts(self.response.speeds_rpm) if law else ()
        of_limits = _doubt_limits(self.system, self.response.speeds_rpm)
        return *of_system, *of_gas, *of_response, *of_limits

    @property
    def summary(self) -> str:
        """Name, and the natural frequencies."""
        modes = ", ".join(f"{mode.frequency_Hz:.4g}" for mode in self.modes[:6])
        return f"of {self.name or 'a chain'}: modes at {modes} Hz"


def _doubt_limits(system: TorsionalSystem, rpm: Real) -> Iterator[Doubt]:
    """Yield warnings of limits that do not cover the range of speeds, each once for all shafts."""
    named: dict[tuple[str, str], list[str]] = {}
    for limit in system.limits:
        word = "torque limit" if limit.kind == "torque" else "limit"
        for text in limit.limit.list_doubts(float(rpm[0]), float(rpm[-1])):
            shafts = named.setdefault((word, text), [])
            shafts.append(printable(system.shafts[limit.column]))
    for (word, text), shafts in named.items():
        if len(shafts) > _MOST_NAMED:
            shafts[_MOST_NAMED:] = ["..."]
        yield Doubt("", f"{word} of {', '.join(shafts)}: {text}")


def _find_doubts(response: TorsionResponse) -> Iterator[Doubt]:
    """Yield warnings of swings and stresses that are too large."""
    for pendulum in response.pendulums or ():
        wide = pendulum.worst.half_swing_deg
        if wide > WIDE_SWING:
            message = (
                f"the pendulums of {printable(pendulum.node)} swing by {wide:.3g} deg at "
                f"{pendulum.worst.speed_rpm:.4g} rpm, but the computation assumes small swings; "
                f"{wide / WIDE_SWING:.3g} times their mass would limit the swing to about "
                f"{WIDE_SWING:.0f} deg"
            )
            yield Doubt("", message)
    hardest = max(response.shafts, key=lambda each: each.worst.stress_Pa or 0.0, default=None)
    if hardest is not None and (stress := hardest.worst.stress_Pa or 0.0) > BREAKING:
        message = (
            f"{printable(hardest.name)} has {stress / 1e6:.4g} N/mm² at "
            f"{hardest.worst.speed_rpm:.5g} rpm, more than any steel bears; check the damping "
            "(loss, damping) of all shafts and nodes"
        )
        yield Doubt("", message)
    swing = response.free_end_worst
    if swing.half_swing_deg > ASTOUNDING:
        message = (
            f"the free end swings by {swing.half_swing_deg:.4g} deg at {swing.speed_rpm:.5g} rpm, "
            "but the computation assumes small swings; is an inertia or the damping missing, or "
            "the speed too low?"
        )
        yield Doubt("", message)


def answer_question(
    source: Source, question: TorsionQuestion, tell: Tell = tell_nobody
) -> TorsionAnalysis:
    """Return the analysis of a chain or an engine. Size the requested damper first, or find the
    worst misfire.

    Args:
        source: File of the chain or engine.
        question: Request.
        tell: Function that is called with the share of the work done so far.

    Raises:
        BalcliError: The node or inertia of a damper is given without its kind; a damper or the
            worst misfire without speeds, or both together; a response lacks excitation or passes an
            undamped resonance; a requested mode does not exist; a Holzer table is requested for a
            chain with loops; no node can carry the damper.
        InputError: The file contradicts itself.
    """
    kind, node, inertia = question.damper
    if source.misfire.worst:
        return _answer_worst_misfire(source, question, tell)
    if kind is None:
        if node is not None or inertia is not None:
            needless = Argument("damper_inertia" if node is None else "damper_at")
            raise ArgumentError(
                "{needless}: give the kind of damper, with {damper}", needless=needless
            )
        result = _analyze_system(source.system(NO_DAMPERS), question, tell)
        return _add_measured(result, source)
    if question.speeds_rpm is None:
        raise ArgumentError("{damper}: give the speeds over which to size it, with {speeds}")
    sized = size_damper(source, question.damper, question.speeds_rpm, tell)
    fitted = source.system({sized.node: sized.damper})
    fitted_result = _analyze_system(fitted, question)  # one more response: no progress is reported
    for each in fitted_result.response.dampers or ():
        if each.node == sized.node:
            sized = replace(sized, heat_W=each.worst.heat_W, heat_rpm=each.worst.speed_rpm)
    return _add_measured(change_attributes(fitted_result, damper=sized), source)


def _add_measured(result: TorsionAnalysis, source: Source) -> TorsionAnalysis:
    """Return a result with the measured curve beside the computed one, if the file names one."""
    if source.measured is None:
        return result
    return change_attributes(result, measured=compare_measured(result.system, source.measured))


def _answer_worst_misfire(source: Source, question: TorsionQuestion, tell: Tell) -> TorsionAnalysis:
    """Return the analysis of an engine in which the worst cylinder does not fire."""
    if question.damper.kind is not None:
        raise ArgumentError(
            "{damper}: size it for one cylinder that does not fire, such as {misfire} 1, not for "
            "{misfire} worst"
        )
    if question.speeds_rpm is None or source.without is None:
        raise ArgumentError("{misfire} worst: give the speeds over which to compare, with {speeds}")
    misfire = find_worst_misfire(source, question.speeds_rpm, tell)
    silent = source.without(misfire.worst, source.misfire.compressing)
    silent = silent._replace(misfire=ALL_FIRE)
    return change_attributes(answer_question(silent, question), misfire=misfire)


def _analyze_system(
    system: TorsionalSystem, question: TorsionQuestion, tell: Tell = tell_nobody
) -> TorsionAnalysis:
    """Return the analysis of a system without sizing a damper."""
    speeds = question.speeds_rpm
    modes = find_natural_modes(system)
    chain = system.chain
    excitation = system.excitation
    span = (0.0, BEYOND * system.rated_rpm) if system.rated_rpm else None
    outside = None
    response = None
    judgment = Judgment(None, None)
    if speeds is not None:
        span = float(speeds[0]), float(speeds[-1])
        response = find_response(system, speeds, tell)
        judgment = judge_system(system, speeds)
        outside = find_criticals_outside(system, modes, span)
    return TorsionAnalysis(
        name=system.name or None,
        no_gas_in=system.silent.without_gas or None,
        no_burning_in=system.silent.without_burning or None,
        assumed=system.assumed or None,
        nodes=tuple(map(ChainNode, system.nodes, chain.inertia.tolist(), system.gears.tolist())),
        shafts=tuple(map(ChainJoint, system.shafts, chain.stiffness.tolist())),
        modes=modes,
        orders=None if excitation is None else tuple(map(order_number, excitation.orders.tolist())),
        criticals=None if excitation is None else find_criticals(system, modes, span),
        criticals_outside=outside,
        holzer=tuple(tabulate_chain(system, modes, asked) for asked in question.holzer) or None,
        response=response,
        limits=judgment.verdicts,
        barred_rpm=judgment.barred_rpm,
        throw=None if system.throw is None else _compare_formulas(system, system.throw),
        system=system,
    )


def _compare_formulas(system: TorsionalSystem, throw: ThrowStiffness) -> ThrowFormulas:
    """Return the stiffness of the throws by both formulas, and the first mode with each."""
    first = _find_first_mode(system, throw.shafts, throw.carter)
    formulas = ThrowFormulas(
        carter_Nm_per_rad=throw.carter,
        used_Nm_per_rad=throw.used,
        used=throw.source,
        carter_mode_1_Hz=first,
    )
    if throw.ker_wilson is None:
        return formulas
    return replace(
        formulas,
        ker_wilson_Nm_per_rad=throw.ker_wilson,
        spread=throw.spread,
        ker_wilson_mode_1_Hz=_find_first_mode(system, throw.shafts, throw.ker_wilson),
    )


def _find_first_mode(system: TorsionalSystem, shafts: Indices, stiffness: float) -> float:
    """Return the frequency of the first mode, Hz, if these shafts have this stiffness, N m/rad."""
    stiff = system.chain.stiffness.copy()
    stiff[shafts] = stiffness
    modes = find_chain_modes(system.chain._replace(stiffness=stiff))
    return float(modes.omega[modes.rigid]) / (2 * np.pi)


def tabulate_chain(
    system: TorsionalSystem, modes: tuple[NaturalMode, ...], asked: HolzerAsked
) -> HolzerTable:
    """Return Holzer's table at a frequency."""
    omega = asked.omega
    chain = system.chain
    shape = None
    if asked.mode is not None:
        if asked.mode > len(modes):
            count = counted(len(modes), "mode")
            raise ArgumentError(
                "has {count}, but {holzer} asks for mode {mode}", count=count, mode=asked.mode
            ).within(system.file)
        omega = modes[asked.mode - 1].omega
        shape = modes[asked.mode - 1].shape
    # Holzer's table begins with an angle of 1 at a free end; a clamped end comes last
    first, end = system.ends[::-1] if chain.clamped[0] else system.ends
    try:
        table = tabulate_holzer(chain, omega, first, end)
    except ValueError as error:
        raise ArgumentError("{holzer}: {error}", error=str(error)).within(system.file) from None
    if shape is not None and np.abs(table.angle * shape[first] - shape).max() > _ASTRAY:
        raise ArgumentError(
            "{holzer}: mode {mode} cannot be followed from {node}: this node hardly moves in the "
            "mode, or a branch swings by itself",
            mode=asked.mode,
            node=system.nodes[first],
        ).within(system.file)
    rows = []
    for k, node in enumerate(system.nodes):
        row = HolzerRow(
            node=node,
            inertia_kg_m2=float(chain.inertia[k]),
            angle=float(table.angle[k]),
            torque_Nm=float(table.torque[k]),
            sum_Nm=float(table.total[k]),
            stiffness_Nm_per_rad=float(table.stiffness[k]),
            twist=float(table.twist[k]),
        )
        rows.append(row)
    return HolzerTable(
        mode=asked.mode,
        frequency_Hz=omega / (2 * np.pi),
        rows=tuple(rows),
        residual_Nm=table.residual,
        end=end,
    )


# ------------------------------------------------------------------ options of the command


def parse_half_orders(text: str | None) -> Real | None:
    """Return the orders in a text: `0.5-8` in steps of a half, `1-8` in whole steps, or `1,2.5,4`.

    Raises:
        BalcliError: The text has another form.
    """
    if text is None:
        return None
    right = "give multiples of 0.5 such as 0.5-8 (with halves), 1-8 (whole orders) or 1,2.5,4"
    bounds = f"must rise, from above 0 to {HIGHEST_TORSION_ORDER} at most"
    found = read_orders(text, right, bounds, 0.5, HIGHEST_TORSION_ORDER)
    return np.array(sorted(set(found)), float)


def _parse_trial(text: str) -> HolzerAsked:
    """Return the number of a mode, or a trial frequency such as `20 rad/s`, `12 Hz` or `900 rpm`.

    Raises:
        BalcliError: The text has another form.
    """
    if re.fullmatch(r"[1-9]\d{0,5}", text.strip()):
        return HolzerAsked(int(text))
    right = 'give the number of a mode, or a frequency such as "20 rad/s", "12 Hz" or "900 rpm"'
    try:
        omega = convert(text, SPEED) * RPM
    except ValueError:
        omega = 0.0
    if not 0 < omega < 1e12:
        raise ArgumentError('{holzer} "{text}": {right}', text=text[:60], right=right)
    return HolzerAsked(None, omega)


def parse_question(
    speeds: str | None,
    holzer: Sequence[str] = (),
    damper: str | None = None,
    damper_at: str | None = None,
    damper_inertia: str | None = None,
    units: Units = Units.SI,
) -> TorsionQuestion:
    """Return the request that these options make.

    Raises:
        BalcliError: An option cannot be read.
    """
    inertia = None
    if damper_inertia is not None:
        inertia = read_inertia("damper_inertia", damper_inertia, units)
    sized = DamperAsked(damper, damper_at, inertia)
    return TorsionQuestion(parse_speeds(speeds), list(map(_parse_trial, holzer)), sized)


def require_speeds(asked: TorsionQuestion, page: str) -> None:
    """Check that a picture over speed has a range of speeds.

    Raises:
        BalcliError: No range was given.
    """
    if asked.speeds_rpm is None and page in ("response", "waterfall"):
        raise ArgumentError(
            "{what} {page}: give the range of speeds, such as {speeds} 1000:2500", page=page
        )


# ------------------------------------------------------------------ in Python


def torsion(
    source: Engine | str | Path | Mapping[str, object],
    speeds: ArrayLike | None = None,
    *,
    orders: Iterable[float] | None = None,
    damper: Literal["viscous", "rubber", "pendulum"] | None = None,
    damper_at: str | None = None,
    damper_inertia: float | None = None,
    misfire: int | Literal["worst"] | Sequence[int] = (),
    compressing: bool = False,
) -> TorsionAnalysis:
    """Return the torsional vibration of a crankshaft, or of any shafts: natural modes, critical
    speeds, and vibratory torque and stress over a range of speeds.

    Args:
        source: Engine whose file has [torsion]; or the path, text or dict of tables of such a file
            or of a chain file.
        speeds: Speeds of the forced vibration, rpm; default: only modes and criticals are computed.
        orders: Orders of the excitation to use, multiples of 1/2. Default for a chain: all orders.
            Default for an engine: all orders up to 32; if the engine fires more than 12 times per
            turn, also the order equal to this number and twice this order.
        damper: Kind of damper to size. The sized damper minimises the largest stress over
            `speeds`, which must be given; the other results include the damper.
        damper_at: Name of the node that carries the damper; default: the foremost part, or for
            pendulums the throw with the largest amplitude.
        damper_inertia: Inertia of the damper's ring, or of its pendulums about the axis, kg m2;
            default: the inertia in the file, or a usual share of the equivalent inertia of the
            damped mode at the node.
        misfire: Number or numbers of the cylinders that do not fire, or "worst": every cylinder
            does not fire in turn, and the results are those of the worst one.
        compressing: Whether these cylinders compress and do not burn, which needs a computed cycle;
            default: they have no gas force.

    Returns:
        `modes` (`frequency_Hz`, `shape`), `criticals` (`speed_rpm`, `order`, `mode`), `response`
        (`shafts`, each with `half_peak_to_peak_Nm` and `stress_Pa` by speed, and `worst`, the
        largest value over the range), and `barred_rpm`. The attributes have the names of the JSON
        keys.

    Raises:
        BalcliError: The file has no [torsion]; orders or inertia are impossible; a response lacks
            excitation or passes an undamped resonance; no node can carry the damper.
        InputError: The file has mistakes; the error lists all of them.
        TypeError: An argument has the wrong type.

    Example:
        >>> torsion(load("i6_diesel.toml"), range(1000, 2501, 25)).barred_rpm
    """
    check_type("damper", damper, (str, NoneType), 'give a kind of damper, such as "viscous"')
    if damper not in (None, *FIGURES):
        raise ArgumentError(
            "{damper} {kind!r}: choose from {kinds}", kind=damper, kinds=", ".join(FIGURES)
        )
    asked = check_torsion_orders(orders)
    inertia = check_inertia("damper_inertia", damper_inertia)
    check_type("damper_at", damper_at, (str, NoneType), 'give the name of a part, such as "hub"')
    rpm = check_speeds("torsion", speeds)
    question = TorsionQuestion(rpm, (), DamperAsked(damper, damper_at, inertia))
    silent = ask_misfire(_take_cylinders(misfire), compressing)
    return answer_question(_read_source(source, asked, silent), question)


def _take_cylinders(misfire: object) -> tuple[int | str, ...]:
    """Return the argument `misfire` as a tuple."""
    wanted = 'give the number of a cylinder, several numbers, or "worst"'
    check_type("misfire", misfire, (int, str, Sequence), wanted)
    if isinstance(misfire, str) and misfire != WORST:
        raise ArgumentError("{misfire} {text!r}: {wanted}", text=misfire, wanted=wanted)
    if isinstance(misfire, (int, str)):
        return (misfire,)
    numbers = []
    for number in cast("Sequence[int]", misfire):
        check_type("misfire", number, (int,), wanted)
        numbers.append(number)
    return tuple(numbers)


def _read_source(source: object, orders: Array | None, misfire: MisfireAsked) -> Source:
    if isinstance(source, Engine):
        return make_source(take_model(source), source, source.name, orders, misfire=misfire)
    wanted = "give an Engine, or the path, text or dict of a chain of inertias and shafts"
    tables, name = take_tables("torsion", source, wanted)
    if describes_chain(tables):
        if misfire != ALL_FIRE:
            raise ArgumentError("{misfire}: a chain has no cylinders")
        name = name or "chain file"  # name, in messages, of a chain without a path
        return make_chain_source(read_chain_tables(tables, name), name, orders)
    engine = build_tables(tables, name)
    own = name or engine.name
    return make_source(take_model(engine), engine, own, orders, misfire=misfire)
