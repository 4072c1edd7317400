"""`torsion --damper`: what is sized is the best there is, does what is said, and can be written."""

import itertools
import json
import re
import tomllib

import numpy as np
import pytest
from support.cases import cases, slow
from support.chains import chain_text
from support.commands import ask_json, ask_torsion, refusal, run_here
from support.diesel import write_diesel
from support.paths import ENGINES, write

from balcli import torsion
from balcli.file.examples import template
from balcli.torsional_vibration.motion import compute_curves
from balcli.torsional_vibration.plot import make_torsion

CHAIN = template("torsion")  # the file to start from
RANGE = ("--speeds", "850:1150:10")
LOW_ORDERS = ("--orders", "0.5-12")  # of the Diesel, those that matter
SPRING = float((1000 * np.pi / 30) ** 2)  # N m/rad: 1 kg m2 on it has a natural frequency of 1000 rpm


def single(spring=SPRING, disc=None, times=1, **more):
    """1 kg m2 on a spring, excited by 100 N m, all times as large."""
    nodes = {"disc": {"inertia": 1e6 * times} | (disc or {}), "wall": 0} | more.pop("nodes", {})
    shafts = {("disc", "wall"): spring * times} | more.pop("shafts", {})
    return chain_text(nodes, shafts, [("disc", 1, 100 * times)], fixed=["wall"], **more)


SINGLE = single()
# A nose of 0.001 kg m2 on a stiff shaft before the disc: room for little
NOSE = single(nodes={"nose": 0.001}, shafts={("nose", "disc"): 1e6}, loss=0.05)


def on_pulley(damper):
    """The Diesel with a damper on its pulley."""
    return write_diesel().replace('name = "pulley"\n', f'name = "pulley"\ndamper = {damper}\n')


def size(text, *options):
    """The sized damper, whatever is doubted."""
    return json.loads(run_here("torsion", "-", *options, "-f", "json", stdin=text).out)["damper"]


def largest(said, what="half_peak_to_peak_Nm"):
    shafts = [shaft["worst"] for shaft in said["response"]["shafts"]]
    return max(worst[what] for worst in shafts if what in worst)


@pytest.mark.parametrize("ratio", [0.1, 0.3])
def test_houdaille_optimum(ratio):
    """A viscous ring on one undamped degree of freedom leaves 1 + 2/ratio times the static torque,
    and the damping is that of Den Hartog's formula.
    """
    options = ("--damper", "viscous", "--damper-inertia", f"{ratio} kg m^2", *RANGE)
    damper = ask_torsion(SINGLE, *options)["damper"]
    assert (damper["node"], damper["before_Nm"]) == ("disc", None), "nothing else damps it: no bound"
    assert damper["after_Nm"] == pytest.approx(100 * (1 + 2 / ratio), rel=2e-4)
    exact = 2 * ratio * (1000 * np.pi / 30) / np.sqrt(2 * (1 + ratio) * (2 + ratio))
    assert damper["damping_Nms_per_rad"] == pytest.approx(exact, rel=0.02)


def test_the_file_s_own_damper_is_off_where_it_is_told_what_there_is_without_one():
    speeds = ("--speeds", "3000:4600:100", *LOW_ORDERS)
    fitted = on_pulley('{ kind = "viscous", inertia = 20000, damping = 30 }')
    stress = largest(ask_torsion(write_diesel(), *speeds), "stress_Pa") / 1e6
    assert largest(ask_torsion(fitted, *speeds), "stress_Pa") / 1e6 < 0.9 * stress
    out = run_here("torsion", "-", *speeds, "--damper", "viscous", stdin=fitted).out
    told = re.search(r"^largest stress without the damper +±([\d.]+) N/mm²$", out, re.MULTILINE)
    assert float(told[1]) == pytest.approx(stress, rel=1.5e-4), "as printed"


