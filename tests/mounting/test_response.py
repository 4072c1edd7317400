"""A body on its mounts, from file to result, against matrices, eigenvalues, loads and time steps of the tests' own."""

import numpy as np
import pytest
from oracle import momentum
from support.cases import slow
from support.engines import build_text
from support.in_time import run_in_time
from support.mounts import ENGINE, RandomBody, block
from support.paths import write

from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_spectra
from balcli.mounting.answer import report_mounts
from balcli.mounting.build import read_mounted
from balcli.mounting.rigid_body import describe_free_motion

SPEEDS = np.array([700.0, 1100, 1900, 3000, 5200])
COMPONENTS = (*(f"force_{axis}_N" for axis in "xyz"), *(f"moment_{axis}_Nm" for axis in "xyz"))


def list_omega(result):
    return 2 * np.pi * np.array([mode.frequency_Hz for mode in result.modes])


def rest_of(result):
    return np.array([mount.force_N for mount in result.static.mounts])


@pytest.fixture
def report(tmp_path):
    def of(text, speeds=SPEEDS, orders=None, scheme=None, ranged=True):
        model, engine, _ = read_mounted(write(tmp_path / "engine.toml", text))
        return report_mounts(model, engine, speeds, orders, scheme, name="engine.toml", ranged=ranged)

    return of


@pytest.mark.parametrize("seed", range(12))
def test_frequencies_and_shares_of_random_bodies(report, seed):
    body = RandomBody(seed, 3 + seed % 4)
    result = report(body.text)
    squares, shapes = np.linalg.eig(np.linalg.solve(body.mass, body.stiffness.real))
    rising = np.argsort(squares.real)
    omega = list_omega(result)
    assert omega == pytest.approx(np.sqrt(squares.real[rising]), rel=1e-11)
    for mode, k in zip(result.modes, rising, strict=True):
        parts = shapes[:, k].real * (body.mass @ shapes[:, k].real)
        shares = list(mode.energy_percent.values())
        assert shares == pytest.approx(100 * parts / parts.sum(), rel=1e-7, abs=1e-7)
        assert mode.loss_factor == pytest.approx(0.1, rel=1e-10)


def test_rest(report):
    body = RandomBody(3, 4)
    result = report(body.text)
    weight = np.array([-body.mass[0, 0] * 9.80665, 0, 0, 0, 0, 0])
    motion = np.linalg.solve(body.static, weight)
    for mount, at in zip(result.static.mounts, body.at, strict=True):
        assert mount.travel_mm == pytest.approx(1e3 * move(motion, at - body.centre), rel=1e-9)
    assert rest_of(result).sum(axis=0) == pytest.approx(weight[:3], abs=1e-9)
    assert result.stiffness_N_per_m == pytest.approx(body.stiffness.real, rel=1e-10)


def find_own_loads(centre, orders):
    """By momentum on a grid: (orders, 6) about the centre, at the engine's speed; its own reference
    point is the middle of the throws, where the file has its origin.
    """
    curves = momentum.Engine.read(ENGINE).curves()
    grid = len(momentum.THETA)

    def phasor(values, n):
        return 2 * np.fft.fft(values)[n] / grid

    loads = []
    for n in orders:
        force = np.array([phasor(curves.force.real, n), phasor(curves.force.imag, n), 0])
        turning = [phasor(curves.moment.real, n), phasor(curves.moment.imag, n)]
        moment = np.array([*turning, phasor(curves.roll, n)])
        loads.append(np.concatenate([force, moment + np.cross(-centre, force)]))
    return np.array(loads)


def find_own_motion(body, load, w):
    dynamic = body.stiffness + 1j * w * body.damping - w**2 * body.mass
    return np.linalg.solve(dynamic, load)


def move(motion, arm):
    return motion[:3] + np.cross(motion[3:6], arm)


def find_largest(vector):
    """Longer semi-axis of the ellipse of Re(vector e^{iwt})."""
    return np.sqrt((np.sum(np.abs(vector) ** 2) + abs(np.sum(vector**2))) / 2)


