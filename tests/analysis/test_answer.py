"""Analysis: which orders are shown, what is computed, what balanced means; over all engines of engines/."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from support.engines import GOOD, build_text
from support.gas_engines import FOUR, WIEBE
from support.paths import ENGINE_FILES, ENGINES

from balcli import load_example
from balcli.analysis.answer import QUANTITIES, Analysis, analyze
from balcli.engine.build import build
from balcli.engine.engine import Engine
from balcli.engine.parse import read
from balcli.errors import BalcliError
from balcli.forces.kinds import KINDS
from balcli.forces.spectrum import SHOWN, compute_spectra, find_relevant_orders
from balcli.forces.symmetry import find_textbook_units
from balcli.limits import HIGHEST_ORDER

NAMES = [file.relative_to(ENGINES).with_suffix("").as_posix() for file in ENGINE_FILES[::3]]
STEADY = (*KINDS, "peak")


@lru_cache
def example(name: str) -> Engine:
    return build(read(ENGINES / f"{name}.toml"))


@lru_cache
def analysed(name: str) -> Analysis:
    return analyze(example(name), only=STEADY)


# ------------------------------------------------------------------ orders
@pytest.mark.parametrize("name", NAMES)
def test_orders_shown_by_default(name):
    """1 and 2, and each in which some quantity exceeds 1e-6 of its own largest order; no other."""
    shown = set(analysed(name).orders)
    everything = compute_spectra(example(name), find_relevant_orders(example(name)))
    due = {1.0, 2.0}
    for _, phasors in everything.items():
        due |= set(everything.orders[phasors.major > SHOWN * phasors.major.max()])
    assert shown == due


@pytest.mark.parametrize("name", NAMES)
def test_orders_do_not_depend_on_those_shown_with_them(name):
    """Within their rounding bounds; to the last digit where all orders are needed for peaks."""
    default = analysed(name)
    asked = analyze(example(name), default.orders[::-1], only=STEADY)
    single = analyze(example(name), [2], only=KINDS)
    many = analyze(example(name), range(1, 300), only=KINDS)
    for kind, phasors in default.spectra.items():
        for other in (asked, single, many):
            common = np.intersect1d(default.orders, other.orders)
            here = phasors.select_orders(common)
            there = other.spectra[kind.name].select_orders(common)
            assert np.all(np.abs(here.vectors - there.vectors) <= here.noise + there.noise), kind.name
            assert other is not asked or np.array_equal(here.vectors, there.vectors), kind.name
    assert asked.peak.force == pytest.approx(default.peak.force, rel=1e-12, abs=1e-9)
    assert asked.peak.moment == pytest.approx(default.peak.moment, rel=1e-12, abs=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_nothing_beyond_the_relevant_orders(name):
    """What lies above them is below the rounding error of the largest order."""
    highest = find_relevant_orders(example(name))[-1]
    beyond = np.arange(highest + 1, highest + 17)
    for q, phasors in compute_spectra(example(name), beyond).items():
        assert phasors.major.max() <= 1e-12 * analysed(name).spectra[q.name].major.max(), q


def test_under_uneven_speed_orders_begin_at_0():
    uneven = build_text(GOOD + "[[operation.speed_ripple]]\norder = 2\namplitude = 0.05\n")
    assert list(analyze(uneven, only=["force"]).orders[:3]) == [0, 1, 2]


@pytest.mark.parametrize("orders", [[1, 2, 3], [5], [0, 1], range(1, 9)])
def test_exactly_the_orders_asked_for_are_shown(orders):
    assert list(analyze(example("i4"), orders).orders) == list(orders)
    assert list(analyze(example("i4"), [*orders, *orders]).orders) == list(orders)


@pytest.mark.parametrize(
    ("orders", "told"), [([-1], "-1"), ([HIGHEST_ORDER + 1], "4097"), ([], "none"), ([1.25], "1.25")]
)
def test_orders_that_cannot_be(orders, told):
    with pytest.raises(BalcliError) as caught:
        analyze(example("i4"), orders)
    assert str(caught.value) == f"orders must be multiples of 1/2 from 0 to 4096, not {told}"


@pytest.mark.parametrize(("name", "order", "factor"), [("i4", 14, 4), ("radial9", 10, 4.5), ("single", 20, 1)])
def test_a_small_order_that_is_there_is_not_swallowed(name, order, factor):
    """A_10 is 1e-7 of the first, A_20 1e-16."""
    engine = example(name)
    units = find_textbook_units(engine, np.array([float(order)]))
    found = analyze(engine, [order], only=["force"]).spectra.force
    assert not found.balanced[0]
    assert found.major[0] == pytest.approx(factor * units.force * units.ratios[0], rel=1e-10)


def test_a_high_order_beside_it_swallows_no_small_one():
    """The orders 1 to 4096 of a single cylinder: the first forty are there as they are by themselves."""
    everything, few = (
        analyze(example("single"), range(1, last + 1), only=["force"]).spectra.force for last in (4096, 40)
    )
    assert np.array_equal(everything.forward[:40], few.forward)
    assert np.array_equal(few.balanced, [n % 2 == 1 and n > 1 for n in range(1, 41)])


# ------------------------------------------------------------------ only what is asked for
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_only_one_quantity(quantity):
    result = analyze(example("vr6"), only=[quantity])
    there = {kind.name for kind, _ in result.spectra.items()}
    assert there == {quantity} & set(KINDS)
    assert hasattr(result, "peak") == (quantity == "peak")
    assert hasattr(result, "sizing") == (quantity == "sizing")
    if quantity in KINDS:
        whole = analysed("vr6").spectra.select_orders(result.orders)[quantity]
        assert np.array_equal(result.spectra[quantity].forward, whole.forward)


def test_gas_near_the_lock_is_computed_for_the_orders_that_are_shown():
    """Of the tens of thousands that peaks need there is no end."""
    locked = (FOUR + WIEBE).replace("length = 150", "ratio = 0.999999").replace("inertia = 2600", "")
    fired = analyze(build_text(locked))
    few = analyze(build_text(locked), [2, 4, 8])
    for order, torque in zip((2, 4, 8), few.spectra.gas.major, strict=True):
        at = fired.orders.tolist().index(order)
        assert fired.spectra.gas.major[at] == pytest.approx(torque, rel=1e-9)
    peakless = analyze(build_text(locked), only="gas").spectra.gas
    assert peakless.major.max() == pytest.approx(fired.spectra.gas.major.max(), rel=1e-12)
    motored = analyze(build_text(locked.replace(WIEBE, "")))
    assert few.peak.force.value == fired.peak.force.value == motored.peak.force.value


def test_an_unknown_quantity():
    with pytest.raises(BalcliError) as caught:
        analyze(example("i4"), only=["force", "weight", "noise"])
    assert str(caught.value) == (
        "there is no quantity noise, weight: choose from force, moment, couple, torque, roll, "
        "peak, sizing, ladder, gas, inner, guide, journals, masses, parts, pru"
    )
    with pytest.raises(BalcliError, match='there is no quantity "": choose'):
        analyze(example("i4"), only=["force", ""])


# ------------------------------------------------------------------ parts and peaks
@pytest.mark.parametrize("name", ["v5", "vr6", "i4_shafts", "v8_crossplane", "radial5", "boxer4"])
def test_cylinders_and_devices_sum_to_the_engine(name):
    e = example(name)
    result = analyze(e, range(1, 9), only=KINDS, by="cylinder")
    assert [share.cylinder for share in result.cylinders] == sorted(e.numbers)
    nothing = np.zeros_like(e.cylinders.reciprocating)
    still = replace(e, cylinders=replace(e.cylinders, reciprocating=nothing, rotating=nothing, couple=nothing))
    parts = [compute_spectra(still, result.orders), *(share.spectra for share in result.cylinders)]
    for q, whole in result.spectra.items():
        scale = sum(part[q.name].major.max() for part in parts)
        for way in ("forward", "backward"):
            total = sum(getattr(part[q.name], way) for part in parts)
            assert np.abs(total - getattr(whole, way)).max() <= 1e-14 * scale, q


@pytest.mark.parametrize("name", NAMES)
def test_peaks_are_those_of_the_whole_curve(name):
    """No sample of the whole curve lies above the peak, and the peak lies on it; whatever orders are shown."""
    e = example(name)
    theta = np.linspace(0, 2 * np.pi, 2881)
    whole = compute_spectra(e, find_relevant_orders(e), ("force", "moment"))
    for q in ("force", "moment"):
        found = getattr(analysed(name).peak, q)
        phasors = getattr(whole, q)
        samples = np.abs(phasors.values(theta))
        assert samples.max() * (1 - 1e-14) <= found.value <= samples.max() * (1 + 1e-3) + 1e-300, q
        assert abs(phasors.values(found.theta)) == pytest.approx(found.value, rel=1e-13, abs=1e-300)
    assert analyze(e, [3], only=["peak"]).peak.force == analysed(name).peak.force


def test_what_is_small_is_small_beside_the_force_of_one_piston_and_its_rod_end():
    """m r w^2, over the 300 mm between the outermost throws and at the crank radius of 45 mm."""
    force = (0.5 + 0.6 * 45 / 160) * 0.045 * (100 * np.pi) ** 2
    scale = analyze(build_text(GOOD), only=["force"]).of_one_cylinder
    assert scale["force"] == pytest.approx(force, rel=1e-14)
    assert scale["moment"] == pytest.approx(0.3 * force, rel=1e-14)
    assert scale["torque"] == pytest.approx(0.045 * force, rel=1e-14)


def test_a_bank_alone_is_the_row_of_its_cylinders():
    """A bank of a flat-plane V8 has four times the second order of a cylinder, along its own axis (Liu (1.3)); both
    together are the engine.
    """
    v8 = load_example("v8_flatplane")
    result = analyze(v8, [2], only=["force"], by="bank")
    cylinder = analyze(v8, [2], only=["force"], by="cylinder").cylinders[0].spectra["force"]
    left, right = result.banks
    assert (left.axis_deg, right.axis_deg) == (-45, 45)
    assert (left.cylinders, right.cylinders) == ((1, 2, 3, 4), (5, 6, 7, 8))
    for bank in result.banks:
        force = bank.spectra["force"]
        assert force.major == pytest.approx(4 * cylinder.major, rel=1e-12)
        assert force.minor == pytest.approx(0, abs=1e-12 * force.major[0])
        assert force.axis_deg == pytest.approx([bank.axis_deg])
    both = left.spectra["force"].vectors + right.spectra["force"].vectors
    assert both == pytest.approx(result.spectra["force"].vectors, rel=1e-12)
