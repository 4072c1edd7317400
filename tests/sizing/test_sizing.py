"""Every scheme: its devices, what it says of itself, and which options it takes."""

import cmath
import math

import numpy as np
import pytest
from support.engines import build_text
from support.remedies import SMALL, figures, find_orders, fit_scheme, size_scheme, weigh, write_engine

from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.options import SCHEMES, SchemeOptions
from balcli.sizing.remedy import Remedy, fit_devices
from balcli.sizing.sizing import size

# ------------------------------------------------------------------ all schemes
UNEVEN = SMALL["vee"] + "[cylinder.3]\npiston_mass = 2.5\n"  # its two vectors act at different places


def devices(remedy: Remedy) -> list[tuple[float, ...]]:
    """What each device is, and where."""
    return [
        (
            d.unbalance,
            *(cmath.rect(1, math.radians(d.angle)).real, cmath.rect(1, math.radians(d.angle)).imag),
            d.position,
            *getattr(d, "at", ()),
            getattr(d, "ratio", 0),
            getattr(d, "direction", 0),
        )
        for d in remedy.devices
    ]


@pytest.mark.parametrize("name", SMALL)
@pytest.mark.parametrize(
    "scheme", ["auto", "counterweights", "factor", "minimax", "single-shaft", "two-shaft", "four-shaft", "slider"]
)
def test_a_remedy_does_not_depend_on_the_point_of_reference(name, scheme):
    """Moments are counted from it, but devices stand where the engine needs them."""
    plain, moved = (build_text(SMALL[name] + frame) for frame in ("", "[frame]\nreference = [30, -20, 170]\n"))
    here, there = (size_scheme(e, scheme, small=0) for e in (plain, moved))
    assert len(there.devices) == len(here.devices)
    for one, other in zip(devices(here), devices(there), strict=True):
        assert other == pytest.approx(one, rel=1e-10, abs=1e-9)
    if scheme == "single-shaft":
        assert figures(there)["axial distance"] == pytest.approx(figures(here)["axial distance"], rel=1e-9, abs=1e-9)


OPTIONS = {
    "order": 2,
    "at": (0.02 + 0.03j,),
    "position": 0.033,
    "planes": (-0.02, 0.09),
    "factor": (0.3,),
    "measured": 1.9,
    "roll": "zero",
}
OF_SCHEMES = {"counterweights": {"order": 1}, "complete": {"at": (0.02 + 0.03j, 0.04, 0.05)}}  # instead of these
NEEDY = {"compensator", "eccentric-slider", "ellipse", "oldham", "step"}  # need an option, or another engine


@pytest.mark.parametrize("option", OPTIONS)
@pytest.mark.parametrize("scheme", sorted({*SCHEMES} - NEEDY))
def test_an_option_makes_a_difference_or_is_refused(scheme, option):
    engine = build_text(SMALL["vee"])
    given = {**OPTIONS, **OF_SCHEMES.get(scheme, {})}
    options = SchemeOptions(**{option: given[option]})
    if option not in SCHEMES[scheme]:
        with pytest.raises(BalcliError, match=f"scheme {scheme} has no {option}; (it takes|choose scheme)"):
            size(engine, scheme, options)
    elif (scheme, option) != ("counterweights", "order"):
        assert devices(size(engine, scheme, options)) != devices(size(engine, scheme))


def test_planes_are_named_or_given():
    engine = build_text(SMALL["vee"])
    with pytest.raises(BalcliError, match=r'planes "left": give ends, throws, webs, or places along z$'):
        size_scheme(engine, "counterweights", planes="left")
    with pytest.raises(BalcliError, match=r"planes: give ends, or two places along z, for opposite eccentrics$"):
        size_scheme(engine, "couple-shaft", planes=(-0.1, 0.0, 0.1))
    ends = [devices(size_scheme(engine, "couple-shaft", planes=planes)) for planes in (None, "ends", (-0.05, 0.05))]
    assert ends[0] == ends[1] == ends[2]
    with pytest.raises(BalcliError, match=r"at: this scheme fits its devices at one place; give one place$"):
        size_scheme(engine, "slider", at=(0j, 1j))


