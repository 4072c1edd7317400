"""What must hold for every engine, on random ones: turned, mirrored, shifted, split, sped up, renumbered.

Engines are drawn as the tables of an engine file and pass through the loader, so that all ways to
say a thing are met.
Tolerance: 1e-12 of the largest order of the quantity, or of what single cylinders make where they
cancel, and the bound of the rounding error that both sides state (a place 158 mm away is not known
to 1e-12 of a spacing of 4 um).
"""

import copy
from typing import Any

import numpy as np
import pytest
import tomli_w
from hypothesis import given, settings, strategies as st
from support.engines import alone, build_text

from balcli.core.phasors import Phasors
from balcli.engine.engine import Engine
from balcli.forces.kinds import KINDS
from balcli.forces.spectrum import Spectra, compute_spectra

pytestmark = pytest.mark.stress

SCALED = 1e-12
ORDERS = np.arange(0.0, 9.0)
quick = settings(max_examples=25, deadline=None, derandomize=True, database=None)

RIPPLE = [{"order": 2, "amplitude": 0.1, "angle": 20}, {"order": 3, "amplitude": 0.05, "angle": -110}]

Tables = dict[str, Any]


# ------------------------------------------------------------------ random engines
def figures(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False).map(lambda x: round(x, 6))


angles = st.one_of(st.sampled_from([0, 30, 45, 60, 90, 120, 180, 240, 270, -90]), figures(-360, 360))
places = figures(-300, 300)
points = st.lists(places, min_size=2, max_size=2)


@st.composite
def rods(draw: st.DrawFn) -> Tables:
    """Long enough to turn with any piston offset of `engines`; by mass and place or weighed at its ends."""
    length = draw(figures(110, 400))
    masses = draw(
        st.one_of(
            st.just({}),
            st.fixed_dictionaries({"mass": figures(0.1, 3), "cg": figures(0, 100)}),
            st.fixed_dictionaries({"small_end": figures(0, 1), "big_end": figures(0.01, 2)}),
        )
    )
    return {"length": length, **masses, **draw(st.sampled_from([{}, {"inertia": 3000.0}, {"inertia": 0.0}]))}


def devices(**more: st.SearchStrategy[Any]) -> st.SearchStrategy[Tables]:
    return st.fixed_dictionaries({"unbalance": figures(-1e5, 1e5), "angle": angles, "position": places, **more})


@st.composite
def engines(draw: st.DrawFn) -> Tables:
    throws = draw(st.lists(angles, min_size=1, max_size=5))
    layout = draw(
        st.one_of(
            st.just({}),
            st.fixed_dictionaries({"bank_angle": angles, "stagger": figures(-30, 30)}),
            st.fixed_dictionaries({"banks": st.lists(angles, min_size=1, max_size=3), "stagger": figures(0, 30)}),
            st.fixed_dictionaries({"radial": st.integers(1, 7)}),
        )
    )
    offset = draw(st.sampled_from([0.0, 0.0, 1.6, -12.0]))
    model: Tables = {
        "crank": {
            "stroke": draw(figures(60, 140)),
            "throws": throws,
            "spacing": draw(figures(0, 150)),
            "throw_mass": draw(figures(0, 5)),
            "splay": draw(st.sampled_from([0, 0, -30, 22.5])),
        },
        "rod": draw(rods()),
        "piston": {"mass": draw(figures(0, 3)), "offset": offset},
        "layout": layout,
        "operation": {"speed": draw(figures(500, 8000)), "speed_ripple": draw(st.sampled_from([[], [], RIPPLE]))},
        "frame": {"reference": [draw(figures(-100, 100)) for _ in range(3)]},
        "counterweight": [draw(devices())],
        "shaft": [draw(devices(ratio=st.sampled_from([-2, -1, 1, 2, 3]), at=points))],
        "slider": [draw(devices(order=st.integers(1, 4), direction=angles, at=points))],
    }
    if draw(st.booleans()):
        first = {"piston_mass": draw(figures(0, 3)), "piston_offset": draw(figures(-10, 10))}
        model["cylinder"] = {"1": first | {"rod_length": draw(figures(150, 300))}}
    return model