@pytest.mark.parametrize(("seed", "damping"), [(1, 0.0), (2, 0.4), (5, 0.0)])
def test_forces_and_motion_by_order(report, seed, damping):
    """Each order at each speed by its own complex equations, with loads by momentum."""
    body = RandomBody(seed, 4, damping=damping)
    result = report(ENGINE + body.text, orders=[1, 2, 4])
    loads = find_own_loads(body.centre, [1, 2, 4])
    for n, order in enumerate((1, 2, 4)):
        for s, rpm in enumerate(SPEEDS):
            w = order * rpm * np.pi / 30
            motion = find_own_motion(body, loads[n] * (rpm / 3000) ** 2, w)
            for k, at in enumerate(body.at):
                own = body.each[k] + 1j * w * damping * 1e3 * np.eye(3)
                largest = find_largest(own @ move(motion, at - body.centre))
                assert result.response.mounts[k].orders[n].force_N[s] == pytest.approx(largest, rel=1e-10)
            largest = find_largest(move(motion, body.point - body.centre))
            assert result.response.points[0].orders[n].motion_mm[s] / 1e3 == pytest.approx(largest, rel=1e-10)


def test_all_orders_add_up_in_time(report):
    """On a fine grid of crank angles: never more than is told, and as much to the grid's width."""
    body = RandomBody(7, 3)
    result = report(ENGINE + body.text, orders=[1, 2, 3, 4, 6])
    orders = np.array([1, 2, 3, 4, 6])
    loads = find_own_loads(body.centre, orders)
    angles = np.linspace(0, 2 * np.pi, 20001)
    for s, rpm in enumerate(SPEEDS):
        curve = np.zeros((3, len(angles)))
        for n, load in zip(orders, loads, strict=True):
            motion = find_own_motion(body, load * (rpm / 3000) ** 2, n * rpm * np.pi / 30)
            force = body.each[1] @ move(motion, body.at[1] - body.centre)
            curve += (force[:, None] * np.exp(1j * n * angles)).real
        highest = np.linalg.norm(curve, axis=0).max()
        assert result.response.mounts[1].peak_N[s] == pytest.approx(highest, rel=1e-6)


def test_stiff_mounts_pass_on_all_there_is(report):
    """The limit of an engine that stands rigidly: mount forces add up to the free forces."""
    text = ENGINE + block("loss = 0.01").replace("[200, 150, 400]", "[2e11, 1.5e11, 4e11]")
    response = report(text).response
    for passed in response.passed:
        for key, load in passed.rigid.items():
            assert passed.on_mounts[key] == pytest.approx(load, rel=1e-6, abs=1e-3)
    assert max(load.max() for passed in response.passed for load in passed.rigid.values()) > 1e3


@pytest.mark.parametrize("loss", [0.1, 0.01, 0.001])
def test_no_resonance_is_too_narrow_to_be_found(report, loss):
    """Between speeds a hundred rpm apart, a range that is fine about every speed at which an order
    meets a mode finds no more.
    """
    text = ENGINE + RandomBody(38, 5, loss).text
    coarse = report(text, speeds=np.arange(200.0, 1501, 100))
    met = np.array([one.speed_rpm for mode in coarse.modes for one in mode.meets])
    near = met[:, None] * (1 + loss * np.linspace(-1, 1, 101))
    speeds = np.unique(np.concatenate([near.ravel(), np.arange(200.0, 1501, 20)]))
    fine = report(text, speeds=speeds[(speeds >= 200) & (speeds <= 1500)]).response
    found = np.array([place.worst[0] for place in (*coarse.response.mounts, *coarse.response.points)])
    highest = np.array([peak.max() for _, _, peak, _ in (*fine.mounts, *fine.points)])
    assert np.all(found >= highest * (1 - 1e-7))
    assert found == pytest.approx(highest, rel=1e-3)


