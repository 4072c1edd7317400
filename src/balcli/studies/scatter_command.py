"""The command `balcli scatter`: its options, and its tables and CSV."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ..core.records import Node, to_document
from ..errors import MOMENTS_UNKNOWN, warn
from ..file.toml import name_file
from ..forces.kinds import DEFAULT_QUANTITIES
from ..shell.file_names import text_format
from ..shell.inputs import read_engine
from ..shell.options import EnginePath, FormatOption, Output
from ..shell.output import refuse_overwriting, show
from ..shell.progress import exit_if_cut_short, reporting_until_stopped
from ..shell.values import optional
from ..show.formats import Renderer, Rows
from ..show.sheet import NAMELESS, Column, Grid, Sheet, assumed_facts, count_name, number
from ..show.units import name_with_unit, unit_of_name
from .quantity_names import tell_speeds

if TYPE_CHECKING:
    from ..show.units import System
    from .deviations import Source
    from .scatter import Scatter, Spread

SHOWN = 6  # largest number of changes of each quantity in a table
BOUND = "Bound: nominal value plus the magnitudes of all single changes; variants may exceed it"
BY_FORMULAS = (
    "Throws: half of the difference of the two formulas by which their stiffness follows from "
    "dimensions."
)
_SHAPES = {
    "uniform": "deviations evenly distributed",
    "normal": (
        "deviations normally distributed with a third of the tolerance as standard deviation, so "
        "that 1 of 370 exceeds the tolerance"
    ),
}


def rows(result: Scatter, _system: System) -> Rows:
    """Return CSV with one quantity in each line, in SI units."""
    sizes = {name: _list_sizes(spread) for name, spread in result.quantities.items()}
    header = ("quantity", *next(iter(sizes.values())), "unit")
    lines = [(name, *each.values(), result.units[name] or None) for name, each in sizes.items()]
    return Rows(header, lines)


def _list_sizes(spread: Spread) -> Node:
    """Return the figures of a spread without the changes by single tolerances."""
    return {key: size for key, size in to_document(spread).items() if key != "sensitivity"}


def sheet(result: Scatter, system: System) -> Sheet:
    """Return a table of percentiles and a table of the tolerances that matter most, with each
    quantity in a fitting unit.
    """
    heads = [Column("quantity", words=True)]
    heads += [Column(name) for name in _list_sizes(next(iter(result.quantities.values())))]
    lines = []
    causes = []
    sources = {source.name: source for source in result.parts}
    for name, spread in result.quantities.items():
        unit = unit_of_name(result.units[name]).fit_values((spread.max, spread.nominal))
        head = name_with_unit(name, unit.name)
        lines.append((head, *(number(value / unit.size) for value in _list_sizes(spread).values())))
        parts = _group_parts(spread.sensitivity, sources, unit.size)[:SHOWN] or [("0", "any part")]
        for change, part in parts:
            causes.append((head, change, part))
            head = ""  # only the first row of a quantity names it
    formulas = BY_FORMULAS if any(part.by_formulas for part in result.parts) else ""
    tolerances = f"{_list_tolerances(result)}."
    notes = (tolerances, formulas, f"{BOUND}.", tell_speeds(result.quantities))
    note = " ".join(filter(None, notes))
    title = f"Spread of {count_name(result.samples)} random {result.varied}"
    spread_of_all = Grid.of_rows(title, heads, lines, note)
    heads = [Column("quantity", words=True), Column("change"), Column("tolerance of", words=True)]
    changes = Grid.of_rows("Change by each single tolerance, largest first", heads, causes)
    name = result.model.name or NAMELESS
    return Sheet(name, (*assumed_facts(result.assumed), spread_of_all, changes))


def _list_tolerances(result: Scatter) -> str:
    """Return a sentence on the tolerances of all kinds of parts and their distribution."""
    kinds: dict[str, dict[str, None]] = {}
    for part in result.parts:
        size = f"{part.tolerance:g} {part.unit}"
        if part.is_relative:
            size = f"{100 * part.tolerance:.4g} %"
        kinds.setdefault(size, {})[f"{part.kind} {part.aspect}".rstrip()] = None
    message = "; ".join(f"{', '.join(names)} ±{size}" for size, names in kinds.items())
    return f"Tolerances: {message}; {_SHAPES[result.distribution]}"


def _group_parts(
    changes: Mapping[str, float], sources: Mapping[str, Source], unit: float
) -> list[tuple[str, str]]:
    """Return the changes other than 0, each with the parts that cause it.

    Args:
        changes: Change by each part, by the part's name, in SI units.
        sources: The parts by name.
        unit: Size of the unit of the changes.
    """
    groups: dict[tuple[str, str, str], list[str]] = {}
    for name, change in changes.items():
        if change:
            source = sources[name]
            key = number(change / unit, 3), source.stem, source.aspect
            groups.setdefault(key, []).append(source.part)
    causes = []
    for (size, stem, aspect), parts in groups.items():
        causes.append((size, f"{stem} {', '.join(parts)} {aspect}".rstrip()))
    return causes


RENDERER = Renderer(sheet=sheet, rows=rows)


MASS = "Tolerance of masses, of the unbalances of devices, and of inertias."
ANGLE = "Tolerance of the angles of throws and devices, such as 0.2 deg."
STIFFNESS = "Tolerance of the stiffness of mounts or shafts."
OF_EACH = "15% for mounts, 5% for shafts"
SAMPLES = "Number of engines; default: 100000, or 500 if each is computed by itself, as for mounts."
SHAPES = "Uniform within the tolerances, or normal with a third of them as standard deviation."
QUANTITY = "Names such as force.1.major, mode.roll.Hz, torsion.1.Hz; see balcli numbers."
percent = partial(optional, "PERCENT")


def scatter(
    path: EnginePath,
    mass: Annotated[str, percent(MASS, "--mass-scatter", show_default=True)] = "0.5%",
    length: Annotated[str, percent("Tolerance of rod lengths.", "--length-scatter")] = "0%",
    angle: Annotated[str, optional("ANGLE", ANGLE, "--angle-scatter")] = "0",
    stiffness: Annotated[
        str | None, percent(STIFFNESS, "--stiffness-scatter", show_default=OF_EACH)
    ] = None,
    samples: Annotated[int | None, optional("N", SAMPLES)] = None,
    seed: Annotated[int | None, optional("N", "Seed of the random numbers.", min=0)] = None,
    distribution: Annotated[Literal["uniform", "normal"], typer.Option(help=SHAPES)] = "uniform",
    quantity: Annotated[
        str | None,
        optional("WHAT,...", QUANTITY, "--quantity", "-q", show_default=DEFAULT_QUANTITIES),
    ] = None,
    form: FormatOption = None,
    output: Output = None,
) -> None:
    """Spread of free forces and moments when masses, rod lengths, throw angles or dimensions of
    webs (web.tolerance) vary, and the tolerances that matter most.

    \b
    Example:
      balcli scatter i4.toml --mass-scatter 0.5% --seed 1
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    from .scatter import Variants, read_tolerances

    within = read_tolerances(mass, length, angle, stiffness)
    _, model, engine = read_engine(path, asked=())
    if quantity is None and not engine.places_known:
        warn(f"{name_file(path)}: {MOMENTS_UNKNOWN}")
    variants = Variants(model, quantity, within)
    count = variants.usual if samples is None else samples
    with reporting_until_stopped("samples", count) as progress:
        found = variants.draw(count, seed, distribution, progress)
    show([found], RENDERER, form, output)
    exit_if_cut_short(progress, "the results cover only these")
