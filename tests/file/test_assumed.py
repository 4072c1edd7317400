"""Assumed values: which of them a result depends on, and those of several engines together."""

import pytest

from balcli.file.assumed import Assumed, join_assumed, select_assumed
from balcli.file.messages import import_table

STROKES = Assumed("layout.strokes", 4)
CENTRE = Assumed("rod.cg", 0.0, "mm")
MASS = Assumed("rod.mass", 0.0, "kg")
INTAKE = Assumed("gas.intake", 1.0, "bar")
LOSS = Assumed("mount.loss", 0.0)


def test_tables_of_chapters_count_only_for_their_chapters() -> None:
    values = (STROKES, CENTRE, INTAKE, LOSS)
    assert select_assumed(values, ()) == (STROKES, CENTRE)
    assert select_assumed(values, ("gas",)) == (STROKES, CENTRE, INTAKE)
    assert select_assumed(values, ("gas", "mount"), without=("rod.cg", "gas")) == (STROKES, LOSS)


def test_values_of_single_engines_follow_those_of_all() -> None:
    of_part = Assumed("crank.spacing", 0.0, "mm", "aft")
    assert join_assumed(("A", "B", "C"), [(CENTRE, STROKES), (STROKES, MASS, of_part), (STROKES,)]) == (
        STROKES,
        CENTRE._replace(engine="A"),
        MASS._replace(engine="B"),
        of_part._replace(engine="B, aft"),
    )


def test_an_engine_without_assumed_values_has_nothing_in_common() -> None:
    assert join_assumed(("A", "B"), [None, (STROKES,)]) == (STROKES._replace(engine="B"),)
    assert join_assumed(("A",), [(STROKES,)]) == (STROKES,)
    assert join_assumed((), []) == ()


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("crank.throws", "deg"),
        ("crank.throw_mass", "kg"),
        ("flywheel.inertia", "kg mm^2"),
        ("articulation.knuckle_angles", "deg"),
        ("mount.stiffness", "N/mm"),
        ("body.gravity", ""),
        ("layout.strokes", ""),
        ("layout.numbering", ""),
        ("gas.compression_index", ""),
        ("gas.indicator", ""),
    ],
)
def test_a_key_has_the_unit_of_its_bare_numbers(path: str, unit: str) -> None:
    table, _, key = path.partition(".")
    assert import_table(table).find_unit(key) == unit
