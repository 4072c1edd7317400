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
from support.remedies import figures

from balcli.core import enclosing_circle as circle
from balcli.core.peaks import find_peak
from balcli.engine.build import build
from balcli.engine.load import parse
from balcli.enginefile.model import Counterweight
from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.auto import size_auto
from balcli.sizing.device_tables import (
    make_counterweight,
    make_shaft,
    make_slider,
    measure_direction,
)
from balcli.sizing.effects import Slot, find_effect, solve, solve_exactly
from balcli.sizing.options import SchemeOptions
from balcli.sizing.remedy import Remedy, fit_devices
from balcli.sizing.residual import Part, Point, Residual, find_residual
from balcli.sizing.sizing import size

FORCE, MOMENT = Part("force", 1), Part("moment", 1)
BACK, ROLL = Part("force", -1), Part("roll", 0)
VECTOR = st.complex_numbers(
    min_magnitude=1e-3, max_magnitude=1e3, allow_nan=False, allow_infinity=False
)


def residual(noise: float = 1e-16, **parts: complex) -> Residual:
    """Parts by name: forward, backward, moment, roll."""
    names = {"forward": FORCE, "backward": BACK, "moment": MOMENT, "roll": ROLL}
    found = {names[name]: value for name, value in parts.items()}
    return Residual(2, found, dict.fromkeys(found, noise), Point(0j, 0.0), 1.0)


def text(*throws: float, **tables: str) -> str:
    return engine_text(
        crank=f"stroke = 100\nthrows = {list(throws)}\nspacing = 100\nthrow_mass = 1", **tables
    )


# ------------------------------------------------------------------ solver
@given(VECTOR, VECTOR)
def test_two_planes_take_any_force_and_moment(force, moment):
    slots = [Slot("shaft", 2, 1, z) for z in (-0.3, 0.2)]
    fit = solve(slots, residual(forward=force, moment=moment), (FORCE, MOMENT))
    left = sum(
        find_effect(s.make_device(u), (FORCE, MOMENT), Point(0j, 0.0))
        for s, u in zip(slots, fit.unbalances, strict=True)
    )
    assert left == pytest.approx(
        [-force, -moment], rel=1e-13, abs=1e-13 * (abs(force) + abs(moment))
    )


