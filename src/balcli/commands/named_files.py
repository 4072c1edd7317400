"""Files that an engine file names, such as a measured diagram: they stand beside it, stay as they
are, and what is written anew has to find them.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..enginefile.toml_text import parse_toml, read_bytes
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


def list_named_files(source: str) -> list[Path]:
    """Files that an engine file names, at this path; none where it cannot be read, which is told
    elsewhere.
    """
    try:
        data = parse_toml(read_bytes(source), source) if Path(source).is_file() else {}
        return [Path(source).parent / name for name in _list_names(data)]
    except (BalcliError, AttributeError, TypeError):
        return []


def _are_equal(one: Path, other: Path) -> bool:
    """Whether both files are there, with one content."""
    try:
        return one.read_bytes() == other.read_bytes()
    except OSError:
        return False


def _list_names(data: dict[str, Any]) -> Iterator[str]:
    for table in (data.get("gas", {}), *data.get("cylinder", {}).values()):
        yield from (table[key] for key in ("indicator", "harmonics") if key in table)
