"""The harmonics against a computation in mpmath that shares nothing with the closed forms: the trapezoidal rule over a
revolution of the textbook's own expressions, which converges geometrically for a periodic analytic function.
"""

from collections.abc import Sequence
from functools import cache

import mpmath as mp
import numpy as np
import pytest

from balcli.core.mechanisms import closed_form, harmonics

RELATIVE = 1e-14  # of each order to 32 of the centred mechanism, twice that to 64, where it is above 1e-290
ABSOLUTE = 1e-15  # of the offset mechanism, in units of the first order
SMALLEST = 1e-290
ORDERS = np.arange(1, 65)
LAMBDAS = [1e-6, 1e-3, 0.05, 0.2632, 0.3, 0.32, 0.4, 0.6180339887, 0.9, 0.95, 0.999]
SERIES = ("piston", "rod", "kinetic", "rod_kinetic")
OFFSETS = [(0.2632, 0.01), (0.25, -0.08), (0.3, 0.002), (0.45, 0.3), (0.3, 0.65), (1e-3, 0.5)]  # lam + |eps| <= 0.95


@pytest.fixture(autouse=True, scope="module")
def _digits():
    with mp.workdps(110):  # order 64 at lambda = 0.2632 is 1e-56 of what is summed
        yield


@cache
def of_revolution(lam: float, eps: float = 0.0, highest: int = 64, digits: int = 25) -> dict[str, list[mp.mpc]]:
    """Coefficients c_n of `Re c_n e^{i n psi}` for the orders 0 .. highest, by sampling one revolution."""
    steep = mp.mpf(lam) / (1 - abs(mp.mpf(eps)))
    decay = mp.log10((1 + mp.sqrt(1 - steep**2)) / steep)
    least = int(2 * highest + digits / decay)  # aliases are below 10^-digits of order `highest`
    count = 1 << least.bit_length()
    turn = [mp.expjpi(mp.mpf(-2 * k) / count) for k in range(count)]
    motions = zip(*(motion(-e.imag, e.real, mp.mpf(lam), mp.mpf(eps)) for e in turn), strict=True)
    return {
        name: [(1 if n == 0 else 2) * value / count for n, value in enumerate(transform(samples, turn)[: highest + 1])]
        for name, samples in zip(SERIES, motions, strict=True)
    }


def transform(values: Sequence[mp.mpf], turn: list[mp.mpc]) -> list[mp.mpc]:
    """`sum values_k turn_1^(n k)` for every n, `turn` the powers of a root of unity as many as the
    values, a power of two: those of even and of odd places, each transformed (Cooley and Tukey).
    """
    if len(values) == 1:
        return [mp.mpc(values[0])]
    even, odd = (transform(values[first::2], turn[::2]) for first in (0, 1))
    odd = [e * value for e, value in zip(turn, odd, strict=False)]
    return [*(a + b for a, b in zip(even, odd, strict=True)), *(a - b for a, b in zip(even, odd, strict=True))]


def motion(sine: mp.mpf, cosine: mp.mpf, lam: mp.mpf, eps: mp.mpf) -> tuple[mp.mpf, ...]:
    """-s''/r, -beta'', (s'/r)^2 and beta'^2 as docs/theory.md has them."""
    sin_beta = lam * sine - eps
    cos_beta = mp.sqrt(1 - sin_beta**2)
    tangent = sin_beta / cos_beta
    rate = lam * cosine / cos_beta
    return (
        cosine - sine * tangent + lam * cosine**2 / cos_beta**3,
        lam * sine / cos_beta - rate**2 * tangent,
        (sine + cosine * tangent) ** 2,
        rate**2,
    )


def centred(name: str, orders: Sequence[int], lam: float | np.ndarray) -> np.ndarray:
    """Coefficients of the closed form, of the rod those of its sines."""
    c = closed_form.find_harmonics(orders, lam)[name].c
    return -c.imag if name == "rod" else c


def worst(got: np.ndarray, want: list[mp.mpf]) -> float:
    """Largest relative error over the orders, by n/32 beyond 32; what must be 0 has to be 0."""
    errors = [0.0]
    for n, value in zip(ORDERS, got, strict=True):
        exact = want[n]
        if abs(exact) > SMALLEST:
            errors.append(float(abs((mp.mpf(float(value)) - exact) / exact)) / max(1, n / 32))
        else:
            assert abs(value) <= SMALLEST, (n, value)
    return max(errors)


