"""Bevan, The Theory of Machines, chapter 15, example 7 (p. 563), in the FOSSEE Python Textbook
Companions: 200 lb on springs that pass on 1/30 of the unbalance at 1200 rpm without damping; 3 lb
reciprocate with a stroke of 3.5 in; damping with a^2/b = 1/198 (that is (2 zeta)^2).

The companion's figures are slips. Force at 1200 rpm: it prints 214.6 lb, the unbalance force itself
(a quotient became a sum); 7.69 lb are passed on. At resonance: its 7 lb is the unbalance force
there; 98 lb are passed on, and its amplitude of 0.643 in takes 152 lb/in, where the springs that
pass on 1/30 have 264: 0.369 in.
"""

import numpy as np
import pytest
from support.rigid_bodies import respond_body

from balcli.mounts.rigid_body import Body, Mounts

G = 32.2 * 12  # in/s^2
SPEED = 1200 * np.pi / 30
OWN = SPEED / np.sqrt(1 + 30)
STIFFNESS = 200 / G * OWN**2
DAMPING = np.sqrt(1 / 198) * np.sqrt(STIFFNESS * 200 / G)
MACHINE = Body(200 / G, np.zeros(3), np.eye(3))


def on_mounts(damping):
    """Four in a square about the centre, so that upright motion is alone."""
    at = np.array([[0, 1, 1], [0, 1, -1], [0, -1, 1], [0, -1, -1]]) * 10.0
    each = np.ones((4, 3)) / 4
    axes = np.tile(np.eye(3), (4, 1, 1))
    return Mounts(at, axes, STIFFNESS * each, 0 * each, damping * each)


def unbalance(speed):
    return 3 / G * 3.5 / 2 * speed**2


def passed_on(speed, damping):
    """Force on all mounts and amplitude of the machine, upright."""
    load = np.array([unbalance(speed), 0, 0, 0, 0, 0])
    response = respond_body(MACHINE, on_mounts(damping), speed, load)
    return abs(response.forces[:, 0].sum()), abs(response.motion[0])


def test_without_damping():
    force, _ = passed_on(SPEED, 0)
    assert unbalance(SPEED) == pytest.approx(214.5566174, rel=1e-9)
    assert round(unbalance(SPEED), 1) == 214.6
    assert force == pytest.approx(unbalance(SPEED) / 30, rel=1e-12)


def test_with_damping():
    force, _ = passed_on(SPEED, DAMPING)
    assert force / unbalance(SPEED) == pytest.approx(0.03584479651, rel=1e-9)
    assert force == pytest.approx(7.690738291, rel=1e-9)


def test_at_resonance():
    force, amplitude = passed_on(OWN, DAMPING)
    assert OWN * 30 / np.pi == pytest.approx(215.5263624, rel=1e-9)
    assert round(unbalance(OWN)) == 7
    assert force == pytest.approx(unbalance(OWN) * np.sqrt(199))
    at_rounded_speed = (215.5 / (OWN * 30 / np.pi)) ** 2  # the companion's 215.5 rpm
    assert force * at_rounded_speed == pytest.approx(97.6113926, rel=1e-9)
    assert amplitude == pytest.approx(unbalance(OWN) / (STIFFNESS * np.sqrt(1 / 198)))
    assert amplitude * STIFFNESS / 152 == pytest.approx(0.643, rel=0.005)
