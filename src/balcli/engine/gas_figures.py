"""Which figures of an engine file the gas in its cylinders depends on: those of the mechanism, of
when a cylinder fires, and of the gas itself; no masses, places along the crank, speed.
"""

from __future__ import annotations

_WHOLE = frozenset({"gas", "layout", "articulation"})  # tables all of whose figures count
_KEYS = {
    "crank": frozenset({"stroke", "throws", "splay"}),
    "rod": frozenset({"length", "ratio"}),
    "piston": frozenset({"bore", "offset"}),
}
_OF_CYLINDER = frozenset(
    {"piston_offset", "rod_length", "rod_ratio", "bank", "throw", "gas", "heat"}
)


def concerns_gas(path: str) -> bool:
    """Whether the gas torque of some cylinder depends on a figure, by its dotted name."""
    table, _, key = path.partition(".")
    if table == "cylinder":
        return key.partition(".")[2] in _OF_CYLINDER
    return table in _WHOLE or key.partition(".")[0] in _KEYS.get(table, ())
