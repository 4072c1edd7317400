"""The command `balcli search`: its options, tables and CSV."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ...errors import naming_file
from ...file.toml import name_file, read_bytes
from ...limits import MOST_FOUND
from ...shell.file_names import require_ending, text_format
from ...shell.inputs import warn_each
from ...shell.options import EnginePath, FormatOption, Output
from ...shell.output import refuse_leaving_files, refuse_overwriting, show, write_file
from ...shell.progress import exit_if_cut_short, reporting, reporting_until_stopped
from ...shell.values import optional
from ...show.formats import Columns, Renderer, Rows, Values
from ...show.sheet import NAMELESS, Column, Grid, Sheet, assumed_facts, number
from ...show.units import name_with_unit, unit_of_name
from ..quantity_names import tell_speeds

if TYPE_CHECKING:
    from ...show.units import System
    from .answer import Search


_EQUAL = 1e-9  # objectives that differ by less than this ratio are equally good


def columns(result: Search) -> Columns:
    """Return one row for each arrangement; throws and firing orders are texts with hyphens."""
    first = result.results[0]
    values: dict[str, Values] = {}
    for key, value in first.design.items():
        settings = [arrangement.design[key] for arrangement in result.results]
        values[key] = list(map(_exactly, settings)) if isinstance(value, list) else settings
    values["objective"] = [arrangement.objective for arrangement in result.results]
    for name in first.quantities:
        values[name] = [arrangement.quantities[name] for arrangement in result.results]
    units = {quantity.name: quantity.unit for quantity in result.objective.quantities}
    for key, number_ in result.ranges.items():
        if number_.unit:
            units[key] = number_.unit
    return Columns(values, units)


def rows(result: Search, _system: System) -> Rows:
    """Return CSV with one arrangement in each line, in SI units."""
    values = columns(result).values
    return Rows([*values], [*zip(*values.values(), strict=True)])


def sheet(result: Search, _system: System) -> Sheet:
    """Return a table of the best arrangements, with each figure in a fitting unit. The objective
    has no column if it is a single quantity with weight 1, which has a column of its own.
    """
    design = result.results[0].design
    table = columns(result)
    shown: list[Column] = []
    for name, column in table.values.items():
        unit = table.units.get(name, "")
        if name in design:
            settings = [_setting(one.design[name]) for one in result.results]
            shown.append(Column(name_with_unit(_in_words(name), unit), settings, words=True))
        elif name != "objective" or [*result.objective.weights.values()] != [1.0]:
            fit = unit_of_name(unit).fit(max(column))
            figures = [number(value / fit.size) for value in column]
            shown.append(Column(name_with_unit(name, fit.name), figures))
    grid = Grid(_title(result), shown, " ".join(_notes(result)))
    return Sheet(result.model.name or NAMELESS, (*assumed_facts(result.assumed), grid))


def _title(result: Search) -> str:
    """Return the title of the table, which states whether the rows are equally good."""
    costs = [arrangement.objective for arrangement in result.results]
    largest = max(map(abs, costs))
    word = "Best"
    if result.constant:
        word = "No best"
    elif len(costs) > 1 and max(costs) - min(costs) <= _EQUAL * largest:
        word = "Equally good"
    title = f"{word} {_in_words(result.over)}"
    return f"{title} with even firing" if result.even_firing else title


def _in_words(over: str) -> str:
    """Return a key in words: "bank angle" for `bank_angle`; dotted names are unchanged."""
    return over if "." in over else over.replace("_", " ")


def _notes(result: Search) -> Iterator[str]:
    ends = []
    for key, number_ in result.ranges.items():
        if "." not in key:  # the user gave no range, so the note tells it
            low, high = number_.values[:2]
            ends.append(f"{_in_words(key)} {low:g} to {high:g} deg")
    if ends:
        yield f"Searched: {', '.join(ends)}."
    if result.refused:
        yield f"With some values the engine is impossible, such as {result.refused}."
    if result.constant:
        same = " and ".join(q.name for q in result.objective.weights)
        yield f"No effect on {same}, which is the same at every searched value."
    for key in result.at_ends:
        yield f"The best {key} is an end of its range; a wider range may contain a better value."
    names = (q.name for q in result.objective.quantities)
    if speeds := tell_speeds(names, result.over.split(", ")):
        yield speeds


def _setting(value: float | list[float]) -> str:
    """Return a number, or several numbers separated by hyphens, as text."""
    if isinstance(value, list):
        return "-".join(f"{angle:.6g}" for angle in value)
    return f"{value:.9g}"


def _exactly(value: float | list[float]) -> str:
    """Return the value of one key as text in full precision."""
    numbers = value if isinstance(value, list) else [value]
    return "-".join(repr(number).removesuffix(".0") for number in numbers)


RENDERER = Renderer(sheet=sheet, rows=rows, columns=columns)


OVER = (
    "What to vary: throws of the file (or of its firing order), firing order, bank angle, splay "
    "of split pins, or a number in a range, such as mount.left.loss=0.05:0.3. Repeat the option "
    "to search several numbers and angles together."
)
MINIMISE = (
    "Minimise this sum of quantities, such as moment.1.major=1,force.2.major=0.5 (different units "
    "need weights)."
)
LIMIT = (
    "Upper limit of a quantity, SI or with its unit, such as 'moment.2.major<100' or "
    "'shaft.flywheel.stress<60 N/mm^2'."
)
MAXIMISE = "Maximise a sum of quantities instead."
REQUIRE = "Allow only arrangements with even firing intervals."
WRITE = "Write the engine file with the best result."
goal = partial(optional, "WHAT[=WEIGHT],...")


def search(
    path: EnginePath,
    over: Annotated[
        list[str], optional("throws|firing_order|bank_angle|splay|NUMBER=FROM:TO", OVER)
    ],
    minimise: Annotated[str | None, goal(MINIMISE, "--minimise", "--minimize")] = None,
    maximise: Annotated[str | None, goal(MAXIMISE, "--maximise", "--maximize")] = None,
    limit: Annotated[list[str] | None, optional("WHAT<VALUE", LIMIT)] = None,
    require: Annotated[Literal["even-firing"] | None, optional("even-firing", REQUIRE)] = None,
    top: Annotated[int, typer.Option(min=1, max=MOST_FOUND, help="Number of results.")] = 10,
    form: FormatOption = None,
    output: Output = None,
    write: Annotated[Path | None, optional("OUT.toml", WRITE)] = None,
) -> None:
    """Find the best crank, firing order, bank angle or splay, or values of any numbers. Mirror
    images and rotations of an arrangement are listed once.

    \b
    Example:
      balcli search v8.toml --over throws --minimise moment.1.major
    """
    refuse_overwriting(reads=[path], writes={"--output": output, "--write": write})
    form = text_format(output, form)
    require_ending(write, ".toml", "--write")
    from ...engine import build, parse
    from . import answer, designs

    text = read_bytes(path)
    name = name_file(path)
    model = parse.parse(text, name)
    with naming_file(name):
        engine = build.build(model)
        unlikely = *engine.unlikely, *engine.doubt_speeds(engine.speed_rpm)
    varied = designs.list_paths(model, over)
    for doubt in unlikely:
        if not any(doubt.concerns(path) for path in varied):
            warn_each([doubt], name)
    if write is not None:
        refuse_leaving_files(text, path, write)
    with_gas = model.gas is not None
    goal = designs.parse_objective(minimise, limit or (), maximise=maximise, with_gas=with_gas)
    has_ranges = any("=" in text for text in over)
    watching = reporting if has_ranges else reporting_until_stopped
    with watching("arrangements") as progress, naming_file(name):
        result = answer.search_arrangements(model, over, goal, top, bool(require), progress)
    show([result], RENDERER, form, output)
    if write is not None:
        write_file(designs.write_design(text, result.results[0].design, name), write)
    exit_if_cut_short(progress, "these are the best of them")
