"""Published problems: `tests/published/NAME.toml` has a source's data, its printed answers, and the command that answers
them.
"""

import json
import math
import os
import shlex
import tempfile
import tomllib
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np

from .commands import run_here
from .paths import ROOT

FOLDER = ROOT / "tests" / "published"
VERDICTS = ("agrees", "rounded", "definition", "wrong")
CHAPTERS = ("forces", "balancing", "locomotive", "torque", "torsion", "mounts", "field")


@dataclass(frozen=True, slots=True)
class Figure:
    """A printed figure, and where it stands in balcli's JSON.

    Attributes:
        name: what it is, with the place or angle.
        unit: its unit in print; empty for a pure number.
        printed: as the source prints it; its last digit is the tolerance.
        path: keys of the JSON, joined by `/`; `key=value` selects the member of a list, a number counts from 0.
        over: path of a figure that the former is divided by.
        times: factor from balcli's unit to the unit in print.
        angle: whether it is modulo 360 deg.
        within: relative difference that the rounded intermediate figures of the source explain; `why` says which.
        why: reason of `within`.
        balcli: what balcli says instead, for an error or another definition.
        wrong: why the source is wrong.
        category: class of that error, a key of `balcli.books.recomputed.CLASSES`; `class` in the file.
        definition: what the source computes instead.
        check: Python expression of the second way: the right value, or the printed one by the source's definition.
        command: number of the command that answers it, from 0.
    """

    name: str
    printed: str
    path: str
    unit: str = ""
    over: str = ""
    times: float = 1.0
    angle: bool = False
    within: float = 0.0
    why: str = ""
    balcli: str = ""
    wrong: str = ""
    category: str = ""
    definition: str = ""
    check: str = ""
    command: int = 0

    @property
    def verdict(self) -> str:
        """Return one of `VERDICTS`."""
        if self.wrong or self.definition:
            return "wrong" if self.wrong else "definition"
        return "rounded" if self.within else "agrees"

    @property
    def remark(self) -> str:
        return self.wrong or self.definition or self.why

    def agrees(self, value: float, text: str, within: float = 0.0) -> bool:
        """Return whether a value rounds to this text, or lies within the tolerance about it."""
        expected = float(text)
        difference = abs((value - expected + 180) % 360 - 180) if self.angle else abs(value - expected)
        half = 0.5 * 10.0 ** int(Decimal(text).as_tuple().exponent)
        return difference <= max(half * (1 + 1e-9), within * abs(expected))

    def checked(self) -> float:
        return float(eval(self.check, {"np": np, **vars(math)}))


@dataclass(frozen=True, slots=True)
class Problem:
    """A published problem.

    Attributes:
        name: name of its file, without the ending.
        title: what is asked, in our words.
        source: authors, book or paper, number of the example, page.
        work: the book, paper or page without the number: problems of one work have the same.
        address: where it can be read.
        chapter: one of `CHAPTERS`.
        given: its data in words, as far as the files do not say it.
        commands: commands of balcli without the first word and the format; the first ones may write files.
        files: name and text of each file.
        figures: the printed figures.
    """

    name: str
    title: str
    source: str
    work: str
    chapter: str
    commands: tuple[str, ...]
    files: dict[str, str]
    figures: tuple[Figure, ...]
    address: str = ""
    given: str = ""

    def answer(self) -> list[float]:
        """Run the commands in an empty folder, and return balcli's figures in the unit of the print."""
        before = Path.cwd()
        with tempfile.TemporaryDirectory() as folder:
            for name, text in self.files.items():
                Path(folder, name).write_text(text, encoding="utf-8")
            os.chdir(folder)
            try:
                documents = [_run(command) for command in self.commands]
            finally:
                os.chdir(before)
        return [_find(documents[f.command], f) for f in self.figures]


def _run(command: str) -> Any:
    status, out, err = run_here("-q", *shlex.split(command), "--format", "json")
    if status:
        raise AssertionError(f"balcli {command}: {err}")
    return json.loads(out)


def _find(document: Any, figure: Figure) -> float:
    value = float(follow(document, figure.path)) * figure.times
    return value / float(follow(document, figure.over)) if figure.over else value


def follow(document: Any, path: str) -> Any:
    """Return what a path leads to."""
    for key in path.split("/"):
        if isinstance(document, dict):
            document = document[key]
        elif "=" in key:
            name, _, text = key.partition("=")
            (document,) = [each for each in document if _is(each.get(name), text)]
        else:
            document = document[int(key)]
    return document


def _is(value: Any, text: str) -> bool:
    return math.isclose(value, float(text), rel_tol=1e-6) if isinstance(value, float | int) else str(value) == text


def load_problem(path: Path) -> Problem:
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    figures = tuple(Figure(category=each.pop("class", ""), **each) for each in content.pop("figures"))
    return Problem(name=path.stem, figures=figures, **{**content, "commands": tuple(content["commands"])})


def load_problems() -> list[Problem]:
    """Return all problems, by chapter and name."""
    found = map(load_problem, sorted(FOLDER.glob("*.toml")))
    return sorted(found, key=lambda problem: CHAPTERS.index(problem.chapter))
