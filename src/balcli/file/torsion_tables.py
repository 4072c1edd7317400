"""Table [torsion] of an engine file, and the tables that it shares with chain files: a shaft
between two nodes, and a damper on a node. Units are kg mm2, N m/rad, N m s/rad, mm, GPa and kg.
"""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Annotated

from pydantic import Field

from ..limits import MOST_LIST_VALUES, MOST_TORSION_NODES
from .fields import (
    RIGID,
    FileName,
    Number,
    NumberOrTable,
    OneOf,
    OneOrEach,
    Whole,
    WrittenFigure,
    counted,
    shorten,
)
from .table import INERTIA_ABOVE_0, Density, FileTable, GivenInertia, Name, Size, Speed
from .units import (
    ANGLE,
    MASS,
    PLAIN,
    SHEAR_MODULUS,
    STRESS,
    TORQUE,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
)

_STIFFNESS = Number(TORSIONAL_STIFFNESS, above=0, most=1e24)
Stiffness = Annotated[
    float, Number(TORSIONAL_STIFFNESS, above=0, most=1e24, word=RIGID, meaning=math.inf)
]
Damping = Annotated[float, Number(TORSIONAL_DAMPING, least=0, most=1e18)]
Loss = Annotated[float, Number(PLAIN, least=0, most=10)]


STEEL = 7.85  # density of steel, g/cm3


# Factors c_K of IACS UR M68 by the design of a shaft.
DESIGN_FACTORS = {
    "flange": 1.0,
    "shrink-fit": 1.0,
    "keyed-taper": 0.60,
    "keyed-cylinder": 0.45,
    "radial-hole": 0.50,
    "slot": 0.30,
    "thrust-collar": 0.85,
    "propeller-keyless": 0.55,
    "propeller-keyed": 0.55,
    "stern-tube": 0.80,
}


class _DesignFactor(Number):
    """The factor c_K of M68, or the word for a design."""

    def read(self, value: object) -> float:
        if not isinstance(value, str):
            return super().read(value)
        if value not in DESIGN_FACTORS:
            words = ", ".join(DESIGN_FACTORS)
            raise ValueError(f"{shorten(value)} is no design; give a number up to 1, or {words}")
        return WrittenFigure(DESIGN_FACTORS[value], value)


_STRESS = Number(STRESS, above=0, most=1e9)
_TORQUE = Number(TORQUE, above=0, most=1e18)
_SPEEDS = Annotated[tuple[Speed, ...], Field(min_length=2, max_length=MOST_LIST_VALUES)]


class LimitBySpeed(FileTable):
    """A limit that depends on the speed."""

    speed: _SPEEDS | None = None
    """Rising speeds. Example: [40, 60, 100]"""

    def check_values(self, key: str) -> Iterator[str]:
        """Yield messages about speeds and values that do not belong together.

        Args:
            key: Key of the values.
        """
        values = getattr(self, key)
        if self.speed is None or values is None:
            missing = "speed" if self.speed is None else key
            yield f"lacks {missing}; give lists of speeds and values of the same length"
            return
        if len(values) != len(self.speed):
            yield f"has {len(self.speed)} speeds, but {counted(len(values), 'value')} of {key}"
        for before, after in pairwise(self.speed):
            if after <= before:
                yield f"has speeds that do not rise: {after:g} rpm after {before:g} rpm"
                return


