"""Tables of an engine file about gas pressure, crank torque and flywheel: [gas], [flywheel] and
[bearing].

This module is imported only for files that have one of these tables (`names.CHAPTERS`).
"""

from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Annotated, Any

from pydantic import Field

from ..limits import MOST_GAS_POINTS, MOST_LIST_VALUES
from .assumed import Assumed, assume
from .fields import Choice, FileName, Number, OneOf, join_words
from .table import (
    Angle,
    Distance,
    FileTable,
    GivenInertia,
    Heat,
    Lengths,
    Mass,
    Numbers,
    Size,
    Speed,
)
from .units import ANGLE, PLAIN, PRESSURE


class ClearanceShare(Number):
    """A clearance volume, divided by the swept volume of its end."""

    def __init__(self) -> None:
        super().__init__(PLAIN, above=0, most=2)

    def _fault(self, number: float) -> tuple[str, str] | None:
        fault = super()._fault(number)
        if fault is None or number <= self.most:
            return fault
        too_large, bound = fault
        share = f"it is a share of the swept volume: {number / 100:g} for {number:g} %"
        return too_large, f"{bound}; {share}"


Pressure = Annotated[float, Number(PRESSURE, least=0, most=1e6)]
PressureAbove0 = Annotated[float, Number(PRESSURE, above=0, most=1e6)]
MeanPressure = Annotated[float, Number(PRESSURE, most=1e6)]
CutOff = Annotated[float, Number(PLAIN, least=1, most=1000)]
Duration = Annotated[float, Number(ANGLE, above=0, most=720)]
Index = Annotated[float, Number(PLAIN, above=0, most=5)]
Clearance = Annotated[float, ClearanceShare()]
NamedFile = Annotated[str, FileName()]
Zero = Annotated[str, OneOf("firing", "gas-exchange")]
Reference = Annotated[str, OneOf("absolute", "gauge")]

_GOALS = ("imep", "bmep", "max_pressure", "cut_off", "heat")
DIAGRAM_KEYS = ("zero", "phase", "pressure")
WIEBE_KEYS = ("burn_start", "burn_duration", "burn_shape")
_CYCLE_KEYS = (
    *("compression_index", "expansion_index", "intake", "exhaust"),
    *("exhaust_opens", "intake_closes", "bmep", "max_pressure", "cut_off", "heat"),
    *WIEBE_KEYS,
)
COMPRESSOR = "compressor"  # value of `cycle`
COMPRESSOR_KEYS = ("suction", "discharge", "clearance")
_OF_COMBUSTION = ("compression_ratio", "imep", *_CYCLE_KEYS[2:])
# Keys of Otto and Wiebe cycles that do not move the angles at which the laws of the cycle change.
_JOINT_KEYS = frozenset(
    {
        *("compression_ratio", "compression_index", "expansion_index", "intake", "exhaust"),
        *("burn_shape", "imep", "bmep", "max_pressure", "heat"),
    }
)
_AT_DEAD_CENTRE = ("exhaust_opens", "intake_closes")  # keys whose default is lower dead centre


MEAN_PRESSURES = ("imep", "bmep")


class GasPoint(FileTable):
    """Gas at one of several speeds. Between two of these speeds, figures and pressures are
    interpolated linearly.
    """

    speed: Speed
    """Crank speed. Example: 1000"""
    indicator: NamedFile | None = None
    """gas.indicator at this speed. Example: 'p_1000.csv'"""
    zero: Zero | None = None
    """gas.zero at this speed. Example: 'gas-exchange'"""
    phase: Angle | None = None
    """gas.phase at this speed. Example: -0.5"""
    pressure: Reference | None = None
    """gas.pressure at this speed. Example: 'gauge'"""
    intake: PressureAbove0 | None = None
    """gas.intake at this speed. Example: 1.2"""
    exhaust: Pressure | None = None
    """gas.exhaust at this speed. Example: 1.1"""
    imep: MeanPressure | None = None
    """gas.imep at this speed. Example: 6"""
    bmep: MeanPressure | None = None
    """gas.bmep at this speed. Example: 5"""
    max_pressure: Pressure | None = None
    """gas.max_pressure at this speed. Example: 45"""
    cut_off: CutOff | None = None
    """gas.cut_off at this speed. Example: 1.5"""
    heat: Heat | None = None
    """gas.heat at this speed. Example: 700"""
    burn_start: Angle | None = None
    """gas.burn_start at this speed. Example: -8"""
    burn_duration: Duration | None = None
    """gas.burn_duration at this speed. Example: 45"""
    harmonics: NamedFile | None = None
    """gas.harmonics at this speed. Example: 'tangential_1000.csv'"""