def test_of_modes_that_make_as_much_the_first_is_named(report):
    """A vee at 90 degrees pulls alike in all directions, and mounts that are alike along x and y
    give way alike: rounding errors chose between up and down and sideways.
    """
    vee = ENGINE.replace("[piston]", "[layout]\nbank_angle = 90\n[piston]")
    vee = vee.replace("throws = [0, 180, 180, 0]", "throws = [0]").replace("spacing = 100\n", "")
    vee = vee.replace("[cylinder.2]\npiston_mass = 0.55\n", "")
    body = "[body]\nmass = 100\ncg = [0, 0, 0]\ninertia = [4e6, 5e6, 3e6, 0, 0, 0]\n"
    at = [(200, 200), (200, -200), (-200, 200), (-200, -200)]
    mounts = "".join(
        f'[[mount]]\nname = "{k}"\nat = [0, {y}, {z}]\nstiffness = [99, 99, 150]\nloss = 0.1\n'
        for k, (y, z) in enumerate(at)
    )
    found = report(f"{vee}{body}{mounts}", orders=[1])
    equal = [k for k, mode in enumerate(found.modes) if max(mode.energy_percent[axis] for axis in "xy") > 99]
    assert len(equal) == 2
    assert {mount.worst.mode for mount in found.response.mounts} == {equal[0]}


def test_a_scheme_takes_away_what_it_is_for(report):
    """Shafts cancel the second-order force; the roll stays, and the mounts feel that."""
    text = ENGINE.replace("[cylinder.2]\npiston_mass = 0.55\n", "") + RandomBody(9, 4).text
    result = report(text, orders=[2], scheme="two-shaft")
    before = result.response.passed[0].rigid
    after = result.fitted.response.passed[0].rigid
    for key in ("force_x_N", "force_y_N"):
        assert np.max(after.get(key, 0.0)) == pytest.approx(0, abs=1e-9 * before["force_x_N"][0])
    assert after["moment_z_Nm"][0] > 0.1
    peaks = [[m.peak_N.max() for m in each.response.mounts] for each in (result.fitted, result)]
    assert max(peaks[0]) < max(peaks[1])


GAS = ENGINE.replace("[cylinder.2]", "[layout]\nfiring_order = [1, 3, 4, 2]\n[cylinder.2]\ngas = 0") + (
    '[gas]\ncycle = "wiebe"\ncompression_ratio = 10\nimep = 9\n'
)


def test_gas_rolls_the_body_alike_at_every_speed(report):
    """A misfire has half orders; torque on the body is the reaction to that on the crank, which does
    not grow with the speed as inertia does.
    """
    body = RandomBody(6, 4)
    orders = [0.5, 1, 1.5, 2]
    result = report(GAS + body.text, orders=orders)
    plain = report(ENGINE + body.text, orders=orders)
    torque = compute_spectra(build_text(GAS), np.array(orders), ["gas"])["gas"].x
    assert np.abs(torque).min() > 1
    assert plain.response.loads.gas is None
    inertia = plain.response.loads.inertia
    for n, order in enumerate(orders):
        for s, rpm in enumerate(SPEEDS):
            load = inertia[n] * (rpm / 3000) ** 2 - np.array([0, 0, 0, 0, 0, torque[n]])
            motion = find_own_motion(body, load, order * rpm * np.pi / 30)
            largest = find_largest(move(motion, body.point - body.centre))
            assert result.response.points[0].orders[n].motion_mm[s] / 1e3 == pytest.approx(largest, rel=1e-9)


MEAN = 9e5 * 4 * np.pi / 4 * 0.08**2 * 0.09 / (4 * np.pi)  # imep V / (4 pi)


def test_the_mean_torque_leans_on_the_mounts(report):
    """Three of four cylinders fire; the crank turns from x to y, so that the body leans the other way. Of a genset the
    mean torque acts between engine and generator, both on the same skid: the mounts bear the weight alone.
    """
    body = RandomBody(6, 4)
    text = GAS + RandomBody(6, 4).text
    apart, aboard = (report(text.replace("[body]\n", f"[body]\n{said}")) for said in ("", "carries_load = true\n"))
    assert apart.response.loads.mean == pytest.approx(-0.75 * MEAN, rel=1e-6)
    about = np.cross(np.array(body.at) - body.centre, rest_of(apart)).sum(axis=0)
    assert about == pytest.approx([0, 0, -0.75 * MEAN], rel=1e-6, abs=1e-6)
    weight = rest_of(report(ENGINE + body.text))
    assert rest_of(aboard) == pytest.approx(weight, rel=1e-12, abs=1e-9)
    assert np.abs(rest_of(apart) - weight).max() > 10
    for mounts in zip(aboard.response.mounts, apart.response.mounts, strict=True):
        assert np.array_equal(*(mount.peak_N for mount in mounts))


