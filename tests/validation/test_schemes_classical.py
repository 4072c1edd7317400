"""The schemes of every textbook, for engines whose answer can be written down (and as hardware that was built)."""

import cmath
import math

import numpy as np
import pytest
from support.cases import cases
from support.engines import build_text, engine_text
from support.remedies import figures, fit_scheme, size_scheme

from balcli.analysis.answer import analyze
from balcli.core.mechanisms import closed_form
from balcli.engine.engine import Engine
from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.remedy import fit_devices
from balcli.sizing.sizing import size

M = 1.0
R = 0.05
LAM = 0.25
A2 = float(closed_form.piston([2], LAM)[0])


def engine(throws: list[float], spacing: float = 100, throw_mass: float = 1, more: str = "", **tables: str) -> Engine:
    crank = f"stroke = 100\nthrows = {throws}\nspacing = {spacing}\nthrow_mass = {throw_mass}"
    return build_text(engine_text(crank=crank, **tables) + more)


INLINE_4 = engine([0, 180, 180, 0])
INLINE_3 = engine([0, 240, 120])
CROSS_V8 = engine([0, 90, 270, 180], layout="bank_angle = 90")
SPLIT_V6 = build_text(
    engine_text(crank="stroke = 100\nthrows = [0, 240, 120]\nspacing = 100\nsplay = -60", layout="bank_angle = 60")
)


def left(e: Engine, orders=(1, 2), quantities=("force", "moment", "roll")):
    return compute_spectra(e, list(orders), quantities)


def sizes(tables) -> list[float]:
    return [t.unbalance / 1e6 for t in tables]


# ------------------------------------------------------------------ counterweights
def test_v_twin_at_90_degrees_needs_a_counterweight_alone():
    """Half of both pistons: one reciprocating mass opposite the pin, with the rotating mass."""
    e = engine([0], layout="bank_angle = 90")
    weights = size(e).counterweights
    assert sum(sizes(weights)) == pytest.approx((M + 1) * R, rel=1e-14)
    assert {weight.angle for weight in weights} == {180}
    assert left(fit_scheme(e), [1]).force.balanced.all()


def test_cross_plane_v8_needs_counterweights_alone():
    """Each throw acts like a rotating mass m_rec + m_rot (Cadillac 1923); end weights take the
    couple of `sqrt 10` throw distances.
    """
    assert not size(CROSS_V8).shafts
    remedy = size(CROSS_V8, "counterweights")
    assert sizes(remedy.counterweights) == pytest.approx([math.sqrt(10) / 3 * (M + 1) * R] * 2, rel=1e-14)
    after = left(fit_devices(CROSS_V8, remedy))
    assert after.force.balanced.all()
    assert after.moment.balanced.all()


@pytest.mark.parametrize("cylinders", [3, 5, 7, 9])
def test_radial_engines_need_a_counterweight_alone(cylinders):
    """R = (m_a/2 + m_b) i r omega^2 (Kvasnikov)."""
    e = engine([0], layout=f"radial = {cylinders}")
    weights = size(e, "counterweights").counterweights
    assert sum(sizes(weights)) == pytest.approx((cylinders * M / 2 + 1) * R, rel=1e-13)
    assert left(fit_scheme(e, "counterweights"), [1]).force.balanced.all()


@pytest.mark.parametrize("planes", ["ends", "throws", (-0.22, 0.19), (-0.3, -0.1, 0.2)])
def test_counterweights_in_any_planes(planes):
    after = left(fit_scheme(INLINE_3, "counterweights", planes=planes), [1])
    assert (after.force.forward[0], after.moment.forward[0]) == (0, 0)
    assert abs(after.moment.backward[0]) == pytest.approx(abs(left(INLINE_3, [1]).moment.backward[0]), rel=1e-14)


def test_a_single_plane_does_what_it_can():
    e = engine([0], layout="bank_angle = 60\nstagger = 20")
    remedy = size_scheme(e, "counterweights", planes=(0.0,))
    assert figures(remedy)["force with crank left"] == 0
    assert figures(remedy)["moment with crank left"] == pytest.approx(abs(left(e, [1]).moment.forward[0]), rel=1e-14)


