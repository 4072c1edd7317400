"""The engine file with an arrangement that was found."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..engine import build
from ..enginefile import parse
from ..errors import InputError

TABLES = {"throws": "crank", "splay": "crank", "firing_order": "layout", "bank_angle": "layout"}


def arranged(text: bytes, arrangement: Mapping[str, Any]) -> str:
    """The text of an engine file, its comments gone, with an arrangement; a firing order that no longer fits is left out."""
    import tomllib

    import tomli_w

    data = tomllib.loads(text.decode("utf-8-sig"))
    for key, value in arrangement.items():
        data.setdefault(TABLES[key], {})[key] = value
    if "firing_order" in arrangement:
        data["layout"].pop("firing_intervals", None)
    new = tomli_w.dumps(data)
    try:
        build(parse(new))
    except InputError:
        for key in ("firing_order", "firing_intervals"):
            data["layout"].pop(key, None)
        new = tomli_w.dumps(data)
    return new
