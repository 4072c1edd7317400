"""Engines from dicts and texts, their tables, and the same with other values of some keys."""

import numpy as np
import pytest
from support.cases import cases
from support.engines import GOOD
from support.paths import ENGINES

import balcli
from balcli.engine.build import build
from balcli.engine.load import vary_engine
from balcli.engine.parse import parse
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.remedy import fit_devices
from balcli.studies.parameters import find_places

FILES = sorted(ENGINES.glob("*.toml"))
FOUR = {
    "crank": {"stroke": 90, "throws": (0, 180, 180, 0), "spacing": 100},
    "rod": {"length": 160, "mass": 0.6, "cg": 45},
    "piston": {"mass": "500 g"},
}


def assert_same(one: balcli.Engine, other: balcli.Engine) -> None:
    """To the last bit."""
    kinds = ["force", "moment", "couple"]
    both = [compute_spectra(each, [1, 2, 4], kinds) for each in (one, other)]
    for kind in kinds:
        a, b = (spectra[kind] for spectra in both)
        assert np.array_equal(a.forward, b.forward, equal_nan=True)
        assert np.array_equal(a.backward, b.backward, equal_nan=True)


# ------------------------------------------------------------------ load and to_dict
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_an_engine_is_made_again_of_its_tables(path):
    engine = balcli.load(path)
    again = balcli.load(engine.to_dict())
    assert again.to_dict() == engine.to_dict()
    assert_same(again, engine)


def test_a_dict_a_text_and_a_file_say_the_same(tmp_path):
    text = (
        "[crank]\nstroke = 90\nthrows = [0, 180, 180, 0]\nspacing = 100\n"
        '[rod]\nlength = 160\nmass = 0.6\ncg = 45\n[piston]\nmass = "500 g"\n'
    )
    (tmp_path / "four.toml").write_text(text)
    engine = balcli.load(tmp_path / "four.toml")
    assert engine.to_dict()["piston"] == {"mass": 0.5}
    for source in (str(tmp_path / "four.toml"), text, FOUR, parse_of(FOUR)):
        assert_same(balcli.load(source), engine)


def parse_of(tables):
    """The same as Python might have it: arrays, numbers of numpy, None, whole numbers as keys."""
    crank = tables["crank"] | {"throws": np.array([0, 180, 180, 0]), "stroke": np.int64(90)}
    rod = tables["rod"] | {"length": np.float64(160), "ratio": None}
    return tables | {"crank": crank, "rod": rod, "cylinder": {3: {"piston_mass": np.float64(0.5)}}}


@pytest.mark.parametrize(("source", "key"), [({1.5: {}}, "1.5 (float)"), ({"crank": {None: 3}}, "None (NoneType)")])
def test_keys_are_text(source, key):
    with pytest.raises(balcli.InputError) as caught:
        balcli.load(source)
    assert str(caught.value) == f'engine: the key {key} is not a text; write it as in a file, such as "stroke"'


@pytest.mark.parametrize(
    ("source", "shown"),
    [(5, "5 (int)"), (None, "None (NoneType)"), (b"x", "b'x' (bytes)"), ([1] * 99, f"[{'1, ' * 18}1,... (list)")],
)
def test_what_is_no_source_is_told_in_words(source, shown):
    with pytest.raises(TypeError) as caught:
        balcli.load(source)
    wanted = "give the path of an engine file, the text of one, or a dict of its tables"
    assert str(caught.value) == f"load: {shown}: {wanted}"


# ------------------------------------------------------------------ vary
def change(path: str) -> str:
    """The tests' engine with other lines."""
    old, new = path.split(" -> ")
    assert GOOD.count(old) == 1
    return GOOD.replace(old, new)


@cases("engine/vary", "it_is_the_engine_of_the_file_with_other_lines")
def test_it_is_the_engine_of_the_file_with_other_lines(changes, text):
    text = change(text).replace("[layout]\nfiring_order = [1, 3, 4, 2]\n", "")
    if "operation.speed" in changes:
        text = text.replace("speed = 3000", "speed = 5000")
    engine = balcli.load(GOOD)
    varied = engine.vary(changes)
    assert_same(varied, balcli.load(text))
    assert engine.to_dict() == balcli.load(GOOD).to_dict()  # as it was


def test_members_of_lists_go_by_number_or_name():
    engine = balcli.load(ENGINES / "i4_mounts.toml")
    name = engine.to_dict()["mount"][1]["name"]
    one = engine.vary({"mount.2.stiffness.1": 99}).to_dict()
    assert one == engine.vary({f"mount.{name.replace(' ', '_')}.stiffness.1": 99}).to_dict()
    assert one["mount"][1]["stiffness"][0] == 99


def test_a_firing_order_that_no_longer_fits_the_throws_is_left_out():
    engine = balcli.load(ENGINES / "v8_crossplane.toml")
    wide = engine.vary({"layout.bank_angle": 60})
    assert wide.fires_deg == {}
    assert engine.vary({"rod.length": 150}).fires_deg == pytest.approx(engine.fires_deg)


@cases("engine/vary", "mistakes_are_told_as_those_of_a_file")
def test_mistakes_are_told_as_those_of_a_file(changes, message):
    with pytest.raises(balcli.InputError) as caught:
        balcli.load(GOOD).vary(changes)
    assert str(caught.value).startswith(message)


def test_devices_that_are_fitted_are_in_the_tables():
    engine = balcli.load(ENGINES / "i3.toml")
    after = balcli.balance(engine, "auto").after.engine
    assert {*after.to_dict()} - {*engine.to_dict()} == {"counterweight", "shaft"}
    again = balcli.load(after.to_dict())
    assert again.devices == after.devices
    assert_same(again, after)
    assert_same(after.vary({"rod.length": 150}), balcli.load(after.vary({"rod.length": 150}).to_dict()))


def test_what_no_file_can_describe_says_so():
    engine = balcli.load(ENGINES / "single.toml")
    oldham = balcli.balance(engine, "oldham").after.engine
    variants = build(parse(GOOD), {"rod.length": np.array([150.0, 160.0])})
    for one in (oldham, variants, fit_devices(variants, balcli.balance(engine).remedy)):
        for ask in (one.to_dict, lambda one=one: vary_engine(one, {"rod.length": 150})):
            with pytest.raises(balcli.BalcliError, match="no file describes this engine"):
                ask()


def test_eccentrics_of_one_named_shaft_have_different_names():
    """Both are `balancer`; each goes by its number in the file."""
    entry = '[[shaft]]\nname = "balancer"\nratio = -1\nunbalance = 9000\nangle = {}\nposition = {}\n'
    engine = balcli.load(GOOD + entry.format(20, -100) + entry.format(200, 100))
    assert {"shaft.1.position", "shaft.2.position"} <= find_places(engine.model).keys()
    varied = engine.vary({"shaft.1.position": -50})
    assert [round(float(shaft.z), 9) for shaft in varied.devices] == [-0.05, 0.1]
