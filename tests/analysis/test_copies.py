"""Results can be kept, sent to other processes and copied: they come back equal."""

import copy
import pickle

import pytest
from support.engines import build_text, engine_text
from support.paths import ENGINES
from support.rotors import three_runs

from balcli import analyze, balance, curves, field, load, mounts, torque, torsion
from balcli.balancing.answer import balance_knuckles
from balcli.engine.parse import parse
from balcli.sizing.options import SCHEMES, SchemeOptions

EVERYTHING = ["force", "moment", "couple", "torque", "roll", "peak", "sizing", "inner", "guide"]
FIRED = (ENGINES / "i3.toml").read_text(encoding="utf-8") + "[gas]\ncycle = 'otto'\ncompression_ratio = 9\nimep = 9\n"


def fit(scheme: str):
    wanted = {
        "step": SchemeOptions(step=1),
        "compensator": SchemeOptions(position=3.0),
        "ellipse": SchemeOptions(direction=90.0, ratio=0.5),
    }
    return balance(build_text(engine_text(operation="speed = 3000")), scheme, wanted.get(scheme))


RESULTS = {
    "analysis": lambda: analyze(load(ENGINES / "v8_crossplane.toml"), None, EVERYTHING, by="cylinder", why=True),
    "articulated": lambda: analyze(
        load(ENGINES / "radial7_articulated.toml"), None, EVERYTHING, by="cylinder", why=True
    ),
    "curves": lambda: curves(load(ENGINES / "i4_wiebe.toml"), 30, cylinder=2),
    "fired": lambda: analyze(pickle.loads(pickle.dumps(load(FIRED)))),
    "knuckles": lambda: balance_knuckles(parse((ENGINES / "radial7_articulated.toml").read_bytes())),
    "mounts": lambda: mounts(ENGINES / "i4_mounts.toml", [700, 3000]),
    "rotor": lambda: field(three_runs()),
    "torque": lambda: torque(load(ENGINES / "i4_wiebe.toml")),
    "torsion": lambda: torsion(load(ENGINES / "i6_diesel.toml"), [1500, 2000], orders=[3, 4.5, 6]),
    **{scheme: lambda scheme=scheme: fit(scheme) for scheme in SCHEMES},
}


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_comes_back_equal(name):
    result = RESULTS[name]()
    document = result.to_dict()
    rows = result.rows()
    for again in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
        assert again.to_dict() == document
        assert again.rows() == rows
        assert repr(again) == repr(result)
    assert result == result
