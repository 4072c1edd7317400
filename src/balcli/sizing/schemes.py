"""Names of the balance schemes, the options that each takes, and a line that describes each. This
module loads no library.
"""

from __future__ import annotations

SCHEMES: dict[str, tuple[str, ...]] = {
    "auto": (),
    "complete": (),
    "step": ("step",),
    "counterweights": ("order", "planes"),
    "factor": ("factor", "measured", "planes"),
    "minimax": ("planes", "position", "orders"),
    "ellipse": ("direction", "ratio", "planes", "position"),
    "single-shaft": ("order", "at", "position", "planes"),
    "two-shaft": ("order", "at", "position", "roll"),
    "four-shaft": ("at", "position"),
    "couple-shaft": ("order", "at", "planes"),
    "compensator": ("order", "at", "position"),
    "slider": ("order", "at", "position"),
    "eccentric-slider": ("design", "criterion", "radius"),
    "oldham": ("radius",),
}


DESIGNS = ("a", "b")  # a: pin on the shaft, slot in the disc; b: pin on the disc, slot on the shaft
CRITERIA = ("largest", "mean")  # force that shafts of uneven speed leave, to be minimised


LADDER = ("auto", "step")  # schemes that fit steps of the ladder


KNUCKLES = "knuckles"  # fits no device, but changes the engine file (balcli.balancing.answer)


FIT = "fit"  # fits the devices that the file leaves open (balcli.sizing.fit)


NAMES = (*SCHEMES, KNUCKLES, FIT)


# Description of each scheme.
MEANINGS = {
    "auto": "orders 1 and 2: counterweights, then shafts where they cancel enough",
    "complete": "all of orders 1 and 2, however small: counterweights, then shafts",
    "step": "a step of the ladder that balance prints, by its name or number",
    "counterweights": "against rotating masses and the part of order 1 that turns with the crank",
    "factor": "the shop's balance factor, with the bobweight card",
    "minimax": "the counterweight that leaves the smallest peak force",
    "ellipse": "the counterweight that leaves order 1 a wanted direction and shape",
    "single-shaft": "one shaft against the crank, and counterweights for the rest",
    "two-shaft": "two shafts turning against each other: force of one order",
    "four-shaft": "two such pairs, for the forces of orders 1 and 2",
    "couple-shaft": "shafts with two opposite eccentrics: moment of one order",
    "compensator": "pairs of masses far from the engine: vertical moment of one order",
    "slider": "reciprocating masses along the axes of one order's ellipse",
    "eccentric-slider": "a pair of shafts of variable speed, for one cylinder",
    "oldham": "an Oldham coupling for orders 1 and 2 of one cylinder",
    KNUCKLES: "knuckle angles for even dead centres or strokes (articulated)",
    FIT: 'devices whose unbalance is "fit" in the file, in their places',
}
