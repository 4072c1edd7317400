"""Six-cylinder Diesel engine (MWM): chain of nine inertias, and vibratory torque in every shaft.

Data: Mendes, Meirelles and Zampieri, Analysis of torsional vibration in internal combustion engines,
Proc. IMechE K 222 (2008), doi 10.1243/14644193JMBD126, Fig. 4, as digitised for openTorsion
(Aalto-Arotor/openTorsion, examples/ICE_example.py and ICE_data). Figures to compare with: that
example, run with openTorsion 0.3.2.
"""

import numpy as np
import pytest
from support.chains import balance_power
from support.diesel import DIAGRAM, INERTIAS, NATURAL_HZ, STIFFNESSES
from support.paths import ROOT

from balcli.core.peaks import find_swing, sum_amplitudes
from balcli.torsional_vibration.chain import ChainShaft, Damping, join_chain
from balcli.torsional_vibration.modes import find_chain_modes, locate_nodes
from balcli.torsional_vibration.motion import respond_chain

DOCUMENT = ROOT / "docs" / "torsion.md"
LOSS = 0.035
CHAIN = join_chain(INERTIAS, [ChainShaft(i, i + 1, k) for i, k in enumerate(STIFFNESSES)])
DAMPING = Damping(np.full(8, LOSS), np.zeros(8), np.array([0, 0, 2, 2, 2, 2, 2, 2, 0.0]))
BORE = 0.105
RADIUS = 0.137 / 2
ROD = 0.207
RECIPROCATING = 2.521
TURNS_AT_FIRING = np.array([0, 4, 2, 5, 1, 3]) / 3  # of cylinders 1 to 6: order 1 5 3 6 2 4

PRESSURE = [*np.transpose(DIAGRAM) * [[25 / 41], [2 / 517]]]  # crank angle (deg), pressure (MPa), with a peak of 15.2
# fmt: off
PEAK = [  # speed (rpm), peak pressure (MPa)
    (997.846881, 14.27833), (1097.21795, 14.27833), (1197.84938, 14.2664016), (1296.0051, 14.0636183),
    (1396.47399, 14.8270378), (1495.84506, 14.8270378), (1595.21612, 14.8270378), (1693.30182, 14.9582505),
    (1799.00221, 14.7673956), (1898.37328, 14.7673956), (1998.9722, 14.9105368), (2097.08791, 14.8986083),
    (2197.66433, 15.1491054), (2298.64336, 13.4791252), (2398.36453, 11.8091451), (2550.55078, 5.88071571),
]
# fmt: on

SUMS_OF_AMPLITUDES = {
    1000: [56.0, 85.3, 4106.4, 5302.5, 3790.0, 6244.4, 5925.2, 2825.9],
    1500: [244.3, 370.5, 4832.3, 6246.1, 5124.9, 7765.9, 7499.1, 4401.0],
    2000: [439.1, 665.3, 5303.8, 6965.9, 6174.9, 8857.2, 8650.6, 5959.8],
    2250: [664.4, 1005.3, 5769.0, 7442.7, 7170.8, 9759.1, 9610.6, 6967.7],
    2500: [264.1, 398.8, 2701.7, 3318.8, 3006.1, 4187.9, 3972.9, 2458.6],
}


def torque(rpm, angle):
    """Of one cylinder, N m: gas and inertia force along the cylinder, the latter as a series."""
    pressure = np.interp(np.degrees(angle), *PRESSURE) / 15.2
    pressure = pressure * np.interp(rpm, *np.transpose(PEAK)) * 1e6
    lam = RADIUS / ROD
    cosines = {1: 1, 2: lam, 4: -(lam**3) / 4, 6: 9 * lam**5 / 128}
    series = sum(a * np.cos(n * angle) for n, a in cosines.items())
    inertia = -RECIPROCATING * RADIUS * (rpm * np.pi / 30) ** 2 * series
    tilt = np.arcsin(lam * np.sin(angle))
    along = pressure * np.pi / 4 * BORE**2 + inertia
    return along * RADIUS * np.sin(angle + tilt) / np.cos(tilt)


