"""`balcli numbers`: what can be varied and asked for is what `sweep` takes."""

import pytest
from support.commands import ask_json, refusal, run_here
from support.paths import ENGINES


def listed(file: str) -> dict:
    return ask_json("numbers", ENGINES / file)


@pytest.mark.parametrize("file", ["v8_wiebe.toml", "i4_shafts.toml", "i4_mounts.toml"])
def test_every_number_of_the_file_can_be_varied(file):
    """Some at once, each at the value that it has: a sweep of one variant."""
    there = [number for number in listed(file)["numbers"] if number["value"] is not None]
    assert len(there) > 10
    force = ("--quantity", "force.2.major")
    alone = run_here("sweep", ENGINES / file, "--vary", "piston.offset=0", *force).out
    expected = float(alone.splitlines()[1].split(",")[-1])
    for k in range(0, len(there), 12):
        some = there[k : k + 12]
        vary = [word for n in some for word in ("--vary", f"{n['path']}={n['value']!r}")]
        status, out, err = run_here("sweep", ENGINES / file, *vary, *force)
        assert (status, err) == (0, "")
        head, row = out.splitlines()
        assert head.split(",")[:-1] == [number["path"] for number in some]
        assert float(row.split(",")[-1]) == pytest.approx(expected, rel=1e-9)


def test_more_than_arrays_have_axes_are_refused():
    vary = [word for n in range(1, 18) for word in ("--vary", f"cylinder.{n}.piston_mass=0.5")]
    engine = "crank.stroke = 90\nrod.length = 160\npiston.mass = 0.5\nlayout.radial = 17\n"
    assert refusal("sweep", "-", *vary, stdin=engine) == "17 numbers vary; at most 16 can vary"
