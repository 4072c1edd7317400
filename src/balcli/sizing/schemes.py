"""The balance schemes by name, and which options each takes.

Light enough for help, completion and messages; the functions stand in `balcli.sizing.sizing.SIZE`.
"""

from __future__ import annotations

SCHEMES: dict[str, tuple[str, ...]] = {
    "auto": (),
    "counterweights": ("order", "planes"),
    "factor": ("factor", "measured", "planes"),
    "minimax": ("planes", "position"),
    "single-shaft": ("order", "at", "position", "planes"),
    "two-shaft": ("order", "at", "position", "roll"),
    "four-shaft": ("at", "position"),
    "couple-shaft": ("order", "at", "planes"),
    "slider": ("order", "at", "position"),
    "eccentric-slider": (),
    "oldham": (),
}
KNUCKLES = "knuckles"  # fits no device, but changes the engine file (balcli.results.knuckles)
NAMES = (*SCHEMES, KNUCKLES)