@given(VECTOR, VECTOR)
def test_sliders_in_two_directions_take_any_ellipse(forward, backward):
    slots = [Slot("slider", 2, 0, 0.0, 0j, direction) for direction in (20, 75)]
    fit = solve(slots, residual(forward=forward, backward=backward), (FORCE, BACK))
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
    asked = residual(forward=1 + 2j, backward=0.5 - 1j, roll=0.3 + 0.1j)
    fit = solve(slots, asked, parts)
    total = sum(
        find_effect(s.make_device(u), parts, Point(0j, 0.0))
        for s, u in zip(slots, fit.unbalances, strict=True)
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
    reference = Point(complex(*engine.reference_m[:2]), float(engine.reference_m[2]))
    u = cmath.rect(2e-3, 0.4)
    table = slot.make_table(u, 0.0)
    with_it = fit_devices(
        engine,
        Remedy("", sliders=(table,)) if slot.kind == "slider" else Remedy("", shafts=(table,)),
    )
    parts = [Part(q, s) for q in ("force", "moment") for s in (1, -1)] + [ROLL]
    before, after = find_residual(engine, 2), find_residual(with_it, 2)
    change = np.array([after.parts[p] - before.parts[p] for p in parts])
    assert change == pytest.approx(find_effect(slot.make_device(u), parts, reference), abs=1e-14)


def test_more_slots_than_needed_share_the_work():
    """The least sum of squares: at every throw of a row, equal weights for a force."""
    fit = solve(
        [Slot("counterweight", 1, 1, z) for z in (-0.1, 0.0, 0.1)],
        residual(forward=3, moment=0),
        (FORCE, MOMENT),
    )
    assert fit.unbalances == pytest.approx([-1, -1, -1])


def test_of_more_slots_than_needed_the_far_ones_do_most():
    """The least sum of squares that makes a moment: unbalances in proportion to the arms, `u = -m z
    / sum z^2`.
    """
    places = np.array([-0.1, 0.2, 0.4])
    fit = solve(
        [Slot("counterweight", 1, 1, z) for z in places], residual(moment=0.21 - 0.42j), (MOMENT,)
    )
    assert fit.unbalances == pytest.approx(-(0.21 - 0.42j) * places / 0.21, rel=1e-14)


@pytest.mark.parametrize("force", [3.7, -3.7, 0.3j, -0.3j])
def test_what_is_not_needed_is_exactly_nothing(force):
    """A force in one of the two planes; its part that is 0 stays 0, so that angles are plain."""
    slots = [Slot("counterweight", 1, 1, z) for z in (-0.13, 0.29)]
    fit = solve_exactly(slots, residual(forward=force, moment=-0.13 * force), (FORCE, MOMENT), "")
    assert fit.unbalances == (pytest.approx(-force, rel=1e-14), 0)
    assert 0 in (fit.unbalances[0].real, fit.unbalances[0].imag)


@pytest.mark.parametrize("scale", [1e-9, 1, 1e9])
def test_one_slot_does_what_it_can(scale):
    """Least squares of force and of moment over the arm: u = -(f + m/z)/2 at z."""
    asked = residual(noise=1e-16 * scale, forward=scale, moment=0.6 * scale)
    fit = solve([Slot("counterweight", 1, 1, 0.2)], asked, (FORCE, MOMENT))
    assert fit.unbalances == pytest.approx([-(1 + 0.6 / 0.2) / 2 * scale])
    assert fit.left == pytest.approx(1 / 5**0.5)  # (f - m/z)/sqrt 2 of |f, m/z|, f = 1, m/z = 3
    with pytest.raises(BalcliError, match="the reason"):
        solve_exactly([Slot("counterweight", 1, 1, 0.2)] * 2, asked, (FORCE, MOMENT), "the reason")


def test_arms_count_from_the_point_of_reference_in_all_directions():
    """A slot beside the crank on that point's own axis has no arm but along it: u = -(f + m/z)/2 at
    z from there.
    """
    asked = residual(forward=1, moment=0.6)._replace(reference=Point(0.3 + 0.4j, 0.1))
    fit = solve([Slot("shaft", 2, 1, 0.3, 0.3 + 0.4j)], asked, (FORCE, MOMENT))
    assert fit.unbalances == pytest.approx([-(1 + 0.6 / 0.2) / 2])


def test_a_slot_without_an_arm_can_do_nothing_about_a_moment():
    fit = solve([Slot("shaft", 2, 1, 0.0)], residual(moment=1), (MOMENT,))
    assert fit == ((0,), math.inf, 1)


# ------------------------------------------------------------------ tables
@given(st.floats(-720, 720), st.floats(-180, 180))
def test_angles_come_back(angle, origin):
    found = measure_direction(cmath.rect(1, math.radians(angle)), origin)
    assert -180 < found <= 180
    assert (found + origin - angle + 180) % 360 - 180 == pytest.approx(0, abs=1e-11)


@pytest.mark.parametrize("angle", [0, 15, 22.5, 30, 45, 90, 120, 135, 180, -30, -54, -162])
def test_plain_angles_are_written_plainly(angle):
    assert measure_direction(cmath.rect(3e-5, math.radians(angle))) == angle


def test_tables_are_in_the_units_of_the_file():
    weight = make_counterweight(-2e-3 + 0j, -0.0425, 45.0)
    assert (weight.unbalance, weight.angle, weight.position) == (2000.0, 135.0, -42.5)
    turning = make_shaft(1e-3j, -2, 0.1, -0.04 + 0.06j)
    assert (turning.ratio, turning.unbalance, turning.angle, turning.at, turning.position) == (
        -2,
        1000.0,
        90.0,
        (-40.0, 60.0),
        100.0,
    )
    sliding = make_slider(-1e-3 + 0j, 2, 90.0, 0.0, 0j)
    assert (sliding.order, sliding.unbalance, sliding.direction, sliding.angle) == (
        2,
        1000.0,
        90.0,
        180.0,
    )


def test_places_are_written_as_people_would():
    """Tenths of a millimetre, whatever metres times 1000 is in binary; and 0 without a sign."""
    assert all(
        make_counterweight(1e-3, tenth / 1e4, 0.0).position == tenth / 10
        for tenth in range(-3000, 3001)
    )
    nothing = make_counterweight(complex(1e-3, -0.0), -0.0, 0.0)
    assert (str(nothing.position), str(nothing.angle)) == ("0.0", "0.0")
    assert (
        make_counterweight(1e-3, 0.1 / 3, 0.0).position == 100 / 3
    )  # what has no short form keeps its digits


# ------------------------------------------------------------------ auto
def test_every_device_has_its_reason():
    remedy = size_auto(build(parse(text(0, 240, 120))))
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
        size_auto(build(parse(text(*throws, **more)))).reasons
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
    assert not size_auto(fit_devices(engine, size_auto(engine))).devices


def test_own_devices_count():
    engine = build(parse(text(0, 180, 180, 0)))
    half = Remedy("", shafts=size_auto(engine).shafts[:1])
    assert [s.ratio for s in size_auto(fit_devices(engine, half)).shafts] == [-2]


def test_staggered_rods_on_one_throw_get_planes_at_the_outer_cylinders():
    remedy = size_auto(build(parse(text(0, layout="bank_angle = 60\nstagger = 24"))))
    assert {d.position for d in remedy.counterweights} == {
        0.0
    }  # forward vectors of both rods lie on the pin
    assert {d.position for d in remedy.shafts if d.ratio == -1} == {-12.0, 12.0}


def test_sizing_does_not_depend_on_speed():
    slow, fast = (
        size_auto(build(parse(text(0, 90, 200) + f"[operation]\nspeed = {rpm}\n")))
        for rpm in (10, 20000)
    )
    assert [d.unbalance for d in slow.devices] == pytest.approx(
        [d.unbalance for d in fast.devices], rel=1e-12
    )


def test_devices_are_summed_in_the_order_of_the_file():
    engine = build(
        parse(text(0, 240, 120) + "[[slider]]\norder = 2\nunbalance = 3\ndirection = 10\n")
    )
    ranks = [d.rank for d in fit_devices(engine, size_auto(engine)).devices]
    assert ranks == sorted(ranks)
    assert compute_spectra(
        fit_devices(engine, size_auto(engine)), [1], ("force",)
    ).force.balanced.all()


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
    here, there = (size(e, scheme) for e in (plain, moved))
    assert len(there.devices) == len(here.devices)
    for one, other in zip(devices(here), devices(there), strict=True):
        assert other == pytest.approx(one, rel=1e-10, abs=1e-9)
    if scheme == "single-shaft":
        assert figures(there)["axial distance"] == pytest.approx(
            figures(here)["axial distance"], rel=1e-9, abs=1e-9
        )


def test_no_roll_about_the_crank_whatever_the_point_of_reference():
    """A given first shaft, the second placed for no roll: the same about any point, the force being
    cancelled.
    """
    options = SchemeOptions(at=(-0.04 + 0.06j,), roll="zero")
    plain, moved = (
        build(parse(ENGINES["four"] + frame))
        for frame in ("", "[frame]\nreference = [30, -20, 170]\n")
    )
    here, there = (devices(size(e, "two-shaft", options)) for e in (plain, moved))
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
    (weight,) = size(replace(engine, cylinders=cylinders), "factor").counterweights
    assert weight.position == 0


def test_a_shaft_where_the_force_acts_is_at_no_distance_from_it():
    """Not at one of 1e-15 mm."""
    engine = build(
        parse(
            engine_text(crank="stroke = 100\nthrows = [0, 90]\npositions = [0, 33.3]")
            + "[cylinder.2]\npiston_mass = 1.7\n"
        )
    )
    remedy = size(engine, "single-shaft", SchemeOptions(order=1))
    assert remedy.shafts[0].position > 0
    assert figures(remedy)["axial distance"] == 0


def test_places_along_the_crank_are_figures_that_people_can_read():
    """Where two forces act together: `(m1 z1 + m2 z2)/(m1 + m2)`, in mm."""
    crank = "stroke = 100\nthrows = [0, 0]\npositions = [{}, {}]"
    for first, second in ((-50, 50), (17.3, 94.1), (-211.7, 3.3), (0, 100)):
        for share in (1, 3, 9):
            crank_text = crank.format(first, second)
            remedy = size_auto(
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
    (weight,) = size(engine, "minimax").counterweights
    assert weight.position == 60
    (weight,) = size(engine, "minimax", SchemeOptions(position=-0.02)).counterweights
    assert weight.position == -20


def test_a_single_device_has_no_condition_number():
    """Of two planes at equal distance from the middle it is 1."""
    assert "condition number" not in figures(size(build(parse(ENGINES["four"])), "single-shaft"))
    assert figures(size_auto(build(parse(ENGINES["three"]))))["condition number"] == pytest.approx(
        1, rel=1e-14
    )
    balanced = build(parse(text(0, 240, 120, 120, 240, 0)))
    assert not size_auto(balanced).details


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
    remedy = size(build(parse((ENGINES | {"centred": text(0)})[name])), scheme)
    assert (remedy.scheme, remedy.order) == (scheme, order)


OPTIONS = {
    "order": 2,
    "at": (0.02 + 0.03j,),
    "position": 0.033,
    "planes": (-0.02, 0.09),
    "factor": (0.3,),
    "measured": 1.9,
    "roll": "zero",
}
TAKEN = {
    "auto": "",
    "counterweights": "order planes",
    "factor": "factor measured planes",
    "minimax": "planes position",
    "four-shaft": "at position",
    "single-shaft": "order at position planes",
    "two-shaft": "order at position roll",
    "couple-shaft": "order at planes",
    "slider": "order at position",
}


@pytest.mark.parametrize("option", OPTIONS)
@pytest.mark.parametrize("scheme", TAKEN)
def test_an_option_makes_a_difference_or_is_refused(scheme, option):
    engine = build(parse(ENGINES["vee"]))
    options = SchemeOptions(
        **{option: 1 if scheme == "counterweights" and option == "order" else OPTIONS[option]}
    )
    if option not in TAKEN[scheme]:
        with pytest.raises(
            BalcliError, match=f"scheme {scheme} has no --{option}; (it takes|add --scheme with)"
        ):
            size(engine, scheme, options)
    elif (scheme, option) != ("counterweights", "order"):
        assert devices(size(engine, scheme, options)) != devices(size(engine, scheme))


def test_planes_are_named_or_given():
    engine = build(parse(ENGINES["vee"]))
    with pytest.raises(
        BalcliError,
        match=r'--planes "left": give ends, throws, or places along z in mm, such as -200,200$',
    ):
        size(engine, "counterweights", SchemeOptions(planes="left"))
    with pytest.raises(
        BalcliError,
        match=r"--planes: opposite eccentrics stand in two planes; give ends, or two places along "
        r"z in mm, "
        r"such as -200,200$",
    ):
        size(engine, "couple-shaft", SchemeOptions(planes=(-0.1, 0.0, 0.1)))
    ends = [
        devices(size(engine, "couple-shaft", SchemeOptions(planes=planes)))
        for planes in (None, "ends", (-0.05, 0.05))
    ]
    assert ends[0] == ends[1] == ends[2]
    with pytest.raises(BalcliError, match=r"--at: this scheme has one place; give it once$"):
        size(engine, "slider", SchemeOptions(at=(0j, 1j)))


@pytest.mark.parametrize("place", [0.0, 0.1])
def test_what_a_single_plane_leaves_is_said(place):
    """Away from the middle, force and moment both."""
    engine = build(parse(ENGINES["vee"]))
    remedy = size(engine, "counterweights", SchemeOptions(planes=(place,)))
    after = compute_spectra(fit_devices(engine, remedy), [1], ("force", "moment"))
    assert figures(remedy)["left force"] == pytest.approx(
        abs(after.force.forward[0]), rel=1e-9, abs=1e-9
    )
    assert (figures(remedy)["left force"] > 1) == (place != 0)
    assert figures(remedy)["left moment"] == pytest.approx(abs(after.moment.forward[0]), rel=1e-12)
    assert figures(remedy)["left moment"] > 1
    assert remedy.note.startswith("one plane, or planes at the same z, cannot take a moment")


def test_without_a_scheme_it_is_auto():
    engine = build(parse(ENGINES["three"]))
    assert size(engine) == size(engine, "auto") == size_auto(engine)


# ------------------------------------------------------------------ shafts and sliders
@pytest.mark.parametrize("name", ["two", "vee", "uneven"])
def test_a_single_shaft_stands_where_its_couple_is_smallest(name):
    engine = build(parse(UNEVEN if name == "uneven" else ENGINES[name]))
    here = size(engine, "single-shaft")
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
        there = size(engine, "single-shaft", SchemeOptions(position=other))
        assert figures(here)["couple left"] <= figures(there)["couple left"] * (1 + 1e-12) + 1e-12
        left = compute_spectra(fit_devices(engine, there), [here.order], ("moment", "roll"))
        assert figures(there)["couple left"] == pytest.approx(
            abs(left.moment.backward[0]), rel=1e-9, abs=1e-9
        )
        assert figures(there)["roll left"] == pytest.approx(left.roll.major[0], rel=1e-12)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("bank", [50, 130])
def test_sliders_stand_where_the_stronger_part_acts(bank, order):
    """Between the throws, so that it leaves the least moment."""
    engine = build(parse(UNEVEN.replace("bank_angle = 50", f"bank_angle = {bank}")))
    force = compute_spectra(engine, [order], ("force",)).force
    stronger = "forward" if abs(force.forward[0]) > abs(force.backward[0]) else "backward"
    place = size(engine, "slider", SchemeOptions(order=order)).sliders[0].position / 1e3

    def left(position):
        after = fit_devices(
            engine, size(engine, "slider", SchemeOptions(order=order, position=position))
        )
        return abs(getattr(compute_spectra(after, [order], ("moment",)).moment, stronger)[0])

    least = left(place) * (1 - 1e-9) - 1e-9
    assert all(
        left(min(max(other, -0.06), 0.06)) >= least
        for other in (-0.06, 0.0, 0.06, place - 1e-3, place + 1e-3)
    )


def test_a_pair_of_shafts_stands_on_the_crank_axis_if_nothing_is_said():
    remedy = size(build(parse(ENGINES["vee"])), "two-shaft")
    assert [s.at for s in remedy.shafts] == [(0, 0), (0, 0)]
    assert remedy.reasons[0] == (
        "Order 1 force turning against the crank: nothing on the crankshaft can cancel it; "
        "one eccentric on a shaft at -1 times crank speed can; a moment stays, which takes "
        "eccentrics in two planes"
    )
    assert "radius ratio" not in figures(remedy, "order 1")


@pytest.mark.parametrize("frame", ["", "[frame]\nreference = [30, -20, 170]\n"])
@pytest.mark.parametrize("order", [1, 2])
def test_no_roll_by_the_nearest_places(order, frame):
    """Of all pairs of places that take force and roll, those with the least sum of squares; about
    the crank axis.
    """
    at_crank = build(parse(UNEVEN))
    options = SchemeOptions(order=order, roll="zero")
    remedy = size(build(parse(UNEVEN + frame)), "two-shaft", options)
    before, after = (
        compute_spectra(e, [order], ("force", "roll"))
        for e in (at_crank, fit_devices(at_crank, remedy))
    )
    assert after.force.balanced.all()
    assert after.roll.major[0] <= 1e-13 * before.roll.major[0]
    near = sum(abs(complex(*s.at)) ** 2 for s in remedy.shafts)
    first = complex(*next(s.at for s in remedy.shafts if s.ratio < 0)) / 1e3
    for step in (1e-3, 1e-3j, -1e-3, -1e-3j):
        other = size(
            at_crank, "two-shaft", SchemeOptions(order=order, roll="zero", at=(first + step,))
        )
        assert sum(abs(complex(*s.at)) ** 2 for s in other.shafts) > near


@pytest.mark.parametrize("scheme", ["single-shaft", "four-shaft", "couple-shaft", "slider"])
def test_other_devices_do_so_too(scheme):
    remedy = size(build(parse(ENGINES["vee"])), scheme)
    assert {d.at for d in remedy.devices if not isinstance(d, Counterweight)} == {(0, 0)}


def test_a_single_shaft_says_what_force_it_leaves():
    """Of an order that nothing on the crankshaft can take."""
    engine = build(parse(UNEVEN))
    remedy = size(engine, "single-shaft", SchemeOptions(order=2))
    left = compute_spectra(fit_devices(engine, remedy), [2], ("force",)).force.forward[0]
    assert figures(remedy)["force with crank left"] == pytest.approx(abs(left), rel=1e-12)
    assert figures(remedy)["force with crank left"] > 1


def test_a_single_shaft_has_counterweights_at_both_throws():
    """As `auto` has, though one plane would do."""
    assert [d.position for d in size(build(parse(text(0, 0))), "single-shaft").counterweights] == [
        -50,
        50,
    ]


def test_the_geometry_of_a_pair_in_the_details():
    engine = build(parse(ENGINES["vee"]))
    remedy = size(engine, "two-shaft", SchemeOptions(order=2, at=(-0.03 + 0.04j, 0.12j)))
    told = figures(remedy, "order 2")
    assert (told["radius against crank"], told["radius with crank"]) == pytest.approx((0.05, 0.12))
    assert told["radius ratio"] == pytest.approx(120 / 50)
    assert (told["direction with crank"], told["direction against crank"]) == pytest.approx(
        (90, math.degrees(math.atan2(4, -3)))
    )
    before, after = (
        compute_spectra(e, [2], ("moment", "roll")) for e in (engine, fit_devices(engine, remedy))
    )
    assert told["roll before"] == pytest.approx(before.roll.major[0], rel=1e-12)
    assert told["roll left"] == pytest.approx(after.roll.major[0], rel=1e-12)
    assert told["moment left"] == pytest.approx(after.moment.major[0], rel=1e-9)


def test_four_shafts_are_for_the_orders_that_are_there():
    assert {
        detail.group for detail in size(build(parse(ENGINES["four"])), "four-shaft").details
    } == {"order 2"}
    assert {s.ratio for s in size(star(3), "four-shaft").shafts} == {1, -2}
    assert (
        "there is no free force of orders 1 and 2"
        in size(build(parse(ENGINES["three"])), "four-shaft").note
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
        size(engine, "two-shaft", SchemeOptions(order=order, roll="zero"))
    remedy = size(engine, "two-shaft", SchemeOptions(order=order, at=(0.03j,)))
    assert [s.at for s in remedy.shafts] == [(0, 30), (0, -30)]
    assert {s.ratio for s in remedy.shafts} == {order if turning == "with" else -order}
    told = figures(remedy, f"order {order}")
    assert told[f"direction {turning} crank"] == 90
    assert all(
        "in two halves on opposite sides of the crank" in reason for reason in remedy.reasons
    )
    assert [key for key in told if key.startswith("radius")] == [f"radius {turning} crank"]


def test_couple_shafts_say_what_they_do_and_what_is_left():
    engine = build(parse(ENGINES["vee"]))
    remedy = size(engine, "couple-shaft", SchemeOptions(order=1))
    assert list(remedy.reasons[::2]) == [
        f"Order 1 moment turning {turning} the crank: two opposite eccentrics on a shaft at "
        f"{ratio} times crank speed make the opposite "
        "moment and no force, wherever the shaft stands"
        for turning, ratio in (("with", "+1"), ("against", "-1"))
    ]
    after = compute_spectra(fit_devices(engine, remedy), [1], ("force", "moment"))
    assert after.moment.balanced.all()
    assert (figures(remedy)["moment left"], figures(remedy)["force left"]) == pytest.approx(
        (0, after.force.major[0]), rel=1e-12
    )


def star(cylinders):
    return build(parse(text(0, layout=f"radial = {cylinders}")))


def test_the_lowest_order_that_is_there_up_to_8():
    """Of a star of k cylinders, order k - 1 is the first that turns against the crank."""
    assert size(star(9), "single-shaft").order == 8
    assert size(star(11), "single-shaft").note.startswith(
        "there is no free force turning against the crank of orders 1 to 8: nothing to balance"
    )
    assert size(star(11), "single-shaft", SchemeOptions(order=10)).order == 10
    ninth = build(
        parse(text(0, layout="radial = 10", piston="mass = 1\noffset = 3"))
    )  # an offset makes odd orders
    assert "of orders 1 to 8" in size(ninth, "single-shaft").note
    assert size(ninth, "single-shaft", SchemeOptions(order=9)).devices
    weighted = fit_devices(star(3), size(star(3), "counterweights"))
    assert size(weighted, "two-shaft").order == 2
    assert size(star(3), "two-shaft", SchemeOptions(order=1000)).note.startswith(
        "order 1000 has no free force: nothing"
    )
    assert [size(star(3), "two-shaft", SchemeOptions(order=order)).order for order in (1, 4)] == [
        1,
        4,
    ]


def test_what_else_an_order_has_is_said():
    three, vee = (build(parse(ENGINES[name])) for name in ("three", "four"))
    assert size(three, "two-shaft", SchemeOptions(order=1)).note == (
        "order 1 has no free force: nothing to balance; it has a free moment: couple-shaft"
    )
    assert size(vee, "couple-shaft", SchemeOptions(order=2)).note == (
        "order 2 has no free moment: nothing to balance; it has a free force: two-shaft"
    )
    cross = build(
        parse(text(0, 90, 270, 180, layout="bank_angle = 90"))
    )  # a moment with the crank alone
    assert size(cross, "two-shaft", SchemeOptions(order=1)).note.endswith(
        "; it has a free moment: couple-shaft"
    )
    assert (
        size(three, "two-shaft", SchemeOptions(order=3)).note
        == "order 3 has no free force: nothing to balance"
    )


@pytest.mark.parametrize("bank", [-90, -89.5, -0.5, 0, 0.5, 30, 89.5, 90])
def test_sliders_lie_along_the_axes_above_minus_90_up_to_90(bank):
    """One cylinder shakes along its axis, and needs no slider across."""
    single = text(0, layout=f"banks = [{bank}]")
    (along,) = size(build(parse(single)), "slider", SchemeOptions(order=2)).sliders
    assert along.direction == pytest.approx(90 if bank == -90 else bank)
    for half in (25, 35):  # the long axis of the ellipse lies along the bisector, and across it
        two = size(
            build(parse(text(0, layout=f"banks = [{bank - half}, {bank + half}]"))),
            "slider",
            SchemeOptions(order=2),
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
    remedy = size(engine, "minimax")
    told, curve = figures(remedy), forces(fit_devices(engine, remedy))
    assert find_peak(curve).value == pytest.approx(told["peak force"], rel=1e-12)
    assert len(told["reached"]) == 3
    assert all(0 <= degree < 360 for degree in told["reached"])
    assert np.abs(curve.values(np.radians(told["reached"]))) == pytest.approx(
        told["peak force"], rel=1e-9
    )
    plain = build(parse(ENGINES["one"]))
    half = find_peak(forces(fit_devices(plain, size(plain, "factor")))).value
    assert told["factor half peak"] == pytest.approx(
        half, rel=1e-12
    )  # without the engine's own weights
    assert told["improvement"] == pytest.approx(1 - told["peak force"] / half, rel=1e-12)


@pytest.mark.parametrize("name", ["one", "two", "vee"])
def test_minimax_knows_its_error(name):
    assert (
        0 <= figures(size(build(parse(ENGINES[name])), "minimax"))["relative error bound"] < 1e-14
    )


def test_minimax_puts_its_angles_in_order_after_they_are_wrapped(monkeypatch):
    """A hair before a whole turn is 0, and stands first."""
    found = circle.Circle(3 + 4j, 1e3, np.array([1.0, 4.0, 2 * np.pi - 1e-14]), 0.0)
    monkeypatch.setattr(circle, "enclose_curve", lambda curve: found)
    told = figures(size(build(parse(ENGINES["one"])), "minimax"))
    assert told["reached"] == (0, round(math.degrees(1), 9), round(math.degrees(4), 9))


def test_minimax_with_nothing_to_fit_says_so_and_fits_no_rounding():
    """An in-line four in two planes: neither a force nor a moment turns with the crank."""
    remedy = size(build(parse(ENGINES["four"])), "minimax", SchemeOptions(planes="ends"))
    assert remedy.devices == ()
    assert remedy.note.startswith("no counterweight makes the largest force smaller than it is: ")
    assert (figures(remedy)["improvement"], figures(remedy)["relative error bound"]) == (0, 0)


@pytest.mark.parametrize("slip", [-1e-15, 1e-15])
def test_a_gain_of_rounding_is_none(monkeypatch, slip):
    exact = circle.enclose_curve
    monkeypatch.setattr(
        circle,
        "enclose_curve",
        lambda curve: (found := exact(curve))._replace(radius=found.radius * (1 + slip)),
    )
    engine = build(parse(ENGINES["three"]))
    told = figures(size(engine, "minimax", SchemeOptions(planes="ends")))
    assert told["improvement"] == 0


def test_minimax_in_several_planes_takes_the_moment_too():
    engine = build(parse(ENGINES["vee"]))
    one, several = (
        size(engine, "minimax", SchemeOptions(planes=planes)) for planes in (None, (-0.1, 0.17))
    )
    assert sum(
        cmath.rect(d.unbalance, math.radians(d.angle)) for d in several.devices
    ) == pytest.approx(
        cmath.rect(one.devices[0].unbalance, math.radians(one.devices[0].angle)), rel=1e-12
    )
    after = compute_spectra(fit_devices(engine, several), [1], ("moment",)).moment
    assert abs(after.forward[0]) <= 1e-13 * abs(after.backward[0])
    with pytest.raises(
        BalcliError,
        match=r"--planes: one plane, or planes at the same z, cannot take a moment; "
        r"choose two planes with some distance between them$",
    ):
        size(engine, "minimax", SchemeOptions(planes=(0.1,)))


def test_minimax_without_a_force():
    """Nothing can be gained; a moment turning with the crank is still taken if planes are named."""
    engine = build(parse(ENGINES["three"]))
    remedy = size(engine, "minimax")
    assert not remedy.devices
    assert "no counterweight makes the largest force smaller than it is" in remedy.note
    in_planes = size(engine, "minimax", SchemeOptions(planes="ends"))
    assert [d.position for d in in_planes.counterweights] == [-100, 100]
    assert (figures(in_planes)["improvement"], figures(in_planes)["relative error bound"]) == (0, 0)


def test_minimax_of_an_engine_without_any_force():
    """A boxer twin: whatever one piston does, the other does against it; its moment has a part that
    turns with the crank.
    """
    engine = build(parse(text(0, 180, layout='banks = [0, 180]\nrods = "alternating"')))
    told = figures(size(engine, "minimax", SchemeOptions(planes="ends")))
    assert (
        told["peak force"],
        told["relative error bound"],
        told["factor half peak"],
        told["improvement"],
    ) == (0, 0, 0, 0)


# ------------------------------------------------------------------ the shop's factor
def test_a_single_factor_is_no_sweep():
    engine = build(parse(ENGINES["vee"]))
    remedy = size(engine, "factor", SchemeOptions(factor=(0.4,)))
    assert not remedy.sweep
    swept = size(engine, "factor", SchemeOptions(factor=(0.4, 0.5))).sweep
    assert [peaks.factor for peaks in swept] == [0.4, 0.5]
    assert not remedy.note
    assert [(entry.throw, entry.cylinders, entry.factor) for entry in remedy.card] == [
        (1, (1, 3), 0.4),
        (2, (2, 4), 0.4),
    ]


def test_peaks_along_and_across_are_those_of_the_curve():
    """Across the first bank, which leans, and off its axis by an offset: samples of what the remedy
    leaves, every 0.01 degrees.
    """
    engine = build(
        parse(ENGINES["vee"].replace("mass = 1\n[layout]", "mass = 1\noffset = 6\n[layout]"))
    )
    for row in size(engine, "factor", SchemeOptions(factor=(0.3, 0.7))).sweep:
        curve = forces(
            fit_devices(engine, size(engine, "factor", SchemeOptions(factor=(row.factor,))))
        )
        seen = curve.values(np.linspace(0, 2 * np.pi, 36001)) * np.exp(
            1j * np.radians(25)
        )  # the first bank at -25 degrees
        assert row.along == pytest.approx(np.abs(seen.real).max(), rel=1e-6)
        assert row.across == pytest.approx(np.abs(seen.imag).max(), rel=1e-6)
        assert abs(row.along - row.across) > 1


def test_rods_a_whole_turn_apart_are_on_one_pin():
    engine = build(
        parse(text(0, 90, layout="bank_angle = 60").replace("spacing", "splay = 360\nspacing"))
    )
    remedy = size(engine, "factor")
    assert [entry.cylinders for entry in remedy.card] == [(1, 3), (2, 4)]
    assert (
        remedy.reasons[0]
        == "Opposite the pin of cylinders 1, 3: all rotating mass and 0.5 of the reciprocating mass"
    )


@pytest.mark.parametrize("share", [-10, 10])
def test_factors_at_their_bounds(share):
    engine = build(parse(ENGINES["one"]))
    assert figures(size(engine, "factor", SchemeOptions(factor=(share,))))["factor"] == share
    with pytest.raises(
        BalcliError,
        match=r"--factor -?10: is no share of the reciprocating mass; (did you mean 10%\? )?give one such as 0.5 or 51%, "
        r"or a range such as 50%:54%:1%$",
    ):
        size(engine, "factor", SchemeOptions(factor=(share * (1 + 1e-15), 0.5)))


@pytest.mark.parametrize("scheme", ["auto", "counterweights", "factor", "minimax"])
def test_dust_of_an_unbalance_is_no_device(scheme):
    """Half of both pistons of a 90-degree twin, and a milliardth of a gram millimetre more or less:
    more than rounding, less than anybody could drill.
    """
    vee = text(0, layout="bank_angle = 90")
    (whole,) = size(build(parse(vee)), "factor").counterweights
    for dust in (1e-9, -1e-9):
        weight = f"[[counterweight]]\nunbalance = {whole.unbalance + dust!r}\nangle = 180\n"
        remedy = size(build(parse(vee + weight)), scheme)
        assert not remedy.counterweights
        if scheme == "counterweights":
            assert remedy.note.startswith("there is no free force or moment of order 1 turning")