class CrankEnd(FileTable):
    """Gas at the crank end of double-acting cylinders. A table with cycle or indicator stands for
    itself; otherwise keys that it leaves out are those of the head end.
    """

    choices = (Choice((("indicator",), ("cycle",))),)

    indicator: NamedFile | None = None
    """gas.indicator of this end; angles count as those of the head end. Example: 'crank_end.csv'"""
    zero: Zero | None = None
    """gas.zero of this end. Example: 'firing'"""
    phase: Angle | None = None
    """gas.phase of this end. Example: -0.5"""
    pressure: Reference | None = None
    """gas.pressure of this end. Example: 'gauge'"""
    cycle: Annotated[str, OneOf("compressor")] | None = None
    """gas.cycle of this end. Example: 'compressor'"""
    suction: PressureAbove0 | None = None
    """gas.suction of this end. Example: 1.0"""
    discharge: PressureAbove0 | None = None
    """gas.discharge of this end. Example: 4.0"""
    clearance: Clearance | None = None
    """gas.clearance of this end. Example: 0.15"""
    compression_index: Index | None = None
    """gas.compression_index of this end. Example: 1.3"""
    expansion_index: Index | None = None
    """gas.expansion_index of this end. Example: 1.25"""


class GasKeys(FileTable):
    """Keys of the gas of all cylinders ([gas]), or of some cylinders ([[gas.of]])."""

    indicator: NamedFile | None = None
    """A measured pressure diagram: CSV file next to the engine file, headed angle_deg,pressure_bar
    (or _MPa, _kPa, _Pa, _psi; gauge pressures _barg, _psig). Example: 'p_2000rpm.csv'
    """
    zero: Zero = "firing"
    """The dead centre at angle 0 of the diagram: the firing one, or the one of the gas exchange.
    Example: 'gas-exchange'"""
    phase: Angle = 0.0
    """Angle that is added to the angles of the diagram. Example: -0.5"""
    pressure: Reference = "absolute"
    """Kind of the diagram's pressures; gauge: above an atmosphere of 1.01325 bar. Example: 'gauge'
    """
    cycle: Annotated[str, OneOf("otto", "diesel", "dual", "wiebe", "compressor")] | None = None
    """Kind of a computed cycle: its combustion, or a compressor with ideal valves. Example: 'wiebe'
    """
    compression_ratio: Annotated[float, Number(PLAIN, above=1, most=1000)] | None = None
    """Largest over smallest volume of the cylinder; with a measured diagram, only results that show
    volumes use it. Example: 10.5
    """
    compression_index: Index = 1.32
    """Index n of the compression, p V^n = const. Example: 1.35"""
    expansion_index: Index = 1.28
    """Index n of the expansion, p V^n = const, and of the burn. In a compressor cycle, index of the
    re-expansion; left out there: compression_index. Example: 1.27"""
    suction: PressureAbove0 | None = None
    """Absolute pressure while a compressor draws in. Example: 1.0"""
    discharge: PressureAbove0 | None = None
    """Absolute pressure while a compressor discharges. Example: 4.0"""
    clearance: Clearance | None = None
    """Clearance volume of a compressor end, divided by its swept volume. Example: 0.12"""
    intake: PressureAbove0 = 1.0
    """Absolute pressure while the cylinder fills. Example: 1.8"""
    exhaust: Pressure = 1.05
    """Absolute pressure while a four-stroke cylinder empties. Example: 1.3"""
    imep: MeanPressure | None = None
    """Indicated mean effective pressure of a computed cycle; with a measured diagram, the value to
    expect from the diagram. Example: 10
    """
    bmep: MeanPressure | None = None
    """Brake mean effective pressure, with mechanical_efficiency, instead of imep. Example: 8.5"""
    max_pressure: Pressure | None = None
    """Highest absolute pressure of a computed cycle; in a dual cycle, the pressure of the second
    part of the burn. Example: 70
    """
    cut_off: CutOff | None = None
    """Volume after the burn at constant pressure, divided by the volume before this burn. Example:
    2"""
    heat: Heat | None = None
    """Heat supplied per cycle and cylinder. Example: 1400"""
    burn_start: Angle = -15.0
    """Wiebe: cycle angle (from the firing dead centre) at which the burn starts. Example: -10"""
    burn_duration: Duration = 50.0
    """Wiebe: crank angle that the burn takes. Example: 60"""
    burn_shape: Annotated[float, Number(PLAIN, least=0, most=100)] = 2.0
    """Wiebe: form factor m, the exponent of Wiebe's law. Example: 1.5"""
    exhaust_opens: Annotated[float, Number(ANGLE, above=0, most=360)] | None = None
    """Cycle angle (from the firing dead centre) at which the exhaust opens; left out: lower dead
    centre. Example: 140"""
    intake_closes: Annotated[float, Number(ANGLE, least=360, below=720)] | None = None
    """Four-stroke: cycle angle (from the firing dead centre) at which the intake closes; left out:
    lower dead centre. Example: 580"""
    crankcase: Pressure = 1.0
    """Absolute pressure under the pistons; with a crank end, pressure on the cross-section of the
    piston rod. Example: 1.1"""
    crank_end: CrankEnd | None = None
    """Gas at the end towards the crank; present: the cylinders are double-acting."""


