"""Define the balance schemes: the name, the one-line description and the options of each. Options
are checked here for both the command and the Python function. This module does not load numpy.
"""

import math
from numbers import Complex, Integral, Real
from types import NoneType
from typing import NamedTuple

from ..errors import Argument, ArgumentError, BalcliError, Message, join_messages, wrong_type
from ..file.fields import nearest
from ..limits import FARTHEST_DEVICE_M, HIGHEST_SHAFT_ORDER, MOST_SMALL, SMALL

DESIGNS = ("a", "b")  # a: pin on the shaft, slot in the disc; b: pin on the disc, slot on the shaft
CRITERIA = ("largest", "mean")  # eccentric-slider minimises this value of the remaining force
LADDER = ("auto", "step")  # schemes that fit steps of the ladder
WEB_SCHEMES = ("factor", "step", "counterweights")  # fit webs that the file leaves open
KNUCKLES = "knuckles"  # fits no device, but changes the engine file (balcli.balancing.answer)
FIT = "fit"  # fits the devices that the file leaves open (balcli.sizing.fit)
ALL = "all"  # compares the other schemes (balcli.balancing.all_schemes)


class Scheme(NamedTuple):
    """A balance scheme.

    Attributes:
        name: Name.
        options: Names of the options that it takes, which are attributes of `SchemeOptions`.
        meaning: Description in one line.
    """

    name: str
    options: tuple[str, ...]
    meaning: str


_PLACES = ("at", "position", "planes")  # of shafts, eccentrics and counterweights
_SCHEMES = (
    Scheme("auto", _PLACES, "orders 1 and 2: counterweights; shafts if they cancel much"),
    Scheme("complete", _PLACES, "all of orders 1 and 2: counterweights, and even small shafts"),
    Scheme("step", ("step", *_PLACES), "rows of the ladder that balance prints, by name or number"),
    Scheme(
        "counterweights",
        ("order", "planes"),
        "counterweights for the part of order 1 turning with the crank",
    ),
    Scheme(
        "factor",
        ("factor", "measured", "planes"),
        "the shop's balance factor, with the bobweight card",
    ),
    Scheme(
        "minimax",
        ("planes", "position", "orders"),
        "the counterweight that leaves the smallest peak force",
    ),
    Scheme(
        "ellipse",
        ("direction", "ratio", "planes", "position"),
        "counterweight that gives order 1 a wanted direction and shape",
    ),
    Scheme(
        "single-shaft",
        ("order", "at", "position", "planes"),
        "one shaft against the crank; for order 1 also counterweights",
    ),
    Scheme(
        "two-shaft",
        ("order", "at", "position", "roll"),
        "two shafts turning against each other: force of one order",
    ),
    Scheme(
        "four-shaft",
        ("at", "position"),
        "as two-shaft, with four shafts: forces of orders 1 and 2",
    ),
    Scheme(
        "couple-shaft",
        ("order", "at", "planes"),
        "shafts with two opposite eccentrics: moment of one order",
    ),
    Scheme(
        "compensator",
        ("order", "at", "position"),
        "masses far from the engine: vertical moment of one order",
    ),
    Scheme(
        "slider",
        ("order", "at", "position"),
        "reciprocating masses along the axes of the force of one order",
    ),
    Scheme(
        "eccentric-slider",
        ("design", "criterion", "radius"),
        "a pair of shafts of variable speed, for one cylinder",
    ),
    Scheme("oldham", ("radius",), "an Oldham coupling for orders 1 and 2 of one cylinder"),
    Scheme("knuckles", ("even",), "knuckle angles for even dead centres or strokes (articulated)"),
    Scheme("fit", ("target",), 'the devices of the file that have unbalance = "fit"'),
    Scheme(ALL, (), "what every scheme leaves and takes, side by side"),
)
_OF_THE_COMMAND = (KNUCKLES, FIT, ALL)  # schemes that the function `balance` does not run
MEANINGS = {scheme.name: scheme.meaning for scheme in _SCHEMES}
NAMES = tuple(MEANINGS)
OPTIONS = {scheme.name: scheme.options for scheme in _SCHEMES}
SCHEMES = {name: options for name, options in OPTIONS.items() if name not in _OF_THE_COMMAND}

