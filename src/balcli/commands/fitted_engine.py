"""`--write`: the engine with its devices, as a new file."""

from __future__ import annotations

from pathlib import Path

from ..enginefile.edit import set_keys
from ..enginefile.toml_text import name_file
from ..sizing.remedy import Remedy
from ..sizing.write import insert_remedy
from .output import refuse_leaving_files, write_file


def write_fitted(
    source: str, text: bytes, remedy: Remedy, target: Path, speed_rpm: float | None = None
) -> None:
    """Write the engine file with these devices, and at the speed for which they were asked if that
    is not its own.

    Raises:
        BalcliError: the target cannot be written, or the devices cannot be described; files that
            the engine file names would be left behind.
    """
    refuse_leaving_files(text, source, target)
    new = insert_remedy(text, remedy, name_file(source))
    if speed_rpm is not None:
        new = set_keys(new, "operation", {"speed": speed_rpm}, "as balanced by balcli")
    write_file(new, target)