def made(model: Tables) -> Engine:
    return build_text(tomli_w.dumps(model))


def changed(model: Tables, change: Any) -> Tables:
    """A copy, changed in place by the function."""
    other = copy.deepcopy(model)
    change(other)
    return other


def without_devices(model: Tables) -> Tables:
    return changed(model, lambda m: [m.pop(key) for key in ("counterweight", "shaft", "slider")])


# ------------------------------------------------------------------ comparison
def found(engine: Engine) -> Spectra:
    return compute_spectra(engine, ORDERS)


def sizes(engine: Engine) -> dict[str, float]:
    """What cylinders and devices make of each quantity by themselves."""
    parts = [alone(engine, n) for n in engine.numbers]
    total = dict.fromkeys(KINDS, 0.0)
    for part in [engine, *parts]:
        for q, p in found(part).items():
            total[q.name] += float(p.major.max())
    for d in engine.devices:
        force = (abs(d.forward) + abs(d.backward)) * d.order**2 * engine.omega**2
        for q, arm in (("force", 1.0), ("moment", 1.0), ("couple", 1.0), ("roll", 1.0)):
            total[q] += force * arm
    return {q: size or 1.0 for q, size in total.items()}


def rounding(*phasors: Phasors) -> float:
    """The rounding error that these state."""
    return sum(float(np.max(p.noise)) for p in phasors)


def assert_same(
    one: Engine, other: Engine, *, forward: complex = 1, by: float = 1.0, quantities: tuple[str, ...] = tuple(KINDS)
) -> None:
    """The other makes `by` times what the first makes; vectors are turned by `forward`."""
    scale = sizes(one)
    for q in quantities:
        p = getattr(found(one), q)
        o = getattr(found(other), q)
        factor = by * (forward if q in ("force", "moment") else 1)
        error = max(np.abs(o.forward - factor * p.forward).max(), np.abs(o.backward - factor * p.backward).max())
        assert error <= SCALED * scale[q] + abs(by) * rounding(p) + rounding(o), (q, error, scale[q])


def assert_sum(whole: Spectra, parts: list[Spectra], scale: dict[str, float]) -> None:
    """The parts add up to the whole, but for rounding beside this size of each quantity."""
    for q in KINDS:
        p = [getattr(part, q) for part in parts]
        for way in ("forward", "backward"):
            total = sum(getattr(one, way) for one in p)
            error = np.abs(getattr(getattr(whole, q), way) - total).max()
            assert error <= SCALED * scale[q] + rounding(getattr(whole, q), *p), q


# ------------------------------------------------------------------ invariants
def banks(layout: Tables) -> list[float]:
    """Bank angles as a plain list, in place of the key that says them otherwise."""
    if "bank_angle" in layout:
        half = layout.pop("bank_angle") / 2
        return [-half, half]
    if "radial" in layout:
        count = layout.pop("radial")
        return [360 * k / count for k in range(count)]
    found: list[float] = layout.get("banks", [0.0])
    return found


def in_a_mirror(m: Tables) -> None:
    """The plane of x and z."""
    m["layout"]["banks"] = [-bank for bank in banks(m["layout"])]
    m["crank"] |= {"throws": [-throw for throw in m["crank"]["throws"]], "splay": -m["crank"]["splay"]}
    m["piston"]["offset"] *= -1
    m["frame"]["reference"][1] *= -1
    m["operation"]["speed_ripple"] = [line | {"angle": -line["angle"]} for line in m["operation"]["speed_ripple"]]
    if "cylinder" in m:
        m["cylinder"]["1"]["piston_offset"] *= -1
    for device in (*m["counterweight"], *m["shaft"], *m["slider"]):
        for key in {"angle", "direction"} & device.keys():
            device[key] *= -1
        if "at" in device:
            device["at"][1] *= -1