# Type of number that each option takes, and words for a valid value.
_NUMBERS: dict[str, tuple[type, str]] = {
    "order": (Integral, "a whole number, such as 2"),
    "at": (Complex, "places x + iy in m, such as (-0.04 + 0.06j,)"),
    "position": (Real, "a place z in m, such as 0.1"),
    "planes": (Real, '"ends", "throws", "webs", or places z in m, such as (-0.1, 0.1)'),
    "factor": (Real, "shares, such as (0.5,)"),
    "measured": (Real, "a mass in kg, such as 0.812"),
    "orders": (Real, "orders, such as (1, 2)"),
    "small": (Real, "a share, such as 0.05"),
    "radius": (Real, "a length in m, such as 0.03"),
    "direction": (Real, "an angle in degrees, such as 90"),
    "ratio": (Real, "a share, such as 0.5"),
}
_CHOICES = {"roll": ("zero",), "design": DESIGNS, "criterion": CRITERIA}
_SEVERAL = ("at", "planes", "factor", "orders")


class SchemeOptions(NamedTuple):
    """Options of the schemes, lengths in m; None: not given. `balcli balance --schemes` lists the
    options of each scheme.

    Attributes:
        order: Order to balance; default: the lowest order with a force or moment that the scheme
            cancels and that is not small.
        at: Positions x + iy of shafts or sliders; for a pair of shafts, the position of the shaft
            that turns against the crank comes first; for steps of the ladder, a position for each
            shaft, in the order -1, -2, +2.
        position: Position z of new devices; compensators take one z, or two (fore and aft). Shafts
            of steps of the ladder take one z, which cancels only the force, or two.
        planes: "ends", "throws", "webs", or positions z of new devices.
        factor: Shares of the reciprocating mass to try; the best share is fitted; default: 0.5.
        measured: Mass on each bare pin that balances the crank, kg; the factor that
            follows from this mass is fitted, unless `factor` gives another one.
        roll: "zero" places two shafts such that they also cancel the inertia roll of their order.
        orders: Orders of the force whose largest value scheme minimax minimises; default: all.
        small: Share of one cylinder's first order below which a force or moment of an order is left
            unbalanced.
        step: Name or number of a step of the ladder (scheme step).
        radius: Radius of the weights of eccentric-slider and oldham; default: the crank radius.
        direction: Direction of the largest force of order 1 that is to remain, deg from x.
        ratio: Smallest over largest force of order 1 that is to remain.
        design: Design of the unevenly turning shafts of eccentric-slider, one of `DESIGNS`.
        criterion: Criterion by which the shafts of eccentric-slider are sized, one of `CRITERIA`.
    """

    order: int | None = None
    at: tuple[complex, ...] | None = None
    position: float | tuple[float, ...] | None = None
    planes: str | tuple[float, ...] | None = None
    factor: tuple[float, ...] | None = None
    measured: float | None = None
    roll: str | None = None
    orders: tuple[float, ...] | None = None
    small: float | None = None
    step: str | int | None = None
    radius: float | None = None
    direction: float | None = None
    ratio: float | None = None
    design: str | None = None
    criterion: str | None = None

    def read_small(self) -> float:
        """Return `small`, or its default if it is not given."""
        return SMALL if self.small is None else self.small

    def check(self, scheme: str) -> None:
        """Reject options that the scheme does not take, and values out of range.

        Raises:
            BalcliError: The scheme is unknown or does not take an option, or a value is out of
                range.
        """
        self._check_numbers()
        taken = find_taken(scheme)
        asked = self._replace(small=None)._asdict().items()  # every scheme takes `small`
        given = [name for name, value in asked if value is not None]
        if strangers := [name for name in given if name not in taken]:
            others = " or ".join(name for name in SCHEMES if {*given} <= {*SCHEMES[name]})
            hint = Message("it takes {names}", names=_name_options(taken))
            if scheme == "auto" and others:
                hint = Message("choose {scheme} {others}", others=others)
            raise ArgumentError(
                "scheme {name} has no {stranger}; {hint}",
                name=scheme,
                stranger=Argument(strangers[0]),
                hint=hint,
            )
        if self.order is not None and not 1 <= self.order <= HIGHEST_SHAFT_ORDER:
            raise ArgumentError(
                "{order} {value}: give 1 to {highest}",
                value=self.order,
                highest=HIGHEST_SHAFT_ORDER,
            )
        check_small(self.read_small())
        if scheme == "step" and self.step is None:
            raise ArgumentError(
                "scheme step: give a step, such as {step} 1; balance lists all steps"
            )
        if not isinstance(self.step, (str, int, NoneType)):
            raise wrong_type("SchemeOptions: step", self.step, "give a name or number, such as 1")
        if self.radius is not None and not 0 < self.radius < math.inf:
            raise ArgumentError(
                "{radius}: {value:g} mm; give a radius above 0", value=1e3 * self.radius
            )
        if isinstance(self.planes, str) and self.planes not in ("ends", "throws", "webs"):
            raise ArgumentError(
                '{planes} "{word}": give ends, throws, webs, or places along z',
                word=self.planes[:60],
            )
        self._check_choices()

    def _check_choices(self) -> None:
        """Raise ArgumentError for a word that is no choice, and for a ratio outside 0 to 1."""
        if self.ratio is not None and not 0 <= self.ratio <= 1:
            raise ArgumentError(
                "{ratio} {percent:g} %: give a share from 0 to 100 %", percent=100 * self.ratio
            )
        for name, choices in _CHOICES.items():
            if getattr(self, name) not in (None, *choices):
                wrong = f"{getattr(self, name)}"[:60]
                raise ArgumentError(
                    '{argument} "{wrong}": choose from {choices}',
                    argument=Argument(name),
                    wrong=wrong,
                    choices=", ".join(choices),
                )

    def _check_numbers(self) -> None:
        """Raise TypeError for a value that is no number, ArgumentError for a position too far from
        the engine.
        """
        for name, (kind, right) in _NUMBERS.items():
            given = getattr(self, name)
            if given is None or (name == "planes" and isinstance(given, str)):
                continue
            several = name in _SEVERAL or (name == "position" and isinstance(given, tuple))
            values = given if several else (given,)
            if not _are(values, kind, name not in ("factor", "radius")):
                raise wrong_type(f"SchemeOptions: {name}", given, f"give {right}")
            if name in ("at", "position", "planes"):
                farthest = max(map(abs, values))
                if farthest > FARTHEST_DEVICE_M:
                    raise ArgumentError(
                        "{argument}: {there:g} mm from the origin; at most {most:g} m",
                        argument=Argument(name),
                        there=1e3 * farthest,
                        most=FARTHEST_DEVICE_M,
                    )

    def read_place(self) -> complex:
        """Return the given position x + iy, by default 0 (the crank axis); ArgumentError for
        several.
        """
        at = self.at or (0j,)
        if len(at) > 1:
            raise ArgumentError("{at}: this scheme fits its devices at one place; give one place")
        return at[0]


