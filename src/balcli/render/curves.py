"""Curves over the crank angle, in full precision."""

from __future__ import annotations

from typing import Any

from ..forces.curves import Curves
from .csv import Columns, Rows
from .figures import assumptions
from .formats import Columnar


def document(curves: Curves) -> dict[str, Any]:
    """`balcli.curves/1`: one list a quantity, all of the length of `crank_deg`."""
    return {
        "format": "balcli.curves/1",
        "engine": curves.name,
        "speed_rpm": curves.speed_rpm,
        "crank_deg": curves.crank_deg.tolist(),
        "curves": {name: y.tolist() for name, y in curves.values.items()},
        **assumptions(curves),
    }


def columns(curves: Curves) -> Columns:
    """Crank angles, and each quantity that is known; units stand in the names."""
    return Columns({"crank_deg": curves.crank_deg, **curves.known()})


def rows(curves: Curves) -> Rows:
    """CSV: a line a crank angle, a column a quantity that is known."""
    known = curves.known()
    columns = [curves.crank_deg.tolist(), *(y.tolist() for y in known.values())]
    return Rows(("crank_deg", *known), zip(*columns, strict=True))


RENDERER = Columnar(document=document, columns=columns)