class StressLimit(LimitBySpeed):
    """A limit of the stress: a table over the speed, or a rule."""

    stress: Annotated[tuple[Annotated[float, _STRESS], ...], Field(min_length=2)] | None = None
    """Limits at these speeds, linear between them. Example: [70, 52, 30]"""
    rule: Annotated[str, OneOf("M68")] | None = None
    """Rule that gives the limit: IACS UR M68, for propulsion shafts. Example: 'M68'"""
    tensile: Annotated[float, Number(STRESS, least=400, most=800)] | None = None
    """Tensile strength, for a rule. Example: 600"""
    ck: Annotated[float, _DesignFactor(PLAIN, above=0, most=1)] | None = None
    """Factor of the design, for a rule: a number, or a word. Example: 'propeller-keyless'"""
    rated_speed: Speed | None = None
    """Rated speed, for a rule; default: operation.speed. Example: 99"""

    def _check_form(self) -> Iterator[str]:
        if self.rule is None:
            yield from self._find_table_faults()
            return
        missing = [key for key in ("tensile", "ck") if not self.has(key)]
        if missing:
            yield f'has rule = "{self.rule}" and lacks {" and ".join(missing)}'
        for key in ("speed", "stress"):
            if self.has(key):
                yield f"has rule and {key}; leave one of them out"

    def _find_table_faults(self) -> Iterator[str]:
        of_rules = [key for key in ("tensile", "ck", "rated_speed") if self.has(key)]
        if of_rules:
            needless = " and ".join(of_rules)
            yield f'has {needless} without a rule; give rule = "M68", or leave {needless} out'
            return
        yield from self.check_values("stress")


class TorqueLimit(LimitBySpeed):
    """A limit of the vibratory torque over the speed."""

    torque: Annotated[tuple[Annotated[float, _TORQUE], ...], Field(min_length=2)] | None = None
    """Limits at these speeds, linear between them. Example: [3800, 3000]"""

    def _check_form(self) -> Iterator[str]:
        yield from self.check_values("torque")


MEAN = "mean"  # torque limit: the mean torque of the shaft


class ShaftKeys(FileTable):
    """Keys of a shaft: its stiffness, or the dimensions and modulus from which it follows."""

    stiffness: Stiffness | None = None
    """Torsional stiffness at the shaft's own speed, not referred to another speed; "rigid" for a
    flange or a gear mesh. Example: 1.25e6"""
    diameter: Size | None = None
    """Diameter of the shaft, needed for its stress. Example: 85"""
    length: Size | None = None
    """Length of a plain shaft, with diameter, instead of stiffness. Example: 400"""
    bore: Size | None = None
    """Diameter of the bore of a hollow shaft. Example: 30"""
    shear_modulus: Annotated[float, Number(SHEAR_MODULUS, above=0, most=1e6)] = 79.3
    """Shear modulus of a plain shaft; default: steel. Example: 79.3"""
    density: Density | None = None
    """Density of a plain shaft; half of the shaft's inertia then counts at each end; left out: the
    shaft has no inertia. Example: 7.85
    """
    loss: Loss | None = None
    """Loss factor: imaginary part of the stiffness divided by its real part. Example: 0.035"""
    damping: Damping = 0.0
    """Damping of a dashpot between the ends of the shaft. Example: 20"""
    limit: Annotated[float | StressLimit, NumberOrTable(_STRESS)] | None = None
    """Largest permitted stress of this shaft: a number, a table over the speed, or a rule; left
    out: that of all shafts. Example: 40"""
    torque_limit: Annotated[float | TorqueLimit | str, NumberOrTable(_TORQUE, MEAN)] | None = None
    """Largest permitted vibratory torque of this shaft: a number, a table over the speed, or "mean"
    for the mean torque of the shaft, above which gears hammer. Example: 5200"""

    @property
    def is_of_unnamed_steel(self) -> bool:
        """Whether this is a plain shaft for which the default shear modulus is used."""
        return self.length is not None and not self.has("shear_modulus")

    def _check_length(self) -> Iterator[str]:
        if self.stiffness is not None and self.length is not None:
            yield "has stiffness and length; leave one of them out"

    def _check_stiffness(self) -> Iterator[str]:
        if self.stiffness is None and (self.length is None or self.diameter is None):
            yield (
                "has no stiffness; give it, such as stiffness = 1.25e6, or diameter and length of "
                "a plain shaft"
            )

    def _check_bore(self) -> Iterator[str]:
        yield from self.check_below("bore", "diameter")

    def _check_limit(self) -> Iterator[str]:
        rule = getattr(self.limit, "rule", None)
        if rule is not None and self.diameter is None:
            yield f'has limit with rule = "{rule}" without a diameter; give the diameter'

    def _check_density(self) -> Iterator[str]:
        if self.density is not None and (self.length is None or self.diameter is None):
            yield "has a density without length and diameter; give all three, or leave density out"


