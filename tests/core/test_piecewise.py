"""Piecewise curves against closed forms and against mpmath."""

import mpmath as mp
import numpy as np
import pytest

from balcli.core.piecewise import find_zero, find_zeros, merged_breaks, polyline, resolved

RELATIVE = 1e-13
TURN = 2 * np.pi


# ---------------------------------------------------------------- smooth functions
def smooth(angle):
    """Its Fourier coefficients are 2 I_k(1), those of e^{cos x}."""
    return np.exp(np.cos(angle))


def bessel(k):
    return float(mp.besseli(k, 1))


@pytest.mark.parametrize("breaks", [[0, TURN], [-1.0, 0.3, 2.0, TURN - 1.0]])
def test_harmonics_of_a_smooth_function(breaks):
    found = resolved(smooth, breaks).harmonics(np.arange(61))
    assert found[0] == pytest.approx(bessel(0), rel=RELATIVE)
    expected = np.array([2 * bessel(k) for k in range(1, 61)])
    np.testing.assert_allclose(found[1:], expected, rtol=0, atol=1e-14)


def test_harmonics_so_high_that_a_panel_holds_many_waves_of_them():
    """|sin x| has 4/(pi (1 - k^2)) in the even k, and nothing in the odd ones."""
    curve = resolved(lambda x: np.abs(np.sin(x)), [0, np.pi, TURN])
    found = curve.harmonics(np.arange(802))
    k = np.arange(2, 801, 2)
    np.testing.assert_allclose(found[2::2], 4 / (np.pi * (1 - k**2.0)), rtol=0, atol=5e-14)
    assert np.abs(found[1::2]).max() < 5e-14


def test_a_harmonic_alone_is_that_of_the_whole_row():
    """Few harmonics are added up directly, many as products of two waves; blocks of angles add up."""
    curve = polyline([0, 1, 4, TURN], [1, 3, -2, 1])
    row = curve.harmonics(np.arange(4001))
    for wanted in ([0, 1, 2], [3999, 4000], [63]):
        assert curve.harmonics(wanted) == pytest.approx(row[wanted], rel=1e-11, abs=1e-13)


def test_values_mean_and_integral():
    curve = resolved(smooth, [0, 1, TURN])
    angle = np.linspace(-20, 20, 501).reshape(3, 167)
    np.testing.assert_allclose(curve.at(angle), smooth(angle), rtol=1e-13)
    assert curve.period == pytest.approx(TURN)
    assert curve.mean == pytest.approx(bessel(0), rel=RELATIVE)
    assert curve.integral == pytest.approx(TURN * bessel(0), rel=RELATIVE)
    assert curve.at(0.0).shape == ()


def test_the_integral_from_the_first_breakpoint_on():
    done = resolved(lambda x: np.cos(3 * x), [0.5, 2.0, TURN + 0.5]).antiderivative()
    angle = np.linspace(0.5, TURN + 0.49, 200)
    exact = (np.sin(3 * angle) - np.sin(1.5)) / 3
    np.testing.assert_allclose(done.at(angle), exact, rtol=0, atol=3e-14)


@pytest.mark.parametrize("power", [0.5, 1.3, 2.5])
def test_a_branch_point_at_a_breakpoint(power):
    """Panels are halved towards it until nothing is missing."""
    curve = resolved(lambda x: x**power, [0.0, 1.0])
    assert curve.integral == pytest.approx(1 / (power + 1), rel=1e-11)
    angle = np.geomspace(1e-6, 0.999, 60)
    np.testing.assert_allclose(curve.at(angle), angle**power, rtol=0, atol=1e-11)


# ---------------------------------------------------------------- extremes
def test_extremes_are_found_between_the_nodes():
    lowest, highest = resolved(lambda x: np.sin(x) + 0.3 * np.cos(2 * x), [0, TURN]).extremes()
    assert lowest.angle == pytest.approx(3 * np.pi / 2, abs=1e-12)
    assert lowest.value == pytest.approx(-1.3, rel=1e-14)
    assert np.sin(highest.angle) == pytest.approx(1 / 1.2, rel=1e-12)
    assert highest.value == pytest.approx(1 / 1.2 + 0.3 * (1 - 2 / 1.44), rel=1e-14)


def test_an_extreme_that_is_rounding_is_0():
    """1 - cos x touches 0; a hundred times further off, its lowest value is kept."""
    for lift, lowest in ((1e-16, 0.0), (1e-12, pytest.approx(1e-12, rel=1e-3))):
        assert resolved(lambda x, lift=lift: 1 + lift - np.cos(x), [0, TURN]).extremes()[0].value == lowest


def test_a_jump_has_its_extremes_at_both_sides():
    assert polyline([0, 1, 1, 2, 3], [0, 4, -3, 1, 0]).extremes() == ((1.0, -3.0), (1.0, 4.0))


def test_reversals_are_changes_of_sign_jumps_included_and_rounding_errors_not():
    assert resolved(lambda x: np.cos(3 * x), [0, TURN]).reversals() == 6
    assert resolved(lambda x: np.cos(3 * x) + 1.01, [0, TURN]).reversals() == 0
    assert polyline([0, 1, 1, 2], [1, 1, -1, -1]).reversals() == 2
    noise = np.random.default_rng(2)
    flat = resolved(lambda x: np.where(x < np.pi, np.sin(x), 1e-13 * noise.uniform(-1, 1, x.shape)), [0, np.pi, TURN])
    assert flat.reversals() == 0


