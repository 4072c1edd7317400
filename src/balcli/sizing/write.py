"""The engine file with the devices of a remedy: its text as it was, comments and all, with their
tables after it.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from typing import Any

from ..engine.build import build
from ..engine.load import parse
from ..enginefile.edit import anew, changed, written
from ..enginefile.model import Counterweight, Shaft, Slider
from ..errors import BalcliError, InputError
from .sizing import Remedy, fitted

_KEYS: dict[type, tuple[str, ...]] = {
    Counterweight: ("unbalance", "angle", "position"),
    Shaft: ("ratio", "unbalance", "angle", "at", "position"),
    Slider: ("order", "unbalance", "direction", "angle", "at", "position"),
}


def fit(text: bytes, remedy: Remedy, file: str = "") -> str:
    """The text of an engine file with these devices fitted; read back, it is exactly the engine
    that was analysed with them.

    Where the file has its devices as an inline list, which cannot be added to, it is written anew,
    without its comments.

    Raises:
        BalcliError: the remedy has devices that no engine file can describe.
    """
    if remedy.beyond:
        raise BalcliError(
            f"scheme {remedy.scheme}: no engine file can describe its devices (shafts of variable "
            "speed, couplings), "
            "so that they cannot be written; balance shows what they leave"
        )
    old = text.decode("utf-8-sig")
    new = old + ("" if old.endswith("\n") or not old else "\n") + "".join(_tables(remedy))
    try:
        parse(new)
    except InputError:
        new = _rewritten(old, remedy)
    if build(parse(new, file)).devices != fitted(build(parse(text, file)), remedy).devices:
        raise BalcliError(
            f"{file}: the devices do not read back as they were sized; please report this file"
        )
    return new


def fit_knuckles(text: bytes, angles_deg: tuple[float, ...], file: str = "") -> str:
    """The text of an engine file with these knuckle angles, in place of older ones."""
    new = changed(
        text.decode("utf-8-sig"),
        "articulation",
        {"knuckle_angles": list(angles_deg)},
        "even, by balcli",
    )
    parse(new, file)
    return new


def _tables(remedy: Remedy) -> Iterator[str]:
    if not remedy.devices:
        return
    yield f"\n# fitted by balcli, scheme {remedy.scheme}\n"
    told = ""
    for device, reason in zip(remedy.devices, remedy.reasons, strict=True):
        head = "" if reason == told else f"# {reason}\n"
        told = reason
        lines = "".join(f"{key} = {written(value)}\n" for key, value in _entries(device).items())
        yield f"{head}[[{type(device).__name__.lower()}]]\n{lines}\n"


def _entries(device: Counterweight | Shaft | Slider) -> dict[str, Any]:
    values = {key: getattr(device, key) for key in _KEYS[type(device)]}
    return {
        key: list(value) if isinstance(value, tuple) else value for key, value in values.items()
    }


def _rewritten(text: str, remedy: Remedy) -> str:
    data = tomllib.loads(text)
    for device in remedy.devices:
        key = type(device).__name__.lower()
        data[key] = [*data.get(key, []), _entries(device)]
    return anew(data, "it has devices in one list, to which TOML lets nothing be added")
