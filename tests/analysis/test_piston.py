"""Motion of pistons against the formula differentiated by Fourier; printed values of a textbook."""

import math

import numpy as np
import pytest
from support.commands import ask, ask_csv, ask_json, refusal
from support.engines import GOOD, RADIAL, build_text, changed
from support.paths import ENGINES

from balcli import BalcliError, load, load_example, piston, sweep
from balcli.analysis.piston import TYPE_LIMIT, choose_cylinder

N = 1 << 14


def differentiate(place: np.ndarray) -> np.ndarray:
    orders = np.fft.rfftfreq(N, 1 / N)
    spectrum = np.fft.rfft(place) * 1j * orders
    return np.fft.irfft(np.where(orders < 400, spectrum, 0), N)


def place_of(radius: float, length: float, offset: float = 0.0) -> np.ndarray:
    psi = 2 * np.pi * np.arange(N) / N
    return radius * np.cos(psi) + np.sqrt(length**2 - (radius * np.sin(psi) - offset) ** 2)


@pytest.mark.parametrize(("ratio", "offset"), [(0.2, 0), (0.3, 0), (0.28, 12), (0.45, -9), (0.7, 6)])
def test_extremes_are_those_of_the_curve(ratio, offset):
    text = changed(("length = 160", f"ratio = {ratio}"), ("mass = 0.5", f"mass = 0.5\noffset = {offset}"))
    found = piston(build_text(text)).mechanisms[0]
    omega = 3000 * math.pi / 30
    radius = 0.045
    place = place_of(radius, radius / ratio, offset / 1e3)
    speed = -omega * differentiate(place)
    rate = -(omega**2) * differentiate(differentiate(place))
    top = place.argmax() * 360 / N
    bottom = place.argmin() * 360 / N
    assert found.stroke_m == pytest.approx(np.ptp(place), rel=1e-6)
    assert found.mean_speed_m_per_s == pytest.approx(2 * found.stroke_m * 50)
    assert abs((found.outer_dead_center_own_deg - top + 180) % 360 - 180) < 0.05
    assert abs((found.inner_dead_center_own_deg - bottom + 180) % 360 - 180) < 0.05
    assert found.inward_stroke_deg + found.outward_stroke_deg == pytest.approx(360)
    for each, curve, highest, lowest in (
        (found.velocity, speed, found.velocity.max_m_per_s, found.velocity.min_m_per_s),
        (found.acceleration, rate, found.acceleration.max_m_per_s2, found.acceleration.min_m_per_s2),
    ):
        assert (highest, lowest) == pytest.approx((curve.max(), curve.min()), rel=1e-6)
        at = np.array([each.max_own_deg, each.min_own_deg]) * N / 360
        assert curve[np.rint(at).astype(int) % N] == pytest.approx([highest, lowest], rel=1e-5)
    minima = (rate < np.roll(rate, 1)) & (rate <= np.roll(rate, -1))
    assert found.acceleration.type == np.count_nonzero(minima)
    assert (found.offset_ratio or 0) == pytest.approx(offset / 45)


@pytest.mark.parametrize(("share", "type_"), [(0.999, 1), (1.001, 2)])
def test_the_acceleration_has_two_minima_above_the_limit(share, type_):
    """At the limit the fourth derivative of the path at 180 deg is 0."""
    lam = TYPE_LIMIT
    assert 3 * lam**3 - 4 * lam + 1 == pytest.approx(0, abs=1e-15)
    found = piston(build_text(changed(("length = 160", f"ratio = {share * lam!r}")))).mechanisms[0]
    assert found.acceleration.type == type_
    assert found.two_term.type == 2


