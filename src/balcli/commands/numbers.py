"""`balcli numbers`"""

from __future__ import annotations

from ..render.numbers import RENDERER
from .file_names import text_format
from .options import EnginePath, FormatOption, Output
from .output import refuse_overwriting, show


def numbers(path: EnginePath, form: FormatOption = None, output: Output = None) -> None:
    """What can be varied of an engine file, and what can be asked of it: names for `sweep`,
    `search` and `scatter`, with values, units and meanings.

    \b
    Examples:
      balcli numbers v8.toml
      balcli numbers v8.toml --format csv
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    from ..studies.numbers import name_numbers
    from .inputs import read_engine

    show([name_numbers(read_engine(path, asked=()).model)], RENDERER, form, output)