def place_throws(m: Tables, sense: int = 1, shift: float = 0.0) -> None:
    """Positions in place of the spacing."""
    spacing = m["crank"].pop("spacing")
    count = len(m["crank"]["throws"])
    m["crank"]["positions"] = [shift + sense * (t - (count - 1) / 2) * spacing for t in range(count)]


def end_to_end(m: Tables) -> None:
    """Throws in reverse: the plane of x and y as a mirror."""
    place_throws(m, sense=-1)
    m["layout"]["stagger"] = -m["layout"].get("stagger", 0)
    m["frame"]["reference"][2] *= -1
    for device in (*m["counterweight"], *m["shaft"], *m["slider"]):
        device["position"] *= -1


@quick
@given(engines(), figures(-180, 180))
def test_a_turned_engine_makes_the_same_turned(model, turn):
    """Banks, devices and the point of reference about the crank axis: every vector turns, no scalar changes."""

    def change(m: Tables) -> None:
        m["layout"]["banks"] = [bank + turn for bank in banks(m["layout"])]
        m["frame"]["reference"][:2] = about(m["frame"]["reference"][:2], turn)
        for device in m["shaft"]:
            device["angle"] += turn
            device["at"] = about(device["at"], turn)
        for device in m["slider"]:
            device["direction"] += turn
            device["at"] = about(device["at"], turn)

    assert_same(made(model), made(changed(model, change)), forward=np.exp(1j * np.radians(turn)))


def about(at: list[float], turn: float) -> list[float]:
    turned = complex(*at) * np.exp(1j * np.radians(turn))
    return [float(turned.real), float(turned.imag)]


@quick
@given(engines())
def test_an_engine_in_a_mirror(model):
    """Mirrored in the plane of x and z, turning the same way: at crank angle -theta it is the
    mirror image of the first at theta. Force: conjugate; moment (over i): conjugate; scalars: odd
    in the crank angle, with their sign changed.
    """
    one = made(model)
    other = made(changed(model, in_a_mirror))
    before = found(one)
    after = found(other)
    scale = sizes(one)
    for q, sign in {"force": 1, "moment": -1, "couple": -1, "torque": -1, "roll": -1}.items():
        p = getattr(before, q)
        o = getattr(after, q)
        for way in ("forward", "backward"):
            want = sign * np.conj(getattr(p, way))
            assert np.abs(getattr(o, way) - want).max() <= SCALED * scale[q] + rounding(p, o), q


@quick
@given(engines())
def test_an_engine_with_its_throws_in_reverse(model):
    """Mirrored in the plane of x and y: only the moment changes, its sign."""
    one = made(model)
    other = made(changed(model, end_to_end))
    assert_same(one, other, quantities=("force", "couple", "torque", "roll"))
    assert_same(one, other, by=-1, quantities=("moment",))


@quick
@given(engines(), figures(-500, 500))
def test_shifted_along_the_crank_with_its_point_of_reference(model, shift):
    def change(m: Tables) -> None:
        place_throws(m, shift=shift)
        m["frame"]["reference"][2] += shift
        for device in (*m["counterweight"], *m["shaft"], *m["slider"]):
            device["position"] += shift

    assert_same(made(model), made(changed(model, change)))


@quick
@given(engines(), figures(-500, 500), figures(-500, 500), figures(-500, 500))
def test_another_point_of_reference_adds_the_force_times_its_arm(model, x, y, z):
    """M' = M - i z F about a point z farther; C' = C - Im(conj(p) F) about a point p beside."""

    def change(m: Tables) -> None:
        m["frame"]["reference"] = [a + b for a, b in zip(m["frame"]["reference"], (x, y, z), strict=True)]

    one = made(model)
    other = made(changed(model, change))
    before = found(one)
    after = found(other)
    scale = sizes(one)
    p = (x + 1j * y) / 1e3
    assert_same(one, other, quantities=("force", "torque"))
    arm = 1 + abs(z) / 1e3 + abs(p)
    for way in ("forward", "backward"):
        want = getattr(before.moment, way) - 1j * z / 1e3 * getattr(before.force, way)
        error = np.abs(getattr(after.moment, way) - want).max()
        assert error <= SCALED * (scale["moment"] + arm * scale["force"]) + rounding(before.moment, after.moment)
    theta = np.linspace(0, 6, 13)
    want = before.couple.values(theta).real - (np.conj(p) * before.force.values(theta)).imag
    error = np.abs(after.couple.values(theta).real - want).max()
    assert error <= len(ORDERS) * (
        SCALED * (scale["couple"] + arm * scale["force"]) + rounding(before.couple, after.couple)
    )


