"""The balance schemes by name, for messages, help and completion; nothing is imported to know them."""
from __future__ import annotations

from typing import NamedTuple


class Scheme(NamedTuple):
    """In which module of `sizing` the function of a scheme is, and the options it takes."""

    room: str
    options: tuple[str, ...] = ()


SCHEMES = {
    "auto": Scheme("auto"),
    "counterweights": Scheme("crank", ("order", "planes")),
    "factor": Scheme("crank", ("factor",)),
    "minimax": Scheme("crank", ("planes", "position")),
    "single-shaft": Scheme("shafts", ("order", "at", "position")),
    "two-shaft": Scheme("shafts", ("order", "at", "position", "roll")),
    "four-shaft": Scheme("shafts", ("at", "position")),
    "couple-shaft": Scheme("shafts", ("order", "at", "planes")),
    "slider": Scheme("shafts", ("order", "at", "position")),
    "eccentric-slider": Scheme("single"),
    "oldham": Scheme("single"),
}
KNUCKLES = "knuckles"           # fits no device, but changes the engine file (balcli.knuckles)
NAMES = (*SCHEMES, KNUCKLES)
