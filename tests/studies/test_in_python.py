"""Studies in Python: they agree with engines that are varied one by one, and say in words what is wrong."""

import io
import sys
import tracemalloc

import numpy as np
import pytest
from support.cases import cases
from support.paths import ENGINES
from support.rotors import three_runs

import balcli
from balcli.forces import curves as force_curves
from balcli.limits import MOST_PARAMETER_VALUES, MOST_SPEEDS
from balcli.studies import sweep

V8 = balcli.load_example("v8_crossplane")
FOUR = balcli.load_example("i4")
MOUNTS = balcli.load_example("i4_mounts")
DIESEL = balcli.load_example("i6_diesel")
GAS = balcli.load_example("i4_wiebe")
CLOSE = 1e-12


# ------------------------------------------------------------------ sweep
def test_a_sweep_is_the_engine_varied_point_by_point():
    angles = np.array([60.0, 75.0, 90.0])
    ratios = [0.25, 0.3]
    found = balcli.sweep(V8, {"layout.bank_angle": angles, "rod.ratio": ratios}, ["force.2.major", "moment.1.major"])
    assert found["moment.1.major"].shape == (3, 2)
    for i, angle in enumerate(angles):
        for k, ratio in enumerate(ratios):
            engine = V8.vary({"layout.bank_angle": angle, "rod.ratio": ratio})
            spectra = balcli.analyze(engine, [1, 2]).spectra
            largest = found["moment.1.major"].max()
            assert found["force.2.major"][i, k] == pytest.approx(spectra.force.major[1], abs=CLOSE * largest)
            assert found["moment.1.major"][i, k] == pytest.approx(spectra.moment.major[0], rel=CLOSE)


def test_ways_to_give_values():
    wanted = [0.25, 0.26, 0.27]
    for values in (wanted, tuple(wanted), np.array(wanted), "0.25:0.27:0.01", "0.25,0.26,0.27"):
        found = balcli.sweep(FOUR, {"rod.ratio": values}, "force.2.major")
        assert found["rod.ratio"].tolist() == wanted
    assert balcli.sweep(FOUR, {"rod.length": "6 in"})["rod.length"].tolist() == [152.4]
    assert balcli.sweep(FOUR, {"rod.length": 150})["rod.length"].tolist() == [150]
    assert balcli.sweep(FOUR, {"rod.length": range(150, 153)})["rod.length"].tolist() == [150, 151, 152]


def test_what_a_sweep_does_not_have_is_no_key():
    found = balcli.sweep(FOUR, {"rod.ratio": 0.3}, "force.2.major")
    with pytest.raises(KeyError, match=r"force\.1\.major; there are rod\.ratio, force\.2\.major"):
        found["force.1.major"]
    assert "force.1.major" not in found
    assert list(found) == ["rod.ratio", "force.2.major"]


def test_a_sweep_too_large_to_keep_names_the_command(monkeypatch):
    monkeypatch.setattr(sweep, "MOST_KEPT_FIGURES", 3)
    with pytest.raises(balcli.BalcliError) as caught:
        balcli.sweep(FOUR, {"rod.ratio": [0.25, 0.3]}, ["force.2.major", "force.4.major"])
    assert str(caught.value) == (
        "4 values are too many to keep; give at most 3, or use the command balcli sweep, which writes them into a file as they are computed"
    )


# ------------------------------------------------------------------ search, scatter, compare
@pytest.mark.parametrize(
    ("engine", "over"), [(V8, "throws"), (balcli.load_example("v6_60"), "bank_angle"), (FOUR, "firing_order")]
)
def test_the_engine_that_a_search_finds_is_as_good_as_it_says(engine, over):
    found = balcli.search(engine, over, "moment.1.major", top=2)
    best = balcli.analyze(found.engine(), [1]).spectra.moment.major[0]
    scale = balcli.analyze(engine, [1]).of_one_cylinder["moment"]
    assert best == pytest.approx(found.results[0].objective, abs=CLOSE * scale)
    with pytest.raises(IndexError, match=r"^rank 3: there are \d results, from 1$"):
        found.engine(3)


