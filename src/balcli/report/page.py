"""Write a self-contained HTML page on an engine, with pictures, tables and animation. Its scripts
get the mechanism (mm, deg), its forces and moments, the body on its mounts (mm, rad), and torque
and pressure over the cycle.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from html import escape
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import tomli_w

from ..analysis import show as analysis
from ..analysis.answer import Analysis, analyze
from ..balancing import show as balancing
from ..balancing.answer import Balance, balance
from ..core.cylinders import Device, DeviceKind
from ..core.mechanisms.linkage import Articulated, Rotary
from ..core.phasors import Array, Phasors, unit
from ..core.records import Node
from ..crank_torque.answer import choose_firing_cylinder
from ..engine.engine import Engine, take_model
from ..errors import BalcliError, name_option, warn
from ..file.fields import order_number
from ..file.model import EngineFile
from ..forces.curves import find_torque_curves
from ..forces.kinds import FORCE, FREE, MOMENT
from ..forces.spectrum import take_gas
from ..mounting import show as mounts
from ..mounting.answer import report_mounts
from ..mounting.records import MountReport
from ..mounting.rigid_body import PROJECTION, find_corners
from ..process import Tell, tell_nobody
from ..show.figures import clean
from ..show.plot_style import inline_svg, save_figure
from ..show.sheet import NEGLIGIBLE, ON_A_PAGE
from ..show.units import SI, ShownUnit, System
from ..sizing.options import SchemeOptions
from ..torsional_vibration import plot as twisting, show as torsion
from ..torsional_vibration.answer import TorsionAnalysis, TorsionQuestion, answer_question
from ..torsional_vibration.load import make_source
from ..torsional_vibration.quantity import choose_torsion_speeds
from ..version import __version__
from .live import describe_one, explain_still, name_unit
from .names import OF_TORSION
from .pages import PageSubject, draw_panel, make_page
from .study import Study, analyze_steps, compute_study

if TYPE_CHECKING:
    from jinja2 import Template


_YOKE = 3  # drawn distance from pin to piston in harmonic motion, in crank radii
_SHAFT_WIDTH = 1.6  # width of a shaft in the picture, in crank radii
ASSUMED_BORE = 0.95  # bore over stroke for drawing pistons if the file gives no bore


def scene(now: Analysis, shown: Mapping[str, Analysis], system: System) -> Node:
    """Return the data of the moving drawings: the mechanism, and forces and moments of each variant
    in `shown`. If the file gives `frame.up`, the drawings are turned so that this direction is up.
    """
    engine = now.engine
    stroke = 2e3 * float(engine.cylinders.radius.max())
    bore = clean(engine.bore_m * 1e3) or ASSUMED_BORE * stroke
    units = {}
    for kind in FREE:
        unit = system.unit(kind)
        least = unit.of(NEGLIGIBLE * now.of_one_cylinder[kind.name])
        units[kind.name] = {**name_unit(unit), "least": least}
    orders = []
    for order in now.orders:
        if any(_shakes(variant, order) for variant in shown.values()):
            orders.append(order_number(order))
    return {
        "stroke": stroke,
        "bore": bore,
        "rotary": isinstance(engine.cylinders.linkage, Rotary),
        "axes": ("x", "y") if engine.up_deg is None else FORCE.upright,
        "cylinders": _cylinder_entries(engine),
        "variants": [_variant_entry(*variant, system, bore) for variant in shown.items()],
        "units": units,
        "orders": orders,
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


def _variant_entry(label: str, result: Analysis, system: System, bore: float) -> Node:
    turn = -(result.engine.up_deg or 0.0)
    entry: Node = {"label": label, "force": [], "moment": []}
    for kind, phasors in result.spectra.vectors():
        if result.moments_known or kind is not MOMENT:
            entry[kind.name] = _vector_rows(phasors.turn(turn), system.unit(kind))
    drawn = place_beside(result.engine, bore / 1e3)
    entry["devices"] = []
    for k, device in enumerate(result.engine.devices):
        entry["devices"].append(_device_entry(device, drawn.get(k), turn))
    return entry


def _vector_rows(phasors: Phasors, unit: ShownUnit) -> list[list[float]]:
    """Return a row for each order: the order, forward x and y, backward x and y."""
    forward = phasors.forward / unit.size
    backward = phasors.backward / unit.size
    parts = (phasors.orders, forward.real, forward.imag, backward.real, backward.imag)
    rows: list[list[float]] = (np.stack(parts, axis=-1) + 0.0).tolist()
    return rows


def place_beside(engine: Engine, bore: float) -> dict[int, complex]:
    """Return positions next to the engine, by device index, for shafts that would be drawn within
    the circle of the crank pins. The real part of a position is upwards, the imaginary part to the
    right, m. Shafts that turn with the crank are to the right of the engine, others to its left.

    Args:
        bore: Cylinder bore, m.
    """
    c = engine.cylinders
    r = float(c.radius.max())
    leans = np.radians(c.axis_of_each_deg - (engine.up_deg or 0.0))
    rods = np.where(c.lam == 0, _YOKE * c.radius, c.rod_length)
    across = np.sin(leans)
    reach = c.radius + rods + bore
    width = float(np.max(np.abs(across) * reach + (1 - np.abs(across)) * bore, initial=1.5 * r))
    places: dict[int, complex] = {}
    rows: dict[tuple[int, bool], int] = {}  # by order and direction: place on its side, downwards
    for k, device in enumerate(engine.devices):
        if device.kind is not DeviceKind.SHAFT or abs(complex(device.place)) >= r:
            continue
        ahead = bool(device.forward)
        row = rows.setdefault((device.order, ahead), sum(way == ahead for _, way in rows))
        side = 1 if ahead else -1
        places[k] = complex(-_SHAFT_WIDTH * r * row, side * (width + r))
    return places


def _device_entry(device: Device, drawn: complex | None, turn_deg: float) -> Node:
    """Return a device for the page, turned by `turn_deg`: unbalance in g mm, position in mm. If
    `drawn` is given, the picture shows the device there instead of at its true position.
    """
    vectors = np.array([device.forward, device.backward, device.place])
    forward, backward, place = (unit(turn_deg) * vectors).tolist()
    place = place if drawn is None else drawn
    return {
        "order": order_number(device.order),
        "forward": [forward.real * 1e6, forward.imag * 1e6],
        "backward": [backward.real * 1e6, backward.imag * 1e6],
        "at": [place.real * 1e3, place.imag * 1e3],
        "z": float(device.z) * 1e3,
        "beside": drawn is not None,
    }


def _shakes(result: Analysis, order: float) -> bool:
    vectors = (phasors for _, phasors in result.spectra.vectors())
    return any(np.any((p.orders == order) & ~p.balanced) for p in vectors)


FOLDER = Path(__file__).with_name("assets")
_PICTURES = tuple(product(("force", "moment", "about"), ("spectrum", "curves")))
_COMPARED = (("force", "spectrum"), ("moment", "spectrum"))
# Pictures for a browser without JavaScript.
_STILL = (("force", "polar"), ("moment", "polar"))


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
    result = analyze(engine, orders)
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


def page(
    answers: Answers, system: System, live: Node | None = None, tell: Tell = tell_nobody
) -> str:
    """Return the page of an engine: forces and moments, devices of a balance scheme, vibration on
    mounts, torsional vibration, and gas. All text from the engine file is escaped.

    Args:
        answers: Results to show.
        system: Units of figures and pictures.
        live: Data of the panel of numbers, from `live.make_book`; None: no panel.
        tell: Progress callback; it receives the share of the pictures that are drawn.

    Raises:
        BalcliError: The engine does not have the cylinder whose piston is wanted.
    """
    result, balanced, mounted, twisted, cylinder = answers
    own = analysis.sheet(result, system, ON_A_PAGE)
    remedy = balancing.sheet(balanced, system)
    quantities = ["force", "about"]
    if result.moments_known:
        quantities.append("moment")
    compared = _COMPARED if balanced.remedy.reasons else ()
    now = PageSubject(Study(result), system)
    after = PageSubject(Study(balanced.after, balanced.before, balanced.remedy), system)
    drawn = None
    stars = ""
    loci: list[str] = []
    if not result.engine.placed:  # a mechanism of several cranks is not drawn
        drawn = scene(result, _list_variants(result, balanced), system)
        stars = _draw_page(PageSubject(compute_study(result.engine, "stars"), system), "stars")
        loci = _draw_panels(now, _STILL, quantities)
    pictures = _draw_panels(now, _PICTURES, quantities)
    tell(0.7)
    pictures_after = _draw_panels(after, compared, quantities)
    tell(1.0)
    return load_template().render(
        whole=True,
        live=live,
        still=explain_still(result.engine),
        title=own.title,
        version=__version__,
        facts=own.parts[0],
        verdict=next((part for part in own.parts if part.title == "Verdict"), None),
        figures=[part for part in own.parts[1:] if part.title != "Verdict"],
        remedy=remedy.parts,
        scene=drawn,
        pictures=pictures,
        stars=stars,
        piston=None if cylinder is None else _draw_page(now, "piston", cylinder),
        compared=pictures_after,
        loci=loci,
        running=running(result.engine, system) if result.engine.gas and drawn else None,
        mounts=None if mounted is None else mounts.sheet(mounted, system),
        rocking=None if mounted is None else rocking(mounted),
        torsion=None if twisted is None else torsion.sheet(twisted, system),
        twists=() if twisted is None else _draw_torsion(twisted, system),
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
    answers = find_answers(model, engine, None, "auto", SchemeOptions(), engine.name or "engine")
    live = describe_one(model, engine, SI, tomli_w.dumps(engine.to_dict()), engine.name)
    return Explorer(page(answers, SI, live))


def _list_variants(result: Analysis, balanced: Balance) -> dict[str, Analysis]:
    """Return the analyses to show, by label: the engine with the devices of each step of the ladder
    (balancing in steps), or as in the file if there is no ladder; and with the scheme's devices, if
    the scheme is not a step.
    """
    remedy = balanced.remedy
    shown = {"as in the file": result}
    is_row = False
    if hasattr(balanced, "ladder"):
        shown = analyze_steps(balanced.before.engine, balanced.ladder, result.orders)
        is_row = any(step.remedy.devices == remedy.devices for step in balanced.ladder.steps)
    if remedy.reasons and not is_row:
        shown[f"scheme {remedy.scheme}"] = balanced.after
    return shown


def _draw_page(subject: PageSubject, what: str, cylinder: int = 1) -> str:
    """Return a page of pictures as SVG."""
    figure = make_page(replace(subject, cylinder=cylinder), what, titled=False)
    return inline_svg(save_figure(figure, "svg"), what)


def _draw_torsion(twisted: TorsionAnalysis, system: System) -> Iterator[str]:
    """Yield the pictures of the torsion as SVG."""
    for what in OF_TORSION:
        figure = twisting.make_torsion(twisted, what, system, titled=False)
        yield inline_svg(save_figure(figure, "svg"), f"torsion-{what}")


def _draw_panels(
    subject: PageSubject, panels: Sequence[tuple[str, str]], quantities: Collection[str]
) -> list[str]:
    """Return pictures as SVG. A quantity without a picture has a single panel, at the end, with
    words in place of the picture.
    """
    words = {quantity: subject.find_words(quantity) for quantity in quantities}
    shown = [(what, name) for name, what in panels if name in quantities and not words[name]]
    worded = {name: (what, name) for name, what in reversed(panels) if words.get(name)}
    return [draw_panel(subject, *panel) for panel in (*shown, *worded.values())]


def load_template() -> Template:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
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
        "motion": [[_rounded(order) for order in speed] for speed in parts],
    }


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
        own = first.find_pressure(at - first.fires)
        unit = system.pressure.fit(float(own.max()))
        shown.append({"id": "pressure", "unit": unit.name, "total": _rounded(own / unit.size)})
    return {"cycle": gas.cycle_deg, "step": _STEP, "cylinder": number, "curves": shown}


def _rounded(values: Array) -> list[float]:
    return [float(f"{v:.5g}") for v in values.tolist()]
