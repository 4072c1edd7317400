"""Figures that know our style, so that a notebook shows them as they are written into files."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from .style import Form, in_our_style, lay_out_figure

DPI = 100  # in a notebook: as wide as its column


class Picture(Figure):
    """A figure of matplotlib's that no backend holds: `savefig` writes it, a notebook shows it, and
    whatever one changes in it (`axes`) is seen in both.
    """

    def savefig(self, fname: Any, **kwargs: Any) -> None:
        """Write it into a file or stream, as `matplotlib.figure.Figure.savefig`."""
        ending = Path(fname).suffix[1:] if isinstance(fname, (str, Path)) else "png"
        form: Form = "svg" if kwargs.get("format", ending) == "svg" else "png"
        with in_our_style(form):
            lay_out_figure(self)
            super().savefig(fname, **kwargs)

    def _repr_png_(self) -> bytes:
        buffer = BytesIO()
        self.savefig(buffer, format="png", dpi=DPI)
        return buffer.getvalue()