@pytest.mark.parametrize("lam", LAMBDAS)
def test_centred_against_the_trapezoidal_rule(lam):
    with mp.workdps(110 if lam > 0.2 else 330):  # orders below lambda = 0.2 go down to SMALLEST
        want = of_revolution(lam)
        least = mp.mpf(10) ** (30 - mp.mp.dps)
    for name in SERIES:
        exact = [c if name != "rod" else -c.imag for c in want[name]]
        exact = [c.real if abs(c) > least else mp.mpf(0) for c in exact]
        assert worst(centred(name, ORDERS, lam), exact) < RELATIVE, name


@pytest.mark.parametrize("lam", [1e-3, 0.3, 0.999])
def test_means_of_the_squares(lam):
    """Order 0 enters the mean inertia under uneven speed."""
    want = of_revolution(lam)
    for name in ("kinetic", "rod_kinetic"):
        assert centred(name, [0], lam)[0] == pytest.approx(float(mp.re(want[name][0])), rel=RELATIVE)


@pytest.mark.slow
@pytest.mark.parametrize("lam", [0.9, 0.97, 0.995])
def test_high_orders_lose_a_rounding_an_order(lam):
    """Orders about 600 are 1e-29 to 1e-121; their relative error is that of the power x^n."""
    with mp.workdps(145):
        count = 1700  # aliases of orders above 1098
        turn = [mp.expjpi(mp.mpf(2 * k) / count) for k in range(count)]
        motions = (motion(e.imag, e.real, mp.mpf(lam), mp.mpf(0)) for e in turn)
        curves = dict(zip(SERIES, zip(*motions, strict=True), strict=True))
        for name, n in (("piston", 600), ("rod", 601), ("kinetic", 600), ("kinetic", 601), ("rod_kinetic", 600)):
            waves = ((e.imag if name == "rod" else e.real) for e in (turn[n * k % count] for k in range(count)))
            want = 2 * mp.fdot(curves[name], waves) / count
            got = centred(name, [n], lam)[0]
            assert abs(mp.mpf(float(got)) / want - 1) < 2e-13, (name, n)


def test_first_coefficients_are_those_of_the_books():
    """A_2 = lambda + lambda^3/4 + 15 lambda^5/128, A_4 = -(lambda^3/4 + 3 lambda^5/16), A_6 = 9 lambda^5/128, A_8 =
    -5 lambda^7/256; D_1 = lambda (1 + lambda^2/8), D_3 = -3 lambda^3/8, each up to its next term.
    """
    lam = 1e-4
    a = closed_form.piston([1, 2, 3, 4, 6, 8], lam)
    assert list(a[[0, 2]]) == [1, 0]
    assert a[1] == pytest.approx(lam + lam**3 / 4 + 15 * lam**5 / 128, rel=1e-14)
    assert a[3:] == pytest.approx([-(lam**3 / 4 + 3 * lam**5 / 16), 9 * lam**5 / 128, -5 * lam**7 / 256], rel=1e-7)
    assert closed_form.rod([1, 3], lam) == pytest.approx([lam + lam**3 / 8, -3 * lam**3 / 8], rel=1e-7)


# ------------------------------------------------------------------ offset
@pytest.mark.parametrize(("lam", "eps"), OFFSETS)
def test_offset_against_the_trapezoidal_rule(lam, eps):
    orders = np.arange(0, 25)
    with mp.workdps(30):
        want = of_revolution(lam, eps, 24, 22)
        found = harmonics.find_harmonics(orders, np.array([lam]), np.array([eps]))
        for name in SERIES:
            first = float(abs(want[name][1]))
            largest = max(float(abs(c)) for c in want[name])
            got = found[name]
            for n in orders:
                error = float(abs(mp.mpmathify(complex(got.c[n, 0])) - want[name][n]))
                assert error <= ABSOLUTE * (first if name == "piston" else largest), (name, n)
                assert error <= float(got.noise[0]), (name, n, "beyond its own bound")


def test_a_variant_is_the_same_among_any_others():
    """To the last bit."""
    lam = np.array([0.1, 0.6, 0.3, 0.3])
    eps = np.array([0.3, 0.35, -0.2, 0.01])
    counts = harmonics.count_samples(lam, eps)
    assert counts.tolist() == [harmonics.count_samples(*pair) for pair in zip(lam, eps, strict=True)]
    assert counts[1] > counts[0] == counts[2]
    found = harmonics.find_harmonics(np.arange(9), lam[None], eps[None])
    for k in range(4):
        single = harmonics.find_harmonics(np.arange(9), lam[k : k + 1], eps[k : k + 1])
        for name in SERIES:
            assert np.array_equal(found[name].c[:, 0, k], single[name].c[:, 0]), name
