"""Numerical extremes of the mechanisms and of what engines make of them, against mpmath and the momentum of every part.

Each test holds a bound of `BOUNDS`, as `docs/accuracy.md` prints them.
"""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, strategies as st
from support.engines import engine

from balcli.analysis.answer import QUANTITIES, analyze
from balcli.core.mechanisms import closed_form, harmonics
from balcli.core.mechanisms.closed_form import SERIES
from balcli.core.phasors import EPS
from balcli.engine.engine import Engine
from balcli.errors import InputError
from balcli.forces.spectrum import Spectra, compute_spectra, find_relevant_orders

pytestmark = pytest.mark.stress

BOUNDS = {  # by row of docs/accuracy.md; roundings, or relative errors
    "closed forms": 1e-14,  # to order 32; n/32 times as much beyond
    "offset pistons": 16,
    "articulated rods": 16,
    "throws 1e-9° off": 24,
    "whole turns": 0,
    "planes 1e-9 mm apart": 1e-12,
    "scale": 16,
    "many cylinders": 8,
    "order of cylinders in the file": 8,
}
LAMBDAS = [1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.28, 0.5, 0.75, 0.9, 0.99, 1 - 1e-5, 1 - 1e-6]
HIGH = [255, 256, 4095, 4096]
SMALLEST = 1e-290  # below which a float has not all its digits
REVOLVING = 0.05 * (2 * np.pi) ** 2  # m r omega^2 of `kit.engine`: 1 kg, 50 mm, 60 rpm


@pytest.fixture(autouse=True, scope="module")
def _digits():
    with mp.workdps(50):
        yield