def test_weights_and_limits_of_a_search():
    weighed = {"moment.1.major": 1, "moment.2.major": np.float64(0.5)}
    for one in balcli.search(V8, "throws", weighed, limit={"moment.2.major": 1000.0}).results:
        assert one.objective == pytest.approx(
            one.quantities["moment.1.major"] + 0.5 * one.quantities["moment.2.major"], rel=CLOSE
        )
        assert one.quantities["moment.2.major"] < 1000
    both = balcli.search(V8, "throws", ["moment.1.major", "moment.2.major"])
    assert both.results[0].quantities.keys() == weighed.keys()


def test_angles_of_a_search_are_numbers_of_a_frame():
    frame = balcli.search(balcli.load_example("v6_90_split"), "splay", "moment.1.major").to_pandas()
    assert frame["splay"].dtype == float
    assert frame.attrs["units"]["splay"] == "deg"
    long = balcli.search(balcli.load_example("i4"), "rod.length=120:160", "force.2.major")
    assert long.to_pandas().attrs["units"]["rod.length"] == "mm"
    throws = balcli.search(V8, "throws", "moment.1.major").to_pandas()["throws"]
    assert throws[0] == "0-180-90-270"


def test_tolerances_are_shares_or_percentages():
    one, other, third = (
        balcli.scatter(FOUR, "force.1.major", mass_scatter=mass, angle_scatter=angle, samples=50, seed=3)
        for mass, angle in ((0.01, 0.2), ("1%", "0.2 deg"), (np.float32(0.01), 0.1))
    )
    assert one.quantities == other.quantities
    assert third.quantities["force.1.major"].bound < one.quantities["force.1.major"].bound


def test_with_gas_torque_is_that_of_gas_and_inertia():
    """As of the commands."""
    gas = balcli.load_example("i4_wiebe")
    torque = balcli.analyze(gas, [2], only="gas").spectra["torque_total"].major[0]
    (spread,) = balcli.scatter(gas, "torque.2.amplitude", samples=10, seed=1).quantities.values()
    assert spread.nominal == pytest.approx(torque)
    best = balcli.search(gas, "firing_order", "torque.2.amplitude", top=1).results[0]
    assert best.objective == pytest.approx(torque)
    found = balcli.sweep(gas, {"operation.speed": gas.speed_rpm}, "torque.2.amplitude")
    assert found["torque.2.amplitude"][0] == pytest.approx(torque)


def test_rows_of_a_scatter_have_their_unit():
    """No name tells it, and one column has figures of several units."""
    pytest.importorskip("pandas")
    found = balcli.scatter(FOUR, ["force.2.major", "moment.2.major"], samples=10, seed=1)
    frame = found.to_pandas()
    assert list(frame.columns)[-1] == "unit"
    assert dict(zip(frame["quantity"], frame["unit"], strict=True)) == {"force.2.major": "N", "moment.2.major": "N·m"}


def test_engines_side_by_side_have_names():
    assert balcli.compare(V8, FOUR).engines == (V8.name, FOUR.name)
    assert balcli.compare(V8, V8.vary({"layout.bank_angle": 60})).engines == ("engine 1", "engine 2")
    found = balcli.compare(V8, V8, names=["as it is", "again"], orders=[1], only="moment")
    assert found.rows()[0]["again"] == found.rows()[0]["as it is"] > 0
    with pytest.raises(balcli.BalcliError, match=r"^1 names for 2 engines; give one for each$"):
        balcli.compare(V8, FOUR, names=["one"])


# ------------------------------------------------------------------ chapters


def test_an_engine_with_torsion_is_read_once_from_standard_input(monkeypatch):
    text = (ENGINES / "i6_diesel.toml").read_bytes()
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text)))
    found = balcli.torsion("-")
    assert found.modes[0].frequency_Hz == balcli.torsion(DIESEL).modes[0].frequency_Hz