def test_two_terms():
    """v = r w (sin psi + lam/2 sin 2 psi), a = r w^2 (cos psi + lam cos 2 psi), by a fine grid."""
    two = piston(load_example("i4")).mechanisms[0].two_term
    lam = 43 / 139
    scale = 0.043 * (7000 * math.pi / 30)
    psi = np.radians(np.arange(0, 360, 0.001))
    speed = scale * (np.sin(psi) + lam / 2 * np.sin(2 * psi))
    rate = scale * (7000 * math.pi / 30) * (np.cos(psi) + lam * np.cos(2 * psi))
    assert two.velocity_max_m_per_s == pytest.approx(speed.max(), rel=1e-9)
    assert two.velocity_max_own_deg == pytest.approx(speed.argmax() / 1000, abs=2e-3)
    assert two.acceleration_max_m_per_s2 == pytest.approx(rate.max(), rel=1e-12)
    assert two.acceleration_min_m_per_s2 == pytest.approx(rate.min(), rel=1e-9)
    assert two.acceleration_min_own_deg == pytest.approx(rate.argmin() / 1000, abs=2e-3)


def test_two_terms_with_an_offset():
    """v = r w (sin psi + lam/2 sin 2 psi - lam xi cos psi) of the engine CA485, offset -1.6 mm, at 4300 rpm."""
    found = piston(load_example("tsinghua_ca485")).mechanisms[0]
    two = found.two_term
    assert round(found.offset_ratio, 5) == -0.03765
    assert (round(two.velocity_max_m_per_s, 4), round(two.velocity_max_own_deg, 2)) == (19.9962, 74.32)
    assert (round(two.velocity_min_m_per_s, 4), round(two.velocity_min_own_deg, 2)) == (-19.8816, 284.68)
    assert (round(two.acceleration_max_m_per_s2, 1), round(two.acceleration_max_own_deg, 2)) == (11233.8, 359.70)
    assert (round(two.acceleration_min_m_per_s2, 1), round(two.acceleration_min_own_deg, 2)) == (-6221.2, 144.15)


@pytest.mark.parametrize(("ratio", "minima"), [(0.249, 1), (0.2501, 2)])
def test_two_terms_have_two_minima_above_a_quarter(ratio, minima):
    found = piston(build_text(changed(("length = 160", f"ratio = {ratio}")))).mechanisms[0]
    assert found.two_term.type == minima


def test_an_offset_of_ten_millimetres():
    """Tsinghua, section 1.1.2: stroke 90.22 mm, dead centres at 2.94 and 185.47 degrees."""
    text = "[crank]\nstroke = 90\n[rod]\nlength = 150\n[piston]\nmass = 0.5\nbore = 90\noffset = 10\n"
    found = piston(build_text(text))
    one = found.mechanisms[0]
    assert round(1e3 * one.stroke_m, 2) == 90.22
    assert (round(one.outer_dead_center_own_deg, 2), round(one.inner_dead_center_own_deg, 2)) == (2.94, 185.47)
    assert found.swept_volume_m3 == pytest.approx(math.pi / 4 * 0.09**2 * one.stroke_m)


def test_articulated_pistons_have_strokes_of_their_own():
    found = piston(build_text(RADIAL)).mechanisms
    assert [each.cylinders for each in found] == [(n,) for n in range(1, 8)]
    assert [each.rod_ratio is None for each in found] == [False] + [True] * 6
    assert len({round(each.stroke_m, 9) for each in found}) == 4  # mirrored in pairs


def test_the_command_in_all_formats(tmp_path):
    (tmp_path / "four.toml").write_text(GOOD)
    table = ask("piston", tmp_path / "four.toml")
    assert "mean speed, m/s" in table
    assert "two-term" in table
    assert "mean speed, ft/s" in ask("piston", tmp_path / "four.toml", "--units", "imperial")
    one = ask_json("piston", tmp_path / "four.toml", "--cylinder", "3")
    assert [each["cylinders"] for each in one["mechanisms"]] == [[3]]
    units = {(row["cylinders"], row["figure"]): row["unit"] for row in ask_csv("piston", tmp_path / "four.toml")}
    assert (units["1 2 3 4", "stroke_m"], units["1 2 3 4", "mean_speed_m_per_s"]) == ("m", "m/s")
    assert refusal("piston", tmp_path / "four.toml", "--cylinder", "7").endswith("has cylinders 1 to 4")
    several = refusal("piston", tmp_path / "four.toml", "--speed", "1000,2000")
    assert several == '--speed "1000,2000": give one speed here, such as --speed 3000'
    with pytest.raises(BalcliError):
        choose_cylinder(piston(build_text(GOOD)), 9)


