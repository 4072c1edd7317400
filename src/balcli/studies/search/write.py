"""The engine file with an arrangement that was found."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...engine.build import build
from ...engine.load import parse
from ...enginefile.edit import changed
from ...errors import InputError

TABLES = {"throws": "crank", "splay": "crank", "firing_order": "layout", "bank_angle": "layout"}
NOTE = "found by balcli"


def arranged(text: bytes, arrangement: Mapping[str, Any]) -> str:
    """The text of an engine file, comments and all, with an arrangement; a firing order that no
    longer fits is left out.
    """
    new = text.decode("utf-8-sig")
    for key, value in arrangement.items():
        new = changed(new, TABLES[key], {key: value}, NOTE)
    if "firing_order" in arrangement:
        new = changed(new, "layout", {"firing_intervals": None}, NOTE)
    try:
        build(parse(new))
    except InputError:
        new = changed(new, "layout", {"firing_order": None, "firing_intervals": None}, NOTE)
    return new
