"""`balcli.load_example`"""

from __future__ import annotations

from ..engine.build import Engine, build
from ..engine.parse import parse
from ..enginefile.examples import text
from ..errors import wrong_type


def load_example(name: str) -> Engine:
    """One of the engines that come with balcli, ready to analyse.

    Args:
        name: as `balcli engines` lists it, such as "i4", "v8_crossplane" or "radial7_articulated".

    Raises:
        BalcliError: there is none of this name, with the nearest ones.
        TypeError: the name is no text.

    Example:
        >>> engine = load_example("v8_crossplane")
    """
    if not isinstance(name, str):
        raise wrong_type("load_example", name, 'give the name of an example, such as "i4"')
    return build(parse(text(name), name))