@pytest.mark.parametrize(("share", "leans"), [("1", 0.85), ("0", 0.75)])
def test_friction_does_not_lean_on_the_mounts(report, share, leans):
    """It acts between parts of the body, which feels the brake torque, that of the load; with a misfire, whose friction
    nobody knows, the indicated one.
    """
    text = GAS.replace("gas = 0", f"gas = {share}") + "mechanical_efficiency = 0.85\n"
    uneven = text.replace("speed = 3000", "speed = 3000\nspeed_ripple = [{ order = 2, amplitude = 0.2 }]")
    for each in (text, uneven):  # a constant load takes the mean over the crank angle, not over the time
        found = report(each + RandomBody(6, 4).text, speeds=np.array([3000.0]), orders=[2]).response.loads.mean
        assert found == pytest.approx(-leans * MEAN, rel=1e-6)


def test_modes_of_a_block_and_where_orders_meet_them(report):
    result = report(ENGINE + block("loss = 0.05"), speeds=np.array([200.0, 2000.0]))
    upright = [mode.frequency_Hz for mode in result.modes if mode.motion == "up and down"]
    assert upright == pytest.approx([np.sqrt(4 * 400e3 / 200) / (2 * np.pi)], rel=1e-14)
    met = [(mode, one) for mode in result.modes for one in mode.meets]
    assert met
    for mode, one in met:
        assert one.speed_rpm * one.order / 60 == pytest.approx(mode.frequency_Hz)
        assert 200 <= one.speed_rpm <= 2000


# ------------------------------------------------------------------ what cannot be
def refused(report, text, **options):
    with pytest.raises(BalcliError) as caught:
        report(text, **options)
    return str(caught.value)


def test_an_undamped_resonance_in_the_range_is_named(report):
    """Also where it lies between the speeds of a range; a list of speeds has none between them."""
    text = ENGINE + block()
    speeds = np.array([300.0, 2000.0])
    assert refused(report, text, speeds=speeds, orders=[2]) == (
        "engine.toml: mode 4 (roll, 17.43 Hz) is not damped, and order 2 drives it at 523.037 rpm, "
        "where its motion has no bound; give the mounts a loss, such as loss = 0.1, or a range "
        "without that speed"
    )
    found = report(text, speeds=speeds, orders=[2], ranged=False).response
    for mount in found.mounts:
        assert mount.worst.force_N == mount.peak_N.max()


@pytest.mark.parametrize(
    ("text", "motion"),
    [
        (block(count=2), "turning about y"),
        (block().replace("[200, 150, 400]", "[200, 0, 400]"), "moving along y"),
    ],
)
def test_a_motion_that_nothing_holds_is_named(report, text, motion):
    assert refused(report, text) == (
        f"engine.toml: mount: nothing holds the body against {motion}; give a mount that does, or "
        "stiffness along another axis"
    )


def test_what_is_not_known_is_told(report):
    told = describe_free_motion(np.array([0, 3, 0, 0.8, 6e-17, 0.6]))
    assert told == "turning about (1, 0, 0.75)"
    text = ENGINE.replace("spacing = 100\n", "") + block("loss = 0.1")
    assert refused(report, text).startswith("engine.toml: moments are not known")


RIPPLE = ENGINE.replace(
    "speed = 3000",
    "speed = 3000\nspeed_ripple = [{ order = 2, amplitude = 0.2, angle = 30 }, { order = 1, amplitude = 0.05 }]",
)


