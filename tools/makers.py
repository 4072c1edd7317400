"""Write the table of makers into docs/ladders.md: for each balancer shaft of known engines, whether
the maker fitted it, and whether `balcli balance` fits it by default.

Usage: python tools/makers.py
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import tomli_w

from balcli.engine.build import build
from balcli.engine.engine import Engine
from balcli.engine.parse import parse
from balcli.sizing.ladder import find_ladder

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT / "tests" / "makers.toml"
DOCUMENT = ROOT / "docs" / "ladders.md"
HEADS = ("engine", "step", "share, %", "limit, %", "maker", "balcli", "source")
_ABOUT = ("name", "fitted", "source", "rival")  # keys of an entry that an engine file has not
_SHAFTS = {1: "-1", 2: "+-2"}  # names in the data, by order
_FITTED = {True: "fitted", False: "none"}
_FITS = {True: "fits", False: "none"}
# Assumed masses, kg; the centre of mass of a rod is at this share of its length from the big end.
_PISTON = 0.45
_ROD = 0.5
_CENTRE = 0.28


class Maker(NamedTuple):
    """An engine and what its maker fitted.

    Attributes:
        name: Name of the engine.
        engine: The engine.
        fitted: Shafts that the maker fitted: "-1", "+-2".
        source: Link to what says so; empty if it is common knowledge.
        rival: Name of an engine whose maker chose the opposite for the same shaft; empty if there
            is none.
    """

    name: str
    engine: Engine
    fitted: tuple[str, ...]
    source: str
    rival: str = ""


class Choice(NamedTuple):
    """The choice for a shaft of an engine.

    Attributes:
        maker: Engine.
        step: Step of the ladder.
        order: Order that the shaft cancels.
        share: What it cancels, as a share of one cylinder's first order.
        limit: Share from which balcli fits it.
        fitted: Whether the maker fitted it.
        proposed: Whether balcli fits it by default.
    """

    maker: Maker
    step: str
    order: int
    share: float
    limit: float
    fitted: bool
    proposed: bool

    @property
    def agrees(self) -> bool:
        """Whether balcli proposes what the maker did."""
        return self.fitted == self.proposed


# ------------------------------------------------------------------ data
def read_makers() -> list[Maker]:
    """Return all engines of the data."""
    with DATA.open("rb") as file:
        entries = tomllib.load(file)["engine"]
    return [_read_maker(entry) for entry in entries]


def _read_maker(entry: dict[str, Any]) -> Maker:
    tables = {key: value for key, value in entry.items() if key not in _ABOUT}
    return Maker(
        name=entry["name"],
        engine=build(parse(tomli_w.dumps(_add_masses(tables)))),
        fitted=tuple(entry["fitted"]),
        source=entry["source"],
        rival=entry.get("rival", ""),
    )


def _add_masses(tables: dict[str, Any]) -> dict[str, Any]:
    """Return an engine file with assumed masses where the data give none."""
    rod = {"mass": _ROD, "cg": _CENTRE * tables["rod"]["length"], **tables["rod"]}
    piston = {"mass": _PISTON, **tables["piston"]}
    return {**tables, "rod": rod, "piston": piston}


def list_choices(makers: Iterable[Maker]) -> list[Choice]:
    """Return the choice for every listed shaft, orders 1 and 2 apart, largest share first."""
    choices: list[Choice] = []
    for maker in makers:
        choices.extend(_list_own_choices(maker))
    return sorted(choices, key=_find_place)


def _find_place(choice: Choice) -> tuple[int, float, str]:
    """Return the key by which choices are sorted; equal shares are sorted by name."""
    return choice.order, -round(choice.share, 4), choice.maker.name


def _list_own_choices(maker: Maker) -> Iterator[Choice]:
    for step in find_ladder(maker.engine).steps:
        if step.limit is not None:
            fitted = _SHAFTS[step.order] in maker.fitted
            yield Choice(
                maker, step.step, step.order, step.share, step.limit, fitted, step.worth_it
            )


def count_wrong(choices: Iterable[Choice], limit: float) -> int:
    """Return how many choices one limit for all shafts would get wrong.

    Args:
        choices: Choices of makers.
        limit: Limit, as a share of one cylinder's first order.
    """
    return sum((choice.share >= limit) != choice.fitted for choice in choices)


# ------------------------------------------------------------------ the document
def make_table(choices: Iterable[Choice]) -> str:
    """Return the table in Markdown."""
    lines = [_write_row(HEADS), "| --- | --- | ---: | ---: | --- | --- | --- |"]
    for choice in choices:
        share = f"{100 * choice.share:.1f}"
        limit = f"{100 * choice.limit:.0f}"
        does = (_FITTED[choice.fitted], _tell_proposal(choice), _link(choice.maker.source))
        lines.append(_write_row((choice.maker.name, choice.step, share, limit, *does)))
    return "\n".join(lines) + "\n"


def _write_row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _tell_proposal(choice: Choice) -> str:
    """Return what balcli does; bold, with an engine of the same choice, if the maker did not."""
    does = _FITS[choice.proposed]
    if choice.agrees:
        return does
    return f"**{does}**, as {choice.maker.rival}" if choice.maker.rival else f"**{does}**"


def _link(source: str) -> str:
    """Return the source as a link: to a section of the document, or to a page."""
    if not source:
        return "common knowledge"
    if not source.startswith("#"):
        return source
    return f"[above]({source})"


def make_document(choices: Iterable[Choice]) -> str:
    """Return the document with a table of these choices."""
    text = DOCUMENT.read_text(encoding="utf-8")
    table = make_table(choices)
    head = re.escape(_write_row(HEADS))
    return re.sub(rf"^{head}\n(?:\|.*\n)*", lambda _: table, text, count=1, flags=re.MULTILINE)


if __name__ == "__main__":
    DOCUMENT.write_text(make_document(list_choices(read_makers())), encoding="utf-8")