class GasOf(GasKeys):
    """Gas of some cylinders."""

    choices = (Choice((("indicator",), ("cycle",))),)

    cylinders: Numbers
    """Numbers of these cylinders. Example: [2]"""


class Gas(GasKeys):
    """Pressure on the pistons over a cycle: measured, computed, or given by torque harmonics."""

    choices = (
        Choice((("indicator",), ("cycle",), ("harmonics",)), required=True),
        Choice((("at",), ("law", "rated_speed")), complete=("law", "rated_speed")),
    )

    mechanical_efficiency: Annotated[float, Number(PLAIN, above=0, most=1)] | None = None
    """Brake over indicated mean effective pressure. Example: 0.85"""
    harmonics: NamedFile | None = None
    """Table of harmonics from an engine builder: CSV file headed order,cos,sin, for the tangential
    pressure in bar (torque / (piston area * crank radius)) over the angle from the firing dead
    centre. Example: 'tangential.csv'"""
    at: Annotated[tuple[GasPoint, ...], Field(max_length=MOST_GAS_POINTS)] = ()
    """Gas at two or more speeds; keys that [[gas.at]] gives must not be in [gas]."""
    law: Annotated[str, OneOf("propeller")] | None = None
    """Load law, instead of [[gas.at]]: imep (or bmep) is proportional to the square of the speed
    and has its given value at rated_speed. Example: 'propeller'"""
    rated_speed: Speed | None = None
    """With law: speed at which the engine has the given imep or bmep. Example: 120"""
    of: Annotated[tuple[GasOf, ...], Field(max_length=MOST_LIST_VALUES)] = ()
    """Gas of some cylinders. Keys replace those of [gas] one by one; a table with cycle or
    indicator takes only crankcase from [gas]."""

    @property
    def given(self) -> set[str]:
        """Keys that the file gives, in [gas] or for each speed."""
        return self.model_fields_set | self.keys_of_points

    @property
    def keys_of_points(self) -> set[str]:
        """Keys that the file gives for each speed."""
        return set[str]().union(*(point.model_fields_set for point in self.at)) - {"speed"}

    @property
    def speeds(self) -> tuple[float, ...]:
        """Speeds for which the file gives the gas, rpm; empty: gas is the same at all speeds."""
        if self.rated_speed is not None:
            return (self.rated_speed,)
        return tuple(point.speed for point in self.at)

    @property
    def goals(self) -> tuple[str, ...]:
        """Keys of which exactly one must be given, because each of them sets the heat; a dual cycle
        also needs max_pressure.
        """
        return tuple(key for key in _GOALS if key != "max_pressure" or self.cycle != "dual")

    @property
    def joint_keys(self) -> frozenset[str]:
        """Keys whose values may be arrays of variants, which are then computed together; empty if
        the gas is not that of one computed cycle at all speeds and in all cylinders.
        """
        apart = self.at or self.law or self.of or self.crank_end
        return frozenset() if apart or self.cycle not in ("otto", "wiebe") else _JOINT_KEYS

    def rivals(self, key: str) -> tuple[str, ...]:
        goals = self.goals if key in self.goals else ()
        return (*super().rivals(key), *(goal for goal in goals if goal != key))

    def list_idle_keys(self, strokes: int, measured: bool, computed: bool) -> set[str]:
        """Return the keys whose values do not matter for the gas in this engine.

        Args:
            strokes: Strokes of a cycle: 2 or 4.
            measured: Whether a cylinder has a diagram.
            computed: Whether a cylinder has a computed cycle.
        """
        idle = self.keys_of_points | {*([] if self.law else ["rated_speed"])}
        if not idle.isdisjoint(self.goals):
            idle.update(self.goals)
        absent = GasPoint.model_fields.keys() - self.keys_of_points - {"speed"}
        idle.update(f"at.{k}.{key}" for k, _ in enumerate(self.at, 1) for key in absent)
        if self.cycle == COMPRESSOR:
            idle.update(_OF_COMBUSTION, ("expansion_index",))
        elif not computed:
            idle.update(_CYCLE_KEYS, ("compression_ratio", "imep"))
        elif self.cycle != "wiebe":
            idle.update(WIEBE_KEYS)
        if strokes == 2:
            idle.update(("exhaust", "intake_closes"))
        if not measured:
            idle.add("phase")
            if self.harmonics:
                idle.add("crankcase")
        return idle

    @property
    def has_crank_ends(self) -> bool:
        """Whether any cylinder is double-acting."""
        return self.crank_end is not None or any(one.crank_end is not None for one in self.of)

    @property
    def is_of_pump(self) -> bool:
        """Whether all cylinders compress, or any cylinder is double-acting."""
        return self.cycle == COMPRESSOR or self.has_crank_ends

    def list_assumed(self, strokes: int, measured: bool, computed: bool) -> Iterator[Assumed]:
        """Yield the defaults on which results depend; arguments as for `list_idle_keys`."""
        idle = self.list_idle_keys(strokes, measured, computed) | {*DIAGRAM_KEYS, "at", "of"}
        for key in type(self).model_fields:
            if self.has(key) or key in idle:
                continue
            value = getattr(self, key)
            if value is not None:
                yield assume(f"gas.{key}", self, value)
            elif key in _AT_DEAD_CENTRE:
                yield Assumed(f"gas.{key}", "lower dead centre")

    def _check_points(self) -> Iterator[str]:
        """Check that all points have the same keys, none of them in [gas], and that speeds rise."""
        if not self.at:
            return
        if len(self.at) == 1:
            yield "has one [[gas.at]]; give two or more, or its keys in [gas] for all speeds"
        for k, (low, high) in enumerate(pairwise(self.speeds), 2):
            if high <= low:
                yield (
                    f"at.{k}.speed = {high:g} rpm does not exceed the {low:g} rpm before it; give "
                    "the points in order of rising speed"
                )
        first, *others = (point.model_fields_set for point in self.at)
        for k, keys in enumerate(others, 2):
            if keys != first:
                listed = join_words(sorted(keys ^ first))
                yield f"at.1 and at.{k} do not both have {listed}; give each point the same keys"
        if twice := sorted(self.keys_of_points & self.model_fields_set):
            yield f"has {join_words(twice)}, and so does [[gas.at]]; give it only in [[gas.at]]"

    def _check_law(self) -> Iterator[str]:
        """Check that a law has a mean pressure to act on."""
        if self.law is not None and self.cycle is None:
            yield "has law with a diagram; give [[gas.at]] tables, each with a diagram, instead"
        elif self.law is not None and not any(map(self.has, MEAN_PRESSURES)):
            yield "has law without imep; give imep, or bmep, at rated_speed"

    def list_compressor_faults(self) -> Iterator[tuple[str, str]]:
        """Yield key (empty: the table) and message for each mistake in the keys of a compressor
        cycle.
        """
        if self.cycle != COMPRESSOR:
            for key in filter(self.has, COMPRESSOR_KEYS):
                yield key, 'belongs to cycle = "compressor"; leave it out'
            return
        if others := [key for key in _OF_COMBUSTION if self.has(key)]:
            yield "", f"has {join_words(others)}, which a compressor cycle does not have"
        missing = [key for key in COMPRESSOR_KEYS if getattr(self, key) is None]
        if missing:
            yield "", f"needs {join_words(missing)} for a compressor cycle"
        if self.suction is None or self.discharge is None:
            return
        if self.discharge <= self.suction:
            lower = f"{self.discharge:g} bar is not above suction = {self.suction:g} bar"
            yield "discharge", f"{lower}; give the higher of the two absolute pressures"

    def _check_alone(self) -> Iterator[str]:
        """Check that [[gas.at]] and law are not combined with ends or cylinders of their own."""
        others = ["of"] * bool(self.of)
        others += ["crank_end"] * (self.crank_end is not None)
        others += ['cycle = "compressor"'] * (self.cycle == COMPRESSOR)
        if others and (self.at or self.law is not None):
            what = "[[gas.at]]" if self.at else "law"
            yield f"has {what} with {join_words(others)}; give the gas of one speed"

    def _check_misplaced(self) -> Iterator[str]:
        """Check that keys of a computed cycle are given only with `cycle`."""
        others = [key for key in _CYCLE_KEYS if self.has(key)]
        if others and self.cycle is None and (self.has("indicator") or self.has("harmonics")):
            what = "indicator" if self.has("indicator") else "harmonics"
            yield f"has {join_words(others)} with {what}; these belong to a computed cycle"

    def _check_cycle(self) -> Iterator[str]:
        """Check that a computed cycle has all its keys, and exactly one key that sets the heat."""
        if self.cycle is None or self.cycle == COMPRESSOR:
            return
        for key, least in (("compression_index", "at least"), ("expansion_index", "above")):
            value = getattr(self, key)
            index = value if isinstance(value, float) else float(value.min())  # of all variants
            if index < 1 or (index == 1 and least == "above"):
                yield f"has {key} = {index:g}; in a cycle with combustion it is {least} 1"
        wiebe = [key for key in WIEBE_KEYS if self.has(key)]
        if wiebe and self.cycle != "wiebe":
            yield f"has {join_words(wiebe)}, which only a wiebe cycle has"
        given = [key for key in self.goals if self.has(key)]
        choice = f"give one of {join_words(self.goals)}"
        if len(given) > 1:
            yield f"has {join_words(given)}; {choice}"
        elif not given:
            yield f"has no key for the heat; {choice}"
        if self.cycle == "dual" and not self.has("max_pressure"):
            yield "needs max_pressure, the pressure of the second part of the burn in a dual cycle"
        if self.has("bmep") and self.mechanical_efficiency is None:
            yield "has bmep without mechanical_efficiency; give both, or imep"
        if self.compression_ratio is None:
            yield "needs compression_ratio for a computed cycle, such as compression_ratio = 10.5"


