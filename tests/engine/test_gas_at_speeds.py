"""Gas that depends on the speed, against files with the gas of one speed; every command at its own speed."""

import numpy as np
import pytest
from support.cases import cases, slow
from support.commands import ask_json, run_here
from support.diesel import write_diesel
from support.engines import build_text, list_problems
from support.gas_engines import FOUR
from support.mounts import RandomBody
from support.paths import write

from balcli import load
from balcli.engine.engine import Engine
from balcli.forces.spectrum import compute_spectra, follow_gas

ORDERS = np.arange(0.5, 12.5, 0.5)
LOW = 1000.0
HIGH = 2500.0
RATED = 2400.0
OWN = "[cylinder.2]\ngas = 0\n[cylinder.3]\nheat = 0\n[cylinder.4]\ngas = 0.8\n"
ANGLES = np.arange(0.0, 720.0, 5.0)


def draw_pressure(top: float, late: float) -> np.ndarray:
    """A diagram in bar, largest at a crank angle of `late`."""
    from_top = (ANGLES - late + 360) % 720 - 360
    return 1 + top * np.exp(-((from_top / 40) ** 2)) + 0.1 * np.cos(np.radians(ANGLES))


def list_rows(pressures: np.ndarray) -> str:
    rows = (f"{a:g},{p!r}\n" for a, p in zip(ANGLES, pressures.tolist(), strict=True))
    return "angle_deg,pressure_bar\n" + "".join(rows)


def share(speed: float) -> float:
    return float(np.clip((speed - LOW) / (HIGH - LOW), 0, 1))


def cycle(kind: str, **keys: object) -> str:
    """[gas] of a computed cycle; a pair of numbers is one for each point."""
    alike = {key: value for key, value in keys.items() if not isinstance(value, tuple)}
    text = f'[gas]\ncycle = "{kind}"\ncompression_ratio = 14\n' + write_keys(alike)
    for k, speed in enumerate((LOW, HIGH) if len(alike) < len(keys) else ()):
        of_point = {key: value[k] for key, value in keys.items() if isinstance(value, tuple)}
        text += f"[[gas.at]]\nspeed = {speed}\n" + write_keys(of_point)
    return text


def write_keys(keys: dict[str, object]) -> str:
    return "".join(f"{key} = {value}\n" for key, value in keys.items())


def hold(speed: float, **keys: object) -> dict[str, object]:
    """The same keys at one speed."""
    between = ((k, v[0] + (v[1] - v[0]) * share(speed)) for k, v in keys.items() if isinstance(v, tuple))
    return keys | dict(between)


def read_torques(engine: Engine) -> np.ndarray:
    """Gas torque of every cylinder by order, shape (orders, cylinders)."""
    return compute_spectra(engine, ORDERS, ["gas"], by_cylinder=True)["gas"].x


def assert_follows(text: str, exact: dict[float, np.ndarray]) -> None:
    """Assert that the gas has these torques at these speeds, all at once and one by one."""
    engine = build_text(text)
    found = follow_gas(engine, read_torques)
    speeds = np.array([[*exact]])
    imep = [engine.at_speed(speed).gas.work / engine.displacement_m3 for speed in exact]
    assert found.imep(speeds[0]) == pytest.approx(imep, rel=1e-11)
    for torques, (speed, wanted) in zip(np.moveaxis(found.torque(speeds), 2, 0), exact.items(), strict=True):
        assert torques[:, 0] == pytest.approx(wanted, abs=1e-11 * np.abs(wanted).max())
        assert read_torques(engine.at_speed(speed)) == pytest.approx(wanted, abs=1e-11 * np.abs(wanted).max())


CYCLES = [
    ("otto", {"imep": (6.0, 11.0), "intake": (1.0, 1.4)}),
    ("otto", {"heat": (500.0, 900.0)}),
    ("wiebe", {"imep": (6.0, 11.0), "burn_start": (-12.0, 4.0), "burn_duration": (40.0, 55.0)}),
    ("wiebe", {"bmep": (6.0, 11.0), "mechanical_efficiency": 0.85, "exhaust": (1.05, 1.6)}),
    pytest.param("wiebe", {"max_pressure": (45.0, 70.0)}, marks=pytest.mark.slow),
    ("diesel", {"cut_off": (1.4, 2.0)}),
    ("dual", {"imep": (8.0, 12.0), "max_pressure": (65.0, 75.0)}),
]


@pytest.mark.parametrize(("kind", "keys"), CYCLES)
def test_a_cycle_is_that_of_the_numbers_at_its_speed(kind, keys):
    own = OWN if "heat" not in keys else ""
    texts = {speed: FOUR + cycle(kind, **hold(speed, **keys)) + own for speed in (700.0, LOW, 1733.0, HIGH, 4000.0)}
    exact = {speed: read_torques(build_text(text)) for speed, text in texts.items()}
    assert_follows(FOUR + cycle(kind, **keys) + own, exact)


