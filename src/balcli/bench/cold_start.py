"""Programs started anew: all that they import is imported."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence

LIBRARIES = "import numpy, typer; from pydantic import BaseModel"


def start_balcli(argv: Sequence[str], engine_file: str) -> None:
    """The whole program with these arguments and an engine file as its input."""
    _start(["-m", "balcli", *argv], engine_file)


def start_libraries() -> None:
    """What no program with these libraries is quicker than."""
    _start(["-c", LIBRARIES])


def _start(argv: Sequence[str], text: str = "") -> None:
    subprocess.run([sys.executable, *argv], input=text.encode(), capture_output=True, check=True)
