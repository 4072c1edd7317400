"""Doubts of a file of which figures vary: only of what does not."""

import pytest

from balcli.engine.load import parse
from balcli.errors import InputError
from balcli.studies.parameters import parse_parameter
from balcli.studies.unlikely import doubt_unvaried

FOUR = """
[crank]
stroke = 86
throws = [0, 180, 180, 0]
[piston]
mass = {piston}
bore = 86
[rod]
length = {length}
mass = 0.6
cg = 40
[layout]
firing_order = {order}
"""
HEAVY = "piston.mass is 51 kg"
LONG = "crank radius / rod length is 0.086"


def doubt(vary: str, piston: float = 0.5, length: float = 140, order: str = "[1, 3, 4, 2]") -> list[str]:
    model = parse(FOUR.format(piston=piston, length=length, order=order))
    return doubt_unvaried(model, [parse_parameter(vary, model)])


@pytest.mark.parametrize("vary", ["rod.length=130,150", "rod.ratio=0.3,0.33"])
def test_what_varies_is_doubted_under_no_name_of_it(vary):
    assert doubt("crank.throws.2=180,180", length=500)[0].startswith(LONG)
    assert doubt(vary, length=500) == []


def test_what_does_not_vary_is_doubted():
    found = doubt("rod.ratio=0.3,0.33", piston=51)
    assert len(found) == 2
    assert found[0].startswith(HEAVY)


@pytest.mark.parametrize("vary", ["crank.throws.3=180,200", "piston.offset=0,130"])
def test_variants_that_fire_otherwise_or_lock_silence_nothing_else(vary):
    assert doubt(vary, piston=51)[0].startswith(HEAVY)


def test_a_file_that_cannot_be_is_refused():
    with pytest.raises(InputError, match="1-3-2-4 would take 1080 deg"):
        doubt("rod.ratio=0.3,0.33", order="[1, 3, 2, 4]")
