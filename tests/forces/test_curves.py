"""Curves by direct evaluation: equal to the sum of all orders, and to what the mechanism must do."""

from dataclasses import replace

import numpy as np
import pytest
from support.engines import build_text
from support.paths import ENGINES

from balcli.analysis.curves import compute_cylinder_curves, compute_engine_curves, compute_order_curves
from balcli.core.records import write_each
from balcli.engine.build import build
from balcli.engine.parse import parse
from balcli.errors import BalcliError
from balcli.forces.curves import divide_revolution
from balcli.forces.spectrum import compute_spectra, find_relevant_orders
from balcli.show.figures import list_orders

RELATIVE = 1e-12  # of the largest parts that are added up

UNEVEN = """
crank = { stroke = 86, throws = [0, 180, 180, 0], spacing = 93, throw_mass = 0.8 }
rod = { length = 143, mass = 0.6, cg = 40, inertia = 2500 }
piston = { mass = 0.45, offset = 1.2 }
operation = { speed = 3000, speed_ripple = [{ order = 2, amplitude = 0.02, angle = 40 }] }
frame = { reference = [30, -20, 55] }
counterweight = [{ unbalance = 9000, angle = 170, position = -60 }]
shaft = [{ ratio = -2, unbalance = 700, angle = 20, at = [-40, 60], position = 10 }]
slider = [{ order = 2, unbalance = 300, direction = 30, angle = 10, at = [5, 9], position = 20 }]
"""


ARTICULATED = UNEVEN.replace(
    "piston =",
    """layout = { banks = [0, 75, -80] }
articulation = { knuckle_radius = 35, rod = { length = 105, mass = 0.4, cg = 50, inertia = 900 } }
piston =""",
)
ROTARY = UNEVEN.replace("piston =", "layout = { banks = [0, 100, -80], rotary = true }\npiston =")
HUNG = ARTICULATED.replace("80] }", "80], rotary = true }")
SKEW = UNEVEN.replace("[0, 180, 180, 0]", "[0, 100, 220, 30]")  # whose pins do not balance one another
TEXTS = {"uneven": UNEVEN, "skew": SKEW, "articulated": ARTICULATED, "rotary": ROTARY, "rotary with a master rod": HUNG}


def engine(name):
    text = TEXTS[name] if name in TEXTS else (ENGINES / f"{name}.toml").read_text(encoding="utf-8")
    return build(parse(text, name))


def scale(subject):
    """Size of what is added up: force of one cylinder times their number; times a length for moments."""
    c = subject.cylinders
    moving = c.reciprocating + c.rotating + (0 if c.linkage is None else c.linkage.mass / c.lam)
    force = c.count * float(subject.omega) ** 2 * float(np.max(c.radius)) * float(np.max(moving))
    arms = float(np.ptp(c.z)) + float(np.max(np.abs(subject.reference_m))) + float(np.max(c.radius))
    return {True: force, False: force * arms}


@pytest.mark.parametrize(
    "name",
    ["single", "i3", "i4_shafts", "v6_90_split", "v8_crossplane", "vr6", "boxer6", "radial7", "single_shaft", *TEXTS],
)
def test_direct_evaluation_is_the_sum_of_all_orders(name):
    subject = replace(engine(name), up_deg=None)
    angles = divide_revolution(7.5)
    direct = compute_engine_curves(subject, angles)
    orders = compute_order_curves(subject, find_relevant_orders(subject), angles)
    assert set(direct) == set(orders)
    for quantity, curve in direct.items():
        assert np.abs(curve - orders[quantity]).max() <= RELATIVE * scale(subject)[quantity.endswith("_N")], quantity


@pytest.mark.parametrize("name", ["single", "i4", "v6_60", "v12_60", "boxer6", "radial7"])
def test_what_is_zero_is_exactly_zero(name):
    """No rounding noise and no negative zeros beside real figures, which may be as small as 1e-9 of their parts."""
    subject = engine(name)
    curves = compute_engine_curves(subject, divide_revolution(15))
    for quantity, curve in curves.items():
        small = np.abs(curve) <= 1e-13 * scale(subject)[quantity.endswith("_N")]
        assert not curve[small].any(), quantity
        assert not np.signbit(curve[small]).any(), quantity
    if name == "v12_60":
        assert 0 < curves["force_x_N"][3] < 1e-4


def test_a_mean_under_uneven_speed_keeps_its_sign_where_the_documents_say():
    """Order 0 is the mean over the crank angle: in `forward` with signs, in the amplitudes of x and y without them."""
    subject = engine("uneven")
    angles = divide_revolution(0.5)
    (order,) = write_each(list_orders(compute_spectra(subject, [0])))
    mean = {name: float(curve.mean()) for name, curve in compute_engine_curves(subject, angles).items()}
    force = order["force_N"]
    couple = order["couple_Nm"]
    assert force["forward"] == pytest.approx([mean["force_x_N"], mean["force_y_N"]], rel=1e-9)
    assert [force[axis] for axis in "xy"] == [{"amplitude": abs(v), "phase_deg": None} for v in force["forward"]]
    assert (force["backward"], force["axis_deg"], couple["peak_deg"], couple["sin"]) == ([0, 0], None, None, 0)
    assert couple["cos"] == pytest.approx(mean["couple_Nm"], rel=1e-9)
    assert couple["amplitude"] == abs(couple["cos"])


