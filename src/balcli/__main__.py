"""The program's start: what makes a process quick, before anything large is imported."""

from __future__ import annotations

import gc
import importlib
import os
import sys
from importlib.machinery import PathFinder
from types import ModuleType
from typing import Any


def main() -> None:
    """Entry point of `balcli` and `python -m balcli`."""
    gc.set_threshold(100_000)  # start-up makes many objects, but no garbage
    os.environ.setdefault(
        "PYDANTIC_DISABLE_PLUGINS", "1"
    )  # looking for plugins takes longer than an analysis
    for name in ("importlib.metadata", "secrets"):
        _Later.defer(name)
    from .cli import main as run

    run()


class _Later(ModuleType):
    """A module of the standard library that is imported when something is asked of it.

    pydantic imports `importlib.metadata` even where plugins are off, and with it e-mail, archives
    and sockets, and `secrets` for random strings of which we have none, and with it OpenSSL:
    together as much as half of our own modules.
    """

    @classmethod
    def defer(cls, name: str) -> None:
        """Stand in for the module, unless it is there already."""
        if name in sys.modules:
            return
        home, _, last = name.rpartition(".")
        later = sys.modules[name] = cls(name)
        spec = later.__spec__ = PathFinder.find_spec(
            name, sys.modules[home].__path__ if home else None
        )
        if spec is not None:
            later.__file__ = spec.origin
            if spec.submodule_search_locations is not None:
                later.__path__ = list(spec.submodule_search_locations)
        if home:
            setattr(sys.modules[home], last, later)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._real(), name)

    def entry_points(self, **chosen: Any) -> Any:
        """Of `importlib.metadata`: pydantic imports it by name."""
        return self._real().entry_points(**chosen)

    def _real(self) -> ModuleType:
        if sys.modules.get(self.__name__) is self:
            del sys.modules[self.__name__]
        return importlib.import_module(self.__name__)


if __name__ == "__main__":
    main()
