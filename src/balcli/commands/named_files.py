"""Files that an engine file names, such as a measured diagram: they stand beside it, and what is
written anew has to find them.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import BalcliError


def refuse_leaving_files(text: bytes, source: str, target: Path) -> None:
    """Nothing, unless an engine file that names others is written into another folder that does not
    have the same ones.

    Args:
        text: of the engine or chain file, which is good.
        source: its path; `-` is standard input, in the working folder.
        target: where it is written anew.

    Raises:
        BalcliError: with the first file and its folder.
    """
    folder = Path(source).parent
    if folder.resolve() == target.parent.resolve():
        return
    for name in _list_names(tomllib.loads(text.decode("utf-8-sig"))):
        if not _are_equal(folder / name, target.parent / name):
            raise BalcliError(
                f'{target}: the engine file names "{name}", which stands beside it in {folder}; '
                f"write into that folder, or copy {name} into {target.parent} first"
            )


def _are_equal(one: Path, other: Path) -> bool:
    """Whether both files are there, with one content."""
    try:
        return one.read_bytes() == other.read_bytes()
    except OSError:
        return False


def _list_names(data: dict[str, Any]) -> Iterator[str]:
    for table in (data.get("gas", {}), *data.get("cylinder", {}).values()):
        yield from (table[key] for key in ("indicator", "harmonics") if key in table)
