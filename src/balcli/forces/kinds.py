"""Define the table of all kinds of forces and moments: names, symbols, keys and units.

All code that computes, shows, compares, records or searches kinds reads this table. A new kind
needs a line here, an attribute of `spectrum.Spectra`, and its computation. `KINDS` are caused by
inertia, and every engine has them; `GAS_KINDS` exist only for engines with [gas].
"""

from __future__ import annotations

from typing import Literal, NamedTuple

Dimension = Literal["force", "moment"]
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
    """

    name: str
    label: str
    symbol: str
    key: str
    vector: bool = False
    dimension: Dimension = "moment"
    plus: tuple[str, ...] = ()
    minus: tuple[str, ...] = ()

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


FORCE = Kind("force", "free force", "F", "force_N", vector=True, dimension="force")
MOMENT = Kind("moment", "free moment", "M", "moment_Nm", vector=True)
COUPLE = Kind("couple", "couple C", "C", "couple_Nm")
TORQUE = Kind("torque", "inertia torque T", "T", "inertia_torque_Nm")
ROLL = Kind("roll", "roll moment", "C − T", "roll_Nm", plus=("couple",), minus=("torque",))

GAS = Kind("gas", "gas torque", "Tg", "gas_torque_Nm")
TORQUE_TOTAL = Kind("torque_total", "total torque", "T + Tg", "torque_Nm", plus=("torque", "gas"))
ROLL_TOTAL = Kind(
    "roll_total",
    "total roll",
    "C − T − Tg",
    "roll_total_Nm",
    plus=("couple",),
    minus=("torque", "gas"),
)

KINDS = {kind.name: kind for kind in (FORCE, MOMENT, COUPLE, TORQUE, ROLL)}
GAS_KINDS = {kind.name: kind for kind in (GAS, TORQUE_TOTAL, ROLL_TOTAL)}  # with gas only
EVERY_KIND = KINDS | GAS_KINDS
# Default quantities (see quantity.py) of variants in sweep, search and scatter.
DEFAULT_QUANTITIES = "force.1.major,force.2.major,moment.1.major,moment.2.major"
VECTORS = tuple(kind for kind in KINDS.values() if kind.vector)
SCALARS = tuple(kind for kind in KINDS.values() if not kind.vector)