def test_quantities_are_those_of_the_command(tmp_path):
    """With an offset the two senses differ, and so do the pistons of two banks."""
    names = [f"piston.{stem}{part}" for stem in ("", "2.") for part in ("mean_speed", "max_speed", "stroke")]
    rows = ask_csv("sweep", ENGINES / "vr6.toml", "--vary", "rod.length=150,164", "-q", ",".join(names))
    for row in rows:
        found = piston(load_example("vr6").vary({"rod.length": float(row["rod.length"])})).mechanisms
        for stem, one in zip(("piston", "piston.2"), found, strict=True):
            fastest = max(one.velocity.max_m_per_s, -one.velocity.min_m_per_s)
            read = [float(row[f"{stem}.{part}"]) for part in ("mean_speed", "max_speed", "stroke")]
            assert read == pytest.approx([one.mean_speed_m_per_s, fastest, one.stroke_m], rel=1e-12)
    told = refusal("sweep", ENGINES / "vr6.toml", "--vary", "rod.length=150", "-q", "piston.7.stroke")
    assert told.endswith('piston.7.stroke: the file has no piston "7"; there are 1, 2, 3, 4, 5, 6')


def test_the_heading_has_the_true_stroke_of_an_offset_piston():
    assert "81 × 90.3 mm (true stroke 90.59 mm)" in " ".join(ask("analyze", ENGINES / "vr6.toml").split())
    assert "true stroke" not in ask("analyze", ENGINES / "i4.toml")


# ------------------------------------------------------------------ members that differ in one number
TWO = {
    "crank": {"stroke": 80, "throws": [0, 180], "spacing": 90},
    "rod": {"length": 200},
    "piston": {"mass": 1, "bore": 80},
    "operation": {"speed": 3000},
}


def move_two(**parts):
    """Motion of both pistons, each of which is a mechanism of its own."""
    tables = {name: TWO.get(name, {}) | parts.get(name, {}) for name in (*TWO, *parts)}
    found = piston(load(tables))
    assert [each.cylinders for each in found.mechanisms] == [(1,), (2,)]
    return found


@pytest.mark.parametrize(("rod", "ratios"), [({"ratio": 0.25}, (0.25, 0.25)), ({"length": 200}, (0.2, 0.3))])
def test_pistons_of_different_strokes_are_different_mechanisms(rod, ratios):
    """With equal rod ratios only the size differs: all is longer and faster in proportion."""
    tables = TWO | {"crank": TWO["crank"] | {"stroke": [80, 120]}, "rod": rod}
    first, second = piston(load(tables)).mechanisms
    assert [first.rod_ratio, second.rod_ratio] == pytest.approx(ratios)
    for each, stroke, ratio in ((first, 0.08, ratios[0]), (second, 0.12, ratios[1])):
        assert each.stroke_m == pytest.approx(stroke)
        assert each.mean_speed_m_per_s == pytest.approx(2 * stroke * 50)
        assert each.swept_volume_m3 == pytest.approx(math.pi / 4 * 0.08**2 * stroke)
        highest = stroke / 2 * (100 * math.pi) ** 2 * (1 + ratio)
        assert each.acceleration.max_m_per_s2 == pytest.approx(highest)
        assert each.two_term.acceleration_max_m_per_s2 == pytest.approx(highest)


