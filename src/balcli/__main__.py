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
    gc.set_threshold(100_000)                                           # start-up makes many objects, but no garbage
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "1")              # looking for plugins takes longer than an analysis
    _Metadata.defer()
    from .cli import main as run

    run()


class _Metadata(ModuleType):
    """`importlib.metadata`, imported when something is asked of it.

    pydantic imports it even where plugins are off, and with it e-mail, archives and sockets: as much as all of our own modules.
    """

    NAME = "importlib.metadata"

    @classmethod
    def defer(cls) -> None:
        """Stand in for the module, unless it is there already."""
        if cls.NAME not in sys.modules:
            later = sys.modules[cls.NAME] = importlib.metadata = cls(cls.NAME)
            spec = later.__spec__ = PathFinder.find_spec(cls.NAME, importlib.__path__)
            if spec is not None:
                later.__file__, later.__path__ = spec.origin, list(spec.submodule_search_locations or ())

    def __getattr__(self, name: str) -> Any:
        return getattr(self._real(), name)

    def entry_points(self, **chosen: Any) -> Any:
        """What pydantic imports by name."""
        return self._real().entry_points(**chosen)

    def _real(self) -> ModuleType:
        if sys.modules.get(self.NAME) is self:
            del sys.modules[self.NAME]
        return importlib.import_module(self.NAME)


if __name__ == "__main__":
    main()
