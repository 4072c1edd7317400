"""Compute the effect of an uneven crank speed on inertia forces and torques.

Forces: the speed is given as `omega = omega_m W`, where omega_m is the mean speed and W is 1 plus a
few harmonics ("lines"). A prime is a derivative by the crank angle. If G is the momentum at crank
speed 1, the momentum is `omega_m W G` and the force `-omega_m^2 W (W G)'`; the couple follows in
the same way from the moment of momentum. With the moment of inertia I, the inertia torque is
`-omega_m^2 1/2 (I W^2)'` (from `-(1/2 I' omega^2 + I omega omega')`, docs/theory.md). For Fourier
coefficients these products are short convolutions, so every order is as exact as at steady speed.
Orders are whole, or multiples of 1/2 if the speed repeats itself after two revolutions.

At uneven speed, a curve is one sum of harmonics of the crank angle and another sum of harmonics of
the time. "Orders over the angle" are oscillations per revolution. "Orders over the time" are
oscillations per mean time of a revolution, as a spectrum analyser shows them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from .peaks import Peak, find_swing
from .phasors import EPS, Array, Complex, Figure, Phasors, unit

Number = TypeVar("Number", np.float64, np.complex128)
# An order over the angle that adds less than this share of itself to an order over the time adds 0.
_FELT = 1e-13


class RippleLine(NamedTuple):
    """One harmonic of the relative speed W: `amplitude cos(order theta - angle)`."""

    order: float
    amplitude: Figure
    angle_deg: Figure


def find_speed(lines: Iterable[RippleLine], step: float = 1.0) -> Complex:
    """Return the Fourier coefficients of W at all multiples of the step from minus the highest
    order of the lines to this order, shape (2 k + 1, *trailing), where k is the highest order
    divided by the step.

    Args:
        lines: Harmonics of the uneven speed; their orders are multiples of the step.
        step: 1, or 1/2 if some orders are halves.
    """
    halves = [
        (round(order / step), amplitude / 2 * unit(-angle)) for order, amplitude, angle in lines
    ]
    highest = max(order for order, _ in halves)
    trailing = np.broadcast_shapes(*(half.shape for _, half in halves))
    w: Complex = np.zeros((2 * highest + 1, *trailing), complex)
    w[highest] = 1
    for order, half in halves:
        w[highest + order] += half
        w[highest - order] += half.conj()
    return w


def find_slowest(lines: Sequence[RippleLine]) -> Peak:
    """Return the least W over a cycle, and the first crank angle (rad) at which it is reached. The
    lines must have no trailing axes.
    """
    w = find_speed(lines, 0.5)
    orders = np.arange(len(w) // 2 + 1.0) / 2
    lowest = find_swing(orders, np.where(orders, 2, 1) * w[len(w) // 2 :]).lowest
    return Peak(float(lowest.value), float(lowest.angle))


class Timetable(NamedTuple):
    """Times at which a crank of uneven speed passes equally spaced angles of a cycle.

    Attributes:
        clock: Time at which the crank passes each angle, shape (samples,), measured as an angle
            (rad): the angle through which a crank of the same cycle time turns until then at
            uniform speed. The zero of the time is arbitrary.
        stay: Time per angle, relative to its mean, shape (samples,).
        step: Step of the orders: 1 for a cycle of one turn, 1/2 for a cycle of two turns.
        turns: Speed averaged over the time, relative to the speed averaged over the angle.
    """

    clock: Array
    stay: Array
    step: float
    turns: float


def find_timetable(w: Complex, step: float, samples: int) -> Timetable:
    """Return the timetable of a speed W.

    Args:
        w: Coefficients from `find_speed` with this step, shape (2 k + 1,).
        step: Step of the orders, 1 or 1/2.
        samples: Number of samples of a cycle of 1 / step turns, many more than 2 k.
    """
    reach = len(w) // 2
    k = np.fft.fftfreq(samples, 1 / samples)
    speed = np.zeros(samples, complex)
    speed[np.arange(-reach, reach + 1)] = w
    slow = 1 / np.fft.ifft(speed, norm="forward").real
    stay = slow / slow.mean()
    waves = np.fft.fft(stay - 1, norm="forward") / (1j * step * np.where(k, k, 1))
    angle = np.arange(samples) * (2 * np.pi / (step * samples))
    clock = angle + np.fft.ifft(waves, norm="forward").real
    return Timetable(clock, stay, step, float(1 / slow.mean()))


def find_reach(timetable: Timetable, order: float) -> float:
    """Return the highest order over the crank angle that contributes to an order over the time.

    Args:
        timetable: Times of the crank angles.
        order: Order over the time.
    """
    wave = timetable.stay * np.exp(1j * order * timetable.clock)
    felt = np.flatnonzero(np.abs(np.fft.fft(wave, norm="forward")) > _FELT)
    return float(np.minimum(felt, len(wave) - felt).max() * timetable.step)


def count_in_time(curve: Phasors, timetable: Timetable, orders: Array) -> Phasors:
    """Return the orders over the time (cycles per mean revolution) of a curve over the crank angle.

    Args:
        curve: Curve without trailing axes, with all orders that contribute.
        timetable: Times of the crank angles.
        orders: Wanted orders over the time, multiples of the step, shape (orders,).
    """
    series = np.zeros(len(timetable.clock), complex)
    rows = np.rint(curve.orders / timetable.step).astype(int)
    np.add.at(series, rows, curve.forward)
    np.add.at(series, -rows, curve.backward)
    felt = np.fft.ifft(series, norm="forward") * timetable.stay
    waves = (np.exp(1j * order * timetable.clock) for order in orders)
    both = [(np.mean(felt * wave.conj()), np.mean(felt * wave)) for wave in waves]
    vectors = np.array(both, complex).reshape(-1, 2).T
    vectors[1, orders == 0] = 0
    noise = np.full(orders.shape, 8 * EPS * np.sum(np.abs(curve.vectors)))
    return Phasors(orders, vectors, noise).drop_noise()


def apply_speed(
    steady: Phasors, w: Complex, mean: Figure = 0.0, *, rate_last: bool = False
) -> Phasors:
    """Return the force, moment, couple or inertia torque at the uneven speed W.

    Args:
        steady: Force, moment, couple or torque at a steady speed, for all orders 0, 1 .. n (or 0,
            1/2 .. n).
        w: Coefficients from `find_speed` with the same step, up to order k.
        mean: Mean momentum times the mean speed, N; for the couple, mean moment of momentum times
            the mean speed, N m; for the torque, half the mean inertia times the square of the mean
            speed, N m. At a steady speed, it has no effect.
        rate_last: Whether both factors W are inside the derivative, `-(W W momentum)'`, as for a
            torque; else `-W (W momentum)'`.

    Returns: The phasors for the same orders, correct up to order n - 2k.
    """

    def shake(momentum: Complex, w: Complex, rate: Complex) -> Complex:
        once = _convolved(momentum, w)
        return -rate * _convolved(once, w) if rate_last else -_convolved(rate * once, w)

    n = len(steady.orders) - 1
    forces = _two_sided(steady.backward, steady.forward)
    both = np.broadcast_to(steady.noise, steady.forward.shape)
    noise = _two_sided(both, both)
    step = steady.orders[1] if n else 1.0
    order = (np.arange(-n, n + 1.0) * step).reshape(-1, *(1,) * (forces.ndim - 1))
    divisor = np.where(order, order, 1)
    shape = (2 * n + 1, *np.broadcast_shapes(forces.shape[1:], np.shape(mean)))
    momentum = np.broadcast_to(1j * forces / divisor, shape).copy()  # force = -i n momentum
    momentum[n] = mean
    # magnitudes of momenta whose rounding errors are this noise
    sizes = np.broadcast_to(noise / EPS / np.abs(divisor), shape).copy()
    sizes[n] = np.maximum(sizes[n], np.abs(mean))
    result = shake(momentum, w, np.asarray(1j * order, np.complex128))
    magnitudes = (np.asarray(v, np.complex128) for v in (sizes, np.abs(w), np.abs(order)))
    error = EPS * np.abs(shake(*magnitudes))
    backward = np.where(order[n:] > 0, result[n::-1], 0)
    # The bound of the error of order -n is that of order n.
    return Phasors.of(steady.orders, result[n:], backward, error[n:])


def _convolved(series: Complex, w: Complex) -> Complex:
    """Return the convolution, sum over k of w_k series_(n-k), cut to the orders of `series`."""
    reach = len(w) // 2
    ends = np.zeros((reach, *series.shape[1:]), complex)
    padded = np.concatenate([ends, series, ends])
    return np.asarray(
        sum(
            w[reach + k] * padded[reach - k : len(padded) - reach - k]
            for k in range(-reach, reach + 1)
            if np.any(w[reach + k])
        )
    )


def _two_sided(backward: NDArray[Number], forward: NDArray[Number]) -> NDArray[Number]:
    """Return the rows of the orders -N .. N: backward rows N .. 1, then forward rows 0 .. N."""
    return np.concatenate([backward[:0:-1], forward])