@pytest.mark.parametrize(("of_first", "of_second"), [(0, 10), (10, 0), (10, -10)])
def test_pistons_of_different_offsets_are_different_mechanisms(of_first, of_second):
    """Stroke and dead centres by triangles; the offset ratio stands only beside a piston that is not centred."""
    pistons = {"1": {"piston_offset": of_first}, "2": {"piston_offset": of_second}}
    for each, offset in zip(move_two(cylinder=pistons).mechanisms, (of_first, of_second), strict=True):
        outer, inner = (math.degrees(math.asin(offset / arm)) for arm in (240, 160))
        height = math.sqrt(240**2 - offset**2) - math.sqrt(160**2 - offset**2)
        assert each.stroke_m == pytest.approx(height / 1e3)
        assert each.outer_dead_center_own_deg == pytest.approx(outer)
        assert each.inner_dead_center_own_deg == pytest.approx(180 + inner)
        assert each.inward_stroke_deg == pytest.approx(180 + inner - outer)
        assert each.offset_ratio == (pytest.approx(offset / 40) if offset else None)


def test_one_of_two_pistons_is_chosen_by_its_number():
    found = piston(load(TWO | {"crank": TWO["crank"] | {"stroke": [80, 120]}}))
    for number, stroke in ((1, 0.08), (2, 0.12)):
        (chosen,) = choose_cylinder(found, number).mechanisms
        assert chosen.cylinders == (number,)
        assert chosen.stroke_m == pytest.approx(stroke)


def test_without_a_bore_no_volume_is_known():
    found = piston(load(TWO | {"piston": {"mass": 1}}))
    assert found.swept_volume_m3 is None
    assert found.mechanisms[0].swept_volume_m3 is None


STROKES = ["piston.stroke", "piston.1.stroke", "piston.2.stroke"]


def test_a_quantity_without_a_number_is_of_piston_1():
    found = sweep(load(TWO | {"crank": TWO["crank"] | {"stroke": [80, 120]}}), {"rod.length": [200, 300]}, STROKES)
    assert [list(found[name]) for name in STROKES] == [
        pytest.approx([0.08, 0.08]),
        pytest.approx([0.08, 0.08]),
        pytest.approx([0.12, 0.12]),
    ]


# ------------------------------------------------------------------ both sides of the limits of two terms
@pytest.mark.parametrize(
    ("ratio", "exact", "two_term"), [(0.24, 1, 1), (0.249, 1, 1), (0.251, 1, 2), (0.262, 1, 2), (0.266, 2, 2)]
)
def test_minima_by_two_terms_begin_at_a_quarter(ratio, exact, two_term):
    """By two terms the lowest acceleration is -(1 - lam) at 180 deg, or -(lam + 1/(8 lam)) at cos psi = -1/(4 lam)."""
    text = changed(("length = 160", f"ratio = {ratio}"))
    found = piston(build_text(text)).mechanisms[0]
    assert (found.acceleration.type, found.two_term.type) == (exact, two_term)
    scale = 0.045 * (100 * math.pi) ** 2
    psi = 180.0 if two_term == 1 else math.degrees(math.acos(-1 / (4 * ratio)))
    lowest = math.cos(math.radians(psi)) + ratio * math.cos(2 * math.radians(psi))
    assert found.two_term.acceleration_min_own_deg == pytest.approx(psi)
    assert found.two_term.acceleration_min_m_per_s2 == pytest.approx(scale * lowest)
    told = " ".join(ask("piston", "-", stdin=text).split())
    assert ("two minima above a rod ratio of 0.2638" in told) == (exact != two_term)


def test_imperial_speeds_are_in_feet():
    table = ask("piston", "-", "--units", "imperial", stdin=GOOD)
    speed = next(line for line in table.splitlines() if line.startswith("mean speed, ft/s"))
    assert speed.split()[3] == f"{2 * 0.09 * 50 / 0.3048:.4g}"
