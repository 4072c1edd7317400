"""Options of `balcli torque`, and what is computed for them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.speeds import RPM
from ..enginefile.toml_text import name_file
from ..errors import BalcliError, warn
from ..limits import SMALLEST_FLUCTUATION
from ..render.formats import Units
from .amounts import read_inertia
from .declare import optional
from .options import parse_orders, parse_speed
from .output import refuse_leaving_files, write_file

if TYPE_CHECKING:
    from ..torque.analysis import TorqueAnalysis
    from ..torque.flywheel import Flywheel
    from ..torque.given_curve import CurveAnalysis

LOADS = ("pin", "main")
_NOTE = "by balcli torque"
# Where an engine has what a curve is given by an option.
_IN_ITS_FILE = {"--inertia": "; that of an engine stands in its file: [crank] inertia, [flywheel]"}
Engine = Annotated[
    str | None,
    typer.Argument(
        metavar="FILE",
        help="Engine file with [gas] (TOML); - reads standard input. Not with --curve.",
        show_default=False,
    ),
]
Fluctuation = Annotated[
    str | None,
    optional(
        "1/200", "Also the inertia that keeps (highest - lowest)/mean speed to this; or 0.5%."
    ),
]
Cylinder = Annotated[
    int, typer.Option(metavar="N", help="Whose torque is shown beside the engine's.")
]
LoadsOption = Annotated[
    str | None,
    optional("pin,main", "Also loads of crank and knuckle pins, and of main bearings.", "--loads"),
]
Curve = Annotated[
    Path | None,
    optional(
        "CSV", "A torque instead of an engine: angle_deg,torque_Nm; the last row closes the period."
    ),
]
Load = Annotated[
    Path | None,
    optional(
        "CSV", "With --curve: the torque that the load takes, likewise; default: the mean, evenly."
    ),
]
Inertia = Annotated[
    str | None, optional("KG_MM2", "With --curve: of all that turns, in kg mm^2 or as '2 kg m^2'.")
]
Orders = Annotated[
    str | None,
    optional(
        "1-8|0.5-8|1,2,4",
        "Orders to show, halves too where a range begins or ends with one; default: all to 12, "
        "and of an engine that fires more than 12 times a turn this order and its double.",
        "--orders",
    ),
]
Write = Annotated[
    Path | None,
    optional(
        "OUT.toml", "Write the engine file with this uneven speed (speed_ripple) and misfires."
    ),
]


def parse_fluctuation(text: str | None) -> float | None:
    """`1/200`, `0.005` or `0.5%`.

    Raises:
        BalcliError: anything else; what is not between 1e-9 and 2.
    """
    if text is None:
        return None
    whole = r"\s*([0-9.]+(?:e-?[0-9]+)?)\s*(?:/\s*([0-9.]+)|(%))?\s*"
    match = re.fullmatch(whole, text, re.ASCII)
    try:
        above, below, percent = match.groups() if match else ("", None, None)
        found = float(above) / float(below or 1) / (100 if percent else 1)
    except (ValueError, ZeroDivisionError):
        found = math.nan
    if not SMALLEST_FLUCTUATION <= found < 2:
        raise BalcliError(
            f'--fluctuation "{text[:60]}": give (highest - lowest)/mean speed, such as 1/200 or '
            "0.5%"
        )
    return found


def parse_loads(text: str | None) -> tuple[str, ...]:
    """Names of `--loads`.

    Raises:
        BalcliError: unknown ones.
    """
    words = tuple(dict.fromkeys(word.strip() for word in (text or "").split(",") if word.strip()))
    if strangers := [word for word in words if word not in LOADS]:
        raise BalcliError(f'--loads "{strangers[0][:60]}": there are {" and ".join(LOADS)}')
    return words


def analyze_file(
    path: str,
    speed: str | None,
    orders: str | None,
    cylinder: int,
    misfire: list[int] | None,
    fluctuation: str | None,
    loads: str | None,
) -> tuple[bytes, TorqueAnalysis]:
    """Text of an engine file, and the torque of its engine."""
    from ..torque.analysis import analyze_torque
    from .inputs import named_by_file, read_engine, require_gas, silence_cylinders

    source = read_engine(path, parse_speed(speed))
    require_gas(source.engine, path)
    engine = silence_cylinders(named_by_file(source.engine, path), misfire or (), path)
    asked, allowed = parse_orders(orders), parse_fluctuation(fluctuation)
    found = analyze_torque(
        engine, asked, cylinder=cylinder, fluctuation=allowed, loads=parse_loads(loads)
    )
    if found.loads.obstacle:
        warn(f"{name_file(path)}: main bearings: {found.loads.obstacle}")
    return source.text, found


def analyze_given(
    curve: Path,
    load: Path | None,
    inertia: str | None,
    speed: str | None,
    orders: str | None,
    fluctuation: str | None,
    units: Units,
) -> CurveAnalysis:
    """A torque from a file."""
    from ..torque.given_curve import DrivenShaft, analyze_curve, doubt_period, read_curve
    from .inputs import warn_each

    rpm = parse_speed(speed)
    shaft = DrivenShaft(
        None if rpm is None else rpm * RPM,
        None if inertia is None else read_inertia("--inertia", inertia, units),
    )
    torque = read_curve(curve)
    warn_each(doubt_period(torque), str(curve))
    return analyze_curve(
        curve.stem,
        torque,
        None if load is None else read_curve(load),
        shaft,
        fluctuation=parse_fluctuation(fluctuation),
        orders=parse_orders(orders),
    )


def refuse_mixture(
    path: str | None, curve: Path | None, alone: Mapping[str, object], given: Mapping[str, object]
) -> None:
    """Either an engine or a curve, and the options of one of them.

    Args:
        alone: options that need an engine, with their values.
        given: options that need a curve.

    Raises:
        BalcliError: with what to leave out.
    """
    if (path is None) == (curve is None):
        raise BalcliError("give an engine file, or --curve with a torque")
    if path is not None and path.lower().endswith(".csv"):
        raise BalcliError(f"{path}: an engine file ends in .toml; is it a torque, for --curve?")
    wrong = alone if path is None else given
    for option, value in wrong.items():
        if value:
            needs = "an engine file" if path is None else f"--curve{_IN_ITS_FILE.get(option, '')}"
            raise BalcliError(f"{option} needs {needs}")


def exit_if_it_stalls(path: str, flywheel: Flywheel | None, fluctuation: str | None) -> None:
    """End with an error where inertia does not carry the crank over a cycle, unless it was asked
    which inertia does.
    """
    if flywheel is not None and flywheel.stall and fluctuation is None:
        from .inputs import exit_on_errors

        exit_on_errors([f"{name_file(path)}: {flywheel.stall}"])


def write_uneven(path: str, source: bytes, result: TorqueAnalysis, target: Path) -> None:
    """The engine file with its speed as uneven as the torque makes it, and without the gas of the
    cylinders that misfire.

    Raises:
        BalcliError: the inertia is not known, or too small; the target cannot be written.
    """
    from ..enginefile.edit import set_keys

    refuse_leaving_files(source, path, target)
    if result.flywheel is not None and result.flywheel.stall:
        raise BalcliError(f"--write: {result.flywheel.stall}")
    if result.flywheel is None or result.flywheel.speed is None:
        raise BalcliError(
            "--write: the speed is not known; give inertia in [crank] or [flywheel], such as "
            "[flywheel] and inertia = 250000"
        )
    lines = [
        {"order": line.order, "amplitude": line.amplitude, "angle": line.angle_deg}
        for line in result.flywheel.speed.lines
    ]
    keys = {"speed": float(result.engine.speed_rpm), "speed_ripple": lines}
    text = set_keys(source.decode("utf-8-sig"), "operation", keys, _NOTE)
    for number in result.engine.silent.without_gas:
        text = set_keys(text, f"cylinder.{number}", {"gas": 0}, _NOTE)
    write_file(text, target)
