"""Table [torsion] of an engine file: what its crankshaft and all that hangs on it are like when
they twist.

It is imported for files that have it.
"""

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import Field

from ..limits import MOST_TORSION_NODES
from .fields import Number, counted, shorten
from .model import Name, Size, TableRule
from .shafting import ChainKeys, Damping, NodeKeys, ShaftKeys
from .units import INERTIA, PLAIN, TORSIONAL_STIFFNESS, Dimension


class SpeedRatio(Number):
    """A speed ratio: not 0, negative where gears turn the other way."""

    def __init__(self) -> None:
        super().__init__(PLAIN, most=1e6)

    def read(self, value: object) -> float:
        ratio = super().read(value)
        if abs(ratio) < 1e-6:
            raise ValueError(f"{ratio:g} is no speed ratio; give driven over driving speed, not 0")
        return ratio


class _EachOrAll(Number):
    """One figure above 0 for all throws, or a list of them."""

    def __init__(self, dimension: Dimension) -> None:
        super().__init__(dimension, above=0, most=1e24)

    def read(self, value: object) -> tuple[float, ...]:  # type: ignore[override]
        if not isinstance(value, list):
            return (super().read(value),)
        if not 1 <= len(value) <= MOST_TORSION_NODES:
            raise ValueError(
                f"{shorten(value)} has {counted(len(value), 'value')}; give one for all, or a list "
                f"of up to {MOST_TORSION_NODES}"
            )
        return tuple(super(_EachOrAll, self).read(each) for each in value)

    def json(self) -> dict[str, Any]:
        items = {"type": "array", "items": super().json(), "minItems": 1}
        return {"anyOf": [super().json(), items], "unit": self.dimension.unit}


class Part(ShaftKeys, NodeKeys):
    """What turns with the crankshaft before or behind its throws, and the shaft that leads to
    it from the throws.
    """

    gear: Annotated[float, SpeedRatio()] | None = Field(
        None,
        description="speed over that of the crank; left out: as fast as what it hangs on. The mesh "
        "sits there, and the shaft turns with this part",
        examples=[0.5],
    )
    of: Name | None = Field(
        None,
        description="what it hangs on, a part or throw 1, throw 2, ...; left out: the part before "
        "it in the list, the first on the nearest throw",
        examples=["throw 1"],
    )
    node_damping: Damping = Field(
        0.0, description="of the part against ground, as water damps a propeller", examples=[5]
    )


_Parts = Annotated[tuple[Part, ...], Field(max_length=MOST_TORSION_NODES)]


class Torsion(ChainKeys):
    """Torsional vibration: a node for each throw, and the parts before and behind them."""

    throw_stiffness: Annotated[tuple[float, ...], _EachOrAll(TORSIONAL_STIFFNESS)] | None = Field(
        None,
        description="torsional stiffness between neighbouring throws, or a list of all",
        examples=[1.25e6],
    )
    throw_inertia: Annotated[tuple[float, ...], _EachOrAll(INERTIA)] | None = Field(
        None,
        description="moment of inertia of the crankshaft at each throw, its own mass and "
        "counterweights included, without rods and pistons; or a list of all; left out: an equal "
        "share of crank.inertia",
        examples=[46700],
    )
    throw_diameter: Size | None = Field(
        None,
        description="diameter of the crankshaft between throws: with it, stress is known",
        examples=[85],
    )
    throw_bore: Size | None = Field(
        None, description="diameter of its bore, if it has one", examples=[30]
    )
    damping: Damping = Field(0.0, description="at every cylinder, against ground", examples=[2])
    front: _Parts = Field((), description="parts before the first throw, outward")
    rear: _Parts = Field((), description="parts behind the last throw, outward")

    def _check_bore(self) -> Iterator[str]:
        if self.throw_bore is not None and (
            self.throw_diameter is None or self.throw_bore >= self.throw_diameter
        ):
            yield "has a throw_bore without a larger throw_diameter; the bore lies within the shaft"

    rules = (TableRule(_check_bore, {"throw_bore", "throw_diameter"}),)
