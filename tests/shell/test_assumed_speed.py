"""Forces of a file without a speed are told as those at the speed that is assumed."""

from support.cases import cases
from support.commands import run_here
from support.engines import GOOD, changed
from support.paths import ENGINES

TOLD = "operation.speed = 1000"
OF_ORDER_2 = ("--minimise", "force.2.major")


@cases("shell/assumed_speed", "an_assumed_speed_is_told", OF_ORDER_2=OF_ORDER_2)
def test_an_assumed_speed_is_told(command: str, options: list[str], others: list[str]) -> None:
    """And not where the file gives one, or the speed is chosen or varied (`others`)."""
    without = changed(("speed = 3000", ""))
    assert TOLD in run_here(command, "-", *options, stdin=without).out
    assert TOLD not in run_here(command, "-", *options, stdin=GOOD).out
    if others:
        found = run_here(command, "-", *others, stdin=without)
        assert found.status == 0
        assert TOLD not in found.out


def test_mounts_say_up_to_which_assumed_speed_they_go() -> None:
    own = (ENGINES / "i4_mounts.toml").read_text(encoding="utf-8")
    speed = next(line for line in own.splitlines() if line.startswith("speed "))
    without = own.replace(speed, "")
    assert TOLD in run_here("mounts", "-", stdin=without).out
    assert TOLD not in run_here("mounts", "-", stdin=own).out
    assert TOLD not in run_here("mounts", "-", "--speeds", "800:900:50", stdin=without).out