_KEYS_OF_KIND = {
    "viscous": ("inertia", "damping"),
    "rubber": ("inertia", "stiffness", "loss"),
    "pendulum": ("mass", "radius"),
}
_TUNINGS = "length", "order"  # keys that tune a pendulum; exactly one of them must be given


class Damper(FileTable):
    """A damper on a node."""

    kind: Annotated[str, OneOf(*_KEYS_OF_KIND)]
    """Viscous: a ring in oil; rubber: a ring on rubber; pendulum: masses that swing under
    centrifugal force. Example: 'viscous'"""
    inertia: GivenInertia | None = None
    """Moment of inertia of the ring. Example: 30000"""
    damping: Annotated[float, Number(TORSIONAL_DAMPING, above=0, most=1e18)] | None = None
    """Damping of the oil film. Example: 12"""
    stiffness: Annotated[float, _STIFFNESS] | None = None
    """Stiffness of the rubber. Example: 40000"""
    loss: Loss | None = None
    """Loss factor of the rubber. Example: 0.15"""
    mass: Annotated[float, Number(MASS, above=0, most=1e12)] | None = None
    """Mass of all pendulums together. Example: 2"""
    radius: Size | None = None
    """Distance from the axis to the pivot of a pendulum. Example: 60"""
    length: Size | None = None
    """Length of a pendulum, from its pivot to its centre of mass. Example: 2.4"""
    order: Annotated[float, Number(PLAIN, above=0, most=1e3)] | None = None
    """Order that the pendulum cancels, in oscillations per turn of the node; instead of length,
    which is then radius/order^2. Example: 4.5"""

    @property
    def swinging_length(self) -> float:
        """Length of a pendulum, mm; 0 for a damper of another kind."""
        if self.order is not None and self.radius is not None:
            return self.radius / self.order**2
        return self.length or 0.0

    def _check_keys(self) -> Iterator[str]:
        wanted = _KEYS_OF_KIND[self.kind]
        given = self.model_fields_set - {"kind"}
        missing = [key for key in wanted if key not in given]
        if self.kind == "pendulum":
            tuning = given.intersection(_TUNINGS)
            given -= tuning
            missing += ["length (or order)"] * (not tuning)
            if len(tuning) > 1:
                yield "has length and order; leave one of them out"
        if missing:
            yield f"is {self.kind} and lacks {' and '.join(missing)}"
        owners = _KEYS_OF_KIND | {"pendulum": (*_KEYS_OF_KIND["pendulum"], *_TUNINGS)}
        for key in sorted(given.difference(wanted)):
            kinds = " or ".join(kind for kind, keys in owners.items() if key in keys)
            yield f"is {self.kind}; {key} is a key of kind = '{kinds}'"


class NodeKeys(FileTable):
    """Keys of a node: its name, its inertia, and its damper."""

    name: Name
    """Name of the node; the names of nodes must differ. Example: 'flywheel'"""
    inertia: GivenInertia | None = None
    """Moment of inertia; left out: the node is massless. Example: 2.075e6"""
    damper: Damper | None = None
    """Damper on the node. Example: { kind = 'viscous', inertia = 30000, damping = 12 }"""


class ChainKeys(FileTable):
    """Keys of a whole chain: the loss factor of its shafts, and limits."""

    loss: Loss = 0.0
    """Loss factor of every shaft for which the file gives none. Example: 0.035"""
    limit: Annotated[float | StressLimit, NumberOrTable(_STRESS)] | None = None
    """Largest permitted stress of every shaft without a limit of its own: a number, or a table over
    the speed, but no rule; speeds with a larger stress are barred. Example: 40"""
    torque_limit: Annotated[float | TorqueLimit | str, NumberOrTable(_TORQUE, MEAN)] | None = None
    """Largest permitted vibratory torque of every shaft without a torque limit of its own: a
    number, or a table over the speed, but not "mean"; speeds with a larger torque are barred.
    Example: 9000"""
    angle_limit: Annotated[float, Number(ANGLE, above=0, most=1e3)] | None = None
    """Largest permitted amplitude of the free end (in a chain file: of the first node); speeds with
    a larger amplitude are barred. Example: 0.3
    """

    def _check_limits(self) -> Iterator[str]:
        rule = getattr(self.limit, "rule", None)
        if rule is not None:
            yield (
                f'has limit with rule = "{rule}", which is for single shafts, not for crankshafts; '
                "give it to the shafts of propulsion, each in its own table"
            )
        if self.torque_limit == MEAN:
            yield (
                'has torque_limit = "mean", which is for single shafts; give it to the part of a '
                "gear, or give a torque in N m"
            )


