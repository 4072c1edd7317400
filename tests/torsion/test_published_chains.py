"""Published torsional systems as chain files, to the digits of the print."""

import math
from itertools import pairwise

import pytest
from support.chains import chain_text
from support.commands import ask_json, ask_torsion


def hertz(text):
    return [mode["frequency_Hz"] for mode in ask_torsion(text)["modes"]]


def test_bevan_15_8_in_pounds_and_inches():
    """Two rotors on a stepped shaft, whose steps meet at massless nodes. Bevan counts with g = 32.2
    ft/s2, which makes 22.26 Hz of the 22.25 that standard gravity gives.
    """
    names = ["left", "step 1", "step 2", "step 3", "step 4", "right"]
    steel = {"shear_modulus": "12e6 psi"}
    pieces = zip((11, 10, 15, 4, 10), (3, 5, 3.5, 7, 5), strict=True)
    plain = [{"length": f"{length} in", "diameter": f"{diameter} in"} | steel for length, diameter in pieces]
    ends = {"left": {"inertia": "1500 lb ft^2"}, "right": {"inertia": "1000 lb ft^2"}}
    text = chain_text(dict.fromkeys(names, 0) | ends, dict(zip(pairwise(names), plain, strict=True)))
    (mode,) = ask_json("-q", "torsion", "-", stdin=text)["modes"]  # -q: shafts without density
    found = mode["frequency_Hz"]
    in_feet = math.sqrt(32.2 / (9.80665 / 0.3048))
    assert found * in_feet == pytest.approx(22.25625042)


def test_uniform_chain_with_one_end_fixed():
    """`2 sqrt(k/J) sin((2 i - 1) pi/(2 (2 n + 1)))`; Holzer's table leads to the clamped end."""
    count, inertia, stiffness = 5, 20, 125
    nodes = {str(k): 1 if k == 1 else inertia for k in range(1, count + 2)}
    text = chain_text(nodes, dict.fromkeys(pairwise(nodes), stiffness), fixed=["1"])
    exact = [
        2 * math.sqrt(stiffness / inertia) * math.sin((2 * i - 1) * math.pi / (2 * (2 * count + 1)))
        for i in range(1, count + 1)
    ]
    assert [2 * math.pi * f for f in hertz(text)] == pytest.approx(exact, rel=1e-13)
    (table,) = ask_torsion(text, "--holzer", "2")["holzer"]
    assert table["rows"][-1]["angle"] == 1
    assert table["rows"][0]["angle"] == pytest.approx(0, abs=1e-12)


def test_bevan_15_1_flywheel_on_a_cantilever():
    """0.3 long tons of radius of gyration 15 in on 36 in of 3 in shaft: 786 a minute."""
    flywheel = {"inertia": f"{0.3 * 2240 * 15**2} lb in^2"}
    shaft = {"length": "36 in", "diameter": "3 in", "shear_modulus": "12e6 psi"}
    text = chain_text({"wall": 0, "flywheel": flywheel}, {("wall", "flywheel"): shaft}, fixed=["wall"])
    (found,) = hertz(text)
    assert round(found * 60 * math.sqrt(32.2 / (9.80665 / 0.3048))) == 786
