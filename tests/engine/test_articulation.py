"""Articulated rods: what the file may say, strokes and dead centres, and what distinguishes them from equal rods."""

import math
import re

import numpy as np
import pytest
from oracle import momentum
from support.cases import cases
from support.engines import RADIAL, build_text

from balcli.core.cylinders import find_travel
from balcli.engine import build as engine, parse as enginefile
from balcli.errors import InputError
from balcli.forces import spectrum
from balcli.forces.spectrum import find_relevant_orders


def built(*changes: tuple[str, str], more: str = "") -> engine.Engine:
    text = RADIAL
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return build_text(text + more)


def mistakes(*changes: tuple[str, str], more: str = "") -> list[str]:
    with pytest.raises(InputError) as caught:
        built(*changes, more=more)
    return [str(problem) for problem in caught.value.problems]


# ------------------------------------------------------------------ the file
@cases("engine/articulation", "what_does_not_fit_together")
def test_what_does_not_fit_together(changes, more, message):
    assert mistakes(*changes, more=more) == [message]


def test_the_masters_own_knuckle_angle_does_not_vary():
    file = enginefile.parse(
        RADIAL.replace("[articulation]", "[articulation]\nknuckle_angles = [0, 50, 100, 150, 200, 250, 300]")
    )
    with pytest.raises(InputError, match="knuckle_angles: has -2 for bank 1, which carries the master rod; give 0"):
        engine.build(file, {"articulation.knuckle_angles.1": np.array([0.0, -2.0])})


def test_a_rod_that_cannot_follow_names_the_cylinder_and_the_crank_angle():
    """Cylinder 3's knuckle pin, on a grid of a quarter of a degree, leaves the cylinder's axis by
    more than its rod is long.
    """
    degrees = np.arange(0, 360, 0.25)
    theta = np.radians(degrees)
    bank = math.radians(720 / 7)
    lean = np.arcsin(60 / 240 * np.sin(theta))
    beside = np.abs(((60 * np.exp(1j * theta) + 52 * np.exp(1j * (bank - lean))) * np.exp(-1j * bank)).imag)
    first, *rest = mistakes(("length = 188", "length = 60"), ("cg = 90", "cg = 30"))
    found = re.fullmatch(
        r"articulation\.rod\.length: the crank cannot turn: at crank angle ([\d.]+) deg the "
        r"knuckle pin of cylinder 3 is ([\d.]+) rod lengths off the path of its piston pin; at most 1 - 1e-06 is "
        r"allowed: make the articulated rod longer or the knuckle radius smaller",
        first,
    )
    assert found
    assert np.interp(float(found[1]), degrees, beside) == pytest.approx(beside.max(), rel=1e-5)
    assert float(found[2]) == pytest.approx(beside.max() / 60, rel=1e-5)
    assert [problem.split("cylinder ")[1][0] for problem in rest] == ["4", "5", "6"]


# ------------------------------------------------------------------ strokes and dead centres
@pytest.mark.parametrize("offset", [0, 7])
def test_strokes_and_dead_centres_against_fine_sampling(offset):
    """Places straight from docs/theory.md, on a grid of 0.001 degrees."""
    psi = np.radians(np.arange(0, 360, 0.001))
    lean = np.arcsin((60 * np.sin(psi) - offset) / 240)
    found = find_travel(built(("mass = 1.3", f"mass = 1.3\noffset = {offset}")).cylinders)
    for k in range(7):
        bank = 2 * math.pi * k / 7
        knuckle = (60 * np.exp(1j * psi) + 52 * (k > 0) * np.exp(1j * (bank - lean))) * np.exp(-1j * bank)
        place = knuckle.real + np.sqrt((188 if k else 240) ** 2 - (knuckle.imag - offset) ** 2)
        assert found.stroke[k] * 1e3 == pytest.approx(np.ptp(place), abs=1e-7)
        top, bottom = (math.degrees(psi[at] - bank) for at in (place.argmax(), place.argmin()))
        assert found.top_deg[k] == pytest.approx((top + 180) % 360 - 180, abs=1e-3)
        assert found.bottom_deg[k] == pytest.approx(bottom % 360 - 180, abs=1e-3)


