"""Compute the torsional stiffness of a throw from its dimensions, by the formulas of Ker Wilson and
of Carter.

Both add up the flexibility of main journal, crank pin and webs. Ker Wilson's formula suits stiff
webs, Carter's soft ones. Measured crankshafts differ from both by about 10 to 15 %.

Source: W. Ker Wilson, Practical Solution of Torsional Vibration Problems, vol. 1; both formulas
also in T. Feese and C. Hill, Guidelines for Preventing Torsional Vibration Problems in
Reciprocating Machinery (2002), section 2.1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal, NamedTuple

import numpy as np

from ..core.vibration import Indices, Real
from ..engine.engine import Engine
from ..errors import Problem
from ..file.doubt import Doubt
from ..file.fields import join_words
from ..file.model import EngineFile
from ..file.torsion_tables import CARTER, KER_WILSON, Torsion

Used = Literal["mean", "ker-wilson", "carter", "file"]
_PATH = "torsion.throw_stiffness"
_SPREAD_MOST = 0.15  # spread of the formulas above which neither fits the webs well
_ALIKE = 1e-9  # relative difference below which two strokes are equal


class ThrowSize(NamedTuple):
    """Dimensions of a throw, m, and its shear modulus, Pa.

    Attributes:
        radius: Crank radius.
        journal_length: Length of the main journal between two webs.
        journal_diameter: Diameter of the main journal.
        journal_bore: Its bore; 0 if it is solid.
        pin_length: Length of the crank pin between its two webs.
        pin_diameter: Diameter of the crank pin.
        pin_bore: Its bore; 0 if it is solid.
        thickness: Thickness of a web along the shaft.
        width: Width of a web across the shaft, half-way between pin and journal.
        shear_modulus: Shear modulus.
    """

    radius: float
    journal_length: float
    journal_diameter: float
    journal_bore: float
    pin_length: float
    pin_diameter: float
    pin_bore: float
    thickness: float
    width: float
    shear_modulus: float

    @property
    def _journal(self) -> float:
        """D^4 - d^4 of the main journal."""
        return self.journal_diameter**4 - self.journal_bore**4

    @property
    def _pin(self) -> float:
        """D^4 - d^4 of the crank pin."""
        return self.pin_diameter**4 - self.pin_bore**4

    @property
    def free_radius(self) -> float:
        """Length of a web that twists freely by Ker Wilson: R - 0.2 (D_j + D_c)."""
        return self.radius - 0.2 * (self.journal_diameter + self.pin_diameter)

    @property
    def ker_wilson(self) -> float | None:
        """Stiffness of a throw by Ker Wilson, N m/rad: `pi G/(32 S)` with
        `S = (L_j + 0.4 D_j)/(D_j^4 - d_j^4) + (L_c + 0.4 D_c)/(D_c^4 - d_c^4) +
        (R - 0.2 (D_j + D_c))/(h W^3)`; None if journal and pin overlap.
        """
        if self.free_radius <= 0:
            return None
        journal = (self.journal_length + 0.4 * self.journal_diameter) / self._journal
        pin = (self.pin_length + 0.4 * self.pin_diameter) / self._pin
        web = self.free_radius / (self.thickness * self.width**3)
        return math.pi * self.shear_modulus / (32 * (journal + pin + web))

    @property
    def carter(self) -> float:
        """Stiffness of a throw by Carter, N m/rad: `pi G/(32 S)` with
        `S = (L_j + 0.8 h)/(D_j^4 - d_j^4) + 0.75 L_c/(D_c^4 - d_c^4) + 1.5 R/(h W^3)`.
        """
        journal = (self.journal_length + 0.8 * self.thickness) / self._journal
        pin = 0.75 * self.pin_length / self._pin
        web = 1.5 * self.radius / (self.thickness * self.width**3)
        return math.pi * self.shear_modulus / (32 * (journal + pin + web))

    @property
    def weakest_section(self) -> tuple[float, float]:
        """Diameter and bore of the journal or pin with the larger stress under a torque, m."""
        journal = self.journal_diameter / self._journal
        pin = self.pin_diameter / self._pin
        if journal >= pin:
            return self.journal_diameter, self.journal_bore
        return self.pin_diameter, self.pin_bore


class ThrowStiffness(NamedTuple):
    """Stiffness of the throws by two formulas, N m/rad.

    Attributes:
        ker_wilson: By Ker Wilson; None if journal and pin overlap.
        carter: By Carter.
        used: Used stiffness; None if the file gives several.
        source: What the used stiffness is: a formula, the mean of both, or the file's.
        shafts: Indices of the shafts between throws.
        size: Dimensions from which both formulas follow.
    """

    ker_wilson: float | None
    carter: float
    used: float | None
    source: Used
    shafts: Indices
    size: ThrowSize

    @property
    def spread(self) -> float | None:
        """Difference of the two formulas over their mean."""
        if self.ker_wilson is None:
            return None
        return 2 * abs(self.ker_wilson - self.carter) / (self.ker_wilson + self.carter)

    @property
    def follows(self) -> bool:
        """Whether the used stiffness follows from dimensions."""
        return self.source != "file"

    def list_doubts(self) -> Iterator[Doubt]:
        """Yield a warning of formulas that differ much, if one of them is used."""
        if self.follows and self.spread is not None and self.spread > _SPREAD_MOST:
            message = (
                f"follows from dimensions, but the formulas differ by {self.spread:.0%}: "
                f"{self.ker_wilson:.4g} N m/rad by Ker Wilson, for stiff webs, and "
                f"{self.carter:.4g} N m/rad by Carter, for soft webs; give a measured stiffness, "
                "or the formula that suits the webs"
            )
            yield Doubt(_PATH, message)


def find_web_thickness(model: EngineFile) -> float | None:
    """Return the thickness of the webs, mm: that of [torsion], else that of [[web]] if all webs
    have the same.
    """
    if model.torsion is not None and model.torsion.web_thickness is not None:
        return model.torsion.web_thickness
    thicknesses = {web.thickness for web in model.web}
    if len(thicknesses) != 1:
        return None
    (thickness,) = thicknesses
    return thickness if math.isfinite(thickness) else None


def _find_dimensions(model: EngineFile) -> dict[str, float | None]:
    """Return the dimensions of a throw by their paths, mm; None: the file does not give one."""
    torsion = model.torsion
    bearing = model.bearing
    dimensions: dict[str, float | None] = {}
    for key in ("main_diameter", "main_length", "pin_diameter", "pin_length"):
        dimensions[f"bearing.{key}"] = None if bearing is None else getattr(bearing, key)
    dimensions["torsion.web_thickness"] = find_web_thickness(model)
    dimensions["torsion.web_width"] = None if torsion is None else torsion.web_width
    return dimensions


def list_missing(model: EngineFile) -> list[str]:
    """Return the paths of the dimensions of a throw that a file does not give."""
    return [path for path, value in _find_dimensions(model).items() if value is None]


def _list_radii(engine: Engine) -> Real:
    """Return the crank radii of all throws, m."""
    return np.array([float(np.ravel(radius)[0]) for radius in engine.throw_radii_m])


def _have_one_radius(engine: Engine) -> bool:
    radii = _list_radii(engine)
    return bool(np.ptp(radii) <= _ALIKE * radii.max())


def find_throw_size(model: EngineFile, engine: Engine) -> ThrowSize | None:
    """Return the dimensions of the throws; None if the file does not give all of them, or the
    throws differ.
    """
    dimensions = _find_dimensions(model)
    torsion = model.torsion
    bearing = model.bearing
    if None in dimensions.values() or torsion is None or bearing is None:
        return None
    if not _have_one_radius(engine):
        return None
    in_m = {path.partition(".")[2]: (value or 0.0) / 1e3 for path, value in dimensions.items()}
    return ThrowSize(
        radius=float(_list_radii(engine)[0]),
        journal_length=in_m["main_length"],
        journal_diameter=in_m["main_diameter"],
        journal_bore=bearing.main_bore / 1e3,
        pin_length=in_m["pin_length"],
        pin_diameter=in_m["pin_diameter"],
        pin_bore=bearing.pin_bore / 1e3,
        thickness=in_m["web_thickness"],
        width=in_m["web_width"],
        shear_modulus=torsion.shear_modulus * 1e9,
    )


def find_throw_stiffness(
    torsion: Torsion, size: ThrowSize | None, shafts: Indices
) -> ThrowStiffness | None:
    """Return the stiffness of the throws by both formulas; None without their dimensions.

    Args:
        torsion: Table [torsion], without contradictions (`find_problems`).
        size: Dimensions of the throws.
        shafts: Indices of the shafts between throws.
    """
    if size is None or not len(shafts):
        return None
    ker_wilson = size.ker_wilson
    carter = size.carter
    used: float | None
    source: Used
    if torsion.given_stiffness:
        source = "file"
        used = torsion.given_stiffness[0] if len({*torsion.given_stiffness}) == 1 else None
    elif torsion.throw_stiffness == CARTER:
        source = "carter"
        used = carter
    elif torsion.throw_stiffness == KER_WILSON:
        source = "ker-wilson"
        used = ker_wilson
    else:
        source = "mean"
        used = None if ker_wilson is None else (ker_wilson + carter) / 2
    return ThrowStiffness(ker_wilson, carter, used, source, shafts, size)


def find_problems(model: EngineFile, engine: Engine, throws: str) -> Iterator[Problem]:
    """Yield why the stiffness of throws, which the file does not give as a number, does not follow
    from dimensions.

    Args:
        model: Engine file with [torsion].
        engine: Engine of this file.
        throws: Number of throws, in words.
    """
    formula = model.torsion and model.torsion.throw_stiffness
    missing = list_missing(model)
    if missing:
        lacking = f"{join_words(missing)} {'is' if len(missing) == 1 else 'are'} missing"
        if formula is not None:
            yield Problem(_PATH, f'is "{formula}", but {lacking}')
            return
        hint = (
            f"give the stiffness between the {throws}, such as throw_stiffness = 1.25e6, or the "
            f"dimensions of a throw, of which {lacking}"
        )
        yield Problem.of_missing(_PATH, hint)
        return
    if not _have_one_radius(engine):
        strokes = join_words(f"{2e3 * radius:g}" for radius in np.unique(_list_radii(engine)))
        text = (
            f"follows from the dimensions of one throw, but the strokes differ ({strokes} mm); "
            "give throw_stiffness as a list"
        )
        yield Problem(_PATH, text)
        return
    size = find_throw_size(model, engine)
    if size is not None and size.ker_wilson is None and formula != CARTER:
        text = (
            "overlap of journal and pin: crank radius - 0.2 (main_diameter + pin_diameter) is "
            f"{1e3 * size.free_radius:.4g} mm, so Ker Wilson's formula does not hold; give "
            "throw_stiffness"
        )
        yield Problem(_PATH, text)
