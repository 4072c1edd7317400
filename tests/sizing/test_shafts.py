"""One shaft with one eccentric or two, and shafts whose place is free."""

from __future__ import annotations

import json

import pytest
from support.cases import cases
from support.commands import ask_json, refusal, run_here
from support.engines import STAGGERED_TWIN, build_text, engine
from support.paths import ENGINES
from support.remedies import fit_scheme, size_scheme

from balcli.core.cylinders import DeviceKind
from balcli.engine.load import load
from balcli.forces.spectrum import compute_spectra
from balcli.render.page_scene import place_beside, scene
from balcli.render.units import SYSTEMS
from balcli.results.analysis import analyze
from balcli.sizing.device_tables import find_free, make_counterweight, make_shaft
from balcli.sizing.options import SchemeOptions
from balcli.sizing.remedy import fit_devices
from balcli.sizing.sizing import size

TWIN = ENGINES / "twin270.toml"
I3 = ENGINES / "i3.toml"
I4 = ENGINES / "i4.toml"
I5 = ENGINES / "i5.toml"


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
    assert "couple left" not in {detail.label for detail in remedy.details}


def test_their_sizes_by_hand():
    """A backward force V at z = 0 and a moment V a/2 of it: (1 -+ a/(2 h)) / 2 of it in planes at
    -h and h, if moment and force point the same way; in general sum and first moment are as
    wanted.
    """
    built = load(TWIN)
    remedy = size_scheme(built, "single-shaft", planes=(-0.05, 0.02))
    spectra = compute_spectra(fit_scheme(built, "counterweights", order=1), [1], ("force", "moment"))
    square = built.omega**2
    force, moment = spectra.force.backward[0] / square, spectra.moment.backward[0] / 1j / square
    one, other = (d.backward for d in fit_devices(built, remedy).devices if d.backward)
    assert one + other == pytest.approx(-force, rel=1e-12)
    assert -0.05 * one + 0.02 * other == pytest.approx(-moment, rel=1e-12)


def test_one_eccentric_promises_the_force_alone_where_a_moment_stays():
    remedy = size_scheme(load(TWIN), "single-shaft", at=(-0.07 + 0.09j,))
    assert remedy.reasons[-1] == (
        "Order 1 force turning against the crank: nothing on the crankshaft can cancel it; one "
        "eccentric on a shaft at -1 times crank speed can; a moment stays, which eccentrics in two "
        "planes take, too"
    )
    assert not left(TWIN, "single-shaft", SchemeOptions(), 1).moment.balanced.all()


def test_one_eccentric_promises_both_where_it_takes_both():
    """A single cylinder: its force acts where the shaft is."""
    remedy = size(load(ENGINES / "single.toml"), "single-shaft")
    assert remedy.reasons[-1].endswith("one eccentric on a shaft at -1 times crank speed can")
    uneven = engine(crank={"throws": [0], "spacing": 1}, cylinder={"1": {"position": 30}})
    assert "moment stays" not in size(uneven, "single-shaft").reasons[-1]


def test_pairs_promise_no_more_either():
    remedy = size(load(TWIN), "two-shaft")
    assert all(reason.endswith("a moment stays, which takes eccentrics in two planes") for reason in remedy.reasons)
    assert all(reason.startswith("Order 1 force turning") for reason in remedy.reasons)
    whole = size_scheme(load(I4), "two-shaft", order=2).reasons
    assert not any("stays" in reason for reason in whole)


def test_two_planes_take_a_moment_alone_too():
    """A three has no force: two opposite eccentrics on one shaft."""
    remedy = size_scheme(load(I3), "single-shaft", planes="ends")
    assert remedy.order == 1
    assert len(remedy.shafts) == 2
    assert left(I3, "single-shaft", SchemeOptions(planes="ends"), 1).moment.balanced.all()
    without = run_here("balance", I3, "--scheme", "single-shaft")
    assert "there is no free force turning against the crank of orders 1 to 5" in without.out or (
        "Order 6 force" in without.out
    )


@cases("sizing/shafts", "refusals")
def test_refusals(options, message):
    assert refusal("balance", TWIN, *options) == message


# ------------------------------------------------------------------ places of couple shafts
def test_couple_shafts_stand_at_two_places():
    options = SchemeOptions(order=2, at=(-0.05 + 0.08j, 0.06 + 0.09j))
    shafts = size(load(I5), "couple-shaft", options).shafts
    assert [(s.ratio, s.at) for s in shafts] == [(2, (60, 90)), (2, (60, 90)), (-2, (-50, 80)), (-2, (-50, 80))]
    assert left(I5, "couple-shaft", options, 2).moment.balanced.all()