def loads(harmonics, orders, sense):
    """Torques (orders, 9) on the nodes; nodes 3 to 8 are cylinders."""
    result = np.zeros((len(orders), 9), complex)
    turned = np.exp(sense * 2j * np.pi * np.outer(orders, TURNS_AT_FIRING))
    result[:, 2:8] = harmonics[:, None] * turned
    return result


def exact_loads(rpm):
    """Orders 0.5 to 12 of a fine sampling."""
    count = 1 << 14
    angle = np.arange(count) * 4 * np.pi / count
    orders = np.arange(1, 25) / 2
    return orders, loads(2 * np.fft.rfft(torque(rpm, angle))[1:25] / count, orders, -1)


def test_natural_frequencies():
    modes = find_chain_modes(CHAIN)
    assert modes.omega / (2 * np.pi) == pytest.approx([0, *NATURAL_HZ], rel=1e-9)
    located = [locate_nodes(CHAIN, shape, omega) for shape, omega in zip(modes.shapes, modes.omega, strict=True)]
    assert [sum(map(len, nodes)) for nodes in located] == list(range(9))


@pytest.mark.parametrize("rpm", SUMS_OF_AMPLITUDES)
def test_sums_of_amplitudes_as_the_example_makes_them(rpm):
    """Every printed figure, with what the example does: 500 samples with 0 and 720 deg both among
    them, so that its orders are 0.499, 0.998 and so on; the elastic part of the torque alone; firing
    angles added instead of subtracted; amplitudes summed.
    """
    angle = np.linspace(0, 4 * np.pi, 500)
    orders = np.arange(1, 25) / 2 * 499 / 500
    load = loads(2 * np.fft.rfft(torque(rpm, angle))[1:25] / 500, orders, 1)
    twist = respond_chain(CHAIN, DAMPING, orders * rpm * np.pi / 30, load)
    elastic = np.abs(twist.torque / (1 + 1j * LOSS)).sum(axis=0)
    assert np.round(elastic, 1).tolist() == SUMS_OF_AMPLITUDES[rpm]


@pytest.mark.parametrize("rpm", SUMS_OF_AMPLITUDES)
def test_exact_orders_synthesised_in_time(rpm):
    """Like in size and shape, and 1.2 to 2.5 times less than the sum of amplitudes."""
    orders, load = exact_loads(rpm)
    w = np.multiply.outer(orders, rpm * np.pi / 30)
    twist = respond_chain(CHAIN, DAMPING, w, load)
    sums = sum_amplitudes(twist.torque)
    half = find_swing(orders, twist.torque).half
    assert sums == pytest.approx(SUMS_OF_AMPLITUDES[rpm], rel=0.06)
    assert np.all((sums / half > 1.2) & (sums / half < 2.5))
    angle = np.linspace(0, 4 * np.pi, 1 << 14)
    curve = (np.exp(1j * np.outer(angle, orders)) @ twist.torque).real
    assert half == pytest.approx(np.ptp(curve, axis=0) / 2, rel=1e-4)
    power = balance_power(CHAIN, DAMPING, w, load, twist.angle)
    lost = power.shafts.sum(axis=-1) + power.nodes.sum(axis=-1)
    assert power.fed == pytest.approx(lost, rel=1e-9)


def test_figures_of_the_document():
    """docs/torsion.md shows both at 2000 rpm."""
    orders, load = exact_loads(2000)
    twist = respond_chain(CHAIN, DAMPING, np.multiply.outer(orders, 2000 * np.pi / 30), load)
    shown = [
        [float(cell) for cell in line.split("|")[2:5]]
        for line in DOCUMENT.read_text(encoding="utf-8").partition("torques at 2000 rpm")[2].splitlines()[4:12]
    ]
    half = find_swing(orders, twist.torque).half
    columns = SUMS_OF_AMPLITUDES[2000], sum_amplitudes(twist.torque), half
    assert np.transpose(shown) == pytest.approx(np.array(columns), abs=0.06)
