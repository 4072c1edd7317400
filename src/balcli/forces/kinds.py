"""Define the table of all kinds of forces and moments: names, symbols, keys, units, and what they
depend on.

All code that computes, shows, compares, records or searches kinds reads this table. A new kind that
is a sum of others needs only its line here; any other kind also needs its computation in
`core.loads`. `KINDS` are caused by inertia, and every engine has them; `GAS_KINDS` exist only for
engines with [gas].
"""

from typing import Literal, NamedTuple, get_args

Dimension = Literal["force", "moment"]
Cause = Literal["throws", "arms", "rods", "turning", "planes"]
EVERY_CAUSE: tuple[Cause, ...] = get_args(Cause)
_SI: dict[Dimension, str] = {"force": "N", "moment": "N·m"}
_UPRIGHT = {"force": ("vertical", "horizontal"), "moment": ("yawing", "pitching")}


class Kind(NamedTuple):
    """One kind of force or moment.

    Attributes:
        name: Name in lists of kinds and in quantities (`force.2.major`); attribute of `Spectra`.
        label: Words for headings and legends.
        symbol: Symbol for formulas and narrow columns.
        key: Key in JSON, with its SI unit as the ending.
        vector: Whether it is a vector of the x-y plane; a scalar acts about the crank's axis.
        dimension: Force or moment.
        plus: Names of the kinds that are added to give this kind, if any.
        minus: Names of the kinds that are subtracted to give this kind, if any.
        on_crank: Whether it is a torque on the crank; otherwise it acts on the frame.
        causes: What it depends on, besides pistons and crank angles: masses of throws ("throws");
            the same if the point of reference is off the crank's axis ("arms"); inertia of rods
            ("rods"); inertia that turns with the crank at uneven speed ("turning"); axial positions
            ("planes"). Results list the assumed values of these. Default: all of them.
        meaning: Meaning in the list of quantities (`balcli numbers`); empty: the label.
        description: Description in the JSON Schema; empty: the label.
    """

    name: str
    label: str
    symbol: str
    key: str
    vector: bool = False
    dimension: Dimension = "moment"
    plus: tuple[str, ...] = ()
    minus: tuple[str, ...] = ()
    on_crank: bool = False
    causes: tuple[Cause, ...] = EVERY_CAUSE
    meaning: str = ""
    description: str = ""

    @property
    def si_unit(self) -> str:
        """SI unit, N or N·m."""
        return _SI[self.dimension]

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of the kinds from which this one is computed: its terms, or itself."""
        return (*self.plus, *self.minus) or (self.name,)

    @property
    def upright(self) -> tuple[str, str]:
        """Names of a vector's components along `frame.up` and along the axis 90 deg ahead of it."""
        return _UPRIGHT[self.dimension]

    def tell_axis(self, axis: str) -> str:
        """Return "along" an axis for a force, or "about" it for a moment."""
        return f"{'along' if self.dimension == 'force' else 'about'} {axis}"

    def name_components(self, up_deg: float | None) -> tuple[str, str]:
        """Return the names of a vector's components: vertical and horizontal if `up_deg` is known,
        else x and y.
        """
        if up_deg is None:
            return f"{self.name} {self.tell_axis('x')}", f"{self.name} {self.tell_axis('y')}"
        return f"{self.upright[0]} {self.name}", f"{self.upright[1]} {self.name}"

    def key_along(self, axis: str) -> str:
        """Return the JSON key of the component along an axis, such as `force_x_N`."""
        stem, _, unit = self.key.rpartition("_")
        return f"{stem}_{axis}_{unit}"


FORCE = Kind(
    "force",
    "free force",
    "F",
    "force_N",
    vector=True,
    dimension="force",
    causes=("throws",),
    description="Free force.",
)
MOMENT = Kind(
    "moment",
    "free moment",
    "M",
    "moment_Nm",
    vector=True,
    causes=("throws", "planes"),
    description="Free moment about the point of reference.",
)
COUPLE = Kind(
    "couple",
    "couple C",
    "C",
    "couple_Nm",
    causes=("rods", "arms", "turning"),
    meaning="free couple of the rods",
    description="Free couple about z through the point of reference.",
)
TORQUE = Kind(
    "torque",
    "inertia torque T",
    "T",
    "inertia_torque_Nm",
    on_crank=True,
    causes=("rods", "turning"),
    meaning="torque on the crank, gas included",  # `torque` of an engine with gas is the total
    description="Torque of the inertia on the crank.",
)
ROLL = Kind(
    "roll",
    "roll moment",
    "C − T",
    "roll_Nm",
    plus=("couple",),
    minus=("torque",),
    causes=("rods", "arms"),
    meaning="roll of the block by inertia",
    description="Roll of the frame: couple minus inertia torque.",
)

GAS = Kind(
    "gas",
    "gas torque",
    "Tg",
    "gas_torque_Nm",
    on_crank=True,
    causes=(),
    meaning="torque of the gas",
    description="Torque of the gas on the crank.",
)
TORQUE_TOTAL = Kind(
    "torque_total",
    "total torque",
    "T + Tg",
    "torque_Nm",
    plus=("torque", "gas"),
    on_crank=True,
    causes=("rods", "turning"),
    meaning="torque of gas and inertia",
    description="Torque of inertia and gas on the crank.",
)
ROLL_TOTAL = Kind(
    "roll_total",
    "total roll",
    "C − T − Tg",
    "roll_total_Nm",
    plus=("couple",),
    minus=("torque", "gas"),
    causes=("rods", "arms"),
    meaning="roll of the block, gas included",
    description="Roll of the frame with gas.",
)

KINDS = {kind.name: kind for kind in (FORCE, MOMENT, COUPLE, TORQUE, ROLL)}
GAS_KINDS = {kind.name: kind for kind in (GAS, TORQUE_TOTAL, ROLL_TOTAL)}  # with gas only
EVERY_KIND = KINDS | GAS_KINDS
FREE = (FORCE, MOMENT)  # have peaks, verdicts and pictures of their own


def list_with(cause: Cause) -> set[str]:
    """Return the names of the kinds that depend on a cause."""
    return {kind.name for kind in EVERY_KIND.values() if cause in kind.causes}


# Default quantities (see quantity.py) of variants in sweep, search and scatter.
DEFAULT_QUANTITIES = "force.1.major,force.2.major,moment.1.major,moment.2.major"