def _name_options(names: tuple[str, ...]) -> str:
    """Return the names of options with commas between them, for messages."""
    return join_messages(list(map(Argument, names))) if names else "no options"


def check_small(share: float) -> float:
    """Return the share below which forces and moments are small, if it is valid.

    Raises:
        BalcliError: The share is not between 0 and MOST_SMALL.
    """
    if not 0 <= share <= MOST_SMALL:
        raise BalcliError(f"small {100 * share:g} %: give a share from 0 to {MOST_SMALL:.0%}")
    return share


def _are(values: object, kind: type, finite: bool) -> bool:
    """Return whether `values` is a tuple of numbers of this kind, not empty; all finite if
    `finite`.
    """
    if not isinstance(values, tuple) or not all(isinstance(one, kind) for one in values):
        return False
    try:
        sizes = [abs(complex(one)) for one in values]
    except OverflowError:
        return False
    return bool(sizes) and (not finite or all(size < math.inf for size in sizes))


def find_taken(scheme: str) -> tuple[str, ...]:
    """Return the options that a scheme takes.

    Raises:
        BalcliError: There is no scheme of this name (the error names the nearest scheme), or the
            scheme is knuckles or fit, which only the command `balance` runs.
    """
    if scheme in SCHEMES:
        return SCHEMES[scheme]
    if scheme in _OF_THE_COMMAND:
        raise BalcliError(f"only the command balance runs the scheme {scheme}")
    near = nearest(scheme, NAMES)
    meant = f"did you mean {near}? " if near else ""
    raise BalcliError(f"there is no scheme {scheme[:60]!r}: {meant}choose from {', '.join(NAMES)}")
