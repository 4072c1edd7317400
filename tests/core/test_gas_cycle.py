"""Computed cycles against arithmetic of 50 digits (`oracle/gas.py`), and what they refuse."""

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from oracle import gas
from support.cases import cases, slow
from support.pistons import slider_crank_piston

from balcli.core.cylinder_pressure import GasError, find_highest, press
from balcli.core.gas_cycle import GOALS, Goal, Process, find_least_imep, gas_cycle

OF_THE_LARGEST = 1e-12  # harmonics
RELATIVE = 1e-12  # imep
LENGTHS = 0.045, 0.15, 0.086  # radius, rod, bore
HALVES = [0, 1, 2, 3, 8, 31, 48]
SPARK = {"compression_ratio": 10.5}
DIESEL = {"compression_ratio": 17.0}
LATE = {"exhaust_opens": 140.0, "intake_closes": 580.0}
PORTS = {"exhaust_opens": 110.0, "strokes": 2}


@pytest.fixture(autouse=True)
def _digits():
    with mp.workdps(gas.DIGITS):
        yield


def reference(process, heat, offset):
    p = process

    def angle(degrees):
        return mp.radians(mp.mpf(degrees))

    kind = {
        "wiebe": ("wiebe", angle(p.burn_start), angle(p.burn_duration), mp.mpf(p.burn_shape)),
        "otto": ("otto",),
    }.get(p.cycle, ("limited", p.max_pressure and mp.mpf(p.max_pressure)))
    valves = {
        name: angle(value)
        for name, value in (("opens", p.exhaust_opens), ("closes", p.intake_closes))
        if value is not None
    }
    return gas.computed(
        gas.Mechanism(*(mp.mpf(length) for length in LENGTHS), mp.mpf(offset)),
        kind,
        mp.mpf(heat),
        strokes=p.strokes,
        ratio=mp.mpf(p.compression_ratio),
        nc=mp.mpf(p.compression_index),
        ne=mp.mpf(p.expansion_index),
        intake=mp.mpf(p.intake),
        exhaust=mp.mpf(p.exhaust),
        **valves,
    )


OTTO = {"cycle": "otto"}
DIESELS = {"cycle": "diesel"}


def wiebe(start, duration, **shape):
    return {"cycle": "wiebe", "burn_start": start, "burn_duration": duration, **shape}


CASES = {
    "otto": (SPARK, OTTO, ("imep", 10e5), 0.0),
    "otto two-stroke": (SPARK | PORTS, OTTO, ("max_pressure", 55e5), 0.012),
    "diesel": (DIESEL | LATE, DIESELS, ("imep", 8e5), 0.0),
    "dual": (DIESEL | LATE, {"cycle": "dual", "max_pressure": 90e5}, ("imep", 12e5), 0.01),
    "wiebe": (SPARK | LATE, wiebe(-15, 50), ("imep", 10e5), 0.0),
    "wiebe with an offset": (SPARK, wiebe(-15, 50), ("max_pressure", 60e5), -0.02),
    "wiebe two-stroke": (DIESEL | PORTS, wiebe(-8, 45, burn_shape=0.5), ("heat", 900.0), 0.0),
    "wiebe after the dead centre": (SPARK, wiebe(4, 60, burn_shape=1.5), ("imep", 6e5), 0.0),
    "wiebe before the dead centre": (SPARK, wiebe(-60, 50, burn_shape=0), ("max_pressure", 70e5), 0.0),
    "wiebe, steep": (
        SPARK | {"compression_index": 1.0, "expansion_index": 1.4},
        *(wiebe(-15, 50, burn_shape=9), ("imep", 10e5), 0.0),
    ),
}


SIMILAR = ["wiebe", "wiebe after the dead centre"]  # to others among them


@pytest.mark.parametrize("case", [*(case for case in CASES if case not in SIMILAR), *slow(*SIMILAR)])
def test_harmonics_and_imep(case):
    given, burn, goal, offset = CASES[case]
    process = Process(**given, **burn)
    cycle = gas_cycle(slider_crank_piston(*LENGTHS, offset), process, Goal(*goal))
    torque = press(slider_crank_piston(*LENGTHS, offset), cycle.pressure, cycle.breaks, crankcase=0.9e5)
    exact = reference(process, cycle.heat, offset)
    expected = np.array([complex(exact.harmonic(h, mp.mpf(0.9e5))) for h in HALVES])
    if process.strokes == 2:
        expected[np.array(HALVES) % 2 == 1] = 0
    error = np.abs(torque.harmonics(HALVES) - expected).max()
    assert error <= OF_THE_LARGEST * np.abs(expected).max()
    assert cycle.imep == pytest.approx(float(exact.imep), rel=RELATIVE)
    assert torque.imep == pytest.approx(float(exact.imep), rel=RELATIVE)
    reached = {"imep": cycle.imep, "max_pressure": find_highest(cycle.pressure).value, "heat": cycle.heat}
    assert reached[goal[0]] == pytest.approx(goal[1], rel=RELATIVE)


