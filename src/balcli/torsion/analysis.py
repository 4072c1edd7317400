"""One question about torsional vibration, one complete answer."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..core.holzer_table import Holzer, tabulate_holzer
from ..core.telling import Tell, tell_nobody
from ..core.vibration import Real
from ..enginefile.fields import printable
from ..result import Result
from .damper_proposal import DamperAsked
from .damper_sizing import SizedDamper, size_damper
from .load import Source
from .modes import Critical, NaturalMode, find_criticals, find_natural_modes
from .response import TorsionResponse, find_barred, find_response
from .system import TorsionalSystem

BEYOND = 1.5  # times the file's own speed to which criticals are told: engines overspeed
BREAKING = 1000e6  # Pa of vibratory stress: the best steel yields below
ASTOUNDING = math.radians(45)  # engines have fractions of a degree, on soft couplings some
WIDE_SWING = math.radians(20)  # on a circle its frequency is 0.8 % low there, by swing^2/16
_ASTRAY = 1e-3  # of the largest angle: so far from the mode's shape a table is rounding errors


class HolzerAsked(NamedTuple):
    """A frequency at which Holzer's table is wanted: that of a mode by its number, or rad/s."""

    mode: int | None
    omega: float = 0.0


class HolzerTable(NamedTuple):
    """Holzer's table at a frequency (rad/s), of a mode by its number or a trial frequency; `end` is
    the node at which it ends.
    """

    mode: int | None
    omega: float
    table: Holzer
    end: int


class TorsionQuestion(NamedTuple):
    """What is asked.

    Attributes:
        speeds_rpm: (speeds,) rising, at which the response is wanted; None: none is.
        orders: which of those that excite; None: all.
        holzer: tables that are wanted.
        damper: that is to be sized; the answer is then about the system that has it.
    """

    speeds_rpm: Real | None = None
    orders: Real | None = None
    holzer: tuple[HolzerAsked, ...] = ()
    damper: DamperAsked | None = None


@dataclass(frozen=True, eq=False, repr=False)
class TorsionAnalysis(Result):
    """Modes, criticals, and what else was asked.

    Attributes:
        system: what was analysed.
        modes: elastic ones, lowest first.
        criticals: those that do most work first; in the range of speeds if there was one, else to
            one and a half times the file's own speed, if it gives one.
        holzer: tables.
        response: None: no speeds were asked for.
        barred_rpm: ranges of speed; None: there is no limit, or no response.
        damper: that was sized; the system has it.
    """

    system: TorsionalSystem
    modes: tuple[NaturalMode, ...]
    criticals: tuple[Critical, ...]
    holzer: tuple[HolzerTable, ...]
    response: TorsionResponse | None
    barred_rpm: tuple[tuple[float, float], ...] | None
    damper: SizedDamper | None = None

    @property
    def doubts(self) -> tuple[str, ...]:
        """What is unlikely of the response, in words: swings beyond what is computed here, a stress
        that breaks the shaft.
        """
        return tuple(self._find_doubts())

    def _find_doubts(self) -> Iterator[str]:
        if self.response is None:
            return
        worst, system = self.response.worst, self.system
        each = zip(system.pendulums, worst.pendulums, worst.pendulum_rpm, strict=True)
        for pendulums, swing, rpm in each:
            if swing > WIDE_SWING:
                yield (
                    f"the pendulums of {printable(system.nodes[pendulums.node])} swing by "
                    f"{math.degrees(swing):.3g} deg at {rpm:.4g} rpm, computed as if that were "
                    f"small: at {math.degrees(WIDE_SWING):.0f} deg one on a circle is 0.8 % out of "
                    f"tune, farther out more; with {swing / WIDE_SWING:.2g} times their mass they "
                    f"would swing by about {math.degrees(WIDE_SWING):.0f} deg"
                )
        question = "is the damping (loss, damping) of all that twists right?"
        stress = np.nan_to_num(worst.stress)
        if stress.size and stress.max() > BREAKING:
            shaft = int(stress.argmax())
            yield (
                f"{printable(system.shafts[shaft])} would bear {stress[shaft] / 1e6:.4g} N/mm2 at "
                f"{worst.speeds_rpm[shaft]:.5g} rpm, which no steel does; {question}"
            )
        elif worst.free_end > ASTOUNDING:
            swings = (
                f"{printable(system.nodes[0])} would swing by {math.degrees(worst.free_end):.4g} "
                f"deg at {worst.swing_rpm:.5g} rpm"
            )
            if worst.free_end > 2 * _add_twists(system, worst.torque):
                yield (
                    f"{swings}, and everything with it, for the shafts twist by less: it turns too "
                    "unevenly for what is computed here, small swings; is an inertia missing, or "
                    "the speed too low?"
                )
            else:
                yield f"{swings}, which no shaft outlasts; {question}"

    @property
    def summary(self) -> str:
        """Of what, and its natural frequencies."""
        modes = ", ".join(f"{mode.frequency_hz:.4g}" for mode in self.modes[:6])
        return f"of {self.system.name or 'a chain'}: modes at {modes} Hz"


