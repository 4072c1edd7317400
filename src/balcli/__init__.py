"""Engine balance: free forces and moments of reciprocating engines, order by order, and what
cancels them.

from balcli import load, analyze, balance

engine = load("v8.toml")
print(analyze(engine).spectra.moment.major)
"""

from __future__ import annotations

TYPE_CHECKING = (
    False  # typing takes longer than all else here, and until then Ctrl-C is a traceback
)
if TYPE_CHECKING:
    from typing import Any

    from .engine.build import Engine
    from .engine.load import load
    from .errors import BalcliError, InputError
    from .field_balancing.balance import FieldBalance, balance_rotor
    from .field_balancing.read import parse_runs, read_runs
    from .mounting.read import read_mounted
    from .mounting.report import MountReport, report_mounts
    from .results.analysis import Analysis, analyze
    from .results.balance import Balance, balance

__version__ = "0.1.0"
__all__ = [
    "Analysis",
    "Balance",
    "BalcliError",
    "Engine",
    "FieldBalance",
    "InputError",
    "MountReport",
    "__version__",
    "analyze",
    "balance",
    "balance_rotor",
    "load",
    "parse_runs",
    "read_mounted",
    "read_runs",
    "report_mounts",
]

_ROOMS = {
    "Analysis": "results.analysis",
    "analyze": "results.analysis",
    "Balance": "results.balance",
    "balance": "results.balance",
    "Engine": "engine.build",
    "load": "engine.load",
    "BalcliError": "errors",
    "InputError": "errors",
    "FieldBalance": "field_balancing.balance",
    "balance_rotor": "field_balancing.balance",
    "parse_runs": "field_balancing.read",
    "read_runs": "field_balancing.read",
    "MountReport": "mounting.report",
    "read_mounted": "mounting.read",
    "report_mounts": "mounting.report",
}


def __dir__() -> list[str]:
    """What the library promises, for completion."""
    return __all__


def __getattr__(name: str) -> Any:
    """The library's door: what is behind it is imported when it is first asked for."""
    if name not in _ROOMS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f".{_ROOMS[name]}", __name__), name)
