"""Curves over the crank angle as JSON and CSV, full precision."""

from __future__ import annotations

from ..forces.curves import Curves
from .csv import write
from .json import dumps


def curves_json(curves: Curves) -> str:
    """One list a quantity, all of the length of `crank_deg`."""
    return dumps(
        {
            "format": "balcli.curves/1",
            "engine": curves.name,
            "speed_rpm": curves.speed_rpm,
            "crank_deg": curves.crank_deg.tolist(),
            "curves": {name: y.tolist() for name, y in curves.values.items()},
        }
    )


def curves_csv(curves: Curves) -> str:
    """One line a crank angle."""
    columns = [curves.crank_deg.tolist(), *(y.tolist() for y in curves.values.values())]
    return write(("crank_deg", *curves.values), zip(*columns, strict=True))