# ------------------------------------------------------------------ factor and bobweight
def test_factor_leaves_what_it_does_not_take():
    """Half balance leaves half, turning against the crank, and exactly nothing with it (Wang, (36))."""
    for share in (0, 0.4, 0.5, 0.66, 1):
        e = engine([0])
        after = left(fit_scheme(e, "factor", factor=(share,)), [1]).force
        unit = M * R * e.omega**2
        assert after.forward[0].real == pytest.approx((0.5 - share) * unit, rel=0, abs=1e-13 * unit * (share != 0.5))
        assert after.backward[0] == pytest.approx(unit / 2, rel=1e-14)


def test_bobweight_cards_of_a_cross_plane_v8_are_of_pairs_and_take_its_moment():
    assert [entry.cylinders for entry in size(CROSS_V8, "factor").card] == [(1, 5), (2, 6), (3, 7), (4, 8)]
    assert left(fit_scheme(CROSS_V8, "factor"), [1]).moment.balanced.all()


def test_split_pins_have_a_card_each():
    e = engine([0, 240, 120], layout="bank_angle = 60")
    assert [len(entry.cylinders) for entry in size(e, "factor").card] == [2, 2, 2]
    assert [len(entry.cylinders) for entry in size(SPLIT_V6, "factor").card] == [1] * 6


def test_factor_sweep_trades_along_for_across():
    """One cylinder, order 1 alone as lambda -> 0: peak along falls by K, across rises by K, both in
    units of m r omega^2.
    """
    e = build_text(engine_text(rod="ratio = 1e-7"))
    remedy = size_scheme(e, "factor", factor=(0.0, 0.25, 0.5, 0.75, 1.0))
    unit = M * R * e.omega**2
    for row in remedy.sweep:
        share = row.factor
        assert row.along_N == pytest.approx((1 - share) * unit, abs=1e-6 * unit)
        assert row.across_N == pytest.approx(share * unit, abs=1e-6 * unit)
        assert row.peak_force_N == pytest.approx(max(share, 1 - share) * unit, abs=1e-6 * unit)
    assert figures(remedy)["factor"] == 0.5


# ------------------------------------------------------------------ shafts
def test_lanchester_shafts_of_an_inline_four():
    """Lanchester 1912: two shafts at twice crank speed, each A2 m r / 2 (of `4 A2 m r omega^2 = 2 U (2 omega)^2`)."""
    for remedy in (size(INLINE_4), size(INLINE_4, "two-shaft")):
        assert sorted(s.ratio for s in remedy.shafts) == [-2, 2]
        assert sizes(remedy.shafts) == pytest.approx([A2 * M * R / 2] * 2, rel=1e-14)
        assert {s.angle for s in remedy.shafts} == {180.0}


def test_shafts_at_different_heights_take_the_roll():
    """Nakamura 1974 (Mitsubishi): the height between the shafts that makes the second-order roll
    vanish, and what is left at others.

    Inertia torque of order 2 of one cylinder: `1/2 m r^2 K_2 2 sin 2 theta` with K_2 the
    coefficient of (s'/r)^2; four of them.
    """
    inertia_torque = 4 * M * R**2 * abs(float(closed_form.find_harmonics([2], LAM)["kinetic"].c[0]))  # per omega^2
    height = inertia_torque / (4 * A2 * M * R / 2)  # force of one shaft
    remedy = size_scheme(INLINE_4, "two-shaft", roll="zero")
    place = {s.ratio: complex(*s.at) / 1e3 for s in remedy.shafts}
    assert place[2] - place[-2] == pytest.approx(height, rel=1e-13)
    after = left(fit_devices(INLINE_4, remedy), [2])
    assert abs(after.roll.forward[0]) <= 1e-14 * inertia_torque * INLINE_4.omega**2
    assert after.force.balanced.all()
    halfway = size_scheme(INLINE_4, "two-shaft", at=(-height / 4 + 0.03j, height / 4 - 0.03j))
    assert figures(halfway, "order 2")["roll left"] == pytest.approx(inertia_torque * INLINE_4.omega**2 / 2, rel=1e-12)


