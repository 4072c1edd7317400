"""Holzer's table against modes, forced vibration and a table by hand."""

import numpy as np
import pytest
from support.chains import KINDS, chain_of, no_damping, random_chain

from balcli.torsional_vibration.chain import ChainShaft, join_chain
from balcli.torsional_vibration.modes import find_chain_modes, tabulate_holzer
from balcli.torsional_vibration.motion import respond_chain


@pytest.mark.parametrize("kind", [k for k in KINDS if k not in ("looped", "clamped at both ends")])
@pytest.mark.parametrize("seed", range(2))
def test_holzers_table_closes_at_natural_frequencies(kind, seed):
    chain = random_chain(kind, seed, 0.4)
    modes = find_chain_modes(chain)
    last = len(chain.inertia) - 1
    first, last = (last, 0) if kind == "clamped" else (0, last)
    for omega, shape in zip(modes.omega, modes.shapes, strict=True):
        table = tabulate_holzer(chain, omega, first, last)
        assert table.angle == pytest.approx(shape / shape[first], abs=1e-7 * abs(table.angle).max())
        if kind != "clamped":
            assert abs(table.residual) <= 1e-7 * max(abs(table.total).max(), 1)


def test_holzers_table_away_from_them_is_the_response():
    """The torque that is left over is what a load at the last node would have to be."""
    chain = random_chain("branched", 6)
    table = tabulate_holzer(chain, 800.0)
    load = np.zeros(len(chain.inertia))
    load[-1] = -table.residual
    twist = respond_chain(chain, no_damping(chain), 800.0, load)
    assert twist.angle.real == pytest.approx(table.angle, rel=1e-9)
    assert table.torque == pytest.approx(800.0**2 * chain.inertia * table.angle)


def test_holzers_table_in_full():
    """Two wheels on a shaft 6 and a third through gears 1:2 on a shaft 4 in its own speed."""
    chain = join_chain([1, 1, 0.5], [ChainShaft(0, 1, 6), ChainShaft(1, 2, 4, 2)])
    table = tabulate_holzer(chain, 2.0)
    assert table.angle == pytest.approx([1, 1 / 3, 2 / 3 - 2 / 3])
    assert table.torque == pytest.approx([4, 4 / 3, 0])
    assert table.total == pytest.approx([4, 16 / 3, 8 / 3])
    assert table.stiffness == pytest.approx([6, 16, 0])
    assert table.twist == pytest.approx([2 / 3, 1 / 3, 0])
    assert table.residual == pytest.approx(8 / 3)


def test_a_branch_to_a_clamp_is_a_spring_to_ground():
    chain = join_chain([1, 1, 1], [ChainShaft(0, 1, 6), ChainShaft(0, 2, 3)], clamped=[2])
    table = tabulate_holzer(chain, 1.0, 0, 1)
    assert table.angle == pytest.approx([1, 1 - (1 - 3) / 6, 0])
    assert table.total == pytest.approx([-2, -2 + 4 / 3, -3])


@pytest.mark.parametrize(
    ("chain", "said"),
    [
        (random_chain("looped", 0), "Holzer's table needs a chain in one piece, without loops"),
        (chain_of([1, 1], [0]), "Holzer's table needs a chain in one piece, without loops"),
        (chain_of([1, 1, 1], [2, 2], clamped=[1]), "Holzer's table can end at a clamped node, but not pass it"),
        (
            join_chain([1, 1, 1], [ChainShaft(0, 1, 6), ChainShaft(1, 2, np.inf, 2)], clamped=[2]),
            "Holzer's table cannot have gears that mesh with a fixed node",
        ),
        (join_chain([1, 1, 1], [ChainShaft(0, 2, 6), ChainShaft(0, 1, 4)]), "a branch is at resonance by itself"),
    ],
)
def test_tables_that_cannot_be_drawn_up(chain, said):
    with pytest.raises(ValueError, match=f"^{said}$"):
        tabulate_holzer(chain, 2.0)
