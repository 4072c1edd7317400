"""Records: JSON, CSV and schema derive from the attributes of a dataclass."""

import json
import math
import pickle
from dataclasses import FrozenInstanceError, dataclass
from typing import Annotated, Literal

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from numpy.typing import NDArray

from balcli.core.peaks import Peak
from balcli.core.records import (
    HIDDEN,
    INLINE,
    Asked,
    Axes,
    Figure,
    Polar,
    Reached,
    WrittenAs,
    angle_deg,
    change_attributes,
    describe_record,
    find_unit,
    list_figures,
    list_series,
    remove_unit,
    to_document,
)
from balcli.errors import NotComputedError

Weight = Annotated[complex, Polar("weight", "angle_deg")]


@dataclass(frozen=True, kw_only=True)
class Piece:
    """A piece.

    Attributes:
        weight: What it weighs.
        depth_mm: Depth of its hole,
            from the rim.
    """

    weight: Annotated[Weight, INLINE]
    depth_mm: float | None = None


@dataclass(frozen=True, kw_only=True)
class Whole:
    """Several pieces.

    Attributes:
        pieces: All of them.
        best: The best one; null if there is none.
        sizes_N: By speed.
    """

    format: Literal["whole/1"]
    pieces: tuple[Piece, ...]
    best: Piece | None
    sizes_N: NDArray[np.float64]
    table: Annotated[NDArray[np.float64], Axes(2)]
    influence: Annotated[NDArray[np.complex128], Polar("amplitude", "phase_deg"), Axes(2)]
    named: dict[str, float]
    step: Weight | None = None
    inner: Annotated[float, HIDDEN] = 3.0


WHOLE = Whole(
    format="whole/1",
    pieces=(Piece(weight=3j, depth_mm=math.nan), Piece(weight=0)),
    best=None,
    sizes_N=np.array([0.0, -0.0, np.inf]),
    table=np.eye(2),
    influence=np.array([[-2j, 0]]),
    named={"k": 1.5},
)


def test_a_document_has_the_attributes_as_keys() -> None:
    assert to_document(WHOLE) == {
        "format": "whole/1",
        "pieces": [{"weight": 3.0, "angle_deg": 90.0, "depth_mm": None}, {"weight": 0.0, "angle_deg": None}],
        "best": None,
        "sizes_N": [0.0, 0.0, None],
        "table": [[1.0, 0.0], [0.0, 1.0]],
        "influence": [[{"amplitude": 2.0, "phase_deg": 270.0}, {"amplitude": 0.0, "phase_deg": None}]],
        "named": {"k": 1.5},
    }
    assert math.copysign(1, to_document(WHOLE)["sizes_N"][1]) == 1


def test_csv_lists_numbers_by_their_paths() -> None:
    document = to_document(WHOLE)
    assert list(list_figures(document, without=("format", "influence"))) == [
        Figure("pieces.1.weight", 3.0, ""),
        Figure("pieces.1.angle_deg", 90.0, "deg"),
        Figure("pieces.1.depth_mm", None, "mm"),
        Figure("pieces.2.weight", 0.0, ""),
        Figure("pieces.2.angle_deg", None, "deg"),
        Figure("best", None, ""),
        Figure("named.k", 1.5, ""),
    ]
    assert list(list_series(document, 1)) == [Figure("sizes_N", 0.0, "N")]


def test_a_schema_describes_what_is_written() -> None:
    schema = describe_record(Whole)
    Draft202012Validator.check_schema(schema)
    Draft202012Validator(schema).validate(json.loads(json.dumps(to_document(WHOLE))))
    assert schema["required"] == ["format", "pieces", "best", "sizes_N", "table", "influence", "named"]
    assert schema["properties"]["sizes_N"]["description"] == "By speed. [N]"
    piece = schema["$defs"]["Piece"]
    assert piece["required"] == ["weight", "angle_deg"]
    assert piece["properties"]["depth_mm"] == {
        "description": "Depth of its hole, from the rim. [mm]",
        "type": ["number", "null"],
    }


def test_units_are_the_endings_of_names() -> None:
    assert find_unit("unbalance_kg_m") == "kg·m"
    assert find_unit("stiffness_Nm_per_rad") == "N·m/rad"
    assert find_unit("rpm") == "rpm"
    assert find_unit("form") == ""
    assert remove_unit("inertia_kg_m2") == "inertia"
    assert angle_deg(1 - 1e-300j) == 0.0


def in_words(numbers: list[int]) -> list[Piece]:
    """Return a piece for each number."""
    return [Piece(weight=complex(number)) for number in numbers]


@dataclass(frozen=True, kw_only=True)
class Marked:
    """Values that are written as something else."""

    top: Annotated[Peak, Reached("top_N", "top_deg"), INLINE]
    rest: Annotated[Peak, Reached("peak", "peak_deg")]
    numbers: Annotated[list[int], WrittenAs(in_words, "pieces")]
    pair: complex
    more: Annotated[dict[str, float], INLINE]


def test_peaks_other_records_pairs_and_further_keys() -> None:
    marked = Marked(top=Peak(2.0, math.pi), rest=Peak(0.0, 0.0), numbers=[1], pair=1 - 2j, more={"x": 3.0})
    found = to_document(marked)
    assert found == {
        "top_N": 2.0,
        "top_deg": 180.0,
        "rest": {"peak": 0.0, "peak_deg": None},
        "pieces": [{"weight": 1.0, "angle_deg": 0.0}],
        "pair": [1.0, -2.0],
        "x": 3.0,
    }
    schema = describe_record(Marked)
    Draft202012Validator(schema).validate(found)
    assert schema["required"] == ["top_N", "top_deg", "rest", "pieces", "pair"]


@dataclass(frozen=True, kw_only=True, eq=False)
class Report:
    """A report.

    Attributes:
        name: Name of the report.
        mass_kg: Mass, if it was asked for.
        weight: Weight, if it was asked for.
    """

    name: str
    mass_kg: Asked[float] = Asked("mass=True")
    weight: Asked[Annotated[complex, Polar("weight", "angle_deg"), INLINE]] = Asked("weight=True")


def test_what_was_not_asked_for_is_not_there() -> None:
    report = Report(name="brief")
    with pytest.raises(NotComputedError, match=r"^mass_kg was not computed; ask for it with mass=True$"):
        _ = report.mass_kg
    assert not hasattr(report, "mass_kg")
    assert to_document(report) == {"name": "brief"}
    whole = Report(name="whole", mass_kg=0.0, weight=2j)
    assert (whole.mass_kg, whole.weight) == (0.0, 2j)  # a mass of 0 is not a missing one
    assert to_document(whole) == {"name": "whole", "mass_kg": 0.0, "weight": 2.0, "angle_deg": 90.0}
    schema = describe_record(Report)
    assert schema["required"] == ["name"]
    assert schema["properties"]["mass_kg"]["type"] == ["number", "null"]
    for document in (report, whole):
        Draft202012Validator(schema).validate(to_document(document))


def test_a_copy_with_changes_keeps_what_was_not_computed() -> None:
    report = Report(name="brief", mass_kg=1.0)
    changed = change_attributes(report, name="other", weight=1j)
    assert to_document(changed) == {"name": "other", "mass_kg": 1.0, "weight": 1.0, "angle_deg": 90.0}
    assert to_document(report) == {"name": "brief", "mass_kg": 1.0}
    assert not hasattr(pickle.loads(pickle.dumps(report)), "weight")
    with pytest.raises(FrozenInstanceError):
        report.mass_kg = 2.0
