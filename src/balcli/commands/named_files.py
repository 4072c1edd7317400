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
    """Nothing, unless an engine file that names others is written into another folder.

    Args:
        text: of the engine file, which is good.
        source: its path; `-` is standard input, in the working folder.
        target: where it is written anew.

    Raises:
        BalcliError: with the first file and its folder.
    """
    folder = Path(source).parent
    if folder.resolve() == target.parent.resolve():
        return
    for name in _list_names(tomllib.loads(text.decode("utf-8-sig"))):
        raise BalcliError(
            f'{target}: the engine file names "{name}", which stands beside it in {folder}; write '
            "into that folder"
        )


def _list_names(data: dict[str, Any]) -> Iterator[str]:
    for table in (data.get("gas", {}), *data.get("cylinder", {}).values()):
        yield from (table[key] for key in ("indicator", "harmonics") if key in table)
