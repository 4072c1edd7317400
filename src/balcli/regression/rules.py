"""Read the table [check] of an engine file: tolerances of figures and limits of quantities, and
find quantities beyond their limits.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import NamedTuple

from ..engine.engine import Engine, take_model
from ..errors import BalcliError, InputError, Problem
from ..file.check_table import EVERY_QUANTITY, Check, Limit
from ..file.fields import Number, shorten, suggest_nearest
from ..file.lines import LineFinder
from ..file.model import EngineFile
from ..file.units import ANGLE, FORCE, LENGTH, PLAIN, TORQUE, Dimension, read_fraction
from ..studies.quantities import AnyQuantity, Evaluator, parse_quantities, refuse_unknown
from ..studies.quantity_names import FORMS
from .naming import RECORDED_QUANTITIES
from .records import BrokenLimit

TOLERANCE = 1e-9  # share of the largest figure of a quantity; rounding is allowed in addition
_TOLERANCES = "check.tolerance"
_LIMITS = "check.limits"
# Dimensions of quantities, by the unit in which `numbers` lists them.
_DIMENSIONS = {
    "N": FORCE,
    "N·m": TORQUE,
    "mm": LENGTH,
    "deg": ANGLE,
    "m": Dimension("m", "a length", ("0.09 m", "90 mm")),
    "m/s": Dimension("m/s", "a speed", ("12 m/s", "40 ft/s")),
    "m/s²": Dimension("m/s^2", "an acceleration", ("20000 m/s^2",)),
    "Hz": Dimension("Hz", "a frequency", ("12 Hz", "0.5 kHz")),
    "Pa": Dimension("Pa", "a stress", ("40 N/mm^2", "5800 psi")),
    "%": PLAIN,
    "": PLAIN,
}


class Tolerance(NamedTuple):
    """Allowed change of a figure.

    Attributes:
        value: Share of the largest figure of its group, or change in the unit of the figure.
        is_share: Whether it is a share.
    """

    value: float
    is_share: bool = True

    def find_change(self, largest: float) -> float:
        """Return the allowed change; `largest` is the largest figure of the group."""
        return self.value * largest if self.is_share else self.value

    def find_share(self, largest: float) -> float:
        """Return the allowed change as a share of the largest figure."""
        if self.is_share:
            return self.value
        return self.value / largest if largest else 0.0


class Tolerances(NamedTuple):
    """Tolerances of the figures of one engine.

    Attributes:
        usual: Tolerance of figures without one of their own.
        named: Tolerances by the beginning of a quantity's name: `force`, `force.2`.
    """

    usual: Tolerance = Tolerance(TOLERANCE)
    named: Mapping[str, Tolerance] = {}

    def find(self, names: tuple[str, ...]) -> Tolerance:
        """Return the tolerance of a figure; its names are ordered from special to general."""
        return next((self.named[name] for name in names if name in self.named), self.usual)


class Limited(NamedTuple):
    """A quantity with limits, in the unit that `numbers` lists for it.

    Attributes:
        name: Name in the file.
        quantity: The quantity.
        below: Limit that the value must be below; None if there is none.
        above: Limit that the value must be above; None if there is none.
    """

    name: str
    quantity: AnyQuantity
    below: float | None
    above: float | None

    def is_kept(self, value: float) -> bool:
        """Return whether a value is within the limits; nan (no value) is not."""
        is_below = self.below is None or value < self.below
        is_above = self.above is None or value > self.above
        return is_below and is_above and not math.isnan(value)


class Rules(NamedTuple):
    """The table [check] of an engine file."""

    tolerances: Tolerances
    limited: tuple[Limited, ...]


def read_rules(engine: Engine, file: str, usual: float | None) -> Rules:
    """Return the tolerances and limits of an engine.

    A tolerance that the file names for a quantity is the strongest; then comes `usual`, then the
    file's tolerance for all quantities.

    Args:
        engine: Engine from a file.
        file: Name of its file, for messages.
        usual: Tolerance from the command line, as a share; None: not given.

    Raises:
        InputError: [check] has mistakes; the error lists all of them.
    """
    model = take_model(engine)
    check = model.check or Check()
    problems: list[Problem] = []
    named: dict[str, Tolerance] = {}
    limited: list[Limited] = []
    for name, value in check.tolerance.items():
        with _collecting(problems, f"{_TOLERANCES}.{name}"):
            resolved = _resolve_name(name)
            if resolved in named:
                raise BalcliError(f"is the second tolerance of {resolved}; leave one out")
            named[resolved] = _read_tolerance(name, value)
    for name, limit in check.limits.items():
        with _collecting(problems, f"{_LIMITS}.{name}"):
            limited.append(_read_limit(model, engine, name, limit))
    if problems:
        raise InputError(problems, file)
    general = named.pop(EVERY_QUANTITY, Tolerance(TOLERANCE))
    if usual is not None:
        general = Tolerance(usual)
    return Rules(Tolerances(general, named), tuple(limited))


@contextmanager
def _collecting(problems: list[Problem], path: str) -> Iterator[None]:
    """Collect a mistake in a value of [check], with the path of the value."""
    try:
        yield
    except (ValueError, BalcliError) as error:
        problems.append(Problem(path, str(error)))


# ------------------------------------------------------------------ tolerances
def _resolve_name(name: str) -> str:
    """Return the name of a tolerance as `naming.name_quantities` has it: `moment.1` for
    `moment.1.major`, because all figures of an order are tolerated together.

    Raises:
        BalcliError: No figure of a record has this name.
    """
    if name == EVERY_QUANTITY:
        return name
    head = name.partition(".")[0]
    if head not in RECORDED_QUANTITIES:
        listed = f"a record has figures of {', '.join(RECORDED_QUANTITIES)}"
        raise BalcliError(f"is not recorded; {suggest_nearest(head, RECORDED_QUANTITIES, listed)}")
    is_whole = any(form.matches(name) for form in FORMS)
    if is_whole or not any(form.begins_with(name) for form in FORMS):
        parse_quantities(name)
    if is_whole and name.count(".") > 1:
        return name.rpartition(".")[0]
    return name


def _read_tolerance(name: str, value: float | str) -> Tolerance:
    """Return a tolerance: a share as a number or percentage, or a change with its unit.

    Raises:
        ValueError: The value is neither; the message says what is wanted.
    """
    if isinstance(value, str):
        with suppress(ValueError):
            value = read_fraction(value)
    if isinstance(value, str):
        return Tolerance(_read_change(name, value), is_share=False)
    if not 0 <= value <= 1:
        raise ValueError(f'{value:g} is not a share from 0 to 1, such as 1e-6 or "0.1 %"')
    return Tolerance(float(value))


def _read_change(name: str, text: str) -> float:
    """Return an allowed change in the unit of a quantity."""
    units = {form.unit for form in FORMS if form.begins_with(name)}
    if len(units) != 1:
        raise ValueError(f'{shorten(text)} is not a share; give a number or percentage: "0.1 %"')
    return Number(_DIMENSIONS[units.pop()], least=0).read(text)


# ------------------------------------------------------------------ limits
def _read_limit(model: EngineFile, engine: Engine, name: str, limit: Limit) -> Limited:
    """Return a limited quantity.

    Raises:
        BalcliError: There is no such quantity, or the engine does not have it.
        ValueError: A limit is not a figure of the quantity's unit, or no value can be within both.
    """
    quantities = parse_quantities(name, with_gas=model.has_gas)
    if len(quantities) > 1:
        raise BalcliError("names several quantities; give each of them its own limit")
    refuse_unknown(model, engine, quantities)
    reader = Number(_DIMENSIONS[quantities[0].unit])
    below = None if limit.below is None else reader.read(limit.below)
    above = None if limit.above is None else reader.read(limit.above)
    if below is not None and above is not None and below <= above:
        raise ValueError(f"no value is above {above:g} and below {below:g}")
    return Limited(name, quantities[0], below, above)


def find_broken_limits(
    engine: Engine, limited: Sequence[Limited], lines: LineFinder
) -> tuple[BrokenLimit, ...]:
    """Return the quantities of an engine that are beyond their limits.

    Args:
        engine: Engine from a file.
        limited: Quantities with limits.
        lines: Finder of the lines in its file.

    Raises:
        BalcliError, InputError: A quantity cannot be computed.
    """
    if not limited:
        return ()
    evaluator = Evaluator(take_model(engine), [each.quantity for each in limited])
    values = evaluator.evaluate({}, ())
    broken = []
    for limit in limited:
        value = float(values[limit.quantity])
        if not limit.is_kept(value):
            figure = None if math.isnan(value) else value
            line = lines.find(f"{_LIMITS}.{limit.name}")
            unit = limit.quantity.unit
            broken.append(BrokenLimit(limit.name, figure, unit, limit.below, limit.above, line))
    return tuple(broken)
