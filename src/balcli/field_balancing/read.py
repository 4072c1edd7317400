"""A file of runs -> model: every mistake at once, by its path and with what would be right."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from pydantic_core import ErrorDetails

from ..enginefile.fields import counted, printable, shorten, suggest_nearest
from ..enginefile.file_kinds import RUNS, refuse_other_kind
from ..enginefile.messages import describe_finding, join_path
from ..enginefile.model import FileTable
from ..enginefile.table_reader import TableReader
from ..enginefile.toml_text import name_file, parse_toml, read_bytes
from ..enginefile.units import MASS
from ..errors import Problem
from ..limits import MOST_RUNS
from .model import Run, RunsFile, read_amount_unit

BY_PLANE = ("radius", "most", "places", "drill", "deepest", "shares")
_NEEDED = {
    "planes": 'name the planes that take weights, such as planes = ["front", "rear"]',
    "run": "write [[run]] for every run, the rotor as found first",
}


def read_runs(source: str | Path) -> RunsFile:
    """The runs in a file, or on standard input for "-".

    Raises BalcliError if there is nothing to read, InputError with every mistake of the text.
    """
    return parse_runs(read_bytes(source), name_file(source))


def parse_runs(text: str | bytes, file: str = "") -> RunsFile:
    """The runs that a TOML text describes; `file` is its name in messages. Raises InputError with
    every mistake.
    """
    return check_runs(parse_toml(text, file), file)


def check_runs(data: Mapping[str, Any], file: str = "") -> RunsFile:
    """The runs that tables describe, as TOML is read; otherwise as `parse_runs`."""
    refuse_other_kind(data, file, RUNS)
    reader = TableReader(RUNS.name, _describe)
    stand_in = {"run": [Run.model_construct(readings=(0j,))]}  # runs are read one by one
    model = reader.read_table("", {**data, **stand_in}, RunsFile)
    runs: tuple[Run | None, ...] = ()
    if "run" not in data:
        reader.problems.append(Problem.of_missing("run", _NEEDED["run"]))
    elif data["run"] == []:
        reader.problems.append(Problem("run", f"is an empty list; {_NEEDED['run']}"))
    else:
        runs = reader.read_list("run", data["run"], Run, MOST_RUNS) or ()
    if not reader.problems and model is not None:
        model = model.model_copy(update={"run": runs})
    head, broken = model, set[str]()
    if model is None:
        refused = reader.refused[""]
        if isinstance(refused.draft, RunsFile) and "planes" not in refused.broken:
            head, broken = refused.draft, refused.broken  # as far as it can be read
    if head is not None:
        numbered = [(k, run) for k, run in enumerate(runs, 1) if run is not None]
        misfits = [*_find_misfits(head, numbered, len(numbered) == len(runs))]
        for k, run in enumerate(runs, 1):  # what could not be read may name no planes, too
            weights = _find_weights(data["run"][k - 1]) if run is None else ()
            misfits += _check_planes(head, k, weights)
        reader.problems += (misfit for misfit in misfits if broken.isdisjoint(misfit.missing))
    if reader.problems or model is None:
        raise reader.refusal(file)
    return model


def _find_weights(table: object) -> Iterable[object]:
    """Names under `weights` in a table as TOML is read; none where there is no such table."""
    weights = table.get("weights") if isinstance(table, Mapping) else None
    return weights if isinstance(weights, Mapping) else ()


def _describe(path: str, finding: ErrorDetails, table: type[FileTable]) -> Problem:
    last = str(finding["loc"][-1])
    if finding["type"] == "missing" and last in _NEEDED:
        return Problem.of_missing(last, _NEEDED[last])
    if finding["type"] == "tuple_type" and last in BY_PLANE:
        value = shorten(finding["input"])
        text = f"{value} is one value; give one for each plane, such as {last} = [{value}, {value}]"
        return Problem(last, text)
    if finding["type"] == "dict_type":
        text = f'{shorten(finding["input"])} is not a table; write it like {{ front = "1.15 @ 0" }}'
        return Problem(join_path(path, finding["loc"]), text)
    return describe_finding(path, finding, table)


# ------------------------------------------------------------------ what does not fit together
def _find_misfits(file: RunsFile, runs: list[tuple[int, Run]], whole: bool) -> Iterator[Problem]:
    """Args: runs that could be read, by their numbers; whether these are all."""
    yield from _check_names(file)
    yield from _check_lists(file)
    yield from _check_permitted(file)
    yield from _check_shop(file)
    yield from _check_runs(file, runs)
    if whole and len({run.speed is None for _, run in runs}) == 1:  # else speeds are not known
        yield from _check_influence_rows(file, [run for _, run in runs])


def _check_names(file: RunsFile) -> Iterator[Problem]:
    for key in ("planes", "sensors"):
        names = getattr(file, key) or ()
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            yield Problem(key, f"names {shorten(twice[0])} twice; each needs a name of its own")


def _check_lists(file: RunsFile) -> Iterator[Problem]:
    for key in BY_PLANE:
        values = getattr(file, key)
        if values is not None and len(values) != len(file.planes):
            yield Problem(
                key,
                f"has {counted(len(values), 'value')}, but there are "
                f"{counted(len(file.planes), 'plane')}; give one for each, in their order",
            )


def _check_permitted(file: RunsFile) -> Iterator[Problem]:
    if file.shares is not None and file.grade is None:
        yield Problem.of_missing("grade", "shares are of what it permits, such as grade = 6.3")
    if file.grade is not None:
        for key, example in (("mass", "120"), ("speed", "3000")):
            if getattr(file, key) is None:
                hint = f"a grade permits an unbalance by it, such as {key} = {example}"
                yield Problem.of_missing(key, hint)
        if file.radius is None and is_mass(file):
            yield Problem.of_missing(
                "radius",
                "a grade permits an unbalance, which is weight times radius: give the "
                "radius of every plane, such as radius = [200, 200], or the weights as unbalances, "
                'with weight_unit = "g mm"',
            )


def _check_shop(file: RunsFile) -> Iterator[Problem]:
    if file.drill is not None and file.radius is None:
        yield Problem.of_missing("radius", "a drill needs the radius of the rim, in every plane")
    if file.deepest is not None and file.drill is None:
        yield Problem.of_missing("drill", "deepest belongs to holes, which have a diameter")
    if file.drill and file.radius and len(file.drill) == len(file.radius):
        for k, (drill, rim) in enumerate(zip(file.drill, file.radius, strict=True), 1):
            if drill > 2 * rim:
                yield Problem(
                    "drill", f"hole {k} of {drill:g} mm is wider than its rim of radius {rim:g} mm"
                )
    if file.deepest and file.radius and len(file.deepest) == len(file.radius):
        for k, (depth, rim) in enumerate(zip(file.deepest, file.radius, strict=True), 1):
            if depth > rim:
                yield Problem(
                    "deepest", f"hole {k} of {depth:g} mm passes the axis, {rim:g} mm below the rim"
                )


def is_mass(file: RunsFile) -> bool:
    """Whether weights are given as masses, not as unbalances."""
    return read_amount_unit(file.weight_unit).powers == MASS.powers


def _check_runs(file: RunsFile, runs: list[tuple[int, Run]]) -> Iterator[Problem]:
    if not runs:
        return
    first, pattern = runs[0]
    wanted = len(file.sensors) if file.sensors else len(pattern.readings)
    whose = "sensors names" if file.sensors else f"run.{first} has"
    spoken = [k for k, run in runs if run.speed is not None]
    for k, run in runs:
        if len(run.readings) != wanted:
            yield Problem(
                f"run.{k}.readings",
                f"has {counted(len(run.readings), 'reading')}, but {whose} {wanted}; give one for "
                "each sensor, in the same order in every run",
            )
        yield from _check_planes(file, k, run.weights)
        if spoken and run.speed is None:
            hint = f"run.{spoken[0]} gives its speed, so every run must"
            yield Problem.of_missing(f"run.{k}.speed", hint)
    yield from _check_factors(file, wanted)


def _check_planes(file: RunsFile, k: int, names: Iterable[object]) -> Iterator[Problem]:
    """What takes a weight in the k-th run, and is no plane."""
    for name in names:
        if isinstance(name, str) and name not in file.planes:
            hint = suggest_nearest(name, file.planes, f"there are {', '.join(file.planes)}")
            yield Problem(f"run.{k}.weights.{printable(name)}", f"is no plane; {hint[:200]}")


def _check_factors(file: RunsFile, sensors: int) -> Iterator[Problem]:
    if file.reading_weights and len(file.reading_weights) != sensors:
        yield Problem(
            "reading_weights",
            f"has {counted(len(file.reading_weights), 'value')}, but there are "
            f"{counted(sensors, 'reading')} in a run; give one for each",
        )
    for k, row in enumerate(file.influence or (), 1):
        if len(row) != len(file.planes):
            yield Problem(
                f"influence.{k}",
                f"has {counted(len(row), 'coefficient')}, but there are "
                f"{counted(len(file.planes), 'plane')}; give one for each, in their order",
            )


def _check_influence_rows(file: RunsFile, runs: list[Run]) -> Iterator[Problem]:
    speeds = len({run.speed for run in runs})
    sensors = len(file.sensors or runs[0].readings)
    if file.influence is not None and len(file.influence) != sensors * speeds:
        at = f" at {counted(speeds, 'speed')}" if speeds > 1 else ""
        yield Problem(
            "influence",
            f"has {counted(len(file.influence), 'row')}, but there are "
            f"{counted(sensors, 'reading')}{at}; give one row for each reading",
        )
