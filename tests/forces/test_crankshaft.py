"""Inner forces and moments against statics worked out here, and the classical comparison of in-line engines."""

import numpy as np
import pytest
from support.engines import INLINE, alone, build_text, inline_engine
from support.paths import ENGINES
from support.remedies import weigh

from balcli import load
from balcli.errors import BalcliError
from balcli.forces import spectrum
from balcli.forces.crankshaft import compute_inner_loads
from balcli.forces.guide import compute_guide_moments

ORDERS = np.arange(1.0, 5.0)
OMEGA = 3000 * np.pi / 30
ROTATING = (1.0 + 0.6 * (160 - 45) / 160) * 0.045 * OMEGA**2  # N, of one throw
RECIPROCATING = (0.5 + 0.6 * 45 / 160) * 0.045 * OMEGA**2


def test_the_first_order_along_an_inline_four():
    """Loads +1 -1 -1 +1, 100 mm apart: shear 1 0 -1 0, moment about the section 0 -100 -100 0 (times i)."""
    found = compute_inner_loads(inline_engine([0, 180, 180, 0]), ORDERS)
    assert found.shear.z_m == pytest.approx([-0.15, -0.05, 0.05, 0.15])
    ahead = ROTATING + RECIPROCATING / 2
    against = RECIPROCATING / 2
    for got, pattern, factor in ((found.shear, [1, 0, -1, 0], 1), (found.bending, [0, -0.1, -0.1, 0], 1j)):
        assert got.phasors.forward[0] == pytest.approx(np.array(pattern) * factor * ahead, rel=1e-12, abs=1e-9)
        assert got.phasors.backward[0] == pytest.approx(np.array(pattern) * factor * against, rel=1e-12, abs=1e-9)


def test_an_inline_six_has_a_large_inner_moment_and_counterweights_take_most_of_it():
    """0-120-240-240-120-0: nothing is free, but the middle carries what three throws on one side make."""
    throws = [0, 120, 240, 240, 120, 0]
    places = range(-250, 251, 100)
    size = (ROTATING + RECIPROCATING / 2) / OMEGA**2 * 1e6
    weights = "".join(weigh(size, angle + 180, place) for angle, place in zip(throws, places, strict=True))
    engines = [inline_engine(throws, more=more) for more in ("", weights)]
    assert all(spectrum.compute_spectra(each, [1.0], ["moment"]).moment.balanced[0] for each in engines)
    before, after = (compute_inner_loads(each, ORDERS).bending for each in engines)
    statics = abs(sum((z + 50) * np.exp(1j * np.radians(a)) for z, a in ((-250, 0), (-150, 120), (-50, 240)))) / 1e3
    middle = abs(before.phasors.forward[0, 2])
    assert middle == pytest.approx(statics * (ROTATING + RECIPROCATING / 2), rel=1e-12)
    assert np.abs(after.phasors.forward[0]).max() < 1e-9 * middle
    assert before.peaks[before.largest].value > 3 * after.peaks[after.largest].value


@pytest.mark.parametrize("layout", ["", "bank_angle = 70\nstagger = 20"])
def test_beyond_the_last_load_stand_free_force_and_moment_which_the_bearings_carry(layout):
    last = 0.1 + (0.01 if layout else 0)
    weight = "[[counterweight]]\nunbalance = 30000\nangle = 99\nposition = -20\n"
    subject = inline_engine([0, 90, 200], layout, f"[frame]\nreference = [0, 0, {last * 1e3}]\n{weight}")
    found = compute_inner_loads(subject, ORDERS)
    free = spectrum.compute_spectra(subject, ORDERS)
    assert found.shear.z_m[-1] == pytest.approx(last)
    assert found.bearings.z_m == pytest.approx([-0.15, -0.05, 0.05, 0.15])
    bearings = found.bearings.phasors
    for way in ("forward", "backward"):
        force = getattr(free.force, way)
        moment = getattr(free.moment, way)
        arms = getattr(bearings, way) @ (found.bearings.z_m - last)
        for along, whole in ((found.shear, force), (found.bending, moment)):
            assert getattr(along.phasors, way)[:, -1] == pytest.approx(whole, rel=1e-11, abs=1e-8)
        assert getattr(bearings, way).sum(axis=1) == pytest.approx(force, rel=1e-11, abs=1e-8)
        assert 1j * arms == pytest.approx(moment, rel=1e-11, abs=1e-8)


