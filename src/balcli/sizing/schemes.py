"""The balance schemes by name, for messages, help and completion; nothing is imported to know
them.
"""

from __future__ import annotations

from typing import NamedTuple


class Scheme(NamedTuple):
    """In which module of `sizing` the function of a scheme is, and the options it takes."""

    room: str
    options: tuple[str, ...] = ()


SCHEMES = {
    "auto": Scheme("auto"),
    "counterweights": Scheme("counterweights", ("order", "planes")),
    "factor": Scheme("counterweights", ("factor",)),
    "minimax": Scheme("counterweights", ("planes", "position")),
    "single-shaft": Scheme("shafts", ("order", "at", "position")),
    "two-shaft": Scheme("shafts", ("order", "at", "position", "roll")),
    "four-shaft": Scheme("shafts", ("at", "position")),
    "couple-shaft": Scheme("shafts", ("order", "at", "planes")),
    "slider": Scheme("shafts", ("order", "at", "position")),
    "eccentric-slider": Scheme("single_cylinder"),
    "oldham": Scheme("single_cylinder"),
}
KNUCKLES = "knuckles"  # fits no device, but changes the engine file (balcli.results.knuckles)
NAMES = (*SCHEMES, KNUCKLES)