def test_one_place_is_that_of_the_shaft_against_the_crank():
    shafts = size_scheme(load(I5), "couple-shaft", order=2, at=(0.1 + 0j,)).shafts
    assert {(s.ratio, s.at) for s in shafts} == {(2, (0, 0)), (-2, (100, 0))}


def test_a_moment_that_turns_in_one_sense_takes_one_place():
    """V6 of 60 degrees: its second order turns against the crank alone."""
    v6 = ENGINES / "v6_60.toml"
    shafts = size_scheme(load(v6), "couple-shaft", order=2, at=(0.1 + 0j,)).shafts
    assert [(s.ratio, s.at) for s in shafts] == [(-2, (100, 0))] * 2
    two = ["--scheme=couple-shaft", "--order=2", "--at=1,2", "--at=3,4"]
    message = "--at: this moment takes one shaft; give no more places"
    assert refusal("balance", v6, *two) == message


# ------------------------------------------------------------------ free places
def test_opposite_eccentrics_that_nobody_has_placed_are_free():
    pair = [make_shaft(u, -1, z, 0j) for u, z in ((1e-3j, -0.1), (-1e-3j, 0.1))]
    placed = [make_shaft(u, -1, z, 0.05j) for u, z in ((1e-3j, -0.1), (-1e-3j, 0.1))]
    force = [make_shaft(u, 2, z, 0j) for u, z in ((1e-3, -0.1), (-0.9e-3, 0.1))]
    weight = make_counterweight(1e-3, 0.0, 0.0)
    assert find_free([weight, *pair, *force]) == (False, True, True, False, False)
    assert find_free(placed) == (False, False)
    assert find_free([make_shaft(1e-3, 2, 0.0, 0j)]) == (False,)


def test_free_places_are_told():
    table = run_here("balance", I5, "--scheme", "couple-shaft", "--order", 2, "--at=100,0").out
    rows = [line.split() for line in table.splitlines() if line.startswith("shaft")]
    assert [(row[1], row[4]) for row in rows] == [("+2", "free")] * 2 + [("-2", "100,")] * 2
    assert "free: the shaft may stand anywhere, for it makes a moment alone." in table
    sizing = ask_json("analyze", I5)["sizing"]
    assert [(s["free"], s["at_mm"]) for s in sizing["shafts"]] == [(True, [0, 0])] * 6


def test_a_force_has_no_free_place():
    """The shafts of a four at +2 and -2 add a roll wherever they stand but on the crank axis, and
    there, too, about a point of reference elsewhere.
    """
    table = run_here("analyze", I4, "--only", "sizing").out
    assert "free: " not in table
    assert "At 0, 0, the crank's centre line, a shaft adds no roll about it; elsewhere" in table


def test_sizes_name_the_device_they_are_of():
    lines = run_here("balance", I3).out.splitlines()
    start = next(k for k, line in enumerate(lines) if "disc r, mm" in line)
    kinds = ["counterweight"] * 2 + ["shaft"] * 6
    found = [line.split()[:2] for line in lines[start + 2 : start + 10]]
    assert found == [[str(k), kind] for k, kind in enumerate(kinds, 1)]


def test_how_a_shaft_stands_is_told():
    """Against the crank, an angle might count either way; of counterweights alone it cannot."""
    told = "angles of those that turn against the crank count in its sense, too."
    assert told in run_here("balance", I3, "--scheme", "couple-shaft", "--order", 1).out
    assert told not in run_here("balance", I3, "--scheme", "counterweights").out


def test_the_file_says_which_are_free(tmp_path):
    out = tmp_path / "out.toml"
    run_here("balance", I3, "--scheme", "couple-shaft", "--order", 1, "--write", out)
    lines = out.read_text().splitlines()
    assert lines.count("at = [0.0, 0.0]  # free: it may stand anywhere") == 4