def test_the_x_type_is_the_moment_of_the_side_forces_on_the_pistons():
    """Couples from the motion of the pistons, with the rods' masses at their ends, times the places
    of the cylinders, over the height of the guide: as MAN's project guides define it (17.05).
    """
    text = INLINE.format(throws=[0, 120, 240, 240, 120, 0], layout="")
    theta = np.arange(256) * 2 * np.pi / 256
    r = 0.045
    rod = 0.160
    point_masses = 0.6 * 45 * (160 - 45)  # m a b: what the two ends have, in kg mm^2
    subject = build_text(text.replace("inertia = 2000", f"inertia = {point_masses}"))
    mass = 0.5 + 0.6 * 45 / 160
    couples = []
    for pin in np.radians([0, 120, 240, 240, 120, 0]):
        wave = np.fft.fft(_height_of_pin(theta + pin, r, rod)) / 256
        order = np.fft.fftfreq(256, 1 / 256)
        acceleration = np.fft.ifft(-(order**2) * OMEGA**2 * wave * 256).real
        tilt = np.arcsin(r / rod * np.sin(theta + pin))
        couples.append(mass * acceleration * np.tan(tilt) * _height_of_pin(theta + pin, r, rod))
    places = np.array([-250, -150, -50, 50, 150, 250]) / 1e3
    for height_m, length in ((None, rod), (0.2, 0.2)):
        found = compute_guide_moments(subject, ORDERS, height_m)
        wanted = np.fft.fft(places @ np.array(couples) / length) / 128
        assert found.x.major == pytest.approx(abs(wanted[1:5]), rel=1e-9, abs=1e-6)
    roll = spectrum.compute_spectra(subject, ORDERS).roll
    assert found.h.forward == pytest.approx(roll.forward, rel=1e-11, abs=1e-9)


def _height_of_pin(angle, r, rod):
    return r * np.cos(angle) + np.sqrt(rod**2 - (r * np.sin(angle)) ** 2)


# ------------------------------------------------------------------ cylinder by cylinder, and near the lock
@pytest.mark.parametrize("name", ["w12", "vr6", "radial9", "car/tsinghua_ca72", "ripple"])
def test_each_cylinder_is_what_it_is_alone(name):
    layout = "firing_order = [1, 3, 4, 2]" if name == "ripple" else ""
    ripple = "speed_ripple = [{order = 2, amplitude = 0.02, angle = 30}]\n"
    subject = inline_engine([0, 180, 180, 0], layout, ripple) if name == "ripple" else load(ENGINES / f"{name}.toml")
    together = spectrum.compute_spectra(subject, ORDERS, by_cylinder=True)
    for row, number in enumerate(subject.numbers):
        for quantity, single in spectrum.compute_spectra(alone(subject, number), ORDERS).items():
            one = together.select_place(row)
            np.testing.assert_allclose(one[quantity.name].forward, single.forward, rtol=1e-14)
            np.testing.assert_allclose(one[quantity.name].backward, single.backward, rtol=1e-14)
            np.testing.assert_array_equal(one[quantity.name].noise, np.broadcast_to(single.noise, one.orders.shape))


def near_the_lock(throws, more=""):
    text = INLINE.replace("length = 160", "ratio = 0.999999").replace("cg = 45\n", "cg = 20\n")
    return build_text(text.format(throws=throws, layout="") + more)


def test_so_many_loads_that_they_would_fill_the_memory_are_refused():
    told = (
        "^32768 orders of 34 single cylinders and counterweights are 1114112 forces, "
        "and at most 1100000 are kept: an engine with longer rods has fewer orders$"
    )
    with pytest.raises(BalcliError, match=told):
        compute_inner_loads(near_the_lock([10 * k for k in range(34)]))
    uneven = near_the_lock([10 * k for k in range(17)], "speed_ripple = [{order = 2, amplitude = 0.01}]\n")
    with pytest.raises(BalcliError, match=r"32773 orders of 17 single cylinders .* at most 550000 are kept"):
        compute_guide_moments(uneven)


def test_more_results_along_the_crank_than_anybody_reads_are_refused():
    told = "^along the crankshaft, 4096 orders of 9 cylinders and counterweights are 36864 results, and at most 32768 "
    with pytest.raises(BalcliError, match=f"{told}are listed; give fewer orders$"):
        compute_inner_loads(inline_engine([0] * 9), np.arange(1.0, 4097))
