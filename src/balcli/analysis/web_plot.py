"""Draw webs of a crankshaft: outline, holes, centre of mass, and the room around it.

A web is seen from the free end, so that it turns clockwise. Where a piston is over it, the web is
drawn at the crank angle of the smallest gap, with this piston's cylinder upwards; otherwise its
crank pin is upwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.outline import trace
from ..engine.engine import Engine, take_model
from ..show.plot_style import (
    BEFORE,
    BLUE,
    FAINT,
    GREEN,
    INK,
    PAPER,
    RED,
    SOFT,
    Look,
    put_legend_above,
)
from ..show.sheet import number, size_text
from ..show.units import System
from ..sizing.web_clearance import Gap, PistonView, find_gap, view_piston
from .web_parts import describe_web, write_ranges

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..engine.webs.bodies import WebShape
    from ..engine.webs.build import CrankWeb
    from ..file.gas_tables import Bearing

_TURN = np.exp(1j * np.radians(np.arange(361)))
_MARGIN = 1.06  # half the side of the picture over the largest radius
_STEP_DEG = 0.1  # of the outline, to find the place of the gap
_CLEARANCE_ROUNDING_M = 1e-6


class _Nearest(NamedTuple):
    """The web of a kind that has the smallest gap to a piston; without one, the first web."""

    web: CrankWeb
    gap: Gap | None


class _View(NamedTuple):
    """Axes of a picture, the factor that turns places of the web into those of the picture, and the
    size of the unit of length, m.
    """

    ax: Axes
    turn: complex
    unit: float

    def draw(self, places: ArrayLike, look: Look) -> None:
        """Draw a line through places in the axes of the web, m."""
        path = np.asarray(places, complex) * self.turn / self.unit
        self.ax.plot(path.imag, path.real, **look)

    def fill(self, places: ArrayLike, look: Look) -> None:
        """Fill a shape in the axes of the web, m."""
        path = np.asarray(places, complex) * self.turn / self.unit
        self.ax.fill(path.imag, path.real, **look)


def draw_web(ax: Axes, engine: Engine, webs: Sequence[CrankWeb], system: System) -> None:
    """Draw a kind of web, at its smallest gap to a piston.

    Args:
        ax: Axes to draw on.
        engine: Engine of the webs.
        webs: Webs of one [[web]] table, which has an outline.
        system: System of units.
    """
    nearest = _find_nearest(engine, webs)
    web = nearest.web
    shape = web.body.shape
    assert shape is not None
    length = system.length
    piston = None if nearest.gap is None else view_piston(engine, web, nearest.gap)
    view = _View(ax, 1.0 if piston is None else piston.turn, length.size)
    crankcase = take_model(engine).frame.crankcase
    _draw_web_itself(view, engine, web, shape)
    look: Look = {"color": BLUE, "linewidth": 0.9, "linestyle": (0, (5, 2))}
    swing = shape.swing_radius
    view.draw(swing * _TURN, look | {"label": f"swing radius {size_text(swing, length)}"})
    room = swing
    if crankcase is not None:
        room = max(swing, crankcase / 1e3)
        label = f"crankcase {size_text(crankcase / 1e3, length)}"
        view.draw(crankcase / 1e3 * _TURN, {"color": SOFT, "linewidth": 2.2, "label": label})
    top = room
    if piston is not None and nearest.gap is not None:
        _draw_piston(view, engine, piston, nearest.gap)
        _draw_gap(view, engine, nearest, piston, system)
        top = max(room, piston.pin_height + 0.15 * room)
    side = _MARGIN * room / length.size
    limits = {"xlim": (-side, side), "ylim": (-side, _MARGIN * top / length.size)}
    ax.set(**limits, aspect="equal", xlabel=length.name, ylabel=length.name)
    ax.set_title(_name_webs(engine, webs, system))
    put_legend_above(ax, 3)


def _find_nearest(engine: Engine, webs: Sequence[CrankWeb]) -> _Nearest:
    """Return the web with the smallest gap to a piston."""
    nearest = _Nearest(webs[0], None)
    for web in webs:
        gap = find_gap(engine, web)
        if gap is None:
            continue
        if nearest.gap is None or round(gap.size, 9) < round(nearest.gap.size, 9):
            nearest = _Nearest(web, gap)
    return nearest


def _name_webs(engine: Engine, webs: Sequence[CrankWeb], system: System) -> str:
    """Return the numbers, the mass and the unbalance of webs that are alike, on two lines."""
    part = describe_web(engine, webs[0])
    unbalance = size_text(part.unbalance_kg_m, system.unbalance)
    if part.unbalance_own_deg is not None:
        unbalance += f" at {number(round(part.unbalance_own_deg, 9))}° from the pin"
    noun = "webs" if len(webs) > 1 else "web"
    thickness = f"{size_text(part.thickness_m, system.length)} thick"
    return (
        f"{noun} {write_ranges(web.number for web in webs)} (web.{part.table}), {thickness}\n"
        f"{size_text(part.mass_kg, system.mass)}, {unbalance}"
    )


def _draw_web_itself(view: _View, engine: Engine, web: CrankWeb, shape: WebShape) -> None:
    """Draw outline, holes, crank pin, main journal and centre of mass."""
    view.fill(trace(shape.outline), {"facecolor": FAINT, "edgecolor": INK, "linewidth": 1.4})
    for hole, density in zip(shape.holes, shape.hole_densities, strict=True):
        rim = complex(hole.x, hole.y) + hole.radius * _TURN
        look: Look = {"facecolor": PAPER, "edgecolor": INK}
        if density:
            look = {"facecolor": BEFORE, "edgecolor": INK, "label": f"slug {density / 1e3:g} g/cm³"}
        view.fill(rim, look)
    thin: Look = {"color": INK, "linewidth": 0.8, "linestyle": (0, (6, 2, 1, 2))}
    radius = float(np.ravel(engine.throw_radii_m)[web.throw])
    bearing: Bearing | None = take_model(engine).bearing
    if bearing is not None:
        circles = [(radius, bearing.pin_diameter), (radius, bearing.pin_bore)]
        circles += [(0.0, bearing.main_diameter), (0.0, bearing.main_bore)]
        for centre, diameter in circles:
            if diameter:
                view.draw(centre + diameter / 2e3 * _TURN, thin)
    for centre in (0.0, radius):
        view.draw([complex(centre)], {"marker": "+", "color": INK, "markersize": 8})
    centre_of_mass = web.body.unbalance / web.body.mass if web.body.mass else 0j
    dot: Look = {"marker": "o", "color": RED, "markersize": 5, "linestyle": ""}
    view.draw([centre_of_mass], dot | {"label": "centre of mass"})


def _draw_piston(view: _View, engine: Engine, piston: PistonView, gap: Gap) -> None:
    """Draw the lower part of a piston: its edge in the plane of the web's face, its sides up to the
    piston pin, and the line of its rod.
    """
    across = piston.edge.offset
    half = float(engine.bore_m) / 2
    low = piston.edge_height
    sides = [complex(piston.pin_height, across - half), complex(low, across - half)]
    sides += [complex(low, across + half), complex(piston.pin_height, across + half)]
    upright = _View(view.ax, 1.0, view.unit)
    upright.draw(sides, {"color": BEFORE, "linewidth": 1.0})
    edge = [complex(low, across + side * piston.edge.half_width) for side in (-1, 1)]
    label = f"piston {gap.cylinder} at {number(round(gap.crank_deg, 6))}°"
    upright.draw(edge, {"color": INK, "linewidth": 2.4, "label": label})
    pin = complex(piston.pin_height, across)
    upright.draw([pin], {"marker": "+", "color": INK, "markersize": 8})


def _draw_gap(
    view: _View, engine: Engine, nearest: _Nearest, piston: PistonView, system: System
) -> None:
    """Draw the gap between a web and a piston, with its size; red if it is too small."""
    web, gap = nearest
    assert gap is not None
    assert web.body.shape is not None
    outline = np.array(trace(web.body.shape.outline, _STEP_DEG)) * piston.turn
    low = piston.edge.offset - piston.edge.half_width
    high = piston.edge.offset + piston.edge.half_width
    edge = np.asarray(piston.edge_height + 1j * np.clip(outline.imag, low, high))
    is_over = outline.real > piston.edge_height  # a web that overlaps the piston
    apart = np.where(is_over & (edge.imag == outline.imag), -1, 1) * np.abs(edge - outline)
    row = int(apart.argmin())
    ends = np.array([outline[row], edge[row]]) / view.unit
    least = take_model(engine).web[web.table - 1].clearance / 1e3
    colour = GREEN if gap.size >= least - _CLEARANCE_ROUNDING_M else RED
    view.ax.plot(ends.imag, ends.real, color=colour, linewidth=2.4, solid_capstyle="butt")
    size = round(gap.size, 6) + 0.0
    text = f"gap {size_text(size, system.length)}"
    place = (float(ends.imag.mean()), float(ends.real.mean()))
    look: Look = {"xytext": (10, 12), "textcoords": "offset points", "color": colour}
    arrow: Look = {"arrowstyle": "-", "color": colour, "linewidth": 0.8}
    box: Look = {"facecolor": PAPER, "edgecolor": "none", "pad": 1.0}
    view.ax.annotate(text, place, fontsize=9, arrowprops=arrow, bbox=box, **look)
