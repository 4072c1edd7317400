"""Which orders there are."""

import numpy as np
import pytest
from support.cases import cases
from support.engines import build_text
from support.gas_engines import FOUR, WIEBE
from support.paths import ENGINES

from balcli import load
from balcli.analysis.answer import analyze
from balcli.analysis.two_engines import Arrangement, combine_engines
from balcli.analysis.verdict import Rocking
from balcli.core.phasors import Phasors
from balcli.crank_torque.answer import torque
from balcli.engine.engine import take_model
from balcli.errors import BalcliError
from balcli.forces.guide import compute_guide_moments
from balcli.forces.spectrum import Spectra, choose_orders, is_order, mark_considerable, parse_order
from balcli.mounting.loads import find_loads
from balcli.torsional_vibration.build import excite_engine


@cases("forces/orders", "the_order_that_a_text_names")
def test_the_order_that_a_text_names(text: str, order: float | None) -> None:
    assert parse_order(text) == order


def test_orders_are_halves_of_whole_numbers() -> None:
    good = (0, 0.5, 1.5, 4096)
    bad = (4096.5, -1, -0.5, 1.25, float("nan"))
    wanted = dict.fromkeys(good, True) | dict.fromkeys(bad, False)
    assert {number: is_order(number) for number in wanted} == wanted


def curve(orders: list[float], sizes: list[float]) -> Phasors:
    forward = np.array(sizes, complex)
    return Phasors.of(np.array(orders), forward, 0 * forward, np.zeros(len(orders)))


def test_an_order_is_considerable_beside_the_largest_unless_it_is_very_high() -> None:
    phasors = curve([1, 2, 3, 512, 513], [5e6, 4.9, 5.1, 6, 5e6])
    assert mark_considerable(phasors).tolist() == [True, False, True, True, False]


def test_orders_to_2_and_all_considerable_ones_are_shown() -> None:
    orders = [1.0, 2.0, 3.0, 4.0]
    found = Spectra(
        np.array(orders), kinds={"force": curve(orders, [0, 0, 1, 0]), "couple": curve(orders, [1, 0, 0, 0])}
    )
    assert choose_orders(found, ()).tolist() == [1, 2, 3]


def test_orders_of_firing_are_shown_however_high():
    """Fourteen cylinders of two strokes: order 14 is the first in which they do not cancel."""
    count = 14
    text = (
        FOUR.replace("throws = [0, 180, 180, 0]\n", "")
        .replace("firing_order = [1, 3, 4, 2]", "{}\nstrokes = 2")
        .replace("mass = 0.5\n", "mass = 0.5\noffset = 2\n")
    )
    subject = build_text(text.format(f"firing_order = {[*range(1, count + 1)]}") + WIEBE)
    one = analyze(build_text(text.format("") + WIEBE), [14, 28], ["gas"]).spectra.gas
    for found in (
        analyze(subject).spectra.gas,
        analyze(subject, only=["gas"]).spectra.gas,
        torque(subject).spectra.gas,
    ):
        assert found.orders[-2:].tolist() == [14, 28]
        assert found.major[-2:] == pytest.approx(count * one.major, rel=1e-9)
    assert compute_guide_moments(subject).h.orders[-2:].tolist() == [14, 28]
    assert 14 in find_loads(subject, np.zeros(3)).orders
    twice = combine_engines(subject, subject, Arrangement()).spectra.gas
    assert twice.major[twice.orders == 14] == pytest.approx(2 * count * one.major[0], rel=1e-9)
    assert {14, 28} <= set(excite_engine(take_model(subject), subject, None).orders.tolist())
    assert analyze(subject).verdict.rocking == Rocking("total", 14)


def test_half_orders_take_gas_in_four_strokes():
    """Without it nothing repeats itself after two revolutions only: a half order is a slip."""
    with pytest.raises(BalcliError) as refused:
        analyze(load(ENGINES / "i4.toml"), [1, 1.5])
    assert str(refused.value) == ("orders 1.5: half orders need [gas] and four strokes, or a shaft at a half order")
    with pytest.raises(BalcliError, match=r"or a shaft at a half order$"):
        analyze(load(ENGINES / "marine" / "marine6.toml"), [1, 1.5])
    found = analyze(load(ENGINES / "i4_wiebe.toml"), [1, 1.5])
    assert found.spectra.orders.tolist() == [1, 1.5]