def test_torsion_of_an_engine_is_that_of_its_file(tmp_path):
    by_engine = balcli.torsion(DIESEL, [1500, 1000], orders=[3, 6])
    by_dict = balcli.torsion(DIESEL.to_dict(), [1000, 1500], orders=[3, 6])
    for one, other in zip(by_engine.response.shafts, by_dict.response.shafts, strict=True):
        assert np.array_equal(one.half_peak_to_peak_Nm, other.half_peak_to_peak_Nm)
        assert len(one.half_peak_to_peak_Nm) == 2
    damped = balcli.torsion(DIESEL, range(1000, 2001, 100), damper="viscous", orders=[3, 6])
    assert damped.damper.damper is not None


def test_mounts_of_an_engine_a_dict_or_a_body_alone():
    found = balcli.mounts(MOUNTS, [2000], orders=[2], scheme="two-shaft")
    again = balcli.mounts(MOUNTS.to_dict(), [2000], orders=[2])
    assert found.modes[0].frequency_Hz == again.modes[0].frequency_Hz
    worst = max(mount.worst.force_N for mount in found.response.mounts)
    assert max(mount.worst.force_N for mount in found.fitted.response.mounts) < worst
    alone = {key: table for key, table in MOUNTS.to_dict().items() if key in ("body", "mount")}
    assert not hasattr(balcli.mounts(alone), "response")
    beside = balcli.mounts(MOUNTS, [2000], orders=[2], others={"V8": V8})
    assert [other.name for other in beside.others] == ["V8"]


# ------------------------------------------------------------------ what is wrong, in words
ENGINE = "give an Engine; load(...) makes one of a path or a dict"
NAMES = 'give words, such as ["force.2.major", "moment.1.backward"]'


THERE = {"V8": V8, "FOUR": FOUR, "MOUNTS": MOUNTS, "DIESEL": DIESEL, "GAS": GAS, "RATIO": {"rod.ratio": 0.3}}
THERE |= {"np": np, "three_runs": three_runs, "TypeError": TypeError}
SIZES = {"MOST_PARAMETER_VALUES": MOST_PARAMETER_VALUES, "MOST_SPEEDS": MOST_SPEEDS, "TOO_MANY": MOST_SPEEDS + 1}


@cases("studies/in_python", "what_is_wrong_is_told", ENGINE=ENGINE, NAMES=NAMES, **SIZES)
def test_what_is_wrong_is_told(kind, call, message):
    """Calls stand in the table as they are typed, with the names of balcli and those of THERE."""
    named = {name: getattr(balcli, name) for name in balcli.__all__} | THERE
    with pytest.raises(named[kind]) as caught:
        eval(call, named)
    assert str(caught.value).startswith(message)


@cases("studies/in_python", "a_thousand_million_values")
def test_a_thousand_million_values_are_refused_before_they_take_memory(call):
    named = {name: getattr(balcli, name) for name in balcli.__all__} | THERE
    tracemalloc.start()
    try:
        with pytest.raises(balcli.BalcliError, match=r"has more than|has 20001 values; give at most|is not a number"):
            eval(call, named)
        assert tracemalloc.get_traced_memory()[1] < 20e6
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("cylinder", [None, 2])
def test_curves_with_gas_do_not_depend_on_how_many_angles_are_computed_at_a_time(cylinder, monkeypatch):
    engine = balcli.load_example("i4_wiebe")
    at_once = balcli.curves(engine, 7, cylinder=cylinder).curves
    monkeypatch.setattr(force_curves, "AT_ONCE", 4 * 10)  # ten angles of four cylinders
    in_pieces = balcli.curves(engine, 7, cylinder=cylinder).curves
    for name, values in at_once.items():
        np.testing.assert_allclose(in_pieces[name], values, rtol=0, atol=1e-12 * np.abs(values).max())