def test_a_revolution_is_divided_from_0_without_360():
    assert divide_revolution().tolist() == list(range(360))
    assert divide_revolution(7)[-1] == 357
    assert divide_revolution(0.1).tolist() == [k / 10 for k in range(3600)]
    assert divide_revolution(0.7)[-2:].tolist() == [359.1, 359.8]
    assert divide_revolution(1 / 3) == pytest.approx(np.arange(1080) / 3, abs=1e-12)
    assert divide_revolution(np.sqrt(2))[100] == pytest.approx(100 * np.sqrt(2), abs=1e-12)
    with pytest.raises(BalcliError, match=r"step 0: give 0.001 to 360 degrees"):
        divide_revolution(0)


@pytest.mark.parametrize("name", ["articulated", "rotary"])
def test_other_mechanisms_by_differences(name):
    """Velocity and acceleration are the slopes of the travel, which is 0 at the top and nowhere less."""
    text = TEXTS[name].replace(", speed_ripple = [{ order = 2, amplitude = 0.02, angle = 40 }]", "")
    subject = build_text(text)
    fine = divide_revolution(0.05)
    omega = float(subject.omega)
    step = np.radians(0.05)
    for number in (1, 6):
        curve = compute_cylinder_curves(subject, number, fine)
        travel = curve["travel_m"]
        assert 0 <= travel.min() < 1e-7
        slope = (np.roll(travel, -1) - np.roll(travel, 1)) / (2 * step) * omega
        bend = (np.roll(travel, -1) - 2 * travel + np.roll(travel, 1)) / step**2 * omega**2
        assert np.abs(slope - curve["velocity_m_per_s"]).max() < 1e-6 * np.abs(slope).max()
        assert np.abs(bend - curve["acceleration_m_per_s2"]).max() < 1e-5 * np.abs(bend).max()


def test_the_rod_swings_as_its_angle_changes():
    """By the closed form of a centred slider-crank (Lu and Meng (1-6)) at steady speed, and by differences at an uneven
    one.
    """
    subject = build(parse((ENGINES / "single.toml").read_text(encoding="utf-8")))
    angles = divide_revolution(15)
    curve = compute_cylinder_curves(subject, 1, angles)
    alpha = np.radians(angles)
    cos_beta = np.sqrt(1 - (0.3 * np.sin(alpha)) ** 2)
    omega = float(subject.omega)
    speed = 0.3 * omega * np.cos(alpha) / cos_beta
    acceleration = -0.3 * (1 - 0.3**2) * omega**2 * np.sin(alpha) / cos_beta**3
    assert curve["rod_speed_rad_per_s"] == pytest.approx(speed, abs=1e-12 * omega)
    assert curve["rod_acceleration_rad_per_s2"] == pytest.approx(acceleration, abs=1e-12 * omega**2)

    uneven = build_text(UNEVEN)
    h = 1e-3
    mid, before, after = (compute_cylinder_curves(uneven, 1, angles + d) for d in (0, -h, h))
    changing = uneven.omega * (1 + 0.02 * np.cos(np.radians(2 * angles - 40)))
    slope = np.radians(after["rod_angle_deg"] - before["rod_angle_deg"]) / (2 * np.radians(h)) * changing
    bend = (after["rod_speed_rad_per_s"] - before["rod_speed_rad_per_s"]) / (2 * np.radians(h)) * changing
    assert mid["rod_speed_rad_per_s"] == pytest.approx(slope, abs=1e-7 * np.abs(slope).max())
    assert mid["rod_acceleration_rad_per_s2"] == pytest.approx(bend, abs=1e-7 * np.abs(bend).max())


def test_a_piston_at_uneven_speed_accelerates_as_its_velocity_changes_in_time():
    """dv/dt is dv/dtheta times the crank speed there."""
    text = TEXTS["uneven"]
    subject = build_text(text)
    h = 1e-3
    angles = divide_revolution(15)
    mid, before, after = (compute_cylinder_curves(subject, 1, angles + d) for d in (0, -h, h))
    omega = subject.omega * (1 + 0.02 * np.cos(np.radians(2 * angles - 40)))
    for name, slope_of in (("velocity_m_per_s", "travel_m"), ("acceleration_m_per_s2", "velocity_m_per_s")):
        slope = (after[slope_of] - before[slope_of]) / (2 * np.radians(h)) * omega
        assert mid[name] == pytest.approx(slope, abs=1e-7 * np.abs(slope).max())


def test_crankshaft_and_flywheel_resist_an_uneven_speed():
    """Each adds -J xi to couple and torque, by differences of the squared speed; the roll has none of it."""
    heavy = SKEW.replace("throw_mass = 0.8", "throw_mass = 0.8, inertia = 60000") + "flywheel = { inertia = 90000 }\n"
    degrees = np.arange(0.0, 360.0)
    bare, found = (compute_engine_curves(build_text(one), degrees) for one in (SKEW, heavy))
    squared = (3000 * np.pi / 30 * (1 + 0.02 * np.cos(np.radians(2 * np.arange(-0.5, 360) - 40)))) ** 2
    added = -(0.15 - 4 * 0.8 * 0.043**2) * np.diff(squared / 2) / np.radians(1)
    for name in ("couple_Nm", "inertia_torque_Nm"):
        np.testing.assert_allclose(found[name] - bare[name], added, atol=1e-3 * np.abs(added).max())
    np.testing.assert_allclose(found["roll_Nm"], bare["roll_Nm"], atol=1e-9 * np.abs(added).max())
    subject = build_text(heavy)
    total = compute_spectra(subject, find_relevant_orders(subject), ["couple"])["couple"]
    np.testing.assert_allclose(total.values(np.radians(degrees)).real, found["couple_Nm"], rtol=0, atol=1e-9)
