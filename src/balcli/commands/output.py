"""Where results go: standard output, or a file that is written beside its place and moved there when it is whole."""
from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from ..errors import BalcliError


def emit(text: str, output: Path | None = None) -> None:
    """Print once, or write the whole file or nothing of it.

    Raises:
        BalcliError: if the file cannot be written; an older one is left as it was.
    """
    if output is None:
        sys.stdout.write(text if text.endswith("\n") else text + "\n")
        sys.stdout.flush()
    else:
        write(text if text.endswith("\n") else text + "\n", output)


def write(content: str | bytes, target: Path) -> None:
    """Replace a file in one step."""
    data = content.encode() if isinstance(content, str) else content
    if target.is_dir():
        raise BalcliError(f"{target}: is a folder, so no file can be written there")
    beside = None
    try:
        handle, beside = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:40]}.")
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        os.chmod(beside, _mode(target))
        os.replace(beside, target)
    except OSError as error:
        if beside is not None and os.path.exists(beside):
            os.unlink(beside)
        raise BalcliError(f"{target}: cannot be written ({error.strerror or error})") from None


def _mode(target: Path) -> int:
    """Permissions of the file that is replaced, or those of a new one."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
