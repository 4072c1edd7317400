"""Uneven crank speed: `omega = mean (1 + sum of lines)`; momentum is multiplied by it before it is differentiated.

With W = omega/mean and momentum `mean W G`, the force is `-mean^2 W (W G)'`, the couple the same of the moment of momentum,
and the inertia torque `-mean^2 1/2 (I W^2)'` (from `-(1/2 I' omega^2 + I omega omega')`, THEORY 4). In Fourier
coefficients all of these are short convolutions, so that every order stays as exact as at steady speed.
"""
from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from .phasors import EPS, Array, Complex, Phasors, unit


def speed(lines: Iterable[tuple[int, float, float]]) -> Complex:
    """Two-sided coefficients of W for lines (order, amplitude, angle in degrees), orders -k .. k."""
    lines = list(lines)
    highest = max(order for order, _, _ in lines)
    w = np.zeros(2 * highest + 1, complex)
    w[highest] = 1
    for order, amplitude, angle in lines:
        half = amplitude / 2 * unit(-angle)
        w[highest + order] += half
        w[highest - order] += np.conj(half)
    return w


def force(steady: Phasors, w: Complex, mean: float = 0.0) -> Phasors:
    """Force (or moment, or couple) under W, from that at steady speed for the dense orders 0 .. n; correct up to order
    n - 2k. `mean` is the mean momentum (for the couple: of the rotating masses), which a steady speed does not show."""
    def shake(momentum: Complex, w: Complex, rate: Complex) -> Complex:
        return -np.convolve(rate * np.convolve(momentum, w, "same"), w, "same")
    return _transformed(steady, w, mean, shake)


def torque(steady: Phasors, w: Complex, mean: float) -> Phasors:
    """Inertia torque under W likewise; `mean` is the mean inertia I_0 (kg m2)."""
    def shake(momentum: Complex, w: Complex, rate: Complex) -> Complex:
        return -rate * np.convolve(np.convolve(momentum, w, "same"), w, "same")
    return _transformed(steady, w, mean / 2, shake)


def _transformed(steady: Phasors, w: Complex, mean: float, shake: Callable[[Complex, Complex, Complex], Complex]) -> Phasors:
    n = len(steady.orders) - 1
    order = np.arange(-n, n + 1.0)
    momentum = 1j * _two_sided(steady) / np.where(order, order, 1)          # steady force = -i n momentum
    momentum[n] = mean
    noise = np.abs(_two_sided(Phasors(steady.orders, *2 * [np.broadcast_to(steady.noise, steady.forward.shape) + 0j], steady.noise)))
    scale = noise / EPS                                                     # sizes of the parts, as their noise tells them
    scale[n] = max(scale[n], abs(mean))
    result = shake(momentum, w, 1j * order)
    error = EPS * np.abs(shake(scale / np.where(order, np.abs(order), 1) + 0j, np.abs(w) + 0j, np.abs(order) + 0j))
    backward = np.where(steady.orders > 0, result[n::-1], 0)
    return Phasors(steady.orders, result[n:], backward, np.maximum(error[n:], error[n::-1]))


def _two_sided(phasors: Phasors) -> NDArray[np.complex128]:
    """Coefficients of e^{i n theta} for n = -N .. N."""
    return np.concatenate([phasors.backward[:0:-1], phasors.forward])
