"""A remedy written into the text of an engine file, which stays as it was, comments and all."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from typing import Any

from ..engine.build import build
from ..engine.load import parse
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
    if remedy.knuckle_angles_deg:
        return _insert_knuckle_angles(old, remedy.knuckle_angles_deg, file)
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


def _insert_knuckle_angles(text: str, angles_deg: tuple[float, ...], file: str) -> str:
    new = set_keys(text, "articulation", {"knuckle_angles": list(angles_deg)}, "even, by balcli")
    parse(new, file)
    return new


def _insert_devices(text: str, remedy: Remedy) -> str:
    """With the tables at the end; where the file has its devices as an inline list, which cannot be
    added to, it is written anew, without its comments.
    """
    end_of_line = "" if text.endswith("\n") or not text else "\n"
    tables = end_of_line + "".join(_write_tables(remedy))
    new = text + (tables.replace("\n", "\r\n") if "\r\n" in text else tables)
    try:
        parse(new)
    except InputError:
        return _rewrite(text, remedy)
    return new


def _write_tables(remedy: Remedy) -> Iterator[str]:
    """The tables, each reason as a comment above the first device that it is told of."""
    if not remedy.devices:
        return
    yield f"\n# fitted by balcli, scheme {remedy.scheme}\n"
    told = ""
    for device, reason, anywhere in zip(remedy.devices, remedy.reasons, remedy.free, strict=True):
        head = "" if reason == told else f"# {reason}\n"
        told = reason
        notes = {"at": "  # free: it may stand anywhere"} if anywhere else {}
        entries = _list_entries(device)
        lines = "".join(
            f"{key} = {format_value(value)}{notes.get(key, '')}\n" for key, value in entries.items()
        )
        yield f"{head}[[{name_kind(device)}]]\n{lines}\n"


def _list_entries(device: DeviceTable) -> dict[str, Any]:
    """Keys and values of a device as TOML has them."""
    values = {key: getattr(device, key) for key in FIELDS[type(device)]}
    return {
        key: list(value) if isinstance(value, tuple) else value for key, value in values.items()
    }


def _rewrite(text: str, remedy: Remedy) -> str:
    """The whole file written anew with the devices."""
    data = tomllib.loads(text)
    for device in remedy.devices:
        kind = name_kind(device)
        data[kind] = [*data.get(kind, []), _list_entries(device)]
    return rewrite(data, "it has devices in one list, to which TOML lets nothing be added")
