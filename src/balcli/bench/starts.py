"""Measure the time of a cold start of `balcli analyze` as a multiple of that of other programs."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator

import numpy as np

from .records import Ratio

LIBRARIES = "import numpy, typer; from pydantic import BaseModel"
SMALLEST = """
import numpy, typer
from pydantic import BaseModel

def main(number: float = 1.0) -> None:
    pass

typer.run(main)
"""
_ROUNDS = 4


def compare_starts(engine: str) -> Iterator[Ratio]:
    """Yield the time of a cold start of `balcli analyze` / that of each of two other programs.

    Args:
        engine: Text of the engine file that is analyzed.
    """
    programs = {
        "import of numpy, typer and pydantic": LIBRARIES,
        "minimal typer program that imports numpy and pydantic": SMALLEST,
    }
    seconds = []
    for _ in range(1 + _ROUNDS):
        ours = _start("-m", "balcli", "analyze", "-", text=engine)
        seconds.append([ours, *(_start("-c", program) for program in programs.values())])
    counted = seconds[1:]  # the first starts may compile modules and read them from the disk
    first, *others = np.median(counted, axis=0)
    for what, other in zip(programs, others, strict=True):
        yield Ratio(what=f"cold balcli analyze / {what}", value=float(first / other))


def _start(*argv: str, text: str = "") -> float:
    """Return the run time of a Python program, s, with one thread of linear algebra."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # compiling again is no part of a start
    command = [sys.executable, *argv]
    start = time.perf_counter()
    subprocess.run(command, input=text.encode(), capture_output=True, check=True, env=environment)
    return time.perf_counter() - start
