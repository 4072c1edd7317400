"""Sizing at numerical extremes: whatever is promised to vanish is below 1e-12 of what was there, or
there is an error that says why.
"""

import numpy as np
import pytest
from hypothesis import example, given, strategies as st
from support.engines import build_text, engine_text
from support.remedies import figures, fit_scheme, size_scheme

from balcli.engine.engine import Engine
from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.options import SCHEMES, SchemeOptions
from balcli.sizing.remedy import fit_devices
from balcli.sizing.sizing import size

pytestmark = pytest.mark.stress

LEFT = 1e-12
# stressed below, or of one cylinder
APART = ("auto", "complete", "compensator", "step", "two-shaft", "ellipse", "eccentric-slider", "oldham")


def share_left(engine: Engine, after: Engine, quantities=("force", "moment")) -> float:
    """Largest of what is left of orders 1 and 2, against the largest of the same quantity before."""
    before = compute_spectra(engine, [1, 2], quantities)
    rest = compute_spectra(after, [1, 2], quantities)
    return max(float(getattr(rest, q).major.max() / (getattr(before, q).major.max() or 1)) for q in quantities)


def random_engine(seed: int) -> Engine:
    """Up to five throws and three banks at any angles, unequal pistons, offsets and positions."""
    r = np.random.default_rng(seed)
    throws = int(r.integers(1, 6))
    banks = int(r.integers(1, 4))
    more = "".join(
        f"[cylinder.{n}]\npiston_mass = {10 ** r.uniform(-3, 1)}\n"
        for n in range(1, throws * banks + 1)
        if r.random() < 0.3
    )
    return build_text(
        engine_text(
            crank=f"stroke = 100\nthrows = {r.uniform(0, 360, throws).tolist()}\n"
            f"positions = {np.sort(r.uniform(-400, 400, throws)).tolist()}\nthrow_mass = {r.uniform(0, 3)}",
            rod=f"ratio = {r.uniform(0.05, 0.5)}\nmass = {r.uniform(0, 2)}\ncg = {r.uniform(0, 100)}",
            piston=f"mass = 1\noffset = {r.choice([0.0, 3.0, -8.0])}",
            layout=f"banks = {list(map(float, r.uniform(-180, 180, banks)))}\nstagger = {r.choice([0.0, 22.0])}",
            frame=f"reference = [{r.uniform(-50, 50)}, {r.uniform(-50, 50)}, {r.uniform(-300, 300)}]",
        )
        + more
    )


@given(st.integers(0, 2**32))
@example(409)
@example(790)
@example(33446)
def test_complete_leaves_nothing_in_any_engine(seed):
    engine = random_engine(seed)
    after = compute_spectra(fit_scheme(engine, "complete"), [1, 2], ("force", "moment"))
    assert after.force.balanced.all()
    assert after.moment.balanced.all()


@given(st.integers(0, 2**32))
def test_pairs_add_no_roll_in_any_engine(seed):
    engine = random_engine(seed)
    remedy = size_scheme(engine, "two-shaft", order=2, at=(0.05 - 0.03j,))
    before, after = (
        compute_spectra(e, [2], ("force", "roll", "torque", "couple")) for e in (engine, fit_devices(engine, remedy))
    )
    assert after.force.balanced.all()
    x, y, _ = engine.reference_m  # no roll is added about the crank axis
    p = complex(x, y)
    moved = 2 * before.force.about(p).forward[0]
    scale = before.torque.major[0] + before.couple.major[0] + abs(moved) + before.force.major[0] * 0.1
    assert abs(2 * after.roll.forward[0] - 2 * before.roll.forward[0] - moved) <= 1e-11 * scale


@given(st.integers(0, 2**32), st.sampled_from([each for each in SCHEMES if each not in APART]))
def test_no_scheme_breaks(seed, scheme):
    engine = random_engine(seed)
    options = SchemeOptions(planes=(-0.21, 0.3) if scheme == "couple-shaft" else None, small=0)
    remedy = size(engine, scheme, options)
    assert all(d.unbalance >= 0 and np.isfinite(d.unbalance) for d in remedy.devices)
    assert len(remedy.reasons) == len(remedy.devices)
    after = compute_spectra(fit_devices(engine, remedy), [1, 2], ("force", "moment"))
    if scheme == "four-shaft":
        assert after.force.balanced.all()
    if scheme == "counterweights":
        assert after.force.forward[0] == after.moment.forward[0] == 0
    if scheme == "slider":
        assert compute_spectra(fit_devices(engine, remedy), [remedy.order], ("force",)).force.balanced.all()
    if scheme == "couple-shaft":
        assert compute_spectra(fit_devices(engine, remedy), [remedy.order], ("moment",)).moment.balanced.all()


@pytest.mark.parametrize("light", [1e-3, 1e-6])
def test_a_gram_next_to_a_hundred_tonnes(light):
    """Beside 100 t a gram is 1e-8, and its part of the moment must vanish with the rest."""
    engine = build_text(
        engine_text(crank="stroke = 100\nthrows = [0, 90]\nspacing = 100", piston="mass = 1e5")
        + f"[cylinder.2]\npiston_mass = {light}\n"
    )
    assert share_left(engine, fit_scheme(engine, "complete")) <= LEFT
    alone = build_text(engine_text(crank="stroke = 100\nthrows = [0, 90]\nspacing = 100", piston=f"mass = {light}"))
    assert share_left(alone, fit_scheme(alone, "complete")) <= LEFT


@pytest.mark.parametrize("apart", [100, 1, 0.1])
def test_planes_next_to_each_other(apart):
    """Planes 1 mm apart in an engine of 200 mm: the unbalances grow a hundredfold, and still nothing is left."""
    engine = build_text(engine_text(crank="stroke = 100\nthrows = [0, 240, 120]\nspacing = 100\nthrow_mass = 2"))
    remedy = size_scheme(engine, "counterweights", planes=(0.05, 0.05 + apart / 1e3))
    before, after = (compute_spectra(e, [1], ("force", "moment")) for e in (engine, fit_devices(engine, remedy)))
    assert abs(after.moment.forward[0]) <= LEFT * before.moment.major[0]
    assert abs(after.force.forward[0]) * 0.1 <= LEFT * before.moment.major[0]
    system = [[1, 1], [0.05 / (0.05 + apart / 1e3), 1]]  # force, and moment by the longest arm
    assert figures(remedy)["condition number"] == pytest.approx(np.linalg.cond(system), rel=1e-6)


@pytest.mark.parametrize("apart", [1e-9, 1e-6])
def test_hopeless_planes_are_refused(apart):
    """A nanometre, or a micrometre: rounding alone would leave more than the promised 1e-12."""
    engine = build_text(engine_text(crank="stroke = 100\nthrows = [0, 240, 120]\nspacing = 100"))
    with pytest.raises(BalcliError, match=r"work against each other, .* choose planes farther apart"):
        size_scheme(engine, "counterweights", planes=(0.05, 0.05 + apart))


@pytest.mark.parametrize("scale", [1e-6, 1, 1e6])
def test_remedies_grow_with_the_masses(scale):
    """Unbalance is linear in mass."""

    def weights(mass):
        crank = f"stroke = 100\nthrows = [0, 90, 250]\nspacing = 100\nthrow_mass = {2 * mass!r}"
        text = engine_text(crank=crank, piston=f"mass = {mass!r}")
        return np.array([d.unbalance for d in size(build_text(text)).devices])

    assert weights(scale) == pytest.approx(scale * weights(1.0), rel=1e-12)
