"""State for each limit of a shaft whether the shaft passes, and for each shaft without a limit why
it is not checked.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from ..core.vibration import Real
from .permitted import M68, M68_BARRED_BELOW, MeanLimit, ShaftLimit
from .shaft_limits import (
    ExceededRange,
    JudgedLimit,
    LargestShare,
    find_largest_share,
    judge_limits,
)
from .system import TorsionalSystem

Verdict = Literal["passes", "barred", "fails", "not checked"]


@dataclass(frozen=True, kw_only=True)
class BarredRange:
    """A range of speeds in which a limit is exceeded.

    Attributes:
        from_rpm: First speed.
        to_rpm: Last speed.
        open: Side on which the range ends only because the speeds end; left out if it ends by
            itself on both sides.
        peak_rpm: Speed of the largest share.
        share: Largest share of the limit in the range.
        transient_share: Largest share of the transient limit in the range; left out without a rule.
        rule_rpm: First and last speed of the usual range to bar about the peak; left out without a
            rule, and if the peak is at an end of the speeds.
    """

    from_rpm: float
    to_rpm: float
    open: Literal["below", "above", "both"] | None = None
    peak_rpm: float
    share: float
    transient_share: float | None = None
    rule_rpm: tuple[float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class LimitVerdict:
    """Verdict on one limit of a shaft, or on a shaft that is not checked.

    Attributes:
        shaft: Name of the shaft.
        kind: What is limited; this and all further figures are left out if it is not checked.
        rule: Rule from which the limit follows; left out if the file gives the limit.
        verdict: Passes: nothing exceeds the limit; barred: it is exceeded in the listed ranges;
            fails: a rule allows no such ranges.
        reason: Why a shaft fails or is not checked; left out otherwise.
        share: Largest ratio of a value to the limit at its speed.
        speed_rpm: Speed of the largest share.
        value_Pa: Stress at that speed.
        value_Nm: Torque at that speed.
        limit_Pa: Limit of the stress at that speed.
        limit_Nm: Limit of the torque at that speed.
        barred: Ranges of speeds in which the limit is exceeded.
    """

    shaft: str
    kind: Literal["stress", "torque"] | None = None
    rule: Literal["M68"] | None = None
    verdict: Verdict
    reason: str | None = None
    share: float | None = None
    speed_rpm: float | None = None
    value_Pa: float | None = None
    value_Nm: float | None = None
    limit_Pa: float | None = None
    limit_Nm: float | None = None
    barred: tuple[BarredRange, ...] | None = None


class Judgment(NamedTuple):
    """Verdicts on shafts, in their order, stress first; and the ranges of speed, rpm, in which any
    limit is exceeded. None: there is no such limit.
    """

    verdicts: tuple[LimitVerdict, ...] | None
    barred_rpm: tuple[tuple[float, float], ...] | None


def judge_system(system: TorsionalSystem, rpm: Real) -> Judgment:
    """Return the verdicts on all shafts, and the barred speeds.

    Args:
        system: System with an excitation.
        rpm: Rising speeds, shape (speeds,).
    """
    idle = [limit for limit in system.limits if _permits_nothing(limit, rpm)]
    limits = [limit for limit in system.limits if limit not in idle]
    judged = judge_limits(system, rpm, limits) if limits else ()
    barred = _unite(judged) if system.limits else None
    of_shafts = any(limit.kind != "angle" for limit in system.limits)
    if not of_shafts and not system.unknown_stress:
        return Judgment(None, barred)
    verdicts = []
    for k, shaft in enumerate(system.shafts):
        of_shaft = [
            (limit, judgment)
            for limit, judgment in zip(limits, judged, strict=True)
            if limit.column == k
        ]
        for limit, judgment in of_shaft:
            verdicts.append(_judge(system, limit, judgment, rpm))
        reason = None
        if any(limit.column == k for limit in idle):
            reason = "its mean torque is 0 at one of the speeds"
        elif not of_shaft and k in system.checkable:
            reason = "no diameter" if k in system.without_diameter else "no limit"
        if reason is not None:
            verdicts.append(LimitVerdict(shaft=shaft, verdict="not checked", reason=reason))
    return Judgment(tuple(verdicts), barred)


def find_hardest(system: TorsionalSystem, rpm: Real) -> LargestShare | None:
    """Return the limit of a shaft that is used most, as `judge_system` finds it; None without such
    limits.
    """
    limits = []
    for limit in system.limits:
        if limit.kind != "angle" and not _permits_nothing(limit, rpm):
            limits.append(limit)
    return find_largest_share(system, rpm, limits) if limits else None


def find_hardest_verdict(verdicts: Sequence[LimitVerdict]) -> LimitVerdict | None:
    """Return the verdict on the limit that is used most; None if no shaft is checked."""
    checked = [verdict for verdict in verdicts if verdict.share is not None]
    return max(checked, key=_take_share, default=None)


def _take_share(verdict: LimitVerdict) -> float:
    return verdict.share or 0.0


def _permits_nothing(limit: ShaftLimit, rpm: Real) -> bool:
    """Return whether a limit is a mean torque that is 0 at one of the speeds."""
    of_mean = limit.limit
    return isinstance(of_mean, MeanLimit) and of_mean.vanishes(float(rpm[0]), float(rpm[-1]))


def _unite(judged: Sequence[JudgedLimit]) -> tuple[tuple[float, float], ...]:
    """Return the ranges in which any limit is exceeded, by rising speed; ranges that touch become
    one.
    """
    spans = []
    for judgment in judged:
        for span in judgment.exceeded:
            spans.append((span.from_rpm, span.to_rpm))
    united: list[tuple[float, float]] = []
    for start, stop in sorted(spans):
        if united and start <= united[-1][1]:
            first, last = united[-1]
            united[-1] = (first, max(last, stop))
        else:
            united.append((start, stop))
    return tuple(united)


def _judge(
    system: TorsionalSystem, limit: ShaftLimit, judgment: JudgedLimit, rpm: Real
) -> LimitVerdict:
    """Return the verdict on one limit."""
    rule = limit.limit if isinstance(limit.limit, M68) else None
    permitted = float(limit.limit.at(np.array(judgment.speed_rpm)))
    barred = tuple(_make_range(rule, span, rpm) for span in judgment.exceeded)
    reason = None if rule is None else _find_failure(rule, barred, any(system.silent))
    verdict: Verdict = "barred" if barred else "passes"
    value = judgment.share * permitted
    stressed = limit.kind == "stress"
    return LimitVerdict(
        shaft=system.shafts[limit.column],
        kind="stress" if stressed else "torque",
        rule=None if rule is None else "M68",
        verdict="fails" if reason else verdict,
        reason=reason,
        share=judgment.share,
        speed_rpm=judgment.speed_rpm,
        value_Pa=value if stressed else None,
        value_Nm=None if stressed else value,
        limit_Pa=permitted if stressed else None,
        limit_Nm=None if stressed else permitted,
        barred=barred,
    )


def _make_range(rule: M68 | None, span: ExceededRange, rpm: Real) -> BarredRange:
    """Return a range with the figures that a rule adds."""
    inside = float(rpm[0]) < span.peak_rpm < float(rpm[-1])
    return BarredRange(
        **span._asdict(),
        transient_share=None if rule is None else span.share / rule.transient,
        rule_rpm=rule.range_about(span.peak_rpm) if rule is not None and inside else None,
    )


def _find_failure(rule: M68, barred: Sequence[BarredRange], misfires: bool) -> str | None:
    """Return why a rule allows no barred range, or None.

    Args:
        rule: Rule.
        barred: Ranges in which its continuous limit is exceeded.
        misfires: Whether a cylinder does not fire: the rule then allows ranges at all speeds.
    """
    return next(_list_failures(rule, barred, misfires), None)


def _find_transient_share(span: BarredRange) -> float:
    return span.transient_share or 0.0


def _list_failures(rule: M68, barred: Sequence[BarredRange], misfires: bool) -> Iterator[str]:
    """Yield the reasons for which a rule allows no barred range, the heaviest one first."""
    for span in sorted(barred, key=_find_transient_share, reverse=True):
        share = _find_transient_share(span)
        if share > 1:
            yield f"{share:.0%} of the transient limit at {span.peak_rpm:.4g} rpm"
    for span in barred:
        highest = M68_BARRED_BELOW * rule.rated_rpm
        if span.to_rpm > highest and not misfires:
            yield (
                f"the barred range reaches {span.to_rpm:.4g} rpm, but M68 allows none above "
                f"{highest:.4g} rpm"
            )