@quick
@given(engines(), figures(0.1, 0.9))
def test_a_counterweight_in_two_parts(model, share):
    """Two unbalances on one side of the crank whose sum and centre are those of one."""

    def change(m: Tables) -> None:
        weight = m["counterweight"][0]
        arm = 100.0
        m["counterweight"] = [
            weight | {"unbalance": weight["unbalance"] * share, "position": weight["position"] + arm * (1 - share)},
            weight | {"unbalance": weight["unbalance"] * (1 - share), "position": weight["position"] - arm * share},
        ]

    assert_same(made(model), made(changed(model, change)))


@quick
@given(engines(), st.lists(angles, max_size=3), st.lists(places, min_size=9, max_size=9))
def test_two_engines_on_one_crank_add_up(model, more, where):
    """One with the devices and one without, whose first pins stand alike; equal but for their throws and places."""
    model.pop("cylinder", None)
    del model["crank"]["spacing"]
    first = model["crank"]["throws"]
    second = [model["crank"]["throws"][0], *more]

    def with_throws(throws: list[float], positions: list[float]) -> Any:
        return lambda m: m["crank"].update(throws=throws, positions=positions)

    count = len(first)
    both = len(first) + len(second)
    bare = without_devices(model)
    one = made(changed(model, with_throws(first, where[:count])))
    other = made(changed(bare, with_throws(second, where[count:both])))
    whole = found(made(changed(model, with_throws(first + second, where[:both]))))
    scale = sizes(one)
    scale_too = sizes(other)
    assert_sum(whole, [found(one), found(other)], {q: scale[q] + scale_too[q] for q in KINDS})


@quick
@given(engines(), figures(0, 1))
def test_every_mass_in_two_parts(model, share):
    """All moving masses of the cylinders split in one proportion between two engines at the same place."""
    model.pop("cylinder", None)
    one = made(model)
    parts = []
    for tables, part in ((copy.deepcopy(model), share), (without_devices(model), 1 - share)):
        tables["piston"]["mass"] *= part
        tables["crank"]["throw_mass"] *= part
        for key in {"mass", "inertia", "small_end", "big_end"} & tables["rod"].keys():
            tables["rod"][key] *= part
        parts.append(found(made(tables)))
    assert_sum(found(one), parts, sizes(one))


@quick
@given(engines())
def test_a_counterweight_is_a_shaft_on_the_crank_axis(model):
    def change(m: Tables) -> None:
        (weight,) = m.pop("counterweight")
        angle = weight["angle"] + float(np.ravel(made(model).first_axis_deg)[0])
        m["shaft"].append({"ratio": 1, "at": [0, 0], **weight, "angle": angle})

    assert_same(made(model), made(changed(model, change)))


@quick
@given(engines())
def test_a_slider_is_two_shafts_turning_against_each_other(model):
    """Half its unbalance each: with the crank at direction + angle, against it at direction - angle."""

    def change(m: Tables) -> None:
        (slider,) = m.pop("slider")
        m["shaft"] += [
            {
                "ratio": sense * slider["order"],
                "unbalance": slider["unbalance"] / 2,
                "at": slider["at"],
                "angle": slider["direction"] + sense * slider["angle"],
                "position": slider["position"],
            }
            for sense in (1, -1)
        ]

    assert_same(made(model), made(changed(model, change)))


