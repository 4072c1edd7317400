"""The engine file with a design that was found."""

from __future__ import annotations

from ...engine.build import build
from ...engine.load import parse
from ...enginefile.edit import set_keys
from ...errors import InputError
from .designs import Design

TABLES = {"throws": "crank", "splay": "crank", "firing_order": "layout", "bank_angle": "layout"}
NOTE = "found by balcli"


def write_design(text: bytes, design: Design) -> str:
    """The text of an engine file, comments and all, with a design; a firing order that no longer
    fits is left out.
    """
    new = text.decode("utf-8-sig")
    for key, value in design.given().items():
        new = set_keys(new, TABLES[key], {key: value}, NOTE)
    if design.firing_order is not None:
        new = set_keys(new, "layout", {"firing_intervals": None}, NOTE)
    try:
        build(parse(new))
    except InputError:
        new = set_keys(new, "layout", {"firing_order": None, "firing_intervals": None}, NOTE)
    return new
