"""Which changes of a record `balcli check` notices, and which are rounding or tolerated."""

import json
import math
from functools import reduce

import numpy as np
import pytest
from support.cases import slow
from support.engines import GOOD, build_text, changed

from balcli import load_example
from balcli.analysis.answer import analyze
from balcli.regression import comparison
from balcli.regression.comparison import find_differences
from balcli.regression.recording import describe_engine, record_result
from balcli.regression.rules import TOLERANCE, Tolerance, Tolerances


def record_of(engine):
    return json.loads(record_result(engine))


def differences(engine, recorded, tolerance=TOLERANCE):
    return list(find_differences(engine, recorded, describe_engine(engine), Tolerances(Tolerance(tolerance))))


def figures(engine, recorded, tolerance=TOLERANCE):
    return [each.figure for each in differences(engine, recorded, tolerance)]


def _list_paths(value, path=()):
    if isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _list_paths(part, (*path, key))
    else:
        yield path, value


def _change(value):
    """Another value of the same kind; angles turn by 2 deg and a tenth."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, str):
        return f"{value}!"
    return 12.5 if value is None else value + 2 + 0.1 * value


def has_no_direction(document, path):
    """Whether a figure is the direction of a vector so small that the tolerance turns it by half a degree or more."""
    if path[-1] not in ("axis_deg", "phase_deg", "peak_deg"):
        return False
    kind = path[2]
    largest = max(entry[kind].get("major", entry[kind].get("amplitude")) for entry in document["orders"])
    place = reduce(lambda part, key: part[key], path[:-1], document)
    vectors = [place[sense] for sense in ("forward", "backward") if sense in place] or [[place["amplitude"]]]
    return min(math.hypot(*vector) for vector in vectors) <= 100 * TOLERANCE * largest


@pytest.mark.parametrize(
    "name",
    ["i3", *slow("vtwin45", "i4_wiebe", "i6_diesel", "i4_mounts", "radial7_articulated", "rotary9", "v8_crossplane")],
)
def test_a_change_of_any_figure_is_noticed(monkeypatch, name):
    """Sizes, axes, phases, angles of peaks, balance, texts, dead centres, and the figures of further chapters."""
    engine = load_example(name)
    text = record_result(engine)
    described = describe_engine(engine)
    monkeypatch.setattr(comparison, "describe_engine", lambda *_: described)
    usual = Tolerances()
    assert list(find_differences(engine, json.loads(text), described, usual)) == []
    unnoticed = []
    document = json.loads(text)
    for path, value in _list_paths(json.loads(text)):
        if path[0] in ("version", "inputs"):
            continue
        place = reduce(lambda part, key: part[key], path[:-1], document)
        place[path[-1]] = _change(value)
        is_angle_of_nothing = path[0] == "peak" and value is None
        if not (list(find_differences(engine, document, described, usual)) or is_angle_of_nothing):
            unnoticed.append(path)
        place[path[-1]] = value
    assert document == json.loads(text)
    assert [path for path in unnoticed if not has_no_direction(json.loads(text), path)] == []


@pytest.mark.parametrize("missing", ["axis_deg", "balanced", "major"])
def test_a_figure_that_is_not_recorded_is_noticed(missing):
    engine = load_example("i3")
    document = record_of(engine)
    del document["orders"][0]["moment_Nm"][missing]
    assert len(figures(engine, document)) == 1


def test_an_axis_is_compared_modulo_half_a_turn():
    """An in-line engine's force is along its cylinders: the axis may be 90 or -90 deg, by rounding."""
    engine = load_example("i3")
    document = record_of(engine)
    moment = document["orders"][0]["moment_Nm"]
    moment["axis_deg"] -= 180
    assert figures(engine, document) == []
    moment["axis_deg"] += 0.001
    assert figures(engine, document) == ["order 1 moment axis"]


def turned(record, degrees):
    """Turns the forward vector of the moment of order 1, and with it the axis by half as much."""
    moment = record["orders"][0]["moment_Nm"]
    x, y = moment["forward"]
    c = math.cos(math.radians(degrees))
    s = math.sin(math.radians(degrees))
    moment["forward"] = [c * x - s * y, s * x + c * y]
    moment["axis_deg"] += degrees / 2
    return record


@pytest.mark.parametrize(("tolerance", "count"), [(0.002, 0), (0.0002, 3)])
def test_a_direction_may_turn_as_far_as_the_tolerance_allows(tolerance, count):
    """A turn by 0.1 deg moves the forward vector by 1.4e-3 of the largest moment, and turns the axis by 0.05 deg. A
    change of the two vectors (0.83 and 0.17 of the largest) by a share s turns it by up to 3.5 s rad.
    """
    engine = load_example("i3")
    found = figures(engine, turned(record_of(engine), 0.1), tolerance)
    assert len(found) == count
    assert ("order 1 moment axis" in found) == bool(count)


