"""Programs started anew: all that they import is imported."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence

LIBRARIES = "import numpy, typer; from pydantic import BaseModel"
# To read an option, typer loads a good deal more of pydantic.
SMALLEST = """
import numpy, typer
from pydantic import BaseModel

def main(number: float = 1.0) -> None:
    pass

typer.run(main)
"""


def start_balcli(argv: Sequence[str], engine_file: str = "") -> None:
    """The whole program with these arguments and an engine file as its input."""
    _start(["-m", "balcli", *argv], engine_file)


def start_libraries() -> None:
    """What no program with these libraries is quicker than."""
    _start(["-c", LIBRARIES])


def start_smallest() -> None:
    """The smallest program with these libraries that reads an option."""
    _start(["-c", SMALLEST])


def _start(argv: Sequence[str], text: str = "") -> None:
    subprocess.run([sys.executable, *argv], input=text.encode(), capture_output=True, check=True)
