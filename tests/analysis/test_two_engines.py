"""Two engines on one frame: the sum is what one file with all their cylinders gives, or what mirroring curves gives."""

from dataclasses import replace

import numpy as np
import pytest
from oracle import momentum
from support.engines import build_text

from balcli.analysis.two_engines import Arrangement, combine_engines
from balcli.forces import spectrum
from balcli.forces.kinds import EVERY_KIND

ORDERS = np.arange(1.0, 9.0)
RELATIVE = 1e-12
PARTS = """\
[rod]
length = 150
mass = 0.6
cg = 45
inertia = 2500
[piston]
mass = 0.5
offset = 3
[operation]
speed = 3000
{operation}
"""
RIPPLE = "speed_ripple = [{ order = 1, amplitude = 0.03, angle = 40 }]"


def built(crank="", more="", operation=""):
    return build_text(f"[crank]\nstroke = 90\nthrow_mass = 0.8\n{crank}\n" + PARTS.format(operation=operation) + more)


def agree(found, wanted):
    for (quantity, a), (_, b) in zip(found.items(), wanted.items(), strict=True):
        size = np.abs(b.forward).max() + np.abs(b.backward).max() + 1e-9
        assert np.abs(a.forward - b.forward).max() < RELATIVE * size, quantity
        assert np.abs(a.backward - b.backward).max() < RELATIVE * size, quantity


@pytest.mark.parametrize("operation", ["", RIPPLE])
def test_two_singles_behind_one_another_are_a_twin(operation):
    """Pin 2 leads by 110 degrees, so that the second engine's crank angle does."""
    orders = np.arange(0.0, 9.0) if operation else ORDERS
    twin = built("throws = [0, 110]\npositions = [0, 130]", "[frame]\nreference = [10, -20, 30]\n", operation)
    single = built(more="[frame]\nreference = [10, -20, 30]\n", operation=operation)
    plain = built()
    agree(
        combine_engines(single, plain, Arrangement(110, (0, 0, 0.13)), orders).spectra,
        spectrum.compute_spectra(twin, orders),
    )


def test_mirrored_turned_and_placed_against_curves():
    """The second engine's curves, mirrored in y, turned by 35 degrees and moved, taken at its own crank angle."""
    first = built()
    second = built("throws = [0, 90]\nspacing = 110", "[layout]\nbank_angle = 50\nstagger = 20\n")
    how = Arrangement(75, (0.2, -0.3, 0.4), 35, True)
    orders = np.arange(1.0, 40.0)
    both = combine_engines(first, second, how, orders).spectra
    origin = spectrum.compute_spectra(replace(second, reference_m=(0.0, 0.0, 0.0)), orders)
    own = spectrum.compute_spectra(first, orders)
    theta = np.linspace(0, 2 * np.pi, 50)
    ahead = theta + np.radians(75)
    turn = np.exp(1j * np.radians(35))
    force = np.conj(origin.force.values(ahead)) * turn
    z = 0.4 - first.reference_m[2]
    moment = -np.conj(origin.moment.values(ahead)) * turn + 1j * z * force
    couple = -origin.couple.values(ahead) + (np.conj(0.2 - 0.3j) * force).imag
    curves = {"force": force, "moment": moment, "couple": couple, "torque": origin.torque.values(ahead)}
    for name, curve in curves.items():
        wanted = curve + getattr(own, name).values(theta)
        assert np.abs(getattr(both, name).values(theta) - wanted).max() < 1e-11 * np.abs(wanted).max(), name
    assert np.allclose(both.roll.forward, both.couple.forward - both.torque.forward)


def together(lead: int, at: complex, reverse: bool) -> dict[str, np.ndarray]:
    """Torque about the first crank by the energy of all bodies of both engines, and what the frame
    feels about the origin, by their angular momentum and by where the load is.

    Args:
        lead: samples of `momentum.THETA` by which the second engine leads.
        at: its place.
    """
    first, second = (momentum.Engine.read(text) for text in (FIRST, SECOND))
    bodies = [
        [(b.place, b.spin + 0 * momentum.THETA, b) for c in e.cylinders.values() for b in c] for e in (first, second)
    ]
    back = -1 if reverse else 1
    for k, (place, spin, body) in enumerate(bodies[1]):
        ahead = np.roll(place, -lead)
        turning = back * np.roll(spin, -lead)
        bodies[1][k] = ((ahead.conj() if reverse else ahead) + at, turning, body)
    energies = []
    swirl = 0 * momentum.THETA
    for parts in bodies:
        energy = 0 * momentum.THETA
        for place, spin, body in parts:
            velocity = momentum.slope(place)
            energy = energy + body.mass * np.abs(velocity) ** 2 + body.inertia * spin**2
            swirl = swirl + body.mass * (place.conj() * velocity).imag + body.inertia * spin
        energies.append(energy)
    one, other = (-0.5 * first.speed**2 * momentum.slope(energy) for energy in energies)
    couple = -(first.speed**2) * momentum.slope(swirl)
    return {
        "torque": one + other,
        "couple": couple,
        "first": couple - (one + other),
        "second": couple - back * (one + other),
        "both": couple - one - back * other,
    }