def list_compressing(gas: Gas | None, numbers: Iterable[int]) -> set[int]:
    """Return those of the cylinders whose head end has a compressor cycle.

    Args:
        gas: Table [gas]; None if the file has none.
        numbers: Numbers of the cylinders.
    """
    if gas is None:
        return set()
    compressing = set(numbers) if gas.cycle == COMPRESSOR else set[int]()
    for table in gas.of:
        own = take_of(gas, table)
        compressing -= {*table.cylinders}
        if own.cycle == COMPRESSOR:
            compressing |= {*table.cylinders}.intersection(numbers)
    return compressing


def take_of(gas: Gas, own: GasOf) -> Gas:
    """Return the gas of the cylinders of a [[gas.of]] in the form of [gas]. If the table has a
    cycle or an indicator, it takes only `crankcase` from [gas], otherwise all keys that it lacks.
    """
    given = {key: getattr(own, key) for key in own.model_fields_set - {"cylinders"}}
    taken = {"crankcase", "mechanical_efficiency"}
    if not (own.has("cycle") or own.has("indicator")):
        taken = gas.model_fields_set - {"of", "at", "law", "rated_speed"}
    kept = {key: getattr(gas, key) for key in taken & gas.model_fields_set}
    ends = kept.get("crank_end"), given.get("crank_end")
    merged = kept | given
    if ends[0] is not None and ends[1] is not None and not stands_alone(ends[1]):
        both = _list_given(ends[0]) | _list_given(ends[1])
        merged["crank_end"] = CrankEnd.model_construct(**both)
    return Gas.model_construct(**merged)


