"""Liu Xianzhi: Two-shaft balance of the second-order inertia force of flat-plane V8 engines (in Chinese), 1979."""

from math import atan, cos, degrees, radians, sqrt

import pytest
from support.engines import build_text

from balcli.books.answer import tables as recompute
from balcli.core.mechanisms import closed_form
from balcli.forces.spectrum import compute_spectra


def second_order(gamma: float):
    """Vectors of order 2 of the engine itself over K = 4 m r omega^2 A_2, at a bank angle in degrees."""
    text = "crank = { stroke = 80, throws = [0, 180, 180, 0], spacing = 100 }\nrod.ratio = 0.28\npiston.mass = 0.5\n"
    engine = build_text(f"{text}layout.bank_angle = {gamma}\noperation.speed = 6000\n")
    scale = 4 * 0.5 * 0.04 * engine.omega**2 * float(closed_form.piston([2], 0.28)[0])
    return compute_spectra(engine, [2], ["force"]).force.vectors[:, 0] / scale


@pytest.mark.parametrize("gamma", [0, 30, 60, 90, 120, 150, 180])
def test_the_second_order_is_two_vectors(gamma):
    """(1.5): cos(gamma/2) turning with the crank, cos(3 gamma/2) against it: at 60 degrees sqrt3/2 and none (3.1)."""
    expected = abs(cos(radians(gamma / 2))), abs(cos(radians(1.5 * gamma)))
    assert abs(second_order(gamma)) == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize(
    ("sign", "half", "printed", "size"),
    [(-1, sqrt(2), 109.4712, 8 / (3 * sqrt(3))), (1, sqrt(5), 131.8103, 4 / (3 * sqrt(6)))],
)
def test_extremes_of_the_slider_forces(sign, half, printed, size):
    """6.1: 8/(3 sqrt3) across at gamma = 2 arctan sqrt2; 6.2: 4/(3 sqrt6) = 0.544 along at 2 arctan sqrt5."""
    gamma = degrees(2 * atan(half))
    assert round(gamma, 4) == printed
    vectors = [second_order(g) for g in (gamma, gamma - 0.5, gamma + 0.5)]
    here, below, above = (abs(ahead + sign * against.conj()) for ahead, against in vectors)
    assert here == pytest.approx(size, rel=1e-13)
    assert here > max(below, above)


def test_paths_of_the_two_shafts():
    """Section 4: they meet at 90 and 180 degrees."""
    table = recompute("liu-1")
    for column in map(table.columns.index, ("90", "180")):
        assert table.exact[0][column] == pytest.approx(table.exact[1][column], abs=1e-14)
    assert table.exact[5][table.columns.index("0")] == -9


def test_table_3_at_the_largest_force():
    table = recompute("liu-3")
    row = next(row for row in table.exact if row[:2] == ("Zx", 109.5))
    assert row[table.columns.index("45")] == pytest.approx(-8 / (3 * sqrt(3)), abs=1e-6)


def test_most_errata_of_table_3_come_from_0_706_for_cos_45():
    kinds = [e.kind for e in recompute("liu-3").errata]
    assert sum("cos 45° taken as 0.706" in kind for kind in kinds) == 48
    assert kinds.count("misprint") == 8
    assert kinds.count("last digit, truncated") == 2
