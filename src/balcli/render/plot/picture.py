"""Figures that keep our style, so that a notebook shows them as files have them."""

from __future__ import annotations

from io import BytesIO
from typing import Any

from matplotlib.figure import Figure

from .style import in_our_style


class Picture(Figure):
    """A matplotlib figure without a window; files and notebooks show what is changed in it."""

    def savefig(self, fname: Any, **kwargs: Any) -> None:
        """Write the figure, as `matplotlib.figure.Figure.savefig` does."""
        with in_our_style():
            super().savefig(fname, **kwargs)

    def _repr_png_(self) -> bytes:
        buffer = BytesIO()
        self.savefig(buffer, format="png", dpi=100)  # a column of a notebook
        return buffer.getvalue()