def take_crank_end(gas: Gas) -> Gas | None:
    """Return the gas of the crank end in the form of [gas]; None for single-acting cylinders. If
    the crank end has no cycle and no indicator, keys that it lacks are those of the head end.
    """
    own = gas.crank_end
    if own is None:
        return None
    kept = {"crankcase": gas.crankcase}
    if not stands_alone(own):
        kept |= {key: getattr(gas, key) for key in gas.model_fields_set & CrankEnd.keys().keys()}
    return Gas.model_construct(**kept | _list_given(own))


def stands_alone(end: CrankEnd) -> bool:
    """Return whether a crank end takes no keys from the head end."""
    return end.has("cycle") or end.has("indicator")


def _list_given(table: FileTable) -> dict[str, Any]:
    return {key: getattr(table, key) for key in table.model_fields_set}


class Flywheel(FileTable):
    """A flywheel and all other parts that the crankshaft drives; `torsion` ignores this table."""

    choices = (
        Choice((("inertia",), ("mass", "radius_of_gyration")), required=True, complete=True),
    )

    inertia: GivenInertia | None = None
    """Polar moment of inertia. Example: 250000"""
    mass: Mass | None = None
    """Mass, with radius_of_gyration, instead of inertia. Example: 12"""
    radius_of_gyration: Size | None = None
    """Radius of gyration, with mass, instead of inertia. Example: 140"""


