"""Define limits of stress, torque and swing as functions of the speed, and make them from the
tables of shafts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from ..core.vibration import Real
from ..file.torsion_tables import MEAN, ChainKeys, ShaftKeys, StressLimit, TorqueLimit
from .means import MeanTorques

M68_FACTOR_ENDS = 0.9  # speed over rated speed up to which the speed factor of M68 falls
M68_ALLOY = 600.0  # N/mm2; M68 counts a higher strength of intermediate shafts only
M68_HIGHEST = 1.05  # speed over rated speed above which M68 says nothing
_PASCALS = 1e6  # Pa in 1 N/mm2
M68_BARRED_BELOW = 0.8  # speed over rated speed up to which M68 allows barred ranges


class LimitTable(NamedTuple):
    """Limit over the speed, linear between the speeds; outside them the nearest value holds.

    Attributes:
        rpm: Rising speeds.
        values: Limits at these speeds, Pa, N m or rad.
    """

    rpm: Sequence[float]
    values: Sequence[float]

    @property
    def corners(self) -> Sequence[float]:
        """Speeds at which the limit is not smooth."""
        return self.rpm

    def list_doubts(self, first_rpm: float, last_rpm: float) -> Iterator[str]:
        """Yield warnings of a range of speeds that the table does not cover."""
        if len(self.rpm) == 1:  # the same limit at all speeds
            return
        for outside, nearest in ((first_rpm, self.rpm[0]), (last_rpm, self.rpm[-1])):
            beyond = outside < self.rpm[0] or outside > self.rpm[-1]
            if beyond:
                yield f"outside its speeds the limit of {nearest:g} rpm is used at {outside:g} rpm"

    def at(self, rpm: Real) -> Real:
        """Return the limits at speeds."""
        return np.interp(rpm, self.rpm, self.values)


class M68(NamedTuple):
    """Continuous and transient limit of the vibratory stress of a propulsion shaft by IACS UR M68.

    Attributes:
        tensile: Tensile strength, N/mm2.
        factor: Factor c_K of the shaft's design, 0 to 1.
        diameter: Diameter of the shaft, mm.
        rated_rpm: Rated speed.
    """

    tensile: float
    factor: float
    diameter: float
    rated_rpm: float

    @property
    def corners(self) -> Sequence[float]:
        """Speeds, rpm, at which the limit is not smooth."""
        return (M68_FACTOR_ENDS * self.rated_rpm,)

    def at(self, rpm: Real) -> Real:
        """Return the limits for continuous running, Pa:
        `(tensile + 160)/18 c_K (0.35 + 0.93 D^-0.2) f` with `f = 3 - 2 (n/n0)^2` below 0.9 of the
        rated speed n0, and 1.38 above.
        """
        ratio = rpm / self.rated_rpm
        of_speed = 3 - 2 * np.minimum(ratio, M68_FACTOR_ENDS) ** 2
        of_size = 0.35 + 0.93 * self.diameter**-0.2
        return np.asarray((self.tensile + 160) / 18 * self.factor * of_size * of_speed * 1e6)

    def list_doubts(self, first_rpm: float, last_rpm: float) -> Iterator[str]:
        """Yield warnings of a strength and of speeds for which the rule does not hold."""
        if self.tensile > M68_ALLOY:
            yield (
                f"tensile = {self.tensile:g}: M68 counts more than {M68_ALLOY:g} N/mm² for "
                "intermediate shafts of alloy steel only"
            )
        highest = M68_HIGHEST * self.rated_rpm
        if last_rpm > highest:
            yield f"{last_rpm:g} rpm is beyond the rule, which ends at {highest:.6g} rpm"

    @property
    def transient(self) -> float:
        """Transient limit over continuous limit: `1.7/sqrt(c_K)`."""
        return 1.7 / math.sqrt(self.factor)

    def range_about(self, rpm: float) -> tuple[float, float]:
        """Return the usual range (rpm) to bar about a resonance: 16 n/(18 - n/n0) to
        (18 - n/n0) n/16.
        """
        width = 18 - rpm / self.rated_rpm
        return 16 * rpm / width, width * rpm / 16


class MeanLimit(NamedTuple):
    """Limit above which the torque of a shaft reverses: the size of its mean torque.

    Attributes:
        means: Mean torques of all shafts.
        shaft: Index of the shaft.
    """

    means: MeanTorques
    shaft: int

    @property
    def corners(self) -> Sequence[float]:
        """Speeds at which the limit is not smooth."""
        return self.means.nodes_rpm

    def at(self, rpm: Real) -> Real:
        """Return the limits at speeds."""
        return np.abs(self.means.at(rpm)[..., self.shaft])

    def list_doubts(self, _first_rpm: float, _last_rpm: float) -> Iterator[str]:
        """Yield nothing: the gas has warnings of its own for speeds that it does not cover."""
        yield from ()

    def vanishes(self, first_rpm: float, last_rpm: float) -> bool:
        """Return whether the mean torque is 0 at a speed from the first to the last one, where it
        would permit nothing.
        """
        between = [rpm for rpm in self.corners if first_rpm < rpm < last_rpm]
        torques = self.means.at(np.array([first_rpm, *between, last_rpm]))[:, self.shaft]
        return bool(torques.min() <= 0 <= torques.max())


Limit: TypeAlias = LimitTable | M68 | MeanLimit


class ShaftLimit(NamedTuple):
    """Limit of one curve: the torque or stress of a shaft, or the swing of the free end.

    Attributes:
        column: Index of the curve among those of `compute_curves`.
        kind: What is limited.
        by_torque: Value of the limited quantity for a curve of 1 N m, or of 1 rad.
        limit: The limit as a function of the speed.
    """

    column: int
    kind: Literal["stress", "torque", "angle"]
    by_torque: float
    limit: Limit


def list_limits(
    tables: Sequence[ShaftKeys],
    stress_by_torque: Real,
    keys: ChainKeys,
    rated_rpm: float | None,
    means: MeanTorques | None = None,
) -> tuple[ShaftLimit, ...]:
    """Return the limits of shafts, in the order of the shafts, stress first.

    Args:
        tables: Tables of the shafts.
        stress_by_torque: Stress of each shaft for 1 N m, Pa; 0 without a diameter.
        keys: Limits of shafts that have none of their own.
        rated_rpm: Speed of the file, for rules; None: the file gives none.
        means: Mean torques of the shafts; None: they are not known.
    """
    limits = []
    for k, (table, by_torque) in enumerate(zip(tables, stress_by_torque.tolist(), strict=True)):
        stress = keys.limit if table.limit is None else table.limit
        if stress is not None and by_torque:
            permitted = _make_stress_limit(stress, table, rated_rpm)
            limits.append(ShaftLimit(k, "stress", by_torque, permitted))
        torque = keys.torque_limit if table.torque_limit is None else table.torque_limit
        if torque == MEAN and means is not None:
            limits.append(ShaftLimit(k, "torque", 1.0, MeanLimit(means, k)))
        elif torque is not None and not isinstance(torque, str):
            limits.append(ShaftLimit(k, "torque", 1.0, _make_torque_limit(torque)))
    return tuple(limits)


def _make_stress_limit(
    given: float | StressLimit, table: ShaftKeys, rated_rpm: float | None
) -> LimitTable | M68:
    """Return the limit of the stress of a shaft."""
    if isinstance(given, float):
        return _make_table(None, (given,), _PASCALS)
    if given.rule is None:
        return _make_table(given.speed, given.stress or (), _PASCALS)
    return M68(
        tensile=given.tensile or math.nan,
        factor=given.ck or math.nan,
        diameter=table.diameter or math.nan,
        rated_rpm=given.rated_speed or rated_rpm or math.nan,
    )


def _make_torque_limit(given: float | TorqueLimit) -> LimitTable:
    """Return the limit of the torque of a shaft."""
    if isinstance(given, float):
        return _make_table(None, (given,), 1.0)
    return _make_table(given.speed, given.torque or (), 1.0)


def _make_table(rpm: Sequence[float] | None, values: Sequence[float], size: float) -> LimitTable:
    """Return a limit as a table over the speed, in SI units.

    Args:
        rpm: Speeds; None: one value holds at all speeds.
        values: Limits at these speeds.
        size: Unit of the values in SI units.
    """
    in_si = tuple(value * size for value in values)
    return LimitTable((1.0,) if rpm is None else tuple(rpm), in_si)