@pytest.mark.parametrize(("size", "noticed"), [(0.9, False), (1.1, True)])
def test_directions_of_vectors_within_the_tolerance_are_not_compared(size, noticed):
    """The fourth order of a three is balanced; a record with a vector below the tolerance may give it an axis."""
    engine = load_example("i3")
    document = record_of(engine)
    largest = max(entry["moment_Nm"]["major"] for entry in document["orders"])
    force = document["orders"][0]["force_N"]
    own = max([document["peak"]["force_N"], *(entry["force_N"]["major"] for entry in document["orders"])])
    tiny = size * 0.01 * own
    force["forward"] = [tiny, 0.0]
    force["major"] = tiny
    force["minor"] = tiny
    force["axis_deg"] = 30.0
    force["balanced"] = False
    assert largest > 0
    found = figures(engine, document, 0.01)
    assert ("order 1 force balanced" in found) == noticed
    assert ("order 1 force major" in found) == noticed
    assert "order 1 force axis" not in found  # the present vector is 0 and has no axis


def test_the_angle_of_a_peak_may_move_to_an_equal_one():
    """The force of an in-line four has two equal peaks a turn, at which it points up and down."""
    engine = load_example("i4")
    document = record_of(engine)
    for turn, moved in ((180, 0), (90, 1), (0.01, 1)):
        document["peak"]["force_deg"] = math.degrees(analyze(engine).peak.force.theta) + turn
        assert [(each.path, each.unit) for each in differences(engine, document)] == [
            (("peak", "force_deg"), "deg")
        ] * moved


def test_where_all_large_orders_cancel_rounding_is_no_difference():
    """The rotary's only forces are millionths of what each cylinder makes: their rounding is more than 1e-9 of them."""
    engine = load_example("rotary9")
    force = analyze(engine).spectra.force
    noise = float(np.broadcast_to(force.noise, force.forward.shape)[force.orders == 9][0])
    assert noise > TOLERANCE * force.major.max() > 0
    for roundings in (1.9, 4):
        document = record_of(engine)
        (entry,) = [entry for entry in document["orders"] if entry["order"] == 9]
        entry["force_N"]["forward"][0] += roundings * noise
        assert len(figures(engine, document)) == (roundings > 2)


def test_an_order_that_is_not_recorded():
    engine = build_text(GOOD)
    document = record_of(engine)
    document["orders"].pop(1)
    found = {each.figure: each for each in differences(engine, document)}
    missing = found["order 2 force major"]
    assert (missing.recorded, missing.now > 1000, missing.unit) == (None, True, "N")
    assert "order 2 order" in found


def test_a_change_is_a_share_of_the_largest_figure_of_the_quantity():
    """A tenth of a per cent more piston moves forces, torque and roll; moments of an in-line four remain 0."""
    document = record_of(build_text(GOOD))
    engine = build_text(changed(("mass = 0.5", "mass = 0.5005")))
    found = differences(engine, document)
    assert {each.cause for each in found} == {"force", "torque", "roll"}
    second = next(each for each in found if each.figure == "order 2 force major")
    reciprocating = 0.5 + 0.6 * 45 / 160
    assert second.now == pytest.approx(second.recorded * (1 + 0.0005 / reciprocating), rel=1e-9)
    largest = analyze(engine).peak.force.value
    assert second.share == pytest.approx((second.now - second.recorded) / largest, rel=1e-9)
    assert figures(engine, document, 0.01) == []


def test_each_assumed_value_has_a_scale_of_its_own():
    """An index that moves by 1e-6 is found next to an inertia of 3105 kg mm2."""
    engine = build_text(changed(more='[gas]\ncycle = "otto"\ncompression_ratio = 10\nimep = 9\n'))
    document = record_of(engine)
    assert {"path": "rod.inertia", "value": 3105.0, "unit": "kg mm^2"} in document["assumed"]
    (index,) = (value for value in document["assumed"] if value["path"] == "gas.compression_index")
    index["value"] += 1e-6
    (difference,) = differences(engine, document)
    assert (difference.cause, difference.figure) == ("assumed", "assumed gas.compression_index")


def test_a_record_of_an_earlier_version_has_no_inputs_and_no_dead_centres():
    engine = load_example("i3")
    document = record_of(engine)
    for key in ("version", "inputs", "travel"):
        del document[key]
    document["assumed"] = ["layout.strokes = 4"]
    assert figures(engine, document) == []
    del document["assumed"]
    document["inputs"] = {}
    assert len(figures(engine, document)) == 3 * 4  # strokes and dead centres of three cylinders
