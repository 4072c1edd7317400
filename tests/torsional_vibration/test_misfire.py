"""Cylinders that do not fire: the worst of them, with or without compression."""

import numpy as np
import pytest
from support.commands import ask_torsion, refusal, run_here
from support.engines import build_text

from balcli import torsion
from balcli.errors import BalcliError
from balcli.forces import spectrum
from balcli.forces.spectrum import compute_gas_torque
from balcli.torsional_vibration.build import NO_DAMPERS
from balcli.torsional_vibration.load import make_source
from balcli.torsional_vibration.worst_misfire import MisfireCase, choose_worst

FLYWHEEL = '[[torsion.rear]]\nname = "flywheel"\ninertia = 2e5\nstiffness = 4e5\n'
ENGINE = """
[crank]
stroke = 90
throws = [0, 240, 120]
spacing = 98
[rod]
length = 150
mass = 0.7
cg = 45
[piston]
bore = 86
mass = 0.5
[layout]
firing_order = [1, 3, 2]
[operation]
speed = 3000
[gas]
cycle = "wiebe"
compression_ratio = 10
heat = 1300
[torsion]
throw_stiffness = 3.4e5
throw_inertia = 6200
loss = 0.03
damping = 0.8
"""
TRIPLE = ENGINE + FLYWHEEL
STRESSED = TRIPLE + "diameter = 60\n"
LIMITED = STRESSED + "limit = 12\n"
# a limit of another kind on the same shaft, which is used more, and one of the free end, which is no shaft
SEVERAL = LIMITED.replace("damping = 0.8", "damping = 0.8\nangle_limit = 0.001") + "torque_limit = 20\n"
SPEEDS = ("--speeds", "2000:2400:200", "--orders", "0.5-6")


@pytest.mark.parametrize(
    ("text", "figure"), [(LIMITED, "share"), (SEVERAL, "share"), (STRESSED, "stress_Pa"), (TRIPLE, "torque_Nm")]
)
def test_the_worst_misfire_is_that_of_a_run_by_itself(text, figure):
    worst = ask_torsion(text, *SPEEDS, "--misfire", "worst")
    cases = worst.pop("misfire")
    sizes = {case["cylinder"]: case[figure] for case in cases["cases"]}
    assert list(sizes) == [1, 2, 3]
    assert cases["worst"] == max(sizes, key=sizes.get)
    for case in cases["cases"]:
        assert set(case) == {"cylinder", figure, "shaft", "speed_rpm"}
        alone = ask_torsion(text, *SPEEDS, "--misfire", str(case["cylinder"]))
        (largest,) = [s["worst"] for s in alone["response"]["shafts"] if s["name"] == case["shaft"]]
        if figure == "share":
            largest = max(alone["limits"], key=lambda limit: limit.get("share", 0))
        key = {"torque_Nm": "half_peak_to_peak_Nm"}.get(figure, figure)
        assert case[figure] == pytest.approx(largest[key], rel=1e-9)
        assert case["speed_rpm"] == pytest.approx(largest["speed_rpm"], rel=1e-6)
        if case["cylinder"] == cases["worst"]:
            assert alone == worst


PROPELLER = LIMITED.replace(
    "heat = 1300", 'imep = 9\nlaw = "propeller"\nrated_speed = 3000\nmechanical_efficiency = 0.85'
)
POINTS = LIMITED.replace(
    "heat = 1300",
    "at = [{ speed = 1000, imep = 6, intake = 1.0 }, { speed = 2200, imep = 9, intake = 1.3 }, { speed = 3000, imep = 8, intake = 1.2 }]",
)
OF_MEAN = '[[torsion.excitation]]\nnode = "flywheel"\norder = 1.5\nshare = 0.2\nangle = 30\n'


SILENCED = [
    *((LIMITED, "gas", False), (LIMITED, "heat", True), (PROPELLER, "heat", True), (POINTS, "gas", False)),
    *(pytest.param(*case, marks=pytest.mark.slow) for case in ((PROPELLER, "gas", False), (POINTS, "heat", True))),
]


@pytest.mark.parametrize(("text", "key", "compressing"), SILENCED)
def test_only_the_gas_of_the_silent_cylinder_is_computed_again(text, key, compressing):
    """Torques, means and imep at all speeds are those of a file in which this cylinder is silent."""
    file = text + OF_MEAN
    engine = build_text(file)
    silent = build_text(f"{file}[cylinder.3]\n{key} = 0\n")
    orders = np.arange(0.5, 6.5, 0.5)
    fast = make_source(engine.model, engine, "three", orders).without(3, compressing).system(NO_DAMPERS)
    slow = make_source(silent.model, silent, "three", orders).system(NO_DAMPERS)
    assert fast.silent == slow.silent
    assert fast.excitation.orders.tolist() == slow.excitation.orders.tolist()
    rpm = np.array([900.0, 1500.0, 2350.0, 3100.0])
    torques = [system.excitation.at(rpm * np.pi / 30) for system in (fast, slow)]
    largest = float(np.abs(torques[1]).max())
    assert torques[0] == pytest.approx(torques[1], rel=0, abs=1e-12 * largest)
    means = [system.means.at(rpm) for system in (fast, slow)]
    assert means[0] == pytest.approx(means[1], rel=1e-12)
    if slow.excitation.gas is not None:
        assert fast.excitation.gas.imep(rpm) == pytest.approx(slow.excitation.gas.imep(rpm), rel=1e-12)