# ---------------------------------------------------------------- polylines
def test_a_polyline_is_exact():
    curve = polyline([0, 1, 1, 3, 4], [0, 2, 5, 1, 0])
    assert curve.integral == 1 + 6 + 0.5
    assert [float(curve.at(a)) for a in (0.5, 1, 2, 3.5, 4)] == [1, 5, 3, 0.5, 0]
    assert [float(curve.at(a + 8)) for a in (0.5, 1, 2)] == pytest.approx([1, 5, 3])
    done = curve.antiderivative()
    assert [float(done.at(a)) for a in (0.5, 1, 2)] == pytest.approx([0.25, 1, 5], rel=1e-15)
    assert done.extremes()[1].value == pytest.approx(7.5, rel=1e-15)


@pytest.mark.parametrize(("count", "noise"), [(10, 1e-14), (5002, 1e-12)])
def test_harmonics_of_a_triangle_wave(count, noise):
    """Thousands of waves within a panel: the polynomial of a power of e^1000 of them would be no number."""
    found = polyline([0, np.pi, TURN], [1, -1, 1]).harmonics(np.arange(count))
    expected = [8 / (np.pi * k) ** 2 if k % 2 else 0 for k in range(count)]
    np.testing.assert_allclose(found, expected, rtol=0, atol=noise)


# ---------------------------------------------------------------- breakpoints
@pytest.mark.parametrize("turns", [-3, 0, 1, 7])
def test_a_breakpoint_is_itself_however_many_turns_off_and_however_rounded(turns):
    breaks = np.radians([-180.0, 0.0, 140.0, 360.0, 540.0])
    curve = polyline(np.repeat(breaks, 2)[1:-1], [1, 1, 2, 2, 3, 3, 4, 4])
    angle = np.radians(np.array([-180.0, 0.0, 140.0, 360.0]) + 720 * turns)
    assert curve.at(angle).tolist() == [1, 2, 3, 4]


def test_breakpoints_of_a_sum():
    a = np.array([-1.0, 0.0, 2.0, 3.0])
    b = np.array([0.0, 1.0, 4.0])
    assert merged_breaks([(a, 0.0)], 4.0).tolist() == [0, 2, 3, 4]
    assert merged_breaks([(a, 0.5), (b, 1e-13), (b, 3.0)], 4.0) == pytest.approx([0, 0.5, 1, 2.5, 3, 3.5, 4])


def test_nothing_but_rounding_errors_has_an_end():
    """Twenty-four cylinders without gas: halving panels for ever filled the memory."""
    random = np.random.default_rng(1)
    asked = []

    def noise(angle):
        asked.append(angle.size)
        assert sum(asked) < 1 << 20
        return random.uniform(-1e-13, 1e-13, angle.shape)

    curve = resolved(noise, [0.0, 1.0])
    assert np.abs(curve.at(np.linspace(0, 1, 99))).max() < 1e-12


# ---------------------------------------------------------------- several functions on the same panels
def draw_peaks(angle, width=None):
    """Peaks at 2 rad, one for each width, of sizes that differ by a hundred."""
    widths = np.array([0.3, 1.0, 2.0])
    each = np.array([1.0, 100.0, 10.0]) * np.exp(-(((np.asarray(angle)[..., None] - 2) / widths) ** 2)) - 0.5
    return each if width is None else each[..., width]


def test_a_curve_with_a_figure_is_each_of_its_functions():
    breaks = [0, 1, TURN]
    joint = resolved(draw_peaks, breaks, each=True)
    angle = np.linspace(-3, 9, 60).reshape(4, 15)
    orders = [0, 1, 2, 40]
    lowest, highest = joint.find_range()
    for k in range(3):
        alone = resolved(lambda x, k=k: draw_peaks(x, k), breaks)
        close = {"rel": 1e-12, "abs": 1e-13 * highest[k]}
        assert joint.at(angle)[..., k] == pytest.approx(alone.at(angle), **close)
        assert joint.integrals[k] == pytest.approx(alone.integral, **close)
        assert joint.means[k] == pytest.approx(alone.mean, **close)
        assert joint.harmonics(orders)[:, k] == pytest.approx(alone.harmonics(orders), **close)
        assert [lowest[k], highest[k]] == pytest.approx([extreme.value for extreme in alone.extremes()], **close)
        done = joint.antiderivative(0.25).within(angle)[..., k]
        assert done == pytest.approx(alone.antiderivative(0.25).within(angle), **close)


def test_each_member_of_a_figure_is_resolved_to_its_own_size():
    """Compared with the largest of all, the small one is resolved badly on few panels."""

    def draw(angle):
        return np.stack([np.full(angle.shape, 1e9), np.exp(-((angle / 0.05) ** 2))], axis=-1)

    exact = 0.05 * np.sqrt(np.pi)
    both = [resolved(draw, [-3.0, 0.1, 3.0], each=each).integrals[1] for each in (False, True)]
    assert both[1] == pytest.approx(exact, rel=1e-13)
    assert both[0] != pytest.approx(exact, rel=1e-11)


def test_zeros_of_several_functions():
    """A line, a power, one that is 0 at 0, one whose zero is far beyond the guess, and a jump."""
    wanted = np.array([3.0, 8.0, 0.0, 1e6, 5.0])

    def exceed(number):
        jump = np.where(number[4] < 2.0, -1.0, np.inf)
        return np.array([*(number[:4] ** np.array([1, 3, 1, 1.5]) - wanted[:4]), jump])

    found = find_zeros(exceed, np.ones(5), np.array([-3.0, -8.0, 0.0, -1e6, -1.0]))
    assert found == pytest.approx([3.0, 2.0, 0.0, 1e4, 2.0], rel=1e-12)
    assert find_zero(lambda x: x**3 - 8, 1.0, -8.0) == pytest.approx(2.0, rel=1e-13)
