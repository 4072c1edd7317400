"""Record the result of an engine, and read records.

A record is the JSON document of `analyze` (orders, peaks, displacement) with strokes and dead
centres, the main figures of `torque`, `mounts` and `torsion` if the engine file has tables for
them, the inputs of the file, and the version of balcli that made it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from ..analysis.answer import Analysis, analyze, list_strokes
from ..core.records import Node, to_document, write_each
from ..crank_torque.answer import torque
from ..engine.engine import Engine, take_model
from ..errors import BalcliError
from ..file.model import EngineFile
from ..forces.kinds import GAS, KINDS
from ..forces.spectrum import Spectra
from ..limits import LARGEST_FILE_BYTES
from ..mounting.answer import mounts
from ..show.formats import stamp
from ..torsional_vibration.answer import torsion
from .inputs import list_inputs

INPUTS = "inputs"  # key of the inputs; records of balcli 0.1.0 do not have it
TRAVEL = "travel"  # key of strokes and dead centres
_ANALYZED = (*KINDS, "peak")
_OF_TORQUE = {"orders", "format", "version", "speed_rpm"}  # keys of `torque` that are not recorded
# Errors that a file with any content can cause when it is read as a record.
MALFORMED = (LookupError, TypeError, AttributeError, RecursionError)
BROKEN = (OSError, ValueError, OverflowError, BalcliError, *MALFORMED)


# ------------------------------------------------------------------ files
def find_record(engine_file: Path) -> Path:
    """Return the path at which the result of an engine file is recorded."""
    return engine_file.parent / "expected" / f"{engine_file.stem}.json"


def list_abandoned(files: Iterable[Path]) -> Iterator[tuple[Path, Path]]:
    """Yield each record among `files` whose engine file is missing, after the path of that file."""
    for record in files:
        engine_file = record.parent.with_name(f"{record.stem}.toml")
        if not engine_file.exists() and _is_record(record):
            yield engine_file, record


def _is_record(path: Path) -> bool:
    try:
        return bool(read_record(path)["format"] == Analysis.format)
    except BROKEN:
        return False


def read_record(record: Path) -> Any:
    """Return the content of a record; any JSON may be in it.

    Raises:
        BalcliError: The file is not a regular file, or is larger than an engine file may be.
        OSError, ValueError: The file cannot be read.
    """
    if not record.is_file():
        raise BalcliError("it is not a regular file")
    with record.open("rb") as file:
        content = file.read(LARGEST_FILE_BYTES + 1)
    if len(content) > LARGEST_FILE_BYTES:
        raise BalcliError(f"it has more than {LARGEST_FILE_BYTES} bytes")
    return json.loads(content.decode())


def check_target(engine_file: Path) -> Path:
    """Return the path at which to record the result of an engine file.

    Raises:
        BalcliError: The record is a link that leads out of the engine's folder.
    """
    record = find_record(engine_file)
    folder = engine_file.parent.resolve()
    if not record.resolve().is_relative_to(folder):
        raise BalcliError(
            f"{record}: is a link that leads out of the engine's folder; nothing is recorded"
        )
    return record


def explain_unreadable(error: Exception) -> str:
    """Return in words why a record cannot be read, for one of the errors in `BROKEN`."""
    if isinstance(error, OSError):
        return error.strerror or str(error)
    if isinstance(error, json.JSONDecodeError):
        return f"it is not JSON: line {error.lineno}"
    if isinstance(error, KeyError):
        return f"{error.args[0]} is missing"
    if isinstance(error, BalcliError):
        return str(error)
    return "it is not a result of balcli analyze"


# ------------------------------------------------------------------ what is recorded
class Described(NamedTuple):
    """The record that an engine would have now, and the phasors of the orders in it."""

    document: Node
    spectra: Spectra


def describe_engine(engine: Engine, orders: Iterable[float] | None = None) -> Described:
    """Return the record of an engine.

    Args:
        engine: One engine from a file.
        orders: Orders to record; None: those that `analyze` shows.
    """
    model = take_model(engine)
    only = _ANALYZED if engine.gas is None else (*_ANALYZED, GAS.name)
    analysis = analyze(engine, orders, only)
    document: Node = stamp({"format": Analysis.format, INPUTS: list_inputs(model)})
    document |= to_document(analysis)
    document.pop("verdict", None)  # it follows from the orders, and may change with its rules
    if not engine.placed:
        document[TRAVEL] = write_each(list_strokes(engine))
    document |= _describe_chapters(engine, model)
    return Described(document, analysis.spectra)


def record_result(engine: Engine) -> str:
    """Return the text of the record of an engine."""
    document = describe_engine(engine).document
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def _describe_chapters(engine: Engine, model: EngineFile) -> Node:
    """Return main figures of torque, mounts and torsion if the engine file has tables for them."""
    chapters: Node = {}
    if engine.gas is not None:
        on_crank = torque(engine).to_dict()
        chapters["torque"] = {key: on_crank[key] for key in on_crank if key not in _OF_TORQUE}
    if model.body is not None and model.mount:
        mounted = mounts(engine).to_dict()
        largest = [{"name": m["name"], **m["worst"]} for m in mounted["response"]["mounts"]]
        chapters["mounts"] = {"modes": _number_modes(mounted), "largest": largest}
    if model.torsion is not None:
        twisted = torsion(engine).to_dict()
        criticals = twisted.get("criticals", [])
        chapters["torsion"] = {"modes": _number_modes(twisted), "criticals": criticals}
    return chapters


def _number_modes(document: Node) -> list[Node]:
    modes = enumerate(document["modes"], 1)
    return [{"mode": n, "frequency_Hz": mode["frequency_Hz"]} for n, mode in modes]