@pytest.mark.parametrize("compressing", [False, True])
def test_the_gas_of_the_other_cylinders_is_not_computed_again(compressing, monkeypatch):
    engine = build_text(PROPELLER)
    calls = []

    def count(*arguments, **options):
        calls.append(arguments)
        return compute_gas_torque(*arguments, **options)

    monkeypatch.setattr(spectrum, "compute_gas_torque", count)
    source = make_source(engine.model, engine, "three")
    rpm = np.array([200.0, 300.0])
    counts = []
    for number in (1, 2, 3):
        source.without(number, compressing).system(NO_DAMPERS).excitation.at(rpm)
        counts.append(len(calls))
    assert counts[0] > 0
    assert counts[1:] == [counts[0]] * 2


@pytest.mark.parametrize(("second", "worst"), [(1 + 1e-12, 1), (1 + 1e-7, 2), (0.9, 1)])
def test_of_equals_the_first_is_the_worst(second, worst):
    cases = [
        MisfireCase(cylinder=number, share=share, shaft="hub", speed_rpm=900)
        for number, share in ((1, 1.0), (2, second))
    ]
    assert choose_worst(cases) == worst


def test_a_compressing_cylinder_has_no_heat():
    by_option = ask_torsion(LIMITED, *SPEEDS, "--misfire", "2", "--compressing")
    by_file = ask_torsion(LIMITED + "[cylinder.2]\nheat = 0\n", *SPEEDS)
    assert by_option == by_file
    assert by_option["no_burning_in"] == [2]
    assert ask_torsion(LIMITED, *SPEEDS, "--misfire", "2")["no_gas_in"] == [2]


def test_a_cylinder_whose_gas_is_its_own_may_compress():
    """The others of its [[gas.of]] burn as before."""
    shared = LIMITED + "[[gas.of]]\ncylinders = [2, 3]\nheat = 1000\n"
    by_option = ask_torsion(shared, *SPEEDS, "--misfire", "2", "--compressing")
    apart = shared.replace("[2, 3]", "[3]") + "[[gas.of]]\ncylinders = [2]\nheat = 0\n"
    assert by_option == ask_torsion(apart, *SPEEDS)
    assert by_option["no_burning_in"] == [2]


def test_the_worst_misfire_may_compress():
    answer = ask_torsion(LIMITED, *SPEEDS, "--misfire", "worst", "--compressing")
    assert answer["no_burning_in"] == [answer["misfire"]["worst"]]
    assert "no_gas_in" not in answer


def test_the_table_and_csv_name_every_cylinder():
    told = run_here("torsion", "-", *SPEEDS, "--misfire", "worst", stdin=LIMITED).out
    assert "Largest value of any shaft, one cylinder not firing" in told
    assert "Worst: cylinder" in told
    lines = run_here("torsion", "-", *SPEEDS, "--misfire", "worst", "-f", "csv", stdin=LIMITED).out
    assert sum(line.startswith("misfire,") for line in lines.splitlines()) == 4


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (
            ["--misfire", "worst", "--misfire", "2"],
            "--misfire worst runs every cylinder by itself; leave out --misfire 2",
        ),
        (["--compressing"], "--compressing: no cylinder is named; give --misfire too"),
        (["--misfire", "worst", "--damper", "viscous"], "--damper: size it for one cylinder that does not fire"),
        (["--misfire", "4"], "there is no cylinder 4"),
    ],
)
def test_contradictory_options(options, told):
    assert told in refusal("torsion", "-", *SPEEDS, *options, stdin=LIMITED)


def test_the_worst_misfire_needs_speeds_gas_and_a_cycle():
    assert "give the speeds over which to compare, with --speeds" in refusal(
        "torsion", "-", "--misfire", "worst", stdin=LIMITED
    )
    gas = LIMITED[LIMITED.index("[gas]") : LIMITED.index("[torsion]")]
    for options in (["worst"], ["2"]):
        assert "[gas]" in refusal("torsion", "-", *SPEEDS, "--misfire", *options, stdin=LIMITED.replace(gas, ""))
    chain = '[[node]]\nname = "a"\ninertia = 1e6\n[[node]]\nname = "b"\ninertia = 1e6\n[[shaft]]\nfrom = "a"\nto = "b"\nstiffness = 1e5\n'
    assert "--misfire: a chain has no cylinders" in refusal("torsion", "-", "--misfire", "worst", stdin=chain)


def test_python_takes_numbers_and_worst():
    engine = build_text(LIMITED)
    rpm = [2000, 2200, 2400]
    orders = [0.5 * k for k in range(1, 13)]
    worst = torsion(engine, rpm, orders=orders, misfire="worst")
    alone = torsion(engine, rpm, orders=orders, misfire=worst.misfire.worst)
    assert worst.limits == alone.limits
    assert torsion(engine, misfire=[1, 2], orders=orders).no_gas_in == (1, 2)
    assert torsion(engine, misfire=(1,), compressing=True, orders=orders).no_burning_in == (1,)
    with pytest.raises(BalcliError, match="misfire 'all'"):
        torsion(engine, misfire="all")
    with pytest.raises(TypeError, match="misfire"):
        torsion(engine, misfire=[1.5])
