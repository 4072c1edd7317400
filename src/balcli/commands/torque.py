"""`balcli torque`"""

from __future__ import annotations

from ..render.formats import Units
from . import torque_options as own
from .file_names import require_ending, text_format
from .options import FormatOption, Misfire, Output, Speed, UnitsOption
from .output import refuse_overwriting, show


def torque(
    path: own.Engine = None,
    fluctuation: own.Fluctuation = None,
    cylinder: own.Cylinder = 1,
    misfire: Misfire = None,
    loads: own.LoadsOption = None,
    curve: own.Curve = None,
    load: own.Load = None,
    inertia: own.Inertia = None,
    write: own.Write = None,
    speed: Speed = None,
    orders: own.Orders = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Torque of gas and inertia on the crank: by order and over the cycle, mean torque and power,
    the uneven speed and the flywheel; or what a given torque curve does.

    `balcli torque v8.toml --fluctuation 1/200` says which inertia keeps the speed to that. Where
    the crank stalls with the inertia it has, that is an error, with the angle; all else is told.

    \b
    Examples:
      balcli torque v8_wiebe.toml
      balcli torque v8_wiebe.toml --fluctuation 2%
    """
    reads = [str(name) for name in (path, curve, load) if name is not None]
    refuse_overwriting(reads=reads, writes={"--output": output, "--write": write})
    form = text_format(output, form)
    require_ending(write, ".toml", "--write")
    from ..render import torque as renderer

    alone = {"--misfire": misfire, "--write": write, "--cylinder": cylinder != 1, "--loads": loads}
    own.refuse_mixture(path, curve, alone, {"--load": load, "--inertia": inertia})
    if curve is not None:
        given = own.analyze_given(curve, load, inertia, speed, orders, fluctuation, units)
        show([given], renderer, form, output, units)
        own.exit_if_it_stalls(str(curve), given.flywheel, fluctuation)
        return
    text, result = own.analyze_file(
        path or "", speed, orders, cylinder, misfire, fluctuation, loads
    )
    if write is not None:
        own.write_uneven(path or "", text, result, write)
    show([result], renderer, form, output, units)
    own.exit_if_it_stalls(path or "", result.flywheel, fluctuation)
