"""The command `balcli torque`: its options, and the file that `--write` makes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ..errors import BalcliError, warn
from ..file.edit import set_keys, set_speed
from ..file.toml import name_file
from ..limits import FLUCTUATION
from ..shell.file_names import engine_argument, require_ending, text_format
from ..shell.inputs import (
    exit_on_errors,
    named_by_file,
    read_engine,
    require_gas,
    silence_cylinders,
    warn_each,
)
from ..shell.options import (
    FormatOption,
    Misfire,
    Orders,
    Output,
    Speed,
    UnitsOption,
    parse_orders,
    parse_speed,
)
from ..shell.output import refuse_leaving_files, refuse_overwriting, show, write_file
from ..shell.values import optional, parse_cylinder, read_inertia, read_share
from ..show.formats import Units

if TYPE_CHECKING:
    from .records import TorqueAnalysis


_NOTE = "by balcli torque"
EngineFile = Annotated[
    str | None,
    engine_argument(
        "FILE",
        "Engine file with [gas] (TOML), or the name of an example; - reads standard input. "
        "Not with --curve.",
    ),
]
Fluctuation = Annotated[
    str | None, optional("1/200", "Also compute the inertia for this speed fluctuation (or 0.5%).")
]
Cylinder = Annotated[
    str | None,
    optional("N|NAME.N", "Show the gas torque of this cylinder; default: 1, or the first to fire."),
]
LoadsOption = Annotated[
    str | None,
    optional("pin,main,rod", "Also show loads of pins, main bearings and piston rods.", "--loads"),
]
Curve = Annotated[
    Path | None,
    optional("CSV", "A curve, not an engine: angle_deg,torque_Nm; or another quantity."),
]
Load = Annotated[
    Path | None, optional("CSV", "With --curve: torque of the load; default: the mean torque.")
]
Inertia = Annotated[
    str | None, optional("KG_MM2", "With --curve: inertia of the shaft, kg mm^2 or '2 kg m^2'.")
]
Write = Annotated[
    Path | None, optional("OUT.toml", "Write a copy of FILE with this uneven speed and misfire.")
]


def torque(
    path: EngineFile = None,
    fluctuation: Fluctuation = None,
    cylinder: Cylinder = None,
    misfire: Misfire = None,
    loads: LoadsOption = None,
    curve: Curve = None,
    load: Load = None,
    inertia: Inertia = None,
    write: Write = None,
    speed: Speed = None,
    orders: Orders = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Torque of gas and inertia on the crank: by order and over the cycle, mean torque and power,
    the uneven speed and the flywheel; or the effect of a given torque curve.

    `balcli torque v8.toml --fluctuation 1/200` computes the inertia that limits the fluctuation to
    1/200. If the inertia is so small that the crank stalls, an error after the results names the
    crank angle at which it stalls.

    \b
    Examples:
      balcli torque v8_wiebe.toml
      balcli torque v8_wiebe.toml --fluctuation 2%
    """
    reads = [str(name) for name in (path, curve, load) if name is not None]
    refuse_overwriting(reads=reads, writes={"--output": output, "--write": write})
    form = text_format(output, form)
    require_ending(write, ".toml", "--write")
    if (path is None) == (curve is None):
        raise BalcliError("give an engine file, or --curve with the CSV file of a torque")
    misplaced: dict[str, object] = {"--load": load, "--inertia": inertia}
    needed = "--curve; an engine file has its inertia in [crank] or [flywheel]"
    if curve is not None:
        misplaced = {"--misfire": misfire, "--write": write, "--loads": loads}
        misplaced["--cylinder"] = cylinder
        needed = "an engine file"
    _refuse_all(misplaced, needed)
    from . import answer, given_curve, recorded_curve, recorded_show, show as pages

    rpm = parse_speed(speed)
    asked = parse_orders(orders)
    allowed = None if fluctuation is None else read_share("fluctuation", fluctuation, FLUCTUATION)
    if curve is not None and (quantity := recorded_curve.find_quantity(curve)):
        own_options = {"--load": load, "--inertia": inertia, "--fluctuation": fluctuation}
        _refuse_all({**own_options, "--speed": speed}, f"a torque; {curve} has {quantity}")
        record = recorded_curve.read_record(curve, quantity)
        warn_each(given_curve.doubt_period(record), str(curve))
        split = recorded_curve.analyze_record(curve.stem, quantity, record, asked)
        show([split], recorded_show.RENDERER, form, output, units)
        return
    if curve is not None:
        own = None if inertia is None else read_inertia("inertia", inertia, units)
        given = given_curve.read_curve(curve)
        warn_each(given_curve.doubt_period(given), str(curve))
        taken = None if load is None else given_curve.read_curve(load)
        result = given_curve.analyze_curve(
            curve.stem, given, taken, speed_rpm=rpm, inertia=own, fluctuation=allowed, orders=asked
        )
    else:
        source = read_engine(path or "", rpm)
        require_gas(source.engine, path or "")
        engine = named_by_file(source.engine, path or "")
        engine = silence_cylinders(engine, misfire or (), path or "")
        result = answer.torque(
            engine,
            asked,
            cylinder=None if cylinder is None else parse_cylinder(cylinder),
            fluctuation=allowed,
            loads=loads or (),
        )
        if hasattr(result, "loads") and result.loads.obstacle:
            warn(f"{name_file(path or '')}: main bearings: {result.loads.obstacle}")
        if write is not None:
            write_uneven(path or "", source.text, result, write)
    show([result], pages.RENDERER, form, output, units)
    if hasattr(result, "flywheel") and result.flywheel.stall and fluctuation is None:
        exit_on_errors([f"{name_file(path or str(curve))}: {result.flywheel.stall}"])


def _refuse_all(options: Mapping[str, object], needed: str) -> None:
    """Raise BalcliError if one of these options is given, which need something else."""
    for option, value in options.items():
        if value:
            raise BalcliError(f"{option} needs {needed}")


def write_uneven(path: str, source: bytes, result: TorqueAnalysis, target: Path) -> None:
    """Write a copy of the engine file with the uneven speed that the torque causes. Cylinders
    without gas get `gas = 0`.

    Raises:
        BalcliError: The inertia is unknown or too small, or the target cannot be written.
    """
    refuse_leaving_files(source, path, target)
    flywheel = result.flywheel if hasattr(result, "flywheel") else None
    if flywheel is None or not hasattr(flywheel, "fluctuation"):
        unknown = (
            "the uneven speed needs an inertia; give inertia in [crank] or [flywheel], such as "
            "inertia = 250000"
        )
        raise BalcliError(f"--write: {(flywheel and flywheel.stall) or unknown}")
    keys = ("order", "amplitude", "angle")
    lines = [dict(zip(keys, line, strict=True)) for line in flywheel.lines]
    text = set_speed(source.decode("utf-8-sig"), result.speed_rpm or 0.0, _NOTE)
    text = set_keys(text, "operation", {"speed_ripple": lines}, _NOTE)
    if result.no_gas_in and result.engine is not None and result.engine.placed:
        message = "write [cylinder.N] gas = 0 into the file of the engine that misfires"
        raise BalcliError(f"--write: geared engines cannot be written with a misfire; {message}")
    for number in result.no_gas_in or ():
        text = set_keys(text, f"cylinder.{number}", {"gas": 0}, _NOTE)
    write_file(text, target)