# ------------------------------------------------------------------ forces
@pytest.mark.parametrize("angles", [(0, 60, 120), (0, 60, -60), (0, 120, -120)])
def test_knuckles_that_differ_in_one_component_alone(angles):
    """Two rods in one direction, hung on opposite sides of the master's big end: against the momentum of every part."""
    text = RADIAL.replace("radial = 7", "banks = [0, 60, 60]").replace(
        "knuckle_radius", f"knuckle_angles = {list(angles)}\nknuckle_radius"
    )
    want = momentum.Engine.read(text).curves()
    found = spectrum.compute_spectra(build_text(text), [1.0, 2.0, 3.0])
    for quantity, phasors in found.items():
        size = max(sum(map(abs, want.order(quantity.name, n))) for n in (1, 2, 3))
        for row, n in enumerate((1, 2, 3)):
            assert (phasors.forward[row], phasors.backward[row]) == pytest.approx(
                want.order(quantity.name, n), abs=1e-10 * size + 1e-9
            )


def highest(c):
    return c.linkage.find_highest_order(c.lam, c.eps)


@pytest.mark.parametrize("angle", [60, 89.999, 90, 90.001, 120, 180])
@pytest.mark.parametrize("rotary", ["", "rotary = true"])
def test_few_orders_far_from_the_lock(angle, rotary):
    """Wherever the master's crank angle comes to a multiple of 90 degrees in a cylinder's frame, too."""
    for master in (1, 2):
        e = built(
            ("radial = 7", f"bank_angle = {angle}\n{rotary}"),
            ("mass = 1.3", "mass = 1.3\noffset = 2.5"),
            ("[articulation]", f"[articulation]\nmaster = {master}"),
        )
        assert len(find_relevant_orders(e)) <= 64


def test_variants_on_a_trailing_axis():
    """A sweep of knuckle radius and rod length gives what each variant alone gives, also at an uneven speed."""
    file = enginefile.parse(RADIAL + "[operation]\nspeed_ripple = [{ order = 2, amplitude = 0.1, angle = 20 }]\n")
    radii = np.array([40.0, 52.0, 60.0])
    lengths = np.array([180.0, 188.0, 230.0])

    def variant(radius, length):
        return engine.build(file, {"articulation.knuckle_radius": radius, "articulation.rod.length": length})

    orders = np.arange(1.0, 7.0)
    many = variant(radii, lengths)
    together = spectrum.compute_spectra(many, orders)
    of_each = [variant(radius, length).cylinders for radius, length in zip(radii, lengths, strict=True)]
    assert highest(many.cylinders) == max(map(highest, of_each))
    for k in range(3):
        alone = spectrum.compute_spectra(variant(radii[k], lengths[k]), orders)
        for (quantity, many), (_, one) in zip(together.items(), alone.items(), strict=True):
            difference = np.abs(np.broadcast_to(many.forward, (6, 3))[:, k] - one.forward).max()
            assert difference <= 1e-12 * np.abs(one.forward).max(initial=1e-9), quantity


# ------------------------------------------------------------------ what articulated rods may say
def test_a_pendulum_test_of_an_articulated_rod_is_its_inertia():
    old = "cg = 90 }"
    period = 2 * math.pi * math.sqrt((3.5e-3 + 0.62 * 0.09**2) / (0.62 * 9.80665 * 0.09))
    swung = built((old, f'cg = 90, pendulum = {{ pivot = "big_end", period = {period!r} }} }}'))
    assert swung.cylinders.couple == pytest.approx(
        built((old, "cg = 90, inertia = 3500 }")).cylinders.couple, rel=1e-12
    )


@cases("engine/articulation", "mistakes_of_articulated_rods")
def test_mistakes_of_articulated_rods(rod, message):
    assert mistakes(("{ length = 188, mass = 0.62, cg = 90 }", rod)) == [message]


def test_rods_given_by_a_ratio_follow_the_stroke_of_their_own_row():
    """A stroke of the first master changes the articulated rods of its row, and no other ones."""
    text = """
        [crank]
        stroke = 120
        throws = [0, 180]
        spacing = 200
        [rod]
        length = 240
        mass = 1.9
        cg = 55
        [piston]
        mass = 1.3
        [layout]
        radial = 5
        rows = 2
        [articulation]
        master = 1
        knuckle_radius = 52
        rod = { ratio = 0.3, mass = 0.62, cg = 30 }
        """
    lengths = {}
    for more in ("", "[cylinder.1]\nstroke = 160\n"):
        own = build_text(text + more)
        rods = np.ravel(own.cylinders.radius / own.cylinders.lam)
        lengths[more] = dict(zip(own.numbers, np.broadcast_to(rods, 10).tolist(), strict=True))
    plain, long_stroke = lengths.values()
    assert [plain[number] for number in range(2, 6)] == pytest.approx([0.2] * 4)
    assert [long_stroke[number] for number in range(2, 6)] == pytest.approx([0.08 / 0.3] * 4)
    assert [long_stroke[number] for number in range(7, 11)] == pytest.approx([0.2] * 4)
    assert long_stroke[1] == long_stroke[6] == pytest.approx(0.24)
