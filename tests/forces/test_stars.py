"""Phasor stars: directions against the closed form, sums against the sums of all cylinders."""

from cmath import exp
from math import radians

import numpy as np
import pytest
from support.commands import ask
from support.engines import inline_engine
from support.paths import ENGINE_FILES, ENGINES

import balcli
from balcli import load
from balcli.analysis.answer import analyze
from balcli.core.records import to_document
from balcli.forces.spectrum import compute_spectra
from balcli.forces.stars import WAYS, find_stars
from balcli.forces.symmetry import without_devices
from balcli.show.plane import draw_polygon, draw_star
from balcli.show.plot_style import open_figure
from balcli.show.units import SI

FIVE = [0, 216, 144, 72, 288]
V8 = [0, 90, 270, 180], "bank_angle = 90"


@pytest.mark.parametrize("order", [1, 2, 4])
def test_directions_in_line(order):
    """Order n of a cylinder with crank angle phi: e^{i n phi} with the crank, e^{-i n phi} against it; a negative
    A_4 turns them by half a turn.
    """
    half = -1 if order == 4 else 1
    for star, sense in zip(find_stars(inline_engine(FIVE), [order]), (1, -1), strict=True):
        (bank,) = star.banks
        for ray, throw in zip(bank.cylinders, FIVE, strict=True):
            expected = half * exp(sense * 1j * order * radians(throw))
            assert ray.force / abs(ray.force) == pytest.approx(expected, abs=1e-12)
            assert ray.moment == pytest.approx(1j * (ray.cylinder - 3) * 0.1 * ray.force, abs=1e-9)


def test_vee():
    """The banks of a cross-plane V8 close each by themselves in force; the moment is left by both in the same sense with
    the crank, and in opposite senses against it.
    """
    ahead, against = find_stars(inline_engine(*V8), [1])
    for star in (ahead, against):
        assert star.force == 0
        assert [bank.force for bank in star.banks] == [0, 0]
        assert [bank.axis_deg for bank in star.banks] == [-45, 45]
    one, other = (bank.moment for bank in ahead.banks)
    assert one == pytest.approx(other, rel=1e-12)
    assert ahead.moment == pytest.approx(2 * one, rel=1e-12)
    one, other = (bank.moment for bank in against.banks)
    assert one == pytest.approx(-other, rel=1e-12)
    assert against.moment == 0
    left, right = (bank.directions for bank in ahead.banks)  # pin 1 points along cylinder 1, at -45
    assert left == {45: [2], 135: [4], 225: [3], 315: [1]}
    assert right == {45: [6], 135: [8], 225: [7], 315: [5]}


@pytest.mark.parametrize("path", ENGINE_FILES, ids=lambda path: path.stem)
def test_sums_are_those_of_the_engine(path):
    """Rays add up to their bank, banks to the star, and the star to the order."""
    engine = load(path)
    orders = np.array([1.0, 2.0, 4.0])
    kinds = ("force", "moment")[: 1 + engine.places_known]
    spectra = compute_spectra(without_devices(engine), orders, kinds)
    for star in find_stars(engine, orders, kinds):
        row = orders.tolist().index(star.order)
        way = WAYS.index(star.turns)
        for kind in kinds:
            every = [getattr(ray, kind) for bank in star.banks for ray in bank.cylinders]
            size = max(map(abs, every))
            assert getattr(star, kind) == spectra[kind].vectors[way, row]
            assert sum(every) == pytest.approx(getattr(star, kind), abs=1e-12 * size)
            for bank in star.banks:
                own = sum(getattr(ray, kind) for ray in bank.cylinders)
                assert getattr(bank, kind) == pytest.approx(own, abs=1e-12 * size)


