"""Every engine against momentum: positions of all masses on a grid of crank angles, and nothing else.

Velocities and rates are taken from the positions by Fourier differentiation. Force is minus the rate of change of
momentum, the couple that of the moment of momentum about z, the inertia torque minus the rate of change of kinetic
energy over the crank's speed. No acceleration, no harmonic and no rotating vector of the product enters.
"""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from balcli.core.inertia import Device
from balcli.engine import Engine, Ripple, build
from balcli.load import read
from balcli.spectrum import SPECTRAL, spectra

SCALED = 1e-11                  # of the sum of what each cylinder and device makes alone
POINTS = 512
THETA = np.arange(POINTS) * 2 * np.pi / POINTS
HIGHEST = 24
ENGINES = sorted(Path(__file__).parents[2].joinpath("engines").glob("*.toml"))


def rate(values: np.ndarray) -> np.ndarray:
    """Derivative by the crank angle along the last axis."""
    order = np.fft.fftfreq(POINTS, 1 / POINTS)
    return np.fft.ifft(1j * order * np.fft.fft(values))


class Momentum:
    """What an engine does to its frame over a revolution, on the grid, summed over its parts."""

    def __init__(self, engine: Engine) -> None:
        self.omega = engine.omega * (1 + sum(line.amplitude * np.cos(line.order * THETA - np.radians(line.angle_deg))
                                             for line in engine.ripple) + 0 * THETA)
        x, y, self.z_ref = engine.reference_m
        self.centre = x + 1j * y
        self.curves: dict[str, np.ndarray] = {q: np.zeros(POINTS, complex) for q in SPECTRAL}
        self.scale = dict.fromkeys(SPECTRAL, 0.0)
        for row in range(engine.cylinders.count):
            self._cylinder(engine, row)
        for device in engine.devices:
            self._device(device)

    def _cylinder(self, engine: Engine, row: int) -> None:
        c = engine.cylinders

        def own(values: np.ndarray) -> float:
            return float(values[row if len(values) > 1 else 0])
        bank = int(np.searchsorted(c.starts, row, side="right")) - 1
        axis = np.exp(1j * np.radians(c.axis_deg[bank]))
        psi = THETA + np.radians(c.axis_deg[c.first] + c.pin_deg[row] - c.axis_deg[bank])
        radius, lam, eps = float(c.radius), own(c.lam), own(c.eps)
        beta = np.arcsin(lam * np.sin(psi) - eps)
        pin = radius * np.exp(1j * psi) * axis
        piston = (radius * np.cos(psi) + radius / lam * np.cos(beta) + 1j * eps * radius / lam) * axis
        masses = [(own(c.reciprocating), piston), (own(c.rotating), pin)]
        momentum = sum(m * self.omega * rate(place) for m, place in masses)
        spin = sum(m * self.omega * (np.conj(place - self.centre) * rate(place)).imag for m, place in masses)
        lack, beta_rate = own(c.couple), rate(beta).real
        inertia = sum(m * np.abs(rate(place)) ** 2 for m, place in masses) - lack * beta_rate**2
        force = -self.omega * rate(momentum)
        couple = -self.omega * rate(spin + lack * beta_rate * self.omega).real
        self._add(force, float(c.z[row]), couple, -rate(inertia * self.omega**2 / 2).real)

    def _device(self, d: Device) -> None:
        swing = d.forward * np.exp(1j * d.order * THETA) + d.backward * np.exp(-1j * d.order * THETA)
        force = -self.omega * rate(self.omega * rate(swing))
        self._add(force, d.z, (np.conj(d.place - self.centre) * force).imag, np.zeros(POINTS))

    def _add(self, force: np.ndarray, z: float, couple: np.ndarray, torque: np.ndarray) -> None:
        parts = {"force": force, "moment": 1j * (z - self.z_ref) * force, "couple": couple, "torque": torque,
                 "roll": couple - torque}
        for quantity, part in parts.items():
            self.curves[quantity] = self.curves[quantity] + part
            self.scale[quantity] += np.abs(part).max()


def errors(engine: Engine, oracle: Momentum) -> dict[str, float]:
    """Largest difference between product and oracle by quantity, as a share of what the parts make alone."""
    orders = np.arange(0 if engine.ripple else 1, HIGHEST + 1)
    found = {}
    for quantity, phasors in spectra(engine, orders).items():
        spectrum = np.fft.fft(oracle.curves[quantity]) / POINTS
        backward = np.where(orders > 0, spectrum[-orders], 0)
        error = max(np.abs(phasors.forward - spectrum[orders]).max(), np.abs(phasors.backward - backward).max())
        found[quantity] = error / (oracle.scale[quantity] or 1.0)
    return found


def assert_agrees(engine: Engine) -> None:
    found = errors(engine, Momentum(engine))
    assert found.keys() == set(SPECTRAL)
    assert max(found.values()) < SCALED, found


@pytest.mark.parametrize("file", ENGINES, ids=lambda file: file.stem)
def test_every_example_engine(file):
    assert_agrees(build(read(file)))


RIPPLES = {
    "one line": (Ripple(4, 0.02, 30.0),),
    "two lines": (Ripple(1, 0.1, 0.0), Ripple(6, 0.05, -75.0)),
    "the same order twice": (Ripple(2, 0.03, 10.0), Ripple(2, 0.04, 100.0)),
}


@pytest.mark.parametrize("ripple", RIPPLES.values(), ids=RIPPLES.keys())
@pytest.mark.parametrize("name", ["single_shaft", "vr6", "i4_shafts", "v8_crossplane", "v5"])
def test_uneven_speed(name, ripple):
    engine = build(read(Path(ENGINES[0]).with_name(f"{name}.toml")))
    assert_agrees(replace(engine, ripple=ripple))
    assert_agrees(replace(engine, ripple=ripple, reference_m=(0.05, -0.02, 0.1)))


@pytest.mark.parametrize("name", ["single", "vr6", "i4_shafts", "v6_60", "radial5"])
def test_another_point_of_reference(name):
    engine = build(read(Path(ENGINES[0]).with_name(f"{name}.toml")))
    assert_agrees(replace(engine, reference_m=(-0.03, 0.07, 0.2)))


def test_the_oracle_sees_a_small_mistake():
    """One part in a million more of the piston masses."""
    engine = build(read(Path(ENGINES[0]).with_name("i4.toml")))
    heavier = replace(engine.cylinders, reciprocating=engine.cylinders.reciprocating * (1 + 1e-6))
    assert errors(replace(engine, cylinders=heavier), Momentum(engine))["force"] > 1e3 * SCALED
