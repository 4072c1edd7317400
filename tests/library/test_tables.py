"""Printed tables in Python: what is wrong names the function's own arguments."""

import pytest

import balcli


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"angles": "0:90:5"}, "angles: table kvasnikov-1 takes ratios"),
        (
            {"ratios": "0.9:1.1:0.1"},
            "ratios '0.9:1.1:0.1': lambda = 1, but a crank turns only with 0 < lambda < 1",
        ),
    ],
)
def test_a_range_that_it_does_not_take(asked, told):
    with pytest.raises(balcli.BalcliError) as refusal:
        balcli.tables("kvasnikov-1", **asked)
    assert str(refusal.value) == told