class Bearing(FileTable):
    """Dimensions of the crankshaft's bearings, for bearing loads per area and the stiffness of
    throws.
    """

    pin_diameter: Size | None = None
    """Diameter of the crank pins. Example: 48"""
    pin_bore: Distance = 0.0
    """Inner diameter of hollow crank pins. Example: 20"""
    pin_width: Size | None = None
    """Width of the big-end bearing of each rod. Example: 20"""
    pin_length: Size | None = None
    """Length of each crank pin between its two webs, needed with [[web]] and for the stiffness of a
    throw. Example: 27"""
    main_diameter: Size | None = None
    """Diameter of the main journals. Example: 60"""
    main_bore: Distance = 0.0
    """Inner diameter of hollow main journals. Example: 20"""
    main_width: Size | None = None
    """Width of each main bearing. Example: 22"""
    main_length: Size | None = None
    """Length of each main journal between two webs, for the stiffness of a throw. Example: 26"""
    main_positions: Lengths | None = None
    """Axial positions of all main bearings, ascending; left out: half-way between neighbouring
    throws, and as far outside the end throws. Example: [-186, -93, 0, 93, 186]"""

    def _check_pin_width(self) -> Iterator[str]:
        if self.pin_width is not None and self.pin_diameter is None:
            yield "has pin_width without pin_diameter; give both pin_diameter and pin_width"

    def _check_main_diameter(self) -> Iterator[str]:
        """Check that sizes of the main journals come with their diameter, and the other way."""
        sizes = [key for key in ("main_width", "main_length") if self.has(key)]
        both = "give both main_diameter and main_width"
        if self.main_diameter is None:
            for key in sizes:
                wanted = both if key == "main_width" else f"give both main_diameter and {key}"
                yield f"has {key} without main_diameter; {wanted}"
        elif not sizes:
            yield f"has main_diameter without main_width; {both}"

    def _check_bores(self) -> Iterator[str]:
        """Check that a hollow journal has a diameter larger than its bore."""
        for kind in ("pin", "main"):
            yield from self.check_below(f"{kind}_bore", f"{kind}_diameter")
