"""Studies over the balance factor and the bank angle: what books say of them, and their pictures."""

import re
from functools import cache

import numpy as np
import pytest
from support.engines import GOOD, build_text, changed
from support.pictures import draw_page
from support.remedies import size_scheme

from balcli.core.mechanisms import harmonics
from balcli.errors import BalcliError
from balcli.limits import SMALL
from balcli.report.pages import PageSubject
from balcli.report.study import compute_study, swing_banks
from balcli.show.sheet import size_text
from balcli.show.units import SI
from balcli.sizing.ladder import find_ladder
from balcli.sizing.options import SchemeOptions

VEE = changed(("firing_order = [1, 3, 4, 2]", "bank_angle = 75\nstagger = 20"))
SINGLE = changed(("throws = [0, 180, 180, 0]", "throws = [0]"), ("firing_order = [1, 3, 4, 2]", ""))
CROSS = changed(
    ("throws = [0, 180, 180, 0]", "throws = [0, 90, 270, 180]"), ("firing_order = [1, 3, 4, 2]", "bank_angle = 90")
)


def test_flat_plane_vee_eight_over_its_bank_angle():
    """Liu: with K = 4 A_2 m r omega^2 the second order is K cos(gamma/2) with the crank and K cos(3
    gamma/2) against it.
    """
    vee = build_text(VEE)
    banks = swing_banks(vee, 2)
    c = vee.cylinders
    ratio = float(harmonics.find_harmonics([2.0], c.lam, c.eps)["piston"].c[0, 0].real)
    K = 4 * ratio * float(c.reciprocating[0] * c.radius[0]) * vee.omega**2
    gamma = np.radians(banks.angles_deg)
    assert np.abs(banks.force.forward[0]) == pytest.approx(K * np.abs(np.cos(gamma / 2)), abs=1e-12 * K)
    assert np.abs(banks.force.backward[0]) == pytest.approx(K * np.abs(np.cos(3 * gamma / 2)), abs=1e-12 * K)
    assert banks.own_deg == 75


@pytest.mark.parametrize("order", [1, 2, 4])
def test_radii_of_two_shafts_over_the_bank_angle(order):
    """Those of the scheme, at bank angles of its own; above 0 the shafts stand on one side of the middle
    plane, below 0 on both. A flat-plane V8's ratio of order 2 is -cos 3x / cos x.
    """
    options = SchemeOptions(order=order)
    text = VEE if order > 1 else VEE.replace("[0, 180, 180, 0]", "[0, 0, 0, 0]")
    study = compute_study(build_text(text), "bank", scheme="two-shaft", options=options)
    with_crank, against, ratio = study.banks.find_radii()
    for angle in (20, 50, 75, 130, 170):
        found = size_scheme(
            build_text(text.replace("= 75", f"= {angle}")), "two-shaft", order=order, at=(0.04 + 0.07j,)
        )
        (other,) = (d.at for d in found.devices if getattr(d, "ratio", 0) == -order)
        (own,) = (d.at for d in found.devices if getattr(d, "ratio", 0) == order)
        radii = float(np.hypot(*own) / np.hypot(*other))
        assert abs(ratio[angle]) == pytest.approx(radii, rel=1e-10)
        assert with_crank[angle] / against[angle] == pytest.approx(ratio[angle])
        if radii > 1e-9:
            assert (own[1] * other[1] > 0) == (ratio[angle] > 0)
            assert (own[0] * other[0] > 0) == (ratio[angle] < 0)
    if order == 2:
        x = np.radians(np.arange(0, 180) / 2)
        assert ratio[:180] == pytest.approx(-np.cos(3 * x) / np.cos(x), abs=1e-9)
    page = draw_page(PageSubject(study), "bank", "svg").decode()
    assert f"Shafts at +{order} and -{order}" in page


def test_its_own_bank_angle_is_the_engine_as_it_is():
    vee = build_text(VEE)
    found = compute_study(build_text(VEE), "bank")
    at = int(np.flatnonzero(found.banks.angles_deg == 75)[0])
    force = compute_study(vee, "all").now.spectra.force.select_orders([2])
    assert found.banks.force.major[0, at] == pytest.approx(float(force.major[0]), rel=1e-12)
    assert found.banks.order == 2


@cache
def study_factors(text):
    return compute_study(build_text(text), "factor")


def test_half_the_reciprocating_mass_balances_a_cross_plane_vee_eight():
    rows = study_factors(CROSS).factors
    best = min(rows, key=lambda row: row.peak_moment_Nm)
    assert [row.factor for row in rows] == pytest.approx(np.linspace(0, 1, 51))
    assert best.factor == 0.5
    assert best.peak_moment_Nm < 1e-2 * rows[0].peak_moment_Nm


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (GOOD, "this engine has 1 bank$"),
        (changed(("firing_order = [1, 3, 4, 2]", "banks = [-60, 0, 60]")), "this engine has 3 banks$"),
    ],
)
def test_only_a_vee_has_a_bank_angle(text, reason):
    with pytest.raises(BalcliError, match=reason):
        compute_study(build_text(text), "bank")


def test_the_page_of_factors_tells_the_best_and_by_what():
    """Pins of a cross-plane crank balance each other: a factor changes the moment alone."""
    for text, by in ((CROSS, r"moment [\d.]+ N·m"), (SINGLE, r"[\d.]+ k?N")):
        page = draw_page(PageSubject(study_factors(text)), "factor", "svg")
        assert re.search(rf"best at 0\.\d+ \({by}\)", page.decode())


