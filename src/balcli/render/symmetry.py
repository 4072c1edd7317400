"""Why each order is balanced or is not: as sentences, in JSON and as rows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from ..forces.symmetry import Symmetry
from .figures import Row, clean
from .sheet import Text


def sheet_parts(why: Symmetry) -> Iterator[Text]:
    """One paragraph a reason."""
    yield Text("Why", why.sentences)


def document(why: Symmetry) -> dict[str, Any]:
    """`why` in `balcli.analysis/1`."""
    return {"reasons": [asdict(reason) for reason in why.reasons], "firing": why.firing}


def rows(why: Symmetry) -> Iterator[Row]:
    """Two figures a reason: what decides, and what is left in units of one cylinder's."""
    for reason in why.reasons:
        about = 0, reason.quantity, reason.order
        yield Row(*about, "why", reason.verdict, "")
        yield Row(*about, "why_size", clean(reason.size), "of one cylinder")
    if why.firing:
        yield Row(0, "firing", None, "why", why.firing, "")