@pytest.mark.parametrize(("kind", "key"), [("viscous", "damping_Nms_per_rad"), ("rubber", "stiffness_Nm_per_rad")])
def test_no_other_figure_is_better(kind, key):
    """Of the Diesel with its inertia torque, over the range in which order 3 is critical."""
    options = ("--speeds", "3000:4600:100", *LOW_ORDERS)
    sized = ask_torsion(write_diesel(), *options, "--damper", kind, "--damper-at", "pulley")
    damper = sized["damper"]
    assert damper["after_Pa"] == pytest.approx(largest(sized, "stress_Pa"))
    assert damper["after_Pa"] < 0.4 * damper["before_Pa"]
    loss = f"loss = {damper['loss']}, " if kind == "rubber" else ""
    for share in (0.5, 0.9, 1.1, 2):
        figure = f"{key.split('_')[0]} = {share * damper[key]}"
        other = on_pulley(f'{{ kind = "{kind}", inertia = {damper["inertia_kg_m2"] * 1e6}, {loss}{figure} }}')
        assert largest(ask_torsion(other, *options), "stress_Pa") > damper["after_Pa"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", [pytest.param("viscous", marks=pytest.mark.stress), "rubber"])
def test_no_resonance_hides_between_the_speeds(kind):
    """The largest stress with and without a damper is that of the range, however far apart the speeds are."""
    text = write_diesel().replace("damping = 2\n", "").replace("loss = 0.035", "loss = 0.004")
    coarse, fine = (
        ask_torsion(text, "--speeds", f"3000:4600:{step}", "--damper", kind)["damper"] for step in (400, 10)
    )
    for key in ("before_Pa", "after_Pa"):
        assert coarse[key] == pytest.approx(fine[key], rel=1e-3)


def test_a_pendulum_is_tuned_to_the_order_that_does_most():
    asked = ("--speeds", "3800:4400:50", "--orders", "3", "--damper", "pendulum", "-f", "json")
    place = ("--damper-at", "pulley", "--damper-inertia", "4000 kg mm^2")
    found = run_here("torsion", "-", *asked, *place, stdin=write_diesel())
    assert found.err.startswith("warning: standard input: the pendulums of pulley swing by ")
    damper = json.loads(found.out)["damper"]
    assert damper["radius_m"] / damper["length_m"] == pytest.approx(9, rel=0.25)
    assert damper["after_Pa"] < 0.1 * damper["before_Pa"]
    assert damper["heat_W"] == 0


@pytest.mark.slow
@pytest.mark.parametrize("stroke", [137, pytest.param(2000, marks=pytest.mark.stress)])
def test_pendulums_hang_as_far_out_as_the_crank_pins(stroke):
    """Whatever the size of the engine; the file's own stay where they are."""
    for text, radius in (
        (write_diesel(), stroke / 2e3),
        (on_pulley('{ kind = "pendulum", mass = 2, radius = 90, length = 9 }'), 0.09),
    ):
        sized = text.replace("stroke = 137", f"stroke = {stroke}").replace("length = 207", f"length = {2 * stroke}")
        asked = ("--damper", "pendulum", "--damper-inertia", "4000 kg mm^2")
        assert size(sized, "--speeds", "3800:4400:100", *asked)["radius_m"] == radius


@pytest.mark.parametrize(
    ("kind", "loss", "speeds"),
    [("viscous", 0.02, "500:3000:100"), *itertools.product(["rubber"], [0.02, 0], ["500:3000:100", "2000:2440:40"])],
)
def test_a_damper_is_tuned_to_the_mode_of_the_largest_stress(kind, loss, speeds):
    """Not to that of a soft coupling, on which most work is done but which hardly twists the
    crankshaft: order 1 meets the coupling's mode at 933 rpm, order 4 the crankshaft's at 2504 rpm.
    In the crankshaft's mode the flywheel swings a tenth as far as the crank, the other way, so that
    1.1 kg m2 vibrate. So it is next to the resonance and where nothing damps it.
    """
    genset = chain_text(
        {"crank": 1, "flywheel": 10, "generator": 10},
        {("crank", "flywheel"): {"stiffness": 1e6, "diameter": 100}, ("flywheel", "generator"): 5e4},
        [("crank", 1, 300), ("crank", 4, 100)],
        loss=loss,
    )
    damper = size(genset, "--speeds", speeds, "--damper", kind)
    assert damper["mode"] == 2
    assert damper["inertia_kg_m2"] == pytest.approx({"viscous": 0.3, "rubber": 0.15}[kind] * 1.1, rel=0.01)
    if (loss, speeds) == (0.02, "500:3000:100"):
        assert damper["after_Pa"] < 0.3 * damper["before_Pa"]


@pytest.mark.parametrize("inertia_and_carrier", [(1, 4), (1.0001, 1), *slow((1, 1), (1.0001, 4))])
def test_a_damper_is_for_a_mode_in_which_its_carrier_moves(inertia_and_carrier):
    """The middle one of three discs, be it heavier than the others, which stands still, or nearly
    so, in the first mode, although that makes the largest torque.
    """
    inertia, carrier = inertia_and_carrier
    nodes = {"a": 1, "b": carrier, "c": inertia}
    text = chain_text(nodes, {"ab": 1e5, "bc": 1e5}, [("a", 3, 50), ("b", 5, 60)], loss=0.02)
    damper = size(text, "--speeds", "500:4000:100", "--damper", "viscous", "--damper-at", "b")
    assert damper["mode"] == 2
    there = (2 + carrier * (2 / carrier) ** 2) / (2 / carrier) ** 2
    assert damper["inertia_kg_m2"] == pytest.approx(0.3 * there, rel=1e-3)
    assert damper["after_Nm"] < 1.01 * damper["before_Nm"]


def test_a_damper_is_for_the_mode_that_the_range_meets_where_its_carrier_moves_a_little():
    """Shapes (3, 2) and (2, -3), of squared frequencies 1e5 and 7.5e5: order 1 meets the first at
    3020 rpm and the second at 8270. At b the first has 13/4 kg m2, more than there is.
    """
    shafts = {("a", "b"): 3e5, ("b", "wall"): 2.5e5}
    text = chain_text({"a": 1, "b": 1, "wall": 0}, shafts, [("a", 1, 100)], loss=0.02, fixed=["wall"])
    damper = ask_torsion(text, "--speeds", "2000:4000:50", "--damper", "viscous", "--damper-at", "b")["damper"]
    assert damper["mode"] == 1
    assert damper["inertia_kg_m2"] == pytest.approx(0.3 * 13 / 4, rel=1e-3)
    assert damper["after_Nm"] < 0.25 * damper["before_Nm"]


def test_a_damper_of_the_file_is_the_one_that_is_sized():
    text = on_pulley('{ kind = "rubber", inertia = 12345, stiffness = 1, loss = 0.2 }')
    damper = ask_torsion(text, "--speeds", "3000:4600:40", *LOW_ORDERS, "--damper", "rubber")["damper"]
    assert (damper["inertia_kg_m2"], damper["loss"]) == (0.012345, 0.2)
    assert damper["stiffness_Nm_per_rad"] > 1000


def test_what_it_costs_is_the_power_lost_in_it():
    """The heat of the sized damper is that of the same damper in a file: the largest of the range,
    between the speeds as well.
    """
    sized = ask_torsion(write_diesel(), "--speeds", "3000:4600:100", "--damper", "viscous", *LOW_ORDERS)
    (told,) = sized["response"]["dampers"]
    damper = sized["damper"]
    worst = told["worst"]
    assert (told["node"], damper["heat_rpm"]) == ("pulley", worst["speed_rpm"])
    assert damper["heat_W"] == worst["heat_W"] > max(told["heat_W"])
    figures = f"inertia = {damper['inertia_kg_m2'] * 1e6}, damping = {damper['damping_Nms_per_rad']}"
    speeds = f"{worst['speed_rpm'] - 100}:{worst['speed_rpm'] + 100}:0.5"
    fine = ask_torsion(on_pulley(f'{{ kind = "viscous", {figures} }}'), "--speeds", speeds, *LOW_ORDERS)["response"]
    assert damper["heat_W"] == pytest.approx(max(fine["dampers"][0]["heat_W"]), rel=1e-6)


def test_heat_of_a_narrow_resonance_is_the_highest_of_it():
    """Its top lies beside that of the damped mode, since other orders heat the damper as well."""
    ring = {"kind": "viscous", "inertia": 18800, "damping": 0.0541}
    nodes = {"a": {"inertia": 106e3, "damper": ring}, "b": 0.114, "c": 0.0333, "d": 0.0866}
    shafts = {"ab": 186.4e3, "bc": 38.6e3, "cd": 44.75e3}
    torques = [("c", 4.5, 83.8), ("c", 5.5, 20.6), ("c", 0.5, 117), ("c", 4, 60)]
    text = chain_text(nodes, shafts, torques, loss=0.0172)
    (coarse,) = ask_torsion(text, "--speeds", "600:3000:100")["response"]["dampers"]
    (fine,) = ask_torsion(text, "--speeds", "1180:1190:0.01")["response"]["dampers"]
    assert coarse["worst"]["heat_W"] == pytest.approx(max(fine["heat_W"]), rel=1e-6)


@pytest.mark.parametrize(("factor", "kept"), [(0.99, False), (1.01, True)])
def test_the_block_of_a_sized_damper_says_whether_the_limit_is_kept(factor, kept):
    options = ("--damper", "viscous", "--damper-inertia", "0.2 kg m^2")
    after = size(SINGLE, *RANGE, *options)["after_Nm"]
    shaft = {"stiffness": SPRING, "torque_limit": factor * after}
    text = single(shafts={("disc", "wall"): shaft})
    told = " ".join(run_here("torsion", "-", *RANGE, *options, stdin=text).out.split())
    share = f"{100 / factor:.3g} % of {factor * after:.4g} N·m at "
    if kept:
        assert f"limit with it kept: disc-wall uses {share}" in told
    else:
        assert f"limit with it exceeded: disc-wall uses {share}" in told
        assert "rpm; try another inertia (--damper-inertia) or kind" in told
    assert "limit with it" not in run_here("torsion", "-", *RANGE, *options, stdin=SINGLE).out


@cases("torsional_vibration/dampers", "dampers_of_unlikely_size")
def test_dampers_of_unlikely_size(options, told):
    speeds = () if "--speeds" in options else RANGE
    status, out, err = run_here("torsion", "-", *speeds, "--damper", "viscous", *options, "-f", "json", stdin=NOSE)
    about_damper = [line for line in err.splitlines() if line.startswith("warning: --damper: ")]
    assert (status, about_damper) == (0, [f"warning: --damper: {told}"] if told else [])
    named_as_arguments = told.replace("--damper-at", "damper_at").replace("--damper-inertia", "damper_inertia")
    assert json.loads(out)["damper"].get("doubts", []) == ([named_as_arguments] if told else [])


def test_the_inertia_of_pendulums_is_about_the_axis():
    text = single(disc={"damper": {"kind": "pendulum", "mass": 2000, "radius": 60, "length": 50}})
    damper = torsion(text, [900, 1000, 1100], damper="pendulum").damper
    told = float(re.search(r"([\d.]+) kg m2", damper.doubts[0])[1])
    assert told == pytest.approx(damper.mass_kg * (damper.radius_m + damper.length_m) ** 2, rel=1e-3)


def test_a_damper_that_cannot_be_is_told_in_words():
    """A shaft as thin as a few atoms asks for next to no damping."""
    thin = CHAIN.replace("diameter = 55", "diameter = 5.5e-8")
    asked = (*RANGE, "--damper", "viscous", "--damper-at", "pump", "-q")  # without doubts
    assert refusal("torsion", "-", *asked, stdin=thin) == (
        "--damper viscous: the best damper is impossible; check the units of inertias and stiffnesses"
    )


@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_what_is_written_does_what_was_said(tmp_path, line_end):
    chain = tmp_path / "chain.toml"
    fitted = tmp_path / "fitted.toml"
    chain.write_bytes(CHAIN.replace("\n", line_end).encode())
    options = ("--speeds", "1500:2600:20", "--format", "json")
    promised = json.loads(run_here("torsion", chain, *options, "--damper", "viscous", "--write", fitted).out)
    del promised["damper"]
    assert json.loads(run_here("torsion", fitted, *options).out) == promised
    kept = [line for line in fitted.read_bytes().decode().split(line_end) if "by balcli" not in line]
    assert kept == CHAIN.split("\n"), "comments and all else stay"


def test_an_older_damper_is_replaced(tmp_path):
    old = write(tmp_path / "old.toml", on_pulley('{ kind = "viscous", inertia = 20000, damping = 1 }   # too soft'))
    new = tmp_path / "new.toml"
    options = ("--speeds", "3000:4600:40", *LOW_ORDERS, "--damper", "viscous")
    assert run_here("torsion", old, *options, "--write", new).status == 0
    damper = tomllib.loads(new.read_text())["torsion"]["front"][1]["damper"]
    assert damper["inertia"] == 20000
    assert damper["damping"] > 10
    assert new.read_text().count("damper = {") == 1


def test_a_file_in_inline_tables_is_written_anew(tmp_path):
    chain = tmp_path / "chain.toml"
    fitted = tmp_path / "fitted.toml"
    chain.write_text(
        'node = [{ name = "a", inertia = 1e6 }, { name = "b", inertia = 2e6 }] # short\n'
        'shaft = [{ from = "a", to = "b", stiffness = 1e4 }]\n'
        'excitation = [{ node = "b", order = 1, cos = 3 }]\n'
    )
    options = ("--speeds", "800:2000", "--damper", "viscous", "--write", fitted)
    assert run_here("torsion", chain, *options).status == 0
    assert fitted.read_text().startswith(
        "# Comments and layout of the original could not be kept: its [node.1] is written in an unusual way.\n"
    )
    assert tomllib.loads(fitted.read_text())["node"][0]["damper"]["kind"] == "viscous"


@cases("torsional_vibration/dampers", "options_that_miss_others", RANGE=RANGE)
def test_options_that_miss_others(options, message):
    assert refusal("torsion", "-", *options, stdin=SINGLE) == message


# ------------------------------------------------------------------ pictures
TITLES = {
    "modes": "Shapes of modes: angle of each node",
    "campbell": "Campbell diagram: orders, and criticals by work",
    "response": "Vibratory stress",
    "waterfall": "by order: widest",
}


@pytest.mark.parametrize("what", [*slow("all"), *TITLES])
def test_pictures_show_what_is_asked_and_are_the_same_for_the_same_question(tmp_path, what):
    files = [tmp_path / f"{k}.svg" for k in range(2 if what == "all" else 1)]
    options = ("--speeds", "1000:4000:100", "--plot")
    for file in files:
        status, _, err = run_here("torsion", "-", *options, file, "--what", what, stdin=write_diesel("limit = 60"))
        assert (status, err) == (0, "")
    (text,) = {file.read_text(encoding="utf-8") for file in files}
    assert "six: torsion" in text
    assert [name for name, title in TITLES.items() if title in text] == ([*TITLES] if what == "all" else [what])


def test_pictures_without_a_range_show_modes_and_criticals(tmp_path):
    assert run_here("torsion", "-", "--plot", tmp_path / "chain.svg", stdin=CHAIN).status == 0
    text = (tmp_path / "chain.svg").read_text()
    assert [name for name, title in TITLES.items() if title in text] == ["modes", "campbell"]


def test_pictures_of_large_torques_are_in_kilonewton_metres():
    """Of a crankshaft without diameters as well; a limit stands in the unit of the stress."""
    result = torsion(write_diesel(), [4000, 4300, 4332])
    waterfall, response = (make_torsion(result, what).axes[0] for what in ("waterfall", "response"))
    largest = max(max(shaft.half_peak_to_peak_Nm) for shaft in result.response.shafts) / 1e3
    assert largest > 10
    assert waterfall.get_title("left").splitlines()[0].endswith(" kN·m")
    assert response.get_ylabel() == "± kN·m"
    assert max(line.get_ydata().max() for line in response.lines) == pytest.approx(largest)


def test_pictures_show_a_resonance_between_the_speeds():
    """Two hundred rpm apart, the curve would stay below what the table tells."""
    result = torsion(write_diesel("limit = 60"), [4030, 4230, 4430, 4630])
    closely = np.arange(4200, 4500, 0.5)
    fine = torsion(write_diesel("limit = 60"), closely).response
    by_order = np.abs(compute_curves(result.system, closely).phasors).max(axis=(0, 1))
    highest_fine, highest_coarse = (
        max(max(shaft.stress_Pa) for shaft in each.shafts if shaft.stress_Pa is not None)
        for each in (fine, result.response)
    )
    assert highest_fine > 1.1 * highest_coarse
    stress, swing = make_torsion(result, "response").axes
    highest = max(max(line.get_ydata()) for line in stress.lines)
    assert highest == pytest.approx(highest_fine / 1e6, rel=1e-3)
    total, *orders = (max(line.get_ydata()) for line in swing.lines)
    assert total == pytest.approx(fine.free_end_deg.max(), rel=1e-3)
    assert max(orders) == pytest.approx(np.degrees(by_order[-1]), rel=1e-3)
    (waterfall,) = make_torsion(result, "waterfall").axes
    told = float(waterfall.get_title("left").splitlines()[0].split()[-2])
    shaft = np.argmax([each.worst.half_peak_to_peak_Nm for each in result.response.shafts])
    assert told == pytest.approx(by_order[shaft] / 1e3, rel=5e-3)


def test_orders_of_a_waterfall_do_not_cover_one_another():
    """Nor where nothing resonates, so that all are about as large."""
    result = torsion(ENGINES / "i6_diesel.toml", [1000, 1500, 2000], orders=[0.5, 1, 1.5, 2, 2.5, 3])
    (axes,) = make_torsion(result, "waterfall").axes
    streams = [stream.get_paths()[0].vertices[:, 0] for stream in axes.collections]
    assert len(streams) == 6
    for left, right in itertools.pairwise(streams):
        assert left.max() < right.min()


@pytest.fixture(scope="module")
def many_and_few_orders():
    return [torsion(ENGINES / "i6_diesel.toml", [1000, 2000, 3000], orders=n) for n in (None, [4.5, 6])]


@pytest.mark.parametrize("what", ["campbell", "waterfall"])
def test_pictures_leave_out_orders_that_are_small(many_and_few_orders, what):
    """At most 15 orders are drawn, and the title counts the others; of few large orders all are."""
    crowded, few = many_and_few_orders

    def look(result):
        (axes,) = make_torsion(result, what).axes
        rays = [line for line in axes.lines if (line.get_xdata()[0], line.get_ydata()[0]) == (0, 0)]
        return axes.get_title("left"), len(axes.collections if what == "waterfall" else rays)

    title, count = look(crowded)
    assert 5 < count <= 15
    left_out = int(re.search(r"\n\((\d+) smaller orders left out\)$", title)[1])
    assert 55 < left_out + count <= len(crowded.orders)
    title, count = look(few)
    assert (count, "left out" in title) == (2, False)


def test_pictures_over_speed_need_a_range(tmp_path):
    told = refusal("plot", "-", "--what", "response", "-o", tmp_path / "x.svg", stdin=SINGLE)
    assert told == "--what response: give the range of speeds, such as --speeds 1000:2500"


@pytest.mark.parametrize(("times", "ring", "heat"), [(1, r"100000 kg·mm²", "W"), (1e4, r"1000 kg·m²", "MW")])
def test_units_of_a_damper_are_those_of_its_size(times, ring, heat):
    """The same shafts ten thousand times as heavy, as stiff and as hard driven."""
    asked = (*RANGE, "--damper", "viscous", "--damper-at", "disc", "--damper-inertia", f"{1e5 * times} kg mm^2")
    told = run_here("torsion", "-", *asked, stdin=single(times=times)).out
    assert re.search(rf"^ring +{ring}$", told, re.MULTILINE)
    assert re.search(rf"^heat +up to [\d.]+ {heat}, at", told, re.MULTILINE)
    assert re.search(rf"turns\s+up\s+to\s+[\d.]+\s+{heat}\s+into\s+heat", told)


@pytest.mark.slow
def test_of_several_stiffnesses_that_are_best_nearby_the_best_of_all_is_taken():
    """The largest stress over the stiffness of this ring has two valleys, the deeper one narrower:
    the other was taken, with 4 % more.
    """

    def chain(**damper):
        nodes = {
            "a": {"inertia": 91000} | damper,
            "b": {"inertia": 98000, "damping": 1},
            "c": {"inertia": 1.3e6, "damping": 0.4},
        }
        shafts = {"ab": {"stiffness": 0.9e6, "diameter": 88}, "bc": {"stiffness": 3e6, "diameter": 52}}
        torques = [("b", 2, -130, 105), ("b", 4, -195, -118), ("b", 9, -220, 160), ("a", 3, 280, 68)]
        return chain_text(nodes, shafts, torques, loss=0.0042)

    speeds = np.arange(1800, 6501, 100)

    def stress(damper):
        shafts = torsion(chain(damper=damper), speeds).response.shafts
        return max(shaft.worst.stress_Pa or 0 for shaft in shafts)

    sized = torsion(chain(), speeds, damper="rubber").damper
    ring = sized.damper.model_dump(exclude_none=True)
    assert sized.after == pytest.approx(stress(ring), rel=1e-9)
    others = [ring | {"stiffness": share * sized.start} for share in np.geomspace(1 / 4, 4, 33).tolist()]
    assert sized.after <= min(map(stress, others))


def test_the_order_that_pendulums_are_tuned_to_meets_modes_with_their_node_at_rest():
    """They hold it, as a wall would, and have the rest of the chain swing against it."""
    pendulums = {"kind": "pendulum", "mass": 3, "radius": 72, "length": 18}  # R/L = 4: order 2
    shafts = {("pulley", "crank"): 1e6, ("crank", "flywheel"): 2e6}

    def analyze(pulley, *speeds, **head):
        nodes = {"pulley": {"inertia": 5e4} | pulley, "crank": 0.2, "flywheel": 1.5}
        return torsion(chain_text(nodes, shafts, [("crank", 2, 300)], loss=1e-4, **head), *speeds)

    for mode in analyze({}, fixed=["pulley"]).modes:
        rpm = 60 * mode.frequency_Hz / 2
        for shaft in analyze({"damper": pendulums}, [0.9 * rpm, 1.1 * rpm]).response.shafts:
            assert shaft.worst.speed_rpm == pytest.approx(rpm, rel=1e-6)
            assert shaft.worst.half_peak_to_peak_Nm > 30 * 300, "of the 300 N m that drive it"


# ------------------------------------------------------------------ dampers on throws
def on_throws(*tables, text=None):
    """The Diesel with dampers on throws: (number, damper)."""
    lines = (f"[[torsion.throw]]\nthrow = {number}\ndamper = {damper}\n" for number, damper in tables)
    return "\n".join([text or write_diesel(), *lines])


DISC = """
crank.stroke = 90
rod = { length = 145, mass = 0.7, cg = 50 }
piston = { mass = 0.5, bore = 86 }
[torsion]
throw_inertia = 20000
loss = 0.02
"""
TUNED = '{ kind = "pendulum", mass = 3, radius = 62, order = 4.5 }'
LONGER = '{ kind = "pendulum", mass = 2, radius = 62, length = 4 }'
RUBBER = '{ kind = "rubber", inertia = 9000, stiffness = 60000, loss = 0.15 }'


@pytest.mark.parametrize("damper", [TUNED, LONGER, RUBBER, '{ kind = "viscous", inertia = 9000, damping = 8 }'])
def test_a_damper_on_a_throw_is_one_on_a_massless_part_that_is_rigid_on_it(damper):
    rigid = f'[[torsion.front]]\nname = "arm"\nof = "throw 4"\nstiffness = "rigid"\ndamper = {damper}\n'
    speeds = ("-q", "--speeds", "1800,3000,4300")
    own, other = (ask_torsion(text, *speeds)["response"] for text in (on_throws((4, damper)), write_diesel() + rigid))
    torques = {shaft["name"]: shaft["half_peak_to_peak_Nm"] for shaft in other["shafts"]}
    for shaft in own["shafts"]:
        name = shaft["name"].replace("throw 4 ring", "arm ring")
        assert shaft["half_peak_to_peak_Nm"] == pytest.approx(torques[name], rel=1e-9)
    for key in {"pendulums", "dampers"} & own.keys():
        assert own[key][0]["worst"] == pytest.approx(other[key][0]["worst"], rel=1e-9)


def test_two_tunings_of_a_throw_hold_it_still_in_both_orders():
    disc = '[[torsion.rear]]\nname = "disc"\ninertia = 2e6\nstiffness = 2e6\n'
    text = on_throws((1, TUNED.replace("4.5", "2")), (1, TUNED.replace("4.5", "3")), text=f"{DISC}{disc}")
    for order, still in ((2, True), (3, True), (4, False)):
        said = ask_torsion(text, "-q", "--speeds", "900:4000:500", "--orders", f"{order}")["response"]
        assert (max(said["free_end_deg"]) < 1e-9) == still
        assert [each["worst"]["order"] for each in said["pendulums"]] == [order, order]


@pytest.mark.slow
def test_proposed_pendulums_swing_by_at_most_20_degrees(tmp_path):
    """On the throw with the largest amplitude; written as a table of this throw. On a light
    crankshaft there is no room for so much mass.
    """
    text = write_diesel().replace("loss = 0.035", "loss = 0.2")
    heavy = re.sub(r"throw_inertia = .*", "throw_inertia = 900000", text)
    asked = ("--speeds", "3800:4400:50", "--orders", "3", "--damper", "pendulum")
    written = tmp_path / "out.toml"
    said = ask_json("torsion", "-q", "-", *asked, "--write", written, stdin=heavy)
    (swung,) = said["response"]["pendulums"]
    assert swung["node"] == said["damper"]["node"] == "throw 5"
    assert swung["worst"]["half_swing_deg"] <= 20
    (table,) = tomllib.loads(written.read_text())["torsion"]["throw"]
    assert (table["throw"], table["damper"]["mass"]) == (5, said["damper"]["mass_kg"])
    again = ask_json("torsion", "-q", written, *asked[:4])["response"]
    assert again["pendulums"] == said["response"]["pendulums"]

    written.unlink()
    told = refusal("torsion", "-q", "-", *asked, "--write", written, stdin=text)
    assert "half of the inertia of the node" in told
    assert not written.exists()