@pytest.mark.parametrize("name", ["one", "vee", "uneven"])
@pytest.mark.parametrize("place", [1e-4, 0.02, -0.03, 0.3])
def test_a_single_plane_near_the_point_of_reference_takes_no_huge_weight(name, place):
    """Least squares of force F + u and moment M + a u over the engine's reach: about the point of
    reference a plane there has no arm a to take a moment with.
    """
    engine = build_text(UNEVEN if name == "uneven" else SMALL[name])
    before = compute_spectra(engine, [1], ("force", "moment"))
    force = before.force.forward[0]
    moment = before.moment.forward[0] / 1j
    reach = max(abs(place), float(np.abs(engine.cylinders.z).max()), float(engine.cylinders.radius[0]))
    best = -(force + place * moment / reach**2) / (1 + (place / reach) ** 2)
    remedy = size_scheme(engine, "counterweights", planes=(place,))
    assert figures(remedy)["force with crank left"] == pytest.approx(
        abs(force + best), rel=1e-9, abs=1e-11 * abs(force)
    )
    if place == 1e-4:
        assert figures(remedy)["force with crank left"] < 0.01 * abs(force)


# ------------------------------------------------------------------ shafts and sliders
@pytest.mark.parametrize("name", ["two", "vee", "uneven"])
def test_a_single_shaft_stands_where_its_moment_is_smallest(name):
    engine = build_text(UNEVEN if name == "uneven" else SMALL[name])
    here = size(engine, "single-shaft")
    assert "turning against the crank" in here.reasons[-1]
    assert "one eccentric on a shaft at -" in here.reasons[-1]
    place = here.shafts[0].position / 1e3
    for other in (-0.05, 0.0, 0.05, max(place - 1e-3, -0.05), min(place + 1e-3, 0.05)):  # between the throws
        there = size_scheme(engine, "single-shaft", position=other)
        assert figures(here)["moment left"] <= figures(there)["moment left"] * (1 + 1e-12) + 1e-12
        left = compute_spectra(fit_devices(engine, there), [here.order], ("moment", "roll"))
        assert figures(there)["moment left"] == pytest.approx(left.moment.major[0], rel=1e-9, abs=1e-9)
        assert figures(there)["roll left"] == pytest.approx(left.roll.major[0], rel=1e-12)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("bank", [50, 130])
def test_sliders_stand_where_the_stronger_part_acts(bank, order):
    """Between the throws, so that it leaves the least moment."""
    engine = build_text(UNEVEN.replace("bank_angle = 50", f"bank_angle = {bank}"))
    force = compute_spectra(engine, [order], ("force",)).force
    stronger = "forward" if abs(force.forward[0]) > abs(force.backward[0]) else "backward"
    place = size_scheme(engine, "slider", order=order).sliders[0].position / 1e3

    def left(position):
        after = fit_scheme(engine, "slider", order=order, position=position)
        return abs(getattr(compute_spectra(after, [order], ("moment",)).moment, stronger)[0])

    least = left(place) * (1 - 1e-9) - 1e-9
    assert all(left(min(max(other, -0.06), 0.06)) >= least for other in (-0.06, 0.0, 0.06, place - 1e-3, place + 1e-3))


@pytest.mark.parametrize("frame", ["", "[frame]\nreference = [30, -20, 170]\n"])
@pytest.mark.parametrize("order", [1, 2])
def test_no_roll_by_the_nearest_places(order, frame):
    """Of all pairs of places that take force and roll, those with the least sum of squares; about the crank axis."""
    at_crank = build_text(UNEVEN)
    options = SchemeOptions(order=order, roll="zero")
    remedy = size(build_text(UNEVEN + frame), "two-shaft", options)
    before, after = (compute_spectra(e, [order], ("force", "roll")) for e in (at_crank, fit_devices(at_crank, remedy)))
    assert after.force.balanced.all()
    assert after.roll.major[0] <= 1e-13 * before.roll.major[0]
    near = sum(abs(complex(*s.at)) ** 2 for s in remedy.shafts)
    first = complex(*next(s.at for s in remedy.shafts if s.ratio < 0)) / 1e3
    for step in (1e-3, 1e-3j, -1e-3, -1e-3j):
        other = size_scheme(at_crank, "two-shaft", order=order, roll="zero", at=(first + step,))
        assert sum(abs(complex(*s.at)) ** 2 for s in other.shafts) > near


