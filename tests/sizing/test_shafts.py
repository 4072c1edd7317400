"""One shaft with one eccentric or two, and shafts whose place is free."""

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask, ask_json, refusal, run_here
from support.paths import ENGINES
from support.remedies import fit_scheme, size_scheme

from balcli import load
from balcli.forces.spectrum import compute_spectra
from balcli.show.sheet import size_text
from balcli.show.units import SI
from balcli.sizing.fitting import Slot
from balcli.sizing.ladder import SHAFTS, find_ladder
from balcli.sizing.options import SchemeOptions
from balcli.sizing.planes import find_free
from balcli.sizing.remedy import fit_devices
from balcli.sizing.sizing import size

TWIN = ENGINES / "twin270.toml"
I3 = ENGINES / "i3.toml"
I4 = ENGINES / "i4.toml"
I5 = ENGINES / "i5.toml"
V6 = ENGINES / "v6_60.toml"


def left(path, scheme, options, order):
    """Forward and backward force and moment with the devices, N and N m."""
    built = load(path)
    fitted = fit_devices(built, size(built, scheme, options))
    return compute_spectra(fitted, [order], ("force", "moment"))


# ------------------------------------------------------------------ two eccentrics on one shaft
def test_two_eccentrics_at_a_given_place_take_force_and_moment_of_a_270_degree_twin():
    options = SchemeOptions(at=(-0.07 + 0.09j,), planes=(-0.048, 0.048))
    remedy = size(load(TWIN), "single-shaft", options)
    assert [(s.ratio, s.at, s.position) for s in remedy.shafts] == [(-1, (-70, 90), -48), (-1, (-70, 90), 48)]
    found = left(TWIN, "single-shaft", options, 1)
    assert found.force.balanced.all()
    assert found.moment.balanced.all()
    assert remedy.reasons[-1].endswith("eccentrics in two planes on a shaft at -1 times crank speed can")
    assert "moment_left_Nm" not in remedy.details


def test_their_sizes_by_hand():
    """A backward force V at z = 0 and a moment V a/2 of it: (1 -+ a/(2 h)) / 2 of it in planes at
    -h and h, if moment and force point the same way; in general sum and first moment are as
    wanted.
    """
    built = load(TWIN)
    remedy = size_scheme(built, "single-shaft", planes=(-0.05, 0.02))
    spectra = compute_spectra(fit_scheme(built, "counterweights", order=1), [1], ("force", "moment"))
    square = built.omega**2
    force = spectra.force.backward[0] / square
    moment = spectra.moment.backward[0] / 1j / square
    one, other = (d.backward for d in fit_devices(built, remedy).devices if d.backward)
    assert one + other == pytest.approx(-force, rel=1e-12)
    assert -0.05 * one + 0.02 * other == pytest.approx(-moment, rel=1e-12)


def test_one_eccentric_promises_the_force_alone_where_a_moment_stays():
    remedy = size_scheme(load(TWIN), "single-shaft", at=(-0.07 + 0.09j,))
    assert remedy.reasons[-1] == (
        "Order 1 force turning against the crank: nothing on the crankshaft can cancel it; one "
        "eccentric on a shaft at -1 times crank speed can; a moment remains, which eccentrics in two "
        "planes cancel"
    )
    assert not left(TWIN, "single-shaft", SchemeOptions(), 1).moment.balanced.all()


def test_two_planes_take_a_moment_alone_too():
    """A three has no force: two opposite eccentrics on one shaft."""
    remedy = size_scheme(load(I3), "single-shaft", planes="ends")
    assert remedy.order == 1
    assert len(remedy.shafts) == 2
    assert left(I3, "single-shaft", SchemeOptions(planes="ends"), 1).moment.balanced.all()
    without = run_here("balance", I3, "--scheme", "single-shaft")
    assert without.status == 2
    assert "couple-shaft cancels a moment of 464.4 N·m at -1" in without.err


@cases("sizing/shafts", "refusals")
def test_refusals(options, message):
    assert refusal("balance", TWIN, *options) == message


# ------------------------------------------------------------------ places of couple shafts
def test_couple_shafts_stand_at_two_places():
    options = SchemeOptions(order=2, at=(-0.05 + 0.08j, 0.06 + 0.09j))
    shafts = size(load(I5), "couple-shaft", options).shafts
    assert [(s.ratio, s.at) for s in shafts] == [(2, (60, 90)), (2, (60, 90)), (-2, (-50, 80)), (-2, (-50, 80))]
    assert left(I5, "couple-shaft", options, 2).moment.balanced.all()


def test_a_moment_that_turns_in_one_sense_takes_one_place():
    """V6 of 60 degrees: its second order turns against the crank alone."""
    v6 = ENGINES / "v6_60.toml"
    shafts = size_scheme(load(v6), "couple-shaft", order=2, at=(0.1 + 0j,)).shafts
    assert [(s.ratio, s.at) for s in shafts] == [(-2, (100, 0))] * 2
    two = ["--scheme=couple-shaft", "--order=2", "--at=1,2", "--at=3,4"]
    message = "--at: this moment takes one shaft; give no further places"
    assert refusal("balance", v6, *two) == message


