"""The default remedy, its reasons, and what it does not depend on."""

import pytest
from support.engines import build_text
from support.remedies import fit_scheme, write_engine

from balcli.sizing.sizing import size


def test_every_device_has_its_reason():
    remedy = size(build_text(write_engine(0, 240, 120)), "complete")
    assert len(remedy.reasons) == len(remedy.devices) == 8
    assert remedy.reasons[0] == (
        "Order 1 moment turning with the crank: counterweights also turn with it and cancel it"
    )
    assert remedy.reasons[-1].endswith(
        "turning against the crank: nothing on the crankshaft can cancel it; "
        "two opposite eccentrics on a shaft at -2 times crank speed can"
    )


def test_nothing_is_fitted_where_nothing_is_left():
    engine = build_text(write_engine(0, 240, 120))
    assert not size(fit_scheme(engine)).devices


def test_devices_of_one_throw_stand_half_a_bore_to_either_side():
    text = write_engine(0, layout="bank_angle = 60\nstagger = 24")
    for bore, planes, distance in (
        ("", {-50.0, 50.0}, "the crank radius"),
        ("bore = 80\n", {-40.0, 40.0}, "half a bore"),
    ):
        remedy = size(build_text(text.replace("[piston]\n", f"[piston]\n{bore}")))
        assert {d.position for d in remedy.counterweights} == planes
        assert {d.position for d in remedy.shafts if d.ratio == -1} == planes
        assert f"; the throws count as one plane, and the weights stand {distance} on" in remedy.reasons[0]


def test_sizing_does_not_depend_on_speed():
    slow, fast = (size(build_text(write_engine(0, 90, 200) + f"[operation]\nspeed = {rpm}\n")) for rpm in (10, 20000))
    assert [d.unbalance for d in slow.devices] == pytest.approx([d.unbalance for d in fast.devices], rel=1e-12)