def find_stiffness(shaft: ShaftKeys) -> float:
    """Return the torsional stiffness, N m/rad. For a plain shaft with shear modulus G, diameter D,
    bore d and length L it is `G pi (D^4 - d^4)/(32 L)`.
    """
    if shaft.stiffness is not None or shaft.length is None:
        return math.inf if shaft.stiffness is None else shaft.stiffness
    return shaft.shear_modulus * 1e9 * _find_polar_moment(shaft) / (shaft.length / 1e3)


def find_shaft_inertia(shaft: ShaftKeys, density: float | None) -> float:
    """Return the moment of inertia of a plain shaft, kg m2. It is 0 without a density, and for a
    shaft whose table gives the stiffness.

    Args:
        shaft: Table of the shaft.
        density: Density of the shaft's material, g/cm3.
    """
    length = (shaft.length or 0.0) / 1e3
    return (density or 0.0) * 1e3 * _find_polar_moment(shaft) * length if length else 0.0


def _find_polar_moment(shaft: ShaftKeys) -> float:
    """Return the polar moment of the section, m4; 0 without a diameter."""
    outer = (shaft.diameter or 0.0) / 1e3
    inner = (shaft.bore or 0.0) / 1e3
    return math.pi * (outer**4 - inner**4) / 32


class _Ratio(Number):
    """A speed ratio. It must not be 0, and is negative if the gears reverse the rotation."""

    def read(self, value: object) -> float:
        ratio = super().read(value)
        if abs(ratio) < 1e-6:
            raise ValueError(f"{ratio:g} is no speed ratio; give driven over driving speed, not 0")
        return ratio


SpeedRatio = Annotated[float, _Ratio(PLAIN, most=1e6)]


class Part(ShaftKeys, NodeKeys):
    """A part that turns with the crankshaft, before or behind its throws, and the shaft that
    connects the part.
    """

    gear: SpeedRatio | None = None
    """Speed of this part over crank speed; left out: the speed of the part to which this part is
    connected. The gear mesh is at that other part; the shaft turns with this part. Example: 0.5
    """
    of: Name | None = None
    """Name of the part to which this part is connected, or throw 1, throw 2, ...; left out: the
    part before this one in the list, or for the first part the nearest throw. Example: 'throw 1'
    """
    node_damping: Damping = 0.0
    """Damping of the part against ground, such as that of a propeller in water. Example: 5"""


class ThrowDamper(FileTable):
    """A damper on a throw of the crankshaft; a throw may have several."""

    throw: Annotated[int, Whole(least=1, most=MOST_TORSION_NODES)]
    """Number of the throw. Example: 6"""
    damper: Damper
    """The damper. Example: { kind = 'pendulum', mass = 3.6, radius = 62, order = 4.5 }"""


