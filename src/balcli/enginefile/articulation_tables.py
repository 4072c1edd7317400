"""Tables of a radial engine whose rods are hinged to a master rod, in the units of the file.

They are imported for files that have them (`messages.CHAPTERS`).
"""

from .model import Angles, Count, FileTable, Length, Mass, Rod, Size, key, needed


class ArticulatedRod(Rod):
    """An articulated rod, from its knuckle pin (its big end) to its piston pin."""

    length: Size | None = key("from the knuckle pin to the piston pin", 200)
    cg: Length | None = key("from the knuckle pin to the centre of mass", 100)
    big_end: Mass | None = key("mass weighed at the knuckle pin, instead of mass and cg", 0.3)


class Articulation(FileTable):
    """A radial with one master rod, to which the others are hinged."""

    master: Count = key("number of the bank that carries the master rod", 1, default=1)
    knuckle_radius: Size = needed("from the crank pin to the knuckle pins", 55)
    knuckle_angles: Angles | None = key(
        "one for each bank, from the master rod's axis (its own is 0); left out: bank angles from "
        "it",
        [0, 72, 144, 216, 288],
    )
    rod: ArticulatedRod = needed("the articulated rods")
