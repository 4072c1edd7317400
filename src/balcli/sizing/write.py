"""A remedy written into the text of an engine file, which stays as it was, comments and all."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from typing import Any

from ..engine.build import build
from ..engine.parse import parse
from ..enginefile.edit import format_value, rewrite, set_keys
from ..errors import BalcliError, InputError
from .device_tables import FIELDS, DeviceTable, name_kind
from .remedy import Remedy, fit_devices


def insert_remedy(text: bytes, remedy: Remedy, file: str = "") -> str:
    """The text of an engine file with the devices of a remedy after it, or with its knuckle angles
    in place of older ones.

    Args:
        text: of the file, UTF-8. file: its name in messages.

    Raises BalcliError if no engine file can describe the remedy.
    """
    old = text.decode("utf-8-sig")
    if angles := remedy.knuckle_angles_deg:
        new = set_keys(old, "articulation", {"knuckle_angles": list(angles)}, "even, by balcli")
        parse(new, file)
        return new
    if remedy.beyond:
        raise BalcliError(
            f"scheme {remedy.scheme}: no engine file can describe its devices (shafts of variable "
            "speed, couplings), so that they cannot be written; balance shows what they leave"
        )
    new = _insert_devices(old, remedy)
    if build(parse(new, file)).devices != fit_devices(build(parse(text, file)), remedy).devices:
        raise BalcliError(
            f"{file}: the devices do not read back as they were sized; please report this file"
        )
    return new


def _insert_devices(text: str, remedy: Remedy) -> str:
    """Return the text with the tables at the end; where the file has its devices as an inline list,
    which cannot be added to, it is written anew, without its comments.
    """
    end_of_line = "" if text.endswith("\n") or not text else "\n"
    tables = end_of_line + "".join(_write_tables(remedy))
    new = text + (tables.replace("\n", "\r\n") if "\r\n" in text else tables)
    try:
        parse(new)
    except InputError:
        data = tomllib.loads(text)
        for device in remedy.devices:
            data.setdefault(name_kind(device), []).append(_list_entries(device))
        return rewrite(data, "it has devices in one list, to which TOML lets nothing be added")
    return new


def _write_tables(remedy: Remedy) -> Iterator[str]:
    """Yield the tables, each reason as a comment above the first of its devices."""
    if remedy.devices:
        yield f"\n# fitted by balcli, scheme {remedy.scheme}\n"
    told = ""
    for device, reason, anywhere in zip(remedy.devices, remedy.reasons, remedy.free, strict=True):
        if reason != told:
            yield f"# {reason}\n"
        told = reason
        yield f"[[{name_kind(device)}]]\n"
        for key, value in _list_entries(device).items():
            note = "  # free: it may stand anywhere" * (anywhere and key == "at")
            yield f"{key} = {format_value(value)}{note}\n"
        yield "\n"


def _list_entries(device: DeviceTable) -> dict[str, Any]:
    """Return keys and values of a device as TOML has them."""
    values = {key: getattr(device, key) for key in FIELDS[type(device)]}
    return {key: [*value] if isinstance(value, tuple) else value for key, value in values.items()}