def test_at_uneven_speed_an_order_is_so_often_in_a_turn_of_equal_steps_of_time(report):
    """What shakes the mounts is a frequency: forces over the crank angle are not yet those over the time, and the speed is
    revolutions in a minute.
    """
    theta, period = run_in_time(lambda a: 1 + 0.2 * np.cos(2 * a - np.radians(30)) + 0.05 * np.cos(a), 1)
    few = np.r_[-39:40]
    longer = period / (2 * np.pi)
    to_time = np.exp(1j * np.outer(theta, few))
    body = RandomBody(8, 4)
    orders = [1, 2, 3, 4]
    result = report(RIPPLE + body.text, orders=orders)
    curves = momentum.Engine.read(RIPPLE).curves()
    parts = [curves.force.real, curves.force.imag, 0 * curves.roll]
    parts += [curves.moment.real, curves.moment.imag, curves.roll]
    values = to_time @ np.array([np.fft.fft(part, norm="forward")[few] for part in parts]).T
    loads = 2 * np.fft.fft(values.real, axis=0, norm="forward")[orders]
    loads[:, 3:] += np.cross(-body.centre, loads[:, :3])
    for n, order in enumerate(orders):
        for s, rpm in enumerate(SPEEDS):
            load = loads[n] * (rpm * longer / 3000) ** 2
            motion = find_own_motion(body, load, order * rpm * np.pi / 30)
            for key, own in zip(COMPONENTS, np.abs(load), strict=True):
                rigid = result.response.passed[n].rigid.get(key, np.zeros(len(SPEEDS)))
                assert rigid[s] == pytest.approx(own, rel=1e-6, abs=1e-3)
            largest = find_largest(move(motion, body.point - body.centre))
            assert result.response.points[0].orders[n].motion_mm[s] / 1e3 == pytest.approx(largest, rel=1e-6)


def test_a_dashpot_alone_holds_a_mount(report):
    """The force that it transmits is that of its damping, so that its travel is ordinary; on its
    soft spring alone the same force would be half a metre.
    """
    soft = block("damping = [5, 5, 5]").replace("stiffness = [200, 150, 400]", "stiffness = [2, 2, 2]")
    found = report(ENGINE + soft)
    assert max(mount.worst.force_N for mount in found.response.mounts) / 2e3 > 0.05
    assert found.doubts == ()


def test_the_leading_mode_is_that_of_the_whole_force_not_of_one_direction(report):
    """An engine that lies on its side shakes along y: the mode that makes most of the largest force moves that way."""
    found = report(ENGINE + "[layout]\nbanks = [90]\n" + block(), orders=[2])
    for mount in found.response.mounts:
        shape = np.abs(found.modes[mount.worst.mode].shape[:3])
        assert shape.argmax() == 1


@pytest.mark.parametrize("seed", [1, *slow(0, 2, 3, 4, 5)])
def test_gas_orders_that_resonate_are_found(report, seed):
    """Peak of a slow engine against a dense grid of speeds with orders to 80."""
    rng = np.random.default_rng(seed)
    gas = (
        f'[layout]\nfiring_order = [1, 3, 4, 2]\n[gas]\ncycle = "wiebe"\n'
        f"compression_ratio = {rng.uniform(9, 19):.3g}\nimep = {rng.uniform(4, 15):.3g}\n"
        f"burn_duration = {rng.uniform(15, 60):.3g}\n"
    )
    engine = ENGINE.replace("speed = 3000", f"speed = {rng.uniform(80, 600):.4g}")
    text = engine + gas + RandomBody(seed, 4, loss=float(rng.uniform(0.02, 0.2))).text
    low = float(rng.uniform(60, 300))
    found = report(text, speeds=np.linspace(low, 1.5 * low, 9)).response
    assert found.orders[-1] >= 12
    every = report(text, speeds=np.linspace(low, 1.5 * low, 601), orders=np.arange(1, 161) / 2)
    for mount, dense in zip(found.mounts, every.response.mounts, strict=True):
        assert mount.worst.force_N == pytest.approx(dense.peak_N.max(), rel=1e-3)
