"""Tables of an engine file about gas pressure, crank torque and flywheel: [gas], [flywheel] and
[bearing].

They are imported for files that have them (`names.CHAPTERS`).
"""

from collections.abc import Iterator
from typing import Annotated

from .fields import Choice, FileName, Number, OneOf, join_words
from .table import Angle, Distance, FileTable, GivenInertia, Heat, Mass, Size
from .units import ANGLE, PLAIN, PRESSURE

Pressure = Annotated[float, Number(PRESSURE, least=0, most=1e6)]
MeanPressure = Annotated[float, Number(PRESSURE, most=1e6)]

_GOALS = ("imep", "bmep", "max_pressure", "cut_off", "heat")
DIAGRAM_KEYS = ("zero", "phase", "pressure")
WIEBE_KEYS = ("burn_start", "burn_duration", "burn_shape")
_CYCLE_KEYS = (
    *("compression_index", "expansion_index", "intake", "exhaust"),
    *("exhaust_opens", "intake_closes", "bmep", "max_pressure", "cut_off", "heat"),
    *WIEBE_KEYS,
)


class Gas(FileTable):
    """Pressure on the pistons over a cycle: measured, computed, or as harmonics of its torque."""

    choices = (Choice((("indicator",), ("cycle",), ("harmonics",)), required=True),)

    indicator: Annotated[str, FileName()] | None = None
    """A measured diagram: CSV next to the engine file, headed angle_deg,pressure_bar (or _MPa,
    _kPa, _Pa, _psi; over the atmosphere _barg, _psig). Example: 'p_2000rpm.csv'"""
    zero: Annotated[str, OneOf("firing", "gas-exchange")] = "firing"
    """The dead centre at angle 0 of the diagram. Example: 'gas-exchange'"""
    phase: Angle = 0.0
    """Added to the angles of the diagram. Example: -0.5"""
    pressure: Annotated[str, OneOf("absolute", "gauge")] = "absolute"
    """Gauge: above the atmosphere of 1.01325 bar. Example: 'gauge'"""
    cycle: Annotated[str, OneOf("otto", "diesel", "dual", "wiebe")] | None = None
    """A computed cycle, by how it burns. Example: 'wiebe'"""
    compression_ratio: Annotated[float, Number(PLAIN, above=1, most=1000)] | None = None
    """Largest over smallest volume of the cylinder; with a diagram it gives the volume.
    Example: 10.5"""
    compression_index: Annotated[float, Number(PLAIN, least=1, most=5)] = 1.32
    """n of p V^n = const. Example: 1.35"""
    expansion_index: Annotated[float, Number(PLAIN, above=1, most=5)] = 1.28
    """n of p V^n = const, and while it burns. Example: 1.27"""
    intake: Annotated[float, Number(PRESSURE, above=0, most=1e6)] = 1.0
    """Absolute, while it is filled. Example: 1.8"""
    exhaust: Pressure = 1.05
    """Absolute, while it empties; four-stroke. Example: 1.3"""
    imep: MeanPressure | None = None
    """Indicated mean effective pressure that the cycle is to have; with a diagram: its expected
    value. Example: 10"""
    bmep: MeanPressure | None = None
    """Instead of imep, with mechanical_efficiency. Example: 8.5"""
    mechanical_efficiency: Annotated[float, Number(PLAIN, above=0, most=1)] | None = None
    """Brake over indicated mean effective pressure. Example: 0.85"""
    max_pressure: Pressure | None = None
    """Absolute; that the cycle is to have, or (dual) at which it burns on. Example: 70"""
    cut_off: Annotated[float, Number(PLAIN, least=1, most=1000)] | None = None
    """Volume after over before burning at constant pressure. Example: 2"""
    heat: Heat | None = None
    """Supplied in each cycle of a cylinder. Example: 1400"""
    burn_start: Angle = -15.0
    """Wiebe: cycle angle. Example: -10"""
    burn_duration: Annotated[float, Number(ANGLE, above=0, most=720)] = 50.0
    """Wiebe: crank angle. Example: 60"""
    burn_shape: Annotated[float, Number(PLAIN, least=0, most=100)] = 2.0
    """Wiebe: exponent m. Example: 1.5"""
    exhaust_opens: Annotated[float, Number(ANGLE, above=0, most=360)] | None = None
    """Cycle angle; left out: lower dead centre. Example: 140"""
    intake_closes: Annotated[float, Number(ANGLE, least=360, below=720)] | None = None
    """Cycle angle, four-stroke; left out: lower dead centre. Example: 580"""
    harmonics: Annotated[str, FileName()] | None = None
    """Builders' table: CSV of order,cos,sin of the mean tangential pressure T/(A r), bar, from
    the firing dead centre. Example: 'tangential.csv'"""
    crankcase: Pressure = 1.0
    """Absolute, under the pistons. Example: 1.1"""

    @property
    def goals(self) -> tuple[str, ...]:
        """Keys of which exactly one sets the heat; the highest pressure of a dual cycle stands next
        to it.
        """
        return tuple(key for key in _GOALS if key != "max_pressure" or self.cycle != "dual")

    def rivals(self, key: str) -> tuple[str, ...]:
        goals = self.goals if key in self.goals else ()
        return (*super().rivals(key), *(goal for goal in goals if goal != key))

    def list_idle_keys(self, strokes: int, measured: bool, computed: bool) -> set[str]:
        """Return the keys of figures that change nothing of the gas in this engine.

        Args:
            strokes: 2 or 4.
            measured: Whether a cylinder has a diagram.
            computed: Whether a cylinder has a computed cycle.
        """
        idle: set[str] = set()
        if not computed:
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

    def list_assumed(self, strokes: int, measured: bool, computed: bool) -> Iterator[str]:
        """Defaults that count in an engine of so many strokes, as `list_idle_keys` takes it."""
        idle = self.list_idle_keys(strokes, measured, computed) | {"phase", "zero", "pressure"}
        at_dead_centre = dict.fromkeys(("exhaust_opens", "intake_closes"), "lower dead centre")
        for key in type(self).model_fields:
            value = getattr(self, key)
            left_out = not self.has(key) and key not in idle
            if left_out and (value is not None or key in at_dead_centre):
                yield f"gas.{key} = {at_dead_centre.get(key) or format(value, 'g')}"

    def _check_misplaced(self) -> Iterator[str]:
        """Find keys of a computed cycle without one."""
        others = [key for key in _CYCLE_KEYS if key in self.model_fields_set]
        if others and self.cycle is None and (self.indicator or self.harmonics):
            what = "indicator" if self.indicator else "harmonics"
            yield f"has {join_words(others)} with {what}; these belong to a computed cycle"

    def _check_cycle(self) -> Iterator[str]:
        """Check that a computed cycle has its keys, and exactly one figure that sets the heat."""
        if self.cycle is None:
            return
        wiebe = [key for key in WIEBE_KEYS if key in self.model_fields_set]
        if wiebe and self.cycle != "wiebe":
            yield f"has {join_words(wiebe)}, which only a wiebe cycle has"
        given = [key for key in self.goals if self.has(key)]
        choice = f"give one of {join_words(self.goals)}"
        if len(given) > 1:
            yield f"has {join_words(given)}; {choice}"
        elif not given:
            yield f"does not say how much is burnt; {choice}"
        if self.cycle == "dual" and self.max_pressure is None:
            yield "needs max_pressure for a dual cycle, at which it burns on"
        if self.bmep is not None and self.mechanical_efficiency is None:
            yield "has bmep without mechanical_efficiency; give both, or imep"
        if self.compression_ratio is None:
            yield "needs compression_ratio for a computed cycle, such as compression_ratio = 10.5"


