"""Vibration as a sum over poles, against the equations of every node."""

from dataclasses import replace

import numpy as np
import pytest
from support.chains import KINDS, chain_of, no_damping, random_chain, random_damping

from balcli.torsional_vibration.chain import Damping
from balcli.torsional_vibration.motion import compute_curves
from balcli.torsional_vibration.poles import expand_in_poles
from balcli.torsional_vibration.response import find_largest, find_largest_of_each
from balcli.torsional_vibration.system import Excitation, NodeTorque, Pendulums, TorsionalSystem, ViscousRing

RPM = np.linspace(500, 9000, 7)


def system_of(chain, damping, seed=0, **others) -> TorsionalSystem:
    """Three orders excite every node that is not clamped, by torques that partly grow with the speed."""
    rng = np.random.default_rng(seed)
    nodes = np.flatnonzero(~chain.clamped)
    steady, growing = rng.normal(size=(2, 3, len(nodes), 2)) @ [1, 1j]
    shafts = len(chain.start)
    return TorsionalSystem(
        name="",
        nodes=tuple(f"node {k}" for k in range(len(chain.inertia))),
        shafts=tuple(f"shaft {k}" for k in range(shafts)),
        chain=chain,
        damping=damping,
        stress_by_torque=np.zeros(shafts),
        excitation=Excitation(np.array([0.5, 1.0, 4.0]), nodes, steady, growing * 1e-4),
        last=len(chain.inertia) - 1,
        ends=(int(nodes[0]), -1),
        **others,
    )


def compare_sums(system) -> None:
    """Every curve alone, all at different speeds, and the sums of amplitudes."""
    curves = compute_curves(system, RPM).phasors
    summed = expand_in_poles(system)
    which = np.flatnonzero(summed.spanned)
    assert len(which) == 1 + np.count_nonzero(np.isfinite(system.chain.stiffness))
    assert summed.sum_amplitudes(RPM, which) == pytest.approx(np.abs(curves[:, :, which]).sum(axis=0), rel=1e-7)
    places, columns = (each.ravel() for each in np.meshgrid(np.arange(len(RPM)), which))
    expected = curves[:, places, columns]
    assert summed.find_curves(RPM[places], columns) == pytest.approx(expected, rel=1e-7, abs=1e-9 * abs(expected).max())


@pytest.mark.parametrize("kind", KINDS)
def test_sums_over_poles_are_the_curves(kind):
    for seed in range(4):
        chain = random_chain(kind, seed)
        damping = random_damping(chain, seed)
        loss = np.maximum(damping.loss, 0.01) * (seed > 0)  # without losses, the equations are real
        dashpots = np.maximum(damping.dashpots, 1.0 * (seed == 0))
        compare_sums(system_of(chain, Damping(loss, dashpots * 20, damping.nodes), seed))


@pytest.mark.parametrize("held", [0.0, 3.0], ids=["turns freely", "held by oil"])
def test_viscous_rings_add_poles(held):
    chain = chain_of([0.1, 0.2, 0.5], [1e5, 2e5])
    damping = Damping(np.array([0.01, 0.02]), np.zeros(2), np.array([0, held, 0]))
    system = system_of(chain, damping, rings=(ViscousRing(0, 0.05, 4.0),))
    compare_sums(system)
    assert expand_in_poles(system).poles.shape == (8,)


def test_there_is_no_sum_where_it_would_fail():
    """Nothing damps a mode; pendulums change the poles; two poles coincide in one; too many poles."""
    chain = chain_of([0.1, 0.2, 0.5], [1e5, 2e5])
    damped = Damping(np.full(2, 0.02), np.zeros(2), np.zeros(3))
    assert expand_in_poles(system_of(chain, no_damping(chain))) is None
    system = system_of(chain, damped)
    assert expand_in_poles(system) is not None
    assert expand_in_poles(replace(system, pendulums=(Pendulums(0, 1.0, 0.05, 0.01),))) is None
    critical = chain_of([0.25, 0.25], [1e5])
    oil = 2 * np.sqrt(1e5 * 0.125)  # aperiodic: (s + w)^2 = 0
    for dashpot, exists in ((oil, False), (0.9 * oil, True)):
        damping = Damping(np.zeros(1), np.array([dashpot]), np.zeros(2))
        assert (expand_in_poles(system_of(critical, damping)) is not None) == exists
    for nodes, exists in ((64, True), (65, False)):
        long = chain_of(np.ones(nodes), np.full(nodes - 1, 1e6))
        damping = Damping(np.full(nodes - 1, 0.02), np.full(nodes - 1, 10.0), np.zeros(nodes))
        assert (expand_in_poles(system_of(long, damping)) is not None) == exists


def test_a_massless_node_without_oil_has_no_sum():
    """Its two infinite poles share an eigenvector; an inverse of 1e180 overflowed."""
    chain = chain_of([1.3, 0.0, 0.58], [51000, 26000])
    for oil, exists in ((0.0, False), (5.0, True)):
        damping = Damping(np.full(2, 0.02), np.zeros(2), np.array([0, oil, 0]))
        assert (expand_in_poles(system_of(chain, damping)) is not None) == exists


def vary(kind: str) -> list[TorsionalSystem]:
    """Variants of a chain, the last of which differs in a way of its own."""
    damping = Damping(np.full(2, 0.02), np.full(2, 5.0), np.zeros(3))
    systems = [system_of(chain_of([0.1, 0.2, 0.5 + more], [1e5, 2e5]), damping) for more in (0.0, 0.1, 0.2)]
    if kind == "sums":
        return systems
    stiff = chain_of([0.1, 0.2, 0.5], [1e9, 2e9])  # its resonances are above the range
    torque = NodeTorque(2, 4.0, 4.0, None, lambda rpm: 0.3 + 0 * rpm)
    last = {
        "rigid": system_of(chain_of([0.1, 0.2, 0.5], [np.inf, 2e5]), damping),
        "steady": replace(
            systems[0], excitation=systems[0].excitation._replace(growing=0 * systems[0].excitation.growing)
        ),
        "no sum": system_of(stiff, no_damping(stiff)),
        "no phase": replace(systems[0], torques=(torque,)),
        "orders": replace(systems[0], excitation=systems[0].excitation._replace(orders=np.array([0.5, 1.5, 4.0]))),
    }
    return [*systems[:2], last[kind]]


@pytest.mark.parametrize("kind", ["sums", "rigid", "steady", "orders", "no sum", "no phase"])
@pytest.mark.parametrize("weights", [None, np.array([0.0, 2.0]), np.zeros(2)], ids=["all", "one shaft", "none"])
def test_variants_are_searched_together_as_each_alone(kind, weights):
    systems = vary(kind)
    speeds = [np.linspace(500, 9000, 40), np.linspace(400, 9000, 40), np.linspace(500, 8000, 31)]
    assert (expand_in_poles(systems[-1]) is None) == (kind == "no sum")
    together = find_largest_of_each(systems, speeds, weights)
    for system, rpm, found in zip(systems, speeds, together, strict=True):
        for alone, values in zip(find_largest(system, rpm, weights), found, strict=True):
            assert values == pytest.approx(alone, rel=1e-12)
            assert values.shape == alone.shape