@quick
@given(engines(), figures(0, 1))
def test_mass_moved_from_the_throw_to_the_big_ends(model, share):
    """What turns with the crank pin is one mass: as throw mass or at the big end of a rod weighed at its ends."""

    def change(m: Tables) -> None:
        rods_on_throw = len(banks(dict(m["layout"])))
        moved = share * m["crank"]["throw_mass"]
        m["crank"]["throw_mass"] -= moved
        m["rod"] |= {"small_end": 0.2, "big_end": 0.5 + moved / rods_on_throw}

    ends = changed(model, lambda m: m.update(rod={"length": m["rod"]["length"], "small_end": 0.2, "big_end": 0.5}))
    other = changed(ends, change)
    assert_same(made(ends), made(other), quantities=("force", "moment"))


@quick
@given(engines())
def test_everything_grows_with_the_square_of_the_speed(model):
    """Exactly fourfold at twice the speed: the factor is a power of two."""
    one = made(model)
    other = made(changed(model, lambda m: m["operation"].update(speed=2 * m["operation"]["speed"])))
    for (_, p), (_, o) in zip(found(one).items(), found(other).items(), strict=True):
        assert np.array_equal(4 * p.forward, o.forward)
        assert np.array_equal(4 * p.backward, o.backward)


@quick
@given(engines(), st.randoms(use_true_random=False))
def test_numbers_are_names(model, random):
    """Other numbers for the same cylinders move the origin of the crank angle to another pin, and change no size."""
    for key in ("cylinder", "counterweight", "shaft", "slider"):
        model.pop(key, None)
    model["operation"].pop("speed_ripple")
    rows = len(banks(dict(model["layout"])))
    numbers = list(range(1, rows * len(model["crank"]["throws"]) + 1))
    random.shuffle(numbers)
    numbering = np.reshape(numbers, (rows, -1)).tolist()
    one = made(model)
    other = made(changed(model, lambda m: m["layout"].update(numbering=numbering)))
    before = found(one)
    after = found(other)
    scale = sizes(one)
    for q in KINDS:
        for name in ("major", "minor"):
            error = np.abs(getattr(getattr(before, q), name) - getattr(getattr(after, q), name)).max()
            assert error <= SCALED * scale[q] + 2 * rounding(getattr(before, q), getattr(after, q)), q


@quick
@given(engines())
def test_units_of_the_file_do_not_matter(model):
    """Inches, pounds, turns, radians a second and so on for millimetres, kilograms, degrees and rpm."""

    def change(m: Tables) -> None:
        crank = m["crank"]
        crank["stroke"] = f"{crank['stroke'] / 25.4!r} in"
        crank["spacing"] = f"{crank['spacing'] / 10!r} cm"
        crank["throw_mass"] = f"{crank['throw_mass'] * 1000!r} g"
        crank["throws"] = [f"{angle / 360!r} turn" for angle in crank["throws"]]
        m["rod"]["length"] = f"{m['rod']['length'] / 1000!r} m"
        m["piston"]["mass"] = f"{m['piston']['mass'] / 0.45359237!r} lb"
        m["operation"]["speed"] = f"{m['operation']['speed'] * np.pi / 30!r} rad/s"
        for device in m["counterweight"]:
            device["unbalance"] = f"{device['unbalance'] / 1000!r} g*m"

    assert_same(made(model), made(changed(model, change)))


@quick
@given(engines())
def test_torque_has_no_mean_and_roll_is_couple_less_torque(model):
    s = found(made(model))
    assert s.torque.forward[0] == s.torque.backward[0] == 0
    scale = max(float(s.couple.major.max()), float(s.torque.major.max())) or 1.0
    assert np.abs(s.couple.x - s.torque.x - s.roll.x).max() <= SCALED * scale + rounding(s.roll)


@quick
@given(engines())
def test_cylinders_and_devices_add_up(model):
    """The whole is the sum of what its cylinders make alone, and its devices."""
    engine = made(model)
    whole = found(made(without_devices(model)))
    assert_sum(whole, [found(alone(engine, n)) for n in engine.numbers], sizes(engine))
