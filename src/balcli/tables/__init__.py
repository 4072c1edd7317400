"""The printed coefficient tables of five sources, recomputed; what deviates is found, never
typed.
"""

from __future__ import annotations

from .options import Options
from .registry import NAMES, recompute, select
from .table import Erratum, Table

__all__ = ["NAMES", "Erratum", "Options", "Table", "recompute", "select"]