@pytest.mark.parametrize(("order", "turning"), [(2, "against"), (4, "with")])
def test_a_force_in_one_sense_leaves_no_shaft_for_the_roll(order, turning):
    """Of three cylinders in a star, order n turns with the crank if n - 1 is divisible by 3, against it if n + 1 is."""
    engine = build_text(write_engine(0, layout="radial = 3"))
    told = f"order {order}: its force turns only {turning} the crank, so one shaft cancels it; leave out roll"
    with pytest.raises(BalcliError, match=told):
        size_scheme(engine, "two-shaft", order=order, roll="zero")
    remedy = size_scheme(engine, "two-shaft", order=order, at=(0.03j,))
    assert [s.at for s in remedy.shafts] == [(0, 30), (0, -30)]
    assert {s.ratio for s in remedy.shafts} == {order if turning == "with" else -order}
    told = figures(remedy, f"order {order}")
    assert told[f"direction {turning} crank"] == 90
    assert all("in two halves on opposite sides of the crank" in reason for reason in remedy.reasons)
    assert [key for key in told if key.startswith("radius")] == [f"radius {turning} crank"]


def star(cylinders):
    return build_text(write_engine(0, layout=f"radial = {cylinders}"))


def test_the_lowest_order_that_is_there_up_to_8():
    """Of a star of k cylinders, order k - 1 is the first that turns against the crank."""
    assert size_scheme(star(9), "single-shaft", small=0).order == 8
    with pytest.raises(BalcliError, match=r"against the crank is .* N \(order 8\), small compared with one cylinder's"):
        size(star(9), "single-shaft")
    assert size(star(11), "single-shaft").note.startswith(
        "there is no free force turning against the crank of orders 1 to 8: nothing to balance"
    )
    assert size_scheme(star(11), "single-shaft", order=10).order == 10
    # An offset makes odd orders.
    ninth = build_text(write_engine(0, layout="radial = 10", piston="mass = 1\noffset = 3"))
    assert "of orders 1 to 8" in size(ninth, "single-shaft").note
    assert size_scheme(ninth, "single-shaft", order=9).devices
    weighted = fit_scheme(star(3), "counterweights")
    assert size(weighted, "two-shaft").order == 2
    assert size_scheme(star(3), "two-shaft", order=1000).note.startswith("order 1000 has no free force: nothing")
    assert [size_scheme(star(3), "two-shaft", order=order).order for order in (1, 4)] == [1, 4]


@pytest.mark.parametrize("bank", [-90, -89.5, -0.5, 0, 0.5, 30, 89.5, 90])
def test_sliders_lie_along_the_axes_above_minus_90_up_to_90(bank):
    """One cylinder shakes along its axis, and needs no slider across."""
    single = write_engine(0, layout=f"banks = [{bank}]")
    (along,) = size_scheme(build_text(single), "slider", order=2).sliders
    assert along.direction == pytest.approx(90 if bank == -90 else bank)
    for half in (25, 35):  # the long axis of the ellipse lies along the bisector, and across it
        vee = build_text(write_engine(0, layout=f"banks = [{bank - half}, {bank + half}]"))
        two = size_scheme(vee, "slider", order=2).sliders
        assert all(-90 < s.direction <= 90 for s in two)
        assert abs(two[0].direction - two[1].direction) == pytest.approx(90)


