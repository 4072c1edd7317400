"""Tables of a radial engine whose rods are hinged to a master rod, in the units of the file.

They are imported for files that have them (`messages.CHAPTERS`).
"""

from pydantic import Field

from .model import Angles, Count, FileTable, Length, Mass, Rod, Size


class ArticulatedRod(Rod):
    """An articulated rod, from its knuckle pin (its big end) to its piston pin."""

    length: Size | None = Field(
        None, description="from the knuckle pin to the piston pin", examples=[200]
    )
    cg: Length | None = Field(
        None, description="from the knuckle pin to the centre of mass", examples=[100]
    )
    big_end: Mass | None = Field(
        None, description="mass weighed at the knuckle pin, instead of mass and cg", examples=[0.3]
    )


class Articulation(FileTable):
    """A radial with one master rod, to which the others are hinged."""

    master: Count = Field(
        1, description="number of the bank that carries the master rod", examples=[1]
    )
    knuckle_radius: Size = Field(
        description="from the crank pin to the knuckle pins", examples=[55]
    )
    knuckle_angles: Angles | None = Field(
        None,
        examples=[[0, 72, 144, 216, 288]],
        description="one for each bank, from the master rod's axis (its own is 0); left out: bank "
        "angles from it",
    )
    rod: ArticulatedRod = Field(description="the articulated rods")
