"""One style for all pictures, and the one place that owns figures: nothing global is left changed,
no display is needed.
"""

from __future__ import annotations

import logging
import re
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from io import BytesIO
from textwrap import wrap
from threading import RLock
from typing import TYPE_CHECKING, Any, Literal
from unicodedata import east_asian_width

from .legends import fold_wide_legends

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .picture import Picture

Form = Literal["svg", "png", "pdf"]

# Wong, Nature Methods 8 (2011) 441: told apart by colour-blind readers; line styles and hatches do
# it in black and white.
INK, SOFT, FAINT, PAPER = "#1a1a1a", "#6b6b6b", "#d4d4d4", "#ffffff"
_LETTER, _EASTERN_LETTER = 0.1, 0.19  # width in a title, inches
BLUE, RED, GREEN = "#0072b2", "#d55e00", "#009e73"
# Of up to twelve curves: neighbours are told apart in grey, too.
MANY_LOOKS = (*zip(("-", "--", ":") * 4, (BLUE, RED, GREEN, INK) * 3, strict=True),)
NAMES = {
    INK: "ink",
    SOFT: "soft",
    FAINT: "faint",
    PAPER: "paper",
    BLUE: "blue",
    RED: "red",
    GREEN: "green",
}

STYLE: Any = {
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial"],
    "font.size": 9,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.labelsize": 8.5,
    "legend.fontsize": 8,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "figure.titlesize": 12,
    "figure.titleweight": "bold",
    "text.parse_math": False,
    "axes.unicode_minus": True,
    "axes.formatter.use_mathtext": False,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.edgecolor": SOFT,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.labelcolor": INK,
    "grid.color": FAINT,
    "grid.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlelocation": "left",
    "axes.titlepad": 17,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "hatch.linewidth": 0.6,
    "hatch.color": PAPER,
    "figure.facecolor": PAPER,
    "axes.facecolor": "none",
    "savefig.facecolor": PAPER,
    "savefig.dpi": 160,
    "svg.fonttype": "none",
    "svg.hashsalt": "balcli",
    "pdf.fonttype": 42,
}
# Families with Chinese, Japanese and Korean glyphs, for names that need them; SVG leaves that to
# the reader's fonts.
_EAST = (
    "Noto Sans CJK SC",
    "Noto Sans CJK JP",
    "Source Han Sans SC",
    "WenQuanYi Micro Hei",
    "Droid Sans Fallback",
    "Microsoft YaHei",
    "PingFang SC",
    "Hiragino Sans",
    "Malgun Gothic",
    "Arial Unicode MS",
)
_one_at_a_time = RLock()
_UNDATED = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}


@contextmanager
def open_figure(width: float, height: float, form: Form) -> Iterator[Picture]:
    """A figure of that size in inches, for which everything is drawn in our style."""
    with in_our_style(form):
        from .picture import Picture

        yield Picture(figsize=(width, height), layout="constrained")


@contextmanager
def in_our_style(form: Form) -> Iterator[None]:
    """What is drawn in this context is drawn in our style, whatever the user's own is. Threads draw
    one after the other, for matplotlib has one style for all.
    """
    with _one_at_a_time, _set_log_level(), _set_style(form):
        yield


@contextmanager
def _set_log_level() -> Iterator[None]:
    logger = logging.getLogger("matplotlib")
    usual = logger.level
    logger.setLevel(logging.ERROR)  # "building the font cache" is no news for our users
    try:
        yield
    finally:
        logger.setLevel(usual)


@contextmanager
def _set_style(form: Form) -> Iterator[None]:
    import matplotlib

    with warnings.catch_warnings(), matplotlib.rc_context():
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        matplotlib.rcdefaults()  # whatever the user's own matplotlibrc says
        matplotlib.rcParams.update(
            STYLE | {"font.family": ["sans-serif", *(_eastern_families() if form != "svg" else ())]}
        )
        yield


def lay_out_figure(figure: Figure) -> None:
    """Find places for everything in a figure."""
    lay_out = figure.get_layout_engine()
    if lay_out is not None:
        lay_out.execute(figure)
        if fold_wide_legends(figure):
            lay_out.execute(figure)


def save_figure(figure: Figure, form: Form) -> bytes:
    """The picture as a file's content; the same figure gives the same bytes. Nothing can be changed
    in the figure afterwards.
    """
    with in_our_style(form):
        return _save(figure, form)


def save_pages(figures: Iterable[Figure]) -> bytes:
    """Pictures as the pages of one PDF; else as of `save_figure`."""
    with in_our_style("pdf"):
        from matplotlib.backends.backend_pdf import PdfPages

        buffer = BytesIO()
        with PdfPages(buffer, metadata=_UNDATED["pdf"]) as pages:
            for figure in figures:
                _place(figure)
                figure.savefig(pages, format="pdf")
        return buffer.getvalue()


def _save(figure: Figure, form: Form) -> bytes:
    _place(figure)
    buffer = BytesIO()
    figure.savefig(buffer, format=form, metadata=_UNDATED[form])
    return buffer.getvalue()


def _place(figure: Figure) -> None:
    """Find the same places for everything on every machine."""
    lay_out_figure(figure)
    figure.set_layout_engine(None)  # matplotlib would lay it out again, and draw it twice
    for ax in figure.axes:  # the solver of the layout is exact to the last bits only
        left, bottom, width, height = (round(edge, 5) for edge in ax.get_position().bounds)
        ax.set_position((left, bottom, width, height))


def inline_svg(svg: bytes, name: str) -> str:
    """An SVG to stand in a page: colours follow the page's (`--ink` ...), ids are its own, and it
    grows with its column.
    """
    text = svg.decode()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.S)
    text = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", text)
    text = re.sub(
        r'(<svg[^>]*?) width="([\d.]+)pt" height="[\d.]+pt"',
        r'\1 style="max-width: \2pt"',
        text,
        count=1,
    )
    return re.sub("|".join(NAMES), lambda colour: f"var(--{NAMES[colour[0]]})", text)


def fit_name(name: str, most: int = 90) -> str:
    """A name on one line that any format can hold, not longer than a title may be."""
    text = "".join(c if c.isprintable() else " " for c in name)
    text = " ".join(text.split())
    return text if len(text) <= most else text[: most - 1].rstrip() + "…"


def put_title(fig: Figure, text: str) -> None:
    """A title over a figure, on as many lines as its width asks for."""
    eastern = any(east_asian_width(letter) in "WF" for letter in text)
    letters = int(fig.get_figwidth() / (_EASTERN_LETTER if eastern else _LETTER))
    lines = [part for line in text.splitlines() for part in wrap(line, letters)]
    fig.suptitle("\n".join(lines), x=0.01, ha="left")


@lru_cache(1)
def _eastern_families() -> tuple[str, ...]:
    """The first of the families with Eastern glyphs that is installed, if any."""
    from matplotlib import font_manager

    there = {font.name for font in font_manager.fontManager.ttflist}
    return tuple(family for family in _EAST if family in there)[:1]