def test_shafts_on_the_crank_axis_are_drawn_beside_the_engine():
    built = load(I5)
    fitted = fit_scheme(built)
    radius = float(built.cylinders.radius)
    drawn = place_beside(fitted, 0.08)
    shafts = {row for row, device in enumerate(fitted.devices) if device.kind is DeviceKind.SHAFT}
    assert set(drawn) == shafts
    assert min(abs(place) for place in drawn.values()) > 2 * radius
    turning = {row: 1 if fitted.devices[row].forward else -1 for row in drawn}
    assert all(place.imag * turning[row] > 0 for row, place in drawn.items())
    by_place = {}
    for row, place in drawn.items():
        by_place.setdefault(place, set()).add((fitted.devices[row].order, turning[row]))
    assert sorted(map(len, by_place.values())) == [1, 1, 1]  # no two shafts in one place


def test_shafts_with_a_place_are_drawn_there():
    built = load(I4)
    options = SchemeOptions(order=2, at=(0.2 + 0.1j, 0.2 - 0.1j))
    assert place_beside(fit_devices(built, size(built, "two-shaft", options)), 0.08) == {}


def test_the_page_has_no_shaft_inside_the_crank():
    built = load(I5)
    now, after = (analyze(e, [1, 2]) for e in (built, fit_scheme(built)))
    shown = scene(now, after, SYSTEMS["si"])
    shafts = [device for device in shown["variants"][-1]["devices"] if device["beside"]]
    assert len(shafts) == 6
    assert all(max(map(abs, shaft["at"])) > shown["stroke"] for shaft in shafts)


# ------------------------------------------------------------------ an order that was not asked for
def test_lower_orders_that_stay_as_they_are_are_named():
    """Pins split by 2 x 75 - 180 degrees: no force of order 1 turns against the crank."""
    twin = build_text(STAGGERED_TWIN)
    remedy = size(twin, "single-shaft")
    assert remedy.order == 2
    assert remedy.note == (
        "Order 2 is the lowest with a free force turning against the crank. Order 1 stays as it is "
        "(its force and moment turning with the crank: the scheme counterweights; its moment turning "
        "against the crank: eccentrics in two planes)."
    )
    assert not size_scheme(twin, "single-shaft", order=2).note
    assert not size_scheme(twin, "single-shaft", planes=(-0.01, 0.01)).note
    assert not size(load(I4), "single-shaft").note  # order 1 is balanced


def test_orders_that_stay_for_the_same_reason_are_named_together():
    """A four has forces of even orders alone, and no moment."""
    note = size(load(I4), "couple-shaft").note
    assert note.endswith("Orders 2, 4, 6 and 8 stay as they are (they have a free force: two-shaft)")


def test_so_are_orders_whose_moment_is_left():
    """A twelve without any free order below 6, and two pairs of eccentrics that turn against it."""
    shafts = "".join(
        f"[[shaft]]\nratio = {ratio}\nunbalance = 500\nangle = {angle}\nposition = {angle}\n"
        for ratio in (-1, -2)
        for angle in (0, 180)
    )
    twelve = load((ENGINES / "v12_60.toml").read_text() + shafts)
    note = size(twelve, "single-shaft").note
    assert note.endswith(
        "Orders 1 and 2 stay as they are (their moment turning against the crank: eccentrics in two planes)."
    )


def test_what_turns_with_the_crank_is_said_with_its_size():
    twin = build_text(STAGGERED_TWIN)
    remedy = size_scheme(twin, "single-shaft", order=1)
    assert remedy.note == (
        "order 1 has no free force turning against the crank: nothing to balance; its force and "
        "moment turning with the crank: the scheme counterweights; its moment turning against the "
        "crank: eccentrics in two planes"
    )
    force = analyze(twin, [1], ["force"]).spectra.force
    (detail,) = remedy.details
    assert detail.label == "force with crank left"
    assert detail.value == pytest.approx(abs(force.forward[0]), rel=1e-12)


def test_a_shaft_that_turns_as_the_crank_does_names_counterweights():
    twin = build_text(STAGGERED_TWIN)
    reasons = [*size(twin, "couple-shaft").reasons, *size(twin, "two-shaft").reasons]
    told = [reason for reason in reasons if "+1 times crank speed" in reason]
    assert len(told) == 3
    assert all("the scheme counterweights" in reason for reason in told)
    assert not any("nothing on the crankshaft" in reason for reason in told)


def test_what_is_left_is_said_with_its_order():
    table = run_here("balance", I3, "--scheme", "couple-shaft").out
    assert "order 1 moment left  0 N" in table
    document = json.loads(run_here("balance", I3, "--scheme=couple-shaft", "--format=json").out)
    assert "moment_left_Nm" in document["details"]
