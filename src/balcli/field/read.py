"""A file of runs: read and checked, every mistake at once by its path."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Sized
from pathlib import Path
from typing import Any

from pydantic_core import ErrorDetails

from ..errors import Problem
from ..file.fields import counted, printable, shorten, suggest_nearest
from ..file.messages import RUNS, describe_finding, join_path, refuse_other_kind
from ..file.read import TableReader
from ..file.table import FileTable
from ..file.toml import name_file, parse_toml, read_bytes
from ..limits import MOST_RUNS
from .tables import Run, RunsFile

BY_PLANE = ("radius", "most", "places", "drill", "deepest", "shares")


_NEEDED = {
    "planes": 'name the planes that take weights, such as planes = ["front", "rear"]',
    "run": "write [[run]] for every run, the rotor as found first",
}
RUNS_FILE = (
    "no file of runs; that is TOML text with tables such as [[run]]: `balcli new field` writes one"
)


def read_runs(source: str | Path) -> RunsFile:
    """Return the runs in a file, or on standard input for "-".

    Raises BalcliError if there is nothing to read, InputError with every mistake of the text.
    """
    return parse_runs(read_bytes(source), name_file(source))


def parse_runs(text: str | bytes, file: str = "") -> RunsFile:
    """Return the runs that a TOML text describes; `file` is its name in messages. Raises InputError
    with every mistake.
    """
    return check_runs(parse_toml(text, file, RUNS_FILE), file)


def check_runs(data: Mapping[str, object], file: str = "") -> RunsFile:
    """Return the runs that tables describe, as TOML is read; otherwise as `parse_runs`."""
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
    if model is not None:
        reader.problems += _find_misfits(model, runs, data.get("run"))
    if reader.problems or model is None:
        raise reader.refusal(file)
    return model


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


def _find_misfits(file: RunsFile, runs: Sequence[Run | None], tables: Any) -> Iterator[Problem]:
    """Yield contradictions, as far as the file can be read.

    Args:
        file: The file without its runs.
        runs: The runs; None for each with mistakes.
        tables: The runs as TOML is read.
    """
    yield from _check_lists(file)
    yield from _check_holes(file)
    readable = {k: run for k, run in enumerate(runs, 1) if run is not None}
    if readable:
        yield from _check_runs(file, readable, len(readable) == len(runs))
    for k, run in enumerate(runs, 1):  # a run that has mistakes may name wrong planes as well
        if run is None and isinstance(tables[k - 1], Mapping):
            weights = tables[k - 1].get("weights")
            yield from _check_planes(file, k, weights if isinstance(weights, Mapping) else ())


def _check_count(path: str, values: Sized | None, what: str, wanted: int, of: str) -> list[Problem]:
    """Return a problem if there is not one value for each plane or reading."""
    if values is None or len(values) == wanted:
        return []
    text = f"has {counted(len(values), what)}, but there are {of}; give one for each"
    return [Problem(path, text)]


def _check_lists(file: RunsFile) -> Iterator[Problem]:
    for key in ("planes", "sensors"):
        names = getattr(file, key) or ()
        if twice := sorted({name for name in names if names.count(name) > 1}):
            yield Problem(key, f"names {shorten(twice[0])} twice; each needs a name of its own")
    planes = len(file.planes)
    for key in BY_PLANE:
        yield from _check_count(key, getattr(file, key), "value", planes, counted(planes, "plane"))
    for k, row in enumerate(file.influence or (), 1):
        path = f"influence.{k}"
        yield from _check_count(path, row, "coefficient", planes, counted(planes, "plane"))


def _check_holes(file: RunsFile) -> Iterator[Problem]:
    if file.drill is not None and file.radius is None:
        yield Problem.of_missing("radius", "a drill needs the radius of the rim, in every plane")
    if file.deepest is not None and file.drill is None:
        yield Problem.of_missing("drill", "deepest belongs to holes, which have a diameter")
    for k, rim in enumerate(file.radius or ()):
        if (drill := _find_kth(file.drill, k)) > 2 * rim:
            text = f"hole {k + 1} of {drill:g} mm is wider than its rim of radius {rim:g} mm"
            yield Problem("drill", text)
        if (depth := _find_kth(file.deepest, k)) > rim:
            text = f"hole {k + 1} of {depth:g} mm passes the axis, {rim:g} mm below the rim"
            yield Problem("deepest", text)


def _find_kth(values: Sequence[float] | None, k: int) -> float:
    return values[k] if values and k < len(values) else 0.0


def _check_runs(file: RunsFile, runs: Mapping[int, Run], whole: bool) -> Iterator[Problem]:
    """Yield contradictions in runs, given by their numbers; `whole`: whether these are all."""
    first, pattern = next(iter(runs.items()))
    sensors = len(file.sensors or pattern.readings)
    whose = "sensors names" if file.sensors else f"run.{first} has"
    with_speed = [k for k, run in runs.items() if run.speed is not None]
    for k, run in runs.items():
        if len(run.readings) != sensors:
            yield Problem(
                f"run.{k}.readings",
                f"has {counted(len(run.readings), 'reading')}, but {whose} {sensors}; give one for "
                "each sensor, in the same order in every run",
            )
        yield from _check_planes(file, k, run.weights)
        if with_speed and run.speed is None:
            hint = f"run.{with_speed[0]} gives its speed, so every run must"
            yield Problem.of_missing(f"run.{k}.speed", hint)
    readings = counted(sensors, "reading")
    key = "reading_weights"
    yield from _check_count(key, file.reading_weights, "value", sensors, f"{readings} in a run")
    if whole and len(with_speed) in (0, len(runs)):  # otherwise the speeds are not known
        speeds = len({run.speed for run in runs.values()})
        at = f" at {counted(speeds, 'speed')}" if speeds > 1 else ""
        yield from _check_count(
            "influence", file.influence, "row", sensors * speeds, f"{readings}{at}"
        )


def _check_planes(file: RunsFile, k: int, names: Iterable[object]) -> Iterator[Problem]:
    """Yield names under `weights` of the k-th run that are no planes."""
    for name in names:
        if isinstance(name, str) and name not in file.planes:
            hint = suggest_nearest(name, file.planes, f"there are {', '.join(file.planes)}")
            yield Problem(f"run.{k}.weights.{printable(name)}", f"is no plane; {hint[:200]}")
