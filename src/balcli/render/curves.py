"""Curves over the crank angle as JSON and CSV, full precision."""
from __future__ import annotations

import csv
import io
import json

from ..curves import Curves


def curves_json(curves: Curves) -> str:
    """One list a quantity, all of the length of `crank_deg`."""
    return json.dumps({
        "format": "balcli.curves/1", "engine": curves.name, "speed_rpm": curves.speed_rpm,
        "crank_deg": curves.crank_deg.tolist(), "curves": {name: y.tolist() for name, y in curves.values.items()},
    }, ensure_ascii=False, allow_nan=False)


def curves_csv(curves: Curves) -> str:
    """One line a crank angle."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["crank_deg", *curves.values])
    writer.writerows(zip(curves.crank_deg.tolist(), *(y.tolist() for y in curves.values.values()), strict=True))
    return out.getvalue()
