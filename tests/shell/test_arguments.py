"""What is wrong names the function's own arguments, not the options of the command line."""

import pytest

import balcli

V8 = balcli.load_example("v8_crossplane")
CHAIN = {
    "fixed": ["wall"],
    "node": [{"name": "disc", "inertia": 1e6}, {"name": "wall"}],
    "shaft": [{"from": "disc", "to": "wall", "stiffness": 1e4}],
    "excitation": [{"node": "disc", "order": 1, "cos": 100}],
}


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: balcli.tables("kvasnikov-1", angles="0:90:5"), "angles: table kvasnikov-1 takes ratios"),
        (
            lambda: balcli.tables("kvasnikov-1", ratios="0.9:1.1:0.1"),
            "ratios '0.9:1.1:0.1': lambda = 1, but a crank turns only with 0 < lambda < 1; "
            "give crank radius over rod length, such as 0.25 or 1/3.5",
        ),
        (lambda: balcli.scatter(V8, mass=0), "nothing deviates; give a tolerance, such as mass 0.5%"),
        (
            lambda: balcli.balance(V8, "couple-shaft", balcli.SchemeOptions(position=0.1)),
            "scheme couple-shaft has no position; it takes order, at, planes",
        ),
        (
            lambda: balcli.balance(V8, "factor", balcli.SchemeOptions(measured=-0.8)),
            "measured -800 g: a mass on the pin is not negative",
        ),
        (
            lambda: balcli.balance(V8, "counterweights", balcli.SchemeOptions(planes="end")),
            'planes "end": give ends, throws, or places along z',
        ),
        (
            lambda: balcli.balance(V8, "knuckles"),
            "scheme knuckles sizes no devices but changes the engine file: `balcli balance --scheme knuckles` does so",
        ),
        (lambda: balcli.curves(V8, 1000), "step_deg 1000: give a step of the crank angle from 0.001 to 360 degrees"),
        (
            lambda: balcli.plot(V8, "bank", scheme="crank"),
            "what bank shows the engine as it is: leave scheme and its options out",
        ),
        (
            lambda: balcli.combine(V8, V8, load="both"),
            "load both: cranks that turn alike roll the frame alike, whichever drives the load; it "
            "matters with reverse",
        ),
        (
            lambda: balcli.combine(V8, V8, at_m=(0, float("nan"), 0)),
            "at_m: the place of the second engine may be up to 1e+06 m off",
        ),
        (
            lambda: balcli.analyze_torque(balcli.load_example("i4_wiebe"), cylinder=9),
            "cylinder 9: in-line four, 2 litres, with gas has the cylinders 1, 2, 3, 4",
        ),
        (
            lambda: balcli.balance_rotor({"planes": ["a"], "run": [{"readings": ["5 @ 30"]}]}),
            "file of runs: run: there is no trial weight in a; add a run with one, such as weights = "
            '{ a = "10 @ 0" }, give influence, or leave the plane out with without a',
        ),
        (
            lambda: balcli.plot(balcli.sweep(V8, {"rod.ratio": [0.25]}, "force.1.major")),
            "a picture shows one or two parameters with several values each, not 0",
        ),
        (
            lambda: balcli.analyze_torsion(CHAIN, [1000, 1100], orders=[2], damper="viscous"),
            "chain file: nothing excites it at the orders asked for",
        ),
    ],
)
def test_errors_name_arguments(ask, told):
    with pytest.raises(balcli.BalcliError) as refusal:
        ask()
    assert str(refusal.value) == told


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: balcli.combine(V8, V8, at_m=0.3), "at_m: 0.3 (float): give x, y and z in m, such as (0.3, 0, 0)"),
        (lambda: balcli.combine(V8, V8, phase_deg="90"), "phase_deg: '90' (str): give an angle in degrees"),
    ],
)
def test_what_is_of_another_type(ask, told):
    with pytest.raises(TypeError) as refusal:
        ask()
    assert str(refusal.value) == told