FIRST = "[crank]\nstroke = 90\n" + PARTS.format(operation="") + "[frame]\nreference = [0, 0, 0]\n"
SECOND = (
    "[crank]\nstroke = 70\nthrows = [0, 90]\nspacing = 90\n"
    + PARTS.format(operation="").replace("offset = 3", "offset = 0")
    + "[layout]\nbank_angle = 50\n[frame]\nreference = [0, 0, 0]\n"
)


@pytest.mark.parametrize(("reverse", "load"), [(False, "first"), (True, "first"), (True, "second"), (True, "both")])
def test_kinetic_energies_of_geared_engines_add(reverse, load):
    """Against energy and angular momentum of all bodies together: what the load takes, the frame does not feel."""
    wanted = together(128, 0.2 - 0.3j, reverse)
    how = Arrangement(45, (0.2, -0.3, 0), 0, reverse, load)
    one, other = (build_text(text) for text in (FIRST, SECOND))
    found = combine_engines(one, other, how, np.arange(0.0, 60.0)).spectra
    for name, curve in (("torque", wanted["torque"]), ("couple", wanted["couple"]), ("roll", wanted[load])):
        values = found[name].values(momentum.THETA).real
        assert np.abs(values - curve).max() < 1e-9 * np.abs(curve).max(), name


# ------------------------------------------------------------------ with gas
GAS = '[gas]\ncycle = "wiebe"\ncompression_ratio = 10\nimep = 9\n'
HALVES = np.arange(0.0, 8.5, 0.5)


def with_gas(crank="", more="", strokes=4):
    layout = f"[layout]\nstrokes = {strokes}\n{more}"
    return build_text(
        f"[crank]\nstroke = 90\nthrow_mass = 0.8\n{crank}\n"
        + PARTS.format(operation="").replace("mass = 0.5", "bore = 86\nmass = 0.5")
        + layout
        + GAS
    )


def test_two_singles_with_gas_are_a_twin():
    """Its second cylinder fires 250 degrees after the first: half a cycle more would be a misplaced
    revolution, which half orders tell.
    """
    twin = with_gas("throws = [0, 110]\npositions = [0, 130]", "firing_order = [1, 2]\n")
    single = with_gas()
    moved = replace(single, reference_m=twin.reference_m)
    wanted = spectrum.compute_spectra(twin, HALVES, EVERY_KIND)
    assert twin.fires_deg[2] == pytest.approx(250)
    for phase, same in ((-250, True), (110, False)):
        found = combine_engines(moved, single, Arrangement(phase, (0, 0, 0.13)), HALVES).spectra
        size = np.abs(wanted.gas.forward).max()
        agrees = [np.allclose(found[k].forward, wanted[k].forward, atol=1e-11 * size) for k in EVERY_KIND]
        assert all(agrees) == same


def test_two_fours_that_fire_between_each_other_leave_what_an_even_eight_leaves():
    four = with_gas("throws = [0, 180, 180, 0]\nspacing = 90", "firing_order = [1, 3, 4, 2]\n")
    gas = combine_engines(four, four, Arrangement(90), HALVES).spectra.gas
    assert gas.orders[~gas.balanced].tolist() == [0, 4, 8]
    assert gas.forward[8] == pytest.approx(
        2 * spectrum.compute_spectra(four, HALVES, ["gas"]).gas.forward[8], rel=1e-12
    )


@pytest.mark.parametrize("load", ["first", "second", "both"])
def test_gas_of_different_cycles_against_curves(load):
    """A two-stroke single that turns against a four-stroke one: both torques over two turns."""
    first = with_gas()
    second = with_gas(strokes=2)
    how = Arrangement(75, (0.2, 0, 0), 0, True, load)
    found = combine_engines(first, second, how, np.arange(0, 60.5, 0.5)).spectra
    theta = np.linspace(0.3, 4 * np.pi, 40)
    ahead = theta + np.radians(75)
    one, other = (
        spectrum.compute_spectra(single, np.arange(0, 60.5, 0.5), ["gas"]).gas.values(at).real
        for single, at in ((first, theta), (second, ahead))
    )
    taken = {"first": one + other, "second": -one - other, "both": one - other}[load]
    size = np.abs(one).max()
    assert found.gas.values(theta).real == pytest.approx(one + other, abs=1e-10 * size)
    rolled = (found.roll_total.values(theta) - found.roll.values(theta)).real
    assert rolled == pytest.approx(-taken, abs=1e-10 * size)
    assert found.torque_total.values(theta).real == pytest.approx(
        one + other + found.torque.values(theta).real, abs=1e-10 * size
    )
