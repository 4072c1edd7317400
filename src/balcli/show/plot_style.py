"""Define the style of all pictures, and open and save figures in this style.

Global state of matplotlib is restored, and no display is needed.
"""

from __future__ import annotations

import logging
import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from pathlib import Path
from textwrap import wrap
from threading import RLock
from typing import TYPE_CHECKING, Any, Literal, TypeAlias
from unicodedata import east_asian_width

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


Form = Literal["svg", "png", "pdf"]
Look: TypeAlias = dict[str, Any]  # keyword arguments of matplotlib

# The colours of the report page (report.css): one quantity has one colour in every picture. Line
# styles and hatches distinguish the curves in black and white.
INK = "#1a1a1a"  # sums and roll
SOFT = "#6b6b6b"
FAINT = "#d4d4d4"
PAPER = "#ffffff"
BEFORE = "#7d858f"  # the engine as drawn, beside the engine with devices
BLUE = "#0067a8"  # the engine now
RED = "#c2410c"  # what shakes
GREEN = "#007a5a"  # devices
TORQUE = "#7a4fa3"  # torque of inertia
GAS = "#8f6400"
COUPLE = "#00727a"
# Looks of up to twelve curves.
MANY_LOOKS = (*zip(("-", "--", ":") * 4, (BLUE, RED, GREEN, INK) * 3, strict=True),)
# Variables of the report page, by colour.
NAMES = {
    INK: "ink",
    SOFT: "soft",
    FAINT: "faint",
    PAPER: "paper",
    BEFORE: "before",
    BLUE: "blue",
    RED: "red",
    GREEN: "green",
    TORQUE: "torque",
    GAS: "gas",
    COUPLE: "couple",
}
_LETTER = 0.1
_WIDE_LETTER = 0.19  # width of a letter and of a wide letter in a title, inches
_LEGEND_LETTER = 0.062  # width of a letter in a legend, inches
_LEGEND_LINE = 0.35  # width of a line in a legend with the gaps beside it, inches
_LABELS = 0.8  # width of ticks and labels on the left of axes, inches
_ROW = 12.5  # height of a row of a legend, points

STYLE = Path(__file__).with_name("balcli.mplstyle")
# Font families with Chinese, Japanese and Korean glyphs; the first that is installed is used.
_EASTERN = ("Noto Sans CJK SC", "Microsoft YaHei", "PingFang SC", "Arial Unicode MS")
_UNDATED: dict[Form, Look] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}
_one_at_a_time = RLock()


@cache
def _find_figure_class() -> type[Figure]:
    """Return the class of all figures; matplotlib is imported when the first figure is opened."""
    from matplotlib.figure import Figure

    class Picture(Figure):
        """A figure without a window; files and notebooks show it in its current state."""

        def savefig(self, fname: Any, **kwargs: Any) -> None:
            """Write the figure, as `matplotlib.figure.Figure.savefig` does."""
            with in_our_style():
                super().savefig(fname, **kwargs)

        def _repr_png_(self) -> bytes:
            buffer = BytesIO()
            self.savefig(buffer, format="png", dpi=100)  # fits the column of a notebook
            return buffer.getvalue()

    return Picture


@contextmanager
def open_figure(width: float, height: float) -> Iterator[Figure]:
    """Open a figure; anything drawn within the context has the style of balcli.

    Args:
        width: Width, inches.
        height: Height, inches.
    """
    with in_our_style():
        yield _find_figure_class()(figsize=(width, height), layout="constrained")


@contextmanager
def in_our_style() -> Iterator[None]:
    """Set balcli's style in place of the user's within the context. Only one thread at a time may
    enter, since matplotlib has one style for all threads.
    """
    with _one_at_a_time, warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        logger = logging.getLogger("matplotlib")
        level = logger.level
        logger.setLevel(logging.ERROR)  # "building the font cache" does not concern the user
        try:
            import matplotlib
            from matplotlib.font_manager import get_font_names

            with matplotlib.rc_context():
                matplotlib.rcdefaults()
                matplotlib.rc_file(STYLE, use_default_template=False)
                eastern = [family for family in _EASTERN if family in get_font_names()][:1]
                matplotlib.rcParams["font.family"] = ["sans-serif", *eastern]
                yield
        finally:
            logger.setLevel(level)


