"""A page of its own: what the engine is and does, drawn, in tables, and in motion. Nothing in it is
loaded from elsewhere.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.telling import Tell, tell_nobody
from ..results.analysis import Analysis
from ..results.balance import Balance
from ..studies.pictures import Study
from ..version import __version__
from . import analysis, balance
from .page_scene import scene
from .plot.names import OF_TORSION
from .plot.pages import PageSubject, draw_panel
from .plot.style import inline_svg, save_figure
from .sheet import Facts, Grid, Text
from .units import System
from .view import ON_A_PAGE

if TYPE_CHECKING:
    from markupsafe import Markup

    from ..engine.build import Engine
    from ..mounting.records import MountReport
    from ..torsion.analysis import TorsionAnalysis

FOLDER = Path(__file__).with_name("page")
_PICTURES = (
    ("polar", "force"),
    ("polar", "moment"),
    ("spectrum", "force"),
    ("spectrum", "moment"),
    ("curves", "force"),
    ("curves", "moment"),
    ("spectrum", "about"),
    ("curves", "about"),
)
_COMPARED = (("polar", "force"), ("polar", "moment"), ("spectrum", "force"), ("spectrum", "moment"))


def page(
    result: Analysis,
    balanced: Balance,
    system: System,
    mounted: MountReport | None = None,
    twisted: TorsionAnalysis | None = None,
    turning: Engine | None = None,
    tell: Tell = tell_nobody,
) -> str:
    """The report of an engine, of a remedy for it, of what it does on its mounts, of how its
    crankshaft twists, and of what its gas does. Whatever comes from the engine file is escaped.
    `tell` is told which share of the pictures of forces and moments is drawn.
    """
    from markupsafe import Markup

    own, remedy = analysis.sheet(result, system, ON_A_PAGE), balance.sheet(balanced, system)
    told = ("force", "about", *(["moment"] if result.moments_known else []))
    fitted = bool(balanced.remedy.reasons)
    compared = _COMPARED if fitted else ()
    now = PageSubject(Study(result), system)
    after = PageSubject(Study(balanced.after, balanced.before, balanced.remedy), system)
    alone = _choose_panels(now, _PICTURES, told)
    beside = _choose_panels(after, compared, told)
    pictures = []
    for panel in (*alone, *beside):
        pictures.append(Markup(draw_panel(*panel)))
        tell(len(pictures) / (len(alone) + len(beside)))
    return _template().render(
        title=own.title,
        version=__version__,
        facts=own.parts[0],
        verdict=next((part for part in own.parts if part.title == "Verdict"), None),
        figures=[part for part in own.parts[1:] if part.title != "Verdict"],
        remedy=remedy.parts,
        fitted=fitted,
        scene=scene(result, balanced.after if fitted else None, system),
        pictures=pictures[: len(alone)],
        compared=pictures[len(alone) :],
        style=_read("report.css"),
        script=_read("report.js"),
        **_gather_chapters(mounted, twisted, turning, system),
    )


def _gather_chapters(
    mounted: MountReport | None,
    twisted: TorsionAnalysis | None,
    turning: Engine | None,
    system: System,
) -> dict[str, Any]:
    """What the template takes of mounts, torsion and gas; None of a chapter that is not there."""
    from markupsafe import Markup

    chapters: dict[str, Any] = {"mounts": None, "torsion": None, "running": None}
    if turning is not None:
        from . import page_torque  # for files with gas

        chapters |= {
            "running": page_torque.running(turning, system),
            "running_script": _read("running.js"),
        }
    if mounted is not None:
        from . import mounts, page_mounts  # for files that have mounts

        chapters |= {
            "mounts": mounts.sheet(mounted, system),
            "rocking": page_mounts.rocking(mounted),
            "rocking_script": _read("rocking.js"),
        }
    if twisted is not None:
        from . import torsion  # for files that have it
        from .plot.torsion import make_torsion

        chapters |= {"torsion": torsion.sheet(twisted, system), "twists": []}
        for what in OF_TORSION:
            figure = make_torsion(twisted, what, system, titled=False)
            svg = inline_svg(save_figure(figure, "svg"), f"torsion-{what}")
            chapters["twists"].append(Markup(svg))
    return chapters


def _read(name: str) -> Markup:
    """A script or style of the page, as it is."""
    from markupsafe import Markup

    return Markup((FOLDER / name).read_text(encoding="utf-8"))


def _choose_panels(
    subject: PageSubject, panels: Sequence[tuple[str, str]], told: Collection[str]
) -> list[tuple[PageSubject, str, str]]:
    """Those of the quantities that are told; of one without a picture the first, which says so."""
    chosen: list[tuple[PageSubject, str, str]] = []
    for what, quantity in panels:
        is_first = all(quantity != other for _, _, other in chosen)
        if quantity in told and (is_first or not subject.find_words(quantity)):
            chosen.append((subject, what, quantity))
    return chosen


def kind(part: Grid | Facts | Text) -> str:
    """Which macro of the template shows a part."""
    return type(part).__name__.lower()


def _template() -> Any:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.policies["json.dumps_kwargs"] = {"allow_nan": False, "separators": (",", ":")}
    environment.filters["kind"] = kind
    return environment.get_template("report.html")