class NodeExcitation(FileTable):
    """A torque of one order on a part or throw, such as that of a propeller, fan or alternator."""

    node: Name
    """Part or throw on which the torque acts. Example: 'propeller'"""
    order: Annotated[float, Number(PLAIN, above=0, most=1e3)]
    """Oscillations per turn of this node. Example: 4"""
    share: Annotated[float, Number(PLAIN, above=0, most=1e3)] | None = None
    """Amplitude as a share of the mean torque at the node. Example: 0.04"""
    amplitude: Annotated[float, _TORQUE] | None = None
    """Amplitude, instead of share. Example: 12000"""
    angle: Annotated[float, Number(ANGLE, most=1e6)] | None = None
    """Angle in the torque: amplitude times the cosine of (order times the angle of the node, minus
    this angle); left out: the phase is not known, and the worst phase counts. Example: 25"""
    law: Annotated[str, OneOf("propeller")] | None = None
    """With amplitude: proportional to the square of the speed. Example: 'propeller'"""
    rated_speed: Speed | None = None
    """With law: speed of the crankshaft at which the amplitude is as given; default:
    operation.speed. Example: 95"""

    def _check_size(self) -> Iterator[str]:
        if self.share is None and self.amplitude is None:
            yield "has neither share nor amplitude; give one of them"
        if self.share is not None and self.amplitude is not None:
            yield "has share and amplitude; leave one of them out"
        if self.share is not None and self.law is not None:
            yield "has share and law; a share follows the mean torque, so leave law out"
        if self.rated_speed is not None and self.law is None:
            yield 'has rated_speed without law; give law = "propeller", or leave rated_speed out'


_Parts = Annotated[tuple[Part, ...], Field(max_length=MOST_TORSION_NODES)]


KER_WILSON = "ker-wilson"
CARTER = "carter"
THROW_FORMULAS = (KER_WILSON, CARTER)  # formulas of the stiffness of a throw


class Torsion(ChainKeys):
    """Torsional vibration: a node for each throw, and parts before and behind the throws."""

    throw_stiffness: (
        Annotated[tuple[float, ...] | str, OneOrEach(_STIFFNESS, copies=1, words=THROW_FORMULAS)]
        | None
    ) = None
    """Torsional stiffness between neighbouring throws: one figure for all of them, or a list; the
    word "ker-wilson" or "carter": it follows from dimensions by this formula; left out: the mean of
    both formulas. Example: 1.25e6
    """
    web_thickness: Size | None = None
    """Thickness of a web along the shaft, for the stiffness from dimensions; left out: that of
    [[web]], if all webs have the same. Example: 20"""
    web_width: Size | None = None
    """Width of a web across the shaft, half-way between pin and journal, for the stiffness from
    dimensions. Example: 82"""
    shear_modulus: Annotated[float, Number(SHEAR_MODULUS, above=0, most=1e6)] = 79.3
    """Shear modulus of the throws; default: steel. Example: 79.3"""
    throw_inertia: Annotated[tuple[float, ...], OneOrEach(INERTIA_ABOVE_0, copies=1)] | None = None
    """Moment of inertia of the crankshaft at each throw with its counterweights, without rods and
    pistons: one figure for all, or a list; left out: an equal share of crank.inertia. Example:
    46700
    """
    throw_diameter: Size | None = None
    """Diameter of the crankshaft between throws, needed for its stress; left out: that of the main
    journal or crank pin, whichever has the larger stress, if all dimensions of a throw are given.
    Example: 85"""
    throw_bore: Size | None = None
    """Diameter of the bore of a hollow crankshaft between throws. Example: 30"""
    damping: Damping = 0.0
    """Damping at every cylinder against ground. Example: 2"""
    front: _Parts = ()
    """Parts before the first throw, in order away from it."""
    rear: _Parts = ()
    """Parts behind the last throw, in order away from it."""
    throw: Annotated[tuple[ThrowDamper, ...], Field(max_length=MOST_TORSION_NODES)] = ()
    """Dampers on throws."""
    excitation: Annotated[tuple[NodeExcitation, ...], Field(max_length=MOST_TORSION_NODES)] = ()
    """Torques on parts and throws, besides those of the cylinders."""
    measured: Annotated[str, FileName()] | None = None
    """CSV file in the folder of the engine file with a measured curve: columns speed_rpm, order and
    amplitude_deg (amplitude of the free end). Example: 'torsiograph.csv'"""

    def _check_bore(self) -> Iterator[str]:
        yield from self.check_below("throw_bore", "throw_diameter")

    @property
    def given_stiffness(self) -> tuple[float, ...]:
        """Stiffness between throws, one figure or several; empty if it follows from dimensions."""
        given = self.throw_stiffness
        return () if given is None or isinstance(given, str) else given