def _add_twists(system: TorsionalSystem, torque: Real) -> float:
    """How far shafts under these torques (N m) twist altogether, rad of the first node: no node
    swings farther against it.
    """
    chain, gears = system.chain, system.gears
    return float(np.abs(torque / chain.stiffness * gears[0] / gears[chain.end]).sum())


def answer_question(
    source: Source, question: TorsionQuestion, tell: Tell = tell_nobody
) -> TorsionAnalysis:
    """The answer about a chain or an engine; `tell` is told which share is done.

    Raises:
        BalcliError: a response without excitation or through an undamped resonance; a mode that is
            not there; Holzer's table of a chain with loops; a damper that nothing can carry.
        InputError: what does not fit together in the file.
    """
    if question.damper is None or question.speeds_rpm is None:
        return _analyze_system(source.system(), question, tell)
    sized = size_damper(source, question.damper, question.speeds_rpm, question.orders, tell)
    fitted = source.with_damper(sized.node, sized.damper).system()  # one response after dozens
    return replace(_analyze_system(fitted, question), damper=sized)


def _analyze_system(
    system: TorsionalSystem, question: TorsionQuestion, tell: Tell = tell_nobody
) -> TorsionAnalysis:
    """The answer about a system as it is."""
    if question.orders is not None and system.excitation is not None:
        system = replace(system, excitation=system.excitation.only(question.orders))
    named = find_natural_modes(system)
    speeds = question.speeds_rpm
    span = (0.0, BEYOND * system.rated_rpm) if system.rated_rpm else None
    if speeds is not None:
        span = float(speeds[0]), float(speeds[-1])
    excitation = system.excitation
    criticals = () if excitation is None else find_criticals(excitation, named, span)
    response, barred = None, None
    if speeds is not None:
        if not len(system.require_excitation().orders):
            raise system.refusal("nothing excites it at the orders asked for")
        response = find_response(system, speeds, tell)
        met = np.array([critical.speed_rpm for critical in criticals])
        barred = find_barred(system, response, met)
    tables = tuple(_tabulate(system, named, asked) for asked in question.holzer)
    return TorsionAnalysis(system, named, criticals, tables, response, barred)


def _tabulate(
    system: TorsionalSystem, modes: tuple[NaturalMode, ...], asked: HolzerAsked
) -> HolzerTable:
    omega = asked.omega
    if asked.mode is not None:
        if asked.mode > len(modes):
            count = f"{len(modes)} mode{'s' * (len(modes) != 1)}"
            raise system.refusal(f"has {count}, but --holzer asks for {asked.mode}")
        omega = modes[asked.mode - 1].omega
    try:
        # Holzer's angle of 1 stands at a free end; a clamped one is where the table leads to
        ends = (system.last, 0) if system.chain.clamped[0] else (0, system.last)
        table = tabulate_holzer(system.chain, omega, *ends)
    except ValueError as error:
        raise system.refusal(f"--holzer: {error}") from None
    if asked.mode is not None:
        shape, first = modes[asked.mode - 1].shape, ends[0]
        if np.abs(table.angle * shape[first] - shape).max() > _ASTRAY:
            raise system.refusal(
                f"--holzer: mode {asked.mode} cannot be followed from {system.nodes[first]}: that "
                "hardly moves in it, or a branch swings by itself"
            )
    return HolzerTable(asked.mode, omega, table, ends[1])
