"""Engines that are geared together: what one file describes is what its parts do where they stand."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import tomli_w
from hypothesis import given, settings, strategies as st
from support.cases import cases, slow
from support.commands import refusal, run_here as run
from support.engines import list_problems
from support.paths import write
from support.pictures import without_pictures

import balcli
from balcli.engine.build import build
from balcli.engine.parse import parse_dict
from balcli.errors import BalcliError
from balcli.forces.kinds import EVERY_KIND
from balcli.forces.spectrum import compute_spectra

RIPPLE = [{"order": 1, "amplitude": 0.03, "angle": 40}]
ROD = {"length": 150, "mass": 0.6, "cg": 45, "inertia": 2500}
GAS = {"cycle": "wiebe", "compression_ratio": 10, "imep": 9}
BY_SPEED = GAS | {"law": "propeller", "rated_speed": 3000}  # takes longer to build: of some engines
VEE = {"bank_angle": 50, "stagger": 20, "numbering": [[1, 2], [3, 4]]}
VEE |= {"firing_order": [1, 3, 2, 4], "firing_intervals": [50, 220, 50, 400]}
ORDERS = np.arange(0.0, 24.5, 0.5)


def engine(layout=(), gas=GAS, **crank):
    """Tables of an engine: a vee of two throws, unless something else is asked for."""
    tables = {
        "crank": {"stroke": 90, "throws": [0, 90], "spacing": 110, "throw_mass": 0.8, "inertia": 90000} | crank,
        "rod": ROD,
        "piston": {"mass": 0.5, "bore": 86, "offset": 3},
        "layout": VEE | dict(layout),
        "flywheel": {"inertia": 300000},
    }
    return tables | ({"gas": gas} if gas else {})


SINGLE = engine(gas=BY_SPEED, throws=[0]) | {"layout": {"firing_order": [1]}}
TWO_STROKE = engine({"strokes": 2, "firing_intervals": [50, 220, 50, 40]}, gas=BY_SPEED)
COLD = engine(gas=None, stroke=70)
TWO = [
    {"name": "upper", "file": "v4.toml"},
    {"name": "lower", "file": "two.toml", "ratio": -1, "phase": 75, "at": [200, -300, 400], "turn": 35},
]


def write_parts(folder):
    for name, tables in {"v4": engine(), "two": TWO_STROKE, "cold": COLD, "single": SINGLE}.items():
        write(folder / f"{name}.toml", tomli_w.dumps(tables))


@pytest.fixture(scope="module")
def load_once(tmp_path_factory):
    """A function of a text with [[engine]] to the engine, which is loaded once."""
    folder = tmp_path_factory.mktemp("parts")
    write_parts(folder)
    return cache(lambda text: balcli.load(write(folder / "geared.toml", text)))


@pytest.fixture
def geared_file(tmp_path):
    """A function of tables beside [[engine]] to such a file, which has those of two engines if nothing else is said."""
    write_parts(tmp_path)

    def write_file(engines=TWO, **tables):
        text = tomli_w.dumps({"operation": {"speed": 3000}} | tables | {"engine": engines})
        return write(tmp_path / "geared.toml", text)

    write_file()
    return write_file


@pytest.fixture
def geared(geared_file, load_once):
    """A function of tables beside [[engine]] to the engine of such a file."""
    return lambda *engines, **tables: load_once(geared_file(*engines, **tables).read_text(encoding="utf-8"))


def alone(tables, reference=(0.0, 0.0, 0.0), **more):
    return replace(build(parse_dict({**tables, **more})), reference_m=reference, speed_rpm=3000.0)


def agree(found, wanted, kinds=EVERY_KIND):
    for kind in kinds:
        size = np.abs(wanted[kind].vectors).max() + 1e-9
        assert np.abs(found[kind].vectors - wanted[kind].vectors).max() < 1e-11 * size, kind


@pytest.mark.parametrize(
    ("loads", "load"), [((True, False), "first"), ((False, True), "second"), ((True, True), "both")]
)
def test_two_engines_are_their_sum(geared, tmp_path, loads, load):
    """In every figure, and the sum writes the file that it stands for."""
    both = geared([one | {"load": own} for one, own in zip(TWO, loads, strict=True)])
    parts = [replace(balcli.load(tmp_path / one["file"]), speed_rpm=3000.0) for one in TWO]
    place = {"phase": 75, "at": (0.2, -0.3, 0.4), "turn": 35, "reverse": True, "load": load}
    agree(balcli.analyze(both, ORDERS).spectra, balcli.sum(*parts, **place, orders=ORDERS).spectra)
    options = ["--phase", 75, "--at", "200,-300,400", "--turn", 35, "--reverse", "--load", load, "--speed", 3000]
    files = [str(tmp_path / one["file"]) for one in TWO]
    target = tmp_path / "written.toml"
    told = run("sum", *files, *map(str, options), "--write", str(target), "-f", "json")
    again = json.loads(run("analyze", str(target), "-f", "json").out)
    assert again["orders"] == json.loads(told.out)["orders"]


@pytest.mark.parametrize("ripple", [[], RIPPLE])
def test_engines_on_one_axis_are_one_crank_with_all_their_throws(geared, ripple):
    """Three singles, one of them twice, and the moments of inertia of all."""
    leads = (0, 110, -95)
    at = (0, 130, 310)
    parts = [{"file": "single.toml", "phase": -lead, "at": [0, 0, z]} for lead, z in zip(leads, at, strict=True)]
    operation = {"operation": {"speed": 3000, "speed_ripple": ripple}}
    frame = {"frame": {"reference": [10, -20, 30]}}
    three = geared(parts, **operation, **frame)
    own = {"firing_order": [1, 2, 3], "firing_intervals": [110, 515, 95]}
    one = engine(gas=BY_SPEED, throws=[0, -110, 95], positions=list(at), inertia=270000) | {"layout": own}
    one["flywheel"] = {"inertia": 900000}
    del one["crank"]["spacing"]
    whole = balcli.load(one | operation | frame)
    orders = ORDERS if not ripple else ORDERS[ORDERS % 1 == 0]
    for rpm in (3000, 1500):
        one, several = (each.at_speed(rpm) for each in (whole, three))
        agree(*(compute_spectra(each, orders, [*EVERY_KIND]) for each in (several, one)))
    assert three.displacement_m3 == pytest.approx(whole.displacement_m3)
    if not ripple:
        first = balcli.torque(three)
        second = balcli.torque(whole)
        assert first.imep_Pa == pytest.approx(second.imep_Pa)
        assert first.flywheel.fluctuation == pytest.approx(second.flywheel.fluctuation)


def test_an_engine_and_its_mirror_image_have_no_couple_at_uneven_speed(geared):
    """What turns has no moment of momentum together, and twice the energy; so has a flywheel on both."""
    uneven = {"operation": {"speed": 3000, "speed_ripple": RIPPLE}}
    one, *both = ({"file": "v4.toml", "ratio": ratio} for ratio in (1, 1, -1))
    found = compute_spectra(geared(both, **uneven), ORDERS[::2], ["couple", "torque"])
    double = compute_spectra(geared([one, one], **uneven), ORDERS[::2], ["couple", "torque"])
    assert found.couple.balanced.all()
    assert not double.couple.balanced.all()
    assert found.torque.vectors == pytest.approx(double.torque.vectors)
    wheel = geared(both, **uneven, flywheel={"inertia": 1e6}).find_turning_inertia()
    assert (wheel.momentum, wheel.energy) == pytest.approx((1.0, 1.0 + 2 * (0.09 + 0.3)))


def test_what_cancels_is_balanced(geared):
    """Nothing is left of the force of orders 1, 2 and 4 of three singles 120 degrees apart."""
    three = geared([{"file": "single.toml", "phase": 120 * k} for k in range(3)])
    assert compute_spectra(three, [1, 2, 4, 6]).force.balanced.tolist() == [True, True, True, False]


@settings(max_examples=12, deadline=None)
@given(st.data())
def test_orders_add_up_to_the_curves(tmp_path_factory, data):
    """Sampled forces of each crank where it stands, against the sum of the orders; with gas over two turns."""
    folder = tmp_path_factory.mktemp("geared")
    angle = st.integers(-720, 720)
    place = st.lists(st.integers(-500, 500), min_size=3, max_size=3)
    engines = []
    for k in range(data.draw(st.integers(2, 3))):
        tables = data.draw(st.sampled_from([engine(), TWO_STROKE, COLD]))
        write(folder / f"{k}.toml", tomli_w.dumps(tables))
        turned = {"ratio": data.draw(st.sampled_from([1, -1])), "phase": data.draw(angle)} if k else {}
        engines.append({"file": f"{k}.toml", "at": data.draw(place), "turn": data.draw(angle), **turned})
    loads = data.draw(st.sampled_from([[], [True] * len(engines), [k == 1 for k in range(len(engines))]]))
    engines = [one | ({"load": loads[k]} if loads else {}) for k, one in enumerate(engines)]
    devices = {
        "counterweight": [{"unbalance": 30000, "angle": 20, "position": 60, "engine": "B"}],
        "shaft": [{"ratio": -2, "unbalance": 9000, "angle": 50, "at": [30, 90], "position": -40}],
    }
    text = {"engine": engines, **devices, "operation": {"speed": 2500, "speed_ripple": RIPPLE}}
    both = balcli.load(write(folder / "all.toml", tomli_w.dumps(text)))
    sampled = balcli.curves(both, 20).curves
    summed = balcli.curves(both, 20, orders=np.arange(0.0, 260.5, 0.5 if both.cycle_revolutions == 2 else 1.0)).curves
    for name, curve in sampled.items():
        with_gas = {"gas_torque_Nm", "torque_Nm", "roll_total_Nm"}  # whose orders have no end
        share = 2e-2 if name in with_gas else 1e-9
        assert np.abs(curve - summed[name]).max() < share * max(np.abs(curve).max(), 1), name


def test_devices_stand_on_their_engines(geared):
    """A counterweight of the whole is one of the engine that carries it; a shaft counts in the axes of the whole."""
    weight = {"unbalance": 50000, "angle": 35, "position": 460, "engine": "lower"}
    shafts = [{"ratio": n, "unbalance": 8000, "angle": 40, "at": [30, 80], "position": 70 + n} for n in (-2, 1)]
    moved = [TWO[0] | {"at": [50, 60, 70], "turn": 25}, TWO[1]]
    bare = geared(moved)
    fitted = geared(moved, counterweight=[weight], shaft=shafts)
    with_own = compute_spectra(fitted, ORDERS[::2])
    one = alone(TWO_STROKE, counterweight=[weight | {"position": 60, "engine": None}])
    lower = bare.placed[1]._replace(engine=one)
    upper = alone(COLD, tuple(map(float, bare.reference_m)))
    shaken = [compute_spectra(replace(upper, devices=d), ORDERS[::2]) for d in (fitted.devices[1:], ())]
    wanted = compute_spectra(replace(bare, placed=(bare.placed[0], lower)), ORDERS[::2])
    for kind in ("force", "moment", "couple"):
        whole = wanted[kind] + (shaken[0][kind] - shaken[1][kind])
        size = np.abs(whole.vectors).max()
        assert np.abs(with_own[kind].vectors - whole.vectors).max() < 1e-11 * size, kind
    for n in (1, 2):  # as the verdict sees them
        turning = [one for one in fitted.every_device if one.order == n]
        added = [compute_spectra(each, [n]) for each in (fitted, bare)]
        force, moment = (added[0][kind].vectors[:, 0] - added[1][kind].vectors[:, 0] for kind in ("force", "moment"))
        pulls = np.array([(one.forward, one.backward) for one in turning]) * (n * float(fitted.omega)) ** 2
        arms = np.array([one.z - float(fitted.reference_m[2]) for one in turning])
        assert pulls.sum(axis=0) == pytest.approx(force)
        assert 1j * (arms @ pulls) == pytest.approx(moment)


SWEPT = ["roll_total.2.amplitude", "moment.1.major", "gas.1.amplitude", "torque.mean"]
VALUES = {
    "engine.2.phase": [0, 33],
    "engine.2.at.3": [10, 20],
    "engine.2.turn": [0, 9],
    "engine.2.rod.length": [150, 170],
    "operation.speed": [2000, 4000],
    "engine.1.gas.imep": [8, 10],
    "engine.2.crank.throw_mass": [1, 2],
}
QUICK = ["engine.2.phase", "engine.2.rod.length", "operation.speed"]
OTHERS = [path for path in VALUES if path not in QUICK]


@pytest.mark.parametrize("path", [*QUICK, *slow(*OTHERS)])
def test_a_sweep_is_its_variants_one_by_one(geared, path):
    both = geared(frame={"reference": [1, 2, 3]})
    swept = balcli.sweep(both, {path: VALUES[path]}, SWEPT)
    for k, value in enumerate(VALUES[path]):
        own = balcli.sweep(both, {path: [value]}, SWEPT)
        assert [swept[name][k] for name in SWEPT] == pytest.approx([own[name][0] for name in SWEPT])
    assert not np.allclose(*(np.array([swept[name][k] for name in SWEPT]) for k in (0, 1)))


def test_the_engine_whose_gas_cannot_be_varied_is_named(geared):
    with pytest.raises(BalcliError, match=r"engine\.1: gas\.imep = -4: gas\.imep: is -4 bar"):
        balcli.sweep(geared(), {"engine.1.gas.imep": [8, -4]}, "gas.1.amplitude")


def test_a_swept_phase_is_that_of_the_file(geared):
    both = geared(frame={"reference": [1, 2, 3]})
    changed = geared([TWO[0], TWO[1] | {"phase": 33}], frame={"reference": [1, 2, 3]})
    swept = balcli.sweep(both, {"engine.2.phase": [33]}, SWEPT)
    wanted = balcli.sweep(changed, {"operation.speed": [3000]}, SWEPT)
    assert [swept[name][0] for name in SWEPT] == pytest.approx([wanted[name][0] for name in SWEPT])


@pytest.mark.parametrize("ratio", [1, -1])
def test_weights_go_on_the_cranks_that_turn_so(geared, tmp_path, ratio):
    """And what no crank can carry goes to a shaft, or stays; --write reads back to what was sized."""
    both = geared([TWO[0], TWO[1] | {"ratio": ratio}])
    after = balcli.balance(both, "counterweights").after.spectra.select_orders([1])
    first = [bool(abs(vector[0]) < 1e-6) for p in (after.force, after.moment) for vector in (p.forward, p.backward)]
    assert first == [True, ratio < 0] * 2
    whole = balcli.balance(both, "complete").after.spectra.select_orders([1, 2])
    assert max(whole.force.major.max(), whole.moment.major.max()) < 1e-6
    out = tmp_path / "out.toml"
    told = run("balance", str(tmp_path / "geared.toml"), "--write", str(out), "-f", "json", "--scheme", "factor")
    told = json.loads(told.out)
    assert {weight["engine"] for weight in told["counterweights"]} == {"upper", "lower"}
    again = json.loads(run("analyze", str(out), "-f", "json", "--only", "peak").out)["peak"]
    assert again["force_N"] == pytest.approx(told["after"]["peak"]["force_N"], rel=1e-9)
    for one, tables in zip(both.cranks, (engine(), TWO_STROKE), strict=True):
        own = balcli.balance(alone(tables), "factor").remedy.counterweights
        z = 1e3 * float(one.at_m[2])
        mine = [w for w in told["counterweights"] if w["engine"] == one.name]
        assert [w["position_mm"] - z for w in mine] == pytest.approx([w.position for w in own])
        assert [w["unbalance_kg_m"] * 1e6 for w in mine] == pytest.approx([w.unbalance for w in own])


def test_json_names_engines_and_cylinders(geared_file, tmp_path):
    file = str(tmp_path / "geared.toml")
    told = json.loads(run("analyze", file, "-f", "json", "--by", "cylinder", "--misfire", "lower.1").out)
    lower = {"name": "lower", "file": "two.toml", "ratio": -1, "phase_deg": 75.0, "turn_deg": 35.0}
    assert told["engine"]["engines"][1] == lower | {"at_mm": [200.0, -300.0, 400.0], "load": False}
    assert [share["cylinder"] for share in told["cylinders"]][3:5] == ["upper.4", "lower.1"]
    assert told["no_gas_in"] == ["lower.1"]
    curve = run("curves", file, "--cylinder", "lower.2", "--step", "90").out.splitlines()
    assert len(curve) == 9
    assert run("torque", file, "--cylinder", "lower.2", "-f", "csv").status == 0
    assert "lower.9: geared" in refusal("torque", file, "--cylinder", "lower.9").replace("the engine", "geared")


def test_mounts_bear_the_torque_in_the_sense_of_the_load(geared):
    """The roll on the mounts is the roll of the frame, gas included."""
    from balcli.mounting.loads import find_loads

    both = geared([TWO[0] | {"load": False}, TWO[1] | {"file": "v4.toml", "load": True}])
    loads = find_loads(both, np.zeros(3), np.array([1.0, 2.0]), np.array([1.0, 2.0]))
    about = replace(both, reference_m=(0.0, 0.0, 0.0))
    wanted = compute_spectra(about, [1, 2], ["roll_total"]).roll_total.x
    assert loads.inertia[:, 5] - loads.gas.torque(3000.0) == pytest.approx(wanted, rel=1e-9)


@cases("engine/geared", "what_cannot_be_geared", A='[[engine]]\nfile = "a.toml"\n')
def test_what_cannot_be_geared(geared_file, tmp_path, text, message):
    (tmp_path / "v4.toml").rename(tmp_path / "a.toml")
    write(tmp_path / "locked.toml", "[crank]\nstroke = 90\n[rod]\nlength = 30\n[piston]\nmass = 3\n")
    write(tmp_path / "wrong.toml", "[crank]\nstroke = 90\n[rod]\nlength = -3\n[piston]\nmas = 3\n")
    found = list_problems(write(tmp_path / "bad.toml", text.replace(r"\n", "\n")))
    wanted = [message.replace("none.toml: no", f"{tmp_path}/none.toml: no")] if isinstance(message, str) else message
    assert {problem.partition(";  ")[0] for problem in found} == set(wanted)


@cases("engine/geared", "commands_of_one_crank")
def test_commands_of_one_crank(geared_file, tmp_path, command):
    told = refusal(*(str(tmp_path / "geared.toml") if word == "FILE" else word for word in command))
    assert told == "v4.toml and two.toml are geared together; run this on one of them"


def test_two_engines_of_one_file_are_told_as_such(geared_file, tmp_path):
    same = write(tmp_path / "same.toml", "".join('[[engine]]\nfile = "v4.toml"\n' for _ in range(2)))
    write(same, same.read_text().replace('"v4.toml"\n', '"v4.toml"\nname = "first"\n', 1) + "at = [300, 0, 0]\n")
    assert refusal("piston", same) == "2 engines of v4.toml are geared together; run this on v4.toml"


@pytest.mark.parametrize(
    "command",
    [
        *("compare FILE DIR/v4.toml", "check FILE --update", "numbers FILE"),
        *slow(*(f"plot FILE DIR/{what}.svg --what {what}" for what in ("all", "ladder", "torque"))),
        "scatter FILE --mass-scatter 1% --angle-scatter 0.1 --samples 20",
        *("analyze FILE --speed 1000:2000:500", "analyze FILE --all", "analyze FILE --only pru"),
        *(f"balance FILE --scheme {scheme}" for scheme in ("auto", "four-shaft", "couple-shaft", "slider")),
        "balance FILE --scheme compensator --position 3000",
    ],
)
def test_commands_that_take_several_cranks(geared_file, tmp_path, command):
    words = command.replace("FILE", "DIR/geared.toml").replace("DIR", str(tmp_path)).split()
    assert run(*words).status == 0
    if words[0] == "check":  # what was recorded is found
        assert run(*words[:-1]).status == 0


def test_a_page_of_several_cranks_has_no_mechanism(geared_file, tmp_path):
    with without_pictures():
        assert run("report", str(tmp_path / "geared.toml"), str(tmp_path / "x.html")).status == 0
    assert 'id="motion"' not in (tmp_path / "x.html").read_text(encoding="utf-8")