@pytest.mark.parametrize("kind", ["otto", "wiebe", *slow("dual")])
def test_the_propeller_law_is_a_square_down_to_no_heat(kind):
    """The least imep is that which a cycle with less is said to have. What takes no dual cycle to its pressure burns
    at the dead centre, as in an otto cycle.
    """
    file = FOUR.replace("firing_order = [1, 3, 4, 2]", "strokes = 2") + "[cylinder.2]\ngas = 0.8\n"
    keys = {"intake": 2.5} | ({"max_pressure": 120} if kind == "dual" else {})
    as_otto = "otto" if kind == "dual" else kind
    (told,) = list_problems(file + cycle(as_otto, imep=0.01, intake=2.5))
    lowest = float(told.split()[-2])
    texts = {part * RATED: file + cycle(kind, imep=16 * part**2, **keys) for part in (0.7, 0.9, 1, 1.3, 2.0)}
    for part in (0.3, 0.5):
        texts[part * RATED] = file + cycle(as_otto, imep=16 * part**2, intake=2.5)
    law = file + cycle(kind, law='"propeller"', rated_speed=RATED, imep=16, **keys)
    assert_follows(law, {speed: read_torques(build_text(text)) for speed, text in texts.items()})
    engine = build_text(law)
    least = file + cycle(as_otto, imep=1.001 * lowest, intake=2.5)
    exact = read_torques(build_text(least))
    for speed in (50.0, 0.99 * RATED * np.sqrt(lowest / 16)):
        alone = read_torques(engine.at_speed(speed))
        found = follow_gas(engine, read_torques).torque(speed)
        assert alone == pytest.approx(exact, abs=3e-3 * np.abs(exact).max())
        assert found == pytest.approx(alone, abs=1e-11 * np.abs(exact).max())
    (doubt,) = engine.doubt_speeds([50.0, RATED])
    assert doubt.path == "gas.law"
    assert float(doubt.message.split()[2]) == pytest.approx(RATED * np.sqrt(lowest / 16), rel=1e-3)
    assert not engine.doubt_speeds([0.5 * RATED])


@pytest.mark.parametrize("speed", [700.0, LOW, 1200.0, 2400.0, 4000.0])
@pytest.mark.parametrize("harmonics", [False, True])
def test_diagrams_are_linear_in_the_speed_at_each_angle(tmp_path, speed, harmonics):
    first = draw_pressure(40, 8)
    second = draw_pressure(75, 14)
    files = {"a": list_rows(first), "b": list_rows(second), "m": list_rows(first + (second - first) * share(speed))}
    key = "indicator"
    if harmonics:
        key = "harmonics"
        rows = {"a": (3, 1), "b": (5, -2)}
        rows["m"] = tuple(np.array(rows["a"]) + (np.array(rows["b"]) - rows["a"]) * share(speed))
        files = {name: f"order,cos,sin\n0,2,0\n0.5,{float(a)!r},{float(b)!r}\n" for name, (a, b) in rows.items()}
    for name, text in files.items():
        write(tmp_path / f"{name}.csv", text)
    points = (f'[[gas.at]]\nspeed = {n}\n{key} = "{name}.csv"\n' for n, name in ((LOW, "a"), (HIGH, "b")))
    write(tmp_path / "moving.toml", FOUR + "[gas]\n" + "".join(points))
    write(tmp_path / "steady.toml", FOUR + f'[gas]\n{key} = "m.csv"\n')
    moving, steady = (load(tmp_path / f"{name}.toml") for name in ("moving", "steady"))
    exact = read_torques(steady)
    found = follow_gas(moving, read_torques).torque(speed)
    assert found == pytest.approx(exact, abs=1e-12 * np.abs(exact).max())
    gas = moving.at_speed(speed).gas.cylinders[0].torque
    own = steady.gas.cylinders[0].torque
    angles = np.radians(np.arange(-300.0, 400.0, 17.3))
    for one, other in ((gas.curve, own.curve), (gas.pressure, own.pressure)):
        if other is not None:
            values = other.at(angles)
            assert one.at(angles) == pytest.approx(values, abs=1e-11 * np.abs(values).max())


# ------------------------------------------------------------------ commands, each at its own speed
GAS = {"imep": (6.0, 11.0), "intake": (1.0, 1.4)}
BODY = RandomBody(6, 4).text
SUBJECTS = {
    "torsion": (write_diesel(extra="{gas}"), ("torsion", "--speeds", "1100,1700", "--orders", "0.5-6")),
    "mounts": (FOUR + "{gas}" + BODY, ("mounts", "--speeds", "1100,1700", "--orders", "0.5-6")),
}


