"""Work of the cylinders' torques on a mode, over one cycle of vibration."""

from __future__ import annotations

import numpy as np
import pytest

import balcli


def test_work_is_that_of_harmonic_torques_on_a_harmonic_motion_of_the_worst_phase():
    """Torques Re(T e^{i wt}) on angles Re(B shape e^{i wt}), |B| = 1: integrated over a cycle in
    time, for the phase of B at which they do most.
    """
    found = balcli.analyze_torsion(balcli.load_example("i6_diesel"))
    system, modes = found.system, {mode.number: mode for mode in found.modes}
    turn = np.exp(2j * np.pi * np.arange(64) / 64)
    for critical in found.criticals[:12]:
        mode = modes[critical.mode]
        k = list(system.excitation.orders).index(critical.order)
        torques = system.excitation.at(np.full(len(system.excitation.orders), mode.omega / critical.order))[k, k]
        shape = mode.shape[system.excitation.nodes]
        rates = np.multiply.outer(np.exp(1j * np.linspace(0, 2 * np.pi, 721)), 1j * turn).real
        power = (torques[:, None] * turn).real * shape[:, None]
        assert critical.work == pytest.approx((rates @ power.sum(axis=0)).max() * 2 * np.pi / 64, rel=1e-4)
