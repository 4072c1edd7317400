"""The smallest peak: reached where it is said, with a known error; and a wanted ellipse."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support.engines import build_text
from support.remedies import SMALL, figures, find_orders, fit_scheme, size_scheme, weigh

from balcli.core.peaks import find_peak
from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.remedy import fit_devices
from balcli.sizing.sizing import size


@pytest.mark.parametrize("more", ["", weigh(30000, 170)])
def test_minimax_reaches_what_it_says_where_it_says(more):
    """The peak, the crank angles at which it is reached, and the gain over half the reciprocating
    mass, by the analysis.
    """
    engine = build_text(SMALL["one"] + more)
    remedy = size(engine, "minimax")
    told = figures(remedy)
    curve = find_orders(fit_devices(engine, remedy))
    assert find_peak(curve).value == pytest.approx(told["peak force"], rel=1e-10)  # devices have twelve digits
    assert 0 <= told["relative error bound"] < 1e-14
    assert len(told["reached"]) == 3
    assert all(0 <= degree < 360 for degree in told["reached"])
    assert np.abs(curve.values(np.radians(told["reached"]))) == pytest.approx(told["peak force"], rel=1e-9)
    plain = build_text(SMALL["one"])
    half = find_peak(find_orders(fit_scheme(plain, "factor"))).value
    assert told["factor half peak"] == pytest.approx(half, rel=1e-12)  # without the engine's own weights
    assert told["improvement"] == pytest.approx(1 - told["peak force"] / half, rel=1e-12)


def test_minimax_with_nothing_to_fit_says_so_and_fits_no_rounding():
    """An in-line four in two planes: neither a force nor a moment turns with the crank."""
    remedy = size_scheme(build_text(SMALL["four"]), "minimax", planes="ends")
    assert remedy.devices == ()
    assert remedy.note.startswith("no counterweight makes the largest force smaller: ")
    assert (figures(remedy)["improvement"], figures(remedy)["relative error bound"]) == (0, 0)


def test_minimax_in_several_planes_takes_the_moment_too():
    engine = build_text(SMALL["vee"])
    one, several = (size_scheme(engine, "minimax", planes=planes) for planes in (None, (-0.1, 0.17)))
    assert sum(cmath.rect(d.unbalance, math.radians(d.angle)) for d in several.devices) == pytest.approx(
        cmath.rect(one.devices[0].unbalance, math.radians(one.devices[0].angle)), rel=1e-10
    )
    after = compute_spectra(fit_devices(engine, several), [1], ("moment",)).moment
    assert abs(after.forward[0]) <= 1e-13 * abs(after.backward[0])
    with pytest.raises(BalcliError, match="planes: one plane, or planes at the same z, cannot take a moment; choose"):
        size_scheme(engine, "minimax", planes=(0.1,))


@given(st.floats(-180, 180), st.floats(0, 1), st.sampled_from(["one", "two", "vee"]))
def test_an_ellipse_lies_as_wanted(direction, ratio, name):
    """The tip of the force over a turn, sampled: its farthest and nearest places, and no weight that
    keeps direction and ratio leaves a smaller force: the part against the crank is that of before.
    """
    engine = build_text(SMALL[name])
    remedy = size_scheme(engine, "ellipse", direction=direction, ratio=ratio)
    force = compute_spectra(fit_devices(engine, remedy), [1], ("force",)).force
    tip = force.values(np.linspace(0, 2 * np.pi, 7201))
    assert np.abs(tip).max() == pytest.approx(remedy.details["order_1_largest_N"], rel=1e-6)
    assert np.abs(tip).min() == pytest.approx(remedy.details["order_1_smallest_N"], abs=2e-3 * np.abs(tip).max())
    if ratio < 0.9:
        farthest = tip[np.abs(tip).argmax()] * np.exp(-1j * np.radians(direction))
        assert abs(farthest.imag) <= 0.05 * abs(farthest)
    before = compute_spectra(engine, [1], ("force",)).force
    assert abs(force.backward[0]) == pytest.approx(abs(before.backward[0]), rel=1e-12)
    assert abs(force.forward[0]) <= abs(force.backward[0]) * (1 + 1e-10)


def test_an_ellipse_needs_a_force_against_the_crank():
    remedy = size_scheme(build_text(SMALL["four"]), "ellipse", direction=0.0, ratio=0.5)
    assert remedy.note.startswith("no force of order 1 turns against the crank")