# ------------------------------------------------------------------ the shop's factor
def test_peaks_along_and_across_are_those_of_the_curve():
    """Across the first bank, which leans, and off its axis by an offset: samples of what the remedy
    leaves, every 0.01 degrees.
    """
    engine = build_text(SMALL["vee"].replace("mass = 1\n[layout]", "mass = 1\noffset = 6\n[layout]"))
    for row in size_scheme(engine, "factor", factor=(0.3, 0.7)).sweep:
        curve = find_orders(fit_scheme(engine, "factor", factor=(row.factor,)))
        turn = np.exp(1j * np.radians(25))  # the first bank at -25 degrees
        seen = curve.values(np.linspace(0, 2 * np.pi, 36001)) * turn
        assert row.along_N == pytest.approx(np.abs(seen.real).max(), rel=1e-6)
        assert row.across_N == pytest.approx(np.abs(seen.imag).max(), rel=1e-6)
        assert abs(row.along_N - row.across_N) > 1


@pytest.mark.parametrize("share", [-2, 2])
def test_factors_at_their_bounds(share):
    engine = build_text(SMALL["one"])
    assert figures(size_scheme(engine, "factor", factor=(share,)))["factor"] == share
    with pytest.raises(BalcliError, match=r"factor -?2: (did you mean 2%\? )?give shares such as 0.5, 51% or"):
        size_scheme(engine, "factor", factor=(share * (1 + 1e-15), 0.5))


@pytest.mark.parametrize("scheme", ["auto", "counterweights", "factor", "minimax"])
def test_dust_of_an_unbalance_is_no_device(scheme):
    """Half of both pistons of a 90-degree twin, and a milliardth of a gram millimetre more or less:
    more than rounding, less than anybody could drill.
    """
    vee = write_engine(0, layout="bank_angle = 90")
    (whole,) = size(build_text(vee), "factor").counterweights
    for dust in (1e-9, -1e-9):
        remedy = size(build_text(vee + weigh(whole.unbalance + dust)), scheme)
        assert not remedy.counterweights
        if scheme == "counterweights":
            assert remedy.note.startswith("Order 1 is balanced already: counterweights change no free force")


@pytest.mark.parametrize(
    ("scheme", "options", "told"),
    [
        ("factor", {"factor": 0.5}, "factor: 0.5 (float): give shares, such as (0.5,)"),
        ("factor", {"factor": ("50%",)}, "factor: ('50%',) (tuple): give shares, such as (0.5,)"),
        ("factor", {"measured": "812 g"}, "measured: '812 g' (str): give a mass in kg"),
        ("factor", {"factor": (10**400,)}, "factor: (1000"),
        ("factor", {"measured": 10**400}, "measured: 1000"),
        ("two-shaft", {"order": 10**5000}, "order: a number of thousands of digits (int): give a"),
        ("two-shaft", {"position": 10**400}, "position: 1000"),
        ("two-shaft", {"order": 2.5}, "order: 2.5 (float): give a whole number, such as 2"),
        ("two-shaft", {"at": 1j}, "at: 1j (complex): give places x + iy in m"),
        ("two-shaft", {"at": (complex("nan"),)}, "at: ((nan+0j),) (tuple): give places x + iy"),
        ("two-shaft", {"position": math.inf}, "position: inf (float): give a place z in m"),
        ("counterweights", {"planes": (0.1, math.nan)}, "planes: (0.1, nan) (tuple): give"),
    ],
)
def test_what_is_no_option_is_told_in_words(scheme, options, told):
    """In Python; nan once went through to the figures."""
    with pytest.raises(TypeError) as error:
        size_scheme(build_text(SMALL["four"]), scheme, **options)
    assert str(error.value).startswith(f"SchemeOptions: {told}")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (SchemeOptions(at=(0.05 + 0.06j, 60 + 80j)), "at: 100000 mm"),
        (SchemeOptions(position=-90.0), "position: 90000 mm"),
        (SchemeOptions(planes=(-215.9, 228.6)), "planes: 228600 mm"),
    ],
)
def test_places_beyond_every_engine_are_refused(options, told):
    """Most likely mm where m are wanted."""
    with pytest.raises(BalcliError, match=f"^{told} from the origin; at most 50 m"):
        options.check("two-shaft" if options.planes is None else "factor")