def test_cylinders_that_stand_alone():
    """The two of a V-twin are banks; those of a radial count as one, which has no direction."""
    twin, radial = (next(find_stars(load(ENGINES / name), [1])) for name in ("vtwin45.toml", "radial7.toml"))
    assert [bank.axis_deg for bank in twin.banks] == [-22.5, 22.5]
    assert [(bank.axis_deg, len(bank.cylinders)) for bank in radial.banks] == [(None, 7)]


def test_the_table_lists_banks_and_sums():
    """Of the same unit in each column; a dash where no cylinder has a moment."""
    table = ask("analyze", ENGINES / "v8_crossplane.toml", "--why", "--orders", "1").partition("Phasor stars\n")[2]
    lines = table.splitlines()[:8]
    assert "force, N  moment, kN·m" in lines[0]
    assert lines[2].split()[-2:] == ["closes", "6.361"]
    assert lines[4].split() == ["all", "banks", "closes", "12.72"]
    single = ask("analyze", ENGINES / "single.toml", "--why", "--orders", "1").partition("Phasor stars\n")[2]
    assert single.splitlines()[2].split()[-2:] == ["24.22", "–"]


def test_pages_say_which_orders_they_leave_out():
    """Eight stars at most are drawn; the directions of the picture are turned as `frame.up` asks."""
    v8 = load(ENGINES / "v8_crossplane.toml")
    few, many = (balcli.plot(v8, "stars", orders=orders) for orders in ([1, 2], [1, 2, 4, 8, 12]))
    assert len(few.axes) == 12
    assert len(many.axes) == 24
    assert "Not drawn" not in few.get_supxlabel()
    assert many.get_supxlabel().endswith("Not drawn: orders 12.")
    each = (inline_engine(*V8, more) for more in ("", "[frame]\nup = 90\n"))
    plain, turned = (balcli.plot(one, "stars", orders=[1]).axes[0] for one in each)
    before, after = (dict(arrows(ax)[0:1]) for ax in (plain, turned))
    assert before != after


def test_there_is_no_star_without_vectors():
    """A single cylinder has no order 3, and no place along the crank from which moments count."""
    assert [star.order for star in find_stars(inline_engine([0]), [0, 1, 3], ["force"])] == [1, 1]


def test_in_the_answer():
    """With `why`: orders 1 and 2, or those asked for; without the moment where only the force is wanted."""
    five = inline_engine(FIVE)
    assert [star.order for star in analyze(five, why=True).stars] == [1, 1, 2, 2]
    (ahead, _) = to_document(analyze(five, [2], "force", why=True))["stars"]
    assert set(ahead) == {"order", "turns", "force_N", "force_deg", "banks"}
    assert not hasattr(analyze(five), "stars")
    assert not hasattr(analyze(five, only="moment", why=True), "stars")


def arrows(ax):
    return [(a.get_position(), a.xy) for a in ax.texts if getattr(a, "arrow_patch", None)]


def test_pictures():
    """A star has an arrow for each cylinder, a polygon its sum as well; its arrows follow each other by direction, so
    that the triangle of a three is drawn as one.
    """
    three = next(find_stars(inline_engine([0, 240, 120]), [1]))
    with open_figure(6, 2) as fig:
        star, force, moment = fig.subplots(1, 3)
        draw_star(star, three, 0.0)
        draw_polygon(force, three, "force", 0.0, SI.force)
        draw_polygon(moment, three, "moment", 0.0, SI.moment)
    assert sorted(text.get_text() for text in star.texts if text.get_text()) == ["1", "2", "3"]
    assert [text.get_text() for text in force.texts if text.get_text()] == ["1", "3", "2"]
    assert len(arrows(star)) == len(arrows(force)) == len(arrows(moment)) == 3  # the middle one has no moment
    assert force.get_title("left") == "force: closes"
    assert moment.get_title("left") == f"moment: {abs(three.moment):.0f} N·m"
    places = arrows(force)
    for (_, tip), (start, _) in zip(places, places[1:] + places[:1], strict=True):
        assert start == pytest.approx(tip, abs=1e-9 * abs(three.banks[0].cylinders[0].force))
