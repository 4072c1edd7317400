"""Write a self-contained HTML page on an engine, with pictures, tables and animation. Its scripts
get the mechanism (mm, deg), its forces and moments, the body on its mounts (mm, rad), and torque
and pressure over the cycle.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import quote

import numpy as np
import tomli_w

from ..analysis import show as analysis
from ..analysis.answer import Analysis, analyze
from ..analysis.curves import compute_cylinder_curves
from ..analysis.devices_show import device_grid
from ..analysis.ladder_show import ladder_grid
from ..analysis.order_tables import gas_grid
from ..analysis.overview import roll_and_peaks
from ..analysis.piston import choose_unit
from ..balancing import show as balancing
from ..balancing.answer import Balance, balance
from ..core.mechanisms.linkage import Articulated, Rotary
from ..core.phasors import Array
from ..core.records import Node
from ..crank_torque.answer import choose_firing_cylinder
from ..engine.engine import Engine, find_row, take_model
from ..errors import BalcliError, name_option, warn
from ..file.model import EngineFile
from ..forces.curves import find_torque_curves
from ..forces.spectrum import take_gas
from ..limits import SMALL
from ..mounting import show as mounts
from ..mounting.answer import report_mounts
from ..mounting.records import MountReport
from ..mounting.rigid_body import PROJECTION, find_corners
from ..show.engine_facts import engine_facts, tell_pivot
from ..show.figures import clean
from ..show.plot_style import inline_svg, save_figure
from ..show.sheet import NAMELESS, WITHOUT_HINTS, Facts, Grid, Text
from ..show.units import SI, System
from ..sizing.ladder import find_ladder
from ..sizing.options import SchemeOptions
from ..torsional_vibration import plot as twisting, show as torsion
from ..torsional_vibration.answer import TorsionAnalysis, TorsionQuestion, answer_question
from ..torsional_vibration.load import make_source
from ..torsional_vibration.quantity import choose_torsion_speeds
from ..version import __version__
from .figures import describe_figures
from .live import describe_one, describe_page, explain_still
from .names import OF_TORSION
from .slim_svg import slim_svg
from .slim_text import slim_script, slim_style

if TYPE_CHECKING:
    from jinja2 import Template


ASSUMED_BORE = 0.95  # bore over stroke for drawing pistons if the file gives no bore


def scene(engine: Engine) -> Node:
    """Return the mechanism for the moving drawing. If the file gives `frame.up`, the drawing is
    turned so that this direction is up.
    """
    stroke = 2e3 * float(engine.cylinders.radius.max())
    bore = clean(engine.bore_m * 1e3)
    return {
        "stroke": stroke,
        "bore": bore or ASSUMED_BORE * stroke,
        "rotary": isinstance(engine.cylinders.linkage, Rotary),
        "cylinders": _cylinder_entries(engine),
    }


def _cylinder_entries(engine: Engine) -> list[Node]:
    """Return an entry for each cylinder, mm and degrees: axis, angle of the crank pin from this
    axis at crank angle 0, rod length (0 in harmonic motion), offset and position; the crank radius
    if the radii differ; for an articulated rod, its knuckle pin and its master cylinder's index.
    """
    c = engine.cylinders
    linkage = engine.cylinders.linkage
    rods = linkage.hung if isinstance(linkage, Rotary) else linkage
    columns = {
        "number": engine.numbers,
        "axis": c.axis_of_each_deg - (engine.up_deg or 0.0),
        "phase": c.angle_deg,
        "z": c.z * 1e3,
        "rod": np.broadcast_to(0.0 if c.harmonic else np.ravel(c.rod_length) * 1e3, c.count),
        "offset": np.broadcast_to(np.ravel(c.offset) * 1e3, c.count),
    }
    if len(c.radius) > 1:
        columns["radius"] = c.radius * 1e3
    lists = [np.asarray(column).tolist() for column in columns.values()]
    entries = [dict(zip(columns, values, strict=True)) for values in zip(*lists, strict=True)]
    if isinstance(rods, Articulated):
        pins = np.ravel(rods.knuckle) * c.radius * 1e3
        for row, entry in enumerate(entries):
            if rods.master[row] != row:
                entry["master"] = int(rods.master[row])
                entry["knuckle"] = [float(pins[row].real), float(pins[row].imag)]
                entry["lead"] = float(rods.lead_deg[row])
    return entries


FOLDER = Path(__file__).with_name("assets")


class Answers(NamedTuple):
    """Results on the page of an engine. `mounted` is None without a result for [body], `twisted`
    without one for [torsion]. `cylinder`: whose piston's motion is drawn; None: no such picture.
    """

    result: Analysis
    balanced: Balance
    mounted: MountReport | None = None
    twisted: TorsionAnalysis | None = None
    cylinder: int | None = None


def find_answers(
    model: EngineFile,
    engine: Engine,
    orders: Sequence[float] | None,
    scheme: str,
    options: SchemeOptions,
    name: str,
) -> Answers:
    """Compute the results on an engine's page, with mounts and torsion if its file has them.

    Args:
        model: Tables of the file.
        engine: Engine of the file.
        orders: Orders to show; None: the default.
        scheme: Balance scheme.
        options: Options of the scheme.
        name: Name of the file, for messages.

    Raises:
        BalcliError: The scheme does not fit the engine.
    """
    result = analyze(engine, orders, small=options.read_small())
    balanced = balance(engine, scheme, options, orders)
    mounted = twisted = None
    if model.body:
        fitted = scheme if balanced.remedy.reasons else None  # without devices, no comparison
        with _warning("mounts"):
            mounted = report_mounts(model, engine, scheme=fitted, name=name, options=options)
    if model.torsion:
        with _warning("torsion"):
            question = TorsionQuestion(choose_torsion_speeds(engine))
            twisted = answer_question(make_source(model, engine, name), question)
    return Answers(result, balanced, mounted, twisted)


@contextmanager
def _warning(chapter: str) -> Iterator[None]:
    """Turn an error within the context into a warning that the page lacks the part `chapter`."""
    try:
        yield
    except BalcliError as error:
        warn(f"the page does not show the {chapter}: {error.tell(name_option)}")


class Site(NamedTuple):
    """What a page of a site has beyond one that is kept as a file.

    Attributes:
        docs: Address of the documentation, to which the name of the program links.
        links: Words and addresses of further links in the header.
        tags: Names and contents of the tags by which other sites show a link to the page.
    """

    docs: str
    links: tuple[tuple[str, str], ...] = ()
    tags: tuple[tuple[str, str], ...] = ()


def load_asset(name: str) -> str:
    """Return the text of a file of the page."""
    return (FOLDER / name).read_text(encoding="utf-8").strip()


def page(
    answers: Answers,
    system: System,
    live: Node | None = None,
    file: str = "",
    small: float = SMALL,
    site: Site | None = None,
) -> str:
    """Return the page of an engine: forces and moments, devices of a balance scheme, vibration on
    mounts, torsional vibration, and gas. All text from the engine file is escaped.

    Args:
        answers: Results to show.
        system: Units of figures and pictures.
        live: Data for changing numbers, from `live.make_book`; None: nothing can be changed.
        file: Name of the engine file; empty if unknown.
        small: Share of one cylinder's first order below which a force or moment is ignored.
        site: Site of which the page is a part; None: the page is a file of its own.

    Raises:
        BalcliError: The engine does not have the cylinder whose piston is wanted.
    """
    result, balanced, mounted, twisted, cylinder = answers
    engine = result.engine
    drawn = None if engine.placed else scene(engine)  # several cranks are not drawn
    motion = None if cylinder is None else trace_piston(engine, cylinder, system)
    return load_template().render(
        live=shorten_numbers(live),
        still=explain_still(engine),
        title=engine.name or NAMELESS,
        version=__version__,
        site=site,
        icon=quote(load_asset("icon.svg")),
        file=Path(file).name or "the file",
        parts=lay_out(result, balanced, system),
        data=describe_page(engine, system, file, small),
        figures=shorten_numbers(describe_figures(result, balanced, small), _FIGURES),
        scene=shorten_numbers(drawn),
        running=running(engine, system) if engine.gas and drawn else None,
        motion=motion,
        mounts=None if mounted is None else mounts.sheet(mounted, system),
        rocking=None if mounted is None else rocking(mounted),
        torsion=None if twisted is None else torsion.sheet(twisted, system),
        twists=None if twisted is None else pack(list(draw_torsion(twisted, system))),
    )


class PageParts(NamedTuple):
    """Parts of the page that the command prints as well; None: the engine has no such part. `pivot`
    is the name of the axis or point about which couple and roll are taken.
    """

    facts: Facts
    verdict: Text | None
    orders: Grid
    couple: Grid | None
    pivot: str
    largest: Facts
    gas: Grid | None
    ladder: Grid
    devices: Grid
    remedy: list[Grid | Facts | Text]
    others: list[Text]


def lay_out(result: Analysis, balanced: Balance, system: System) -> PageParts:
    """Return the parts of the page that the command prints as well."""
    engine = result.engine
    pivot = tell_pivot(engine)
    every = hasattr(balanced, "every_order") and balanced.every_order
    view = WITHOUT_HINTS._replace(every_order=every)
    ladder = getattr(balanced, "ladder", None) or find_ladder(engine)
    usual = balanced.remedy.scheme == "auto"
    return PageParts(
        facts=engine_facts(engine, system, whole=False),
        verdict=next(analysis.lay_out_verdict(result, system), None),
        orders=next(analysis.lay_out_orders(result, system, view)),
        couple=next(analysis.lay_out_couple(result, system), None),
        pivot=pivot,
        largest=roll_and_peaks(result, system, every_order=every),
        gas=next(gas_grid(result.spectra, system, pivot, view), None),
        ladder=ladder_grid(ladder, engine, system, tell_fitted=usual, tell_skirt=True),
        devices=device_grid(balanced.remedy, system),
        remedy=list(balancing.lay_out_remedy(balanced, system, with_table=False)),
        others=list(analysis.tell_uncounted(result)),
    )


class Explorer:
    """The page of an engine in a frame of a notebook.

    Args:
        text: The page.
    """

    def __init__(self, text: str) -> None:
        self._text = text

    def _repr_html_(self) -> str:
        style = "width:100%;height:900px;border:1px solid #ccc"
        return f'<iframe style="{style}" srcdoc="{escape(self._text, quote=True)}"></iframe>'


def explore(engine: Engine) -> Explorer:
    """Return the page of an engine for a notebook (`api.Engine.explore`)."""
    model = take_model(engine)
    found = find_answers(model, engine, None, "auto", SchemeOptions(), engine.name or "engine")
    live = describe_one(model, engine, tomli_w.dumps(engine.to_dict()), engine.name)
    return Explorer(page(found, SI, live, engine.name))


_FIGURES = 12  # significant digits of the figures on the page


def shorten_numbers(node: Any, digits: int = 17) -> Any:
    """Return a document for a page: its numbers have so many significant digits, and a whole number
    is written without a fraction.
    """
    if isinstance(node, dict):
        return {key: shorten_numbers(value, digits) for key, value in node.items()}
    if isinstance(node, (list, tuple)):
        return [shorten_numbers(value, digits) for value in node]
    if not isinstance(node, float):
        return node
    rounded = float(f"{node:.{digits}g}")
    is_short = rounded.is_integer() and abs(rounded) < 10**_FIGURES
    return int(rounded) if is_short else rounded


def draw_torsion(twisted: TorsionAnalysis, system: System) -> Iterator[str]:
    """Yield the pictures of the torsion as SVG."""
    for what in OF_TORSION:
        figure = twisting.make_torsion(twisted, what, system, titled=False)
        yield slim_svg(inline_svg(save_figure(figure, "svg"), f"torsion-{what}"))


def pack(data: Sequence[str]) -> str:
    """Return texts as JSON, deflated and written as base64url (`assets/packed.js` reads it)."""
    deflated = zlib.compress(json.dumps(data, ensure_ascii=False).encode(), 9)
    return base64.urlsafe_b64encode(deflated).decode().rstrip("=")


@cache
def read_asset(name: str) -> str:
    """Return a script or style sheet as it stands in a page, which is kept and sent."""
    text = (FOLDER / name).read_text(encoding="utf-8")
    return slim_style(text) if name.endswith(".css") else slim_script(text)


def mark_code(text: str) -> str:
    """Return a sentence of the command as HTML; what stands between backticks is code."""
    return re.sub("`([^`]+)`", r"<code>\1</code>", escape(text))


def load_template() -> Template:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FileSystemLoader(FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals["read_asset"] = lambda name: Markup(read_asset(name))
    environment.filters["code"] = lambda text: Markup(mark_code(text))
    environment.policies["json.dumps_kwargs"] = {"allow_nan": False, "separators": (",", ":")}
    return environment.get_template("report.html")


_SPEEDS = 48  # largest number of speeds on the page


def rocking(result: MountReport) -> Node | None:
    """Return the block and its mounts relative to the centre of gravity, and the block's motion by
    speed and order: cosine coefficients, then sine coefficients, each of three displacements (mm)
    and three rotations (rad). None for mounts without an engine.
    """
    if not hasattr(result, "response"):
        return None
    response = result.response
    body = result.mounted.body
    count = len(response.speeds_rpm)
    rows = np.linspace(0, count - 1, min(count, _SPEEDS)).round().astype(int)
    motion = np.moveaxis(response.body[:, rows], 1, 0) * np.repeat([1e3, 1.0], 3)
    parts = np.concatenate([motion.real, -motion.imag], axis=-1)
    return {
        "projection": PROJECTION.tolist(),
        "corners": (1e3 * find_corners(body)).round(3).tolist(),
        "mounts": (1e3 * (result.mounted.dynamic.at - body.centre)).round(3).tolist(),
        "speeds": _rounded(response.speeds_rpm[rows]),
        "orders": [passed.order for passed in response.passed],
        "motion": [[_rounded(order) for order in _drop_unseen(speed)] for speed in parts],
    }


_UNSEEN = 1e-3  # share of the largest motion at a speed that nobody sees in the drawing


def _drop_unseen(parts: Array) -> Array:
    """Return the motion at a speed without what is too small to be seen.

    Args:
        parts: Cosine and sine coefficients, shape (orders, 12): three displacements and three
            rotations of each.
    """
    sizes = np.abs(parts).reshape(len(parts), 2, 2, 3)  # orders, cosine or sine, shift or turn
    largest = sizes.max(axis=(0, 1, 3), keepdims=True, initial=0.0)
    seen = (sizes > _UNSEEN * largest).reshape(parts.shape)
    return np.where(seen, parts, 0.0)


_STEP = 2.0  # step of the crank angle, deg


def running(engine: Engine, system: System) -> Node:
    """Return torque and pressure over one cycle, at equal steps of the crank angle, with units."""
    gas = take_gas(engine)
    curves = find_torque_curves(replace(engine, ripple=()))
    at = np.radians(np.arange(0.0, gas.cycle_deg + _STEP / 2, _STEP))
    total = curves.total.at(at)
    unit = system.moment.fit(float(np.abs(total).max()))
    shown: list[Node] = [
        {
            "id": "torque",
            "unit": unit.name,
            "total": _rounded(total / unit.size),
            "gas": _rounded(curves.gas.at(at) / unit.size),
            "mean": float(f"{curves.total.mean / unit.size:.5g}"),
        }
    ]
    number = choose_firing_cylinder(engine)
    first = gas.cylinders[engine.numbers.index(number)]
    if first.torque.pressure is not None:
        ends = first.torque.ends
        pressures = [first.find_end_pressure(end, at - first.fires) for end in ends]
        unit = system.pressure.fit(max(float(pressure.max()) for pressure in pressures))
        curve: Node = {"id": "pressure", "unit": unit.name}
        for name, pressure in zip(("total", "crank_end"), pressures, strict=False):
            curve[name] = _rounded(pressure / unit.size)
        shown.append(curve)
    return {"cycle": gas.cycle_deg, "step": _STEP, "cylinder": number, "curves": shown}


_MOTIONS = {  # titles, by names of curves
    "travel_m": "Travel from the outer dead centre",
    "velocity_m_per_s": "Velocity towards the crank",
    "acceleration_m_per_s2": "Acceleration towards the crank",
}


def trace_piston(engine: Engine, number: int, system: System) -> Node:
    """Return travel, velocity and acceleration of a piston over the crank angle from its cylinder's
    axis, at equal steps, with units.

    Raises:
        BalcliError: The engine has no such cylinder.
    """
    steady = replace(engine, ripple=())
    row = find_row(engine, number)
    own_deg = np.arange(0.0, 360 + _STEP / 2, _STEP)
    turned = own_deg - float(np.ravel(engine.cylinders.angle_deg)[row])
    curves = compute_cylinder_curves(steady, number, turned)
    shown: list[Node] = []
    for name, title in _MOTIONS.items():
        unit = choose_unit(name, system)
        values = _rounded(curves[name] / unit.size)
        shown.append({"id": name, "title": title, "unit": unit.name, "total": values})
    return {"cylinder": number, "curves": shown}


def _rounded(values: Array) -> list[float]:
    """Return values with the four digits that the page shows."""
    rounded = [float(f"{value:.4g}") for value in values.tolist()]
    return [int(value) if value.is_integer() else value for value in rounded]
