"""Orders of the time at uneven speed, against an engine followed through equal steps of time."""

import re

import numpy as np
import pytest
from support.engines import build_text
from support.in_time import run_in_time
from support.mounts import ENGINE

from balcli.errors import BalcliError
from balcli.forces.spectrum import compute_spectra
from balcli.mounting.loads import compute_spectra_in_time

FIRED = f"""{ENGINE}
[layout]
firing_order = [1, 3, 4, 2]
[gas]
cycle = "wiebe"
compression_ratio = 10
imep = 9
"""
LINES = {
    "whole": [(2, 0.2, 30.0), (1, 0.05, 0.0)],
    "half": [(0.5, 0.1, -70.0), (2, 0.2, 30.0)],
    "large": [(2, 0.7, 100.0)],
}


def make_uneven(lines):
    tables = [f"{{ order = {n}, amplitude = {a}, angle = {angle} }}" for n, a, angle in lines]
    return FIRED.replace("speed = 3000", f"speed = 3000\nspeed_ripple = [{', '.join(tables)}]")


@pytest.mark.slow
@pytest.mark.parametrize("name", LINES)
def test_force_roll_and_gas(name):
    """Half orders of gas, and order 0; gas over the angle reaches far beyond the orders wanted."""
    lines = LINES[name]
    orders = np.arange(0, 12.5, 0.5)
    engine = build_text(make_uneven(lines))
    found, turns = compute_spectra_in_time(engine, orders, ["force", "roll", "gas"])
    over_angle = compute_spectra(engine, np.arange(0, 150, 0.5), ["force", "roll", "gas"])

    def speed(theta):
        return 1 + sum(a * np.cos(n * theta - np.radians(angle)) for n, a, angle in lines)

    theta, period = run_in_time(speed, 2)
    assert turns == pytest.approx(4 * np.pi / period, rel=1e-12)
    began = None
    for kind in ("force", "roll", "gas"):
        own = np.fft.fft(over_angle[kind].values(theta), norm="forward")
        ahead = own[: len(orders)]
        astern = np.where(orders, own[-np.arange(len(orders))], 0)
        largest = np.abs(own).max()
        if began is None:  # when the time began is open: by order 2 of the force
            began = np.angle(ahead[4] / found[kind].forward[4]) / 2
        turned = np.exp(1j * orders * began)
        assert found[kind].forward * turned == pytest.approx(ahead, rel=0, abs=1e-9 * largest)
        assert found[kind].backward / turned == pytest.approx(astern, rel=0, abs=1e-9 * largest)


@pytest.mark.parametrize(("line", "slowest"), [((2, 0.9999, 0.0), "0.0001"), ((256, 0.8, 0.0), "0.2")])
def test_a_crank_that_all_but_stops_or_trembles_is_refused(line, slowest):
    engine = build_text(make_uneven([line]))
    said = (
        f"operation.speed_ripple: the crank slows down to {slowest} of its mean speed, so "
        "that orders of time need too many samples; give a smaller ripple or lower orders"
    )
    with pytest.raises(BalcliError, match=re.escape(said)):
        compute_spectra_in_time(engine, np.arange(1.0, 501), ["force"])