@pytest.mark.parametrize("subject", SUBJECTS)
def test_responses_have_the_gas_of_each_speed(tmp_path, subject):
    text, (command, *options) = SUBJECTS[subject]
    moving = write(tmp_path / "moving.toml", text.replace("{gas}", cycle("otto", **GAS)))
    result = ask_json(command, moving, *options, "--misfire", 2)["response"]
    for s, speed in enumerate(result["speeds_rpm"]):
        steady = write(tmp_path / "steady.toml", text.replace("{gas}", cycle("otto", **hold(speed, **GAS))))
        alone = ask_json(command, steady, "--speeds", speed, *options[2:], "--misfire", 2)["response"]
        assert "imep_Pa" not in alone
        imep = ask_json("torque", steady, "--misfire", 2, "--speed", speed)["imep_Pa"]
        assert result["imep_Pa"][s] == pytest.approx(imep, rel=1e-11)
        key, name = ("shafts", "half_peak_to_peak_Nm") if command == "torsion" else ("mounts", "peak_N")
        found, exact = ([each[name][k] for each in of[key]] for of, k in ((result, s), (alone, 0)))
        assert found == pytest.approx(exact, rel=1e-10)
    shown = " ".join(run_here(command, moving, *options).out.split())
    assert "at every speed" not in shown
    assert "at every speed" in " ".join(run_here(command, steady, *options).out.split())


def test_criticals_have_the_gas_of_their_speed(tmp_path):
    """With a misfire the sum over the cylinders depends on how much gas there is next to the inertia."""
    text = SUBJECTS["torsion"][0]
    options = ("--orders", "3-6", "--misfire", 2)
    moving = write(tmp_path / "moving.toml", text.replace("{gas}", cycle("otto", **GAS)))
    criticals = ask_json("torsion", moving, *options)["criticals"][:4]
    assert any(LOW < found["speed_rpm"] < HIGH for found in criticals)
    for found in criticals:
        steady = write(tmp_path / "s.toml", text.replace("{gas}", cycle("otto", **hold(found["speed_rpm"], **GAS))))
        each = ask_json("torsion", steady, *options)["criticals"]
        (alone,) = (one for one in each if (one["mode"], one["order"]) == (found["mode"], found["order"]))
        assert found["phase_sum"] == pytest.approx(alone["phase_sum"], rel=1e-10)


def test_speeds_without_a_point_are_warned_of_once(tmp_path):
    file = write(tmp_path / "four.toml", FOUR + cycle("otto", **GAS))
    for *command, told in (
        ("torque", "--speed", "700", "the gas of 1000 rpm is used at 700 rpm"),
        ("analyze", "--speed", "700:4000:1100", "is used at 700 rpm and the gas of 2500 rpm is used at 4000 rpm"),
        ("sweep", "--vary", "operation.speed=700,2000", "-q", "torque.mean", "1000 rpm is used at 700 rpm"),
    ):
        done = run_here(command[0], file, *command[1:])
        assert (done.status, done.err.count("gas.at"), told in done.err) == (0, 1, True)
    assert "gas.at" not in run_here("torque", file, "--speed", 1200).err


def test_variants_have_the_gas_of_their_speed(tmp_path):
    """Swept as arrays and one by one; a point's figure varies as well."""
    file = write(tmp_path / "four.toml", FOUR + cycle("otto", **GAS))
    vary = ("--vary", "operation.speed=1200,2200", "--vary", "gas.at.2.imep=9,11", "-q", "torque.mean,gas.2.amplitude")
    rows = ask_json("sweep", file, *vary)["rows"]
    for speed, imep, mean, amplitude in (list(row.values()) if isinstance(row, dict) else row for row in rows):
        keys = hold(speed, imep=(6.0, imep), intake=GAS["intake"])
        steady = write(tmp_path / "steady.toml", FOUR + cycle("otto", **keys))
        exact = ask_json("torque", steady, "--speed", speed, "--orders", "2")
        found = exact["mean_torque_Nm"], exact["orders"][0]["gas_torque_Nm"]["amplitude"]
        assert (mean, amplitude) == pytest.approx(found, rel=1e-11)
    assert "\ngas.imep" not in run_here("numbers", file).out


@cases("engine/gas", "mistakes_of_gas_by_speed", FOUR=FOUR)
def test_mistakes_of_gas_by_speed(gas, told):
    for one, wanted in zip(list_problems(FOUR + gas), told, strict=True):
        assert one.startswith(wanted)