def test_counterweights_unload_the_crankshaft_of_an_in_line_four():
    """It is balanced outside, and yet bent; weights at every throw take most of that away."""
    free = compute_study(build_text(GOOD), "inner").bent[0]
    now, before = compute_study(build_text(GOOD), "inner", scheme="factor").bent
    assert max(p.value for p in before.bending.peaks) == max(p.value for p in free.bending.peaks) > 100
    assert max(p.value for p in now.bending.peaks) < 0.7 * max(p.value for p in before.bending.peaks)


def test_the_best_factor_of_one_cylinder_is_found_between_the_steps():
    """The force is that of piston and small end along the cylinder, less the factor's share of
    their mass on the other side of the pin: a peak over a fine grid of both, by hand.
    """
    rows = study_factors(SINGLE).factors
    best = min(rows, key=lambda row: row.peak_force_N)
    r = 0.045
    rod = 0.160
    mass = 0.5 + 0.6 * 45 / 160
    omega = 100 * np.pi
    turn = np.radians(np.arange(0, 360, 0.05))
    lean = np.sqrt(rod**2 - (r * np.sin(turn)) ** 2)
    along = np.cos(turn) + r * np.cos(2 * turn) / lean + r**3 * np.sin(2 * turn) ** 2 / 4 / lean**3
    factors = best.factor + np.arange(-0.005, 0.00501, 1e-4)
    peaks = [np.abs(along - factor * np.exp(1j * turn)).max() for factor in factors]
    assert factors[np.argmin(peaks)] == pytest.approx(best.factor, abs=1.5e-4)
    assert best.peak_force_N == pytest.approx(mass * r * omega**2 * min(peaks), rel=2e-4)
    assert round(50 * best.factor, 3) % 1
    assert [row.factor for row in rows] == sorted(row.factor for row in rows)


def test_a_force_that_is_negligible_at_every_bank_angle_is_said():
    """Two sixes side by side have no free force but of order 6, and that is small."""
    text = changed(
        ("throws = [0, 180, 180, 0]", "throws = [0, 240, 120, 120, 240, 0]"),
        ("firing_order = [1, 3, 4, 2]", "bank_angle = 60"),
        ("length = 160", "length = 240"),
    )
    drawn = draw_page(PageSubject(compute_study(build_text(text), "bank")), "bank", "svg")
    assert re.search(r"negligible \(\S+ N\), whatever the bank angle", drawn.decode())


def test_a_scheme_compares_before_and_after():
    found = compute_study(build_text(GOOD), "all", scheme="two-shaft")
    assert found.before.spectra.force.select_orders([2]).major[0] > 100
    assert found.now.spectra.force.select_orders([2]).balanced[0]
    with pytest.raises(BalcliError, match="there is no scheme 'tow-shaft'"):
        compute_study(build_text(GOOD), "all", scheme="tow-shaft")


def test_the_study_of_factors_takes_planes_alone():
    """In the planes of the end throws the same unbalance of order 1 is left as at every throw."""
    free = study_factors(CROSS).factors
    ends = compute_study(build_text(CROSS), "factor", options=SchemeOptions(planes="ends")).factors
    assert [row.peak_moment_Nm for row in ends] == pytest.approx([row.peak_moment_Nm for row in free], abs=1)
    assert ends[0].counterweight_kg_m > 1.02 * free[0].counterweight_kg_m
    for asked, reason in (
        ({"scheme": "minimax"}, "what factor shows the scheme factor: leave scheme minimax out"),
        ({"options": SchemeOptions(factor=(0.5,))}, "what factor shows all factors: leave"),
        ({"options": SchemeOptions(at=(0j,))}, "scheme factor has no at; it takes factor, measured, planes"),
    ):
        with pytest.raises(BalcliError, match=reason):
            compute_study(build_text(CROSS), "factor", **asked)


def test_the_page_of_the_ladder_has_the_loci_of_all_steps():
    """Each with its name and its largest value; `small` says which steps there are."""
    three = changed(("throws = [0, 180, 180, 0]", "throws = [0, 240, 120]"), ("firing_order = [1, 3, 4, 2]", ""))
    for small, last in ((None, "4: shafts at +2 and -2"), (0.3, "3: shaft at -1")):
        subject = PageSubject(compute_study(build_text(three), "ladder", options=SchemeOptions(small=small)))
        *_, step = find_ladder(build_text(three), small or SMALL).steps
        assert list(subject.study.steps)[-1] == last
        page = draw_page(subject, "ladder", "svg").decode()
        words = " ".join(re.findall(r">([^<>]*)</text>", page))  # long names have two lines
        assert [name in words for name in subject.study.steps] == [True] * len(subject.study.steps)
        assert f">{last}<" in page
        assert f">moment {size_text(step.peak_moment_Nm, SI.moment, 4)}<" in page
    with pytest.raises(BalcliError, match=r"^what ladder shows the engine as it is"):
        compute_study(build_text(three), "ladder", scheme="auto")
    with pytest.raises(BalcliError, match=r"^what bank shows the engine as it is: leave scheme"):
        compute_study(build_text(VEE), "bank", scheme="auto")