# ---------------------------------------------------------------- pressures
PISTON = slider_crank_piston(*LENGTHS)


def cycle_of(burn, name, value, **given):
    return gas_cycle(PISTON, Process(**({"compression_ratio": 10.0} | given | burn)), Goal(name, value))


@pytest.mark.parametrize(
    ("burn", "given"),
    [
        (OTTO, {"max_pressure", "heat", "imep"}),
        (DIESELS, {"cut_off", "heat", "imep"}),
        ({"cycle": "dual", "max_pressure": 70e5}, {"cut_off", "heat", "imep"}),
        (wiebe(-15, 50), {"max_pressure", "heat", "imep"}),
    ],
)
def test_every_goal_leads_to_the_same_cycle(burn, given):
    first = cycle_of(burn, "imep", 9e5, compression_ratio=16.0)
    top = find_highest(first.pressure).value
    width = PISTON.volume(first.breaks[2], 16.0) / PISTON.clearance(16.0)
    known = {"imep": 9e5, "heat": first.heat, "max_pressure": top, "cut_off": float(width)}
    assert set(GOALS[burn["cycle"]]) == given
    for name in given:
        again = cycle_of(burn, name, known[name], compression_ratio=16.0)
        assert again.heat == pytest.approx(first.heat, rel=1e-11)
        assert again.imep == pytest.approx(9e5, rel=1e-11)


def test_a_burn_that_ends_before_the_dead_centre_has_its_highest_pressure_there():
    cycle = cycle_of(wiebe(-60, 50), "max_pressure", 80e5)
    assert find_highest(cycle.pressure) == (pytest.approx(0, abs=1e-7), pytest.approx(80e5, rel=1e-12))


# ---------------------------------------------------------------- what is refused
@cases("core/gas_cycle", "what_cannot_be_is_refused_by_the_name_of_the_value")
def test_what_cannot_be_is_refused_by_the_name_of_the_value(burn, goal, value, process, told):
    with pytest.raises(GasError) as caught:
        cycle_of(burn, goal, value, **process)
    assert f"{caught.value.field}: {caught.value}" == told


# ---------------------------------------------------------------- variants
JOINT = {
    "mean pressures": (wiebe(-15, 50), ("imep", [5e5, 9e5, 14e5]), {}),
    "heats, one of them none": (OTTO, ("heat", [0.0, 500.0, 900.0]), {"expansion_index": [1.32, 1.28, 1.28]}),
    "pressures and ratios": (wiebe(-15, 50), ("max_pressure", [60e5, 55e5, 70e5]), {"compression_ratio": [9, 10, 11]}),
    "an isothermal compression": (OTTO, ("imep", 9e5), {"compression_index": [1.0, 1.2, 1.4]}),
    "all else": (
        wiebe(-40, 30),
        ("max_pressure", 70e5),
        {"burn_shape": [0.0, 0.5, 2.0], "intake": [0.9e5, 1e5, 1.4e5], "exhaust": [1e5, 2e5, 3e5]},
    ),
    "the least mean pressure": (OTTO, ("imep", [None, 9e5, None]), {"compression_ratio": [8, 10, 12]}),
}


@pytest.mark.parametrize("case", JOINT)
def test_variants_of_a_cycle_are_each_of_them(case):
    burn, (name, values), given = JOINT[case]
    process = Process(**{"compression_ratio": 10.0} | burn)
    every = []
    for k in range(3):
        own = replace(process, **{key: float(each[k]) for key, each in given.items()})
        value = values[k] if isinstance(values, list) else values
        wanted = find_least_imep(PISTON, own) if value is None else value
        every.append((wanted, gas_cycle(PISTON, own, Goal(name, wanted))))
    arrays = {key: np.array(each, float) for key, each in given.items()}
    joint = gas_cycle(PISTON, replace(process, **arrays), Goal(name, np.array([wanted for wanted, _ in every])))
    angle = np.linspace(0, 4 * np.pi, 301)
    for k, (_, alone) in enumerate(every):
        pressure = alone.pressure.at(angle)
        assert joint.heat[k] == pytest.approx(alone.heat, rel=1e-11, abs=1e-9)
        assert joint.imep[k] == pytest.approx(alone.imep, rel=1e-12)
        assert joint.pressure.at(angle)[:, k] == pytest.approx(pressure, rel=1e-12, abs=1e-12 * pressure.max())


def test_the_first_impossible_variant_is_refused():
    with pytest.raises(GasError, match=r"is 3 bar: this cycle has at least") as told:
        cycle_of(OTTO, "max_pressure", np.array([60e5, 3e5, 1e5]))
    assert told.value.field == "max_pressure"
    with pytest.raises(GasError, match=r"is 0\.95: give more than 1"):
        cycle_of(OTTO, "imep", 9e5, expansion_index=np.array([1.3, 0.95, 1.28]))