# ------------------------------------------------------------------ free places
def test_opposite_eccentrics_that_nobody_has_placed_are_free():
    pair = [Slot("shaft", 1, -1, z, 0j).make_table(u, 0.0) for u, z in ((1e-3j, -0.1), (-1e-3j, 0.1))]
    placed = [Slot("shaft", 1, -1, z, 0.05j).make_table(u, 0.0) for u, z in ((1e-3j, -0.1), (-1e-3j, 0.1))]
    force = [Slot("shaft", 2, 1, z, 0j).make_table(u, 0.0) for u, z in ((1e-3, -0.1), (-0.9e-3, 0.1))]
    weight = Slot("counterweight", 1, 1, 0.0).make_table(1e-3, 0.0)
    assert find_free([weight, *pair, *force]) == (False, True, True, False, False)
    assert find_free(placed) == (False, False)
    assert find_free([Slot("shaft", 2, 1, 0.0).make_table(1e-3, 0.0)]) == (False,)


def test_a_force_has_no_free_place():
    """The shafts of a four at +2 and -2 add a roll wherever they stand but on the crank axis, and
    there, too, about a point of reference elsewhere.
    """
    table = " ".join(run_here("analyze", I4, "--only", "sizing").out.split())
    assert "free: " not in table
    assert "At 0, 0 (on the crank axis), a shaft adds no roll about this axis" in table


# ------------------------------------------------------------------ moment compensators
@pytest.mark.parametrize("places", [(3.0,), (-2.0, 3.0)])
@pytest.mark.parametrize(("path", "order"), [(I5, 2), (I3, 1), (I3, 2), (V6, 1), (V6, 2)])
def test_compensators_cancel_the_moment_about_y_alone(path, order, places):
    built = load(path)
    remedy = size_scheme(built, "compensator", order=order, position=places if len(places) > 1 else places[0])
    before, after = (
        compute_spectra(engine, [order], ("force", "moment", "roll")) for engine in (built, fit_devices(built, remedy))
    )
    size = abs(before.moment.y[0])
    assert remedy.details["moment_before_Nm"] == pytest.approx(size)
    assert remedy.details["moment_after_Nm"] == 0
    assert abs(after.moment.y[0]) < 1e-12 * size
    assert abs(after.moment.x[0] - before.moment.x[0]) < 1e-12 * size
    added = after.force.x[0] - before.force.x[0], after.force.y[0] - before.force.y[0]
    force = remedy.details["force_introduced_N"]
    arms = [z - float(built.reference_m[2]) for z in places]
    assert force == pytest.approx(0 if len(places) > 1 else size / arms[0])
    assert abs(added[0]) == pytest.approx(force, abs=1e-9 * size)
    assert abs(added[1]) < 1e-9 * size
    assert remedy.details["compensators"][0]["force_N"] == pytest.approx(size / abs(arms[0] - (*arms, 0)[1]))
    turned = remedy.details["moment_left_per_degree_Nm"] / size  # the pair turned by one degree
    assert turned == pytest.approx(abs(np.exp(1j * np.radians(1)) - 1))


COMPENSATED = ("--scheme", "compensator", "--position", "3 m")


def test_the_force_of_a_compensator_is_meant_to_remain(tmp_path):
    """It counts in figures, but no step of the ladder cancels it; the file that is written says so."""
    written = tmp_path / "aft.toml"
    run_here("balance", I5, *COMPENSATED, "--write", written)
    fitted = load(written)
    promised = fit_devices(load(I5), size_scheme(load(I5), "compensator", position=3.0))
    assert fitted.devices == promised.devices
    ladder = find_ladder(fitted)
    assert SHAFTS in [step.step for step in find_ladder(load(I5)).steps]
    assert SHAFTS not in [step.step for step in ladder.steps]
    told = ask("analyze", "-q", written)
    verdict = " ".join(told[told.index("Verdict") : told.index("Largest by")].split())
    force = size_text(ask_json("balance", I5, *COMPENSATED)["details"]["force_introduced_N"], SI.force)
    assert (
        "Second order: moment about y balanced by the compensator at z = 3000 mm; the compensator introduces "
        f"a force of {force} by design." in verdict
    )
    assert "+2 and -2" not in verdict
    drawn = ladder.steps[0].peak_force_N
    assert drawn > 1.5 * find_ladder(load(I5)).steps[0].peak_force_N + 1
    assert written.read_text().count('role = "compensator"') == 2
    (first, _) = ask_json("balance", I5, *COMPENSATED)["shafts"]
    assert first["role"] == "compensator"


@cases("sizing/shafts", "compensators_that_cannot_be")
def test_compensators_that_cannot_be(options, message):
    assert refusal("balance", I5, "--scheme", "compensator", *options) == message


def test_an_order_without_a_moment_needs_no_compensator():
    out = run_here("balance", I4, "--scheme", "compensator", "--position", "3 m").out
    assert "Order 2 has no moment about y: nothing to compensate." in out