def test_roll_vanishes_with_the_first_shaft_given_and_the_reference_elsewhere():
    e = engine([0, 180, 180, 0], more="[frame]\nreference = [30, -20, 0]\n")
    remedy = size_scheme(e, "two-shaft", at=(-0.04 + 0.06j,), roll="zero")
    assert remedy.shafts[0].at == (-40.0, 60.0)
    rolls = [abs(left(x, [2]).roll.forward[0]) for x in (e, fit_devices(e, remedy))]
    assert rolls[1] <= 1e-13 * rolls[0]


def test_inline_three_needs_couples():
    """Order 1 backward couple `sqrt3/2 m r a omega^2`: two opposite eccentrics 2a apart (a the throw spacing)."""
    remedy = size(INLINE_3, "complete")
    at = {ratio: [s for s in remedy.shafts if s.ratio == ratio] for ratio in (-1, 2, -2)}
    assert sizes(at[-1]) == pytest.approx([math.sqrt(3) / 4 * M * R] * 2, rel=1e-13)
    assert sizes(at[2]) == pytest.approx([math.sqrt(3) / 4 * A2 * M * R / 4] * 2, rel=1e-13)
    a, b = (cmath.rect(s.unbalance, math.radians(s.angle)) for s in at[-1])
    assert abs(a + b) <= 1e-14 * abs(a)
    after = left(fit_devices(INLINE_3, remedy))
    assert after.force.balanced.all()
    assert after.moment.balanced.all()
    shafts = fit_scheme(INLINE_3, "couple-shaft")
    assert left(shafts, [1]).moment.balanced.all()


def test_even_firing_v6_at_60_degrees_has_a_backward_second_order_couple_alone():
    assert {s.ratio for s in size(SPLIT_V6).shafts} <= {-2}


def test_single_shaft_on_an_inline_four_says_what_stays():
    remedy = size(INLINE_4, "single-shaft")
    assert remedy.order == 2
    assert figures(remedy)["force with crank left"] == pytest.approx(2 * A2 * M * R * INLINE_4.omega**2, rel=1e-14)


def test_inline_six_needs_nothing():
    e = engine([0, 240, 120, 120, 240, 0])
    assert not size(e, "complete").devices
    assert not size(e, "counterweights").devices
    assert size(e, "counterweights").note.startswith("Order 1 is balanced already: counterweights change no free")
    assert size(e).steps == ("counterweights at every throw",)


def test_eccentric_stands_where_the_force_acts():
    """A twin whose second-order force acts off the middle of the throws: one eccentric there takes the moment too."""
    e = engine([0, 180], more="[cylinder.2]\npiston_mass = 3\n")
    at = {s.ratio: s for s in size(e, "complete").shafts if abs(s.ratio) == 2}
    assert at[2].position == at[-2].position == pytest.approx((3 * 50 - 50) / 4, rel=1e-14)
    after = left(fit_scheme(e, "complete"))
    assert after.force.balanced.all()
    assert after.moment.balanced.all()


# ------------------------------------------------------------------ refusals
@cases("sizing/schemes", "infeasible_options")
def test_infeasible_options_are_told_why(scheme, options, reason):
    with pytest.raises(BalcliError, match=reason):
        size_scheme(INLINE_3, scheme, **options)


def test_sizing_is_for_steady_speed():
    ripple = "[operation]\nspeed_ripple = [{ order = 2, amplitude = 0.02 }]\n"
    uneven = engine([0, 180, 180, 0], more=ripple)
    assert size(uneven).shafts == size(INLINE_4).shafts
    assert np.any(analyze(fit_scheme(uneven), [1, 2, 4], ["force"]).spectra.force.major > 0)
