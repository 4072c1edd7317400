"""Tables that chains of inertias and shafts share, wherever they are described: a shaft between two
nodes, and a damper on a node. Units: kg mm2, N m/rad, N m s/rad, mm, GPa, kg.
"""

import math
from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Field

from .fields import RIGID, Number, OneOf
from .model import FileTable, GivenInertia, Name, Size, TableRule
from .units import (
    ANGLE,
    INERTIA,
    MASS,
    PLAIN,
    SHEAR_MODULUS,
    STRESS,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
)


class _Stiffness(Number):
    """A torsional stiffness above 0, or "rigid"."""

    def __init__(self) -> None:
        super().__init__(TORSIONAL_STIFFNESS, above=0, most=1e24)

    def read(self, value: object) -> float:
        return math.inf if value == RIGID else super().read(value)

    def json(self) -> dict[str, Any]:
        return {"anyOf": [super().json(), {"const": RIGID}], "unit": TORSIONAL_STIFFNESS.unit}


class _PolarInertia(Number):
    """A moment of inertia above 0."""

    def __init__(self) -> None:
        super().__init__(INERTIA, above=0, most=1e24)

    def read(self, value: object) -> float:
        if value == 0 and not isinstance(value, bool):
            raise ValueError("is 0; leave it out where a node has no inertia")
        return super().read(value)


NodeInertia = Annotated[float, _PolarInertia()]
Stiffness = Annotated[float, _Stiffness()]
Damping = Annotated[float, Number(TORSIONAL_DAMPING, least=0, most=1e18)]
Loss = Annotated[float, Number(PLAIN, least=0, most=10)]
Modulus = Annotated[float, Number(SHEAR_MODULUS, above=0, most=1e6)]
StressLimit = Annotated[float, Number(STRESS, above=0, most=1e9)]
AngleLimit = Annotated[float, Number(ANGLE, above=0, most=1e3)]
_RingStiffness = Annotated[float, Number(TORSIONAL_STIFFNESS, above=0, most=1e24)]
_RingDamping = Annotated[float, Number(TORSIONAL_DAMPING, above=0, most=1e18)]
_PendulumMass = Annotated[float, Number(MASS, above=0, most=1e12)]


class ShaftKeys(FileTable):
    """What a shaft is like: its stiffness, or the steel that makes it; its section gives stress."""

    stiffness: Stiffness | None = Field(
        None,
        examples=[1.25e6],
        description="torsional stiffness in the shaft's own speed; rigid: a flange or a mesh",
    )
    diameter: Size | None = Field(
        None, examples=[85], description="diameter of the shaft: with it, stress is known"
    )
    length: Size | None = Field(
        None, examples=[400], description="length of a plain shaft, instead of stiffness"
    )
    bore: Size | None = Field(
        None, examples=[30], description="diameter of its bore, if it has one"
    )
    shear_modulus: Modulus = Field(
        79.3, examples=[79.3], description="of what a plain shaft is made of; default: steel"
    )
    loss: Loss | None = Field(
        None, examples=[0.035], description="loss factor, imaginary over real part of the stiffness"
    )
    damping: Damping = Field(
        0.0, examples=[20], description="of a dashpot between the ends of the shaft"
    )

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
        if self.bore is not None and (self.diameter is None or self.bore >= self.diameter):
            outer = "no diameter" if self.diameter is None else f"a diameter of {self.diameter:g}"
            yield f"has a bore of {self.bore:g} mm and {outer}; the bore is the smaller of both"

    rules = (
        TableRule(_check_length, {"stiffness", "length"}),
        TableRule(_check_stiffness, {"stiffness", "length", "diameter"}),
        TableRule(_check_bore, {"bore", "diameter"}),
    )


_KEYS_OF_KIND = {
    "viscous": ("inertia", "damping"),
    "rubber": ("inertia", "stiffness", "loss"),
    "pendulum": ("mass", "radius", "length"),
}


class Damper(FileTable):
    """A damper on a node."""

    kind: Annotated[str, OneOf(*_KEYS_OF_KIND)] = Field(
        examples=["viscous"],
        description="viscous: a ring in oil; rubber: a ring on rubber; pendulum: masses that swing "
        "in the field of rotation",
    )
    inertia: GivenInertia | None = Field(None, examples=[30000], description="of the ring")
    damping: _RingDamping | None = Field(None, examples=[12], description="of the oil film")
    stiffness: _RingStiffness | None = Field(None, examples=[40000], description="of the rubber")
    loss: Loss | None = Field(None, examples=[0.15], description="loss factor of the rubber")
    mass: _PendulumMass | None = Field(None, examples=[2], description="of all pendulums")
    radius: Size | None = Field(
        None, examples=[60], description="from the axis to where a pendulum hangs"
    )
    length: Size | None = Field(
        None, examples=[2.4], description="of a pendulum, from there to its centre of mass"
    )

    def _check_keys(self) -> Iterator[str]:
        wanted = _KEYS_OF_KIND[self.kind]
        given = self.model_fields_set - {"kind"}
        if missing := [key for key in wanted if key not in given]:
            yield f"is {self.kind} and lacks {' and '.join(missing)}"
        if strange := sorted(given - set(wanted)):
            yield f"is {self.kind}, which has no {' and no '.join(strange)}"

    rules = (TableRule(_check_keys, {"kind"}),)


class NodeKeys(FileTable):
    """What a node is like: its name, its inertia, and its damper."""

    name: Name = Field(examples=["flywheel"], description="what to call it; each its own")
    inertia: NodeInertia | None = Field(
        None, examples=[2.075e6], description="moment of inertia; left out: a massless node"
    )
    damper: Damper | None = Field(
        None,
        examples=[{"kind": "viscous", "inertia": 30000, "damping": 12}],
        description="a damper that it has",
    )


class ChainKeys(FileTable):
    """What holds for a whole chain: the loss of its shafts, and limits."""

    loss: Loss = Field(
        0.0, examples=[0.035], description="loss factor of every shaft that names none"
    )
    limit: StressLimit | None = Field(
        None, examples=[40], description="stress of a shaft above which a speed is barred"
    )
    angle_limit: AngleLimit | None = Field(
        None,
        examples=[0.3],
        description="angle by which the first node may swing either way; above, a speed is barred",
    )


def find_stiffness(shaft: ShaftKeys) -> float:
    """Torsional stiffness in N m/rad, `G pi (D^4 - d^4)/(32 L)` of a plain shaft."""
    if shaft.stiffness is not None or shaft.diameter is None or shaft.length is None:
        return math.inf if shaft.stiffness is None else shaft.stiffness
    outer, inner = shaft.diameter / 1e3, (shaft.bore or 0.0) / 1e3
    modulus = shaft.shear_modulus * 1e9
    return modulus * math.pi * (outer**4 - inner**4) / 32 / (shaft.length / 1e3)
