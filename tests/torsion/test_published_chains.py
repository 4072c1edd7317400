"""Published torsional systems as chain files, to the digits of the print."""

from __future__ import annotations

import math

import pytest
from support.commands import ask_json, ask_torsion


def hertz(text):
    return [mode["frequency_Hz"] for mode in ask_torsion(text)["modes"]]


def row(inertias, stiffness):
    """A file of nodes in a row, kg m2 and N m/rad."""
    nodes = [f'{{ name = "{k}", inertia = "{j} kg m^2" }}' for k, j in enumerate(inertias, 1)]
    shafts = [f'{{ from = "{k}", to = "{k + 1}", stiffness = {s} }}' for k, s in enumerate(stiffness, 1)]
    return f"node = [{', '.join(nodes)}]\nshaft = [{', '.join(shafts)}]\n"


def test_bevan_15_8_in_pounds_and_inches():
    """Two rotors on a stepped shaft, whose steps meet at massless nodes. Bevan counts with g = 32.2
    ft/s2, which makes 22.26 Hz of the 22.25 that standard gravity gives.
    """
    lengths, diameters = [11, 10, 15, 4, 10], [3, 5, 3.5, 7, 5]
    inner = "".join(f'[[node]]\nname = "step {k}"\n' for k in range(1, 5))
    names = ["left", *(f"step {k}" for k in range(1, 5)), "right"]
    shafts = "".join(
        f'[[shaft]]\nfrom = "{a}"\nto = "{b}"\nlength = "{length} in"\ndiameter = "{diameter} in"\n'
        'shear_modulus = "12e6 psi"\n'
        for a, b, length, diameter in zip(names, names[1:], lengths, diameters, strict=False)
    )
    ends = [f'[[node]]\nname = "{n}"\ninertia = "{j} lb ft^2"\n' for n, j in (("left", 1500), ("right", 1000))]
    text = ends[0] + inner + ends[1] + shafts
    (mode,) = ask_json("-q", "torsion", "-", stdin=text)["modes"]  # -q: shafts without density
    found = mode["frequency_Hz"]
    in_feet = math.sqrt(32.2 / (9.80665 / 0.3048))
    assert found * in_feet == pytest.approx(22.25625042)


def test_uniform_chain_with_one_end_fixed():
    """`2 sqrt(k/J) sin((2 i - 1) pi/(2 (2 n + 1)))`; Holzer's table leads to the clamped end."""
    count, inertia, stiffness = 5, 20, 125
    text = 'fixed = ["1"]\n' + row([1, *[inertia] * count], [stiffness] * count)
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
    text = f"""
        fixed = ["wall"]
        node = [
            {{ name = "wall" }},
            {{ name = "flywheel", inertia = "{0.3 * 2240 * 15**2} lb in^2" }},
        ]
        shaft = [
            {{ from = "wall", to = "flywheel", length = "36 in", diameter = "3 in", shear_modulus = "12e6 psi" }},
        ]
        """
    (found,) = hertz(text)
    assert round(found * 60 * math.sqrt(32.2 / (9.80665 / 0.3048))) == 786
