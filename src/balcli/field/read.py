"""Read and check a file of runs. First all wrong values are reported, each by its path; if there
are none, all contradictions between values.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from pydantic_core import ErrorDetails

from ..errors import Problem
from ..file.fields import counted, printable, shorten, suggest_nearest
from ..file.messages import RUNS, describe_finding, refuse_other_kind
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
    "not a file of runs, which is TOML text with tables such as [[run]]: `balcli new field` writes "
    "one"
)


def read_runs(source: str | Path) -> RunsFile:
    """Return the runs in a file, or on standard input for "-".

    Raises BalcliError if the file cannot be read, and InputError with every mistake of the text.
    """
    return parse_runs(read_bytes(source), name_file(source))


def parse_runs(text: str | bytes, file: str = "") -> RunsFile:
    """Return the runs that a TOML text describes; `file` is its name in messages. Raises InputError
    with every mistake.
    """
    return check_runs(parse_toml(text, file, RUNS_FILE), file)


def check_runs(data: Mapping[str, object], file: str = "") -> RunsFile:
    """Return the runs that the tables of a parsed TOML text describe; see `parse_runs`."""
    refuse_other_kind(data, file, RUNS)
    reader = TableReader(RUNS.name, _describe)
    stand_in = [Run.model_construct(readings=(0j,))]  # runs are read one by one
    head = reader.read_table("", {**data, "run": stand_in}, RunsFile)
    if not (tables := data.get("run", [])) and isinstance(tables, list):
        reader.problems.append(Problem.of_missing("run", _NEEDED["run"]))
    runs = reader.read_list("run", tables, Run, MOST_RUNS)
    if head is not None and not reader.problems:
        head = head.model_copy(update={"run": runs})
        reader.problems += _find_misfits(head)
    if head is None or reader.problems:
        raise reader.refusal(file)
    return head


def _describe(path: str, finding: ErrorDetails, table: type[FileTable]) -> Problem:
    last = str(finding["loc"][-1])
    if finding["type"] == "missing" and last in _NEEDED:
        return Problem.of_missing(last, _NEEDED[last])
    if finding["type"] == "tuple_type" and last in BY_PLANE:
        value = shorten(finding["input"])
        text = f"{value} is one value; give one for each plane, such as {last} = [{value}, {value}]"
        return Problem(last, text)
    return describe_finding(path, finding, table)


def _find_misfits(file: RunsFile) -> Iterator[Problem]:
    """Yield contradictions between keys and between runs."""
    for key in ("planes", "sensors"):
        names = getattr(file, key) or ()
        if twice := sorted({name for name in names if names.count(name) > 1}):
            yield Problem(key, f"names {shorten(twice[0])} twice; each needs a name of its own")
    planes = counted(len(file.planes), "plane")
    counts = [(key, getattr(file, key), "value", len(file.planes), planes) for key in BY_PLANE]
    for k, row in enumerate(file.influence or (), 1):
        counts.append((f"influence.{k}", row, "coefficient", len(file.planes), planes))
    sensors = len(file.sensors or file.run[0].readings)
    readings = counted(sensors, "reading")
    in_a_run = f"{readings} in a run"
    counts.append(("reading_weights", file.reading_weights, "value", sensors, in_a_run))
    speeds = {run.speed for run in file.run}
    if None not in speeds or len(speeds) == 1:  # otherwise the number of speeds is unknown
        at = f" at {counted(len(speeds), 'speed')}" if len(speeds) > 1 else ""
        wanted = sensors * len(speeds)
        counts.append(("influence", file.influence, "row", wanted, f"{readings}{at}"))
    for path, values, what, wanted, of in counts:
        if values is not None and len(values) != wanted:
            text = f"has {counted(len(values), what)}, but there are {of}; give one for each"
            yield Problem(path, text)
    yield from _check_holes(file)
    for k, run in enumerate(file.run, 1):
        yield from _check_run(file, k, run, sensors)


def _check_holes(file: RunsFile) -> Iterator[Problem]:
    if file.drill is not None and file.radius is None:
        yield Problem.of_missing("radius", "a drill needs the radius of the rim, in every plane")
    if file.deepest is not None and file.drill is None:
        yield Problem.of_missing("drill", "deepest belongs to holes, which have a diameter")
    for key, most, fault in (
        ("drill", 2.0, "is wider than its rim of radius {:g} mm"),
        ("deepest", 1.0, "passes the axis, {:g} mm below the rim"),
    ):
        pairs = zip(getattr(file, key) or (), file.radius or (), strict=False)
        for k, (size, rim) in enumerate(pairs, 1):
            if size > most * rim:
                yield Problem(key, f"hole {k} of {size:g} mm {fault.format(rim)}")


def _check_run(file: RunsFile, k: int, run: Run, sensors: int) -> Iterator[Problem]:
    """Yield contradictions in the k-th run (from 1); a run has as many readings as `sensors`."""
    if len(run.readings) != sensors:
        whose = "sensors names" if file.sensors else "run.1 has"
        yield Problem(
            f"run.{k}.readings",
            f"has {counted(len(run.readings), 'reading')}, but {whose} {sensors}; give one for "
            "each sensor, in the same order in every run",
        )
    with_speed = [n for n, other in enumerate(file.run, 1) if other.speed is not None]
    if with_speed and run.speed is None:
        hint = f"run.{with_speed[0]} gives its speed, so every run must"
        yield Problem.of_missing(f"run.{k}.speed", hint)
    for name in [name for name in run.weights if name not in file.planes]:
        hint = suggest_nearest(name, file.planes, f"there are {', '.join(file.planes)}")
        yield Problem(f"run.{k}.weights.{printable(name)}", f"is not a plane; {hint[:200]}")
