"""Gas torque of whole engines by order: identities, and a quadrature that shares nothing with it."""

from itertools import pairwise

import numpy as np
import pytest
from support.cases import cases
from support.engines import RADIAL, build_text
from support.gas_engines import FOUR, WIEBE, draw_engine

from balcli.forces.spectrum import compute_gas_torque, compute_spectra
from balcli.forces.symmetry import explain_symmetry

ORDERS = np.arange(0, 24.5, 0.5)
OF_THE_LARGEST = 1e-12


def scalar(phasors):
    """c_n of `Re sum c_n e^{i n theta}`."""
    return phasors.forward + np.conj(phasors.backward)


def find_plain_rate(found, row, crank):
    """`-s'` of a slider-crank by its own formula, m, at crank angles (rad)."""
    c = found.cylinders
    lam, eps = (np.broadcast_to(v, c.count)[row] for v in (c.lam, c.eps))
    psi = crank + np.radians(c.angle_deg[row])
    beta = np.arcsin(lam * np.sin(psi) - eps)
    return float(c.radius[0]) * (np.sin(psi) + np.cos(psi) * np.tan(beta))


def quadrature(found, orders, find_rate=find_plain_rate):
    """The same by Gauss-Legendre sums over the cycle of each cylinder, of pressures at crank angles times `-s'`."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    cycle = found.gas.cycle
    total = 0
    for row, gas in enumerate(found.gas.cylinders):
        breaks = gas.torque.breaks
        edges = np.concatenate([np.linspace(a, b, 13)[:-1] for a, b in pairwise(breaks)])
        edges = np.append(edges, breaks[-1])
        half = np.diff(edges) / 2
        angle = ((edges[1:] + edges[:-1]) / 2 + half * nodes[:, None]).ravel()
        crank = angle + gas.fires
        rate = find_rate(found, row, crank)
        pressure = gas.torque.pressure.at(angle) - gas.torque.crankcase
        area = np.pi / 4 * found.bore_m**2
        values = gas.share * pressure * area * rate * (half * weights[:, None]).ravel()
        total = total + np.exp(-1j * np.multiply.outer(orders, crank)) @ values
    return total / cycle * np.where(orders == 0, 1, 2)


def assert_same(found, want):
    error = np.abs(scalar(compute_gas_torque(found, ORDERS)) - want)
    assert error.max() < OF_THE_LARGEST * np.abs(want).max()


@pytest.mark.parametrize("strokes", [2, 4])
@pytest.mark.parametrize("seed", range(3))
def test_against_a_quadrature(seed, strokes):
    found = draw_engine(seed, strokes)
    want = quadrature(found, ORDERS)
    assert_same(found, want if strokes == 4 else np.where(ORDERS % 1, 0, want))


HUNG = RADIAL.replace("radial = 7", "radial = 5\nfiring_order = [1, 3, 5, 2, 4]").replace(
    "[piston]", "[piston]\nbore = 120\noffset = 7"
)
HUNG += "[cylinder.4]\ngas = 0\n"


def find_hung_rate(found, row, crank):
    """`-s'` in the radial above, m, from places alone: cylinder 1 has the master rod. Places are
    analytic in the crank angle, so that a step along the imaginary axis differentiates them.
    """
    step = 1e-30

    def turn(x, y, angle):
        return x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)

    def find_place(x, y, length):
        return x + np.sqrt(length**2 - (y - 0.007) ** 2)

    theta = crank + 1j * step
    axis = np.radians(found.cylinders.axis_of_each_deg[row])
    x = 0.06 * np.cos(theta)
    y = 0.06 * np.sin(theta)
    master = find_place(x, y, 0.24)
    if found.numbers[row] == 1:
        return -master.imag / step
    along = (master - x) / 0.24
    across = (0.007 - y) / 0.24
    out = turn(along * 0.052, across * 0.052, axis)
    return -find_place(*turn(x + out[0], y + out[1], -axis), 0.188).imag / step


def test_articulated_cylinders_against_a_quadrature():
    """With a misfire, and a piston offset."""
    found = build_text(HUNG + WIEBE)
    assert_same(found, quadrature(found, ORDERS, find_hung_rate))


@cases("forces/gas", "equal_cylinders_that_fire_evenly_leave_multiples_of_their_number_alone")
def test_equal_cylinders_that_fire_evenly_leave_multiples_of_their_number_alone(throws, firing, strokes):
    text = FOUR.replace("throws = [0, 180, 180, 0]", f"throws = {throws}" if throws else "")
    text = text.replace("[1, 3, 4, 2]", f"{firing}\nstrokes = {strokes}")
    found = build_text(text + WIEBE)
    per_cycle = len(firing) * 2 / strokes
    total = compute_spectra(found, ORDERS, ["gas"])["gas"]
    each = compute_gas_torque(found, ORDERS, by_cylinder=True)
    alone = ORDERS % per_cycle == 0
    assert total.balanced.tolist() == (~alone).tolist()
    sum_of_sizes = len(firing) * np.abs(scalar(each)[:, 0])
    assert np.abs(scalar(total))[alone] == pytest.approx(sum_of_sizes[alone], rel=1e-13)
    why = {r.order: r.verdict for r in explain_symmetry(found, ORDERS[1:], ["gas"]).reasons}
    if strokes == 4:
        assert [why[n] == "symmetry" for n in ORDERS[1:]] == (~alone[1:]).tolist()
    else:
        assert why[0.5] == "none"


def test_a_misfire_leaves_what_the_cylinder_would_have_made():
    whole = build_text(FOUR + WIEBE)
    missing = build_text(FOUR + WIEBE + "[cylinder.3]\ngas = 0\n")
    row = whole.numbers.index(3)
    gone = compute_gas_torque(whole, ORDERS, by_cylinder=True).forward[:, row]
    left = compute_gas_torque(missing, ORDERS).forward
    assert left == pytest.approx(compute_gas_torque(whole, ORDERS).forward - gone, abs=1e-11)
    assert np.all(explain_symmetry(missing, [0.5, 1], ["gas"]).reasons[0].size > 0.9)


def test_totals_are_sums_of_inertia_and_gas():
    found = compute_spectra(draw_engine(3), ORDERS, ["couple", "torque", "gas", "torque_total", "roll_total"])
    couple, torque, gas = (scalar(found[name]) for name in ("couple", "torque", "gas"))
    slack = 1e-13 * np.abs(gas).max()
    assert scalar(found.torque_total) == pytest.approx(torque + gas, abs=slack)
    assert scalar(found.roll_total) == pytest.approx(couple - torque - gas, abs=slack)
