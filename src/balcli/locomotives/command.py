"""The command `balcli locomotive`: its options and its output."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from ..errors import BalcliError, naming_file, warn
from ..file.toml import name_file
from ..shell.file_names import require_ending, text_format
from ..shell.inputs import named_by_file, read_engine, warn_each
from ..shell.options import EnginePath, FormatOption, Output, UnitsOption
from ..shell.output import refuse_leaving_files, refuse_overwriting, show, write_file
from ..shell.scheme_options import parse_factors
from ..shell.values import optional
from ..show.formats import Format, Units

Factor = Annotated[
    str | None,
    optional("K|K:K:STEP", "Balance factor instead of the file's, such as 2/3 or 0:100%:10%."),
]
HammerBlow = Annotated[
    str | None,
    optional("N", "Allowed hammer blow of a wheel instead of a factor, such as '40 kN'."),
]
Speed = Annotated[str | None, optional("KM_H|RPM", "Speed: '80 km/h', '50 mph', or 300 (rpm).")]
Write = Annotated[Path | None, optional("OUT.toml", "Write the file with these balance masses.")]


def locomotive(
    path: EnginePath,
    factor: Factor = None,
    hammer_blow: HammerBlow = None,
    speed: Speed = None,
    write: Write = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Balance of a steam locomotive: balance masses in the wheels, hammer blow, rail loads, wheel
    lift, variation of tractive effort and swaying couple.

    The file has [locomotive] and, for coupled wheels, [[axle]] with the masses of the coupling rods
    (side rods); `balcli new locomotive` writes a file to start from. Several factors make a table
    with a row for each factor: a larger factor (more overbalance) means a smaller swaying couple
    and a larger hammer blow.

    \b
    Examples:
      balcli locomotive locomotive2.toml --factor 0:100%:20%
      balcli locomotive locomotive2.toml --hammer-blow "15 kN" --speed "60 mph"
    """
    refuse_overwriting(reads=[path], writes={"--output": output, "--write": write})
    form = text_format(output, form)
    require_ending(write, ".toml", "--write")
    factors = (None,) if factor is None else parse_factors(factor)
    if len(factors) > 1 and write is not None:
        raise BalcliError(f'--write takes one factor, not --factor "{factor}"')
    from . import answer, show as pages

    source = read_engine(path, asked=())
    engine = named_by_file(source.engine, path)
    asked = [_read_bare(hammer_blow), _read_bare(speed)]
    with naming_file(name_file(path)):
        results = [
            answer.locomotive(engine, one, hammer_blow=asked[0], speed=asked[1]) for one in factors
        ]
    warn_each(results[0].doubts, name_file(path))
    if hammer_blow is not None and results[0].factor == 1:
        blow = max(wheel.hammer_blow_N for wheel in results[0].wheels)
        warn(f"--hammer-blow: not reached; even the factor 1 makes only {blow:.4g} N")
    if write is not None:
        refuse_leaving_files(source.text, path, write)
        rpm = None if speed is None else results[0].speed_rpm
        write_file(answer.insert_weights(source.text, results[0], name_file(path), rpm), write)
    if len(results) > 1 and form is not Format.JSON:
        show([results], pages.OF_FACTORS, form, output, units)
    else:
        show(results, pages.RENDERER, form, output, units)


def _read_bare(text: str | None) -> float | str | None:
    """Return a text without a unit as a number, and any other text unchanged."""
    try:
        return None if text is None else float(text)
    except ValueError:
        return text