class Flywheel(FileTable):
    """A flywheel, or all that turns with the crankshaft beyond it. [torsion] has its own."""

    choices = (
        Choice((("inertia",), ("mass", "radius_of_gyration")), required=True, complete=True),
    )

    inertia: GivenInertia | None = None
    """Polar moment of inertia. Example: 250000"""
    mass: Mass | None = None
    """With radius_of_gyration, instead of inertia. Example: 12"""
    radius_of_gyration: Size | None = None
    """With mass, instead of inertia. Example: 140"""


class Bearing(FileTable):
    """Bearings of the crankshaft, for loads per area."""

    choices = (
        Choice((("pin_diameter", "pin_width"),), complete=True),
        Choice((("main_diameter", "main_width"),), complete=True),
    )

    pin_diameter: Size | None = None
    """Of the crank pins. Example: 48"""
    pin_bore: Distance = 0.0
    """Inner diameter of hollow crank pins. Example: 20"""
    pin_width: Size | None = None
    """Of each rod's bearing. Example: 20"""
    main_diameter: Size | None = None
    """Of the main journals. Example: 60"""
    main_bore: Distance = 0.0
    """Inner diameter of hollow main journals. Example: 20"""
    main_width: Size | None = None
    """Of each main bearing. Example: 22"""

    def _check_bores(self) -> Iterator[str]:
        """A hollow journal has a diameter, above that of its bore."""
        for kind in ("pin", "main"):
            bore, diameter = getattr(self, f"{kind}_bore"), getattr(self, f"{kind}_diameter")
            if bore and (diameter is None or bore >= diameter):
                wanted = "" if diameter is None else f" = {diameter:g} mm"
                yield f"{kind}_bore = {bore:g} mm: has to be below {kind}_diameter{wanted}"