def save_figure(figure: Figure, form: Form) -> bytes:
    """Return a figure as the content of a file; equal figures have equal bytes.

    Args:
        figure: Figure to save.
        form: Format of the file.
    """
    with in_our_style():
        buffer = BytesIO()
        figure.savefig(buffer, format=form, metadata=_UNDATED[form])
        return buffer.getvalue()


def save_pages(figures: Iterable[Figure]) -> bytes:
    """Return figures as the pages of one PDF."""
    with in_our_style():
        from matplotlib.backends.backend_pdf import PdfPages

        buffer = BytesIO()
        with PdfPages(buffer, metadata=_UNDATED["pdf"]) as pages:
            for figure in figures:
                figure.savefig(pages, format="pdf")
        return buffer.getvalue()


def inline_svg(svg: bytes, name: str) -> str:
    """Return an SVG for an HTML page. It uses the page's colours (`--ink` ...) and the width of its
    column.

    Args:
        svg: Content of an SVG file.
        name: Prefix of its ids.
    """
    text = svg[svg.index(b"<svg") :].decode()
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.S)
    text = re.sub(r"<[^>]*>", lambda tag: _adapt_tag(tag[0], name), text)
    size = r'(<svg[^>]*?) width="([\d.]+)pt" height="[\d.]+pt"'
    return re.sub(size, r'\1 style="max-width: \2pt"', text, count=1)


def _adapt_tag(tag: str, name: str) -> str:
    tag = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", tag)
    return re.sub("|".join(NAMES), lambda colour: f"var(--{NAMES[colour[0]]})", tag)


def fit_name(name: str, most: int = 90) -> str:
    """Return a name on one line, without control characters.

    Args:
        name: Any text.
        most: Largest number of letters.
    """
    printable = [letter if letter.isprintable() else " " for letter in name]
    text = " ".join("".join(printable).split())
    if len(text) <= most:
        return text
    return text[: most - 1].rstrip() + "…"


def put_title(fig: Figure, text: str) -> None:
    """Put a title over a figure, on as many lines as it needs.

    Args:
        fig: Figure to change.
        text: Title.
    """
    wide = any(east_asian_width(letter) in "WF" for letter in text)
    letters = int(fig.get_figwidth() / (_WIDE_LETTER if wide else _LETTER))
    lines = []
    for line in text.splitlines():
        lines += wrap(line, letters)
    fig.suptitle("\n".join(lines), x=0.01, ha="left")


def put_legend_above(ax: Axes, columns: int = 4) -> None:
    """Put the legend between the axes and their title.

    Args:
        ax: Axes to change.
        columns: Largest number of columns.
    """
    labels = ax.get_legend_handles_labels()[1]
    width = measure_room(ax)[0] - _LABELS
    columns = min(columns, len(labels))
    while columns > 1 and _measure_legend(labels, columns) > width:
        columns -= 1
    legend = ax.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=columns)
    legend.set_in_layout(False)  # a long legend must not narrow the axes
    rows = -(-len(labels) // columns) if columns else 0
    if rows > 1:
        import matplotlib

        pad = matplotlib.rcParams["axes.titlepad"] + _ROW * (rows - 1)
        ax.set_title(ax.get_title("left"), pad=pad)


def _measure_legend(labels: Sequence[str], columns: int) -> float:
    """Return the width of a legend, inches. It is filled column by column."""
    rows = -(-len(labels) // columns)
    width = 0.0
    for start in range(0, len(labels), rows):
        longest = max(map(len, labels[start : start + rows]))
        width += _LEGEND_LINE + _LEGEND_LETTER * longest
    return width


def measure_room(ax: Axes) -> tuple[float, float]:
    """Return the width and height of the part of its figure that axes have, inches."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    width, height = figure.get_size_inches()
    spec = ax.get_subplotspec()
    if spec is None:
        return float(width), float(height)
    rows, columns = spec.get_gridspec().get_geometry()
    return float(width * len(spec.colspan) / columns), float(height * len(spec.rowspan) / rows)
