"""The solver and its slots; what a remedy says."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.engines import engine_text

from balcli.core import enclosing_circle as circle
from balcli.core.peaks import peak
from balcli.engine.build import build
from balcli.engine.load import parse
from balcli.enginefile.model import Counterweight
from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.auto import auto
from balcli.sizing.effects import Part, Rest, Slot, effect, exactly, rest, solve
from balcli.sizing.remedy import counterweight, degrees, shaft, slider
from balcli.sizing.sizing import Remedy, Wish, fitted, remedy_for

FORCE, MOMENT = Part("force", 1), Part("moment", 1)
BACK, ROLL = Part("force", -1), Part("roll", 0)
VECTOR = st.complex_numbers(
    min_magnitude=1e-3, max_magnitude=1e3, allow_nan=False, allow_infinity=False
)


def wish(noise: float = 1e-16, **parts: complex) -> Rest:
    """Parts by name: forward, backward, moment, roll."""
    names = {"forward": FORCE, "backward": BACK, "moment": MOMENT, "roll": ROLL}
    found = {names[name]: value for name, value in parts.items()}
    return Rest(2, found, dict.fromkeys(found, noise), (0j, 0.0), 1.0)


def text(*throws: float, **tables: str) -> str:
    return engine_text(
        crank=f"stroke = 100\nthrows = {list(throws)}\nspacing = 100\nthrow_mass = 1", **tables
    )


# ------------------------------------------------------------------ solver
@given(VECTOR, VECTOR)
def test_two_planes_take_any_force_and_moment(force, moment):
    slots = [Slot("shaft", 2, 1, z) for z in (-0.3, 0.2)]
    fit = solve(slots, wish(forward=force, moment=moment), (FORCE, MOMENT))
    left = sum(
        effect(s.device(u), (FORCE, MOMENT), (0j, 0.0))
        for s, u in zip(slots, fit.unbalances, strict=True)
    )
    assert left == pytest.approx(
        [-force, -moment], rel=1e-13, abs=1e-13 * (abs(force) + abs(moment))
    )


@given(VECTOR, VECTOR)
def test_sliders_in_two_directions_take_any_ellipse(forward, backward):
    slots = [Slot("slider", 2, 0, 0.0, 0j, direction) for direction in (20, 75)]
    fit = solve(slots, wish(forward=forward, backward=backward), (FORCE, BACK))
    assert fit.left <= 1e-14


def test_a_force_and_a_roll_by_shafts_at_three_places():
    """The roll couples both senses; with a shaft to spare it is cancelled together with the
    force.
    """
    slots = [
        Slot("shaft", 2, sense, 0.0, place)
        for sense, place in ((1, 0.1 + 0j), (-1, -0.1 + 0.05j), (1, -0.2j))
    ]
    parts = (FORCE, BACK, ROLL)
    asked = wish(forward=1 + 2j, backward=0.5 - 1j, roll=0.3 + 0.1j)
    fit = solve(slots, asked, parts)
    total = sum(
        effect(s.device(u), parts, (0j, 0.0)) for s, u in zip(slots, fit.unbalances, strict=True)
    )
    assert total == pytest.approx([-asked.parts[p] for p in parts], rel=1e-13)


@pytest.mark.parametrize(
    "slot",
    [
        Slot("slider", 2, 0, 0.07, 0.03 - 0.02j, 33),
        Slot("shaft", 2, 1, 0.07, 0.03 - 0.02j),
        Slot("shaft", 2, -1, -0.04, -0.01 + 0.05j),
    ],
)
def test_effect_is_what_the_analysis_says(slot):
    """Moments and roll about a point that is neither on the crank axis nor in the middle of the
    throws.
    """
    engine = build(parse(text(0, 180, 180, 0, frame="reference = [40, -25, 130]")))
    arm = (complex(*engine.reference_m[:2]), float(engine.reference_m[2]))
    u = cmath.rect(2e-3, 0.4)
    table = slot.table(u, 0.0)
    with_it = fitted(
        engine,
        Remedy("", sliders=(table,)) if slot.kind == "slider" else Remedy("", shafts=(table,)),
    )
    parts = [Part(q, s) for q in ("force", "moment") for s in (1, -1)] + [ROLL]
    before, after = rest(engine, 2), rest(with_it, 2)
    change = np.array([after.parts[p] - before.parts[p] for p in parts])
    assert change == pytest.approx(effect(slot.device(u), parts, arm), abs=1e-14)


def test_more_slots_than_needed_share_the_work():
    """The least sum of squares: at every throw of a row, equal weights for a force."""
    fit = solve(
        [Slot("counterweight", 1, 1, z) for z in (-0.1, 0.0, 0.1)],
        wish(forward=3, moment=0),
        (FORCE, MOMENT),
    )
    assert fit.unbalances == pytest.approx([-1, -1, -1])


def test_of_more_slots_than_needed_the_far_ones_do_most():
    """The least sum of squares that makes a moment: unbalances in proportion to the arms, `u = -m z
    / sum z^2`.
    """
    places = np.array([-0.1, 0.2, 0.4])
    fit = solve(
        [Slot("counterweight", 1, 1, z) for z in places], wish(moment=0.21 - 0.42j), (MOMENT,)
    )
    assert fit.unbalances == pytest.approx(-(0.21 - 0.42j) * places / 0.21, rel=1e-14)


@pytest.mark.parametrize("force", [3.7, -3.7, 0.3j, -0.3j])
def test_what_is_not_needed_is_exactly_nothing(force):
    """A force in one of the two planes; its part that is 0 stays 0, so that angles are plain."""
    slots = [Slot("counterweight", 1, 1, z) for z in (-0.13, 0.29)]
    fit = exactly(slots, wish(forward=force, moment=-0.13 * force), (FORCE, MOMENT), "")
    assert fit.unbalances == (pytest.approx(-force, rel=1e-14), 0)
    assert 0 in (fit.unbalances[0].real, fit.unbalances[0].imag)


@pytest.mark.parametrize("scale", [1e-9, 1, 1e9])
def test_one_slot_does_what_it_can(scale):
    """Least squares of force and of moment over the arm: u = -(f + m/z)/2 at z."""
    asked = wish(noise=1e-16 * scale, forward=scale, moment=0.6 * scale)
    fit = solve([Slot("counterweight", 1, 1, 0.2)], asked, (FORCE, MOMENT))
    assert fit.unbalances == pytest.approx([-(1 + 0.6 / 0.2) / 2 * scale])
    assert fit.left == pytest.approx(1 / 5**0.5)  # (f - m/z)/sqrt 2 of |f, m/z|, f = 1, m/z = 3
    with pytest.raises(BalcliError, match="the reason"):
        exactly([Slot("counterweight", 1, 1, 0.2)] * 2, asked, (FORCE, MOMENT), "the reason")


def test_arms_count_from_the_point_of_reference_in_all_directions():
    """A slot beside the crank on that point's own axis has no arm but along it: u = -(f + m/z)/2 at
    z from there.
    """
    asked = wish(forward=1, moment=0.6)._replace(arm=(0.3 + 0.4j, 0.1))
    fit = solve([Slot("shaft", 2, 1, 0.3, 0.3 + 0.4j)], asked, (FORCE, MOMENT))
    assert fit.unbalances == pytest.approx([-(1 + 0.6 / 0.2) / 2])


def test_a_slot_without_an_arm_can_do_nothing_about_a_moment():
    fit = solve([Slot("shaft", 2, 1, 0.0)], wish(moment=1), (MOMENT,))
    assert fit == ((0,), math.inf, 1)


# ------------------------------------------------------------------ tables
@given(st.floats(-720, 720), st.floats(-180, 180))
def test_angles_come_back(angle, origin):
    found = degrees(cmath.rect(1, math.radians(angle)), origin)
    assert -180 < found <= 180
    assert (found + origin - angle + 180) % 360 - 180 == pytest.approx(0, abs=1e-11)


@pytest.mark.parametrize("angle", [0, 15, 22.5, 30, 45, 90, 120, 135, 180, -30, -54, -162])
def test_plain_angles_are_written_plainly(angle):
    assert degrees(cmath.rect(3e-5, math.radians(angle))) == angle


def test_tables_are_in_the_units_of_the_file():
    weight = counterweight(-2e-3 + 0j, -0.0425, 45.0)
    assert (weight.unbalance, weight.angle, weight.position) == (2000.0, 135.0, -42.5)
    turning = shaft(1e-3j, -2, 0.1, -0.04 + 0.06j)
    assert (turning.ratio, turning.unbalance, turning.angle, turning.at, turning.position) == (
        -2,
        1000.0,
        90.0,
        (-40.0, 60.0),
        100.0,
    )
    sliding = slider(-1e-3 + 0j, 2, 90.0, 0.0, 0j)
    assert (sliding.order, sliding.unbalance, sliding.direction, sliding.angle) == (
        2,
        1000.0,
        90.0,
        180.0,
    )


def test_places_are_written_as_people_would():
    """Tenths of a millimetre, whatever metres times 1000 is in binary; and 0 without a sign."""
    assert all(
        counterweight(1e-3, tenth / 1e4, 0.0).position == tenth / 10 for tenth in range(-3000, 3001)
    )
    nothing = counterweight(complex(1e-3, -0.0), -0.0, 0.0)
    assert (str(nothing.position), str(nothing.angle)) == ("0.0", "0.0")
    assert (
        counterweight(1e-3, 0.1 / 3, 0.0).position == 100 / 3
    )  # what has no short form keeps its digits


# ------------------------------------------------------------------ auto
def test_every_device_has_its_reason():
    remedy = auto(build(parse(text(0, 240, 120))))
    assert len(remedy.reasons) == len(remedy.devices) == 8
    assert remedy.reasons[0] == (
        "Order 1 moment turning with the crank: counterweights turn with it too and cancel it"
    )
    assert remedy.reasons[-1].endswith(
        "turning against the crank: nothing on the crankshaft can cancel it; "
        "two opposite eccentrics on a shaft at -2 times crank speed can"
    )


def test_reasons_name_what_turns_and_how_it_is_cancelled():
    """One eccentric for a force, two planes for force and moment, two opposite ones for a
    moment.
    """
    four, three, vee = (
        auto(build(parse(text(*throws, **more)))).reasons
        for throws, more in (
            ((0, 180, 180, 0), {}),
            ((0, 240, 120), {}),
            ((0, 100, 210), {"layout": "bank_angle = 50"}),
        )
    )
    assert four[0] == (
        "Order 2 force turning with the crank: nothing on the crankshaft can cancel it; one "
        "eccentric on a shaft at "
        "+2 times crank speed can"
    )
    assert three[2].startswith("Order 1 moment turning against the crank: nothing")
    assert vee[0].endswith(
        "and moment turning with the crank: counterweights turn with it too and cancel both"
    )
    assert vee[-1] == (
        "Order 2 force and moment turning against the crank: nothing on the crankshaft can cancel "
        "it; eccentrics in two "
        "planes on a shaft at -2 times crank speed can"
    )


def test_nothing_is_fitted_where_nothing_is_left():
    engine = build(parse(text(0, 240, 120)))
    assert not auto(fitted(engine, auto(engine))).devices


def test_own_devices_count():
    engine = build(parse(text(0, 180, 180, 0)))
    half = Remedy("", shafts=auto(engine).shafts[:1])
    assert [s.ratio for s in auto(fitted(engine, half)).shafts] == [-2]


def test_staggered_rods_on_one_throw_get_planes_at_the_outer_cylinders():
    remedy = auto(build(parse(text(0, layout="bank_angle = 60\nstagger = 24"))))
    assert {d.position for d in remedy.counterweights} == {
        0.0
    }  # forward vectors of both rods lie on the pin
    assert {d.position for d in remedy.shafts if d.ratio == -1} == {-12.0, 12.0}


def test_sizing_does_not_depend_on_speed():
    slow, fast = (
        auto(build(parse(text(0, 90, 200) + f"[operation]\nspeed = {rpm}\n")))
        for rpm in (10, 20000)
    )
    assert [d.unbalance for d in slow.devices] == pytest.approx(
        [d.unbalance for d in fast.devices], rel=1e-12
    )


def test_devices_are_summed_in_the_order_of_the_file():
    engine = build(
        parse(text(0, 240, 120) + "[[slider]]\norder = 2\nunbalance = 3\ndirection = 10\n")
    )
    ranks = [d.rank for d in fitted(engine, auto(engine)).devices]
    assert ranks == sorted(ranks)
    assert compute_spectra(fitted(engine, auto(engine)), [1], ("force",)).force.balanced.all()


# ------------------------------------------------------------------ all schemes
ENGINES = {
    "one": text(0, piston="mass = 1\noffset = 4"),
    "two": text(0, 180) + "[cylinder.2]\npiston_mass = 3\n",
    "three": text(0, 240, 120),
    "four": text(0, 180, 180, 0),
    "vee": text(0, 100, layout="bank_angle = 50\nstagger = 20"),
}


UNEVEN = (
    ENGINES["vee"] + "[cylinder.3]\npiston_mass = 2.5\n"
)  # its two vectors act at different places


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


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize(
    "scheme",
    [
        "auto",
        "counterweights",
        "factor",
        "minimax",
        "single-shaft",
        "two-shaft",
        "four-shaft",
        "slider",
    ],
)
def test_a_remedy_does_not_depend_on_the_point_of_reference(name, scheme):
    """Moments are counted from it, but devices stand where the engine needs them."""
    plain, moved = (
        build(parse(ENGINES[name] + frame))
        for frame in ("", "[frame]\nreference = [30, -20, 170]\n")
    )
    here, there = (remedy_for(e, scheme) for e in (plain, moved))
    assert len(there.devices) == len(here.devices)
    for one, other in zip(devices(here), devices(there), strict=True):
        assert other == pytest.approx(one, rel=1e-10, abs=1e-9)
    if scheme == "single-shaft":
        assert there.details["axial_distance_mm"] == pytest.approx(
            here.details["axial_distance_mm"], rel=1e-9, abs=1e-9
        )


def test_no_roll_about_the_crank_whatever_the_point_of_reference():
    """A given first shaft, the second placed for no roll: the same about any point, the force being
    cancelled.
    """
    wish = Wish(at=(-0.04 + 0.06j,), roll="zero")
    plain, moved = (
        build(parse(ENGINES["four"] + frame))
        for frame in ("", "[frame]\nreference = [30, -20, 170]\n")
    )
    here, there = (devices(remedy_for(e, "two-shaft", wish)) for e in (plain, moved))
    assert there == [pytest.approx(device, rel=1e-10, abs=1e-9) for device in here]


def test_a_weight_opposite_staggered_rods_stands_in_their_middle():
    """Places whose mean is 0 but for rounding."""
    engine = build(
        parse(
            engine_text(
                crank="stroke = 100\nthrows = [0]",
                layout="bank_angle = 90\nstagger = 22.3",
                rod="ratio = 0.25\nmass = 0.61\ncg = 47.3",
            )
        )
    )
    cylinders = replace(
        engine.cylinders, z=engine.cylinders.z * (1 + 2e-16 * (engine.cylinders.z > 0))
    )
    (weight,) = remedy_for(replace(engine, cylinders=cylinders), "factor").counterweights
    assert weight.position == 0


def test_a_shaft_where_the_force_acts_is_at_no_distance_from_it():
    """Not at one of 1e-15 mm."""
    engine = build(
        parse(
            engine_text(crank="stroke = 100\nthrows = [0, 90]\npositions = [0, 33.3]")
            + "[cylinder.2]\npiston_mass = 1.7\n"
        )
    )
    (shaft,) = remedy_for(engine, "single-shaft", Wish(order=1)).shafts
    assert shaft.position > 0
    assert remedy_for(engine, "single-shaft", Wish(order=1)).details["axial_distance_mm"] == 0


def test_places_along_the_crank_are_figures_that_people_can_read():
    """Where two forces act together: `(m1 z1 + m2 z2)/(m1 + m2)`, in mm."""
    crank = "stroke = 100\nthrows = [0, 0]\npositions = [{}, {}]"
    for first, second in ((-50, 50), (17.3, 94.1), (-211.7, 3.3), (0, 100)):
        for share in (1, 3, 9):
            crank_text = crank.format(first, second)
            remedy = auto(
                build(
                    parse(engine_text(crank=crank_text) + f"[cylinder.2]\npiston_mass = {share}\n")
                )
            )
            assert {d.position for d in remedy.shafts} == {
                round((first + share * second) / (1 + share), 9)
            }
            assert [d.position for d in remedy.counterweights] == [first, second]  # at both throws


def test_what_is_in_the_middle_of_the_throws():
    """Throws at 10, 30 and 110 mm: 60, where nothing says otherwise."""
    engine = build(
        parse(engine_text(crank="stroke = 100\nthrows = [0, 0, 0]\npositions = [10, 30, 110]"))
    )
    (weight,) = remedy_for(engine, "minimax").counterweights
    assert weight.position == 60
    (weight,) = remedy_for(engine, "minimax", Wish(position=-0.02)).counterweights
    assert weight.position == -20


def test_a_single_device_has_no_condition_number():
    """Of two planes at equal distance from the middle it is 1."""
    assert (
        "condition_number" not in remedy_for(build(parse(ENGINES["four"])), "single-shaft").details
    )
    assert auto(build(parse(ENGINES["three"]))).details["condition_number"] == pytest.approx(
        1, rel=1e-14
    )
    balanced = build(parse(text(0, 240, 120, 120, 240, 0)))
    assert not auto(balanced).details


@pytest.mark.parametrize(
    ("scheme", "name", "order"),
    [
        ("auto", "three", None),
        ("counterweights", "three", 1),
        ("counterweights", "one", 1),
        ("factor", "one", 1),
        ("minimax", "one", 1),
        ("single-shaft", "four", 2),
        ("two-shaft", "four", 2),
        ("two-shaft", "one", 1),
        ("four-shaft", "one", None),
        ("couple-shaft", "three", 1),
        ("slider", "four", 2),
        ("minimax", "four", None),
        ("oldham", "centred", None),
    ],
)
def test_a_remedy_says_its_scheme_and_its_order(scheme, name, order):
    remedy = remedy_for(build(parse((ENGINES | {"centred": text(0)})[name])), scheme)
    assert (remedy.scheme, remedy.order) == (scheme, order)


WISHES = {
    "order": 2,
    "at": (0.02 + 0.03j,),
    "position": 0.033,
    "planes": (-0.02, 0.09),
    "factor": (0.3,),
    "roll": "zero",
}
TAKEN = {
    "auto": "",
    "counterweights": "order planes",
    "factor": "factor",
    "minimax": "planes position",
    "four-shaft": "at position",
    "single-shaft": "order at position",
    "two-shaft": "order at position roll",
    "couple-shaft": "order at planes",
    "slider": "order at position",
}


@pytest.mark.parametrize("option", WISHES)
@pytest.mark.parametrize("scheme", TAKEN)
def test_an_option_makes_a_difference_or_is_refused(scheme, option):
    engine = build(parse(ENGINES["vee"]))
    wish = Wish(
        **{option: 1 if scheme == "counterweights" and option == "order" else WISHES[option]}
    )
    if option not in TAKEN[scheme]:
        with pytest.raises(BalcliError, match=f"scheme {scheme} has no --{option}; it takes"):
            remedy_for(engine, scheme, wish)
    elif (scheme, option) != ("counterweights", "order"):
        assert devices(remedy_for(engine, scheme, wish)) != devices(remedy_for(engine, scheme))


def test_planes_are_named_or_given():
    engine = build(parse(ENGINES["vee"]))
    with pytest.raises(
        BalcliError,
        match=r'--planes "left": give ends, throws, or places along z in mm, such as -200,200$',
    ):
        remedy_for(engine, "counterweights", Wish(planes="left"))
    with pytest.raises(
        BalcliError,
        match=r"--planes: opposite eccentrics stand in two planes; give ends, or two places along "
        r"z in mm, "
        r"such as -200,200$",
    ):
        remedy_for(engine, "couple-shaft", Wish(planes=(-0.1, 0.0, 0.1)))
    ends = [
        devices(remedy_for(engine, "couple-shaft", Wish(planes=planes)))
        for planes in (None, "ends", (-0.05, 0.05))
    ]
    assert ends[0] == ends[1] == ends[2]
    with pytest.raises(BalcliError, match=r"--at: this scheme has one place; give it once$"):
        remedy_for(engine, "slider", Wish(at=(0j, 1j)))


@pytest.mark.parametrize("place", [0.0, 0.1])
def test_what_a_single_plane_leaves_is_said(place):
    """Away from the middle, force and moment both."""
    engine = build(parse(ENGINES["vee"]))
    remedy = remedy_for(engine, "counterweights", Wish(planes=(place,)))
    after = compute_spectra(fitted(engine, remedy), [1], ("force", "moment"))
    assert remedy.details["left_force_N"] == pytest.approx(
        abs(after.force.forward[0]), rel=1e-9, abs=1e-9
    )
    assert (remedy.details["left_force_N"] > 1) == (place != 0)
    assert remedy.details["left_moment_Nm"] == pytest.approx(
        abs(after.moment.forward[0]), rel=1e-12
    )
    assert remedy.details["left_moment_Nm"] > 1
    assert remedy.details["note"].startswith(
        "one plane, or planes at the same z, cannot take a moment"
    )


def test_without_a_scheme_it_is_auto():
    engine = build(parse(ENGINES["three"]))
    assert remedy_for(engine) == remedy_for(engine, "auto") == auto(engine)


# ------------------------------------------------------------------ shafts and sliders
@pytest.mark.parametrize("name", ["two", "vee", "uneven"])
def test_a_single_shaft_stands_where_its_couple_is_smallest(name):
    engine = build(parse(UNEVEN if name == "uneven" else ENGINES[name]))
    here = remedy_for(engine, "single-shaft")
    assert "turning against the crank" in here.reasons[-1]
    assert "one eccentric on a shaft at -" in here.reasons[-1]
    place = here.shafts[0].position / 1e3
    for other in (
        -0.05,
        0.0,
        0.05,
        max(place - 1e-3, -0.05),
        min(place + 1e-3, 0.05),
    ):  # between the throws
        there = remedy_for(engine, "single-shaft", Wish(position=other))
        assert (
            here.details["couple_left_Nm"] <= there.details["couple_left_Nm"] * (1 + 1e-12) + 1e-12
        )
        left = compute_spectra(fitted(engine, there), [here.order], ("moment", "roll"))
        assert there.details["couple_left_Nm"] == pytest.approx(
            abs(left.moment.backward[0]), rel=1e-9, abs=1e-9
        )
        assert there.details["roll_left_Nm"] == pytest.approx(left.roll.major[0], rel=1e-12)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("bank", [50, 130])
def test_sliders_stand_where_the_stronger_part_acts(bank, order):
    """Between the throws, so that it leaves the least moment."""
    engine = build(parse(UNEVEN.replace("bank_angle = 50", f"bank_angle = {bank}")))
    force = compute_spectra(engine, [order], ("force",)).force
    stronger = "forward" if abs(force.forward[0]) > abs(force.backward[0]) else "backward"
    place = remedy_for(engine, "slider", Wish(order=order)).sliders[0].position / 1e3

    def left(position):
        after = fitted(engine, remedy_for(engine, "slider", Wish(order=order, position=position)))
        return abs(getattr(compute_spectra(after, [order], ("moment",)).moment, stronger)[0])

    least = left(place) * (1 - 1e-9) - 1e-9
    assert all(
        left(min(max(other, -0.06), 0.06)) >= least
        for other in (-0.06, 0.0, 0.06, place - 1e-3, place + 1e-3)
    )


def test_a_pair_of_shafts_stands_on_the_crank_axis_if_nothing_is_said():
    remedy = remedy_for(build(parse(ENGINES["vee"])), "two-shaft")
    assert [s.at for s in remedy.shafts] == [(0, 0), (0, 0)]
    assert remedy.reasons[0] == (
        "Order 1 force and moment turning against the crank: nothing on the crankshaft can cancel "
        "it; "
        "one eccentric on a shaft at -1 times crank speed can"
    )
    assert "radius_ratio" not in remedy.details["order_1"]


@pytest.mark.parametrize("frame", ["", "[frame]\nreference = [30, -20, 170]\n"])
@pytest.mark.parametrize("order", [1, 2])
def test_no_roll_by_the_nearest_places(order, frame):
    """Of all pairs of places that take force and roll, those with the least sum of squares; about
    the crank axis.
    """
    at_crank = build(parse(UNEVEN))
    wish = Wish(order=order, roll="zero")
    remedy = remedy_for(build(parse(UNEVEN + frame)), "two-shaft", wish)
    before, after = (
        compute_spectra(e, [order], ("force", "roll")) for e in (at_crank, fitted(at_crank, remedy))
    )
    assert after.force.balanced.all()
    assert after.roll.major[0] <= 1e-13 * before.roll.major[0]
    near = sum(abs(complex(*s.at)) ** 2 for s in remedy.shafts)
    first = complex(*next(s.at for s in remedy.shafts if s.ratio < 0)) / 1e3
    for step in (1e-3, 1e-3j, -1e-3, -1e-3j):
        other = remedy_for(
            at_crank, "two-shaft", Wish(order=order, roll="zero", at=(first + step,))
        )
        assert sum(abs(complex(*s.at)) ** 2 for s in other.shafts) > near


@pytest.mark.parametrize("scheme", ["single-shaft", "four-shaft", "couple-shaft", "slider"])
def test_other_devices_do_so_too(scheme):
    remedy = remedy_for(build(parse(ENGINES["vee"])), scheme)
    assert {d.at for d in remedy.devices if not isinstance(d, Counterweight)} == {(0, 0)}


def test_a_single_shaft_says_what_force_it_leaves():
    """Of an order that nothing on the crankshaft can take."""
    engine = build(parse(UNEVEN))
    remedy = remedy_for(engine, "single-shaft", Wish(order=2))
    left = compute_spectra(fitted(engine, remedy), [2], ("force",)).force.forward[0]
    assert remedy.details["force_with_crank_left_N"] == pytest.approx(abs(left), rel=1e-12)
    assert remedy.details["force_with_crank_left_N"] > 1


def test_a_single_shaft_has_counterweights_at_both_throws():
    """As `auto` has, though one plane would do."""
    assert [
        d.position for d in remedy_for(build(parse(text(0, 0))), "single-shaft").counterweights
    ] == [-50, 50]


def test_the_geometry_of_a_pair_in_the_details():
    engine = build(parse(ENGINES["vee"]))
    remedy = remedy_for(engine, "two-shaft", Wish(order=2, at=(-0.03 + 0.04j, 0.12j)))
    told = remedy.details["order_2"]
    assert (told["radius_against_crank_mm"], told["radius_with_crank_mm"]) == pytest.approx(
        (50, 120)
    )
    assert told["radius_ratio"] == pytest.approx(120 / 50)
    assert (told["direction_with_crank_deg"], told["direction_against_crank_deg"]) == pytest.approx(
        (90, math.degrees(math.atan2(4, -3)))
    )
    before, after = (
        compute_spectra(e, [2], ("moment", "roll")) for e in (engine, fitted(engine, remedy))
    )
    assert told["roll_before_Nm"] == pytest.approx(before.roll.major[0], rel=1e-12)
    assert told["roll_left_Nm"] == pytest.approx(after.roll.major[0], rel=1e-12)
    assert told["moment_left_Nm"] == pytest.approx(after.moment.major[0], rel=1e-9)


def test_four_shafts_are_for_the_orders_that_are_there():
    assert [
        key
        for key in remedy_for(build(parse(ENGINES["four"])), "four-shaft").details
        if key.startswith("order")
    ] == ["order_2"]
    assert {s.ratio for s in remedy_for(star(3), "four-shaft").shafts} == {1, -2}
    assert (
        "there is no free force of orders 1 and 2"
        in remedy_for(build(parse(ENGINES["three"])), "four-shaft").details["note"]
    )


@pytest.mark.parametrize(("order", "turning"), [(2, "against"), (4, "with")])
def test_a_force_in_one_sense_leaves_no_shaft_for_the_roll(order, turning):
    """Of three cylinders in a star, order n turns with the crank if n - 1 is divisible by 3,
    against it if n + 1 is.
    """
    engine = build(parse(text(0, layout="radial = 3")))
    with pytest.raises(
        BalcliError,
        match=f"order {order}: its force turns {turning} the crank alone, so that one shaft takes "
        "it and none",
    ):
        remedy_for(engine, "two-shaft", Wish(order=order, roll="zero"))
    remedy = remedy_for(engine, "two-shaft", Wish(order=order, at=(0.03j,)))
    assert [s.at for s in remedy.shafts] == [(0, 30), (0, -30)]
    assert {s.ratio for s in remedy.shafts} == {order if turning == "with" else -order}
    assert remedy.details[f"order_{order}"][f"direction_{turning}_crank_deg"] == 90
    assert all(
        "in two halves on opposite sides of the crank" in reason for reason in remedy.reasons
    )
    assert [key for key in remedy.details[f"order_{order}"] if key.startswith("radius")] == (
        ["radius_with_crank_mm"] if turning == "with" else ["radius_against_crank_mm"]
    )


def test_couple_shafts_say_what_they_do_and_what_is_left():
    engine = build(parse(ENGINES["vee"]))
    remedy = remedy_for(engine, "couple-shaft", Wish(order=1))
    assert list(remedy.reasons[::2]) == [
        f"Order 1 moment turning {turning} the crank: two opposite eccentrics on a shaft at "
        f"{ratio} times crank speed make the opposite "
        "moment and no force"
        for turning, ratio in (("with", "+1"), ("against", "-1"))
    ]
    after = compute_spectra(fitted(engine, remedy), [1], ("force", "moment"))
    assert after.moment.balanced.all()
    assert (remedy.details["moment_left_Nm"], remedy.details["force_left_N"]) == pytest.approx(
        (0, after.force.major[0]), rel=1e-12
    )


def star(cylinders):
    return build(parse(text(0, layout=f"radial = {cylinders}")))


def test_the_lowest_order_that_is_there_up_to_8():
    """Of a star of k cylinders, order k - 1 is the first that turns against the crank."""
    assert remedy_for(star(9), "single-shaft").order == 8
    assert (
        remedy_for(star(11), "single-shaft")
        .details["note"]
        .startswith(
            "there is no free force turning against the crank of orders 1 to 8: nothing to balance"
        )
    )
    assert remedy_for(star(11), "single-shaft", Wish(order=10)).order == 10
    ninth = build(
        parse(text(0, layout="radial = 10", piston="mass = 1\noffset = 3"))
    )  # an offset makes odd orders
    assert "of orders 1 to 8" in remedy_for(ninth, "single-shaft").details["note"]
    assert remedy_for(ninth, "single-shaft", Wish(order=9)).devices
    weighted = fitted(star(3), remedy_for(star(3), "counterweights"))
    assert remedy_for(weighted, "two-shaft").order == 2
    assert (
        remedy_for(star(3), "two-shaft", Wish(order=1000))
        .details["note"]
        .startswith("order 1000 has no free force: nothing")
    )
    assert [remedy_for(star(3), "two-shaft", Wish(order=order)).order for order in (1, 4)] == [1, 4]


def test_what_else_an_order_has_is_said():
    three, vee = (build(parse(ENGINES[name])) for name in ("three", "four"))
    assert remedy_for(three, "two-shaft", Wish(order=1)).details["note"] == (
        "order 1 has no free force: nothing to balance; it has a free moment: couple-shaft"
    )
    assert remedy_for(vee, "couple-shaft", Wish(order=2)).details["note"] == (
        "order 2 has no free moment: nothing to balance; it has a free force: two-shaft"
    )
    cross = build(
        parse(text(0, 90, 270, 180, layout="bank_angle = 90"))
    )  # a moment with the crank alone
    assert (
        remedy_for(cross, "two-shaft", Wish(order=1))
        .details["note"]
        .endswith("; it has a free moment: couple-shaft")
    )
    assert (
        remedy_for(three, "two-shaft", Wish(order=3)).details["note"]
        == "order 3 has no free force: nothing to balance"
    )


@pytest.mark.parametrize("bank", [-90, -89.5, -0.5, 0, 0.5, 30, 89.5, 90])
def test_sliders_lie_along_the_axes_above_minus_90_up_to_90(bank):
    """One cylinder shakes along its axis, and needs no slider across."""
    single = text(0, layout=f"banks = [{bank}]")
    (along,) = remedy_for(build(parse(single)), "slider", Wish(order=2)).sliders
    assert along.direction == pytest.approx(90 if bank == -90 else bank)
    for half in (25, 35):  # the long axis of the ellipse lies along the bisector, and across it
        two = remedy_for(
            build(parse(text(0, layout=f"banks = [{bank - half}, {bank + half}]"))),
            "slider",
            Wish(order=2),
        ).sliders
        assert all(-90 < s.direction <= 90 for s in two)
        assert abs(two[0].direction - two[1].direction) == pytest.approx(90)


# ------------------------------------------------------------------ the smallest peak
def forces(engine, quantity="force"):
    """Force of all orders."""
    return getattr(compute_spectra(engine, np.arange(1, 41), (quantity,)), quantity)


@pytest.mark.parametrize("more", ["", "[[counterweight]]\nunbalance = 30000\nangle = 170\n"])
def test_minimax_reaches_what_it_says_where_it_says(more):
    """The peak, the crank angles at which it is reached, and the gain over half the reciprocating
    mass, by the analysis.
    """
    engine = build(parse(ENGINES["one"] + more))
    remedy = remedy_for(engine, "minimax")
    told, curve = remedy.details, forces(fitted(engine, remedy))
    assert peak(curve).value == pytest.approx(told["peak_force_N"], rel=1e-12)
    assert len(told["reached_deg"]) == 3
    assert all(0 <= degree < 360 for degree in told["reached_deg"])
    assert np.abs(curve.values(np.radians(told["reached_deg"]))) == pytest.approx(
        told["peak_force_N"], rel=1e-9
    )
    plain = build(parse(ENGINES["one"]))
    half = peak(forces(fitted(plain, remedy_for(plain, "factor")))).value
    assert told["factor_half_peak_N"] == pytest.approx(
        half, rel=1e-12
    )  # without the engine's own weights
    assert told["improvement"] == pytest.approx(1 - told["peak_force_N"] / half, rel=1e-12)


@pytest.mark.parametrize("name", ["one", "two", "vee"])
def test_minimax_knows_its_error(name):
    assert (
        0
        <= remedy_for(build(parse(ENGINES[name])), "minimax").details["relative_error_bound"]
        < 1e-14
    )


def test_minimax_puts_its_angles_in_order_after_they_are_wrapped(monkeypatch):
    """A hair before a whole turn is 0, and stands first."""
    found = circle.Circle(3 + 4j, 1e3, np.array([1.0, 4.0, 2 * np.pi - 1e-14]), 0.0)
    monkeypatch.setattr(circle, "enclose_curve", lambda curve: found)
    told = remedy_for(build(parse(ENGINES["one"])), "minimax").details
    assert told["reached_deg"] == [0, round(math.degrees(1), 9), round(math.degrees(4), 9)]


def test_minimax_with_nothing_to_fit_says_so_and_fits_no_rounding():
    """An in-line four in two planes: neither a force nor a moment turns with the crank."""
    remedy = remedy_for(build(parse(ENGINES["four"])), "minimax", Wish(planes="ends"))
    assert remedy.devices == ()
    assert remedy.details["note"].startswith(
        "no counterweight makes the largest force smaller than it is: "
    )
    assert (remedy.details["improvement"], remedy.details["relative_error_bound"]) == (0, 0)


@pytest.mark.parametrize("slip", [-1e-15, 1e-15])
def test_a_gain_of_rounding_is_none(monkeypatch, slip):
    exact = circle.enclose_curve
    monkeypatch.setattr(
        circle,
        "enclose_curve",
        lambda curve: (found := exact(curve))._replace(radius=found.radius * (1 + slip)),
    )
    told = remedy_for(build(parse(ENGINES["three"])), "minimax", Wish(planes="ends")).details
    assert told["improvement"] == 0


def test_minimax_in_several_planes_takes_the_moment_too():
    engine = build(parse(ENGINES["vee"]))
    one, several = (
        remedy_for(engine, "minimax", Wish(planes=planes)) for planes in (None, (-0.1, 0.17))
    )
    assert sum(
        cmath.rect(d.unbalance, math.radians(d.angle)) for d in several.devices
    ) == pytest.approx(
        cmath.rect(one.devices[0].unbalance, math.radians(one.devices[0].angle)), rel=1e-12
    )
    after = compute_spectra(fitted(engine, several), [1], ("moment",)).moment
    assert abs(after.forward[0]) <= 1e-13 * abs(after.backward[0])
    with pytest.raises(
        BalcliError,
        match=r"--planes: one plane, or planes at the same z, cannot take a moment; "
        r"choose two planes with some distance between them$",
    ):
        remedy_for(engine, "minimax", Wish(planes=(0.1,)))


def test_minimax_without_a_force():
    """Nothing can be gained; a moment turning with the crank is still taken if planes are named."""
    engine = build(parse(ENGINES["three"]))
    remedy = remedy_for(engine, "minimax")
    assert not remedy.devices
    assert "no counterweight makes the largest force smaller than it is" in remedy.details["note"]
    in_planes = remedy_for(engine, "minimax", Wish(planes="ends"))
    assert [d.position for d in in_planes.counterweights] == [-100, 100]
    assert (in_planes.details["improvement"], in_planes.details["relative_error_bound"]) == (0, 0)


def test_minimax_of_an_engine_without_any_force():
    """A boxer twin: whatever one piston does, the other does against it; its moment has a part that
    turns with the crank.
    """
    engine = build(parse(text(0, 180, layout='banks = [0, 180]\nrods = "alternating"')))
    told = remedy_for(engine, "minimax", Wish(planes="ends")).details
    assert (
        told["peak_force_N"],
        told["relative_error_bound"],
        told["factor_half_peak_N"],
        told["improvement"],
    ) == (0, 0, 0, 0)


# ------------------------------------------------------------------ the shop's factor
def test_a_single_factor_is_no_sweep():
    engine = build(parse(ENGINES["vee"]))
    told = remedy_for(engine, "factor", Wish(factor=(0.4,))).details
    assert "sweep" not in told
    assert [
        row["factor"]
        for row in remedy_for(engine, "factor", Wish(factor=(0.4, 0.5))).details["sweep"]
    ] == [0.4, 0.5]
    assert "note" not in told
    assert [(entry["throw"], entry["cylinders"], entry["factor"]) for entry in told["card"]] == [
        (1, [1, 3], 0.4),
        (2, [2, 4], 0.4),
    ]


def test_own_counterweights_are_not_counted_and_said():
    engine = build(
        parse(
            ENGINES["one"]
            + "[[counterweight]]\nunbalance = 1\n[[shaft]]\nratio = 2\nunbalance = 1\n"
        )
    )
    assert (
        remedy_for(engine, "factor").details["note"]
        == "the engine's own counterweights are not counted in the factor"
    )
    shafts = build(parse(ENGINES["one"] + "[[shaft]]\nratio = 2\nunbalance = 1\n"))
    assert "note" not in remedy_for(shafts, "factor").details


def test_peaks_along_and_across_are_those_of_the_curve():
    """Across the first bank, which leans, and off its axis by an offset: samples of what the remedy
    leaves, every 0.01 degrees.
    """
    engine = build(
        parse(ENGINES["vee"].replace("mass = 1\n[layout]", "mass = 1\noffset = 6\n[layout]"))
    )
    told = remedy_for(engine, "factor", Wish(factor=(0.3, 0.7))).details["sweep"]
    for row in told:
        curve = forces(fitted(engine, remedy_for(engine, "factor", Wish(factor=(row["factor"],)))))
        seen = curve.values(np.linspace(0, 2 * np.pi, 36001)) * np.exp(
            1j * np.radians(25)
        )  # the first bank at -25 degrees
        assert row["along_N"] == pytest.approx(np.abs(seen.real).max(), rel=1e-6)
        assert row["across_N"] == pytest.approx(np.abs(seen.imag).max(), rel=1e-6)
        assert abs(row["along_N"] - row["across_N"]) > 1


def test_rods_a_whole_turn_apart_are_on_one_pin():
    engine = build(
        parse(text(0, 90, layout="bank_angle = 60").replace("spacing", "splay = 360\nspacing"))
    )
    remedy = remedy_for(engine, "factor")
    assert [entry["cylinders"] for entry in remedy.details["card"]] == [[1, 3], [2, 4]]
    assert (
        remedy.reasons[0]
        == "Opposite the pin of cylinders 1, 3: all rotating mass and 0.5 of the reciprocating mass"
    )


@pytest.mark.parametrize("share", [-10, 10])
def test_factors_at_their_bounds(share):
    engine = build(parse(ENGINES["one"]))
    assert remedy_for(engine, "factor", Wish(factor=(share,))).details["factor"] == share
    with pytest.raises(
        BalcliError,
        match=r"--factor: give a share of the reciprocating mass such as 0.5, or a range such as "
        r"0:1:0.1$",
    ):
        remedy_for(engine, "factor", Wish(factor=(share * (1 + 1e-15), 0.5)))