# ------------------------------------------------------------------ centred mechanisms
def exact(name: str, n: int, lam: float) -> mp.mpf:
    """A_n, D_n, K_n, B_n by Gauss's functions (docs/theory.md), with 50 digits: D as the book's
    sum, which cancels, and no ladder.
    """
    ratio = mp.mpf(lam)
    w = mp.sqrt(1 - ratio**2)
    q = (ratio / (1 + w)) ** 2

    def binomial(power: mp.mpf, m: int) -> mp.mpf:
        return mp.binomial(power, m) * q**m * mp.hyp2f1(-power, m - power, m + 1, q**2)

    def over_order(m: int) -> mp.mpf:
        return m * (1 + w) * binomial(mp.mpf("0.5"), m // 2) / ratio

    square = (2 * w / (1 + w) ** 2 * (-1) ** (n // 2 - 1) * q ** (n // 2 - 1)) if n else 1 / (1 + w)
    below, above = (binomial(mp.mpf("-0.5"), (n - 1) // 2 + k) for k in (0, 1))
    return {
        "piston": lambda: n * over_order(n) if n % 2 == 0 else mp.mpf(n == 1),
        "rod": lambda: n * ratio * 2 / (1 + w) * (below + above) if n % 2 else mp.mpf(0),
        "kinetic": lambda: over_order(n + 1) - over_order(n - 1) if n % 2 else square - (n == 2),
        "rod_kinetic": lambda: ratio**2 * square if n % 2 == 0 else mp.mpf(0),
    }[name]()


def error(name: str, orders: list[int], lam: float) -> float:
    """Largest relative error, by n/32 beyond order 32; what has to vanish must be 0."""
    c = closed_form.find_harmonics(orders, lam)[name].c
    worst = 0.0
    got = -c.imag if name == "rod" else c
    for n, value in zip(orders, got, strict=True):
        want = exact(name, n, lam)
        if want == 0:
            assert value == 0, (name, n)
        elif abs(want) > SMALLEST:
            worst = max(worst, float(abs((mp.mpf(float(value)) - want) / want)) / max(1, n / 32))
    return worst


@pytest.mark.parametrize("lam", LAMBDAS)
@pytest.mark.parametrize("name", ["piston", "rod", "kinetic", "rod_kinetic"])
def test_closed_forms_are_good_to_their_last_digits(name, lam):
    orders = [1, 2, 3, 4, 5, 8, 17, 30, 63, 64, *HIGH]
    assert error(name, sorted(orders), lam) < BOUNDS["closed forms"]


@given(st.floats(-12, -0.3), st.sampled_from(["lambda", "rest"]), st.integers(2, 64))
def test_closed_forms_at_any_lambda(exponent, which, n):
    """lambda = 10^-x, or 1 - 10^-x down to 1 - 1e-6."""
    lam = 10**exponent if which == "lambda" else 1 - 10 ** (exponent / 2)
    assert error("piston" if n % 2 == 0 else "rod", [n], lam) < BOUNDS["closed forms"]


# ------------------------------------------------------------------ offset and articulated mechanisms
def revolution(motion, count: int, orders: list[int]) -> list[list[mp.mpc]]:
    """Coefficients of `Re c_n e^{i n psi}` of each curve, from as many samples as the product takes."""
    turn = [mp.expjpi(mp.mpf(2 * k) / count) for k in range(count)]
    curves = list(zip(*(motion(e) for e in turn), strict=True))
    return [
        [(1 if n == 0 else 2) * mp.fsum(v * turn[-n * k % count] for k, v in enumerate(values)) / count for n in orders]
        for values in curves
    ]


def share_of_bound(series: closed_form.Series, row: int, want: list[mp.mpc]) -> float:
    """Largest error as a share of the bound that the product states, which is 16 roundings."""
    assert harmonics.SAMPLING == BOUNDS["offset pistons"] * EPS == BOUNDS["articulated rods"] * EPS
    errors = [float(abs(mp.mpmathify(complex(got)) - exact)) for got, exact in zip(series.c[:, row], want, strict=True)]
    return max(errors) / float(np.ravel(series.noise)[row])


NEAR_LOCK = [
    (0.28, 0.01),
    (0.7, 0.29),
    (0.3, 0.69),
    (0.3, -0.699),
    (1e-3, 0.998),
    (1e-6, 1 - 3e-6),
    (1e-9, 1 - 1e-6 - 1e-9),
    (1e-12, 0.5),
    (1e-3, 1 - 1e-3 - 1e-6),
    (0.05, 0.9499),
]


@pytest.mark.parametrize(("lam", "eps"), NEAR_LOCK)
def test_offset_mechanisms_keep_the_bound_they_state(lam, eps):
    """lambda + |eps| to 1 - 1e-6: 16 roundings of the root mean square of the curve, of which half is never reached."""

    def motion(e):
        sine = ratio * e.imag - offset
        cosine = mp.sqrt(1 - sine**2)
        rate = ratio * e.real / cosine
        tangent = sine / cosine
        return (
            e.real - e.imag * tangent + ratio * e.real**2 / cosine**3,
            ratio * e.imag / cosine - rate**2 * tangent,
            (e.imag + e.real * tangent) ** 2,
            rate**2,
        )

    ratio = mp.mpf(lam)
    offset = mp.mpf(eps)
    count = harmonics.count_samples(lam, eps)
    orders = [n for n in (0, 1, 2, 3, 7, 24) if n < count // 4]
    with mp.workdps(30):
        want = revolution(motion, count, orders)
    found = harmonics.find_harmonics(orders, np.array([lam]), np.array([eps]))
    for name, values in zip(("piston", "rod", "kinetic", "rod_kinetic"), want, strict=True):
        assert share_of_bound(found[name], 0, values) < 0.6, name


def test_near_its_lock_an_offset_engine_without_a_resultant_is_exactly_balanced():
    """Three throws at 120 degrees: only orders 3, 6, 9 .. are left, exactly, at lambda + eps = 1 - 1.1e-6."""
    found = three(rod={"ratio": 0.3}, piston={"mass": 1, "offset": 50 / 0.3 * (1 - 1.1e-6 - 0.3)})
    assert list(found.orders[~found.force.balanced]) == list(range(3, 65, 3))


# mm, farthest that the knuckle pin of `vee` comes beside the second cylinder's axis
DEAD = 42.869366513132036


def vee(short: float, master: int = 1) -> Engine:
    """A V twin whose articulated rod comes this close to dead lock: its angle's sine reaches 1 -
    short, or short - 1 where the second cylinder has the master rod.
    """
    rod = {"length": DEAD / (1 - short), "mass": 0.8, "cg": 40}
    return engine(
        rod={"length": 180, "mass": 1, "cg": 50},
        layout={"banks": [-22.5, 22.5]},
        articulation={"master": master, "knuckle_radius": 40, "rod": rod},
    )


@pytest.mark.parametrize(("short", "master"), [(0.5, 1), (1e-2, 1), (1e-2, 2), (1e-3, 1)])
def test_articulated_rods_near_dead_lock_keep_the_bound_they_state(short, master):
    """16 roundings of the root mean square of the curve, and of its mean by 1/(1 - |sin|) of the rod's angle."""
    c = vee(short, master).cylinders
    row = 1 - int(c.linkage.master[0])
    ratio, chief = (mp.mpf(float(np.broadcast_to(c.lam, 2)[k])) for k in (row, 1 - row))
    pin = mp.mpmathify(complex(c.linkage.knuckle[row]))
    lead = mp.expjpi(mp.mpf(float(c.linkage.lead_deg[row])) / 180)

    def motion(e):
        master = e * lead
        sine = chief * master.imag
        cosine = mp.sqrt(1 - sine**2)
        rate = chief * master.real / cosine
        bend = -sine / cosine + rate**2 * sine / cosine
        arm = mp.conj(lead) * pin * (cosine - 1j * sine)
        k = e + arm
        k1 = 1j * (e - rate * arm)
        k2 = -e - (rate**2 + 1j * bend) * arm
        s = ratio * k.imag
        cos = mp.sqrt(1 - s**2)
        spin = ratio * k1.imag / cos
        return -(k2.real - s / cos * k2.imag - spin * k1.imag / cos**2), -(ratio * k2.imag / cos + spin**2 * s / cos)

    orders = [0, 1, 2, 3, 7]
    with mp.workdps(30):
        want = revolution(motion, 2 * c.linkage.find_highest_order(c.lam, c.eps), orders)
    few, which = c.linkage.find_distinct_harmonics(orders, c.lam, c.eps, SERIES)
    found = closed_form.select_cylinders(few, which)
    assert share_of_bound(found["piston"], row, want[0]) < 0.5
    assert share_of_bound(found["rod"], row, want[1]) < 0.5


def test_an_articulated_rod_nearer_to_dead_lock_is_refused_with_the_number():
    assert len(find_relevant_orders(vee(2e-6))) == 1 << 14
    with pytest.raises(InputError, match=r"is 0\.9999995\d* rod lengths off .*at most 1 - 1e-06 is allowed"):
        vee(5e-7)


@pytest.mark.parametrize(
    ("ratio", "offset", "number"),
    [(1 - 9e-7, 0.0, "0.9999991"), (0.3, 50 / 0.3 * (0.7 - 9e-7), "0.9999991"), (0.3, -50 / 0.3 * 0.7, "1")],
)
def test_nearer_to_the_lock_is_an_error_with_the_number(ratio, offset, number):
    with pytest.raises(InputError, match=rf"the crank cannot turn: .* {number}; at most 1 - 1e-06 is allowed"):
        engine(rod={"ratio": ratio}, piston={"mass": 1, "offset": offset})


# ------------------------------------------------------------------ angles
def three(**parts) -> Spectra:
    """Throws at 0, 120, 240 degrees."""
    crank = {"stroke": 100, "throws": [0, 120, 240], "spacing": 100} | parts.pop("crank", {})
    return compute_spectra(engine(crank=crank, **parts), np.arange(1.0, 65.0))


@pytest.mark.parametrize("off", [1e-9, -1e-9, 1e-7, 1e-3])
def test_throws_that_almost_cancel(off):
    """x off in one throw: a force of x in order 1 and 2 A_2 x in order 2, as the file's rounding to
    1.4e-14 degrees lets it be.
    """
    found = three(crank={"throws": [0, 120 + off, 240]})
    true = np.radians((120 + off) - 120)  # exact, of the number that is in the file
    a = closed_form.piston([1, 2, 4], 0.25)
    for n, share in zip((1, 2, 4), a, strict=True):
        want = REVOLVING * abs(share) * 2 * abs(np.sin(n * true / 2))
        assert abs(found.force.major[n - 1] - want) <= BOUNDS["throws 1e-9° off"] * EPS * REVOLVING * abs(share)


@pytest.mark.parametrize(
    "throws", [[0, 120, 240], [0, -240, 240.0], [0, 120 + 360e6, 240 - 360e6], [360e6, -360e6 - 240, 600]]
)
@pytest.mark.parametrize("layout", [{}, {"bank_angle": 72}, {"bank_angle": 72 + 720e6}, {"banks": [36, 36 - 360e6]}])
def test_whole_turns_and_thirds_cancel_exactly(throws, layout):
    """A million full turns more or less: forces of the orders 3, 6, 9 .. alone, and these as without the turns."""
    found = three(crank={"throws": throws}, layout=layout)
    left = found.orders % 3 == 0
    assert found.force.balanced[~left].all()
    even = found.orders[left] % 2 == 0
    assert not found.force.balanced[left][even & (found.orders[left] < 24)].any()


@pytest.mark.parametrize("count", [5, 10])
def test_banks_and_throws_of_72_degrees_cancel_exactly(count):
    """Five throws at 72 degrees, and two banks of them: orders 5, 10 .. alone."""
    layout = {"bank_angle": 72} if count == 10 else {}
    found = compute_spectra(
        engine(crank={"stroke": 100, "throws": [0, 144, 216, 288, 72], "spacing": 90}, layout=layout),
        np.arange(1.0, 257.0),
    )
    assert found.force.balanced[found.orders % 5 != 0].all()
    assert not found.force.balanced[9]


@pytest.mark.parametrize("apart", [1e-9, 1e-6, 1.0])
def test_planes_that_almost_coincide(apart):
    """Two opposed pistons `apart` mm: a couple of m r omega^2 times that, to 1e-12 of it (positions
    are sums of halves).
    """
    found = compute_spectra(engine(crank={"stroke": 100, "throws": [0, 180], "positions": [0, apart]}), [1, 2])
    assert found.force.balanced[0]
    assert found.moment.major[0] == pytest.approx(REVOLVING * apart / 1e3, rel=BOUNDS["planes 1e-9 mm apart"])


# ------------------------------------------------------------------ sizes
@pytest.mark.parametrize("stroke", [1e-3, 1.0, 1e6])
@pytest.mark.parametrize("mass", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("speed", [1e-3, 1e3, 1e6])
def test_scale(stroke, mass, speed):
    """Forces go with m r omega^2, moments with the length too: bores of a um to a km, to 16 roundings."""

    def found(stroke, mass, speed):
        crank = {"stroke": stroke, "throws": [0, 90], "spacing": stroke, "throw_mass": mass / 2}
        piston = {"mass": mass, "bore": stroke}
        whole = engine(crank=crank, rod={"ratio": 0.3}, piston=piston, operation={"speed": speed})
        return analyze(whole, only=QUANTITIES)

    one = found(100, 1, 60)
    other = found(stroke, mass, speed)
    size = mass * stroke / 100 * (speed / 60) ** 2
    for q, by in (("force", size), ("moment", size * stroke / 100), ("torque", size * stroke / 100)):
        p = getattr(one.spectra, q)
        o = getattr(other.spectra, q)
        assert np.array_equal(p.balanced, o.balanced)
        assert np.abs(o.forward / by - p.forward).max() <= BOUNDS["scale"] * EPS * p.major.max()
    assert other.peak.force.value == pytest.approx(one.peak.force.value * size, rel=1e-14)
    assert other.sizing.after.peak.force.value <= other.peak.force.value


def test_a_microgram_beside_a_million_tonnes():
    """1e-9 and 1e9 kg: the small piston is below the rounding of the sum, but not of its own figures."""
    both = engine(
        crank={"stroke": 100, "throws": [0, 90]}, cylinder={"1": {"piston_mass": 1e-9}, "2": {"piston_mass": 1e9}}
    )
    found = compute_spectra(both, [1, 2, 4])
    a = closed_form.piston([1, 2, 4], 0.25)
    assert found.force.major == pytest.approx(1e9 * REVOLVING * np.abs(a), rel=1e-14)
    own = {c.cylinder: c.spectra for c in analyze(both, [1, 2, 4], by="cylinder", only=["force"]).cylinders}
    assert own[1].force.major == pytest.approx(1e-9 * REVOLVING * np.abs(a), rel=1e-14)


@pytest.mark.parametrize("count", [1, 2, 64, 512])
def test_many_cylinders(count):
    """n throws spread evenly: order n is n times that of one cylinder, all below vanish exactly; to
    8 n roundings.
    """
    throws = [360 * k / count for k in range(count)]
    found = compute_spectra(
        engine(crank={"stroke": 100, "throws": throws}, rod={"ratio": 0.999}), np.arange(1.0, 513.0)
    )
    left = found.orders % count == 0
    assert found.force.balanced[~left].all()
    want = REVOLVING * np.abs(closed_form.piston(found.orders[left], 0.999)) * count
    assert np.all(np.abs(found.force.major[left] - want) <= BOUNDS["many cylinders"] * count * EPS * want)
